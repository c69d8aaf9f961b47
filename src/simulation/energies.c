/* energies.c - computes the energies of a run and their balance. */
#include <string.h>

#include "simulation/simulation.h"

/* Adds a value, J, to the row with this name; a missing row is created. */
static void add_energy(Energies *energies, const char *name, double value)
{
    int i = 0;
    while (i < energies->count && strcmp(energies->energy[i].name, name) != 0)
        i++;
    if (i == energies->count)
        energies->energy[energies->count++] = (Energy){name, 0};
    energies->energy[i].value += value;
}

Energies simulation_get_energies(const Simulation *simulation, int run)
{
    const TimeIntegrator *integrator = &simulation->run[run];
    const System *system = integrator->system;
    const double *x = integrator->x;
    Energies energies = {
        .kinetic = system_kinetic_energy(system, integrator->v),
        .gravity = system_gravity_potential(system, x),
        .work = simulation->ledger[run].user_work + integrator->external_work};
    double lost = 0;
    energies.total = energies.kinetic + energies.gravity;
    add_energy(&energies, "total", 0);
    add_energy(&energies, "kinetic", energies.kinetic);
    EvalPoint at = make_eval_point(system, NULL, NULL, x);
    for (const TermKind *kind; (kind = eval_point_next_term(&at));) {
        double value = kind->energy_name ? kind->potential(&at) : 0;
        energies.total += value;
        if (kind->energy_name)
            add_energy(&energies, kind->energy_name, value);
    }
    add_energy(&energies, "gravity", energies.gravity);
    for (int t = 0; t < system->term_count; t++)
        if (system->term[t].kind->loss_name)
            add_energy(&energies, system->term[t].kind->loss_name, 0);
    for (int i = 0; i < SYSTEM_MAX_TERMS && system->losses[i].name; i++) {
        add_energy(&energies, system->losses[i].name, system->losses[i].energy);
        lost += system->losses[i].energy;
    }
    energies.energy[0].value = energies.total;
    energies.dissipated = simulation->ledger[run].start_energy + energies.work -
                          energies.total - lost;
    add_energy(&energies, "work", energies.work);
    add_energy(&energies, "dissipated", energies.dissipated);
    return energies;
}
