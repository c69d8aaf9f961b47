/* Damping of springs: its derivatives and what they are along a line, the
 * ordinary differential equation of two masses, momentum, turning, the ledger,
 * and everything that a damped scene shares with others.
 */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model/contact.h"
#include "model/damping.h"
#include "model/fracture.h"
#include "model/mass_spring_energy.h"
#include "model/plasticity.h"
#include "play/track.h"
#include "scenes/state.h"

static const double H = 0.01;

/* A random system with random theta, frozen at random x_n; x [MAX_SIZE] out. */
static double damped_system(Random *random, bool flows, System *system,
                            double *x_n, double *x)
{
    random_system(random, SPRINGS_MIXED, system, x_n);
    double theta = random_logarithmic(random, 1e-3, 1e3);
    if (flows)
        CHECK_STATUS(plasticity_set(system, 0.1, 0.3), STATUS_OK);
    CHECK_STATUS(damping_add(system, theta * H), STATUS_OK);
    Term *term = system_find_term(system, &damping);
    CHECK(damping.begin(term, system, x_n, x_n, H));
    for (int i = 0; i < 2 * system->nodes; i++)
        x[i] = x_n[i] + random_uniform(random, -0.2, 0.2);
    return theta;
}

/* |d|^2/l2 - 1 of spring s at x + e, e in coordinate c. */
static long double strain(const System *system, int s, const double *x, int c,
                          long double e)
{
    long double d[2];
    for (int a = 0; a < 2; a++) {
        int i = 2 * system->e[2 * s] + a, j = 2 * system->e[2 * s + 1] + a;
        d[a] = (long double)x[i] + (i == c ? e : 0) - x[j] - (j == c ? e : 0);
    }
    return (d[0] * d[0] + d[1] * d[1]) / system->l2[s] - 1;
}

/* sum k l2 [V(E) + theta (E - E_n)^2/2]; V = E^2/2, or with yield strain Y and
 * hardening as above. */
static long double exact_value(const System *system, double theta, bool flows,
                               const double *x_n, const double *x, int c,
                               long double e)
{
    long double sum = 0;
    for (int s = 0; s < system->springs; s++) {
        long double E = strain(system, s, x, c, e);
        long double change = E - strain(system, s, x_n, -1, 0);
        long double over = fmaxl(fabsl(E) - 0.1L, 0);
        sum += (long double)system->k[s] * system->l2[s] *
               (E * E - (flows ? over * over / 1.3L : 0) +
                theta * change * change) /
               2;
    }
    return sum;
}

/* A random place in a step, the springs' term there, a direction p, and the
 * gradient; sizes for tolerances. */
typedef struct Case {
    System system;
    double x_n[MAX_SIZE], x[MAX_SIZE], u[MAX_SIZE], p[MAX_SIZE], g[MAX_SIZE];
    double theta, scale;
    bool flows;
    int size;
    const Term *term;
    Place at;
} Case;

static void make_case(Random *random, bool flows, Case *c)
{
    *c = (Case){.flows = flows};
    System *system = &c->system;
    c->theta = damped_system(random, flows, system, c->x_n, c->x);
    c->size = 2 * system->nodes;
    for (int s = 0; s < system->springs; s++)
        c->scale += system->k[s] * (1 + c->theta) *
                    (1 + system->l2[s] + 1 / system->l2[s]);
    for (int i = 0; i < c->size; i++) {
        c->u[i] = c->x[i] - c->x_n[i];
        c->p[i] = random_uniform(random, -1, 1);
    }
    c->term = &system->term[0];
    c->at = place_at(system, c->x_n, c->u, c->x);
    c->at.term = c->term;
    c->term->kind->gradient(&c->at, c->g);
}

/* Of the springs' terms in a step, elastic and plastic, against differences of
 * the header's formula: their error is e^2, and where flow begins on the way
 * that of the bend. */
