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

/* Nanoseconds that a phase takes for a block, about. */
static const double TIP_COST = 1e3;

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
    tips->window = malloc(blocks * sizeof *tips->window);
    tips->sums = malloc(2 * blocks * GRID_MAX_SUMS * sizeof *tips->sums);
    tips->D = grid_piece(grid, 11, &tips->memory);
    if (!tips->activity || !tips->row || !tips->mark || !tips->window ||
        !tips->sums || !tips->D || grid_region_create(grid, &tips->inside) ||
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
    free(tips->window);
    free(tips->sums);
    free(tips->memory);
    free(tips->inside.run);
    free(tips->starts.run);
    free(tips->around.run);
    *tips = (Tips){0};
}

/* ---- regions ---- */

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

/* Adds the run of marked blocks that block b of row i is in to a region, and
 * removes their marks. */
static void take_run(Tips *tips, int i, int b, GridRegion *region)
{
    const GridLayout *layout = &tips->grid->layout;
    unsigned char *mark = tips->mark + i * layout->blocks;
    while (b > 0 && mark[b - 1])
        b--;
    int first = b;
    while (b < layout->blocks && mark[b])
        mark[b++] = 0;
    region->run[region->runs++] = (GridRun){i, first, b - first};
    region->blocks += b - first;
}

/* The same for all marked blocks. */
static void take_marks(Tips *tips, GridRegion *region)
{
    int width = tips->grid->layout.blocks;
    for (int i = tips->first; i < tips->end; i++)
        for (int b = 0; b < width; b++)
            if (tips->mark[i * width + b])
                take_run(tips, i, b, region);
    tips->first = tips->grid->layout.nodes;
    tips->end = 0;
}

/* Adds these blocks to a region, and those before and below them where springs
 * start that end there; beyond: those after and above too, all neighbours. */
static void take_beside(Tips *tips, const GridRegion *these, int beyond,
                        GridRegion *region)
{
    for (int r = 0; r < these->runs; r++) {
        GridRun run = these->run[r];
        int i = run.row, b = run.first, end = b + run.blocks;
        mark_blocks(tips, i - 1, b - 1, i, end + 1);
        mark_blocks(tips, i, b - 1, i + 1 + beyond, end + beyond);
    }
    take_marks(tips, region);
}

/* Adds the runs of marked blocks that are near its own, and those near these:
 * with less than two blocks between, in the same row or the next. */
static void take_near(Tips *tips, GridRegion *region)
{
    const GridLayout *layout = &tips->grid->layout;
    int width = layout->blocks;
    for (int r = 0; r < region->runs; r++) {
        GridRun run = region->run[r];
        int first = run.first > 2 ? run.first - 2 : 0;
        int end = run.first + run.blocks + 2;
        int last = run.row + 1 < layout->nodes ? run.row + 1 : run.row;
        for (int i = run.row > 0 ? run.row - 1 : 0; i <= last; i++)
            for (int b = first; b < end && b < width; b++)
                if (tips->mark[i * width + b])
                    take_run(tips, i, b, region);
    }
}

/* An empty region behind this one. */
static GridRegion region_behind(const GridRegion *region)
{
    return (GridRegion){0, 0, region->run + region->runs};
}

/* Takes in what has been added to the region behind it. */
static void join_region(GridRegion *region, const GridRegion *behind)
{
    region->runs += behind->runs;
    region->blocks += behind->blocks;
}

/* Every part of the marks becomes a window. */
static void make_windows(Tips *tips)
{
    int width = tips->grid->layout.blocks;
    tips->windows = 0;
    tips->inside.runs = tips->inside.blocks = 0;
    for (int i = tips->first; i < tips->end; i++)
        for (int b = 0; b < width; b++) {
            if (!tips->mark[i * width + b])
                continue;
            TipWindow *window = &tips->window[tips->windows++];
            *window = (TipWindow){.inside = region_behind(&tips->inside)};
            take_run(tips, i, b, &window->inside);
            take_near(tips, &window->inside);
            join_region(&tips->inside, &window->inside);
        }
}

