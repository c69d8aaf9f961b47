/* bench.c - the program elasto-bench: run time against error, and how long
 * steps and frames take. */
#include "bench/bench.h"

#include <SDL_version.h>
#include <cholmod.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/clock.h"
#include "picture/picture.h"

/* Processor time of this thread, s: what a busy machine changes least. */
static double cpu_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The middle one, or the mean of the two in the middle; sorts the values.
 * count at least 1. */
static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare_doubles);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

/* Prints what README says, what was measured, and whether that holds. */
static void claim(const char *what, double measured, double at_most)
{
    printf("# claim: %s: %.3g, at most %g: %s\n", what, measured, at_most,
           measured <= at_most ? "met" : "NOT MET");
}

/* The slides' numbers, on a square of so many segments. */
static Options slides_options(int segments)
{
    char message[128];
    Options options;
    options_of_line("square", &options, message, sizeof message);
    options.segments = segments;
    return options;
}

/* ---- work ---------------------------------------------------------------- */

/* Error against run time: every method crosses the same time in 8, 16, 32, ...
 * steps, until it takes too long or is as exact as anybody needs. */
typedef struct Motion {
    const char *name;
    double stiffness, stretch; /* J/m^2, at the start */
    double spin, time;         /* rad/s at the start, s */
    int segments[4];           /* 0: no more */
} Motion;

/* Stiffness 10^4 times larger makes everything 100 times as fast.  The last
 * one is where implicit methods are at home: stiff springs that hardly move,
 * in a square that turns slowly. */
static const Motion motions[] = {
    {"soft", 1e5, 1.1, 0, 0.1, {16, 64, 128, 0}},
    {"stiff", 1e9, 1.1, 0, 0.02, {16, 32, 0}},
    {"spinning", 1e9, 1, 10, 0.1, {16, 0}},
};
enum { MOTIONS = sizeof motions / sizeof *motions };

/* A step has so many updates at most. */
enum { MAX_UPDATES = 2000, FIRST_STEPS = 8, REPEATS = 3, TARGETS = 5 };

/* Errors that the table asks for; the one that the first run may have, m. */
static const double targets[TARGETS] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
static const double first_error = 1e-2;

typedef struct Problem {
    const Motion *motion;
    Simulation simulation; /* Verlet's; its system is that of all runs */
    /* [4n] m, m/s, x and v: at the start, where they really end, room. */
    double *start, *exact, *room;
} Problem;

/* One run, or the fastest of several equal ones. */
typedef struct Rung {
    long steps;
    double tolerance, seconds;
    double error; /* m, root mean square over the masses, which are alike */
    bool failed;  /* not finite, not converged, or gone by a side */
} Rung;

/* The fastest run that comes below a target. */
typedef struct Best {
    const char *name; /* of its method; NULL: none does */
    double ms;
} Best;

/* Each interval H, omega H <= 1, is crossed by velocity Verlet in 1, 2, ... 6
 * steps; these results are extrapolated to steps of length 0.  Verlet is
 * symmetric, its error has even powers of the step, and what is left is
 * O(H^12) (Gragg 1965).  Lagrange: the polynomial in 1/n^2 through all results
 * has at 0 the sum over j of w_j times result j, with w_j = product over i of
 * n_j^2 / (n_j^2 - n_i^2). */
static Status find_exact(const Problem *problem)
{
    enum { COLUMNS = 6 };
    const Motion *motion = problem->motion;
    TimeIntegrator run = problem->simulation.run[0]; /* the same arrays */
    size_t both = 2 * run.size, bytes = both * sizeof *problem->exact;
    /* Eight springs at a node, each of 2k (3 |d|^2 / l2 - 1) at most: by
     * Gershgorin omega^2 is below twice their sum over m. */
    double along =
        2 * run.system->k[0] * (3 * motion->stretch * motion->stretch - 1);
    double omega = sqrt(2 * 8 * along / run.system->m[0]);
    long intervals = 1 + (long)(motion->time * omega);
    double H = motion->time / (double)intervals;
    Status status = STATUS_OK;
    memcpy(problem->exact, problem->start, bytes);
    for (long k = 0; k < intervals && !status; k++) {
        memcpy(problem->room, problem->exact, bytes);
        for (int j = 1; j <= COLUMNS && !status; j++) {
            double weight = 1;
            for (int i = 1; i <= COLUMNS; i++)
                weight *= i == j ? 1 : (double)(j * j) / (j * j - i * i);
            memcpy(run.x, problem->room, bytes); /* v is behind x */
            run.memory_h = 0;
            run.h = H / j;
            for (int step = 0; step < j && !status; step++)
                status = time_integrator_step(&run);
            for (size_t i = 0; i < both; i++)
                problem->exact[i] += weight * (run.x[i] - problem->room[i]);
        }
    }
    return status;
}

