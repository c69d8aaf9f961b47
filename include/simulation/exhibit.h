/* exhibit.h - data of the lecture's small scenes, which are part of the saved
 * state, and the points and switches that a user can move in them. */
#pragma once

#include "simulation/scene.h"
#include "step/time_integrator.h"

typedef struct Simulation Simulation;

/* A user's guess where the next step leads, and where the step does lead. */
typedef struct UserPrediction {
    bool has_guess;    /* the user has made a guess */
    long guess_step;   /* number of steps made before the guess */
    double guess[2];   /* m, the guess */
    double outcome[2]; /* m, where the step does lead */
    double error;      /* m, distance guess to outcome; one unknown: along x */
} UserPrediction;

/* ---- descents: minimisation by Newton's method, update by update --------- */

/* Value, gradient and Hessian (xx, xy, yy) of E at a point, in J s^2 and m.  A
 * function f of one unknown uses g[0] and H[0]; the other numbers are 0. */
typedef struct TaylorModel {
    double energy, g[2], H[3]; /* E; gradient; Hessian xx, xy, yy */
    int projected_springs; /* number of springs whose Hessian was projected */
} TaylorModel;

/* Evaluates a function of one unknown at x. */
typedef TaylorModel ScalarFunction(const Simulation *simulation, double x);

enum { DESCENT_MAX_RECORDS = 256 };

/* A minimisation that is shown iteration by iteration. */
typedef struct Descent {
    int record_count;                         /* number of records */
    NewtonRecord record[DESCENT_MAX_RECORDS]; /* Newton's first iterations */
    double iterate[2];                        /* present iterate (m) */
    double value;        /* value of the minimised function at the iterate */
    double start_value;  /* E at the start; INFINITY in one dimension */
    double direction[2]; /* Newton's direction p at the iterate (m); 0: none */
    double slope;        /* gradient times p; below 0, E falls along p */
    bool tests_g;        /* the loop tests |g| (Algorithm 1), not |p|/h */
    double residual;     /* |g|, or |p|/h (m/s), compared with the tolerance */
    ScalarFunction *scalar; /* function of one unknown; NULL: two unknowns */
} Descent;

/* Parts of E in the scene `landscape`, as bits. */
enum LandscapePart {
    PART_INERTIA = 1,    /* |x - x_tilde|_M^2 / 2 */
    PART_ELASTICITY = 2, /* h^2 P(x) */
    PART_BOTH = 3
};

/* The minimiser of E as a function of the time step h. */
enum { DIAL_POINTS = 41 };

typedef struct MinimiserCurve {
    double h[DIAL_POINTS];            /* time steps in ascending order (s) */
    double minimiser[DIAL_POINTS][2]; /* m, minimiser for each h */
} MinimiserCurve;

/* ---- run time against error ---------------------------------------------- */

#define RACE_TIME 0.064 /* s, simulated time of each run */

/* RACE_SHOWN_STEP_INDEX: index of the step size in the table of methods. */
enum { RACE_SHOWN_STEP_INDEX = 1, RACE_METHODS = 4, RACE_STEP_SIZES = 7 };

/* An explicit run counts as stable if RACE_EXTRA_STEPS further steps, which are
 * not measured, leave the energy below RACE_MAX_ENERGY_RATIO times that of the
 * start. With too long a time step an accurate run may explode later. */
enum { RACE_EXTRA_STEPS = 2048, RACE_MAX_ENERGY_RATIO = 2 };

/* A run of the race: a method with a time step. */
typedef struct RaceResult {
    const IntegratorMethod *method;
    double h;              /* s, time step */
    double error;          /* m, largest error of a node; NaN: the run failed */
    double processor_time; /* s, processor time */
    bool converged;        /* every step converged */
    bool is_stable;        /* the energy stays bounded when the run goes on */
} RaceResult;

typedef struct MethodRace {
    int run_count; /* number of runs that were made so far */
    RaceResult result[RACE_METHODS * RACE_STEP_SIZES];
} MethodRace;

/* ---- how far the solver can be trusted ----------------------------------- */

enum { ENVELOPE_STEPS = 3, ENVELOPE_COLUMNS = 25, ENVELOPE_ROWS = 22 };

typedef struct ConvergenceCell {
    bool is_known;     /* the run of the cell was made */
    Status run_status; /* OK, or why a step failed or did not converge */
    int updates;       /* Newton updates of all steps */
} ConvergenceCell;

/* Whether the square converges, by stiffness (row) and time step (column). */
typedef struct ConvergenceMap {
    ConvergenceCell cell[ENVELOPE_ROWS][ENVELOPE_COLUMNS];
    int shown_column, shown_row; /* cell whose run is shown; -1: none */
} ConvergenceMap;

/* ---- data of all scenes, points and switches ----------------------------- */

/* Data of all small scenes; a scene uses what it needs. */
typedef struct SmallSceneData {
    double exact_start[4]; /* x (m) and v (m/s) where the exact path starts */
    double x_tilde[2];     /* inertial target (m); one unknown uses only [0] */
    unsigned switches;   /* bit s: 1 if switch s is on; with LAYER_SPRING_KINDS
                            1 if the springs of kind s are off */
    MinimiserCurve dial; /* curve of minimisers in scene `dial` */
    MethodRace race;     /* runs of scene `race` */
    ConvergenceMap envelope; /* runs of scene `envelope` */
} SmallSceneData;

/* Lists the points that can be dragged, m.  Returns how many there are. */
int exhibit_list_handles(const struct Simulation *simulation,
                         double at[SCENE_MAX_HANDLES][2]);

/* Lists the switches and whether each is on.  Returns how many there are. */
int exhibit_list_switches(const struct Simulation *simulation,
                          SceneSwitch out[SCENE_MAX_SWITCHES]);

/* Returns the switches that were turned since the start, bit s for switch s. */
unsigned exhibit_get_flip_bits(const struct Simulation *simulation);

/* Returns the kind of a spring: 0 horizontal, 1 vertical, 2, 3 diagonal. */
int exhibit_find_spring_kind(const struct Simulation *simulation, int spring);

/* Moves a point to (x, y), m, if finite; begins the scene again from there. */
void exhibit_drag_handle(struct Simulation *simulation, int handle, double x,
                         double y);
void exhibit_flip_switch(struct Simulation *simulation, int number);
