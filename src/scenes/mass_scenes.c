/* mass_scenes.c - scenes of one mass: circle, arrows and spring. */
#include "scenes/small_scenes.h"

#include <math.h>
#include <string.h>

#include "model/pull_energy.h"
#include "model/spring_law.h"

/* Angular frequency in the scene `circle`, a turn per second, 1/s */
static const double CIRCLE_OMEGA = 6.283185307179586;
static const double MASS_OMEGA2 = 1; /* omega2 in the scene `arrows`, 1/s^2 */
static const double SPRING_STIFFNESS = 100; /* J/m^2 */
static const double SPRING_LENGTH = 1;      /* rest length, m */

Status create_small_system(System *system, int pins, double length,
                           double stiffness)
{
    Status status = system_create(1 + pins, pins, system);
    for (int i = 0; i <= pins && !status; i++)
        system->m[i] = SMALL_MASS;
    for (int s = 0; s < pins && !status; s++) {
        system->is_pinned[s + 1] = 1;
        system->e[2 * s + 1] = s + 1;
        system->l2[s] = length * length;
        system->k[s] = stiffness;
    }
    return status;
}

/* Creates runs of a mass with a = -omega2 x, from x with velocity v. */
static Status create_orbit(Simulation *simulation, double omega2,
                           const double x[2], const double v[2])
{
    static const char *const names[SIMULATION_MAX_RUNS] = {
        "forward-euler", "symplectic-euler", "backward-euler"};
    const Options *options = &simulation->options;
    bool chosen = options->integrator >= 0;
    Status status = create_small_system(&simulation->system, 0, 0, 0);
    if (!status)
        status = pull_configure(&simulation->system, &central_field,
                                &(NodePull){.k = SMALL_MASS * omega2});
    simulation->runs = chosen ? 1 : SIMULATION_MAX_RUNS;
    memcpy(simulation->exhibit.exact_start, x, 2 * sizeof *x);
    memcpy(simulation->exhibit.exact_start + 2, v, 2 * sizeof *v);
    for (int i = 0; i < simulation->runs && !status; i++)
        status = simulation_start_run(simulation, i,
                                      chosen ? options_get_method(options)
                                             : integrator_find_method(names[i]),
                                      &simulation->system, x, v);
    return status;
}

Status create_circle_scene(Simulation *simulation)
{
    const double x[2] = {1, 0}, v[2] = {0, CIRCLE_OMEGA};
    return create_orbit(simulation, CIRCLE_OMEGA * CIRCLE_OMEGA, x, v);
}

Status create_arrows_scene(Simulation *simulation)
{
    const double v[2] = {0, 1};
    return create_orbit(simulation, MASS_OMEGA2, simulation->options.start, v);
}

bool mass_find_next_step(const Simulation *simulation, int run, MassStep *step)
{
    const TimeIntegrator *integrator = &simulation->run[run];
    const char *name = integrator->method->name;
    bool forward = strcmp(name, "forward-euler") == 0;
    bool symplectic = strcmp(name, "symplectic-euler") == 0;
    bool backward = strcmp(name, "backward-euler") == 0;
    double h = integrator->h;
    step->uses_old_v = forward;
    for (int i = 0; i < 2; i++) {
        double x = integrator->x[i], v = integrator->v[i];
        double a = -MASS_OMEGA2 * x, new_v = v + h * a;
        if (backward) /* v' = v - h omega2 (x + h v'), solved for v' */
            new_v = new_v / (1 + h * h * MASS_OMEGA2);
        step->x[i] = x;
        step->v[i] = v;
        step->a[i] = a;
        step->new_v[i] = new_v;
        step->new_x[i] = x + h * (forward ? v : new_v);
        step->new_a[i] = -MASS_OMEGA2 * step->new_x[i];
    }
    return forward || symplectic || backward;
}

void mass_find_exact_x(const Simulation *simulation, double t, double x[2])
{
    const double *start = simulation->exhibit.exact_start,
                 omega = sqrt(MASS_OMEGA2);
    for (int i = 0; i < 2; i++)
        x[i] =
            start[i] * cos(omega * t) + start[i + 2] * sin(omega * t) / omega;
}

SpringValues spring_evaluate(const double d[2], double l2, double k)
{
    double d2 = d[0] * d[0] + d[1] * d[1], l = sqrt(l2), r = sqrt(d2);
    double s = spring_eigenvalue_across(d2, l2) / l2;
    double pull = spring_gradient_factor(k, s);
    double c = spring_hessian_factor(l2, k);
    return (SpringValues){
        .length = r,
        .strain = s,
        .energy = spring_energy(l2, k, s),
        .force = {-pull * d[0], -pull * d[1]},
        .eigenvalue_along = c * spring_eigenvalue_along(d2, l2),
        .eigenvalue_across = c * spring_eigenvalue_across(d2, l2),
        .root_energy = 2 * k * (r - l) * (r - l),
        .root_eigenvalue_along = 4 * k,
        .root_eigenvalue_across = 4 * k * (1 - l / r),
    };
}

Status create_spring_scene(Simulation *simulation)
{
    const Options *options = &simulation->options;
    System *system = &simulation->system;
    const double x[4] = {options->start[0], options->start[1], 0, 0};
    const double v[4] = {0};
    Status status =
        create_small_system(system, 1, SPRING_LENGTH, SPRING_STIFFNESS);
    simulation->runs = 1;
    return status ? status
                  : simulation_start_run(simulation, 0,
                                         options_get_method(options), system, x,
                                         v);
}
