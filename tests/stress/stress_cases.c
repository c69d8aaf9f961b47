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

/* ---- answers known beforehand ------------------------------------------- */

/* Nothing moves, not by one bit, and no matrix is made. */
static bool at_rest(Tally *tally, char *reason)
{
    Case c = {.tally = tally, .reason = reason};
    double x[2 * 81];
    if (case_open(&c, "--segments 8 --stretch 1")) {
        memcpy(x, c.run->x, sizeof x);
        case_converges(&c, 100);
        if (memcmp(x, c.run->x, sizeof x) != 0)
            case_wrong(&c, "the square at rest moved");
        if (simulation_counters(&c.simulation).factorisations > 0)
            case_wrong(&c, "a square at rest needs no factor");
    }
    return case_close(&c);
}

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

/* Where the distance d of two masses goes in one implicit step:
 * mu (d - t) + h^2 2 k (d^2/l2 - 1) d = 0, by bisection. */
static long double next_distance(long double mu, long double t, long double w,
                                 long double l2)
{
    long double low = sqrtl(l2) / 2, high = 10 * (fabsl(t) + sqrtl(l2));
    for (int i = 0; i < 100; i++) {
        long double d = (low + high) / 2;
        if (mu * (d - t) + 2 * w * (d * d / l2 - 1) * d > 0)
            high = d;
        else
            low = d;
    }
    return (low + high) / 2;
}

/* Two masses on a spring, against the recurrence for their distance. */
static bool two_masses(Tally *tally, char *reason)
{
    const double x[4] = {0, 0, 1.1}, v[4] = {0};
    NewtonSettings settings = {
        .h = 0.003, .tolerance = 1e-12, .max_iterations = 100};
    Case c = {.tally = tally, .reason = reason};
    System *system = &c.simulation.system;
    if (system_create(2, 1, system))
        return case_wrong(&c, "no memory");
    system->m[0] = 2;
    system->m[1] = 3;
    system->e[0] = 0;
    system->e[1] = 1;
    system->l2[0] = 1;
    system->k[0] = 1e3;
    c.run = &c.simulation.run[0];
    if (time_integrator_create(&integrator_methods[0], system, &settings, x, v,
                               c.run) ||
        !watch_create(c.run, &c.watch))
        case_wrong(&c, "no memory");
    long double d = x[2], speed = 0, h = settings.h;
    for (int step = 0; step < 300 && case_converges(&c, 1); step++) {
        long double next = next_distance(1.2L, d + h * speed, h * h * 1e3L, 1);
        speed = (next - d) / h;
        d = next;
        long double got = (long double)c.run->x[2] - c.run->x[0];
        if (!(fabsl(got - d) <= 1e-12L) || c.run->x[1] != 0)
            case_wrong(&c, "step %d: distance %.17Lg, expected %.17Lg", step,
                       got, d);
    }
    return case_close(&c);
}

