/* grid.h - the square of masses and springs as planes of numbers, and E on it.
 *
 * A step's problem is: minimise
 *   E = |x - x_tilde|_M^2 / 2 + sum over springs of c/4 (|d|^2 - l2)^2
 * with d = x_i - x_j and c = 2 w k/l2 for a spring of stiffness k and squared
 * rest length l2 (spring_law.h); w is the weight of P, h^2 for implicit Euler.
 *
 * A row stores its nodes in even columns first, then those in odd columns.  The
 * even nodes of a row are contiguous and share no spring, and so are the odd
 * ones; loops handle several of them at once.  The even nodes of even rows are
 * a coarser grid.  Around the nodes are ghosts, whose springs have stiffness 0.
 * A vector has two planes, all x and then all y; outside the nodes it is 0.
 * Lengths and masses are scaled by powers of two, so that numbers are about 1;
 * the scaling changes no bit of a mantissa.
 *
 * The order of additions does not depend on the width of the registers: each of
 * LANES neighbours has its own partial sum, the partial sums of a band of rows
 * are added in a fixed order, and then the bands.  Results therefore have the
 * same bits everywhere. */
#pragma once

#include <stddef.h>

#include "base/status.h"
#include "solve/incremental_potential.h"

/* Kinds of springs, which lead from node (i, j) to (i+1, j), (i, j+1),
 * (i+1, j+1), (i+1, j-1). */
enum { RIGHT, UP, DIAGONAL, ANTIDIAGONAL, SPRING_KINDS };

/* Nodes that a loop handles at once. */
enum { LANES = 8 };

/* Number of rows in a band. */
enum { BAND_ROWS = 8 };

/* Layout of a plane: where the number of each node is stored. */
typedef struct RowLayout {
    int nodes_per_side;  /* number of nodes in a row, and of rows */
    int column_count[2]; /* number of even and of odd columns */
    int odd_offset;   /* distance from a row's even columns to its odd ones */
    int pitch;        /* distance from one row to the next */
    int plane_length; /* length of a plane, with the ghosts */
} RowLayout;

RowLayout make_row_layout(int nodes);

/* Returns the index of node (i, j) in a plane. */
static inline int node_index(const RowLayout *rows, int i, int j)
{
    return (i + 1) * rows->pitch + (j & 1) * rows->odd_offset + j / 2;
}

typedef struct Grid {
    RowLayout rows;
    int segments, band_count; /* number of segments a side, of bands of rows */
    double length_scale, mass_scale,
        energy_scale; /* grid units per m, kg, J s^2 (unit of E) */
    /* Equal rows of masses or springs are stored once.  Node q of row i has the
     * mass m[q + mass_shift[i]], and the springs that start at node q have the
     * index q + spring_shift[i + 1]; spring_shift[0] is for row -1 (ghosts). */
    int *mass_shift, *spring_shift; /* [nodes_per_side + 1], by row */
    double *c[SPRING_KINDS];  /* [plane] Hessian factor 2 w k/l2; 0: none */
    double *l2[SPRING_KINDS]; /* [plane] squared rest length */
    double *m, *inverse_m; /* [plane] mass and 1/mass; inverse_m is 0 at pins */
    double min_mass;       /* smallest mass of a node that moves */
    double max_node_stiffness;     /* largest 8 c l2: 8 springs at rest */
    float *float_c[SPRING_KINDS];  /* [plane] c in single precision */
    float *float_l2[SPRING_KINDS]; /* [plane] l2 in single precision */
    float *float_m;                /* [plane] mass of each node; 0 at pins */
    float *float_x; /* [2 planes] x relative to the middle node */
    double *x, *x_tilde, *u_tilde; /* [2 planes] u_tilde is x_tilde - x_n */
    double *target_offset; /* [2 planes] x - x_tilde = u - u_tilde; 0 at pins */
} Grid;

/* A block of memory for several arrays.  The layout is made twice: first with
 * base NULL, to count the bytes, then to place the arrays. */
typedef struct ArrayArena {
    char *base;
    size_t used_bytes;
} ArrayArena;

/* Returns the next piece of the block; NULL while bytes are counted.  Pieces of
 * one size would all start in the same lines of the cache, so each starts some
 * lines further than the one before. */
void *arena_take_piece(ArrayArena *memory, size_t bytes);

/* Allocates zeroed memory for all pieces that arena_take_piece counted, in
 * large pages of the system if it has them.  Returns OK or OUT_OF_MEMORY; the
 * caller frees base. */
Status arena_allocate(ArrayArena *memory);

/* Sets sizes and places arrays of segments x segments cells; clears all else.
 */
void grid_init(int segments, ArrayArena *memory, Grid *grid);

/* Returns the power of two that scales a to about 1. */
double power_of_two_scale(double a);

/* Copies pins, stiffnesses and rest lengths of the system, and the masses m
 * [2n] kg, into the grid. */
void grid_copy_from_system(Grid *grid, const Iterate *at, const double *m);

/* Copies x and u of the iterate, and u_tilde [2n] m, into the grid. */
void grid_copy_from_state(Grid *grid, const Iterate *at, const double *u_tilde);

/* Writes u and x of the grid to the iterate. */
void grid_copy_to_iterate(const Grid *grid, Iterate *at);

/* ---- loops over all nodes (grid_energy.c); vectors have [2 planes] ---- */

/* Writes grad E to g and returns |g|_(M^-1)^2.  g has no meaning at pins and
 * outside of the nodes. */
double grid_gradient(const Grid *grid, double *g);

/* Returns |r|_(M^-1)^2 of the linear residual r = -g - H p, with H clamped to
 * be positive semi-definite (psd.h). */
double grid_linear_residual(const Grid *grid, const double *g, const double *p);

/* Writes the quartic E(x + a p) - E(x) = q[0] a + q[1] a^2 + ... + q[3] a^4. */
void grid_energy_quartic(const Grid *grid, const double *p, double quartic[4]);

/* p += beta last_p: the direction p becomes conjugate to last_p, along which x
 * has just moved to the lowest E (Polak and Ribiere 1969).
 *   g, last_g   grad E after and before that step
 *   last_slope  last_g.last_p, below 0
 * Returns beta >= 0. */
double grid_make_p_conjugate(const Grid *grid, const double *g,
                             const double *last_g, const double *last_p,
                             double last_slope, double *p);

/* Moves all nodes alike, so that sum m x is sum m x_tilde, as at the minimum of
 * E where no node is pinned.  Returns the change of E, which is at most 0. */
double grid_correct_momentum(const Grid *grid);

/* Adds a p to x. */
void grid_move_x(const Grid *grid, double a, const double *p);

/* Computes float_x from x. */
void grid_update_float_x(const Grid *grid);
