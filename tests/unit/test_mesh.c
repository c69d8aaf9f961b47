/* The square: nodes, springs and numbering as on the slides; the scene made
 * of it; and what is refused.
 */
#include "model/pull_energy.h"
#include "test.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene.h"

TEST(nodes_are_a_centred_grid)
{
    SquareMesh mesh;
    CHECK_STATUS(square_mesh_create(4, 4, 2, &mesh), STATUS_OK);
    CHECK(mesh.nodes == 25 && mesh.segments == 4 && mesh.side == 2);
    for (int i = 0; i <= 4; i++)
        for (int j = 0; j <= 4; j++) {
            int node = i * 5 + j; /* halves and ones: exact */
            CHECK_NEAR(mesh.x[2 * node], -1 + 0.5 * i, 0);
            CHECK_NEAR(mesh.x[2 * node + 1], -1 + 0.5 * j, 0);
        }
    square_mesh_free(&mesh);
    CHECK(mesh.x == NULL && mesh.nodes == 0);
    square_mesh_free(&mesh);
    square_mesh_free(NULL);
}

/* The slide's own four loops for 1 segment, written out by hand. */
TEST(one_cell_is_as_on_the_slide)
{
    const int expected[] = {0, 2, 1, 3, /* horizontal */
                            0, 1, 2, 3, /* vertical */
                            0, 3, 2, 1 /* diagonals */};
    SquareMesh mesh;
    CHECK_STATUS(square_mesh_create(1, 1, 1, &mesh), STATUS_OK);
    CHECK(mesh.springs == 6);
    for (int i = 0; i < 12; i++)
        CHECK_NEAR(mesh.e[i], expected[i], 0);
    square_mesh_free(&mesh);
}

/* Every spring of 3 segments from its place in the list. */
TEST(springs_come_in_the_order_of_the_slide)
{
    enum { N = 3, ROW = N + 1 };
    SquareMesh mesh;
    CHECK_STATUS(square_mesh_create(N, N, 1, &mesh), STATUS_OK);
    CHECK(mesh.springs == 2 * N * ROW + 2 * N * N);
    for (int s = 0; s < N * ROW; s++) {
        CHECK(mesh.e[2 * s] == s); /* to the right: i + 1 */
        CHECK(mesh.e[2 * s + 1] == s + ROW);
    }
    for (int s = 0; s < N * ROW; s++) {
        int node = s / N * ROW + s % N; /* up: j + 1 */
        CHECK(mesh.e[2 * (N * ROW + s)] == node);
        CHECK(mesh.e[2 * (N * ROW + s) + 1] == node + 1);
    }
    for (int cell = 0; cell < N * N; cell++) {
        int corner = cell / N * ROW + cell % N;
        const int *e = mesh.e + 2 * (2 * N * ROW + 2 * cell);
        CHECK(e[0] == corner && e[1] == corner + ROW + 1);
        CHECK(e[2] == corner + ROW && e[3] == corner + 1);
    }
    square_mesh_free(&mesh);
}

/* Counts and lengths for many sizes; an odd side rounds, so 1e-14 of it. */
TEST(springs_have_the_lengths_of_a_cell)
{
    for (int n = 1; n <= 20; n++) {
        SquareMesh mesh;
        double side = 0.7 * n, cell = 0.7;
        CHECK_STATUS(square_mesh_create(n, n, side, &mesh), STATUS_OK);
        int straight = 0, diagonal = 0;
        for (int s = 0; s < mesh.springs; s++) {
            const double *a = mesh.x + 2 * mesh.e[2 * s];
            const double *b = mesh.x + 2 * mesh.e[2 * s + 1];
            double length = hypot(a[0] - b[0], a[1] - b[1]);
            bool is_straight = length < 1.2 * cell;
            straight += is_straight;
            diagonal += !is_straight;
            CHECK_NEAR(length, is_straight ? cell : sqrt(2) * cell,
                       1e-14 * side);
        }
        CHECK(straight == 2 * n * (n + 1) && diagonal == 2 * n * n);
        square_mesh_free(&mesh);
    }
}

/* Whether the springs join the nodes in pairs, in any order. */
static bool joins(const SquareMesh *mesh, int spring, int a, int b)
{
    const int *e = mesh->e + 2 * spring;
    return (e[0] == a && e[1] == b) || (e[0] == b && e[1] == a);
}

/* Of a beam: cells and triangles lie anticlockwise, have the area of a cell and
 * of half a one, and the springs that join their nodes; the outline has what is
 * left over at all sides.  Coordinates are halves: exact. */
