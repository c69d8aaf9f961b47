/* square_mesh.c - the mesh of the square (slide square_mesh.py). */
#include "model/square_mesh.h"

#include <string.h>

SquareMesh square_mesh_create(int columns, int rows, double side, int bodies)
{
    int springs = columns * (rows + 1) + rows * (columns + 1);
    return (SquareMesh){.columns = columns,
                        .rows = rows,
                        .bodies = bodies,
                        .side = side,
                        .spacing = side / columns,
                        .nodes = bodies * (columns + 1) * (rows + 1),
                        .springs = bodies * (springs + 2 * columns * rows),
                        .cells = bodies * columns * rows,
                        .outline_edge_count = bodies * 2 * (columns + rows)};
}

/* Returns the body of node, cell or edge i; i becomes its number in the body.
 *   total  number of nodes, cells or edges of all bodies */
static int find_body_and_index(const SquareMesh *shape, int total, int *i)
{
    int each = total / shape->bodies, body = *i / each;
    *i %= each;
    return body;
}

/* Returns the node of column i, row j; nodes are numbered column by column. */
static int find_node(const SquareMesh *shape, int i, int j)
{
    return i * (shape->rows + 1) + j;
}

int square_mesh_find_body(const SquareMesh *shape, int node)
{
    return find_body_and_index(shape, shape->nodes, &node);
}

/* Node (i, j) rests at (-side/2 + i spacing, -height/2 + j spacing). */
void square_mesh_rest_position(const SquareMesh *shape, int i, double x[2])
{
    int stride = find_node(shape, 1, 0);
    find_body_and_index(shape, shape->nodes, &i);
    double step = shape->spacing;
    double high =
        shape->rows == shape->columns ? shape->side : shape->rows * step;
    x[0] = -shape->side / 2 + i / stride * step;
    x[1] = -high / 2 + i % stride * step;
}

int square_mesh_get_node_sides(const SquareMesh *shape, int i)
{
    find_body_and_index(shape, shape->nodes, &i);
    int stride = find_node(shape, 1, 0), column = i / stride, row = i % stride;
    return (column == 0 ? MESH_LEFT : 0) |
           (column == shape->columns ? MESH_RIGHT : 0) |
           (row == 0 ? MESH_BOTTOM : 0) | (row == shape->rows ? MESH_TOP : 0);
}

void square_mesh_get_cell(const SquareMesh *shape, int c, int node[4],
                          int spring[6])
{
    int columns = shape->columns, rows = shape->rows;
    square_mesh_get_cell_patch(shape, c, 1, node);
    int first = find_body_and_index(shape, shape->cells, &c);
    first *= shape->springs / shape->bodies;
    int a = first + c / rows * (rows + 1) + c % rows;
    int upright = first + find_node(shape, columns, 0) + c;
    int diagonals = upright + (columns + 1) * rows + c;
    const int springs[6] = {a,       upright + rows, a + 1,
                            upright, diagonals,      diagonals + 1};
    memcpy(spring, springs, sizeof springs);
}

void square_mesh_get_triangle(const SquareMesh *shape, int t, int node[3],
                              int side[3])
{
    int corner[4], spring[6], k = t % 4, before = (t + 3) % 4;
    square_mesh_get_cell(shape, t / 4, corner, spring);
    node[0] = corner[k];
    node[1] = corner[(k + 1) % 4];
    node[2] = corner[before];
    side[0] = spring[k];
    side[1] = spring[k % 2 ? 4 : 5];
    side[2] = spring[before];
}

int square_mesh_find_cell(const SquareMesh *shape, const double *x,
                          const double *at, int cell, int end)
{
    int node[3], side[3];
    for (int t = 4 * cell; t < 4 * end; t++) {
        square_mesh_get_triangle(shape, t, node, side);
        const double *a = x + 2 * node[0], *b = x + 2 * node[1];
        const double *c = x + 2 * node[2];
        double whole = twice_signed_area(a, b, c), turn = whole < 0 ? -1 : 1;
        if (whole != 0 && turn * twice_signed_area(a, b, at) >= 0 &&
            turn * twice_signed_area(b, c, at) >= 0 &&
            turn * twice_signed_area(c, a, at) >= 0)
            return t / 4;
    }
    return -1;
}