TEST(the_gradient_is_that_of_the_formula)
{
    Random random = {5};
    for (int n = 0; n < 200; n++) {
        const long double e = 1e-5L;
        Case c;
        make_case(&random, n % 2, &c);
        for (int i = 0; i < c.size; i++) {
            long double up =
                exact_value(&c.system, c.theta, c.flows, c.x_n, c.x, i, e);
            long double down =
                exact_value(&c.system, c.theta, c.flows, c.x_n, c.x, i, -e);
            CHECK_NEAR(c.g[i], (up - down) / (2 * e),
                       (c.flows ? 1e-5 : 1e-9) * c.scale);
        }
        system_free(&c.system);
    }
}

/* E along p: the exact difference of the formula. */
TEST(the_line_is_exact)
{
    Random random = {8};
    for (int n = 0; n < 200; n++) {
        Case c;
        make_case(&random, n % 2, &c);
        double q[3] = {0}, slope = 0, other[MAX_SIZE];
        double alpha = random_logarithmic(&random, 1e-3, 1);
        for (int i = 0; i < c.size; i++) {
            slope += c.g[i] * c.p[i];
            other[i] = c.x[i] + alpha * c.p[i];
        }
        c.term->kind->along(&c.at, c.p, 1, q);
        double got =
            alpha * (slope + alpha * (q[0] + alpha * (q[1] + alpha * q[2])));
        if (c.term->kind->remainder)
            got += c.term->kind->remainder(&c.at, c.p, alpha);
        CHECK_NEAR(
            got,
            exact_value(&c.system, c.theta, c.flows, c.x_n, other, -1, 0) -
                exact_value(&c.system, c.theta, c.flows, c.x_n, c.x, -1, 0),
            1e-13 * c.scale);
        system_free(&c.system);
    }
}

/* H p is how the gradient changes. */
TEST(the_hessian_is_the_gradients_change)
{
    Random random = {9};
    for (int n = 0; n < 100; n++) {
        Case c;
        double g[2][MAX_SIZE] = {{0}}, Hp[MAX_SIZE] = {0}, x[MAX_SIZE];
        make_case(&random, n % 2, &c);
        const TermKind *kind = c.term->kind;
        kind->hessian(&c.at, FILTER_NONE, NULL, c.p, Hp);
        for (int way = 0; way < 2; way++) {
            for (int i = 0; i < c.size; i++)
                x[i] = c.x[i] + (way ? 1e-6 : -1e-6) * c.p[i];
            c.at.x = x;
            kind->gradient(&c.at, g[way]);
        }
        for (int i = 0; i < c.size; i++)
            CHECK_NEAR(Hp[i], (g[1][i] - g[0][i]) / 2e-6, 1e-8 * c.scale);
        system_free(&c.system);
    }
}

/* What solvers compare with masses and forces: the largest k' and k' l of the
 * step. */
TEST(bounds_are_those_of_the_step)
{
    Random random = {10};
    for (int n = 0; n < 50; n++) {
        Case c;
        double stiffest, force, most[2] = {0, 0};
        make_case(&random, false, &c);
        for (int s = 0; s < c.system.springs; s++) {
            double l2 = c.system.l2[s], k = c.system.k[s];
            double E_n = (double)strain(&c.system, s, c.x_n, -1, 0);
            double mean = l2 * (1 + c.theta * E_n / (1 + c.theta));
            k *= (1 + c.theta) * mean / l2;
            most[0] = fmax(most[0], k);
            most[1] = fmax(most[1], k * sqrt(mean));
        }
        system_bounds(&c.system, &stiffest, &force);
        CHECK(stiffest >= most[0] * (1 - 1e-13));
        CHECK(force >= most[1] * (1 - 1e-13));
        system_free(&c.system);
    }
}

/* Outside of a step the potential is that of the springs alone. */
TEST(the_potential_knows_nothing_of_it)
{
    Random random = {6};
    for (int n = 0; n < 20; n++) {
        System system;
        double x_n[MAX_SIZE], x[MAX_SIZE], g[MAX_SIZE];
        damped_system(&random, n % 2, &system, x_n, x);
        double P = system_potential(&system, x);
        double size = (double)exact_value(&system, 0, n % 2, x_n, x, -1, 0);
        CHECK_NEAR(P, size, 1e-13 * size);
        system_acceleration(&system, x, g);
        double a[MAX_SIZE];
        damping_of(&system)->theta = 0;
        Term *own = system_find_term(&system, &damping);
        damping.begin(own, &system, x, x, INFINITY); /* theta = 0 */
        system_acceleration(&system, x, a);
        CHECK_SAME_BITS(g, a, 2 * system.nodes);
        system_free(&system);
    }
}

