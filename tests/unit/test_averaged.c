/* The energy of average vector field steps, against Gauss's rule with two
 * points, which is exact for its cubic integrands; and both energies as
 * polynomials along a line and in a plane.
 */
#include "model/pull_energy.h"
#include "testing.h"

#include <stdlib.h>
#include <math.h>

#include "model/mass_spring_energy.h"

/* A random system on its way from x_n to x_n + u. */
typedef struct Way {
    System system;
    double x_n[MAX_SIZE], u[MAX_SIZE], x[MAX_SIZE], u_tilde[MAX_SIZE];
    double p[MAX_SIZE]; /* a direction */
    IncrementalPotential E;
    int size;
} Way;

static void way_create(Random *random, SpringState state, bool averaged,
                       Way *way)
{
    random_system(random, state, &way->system, way->x_n);
    central_field_set(&way->system, random_uniform(random, 0, 3));
    way->size = 2 * way->system.nodes;
    for (int i = 0; i < way->size; i++) {
        way->u[i] = random_uniform(random, -1, 1);
        way->x[i] = way->x_n[i] + way->u[i];
        way->u_tilde[i] = random_uniform(random, -1, 1);
        way->p[i] = random_uniform(random, -1, 1);
    }
    way->E = (IncrementalPotential){
        .system = &way->system,
        .weight = 0.7,
        .x_n = way->x_n,
        .u_tilde = way->u_tilde,
        .averaged = averaged,
    };
}

/* sum m/2 |u - u_tilde|^2 */
static long double inertia(const Way *way, const double *u)
{
    long double sum = 0;
    for (int i = 0; i < way->size; i++) {
        long double away = (long double)u[i] - way->u_tilde[i];
        sum += 0.5L * way->system.m[i / 2] * away * away;
    }
    return sum;
}

/* Value, gradient and Hessian (NULL: not wanted) at x_n + u:
 *   Phi = integral of (P(x_n + t u) - P(x_n)) / t, t = 0 ... 1,
 *   gradient: of grad P(x_n + t u), Hessian: of t times that of P. */
static long double exact_average(const Way *way, const double *u,
                                 long double *g, long double *H)
{
    int size = way->size;
    long double value = inertia(way, u);
    for (int i = 0; g && i < size; i++) {
        g[i] = way->system.m[i / 2] * ((long double)u[i] - way->u_tilde[i]);
        for (int j = 0; H && j < size; j++)
            H[size * i + j] = i == j ? way->system.m[i / 2] : 0;
    }
    for (int point = -1; point <= 1; point += 2) {
        long double t = 0.5L + point * 0.5L / sqrtl(3);
        long double gt[MAX_SIZE], Ht[MAX_SIZE * MAX_SIZE];
        double y[MAX_SIZE];
        for (int i = 0; i < size; i++)
            y[i] = (double)(way->x_n[i] + t * u[i]);
        value += (exact_energy(&way->E, NULL, y, -1, -1).f -
                  exact_energy(&way->E, NULL, way->x_n, -1, -1).f) /
                 (2 * t);
        if (!g)
            continue;
        exact_derivatives(&way->E, NULL, y, gt, H ? Ht : NULL);
        for (int i = 0; i < size; i++) {
            g[i] += gt[i] / 2;
            for (int j = 0; H && j < size; j++)
                H[size * i + j] += t * Ht[size * i + j] / 2;
        }
    }
    return value;
}

/* E(u), averaged or not. */
static long double exact_value(const Way *way, const double *u)
{
    double x[MAX_SIZE];
    if (way->E.averaged)
        return exact_average(way, u, NULL, NULL);
    for (int i = 0; i < way->size; i++)
        x[i] = way->x_n[i] + u[i];
    return exact_energy(&way->E, u, x, -1, -1).f;
}

static long double largest(int count, const long double *values)
{
    long double result = 0;
    for (int i = 0; i < count; i++)
        result = fmaxl(result, fabsl(values[i]));
    return result;
}

static void assemble(const Way *way, Filter filter, double *dense)
{
    Sparse A;
    int *slot;
    Iterate at = {.E = way->E, .u = (double *)way->u, .x = (double *)way->x};
    CHECK_STATUS(incremental_potential_pattern(&way->system, &A, &slot),
                 STATUS_OK);
    incremental_potential_hessian(&at, filter, slot, &A);
    dense_from_sparse(&A, dense);
    sparse_free(&A);
    free(slot);
}

