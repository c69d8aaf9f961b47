/* Smoothing: each node's step against its block of the exact Hessian, colours,
 * and an energy that never rises.
 */
#include "model/central_field.h"
#include "testing.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solve/gauss_seidel.h"

/* A random system away from its minimum. */
typedef struct Spot {
    System system;
    GaussSeidel smoother;
    double x_n[MAX_SIZE], u[MAX_SIZE], x[MAX_SIZE], u_tilde[MAX_SIZE];
    IncrementalPotential E;
    int size;
} Spot;

static void place_create(Random *random, SpringState state, Spot *place)
{
    double x[MAX_SIZE];
    random_system(random, state, &place->system, x);
    central_field_set(&place->system, random_below(random, 2)
                                          ? random_uniform(random, 0, 3)
                                          : 0);
    place->size = 2 * place->system.nodes;
    for (int i = 0; i < place->size; i++) {
        place->u[i] = random_uniform(random, -1, 1);
        place->u_tilde[i] = random_uniform(random, -1, 1);
        place->x_n[i] = x[i] - place->u[i];
        place->x[i] = place->x_n[i] + place->u[i];
    }
    place->E = (IncrementalPotential){&place->system,
                                      random_logarithmic(random, 1e-3, 1e3),
                                      place->x_n, place->u_tilde, false};
}

static void place_free(Spot *place)
{
    gauss_seidel_free(&place->smoother);
    system_free(&place->system);
}

/* The Newton step of node i alone: -(its block of H)^-1 (its part of g).
 * Returns the block's condition number, for the tolerance. */
static long double exact_move(const Spot *place, int i, long double move[2])
{
    long double g[MAX_SIZE], H[MAX_SIZE * MAX_SIZE];
    int size = place->size;
    exact_derivatives(&place->E, place->u, place->x, g, NULL);
    exact_hessian(&place->E, place->x, true, H);
    long double a = H[size * 2 * i + 2 * i], b = H[size * 2 * i + 2 * i + 1];
    long double c = H[size * (2 * i + 1) + 2 * i + 1], det = a * c - b * b;
    move[0] = -(c * g[2 * i] - b * g[2 * i + 1]) / det;
    move[1] = -(a * g[2 * i + 1] - b * g[2 * i]) / det;
    return (a + c) * (a + c) / det;
}

/* All nodes are pinned but one.  1e-14, some roundings, times what the block
 * makes of them: its condition, and the size of the forces that cancel in g is
 * in the move's own size and in |u|, |u_tilde| of order 1. */
static void a_node_makes_its_own_newton_step(void **unused)
{
    (void)unused;
    Random random = {501};
    int moved = 0;
    for (int trial = 0; trial < 400; trial++) {
        Spot place;
        place_create(&random, (SpringState)(trial % SPRING_STATES), &place);
        assert_int_equal(system_create_pins(&place.system), STATUS_OK);
        int n = place.system.nodes, free_node = random_below(&random, n);
        for (int i = 0; i < n; i++)
            place.system.pinned[i] = i != free_node;
        CHECK_STATUS(gauss_seidel_create(&place.system, &place.smoother),
                     STATUS_OK);
        double u[MAX_SIZE];
        memcpy(u, place.u, sizeof u);
        long double move[2];
        long double condition = exact_move(&place, free_node, move);
        gauss_seidel_sweep(&place.smoother, &place.E, trial % 2, place.u,
                           place.x);
        for (int i = 0; i < place.size; i++) {
            if (i / 2 != free_node) {
                CHECK(place.u[i] == u[i]);
                continue;
            }
            long double size = 10 + hypotl(move[0], move[1]);
            CHECK_NEAR(place.u[i], u[i] + move[i % 2],
                       1e-14L * condition * size);
            CHECK(place.x[i] == place.x_n[i] + place.u[i]);
            moved += place.u[i] != u[i];
        }
        place_free(&place);
    }
    CHECK(moved > 700);
}

/* A whole sweep is what its nodes do one after the other, in the order of the
 * groups, each seeing the ones before. */
