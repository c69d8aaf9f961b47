#include <math.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/handles.h"
#include "scenes/small_scenes.h"

/* The points of a method joined, hollow where it explodes later; words keep
 * off the lines.  Returns the last one; NULL: there is none. */
static const RacePoint *draw_method(Plot *plot, const Race *race, int method)
{
    Colour colour = colour_of_method(race_method(method)->name);
    const RacePoint *last = NULL;
    for (int i = method; i < race->count; i += RACE_METHODS) {
        const RacePoint *point = &race->point[i];
        const double now[2] = {point->seconds, point->error};
        if (!(point->error > 0))
            continue;
        if (last) {
            const double before[2] = {last->seconds, last->error};
            plot_line(plot, before, now, 2.2, colour);
            plot_keep_line(plot, before, now);
        }
        plot_hollow(plot, now, 5, point->stable ? 0 : 3, colour);
        last = point;
    }
    return last;
}

/* The names of the methods, each at its last point. */
static void race_draw(Plot *stage, const Show *show)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    static const PlotRoom room = {4, 5, 1.6, 3.6};
    const RacePoint *last[RACE_METHODS];
    Plot plot =
        plot_on(stage, &room, (Axis){.log = true, .label = "run time in s"},
                (Axis){.log = true, .label = "error in m"});
    for (int i = 0; i < RACE_METHODS; i++)
        last[i] = draw_method(&plot, &simulation->exhibit.race, i);
    for (int i = 0; i < RACE_METHODS && stage->text && !show->bare; i++)
        if (last[i])
            plot_words(
                &plot, 1, &(const double[2]){last[i]->seconds, last[i]->error},
                0.6, 0.95, FACE_BOLD, colour_of_method(race_method(i)->name),
                race_method(i)->label);
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

const Picture race_picture = {
    .name = "race",
    .cards = (const Card *const[]){&card_page, &card_race_numbers, NULL},
    .stretched = true,
    .around = {-6.3, -9.3, 0.3, 1}, /* powers of ten: s across, m */
    .draw = race_draw,
};