/* 1e-13 of the largest: rounding of the points of Gauss's rule. */
static void averages_are_right(void **unused)
{
    (void)unused;
    Random random = {90};
    for (int trial = 0; trial < 50; trial++) {
        Way way;
        double g[MAX_SIZE], H[MAX_SIZE * MAX_SIZE];
        long double exact_g[MAX_SIZE], exact_H[MAX_SIZE * MAX_SIZE];
        way_create(&random, (SpringState)(trial % SPRINGS_NEAR_ZERO), true,
                   &way);
        int size = way.size;
        long double value = exact_average(&way, way.u, exact_g, exact_H);
        long double scale = fabsl(value) + inertia(&way, way.u);
        CHECK_NEAR(incremental_potential_value(&way.E, way.u, way.x), value,
                   1e-13L * scale);
        incremental_potential_gradient(&way.E, way.u, way.x, g);
        scale = largest(size, exact_g);
        for (int i = 0; i < size; i++)
            CHECK_NEAR(g[i], exact_g[i], 1e-13L * scale);
        assemble(&way, FILTER_NONE, H);
        scale = largest(size * size, exact_H);
        for (int i = 0; i < size * size; i++)
            CHECK_NEAR(H[i], exact_H[i], 1e-13L * scale);
        system_free(&way.system);
    }
}

/* Projected: still symmetric, and H+ - H is positive semi-definite, seen with
 * random vectors; 1e-12 of the norms: rounding. */
static void projected_averages_are_above(void **unused)
{
    (void)unused;
    Random random = {91};
    for (int trial = 0; trial < 50; trial++) {
        Way way;
        double H[MAX_SIZE * MAX_SIZE], plus[MAX_SIZE * MAX_SIZE];
        way_create(&random, (SpringState)(trial % SPRINGS_NEAR_ZERO), true,
                   &way);
        assemble(&way, FILTER_NONE, H);
        assemble(&way, FILTER_CLAMP, plus);
        for (int vector = 0; vector < 20; vector++) {
            double y[MAX_SIZE], of_H = 0, of_plus = 0, masses = 0, size = 0;
            for (int i = 0; i < way.size; i++) {
                y[i] = random_uniform(&random, -1, 1);
                masses += way.system.m[i / 2] * y[i] * y[i];
            }
            for (int i = 0; i < way.size; i++)
                for (int j = 0; j < way.size; j++) {
                    of_H += y[i] * H[way.size * i + j] * y[j];
                    of_plus += y[i] * plus[way.size * i + j] * y[j];
                    size += fabs(H[way.size * i + j]);
                }
            CHECK_AT_MOST(of_H, of_plus + 1e-12 * size);
            CHECK_AT_MOST(masses, of_plus + 1e-12 * size);
        }
        system_free(&way.system);
    }
}

/* E(u + a p) - E(u) in extended precision. */
static long double exact_difference(const Way *way, double a)
{
    double moved[MAX_SIZE];
    for (int i = 0; i < way->size; i++)
        moved[i] = way->u[i] + a * way->p[i];
    return exact_value(way, moved) - exact_value(way, way->u);
}

/* Everything of order 1: 1e-12 of the energies is the rounding of u. */
static void check_polynomials(bool averaged)
{
    Random random = {92};
    for (int trial = 0; trial < 40; trial++) {
        Way way;
        double g[MAX_SIZE];
        way_create(&random, (SpringState)(trial % SPRINGS_NEAR_ZERO), averaged,
                   &way);
        incremental_potential_gradient(&way.E, way.u, way.x, g);
        Iterate at = {way.E, way.u, way.x, g, way.p};
        Quartic along = incremental_potential_along(&at, 1).smooth;
        for (int i = 0; i < 12; i++) {
            double a = random_uniform(&random, -1, 1);
            long double line = exact_difference(&way, a);
            long double scale = fabsl(line) + fabsl(exact_value(&way, way.u));
            CHECK_NEAR(quartic_value(&along, a), line, 1e-12L * scale);
        }
        system_free(&way.system);
    }
}

static void polynomials_are_the_energy(void **unused)
{
    (void)unused;
    check_polynomials(false);
}

static void polynomials_are_the_averaged_energy(void **unused)
{
    (void)unused;
    check_polynomials(true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(averages_are_right),
        cmocka_unit_test(projected_averages_are_above),
        cmocka_unit_test(polynomials_are_the_energy),
        cmocka_unit_test(polynomials_are_the_averaged_energy),
    };
    return cmocka_run_group_tests_name("averaged", tests, NULL, NULL);
}
