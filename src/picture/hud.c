#include "picture/hud.h"

#include <math.h>

#include "scenes/scene.h"

/* What one sees at the start. */
void hud_create(Hud *hud)
{
    *hud = (Hud){.text = true};
    hud_restart(hud);
}

/* Numbers of the run. */
void hud_restart(Hud *hud)
{
    hud_begin_step(hud);
    hud->stepped = false;
    hud->trouble_step = 0;
    hud->note[0] = '\0';
    hud->energies = (Energies){0};
    hud->history.series = 3;
    history_clear(&hud->history);
    trail_clear(&hud->trail);
}

/* Sums over the updates of a step start here. */
void hud_begin_step(Hud *hud)
{
    hud->stepped = true;
    hud->trouble = STATUS_OK;
    hud->iterations = 0;
    hud->trials = 0;
    hud->projected = 0;
    hud->alpha = 1;
    hud->slope = 0;
}

/* One more update. */
void hud_add_update(Hud *hud, const NewtonRecord *record)
{
    if (record->iteration < 0)
        return;
    hud->iterations++;
    hud->trials += record->trials;
    if (record->projected > hud->projected)
        hud->projected = record->projected;
    hud->alpha = fmin(hud->alpha, record->alpha);
    hud->slope = record->slope;
}

/* Remembers what went wrong; an interrupted step is no trouble. */
void hud_end_step(Hud *hud, const Simulation *simulation)
{
    Status status = simulation->status;
    if (!status || status == STATUS_INTERRUPTED)
        return;
    hud->trouble = status;
    hud->trouble_step = simulation->steps;
    if (!status_is_unconverged(status))
        hud->trouble_step++;
}

/* Energies of run 0. */
static void sample_energies(Hud *hud, const Simulation *simulation)
{
    hud->energies = simulation_energies(simulation, 0);
    const double value[HISTORY_SERIES] = {
        hud->energies.total, hud->energies.kinetic, hud->energies.elastic};
    history_add(&hud->history, simulation_time(simulation), value);
}

/* Position and radius of node 0 in each run. */
static void sample_circle(Hud *hud, const Simulation *simulation)
{
    double value[HISTORY_SERIES] = {0}, point[2 * TRAIL_RUNS] = {0};
    for (int r = 0; r < simulation->runs; r++) {
        const double *x = simulation->run[r].x;
        value[r] = hypot(x[0], x[1]);
        point[2 * r] = x[0];
        point[2 * r + 1] = x[1];
    }
    history_add(&hud->history, simulation_time(simulation), value);
    trail_add(&hud->trail, simulation->runs, point);
}

/* By what the picture of the scene shows. */
void hud_sample(Hud *hud, const Simulation *simulation)
{
    PictureKind picture = simulation->scene->picture;
    if (picture == PICTURE_SQUARE && hud->text)
        sample_energies(hud, simulation);
    if (picture == PICTURE_CIRCLE)
        sample_circle(hud, simulation);
}
