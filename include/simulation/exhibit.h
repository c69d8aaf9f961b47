/* exhibit.h - data of the lecture's small scenes, which are part of the saved
 * state, and the points and switches that a user can move in them. */
#pragma once

#include "simulation/scene.h"
#include "step/time_integrator.h"

typedef struct Simulation Simulation;

/* A user's guess where the next step leads, and where the step does lead. */
typedef struct Prediction {
    bool has_guess;    /* the user has made a guess */
    long guess_step;   /* steps of the simulation when the user guessed */
    double guess[2];   /* m, the guess */
    double outcome[2]; /* m, where the step does lead */
    double error;      /* m, `guess` to `outcome`; in one variable along x */
} Prediction;

/* ---- descents: minimisation by Newton's method, update by update --------- */

/* Value, gradient and Hessian (xx, xy, yy) of E or f at a point, in J s^2 and
 * m.  A function of one unknown uses g[0] and H[0]; the other numbers are 0. */
typedef struct LocalModel {
    double energy, g[2], H[3]; /* E; gradient; Hessian xx, xy, yy */
    int projected_springs; /* number of springs whose Hessian was projected */
} LocalModel;

/* Evaluates a function of one unknown at x. */
typedef LocalModel ScalarEnergy(const Simulation *simulation, double x);

enum { DESCENT_MAX_RECORDS = 256 };

/* A minimisation that is shown iteration by iteration. */
typedef struct Descent {
    int count;                                /* number of records */
    NewtonRecord record[DESCENT_MAX_RECORDS]; /* records of first iterations */
    double iterate[2];                        /* present iterate (m) */
    double value;                             /* f or E at the iterate */
    double start_value;                       /* E at the start of the search */
    double direction[2]; /* p at the iterate (m); 0: none */
    double slope;        /* gradient times p; negative is downhill */
    bool tests_g;        /* Algorithm 1, whose loop tests |g|, not |p| */
    double residual;     /* compared with the tolerance: |g|, or |p|/h in m/s */
    ScalarEnergy *scalar; /* function of one unknown; NULL: two unknowns */
} Descent;

/* Parts of E on the map of landscape. */
enum LandscapePart {
    PART_INERTIA = 1,    /* |x - x_tilde|_M^2 / 2 */
    PART_ELASTICITY = 2, /* h^2 P(x) */
    PART_BOTH = 3
};

/* The minimiser of E as a function of the time step h. */
enum { DIAL_POINTS = 41 };

typedef struct DialCurve {
    double h[DIAL_POINTS];        /* s, ascending */
    double point[DIAL_POINTS][2]; /* m, minimiser for each h */
} DialCurve;

/* ---- run time against error ---------------------------------------------- */

#define RACE_TIME 0.064 /* s, simulated time of each run */

/* RACE_SHOWN_ROW is the step size whose runs the table of methods shows. */
enum { RACE_SHOWN_ROW = 1, RACE_METHODS = 4, RACE_STEP_SIZES = 7 };

/* An explicit run counts as stable if RACE_EXTRA_STEPS further steps, which are
 * not measured, leave the energy below RACE_MAX_ENERGY_RATIO times that of the
 * start. With too long a time step an accurate run may explode later. */
enum { RACE_EXTRA_STEPS = 2048, RACE_MAX_ENERGY_RATIO = 2 };

/* A run of the race: a method with a time step. */
typedef struct RacePoint {
    const IntegratorMethod *method;
    double h;       /* s, time step */
    double error;   /* m, largest distance from the reference; NaN: failed */
    double seconds; /* s, processor time */
    bool converged; /* every step converged */
    bool is_stable; /* the energy stays bounded when the run goes on */
} RacePoint;

typedef struct Race {
    int count; /* number of runs that were made so far */
    RacePoint point[RACE_METHODS * RACE_STEP_SIZES];
} Race;

/* ---- how far the solver can be trusted ----------------------------------- */

enum { ENVELOPE_STEPS = 3, ENVELOPE_COLUMNS = 25, ENVELOPE_ROWS = 22 };

typedef struct EnvelopeCell {
    bool is_known;     /* the run of the cell was made */
    Status bad_status; /* OK, or the last other status of all steps */
    int updates;       /* Newton updates of all steps */
} EnvelopeCell;

/* Whether the square converges, by stiffness (row) and time step (column). */
typedef struct EnvelopeMap {
    EnvelopeCell cell[ENVELOPE_ROWS][ENVELOPE_COLUMNS];
    int column, row; /* cell whose run is shown; -1: none */
} EnvelopeMap;

/* ---- data of all scenes, points and switches ----------------------------- */

/* Data of all small scenes; a scene uses what it needs. */
typedef struct SmallSceneData {
    double exact_start[4]; /* x (m) and v (m/s) where the exact path starts */
    double x_tilde[2];     /* x_tilde (m); in one unknown only [0] */
    unsigned switches;     /* bit s: part s of E is on (LandscapePart); for
                              switches of kinds of springs, kind s is off */
    DialCurve dial;        /* minimisers of scene `dial` */
    Race race;             /* runs of scene `race` */
    EnvelopeMap envelope;  /* runs of scene `envelope` */
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