static Status create_problem(const Motion *motion, int segments,
                             Problem *problem)
{
    Options options = slides_options(segments);
    options.stiffness = motion->stiffness;
    options.stretch = motion->stretch;
    options.integrator = integrator_method("verlet") - integrator_methods;
    *problem = (Problem){.motion = motion};
    Simulation *simulation = &problem->simulation;
    Status status = simulation_create(&options, NULL, NULL, simulation);
    if (status)
        return status;
    size_t both = 2 * simulation->run[0].size;
    problem->start = malloc(3 * both * sizeof *problem->start);
    if (!problem->start)
        return STATUS_OUT_OF_MEMORY;
    problem->exact = problem->start + both;
    problem->room = problem->exact + both;
    const double *x = simulation->run[0].x;
    for (size_t i = 0; i < both / 2; i += 2) {
        double *start = problem->start + i, *v = start + both / 2;
        memcpy(start, x + i, 2 * sizeof *x);
        v[0] = -motion->spin * x[i + 1];
        v[1] = motion->spin * x[i];
    }
    return find_exact(problem);
}

/* From nothing to the end, once. */
static Status run_once(const Problem *problem, const IntegratorMethod *method,
                       Rung *rung)
{
    NewtonSettings settings = {.h = problem->motion->time / (double)rung->steps,
                               .tolerance = rung->tolerance,
                               .solver = SOLVER_MULTIGRID,
                               .max_iterations = MAX_UPDATES};
    System system = problem->simulation.system; /* the same arrays */
    size_t size = problem->simulation.run[0].size;
    TimeIntegrator run;
    double start = cpu_now(), sum = 0;
    Status status =
        time_integrator_create(method, &system, &settings, problem->start,
                               problem->start + size, &run);
    while (!status && run.steps < rung->steps)
        status = time_integrator_step(&run);
    rung->seconds = cpu_now() - start;
    for (size_t i = 0; run.x && i < run.size; i++)
        sum += pow(run.x[i] - problem->exact[i], 2);
    time_integrator_free(&run);
    rung->error = sqrt(2 * sum / (double)size);
    rung->failed = status || !(rung->error < problem->simulation.options.side);
    return status == STATUS_OUT_OF_MEMORY ? status : STATUS_OK;
}

/* What a minimisation leaves undone in a step is a change of velocity of at
 * most its tolerance; the sum over all steps is steps * tolerance * time / 2.
 * That may be a tenth of the error that is expected.  No run takes longer than
 * so much time, none follows an error that is small enough. */
static Status climb(bool quick, const Problem *problem,
                    const IntegratorMethod *method, Best best[TARGETS])
{
    const Motion *motion = problem->motion;
    int segments = problem->simulation.options.segments;
    double longest = quick ? 0.01 : segments / 64.0 + 0.25;
    double enough = quick ? 1e-5 : 1e-8, expected = first_error;
    Rung now = {.failed = true};
    for (long steps = FIRST_STEPS; now.failed || now.error >= enough;
         steps *= 2) {
        double fastest = INFINITY;
        now = (Rung){.steps = steps,
                     .tolerance = 0.2 * expected / (steps * motion->time)};
        for (int i = 0; i < REPEATS && (i == 0 || !now.failed); i++) {
            Status status = run_once(problem, method, &now);
            if (status)
                return status;
            fastest = fmin(fastest, now.seconds);
        }
        now.seconds = fastest;
        printf("%s,%d,%s,%s,%d,%ld,%.6g,%.6g,%.6g,%d\n", motion->name, segments,
               method->name, method->implicit ? "multigrid" : "none",
               method->order, steps, now.tolerance, now.seconds,
               fmin(now.error, 1e300), now.failed);
        for (int t = 0; t < TARGETS && !now.failed; t++)
            if (now.error <= targets[t] && 1e3 * fastest < best[t].ms)
                best[t] = (Best){method->name, 1e3 * fastest};
        if (2 * fastest > longest)
            break;
        expected = fmin(now.failed ? first_error : now.error, first_error) /
                   (1 << method->order);
    }
    return STATUS_OK;
}

/* All methods on one problem, and for each error the fastest explicit and the
 * fastest implicit one. */
