#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "scenes/small_scenes.h"

static const double NAMED = 36;  /* ems, for names beside the lines */
static const double NEAR = 0.01; /* m, the error that is asked for */

/* Across: run time, or h where that is switched on. */
static double place_of(const Simulation *simulation, const RacePoint *point)
{
    return simulation->exhibit.parts ? point->h : point->seconds;
}

/* Powers of ten. */
void race_bounds(const Plot *stage, double bounds[4])
{
    bool over_h = stage->simulation->exhibit.parts;
    bounds[0] = over_h ? -4.5 : -6.3;
    bounds[1] = over_h ? -12 : -10;
    bounds[2] = over_h ? -1.9 : 0.3;
    bounds[3] = over_h ? 5 : 3; /* below the switch */
}

/* The points of a method joined, hollow where it explodes later.  Returns the
 * last one; NULL: there is none. */
static const RacePoint *draw_method(Plot *plot, int method)
{
    const Simulation *simulation = plot->simulation;
    const Race *race = &simulation->exhibit.race;
    Colour colour = colour_of_method(race_method(method)->name);
    const RacePoint *last = NULL;
    for (int i = method; i < race->count; i += RACE_METHODS) {
        const RacePoint *point = &race->point[i];
        const double now[2] = {place_of(simulation, point), point->error};
        if (!(point->error > 0))
            continue;
        if (last)
            plot_line(plot,
                      (double[2]){place_of(simulation, last), last->error}, now,
                      2.2, colour);
        plot_hollow(plot, now, 5, point->stable ? 0 : 3, colour);
        last = point;
    }
    return last;
}

/* The names of the methods, each at its last point. */
void race_draw(Plot *stage)
{
    const Simulation *simulation = stage->simulation;
    const RacePoint *last[RACE_METHODS];
    bool over_h = simulation->exhibit.parts;
    bool wide = stage->text && stage->box.width > NAMED * stage->em;
    Plot plot = plot_on(
        stage,
        (Axis){.log = true, .label = over_h ? "h in s" : "run time in s"},
        (Axis){.log = true});
    const double at[2][2] = {{plot.x.low, NEAR}, {plot.x.high, NEAR}};
    if (!over_h)
        plot_dashes(&plot, at[0], at[1], 1.4, NULL, COLOUR_TEXT);
    if (!over_h && stage->text)
        plot_text(&plot, at[1], -0.4, -1.3, 0.95, ALIGN_RIGHT, FACE_BOLD,
                  COLOUR_TEXT, "1 cm");
    for (int i = 0; i < RACE_METHODS; i++)
        last[i] = draw_method(&plot, i);
    for (int i = 0; i < RACE_METHODS && wide; i++)
        if (last[i])
            plot_words(&plot, 1,
                       &(const double[2]){place_of(simulation, last[i]),
                                          last[i]->error},
                       0.6, 0.95, FACE_BOLD,
                       colour_of_method(race_method(i)->name),
                       race_method(i)->label);
}

/* The quickest stable run that is so near, of an implicit method or an explicit
 * one; NULL: there is none. */
static const RacePoint *find_quickest(const Race *race, bool implicit)
{
    const RacePoint *best = NULL;
    for (const RacePoint *at = race->point; at < race->point + race->count;
         at++)
        if (at->method->implicit == implicit && at->stable &&
            at->error <= NEAR && (!best || at->seconds < best->seconds))
            best = at;
    return best;
}

void race_facts(const Simulation *simulation, Facts *facts)
{
    static const char *const names[2][2] = {{"explicit", "explicit ms"},
                                            {"implicit", "implicit ms"}};
    for (int i = 0; i < 2; i++) {
        const RacePoint *best = find_quickest(&simulation->exhibit.race, i > 0);
        fact_words(facts, names[i][0], best ? best->method->label : "none");
        fact(facts, names[i][1], best ? 1e3 * best->seconds : INFINITY);
    }
    fact(facts, "methods", RACE_METHODS);
    fact_when(facts, "failed", simulation->status);
}

/* A number of a row of the table; nothing where it is not known. */
static void put_cell(char *cell, size_t size, const char *sign, double value,
                     int digits, const char *unit)
{
    if (isfinite(value))
        snprintf(cell, size, "%s%.40s%s", sign, number_with(value, digits).text,
                 unit);
}

/* A method a row: its error with h, by what it is divided as h is halved again
 * and again, the longest stable step, and with h what is left of the energy
 * after a second, and how long it took; a narrow card has room for some of it.
 */
void table_draw(const Plot *card)
{
    enum { COLUMNS = 9, HALVED = 4, CELL = 64 };
    static const char *const heads[COLUMNS] = {"",          "error, m", "h/2",
                                               "h/4",       "h/8",      "h/16",
                                               "stable at", "energy",   "time"};
    static const double columns[2][COLUMNS] = {
        {0, 0.56, 0, 0, 0, 0, 0.78, 0, 1},
        {0, 0.31, 0.395, 0.465, 0.535, 0.605, 0.735, 0.87, 1}};
    bool wide = card->box.width > 46 * card->paper->em;
    const Race *race = &card->simulation->exhibit.race;
    Paper *paper = card->paper;
    Box inside = card->box;
    double line = fmin(3.6 * paper->em, inside.height / (RACE_METHODS + 1.0));
    for (int row = 0; row <= RACE_METHODS; row++) {
        char cell[COLUMNS][CELL] = {""};
        int method = row > 0 ? row - 1 : 0;
        const IntegratorMethod *shown = race_method(method);
        const RacePoint *point =
            &race->point[RACE_SHOWN * RACE_METHODS + method];
        snprintf(cell[0], CELL, "%s", shown->label);
        if (race->count > point - race->point) {
            put_cell(cell[1], CELL, "", point->error, 2, "");
            snprintf(cell[7], CELL, "explodes");
            put_cell(cell[7], CELL, "\u00d7 ", point->later, 2, "");
            put_cell(cell[8], CELL, "", 1e3 * point->seconds, 2, " ms");
        }
        for (int k = 1; k <= HALVED; k++) {
            const RacePoint *half = point + RACE_METHODS;
            if (race->count > half - race->point)
                put_cell(cell[1 + k], CELL, "\u00f7 ",
                         point->error / half->error, 2, "");
            point = half;
        }
        if (shown->implicit)
            snprintf(cell[6], CELL, "linear: any");
        else if (race->count == RACE_METHODS * RACE_STEP_SIZES)
            snprintf(cell[6], CELL, "none");
        put_cell(cell[6], CELL, "",
                 shown->implicit ? NAN : 1e3 * race_stable(race, method), 3,
                 " ms");
        for (int c = 0; c < COLUMNS; c++)
            if (c == 0 || columns[wide][c] > 0)
                paper_write(paper, row ? FACE_REGULAR : FACE_BOLD, 1,
                            row && c == 0 ? colour_of_method(shown->name)
                                          : COLOUR_TEXT,
                            inside.x + columns[wide][c] * inside.width,
                            inside.y + row * line, c ? ALIGN_RIGHT : ALIGN_LEFT,
                            "%s", row ? cell[c] : heads[c]);
    }
}
