/* simulation.h - what a scene set up, while it runs.
 *
 * A system and one or more runs of it, each with its own integrator and state;
 * all scenes but the comparison of integrators have one run.
 */
#ifndef ELASTO_SIMULATION_H
#define ELASTO_SIMULATION_H

#include "run/exhibit.h"
#include "run/options.h"
#include "run/scene.h"
#include "solve/newton.h"
#include "model/square_mesh.h"

enum { SIMULATION_MAX_RUNS = 3, SIMULATION_MODE_NODES = 64 };

/* Steps of backward Euler after which the total energy was higher than before,
 * by more than the work that was done: the minimiser may lie behind a barrier
 * that no motion would pass, a body on the other side of another one. */
typedef struct Gain {
    long steps;
    double energy; /* J, all that was gained in them */
} Gain;

struct Simulation {
    const Scene *scene;
    Options options;                  /* what it was set up with */
    SquareMesh mesh;                  /* zeroed in scenes without a square */
    System system;                    /* of run 0, and of all others but */
    System more[SIMULATION_MAX_RUNS]; /* where runs differ: run 1, 2 */
    int runs;
    int stepping; /* the run whose step is made, while it is made */
    Status worst; /* of the runs before it */
    TimeIntegrator run[SIMULATION_MAX_RUNS];
    double start[SIMULATION_MAX_RUNS]; /* J, total energy when it began */
    Descent descent;       /* zeroed in scenes that move through time */
    Exhibit exhibit;       /* zeroed in scenes without one */
    Prediction prediction; /* of where the next step leads */
    double work[SIMULATION_MAX_RUNS]; /* J, done by the hand in each run */
    double grip[SIMULATION_MAX_RUNS]; /* a run's friction is that of the options
                                         times this; 0: 1 */
    double lift[SIMULATION_MAX_RUNS]; /* m, its grounds are so much higher */
    Gain gain[SIMULATION_MAX_RUNS];   /* of each run */
    double before;           /* J, energy of the present run before its step,
                                less the work done until then */
    bool done;               /* the scene came to its end: no more steps */
    NewtonObserver observer; /* called after each Newton iteration, or NULL */
    void *user;
    long steps;                /* done so far */
    long unconverged;          /* of them not converged */
    int reasons[STATUS_COUNT]; /* how many of these ended in this way */
    Status status;             /* of the last step */
    NewtonCounters counted;    /* by solvers that are no more */
};

/* A quantity of the ledger by its name: "elastic", "friction". */
typedef struct Energy {
    const char *name; /* not owned */
    double value;     /* J */
} Energy;

/* The ledger of a run, J.  What it holds now:
 *   total = kinetic + gravity + what the terms store (TermKind.energy)
 * and where the rest has gone since it began:
 *   total at the start + work
 *     = total + what the terms have taken out (TermKind.loss) + dissipated.
 * Each term books for itself; several may share a name.
 *
 * The work of what moves is that of the force at the end of the step, times the
 * way: right to O(h), and with it backward Euler dissipates in every step where
 * the potential is convex.  Where it is not (springs buckle, contacts turn, as
 * in squeeze and rub), dissipated may fall: the method has made energy.  The
 * mean of both forces would be smaller where something is pressed, and let it
 * fall in convex potentials, too. */
enum { ENERGY_ROWS = 2 * SYSTEM_MAX_TERMS + 5 };

typedef struct Energies {
    double kinetic, gravity, total;
    double work;       /* done by what moves walls, pins and the hand */
    double dissipated; /* by the integrator; < 0: it has made energy */
    int rows;
    Energy row[ENERGY_ROWS]; /* all, as legends have it: total first */
} Energies;

/* Sets up options->scene.  simulation out; free it in any case.
 *   observer, user  called after each Newton iteration, or NULL
 * Returns OK, OUT_OF_MEMORY, TOO_LARGE, INVALID_INPUT. */
Status simulation_create(const Options *options, NewtonObserver observer,
                         void *user, Simulation *simulation);
void simulation_free(Simulation *simulation);

/* For a scene's create: what its options say to Newton's method; and run 0, 1,
 * ... of it, as time_integrator_create makes it. */
void newton_settings_take(const Options *options, NewtonSettings *settings);
Status simulation_start(Simulation *simulation, int run,
                        const IntegratorMethod *method, System *system,
                        const double *x, const double *v);

/* One step: of time in every run, or one Newton iteration; none where
 * simulation->done.  A pure function of the state (control.h) and the settings:
 * solvers keep nothing from step to step that changes a bit.
 * OK; an unconverged status: the step was made; a failure: nothing moved in the
 * run that failed. */
Status simulation_step(Simulation *simulation);

/* The same with pauses, where Newton's observer asks for them: begin, then
 * advance while it returns RUNNING; at the end as simulation_step.  After a
 * step that is left before its end state_restore has to follow. */
Status simulation_begin(Simulation *simulation);
Status simulation_advance(Simulation *simulation);

/* Simulated time, s; 0 in scenes where no time passes. */
double simulation_time(const Simulation *simulation);

/* Energies of one run, computed now. */
Energies simulation_energies(const Simulation *simulation, int run);

/* Whether run 0 is at rest: within a frame, and a step, no node moves by more
 * than a millionth of the shortest spring, and the forces balance within a
 * thousandth of its length.  The first alone would be true at a turning point,
 * too. */
bool simulation_rests(const Simulation *simulation);

/* Sum over the runs of what Newton did; zero where all are explicit. */
NewtonCounters simulation_counters(const Simulation *simulation);

/* When another number of this row takes effect here: as the row says, but in
 * scenes of other runs, and where each run has a method of its own, at a
 * start. */
Effect simulation_effect(const Simulation *simulation, const OptionRow *row);

/* Whether the obstacles of other options leave room for the bodies as they are:
 * OK; INVALID_INPUT where not.
 *   message  [size] out, one line then */
Status simulation_has_room(const Simulation *simulation, const Options *options,
                           char *message, size_t size);

/* How far a ground or, numbered on, a ball of these options can be moved
 * straight towards `to` [2] m: all of the way, 1, if there is room at its end;
 * else the part of it before it touches a body. */
double simulation_way(const Simulation *simulation, const Options *options,
                      int number, const double to[2]);

/* Puts a node at (x, y), m, at rest; really: else it is only tried.  What this
 * does to the energy is booked as work.
 * Returns OK; INVALID_INPUT: there is no such node, or a cell would be turned
 * over there, or an obstacle is. */
Status simulation_place(Simulation *simulation, int node, double x, double y,
                        bool really);

/* Whether a hand can take hold of its nodes. */
bool simulation_is_handled(const Simulation *simulation);

/* Whether there is a Hessian to project and a line to search (not in explicit
 * integrators). */
bool simulation_has_projection(const Simulation *simulation);
bool simulation_has_line_search(const Simulation *simulation);

/* Whether the blocks that a projection may change are those of the springs
 * alone: one each, and none of contact or cells. */
bool simulation_projects_springs(const Simulation *simulation);

/* The point that a scene is about, m: the iterate, or node 0 of run 0; at [2]
 * out.  Returns how many of its coordinates count: 1 where a minimum in one
 * variable is searched, 0 where there is no single point. */
int simulation_point(const Simulation *simulation, double at[2]);

/* omega of the fastest small oscillation around x [2n], 1/s: M mode'' = -H mode
 * with the Hessian of P as it is; NaN where there is none, or more nodes.
 *   mode  [2n] out, its length is 1 */
double simulation_fastest(const Simulation *simulation, const double *x,
                          double *mode);

#endif
