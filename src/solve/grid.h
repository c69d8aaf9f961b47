/* grid.h - the square of masses and springs as rows of numbers, for kernels
 * that go through it several nodes at once.
 *
 * Node (i, j) stands at grid_at: rows of `pitch` numbers, padded to whole
 * blocks of 8 nodes, with a ring of ghosts around whose springs have stiffness
 * 0.  A vector has two planes, all x and then all y; padding and ghosts are 0.
 * Springs of four kinds belong to their first node.
 *
 * Sums have one shape whatever the width of the lanes and the number of
 * threads: node j of a run adds to partial sum j mod 8, these 8 add up in a
 * fixed order, and the runs in theirs.  So the bits are the same everywhere.
 */
#ifndef ELASTO_GRID_H
#define ELASTO_GRID_H

#include <stddef.h>

#include "base/crew.h"
#include "base/status.h"

/* From node (i, j): to (i+1, j), (i, j+1), (i+1, j+1), (i+1, j-1). */
enum {
    SPRING_RIGHT,
    SPRING_UP,
    SPRING_DIAGONAL,
    SPRING_ANTIDIAGONAL,
    SPRING_KINDS
};

/* Nodes of a block; empty places before each row, a whole cache line even in
 * single precision. */
enum { GRID_BLOCK = 8, GRID_LEAD = 16 };

enum { GRID_MAX_SUMS = 16 };

/* Where numbers of a grid of `nodes` x `nodes` nodes stand. */
typedef struct GridLayout {
    int nodes;                /* of a row, and rows: n + 1 */
    int pitch;                /* from one row to the next */
    int blocks;               /* of a row */
    int plane;                /* numbers of one component */
    int offset[SPRING_KINDS]; /* from a spring's first node to its second */
} GridLayout;

GridLayout grid_layout(int nodes);

/* The place of node (i, j). */
static inline int grid_at(const GridLayout *layout, int i, int j)
{
    return (i + 1) * layout->pitch + GRID_LEAD + j;
}

/* Some nodes: runs of whole blocks. */
typedef struct GridRun {
    int row, first; /* block of 8 nodes */
    int blocks;     /* so many */
} GridRun;

typedef struct GridRegion {
    int runs, blocks; /* in all */
    GridRun *run;
} GridRegion;

/* The place of a run's first node. */
static inline int grid_start(const GridLayout *layout, GridRun run)
{
    return grid_at(layout, run.row, GRID_BLOCK * run.first);
}

typedef struct GridKernels GridKernels;

/* A step's problem: minimise
 *   E = |u - u_tilde|_M^2/2 + sum over springs of c/4 (|d|^2 - l2)^2,
 * d = x_i - x_j, x = x_n + u, c = 2 w k/l2 (mass_spring_energy.h). */
typedef struct Grid {
    int segments; /* n */
    GridLayout layout;
    /* m and per_mass, c and l2: rows with the same numbers share one place.
     * Those of node (i, j) stand at grid_at(i, j) + grid_shift(shift, i). */
    int *node_shift, *spring_shift; /* [nodes + 2] */
    double *c[SPRING_KINDS];        /* [plane] kg/m^2; 0: no spring */
    double *l2[SPRING_KINDS];       /* [plane] m^2; not where all are equal */
    double rest[SPRING_KINDS];      /* m^2, l2 where all of a kind are equal */
    bool uniform;                   /* they are, in each kind */
    double *m;                      /* [plane] kg; 0 outside */
    double *per_mass;               /* [plane] 1/kg; 0 outside and for pins */
    bool pinned;                    /* some node never moves */
    double lightest;                /* kg, of the nodes that move */
    double *x_n, *u, *x, *u_tilde;  /* [2 planes] m */
    void *memory;                   /* all of these */
    GridRegion all;
    double *sums; /* [nodes * GRID_MAX_SUMS] of the runs */
    const GridKernels *kernels;
    Crew *crew; /* who works; not owned, NULL: the caller alone */
} Grid;

/* How far from its places the numbers of row i stand; i is -1 for ghosts. */
static inline int grid_shift(const int *shift, int i)
{
    return shift[i + 1];
}

