/* What each page of the lecture claims with numbers, held to the simulation. */
#include "test.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/contact.h"
#include "model/fracture.h"
#include "model/plasticity.h"
#include "base/mathematics.h"
#include "picture/cards.h"
#include "picture/font.h"
#include "picture/plot.h"
#include "picture/text.h"

/* All Newton updates of a run. */
enum { LOG_MOST = 4096 };

typedef struct Log {
    int count;
    NewtonRecord record[LOG_MOST];
} Log;

static Log updates; /* of the page that was opened last */

static bool keep_record(void *user, const NewtonRecord *record)
{
    (void)user;
    if (updates.count < LOG_MOST)
        updates.record[updates.count++] = *record;
    return true;
}

/* The scene of a page as it is set up, with more options behind its own. */
static Simulation *open_page(const char *name, const char *more)
{
    const LecturePage *page = lecture_find(name);
    assert_non_null(page);
    updates.count = 0;
    Simulation *simulation = simulate_watched(
        keep_record, NULL, "%s%s%s", page->line, more[0] ? " " : "", more);
    lecture_enter(page, &simulation->options);
    return simulation;
}

static void check_falls(void)
{
    CHECK(updates.count > 0);
    for (int i = 0; i < updates.count; i++)
        CHECK(updates.record[i].change < 0 && updates.record[i].slope < 0);
}

/* sum of all masses, kg */
static double total_mass(const System *system)
{
    double sum = 0;
    for (int i = 0; i < system->nodes; i++)
        sum += system->m[i];
    return sum;
}

/* What a page's texts know by this name now, and when it opens. */
static double known_now(Simulation *simulation, const char *fact)
{
    FrameContent content;
    frame_create(simulation, &content);
    frame_add_lecture(COLUMN_CARDS, NULL, &content);
    return frame_find_number(&content, fact);
}

/* Whether a page says what begins with these facts. */
static bool speaks_of(Simulation *simulation, const char *text)
{
    FrameContent content;
    frame_create(simulation, &content);
    frame_fill_values(&content);
    return text_has_line(&active_pane(&content)->values, text);
}

/* Whether it speaks of results of which there are none yet. */
static bool speaks_of_all(Simulation *simulation)
{
    bool all = speaks_of(simulation, "{all runs}");
    CHECK(all != speaks_of(simulation, "{some runs}"));
    return all;
}

static double known(const char *name, const char *fact)
{
    return known_now(open_page(name, ""), fact);
}

/* The lowest node, m, after some seconds. */
static double hang(int segments, double seconds, bool diagonals)
{
    double low = 0, h;
    char line[40];
    snprintf(line, sizeof line, "--segments %d", segments);
    Simulation *simulation = open_page("solid", line);
    for (int kind = 2; kind < 4 && !diagonals; kind++)
        exhibit_flip(simulation, kind);
    h = simulation->options.timestep;
    make_steps(simulation, (int)lrint(seconds / h));
    for (int i = 0; i < simulation->system.nodes; i++)
        low = fmin(low, simulation->run[0].x[2 * i + 1]);
    return low;
}

TEST(claim_solid)
{
    static const int count[2][3] = {{4, 25, 72}, {6, 49, 156}};
    for (int i = 0; i < 2; i++) {
        char line[40];
        snprintf(line, sizeof line, "--segments %d", count[i][0]);
        Simulation *simulation = open_page("solid", line);
        CHECK(known_now(simulation, "masses") == count[i][1]);
        CHECK(known_now(simulation, "springs") == count[i][2]);
        /* each mass is rounded once */
        CHECK_NEAR(total_mass(&simulation->system), 1000, 1e-9);
        CHECK(simulation->system.k[0] == 1e4);
    }
    CHECK_NEAR(hang(4, 20, true), -0.600, 5e-4);
    CHECK_NEAR(hang(16, 20, true), -0.638, 5e-4);
    CHECK(hang(4, 0.5, false) < -1);
    Simulation *simulation = open_page("solid", "--segments 2");
    const System *system = &simulation->system;
    const double *x = simulation->run[0].x; /* node 1 above 0, 3 beside it */
    CHECK(x[2] == x[0] && x[3] > x[1] && x[6] > x[0] && x[7] == x[1]);
    CHECK(system->e[0] == 0 && system->e[1] == 3 && system->springs == 12 + 8);
}

/* The places that the page's opening gives to nodes. */
static void obey_places(Simulation *simulation, const char *page)
{
    const char *at = lecture_find(page)->open;
    for (int count = 0; (at = strstr(at, "place ")); count++, at++) {
        int node = 0;
        double x = 0, y = 0;
        assert_int_equal(sscanf(at, "place %d %lf %lf", &node, &x, &y), 3);
        CHECK(!simulation_place(simulation, node, x, y, true));
    }
}

/* The middle of a body, m. */
static void middle_of(const Simulation *simulation, int body, double x[2])
{
    int each = simulation->mesh.nodes / simulation->mesh.bodies;
    x[0] = x[1] = 0;
    for (int i = 2 * each * body; i < 2 * each * (body + 1); i++)
        x[i % 2] += simulation->run[0].x[i] / each;
}

TEST(claim_equation)
{
    CHECK(known("equation", "balanced") == 9);
    double g[50] = {0}, sum[2] = {0}, scale = 0;
    Simulation *simulation = open_page("equation", "");
    for (int i = 0; i < 25; i++)
        CHECK_NEAR(simulation->system.m[i], 40, 0);
    system_acceleration(&simulation->system, simulation->run[0].x, g);
    for (int i = 0; i < 50; i++) {
        g[i] *= 40; /* the force, N */
        sum[i % 2] += g[i];
        scale = fmax(scale, fabs(g[i]));
    }
    CHECK(scale > 1000);
    CHECK_NEAR(hypot(sum[0], sum[1]), 0, 1e-13 * scale);
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
    Simulation *simulation = open_page(name, "");
    CHECK_NEAR(simulation->options.timestep, 0.5, 0);
    for (int i = 0; i < 20; i++) {
        double before = mass_energy(simulation);
        const double *to = make_steps(simulation, 1)->run[0].x;
        CHECK(i > 0 || fabs(to[0] - x) + fabs(to[1] - y) <= 2e-15);
        CHECK_NEAR(mass_energy(simulation) / before, factor, 1e-14);
    }
}

TEST(claim_forward)
{
    check_euler("forward", 1, 0.5, 1.25);
    CHECK_NEAR(known("forward", "half miss"),
               hypot(1 - cos(0.25), 0.25 - sin(0.25)), 1e-15);
    CHECK_NEAR(known("forward", "half miss") / known("forward", "miss"), 0.25,
               0.02 * 0.25);
    const double *x =
        make_steps(open_page("forward", "--timestep 0.1"), 1)->run[0].x;
    CHECK_NEAR(hypot(x[0] - cos(0.1), x[1] - sin(0.1)), 0.005, 0.02 * 0.005);
    /* what Taylor's next term h^2/2 a, a = (-1, 0), leaves is of third order */
    CHECK_AT_MOST(hypot(x[0] - 0.005 - cos(0.1), x[1] - sin(0.1)), 0.001 / 5);
    CHECK(page_wants_click(lecture_find("forward")));
}

