/* bench.c - measures run time against error, and the time of a step. */
#include <SDL.h>
#include <cholmod.h>
#include <math.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "lesson/command_line.h"
#include "scenes/small_scenes.h"

/* Place in make_lecture_step to which a call of exit in lecture.c jumps. */
static jmp_buf program_ended;

#define exit(code) longjmp(program_ended, code)
#define main       lecture_main
int main(int argc, char **argv);
#include "lecture.c"
#undef main
#undef exit

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts the values and returns their median.  count > 0. */
static double find_median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare_doubles);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

/* Prints a claim of the README, the measured number, and whether it is met. */
static void print_claim(const char *what, double measured, double at_most)
{
    printf("# claim: %s: %.3g, at most %g: %s\n", what, measured, at_most,
           measured <= at_most ? "met" : "NOT MET");
}

/* Returns the options of the slides, with this many segments. */
static Options make_slides_options(int segments)
{
    char message[128];
    Options options;
    options_parse_line("square", &options, MESSAGE(message));
    options.segments = segments;
    return options;
}

/* ---- work ---------------------------------------------------------------- */

/* A motion for the table `work`.  Every method simulates the same time in 8,
 * 16, 32, ... steps, until a run takes too long or is accurate enough. */
typedef struct BenchMotion {
    const char *name;
    double stiffness;      /* J/m^2 */
    double stretch;        /* factor on all x at the start */
    double spin;           /* angular velocity at the start, rad/s */
    double duration;       /* duration, s */
    int segment_counts[4]; /* segments of each square, then 0 */
} BenchMotion;

/* A stiffness 10^4 times as large makes vibrations 100 times as fast.  The last
 * motion suits implicit methods: a stiff square turns and hardly vibrates. */
static const BenchMotion motions[] = {
    {"soft", 1e5, 1.1, 0, 0.1, {16, 64, 128, 0}},
    {"stiff", 1e9, 1.1, 0, 0.02, {16, 32, 0}},
    {"spinning", 1e9, 1, 10, 0.1, {16, 0}},
};
enum { MOTION_COUNT = sizeof motions / sizeof *motions };

enum { FEWEST_STEPS = 8, TARGET_COUNT = 5 };

/* Errors for which the fastest methods are named, m */
static const double targets[TARGET_COUNT] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

/* Expected error of the first run, m */
static const double first_error = 1e-2;

/* The fastest run with an error below a target. */
typedef struct BestMethod {
    const char *name; /* method; NULL: no run met the target */
    double run_ms;    /* run time */
} BestMethod;

/* Creates a simulation: run 0 is the start of the motion, run 1 its end. */
static Status create_motion_simulation(const BenchMotion *motion, int segments,
                                       Simulation *simulation)
{
    Options options = make_slides_options(segments);
    options.stiffness = motion->stiffness;
    options.stretch = motion->stretch;
    options.solver = SOLVER_MULTIGRID;
    Status status = simulation_create(&options, NULL, NULL, simulation);
    if (status)
        return status;
    TimeIntegrator *start = &simulation->run[0];
    for (size_t i = 0; i < start->x_length; i += 2) {
        start->v[i] = -motion->spin * start->x[i + 1];
        start->v[i + 1] = motion->spin * start->x[i];
    }
    return race_make_reference(simulation, motion->duration);
}

/* Measures a method with 8, 16, 32, ... steps, up to a run that takes too long
 * or is accurate enough.
 *
 * Tolerance: the last p of a step changes velocities by at most the tolerance,
 * so the last p of all steps together change positions by at most
 * steps * tolerance * time / 2.  The bound may equal the expected error of the
 * method, since each step applies its last p and leaves a far smaller error. */
static Status measure_method(bool quick, const BenchMotion *motion,
                             Simulation *simulation,
                             const IntegratorMethod *method,
                             BestMethod best[TARGET_COUNT])
{
    int segments = simulation->options.segments;
    double longest = quick ? 0.01 : segments / 64.0 + 0.25;
    double enough = quick ? 1e-5 : 1e-8, expected = first_error;
    RaceResult now = {.error = INFINITY};
    for (long steps = FEWEST_STEPS; !(now.error < enough); steps *= 2) {
        TimeIntegrator run = {0};
        simulation->options.tolerance =
            2 * expected / (steps * motion->duration);
        Status status = race_measure_method(
            simulation, method, motion->duration, steps, &run, &now);
        time_integrator_free(&run);
        if (status == STATUS_OUT_OF_MEMORY)
            return status;
        bool failed = !(now.converged && now.error < simulation->options.side);
        double ms = 1e3 * now.processor_time;
        printf("%s,%d,%s,%s,%d,%ld,%.6g,%.6g,%.6g,%d\n", motion->name, segments,
               method->name, method->stages > 0 ? "multigrid" : "none",
               method->order, steps, simulation->options.tolerance,
               now.processor_time, fmin(now.error, 1e300), failed);
        if (failed)
            now.error = INFINITY;
        for (int t = 0; t < TARGET_COUNT; t++)
            if (now.error <= targets[t] && ms < best[t].run_ms)
                best[t] = (BestMethod){method->name, ms};
        if (2 * now.processor_time > longest)
            break;
        expected = fmin(now.error, first_error) / (1 << method->order);
    }
    return STATUS_OK;
}

