/* scene.h - what a scene is: a row of the table in scene.c.
 *
 * A new scene is a row in scene.c, whose function, such as create_square_scene,
 * fills the system and the start.  Files, options, --list and, for the first
 * nine rows, the keys 1 to 9 read the row. */
#pragma once

#include "base/status.h"

struct Options;
struct Simulation;

/* The picture of a scene. */
typedef enum PictureKind {
    PICTURE_SQUARE,    /* springs and discs, energies over time */
    PICTURE_CIRCLE,    /* trails around the exact circle, radius over time */
    PICTURE_CURVE,     /* f(x), its quadratic model, the iterates */
    PICTURE_LANDSCAPE, /* contours of E, the Newton path */
    PICTURE_MASS,      /* a mass and the arrows of a step */
    PICTURE_TANGENT,   /* g and its tangents above E and its parabolas */
    PICTURE_DIAL,      /* the landscape's minimiser for every h */
    PICTURE_SPRING,    /* a spring, its energies and eigenvalues */
    PICTURE_RACE,      /* error over run time */
    PICTURE_ENVELOPE,  /* convergence for each time step and stiffness */
    PICTURE_COUNT
} PictureKind;

/* Parts that a scene has, as bits.  Options about missing parts are refused. */
enum ScenePart {
    HAS_MESH = 1,            /* a square: segments, side, density, stiffness */
    HAS_TIME = 2,            /* motion in time, by an integrator */
    HAS_START = 4,           /* a point to start from */
    HAS_SPRINGS = 8,         /* springs: solver, projection of their Hessian */
    HAS_MINIMUM = 16,        /* tolerance and line search */
    HAS_ONE_COORDINATE = 32, /* a start with one coordinate, x */
    HAS_TIMESTEP = 64,       /* a time step h */
    HAS_BODY = 128,          /* a body: options --turn, --at, --pin and more */
    HAS_MOTION = HAS_TIME | HAS_TIMESTEP,
    HAS_SQUARE = HAS_MESH | HAS_MOTION | HAS_SPRINGS | HAS_MINIMUM | HAS_BODY
};

/* Most points that the mouse can drag, and most switches of a picture. */
enum { SCENE_MAX_HANDLES = 4, SCENE_MAX_SWITCHES = 4 };

/* A part of the picture that can be switched off. */
typedef struct SceneSwitch {
    const char *label; /* text beside the switch */
    bool is_on;        /* the switch is on */
} SceneSwitch;

/* Properties of a scene's body for which there is no option. */
typedef struct SceneBody {
    double aspect;         /* height over width; 0: a square */
    double cell_stiffness; /* stiffness of cells, k_c, over k; 0: one half */
    double pin_speed; /* speed of pinned nodes to the left and right, sides/s */
    double notch[2]; /* heights between which springs across the middle line are
                        cut, from the centre, divided by the body's height */
    int runs;        /* number of runs, each with a body; 0 means 1 */
    double height_step;        /* height of run r above run r + 1, in sides */
    double friction_factor[3]; /* factors on the runs' friction; 0 means 1 */
    /* Returns a further obstacle, at its start; NULL: no obstacle. */
    struct Obstacle (*make_obstacle)(const struct Options *options);
} SceneBody;

/* A row of the table of scenes.  0 and NULL mean "none", or the usual value. */
typedef struct Scene {
    const char *name;     /* name on the command line */
    const char *title;    /* heading above the picture */
    const char *sentence; /* description, at most 60 letters */
    PictureKind picture;
    unsigned parts;   /* bits of ScenePart: what the scene has */
    const char *args; /* options with other values than on the slides */
    /* Fills simulation->system and the mesh, and starts each run
     * (simulation_start_run). */
    Status (*create)(struct Simulation *simulation);
    double speed;   /* steps a frame at first; 0: 1, or 1/32 without time */
    double view[4]; /* m, left, bottom, right, top of the view; 0: automatic */
    double strain_colour_max; /* strain of the full colour; 0: no colours */
    bool needs_dissipation;   /* the sentence describes a motion that dies away,
                                 which is true only of methods that dissipate */
    const char *step_name; /* name of a step, "iteration"; NULL: a time step */
    bool starts_paused;    /* the window waits at step 0 */
    const char *group_heading; /* heading of the group, in its first scene */
    bool is_hidden;  /* has no key and no cell in the overview; the table ends
                        with these scenes */
    const char *pin; /* value of --pin */
    SceneBody body;
    /* Makes one step; NULL: a step in time of each run. */
    Status (*step)(struct Simulation *simulation);
    /* Computes the next direction again, after the projection or the line
     * search changed.  NULL: the next step computes its direction. */
    void (*find_direction)(struct Simulation *simulation);
    /* Begins the search again after a drag.  NULL: the scene moves in time. */
    void (*restart)(struct Simulation *simulation);
    /* A letter for each point that can be dragged: x for the mass or the
     * iterate, v for the tip of the velocity, t for x_tilde. */
    const char *handle_kinds;
    /* Names of the parts of the picture that can be switched. */
    const char *switch_labels[SCENE_MAX_SWITCHES];
} Scene;
