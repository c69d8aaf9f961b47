/* The lecture's small scenes, held to formulas written here once more. */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model/mass_spring_energy.h"
#include "scenes/small_scenes.h"

/* ---- one mass ----------------------------------------------------------- */

/* The arrows that are drawn before a step are what the integrators then do:
 * equal but for a few roundings of numbers below 10. */
TEST(mass_arrows_are_the_next_step)
{
    Simulation simulation;
    simulation_from_line("arrows --timestep 0.37 --start 0.8,-0.4", NULL, NULL,
                         &simulation);
    CHECK(simulation.runs == 3);
    for (int n = 0; n < 20; n++) {
        MassStep step[3];
        for (int run = 0; run < 3; run++)
            CHECK(mass_next_step(&simulation, run, &step[run]));
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        for (int run = 0; run < 3; run++)
            for (int i = 0; i < 2; i++) {
                const TimeIntegrator *now = &simulation.run[run];
                double scale = 1 + hypot(now->x[0], now->x[1]);
                CHECK_NEAR(now->x[i], step[run].new_x[i], 1e-14 * scale);
                CHECK_NEAR(now->v[i], step[run].new_v[i], 1e-14 * scale);
                CHECK_NEAR(step[run].a[i], -step[run].x[i], 0);
                CHECK_NEAR(step[run].new_a[i], -step[run].new_x[i], 0);
            }
    }
    simulation_free(&simulation);
}

/* The three formulas, by hand, from (1, 0) with v = (0, 1) and h = 0.5:
 * forward (1, 0.5); symplectic: v' = (-0.5, 1), x' = (0.75, 0.5); backward:
 * x' = (x + h v)/1.25 = (0.8, 0.4), v' = (x' - x)/h = (-0.4, 0.8). */
TEST(mass_steps_are_the_slides)
{
    static const double x[3][2] = {{1, 0.5}, {0.75, 0.5}, {0.8, 0.4}};
    static const double v[3][2] = {{-0.5, 1}, {-0.5, 1}, {-0.4, 0.8}};
    Simulation simulation;
    simulation_from_line("arrows", NULL, NULL, &simulation);
    for (int run = 0; run < 3; run++) {
        MassStep step;
        CHECK(mass_next_step(&simulation, run, &step));
        for (int i = 0; i < 2; i++) {
            CHECK_NEAR(step.new_x[i], x[run][i], 1e-15);
            CHECK_NEAR(step.new_v[i], v[run][i], 1e-15);
        }
    }
    simulation_free(&simulation);
    simulation_from_line("arrows --integrator verlet", NULL, NULL, &simulation);
    MassStep step;
    CHECK(!mass_next_step(&simulation, 0, &step));
    simulation_free(&simulation);
}

/* Which v forward Euler's way is along is its method's, whatever the digits of
 * x + h v are; the exact path is the ellipse of where the mass began, or was
 * dragged, also after another method is chosen. */
TEST(mass_knows_its_path)
{
    Simulation simulation;
    MassStep step;
    simulation_from_line("arrows --integrator forward-euler", NULL, NULL,
                         &simulation);
    Options other = simulation.options;
    Random random = {7};
    for (int i = 0; i < 100; i++) {
        double now[2], later[2], x = random_uniform(&random, -2, 2);
        exhibit_drag(&simulation, i % 2, x, random_uniform(&random, -2, 2));
        CHECK(mass_next_step(&simulation, 0, &step) && step.by_old_v);
        mass_exact(&simulation, 0, now);
        mass_exact(&simulation, 0.5 * M_PI, later);
        for (int c = 0; c < 2; c++) {
            CHECK_NEAR(now[c], step.x[c], 0);
            CHECK_NEAR(later[c], step.v[c], 1e-15 * (1 + fabs(now[c])));
        }
    }
    double before[2], after[2];
    mass_exact(&simulation, 1, before);
    simulation_step(&simulation);
    other.integrator =
        integrator_method("symplectic-euler") - integrator_methods;
    CHECK_STATUS(simulation_change(&simulation, &other), STATUS_OK);
    CHECK(mass_next_step(&simulation, 0, &step) && !step.by_old_v);
    mass_exact(&simulation, 1, after);
    CHECK_SAME_BITS(before, after, 2);
    simulation_free(&simulation);
}

/* Dragging the mass keeps its velocity, dragging the tip its place; all runs
 * follow. */
