#include "bench/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Results that are extrapolated from. */
enum { REFERENCE_COLUMNS = 6 };

/* v += h a(x): each spring pulls with 2 k (|d|^2/l2 - 1) d. */
static void reference_kick(const System *system, const long double *x,
                           long double h, long double *v)
{
    for (int s = 0; s < system->springs; s++) {
        int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
        long double dx = x[i] - x[j], dy = x[i + 1] - x[j + 1];
        long double f = 2 * (long double)system->k[s] * h *
                        ((dx * dx + dy * dy) / system->l2[s] - 1);
        long double fi = f / system->m[i / 2], fj = f / system->m[j / 2];
        v[i] -= fi * dx;
        v[i + 1] -= fi * dy;
        v[j] += fj * dx;
        v[j + 1] += fj * dy;
    }
}

/* Leapfrog over the time H in so many steps; inside, the two half kicks of
 * neighbouring steps are one. */
static void reference_leapfrog(const System *system, long double H, int steps,
                               long double *x, long double *v)
{
    long double h = H / steps;
    reference_kick(system, x, h / 2, v);
    for (int step = 1; step <= steps; step++) {
        for (int i = 0; i < 2 * system->nodes; i++)
            x[i] += h * v[i];
        reference_kick(system, x, step < steps ? h : h / 2, v);
    }
}

/* Lagrange: sum over j of w_j f(1/n_j) is the value at 0 of the polynomial in
 * 1/n^2 through all f, with w_j = product over i of n_j^2 / (n_j^2 - n_i^2). */
static long double reference_weight(int j)
{
    long double weight = 1, n2 = (long double)j * j;
    for (int i = 1; i <= REFERENCE_COLUMNS; i++)
        if (i != j)
            weight *= n2 / (n2 - (long double)i * i);
    return weight;
}

/* One interval.  work [8n]: start and one result, each x then v. */
static void reference_interval(const System *system, long double H,
                               Reference *out, long double *work)
{
    size_t size = 2 * (size_t)system->nodes, bytes = size * sizeof *work;
    long double *x0 = work, *v0 = x0 + size, *x = v0 + size, *v = x + size;
    memcpy(x0, out->x, bytes);
    memcpy(v0, out->v, bytes);
    for (int j = 1; j <= REFERENCE_COLUMNS; j++) {
        long double weight = reference_weight(j);
        memcpy(x, x0, bytes);
        memcpy(v, v0, bytes);
        reference_leapfrog(system, H, j, x, v);
        for (size_t i = 0; i < size; i++) {
            out->x[i] += weight * (x[i] - x0[i]);
            out->v[i] += weight * (v[i] - v0[i]);
        }
    }
}

Status reference_create(const System *system, const double *x, const double *v,
                        double time, long intervals, Reference *out)
{
    size_t size = 2 * (size_t)system->nodes;
    *out = (Reference){.system = system};
    long double *work = malloc(4 * size * sizeof *work);
    out->x = malloc(size * sizeof *out->x);
    out->v = malloc(size * sizeof *out->v);
    if (!work || !out->x || !out->v) {
        free(work);
        return STATUS_OUT_OF_MEMORY;
    }
    for (size_t i = 0; i < size; i++) {
        out->x[i] = x[i];
        out->v[i] = v[i];
    }
    for (long i = 0; i < intervals; i++)
        reference_interval(system, (long double)time / intervals, out, work);
    free(work);
    return STATUS_OK;
}

void reference_free(Reference *reference)
{
    free(reference->x);
    free(reference->v);
    *reference = (Reference){0};
}

double reference_distance(const Reference *reference, const double *x)
{
    const System *system = reference->system;
    long double sum = 0, mass = 0;
    for (int i = 0; i < 2 * system->nodes; i++) {
        long double d = reference->x[i] - x[i];
        sum += system->m[i / 2] * d * d;
        mass += 0.5L * system->m[i / 2];
    }
    return (double)sqrtl(sum / mass);
}
