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
