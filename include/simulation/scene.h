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
    PICTURE_TANGENT,   /* upper plot: g = E' and tangents; lower plot: E and
                          parabolas */
    PICTURE_DIAL,      /* minimiser of E for every time step h */
    PICTURE_SPRING,    /* a spring, its energies and eigenvalues */
    PICTURE_RACE,      /* error of methods over computing time */
    PICTURE_ENVELOPE,  /* convergence for each time step and stiffness */
    PICTURE_COUNT
} PictureKind;

/* Parts of a scene, as bits.  Options that need a missing part are refused. */
enum SceneTrait {
    HAS_MESH = 1,            /* a square, with the options of mesh and solver */
    HAS_TIME = 2,            /* motion in time, by an integrator */
    HAS_START = 4,           /* a point to start from */
    HAS_SPRINGS = 8,         /* springs, with the option of projection */
    HAS_MINIMISATION = 16,   /* a minimisation, with tolerance, line search */
    HAS_ONE_COORDINATE = 32, /* a start with one coordinate, x */
    HAS_TIMESTEP = 64,       /* a time step h */
    HAS_BODY = 128,          /* a body: options --turn, --at, --pin and more */
    HAS_MOTION = HAS_TIME | HAS_TIMESTEP,
    HAS_SQUARE =
        HAS_MESH | HAS_MOTION | HAS_SPRINGS | HAS_MINIMISATION | HAS_BODY
};

/* Limits of the numbers of draggable points and of switches in a picture. */
enum { SCENE_MAX_HANDLES = 4, SCENE_MAX_SWITCHES = 4 };

/* A part of the picture that can be switched off. */
typedef struct SceneSwitch {
    const char *label; /* text beside the switch */
    bool is_on;        /* the switch is on */
} SceneSwitch;

/* Properties of a scene's body for which there is no option. */
typedef struct SceneBody {
    double aspect;         /* height over width; 0: a square */
    double cell_stiffness; /* stiffness of cells / that of springs; 0: 1/2 */
    double pin_speed;      /* outward speed of pins in x, side lengths/s */
    double notch_ends[2];  /* ends of a slit beside the middle: heights above
                              the centre, divided by the body's height */
    int runs;              /* number of runs, each with a body; 0 means 1 */
    double run_distance;   /* height of run r above r + 1, in side lengths */
    double friction_factor[3]; /* factors on the runs' friction; 0 means 1 */
    /* Returns a further obstacle, at its start; NULL: no obstacle. */
    struct Obstacle (*make_obstacle)(const struct Options *options);
} SceneBody;

/* A row of the table of scenes.  0 and NULL mean "none", or the usual value. */
typedef struct Scene {
    const char *name;        /* name on the command line */
    const char *title;       /* heading above the picture */
    const char *description; /* description, at most 60 letters */
    PictureKind picture;
    unsigned traits;             /* bits of SceneTrait: what the scene has */
    const char *default_options; /* values that differ from the slides */
    /* Fills simulation->system and the mesh, and starts each run
     * (simulation_start_run). */
    Status (*create)(struct Simulation *simulation);
    double steps_per_frame; /* steps per frame at the start; 0: 1, without time
                               1/32 */
    double view[4]; /* m, left, bottom, right, top of the view; 0: automatic */
    double strain_colour_max; /* strain of the full colour; 0: no colours */
    bool needs_dissipation;   /* the sentence describes a motion that dies away,
                                 which is true only of methods that dissipate */
    const char *step_name; /* word for a step, as "iteration"; NULL: "step" */
    bool starts_paused;    /* the window waits at step 0 */
    const char *group_heading; /* heading of the group that this scene begins */
    bool is_hidden; /* has no key and no cell in the overview; the table ends
                       with these scenes */
    const char *default_pin; /* default of option --pin */
    SceneBody body;
    /* Makes one step; NULL: a step in time of each run. */
    Status (*step)(struct Simulation *simulation);
    /* Computes the next direction again, after the projection or the line
     * search changed.  NULL: the next step computes its direction. */
    void (*update_direction)(struct Simulation *simulation);
    /* Computes the scene anew after a drag of a handle.  NULL: no handle needs
     * it. */
    void (*after_drag)(struct Simulation *simulation);
    /* A letter for each point that can be dragged: x for the mass or the
     * iterate, v for the tip of the velocity, t for x_tilde. */
    const char *handle_kinds;
    /* Names of the parts of the picture that can be switched. */
    const char *switch_labels[SCENE_MAX_SWITCHES];
} Scene;
