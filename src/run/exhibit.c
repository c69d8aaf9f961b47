/* exhibit.c - moves points and turns switches of the lecture's small scenes. */
#include <math.h>
#include <string.h>

#include "run/simulation.h"

int exhibit_handles(const Simulation *simulation,
                    double at[SCENE_MAX_HANDLES][2])
{
    const TimeIntegrator *run = &simulation->run[0];
    const char *grip = simulation->scene->grips;
    int count = 0;
    for (; grip && grip[count]; count++)
        for (int k = 0; k < 2; k++)
            at[count][k] = grip[count] == 't'   ? simulation->exhibit.target[k]
                           : grip[count] == 'v' ? run->x[k] + run->v[k]
                                                : run->x[k];
    return count;
}

/* Dragging x moves the mass, which keeps its velocity, or on a spring loses it;
 * dragging v sets the velocity.  Each run begins again from there. */
void exhibit_drag(Simulation *simulation, int handle, double x, double y)
{
    const Scene *scene = simulation->scene;
    TimeIntegrator *run = simulation->run;
    double *began = simulation->exhibit.began; /* x and v */
    char grip = scene->grips[handle];
    bool line = scene->needs & NEEDS_ONE_NUMBER; /* y is ignored */
    const double to[2] = {x, line ? 0 : y};
    if (!isfinite(to[0]) || !isfinite(to[1]))
        return;
    simulation->prediction = (Prediction){0};
    if (!(scene->needs & NEEDS_TIME)) {
        memcpy(grip == 't' ? simulation->exhibit.target : run->x, to,
               sizeof to);
        scene->restart(simulation);
        return;
    }
    for (int k = 0; k < 2; k++) {
        double v = simulation->system.springs ? 0 : run->v[k];
        began[k] = grip == 'v' ? run->x[k] : to[k];
        began[k + 2] = grip == 'v' ? to[k] - run->x[k] : v;
    }
    for (int r = 0; r < simulation->runs; r++) {
        memcpy(run[r].x, began, 2 * sizeof *began);
        memcpy(run[r].v, began + 2, 2 * sizeof *began);
        run[r].memory_h = 0;
    }
}

bool exhibit_has_kinds(const Simulation *simulation)
{
    return simulation->options.layers & LAYER_KINDS;
}

/* The order of the mesh: n (n + 1) horizontal springs, as many vertical ones,
 * and two diagonals for each cell. */
int exhibit_kind(const Simulation *simulation, int spring)
{
    int n = simulation->system.segments, half = n * (n + 1);
    return spring < half ? 0 : spring < 2 * half ? 1 : 2 + spring % 2;
}

/* Lists the switches of the scene and whether each is on.  For kinds of springs
 * a bit of `parts` is 1 if the kind is off; elsewhere 1 means on. */
int exhibit_switches(const Simulation *simulation,
                     Switch out[SCENE_MAX_SWITCHES])
{
    static const char *const kinds[SCENE_MAX_SWITCHES] = {
        "horizontal", "vertical", "diagonal /", "diagonal \\"};
    bool has_kinds = exhibit_has_kinds(simulation);
    const char *const *part = has_kinds ? kinds : simulation->scene->parts;
    const Options *options = &simulation->options;
    bool none = options->next == NEXT_NEARER && !options->flips; /* alone */
    int count = 0;
    for (; !none && count < SCENE_MAX_SWITCHES && part[count]; count++)
        out[count] = (Switch){
            part[count], (simulation->exhibit.parts >> count & 1) != has_kinds};
    return count;
}

unsigned exhibit_flips(const Simulation *simulation)
{
    unsigned begins = simulation->scene->parts[1] ? PART_BOTH : 0;
    return simulation->exhibit.parts ^ begins;
}

/* The energy that a kind of springs takes away is booked as work.  At least one
 * part of E stays on.  A switch changes the function that is minimised, so the
 * updates so far are no longer shown. */
void exhibit_flip(Simulation *simulation, int number)
{
    const Scene *scene = simulation->scene;
    System *system = &simulation->system;
    unsigned parts = simulation->exhibit.parts ^ (1U << number);
    if (exhibit_has_kinds(simulation)) {
        double k = parts >> number & 1 ? 0 : simulation->options.stiffness;
        double before = simulation_energies(simulation, 0).total;
        simulation->exhibit.parts = parts;
        for (int s = 0; s < system->springs; s++)
            if (exhibit_kind(simulation, s) == number)
                system->k[s] = k;
        system_mark_changed(system, false);
        simulation->ledger[0].work +=
            simulation_energies(simulation, 0).total - before;
        return;
    }
    bool none = parts == 0 && scene->parts[1];
    simulation->exhibit.parts = none ? PART_BOTH ^ (1U << number) : parts;
    simulation->descent.count = 0;
    simulation->prediction = (Prediction){0};
    if (scene->aim)
        scene->aim(simulation);
}
