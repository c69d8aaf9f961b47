/* The energy along a line as a quartic, and backtracking on it. */
#include "model/pull_energy.h"
#include "test.h"

#include <math.h>
#include <stdlib.h>

#include "model/plasticity.h"
#include "solve/line_search.h"

/* E(x + alpha p) - E(x), both summed in extended precision. */
static long double energy_difference(const IncrementalPotential *E,
                                     const double *u, const double *x,
                                     const double *p, double alpha)
{
    double u_new[MAX_SIZE], x_new[MAX_SIZE];
    for (int i = 0; i < 2 * E->system->nodes; i++) {
        u_new[i] = u[i] + alpha * p[i];
        x_new[i] = x[i] + alpha * p[i];
    }
    return exact_energy(E, u_new, x_new) -
           exact_energy(E, u, x);
}

/* Coordinates on a grid of 2^-20 and steps of 2^-k: x + alpha p is exact, so
 * only the sums round.  1e-13 of the largest coefficient: some hundred
 * roundings. */
static void check_quartic(SpringState state, bool pinned)
{
    Random random = {20 + (uint64_t)state};
    for (int trial = 0; trial < 50; trial++) {
        System system;
        double x[MAX_SIZE], p[MAX_SIZE], u[MAX_SIZE], u_tilde[MAX_SIZE];
        double g[MAX_SIZE];
        random_system(&random, state, &system, x);
        central_field_set(&system, random_uniform(&random, 0, 3));
        if (pinned) {
            system.pinned = calloc((size_t)system.nodes, 1);
            system.pinned[0] = 1;
        }
        for (int i = 0; i < 2 * system.nodes; i++) {
            x[i] = ldexp(round(ldexp(x[i], 20)), -20);
            p[i] = ldexp(round(ldexp(random_uniform(&random, -1, 1), 10)), -10);
            u[i] = ldexp(round(ldexp(random_uniform(&random, -1, 1), 10)), -10);
            u_tilde[i] = random_uniform(&random, -1, 1);
            if (pinned && i < 2)
                p[i] = 0;
        }
        IncrementalPotential E = {
            .system = &system, .weight = 0.7, .x_n = x, .u_tilde = u_tilde};
        incremental_potential_gradient(&E, u, x, g);
        Iterate at = {E, u, x, g, p};
        Quartic along = incremental_potential_along(&at, 1).smooth;
        double scale = fabs(along.q[0]) + fabs(along.q[1]) + fabs(along.q[2]) +
                       fabs(along.q[3]);
        for (int i = -2; i < 10; i++) {
            double alpha = ldexp(1, -i);
            CHECK_NEAR(quartic_value(&along, alpha),
                       energy_difference(&E, u, x, p, alpha),
                       1e-13 * scale * alpha * (1 + pow(alpha, 3)));
        }
        system_free(&system);
    }
}

TEST(quartic_is_the_energy_of_stretched_springs)
{
    check_quartic(SPRINGS_STRETCHED, false);
}

TEST(quartic_is_the_energy_of_compressed_springs)
{
    check_quartic(SPRINGS_COMPRESSED, false);
    check_quartic(SPRINGS_SHORT, false);
}

TEST(quartic_is_the_energy_of_mixed_springs)
{
    check_quartic(SPRINGS_MIXED, false);
}

TEST(quartic_is_the_energy_with_pins)
{
    check_quartic(SPRINGS_MIXED, true);
}

TEST(quartic_value_is_the_polynomial)
{
    const Quartic quartic = {{1, -2, 3, -5}};
    CHECK(quartic_value(&quartic, 0) == 0);
    CHECK(quartic_value(&quartic, 1) == -3);
    CHECK(quartic_value(&quartic, 2) == 2 - 8 + 24 - 80);
    CHECK(quartic_value(&quartic, -0.5) == -0.5 - 0.5 - 0.375 - 0.3125);
}

/* What a search saw. */
typedef struct Probe {
    double limit; /* alphas below it do not raise the energy */
    double at_limit;
    int calls;
    double last;
} Probe;

static double probe_difference(const void *function, double alpha)
{
    Probe *probe = *(Probe *const *)function;
    probe->calls++;
    probe->last = alpha;
    return alpha <= probe->limit ? probe->at_limit : 1;
}

