/* Gradient against value and Hessian against gradient, for each energy and
 * for their sum; and the checker itself against kernels that are wrong.
 */
#include "model/pull_energy.h"
#include "testing.h"

#include <stdlib.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "model/inertia_energy.h"
#include "model/mass_spring_energy.h"

/* An energy at random springs, and what is wrong with it. */
typedef enum Part { TERM_INERTIA, TERM_SPRINGS, TERM_CENTRAL, TERM_SUM } Part;

typedef enum Fault {
    FAULT_NONE,
    FAULT_SIGN,           /* of one component of the gradient */
    FAULT_FACTOR,         /* gradient 1 + 1e-9 times too large */
    FAULT_MISSING_SPRING, /* in gradient and Hessian, not in the value */
    FAULT_NO_GEOMETRY,    /* Hessian without the term 2 k s I */
    FAULT_HESSIAN_FACTOR, /* Hessian 1 + 1e-9 times too large */
    FAULT_ASYMMETRIC,     /* by one unit in the last place */
    FAULT_VALUE_FACTOR,   /* value 1 + 1e-9 times too large */
    FAULT_NAN_VALUE,
    FAULT_NAN_GRADIENT,
    FAULT_NAN_HESSIAN,
    FAULT_COUNT
} Fault;

/* x_n = 0, so that u = x. */
typedef struct Energy {
    Part part;
    Fault fault;
    System system;
    double x_n[MAX_SIZE], x_tilde[MAX_SIZE];
    IncrementalPotential E;
} Energy;

/* The energy as the checker sees it. */
typedef struct Kernel {
    int size;
    double (*value)(const Energy *energy, const double *x);
    void (*gradient)(const Energy *energy, const double *x, double *g);
    void (*hessian)(const Energy *energy, const double *x, double *H);
    const Energy *energy;
} Kernel;

static double energy_value(const Energy *energy, const double *x)
{
    const System *system = &energy->system;
    Place at = place_at(system, energy->x_n, x, x);
    double value = 0;
    if (energy->part == TERM_INERTIA)
        value =
            inertia_energy_value(system->nodes, x, energy->x_tilde, system->m);
    else if (energy->part == TERM_SPRINGS)
        value = energy->E.weight * mass_spring_energy.value(&at);
    else if (energy->part == TERM_CENTRAL)
        value = energy->E.weight * system_potential(system, x);
    else
        value = incremental_potential_value(&energy->E, x, x);
    if (energy->fault == FAULT_VALUE_FACTOR)
        value *= 1 + 1e-9;
    return energy->fault == FAULT_NAN_VALUE ? NAN : value;
}

static void energy_gradient(const Energy *energy, const double *x, double *g)
{
    const System *system = &energy->system;
    System fewer = *system;
    IncrementalPotential E = energy->E;
    E.system = &fewer;
    fewer.springs -= energy->fault == FAULT_MISSING_SPRING;
    Place at = place_at(&fewer, energy->x_n, x, x);
    at.term = system_find_term(system, &central_field);
    at.w = E.weight;
    for (int i = 0; i < 2 * system->nodes; i++)
        g[i] = 0;
    if (energy->part == TERM_INERTIA)
        inertia_energy_gradient(system->nodes, x, energy->x_tilde, system->m,
                                g);
    else if (energy->part == TERM_SPRINGS)
        mass_spring_energy.gradient(&at, g);
    else if (energy->part == TERM_CENTRAL)
        central_field.gradient(&at, g);
    else
        incremental_potential_gradient(&E, x, x, g);
    if (energy->fault == FAULT_SIGN)
        g[3] = -g[3];
    for (int i = 0; energy->fault == FAULT_FACTOR && i < 2 * system->nodes; i++)
        g[i] *= 1 + 1e-9;
    if (energy->fault == FAULT_NAN_GRADIENT)
        g[2] = NAN;
}

/* Without 2 k s I on both diagonal blocks, and its mirror images. */
static void drop_geometry(const Energy *energy, const double *x, double *H)
{
    const System *system = &energy->system;
    int size = 2 * system->nodes;
    for (int s = 0; s < system->springs; s++)
        for (int axis = 0; axis < 2; axis++) {
            int i = 2 * system->e[2 * s], j = 2 * system->e[2 * s + 1];
            double d2 = pow(x[i] - x[j], 2) + pow(x[i + 1] - x[j + 1], 2);
            double term =
                energy->E.weight * 2 * system->k[s] * (d2 / system->l2[s] - 1);
            i += axis;
            j += axis;
            H[size * i + i] -= term;
            H[size * j + j] -= term;
            H[size * i + j] += term;
            H[size * j + i] += term;
        }
}

