/* stress_contact.c - random scenes of contact, friction, cells, plastic flow,
 * damping, fracture and what moves, each a command line that can be run again.
 * No gap and no cell may end at any iterate, every step must end with finite
 * numbers, and one that did not converge must say so.
 */
#include "stress.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "model/cells.h"
#include "model/contact.h"

/* Seconds that one scene may take before it counts as one that never ends. */
enum { SCENE_LIMIT = 120, CONTACT_STEPS = 10 };

/* The smallest gap and cell of all iterates. */
typedef struct Narrow {
    Simulation simulation;
    double gap, J;
    bool finite;
} Narrow;

static bool look(void *user, const NewtonRecord *record)
{
    Narrow *narrow = user;
    (void)record;
    for (int r = 0; r < narrow->simulation.runs; r++) {
        const TimeIntegrator *run = &narrow->simulation.run[r];
        if (!run->newton || run->newton->counters.minimisations == 0)
            continue;
        const double *x = run->newton->at.x;
        double gap = smallest_gap(run->system, x);
        double J = smallest_cell(run->system, x);
        for (int i = 0; i < 2 * run->system->nodes; i++)
            narrow->finite = narrow->finite && isfinite(x[i]);
        narrow->gap = fmin(narrow->gap, gap);
        narrow->J = fmin(narrow->J, J);
    }
    return true;
}

/* Appends to a command line. */
static void append(char *line, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void append(char *line, size_t size, const char *format, ...)
{
    size_t used = strlen(line);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + used, size - used, format, arguments);
    va_end(arguments);
}

/* The random scene with this number. */
static void contact_line(uint64_t seed, long number, char *line, size_t size)
{
    static const char *const names[] = {"drop", "slope", "squeeze", "dent",
                                        "tear", "bend",  "square",  "square"};
    Random random = {seed * 1000003 + (uint64_t)number};
    int kind = random_below(&random, 8);
    bool square = kind >= 6, beam = kind == 5;
    double k = random_logarithmic(&random, 1e3, 1e8);
    line[0] = '\0';
    append(line, size, "%s --segments %d --stiffness %.3g --timestep %.3g",
           names[kind], beam ? 16 : 1 + random_below(&random, 6), k,
           random_logarithmic(&random, 3e-4, 1));
    append(line, size, " --tolerance %.3g",
           random_logarithmic(&random, 1e-8, 1e-2));
    if (random_below(&random, 3) == 0)
        append(line, size, " --cells %s",
               random_below(&random, 3) ? "on" : "off");
    if (random_below(&random, 4) == 0)
        append(line, size, " --filter clamp");
    if (kind != 4 && !square)
        append(line, size, " --friction %.3g", random_uniform(&random, 0, 1.5));
    if (kind != 4 && kind != 5)
        append(line, size, " --velocity %.3g,%.3g",
               random_uniform(&random, -1, 1) *
                   random_logarithmic(&random, 0.1, 100),
               -random_logarithmic(&random, 0.1, 100));
    if (square) { /* floor, wall and ball around a turned square */
        double stretch = random_uniform(&random, 0.6, 1.5);
        append(line, size,
               " --stretch %.3g --turn %.3g --gravity 9.81 --ground "
               "%.3g,1,0,-1.6 --ground 1,%.3g,-1.6,0 --ball %.3g,-1.8,0.6",
               stretch, random_uniform(&random, 0, 360),
               random_uniform(&random, -0.3, 0.3),
               random_uniform(&random, -0.3, 0.3),
               random_uniform(&random, -0.5, 0.5));
        append(line, size, " --friction %.3g --slip-speed %.3g --cells on",
               random_uniform(&random, 0, 1.5),
               random_logarithmic(&random, 1e-4, 1));
    }
    if (random_below(&random, 3) == 0)
        append(line, size, " --yield %.3g --hardening %.3g",
               random_logarithmic(&random, 0.01, 0.5),
               random_uniform(&random, 0, 2));
    if (random_below(&random, 3) == 0)
        append(line, size, " --tear %.3g",
               random_logarithmic(&random, 0.03, 1));
    if (random_below(&random, 3) == 0)
        append(line, size, " --damping %.3g",
               random_logarithmic(&random, 1e-5, 10));
    if (kind != 4 && random_below(&random, 3) == 0)
        append(line, size, " --barrier %.3g,%.3g",
               random_logarithmic(&random, 1e-4, 0.004),
               k * random_logarithmic(&random, 0.1, 100));
}

/* Some steps of it; reason [512] out where a promise was broken. */
static Verdict contact_run(const char *line, Tally *tally, char *reason)
{
    static Narrow narrow;
    narrow = (Narrow){.gap = INFINITY, .J = INFINITY, .finite = true};
    bool reported = false;
    alarm(SCENE_LIMIT);
    simulation_from_line(line, look, &narrow, &narrow.simulation);
    tally->cases++;
    for (int step = 0; step < CONTACT_STEPS; step++) {
        Status status = simulation_step(&narrow.simulation);
        bool ended = !status || status_is_unconverged(status);
        reported = reported || status;
        tally->steps[status ? VERDICT_REPORTED : VERDICT_CONVERGED]++;
        tally->statuses[status]++;
        if (ended && narrow.gap > 0 && narrow.J > 0 && narrow.finite)
            continue;
        snprintf(reason, 512, "%.400s: step %d: %s, smallest gap %g, cell %g%s",
                 line, step + 1, status_name(status), narrow.gap, narrow.J,
                 narrow.finite ? "" : ", not finite");
        tally->wrong++;
        simulation_free(&narrow.simulation);
        return VERDICT_WRONG;
    }
    simulation_free(&narrow.simulation);
    return reported ? VERDICT_REPORTED : VERDICT_CONVERGED;
}

uint64_t stress_contact_seed = 1;

/* This many scenes; the first that is wrong ends them. */
static bool contact_scenes(long count, Tally *tally, char *reason)
{
    char line[512];
    for (long i = 0; i < count; i++) {
        contact_line(stress_contact_seed, i, line, sizeof line);
        if (contact_run(line, tally, reason) == VERDICT_WRONG)
            return false;
    }
    alarm(0);
    long steps = tally->steps[VERDICT_CONVERGED];
    long all = steps + tally->steps[VERDICT_REPORTED];
    if ((double)steps >= 0.999 * (double)all)
        return true;
    snprintf(reason, 512, "only %ld of %ld steps converged", steps, all);
    return false;
}

bool stress_contact(Tally *tally, char *reason)
{
    return contact_scenes(20000, tally, reason);
}

bool stress_contact_small(Tally *tally, char *reason)
{
    return contact_scenes(120, tally, reason);
}
