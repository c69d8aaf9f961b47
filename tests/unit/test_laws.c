/* test_laws.c - whole time steps: orders and conserved quantities of each
 * method (the exact motion is extrapolated from two runs of velocity Verlet),
 * laws of mechanics, and the ledger of energies, with contact, friction, cells,
 * plastic flow, damping, fracture and moving bodies. (Terms at one point:
 * test_terms; feasible iterates: stress.) */
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model/damping.h"
#include "model/fracture.h"
#include "model/elements.h"
#include "model/friction.h"
#include "model/neo_hookean.h"
#include "model/plasticity.h"

static const double G = 9.81;

/* ---- some masses ------------------------------------------------------- */

/* System and run of the current test; create_system frees both first */
static System masses;
static TimeIntegrator run;

/* Creates nodes of 1 kg; spring s (1 J/m^2, 1 m) joins nodes 0 and s + 1. */
static System *create_system(int nodes, int springs)
{
    time_integrator_free(&run);
    system_free(&masses);
    memset(&run, 0, sizeof run);
    CHECK_OK(system_create(nodes, springs, &masses));
    for (int i = 0; i < nodes; i++)
        masses.m[i] = 1;
    for (int s = 0; s < springs; s++) {
        masses.e[2 * s + 1] = s + 1;
        masses.l2[s] = masses.k[s] = 1;
    }
    return &masses;
}

/* Creates a mass above a wall through the origin. */
static void put_mass_on_wall(const double n[2], double friction,
                             double slip_speed, double gravity)
{
    const Obstacle wall = {.kind = OBSTACLE_WALL,
                           .n = {n[0], n[1]},
                           .mu = friction,
                           .ball_node = -1};
    create_system(1, 0)->gravity[1] = -gravity;
    CHECK_OK(contact_configure(&masses, &(Barrier){0.01, 1}, 1, &wall));
    if (friction > 0)
        CHECK_OK(
            friction_configure(&masses, &friction_energy, true, slip_speed));
}

static void begin_free_masses(double h, const double *x, const double *v)
{
    const NewtonSettings settings = {
        .h = h, .tolerance = 1e-11, .max_iterations = 2000};
    time_integrator_free(&run);
    CHECK_OK(time_integrator_create(&integrator_methods[0], &masses, &settings,
                                    x, v, &run));
}

static double get_lost_energy(void)
{
    return masses.losses[0].energy;
}

static void step_masses(void)
{
    CHECK_OK(time_integrator_make_step(&run));
}

/* A belt, an inclined wall with the tangential speed W, carries a block of 1
 * kg. While the block slips, the friction is mu N with N = m g cos(angle), and
 * the belt has the power mu N W, of which mu N (W - speed) becomes heat. */
TEST(a_belt_takes_its_load_along)
{
    const double mu = 0.9, angle = 0.3, W = 10, h = 0.01, still[2] = {0, 0};
    const double n[2] = {-sin(angle), cos(angle)}, N = G * cos(angle);
    const double t[2] = {cos(angle), sin(angle)};
    double speed = 0;
    int slips = 0;
    put_mass_on_wall(n, mu, 1e-4, G);
    get_contact(&masses)->obstacle[0].motion = (ObstacleMotion){
        .phase_count = 1, .phase_end = {1e9}, .v = {{W * t[0], W * t[1]}}};
    begin_free_masses(h, (double[2]){0.005 * n[0], 0.005 * n[1]}, still);
    for (int i = 0; i < 200; i++) {
        double before = speed, done = run.external_work;
        double heat = get_lost_energy();
        step_masses();
        speed = run.v[0] * t[0] + run.v[1] * t[1];
        if (i < 60 || speed > 0.9 * W)
            continue; /* the block still falls onto the belt, or sticks */
        CHECK_NEAR((speed - before) / h, mu * N - G * sin(angle), 1e-6);
        CHECK_NEAR((run.external_work - done) / h, mu * N * W, 1e-5);
        CHECK_NEAR((get_lost_energy() - heat) / h, mu * N * (W - speed), 1e-5);
        slips++;
    }
    CHECK(slips > 30);
    CHECK_NEAR(speed, W, 1e-4);
}

