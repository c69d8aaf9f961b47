/* The cases that have a name: places where floating point is known to bite, and
 * those whose answer is known beforehand.
 */
#include "stress.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool case_wrong(Case *c, const char *format, ...)
{
    va_list arguments;
    if (!c->wrong) {
        va_start(arguments, format);
        vsnprintf(c->reason, 512, format, arguments);
        va_end(arguments);
    }
    c->wrong = true;
    return false;
}

bool case_open(Case *c, const char *line)
{
    simulation_from_line(line, NULL, NULL, &c->simulation);
    c->run = &c->simulation.run[0];
    if (watch_create(c->run, &c->watch))
        return true;
    return case_wrong(c, "no memory");
}

bool case_restart(Case *c, double finer)
{
    Status status = watch_restart(c->run, finer);
    watch_free(&c->watch);
    if (status)
        return case_wrong(c, "restart: %s", status_name(status));
    return watch_create(c->run, &c->watch) || case_wrong(c, "no memory");
}

bool case_steps(Case *c, int steps)
{
    for (int i = 0; i < steps; i++) {
        Verdict verdict = watch_step(&c->watch);
        c->tally->statuses[c->watch.status]++;
        if (verdict == VERDICT_WRONG)
            return case_wrong(c, "%s", c->watch.reason);
    }
    return true;
}

bool case_converges(Case *c, int steps)
{
    for (int i = 0; i < steps; i++)
        if (case_steps(c, 1) && c->watch.status)
            return case_wrong(c, "step %d: %s", i + 1,
                              status_name(c->watch.status));
    return !c->wrong;
}

bool case_close(Case *c)
{
    bool good = !c->wrong;
    if (c->run) {
        tally_add(&c->watch, c->tally);
        watch_free(&c->watch);
        simulation_free(&c->simulation);
    }
    c->run = NULL;
    c->tally->cases++;
    c->tally->wrong += !good;
    return good;
}

int case_size(const Case *c)
{
    return 2 * c->run->system->nodes;
}

/* So many steps of a command line, with one solver or the other; where it
 * begins with '!' all must converge. */
typedef struct Line {
    int steps;
    const char *line; /* NULL: the end of a list */
} Line;

static bool run_line(Tally *tally, char *reason, Line row, int solver)
{
    char line[STRESS_LINE];
    Case c = {.tally = tally, .reason = reason};
    bool converge = row.line[0] == '!';
    snprintf(line, sizeof line, " %s --solver %s", row.line + converge,
             solver_name(solver));
    if (case_open(&c, line + 1))
        converge ? case_converges(&c, row.steps) : case_steps(&c, row.steps);
    if (c.wrong)
        strncat(reason, line, 511 - strlen(reason));
    return case_close(&c);
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

/* A default square that is kicked at random every 50 steps. */
static bool many_steps(Tally *tally, char *reason)
{
    Random random = {7};
    Case c = {.tally = tally, .reason = reason};
    if (case_open(&c, "--stretch 1.4"))
        for (long step = 0; step < 300000 && !c.wrong; step++) {
            for (int i = 0; step % 50 == 0 && i < case_size(&c); i++)
                c.run->v[i] += random_uniform(&random, -3, 3);
            c.watch.residuals = step % 500 < 3;
            case_steps(&c, 1);
        }
    return case_close(&c);
}

/* ---- answers known beforehand ------------------------------------------- */

/* A square at rest lengths that flies far out, for every length of step. */
static bool fly(Tally *tally, char *reason, double h, double offset)
{
    char line[80];
    Case c = {.tally = tally, .reason = reason};
    snprintf(line, sizeof line,
             "--segments 3 --stretch 1 --tolerance 1e-10 --timestep %.17g", h);
    if (case_open(&c, line)) {
        System *system = &c.simulation.system;
        for (int i = 0; i < case_size(&c); i++) {
            c.run->x[i] += offset;
            c.run->v[i] = i % 2 ? -2 : 3;
        }
        for (int s = 0; s < system->springs; s++) {
            int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
            double dx = c.run->x[i] - c.run->x[j];
            double dy = c.run->x[i + 1] - c.run->x[j + 1];
            system->l2[s] = dx * dx + dy * dy;
        }
        if (case_restart(&c, 1))
            case_converges(&c, 3);
        /* x + h v is rounded, which strains the springs a little */
        double strain = (offset + 10 * h) * DBL_EPSILON;
        double allowed = 1e-10 + 1e4 * fmin(strain * h, strain / h);
        for (int i = 0; i < case_size(&c); i++)
            if (!(fabs(c.run->v[i] - (i % 2 ? -2 : 3)) <= allowed))
                case_wrong(&c, "h %g: velocity is off by %g", h,
                           c.run->v[i] - (i % 2 ? -2 : 3));
    }
    return case_close(&c);
}

static bool free_flight(Tally *tally, char *reason)
{
    for (int i = -9; i <= 3; i++)
        if (!fly(tally, reason, pow(10, i), 0) ||
            !fly(tally, reason, pow(10, i), 1e6))
            return false;
    return true;
}

const StressCase stress_cases[] = {
    {"extreme squares", false, extreme_squares},
    {"large squares", true, large_squares},
    {"every integrator", false, every_integrator},
    {"free flight", false, free_flight},
    {"many steps", true, many_steps},
    {NULL, false, NULL},
};