TEST(mass_is_dragged)
{
    Simulation simulation;
    double at[SCENE_MAX_HANDLES][2];
    simulation_from_line("arrows", NULL, NULL, &simulation);
    simulation_step(&simulation);
    exhibit_drag(&simulation, 0, 0.25, -0.5);
    exhibit_drag(&simulation, 1, 0.25 + 2, -0.5 + 3);
    CHECK(exhibit_handles(&simulation, at) == 2);
    CHECK_NEAR(at[0][0], 0.25, 0);
    CHECK_NEAR(at[1][1], 2.5, 0);
    for (int run = 0; run < 3; run++) {
        const double x[2] = {0.25, -0.5}, v[2] = {2, 3};
        CHECK_SAME_BITS(simulation.run[run].x, x, 2);
        CHECK_SAME_BITS(simulation.run[run].v, v, 2);
    }
    simulation_free(&simulation);
}

/* ---- Newton in one dimension -------------------------------------------- */

/* E and g of the header's formula, in extended precision: m = 1 kg, k = 10
 * J/m^2, l = 1 m, h = 0.3 s. */
static long double line_E(const Simulation *simulation, long double x)
{
    long double s = x * x - 1, d = x - simulation->exhibit.target[0];
    long double h = 0.3;
    return d * d / 2 + h * h * 5 * s * s;
}

static long double line_g(const Simulation *simulation, long double x)
{
    long double h = 0.3;
    return x - simulation->exhibit.target[0] + 20 * h * h * x * (x * x - 1);
}

/* g is the derivative of E and E'' that of g: central differences of a quartic
 * with step e have an error of e^2 f'''/6, f''' < 100 here. */
TEST(tangent_derivatives_are_right)
{
    Simulation simulation;
    simulation_from_line("tangent", NULL, NULL, &simulation);
    const Simulation *line = &simulation;
    const long double e = 1e-5L;
    for (double x = -2; x <= 2.5; x += 0.125) {
        long double by_E = (line_E(line, x + e) - line_E(line, x - e)) / 2 / e;
        long double by_g = (line_g(line, x + e) - line_g(line, x - e)) / 2 / e;
        Local E = descent_at(line, FILTER_NONE, x, 0);
        CHECK_NEAR(E.value, line_E(line, x), 1e-13);
        CHECK_NEAR(E.g[0], by_E, 2e-9);
        CHECK_NEAR(E.H[0], by_g, 2e-9);
    }
    simulation_free(&simulation);
}

/* The next iterate is where the tangent of g is zero; the limit is a root. */
TEST(tangent_follows_tangents)
{
    Simulation simulation;
    simulation_from_line("tangent", NULL, NULL, &simulation);
    const Simulation *line = &simulation;
    while (!simulation.done) {
        double x = simulation.descent.point[0];
        double slope = descent_at(line, FILTER_NONE, x, 0).H[0];
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
        long double zero = x - line_g(line, x) / slope;
        CHECK_NEAR(simulation.descent.point[0], zero, 1e-14);
    }
    CHECK(simulation.steps == 6 || simulation.steps == 7);
    /* |p| <= 1e-10 and g = -E'' p with E'' < 10 */
    CHECK_NEAR(line_g(line, simulation.descent.point[0]), 0, 1e-9);
    simulation_free(&simulation);
}

/* A dragged start or x_tilde begins anew, with the same E elsewhere. */
TEST(tangent_is_dragged)
{
    Simulation simulation;
    double at[SCENE_MAX_HANDLES][2];
    simulation_from_line("tangent", NULL, NULL, &simulation);
    while (!simulation.done)
        simulation_step(&simulation);
    exhibit_drag(&simulation, 1, -1.5, 7);
    CHECK(simulation.steps == 0 && !simulation.done);
    CHECK_NEAR(simulation.exhibit.target[0], -1.5, 0);
    exhibit_drag(&simulation, 0, -2.25, 7);
    CHECK(exhibit_handles(&simulation, at) == 2);
    CHECK_NEAR(at[0][0], -2.25, 0);
    CHECK_NEAR(at[0][1], line_E(&simulation, -2.25), 1e-13);
    CHECK_NEAR(at[1][0], -1.5, 0);
    while (!simulation.done)
        simulation_step(&simulation);
    CHECK_NEAR(line_g(&simulation, simulation.run[0].x[0]), 0, 1e-9);
    CHECK(simulation.run[0].x[0] < 0);
    exhibit_drag(&simulation, 0, NAN, 0);
    CHECK(isfinite(simulation.run[0].x[0]));
    simulation_free(&simulation);
}

