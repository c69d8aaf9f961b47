/* tips.h - where folds run: local minimisation between global steps.
 *
 * When the square buckles, a dislocation of some ten nodes runs along a
 * column, less than a cell for each Newton direction of the whole square.  Here
 * only windows around such tips move, by a nonlinear conjugate gradient method
 * with exact line search, preconditioned by the Hessian's diagonal blocks
 * (nonlinear elimination).  Nodes outside stay, so that E falls as much as the
 * windows say; and windows that are apart are minimised each by itself, by two
 * threads.
 */
#ifndef ELASTO_TIPS_H
#define ELASTO_TIPS_H

#include "solve/grid.h"

/* The activity of a row's blocks. */
typedef struct TipRow {
    double sum, most;
} TipRow;

/* Nodes that move together.  Windows are so far from each other that neither
 * changes what the other computes. */
typedef struct TipWindow {
    GridRegion inside; /* nodes that move */
    GridRegion starts; /* where springs start that they change */
    double *sums;      /* [runs of both * GRID_MAX_SUMS] */
    double change;     /* of E */
    int iterations;
} TipWindow;

typedef struct Tips {
    const Grid *grid;
    double *activity;    /* [rows * blocks] g.D g of each block */
    TipRow *row;         /* [rows] */
    unsigned char *mark; /* [rows * blocks] 0, but while regions are made */
    int first, end;      /* rows with marks */
    bool weighed;        /* D is of this step; the owner sets it to false */
    TipWindow *window;   /* [windows] of a phase */
    int windows;
    GridRegion inside, starts; /* of all of them, one after the other */
    GridRegion around;         /* what is inside, and all neighbours */
    double *sums;              /* of all windows */
    void *memory;              /* of these vectors */
    double *D, *z, *p;         /* [3 planes], [2 planes] */
    double *g,
        *old_g; /* [2 planes] in the windows, by turns: last two grad E */
    long phases, iterations; /* done so far, all windows' */
} Tips;

/* For this grid, which must outlive it.  Returns OK, OUT_OF_MEMORY; free it in
 * any case. */
Status tips_create(const Grid *grid, Tips *tips);
void tips_free(Tips *tips);

/* Moves windows until no part of the square stands out, or iterations of the
 * whole square lower E faster.
 *   global  by how much the last of these changed E, < 0
 *   g       [2 planes] out, grad E where that has led
 * Returns by how much E has changed, <= 0. */
double tips_minimise(Tips *tips, double global, double *g);

#endif
