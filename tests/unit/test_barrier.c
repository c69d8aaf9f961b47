/* The functions of one contact, one sliding node, one cell and one plastic
 * spring: derivatives against differences, remainders against integrals in
 * extended precision, blocks against eigenvalues.
 */
#include "testing.h"

#include <float.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "model/barrier.h"
#include "model/cells.h"
#include "model/contact.h"
#include "model/friction.h"
#include "model/mass_spring_energy.h"
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

static long double law_second(long double e, const double *constants)
{
    return fabsl(e) > constants[0] ? 1 - (long double)constants[1] : 1;
}

/* The three functions in one shape. */
typedef struct Scalar {
    double (*value)(double, const double *);
    double (*slope)(double, const double *);
    double (*curvature)(double, const double *);
    double (*remainder)(double, double, const double *);
    Curvature second;
} Scalar;

static double b0(double s, const double *c)
{
    (void)c;
    return barrier_value(s);
}
static double b1(double s, const double *c)
{
    (void)c;
    return barrier_slope(s);
}
static double b2(double s, const double *c)
{
    (void)c;
    return barrier_curvature(s);
}
static double br(double s, double t, const double *c)
{
    (void)c;
    return barrier_remainder(s, t);
}
static double f0(double y, const double *c)
{
    return friction_value(y, c[0]);
}
static double f1(double y, const double *c)
{
    return friction_slope(y, c[0]);
}
static double f2(double y, const double *c)
{
    return friction_curvature(y, c[0]);
}
static double fr(double y, double t, const double *c)
{
    return friction_remainder(y, t, c[0]);
}
static double l0(double e, const double *c)
{
    return spring_law_value((SpringLaw){c[0], c[1], 0, 0}, e);
}
static double l1(double e, const double *c)
{
    return spring_law_slope((SpringLaw){c[0], c[1], 0, 0}, e);
}
static double l2(double e, const double *c)
{
    return spring_law_curvature((SpringLaw){c[0], c[1], 0, 0}, e);
}
static double lr(double e, double t, const double *c)
{
    return spring_law_remainder((SpringLaw){c[0], c[1], 0, 0}, e, t);
}

static const Scalar barrier_scalar = {b0, b1, b2, br, barrier_second};
static const Scalar friction_scalar = {f0, f1, f2, fr, friction_second};
static const Scalar law_scalar = {l0, l1, l2, lr, law_second};

/* Fourth-order differences of value and slope.  h: their width, small against
 * the distance to the next cut. */
static void check_derivatives(const Scalar *f, const double *c, double at,
                              double h, double scale)
{
    double first = (8 * (f->value(at + h, c) - f->value(at - h, c)) -
                    (f->value(at + 2 * h, c) - f->value(at - 2 * h, c))) /
                   (12 * h);
    double second = (8 * (f->slope(at + h, c) - f->slope(at - h, c)) -
                     (f->slope(at + 2 * h, c) - f->slope(at - 2 * h, c))) /
                    (12 * h);
    /* rounding eps/h = 1e-12, error of the formula h^4/30 f^(5) */
    CHECK_NEAR(f->slope(at, c), first,
               1e-9 * (fabs(first) + fabs(f->value(at, c)) / scale));
    CHECK_NEAR(f->curvature(at, c), second,
               1e-9 * (fabs(second) + fabs(f->slope(at, c)) / scale));
}

static void derivatives_of_the_scalars(void **state)
{
    (void)state;
    Random random = {11};
    for (int i = 0; i < 2000; i++) {
        double s = random_logarithmic(&random, 1e-6, 0.99), c[2];
        check_derivatives(&barrier_scalar, NULL, s, 1e-3 * fmin(s, 1 - s), s);
        c[0] = random_logarithmic(&random, 1e-8, 1);
        double y = c[0] * random_uniform(&random, -3, 3);
        double away = fmin(fabs(y), fabs(fabs(y) - c[0]));
        check_derivatives(&friction_scalar, c, y, 0.01 * away, c[0]);
        c[1] = random_uniform(&random, 0.3, 1);
        check_derivatives(&law_scalar, c, y, 0.01 * away, c[0]);
    }
}

