#include "solve/multigrid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/quartic.h"
#include "solve/tiles.h"
#include "solve/v_cycle.h"

/* Newton's directions: the remainder falls to this share of its norm, in at
 * most so many V-cycles. */
static const double ENOUGH = 0.3;
enum { MAX_CYCLES = 60 };

/* Tiles relax once so many directions are done and the gradient's bound falls
 * by less than this factor; and go on while a sweep lowers E by more than PACE
 * of what the last direction did for each tile. */
enum { DIRECTIONS = 2 };
static const double STALLS = 0.3, PACE = 0.5;

/* The test is worth conjugate gradients when the gradient's bound is at most
 * so many tolerances for each segment, and has halved since they last said no.
 * They make the remainder smaller by TESTED; then it is computed in double
 * precision, and made smaller by REFINED, until it falls no more. */
static const double WORTH_A_TEST = 8, TESTED = 1e-4, REFINED = 1e-2;

struct Multigrid {
    Grid grid;
    VCycle cycle;
    Tiles tiles;
    Memory memory; /* all of their arrays, and these */
    Crew *crew;
    MultigridRecord record;
    MultigridStep step;
    double *g, *p, *rest; /* [2 planes] grad E and direction at x, remainder */
    double square;        /* |g|_(M^-1)^2 */
    double moment[2];     /* kg m, sum m (x - x_tilde) */
    double bound;         /* m/s, of the residual */
    double last_bound;    /* m/s, an iteration before */
    double test_below;    /* m/s, half the bound when it said no */
    bool known;           /* the grid has the system's numbers */
    bool directed;        /* p is a direction at x */
    bool stalls;          /* tiles relax in each iteration */
    int iterations;       /* of this step */
};

static void lay_out(int segments, Multigrid *mg)
{
    mg->memory.used = 0;
    grid_lay_out(segments, &mg->memory, &mg->grid);
    v_cycle_lay_out(&mg->grid, &mg->memory, &mg->cycle);
    tiles_lay_out(&mg->grid, &mg->memory, &mg->tiles);
    double **vectors[] = {&mg->g, &mg->p, &mg->rest};
    size_t bytes = 2 * (size_t)mg->grid.rows.plane * sizeof(double);
    for (int i = 0; i < 3; i++)
        *vectors[i] = memory_piece(&mg->memory, bytes);
}

Status multigrid_create(int segments, int threads, Multigrid **multigrid)
{
    *multigrid = NULL;
    if (segments < 1)
        return STATUS_INVALID_INPUT;
    Multigrid *mg = calloc(1, sizeof *mg);
    if (!mg)
        return STATUS_OUT_OF_MEMORY;
    lay_out(segments, mg);
    if (memory_create(&mg->memory)) {
        free(mg);
        return STATUS_OUT_OF_MEMORY;
    }
    lay_out(segments, mg);
    mg->crew = mg->grid.crew = crew_create(threads);
    *multigrid = mg;
    return STATUS_OK;
}

void multigrid_free(Multigrid *mg)
{
    if (!mg)
        return;
    crew_free(mg->crew);
    free(mg->memory.base);
    free(mg);
}

/* ---- the test ---- */

/* m/s, the residual of a direction whose largest |p_x| + |p_y| is this. */
static double residual_of(const Multigrid *mg, double largest)
{
    return largest / mg->step.h;
}

/* Whether p = -H^-1 g, and its residual, got so exact that the test is decided
 * by a remainder in double precision. */
static bool decide_test(Multigrid *mg)
{
    const Grid *grid = &mg->grid;
    double length = mg->step.h * mg->step.tolerance, last, now = INFINITY;
    VEnd end = {TESTED, length, MAX_CYCLES};
    v_solve(&mg->cycle, -1, mg->g, mg->square, end, false, mg->p);
    end = (VEnd){REFINED, 0, MAX_CYCLES};
    do {
        double largest;
        last = now;
        now = grid_remainder(grid, mg->g, mg->p, mg->rest, &largest);
        mg->record.after = residual_of(mg, largest);
        if (v_decides(grid, largest, now, length))
            return true;
        v_solve(&mg->cycle, 1, mg->rest, now, end, true, mg->p);
    } while (now < 0.25 * last);
    return false;
}

/* A place where the quartic is below 0, at a minimum if rounding allows, looked
 * for from 1 on; 0 if there is none.
 *   trials  out, places looked at */
static double lowest(const Quartic *quartic, int *trials)
{
    const double *q = quartic->q;
    double low = 0, high = INFINITY, a = 1, last = 0;
    for (*trials = 0; *trials < 50 && fabs(a - last) > 1e-9 * a; ++*trials) {
        double slope = q[0] + a * (2 * q[1] + a * (3 * q[2] + a * 4 * q[3]));
        double bend = 2 * q[1] + a * (6 * q[2] + a * 12 * q[3]);
        *(slope < 0 ? &low : &high) = last = a;
        a = bend > 0 ? a - slope / bend : 0;
        if (!(a > low && a < high))
            a = high < INFINITY ? 0.5 * (low + high) : 2 * last;
    }
    while (a > 1e-9 && !(quartic_value(quartic, a) < 0))
        a /= 2;
    return a > 1e-9 ? a : 0;
}

