#include "model/fracture.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "model/mass_spring_energy.h"

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
    return fracture->strength * (1 + fracture->scatter * scatter_of(s));
}

/* The most loaded candidates first, by a heap; equal loads by number. */
static bool before(const Fracture *fracture, int a, int b)
{
    return fracture->load[a] > fracture->load[b] ||
           (fracture->load[a] == fracture->load[b] && a < b);
}

static void sink(Fracture *fracture, int count, int place)
{
    int *heap = fracture->candidate, it = heap[place];
    for (int child; (child = 2 * place + 1) < count; place = child) {
        if (child + 1 < count && before(fracture, heap[child + 1], heap[child]))
            child++;
        if (!before(fracture, heap[child], it))
            break;
        heap[place] = heap[child];
    }
    heap[place] = it;
}

/* Collects the candidates; returns how many. */
static int find_candidates(Fracture *fracture, const System *system,
                           const double *x)
{
    int count = 0;
    for (int s = 0; s < system->springs; s++) {
        if (spring_is_broken(system, s))
            continue;
        double d[2];
        double strain = spring_strain(system->e + 2 * s, system->l2[s], x, d);
        fracture->load[s] = strain / fracture_strength(fracture, s);
        if (fracture->load[s] > 1)
            fracture->candidate[count++] = s;
    }
    for (int place = count / 2 - 1; place >= 0; place--)
        sink(fracture, count, place);
    return count;
}

/* Breaks them; the energy that was in them, and in cells that end with them, is
 * what the potential has less afterwards. */
static bool end(Term *term, System *system, const double *x, const double *v,
                double h)
{
    Fracture *fracture = term->data;
    int count = find_candidates(fracture, system, x);
    (void)v;
    (void)h;
    if (count == 0)
        return false;
    double energy = system_potential(system, x);
    memset(fracture->taken, 0, (size_t)system->nodes);
    while (count > 0) {
        int s = fracture->candidate[0];
        unsigned char *i = &fracture->taken[system->e[2 * s]];
        unsigned char *j = &fracture->taken[system->e[2 * s + 1]];
        fracture->candidate[0] = fracture->candidate[--count];
        sink(fracture, count, 0);
        if (*i || *j)
            continue;
        *i = *j = 1;
        system->k[s] = 0;
        fracture->broken++;
    }
    system_lose(system, term->kind, energy - system_potential(system, x));
    return true;
}

static bool valid(const Place *at)
{
    const Fracture *fracture = at->term->data;
    return isfinite(fracture->strength) && fracture->strength > 0 &&
           fracture->scatter >= 0 && fracture->scatter < 1;
}

const TermKind fracture = {
    .loss = "fracture",
    .valid = valid,
    .end = end,
    .internal = true,
};

Status fracture_add(System *system, double strength, double scatter)
{
    size_t springs = (size_t)system->springs;
    Fracture *data =
        calloc(1, sizeof *data + springs * (sizeof(double) + sizeof(int)) +
                      (size_t)system->nodes);
    if (!data)
        return STATUS_OUT_OF_MEMORY;
    data->strength = strength;
    data->scatter = scatter;
    data->load = (double *)(data + 1);
    data->candidate = (int *)(data->load + springs);
    data->taken = (unsigned char *)(data->candidate + springs);
    system->breaks = true;
    return system_add_term(system, &fracture, data);
}
