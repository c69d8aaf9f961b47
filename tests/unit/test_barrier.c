/* The functions of one variable in barriers, friction and springs that flow:
 * their values at borders, and remainders to the last digits, against integrals
 * and formulas in extended precision.
 */
#include "test.h"

#include <float.h>
#include <math.h>

#include "model/barrier.h"
#include "model/friction.h"
#include "model/plasticity.h"

/* A function of one variable with what it is said to have. */
typedef long double (*Curvature)(long double at, const double *constants);

/* Integral of (t - q) f''(y + q) dq over q = from ... to, where f'' is smooth:
 * Gauss-Legendre with five points on panels, which get shorter in proportion to
 * y + q where the way leads far: f'' = 1/s^2 near 0 does no harm then. */
static long double integrate(Curvature second, const double *constants,
                             long double y, long double from, long double to,
                             long double t)
{
    static const long double node[5] = {
        0, 0.53846931010568309103631442070020880496728660690556L,
        -0.53846931010568309103631442070020880496728660690556L,
        0.90617984593866399279762687829939296512565191076253L,
        -0.90617984593866399279762687829939296512565191076253L};
    static const long double weight[5] = {
        0.56888888888888888888888888888888888888888888888889L,
        0.47862867049936646804129151483563819291229555334314L,
        0.47862867049936646804129151483563819291229555334314L,
        0.23692688505618908751426404071991736264326000221241L,
        0.23692688505618908751426404071991736264326000221241L};
    enum { PANELS = 128 };
    long double sum = 0, ratio = y + from > 0 ? (y + to) / (y + from) : 1;
    bool far = ratio > 1.5L || (ratio > 0 && ratio < 0.7L);
    for (int k = 0; k < PANELS; k++) {
        long double t0 = (long double)k / PANELS, t1 = (k + 1.0L) / PANELS;
        long double a = from + (to - from) * t0, b = from + (to - from) * t1;
        if (far) {
            a = k > 0 ? (y + from) * powl(ratio, t0) - y : from;
            b = k < PANELS - 1 ? (y + from) * powl(ratio, t1) - y : to;
        }
        for (int i = 0; i < 5; i++) {
            long double q = 0.5L * (a + b) + 0.5L * (b - a) * node[i];
            sum +=
                0.5L * (b - a) * weight[i] * (t - q) * second(y + q, constants);
        }
    }
    return sum;
}

/* f(y + t) - f(y) - f'(y) t, cut where f'' jumps or bends. */
static long double exact_remainder(Curvature second, const double *constants,
                                   const double *cuts, int count, double y,
                                   double t)
{
    long double from = 0, sum = 0;
    while (from != t) {
        long double to = t;
        for (int i = 0; i < count; i++) {
            long double cut = (long double)cuts[i] - y;
            if ((cut > from && cut < to) || (cut < from && cut > to))
                to = cut;
        }
        sum += integrate(second, constants, y, from, to, t);
        from = to;
    }
    return sum;
}

static long double barrier_second(long double s, const double *constants)
{
    (void)constants;
    return s < 1 ? (1 + s) / (s * s) : 0;
}

static long double friction_second(long double y, const double *constants)
{
    long double e = constants[0];
    return 2 / e * fmaxl(0, 1 - fabsl(y) / e);
}

/* The values at the borders, which no difference can tell. */
TEST(scalars_are_continuous)
{
    const double below = 1 - DBL_EPSILON / 2, e = 0.125;
    CHECK_NEAR(barrier_value(0.5), 0.5 * logl(2), 1e-16);
    CHECK_NEAR(barrier_value(below), 0, 1e-30);
    CHECK_NEAR(barrier_slope(below), 0, 1e-15);
    CHECK_NEAR(barrier_curvature(below), 2, 1e-15);
    assert_true(barrier_value(1) == 0 && barrier_slope(1) == 0 &&
                barrier_curvature(1) == 0);
    assert_true(barrier_remainder(0.5, -0.5) == INFINITY);
    assert_true(barrier_remainder(0.5, -0.7) == INFINITY);
    assert_true(friction_value(0, e) == 0 && friction_slope(0, e) == 0);
    CHECK_NEAR(friction_value(e, e), e - e / 3, 1e-17);
    CHECK_NEAR(friction_value(e * below, e), e - e / 3, 1e-16);
    assert_true(friction_slope(e, e) == 1 && friction_slope(-2 * e, e) == -1);
    SpringLaw law = {e, 0.8, 0, 0};
    CHECK_NEAR(spring_law_slope(law, e), e, 0);
    CHECK_NEAR(spring_law_slope(law, -e), -e, 0);
    /* beyond: force Y + (e - Y) H/(1 + H), flow the rest */
    CHECK_NEAR(spring_law_slope(law, 3 * e), e + 2 * e * 0.2, 1e-16);
    CHECK_NEAR(spring_law_slope(law, -3 * e), -e - 2 * e * 0.2, 1e-16);
    CHECK_NEAR(spring_law_flow(law, -3 * e), 2 * e * 0.8, 1e-16);
    assert_true(spring_law_flow(law, e) == 0);
}

/* 7e-13 in topics of 60 digits; ours holds some units in the last place, more
 * where y + t itself is rounded. */
