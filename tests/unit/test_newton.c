/* Newton's method: every way in which it can end, and that its records and
 * counters say what happened, by formulas that share nothing with it.
 */
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Squares of up to 4 segments; most have 3. */
enum { LARGEST = 2 * 25, SIZE = 2 * 16 };

/* max over nodes |p_x| + |p_y|, over h, of p = -H^-1 grad E. */
static double exact_residual(const IncrementalPotential *E, const double *u,
                             const double *x, bool clamp, double h)
{
    int size = 2 * E->system->nodes;
    long double H[LARGEST * LARGEST], p[LARGEST], largest = 0;
    exact_derivatives(E, u, x, p, NULL);
    exact_hessian(E, x, clamp, H);
    CHECK(dense_solve(size, H, p));
    for (int i = 0; i < size; i += 2)
        largest = fmaxl(largest, fabsl(p[i]) + fabsl(p[i + 1]));
    return (double)(largest / h);
}

/* Springs shorter than at rest. */
static int short_springs(const System *system, const double *x)
{
    int count = 0;
    for (int s = 0; s < system->springs; s++) {
        int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
        double dx = x[i] - x[j], dy = x[i + 1] - x[j + 1];
        count += dx * dx + dy * dy < system->l2[s];
    }
    return count;
}

/* Follows a run from record to record. */
typedef struct Witness {
    Simulation *simulation;
    double u[LARGEST], x[LARGEST]; /* the last iterate */
    int iteration;
    long iterations, trials, projected, records;
    double worst_residual; /* relative error of the records */
    double worst_change;   /* of E, over E */
    bool good;
} Witness;

/* Before each step: the iterate is the state. */
static void witness_start(Witness *witness)
{
    const TimeIntegrator *run = &witness->simulation->run[0];
    size_t bytes = 2 * (size_t)run->system->nodes * sizeof(double);
    memset(witness->u, 0, bytes);
    memcpy(witness->x, run->x, bytes);
    witness->iteration = 0;
    witness->good = true;
}

static bool witness_record(void *user, const NewtonRecord *record)
{
    Witness *witness = user;
    if (record->iteration < 0)
        return true;
    const Newton *newton = witness->simulation->run[0].newton;
    const IncrementalPotential *E = &newton->at.E;
    bool clamp = newton->settings.filter == FILTER_CLAMP;
    double residual =
        exact_residual(E, witness->u, witness->x, clamp, newton->settings.h);
    long double before = exact_energy(E, witness->u, witness->x);
    long double after = exact_energy(E, newton->at.u, newton->at.x);
    witness->worst_residual =
        fmax(witness->worst_residual, fabs(record->residual / residual - 1));
    double change = (double)fabsl(record->change - (after - before));
    witness->worst_change =
        fmax(witness->worst_change, change / (double)before);
    witness->good =
        witness->good && record->kind == RESIDUAL_VALUE && record->slope < 0 &&
        record->change <= 0 && after <= before &&
        record->iteration == witness->iteration &&
        record->step == witness->simulation->steps + 1 && record->factorised &&
        record->seconds >= 0 && record->alpha == ldexp(1, 1 - record->trials) &&
        record->projected == (clamp ? short_springs(E->system, witness->x) : 0);
    size_t bytes = 2 * (size_t)E->system->nodes * sizeof(double);
    memcpy(witness->u, newton->at.u, bytes);
    memcpy(witness->x, newton->at.x, bytes);
    witness->iteration++;
    witness->iterations++;
    witness->records++;
    witness->trials += record->trials;
    witness->projected += record->projected;
    return true;
}

/* Steps of one command line, each iteration watched.  1e-10: the condition of
 * H, some thousand, times rounding; 5e-13 of E: the rounding of g, along p. */
