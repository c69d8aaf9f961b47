/* exhibit.c - drags points and turns switches of the lecture's small scenes. */
#include <math.h>
#include <string.h>

#include "simulation/simulation.h"

int exhibit_list_handles(const Simulation *simulation,
                         double at[SCENE_MAX_HANDLES][2])
{
    const TimeIntegrator *run = &simulation->run[0];
    const char *kind = simulation->scene->handle_kinds;
    int count = 0;
    for (; kind && kind[count]; count++)
        for (int k = 0; k < 2; k++)
            at[count][k] = kind[count] == 't'   ? simulation->exhibit.x_tilde[k]
                           : kind[count] == 'v' ? run->x[k] + run->v[k]
                                                : run->x[k];
    return count;
}

/* Dragging x moves the mass; the velocity stays, or becomes 0 in scenes with
 * springs.  Dragging v sets the velocity.  Each run begins again from there. */
void exhibit_drag_handle(Simulation *simulation, int handle, double x, double y)
{
    const Scene *scene = simulation->scene;
    TimeIntegrator *run = simulation->run;
    double *start = simulation->exhibit.exact_start; /* x and v */
    char kind = scene->handle_kinds[handle];
    const double to[2] = {x, scene->traits & HAS_ONE_COORDINATE ? 0 : y};
    if (!isfinite(to[0]) || !isfinite(to[1]))
        return;
    simulation->prediction = (UserPrediction){0};
    if (!(scene->traits & HAS_TIME)) {
        memcpy(kind == 't' ? simulation->exhibit.x_tilde : run->x, to,
               sizeof to);
        scene->after_drag(simulation);
        return;
    }
    for (int k = 0; k < 2; k++) {
        double v = simulation->system.springs ? 0 : run->v[k];
        start[k] = kind == 'v' ? run->x[k] : to[k];
        start[k + 2] = kind == 'v' ? to[k] - run->x[k] : v;
    }
    for (int r = 0; r < simulation->runs; r++) {
        memcpy(run[r].x, start, 2 * sizeof *start);
        memcpy(run[r].v, start + 2, 2 * sizeof *start);
        run[r].history_h = 0;
    }
}

/* The mesh lists its springs in this order: n (n + 1) horizontal springs, as
 * many vertical ones, and two diagonals for each cell. */
int exhibit_find_spring_kind(const Simulation *simulation, int spring)
{
    int n = simulation->system.segments, half = n * (n + 1);
    return spring < half ? 0 : spring < 2 * half ? 1 : 2 + spring % 2;
}

int exhibit_list_switches(const Simulation *simulation,
                          SceneSwitch out[SCENE_MAX_SWITCHES])
{
    static const char *const kinds[SCENE_MAX_SWITCHES] = {
        "horizontal", "vertical", "diagonal /", "diagonal \\"};
    bool has_kinds = simulation->options.layers & LAYER_SPRING_KINDS;
    const char *const *label =
        has_kinds ? kinds : simulation->scene->switch_labels;
    const Options *options = &simulation->options;
    /* On pages where the key N shortens a spring (NEXT_SHORTENS_SPRING),
     * switches are listed only if the page's option `flips` is not 0. */
    bool none = options->next_action == NEXT_SHORTENS_SPRING && !options->flips;
    int count = 0;
    for (; !none && count < SCENE_MAX_SWITCHES && label[count]; count++)
        out[count] =
            (SceneSwitch){label[count], (simulation->exhibit.switches >> count &
                                         1) != has_kinds};
    return count;
}

unsigned exhibit_get_flip_bits(const Simulation *simulation)
{
    unsigned at_start = simulation->scene->switch_labels[1] ? PART_BOTH : 0;
    return simulation->exhibit.switches ^ at_start;
}

/* The energy of switched springs is booked as work.  At least one part of E
 * stays on.  A switch changes E, so the updates so far are no longer shown. */
void exhibit_flip_switch(Simulation *simulation, int number)
{
    const Scene *scene = simulation->scene;
    System *system = &simulation->system;
    unsigned switches = simulation->exhibit.switches ^ (1U << number);
    if (simulation->options.layers & LAYER_SPRING_KINDS) {
        double k = switches >> number & 1 ? 0 : simulation->options.stiffness;
        double before = simulation_get_energies(simulation, 0).total;
        simulation->exhibit.switches = switches;
        for (int s = 0; s < system->springs; s++)
            if (exhibit_find_spring_kind(simulation, s) == number)
                system->k[s] = k;
        system_mark_changed(system, false);
        simulation->run[0].history_h = 0; /* history of the method is invalid */
        simulation->ledger[0].user_work +=
            simulation_get_energies(simulation, 0).total - before;
        return;
    }
    bool none = switches == 0 && scene->switch_labels[1];
    simulation->exhibit.switches = none ? PART_BOTH ^ (1U << number) : switches;
    simulation->descent.record_count = 0;
    simulation->prediction = (UserPrediction){0};
    if (scene->update_direction)
        scene->update_direction(simulation);
}
