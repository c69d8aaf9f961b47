#include "bench/bench_problem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench_report.h"

/* Newton gives up after so many updates of a step. */
enum { PROBLEM_MAX_ITERATIONS = 2000 };

/* Length of the disturbance whose growth is measured, m. */
static const double disturbance = 1e-9;

Options slides_options(int segments)
{
    char program[] = "elasto", message[128], *arguments[] = {program, NULL};
    Options options;
    options_parse(1, arguments, &options, message, sizeof message);
    options.segments = segments;
    return options;
}

/* Rotation about the origin. */
static void spin_velocity(const Motion *motion, int nodes, const double *x,
                          double *v)
{
    for (int i = 0; i < nodes; i++) {
        v[2 * i] = -motion->spin * x[2 * i + 1];
        v[2 * i + 1] = motion->spin * x[2 * i];
    }
}

/* How much further apart than at the start the ends of two runs are. */
static Status measure_growth(Problem *problem, long intervals)
{
    const System *system = &problem->simulation.system;
    size_t size = 2 * (size_t)system->nodes;
    unsigned long long random = 1;
    double *x = malloc(size * sizeof *x);
    Reference end = {0};
    if (!x)
        return STATUS_OUT_OF_MEMORY;
    for (size_t i = 0; i < size; i++) { /* Knuth's MMIX */
        random = random * 6364136223846793005u + 1442695040888963407u;
        x[i] = problem->x[i] +
               disturbance * ((double)(random >> 63) * 2 - 1) / sqrt(2);
    }
    Status status = reference_create(system, x, problem->v,
                                     problem->motion.time, intervals, &end);
    if (!status)
        problem->growth =
            reference_difference(&end, &problem->reference) / disturbance;
    reference_free(&end);
    free(x);
    return status;
}

/* The exact end, from twice as many intervals as are needed, and how far it is
 * from that with just as many. */
static Status solve_exactly(Problem *problem)
{
    const System *system = &problem->simulation.system;
    double time = problem->motion.time;
    long intervals = reference_intervals(system, problem->x, time);
    Reference coarse = {0};
    Status status = reference_create(system, problem->x, problem->v, time,
                                     2 * intervals, &problem->reference);
    if (!status)
        status = reference_create(system, problem->x, problem->v, time,
                                  intervals, &coarse);
    if (!status) {
        problem->self_error =
            reference_difference(&coarse, &problem->reference);
        status = measure_growth(problem, intervals);
    }
    reference_free(&coarse);
    return status;
}

Status problem_create(const Motion *motion, int segments, Problem *problem)
{
    *problem = (Problem){.motion = *motion, .segments = segments};
    Options options = slides_options(segments);
    options.stiffness = motion->stiffness;
    options.stretch = motion->stretch;
    options.integrator = integrator_method("verlet");
    Simulation *simulation = &problem->simulation;
    Status status = simulation_create(&options, NULL, NULL, simulation);
    if (status)
        return status;
    const System *system = &simulation->system;
    size_t size = 2 * (size_t)system->nodes;
    problem->x = malloc(size * sizeof *problem->x);
    problem->v = malloc(size * sizeof *problem->v);
    if (!problem->x || !problem->v)
        return STATUS_OUT_OF_MEMORY;
    memcpy(problem->x, simulation->run[0].x, size * sizeof *problem->x);
    spin_velocity(motion, system->nodes, problem->x, problem->v);
    problem->energy = system_potential(system, problem->x) +
                      system_kinetic(system, problem->v);
    return solve_exactly(problem);
}

void problem_free(Problem *problem)
{
    if (!problem)
        return;
    reference_free(&problem->reference);
    simulation_free(&problem->simulation);
    free(problem->x);
    free(problem->v);
    *problem = (Problem){0};
}

void problem_judge(const Problem *problem, const double *x, const double *v,
                   RunResult *result)
{
    const System *system = &problem->simulation.system;
    double energy = system_potential(system, x) + system_kinetic(system, v);
    result->error = reference_distance(&problem->reference, x);
    result->drift = fabs(energy / problem->energy - 1);
    result->failed = result->status || result->unconverged > 0 ||
                     !(result->error < problem->simulation.options.side);
}

/* One run. */
static Status run_once(const Problem *problem, const IntegratorMethod *method,
                       const NewtonSettings *settings, RunResult *result)
{
    TimeIntegrator run;
    System system = problem->simulation.system; /* the same arrays */
    double start = bench_cpu();
    Status status = time_integrator_create(method, &system, settings,
                                           problem->x, problem->v, &run);
    if (status) {
        time_integrator_free(&run);
        return status;
    }
    while (!status && run.steps < result->steps) {
        status = time_integrator_step(&run);
        if (status_is_unconverged(status)) {
            result->unconverged++;
            status = STATUS_OK;
        }
    }
    result->seconds = bench_cpu() - start;
    result->status = status;
    if (run.newton) {
        result->iterations = run.newton->counters.iterations;
        result->factorisations = run.newton->counters.factorisations;
    }
    problem_judge(problem, run.x, run.v, result);
    time_integrator_free(&run);
    return status == STATUS_OUT_OF_MEMORY ? status : STATUS_OK;
}

Status problem_run(const Problem *problem, const IntegratorMethod *method,
                   Solver solver, long steps, double tolerance, int repeats,
                   RunResult *result)
{
    NewtonSettings settings = {.h = problem->motion.time / (double)steps,
                               .tolerance = tolerance,
                               .solver = solver,
                               .max_iterations = PROBLEM_MAX_ITERATIONS};
    double fastest = INFINITY;
    for (int i = 0; i < repeats; i++) {
        *result = (RunResult){.steps = steps};
        Status status = run_once(problem, method, &settings, result);
        if (status)
            return status;
        fastest = fmin(fastest, result->seconds);
    }
    result->seconds = fastest;
    return STATUS_OK;
}

double problem_tolerance(const Problem *problem, long steps, double error)
{
    return 0.2 * error / ((double)steps * problem->motion.time);
}
