/* Contact, friction, cells, plastic flow, fracture and what moves, in whole
 * steps: laws of mechanics with closed forms, the ledger of energies, and that
 * no iterate ever penetrates or turns a cell over.
 */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/cells.h"
#include "model/contact.h"
#include "model/fracture.h"
#include "model/friction.h"
#include "model/plasticity.h"

static const double G = 9.81;

/* ---- one or two masses ------------------------------------------------- */

/* One node of mass 1 above a wall through the origin. */
typedef struct Point {
    System system;
    TimeIntegrator run;
} Point;

static void make_point(const double n[2], double friction, double slip_speed,
                       double gravity, double d_hat, double c, double h,
                       const double x[2], const double v[2], Point *point)
{
    const NewtonSettings settings = {
        .h = h, .tolerance = 1e-11, .max_iterations = 2000};
    const Obstacle wall = {.kind = OBSTACLE_WALL,
                           .n = {n[0], n[1]},
                           .friction = friction,
                           .node = -1};
    const Barrier barrier = {d_hat, c};
    memset(point, 0, sizeof *point);
    CHECK_STATUS(system_create(1, 0, &point->system), STATUS_OK);
    point->system.m[0] = 1;
    point->system.gravity[1] = -gravity;
    CHECK_STATUS(contact_add(&point->system, &barrier, 1, &wall), STATUS_OK);
    if (friction > 0)
        CHECK_STATUS(friction_add(&point->system, slip_speed), STATUS_OK);
    CHECK_STATUS(time_integrator_create(&integrator_methods[0], &point->system,
                                        &settings, x, v, &point->run),
                 STATUS_OK);
}

static void free_point(Point *point)
{
    time_integrator_free(&point->run);
    system_free(&point->system);
}

/* A pinned node can touch what moves by itself or is moved, and nothing else.
 */
TEST(pairs_are_those_that_can_move)
{
    enum { PINNED, BALL };
    unsigned char pinned[2] = {1, 0};
    double pin_v[4] = {0};
    System system = {.nodes = 2, .pinned = pinned};
    Contact contact = {.obstacles = 3, .ball = 1};
    contact.obstacle[0] = (Obstacle){.kind = OBSTACLE_WALL, .node = -1};
    contact.obstacle[1] = (Obstacle){.kind = OBSTACLE_BALL, .node = BALL};
    contact.obstacle[2] = contact.obstacle[0];
    contact.obstacle[2].motion.phases = 1;

    CHECK(!contact_has_pair(&contact, &system, PINNED, 0));
    CHECK(contact_has_pair(&contact, &system, PINNED, 1));
    CHECK(contact_has_pair(&contact, &system, PINNED, 2));
    CHECK(contact_has_pair(&contact, &system, BALL, 0));
    CHECK(!contact_has_pair(&contact, &system, BALL, 1));
    pinned[BALL] = 1;
    CHECK(!contact_has_pair(&contact, &system, PINNED, 1));
    system.pin_v = pin_v;
    CHECK(contact_has_pair(&contact, &system, PINNED, 0));
    CHECK(contact_has_pair(&contact, &system, PINNED, 1));
}

/* (s - 1) ln s = f for s in 0 ... 1, by bisection. */
static double barrier_inverse(double f)
{
    double low = 0, high = 1;
    for (int i = 0; i < 200; i++) {
        double s = 0.5 * (low + high);
        if ((s - 1) * log(s) > f)
            low = s;
        else
            high = s;
    }
    return low;
}

/* A mass flies into the barrier and out again.  It turns where the barrier has
 * taken all of m v^2/2; implicit Euler swallows a part of the bounce that goes
 * to 0 with h. */
TEST(bounce_comes_back_with_small_steps)
{
    const double n[2] = {0, 1}, x[2] = {0, 0.01}, v[2] = {0, -1};
    const double d_hat = 0.01, c = 1;
    double exact = d_hat * barrier_inverse(0.5 / c), time = 0, last = 0;
    /* T = 2 int dd/sqrt(v^2 - 2 b/m), d = d_min + (d_hat - d_min) q^2 */
    for (int i = 0; i < 100000; i++) {
        double q = (i + 0.5) / 100000;
        double d = exact + (d_hat - exact) * q * q;
        double b = c * (d / d_hat - 1) * log(d / d_hat);
        time += 2 * 2 * (d_hat - exact) * q / sqrt(1 - 2 * b) / 100000;
    }
    static const double least[5] = {0.30, 0.70, 0.90, 0.97, 0.993};
    for (int k = 0; k < 5; k++) {
        Point point;
        double h = time / pow(4, k + 1), lowest = 1;
        make_point(n, 0, 1, 0, d_hat, c, h, x, v, &point);
        for (int i = 0; i < 20 * pow(4, k + 1); i++) {
            CHECK_STATUS(time_integrator_step(&point.run), STATUS_OK);
            lowest = fmin(lowest, point.run.x[1]);
            if (point.run.x[1] > d_hat)
                break;
        }
        CHECK(point.run.x[1] > d_hat);
        CHECK(point.run.v[1] > least[k] && point.run.v[1] < 1);
        CHECK(point.run.v[1] > last);
        CHECK_NEAR(lowest, exact, 3 * h);
        last = point.run.v[1];
        free_point(&point);
    }
    CHECK_NEAR(last, 1, 0.007);
}

/* A block on a slope.  mu > tan: it creeps at eps_v (1 - sqrt(1 - tan/mu));
 * mu < tan: it slides with g (sin - mu cos). */
