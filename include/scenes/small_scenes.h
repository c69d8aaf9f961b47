/* small_scenes.h - the lecture's small scenes, with one mass, one unknown, one
 * spring, or many runs of the square.
 *
 * circle, arrows: a mass of 1 kg with a = -omega2 x.
 * overshoot: f(x) = ln(e^x + e^-x), whose minimum is at 0.
 * tangent: a mass on a spring along a line, whose other end is held at 0:
 *   E(x) = m/2 (x - x_tilde)^2 + h^2 l2 k/2 (x^2/l2 - 1)^2
 * landscape: a free node between two pinned nodes that are too close for its
 *   springs: E is not convex where the springs are short.
 * dial: the minimiser of the same E for every h; at h = 0 it is x_tilde.
 * spring: P(d) = l2 k/2 (|d|^2/l2 - 1)^2, and for comparison the energy with a
 *   square root and the same stiffness at rest, P_root(d) = 2k (|d| - l)^2.
 * race: the stretched square, by four methods with seven time steps; each run
 *   is a point, its run time and its error.
 * envelope: the square for every time step and stiffness.
 *
 * simulation/exhibit.h has the data of these scenes. */
#pragma once

#include "simulation/simulation.h"

/* Stores a user's guess (x, y), m, of the point after the next step, in `dial`
 * after the longest step.  No effect with several nodes or after the end. */
void scene_store_guess(Simulation *simulation, double x, double y);

/* ---- one mass, one spring ------------------------------------------------ */

#define SMALL_MASS 1.0 /* mass of each node, kg */

/* Creates a system of a free node 0 and some pinned nodes, each with a spring
 * (rest length m, stiffness J/m^2) to node 0.  Returns as system_create. */
Status create_small_system(System *system, int pins, double length,
                           double stiffness);

/* Create `circle` and `arrows`, with runs 0, 1, 2 by forward, symplectic and
 * backward Euler, or a single run if an integrator is chosen. */
Status create_circle_scene(Simulation *simulation);
Status create_arrows_scene(Simulation *simulation);

/* Creates `spring`: node 0 is free, node 1 is pinned at the origin. */
Status create_spring_scene(Simulation *simulation);

/* A step of the scene arrows, with omega2 = 1/s^2.
 *   forward     x' = x + h v     v' = v + h a(x)
 *   symplectic  v' = v + h a(x)  x' = x + h v'
 *   backward    v' = v + h a(x') x' = x + h v' */
typedef struct MassStep {
    /* Position, velocity, acceleration, SI units, before and after the step. */
    double x[2], v[2], a[2], new_x[2], new_v[2], new_a[2]; /* m, m/s, m/s^2 */
    bool uses_old_v; /* x' = x + h v (forward Euler) */
} MassStep;

/* Computes the next step of a run.
 *   step  out
 * Returns false if the method is not forward, symplectic or backward Euler. */
bool mass_find_next_step(const Simulation *simulation, int run, MassStep *step);

/* Exact solution x(t), m, out; t seconds since the start or the last drag. */
void mass_find_exact_x(const Simulation *simulation, double t, double x[2]);

/* A spring with the vector d (m) from its pinned end to its free end. */
typedef struct SpringValues {
    double length;            /* |d|, m */
    double strain;            /* |d|^2/l2 - 1 */
    double energy;            /* P, J */
    double force[2];          /* -grad P, on the free end, N */
    double eigenvalue_along;  /* eigenvalue of P's Hessian along d, J/m^2 */
    double eigenvalue_across; /* eigenvalue of P's Hessian across d, J/m^2 */
    double root_energy;       /* J, P_root = 2 k (|d| - l)^2 */
    /* Eigenvalues of P_root's Hessian (J/m^2); the second is -inf at d = 0 */
    double root_eigenvalue_along, root_eigenvalue_across;
} SpringValues;

/* Evaluates a spring with the vector d [2] (m), l2 (m^2) and k (J/m^2). */
SpringValues spring_evaluate(const double d[2], double l2, double k);

