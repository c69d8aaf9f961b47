/* Projection of a spring's Hessian: the closed form, the 4x4 form of the
 * slide, and what both promise.
 */
#include "testing.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "model/mass_spring_energy.h"

/* [[H, -H], [-H, H]] */
static void block_from_spring(const double H[3], double a[16])
{
    const double full[4] = {H[0], H[1], H[1], H[2]};
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            a[4 * r + c] =
                (r / 2 == c / 2 ? 1 : -1) * full[2 * (r % 2) + c % 2];
}

static double frobenius(const double a[16], const double b[16])
{
    double sum = 0;
    for (int i = 0; i < 16; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(sum);
}

static double norm(const double a[16])
{
    const double zero[16] = {0};
    return frobenius(a, zero);
}

/* Whether A + shift I has a Cholesky factor. */
static bool is_positive(const double a[16], double shift)
{
    long double L[16] = {0};
    for (int r = 0; r < 4; r++)
        for (int c = 0; c <= r; c++) {
            long double sum = a[4 * r + c] + (r == c ? (long double)shift : 0);
            for (int i = 0; i < c; i++)
                sum -= L[4 * r + i] * L[4 * c + i];
            if (r == c && !(sum > 0))
                return false;
            L[4 * r + c] = r == c ? sqrtl(sum) : sum / L[5 * c];
        }
    return true;
}

/* A random spring with |d|/l = ratio in a random direction. */
static double random_spring(Random *random, double ratio, double d[2],
                            double *k)
{
    double l = random_logarithmic(random, 1e-3, 1e3);
    double angle = random_uniform(random, 0, 6.28);
    d[0] = ratio * l * cos(angle);
    d[1] = ratio * l * sin(angle);
    *k = random_logarithmic(random, 1e-6, 1e6);
    return l * l;
}

/* Symmetric, entries -1 ... 1. */
static void random_block(Random *random, double a[16])
{
    for (int r = 0; r < 4; r++)
        for (int c = r; c < 4; c++)
            a[4 * r + c] = a[4 * c + r] = random_uniform(random, -1, 1);
}

/* B B^T with B random: positive semi-definite, of rank 1 ... 4. */
static void random_psd(Random *random, double scale, double a[16])
{
    double b[16];
    int rank = 1 + random_below(random, 4);
    for (int i = 0; i < 16; i++)
        b[i] = i % 4 < rank ? random_uniform(random, -1, 1) : 0;
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            a[4 * r + c] = 0;
            for (int i = 0; i < 4; i++)
                a[4 * r + c] += scale * b[4 * r + i] * b[4 * c + i];
        }
}

/* 1e-13 of the norm: Jacobi's rounding is about 1e-15. */
static void closed_form_is_the_4x4_form(void **unused)
{
    (void)unused;
    Random random = {1};
    for (int trial = 0; trial < 3000; trial++) {
        double d[2], k, H[3], plain[16], closed[16], general[16];
        double ratio = trial % 3 ? random_uniform(&random, 0, 1.5)
                                 : random_logarithmic(&random, 1e-9, 1);
        double l2 = random_spring(&random, ratio, d, &k);
        spring_hessian(d, l2, k, FILTER_NONE, H);
        block_from_spring(H, plain);
        memcpy(general, plain, sizeof plain);
        make_psd(general);
        spring_hessian(d, l2, k, FILTER_CLAMP, H);
        block_from_spring(H, closed);
        CHECK_AT_MOST(frobenius(closed, general), 1e-13 * norm(plain));
    }
}

/* Eigenvalues 0, 0, 2 lambda(H) as in the formulas; 1e-14: a few roundings of
 * numbers of the size of k. */