/* Makes a hand push the wall at (-0.1, 0), with normal (1, 0), to (1, 0). */
static Obstacle *add_hand_on_wall(void)
{
    Contact *contact = get_contact(&masses);
    contact->obstacle[0].o[0] = -0.1;
    contact->push =
        (ObstaclePush){.is_held = 1, .target = {1, 0}, .mesh = {.side = 1}};
    return &contact->obstacle[0];
}

/* A hand pushes a wall against a mass at rest: the wall is no faster than 5
 * m/s, passes no mass, and reaches the hand. The work of the hand is the energy
 * of the mass and the loss of backward Euler. A ball moves at once by at most
 * half its radius, so it skips no mass. */
TEST(a_hand_pushes_with_a_bounded_speed)
{
    const double h = 0.01, still[2] = {0, 0}, right[2] = {1, 0};
    put_mass_on_wall(right, 0, 0, 0);
    Obstacle *wall = add_hand_on_wall();
    begin_free_masses(h, still, still);
    for (int i = 0; i < 200; i++) {
        double before = wall->o[0];
        step_masses();
        CHECK(wall->o[0] >= before && wall->o[0] - before <= 5 * h + 1e-12);
        CHECK(run.x[0] > wall->o[0]);
    }
    CHECK_NEAR(wall->o[0], 1, 1e-12);
    CHECK(run.v[0] > 1 && run.external_work >= 0.5 * run.v[0] * run.v[0]);
    get_contact(&masses)->push.is_held = false;
    double work = run.external_work;
    step_masses();
    CHECK(wall->o[0] == 1 && run.external_work == work);
    *wall = (Obstacle){.kind = OBSTACLE_BALL, .radius = 0.2, .v = {0, 40}};
    CHECK_NEAR(push_max_move_fraction(get_contact(&masses), h) * h * 40, 0.1,
               1e-15);
}

/* A pushed wall stops 0.3 d_hat in front of a pinned mass. In front of a free
 * mass that leans on a second wall, the pushed wall stops where the barrier is
 * as strong as the hand, at a gap just below d_hat/10. No step is blocked. */
TEST(a_fixed_body_stops_the_hand)
{
    const double still[2] = {0, 0}, right[2] = {1, 0}, left[2] = {-1, 0};
    put_mass_on_wall(right, 0, 0, 0);
    masses.is_pinned[0] = 1;
    Obstacle *wall = add_hand_on_wall();
    begin_free_masses(0.01, still, still);
    for (int i = 0; i < 100; i++)
        step_masses();
    CHECK(-0.0035 < wall->o[0] && wall->o[0] <= -0.003 && run.x[0] == 0);
    create_system(1, 0);
    Obstacle walls[2] = {{.n = {right[0], 0}, .o = {-0.1, 0}, .ball_node = -1},
                         {.n = {left[0], 0}, .o = {0.05, 0}, .ball_node = -1}};
    CHECK_OK(contact_configure(&masses, &(Barrier){0.01, 1}, 2, walls));
    wall = add_hand_on_wall();
    get_contact(&masses)->push.target[0] = 0.05; /* near target: slow push */
    begin_free_masses(0.01, still, still);
    for (int i = 0; i < 300; i++)
        step_masses();
    double room = 0.05 - wall->o[0];
    CHECK(0.001 < room && room < 0.002);
    CHECK_NEAR(run.x[0], 0.05 - 0.5 * room, 1e-6);
}

/* A pushed ball of 2 cm, which moves 5 cm in a step, takes a mass along. */
TEST(a_ball_that_is_pushed_jumps_over_nothing)
{
    const double still[2] = {0, 0};
    const Obstacle ball = {.kind = OBSTACLE_BALL,
                           .o = {-0.05, 0},
                           .radius = 0.02,
                           .ball_node = -1};
    create_system(1, 0);
    CHECK_OK(contact_configure(&masses, &(Barrier){0.002, 1}, 1, &ball));
    Contact *contact = get_contact(&masses);
    contact->push =
        (ObstaclePush){.is_held = 1, .target = {9, 0}, .mesh = {.side = 1}};
    begin_free_masses(0.01, still, still);
    for (int i = 0; i < 50; i++) {
        step_masses();
        CHECK(run.x[0] - contact->obstacle[0].o[0] > 0.02);
    }
    CHECK(contact->obstacle[0].o[0] > 1);
}

