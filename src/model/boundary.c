/* boundary.c - the boundary of the bodies, and the edges near its points. */
#include "model/boundary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Boundary.near_edge has room for this many edges for each node of the mesh. */
enum { NEAR_EDGES_PER_NODE = 8 };

Status boundary_create(const SquareMesh *mesh, Boundary *boundary)
{
    size_t nodes = (size_t)mesh->nodes, springs = (size_t)mesh->springs;
    size_t bytes =
        4 * nodes * sizeof(double) + (nodes + springs) * sizeof(SweptBox) +
        (2 + NEAR_EDGES_PER_NODE) * nodes * sizeof(int) + springs + nodes;
    *boundary =
        (Boundary){.mesh = *mesh, .system_version = ~0u, .x = calloc(1, bytes)};
    if (!boundary->x)
        return STATUS_OUT_OF_MEMORY;
    boundary->p = boundary->x + 2 * nodes;
    boundary->edge_box = (SweptBox *)(boundary->p + 2 * nodes);
    boundary->point_box = boundary->edge_box + springs;
    boundary->point_node = (int *)(boundary->point_box + nodes);
    boundary->near_list_end = boundary->point_node + nodes;
    boundary->near_edge = boundary->near_list_end + nodes;
    boundary->spring_triangle_count =
        (unsigned char *)(boundary->near_edge + NEAR_EDGES_PER_NODE * nodes);
    boundary->node_role = boundary->spring_triangle_count + springs;
    return STATUS_OK;
}

/* ---- points and edges --------------------------------------------------- */

enum { NODE_IN_TRIANGLE = 1, NODE_ON_EDGE = 2 };

/* Triangle 4 c + k is at corner k of cell c.  If both triangles 1 and 3 are
 * solid, but not both 0 and 2, then 1 and 3 count, else the solid ones of 0 and
 * 2.  As 1 or 3 never counts alone, the solid part of a cell only shrinks. */
static void find_boundary(Boundary *boundary, const System *system)
{
    const SquareMesh *shape = &boundary->mesh;
    memset(boundary->spring_triangle_count, 0, (size_t)shape->springs);
    memset(boundary->node_role, 0, (size_t)shape->nodes);
    boundary->point_count = boundary->edge_count = 0;
    for (int c = 0; c < shape->cells; c++) {
        int node[4][3], side[4][3], solid = 0;
        for (int k = 0; k < 4; k++) {
            square_mesh_get_triangle(shape, 4 * c + k, node[k], side[k]);
            bool broken = spring_is_broken(system, side[k][0]) ||
                          spring_is_broken(system, side[k][1]) ||
                          spring_is_broken(system, side[k][2]);
            solid |= !broken << k;
        }
        bool other = (solid & 5) != 5 && (solid & 10) == 10;
        for (int k = other; k < 4; k += 2)
            for (int i = 0; i < 3 && solid >> k & 1; i++) {
                boundary->node_role[node[k][i]] |= NODE_IN_TRIANGLE;
                boundary->spring_triangle_count[side[k][i]]++;
            }
    }
    for (int s = 0; s < shape->springs; s++) {
        if (boundary->spring_triangle_count[s] != 1)
            continue;
        boundary->edge_box[boundary->edge_count++].edge_spring = s;
        for (int end = 0; end < 2; end++)
            boundary->node_role[system->e[2 * s + end]] |= NODE_ON_EDGE;
    }
    for (int i = 0; i < shape->nodes; i++)
        if (boundary->node_role[i] != NODE_IN_TRIANGLE)
            boundary->point_node[boundary->point_count++] = i;
    boundary->system_version = system->version;
    boundary->has_valid_boxes = false;
}

/* ---- search for near edges ---------------------------------------------- */

static void extend_box(SweptBox *box, int k, double from, double to)
{
    box->low[k] = from < box->low[k] ? from : box->low[k];
    box->high[k] = to > box->high[k] ? to : box->high[k];
}

static const SweptBox empty_box = {
    {INFINITY, INFINITY}, {-INFINITY, -INFINITY}, -1};

/* Orders boxes for qsort: by left side, then by spring. */
static int compare_box_left_sides(const void *one, const void *other)
{
    const SweptBox *a = one, *b = other;
    if (a->low[0] != b->low[0])
        return a->low[0] < b->low[0] ? -1 : 1;
    return a->edge_spring - b->edge_spring;
}

