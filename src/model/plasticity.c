#include "model/plasticity.h"

#include <math.h>
#include <stdlib.h>

#include "model/damping.h"
#include "model/mass_spring_energy.h"

/* (|e| - Y)_+ */
static double beyond(SpringLaw law, double e)
{
    return fmax(fabs(e) - law.yield, 0);
}

/* Where |e| is far beyond Y, e^2 and the square of what is beyond are nearly
 * the same: so Y and what is beyond are looked at apart. */
double spring_law_value(SpringLaw law, double e)
{
    double over = beyond(law, e), change = e - law.e_n;
    double within = fmin(fabs(e), law.yield);
    double sum =
        within * (fabs(e) - 0.5 * within) + 0.5 * (1 - law.flow) * over * over;
    return law.theta > 0 ? sum + 0.5 * law.theta * change * change : sum;
}

double spring_law_slope(SpringLaw law, double e)
{
    double within = fmin(fabs(e), law.yield);
    double tau = copysign(within + (1 - law.flow) * beyond(law, e), e);
    return law.theta > 0 ? tau + law.theta * (e - law.e_n) : tau;
}

double spring_law_curvature(SpringLaw law, double e)
{
    return law.theta + (beyond(law, e) > 0 ? 1 - law.flow : 1);
}

double spring_law_flow(SpringLaw law, double e)
{
    return law.flow * beyond(law, e);
}

/* The integral of (t - s) V''(e + s) over s = 0 ... t, mirrored so that t >= 0:
 * V'' is 1 - flow + theta everywhere, and flow more where the spring is
 * elastic.  Nothing is subtracted but ends of the way. */
double spring_law_remainder(SpringLaw law, double e, double t)
{
    double start = copysign(1, t) * e, way = fabs(t);
    double from = fmax(-law.yield - start, 0);
    double to = fmin(law.yield - start, way);
    double within = from > 0 && to < way ? 2 * law.yield : to - from;
    double elastic = to > from ? within * (way - to + 0.5 * within) : 0;
    return 0.5 * (1 - law.flow + law.theta) * t * t + law.flow * elastic;
}

/* d is an eigenvector, with (2k/l2) (2 tau' q + l2 tau); across it is
 * (2k/l2) l2 tau. */
static bool spring_law_hessian(SpringLaw law, const double d[2], double l2,
                               double k, double e, Filter filter, double H[3])
{
    double factor = 2 * k / l2, q = d[0] * d[0] + d[1] * d[1];
    double across = l2 * spring_law_slope(law, e);
    double along = 2 * spring_law_curvature(law, e) * q + across;
    bool changed = (along < 0 || across < 0) && filter_projects(filter);
    if (changed) {
        along = projected_eigenvalue(filter, along);
        across = projected_eigenvalue(filter, across);
    }
    double difference = q > 0 ? (along - across) / q : 0;
    H[0] = factor * (across + difference * d[0] * d[0]);
    H[1] = factor * difference * d[0] * d[1];
    H[2] = factor * (across + difference * d[1] * d[1]);
    return changed && k > 0;
}

/* ---- the term -------------------------------------------------------- */

Plasticity *plasticity_of(const System *system)
{
    Term *term = system_find_term(system, &plastic_energy);
    return term ? term->data : NULL;
}

static SpringLaw law_of(const Plasticity *plasticity, const Damping *damping,
                        int s)
{
    return (SpringLaw){.yield = plasticity->yield +
                                plasticity->hardening * plasticity->kappa[s],
                       .flow = 1 / (1 + plasticity->hardening),
                       .theta = damping ? damping->theta : 0,
                       .e_n =
                           damping ? damping->E_n[s] - plasticity->ep[s] : 0};
}

/* d = x_i - x_j; returns e = |d|^2/l2 - 1 - ep */
static double strain_at(const Plasticity *plasticity, const System *system,
                        const double *x, int s, double d[2])
{
    return spring_strain(system->e + 2 * s, system->l2[s], x, d) -
           plasticity->ep[s];
}

static bool valid(const Place *at)
{
    const Plasticity *plasticity = at->term->data;
    return isfinite(plasticity->yield) && plasticity->yield > 0 &&
           isfinite(plasticity->hardening) && plasticity->hardening >= 0;
}

static double value(const Place *at)
{
    const Plasticity *plasticity = at->term->data;
    const System *system = at->system;
    double sum = 0;
    for (int s = 0; s < system->springs; s++) {
        double d[2], e = strain_at(plasticity, system, at->x, s, d);
        double kappa = plasticity->kappa[s];
        sum += system->k[s] * system->l2[s] *
               (spring_law_value(law_of(plasticity, at->damping, s), e) +
                0.5 * plasticity->hardening * kappa * kappa);
    }
    return sum;
}

/* 2 k tau d */
static void gradient(const Place *at, double *g)
{
    const Plasticity *plasticity = at->term->data;
    const System *system = at->system;
    for (int s = 0; s < system->springs; s++) {
        double d[2], e = strain_at(plasticity, system, at->x, s, d);
        double factor = at->w * 2 * system->k[s] *
                        spring_law_slope(law_of(plasticity, at->damping, s), e);
        for (int c = 0; c < 2; c++) {
            g[2 * system->e[2 * s] + c] += factor * d[c];
            g[2 * system->e[2 * s + 1] + c] -= factor * d[c];
        }
    }
}