static void check_run(const char *line, int steps)
{
    Simulation simulation;
    Witness witness = {.simulation = &simulation};
    simulation_from_line(line, witness_record, &witness, &simulation);
    for (int step = 0; step < steps; step++) {
        witness_start(&witness);
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        CHECK(witness.good);
    }
    NewtonCounters counters = simulation_counters(&simulation);
    CHECK(witness.records > 0);
    CHECK_AT_MOST(witness.worst_residual, 1e-10);
    CHECK_AT_MOST(witness.worst_change, 5e-13);
    CHECK(counters.minimisations == steps);
    CHECK(counters.iterations == witness.iterations);
    CHECK(counters.trials == witness.trials);
    CHECK(counters.projected >= witness.projected);
    CHECK(counters.gradients == counters.minimisations + counters.iterations);
    /* Each direction has a factor, unless its test was passed without. */
    long factored = counters.gradients - counters.skipped;
    CHECK(counters.factorisations >= factored);
    CHECK(counters.solves >= factored);
    CHECK(simulation.steps == steps && simulation.unconverged == 0);
    simulation_free(&simulation);
}

TEST(records_are_right)
{
    check_run("--segments 3", 15);
    check_run("--segments 2 --side 3 --density 20 --stiffness 7e3", 15);
}

TEST(records_are_right_where_springs_are_compressed)
{
    check_run("--segments 3 --stretch 0.5 --timestep 0.02", 15);
    check_run("--segments 3 --stretch 0.05 --timestep 0.1 --tolerance 1e-3", 8);
}

TEST(records_are_right_without_projection)
{
    check_run("--segments 3 --filter none", 15);
}

/* A residual that is called a value is that of the exact direction, an estimate
 * is as near to it as to the tolerance, which it decides, and a bound is above
 * it.  The lines end their steps in all three ways. */
TEST(residuals_are_what_they_are_called)
{
    static const char *const lines[] = {
        "--segments 3 --tolerance 0.1", "--segments 3 --tolerance 1e-5",
        "--segments 3 --stretch 1.0001 --tolerance 1e-3",
        "--segments 4 --solver multigrid --tolerance 1e-3",
        "--segments 4 --solver multigrid --stretch 1.001"};
    int seen[2][3] = {{0}};
    for (int line = 0; line < 5; line++) {
        Simulation simulation;
        simulation_from_line(lines[line], NULL, NULL, &simulation);
        TimeIntegrator *run = &simulation.run[0];
        const Newton *newton = run->newton;
        double tolerance = simulation.options.tolerance;
        for (int step = 0; step < 60; step++) {
            double x_n[LARGEST];
            memcpy(x_n, run->x, 2 * (size_t)run->system->nodes * sizeof *x_n);
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
            IncrementalPotential E = newton->at.E;
            E.x_n = x_n;
            double residual = newton->residual;
            double exact =
                exact_residual(&E, newton->at.u, newton->at.x, true, run->h);
            seen[newton->working == SOLVER_MULTIGRID][newton->kind]++;
            if (newton->kind == RESIDUAL_VALUE)
                CHECK_NEAR(residual, exact, 1e-9 * exact);
            else if (newton->kind == RESIDUAL_ESTIMATE)
                CHECK_NEAR(residual, exact, tolerance - residual);
            else
                CHECK_AT_MOST(exact, residual);
        }
        simulation_free(&simulation);
    }
    CHECK(seen[0][RESIDUAL_VALUE] > 20 && seen[0][RESIDUAL_ESTIMATE] == 0 &&
          seen[0][RESIDUAL_BOUND] > 20);
    CHECK(seen[1][RESIDUAL_VALUE] == 0 && seen[1][RESIDUAL_ESTIMATE] > 20 &&
          seen[1][RESIDUAL_BOUND] > 0);
}

/* Where the bound on |p| ended the loop, p itself must pass the test, and be
 * below the bound. */
