/* The square: nodes, springs and numbering as on the slides. */
#include "test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/self_contact.h"

/* A centred grid, column by column from below; springs as the slide's four
 * loops make them: to the right, up, and the diagonals of each cell.  Halves
 * and ones: exact.  The elimination order has each place once. */
TEST(nodes_and_springs_are_the_slides)
{
    static bool seen[71 * 71];
    for (int n = 1; n <= 70; n++) {
        SquareMesh mesh;
        int row = n + 1, s = 0;
        CHECK_STATUS(square_mesh_create(n, n, 0.5 * n, 1, &mesh), STATUS_OK);
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

/* Of two beams: cells and triangles lie anticlockwise, have the area of a cell
 * and of half a one, and the springs that join their nodes; the outline has
 * what is left over at all sides.  Coordinates are halves: exact. */
TEST(cells_triangles_and_outline_are_those_of_the_springs)
{
    enum { COLUMNS = 5, ROWS = 3, BODIES = 2 };
    int node[4], spring[6], seen = 0;
    SquareMesh mesh;
    CHECK_STATUS(square_mesh_create(COLUMNS, ROWS, 2.5, BODIES, &mesh),
                 STATUS_OK);
    CHECK(mesh.cells == 30 && mesh.spacing == 0.5);
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
        square_mesh_outline(&mesh, k, node);
        int i = node[0], j = node[1];
        const double *a = mesh.x + 2 * i, *b = mesh.x + 2 * j;
        CHECK(i / 24 == j / 24 && square_mesh_body(&mesh, &i) == k / 16);
        CHECK(fabs(a[0] - b[0]) + fabs(a[1] - b[1]) == 0.5);
        CHECK(square_mesh_sides(&mesh, i) ==
              (a[0] == -1.25 ? MESH_LEFT : 0) +
                  (a[0] == 1.25 ? MESH_RIGHT : 0) +
                  (a[1] == -0.75 ? MESH_BOTTOM : 0) +
                  (a[1] == 0.75 ? MESH_TOP : 0));
        twice += a[0] * b[1] - a[1] * b[0];
    }
    CHECK(mesh.outline == 32 && twice == BODIES * 2 * 2.5 * 1.5);
    twice = 0;
    for (int c = 0; c < mesh.cells; c++) /* 2 x 2, cut at the edges */
        if (square_mesh_patch(&mesh, c, 2, node)) {
            const double *low = mesh.x + 2 * node[0];
            const double *up = mesh.x + 2 * node[2];
            twice += 2 * (up[0] - low[0]) * (up[1] - low[1]);
            seen++;
        }
    CHECK(seen == 12 && twice == BODIES * 2 * 2.5 * 1.5);
    square_mesh_free(&mesh);
}

/* Of two cells beside each other, with some springs of the first one broken: ab
 * bc dc ad ac bd.  bc is the second one's ad. */
TEST(the_boundary_is_that_of_what_is_solid)
{
    static const struct {
        int broken[6], edges, points;
    } rows[] = {
        {{0}, 6, 6},
        {{0, 0, 0, 0, 1, 0}, 6, 6}, /* the other diagonal will do */
        {{0, 0, 0, 0, 0, 1}, 6, 6},
        {{0, 1, 0, 0, 0, 0}, 6, 6}, /* a crack between them: abd, and b'c'a' */
        {{1, 0, 0, 0, 0, 0}, 5, 6}, /* a is of no triangle */
        {{0, 0, 0, 0, 1, 1}, 4, 6}, /* d and a are threads' ends */
        {{0, 0, 1, 0, 1, 0}, 7, 6}, /* abd is left, */
        {{0, 0, 1, 0, 0, 1}, 4, 6}, /* but bca is not taken alone */
        {{1, 1, 1, 1, 1, 1}, 3, 6},
    };
    SquareMesh mesh;
    CHECK_STATUS(square_mesh_create(2, 1, 2, 1, &mesh), STATUS_OK);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const Barrier barrier = {0.01, 1};
        int node[4], spring[6];
        System system;
        CHECK_STATUS(system_create(6, mesh.springs, &system), STATUS_OK);
        memcpy(system.e, mesh.e, 2 * (size_t)mesh.springs * sizeof *mesh.e);
        square_mesh_cell(&mesh, 0, node, spring);
        for (int s = 0; s < mesh.springs; s++)
            system.k[s] = system.l2[s] = 1;
        for (int k = 0; k < 6; k++)
            system.k[spring[k]] = !rows[i].broken[k];
        CHECK_STATUS(self_contact_set(&system, &mesh, &barrier, 0), STATUS_OK);
        Place at = place_at(&system, mesh.x, NULL, mesh.x);
        at.term = system_find_term(&system, &self_contact_energy);
        CHECK(self_contact_energy.value(&at) == 0);
        const Boundary *boundary = &self_contact_of(&system)->boundary;
        CHECK_NEAR(boundary->edges, rows[i].edges, 0);
        CHECK_NEAR(boundary->points, rows[i].points, 0);
        system_free(&system);
    }
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

TESTS(NULL, NULL)