/* ---- the dial ----------------------------------------------------------- */

/* |grad E| of the landscape's free node by the formula, in extended
 * precision. */
static long double dial_gradient(const Simulation *simulation, double h,
                                 const double point[2])
{
    long double g[2];
    for (int i = 0; i < 2; i++)
        g[i] = point[i] - (long double)simulation->exhibit.target[i];
    for (int pin = -1; pin <= 1; pin += 2) {
        long double d[2] = {point[0] - pin, point[1]};
        long double s = (d[0] * d[0] + d[1] * d[1]) / 2.25L - 1;
        for (int i = 0; i < 2; i++)
            g[i] += (long double)h * h * 200 * s * d[i];
    }
    return hypotl(g[0], g[1]);
}

/* Each point of the walk is a minimiser: its gradient is rounding of numbers
 * about h^2 k = 1e4 and 1. */
TEST(dial_walks_over_minimisers)
{
    Simulation simulation;
    simulation_from_line("dial", NULL, NULL, &simulation);
    for (int drag = 0; drag < 2; drag++) {
        const Walk *walk = &simulation.exhibit.walk;
        for (int i = 0; i < WALK_POINTS; i++) {
            double h = walk->h[i];
            CHECK_AT_MOST(dial_gradient(&simulation, h, walk->point[i]),
                          1e-13 * (1 + 100 * h * h));
            CHECK(i == 0 || h > walk->h[i - 1]);
            double step =
                i == 0 ? 0
                       : hypot(walk->point[i][0] - walk->point[i - 1][0],
                               walk->point[i][1] - walk->point[i - 1][1]);
            CHECK_AT_MOST(step, 0.2); /* it walks and does not jump */
        }
        exhibit_drag(&simulation, 0, -0.5, 0.9);
    }
    simulation_free(&simulation);
}

/* From x_tilde to rest: there the free node is 1.5 m from both pins. */
TEST(dial_turns_from_target_to_rest)
{
    Simulation simulation;
    simulation_from_line("dial --timestep 1e-6", NULL, NULL, &simulation);
    CHECK_NEAR(simulation.run[0].x[0], 0.2, 1e-9);
    CHECK_NEAR(simulation.run[0].x[1], 0.3, 1e-9);
    simulation_free(&simulation);
    simulation_from_line("dial", NULL, NULL, &simulation);
    double h = simulation.options.timestep;
    CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK_NEAR(simulation.options.timestep, h * pow(10, 0.1), 1e-15);
    while (!simulation.done)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK_NEAR(simulation.options.timestep, 10, 0);
    /* inertia still pulls: by 1 / (h^2 k) = 1e-4 of its distance */
    CHECK_NEAR(simulation.run[0].x[0], 0, 1e-4);
    CHECK_NEAR(simulation.run[0].x[1], sqrt(1.25), 1e-4);
    CHECK_AT_MOST(dial_gradient(&simulation, 10, simulation.run[0].x), 1e-9);
    simulation_free(&simulation);
}

/* With x_tilde on the line of the pins a short step ends there; a longer one
 * does not end on the saddle that is there then. */
TEST(dial_ends_on_no_saddle)
{
    Simulation simulation;
    simulation_from_line("dial", NULL, NULL, &simulation);
    exhibit_drag(&simulation, 0, 0.2, 0);
    const Walk *walk = &simulation.exhibit.walk;
    CHECK_NEAR(walk->point[0][1], 0, 1e-12);
    CHECK_NEAR(fabs(walk->point[WALK_POINTS - 1][1]), sqrt(1.25), 1e-4);
    for (int i = 0; i < WALK_POINTS; i++) {
        simulation.run[0].h = walk->h[i];
        CHECK(descent_bends_down(&simulation, walk->point[i][0],
                                 walk->point[i][1]) == 0);
    }
    simulation_free(&simulation);
}

/* ---- inertia and elasticity on the map ---------------------------------- */

