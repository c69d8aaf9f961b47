#include "bench/bench_claims.h"

#include <math.h>
#include <stdio.h>

#include "bench/bench_cost.h"
#include "bench/bench_lecture.h"
#include "bench/bench_starts.h"
#include "bench/bench_work.h"

enum {
    CLAIM_STEPS = 10,
    CLAIM_STARTS = 9,
    CLAIM_SMOOTH_STEPS = 7, /* later ones buckle */
    CLAIM_BARE_STEPS = 50,
    CLAIM_BARE_ROUNDS = 31
};

static const double no_limit = 1e9; /* s */

/* Newton's processor time over multigrid's, first ten steps: at least. */
typedef struct SpeedClaim {
    int segments;
    double ratio;
} SpeedClaim;

static const SpeedClaim speed_claims[] = {{32, 10}, {64, 40}};

/* Milliseconds of processor time a step by multigrid: at most. */
typedef struct StepClaim {
    int segments, steps;
    double timestep, ms;
} StepClaim;

static const StepClaim step_claims[] = {{128, 40, 0.004, 16},
                                        {128, 40, 1 / 60.0, 8}};

/* One line of the table: at_most tells which way the limit counts. */
static void report_claim(Bench *bench, const char *name, int segments,
                         double measured, bool at_most, double limit)
{
    bool met = at_most ? measured <= limit : measured >= limit;
    bench_progress(bench, NULL);
    printf("  %-54s %4d segments: %9.4g, %s %g: %s\n", name, segments, measured,
           at_most ? "at most" : "at least", limit, met ? "met" : "NOT MET");
    bench_csv_row(bench, "%s,%d,%.6g,%s,%g,%d", name, segments, measured,
                  at_most ? "at most" : "at least", limit, met);
}

static Status claim_speed(Bench *bench, const SpeedClaim *claim)
{
    Options options[2] = {slides_options(claim->segments),
                          slides_options(claim->segments)};
    StartRow row[2];
    char name[100];
    options[0].solver = SOLVER_NEWTON;
    options[1].solver = SOLVER_MULTIGRID;
    bench_progress(bench, "claims: %d segments, both solvers", claim->segments);
    Status status = starts_compare(options, 2, CLAIM_STARTS, CLAIM_STEPS, row);
    if (status)
        return status;
    snprintf(name, sizeof name,
             "newton's time (%.3g-%.3g ms) over multigrid's (%.3g-%.3g)",
             row[0].least, row[0].most, row[1].least, row[1].most);
    report_claim(bench, name, claim->segments, row[0].ms / row[1].ms, false,
                 claim->ratio);
    return STATUS_OK;
}

static Status claim_step(Bench *bench, const StepClaim *claim)
{
    Options options = slides_options(claim->segments);
    StartRow row;
    char name[100];
    options.solver = SOLVER_MULTIGRID;
    options.timestep = claim->timestep;
    bench_progress(bench, "claims: %d segments, %d steps", claim->segments,
                   claim->steps);
    Status status = starts_measure(&options, CLAIM_STARTS, claim->steps, &row);
    if (status)
        return status;
    snprintf(name, sizeof name,
             "ms a step of %.4f s by multigrid; %d steps (%.3g-%.3g)",
             claim->timestep, claim->steps, row.least, row.most);
    report_claim(bench, name, claim->segments, row.ms, true, claim->ms);
    return STATUS_OK;
}

/* The first steps of 64 segments and of more, by multigrid.
 *   nodes  [2] out, how many they have */
static Status grow(Bench *bench, int segments, int steps, StartRow row[2],
                   double nodes[2])
{
    const int n[] = {64, segments};
    Options options[2];
    for (int i = 0; i < 2; i++) {
        options[i] = slides_options(n[i]);
        options[i].solver = SOLVER_MULTIGRID;
        nodes[i] = (n[i] + 1.0) * (n[i] + 1.0);
    }
    bench_progress(bench, "claims: 64 and %d segments", segments);
    return starts_compare(options, 2, CLAIM_STARTS, steps, row);
}

/* Steps before the square buckles cost the same for each node, but for caches;
 * the first, which meets new memory, is one of them. */
static Status claim_growth(Bench *bench)
{
    StartRow row[2];
    char name[100];
    double nodes[2];
    Status status = grow(bench, 512, CLAIM_SMOOTH_STEPS, row, nodes);
    if (status)
        return status;
    double small = 1e6 * row[0].ms / nodes[0],
           large = 1e6 * row[1].ms / nodes[1];
    snprintf(name, sizeof name,
             "smooth step's ns a node (%.3g) over those at 64 (%.3g)", large,
             small);
    report_claim(bench, name, 512, large / small, true, 1.5);
    return STATUS_OK;
}

/* How steps that buckle grow from 64 to 256 segments. */
static Status claim_buckling(Bench *bench)
{
    StartRow row[2];
    char name[100];
    double nodes[2];
    Status status = grow(bench, 256, CLAIM_STEPS, row, nodes);
    if (status)
        return status;
    snprintf(name, sizeof name,
             "power of nodes in buckling steps (%.3g ms at 64, %.3g)",
             row[0].buckling, row[1].buckling);
    report_claim(bench, name, 256,
                 log(row[1].buckling / row[0].buckling) /
                     log(nodes[1] / nodes[0]),
                 true, 1.3);
    return STATUS_OK;
}

/* Default steps, while the square still moves, against nothing but the calls of
 * CHOLMOD that they make. */
