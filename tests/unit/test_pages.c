/* What each page of the lecture says with numbers, held to the simulation. */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/fracture.h"
#include "model/plasticity.h"
#include "picture/cards.h"
#include "picture/exhibits.h"
#include "scenes/small_scenes.h"
#include "scenes/listing.h"
#include "scenes/pages.h"

/* The scene of a page as it is set up, with more options behind its own. */
static void open_page(const char *name, const char *more,
                      NewtonObserver observer, void *user,
                      Simulation *simulation)
{
    char line[256];
    const LecturePage *page = lecture_find(name);
    assert_non_null(page);
    snprintf(line, sizeof line, "%s%s%s", page->line, more[0] ? " " : "", more);
    simulation_from_line(line, observer, user, simulation);
}

/* All Newton updates of a run. */
enum { LOG_MOST = 4096 };

typedef struct Log {
    int count;
    NewtonRecord record[LOG_MOST];
} Log;

static bool keep_record(void *user, const NewtonRecord *record)
{
    Log *log = user;
    if (log->count < LOG_MOST)
        log->record[log->count++] = *record;
    return true;
}

static void check_falls(const Log *log)
{
    CHECK(log->count > 0);
    for (int i = 0; i < log->count; i++)
        CHECK(log->record[i].change < 0 && log->record[i].slope < 0);
}

/* sum of all masses, kg */
static double total_mass(const System *system)
{
    double sum = 0;
    for (int i = 0; i < system->nodes; i++)
        sum += system->m[i];
    return sum;
}

static void claim_solid(void)
{
    for (int segments = 1; segments <= 32; segments *= 2) {
        char more[32];
        Simulation simulation;
        snprintf(more, sizeof more, "--segments %d", segments);
        open_page("solid", more, NULL, NULL, &simulation);
        /* n terms, each rounded once */
        CHECK_NEAR(total_mass(&simulation.system), 1000, 1e-9);
        CHECK(simulation.system.nodes == (segments + 1) * (segments + 1));
        CHECK(simulation.system.springs ==
              4 * segments * segments + 2 * segments);
        simulation_free(&simulation);
    }
}

static void claim_mesh(void)
{
    Simulation simulation;
    open_page("mesh", "", NULL, NULL, &simulation);
    const System *system = &simulation.system;
    const double *x = simulation.run[0].x;
    CHECK(system->nodes == 9 && system->springs == 20);
    CHECK(x[2] == x[0] && x[3] > x[1]);
    CHECK(x[6] > x[0] && x[7] == x[1]);
    CHECK(system->e[0] == 0 && system->e[1] == 3);
    for (int s = 0; s < system->springs; s++)
        CHECK(system->l2[s] == (s < 12 ? 0.25 : 0.5));
    simulation_free(&simulation);
}

/* The place of the middle, m. */
static void centre(const Simulation *simulation, double c[2])
{
    const System *system = &simulation->system;
    c[0] = c[1] = 0;
    for (int i = 0; i < 2 * system->nodes; i++)
        c[i % 2] += system->m[i / 2] * simulation->run[0].x[i];
    c[0] /= total_mass(system);
    c[1] /= total_mass(system);
}

