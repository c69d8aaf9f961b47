/* test_mesh.c - the square: nodes, springs and numbering of the slides, the
 * elimination order, and the words of --pin */
#include "test.h"

#include <math.h>
#include <string.h>

#include "simulation/body.h"

/* The grid is centred, numbered by columns from below; springs have the order
 * of the four loops on the slide: right, up, both diagonals. Coordinates are
 * multiples of 1/4, so exact. The elimination order is a permutation. */
TEST(nodes_and_springs_are_the_slides)
{
    static int order[71 * 71], springs[2 * 4 * 70 * 71];
    static bool seen[71 * 71];
    for (int n = 1; n <= 70; n++) {
        const SquareMesh mesh = square_mesh_create(n, n, 0.5 * n, 1);
        int row = n + 1, s = 0;
        square_mesh_order_nodes(&mesh, order);
        square_mesh_list_springs(&mesh, springs);
        CHECK(mesh.nodes == row * row && mesh.columns == n);
        CHECK(mesh.springs == 2 * n * row + 2 * n * n);
        memset(seen, 0, sizeof seen);
        for (int node = 0; node < mesh.nodes; node++) {
            double x[2];
            square_mesh_rest_position(&mesh, node, x);
            CHECK(x[0] == 0.5 * (node / row) - 0.25 * n);
            CHECK(x[1] == 0.5 * (node % row) - 0.25 * n);
            CHECK(order[node] >= 0 && order[node] < mesh.nodes);
            CHECK(!seen[order[node]]);
            seen[order[node]] = true;
        }
        const int *e = springs;
        for (int i = 0; i < n * row; i++, s++, e += 2)
            CHECK(e[0] == i && e[1] == i + row);
        for (int i = 0; i < n * row; i++, s++, e += 2) {
            int node = i / n * row + i % n;
            CHECK(e[0] == node && e[1] == node + 1);
        }
        for (int cell = 0; cell < n * n; cell++, s += 2, e += 4) {
            int corner = cell / n * row + cell % n;
            CHECK(e[0] == corner && e[1] == corner + row + 1);
            CHECK(e[2] == corner + row && e[3] == corner + 1);
        }
        CHECK(s == mesh.springs);
    }
}

static bool spring_joins(const int e[2], int a, int b)
{
    return (e[0] == a && e[1] == b) || (e[0] == b && e[1] == a);
}

/* Cells and triangles of two beams are anticlockwise, with the right areas and
 * springs; each edge of the outline has one cell. Sums are exact. */
TEST(cells_triangles_and_outline_are_those_of_the_springs)
{
    enum { COLUMNS = 5, ROWS = 3, BODIES = 2 };
    int node[4], spring[6], seen = 0, e[300];
    double x[100];
    const SquareMesh mesh = square_mesh_create(COLUMNS, ROWS, 2.5, BODIES);
    square_mesh_list_springs(&mesh, e);
    for (int i = 0; i < mesh.nodes; i++)
        square_mesh_rest_position(&mesh, i, x + 2 * i);
    CHECK(mesh.cells == 30 && mesh.spacing == 0.5);
    for (int t = 0; t < 4 * mesh.cells; t++) {
        square_mesh_get_triangle(&mesh, t, node, spring);
        const double *a = x + 2 * node[0], *b = x + 2 * node[1];
        const double *c = x + 2 * node[2];
        CHECK((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]) ==
              0.25);
        for (int k = 0; k < 3; k++)
            CHECK(spring_joins(e + 2 * spring[k], node[k], node[(k + 1) % 3]));
        square_mesh_get_cell(&mesh, t / 4, node, spring);
        for (int k = 0; k < 4; k++)
            CHECK(spring_joins(e + 2 * spring[k], node[k], node[(k + 1) % 4]));
        CHECK(spring_joins(e + 2 * spring[4], node[0], node[2]) &&
              spring_joins(e + 2 * spring[5], node[1], node[3]));
    }
    double twice = 0;
    for (int k = 0; k < mesh.outline_edge_count; k++) {
        square_mesh_get_outline_edge(&mesh, k, node);
        int i = node[0], j = node[1];
        const double *a = x + 2 * i, *b = x + 2 * j;
        CHECK(i / 24 == j / 24 && square_mesh_find_body(&mesh, i) == k / 16);
        CHECK(fabs(a[0] - b[0]) + fabs(a[1] - b[1]) == 0.5);
        CHECK(square_mesh_get_node_sides(&mesh, i) ==
              (a[0] == -1.25 ? MESH_LEFT : 0) +
                  (a[0] == 1.25 ? MESH_RIGHT : 0) +
                  (a[1] == -0.75 ? MESH_BOTTOM : 0) +
                  (a[1] == 0.75 ? MESH_TOP : 0));
        twice += a[0] * b[1] - a[1] * b[0];
    }
    CHECK(mesh.outline_edge_count == 32 && twice == BODIES * 2 * 2.5 * 1.5);
    twice = 0;
    for (int c = 0; c < mesh.cells; c++) /* patches of at most 2 x 2 cells */
        if (square_mesh_get_cell_patch(&mesh, c, 2, node)) {
            const double *low = x + 2 * node[0], *up = x + 2 * node[2];
            twice += 2 * (up[0] - low[0]) * (up[1] - low[1]);
            seen++;
        }
    CHECK(seen == 12 && twice == BODIES * 2 * 2.5 * 1.5);
}