/* The matrix as the solver gets it: through slots, one triangle, mirrored. */
static void sum_hessian(const Energy *energy, const double *x, double *H)
{
    System fewer = energy->system;
    fewer.springs -= energy->fault == FAULT_MISSING_SPRING;
    if (energy->part == TERM_SPRINGS)
        fewer.terms = 1;
    IncrementalPotential E = energy->E;
    E.system = &fewer;
    Sparse A;
    int *slot;
    Iterate at = {.E = E, .u = (double *)x, .x = (double *)x};
    Place place = place_at(&fewer, energy->x_n, x, x);
    place.w = E.weight;
    CHECK_STATUS(incremental_potential_pattern(&fewer, &A, &slot), STATUS_OK);
    if (energy->part == TERM_SPRINGS)
        mass_spring_energy.hessian(&place, FILTER_NONE, slot + 2 * fewer.nodes,
                                   NULL, A.value);
    else if (energy->part == TERM_INERTIA)
        inertia_energy_hessian(fewer.nodes, fewer.m, slot, A.value);
    else
        incremental_potential_hessian(&at, FILTER_NONE, slot, &A);
    if (energy->part == TERM_CENTRAL) /* its share comes with the masses' */
        for (int t = 0; t < 2 * fewer.nodes; t++)
            A.value[slot[t]] -= fewer.m[t / 2];
    dense_from_sparse(&A, H);
    sparse_free(&A);
    free(slot);
}

static void energy_hessian(const Energy *energy, const double *x, double *H)
{
    int size = 2 * energy->system.nodes;
    sum_hessian(energy, x, H);
    if (energy->fault == FAULT_NO_GEOMETRY)
        drop_geometry(energy, x, H);
    for (int i = 0; energy->fault == FAULT_HESSIAN_FACTOR && i < size * size;
         i++)
        H[i] *= 1 + 1e-9;
    if (energy->fault == FAULT_ASYMMETRIC)
        H[size] = nextafter(H[size], INFINITY);
    if (energy->fault == FAULT_NAN_HESSIAN)
        H[size + 1] = NAN;
}

/* What the checker measures. */
typedef struct DerivativeErrors {
    double value, gradient, hessian; /* relative to the largest entry */
    double slope1;                   /* of log |E(x + t p) - E - t g.p|: 2 */
    double slope2;                   /* the same less t^2 p.Hp/2: 3 */
    double slope3;                   /* of log |g(x + t p) - g - t H p|: 2 */
    bool symmetric;
} DerivativeErrors;

/* The largest |got - exact| over the largest |exact|; NaN stays. */
static double largest_error(int count, const double *got,
                            const long double *exact)
{
    long double error = 0, scale = 0;
    for (int i = 0; i < count; i++) {
        if (isnan(got[i]))
            return NAN;
        error = fmaxl(error, fabsl(got[i] - exact[i]));
        scale = fmaxl(scale, fabsl(exact[i]));
    }
    return (double)(error / (scale > 0 ? scale : 1));
}

/* The terms that the kernel has, from the formula in extended precision. */
static void check_against_formula(const Kernel *kernel, const double *x,
                                  double value, const double *g,
                                  const double *H, DerivativeErrors *errors)
{
    IncrementalPotential E = kernel->energy->E;
    System terms = kernel->energy->system;
    Part part = kernel->energy->part;
    E.system = &terms;
    if (part == TERM_INERTIA)
        E.weight = 0;
    if (part == TERM_SPRINGS)
        terms.terms = 1;
    const double *u = part == TERM_INERTIA || part == TERM_SUM ? x : NULL;
    long double exact_g[MAX_SIZE], exact_H[MAX_SIZE * MAX_SIZE];
    long double exact_value = exact_energy(&E, u, x, -1, -1).f;
    exact_derivatives(&E, u, x, exact_g, exact_H);
    errors->value = largest_error(1, &value, &exact_value);
    errors->gradient = largest_error(kernel->size, g, exact_g);
    errors->hessian = largest_error(kernel->size * kernel->size, H, exact_H);
}

enum { LADDER = 6 };

/* Mean slope of log2 |remainder| over steps that halve; 0 remainders (of a
 * quadratic energy, the last one) count as rounding: INFINITY. */