static void claim_equation(void)
{
    Simulation simulation;
    double g[50] = {0}, sum[2] = {0}, scale = 0, before[2], after[2];
    open_page("equation", "", NULL, NULL, &simulation);
    for (int i = 0; i < 25; i++)
        CHECK_NEAR(simulation.system.m[i], 40, 0);
    system_acceleration(&simulation.system, simulation.run[0].x, g);
    for (int i = 0; i < 50; i++) {
        g[i] *= 40; /* the force, N */
        sum[i % 2] += g[i];
        scale = fmax(scale, fabs(g[i]));
    }
    CHECK(scale > 1000);
    CHECK_NEAR(hypot(sum[0], sum[1]), 0, 1e-13 * scale);
    centre(&simulation, before);
    for (int i = 0; i < 50; i++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    centre(&simulation, after);
    CHECK_NEAR(hypot(after[0] - before[0], after[1] - before[1]), 0, 1e-14);
    simulation_free(&simulation);
}

/* (|x|^2 + |v|^2)/2 of the single mass, J */
static double mass_energy(const Simulation *simulation)
{
    const double *x = simulation->run[0].x, *v = simulation->run[0].v;
    return 0.5 * (x[0] * x[0] + x[1] * x[1] + v[0] * v[0] + v[1] * v[1]);
}

/* One step to (x, y), and the energy times `factor` in each of 20. */
static void check_euler(const char *name, double x, double y, double factor)
{
    Simulation simulation;
    open_page(name, "", NULL, NULL, &simulation);
    CHECK_NEAR(simulation.options.timestep, 0.5, 0);
    for (int i = 0; i < 20; i++) {
        double before = mass_energy(&simulation);
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        if (i == 0) {
            CHECK_NEAR(simulation.run[0].x[0], x, 1e-15);
            CHECK_NEAR(simulation.run[0].x[1], y, 1e-15);
        }
        CHECK_NEAR(mass_energy(&simulation) / before, factor, 1e-14);
    }
    simulation_free(&simulation);
}

static void claim_forward(void)
{
    check_euler("forward", 1, 0.5, 1.25);
}

static void claim_backward(void)
{
    check_euler("backward", 0.8, 0.4, 1 / 1.25);
}

static void claim_symplectic(void)
{
    Simulation simulation;
    open_page("symplectic", "", NULL, NULL, &simulation);
    const double *x = simulation.run[0].x, *v = simulation.run[0].v;
    double start =
        2 * mass_energy(&simulation) - 0.5 * (x[0] * v[0] + x[1] * v[1]);
    for (int i = 0; i < 1000; i++) {
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        double now =
            2 * mass_energy(&simulation) - 0.5 * (x[0] * v[0] + x[1] * v[1]);
        CHECK_NEAR(now, start, 1e-12);
    }
    simulation_free(&simulation);
}

static void claim_stability(void)
{
    Simulation simulation;
    double before[3], factor[3];
    open_page("stability", "", NULL, NULL, &simulation);
    for (int i = 0; i < 300; i++) {
        for (int run = 0; run < 3; run++)
            before[run] =
                hypot(simulation.run[run].x[0], simulation.run[run].x[1]);
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        for (int run = 0; run < 3; run++) {
            double r =
                hypot(simulation.run[run].x[0], simulation.run[run].x[1]);
            factor[run] = r / before[run];
            if (run == 1)
                CHECK_NEAR(r, 1, 0.04);
        }
        /* sqrt(1 + (0.02 2 pi)^2) = 1.007864; 5 digits are shown */
        CHECK_NEAR(factor[0], 1.00786, 5e-6);
        CHECK_NEAR(1 / factor[2], 1.00786, 5e-6);
    }
    simulation_free(&simulation);
    for (int i = 0; i < 2; i++) { /* h omega = 1.95 and 2.07 */
        double most = 0;
        open_page("stability", i ? "--timestep 0.33" : "--timestep 0.31", NULL,
                  NULL, &simulation);
        for (int step = 0; step < (i ? 10 : 500); step++) {
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
            const double *x = simulation.run[1].x;
            most = fmax(most, hypot(x[0], x[1]));
        }
        CHECK(i ? most > 100 : most < 7);
        simulation_free(&simulation);
    }
}

/* The status of the last of at most `steps` steps. */
static Status run_steps(Simulation *simulation, int steps)
{
    Status status = STATUS_OK;
    for (int i = 0; i < steps && !status && !simulation->done; i++)
        status = simulation_step(simulation);
    return status;
}

static void claim_explicit(void)
{
    static const struct {
        const char *more;
        int steps;
        Status end;
    } runs[] = {
        {"", 20, STATUS_NOT_FINITE},
        {"--timestep 0.003", 1000, STATUS_OK},
        {"--integrator backward-euler", 100, STATUS_OK},
        {"--integrator backward-euler --timestep 1", 100, STATUS_OK},
    };
    for (int i = 0; i < 4; i++) {
        Simulation simulation;
        open_page("explicit", runs[i].more, NULL, NULL, &simulation);
        CHECK_STATUS(run_steps(&simulation, runs[i].steps), runs[i].end);
        simulation_free(&simulation);
    }
}

/* g''/(2 g') of E = (x - 2)^2/2 + 0.45 (x^2 - 1)^2 at the root of g. */
static void claim_tangent(void)
{
    Simulation simulation;
    double x[16];
    int count = 0;
    open_page("tangent", "", NULL, NULL, &simulation);
    while (!simulation.done) {
        x[count++] = simulation.descent.point[0];
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    }
    double root = simulation.descent.point[0];
    CHECK(count == 6);
    CHECK_NEAR(root, 1.17799, 5e-6);
    double slope = 1 + 0.09 * 20 * (3 * root * root - 1);
    double factor = 0.09 * 20 * 6 * root / (2 * slope);
    CHECK_NEAR(factor, 0.95, 0.005); /* two digits are shown */
    /* The error before, times two, is the share of the terms left out. */
    int checked = 0;
    for (int i = 0; i + 1 < count; i++) {
        double error = x[i] - root, next = x[i + 1] - root;
        if (error > 0.1 || error < 1e-5)
            continue;
        CHECK_NEAR(next / (error * error), factor, 2 * error * factor);
        checked++;
    }
    CHECK(checked >= 2);
    simulation_free(&simulation);
    /* after five updates |p| is below that, and |g| above */
    open_page("tangent", "--tolerance 1e-6", NULL, NULL, &simulation);
    CHECK_STATUS(run_steps(&simulation, 100), STATUS_OK);
    CHECK(simulation.descent.count == 6);
    simulation_free(&simulation);
}

static void claim_newton(void)
{
    Simulation simulation;
    open_page("newton", "", NULL, NULL, &simulation);
    const Newton *newton = simulation.run[0].newton;
    while (!simulation.done) {
        long double H[36], g[6];
        exact_derivatives(&newton->at.E, newton->at.u, newton->at.x, g, H);
        for (int i = 0; i < 2 && newton->status == STATUS_RUNNING; i++) {
            long double sum = g[i];
            for (int j = 0; j < 2; j++)
                sum += H[6 * i + j] * (long double)newton->at.p[j];
            CHECK_NEAR(sum, 0, 1e-12);
        }
        double size = hypot((double)g[0], (double)g[1]);
        CHECK(size > 1e-6); /* or the loop would have ended before */
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        int last = simulation.descent.count - 1;
        CHECK_NEAR(simulation.descent.record[last].residual, size,
                   1e-12 * (1 + size));
    }
    CHECK(simulation.descent.count == 5);
    CHECK_AT_MOST(simulation.descent.residual, 1e-6);
    simulation_free(&simulation);
    /* after four updates |p|/h is below that, and |g| above */
    open_page("newton", "--tolerance 3e-5", NULL, NULL, &simulation);
    CHECK_STATUS(run_steps(&simulation, 100), STATUS_OK);
    CHECK(simulation.descent.count == 5);
    simulation_free(&simulation);
    open_page("newton", "--start 0.05,-0.05", NULL, NULL, &simulation);
    CHECK_STATUS(run_steps(&simulation, 100), STATUS_OK);
    CHECK(simulation.done);
    const double *x = simulation.descent.point;
    CHECK(descent_bends_down(&simulation, x[0], x[1]) == 1);
    simulation_free(&simulation);
    /* and from below the saddle it climbs there: no success */
    open_page("newton", "--start 0.1,-0.35", NULL, NULL, &simulation);
    CHECK_STATUS(run_steps(&simulation, 100), STATUS_DIVERGED);
    simulation_free(&simulation);
}

static void claim_overshoot(void)
{
    Simulation simulation;
    open_page("overshoot", "", NULL, NULL, &simulation);
    run_steps(&simulation, 10);
    CHECK_NEAR(simulation.descent.record[0].to[0], -11.645, 5e-4);
    CHECK(fabs(simulation.descent.record[1].to[0]) > 3e9);
    simulation_free(&simulation);
    for (int sign = -1; sign <= 1; sign += 2) {
        open_page("overshoot", sign < 0 ? "--start -1.0886" : "--start 1.0886",
                  NULL, NULL, &simulation);
        CHECK_STATUS(run_steps(&simulation, 100), STATUS_OK);
        CHECK(simulation.done);
        simulation_free(&simulation);
        open_page("overshoot", sign < 0 ? "--start -1.0887" : "--start 1.0887",
                  NULL, NULL, &simulation);
        CHECK_STATUS(run_steps(&simulation, 100), STATUS_DIVERGED);
        simulation_free(&simulation);
    }
    open_page("overshoot", "--start 1.09", NULL, NULL, &simulation);
    CHECK_STATUS(run_steps(&simulation, 100), STATUS_DIVERGED);
    const Descent *descent = &simulation.descent;
    CHECK(descent->count == 7);
    for (int i = 0; i < descent->count; i++) {
        double from = descent->record[i].from[0], to = descent->record[i].to[0];
        CHECK(from * to < 0 && fabs(to) > fabs(from));
    }
    simulation_free(&simulation);
}

static void claim_explodes(void)
{
    static const char *const watched[] = {
        "--filter clamp", "--line-search backtrack",
        "--filter clamp --line-search backtrack"};
    Log log = {0};
    Simulation simulation;
    double E = 0, highest = 0, farthest = 0;
    open_page("explodes", "", keep_record, &log, &simulation);
    simulation_step(&simulation);
    for (int i = 0; i < log.count; i++) {
        E += log.record[i].change;
        highest = fmax(highest, E);
        /* |p_x| + |p_y| is at most sqrt(2) |p| */
        farthest =
            fmax(farthest, log.record[i].residual * 0.02 / 1.4142135623731);
    }
    CHECK(highest > 1e16);
    CHECK(farthest > 1000);
    simulation_free(&simulation);
    for (int i = 0; i < 3; i++) {
        log.count = 0;
        open_page("explodes", watched[i], keep_record, &log, &simulation);
        Status status = simulation_step(&simulation);
        for (int k = 0; k < log.count; k++)
            CHECK(log.record[k].change <= 0);
        if (i != 1) {
            CHECK_STATUS(status, STATUS_OK);
            CHECK(log.count == 5);
        }
        simulation_free(&simulation);
    }
}

/* M (x - x_tilde) + h^2 grad P at the end of each step, as a p: M^-1 of it is
 * more than H^-1 of it, so it is only bounded by the tolerance where H is at
 * most 100 M, as it is here: h^2 k is 1.6 and M is 40. */
static void claim_minimise(void)
{
    Simulation simulation;
    open_page("minimise", "--tolerance 1e-9", NULL, NULL, &simulation);
    const TimeIntegrator *run = &simulation.run[0];
    double h = run->h, x_tilde[50], x_n[50];
    for (int step = 0; step < 10; step++) {
        double g[50] = {0};
        for (int i = 0; i < 50; i++) {
            x_n[i] = run->x[i];
            x_tilde[i] = run->x[i] + h * run->v[i];
        }
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        system_acceleration(&simulation.system, run->x, g);
        for (int i = 0; i < 50; i++) {
            g[i] = 40 * (run->x[i] - x_tilde[i] - h * h * g[i]);
            CHECK_NEAR(g[i], 0, 100 * 40 * 1e-9 * h + 1e-13 * 40);
            CHECK_NEAR(run->v[i], (run->x[i] - x_n[i]) / h, 1e-11);
        }
    }
    simulation_free(&simulation);
}

static void claim_parts(void)
{
    Simulation simulation;
    open_page("parts", "", NULL, NULL, &simulation);
    const double *target = simulation.exhibit.target;
    double inertia[2], elastic[2], rest = sqrt(1.25);
    CHECK_STATUS(run_steps(&simulation, 100), STATUS_OK);
    const double *x = simulation.run[0].x;
    CHECK_NEAR(
        landscape_part_value(&simulation, PART_INERTIA, target[0], target[1]),
        0, 0);
    for (int sign = -1; sign <= 1; sign += 2)
        CHECK_NEAR(
            landscape_part_value(&simulation, PART_ELASTICITY, 0, sign * rest),
            0, 1e-15);
    inertia[0] = landscape_part_value(&simulation, PART_INERTIA, x[0], x[1]);
    elastic[0] = landscape_part_value(&simulation, PART_ELASTICITY, x[0], x[1]);
    inertia[1] = landscape_part_value(&simulation, PART_INERTIA, 0, rest);
    elastic[1] = landscape_part_value(&simulation, PART_ELASTICITY, target[0],
                                      target[1]);
    CHECK(inertia[0] > 0 && elastic[0] > 0);
    CHECK(inertia[0] < inertia[1] && elastic[0] < elastic[1]);
    simulation_free(&simulation);
}

static void claim_dial(void)
{
    Simulation simulation;
    open_page("dial", "", NULL, NULL, &simulation);
    const Walk *walk = &simulation.exhibit.walk;
    const double *target = simulation.exhibit.target;
    CHECK_NEAR(walk->h[0], 1e-3, 1e-15);
    CHECK_AT_MOST(
        hypot(walk->point[0][0] - target[0], walk->point[0][1] - target[1]),
        1e-3);
    CHECK_NEAR(walk->h[WALK_POINTS - 1], 10, 1e-12);
    CHECK_AT_MOST(hypot(walk->point[WALK_POINTS - 1][0],
                        walk->point[WALK_POINTS - 1][1] - sqrt(1.25)),
                  1e-3);
    for (int i = 1; i < WALK_POINTS; i++) {
        double value[2][2]; /* [part][before, now] */
        for (int k = 0; k < 2; k++)
            for (int part = 0; part < 2; part++)
                value[part][k] = landscape_part_value(
                    &simulation, part ? PART_ELASTICITY : PART_INERTIA,
                    walk->point[i - 1 + k][0], walk->point[i - 1 + k][1]);
        CHECK(value[0][1] > value[0][0] && value[1][1] < value[1][0]);
    }
    simulation_free(&simulation);
}

static void claim_inertia(void)
{
    Simulation simulation;
    const LecturePage *page = lecture_find("inertia");
    open_page("inertia", "", NULL, NULL, &simulation);
    exhibit_flip(&simulation, 1);
    CHECK(page->flips == 2);
    CHECK(simulation.exhibit.parts == PART_INERTIA);
    /* ((0.6 - 0.2)^2 + (0.9 - 0.3)^2) / 2 */
    CHECK_NEAR(landscape_part_value(&simulation, PART_INERTIA, 0.6, 0.9), 0.26,
               1e-15);
    const Descent *descent = &simulation.descent;
    CHECK_NEAR(descent->value, 0.26, 1e-15);
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK(simulation.done && descent->count == 1);
    for (int i = 0; i < 2; i++) /* one subtraction and one addition */
        CHECK_NEAR(descent->point[i], simulation.exhibit.target[i], 1e-15);
    CHECK_NEAR(descent->record[0].change, -0.26, 1e-15);
    simulation_free(&simulation);
}

static void claim_alpha(void)
{
    Log log = {0};
    Simulation simulation;
    bool eighth = false;
    open_page("alpha", "", keep_record, &log, &simulation);
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK(log.record[0].trials > 1); /* alpha = 1 was refused */
    for (int i = 0; i < log.count; i++)
        eighth = eighth || log.record[i].alpha == 0.125;
    CHECK(eighth);
    check_falls(&log);
    simulation_free(&simulation);
}

static void claim_algorithm2(void)
{
    static const double alpha[] = {0.25, 0.5, 1, 1, 1, 1};
    Simulation simulation;
    open_page("algorithm2", "", NULL, NULL, &simulation);
    CHECK_STATUS(run_steps(&simulation, 100), STATUS_OK);
    CHECK(simulation.descent.count == 6);
    for (int i = 0; i < 6; i++) {
        CHECK_NEAR(simulation.descent.record[i].alpha, alpha[i], 0);
        CHECK(simulation.descent.record[i].change < 0);
    }
    simulation_free(&simulation);
}

static void claim_descent(void)
{
    Simulation simulation;
    open_page("descent", "", NULL, NULL, &simulation);
    CHECK_NEAR(simulation.run[0].x[0], 0.1, 0);
    CHECK_NEAR(simulation.run[0].x[1], -0.35, 0);
    CHECK(simulation.descent.slope > 0.1);
    simulation_set_filter(&simulation, FILTER_CLAMP);
    CHECK(simulation.descent.slope < -0.1);
    for (int i = -8; i <= 8; i++)
        for (int j = -8; j <= 8; j++) {
            exhibit_drag(&simulation, 1, 0.2 * i, 0.2 * j);
            CHECK(simulation.descent.slope < 0);
        }
    simulation_free(&simulation);
}

static void claim_psd(void)
{
    for (double r = 0.02; r < 1.5; r += 0.02) {
        SpringFacts facts;
        double most = 0, expected[2];
        spring_facts((double[2]){r, 0}, 1, 100, &facts);
        expected[0] = 2 * fmin(facts.along, facts.across);
        expected[1] = 2 * fmax(facts.along, facts.across);
        int zeros = 0;
        for (int i = 0; i < 4; i++) {
            zeros += facts.block[i] == 0;
            most = fmax(most, facts.projected[i]);
        }
        CHECK(zeros >= 2);
        CHECK_NEAR(facts.block[0], fmin(expected[0], 0), 0);
        CHECK_NEAR(facts.block[3], fmax(expected[1], 0), 0);
        CHECK((most == 0) == (r < 1 / sqrt(3)));
    }
}

static void claim_energy(void)
{
    SpringFacts rest, near;
    const double k = 100;
    spring_facts((double[2]){1, 0}, 1, k, &rest);
    CHECK_NEAR(rest.along, 4 * k, 0);
    CHECK_NEAR(rest.root_along, 4 * k, 0);
    spring_facts((double[2]){1e-3, 0}, 1, k, &near);
    CHECK_NEAR(near.across, -2 * k, 1e-5 * k);
    CHECK_NEAR(near.root_across, -3996 * k, 1e-9 * k);
}

static void claim_force(void)
{
    Simulation simulation;
    SpringFacts facts, more;
    const double e = 1e-5;
    open_page("force", "", NULL, NULL, &simulation);
    const double *x = simulation.run[0].x;
    const System *system = &simulation.system;
    spring_facts(x, system->l2[0], system->k[0], &facts);
    CHECK_NEAR(facts.energy, 23.805, 1e-12);
    CHECK_NEAR(facts.force[0], -165.6, 1e-12);
    CHECK_NEAR(facts.force[1], -69, 1e-12);
    CHECK_NEAR(system_potential(system, x), facts.energy, 1e-12);
    for (int i = 0; i < 2; i++) { /* third derivatives are below 3000 */
        double at[2][2] = {{x[0], x[1]}, {x[0], x[1]}};
        at[0][i] += e;
        at[1][i] -= e;
        spring_facts(at[0], 1, 100, &facts);
        spring_facts(at[1], 1, 100, &more);
        CHECK_NEAR(-(facts.energy - more.energy) / (2 * e),
                   i == 0 ? -165.6 : -69, 1e-6);
    }
    simulation_free(&simulation);
}

static void claim_potential(void)
{
    Simulation simulation;
    open_page("potential", "", NULL, NULL, &simulation);
    const System *system = &simulation.system;
    const double *x = simulation.run[0].x, e = 1e-6;
    double u[50] = {0}, u_tilde[50] = {0}, q[50], y[50];
    bool used[50][50] = {{false}};
    int places = 0;
    CHECK(system->nodes == 25 && system->springs == 72);
    for (int i = 0; i < 50; i++)
        for (int s = 0; s < 72; s++)
            for (int a = 0; a < 4; a++)
                for (int b = 0; b < 4; b++) {
                    int row = 2 * system->e[2 * s + a / 2] + a % 2;
                    int column = 2 * system->e[2 * s + b / 2] + b % 2;
                    used[row][column] = used[i][i] = true;
                }
    for (int i = 0; i < 50; i++)
        for (int j = 0; j < 50; j++)
            places += used[i][j];
    CHECK(places == 676);
    IncrementalPotential E = {
        .system = system, .weight = 1.6e-5, .x_n = x, .u_tilde = u_tilde};
    Random random = {7};
    for (int i = 0; i < 50; i++)
        q[i] = random_uniform(&random, -1, 1);
    double x_copy[50], unused[50];
    memcpy(x_copy, x, sizeof x_copy);
    const Iterate at = {E, u, x_copy, unused, unused};
    incremental_potential_product(&at, FILTER_NONE, q, y);
    double up[50], down[50], x_up[50], x_down[50], g_up[50], g_down[50];
    for (int i = 0; i < 50; i++) {
        up[i] = e * q[i];
        down[i] = -e * q[i];
        x_up[i] = x[i] + up[i];
        x_down[i] = x[i] + down[i];
    }
    incremental_potential_gradient(&E, up, x_up, g_up);
    incremental_potential_gradient(&E, down, x_down, g_down);
    for (int i = 0; i < 50; i++) /* rounding of g, 1e-15 of 100, over e */
        CHECK_NEAR((g_up[i] - g_down[i]) / (2 * e), y[i], 1e-6);
    simulation_free(&simulation);
}

static void claim_algorithm3(void)
{
    Log log = {0};
    Simulation simulation;
    open_page("algorithm3", "", keep_record, &log, &simulation);
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK(log.count == 5);
    CHECK(log.record[0].projected == 52);
    for (int i = 0; i < log.count; i++)
        CHECK_NEAR(log.record[i].alpha, 1, 0);
    check_falls(&log);
    simulation_free(&simulation);
}

static void claim_step(void)
{
    int count[2];
    for (int i = 0; i < 2; i++) {
        Log log = {0};
        Simulation simulation;
        if (i == 0)
            simulation_from_line("square", keep_record, &log, &simulation);
        else
            open_page("step", "", keep_record, &log, &simulation);
        CHECK_NEAR(simulation.options.tolerance, i == 0 ? 1e-2 : 1e-6, 0);
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        check_falls(&log);
        count[i] = log.count;
        /* what is to be looked at, in two digits */
        CHECK_NEAR(log.record[0].residual / log.record[1].residual, 36, 0.5);
        if (i == 1)
            CHECK_NEAR(log.record[1].residual / log.record[2].residual, 330, 5);
        simulation_free(&simulation);
    }
    CHECK(count[1] == count[0] + 2);
}

static void claim_simulator(void)
{
    Simulation simulation;
    open_page("simulator", "", NULL, NULL, &simulation);
    double before = simulation_energies(&simulation, 0).total;
    for (int i = 0; i < 50; i++) {
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        double now = simulation_energies(&simulation, 0).total;
        CHECK(now <= before);
        before = now;
    }
    simulation_free(&simulation);
}

/* Steps that all have to converge. */
static void check_steps(Simulation *simulation, int steps)
{
    for (int i = 0; i < steps; i++)
        CHECK_STATUS(simulation_step(simulation), STATUS_OK);
}

/* total at the start + work = what there is + what was lost, within a
 * millionth of the largest number in it */
static void check_ledger(const Simulation *simulation, double start)
{
    Energies e = simulation_energies(simulation, 0);
    double sum = e.total + OF(&e, plastic) + OF(&e, fracture) +
                 OF(&e, friction) + e.dissipated;
    CHECK_NEAR(sum, start + e.work, 1e-6 * (fabs(start) + fabs(e.total)));
}

static void claim_contact(void)
{
    Simulation simulation;
    double nearest = 1;
    open_page("contact", "", NULL, NULL, &simulation);
    for (int step = 0; step < 300; step++) {
        check_steps(&simulation, 1);
        const double *x = simulation.run[0].x;
        for (int i = 0; i < 2 * simulation.system.nodes; i += 2)
            nearest = fmin(nearest, fmin(x[i + 1] + 0.5, 1.1 - fabs(x[i])));
    }
    CHECK(nearest > 1e-3 && nearest < 0.05); /* it does come near */
    simulation_free(&simulation);
}

/* How far each block has moved in 3 s, m, and the fastest node of the second
 * one then, m/s. */
static double slide(const char *more, double way[3])
{
    Simulation simulation;
    double before[3][2] = {{0}};
    open_page("friction", more, NULL, NULL, &simulation);
    CHECK(simulation.runs == 3);
    int nodes = simulation.system.nodes;
    for (int pass = 0; pass < 2; pass++) {
        for (int run = 0; run < 3; run++) {
            double middle[2] = {0, 0};
            for (int i = 0; i < 2 * nodes; i++)
                middle[i % 2] += simulation.run[run].x[i] / nodes;
            if (pass == 0)
                memcpy(before[run], middle, sizeof middle);
            way[run] =
                hypot(middle[0] - before[run][0], middle[1] - before[run][1]);
        }
        if (pass == 0)
            check_steps(&simulation, 300);
    }
    CHECK_NEAR(simulation_time(&simulation), 3, 1e-12);
    double fastest = 0;
    for (int i = 0; i < 2 * nodes; i++)
        fastest = fmax(fastest, fabs(simulation.run[1].v[i]));
    simulation_free(&simulation);
    return fastest;
}

static void claim_friction(void)
{
    double way[3];
    slide("", way);
    CHECK(way[0] > 7 && way[0] > way[1] && way[1] > 1 && way[2] < 0.02);
    CHECK_AT_MOST(slide("--friction 0.41", way), 1e-3); /* the slip speed */
    CHECK(way[0] > 1 && way[1] < 0.06 && way[2] < 0.02);
    CHECK(slide("--friction 0.40", way) > 0.1);
    slide("--friction 0.32", way);
    CHECK(way[1] > 1 && way[2] > 0.5);
}

static void claim_inelastic(void)
{
    Simulation simulation;
    double nearest = 1, most = 0;
    open_page("inelastic", "", NULL, NULL, &simulation);
    double start = simulation_energies(&simulation, 0).total;
    for (int step = 0; step < 300; step++) {
        check_steps(&simulation, 1);
        const double *x = simulation.run[0].x;
        for (int i = 0; i < 2 * simulation.system.nodes; i += 2)
            nearest = fmin(nearest, hypot(x[i], x[i + 1] + 0.75) - 0.35);
    }
    const Plasticity *plasticity = plasticity_of(&simulation.system);
    assert_non_null(plasticity);
    for (int s = 0; s < simulation.system.springs; s++)
        most = fmax(most, fabs(plasticity->ep[s]));
    CHECK(most > 0.05);
    CHECK(nearest > 0);
    CHECK(energy_now(&simulation, 0, "plastic") > 0);
    check_ledger(&simulation, start);
    simulation_free(&simulation);
}

static void claim_fracture(void)
{
    Simulation simulation;
    open_page("fracture", "", NULL, NULL, &simulation);
    double start = simulation_energies(&simulation, 0).total;
    const Fracture *broken = fracture_of(&simulation.system);
    assert_non_null(broken);
    check_steps(&simulation, 20);
    CHECK(broken->broken == 0);
    check_steps(&simulation, 80);
    CHECK(broken->broken > 100);
    CHECK(energy_now(&simulation, 0, "fracture") > 0);
    check_ledger(&simulation, start);
    simulation_free(&simulation);
}

static void claim_race(void)
{
    static const double factor[RACE_METHODS] = {2, 2, 4, 2, 4, 16};
    Simulation simulation;
    open_page("race", "", NULL, NULL, &simulation);
    const Race *race = &simulation.exhibit.race;
    while (!simulation.done)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    for (int i = 0; i < RACE_METHODS; i++) {
        const RacePoint *point =
            &race->point[(RACE_STEP_SIZES - 1) * RACE_METHODS + i];
        while (point->error < 1e-8) /* where tolerance and reference are seen */
            point -= RACE_METHODS;
        /* terms of higher order: a quarter */
        CHECK_NEAR((point - RACE_METHODS)->error / point->error, factor[i],
                   0.25 * factor[i]);
    }
    enum { VERLET = 2 }; /* h = 8 ms comes first, then 4 ms */
    CHECK(race->point[VERLET].method == integrator_method("verlet"));
    CHECK(race->point[VERLET].error < 0.01 && !race->point[VERLET].stable);
    CHECK(race->point[VERLET + RACE_METHODS].stable);
    Race timed = *race; /* as if the unstable ones were by far the quickest */
    for (int i = 0; i < timed.count; i++)
        timed.point[i].seconds = timed.point[i].stable ? 1 : 1e-9;
    timed.point[VERLET + RACE_METHODS].seconds = 0.5;
    CHECK(race_quickest(&timed, 1e-2, false) ==
          &timed.point[VERLET + RACE_METHODS]);
    CHECK(race_quickest(&timed, 1e-2, true)->method->implicit);
    CHECK(!race_quickest(&timed, 1e-6, false)); /* what the card says */
    simulation_free(&simulation);
}

static void claim_trust(void)
{
    Simulation simulation;
    int undone = 0, good = 0, all = ENVELOPE_ROWS * ENVELOPE_COLUMNS;
    open_page("trust", "", NULL, NULL, &simulation);
    for (int row = 0; row < ENVELOPE_ROWS; row++)
        for (int column = 0; column < ENVELOPE_COLUMNS; column++) {
            CHECK_STATUS(envelope_visit(&simulation, column, row), STATUS_OK);
            const EnvelopeCell *cell =
                &simulation.exhibit.map.cell[row][column];
            double width = simulation.run[0].x[2 * 24] -
                           simulation.run[0].x[0]; /* m, corner to corner */
            undone += cell->undone;
            good += cell->worst == STATUS_OK && !cell->undone;
            CHECK(cell->undone == (!cell->worst && cell->updates == 0));
            CHECK(!cell->undone || fabs(width - 1.4) <= 1e-15);
            CHECK(!cell->worst || status_is_unconverged(cell->worst));
            for (int i = 0; i < 2 * simulation.system.nodes; i++)
                CHECK(isfinite(simulation.run[0].x[i]) &&
                      isfinite(simulation.run[0].v[i]));
        }
    CHECK(undone == 280 && all == 550);
    CHECK(good >= 0.97 * (all - undone));
    simulation_free(&simulation);
}

static const struct {
    const char *page;
    void (*check)(void);
} claims[] = {
    {"solid", claim_solid},
    {"mesh", claim_mesh},
    {"equation", claim_equation},
    {"forward", claim_forward},
    {"symplectic", claim_symplectic},
    {"backward", claim_backward},
    {"stability", claim_stability},
    {"explicit", claim_explicit},
    {"tangent", claim_tangent},
    {"newton", claim_newton},
    {"overshoot", claim_overshoot},
    {"explodes", claim_explodes},
    {"minimise", claim_minimise},
    {"parts", claim_parts},
    {"dial", claim_dial},
    {"inertia", claim_inertia},
    {"alpha", claim_alpha},
    {"algorithm2", claim_algorithm2},
    {"descent", claim_descent},
    {"psd", claim_psd},
    {"energy", claim_energy},
    {"force", claim_force},
    {"potential", claim_potential},
    {"algorithm3", claim_algorithm3},
    {"step", claim_step},
    {"simulator", claim_simulator},
    {"contact", claim_contact},
    {"friction", claim_friction},
    {"inelastic", claim_inelastic},
    {"fracture", claim_fracture},
    {"race", claim_race},
    {"trust", claim_trust},
};

enum { CLAIMS = sizeof claims / sizeof *claims };

/* A page without a test, and a test without a page, are found. */
TEST(every_claim_has_its_test)
{
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        int tests = 0;
        for (int i = 0; i < CLAIMS; i++)
            tests += strcmp(claims[i].page, page->name) == 0;
        if (tests != 1)
            fail_msg("page %s has %d tests", page->name, tests);
    }
    CHECK(lecture_count() == CLAIMS);
}

