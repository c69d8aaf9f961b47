#include "solve/tips.h"

#include <stdlib.h>
#include <string.h>

#include "base/quartic.h"

/* Phases, each with its windows, and iterations in one. */
enum { TIP_PHASES = 20, TIP_ITERATIONS = 40, TIP_DIAGONAL_EVERY = 10 };

/* A tip is a block this much more active than all are on average.  Windows are
 * around the blocks with this share of the largest activity, so many rows and
 * blocks beyond them, and cover at most this share of the square. */
static const double TIP_STANDS_OUT = 20, TIP_ACTIVE = 0.1,
                    TIP_LARGEST_SHARE = 0.5;
enum { TIP_ROWS = 8, TIP_BLOCKS = 1 };

/* Below so many segments windows may be all of it: directions of the whole
 * square are no better there. */
enum { TIP_SMALL_SQUARE = 48 };

/* A phase ends when g.D g fell to this share; 0.02 ... 0.3 measured about the
 * same. */
static const double TIP_ENOUGH = 0.1;

Status tips_create(const Grid *grid, Tips *tips)
{
    *tips = (Tips){.grid = grid};
    size_t blocks = (size_t)grid->all.blocks;
    tips->activity = malloc(blocks * sizeof *tips->activity);
    tips->mark = malloc(blocks);
    tips->spread = malloc(blocks);
    tips->D = grid_planes(grid, 3);
    tips->z = grid_planes(grid, 2);
    tips->p = grid_planes(grid, 2);
    tips->old_g = grid_planes(grid, 2);
    if (!tips->activity || !tips->mark || !tips->spread || !tips->D ||
        !tips->z || !tips->p || !tips->old_g ||
        grid_region_create(grid, &tips->inside))
        return STATUS_OUT_OF_MEMORY;
    return grid_region_create(grid, &tips->around);
}

void tips_free(Tips *tips)
{
    if (!tips)
        return;
    free(tips->activity);
    free(tips->mark);
    free(tips->spread);
    free(tips->D);
    free(tips->z);
    free(tips->p);
    free(tips->old_g);
    free(tips->inside.run);
    free(tips->around.run);
    *tips = (Tips){0};
}

/* to = from and all that is at most so many rows and blocks away. */
static void dilate(const Grid *grid, const unsigned char *from, int rows,
                   int blocks, unsigned char *to)
{
    int width = grid->layout.blocks, height = grid->layout.nodes;
    memset(to, 0, (size_t)width * (size_t)height);
    for (int i = 0; i < height; i++)
        for (int b = 0; b < width; b++) {
            if (!from[i * width + b])
                continue;
            int first = b > blocks ? b - blocks : 0;
            int past = b + blocks < width ? b + blocks + 1 : width;
            for (int row = i > rows ? i - rows : 0;
                 row <= i + rows && row < height; row++)
                memset(to + row * width + first, 1, (size_t)(past - first));
        }
}

/* The windows of a phase; false where there is none, or too much is one. */
static bool choose_windows(Tips *tips)
{
    const Grid *grid = tips->grid;
    int blocks = grid->all.blocks;
    double sum = 0, most = 0;
    for (int b = 0; b < blocks; b++) {
        sum += tips->activity[b];
        most = tips->activity[b] > most ? tips->activity[b] : most;
    }
    if (!(most >= TIP_STANDS_OUT * sum / blocks))
        return false;
    for (int b = 0; b < blocks; b++)
        tips->mark[b] = tips->activity[b] >= TIP_ACTIVE * most;
    dilate(grid, tips->mark, TIP_ROWS, TIP_BLOCKS, tips->spread);
    grid_region_mark(grid, tips->spread, &tips->inside);
    if (grid->segments >= TIP_SMALL_SQUARE &&
        tips->inside.blocks > TIP_LARGEST_SHARE * blocks)
        return false;
    dilate(grid, tips->spread, 1, 1, tips->mark);
    grid_region_mark(grid, tips->mark, &tips->around);
    return true;
}

/* Nonlinear conjugate gradients (Polak and Ribiere, beta >= 0) in the windows,
 * from g and D at x.  Returns by how much E has changed. */
static double minimise_windows(Tips *tips, double *g)
{
    const Grid *grid = tips->grid;
    const GridRegion *inside = &tips->inside;
    double change = 0, start = 0, last = 0;
    for (int i = 0; i < TIP_ITERATIONS; i++) {
        if (i > 0)
            grid_gradient(grid, inside, g);
        if (i > 0 && i % TIP_DIAGONAL_EVERY == 0)
            grid_diagonal(grid, inside, tips->D);
        double old, inertia, beta = 0;
        double now = grid_precondition(grid, inside, tips->D, g, tips->old_g,
                                       tips->z, &old);
        if (i == 0)
            start = now;
        else if (now > old)
            beta = (now - old) / last;
        if (!(now > TIP_ENOUGH * start) && i > 0)
            break;
        double slope = grid_direction(grid, inside, tips->z, beta, g, tips->p,
                                      tips->old_g, &inertia);
        if (!(slope < 0))
            slope = grid_direction(grid, inside, tips->z, 0, g, tips->p,
                                   tips->old_g, &inertia);
        Quartic along;
        grid_along(grid, &tips->around, tips->p, slope, inertia, along.q);
        double alpha = quartic_first_minimum(&along);
        if (!(alpha > 0))
            break;
        grid_move(grid, inside, alpha, tips->p, 0, NULL);
        change += quartic_value(&along, alpha);
        last = now;
        tips->iterations++;
    }
    grid_clear(grid, tips->p);
    return change;
}

double tips_minimise(Tips *tips, double *g)
{
    const Grid *grid = tips->grid;
    const GridRegion *changed = NULL; /* since g and D were computed */
    double change = 0;
    for (int phase = 0; phase < TIP_PHASES; phase++) {
        grid_gradient(grid, changed, g);
        grid_diagonal(grid, changed, tips->D);
        grid_activity(grid, changed, tips->D, g, tips->activity);
        if (!choose_windows(tips))
            return change;
        changed = &tips->around;
        change += minimise_windows(tips, g);
        tips->phases++;
    }
    grid_gradient(grid, changed, g);
    return change;
}
