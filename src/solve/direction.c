/* direction.c - the search direction p = -H^-1 grad E, and its residual. */
#include "solve/newton_parts.h"

#include <math.h>

/* Iterations in which projection on demand clamps after a failed factor. */
enum { CLAMPED_ITERATIONS = 4 };

/* Shifts to try: 1e-15, 1e-13, ... 1e-5 of the largest diagonal entry.  A shift
 * matters for few eigenvectors, so conjugate gradients need few solves.  The
 * iteration ends when r.z is at most ALL_DIGITS times its first value. */
enum { MAX_SHIFTS = 6, CG_MAX_SOLVES = 59 };
static const double ALL_DIGITS = 1e-28;

/* ---- the Hessian and its factor ---- */

void direction_free_matrix(FactoredHessian *direction)
{
    cholesky_free(direction->cholesky);
    direction->cholesky = NULL;
    sparse_free(&direction->A);
}

/* Assembles A, the Hessian at x.  The pattern and the symbolic analysis are
 * made again only if the system's pattern or the kind of factor has changed, or
 * if x needs new entries.  PROJECTION_NONE asks for a factor L D L^T, which
 * allows negative eigenvalues, every other projection for L L^T.  With
 * PROJECTION_ON_DEMAND A is not projected.
 *   projected  out, number of projected blocks
 * Returns OK, TOO_LARGE, OUT_OF_MEMORY. */
static Status assemble_hessian(Newton *newton, Projection projection,
                               int *projected)
{
    FactoredHessian *direction = &newton->factored_hessian;
    const System *system = newton->system;
    CholeskyKind kind =
        projection == PROJECTION_NONE ? CHOLESKY_INDEFINITE : CHOLESKY_DEFINITE;
    bool grown;
    Status status =
        incremental_potential_extend_pattern(&newton->iterate, &grown);
    *projected = 0;
    if (!status &&
        (!direction->cholesky || direction->factor_kind != kind || grown ||
         direction->analysed_pattern_version != system->pattern_version)) {
        direction_free_matrix(direction);
        direction->analysed_pattern_version = system->pattern_version;
        direction->factor_kind = kind;
        status = incremental_potential_create_hessian(system, &direction->A);
        if (!status)
            status = cholesky_create(&direction->A, kind, &direction->cholesky);
    }
    direction->projection =
        projection == PROJECTION_ON_DEMAND ? PROJECTION_NONE : projection;
    if (!status)
        *projected = incremental_potential_hessian(
            &newton->iterate, direction->projection, &direction->A);
    return status;
}

/* Returns the largest diagonal entry of A (slots of the first 2n triplets). */
static double largest_diagonal_entry(const Newton *newton)
{
    const FactoredHessian *direction = &newton->factored_hessian;
    double largest = 0;
    for (int t = 0; t < 2 * newton->system->nodes; t++)
        largest = fmax(largest, direction->A.value[direction->A.slot[t]]);
    return largest;
}

/* Factors A.  If this fails for a projected A, which is semi-definite, rounding
 * is the reason: adds a shift to the diagonal and tries again.  Without
 * projection returns the failure.  Returns OK, NOT_POSITIVE_DEFINITE,
 * NOT_FINITE, OUT_OF_MEMORY. */
static Status factor_hessian(Newton *newton)
{
    FactoredHessian *direction = &newton->factored_hessian;
    direction->shift = 0;
    for (int tries = 0;; tries++) {
        newton->counters.factorisations++;
        Status status = cholesky_factor(direction->cholesky);
        if (status != STATUS_NOT_POSITIVE_DEFINITE || tries == MAX_SHIFTS ||
            direction->projection == PROJECTION_NONE)
            return status;
        double shift = tries > 0 ? 100 * direction->shift
                                 : 1e-15 * largest_diagonal_entry(newton);
        for (int t = 0; t < 2 * newton->system->nodes; t++)
            direction->A.value[direction->A.slot[t]] +=
                shift - direction->shift;
        direction->shift = shift;
    }
}

/* Assembles and factors the Hessian at x.  Projection on demand first tries the
 * unprojected Hessian.  After a failure it clamps, now and in the next
 * iterations (CLAMPED_ITERATIONS). */
