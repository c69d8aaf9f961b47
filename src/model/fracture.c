/* fracture.c - breaks overstretched springs after a step. */
#include "model/fracture.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "model/spring_law.h"

/* Largest relative difference of a spring's strength from the mean. */
static const double SCATTER = 0.1;

/* SplitMix64 (Steele et al. 2014) gives each spring a number from -1 to 1. */
double fracture_strength(const Fracture *fracture, int s)
{
    uint64_t z = ((uint64_t)s + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    double scatter = (double)(z >> 11) * 0x1p-52 - 1;
    return fracture->mean_strength * (1 + SCATTER * scatter);
}

/* Orders candidates for qsort: largest load first, equal loads by spring. */
static int compare_loads(const void *one, const void *other)
{
    const SpringLoad *a = one, *b = other;
    if (a->load != b->load)
        return a->load > b->load ? -1 : 1;
    return a->spring_index - b->spring_index;
}

/* Collects and sorts the candidates, and returns their number. */
static int find_overloaded_springs(Fracture *fracture, const System *system,
                                   const double *x)
{
    int count = 0;
    for (int s = 0; s < system->springs; s++) {
        double d[2];
        double d2 = spring_vector(system->e + 2 * s, x, d);
        double strain = spring_strain(d2, system->l2[s]);
        double load = strain / fracture_strength(fracture, s);
        if (load > 1 && !spring_is_broken(system, s))
            fracture->candidate[count++] = (SpringLoad){load, s};
    }
    qsort(fracture->candidate, (size_t)count, sizeof(SpringLoad),
          compare_loads);
    return count;
}

/* Breaks springs, and books the decrease of the potential as lost energy.  The
 * cells of broken springs lose their energy, too. */
static void fracture_end_step(const TermStep *step)
{
    System *system = step->system;
    Fracture *fracture = step->term->data;
    int count = find_overloaded_springs(fracture, system, step->x);
    if (count == 0)
        return;
    double energy = system_potential(system, step->x);
    memset(fracture->has_new_break, 0, (size_t)system->nodes);
    for (int k = 0; k < count; k++) {
        int s = fracture->candidate[k].spring_index;
        unsigned char *i = &fracture->has_new_break[system->e[2 * s]];
        unsigned char *j = &fracture->has_new_break[system->e[2 * s + 1]];
        if (*i || *j)
            continue;
        *i = *j = 1;
        system->k[s] = 0;
    }
    system_add_loss(system, step->term->kind,
                    energy - system_potential(system, step->x));
    system_mark_changed(system, false);
}

static Status fracture_configure(System *system, const struct SquareMesh *mesh,
                                 const double *number)
{
    size_t springs = (size_t)system->springs;
    (void)mesh;
    Fracture *data =
        system_add_term(system, &fracture,
                        sizeof *data + springs * sizeof *data->candidate +
                            (size_t)system->nodes);
    if (!data)
        return STATUS_OUT_OF_MEMORY;
    data->mean_strength = number[0];
    data->candidate = (SpringLoad *)(data + 1);
    data->has_new_break = (unsigned char *)(data->candidate + springs);
    return STATUS_OK;
}

const TermKind fracture = {
    .configure = fracture_configure,
    .loss_name = "fracture",
    .rank = RANK_FRACTURE,
    .end_step = fracture_end_step,
    .supports_all_integrators = true,
};