bool square_mesh_get_cell_patch(const SquareMesh *shape, int c, int cells,
                                int node[4])
{
    int columns = shape->columns, rows = shape->rows;
    int first = find_body_and_index(shape, shape->cells, &c);
    first *= shape->nodes / shape->bodies;
    int left = c / rows, low = c % rows;
    int right = left + cells < columns ? left + cells : columns;
    int up = low + cells < rows ? low + cells : rows;
    node[0] = first + find_node(shape, left, low);
    node[1] = first + find_node(shape, right, low);
    node[2] = first + find_node(shape, right, up);
    node[3] = first + find_node(shape, left, up);
    return cells == 1 || (left % cells == 0 && low % cells == 0);
}

/* Returns node k of a body's outline, anticlockwise from the lower left. */
static int get_outline_node(const SquareMesh *shape, int k)
{
    int columns = shape->columns, rows = shape->rows;
    if (k >= columns + rows) /* point reflection of the lower and right sides */
        return find_node(shape, columns, rows) -
               get_outline_node(shape, k - columns - rows);
    return k < columns ? find_node(shape, k, 0)
                       : find_node(shape, columns, k - columns);
}

void square_mesh_get_outline_edge(const SquareMesh *shape, int k, int node[2])
{
    int first = find_body_and_index(shape, shape->outline_edge_count, &k);
    first *= shape->nodes / shape->bodies;
    int next = (k + 1) % (shape->outline_edge_count / shape->bodies);
    node[0] = first + get_outline_node(shape, k);
    node[1] = first + get_outline_node(shape, next);
}

/* Writes the springs from each node (i, j) to (i + right, j + up).  Returns the
 * place in e for the next spring. */
static int *list_springs_of_direction(const SquareMesh *shape, int first,
                                      int *e, int right, int up)
{
    for (int i = 0; i + right <= shape->columns; i++)
        for (int j = 0; j + up <= shape->rows; j++) {
            *e++ = first + find_node(shape, i, j);
            *e++ = first + find_node(shape, i + right, j + up);
        }
    return e;
}

/* Springs have the order of the slide: horizontal, vertical, cell by cell. */
void square_mesh_list_springs(const SquareMesh *shape, int *e)
{
    int each = shape->nodes / shape->bodies, spring[6], c = 0;
    for (int first = 0; first < shape->nodes; first += each) {
        e = list_springs_of_direction(shape, first, e, 1, 0);
        e = list_springs_of_direction(shape, first, e, 0, 1);
        for (int end = c + shape->columns * shape->rows; c < end; c++, e += 4) {
            square_mesh_get_cell(shape, c, e, spring); /* a b c d */
            const int diagonals[4] = {e[0], e[2], e[1], e[3]};
            memcpy(e, diagonals, sizeof diagonals);
        }
    }
}

/* Columns begin[0] ... end[0]-1 and rows begin[1] ... end[1]-1 of the nodes. */
typedef struct GridRegion {
    int begin[2], end[2]; /* first column and row; one past the last */
} GridRegion;

/* Dissection stops at parts of at most this many nodes. */
enum { MAX_LEAF_NODES = 9 };

/* Nested dissection (George 1973).  Numbers the nodes of a part from `next` on:
 * first the two halves, then the line between them, which cuts the longer side.
 * Returns the next free number.
 *   order  out, place of each node of this body */
static int dissect_grid(const SquareMesh *shape, GridRegion part, int next,
                        int *order)
{
    int wide = part.end[0] - part.begin[0], high = part.end[1] - part.begin[1];
    if (wide * high > MAX_LEAF_NODES) {
        int side = wide >= high ? 0 : 1;
        int cut = part.begin[side] + (side == 0 ? wide : high) / 2;
        GridRegion low = part, upper = part;
        low.end[side] = part.begin[side] = cut;
        upper.begin[side] = part.end[side] = cut + 1;
        next = dissect_grid(shape, low, next, order);
        next = dissect_grid(shape, upper, next, order);
    }
    for (int i = part.begin[0]; i < part.end[0]; i++)
        for (int j = part.begin[1]; j < part.end[1]; j++)
            order[find_node(shape, i, j)] = next++;
    return next;
}

void square_mesh_order_nodes(const SquareMesh *shape, int *order)
{
    const GridRegion all = {{0, 0}, {shape->columns + 1, shape->rows + 1}};
    for (int next = 0; next < shape->nodes;)
        next = dissect_grid(shape, all, next, order + next);
}
