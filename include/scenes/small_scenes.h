/* small_scenes.h - the lecture's small scenes: one mass, one unknown, one
 * spring, the square a hundred times.
 *
 * circle, arrows: a mass of 1 kg with a = -omega2 x.
 * overshoot: f(x) = ln(e^x + e^-x), whose minimum is at 0.
 * tangent: one mass on one spring along a line, the other end held at 0:
 *   E(x) = m/2 (x - x_tilde)^2 + h^2 l2 k/2 (x^2/l2 - 1)^2
 * landscape: one free node between two pinned ones, too close for its springs:
 * where these are short E is not convex.  dial: the minimiser of the same E for
 * every h; at h = 0 it is x_tilde.
 * spring: P(d) = l2 k/2 (|d|^2/l2 - 1)^2, and beside it the energy with a
 * square root that is as stiff at rest, P_root(d) = 2k (|d| - l)^2. race: the
 * stretched square by several methods with several time steps; every run is a
 * point, its run time and its error against velocity Verlet with a 64 times
 * finer step.  envelope: the square with every time step and stiffness.
 *
 * What they keep beside the states of their runs is in run/exhibit.h.
 */
#ifndef ELASTO_SMALL_SCENES_H
#define ELASTO_SMALL_SCENES_H

#include "run/simulation.h"

/* Notes the guess that the next step leads to (x, y), m: on the dial the end of
 * the longest step.  Does nothing where a scene has no single point or has
 * ended. */
void scene_predict(Simulation *simulation, double x, double y);

/* ---- one mass, one spring ------------------------------------------------ */

/* Node 0 is free; each of the others is held and has a spring to it.  kg, m,
 * J/m^2.  Returns as system_create. */
Status small_system(System *system, int held, double mass, double length,
                    double stiffness);

/* Run 0 forward, 1 symplectic, 2 backward Euler; with --integrator that one. */
Status create_circle(Simulation *simulation);
Status create_mass(Simulation *simulation);

/* Node 0 is free, node 1 held at the origin; l = 1 m, k = 100 J/m^2, 1 kg. */
Status create_spring(Simulation *simulation);

/* A step of arrows, omega2 = 1/s^2: of t_n, and of t_n + h with new_.
 *   forward     x' = x + h v     v' = v + h a(x)
 *   symplectic  v' = v + h a(x)  x' = x + h v'
 *   backward    v' = v + h a(x') x' = x + h v' */
typedef struct MassStep {
    double x[2], v[2], a[2];             /* m, m/s, m/s^2 */
    double new_x[2], new_v[2], new_a[2]; /* the same after the step */
    bool by_old_v;                       /* x' = x + h v, not x + h v' */
} MassStep;

/* The step that a run makes next.  Returns false where its method is none of
 * the three. */
bool mass_next_step(const Simulation *simulation, int run, MassStep *step);

/* Where the mass would be without a method t seconds after it began, or was
 * dragged: out, m. */
void mass_exact(const Simulation *simulation, double t, double x[2]);

typedef struct SpringFacts {
    double length;      /* |d|, m */
    double strain;      /* |d|^2/l2 - 1 */
    double energy;      /* P, J */
    double force[2];    /* -grad P on the free end, N */
    double along;       /* eigenvalue of its 2x2 Hessian along d, J/m^2 */
    double across;      /* and across */
    double root_energy; /* P_root, J */
    double root_along, root_across; /* -infinity across at |d| = 0 */
} SpringFacts;

/* d [2] m; l2 m^2; k J/m^2 */
SpringFacts spring_facts(const double d[2], double l2, double k);

/* ---- descents: a minimum that Newton looks for, update by update --------- */

/* Of one unknown: node 0 is the point (x, E(x)).  Of two: node 0 is free, nodes
 * 1 and 2 are pinned. */
Status create_overshoot(Simulation *simulation);
Status create_tangent(Simulation *simulation);
Status create_landscape(Simulation *simulation);

/* One Newton update (Algorithm 1), with projection (Algorithm 3, line 3) and
 * line search (Algorithm 2) as the options say.  The loop tests |g| in one
 * unknown and without both, else |p|/h. */
Status step_descent(Simulation *simulation);

/* The direction from the present iterate, as the methods now want it; and the
 * search anew, from there. */
void aim_descent(Simulation *simulation);
void descent_restart(Simulation *simulation);

/* What is minimised there, of the parts on the map. */
Local descent_at(const Simulation *simulation, Projection projection, double x,
                 double y);

/* p = -H^-1 g from x [2] with this projection, m, whatever the run's own
 * projection is.  Returns grad E . p, J s^2, NaN where H has no inverse. */
double descent_direction(const Simulation *simulation, Projection projection,
                         const double *x, double p[2]);

/* In how many directions it bends down there, or does not bend: 0 where the
 * Hessian, not projected, is positive definite (Newton's direction is downhill
 * with and without projection), 1 as at a saddle, 2 as at a maximum. */
int descent_bends_down(const Simulation *simulation, double x, double y);

/* Their value with the h of the run, J s^2. */
double landscape_part_value(const Simulation *simulation, unsigned parts,
                            double x, double y);

/* Turns the dial: h times 10^(1/10), up to 10 s; node 0 is the minimiser. */
Status create_dial(Simulation *simulation);
Status step_dial(Simulation *simulation);
void dial_restart(Simulation *simulation);

/* ---- run time against error ---------------------------------------------- */

/* The motion of run 0, exact up to rounding after so many seconds: sets run 1
 * to its end.  Only for springs alone.  STATUS_NOT_FINITE: the motion is too
 * fast, or it explodes. */
Status race_reference(Simulation *simulation, double time);

/* Measures how long a method takes from run 0 to run 1 in so many steps, and
 * how far from run 1 it ends.  run: where it has come, in/out; the caller frees
 * it.  point out.  A status that is not OK: no run came to the end. */
Status race_measure(Simulation *simulation, const IntegratorMethod *method,
                    double time, long steps, TimeIntegrator *run,
                    RacePoint *point);

/* Stretch 1.1, where the motion is no chaos. */
Status create_race(Simulation *simulation);

/* One run more, up to all of them.  The methods take turns, each from its
 * longest time step to its shortest. */
Status step_race(Simulation *simulation);

/* The longest time step with which a method is stable in the runs so far, s;
 * NaN: not known. */
double race_stable(const Race *race, int method);

/* The method of column i, 0 ... RACE_METHODS - 1. */
const IntegratorMethod *race_method(int i);

/* ---- how far the solver can be trusted ----------------------------------- */

/* s, of a column; J/m^2, of a row */
double envelope_timestep(int column);
double envelope_stiffness(int row);

/* Run 0 is the cell that is shown; at first the one nearest to the options. */
Status create_envelope(Simulation *simulation);

/* The next row, from the softest to the stiffest. */
Status step_envelope(Simulation *simulation);

/* Runs one cell and shows it: run 0 is then its run.  Returns OK also where the
 * cell's steps did not converge; OUT_OF_MEMORY. */
Status envelope_visit(Simulation *simulation, int column, int row);

#endif