TEST(claim_backward)
{
    CHECK_NEAR(known("backward", "factor"), 0.8, 1e-15);
    check_euler("backward", 0.8, 0.4, 1 / 1.25);
    const double *v = make_steps(open_page("backward", ""), 1)->run[0].v;
    for (int i = 0; i < 2; i++) /* (1 + h^2) v' = v - h x */
        CHECK_NEAR(1.25 * v[i], i - 0.5 * (1 - i), 1e-15);
}

TEST(claim_symplectic)
{
    CHECK_NEAR(known("symplectic", "h limit"), 2, 0); /* as below */
    Simulation *simulation = open_page("symplectic", "");
    const double *x = simulation->run[0].x, *v = simulation->run[0].v;
    double start = 0;
    for (int i = 0; i < 1000; i++) {
        double now =
            2 * mass_energy(simulation) - 0.5 * (x[0] * v[0] + x[1] * v[1]);
        double to[2] = {0.75 * x[0] + 0.5 * v[0], -0.5 * x[0] + v[0]};
        start = i == 0 ? now : start;
        CHECK_NEAR(now, start, 1e-12);
        make_steps(simulation, 1); /* the matrix of trace 2 - h^2 */
        CHECK_NEAR(x[0], to[0], 1e-15);
        CHECK_NEAR(v[0], to[1], 1e-15);
    }
    for (int flies = 0; flies < 2; flies++) {
        simulation =
            open_page("symplectic", flies ? "--timestep 2" : "--timestep 1.98");
        make_steps(simulation, 400);
        CHECK((mass_energy(simulation) > 1e4) == flies);
    }
}