static Status assemble_and_factor(Newton *newton)
{
    NewtonRecord *record = &newton->record;
    Projection projection = newton->settings.projection;
    if (projection == PROJECTION_ON_DEMAND &&
        newton->clamped_iterations_left > 0) {
        newton->clamped_iterations_left--;
        projection = PROJECTION_CLAMP;
    }
    Status status =
        assemble_hessian(newton, projection, &record->projected_blocks);
    if (!status)
        status = factor_hessian(newton);
    record->has_new_factor = true;
    record->shift = newton->factored_hessian.shift;
    newton->factored_hessian.moved_since_factor = 0;
    if (!status && newton->factored_hessian.factor_kind == CHOLESKY_INDEFINITE)
        record->negative_pivots =
            cholesky_negative_pivots(newton->factored_hessian.cholesky);
    newton->counters.projected_blocks += record->projected_blocks;
    if (projection != PROJECTION_ON_DEMAND ||
        status != STATUS_NOT_POSITIVE_DEFINITE)
        return status;
    newton->clamped_iterations_left = CLAMPED_ITERATIONS;
    return assemble_and_factor(newton);
}

/* Solves (H + shift I) z = r with the last factor; r and z are in the order of
 * the nodes, not of elimination.  Returns OK, NOT_FINITE, SINGULAR. */
static Status apply_inverse_factor(Newton *newton, const double *r, double *z)
{
    const int *order = newton->system->elimination_index;
    double *b = newton->factored_hessian.b;
    for (int i = 0; i < newton->system->nodes; i++) {
        int place = order[i];
        b[2 * place] = r[2 * i];
        b[2 * place + 1] = r[2 * i + 1];
    }
    Status status = cholesky_solve(newton->factored_hessian.cholesky, b, b);
    for (int i = 0; i < newton->system->nodes && !status; i++) {
        int place = order[i];
        z[2 * i] = b[2 * place];
        z[2 * i + 1] = b[2 * place + 1];
    }
    return status;
}

/* ---- conjugate gradients ---- */

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* State of conjugate gradients for H p = -g (Golub, Van Loan: 11.5) with
 * directions d, residual r = -g - H p, and z = factor^-1 r, where the Cholesky
 * factor of H is the preconditioner.  Products with H are summed term by term:
 * in the assembled matrix small masses are lost to rounding. */
typedef struct ConjugateGradients {
    Projection projection;
    double tolerance; /* the loop ends at r.z <= tolerance * first_rz */
    double rz;        /* r.z, squared size of the residual */
    double first_rz;  /* r.z before the first step */
} ConjugateGradients;

/* Makes a step of conjugate gradients, for a known z.  Returns false at the
 * end: r.z is small enough, or the curvature along d is not positive. */
static bool take_conjugate_step(Newton *newton, ConjugateGradients *state)
{
    const FactoredHessian *direction = &newton->factored_hessian;
    int n = 2 * newton->system->nodes;
    double *r = direction->r, *z = direction->z, *q = direction->q,
           *d = direction->d;
    double *p = newton->iterate.p;
    double last = state->rz;
    state->rz = dot(n, r, z);
    if (last == 0)
        state->first_rz = state->rz;
    if (!(state->rz > state->tolerance * state->first_rz))
        return false;
    for (int i = 0; i < n; i++)
        d[i] = z[i] + (last == 0 ? 0 : state->rz / last * d[i]);
    incremental_potential_apply_hessian(&newton->iterate, state->projection, d,
                                        q);
    double curvature = dot(n, d, q);
    double alpha = state->rz / curvature;
    /* E is not convex along d, or rounding hides its curvature. */
    if (!(curvature > 0) || !(alpha > 0) || !isfinite(alpha))
        return false;
    for (int i = 0; i < n; i++) {
        p[i] += alpha * d[i];
        r[i] -= alpha * q[i];
    }
    return true;
}

/* Computes p = -H^-1 g (slide: search_dir) with the last factor, improved by
 * conjugate gradients if it has a shift.  Returns OK, NOT_FINITE, SINGULAR. */
static Status solve_with_factor(Newton *newton)
{
    const Iterate *at = &newton->iterate;
    const FactoredHessian *direction = &newton->factored_hessian;
    int n = 2 * newton->system->nodes;
    newton->counters.linear_solves++;
    Status status = apply_inverse_factor(newton, at->g, at->p);
    for (int i = 0; i < n; i++)
        at->p[i] = -at->p[i];
    if (status || direction->shift == 0)
        return status;
    ConjugateGradients state = {direction->projection, .tolerance = ALL_DIGITS};
    for (int i = 0; i < n; i++) {
        direction->z[i] = at->p[i]; /* p is factor^-1 (-g), the first z */
        at->p[i] = direction->d[i] = 0;
        direction->r[i] = -at->g[i];
    }
    for (int solves = 0; !status && take_conjugate_step(newton, &state) &&
                         solves < CG_MAX_SOLVES;
         solves++)
        status = apply_inverse_factor(newton, direction->r, direction->z);
    return status;
}