/* The values at the borders, which no difference can tell. */
static void scalars_are_continuous(void **state)
{
    (void)state;
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
static void remainders_are_exact(void **state)
{
    (void)state;
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

static void remainders_of_pieces_are_exact(void **state)
{
    (void)state;
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
static void remainders_of_flow_are_exact(void **state)
{
    (void)state;
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

static void log1p_minus_is_exact(void **state)
{
    (void)state;
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

/* An energy in six coordinates: a contact of two points, or a triangle. */
typedef struct Block {
    bool cell;
    Obstacle obstacle;
    Barrier barrier;
    double area, c;
} Block;

/* W in extended precision. */
static long double block_value(const Block *block, const long double x[6])
{
    long double s, c = block->cell ? block->c : block->barrier.c;
    if (block->cell)
        s = ((x[2] - x[0]) * (x[5] - x[1]) - (x[3] - x[1]) * (x[4] - x[0])) /
            (2 * block->area) / CELL_J_HAT;
    else if (block->obstacle.kind == OBSTACLE_WALL)
        s = (block->obstacle.n[0] * (x[0] - block->obstacle.o[0]) +
             block->obstacle.n[1] * (x[1] - block->obstacle.o[1])) /
            block->barrier.d_hat;
    else
        s = (hypotl(x[0] - x[2], x[1] - x[3]) - block->obstacle.radius) /
            block->barrier.d_hat;
    return s < 1 ? c * (s - 1) * logl(s) : 0;
}

static Gap block_gap(const Block *block, const double x[6])
{
    return contact_gap(&block->obstacle,
                       block->obstacle.kind == OBSTACLE_WALL ? block->obstacle.o
                                                             : x + 2,
                       x, 0);
}

static Corner block_corner(const Block *block, const double x[6])
{
    return cell_corner(x, x + 2, x + 4, block->area, block->c);
}

/* One triangle of nine 2x2 blocks in a whole matrix. */
static void whole_cell(const double H[CELL_ENTRIES], double full[36])
{
    static const int pair[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    memset(full, 0, 36 * sizeof *full);
    for (int k = 0; k < 3; k++) {
        const double *B = H + 3 * k;
        full[6 * (2 * k) + 2 * k] = B[0];
        full[6 * (2 * k) + 2 * k + 1] = full[6 * (2 * k + 1) + 2 * k] = B[1];
        full[6 * (2 * k + 1) + 2 * k + 1] = B[2];
        B = H + 9 + 4 * k;
        for (int r = 0; r < 2; r++)
            for (int c = 0; c < 2; c++) {
                int row = 2 * pair[k][0] + r, column = 2 * pair[k][1] + c;
                full[6 * row + column] = full[6 * column + row] = B[2 * r + c];
            }
    }
}

/* Gradient [6] and Hessian [36], walls with nothing at the second point. */
static void block_derivatives(const Block *block, const double x[6],
                              Filter filter, double g[6], double H[36])
{
    double h[CELL_ENTRIES];
    memset(g, 0, 6 * sizeof *g);
    if (block->cell) {
        Corner corner = block_corner(block, x);
        cell_gradient(&corner, g);
        cell_hessian(&corner, filter, h);
        whole_cell(h, H);
        return;
    }
    Gap gap = block_gap(block, x);
    double force = contact_force(&block->barrier, &gap);
    bool wall = block->obstacle.kind == OBSTACLE_WALL;
    memset(H, 0, 36 * sizeof *H);
    contact_hessian(&block->barrier, &gap, filter, h);
    for (int i = 0; i < 2; i++) {
        g[i] = -force * gap.n[i];
        g[2 + i] = wall ? 0 : force * gap.n[i];
        for (int j = 0; j < 2; j++) {
            double entry = h[i + j];
            H[6 * i + j] = entry;
            if (!wall) {
                H[6 * (2 + i) + 2 + j] = entry;
                H[6 * i + 2 + j] = H[6 * (2 + i) + j] = -entry;
            }
        }
    }
}

/* A random block that is live: barrier between 1e-4 and 0.95 of its width. */
static Block random_block(Random *random, int kind, double x[6])
{
    Block block = {.cell = kind == 2};
    double angle = random_uniform(random, 0, 6.28);
    double n[2] = {cos(angle), sin(angle)};
    double s = random_logarithmic(random, 1e-4, 0.95);
    for (int i = 0; i < 6; i++)
        x[i] = random_uniform(random, -1, 1);
    if (kind == 2) { /* flat, but not turned over */
        block.area = random_logarithmic(random, 1e-3, 10);
        block.c = random_logarithmic(random, 1e-2, 1e4);
        double length = sqrt(block.area) * random_uniform(random, 0.3, 3);
        double high = 2 * block.area * s * CELL_J_HAT / length;
        double along = random_uniform(random, -1, 2) * length;
        x[2] = x[0] + length * n[0];
        x[3] = x[1] + length * n[1];
        x[4] = x[0] + along * n[0] - high * n[1];
        x[5] = x[1] + along * n[1] + high * n[0];
        return block;
    }
    block.barrier = (Barrier){random_logarithmic(random, 1e-3, 0.1),
                              random_logarithmic(random, 1e-3, 1e4)};
    block.obstacle = (Obstacle){.kind = kind ? OBSTACLE_BALL : OBSTACLE_WALL,
                                .n = {n[0], n[1]},
                                .radius = random_logarithmic(random, 0.01, 2),
                                .node = -1};
    double d = s * block.barrier.d_hat, away = d;
    if (kind)
        away += block.obstacle.radius;
    for (int i = 0; i < 2; i++) {
        block.obstacle.o[i] = kind ? x[2 + i] : x[i] - away * n[i];
        if (kind)
            x[i] = x[2 + i] + away * n[i];
    }
    return block;
}

/* The gap, or how high the triangle is. */
static double block_length(const Block *block, const double x[6])
{
    if (!block->cell)
        return block_gap(block, x).d;
    Corner corner = block_corner(block, x);
    return corner.J * 2 * block->area /
           fmax(hypot(corner.e1[0], corner.e1[1]),
                hypot(corner.e2[0], corner.e2[1]));
}

/* Differences of the energy in long double, of fourth order. */
static void derivatives_of_the_blocks(void **state)
{
    (void)state;
    Random random = {15};
    for (int n = 0; n < 600; n++) {
        double x[6], g[6], H[36], up[6], down[6], other[36];
        Block block = random_block(&random, n % 3, x);
        block_derivatives(&block, x, FILTER_NONE, g, H);
        double length = block_length(&block, x), size = 0, largest = 0;
        for (int i = 0; i < 36; i++)
            largest = fmax(largest, fabs(H[i]));
        for (int i = 0; i < 6; i++)
            size = fmax(size, fabs(g[i]));
        for (int i = 0; i < 6; i++) {
            long double h = 1e-4L * length, y[6], sum = 0;
            const int steps[4] = {1, -1, 2, -2};
            const long double weights[4] = {8, -8, -1, 1};
            for (int k = 0; k < 4; k++) {
                for (int j = 0; j < 6; j++)
                    y[j] = x[j];
                y[i] += steps[k] * h;
                sum += weights[k] * block_value(&block, y);
            }
            /* the gap x - o has lost eps/d; the formula h^4 = 1e-16 */
            double lost = 1e-9 + 4e-16 * 8 / length;
            CHECK_NEAR(g[i], sum / (12 * h), lost * size);
            double H_i[6] = {0};
            for (int k = 0; k < 4; k++) {
                memcpy(up, x, sizeof up);
                up[i] += (double)(steps[k] * h);
                block_derivatives(&block, up, FILTER_NONE, down, other);
                for (int j = 0; j < 6; j++)
                    H_i[j] += (double)weights[k] * down[j] / (12 * (double)h);
            }
            for (int j = 0; j < 6; j++)
                CHECK_NEAR(H[6 * i + j], H_i[j],
                           (1e-7 + 4e-12 / length) * largest);
        }
    }
}

/* Cyclic Jacobi rotations on a symmetric matrix; values [n] of l, vectors in
 * the columns of q. */
static void jacobi(int n, long double *a, long double *q)
{
    for (int i = 0; i < n * n; i++)
        q[i] = i % (n + 1) == 0;
    for (int sweep = 0; sweep < 40; sweep++)
        for (int r = 0; r < n; r++)
            for (int c = r + 1; c < n; c++) {
                if (a[n * r + c] == 0)
                    continue;
                long double theta =
                    (a[n * c + c] - a[n * r + r]) / (2 * a[n * r + c]);
                long double t =
                    copysignl(1, theta) / (fabsl(theta) + hypotl(1, theta));
                long double cosine = 1 / hypotl(1, t), sine = t * cosine;
                for (int i = 0; i < n; i++) {
                    long double ar = a[n * i + r], ac = a[n * i + c];
                    long double qr = q[n * i + r], qc = q[n * i + c];
                    a[n * i + r] = cosine * ar - sine * ac;
                    a[n * i + c] = sine * ar + cosine * ac;
                    q[n * i + r] = cosine * qr - sine * qc;
                    q[n * i + c] = sine * qr + cosine * qc;
                }
                for (int i = 0; i < n; i++) {
                    long double ar = a[n * r + i], ac = a[n * c + i];
                    a[n * r + i] = cosine * ar - sine * ac;
                    a[n * c + i] = sine * ar + cosine * ac;
                }
            }
}

/* Clamped and absolute blocks against the eigenvalues of the raw ones. */
static void projections_are_the_eigenvalues(void **state)
{
    (void)state;
    Random random = {16};
    const Filter filters[2] = {FILTER_CLAMP, FILTER_ABS};
    for (int n = 0; n < 900; n++) {
        double x[6], g[6], H[36], got[36];
        Block block = random_block(&random, n % 3, x);
        if (n == 2) { /* a right corner of equal sides has no part e- */
            const double corner[6] = {0, 0, 0.1, 0, 0, 0.1};
            memcpy(x, corner, sizeof x);
            block.area = 0.5;
        }
        block_derivatives(&block, x, FILTER_NONE, g, H);
        for (int f = 0; f < 2; f++) {
            long double a[36], q[36], largest = 0, l[6];
            block_derivatives(&block, x, filters[f], g, got);
            for (int i = 0; i < 36; i++)
                a[i] = H[i];
            jacobi(6, a, q);
            for (int i = 0; i < 6; i++) {
                largest = fmaxl(largest, fabsl(a[7 * i]));
                l[i] = f ? fabsl(a[7 * i]) : fmaxl(a[7 * i], 0);
            }
            for (int r = 0; r < 6; r++)
                for (int c = 0; c < 6; c++) {
                    long double sum = 0;
                    for (int i = 0; i < 6; i++)
                        sum += l[i] * q[6 * r + i] * q[6 * c + i];
                    /* for cells node a's rows are sums of the others', so the
                       projection is that of edges, not of nodes */
                    if (!block.cell)
                        CHECK_NEAR(got[6 * r + c], sum, 4e-15 * largest);
                }
        }
    }
}

/* The same for cells, in the edges, where the projection is made: rows and
 * columns of nodes b and c. */
static void projected_cells_are_the_eigenvalues(void **state)
{
    (void)state;
    Random random = {17};
    for (int n = 0; n < 900; n++) {
        double x[6], g[6], H[36], got[36];
        Block block = random_block(&random, 2, x);
        if (n == 0) {
            const double corner[6] = {0, 0, 0.1, 0, 0, 0.1};
            memcpy(x, corner, sizeof x);
            block.area = 0.5;
        }
        block_derivatives(&block, x, FILTER_NONE, g, H);
        for (int f = 0; f < 2; f++) {
            long double a[16], q[16], largest = 0;
            block_derivatives(&block, x, f ? FILTER_ABS : FILTER_CLAMP, g, got);
            for (int r = 0; r < 4; r++)
                for (int c = 0; c < 4; c++)
                    a[4 * r + c] = H[6 * (2 + r) + 2 + c];
            jacobi(4, a, q);
            for (int i = 0; i < 4; i++)
                largest = fmaxl(largest, fabsl(a[5 * i]));
            for (int r = 0; r < 4; r++)
                for (int c = 0; c < 4; c++) {
                    long double sum = 0;
                    for (int i = 0; i < 4; i++)
                        sum += (f ? fabsl(a[5 * i]) : fmaxl(a[5 * i], 0)) *
                               q[4 * r + i] * q[4 * c + i];
                    CHECK_NEAR(got[6 * (2 + r) + 2 + c], sum, 4e-15 * largest);
                }
            for (int r = 0; r < 6; r++) /* a common motion changes nothing */
                for (int c = 0; c < 2; c++)
                    CHECK_NEAR(got[6 * r + c] + got[6 * r + 2 + c] +
                                   got[6 * r + 4 + c],
                               0, 8e-16 * largest);
        }
    }
}

static void products_are_the_entries(void **state)
{
    (void)state;
    Random random = {18};
    for (int n = 0; n < 300; n++) {
        double x[6], q[6], y[6] = {0}, full[36], h[CELL_ENTRIES], largest = 0;
        Block block = random_block(&random, 2, x);
        Corner corner = block_corner(&block, x);
        cell_hessian(&corner, n % 2 ? FILTER_CLAMP : FILTER_NONE, h);
        whole_cell(h, full);
        for (int i = 0; i < 6; i++)
            q[i] = random_uniform(&random, -1, 1);
        cell_multiply(h, (int[3]){0, 1, 2}, q, y);
        for (int i = 0; i < 36; i++)
            largest = fmax(largest, fabs(full[i]));
        for (int r = 0; r < 6; r++) {
            double sum = 0;
            for (int c = 0; c < 6; c++)
                sum += full[6 * r + c] * q[c];
            CHECK_NEAR(y[r], sum, 4e-15 * largest);
        }
    }
}

/* What reach, remainder and the step's gap are for a block and a step p. */
static double block_reach(const Block *block, const double x[6],
                          const double p[6])
{
    double P1[2] = {p[2] - p[0], p[3] - p[1]};
    double P2[2] = {p[4] - p[0], p[5] - p[1]}, J1, J2;
    if (block->cell) {
        Corner corner = block_corner(block, x);
        cell_along(&corner, P1, P2, &J1, &J2);
        return cell_reach(corner.J, J1, J2);
    }
    Gap gap = block_gap(block, x);
    bool wall = block->obstacle.kind == OBSTACLE_WALL;
    double P[2] = {p[0] - (wall ? 0 : p[2]), p[1] - (wall ? 0 : p[3])};
    return contact_reach(&gap, P);
}

static double block_remainder(const Block *block, const double x[6],
                              const double p[6], double alpha)
{
    double P1[2] = {p[2] - p[0], p[3] - p[1]};
    double P2[2] = {p[4] - p[0], p[5] - p[1]}, J1, J2;
    if (block->cell) {
        Corner corner = block_corner(block, x);
        cell_along(&corner, P1, P2, &J1, &J2);
        return cell_remainder(&corner, alpha * J1, alpha * alpha * J2);
    }
    Gap gap = block_gap(block, x);
    bool wall = block->obstacle.kind == OBSTACLE_WALL;
    double P[2] = {alpha * (p[0] - (wall ? 0 : p[2])),
                   alpha * (p[1] - (wall ? 0 : p[3]))};
    return contact_remainder(&block->barrier, &gap, P);
}

/* The distance or area ratio at x + alpha p, over its value at x. */
static long double share_left(const Block *block, const double x[6],
                              const double p[6], double alpha)
{
    long double now[6], then[6], left[2];
    for (int i = 0; i < 6; i++) {
        now[i] = x[i];
        then[i] = x[i] + (long double)alpha * p[i];
    }
    for (int k = 0; k < 2; k++) {
        const long double *y = k ? then : now;
        if (block->cell)
            left[k] =
                (y[2] - y[0]) * (y[5] - y[1]) - (y[3] - y[1]) * (y[4] - y[0]);
        else if (block->obstacle.kind == OBSTACLE_WALL)
            left[k] = block->obstacle.n[0] * (y[0] - block->obstacle.o[0]) +
                      block->obstacle.n[1] * (y[1] - block->obstacle.o[1]);
        else
            left[k] = hypotl(y[0] - y[2], y[1] - y[3]) - block->obstacle.radius;
    }
    return left[1] / left[0];
}

/* At the limit a tenth is left, before it more; where there is no limit never
 * less. */
static void limits_leave_a_tenth(void **state)
{
    (void)state;
    Random random = {19};
    int limited = 0, free_ways = 0;
    for (int n = 0; n < 6000; n++) {
        double x[6], p[6];
        Block block = random_block(&random, n % 3, x);
        double size = random_logarithmic(&random, 1e-6, 1e3);
        for (int i = 0; i < 6; i++)
            p[i] = size * random_uniform(&random, -1, 1);
        double reach = block_reach(&block, x, p);
        CHECK(reach > 0);
        bool limit = isfinite(reach);
        limited += limit;
        free_ways += !limit;
        /* x and alpha p have lost eps of themselves against the gap */
        double away = (limit ? reach : 1) * size;
        double lost =
            1e-8 + 1e-14 * away * (1 + away) / pow(block_length(&block, x), 2);
        if (limit)
            CHECK_NEAR(share_left(&block, x, p, reach), 1 - CONTACT_LIMIT,
                       lost);
        for (int k = 1; k < 40; k++) {
            double alpha = limit ? reach * k / 40 : k / 40.0;
            CHECK(share_left(&block, x, p, alpha) >= 1 - CONTACT_LIMIT - lost);
        }
    }
    CHECK(limited > 1000);
    CHECK(free_ways > 1000);
}

/* Against differences of the energy in long double while these have digits,
 * and against half of p.H p for steps that are tiny. */
static void remainders_of_blocks_are_exact(void **state)
{
    (void)state;
    Random random = {20};
    int compared = 0;
    for (int n = 0; n < 3000; n++) {
        double x[6], p[6], g[6], H[36];
        long double y[6], slope = 0, curvature = 0, size = 0;
        Block block = random_block(&random, n % 3, x);
        for (int i = 0; i < 6; i++)
            p[i] = random_uniform(&random, -1, 1);
        double reach = fmin(1, block_reach(&block, x, p));
        double alpha = reach * random_logarithmic(&random, 1e-3, 1);
        block_derivatives(&block, x, FILTER_NONE, g, H);
        for (int i = 0; i < 6; i++) {
            y[i] = x[i];
            slope += (long double)g[i] * p[i];
            for (int j = 0; j < 6; j++) {
                curvature += (long double)p[i] * H[6 * i + j] * p[j];
                size += fabsl((long double)p[i] * H[6 * i + j] * p[j]);
            }
        }
        long double start = block_value(&block, y);
        for (int i = 0; i < 6; i++)
            y[i] += (long double)alpha * p[i];
        long double exact = block_value(&block, y) - start - alpha * slope;
        double got = block_remainder(&block, x, p, alpha);
        /* the gap, and with it g, has lost eps of the coordinates */
        long double lost = (1e-13L + 4e-15L / block_length(&block, x)) *
                           (fabsl(alpha * slope) + start + fabsl(exact));
        if (lost < 1e-5L * fabsl(exact)) {
            compared++;
            CHECK_NEAR(got, exact, lost);
        }
        double tiny = 1e-7 * block_length(&block, x);
        CHECK_NEAR(block_remainder(&block, x, p, tiny),
                   0.5L * tiny * tiny * curvature, 1e-5L * tiny * tiny * size);
    }
    CHECK(compared > 1500);
}

/* Below its yield strain a plastic spring is the elastic one, beyond it has
 * the eigenvalues 2 k tau and (2k/l2) (2 tau' q + l2 tau). */
static void plastic_hessian_is_projected(void **state)
{
    (void)state;
    Random random = {21};
    for (int n = 0; n < 3000; n++) {
        double rest = random_logarithmic(&random, 0.1, 10), k = 3;
        double l = sqrt(rest) * random_uniform(&random, 0.2, 1.8);
        double angle = random_uniform(&random, 0, 6.28), H[3], elastic[3];
        double d[2] = {l * cos(angle), l * sin(angle)};
        double e = (d[0] * d[0] + d[1] * d[1]) / rest - 1;
        SpringLaw stiff = {10, 0.9, 0, 0},
                  law = {0.1, 0.9, n % 2 ? 0.7 : 0, 0.3};
        Filter filter = (Filter)(n % 3);
        spring_law_hessian(stiff, d, rest, k, e, filter, H);
        spring_hessian(d, rest, k, filter, elastic);
        double size = 9 * k / rest * fmax(l * l, rest);
        for (int i = 0; i < 3; i++)
            CHECK_NEAR(H[i], elastic[i], 4e-15 * size);
        spring_law_hessian(law, d, rest, k, e, filter, H);
        double tau = spring_law_slope(law, e);
        double bend = spring_law_curvature(law, e);
        double along = 2 * k / rest * (2 * bend * l * l + rest * tau);
        double across = 2 * k * tau;
        if (filter == FILTER_CLAMP) {
            along = fmax(along, 0);
            across = fmax(across, 0);
        } else if (filter == FILTER_ABS) {
            along = fabs(along);
            across = fabs(across);
        }
        double c = d[0] / l, s = d[1] / l;
        CHECK_NEAR(H[0], along * c * c + across * s * s, 8e-15 * size);
        CHECK_NEAR(H[1], (along - across) * c * s, 8e-15 * size);
        CHECK_NEAR(H[2], along * s * s + across * c * c, 8e-15 * size);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(derivatives_of_the_scalars),
        cmocka_unit_test(scalars_are_continuous),
        cmocka_unit_test(log1p_minus_is_exact),
        cmocka_unit_test(remainders_are_exact),
        cmocka_unit_test(remainders_of_pieces_are_exact),
        cmocka_unit_test(remainders_of_flow_are_exact),
        cmocka_unit_test(derivatives_of_the_blocks),
        cmocka_unit_test(projections_are_the_eigenvalues),
        cmocka_unit_test(projected_cells_are_the_eigenvalues),
        cmocka_unit_test(products_are_the_entries),
        cmocka_unit_test(limits_leave_a_tenth),
        cmocka_unit_test(remainders_of_blocks_are_exact),
        cmocka_unit_test(plastic_hessian_is_projected),
    };
    return cmocka_run_group_tests_name("barrier", tests, NULL, NULL);
}
