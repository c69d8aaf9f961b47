/* time_integrator.h - one step forward in time (slide time_integrator.py).
 *
 * A method (methods.c) reads x and v of t_n and fills new_x and new_v of
 * t_n + h, which become x and v if they are finite.  An implicit method
 * minimises E in its stages: set_target writes u_tilde, set_x_v reads the
 * minimiser.  Newton's observer may pause a step, and time_integrator_continue
 * continues it. */
#pragma once

#include "solve/newton.h"

typedef struct TimeIntegrator TimeIntegrator;

typedef struct IntegratorMethod {
    const char *name;        /* name on the command line */
    const char *label;       /* name in the window */
    int order;               /* order of accuracy */
    bool supports_all_terms; /* works with every term: only backward Euler */
    bool is_damped;          /* numerical damping brings motion to rest */
    bool only_by_name;       /* the key M skips it */
    int history_arrays;      /* number of arrays [2n] kept between steps */
    int stages; /* stages of a step, each with a minimisation; 0: explicit */
    /* Fills newton->u_tilde, without gravity, and the weight of the integrator
     * for the present stage.  The caller then adds gravity to u_tilde by
     * completing the square:
     *   |u - u_tilde|_M^2/2 - weight m g.u
     *       = |u - (u_tilde + weight g)|_M^2/2 + constant. */
    void (*set_target)(TimeIntegrator *);
    /* Implicit methods read u, x of newton->iterate.  The last stage of an
     * implicit method, and an explicit method, fill new_x and new_v. */
    void (*set_x_v)(TimeIntegrator *);
} IntegratorMethod;

/* Time as a number of equal steps since h was last changed.  A sum of steps has
 * wrong last digits: 60 steps of 0.002 s would not be 0.12 s. */
typedef struct StepClock {
    double time;          /* s, h_change_time + steps h */
    double h_change_time; /* s, time of the last change of h */
    double h;             /* s, time step since h_change_time */
    long steps;           /* number of steps since the last change of h */
} StepClock;

struct TimeIntegrator {
    const IntegratorMethod *method;
    System *system;  /* not owned; terms may change the system */
    size_t x_length; /* 2n, length of x, v, new_x, new_v */
    double h;        /* s, time step */
    long steps;      /* steps so far */
    Status status;   /* status of the last step */
    StepClock clock; /* time of x and v */
    bool is_driven;  /* walls, pins or a pushed obstacle move in this step */
    double moved_fraction; /* fraction of the prescribed motion that is done */
    double external_work;  /* J, work of walls, pins and the hand so far */
    double *x;       /* [2n] m, positions; start of the block of all arrays */
    double *v;       /* [2n] m/s, velocities */
    double *new_x;   /* [2n] m, x at the end of a step; before that workspace */
    double *new_v;   /* [2n] m/s, v at the end; before that workspace */
    double *history; /* [history_arrays * 2n] data that the method keeps */
    double history_h; /* s, time step of `history`; 0: it is not valid */
    Newton *newton;   /* NULL for explicit methods */
    /* The following members describe an unfinished step. */
    int stage;                 /* 0 ... stages - 1 */
    Status stage_status;       /* OK, or why a stage did not converge */
    double weight;             /* s^2, factor of the potential P in E */
    double remaining_fraction; /* fraction that is left to move; 0 if blocked */
    int motion_parts_made;     /* number of parts of the motion that are done */
    long updates_before_step;  /* Newton's updates before this step */
    bool is_blocked; /* walls and pins cannot move on: a body is in their way */
};

/* The table of methods.  The last row has the name NULL. */
extern const IntegratorMethod integrator_methods[];

/* Returns the method with this name, or NULL. */
const IntegratorMethod *integrator_find_method(const char *name);

/* Whether the system has a term that the method is not right for. */
bool integrator_method_refuses_system(const IntegratorMethod *method,
                                      const System *system);

/* Allocates the run of a method on a system, and copies the start.
 *   settings  of Newton, with h; explicit methods use only h
 *   x, v      [2n] in, positions and velocities at time 0
 * Returns OK, OUT_OF_MEMORY, INVALID_INPUT (a term does not allow x, or the
 * method cannot serve a term or moving pins). */
Status time_integrator_create(const IntegratorMethod *method, System *system,
                              const NewtonSettings *settings, const double *x,
                              const double *v, TimeIntegrator *run);
void time_integrator_free(TimeIntegrator *run);

/* Begin a step, and continue the step to the end or the next pause.  The
 * functions return RUNNING before the end of the step.  At its end they return
 * OK; or a status for which status_is_unconverged holds, where the step has the
 * last iterate; or a failure, after which x and v are still those of t_n.  A
 * caller that abandons a step has to restore the terms' data and the walls. */
Status time_integrator_begin_step(TimeIntegrator *run);
Status time_integrator_continue(TimeIntegrator *run);

/* Makes a whole step.  Returns as time_integrator_continue does at the end. */
Status time_integrator_make_step(TimeIntegrator *run);
