/* race_picture.c - run time against error of each method, and its table. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"

enum { HALVED_STEP_COLUMNS = 2 };        /* columns for h/2 and h/4 */
static const double NAMES_WIDTH = 20;    /* ems; a narrower plot has no names */
static const double TARGET_ERROR = 0.01; /* m, largest accepted error */

/* Returns bounds as powers of ten, of h or run time (ms) and of the error (m).
 * Errors below 1e-8 m and above 10 m may be outside. */
void find_race_bounds(const Plot *stage, double bounds[4])
{
    const MethodRace *race = &stage->simulation->exhibit.race;
    bool over_h = stage->simulation->exhibit.switches;
    bounds[0] = over_h ? -1.8 : -3.4;
    bounds[1] = -7.4;
    bounds[2] = over_h ? 1.1 : 2.1; /* leaves room for the methods' names */
    bounds[3] = 1.2; /* leaves room for the button "h instead of time" */
    for (int i = 0; i < race->run_count; i++) {
        const RaceResult *point = &race->result[i];
        double x = log10(1e3 * (over_h ? point->h : point->processor_time));
        double y = fmin(fmax(log10(point->error), -8), 1);
        if (!(point->error > 0))
            continue;
        bounds[0] = fmin(bounds[0], x - 0.6);
        bounds[1] = fmin(bounds[1], y - 0.3);
        bounds[2] = fmax(bounds[2], x + 0.2);
        bounds[3] = fmax(bounds[3], y + 1);
    }
}

/* Draws a curve through the points of each method; points of runs that explode
 * later are hollow.  If x is h, also draws the slopes of order 1 and 2. */
void draw_race_picture(Plot *stage)
{
    const Simulation *simulation = stage->simulation;
    const MethodRace *race = &simulation->exhibit.race;
    double named[RACE_METHODS][2]; /* place of the name; NaN: none */
    bool over_h = simulation->exhibit.switches;
    bool wide = stage->has_text && stage->box.width > NAMES_WIDTH * stage->em;
    Plot plot = plot_create_on_stage(
        stage,
        (Axis){.scale = SCALE_LOG,
               .label = over_h ? "h in ms" : "run time in ms"},
        (Axis){.scale = SCALE_LOG});
    const double at[2][2] = {{plot.x.low, TARGET_ERROR},
                             {plot.x.high, TARGET_ERROR}};
    if (!over_h)
        plot_dashes(&plot, at[0], at[1], 1.4, NULL, COLOUR_TEXT);
    for (int method = 0; method < RACE_METHODS; method++) {
        Colour colour = colour_of_name(race_get_method(method)->name);
        double last[2] = {NAN, NAN};
        named[method][0] = named[method][1] = NAN;
        for (int i = method; i < race->run_count; i += RACE_METHODS) {
            const RaceResult *point = &race->result[i];
            double seconds = over_h ? point->h : point->processor_time;
            const double now[2] = {1e3 * seconds, point->error};
            if (!(point->error > 0))
                continue;
            plot_line(&plot, last, now, 2.2, colour);
            plot_hollow_disc(&plot, now, 5, point->is_stable ? 0 : 3, colour);
            memcpy(last, now, sizeof now);
            memcpy(named[method], now, sizeof now);
        }
    }
    for (int order = 1; over_h && wide && order <= 2; order++) {
        const double from[2] = {0.025, 0.03}, way = 4.5;
        const double to[2] = {from[0] * way, from[1] * pow(way, order)};
        plot_dashes(&plot, from, to, 1.2, NULL, COLOUR_GREY);
        plot_label(&plot, 1, to, COLOUR_GREY, "order %d", order);
    }
    for (int method = 0; method < RACE_METHODS && wide; method++)
        plot_label(&plot, 1, named[method],
                   colour_of_name(race_get_method(method)->name), "%s",
                   race_get_method(method)->label);
}

/* Adds the fastest stable runs, explicit and implicit, within TARGET_ERROR. */
void list_race_values(const Simulation *simulation, LiveValues *values)
{
    static const char *const names[2][2] = {{"explicit", "explicit ms"},
                                            {"implicit", "implicit ms"}};
    const MethodRace *race = &simulation->exhibit.race;
    bool all = race->run_count == RACE_METHODS * RACE_STEP_SIZES;
    for (int i = 0; i < 2; i++) {
        const RaceResult *best = NULL, *at = race->result;
        for (; at < race->result + race->run_count; at++)
            if ((at->method->stages > 0) == (i == 1) && at->is_stable &&
                at->error <= TARGET_ERROR &&
                (!best || at->processor_time < best->processor_time))
                best = at;
        values_add_words(values, names[i][0],
                         best ? best->method->label : NULL);
        values_add(values, names[i][1],
                   best ? 1e3 * best->processor_time : NAN);
        values_add_flag(values, i ? "" : "no explicit", !best && all);
    }
    values_add_flag(
        values, simulation->exhibit.switches ? "over h" : "over time", true);
    values_add(values, "methods", RACE_METHODS);
    if (race->run_count > 0)
        values_add(values, "longest h", 1e3 * race->result[0].h);
    values_add_flag(values, "failed", simulation->status);
}

/* Writes a number into a cell, which stays as it is if value is not finite. */
static void format_cell(char cell[CARD_CELL], const char *sign, double value)
{
    if (isfinite(value))
        snprintf(cell, CARD_CELL, "%s%.40s", sign,
                 format_digits(value, 2).text);
}

/* Fills a method's row with its error (m) at the shown h, and with the factors
 * by which the error falls from h to h/2 and from h/2 to h/4. */
bool race_make_row(const FrameContent *content, int row, CardTableRow *cells)
{
    const MethodRace *race = &active_pane(content)->simulation->exhibit.race;
    int method = row - 1;
    if (row == 0 || row > RACE_METHODS)
        return row == 0;
    const IntegratorMethod *shown = race_get_method(method);
    const RaceResult *point =
        &race->result[RACE_SHOWN_STEP_INDEX * RACE_METHODS + method];
    char(*cell)[CARD_CELL] = cells->cell;
    cells->colour = colour_of_name(shown->name);
    snprintf(cell[0], CARD_CELL, "%s", shown->label);
    if (race->run_count > point - race->result) {
        snprintf(cell[1], CARD_CELL, "explodes");
        format_cell(cell[1], "", point->error);
    }
    for (int k = 1; k <= HALVED_STEP_COLUMNS; k++) {
        const RaceResult *half = point + RACE_METHODS;
        if (race->run_count <= half - race->result)
            break;
        snprintf(cell[1 + k], CARD_CELL, "\u2013");
        format_cell(cell[1 + k], "\u00f7 ", point->error / half->error);
        point = half;
    }
    return true;
}

void draw_race_table_card(const Plot *card)
{
    static const int order[CARD_COLUMNS] = {0, 1, 2, 3};
    card_draw_table(card, &card_race_table, order);
}
