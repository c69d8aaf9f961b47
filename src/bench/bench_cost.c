#include "bench/bench_cost.h"

#include <math.h>
#include <stdlib.h>

#include "bench/bench_lecture.h"
#include "bench/bench_report.h"

/* Calls whose median is the bare time of one. */
enum { BARE_CALLS = 21 };

const char *cost_name(int solver)
{
    return solver == COST_PLAIN ? "plain" : solver_name((Solver)solver);
}

/* Stops a minimisation whose time is up. */
static bool before_deadline(void *user, const NewtonRecord *record)
{
    (void)record;
    return clock_now() < *(const double *)user;
}

/* What the counters of newton.h say; what is left is the rest. */
static void cost_from_counters(const NewtonCounters *counters, Cost *cost)
{
    cost->assembly = counters->seconds_assembly;
    cost->factor = counters->seconds_factor;
    cost->solve = counters->seconds_solve;
    cost->search = counters->seconds_search;
    cost->multigrid = counters->seconds_multigrid;
    cost->iterations = counters->iterations;
    cost->factorisations = counters->factorisations;
    cost->solves = counters->solves;
    cost->rest = cost->total - cost->assembly - cost->factor - cost->solve -
                 cost->search - cost->multigrid;
}

/* The median of some calls alone, times the calls that were made. */
static Status measure_bare(Newton *newton, Cost *cost)
{
    double factor[BARE_CALLS], solve[BARE_CALLS];
    int calls = cost->total > 1 ? 5 : BARE_CALLS;
    Cholesky *cholesky = newton->search.cholesky;
    Status status = STATUS_OK;
    if (!cholesky)
        return STATUS_OK;
    for (int i = 0; i < calls && !status; i++) {
        double start = clock_now();
        status = cholesky_factor(cholesky);
        double factored = clock_now();
        if (!status)
            status = cholesky_solve(cholesky, newton->at.g, newton->at.p);
        solve[i] = clock_now() - factored;
        factor[i] = factored - start;
    }
    if (status)
        return status;
    cost->bare = (double)cost->factorisations * bench_median(factor, calls) +
                 (double)cost->solves * bench_median(solve, calls);
    cost->memory = cholesky_peak_bytes(cholesky);
    return STATUS_OK;
}

/* Steps of newton.h. */
static Status cost_newton(Simulation *simulation, long steps, double deadline,
                          Cost *cost)
{
    double start = clock_now();
    while (cost->steps < steps) {
        Status status = clock_now() < deadline ? simulation_step(simulation)
                                               : STATUS_INTERRUPTED;
        cost->timed_out = status == STATUS_INTERRUPTED;
        if (cost->timed_out)
            return STATUS_OK;
        if (status && !status_is_unconverged(status))
            return status;
        cost->unconverged += status != STATUS_OK;
        cost->steps++;
    }
    cost->total = clock_now() - start;
    NewtonCounters counters = simulation_counters(simulation);
    cost_from_counters(&counters, cost);
    cost->energy_end = simulation_energies(simulation, 0).total;
    return measure_bare(simulation->run[0].newton, cost);
}

/* Steps of lecture.c, with the state of the simulation. */
static Status cost_plain(Simulation *simulation, long steps, double deadline,
                         Cost *cost)
{
    const Options *options = &simulation->options;
    TimeIntegrator *run = &simulation->run[0];
    LectureCounters counters = {0};
    double start = clock_now();
    while (cost->steps < steps) {
        cost->timed_out = clock_now() >= deadline;
        if (cost->timed_out)
            return STATUS_OK;
        Status status =
            lecture_step(&simulation->system, options->timestep,
                         options->tolerance, run->x, run->v, &counters);
        if (status && !status_is_unconverged(status))
            return status;
        cost->unconverged += status != STATUS_OK;
        cost->steps++;
    }
    cost->total = clock_now() - start;
    cost->assembly = counters.seconds_assembly;
    cost->analysis = counters.seconds_analysis;
    cost->factor = counters.seconds_factor;
    cost->solve = counters.seconds_solve;
    cost->search = counters.seconds_search;
    cost->iterations = counters.factorisations - cost->steps;
    cost->factorisations = cost->solves = counters.factorisations;
    cost->rest = cost->total - cost->assembly - cost->analysis - cost->factor -
                 cost->solve - cost->search;
    cost->energy_end = simulation_energies(simulation, 0).total;
    return STATUS_OK;
}

Status cost_measure(const Options *options, int solver, long steps,
                    double longest, Cost *cost)
{
    Simulation simulation;
    Options chosen = *options;
    double deadline = clock_now() + longest;
    chosen.solver = solver == COST_PLAIN ? SOLVER_NEWTON : (Solver)solver;
    *cost = (Cost){0};
    Status status =
        simulation_create(&chosen, before_deadline, &deadline, &simulation);
    if (!status) {
        cost->energy_start = simulation_energies(&simulation, 0).total;
        status = solver == COST_PLAIN
                     ? cost_plain(&simulation, steps, deadline, cost)
                     : cost_newton(&simulation, steps, deadline, cost);
    }
    simulation_free(&simulation);
    return status;
}

static int compare_costs(const void *a, const void *b)
{
    double x = ((const Cost *)a)->total, y = ((const Cost *)b)->total;
    return (x > y) - (x < y);
}

const Cost *cost_median(Cost *costs, int count)
{
    qsort(costs, (size_t)count, sizeof *costs, compare_costs);
    return &costs[(count - 1) / 2];
}
