/* The square: nodes, springs and numbering as on the slides; the scene made
 * of it; and what is refused.
 */
#include "test.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/pull_energy.h"

/* A centred grid, column by column from below; springs as the slide's four
 * loops make them: to the right, up, and the diagonals of each cell.  Halves
 * and ones: exact.  The elimination order has each place once. */
TEST(nodes_and_springs_are_the_slides)
{
    static bool seen[71 * 71];
    for (int n = 1; n <= 70; n++) {
        SquareMesh mesh;
        int row = n + 1, s = 0;
        CHECK_STATUS(square_mesh_create(n, n, 0.5 * n, &mesh), STATUS_OK);
        CHECK(mesh.nodes == row * row && mesh.segments == n);
        CHECK(mesh.springs == 2 * n * row + 2 * n * n);
        memset(seen, 0, sizeof seen);
        for (int node = 0; node < mesh.nodes; node++) {
            CHECK(mesh.x[2 * node] == 0.5 * (node / row) - 0.25 * n);
            CHECK(mesh.x[2 * node + 1] == 0.5 * (node % row) - 0.25 * n);
            CHECK(mesh.order[node] >= 0 && mesh.order[node] < mesh.nodes);
            CHECK(!seen[mesh.order[node]]);
            seen[mesh.order[node]] = true;
        }
        for (int i = 0; i < n * row; i++, s++)
            CHECK(mesh.e[2 * s] == i && mesh.e[2 * s + 1] == i + row);
        for (int i = 0; i < n * row; i++, s++) {
            int node = i / n * row + i % n;
            CHECK(mesh.e[2 * s] == node && mesh.e[2 * s + 1] == node + 1);
        }
        for (int cell = 0; cell < n * n; cell++, s += 2) {
            int corner = cell / n * row + cell % n;
            const int *e = mesh.e + 2 * s;
            CHECK(e[0] == corner && e[1] == corner + row + 1);
            CHECK(e[2] == corner + row && e[3] == corner + 1);
        }
        square_mesh_free(&mesh);
        CHECK(mesh.x == NULL && mesh.nodes == 0);
        square_mesh_free(&mesh);
    }
    square_mesh_free(NULL);
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

/* Entries of the factor of a square with the mesh's order, or CHOLMOD's own. */
static double factor_entries(int segments, bool ordered)
{
    Simulation *square = simulate("--segments %d", segments);
    if (!ordered) {
        free(square->system.order);
        square->system.order = NULL;
    }
    make_steps(square, 1);
    return cholesky_factor_entries(square->run[0].newton->search.cholesky);
}

/* Nested dissection is no worse than the general order that CHOLMOD finds, and
 * its factor has n log n entries: from 12 to 24 segments nodes grow 3.7 times,
 * entries less than 6 times (a band matrix would have 7.4 times as many). */
TEST(order_keeps_the_factor_small)
{
    double ours = factor_entries(24, true);
    CHECK_AT_MOST(ours, 1.05 * factor_entries(24, false));
    CHECK_AT_MOST(ours, 6 * factor_entries(12, true));
}

/* m = density side^2 / nodes, l2 = |d|^2 at rest, x = stretch times rest. */
TEST(the_square_scene_is_the_slides)
{
    Simulation *scene = simulate("square --segments 4 --side 2 --density 500 "
                                 "--stiffness 3e4 --stretch 1.25");
    const System *system = &scene->system;
    const TimeIntegrator *run = &scene->run[0];
    CHECK(system->nodes == 25 && system->springs == 72);
    CHECK(system->terms == 1 && system->pinned == NULL);
    assert_string_equal(run->method->name, "backward-euler");
    for (int i = 0; i < 50; i++) {
        CHECK(system->m[i / 2] == 500 * 4 / 25.0);
        CHECK(run->x[i] == (i % 2 ? 1 : 1.25) * scene->mesh.x[i]);
        CHECK(run->v[i] == 0);
    }
    for (int s = 0; s < 72; s++) {
        CHECK(system->k[s] == 3e4);
        CHECK(system->l2[s] == (s < 40 ? 0.25 : 0.5)); /* halves: exact */
        CHECK(system->e[2 * s] == scene->mesh.e[2 * s]);
    }
    CHECK_NEAR(strain_of(scene, 0), 0.25, 1e-15);
    CHECK_NEAR(strain_of(scene, 20), 0, 1e-15);
}

/* ---- what is refused --------------------------------------------------- */

TEST(bad_sizes_are_refused)
{
    const double lengths[] = {0, -1, NAN, INFINITY, -INFINITY};
    const int segments[] = {0, -1, SQUARE_MESH_MAX_SEGMENTS + 1, INT_MAX};
    const int sizes[][2] = {
        {0, 0}, {-1, 1}, {INT_MAX, 0}, {1, -1}, {1, INT_MAX}};
    SquareMesh mesh;
    System system;
    for (int i = 0; i < 9; i++) {
        int n = i < 5 ? 4 : segments[i - 5];
        CHECK_STATUS(square_mesh_create(n, n, i < 5 ? lengths[i] : 1, &mesh),
                     STATUS_INVALID_INPUT);
        square_mesh_free(&mesh);
    }
    for (int i = 0; i < 5; i++) {
        CHECK_STATUS(system_create(sizes[i][0], sizes[i][1], &system),
                     STATUS_INVALID_INPUT);
        system_free(&system);
    }
    CHECK_STATUS(system_create(3, 0, &system), STATUS_OK);
    CHECK(system.terms == 0);
    system_free(&system);
    system_free(NULL);
}

/* Of two nodes and a spring, all in order but for one thing. */
TEST(bad_systems_are_refused)
{
    const double bad[] = {NAN, INFINITY, -INFINITY, 0, -1, 1e-310, -1e-310};
    const int ends[][2] = {{0, 0}, {1, 1}, {-1, 0},      {0, -1},
                           {2, 0}, {0, 2}, {INT_MAX, 0}, {0, INT_MIN}};
    System system;
    double x[4] = {0, 0, 1, 0}, omega2 = 1;
    CHECK_STATUS(system_create(2, 1, &system), STATUS_OK);
    double *number[] = {system.m, &system.m[1], system.l2, system.k, x,
                        x + 1,    x + 2,        x + 3,     &omega2};
    system.m[0] = system.m[1] = system.l2[0] = system.k[0] = 1;
    system.e[1] = 1;
    for (int field = 0; field < 9; field++) /* of x only what is not finite */
        for (int i = 0; i < (field < 4 ? 7 : 3); i++) {
            double good = *number[field];
            *number[field] = bad[i];
            CHECK_STATUS(central_field_set(&system, omega2), STATUS_OK);
            CHECK_STATUS(system_check(&system, x), STATUS_INVALID_INPUT);
            *number[field] = good;
            CHECK_STATUS(central_field_set(&system, omega2), STATUS_OK);
            CHECK_STATUS(system_check(&system, x), STATUS_OK);
        }
    for (int i = 0; i < 8; i++) {
        memcpy(system.e, ends[i], sizeof ends[i]);
        CHECK_STATUS(system_check(&system, x), STATUS_INVALID_INPUT);
    }
    memcpy(system.e, (int[]){1, 0}, 2 * sizeof(int));
    CHECK_STATUS(system_check(&system, x), STATUS_OK);
    system.l2[0] = 1e300; /* k / l2 would be denormal */
    system.k[0] = 1e-100;
    CHECK_STATUS(system_check(&system, x), STATUS_INVALID_INPUT);
    system_free(&system);
}

TESTS(NULL, NULL)
