/* multigrid.c - the phases of Newton's loop on a square grid of springs. */
#include "solve/multigrid.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "model/mass_spring_energy.h"
#include "solve/newton_parts.h"
#include "solve/tiles.h"
#include "solve/v_cycle.h"

/* The V-cycle keeps its matrices while no node has moved by more than this
 * fraction of the shortest spring since they were computed. */
static const double NEARBY = 0.05;

/* A direction p is poor if p is not small (SMALL_P), and p_bound is more than
 * STALLS times its value in the iteration before.  Tiles relax after each poor
 * direction.  A sweep of a tile is worth its time if it lowers E by more than
 * PACE times the last direction's decrease, divided by the number of tiles.  A
 * minimum is near if the bound is at most CLOSE times the limit of the test. */
static const double STALLS = 0.3, PACE = 0.01, CLOSE = 1e3;

/* If the first sweep of all tiles in a step lowers E by less than USELESS times
 * the last direction's decrease, tiles pause for TILE_PAUSE_ITERATIONS - 1
 * iterations. */
static const double USELESS = 0.005;
enum { TILE_PAUSE_ITERATIONS = 5 };

/* Number of the iteration, counted from 0, after which Newton takes over. */
enum { MAX_MG_ITERATIONS = 200 };

/* A change of E that is at most this fraction of the step's largest change is
 * compared with the rounding of E, unless p_bound has fallen. */
static const double SMALL_CHANGE = 1e-9;

struct Multigrid {
    Grid grid;
    VCycle v_cycle;
    Tiles tiles;
    ArrayArena memory;     /* memory that holds all arrays */
    double *g, *p;         /* [2 planes] grad E and direction at x */
    double *old_g, *old_p; /* [2 planes] g and p in the iteration before */
    double gradient_norm2; /* |g|_(M^-1)^2 */
    double p_bound;        /* m, upper bound of |p_x| + |p_y|, from g alone */
    double old_p_bound;    /* m, p_bound in the iteration before */
    double p_size;         /* m, upper bound of |p_x| + |p_y|, once p is
                              conjugate to old_p */
    double moved_since_setup; /* m, upper bound of a node's displacement since
                                 the V-cycle's matrices were computed */
    long direction_cycles;    /* number of V-cycles that computed p */
    double lowest_change;     /* J s^2, most negative change of E in the step */
    Quartic line_E;           /* E(x + alpha p) - E(x), J s^2 */
    unsigned system_version;  /* System.version that the grid was made for */
    double weight;            /* s^2, weight of P that the grid was made for */
    int tiles_pause_until;    /* iteration before which tiles do not relax */
    bool next_p_is_last;      /* p_bound says that the next p passes the test */
    bool has_relaxed_tiles;   /* tiles relaxed in the last update */
    bool change_was_hidden;   /* rounding hid the last iteration's change of E,
                                 and p_bound did not fall */
};

Status multigrid_create(int segments, Multigrid **multigrid)
{
    Multigrid *mg = *multigrid = calloc(1, sizeof *mg);
    Status status = mg ? STATUS_OK : STATUS_OUT_OF_MEMORY;
    /* The first pass counts the bytes of the arrays. */
    for (int pass = 0; pass < 2 && !status; pass++) {
        double **vectors[] = {&mg->g, &mg->p, &mg->old_g, &mg->old_p};
        if (pass > 0)
            status = arena_allocate(&mg->memory);
        grid_init(segments, &mg->memory, &mg->grid);
        v_cycle_init(&mg->grid, &mg->memory, &mg->v_cycle);
        tiles_init(&mg->grid, &mg->memory, &mg->tiles);
        for (int i = 0; i < 4; i++)
            *vectors[i] = arena_take_piece(
                &mg->memory,
                2 * (size_t)mg->grid.rows.plane_length * sizeof(double));
    }
    if (status) {
        free(mg);
        *multigrid = NULL;
    }
    return status;
}

void multigrid_free(Multigrid *multigrid)
{
    if (!multigrid)
        return;
    free(multigrid->memory.base);
    free(multigrid);
}

/* ---- who makes a minimisation ---- */

/* Returns why multigrid does not make the minimisation, or NULL if it does.
 * Only springs, with or without damping, and terms that draw nodes to points
 * may have an energy. */
