#include "solve/gauss_seidel.h"

#include <stdlib.h>
#include <string.h>

#include "model/central_field.h"
#include "solve/line_search.h"

/* More sweeps, fewer iterations: there and back once took the least time, if
 * not by much, over stretches of 0.6 ... 2.5 at 32 and 64 segments. */
enum { SWEEPS = 2 };

/* Which springs end at each node, and each node's colour; only needed while
 * the groups are made. */
typedef struct Lists {
    int *start;  /* [n + 1] first of each node's springs */
    int *end;    /* [2 springs] places in System's e */
    int *colour; /* [n], from 0; -1: pinned, does not move */
    int colours;
} Lists;

/* By counting: start[i + 1] is first where node i's list is being filled, then
 * where it ends. */
static void list_springs(const System *system, Lists *lists)
{
    int *start = lists->start, ends = 2 * system->springs;
    for (int t = 0; t < ends; t++)
        if (system->e[t] + 2 <= system->nodes)
            start[system->e[t] + 2]++;
    for (int i = 2; i <= system->nodes; i++)
        start[i] += start[i - 1];
    for (int t = 0; t < ends; t++)
        lists->end[start[system->e[t] + 1]++] = t;
}

/* The first colour that no neighbour has; mark [n] holds, for each colour, the
 * last node that could not take it. */
static void colour_nodes(const System *system, int *mark, Lists *lists)
{
    for (int i = 0; i < system->nodes; i++)
        lists->colour[i] = mark[i] = -1;
    for (int i = 0; i < system->nodes; i++) {
        if (system->pinned && system->pinned[i])
            continue;
        for (int t = lists->start[i]; t < lists->start[i + 1]; t++) {
            int j = system->e[lists->end[t] ^ 1];
            if (lists->colour[j] >= 0)
                mark[lists->colour[j]] = i;
        }
        int colour = 0;
        while (mark[colour] == i)
            colour++;
        lists->colour[i] = colour;
        if (colour >= lists->colours)
            lists->colours = colour + 1;
    }
}

/* Spring t of the node's list into a lane, or one without stiffness. */
static void fill_lane(const System *system, const Lists *lists, int i, int t,
                      int lane, SpringLanes *springs)
{
    springs->other[lane] = i;
    springs->l2[lane] = 1;
    springs->c[lane] = 0;
    if (lists->start[i] + t >= lists->start[i + 1])
        return;
    int end = lists->end[lists->start[i] + t], s = end / 2;
    springs->other[lane] = system->e[end ^ 1];
    springs->l2[lane] = system->l2[s];
    springs->c[lane] = 2 * system->k[s] / system->l2[s];
}

/* The nodes in group->node, with as many springs as the one with most; without
 * an array they are only counted. */
static void add_group(const System *system, const Lists *lists, NodeLanes group,
                      GaussSeidel *smoother, int *springs)
{
    int most = 0;
    for (int lane = 0; lane < LANES; lane++) {
        int i = group.node[lane];
        int count = lists->start[i + 1] - lists->start[i];
        most = count > most ? count : most;
    }
    for (int t = 0; t < most && smoother->spring; t++)
        for (int lane = 0; lane < LANES; lane++)
            fill_lane(system, lists, group.node[lane], t, lane,
                      &smoother->spring[*springs + t]);
    *springs += most;
    group.end = *springs;
    if (smoother->group)
        smoother->group[smoother->groups] = group;
    smoother->groups++;
}

/* Colour by colour, LANES nodes at a time; the last of a colour fills the lanes
 * that are left, and is moved in one of them. */
static int add_groups(const System *system, const Lists *lists,
                      GaussSeidel *smoother)
{
    int springs = 0;
    smoother->groups = 0;
    for (int colour = 0; colour < lists->colours; colour++) {
        NodeLanes group = {{0}, 0};
        int used = 0;
        for (int i = 0; i < system->nodes; i++) {
            if (lists->colour[i] != colour)
                continue;
            for (int lane = used; lane < LANES; lane++)
                group.node[lane] = i;
            if (++used == LANES) {
                add_group(system, lists, group, smoother, &springs);
                used = 0;
            }
        }
        if (used > 0)
            add_group(system, lists, group, smoother, &springs);
    }
    return springs;
}

static Status create_groups(const System *system, Lists *lists, int *mark,
                            GaussSeidel *smoother)
{
    list_springs(system, lists);
    colour_nodes(system, mark, lists);
    size_t springs = (size_t)add_groups(system, lists, smoother);
    smoother->group =
        malloc(((size_t)smoother->groups + 1) * sizeof *smoother->group);
    smoother->spring = malloc((springs + 1) * sizeof *smoother->spring);
    if (!smoother->group || !smoother->spring) {
        gauss_seidel_free(smoother);
        return STATUS_OUT_OF_MEMORY;
    }
    add_groups(system, lists, smoother);
    return STATUS_OK;
}

Status gauss_seidel_create(const System *system, GaussSeidel *smoother)
{
    *smoother = (GaussSeidel){0};
    size_t n = (size_t)system->nodes, ends = 2 * (size_t)system->springs;
    Lists lists = {calloc(n + 1, sizeof(int)), calloc(ends + 1, sizeof(int)),
                   malloc(n * sizeof(int)), 0};
    int *mark = malloc(n * sizeof(int));
    Status status = STATUS_OUT_OF_MEMORY;
    if (lists.start && lists.end && lists.colour && mark)
        status = create_groups(system, &lists, mark, smoother);
    free(lists.start);
    free(lists.end);
    free(lists.colour);
    free(mark);
    return status;
}