/* The square turned and moved as a whole: no spring has another strain, so the
 * gradient in the step is that without damping, however large theta is; and
 * whatever the nodes do, the forces have no sum and no torque. */
TEST(turning_costs_nothing)
{
    Random random = {7};
    for (int n = 0; n < 100; n++) {
        System system;
        double x_n[MAX_SIZE], x[MAX_SIZE], u[MAX_SIZE], g[MAX_SIZE] = {0};
        double plain[MAX_SIZE] = {0}, sum[3] = {0}, size = 0;
        double theta = damped_system(&random, false, &system, x_n, x);
        Term *term = &system.term[0];
        Place at = place_at(&system, x_n, u, x);
        Place undamped = place_at(&system, x, NULL, x);
        at.term = undamped.term = term;
        term->kind->gradient(&at, g);
        for (int i = 0; i < 2 * system.nodes; i++) {
            sum[i % 2] += g[i];
            sum[2] += i % 2 ? x[i - 1] * g[i] : -x[i + 1] * g[i];
            size += fabs(g[i]) * (1 + fabs(x[i]));
        }
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(sum[c], 0, 4e-15 * size);
        double angle = random_uniform(&random, 0, 6.28);
        for (int i = 0; i < 2 * system.nodes; i += 2) {
            x[i] = cos(angle) * x_n[i] - sin(angle) * x_n[i + 1] + 0.3;
            x[i + 1] = sin(angle) * x_n[i] + cos(angle) * x_n[i + 1] - 0.2;
        }
        memset(g, 0, sizeof g);
        term->kind->gradient(&at, g);
        term->kind->gradient(&undamped, plain);
        for (int i = 0; i < 2 * system.nodes; i++)
            CHECK_NEAR(g[i], plain[i], 2e-14 * (1 + theta) * size);
        system_free(&system);
    }
}

/* ---- two masses ---------------------------------------------------------- */

static const double K = 1000, L2 = 1, M = 1, ETA = 0.004;

/* r'' = -(k l2 (E + eta E') 2 r/l2)/(m/2), E = r^2/l2 - 1 */
static double pull_of_pair(double r, double v)
{
    double E = r * r / L2 - 1, rate = 2 * r * v / L2;
    return -K * L2 * (E + ETA * rate) * (2 * r / L2) / (M / 2);
}