TEST(bound_implies_the_test)
{
    const char *lines[] = {"--segments 3 --tolerance 0.1",
                           "--segments 3 --tolerance 1e-3 --stretch 0.6",
                           "--segments 2 --tolerance 3 --stretch 2"};
    for (int line = 0; line < 3; line++) {
        Simulation simulation;
        long skipped = 0;
        simulation_from_line(lines[line], NULL, NULL, &simulation);
        TimeIntegrator *run = &simulation.run[0];
        const Newton *newton = run->newton;
        for (int step = 0; step < 20; step++) {
            double x_n[SIZE];
            memcpy(x_n, run->x, 2 * (size_t)run->system->nodes * sizeof *x_n);
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
            IncrementalPotential E = newton->at.E;
            E.x_n = x_n;
            double residual =
                exact_residual(&E, newton->at.u, newton->at.x, true, run->h);
            CHECK_AT_MOST(residual, newton->settings.tolerance);
            if (newton->counters.skipped > skipped)
                CHECK_AT_MOST(residual, newton->residual);
            skipped = newton->counters.skipped;
        }
        CHECK(skipped > 0);
        simulation_free(&simulation);
    }
}

/* One gradient a step, and nothing else, not even a matrix. */
TEST(rest_costs_one_gradient)
{
    Simulation simulation;
    double x[SIZE];
    simulation_from_line("--segments 3 --stretch 1", NULL, NULL, &simulation);
    TimeIntegrator *run = &simulation.run[0];
    memcpy(x, run->x, sizeof x);
    for (int step = 0; step < 5; step++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    NewtonCounters counters = simulation_counters(&simulation);
    CHECK(counters.gradients == 5 && counters.skipped == 5);
    CHECK(counters.iterations == 0 && counters.factorisations == 0);
    CHECK(counters.solves == 0 && counters.trials == 0);
    CHECK(run->newton->search.cholesky == NULL);
    CHECK_SAME_BITS(run->x, x, SIZE);
    for (int i = 0; i < SIZE; i++)
        CHECK(run->v[i] == 0);
    simulation_free(&simulation);
}

TEST(pieces_are_the_whole)
{
    Simulation simulation;
    simulation_from_line("--segments 3 --stretch 0.4 --timestep 0.02", NULL,
                         NULL, &simulation);
    Newton *whole = simulation.run[0].newton, pieces;
    const double *x_n = simulation.run[0].x;
    double h = whole->settings.h;
    CHECK_STATUS(newton_create(&simulation.system, &whole->settings, &pieces),
                 STATUS_OK);
    CHECK_STATUS(newton_minimise(whole, x_n, NULL, h * h), STATUS_OK);
    CHECK_STATUS(newton_start(&pieces, x_n, NULL, h * h), STATUS_RUNNING);
    int iterations = 1;
    while (newton_iterate(&pieces) == STATUS_RUNNING)
        iterations++;
    CHECK_STATUS(newton_iterate(&pieces), STATUS_OK); /* stays at its end */
    newton_finish(&pieces);
    CHECK(iterations > 1 && iterations == whole->counters.iterations);
    CHECK(iterations == pieces.counters.iterations);
    CHECK_SAME_BITS(pieces.at.u, whole->at.u, SIZE);
    CHECK_SAME_BITS(pieces.at.x, whole->at.x, SIZE);
    newton_free(&pieces);
    newton_free(NULL);
    simulation_free(&simulation);
}

/* Keys may change both at any time: the next step obeys. */
TEST(settings_change_while_running)
{
    Simulation simulation;
    simulation_from_line("--segments 3", NULL, NULL, &simulation);
    const Newton *newton = simulation.run[0].newton;
    for (int round = 0; round < 3; round++) {
        simulation_set_filter(&simulation, FILTER_CLAMP);
        simulation_set_line_search(&simulation, LINE_SEARCH_BACKTRACK);
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        CHECK(newton->search.kind == CHOLESKY_DEFINITE);
        CHECK(newton->record.trials > 0);
        simulation_set_filter(&simulation, FILTER_NONE);
        simulation_set_line_search(&simulation, LINE_SEARCH_NONE);
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        CHECK(newton->search.kind == CHOLESKY_INDEFINITE);
        CHECK(newton->record.trials == 0 && newton->record.alpha == 1);
        CHECK(newton->record.projected == 0);
    }
    simulation_free(&simulation);
}

TEST(large_matrices_use_blocks)
{
    Simulation simulation;
    simulation_from_line("--segments 24", NULL, NULL, &simulation);
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK(simulation.run[0].newton->search.kind == CHOLESKY_DEFINITE);
    simulation_free(&simulation);
}

/* A step that ends like this is made all the same: the state is finite and
 * E is not higher than at the start. */
static void check_unconverged_step(Simulation *simulation, Status expected)
{
    TimeIntegrator *run = &simulation->run[0];
    int size = 2 * run->system->nodes;
    double x_n[LARGEST], zero[LARGEST] = {0};
    memcpy(x_n, run->x, (size_t)size * sizeof *x_n);
    long steps = simulation->steps, unconverged = simulation->unconverged;
    CHECK_STATUS(simulation_step(simulation), expected);
    IncrementalPotential E = run->newton->at.E;
    E.x_n = x_n;
    CHECK_AT_MOST(exact_energy(&E, run->newton->at.u, run->x),
                  exact_energy(&E, zero, x_n));
    for (int i = 0; i < size; i++)
        CHECK(isfinite(run->x[i]) && isfinite(run->v[i]));
    CHECK(simulation->steps == steps + 1 && run->steps == steps + 1);
    CHECK(simulation->unconverged == unconverged + 1);
    CHECK(status_is_unconverged(expected));
}

TEST(iteration_limit_is_reached)
{
    Simulation simulation;
    simulation_from_line("--segments 3", NULL, NULL, &simulation);
    simulation.run[0].newton->settings.max_iterations = 1;
    check_unconverged_step(&simulation, STATUS_ITERATION_LIMIT);
    CHECK(simulation.run[0].newton->counters.iterations == 1);
    simulation_free(&simulation);
}

/* Without projection some directions point uphill. */
TEST(ascent_is_reported)
{
    Simulation simulation;
    simulation_from_line("--filter none --timestep 0.02 --stretch 0.5", NULL,
                         NULL, &simulation);
    check_unconverged_step(&simulation, STATUS_NOT_DESCENT);
    CHECK(simulation.run[0].newton->record.slope > 0);
    simulation_free(&simulation);
}

TEST(rounding_limit_is_reached)
{
    Simulation simulation;
    simulation_from_line("--segments 3 --tolerance 1e-30", NULL, NULL,
                         &simulation);
    for (int step = 0; step < 5; step++)
        check_unconverged_step(&simulation, STATUS_ROUNDING_LIMIT);
    CHECK_AT_MOST(simulation_counters(&simulation).iterations, 250);
    simulation_free(&simulation);
}

/* All nodes in one point: a maximum of P, where its gradient is 0. */
TEST(maximum_is_not_taken_for_a_minimum)
{
    Simulation simulation;
    simulation_from_line("--segments 3 --timestep 0.1", NULL, NULL,
                         &simulation);
    memset(simulation.run[0].x, 0, SIZE * sizeof(double));
    double maximum = simulation_energies(&simulation, 0).total;
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK); /* it is left */
    CHECK(simulation_energies(&simulation, 0).total < 0.9 * maximum);
    CHECK(simulation_counters(&simulation).saddles > 0);
    simulation_free(&simulation);
    /* h so small that the masses outweigh the springs: there it is one */
    simulation_from_line("--segments 3 --timestep 1e-6", NULL, NULL,
                         &simulation);
    memset(simulation.run[0].x, 0, SIZE * sizeof(double));
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK(simulation_counters(&simulation).factorisations == 0);
    simulation_free(&simulation);
}

