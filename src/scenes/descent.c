/* descent.c - Newton's method in one or two unknowns: the scenes overshoot,
 * tangent, landscape and dial. */
#include "scenes/small_scenes.h"

#include <math.h>
#include <string.h>

#include "model/spring_law.h"
#include "base/mathematics.h"

enum { LANDSCAPE_PINS = 2, LANDSCAPE_NODES = 1 + LANDSCAPE_PINS };

static const double LINE_STIFFNESS = 10;       /* J/m^2 */
static const double LINE_LENGTH = 1;           /* rest length, m */
static const double LINE_TARGET = 2;           /* x_tilde of node 0, m */
static const double LANDSCAPE_STIFFNESS = 100; /* J/m^2 */
static const double LANDSCAPE_LENGTH = 1.5;    /* rest length, m */

/* x_tilde of the free node: minimiser of the inertia energy, m */
static const double LANDSCAPE_TARGET[2] = {0.2, 0.3};

/* Time steps of the dial, s: from 1e-3 to 10, ten for each factor of 10 */
static const double DIAL_FIRST = 1e-3, DIAL_LAST = 10, DIAL_PER_TEN = 10;

/* Length of p below which the search for a minimiser ends, m */
static const double DIAL_SHORT_P = 1e-14;

/* Smallest distance of a search's start from the line through the pins, m */
static const double DIAL_OFF_LINE = 1e-9;

/* ---- the functions ------------------------------------------------------- */

/* ln(e^x + e^-x), written as |x| + ln(1 + e^(-2|x|)), which cannot overflow.
 * The derivatives are tanh and 1/cosh^2. */
static TaylorModel log_two_cosh(const Simulation *simulation, double x)
{
    double f = fabs(x) + log1p(exp(-2 * fabs(x)));
    double g = tanh(x);
    double H = 1 / (cosh(x) * cosh(x));
    (void)simulation;
    return (TaylorModel){.energy = f, .g = {g}, .H = {H}};
}

/* Evaluates E, g and H of the scene "tangent" at position x. */
static TaylorModel evaluate_tangent_energy(const Simulation *simulation,
                                           double x)
{
    double m = SMALL_MASS, l2 = LINE_LENGTH * LINE_LENGTH;
    double h = simulation->run[0].h, x_tilde = simulation->exhibit.x_tilde[0];
    double d = x - x_tilde, k = h * h * LINE_STIFFNESS;
    double s = spring_strain(x * x, l2);
    double E = m / 2 * d * d + spring_energy(l2, k, s);
    double g = m * d + spring_gradient_factor(k, s) * x;
    double H =
        m + spring_hessian_factor(l2, k) * spring_eigenvalue_along(x * x, l2);
    return (TaylorModel){.energy = E, .g = {g}, .H = {H}};
}

/* Returns parts of E with their derivatives in the scenes `landscape` and
 * `dial`, and the function of one unknown in `overshoot` and `tangent`.
 *   parts  enum LandscapePart */
static TaylorModel evaluate_landscape(const Simulation *simulation,
                                      unsigned parts, Projection projection,
                                      double x, double y)
{
    if (simulation->descent.scalar)
        return simulation->descent.scalar(simulation, x);
    const System *system = &simulation->system;
    const double *pins = simulation->run[0].x, *o = simulation->exhibit.x_tilde;
    double m = system->m[0], h = simulation->run[0].h, w = h * h, P = 0;
    const double u[2] = {x - o[0], y - o[1]};
    TaylorModel E = {.energy = 0};
    if (parts & PART_INERTIA)
        E = (TaylorModel){0.5 * m * (u[0] * u[0] + u[1] * u[1]),
                          {m * u[0], m * u[1]},
                          {m, 0, m},
                          0};
    for (int s = 0; s < system->springs && (parts & PART_ELASTICITY); s++) {
        const double *pin = pins + 2 * system->e[2 * s + 1];
        const double d[2] = {x - pin[0], y - pin[1]};
        double l2 = system->l2[s], k = system->k[s], H[3];
        double d2 = d[0] * d[0] + d[1] * d[1];
        double pull = spring_gradient_factor(
            w * k, spring_eigenvalue_across(d2, l2) / l2);
        P += spring_energy(l2, k, spring_strain(d2, l2));
        for (int i = 0; i < 2; i++)
            E.g[i] += pull * d[i];
        E.projected_springs += spring_hessian(d, l2, k, projection, H);
        for (int i = 0; i < 3; i++)
            E.H[i] += w * H[i];
    }
    E.energy += w * P;
    return E;
}