/* ---- descents: a minimisation by Newton's method, update by update ------- */

/* Create the scenes of a descent.  In overshoot and tangent the unknown is x of
 * node 0.  In landscape node 0 is free, and nodes 1 and 2 are pinned. */
Status create_overshoot_scene(Simulation *simulation);
Status create_tangent_scene(Simulation *simulation);
Status create_landscape_scene(Simulation *simulation);

/* Makes one Newton update (Algorithm 1), with the projection (Algorithm 3, line
 * 3) and line search (Algorithm 2) of the options.  Convergence is tested by
 * |g| with one unknown or if both options are off, else by |p|/h. */
Status step_descent(Simulation *simulation);

/* Computes the direction at the present iterate with the present options. */
void descent_update_direction(Simulation *simulation);

/* Returns E or f with derivatives at (x, y), of the parts switched on. */
TaylorModel descent_evaluate(const Simulation *simulation,
                             Projection projection, double x, double y);

/* Computes p = -H^-1 g with a given projection.
 *   x  [2] m, in
 *   p  [2] m, out
 * Returns g . p, J s^2; NaN if H has no inverse. */
double descent_find_p(const Simulation *simulation, Projection projection,
                      const double *x, double p[2]);

/* Classifies the Hessian without projection: 0 if all its eigenvalues are
 * positive, as at a minimum, and Newton's direction is downhill; 1 if its
 * determinant is not positive, as at a saddle; 2 if all are negative, as at a
 * maximum. With one unknown: 2 if H < 0, else 0. */
int descent_classify_hessian(const Simulation *simulation, double x, double y);

/* Returns the value of some parts of E at (x, y), J s^2.
 *   parts  enum LandscapePart */
double landscape_sum_energy_parts(const Simulation *simulation, unsigned parts,
                                  double x, double y);

/* Creates `dial`: a step makes h 10^(1/10) times longer, up to 10 s; node 0 is
 * at the minimiser. */
Status create_dial_scene(Simulation *simulation);
Status step_dial_scene(Simulation *simulation);
void dial_update_curve(Simulation *simulation);

/* ---- run time against error ---------------------------------------------- */

/* Computes the motion of run 0 up to rounding and puts its end into run 1.
 * Springs must be the only term.  Returns OK, NOT_FINITE if the motion is too
 * fast or explodes, OUT_OF_MEMORY. */
Status race_make_reference(Simulation *simulation, double time);

/* Measures run time and error of a method from run 0 to run 1.
 *   run    in/out, an old run or zeros, then the run of the method at its end;
 *          the caller frees it
 *   point  out
 * Returns OK, or the failure that ended the run. */
Status race_measure_method(Simulation *simulation,
                           const IntegratorMethod *method, double time,
                           long steps, TimeIntegrator *run, RaceResult *point);

/* Makes run[0], the start of the measured runs, and run[1], the exact end. */
Status create_race_scene(Simulation *simulation);

/* Makes the next run.  The methods take turns, with ever shorter time steps. */
Status step_race_scene(Simulation *simulation);

/* Returns method i of the race, 0 ... RACE_METHODS - 1. */
const IntegratorMethod *race_get_method(int i);

/* ---- how far the solver can be trusted ----------------------------------- */

/* Returns the time step of a column, s. */
double envelope_get_timestep(int column);

/* Returns the stiffness of a row, J/m^2. */
double envelope_get_stiffness(int row);

/* Creates `envelope`.  Run 0 is the run of the shown cell of the map, at first
 * of the cell nearest to h and k of the options. */
Status create_envelope_scene(Simulation *simulation);

/* Runs the cells of the next row, from the softest springs to the stiffest. */
Status step_envelope_scene(Simulation *simulation);

/* Runs a cell of the map, with h of the column and k of the row, as run 0.
 * Returns OK, also if steps did not converge, or OUT_OF_MEMORY. */
Status envelope_run_cell(Simulation *simulation, int column, int row);
