/* stress_watch.c - tests every step and every Newton iteration from outside. */
#include "model/cells.h"
#include "model/damping.h"
#include "model/fracture.h"
#include "model/friction.h"
#include "model/mass_spring_energy.h"
#include "model/neo_hookean.h"
#include "model/plasticity.h"
#include "model/pull_energy.h"
#include "model/self_contact.h"
#include "stress.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Factor of the allowed rounding error, for sums of many terms */
enum { ROUNDING_SAFETY_FACTOR = 16 };

/* Energy, J s^2, above which overflow is near and NOT_FINITE is right */
static const long double HUGE_ENERGY = 1e280L;

/* Area over rest area below which coordinates hardly resolve a cell */
#define FLAT_CELL 1e-12

/* Unknowns above which no dense matrix is factored, which costs n^3 */
enum { MAX_DENSE_UNKNOWNS = 400 };

/* Factor of the noise of exact_residual for shaken squares, whose coordinates
 * and forces have very different sizes */
enum { PERTURBED_NOISE_FACTOR = 4 };

/* Largest relative error of a direction that rounding.c accepts */
#define DIRECTION_TOLERANCE 1e-5

/* Marks the step as wrong; the first reason is kept. */
static void mark_wrong(RunWatch *watch, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void mark_wrong(RunWatch *watch, const char *format, ...)
{
    va_list arguments;
    if (watch->is_wrong)
        return;
    watch->is_wrong = true;
    va_start(arguments, format);
    int used = snprintf(watch->reason, sizeof watch->reason,
                        "step %ld: ", watch->run->steps);
    vsnprintf(watch->reason + used, sizeof watch->reason - (size_t)used, format,
              arguments);
    va_end(arguments);
}

static int count_unknowns(const RunWatch *watch)
{
    return 2 * watch->run->system->nodes;
}

/* Returns the potential of the present minimisation, with the stored x_n. */
static IncrementalPotential get_minimised_E(const RunWatch *watch)
{
    IncrementalPotential E = watch->run->newton->iterate.E;
    E.x_n = watch->x_n;
    return E;
}

/* Returns the present E and the time of the walls' motion in the step. */
static StepPotential get_step_potential(const RunWatch *watch)
{
    double moved =
        watch->run->is_driven ? watch->run->moved_fraction * watch->run->h : 0;
    return (StepPotential){get_minimised_E(watch), moved};
}

/* Tests the residual of a large square of springs, whose blocks are clamped. */
static void judge_cg_residual(RunWatch *watch, const double *u,
                              double tolerance)
{
    IncrementalPotential E = get_minimised_E(watch);
    const NewtonSettings *settings = &watch->run->newton->settings;
    if (settings->projection != PROJECTION_CLAMP)
        return;
    TestVerdict verdict = test_cg_residual(&E, u, settings->h, tolerance);
    watch->tally->judged_residuals++;
    watch->tally->undecided_tests += verdict == TEST_UNDECIDED;
    if (verdict == TEST_FAILED)
        mark_wrong(watch, "converged, but the residual is above %g m/s",
                   tolerance);
}

/* Type of exact_residual and, with 34 digits, of wide_exact_residual */
typedef double (*ResidualFunction)(const IncrementalPotential *E,
                                   const double *u, const double *x, double h,
                                   double moved, int lifts, double *noise);

/* Returns true if the residual at u is at most the limit, m/s. With projection
 * on demand p may come from either Hessian, projected or exact.
 *   noise  out, m/s, allowed error by rounding; NULL: none
 *   least  out, m/s, smallest residual */
static bool residual_is_low(const RunWatch *watch, const double *u,
                            double limit, ResidualFunction judge, double *noise,
                            double *least)
{
    static const int lifts[PROJECTION_COUNT] = {[PROJECTION_CLAMP] = 1,
                                                [PROJECTION_NONE] = 0,
                                                [PROJECTION_ABS] = 2,
                                                [PROJECTION_ON_DEMAND] = 1};
    const NewtonSettings *settings = &watch->run->newton->settings;
    StepPotential potential = get_step_potential(watch);
    *least = INFINITY;
    for (int i = 0; i < count_unknowns(watch); i++)
        watch->workspace[i] = watch->x_n[i] + u[i];
    bool either = settings->projection == PROJECTION_ON_DEMAND;
    for (int k = 0; k <= either; k++) {
        double residual = judge(&potential.E, u, watch->workspace, settings->h,
                                potential.motion_time,
                                lifts[settings->projection] - k, noise);
        *least = fmin(*least, residual);
        if (noise && watch->only_springs)
            *noise *= PERTURBED_NOISE_FACTOR;
        if (residual <= limit + (noise ? *noise : 0))
            return true;
    }
    return false;
}

/* Tests the residual at u by the oracle, with all terms of E. A failed test is
 * repeated with 34 digits, since rounding raises small residuals, and then with
 * the rounding error added to the limit; the residual counts as undecided. */
static void judge_residual(RunWatch *watch, const double *u, double limit)
{
    double noise, residual;
    watch->tally->judged_residuals++;
    limit *= 1 + DIRECTION_TOLERANCE;
    if (residual_is_low(watch, u, limit, exact_residual, NULL, &residual) ||
        residual_is_low(watch, u, limit, wide_exact_residual, NULL, &residual))
        return;
    watch->tally->undecided_tests++;
    if (!residual_is_low(watch, u, limit, wide_exact_residual, &noise,
                         &residual))
        mark_wrong(
            watch,
            "converged, but the residual is %g m/s, tolerance %g, rounding "
            "%g",
            residual, limit, noise);
}

/* Tests that the residual at u is below the limit, m/s. */
static void judge_convergence(RunWatch *watch, const double *u, double limit)
{
    if (watch->tests_residuals && count_unknowns(watch) <= MAX_DENSE_UNKNOWNS)
        judge_residual(watch, u, limit);
    else if (watch->tests_residuals && watch->only_springs)
        judge_cg_residual(watch, u, limit);
}

/* Tests the residual at the end of a minimisation: before the last update if
 * its direction passed the test, else after the last update. Then, without
 * multigrid, the limit of p is at most a millionth of the shortest spring. */
static void judge_step_end(RunWatch *watch)
{
    const Newton *newton = watch->run->newton;
    const System *system = newton->system;
    double l2 = system->springs ? INFINITY : 1;
    for (int s = 0; s < system->springs; s++)
        l2 = fmin(l2, system->l2[s]);
    bool guess = watch->run->is_driven && watch->run->remaining_fraction > 0;
    double limit = guess ? newton->tolerance : watch->tolerance;
    if (newton->meets_tolerance)
        judge_convergence(watch, watch->u, limit);
    else if (newton->active_solver == SOLVER_MULTIGRID)
        judge_convergence(watch, newton->iterate.u, limit);
    else
        judge_convergence(watch, newton->iterate.u,
                          fmin(limit, 1e-6 * sqrt(l2) / newton->settings.h));
}

/* Returns true if E rises between two iterates by more than rounding
 * explains, with 34 digits if 19 are too few. */
static bool energy_rises(RunWatch *watch, const double *from, const double *to,
                         Real rise, Real scale)
{
    StepPotential potential = get_step_potential(watch);
    if (rise <= 0)
        return false;
    for (int i = 0; i < count_unknowns(watch); i++)
        watch->workspace[i] = to[i] - from[i];
    Real allowed = ROUNDING_SAFETY_FACTOR *
                   (DBL_EPSILON * scale +
                    estimate_energy_noise(&potential, from, watch->workspace) +
                    estimate_energy_noise(&potential, to, watch->workspace));
    return !(rise <= allowed) &&
           !(wide_exact_E_change(&potential.E, from, to,
                                 potential.motion_time) <= allowed);
}

/* Begins to watch a minimisation, which starts at u = 0 or where the walls and
 * pins of this step have moved nodes. */
static void begin_minimisation(RunWatch *watch)
{
    int n = count_unknowns(watch);
    const Newton *newton = watch->run->newton;
    memcpy(watch->x_n, newton->iterate.E.x_n, (size_t)n * sizeof *watch->x_n);
    for (int i = 0; i < n; i++)
        watch->u[i] = watch->run->is_driven ? watch->run->new_x[i] : 0;
    if (!system_find_term(watch->run->system, &cell_energy))
        watch->crossing_count = edge_crossings(watch->run->system, watch->x_n);
    StepPotential potential = get_step_potential(watch);
    watch->start_energy = watch->energy = exact_energy(&potential, watch->u);
    watch->update_count = 0;
}

/* Tests that E at this iterate is not above E at the last one. Iterates with a
 * cell that moving walls have flattened are skipped: rounding decides its E. */
static void check_descent(RunWatch *watch, const double *u, const char *where)
{
    StepPotential potential = get_step_potential(watch);
    long double energy = exact_energy(&potential, u);
    long double scale = fabsl(energy - watch->start_energy) +
                        fabsl(watch->energy - watch->start_energy);
    bool was_flat = watch->has_flat_cell, flat = watch->run->is_driven;
    watch->has_flat_cell =
        smallest_area_ratio(potential.E.system, watch->run->newton->iterate.x) <
        FLAT_CELL;
    flat =
        flat && (watch->has_flat_cell || was_flat || !isfinite(watch->energy));
    if (!isfinite(energy) && !flat)
        mark_wrong(watch, "E is %Lg %s", energy, where);
    if (!flat &&
        energy_rises(watch, watch->u, u, energy - watch->energy, scale))
        mark_wrong(watch, "E rises from %.17Lg to %.17Lg %s", watch->energy,
                   energy, where);
    watch->energy = energy;
}

/* Tests that LINE_SEARCH_LIMIT and NOT_DESCENT are reported only where rounding
 * does not hide the slope. */
static void check_failure_reason(RunWatch *watch, const NewtonRecord *record)
{
    IncrementalPotential E = get_minimised_E(watch);
    long double scale = 0;
    if (!watch->only_springs || (record->status != STATUS_LINE_SEARCH_LIMIT &&
                                 record->status != STATUS_NOT_DESCENT))
        return;
    for (int i = 0; i < count_unknowns(watch); i++) {
        long double away = (long double)watch->u[i] - E.u_tilde[i];
        scale += 0.5L * E.system->m[i / 2] * away * away;
    }
    scale +=
        E.weight * exact_potential(E.system, watch->run->newton->iterate.x);
    if (fabs(record->slope) < 3 * DBL_EPSILON * scale)
        mark_wrong(watch, "%s, but the slope %g is lost in E = %Lg",
                   status_name(record->status), record->slope, scale);
}

/* Tests that no node is behind a wall and no triangle is turned over. */
static void check_gaps_and_areas(RunWatch *watch, const double *x)
{
    double gap = find_smallest_gap(watch->run->system, x);
    double J = smallest_area_ratio(watch->run->system, x);
    if (!(gap > 0) || !(J > 0))
        mark_wrong(watch, "the smallest gap is %g, the smallest cell %g", gap,
                   J);
}

/* Tests that no more edges cross than at the start of the step. Edges may cross
 * at the start if a break has uncovered cells that had turned over. */
static void check_crossings(RunWatch *watch, const double *x)
{
    long crossings = edge_crossings(watch->run->system, x);
    if (crossings > watch->crossing_count)
        mark_wrong(watch, "%ld edges cross, %ld did", crossings,
                   watch->crossing_count);
}

/* Tests an iterate: the observer of Newton's method. */
static bool check_iterate(void *user, const NewtonRecord *record)
{
    RunWatch *watch = user;
    const Newton *newton = watch->run->newton;
    if (record->iteration < 0) /* record of prescribed motion */
        return true;
    if (record->iteration == 0)
        begin_minimisation(watch);
    check_crossings(watch, newton->iterate.x);
    if (record->iteration != watch->update_count)
        mark_wrong(watch, "record %d after %d updates", record->iteration,
                   watch->update_count);
    watch->update_count++;
    if (watch->update_count > newton->settings.max_iterations)
        mark_wrong(watch, "%d iterations, more than allowed",
                   watch->update_count);
    for (int i = 0; i < count_unknowns(watch); i++)
        if (!isfinite(newton->iterate.u[i]) || !isfinite(newton->iterate.x[i]))
            mark_wrong(watch, "iterate %d is not finite", watch->update_count);
    if (newton->settings.line_search != LINE_SEARCH_NONE)
        check_descent(watch, newton->iterate.u, "in an iteration");
    check_failure_reason(watch, record);
    check_gaps_and_areas(watch, newton->iterate.x);
    if (record->status == STATUS_OK)
        judge_step_end(watch);
    memcpy(watch->u, newton->iterate.u,
           (size_t)count_unknowns(watch) * sizeof *watch->u);
    return true;
}

bool watch_create(TimeIntegrator *run, VerdictTally *tally, RunWatch *watch)
{
    *watch = (RunWatch){.run = run,
                        .tally = tally,
                        .tests_residuals = true,
                        .only_springs = true};
    size_t n = (size_t)count_unknowns(watch);
    double **vectors[] = {&watch->x, &watch->v, &watch->x_n, &watch->u,
                          &watch->workspace};
    bool good = true;
    for (int i = 0; i < 5; i++)
        good = (*vectors[i] = calloc(n, sizeof(double))) && good;
    for (int i = 0; i < run->system->term_count; i++) {
        const TermKind *kind = run->system->term[i].kind;
        if (kind != &mass_spring_energy && kind != &central_field &&
            kind != &hand_energy)
            watch->only_springs = false;
    }
    if (run->newton) {
        run->newton->settings.observer = check_iterate;
        run->newton->settings.user_data = watch;
    }
    return good;
}

void watch_free(RunWatch *watch)
{
    if (watch->run->newton)
        watch->tally->updates += watch->run->newton->counters.updates;
    free(watch->x);
    free(watch->v);
    free(watch->x_n);
    free(watch->u);
    free(watch->workspace);
    *watch = (RunWatch){0};
}

Status restart_watched_run(TimeIntegrator *run)
{
    TimeIntegrator old = *run;
    NewtonSettings settings = {.h = old.h, .tolerance = 1};
    if (old.newton)
        settings = old.newton->settings;
    settings.h = old.h;
    Status status = time_integrator_create(old.method, old.system, &settings,
                                           old.x, old.v, run);
    time_integrator_free(&old);
    return status;
}

/* Returns true if energies may overflow in this step; always without Newton. */
static bool overflow_is_near(const RunWatch *watch)
{
    const System *system = watch->run->system;
    long double h = watch->run->h, sum = 0;
    for (int i = 0; i < count_unknowns(watch); i++)
        sum = fmaxl(sum, fabsl(watch->x[i]) + h * fabsl(watch->v[i]));
    sum = sum * sum;
    for (int s = 0; s < system->springs; s++) {
        long double strain = sum / system->l2[s];
        if (h * h * system->k[s] * strain * sum > HUGE_ENERGY ||
            system->k[s] * strain * strain > HUGE_ENERGY)
            return true;
    }
    return sum > HUGE_ENERGY || !watch->run->newton;
}

/* Tests that a failed step left the state as it was, and had a reason. */
static void check_failed_step(RunWatch *watch, Status status)
{
    size_t bytes = (size_t)count_unknowns(watch) * sizeof *watch->x;
    if (memcmp(watch->run->x, watch->x, bytes) != 0 ||
        memcmp(watch->run->v, watch->v, bytes) != 0)
        mark_wrong(watch, "%s, but the state moved", status_name(status));
    if (status != STATUS_NOT_FINITE)
        mark_wrong(watch, "fails with %s", status_name(status));
    else if (!overflow_is_near(watch))
        mark_wrong(watch, "not_finite, but nothing is near overflow");
}

/* Returns true if only gravity and one pin act on the bodies from outside, and
 * backward Euler makes the step.
 *   pin  out, the pinned node, or -1 */
static bool momentum_is_conserved(const TimeIntegrator *run, int *pin)
{
    static const TermKind *const inner[] = {&mass_spring_energy,
                                            &neo_hookean_energy,
                                            &self_contact_energy,
                                            &cell_energy,
                                            &plastic_energy,
                                            &fracture,
                                            &damping,
                                            &self_friction_energy};
    bool free =
        !run->is_driven && strcmp(run->method->name, "backward-euler") == 0;
    *pin = -1;
    for (int i = 0; i < run->system->nodes && run->system->is_pinned; i++)
        if (run->system->is_pinned[i]) {
            free = free && *pin < 0;
            *pin = i;
        }
    for (int t = 0; t < run->system->term_count; t++) {
        bool found = false;
        for (int k = 0; k < 8; k++)
            found = found || run->system->term[t].kind == inner[k];
        free = free && found;
    }
    return free;
}

/* Tests that gravity alone changes momentum and angular momentum. Without a pin
 * the sum of m (v_new - v_old - h g) is 0 up to the tolerance, which bounds the
 * last direction; the sum's moment about the pin, or the centre of mass, too.
 * Moments are not tested after projection (multigrid clamps compressed springs
 * and does not count them) or with friction across a gap. */
static void check_step_momentum(RunWatch *watch, int pin)
{
    const TimeIntegrator *run = watch->run;
    const double *g = run->system->gravity, *m = run->system->m;
    Real mass = 0, sum[2] = {0}, middle[2] = {0}, turn = 0, arms = 0, noise = 0;
    Real unsure = 0; /* rounding error of the lever arms, kg m^2/s */
    for (int i = 0; i < count_unknowns(watch); i++) {
        middle[i % 2] += (Real)m[i / 2] * run->x[i];
        mass += 0.5L * m[i / 2];
    }
    for (int c = 0; c < 2 && pin >= 0; c++)
        middle[c] = mass * run->x[2 * pin + c];
    for (int i = 0; i < count_unknowns(watch); i++) {
        Real change = (Real)run->v[i] - watch->v[i] - (Real)run->h * g[i % 2];
        Real arm = run->x[i ^ 1] - middle[1 - i % 2] / mass;
        sum[i % 2] += m[i / 2] * change;
        turn += (i % 2 ? 1 : -1) * m[i / 2] * arm * change;
        arms = fmaxl(arms, fabsl(arm));
        unsure += m[i / 2] * fabsl(change) * DBL_EPSILON * fabs(run->x[i ^ 1]);
        noise += m[i / 2] * ROUNDING_SAFETY_FACTOR * DBL_EPSILON *
                 (fabs(run->v[i]) + fabs(watch->v[i]) +
                  (fabs(run->x[i]) + fabs(watch->x[i])) / run->h);
    }
    bool projected = run->newton->record.projected_blocks != 0;
    for (int s = 0; s < run->system->springs; s++)
        projected =
            projected || (run->newton->active_solver == SOLVER_MULTIGRID &&
                          exact_strain(run->system, run->x, s) < 0);
    Real limit = mass * watch->tolerance + noise;
    if (pin < 0 && fabsl(sum[0]) + fabsl(sum[1]) > limit)
        mark_wrong(watch, "momentum is off by (%Lg, %Lg) kg m/s, tolerance %Lg",
                   sum[0], sum[1], limit);
    if (!projected && !system_find_term(run->system, &self_friction_energy) &&
        fabsl(turn) > 4 * arms * limit + unsure)
        mark_wrong(watch, "angular momentum is off by %Lg kg m^2/s", turn);
}

static void check_end_state(RunWatch *watch)
{
    const TimeIntegrator *run = watch->run;
    for (int i = 0; i < count_unknowns(watch); i++) {
        if (!isfinite(run->x[i]) || !isfinite(run->v[i]))
            mark_wrong(watch, "the state is not finite");
        if (run->system->is_pinned && run->system->is_pinned[i / 2] &&
            !run->system->pin_v && (run->x[i] != watch->x[i] || run->v[i] != 0))
            mark_wrong(watch, "a pinned node moved");
    }
    check_gaps_and_areas(watch, run->x);
    int pin;
    if (watch->status == STATUS_OK && momentum_is_conserved(run, &pin))
        check_step_momentum(watch, pin);
    if (watch->only_springs && /* flow and breaks change E as a step ends */
        run->newton && run->newton->settings.line_search != LINE_SEARCH_NONE)
        check_descent(watch, run->newton->iterate.u, "as the step ends");
}

StepVerdict make_judged_step(RunWatch *watch)
{
    TimeIntegrator *run = watch->run;
    size_t bytes = (size_t)count_unknowns(watch) * sizeof *watch->x;
    memcpy(watch->x, run->x, bytes);
    memcpy(watch->v, run->v, bytes);
    watch->is_wrong = false;
    watch->update_count = 0;
    watch->tolerance = run->newton ? run->newton->settings.tolerance : 0;
    Status status = watch->status = time_integrator_make_step(run);
    if ((int)status < 0 || status >= STATUS_COUNT || status == STATUS_RUNNING)
        mark_wrong(watch, "status %d has no name", (int)status);
    else if (status == STATUS_OK || status_is_unconverged(status))
        check_end_state(watch);
    else
        check_failed_step(watch, status);
    StepVerdict verdict = watch->is_wrong ? VERDICT_WRONG
                          : status        ? VERDICT_REPORTED
                                          : VERDICT_CONVERGED;
    watch->tally->steps_by_verdict[verdict]++;
    watch->tally->steps_by_status[status]++;
    return verdict;
}
