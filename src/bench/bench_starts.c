#include "bench/bench_starts.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bench/bench_problem.h"

enum { STARTS = 9, START_STEPS = 10 };

/* No further start after so much time, and no larger square that would take
 * longer, s: four times the nodes take some sixteen times as long. */
static const double all_starts = 40;
enum { LONGER_NEXT = 16 };

/* A step buckles that needs more than so many times the iterations of the
 * easiest one before it. */
enum { BUCKLING_RATIO = 2 };

typedef struct Variant {
    const char *name;
    Solver solver;
    bool minimum;
} Variant;

static const Variant variants[] = {
    {"newton", SOLVER_NEWTON, false},
    {"newton-minimum", SOLVER_NEWTON, true},
    {"multigrid", SOLVER_MULTIGRID, false},
    {"multigrid-minimum", SOLVER_MULTIGRID, true},
};
enum { VARIANTS = sizeof variants / sizeof *variants };

/* One run; processor time of the caller's thread, s. */
typedef struct StartRun {
    double total, smooth, buckling; /* s */
    int smooth_steps, buckling_steps;
    long iterations, unconverged;
    double energy; /* at the end over that at the start */
} StartRun;

/* Starts a billionth apart. */
static void move_start(Options *options, int start)
{
    options->stretch += 1e-9 * start;
}

/* least  iterations of the easiest step up to now, in/out */
static bool step_buckles(long made, long *least)
{
    *least = made < *least ? made : *least;
    return made > BUCKLING_RATIO * *least;
}

static Options start_options(const Variant *variant, int segments, int start)
{
    Options options = slides_options(segments);
    move_start(&options, start);
    options.solver = variant->solver;
    options.minimum = variant->minimum;
    return options;
}

static Status run_start(const Options *options, int steps, StartRun *run)
{
    Simulation simulation;
    *run = (StartRun){0};
    Status status = simulation_create(options, NULL, NULL, &simulation);
    double energy = status ? 0 : simulation_energies(&simulation, 0).total;
    long least = LONG_MAX;
    for (int i = 0; i < steps && !status; i++) {
        long before = simulation_counters(&simulation).iterations;
        double start = bench_cpu();
        status = simulation_step(&simulation);
        double spent = bench_cpu() - start;
        long made = simulation_counters(&simulation).iterations - before;
        if (status_is_unconverged(status))
            status = STATUS_OK;
        bool buckles = step_buckles(made, &least);
        *(buckles ? &run->buckling : &run->smooth) += spent;
        ++*(buckles ? &run->buckling_steps : &run->smooth_steps);
        run->total += spent;
        run->iterations += made;
    }
    run->unconverged = simulation.unconverged;
    if (!status)
        run->energy = simulation_energies(&simulation, 0).total / energy;
    simulation_free(&simulation);
    return status;
}

static StartRow summarise(StartRun *runs, int count, int steps)
{
    double ms[STARTS], iterations[STARTS], smooth[STARTS], buckling[STARTS];
    double energy[STARTS];
    StartRow row = {.starts = count, .least = INFINITY};
    for (int i = 0; i < count; i++) {
        const StartRun *run = &runs[i];
        ms[i] = 1e3 * run->total / steps;
        iterations[i] = (double)run->iterations / steps;
        smooth[i] =
            run->smooth_steps ? 1e3 * run->smooth / run->smooth_steps : 0;
        buckling[i] =
            run->buckling_steps ? 1e3 * run->buckling / run->buckling_steps : 0;
        energy[i] = 100 * run->energy;
        row.least = fmin(row.least, ms[i]);
        row.most = fmax(row.most, ms[i]);
        row.unconverged += run->unconverged;
    }
    row.ms = bench_median(ms, count);
    row.iterations = bench_median(iterations, count);
    row.smooth = bench_median(smooth, count);
    row.buckling = bench_median(buckling, count);
    row.energy = bench_median(energy, count);
    return row;
}