TEST(landscape_has_two_parts)
{
    Simulation simulation;
    Switch out[SCENE_MAX_SWITCHES];
    simulation_from_line("landscape", NULL, NULL, &simulation);
    for (double x = -1.5; x < 1.6; x += 0.31) {
        double y = 0.7 * x + 0.1;
        double inertia = landscape_part_value(&simulation, PART_INERTIA, x, y);
        double elastic =
            landscape_part_value(&simulation, PART_ELASTICITY, x, y);
        CHECK_NEAR(inertia,
                   0.5 * ((x - 0.2) * (x - 0.2) + (y - 0.3) * (y - 0.3)),
                   1e-15);
        CHECK_NEAR(inertia + elastic, descent_value(&simulation, x, y), 1e-13);
    }
    CHECK(exhibit_switches(&simulation, out) == 2 && out[0].on && out[1].on);
    exhibit_flip(&simulation, 0);
    CHECK(simulation.exhibit.parts == PART_ELASTICITY);
    exhibit_flip(&simulation, 1); /* the last one: the other comes back */
    CHECK(simulation.exhibit.parts == PART_INERTIA);
    exhibit_flip(&simulation, 1);
    CHECK(simulation.exhibit.parts == PART_BOTH);
    simulation_free(&simulation);
}

/* What is switched off is not minimised either: the part that is left falls in
 * each update, to its own minimum, with every method. */
TEST(landscape_minimises_what_it_shows)
{
    static const char *const lines[] = {
        "landscape --start 0.6,0.9", "landscape --start 0.2,-0.3 --filter abs",
        "landscape --start 0.6,0.9 --filter on-demand",
        "landscape --start 0.6,0.9 --filter none",
        "landscape --start 0.6,0.9 --filter none --line-search none"};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        for (int off = 0; off < 2; off++) {
            Simulation simulation;
            simulation_from_line(lines[i], NULL, NULL, &simulation);
            const Descent *descent = &simulation.descent;
            CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
            exhibit_flip(&simulation, off);
            unsigned part = simulation.exhibit.parts;
            CHECK(part == (off ? PART_INERTIA : PART_ELASTICITY));
            CHECK(descent->count == 0);
            while (!simulation.done) {
                double before = descent->value;
                CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
                CHECK(descent->value < before);
            }
            CHECK(!off || descent->count == 1);
            CHECK_AT_MOST(descent->residual, simulation.options.tolerance);
            /* p <= h 1e-6, twice: E <= 10 p^2 */
            CHECK_AT_MOST(landscape_part_value(&simulation, part,
                                               descent->point[0],
                                               descent->point[1]),
                          1e-12);
            exhibit_flip(&simulation, !off); /* all of E again */
            exhibit_flip(&simulation, off);
            simulation_free(&simulation);
        }
    Simulation flat; /* both springs along x: elasticity alone has no H^-1 */
    simulation_from_line("landscape --start 0.3,0", NULL, NULL, &flat);
    exhibit_flip(&flat, 0);
    CHECK_STATUS(flat.status, STATUS_SINGULAR);
    CHECK(flat.done && flat.descent.direction[0] == 0);
    simulation_free(&flat);
}

/* Newton begins anew where the iterate is dragged to, or with another target:
 * as a scene that was started there. */
TEST(landscape_is_dragged)
{
    Simulation dragged, fresh;
    simulation_from_line("landscape", NULL, NULL, &dragged);
    simulation_from_line("landscape --start 0.9,-0.8", NULL, NULL, &fresh);
    while (!dragged.done)
        simulation_step(&dragged);
    exhibit_drag(&dragged, 1, 0.9, -0.8);
    CHECK(!dragged.done && dragged.steps == 0 && dragged.descent.count == 0);
    CHECK_NEAR(dragged.descent.slope, fresh.descent.slope,
               1e-12 * fabs(fresh.descent.slope));
    while (!dragged.done && !fresh.done) {
        simulation_step(&dragged);
        simulation_step(&fresh);
        CHECK_NEAR(dragged.run[0].x[0], fresh.run[0].x[0], 1e-12);
        CHECK_NEAR(dragged.run[0].x[1], fresh.run[0].x[1], 1e-12);
    }
    CHECK(dragged.done && fresh.done);
    exhibit_drag(&dragged, 0, 0.3, -1.3);
    while (!dragged.done)
        simulation_step(&dragged);
    CHECK_STATUS(dragged.status, STATUS_OK);
    CHECK_AT_MOST(dial_gradient(&dragged, 0.2, dragged.run[0].x), 1e-5);
    simulation_free(&dragged);
    simulation_free(&fresh);
}

