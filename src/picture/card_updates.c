#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/inertia_energy.h"
#include "picture/cards.h"
#include "picture/colour_map.h"

/* Updates whose alpha p has been added to what is shown. */
static int updates_made(const Trace *trace)
{
    bool before = trace->line != LINE_NONE && trace->line < LINE_UPDATE;
    return before ? trace->iteration : trace->updates;
}

/* E of masses and springs at x, J s^2: its parts, and their sum. */
static void values_at(const System *system, const Trace *trace, const double *x,
                      double value[3])
{
    value[0] =
        inertia_energy_value(system->nodes, x, trace->x_tilde, system->m);
    value[1] = trace->h * trace->h * system_potential(system, x);
    value[2] = value[0] + value[1];
}

/* Along the line from x_tilde through x: why neither is lowest where one part
 * is. */
static void draw_way(const Plot *card, const System *system, const Trace *trace,
                     const double *x)
{
    enum { POINTS = 39, AIM = 6, NOW = 26 }; /* t = 0, 1 */
    static const int named[] = {18, 15, 34};
    static const double lower[] = {1, 0.72, 1};
    static const char *const names[] = {"inertia", "h\u00b2 P", "E"};
    static const Colour colours[] = {COLOUR_X_TILDE, COLOUR_SHADED, COLOUR_X};
    double t[POINTS], part[3][POINTS], value[3];
    size_t count = 2 * (size_t)system->nodes;
    double *at = malloc(count * sizeof *at);
    if (!at)
        return;
    for (int i = 0; i < POINTS; i++) {
        t[i] = 0.05 * (i - AIM);
        for (size_t c = 0; c < count; c++)
            at[c] = trace->x_tilde[c] + t[i] * (x[c] - trace->x_tilde[c]);
        values_at(system, trace, at, value);
        for (int k = 0; k < 3; k++)
            part[k][i] = value[k];
    }
    free(at);
    double high = fmax(part[2][AIM], part[2][NOW]);
    Plot plot =
        plot_create(card, (Axis){t[0], t[POINTS - 1], false, false, "t"},
                    (Axis){0, 1.4 * high, false, false, "J s\u00b2"});
    for (int k = 0; k < 3; k++)
        plot_curve(&plot, POINTS, t, part[k], k < 2 ? 1.6 : 2.4, colours[k]);
    for (int i = AIM; i <= NOW; i += NOW - AIM)
        plot_disc(&plot, (double[2]){t[i], part[2][i]}, 5,
                  colours[i > AIM ? 2 : 0]);
    for (int i = AIM; i <= NOW; i += NOW - AIM)
        plot_words(&plot, 1, (double[2]){t[i], part[2][i]},
                   colours[i > AIM ? 2 : 0], i > AIM ? "{x}: %s" : "{xt}: %s",
                   number_with(part[2][i], 4).text);
    for (int k = 0; k < 3; k++)
        plot_words(&plot, 1,
                   (double[2]){t[named[k]], lower[k] * part[k][named[k]]},
                   colours[k], "%s", names[k]);
}

/* From the start of the step on, a point an update. */
static void draw_values(const Plot *card, const Trace *trace, double now)
{
    int made = updates_made(trace);
    double start = now;
    for (int i = 0; i < made; i++)
        start -= trace->record[i].change;
    Plot plot = plot_create(
        card, (Axis){-0.4, fmax(made, 3) + 0.7, false, true, "update"},
        (Axis){0, 1.3 * start, false, false, "E, J s\u00b2"});
    for (int words = 0; words < 2; words++) { /* off all that is drawn */
        double at[2] = {0, start}, before[2];
        for (int i = 0; i <= made; i++) {
            memcpy(before, at, sizeof at);
            at[0] = i;
            at[1] += i > 0 ? trace->record[i - 1].change : 0;
            if (words) {
                plot_words(&plot, 1, at, COLOUR_X, "%s",
                           number_with(at[1], 4).text);
                continue;
            }
            plot_line(&plot, before, at, 1.6, COLOUR_X);
            plot_disc(&plot, at, 4.5, COLOUR_X);
        }
    }
}

/* E of the step in two graphs; in a narrow card the first alone. */
void values_draw(const Plot *card)
{
    const Pane *pane = show_pane(card->show);
    const Trace *trace = pane->trace;
    const System *system = &card->simulation->system;
    double value[3];
    Plot half = *card;
    if (!trace || !trace->x_tilde) {
        cards_hint(card, "N makes a step");
        return;
    }
    bool wide = card->box.width > 36 * card->em;
    half.box.width = (int)((wide ? 0.52 : 1) * card->box.width);
    draw_way(&half, system, trace, pane_x(pane));
    if (!wide)
        return;
    values_at(system, trace, pane_x(pane), value);
    half.box.x = card->box.x + half.box.width + paper_pixels(card->paper, 1);
    half.box.width = card->box.x + card->box.width - half.box.x;
    draw_values(&half, trace, value[2]);
}

/* A row of the table, 0: its heads; with what is known at this line. */
static void draw_update(const Plot *card, double y, int row,
                        const NewtonRecord *update, Line line)
{
    static const char *const heads[] = {"", "projected",
                                        "\u2016{p}\u2016_{\u221e}/h, m/s",
                                        "{alpha}", "change of E, J s\u00b2"};
    static const double right[] = {0.05, 0.25, 0.52, 0.63, 1};
    enum { COLUMNS = sizeof right / sizeof *right };
    const Trace *trace = show_pane(card->show)->trace;
    char cell[COLUMNS][96] = {""};
    if (row > 0)
        snprintf(cell[0], sizeof *cell, "%d", row);
    if (row > 0 && line >= LINE_PROJECT)
        snprintf(cell[1], sizeof *cell, "%d", update->projected);
    if (row > 0 && line >= LINE_SOLVE)
        snprintf(cell[2], sizeof *cell, "%s %s \u03b5",
                 number_of(update->residual).text,
                 update->residual > trace->tolerance ? ">" : "\u2264");
    if (row > 0 && line >= LINE_SEARCH &&
        (line > LINE_SEARCH || trace->accepted))
        snprintf(cell[3], sizeof *cell, "%s", number_of(update->alpha).text);
    if (row > 0 && line >= LINE_UPDATE)
        snprintf(cell[4], sizeof *cell, "%s", number_of(update->change).text);
    for (int c = 0; c < COLUMNS; c++)
        paper_write(card->paper, row ? FACE_REGULAR : FACE_BOLD, 1, COLOUR_TEXT,
                    card->box.x + right[c] * card->box.width, y, ALIGN_RIGHT,
                    "%s", row ? cell[c] : heads[c]);
}

/* The updates of this step so far, the present one as far as it has come. */
void updates_draw(const Plot *card)
{
    const Trace *trace = show_pane(card->show)->trace;
    double pitch = 1.45 * card->em, y = card->box.y + 0.2 * card->em;
    if (!trace) {
        cards_hint(card, "N makes a step");
        return;
    }
    int made = updates_made(trace);
    bool now = trace->line >= LINE_PROJECT && trace->line < LINE_UPDATE &&
               trace->projected >= 0;
    draw_update(card, y, 0, NULL, LINE_NONE);
    for (int i = 0; i < made + now; i++)
        draw_update(card, y + (i + 1) * pitch, i + 1, &trace->record[i],
                    i < made ? LINE_END : trace->line);
}
