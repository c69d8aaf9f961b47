#include "model/square_mesh.h"

#include <math.h>
#include <stdlib.h>

/* x_(i,j) = (-side/2 + i step, -high/2 + j step), step = side/segments */
static void square_mesh_nodes(SquareMesh *mesh)
{
    int row = mesh->rows + 1;
    double step = mesh->side / mesh->segments;
    double high = mesh->rows == mesh->segments ? mesh->side : mesh->rows * step;
    for (int i = 0; i <= mesh->segments; i++)
        for (int j = 0; j < row; j++) {
            double *x = mesh->x + 2 * (i * row + j);
            x[0] = -mesh->side / 2 + i * step;
            x[1] = -high / 2 + j * step;
        }
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
    *mesh = (SquareMesh){.segments = columns, .rows = rows, .side = side};
    if (columns < 1 || columns > SQUARE_MESH_MAX_SEGMENTS || rows < 1 ||
        rows > SQUARE_MESH_MAX_SEGMENTS || !isfinite(side) || !(side > 0))
        return STATUS_INVALID_INPUT;
    mesh->nodes = (columns + 1) * (rows + 1);
    mesh->springs =
        columns * (rows + 1) + rows * (columns + 1) + 2 * columns * rows;
    size_t n = (size_t)mesh->nodes, springs = (size_t)mesh->springs;
    mesh->x = malloc(2 * n * sizeof *mesh->x);
    mesh->e = malloc(2 * springs * sizeof *mesh->e);
    mesh->order = malloc(n * sizeof *mesh->order);
    if (!mesh->x || !mesh->e || !mesh->order)
        return STATUS_OUT_OF_MEMORY;
    square_mesh_nodes(mesh);
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
