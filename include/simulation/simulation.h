/* simulation.h - a scene while it moves, in one to three runs side by side.
 * Each run has an integrator and a state of its own. */
#pragma once

#include "simulation/exhibit.h"
#include "simulation/message.h"
#include "simulation/options.h"
#include "simulation/scene.h"
#include "solve/newton.h"
#include "model/square_mesh.h"

enum { SIMULATION_MAX_RUNS = 3, SIMULATION_MAX_MODE_NODES = 64 };

/* Energies that a run has added up since its start.  In a step of backward
 * Euler the total energy can grow by more than the work: the minimiser may lie
 * behind a barrier of energy, such as another body. */
typedef struct EnergyLedger {
    double start_energy; /* J, total energy at the start */
    double user_work;    /* J, work of the user's changes of nodes, options and
                            pins */
    double latest_balance; /* J, total energy minus work, after the last step */
    long gain_steps;      /* steps in which energy grew by more than the work */
    double gained_energy; /* J, energy gained beyond the work in gain_steps */
} EnergyLedger;

struct Simulation {
    const Scene *scene;
    Options options;
    SquareMesh mesh; /* mesh of the square; zero in other scenes */
    System system;   /* system of run 0, which all runs may share */
    System run_system[SIMULATION_MAX_RUNS]; /* own systems of runs 1, 2 */
    int runs; /* number of runs, 1 ... SIMULATION_MAX_RUNS */
    TimeIntegrator run[SIMULATION_MAX_RUNS];
    EnergyLedger ledger[SIMULATION_MAX_RUNS];
    int current_run;   /* run whose step is being computed */
    Status bad_status; /* OK, or the last other status of this step's runs */
    Descent descent;   /* minimisation; zero in scenes that move in time */
    SmallSceneData exhibit;    /* data of the small scenes; switches */
    UserPrediction prediction; /* guess where the next step leads */
    NewtonObserver observer;   /* called after each Newton iteration, or NULL */
    void *observer_data;       /* argument of observer */
    long steps;                /* steps so far */
    long unconverged_steps;    /* steps so far that did not converge */
    int status_counts[STATUS_COUNT]; /* unconverged steps by their status */
    Status status;                   /* status of the last step */
    bool is_over; /* the scene has ended: a step does nothing */
    NewtonCounters replaced_counters; /* counters of replaced integrators */
};

/* A quantity of energy by its name: "elastic", "friction". */
typedef struct Energy {
    const char *name; /* static text, not to be freed */
    double value;     /* J */
} Energy;

/* The energies of a run, J.  A run holds
 *   total = kinetic + gravity + what the terms store (TermKind.energy_name)
 * and its balance since the start is
 *   total at the start + work
 *     = total + what terms took out (TermKind.loss_name) + dissipated.
 * A term has its own energy; several terms may share a name.
 *
 * The work of a moving wall, pin or hand is its force at the end of the step
 * times its displacement, with error O(h): backward Euler then dissipates in
 * every step where the potential is convex.  Where the potential is not convex
 * (springs buckle, contacts turn, as in squeeze and rub) `dissipated` may fall:
 * the method has added energy.  The mean of the forces at both ends would have
 * a smaller error where a body is pressed, but `dissipated` would fall more. */
enum { MAX_ENERGIES = 2 * SYSTEM_MAX_TERMS + 5 };

typedef struct Energies {
    double kinetic, gravity, total; /* J */
    double work;                    /* work of walls, pins, hand, user_work */
    double dissipated; /* energy that the integrator took out; < 0: added */
    int count;         /* number of energies */
    Energy energy[MAX_ENERGIES]; /* in the order of the plots' legend */
} Energies;

/* Creates the simulation of options->scene; free it in any case.
 *   observer    called with `user` after each Newton iteration, or NULL
 *   simulation  out
 * Returns OK, OUT_OF_MEMORY, TOO_LARGE, INVALID_INPUT. */
