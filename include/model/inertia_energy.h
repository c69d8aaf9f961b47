/* inertia_energy.h - E_I = sum m_i |x_i - x_tilde_i|^2/2 (InertiaEnergy.py).
 *
 * E_I depends on x - x_tilde alone.  Time steps therefore pass displacements
 * from x_n as x and x_tilde, which have smaller rounding errors.
 *   n        nodes
 *   x        [2n] m, in
 *   x_tilde  [2n] m, in
 *   m        [n] kg, in */
#pragma once

/* E_I(x), kg m^2. */
static inline double inertia_energy_value(int n, const double *x,
                                          const double *x_tilde,
                                          const double *m)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        double dx = x[2 * i] - x_tilde[2 * i];
        double dy = x[2 * i + 1] - x_tilde[2 * i + 1];
        sum += 0.5 * m[i] * (dx * dx + dy * dy);
    }
    return sum;
}

/* g_i += m_i (x_i - x_tilde_i).  g [2n] kg m, in/out. */
static inline void inertia_energy_gradient(int n, const double *x,
                                           const double *x_tilde,
                                           const double *m, double *g)
{
    for (int i = 0; i < n; i++) {
        g[2 * i] += m[i] * (x[2 * i] - x_tilde[2 * i]);
        g[2 * i + 1] += m[i] * (x[2 * i + 1] - x_tilde[2 * i + 1]);
    }
}

/* values[slot[t]] += M_tt for the 2n entries t of M = diag(m_0, m_0, m_1, ...).
 *   slot    [2n] in
 *   values  in/out, kg */
static inline void inertia_energy_hessian(int n, const double *m,
                                          const int *slot, double *values)
{
    for (int t = 0; t < 2 * n; t++)
        values[slot[t]] += m[t / 2];
}
