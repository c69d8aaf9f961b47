#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/handles.h"
#include "scenes/small_scenes.h"

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
        plot_hollow(paper, plot, now, 5, point->stable ? 0 : 3, colour);
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
    static const StageRoom room = {4, 5, 1.6, 3.6};
    Plot plot = stage_plot(paper, stage, &room,
                           (Axis){.log = true, .label = "run time in s"},
                           (Axis){.log = true, .label = "error in m"});
    Labels labels = {.stage = stage->box};
    for (int i = 0; i < RACE_METHODS; i++)
        race_method_curve(paper, &plot, &simulation->exhibit.race, i, &labels);
    if (stage->text && !show->bare)
        race_names(paper, &plot, &simulation->exhibit.race, &labels);
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
    .around = {-6.3, -9.3, 0.3, 1}, /* powers of ten: s across, m */
    .draw = race_draw,
};