static const char *find_refusal_reason(const Newton *newton)
{
    const NewtonSettings *settings = &newton->settings;
    const System *system = newton->system;
    bool alone = system_find_term(system, &mass_spring_energy);
    for (int t = 0; alone && t < system->term_count; t++) {
        const TermKind *kind = system->term[t].kind;
        alone = kind == &mass_spring_energy || kind->is_diagonal ||
                !kind->potential;
    }
    if (system->segments == 0)
        return "there is no square grid";
    if (!alone)
        return "there are energies beside the springs'";
    if (settings->projection != PROJECTION_CLAMP)
        return "the projection is not clamp";
    if (settings->line_search != LINE_SEARCH_BACKTRACK)
        return "there is no line search";
    /* The test of p would need more digits than a double has. */
    if (newton->rounding.factor_is_inexact)
        return "springs outweigh the masses too far";
    return NULL;
}

bool multigrid_accepts_problem(Newton *newton)
{
    Solver solver = newton->settings.solver;
    bool wanted = solver == SOLVER_AUTO
                      ? newton->system->segments > AUTO_NEWTON_MAX_SEGMENTS
                      : solver == SOLVER_MULTIGRID;
    newton->refusal_reason = wanted ? find_refusal_reason(newton) : NULL;
    return wanted && !newton->refusal_reason;
}

/* Computes g at x, and p_bound from g.  Returns OK, NOT_FINITE. */
static Status multigrid_evaluate_gradient(Multigrid *mg)
{
    mg->gradient_norm2 = grid_gradient(&mg->grid, mg->g);
    mg->old_p_bound = mg->p_bound;
    mg->p_bound = sqrt(2 / mg->grid.min_mass * mg->gradient_norm2) /
                  mg->grid.length_scale;
    return isfinite(mg->gradient_norm2) ? STATUS_OK : STATUS_NOT_FINITE;
}

/* Copies the problem to the grid.  Returns OK, OUT_OF_MEMORY, NOT_FINITE. */
static Status multigrid_copy_problem(Newton *newton)
{
    Iterate *at = &newton->iterate;
    const System *system = newton->system;
    double *m = newton->x_trial, *u_tilde = newton->u_trial;
    Status status = STATUS_OK;
    if (!newton->multigrid)
        status = multigrid_create(system->segments, &newton->multigrid);
    if (status)
        return status;
    Multigrid *mg = newton->multigrid;
    mg->has_relaxed_tiles = mg->change_was_hidden = mg->next_p_is_last =
        mg->v_cycle.is_clamped = false;
    mg->lowest_change = mg->p_size = 0;
    mg->tiles_pause_until = 0;
    incremental_potential_absorb_pulls(at, m, u_tilde);
    if (mg->weight != at->E.weight || mg->system_version != system->version) {
        grid_copy_from_system(&mg->grid, at, m);
        v_cycle_copy_system(&mg->v_cycle);
    }
    mg->weight = at->E.weight;
    mg->system_version = system->version;
    grid_copy_from_state(&mg->grid, at, u_tilde);
    mg->p_bound = mg->moved_since_setup = INFINITY;
    return multigrid_evaluate_gradient(mg);
}

/* ---- search direction ---- */

/* Chooses the clamped or the exact Hessian for the next directions. */
static void multigrid_choose_hessian(Multigrid *mg, bool is_clamped)
{
    if (mg->v_cycle.is_clamped != is_clamped)
        mg->moved_since_setup = INFINITY;
    mg->v_cycle.is_clamped = is_clamped;
}

/* Computes p = -H^-1 g up to a linear residual, and tests p unless it is known
 * to be the last one. */
static void multigrid_compute_direction(Newton *newton)
{
    Multigrid *mg = newton->multigrid;
    if (mg->moved_since_setup > NEARBY * newton->rounding.shortest_spring) {
        mg->v_cycle.has_matrices = false;
        mg->moved_since_setup = 0;
    }
    const double h = newton->settings.h * mg->grid.length_scale;
    const double longest = h * newton->tolerance;
    const long cycles = mg->v_cycle.cycles;
    double largest;
    const bool passes = v_cycle_solve(&mg->v_cycle, mg->g, mg->gradient_norm2,
                                      longest, mg->p, &largest);
    if (passes && !newton->meets_tolerance) {
        double square = grid_linear_residual(&mg->grid, mg->g, mg->p);
        /* `largest` is rounded to single precision; the factor makes it an
         * upper bound. */
        newton->meets_tolerance = p_meets_tolerance(
            &mg->grid, largest * (1 + FLT_EPSILON), square, longest);
    }
    newton->record.residual = largest / h;
    mg->direction_cycles = mg->v_cycle.cycles - cycles;
    newton->counters.v_cycles = mg->v_cycle.cycles;
}