static void spring_hessian_has_its_eigenvalues(void **unused)
{
    (void)unused;
    Random random = {2};
    for (int trial = 0; trial < 1000; trial++) {
        double d[2], k, H[3];
        double ratio = random_uniform(&random, 0.01, 2);
        double l2 = random_spring(&random, ratio, d, &k);
        double d2 = d[0] * d[0] + d[1] * d[1];
        double along = 2 * k / l2 * (3 * d2 - l2);
        double across = 2 * k / l2 * (d2 - l2);
        spring_hessian(d, l2, k, FILTER_NONE, H);
        CHECK_NEAR(H[0] * d[0] + H[1] * d[1], along * d[0],
                   1e-14 * 20 * k * sqrt(d2));
        CHECK_NEAR(H[1] * d[0] + H[2] * d[1], along * d[1],
                   1e-14 * 20 * k * sqrt(d2));
        CHECK_NEAR(H[0] + H[2], along + across, 1e-14 * 20 * k);
    }
}

/* -1e-14 of the norm is what rounding leaves of an eigenvalue 0. */
static void results_are_positive_semidefinite(void **unused)
{
    (void)unused;
    Random random = {3};
    for (int trial = 0; trial < 3000; trial++) {
        double d[2], k, H[3], a[16];
        double l2 =
            random_spring(&random, random_uniform(&random, 0, 1.5), d, &k);
        bool cut = spring_hessian(d, l2, k, FILTER_CLAMP, H);
        block_from_spring(H, a);
        CHECK(is_positive(a, 1e-14 * k * 10));
        CHECK(cut == (d[0] * d[0] + d[1] * d[1] < l2));
        random_block(&random, a);
        double scale = norm(a);
        make_psd(a);
        CHECK(is_positive(a, 1e-14 * scale));
        for (int i = 0; i < 16; i++)
            CHECK(a[i] == a[4 * (i % 4) + i / 4]);
    }
}

static void blocks_that_are_psd_stay(void **unused)
{
    (void)unused;
    Random random = {4};
    for (int trial = 0; trial < 1000; trial++) {
        double d[2], k, H[3], plain[3], a[16], before[16];
        double l2 =
            random_spring(&random, random_uniform(&random, 1.001, 3), d, &k);
        spring_hessian(d, l2, k, FILTER_NONE, plain);
        CHECK(!spring_hessian(d, l2, k, FILTER_CLAMP, H));
        CHECK_SAME_BITS(H, plain, 3);
        block_from_spring(H, a);
        memcpy(before, a, sizeof a);
        make_psd(a);
        CHECK_SAME_BITS(a, before, 16);
        random_psd(&random, random_logarithmic(&random, 1e-6, 1e6), a);
        for (int i = 0; i < 4; i++)
            a[5 * i] *= 1 + 1e-12; /* no eigenvalue is -rounding */
        memcpy(before, a, sizeof a);
        make_psd(a);
        CHECK_SAME_BITS(a, before, 16);
    }
}

/* No positive semi-definite matrix is nearer: neither one of its own making,
 * nor a small change of the answer; 1e-12: rounding of the two distances. */
static void check_nearest(Random *random, const double plain[16],
                          const double answer[16])
{
    double distance = frobenius(plain, answer), scale = norm(plain);
    for (int trial = 0; trial < 40; trial++) {
        double other[16], change[16];
        random_psd(random, scale * random_logarithmic(random, 1e-6, 1), other);
        CHECK_AT_MOST(distance, frobenius(plain, other) + 1e-12 * scale);
        for (int i = 0; i < 16; i++)
            change[i] = answer[i] + other[i]; /* a sum of two is one too */
        CHECK_AT_MOST(distance, frobenius(plain, change) + 1e-12 * scale);
        for (int i = 0; i < 16; i++)
            change[i] = answer[i] * random_uniform(random, 0.9, 1.1);
        double factor = change[0] / (answer[0] != 0 ? answer[0] : 1);
        for (int i = 0; i < 16; i++) /* so is a multiple, and a mean */
            change[i] = 0.99 * factor * answer[i] + 0.01 * other[i];
        CHECK_AT_MOST(distance, frobenius(plain, change) + 1e-12 * scale);
    }
}

