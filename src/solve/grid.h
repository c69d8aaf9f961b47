/* grid.h - the square of masses and springs as planes of numbers, and E on it.
 *
 * A step's problem is: minimise
 *   E = |x - x_tilde|_M^2 / 2 + sum over springs of c/4 (|d|^2 - l2)^2,
 * d = x_i - x_j, c = 2 w k/l2 (spring_law.h).
 *
 * A row of nodes stands with its even columns first, then its odd ones.  So
 * the nodes of a row that are `even` or `odd` are contiguous, no two of them
 * share a spring, loops go through them several nodes at once, and the even
 * ones of even rows are a coarser grid.  Around the nodes are ghosts, whose
 * springs have stiffness 0.  A vector has two planes, all x and then all y;
 * outside the nodes it is 0.  Lengths and masses have units of the
 * grid, powers of two near those of a cell, which change no bit: its numbers
 * are about 1.
 *
 * Sums have one shape whatever the width of the registers: each of LANES
 * neighbours has a part of its own, these add up in a fixed order for each band
 * of rows, and the bands in theirs.  So the bits are the same everywhere.
 */
#ifndef ELASTO_GRID_H
#define ELASTO_GRID_H

#include <stddef.h>

#include "base/status.h"
#include "solve/incremental_potential.h"

/* Kinds of springs, which lead from node (i, j) to (i+1, j), (i, j+1),
 * (i+1, j+1), (i+1, j-1). */
enum { RIGHT, UP, DIAGONAL, ANTIDIAGONAL, KINDS };

/* Nodes at once in double and in single precision. */
enum { LANES = 8, WIDE_LANES = 16 };

/* The nodes of half a row are padded to a multiple of PADDED, for whole
 * vectors; in a browser vectors are shorter. */
#ifdef __wasm_simd128__
enum { PADDED = LANES };
#else
enum { PADDED = WIDE_LANES };
#endif

/* Rows of a band. */
enum { BAND = 8 };

/* Where the numbers of nodes x nodes nodes stand. */
typedef struct Rows {
    int nodes;    /* number of nodes in a row, and of rows: n + 1 */
    int count[2]; /* even and odd columns */
    int half;     /* from a row's even columns to its odd ones */
    int pitch;    /* from one row to the next */
    int plane;    /* numbers of one component */
} Rows;

Rows lay_out_rows(int nodes);

/* Returns the place of node (i, j). */
static inline int node_place(const Rows *rows, int i, int j)
{
    return (i + 1) * rows->pitch + (j & 1) * rows->half + j / 2;
}

typedef struct Grid {
    Rows rows;
    int segments, bands;
    double length, mass, energy; /* units of the grid: 1/m, 1/kg, 1/(J s^2) */
    /* Rows with the same masses, or the same springs, share one place: masses
     * of row i stand node_shift[i] further than its nodes, springs of row i
     * spring_shift[i + 1] further. */
    int *node_shift, *spring_shift; /* [nodes + 1] */
    double *c[KINDS];               /* [plane] 0: no spring */
    double *l2[KINDS];              /* [plane] */
    double *m, *per_m;              /* [plane] per_m: 0 for pins */
    double lightest;                /* smallest mass of a node that moves */
    double *x, *x_tilde, *u_tilde;  /* [2 planes] */
    double *away;                   /* [2 planes] x - x_tilde in the digits of
                                       u; pins: 0 */
} Grid;

/* Pieces of one block of memory, which is laid out twice: first to count, with
 * base NULL, then in earnest. */
typedef struct Memory {
    char *base;
    size_t used;
} Memory;

/* The next piece.  Arrays of one size would all stand in the same lines of the
 * cache, so each starts some lines further than the one before. */
void *memory_take_piece(Memory *memory, size_t bytes);

/* Allocates zeroed memory for all pieces that memory_take_piece counted, in
 * large pages of the system if it has them.  Returns OK or OUT_OF_MEMORY; the
 * caller frees base. */
Status memory_create(Memory *memory);

/* Arrays for segments x segments cells, everything else 0. */
void grid_lay_out(int segments, Memory *memory, Grid *grid);

/* The power of two that makes a number about 1. */
double power_of_two_scale(double a);

/* Pins, stiffnesses and lengths of the system; m [2n] kg, masses. */
void grid_read_system(Grid *grid, const Iterate *at, const double *m);

/* x and away, with u_tilde [2n] m. */
void grid_read_state(Grid *grid, const Iterate *at, const double *u_tilde);

/* at->u = u_tilde + away, but for pins, and at->x. */
void grid_write_state(const Grid *grid, Iterate *at);

/* ---- loops over all nodes (grid_energy.c); vectors have [2 planes] ---- */

/* g = grad E; returns |g|_(M^-1)^2.  At pins and outside g is anything. */
double grid_gradient(const Grid *grid, double *g);

/* |g + H p|_(M^-1)^2, H clamped to be positive semi-definite (psd.h).
 *   largest  out, max over nodes of |p_x| + |p_y| */
double grid_linear_residual(const Grid *grid, const double *g, const double *p,
                            double *largest);

/* E(x + a p) - E(x) = q[0] a + q[1] a^2 + q[2] a^3 + q[3] a^4; q out. */
void grid_line_polynomial(const Grid *grid, const double *g, const double *p,
                          double quartic[4]);

/* Moves all nodes alike, so that sum m x is sum m x_tilde, as at the minimum of
 * E where no node is pinned.  Returns the change of E, which is at most 0. */
double grid_correct_momentum(const Grid *grid);

/* x += a p */
void grid_add_step(const Grid *grid, double a, const double *p);

#endif
