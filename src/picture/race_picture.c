#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/handles.h"
#include "picture/labels.h"
#include "scenes/race_scene.h"

/* Powers of ten: run time in s, error in m. */
static const double RACE_BOUNDS[4] = {-6.3, -9.3, 0.3, 1};

static void race_bounds(const Show *show, int pane, double bounds[4])
{
    (void)show;
    (void)pane;
    for (int i = 0; i < 4; i++)
        bounds[i] = RACE_BOUNDS[i];
}

/* The last point of a method; NULL: there is none. */
static const RacePoint *race_last(const Race *race, int method)
{
    const RacePoint *last = NULL;
    for (int i = method; i < race->count; i += RACE_METHODS)
        if (race->point[i].error > 0)
            last = &race->point[i];
    return last;
}

/* The points of a method joined; words keep off the lines. */
static void race_method_curve(Paper *paper, const Plot *plot, const Race *race,
                              int method, Labels *labels)
{
    Colour colour = colour_of_method(race_method(method)->name);
    double before[2] = {NAN, NAN};
    for (int i = method; i < race->count; i += RACE_METHODS) {
        const RacePoint *point = &race->point[i];
        const double now[2] = {point->seconds, point->error};
        double from[2], to[2];
        if (!(point->error > 0))
            continue;
        if (isfinite(before[0])) {
            plot_line(paper, plot, before, now, 2.2, colour);
            plot_place(plot, before[0], before[1], from);
            plot_place(plot, now[0], now[1], to);
            labels_line(labels, from, to);
        }
        if (plot_disc(paper, plot, now, 5, colour) && !point->stable)
            plot_disc(paper, plot, now, 3, COLOUR_WHITE);
        before[0] = now[0];
        before[1] = now[1];
    }
}

/* The names of the methods, each at its last point. */
static void race_names(Paper *paper, const Plot *plot, const Race *race,
                       Labels *labels)
{
    for (int i = 0; i < RACE_METHODS; i++) {
        const RacePoint *last = race_last(race, i);
        double at[2];
        if (!last)
            continue;
        plot_place(plot, last->seconds, last->error, at);
        labels_put(paper, labels, FACE_BOLD, 0.95,
                   colour_of_method(race_method(i)->name),
                   (const double(*)[2])at, 1, 0.6 * paper->em,
                   race_method(i)->label);
    }
}

static void race_draw(Paper *paper, const Stage *stage, const Show *show)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    Plot plot = {stage->box,
                 {0, 1, true, false, "run time in s"},
                 {0, 1, true, false, "error in m"}};
    double low[2], high[2];
    if (stage->text) {
        plot.box.x += paper_pixels(paper, 4);
        plot.box.width -= paper_pixels(paper, 5);
        plot.box.y += paper_pixels(paper, 1.6);
        plot.box.height -= paper_pixels(paper, 3.6);
    }
    camera_world(&stage->camera, plot.box.x, plot.box.y + plot.box.height, low);
    camera_world(&stage->camera, plot.box.x + plot.box.width, plot.box.y, high);
    plot.x.low = pow(10, low[0]);
    plot.x.high = pow(10, high[0]);
    plot.y.low = pow(10, low[1]);
    plot.y.high = pow(10, high[1]);
    if (stage->text)
        plot_axes(paper, &plot);
    Labels labels = {.stage = stage->box};
    for (int i = 0; i < RACE_METHODS; i++)
        race_method_curve(paper, &plot, &simulation->exhibit.race, i, &labels);
    if (stage->text && !show->bare)
        race_names(paper, &plot, &simulation->exhibit.race, &labels);
}

static Pick race_pick(const Show *show, const Stage *stage, double x, double y)
{
    Pick pick = {PICK_NONE, stage->pane, 0, {0, 0}};
    (void)show;
    camera_world(&stage->camera, x, y, pick.point);
    return pick;
}

static void race_draw_numbers(Paper *paper, Box inside, const Show *show)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    const Race *race = &simulation->exhibit.race;
    Lines lines = {0};
    lines_add(&lines, COLOUR_TEXT, "%d of %d runs, %g s of motion each",
              race->count, RACE_METHODS * RACE_STEP_SIZES, RACE_TIME);
    for (double error = 1e-2; error > 0.5e-6; error /= 100) {
        lines_add(&lines, COLOUR_TEXT, "error at most %g m:", error);
        for (int implicit = 0; implicit < 2; implicit++) {
            const RacePoint *best = race_quickest(race, error, implicit);
            if (best)
                lines_add(
                    &lines, COLOUR_FAINT, "    %s: %.3g ms with h = %.3g ms",
                    best->method->label, 1e3 * best->seconds, 1e3 * best->h);
            else
                lines_add(&lines, COLOUR_GREY, "    no %s method%s",
                          implicit ? "implicit" : "explicit",
                          simulation->done ? " with these h" : " yet");
        }
    }
    lines_add(&lines, COLOUR_FAINT,
              "hollow: it explodes when it goes on with this h");
    if (simulation->status)
        lines_add(&lines, COLOUR_WARNING,
                  "no answer to compare with: k is "
                  "too large");
    lines_draw(paper, inside, &lines);
}

static const Card card_race_numbers = {
    .name = "numbers",
    .title = "the quickest runs",
    .least = 17.5,
    .weight = 1.4,
    .draw = race_draw_numbers,
};

static const Card *const race_cards[] = {&card_page, &card_race_numbers, NULL};

const Picture race_picture = {
    .name = "race",
    .cards = race_cards,
    .stretched = true,
    .bounds = race_bounds,
    .draw = race_draw,
    .pick = race_pick,
};
