/* scene.h - what a scene is: a row of the table in scenes.h.
 *
 * A row names what the scene needs; the rest is skipped: no term evaluated, no
 * matrix analysed, nothing drawn.  To add a scene: one row in scene.c and one
 * function that fills the system and the start, such as create_square; the
 * keys, the files, the options and --list know of it then.
 */
#ifndef ELASTO_SCENE_H
#define ELASTO_SCENE_H

#include "base/status.h"

struct Options;
struct Simulation;

/* How the picture layer shows a scene. */
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
    PICTURE_ENVELOPE,  /* a cell for each time step and stiffness */
    PICTURE_COUNT
} PictureKind;

/* What a scene makes use of; options about anything else are refused. */
enum SceneNeeds {
    NEEDS_MESH = 1,        /* segments, side, density, stiffness, stretch */
    NEEDS_TIME = 2,        /* an integrator */
    NEEDS_START = 4,       /* a point to start from */
    NEEDS_SPRINGS = 8,     /* solver and projection of their Hessian */
    NEEDS_MINIMUM = 16,    /* tolerance and line search */
    NEEDS_ONE_NUMBER = 32, /* of the start: its x is enough */
    NEEDS_STEP = 64,       /* a time step h, but no integrator */
    NEEDS_BODY = 128,      /* turn, at, velocity, gravity, pin */
    NEEDS_SQUARE =
        NEEDS_MESH | NEEDS_TIME | NEEDS_SPRINGS | NEEDS_MINIMUM | NEEDS_BODY
};

/* Points of the stage that the mouse can drag, and parts of the picture that it
 * can switch off, at most. */
enum { SCENE_MAX_HANDLES = 4, SCENE_MAX_SWITCHES = 4 };

/* A part of the picture that can be switched off. */
typedef struct Switch {
    const char *label;
    bool on;
} Switch;

typedef struct Scene {
    const char *name;     /* as on the command line */
    const char *title;    /* above its picture */
    const char *sentence; /* for --list and the window, at most 60 letters */
    PictureKind picture;
    unsigned needs;   /* of enum SceneNeeds */
    const char *line; /* its own numbers where the slides' are not right, as on
                         the command line; NULL: there are none */
    /* Fills simulation->system, mesh and the start. */
    Status (*create)(struct Simulation *simulation);
    double speed;     /* Steps a frame, as somebody first sees it; 0: 1. */
    double frame[4];  /* m, left, bottom, right, top of what is seen; 0: the
                         picture's choice */
    double strain;    /* its springs are coloured by strain from the start, the
                         full colours at this one; 0: only if one asks */
    bool settles;     /* the sentence tells of a motion that dies away: true
                         only of methods that take energy out */
    const char *turn; /* what one step is; NULL: a step in time */
    bool explains; /* it is looked at step by step: a window waits at step 0 */
    const char *group; /* of scenes that begins with it; NULL: none does */
    bool by_name;    /* opened by name or by a page only: neither a key nor the
                        sheet has it */
    const char *pin; /* as --pin, or NULL */
    /* What the command line has no words for: rows over columns, 0: a square;
     * k_c over k, 0: one half; whether pins are moved. */
    double aspect, cell_stiffness;
    bool moving_pins;
    int runs; /* each with a body of its own; 0: one */
    /* The obstacle that comes with the scene beside those of the options, as it
     * begins, o a ball's centre too.  NULL: there is none. */
    struct Obstacle (*own)(const struct Options *options);
    /* One step; NULL: a step in time of every run. */
    Status (*step)(struct Simulation *simulation);
    /* The next direction again, after projection or line search changed; NULL:
     * the next step takes notice by itself. */
    void (*aim)(struct Simulation *simulation);
    /* The search anew, after a point was dragged; NULL: only where time passes.
     */
    void (*restart)(struct Simulation *simulation);
    /* The points that can be dragged, a letter each: x, the mass or the
     * iterate; v, the tip of its velocity; t, x_tilde.  NULL: none. */
    const char *grips;
    /* The parts of the picture that can be switched. */
    const char *parts[SCENE_MAX_SWITCHES];
} Scene;

#endif
