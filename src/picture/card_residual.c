#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "scenes/scene.h"

/* Smallest and largest power of ten around the residuals, extended. */
static void extend_range(const NewtonRecord *records, int count, double *low,
                         double *high)
{
    for (int i = 0; i < count; i++) {
        double residual = records[i].residual;
        if (!(residual > 0) || !isfinite(residual))
            continue;
        *low = fmin(*low, residual);
        *high = fmax(*high, residual);
    }
}

/* A disc is a value, a square an estimate, a ring a bound. */
static void draw_point(const Plot *plot, const double *at, double radius,
                       ResidualKind kind, Colour colour)
{
    Paper *paper = plot->paper;
    double p[2], unit = paper->unit;
    plot_place(plot, at, p);
    int half = (int)fmax(2, round(0.85 * radius * unit));
    if (kind == RESIDUAL_VALUE)
        plot_disc(plot, at, radius, colour);
    else if (kind == RESIDUAL_ESTIMATE)
        canvas_fill(&paper->canvas,
                    (Box){(int)round(p[0]) - half, (int)round(p[1]) - half,
                          2 * half, 2 * half},
                    colour);
    else
        plot_ring(plot, at, radius + 1, 1.6, colour);
}

/* Says so, where there are others than values. */
static void draw_kinds(const Plot *plot, const Trace *trace)
{
    Paper *paper = plot->paper;
    bool estimate = trace->kind == RESIDUAL_ESTIMATE;
    bool bound = trace->kind == RESIDUAL_BOUND;
    double p[2];
    for (int i = 0; i < trace->updates; i++) {
        estimate = estimate || trace->record[i].kind == RESIDUAL_ESTIMATE;
        bound = bound || trace->record[i].kind == RESIDUAL_BOUND;
    }
    plot_place(plot, (double[2]){plot->x.high, plot->y.high}, p);
    if (estimate || bound)
        paper_write(
            paper, FACE_REGULAR, 0.85, COLOUR_P, p[0], p[1] + 0.1 * paper->em,
            ALIGN_RIGHT, "%s%s%s", estimate ? "\u25a0 estimate" : "",
            estimate && bound ? "  " : "", bound ? "\u25cb upper bound" : "");
}

/* The residuals joined by lines, a point each, the last one this large; behind
 * the records one more, if not NULL. */
static void draw_updates(const Plot *plot, const NewtonRecord *records,
                         int count, const NewtonRecord *more, double radius,
                         double last, Colour colour)
{
    double before[2] = {NAN, NAN};
    int all = count + (more != NULL);
    for (int i = 0; i < all; i++) {
        const NewtonRecord *one = i < count ? &records[i] : more;
        const double point[2] = {1 + i, one->residual};
        if (!(point[1] > 0))
            continue;
        if (isfinite(before[1]))
            plot_line(plot, before, point, 1.3, colour);
        draw_point(plot, point, i + 1 < all ? radius : last, one->kind, colour);
        memcpy(before, point, sizeof before);
    }
}

/* Its line; and below, where the curve does not come from, what that means in
 * metres; h 0: nothing. */
static void draw_tolerance(const Plot *plot, double tolerance, double h)
{
    Paper *paper = plot->paper;
    const double left[2] = {plot->x.low, tolerance};
    const double right[2] = {plot->x.high, tolerance};
    char words[80] = "\u03b5";
    double p[2], em = paper->em;
    plot_place(plot, left, p);
    plot_dashes(plot, left, right, 1.4, NULL, COLOUR_TEXT);
    bool below = p[1] + 1.05 * em <= plot->box.y + plot->box.height;
    if (below && h > 0)
        snprintf(words, sizeof words, "\u03b5: h \u03b5 = %s m",
                 number_of(h * tolerance).text);
    if (paper_width(paper, FACE_BOLD, 0.85, words) > plot->box.width)
        snprintf(words, sizeof words, "\u03b5");
    paper_write(paper, FACE_BOLD, 0.85, COLOUR_TEXT, p[0] + 0.3 * em,
                p[1] + (below ? 0 : -1.25) * em, ALIGN_LEFT, "%s", words);
}

/* The update whose p is known is the last record of the trace, or it is still
 * to come there; its point is larger. */
static void draw_residual(const Plot *card)
{
    const Trace *trace = show_pane(card->show)->update;
    if (!trace || (trace->updates == 0 && trace->updates_before == 0 &&
                   !(trace->residual > 0))) {
        cards_hint(card, "{explicit}an explicit method solves nothing\n"
                         "a point for each Newton update");
        return;
    }
    double low = 0.3 * trace->tolerance, high = 30 * trace->tolerance;
    int last = trace->updates - 1, before = trace->updates_before;
    bool counted = last >= 0 && trace->record[last].residual == trace->residual;
    bool pending = trace->residual > 0 && isfinite(trace->residual) &&
                   (trace->line >= LINE_SOLVE || trace->line == LINE_NONE) &&
                   !counted;
    bool known = trace->line && (counted || (pending && !trace->passed));
    const NewtonRecord now = {.residual = trace->residual, .kind = trace->kind};
    extend_range(trace->record, trace->updates, &low, &high);
    extend_range(trace->record_before, before, &low, &high);
    extend_range(&now, pending, &low, &high);
    int count = trace->updates + pending,
        most = count > before ? count : before;
    Axis x = {0.5, fmax(most, 4) + 0.5, false, true, "update"};
    Axis y = {pow(10, floor(log10(low))), pow(10, ceil(log10(high))), true,
              false, NULL};
    Plot plot = plot_create(card, x, y);
    bool time = card->simulation->scene->needs & NEEDS_TIME;
    draw_updates(&plot, trace->record_before, before, NULL, 2.5, 2.5,
                 COLOUR_BORDER);
    draw_tolerance(&plot, trace->tolerance, time ? trace->h : 0);
    draw_updates(&plot, trace->record, trace->updates, pending ? &now : NULL,
                 3.5, known ? 5.5 : 3.5, COLOUR_P);
    draw_kinds(&plot, trace);
}

const Card card_residual = {
    .name = "residual",
    .title = "{tangent}Residual |g|\n"
             "{one unknown}Residual |f \u2032|\n"
             "{by gradient}Residual \u2016\u2207E\u2016\n"
             "Residual \u2016{p}\u2016_{\u221e}/h, m/s",
    .least = 8,
    .weight = 1,
    .half = true,
    .draw = draw_residual,
};