/* How a spring between two nodes in one point ends, h = 1: its Hessian is
 * [[m0 - 2, 2], [2, m1 - 2]], indefinite where 1/m0 + 1/m1 > 1/2. */
static void check_pair_in_one_point(double m0, double m1, Status expected)
{
    System system;
    Newton newton;
    const double x[4] = {0};
    NewtonSettings settings = {.h = 1, .tolerance = 1e-3, .max_iterations = 9};
    CHECK_STATUS(system_create(2, 1, &system), STATUS_OK);
    system.e[1] = 1;
    system.l2[0] = system.k[0] = 1;
    system.m[0] = m0;
    system.m[1] = m1;
    CHECK_STATUS(newton_create(&system, &settings, &newton), STATUS_OK);
    CHECK_STATUS(newton_minimise(&newton, x, NULL, 1), expected);
    newton_free(&newton);
    system_free(&system);
}

/* Whichever node is the light one, and however little is missing. */
TEST(light_nodes_show_a_maximum)
{
    check_pair_in_one_point(0.1, 1e6, STATUS_NOT_A_MINIMUM);
    check_pair_in_one_point(1e6, 0.1, STATUS_NOT_A_MINIMUM);
    check_pair_in_one_point(2.2, 4.2, STATUS_NOT_A_MINIMUM);
    check_pair_in_one_point(4.2, 2.2, STATUS_NOT_A_MINIMUM);
    check_pair_in_one_point(3.9, 3.9, STATUS_NOT_A_MINIMUM);
    check_pair_in_one_point(4.1, 4.1, STATUS_OK);
    check_pair_in_one_point(2.1, 1e6, STATUS_OK);
}