TEST(claims_hold)
{
    for (int i = 0; i < CLAIMS; i++) {
        print_message("           %s\n", claims[i].page);
        claims[i].check();
    }
}

/* Each page's file is one that the program has the text of, as it stands in
 * the folder, and its function is defined in it. */
TEST(pages_name_code_that_exists)
{
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        const Listing *listing = listing_find(page->file);
        int from = -1, body = -1, to = -1;
        if (!listing)
            fail_msg("page %s: no text of %s", page->name, page->file);
        if (!listing_function(listing, page->function, &from, &body, &to))
            fail_msg("page %s: no %s in %s", page->name, page->function,
                     page->file);
        CHECK(from >= 0 && from <= body && body < to && to <= listing->lines);
        CHECK(strstr(listing->line[body], page->function) != NULL);
        int lit = 0;
        for (int i = body; i < to; i++)
            lit += strstr(listing->line[i], page->lit) != NULL;
        if (lit < 1 || lit > 4)
            fail_msg("page %s: '%s' is in %d lines", page->name, page->lit,
                     lit);
        CHECK(listing->line[to - 1][0] == '}' ||
              strchr(listing->line[to - 1], '}') != NULL);
    }
}

TEST(listings_are_the_sources)
{
    for (const Listing *listing = listings; listing->file; listing++) {
        char line[512];
        int count = 0;
        FILE *file = fopen(listing->file, "r");
        assert_non_null(file);
        while (fgets(line, sizeof line, file)) {
            line[strcspn(line, "\n")] = '\0';
            CHECK(count < listing->lines);
            assert_string_equal(line, listing->line[count]);
            count++;
        }
        fclose(file);
        CHECK(count == listing->lines);
    }
}

