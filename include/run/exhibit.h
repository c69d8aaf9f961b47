/* exhibit.h - what the lecture's small scenes keep beside the states of their
 * runs: plain numbers, part of the state; and what the mouse drags and
 * switches in them.
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
    double came[2];  /* where the step leads, m */
    double distance; /* between the two, m; along x in one variable */
} Prediction;

/* ---- descents: a minimum that Newton looks for, update by update --------- */

/* What is minimised, at a point: E or f, its gradient and its Hessian, J s^2
 * and m; of one unknown the first of each counts, the others are 0. */
typedef struct Local {
    double value, g[2], H[3]; /* xx, xy, yy */
    int projected;            /* springs that a projection has changed in H */
} Local;

/* A function of one unknown. */
typedef Local ScalarEnergy(const Simulation *simulation, double x);

enum { DESCENT_MAX = 256 };

/* The path of a minimisation that is shown iteration by iteration. */
typedef struct Descent {
    int count;                        /* iterations so far */
    NewtonRecord record[DESCENT_MAX]; /* the first DESCENT_MAX of them */
    double point[2];                  /* the present iterate */
    double value;                     /* f or E there */
    double began;                     /* E where the search began */
    double direction[2];              /* p there, m; 0 if there is none */
    double slope;                     /* grad . p there; < 0 is downhill */
    bool by_gradient;     /* Algorithm 1 runs: its loop tests |g|, not |p|/h */
    double residual;      /* what is tested, there: |g|, or |p|/h, m/s */
    ScalarEnergy *scalar; /* of one unknown; NULL: of two */
} Descent;

/* The parts of E on the map of the landscape. */
enum LandscapePart {
    PART_INERTIA = 1,    /* |x - x_tilde|_M^2 / 2 */
    PART_ELASTICITY = 2, /* h^2 P(x) */
    PART_BOTH = 3
};

/* The minimiser of E for one time step after the other. */
enum { WALK_POINTS = 41 };

typedef struct Walk {
    double h[WALK_POINTS];        /* s, ascending */
    double point[WALK_POINTS][2]; /* m */
} Walk;

/* ---- run time against error ---------------------------------------------- */

#define RACE_TIME 0.064 /* s, that every run covers */

/* RACE_SHOWN: the row of h, h/2 and h/4 in the table of methods. */
enum { RACE_SHOWN = 1, RACE_METHODS = 7, RACE_STEP_SIZES = 7 };

/* Steps that explicit runs go on, unmeasured, for with too long a time step a
 * run may be accurate for a while and explode later; and how often the energy
 * at their end may be that at the start. */
enum { RACE_LONGER = 2048, RACE_ENERGY = 2 };

/* One run of the race: a method with a time step. */
typedef struct RacePoint {
    const IntegratorMethod *method;
    double h;       /* s */
    double error;   /* m, largest distance of a node from where it belongs;
                       NaN: the run failed */
    double seconds; /* run time, of the processor */
    bool converged; /* in all steps */
    double later;   /* what is left of the energy at the start after a second,
                       of the runs of RACE_SHOWN */
    bool stable;    /* its energy stays bounded when it runs on */
} RacePoint;

typedef struct Race {
    int count; /* runs so far */
    RacePoint point[RACE_METHODS * RACE_STEP_SIZES];
} Race;

/* ---- how far the solver can be trusted ----------------------------------- */

enum { ENVELOPE_STEPS = 3, ENVELOPE_COLUMNS = 25, ENVELOPE_ROWS = 22 };

typedef struct EnvelopeCell {
    bool known;
    Status worst; /* OK: all steps passed the test */
    int updates;  /* Newton updates of all its steps */
} EnvelopeCell;

/* Where the square converges: a row for each stiffness, a column for each time
 * step. */
typedef struct EnvelopeMap {
    EnvelopeCell cell[ENVELOPE_ROWS][ENVELOPE_COLUMNS];
    int column, row; /* the cell whose run is shown; -1: none yet */
} EnvelopeMap;

/* ---- all of it ----------------------------------------------------------- */

typedef struct Exhibit {
    double began[4]; /* m, m/s: x and v from which one mass's exact path goes */
    double target[2]; /* m, x_tilde; of one unknown its x */
    unsigned parts;   /* that are switched on: enum LandscapePart; of one spring
                         1: the energy with the square root too; of the race
                         1: over h instead of run time */
    Walk walk;
    Race race;
    EnvelopeMap map;
} Exhibit;

/* The points that can be dragged, m: at out; the parts that can be switched.
 * Both return how many. */
int exhibit_handles(const struct Simulation *simulation,
                    double at[SCENE_MAX_HANDLES][2]);
int exhibit_switches(const struct Simulation *simulation,
                     Switch out[SCENE_MAX_SWITCHES]);

/* Bit s: switch s is not as the scene begins by itself. */
unsigned exhibit_flips(const struct Simulation *simulation);

/* On a page that has them as switches: the kind of a spring, 0 ... 3. */
bool exhibit_has_kinds(const struct Simulation *simulation);
int exhibit_kind(const struct Simulation *simulation, int spring);

/* Moves one of the points, and all that hangs on it, to (x, y), which may be no
 * place for it; switches a part.  The number is below how many there are. */
void exhibit_drag(struct Simulation *simulation, int handle, double x,
                  double y);
void exhibit_flip(struct Simulation *simulation, int number);

#endif
