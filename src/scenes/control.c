#include "scenes/control.h"

#include <stdlib.h>
#include <string.h>

#include "model/pull_energy.h"

/* With room for this many pins. */
static Control *make_control(int pins)
{
    Control *control =
        calloc(1, sizeof *control + (size_t)pins * sizeof *control->pin);
    if (control)
        control->users = 1;
    return control;
}

Control *control_of(const Simulation *simulation)
{
    int nodes = simulation->system.nodes;
    Control *control = make_control(nodes);
    if (!control)
        return NULL;
    control->options = simulation->options;
    control->hand = -1;
    for (int i = 0; i < nodes; i++)
        if (simulation_is_pinned(simulation, i))
            control->pin[control->pins++] = i;
    return control;
}

Control *control_copy(const Control *from)
{
    Control *control = make_control(from->pins + 1);
    if (!control)
        return NULL;
    memcpy(control, from,
           sizeof *from + (size_t)from->pins * sizeof *from->pin);
    control->users = 1;
    return control;
}

void control_pin(Control *control, int node, bool pinned)
{
    int at = 0;
    while (at < control->pins && control->pin[at] < node)
        at++;
    int *pin = control->pin + at, behind = control->pins - at;
    bool had = behind > 0 && *pin == node;
    if (had == pinned)
        return;
    memmove(pin + pinned, pin + had, (size_t)(behind - had) * sizeof *pin);
    if (pinned)
        *pin = node;
    control->pins += pinned - had;
}

void obstacle_move(Options *options, int number, double x, double y)
{
    int ball = number - (int)options->grounds;
    double *at = ball < 0 ? options->ground[number] + 2 : options->ball[ball];
    at[0] = x;
    at[1] = y;
}

const Control *control_keep(const Control *control)
{
    if (control)
        ((Control *)control)->users++;
    return control;
}

void control_drop(const Control *control)
{
    Control *own = (Control *)control;
    if (own && --own->users == 0)
        free(own);
}

/* The hand, where it is not already. */
static Status use_hand(Simulation *simulation, const Control *control)
{
    const Pull *hand = hand_energy_of(&simulation->system);
    if (control->hand < 0) {
        simulation_release(simulation);
        return STATUS_OK;
    }
    if (hand && hand->node == control->hand &&
        hand->mouse[0] == control->at[0] && hand->mouse[1] == control->at[1])
        return STATUS_OK;
    return simulation_grab(simulation, control->hand, control->at[0],
                           control->at[1]);
}

Status simulation_use(Simulation *simulation, const Control *control)
{
    Status status = simulation_change(simulation, &control->options);
    for (int i = 0, at = 0; i < simulation->system.nodes && !status; i++) {
        bool pinned = at < control->pins && control->pin[at] == i;
        at += pinned;
        if (simulation_is_pinned(simulation, i) != pinned)
            status = simulation_pin(simulation, i, pinned);
    }
    return status ? status : use_hand(simulation, control);
}