/* What is no definition is not taken for one. */
TEST(listing_finds_definitions_only)
{
    static const char *const text[] = {
        "static double one(double x);",
        "static double two(const Solid *solid, const Vec2 *x,",
        "                  double h);",
        "",
        "/* Comment",
        " * of two lines. */",
        "static double two(const Solid *solid)",
        "{",
        "    return one(3);",
        "}",
        "static double three(void) { return 3; }",
        "",
        "int one(double x)",
        "{",
        "}",
    };
    const Listing listing = {"text", sizeof text / sizeof *text, text};
    int from = 0, body = 0, to = 0;
    CHECK(listing_function(&listing, "one", &from, &body, &to));
    CHECK(from == 12 && body == 12 && to == 15);
    CHECK(listing_function(&listing, "two", &from, &body, &to));
    CHECK(from == 4 && body == 6 && to == 10);
    CHECK(listing_function(&listing, "three", &from, &body, &to));
    CHECK(from == 10 && to == 11);
    CHECK(!listing_function(&listing, "wo", &from, &body, &to));
    CHECK(!listing_function(&listing, "four", &from, &body, &to));
}

/* Every page's line is valid; its texts fit where they are shown. */
TEST(pages_are_complete)
{
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        char message[512] = "";
        Options options;
        if (lecture_options(page, &options, message, sizeof message))
            fail_msg("page %s: %s", page->name, message);
        CHECK(strlen(page->topic) > 3 && strlen(page->topic) <= 48);
        CHECK(strlen(page->text) > 20 && strlen(page->text) <= 220);
        CHECK(strlen(page->look) > 20 && strlen(page->look) <= 160);
        CHECK(strlen(page->touch) > 20 && strlen(page->touch) <= 100);
        CHECK(strlen(page->claim) > 20 && strlen(page->claim) <= 240);
        CHECK(page->cards && strncmp(page->cards, "page", 4) == 0);
        CHECK(page->film >= 0 && page->every >= 0 && page->lines >= 0);
        CHECK(!page->lines || page->open);
        for (const LecturePage *other = lecture_pages; other < page; other++)
            CHECK(strcmp(other->name, page->name) != 0);
    }
    CHECK(lecture_count() >= 26);
}

