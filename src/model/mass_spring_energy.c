#include "model/mass_spring_energy.h"

/* d = x_i - x_j; returns s = |d|^2/l2 - 1 */
static double spring_strain(const double *x, const int e[2], double l2,
                            double d[2])
{
    const double *xi = x + 2 * e[0], *xj = x + 2 * e[1];
    d[0] = xi[0] - xj[0];
    d[1] = xi[1] - xj[1];
    return (d[0] * d[0] + d[1] * d[1]) / l2 - 1;
}

/* sum l2 k/2 s^2 */
double mass_spring_energy_value(int springs, const double *x, const int *e,
                                const double *l2, const double *k)
{
    double sum = 0;
    for (int i = 0; i < springs; i++) {
        double d[2];
        double s = spring_strain(x, e + 2 * i, l2[i], d);
        sum += l2[i] * 0.5 * k[i] * s * s;
    }
    return sum;
}

/* grad_i P = 2 k s d, grad_j P = -2 k s d */
void mass_spring_energy_gradient(int springs, const double *x, const int *e,
                                 const double *l2, const double *k,
                                 double scale, double *g)
{
    for (int i = 0; i < springs; i++) {
        double d[2];
        double s = spring_strain(x, e + 2 * i, l2[i], d);
        double factor = scale * 2 * k[i] * s;
        double *gi = g + 2 * e[2 * i], *gj = g + 2 * e[2 * i + 1];
        gi[0] += factor * d[0];
        gi[1] += factor * d[1];
        gj[0] -= factor * d[0];
        gj[1] -= factor * d[1];
    }
}

/* H = (2k/l2) (2 d d^T + (|d|^2 - l2) I), projected where d is too short;
 * returns whether it was. */
static inline bool filtered_hessian(const double *x, const int e[2], double l2,
                                    double k, Filter filter, double H[3])
{
    const double *xi = x + 2 * e[0], *xj = x + 2 * e[1];
    double d[2] = {xi[0] - xj[0], xi[1] - xj[1]};
    return filter == FILTER_CLAMP
               ? spring_hessian_psd(d, l2, k, H)
               : spring_hessian_filtered(d, l2, k, filter, H);
}

int mass_spring_energy_hessian(int springs, const double *x, const int *e,
                               const double *l2, const double *k, double scale,
                               Filter filter, const int *slot, double *values)
{
    int projected = 0;
    for (int i = 0; i < springs; i++) {
        double H[3];
        projected +=
            filtered_hessian(x, e + 2 * i, l2[i], scale * k[i], filter, H);
        mass_spring_scatter(H, i, slot, values);
    }
    return projected;
}

void mass_spring_energy_product(int springs, const double *x, const int *e,
                                const double *l2, const double *k, double scale,
                                Filter filter, const double *q, double *y)
{
    for (int i = 0; i < springs; i++) {
        double H[3];
        filtered_hessian(x, e + 2 * i, l2[i], scale * k[i], filter, H);
        mass_spring_multiply(H, e + 2 * i, q, y);
    }
}