TaylorModel descent_evaluate(const Simulation *simulation,
                             Projection projection, double x, double y)
{
    return evaluate_landscape(simulation, simulation->exhibit.switches,
                              projection, x, y);
}

double landscape_sum_energy_parts(const Simulation *simulation, unsigned parts,
                                  double x, double y)
{
    return evaluate_landscape(simulation, parts, PROJECTION_NONE, x, y).energy;
}

int descent_classify_hessian(const Simulation *simulation, double x, double y)
{
    TaylorModel E = descent_evaluate(simulation, PROJECTION_NONE, x, y);
    if (simulation->descent.scalar)
        return E.H[0] < 0 ? 2 : 0;
    bool same = E.H[0] * E.H[2] - E.H[1] * E.H[1] > 0;
    return same ? (E.H[0] > 0 ? 0 : 2) : 1;
}

/* ---- Newton -------------------------------------------------------------- */

/* Returns Newton's direction in one unknown, to the zero of g's tangent. */
static double newton_direction_1d(double g, double H)
{
    return -g / H;
}

/* Computes p = -H^-1 g.  Returns the slope g . p of E along p. */
static double newton_direction(const TaylorModel *E, bool scalar, double p[2])
{
    const double *g = E->g, *H = E->H;
    if (scalar) {
        p[0] = newton_direction_1d(g[0], H[0]);
        p[1] = 0;
        return g[0] * p[0];
    }
    double determinant = H[0] * H[2] - H[1] * H[1], trace = H[0] + H[2];
    if (fabs(determinant) <= 1e-14 * trace * trace)
        determinant = NAN; /* H has no inverse */
    p[0] = (H[1] * g[1] - H[2] * g[0]) / determinant;
    p[1] = (H[1] * g[0] - H[0] * g[1]) / determinant;
    return g[0] * p[0] + g[1] * p[1];
}

double descent_find_p(const Simulation *simulation, Projection projection,
                      const double *x, double p[2])
{
    TaylorModel E = descent_evaluate(simulation, projection, x[0], x[1]);
    return newton_direction(&E, simulation->descent.scalar, p);
}

/* Returns the change of E along alpha p, for line_search_backtrack. */
static double descent_energy_difference(const void *function, double alpha)
{
    const Simulation *simulation = function;
    const Descent *descent = &simulation->descent;
    const double *x = descent->iterate, *p = descent->direction;
    return descent_evaluate(simulation, PROJECTION_NONE, x[0] + alpha * p[0],
                            x[1] + alpha * p[1])
               .energy -
           descent->value;
}

/* Returns E and its derivatives at the iterate, with the options' projection.
 * Projection on demand clamps a Hessian that is not positive definite. */
static TaylorModel evaluate_local_model(const Simulation *simulation)
{
    const double *at = simulation->descent.iterate;
    Projection projection = (Projection)simulation->options.projection;
    if (projection == PROJECTION_ON_DEMAND)
        projection = descent_classify_hessian(simulation, at[0], at[1])
                         ? PROJECTION_CLAMP
                         : PROJECTION_NONE;
    return descent_evaluate(simulation, projection, at[0], at[1]);
}

/* Computes E, p, slope and residual at a new iterate.  If the status is
 * RUNNING, tests the residual: OK if it is small enough, DIVERGED if E is then
 * above E at the start, as may happen without a line search; a failure if p is
 * not finite.  p is set to 0 if OK or not finite, and else kept for drawing. */
