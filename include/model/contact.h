/* contact.h - contact of nodes with walls and balls (slides: contact; lesson
 * "Boundary Treatments" of the lecture's author; Li et al.: Incremental
 * Potential Contact, 2020).
 *
 *          n                    The gap d between node i and an obstacle is
 *          ^    o x_i             wall  d = n.(x_i - o)
 *          |    |                 ball  d = |x_i - x_b| - R
 *          |    | d             with n the unit vector from the obstacle to the
 *    ------o----+--------       node.  For d < d_hat the barrier energy
 *    //////////////////////       W = c f(d/d_hat), f of barrier.h
 *                               pushes the node away.
 *
 * c = A d_hat kappa/2 in J, where A is the length of boundary for each node.
 * Every node is tested, since a break turns inner nodes into boundary. */
#pragma once

#include "model/elements.h"
#include "model/square_mesh.h"

typedef enum ObstacleKind { OBSTACLE_WALL, OBSTACLE_BALL } ObstacleKind;

enum { MOTION_MAX_PHASES = 4 };

/* Prescribed motion of an obstacle: phases of constant velocity, then rest. */
typedef struct ObstacleMotion {
    int phase_count;
    double phase_end[MOTION_MAX_PHASES]; /* s, end of the phase */
    double v[MOTION_MAX_PHASES][2];      /* m/s, velocity in the phase */
} ObstacleMotion;

typedef struct Obstacle {
    ObstacleKind kind; /* wall or ball */
    double o[2];   /* m, point of a wall's surface, centre of a fixed ball */
    double n[2];   /* outward unit normal of a wall; not used for balls */
    double radius; /* m, R > 0; not used for walls */
    ObstacleMotion motion;
    double v[2];   /* m/s, velocity in the present step */
    double mu;     /* coefficient of friction mu >= 0 */
    int ball_node; /* node at the centre of a free ball; -1: not free */
    double configured_o[2]; /* m, o in the options, before any motion */
} Obstacle;

/* Width and strength of the barrier. */
typedef struct Barrier {
    double d_hat; /* m, gap at which the barrier begins */
    double c;     /* J, factor in W = c f(d/d_hat) */
} Barrier;

/* Gap between a node and an obstacle. */
typedef struct NodeGap {
    double d;    /* m; d <= 0: the node is inside the obstacle */
    double n[2]; /* unit vector from the obstacle to the node */
    double r;    /* m, |x_i - x_b| for a ball, infinite for a wall */
} NodeGap;

/* Returns the point o of an obstacle, or the node at the centre of the free
 * ball.  x [2n] m, in. */
const double *obstacle_get_position(const Obstacle *obstacle, const double *x);

/* Measures the gap between a node and an obstacle.
 *   o       [2] m, in, position of the obstacle's point
 *   x_i     [2] m, in, position of the node
 *   radius  m, of the node; 0 for a point */
NodeGap contact_measure_gap(const Obstacle *obstacle, const double *o,
                            const double *x_i, double radius);

/* Returns the force -dW/dd >= 0 (N) on the node along n at the gap d > 0. */
double contact_normal_force(const Barrier *barrier, double d);

/* Largest number of obstacles that a command line and a scene have together. */
enum { CONTACT_MAX_OBSTACLES = 20 };

/* An obstacle that a hand pulls to a point (push.c). */
typedef struct ObstaclePush {
    bool is_held;       /* whether a hand holds an obstacle */
    int obstacle_index; /* number of the obstacle */
    double target[2];   /* m, target of the obstacle's point o */
    SquareMesh mesh;    /* mesh of the bodies, whose cells no ball may enter */
    bool is_blocked;    /* the obstacle found no room to move in this step */
    double moving_fraction; /* fraction of the step before the obstacle stops */
} ObstaclePush;

typedef struct Contact {
    Barrier barrier;
    int obstacle_count;
    Obstacle obstacle[CONTACT_MAX_OBSTACLES];
    int free_ball_index; /* ball whose centre is a node; -1: none */
    ObstaclePush push;   /* obstacle held by a hand */
} Contact;

/* The sum of W over all pairs of a node and an obstacle; data: Contact.  In
 * the Element of a pair, s is the gap d; n and r are those of its NodeGap. */
extern const TermKind contact_energy;

/* Adds the term or replaces its obstacles; removes the term if obstacles is 0.
 *   obstacle  [obstacles] in, at most one of them a free ball
 * Returns OK or OUT_OF_MEMORY. */
Status contact_configure(System *system, const Barrier *barrier, int obstacles,
                         const Obstacle *obstacle);

/* Returns the data of the contact term; NULL: the system has no obstacles. */
Contact *get_contact(const System *system);

/* Whether the energy of this node and this obstacle counts.  The free ball's
 * own node does not count, nor a fixed node at a fixed obstacle. */
bool contact_includes_pair(const Contact *contact, const System *system,
                           int node, int obstacle);

/* Returns the radius of a node (m): R of the free ball; 0 for others. */
double contact_node_radius(const Contact *contact, int node);

/* ---- obstacle moved by a hand (push.c) --------------------------------- */

/* Sets the velocity of the held obstacle before a step of h seconds from x [2n]
 * m.  The obstacle moves part of the way to its target, with a bounded speed.
 * The obstacle rests if a node in front feels the hand's full force, and stops
 * before fixed nodes, and before its centre enters a cell. */
void push_begin_step(Contact *contact, const System *system, const double *x,
                     double h);

/* Returns the largest fraction of a step's way that the held obstacle may move
 * at once: a ball moves at most half its radius, so that it skips no node. */
double push_max_move_fraction(const Contact *contact, double h);
