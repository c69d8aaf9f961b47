#include "solve/newton_parts.h"

#include <math.h>
#include <stddef.h>

#include "base/clock.h"
#include "model/mass_spring_energy.h"
#include "solve/multigrid.h"

/* Iterations that multigrid gets; most steps need ten. */
enum { HANDED_ITERATIONS = 200 };

/* A change of E that is this small a part of the step's first one may be
 * rounding: that is looked at. */
static const double SMALL_CHANGE = 1e-9;

/* Whether nodes and springs are those of square_mesh.h. */
static bool is_grid(const System *system)
{
    int n = system->segments;
    return n > 0 && system->nodes == (n + 1) * (n + 1) &&
           system->springs == 2 * n * (n + 1) + 2 * n * n;
}

/* Whether the springs, with or without damping, are all that has an energy. */
static bool has_springs_alone(const System *system)
{
    for (int t = 0; t < system->terms; t++)
        if (system->term[t].kind != &mass_spring_energy &&
            system->term[t].kind->value)
            return false;
    return system_find_term(system, &mass_spring_energy);
}

/* Why multigrid does not take it, or NULL. */
static const char *refusal(const Newton *newton)
{
    const System *system = newton->system;
    const NewtonSettings *settings = &newton->settings;
    if (!is_grid(system))
        return "there is no square grid";
    if (settings->averaged)
        return "the energy is averaged over the step";
    if (!has_springs_alone(system))
        return "there are energies beside the springs'";
    if (settings->filter != FILTER_CLAMP)
        return "the projection is not clamp";
    if (settings->search != LINE_SEARCH_BACKTRACK)
        return "there is no line search";
    if (newton->rounding.blurred) /* the test would need more digits */
        return "springs outweigh the masses too far";
    return NULL;
}

bool newton_takes_multigrid(Newton *newton)
{
    Solver solver = newton->settings.solver;
    int segments = newton->system->segments;
    newton->working = SOLVER_NEWTON;
    newton->refusal = NULL;
    if (solver == SOLVER_AUTO)
        solver =
            segments > AUTO_NEWTON_SEGMENTS ? SOLVER_MULTIGRID : SOLVER_NEWTON;
    if (solver == SOLVER_NEWTON)
        return false;
    newton->refusal = refusal(newton);
    if (!newton->refusal)
        newton->working = SOLVER_MULTIGRID;
    return !newton->refusal;
}

/* u and x from multigrid; the residual as far as it is known. */
static void fetch(Newton *newton)
{
    const MultigridRecord *end = multigrid_record(newton->multigrid);
    Iterate *at = &newton->at;
    multigrid_displacement(newton->multigrid, at->u);
    for (int i = 0; i < 2 * newton->system->nodes; i++)
        at->x[i] = at->E.x_n[i] + at->u[i];
    newton->residual = end->after;
    newton->kind = end->decided ? RESIDUAL_ESTIMATE : RESIDUAL_BOUND;
}

/* Newton goes on from the iterate that multigrid has reached; where that is a
 * saddle for one iteration, which leaves it. */
static Status take_back(Newton *newton)
{
    int saddles = newton->saddles;
    newton->working = newton->record.solver = SOLVER_NEWTON;
    newton->rounding.E = NAN;
    Status status = direction_first(newton);
    newton->lent = newton->saddles > saddles;
    newton->counters.taken_back += status == STATUS_RUNNING && !newton->lent;
    return status;
}

Status newton_multigrid_start(Newton *newton)
{
    const System *system = newton->system;
    const NewtonSettings *settings = &newton->settings;
    Status status = STATUS_OK;
    if (!newton->multigrid)
        status = multigrid_create(system->segments, 0, &newton->multigrid);
    if (status)
        return status;
    double start = clock_now();
    const Iterate *at = &newton->at;
    Place place = place_at(system, at->E.x_n, at->u, at->x);
    MultigridStep step = {.version = system->version,
                          .x_n = at->E.x_n,
                          .u = at->u,
                          .u_tilde = newton->u_tilde,
                          .m = system->m,
                          .pinned = system->pinned,
                          .k = place.k,
                          .l2 = place.l2,
                          .weight = at->E.weight,
                          .h = settings->h,
                          .tolerance = settings->tolerance,
                          .is_free = system_is_free(system),
                          .counters = &newton->counters};
    status = multigrid_start(newton->multigrid, &step);
    fetch(newton);
    newton->counters.seconds_multigrid += clock_now() - start;
    newton->first_change = 0;
    /* A gradient that vanishes may be that of a maximum: Newton looks. */
    if (status == STATUS_OK && newton->kind == RESIDUAL_BOUND)
        return take_back(newton);
    status = status == STATUS_OK ? direction_judges_end(newton) : status;
    return status == STATUS_NOT_A_MINIMUM ? take_back(newton) : status;
}

Status newton_multigrid_again(Newton *newton)
{
    newton->lent = newton->bends_down = false;
    newton->working = newton->record.solver = SOLVER_MULTIGRID;
    return newton_multigrid_start(newton);
}

/* Whether multigrid has come to its end without the test being passed.
 *   last  no more iterations are allowed */
static bool is_stuck(Newton *newton, Status status, bool last)
{
    const NewtonRecord *record = &newton->record;
    newton->first_change = fmin(newton->first_change, record->change);
    bool small = fabs(record->change) <= SMALL_CHANGE * -newton->first_change;
    bool many = record->iteration >= HANDED_ITERATIONS;
    if (last || small || many || status != STATUS_RUNNING ||
        newton->settings.observer)
        fetch(newton); /* else nobody looks at it */
    if (status != STATUS_RUNNING)
        return status != STATUS_OK;
    return many || (small && rounding_hides(newton, record->change));
}

Status newton_multigrid_iterate(Newton *newton)
{
    double start = clock_now();
    NewtonRecord *record = &newton->record;
    Status status = multigrid_iterate(newton->multigrid);
    const MultigridRecord *did = multigrid_record(newton->multigrid);
    record->iteration++;
    record->residual = did->residual;
    record->kind = RESIDUAL_ESTIMATE;
    record->slope = did->slope;
    record->alpha = did->alpha;
    record->change = did->change;
    record->trials = did->trials;
    record->solver = SOLVER_MULTIGRID;
    newton->counters.trials += record->trials;
    NewtonRecord done = *record;
    bool last = done.iteration + 1 >= newton_most_iterations(newton);
    bool stuck = is_stuck(newton, status, last);
    status = status == STATUS_OK ? direction_judges_end(newton) : status;
    stuck = stuck || status == STATUS_NOT_A_MINIMUM;
    newton->counters.seconds_multigrid += clock_now() - start;
    if (stuck)
        status = take_back(newton);
    if (status == STATUS_RUNNING && last)
        status = STATUS_ITERATION_LIMIT;
    done.status = status;
    done.seconds = clock_now() - start;
    return newton->status = newton_tell(newton, &done);
}