static Status update_iterate_values(Simulation *simulation, Status status)
{
    TimeIntegrator *run = &simulation->run[0];
    Descent *descent = &simulation->descent;
    double *p = descent->direction;
    memcpy(descent->iterate, run->x, sizeof descent->iterate);
    TaylorModel E = evaluate_local_model(simulation);
    descent->value = E.energy;
    if (descent->scalar)
        descent->iterate[1] = run->x[1] = E.energy;
    descent->slope = newton_direction(&E, descent->scalar, p);
    descent->residual = descent->tests_g ? math_hypot(E.g[0], E.g[1])
                                         : (fabs(p[0]) + fabs(p[1])) / run->h;
    double start = descent->start_value, limit = start + 1e-12 * fabs(start);
    bool passed = descent->residual <= simulation->options.tolerance;
    if (status == STATUS_RUNNING && passed)
        status = descent->value > limit ? STATUS_DIVERGED : STATUS_OK;
    else if (status == STATUS_RUNNING && !isfinite(descent->slope))
        status = descent->scalar ? STATUS_DIVERGED : STATUS_SINGULAR;
    simulation->is_over = status != STATUS_RUNNING;
    if (status == STATUS_OK || !isfinite(descent->slope))
        p[0] = p[1] = descent->slope = 0;
    return status;
}

/* Chooses the number that the loop tests: |g| in Algorithm 1, else |p|/h. */
static void choose_stopping_test(Simulation *simulation)
{
    const Options *options = &simulation->options;
    Descent *descent = &simulation->descent;
    bool plain = descent->scalar || (options->projection == PROJECTION_NONE &&
                                     options->line_search == LINE_SEARCH_NONE);
    if (plain != descent->tests_g)
        descent->record_count = 0; /* the residuals so far are not comparable */
    descent->tests_g = plain;
}

void descent_update_direction(Simulation *simulation)
{
    Descent *descent = &simulation->descent;
    choose_stopping_test(simulation);
    descent->start_value = INFINITY; /* no upper limit of E yet */
    Status status = update_iterate_values(simulation, STATUS_RUNNING);
    simulation->status = simulation->is_over ? status : STATUS_OK;
    if (!descent->scalar)
        descent->start_value = descent->value;
}

Status step_descent(Simulation *simulation)
{
    Descent *descent = &simulation->descent;
    NewtonRecord record = {
        .step_number = simulation->steps + 1,
        .iteration = (int)simulation->steps,
        .residual = descent->residual,
        .alpha = 1,
        .slope = descent->slope,
        .has_new_factor = true,
        .projected_blocks = evaluate_local_model(simulation).projected_springs,
        .x_before = {descent->iterate[0], descent->iterate[1]}};
    const double *p = descent->direction;
    double *x = simulation->run[0].x;
    Status status = STATUS_RUNNING;
    if (simulation->options.line_search == LINE_SEARCH_BACKTRACK) {
        Status found =
            line_search_backtrack(descent_energy_difference, simulation,
                                  &record.alpha, &record.trials);
        /* Along an uphill p, E grows by about slope (alpha - alpha^2/2).  Only
         * rounding can make a very short step seem to lower E. */
        bool rounding = record.slope > 0 && record.alpha < 1e-3;
        if (found || rounding) {
            status = record.slope > 0 ? STATUS_NOT_DESCENT
                                      : STATUS_LINE_SEARCH_LIMIT;
            record.alpha = 0;
        }
    }
    record.energy_change = descent_energy_difference(simulation, record.alpha);
    for (int i = 0; i < 2; i++)
        x[i] += record.alpha * p[i];
    record.status = update_iterate_values(simulation, status);
    memcpy(record.x_after, x, sizeof record.x_after);
    if (descent->record_count < DESCENT_MAX_RECORDS)
        descent->record[descent->record_count++] = record;
    if (simulation->observer)
        simulation->observer(simulation->observer_data, &record);
    return simulation->is_over ? record.status : STATUS_OK;
}

/* ---- the scenes ---------------------------------------------------------- */

/* Creates the system and begins the search at the start of the options.  With
 * two unknowns the pins are at (-1, 0) and (1, 0) m, each with a spring to node
 * 0, and E is that of a step of backward Euler. */
static Status begin_descent(Simulation *simulation)
{
    const double *start = simulation->options.start;
    const double x[2 * LANDSCAPE_NODES] = {start[0], start[1], -1, 0, 1, 0};
    const double v[2 * LANDSCAPE_NODES] = {0};
    bool scalar = simulation->descent.scalar;
    const char *method = scalar ? "forward-euler" : "backward-euler";
    simulation->runs = 1;
    Status status =
        create_small_system(&simulation->system, scalar ? 0 : LANDSCAPE_PINS,
                            LANDSCAPE_LENGTH, LANDSCAPE_STIFFNESS);
    if (!status)
        status =
            simulation_start_run(simulation, 0, integrator_find_method(method),
                                 &simulation->system, x, v);
    if (status)
        return status;
    descent_update_direction(simulation);
    return STATUS_OK;
}