static Status climb_all(bool quick, const Problem *problem)
{
    Best best[2][TARGETS];
    for (int i = 0; i < 2 * TARGETS; i++)
        best[i / TARGETS][i % TARGETS] = (Best){NULL, INFINITY};
    for (const IntegratorMethod *row = integrator_methods; row->name; row++) {
        Status status = climb(quick, problem, row, best[row->implicit]);
        if (status)
            return status;
    }
    printf("# %s, %g segments\n#  error m  best explicit             ms  best "
           "implicit        ms  implicit/explicit\n",
           problem->motion->name, problem->simulation.options.segments);
    for (int t = 0; t < TARGETS; t++) {
        const Best *one = &best[0][t], *other = &best[1][t];
        if (one->name && other->name)
            printf("#  %7.0e  %-16s %11.3f  %-14s %8.3f  %8.3g: implicit %s\n",
                   targets[t], one->name, one->ms, other->name, other->ms,
                   other->ms / one->ms, other->ms > one->ms ? "loses" : "wins");
    }
    return STATUS_OK;
}

static Status measure_work(bool quick)
{
    Status status = STATUS_OK;
    for (int m = 0; m < MOTIONS; m++)
        for (int i = 0; motions[m].segments[i] && !status; i++) {
            const Motion *motion = &motions[m];
            int segments = quick ? 4 : motion->segments[i];
            Problem problem;
            if (quick && i > 0)
                break;
            status = create_problem(motion, segments, &problem);
            if (!status)
                status = climb_all(quick, &problem);
            simulation_free(&problem.simulation);
            free(problem.start);
        }
    return status;
}

/* ---- steps --------------------------------------------------------------- */

/* Which fold a buckling step takes hangs on the last bits: so every run is
 * made from nine starts, stretches that are a billionth apart. */
enum { STARTS = 9, STEPS = 10, SOLVERS = 3 };

typedef enum Maker { LECTURE, NEWTON, MULTIGRID } Maker;

static const struct {
    const char *name;
    int largest; /* squares above take too long */
} makers[SOLVERS] = {{"lecture.c", 32}, {"newton", 64}, {"multigrid", 512}};

/* No further start of a size after so much time, s. */
static const double enough = 60;

/* All runs of one solver on one square; of each: */
typedef struct Runs {
    double ms[STARTS], updates[STARTS]; /* a step */
    double energy[STARTS];              /* at the end, % of that at the start */
    long unconverged;
} Runs;

static Status play(Maker maker, int segments, int start, int steps, Runs *runs)
{
    Simulation simulation;
    Options options = slides_options(segments);
    options.stretch += 1e-9 * start;
    options.solver = maker == MULTIGRID ? SOLVER_MULTIGRID : SOLVER_NEWTON;
    Status status = simulation_create(&options, NULL, NULL, &simulation);
    double energy = status ? 1 : simulation_energies(&simulation, 0).total;
    double began = cpu_now();
    for (int i = 0; i < steps && !status; i++) {
        status = maker == LECTURE
                     ? lecture_step(&simulation.system, options.timestep,
                                    options.tolerance, simulation.run[0].x,
                                    simulation.run[0].v)
                     : simulation_step(&simulation);
        if (status_is_unconverged(status)) {
            runs->unconverged++;
            status = STATUS_OK;
        }
    }
    runs->ms[start] = 1e3 * (cpu_now() - began) / steps;
    runs->updates[start] =
        (double)simulation_counters(&simulation).iterations / steps;
    if (!status)
        runs->energy[start] =
            100 * simulation_energies(&simulation, 0).total / energy;
    simulation_free(&simulation);
    return status;
}

/* All solvers on one square, by turns.  ms out: the median of a step */
static Status measure(bool quick, int segments, double ms[SOLVERS])
{
    Runs runs[SOLVERS] = {{.unconverged = 0}};
    int starts = quick ? 1 : STARTS, steps = quick ? 3 : STEPS;
    int count = 0;
    double began = clock_now();
    Status status = STATUS_OK;
    for (; count < starts && clock_now() - began < enough && !status; count++)
        for (int m = 0; m < SOLVERS && !status; m++)
            if (segments <= makers[m].largest)
                status = play((Maker)m, segments, count, steps, &runs[m]);
    for (int m = 0; m < SOLVERS && !status; m++) {
        Runs *all = &runs[m];
        if (segments > makers[m].largest)
            continue;
        ms[m] = median(all->ms, count); /* which sorts them */
        printf("%d,%s,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%ld\n", segments,
               makers[m].name, count, ms[m], all->ms[0], all->ms[count - 1],
               median(all->updates, count), median(all->energy, count),
               all->unconverged);
    }
    return status;
}

