#include "base/quartic.h"

double quartic_value(const Quartic *quartic, double alpha)
{
    const double *q = quartic->q;
    return alpha * (q[0] + alpha * (q[1] + alpha * (q[2] + alpha * q[3])));
}

double quartic_difference(const void *quartic, double alpha)
{
    return quartic_value(quartic, alpha);
}

double plane_value(const PlaneQuartic *quartic, double a, double b)
{
    const double *c = quartic->c;
    double degree1 = c[0] * a + c[1] * b;
    double degree2 = a * (c[2] * a + c[3] * b) + c[4] * b * b;
    double degree3 =
        a * (a * (c[5] * a + c[6] * b) + c[7] * b * b) + c[8] * b * b * b;
    double degree4 = a * (a * (a * (c[9] * a + c[10] * b) + c[11] * b * b) +
                          c[12] * b * b * b) +
                     c[13] * b * b * b * b;
    return degree1 + degree2 + degree3 + degree4;
}