/* Measures all methods on one motion.  Prints the fastest explicit and the
 * fastest implicit method for each target. */
static Status measure_motion(bool quick, const BenchMotion *motion,
                             Simulation *simulation)
{
    BestMethod best[2][TARGET_COUNT];
    for (int i = 0; i < 2 * TARGET_COUNT; i++)
        best[i / TARGET_COUNT][i % TARGET_COUNT] = (BestMethod){NULL, INFINITY};
    for (const IntegratorMethod *method = integrator_methods; method->name;
         method++) {
        Status status = measure_method(quick, motion, simulation, method,
                                       best[method->stages > 0]);
        if (status)
            return status;
    }
    printf("# %s, %g segments\n#  error m  best explicit             ms  best "
           "implicit        ms  implicit/explicit\n",
           motion->name, simulation->options.segments);
    for (int t = 0; t < TARGET_COUNT; t++) {
        const BestMethod *one = &best[0][t], *other = &best[1][t];
        if (one->name && other->name)
            printf("#  %7.0e  %-16s %11.3f  %-14s %8.3f  %8.3g: implicit %s\n",
                   targets[t], one->name, one->run_ms, other->name,
                   other->run_ms, other->run_ms / one->run_ms,
                   other->run_ms > one->run_ms ? "loses" : "wins");
    }
    return STATUS_OK;
}

static Status measure_work_precision(bool quick)
{
    Status status = STATUS_OK;
    for (int m = 0; m < MOTION_COUNT; m++)
        for (int i = 0; motions[m].segment_counts[i] && !status; i++) {
            const BenchMotion *motion = &motions[m];
            Simulation simulation;
            if (quick && i > 0)
                break;
            status = create_motion_simulation(
                motion, quick ? 4 : motion->segment_counts[i], &simulation);
            if (!status)
                status = measure_motion(quick, motion, &simulation);
            simulation_free(&simulation);
        }
    return status;
}

/* ---- steps --------------------------------------------------------------- */

/* Rounding decides how the square folds when it buckles.  Every program
 * therefore runs from nine starts, whose stretches differ by 1e-9. */
enum { START_COUNT = 9, STEPS_PER_START = 10, PROGRAM_COUNT = 3 };

typedef enum BenchProgram { LECTURE, NEWTON, MULTIGRID } BenchProgram;

static const struct {
    const char *name;
    int max_segments; /* largest number of segments that is measured */
} programs[PROGRAM_COUNT] = {
    {"lecture.c", 32}, {"newton", 64}, {"multigrid", 512}};

/* Time after which no further start of the same size begins, s */
static const double time_limit = 60;

/* Results of one program on one square, for each start. */
typedef struct ProgramResults {
    double step_ms[START_COUNT];          /* processor time a step */
    double updates_per_step[START_COUNT]; /* number of updates of x per step */
    double end_energy_percent[START_COUNT]; /* % of the energy at the start */
    long unconverged_steps; /* number in the runs from all starts */
} ProgramResults;

/* Makes a step by step_forward of lecture.c, with the springs and masses of a
 * system.  Returns OK, OUT_OF_MEMORY, or LINE_SEARCH_LIMIT where lecture.c ends
 * the program; x is then the last iterate. */
static Status make_lecture_step(const System *system, double h, double tol,
                                double *x, double *v)
{
    Spring *e = malloc((size_t)system->springs * sizeof *e);
    if (!e)
        return STATUS_OUT_OF_MEMORY;
    for (int s = 0; s < system->springs; s++)
        e[s] = (Spring){system->e[2 * s], system->e[2 * s + 1], system->l2[s],
                        system->k[s]};
    Solid solid = {system->nodes, system->springs, (Vec2 *)x,
                   (Vec2 *)v,     system->m,       e};
    volatile Status status = STATUS_LINE_SEARCH_LIMIT;
    if (!setjmp(program_ended)) {
        step_forward(&solid, h, tol, 0, NULL);
        status = STATUS_OK;
    }
    free(e);
    return status;
}

