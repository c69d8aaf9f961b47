#include "model/pull_energy.h"

#include <math.h>
#include <stdlib.h>

/* The nodes first ... end - 1 are pulled. */
static int first_node(const Pull *pull)
{
    return pull->node < 0 ? 0 : pull->node;
}

static int end_node(const Pull *pull, const System *system)
{
    return pull->node < 0 ? system->nodes : pull->node + 1;
}

/* w c_i; with a huge omega2, w keeps it below overflow. */
static double stiffness(const Pull *pull, const System *system, double w, int i)
{
    return pull->node < 0 ? w * pull->k * system->m[i] : w * pull->k;
}

static bool valid(const Term *term, const System *system)
{
    const Pull *pull = term->data;
    return pull->node < system->nodes && pull->k >= 0 && isfinite(pull->k) &&
           isfinite(pull->target[0]) && isfinite(pull->target[1]);
}

/* c/2 |x - o|^2.  Averaged along the way from x_n the gradient is the one half
 * way, c (x_n + u/2 - o), and its potential c u.(x_n + u/4 - o). */
static double value(const Term *term, const Place *at)
{
    const Pull *pull = term->data;
    double sum = 0;
    for (int i = first_node(pull); i < end_node(pull, at->system); i++)
        for (int c = 2 * i; c < 2 * i + 2; c++) {
            double o = pull->target[c % 2], x = at->x[c] - o;
            sum += stiffness(pull, at->system, 0.5, i) *
                   (at->averaged
                        ? 2 * at->u[c] * (at->x_n[c] - o + 0.25 * at->u[c])
                        : x * x);
        }
    return sum;
}

static void gradient(const Term *term, const Place *at, double w, double *g)
{
    const Pull *pull = term->data;
    for (int i = first_node(pull); i < end_node(pull, at->system); i++)
        for (int c = 2 * i; c < 2 * i + 2; c++) {
            double x = at->averaged ? at->x_n[c] + 0.5 * at->u[c] : at->x[c];
            g[c] +=
                stiffness(pull, at->system, w, i) * (x - pull->target[c % 2]);
        }
}

/* The diagonal of these nodes. */
static long long entries(const Term *term, const System *system)
{
    return 2LL * (end_node(term->data, system) - first_node(term->data));
}

static void pattern(const Term *term, const System *system, Triplets *triplets)
{
    for (int i = first_node(term->data); i < end_node(term->data, system); i++)
        term_add_diagonal(system, i, triplets);
}

/* Averaged, what is linear in u counts half.  It is never negative. */
static int hessian(const Term *term, const Place *at, double w, Filter filter,
                   const int *slot, const double *q, double *out)
{
    const Pull *pull = term->data;
    int first = 2 * first_node(pull);
    (void)filter;
    for (int i = first; i < 2 * end_node(pull, at->system); i++) {
        double c =
            stiffness(pull, at->system, at->averaged ? 0.5 * w : w, i / 2);
        if (q)
            out[i] += c * q[i];
        else
            out[slot[i - first]] += c;
    }
    return 0;
}

static void along(const Term *term, const Place *at, const double *p, double w,
                  double reach, double q[3])
{
    const Pull *pull = term->data;
    (void)reach;
    for (int i = 2 * first_node(pull); i < 2 * end_node(pull, at->system); i++)
        q[0] += (at->averaged ? 0.25 : 0.5) *
                stiffness(pull, at->system, w, i / 2) * p[i] * p[i];
}

static void hand_bounds(const Term *term, const System *system,
                        double *stiffest, double *force)
{
    const Pull *pull = term->data;
    (void)system;
    (void)force;
    *stiffest = fmax(*stiffest, pull->k);
}

const TermKind central_field = {
    .name = "central field",
    .valid = valid,
    .value = value,
    .gradient = gradient,
    .entries = entries,
    .pattern = pattern,
    .hessian = hessian,
    .along = along,
    .averaged = &central_field,
    .free = free,
    .diagonal = true,
};

const TermKind hand_energy = {
    .name = "hand",
    .valid = valid,
    .value = value,
    .gradient = gradient,
    .entries = entries,
    .pattern = pattern,
    .hessian = hessian,
    .along = along,
    .averaged = &hand_energy,
    .bounds = hand_bounds,
    .free = free,
    .diagonal = true,
};

/* Adds a term of this kind, or changes the one that there is. */
static Status set_pull(System *system, const TermKind *kind, const Pull *pull)
{
    Term *term = system_find_term(system, kind);
    Pull *own = term ? term->data : malloc(sizeof *own);
    if (!own)
        return STATUS_OUT_OF_MEMORY;
    *own = *pull;
    if (term || system_add_term(system, kind, own))
        return STATUS_OK;
    free(own);
    return STATUS_TOO_LARGE;
}

Status central_field_set(System *system, double omega2)
{
    if (omega2 != 0)
        return set_pull(system, &central_field,
                        &(Pull){.node = -1, .k = omega2});
    system_remove_term(system, &central_field);
    return STATUS_OK;
}

Status hand_energy_set(System *system, const Pull *hand)
{
    if (hand->node < 0 || hand->node >= system->nodes)
        return STATUS_INVALID_INPUT;
    return set_pull(system, &hand_energy, hand);
}

void hand_energy_remove(System *system)
{
    system_remove_term(system, &hand_energy);
}

Pull *hand_energy_of(const System *system)
{
    const Term *term = system_find_term(system, &hand_energy);
    return term ? term->data : NULL;
}
