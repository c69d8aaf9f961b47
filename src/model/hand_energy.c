#include "model/hand_energy.h"

#include <math.h>
#include <stdlib.h>

static const HandEnergy *hand_of(const Term *term)
{
    return term->data;
}

static bool valid(const Term *term, const System *system)
{
    const HandEnergy *hand = hand_of(term);
    return hand->node >= 0 && hand->node < system->nodes && hand->k >= 0 &&
           isfinite(hand->k) && isfinite(hand->target[0]) &&
           isfinite(hand->target[1]);
}

/* k/2 |x_i - target|^2 */
static double value(const Term *term, const Place *at)
{
    const HandEnergy *hand = hand_of(term);
    double dx = at->x[2 * hand->node] - hand->target[0];
    double dy = at->x[2 * hand->node + 1] - hand->target[1];
    return 0.5 * hand->k * (dx * dx + dy * dy);
}

/* k (x_i - target) */
static void gradient(const Term *term, const Place *at, double w, double *g)
{
    const HandEnergy *hand = hand_of(term);
    for (int c = 0; c < 2; c++) {
        int i = 2 * hand->node + c;
        g[i] += w * hand->k * (at->x[i] - hand->target[c]);
    }
}

/* Two entries on the diagonal. */
static long long entries(const Term *term, const System *system)
{
    (void)term;
    (void)system;
    return 2;
}

static void pattern(const Term *term, const System *system, Triplets *triplets)
{
    int node = hand_of(term)->node;
    int place = system->order ? system->order[node] : node;
    triplets_add(triplets, 2 * place, 2 * place);
    triplets_add(triplets, 2 * place + 1, 2 * place + 1);
}

static int hessian(const Term *term, const Place *at, double w, Filter filter,
                   const int *slot, double *values)
{
    (void)at;
    (void)filter; /* it is positive */
    values[slot[0]] += w * hand_of(term)->k;
    values[slot[1]] += w * hand_of(term)->k;
    return 0;
}

static void product(const Term *term, const Place *at, double w, Filter filter,
                    const double *q, double *y)
{
    const HandEnergy *hand = hand_of(term);
    (void)at;
    (void)filter;
    for (int i = 2 * hand->node; i < 2 * hand->node + 2; i++)
        y[i] += w * hand->k * q[i];
}

static void along(const Term *term, const Place *at, const double *p, double w,
                  double reach, double q[3])
{
    const HandEnergy *hand = hand_of(term);
    const double *pi = p + 2 * hand->node;
    (void)at;
    (void)reach;
    q[0] += 0.5 * w * hand->k * (pi[0] * pi[0] + pi[1] * pi[1]);
}

/* Along the straight way from x_n to x_n + u the mean of the gradient is
 * k (x_n + u/2 - target); this is its potential in u. */
static double average_value(const Term *term, const Place *at)
{
    const HandEnergy *hand = hand_of(term);
    double sum = 0;
    for (int c = 0; c < 2; c++) {
        int i = 2 * hand->node + c;
        sum += at->u[i] * (at->x_n[i] - hand->target[c] + 0.25 * at->u[i]);
    }
    return hand->k * sum;
}

static void average_gradient(const Term *term, const Place *at, double w,
                             double *g)
{
    const HandEnergy *hand = hand_of(term);
    for (int c = 0; c < 2; c++) {
        int i = 2 * hand->node + c;
        g[i] += w * hand->k * (at->x_n[i] + 0.5 * at->u[i] - hand->target[c]);
    }
}

/* Half the weight on u, in the functions that are linear in w. */
static int average_hessian(const Term *term, const Place *at, double w,
                           Filter filter, const int *slot, double *values)
{
    return hessian(term, at, 0.5 * w, filter, slot, values);
}

static void average_product(const Term *term, const Place *at, double w,
                            Filter filter, const double *q, double *y)
{
    product(term, at, 0.5 * w, filter, q, y);
}

static void average_along(const Term *term, const Place *at, const double *p,
                          double w, double reach, double q[3])
{
    along(term, at, p, 0.5 * w, reach, q);
}

static double stiffest(const Term *term, const System *system)
{
    (void)system;
    return hand_of(term)->k;
}

/* It bends up everywhere. */
static void concave(const Term *term, const Place *at, double w, double *sum)
{
    (void)term;
    (void)at;
    (void)w;
    (void)sum;
}

static const TermKind averaged_hand_energy = {
    .name = "hand",
    .valid = valid,
    .value = average_value,
    .gradient = average_gradient,
    .entries = entries,
    .pattern = pattern,
    .hessian = average_hessian,
    .product = average_product,
    .along = average_along,
    .stiffest = stiffest,
    .concave = concave,
};

const TermKind hand_energy = {
    .name = "hand",
    .valid = valid,
    .value = value,
    .gradient = gradient,
    .entries = entries,
    .pattern = pattern,
    .hessian = hessian,
    .product = product,
    .along = along,
    .averaged = &averaged_hand_energy,
    .stiffest = stiffest,
    .concave = concave,
    .free = free,
};

Status hand_energy_set(System *system, const HandEnergy *hand)
{
    HandEnergy *own = hand_energy_of(system);
    if (hand->node < 0 || hand->node >= system->nodes)
        return STATUS_INVALID_INPUT;
    if (own) {
        *own = *hand;
        return STATUS_OK;
    }
    own = malloc(sizeof *own);
    if (!own)
        return STATUS_OUT_OF_MEMORY;
    *own = *hand;
    if (system_add_term(system, &hand_energy, own))
        return STATUS_OK;
    free(own);
    return STATUS_TOO_LARGE;
}

void hand_energy_remove(System *system)
{
    system_remove_term(system, &hand_energy);
}

HandEnergy *hand_energy_of(const System *system)
{
    const Term *term = system_find_term(system, &hand_energy);
    return term ? term->data : NULL;
}

double hand_energy_value(const System *system, const double *x)
{
    const Term *term = system_find_term(system, &hand_energy);
    Place at = {system, x, NULL, x};
    return term ? value(term, &at) : 0;
}