/* A broken spring keeps its plastic strain and no longer damps. */
TEST(broken_springs_neither_flow_nor_damp)
{
    const double x[4] = {0, 0, 3, 0}, far[4] = {0, 0, 30, 0};
    const double apart[4] = {-0.5, 0, 0.5, 0}, v[4] = {-30, 0, 30, 0};
    create_system(2, 1);
    CHECK_OK(plastic_energy.configure(&masses, NULL, (double[]){0.1, 0}));
    const Plasticity *flow = system_term_data(&masses, &plastic_energy);
    plastic_energy.end_step(&(TermStep){&masses, masses.term, x, x, 1});
    CHECK_NEAR(flow->ep[0], 8 - 0.1, 1e-14); /* an unbroken spring flows */
    masses.k[0] = 0;
    unsigned version = masses.version;
    plastic_energy.end_step(&(TermStep){&masses, masses.term, far, far, 1});
    CHECK(masses.version == version);
    CHECK_NEAR(flow->ep[0], 8 - 0.1, 1e-14);
    CHECK_NEAR(flow->kappa[0], 8 - 0.1, 1e-14);

    create_system(2, 1)->k[0] = 1000;
    CHECK_OK(damping.configure(&masses, NULL, &(double){0.01}));
    CHECK_OK(fracture.configure(&masses, NULL, &(double){0.01}));
    begin_free_masses(0.001, apart, v);
    for (int i = 0; i < 200 && !spring_is_broken(&masses, 0); i++)
        step_masses();
    CHECK(spring_is_broken(&masses, 0));
    double damped = get_lost_energy(), speed = run.v[2];
    CHECK(damped > 0 && speed > 0);
    for (int i = 0; i < 5; i++)
        step_masses();
    CHECK_NEAR(run.v[2], speed, 1e-12 * speed);
    CHECK(get_lost_energy() == damped);
}

/* ---- whole scenes ------------------------------------------------------ */

/* Upper limits for the nodes and springs of the scenes in this file */
enum { NODE_LIMIT = 1024, SPRING_LIMIT = 8 * NODE_LIMIT };

/* Returns the work of moving walls in the last step, J. */
static double find_wall_work(const System *system, const double *x, double h)
{
    const Contact *contact = get_contact(system);
    double sum = 0;
    for (int k = 0; contact && k < contact->obstacle_count; k++) {
        const Obstacle *wall = &contact->obstacle[k];
        double distance =
            (wall->n[0] * wall->v[0] + wall->n[1] * wall->v[1]) * h;
        for (int i = 0; distance != 0 && i < system->nodes; i++) {
            double s = (wall->n[0] * (x[2 * i] - wall->o[0]) +
                        wall->n[1] * (x[2 * i + 1] - wall->o[1])) /
                       contact->barrier.d_hat;
            if (s < 1)
                sum -= contact->barrier.c / contact->barrier.d_hat *
                       (log(s) + 1 - 1 / s) * distance;
        }
    }
    return sum;
}

/* Returns the energy that a step from x_n, v_n dissipates, J, without friction:
 * the sum of |v_n+1 - v_n|_M^2/2, the work of walls, and the difference between
 * the potential and its tangent at the end.
 *   k  [springs] stiffnesses before the step, which the forces are made with
 *   P  J, potential at the start */
static double find_dissipation(const TimeIntegrator *it, double *k,
                               const double *x_n, const double *v_n, Real P)
{
    System whole = *it->system;
    static double dx[2 * NODE_LIMIT];
    whole.k = k;
    Real sum = P + find_wall_work(&whole, it->x, it->h);
    for (int c = 0; c < 2 * whole.nodes; c++) {
        double dv = it->v[c] - v_n[c];
        dx[c] = it->x[c] - x_n[c];
        sum += 0.5 * whole.m[c / 2] * dv * dv;
    }
    EvalPoint at = make_eval_point(&whole, x_n, NULL, it->x);
    Probe probe = {.at = &at, .h = it->h, .p = dx};
    sum -= oracle_energy(&probe, NULL).f;
    at.u = dx; /* with u the energy includes damping and friction */
    sum += oracle_energy(&probe, NULL).p;
    /* friction books its own loss */
    if (system_find_term(&whole, &friction_energy))
        sum -= oracle_energy(&probe, &friction_energy).p;
    return (double)sum;
}

