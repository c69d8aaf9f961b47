#include <math.h>
#include <stdio.h>
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

/* E of masses and springs, J s^2. */
static double value_at(const System *system, const Trace *trace,
                       const double *x)
{
    return inertia_energy_value(system->nodes, x, trace->x_tilde, system->m) +
           trace->h * trace->h * system_potential(system, x);
}

/* From the start of the step on, a point an update; and how high x_tilde is. */
void values_draw(const Plot *card)
{
    const Pane *pane = show_pane(card->show);
    const Trace *trace = pane->trace;
    const System *system = &card->simulation->system;
    if (!trace || !trace->x_tilde) {
        cards_hint(card, "N makes a step");
        return;
    }
    int made = updates_made(trace);
    double start = value_at(system, trace, pane_x(pane));
    double aim = value_at(system, trace, trace->x_tilde);
    for (int i = 0; i < made; i++)
        start -= trace->record[i].change;
    double right = fmax(made, 3) + 0.7;
    Plot plot = plot_create(
        card, (Axis){-0.4, right, false, true, "update"},
        (Axis){0, 1.3 * fmax(start, aim), false, false, "E, J s\u00b2"});
    const double from[2] = {-0.4, aim}, to[2] = {right, aim};
    const double told[2] = {0.5 * right, aim};
    plot_dashes(&plot, from, to, 1.6, NULL, COLOUR_X_TILDE);
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
    plot_words(&plot, 1, told, COLOUR_X_TILDE, "at {xt}: %s",
               number_with(aim, 4).text);
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
