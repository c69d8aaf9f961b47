/* time_integrator.h - one step forward in time (slide time_integrator.py).
 *
 * A method (methods.c) reads x and v, those of t_n, and fills new_x and new_v,
 * those of t_n + h, which become x and v unless one of them is not finite.
 * Explicit ones do so at once.  Implicit ones minimise E once or, stage by
 * stage, several times: aim says what, land reads the minimiser.
 *
 * Newton's observer may pause a step, which time_integrator_advance continues.
 */
#ifndef ELASTO_TIME_INTEGRATOR_H
#define ELASTO_TIME_INTEGRATOR_H

#include "solve/newton.h"

typedef struct TimeIntegrator TimeIntegrator;

typedef struct IntegratorMethod {
    const char *name;  /* as on the command line */
    const char *label; /* as in the window */
    int order;         /* of accuracy */
    bool implicit;     /* needs Newton */
    bool at_end;       /* x_(n+1) is the minimiser itself: all terms will do */
    bool damps;        /* takes energy out of motion: it comes to rest */
    bool by_name;      /* chosen by name only: key M skips it */
    int memory;        /* arrays [2n] kept between steps */
    int stages;        /* minimisations of a step; explicit: 0 */
    /* Fills newton->u_tilde and weight for the present stage.  Gravity is added
     * to u_tilde by completing the square:
     *   |u - u_tilde|_M^2/2 - weight m g.u
     *       = |u - (u_tilde + weight g)|_M^2/2 + constant. */
    void (*set_target)(TimeIntegrator *);
    void (*finish)(
        TimeIntegrator *); /* from newton->at.u; the last stage, and an
                            explicit method, fill new_x and new_v */
} IntegratorMethod;

/* Time as whole steps from where h was last another one: a sum of all steps
 * would be wrong in its last digits, and 60 steps of 0.002 s not 0.12 s. */
typedef struct StepClock {
    double now;   /* s, since + steps h */
    double since; /* s, the time at which h became what it is */
    double h;     /* s, of the steps since then */
    long steps;   /* made since then */
} StepClock;

struct TimeIntegrator {
    const IntegratorMethod *method;
    System *system;  /* not owned; its terms may change it */
    size_t size;     /* 2n, of the arrays below */
    double h;        /* s */
    long steps;      /* done so far */
    Status status;   /* of the last step */
    StepClock clock; /* time of x and v */
    bool moves;      /* whether anything is moved in the present step */
    double moved;    /* part of its way that moved things went in it */
    double work;     /* J, done so far by what moves walls and pins */
    double *x;       /* [2n] m; the arrays below are in the same piece */
    double *v;       /* [2n] m/s */
    double *new_x;   /* [2n] m, x at the end of a step; workspace in it */
    double *new_v;   /* [2n] m/s, v, the same */
    double *memory;  /* [memory * 2n] what the method remembers */
    double memory_h; /* s, of the step that it is of; 0: it holds nothing */
    Newton *newton;  /* NULL for explicit methods */
    /* Of the step that is being made: */
    int stage;     /* 0 ... stages - 1 */
    Status worst;  /* last status of its minimisations that is not OK */
    double weight; /* s^2, factor of P in E */
    double left;   /* part of the way of moved things, still to go; */
    int part;      /* their parts so far, */
    long before;   /* Newton's iterations before the first of them; */
    bool blocked;  /* they can go no further */
};

/* The table; it ends with a row whose name is NULL. */
extern const IntegratorMethod integrator_methods[];

/* The row with this name, or NULL. */
const IntegratorMethod *integrator_method(const char *name);

/* Whether the system has a term that the method is not right for. */
bool integrator_method_refuses(const IntegratorMethod *method,
                               const System *system);

/* Allocates for the system and copies the start.
 *   settings  of Newton, with h; explicit methods use only h
 *   x, v      [2n] in, positions and velocities at time 0
 * Returns OK, OUT_OF_MEMORY, INVALID_INPUT (system_check, or the method has a
 * term it cannot serve). */
Status time_integrator_create(const IntegratorMethod *method, System *system,
                              const NewtonSettings *settings, const double *x,
                              const double *v, TimeIntegrator *run);
void time_integrator_free(TimeIntegrator *run);

/* Begins a step; and makes it, up to its end or to the next pause.  Both return
 * RUNNING while the step is not over.  At its end: OK; or a status for which
 * status_is_unconverged holds: the step was made with the best iterate; or a
 * failure: x, v are those of t_n, as they are until then.  Who leaves a step
 * before its end restores what the terms remember and where walls are. */
Status time_integrator_begin(TimeIntegrator *run);
Status time_integrator_advance(TimeIntegrator *run);

/* A whole step.  Returns as time_integrator_advance at its end. */
Status time_integrator_step(TimeIntegrator *run);

#endif
