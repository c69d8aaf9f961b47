#include "model/inertia_energy.h"

/* sum m_i |x_i - x_tilde_i|^2 / 2 */
double inertia_energy_value(int n, const double *x, const double *x_tilde,
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

/* g_i += m_i (x_i - x_tilde_i) */
void inertia_energy_gradient(int n, const double *x, const double *x_tilde,
                             const double *m, double *g)
{
    for (int i = 0; i < n; i++) {
        g[2 * i] += m[i] * (x[2 * i] - x_tilde[2 * i]);
        g[2 * i + 1] += m[i] * (x[2 * i + 1] - x_tilde[2 * i + 1]);
    }
}

/* M = diag(m_0, m_0, m_1, m_1, ...) */
void inertia_energy_hessian(int n, const double *m, const int *slot,
                            double *values)
{
    for (int t = 0; t < 2 * n; t++)
        values[slot[t]] += m[t / 2];
}