static Status multigrid_find_direction(Newton *newton)
{
    NewtonRecord *record = &newton->record;
    Status status =
        record->iteration == 0 ? multigrid_copy_problem(newton) : STATUS_OK;
    newton->meets_tolerance = !status && newton->multigrid->next_p_is_last;
    record->residual_kind = RESIDUAL_ESTIMATE;
    if (!status)
        multigrid_compute_direction(newton);
    return status;
}

/* Finds a minimum of the quartic by Newton's method with bisection, from 1 on.
 * Returns its alpha, halved until the quartic is below 0; 0 if there is none.
 *   trials  out, number of steps of Newton's method or bisection */
static double minimise_quartic(const Quartic *quartic, int *trials)
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

/* Computes the change of E along p. */
static void multigrid_compute_line_polynomial(Multigrid *mg)
{
    grid_energy_quartic(&mg->grid, mg->p, mg->line_E.q);
    for (int i = 0; i < 4; i++)
        mg->line_E.q[i] /= mg->grid.energy_scale;
}

/* Makes p conjugate to the direction before, unless tiles have relaxed since.
 * Finds the alpha at which E, a quartic along p, is lowest; 0 if E rises.
 *   last_size, last_slope  p_size and grad E . p, grid units, of the direction
 *                          before */
static void multigrid_search_along_p(Newton *newton, double last_size,
                                     double last_slope)
{
    Multigrid *mg = newton->multigrid;
    NewtonRecord *record = &newton->record;
    double beta = 0;
    if (record->iteration > 0 && !mg->has_relaxed_tiles)
        beta = grid_make_p_conjugate(&mg->grid, mg->g, mg->old_g, mg->old_p,
                                     last_slope, mg->p);
    mg->p_size = record->residual * newton->settings.h + beta * last_size;
    multigrid_compute_line_polynomial(mg);
    record->slope = mg->line_E.q[0];
    record->alpha =
        record->slope <= 0 ? minimise_quartic(&mg->line_E, &record->trials) : 0;
}

/* Finds the step length.  If E does not fall along p, the exact Hessian is not
 * positive definite, and the clamped Hessian gives another p. */
static Status multigrid_find_step_length(Newton *newton)
{
    Multigrid *mg = newton->multigrid;
    NewtonRecord *record = &newton->record;
    const double last_size = mg->p_size;
    const double last_slope = mg->line_E.q[0] * mg->grid.energy_scale;
    multigrid_search_along_p(newton, last_size, last_slope);
    if (!(record->alpha > 0) && !mg->v_cycle.is_clamped) {
        multigrid_choose_hessian(mg, true);
        multigrid_compute_direction(newton);
        multigrid_search_along_p(newton, last_size, last_slope);
    }
    if (!isfinite(record->slope))
        return STATUS_NOT_FINITE;
    if (!(record->alpha > 0))
        return STATUS_LINE_SEARCH_LIMIT;
    record->energy_change = quartic_value(&mg->line_E, record->alpha);
    return STATUS_OK;
}

/* Adds alpha p to x, then relaxes tiles of nodes if the directions stall.  The
 * Hessian is clamped after a poor direction, unless it is the step's first one,
 * since tiles alone are often enough, or a minimum is near.  The exact Hessian
 * returns after a direction that is not poor, if one V-cycle was enough for p:
 * near a minimum it needs fewer updates, and each of them takes less time. */
