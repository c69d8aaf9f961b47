/* contact.h - nodes against walls and balls (slides: contact; lesson "Boundary
 * Treatments" of the lecture's author; Li et al.: Incremental Potential
 * Contact, 2020).
 *
 *          n                    A node i keeps the gap d to an obstacle:
 *          ^    o x_i             wall  d = n.(x_i - o)
 *          |    |                 ball  d = |x_i - x_b| - R
 *          |    | d             with n the direction from the obstacle to the
 *    ------o----+--------       node.  Below d_hat it is pushed away by the
 *    //////////////////////     barrier W = c f(s), s = d/d_hat.
 *
 * c = A d_hat kappa/2 in J, A the length of boundary that a node stands for.
 * Every node is tested: those inside become boundary where springs break.
 */
#ifndef ELASTO_CONTACT_H
#define ELASTO_CONTACT_H

#include "model/elements.h"
#include "model/square_mesh.h"

typedef enum ObstacleKind { OBSTACLE_WALL, OBSTACLE_BALL } ObstacleKind;

/* How an obstacle is moved: phase after phase, then it stands still. */
enum { MOTION_MAX_PHASES = 4 };

typedef struct Motion {
    int phases;
    double until[MOTION_MAX_PHASES]; /* s, end of the phase */
    double v[MOTION_MAX_PHASES][2];  /* m/s in it */
    bool stops;                      /* whether the obstacle stops at `stop` */
    double stop[2]; /* m, last place of the obstacle's point o */
} Motion;

typedef struct Obstacle {
    ObstacleKind kind;
    double o[2];   /* m, a point of the wall's surface, or the ball's centre;
                      not used where the ball is a node */
    double n[2];   /* the wall's unit normal, out of it; balls: not used */
    double radius; /* m, R > 0; walls: not used */
    Motion motion;
    double v[2];     /* m/s, its velocity in the present step */
    double friction; /* mu >= 0 */
    int node;        /* the ball's centre is this free node; -1: it is o */
    double given[2]; /* m, o as the options last gave it; a hand may have moved
                        the obstacle from there */
} Obstacle;

/* How the barrier acts. */
typedef struct Barrier {
    double d_hat; /* m, gap at which it begins */
    double c;     /* J, A d_hat kappa/2 */
} Barrier;

/* Where a node stands to an obstacle. */
typedef struct Gap {
    double d;    /* m; <= 0: penetration */
    double n[2]; /* unit vector from the obstacle to the node */
    double r;    /* m, |x_i - x_b|; a wall: infinite */
} Gap;

/* The point that the obstacle's gaps are measured from, in positions x [2n] m:
 * o, or the free node. */
const double *obstacle_origin(const Obstacle *obstacle, const double *x);

/* The gap of a node with this radius (a point: 0) at x_i [2] to an obstacle
 * whose point is at o [2]. */
Gap contact_measure_gap(const Obstacle *obstacle, const double *o,
                        const double *x_i, double radius);

/* -dW/dd >= 0, N, at the gap d > 0: the force that pushes the node along n. */
double contact_normal_force(const Barrier *barrier, double d);

/* ---- the term -------------------------------------------------------- */

/* Walls and balls of the command line, and a few that a scene moves. */
enum { CONTACT_MAX_OBSTACLES = 20 };

/* An obstacle that a hand draws to a point (push.c). */
typedef struct Push {
    bool on;          /* Whether a hand holds an obstacle. */
    int obstacle;     /* Number of the obstacle. */
    double to[2];     /* m, where the hand wants the obstacle's point o. */
    SquareMesh shape; /* Of the bodies: no ball enters their cells. */
    bool stopped;     /* Whether the obstacle was stopped in this step. */
    double moved;     /* Part of its way that it had made then. */
} Push;

/* The term's data. */
typedef struct Contact {
    Barrier barrier;
    int obstacles;
    Obstacle obstacle[CONTACT_MAX_OBSTACLES];
    int ball; /* the obstacle whose centre is a node, at most one; -1 */
    Push push;
} Contact;

/* sum of W over all pairs of nodes and obstacles, its elements, of which s is
 * the gap, n and r those of Gap; data: Contact. */
extern const TermKind contact_energy;

/* Puts the term in, gives it these obstacles, of which at most one has a node,
 * or takes it out where there are none.  Returns OK, OUT_OF_MEMORY. */
Status contact_set(System *system, const Barrier *barrier, int obstacles,
                   const Obstacle *obstacle);

/* The system's obstacles, or NULL. */
Contact *contact_of(const System *system);

/* Whether this node and this obstacle can touch: a ball does not touch itself,
 * nor a pinned node an obstacle that cannot give way. */
bool contact_has_pair(const Contact *contact, const System *system, int node,
                      int obstacle);

/* m, of a node: 0, a point, but for the centre of the free ball. */
double contact_node_radius(const Contact *contact, int node);

/* ---- an obstacle that a hand moves (push.c) ---------------------------- */

/* Before a step of h seconds from x [2n] m: sets the velocity of the obstacle
 * that a hand holds.  The obstacle goes a part of the way to the hand, with a
 * bounded speed.  It stands still where a node in front of it is pressed as
 * strongly as the hand can, and stops before pinned nodes that do not give way
 * and before its centre enters a cell. */
void push_begin_step(Contact *contact, const System *system, const double *x,
                     double h);

/* The largest part of a step's way that the held obstacle may make at once: a
 * ball half of its radius, so that it jumps over no node. */
double push_max_step(const Contact *contact, double h);

#endif
