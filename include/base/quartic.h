/* quartic.h - what the energy is along a line: a polynomial of degree 4
 * without constant term.
 */
#ifndef ELASTO_QUARTIC_H
#define ELASTO_QUARTIC_H

/* q(alpha) = q[0] alpha + q[1] alpha^2 + q[2] alpha^3 + q[3] alpha^4 */
typedef struct Quartic {
    double q[4]; /* J s^2 */
} Quartic;

/* q(alpha) - q(0), by Horner's rule. */
static inline double quartic_value(const Quartic *quartic, double alpha)
{
    const double *q = quartic->q;
    return alpha * (q[0] + alpha * (q[1] + alpha * (q[2] + alpha * q[3])));
}

#endif
