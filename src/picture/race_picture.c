#include <math.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
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
    for (int i = 0; i < RACE_METHODS && stage->text; i++)
        if (last[i])
            plot_words(
                &plot, 1, &(const double[2]){last[i]->seconds, last[i]->error},
                0.6, 0.95, FACE_BOLD, colour_of_method(race_method(i)->name),
                race_method(i)->label);
}

/* The quickest runs for three errors, explicit and implicit; run: 1, 2, 3. */
static void race_facts(const Simulation *simulation, Facts *facts)
{
    static const char *const names[2][3] = {
        {"explicit", "explicit ms", "explicit h"},
        {"implicit", "implicit ms", "implicit h"}};
    const Race *race = &simulation->exhibit.race;
    fact(facts, "methods", RACE_METHODS);
    fact(facts, "count", race->count);
    fact(facts, "most", RACE_METHODS * RACE_STEP_SIZES);
    fact(facts, "duration", RACE_TIME);
    fact_words(facts, "yet", simulation->done ? "with these h" : "yet");
    fact_when(facts, "failed", simulation->status);
    for (facts->run = 1; facts->run <= 3; facts->run++) {
        double error = pow(100, -facts->run);
        fact(facts, "error", error);
        for (int implicit = 0; implicit < 2; implicit++) {
            const RacePoint *best = race_quickest(race, error, implicit);
            const char *const *name = names[implicit];
            fact_words(facts, name[0], best ? best->method->label : NULL);
            fact(facts, name[1], best ? 1e3 * best->seconds : NAN);
            fact(facts, name[2], best ? 1e3 * best->h : NAN);
            fact_when(facts, implicit ? "no implicit" : "no explicit", !best);
        }
    }
    facts->run = 0;
}

static const Card card_race_numbers = {
    .name = "numbers",
    .title = "the quickest runs",
    .least = 17.5,
    .weight = 1.4,
    .words =
        "{count} of {most} runs, {duration} s of motion each\n"
        "#warning {failed}no answer to compare with: k is too large\n"
        "#faint hollow: it explodes when it goes on with this h\n"
        "@\nerror at most {error} m:\n"
        "#faint     {explicit}: {explicit ms} ms with h = {explicit h} ms\n"
        "#grey     {no explicit}no explicit method {yet}\n"
        "#faint     {implicit}: {implicit ms} ms with h = {implicit h} ms\n"
        "#grey     {no implicit}no implicit method {yet}",
};

const Picture race_picture = {
    .name = "race",
    .cards = (const Card *const[]){&card_page, &card_race_numbers, NULL},
    .stretched = true,
    .around = {-6.3, -9.3, 0.3, 1}, /* powers of ten: s across, m */
    .draw = race_draw,
    .facts = race_facts,
};