TEST(remainders_are_exact)
{
    Random random = {12};
    const double one = 1;
    for (int i = 0; i < 1500; i++) {
        double s = random_logarithmic(&random, 1e-5, 3);
        double t = s * random_logarithmic(&random, 1e-14, 10);
        if (i % 2)
            t = -fmin(t, 0.9 * s);
        long double exact =
            exact_remainder(barrier_second, NULL, &one, 1, s, t);
        double got = barrier_remainder(s, t);
        /* leaving or entering the barrier: (s + t - 1)^2 has lost digits */
        double gap = fabs(s + t - 1);
        double lost = s > 1 || s + t > 1 ? 8e-16 * (s + 1) : 0;
        if (s > 1 && s + t < 1)
            lost = 2e-15 / gap;
        CHECK_NEAR(got, exact, (2e-15 + lost) * exact);
        CHECK(got >= 0);
    }
}

TEST(remainders_of_pieces_are_exact)
{
    Random random = {13};
    for (int i = 0; i < 3000; i++) {
        double c[2] = {random_logarithmic(&random, 1e-8, 10),
                       random_uniform(&random, 0.3, 1)};
        const double cuts[3] = {-c[0], 0, c[0]};
        double y = c[0] * random_uniform(&random, -2, 2);
        double t = c[0] * random_logarithmic(&random, 1e-9, 10);
        if (i % 2)
            t = -t;
        /* y + t is rounded: eps c[0] of t, twice, in what is passed of f'' */
        double lost = 4e-15 * c[0] * (1 + fabs(t) / c[0]);
        long double exact = exact_remainder(friction_second, c, cuts, 3, y, t);
        double got = friction_remainder(y, t, c[0]);
        CHECK_NEAR(got, exact,
                   2e-15 * exact + lost * fmin(1, fabs(t) / c[0]) * 2);
        CHECK(got >= 0);
    }
    /* tiny steps on one piece: relative accuracy is kept */
    for (double t = 1e-3; t > 1e-12; t /= 7) {
        double e = 1, y = 0.5;
        long double exact = (long double)t * t * (1 - 2 * t / 3) / 2;
        CHECK_NEAR(friction_remainder(y, t, e), exact, 1e-15 * exact);
        exact = (long double)t * t / 2;
        CHECK_NEAR(spring_law_remainder((SpringLaw){1, .5, 0, 0}, y, t), exact,
                   1e-15 * exact);
        CHECK_NEAR(spring_law_remainder((SpringLaw){.25, .5, 0, 0}, y, t),
                   exact / 2, 1e-15 * exact);
    }
}

/* V of plasticity.h as it stands there, times 2. */
static Wide twice_V(Wide Y, Wide flow, Wide theta, Wide e_n, Wide e)
{
    Wide over = e > Y ? e - Y : e < -Y ? -e - Y : 0, change = e - e_n;
    return e * e - flow * over * over + theta * change * change;
}

/* Springs that flow, half of them without hardening, as far as light nodes may
 * fly.  Where they are elastic, |e| < Y, is known to an ulp of e and Y: that
 * moves the remainder by no more than 2Y times the way.  And the whole change,
 * V(e + t) - V(e), is as exact as V is large. */
TEST(remainders_of_flow_are_exact)
{
    Random random = {15};
    for (int i = 0; i < 20000; i++) {
        double Y = random_logarithmic(&random, 1e-8, 10), e_n = 0, theta = 0;
        double flow = i % 2 ? 1 : random_uniform(&random, 0.3, 1);
        double e = Y * random_logarithmic(&random, 1e-3, 1e9);
        double t = random_below(&random, 3)
                       ? Y * random_logarithmic(&random, 1e-9, 1e14)
                       : e * random_uniform(&random, 0, 3);
        if (random_below(&random, 2))
            e = -e;
        if (random_below(&random, 2))
            t = -t;
        if (random_below(&random, 4) == 0) {
            e_n = e * random_uniform(&random, -1, 1);
            theta = random_logarithmic(&random, 1e-3, 1e3);
        }
        SpringLaw law = {Y, flow, theta, e_n};
        Wide start = twice_V(Y, flow, theta, e_n, e) / 2;
        Wide end = twice_V(Y, flow, theta, e_n, (Wide)e + t) / 2;
        Wide within = e > Y ? Y : e < -Y ? -Y : e;
        Wide slope =
            within + (1 - (Wide)flow) * (e - within) + theta * ((Wide)e - e_n);
        double got = spring_law_remainder(law, e, t);
        double exact = (double)(end - start - slope * t);
        CHECK_NEAR(got, exact,
                   1e-15 * exact +
                       DBL_EPSILON * 2 * Y * (fabs(e) + Y + fabs(t)));
        CHECK(got >= 0);
        CHECK_NEAR(
            spring_law_slope(law, e), slope,
            4e-16 * (Y + (1 - flow) * fabs(e) + theta * (fabs(e) + fabs(e_n))));
        CHECK_NEAR(spring_law_value(law, e), start, 1e-15 * (double)start);
        CHECK_NEAR(got + spring_law_slope(law, e) * t, end - start,
                   2e-15 * (double)(start + end));
    }
}

TEST(log1p_minus_is_exact)
{
    Random random = {14};
    for (int i = 0; i < 20000; i++) {
        double z = random_logarithmic(&random, 1e-18, 1);
        if (i % 2)
            z = -0.999 * z;
        long double exact = log1pl(z) - (long double)z;
        if (fabs(z) < 0.3) {
            exact = 0;
            for (int k = 80; k > 1; k--)
                exact = z * (exact + (k % 2 ? 1.0L : -1.0L) / k);
            exact *= z;
        }
        /* from 1/4 on a difference, which loses two or three bits */
        CHECK_NEAR(log1p_minus(z), exact,
                   (fabs(z) < 0.25 ? 1e-15 : 8e-15) * fabsl(exact));
    }
}

TESTS(NULL, NULL)