/* The ledger's dissipated energy is the sum of the oracle's over all steps. */
TEST(the_ledger_adds_up)
{
    static const char *const lines[] = {"slope",
                                        "dent --segments 8 --damping 0.003",
                                        "tear --segments 8",
                                        "squeeze --segments 6 --damping 0.01",
                                        "bend",
                                        "drop",
                                        "squeeze",
                                        "dent"};
    static double x[2 * NODE_LIMIT], v[2 * NODE_LIMIT], k[SPRING_LIMIT];
    for (int i = 0; i < 8; i++) {
        Simulation *scene = simulate("%s --tolerance 1e-8", lines[i]);
        double sum[SIMULATION_MAX_RUNS] = {0}, most = 0;
        CHECK(scene->system.nodes <= NODE_LIMIT &&
              scene->system.springs <= SPRING_LIMIT);
        for (int n = 0; n < 110; n++)
            for (int r = 0; r < scene->runs; r++) {
                TimeIntegrator *it = &scene->run[r];
                Energies start = simulation_get_energies(scene, r);
                Real P = exact_potential(it->system, it->x);
                memcpy(x, it->x, it->x_length * sizeof *x);
                memcpy(v, it->v, it->x_length * sizeof *v);
                memcpy(k, it->system->k,
                       (size_t)it->system->springs * sizeof *k);
                CHECK_OK(time_integrator_make_step(it));
                Energies end = simulation_get_energies(scene, r);
                double stored = ENERGY(&end, elastic) + ENERGY(&end, contact);
                CHECK_NEAR(stored, exact_potential(it->system, it->x),
                           1e-12 * (most + stored + 1));
                CHECK_NEAR(end.total, end.kinetic + end.gravity + stored,
                           1e-12 * (most + stored + 1));
                sum[r] += find_dissipation(it, k, x, v, P) -
                          (ENERGY(&end, plastic) - ENERGY(&start, plastic)) -
                          (ENERGY(&end, damping) - ENERGY(&start, damping));
                most = fmax(most, fabs(end.dissipated) + fabs(end.total) +
                                      fabs(end.work) + end.kinetic);
            }
        for (int r = 0; r < scene->runs; r++)
            CHECK_NEAR(simulation_get_energies(scene, r).dissipated, sum[r],
                       2e-6 * most);
    }
}

/* Damping books the lost energy, apart from a share of O(h). */
TEST(damping_books_the_energy_that_it_takes)
{
    double share[2];
    for (int fine = 0; fine < 2; fine++) {
        Simulation *square =
            simulate("--damping 0.002 --stretch 1.2 --tolerance 1e-8 "
                     "--timestep %g",
                     fine ? 2.5e-5 : 1e-4);
        double start = simulation_get_energies(square, 0).total;
        make_steps(square, fine ? 1600 : 400);
        Energies end = simulation_get_energies(square, 0);
        CHECK(end.total < 0.6 * start && end.dissipated > 0);
        share[fine] = end.dissipated / (start - end.total);
    }
    CHECK_AT_MOST(share[0], 0.05);
    CHECK_NEAR(share[1] / share[0], 0.25, 0.03); /* O(h) */
}

/* Springs that a step breaks were overstretched and share no node; the booked
 * energy is that of these springs and their cells. Overstretched springs that
 * did not break share a node with a broken one of larger load. */
TEST(breaking_books_its_energy)
{
    static double k[SPRING_LIMIT], load[SPRING_LIMIT], most[NODE_LIMIT];
    Simulation *scene = simulate("tear");
    System *system = &scene->system;
    int broken = 0;
    CHECK(system->nodes <= NODE_LIMIT && system->springs <= SPRING_LIMIT);
    for (int n = 0; n < 120; n++) {
        double lost = get_run_energy(scene, 0, "fracture");
        const double *x = scene->run[0].x;
        memcpy(k, system->k, (size_t)system->springs * sizeof *k);
        memset(most, 0, sizeof most);
        make_steps(scene, 1);
        for (int s = 0; s < system->springs; s++) {
            Random random = {(uint64_t)s * 0x9e3779b97f4a7c15u};
            double strength = 0.12 * (1 + 0.1 * random_uniform(&random, -1, 1));
            load[s] = (double)exact_strain(system, x, s) / strength;
            if (k[s] == 0 || system->k[s] > 0)
                continue;
            double *end[2] = {most + system->e[2 * s],
                              most + system->e[2 * s + 1]};
            CHECK(load[s] > 1 && *end[0] == 0 && *end[1] == 0);
            *end[0] = *end[1] = load[s];
            broken++;
        }
        for (int s = 0; s < system->springs; s++)
            CHECK(system->k[s] == 0 || load[s] <= 1 ||
                  load[s] * (1 - 1e-12) <=
                      fmax(most[system->e[2 * s]], most[system->e[2 * s + 1]]));
        System whole = *system;
        whole.k = k;
        CHECK_NEAR(get_run_energy(scene, 0, "fracture") - lost,
                   exact_potential(&whole, x) - exact_potential(system, x),
                   1e-10 * (1 + get_run_energy(scene, 0, "elastic")));
    }
    CHECK(broken > 30);
}

