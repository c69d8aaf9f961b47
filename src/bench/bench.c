/* bench.c - the program elasto-bench: run time against error, and how long
 * steps and frames take. */
#include "bench/bench.h"
#include "base/clock.h"
#include "picture/picture.h"

#include <SDL_version.h>
#include <cholmod.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

double bench_cpu(void)
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

Options slides_options(int segments)
{
    char message[128];
    Options options;
    options_of_line("square", &options, message, sizeof message);
    options.segments = segments;
    return options;
}

/* ---- steps
 * ------------------------------------------------------------------- */

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
    double began = bench_cpu();
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
    runs->ms[start] = 1e3 * (bench_cpu() - began) / steps;
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

/* ---- frames
 * ------------------------------------------------------------------ */

enum { FRAMES = 31 };

/* Median processor time of a frame of this size, in ms. */
static Status time_frames(const Show *show, int width, int height, double *ms)
{
    double spent[FRAMES];
    Paper paper;
    Status status = paper_create(width, height, &paper);
    for (int i = 0; i < FRAMES && !status; i++) {
        double start = bench_cpu();
        show_draw(&paper, show);
        spent[i] = 1e3 * (bench_cpu() - start);
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

/* ---- the program -----------------------------------------------------------
 */

static const struct {
    const char *name, *sentence;
    Status (*run)(bool quick);
    const char *columns;
} tables[] = {
    {"work", "error against run time of all methods", bench_work,
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
