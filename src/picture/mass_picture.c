#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/handles.h"
#include "scenes/small_scenes.h"

enum { MASS_CORNERS = 120 };

static const double MASS_REACH = 1.9; /* m, seen at least */
static const double MASS_TURN = 6.283185307179586;

Colour circle_colour(const Simulation *simulation, int run)
{
    return colour_of_method(simulation->run[run].method->name);
}

/* Runs side by side have the colours of their methods. */
static Colour run_colour(const Simulation *simulation, int run, Colour alone)
{
    return simulation->runs > 1 ? circle_colour(simulation, run) : alone;
}

/* Where the runs have been; with a disc for each step. */
static void draw_trails(Paper *paper, const Stage *stage, const Pane *pane,
                        bool steps)
{
    const Trail *trail = pane->trail;
    for (int r = 0; trail && r < pane->simulation->runs; r++)
        for (int i = 0; i < trail->count; i++) {
            const double *at = trail->point[r][i];
            Colour colour = steps ? run_colour(pane->simulation, r, COLOUR_X)
                                  : circle_colour(pane->simulation, r);
            if (steps)
                stage_disc(paper, stage, at, 3.5 * paper->unit, colour);
            if (i > 0)
                stage_line(paper, stage, trail->point[r][i - 1], at,
                           steps ? 1.6 : 2.2, colour);
        }
}

static double mass_energy(const double *x, const double *v)
{
    return 0.5 * (x[0] * x[0] + x[1] * x[1] + v[0] * v[0] + v[1] * v[1]);
}

/* The trail of each run; on the circle its radius, else its energy. */
static void mass_sample(const Simulation *simulation, History *history,
                        Trail *trail)
{
    bool circle = simulation->scene->picture == PICTURE_CIRCLE;
    double value[HISTORY_SERIES] = {0}, point[2 * TRAIL_RUNS] = {0};
    history->series = simulation->runs;
    for (int r = 0; r < simulation->runs; r++) {
        const double *x = simulation->run[r].x, *v = simulation->run[r].v;
        history->name[r] = simulation->run[r].method->label;
        value[r] = circle ? hypot(x[0], x[1]) : mass_energy(x, v);
        memcpy(point + 2 * r, x, 2 * sizeof *x);
    }
    history_add(history, simulation_time(simulation), value);
    if (trail)
        trail_add(trail, simulation->runs, point);
}

/* ---- the circle ---------------------------------------------------------- */

/* The exact path and its radius. */
static void draw_exact_circle(Paper *paper, const Stage *stage)
{
    const double middle[2] = {0, 0}, start[2] = {1, 0};
    double at[2];
    stage_ring(paper, stage, middle, stage->camera.scale[0], 5, COLOUR_GRID);
    stage_line(paper, stage, middle, start, 1.2, COLOUR_GREY);
    stage_disc(paper, stage, middle, 3.5 * paper->unit, COLOUR_GREY);
    const double half[2] = {0.5, 0};
    stage_pixel(stage, half, at);
    if (stage->text)
        paper_write(paper, FACE_REGULAR, 0.9, COLOUR_FAINT, at[0],
                    at[1] + 0.2 * paper->em, ALIGN_CENTRE, "1 m");
}

/* Trails, and a disc where each run is now. */
static void circle_draw(Paper *paper, const Stage *stage, const Show *show)
{
    const Pane *pane = &show->pane[stage->pane];
    const Simulation *simulation = pane->simulation;
    Legend legend = {0, 0};
    draw_exact_circle(paper, stage);
    draw_trails(paper, stage, pane, false);
    for (int r = 0; r < simulation->runs; r++)
        stage_disc(paper, stage, simulation->run[r].x, 7 * paper->unit,
                   circle_colour(simulation, r));
    if (show->bare || !stage->text)
        return;
    stage_legend(paper, stage, &legend, COLOUR_GREY, "exact: |{x}| = 1 m");
    for (int r = 0; r < simulation->runs; r++) {
        char radius[48];
        const double *x = simulation->run[r].x;
        plot_number(radius, sizeof radius, hypot(x[0], x[1]));
        stage_legend(paper, stage, &legend, circle_colour(simulation, r),
                     "%s: %s m", simulation->run[r].method->label, radius);
    }
    stage_scale(paper, stage);
}

/* The node of the nearest run. */
static Pick circle_pick(const Show *show, const Stage *stage, double x,
                        double y)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    Pick pick = {PICK_NONE, stage->pane, 0, {0, 0}};
    double best = 16;
    camera_world(&stage->camera, x, y, pick.point);
    for (int r = 0; r < simulation->runs; r++) {
        double at[2];
        stage_pixel(stage, simulation->run[r].x, at);
        double distance = hypot(at[0] - x, at[1] - y);
        if (distance < best) {
            best = distance;
            pick.kind = PICK_NODE;
            pick.index = r;
        }
    }
    return pick;
}

static const Card *const circle_cards[] = {&card_page, &card_radius,
                                           &card_methods, NULL};