void gauss_seidel_free(GaussSeidel *smoother)
{
    if (!smoother)
        return;
    free(smoother->group);
    free(smoother->spring);
    *smoother = (GaussSeidel){0};
}

/* Gradient and upper triangle of the projected Hessian of the springs at the
 * nodes of a group. */
typedef struct Block {
    Lanes g0, g1, H0, H1, H2;
} Block;

/* A spring's block is iso I + along d d^T with, for t = |d|^2 - l2,
 *   iso = c max(t, 0),  along = c max(2 + min(t, 0)/|d|^2, 0),
 * which is spring_hessian_psd without a branch. */
static inline void add_spring(const SpringLanes *spring, const double *x,
                              Lanes x0, Lanes x1, Block *sum)
{
    Lanes other0 = {0}, other1 = {0};
    for (int lane = 0; lane < LANES; lane++) {
        other0[lane] = x[2 * spring->other[lane]];
        other1[lane] = x[2 * spring->other[lane] + 1];
    }
    Lanes d0 = x0 - other0, d1 = x1 - other1, c = lanes_load(spring->c);
    Lanes d2 = d0 * d0 + d1 * d1, t = d2 - lanes_load(spring->l2);
    Lanes iso = c * lanes_where(t > 0, t);
    Lanes along = 2 + lanes_where(t < 0, t) / d2;
    along = c * lanes_where(along > 0, along);
    sum->g0 += c * t * d0;
    sum->g1 += c * t * d1;
    sum->H0 += iso + along * d0 * d0;
    sum->H1 += along * d0 * d1;
    sum->H2 += iso + along * d1 * d1;
}

/* The node's Newton step.  Where rounding has eaten the masses the block may be
 * singular: then the node stays. */
static void move_node(const IncrementalPotential *E, int i, int lane,
                      const Block *sum, double *u, double *x)
{
    double w = E->weight, m = E->system->m[i],
           field = w * central_field_omega2(E->system);
    double *ui = u + 2 * i, *xi = x + 2 * i;
    const double *target = E->u_tilde + 2 * i;
    double g0 = w * sum->g0[lane] + m * (ui[0] - target[0] + field * xi[0]);
    double g1 = w * sum->g1[lane] + m * (ui[1] - target[1] + field * xi[1]);
    double a = w * sum->H0[lane] + m + field * m;
    double b = w * sum->H1[lane];
    double c = w * sum->H2[lane] + m + field * m;
    double det = a * c - b * b;
    if (!(det > 1e-12 * a * c))
        return;
    ui[0] -= (c * g0 - b * g1) / det;
    ui[1] -= (a * g1 - b * g0) / det;
    xi[0] = E->x_n[2 * i] + ui[0];
    xi[1] = E->x_n[2 * i + 1] + ui[1];
}

/* Being of one colour, they do not see each other move. */
static void move_group(const GaussSeidel *smoother,
                       const IncrementalPotential *E, int k, double *u,
                       double *x)
{
    const NodeLanes *group = &smoother->group[k];
    Block sum = {{0}, {0}, {0}, {0}, {0}};
    Lanes x0 = {0}, x1 = {0};
    for (int lane = 0; lane < LANES; lane++) {
        x0[lane] = x[2 * group->node[lane]];
        x1[lane] = x[2 * group->node[lane] + 1];
    }
    for (int t = k > 0 ? group[-1].end : 0; t < group->end; t++)
        add_spring(&smoother->spring[t], x, x0, x1, &sum);
    for (int lane = 0; lane < LANES; lane++)
        if (lane == 0 || group->node[lane] != group->node[lane - 1])
            move_node(E, group->node[lane], lane, &sum, u, x);
}

void gauss_seidel_sweep(const GaussSeidel *smoother,
                        const IncrementalPotential *E, bool backward, double *u,
                        double *x)
{
    for (int k = 0; k < smoother->groups; k++)
        move_group(smoother, E, backward ? smoother->groups - 1 - k : k, u, x);
}

int gauss_seidel_smooth(const GaussSeidel *smoother,
                        const IncrementalPotential *E, const double *g,
                        double *u, double *x, double *s, double *change)
{
    int size = 2 * E->system->nodes, trials = 0;
    double alpha = 1;
    memcpy(s, u, (size_t)size * sizeof *s);
    for (int i = 0; i < SWEEPS; i++)
        gauss_seidel_sweep(smoother, E, i % 2, u, x);
    for (int i = 0; i < size; i++) {
        double start = s[i];
        s[i] = u[i] - start;
        u[i] = start;
        x[i] = E->x_n[i] + start;
    }
    Iterate at = {*E, u, x, (double *)g, s};
    Along along = incremental_potential_along(&at, 1);
    if (line_search_backtrack(along_difference, &along, &alpha, &trials))
        alpha = 0;
    *change = alpha > 0 ? along_difference(&along, alpha) : 0;
    for (int i = 0; i < size; i++) {
        s[i] = alpha > 0 ? alpha * s[i] : 0;
        u[i] += s[i];
        x[i] = E->x_n[i] + u[i];
    }
    return trials;
}
