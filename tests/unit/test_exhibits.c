/* The lecture's small scenes, held to formulas written here once more. */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model/mass_spring_energy.h"
#include "scenes/small_scenes.h"

/* ---- one mass ----------------------------------------------------------- */

/* The mass keeps its velocity and the tip its place where the other is dragged;
 * the exact path is the ellipse from there, also after another method is
 * chosen.  All runs follow. */
TEST(mass_is_dragged)
{
    Simulation *scene = simulate("arrows"), *one;
    double at[SCENE_MAX_HANDLES][2], now[2], later[2];
    make_steps(scene, 1);
    exhibit_drag(scene, 0, 0.25, -0.5);
    exhibit_drag(scene, 1, 0.25 + 2, -0.5 + 3);
    CHECK(exhibit_handles(scene, at) == 2);
    CHECK(at[0][0] == 0.25 && at[1][1] == 2.5);
    const double x[2] = {0.25, -0.5}, v[2] = {2, 3};
    for (int run = 0; run < 3; run++) {
        CHECK_SAME_BITS(scene->run[run].x, x, 2);
        CHECK_SAME_BITS(scene->run[run].v, v, 2);
    }
    one = simulate("arrows --integrator forward-euler");
    exhibit_drag(one, 0, 0.25, -0.5);
    exhibit_drag(one, 1, 0.25 + 2, -0.5 + 3);
    for (int changed = 0; changed < 2; changed++) {
        Options other = one->options;
        mass_exact(one, 0, now);
        mass_exact(one, 0.5 * M_PI, later);
        CHECK_SAME_BITS(now, x, 2);
        for (int i = 0; i < 2; i++)
            CHECK_NEAR(later[i], v[i], 1e-15);
        make_steps(one, 1);
        other.integrator =
            integrator_method("symplectic-euler") - integrator_methods;
        CHECK_STATUS(simulation_change(one, &other), STATUS_OK);
    }
}

/* ---- Newton in one dimension -------------------------------------------- */

/* E and g = E' of the header's formula, in extended precision: m = 1 kg,
 * k = 10 J/m^2, l = 1 m, h = 0.3 s. */
static long double line_E(const Simulation *scene, long double x)
{
    long double s = x * x - 1, d = x - scene->exhibit.target[0];
    return d * d / 2 + 0.45L * s * s;
}

static long double line_g(const Simulation *scene, long double x)
{
    return x - scene->exhibit.target[0] + 1.8L * x * (x * x - 1);
}

static void finish(Simulation *scene)
{
    while (!scene->done)
        CHECK_STATUS(simulation_step(scene), STATUS_OK);
}

/* The next iterate is where the tangent of g is zero; the limit is a root.  A
 * dragged start or x_tilde begins anew, with the same E elsewhere. */
TEST(tangent_follows_tangents)
{
    Simulation *scene = simulate("tangent");
    double at[SCENE_MAX_HANDLES][2];
    for (int drag = 0; drag < 3; drag++) {
        while (!scene->done) {
            double x = scene->descent.point[0];
            double slope = descent_at(scene, FILTER_NONE, x, 0).H[0];
            make_steps(scene, 1);
            CHECK_NEAR(scene->descent.point[0], x - line_g(scene, x) / slope,
                       1e-13);
        }
        /* |p| <= 1e-10 and g = -E'' p with E'' < 10 */
        CHECK_NEAR(line_g(scene, scene->descent.point[0]), 0, 1e-9);
        CHECK(drag || scene->steps == 6 || scene->steps == 7);
        exhibit_drag(scene, drag ? 0 : 1, drag ? -2.25 : -1.5, 7);
        CHECK(scene->steps == 0 && !scene->done);
        CHECK(exhibit_handles(scene, at) == 2 && at[1][0] == -1.5);
        CHECK_NEAR(at[0][1], line_E(scene, at[0][0]), 1e-13);
        CHECK(!drag || at[0][0] == -2.25);
    }
    exhibit_drag(scene, 0, NAN, 0);
    CHECK(isfinite(scene->run[0].x[0]));
}

/* ---- two unknowns ------------------------------------------------------- */

/* |grad E| of the landscape's free node by the formula, in extended
 * precision. */
