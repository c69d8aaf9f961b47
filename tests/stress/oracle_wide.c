/* oracle_wide.c - the formulas of the oracle with 34 digits where the compiler
 * has them: 19 digits do not resolve how a stiff, light body turns. */
#define ORACLE_WIDE
#include <float.h>
#include <math.h>

#define exact_E_change      wide_exact_E_change
#define exact_residual      wide_exact_residual
#define oracle_energy       wide_oracle_energy
#define oracle_step_energy  wide_oracle_step_energy
#define exact_potential     wide_exact_potential
#define exact_strain        wide_exact_strain
#define exact_derivatives   wide_exact_derivatives
#define exact_eigenvectors  wide_exact_eigenvectors
#define visit_E_parts       wide_visit_blocks
#define exact_gap           wide_exact_gap
#define find_smallest_gap   wide_find_smallest_gap
#define smallest_area_ratio wide_smallest_area_ratio
#define edge_crossings      wide_edge_crossings
#include "oracle.h"

static Real larger(Real a, Real b)
{
    return a > b ? a : b;
}

static Real smaller(Real a, Real b)
{
    return a < b ? a : b;
}

static Real magnitude(Real a)
{
    return a < 0 ? -a : a;
}

static Real copy_sign(Real size, Real sign)
{
    return sign < 0 ? -magnitude(size) : magnitude(size);
}

/* Returns the square root: Newton's method from the root of a long double. */
static Real square_root(Real a)
{
    if (!(a > 0))
        return a == 0 ? 0 : (Real)NAN;
    Real root = sqrtl((long double)a);
    root = (root + a / root) / 2;
    return (root + a / root) / 2;
}

static Real hypotenuse(Real x, Real y)
{
    return square_root(x * x + y * y);
}

/* Returns ln a for 1 <= a <= 2: four roots, then 2 artanh((a - 1)/(a + 1)). */
static Real log_of_mantissa(Real a)
{
    for (int i = 0; i < 4; i++)
        a = square_root(a);
    Real r = (a - 1) / (a + 1), sum = 0, power = r;
    for (int i = 1; i < 30; i += 2, power *= r * r)
        sum += power / i;
    return 32 * sum;
}

static Real logarithm(Real a)
{
    int k;
    if (!(a > 0))
        return a == 0 ? -(Real)INFINITY : (Real)NAN;
    frexpl((long double)a, &k);
    return log_of_mantissa(a / ldexpl(0.5L, k)) + (k - 1) * log_of_mantissa(2);
}

#define fabsl     magnitude
#define sqrtl     square_root
#define logl      logarithm
#define hypotl    hypotenuse
#define fminl     smaller
#define fmaxl     larger
#define copysignl copy_sign
#include "../unit/oracle.c"