static int hessian(const Place *at, Filter filter, const int *slot,
                   const double *q, double *out)
{
    const Plasticity *plasticity = at->term->data;
    const System *system = at->system;
    int projected = 0;
    for (int s = 0; s < system->springs; s++) {
        double d[2], e = strain_at(plasticity, system, at->x, s, d), H[3];
        projected += spring_law_hessian(law_of(plasticity, at->damping, s), d,
                                        system->l2[s], at->w * system->k[s], e,
                                        filter, H);
        mass_spring_add(H, system->e + 2 * s, s, slot, q, out);
    }
    return projected;
}

/* With D = alpha B + alpha^2 C the remainder of k l2 V is
 * k l2 (tau alpha^2 C + R_V(e, D)).  Springs that stay elastic all the way have
 * R_V = (1 + theta) D^2/2, a polynomial; the others are noted. */
static void along(const Place *at, const double *p, double reach, double q[3])
{
    Plasticity *plasticity = at->term->data;
    const System *system = at->system;
    plasticity->live = 0;
    for (int s = 0; s < system->springs; s++) {
        double d[2], e = strain_at(plasticity, system, at->x, s, d);
        const double *pi = p + 2 * system->e[2 * s];
        const double *pj = p + 2 * system->e[2 * s + 1];
        double P[2] = {pi[0] - pj[0], pi[1] - pj[1]};
        double B = 2 * (d[0] * P[0] + d[1] * P[1]) / system->l2[s];
        double C = (P[0] * P[0] + P[1] * P[1]) / system->l2[s];
        double stiffness = at->w * system->k[s] * system->l2[s];
        SpringLaw law = law_of(plasticity, at->damping, s);
        q[0] += stiffness * spring_law_slope(law, e) * C;
        if (fabs(e) + reach * fabs(B) + reach * reach * C < law.yield) {
            stiffness *= 1 + law.theta;
            q[0] += stiffness * 0.5 * B * B;
            q[1] += stiffness * B * C;
            q[2] += stiffness * 0.5 * C * C;
        } else {
            plasticity->spring[plasticity->live++] = (LiveSpring){s, B, C};
        }
    }
}

static double remainder_along(const Place *at, const double *p, double alpha)
{
    const Plasticity *plasticity = at->term->data;
    const System *system = at->system;
    double sum = 0;
    (void)p;
    for (int k = 0; k < plasticity->live; k++) {
        const LiveSpring *live = &plasticity->spring[k];
        int s = live->spring;
        double d[2], e = strain_at(plasticity, system, at->x, s, d);
        sum += system->k[s] * system->l2[s] *
               spring_law_remainder(law_of(plasticity, at->damping, s), e,
                                    alpha * (live->B + alpha * live->C));
    }
    return at->w * sum;
}

/* What has flowed stays: ep moves by gamma, the yield strain grows. */
static bool end(Term *term, System *system, const double *x, const double *v,
                double h)
{
    Plasticity *plasticity = term->data;
    bool changed = false;
    (void)v;
    (void)h;
    for (int s = 0; s < system->springs; s++) {
        double d[2], e = strain_at(plasticity, system, x, s, d);
        double gamma = spring_law_flow(law_of(plasticity, NULL, s), e);
        if (!(gamma > 0) || !(system->k[s] > 0))
            continue;
        plasticity->ep[s] += copysign(gamma, e);
        plasticity->kappa[s] += gamma;
        system_lose(system, term->kind,
                    system->k[s] * system->l2[s] * plasticity->yield * gamma);
        changed = true;
    }
    return changed;
}

/* Where tau < 0 the lower eigenvalue of H is 2 k tau at least. */
static void concave(const Place *at, double *sum)
{
    const Plasticity *plasticity = at->term->data;
    const System *system = at->system;
    for (int s = 0; s < system->springs; s++) {
        double d[2], e = strain_at(plasticity, system, at->x, s, d);
        double tau = spring_law_slope(law_of(plasticity, at->damping, s), e);
        double c = 4 * at->w * system->k[s] * fmax(-tau, 0);
        sum[system->e[2 * s]] += c;
        sum[system->e[2 * s + 1]] += c;
    }
}

static void free_plasticity(void *data)
{
    Plasticity *plasticity = data;
    free(plasticity->ep);
    free(plasticity->kappa);
    free(plasticity->spring);
    free(plasticity);
}

const TermKind plastic_energy = {
    .energy = "elastic",
    .loss = "plastic",
    .valid = valid,
    .value = value,
    .gradient = gradient,
    .entries = mass_spring_entries,
    .pattern = mass_spring_pattern,
    .hessian = hessian,
    .along = along,
    .remainder = remainder_along,
    .end = end,
    .bounds = mass_spring_bounds,
    .concave = concave,
    .free = free_plasticity,
    .internal = true,
    .end_of_step = true,
};

Status plasticity_set(System *system, double yield, double hardening)
{
    size_t springs = (size_t)system->springs + 1;
    Plasticity *plasticity = calloc(1, sizeof *plasticity);
    if (!plasticity)
        return STATUS_OUT_OF_MEMORY;
    plasticity->yield = yield;
    plasticity->hardening = hardening;
    plasticity->ep = calloc(springs, sizeof(double));
    plasticity->kappa = calloc(springs, sizeof(double));
    plasticity->spring = calloc(springs, sizeof *plasticity->spring);
    Term *elastic = system_find_term(system, &mass_spring_energy);
    if (!plasticity->ep || !plasticity->kappa || !plasticity->spring) {
        free_plasticity(plasticity);
        return STATUS_OUT_OF_MEMORY;
    }
    if (!elastic)
        return system_add_term(system, &plastic_energy, plasticity);
    *elastic = (Term){.kind = &plastic_energy, .data = plasticity};
    return STATUS_OK;
}