TEST(slopes_hold_and_let_go)
{
    double angle = 0.35, t[2] = {-cos(angle), -sin(angle)};
    const double n[2] = {-sin(angle), cos(angle)}, still[2] = {0, 0};
    for (int slides = 0; slides < 2; slides++) {
        double mu = tan(angle) * (slides ? 0.5 : 1.2), eps_v = 1e-2;
        double x[2] = {0.005 * n[0], 0.005 * n[1]}, before = 0, h = 0.01;
        Point point;
        make_point(n, mu, eps_v, G, 0.01, 1, h, x, still, &point);
        for (int i = 0; i < 400; i++) {
            before = point.run.v[0] * t[0] + point.run.v[1] * t[1];
            CHECK_STATUS(time_integrator_step(&point.run), STATUS_OK);
        }
        double speed = point.run.v[0] * t[0] + point.run.v[1] * t[1];
        if (slides)
            CHECK_NEAR((speed - before) / h, G * (sin(angle) - mu * cos(angle)),
                       1e-6);
        else
            CHECK_NEAR(speed, eps_v * (1 - sqrt(1 - tan(angle) / mu)),
                       1e-6 * eps_v);
        free_point(&point);
    }
}

/* Two masses fly apart: k l2 V(e_max) is the energy of their relative motion
 * m v^2/4, and what has flowed is (e_max - Y)/(1 + H); it stays. */
TEST(a_plastic_spring_keeps_what_has_flowed)
{
    const double k = 1000, Y = 0.05, H = 0.3, m = 1, l2 = 1, v = 8;
    double low = Y, high = 10, error[2];
    for (int i = 0; i < 200; i++) {
        double e = 0.5 * (low + high);
        double V = e * e / 2 - (e - Y) * (e - Y) / (2 * (1 + H));
        if (k * l2 * V < m * v * v / 4)
            low = e;
        else
            high = e;
    }
    double exact = (low - Y) / (1 + H);
    for (int run = 0; run < 2; run++) {
        const double x[4] = {-0.5, 0, 0.5, 0};
        const double speed[4] = {-v / 2, 0, v / 2, 0};
        double h = run ? 2e-6 : 1e-5;
        const NewtonSettings settings = {
            .h = h, .tolerance = 1e-9, .max_iterations = 100};
        System system;
        TimeIntegrator integrator;
        CHECK_STATUS(system_create(2, 1, &system), STATUS_OK);
        system.m[0] = system.m[1] = m;
        system.e[1] = 1;
        system.l2[0] = l2;
        system.k[0] = k;
        CHECK_STATUS(plasticity_set(&system, Y, H), STATUS_OK);
        CHECK_STATUS(time_integrator_create(&integrator_methods[0], &system,
                                            &settings, x, speed, &integrator),
                     STATUS_OK);
        const Plasticity *plasticity = plasticity_of(&system);
        double last = -1;
        while (plasticity->ep[0] > last || plasticity->ep[0] == 0) {
            last = plasticity->ep[0];
            CHECK_STATUS(time_integrator_step(&integrator), STATUS_OK);
            double dx = integrator.x[2] - integrator.x[0];
            double e = dx * dx / l2 - 1 - plasticity->ep[0];
            CHECK_AT_MOST(fabs(e),
                          (Y + H * plasticity->kappa[0]) * (1 + 1e-12));
        }
        CHECK_NEAR(system_lost(&system, system.term[0].kind),
                   k * l2 * Y * plasticity->ep[0], 1e-9);
        error[run] = fabs(plasticity->ep[0] - exact);
        CHECK_AT_MOST(error[run], 0.05 * exact);
        time_integrator_free(&integrator);
        system_free(&system);
    }
    CHECK_AT_MOST(error[1], 0.3 * error[0]); /* O(h) */
}

/* One plastic spring along x, at rest from -0.5 to 0.5. */
static void make_plastic_spring(System *system)
{
    CHECK_STATUS(system_create(2, 1, system), STATUS_OK);
    system->m[0] = system->m[1] = 1;
    system->e[1] = 1;
    system->l2[0] = 1;
    system->k[0] = 3;
    CHECK_STATUS(plasticity_set(system, 0.05, 0.4), STATUS_OK);
}

/* What flows turns stored energy into lost energy, and nothing else: hardening
 * is stored.  Twice, so that the second flow finds a hardened spring. */
TEST(flow_is_booked)
{
    System system;
    make_plastic_spring(&system);
    Term *term = &system.term[0];
    for (int i = 0; i < 2; i++) {
        double x[4] = {-0.5, 0, 0.6 + 0.1 * i, 0};
        Place at = place_at(&system, x, NULL, x);
        at.term = term;
        double before =
            term->kind->value(&at) + system_lost(&system, term->kind);
        CHECK(term->kind->end(term, &system, x, x, 1));
        CHECK_NEAR(term->kind->value(&at) + system_lost(&system, term->kind),
                   before, 1e-15);
    }
    CHECK(plasticity_of(&system)->kappa[0] > 0.1);
    system_free(&system);
}

/* Differences of the energy along a line are those of its values, wherever it
 * begins: elastic, just beyond the yield strain, far beyond. */
TEST(flow_is_exact_along_lines)
{
    System system;
    make_plastic_spring(&system);
    Term *term = &system.term[0];
    for (int i = 0; i < 12; i++) {
        double x[4] = {-0.5, 0, 0.5 + 0.006 * i, 0}, p[4] = {0, 0, 0.01, 0.02};
        double to[4] = {x[0], x[1], x[2] + p[2], x[3] + p[3]};
        double q[3] = {0}, g[4] = {0};
        Place at = place_at(&system, x, NULL, x);
        Place end = place_at(&system, to, NULL, to);
        at.term = end.term = term;
        term->kind->gradient(&at, g);
        term->kind->along(&at, p, 1, q);
        double change = g[2] * p[2] + g[3] * p[3] + q[0] + q[1] + q[2] +
                        term->kind->remainder(&at, p, 1);
        CHECK_NEAR(change, term->kind->value(&end) - term->kind->value(&at),
                   1e-15);
    }
    system_free(&system);
}

