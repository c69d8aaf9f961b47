#include "model/fracture.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "model/mass_spring_energy.h"

/* Part by which the strengths of springs differ. */
static const double SCATTER = 0.1;

Fracture *fracture_of(const System *system)
{
    return system_data(system, &fracture);
}

/* A number from -1 to 1 for each spring: SplitMix64 (Steele et al. 2014). */
static double scatter_of(int s)
{
    uint64_t z = ((uint64_t)s + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-52 - 1;
}

double fracture_strength(const Fracture *fracture, int s)
{
    return fracture->strength * (1 + SCATTER * scatter_of(s));
}

/* The spring with the highest load, strain over strength, above 1, at whose
 * nodes none has broken in this step; -1: there is none. */
static int most_loaded(const Fracture *fracture, const System *system,
                       const double *x)
{
    double most = 1;
    int found = -1;
    for (int s = 0; s < system->springs; s++) {
        const int *e = system->e + 2 * s;
        double d[2], strain = spring_strain(e, system->l2[s], x, d);
        double load = strain / fracture_strength(fracture, s);
        if (load > most && !spring_is_broken(system, s) &&
            !fracture->taken[e[0]] && !fracture->taken[e[1]]) {
            most = load;
            found = s;
        }
    }
    return found;
}

/* Breaks them; the energy that was in them, and in cells that end with them, is
 * what the potential has less afterwards. */
static void end(const TermStep *step)
{
    System *system = step->system;
    Fracture *fracture = step->term->data;
    const double *x = step->x;
    memset(fracture->taken, 0, (size_t)system->nodes);
    int s = most_loaded(fracture, system, x);
    if (s < 0)
        return;
    double energy = system_potential(system, x);
    for (; s >= 0; s = most_loaded(fracture, system, x)) {
        fracture->taken[system->e[2 * s]] = 1;
        fracture->taken[system->e[2 * s + 1]] = 1;
        system->k[s] = 0;
        fracture->broken++;
    }
    system_lose(system, step->term->kind, energy - system_potential(system, x));
    system_changed(system, false);
}

static Status set(System *system, const struct SquareMesh *mesh,
                  const double *number)
{
    (void)mesh;
    if (number[0] == 0)
        return STATUS_OK;
    Fracture *data =
        system_term(system, &fracture, sizeof *data + (size_t)system->nodes);
    if (!data)
        return STATUS_OUT_OF_MEMORY;
    data->strength = number[0];
    data->taken = (unsigned char *)(data + 1);
    system->breaks = true;
    return STATUS_OK;
}

const TermKind fracture = {
    .set = set,
    .loss = "fracture",
    .place = PLACE_FRACTURE,
    .end = end,
    .internal = true,
};