/* ---- laws of a scene --------------------------------------------------- */

/* A ceiling of 50 m/s moves in parts, each from a feasible point. A ceiling
 * that would crush the square is stopped, and the step is called blocked. */
TEST(a_fast_ceiling_comes_in_parts)
{
    Simulation *scene = simulate("squeeze --segments 8 --gravity 0");
    TimeIntegrator *it = &scene->run[0];
    Obstacle *ceiling = &get_contact(it->system)->obstacle[1];
    ceiling->motion = (ObstacleMotion){
        .phase_count = 2, .phase_end = {0.01, 10}, .v = {{0, -50}, {0, -60}}};
    make_steps(scene, 1);
    CHECK_NEAR(ceiling->o[1], 0.51 - 0.5, 1e-12);
    CHECK(it->motion_parts_made > 1);
    CHECK_NEAR(it->moved_fraction, 1, 1e-15);
    CHECK_STATUS(simulation_step(scene), STATUS_BLOCKED);
    CHECK(ceiling->o[1] > -0.51 && it->moved_fraction < 1);
    CHECK(find_smallest_gap(it->system, it->x) > 0);
}

/* A wall throws, catches and lowers a mass. In a convex potential each step of
 * backward Euler dissipates, with the wall's work by the force at the end. */
TEST(a_moving_wall_never_gives_back_what_is_dissipated)
{
    static const double up[2] = {0, 1}, x[2] = {0, 0.008}, v[2] = {0};
    static const double h[] = {1e-4, 1e-3, 0.01};
    for (int k = 0; k < 3; k++) {
        put_mass_on_wall(up, 0, 0, G);
        get_contact(&masses)->obstacle[0].motion =
            (ObstacleMotion){.phase_count = 3,
                             .phase_end = {0.2, 0.3, 0.8},
                             .v = {{0, 0.5}, {0, -3}, {0, 1}}};
        begin_free_masses(h[k], x, v);
        double before = 0, start = 0, most = 0;
        for (int step = 0; step < 1 / h[k]; step++) {
            double held = system_kinetic_energy(&masses, run.v) +
                          system_potential(&masses, run.x) +
                          system_gravity_potential(&masses, run.x) -
                          run.external_work;
            start = step == 0 ? held : start;
            CHECK(start - held >= before - 1e-12);
            before = start - held;
            most = fmax(most, run.external_work);
            CHECK_OK(time_integrator_make_step(&run));
        }
        CHECK(before > 1e-3 && most > 0.1);
    }
}

/* A method of the table with one of its solvers */
typedef struct MethodVariant {
    const IntegratorMethod *method;
    Solver solver;
} MethodVariant;

static bool find_next_method_variant(MethodVariant *variant)
{
    if (!variant->method)
        variant->method = integrator_methods;
    else if (variant->method->stages > 0 && variant->solver + 1 < SOLVER_COUNT)
        variant->solver++;
    else
        *variant = (MethodVariant){.method = variant->method + 1};
    return variant->method->name != NULL;
}

static Simulation *start_variant(const MethodVariant *variant, const char *line)
{
    return simulate("%s --integrator %s --solver %s", line,
                    variant->method->name, get_solver_name(variant->solver));
}

/* ---- orders ------------------------------------------------------------ */

/* Duration of the runs, s; nodes move by about a tenth of the side */
static const double TIME = 0.064;