/* The same for cells that the way leads below J_hat: a body at rest pressed to
 * 0.3 of its height, J = 1 - 0.7 alpha.  1e-12: rounding of J, of 1e-16, in
 * the barriers of 8 cells. */
TEST(cells_are_exact_along_lines)
{
    Simulation simulation;
    simulation_from_line("--segments 2 --stretch 1 --cells on", NULL, NULL,
                         &simulation);
    System *system = &simulation.system;
    Term *term = system_find_term(system, &cell_energy);
    double *x = simulation.run[0].x, p[18] = {0}, to[18], q[3] = {0};
    CHECK(system->nodes == 9);
    for (int i = 0; i < 18; i++) {
        p[i] = i % 2 ? -0.7 * x[i] : 0;
        to[i] = x[i] + p[i];
    }
    Place at = place_at(system, x, NULL, x);
    Place end = place_at(system, to, NULL, to);
    at.term = end.term = term;
    double pressed = term->kind->value(&end);
    CHECK(pressed > 0 && term->kind->value(&at) == 0);
    term->kind->along(&at, p, 1, q);
    CHECK_NEAR(term->kind->remainder(&at, p, 1), pressed, 1e-12 * pressed);
    simulation_free(&simulation);
}

/* The same for a node that the way leads to the wall from where the barrier is
 * 0 yet, and back again.  1e-14: rounding. */
TEST(contacts_are_exact_along_lines)
{
    Point point;
    const double n[2] = {0, 1}, zero[2] = {0}, high[2] = {0, 0.15};
    const double low[2] = {0, 0.02}, down[2] = {0.1, -0.13},
                 up[2] = {0.1, 0.13};
    make_point(n, 0, 0, 0, 0.1, 1e3, 0.01, high, zero, &point);
    Term *term = system_find_term(&point.system, &contact_energy);
    Place there = place_at(&point.system, high, NULL, high);
    Place here = place_at(&point.system, low, NULL, low);
    there.term = here.term = term;
    double q[3] = {0}, g[2] = {0}, pressed = term->kind->value(&here);
    CHECK(pressed > 0 && term->kind->value(&there) == 0);
    term->kind->along(&there, down, 1, q);
    CHECK_NEAR(term->kind->remainder(&there, down, 1), pressed,
               1e-14 * pressed);
    term->kind->gradient(&here, g);
    term->kind->along(&here, up, 1, q);
    double left = pressed + g[1] * up[1];
    CHECK_NEAR(left + term->kind->remainder(&here, up, 1), 0,
               1e-14 * fabs(g[1]));
    free_point(&point);
}

/* Three steps of 1000 s bring a chain of springs to rest: each holds what hangs
 * on it, 2 k s l sqrt(1 + s) = m g (nodes below). */
TEST(a_chain_hangs_at_rest)
{
    enum { LINKS = 5 };
    const NewtonSettings settings = {
        .h = 1e3, .tolerance = 1e-15, .max_iterations = 1000};
    System system;
    TimeIntegrator run;
    double x[2 * LINKS + 2] = {0}, v[2 * LINKS + 2] = {0}, k = 1000;
    CHECK_STATUS(system_create(LINKS + 1, LINKS, &system), STATUS_OK);
    CHECK_STATUS(system_create_pins(&system), STATUS_OK);
    system.pinned[0] = 1;
    system.gravity[1] = -G;
    for (int i = 0; i <= LINKS; i++) {
        system.m[i] = 1.5;
        x[2 * i + 1] = -0.3 * i;
    }
    for (int s = 0; s < LINKS; s++) {
        system.e[2 * s] = s;
        system.e[2 * s + 1] = s + 1;
        system.l2[s] = 0.09;
        system.k[s] = k;
    }
    CHECK_STATUS(time_integrator_create(&integrator_methods[0], &system,
                                        &settings, x, v, &run),
                 STATUS_OK);
    for (int i = 0; i < 3; i++) {
        Status status = time_integrator_step(&run);
        CHECK(status == STATUS_OK || status_is_unconverged(status));
    }
    for (int s = 0; s < LINKS; s++) {
        double d = run.x[2 * s + 1] - run.x[2 * s + 3];
        double strain = d * d / 0.09 - 1;
        CHECK_NEAR(2 * k * strain * 0.3 * sqrt(1 + strain),
                   1.5 * G * (LINKS - s), 1e-9);
    }
    time_integrator_free(&run);
    system_free(&system);
}

/* ---- whole scenes ------------------------------------------------------ */

/* What is seen at each iterate. */
typedef struct Watch {
    const Simulation *simulation;
    double gap, J; /* the smallest */
    long iterates;
} Watch;

static void look(Watch *watch, const TimeIntegrator *run)
{
    const double *x = run->newton->at.x;
    watch->gap = fmin(watch->gap, smallest_gap(run->system, x));
    watch->J = fmin(watch->J, smallest_cell(run->system, x));
    watch->iterates++;
}

static bool watch_iterate(void *user, const NewtonRecord *record)
{
    Watch *watch = user;
    (void)record;
    for (int r = 0; r < watch->simulation->runs; r++)
        if (watch->simulation->run[r].newton->counters.minimisations > 0)
            look(watch, &watch->simulation->run[r]);
    return true;
}

