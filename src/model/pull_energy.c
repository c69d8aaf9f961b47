#include "model/pull_energy.h"

#include <math.h>
#include <stdlib.h>

/* w c of coordinate i; with a huge omega2, w keeps it below overflow. */
static double stiffness(const Place *at, double w, int i)
{
    const Pull *pull = at->term->data;
    if (pull->node < 0)
        return w * pull->k * at->system->m[i / 2];
    return i / 2 == pull->node ? w * pull->k : 0;
}

/* c/2 |x - o|^2.  Averaged along the way from x_n the gradient is the one half
 * way, c (x_n + u/2 - o), and its potential c u.(x_n + u/4 - o). */
static double value(const Place *at)
{
    const Pull *pull = at->term->data;
    double sum = 0;
    for (int i = 0; i < 2 * at->system->nodes; i++) {
        double o = pull->target[i % 2], x = at->x[i] - o;
        double size = at->averaged
                          ? 2 * at->u[i] * (at->x_n[i] - o + 0.25 * at->u[i])
                          : x * x;
        sum += stiffness(at, 0.5, i) * size;
    }
    return sum;
}

static void gradient(const Place *at, double *g)
{
    const Pull *pull = at->term->data;
    for (int i = 0; i < 2 * at->system->nodes; i++) {
        double x = at->averaged ? at->x_n[i] + 0.5 * at->u[i] : at->x[i];
        g[i] += stiffness(at, at->w, i) * (x - pull->target[i % 2]);
    }
}

/* The diagonal. */
static long long entries(const Place *at)
{
    return 2LL * at->system->nodes;
}

static void pattern(const Place *at, Triplets *triplets)
{
    for (int i = 0; i < 2 * at->system->nodes; i += 2)
        term_add_diagonal(at->system, i / 2, triplets);
}

/* Averaged, what is linear in u counts half.  It is never negative. */
static int hessian(const Place *at, Filter filter, const int *slot,
                   const double *q, double *out)
{
    double part = at->averaged ? 0.5 * at->w : at->w;
    (void)filter;
    for (int i = 0; i < 2 * at->system->nodes; i++) {
        double c = stiffness(at, part, i);
        if (q)
            out[i] += c * q[i];
        else
            out[slot[i]] += c;
    }
    return 0;
}

static void along(const Place *at, const double *p, double q[3])
{
    double part = at->averaged ? 0.25 * at->w : 0.5 * at->w;
    for (int i = 0; i < 2 * at->system->nodes; i++)
        q[0] += stiffness(at, part, i) * p[i] * p[i];
}

static void bounds(const Place *at, double *stiffest, double *force)
{
    (void)force;
    for (int i = 0; i < 2 * at->system->nodes; i += 2)
        bound_raise(stiffest, fabs(stiffness(at, 1, i)));
}

/* What both kinds share; averaged, each is itself. */
#define PULL                                                                   \
    .value = value, .gradient = gradient, .entries = entries,                  \
    .pattern = pattern, .hessian = hessian, .along = along, .bounds = bounds,  \
    .diagonal = true

const TermKind central_field = {PULL, .energy = "elastic",
                                .averaged = &central_field};
const TermKind hand_energy = {PULL, .energy = "hand", .place = PLACE_HAND,
                              .averaged = &hand_energy};

Status pull_set(System *system, const TermKind *kind, const Pull *pull)
{
    Term *term = system_find_term(system, kind);
    Pull *own = term ? term->data : malloc(sizeof *own);
    if (!own)
        return STATUS_OUT_OF_MEMORY;
    if (term)
        system_changed(system, true);
    *own = *pull;
    return term ? STATUS_OK : system_add_term(system, kind, own);
}

Status central_field_set(System *system, double omega2)
{
    Pull all = {.node = -1, .k = omega2};
    if (omega2 != 0)
        return pull_set(system, &central_field, &all);
    system_remove_term(system, &central_field);
    return STATUS_OK;
}

Pull *hand_energy_of(const System *system)
{
    return system_data(system, &hand_energy);
}
