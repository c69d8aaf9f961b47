#include "scenes/state.h"

#include <string.h>

#include "scenes/scene.h"

/* What a state holds beside arrays. */
typedef struct StateHead {
    long steps, unconverged;
    long steps_before; /* of which the timestep was another */
    double time_before;
    double work[SIMULATION_MAX_RUNS];
    Status first, status;
    bool done;
    int reasons[STATUS_COUNT];
} StateHead;

/* The same for one run. */
typedef struct RunHead {
    long steps, unconverged;
    Status status;
    bool remembers;
} RunHead;

/* Doubles of one array of a run. */
static size_t array_size(const Simulation *simulation)
{
    return 2 * (size_t)simulation->system.nodes;
}

size_t state_size(const Simulation *simulation)
{
    const Scene *scene = simulation->scene;
    if (!(scene->needs & NEEDS_TIME) || scene->step || scene->handles)
        return 0;
    size_t bytes = sizeof(StateHead), arrays = 0;
    for (int r = 0; r < simulation->runs; r++) {
        bytes += sizeof(RunHead);
        arrays += 2 + (size_t)simulation->run[r].method->memory;
    }
    return bytes + arrays * array_size(simulation) * sizeof(double);
}

/* Where bytes are read or written next. */
typedef struct Cursor {
    unsigned char *at;
} Cursor;

static void put(Cursor *cursor, const void *from, size_t size)
{
    memcpy(cursor->at, from, size);
    cursor->at += size;
}

static void get(Cursor *cursor, void *to, size_t size)
{
    memcpy(to, cursor->at, size);
    cursor->at += size;
}

void state_save(const Simulation *simulation, void *bytes)
{
    Cursor cursor = {bytes};
    StateHead head;
    memset(&head, 0, sizeof head); /* padding too: equal states, equal bytes */
    head.steps = simulation->steps;
    head.unconverged = simulation->unconverged;
    head.steps_before = simulation->steps_before;
    head.time_before = simulation->time_before;
    memcpy(head.work, simulation->work, sizeof head.work);
    head.first = simulation->first;
    memcpy(head.reasons, simulation->reasons, sizeof head.reasons);
    head.status = simulation->status;
    head.done = simulation->done;
    put(&cursor, &head, sizeof head);
    size_t array = array_size(simulation) * sizeof(double);
    for (int r = 0; r < simulation->runs; r++) {
        const TimeIntegrator *run = &simulation->run[r];
        RunHead own;
        memset(&own, 0, sizeof own);
        own.steps = run->steps;
        own.unconverged = run->unconverged;
        own.status = run->status;
        own.remembers = run->remembers;
        put(&cursor, &own, sizeof own);
        put(&cursor, run->x, array);
        put(&cursor, run->v, array);
        if (run->method->memory > 0)
            put(&cursor, run->memory, (size_t)run->method->memory * array);
    }
}

void state_restore(const void *bytes, Simulation *simulation)
{
    Cursor cursor = {(unsigned char *)bytes};
    StateHead head;
    get(&cursor, &head, sizeof head);
    simulation->steps = head.steps;
    simulation->unconverged = head.unconverged;
    simulation->steps_before = head.steps_before;
    simulation->time_before = head.time_before;
    memcpy(simulation->work, head.work, sizeof head.work);
    simulation->first = head.first;
    memcpy(simulation->reasons, head.reasons, sizeof head.reasons);
    simulation->status = head.status;
    simulation->done = head.done;
    size_t array = array_size(simulation) * sizeof(double);
    for (int r = 0; r < simulation->runs; r++) {
        TimeIntegrator *run = &simulation->run[r];
        RunHead own;
        get(&cursor, &own, sizeof own);
        run->steps = own.steps;
        run->unconverged = own.unconverged;
        run->status = own.status;
        run->remembers = own.remembers;
        get(&cursor, run->x, array);
        get(&cursor, run->v, array);
        if (run->method->memory > 0)
            get(&cursor, run->memory, (size_t)run->method->memory * array);
        if (run->newton)
            newton_forget(run->newton);
    }
}

/* FNV-1a over these bytes. */
static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ at[i]) * UINT64_C(1099511628211);
    return hash;
}

uint64_t state_hash(const Simulation *simulation, uint64_t seed)
{
    size_t array = array_size(simulation) * sizeof(double);
    int64_t steps = simulation->steps;
    uint64_t hash = hash_bytes(seed, &steps, sizeof steps);
    for (int r = 0; r < simulation->runs; r++) {
        hash = hash_bytes(hash, simulation->run[r].x, array);
        hash = hash_bytes(hash, simulation->run[r].v, array);
    }
    return hash;
}