static void results_are_nearest(void **unused)
{
    (void)unused;
    Random random = {5};
    for (int trial = 0; trial < 300; trial++) {
        double plain[16], answer[16], d[2], k, H[3];
        random_block(&random, plain);
        memcpy(answer, plain, sizeof plain);
        make_psd(answer);
        check_nearest(&random, plain, answer);
        double l2 =
            random_spring(&random, random_uniform(&random, 0, 1), d, &k);
        spring_hessian(d, l2, k, FILTER_NONE, H);
        block_from_spring(H, plain);
        spring_hessian(d, l2, k, FILTER_CLAMP, H);
        block_from_spring(H, answer);
        check_nearest(&random, plain, answer);
    }
}

/* A = A+ - (-A)+ and A+ (-A)+ = 0: together the eigenvalues of both signs,
 * with their vectors; 1e-14: Jacobi's rounding. */
static void positive_and_negative_parts_rebuild(void **unused)
{
    (void)unused;
    Random random = {6};
    for (int trial = 0; trial < 2000; trial++) {
        double a[16], plus[16], minus[16], sum[16];
        random_block(&random, a);
        double scale = random_logarithmic(&random, 1e-100, 1e100);
        for (int i = 0; i < 16; i++) {
            plus[i] = a[i] *= scale;
            minus[i] = -a[i];
        }
        make_psd(plus);
        make_psd(minus);
        for (int i = 0; i < 16; i++)
            sum[i] = plus[i] - minus[i];
        CHECK_AT_MOST(frobenius(sum, a) / scale, 1e-14);
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++) {
                double product = 0;
                for (int i = 0; i < 4; i++)
                    product += plus[4 * r + i] / scale * minus[4 * i + c];
                CHECK_NEAR(product / scale, 0, 1e-14);
            }
    }
}

static void no_length_gives_zero(void **unused)
{
    (void)unused;
    const double d[2] = {0, 0}, zero[16] = {0};
    double H[3], a[16];
    CHECK(spring_hessian(d, 2, 3, FILTER_CLAMP, H));
    CHECK(H[0] == 0 && H[1] == 0 && H[2] == 0);
    spring_hessian(d, 2, 3, FILTER_NONE, H);
    CHECK(H[0] == -6 && H[1] == 0 && H[2] == -6);
    block_from_spring(H, a);
    make_psd(a);
    CHECK(frobenius(a, zero) == 0);
    make_psd(a);
    CHECK(frobenius(a, zero) == 0);
}

/* At |d|^2 = l2 one eigenvalue is 0, at l2/3 the other; both forms must agree
 * on either side of it and be continuous there. */
static void borders_are_continuous(void **unused)
{
    (void)unused;
    const double borders[] = {1, sqrt(1.0 / 3)};
    for (int b = 0; b < 2; b++)
        for (int ulps = -3; ulps <= 3; ulps++) {
            double d[2] = {borders[b] * (1 + ulps * DBL_EPSILON), 0};
            double H[3], across[3];
            spring_hessian(d, 1, 1, FILTER_CLAMP, H);
            CHECK_NEAR(H[0], b == 0 ? 4 : 0, 3e-14);
            CHECK(H[0] >= 0 && H[1] == 0 && H[2] >= 0);
            CHECK_NEAR(H[2], 0, 3e-14);
            const double turned[2] = {0, d[0]};
            spring_hessian(turned, 1, 1, FILTER_CLAMP, across);
            CHECK(across[0] == H[2] && across[2] == H[0]);
        }
    const double d[2] = {1, 0};
    double H[3];
    CHECK(!spring_hessian(d, 1, 1, FILTER_CLAMP,
                          H)); /* exactly at rest: not cut */
    CHECK(H[0] == 4 && H[1] == 0 && H[2] == 0);
}

/* Diagonal blocks are their own eigenvalues. */
static void diagonal_blocks_are_cut_exactly(void **unused)
{
    (void)unused;
    double a[16] = {0};
    a[0] = -1;
    a[5] = 2;
    a[10] = -3e-9;
    a[15] = 4;
    make_psd(a);
    for (int i = 0; i < 16; i++)
        CHECK(a[i] == (i == 5 ? 2 : i == 15 ? 4 : 0));
}

