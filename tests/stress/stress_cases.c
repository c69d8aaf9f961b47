/* The cases that have a name: places where floating point is known to bite.
 * Those with an answer in closed form stand in stress_answers.c.
 */
#include "stress_cases.h"
#include "stress_large.h"

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

/* So many steps of a command line, with both solvers. */
static bool run_line(Tally *tally, char *reason, const char *line, int steps,
                     bool converge)
{
    for (int solver = 0; solver < SOLVER_COUNT; solver++) {
        char whole[256];
        Case c = {.tally = tally, .reason = reason};
        snprintf(whole, sizeof whole, "%s --solver %s", line,
                 solver_name((Solver)solver));
        if (case_open(&c, whole))
            converge ? case_converges(&c, steps) : case_steps(&c, steps);
        if (!case_close(&c)) {
            size_t used = strlen(reason);
            snprintf(reason + used, 512 - used, " (%s)", whole);
            return false;
        }
    }
    return true;
}

static bool extreme_squares(Tally *tally, char *reason)
{
    static const struct {
        int steps;
        bool converge;
        const char *line;
    } rows[] = {
        {5, true, "--timestep 1e3"},
        {5, true, "--timestep 1e3 --stretch 0.3"},
        {5, true, "--timestep 1e3 --stretch 100"},
        {5, true, "--timestep 1e3 --segments 1"},
        {5, true, "--stiffness 1e-6"},
        {5, true, "--stiffness 1e15"},
        {5, true, "--stiffness 1e-6 --stretch 0.1"},
        {5, true, "--stiffness 1e15 --stretch 0.9"},
        {5, false, "--stretch 1e6"},
        {5, false, "--stretch 1e-6"},
        {5, false, "--stretch 0"},
        {5, false, "--stretch -1.4"},
        {5, false, "--stretch 1e3"},
        {5, false, "--stretch 0.1"},
        {50, true, "--segments 1"},
        {50, true, "--segments 1 --stretch 0.2"},
        {50, true, "--segments 1 --timestep 1"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (!run_line(tally, reason, rows[i].line, rows[i].steps,
                      rows[i].converge))
            return false;
    return true;
}

/* Every integrator, gently and hard. */
static bool every_integrator(Tally *tally, char *reason)
{
    for (int i = 0; integrator_methods[i].name; i++) {
        char line[128];
        for (int hard = 0; hard < 2; hard++) {
            snprintf(line, sizeof line, "--integrator %s --timestep %s",
                     integrator_methods[i].name, hard ? "0.05" : "1e-3");
            if (!run_line(tally, reason, line, 20, false))
                return false;
        }
    }
    return true;
}

/* Where |d|^4 overflows nothing moves, whatever the integrator. */
static bool overflow(Tally *tally, char *reason)
{
    for (int i = 0; integrator_methods[i].name; i++) {
        char line[128];
        Case c = {.tally = tally, .reason = reason};
        snprintf(line, sizeof line, "--integrator %s --stretch 1e160",
                 integrator_methods[i].name);
        if (case_open(&c, line) && case_steps(&c, 2) &&
            c.watch.status != STATUS_NOT_FINITE)
            case_wrong(&c, "%s: %s", line, status_name(c.watch.status));
        if (!case_close(&c))
            return false;
    }
    return true;
}

static void mix_stiffness(Case *c)
{
    System *system = &c->simulation.system;
    for (int s = 0; s < system->springs; s++)
        system->k[s] = pow(10, s * 21.0 / (system->springs - 1) - 6);
}

static void mix_masses(Case *c)
{
    System *system = &c->simulation.system;
    for (int i = 0; i < system->nodes; i++)
        system->m[i] = pow(10, i * 12.0 / (system->nodes - 1) - 6);
}

static void alternate(Case *c)
{
    for (int i = 0; i < case_size(c); i++)
        c->run->x[i] *= i / 2 % 2 ? 1e6 : 1e-6;
}

static void put_on_a_line(Case *c)
{
    for (int i = 1; i < case_size(c); i += 2)
        c->run->x[i] = 0;
}

static void make_pairs(Case *c)
{
    for (int i = 0; i + 3 < case_size(c); i += 4)
        memcpy(c->run->x + i + 2, c->run->x + i, 2 * sizeof(double));
}

static void fold(Case *c)
{
    for (int i = 0; i < case_size(c); i += 2)
        c->run->x[i] = fabs(c->run->x[i]);
}

static void scatter(Case *c)
{
    Random random = {12345};
    for (int i = 0; i < case_size(c); i++) {
        c->run->x[i] = random_uniform(&random, -1, 1);
        c->run->v[i] = random_uniform(&random, -10, 10);
    }
}

/* A square in which something is changed before the steps, with both solvers.
 */
static bool changed_squares(Tally *tally, char *reason)
{
    static const struct {
        void (*change)(Case *);
        int steps;
        const char *line;
    } rows[] = {
        {mix_stiffness, 5, "--stretch 1.4"},
        {mix_stiffness, 5, "--timestep 1"},
        {mix_masses, 5, "--stretch 1.4"},
        {mix_masses, 5, "--timestep 1"},
        {alternate, 3, "--stretch 1"},
        {alternate, 3, "--timestep 10"},
        {put_on_a_line, 10, "--stretch 0.7"},
        {put_on_a_line, 5, "--timestep 1"},
        {make_pairs, 10, "--stretch 1"},
        {make_pairs, 5, "--timestep 1"},
        {fold, 20, "--stretch 1"},
        {fold, 5, "--timestep 1"},
        {scatter, 20, "--stretch 1"},
        {scatter, 5, "--timestep 1"},
        {scatter, 5, "--timestep 1e-6"},
        {scatter, 5, "--segments 5 --timestep 0.1"},
    };
    for (size_t i = 0; i < 2 * sizeof rows / sizeof *rows; i++) {
        char line[128];
        Case c = {.tally = tally, .reason = reason};
        snprintf(line, sizeof line, "%s --solver %s", rows[i / 2].line,
                 solver_name((Solver)(i % 2)));
        if (case_open(&c, line)) {
            rows[i / 2].change(&c);
            if (case_restart(&c, 1))
                case_steps(&c, rows[i / 2].steps);
        }
        if (!case_close(&c))
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

const StressCase stress_cases[] = {
    {"large squares", true, false, large_squares},
    {"random large squares", true, false, random_large_squares},
    {"at rest", false, false, at_rest},
    {"free flight", false, false, free_flight},
    {"two masses", false, false, two_masses},
    {"nodes in one point", false, false, nodes_in_one_point},
    {"mirrored", false, true, mirrored},
    {"changed squares", false, false, changed_squares},
    {"refused input", false, false, refused_input},
    {"translated", false, true, translated},
    {"rotated", false, true, rotated},
    {"other units", false, true, other_units},
    {"extreme squares", false, false, extreme_squares},
    {"every integrator", false, false, every_integrator},
    {"overflow", false, false, overflow},
    {"interrupted", false, false, interrupted},
    {"many steps", true, false, many_steps},
    {NULL, false, false, NULL},
};
