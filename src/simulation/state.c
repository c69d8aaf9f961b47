/* state.c - saves, restores and hashes the state of a simulation. */
#include "simulation/control.h"

#include <string.h>

#include "model/contact.h"
#include "model/fracture.h"
#include "model/plasticity.h"

/* Position in the bytes of a state.  Saving, restoring and counting visit the
 * pieces of a state by the same functions. */
typedef struct StateCursor {
    unsigned char *bytes; /* NULL: the pieces are only counted */
    bool is_restoring;    /* the pieces are read from the bytes */
    size_t offset;        /* bytes visited so far */
} StateCursor;

/* Saves, restores or counts a piece of the state. */
static void serialise_bytes(StateCursor *cursor, void *piece, size_t size)
{
    unsigned char *at = cursor->bytes ? cursor->bytes + cursor->offset : NULL;
    if (at && cursor->is_restoring)
        memcpy(piece, at, size);
    else if (at)
        memcpy(at, piece, size);
    cursor->offset += size;
}

#define SERIALISE(piece) serialise_bytes(cursor, &(piece), sizeof(piece))

/* Visits all that steps change in a system: broken springs, plastic strains,
 * moving obstacles, and the energy that each term has lost. */
static void serialise_system(StateCursor *cursor, System *system)
{
    size_t springs = (size_t)system->springs * sizeof(double);
    Plasticity *plasticity = system_term_data(system, &plastic_energy);
    Contact *contact = get_contact(system);
    SERIALISE(system->losses);
    if (plasticity) {
        serialise_bytes(cursor, plasticity->ep, springs);
        serialise_bytes(cursor, plasticity->kappa, springs);
    }
    if (system_find_term(system, &fracture))
        serialise_bytes(cursor, system->k, springs);
    if (contact)
        serialise_bytes(cursor, contact->obstacle,
                        (size_t)contact->obstacle_count *
                            sizeof *contact->obstacle);
}

static void serialise_exhibit(StateCursor *cursor, Simulation *simulation)
{
    const Scene *scene = simulation->scene;
    TimeIntegrator *run = &simulation->run[0];
    bool kinds = simulation->options.layers & LAYER_SPRING_KINDS;
    if (kinds)
        SERIALISE(simulation->exhibit.switches);
    if (kinds || scene->step)
        serialise_bytes(cursor, simulation->system.k,
                        (size_t)simulation->system.springs * sizeof(double));
    if (scene->step || scene->handle_kinds)
        SERIALISE(simulation->exhibit);
    if (!scene->step)
        return;
    SERIALISE(simulation->descent);
    SERIALISE(simulation->options.timestep);
    SERIALISE(run->h);
    if (cursor->is_restoring && run->newton)
        run->newton->settings.h = run->h;
}

static void serialise_state(StateCursor *cursor, Simulation *simulation)
{
    SERIALISE(simulation->steps);
    SERIALISE(simulation->unconverged_steps);
    SERIALISE(simulation->ledger);
    SERIALISE(simulation->status_counts);
    SERIALISE(simulation->status);
    SERIALISE(simulation->is_over);
    serialise_exhibit(cursor, simulation);
    for (int r = 0; r < simulation->runs; r++) {
        TimeIntegrator *run = &simulation->run[r];
        size_t array = run->x_length * sizeof(double);
        SERIALISE(run->steps);
        SERIALISE(run->clock);
        SERIALISE(run->moved_fraction);
        SERIALISE(run->external_work);
        SERIALISE(run->status);
        serialise_bytes(cursor, run->x, array);
        serialise_bytes(cursor, run->v, array);
        SERIALISE(run->history_h);
        serialise_bytes(cursor, run->history,
                        (size_t)run->method->history_arrays * array);
        if (r == 0 || run->system != simulation->run[0].system)
            serialise_system(cursor, run->system);
        if (cursor->is_restoring)
            system_mark_changed(run->system, false);
    }
}

size_t state_save(const Simulation *simulation, void *bytes)
{
    StateCursor cursor = {bytes, false, 0};
    serialise_state(&cursor, (Simulation *)simulation); /* saving only reads */
    return cursor.offset;
}

void state_restore(const void *bytes, Simulation *simulation)
{
    StateCursor cursor = {(unsigned char *)bytes, true, 0};
    simulation->prediction = (UserPrediction){0}; /* a guess is not saved */
    serialise_state(&cursor, simulation);
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
        hash = hash_bytes(hash, run->x, run->x_length * sizeof(double));
        hash = hash_bytes(hash, run->v, run->x_length * sizeof(double));
    }
    return hash;
}
