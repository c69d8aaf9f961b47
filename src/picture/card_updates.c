/* card_updates.c - cards of a step: E and its parts, residuals, updates. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "model/inertia_energy.h"
#include "picture/cards.h"

/* Draws E and its parts along the line from x^n (t = 0) to x_tilde (t = 1), and
 * E at x as a dot at the t of the line's nearest point. */
void draw_energy_parts_card(const Plot *card)
{
    enum {
        POINT_COUNT = 31,
        INDEX_X_N = 5,
        INDEX_X_TILDE = 25
    }; /* indices of x^n and x_tilde */
    static const struct {
        const char *name; /* name of the curve */
        Colour colour;
        int label_index;     /* index of the point with the label */
        double height_ratio; /* height of label / height of curve */
    } parts[] = {{"inertia", COLOUR_X_TILDE, 10, 1},
                 {"h\u00b2 P", COLOUR_SHADED, 20, 0.72},
                 {"E", COLOUR_X, 3, 1}};
    double t[POINT_COUNT + 1], part[3][POINT_COUNT + 1], along = 0, square = 0;
    const NewtonTrace *trace = card->pane->trace;
    if (!trace || !trace->x_tilde || !trace->x_n) {
        card_write_hint(card, text_undrawn);
        return;
    }
    const System *system = &card->simulation->system;
    const double *aim = trace->x_tilde, *from = trace->x_n;
    const double *x = pane_get_positions(card->pane);
    size_t count = 2 * (size_t)system->nodes;
    double *at = malloc(count * sizeof *at);
    if (!at)
        return;
    for (size_t c = 0; c < count; c++) {
        along += (x[c] - from[c]) * (aim[c] - from[c]);
        square += (aim[c] - from[c]) * (aim[c] - from[c]);
    }
    for (int i = 0; i <= POINT_COUNT; i++) { /* i = POINTS: x */
        t[i] = i < POINT_COUNT ? 0.05 * (i - INDEX_X_N)
                               : along / fmax(square, 1e-300);
        for (size_t c = 0; c < count; c++)
            at[c] =
                i < POINT_COUNT ? from[c] + t[i] * (aim[c] - from[c]) : x[c];
        part[0][i] = inertia_energy_value(system->nodes, at, aim, system->m);
        part[1][i] = trace->h * trace->h * system_potential(system, at);
        part[2][i] = part[0][i] + part[1][i];
    }
    free(at);
    const double *E = part[2];
    Plot plot =
        plot_create(card, (Axis){t[0], t[POINT_COUNT - 1]},
                    (Axis){0, 1.4 * fmax(E[INDEX_X_N], E[INDEX_X_TILDE]),
                           .label = "J s\u00b2"});
    for (int k = 0; k < 3; k++)
        plot_curve(&plot, POINT_COUNT, t, part[k], k < 2 ? 1.6 : 2.4,
                   parts[k].colour);
    for (int k = 0; k < 3; k++) {
        static const char *const names[] = {"{x}^{n}", "{xt}^{n}", "{x}"};
        static const int index[] = {INDEX_X_N, INDEX_X_TILDE, POINT_COUNT};
        const double mark[2] = {t[index[k]], E[index[k]]};
        Colour colour = k == 1 ? COLOUR_X_TILDE : COLOUR_X;
        plot_disc(&plot, mark, 5, colour);
        plot_label(&plot, 1, mark, colour, "%s: %s", names[k],
                   format_digits(mark[1], 4).text);
    }
    for (int k = 0; k < 3; k++) {
        int i = parts[k].label_index;
        plot_label(&plot, 1,
                   (double[2]){t[i], parts[k].height_ratio * part[k][i]},
                   parts[k].colour, "%s", parts[k].name);
    }
}