static Simulation *start_moving_square(const MethodVariant *variant, int steps)
{
    char line[120];
    Random random = {90};
    snprintf(line, sizeof line,
             "--segments 2 --stretch 1.1 --gravity 9.81 --tolerance 1e-13 "
             "--timestep %.17g",
             TIME / steps);
    Simulation *square = start_variant(variant, line);
    for (size_t i = 0; i < square->run[0].x_length; i++)
        square->run[0].v[i] += random_uniform(&random, -1, 1);
    return square;
}

/* Halving h divides the error of a falling square by 2^order; steps are so
 * small that the next term of the error changes the order by less than 0.05. */
TEST(methods_have_the_order_of_their_table)
{
    enum { STEPS = 16384 };
    const MethodVariant verlet = {integrator_find_method("verlet"),
                                  SOLVER_NEWTON};
    const TimeIntegrator *start = &start_moving_square(&verlet, STEPS)->run[0];
    Simulation *far = make_steps(start_moving_square(&verlet, STEPS), STEPS);
    Simulation *near =
        make_steps(start_moving_square(&verlet, 2 * STEPS), 2 * STEPS);
    double fallen = 0; /* springs do not move the centre of mass */
    for (int i = 1; i < 2 * 9; i += 2)
        fallen += (far->run[0].x[i] - start->x[i] - TIME * start->v[i]) / 9;
    CHECK_NEAR(fallen, -9.81 / 2 * TIME * TIME, 1e-12);
    for (MethodVariant variant = {0}; find_next_method_variant(&variant);) {
        int order = variant.method->order;
        int steps = order == 1 ? 2048 : 256;
        double last = 0;
        for (int k = 0; k < 3; k++, steps *= 2) {
            Simulation *square =
                make_steps(start_moving_square(&variant, steps), steps);
            double error = 0;
            for (size_t i = 0; i < square->run[0].x_length; i++)
                error =
                    fmax(error,
                         fabs(square->run[0].x[i] -
                              (4 * near->run[0].x[i] - far->run[0].x[i]) / 3));
            if (k > 0)
                CHECK_NEAR(log2(last / error), order, 0.05);
            last = error;
        }
    }
}

/* ---- what is conserved ------------------------------------------------- */

/* Linear and angular momentum, with the sums of absolute values */
typedef struct Momentum {
    long double linear[2], angular, linear_abs_sum, angular_abs_sum;
} Momentum;

static Momentum find_momentum(const TimeIntegrator *run)
{
    Momentum sum = {{0, 0}, 0, 0, 0};
    for (int i = 0; i < run->system->nodes; i++) {
        long double m = run->system->m[i];
        const double *x = run->x + 2 * i, *v = run->v + 2 * i;
        sum.linear[0] += m * v[0];
        sum.linear[1] += m * v[1];
        sum.angular +=
            m * ((long double)x[0] * v[1] - (long double)x[1] * v[0]);
        sum.linear_abs_sum += m * hypotl(v[0], v[1]);
        sum.angular_abs_sum += m * hypotl(x[0], x[1]) * hypotl(v[0], v[1]);
    }
    return sum;
}

/* Makes 40 steps with rotation, drift and noise, and checks the momentum;
 * angular: tolerance of the angular momentum, <= 0: it may change. */
static void check_momentum(Simulation *square, double angular)
{
    Random random = {91};
    TimeIntegrator *run = &square->run[0];
    for (size_t i = 0; i < run->x_length; i++)
        run->v[i] =
            (i % 2 ? 5 : -5) * run->x[i ^ 1] + random_uniform(&random, -1, 3);
    Momentum start = find_momentum(run);
    for (int step = 0; step < 40; step++) {
        Momentum now = find_momentum(&make_steps(square, 1)->run[0]);
        for (int c = 0; c < 2; c++)
            CHECK_NEAR(now.linear[c], start.linear[c],
                       4e-13 * start.linear_abs_sum);
        if (angular > 0)
            CHECK_NEAR(now.angular, start.angular,
                       angular * start.angular_abs_sum);
    }
}

/* All methods keep linear momentum, however far from the minimum they stop. The
 * symplectic explicit methods keep angular momentum exactly, midpoint to the
 * tolerance of Newton's method. */
