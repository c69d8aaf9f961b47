#include "model/mass_spring_energy.h"

#include <math.h>

#include "model/avf_energy.h"
#include "model/system.h"

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

/* With q = p_i - p_j, B = 2 d.q/l2 and C = |q|^2/l2 a spring's strain along
 * the direction is s + alpha B + alpha^2 C, so its energy
 * l2 k/2 (s + alpha B + alpha^2 C)^2 has the coefficients below. */
void mass_spring_energy_along(int springs, const double *x, const double *p,
                              const int *e, const double *l2, const double *k,
                              double scale, double q[3])
{
    for (int s = 0; s < springs; s++) {
        int i = 2 * e[2 * s], j = 2 * e[2 * s + 1];
        double d0 = x[i] - x[j], d1 = x[i + 1] - x[j + 1];
        double p0 = p[i] - p[j], p1 = p[i + 1] - p[j + 1];
        double w = scale * 0.5 * k[s] / l2[s];
        double strain = d0 * d0 + d1 * d1 - l2[s];
        double B = 2 * (d0 * p0 + d1 * p1);
        double C = p0 * p0 + p1 * p1;
        q[0] += w * (B * B + 2 * strain * C);
        q[1] += 2 * w * B * C;
        q[2] += w * C * C;
    }
}

long long mass_spring_entries(const Term *term, const System *system)
{
    (void)term;
    return (long long)SPRING_ENTRIES * system->springs;
}

void mass_spring_pattern(const Term *term, const System *system,
                         Triplets *triplets)
{
    (void)term;
    for (int s = 0; s < system->springs; s++) {
        int i = system->e[2 * s], j = system->e[2 * s + 1];
        term_add_block(system, i, i, triplets);
        term_add_block(system, j, j, triplets);
        term_add_block(system, i, j, triplets);
    }
}

double mass_spring_stiffest(const Term *term, const System *system)
{
    (void)term;
    double stiffest = 0;
    for (int s = 0; s < system->springs; s++)
        stiffest = fmax(stiffest, system->k[s]);
    return stiffest;
}

double mass_spring_force(const Term *term, const System *system)
{
    (void)term;
    double force = 0;
    for (int s = 0; s < system->springs; s++)
        force = fmax(force, system->k[s] * sqrt(system->l2[s]));
    return force;
}

/* Every spring's block is at least -2 c (|x_i|^2 + |x_j|^2), where -c is the
 * lower eigenvalue of its H. */
static void concave(const Term *term, const Place *at, double w, double *sum)
{
    (void)term;
    const System *system = at->system;
    for (int s = 0; s < system->springs; s++) {
        int i = system->e[2 * s], j = system->e[2 * s + 1];
        double dx = at->x[2 * i] - at->x[2 * j];
        double dy = at->x[2 * i + 1] - at->x[2 * j + 1];
        double missing = system->l2[s] - (dx * dx + dy * dy);
        if (!(missing > 0))
            continue;
        double c = w * 2 * system->k[s] / system->l2[s];
        sum[i] += 2 * c * missing;
        sum[j] += 2 * c * missing;
    }
}

static double value(const Term *term, const Place *at)
{
    (void)term;
    const System *system = at->system;
    return mass_spring_energy_value(system->springs, at->x, system->e,
                                    system->l2, system->k);
}

static void gradient(const Term *term, const Place *at, double w, double *g)
{
    (void)term;
    const System *system = at->system;
    mass_spring_energy_gradient(system->springs, at->x, system->e, system->l2,
                                system->k, w, g);
}

static int hessian(const Term *term, const Place *at, double w, Filter filter,
                   const int *slot, double *values)
{
    (void)term;
    const System *system = at->system;
    return mass_spring_energy_hessian(system->springs, at->x, system->e,
                                      system->l2, system->k, w, filter, slot,
                                      values);
}

static void product(const Term *term, const Place *at, double w, Filter filter,
                    const double *q, double *y)
{
    (void)term;
    const System *system = at->system;
    mass_spring_energy_product(system->springs, at->x, system->e, system->l2,
                               system->k, w, filter, q, y);
}

static void along(const Term *term, const Place *at, const double *p, double w,
                  double reach, double q[3])
{
    (void)term;
    (void)reach;
    const System *system = at->system;
    mass_spring_energy_along(system->springs, at->x, p, system->e, system->l2,
                             system->k, w, q);
}

const TermKind mass_spring_energy = {
    .name = "springs",
    .value = value,
    .gradient = gradient,
    .entries = mass_spring_entries,
    .pattern = mass_spring_pattern,
    .hessian = hessian,
    .product = product,
    .along = along,
    .averaged = &avf_energy,
    .stiffest = mass_spring_stiffest,
    .force = mass_spring_force,
    .concave = concave,
    .internal = true,
};