/* One spring from a pinned node at 0 to a node of 1 kg at (1/2, 0), half as
 * long as at rest.  h = 1: the Hessian's entry across is 1 - 3/2 k. */
typedef struct Lever {
    System system;
    Newton newton;
    double x[4];
} Lever;

static void lever_create(double k, double pull, Lever *lever)
{
    System *system = &lever->system;
    NewtonSettings settings = {.h = 1,
                               .tolerance = 1e-6,
                               .filter = FILTER_NONE,
                               .max_iterations = 100};
    CHECK_STATUS(system_create(2, 1, system), STATUS_OK);
    CHECK_STATUS(system_create_pins(system), STATUS_OK);
    system->m[0] = system->m[1] = system->l2[0] = 1;
    system->e[1] = 1;
    system->k[0] = k;
    system->pinned[0] = 1;
    memset(lever->x, 0, sizeof lever->x);
    lever->x[2] = 0.5;
    CHECK_STATUS(newton_create(system, &settings, &lever->newton), STATUS_OK);
    lever->newton.u_tilde[3] = pull;
}

static void lever_free(Lever *lever)
{
    newton_free(&lever->newton);
    system_free(&lever->system);
}

/* A direction 1e38 m long is downhill, but only for steps below 2^-64. */
TEST(line_search_limit_is_reached)
{
    Lever lever;
    lever_create((1 - 1e-8) / 1.5, 1e30, &lever);
    CHECK_STATUS(newton_minimise(&lever.newton, lever.x, NULL, 1),
                 STATUS_LINE_SEARCH_LIMIT);
    CHECK(lever.newton.record.slope < 0 && lever.newton.record.alpha == 0);
    CHECK(lever.newton.record.trials == 65);
    for (int i = 0; i < 4; i++)
        CHECK(lever.newton.at.u[i] == 0 && lever.newton.at.x[i] == lever.x[i]);
    lever_free(&lever);
}

