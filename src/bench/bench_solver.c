#include "bench/bench_solver.h"

#include <math.h>
#include <stdio.h>

#include "bench/bench_cost.h"
#include "bench/bench_problem.h"

enum { SOLVER_REPEATS = 3 };

/* Runs longer than this are not repeated, s. */
static const double unrepeated_run = 5;

/* What is remembered of each solver from size to size. */
typedef struct SolverHistory {
    bool left_out;
    double last; /* s a step on the square before; 0: none yet */
    double sum_x, sum_y, sum_xx, sum_xy; /* logarithms of size and time */
    int count;                           /* of squares that count */
} SolverHistory;

/* Squares below this have too little work for a law of growth. */
enum { GROWTH_SEGMENTS = 16 };

static void remember_growth(int segments, double seconds,
                            SolverHistory *history)
{
    history->last = seconds;
    if (segments < GROWTH_SEGMENTS)
        return;
    double x = log(segments), y = log(seconds);
    history->sum_x += x;
    history->sum_y += y;
    history->sum_xx += x * x;
    history->sum_xy += x * y;
    history->count++;
}

static void print_solver_head(void)
{
    printf(
        "  segments solver      ms/step assembly analysis   factor    solve"
        "   search multigr.    rest     bare  it./step fact./step  growth\n");
}

/* Milliseconds a step; growth is that from the square before. */
static void report_cost(Bench *bench, int segments, int solver,
                        const Cost *cost, double last)
{
    double n = (double)cost->steps, ms = 1e3 / n;
    bench_progress(bench, NULL);
    printf("  %8d %-9s %9.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f "
           "%9.1f "
           "%10.1f",
           segments, cost_name(solver), ms * cost->total, ms * cost->assembly,
           ms * cost->analysis, ms * cost->factor, ms * cost->solve,
           ms * cost->search, ms * cost->multigrid, ms * cost->rest,
           ms * cost->bare, (double)cost->iterations / n,
           (double)cost->factorisations / n);
    if (last > 0)
        printf("  %6.2f", log2(cost->total / n / last));
    putchar('\n');
    bench_csv_row(
        bench,
        "%s,%d,%ld,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%ld,%ld,"
        "%ld,%ld,%.9g,%.9g",
        cost_name(solver), segments, cost->steps, ms * cost->total,
        ms * cost->assembly, ms * cost->analysis, ms * cost->factor,
        ms * cost->solve, ms * cost->search, ms * cost->multigrid,
        ms * cost->rest, ms * cost->bare, cost->iterations,
        cost->factorisations, cost->solves, cost->unconverged,
        cost->energy_start, cost->energy_end);
}

/* All solvers on one square, several times in turns; the median of each. */
static Status solver_square(Bench *bench, int segments, long steps,
                            double longest, SolverHistory *history)
{
    Cost costs[COST_SOLVERS][SOLVER_REPEATS];
    int made[COST_SOLVERS] = {0};
    Options options = slides_options(segments);
    for (int r = 0; r < SOLVER_REPEATS; r++)
        for (int s = 0; s < COST_SOLVERS; s++) {
            if (history[s].left_out ||
                (r > 0 && costs[s][0].total > unrepeated_run))
                continue;
            bench_progress(bench, "solver: %d segments, %s", segments,
                           cost_name(s));
            Status status =
                cost_measure(&options, s, steps, longest, &costs[s][r]);
            if (status)
                return status;
            history[s].left_out = costs[s][r].timed_out;
            made[s] += !costs[s][r].timed_out;
            if (s == SOLVER_NEWTON && history[s].left_out)
                history[COST_PLAIN].left_out = true; /* it is slower yet */
        }
    for (int s = 0; s < COST_SOLVERS; s++)
        if (made[s] > 0) {
            const Cost *cost = cost_median(costs[s], made[s]);
            report_cost(bench, segments, s, cost, history[s].last);
            remember_growth(segments, cost->total / (double)steps, &history[s]);
        } else if (history[s].last > 0) {
            bench_progress(bench, NULL);
            printf("  %8d %-6s more than %g s for %ld steps: left out from "
                   "here on\n",
                   segments, cost_name(s), longest, steps);
            history[s].last = 0;
        }
    return STATUS_OK;
}

/* Slope of the straight line through the logarithms. */
static void print_growth(const SolverHistory *history)
{
    for (int s = 0; s < COST_SOLVERS; s++) {
        const SolverHistory *h = &history[s];
        double n = h->count, spread = n * h->sum_xx - h->sum_x * h->sum_x;
        if (h->count >= 2)
            printf("  %s: time grows as segments^%.2f from %d segments on\n",
                   cost_name(s), (n * h->sum_xy - h->sum_x * h->sum_y) / spread,
                   GROWTH_SEGMENTS);
    }
}

Status bench_solver(Bench *bench)
{
    SolverHistory history[COST_SOLVERS] = {0};
    long steps = bench->quick ? 3 : 10;
    double longest = bench->quick ? 1 : 20;
    int largest = bench->quick ? 32 : 256;
    Status status = bench_csv_open(
        bench, "solver",
        "solver,segments,steps,total_ms,assembly_ms,analysis_ms,factor_ms,"
        "solve_ms,search_ms,multigrid_ms,rest_ms,bare_ms,iterations,"
        "factorisations,solves,"
        "unconverged,energy_start_J,energy_end_J");
    if (status)
        return status;
    printf("  %ld steps of the slides' scene; bare: the same calls of factor "
           "and solve alone\n",
           steps);
    print_solver_head();
    for (int segments = 4; segments <= largest && !status; segments *= 2)
        status = solver_square(bench, segments, steps, longest, history);
    if (!status)
        print_growth(history);
    return bench_csv_close(bench, status);
}
