#include "model/square_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

SquareMesh square_mesh_shape(int columns, int rows, double side)
{
    return (SquareMesh){.segments = columns,
                        .rows = rows,
                        .side = side,
                        .spacing = side / columns,
                        .nodes = (columns + 1) * (rows + 1),
                        .springs = columns * (rows + 1) + rows * (columns + 1) +
                                   2 * columns * rows,
                        .cells = columns * rows,
                        .outline = 2 * (columns + rows)};
}

/* x_(i,j) = (-side/2 + i spacing, -high/2 + j spacing) */
void square_mesh_place(const SquareMesh *shape, int i, double x[2])
{
    int row = shape->rows + 1;
    double step = shape->spacing;
    double high =
        shape->rows == shape->segments ? shape->side : shape->rows * step;
    x[0] = -shape->side / 2 + i / row * step;
    x[1] = -high / 2 + i % row * step;
}

int square_mesh_sides(const SquareMesh *shape, int i)
{
    int column = i / (shape->rows + 1), row = i % (shape->rows + 1);
    return (column == 0 ? MESH_LEFT : 0) |
           (column == shape->segments ? MESH_RIGHT : 0) |
           (row == 0 ? MESH_BOTTOM : 0) | (row == shape->rows ? MESH_TOP : 0);
}

void square_mesh_cell(const SquareMesh *shape, int c, int node[4],
                      int spring[6])
{
    int columns = shape->segments, rows = shape->rows, row = rows + 1;
    int a = c / rows * row + c % rows;
    int upright = columns * row + c;
    int diagonals = columns * row + (columns + 1) * rows + 2 * c;
    const int corners[4] = {a, a + row, a + row + 1, a + 1};
    const int springs[6] = {a,       upright + rows, a + 1,
                            upright, diagonals,      diagonals + 1};
    memcpy(node, corners, sizeof corners);
    memcpy(spring, springs, sizeof springs);
}

void square_mesh_triangle(const SquareMesh *shape, int t, int node[3],
                          int side[3])
{
    int corner[4], spring[6], k = t % 4, before = (t + 3) % 4;
    square_mesh_cell(shape, t / 4, corner, spring);
    node[0] = corner[k];
    node[1] = corner[(k + 1) % 4];
    node[2] = corner[before];
    side[0] = spring[k];
    side[1] = spring[k % 2 ? 4 : 5];
    side[2] = spring[before];
}

bool square_mesh_patch(const SquareMesh *shape, int c, int stride, int node[4])
{
    int columns = shape->segments, rows = shape->rows, row = rows + 1;
    int left = c / rows, low = c % rows;
    int right = left + stride < columns ? left + stride : columns;
    int up = low + stride < rows ? low + stride : rows;
    node[0] = left * row + low;
    node[1] = right * row + low;
    node[2] = right * row + up;
    node[3] = left * row + up;
    return left % stride == 0 && low % stride == 0;
}

int square_mesh_outline(const SquareMesh *shape, int k)
{
    int columns = shape->segments, rows = shape->rows, row = rows + 1;
    k %= shape->outline;
    if (k < columns)
        return k * row;
    if (k < columns + rows)
        return columns * row + (k - columns);
    if (k < 2 * columns + rows)
        return (2 * columns + rows - k) * row + rows;
    return shape->outline - k;
}

/* Appends a spring between nodes a and b; returns the place of the next. */
static int *square_mesh_spring(int *e, int a, int b)
{
    e[0] = a;
    e[1] = b;
    return e + 2;
}

/* Springs in the order of the slide: horizontal, vertical, diagonals. */
static void square_mesh_springs(SquareMesh *mesh)
{
    int n_seg = mesh->segments, rows = mesh->rows, row = rows + 1;
    int *e = mesh->e;
    for (int i = 0; i < n_seg; i++)
        for (int j = 0; j <= rows; j++)
            e = square_mesh_spring(e, i * row + j, (i + 1) * row + j);
    for (int i = 0; i <= n_seg; i++)
        for (int j = 0; j < rows; j++)
            e = square_mesh_spring(e, i * row + j, i * row + j + 1);
    for (int i = 0; i < n_seg; i++)
        for (int j = 0; j < rows; j++) {
            int a = i * row + j, b = (i + 1) * row + j;
            e = square_mesh_spring(e, a, b + 1);
            e = square_mesh_spring(e, b, a + 1);
        }
}

/* A rectangle of grid nodes: columns begin[0] ... end[0]-1, rows begin[1] ...
 * end[1]-1. */
typedef struct GridPart {
    int begin[2], end[2];
} GridPart;

/* Parts of at most this many nodes are not cut any further. */
enum { GRID_LEAF = 9 };

/* Nested dissection (George 1973): numbers the nodes of a part from `next` on,
 * the two halves first, the line between them last; returns the next free
 * number.  The longer side is cut, so the line is the shorter one. */
static int dissect_grid(GridPart part, int row, int *order, int next)
{
    int wide = part.end[0] - part.begin[0], high = part.end[1] - part.begin[1];
    if (wide * high > GRID_LEAF) {
        int side = wide >= high ? 0 : 1;
        int cut = part.begin[side] + (side == 0 ? wide : high) / 2;
        GridPart low = part, upper = part;
        low.end[side] = part.begin[side] = cut;
        upper.begin[side] = part.end[side] = cut + 1;
        next = dissect_grid(low, row, order, next);
        next = dissect_grid(upper, row, order, next);
    }
    for (int i = part.begin[0]; i < part.end[0]; i++)
        for (int j = part.begin[1]; j < part.end[1]; j++)
            order[i * row + j] = next++;
    return next;
}

Status square_mesh_create(int columns, int rows, double side, SquareMesh *mesh)
{
    *mesh = (SquareMesh){0};
    if (columns < 1 || columns > SQUARE_MESH_MAX_SEGMENTS || rows < 1 ||
        rows > SQUARE_MESH_MAX_SEGMENTS || !isfinite(side) || !(side > 0))
        return STATUS_INVALID_INPUT;
    *mesh = square_mesh_shape(columns, rows, side);
    size_t n = (size_t)mesh->nodes, springs = (size_t)mesh->springs;
    mesh->x = malloc(2 * n * sizeof *mesh->x);
    mesh->e = malloc(2 * springs * sizeof *mesh->e);
    mesh->order = malloc(n * sizeof *mesh->order);
    if (!mesh->x || !mesh->e || !mesh->order)
        return STATUS_OUT_OF_MEMORY;
    for (int i = 0; i < mesh->nodes; i++)
        square_mesh_place(mesh, i, mesh->x + 2 * i);
    square_mesh_springs(mesh);
    GridPart all = {{0, 0}, {columns + 1, rows + 1}};
    dissect_grid(all, rows + 1, mesh->order, 0);
    return STATUS_OK;
}

void square_mesh_free(SquareMesh *mesh)
{
    if (!mesh)
        return;
    free(mesh->x);
    free(mesh->e);
    free(mesh->order);
    *mesh = (SquareMesh){0};
}