TEST(cells_triangles_and_outline_are_those_of_the_springs)
{
    enum { COLUMNS = 5, ROWS = 3 };
    int node[4], spring[6], seen = 0;
    SquareMesh mesh;
    CHECK_STATUS(square_mesh_create(COLUMNS, ROWS, 2.5, &mesh), STATUS_OK);
    CHECK(mesh.cells == 15 && mesh.spacing == 0.5);
    for (int t = 0; t < 4 * mesh.cells; t++) {
        square_mesh_triangle(&mesh, t, node, spring);
        const double *a = mesh.x + 2 * node[0], *b = mesh.x + 2 * node[1];
        const double *c = mesh.x + 2 * node[2];
        CHECK((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]) ==
              0.25);
        for (int k = 0; k < 3; k++)
            CHECK(joins(&mesh, spring[k], node[k], node[(k + 1) % 3]));
        square_mesh_cell(&mesh, t / 4, node, spring);
        for (int k = 0; k < 4; k++)
            CHECK(joins(&mesh, spring[k], node[k], node[(k + 1) % 4]));
        CHECK(joins(&mesh, spring[4], node[0], node[2]) &&
              joins(&mesh, spring[5], node[1], node[3]));
    }
    double twice = 0;
    for (int k = 0; k < mesh.outline; k++) {
        int i = square_mesh_outline(&mesh, k);
        const double *a = mesh.x + 2 * i;
        const double *b = mesh.x + 2 * square_mesh_outline(&mesh, k + 1);
        CHECK(fabs(a[0] - b[0]) + fabs(a[1] - b[1]) == 0.5);
        CHECK(square_mesh_sides(&mesh, i) ==
              (a[0] == -1.25 ? MESH_LEFT : 0) +
                  (a[0] == 1.25 ? MESH_RIGHT : 0) +
                  (a[1] == -0.75 ? MESH_BOTTOM : 0) +
                  (a[1] == 0.75 ? MESH_TOP : 0));
        twice += a[0] * b[1] - a[1] * b[0];
    }
    CHECK(mesh.outline == 16 && twice == 2 * 2.5 * 1.5);
    twice = 0;
    for (int c = 0; c < mesh.cells; c++) /* 2 x 2, cut at the edges */
        if (square_mesh_patch(&mesh, c, 2, node)) {
            const double *low = mesh.x + 2 * node[0];
            const double *up = mesh.x + 2 * node[2];
            twice += 2 * (up[0] - low[0]) * (up[1] - low[1]);
            seen++;
        }
    CHECK(seen == 6 && twice == 2 * 2.5 * 1.5);
    square_mesh_free(&mesh);
}

TEST(order_is_a_permutation)
{
    static bool seen[71 * 71];
    for (int n = 1; n <= 70; n++) {
        SquareMesh mesh;
        memset(seen, 0, sizeof seen);
        CHECK_STATUS(square_mesh_create(n, n, 1, &mesh), STATUS_OK);
        for (int i = 0; i < mesh.nodes; i++) {
            CHECK(mesh.order[i] >= 0 && mesh.order[i] < mesh.nodes);
            CHECK(!seen[mesh.order[i]]);
            seen[mesh.order[i]] = true;
        }
        square_mesh_free(&mesh);
    }
}

/* Entries of the factor of a square with this order, or CHOLMOD's own. */
static double factor_entries(int segments, bool ordered)
{
    Simulation simulation;
    char line[64];
    snprintf(line, sizeof line, "--segments %d", segments);
    simulation_from_line(line, NULL, NULL, &simulation);
    if (!ordered) {
        free(simulation.system.order);
        simulation.system.order = NULL;
    }
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    double entries =
        cholesky_factor_entries(simulation.run[0].newton->search.cholesky);
    simulation_free(&simulation);
    return entries;
}

/* Nested dissection is no worse than the general order that CHOLMOD finds,
 * and the sum of a step does not depend on it. */
TEST(order_keeps_the_factor_small)
{
    double ours = factor_entries(24, true);
    CHECK_AT_MOST(ours, 1.05 * factor_entries(24, false));
    /* n log n: from 12 to 24 segments nodes grow 3.7 times, entries less
     * than 6 times (a band matrix would have 7.4 times as many) */
    CHECK_AT_MOST(ours, 6 * factor_entries(12, true));
}

TEST(bad_meshes_are_refused)
{
    const double bad[] = {0, -1, NAN, INFINITY, -INFINITY};
    SquareMesh mesh;
    for (int i = 0; i < 5; i++) {
        CHECK_STATUS(square_mesh_create(4, 4, bad[i], &mesh),
                     STATUS_INVALID_INPUT);
        square_mesh_free(&mesh);
    }
    const int segments[] = {0, -1, SQUARE_MESH_MAX_SEGMENTS + 1, INT_MAX};
    for (int i = 0; i < 4; i++) {
        CHECK_STATUS(square_mesh_create(segments[i], segments[i], 1, &mesh),
                     STATUS_INVALID_INPUT);
        square_mesh_free(&mesh);
    }
}