static const char *const all_scenes[] = {
    "drop",
    "slope",
    "squeeze --stiffness 5e4",
    "dent",
    "tear",
    "bend",
    "squeeze --yield 0.05 --segments 8",
    "drop --yield 0.05 --tear 0.2 --segments 8",
    "drop --segments 6 --line-search none"};
enum { ALL_SCENES = sizeof all_scenes / sizeof *all_scenes };

/* Every gap and every cell is > 0 at every iterate, and every step converges
 * where there is a line search. */
TEST(nothing_penetrates_or_turns_over)
{
    for (int i = 0; i < ALL_SCENES; i++) {
        Simulation simulation;
        Watch watch = {&simulation, INFINITY, INFINITY, 0};
        simulation_from_line(all_scenes[i], watch_iterate, &watch, &simulation);
        for (int step = 0; step < 120; step++) {
            Status status = simulation_step(&simulation);
            CHECK(status == STATUS_OK || (strstr(all_scenes[i], "none") &&
                                          status_is_unconverged(status)));
        }
        CHECK(watch.iterates > 120);
        CHECK(watch.gap > 0);
        CHECK(watch.J > 0);
        simulation_free(&simulation);
    }
}

/* grad P at x, all terms but friction, pins not left out. */
static void potential_gradient(const System *system, const double *x, double *g)
{
    Place at = place_at(system, x, NULL, x);
    memset(g, 0, 2 * (size_t)system->nodes * sizeof *g);
    for (const TermKind *kind; (kind = next_energy(&at));)
        if (kind != &friction_energy)
            kind->gradient(&at, g);
}

/* What walls that move do in a step, by the test's own formulas. */
static double wall_work(const System *system, const double *x,
                        const double *x_n, double h)
{
    const Contact *contact = contact_of(system);
    const Term *friction = system_find_term(system, &friction_energy);
    double sum = 0;
    for (int k = 0; contact && k < contact->obstacles; k++) {
        const Obstacle *wall = &contact->obstacle[k];
        if (wall->v[0] == 0 && wall->v[1] == 0)
            continue;
        CHECK(wall->kind == OBSTACLE_WALL);
        double pushed = wall->n[0] * wall->v[0] + wall->n[1] * wall->v[1];
        for (int i = 0; i < system->nodes; i++) {
            double d = wall->n[0] * (x[2 * i] - wall->o[0]) +
                       wall->n[1] * (x[2 * i + 1] - wall->o[1]);
            double s = d / contact->barrier.d_hat;
            if (s < 1)
                sum -= contact->barrier.c / contact->barrier.d_hat *
                       (log(s) + 1 - 1 / s) * pushed * h;
        }
    }
    (void)friction; /* all walls here move along their normals */
    (void)x_n;
    return sum;
}

/* What a minimum promises where nothing is moved: |v' - v|_M^2/2 and the
 * energies after a step are not more than those before it, with
 * k l2 theta (E - E_n)^2/2, half of what damping takes; and nothing lost comes
 * back.
 */
static void check_inequality(const TimeIntegrator *run, const double *v,
                             const Energies *start, const Energies *end,
                             double tolerance)
{
    double jump = 0;
    for (int c = 0; c < 2 * run->system->nodes; c++)
        jump += 0.5 * run->system->m[c / 2] * (run->v[c] - v[c]) *
                (run->v[c] - v[c]);
    if (end->work == start->work)
        CHECK_AT_MOST(
            jump + OF(end, elastic) + OF(end, contact) + end->gravity +
                OF(end, plastic) + OF(end, fracture) + 0.5 * OF(end, damping),
            start->kinetic + OF(start, elastic) + OF(start, contact) +
                start->gravity + OF(start, plastic) + OF(start, fracture) +
                0.5 * OF(start, damping) + tolerance);
    CHECK(OF(end, plastic) >= OF(start, plastic) &&
          OF(end, fracture) >= OF(start, fracture) &&
          OF(end, friction) >= OF(start, friction) &&
          OF(end, damping) >= OF(start, damping));
}

/* What the forces of damping do on the straight way from x_n to x. */
static double damping_work(const System *system, const double *x,
                           const double *x_n, double eta, double h)
{
    double sum = 0;
    for (int s = 0; s < system->springs; s++) {
        int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
        double d[2] = {x[i] - x[j], x[i + 1] - x[j + 1]};
        double d_n[2] = {x_n[i] - x_n[j], x_n[i + 1] - x_n[j + 1]};
        double change =
            d[0] * d[0] + d[1] * d[1] - d_n[0] * d_n[0] - d_n[1] * d_n[1];
        double way = d[0] * (d[0] - d_n[0]) + d[1] * (d[1] - d_n[1]);
        sum += 2 * system->k[s] * eta / h * change / system->l2[s] * way;
    }
    return sum;
}

/* |v' - v|_M^2/2, what walls do, and what lies between the potential and its
 * tangent g at the end of the step from x, v. */
static double dissipated_in(const TimeIntegrator *run, const double *x,
                            const double *v, const double *g,
                            const Energies *start, const Energies *end)
{
    double sum = wall_work(run->system, run->x, x, run->h);
    for (int c = 0; c < 2 * run->system->nodes; c++) {
        double dv = run->v[c] - v[c];
        sum += 0.5 * run->system->m[c / 2] * dv * dv;
        sum += g[c] * (run->x[c] - x[c]);
    }
    return sum + OF(start, elastic) + OF(start, contact) - OF(end, elastic) -
           OF(end, contact) - (OF(end, plastic) - OF(start, plastic)) -
           (OF(end, fracture) - OF(start, fracture)) -
           (OF(end, damping) - OF(start, damping));
}

/* The ledger's dissipation is what is left over; here it is summed from
 * formulas of its own: |v' - v|_M^2/2 and what lies between P and its tangent
 * at the end of the step.  And every step keeps the inequality of a minimum. */