TEST(claim_stability)
{
    double each = hypot(1, 0.02 * 2 * acos(-1));
    double often = known("stability", "doubling");
    CHECK(pow(each, often) >= 2 && pow(each, often - 1) < 2);
    Simulation *simulation = open_page("stability", "");
    for (int i = 0; i < 300; i++) {
        double r[2][3];
        for (int k = 0; k < 6; k++) {
            if (k == 3)
                make_steps(simulation, 1);
            const double *x = simulation->run[k % 3].x;
            r[k / 3][k % 3] = hypot(x[0], x[1]);
        }
        /* sqrt(1 + (0.02 2 pi)^2) = 1.007864; 5 digits are shown */
        CHECK_NEAR(r[1][0] / r[0][0], 1.00786, 5e-6);
        CHECK_NEAR(r[0][2] / r[1][2], 1.00786, 5e-6);
        CHECK_NEAR(r[1][1], 1, 0.04);
    }
    for (int i = 0; i < 2; i++) { /* h omega = 1.95 and 2.07 */
        double most = 0;
        simulation =
            open_page("stability", i ? "--timestep 0.33" : "--timestep 0.31");
        for (int step = 0; step < (i ? 10 : 500); step++) {
            const double *x = make_steps(simulation, 1)->run[1].x;
            most = fmax(most, hypot(x[0], x[1]));
        }
        CHECK(i ? most > 100 : most < 7);
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

/* The same of a page from its start. */
static Status end_of(const char *name, const char *more, int steps)
{
    return run_steps(open_page(name, more), steps);
}

TEST(claim_opening)
{
    CHECK_STATUS(end_of("opening", "", 20), STATUS_NOT_FINITE);
    CHECK_STATUS(end_of("opening", "--timestep 0.004", 1000), STATUS_OK);
    Simulation *simulation =
        open_page("opening", "--integrator backward-euler");
    double start = simulation_energies(simulation, 0).total;
    for (int i = 0; i < 200; i++)
        CHECK_STATUS(simulation_step(simulation), STATUS_OK);
    CHECK_AT_MOST(simulation_energies(simulation, 0).total, 0.1 * start);
}

TEST(claim_closing)
{
    Simulation *simulation = open_page("closing", "");
    CHECK_NEAR(simulation->options.timestep, 0.2, 0);
    const double *x = simulation->descent.point;
    CHECK_NEAR(x[0], -0.4, 0);
    CHECK_NEAR(x[1], -0.2, 0);
    CHECK_STATUS(run_steps(simulation, 100), STATUS_OK);
    CHECK_NEAR(updates.record[0].alpha, 0.5, 0);
    check_falls();
    CHECK(simulation->done && x[1] < -1);
    CHECK(descent_hessian_index(simulation, x[0], x[1]) == 0);
    double lower = simulation->descent.value;
    simulation = open_page("closing", "--start 0.2,0.9");
    CHECK_STATUS(run_steps(simulation, 100), STATUS_OK);
    CHECK(simulation->descent.point[1] > 1);
    CHECK_NEAR(lower, 0.966, 5e-4);
    CHECK_NEAR(simulation->descent.value, 0.335, 5e-4);
}

TEST(claim_explicit)
{
    double limit = known("explicit", "h limit");
    for (int i = 0; i < 2; i++) { /* a push along it, below and above */
        char line[80];
        double mode[2 * SIMULATION_MODE_NODES];
        snprintf(line, sizeof line, "--timestep %.17g",
                 limit * (i ? 1.02 : 0.98));
        Simulation *simulation = open_page("explicit", line);
        simulation_fastest_mode(simulation, simulation->run[0].x, mode);
        for (int k = 0; k < 2 * simulation->system.nodes; k++)
            simulation->run[0].v[k] += 1e-6 * mode[k];
        double start = simulation_energies(simulation, 0).total;
        run_steps(simulation, 300);
        double now = simulation_energies(simulation, 0).total;
        CHECK((now < 1e3 * start) == (i == 0));
    }
    CHECK_NEAR(0.009 * 2 / limit, 1.84, 0.005);
    CHECK_NEAR(known_now(open_page("explicit", "--stretch 1.2"), "h limit"),
               limit, 1e-12); /* about its rest */
    CHECK_NEAR(0.01 * 2 / limit, 2.05, 0.005);
    double t2 = powl(0.02 / limit, 2); /* of lambda^2 - (2 - t2) lambda + 1 */
    double growth = 0.5 * (t2 - 2) + sqrt(0.25 * (t2 - 2) * (t2 - 2) - 1);
    CHECK_NEAR(known("explicit", "growth"), growth, 1e-9);
    static const struct {
        const char *line;
        int steps;
        Status status;
    } runs[] = {{"", 20, STATUS_NOT_FINITE},
                {"--timestep 0.009", 1000, STATUS_OK},
                {"--timestep 0.0095", 60, STATUS_NOT_FINITE},
                {"--integrator backward-euler", 100, STATUS_OK},
                {"--integrator backward-euler --timestep 1", 100, STATUS_OK}};
    for (int r = 0; r < 5; r++) {
        Simulation *simulation = open_page("explicit", runs[r].line);
        const double *x = simulation->run[0].x, *rest = rest_of(simulation);
        obey_places(simulation, "explicit");
        for (int k = 0; k < 32; k++)
            CHECK_AT_MOST(fabs(x[k] - rest[k]), 0.0034);
        Status status = STATUS_OK;
        double start = simulation_energies(simulation, 0).total, most = 0;
        for (int step = 0; step < runs[r].steps && !status; step++) {
            status = simulation_step(simulation);
            most = fmax(most, simulation_energies(simulation, 0).total / start);
            for (int i = 0; i < 16 && r == 1; i++)
                CHECK_AT_MOST(math_hypot(x[2 * i] - rest[2 * i],
                                         x[2 * i + 1] - rest[2 * i + 1]),
                              0.02);
        }
        CHECK_STATUS(status, runs[r].status);
        CHECK(r != 1 || (most > 12 && most < 13));
    }
}

/* g''/(2 g') of E = (x - 2)^2/2 + 0.45 (x^2 - 1)^2 at the root of g. */
TEST(claim_tangent)
{
    double x[16];
    int count = 0;
    Simulation *simulation = open_page("tangent", "");
    while (!simulation->done) {
        x[count++] = simulation->descent.point[0];
        make_steps(simulation, 1);
    }
    double root = simulation->descent.point[0];
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
    simulation = open_page("tangent", "--start 0.2"); /* there g falls */
    double before = simulation->descent.value;
    make_steps(simulation, 1);
    CHECK_NEAR(simulation->descent.point[0], -3.47, 5e-3);
    CHECK(simulation->descent.value > before);
    /* after five updates |p| is below that, and |g| above */
    CHECK_STATUS(end_of("tangent", "--tolerance 1e-6", 100), STATUS_OK);
    CHECK(updates.count == 6);
}

TEST(claim_newton)
{
    Simulation *simulation = open_page("newton", "");
    const double *x = simulation->descent.point;
    make_steps(simulation, 1);
    CHECK_NEAR(x[0], 0.0248, 5e-5);
    CHECK_NEAR(x[1], 1.2623, 5e-5);
    simulation = open_page("newton", "--start 0.05,-0.05");
    CHECK_STATUS(run_steps(simulation, 100), STATUS_OK);
    CHECK(simulation->done);
    x = simulation->descent.point;
    CHECK(descent_hessian_index(simulation, x[0], x[1]) == 1);
    /* and from below the saddle it climbs there: no success */
    CHECK_STATUS(end_of("newton", "--start 0.1,-0.35", 100), STATUS_DIVERGED);
}

TEST(claim_algorithm1)
{
    static const double norm[] = {8.59, 4.06, 0.622, 0.0271, 6e-5, 3e-10};
    CHECK(known("algorithm1", "updates") == 5);
    Simulation *simulation = open_page("algorithm1", "");
    const Descent *descent = &simulation->descent;
    for (int i = 0; i <= 5; i++) { /* with three digits; of the last two one */
        CHECK_NEAR(descent->residual, norm[i], (i < 4 ? 1e-2 : 0.1) * norm[i]);
        CHECK(simulation->done == (i == 5));
        if (i < 5)
            make_steps(simulation, 1);
    }
    CHECK(descent->count == 5);
    const double *x = descent->point, h = simulation->options.timestep;
    CHECK_NEAR(x[0], 0.0138, 5e-5);
    CHECK_NEAR(x[1], 1.0717, 5e-5);
    CHECK_NEAR((x[0] - 0.6) / h, -2.93, 5e-3);
    CHECK_NEAR((x[1] - 0.9) / h, 0.859, 5e-4);
    CHECK_NEAR(known_now(simulation, "v end"), (x[0] - 0.6) / h, 1e-12);
    for (int k = 0; k < 2; k++) /* v^n leads to x_tilde */
        CHECK_NEAR((simulation->exhibit.target[k] - (k ? 0.9 : 0.6)) / h,
                   k ? -3 : -2, 1e-12);
    /* after four updates |p|/h is below that, and |g| above */
    CHECK_STATUS(end_of("algorithm1", "--tolerance 3e-5", 100), STATUS_OK);
    CHECK(updates.count == 5);
}

TEST(claim_overshoot)
{
    CHECK_NEAR(known("overshoot", "next"), 1.3 - sinh(2.6) / 2, 1e-12);
    CHECK_NEAR(known("overshoot", "slope"), tanh(1.3), 1e-15);
    CHECK_NEAR(known("overshoot", "curvature"), pow(cosh(1.3), -2), 1e-15);
    end_of("overshoot", "", 10);
    CHECK_NEAR(updates.record[0].to[0], -2.047, 5e-4);
    CHECK_NEAR(updates.record[1].to[0], 12.95, 5e-3);
    CHECK(updates.record[2].to[0] < -4e10);
    CHECK_STATUS(end_of("overshoot", "--start -1.0886", 100), STATUS_OK);
    CHECK_STATUS(end_of("overshoot", "--start 1.0886", 100), STATUS_OK);
    CHECK_STATUS(end_of("overshoot", "--start -1.0887", 100), STATUS_DIVERGED);
    CHECK_STATUS(end_of("overshoot", "--start 1.0887", 100), STATUS_DIVERGED);
    CHECK_STATUS(end_of("overshoot", "--start 1.09", 100), STATUS_DIVERGED);
    CHECK(updates.count == 7);
    for (int i = 0; i < updates.count; i++) {
        double from = updates.record[i].from[0], to = updates.record[i].to[0];
        CHECK(from * to < 0 && fabs(to) > fabs(from));
    }
}

/* One update of the page's first step, from its start + u [n]: p, added to u,
 * by eigenvectors of the dense H.  Returns its smallest |eigenvalue|. */
static Real update_dense(const Simulation *simulation, int n, double *u)
{
    static Real g[50], H[50 * 50], q[50 * 50];
    double x[50] = {0}, resting[50] = {0}, h = simulation->options.timestep;
    const double *x_n = simulation->run[0].x;
    const IncrementalPotential E = {.system = &simulation->system,
                                    .weight = h * h,
                                    .x_n = x_n,
                                    .u_tilde = resting};
    Real least = INFINITY;
    for (int i = 0; i < n; i++)
        x[i] = x_n[i] + u[i];
    exact_derivatives(&E, u, x, g, H);
    exact_eigen(n, H, q);
    for (int k = 0; k < n; k++) {
        Real part = 0, lambda = H[(n + 1) * k];
        least = fminl(least, fabsl(lambda));
        for (int i = 0; i < n; i++)
            part -= q[n * i + k] * g[i] / lambda;
        for (int i = 0; i < n; i++)
            u[i] += (double)(part * q[n * i + k]);
    }
    return least;
}

/* How small eigenvalues are on the way to the tenth update, and how far that
 * leads. */
static void check_explosion(void)
{
    Simulation *simulation = open_page("explodes", "");
    double u[32] = {0}, farthest = 0;
    for (int update = 1; update <= 10; update++) {
        Real least = update_dense(simulation, 32, u);
        CHECK(update == 1 || update == 10 || least > 62);
        if (update == 10)
            CHECK_NEAR(least, 0.0043, 5e-5);
    }
    for (int i = 0; i < 16; i++)
        farthest = fmax(farthest, math_hypot(u[2 * i], u[2 * i + 1]));
    CHECK_NEAR(farthest, 1700, 50);
}

TEST(claim_explodes)
{
    CHECK(2 * open_page("explodes", "")->system.nodes == 32);
    static const char *const watched[] = {
        "--projection clamp", "--line-search backtrack",
        "--projection clamp --line-search backtrack"};
    double E = 0, highest = 0, farthest = 0;
    double start = system_potential(&open_page("explodes", "")->system,
                                    open_page("explodes", "")->run[0].x);
    start *= 0.02 * 0.02; /* at rest E is h^2 P */
    CHECK_NEAR(start, 27.3, 0.05);
    simulation_step(open_page("explodes", ""));
    CHECK_NEAR(updates.record[0].slope, 33.6, 0.05);
    CHECK(updates.record[9].slope < 0);
    for (int i = 0; i < updates.count; i++) {
        E += updates.record[i].change;
        if (i == 0)
            CHECK_NEAR(start + E, 634567, 0.5);
        if (i == 8)
            CHECK_NEAR(start + E, 29.2, 0.05);
        highest = fmax(highest, E);
        /* |p_x| + |p_y| is at most sqrt(2) |p| */
        farthest = fmax(farthest, updates.record[i].residual * 0.02 / sqrt(2));
    }
    CHECK(highest > 1e16 && farthest > 1000);
    check_explosion();
    for (int i = 0; i < 3; i++) {
        Status status = simulation_step(open_page("explodes", watched[i]));
        for (int k = 0; k < updates.count; k++)
            CHECK(updates.record[k].change <= 0);
        CHECK(i == 1 || (status == STATUS_OK && updates.count == 6));
    }
}

TEST(claim_minimise)
{
    static const double values[] = {4.918, 2.024, 1.984, 1.984, 1.984, 1.984};
    Simulation *simulation = open_page("minimise", "");
    const TimeIntegrator *run = &simulation->run[0];
    const System *square = &simulation->system;
    double x_tilde[50], value = 0, h = 0.01;
    make_steps(simulation, 4);
    for (int i = 0; i < 50; i++) {
        x_tilde[i] = run->x[i] + h * run->v[i];
        value += 20 * h * h * run->v[i] * run->v[i]; /* m is 40 kg */
    }
    value += h * h * system_potential(square, run->x);
    CHECK_NEAR(h * h * system_potential(square, x_tilde), 3.476, 5e-4);
    CHECK_NEAR(run->x[44], 0.505, 5e-4);
    CHECK_NEAR(x_tilde[44], 0.376, 5e-4);
    simulation_set(simulation, OPTION_SLOT(timestep), h);
    updates.count = 0;
    make_steps(simulation, 1);
    CHECK_NEAR(run->x[44], 0.432, 5e-4);
    CHECK(updates.count == 5);
    for (int i = 0; i <= 5; i++) {
        CHECK_NEAR(value, values[i], 5e-4);
        value += i < 5 ? updates.record[i].change : 0;
    }
}

TEST(claim_parts)
{
    Simulation *simulation = open_page("parts", "");
    for (int s = 0; s < 2; s++) {
        CHECK_NEAR(simulation->system.k[s], 100, 0);
        CHECK_NEAR(simulation->system.l2[s], 1.5 * 1.5, 0);
    }
    const double *target = simulation->exhibit.target, rest = sqrt(1.25);
    CHECK_STATUS(run_steps(simulation, 100), STATUS_OK);
    const double *x = simulation->run[0].x;
    /* [part][where]: the minimum, x_tilde, the two places of rest */
    const double at[4][2] = {
        {x[0], x[1]}, {target[0], target[1]}, {0, rest}, {0, -rest}};
    double value[2][4];
    for (int i = 0; i < 4; i++)
        for (int part = 0; part < 2; part++)
            value[part][i] = landscape_part_value(
                simulation, part ? PART_ELASTICITY : PART_INERTIA, at[i][0],
                at[i][1]);
    CHECK(value[0][1] == 0 && value[1][2] < 1e-15 && value[1][3] < 1e-15);
    CHECK(value[0][0] > 0 && value[0][0] < value[0][2]);
    CHECK(value[1][0] > 0 && value[1][0] < value[1][1]);
    simulation =
        open_page("parts", ""); /* inertia alone is done in one update */
    CHECK(simulation->options.page->flips == 2);
    exhibit_flip(simulation, 1);
    CHECK(simulation->exhibit.switches == PART_INERTIA);
    /* ((0.6 - 0.2)^2 + (0.9 - 0.3)^2) / 2 */
    const Descent *descent = &simulation->descent;
    CHECK_NEAR(descent->value, 0.26, 1e-15);
    make_steps(simulation, 1);
    CHECK(simulation->done && descent->count == 1);
    for (int k = 0; k < 2;
         k++) /* rounding of one subtraction and one addition */
        CHECK_NEAR(descent->point[k], simulation->exhibit.target[k], 1e-15);
}

TEST(claim_dial)
{
    Simulation *simulation = open_page("dial", "");
    const DialCurve *dial = &simulation->exhibit.dial;
    const double *target = simulation->exhibit.target;
    CHECK_NEAR(dial->h[0], 1e-3, 1e-15);
    CHECK_AT_MOST(
        hypot(dial->point[0][0] - target[0], dial->point[0][1] - target[1]),
        1e-3);
    CHECK_NEAR(dial->h[DIAL_POINTS - 1], 10, 1e-12);
    CHECK_AT_MOST(hypot(dial->point[DIAL_POINTS - 1][0],
                        dial->point[DIAL_POINTS - 1][1] - sqrt(1.25)),
                  1e-3);
    for (int bowl = 0; bowl < 2; bowl++) {
        int bends = 0;
        simulation->run[0].h = bowl ? 0.067 : 0.0675;
        for (int i = 0; i < 81 * 81; i++) /* every place of the map */
            bends += descent_hessian_index(simulation, 0.05 * (i % 81 - 40),
                                           0.05 * (i / 81 - 40)) > 0;
        CHECK((bends == 0) == bowl);
    }
}

TEST(claim_algorithm2)
{
    static const double alpha[] = {0.25, 0.5, 1, 1, 1, 1};
    CHECK_NEAR(known("algorithm2", "first length"), 0.25, 0);
    CHECK_NEAR(2 - sinh(4) / 2, -11.64, 0.005);
    CHECK_STATUS(end_of("algorithm2", "--line-search none", 100),
                 STATUS_DIVERGED);
    CHECK_STATUS(end_of("algorithm2", "", 100), STATUS_OK);
    CHECK(updates.count == 6);
    check_falls();
    CHECK_NEAR(updates.record[0].to[0], -1.41, 0.005);
    for (int i = 0; i < 6; i++)
        CHECK_NEAR(updates.record[i].alpha, alpha[i], 0);
}

TEST(claim_descent)
{
    Simulation *simulation = open_page("descent", "");
    CHECK_NEAR(simulation->options.timestep, 0.2, 0);
    CHECK_NEAR(simulation->run[0].x[0], 0.1, 0);
    CHECK_NEAR(simulation->run[0].x[1], -0.35, 0);
    CHECK_NEAR(simulation->descent.slope, 0.86, 0.005);
    simulation_set(simulation, OPTION_SLOT(projection), PROJECTION_CLAMP);
    CHECK_NEAR(simulation->descent.slope, -2.94, 0.005);
}

TEST(claim_psd)
{
    CHECK_NEAR(known("psd", "negative"), -220, 1e-12);
    Simulation *simulation = open_page("psd", "--projection abs");
    CHECK(known_now(simulation, "projected across") == 0);
    exhibit_drag(simulation, 0, 2, 1);
    CHECK(known_now(simulation, "negative") == 0);
    for (double r = 0.02; r < 1.5; r += 0.02) {
        SpringValues spring = spring_evaluate((double[2]){r, 0}, 1, 100);
        CHECK_NEAR(2 * spring.across, 4 * 100 * (r * r - 1), 1e-9);
        CHECK_NEAR(2 * spring.along, 4 * 100 * (3 * r * r - 1), 1e-9);
        CHECK((spring.along <= 0) == (r < 1 / sqrt(3)));
    }
}

/* How much the springs of each kind hold, J. */
static double held_by_kinds(const Simulation *simulation, double kind[4])
{
    const System *system = &simulation->system;
    double sum = 0;
    memset(kind, 0, 4 * sizeof *kind);
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        const double *a = simulation->run[0].x + 2 * e[0];
        const double *b = simulation->run[0].x + 2 * e[1];
        double d[2] = {a[0] - b[0], a[1] - b[1]}, l2 = system->l2[s];
        double strain = (d[0] * d[0] + d[1] * d[1]) / l2 - 1;
        double held = 0.5 * l2 * system->k[s] * strain * strain;
        kind[exhibit_spring_kind(simulation, s)] += held;
        sum += held;
    }
    return sum;
}

TEST(claim_stretched)
{
    double kind[4];
    Simulation *simulation = open_page("stretched", "");
    CHECK_NEAR(held_by_kinds(simulation, kind), 103680, 1e-6);
    CHECK_NEAR(kind[0], 57600, 1e-6);
    CHECK_NEAR(kind[0] / 20, 2880, 1e-7);
    CHECK_NEAR(kind[1], 0, 1e-9);
    CHECK_NEAR(kind[2] + kind[3], 46080, 1e-6);
    CHECK_NEAR((kind[2] + kind[3]) / 32, 1440, 1e-7);
    CHECK_NEAR(simulation_energies(simulation, 0).total, 103680, 1e-6);
    simulation = open_page("stretched", "--segments 8");
    CHECK(simulation->system.springs == 272);
    CHECK_NEAR(held_by_kinds(simulation, kind), 97920, 1e-6);
}

TEST(claim_energy)
{
    const double k = 100;
    SpringValues rest = spring_evaluate((double[2]){1, 0}, 1, k);
    SpringValues near = spring_evaluate((double[2]){0, 0}, 1, k);
    CHECK_NEAR(rest.along, 4 * k, 0);
    CHECK_NEAR(rest.root_along, 4 * k, 0);
    CHECK_NEAR(near.energy, 50, 0);
    CHECK_NEAR(near.root_energy, 200, 0);
    CHECK_NEAR(known("energy", "tip"), 200, 1e-12);
    near = spring_evaluate((double[2]){1e-3, 0}, 1, k);
    CHECK_NEAR(near.across, -2 * k, 1e-5 * k);
    CHECK_NEAR(near.root_across, -3996 * k, 1e-9 * k);
}

TEST(claim_force)
{
    Simulation *simulation = open_page("force", "");
    const double *x = simulation->run[0].x;
    const System *system = &simulation->system;
    SpringValues spring = spring_evaluate(x, system->l2[0], system->k[0]);
    CHECK_NEAR(spring.strain, 0.69, 1e-15);
    CHECK_NEAR(spring.energy, 23.805, 1e-12);
    CHECK_NEAR(spring.force[0], -179.4, 1e-12);
    CHECK_NEAR(spring.along, 814, 1e-12);
    CHECK_NEAR(known_now(simulation, "across"), 138, 1e-12);
    CHECK_NEAR(known_now(simulation, "Dxx"), 814, 1e-5);
    CHECK_NEAR(known_now(simulation, "Dyy"), 138, 1e-5);
    CHECK_NEAR(system_potential(system, x), spring.energy, 1e-12);
    exhibit_drag(simulation, 0, 4, 0);
    CHECK_NEAR(known_now(simulation, "force too"), -200 * 15 * 4, 1e-5);
    CHECK_NEAR(known_now(simulation, "Dxx"), 200 * (15 + 32), 1e-5);
}

TEST(claim_potential)
{
    CHECK(known("potential", "places") == 676);
    Simulation *simulation = open_page("potential", "");
    const System *system = &simulation->system;
    CHECK(system->nodes == 25 && system->springs == 72);
    double before[50]; /* only the matrix changes from step to step */
    memcpy(before, simulation->run[0].x, sizeof before);
    make_steps(simulation, 72);
    assert_memory_equal(before, simulation->run[0].x, sizeof before);
    simulation = open_page("potential", "--stretch 0.5 --projection none");
    CHECK(known_now(simulation, "Byy") == 0); /* projected all the same */
}

TEST(claim_algorithm3)
{
    CHECK(known("algorithm3", "short") == 52);
    Simulation *simulation = open_page("algorithm3", "");
    make_steps(simulation, 1);
    CHECK(updates.count == 6);
    CHECK(updates.record[0].projected == 52);
    for (int i = 0; i < updates.count; i++)
        CHECK_NEAR(updates.record[i].alpha, 1, 0);
    check_falls();
}

TEST(claim_step)
{
    make_steps(open_page("step", "--tolerance 0.01"), 1);
    CHECK(updates.count == 3);
    check_falls();
    make_steps(open_page("step", ""), 1);
    CHECK(updates.count == 6);
    check_falls();
    for (int k = 1; k < 6; k++) {
        static const double factors[] = {0, 36, 330, 392, 227, 217};
        const NewtonRecord *at = &updates.record[k];
        CHECK_NEAR(at[-1].residual / at->residual, factors[k], 0.5);
        CHECK(at->projected == 20);
    }
    make_steps(open_page("step", "--projection none"), 1);
    CHECK(updates.count == 5);
    for (int k = 2; k < 4; k++) {
        double before = updates.record[k - 1].residual;
        CHECK_NEAR(updates.record[k].residual / (before * before), 0.009,
                   0.0005);
    }
}

/* Triangles turned over, of a square of springs each cell's two. */
static int turned_over(const Simulation *simulation)
{
    int turned = 0, node[3], side[3];
    const double *x = simulation->run[0].x;
    for (int t = 0; t < 4 * simulation->mesh.cells; t++) {
        square_mesh_get_triangle(&simulation->mesh, t, node, side);
        const double *a = x + 2 * node[0], *b = x + 2 * node[1];
        const double *c = x + 2 * node[2];
        turned += !(
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0);
    }
    return turned;
}

TEST(claim_simulator)
{
    static const char *const larger[] = {"--density 1e5", "--stiffness 1e7",
                                         "--stretch 140", "--timestep 0.4"};
    for (int i = 0; i < 4; i++) {
        Simulation *simulation = open_page("simulator", larger[i]);
        double start = simulation_energies(simulation, 0).total;
        for (int step = 0; step < 100; step++) {
            CHECK_STATUS(simulation_step(simulation), STATUS_OK);
            CHECK(simulation_energies(simulation, 0).total <= start);
        }
    }
    Simulation *simulation = open_page("simulator", "");
    double start = simulation_energies(simulation, 0).total;
    make_steps(simulation, 100);
    CHECK(simulation_energies(simulation, 0).total < 0.5 * start);
    make_steps(simulation, 100); /* at the minima themselves 0.24335 J */
    CHECK_NEAR(simulation_energies(simulation, 0).total, 0.2433, 5e-4);
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

TEST(claim_contact)
{
    double nearest = 1;
    Simulation *simulation = open_page("contact", "");
    CHECK_NEAR(total_mass(&simulation->system), 1000, 1e-9);
    for (int step = 0; step < 300; step++) {
        make_steps(simulation, 1);
        const double *x = simulation->run[0].x;
        for (int i = 0; i < 2 * simulation->system.nodes; i += 2)
            nearest = fmin(nearest, fmin(x[i + 1] + 0.5, 1.1 - fabs(x[i])));
        if (step + 1 != lecture_find("contact")->picture)
            continue;
        double s = nearest / 0.01;
        CHECK_NEAR(known_now(simulation, "law force"),
                   125 / 0.01 * (1 / s - 1 - log(s)), 1);
        CHECK_NEAR(nearest, 5.75e-3, 5e-6);
    }
    CHECK(nearest > 5e-3);
    CHECK_NEAR(known("contact", "c"), 125, 1e-9); /* d_hat kappa A/2 */
}

/* Steps that converge, at the end of which nothing is turned or passed. */
static Simulation *bodies_after(const char *name, const char *more, int steps)
{
    Simulation *simulation = open_page(name, more);
    for (int step = 0; step < steps; step++) {
        const double *x = make_steps(simulation, 1)->run[0].x;
        CHECK(exact_crossings(&simulation->system, x) == 0);
        CHECK(smallest_cell(&simulation->system, x) > 0);
    }
    CHECK(simulation->unconverged == 0);
    return simulation;
}

TEST(claim_friction)
{
    for (int i = 0; i < 2; i++) {
        double x[2], rigid = 1 / (2 * (i ? 0.4 : 0.2) * 9.81);
        Simulation *rub =
            bodies_after("friction", i ? "--friction 0.4" : "", 100);
        for (int body = 1; body < 3; body++) {
            middle_of(rub, body, x);
            CHECK_NEAR(x[0] + 0.15, rigid, 0.01 * rigid);
        }
        CHECK_NEAR(known_now(rub, "rigid"), rigid, 1e-12);
        CHECK_NEAR(rigid, i ? 0.127 : 0.255, 5e-4);
    }
}

TEST(claim_inelastic)
{
    double nearest = 1, most = 0;
    Simulation *simulation = open_page("inelastic", "");
    double start = simulation_energies(simulation, 0).total;
    CHECK_NEAR(simulation_energies(simulation, 0).kinetic, 8000, 1e-9);
    CHECK_NEAR(start, 8225, 1e-9);
    for (int step = 0; step < 300; step++) {
        if (step % 60 == 0 && step <= 60) { /* rounding is no flow */
            FrameContent content;
            frame_create(simulation, &content);
            frame_fill_values(&content);
            TextLine title =
                text_first_line(&active_pane(&content)->values, card_law.title);
            CHECK((strcmp(title.words, "no spring has flowed") == 0) ==
                  (step == 0));
            double up = 0, gap = 1;
            for (int i = 0; i < simulation->system.nodes; i++) {
                const double *x = simulation->run[0].x + 2 * i;
                gap = fmin(gap, hypot(x[0], x[1] + 0.75) - 0.35);
                up += simulation->run[0].v[2 * i + 1] *
                      simulation->system.m[i] / 1000;
            }
            CHECK_NEAR(up, step ? 0.98 : -4, 5e-3);
            CHECK(gap > 0.03);
        }
        make_steps(simulation, 1);
        const double *x = simulation->run[0].x;
        for (int i = 0; i < 2 * simulation->system.nodes; i += 2)
            nearest = fmin(nearest, hypot(x[i], x[i + 1] + 0.75) - 0.35);
    }
    const Plasticity *plasticity =
        system_term_data(&simulation->system, &plastic_energy);
    assert_non_null(plasticity);
    for (int s = 0; s < simulation->system.springs; s++)
        most = fmax(most, fabs(plasticity->ep[s]));
    CHECK(most > 0.05);
    CHECK_NEAR(fabs(known_now(simulation, "s_p")), most, 0);
    CHECK(nearest > 0);
    CHECK(energy_now(simulation, 0, "plastic") > 0);
    check_ledger(simulation, start);
}

TEST(claim_return)
{
    Simulation *simulation = open_page("return", "");
    double start = simulation_energies(simulation, 0).total;
    make_steps(simulation, 5);
    CHECK_NEAR(known_now(simulation, "law x"),
               smallest_cell(&simulation->system, simulation->run[0].x), 1e-12);
    make_steps(simulation, 195);
    check_ledger(simulation, start);
    CHECK(simulation->unconverged == 0);
    CHECK(turned_over(simulation) == 0);
    for (int i = 0; i < 2 * simulation->mesh.nodes; i++)
        CHECK_NEAR(simulation->run[0].x[i], rest_of(simulation)[i], 0.01);
    simulation = open_page("return", "--material springs");
    make_steps(simulation, 200);
    CHECK(turned_over(simulation) > 80);
}

TEST(claim_bodies)
{
    for (int i = 0; i < 2; i++) {
        double x[2];
        middle_of(bodies_after("bodies", i ? "--young 200000" : "", 100), 0, x);
        CHECK(i ? x[1] > 0 : x[1] < -0.4);
    }
    const LecturePage *page = lecture_find("bodies");
    Simulation *through = open_page("bodies", "");
    Options options;
    char message[80];
    CHECK_STATUS(lecture_options(page, &options, MESSAGE(message)), 0);
    assert_string_equal(options.pin, "all:2,all:3");
    CHECK(options.pin == strstr(page->line, "all:2")); /* it stays */
    double most[2] = {0, 0};
    CHECK(page->picture == 36);
    for (int step = 0; step < 36; step++) {
        make_steps(through, 1);
        most[0] = fmax(most[0], energy_now(through, 0, "elastic"));
        most[1] = fmax(most[1], energy_now(through, 0, "contact"));
    }
    CHECK_NEAR(most[0], 462, 0.5);
    CHECK_NEAR(most[1], 20, 0.5);
    CHECK_NEAR(energy_now(through, 0, "friction"), 259, 0.5);
    CHECK_NEAR(simulation_energies(through, 0).dissipated, 978, 0.6);
    for (int i = 0; i < through->mesh.nodes / 3; i++)
        CHECK(through->run[0].x[2 * i + 1] < 0);
}

TEST(claim_fracture)
{
    Simulation *simulation = open_page("fracture", "");
    CHECK(simulation->options.segments == 24);
    double start = simulation_energies(simulation, 0).total;
    make_steps(simulation, 20);
    CHECK(energy_now(simulation, 0, "fracture") == 0);
    const System *system = &simulation->system;
    static bool before[4000];
    int count = 0, broken = 0;
    for (int s = 0; s < system->springs; s++)
        broken -= before[s] = spring_is_broken(system, s); /* the slit's */
    for (int step = 20; step < 45; step++) {
        make_steps(simulation, 1);
        for (int s = 0; s < system->springs; s++) {
            const double *rest = rest_of(simulation);
            const double *a = rest + 2 * system->e[2 * s];
            const double *b = rest + 2 * system->e[2 * s + 1];
            /* the slit: a column of cells, x = 1/48, and |y| < 5/48 */
            double across = fabs(0.5 * (a[0] + b[0]) - 1 / 48.0);
            double beyond = fabs(0.5 * (a[1] + b[1])) - 5 / 48.0;
            if (before[s] || !spring_is_broken(system, s))
                continue;
            before[s] = true;
            CHECK(across <= beyond + 1e-9);
            CHECK(count++ >= 2 || (across < 1e-9 && beyond < 1 / 47.0));
        }
    }
    CHECK(count > 10);
    double most = 0; /* largest load of a spring that still pulls */
    for (int step = 45; step < 100; step++) {
        make_steps(simulation, 1);
        most = fmax(most, known_now(simulation, "law x"));
        CHECK(known_now(simulation, "law y") == known_now(simulation, "law x"));
    }
    CHECK(most > 1);
    for (int s = 0; s < system->springs; s++)
        broken += spring_is_broken(system, s);
    CHECK(broken > 100);
    CHECK(energy_now(simulation, 0, "fracture") > 0);
    check_ledger(simulation, start);
}

static Simulation *run_out(const char *name, const char *options)
{
    Simulation *simulation = open_page(name, options);
    while (!simulation->done)
        make_steps(simulation, 1);
    return simulation;
}

/* The race with its last run made. */
static Simulation *whole_race(const char *name)
{
    Simulation *simulation = open_page(name, "");
    for (; !simulation->done; make_steps(simulation, 1))
        CHECK(!speaks_of_all(simulation));
    CHECK(speaks_of_all(simulation));
    return simulation;
}

/* What the table says, and what its try and its notes do. */
static void check_race_table(void)
{
    Simulation *raced = whole_race("order");
    const Race *race = &raced->exhibit.race;
    double quickest = INFINITY;
    for (int i = 0; i < race->count; i++) {
        const RacePoint *point = &race->point[i];
        if (point->stable && !point->method->implicit && point->error <= 0.01)
            quickest = fmin(quickest, point->seconds);
    }
    CHECK_NEAR(known_now(raced, "explicit ms"), 1e3 * quickest, 0);
    enum { VERLET = 2 }; /* h = 8 ms comes first, then 4 ms */
    CHECK(race->point[VERLET].method == integrator_method("verlet"));
    CHECK(race->point[VERLET].error < 0.01 && !race->point[VERLET].stable);
    CHECK(race->point[VERLET + RACE_METHODS].stable);
    CHECK_NEAR(race_find_stable_h(race, VERLET), 0.004, 1e-15);
    CHECK(isnan(race_find_stable_h(race, 0))); /* forward Euler */
    Simulation *longer = simulate("square --stretch 1.1 --tolerance 1e-8 "
                                  "--timestep 1 --integrator midpoint");
    double start = simulation_energies(longer, 0).total, most = 0;
    for (int i = 0; i < 100; i++)
        most = fmax(most, simulation_energies(make_steps(longer, 1), 0).total /
                              start);
    CHECK(most > 100);
    Simulation *stiff = run_out("order", "--stiffness 1e9 --stretch 1.01");
    for (int i = 0; i < RACE_METHODS * RACE_STEP_SIZES; i++) {
        const RacePoint *point = &stiff->exhibit.race.point[i];
        CHECK(point->method->implicit ? point->error < 0.01
                                      : !(point->error < 1e9));
    }
    CHECK_NEAR(stiff->exhibit.race.point[0].h, RACE_TIME / 8, 1e-15);
}

TEST(claim_order)
{
    static const double factor[RACE_METHODS] = {2, 2, 4, 2, 4, 4, 4};
    const Race *race = &whole_race("order")->exhibit.race;
    for (int i = 0; i < RACE_METHODS; i++) {
        const RacePoint *point =
            &race->point[(RACE_STEP_SIZES - 1) * RACE_METHODS + i];
        while (point->error < 1e-8) /* where tolerance and reference are seen */
            point -= RACE_METHODS;
        /* terms of higher order: a quarter */
        CHECK_NEAR((point - RACE_METHODS)->error / point->error, factor[i],
                   0.25 * factor[i]);
        point = &race->point[RACE_SHOWN_ROW * RACE_METHODS + i];
        CHECK_NEAR(point->h, 0.004, 1e-15);
        Simulation *again =
            simulate("square --stretch 1.1 --tolerance 1e-8 --timestep 0.004 "
                     "--integrator %s",
                     point->method->name);
        double start = simulation_energies(again, 0).total;
        if (i == 0) { /* forward Euler explodes */
            CHECK(isnan(point->energy_after_second));
            continue;
        }
        make_steps(again, 250);
        CHECK_NEAR(point->energy_after_second,
                   simulation_energies(again, 0).total / start, 1e-6);
    }
    check_race_table();
}

TEST(claim_trust)
{
    int good = 0;
    Simulation *simulation = open_page("trust", "");
    CHECK(!speaks_of_all(simulation));
    CHECK(isnan(known_now(simulation, "known"))); /* a single run is no map */
    for (int row = 0; row < ENVELOPE_ROWS; row++)
        for (int column = 0; column < ENVELOPE_COLUMNS; column++) {
            CHECK_STATUS(envelope_run_cell(simulation, column, row), STATUS_OK);
            const EnvelopeCell *cell =
                &simulation->exhibit.map.cell[row][column];
            good += cell->worst == STATUS_OK && cell->updates > 0;
            for (int i = 0; i < 2 * simulation->system.nodes; i++)
                CHECK(isfinite(simulation->run[0].x[i]) &&
                      isfinite(simulation->run[0].v[i]));
        }
    CHECK(good == 550);
    CHECK(speaks_of(simulation, "{all converged}"));
    CHECK(!speaks_of(simulation, "{rounded}") &&
          !speaks_of(simulation, "{refused}"));
    CHECK(speaks_of_all(simulation));
    simulation = run_out("trust", "--stretch 0.5 --projection none");
    CHECK(speaks_of(simulation, "{refused}"));
    CHECK(!speaks_of(simulation, "{rounded}"));
}

/* A page without a test, and a test without a page, are found. */
TEST(every_claim_has_its_test)
{
    int claims = 0;
    for (size_t i = 0; i < test_count; i++) {
        bool claim = strncmp(test_list[i].name, "claim_", 6) == 0;
        claims += claim;
        CHECK(!claim || lecture_find(test_list[i].name + 6));
    }
    CHECK(claims == lecture_count());
}

/* Each page has its functions, in their order and to their ends, and few of
 * their lines are lit. */
TEST(pages_show_their_code)
{
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        char names[160], *rest = names, *name;
        int lit = 0, functions = 0, ends = 0;
        snprintf(names, sizeof names, "%s", page->function);
        name = strtok_r(rest, ",", &rest);
        for (const char *const *line = page->code; *line; line++) {
            lit += strstr(*line, page->lit) != NULL;
            CHECK(!strstr(*line, "FAIL(")); /* no reports */
            ends += (*line)[0] == '}';
            if (name && ends == functions && strstr(*line, name)) {
                name = strtok_r(rest, ",", &rest);
                functions++;
            }
        }
        if (name || functions == 0 || ends != functions)
            fail_msg("page %s: no %s in %s", page->name, name, page->file);
        if (lit < 1 || lit > 5)
            fail_msg("page %s: '%s' is in %d lines", page->name, page->lit,
                     lit);
    }
}

/* What is asked can be answered. */
TEST(pages_ask_what_has_an_answer)
{
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        if (page->answer && !page_wants_click(page) &&
            !isfinite(known(page->name, page->answer)))
            fail_msg("page %s: no number %s", page->name, page->answer);
        CHECK(page->ask || (!page->answer && !page->veils));
    }
}

