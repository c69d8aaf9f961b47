/* exhibit.h - what the lecture's small scenes keep beside the states of their
 * runs: plain numbers without pointers to what they own.
 */
#ifndef ELASTO_EXHIBIT_H
#define ELASTO_EXHIBIT_H

#include <stdbool.h>

#include "base/status.h"

struct IntegratorMethod;

/* "Predict, then show": where somebody thinks that the next step leads. */
typedef struct Prediction {
    bool made;       /* at is a guess */
    bool shown;      /* the step was made: came and distance are valid */
    double at[2];    /* m */
    double came[2];  /* m, where it led */
    double distance; /* m, between the two; along x in one variable */
} Prediction;

/* The parts of E on the map of the landscape. */
enum LandscapePart {
    PART_INERTIA = 1,    /* |x - x_tilde|_M^2 / 2 */
    PART_ELASTICITY = 2, /* h^2 P(x) */
    PART_BOTH = 3
};

/* What is minimised, at a point: E or f, its gradient and its Hessian, J s^2
 * and m; of one unknown the first of each counts, the others are 0. */
typedef struct Local {
    double value, g[2], H[3]; /* xx, xy, yy */
    int projected;            /* springs that a filter has changed in H */
} Local;

/* A function of one unknown. */
struct Simulation;
typedef Local ScalarEnergy(const struct Simulation *simulation, double x);

/* The minimiser of E for one time step after the other. */
enum { WALK_POINTS = 41 };

typedef struct Walk {
    double h[WALK_POINTS];        /* s, ascending */
    double point[WALK_POINTS][2]; /* m */
} Walk;

/* One run of the race: a method with a time step. */
enum { RACE_POINTS = 64 };

typedef struct RacePoint {
    const struct IntegratorMethod *method;
    double h;       /* s */
    long steps;     /* that it took */
    double error;   /* m, largest distance of a node from where it belongs;
                       NaN: the run failed */
    double seconds; /* run time */
    long updates;   /* Newton updates; 0 in explicit methods */
    bool stable;    /* its energy stays bounded when it runs on */
} RacePoint;

typedef struct Race {
    int count; /* runs so far */
    RacePoint point[RACE_POINTS];
} Race;

/* Where the square converges: a row for each stiffness, a
 * column for each time step. */
enum { ENVELOPE_COLUMNS = 25, ENVELOPE_ROWS = 22 };

typedef struct EnvelopeCell {
    bool known;
    Status worst; /* OK: all steps passed the test */
    int updates;  /* Newton updates of all its steps */
    bool undone;  /* there were none, and it is not at rest: the test let the
                     forces pass */
} EnvelopeCell;

typedef struct EnvelopeMap {
    EnvelopeCell cell[ENVELOPE_ROWS][ENVELOPE_COLUMNS];
    int column, row; /* the cell whose run is shown; -1: none yet */
} EnvelopeMap;

typedef struct Exhibit {
    double began[4]; /* m, m/s: x and v from which one mass's exact path goes */
    double target[2]; /* m, x_tilde; of one unknown its x */
    unsigned parts;   /* that are switched on: enum LandscapePart; of one spring
                         1: the energy with the square root too */
    Walk walk;
    Race race;
    EnvelopeMap map;
} Exhibit;

#endif