static long double dial_gradient(const Simulation *scene, double h,
                                 const double point[2])
{
    long double g[2];
    for (int i = 0; i < 2; i++)
        g[i] = point[i] - (long double)scene->exhibit.target[i];
    for (int pin = -1; pin <= 1; pin += 2) {
        long double d[2] = {point[0] - pin, point[1]};
        long double s = (d[0] * d[0] + d[1] * d[1]) / 2.25L - 1;
        for (int i = 0; i < 2; i++)
            g[i] += (long double)h * h * 200 * s * d[i];
    }
    return hypotl(g[0], g[1]);
}

/* Each point of the walk is a minimiser: its gradient is rounding of numbers
 * about h^2 k = 1e4 and 1.  With x_tilde on the line of the pins a short step
 * ends there; a longer one does not end on the saddle that is there then. */
TEST(dial_walks_over_minimisers)
{
    static const double target[3][2] = {{0.2, 0.3}, {-0.5, 0.9}, {0.2, 0}};
    Simulation *scene = simulate("dial");
    const Walk *walk = &scene->exhibit.walk;
    for (int drag = 0; drag < 3; drag++) {
        if (drag)
            exhibit_drag(scene, 0, target[drag][0], target[drag][1]);
        for (int i = 0; i < WALK_POINTS; i++) {
            const double *at = walk->point[i], h = walk->h[i];
            const double *before = i ? walk->point[i - 1] : at;
            CHECK_AT_MOST(dial_gradient(scene, h, at),
                          1e-13 * (1 + 100 * h * h));
            CHECK(i == 0 || h > walk->h[i - 1]);
            scene->run[0].h = h;
            CHECK(descent_bends_down(scene, at[0], at[1]) == 0);
            if (drag < 2) /* it walks and does not jump */
                CHECK_AT_MOST(hypot(at[0] - before[0], at[1] - before[1]), 0.2);
        }
    }
    CHECK_NEAR(walk->point[0][1], 0, 1e-12);
    CHECK_NEAR(fabs(walk->point[WALK_POINTS - 1][1]), sqrt(1.25), 1e-4);
}

/* From x_tilde to rest: there the free node is 1.5 m from both pins. */
TEST(dial_turns_from_target_to_rest)
{
    const Simulation *short_step = simulate("dial --timestep 1e-6");
    CHECK_NEAR(short_step->run[0].x[0], 0.2, 1e-9);
    CHECK_NEAR(short_step->run[0].x[1], 0.3, 1e-9);
    Simulation *scene = simulate("dial");
    double h = scene->options.timestep;
    make_steps(scene, 1);
    CHECK_NEAR(scene->options.timestep, h * pow(10, 0.1), 1e-15);
    finish(scene);
    CHECK_NEAR(scene->options.timestep, 10, 0);
    /* inertia still pulls: by 1 / (h^2 k) = 1e-4 of its distance */
    CHECK_NEAR(scene->run[0].x[0], 0, 1e-4);
    CHECK_NEAR(scene->run[0].x[1], sqrt(1.25), 1e-4);
}

/* |x - (0.2, 0.3)|^2 / 2 and 0.2^2 sum 2.25 100/2 (|x - pin|^2/2.25 - 1)^2,
 * J s^2, wherever Newton is. */
TEST(landscape_has_two_parts)
{
    Simulation *scene = simulate("landscape");
    Switch out[SCENE_MAX_SWITCHES];
    for (double x = -1.5; x < 1.6; x += 0.31) {
        double y = 0.7 * x + 0.1;
        double inertia = landscape_part_value(scene, PART_INERTIA, x, y);
        double elastic = landscape_part_value(scene, PART_ELASTICITY, x, y);
        double by_hand = (x - 0.2) * (x - 0.2) + (y - 0.3) * (y - 0.3);
        CHECK_NEAR(inertia, 0.5 * by_hand, 1e-15);
        by_hand = 0;
        for (int pin = -1; pin <= 1; pin += 2) {
            double s = ((x - pin) * (x - pin) + y * y) / 2.25 - 1;
            by_hand += 0.04 * 2.25 * 100 / 2 * s * s;
        }
        CHECK_NEAR(elastic, by_hand, 1e-12);
        CHECK_NEAR(inertia + elastic, descent_value(scene, x, y), 1e-13);
        if (!scene->done)
            make_steps(scene, 1);
    }
    CHECK(exhibit_switches(scene, out) == 2 && out[0].on && out[1].on);
    exhibit_flip(scene, 0);
    CHECK(scene->exhibit.parts == PART_ELASTICITY);
    CHECK(descent_bends_down(scene, 0.1, -0.35));
    exhibit_flip(scene, 1); /* the last one: the other comes back */
    CHECK(scene->exhibit.parts == PART_INERTIA);
    CHECK(!descent_bends_down(scene, 0.1, -0.35));
    exhibit_flip(scene, 1);
    CHECK(scene->exhibit.parts == PART_BOTH);
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
    for (int i = 0; i < 10; i++) {
        Simulation *scene = simulate("%s", lines[i / 2]);
        const Descent *descent = &scene->descent;
        bool off = i % 2;
        make_steps(scene, 1);
        exhibit_flip(scene, off);
        unsigned part = off ? PART_INERTIA : PART_ELASTICITY;
        CHECK(scene->exhibit.parts == part && descent->count == 0);
        while (!scene->done) {
            double before = descent->value;
            make_steps(scene, 1);
            CHECK(descent->value < before);
        }
        CHECK(!off || descent->count == 1);
        CHECK_AT_MOST(descent->residual, scene->options.tolerance);
        /* p <= h 1e-6, twice: E <= 10 p^2 */
        const double *at = descent->point;
        CHECK_AT_MOST(landscape_part_value(scene, part, at[0], at[1]), 1e-12);
    }
    /* both springs along x: elasticity alone has no H^-1 */
    Simulation *flat = simulate("landscape --start 0.3,0");
    exhibit_flip(flat, 0);
    CHECK_STATUS(flat->status, STATUS_SINGULAR);
    CHECK(flat->done && flat->descent.direction[0] == 0);
}