/* Both directions are those that Newton has with that filter. */
TEST(landscape_knows_both_directions)
{
    static const Filter filters[2] = {FILTER_NONE, FILTER_CLAMP};
    Simulation simulation;
    simulation_from_line("landscape", NULL, NULL, &simulation);
    for (int i = 0; i < 2; i++) {
        double p[2];
        simulation_set_filter(&simulation, filters[i]);
        double slope = descent_direction(&simulation, filters[i], p);
        CHECK_NEAR(slope, simulation.descent.slope, 1e-12);
        CHECK_NEAR(p[0], simulation.descent.direction[0], 1e-13);
        CHECK_NEAR(p[1], simulation.descent.direction[1], 1e-13);
        CHECK((slope > 0) == (i == 0));
    }
    CHECK(descent_bends_down(&simulation, 0.1, -0.35));
    exhibit_flip(&simulation, 1);
    CHECK(!descent_bends_down(&simulation, 0.1, -0.35)); /* inertia alone */
    simulation_free(&simulation);
}

/* ---- one spring --------------------------------------------------------- */

static long double spring_P(long double x, long double y)
{
    long double s = x * x + y * y - 1;
    return 50 * s * s;
}

/* All of the facts by differences of P in extended precision; the error of a
 * second difference is e^2 P''''/12 < 1e-7. */
TEST(spring_facts_are_derivatives)
{
    const long double e = 1e-5L;
    Random random = {15};
    for (int i = 0; i < 200; i++) {
        double angle = random_uniform(&random, 0, 6.28);
        double r = random_uniform(&random, 0.05, 2);
        const double d[2] = {r * cos(angle), r * sin(angle)};
        const long double a[2] = {cosl(angle), sinl(angle)};
        SpringFacts facts;
        spring_facts(d, 1, 100, &facts);
        long double x = d[0], y = d[1], P = spring_P(x, y);
        CHECK_NEAR(facts.length, r, 1e-15);
        CHECK_NEAR(facts.energy, P, 1e-12);
        CHECK_NEAR(facts.force[0],
                   (spring_P(x - e, y) - spring_P(x + e, y)) / 2 / e, 1e-6);
        CHECK_NEAR(facts.force[1],
                   (spring_P(x, y - e) - spring_P(x, y + e)) / 2 / e, 1e-6);
        CHECK_NEAR(facts.along,
                   (spring_P(x + e * a[0], y + e * a[1]) +
                    spring_P(x - e * a[0], y - e * a[1]) - 2 * P) /
                       (e * e),
                   1e-5);
        CHECK_NEAR(facts.across,
                   (spring_P(x - e * a[1], y + e * a[0]) +
                    spring_P(x + e * a[1], y - e * a[0]) - 2 * P) /
                       (e * e),
                   1e-5);
    }
}

/* The four eigenvalues are those of the 4x4 block, before and after make_psd:
 * traces of the matrix and of its square tell. */
TEST(spring_eigenvalues_are_those_of_the_block)
{
    for (double r = 0.05; r < 2; r += 0.07) {
        const double d[2] = {0.6 * r, 0.8 * r};
        double H[3], a[16];
        SpringFacts facts;
        spring_facts(d, 1, 100, &facts);
        spring_hessian(d, 1, 100, FILTER_NONE, H);
        for (int i = 0; i < 16; i++) {
            int row = i / 4, column = i % 4;
            double sign = row / 2 == column / 2 ? 1 : -1;
            a[i] = sign * H[row % 2 + column % 2];
        }
        for (int pass = 0; pass < 2; pass++) {
            const double *value = pass ? facts.projected : facts.block;
            double trace = 0, square = 0, sum = 0, squares = 0;
            for (int i = 0; i < 16; i++) {
                trace += i % 5 == 0 ? a[i] : 0;
                square += a[i] * a[i];
            }
            for (int i = 0; i < 4; i++) {
                sum += value[i];
                squares += value[i] * value[i];
                CHECK(i == 0 || value[i] >= value[i - 1]);
                CHECK(!pass || value[i] >= 0);
            }
            CHECK_NEAR(trace, sum, 1e-11 * (1 + fabs(sum)));
            CHECK_NEAR(square, squares, 1e-11 * (1 + squares));
            make_psd(a);
        }
    }
}