/* The first of 1, 1/2, 1/4, ... that does not raise the energy. */
TEST(backtracking_takes_the_first_halving)
{
    for (int halvings = 0; halvings <= LINE_SEARCH_MAX_HALVINGS; halvings++)
        for (int equal = 0; equal < 2; equal++) {
            Probe probe = {ldexp(1, -halvings), equal ? 0 : -1, 0, 0};
            Probe *pointer = &probe;
            double alpha = 1;
            int trials;
            CHECK_STATUS(line_search_backtrack(probe_difference, &pointer,
                                               &alpha, &trials),
                         STATUS_OK);
            CHECK(alpha == ldexp(1, -halvings) && probe.last == alpha);
            CHECK(trials == halvings + 1 && probe.calls == trials);
        }
}

/* Where contact leaves less than 1: from there down. */
TEST(backtracking_starts_where_it_is_told)
{
    Probe probe = {0.1, -1, 0, 0};
    Probe *pointer = &probe;
    double alpha = 0.3;
    int trials;
    CHECK_STATUS(
        line_search_backtrack(probe_difference, &pointer, &alpha, &trials),
        STATUS_OK);
    CHECK(alpha == 0.075 && trials == 3 && probe.calls == 3);
}

TEST(backtracking_gives_up)
{
    Probe probe = {ldexp(1, -65), -1, 0, 0};
    Probe *pointer = &probe;
    double alpha = 1;
    int trials;
    CHECK_STATUS(
        line_search_backtrack(probe_difference, &pointer, &alpha, &trials),
        STATUS_LINE_SEARCH_LIMIT);
    CHECK(alpha == 0 && trials == 65 && probe.calls == 65);
    CHECK(probe.last == ldexp(1, -64));
}

/* NaN for alpha > 1/4, and always. */
static double nan_difference(const void *function, double alpha)
{
    return alpha > *(const double *)function ? NAN : -1;
}

TEST(nan_is_not_lower)
{
    double limit = 0.25, alpha = 1;
    int trials;
    CHECK_STATUS(line_search_backtrack(nan_difference, &limit, &alpha, &trials),
                 STATUS_OK);
    CHECK(alpha == 0.25 && trials == 3);
    limit = 0;
    alpha = 1;
    CHECK_STATUS(line_search_backtrack(nan_difference, &limit, &alpha, &trials),
                 STATUS_LINE_SEARCH_LIMIT);
    CHECK(alpha == 0 && trials == 65);
}

/* ---- E itself ---------------------------------------------------------- */

/* Springs that flow, of which a long line says that E falls without end. */
static double a_lie(const Place *at, const double *p, double alpha)
{
    return alpha > 0.001 ? -1e20 : plastic_energy.remainder(at, p, alpha);
}

/* E after each update. */
typedef struct Falling {
    Simulation simulation;
    double E;
    int updates, halved;
    bool good;
} Falling;

static bool see_fall(void *user, const NewtonRecord *record)
{
    Falling *falling = user;
    const Iterate *at = &falling->simulation.run[0].newton->at;
    double E = incremental_potential_value(&at->E, at->u, at->x);
    if (record->iteration > 0) { /* 1e-9: the rounding of E */
        falling->good = falling->good && E <= falling->E * (1 + 1e-9) &&
                        record->change <= 0 &&
                        record->change >= -falling->E * (1 + 1e-9);
        falling->halved += record->alpha < 0.001;
    }
    falling->E = E;
    falling->updates++;
    return true;
}

/* Whatever a term says about a line: no update raises E, and none is said to
 * lower it by more than there is of it.  Springs that flow let light nodes fly,
 * so that long steps raise E. */
TEST(no_update_is_taken_that_E_contradicts)
{
    static Falling falling;
    falling.good = true;
    simulation_from_line("--segments 4 --stretch 4 --timestep 1 --yield 0.01 "
                         "--density 0.001",
                         see_fall, &falling, &falling.simulation);
    TermKind liar = plastic_energy;
    liar.remainder = a_lie;
    system_find_term(&falling.simulation.system, &plastic_energy)->kind = &liar;
    CHECK_STATUS(simulation_step(&falling.simulation), STATUS_OK);
    CHECK(falling.good && falling.updates > 5 && falling.halved > 5);
    simulation_free(&falling.simulation);
}

TESTS(NULL, NULL)
