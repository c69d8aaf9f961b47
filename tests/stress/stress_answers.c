/* Named cases whose answer is known beforehand. */
#include "model/pull_energy.h"
#include "stress_cases.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Nothing moves, not by one bit, and no matrix is made. */
bool at_rest(Tally *tally, char *reason)
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

bool free_flight(Tally *tally, char *reason)
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
bool two_masses(Tally *tally, char *reason)
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
bool nodes_in_one_point(Tally *tally, char *reason)
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
                               const double v_factor[2], int steps)
{
    for (int step = 0; step < steps; step++) {
        if (!case_steps(a, 1) || !case_steps(b, 1))
            return false;
        if (a->watch.status != b->watch.status)
            return case_wrong(a, "step %d: %s became %s", step,
                              status_name(a->watch.status),
                              status_name(b->watch.status));
        for (int i = 0; i < case_size(a); i++)
            if (a->run->x[i] * x_factor[i % 2] != b->run->x[i] ||
                a->run->v[i] * v_factor[i % 2] != b->run->v[i])
                return case_wrong(a,
                                  "step %d, number %d: x %a, v %a became "
                                  "%a, %a",
                                  step, i, a->run->x[i], a->run->v[i],
                                  b->run->x[i], b->run->v[i]);
    }
    return true;
}

static const char *const calm_and_wild[] = {
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
    NULL,
};

bool mirrored(Tally *tally, char *reason)
{
    const double sign[2][2] = {{-1, 1}, {1, -1}};
    for (int i = 0; calm_and_wild[i]; i++)
        for (int axis = 0; axis < 2; axis++) {
            Case a = {.tally = tally, .reason = reason}, b = a;
            if (case_open(&a, calm_and_wild[i]) &&
                case_open(&b, calm_and_wild[i])) {
                for (int j = 0; j < case_size(&a); j++) {
                    a.run->v[j] = 0.1 * (j * 7 % 5) - 0.2;
                    b.run->v[j] = a.run->v[j] * sign[axis][j % 2];
                    b.run->x[j] *= sign[axis][j % 2];
                }
                same_after_scaling(&a, &b, sign[axis], sign[axis], 10);
            }
            bool good = case_close(&a);
            if (!case_close(&b) || !good)
                return false;
        }
    return true;
}

/* The whole scene in other units of length, mass and time. */
static void change_units(Case *c, double length, double mass, double time)
{
    System *system = &c->simulation.system;
    for (int i = 0; i < case_size(c); i++) {
        c->run->x[i] *= length;
        c->run->v[i] *= length / time;
    }
    for (int i = 0; i < system->nodes; i++)
        system->m[i] *= mass;
    for (int s = 0; s < system->springs; s++) {
        system->l2[s] *= length * length;
        system->k[s] *= mass / time / time;
    }
    c->run->h *= time;
    case_restart(c, length / time);
}

/* Powers of two, so that no number changes but in its exponent; masses by
 * powers of four, because a Cholesky factor holds their roots. */
bool other_units(Tally *tally, char *reason)
{
    const double units[][3] = {{0x1p20, 1, 1},         {0x1p-20, 1, 1},
                               {1, 0x1p20, 1},         {1, 0x1p-20, 1},
                               {1, 1, 0x1p20},         {1, 1, 0x1p-20},
                               {0x1p3, 0x1p-10, 0x1p7}};
    for (int i = 0; calm_and_wild[i]; i++)
        for (int u = 0; u < 7; u++) {
            Case a = {.tally = tally, .reason = reason}, b = a;
            double x = units[u][0], v = x / units[u][2];
            if (case_open(&a, calm_and_wild[i]) &&
                case_open(&b, calm_and_wild[i])) {
                change_units(&b, units[u][0], units[u][1], units[u][2]);
                same_after_scaling(&a, &b, (double[]){x, x}, (double[]){v, v},
                                   10);
            }
            bool good = case_close(&a);
            if (!case_close(&b) || !good)
                return false;
        }
    return true;
}

/* How far two runs part that should not: by rounding alone. */
static bool check_near_run(Case *a, Case *b, double cosine, double sine,
                           double allowed)
{
    for (int i = 0; i < case_size(a); i += 2) {
        const double *v = a->run->v + i, *w = b->run->v + i;
        double away = hypot(cosine * v[0] - sine * v[1] - w[0],
                            sine * v[0] + cosine * v[1] - w[1]);
        if (!(away <= allowed))
            return case_wrong(a, "node %d: velocities part by %g m/s", i / 2,
                              away);
    }
    return true;
}

static const char gently[] = "--stretch 1.1 --tolerance 1e-9 --segments 3";

/* Moved by 1e3 ... 1e9: positions lose digits, so velocities do. */
bool translated(Tally *tally, char *reason)
{
    for (double offset = 1e3; offset <= 1e9; offset *= 100) {
        Case a = {.tally = tally, .reason = reason}, b = a;
        if (case_open(&a, gently) && case_open(&b, gently)) {
            /* a starts at the same rounded shape */
            for (int i = 0; i < case_size(&a); i++) {
                b.run->x[i] += offset;
                a.run->x[i] = b.run->x[i] - offset;
            }
            if (case_steps(&a, 5) && case_steps(&b, 5))
                check_near_run(&a, &b, 1, 0, 1e-8 + 1e4 * DBL_EPSILON * offset);
        }
        bool good = case_close(&a);
        if (!case_close(&b) || !good)
            return false;
    }
    return true;
}

bool rotated(Tally *tally, char *reason)
{
    for (double angle = 0.1; angle < 6; angle += 0.7) {
        double cosine = cos(angle), sine = sin(angle);
        Case a = {.tally = tally, .reason = reason}, b = a;
        if (case_open(&a, gently) && case_open(&b, gently)) {
            for (int i = 0; i < case_size(&a); i += 2) {
                double *x = b.run->x + i, old = x[0];
                x[0] = cosine * old - sine * x[1];
                x[1] = sine * old + cosine * x[1];
            }
            if (case_converges(&a, 5) && case_converges(&b, 5))
                check_near_run(&a, &b, cosine, sine, 1e-7);
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
bool interrupted(Tally *tally, char *reason)
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
bool refused_input(Tally *tally, char *reason)
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