/* Goes along p to where E is lowest, and adds to the record by how much that
 * changed E.  Returns OK, LINE_SEARCH_LIMIT, NOT_DESCENT, NOT_FINITE. */
static Status search_step(Multigrid *mg)
{
    MultigridRecord *record = &mg->record;
    Quartic along;
    grid_along(&mg->grid, mg->g, mg->p, along.q);
    record->slope = along.q[0];
    record->alpha = record->trials = 0;
    if (!isfinite(record->slope))
        return STATUS_NOT_FINITE;
    if (!(record->slope <= 0))
        return STATUS_NOT_DESCENT;
    record->alpha = lowest(&along, &record->trials);
    if (!(record->alpha > 0))
        return STATUS_LINE_SEARCH_LIMIT;
    record->change += quartic_value(&along, record->alpha);
    grid_move(&mg->grid, record->alpha, mg->p);
    return STATUS_OK;
}

/* g at x, and the bound of the residual. */
static void evaluate(Multigrid *mg)
{
    mg->square = grid_gradient(&mg->grid, mg->g, mg->moment);
    mg->bound = mg->record.after =
        residual_of(mg, sqrt(2 / mg->grid.lightest * mg->square));
    mg->directed = mg->record.decided = mg->cycle.set_up = false;
    mg->step.counters->gradients++;
}

/* The test of Algorithm 3 at x.  Returns OK, RUNNING, NOT_FINITE. */
static Status multigrid_test(Multigrid *mg)
{
    const double tolerance = mg->step.tolerance;
    if (!isfinite(mg->square))
        return STATUS_NOT_FINITE;
    if (!(mg->bound <= tolerance)) {
        double worth = WORTH_A_TEST * tolerance * mg->grid.segments;
        if (!(mg->bound <= fmin(worth, mg->test_below)))
            return STATUS_RUNNING;
        if (mg->step.is_free) {
            grid_shift(&mg->grid, (double[2]){-mg->moment[0] / mg->grid.mass,
                                              -mg->moment[1] / mg->grid.mass});
            evaluate(mg);
        }
        mg->directed = decide_test(mg);
        mg->record.decided = true;
        mg->test_below = mg->bound / 2;
        if (!mg->directed || !(mg->record.after <= tolerance))
            return STATUS_RUNNING;
    }
    return STATUS_OK;
}

/* ---- the iteration ---- */

/* Before a return: what the parts have done. */
static Status count(Multigrid *mg, Status status)
{
    mg->step.counters->cycles += mg->cycle.cycles;
    mg->step.counters->local += mg->tiles.sweeps;
    mg->cycle.cycles = mg->tiles.sweeps = 0;
    return status;
}

Status multigrid_start(Multigrid *mg, const MultigridStep *step)
{
    mg->known = mg->known && step->weight == mg->step.weight &&
                step->version == mg->step.version;
    mg->step = *step;
    mg->record = (MultigridRecord){0};
    mg->stalls = false;
    mg->iterations = 0;
    mg->last_bound = mg->test_below = INFINITY;
    crew_begin(mg->crew);
    if (!mg->known) {
        grid_read_system(&mg->grid, step);
        v_cycle_read_system(&mg->cycle);
    }
    mg->known = true;
    grid_read_state(&mg->grid, step);
    evaluate(mg);
    return count(mg, multigrid_test(mg));
}

Status multigrid_iterate(Multigrid *mg)
{
    const double bound = mg->bound;
    double residual = mg->record.after;
    if (!mg->directed) {
        VEnd end = {ENOUGH, 0, MAX_CYCLES};
        residual = residual_of(
            mg, v_solve(&mg->cycle, -1, mg->g, mg->square, end, false, mg->p));
    }
    mg->record = (MultigridRecord){.residual = residual};
    Status status = search_step(mg);
    if (!status) {
        mg->stalls = mg->stalls || (mg->iterations >= DIRECTIONS &&
                                    bound > STALLS * mg->last_bound);
        mg->last_bound = bound;
        mg->iterations++;
        mg->step.counters->iterations++;
        int tiles = mg->tiles.high * mg->tiles.wide;
        if (mg->stalls)
            mg->record.change +=
                tiles_relax(&mg->tiles, PACE * mg->record.change / tiles);
        evaluate(mg);
        status = multigrid_test(mg);
    }
    return count(mg, status);
}

/* ---- what others may know ---- */

void multigrid_displacement(const Multigrid *mg, double *u)
{
    grid_displacement(&mg->grid, &mg->step, u);
}

const MultigridRecord *multigrid_record(const Multigrid *mg)
{
    return &mg->record;
}