/* m = density side^2 / nodes, l2 = |d|^2 at rest, x = stretch times rest. */
TEST(the_square_scene_is_the_slides)
{
    Simulation simulation;
    simulation_from_line("square --segments 4 --side 2 --density 500 "
                         "--stiffness 3e4 --stretch 1.25",
                         NULL, NULL, &simulation);
    const System *system = &simulation.system;
    CHECK(system->nodes == 25 && system->springs == 72);
    CHECK(system->terms == 1 && system->pinned == NULL);
    assert_string_equal(simulation.run[0].method->name, "backward-euler");
    for (int i = 0; i < 25; i++) {
        CHECK(system->m[i] == 500 * 4 / 25.0);
        CHECK(simulation.run[0].x[2 * i] == 1.25 * simulation.mesh.x[2 * i]);
        CHECK(simulation.run[0].x[2 * i + 1] == simulation.mesh.x[2 * i + 1]);
        CHECK(simulation.run[0].v[2 * i] == 0);
        CHECK(simulation.run[0].v[2 * i + 1] == 0);
    }
    for (int s = 0; s < 72; s++) {
        CHECK(system->k[s] == 3e4);
        CHECK(system->l2[s] == (s < 40 ? 0.25 : 0.5)); /* halves: exact */
        CHECK(system->e[2 * s] == simulation.mesh.e[2 * s]);
    }
    CHECK_NEAR(strain_of(&simulation, 0), 0.25, 1e-15);
    CHECK_NEAR(strain_of(&simulation, 20), 0, 1e-15);
    Energies energies = simulation_energies(&simulation, 0);
    CHECK(energies.kinetic == 0 && energies.total == OF(&energies, elastic));
    IncrementalPotential E = {.system = system, .weight = 1};
    CHECK_NEAR(OF(&energies, elastic),
               exact_energy(&E, NULL, simulation.run[0].x),
               1e-13 * OF(&energies, elastic));
    simulation_free(&simulation);
    simulation_free(NULL);
}

/* Two nodes and a spring between them, all in order. */
static void pair_create(System *system, double *x)
{
    CHECK_STATUS(system_create(2, 1, system), STATUS_OK);
    system->m[0] = system->m[1] = system->l2[0] = system->k[0] = 1;
    system->e[1] = 1;
    memcpy(x, (double[]){0, 0, 1, 0}, 4 * sizeof *x);
}

TEST(bad_numbers_are_refused)
{
    const double bad[] = {0, -1, NAN, INFINITY, -INFINITY, 1e-310, -1e-310};
    System system;
    double x[4];
    pair_create(&system, x);
    CHECK_STATUS(system_check(&system, x), STATUS_OK);
    double *positive[] = {&system.m[0], &system.m[1], &system.l2[0],
                          &system.k[0]};
    for (int field = 0; field < 4; field++)
        for (int i = 0; i < 7; i++) {
            *positive[field] = bad[i];
            CHECK_STATUS(system_check(&system, x), STATUS_INVALID_INPUT);
            *positive[field] = 1;
        }
    for (int i = 2; i < 5; i++)
        for (int c = 0; c < 4; c++) {
            double good = x[c];
            x[c] = bad[i];
            CHECK_STATUS(system_check(&system, x), STATUS_INVALID_INPUT);
            x[c] = good;
        }
    for (int i = 1; i < 5; i++) {
        CHECK_STATUS(central_field_set(&system, bad[i]), STATUS_OK);
        CHECK_STATUS(system_check(&system, x), STATUS_INVALID_INPUT);
        CHECK_STATUS(central_field_set(&system, 0), STATUS_OK);
    }
    system.l2[0] = 1e300; /* k / l2 would be denormal */
    system.k[0] = 1e-100;
    CHECK_STATUS(system_check(&system, x), STATUS_INVALID_INPUT);
    system.l2[0] = system.k[0] = 1;
    CHECK_STATUS(system_check(&system, x), STATUS_OK);
    system_free(&system);
}

TEST(bad_springs_are_refused)
{
    const int bad[][2] = {{0, 0}, {1, 1}, {-1, 0},      {0, -1},
                          {2, 0}, {0, 2}, {INT_MAX, 0}, {0, INT_MIN}};
    System system;
    double x[4];
    pair_create(&system, x);
    for (int i = 0; i < 8; i++) {
        memcpy(system.e, bad[i], sizeof bad[i]);
        CHECK_STATUS(system_check(&system, x), STATUS_INVALID_INPUT);
    }
    memcpy(system.e, (int[]){1, 0}, 2 * sizeof(int));
    CHECK_STATUS(system_check(&system, x), STATUS_OK);
    system_free(&system);
    system_free(NULL);
}

TEST(bad_sizes_are_refused)
{
    const int bad[][2] = {{0, 0}, {-1, 1}, {INT_MAX, 0}, {1, -1}, {1, INT_MAX}};
    System system;
    for (int i = 0; i < 5; i++) {
        CHECK_STATUS(system_create(bad[i][0], bad[i][1], &system),
                     STATUS_INVALID_INPUT);
        system_free(&system);
    }
    CHECK_STATUS(system_create(3, 0, &system), STATUS_OK);
    CHECK(system.terms == 0);
    system_free(&system);
}

TESTS(NULL, NULL)