/* Bounds the error of p, with H applied term by term.
 *   error  out, kg^(1/2) m, bound of |p - exact p|_M
 * For a projected H the bound is |g + H p|_(M^-1), as H - M is positive
 * semi-definite.  For an unprojected H with its own factor the bound is
 * 2 |factor^-1 (g + H p)|_M.  With the factor of an earlier H, which may be far
 * stiffer if a contact has opened, H is clamped before the bound is computed.
 * Returns OK, NOT_FINITE, SINGULAR. */
static Status direction_error_bound(Newton *newton, double *error)
{
    const FactoredHessian *direction = &newton->factored_hessian;
    const System *system = newton->system;
    const Iterate *at = &newton->iterate;
    double *r = direction->r, *z = direction->z, square = 0;
    Projection projection = direction->projection;
    if (projection == PROJECTION_NONE && direction->moved_since_factor > 0)
        projection = PROJECTION_CLAMP;
    incremental_potential_apply_hessian(at, projection, at->p, direction->q);
    for (int i = 0; i < 2 * system->nodes; i++)
        r[i] = -at->g[i] - direction->q[i];
    *error = system_inverse_mass_norm(system, r);
    if (projection != PROJECTION_NONE)
        return STATUS_OK;
    Status status = apply_inverse_factor(newton, r, z);
    for (int i = 0; i < 2 * system->nodes; i++)
        square += system->m[i / 2] * z[i] * z[i];
    *error = 2 * sqrt(square);
    return status;
}

/* Makes linear momentum exact by an equal shift of all nodes.  Internal forces
 * cannot move the centre of mass, so sum m (u + p) is sum m u_tilde for the
 * exact p; rounding of a stiff H makes p miss this sum. */
static void correct_momentum(Newton *newton)
{
    const System *system = newton->system;
    const double *u = newton->iterate.u, *u_tilde = newton->u_tilde;
    double *p = newton->iterate.p, mass = 0, missing[2] = {0, 0};
    if (!system_falls_freely(system))
        return;
    for (int i = 0; i < 2 * system->nodes; i++) {
        mass += 0.5 * system->m[i / 2];
        missing[i % 2] += system->m[i / 2] * (u_tilde[i] - u[i] - p[i]);
    }
    for (int i = 0; i < 2 * system->nodes; i++)
        p[i] += missing[i % 2] / mass;
}

/* Computes p = -H^-1 g if H is diagonal, such as for masses without springs.
 * The product of H with a vector of ones is its diagonal. */
static void solve_diagonal(Newton *newton)
{
    const Iterate *at = &newton->iterate;
    double *ones = newton->factored_hessian.b, *H = newton->factored_hessian.q;
    int n = 2 * newton->system->nodes;
    for (int i = 0; i < n; i++)
        ones[i] = 1;
    incremental_potential_apply_hessian(at, PROJECTION_NONE, ones, H);
    for (int i = 0; i < n; i++)
        at->p[i] = at->g[i] == 0 ? 0 : -at->g[i] / H[i];
}

/* Returns max over nodes of |p_x| + |p_y| (m); NaN if p has a NaN.  (numpy's
 * norm(p, inf) of an array of shape (n, 2) is the largest row sum.) */
static double largest_node_norm(int nodes, const double *p)
{
    double largest = 0;
    for (int i = 0; i < 2 * nodes; i += 2) {
        double sum = fabs(p[i]) + fabs(p[i + 1]);
        if (!(sum <= largest))
            largest = sum;
    }
    return largest;
}

/* A negligible direction passes the test, and moves no node by more than this
 * fraction of the shortest spring. */
static const double NEGLIGIBLE = 1e-6;

/* A factor serves again while no node has moved by more than NEARBY of the
 * shortest spring since it was computed.  Each correction of p is at most
 * CONVERGES of the one before, and the last one at most REFINED of p. */
static const double NEARBY = 0.03, CONVERGES = 0.1, REFINED = 0.01;

/* Computes p with the factor of an earlier iteration, as the Hessian hardly
 * changes near the end.  Iterative refinement with the present Hessian,
 *     p += factor^-1 (-g - H p),
 * makes p accurate.  Returns false if p diverges or is not downhill. */