const Picture circle_picture = {
    .name = "circle",
    .cards = circle_cards,
    .around = {-1.75, -1.75, 1.75, 1.75},
    .draw = circle_draw,
    .pick = circle_pick,
    .sample = mass_sample,
};

/* ---- the arrows ---------------------------------------------------------- */

/* What is farthest from the middle, in steps of sqrt(2), so that the view does
 * not move all the time. */
static void mass_bounds(const Show *show, int pane, double bounds[4])
{
    const Simulation *simulation = show->pane[pane].simulation;
    const double *began = simulation->exhibit.began;
    double most = hypot(hypot(began[0], began[1]), hypot(began[2], began[3]));
    for (int r = 0; r < simulation->runs; r++) {
        MassStep step;
        mass_next_step(simulation, r, &step);
        most = fmax(most, hypot(step.new_x[0], step.new_x[1]));
        most = fmax(most, hypot(step.x[0] + step.v[0], step.x[1] + step.v[1]));
    }
    bounds_around(MASS_REACH, 1.1 * most, M_SQRT2, bounds);
}

/* The exact path: a circle where v is across and as long as x. */
static void draw_mass_exact(Paper *paper, const Stage *stage,
                            const Simulation *simulation)
{
    for (int i = 0; i < MASS_CORNERS; i++) {
        double s = MASS_TURN * i / MASS_CORNERS;
        double t = MASS_TURN * (i + 1) / MASS_CORNERS;
        double a[2], b[2];
        mass_exact(simulation, s, a);
        mass_exact(simulation, t, b);
        stage_line(paper, stage, a, b, 4, COLOUR_GRID);
    }
}

/* An arrow from a along d, and the word beside it. */
typedef struct MassArrow {
    const double *a, *d;
    double width;
    Colour colour;
    const char *word;
} MassArrow;

/* Words keep off it. */
static void draw_mass_arrow(Paper *paper, const Stage *stage, Labels *labels,
                            const MassArrow *arrow)
{
    const double *a = arrow->a, b[2] = {a[0] + arrow->d[0], a[1] + arrow->d[1]};
    stage_arrow(paper, stage, a, arrow->d, 1, arrow->width, arrow->colour);
    keep_off_line(labels, stage, a, b);
}

/* Its word, unless it is short. */
static void label_mass_arrow(Paper *paper, const Stage *stage, Labels *labels,
                             const MassArrow *arrow)
{
    static const double part[] = {0.55, 0.8, 0.35, 0.7};
    const double *a = arrow->a, *d = arrow->d;
    double at[4][2], length = hypot(d[0], d[1]);
    if (!(length * stage->camera.scale[0] > 2 * stage->em))
        return;
    for (int i = 0; i < 4; i++) {
        const double point[2] = {a[0] + part[i] * d[0], a[1] + part[i] * d[1]};
        stage_pixel(stage, point, at[i]);
    }
    labels_put(paper, labels, FACE_BOLD, 1.15, arrow->colour, at, 4,
               0.35 * paper->em, arrow->word);
}

/* The arrows of one method in the order in which it makes them; then their
 * words, the most important ones first. */
static void draw_mass_step(Paper *paper, const Stage *stage,
                           const Simulation *simulation)
{
    static const int order[] = {0, 1, 3, 2, 4};
    MassStep step;
    Labels labels = {.stage = stage->box};
    double h = simulation->run[0].h, tip[2], way[2], push[2], at[2];
    if (!mass_next_step(simulation, 0, &step))
        return;
    bool backward = simulation->run[0].method->implicit;
    for (int i = 0; i < 2; i++) {
        tip[i] = step.x[i] + step.v[i];
        way[i] = step.new_x[i] - step.x[i];
        push[i] = h * (backward ? step.new_a[i] : step.a[i]);
    }
    const MassArrow arrow[] = {
        {step.x, step.v, 2.6, COLOUR_VELOCITY, "v"},
        {tip, push, 2.6, COLOUR_FORCE, backward ? "h a(x\u2032)" : "h a(x)"},
        {step.x, step.new_v, 1.4, COLOUR_VELOCITY, "v\u2032"},
        {step.x, way, 4, COLOUR_X, step.by_old_v ? "h v" : "h v\u2032"},
        {step.new_x, step.new_a, 1.6, COLOUR_FORCE, "a(x\u2032)"}};
    for (int i = 0; i < 4 + backward; i++)
        draw_mass_arrow(paper, stage, &labels, &arrow[i]);
    stage_ring(paper, stage, step.new_x, 9 * paper->unit, 2.4, COLOUR_X);
    keep_off_disc(&labels, paper, stage, step.new_x, 10);
    keep_off_disc(&labels, paper, stage, step.x, 11);
    keep_off_disc(&labels, paper, stage, tip, 11);
    if (!stage->text)
        return;
    stage_pixel(stage, step.new_x, at);
    labels_put(paper, &labels, FACE_BOLD, 1.15, COLOUR_X,
               (const double(*)[2])at, 1, 0.9 * paper->em, "x\u2032");
    for (int i = 0; i < 4 + backward; i++)
        label_mass_arrow(paper, stage, &labels, &arrow[order[i]]);
}

