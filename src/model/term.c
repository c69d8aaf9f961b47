/* term.c - the list of a system's terms, and triplets of their Hessians. */
#include "model/system.h"

#include <stdlib.h>
#include <string.h>

void system_mark_changed(System *system, bool pattern)
{
    system->version++;
    system->pattern_version += pattern;
}

EnergyTerm *system_find_term(const System *system, const TermKind *kind)
{
    for (int t = 0; t < system->term_count; t++)
        if (system->term[t].kind == kind)
            return (EnergyTerm *)&system->term[t];
    return NULL;
}

void *system_term_data(const System *system, const TermKind *kind)
{
    const EnergyTerm *term = system_find_term(system, kind);
    return term ? term->data : NULL;
}

void *system_add_term(System *system, const TermKind *kind, size_t bytes)
{
    int place = system->term_count;
    void *data = system_term_data(system, kind);
    if (data || place == SYSTEM_MAX_TERMS || !(data = calloc(1, bytes)))
        return data;
    for (; place > 0 && system->term[place - 1].kind->rank > kind->rank;
         place--)
        system->term[place] = system->term[place - 1];
    system->term[place] = (EnergyTerm){.kind = kind, .data = data};
    system->term_count++;
    system_mark_changed(system, true);
    return data;
}

void system_remove_term(System *system, const TermKind *kind)
{
    EnergyTerm *term = system_find_term(system, kind);
    if (!term)
        return;
    if (kind->free)
        kind->free(term->data);
    free(term->data);
    EnergyTerm *end = system->term + --system->term_count;
    for (; term < end; term++)
        term[0] = term[1];
    system_mark_changed(system, true);
}

/* Adds to the lost energy of the kind's name.  A name that is not in the table
 * yet takes the first free row. */
void system_add_loss(System *system, const TermKind *kind, double energy)
{
    EnergyLoss *loss = system->losses;
    while (loss->name && strcmp(loss->name, kind->loss_name) != 0)
        loss++;
    loss->name = kind->loss_name;
    loss->energy += energy;
}

const TermKind *eval_point_next_term(EvalPoint *at)
{
    const System *system = at->system;
    const EnergyTerm *next = at->term ? at->term + 1 : system->term;
    at->term = next < system->term + system->term_count ? next : NULL;
    return at->term ? at->term->kind : NULL;
}

void add_block_triplets(const System *system, int i, int j, Triplets *triplets)
{
    int r = system->elimination_index[i], c = system->elimination_index[j];
    triplets_add(triplets, 2 * r, 2 * c);
    triplets_add(triplets, 2 * r, 2 * c + 1);
    if (r != c)
        triplets_add(triplets, 2 * r + 1, 2 * c);
    triplets_add(triplets, 2 * r + 1, 2 * c + 1);
}

void add_diagonal_triplets(const System *system, int i, Triplets *triplets)
{
    int place = system->elimination_index[i];
    triplets_add(triplets, 2 * place, 2 * place);
    triplets_add(triplets, 2 * place + 1, 2 * place + 1);
}