Status simulation_create(const Options *options, NewtonObserver observer,
                         void *user, Simulation *simulation);
void simulation_free(Simulation *simulation);

/* Copies the settings of Newton's method from the options. */
void options_fill_newton_settings(const Options *options,
                                  NewtonSettings *settings);

/* Creates the integrator of a run, which starts at x with velocities v. */
Status simulation_start_run(Simulation *simulation, int run,
                            const IntegratorMethod *method, System *system,
                            const double *x, const double *v);

/* Makes one step: a time step of every run, or one Scene.step; a scene that is
 * done makes none.  The result depends only on the state (control.h) and the
 * settings, to the last bit: data that solvers keep changes no bit.
 * Returns OK; an unconverged status, with which the step was made; or a
 * failure, and the run that failed did not move. */
Status simulation_step(Simulation *simulation);

/* Makes one step in parts: call simulation_begin_step, then simulation_advance
 * while it returns RUNNING, which happens after each Newton iteration for which
 * the observer asks for a pause.  The last status is as from simulation_step.
 * A step that is left before its end must be followed by state_restore. */
Status simulation_begin_step(Simulation *simulation);
Status simulation_advance(Simulation *simulation);

/* Returns the simulated time, s; 0 in scenes without time. */
double simulation_get_time(const Simulation *simulation);

/* Computes the energies of a run. */
Energies simulation_get_energies(const Simulation *simulation, int run);

/* Whether run 0 is at rest: nodes hardly move, and forces nearly vanish. */
bool simulation_is_at_rest(const Simulation *simulation);

/* Returns Newton's counters, summed over the runs; explicit methods have 0. */
NewtonCounters simulation_sum_newton_counters(const Simulation *simulation);

/* Returns when a change of row's option takes effect, usually row->effect.  The
 * result is EFFECT_NEW_RUN for the method of several runs, and in scenes
 * without time; with HAS_START such a scene keeps EFFECT_REPEATED_STEP. */
EffectTime simulation_find_option_effect(const Simulation *simulation,
                                         const OptionRow *row);

/* Checks that obstacles of changed options overlap no body at its present
 * place.  Returns OK, or INVALID_INPUT with a message. */
Status simulation_check_clearance(const Simulation *simulation,
                                  const Options *options, Message message);

/* Returns the fraction of the straight way to a point that an obstacle can
 * move: 1 if there is room at the end, else the fraction up to the first body.
 *   number  of the obstacle: grounds first, then balls
 *   to      [2] m, in, the point */
double simulation_find_free_fraction(const Simulation *simulation,
                                     const Options *options, int number,
                                     const double to[2]);

/* Whether the mouse can drag the nodes. */
bool simulation_is_draggable(const Simulation *simulation);

/* Whether a time step consists of updates of Newton's method. */
bool simulation_has_newton_updates(const Simulation *simulation);

/* Whether the method projects a Hessian, and whether the method searches along
 * a line.  Explicit integrators do neither. */
bool simulation_has_projection(const Simulation *simulation);
bool simulation_has_line_search(const Simulation *simulation);

/* Whether springs are the only terms whose Hessian may need the projection. */
bool simulation_projects_only_springs(const Simulation *simulation);

/* Finds the point that a scene shows: the iterate, or the only mass of run 0.
 *   at  [2] out, m
 * Returns how many coordinates are used: 1 for a function of one variable, 0 if
 * the scene has several points. */
int simulation_find_shown_point(const Simulation *simulation, double at[2]);

/* Finds the fastest small oscillation around x, M mode'' = -H mode, with the
 * Hessian H of P, not projected.  Returns its angular frequency, 1/s; NaN if no
 * mode oscillates, or with more than SIMULATION_MAX_MODE_NODES nodes.
 *   x     [2n] m, in
 *   mode  [2n] out, of length 1 */
double simulation_find_max_omega(const Simulation *simulation, const double *x,
                                 double *mode);
