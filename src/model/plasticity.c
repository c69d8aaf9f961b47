/* plasticity.c - energy of springs that flow beyond their yield strain. */
#include "model/plasticity.h"

#include <math.h>

#include "model/damping.h"
#include "model/mass_spring_energy.h"

/* Returns (|e| - Y)_+.  fmax would be a slow library call for each spring. */
static double strain_beyond_yield(FlowLaw law, double e)
{
    return fabs(e) > law.yield_strain ? fabs(e) - law.yield_strain : 0;
}

/* Returns min(|e|, Y). */
static double limit_strain_to_yield(FlowLaw law, double e)
{
    return fabs(e) < law.yield_strain ? fabs(e) : law.yield_strain;
}

/* Returns V(e) = e^2/2 - flow (|e| - Y)_+^2/2, plus theta (e - e_n)^2/2 with
 * damping.  For |e| far beyond the yield strain Y the two squares would cancel,
 * so the parts of |e| within and beyond Y are computed separately. */
static double flow_law_value(FlowLaw law, double e)
{
    double over = strain_beyond_yield(law, e), change = e - law.e_n;
    double within = limit_strain_to_yield(law, e);
    double sum = within * (fabs(e) - 0.5 * within) +
                 0.5 * law.plastic_slope * over * over;
    return law.theta > 0 ? sum + 0.5 * law.theta * change * change : sum;
}

double flow_law_slope(FlowLaw law, double e)
{
    double tau = copysign(limit_strain_to_yield(law, e) +
                              law.plastic_slope * strain_beyond_yield(law, e),
                          e);
    return law.theta > 0 ? tau + law.theta * (e - law.e_n) : tau;
}

static double flow_law_curvature(FlowLaw law, double e)
{
    return law.theta +
           (strain_beyond_yield(law, e) > 0 ? law.plastic_slope : 1);
}

double flow_law_eigenvalue_along(FlowLaw law, double e, double d2,
                                 double across)
{
    return 2 * flow_law_curvature(law, e) * d2 + across;
}

/* Returns the law V of spring s without damping. */
static inline FlowLaw make_flow_law(const Plasticity *data, int s)
{
    double H = data->hardening, flow = 1 / (1 + H);
    return (FlowLaw){.ep_n = data->ep[s],
                     .yield_strain =
                         data->initial_yield_strain + H * data->kappa[s],
                     .flow_fraction = flow,
                     .plastic_slope = 1 - flow};
}

FlowLaw plasticity_get_flow_law(const System *system, int s)
{
    const Plasticity *data = system_term_data(system, &plastic_energy);
    return data ? make_flow_law(data, s)
                : (FlowLaw){.yield_strain = INFINITY, .plastic_slope = 1};
}

/* A spring at the point of evaluation. */
typedef struct FlowSpring {
    const int *e;           /* nodes of the spring */
    double k, l2;           /* stiffness (J/m^2), squared rest length (m^2) */
    double d[2], d_squared; /* x_i - x_j (m), |d|^2 (m^2) */
    double elastic_strain;  /* elastic strain, E - ep */
    FlowLaw law;
} FlowSpring;

static inline FlowSpring evaluate_flow_spring(const EvalPoint *at, int s)
{
    const Damping *damping = at->damping;
    FlowSpring spring = {.e = at->system->e + 2 * s,
                         .k = at->system->k[s],
                         .l2 = at->system->l2[s],
                         .law = make_flow_law(at->term->data, s)};
    spring.law.theta = damping ? damping->theta : 0;
    spring.law.e_n = damping ? damping->E_n[s] - spring.law.ep_n : 0;
    spring.d_squared = spring_vector(spring.e, at->x, spring.d);
    spring.elastic_strain =
        spring_strain(spring.d_squared, spring.l2) - spring.law.ep_n;
    return spring;
}

static double plastic_potential(const EvalPoint *at)
{
    const Plasticity *data = at->term->data;
    double sum = 0;
    for (int s = 0; s < at->system->springs; s++) {
        FlowSpring spring = evaluate_flow_spring(at, s);
        double kappa = data->kappa[s];
        sum += spring.k * spring.l2 *
               (flow_law_value(spring.law, spring.elastic_strain) +
                0.5 * data->hardening * kappa * kappa);
    }
    return sum;
}

/* A spring adds 2 k tau d to the gradient at its node i and subtracts it at its
 * node j; d = x_i - x_j, tau = V'(e). */
static void plastic_gradient(const EvalPoint *at, double *g)
{
    for (int s = 0; s < at->system->springs; s++) {
        FlowSpring spring = evaluate_flow_spring(at, s);
        spring_add_gradient(
            spring.e,
            spring_gradient_factor(
                at->weight * spring.k,
                flow_law_slope(spring.law, spring.elastic_strain)),
            spring.d, g);
    }
}