static double ladder_slope(const double *remainder, double rounding)
{
    double sum = 0;
    for (int i = 0; i < LADDER; i++)
        if (fabs(remainder[i]) <= rounding)
            return INFINITY;
    for (int i = 0; i + 1 < LADDER; i++)
        sum += log2(fabs(remainder[i] / remainder[i + 1]));
    return sum / (LADDER - 1);
}

/* E(x + t p) - E less the terms that are given. */
static double value_remainder(const Kernel *kernel, const double *x,
                              const double *p, double t, double known)
{
    double y[MAX_SIZE];
    for (int i = 0; i < kernel->size; i++)
        y[i] = x[i] + t * p[i];
    return kernel->value(kernel->energy, y) - known;
}

/* |g(x + t p) - g - t H p| */
static double gradient_remainder(const Kernel *kernel, const double *x,
                                 const double *p, double t, const double *g,
                                 const double *Hp)
{
    double y[MAX_SIZE], g_y[MAX_SIZE], sum = 0;
    for (int i = 0; i < kernel->size; i++)
        y[i] = x[i] + t * p[i];
    kernel->gradient(kernel->energy, y, g_y);
    for (int i = 0; i < kernel->size; i++)
        sum += pow(g_y[i] - g[i] - t * Hp[i], 2);
    return sqrt(sum);
}

/* Taylor remainders over steps that halve, from 2^-8, 2^-4 and 2^-5 on: with
 * larger ones the next order shows in the slope, at the end of smaller ones
 * the rounding of E would. */
static void check_ladder(const Kernel *kernel, const double *x, const double *p,
                         double value, const double *g, const double *H,
                         DerivativeErrors *errors)
{
    int size = kernel->size;
    double first[LADDER], second[LADDER], third[LADDER];
    double gp = 0, pHp = 0, Hp[MAX_SIZE], g_scale = 0;
    for (int i = 0; i < size; i++) {
        Hp[i] = 0;
        for (int j = 0; j < size; j++)
            Hp[i] += H[size * i + j] * p[j];
        gp += g[i] * p[i];
        pHp += p[i] * Hp[i];
        g_scale = fmax(g_scale, fabs(g[i]) + fabs(Hp[i]));
    }
    for (int step = 0; step < LADDER; step++) {
        double t = ldexp(1, -8 - step);
        first[step] = value_remainder(kernel, x, p, t, value + t * gp);
        t = ldexp(1, -4 - step);
        second[step] =
            value_remainder(kernel, x, p, t, value + t * gp + t * t * pHp / 2);
        third[step] = gradient_remainder(kernel, x, p, t / 2, g, Hp);
    }
    double rounding = 20 * DBL_EPSILON;
    errors->slope1 = ladder_slope(first, rounding * (fabs(value) + fabs(gp)));
    errors->slope2 = ladder_slope(second, rounding * (fabs(value) + fabs(gp)));
    errors->slope3 = ladder_slope(third, rounding * g_scale);
}

/* All of it, at x along p. */
static DerivativeErrors check_derivatives(const Kernel *kernel, const double *x,
                                          const double *p)
{
    DerivativeErrors errors = {.symmetric = true};
    double g[MAX_SIZE], H[MAX_SIZE * MAX_SIZE];
    int size = kernel->size;
    double value = kernel->value(kernel->energy, x);
    kernel->gradient(kernel->energy, x, g);
    kernel->hessian(kernel->energy, x, H);
    for (int i = 0; i < size * size; i++)
        if (H[i] != H[size * (i % size) + i / size])
            errors.symmetric = false;
    check_against_formula(kernel, x, value, g, H, &errors);
    check_ladder(kernel, x, p, value, g, H, &errors);
    return errors;
}

/* Double precision leaves sums of some 40 terms with an error of about 1e-15
 * of the largest; 1e-13 is what a wrong digit cannot hide under. */
static bool formula_accepts(const DerivativeErrors *errors)
{
    return errors->value <= 1e-13 && errors->gradient <= 1e-13 &&
           errors->hessian <= 1e-13 && errors->symmetric;
}

/* A quadratic has no remainder of third order. */
static bool ladder_accepts(const DerivativeErrors *errors, bool quadratic)
{
    if (!(fabs(errors->slope1 - 2) <= 0.05))
        return false;
    if (quadratic)
        return isinf(errors->slope2) && isinf(errors->slope3);
    return fabs(errors->slope2 - 3) <= 0.05 && fabs(errors->slope3 - 2) <= 0.05;
}