/* Newton begins anew where the iterate is dragged to, or with another target:
 * as a scene that was started there. */
TEST(landscape_is_dragged)
{
    Simulation *dragged = simulate("landscape");
    Simulation *fresh = simulate("landscape --start 0.9,-0.8");
    finish(dragged);
    exhibit_drag(dragged, 1, 0.9, -0.8);
    CHECK(!dragged->done && dragged->steps == 0);
    CHECK_NEAR(dragged->descent.slope, fresh->descent.slope,
               1e-12 * fabs(fresh->descent.slope));
    while (!dragged->done && !fresh->done) {
        make_steps(dragged, 1);
        make_steps(fresh, 1);
        for (int k = 0; k < 2; k++)
            CHECK_NEAR(dragged->run[0].x[k], fresh->run[0].x[k], 1e-12);
    }
    CHECK(dragged->done && fresh->done);
    exhibit_drag(dragged, 0, 0.3, -1.3);
    finish(dragged);
    CHECK_AT_MOST(dial_gradient(dragged, 0.2, dragged->run[0].x), 1e-5);
}

/* ---- one spring --------------------------------------------------------- */

/* As stiff at rest, and without a bound below beside it. */
TEST(spring_with_a_square_root_is_worse)
{
    SpringFacts rest, near, none;
    spring_facts((double[2]){1, 0}, 1, 100, &rest);
    spring_facts((double[2]){1e-3, 0}, 1, 100, &near);
    spring_facts((double[2]){0, 0}, 1, 100, &none);
    CHECK(rest.along == 400 && rest.root_along == 400);
    CHECK(rest.across == 0 && rest.root_across == 0);
    CHECK(rest.root_energy == rest.energy);
    CHECK_NEAR(near.across, -200, 1e-3);
    CHECK_NEAR(near.root_across, -399600, 1e-6);
    CHECK(none.across == -200 && none.along == -200 && none.force[0] == 0);
    CHECK(none.root_across == -INFINITY);
}

TEST(spring_is_dragged)
{
    Simulation *scene = make_steps(simulate("spring"), 5);
    double at[SCENE_MAX_HANDLES][2];
    exhibit_drag(scene, 0, 0.2, 0.1);
    CHECK(exhibit_handles(scene, at) == 1);
    CHECK(at[0][0] == 0.2 && scene->run[0].v[1] == 0);
    make_steps(scene, 200);
    CHECK(scene->run[0].x[2] == 0); /* held */
    /* backward Euler has taken nearly all of the energy of 45 J */
    CHECK_AT_MOST(simulation_energies(scene, 0).total, 1);
}

/* ---- run time against error --------------------------------------------- */

