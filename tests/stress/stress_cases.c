/* The cases that have a name: places where floating point is known to bite. */
#include "stress.h"

#include <stdio.h>
#include <string.h>

/* So many steps of a command line, with one solver or the other; where it
 * begins with '!' all must converge. */
typedef struct Line {
    int steps;
    const char *line; /* NULL: the end of a list */
} Line;

static bool run_line(Tally *tally, char *reason, Line row, int solver)
{
    char line[STRESS_LINE];
    bool converges = row.line[0] == '!';
    snprintf(line, sizeof line, "%s --solver %s", row.line + converges,
             solver_name(solver));
    Verdict verdict = stress_run(line, row.steps, tally, reason);
    if (verdict == VERDICT_REPORTED && converges)
        snprintf(reason, 512, "it does not converge");
    if (verdict == VERDICT_WRONG || (verdict && converges)) {
        strncat(strncat(reason, ": ", 3), line, 511 - strlen(reason));
        return false;
    }
    return true;
}

static bool extreme_squares(Tally *tally, char *reason)
{
    static const Line rows[] = {
        {5, "!--timestep 1e3"},
        {5, "!--timestep 1e3 --stretch 0.3"},
        {5, "!--timestep 1e3 --stretch 100"},
        {5, "!--timestep 1e3 --segments 1"},
        {5, "!--stiffness 1e-6"},
        {5, "!--stiffness 1e15"},
        {5, "!--stiffness 1e-6 --stretch 0.1"},
        {5, "!--stiffness 1e15 --stretch 0.9"},
        {5, "--stretch 1e6"},
        {5, "--stretch 1e-6"},
        {5, "--stretch 0"},
        {5, "--stretch -1.4"},
        {5, "--stretch 1e3"},
        {5, "--stretch 0.1"},
        /* h^2 k/m from 1e22 to 1e31: the factor needs a shift or is not exact,
         * and conjugate gradients break down; curvatures are rounded to 0 */
        {4, "--segments 2 --density 1 --stiffness 1e15 --stretch 20 "
            "--timestep 1e6"},
        {4, "--segments 2 --side 0.04096289353718123 --density "
            "0.075213809795248179 --stiffness 3099333258.9627662 --stretch "
            "1.9217744152891494 --timestep 34289.345836827328 --tolerance "
            "0.22234558596351073 --integrator midpoint"},
        {1, "--segments 2 --density 1e-6 --stiffness 1e13 --timestep 1e6"},
        /* all nodes in one place: E falls by 1e-7 J s^2, P is 1e21 */
        {1, "--segments 1 --stiffness 2.02e+11 --density 0.0726 --side 0.00461 "
            "--timestep 1.31e+03 --filter abs --integrator avf4 "
            "shaken 8.01e+05"},
        {50, "!--segments 1"},
        {50, "!--segments 1 --stretch 0.2"},
        {50, "!--segments 1 --timestep 1"},
        {0, NULL},
    };
    for (const Line *row = rows; row->line; row++)
        if (!run_line(tally, reason, *row, SOLVER_NEWTON) ||
            !run_line(tally, reason, *row, SOLVER_MULTIGRID))
            return false;
    return true;
}

static bool large_squares(Tally *tally, char *reason)
{
    static const Line rows[] = {
        {40, "--segments 33"},
        {20, "--segments 64"},
        {14, "--segments 64 --minimum"},
        {6, "--segments 97 --stretch 0.7"},
        {10, "--segments 128"},
        {6, "--segments 128 --timestep 0.0166"},
        {8, "--segments 48 --stretch 2.5"},
        {5, "--segments 48 --stretch 0.5 --timestep 0.02"},
        {4, "--segments 40 --stretch 0.1 --timestep 0.1"},
        {5, "--segments 40 --stiffness 1e9 --stretch 1.1"},
        {8, "--segments 40 --stiffness 1e3 --timestep 0.1"},
        {12, "--segments 40 --integrator bdf2"},
        {12, "--segments 40 --integrator midpoint --stretch 1.2"},
        {8, "--segments 40 --integrator sdirk2"},
        {10, "--segments 40 --tolerance 1e-6"},
        {14, "--segments 40 --tolerance 1"},
        {15, "--segments 36 --gravity 9.81 --pin top-corners --stretch 1 "
             "--timestep 0.01 --stiffness 1e4"},
        {12, "--segments 35 --pin left --stretch 1.3"},
        {6, "--segments 33 --side 1e-3 --density 1e-3 --stiffness 1e-3"},
        {6, "--segments 33 --side 1e3 --stiffness 1e9"},
        {0, NULL},
    };
    for (const Line *row = rows; row->line; row++)
        if (!run_line(tally, reason, *row, SOLVER_MULTIGRID))
            return false;
    return true;
}

/* Every integrator, gently and hard. */
static bool every_integrator(Tally *tally, char *reason)
{
    for (int i = 0; integrator_methods[i].name; i++)
        for (int way = 0; way < 4; way++) {
            char line[128];
            snprintf(line, sizeof line, "--integrator %s --timestep %s",
                     integrator_methods[i].name, way < 2 ? "0.05" : "1e-3");
            if (!run_line(tally, reason, (Line){20, line}, way % 2))
                return false;
        }
    return true;
}

/* A default square that is kicked at random every 50 steps; residuals are
 * computed again of some steps. */
static bool many_steps(Tally *tally, char *reason)
{
    Random random = {7};
    Simulation simulation;
    Watch watch;
    simulation_from_line("--stretch 1.4", NULL, NULL, &simulation);
    TimeIntegrator *run = &simulation.run[0];
    bool good = watch_create(run, tally, &watch);
    for (long step = 0; step < 300000 && good; step++) {
        for (size_t i = 0; step % 50 == 0 && i < run->size; i++)
            run->v[i] += random_uniform(&random, -3, 3);
        watch.residuals = step % 500 < 3;
        good = watch_step(&watch) != VERDICT_WRONG;
    }
    memcpy(reason, watch.reason, sizeof watch.reason);
    watch_free(&watch);
    simulation_free(&simulation);
    tally->cases++;
    tally->wrong += !good;
    return good;
}

const StressCase stress_cases[] = {
    {"extreme squares", false, extreme_squares},
    {"large squares", true, large_squares},
    {"every integrator", false, every_integrator},
    {"many steps", true, many_steps},
    {NULL, false, NULL},
};
