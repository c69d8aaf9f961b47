/* Functions whose last digit is promised. */
#include "test.h"

#include <float.h>
#include <math.h>

#include "base/mathematics.h"

/* Units in the last place between a double and the same in extended precision.
 */
static double ulps(double got, long double exact)
{
    double nearest = (double)exact;
    if (!isfinite(nearest))
        return got == nearest || (isnan(got) && isnan(nearest)) ? 0 : INFINITY;
    double unit = nextafter(fabs(nearest), INFINITY) - fabs(nearest);
    return (double)(fabsl(got - exact) / unit);
}

/* 1.5 units: what mathematics.h promises. */
static void check_digits(double x, double z)
{
    CHECK_AT_MOST(ulps(math_log(x), logl(x)), 1.5);
    CHECK_AT_MOST(ulps(math_log1p(z), log1pl(z)), 1.5);
    CHECK_AT_MOST(ulps(math_hypot(x, z), hypotl(x, z)), 1.5);
}

TEST(functions_are_right_to_the_last_place)
{
    static const double edges[] = {
        0,       1,       -1,       0.70710678118654752, INFINITY,        NAN,
        DBL_MIN, DBL_MAX, 4.9e-324, 1 - DBL_EPSILON,     1 + DBL_EPSILON, -3,
        1e-200,  1e200};
    const int count = sizeof edges / sizeof *edges;
    Random random = {81};
    for (int i = 0; i < count * count; i++)
        check_digits(edges[i / count], edges[i % count]);
    for (int i = 0; i < 300000; i++) {
        double x = i % 3 == 0   ? random_logarithmic(&random, 1e-300, 1e300)
                   : i % 3 == 1 ? random_uniform(&random, 0.5, 2)
                                : 1 + random_uniform(&random, -1e-6, 1e-6);
        double z = i % 2 ? random_uniform(&random, -0.999, 3)
                         : random_logarithmic(&random, 1e-20, 1e20);
        check_digits(x, i % 4 == 2 && z < 0.5 ? -z : z);
        if (i % 5 == 0)
            check_digits(x, x * random_uniform(&random, -2, 2));
    }
}

TESTS(NULL, NULL)
