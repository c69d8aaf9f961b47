#include "solve/multigrid.h"

#include <math.h>
#include <stdlib.h>

#include "model/mass_spring_energy.h"
#include "solve/newton_parts.h"
#include "solve/tiles.h"
#include "solve/v_cycle.h"

/* Newton's directions: the remainder falls to this share of its norm. */
static const double ENOUGH = 0.3;

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

/* Iterations that multigrid gets; most steps need ten. */
enum { HANDED_ITERATIONS = 200 };

/* A change of E that is this small a part of the step's first one may be
 * rounding: that is looked at. */
static const double SMALL_CHANGE = 1e-9;

struct Multigrid {
    Grid grid;
    VCycle cycle;
    Tiles tiles;
    Memory memory;        /* all of their arrays, and these */
    double *g, *p, *rest; /* [2 planes] grad E and direction at x, remainder */
    double square;        /* |g|_(M^-1)^2 */
    double bound;         /* m/s, of the residual */
    double last_bound;    /* m/s, an iteration before */
    double test_below;    /* m/s, half the bound when it said no */
    double largest;       /* J s^2, change of E in this step, < 0 */
    unsigned version;     /* of the system, and */
    double weight;        /* s^2, of P, for which the grid has the numbers */
    int directions;       /* of this step */
    bool directed;        /* p is a direction at x */
    bool stalls;          /* tiles relax in each iteration */
};

Status multigrid_create(int segments, Multigrid **multigrid)
{
    Multigrid *mg = *multigrid = calloc(1, sizeof *mg);
    Status status = mg ? STATUS_OK : STATUS_OUT_OF_MEMORY;
    for (int pass = 0; pass < 2 && !status; pass++) { /* the first one counts */
        double **vectors[] = {&mg->g, &mg->p, &mg->rest};
        if (pass > 0)
            status = memory_create(&mg->memory);
        grid_lay_out(segments, &mg->memory, &mg->grid);
        v_cycle_lay_out(&mg->grid, &mg->memory, &mg->cycle);
        tiles_lay_out(&mg->grid, &mg->memory, &mg->tiles);
        for (int i = 0; i < 3; i++)
            *vectors[i] = memory_piece(
                &mg->memory, 2 * (size_t)mg->grid.rows.plane * sizeof(double));
    }
    if (status) {
        free(mg);
        *multigrid = NULL;
    }
    return status;
}

void multigrid_free(Multigrid *mg)
{
    if (!mg)
        return;
    free(mg->memory.base);
    free(mg);
}

/* ---- who makes a minimisation ---- */

/* Why multigrid does not take it, or NULL: only springs, with or without
 * damping, may have an energy, and what draws nodes to points. */
static const char *refusal(const Newton *newton)
{
    const NewtonSettings *settings = &newton->settings;
    const System *system = newton->system;
    bool alone = system_find_term(system, &mass_spring_energy);
    for (int t = 0; alone && t < system->terms; t++) {
        const TermKind *kind = system->term[t].kind;
        alone = kind == &mass_spring_energy || kind->diagonal || !kind->value;
    }
    if (system->segments == 0)
        return "there is no square grid";
    if (!alone)
        return "there are energies beside the springs'";
    if (settings->filter != FILTER_CLAMP)
        return "the projection is not clamp";
    if (settings->search != LINE_SEARCH_BACKTRACK)
        return "there is no line search";
    if (newton->rounding.blurred) /* the test would need more digits */
        return "springs outweigh the masses too far";
    return NULL;
}

bool multigrid_takes(Newton *newton)
{
    Solver solver = newton->settings.solver;
    bool wanted = solver == SOLVER_AUTO
                      ? newton->system->segments > AUTO_NEWTON_SEGMENTS
                      : solver == SOLVER_MULTIGRID;
    newton->refusal = wanted ? refusal(newton) : NULL;
    wanted = wanted && !newton->refusal;
    newton->working = wanted ? SOLVER_MULTIGRID : SOLVER_NEWTON;
    return wanted;
}

/* ---- the test ---- */

/* g at x, and the bound of the residual. */
static void evaluate(Newton *newton)
{
    Multigrid *mg = newton->multigrid;
    mg->square = grid_gradient(&mg->grid, mg->g);
    mg->bound = sqrt(2 / mg->grid.lightest * mg->square) /
                (newton->settings.h * mg->grid.length);
    mg->directed = mg->cycle.set_up = false;
    newton->residual = mg->bound;
    newton->kind = RESIDUAL_BOUND;
}

/* The test of Algorithm 3 at x: p = -H^-1 g, and its residual, are made so
 * exact that a remainder in double precision decides it.  Returns OK, RUNNING,
 * NOT_FINITE. */
static Status pass_test(Newton *newton)
{
    Multigrid *mg = newton->multigrid;
    const double tolerance = newton->tolerance;
    const double h = newton->settings.h * mg->grid.length;
    double length = h * tolerance, last, now = INFINITY, largest;
    double worth = WORTH_A_TEST * tolerance * mg->grid.segments;
    if (!isfinite(mg->square))
        return STATUS_NOT_FINITE;
    if (mg->bound <= tolerance)
        return STATUS_OK;
    if (!(mg->bound <= fmin(worth, mg->test_below)))
        return STATUS_RUNNING;
    v_solve(&mg->cycle, mg->g, mg->square, TESTED, length, false, mg->p);
    do {
        last = now;
        now = grid_remainder(&mg->grid, mg->g, mg->p, mg->rest, &largest);
        mg->directed = v_decides(&mg->grid, largest, now, length);
        if (!mg->directed)
            v_solve(&mg->cycle, mg->rest, now, REFINED, 0, true, mg->p);
    } while (!mg->directed && now < 0.25 * last);
    mg->test_below = mg->bound / 2;
    newton->kind = RESIDUAL_ESTIMATE;
    newton->residual = largest / h;
    return mg->directed && newton->residual <= tolerance ? STATUS_OK
                                                         : STATUS_RUNNING;
}