/* 1 - 3/2 k = 0 in double precision, and the node is pulled across. */
TEST(singular_hessian_is_reported)
{
    Lever lever;
    lever_create(2.0 / 3, 1, &lever);
    CHECK_STATUS(newton_minimise(&lever.newton, lever.x, NULL, 1),
                 STATUS_SINGULAR);
    for (int i = 0; i < 4; i++)
        CHECK(lever.newton.at.u[i] == 0 && lever.newton.at.x[i] == lever.x[i]);
    lever_free(&lever);
}

/* Projected, the same lever swings out; the pinned node stays. */
TEST(pins_hold)
{
    Lever lever;
    lever_create(2.0 / 3, 1, &lever);
    lever.newton.settings.filter = FILTER_CLAMP;
    CHECK_STATUS(newton_minimise(&lever.newton, lever.x, NULL, 1), STATUS_OK);
    CHECK(lever.newton.at.u[0] == 0 && lever.newton.at.u[1] == 0);
    CHECK(lever.newton.at.u[3] > 0.5);
    long double g[4];
    exact_derivatives(&lever.newton.at.E, lever.newton.at.u, lever.newton.at.x,
                      g, NULL);
    CHECK_NEAR(g[2], 0, 1e-5); /* tolerance times the largest eigenvalue */
    CHECK_NEAR(g[3], 0, 1e-5);
    lever_free(&lever);
}

/* Against springs of 1e30 J/m^2 the masses are nothing, and the assembled
 * Hessian of a square that may move has pivots of 0 but for rounding.  The
 * shift makes a factor possible, and conjugate gradients find the masses
 * again: a square that flies along while it relaxes keeps its velocity. */
static bool count_shifts(void *user, const NewtonRecord *record)
{
    *(int *)user += record->shift > 0;
    return true;
}

TEST(lost_masses_are_found_again)
{
    Simulation simulation;
    int shifts = 0;
    simulation_from_line("--segments 3 --stiffness 1e30", count_shifts, &shifts,
                         &simulation);
    TimeIntegrator *run = &simulation.run[0];
    double start = system_potential(&simulation.system, run->x);
    for (int i = 0; i < SIZE; i++)
        run->v[i] = i % 2 ? 2 : 1;
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK(shifts > 0);
    double mean[2] = {0, 0};
    for (int i = 0; i < SIZE; i++)
        mean[i % 2] += run->v[i] / (SIZE / 2);
    CHECK_NEAR(mean[0], 1, 1e-12); /* a sum of 16 terms of up to 100 m/s */
    CHECK_NEAR(mean[1], 2, 1e-12);
    CHECK_AT_MOST(system_potential(&simulation.system, run->x), 1e-6 * start);
    simulation_free(&simulation);
}

/* Where a double cannot hold springs and masses side by side, slopes are
 * rounding: steps may end unconverged, but E never rises. */
static const char *const massless[] = {
    "--segments 5 --density 1e-6 --timestep 1e9 --stiffness 1e10 "
    "--stretch 1.12 --solver multigrid",
    "--segments 6 --density 2.4e-5 --timestep 9.3e8 --stiffness 3.25e8 "
    "--stretch 1.05 --solver multigrid --filter abs",
    "--segments 5 --density 2.31e-5 --timestep 4.17e8 --stiffness 9.51e8 "
    "--stretch 1.12 --solver newton",
    "--segments 6 --density 3.78e-6 --timestep 3.07e8 --stiffness 1.51e8 "
    "--stretch 0.5 --solver newton --filter on-demand",
    "--segments 5 --timestep 1e12 --stiffness 1e10 --stretch 1.12 "
    "--solver multigrid --filter abs",
    "--segments 1 --density 0.02078113651981987 --timestep "
    "3364147816908.643 --stiffness 5526952586.520507 --stretch 2 "
    "--solver multigrid --filter on-demand",
    "--segments 4 --density 8.641832226359739 --timestep "
    "6315292785651.445 --stiffness 98681394.03566141 --stretch 0.3 "
    "--solver multigrid --filter abs",
};

enum { MASSLESS = sizeof massless / sizeof *massless };