/* What a frame has: the smallest letters, pixels, those of scripts, too; words
 * that its place cuts, curves that leave their axes, and all texts, with blanks
 * between. */
static struct {
    int smallest, smallest_code, ellipses, cut, outside;
    char texts[1 << 15];
} seen;

const Glyph *__real_font_glyph(Text *text, Face face, int size,
                               uint32_t letter);
const Glyph *__wrap_font_glyph(Text *text, Face face, int size,
                               uint32_t letter);
int __real_text_draw(Text *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup);
int __wrap_text_draw(Text *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup);
void __real_plot_curve(const Plot *plot, int count, const double *x,
                       const double *y, double width, Colour colour);
void __wrap_plot_curve(const Plot *plot, int count, const double *x,
                       const double *y, double width, Colour colour);

const Glyph *__wrap_font_glyph(Text *text, Face face, int size, uint32_t letter)
{
    if (letter != ' ' && size < seen.smallest)
        seen.smallest = size;
    if (face == FACE_MONO && size < seen.smallest_code)
        seen.smallest_code = size;
    seen.ellipses += letter == 0x2026;
    return __real_font_glyph(text, face, size, letter);
}

int __wrap_text_draw(Text *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup)
{
    const Box *place = &canvas->clip;
    double wide = text_extent(text, style, markup).width;
    double left = x - 0.5 * (double)align * wide;
    size_t used = strlen(seen.texts);
    seen.cut += left < place->x - 1.5 || y < place->y - 1.5 ||
                left + wide > place->x + place->width + 1.5 ||
                y + style->size > place->y + place->height + 1.5;
    snprintf(seen.texts + used, sizeof seen.texts - used, "%s ", markup);
    return __real_text_draw(text, canvas, style, x, y, align, markup);
}

