#include "solve/tips.h"

#include <stdlib.h>
#include <string.h>

#include "solve/plane_search.h"

/* Iterations of a phase at most; phases at most. */
enum { TIP_ITERATIONS = 20, TIP_PHASES = 1000 };

/* A phase ends when g.D g fell to this share. */
static const double TIP_ENOUGH = 0.3;

/* A tip is a block this much more active than all are on average.  Windows are
 * around the blocks with this share of the largest activity, so many rows and
 * blocks beyond them, and cover at most this share of the square. */
static const double TIP_STANDS_OUT = 20, TIP_ACTIVE = 0.6,
                    TIP_LARGEST_SHARE = 0.5;
enum { TIP_ROWS = 8, TIP_BLOCKS = 1 };

/* Below so many segments windows may be all of it: directions of the whole
 * square are no better there. */
enum { TIP_SMALL_SQUARE = 48 };

/* Work is counted in iterations of one block: an iteration of the whole square
 * takes about so many for each block, and so does looking where E has changed.
 * Phases go on while they lower E by more than the last iteration of the whole
 * square did for the same work.  That is an average over the last phases, of
 * which each counts this times as much as the next. */
enum { WORK_GLOBAL = 3, WORK_LOOK = 2 };
static const double TIP_MEMORY = 0.8;

Status tips_create(const Grid *grid, Tips *tips)
{
    *tips = (Tips){.grid = grid};
    size_t blocks = (size_t)grid->all.blocks, rows = (size_t)grid->all.runs;
    tips->activity = malloc(blocks * sizeof *tips->activity);
    tips->row = malloc(rows * sizeof *tips->row);
    tips->mark = calloc(blocks, 1);
    tips->first = grid->layout.nodes;
    tips->D = grid_piece(grid, 11, &tips->memory);
    if (!tips->activity || !tips->row || !tips->mark || !tips->D ||
        grid_region_create(grid, &tips->inside) ||
        grid_region_create(grid, &tips->starts))
        return STATUS_OUT_OF_MEMORY;
    tips->z = tips->D + 3 * grid->layout.plane;
    tips->p = tips->z + 2 * grid->layout.plane;
    tips->g = tips->p + 2 * grid->layout.plane;
    tips->old_g = tips->g + 2 * grid->layout.plane;
    return grid_region_create(grid, &tips->around);
}

void tips_free(Tips *tips)
{
    if (!tips)
        return;
    free(tips->activity);
    free(tips->row);
    free(tips->mark);
    free(tips->memory);
    free(tips->inside.run);
    free(tips->starts.run);
    free(tips->around.run);
    *tips = (Tips){0};
}

/* Marks the blocks from row and block (i, b) to just before (end_i, end_b). */
static void mark_blocks(Tips *tips, int i, int b, int end_i, int end_b)
{
    int width = tips->grid->layout.blocks, height = tips->grid->layout.nodes;
    i = i > 0 ? i : 0;
    b = b > 0 ? b : 0;
    end_i = end_i < height ? end_i : height;
    end_b = end_b < width ? end_b : width;
    tips->first = i < tips->first ? i : tips->first;
    tips->end = end_i > tips->end ? end_i : tips->end;
    for (; i < end_i; i++)
        memset(tips->mark + i * width + b, 1, (size_t)(end_b - b));
}

/* The blocks that are marked; none is afterwards. */
static void take_marks(Tips *tips, GridRegion *region)
{
    const GridLayout *layout = &tips->grid->layout;
    region->runs = region->blocks = 0;
    for (int i = tips->first; i < tips->end; i++) {
        unsigned char *mark = tips->mark + i * layout->blocks;
        for (int b = 0; b < layout->blocks; b++) {
            int first = b;
            while (b < layout->blocks && mark[b])
                mark[b++] = 0;
            if (b == first)
                continue;
            region->run[region->runs++] =
                (GridRun){grid_at(layout, i, GRID_BLOCK * first), b - first};
            region->blocks += b - first;
        }
    }
    tips->first = layout->nodes;
    tips->end = 0;
}

/* The windows, and the blocks before and below them where springs start that
 * end there; beyond: those after and above too, all neighbours. */
static void take_beside(Tips *tips, int beyond, GridRegion *region)
{
    const GridLayout *layout = &tips->grid->layout;
    for (int r = 0; r < tips->inside.runs; r++) {
        GridRun run = tips->inside.run[r];
        int i = grid_row(layout, run);
        int b = (run.start - grid_at(layout, i, 0)) / GRID_BLOCK;
        int end = b + run.blocks;
        mark_blocks(tips, i - 1, b - 1, i, end + 1);
        mark_blocks(tips, i, b - 1, i + 1 + beyond, end + beyond);
    }
    take_marks(tips, region);
}

