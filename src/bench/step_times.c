#include "base/clock.h"
#include "bench/bench.h"

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
        ms[m] = bench_median(all->ms, count); /* which sorts them */
        printf("%d,%s,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%ld\n", segments,
               makers[m].name, count, ms[m], all->ms[0], all->ms[count - 1],
               bench_median(all->updates, count),
               bench_median(all->energy, count), all->unconverged);
    }
    return status;
}

Status bench_steps(bool quick)
{
    Status status = STATUS_OK;
    for (int n = 4; n <= (quick ? 32 : 512) && !status; n *= 2) {
        double ms[SOLVERS] = {0};
        status = measure(quick, n, ms);
        if (status || quick)
            continue;
        if (n == 32)
            bench_claim("newton's time over that of the slides' program",
                        ms[NEWTON] / ms[LECTURE], 0.2);
        if (n == 32 || n == 64)
            bench_claim("multigrid's time over newton's",
                        ms[MULTIGRID] / ms[NEWTON], n == 32 ? 0.1 : 0.025);
        if (n == 128)
            bench_claim("ms a step of 128 segments", ms[MULTIGRID], 16);
    }
    return status;
}