/* A maximum of P: left or reported where the springs outweigh the masses. */
static bool nodes_in_one_point(Tally *tally, char *reason)
{
    for (int far = 0; far < 2; far++) {
        Case c = {.tally = tally, .reason = reason};
        if (case_open(&c, "--timestep 0.1")) {
            for (int i = 0; i < case_size(&c); i++)
                c.run->x[i] = far ? 1e3 : 0;
            double high = system_potential(c.run->system, c.run->x);
            if (case_steps(&c, 1) && c.watch.status != STATUS_NOT_A_MINIMUM &&
                !(system_potential(c.run->system, c.run->x) < 0.9 * high))
                case_wrong(&c, "taken for %s", status_name(c.watch.status));
        }
        if (!case_close(&c))
            return false;
    }
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

/* Stops at the given record; 0: never. */
static bool stop_at_record(void *user, const NewtonRecord *record)
{
    (void)record;
    return --*(int *)user != 0;
}

/* Interrupts the third step at this record, makes it again, and compares with
 * a run that nobody interrupted.  Returns whether there was such a record. */
static bool interrupt_at(Case *c, const char *line, int record)
{
    Simulation other;
    int never = 0, left = 0;
    simulation_from_line(line, stop_at_record, &left, &c->simulation);
    simulation_from_line(line, stop_at_record, &never, &other);
    bool stopped = false;
    for (int step = 0; step < 4; step++) {
        left = step == 2 ? record : 0;
        Status status = simulation_step(&c->simulation);
        if (step == 2 && status == STATUS_INTERRUPTED) {
            size_t bytes = 50 * sizeof(double);
            stopped = true;
            if (memcmp(c->simulation.run[0].x, other.run[0].x, bytes) != 0 ||
                memcmp(c->simulation.run[0].v, other.run[0].v, bytes) != 0)
                case_wrong(c, "%s: moved though interrupted", line);
            left = 0;
            status = simulation_step(&c->simulation);
        }
        never = 0;
        if (status != simulation_step(&other))
            case_wrong(c, "%s: other status after an interruption", line);
    }
    for (int i = 0; i < 50 && !c->wrong; i++)
        if (c->simulation.run[0].x[i] != other.run[0].x[i] ||
            c->simulation.run[0].v[i] != other.run[0].v[i])
            case_wrong(c, "%s: an interruption left a trace", line);
    simulation_free(&c->simulation);
    simulation_free(&other);
    return stopped;
}

/* A step that was interrupted can be made again, to the same bits. */
static bool interrupted(Tally *tally, char *reason)
{
    for (int i = 0; integrator_methods[i].name; i++) {
        char line[128];
        Case c = {.tally = tally, .reason = reason};
        if (!integrator_methods[i].implicit)
            continue;
        snprintf(line, sizeof line, "--integrator %s --tolerance 1e-8",
                 integrator_methods[i].name);
        int record = 1;
        while (interrupt_at(&c, line, record) && !c.wrong)
            record++;
        if (record < 4)
            case_wrong(&c, "%s: only %d records", line, record);
        if (!case_close(&c))
            return false;
    }
    return true;
}

/* Numbers that make no sense are refused, wherever they stand; with 1e308 a
 * step may fail, but then nothing moves. */
static bool refused_input(Tally *tally, char *reason)
{
    const double bad[] = {NAN, INFINITY, -INFINITY, -1, 0, 0x1p-1074};
    for (int place = 0; place < 7; place++) {
        Case c = {.tally = tally, .reason = reason};
        if (!case_open(&c, "--segments 1"))
            return case_close(&c);
        System *system = &c.simulation.system;
        double *number[] = {system->m + 1,
                            system->l2 + 1,
                            system->k + 1,
                            &c.run->h,
                            c.run->x + 4,
                            c.run->v + 5,
                            &c.run->newton->settings.tolerance};
        /* positive numbers; the time step; any; a tolerance, maybe infinite */
        int count = place < 3 ? 6 : place == 3 || place == 6 ? 5 : 3;
        for (int b = 0; b < count; b++) {
            TimeIntegrator run;
            NewtonSettings settings = c.run->newton->settings;
            *number[place] = bad[b];
            settings.h = c.run->h;
            settings.tolerance = c.run->newton->settings.tolerance;
            Status status =
                time_integrator_create(&integrator_methods[0], system,
                                       &settings, c.run->x, c.run->v, &run);
            time_integrator_free(&run);
            if (status != STATUS_INVALID_INPUT && (place < 6 || b != 1))
                case_wrong(&c, "place %d took %g", place, bad[b]);
        }
        *number[place] = 1e308;
        Status status = watch_restart(c.run, 1);
        watch_free(&c.watch);
        if (!status && watch_create(c.run, &c.watch))
            case_steps(&c, 1);
        else if (status != STATUS_INVALID_INPUT)
            case_wrong(&c, "place %d: %s", place, status_name(status));
        if (!case_close(&c))
            return false;
    }
    return true;
}

const StressCase stress_cases[] = {
    {"large squares", true, false, large_squares},
    {"random large squares", true, false, random_large_squares},
    {"at rest", false, false, at_rest},
    {"free flight", false, false, free_flight},
    {"two masses", false, false, two_masses},
    {"nodes in one point", false, false, nodes_in_one_point},
    {"changed squares", false, false, changed_squares},
    {"refused input", false, false, refused_input},
    {"other units", false, true, other_units},
    {"other places", false, true, other_places},
    {"extreme squares", false, false, extreme_squares},
    {"every integrator", false, false, every_integrator},
    {"overflow", false, false, overflow},
    {"interrupted", false, false, interrupted},
    {"many steps", true, false, many_steps},
    {NULL, false, false, NULL},
};