static void report_start(Bench *bench, const Variant *variant, int segments,
                         const StartRow *row, const StartRow *last)
{
    double nodes = (segments + 1.0) * (segments + 1.0);
    bench_progress(bench, NULL);
    printf("  %8d %-17s %6d %9.3f %9.3f %9.3f %8.1f %9.1f %11.2f %8.3f",
           segments, variant->name, row->starts, row->ms, row->least, row->most,
           row->iterations, 1e6 * row->smooth / nodes, row->buckling,
           row->energy);
    double grown = log(nodes) - 2 * log(0.5 * segments + 1);
    if (last->buckling > 0 && row->buckling > 0)
        printf("  %5.2f %5.2f", log(row->smooth / last->smooth) / grown,
               log(row->buckling / last->buckling) / grown);
    putchar('\n');
    bench_csv_row(bench, "%s,%d,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%ld",
                  variant->name, segments, row->starts, row->ms, row->least,
                  row->most, row->iterations, 1e6 * row->smooth / nodes,
                  row->buckling, row->energy, row->unconverged);
}

Status starts_compare(const Options *options, int sorts, int starts, int steps,
                      StartRow *row)
{
    StartRun runs[2][STARTS];
    int count = 0;
    double longest[2] = {0}, all = 0;
    while (count < starts && count < STARTS && all < sorts * all_starts) {
        for (int s = 0; s < sorts; s++) {
            Options moved = options[s];
            move_start(&moved, count);
            Status status = run_start(&moved, steps, &runs[s][count]);
            if (status)
                return status;
            longest[s] = fmax(longest[s], runs[s][count].total);
            all += runs[s][count].total;
        }
        count++;
    }
    for (int s = 0; s < sorts; s++) {
        row[s] = summarise(runs[s], count, steps);
        row[s].longest = longest[s];
    }
    return STATUS_OK;
}

Status starts_measure(const Options *options, int starts, int steps,
                      StartRow *row)
{
    return starts_compare(options, 1, starts, steps, row);
}

Status bench_starts(Bench *bench)
{
    StartRow last[VARIANTS] = {{0}}, row = {0};
    bool left_out[VARIANTS] = {false};
    int largest = bench->quick ? 64 : 512;
    Status status = bench_csv_open(
        bench, "starts",
        "solver,segments,starts,median_ms,least_ms,most_ms,iterations,"
        "smooth_ns_per_node,buckling_ms,energy_end_percent,unconverged");
    if (status)
        return status;
    puts("  processor time of one thread, ms a step; growth as nodes^");
    puts("  segments solver            starts    median     least      most"
         " it./step smooth ns buckling ms energy %  growth: smooth, buckling");
    for (int segments = 16; segments <= largest && !status; segments *= 2)
        for (int v = 0; v < VARIANTS && !status; v++) {
            if (left_out[v])
                continue;
            Options options = start_options(&variants[v], segments, 0);
            bench_progress(bench, "starts: %d segments, %s", segments,
                           variants[v].name);
            status = starts_measure(&options, bench->quick ? 2 : STARTS,
                                    bench->quick ? 3 : START_STEPS, &row);
            left_out[v] = LONGER_NEXT * row.longest > all_starts;
            if (!status)
                report_start(bench, &variants[v], segments, &row, &last[v]);
            last[v] = row;
        }
    return bench_csv_close(bench, status);
}

/* ---- saddles ---- */

/* From this step on squares buckle. */
enum { FIRST_JUDGED = 5 };

/* Energies that differ less are those of the same fold. */
static const double same_energy = 1e-4;

/* What a step ended with, looked at before the integrator moves on. */
typedef struct End {
    const Simulation *simulation;
    SearchDirection search; /* of the Hessian as it is */
    Status status;          /* of that */
    double energy;          /* of E, J s^2 */
    bool saddle;
} End;

static bool judge_step(void *user, const NewtonRecord *record)
{
    End *end = user;
    if (record->status == STATUS_RUNNING)
        return true;
    const Iterate *at = &end->simulation->run[0].newton->at;
    int projected;
    end->energy = incremental_potential_value(&at->E, at->u, at->x);
    end->status = search_direction_assemble(&end->search, at, FILTER_ON_DEMAND,
                                            &projected);
    if (!end->status)
        end->status = cholesky_factor(end->search.cholesky);
    end->saddle = end->status == STATUS_NOT_POSITIVE_DEFINITE;
    if (end->saddle)
        end->status = STATUS_OK;
    return true;
}

/* Counts of one solver. */
typedef struct Verdicts {
    int steps, buckling, saddles, buckling_saddles, equal, lower, higher;
} Verdicts;

/* One start: newton's trajectory, and each of its steps by every solver. */
typedef struct Match {
    Simulation simulation[VARIANTS];
    End end[VARIANTS];
} Match;

