/* system.c - masses, springs, pins, gravity, and sums over the energy terms. */
#include "model/system.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/damping.h"
#include "model/elements.h"
#include "model/mass_spring_energy.h"

Status system_create(int nodes, int springs, System *system)
{
    *system = (System){.nodes = nodes, .springs = springs};
    size_t n = (size_t)nodes, count = (size_t)springs;
    system->m = calloc(n + 2 * count, sizeof *system->m);
    system->e = calloc(1, (2 * count + n) * sizeof *system->e + n);
    if (!system->m || !system->e)
        return STATUS_OUT_OF_MEMORY;
    system->l2 = system->m + n;
    system->k = system->l2 + count;
    system->elimination_index = system->e + 2 * count;
    for (int i = 0; i < nodes; i++)
        system->elimination_index[i] = i;
    system->is_pinned = (unsigned char *)(system->elimination_index + n);
    return springs == 0 || system_add_term(system, &mass_spring_energy, 1)
               ? STATUS_OK
               : STATUS_OUT_OF_MEMORY;
}

void system_free(System *system)
{
    free(system->m);
    free(system->e);
    free(system->pin_v);
    while (system->term_count > 0)
        system_remove_term(system, system->term[0].kind);
    *system = (System){0};
}

EvalPoint make_eval_point(const System *system, const double *x_n,
                          const double *u, const double *x)
{
    const Damping *damped = u ? system_term_data(system, &damping) : NULL;
    return (EvalPoint){.system = system,
                       .weight = 1,
                       .x_n = x_n,
                       .u = u,
                       .x = x,
                       .damping = damped,
                       .k = damped ? damped->k : system->k,
                       .l2 = damped ? damped->l2 : system->l2};
}

bool system_is_feasible(EvalPoint at)
{
    for (const TermKind *kind; (kind = eval_point_next_term(&at));)
        if (kind->element && !elements_are_feasible(&at))
            return false;
    return true;
}

double system_max_alpha(EvalPoint at, const double *p, bool internal)
{
    double reach = INFINITY;
    for (const TermKind *kind; (kind = eval_point_next_term(&at));)
        if (kind->element && !(kind->is_external && internal))
            reach = fmin(reach, elements_max_alpha(&at, p));
    return reach;
}

bool system_path_is_free(const System *system, const double *x, const double *p)
{
    return system_max_alpha(make_eval_point(system, NULL, NULL, x), p, true) >
           1;
}

bool system_has_gravity(const System *system)
{
    return system->gravity[0] != 0 || system->gravity[1] != 0;
}

/* A sum below its rounding error, about sqrt(n) DBL_EPSILON sum |m g.x|, counts
 * as 0: a square with its centre at height 0 has no gravity potential. */
double system_gravity_potential(const System *system, const double *x)
{
    const double *a = system->gravity;
    double sum = 0, size = 0;
    if (!system_has_gravity(system))
        return 0;
    for (int i = 0; i < system->nodes; i++) {
        double part = system->m[i] * (a[0] * x[2 * i] + a[1] * x[2 * i + 1]);
        sum -= part;
        size += fabs(part);
    }
    double rounding = sqrt(system->nodes) * DBL_EPSILON * size;
    return fabs(sum) <= rounding ? 0 : sum;
}

double system_potential(const System *system, const double *x)
{
    EvalPoint at = make_eval_point(system, x, NULL, x);
    double sum = 0;
    for (const TermKind *kind; (kind = eval_point_next_term(&at));)
        if (kind->potential)
            sum += kind->potential(&at);
    return sum;
}

void system_zero_pinned_entries(const System *system, double *g)
{
    for (int i = 0; i < system->nodes; i++)
        if (system->is_pinned[i])
            g[2 * i] = g[2 * i + 1] = 0;
}

/* Whether P stays the same if the body shifts or, with `turn`, turns. */
static bool terms_are_invariant(const System *system, bool turn)
{
    for (int t = 0; t < system->term_count; t++) {
        const TermKind *kind = system->term[t].kind;
        if (kind->is_external || (turn && kind->depends_on_x_n))
            return false;
    }
    return true;
}

bool system_falls_freely(const System *system)
{
    return terms_are_invariant(system, false) &&
           !memchr(system->is_pinned, 1, (size_t)system->nodes);
}

bool system_turns_freely(const System *system, int *pivot)
{
    int pins = 0;
    *pivot = -1;
    for (int i = 0; i < system->nodes; i++)
        if (system->is_pinned[i]) {
            pins++;
            *pivot = i;
        }
    return pins <= 1 && terms_are_invariant(system, true);
}

void system_acceleration(const System *system, const double *x, double *a)
{
    EvalPoint at = make_eval_point(system, x, NULL, x);
    at.weight = -1;
    for (int i = 0; i < 2 * system->nodes; i++)
        a[i] = 0;
    for (const TermKind *kind; (kind = eval_point_next_term(&at));)
        if (kind->gradient)
            kind->gradient(&at, a);
    for (int i = 0; i < 2 * system->nodes; i++)
        a[i] = a[i] / system->m[i / 2] + system->gravity[i % 2];
    system_zero_pinned_entries(system, a);
}

double system_max_stiffness(const System *system)
{
    /* An EvalPoint with u is inside a step, where damping stiffens springs. */
    const double u = 0;
    EvalPoint at = make_eval_point(system, NULL, &u, NULL);
    double most = 0;
    for (const TermKind *kind; (kind = eval_point_next_term(&at));)
        if (kind->max_stiffness)
            most = max_or_nan(most, kind->max_stiffness(&at));
    return most;
}

double system_kinetic_energy(const System *system, const double *v)
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