TEST(the_ledger_adds_up)
{
    static const char *const lines[] = {
        "slope --tolerance 1e-8",   "dent --tolerance 1e-8 --damping 0.003",
        "tear --tolerance 1e-8",    "bend --tolerance 1e-8",
        "drop --tolerance 1e-8",    "dent --tolerance 1e-8",
        "squeeze --tolerance 1e-8", "squeeze --tolerance 1e-8 --damping 0.01"};
    for (int i = 0; i < (tests_are_long() ? 8 : 4); i++) {
        Simulation simulation;
        double sum[SIMULATION_MAX_RUNS] = {0}, most = 0;
        simulation_from_line(lines[i], NULL, NULL, &simulation);
        size_t size = 2 * (size_t)simulation.system.nodes;
        double *x = malloc(size * sizeof *x), *v = malloc(size * sizeof *v);
        size_t springs = (size_t)simulation.system.springs;
        double *g = malloc(size * sizeof *g);
        double *k = malloc(springs * sizeof *k);
        CHECK(x && v && g && k);
        for (int step = 0; step < 110; step++)
            for (int r = 0; r < simulation.runs; r++) {
                TimeIntegrator *run = &simulation.run[r];
                Energies start = simulation_energies(&simulation, r);
                memcpy(x, run->x, size * sizeof *x);
                memcpy(v, run->v, size * sizeof *v);
                memcpy(k, run->system->k, springs * sizeof *k);
                CHECK_STATUS(time_integrator_step(run), STATUS_OK);
                Energies end = simulation_energies(&simulation, r);
                /* forces were in balance while the springs were whole */
                System whole = *run->system;
                whole.k = k;
                potential_gradient(&whole, run->x, g);
                sum[r] += dissipated_in(run, x, v, g, &start, &end) +
                          damping_work(run->system, run->x, x,
                                       simulation.options.damping, run->h);
                most = fmax(most, fabs(end.dissipated) + fabs(end.total) +
                                      fabs(end.work) + end.kinetic);
                CHECK_NEAR(end.total,
                           end.kinetic + OF(&end, elastic) + end.gravity +
                               OF(&end, contact),
                           1e-9 * most);
                check_inequality(run, v, &start, &end, 1e-9 * most);
            }
        for (int r = 0; r < simulation.runs; r++)
            CHECK_NEAR(simulation_energies(&simulation, r).dissipated, sum[r],
                       2e-6 * most);
        free(x);
        free(v);
        free(g);
        free(k);
        simulation_free(&simulation);
    }
}

/* M (v' - v) = h (M g + sum of the walls' forces), these from formulas of the
 * test: normal ones at x', tangential ones with the normal forces of x. */
TEST(momentum_is_what_the_walls_give)
{
    Simulation simulation;
    simulation_from_line("drop --tolerance 1e-8", NULL, NULL, &simulation);
    TimeIntegrator *run = &simulation.run[0];
    const System *system = run->system;
    const Contact *contact = contact_of(system);
    const double c = contact->barrier.c, d_hat = contact->barrier.d_hat;
    int n = system->nodes, touched = 0;
    double *x = malloc(2 * (size_t)n * sizeof *x);
    CHECK(x != NULL);
    for (int step = 0; step < 130; step++) {
        double before[2] = {0, 0}, given[2] = {0, -G * 1000 * run->h};
        memcpy(x, run->x, 2 * (size_t)n * sizeof *x);
        for (int i = 0; i < 2 * n; i++)
            before[i % 2] += system->m[i / 2] * run->v[i];
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        for (int k = 0; k < contact->obstacles; k++)
            for (int i = 0; i < n; i++) {
                const Obstacle *wall = &contact->obstacle[k];
                const double *w = wall->n, t[2] = {-w[1], w[0]};
                double s[2], y = 0, e = 1e-3 * run->h;
                for (int end = 0; end < 2; end++) {
                    const double *at = (end ? run->x : x) + 2 * i;
                    s[end] = (w[0] * (at[0] - wall->o[0]) +
                              w[1] * (at[1] - wall->o[1])) /
                             d_hat;
                }
                for (int axis = 0; axis < 2; axis++)
                    y += t[axis] * (run->x[2 * i + axis] - x[2 * i + axis]);
                double a = fmin(fabs(y) / e, 1), normal = 0, rub = 0;
                if (s[1] < 1)
                    normal = -c / d_hat * (log(s[1]) + 1 - 1 / s[1]);
                if (s[0] < 1)
                    rub = 0.3 * c / d_hat * (log(s[0]) + 1 - 1 / s[0]) * a *
                          (2 - a) * (y > 0 ? 1 : -1);
                touched += s[1] < 1;
                for (int axis = 0; axis < 2; axis++)
                    given[axis] += run->h * (normal * w[axis] + rub * t[axis]);
            }
        for (int i = 0; i < 2 * n; i++)
            before[i % 2] -= system->m[i / 2] * run->v[i];
        for (int axis = 0; axis < 2; axis++) /* N s, of 49 a step */
            CHECK_NEAR(-before[axis], given[axis], 1e-4);
    }
    CHECK(touched > 100);
    free(x);
    simulation_free(&simulation);
}

/* After the ceiling has gone the square is as it was; with springs that flow it
 * is not. */
