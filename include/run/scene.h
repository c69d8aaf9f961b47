/* scene.h - what a scene is: a row of the table in scenes.h.
 *
 * A row names what the scene needs; the rest is neither computed nor drawn.  A
 * new scene is a row in scene.c and a function that fills the system and the
 * start, such as create_square; keys, files, options and --list read the row.
 */
#ifndef ELASTO_SCENE_H
#define ELASTO_SCENE_H

#include "base/status.h"

struct Options;
struct Simulation;

/* The picture of a scene. */
typedef enum PictureKind {
    PICTURE_SQUARE,    /* springs and discs, energies over time */
    PICTURE_CIRCLE,    /* trails around the exact circle, radius over time */
    PICTURE_CURVE,     /* f(x), its quadratic model, the iterates */
    PICTURE_LANDSCAPE, /* contours of E, the Newton path */
    PICTURE_MASS,      /* one mass and the arrows of a step */
    PICTURE_TANGENT,   /* g and its tangents above E and its parabolas */
    PICTURE_DIAL,      /* the landscape's minimiser for every h */
    PICTURE_SPRING,    /* one spring, its energies and eigenvalues */
    PICTURE_RACE,      /* error over run time */
    PICTURE_ENVELOPE,  /* convergence for each time step and stiffness */
    PICTURE_COUNT
} PictureKind;

/* Parts that a scene may have; options about missing parts are refused. */
enum SceneNeeds {
    NEEDS_MESH = 1,        /* a square: segments, side, density, stiffness */
    NEEDS_TIME = 2,        /* motion in time, by an integrator */
    NEEDS_START = 4,       /* a point to start from */
    NEEDS_SPRINGS = 8,     /* solver and projection of the springs' Hessian */
    NEEDS_MINIMUM = 16,    /* tolerance and line search */
    NEEDS_ONE_NUMBER = 32, /* a start with one coordinate, x */
    NEEDS_STEP = 64,       /* a time step h without an integrator */
    NEEDS_BODY = 128,      /* a body: turn, at, velocity, gravity, pin */
    NEEDS_SQUARE =
        NEEDS_MESH | NEEDS_TIME | NEEDS_SPRINGS | NEEDS_MINIMUM | NEEDS_BODY
};

/* Most points that the mouse can drag, and most switches of a picture. */
enum { SCENE_MAX_HANDLES = 4, SCENE_MAX_SWITCHES = 4 };

/* A part of the picture that can be switched off. */
typedef struct Switch {
    const char *label;
    bool on;
} Switch;

/* The body of a scene, as far as no option describes it. */
typedef struct SceneBody {
    double aspect;         /* height over width; 0: a square */
    double cell_stiffness; /* k_c over k; 0: one half */
    bool moving_pins;      /* pinned nodes move at a given velocity */
    int runs;              /* runs, each with a body of its own; 0: one */
    /* An obstacle besides those of the options, as it is at the start, a ball
     * with its centre o.  NULL: none. */
    struct Obstacle (*obstacle)(const struct Options *options);
} SceneBody;

/* A row of the table of scenes; 0 and NULL mean "none" or "as usual". */
typedef struct Scene {
    const char *name;     /* name on the command line */
    const char *title;    /* heading above the picture */
    const char *sentence; /* description in --list and the window, at most 60
                             letters */
    PictureKind picture;
    unsigned needs;   /* enum SceneNeeds */
    const char *line; /* options where the scene differs from the slides */
    /* Fills simulation->system, the mesh and the start. */
    Status (*create)(struct Simulation *simulation);
    double speed;    /* steps a frame when the scene opens; 0: 1 */
    double frame[4]; /* m, left, bottom, right, top of the view; 0: the choice
                        of the picture */
    double strain_colour_max; /* strain with the full colour, where springs are
                                 coloured from the start; 0: they are not */
    bool settles;      /* the sentence describes a motion that dies away, which
                          holds only with methods that dissipate */
    const char *turn;  /* name of what a step does; NULL: a step in time */
    bool explains;     /* the window waits at step 0, to be stepped through */
    const char *group; /* heading of the group that begins with this scene */
    bool by_name;      /* opens by name or by a page, neither by a key nor in
   the sheet */
    const char *pin;   /* value of --pin */
    SceneBody body;
    /* Makes one step; NULL: a step in time of each run. */
    Status (*step)(struct Simulation *simulation);
    /* Computes the next direction again, after the projection or the line
     * search changed; NULL: the next step does. */
    void (*aim)(struct Simulation *simulation);
    /* Begins the search again, after a point was dragged; NULL: the scene moves
     * in time. */
    void (*restart)(struct Simulation *simulation);
    /* A letter for each point that can be dragged: x is the mass or the
     * iterate, v the tip of the velocity, t x_tilde. */
    const char *grips;
    /* Names of the parts of the picture that can be switched. */
    const char *parts[SCENE_MAX_SWITCHES];
} Scene;

#endif