/* The card of words is high enough for letters of one size on all pages. */
TEST(words_of_all_pages_have_one_size)
{
    int small = 0;
    static const int sizes[][2] = {{1280, 800}, {1120, 700}, {1920, 1080},
                                   {900, 900},  {1024, 768}, {1400, 1050}};
    for (const LecturePage *page = lecture_pages; page->name; page++)
        for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
            int width = sizes[s][0], height = sizes[s][1];
            Simulation simulation;
            Show show;
            Paper paper;
            Options options;
            char message[512];
            assert_int_equal(
                lecture_options(page, &options, message, sizeof message), 0);
            assert_int_equal(
                simulation_create(&options, NULL, NULL, &simulation), 0);
            show_create(&simulation, &show);
            show_lecture(LECTURE_CARDS, NULL, &show);
            assert_int_equal(paper_create(width, height, &paper), 0);
            show.settings = 9; /* as many as fill two rows */
            for (int i = 0; i < show.settings; i++)
                show.setting[i] = (Setting){.name = "name", .letters = 12};
            Layout layout = show_layout(&show, width, height);
            paper.em = layout.em;
            Box inside = cards_inside(layout.card[0], layout.em);
            double size = page_letters(&paper, inside, page);
            if (!(size >= 1.2)) {
                print_message("page %s at %d x %d: letters of %.2f\n",
                              page->name, width, height, size);
                small++;
            }
            paper_free(&paper);
            simulation_free(&simulation);
        }
    CHECK(small == 0);
}