/* g and the activity of all blocks, which have changed in this region (NULL:
 * everywhere) since the last look.  D may be older there: it only weighs. */
static void look(Tips *tips, const GridRegion *changed, double *g)
{
    const Grid *grid = tips->grid;
    int width = grid->layout.blocks;
    grid_gradient(grid, changed, g);
    if (!changed)
        grid_diagonal(grid, NULL, tips->D);
    grid_activity(grid, changed, tips->D, g, tips->activity);
    changed = changed ? changed : &grid->all;
    for (int r = 0; r < changed->runs; r++) {
        int i = grid_row(&grid->layout, changed->run[r]);
        TipRow *row = &tips->row[i];
        *row = (TipRow){0, 0};
        for (int b = 0; b < width; b++) {
            double activity = tips->activity[i * width + b];
            row->sum += activity;
            row->most = activity > row->most ? activity : row->most;
        }
    }
}

/* The windows of a phase; false where there is none, or too much is one. */
static bool choose_windows(Tips *tips)
{
    const Grid *grid = tips->grid;
    const GridLayout *layout = &grid->layout;
    int blocks = grid->all.blocks, width = layout->blocks;
    double sum = 0, most = 0;
    for (int i = 0; i < layout->nodes; i++) {
        sum += tips->row[i].sum;
        most = tips->row[i].most > most ? tips->row[i].most : most;
    }
    if (!(most >= TIP_STANDS_OUT * sum / blocks))
        return false;
    for (int i = 0; i < layout->nodes; i++)
        for (int b = 0; b < width && tips->row[i].most >= TIP_ACTIVE * most;
             b++)
            if (tips->activity[i * width + b] >= TIP_ACTIVE * most)
                mark_blocks(tips, i - TIP_ROWS, b - TIP_BLOCKS,
                            i + TIP_ROWS + 1, b + TIP_BLOCKS + 1);
    take_marks(tips, &tips->inside);
    if (grid->segments >= TIP_SMALL_SQUARE &&
        tips->inside.blocks > TIP_LARGEST_SHARE * blocks)
        return false;
    take_beside(tips, 1, &tips->around);
    take_beside(tips, 0, &tips->starts);
    return true;
}

/* Nonlinear conjugate gradients (Polak and Ribiere, beta >= 0) in the windows,
 * at x.  Returns by how much E has changed. */
static double minimise_windows(Tips *tips)
{
    const Grid *grid = tips->grid;
    const GridRegion *inside = &tips->inside;
    double change = 0, start = 0, last = 0;
    grid_diagonal(grid, inside, tips->D);
    for (int i = 0; i < TIP_ITERATIONS; i++) {
        double old, inertia, beta = 0;
        double now = grid_precondition(grid, inside, tips->D, tips->old_g,
                                       tips->g, tips->z, &old);
        if (i == 0)
            start = now;
        else if (now > old)
            beta = (now - old) / last;
        if (!(now > TIP_ENOUGH * start) && i > 0)
            break;
        double slope = grid_direction(grid, inside, tips->z, beta, tips->g,
                                      tips->p, &inertia);
        if (!(slope < 0))
            slope = grid_direction(grid, inside, tips->z, 0, tips->g, tips->p,
                                   &inertia);
        double *g = tips->g; /* is the old one at the next x */
        tips->g = tips->old_g;
        tips->old_g = g;
        Quartic along;
        grid_along(grid, &tips->starts, tips->p, slope, inertia, along.q);
        double alpha = quartic_first_minimum(&along);
        if (!(alpha > 0))
            break;
        grid_move(grid, inside, alpha, tips->p, 0, NULL);
        change += quartic_value(&along, alpha);
        last = now;
        tips->iterations++;
    }
    grid_region_clear(grid, inside, tips->p);
    return change;
}

double tips_minimise(Tips *tips, double global, double *g)
{
    const GridRegion *changed = NULL; /* since the last look */
    double pace = global / WORK_GLOBAL / tips->grid->all.blocks;
    double change = 0, lowered = 0, work = 0;
    for (int phase = 0; phase < TIP_PHASES; phase++) {
        look(tips, changed, g);
        if (!choose_windows(tips))
            return change;
        changed = &tips->around;
        long before = tips->iterations;
        double by = minimise_windows(tips);
        change += by;
        lowered = TIP_MEMORY * lowered + by;
        work = TIP_MEMORY * work + WORK_LOOK * changed->blocks +
               (double)(tips->iterations - before) * tips->inside.blocks;
        tips->phases++;
        if (!(lowered < pace * work))
            break;
    }
    grid_gradient(tips->grid, changed, g);
    return change;
}
