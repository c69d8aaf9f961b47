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

Status square_mesh_create(int segments, double side, SquareMesh *mesh)
{
    return square_mesh_create_beam(segments, segments, side, mesh);
}

static void order_grid(int columns, int rows, int *order);

Status square_mesh_create_beam(int columns, int rows, double side,
                               SquareMesh *mesh)
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
    order_grid(columns, rows, mesh->order);
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

/* A rectangle of grid nodes: columns i0 ... i1-1, rows j0 ... j1-1. */
typedef struct GridPart {
    int i0, i1, j0, j1;
} GridPart;

/* Parts of at most this many nodes are not cut any further. */
enum { GRID_LEAF = 9 };

/* Numbers the nodes of a part from `next` on; returns the next free number.
 * The longer side is cut, so the line between the halves is the shorter. */
static int dissect_grid(GridPart part, int row, int *order, int next)
{
    int wide = part.i1 - part.i0, high = part.j1 - part.j0;
    if (wide * high > GRID_LEAF && wide >= high) {
        int cut = part.i0 + wide / 2;
        GridPart left = part, right = part;
        left.i1 = cut;
        right.i0 = cut + 1;
        next = dissect_grid(left, row, order, next);
        next = dissect_grid(right, row, order, next);
        part.i0 = cut;
        part.i1 = cut + 1;
    } else if (wide * high > GRID_LEAF) {
        int cut = part.j0 + high / 2;
        GridPart low = part, upper = part;
        low.j1 = cut;
        upper.j0 = cut + 1;
        next = dissect_grid(low, row, order, next);
        next = dissect_grid(upper, row, order, next);
        part.j0 = cut;
        part.j1 = cut + 1;
    }
    for (int i = part.i0; i < part.i1; i++)
        for (int j = part.j0; j < part.j1; j++)
            order[i * row + j] = next++;
    return next;
}

static void order_grid(int columns, int rows, int *order)
{
    dissect_grid((GridPart){0, columns + 1, 0, rows + 1}, rows + 1, order, 0);
}

void square_mesh_order(int segments, int *order)
{
    order_grid(segments, segments, order);
}