/* By the classical Runge-Kutta method. */
static double exact_pair(double r, double v, double time)
{
    const int steps = 20000;
    double h = time / steps;
    for (int i = 0; i < steps; i++) {
        double a1 = pull_of_pair(r, v), v2 = v + h / 2 * a1;
        double a2 = pull_of_pair(r + h / 2 * v, v2), v3 = v + h / 2 * a2;
        double a3 = pull_of_pair(r + h / 2 * v2, v3), v4 = v + h * a3;
        double a4 = pull_of_pair(r + h * v3, v4);
        r += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
        v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return r;
}

static void create_pair(double eta, System *system)
{
    CHECK_STATUS(system_create(2, 1, system), STATUS_OK);
    system->m[0] = system->m[1] = M;
    system->e[1] = 1;
    system->l2[0] = L2;
    system->k[0] = K;
    CHECK_STATUS(damping_add(system, eta), STATUS_OK);
}

/* After 0.1 s, a bit more than one swing, the error is that of the method: half
 * of it with half the step. */
TEST(the_damped_pair_follows_its_equation)
{
    const double time = 0.1, start = 1.2;
    const double x[4] = {-start / 2, 0, start / 2, 0}, v[4] = {0};
    double exact = exact_pair(start, 0, time), error[3];
    for (int n = 0; n < 3; n++) {
        int steps = 10000 << n;
        const NewtonSettings settings = {
            .h = time / steps, .tolerance = 1e-10, .max_iterations = 100};
        System system;
        TimeIntegrator run;
        create_pair(ETA, &system);
        CHECK_STATUS(time_integrator_create(&integrator_methods[0], &system,
                                            &settings, x, v, &run),
                     STATUS_OK);
        for (int i = 0; i < steps; i++)
            CHECK_STATUS(time_integrator_step(&run), STATUS_OK);
        error[n] = run.x[2] - run.x[0] - exact;
        /* the centre stays where it is */
        CHECK_NEAR(run.x[0] + run.x[2], 0, 1e-13);
        time_integrator_free(&run);
        system_free(&system);
    }
    CHECK_AT_MOST(fabs(error[0]), 1e-3 * start);
    CHECK(fabs(error[0]) > 1e-7); /* else the ratios say nothing */
    CHECK_NEAR(error[1] / error[0], 0.5, 0.01);
    CHECK_NEAR(error[2] / error[1], 0.5, 0.01);
    /* and it matters: without damping the pair is elsewhere */
    CHECK(fabs(exact - start * 0.9) > 0.01);
}

/* As the steps get shorter all that is lost is lost by damping. */
TEST(damping_takes_what_is_lost)
{
    double share[2];
    for (int n = 0; n < 2; n++) {
        char line[128];
        Simulation simulation;
        snprintf(line, sizeof line,
                 "square --damping 0.002 --stretch 1.2 --tolerance 1e-8 "
                 "--timestep %g",
                 n ? 2.5e-5 : 1e-4);
        simulation_from_line(line, NULL, NULL, &simulation);
        double start = simulation_energies(&simulation, 0).total;
        for (int i = 0; i < (n ? 1600 : 400); i++)
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        Energies end = simulation_energies(&simulation, 0);
        CHECK(end.total < 0.6 * start && end.dissipated > 0);
        CHECK_NEAR(end.total + OF(&end, damping) + end.dissipated, start,
                   1e-12 * start);
        share[n] = end.dissipated / (start - end.total);
        simulation_free(&simulation);
    }
    CHECK_AT_MOST(share[0], 0.05);
    CHECK_NEAR(share[1] / share[0], 0.25, 0.03); /* O(h) */
}

/* ---- with all the rest --------------------------------------------------- */

/* The hash after so many steps of a command line, all of them converged. */
static uint64_t hash_after(const char *line, int steps)
{
    Simulation simulation;
    simulation_from_line(line, NULL, NULL, &simulation);
    for (int i = 0; i < steps; i++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    uint64_t hash = state_hash(&simulation, STATE_HASH_SEED);
    simulation_free(&simulation);
    return hash;
}

/* A scene that had the term for a while has the bits of one that never did. */
TEST(none_of_it_leaves_the_bits)
{
    static const char *const lines[] = {"square", "dent", "tear",
                                        "hang --segments 40"};
    for (int n = 0; n < 4; n++) {
        Simulation simulation;
        simulation_from_line(lines[n], NULL, NULL, &simulation);
        CHECK(!damping_of(&simulation.system));
        CHECK_STATUS(simulation_set_damping(&simulation, 0.1), STATUS_OK);
        CHECK_STATUS(simulation_set_damping(&simulation, 0), STATUS_OK);
        CHECK(!damping_of(&simulation.system));
        for (int i = 0; i < 30; i++)
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        CHECK(state_hash(&simulation, STATE_HASH_SEED) ==
              hash_after(lines[n], 30));
        CHECK(energy_now(&simulation, 0, "damping") == 0);
        simulation_free(&simulation);
    }
}

/* Springs that could flow, but never do, are the elastic ones. */
TEST(stiff_flow_is_none)
{
    static const char *const lines[] = {
        "square --damping 0.01 --tolerance 1e-10",
        "square --damping 0.01 --tolerance 1e-10 --yield 100"};
    Simulation simulation[2];
    for (int n = 0; n < 2; n++) {
        simulation_from_line(lines[n], NULL, NULL, &simulation[n]);
        for (int i = 0; i < 50; i++)
            CHECK_STATUS(simulation_step(&simulation[n]), STATUS_OK);
    }
    for (int i = 0; i < 2 * simulation[0].system.nodes; i++)
        CHECK_NEAR(simulation[1].run[0].x[i], simulation[0].run[0].x[i], 1e-12);
    CHECK_NEAR(energy_now(&simulation[1], 0, "damping"),
               energy_now(&simulation[0], 0, "damping"), 1e-5);
    for (int n = 0; n < 2; n++)
        simulation_free(&simulation[n]);
}

/* Broken springs have none: their ends part like free points. */
TEST(broken_springs_are_not_damped)
{
    const double x[4] = {-0.5, 0, 0.5, 0}, v[4] = {-30, 0, 30, 0};
    const NewtonSettings settings = {
        .h = 0.001, .tolerance = 1e-9, .max_iterations = 100};
    System system;
    TimeIntegrator run;
    create_pair(0.01, &system);
    CHECK_STATUS(fracture_add(&system, 0.01, 0), STATUS_OK);
    CHECK_STATUS(time_integrator_create(&integrator_methods[0], &system,
                                        &settings, x, v, &run),
                 STATUS_OK);
    for (int i = 0; i < 200 && !spring_is_broken(&system, 0); i++)
        CHECK_STATUS(time_integrator_step(&run), STATUS_OK);
    CHECK(spring_is_broken(&system, 0));
    double lost = system_lost(&system, &damping), speed = run.v[2];
    CHECK(lost > 0 && speed > 0);
    for (int i = 0; i < 5; i++)
        CHECK_STATUS(time_integrator_step(&run), STATUS_OK);
    CHECK_NEAR(run.v[2], speed, 1e-12 * speed);
    CHECK(system_lost(&system, &damping) == lost);
    time_integrator_free(&run);
    system_free(&system);
}

/* Multigrid makes damped steps, and those of springs that break, and ends where
 * Newton does.  Where springs break, rounding hides what iterations change of E
 * from a tolerance of 1e-7 on. */
TEST(multigrid_serves_it)
{
    static const char *const lines[] = {
        "square --segments 40 --damping 0.005 --tolerance 1e-7 --solver %s",
        "hang --segments 40 --damping 0.05 --tolerance 1e-7 --solver %s",
        "square --segments 36 --damping 0.001 --tear 0.5 --stretch 1.26 "
        "--tolerance 5e-7 --solver %s",
        "square --segments 36 --tear 0.5 --stretch 1.26 --tolerance 5e-7 "
        "--solver %s"};
    for (int n = 0; n < 4; n++) {
        Simulation simulation[2];
        for (int k = 0; k < 2; k++) {
            char line[256];
            snprintf(line, sizeof line, lines[n], k ? "multigrid" : "newton");
            simulation_from_line(line, NULL, NULL, &simulation[k]);
            for (int i = 0; i < 8; i++)
                CHECK_STATUS(simulation_step(&simulation[k]), STATUS_OK);
        }
        const Newton *newton = simulation[1].run[0].newton;
        CHECK(newton->working == SOLVER_MULTIGRID && !newton->refusal);
        CHECK(newton->counters.cycles > 0 && newton->counters.taken_back == 0);
        if (n >= 2) {
            const Fracture *breaks = fracture_of(&simulation[1].system);
            CHECK(breaks->broken > 0);
            CHECK(breaks->broken == fracture_of(&simulation[0].system)->broken);
        }
        const Options *options = &simulation[0].options;
        for (int i = 0; i < 2 * simulation[0].system.nodes; i++)
            CHECK_NEAR(simulation[1].run[0].x[i], simulation[0].run[0].x[i],
                       100 * options->tolerance * options->timestep);
        for (int k = 0; k < 2; k++)
            simulation_free(&simulation[k]);
    }
}

/* Contact, flow, fracture, what moves, pins: every step converges, nothing
 * comes back, and the ledger has no hole. */
TEST(every_scene_can_be_damped)
{
    static const char *const lines[] = {
        "drop --damping 0.005",
        "slope --damping 0.01",
        "squeeze --damping 0.02",
        "dent --damping 0.002",
        "tear --damping 0.001",
        "bend --damping 0.0005",
        "hang --damping 0.1",
        "square --damping 1",
        "square --damping 0.01 --filter on-demand",
        "square --damping 0.01 --filter abs"};
    for (int n = 0; n < 10; n++) {
        Simulation simulation;
        simulation_from_line(lines[n], NULL, NULL, &simulation);
        double before = 0, start = simulation_energies(&simulation, 0).total;
        for (int i = 0; i < 120; i++) {
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
            Energies e = simulation_energies(&simulation, 0);
            CHECK(OF(&e, damping) >= before);
            before = OF(&e, damping);
            double size = fabs(start) + fabs(e.total) + fabs(e.work) + before;
            CHECK_NEAR(e.total + OF(&e, plastic) + OF(&e, fracture) +
                           OF(&e, friction) + OF(&e, damping) + e.dissipated -
                           e.work,
                       start, 1e-10 * size);
        }
        CHECK(before > 0);
        simulation_free(&simulation);
    }
}

/* ---- while it runs ------------------------------------------------------- */

static void change(Track *track, const char *text)
{
    char message[256];
    Command command = {.kind = COMMAND_SET};
    snprintf(command.text, sizeof command.text, "%s", text);
    CHECK_STATUS(track_change(track, &command, message, sizeof message),
                 STATUS_OK);
}

static uint64_t hash_of(const Track *track)
{
    return state_hash(&track->simulation, STATE_HASH_SEED);
}

/* mu, eta and a hand change while the run goes on; every step is then reached
 * again with its bits and its ledger, whichever way one comes. */
TEST(live_changes_are_gone_through_again)
{
    enum { STEPS = 120 };
    static const char *const lines[] = {
        "slope", "drop --segments 6 --damping 0.01 --filter clamp",
        "drop --segments 6 --friction 0", "dent --segments 6"};
    for (int n = 0; n < 4; n++) {
        Simulation made;
        Track track;
        uint64_t hash[STEPS + 1];
        double lost[STEPS + 1];
        char message[256];
        simulation_from_line(lines[n], NULL, NULL, &made);
        Options options = made.options;
        simulation_free(&made);
        CHECK_STATUS(track_create(&options, true, NULL, NULL, &track),
                     STATUS_OK);
        hash[0] = hash_of(&track);
        lost[0] = 0;
        for (int i = 1; i <= STEPS; i++) {
            if (i == 20)
                change(&track, "friction 0.7");
            if (i == 30)
                change(&track, "damping 0.02");
            if (i == 35) {
                Command grab = {COMMAND_GRAB, .number = 3, .x = 1, .y = 1};
                CHECK_STATUS(track_change(&track, &grab, message, 256),
                             STATUS_OK);
            }
            if (i == 105)
                change(&track, "stiffness 30000");
            if (i == 110)
                change(&track, "damping 0");
            CHECK(track_step_shown(&track) ==
                  i - 1); /* it did not begin anew */
            Status status = track_step(&track);
            CHECK(!status || status_is_unconverged(status));
            hash[i] = hash_of(&track);
            Energies e = simulation_energies(&track.simulation, 0);
            lost[i] = OF(&e, damping) + OF(&e, friction);
        }
        CHECK(lost[STEPS] > 0 && hash[19] != hash[20] && hash[30] != hash[31]);
        Random random = {(uint64_t)n};
        for (int k = 0; k < (tests_are_long() ? 40 : 8); k++) {
            int step = random_below(&random, STEPS + 1);
            CHECK_STATUS(track_show(&track, step), STATUS_OK);
            CHECK(hash_of(&track) == hash[step]);
            Energies e = simulation_energies(&track.simulation, 0);
            CHECK(OF(&e, damping) + OF(&e, friction) == lost[step]);
        }
        track_free(&track);
    }
}

/* A run that gets mu or eta at its beginning is the one that has it from the
 * command line; long enough to meet what it needs for it. */
TEST(a_live_number_is_the_option)
{
    static const int steps[] = {20, 100, 120, 20, 120};
    static const char *const lines[][3] = {
        {"slope", "friction 0.2", "slope --friction 0.2"},
        {"drop --friction 0", "friction 0.4", "drop --friction 0.4"},
        {"dent", "damping 0.003", "dent --damping 0.003"},
        {"square --damping 1", "damping 0.003", "square --damping 0.003"},
        {"tear", "damping 0.001", "tear --damping 0.001"}};
    for (int n = 0; n < 5; n++) {
        Simulation simulation;
        Track track;
        simulation_from_line(lines[n][0], NULL, NULL, &simulation);
        CHECK_STATUS(
            track_create(&simulation.options, false, NULL, NULL, &track),
            STATUS_OK);
        simulation_free(&simulation);
        change(&track, lines[n][1]);
        simulation_from_line(lines[n][2], NULL, NULL, &simulation);
        for (int i = 0; i < steps[n]; i++) {
            CHECK_STATUS(track_step(&track), STATUS_OK);
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        }
        for (int r = 0; r < simulation.runs; r++)
            CHECK_SAME_BITS(track.simulation.run[r].x, simulation.run[r].x,
                            2 * simulation.system.nodes);
        Energies e = simulation_energies(&track.simulation, 0);
        CHECK((n < 2 ? OF(&e, friction) : OF(&e, damping)) > 0);
        CHECK((OF(&e, fracture) > 0) == (n == 4)); /* after what was damped */
        CHECK(OF(&e, damping) == energy_now(&simulation, 0, "damping"));
        simulation_free(&simulation);
        track_free(&track);
    }
}

/* What goes on with other options has their mu and eta, and what was lost. */
TEST(other_options_are_taken_over)
{
    Simulation simulation;
    simulation_from_line("slope --damping 0.01", NULL, NULL, &simulation);
    for (int i = 0; i < 20; i++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    Energies before = simulation_energies(&simulation, 2), after;
    Options options = simulation.options;
    options.friction = 0.05;
    options.damping = 0.03;
    CHECK_STATUS(simulation_change(&simulation, &options), STATUS_OK);
    after = simulation_energies(&simulation, 2);
    CHECK_NEAR(contact_of(simulation.run[2].system)->obstacle[0].friction,
               1.1 * 0.05, 1e-16);
    CHECK(damping_of(simulation.run[2].system)->eta == 0.03);
    CHECK(OF(&before, friction) > 0 &&
          OF(&after, friction) == OF(&before, friction));
    CHECK(OF(&before, damping) > 0 &&
          OF(&after, damping) == OF(&before, damping));
    CHECK_NEAR(after.dissipated, before.dissipated,
               1e-12 * OF(&before, friction));
    simulation_free(&simulation);
}

/* Only where x_(n+1) is the minimiser is (E - E_n)/h the rate that counts. */
TEST(other_methods_refuse_it)
{
    for (const IntegratorMethod *method = integrator_methods; method->name;
         method++) {
        char name[64], damped[] = "--damping", eta[] = "0.1";
        char program[] = "elasto", option[] = "--integrator", message[512];
        char *arguments[] = {program, damped, eta, option, name, NULL};
        Options options;
        System system;
        snprintf(name, sizeof name, "%s", method->name);
        Status status =
            options_parse(5, arguments, &options, message, sizeof message);
        CHECK_STATUS(status, method->at_end ? STATUS_OK : STATUS_INVALID_INPUT);
        if (status)
            CHECK(strstr(message, "damping") && strstr(message, name));
        create_pair(0.1, &system);
        CHECK(integrator_method_refuses(method, &system) == !method->at_end);
        system_remove_term(&system, &damping);
        CHECK(!integrator_method_refuses(method, &system));
        system_free(&system);
        /* and while it runs */
        if (method->at_end)
            continue;
        CHECK_STATUS(
            options_parse(1, arguments, &options, message, sizeof message),
            STATUS_OK);
        options.integrator = method - integrator_methods;
        CHECK_STATUS(
            options_set(&options, "damping", "0.1", message, sizeof message),
            STATUS_INVALID_INPUT);
    }
}

TESTS(NULL, NULL)