/* Runs a program from one start and stores its results. */
static Status measure_run_from_start(BenchProgram program, int segments,
                                     int start, int steps, ProgramResults *runs)
{
    Simulation simulation;
    Options options = make_slides_options(segments);
    options.stretch += 1e-9 * start;
    options.solver = program == MULTIGRID ? SOLVER_MULTIGRID : SOLVER_NEWTON;
    Status status = simulation_create(&options, NULL, NULL, &simulation);
    double energy = status ? 1 : simulation_get_energies(&simulation, 0).total;
    double began = clock_processor_time();
    for (int i = 0; i < steps && !status; i++) {
        status = program == LECTURE
                     ? make_lecture_step(&simulation.system, options.timestep,
                                         options.tolerance, simulation.run[0].x,
                                         simulation.run[0].v)
                     : simulation_step(&simulation);
        if (status_is_unconverged(status)) {
            runs->unconverged_steps++;
            status = STATUS_OK;
        }
    }
    runs->step_ms[start] = 1e3 * (clock_processor_time() - began) / steps;
    runs->updates_per_step[start] =
        (double)simulation_sum_newton_counters(&simulation).updates / steps;
    if (!status)
        runs->end_energy_percent[start] =
            100 * simulation_get_energies(&simulation, 0).total / energy;
    simulation_free(&simulation);
    return status;
}

/* Runs all programs from each start of one square, and prints the medians.
 *   ms  out, median time a step */
static Status measure_programs(bool quick, int segments,
                               double ms[PROGRAM_COUNT])
{
    ProgramResults runs[PROGRAM_COUNT] = {{.unconverged_steps = 0}};
    int starts = quick ? 1 : START_COUNT, steps = quick ? 3 : STEPS_PER_START;
    int count = 0;
    double began = clock_now();
    Status status = STATUS_OK;
    for (; count < starts && clock_now() - began < time_limit && !status;
         count++)
        for (int m = 0; m < PROGRAM_COUNT && !status; m++)
            if (segments <= programs[m].max_segments)
                status = measure_run_from_start((BenchProgram)m, segments,
                                                count, steps, &runs[m]);
    for (int m = 0; m < PROGRAM_COUNT && !status; m++) {
        ProgramResults *all = &runs[m];
        if (segments > programs[m].max_segments)
            continue;
        ms[m] = find_median(all->step_ms, count); /* sorts step_ms */
        printf("%d,%s,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%ld\n", segments,
               programs[m].name, count, ms[m], all->step_ms[0],
               all->step_ms[count - 1],
               find_median(all->updates_per_step, count),
               find_median(all->end_energy_percent, count),
               all->unconverged_steps);
    }
    return status;
}

static Status measure_step_times(bool quick)
{
    Status status = STATUS_OK;
    for (int n = 4; n <= (quick ? 32 : 512) && !status; n *= 2) {
        double ms[PROGRAM_COUNT] = {0};
        status = measure_programs(quick, n, ms);
        if (status || quick)
            continue;
        if (n == 32)
            print_claim("newton's time over that of the slides' program",
                        ms[NEWTON] / ms[LECTURE], 0.2);
        if (n == 32 || n == 64)
            print_claim("multigrid's time over newton's",
                        ms[MULTIGRID] / ms[NEWTON], n == 32 ? 0.1 : 0.025);
        if (n == 128)
            print_claim("ms a step of 128 segments", ms[MULTIGRID], 16);
    }
    return status;
}

/* ---- the program --------------------------------------------------------- */

static const struct {
    const char *name, *description;
    Status (*run)(bool quick);
    const char *heading; /* heading of the table */
} tables[] = {
    {"work", "error against run time of all methods", measure_work_precision,
     "case,segments,integrator,solver,order,steps,tolerance_m_s,run_time_s,"
     "error_m,failed"},
    {"steps", "milliseconds a step: the slides' program, newton, multigrid",
     measure_step_times,
     "segments,solver,starts,median_ms,least_ms,most_ms,updates,"
     "energy_end_percent,unconverged"},
};
enum { TABLE_COUNT = sizeof tables / sizeof *tables };

int main(int argc, char **argv)
{
    bool quick = argc == 3 && strcmp(argv[2], "--quick") == 0;
    int t = 0;
    while (t < TABLE_COUNT &&
           (argc < 2 || strcmp(argv[1], tables[t].name) != 0))
        t++;
    if (t == TABLE_COUNT || argc != 2 + quick) {
        fprintf(stderr, "usage: elasto-bench TABLE [--quick]; tables:");
        for (t = 0; t < TABLE_COUNT; t++)
            fprintf(stderr, " %s (%s)%s", tables[t].name, tables[t].description,
                    t + 1 < TABLE_COUNT ? "," : "\n");
        return 2;
    }
    setvbuf(stdout, NULL, _IOLBF, 0); /* each line is written at once */
    printf("# elasto %s; SuiteSparse %d.%d.%d; SDL %d.%d.%d; compiler %s; "
           "flags %s; one thread; %s run\n%s\n",
           ELASTO_VERSION, SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION,
           SUITESPARSE_SUBSUB_VERSION, SDL_MAJOR_VERSION, SDL_MINOR_VERSION,
           SDL_PATCHLEVEL, __VERSION__, BENCH_FLAGS, quick ? "quick" : "full",
           tables[t].heading);
    Status status = tables[t].run(quick);
    if (status)
        fprintf(stderr, "elasto-bench: %s\n", status_text(status));
    return status || fflush(stdout) || ferror(stdout);
}