/* |H| is the positive semi-definite matrix with |H|^2 = H^2: for the spring's
 * closed form and for any 2x2 matrix. */
static void check_absolute(const double H[3], const double A[3])
{
    double scale = fabs(H[0]) + fabs(H[1]) + fabs(H[2]) + DBL_MIN;
    double square = scale * scale;
    for (int i = 0; i < 2; i++) {
        const double *d = i == 0 ? H : A;
        CHECK(isfinite(d[0] + d[1] + d[2]));
    }
    /* A few roundings of each product. */
    CHECK_NEAR(A[0] * A[0] + A[1] * A[1], H[0] * H[0] + H[1] * H[1],
               1e-13 * square);
    CHECK_NEAR(A[1] * (A[0] + A[2]), H[1] * (H[0] + H[2]), 1e-13 * square);
    CHECK_NEAR(A[2] * A[2] + A[1] * A[1], H[2] * H[2] + H[1] * H[1],
               1e-13 * square);
    CHECK_AT_MOST(-(A[0] + A[2]), 0);
    CHECK_AT_MOST(A[1] * A[1] - A[0] * A[2], 1e-13 * square);
}

static void absolute_values_are_right(void **unused)
{
    (void)unused;
    Random random = {11};
    for (int i = 0; i < 2000; i++) {
        double d[2], k, H[3], A[3];
        double ratio = i % 10 == 0 ? 0 : random_uniform(&random, 0, 1.5);
        double l2 = random_spring(&random, ratio, d, &k);
        spring_hessian(d, l2, k, FILTER_NONE, H);
        bool changed = spring_hessian(d, l2, k, FILTER_ABS, A);
        check_absolute(H, A);
        CHECK(changed == (d[0] * d[0] + d[1] * d[1] < l2));
        if (!changed)
            CHECK_SAME_BITS(A, H, 3);
        for (int c = 0; c < 3; c++)
            A[c] = H[c] = random_uniform(&random, -1, 1);
        if (!filter_2x2(FILTER_ABS, A))
            CHECK_SAME_BITS(A, H, 3);
        check_absolute(H, A);
    }
}

static void filters_do_what_they_say(void **unused)
{
    (void)unused;
    const double d[2] = {0.3, 0.1}, mixed[3] = {1, 0, -2};
    double H[3], plain[3];
    spring_hessian(d, 1, 2, FILTER_NONE, plain);
    CHECK(spring_hessian(d, 1, 2, FILTER_CLAMP, H) && H[0] == 0);
    CHECK(!spring_hessian(d, 1, 2, FILTER_NONE, H));
    CHECK_SAME_BITS(H, plain, 3);
    CHECK(!spring_hessian(d, 1, 2, FILTER_ON_DEMAND, H));
    CHECK_SAME_BITS(H, plain, 3);
    for (int filter = 0; filter < FILTER_COUNT; filter++) {
        const double last[FILTER_COUNT] = {[FILTER_CLAMP] = 0,
                                           [FILTER_NONE] = -2,
                                           [FILTER_ABS] = 2,
                                           [FILTER_ON_DEMAND] = -2};
        memcpy(H, mixed, sizeof H);
        CHECK(filter_2x2((Filter)filter, H) == (last[filter] > -2));
        CHECK_NEAR(H[0], 1, 1e-15);
        CHECK_NEAR(H[2], last[filter], 1e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_form_is_the_4x4_form),
        cmocka_unit_test(spring_hessian_has_its_eigenvalues),
        cmocka_unit_test(results_are_positive_semidefinite),
        cmocka_unit_test(blocks_that_are_psd_stay),
        cmocka_unit_test(results_are_nearest),
        cmocka_unit_test(positive_and_negative_parts_rebuild),
        cmocka_unit_test(no_length_gives_zero),
        cmocka_unit_test(borders_are_continuous),
        cmocka_unit_test(diagonal_blocks_are_cut_exactly),
        cmocka_unit_test(absolute_values_are_right),
        cmocka_unit_test(filters_do_what_they_say),
    };
    return cmocka_run_group_tests_name("psd", tests, NULL, NULL);
}