/* All three: the way that each goes next. */
static void draw_mass_ways(Paper *paper, const Stage *stage,
                           const Simulation *simulation)
{
    for (int r = 0; r < simulation->runs; r++) {
        MassStep step;
        mass_next_step(simulation, r, &step);
        const double way[2] = {step.new_x[0] - step.x[0],
                               step.new_x[1] - step.x[1]};
        stage_arrow(paper, stage, step.x, way, 1, 3,
                    circle_colour(simulation, r));
        stage_ring(paper, stage, step.new_x, 8 * paper->unit, 2.2,
                   circle_colour(simulation, r));
    }
}

/* While a guess is awaited the arrows would tell. */
static bool mass_is_hidden(const Show *show, const Simulation *simulation)
{
    const Prediction *guess = &simulation->prediction;
    return show->lecture && show->lecture->predict && guess->made &&
           !guess->shown;
}

static void mass_draw(Paper *paper, const Stage *stage, const Show *show)
{
    const Pane *pane = &show->pane[stage->pane];
    const Simulation *simulation = pane->simulation;
    const double origin[2] = {0, 0};
    Legend legend = {0, 0};
    draw_mass_exact(paper, stage, simulation);
    for (int r = 0; r < simulation->runs; r++)
        stage_line(paper, stage, origin, simulation->run[r].x, 1.4,
                   COLOUR_REST);
    stage_pin(paper, stage, origin, 5 * paper->unit);
    draw_trails(paper, stage, pane, true);
    if (simulation->runs > 1)
        draw_mass_ways(paper, stage, simulation);
    else if (!mass_is_hidden(show, simulation))
        draw_mass_step(paper, stage, simulation);
    for (int r = 0; r < simulation->runs; r++)
        stage_disc(paper, stage, simulation->run[r].x, 8 * paper->unit,
                   run_colour(simulation, r, COLOUR_X));
    if (show->bare || !stage->text)
        return;
    stage_legend(paper, stage, &legend, COLOUR_GREY, "the exact path");
    for (int r = 0; r < simulation->runs && simulation->runs > 1; r++)
        stage_legend(paper, stage, &legend, circle_colour(simulation, r), "%s",
                     simulation->run[r].method->label);
    stage_scale(paper, stage);
}

/* ---- the formula with its numbers --------------------------------------- */

static void add_mass_lines(const Simulation *simulation, Lines *lines)
{
    MassStep step;
    char x[64], v[64], a[64], new_x[64], new_v[64];
    double h = simulation->run[0].h;
    if (!mass_next_step(simulation, 0, &step)) {
        lines_add(lines, COLOUR_FAINT, "%s has more stages than arrows",
                  simulation->run[0].method->label);
        return;
    }
    bool backward = simulation->run[0].method->implicit;
    bool forward = step.by_old_v;
    point_text(x, sizeof x, step.x);
    point_text(v, sizeof v, step.v);
    point_text(a, sizeof a, backward ? step.new_a : step.a);
    point_text(new_x, sizeof new_x, step.new_x);
    point_text(new_v, sizeof new_v, step.new_v);
    lines_add(lines, COLOUR_TEXT, "v\u2032 = v + h a(%s)",
              backward ? "x\u2032" : "x");
    lines_add(lines, COLOUR_VELOCITY, "    = %s + %.3g %s = %s", v, h, a,
              new_v);
    lines_add(lines, COLOUR_TEXT, "{x}\u2032 = {x} + h %s",
              forward ? "v" : "v\u2032");
    lines_add(lines, COLOUR_X, "    = %s + %.3g %s = %s", x, h,
              forward ? v : new_v, new_x);
    lines_add(lines, COLOUR_TEXT, "%s", "");
}

static void draw_mass_numbers(Paper *paper, Box inside, const Show *show)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    Lines lines = {0};
    if (simulation->runs == 1)
        add_mass_lines(simulation, &lines);
    for (int r = 0; r < simulation->runs; r++) {
        MassStep step;
        if (!mass_next_step(simulation, r, &step))
            continue;
        double before = mass_energy(step.x, step.v);
        double after = mass_energy(step.new_x, step.new_v);
        lines_add(&lines, run_colour(simulation, r, COLOUR_TEXT),
                  "%s%senergy %.4g J \u2192 %.4g J  (\u00d7 %.4g)",
                  simulation->runs > 1 ? simulation->run[r].method->label : "",
                  simulation->runs > 1 ? ": " : "", before, after,
                  after / before);
    }
    lines_draw(paper, inside, &lines);
}

static const Card card_mass_numbers = {
    .name = "numbers",
    .title = "the step with its numbers",
    .least = 10.5,
    .weight = 1.1,
    .draw = draw_mass_numbers,
};

static const Card *const mass_cards[] = {&card_page, &card_mass_numbers,
                                         &card_energies, NULL};

const Picture mass_picture = {
    .name = "mass",
    .cards = mass_cards,
    .places = true,
    .bounds = mass_bounds,
    .draw = mass_draw,
    .sample = mass_sample,
};