static Status multigrid_update_iterate(Newton *newton)
{
    Multigrid *mg = newton->multigrid;
    NewtonRecord *record = &newton->record;
    const int tiles = mg->tiles.rows * mg->tiles.columns;
    double *g = mg->g, *p = mg->p;
    grid_move_x(&mg->grid, record->alpha, p);
    mg->moved_since_setup += record->alpha * mg->p_size;
    newton->counters.updates++;
    if (newton->meets_tolerance)
        return STATUS_OK;
    const bool is_poor = mg->p_bound > STALLS * mg->old_p_bound &&
                         record->residual > SMALL_P * newton->tolerance;
    const bool is_first_poor = mg->tiles_pause_until == 0;
    mg->has_relaxed_tiles =
        is_poor && record->iteration >= mg->tiles_pause_until;
    if (mg->has_relaxed_tiles) {
        const double change = record->energy_change * mg->grid.energy_scale;
        double first = tiles_relax(&mg->tiles, PACE * change / tiles, p);
        if (is_first_poor)
            mg->tiles_pause_until =
                record->iteration +
                (first > USELESS * change ? TILE_PAUSE_ITERATIONS : 1);
        multigrid_compute_line_polynomial(mg);
        double alpha = minimise_quartic(&mg->line_E, &(int){0});
        if (alpha > 0) { /* alpha is 0 after an overflow of floats */
            grid_move_x(&mg->grid, alpha, p);
            record->energy_change += quartic_value(&mg->line_E, alpha);
            mg->moved_since_setup = INFINITY;
        }
    }
    newton->counters.tile_sweeps = mg->tiles.sweeps;
    mg->g = mg->old_g;
    mg->p = mg->old_p;
    mg->old_g = g;
    mg->old_p = p;
    Status status = multigrid_evaluate_gradient(mg);
    const double close = CLOSE * newton->tolerance * newton->settings.h;
    multigrid_choose_hessian(
        mg, (is_poor && !is_first_poor && mg->p_bound > close) ||
                (mg->v_cycle.is_clamped && mg->direction_cycles > 1));
    return status;
}

/* Decides whether the loop ends.  If multigrid cannot pass the test, for
 * example because of rounding, Newton goes on from the iterate. */
static Status multigrid_test_convergence(Newton *newton, Status status)
{
    Multigrid *mg = newton->multigrid;
    NewtonRecord *record = &newton->record;
    if (!mg)
        return status;
    mg->lowest_change = fmin(mg->lowest_change, record->energy_change);
    bool small =
        fabs(record->energy_change) <= SMALL_CHANGE * -mg->lowest_change;
    bool last = record->iteration + 1 >= newton_iteration_limit(newton);
    bool stuck = status != STATUS_OK || record->iteration >= MAX_MG_ITERATIONS;
    mg->next_p_is_last |=
        fmax(record->residual, 2 * mg->p_bound / newton->settings.h) <=
        newton->tolerance;
    bool is_tiny = mg->p_bound <= negligible_direction_size(newton);
    bool ends = newton->meets_tolerance || (!stuck && is_tiny);
    if (ends && system_falls_freely(newton->system))
        record->energy_change +=
            grid_correct_momentum(&mg->grid) / mg->grid.energy_scale;
    /* Only these cases need the iterate in newton->iterate. */
    if (ends || stuck || small || last || newton->settings.observer) {
        swap_iterates(newton);
        grid_copy_to_iterate(&mg->grid, &newton->iterate);
    }
    const double turned =
        ends && newton->rounding.is_stiff ? turn_free_body(newton) : 0;
    record->energy_change += turned;
    /* p_bound was computed before the body was turned, and is not valid if the
     * turn may move a node by more than half of tolerance times h. */
    bool overturns = (mg->next_p_is_last || !newton->meets_tolerance) &&
                     2 * bound_largest_movement(newton, sqrt(-2 * turned)) >
                         newton->tolerance * newton->settings.h;
    if (ends && !overturns && status != STATUS_NOT_FINITE)
        return STATUS_OK;
    stuck = stuck || overturns;
    bool hidden = small && !(mg->p_bound < mg->old_p_bound) &&
                  is_below_roundoff(newton, record->energy_change);
    if (stuck || (hidden && mg->change_was_hidden)) {
        newton->active_solver = SOLVER_NEWTON;
        newton->rounding.E = NAN;
        newton->counters.newton_takeovers++;
    }
    mg->change_was_hidden = hidden;
    return last ? STATUS_ITERATION_LIMIT : STATUS_RUNNING;
}

const NewtonPhases multigrid_phases = {
    multigrid_find_direction, multigrid_find_step_length,
    multigrid_update_iterate, multigrid_test_convergence};
