/* rounding.c - tests of whether rounding hides a decrease of E. */
#include "solve/newton_parts.h"

#include <float.h>
#include <math.h>

/* After this many iterations without a smaller residual rounding is tested. */
enum { MIN_STAGNANT_ITERATIONS = 20 };

/* Without a line search updates may go round in circles.  After this many
 * iterations without a smaller residual the loop ends.  (Of 1100 steps with
 * contact one converged later.) */
enum { MAX_STAGNANT_ITERATIONS = 500 };

/* Limits of w max_stiffness / min_mass, w being P's weight.  Above
 * STIFF_MASSES, rounding of the gradient may hide that E rises along p.  Above
 * INEXACT_MASSES, a direction from a factor may have a relative error of 1e-5.
 * Above HIDDEN_MASSES, mass plus stiffness rounds to the stiffness. */
static const double STIFF_MASSES = 1e5, INEXACT_MASSES = 1e10,
                    HIDDEN_MASSES = 1e16;

/* Fraction by which E may exceed its value at the start, since E is rounded. */
static const double MARGIN = 1e-12;

/* E at the end of a line may be above its prediction by AGREED times the sum of
 * E at both ends plus BLURS times the effect of rounded coordinates on E.
 * (Samples of this effect differ by large factors.) */
static const double AGREED = 1e-10, BLURS = 100;

void rounding_prepare(Newton *newton)
{
    const Iterate *at = &newton->iterate;
    const System *system = newton->system;
    RoundingChecks *rounding = &newton->rounding;
    if (rounding->bounds_version != system->version + 1) {
        rounding->bounds_version = system->version + 1;
        rounding->min_mass = INFINITY;
        for (int i = 0; i < system->nodes; i++)
            rounding->min_mass = fmin(rounding->min_mass, system->m[i]);
        double l2 = system->springs ? INFINITY : 1;
        for (int s = 0; s < system->springs; s++)
            l2 = fmin(l2, system->l2[s]);
        rounding->shortest_spring = sqrt(l2);
        rounding->max_stiffness = system_max_stiffness(system);
    }
    rounding->best_residual = INFINITY;
    rounding->stagnant_iterations = 0;
    rounding->E = NAN;
    double stiffness = at->E.weight * rounding->max_stiffness;
    rounding->is_stiff = stiffness > STIFF_MASSES * rounding->min_mass;
    rounding->factor_is_inexact =
        stiffness > INEXACT_MASSES * rounding->min_mass;
    rounding->energy_limit = INFINITY;
    rounding->start_energy = NAN;
    if (newton->settings.line_search != LINE_SEARCH_NONE &&
        stiffness <= HIDDEN_MASSES * rounding->min_mass)
        return;
    rounding->start_energy = incremental_potential_value(&at->E, at->u, at->x);
    rounding->energy_limit =
        rounding->start_energy + MARGIN * rounding->start_energy;
}

bool is_below_roundoff(const Newton *newton, double change)
{
    const Iterate *at = &newton->iterate;
    double E = incremental_potential_value(&at->E, at->u, at->x);
    return isfinite(E) && fabs(change) <= 4 * DBL_EPSILON * E;
}

/* Returns how much E changes when each coordinate's last bits change. */
static double sample_coordinate_rounding(Newton *newton, const double *u,
                                         const double *x, double E)
{
    double *near_u = newton->factored_hessian.r,
           *near_x = newton->factored_hessian.b;
    for (int i = 0; i < 2 * newton->system->nodes; i++) {
        double part = 16 * (fmod(0.6180339887 * (i + 1), 1) - 0.5);
        near_u[i] = u[i] * (1 + part * DBL_EPSILON);
        near_x[i] = x[i] * (1 + part * DBL_EPSILON);
    }
    return fabs(
        incremental_potential_value(&newton->iterate.E, near_u, near_x) - E);
}

/* The change of E may lie above record.energy_change by the rounding of E and
 * by that of the coordinates.  The estimate for the coordinates needs E twice
 * more, and is computed only if the rounding of E does not explain the
 * difference. */
bool energy_confirms_change(Newton *newton)
{
    RoundingChecks *rounding = &newton->rounding;
    const Iterate *at = &newton->iterate;
    const double *u = newton->u_trial, *x = newton->x_trial;
    if (newton->settings.line_search == LINE_SEARCH_NONE ||
        !rounding->is_stiff || rounding->energy_limit < INFINITY)
        return true;
    if (isnan(rounding->E))
        rounding->E = incremental_potential_value(&at->E, at->u, at->x);
    double E = rounding->E_trial = incremental_potential_value(&at->E, u, x);
    double above = E - rounding->E - newton->record.energy_change;
    double agreed = AGREED * (rounding->E + E);
    if (above <= agreed)
        return true;
    double blur = sample_coordinate_rounding(newton, u, x, E) +
                  sample_coordinate_rounding(newton, at->u, at->x, rounding->E);
    return !(above > agreed + BLURS * blur);
}

bool energy_is_within_limit(const Newton *newton, const double *u,
                            const double *x)
{
    double most = newton->rounding.energy_limit;
    return most == INFINITY ||
           incremental_potential_value(&newton->iterate.E, u, x) <= most;
}

Status rounding_test_stagnation(Newton *newton)
{
    RoundingChecks *rounding = &newton->rounding;
    if (newton->record.residual < rounding->best_residual) {
        rounding->best_residual = newton->record.residual;
        rounding->stagnant_iterations = 0;
        return STATUS_RUNNING;
    }
    rounding->stagnant_iterations++;
    if (rounding->stagnant_iterations >= MIN_STAGNANT_ITERATIONS &&
        is_below_roundoff(newton, newton->record.energy_change))
        return STATUS_ROUNDING_LIMIT;
    return rounding->stagnant_iterations >= MAX_STAGNANT_ITERATIONS &&
                   newton->settings.line_search == LINE_SEARCH_NONE
               ? STATUS_ITERATION_LIMIT
               : STATUS_RUNNING;
}
