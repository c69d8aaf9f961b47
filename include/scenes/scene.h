/* scene.h - the scenes, one row of a table each.
 *
 * A row names what the scene needs; the rest is skipped: no term evaluated, no
 * matrix analysed, nothing drawn.  To add a scene: one row in scene.c and one
 * function that fills the system and the start, such as create_square; the
 * keys, the files, the options and --list know of it then.
 */
#ifndef ELASTO_SCENE_H
#define ELASTO_SCENE_H

#include "scenes/simulation.h"

/* How the picture layer shows a scene. */
typedef enum PictureKind {
    PICTURE_SQUARE,    /* springs and discs, energies over time */
    PICTURE_CIRCLE,    /* trails around the exact circle, radius over time */
    PICTURE_CURVE,     /* f(x), its quadratic model, the iterates */
    PICTURE_LANDSCAPE, /* contours of E, the Newton path */
    PICTURE_COUNT
} PictureKind;

/* What a scene makes use of; options about anything else are refused. */
enum SceneNeeds {
    NEEDS_MESH = 1,        /* segments, side, density, stiffness, stretch */
    NEEDS_TIME = 2,        /* an integrator */
    NEEDS_START = 4,       /* a point to start from */
    NEEDS_SPRINGS = 8,     /* solver and filter of their Hessian */
    NEEDS_MINIMUM = 16,    /* tolerance and line search */
    NEEDS_ONE_NUMBER = 32, /* of the start: its x is enough */
};

typedef struct Scene {
    const char *name;     /* as on the command line */
    const char *sentence; /* for --list and the window, at most 60 letters */
    PictureKind picture;
    unsigned needs; /* of enum SceneNeeds */
    /* Changes the default options, before the command line is applied; NULL:
     * the slides' numbers are right. */
    void (*defaults)(Options *options);
    /* Fills simulation->system, mesh and the start. */
    Status (*create)(Simulation *simulation, const NewtonSettings *settings);
    /* One step; NULL: a step in time of every run. */
    Status (*step)(Simulation *simulation);
    /* The next direction again, after filter or line search changed; NULL:
     * the next step takes notice by itself. */
    void (*aim)(Simulation *simulation);
} Scene;

/* The table; the first row is the default; it ends with a NULL name. */
extern const Scene scenes[];

/* The row with this name, or NULL. */
const Scene *scene_find(const char *name);

#endif