TEST(race_has_a_run_for_each_point)
{
    Simulation *scene = simulate("race");
    const Race *race = &scene->exhibit.race;
    finish(scene);
    CHECK(race->count == RACE_METHODS * RACE_STEP_SIZES);
    for (int i = RACE_METHODS; i < race->count; i++) {
        const RacePoint *point = &race->point[i];
        const RacePoint *before = point - RACE_METHODS;
        CHECK(point->method == before->method);
        CHECK_NEAR(point->h, before->h / 2, 1e-18);
        CHECK(point->seconds > 0 && point->seconds < 10);
        CHECK((point->updates > 0) == point->method->implicit);
    }
    /* where no method has an answer to be compared with, the scene ends */
    scene = simulate("race --stiffness 1e16");
    CHECK(scene->done);
    CHECK_STATUS(scene->status, STATUS_NOT_FINITE);
}

/* ---- the envelope ------------------------------------------------------- */

static const EnvelopeCell *visit(Simulation *map, int column, int row)
{
    CHECK_STATUS(envelope_visit(map, column, row), STATUS_OK);
    return &map->exhibit.map.cell[row][column];
}

/* A cell is the run that its command line makes. */
TEST(envelope_cells_are_runs)
{
    static const int cells[6][2] = {{13, 11}, {20, 8},  {24, 21},
                                    {0, 0},   {22, 21}, {24, 20}};
    Simulation *map = simulate("envelope");
    int refused = 0;
    for (int i = 0; i < 6; i++) {
        int column = cells[i][0], row = cells[i][1];
        const EnvelopeCell *cell = visit(map, column, row);
        Status worst = STATUS_OK;
        Simulation *run =
            simulate("square --segments %d --stretch %.17g --timestep %.17g "
                     "--stiffness %.17g",
                     (int)map->options.segments, map->options.stretch,
                     envelope_timestep(column), envelope_stiffness(row));
        for (int step = 0; step < ENVELOPE_STEPS; step++) {
            Status status = simulation_step(run);
            worst = status ? status : worst;
        }
        CHECK(cell->known);
        CHECK_STATUS(cell->worst, worst);
        refused += worst != STATUS_OK;
        CHECK(cell->updates == simulation_counters(run).iterations);
        CHECK_SAME_BITS(map->run[0].x, run->run[0].x, 2 * run->system.nodes);
    }
    CHECK(refused >= 1); /* such cells are compared too */
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
        const EnvelopeCell *cell =
            visit(simulate("%s", rows[i].line), rows[i].column, rows[i].row);
        CHECK_STATUS(cell->worst, STATUS_OK);
        CHECK(cell->undone == rows[i].undone);
    }
}

/* A row a step; the cell that is shown stays the one that was. */
TEST(envelope_fills_row_by_row)
{
    Simulation *scene = simulate("envelope");
    const EnvelopeMap *map = &scene->exhibit.map;
    CHECK_NEAR(envelope_stiffness(map->row), 1e5, 1e-9);
    CHECK_NEAR(log10(envelope_timestep(map->column)), log10(0.004), 0.25);
    int column = map->column, row = map->row, known = 0;
    finish(scene);
    for (int i = 0; i < ENVELOPE_ROWS * ENVELOPE_COLUMNS; i++)
        known += map->cell[i / ENVELOPE_COLUMNS][i % ENVELOPE_COLUMNS].known;
    CHECK(known == ENVELOPE_ROWS * ENVELOPE_COLUMNS);
    CHECK(scene->steps == ENVELOPE_ROWS);
    CHECK(map->column == column && map->row == row);
}

/* ---- predict, then show ------------------------------------------------- */

TEST(predictions_are_compared)
{
    Simulation *scene = simulate("arrows --integrator forward-euler");
    const Prediction *guess = &scene->prediction;
    simulation_predict(scene, 1.3, 0.9); /* it will be (1, 0.5) */
    CHECK(guess->made && !guess->shown);
    make_steps(scene, 1);
    CHECK(guess->shown);
    CHECK_NEAR(guess->distance, 0.5, 1e-15);
    make_steps(scene, 1);
    CHECK(!guess->made && !guess->shown);
    /* along x alone: from 2 to 2 - sinh(4)/2 */
    scene = simulate("overshoot");
    simulation_predict(scene, -11, 123);
    make_steps(scene, 1);
    CHECK_NEAR(scene->prediction.distance, 0.644958598563875, 1e-12);
    exhibit_drag(scene, 0, 1.5, NAN); /* x alone counts */
    exhibit_drag(scene, 0, NAN, 1);
    CHECK(scene->descent.point[0] == 1.5 && scene->steps == 0);
    scene = simulate("square"); /* no single point */
    simulation_predict(scene, 1, 1);
    CHECK(!scene->prediction.made);
}

TESTS(NULL, NULL)