TEST(what_is_unloaded_comes_back)
{
    static const char *const lines[] = {
        "squeeze --segments 8 --gravity 0",
        "squeeze --segments 8 --gravity 0 --yield 0.05"};
    for (int flows = 0; flows < 2; flows++) {
        Simulation simulation;
        double worst = 0;
        simulation_from_line(lines[flows], NULL, NULL, &simulation);
        for (int step = 0; step < 500; step++)
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        for (int s = 0; s < simulation.system.springs; s++)
            worst = fmax(worst, fabs(strain_of(&simulation, s)));
        Energies end = simulation_energies(&simulation, 0);
        if (flows)
            CHECK(worst > 0.2 && OF(&end, plastic) > 1000);
        else
            CHECK(worst < 0.01 && OF(&end, plastic) == 0);
        simulation_free(&simulation);
    }
}

/* ---- symmetries -------------------------------------------------------- */

/* Turns a run by an angle: nodes, velocities, gravity and obstacles. */
static void turn_run(TimeIntegrator *run, double angle)
{
    double c = cos(angle), s = sin(angle);
    Contact *contact = contact_of(run->system);
    double *pairs[64];
    int count = 0;
    pairs[count++] = run->system->gravity;
    for (int k = 0; k < contact->obstacles; k++) {
        pairs[count++] = contact->obstacle[k].o;
        pairs[count++] = contact->obstacle[k].n;
    }
    for (int i = 0; i < count + 2 * run->system->nodes; i++) {
        int node = (i - count) / 2;
        double *p = i < count              ? pairs[i]
                    : (i - count) % 2 == 0 ? run->x + 2 * node
                                           : run->v + 2 * node;
        double x = p[0], y = p[1];
        p[0] = c * x - s * y;
        p[1] = s * x + c * y;
    }
}

TEST(directions_do_not_matter)
{
    static const struct {
        double angle;
        bool mirror;
        const char *line;
        double tolerance;
    } cases[] = {
        {0.6457718232379019, false, "dent --tolerance 1e-8 --segments 8", 1e-9},
        {0, true, "dent --tolerance 1e-8 --segments 8 --velocity -0.02,-2",
         1e-9},
        {0, false, /* k, kappa and m times 16: powers of two leave all bits */
         "dent --tolerance 1e-8 --segments 8 --stiffness 3.2e6 --density "
         "16000 --barrier 0.01,1.28e7",
         0},
        {0.6457718232379019, false,
         "dent --tolerance 1e-8 --segments 8 --damping 0.002", 1e-9},
        {0, true,
         "dent --tolerance 1e-8 --segments 8 --velocity -0.02,-2 --damping "
         "0.002",
         1e-9},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Simulation plain, other;
        double c = cos(cases[i].angle), s = sin(cases[i].angle);
        bool damped = strstr(cases[i].line, "damping");
        simulation_from_line(
            damped ? "dent --tolerance 1e-8 --segments 8 --damping 0.002"
                   : "dent --tolerance 1e-8 --segments 8",
            NULL, NULL, &plain);
        simulation_from_line(cases[i].line, NULL, NULL, &other);
        if (cases[i].angle != 0)
            turn_run(&other.run[0], cases[i].angle);
        for (int step = 0; step < 150; step++) {
            CHECK_STATUS(simulation_step(&plain), STATUS_OK);
            CHECK_STATUS(simulation_step(&other), STATUS_OK);
        }
        for (int node = 0; node < plain.system.nodes; node++) {
            int row = 9, image = (8 - node / row) * row + node % row;
            const double *p = plain.run[0].x + 2 * node;
            double x = cases[i].mirror ? -p[0] : p[0], y = p[1];
            const double *got =
                other.run[0].x + 2 * (cases[i].mirror ? image : node);
            CHECK_NEAR(got[0], c * x - s * y, cases[i].tolerance);
            CHECK_NEAR(got[1], s * x + c * y, cases[i].tolerance);
        }
        CHECK(energy_now(&plain, 0, "plastic") > 1);
        CHECK((energy_now(&plain, 0, "damping") > 1) == damped);
        simulation_free(&plain);
        simulation_free(&other);
    }
}

/* ---- fracture ---------------------------------------------------------- */

/* Strain of a spring over its strength, which is the scene's times 1 +- 10 %
 * by the next number of SplitMix64. */
static double fracture_load(const System *system, const double *x, int s)
{
    int i = system->e[2 * s], j = system->e[2 * s + 1];
    double dx = x[2 * i] - x[2 * j], dy = x[2 * i + 1] - x[2 * j + 1];
    Random random = {(uint64_t)s * 0x9e3779b97f4a7c15u};
    double strength = 0.12 * (1 + 0.1 * random_uniform(&random, -1, 1));
    CHECK_NEAR(fracture_strength(fracture_of(system), s), strength, 1e-16);
    return ((dx * dx + dy * dy) / system->l2[s] - 1) / strength;
}

/* What was stretched beyond its strength has broken, or one that was stretched
 * more has, at one of its nodes.
 *   k  [springs] of the springs before the step */
static void check_all_that_must_break(const System *system, const double *k,
                                      const double *x)
{
    double *most = calloc((size_t)system->nodes, sizeof *most);
    CHECK(most != NULL);
    for (int s = 0; s < system->springs; s++)
        for (int end = 0; k[s] > 0 && system->k[s] == 0 && end < 2; end++) {
            int i = system->e[2 * s + end];
            most[i] = fmax(most[i], fracture_load(system, x, s));
        }
    for (int s = 0; s < system->springs; s++) {
        double load = fracture_load(system, x, s);
        if (system->k[s] > 0 && load > 1)
            CHECK(fmax(most[system->e[2 * s]], most[system->e[2 * s + 1]]) >=
                  load * (1 - 1e-12));
    }
    free(most);
}

/* What a step breaks was overstretched, shares no node, and the energy booked
 * is that of the springs and of the cells that end with them. */