TEST(momentum_is_kept)
{
    for (MethodVariant variant = {0}; find_next_method_variant(&variant);) {
        bool midpoint = strcmp(variant.method->name, "midpoint") == 0;
        bool symplectic = strcmp(variant.method->name, "verlet") == 0 ||
                          strcmp(variant.method->name, "symplectic-euler") == 0;
        check_momentum(start_variant(&variant, "--timestep 1e-3"),
                       symplectic ? 4e-13 : 0);
        if (variant.method->stages > 0)
            check_momentum(
                start_variant(&variant, "--stretch 0.6 --timestep 0.01"), 0);
        if (midpoint)
            check_momentum(start_variant(&variant, "--tolerance 1e-12"), 1e-11);
    }
}

/* The forces of triangles have no torque on a body that is turned, strained or
 * far away. The torque by rounding is in proportion to the triangles' forces; a
 * body without strain has none, however stiff. */
TEST(triangles_have_no_torque)
{
    static const double away[] = {0, 1, 1e3, 1e6};
    static const double strain[] = {0, 1e-15, 1e-12, 1e-6, 0.01, 0.3};
    Random random = {5};
    for (int k = 0; k < 11 * 4 * 6; k++) {
        Simulation *body =
            simulate("square --segments 3 --material "
                     "neo-hookean --stretch 1 --young 1e%d --turn "
                     "%d",
                     3 + k % 11, 37 * k);
        const System *system = &body->system;
        double *x = body->run[0].x, g[32] = {0};
        for (int i = 0; i < 32; i++)
            x[i] = away[k / 11 % 4] + x[i] +
                   strain[k / 44] / 3 * random_uniform(&random, -1, 1);
        EvalPoint at = make_eval_point(system, NULL, NULL, x);
        at.term = system_find_term(system, &neo_hookean_energy);
        Real torque = 0, size = 0;
        double own[4];
        for (ElementIterator walk = elements_begin(&at, NULL, 0);
             elements_next(&walk);) {
            const double *e = walk.element.v;
            walk.kind->gradient(&at, &walk.element, own);
            size += hypot(e[0], e[1]) * hypot(own[0], own[1]) +
                    hypot(e[2], e[3]) * hypot(own[2], own[3]);
        }
        elements_gradient(&at, g);
        for (int i = 2; i < 32; i += 2)
            torque +=
                ((Real)x[i] - x[0]) * g[i + 1] - ((Real)x[i + 1] - x[1]) * g[i];
        /* lever arms are up to four segments long */
        CHECK_NEAR(torque, 0, 8 * DBL_EPSILON * size);
        free_simulations();
    }
}

/* A free body keeps its velocity with every time step, and far from the origin,
 * where rounding of x + h v strains the springs a little. */
TEST(free_flight_is_straight)
{
    for (int i = 0; i < 26; i++) {
        double h = pow(10, i / 2 - 9), far = i % 2 ? 1e6 : 0, off = 0;
        double strain = (far + 10 * h) * DBL_EPSILON;
        Simulation *square =
            simulate("--segments 3 --stretch 1 --tolerance 1e-10 --timestep %g "
                     "--at %g,%g --velocity 3,-2",
                     h, far, far);
        for (int s = 0; s < square->system.springs; s++)
            square->system.l2[s] *=
                1 + (double)exact_strain(&square->system, square->run[0].x, s);
        make_steps(square, 3);
        for (int c = 0; c < 2 * 16; c++)
            off = fmax(off, fabs(square->run[0].v[c] - (c % 2 ? -2 : 3)));
        CHECK_AT_MOST(off, 1e-10 + 1e4 * fmin(strain * h, strain / h));
    }
}

/* ---- the table --------------------------------------------------------- */

/* After a step that overflowed, Verlet computes the acceleration again, instead
 * of reusing that of a state which was never accepted. */
TEST(a_failed_step_is_not_remembered)
{
    Simulation *pair[2];
    for (int i = 0; i < 2; i++) {
        pair[i] =
            make_steps(simulate("--integrator verlet --timestep 1e-3"), 1);
        double *v = pair[i]->run[0].v, kept = v[0];
        v[0] = i ? 1e300 : v[0];
        if (i)
            CHECK_STATUS(simulation_step(pair[i]), STATUS_NOT_FINITE);
        v[0] = kept;
        make_steps(pair[i], 1);
    }
    CHECK_SAME_BITS(pair[0]->run[0].x, pair[1]->run[0].x, 2 * 25);
    CHECK_SAME_BITS(pair[0]->run[0].v, pair[1]->run[0].v, 2 * 25);
}

TESTS(NULL, NULL)
