#include "model/central_field.h"

#include <math.h>
#include <stdlib.h>

static double omega2_of(const Term *term)
{
    return *(const double *)term->data;
}

static bool valid(const Term *term, const System *system)
{
    (void)system;
    return isfinite(omega2_of(term)) && omega2_of(term) >= 0;
}

/* omega2 times sum m |x|^2/2 */
static double value(const Term *term, const Place *at)
{
    return omega2_of(term) * system_kinetic(at->system, at->x);
}

/* m omega2 x */
static void gradient(const Term *term, const Place *at, double w, double *g)
{
    const System *system = at->system;
    for (int i = 0; i < 2 * system->nodes; i++)
        g[i] += w * omega2_of(term) * system->m[i / 2] * at->x[i];
}

/* Along the way: sum m omega2 u.(x_n/2 + u/4) * 2, with the gradient
 * m omega2 (x_n + u/2). */
static double average_value(const Term *term, const Place *at)
{
    const System *system = at->system;
    double sum = 0;
    for (int i = 0; i < 2 * system->nodes; i++)
        sum += system->m[i / 2] * at->u[i] * (at->x_n[i] + 0.25 * at->u[i]);
    return omega2_of(term) * sum;
}

static void average_gradient(const Term *term, const Place *at, double w,
                             double *g)
{
    const System *system = at->system;
    for (int i = 0; i < 2 * system->nodes; i++)
        g[i] += w * omega2_of(term) * system->m[i / 2] *
                (at->x_n[i] + 0.5 * at->u[i]);
}

/* The diagonal. */
static long long entries(const Term *term, const System *system)
{
    (void)term;
    return 2LL * system->nodes;
}

static void pattern(const Term *term, const System *system, Triplets *triplets)
{
    (void)term;
    for (int i = 0; i < system->nodes; i++) {
        int place = system->order ? system->order[i] : i;
        triplets_add(triplets, 2 * place, 2 * place);
        triplets_add(triplets, 2 * place + 1, 2 * place + 1);
    }
}

static int hessian(const Term *term, const Place *at, double w, Filter filter,
                   const int *slot, double *values)
{
    (void)filter; /* it is positive */
    for (int t = 0; t < 2 * at->system->nodes; t++)
        values[slot[t]] += w * omega2_of(term) * at->system->m[t / 2];
    return 0;
}

static void product(const Term *term, const Place *at, double w, Filter filter,
                    const double *q, double *y)
{
    (void)filter;
    for (int i = 0; i < 2 * at->system->nodes; i++)
        y[i] += w * omega2_of(term) * at->system->m[i / 2] * q[i];
}

static void along(const Term *term, const Place *at, const double *p, double w,
                  double reach, double q[3])
{
    (void)reach;
    for (int i = 0; i < 2 * at->system->nodes; i++)
        q[0] += 0.5 * w * omega2_of(term) * at->system->m[i / 2] * p[i] * p[i];
}

/* (u - u_tilde) + w omega2 (x_n + u) = 0 in each coordinate. */
static void closed_form(const Term *term, const Place *at, double w,
                        const double *u_tilde, double *u)
{
    double stiffness = w * omega2_of(term);
    for (int i = 0; i < 2 * at->system->nodes; i++)
        u[i] = (u_tilde[i] - stiffness * at->x_n[i]) / (1 + stiffness);
}

/* Averaged: half the weight on u, in the functions that are linear in w. */
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

static void average_closed_form(const Term *term, const Place *at, double w,
                                const double *u_tilde, double *u)
{
    double stiffness = w * omega2_of(term);
    for (int i = 0; i < 2 * at->system->nodes; i++)
        u[i] = (u_tilde[i] - stiffness * at->x_n[i]) / (1 + 0.5 * stiffness);
}

/* A field bends up everywhere. */
static void concave(const Term *term, const Place *at, double w, double *sum)
{
    (void)term;
    (void)at;
    (void)w;
    (void)sum;
}

static const TermKind averaged_central_field = {
    .name = "central field",
    .valid = valid,
    .value = average_value,
    .gradient = average_gradient,
    .entries = entries,
    .pattern = pattern,
    .hessian = average_hessian,
    .product = average_product,
    .along = average_along,
    .concave = concave,
    .closed_form = average_closed_form,
};

const TermKind central_field = {
    .name = "central field",
    .valid = valid,
    .value = value,
    .gradient = gradient,
    .entries = entries,
    .pattern = pattern,
    .hessian = hessian,
    .product = product,
    .along = along,
    .averaged = &averaged_central_field,
    .concave = concave,
    .closed_form = closed_form,
    .free = free,
};

Status central_field_set(System *system, double omega2)
{
    Term *term = system_find_term(system, &central_field);
    if (omega2 == 0) {
        system_remove_term(system, &central_field);
        return STATUS_OK;
    }
    if (term) {
        *(double *)term->data = omega2;
        return STATUS_OK;
    }
    double *data = malloc(sizeof *data);
    if (!data)
        return STATUS_OUT_OF_MEMORY;
    *data = omega2;
    if (system_add_term(system, &central_field, data))
        return STATUS_OK;
    free(data);
    return STATUS_TOO_LARGE;
}

double central_field_omega2(const System *system)
{
    const Term *term = system_find_term(system, &central_field);
    return term ? omega2_of(term) : 0;
}