/* Where their springs start, and what is around them all. */
static void look_around(Tips *tips)
{
    tips->starts.runs = tips->starts.blocks = 0;
    tips->around.runs = tips->around.blocks = 0;
    double *sums = tips->sums;
    for (int w = 0; w < tips->windows; w++) {
        TipWindow *window = &tips->window[w];
        window->starts = region_behind(&tips->starts);
        take_beside(tips, &window->inside, 0, &window->starts);
        join_region(&tips->starts, &window->starts);
        window->sums = sums;
        sums += (window->inside.runs + window->starts.runs) * GRID_MAX_SUMS;
    }
    take_beside(tips, &tips->inside, 1, &tips->around);
}

/* ---- phases ---- */

/* g and the activity of all blocks, which have changed in this region (NULL:
 * everywhere) since the last look.  D may be older, but of this step: it only
 * weighs. */
static void look(Tips *tips, const GridRegion *changed, double *g)
{
    const Grid *grid = tips->grid;
    int width = grid->layout.blocks;
    grid_gradient(grid, changed, g);
    if (!tips->weighed)
        grid_diagonal(grid, NULL, tips->D);
    tips->weighed = true;
    grid_activity(grid, changed, tips->D, g, tips->activity);
    changed = changed ? changed : &grid->all;
    for (int r = 0; r < changed->runs; r++) {
        int i = changed->run[r].row;
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
    make_windows(tips);
    if (grid->segments >= TIP_SMALL_SQUARE &&
        tips->inside.blocks > TIP_LARGEST_SHARE * blocks)
        return false;
    look_around(tips);
    return true;
}

/* Nonlinear conjugate gradients (Polak and Ribiere, beta >= 0) in a window, at
 * x. */
static void minimise_window(const Tips *tips, const Grid *grid,
                            TipWindow *window)
{
    const GridRegion *inside = &window->inside;
    double start = 0, last = 0, *g = tips->g, *old_g = tips->old_g;
    grid_diagonal(grid, inside, tips->D);
    for (int i = 0; i < TIP_ITERATIONS; i++) {
        double old, inertia, beta = 0;
        double now =
            grid_precondition(grid, inside, tips->D, old_g, g, tips->z, &old);
        if (i == 0)
            start = now;
        else if (now > old)
            beta = (now - old) / last;
        if (!(now > TIP_ENOUGH * start) && i > 0)
            break;
        double slope =
            grid_direction(grid, inside, tips->z, beta, g, tips->p, &inertia);
        if (!(slope < 0))
            slope =
                grid_direction(grid, inside, tips->z, 0, g, tips->p, &inertia);
        double *next = old_g; /* g is the old one at the next x */
        old_g = g;
        g = next;
        Quartic along;
        grid_along(grid, &window->starts, tips->p, slope, inertia, along.q);
        double alpha = quartic_first_minimum(&along);
        if (!(alpha > 0))
            break;
        grid_move(grid, inside, alpha, tips->p, 0, NULL);
        window->change += quartic_value(&along, alpha);
        last = now;
        window->iterations++;
    }
    grid_region_clear(grid, inside, tips->p);
}

/* Windows first ... end - 1.  Of several, each is one thread's. */
static void minimise_windows(const void *job, int first, int end)
{
    const Tips *tips = job;
    Grid grid = *tips->grid;
    grid.crew = tips->windows == 1 ? grid.crew : NULL;
    for (int w = first; w < end; w++) {
        grid.sums = tips->window[w].sums;
        minimise_window(tips, &grid, &tips->window[w]);
    }
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
        crew_run_uneven(tips->grid->crew, minimise_windows, tips, tips->windows,
                        TIP_COST * tips->inside.blocks);
        lowered *= TIP_MEMORY;
        work = TIP_MEMORY * work + WORK_LOOK * changed->blocks;
        for (int w = 0; w < tips->windows; w++) {
            const TipWindow *window = &tips->window[w];
            change += window->change;
            lowered += window->change;
            work += (double)window->iterations * window->inside.blocks;
            tips->iterations += window->iterations;
        }
        tips->phases++;
        if (!(lowered < pace * work))
            break;
    }
    grid_gradient(tips->grid, changed, g);
    return change;
}