/* Not from one iterate to another either: E as it is, 1e-9 for rounding. */
TEST(iterations_never_rise_without_masses)
{
    for (int i = 0; i < MASSLESS; i++) {
        Simulation simulation;
        simulation_from_line(massless[i], NULL, NULL, &simulation);
        const TimeIntegrator *run = &simulation.run[0];
        Newton *newton = run->newton;
        double h = simulation.options.timestep;
        for (int c = 0; c < 2 * simulation.system.nodes; c++)
            newton->u_tilde[c] = 0;
        Status status = newton_start(newton, run->x, NULL, h * h);
        double start = incremental_potential_value(&newton->at.E, newton->at.u,
                                                   newton->at.x);
        while (status == STATUS_RUNNING) {
            status = newton_iterate(newton);
            CHECK_AT_MOST(incremental_potential_value(
                              &newton->at.E, newton->at.u, newton->at.x),
                          start * (1 + 1e-9));
        }
        simulation_free(&simulation);
    }
}

/* From rest, M |v|^2/2 + P(x) <= P(x_n), with 1e-9 for rounding. */
TEST(energy_never_rises_without_masses)
{
    for (int i = 0; i < MASSLESS; i++) {
        Simulation simulation;
        simulation_from_line(massless[i], NULL, NULL, &simulation);
        for (int step = 0; step < 6; step++) {
            TimeIntegrator *run = &simulation.run[0];
            for (int c = 0; c < 2 * simulation.system.nodes; c++)
                run->v[c] = 0;
            double before = simulation_energies(&simulation, 0).total;
            Status status = simulation_step(&simulation);
            CHECK(!status || status_is_unconverged(status));
            CHECK_AT_MOST(simulation_energies(&simulation, 0).total,
                          before * (1 + 1e-9));
        }
        simulation_free(&simulation);
    }
}

/* All filters that make H positive definite end in the same minimum; on demand
 * needs fewer iterations, because near it H is used as it is. */
TEST(filters_share_the_minimum)
{
    const char *const names[] = {"clamp", "abs", "on-demand"};
    double x[3][SIZE];
    long iterations[3];
    for (int i = 0; i < 3; i++) {
        char line[128];
        snprintf(line, sizeof line,
                 "--segments 3 --stretch 0.7 --tolerance 1e-9 --filter %s",
                 names[i]);
        Simulation simulation;
        simulation_from_line(line, NULL, NULL, &simulation);
        for (int step = 0; step < 10; step++)
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        memcpy(x[i], simulation.run[0].x, sizeof x[i]);
        iterations[i] = simulation_counters(&simulation).iterations;
        simulation_free(&simulation);
    }
    for (int i = 0; i < SIZE; i++) {
        /* Ten steps of 1e-9 m/s times 0.004 s, times their growth. */
        CHECK_NEAR(x[1][i], x[0][i], 1e-9);
        CHECK_NEAR(x[2][i], x[0][i], 1e-9);
    }
    CHECK(iterations[2] < iterations[0]);
}

/* |d|^4 overflows: the step fails and leaves everything as it was. */
TEST(overflow_is_reported)
{
    Simulation simulation;
    double x[SIZE];
    simulation_from_line("--segments 3 --stretch 1e160", NULL, NULL,
                         &simulation);
    memcpy(x, simulation.run[0].x, sizeof x);
    CHECK_STATUS(simulation_step(&simulation), STATUS_NOT_FINITE);
    CHECK(!status_is_unconverged(STATUS_NOT_FINITE));
    CHECK_SAME_BITS(simulation.run[0].x, x, SIZE);
    CHECK(simulation.steps == 0 && simulation.unconverged == 0);
    for (int i = 0; i < SIZE; i++)
        CHECK(simulation.run[0].v[i] == 0);
    simulation_free(&simulation);
}