void __wrap_plot_curve(const Plot *plot, int count, const double *x,
                       const double *y, double width, Colour colour)
{
    const Axis *axis = &plot->y;
    double slack = 1e-9 * fmax(fabs(axis->low), fabs(axis->high));
    for (int i = 0; i < count && plot->x.high > plot->x.low; i++)
        seen.outside += x[i] >= plot->x.low && x[i] <= plot->x.high &&
                        (y[i] < axis->low - slack || y[i] > axis->high + slack);
    __real_plot_curve(plot, count, x, y, width, colour);
}

/* What a frame of a page has: cards, large cards before and after the answer,
 * code, the list of pages. */
enum { CARDS, LARGE, LARGE_ASKED, CODE, LIST, KINDS };

/* The first line of a page's text that is not all there; NULL: all are. */
static const char *missing_line(const FrameContent *content, const char *text)
{
    static TextLine line;
    line = text_begin(&active_pane(content)->values, text);
    while (text_next_line(&line))
        if (!strstr(seen.texts, line.words))
            return line.words;
    return NULL;
}

/* brief: an answer may leave out the page's first text. */
static const char *missing_words(const FrameContent *content, bool brief)
{
    const LecturePage *page = content->lecture.page;
    const char *texts[] = {brief ? NULL : page->text, page->formula,
                           content->lecture.hides_answer ? page->ask
                                                         : page->look,
                           content->lecture.hides_answer ? NULL : page->touch};
    const char *missing = NULL;
    for (int i = 0; i < 4 && !missing; i++)
        missing = missing_line(content, texts[i]);
    return missing;
}

