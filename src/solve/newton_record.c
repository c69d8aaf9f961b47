#include "solve/newton_record.h"

Status newton_tell(Newton *newton, const NewtonRecord *record)
{
    const NewtonSettings *settings = &newton->settings;
    if (settings->observer && !settings->observer(settings->user, record))
        return STATUS_INTERRUPTED;
    return record->status;
}

void newton_counters_add(const NewtonCounters *counters, NewtonCounters *sum)
{
    sum->minimisations += counters->minimisations;
    sum->iterations += counters->iterations;
    sum->gradients += counters->gradients;
    sum->factorisations += counters->factorisations;
    sum->solves += counters->solves;
    sum->projected += counters->projected;
    sum->trials += counters->trials;
    sum->shifted += counters->shifted;
    sum->skipped += counters->skipped;
    sum->certified += counters->certified;
    sum->cycles += counters->cycles;
    sum->local += counters->local;
    sum->saddles += counters->saddles;
    sum->taken_back += counters->taken_back;
    sum->seconds_assembly += counters->seconds_assembly;
    sum->seconds_factor += counters->seconds_factor;
    sum->seconds_solve += counters->seconds_solve;
    sum->seconds_search += counters->seconds_search;
    sum->seconds_multigrid += counters->seconds_multigrid;
}
