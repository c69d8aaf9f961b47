/* state.c - saves, restores and hashes the state of a simulation. */
#include "run/control.h"

#include <string.h>

#include "model/contact.h"
#include "model/fracture.h"
#include "model/plasticity.h"
#include "run/body.h"

/* A place in the bytes of a state.  The same
 * functions visit the pieces of a state to save, restore or count them. */
typedef struct Cursor {
    unsigned char *bytes; /* NULL: the pieces are only counted */
    bool restores;        /* bytes are read, not written */
    size_t used;          /* bytes visited so far */
} Cursor;

static void pass(Cursor *cursor, void *piece, size_t size)
{
    unsigned char *at = cursor->bytes ? cursor->bytes + cursor->used : NULL;
    if (at && cursor->restores)
        memcpy(piece, at, size);
    else if (at)
        memcpy(at, piece, size);
    cursor->used += size;
}

#define PASS(piece) pass(cursor, &(piece), sizeof(piece))

/* Visits what steps change in a system: broken springs, plastic strains, moving
 * obstacles, and the energy that each term has lost. */
static void pass_system(Cursor *cursor, System *system)
{
    size_t springs = (size_t)system->springs * sizeof(double);
    Plasticity *plasticity = system_term_data(system, &plastic_energy);
    Contact *contact = contact_of(system);
    PASS(system->lost);
    if (plasticity) {
        pass(cursor, plasticity->ep, springs);
        pass(cursor, plasticity->kappa, springs);
    }
    if (system_find_term(system, &fracture))
        pass(cursor, system->k, springs);
    if (contact)
        pass(cursor, contact->obstacle,
             (size_t)contact->obstacles * sizeof *contact->obstacle);
}

/* Visits the data of a small scene. */
static void pass_exhibit(Cursor *cursor, Simulation *simulation)
{
    const Scene *scene = simulation->scene;
    TimeIntegrator *run = &simulation->run[0];
    bool kinds = exhibit_has_kinds(simulation);
    if (kinds)
        PASS(simulation->exhibit.parts);
    if (kinds || scene->step)
        pass(cursor, simulation->system.k,
             (size_t)simulation->system.springs * sizeof(double));
    if (scene->step || scene->grips)
        PASS(simulation->exhibit);
    if (!scene->step)
        return;
    PASS(simulation->descent);
    PASS(simulation->options.timestep);
    PASS(run->h);
    if (run->newton)
        run->newton->settings.h = run->h;
}

static void pass_all(Cursor *cursor, Simulation *simulation)
{
    PASS(simulation->steps);
    PASS(simulation->unconverged);
    PASS(simulation->ledger);
    PASS(simulation->reasons);
    PASS(simulation->status);
    PASS(simulation->done);
    pass_exhibit(cursor, simulation);
    for (int r = 0; r < simulation->runs; r++) {
        TimeIntegrator *run = &simulation->run[r];
        size_t array = run->size * sizeof(double);
        PASS(run->steps);
        PASS(run->clock);
        PASS(run->moved);
        PASS(run->work);
        PASS(run->status);
        pass(cursor, run->x, array);
        pass(cursor, run->v, array);
        PASS(run->memory_h);
        pass(cursor, run->memory, (size_t)run->method->memory * array);
        if (r == 0 || run->system != simulation->run[0].system)
            pass_system(cursor, run->system);
        if (cursor->restores)
            system_mark_changed(run->system, false);
    }
}

size_t state_save(const Simulation *simulation, void *bytes)
{
    Cursor cursor = {bytes, false, 0};
    pass_all(&cursor, (Simulation *)simulation); /* saving changes nothing */
    return cursor.used;
}

void state_restore(const void *bytes, Simulation *simulation)
{
    Cursor cursor = {(unsigned char *)bytes, true, 0};
    simulation->prediction = (Prediction){0}; /* a guess is about one step */
    pass_all(&cursor, simulation);
    for (int r = 0; r < simulation->runs; r++)
        if (simulation->scene->needs & NEEDS_BODY)
            body_follow(simulation, r);
}

/* FNV-1a hash of bytes. */
static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ at[i]) * UINT64_C(1099511628211);
    return hash;
}

uint64_t state_hash(const Simulation *simulation, uint64_t seed)
{
    int64_t steps = simulation->steps;
    uint64_t hash = hash_bytes(seed, &steps, sizeof steps);
    for (int r = 0; r < simulation->runs; r++) {
        const TimeIntegrator *run = &simulation->run[r];
        hash = hash_bytes(hash, run->x, run->size * sizeof(double));
        hash = hash_bytes(hash, run->v, run->size * sizeof(double));
    }
    return hash;
}