TEST(breaking_books_its_energy)
{
    Simulation simulation;
    simulation_from_line("tear", NULL, NULL, &simulation);
    System *system = &simulation.system;
    const Fracture *tear = fracture_of(system);
    const Cells *cells = system_find_term(system, &cell_energy)->data;
    double *k = malloc((size_t)system->springs * sizeof *k);
    int *seen = malloc((size_t)system->nodes * sizeof *seen), broken = 0;
    CHECK(k && seen);
    for (int step = 0; step < 120; step++) {
        double lost = energy_now(&simulation, 0, "fracture"), sum = 0;
        memcpy(k, system->k, (size_t)system->springs * sizeof *k);
        memset(seen, 0, (size_t)system->nodes * sizeof *seen);
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        const double *x = simulation.run[0].x;
        check_all_that_must_break(system, k, x);
        for (int s = 0; s < system->springs; s++) {
            if (k[s] == 0 || system->k[s] != 0)
                continue;
            int i = system->e[2 * s], j = system->e[2 * s + 1];
            double dx = x[2 * i] - x[2 * j], dy = x[2 * i + 1] - x[2 * j + 1];
            double strain = (dx * dx + dy * dy) / system->l2[s] - 1;
            CHECK(strain > fracture_strength(tear, s));
            CHECK(fabs(fracture_strength(tear, s) / 0.12 - 1) <= 0.1);
            CHECK(!seen[i]++ && !seen[j]++);
            sum += 0.5 * k[s] * system->l2[s] * strain * strain;
            broken++;
        }
        for (int t = 0; t < cells->triangles; t++) {
            bool before = true, after = true;
            for (int side = 0; side < 3; side++) {
                before = before && k[cells->spring[3 * t + side]] > 0;
                after = after && system->k[cells->spring[3 * t + side]] > 0;
            }
            const int *node = cells->node + 3 * t;
            Corner corner = cell_corner(x + 2 * node[0], x + 2 * node[1],
                                        x + 2 * node[2], cells->area, cells->c);
            if (before && !after)
                sum += cell_value(&corner);
        }
        CHECK_NEAR(energy_now(&simulation, 0, "fracture") - lost, sum,
                   1e-10 * (1 + energy_now(&simulation, 0, "elastic")));
    }
    CHECK(broken > 30 && broken == tear->broken);
    free(k);
    free(seen);
    simulation_free(&simulation);
}

/* Five equal springs from one node, equally loaded: it loses one a step, the
 * one with the smallest number. */
TEST(equal_loads_break_in_their_order)
{
    enum { SPRINGS = 5 };
    const double x[2 * (SPRINGS + 1)] = {0, 0, 2, 0, 0, 2, -2, 0, 0, -2, 2, 0};
    System system;
    CHECK_STATUS(system_create(SPRINGS + 1, SPRINGS, &system), STATUS_OK);
    for (int s = 0; s < SPRINGS; s++) {
        system.e[2 * s + 1] = s + 1;
        system.l2[s] = system.k[s] = 1;
    }
    CHECK_STATUS(fracture_add(&system, 1, 0), STATUS_OK);
    for (int step = 0; step < SPRINGS; step++) {
        CHECK(fracture.end(&system.term[1], &system, x, x, 1));
        for (int s = 0; s < SPRINGS; s++)
            CHECK((system.k[s] == 0) == (s <= step));
    }
    CHECK(!fracture.end(&system.term[1], &system, x, x, 1));
    system_free(&system);
}

/* A spring that is broken stays as it was, however far its ends part. */
TEST(broken_springs_do_not_flow)
{
    const double x[4] = {0, 0, 3, 0};
    System system;
    CHECK_STATUS(system_create(2, 1, &system), STATUS_OK);
    system.e[1] = 1;
    system.l2[0] = system.k[0] = 1;
    CHECK_STATUS(plasticity_set(&system, 0.1, 0), STATUS_OK);
    const Plasticity *flow = plasticity_of(&system);
    CHECK(plastic_energy.end(&system.term[0], &system, x, x, 1));
    CHECK_NEAR(flow->ep[0], 8 - 0.1, 1e-14); /* it does while it is whole */
    system.k[0] = 0;
    const double far[4] = {0, 0, 30, 0};
    CHECK(!plastic_energy.end(&system.term[0], &system, far, far, 1));
    CHECK_NEAR(flow->ep[0], 8 - 0.1, 1e-14);
    CHECK_NEAR(flow->kappa[0], 8 - 0.1, 1e-14);
    system_free(&system);
}

/* ---- what moves -------------------------------------------------------- */

/* A belt: an inclined wall that moves along itself at W takes a block along.
 * While it slips, it feels mu N, N = m g cos; what the belt does is mu N W a
 * second, half of which heats. */
TEST(a_belt_takes_its_load_along)
{
    const double mu = 0.9, angle = 0.3, W = 10, h = 0.01, still[2] = {0, 0};
    const double n[2] = {-sin(angle), cos(angle)};
    const double t[2] = {cos(angle), sin(angle)};
    const double x[2] = {0.005 * n[0], 0.005 * n[1]};
    const double a = G * (mu * cos(angle) - sin(angle));
    Point point;
    make_point(n, mu, 1e-4, G, 0.01, 1, h, x, still, &point);
    Obstacle *belt = &contact_of(&point.system)->obstacle[0];
    belt->motion = (Motion){1, {1e9}, {{W * t[0], W * t[1]}}};
    double speed = 0;
    int slips = 0;
    for (int i = 0; i < 200; i++) {
        double before = speed;
        double heat = system_lost(&point.system, &friction_energy);
        double done = point.run.work;
        CHECK_STATUS(time_integrator_step(&point.run), STATUS_OK);
        speed = point.run.v[0] * t[0] + point.run.v[1] * t[1];
        if (i < 60 || speed > 0.9 * W)
            continue; /* finds its height; is carried along */
        CHECK_NEAR((speed - before) / h, a, 1e-6);
        CHECK_NEAR((point.run.work - done) / h, mu * G * cos(angle) * W, 1e-5);
        CHECK_NEAR((system_lost(&point.system, &friction_energy) - heat) / h,
                   mu * G * cos(angle) * (W - speed), 1e-5);
        slips++;
    }
    CHECK(slips > 30);
    CHECK_NEAR(speed, W, 1e-4);
    free_point(&point);
}

