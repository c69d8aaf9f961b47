/* modes.c - the fastest small oscillation around a place: M q'' = -H q. */
#include <math.h>
#include <string.h>

#include "scenes/simulation.h"

/* Paces of the power iteration, and numbers that it has room for. */
enum { PACES = 1200, ROOM = 2 * SIMULATION_MODE_NODES };

/* M^-1 H q, out; H of the system at x, 1/s^2 */
static void pull(const System *system, const double *x, const double *q,
                 double *out)
{
    Place at = place_at(system, NULL, NULL, x);
    memset(out, 0, 2 * (size_t)system->nodes * sizeof *out);
    for (const TermKind *kind; (kind = next_energy(&at)) != NULL;)
        if (kind->hessian)
            kind->hessian(&at, FILTER_NONE, NULL, q, out);
    for (int i = 0; i < 2 * system->nodes; i++)
        out[i] /= system->m[i / 2];
    system_clear_pinned(system, out);
}

double simulation_fastest(const Simulation *simulation, const double *x,
                          double *mode)
{
    double pulled[ROOM], omega2 = NAN;
    int n = 2 * simulation->system.nodes;
    if (n > ROOM)
        return NAN;
    for (int i = 0; i < n; i++) /* no symmetry: in it all modes have a part */
        mode[i] = sin(1 + i + 0.1 * i * i);
    for (int pace = 0; pace < PACES; pace++) {
        double size = 0;
        for (int i = 0; i < n; i++)
            size += mode[i] * mode[i];
        for (int i = 0; i < n; i++)
            mode[i] /= sqrt(size);
        pull(&simulation->system, x, mode, pulled);
        omega2 = 0;
        for (int i = 0; i < n; i++)
            omega2 += mode[i] * pulled[i];
        for (int i = 0; i < n && pace + 1 < PACES; i++)
            mode[i] = pulled[i];
    }
    return omega2 > 0 ? sqrt(omega2) : NAN;
}