static Status measure_steps(bool quick)
{
    Status status = STATUS_OK;
    for (int n = 4; n <= (quick ? 32 : 512) && !status; n *= 2) {
        double ms[SOLVERS] = {0};
        status = measure(quick, n, ms);
        if (status || quick)
            continue;
        if (n == 32)
            claim("newton's time over that of the slides' program",
                  ms[NEWTON] / ms[LECTURE], 0.2);
        if (n == 32 || n == 64)
            claim("multigrid's time over newton's", ms[MULTIGRID] / ms[NEWTON],
                  n == 32 ? 0.1 : 0.025);
        if (n == 128)
            claim("ms a step of 128 segments", ms[MULTIGRID], 16);
    }
    return status;
}

/* ---- frames -------------------------------------------------------------- */

enum { FRAMES = 31 };

/* Median processor time of a frame of this size, in ms. */
static Status time_frames(const Show *show, int width, int height, double *ms)
{
    double spent[FRAMES];
    Paper paper;
    Status status = paper_create(width, height, &paper);
    for (int i = 0; i < FRAMES && !status; i++) {
        double start = cpu_now();
        show_draw(&paper, show);
        spent[i] = 1e3 * (cpu_now() - start);
    }
    if (!status)
        *ms = median(spent, FRAMES);
    paper_free(&paper);
    return status;
}

static Status measure_frames(bool quick)
{
    static Show show;
    static History history;
    Status status = STATUS_OK;
    double bare = 0, full = 0;
    for (int n = 4; n <= (quick ? 8 : 256) && !status; n *= 2) {
        Simulation simulation;
        Options options = slides_options(n);
        options.integrator = integrator_method("verlet") - integrator_methods;
        status = simulation_create(&options, NULL, NULL, &simulation);
        if (!status) {
            history.series = history.count = 0;
            Energy row[HISTORY_SERIES];
            history_add(&history, 0, show_sample(&simulation, row), row);
            show_create(&simulation, &show);
            show.pane[0].history = &history;
            show_describe(&show);
            status = time_frames(&show, 1280, 800, &full);
            show.bare = true;
        }
        if (!status)
            status = time_frames(&show, 900, 900, &bare);
        simulation_free(&simulation);
        if (!status)
            printf("%d,%.6g,%.6g\n", n, bare, full);
        if (n == 128)
            claim("ms to draw a bare frame of 128 segments", bare, 4);
    }
    return status;
}

/* ---- the program --------------------------------------------------------- */

static const struct {
    const char *name, *sentence;
    Status (*run)(bool quick);
    const char *columns;
} tables[] = {
    {"work", "error against run time of all methods", measure_work,
     "case,segments,integrator,solver,order,steps,tolerance_m_s,run_time_s,"
     "error_m,failed"},
    {"steps", "milliseconds a step: the slides' program, newton, multigrid",
     measure_steps,
     "segments,solver,starts,median_ms,least_ms,most_ms,updates,"
     "energy_end_percent,unconverged"},
    {"frames", "milliseconds a frame", measure_frames,
     "segments,bare_ms,full_ms"},
};
enum { TABLES = sizeof tables / sizeof *tables };

int main(int argc, char **argv)
{
    bool quick = argc == 3 && strcmp(argv[2], "--quick") == 0;
    int t = 0;
    while (t < TABLES && (argc < 2 || strcmp(argv[1], tables[t].name) != 0))
        t++;
    if (t == TABLES || argc != 2 + quick) {
        fprintf(stderr, "usage: elasto-bench TABLE [--quick]; tables:");
        for (t = 0; t < TABLES; t++)
            fprintf(stderr, " %s (%s)%s", tables[t].name, tables[t].sentence,
                    t + 1 < TABLES ? "," : "\n");
        return 2;
    }
    setvbuf(stdout, NULL, _IOLBF, 0); /* each line when it is measured */
    printf("# elasto %s; SuiteSparse %d.%d.%d; SDL %d.%d.%d; compiler %s; "
           "flags %s; one thread; %s run\n%s\n",
           ELASTO_VERSION, SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION,
           SUITESPARSE_SUBSUB_VERSION, SDL_MAJOR_VERSION, SDL_MINOR_VERSION,
           SDL_PATCHLEVEL, __VERSION__, BENCH_FLAGS, quick ? "quick" : "full",
           tables[t].columns);
    Status status = tables[t].run(quick);
    if (status)
        fprintf(stderr, "elasto-bench: %s\n", status_text(status));
    return status || fflush(stdout) || ferror(stdout);
}
