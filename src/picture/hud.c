#include "picture/hud.h"

#include <math.h>

#include "picture/show.h"

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

/* What the picture of the scene keeps. */
void hud_sample(Hud *hud, const Simulation *simulation)
{
    show_sample(simulation, &hud->history, &hud->trail);
}
