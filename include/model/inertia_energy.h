/* inertia_energy.h - E_I(x) = sum m_i |x_i - x_tilde_i|^2 / 2
 * (slide InertiaEnergy.py).
 *
 * Only the difference x - x_tilde enters, so both may be displacements from
 * x_n instead of positions: that is how the stepper calls it.
 *   n        nodes
 *   x        [2n] m, in
 *   x_tilde  [2n] m, in
 *   m        [n] kg, in
 */
#ifndef ELASTO_INERTIA_ENERGY_H
#define ELASTO_INERTIA_ENERGY_H

/* E_I(x), kg m^2. */
double inertia_energy_value(int n, const double *x, const double *x_tilde,
                            const double *m);

/* g += M (x - x_tilde).  g [2n] kg m, in/out. */
void inertia_energy_gradient(int n, const double *x, const double *x_tilde,
                             const double *m, double *g);

/* values[slot[t]] += M_tt for the 2n diagonal entries t.
 *   slot    [2n] in
 *   values  in/out, kg */
void inertia_energy_hessian(int n, const double *m, const int *slot,
                            double *values);

#endif