static Status create_match(int segments, int start, Match *match)
{
    Status status = STATUS_OK;
    for (int v = 0; v < VARIANTS && !status; v++) {
        Options options = start_options(&variants[v], segments, start);
        match->end[v].simulation = &match->simulation[v];
        status = simulation_create(&options, judge_step, &match->end[v],
                                   &match->simulation[v]);
        if (!status)
            status = search_direction_create(&match->simulation[v].system,
                                             &match->end[v].search);
    }
    return status;
}

static void free_match(Match *match)
{
    for (int v = 0; v < VARIANTS; v++) {
        search_direction_free(&match->end[v].search);
        simulation_free(&match->simulation[v]);
    }
}

/* The step that all have just made; buckles  newton needed many iterations. */
static void compare_ends(const Match *match, bool buckles,
                         Verdicts verdicts[VARIANTS])
{
    for (int v = 0; v < VARIANTS; v++) {
        double E = match->end[v].energy, newton = match->end[0].energy;
        double away = E - newton, limit = same_energy * fabs(newton);
        verdicts[v].steps++;
        verdicts[v].buckling += buckles;
        verdicts[v].saddles += match->end[v].saddle;
        verdicts[v].buckling_saddles += buckles && match->end[v].saddle;
        verdicts[v].equal += fabs(away) <= limit;
        verdicts[v].lower += away < -limit;
        verdicts[v].higher += away > limit;
    }
}

static Status play_match(Match *match, int steps, Verdicts verdicts[VARIANTS])
{
    const TimeIntegrator *from = &match->simulation[0].run[0];
    size_t size = 2 * (size_t)from->system->nodes;
    long least = LONG_MAX;
    Status status = STATUS_OK;
    for (int i = 0; i < steps && !status; i++) {
        for (int v = 1; v < VARIANTS; v++) {
            TimeIntegrator *run = &match->simulation[v].run[0];
            memcpy(run->x, from->x, size * sizeof *run->x);
            memcpy(run->v, from->v, size * sizeof *run->v);
        }
        long before = from->newton->counters.iterations;
        for (int v = 0; v < VARIANTS && !status; v++) {
            if (v > 0 && i < FIRST_JUDGED)
                continue;
            status = simulation_step(&match->simulation[v]);
            if (status_is_unconverged(status))
                status = STATUS_OK;
            status = status ? status : match->end[v].status;
        }
        long made = from->newton->counters.iterations - before;
        bool buckles = step_buckles(made, &least);
        if (i >= FIRST_JUDGED && !status)
            compare_ends(match, buckles, verdicts);
    }
    return status;
}

Status bench_saddles(Bench *bench)
{
    int largest = bench->quick ? 16 : 64, starts = bench->quick ? 1 : STARTS;
    int steps = bench->quick ? 7 : 14;
    Status status = bench_csv_open(bench, "saddles",
                                   "solver,segments,steps,buckling,saddles,"
                                   "buckling_saddles,equal,lower,higher");
    if (status)
        return status;
    printf("  steps %d to %d of newton's way, each made by every solver; "
           "energy against newton's\n",
           FIRST_JUDGED + 1, steps);
    puts("  segments solver            steps buckling saddles of buckling"
         "  equal  lower higher");
    for (int segments = 16; segments <= largest && !status; segments *= 2) {
        Verdicts verdicts[VARIANTS] = {{0}};
        for (int start = 0; start < starts && !status; start++) {
            Match match = {0};
            bench_progress(bench, "saddles: %d segments, %d of %d starts",
                           segments, start + 1, starts);
            status = create_match(segments, start, &match);
            if (!status)
                status = play_match(&match, steps, verdicts);
            free_match(&match);
        }
        bench_progress(bench, NULL);
        for (int v = 0; v < VARIANTS && !status; v++) {
            const Verdicts *r = &verdicts[v];
            printf("  %8d %-17s %5d %8d %7d %11d %6d %6d %6d\n", segments,
                   variants[v].name, r->steps, r->buckling, r->saddles,
                   r->buckling_saddles, r->equal, r->lower, r->higher);
            bench_csv_row(bench, "%s,%d,%d,%d,%d,%d,%d,%d,%d", variants[v].name,
                          segments, r->steps, r->buckling, r->saddles,
                          r->buckling_saddles, r->equal, r->lower, r->higher);
        }
    }
    return bench_csv_close(bench, status);
}
