#include <math.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"

/* The smallest and the largest residual, extended. */
static void extend_range(const NewtonRecord *records, int count,
                         double range[2])
{
    for (int i = 0; i < count; i++)
        if (records[i].residual > 0 && isfinite(records[i].residual)) {
            range[0] = fmin(range[0], records[i].residual);
            range[1] = fmax(range[1], records[i].residual);
        }
}

/* Points, bounds hollow, joined by lines from the one before, in/out: at first
 * not finite. */
static void draw_updates(const Plot *plot, const NewtonRecord *records,
                         int count, double before[2])
{
    const double radius = 3.5;
    for (int i = 0; i < count; i++) {
        const double point[2] = {isfinite(before[0]) ? before[0] + 1
                                                     : plot->x.low + 0.5,
                                 records[i].residual};
        if (isfinite(before[0]))
            plot_line(plot, before, point, 1.3, COLOUR_P);
        bool bound = records[i].kind == RESIDUAL_BOUND;
        plot_hollow(plot, point, radius + bound, bound ? radius - 1 : 0,
                    COLOUR_P);
        memcpy(before, point, sizeof point);
    }
}

/* The update whose p is known is the last record of the trace, or it is still
 * to come there. */
void residual_draw(const Plot *card)
{
    const Trace *trace = show_pane(card->show)->update;
    if (!trace || (trace->updates == 0 && !(trace->residual > 0))) {
        cards_hint(card, "{explicit}an explicit method solves nothing\n"
                         "a point for each Newton update");
        return;
    }
    double range[2] = {0.3 * trace->tolerance, 30 * trace->tolerance};
    double from[2] = {NAN};
    int last = trace->updates - 1;
    bool pending =
        trace->residual > 0 && isfinite(trace->residual) &&
        (trace->line >= LINE_SOLVE || trace->line == LINE_NONE) &&
        !(last >= 0 && trace->record[last].residual == trace->residual);
    const NewtonRecord now = {.residual = trace->residual, .kind = trace->kind};
    extend_range(trace->record, trace->updates, range);
    extend_range(&now, pending, range);
    const LecturePage *page = card->show->lecture;
    bool star = page && page->star; /* from 0, as the slides' program prints */
    double most = fmax(trace->updates + pending, 4);
    Axis x = {0.5 - star, most + 0.5 - 0.4 * star, false, true,
              star ? "iteration" : "update"};
    Axis y = {pow(10, floor(log10(range[0]))), pow(10, ceil(log10(range[1]))),
              true, false, star ? "residual, m/s" : NULL};
    Plot plot = plot_create(card, x, y);
    const double left[2] = {x.low, trace->tolerance};
    const double right[2] = {x.high, trace->tolerance};
    draw_updates(&plot, trace->record, trace->updates, from);
    draw_updates(&plot, &now, pending, from);
    plot_dashes(&plot, left, right, 1.4, NULL, COLOUR_TEXT);
    plot_words(&plot, 1, left, COLOUR_TEXT, "\u03b5");
}
