/* turn.c - turns free bodies to the angle at which E is lowest. */
#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "solve/newton_parts.h"

bool next_direction_may_turn(const Newton *newton)
{
    const Iterate *at = &newton->iterate;
    double torque = 0;
    for (int i = 0; i < newton->system->nodes; i++) {
        const double *p = at->p + 2 * i, *g = at->g + 2 * i;
        torque +=
            sqrt(p[0] * p[0] + p[1] * p[1]) * sqrt(g[0] * g[0] + g[1] * g[1]);
    }
    return torque > newton->tolerance * newton->settings.h *
                        newton->rounding.min_mass *
                        newton->rounding.shortest_spring;
}

double turn_free_body(Newton *newton)
{
    const System *system = newton->system;
    const int size = 2 * system->nodes;
    const double *m = system->m, *u_tilde = newton->u_tilde;
    double *u = newton->iterate.u, *x = newton->iterate.x;
    double mass = 0, centre[2] = {0}, moved[2] = {0}, along = 0, across = 0;
    int pivot;
    bool turns = newton->rounding.is_stiff ||
                 (newton->meets_tolerance && next_direction_may_turn(newton));
    if (!turns || !system_turns_freely(system, &pivot))
        return 0;
    for (int i = 0; i < size; i++) {
        mass += 0.5 * m[i / 2];
        centre[i % 2] += m[i / 2] * x[i];
        moved[i % 2] += m[i / 2] * (u_tilde[i] - u[i]);
    }
    for (int c = 0; c < 2; c++) {
        centre[c] = pivot < 0 ? centre[c] / mass : x[2 * pivot + c];
        moved[c] = pivot < 0 ? moved[c] / mass : 0;
    }
    /* From the centre, d leads to x, d + b to x_tilde moved to this centre. */
    for (int i = 0; i < size; i += 2) {
        double dx = x[i] - centre[0], dy = x[i + 1] - centre[1];
        double bx = u_tilde[i] - u[i] - moved[0];
        double by = u_tilde[i + 1] - u[i + 1] - moved[1];
        along += m[i / 2] * (dx * (dx + bx) + dy * (dy + by));
        across += m[i / 2] * (dx * by - dy * bx);
    }
    double both = math_hypot(along, across);
    double change =
        along > 0 ? -across * across / (both + along) : along - both;
    if (!(change < 0))
        return 0;
    double sine = across / both, cosine_less_1 = change / both;
    double *new_u = newton->factored_hessian.r,
           *new_x = newton->factored_hessian.b;
    for (int i = 0; i < size; i++) {
        int other = i ^ 1;
        double arm = x[i] - centre[i % 2], side = x[other] - centre[other % 2];
        new_u[i] = u[i] + cosine_less_1 * arm + (i % 2 ? sine : -sine) * side;
        new_x[i] = newton->iterate.E.x_n[i] + new_u[i];
    }
    if (!incremental_potential_is_feasible(&newton->iterate.E, new_u, new_x))
        return 0; /* rounding made the turned body infeasible */
    memcpy(u, new_u, (size_t)size * sizeof *u);
    memcpy(x, new_x, (size_t)size * sizeof *x);
    newton->has_gradient = false;
    newton->factored_hessian.moved_since_factor = INFINITY;
    newton->rounding.E = NAN;
    return change;
}