/* As stiff at rest, and without a bound below beside it. */
TEST(spring_with_a_square_root_is_worse)
{
    SpringFacts rest, near;
    spring_facts((double[2]){1, 0}, 1, 100, &rest);
    CHECK_NEAR(rest.along, 400, 0);
    CHECK_NEAR(rest.root_along, 400, 0);
    CHECK_NEAR(rest.across, 0, 0);
    CHECK_NEAR(rest.root_across, 0, 0);
    CHECK_NEAR(rest.root_energy, rest.energy, 0);
    spring_facts((double[2]){1e-3, 0}, 1, 100, &near);
    CHECK_NEAR(near.across, -200, 1e-3);
    CHECK_NEAR(near.root_across, -399600, 1e-6);
    spring_facts((double[2]){0, 0}, 1, 100, &near);
    CHECK_NEAR(near.across, -200, 0);
    CHECK_NEAR(near.along, -200, 0);
    CHECK_NEAR(near.force[0], 0, 0);
    CHECK(near.root_across == -INFINITY);
}

TEST(spring_is_dragged)
{
    Simulation simulation;
    double at[SCENE_MAX_HANDLES][2];
    simulation_from_line("spring", NULL, NULL, &simulation);
    for (int i = 0; i < 5; i++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    exhibit_drag(&simulation, 0, 0.2, 0.1);
    CHECK(exhibit_handles(&simulation, at) == 1);
    CHECK_NEAR(at[0][0], 0.2, 0);
    CHECK_NEAR(simulation.run[0].v[1], 0, 0);
    for (int i = 0; i < 200; i++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK_NEAR(simulation.run[0].x[2], 0, 0); /* held */
    /* backward Euler has taken nearly all of the energy of 45 J */
    CHECK_AT_MOST(simulation_energies(&simulation, 0).total, 1);
    simulation_free(&simulation);
}

/* ---- run time against error --------------------------------------------- */

/* Halving a small time step divides the error by 2 to the power of the order
 * of the method: within a quarter, for the terms of higher order. */
TEST(race_shows_the_orders)
{
    Simulation simulation;
    simulation_from_line("race", NULL, NULL, &simulation);
    const Race *race = &simulation.exhibit.race;
    while (!simulation.done)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK(race->count == RACE_METHODS * RACE_STEP_SIZES);
    for (int i = race->count - RACE_METHODS; i < race->count; i++) {
        const RacePoint *point = &race->point[i];
        while (point->error < 1e-8) /* where tolerance and reference are seen */
            point -= RACE_METHODS;
        const RacePoint *before = point - RACE_METHODS;
        double factor = pow(2, point->method->order);
        CHECK(point->method == before->method);
        CHECK_NEAR(point->h, before->h / 2, 1e-18);
        CHECK(point->seconds > 0 && point->seconds < 10);
        CHECK((point->updates > 0) == point->method->implicit);
        CHECK_NEAR(before->error / point->error, factor, 0.25 * factor);
    }
    simulation_free(&simulation);
}

/* Where no method has an answer to be compared with, the scene ends. */
TEST(race_may_have_no_answer)
{
    Simulation simulation;
    simulation_from_line("race --stiffness 1e16", NULL, NULL, &simulation);
    CHECK(simulation.done);
    CHECK_STATUS(simulation.status, STATUS_NOT_FINITE);
    simulation_free(&simulation);
}

/* ---- the envelope ------------------------------------------------------- */

/* A cell is the run that its command line makes. */
TEST(envelope_cells_are_runs)
{
    static const int cells[6][2] = {{13, 11}, {20, 8},  {24, 21},
                                    {0, 0},   {22, 21}, {24, 20}};
    int refused = 0;
    Simulation map, run;
    char line[256];
    simulation_from_line("envelope", NULL, NULL, &map);
    for (int i = 0; i < 6; i++) {
        Status worst = STATUS_OK;
        CHECK_STATUS(envelope_visit(&map, cells[i][0], cells[i][1]), STATUS_OK);
        const EnvelopeCell *cell =
            &map.exhibit.map.cell[cells[i][1]][cells[i][0]];
        snprintf(line, sizeof line,
                 "square --segments %d --stretch %.17g --timestep %.17g "
                 "--stiffness %.17g",
                 (int)map.options.segments, map.options.stretch,
                 envelope_timestep(cells[i][0]),
                 envelope_stiffness(cells[i][1]));
        simulation_from_line(line, NULL, NULL, &run);
        CHECK_NEAR(run.options.timestep, envelope_timestep(cells[i][0]), 0);
        CHECK_NEAR(run.options.stiffness, envelope_stiffness(cells[i][1]), 0);
        for (int step = 0; step < ENVELOPE_STEPS; step++) {
            Status status = simulation_step(&run);
            worst = status ? status : worst;
        }
        CHECK(cell->known);
        CHECK_STATUS(cell->worst, worst);
        refused += worst != STATUS_OK;
        CHECK(cell->updates == simulation_counters(&run).iterations);
        CHECK_SAME_BITS(map.run[0].x, run.run[0].x, 2 * run.system.nodes);
        simulation_free(&run);
    }
    CHECK(refused >= 1); /* such cells are compared too */
    simulation_free(&map);
}

/* Where nothing was done because of the tolerance, the map says so; not where
 * there was nothing to do, nor where a smaller one sees the forces. */
TEST(envelope_tells_where_nothing_was_done)
{
    static const struct {
        const char *line;
        int column, row;
        bool undone;
    } rows[] = {{"envelope", 13, 11, false},
                {"envelope", 24, 7, true},
                {"envelope", 0, 11, true},
                {"envelope --stretch 1", 24, 7, false},
                {"envelope --stretch 1", 0, 11, false},
                {"envelope --tolerance 1e-6", 24, 7, false},
                {"envelope --tolerance 1e-7", 0, 11, false}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Simulation map;
        simulation_from_line(rows[i].line, NULL, NULL, &map);
        CHECK_STATUS(envelope_visit(&map, rows[i].column, rows[i].row),
                     STATUS_OK);
        const EnvelopeCell *cell =
            &map.exhibit.map.cell[rows[i].row][rows[i].column];
        CHECK_STATUS(cell->worst, STATUS_OK);
        CHECK(cell->undone == rows[i].undone);
        simulation_free(&map);
    }
}

/* A row a step; the cell that is shown stays the one that was. */
TEST(envelope_fills_row_by_row)
{
    Simulation simulation;
    const EnvelopeMap *map = &simulation.exhibit.map;
    simulation_from_line("envelope", NULL, NULL, &simulation);
    CHECK_NEAR(envelope_stiffness(map->row), 1e5, 1e-9);
    CHECK_NEAR(log10(envelope_timestep(map->column)), log10(0.004), 0.25);
    int column = map->column, row = map->row, known = 0;
    while (!simulation.done)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    for (int i = 0; i < ENVELOPE_ROWS; i++)
        for (int j = 0; j < ENVELOPE_COLUMNS; j++)
            known += map->cell[i][j].known;
    CHECK(known == ENVELOPE_ROWS * ENVELOPE_COLUMNS);
    CHECK(simulation.steps == ENVELOPE_ROWS);
    CHECK(map->column == column && map->row == row);
    simulation_free(&simulation);
}

/* ---- predict, then show ------------------------------------------------- */

TEST(predictions_are_compared)
{
    Simulation simulation;
    simulation_from_line("arrows --integrator forward-euler", NULL, NULL,
                         &simulation);
    simulation_predict(&simulation, 1.3, 0.9); /* it will be (1, 0.5) */
    CHECK(simulation.prediction.made && !simulation.prediction.shown);
    simulation_step(&simulation);
    CHECK(simulation.prediction.shown);
    CHECK_NEAR(simulation.prediction.distance, 0.5, 1e-15);
    simulation_step(&simulation);
    CHECK(!simulation.prediction.made && !simulation.prediction.shown);
    simulation_free(&simulation);
    /* along x alone: from 2 to 2 - sinh(4)/2 */
    simulation_from_line("overshoot", NULL, NULL, &simulation);
    simulation_predict(&simulation, -11, 123);
    simulation_step(&simulation);
    CHECK_NEAR(simulation.prediction.distance, 0.644958598563875, 1e-12);
    exhibit_drag(&simulation, 0, 1.5, NAN); /* x alone counts */
    exhibit_drag(&simulation, 0, NAN, 1);
    CHECK(simulation.descent.point[0] == 1.5 && simulation.steps == 0);
    simulation_free(&simulation);
    /* a square is no single point */
    simulation_from_line("square", NULL, NULL, &simulation);
    simulation_predict(&simulation, 1, 1);
    CHECK(!simulation.prediction.made);
    simulation_free(&simulation);
}

TESTS(NULL, NULL)
