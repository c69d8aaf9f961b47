/* mass_scene.h - one mass and one step of each Euler method (slides: forward,
 * symplectic and implicit Euler).
 *
 * A mass of 1 kg hangs on a spring of rest length 0 to the origin: a = -x
 * (omega = 1/s).  From (1, 0) m with 1 m/s upwards its path is the unit circle,
 * from x0 with v0 the ellipse x0 cos t + v0 sin t.
 *   forward     x' = x + h v     v' = v + h a(x)
 *   symplectic  v' = v + h a(x)  x' = x + h v'
 *   backward    v' = v + h a(x') x' = x + h v'
 */
#ifndef ELASTO_MASS_SCENE_H
#define ELASTO_MASS_SCENE_H

#include "scenes/scene.h"

/* a = -MASS_OMEGA2 x, 1/s^2 */
#define MASS_OMEGA2 1.0

/* A step as its arrows: of t_n, and of t_n + h with a dash. */
typedef struct MassStep {
    double x[2], v[2], a[2];             /* m, m/s, m/s^2 */
    double new_x[2], new_v[2], new_a[2]; /* the same after the step */
    bool by_old_v;                       /* x' = x + h v, not x + h v' */
} MassStep;

/* h = 0.5 s, start at (1, 0) m. */
void mass_defaults(Options *options);

/* Run 0 forward, 1 symplectic, 2 backward Euler; with --integrator that one. */
Status create_mass(Simulation *simulation, const NewtonSettings *settings);

/* The step that a run makes next.  Returns false where its method is none of
 * the three. */
bool mass_next_step(const Simulation *simulation, int run, MassStep *step);

/* Where the mass would be without a method t seconds after it began, or was
 * dragged: out, m. */
void mass_exact(const Simulation *simulation, double t, double x[2]);

/* Handle 0 is the mass, handle 1 the tip of v: all runs begin anew there. */
int mass_handles(const Simulation *simulation, double at[SCENE_MAX_HANDLES][2]);
void mass_drag(Simulation *simulation, int handle, double x, double y);

#endif
