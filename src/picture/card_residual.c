/* card_residual.c - the card that plots the residual of each update. */
#include <math.h>

#include "picture/cards.h"

/* Draws the residuals of the updates, and of the next update if p is known. */
void residual_draw(const Plot *card)
{
    const Trace *trace = card->pane->shown_trace;
    if (!trace || (trace->updates == 0 && !(trace->residual > 0))) {
        card_write_hint(card, text_undrawn);
        return;
    }
    const double now = trace->residual;
    int updates = trace->updates;
    bool known = trace->line >= LINE_SOLVE || trace->line == LINE_NONE;
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
    /* A page's main card counts iterations from 0, others updates from 1. */
    bool is_main = card->simulation->options.main_card;
    double most = fmax(updates + pending, 4);
    Axis x = {0.5 - is_main, most + 0.5 - 0.4 * is_main, false, true,
              is_main ? "iteration" : "update"};
    Axis y = {pow(10, floor(log10(low))), pow(10, ceil(log10(high))), true,
              false, is_main ? "residual, m/s" : NULL};
    Plot plot = plot_create(card, x, y);
    const double left[2] = {x.low, trace->tolerance};
    const double right[2] = {x.high, trace->tolerance};
    double at[2] = {0, 0}, before[2];
    for (int i = 0; i < updates + pending; i++) {
        before[0] = at[0], before[1] = at[1];
        at[0] = i + x.low + 0.5;
        at[1] = i < updates ? trace->record[i].residual : now;
        if (i > 0)
            plot_line(&plot, before, at, 1.3, COLOUR_P);
        plot_disc(&plot, at, 3.5, COLOUR_P);
    }
    plot_dashes(&plot, left, right, 1.4, NULL, COLOUR_TEXT);
    plot_label(&plot, 1, left, COLOUR_TEXT, "\u03b5");
}
