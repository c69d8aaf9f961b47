#include "model/system.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "model/inertia_energy.h"
#include "model/mass_spring_energy.h"

Status system_create(int nodes, int springs, System *system)
{
    *system = (System){.nodes = nodes, .springs = springs};
    if (nodes < 1 || nodes > INT_MAX / 2 || springs < 0 ||
        springs > INT_MAX / SPRING_ENTRIES)
        return STATUS_INVALID_INPUT;
    size_t n = (size_t)nodes, count = (size_t)springs;
    system->m = calloc(n, sizeof *system->m);
    if (!system->m)
        return STATUS_OUT_OF_MEMORY;
    if (springs == 0)
        return STATUS_OK;
    system->e = calloc(2 * count, sizeof *system->e);
    system->l2 = calloc(count, sizeof *system->l2);
    system->k = calloc(count, sizeof *system->k);
    if (!system->e || !system->l2 || !system->k)
        return STATUS_OUT_OF_MEMORY;
    return STATUS_OK;
}

Status system_create_pins(System *system)
{
    system->pinned = calloc((size_t)system->nodes, sizeof *system->pinned);
    return system->pinned ? STATUS_OK : STATUS_OUT_OF_MEMORY;
}

void system_free(System *system)
{
    if (!system)
        return;
    free(system->m);
    free(system->e);
    free(system->l2);
    free(system->k);
    free(system->pinned);
    free(system->order);
    *system = (System){0};
}

/* A normal number > 0: not 0, denormal, infinite or NaN. */
static bool is_positive(double value)
{
    return isnormal(value) && value > 0;
}

/* Two different nodes, rest length and stiffness that can be divided by. */
static bool spring_is_valid(const System *system, int s)
{
    int i = system->e[2 * s], j = system->e[2 * s + 1];
    return i >= 0 && i < system->nodes && j >= 0 && j < system->nodes &&
           i != j && is_positive(system->l2[s]) && is_positive(system->k[s]) &&
           is_positive(system->k[s] / system->l2[s]);
}

Status system_check(const System *system, const double *x)
{
    if (!isfinite(system->omega2) || system->omega2 < 0)
        return STATUS_INVALID_INPUT;
    for (int i = 0; i < system->nodes; i++)
        if (!is_positive(system->m[i]) || !isfinite(x[2 * i]) ||
            !isfinite(x[2 * i + 1]))
            return STATUS_INVALID_INPUT;
    for (int s = 0; s < system->springs; s++)
        if (!spring_is_valid(system, s))
            return STATUS_INVALID_INPUT;
    return STATUS_OK;
}

/* Springs, and omega2/2 sum m |x|^2 for the central field. */
double system_potential(const System *system, const double *x)
{
    double sum = mass_spring_energy_value(system->springs, x, system->e,
                                          system->l2, system->k);
    if (system->omega2 > 0)
        sum += system->omega2 * system_kinetic(system, x);
    return sum;
}

/* Adds scale omega2 m x, the gradient of the central field's energy. */
static void central_gradient(const System *system, const double *x,
                             double scale, double *g)
{
    for (int i = 0; i < 2 * system->nodes; i++)
        g[i] += scale * system->omega2 * system->m[i / 2] * x[i];
}

void system_gradient(const System *system, const double *x, double scale,
                     double *g)
{
    mass_spring_energy_gradient(system->springs, x, system->e, system->l2,
                                system->k, scale, g);
    if (system->omega2 > 0)
        central_gradient(system, x, scale, g);
    system_clear_pinned(system, g);
}

void system_clear_pinned(const System *system, double *g)
{
    if (!system->pinned)
        return;
    for (int i = 0; i < system->nodes; i++)
        if (system->pinned[i])
            g[2 * i] = g[2 * i + 1] = 0;
}

bool system_is_free(const System *system)
{
    return !system->pinned && !(system->omega2 > 0);
}

void system_acceleration(const System *system, const double *x, double *a)
{
    for (int i = 0; i < 2 * system->nodes; i++)
        a[i] = 0;
    system_gradient(system, x, -1, a);
    for (int i = 0; i < 2 * system->nodes; i++)
        a[i] /= system->m[i / 2];
}

/* sum m_i |v_i|^2 / 2 */
double system_kinetic(const System *system, const double *v)
{
    double sum = 0;
    for (int i = 0; i < system->nodes; i++)
        sum += 0.5 * system->m[i] *
               (v[2 * i] * v[2 * i] + v[2 * i + 1] * v[2 * i + 1]);
    return sum;
}

double system_inverse_mass_norm(const System *system, const double *g)
{
    double sum = 0;
    for (int i = 0; i < system->nodes; i++)
        sum +=
            (g[2 * i] * g[2 * i] + g[2 * i + 1] * g[2 * i + 1]) / system->m[i];
    return sqrt(sum);
}
