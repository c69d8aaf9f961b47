#include "model/plasticity.h"

#include <math.h>

/* (|e| - Y)_+ */
static double beyond(SpringLaw law, double e)
{
    return fmax(fabs(e) - law.yield, 0);
}

double spring_law_value(SpringLaw law, double e)
{
    double over = beyond(law, e);
    return 0.5 * (e * e - law.flow * over * over);
}

double spring_law_slope(SpringLaw law, double e)
{
    return e - copysign(law.flow * beyond(law, e), e);
}

double spring_law_curvature(SpringLaw law, double e)
{
    return beyond(law, e) > 0 ? 1 - law.flow : 1;
}

double spring_law_flow(SpringLaw law, double e)
{
    return law.flow * beyond(law, e);
}

/* The remainder of (r)_+^2/2 on the way from r to r + t. */
static double ramp_remainder(double r, double t)
{
    double end = r + t;
    if (r > 0)
        return end > 0 ? 0.5 * t * t : r * (0.5 * r - end);
    return end > 0 ? 0.5 * end * end : 0;
}

double spring_law_remainder(SpringLaw law, double e, double t)
{
    return 0.5 * t * t - law.flow * (ramp_remainder(e - law.yield, t) +
                                     ramp_remainder(-e - law.yield, -t));
}

/* d is an eigenvector, with (2k/l2) (2 tau' q + l2 tau); across it is
 * (2k/l2) l2 tau. */
bool spring_law_hessian(SpringLaw law, const double d[2], double l2, double k,
                        double e, Filter filter, double H[3])
{
    double factor = 2 * k / l2, q = d[0] * d[0] + d[1] * d[1];
    double across = l2 * spring_law_slope(law, e);
    double along = 2 * spring_law_curvature(law, e) * q + across;
    bool negative = along < 0 || across < 0;
    if (filter == FILTER_CLAMP) {
        along = fmax(along, 0);
        across = fmax(across, 0);
    } else if (filter == FILTER_ABS) {
        along = fabs(along);
        across = fabs(across);
    }
    double difference = q > 0 ? (along - across) / q : 0;
    H[0] = factor * (across + difference * d[0] * d[0]);
    H[1] = factor * difference * d[0] * d[1];
    H[2] = factor * (across + difference * d[1] * d[1]);
    return negative && (filter == FILTER_CLAMP || filter == FILTER_ABS);
}