/* An algorithm with lines off goes by another name. */
TEST(listings_are_called_by_what_is_on)
{
    static const char *const rows[][2] = {
        {"square", "Algorithm 3: projected Newton"},
        {"square --filter none", "Algorithm 3, line 3 is off"},
        {"square --line-search none", "Algorithm 3, line 5 is off"},
        {"landscape --filter none --line-search none",
         "Algorithm 1: Newton's method"},
        {"square --filter none --line-search none",
         "Algorithm 3, lines 3 and 5 are off"},
        {"overshoot", "Algorithm 1: Newton's method"},
        {"overshoot --line-search backtrack",
         "Algorithm 1; line 4 is Algorithm 2"},
        {"square --integrator forward-euler", "Forward Euler"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Simulation simulation;
        Show show;
        simulation_from_line(rows[i][0], NULL, NULL, &simulation);
        show_create(&simulation, &show);
        assert_string_equal(card_listing.titled(&show), rows[i][1]);
        simulation_free(&simulation);
    }
}

TEST(pages_are_found)
{
    char last[16];
    snprintf(last, sizeof last, "%d", lecture_count());
    CHECK(lecture_find("1") == &lecture_pages[0]);
    CHECK(lecture_find(last) == &lecture_pages[lecture_count() - 1]);
    CHECK(lecture_find("dial") && lecture_find("dial")->film == 20);
    CHECK(!lecture_find("0") && !lecture_find("-1") && !lecture_find("1000"));
    CHECK(!lecture_find("") && !lecture_find("no-such-page"));
    CHECK(!lecture_find("2x"));
}

TESTS(NULL, NULL)