/* Stops at the given record. */
static bool stop_at(void *user, const NewtonRecord *record)
{
    (void)record;
    return --*(int *)user > 0;
}

TEST(observers_can_interrupt)
{
    for (int records = 1; records <= 3; records++) {
        Simulation simulation;
        double x[SIZE];
        int left = records;
        simulation_from_line("--segments 3 --tolerance 1e-9", stop_at, &left,
                             &simulation);
        memcpy(x, simulation.run[0].x, sizeof x);
        CHECK_STATUS(simulation_step(&simulation), STATUS_INTERRUPTED);
        CHECK(left == 0 && simulation.steps == 0);
        CHECK_SAME_BITS(simulation.run[0].x, x, SIZE);
        left = 1000; /* and the step can be made again */
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        simulation_free(&simulation);
    }
}

/* A term without any energy, which only exists where x > -0.3 and tells no
 * reach beforehand: as where rounding takes a step into a wall. */
static double no_value(const Place *at)
{
    (void)at;
    return 0;
}

static void no_gradient(const Place *at, double *g)
{
    (void)at;
    (void)g;
}

static long long no_entries(const Place *at)
{
    (void)at;
    return 0;
}

static void no_pattern(const Place *at, Triplets *triplets)
{
    (void)at;
    (void)triplets;
}

static int no_hessian(const Place *at, Filter filter, const int *slot,
                      const double *q, double *out)
{
    (void)at;
    (void)filter;
    (void)slot;
    (void)q;
    (void)out;
    return 0;
}

static bool right_of_the_wall(const Place *at)
{
    return at->x[0] > -0.3;
}

/* From x = 0 to x_tilde = -1: 1 and 1/2 are refused, with and without a line
 * search; no later one ends beyond the wall. */
TEST(steps_into_a_wall_are_halved)
{
    const TermKind wall = {.value = no_value,
                           .gradient = no_gradient,
                           .entries = no_entries,
                           .pattern = no_pattern,
                           .hessian = no_hessian,
                           .allowed = right_of_the_wall};
    for (int search = 0; search < LINE_SEARCH_COUNT; search++) {
        System system;
        Newton newton;
        const double x[2] = {0, 0};
        const NewtonSettings settings = {.h = 1,
                                         .tolerance = 1e-6,
                                         .search = (LineSearch)search,
                                         .max_iterations = 100};
        CHECK_STATUS(system_create(1, 0, &system), STATUS_OK);
        system.m[0] = 1;
        CHECK_STATUS(system_add_term(&system, &wall, NULL), STATUS_OK);
        CHECK_STATUS(newton_create(&system, &settings, &newton), STATUS_OK);
        newton.u_tilde[0] = -1;
        CHECK_STATUS(newton_start(&newton, x, NULL, 1), STATUS_RUNNING);
        CHECK_STATUS(newton_iterate(&newton), STATUS_RUNNING);
        CHECK_NEAR(newton.at.x[0], -0.25, 0);
        while (newton_iterate(&newton) == STATUS_RUNNING)
            CHECK(newton.at.x[0] > -0.3);
        CHECK(newton.at.x[0] > -0.3 && newton.status != STATUS_OK);
        newton_free(&newton);
        system_free(&system);
    }
}

/* Each constant has a name and a text of its own. */
TEST(every_status_has_a_text)
{
    for (int i = 0; i < STATUS_COUNT; i++) {
        CHECK(strlen(status_text((Status)i)) > 5);
        for (int j = 0; j < i; j++) {
            CHECK(strcmp(status_text((Status)i), status_text((Status)j)) != 0);
            CHECK(strcmp(status_name((Status)i), status_name((Status)j)) != 0);
        }
    }
    CHECK(!status_is_unconverged(STATUS_OK));
    CHECK(!status_is_unconverged(STATUS_OUT_OF_MEMORY));
    CHECK(!status_is_unconverged(STATUS_INTERRUPTED));
}

TESTS(NULL, NULL)