/* Allocates for segments x segments cells.
 *   lanes  numbers at once: 2, 4, 8, or 0 for the most this processor has
 * Returns OK, TOO_LARGE, OUT_OF_MEMORY; free it in any case. */
Status grid_create(int segments, int lanes, Grid *grid);
void grid_free(Grid *grid);

/* Zeros for so many planes, for free(), or NULL. */
double *grid_planes(const Grid *grid, int planes);

/* The same for many, which the caller divides.  They are in
 * large pages: a kernel reads up to thirty planes at once, more than the
 * processor has small pages at hand.
 *   memory  out, for free() */
double *grid_piece(const Grid *grid, int planes, void **memory);
void *grid_memory(size_t bytes, void **memory);

/* An empty region with room for every node: at most so many runs a row.
 * Returns OK, OUT_OF_MEMORY. */
Status grid_region_create(const Grid *grid, GridRegion *region);

/* Masses and pins.  m [n] kg in; pinned [n] in or NULL. */
void grid_set_nodes(Grid *grid, const double *m, const unsigned char *pinned);

/* Springs in the order of square_mesh.h.  k, l2 [springs] in (k 0: broken);
 * weight w, s^2. */
void grid_set_springs(Grid *grid, const double *k, const double *l2,
                      double weight);

/* Between vectors of the system, [2n] x and y by turns, and of the grid. */
void grid_pack(const Grid *grid, const double *from, double *to);
void grid_unpack(const Grid *grid, const double *from, double *to);

/* ---- kernels; region NULL: all nodes, and what is written is 0 outside ----
 */

/* g = grad E; returns |g|_(M^-1)^2. */
double grid_gradient(const Grid *grid, const GridRegion *region, double *g);

/* y = H q, H clamped to be positive semi-definite (psd.h) or as it is; returns
 * q.y. */
double grid_product(const Grid *grid, bool clamped, const double *q, double *y);

/* D = inverse of the clamped Hessian's 2x2 diagonal blocks, [3 planes]: xx, xy,
 * yy; 0 for pins. */
void grid_diagonal(const Grid *grid, const GridRegion *region, double *D);

/* g = grad E, z = D g; returns g.z and, in *old, old_g.z. */
double grid_precondition(const Grid *grid, const GridRegion *region,
                         const double *D, const double *old_g, double *g,
                         double *z, double *old);

/* p = beta p - z; returns g.p and, in *inertia, |p|_M^2. */
double grid_direction(const Grid *grid, const GridRegion *region,
                      const double *z, double beta, const double *g, double *p,
                      double *inertia);

/* E(x + a p) - E(x) = slope a + q[1] a^2 + q[2] a^3 + q[3] a^4.
 *   region   all springs of nodes that p moves start in it
 *   slope    g.p; inertia |p|_M^2 */
void grid_along(const Grid *grid, const GridRegion *region, const double *p,
                double slope, double inertia, double q[4]);

/* E(x + a p + b r) - E(x), 14 coefficients as in quartic.h. */
void grid_in_plane(const Grid *grid, const double *g, const double *p,
                   const double *r, double c[14]);

/* r = a p + b r, u += r, x = x_n + u; r NULL: u += a p. */
void grid_move(const Grid *grid, const GridRegion *region, double a,
               const double *p, double b, double *r);

/* a[block] = g.D g of each block, row by row. */
void grid_activity(const Grid *grid, const GridRegion *region, const double *D,
                   const double *g, double *activity);

/* a = 0, everywhere, padding and ghosts too, or in a region. */
void grid_clear(const Grid *grid, double *a);
void grid_region_clear(const Grid *grid, const GridRegion *region, double *a);

/* a.b; |a|_(M^-1)^2; max over nodes of |a_x| + |a_y|. */
double grid_dot(const Grid *grid, const double *a, const double *b);
double grid_inverse_mass_square(const Grid *grid, const double *a);
double grid_largest(const Grid *grid, const double *a);

/* y = alpha x + beta y; beta 0: whatever y holds. */
void grid_combine(const Grid *grid, const GridRegion *region, double alpha,
                  const double *x, double beta, double *y);

#endif