/* A random problem of this kind; p grows every spring, so that no third
 * derivative is 0 by accident. */
static Kernel random_kernel(Random *random, Part part, SpringState state,
                            Energy *energy, double *x, double *p)
{
    *energy = (Energy){.part = part};
    random_system(random, state, &energy->system, x);
    if (part == TERM_CENTRAL)
        energy->system.springs = 0;
    central_field_set(&energy->system, random_logarithmic(random, 0.1, 10));
    energy->E = (IncrementalPotential){
        .system = &energy->system,
        .weight = random_logarithmic(random, 0.1, 10),
        .x_n = energy->x_n,
        .u_tilde = energy->x_tilde,
    };
    for (int i = 0; i < 2 * energy->system.nodes; i++) {
        energy->x_tilde[i] = x[i] + random_uniform(random, -1, 1);
        p[i] = 0.5 * x[i] + 0.2 * random_uniform(random, -1, 1);
    }
    return (Kernel){2 * energy->system.nodes, energy_value, energy_gradient,
                    energy_hessian, energy};
}

static void print_errors(const DerivativeErrors *errors)
{
    print_error("value %.2g gradient %.2g Hessian %.2g (at most 1e-13), "
                "slopes %.3f %.3f %.3f (2, 3, 2), %ssymmetric\n",
                errors->value, errors->gradient, errors->hessian,
                errors->slope1, errors->slope2, errors->slope3,
                errors->symmetric ? "" : "not ");
}

static void check_term(Part part, SpringState state, bool with_ladder)
{
    Random random = {100 * (uint64_t)part + (uint64_t)state};
    bool quadratic = part == TERM_INERTIA || part == TERM_CENTRAL;
    for (int trial = 0; trial < 20; trial++) {
        Energy energy;
        double x[MAX_SIZE], p[MAX_SIZE];
        Kernel kernel = random_kernel(&random, part, state, &energy, x, p);
        DerivativeErrors errors = check_derivatives(&kernel, x, p);
        bool good = formula_accepts(&errors) &&
                    (!with_ladder || ladder_accepts(&errors, quadratic));
        system_free(&energy.system);
        if (!good)
            print_errors(&errors);
        CHECK(good);
    }
}

static void inertia_is_right(void **unused)
{
    (void)unused;
    check_term(TERM_INERTIA, SPRINGS_MIXED, true);
}

static void central_field_is_right(void **unused)
{
    (void)unused;
    check_term(TERM_CENTRAL, SPRINGS_MIXED, true);
}

static void stretched_springs_are_right(void **unused)
{
    (void)unused;
    check_term(TERM_SPRINGS, SPRINGS_STRETCHED, true);
}

static void compressed_springs_are_right(void **unused)
{
    (void)unused;
    check_term(TERM_SPRINGS, SPRINGS_COMPRESSED, true);
}

static void mixed_springs_are_right(void **unused)
{
    (void)unused;
    check_term(TERM_SPRINGS, SPRINGS_MIXED, true);
}

static void short_springs_are_right(void **unused)
{
    (void)unused;
    check_term(TERM_SPRINGS, SPRINGS_SHORT, true);
}

/* No ladder: E = l2 k/2 (1 - tiny) hides every third-order term there. */
static void springs_of_no_length_are_right(void **unused)
{
    (void)unused;
    check_term(TERM_SPRINGS, SPRINGS_NEAR_ZERO, false);
}

static void sums_are_right(void **unused)
{
    (void)unused;
    check_term(TERM_SUM, SPRINGS_STRETCHED, true);
    check_term(TERM_SUM, SPRINGS_COMPRESSED, true);
    check_term(TERM_SUM, SPRINGS_MIXED, true);
    check_term(TERM_SUM, SPRINGS_SHORT, true);
    check_term(TERM_SUM, SPRINGS_NEAR_ZERO, false);
}

/* Both halves of the checker against one fault, in each state. */
static void check_rejected(Fault fault, bool by_formula, bool by_ladder)
{
    Random random = {7 + (uint64_t)fault};
    for (int trial = 0; trial < 20; trial++) {
        Energy energy;
        double x[MAX_SIZE], p[MAX_SIZE];
        SpringState state = (SpringState)(trial % SPRINGS_NEAR_ZERO);
        Part part = trial % 2 ? TERM_SPRINGS : TERM_SUM;
        Kernel kernel = random_kernel(&random, part, state, &energy, x, p);
        energy.fault = fault;
        DerivativeErrors errors = check_derivatives(&kernel, x, p);
        bool formula = formula_accepts(&errors);
        bool ladder = ladder_accepts(&errors, false);
        system_free(&energy.system);
        if (formula == by_formula || (by_ladder && ladder))
            print_errors(&errors);
        CHECK(formula == !by_formula);
        CHECK(!by_ladder || !ladder);
    }
}