Status create_overshoot_scene(Simulation *simulation)
{
    simulation->descent.scalar = log_two_cosh;
    return begin_descent(simulation);
}

Status create_tangent_scene(Simulation *simulation)
{
    simulation->exhibit.x_tilde[0] = LINE_TARGET;
    simulation->descent.scalar = evaluate_tangent_energy;
    return begin_descent(simulation);
}

/* The springs are too long to lie flat between the pins; as in a buckling
 * column node 0 moves up or down. */
Status create_landscape_scene(Simulation *simulation)
{
    memcpy(simulation->exhibit.x_tilde, LANDSCAPE_TARGET,
           sizeof LANDSCAPE_TARGET);
    simulation->exhibit.switches = PART_BOTH;
    return begin_descent(simulation);
}

/* ---- the dial ------------------------------------------------------------ */

/* Finds the minimiser for a time step h, up to rounding, by Newton's method of
 * the run.  The gradient is 0 also at a saddle on the line through the pins, so
 * the search begins beside this line.
 *   point  [2] m, in/out */
static void minimise_landscape(const Simulation *simulation, double h,
                               double point[2])
{
    const TimeIntegrator *run = &simulation->run[0];
    Newton *newton = run->newton;
    if (fabs(point[1]) < DIAL_OFF_LINE)
        point[1] = copysign(DIAL_OFF_LINE, point[1]);
    for (int i = 0; i < 2; i++) {
        run->x[i] = point[i];
        newton->u_tilde[i] = simulation->exhibit.x_tilde[i] - point[i];
    }
    newton_start(newton, run->x, NULL, h * h,
                 DIAL_SHORT_P / newton->settings.h);
    newton_minimise(newton);
    newton->counters = (NewtonCounters){0}; /* the dial counts no updates */
    memcpy(point, newton->iterate.x, 2 * sizeof *point);
}

/* Computes the curve of minimisers.  A search begins at the last minimiser, so
 * that the curve is continuous.  Puts node 0 at the minimiser for h. */
void dial_update_curve(Simulation *simulation)
{
    MinimiserCurve *dial = &simulation->exhibit.dial;
    double point[2], h = simulation->options.timestep;
    memcpy(point, simulation->exhibit.x_tilde, sizeof point);
    memcpy(simulation->descent.iterate, point, sizeof point);
    for (int i = 0; i < DIAL_POINTS; i++) {
        dial->h[i] = DIAL_FIRST * pow(10, i / DIAL_PER_TEN);
        minimise_landscape(simulation, dial->h[i], point);
        memcpy(dial->minimiser[i], point, sizeof point);
        if (dial->h[i] <= h)
            memcpy(simulation->descent.iterate, point, sizeof point);
    }
    minimise_landscape(simulation, h, simulation->descent.iterate);
    memcpy(simulation->run[0].x, simulation->descent.iterate, sizeof point);
    simulation->descent.value = landscape_sum_energy_parts(
        simulation, PART_BOTH, simulation->descent.iterate[0],
        simulation->descent.iterate[1]);
}

Status create_dial_scene(Simulation *simulation)
{
    Status status = create_landscape_scene(simulation);
    if (status)
        return status;
    simulation->run[0].newton->settings.observer = NULL; /* hides the updates */
    dial_update_curve(simulation);
    simulation->is_over = simulation->options.timestep >= DIAL_LAST;
    simulation->status = STATUS_OK;
    return STATUS_OK;
}

Status step_dial_scene(Simulation *simulation)
{
    double h = simulation->options.timestep * pow(10, 1 / DIAL_PER_TEN);
    h = fmin(h, DIAL_LAST);
    simulation->options.timestep = simulation->run[0].h = h;
    simulation->is_over = h >= DIAL_LAST;
    dial_update_curve(simulation);
    return STATUS_OK;
}