static void a_sweep_moves_one_node_after_the_other(void **unused)
{
    (void)unused;
    Random random = {502};
    for (int trial = 0; trial < 60; trial++) {
        Spot place, single;
        place_create(&random, (SpringState)(trial % SPRINGS_NEAR_ZERO), &place);
        CHECK_STATUS(gauss_seidel_create(&place.system, &place.smoother),
                     STATUS_OK);
        single = place;
        int n = place.system.nodes, groups = place.smoother.groups;
        int visits[MAX_NODES] = {0};
        CHECK_STATUS(system_create_pins(&single.system), STATUS_OK);
        for (int k = 0; k < groups * LANES; k++) {
            int group = trial % 2 ? groups - 1 - k / LANES : k / LANES;
            int node = place.smoother.group[group].node[k % LANES];
            if (k % LANES > 0 &&
                node == place.smoother.group[group].node[k % LANES - 1])
                continue;
            visits[node]++;
            for (int i = 0; i < n; i++)
                single.system.pinned[i] = i != node;
            single.E.system = &single.system;
            single.E.u_tilde = single.u_tilde;
            CHECK_STATUS(gauss_seidel_create(&single.system, &single.smoother),
                         STATUS_OK);
            gauss_seidel_sweep(&single.smoother, &single.E, false, single.u,
                               single.x);
            gauss_seidel_free(&single.smoother);
        }
        gauss_seidel_sweep(&place.smoother, &place.E, trial % 2, place.u,
                           place.x);
        for (int i = 0; i < n; i++)
            CHECK(visits[i] == 1);
        CHECK_SAME_BITS(place.u, single.u, place.size);
        free(single.system.pinned);
        place_free(&place);
    }
}

/* On a square four colours are enough, and nodes of one group are strangers. */
static void nodes_of_a_group_are_not_joined(void **unused)
{
    (void)unused;
    Simulation simulation;
    simulation_from_line("--segments 9", NULL, NULL, &simulation);
    const System *system = &simulation.system;
    GaussSeidel smoother;
    CHECK_STATUS(gauss_seidel_create(system, &smoother), STATUS_OK);
    CHECK(smoother.groups <= (system->nodes + LANES - 1) / LANES + 4);
    for (int k = 0; k < smoother.groups; k++)
        for (int s = 0; s < system->springs; s++) {
            int ends = 0;
            for (int lane = 0; lane < LANES; lane++)
                ends += smoother.group[k].node[lane] == system->e[2 * s] ||
                        smoother.group[k].node[lane] == system->e[2 * s + 1];
            const int *node = smoother.group[k].node;
            CHECK(ends <= 1 || node[0] == node[LANES - 1]);
        }
    gauss_seidel_free(&smoother);
    simulation_free(&simulation);
}

/* The change that is told is the change there is, and not upwards.  4e-15 of
 * the energies: they are sums of some dozen terms, and x = x_n + u is rounded.
 */
static void smoothing_never_goes_uphill(void **unused)
{
    (void)unused;
    Random random = {503};
    int gone = 0;
    for (int trial = 0; trial < 400; trial++) {
        Spot place;
        double g[MAX_SIZE], s[MAX_SIZE], start[MAX_SIZE], change;
        place_create(&random, (SpringState)(trial % SPRING_STATES), &place);
        CHECK_STATUS(gauss_seidel_create(&place.system, &place.smoother),
                     STATUS_OK);
        memcpy(start, place.u, sizeof start);
        long double before = exact_energy(&place.E, place.u, place.x, -1, -1).f;
        incremental_potential_gradient(&place.E, place.u, place.x, g);
        int trials = gauss_seidel_smooth(&place.smoother, &place.E, g, place.u,
                                         place.x, s, &change);
        long double after = exact_energy(&place.E, place.u, place.x, -1, -1).f;
        CHECK(trials >= 1 && change <= 0);
        CHECK_NEAR(change, after - before, 1e-13L * (before + after));
        for (int i = 0; i < place.size; i++) {
            CHECK_NEAR(place.u[i], start[i] + s[i],
                       2 * DBL_EPSILON * fabs(place.u[i]));
            CHECK(place.x[i] == place.x_n[i] + place.u[i]);
        }
        gone += change < 0;
        place_free(&place);
    }
    CHECK(gone > 350);
}

/* Sweeps that overflow leave everything where it was. */
static void smoothing_gives_up_without_damage(void **unused)
{
    (void)unused;
    Random random = {504};
    Spot place;
    double g[MAX_SIZE], s[MAX_SIZE], start[MAX_SIZE], change;
    place_create(&random, SPRINGS_STRETCHED, &place);
    CHECK_STATUS(gauss_seidel_create(&place.system, &place.smoother),
                 STATUS_OK);
    place.u_tilde[0] = 1e300; /* its square overflows */
    memcpy(start, place.u, sizeof start);
    incremental_potential_gradient(&place.E, place.u, place.x, g);
    gauss_seidel_smooth(&place.smoother, &place.E, g, place.u, place.x, s,
                        &change);
    CHECK(change == 0);
    CHECK_SAME_BITS(place.u, start, place.size);
    for (int i = 0; i < place.size; i++)
        CHECK(s[i] == 0 && place.x[i] == place.x_n[i] + place.u[i]);
    place_free(&place);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_node_makes_its_own_newton_step),
        cmocka_unit_test(a_sweep_moves_one_node_after_the_other),
        cmocka_unit_test(nodes_of_a_group_are_not_joined),
        cmocka_unit_test(smoothing_never_goes_uphill),
        cmocka_unit_test(smoothing_gives_up_without_damage),
    };
    return cmocka_run_group_tests_name("gauss_seidel", tests, NULL, NULL);
}