/* Draws the residual of each update, and of the next update if p is known. */
void draw_residual_card(const Plot *card)
{
    const NewtonTrace *trace = card->pane->shown_trace;
    if (!trace || (trace->record_count == 0 && !(trace->residual > 0))) {
        card_write_hint(card, text_undrawn);
        return;
    }
    const double now = trace->residual;
    int updates = trace->record_count;
    bool known = trace->at_line >= LINE_SOLVE || trace->at_line == LINE_NONE;
    bool pending = known && now > 0 && isfinite(now) &&
                   (updates == 0 || trace->record[updates - 1].residual != now);
    double low = 0.3 * trace->tolerance, high = 30 * trace->tolerance;
    for (int i = 0; i < updates + pending; i++) {
        double residual = i < updates ? trace->record[i].residual : now;
        if (residual > 0 && isfinite(residual)) {
            low = fmin(low, residual);
            high = fmax(high, residual);
        }
    }
    bool is_main = card->simulation->options.main_card;
    Axis x = {0.5, fmax(updates + pending, 4) + (is_main ? 0.9 : 0.5),
              .scale = SCALE_INTEGER, .label = "update"};
    Axis y = {pow(10, floor(log10(low))), pow(10, ceil(log10(high))),
              .scale = SCALE_LOG, .label = is_main ? "residual, m/s" : NULL};
    Plot plot = plot_create(card, x, y);
    const double left[2] = {x.low, trace->tolerance};
    const double right[2] = {x.high, trace->tolerance};
    double at[2] = {0, 0}, before[2];
    for (int i = 0; i < updates + pending; i++) {
        before[0] = at[0], before[1] = at[1];
        at[0] = i + 1;
        at[1] = i < updates ? trace->record[i].residual : now;
        if (i > 0)
            plot_line(&plot, before, at, 1.3, COLOUR_P);
        plot_disc(&plot, at, 3.5, COLOUR_P);
    }
    plot_dashes(&plot, left, right, 1.4, NULL, COLOUR_TEXT);
    plot_label(&plot, 1, left, COLOUR_TEXT, "\u03b5");
}

/* Fills the row of an update.  The row of the current update has the cells that
 * are known at the algorithm's present line.  Without projection the cells have
 * the number of negative eigenvalues of the Hessian and the slope along p. */
bool updates_make_row(const FrameContent *content, int row, CardTableRow *cells)
{
    const Pane *pane = active_pane(content);
    const NewtonTrace *trace = pane->trace;
    bool raw = pane->simulation->options.projection == PROJECTION_NONE;
    if (!trace || row == 0)
        return trace;
    bool before = trace->at_line != LINE_NONE && trace->at_line < LINE_UPDATE;
    /* Number of updates that are already added to the shown positions. */
    int made = before ? trace->iteration : trace->record_count;
    bool now = before && trace->at_line >= LINE_PROJECT &&
               trace->projected_blocks >= 0;
    const NewtonRecord *update = &trace->record[row - 1];
    AlgoLine line = row <= made ? LINE_END_STEP : trace->at_line;
    if (row > made + now)
        return false;
    snprintf(cells->cell[0], CARD_CELL, "%d", row);
    snprintf(cells->cell[1], CARD_CELL, "%d",
             raw ? update->negative_pivots : update->projected_blocks);
    if (line >= LINE_SOLVE) {
        snprintf(cells->cell[2], CARD_CELL, "%s %s \u03b5",
                 format_number(update->residual).text,
                 update->residual > trace->tolerance ? ">" : "\u2264");
        snprintf(cells->cell[5], CARD_CELL, "%s",
                 format_number(update->slope).text);
    }
    if (line > LINE_SEARCH || (line == LINE_SEARCH && trace->is_accepted))
        snprintf(cells->cell[3], CARD_CELL, "%s",
                 format_number(update->alpha).text);
    if (line >= LINE_UPDATE)
        snprintf(cells->cell[4], CARD_CELL, "%s",
                 format_number(update->energy_change).text);
    return true;
}

/* Returns the height of the card in ems; the table has at least six rows. */
double updates_find_height(const FrameContent *content, double wide, double em)
{
    const NewtonTrace *trace = active_pane(content)->trace;
    return CARD_ROW * (1 + fmax(6, trace ? trace->record_count : 0)) + 2.8;
}

void draw_updates_card(const Plot *card)
{
    static const int order[2][CARD_COLUMNS] = {{0, 1, 2, 4, 3},
                                               {0, 1, 4, 5, 2, 3}};
    const Options *options = &card->simulation->options;
    bool raw = options->projection == PROJECTION_NONE;
    if (card->pane->trace)
        card_draw_table(card, &card_updates, order[raw]);
    else
        card_write_hint(card, text_undrawn);
}