static void check_frame(const LecturePage *page, Simulation *simulation,
                        int kind, Paper *paper)
{
    static const Column column[KINDS] = {
        COLUMN_CARDS, COLUMN_CARDS, COLUMN_CARDS, COLUMN_CODE, COLUMN_PAGES};
    int width = paper->canvas.width, height = paper->canvas.height;
    bool large = kind == LARGE || kind == LARGE_ASKED;
    /* E along p rises far above what is accepted: the axis has that */
    bool cuts = strstr("descent algorithm2 closing", page->name);
    const char *missing = NULL;
    FrameContent content;
    simulation->options.big = large;
    frame_create(simulation, &content);
    content.lecture.hides_answer = kind == LARGE_ASKED && page->ask;
    frame_add_lecture(column[kind], NULL, &content);
    frame_describe(&content);
    memset(&seen, 0, sizeof seen);
    seen.smallest = seen.smallest_code = INT_MAX;
    frame_draw(paper, &content);
    bool good = (seen.smallest + 0.5) * (large ? 35 : 55) >= height;
    if (kind == CODE) { /* the picture and a star stay */
        Layout beside = layout_create(&content, width, height);
        int star = page->star
                       ? picture_card(picture_of(simulation->scene), page->star)
                       : -1;
        CHECK(beside.stage.width > 0.3 * width);
        CHECK(star < 0 ||
              beside.card[star].height > 0.25 * beside.stage.height);
        good = good && (strcmp(page->file, "src/lecture.c") != 0 ||
                        50 * (seen.smallest_code + 0.5) > height);
    }
    if (kind < CODE)
        missing = missing_words(&content, kind == LARGE);
    if (!good || missing || (large && seen.ellipses > 0) ||
        (kind != LIST && seen.cut > 0) || (!cuts && seen.outside > 0))
        fail_msg("page %s, step %ld, at %d x %d, %d: letters of %d, of code "
                 "%d, %d cut, %d outside, %d beyond the axes, no '%s'",
                 page->name, simulation->steps, width, height, kind,
                 seen.smallest, seen.smallest_code, seen.ellipses, seen.cut,
                 seen.outside, missing ? missing : "");
}

