/* time_integrator.c - one step forward in time (slide time_integrator.py). */
#include "step/time_integrator.h"

#include <stdlib.h>
#include <string.h>

#include "model/pull_energy.h"
#include "step/prescribed.h"

const IntegratorMethod *integrator_find_method(const char *name)
{
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        if (strcmp(row->name, name) == 0)
            return row;
    return NULL;
}

bool integrator_method_refuses_system(const IntegratorMethod *method,
                                      const System *system)
{
    for (int t = 0; t < system->term_count; t++) {
        const TermKind *kind = system->term[t].kind;
        if (!kind->supports_all_integrators && !method->supports_all_terms)
            return true;
    }
    return false;
}

Status time_integrator_create(const IntegratorMethod *method, System *system,
                              const NewtonSettings *settings, const double *x,
                              const double *v, TimeIntegrator *run)
{
    size_t size = 2 * (size_t)system->nodes;
    *run = (TimeIntegrator){
        .method = method, .system = system, .x_length = size, .h = settings->h};
    if (!system_is_feasible(make_eval_point(system, x, NULL, x)) ||
        integrator_method_refuses_system(method, system) ||
        (system->pin_v && !method->supports_all_terms))
        return STATUS_INVALID_INPUT;
    run->x = calloc((4 + (size_t)method->history_arrays) * size, sizeof *x);
    if (!run->x)
        return STATUS_OUT_OF_MEMORY;
    run->v = run->x + size;
    run->new_x = run->v + size;
    run->new_v = run->new_x + size;
    run->history = run->new_v + size;
    memcpy(run->x, x, size * sizeof *x);
    memcpy(run->v, v, size * sizeof *v);
    if (method->stages == 0)
        return STATUS_OK;
    run->newton = calloc(1, sizeof *run->newton);
    return run->newton ? newton_create(system, settings, run->newton)
                       : STATUS_OUT_OF_MEMORY;
}

void time_integrator_free(TimeIntegrator *run)
{
    newton_free(run->newton);
    free(run->newton);
    free(run->x);
    *run = (TimeIntegrator){0};
}

/* ---- a step -------------------------------------------------------------
 *
 * The slides' step_forward, here with the formulas of backward Euler:
 *
 *     x_tilde = x + h v        method->set_target
 *     x = argmin of E          newton_minimise
 *     v = (x - x_n) / h        method->set_x_v */

/* Advances the clock by a step of h. */
static void advance_step_clock(StepClock *clock, double h)
{
    if (h != clock->h)
        *clock = (StepClock){.h_change_time = clock->time, .h = h};
    clock->steps++;
    clock->time = clock->h_change_time + (double)clock->steps * h;
}

/* Lets the terms begin a step: friction, for example, reads contacts. */
static Status begin_term_steps(TimeIntegrator *run)
{
    System *system = run->system;
    Status status = STATUS_OK;
    for (int t = 0; t < system->term_count && !status; t++)
        if (system->term[t].kind->begin_step)
            status = system->term[t].kind->begin_step(
                &(TermStep){system, &system->term[t], run->x, run->v, run->h});
    return status;
}

/* Lets the terms end a step; plastic springs, for example, flow. */
static void end_term_steps(TimeIntegrator *run)
{
    System *system = run->system;
    for (int t = 0; t < system->term_count; t++)
        if (system->term[t].kind->end_step)
            system->term[t].kind->end_step(
                &(TermStep){system, &system->term[t], run->x, run->v, run->h});
}

/* Sets the target of the hand for this step. */
static void begin_hand_step(TimeIntegrator *run)
{
    System *system = run->system;
    NodePull *hand = system_term_data(system, &hand_energy);
    if (!hand)
        return;
    size_t i = 2 * (size_t)hand->node;
    if (!run->newton) {
        hand->k = 0;
        system_acceleration(system, run->x, run->new_x);
        run->history_h = 0; /* the stored acceleration lacks the hand's force */
    }
    hand_begin_step(hand, run->x + i, run->v + i, system->m[hand->node], run->h,
                    run->newton ? NULL : run->new_x + i);
    system_mark_changed(system, false);
}

/* Begins a stage: adds gravity to the target, and starts Newton's method. */
static void begin_stage(TimeIntegrator *run)
{
    const System *system = run->system;
    Newton *newton = run->newton;
    run->method->set_target(run);
    if (system_has_gravity(system))
        for (size_t i = 0; i < run->x_length; i++)
            newton->u_tilde[i] += run->weight * system->gravity[i % 2];
    newton->step_number = run->steps + 1;
    if (run->is_driven)
        prescribed_begin_motion_part(run);
    else
        newton_start(newton, run->x, NULL, run->weight,
                     newton->settings.tolerance);
}

/* Ends the step.  x and v become new_x and new_v unless the step failed. */
static Status end_step(TimeIntegrator *run, Status status)
{
    size_t both = 2 * run->x_length; /* x and v are one array */
    run->status = status;
    if (status_is_failure(status))
        return status;
    if (!all_finite(run->new_x, both)) {
        run->history_h = 0;
        return run->status = STATUS_NOT_FINITE;
    }
    const NodePull *hand = system_term_data(run->system, &hand_energy);
    if (hand)
        run->external_work += hand_work(hand, run->x + 2 * hand->node,
                                        run->new_x + 2 * hand->node);
    memcpy(run->x, run->new_x, both * sizeof(double));
    run->steps++;
    advance_step_clock(&run->clock, run->h);
    if (run->is_driven)
        run->external_work += prescribed_compute_work(run);
    end_term_steps(run);
    return run->status;
}

Status time_integrator_begin_step(TimeIntegrator *run)
{
    run->stage_status = STATUS_OK;
    run->stage = 0;
    if (run->newton)
        run->newton->total_energy_change = 0;
    run->is_driven = prescribed_begin_motion(run);
    Status status = begin_term_steps(run);
    if (status)
        return end_step(run, status);
    begin_hand_step(run);
    if (run->newton)
        begin_stage(run);
    return run->status = STATUS_RUNNING;
}

Status time_integrator_continue(TimeIntegrator *run)
{
    const IntegratorMethod *method = run->method;
    while (run->stage < method->stages) {
        /* Minimise E */
        Status status = newton_minimise(run->newton);
        if (status == STATUS_RUNNING)
            return status;

        /* Move walls and pins by the next part of their way */
        if (run->is_driven && prescribed_end_motion_part(run, &status)) {
            prescribed_begin_motion_part(run);
            continue;
        }
        if (status_is_failure(status))
            return end_step(run, status);
        run->stage_status = status ? status : run->stage_status;

        /* Compute x and v, or begin the next stage */
        method->set_x_v(run);
        if (++run->stage < method->stages)
            begin_stage(run);
    }
    if (method->stages == 0)
        method->set_x_v(run);
    return end_step(run, run->stage_status);
}

Status time_integrator_make_step(TimeIntegrator *run)
{
    Status status = time_integrator_begin_step(run);
    while (status == STATUS_RUNNING)
        status = time_integrator_continue(run);
    return status;
}