static void checker_accepts_what_is_right(void **unused)
{
    (void)unused;
    check_rejected(FAULT_NONE, false, false);
}

static void checker_rejects_a_sign(void **unused)
{
    (void)unused;
    check_rejected(FAULT_SIGN, true, true);
}

/* 1e-9 is too little for the ladders; the formula sees it. */
static void checker_rejects_a_factor(void **unused)
{
    (void)unused;
    check_rejected(FAULT_FACTOR, true, false);
    check_rejected(FAULT_HESSIAN_FACTOR, true, false);
    check_rejected(FAULT_VALUE_FACTOR, true, false);
}

/* Which may be the weakest of forty: only the formula must see it. */
static void checker_rejects_a_missing_spring(void **unused)
{
    (void)unused;
    check_rejected(FAULT_MISSING_SPRING, true, false);
}

static void checker_rejects_a_missing_term(void **unused)
{
    (void)unused;
    check_rejected(FAULT_NO_GEOMETRY, true, true);
}

static void checker_rejects_asymmetry(void **unused)
{
    (void)unused;
    check_rejected(FAULT_ASYMMETRIC, true, false);
}

static void checker_rejects_nan(void **unused)
{
    (void)unused;
    check_rejected(FAULT_NAN_VALUE, true, true);
    check_rejected(FAULT_NAN_GRADIENT, true, true);
    check_rejected(FAULT_NAN_HESSIAN, true, true);
}

/* acceleration = -M^-1 gradient; pinned nodes feel nothing; kinetic energy. */
static void system_uses_the_energies(void **unused)
{
    (void)unused;
    Random random = {77};
    Energy energy;
    double x[MAX_SIZE], p[MAX_SIZE], a[MAX_SIZE], kinetic = 0;
    long double g[MAX_SIZE];
    random_kernel(&random, TERM_SUM, SPRINGS_MIXED, &energy, x, p);
    System *system = &energy.system;
    energy.E.weight = 1;
    exact_derivatives(&energy.E, NULL, x, g, NULL);
    system_acceleration(system, x, a);
    for (int i = 0; i < 2 * system->nodes; i++) {
        CHECK_NEAR(a[i] * system->m[i / 2], -g[i], 1e-12 * fabsl(g[i]) + 1e-11);
        kinetic += system->m[i / 2] * p[i] * p[i] / 2;
    }
    CHECK_NEAR(system_potential(system, x),
               exact_energy(&energy.E, NULL, x, -1, -1).f,
               1e-13 * system_potential(system, x));
    CHECK_NEAR(system_kinetic(system, p), kinetic, 1e-14 * kinetic);
    system->pinned = test_calloc((size_t)system->nodes, 1);
    system->pinned[1] = 1;
    system_acceleration(system, x, p);
    CHECK(p[2] == 0 && p[3] == 0);
    CHECK_SAME_BITS(p, a, 2);
    CHECK_SAME_BITS(p + 4, a + 4, 2 * system->nodes - 4);
    test_free(system->pinned);
    system->pinned = NULL;
    system_free(system);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inertia_is_right),
        cmocka_unit_test(central_field_is_right),
        cmocka_unit_test(stretched_springs_are_right),
        cmocka_unit_test(compressed_springs_are_right),
        cmocka_unit_test(mixed_springs_are_right),
        cmocka_unit_test(short_springs_are_right),
        cmocka_unit_test(springs_of_no_length_are_right),
        cmocka_unit_test(sums_are_right),
        cmocka_unit_test(checker_accepts_what_is_right),
        cmocka_unit_test(checker_rejects_a_sign),
        cmocka_unit_test(checker_rejects_a_factor),
        cmocka_unit_test(checker_rejects_a_missing_spring),
        cmocka_unit_test(checker_rejects_a_missing_term),
        cmocka_unit_test(checker_rejects_asymmetry),
        cmocka_unit_test(checker_rejects_nan),
        cmocka_unit_test(system_uses_the_energies),
    };
    return cmocka_run_group_tests_name("derivatives", tests, NULL, NULL);
}