/* Newton goes on from the iterate that multigrid has reached; where that is a
 * saddle for one iteration, which leaves it.
 *   why  NOT_A_MINIMUM: it is one */
static Status take_back(Newton *newton, Status why)
{
    int saddles = newton->saddles;
    newton->working = newton->record.solver = SOLVER_NEWTON;
    newton->rounding.E = NAN;
    Status status = why == STATUS_NOT_A_MINIMUM ? direction_from_saddle(newton)
                                                : direction_first(newton);
    newton->lent = newton->saddles > saddles;
    newton->counters.taken_back += status == STATUS_RUNNING && !newton->lent;
    return status;
}

Status multigrid_start(Newton *newton)
{
    Iterate *at = &newton->at;
    const System *system = newton->system;
    double *m = newton->x_trial, *u_tilde = newton->u_trial;
    Status status = STATUS_OK;
    if (!newton->multigrid)
        status = multigrid_create(system->segments, &newton->multigrid);
    if (status)
        return status;
    Multigrid *mg = newton->multigrid;
    newton->lent = newton->bends_down = mg->stalls = false;
    newton->working = newton->record.solver = SOLVER_MULTIGRID;
    newton->record.factorised = false;
    newton->record.projected = 0;
    newton->record.shift = 0;
    mg->last_bound = mg->test_below = INFINITY;
    mg->largest = mg->directions = 0;
    incremental_potential_inertia(at, m, u_tilde);
    if (mg->weight != at->E.weight || mg->version != system->version) {
        grid_read_system(&mg->grid, at, m);
        v_cycle_read_system(&mg->cycle);
    }
    mg->weight = at->E.weight;
    mg->version = system->version;
    grid_read_state(&mg->grid, at, u_tilde);
    evaluate(newton);
    status = pass_test(newton);
    grid_write_state(&mg->grid, at);
    newton->counters.cycles = mg->cycle.cycles;
    /* A gradient that vanishes may be that of a maximum: Newton looks. */
    if (status == STATUS_OK && newton->kind == RESIDUAL_BOUND)
        return take_back(newton, status);
    status = status == STATUS_OK ? direction_judges_end(newton) : status;
    return status == STATUS_NOT_A_MINIMUM ? take_back(newton, status) : status;
}

/* ---- the iteration ---- */

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

/* Direction, step to where E is lowest along it, tiles where it stalls, and the
 * test of where that led. */
static Status iterate(Newton *newton)
{
    Multigrid *mg = newton->multigrid;
    NewtonRecord *record = &newton->record;
    const double bound = mg->bound, unit = mg->grid.energy;
    Quartic along;
    record->kind = RESIDUAL_ESTIMATE;
    if (!mg->directed)
        record->residual =
            v_solve(&mg->cycle, mg->g, mg->square, ENOUGH, 0, false, mg->p) /
            (newton->settings.h * mg->grid.length);
    grid_along(&mg->grid, mg->g, mg->p, along.q);
    for (int i = 0; i < 4; i++)
        along.q[i] /= unit;
    record->slope = along.q[0];
    record->alpha = record->change = record->trials = 0;
    if (!isfinite(record->slope))
        return STATUS_NOT_FINITE;
    if (!(record->slope <= 0))
        return STATUS_NOT_DESCENT;
    record->alpha = lowest(&along, &record->trials);
    if (!(record->alpha > 0))
        return STATUS_LINE_SEARCH_LIMIT;
    record->change = quartic_value(&along, record->alpha);
    grid_move(&mg->grid, record->alpha, mg->p);
    mg->stalls = mg->stalls || (mg->directions >= DIRECTIONS &&
                                bound > STALLS * mg->last_bound);
    mg->last_bound = bound;
    mg->directions++;
    newton->counters.iterations++;
    int tiles = mg->tiles.high * mg->tiles.wide;
    if (mg->stalls)
        record->change +=
            tiles_relax(&mg->tiles, PACE * record->change * unit / tiles) /
            unit;
    evaluate(newton);
    return pass_test(newton);
}

Status multigrid_iterate(Newton *newton, NewtonRecord *done)
{
    Multigrid *mg = newton->multigrid;
    Status status = iterate(newton);
    newton->counters.cycles = mg->cycle.cycles;
    newton->counters.local = mg->tiles.sweeps;
    *done = newton->record;
    mg->largest = fmin(mg->largest, done->change);
    bool last = done->iteration + 1 >= newton_most_iterations(newton);
    bool small = fabs(done->change) <= SMALL_CHANGE * -mg->largest;
    bool many = done->iteration >= HANDED_ITERATIONS;
    bool runs = status == STATUS_RUNNING;
    if (last || small || many || !runs || newton->settings.observer)
        grid_write_state(&mg->grid, &newton->at); /* else nobody looks at it */
    /* It has come to its end without passing the test. */
    bool stuck = runs ? many || (small && rounding_hides(newton, done->change))
                      : status != STATUS_OK;
    status = status == STATUS_OK ? direction_judges_end(newton) : status;
    if (stuck || status == STATUS_NOT_A_MINIMUM)
        status = take_back(newton, status);
    return status == STATUS_RUNNING && last ? STATUS_ITERATION_LIMIT : status;
}