/* Makes and sorts the boxes of the motion relative to the mean motion. */
static void compute_boxes(Boundary *boundary, const System *system)
{
    const double *x = boundary->x, *p = boundary->is_swept ? boundary->p : NULL;
    double *mean = boundary->mean_p;
    boundary->max_box_width = mean[0] = mean[1] = 0;
    SweptBox all = empty_box;
    for (int i = 0; i < boundary->point_count; i++) {
        int node = boundary->point_node[i];
        for (int c = 0; c < 2; c++) {
            extend_box(&all, c, x[2 * node + c], x[2 * node + c]);
            if (p)
                mean[c] += p[2 * node + c] / boundary->point_count;
        }
    }
    boundary->sorts_by_y = all.high[1] - all.low[1] > all.high[0] - all.low[0];
    for (int i = 0; i < boundary->point_count; i++) {
        int node = boundary->point_node[i];
        SweptBox *box = &boundary->point_box[node];
        *box = empty_box;
        for (int c = 0; c < 2; c++) {
            double way = p ? boundary->alpha * (p[2 * node + c] - mean[c]) : 0;
            extend_box(
                box, boundary->sorts_by_y ? 1 - c : c,
                x[2 * node + c] - boundary->box_margin + (way < 0 ? way : 0),
                x[2 * node + c] + boundary->box_margin + (way > 0 ? way : 0));
        }
    }
    for (int k = 0; k < boundary->edge_count; k++) {
        SweptBox *box = &boundary->edge_box[k];
        int s = box->edge_spring;
        const SweptBox *other = &boundary->point_box[system->e[2 * s + 1]];
        *box = boundary->point_box[system->e[2 * s]];
        box->edge_spring = s;
        for (int c = 0; c < 2; c++)
            extend_box(box, c, other->low[c], other->high[c]);
        double wide = box->high[0] - box->low[0];
        boundary->max_box_width =
            wide > boundary->max_box_width ? wide : boundary->max_box_width;
    }
    qsort(boundary->edge_box, (size_t)boundary->edge_count, sizeof(SweptBox),
          compare_box_left_sides);
}

/* Returns the first sorted edge whose box may reach the coordinate `left`. */
static int find_first_edge(const Boundary *boundary, double left)
{
    int low = 0, high = boundary->edge_count;
    while (low < high) {
        int middle = (low + high) / 2;
        if (boundary->edge_box[middle].low[0] < left - boundary->max_box_width)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Returns the result of boundary_near_edge by a search in the sorted boxes. */
static int search_near_edge(const Boundary *boundary, const System *system,
                            int i, int *cursor)
{
    int node = boundary->point_node[i];
    const SweptBox *own = &boundary->point_box[node];
    int k = *cursor > 0 ? *cursor : find_first_edge(boundary, own->low[0]);
    for (; k < boundary->edge_count &&
           boundary->edge_box[k].low[0] <= own->high[0];
         k++) {
        const SweptBox *box = &boundary->edge_box[k];
        const int *end = system->e + 2 * box->edge_spring;
        if (box->low[1] > own->high[1] || box->high[1] < own->low[1] ||
            box->high[0] < own->low[0] || end[0] == node || end[1] == node)
            continue;
        *cursor = k + 1;
        return box->edge_spring;
    }
    *cursor = 0;
    return -1;
}

void boundary_update(Boundary *boundary, const System *system, const double *x,
                     const double *p, double alpha, double margin)
{
    size_t bytes = 2 * (size_t)boundary->mesh.nodes * sizeof *x;
    int room = NEAR_EDGES_PER_NODE * boundary->mesh.nodes, count = 0,
        cursor = 0, edge;
    if (boundary->system_version != system->version)
        find_boundary(boundary, system);
    if (boundary->has_valid_boxes && boundary->is_swept == (p != NULL) &&
        boundary->alpha == alpha && boundary->box_margin == margin &&
        memcmp(boundary->x, x, bytes) == 0 &&
        (!p || memcmp(boundary->p, p, bytes) == 0))
        return;
    boundary->has_valid_boxes = true;
    boundary->is_swept = p != NULL;
    boundary->alpha = alpha;
    boundary->box_margin = margin;
    memcpy(boundary->x, x, bytes);
    if (p)
        memcpy(boundary->p, p, bytes);
    compute_boxes(boundary, system);
    boundary->has_all_near_edges = true;
    for (int i = 0; i < boundary->point_count && boundary->has_all_near_edges;
         i++) {
        while ((edge = search_near_edge(boundary, system, i, &cursor)) >= 0 &&
               count < room)
            boundary->near_edge[count++] = edge;
        boundary->near_list_end[i] = count;
        boundary->has_all_near_edges = edge < 0;
    }
}

int boundary_near_edge(const Boundary *boundary, const System *system, int i,
                       int *cursor)
{
    if (!boundary->has_all_near_edges)
        return search_near_edge(boundary, system, i, cursor);
    int first = i > 0 ? boundary->near_list_end[i - 1] : 0;
    int k = *cursor > 0 ? *cursor : first;
    *cursor = k < boundary->near_list_end[i] ? k + 1 : 0;
    return *cursor > 0 ? boundary->near_edge[k] : -1;
}
