/* Where the default square converges: time step by stiffness by stretch. */
#include "stress.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

double envelope_h(int i)
{
    return pow(10, 0.5 * i - 9);
}

double envelope_k(int i)
{
    return pow(10, i - 6);
}

double envelope_stretch(int i)
{
    static const double stretch[ENVELOPE_STRETCH] = {1e-6, 1e-3, 0.1, 0.5,
                                                     1.4,  10,   1e3, 1e6};
    return stretch[i];
}

char envelope_cell(Solver solver, int stretch, int k, int h, Tally *tally,
                   char *reason)
{
    char line[160];
    Case c = {.tally = tally, .reason = reason};
    Status status = STATUS_OK;
    snprintf(line, sizeof line,
             "--solver %s --stretch %g --stiffness %g --timestep %.17g",
             solver_name(solver), envelope_stretch(stretch), envelope_k(k),
             envelope_h(h));
    if (case_open(&c, line))
        for (int step = 0; step < 3 && case_steps(&c, 1); step++)
            status = c.watch.status ? c.watch.status : status;
    bool undone = c.run && c.run->newton->counters.iterations == 0;
    if (case_close(&c))
        return status ? 'r' : undone ? 'n' : 'c';
    size_t used = strlen(reason);
    snprintf(reason + used, 512 - used, " (%s)", line);
    return 'w';
}

double envelope_share(const Envelope *envelope, Solver solver)
{
    int cells = 0, converged = 0;
    for (int s = 0; s < ENVELOPE_STRETCH; s++)
        for (int k = 0; k < ENVELOPE_K && envelope_stretch(s) >= 0.1; k++)
            for (int h = 0; h < ENVELOPE_H; h++) {
                cells += envelope->verdict[solver][s][k][h] != 'n';
                converged += envelope->verdict[solver][s][k][h] == 'c';
            }
    return (double)converged / cells;
}