/* Returns the number of entries in the factor of a square, by symbolic
 * elimination: later neighbours of a node become neighbours. */
static double count_factor_entries(int segments)
{
    enum { MAX_MESH_NODES = 625 };
    static bool meets[MAX_MESH_NODES][MAX_MESH_NODES];
    const System *system = &simulate("--segments %d", segments)->system;
    int n = system->nodes, blocks = n;
    memset(meets, 0, sizeof meets);
    for (int s = 0; s < system->springs; s++) {
        int i = system->elimination_index[system->e[2 * s]];
        int j = system->elimination_index[system->e[2 * s + 1]];
        meets[i][j] = meets[j][i] = true;
    }
    for (int k = 0; k < n; k++)
        for (int i = k + 1; i < n; i++)
            for (int j = k + 1; j < n && meets[k][i]; j++)
                meets[i][j] = meets[i][j] || meets[k][j];
    for (int k = 0; k < n; k++)
        for (int i = k + 1; i < n; i++)
            blocks += meets[k][i];
    return 4 * blocks - n; /* 4 entries a block, 3 a diagonal block */
}

/* Nested dissection gives a factor of n log n entries. From 12 to 24 segments
 * the nodes grow 3.7 times, the entries less than 6 times (a band matrix: 7.4);
 * CHOLMOD's own order (AMD) has 41519 with 24 segments. */
TEST(elimination_order_keeps_the_factor_small)
{
    double ours = count_factor_entries(24);
    CHECK_AT_MOST(ours, 41519);
    CHECK_AT_MOST(ours, 6 * count_factor_entries(12));
}

/* Words of --pin select their nodes; nodes 0 ... rows are the left column. */
TEST(the_words_of_pin_name_their_nodes)
{
    static const struct {
        int columns, rows;
        const char *text, *pinned_flags;
    } cases[] = {
        {2, 2, "top-corners", "001000001"}, {2, 2, "top", "001001001"},
        {2, 2, "bottom", "100100100"},      {2, 2, "left", "111000000"},
        {2, 2, "right", "000000111"},       {2, 2, "4", "000010000"},
        {2, 2, "0,8,left", "111000001"},    {2, 2, "8,8", "000000001"},
        {3, 1, "top-corners", "01000001"},  {3, 1, "top", "01010101"},
        {3, 1, "bottom", "10101010"},       {3, 1, "left", "11000000"},
        {3, 1, "right,2", "00100011"},      {1, 3, "top-corners", "00010001"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        unsigned char pinned[9] = {0};
        const SquareMesh shape =
            square_mesh_create(cases[i].columns, cases[i].rows, 1, 1);
        CHECK(!pins_parse(cases[i].text, &shape, pinned));
        for (int node = 0; cases[i].pinned_flags[node]; node++)
            CHECK(pinned[node] == (cases[i].pinned_flags[node] == '1'));
    }
}

TESTS(NULL, NULL)