/* The lecture author's fifth program, solved tightly: a ceiling that comes down
 * at 0.5 m/s.  There a stiff spring draws it along and misses by 1e-6 m; here
 * it is where it belongs.  Friction is the ground's alone. */
TEST(a_ceiling_comes_down_as_in_the_lesson)
{
    Simulation simulation;
    simulation_from_line(
        "square --segments 4 --stiffness 2e4 --stretch 1 --timestep 0.01 "
        "--gravity 9.81 --barrier 0.01,1e5 --tolerance 1e-6 --friction 0.11 "
        "--ground 0,1,0,-1 --at 0,-0.3",
        NULL, NULL, &simulation);
    TimeIntegrator *run = &simulation.run[0];
    Contact *contact = contact_of(run->system);
    contact->obstacle[contact->obstacles++] =
        (Obstacle){.kind = OBSTACLE_WALL,
                   .n = {0, -1},
                   .o = {0, 0.25},
                   .motion = {1, {10}, {{0, -0.5}}},
                   .node = -1};
    FILE *file = fopen("tests/data/reference/ceiling_tight.states.csv", "r");
    char header[128];
    CHECK(file && fgets(header, sizeof header, file));
    for (int step = 0; step <= 120; step++) {
        if (step > 0)
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        for (int i = 0; i <= run->system->nodes; i++) {
            double x[2];
            CHECK(fscanf(file, "%*d,%*f,%*d,%lf,%lf,%*f,%*f", &x[0], &x[1]) ==
                  2);
            const double *got = i < run->system->nodes ? run->x + 2 * i
                                                       : contact->obstacle[1].o;
            for (int axis = i == run->system->nodes; axis < 2; axis++)
                CHECK_NEAR(got[axis], x[axis], 2e-6);
        }
    }
    CHECK_NEAR(contact->obstacle[1].o[1], 0.25 - 0.5 * 1.2, 1e-12);
    CHECK(simulation_energies(&simulation, 0).work > 0);
    fclose(file);
    simulation_free(&simulation);
}

/* A ceiling of 50 m/s comes in parts, each from a place that is allowed; one
 * that would crush the square to nothing is stopped, and the step says so. */
TEST(a_fast_ceiling_comes_in_parts)
{
    Simulation simulation;
    simulation_from_line("squeeze --segments 8 --gravity 0", NULL, NULL,
                         &simulation);
    TimeIntegrator *run = &simulation.run[0];
    Obstacle *ceiling = &contact_of(run->system)->obstacle[1];
    ceiling->motion = (Motion){2, {0.01, 10}, {{0, -50}, {0, -60}}};
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK_NEAR(ceiling->o[1], 0.51 - 0.5, 1e-12);
    CHECK(run->newton->counters.minimisations > 1);
    CHECK_NEAR(run->moved, 1, 1e-15);
    CHECK_STATUS(simulation_step(&simulation), STATUS_BLOCKED);
    CHECK(ceiling->o[1] > -0.51 && run->moved < 1);
    CHECK(smallest_gap(run->system, run->x) > 0);
    simulation_free(&simulation);
}

/* Updates of the step that is made, without and with a smaller residual. */
typedef struct Circles {
    double best;
    int updates, since, most;
} Circles;

static bool count_circles(void *user, const NewtonRecord *record)
{
    Circles *circles = user;
    bool smaller = record->iteration == 0 || record->residual < circles->best;
    if (record->iteration < 0)
        return true;
    circles->best = smaller ? record->residual : circles->best;
    circles->since = smaller ? 0 : circles->since + 1;
    circles->updates++;
    if (circles->since > circles->most)
        circles->most = circles->since;
    return true;
}

/* Without a line search updates of contact may go round in circles: such a step
 * ends after some hundreds, with its reason. */
TEST(circles_without_a_line_search_end)
{
    static const char *const lines[] = {
        "drop --segments 6 --stiffness 8.29e4 --timestep 0.0192 --tolerance "
        "6e-8 --line-search none --velocity 0.229,-70.7",
        "dent --segments 4 --stiffness 1.56e4 --timestep 0.0789 --tolerance "
        "0.005 --line-search none --velocity 0.436,-6.82",
        "dent --segments 5 --stiffness 8.43e6 --timestep 0.342 --tolerance "
        "6.5e-6 --line-search none --velocity -0.102,-0.42"};
    for (int n = 0; n < 3; n++) {
        Simulation simulation;
        Circles circles = {0};
        int ended = 0;
        simulation_from_line(lines[n], count_circles, &circles, &simulation);
        for (int i = 0; i < 6; i++) {
            circles = (Circles){0};
            Status status = simulation_step(&simulation);
            CHECK(!status || status_is_unconverged(status));
            CHECK(circles.most <= 500 && circles.updates < 6000);
            ended += circles.most >= 490 && status;
            for (int c = 0; c < 2 * simulation.system.nodes; c++)
                CHECK(isfinite(simulation.run[0].x[c]));
        }
        CHECK(ended > 0);
        simulation_free(&simulation);
    }
}

TESTS(NULL, NULL)