static bool refine_with_old_factor(Newton *newton)
{
    const FactoredHessian *direction = &newton->factored_hessian;
    const int n = 2 * newton->system->nodes;
    double *g = newton->iterate.g, *p = newton->iterate.p;
    double *r = direction->r, *z = direction->z, last = INFINITY, size;
    for (int i = 0; i < n; i++) {
        p[i] = 0;
        r[i] = -g[i];
    }
    for (;;) {
        newton->counters.linear_solves++;
        if (apply_inverse_factor(newton, r, z) != STATUS_OK)
            return false;
        size = largest_node_norm(n / 2, z);
        if (!(size <= CONVERGES * last))
            return false;
        for (int i = 0; i < n; i++)
            p[i] += z[i];
        if (size <= REFINED * largest_node_norm(n / 2, p))
            break;
        last = size;
        newton->record.projected_blocks = incremental_potential_apply_hessian(
            &newton->iterate, direction->projection, p, direction->q);
        for (int i = 0; i < n; i++)
            r[i] = -g[i] - direction->q[i];
    }
    return dot(n, g, p) <= 0;
}

/* norm is |p|_M >= sqrt(m) |p_i|, and |p_x| + |p_y| <= sqrt(2) |p_i|. */
double bound_largest_movement(const Newton *newton, double norm)
{
    return sqrt(2 / newton->rounding.min_mass) * norm;
}

/* Computes the residual of p and tests it against the tolerance.
 *   exact  whether p solves H p = -g up to rounding.  Otherwise the test adds
 *          a bound of the error of p, which leaves out the rounding of g. */
static Status find_residual(Newton *newton, bool exact)
{
    NewtonRecord *record = &newton->record;
    const double h = newton->settings.h;
    Status status = STATUS_OK;
    double error = 0;
    int pivot;
    record->residual =
        largest_node_norm(newton->system->nodes, newton->iterate.p) / h;
    record->residual_kind = exact ? RESIDUAL_EXACT : RESIDUAL_ESTIMATE;
    if (!isfinite(record->residual))
        return STATUS_NOT_FINITE;
    newton->meets_tolerance = record->residual <= newton->tolerance;
    if (!exact && newton->meets_tolerance)
        status = direction_error_bound(newton, &error);
    if (record->residual + bound_largest_movement(newton, error) / h >
            newton->tolerance ||
        (next_direction_may_turn(newton) &&
         !system_turns_freely(newton->system, &pivot)))
        newton->meets_tolerance = false;
    return status;
}

/* Computes g at x, which is valid until x moves. */
static void evaluate_gradient(Newton *newton)
{
    Iterate *at = &newton->iterate;
    incremental_potential_gradient(&at->E, at->u, at->x, at->g);
    newton->has_gradient = true;
}

double negligible_direction_size(const Newton *newton)
{
    return fmin(newton->tolerance * newton->settings.h,
                NEGLIGIBLE * newton->rounding.shortest_spring);
}

/* The projected Hessian minus M is positive semi-definite, so |p|_M is at most
 * |g|_(M^-1), a bound without the Hessian.  With projection on demand the bound
 * holds for the direction of the clamped Hessian. */
bool next_direction_is_negligible(Newton *newton)
{
    if (newton->settings.projection == PROJECTION_NONE)
        return false;
    evaluate_gradient(newton);
    double norm = system_inverse_mass_norm(newton->system, newton->iterate.g);
    return bound_largest_movement(newton, norm) <=
           negligible_direction_size(newton);
}

/* Whether the last factor can serve again, since it was computed in this
 * minimisation, nearby, as L L^T and without a shift. */
static bool factor_is_reusable(const Newton *newton)
{
    const FactoredHessian *direction = &newton->factored_hessian;
    return direction->shift == 0 &&
           newton->settings.projection != PROJECTION_NONE &&
           direction->moved_since_factor <=
               NEARBY * newton->rounding.shortest_spring;
}

/* Computes p with a new factor, and the residual of p. */
static Status solve_with_new_factor(Newton *newton)
{
    Status status = assemble_and_factor(newton);
    if (status == STATUS_OK)
        status = solve_with_factor(newton);
    if (status != STATUS_OK)
        return status;
    correct_momentum(newton);
    /* The factor is inexact if springs hide the masses by rounding, if A has a
     * shift, or if pivots were replaced. */
    return find_residual(
        newton, !newton->rounding.factor_is_inexact &&
                    newton->factored_hessian.shift == 0 &&
                    cholesky_is_exact(newton->factored_hessian.cholesky));
}

Status find_direction(Newton *newton)
{
    newton->meets_tolerance = false;
    if (!newton->has_gradient)
        evaluate_gradient(newton);
    if (incremental_potential_is_diagonal(&newton->iterate.E)) {
        solve_diagonal(newton);
        return find_residual(newton, true);
    }
    if (factor_is_reusable(newton) && refine_with_old_factor(newton)) {
        correct_momentum(newton);
        Status status = find_residual(newton, false);
        bool decided = newton->meets_tolerance ||
                       newton->record.residual > newton->tolerance;
        if (status || decided)
            return status;
    }
    return solve_with_new_factor(newton);
}
