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

/* Steps of two runs side by side; every number of one is that of the other
 * times a factor, to the last bit. */
static bool same_after_scaling(Case *a, Case *b, const double x_factor[2],
                               double time)
{
    for (int step = 0; step < 10; step++) {
        if (!case_steps(a, 1) || !case_steps(b, 1))
            return false;
        if (a->watch.status != b->watch.status)
            return case_wrong(a, "step %d: %s became %s", step,
                              status_name(a->watch.status),
                              status_name(b->watch.status));
        for (int i = 0; i < case_size(a); i++)
            if (a->run->x[i] * x_factor[i % 2] != b->run->x[i] ||
                a->run->v[i] * (x_factor[i % 2] / time) != b->run->v[i])
                return case_wrong(a, "step %d, number %d: x %a became %a", step,
                                  i, a->run->x[i], b->run->x[i]);
    }
    return true;
}

/* The whole scene in other units of length (x and y), mass and time. */
static void change_units(Case *c, const double length[2], double mass,
                         double time)
{
    System *system = &c->simulation.system;
    for (int i = 0; i < case_size(c); i++) {
        c->run->x[i] *= length[i % 2];
        c->run->v[i] *= length[i % 2] / time;
    }
    for (int i = 0; i < system->nodes; i++)
        system->m[i] *= mass;
    for (int s = 0; s < system->springs; s++) {
        system->l2[s] *= length[0] * length[0];
        system->k[s] *= mass / time / time;
    }
    c->run->h *= time;
    case_restart(c, fabs(length[0]) / time);
}

/* Mirrored, and in other units: powers of two, so that no number changes but in
 * its exponent; masses by powers of four, because a Cholesky factor holds their
 * roots. */
static bool other_units(Tally *tally, char *reason)
{
    static const char *const lines[] = {
        "--stretch 1.4",
        "--stretch 0.5 --timestep 0.02",
        "--stretch 0.05 --timestep 0.5 --solver multigrid",
        "--stretch 3 --solver multigrid --segments 5",
        "--stretch 1.4 --tolerance 1e-30 --segments 2", /* to the last digit */
        "--stiffness 1e15 --timestep 1",                /* needs a shift */
        "--stretch 0.7 --integrator avf --timestep 0.02",
        "--stretch 0.7 --integrator bdf2 --timestep 0.02 --solver multigrid",
        "--stretch 0.7 --integrator sdirk2 --timestep 0.05",
        "--stretch 1.2 --integrator verlet --timestep 1e-3",
    };
    static const struct {
        double length[2], mass, time;
    } units[] = {{{-1, 1}, 1, 1},
                 {{1, -1}, 1, 1},
                 {{0x1p20, 0x1p20}, 1, 1},
                 {{0x1p-20, 0x1p-20}, 1, 1},
                 {{1, 1}, 0x1p20, 1},
                 {{1, 1}, 0x1p-20, 1},
                 {{1, 1}, 1, 0x1p20},
                 {{1, 1}, 1, 0x1p-20},
                 {{0x1p3, 0x1p3}, 0x1p-10, 0x1p7}};
    for (int i = 0; i < 10 * 9; i++) {
        Case a = {.tally = tally, .reason = reason}, b = a;
        if (case_open(&a, lines[i / 9]) && case_open(&b, lines[i / 9])) {
            for (int j = 0; j < case_size(&a); j++)
                a.run->v[j] = b.run->v[j] = 0.1 * (j * 7 % 5) - 0.2;
            change_units(&b, units[i % 9].length, units[i % 9].mass,
                         units[i % 9].time);
            same_after_scaling(&a, &b, units[i % 9].length, units[i % 9].time);
        }
        bool good = case_close(&a);
        if (!case_close(&b) || !good)
            return false;
    }
    return true;
}

/* Turned, or moved by 1e3 ... 1e9, where positions lose digits, so that
 * velocities do: two runs part by rounding alone. */
static bool other_places(Tally *tally, char *reason)
{
    static const struct {
        double angle, offset;
    } places[] = {{0, 1e3}, {0, 1e5}, {0, 1e7}, {0, 1e9}, {0.1, 0},
                  {1.5, 0}, {2.9, 0}, {3.6, 0}, {5, 0}};
    for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
        Case a = {.tally = tally, .reason = reason}, b = a;
        const char *line = "--stretch 1.1 --tolerance 1e-9 --segments 3";
        double offset = places[p].offset, c = cos(places[p].angle),
               s = sin(places[p].angle);
        if (case_open(&a, line) && case_open(&b, line)) {
            for (int i = 0; i < case_size(&a); i += 2) {
                double *x = a.run->x + i, *y = b.run->x + i;
                y[0] = c * x[0] - s * x[1] + offset;
                y[1] = s * x[0] + c * x[1] + offset;
                x[0] = offset > 0 ? y[0] - offset : x[0]; /* as y is rounded */
                x[1] = offset > 0 ? y[1] - offset : x[1];
            }
            double allowed = 1e-8 + 1e4 * DBL_EPSILON * offset;
            case_steps(&a, 5);
            case_steps(&b, 5);
            for (int i = 0; i < case_size(&a); i += 2) {
                const double *v = a.run->v + i, *w = b.run->v + i;
                double away = hypot(c * v[0] - s * v[1] - w[0],
                                    s * v[0] + c * v[1] - w[1]);
                if (!(away <= allowed))
                    case_wrong(&a, "node %d: velocities part by %g m/s", i / 2,
                               away);
            }
        }
        bool good = case_close(&a);
        if (!case_close(&b) || !good)
            return false;
    }
    return true;
}

const StressCase stress_cases[] = {
    {"extreme squares", false, false, extreme_squares},
    {"large squares", true, false, large_squares},
    {"every integrator", false, false, every_integrator},
    {"free flight", false, false, free_flight},
    {"other units", false, true, other_units},
    {"other places", false, true, other_places},
    {"many steps", true, false, many_steps},
    {NULL, false, false, NULL},
};