static Status claim_bare(Bench *bench)
{
    Options options = slides_options(4);
    double ratio[CLAIM_BARE_ROUNDS];
    for (int i = 0; i < CLAIM_BARE_ROUNDS; i++) {
        Cost cost;
        Status status = cost_measure(&options, SOLVER_NEWTON, CLAIM_BARE_STEPS,
                                     no_limit, &cost);
        if (status)
            return status;
        ratio[i] = cost.total / cost.bare;
    }
    report_claim(bench, "a default step's time over its factor and solve calls",
                 4, bench_median(ratio, CLAIM_BARE_ROUNDS), true, 1.5);
    return STATUS_OK;
}

/* The error that is asked for, m. */
static const double claim_error = 1e-4;

/* Seconds of one step of the plain baseline with this time step. */
static Status plain_seconds(const Problem *problem, double steps,
                            double *seconds)
{
    const System *system = &problem->simulation.system;
    double h = problem->motion.time / steps;
    double tolerance = problem_tolerance(problem, (long)steps, claim_error);
    int size = 2 * system->nodes, count = problem->segments > 16 ? 8 : 100;
    LectureCounters counters = {0};
    double *x = problem->simulation.run[0].x, *v = problem->simulation.run[0].v;
    for (int i = 0; i < size; i++) {
        x[i] = problem->x[i];
        v[i] = problem->v[i];
    }
    double start = bench_cpu();
    for (int i = 0; i < count; i++) {
        Status status = lecture_step(system, h, tolerance, x, v, &counters);
        if (status && !status_is_unconverged(status))
            return status;
    }
    *seconds = (bench_cpu() - start) / count;
    return STATUS_OK;
}

/* Steps that backward Euler needs: the error of the finest rung, and from
 * there on first order. */
static Status plain_steps(const Bench *bench, const Problem *problem,
                          double longest, double *steps)
{
    Ladder ladder;
    Status status =
        ladder_climb(bench, problem, integrator_method("backward-euler"),
                     SOLVER_MULTIGRID, longest, claim_error, &ladder);
    if (status)
        return status;
    const RunResult *last = &ladder.rung[ladder.rungs - 1];
    const RunResult *before = last - (ladder.rungs > 1);
    *steps = (double)last->steps * last->error / claim_error;
    bench_progress(bench, NULL);
    printf("  backward Euler: error %.2e m with %ld steps, %.2e m with %ld; "
           "extrapolated by first order: %.0f steps for %g m\n",
           before->error, before->steps, last->error, last->steps, *steps,
           claim_error);
    return STATUS_OK;
}

/* The fastest method for the error, of those that are (not) implicit. */
static Status best_method(const Bench *bench, const Problem *problem,
                          bool implicit, double longest, double *seconds)
{
    const char *name = "none";
    *seconds = INFINITY;
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        for (int s = 0; s < (implicit ? SOLVER_COUNT : 1); s++) {
            Ladder ladder;
            if (row->implicit != implicit || (implicit && row->order == 1))
                continue;
            Status status = ladder_climb(bench, problem, row, (Solver)s,
                                         longest, claim_error, &ladder);
            if (status)
                return status;
            if (ladder_seconds(&ladder, claim_error) < *seconds) {
                *seconds = ladder_seconds(&ladder, claim_error);
                name = row->name;
            }
        }
    bench_progress(bench, NULL);
    printf("  best %s method for an error of %g m: %s, %.4g s\n",
           implicit ? "implicit" : "explicit", claim_error, name, *seconds);
    return STATUS_OK;
}

/* Error 1e-4 m: the best method against the plain baseline. */
static Status claim_precision(Bench *bench, int segments)
{
    const Motion motion = {"claims", 1e5, 1.1, 0, 0.05};
    double longest = bench->quick ? 0.1 : 1.5, steps = 0, plain = 0;
    double with = 0, without = 0;
    Problem problem;
    bench_progress(bench, "claims: %d segments, reference", segments);
    Status status = problem_create(&motion, segments, &problem);
    if (!status)
        status = plain_steps(bench, &problem, longest, &steps);
    if (!status)
        status = plain_seconds(&problem, steps, &plain);
    if (!status)
        status = best_method(bench, &problem, true, longest, &with);
    if (!status)
        status = best_method(bench, &problem, false, longest, &without);
    problem_free(&problem);
    if (status)
        return status;
    printf("  backward Euler with CHOLMOD's defaults (plain): %.4g s a step, "
           "%.4g s in all, extrapolated\n",
           plain, plain * steps);
    report_claim(bench, "plain backward Euler's time over the best method's",
                 segments, plain * steps / fmin(with, without), false, 50);
    report_claim(bench, "plain backward Euler's time over the best implicit",
                 segments, plain * steps / with, false, 50);
    return STATUS_OK;
}

Status bench_claims(Bench *bench)
{
    int speeds = bench->quick ? 0 : 2;
    Status status = bench_csv_open(bench, "claims",
                                   "claim,segments,measured,sense,limit,met");
    if (status)
        return status;
    status = claim_bare(bench);
    if (!status)
        status = claim_precision(bench, bench->quick ? 8 : 64);
    for (int i = 0; i < speeds && !status; i++)
        status = claim_speed(bench, &speed_claims[i]);
    for (int i = 0; i < speeds && !status; i++)
        status = claim_step(bench, &step_claims[i]);
    if (!bench->quick && !status)
        status = claim_growth(bench);
    if (!bench->quick && !status)
        status = claim_buckling(bench);
    return bench_csv_close(bench, status);
}