static int plastic_hessian(const EvalPoint *at, Projection projection,
                           const int **slot, const double *q, double *out)
{
    int projected = 0;
    for (int s = 0; s < at->system->springs; s++) {
        FlowSpring spring = evaluate_flow_spring(at, s);
        const double *d = spring.d, d2 = spring.d_squared;
        double k = at->weight * spring.k,
               factor = spring_hessian_factor(spring.l2, k);
        double across =
            spring.l2 * flow_law_slope(spring.law, spring.elastic_strain);
        double along = flow_law_eigenvalue_along(
            spring.law, spring.elastic_strain, d2, across);
        projected +=
            spring_project_eigenvalues(projection, &along, &across) && k > 0;
        double difference = d2 > 0 ? (along - across) / d2 : 0;
        const double H[3] = {factor * (across + difference * d[0] * d[0]),
                             factor * difference * d[0] * d[1],
                             factor * (across + difference * d[1] * d[1])};
        mass_spring_add_hessian(H, spring.e, slot, q, out);
    }
    return projected;
}

/* Writes B and C: along p the strain e changes by D = alpha B + alpha^2 C.  V
 * then changes by three summands: V'(e) alpha B, the slope; V'(e) alpha^2 C,
 * the line polynomial; R_V(e, D), the Taylor remainder (each times k l2 in W).
 */
static inline void compute_strain_polynomial(const FlowSpring *spring,
                                             const double *p, double *B,
                                             double *C)
{
    double change[2];
    *C = spring_vector(spring->e, p, change) / spring->l2;
    *B = 2 * (spring->d[0] * change[0] + spring->d[1] * change[1]) / spring->l2;
}

static void plastic_line_polynomial(const EvalPoint *at, const double *p,
                                    double q[3])
{
    double B, C;
    for (int s = 0; s < at->system->springs; s++) {
        FlowSpring spring = evaluate_flow_spring(at, s);
        compute_strain_polynomial(&spring, p, &B, &C);
        q[0] += at->weight * spring.k * spring.l2 *
                flow_law_slope(spring.law, spring.elastic_strain) * C;
    }
}

/* R_V(e, t) = V(e + t) - V(e) - V'(e) t >= 0 is the integral over s from 0 to t
 * of (t - s) V''(e + s), mirrored so that t >= 0.  V'' is 1 + theta where the
 * spring is elastic, elsewhere 1 + theta - flow.  No summand is negative. */
static double plastic_taylor_remainder(const EvalPoint *at, const double *p,
                                       double alpha)
{
    double sum = 0, B, C;
    for (int s = 0; s < at->system->springs; s++) {
        FlowSpring spring = evaluate_flow_spring(at, s);
        FlowLaw law = spring.law;
        compute_strain_polynomial(&spring, p, &B, &C);
        double t = alpha * (B + alpha * C), way = fabs(t);
        double start = copysign(1, t) * spring.elastic_strain;
        double from = -law.yield_strain - start, to = law.yield_strain - start;
        from = from > 0 ? from : 0;
        to = to < way ? to : way;
        double within = from > 0 && to < way ? 2 * law.yield_strain : to - from;
        double elastic = to > from ? within * (way - to + 0.5 * within) : 0;
        sum += spring.k * spring.l2 *
               (0.5 * (law.plastic_slope + law.theta) * t * t +
                law.flow_fraction * elastic);
    }
    return at->weight * sum;
}

/* Adds the flow gamma of the step to ep and kappa. */
static void plastic_end_step(const TermStep *step)
{
    System *system = step->system;
    Plasticity *data = step->term->data;
    EvalPoint at = make_eval_point(system, step->x, NULL, step->x);
    bool changed = false;
    at.term = step->term;
    for (int s = 0; s < system->springs; s++) {
        FlowSpring spring = evaluate_flow_spring(&at, s);
        double gamma = spring.law.flow_fraction *
                       strain_beyond_yield(spring.law, spring.elastic_strain);
        if (!(gamma > 0) || spring_is_broken(system, s))
            continue;
        data->ep[s] += copysign(gamma, spring.elastic_strain);
        data->kappa[s] += gamma;
        system_add_loss(system, &plastic_energy,
                        spring.k * spring.l2 * data->initial_yield_strain *
                            gamma);
        changed = true;
    }
    if (changed)
        system_mark_changed(system, false);
}

/* Makes all springs plastic: the term takes the place of the elastic one.
 *   number  [2] yield strain Y and hardening H */
static Status plastic_configure(System *system, const struct SquareMesh *mesh,
                                const double *number)
{
    size_t springs = (size_t)system->springs;
    (void)mesh;
    Plasticity *data = system_add_term(
        system, &plastic_energy, sizeof *data + 2 * springs * sizeof(double));
    if (!data)
        return STATUS_OUT_OF_MEMORY;
    data->initial_yield_strain = number[0];
    data->hardening = number[1];
    data->ep = (double *)(data + 1);
    data->kappa = data->ep + springs;
    system_remove_term(system, &mass_spring_energy);
    return STATUS_OK;
}

const TermKind plastic_energy = {
    .name = "plastic springs",
    .configure = plastic_configure,
    .energy_name = "elastic",
    .loss_name = "plastic",
    .potential = plastic_potential,
    .gradient = plastic_gradient,
    .add_triplets = mass_spring_add_triplets,
    .hessian = plastic_hessian,
    .line_polynomial = plastic_line_polynomial,
    .taylor_remainder = plastic_taylor_remainder,
    .end_step = plastic_end_step,
    .max_stiffness = mass_spring_max_stiffness,
};
