#include "bench/bench_work.h"

#include <math.h>
#include <stdio.h>

/* The motions, and on which squares; 0: no more. */
typedef struct WorkCase {
    Motion motion;
    int segments[4];
} WorkCase;

/* Stiffness 10^4 times larger makes everything 100 times as fast.  The last
 * one is where implicit methods are at home: stiff springs that hardly move,
 * in a square that turns slowly. */
static const WorkCase work_cases[] = {
    {{"soft", 1e5, 1.1, 0, 0.1}, {16, 64, 128, 0}},
    {{"stiff", 1e9, 1.1, 0, 0.02}, {16, 32, 0}},
    {{"spinning", 1e9, 1, 10, 0.1}, {16, 0}},
};
enum { WORK_CASES = sizeof work_cases / sizeof *work_cases, QUICK_SIZE = 4 };

/* Newton's factors take too long on squares larger than this. */
enum { NEWTON_SEGMENTS = 64 };

/* Errors that the table asks for, m. */
static const double work_targets[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
enum { WORK_TARGETS = sizeof work_targets / sizeof *work_targets };

/* Methods and solvers at most. */
enum { WORK_LADDERS = 40 };

/* Steps of the first rung, and the error it is expected to have, m. */
enum { FIRST_STEPS = 8 };
static const double first_error = 1e-2;

/* Runs shorter than this are repeated so often, s. */
static const double short_run = 0.3;
enum { SHORT_REPEATS = 3, LONG_REPEATS = 2 };

/* One rung: a first run, and more if they are cheap. */
static Status climb_rung(const Problem *problem, Ladder *ladder, long steps,
                         double tolerance)
{
    RunResult *result = &ladder->rung[ladder->rungs], again;
    ladder->tolerance[ladder->rungs] = tolerance;
    Status status = problem_run(problem, ladder->method, ladder->solver, steps,
                                tolerance, 1, result);
    if (!status && !result->failed) {
        int repeats =
            result->seconds < short_run ? SHORT_REPEATS : LONG_REPEATS;
        status = problem_run(problem, ladder->method, ladder->solver, steps,
                             tolerance, repeats - 1, &again);
        if (!status)
            result->seconds = fmin(result->seconds, again.seconds);
    }
    if (!status)
        ladder->rungs++;
    return status;
}

Status ladder_climb(const Bench *bench, const Problem *problem,
                    const IntegratorMethod *method, Solver solver,
                    double longest, double finest, Ladder *ladder)
{
    *ladder = (Ladder){.method = method, .solver = solver};
    double expected = first_error;
    for (long steps = FIRST_STEPS; ladder->rungs < LADDER_MAX; steps *= 2) {
        bench_progress(bench, "%s, %d segments: %s %s, %ld steps",
                       problem->motion.name, problem->segments, method->name,
                       method->implicit ? solver_name(solver) : "", steps);
        Status status = climb_rung(problem, ladder, steps,
                                   problem_tolerance(problem, steps, expected));
        if (status)
            return status;
        const RunResult *result = &ladder->rung[ladder->rungs - 1];
        if (2 * result->seconds > longest ||
            (!result->failed && result->error < finest))
            break;
        expected =
            fmin(result->failed ? first_error : result->error, first_error) /
            (1 << method->order);
    }
    return STATUS_OK;
}

double ladder_seconds(const Ladder *ladder, double error)
{
    const RunResult *last = NULL;
    for (int i = 0; i < ladder->rungs; i++) {
        const RunResult *next = &ladder->rung[i];
        if (next->failed)
            continue;
        if (next->error <= error) {
            if (!last)
                return next->seconds;
            double part =
                log(last->error / error) / log(last->error / next->error);
            return last->seconds * pow(next->seconds / last->seconds, part);
        }
        last = next;
    }
    return INFINITY;
}

static void write_ladder(Bench *bench, const Problem *problem,
                         const Ladder *ladder)
{
    for (int i = 0; i < ladder->rungs; i++) {
        const RunResult *result = &ladder->rung[i];
        bench_csv_row(
            bench, "%s,%d,%s,%s,%d,%ld,%.6g,%.6g,%.6g,%.6g,%.6g,%ld,%ld,%ld,%d",
            problem->motion.name, problem->segments, ladder->method->name,
            ladder->method->implicit ? solver_name(ladder->solver) : "none",
            ladder->method->order, result->steps,
            problem->motion.time / (double)result->steps, ladder->tolerance[i],
            result->seconds, fmin(result->error, 1e300),
            fmin(result->drift, 1e300), result->iterations,
            result->factorisations, result->unconverged, result->failed);
    }
}

/* The fastest ladder of this kind for the error, or NULL. */
static const Ladder *fastest_ladder(const Ladder *ladders, int count,
                                    bool implicit, double error)
{
    const Ladder *best = NULL;
    for (int i = 0; i < count; i++) {
        double seconds = ladder_seconds(&ladders[i], error);
        if (ladders[i].method->implicit == implicit && isfinite(seconds) &&
            (!best || seconds < ladder_seconds(best, error)))
            best = &ladders[i];
    }
    return best;
}

/* Name and milliseconds, or a dash. */
static void print_best(const Ladder *best, double error)
{
    char name[40] = "-";
    if (best && best->method->implicit)
        snprintf(name, sizeof name, "%s, %s", best->method->name,
                 solver_name(best->solver));
    else if (best)
        snprintf(name, sizeof name, "%s", best->method->name);
    if (best)
        printf("  %-22s %10.3f", name, 1e3 * ladder_seconds(best, error));
    else
        printf("  %-22s %10s", name, "");
}

/* For each error the best explicit and the best implicit method. */
static void print_targets(const Ladder *ladders, int count)
{
    printf("    error m  best explicit                  ms  best implicit"
           "                  ms  implicit/explicit\n");
    for (int i = 0; i < WORK_TARGETS; i++) {
        double error = work_targets[i];
        const Ladder *without = fastest_ladder(ladders, count, false, error);
        const Ladder *with = fastest_ladder(ladders, count, true, error);
        printf("    %7.0e", error);
        print_best(without, error);
        print_best(with, error);
        if (without && with) {
            double ratio =
                ladder_seconds(with, error) / ladder_seconds(without, error);
            printf("  %8.3g: implicit %s", ratio, ratio > 1 ? "loses" : "wins");
        }
        putchar('\n');
    }
}

static int count_failures(const Ladder *ladder)
{
    int failures = 0;
    for (int i = 0; i < ladder->rungs; i++)
        failures += ladder->rung[i].failed;
    return failures;
}

/* How far each ladder came. */
static void print_ladders(const Ladder *ladders, int count)
{
    printf("    method                  runs failed   smallest error m  "
           "energy drift        in ms\n");
    for (int i = 0; i < count; i++) {
        const Ladder *ladder = &ladders[i];
        const RunResult *best = &ladder->rung[ladder->rungs - 1];
        printf("    %-16s %-6s %4d %5d", ladder->method->name,
               ladder->method->implicit ? solver_name(ladder->solver) : "",
               ladder->rungs, count_failures(ladder));
        if (best->failed)
            printf("        failed\n");
        else
            printf(" %18.2e %13.1e %12.3f\n", best->error, best->drift,
                   1e3 * best->seconds);
    }
}

/* All methods on one problem. */
static Status climb_all(Bench *bench, const Problem *problem, double longest,
                        Ladder *ladders, int *count)
{
    double finest = bench->quick ? 1e-5 : 1e-8;
    Status status = STATUS_OK;
    *count = 0;
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        for (int s = 0; s < (row->implicit ? SOLVER_COUNT : 1); s++) {
            if (status || *count == WORK_LADDERS)
                return status;
            if (row->implicit && s == SOLVER_NEWTON &&
                problem->segments > NEWTON_SEGMENTS)
                continue;
            status = ladder_climb(bench, problem, row, (Solver)s, longest,
                                  finest, &ladders[*count]);
            if (!status)
                write_ladder(bench, problem, &ladders[(*count)++]);
        }
    return status;
}

/* One motion on one square. */
static Status work_problem(Bench *bench, const Motion *motion, int segments)
{
    static Ladder ladders[WORK_LADDERS];
    int count = 0;
    Problem problem;
    bench_progress(bench, "%s, %d segments: reference", motion->name, segments);
    Status status = problem_create(motion, segments, &problem);
    if (!status) {
        bench_progress(bench, NULL);
        printf("\n  %s: %d segments, k %.0e J/m^2, stretch %g, spin %g rad/s, "
               "%g s\n",
               motion->name, segments, motion->stiffness, motion->stretch,
               motion->spin, motion->time);
        printf("    reference: two runs of it agree to %.1e m; a disturbance "
               "of 1e-9 m grows %.3g-fold\n",
               problem.self_error, problem.growth);
        double longest = bench->quick ? 0.01 : segments / 64.0 + 0.25;
        status = climb_all(bench, &problem, longest, ladders, &count);
    }
    if (!status) {
        bench_progress(bench, NULL);
        print_ladders(ladders, count);
        print_targets(ladders, count);
    }
    problem_free(&problem);
    return status;
}

Status bench_work_precision(Bench *bench)
{
    Status status = bench_csv_open(
        bench, "work_precision",
        "case,segments,integrator,solver,order,steps,timestep_s,tolerance_m_s,"
        "run_time_s,error_m,energy_drift,iterations,factorisations,"
        "unconverged,failed");
    if (status)
        return status;
    for (int c = 0; c < WORK_CASES && !status; c++) {
        const WorkCase *row = &work_cases[c];
        for (int i = 0; row->segments[i] && !status; i++)
            if (!bench->quick || i == 0)
                status =
                    work_problem(bench, &row->motion,
                                 bench->quick ? QUICK_SIZE : row->segments[i]);
    }
    return bench_csv_close(bench, status);
}