/* On every page, as it opens and later, letters have a 55th of the height, in
 * large type a 35th, and no text of it is cut off; code of lecture.c, whose
 * lines have up to 80 letters, a 50th.  No word is outside its card, no curve
 * outside its axes. */
TEST(pages_are_read_from_the_back_row)
{
    static const int sizes[][2] = {{1280, 800}, {1366, 768}, {1920, 1080}};
    for (int s = 0; s < 3; s++) {
        Paper paper;
        CHECK_STATUS(paper_create(sizes[s][0], sizes[s][1], &paper), STATUS_OK);
        for (int i = 0; lecture_pages[i].name; i++) {
            const LecturePage *page = &lecture_pages[i];
            Simulation *simulation = open_page(page->name, "");
            for (int kind = 0; kind < KINDS; kind++)
                if (kind == LARGE || kind == LARGE_ASKED || (i + kind) % 3 == s)
                    check_frame(page, simulation, kind, &paper);
            run_steps(simulation, 5);
            check_frame(page, simulation, s ? CARDS : LARGE, &paper);
            free_all_begun();
        }
        paper_free(&paper);
    }
    FrameContent content; /* large letters outside of the lecture */
    frame_create(simulate("square --big"), &content);
    CHECK(layout_create(&content, 1280, 800).em > 800 / 40);
}

/* Nor is a word outside its place in any scene, in windows of several sizes. */
TEST(scenes_keep_their_words_in_place)
{
    static const int sizes[][2] = {{900, 900}, {800, 600}, {1280, 800}};
    for (int i = 0; scenes[i].name; i++) {
        Simulation *simulation = simulate("%s", scenes[i].name);
        for (int s = 0; s < 3; s++) {
            Paper paper;
            FrameContent content;
            CHECK_OK(paper_create(sizes[s][0], sizes[s][1], &paper));
            frame_create(simulation, &content);
            frame_describe(&content);
            memset(&seen, 0, sizeof seen);
            frame_draw(&paper, &content);
            paper_free(&paper);
            if (seen.cut > 0)
                fail_msg("%s at %d x %d: %d words cut", scenes[i].name,
                         sizes[s][0], sizes[s][1], seen.cut);
        }
        free_all_begun();
    }
}

TESTS(NULL, NULL)
