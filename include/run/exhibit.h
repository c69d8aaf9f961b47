/* exhibit.h - the data of the lecture's small scenes, as far as it is not the
 * state of a run, and what the mouse drags and switches in them.  The data are
 * plain numbers and part of the saved state.
 */
#ifndef ELASTO_EXHIBIT_H
#define ELASTO_EXHIBIT_H

#include "run/scene.h"
#include "step/time_integrator.h"

typedef struct Simulation Simulation;

/* A guess of where the next step leads, and where it does lead. */
typedef struct Prediction {
    bool made;       /* the fields below are valid */
    long step;       /* number of steps when the guess was made */
    double at[2];    /* guess, m */
    double came[2];  /* end of the step, m */
    double distance; /* from guess to end, m; along x in one variable */
} Prediction;

/* ---- descents: a minimum that Newton looks for, update by update --------- */

/* Value, gradient and Hessian (xx, xy, yy) of E or f at a point, J s^2 and m.
 * A function of one unknown uses the first number of each; the others are 0. */
typedef struct Local {
    double value, g[2], H[3];
    int projected; /* springs whose Hessian the projection has changed */
} Local;

/* A function of one unknown. */
typedef Local ScalarEnergy(const Simulation *simulation, double x);

enum { DESCENT_MAX = 256 };

/* A minimisation that is shown iteration by iteration. */
typedef struct Descent {
    int count;                        /* iterations so far */
    NewtonRecord record[DESCENT_MAX]; /* the first iterations */
    double point[2];                  /* present iterate, m */
    double value;                     /* f or E at the iterate */
    double began;                     /* E where the search began */
    double direction[2];              /* p at the iterate, m; 0: none */
    double slope;         /* gradient times p; negative is downhill */
    bool by_gradient;     /* Algorithm 1, whose loop tests |g| */
    double residual;      /* tested number: |g|, or |p|/h in m/s */
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

/* RACE_SHOWN is the row of step sizes in the table of methods. */
enum { RACE_SHOWN = 1, RACE_METHODS = 7, RACE_STEP_SIZES = 7 };

/* An explicit run counts as stable if RACE_LONGER further steps, which are not
 * measured, leave the energy below RACE_ENERGY times that of the start: with
 * too long a time step a run may be accurate for a while and explode later. */
enum { RACE_LONGER = 2048, RACE_ENERGY = 2 };

/* A run of the race: a method with a time step. */
typedef struct RacePoint {
    const IntegratorMethod *method;
    double h;       /* s, time step */
    double error;   /* m, largest distance of a node from the reference; NaN:
                       the run failed */
    double seconds; /* s, processor time */
    bool converged; /* every step converged */
    double later;   /* energy after a second, over that of the start; only of
                       the runs of RACE_SHOWN */
    bool stable;    /* the energy stays bounded when the run goes on */
} RacePoint;

typedef struct Race {
    int count; /* runs so far */
    RacePoint point[RACE_METHODS * RACE_STEP_SIZES];
} Race;

/* ---- how far the solver can be trusted ----------------------------------- */

enum { ENVELOPE_STEPS = 3, ENVELOPE_COLUMNS = 25, ENVELOPE_ROWS = 22 };

typedef struct EnvelopeCell {
    bool known;
    Status worst; /* last status that is not OK */
    int updates;  /* Newton updates of all steps */
} EnvelopeCell;

/* Whether the square converges: a row for each stiffness, a column for each
 * time step. */
typedef struct EnvelopeMap {
    EnvelopeCell cell[ENVELOPE_ROWS][ENVELOPE_COLUMNS];
    int column, row; /* cell whose run is shown; -1: none */
} EnvelopeMap;

/* ---- all of it ----------------------------------------------------------- */

/* Data of all small scenes; a scene uses what it needs. */
typedef struct Exhibit {
    double began[4];  /* m, m/s, start x, v of the exact path of one mass */
    double target[2]; /* m, x_tilde; in one unknown its x */
    unsigned parts;   /* bit s: switch s is on; of landscape and dial enum
                         LandscapePart */
    DialCurve dial;
    Race race;
    EnvelopeMap map;
} Exhibit;

/* Lists the points that can be dragged, m, or the switches.
 * Each returns how many. */
int exhibit_handles(const struct Simulation *simulation,
                    double at[SCENE_MAX_HANDLES][2]);
int exhibit_switches(const struct Simulation *simulation,
                     Switch out[SCENE_MAX_SWITCHES]);

/* Bit s: switch s differs from the start of the scene. */
unsigned exhibit_flips(const struct Simulation *simulation);

/* Whether the switches are the kinds of springs, which a page asks for. */
bool exhibit_has_kinds(const struct Simulation *simulation);

/* Kind of a spring: 0 horizontal, 1 vertical, 2 and 3 the diagonals. */
int exhibit_kind(const struct Simulation *simulation, int spring);

/* Moves a point to (x, y), m, and begins the scene again from there; without
 * effect if x or y is not finite. */
void exhibit_drag(struct Simulation *simulation, int handle, double x,
                  double y);

/* Turns a switch over. */
void exhibit_flip(struct Simulation *simulation, int number);

#endif
