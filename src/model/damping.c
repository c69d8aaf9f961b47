/* damping.c - Kelvin-Voigt damping of the springs. */
#include "model/damping.h"

#include <string.h>

#include "model/mass_spring_energy.h"

/* Computes k' and l2' for the step from x_n.  A broken spring keeps k' = 0. */
static Status damping_begin_step(const TermStep *step)
{
    System *system = step->system;
    Damping *data = step->term->data;
    double theta = data->theta = data->eta / step->h;
    for (int s = 0; s < system->springs; s++) {
        double d[2], l2 = system->l2[s];
        double d2 = spring_vector(system->e + 2 * s, step->x, d);
        data->E_n[s] = spring_strain(d2, l2);
        data->l2[s] = theta > 0 ? (l2 + theta * d2) / (1 + theta) : l2;
        data->k[s] = system->k[s] * (1 + theta) * (data->l2[s] / l2);
    }
    system_mark_changed(system, false);
    return STATUS_OK;
}

static void damping_end_step(const TermStep *step)
{
    System *system = step->system;
    const Damping *data = step->term->data;
    double sum = 0, d[2];
    for (int s = 0; s < system->springs; s++) {
        double l2 = system->l2[s];
        double d2 = spring_vector(system->e + 2 * s, step->x, d);
        double change = spring_strain(d2, l2) - data->E_n[s];
        sum += system->k[s] * l2 * data->theta * change * change;
    }
    system_add_loss(system, &damping, sum);
}

static Status damping_configure(System *system, const struct SquareMesh *mesh,
                                const double *number)
{
    size_t springs = (size_t)system->springs;
    (void)mesh;
    Damping *data = system_add_term(
        system, &damping, sizeof *data + 3 * springs * sizeof(double));
    if (!data)
        return STATUS_OUT_OF_MEMORY;
    data->eta = number[0];
    if (data->E_n)
        return STATUS_OK;
    data->E_n = (double *)(data + 1);
    data->k = data->E_n + springs;
    data->l2 = data->k + springs;
    memcpy(data->k, system->k, springs * sizeof *data->k);
    memcpy(data->l2, system->l2, springs * sizeof *data->l2);
    return STATUS_OK;
}

const TermKind damping = {
    .name = "damping",
    .configure = damping_configure,
    .loss_name = "damping",
    .rank = RANK_DAMPING,
    .begin_step = damping_begin_step,
    .end_step = damping_end_step,
};
