/* scalar_picture.c - Newton's method in one unknown.  Scene `overshoot`: f with
 * quadratic models.  Scene `tangent`: g with tangents, E with parabolas. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"

enum { ROOT_MAX_UPDATES = 60, DIGITS_TEXT_SIZE = 48 };

static const double TANGENT_REACH = 3;  /* m, least half width of the view */
static const double ITERATES_WIDE = 12; /* ems */

/* An update with its model q(x) = f + f' (x - x0) + f'' (x - x0)^2 / 2, whose
 * minimum is at x1 = x0 + p. */
typedef struct ScalarUpdate {
    const Simulation *simulation;
    double x0, x1, f, slope, curvature;
    double alpha; /* step length; 0: unknown, or all lengths were refused */
    int refused_count;     /* number of refused trials alpha = 1, 1/2, ... */
    int iterate_index;     /* index of the iterate x0 */
    bool is_recorded;      /* false: the update is only predicted */
    bool shows_derivative; /* draws f' and tangent, not f and model */
} ScalarUpdate;

static TaylorModel evaluate_scalar_model(const Simulation *simulation, double x)
{
    return descent_evaluate(simulation, PROJECTION_NONE, x, 0);
}

/* Returns update i = 0, 1, ...; -1: the next one, from the present iterate. */
static ScalarUpdate find_scalar_update(const Simulation *simulation, int i)
{
    const Descent *descent = &simulation->descent;
    bool whole = simulation->options.line_search == LINE_SEARCH_NONE;
    ScalarUpdate update = {
        .simulation = simulation, .x0 = descent->iterate[0], .alpha = whole};
    if (i >= 0) {
        const NewtonRecord *record = &descent->record[i];
        update.x0 = record->x_before[0];
        update.alpha = record->alpha;
        update.refused_count = record->trials - (record->alpha > 0);
        update.iterate_index = i;
        update.is_recorded = true;
    }
    TaylorModel at = evaluate_scalar_model(simulation, update.x0);
    update.f = at.energy;
    update.slope = at.g[0];
    update.curvature = at.H[0];
    update.x1 = update.x0 - at.g[0] / at.H[0];
    return update;
}

/* Returns f at x, or f' if shows_derivative, for plot_graph. */
static double evaluate_f(const void *data, double x)
{
    const ScalarUpdate *update = data;
    TaylorModel at = evaluate_scalar_model(update->simulation, x);
    return update->shows_derivative ? at.g[0] : at.energy;
}

/* Returns the model at x, or the tangent of f' if shows_derivative. */
static double evaluate_model_at(const void *data, double x)
{
    const ScalarUpdate *update = data;
    double d = x - update->x0, bend = d * update->curvature;
    return update->shows_derivative
               ? update->slope + bend
               : update->f + d * (update->slope + 0.5 * bend);
}

/* Returns iterate i of 0 ... count; the last one is the present point. */
static double get_iterate(const Descent *descent, int i)
{
    return i == descent->record_count ? descent->iterate[0]
                                      : descent->record[i].x_before[0];
}

/* ---- function, model and iterates ---------------------------------------- */

/* Draws the model (or tangent), and a line from its minimum (or zero) to f. */
static void draw_newton_model(const Plot *plot, const ScalarUpdate *update,
                              double width, double radius, Colour colour)
{
    const double low[2] = {update->x1, evaluate_model_at(update, update->x1)};
    const double high[2] = {update->x1, evaluate_f(update, update->x1)};
    plot_graph(plot, evaluate_model_at, update, width, colour);
    plot_line(plot, low, high, 1.2, colour);
    plot_hollow_disc(plot, low, radius, 0.6 * radius, COLOUR_P);
}

/* Draws the function (or its derivative), the model, a ring for each refused
 * trial, and a numbered disc for each iterate, the last one black. */
static void draw_iteration(const Plot *plot, const ScalarUpdate *update,
                           bool model)
{
    const Descent *descent = &update->simulation->descent;
    double x1 = update->x1, used[2] = {-1e9, -1e9}, alpha = 1, p[2];
    bool right = x1 > plot->x.high, left = x1 < plot->x.low;
    plot_graph(plot, evaluate_f, update, 2.4, COLOUR_X);
    if (model)
        draw_newton_model(plot, update, 1.6, 6, COLOUR_P);
    const double edge[2] = {right ? plot->x.high : plot->x.low,
                            0.2 * plot->y.low};
    if (model && !update->shows_derivative && isfinite(x1) && (left || right))
        plot_label(plot, 1, edge, COLOUR_P, "%sto x = %s%s",
                   right ? "" : "\u2190 ", format_number(x1).text,
                   right ? " \u2192" : "");
    for (int i = 0; i < update->refused_count; i++, alpha *= 0.5) {
        double x = update->x0 + alpha * (x1 - update->x0);
        plot_hollow_disc(plot, (double[2]){x, evaluate_f(update, x)}, 5, 3.2,
                         COLOUR_WARNING);
    }
    for (int i = 0; i <= descent->record_count; i++) {
        bool last = i == descent->record_count;
        double x = get_iterate(descent, i);
        const double at[2] = {x, evaluate_f(update, x)};
        Colour colour = last ? COLOUR_TEXT : COLOUR_X;
        bool seen = plot_disc(plot, at, last ? 7 : 5.5, colour);
        plot_to_pixel(plot, at, p);
        if (!seen || !plot->has_text ||
            fabs(p[0] - used[i % 2]) < 1.5 * plot->em)
            continue;
        used[i % 2] = p[0];
        plot_label(plot, 1, at, colour, "x^{%d}", i);
    }
}

/* Draws f with the iterates.  The models of earlier full updates are pale. */
void draw_scalar_picture(Plot *stage)
{
    const Simulation *simulation = stage->simulation;
    bool whole = simulation->options.line_search == LINE_SEARCH_NONE;
    const Colour pale = (COLOUR_P & 0xffffff) | 0x70000000u;
    ScalarUpdate update =
        find_scalar_update(simulation, simulation->descent.record_count - 1);
    Plot plot = plot_create_on_stage(stage, (Axis){.label = "x"}, (Axis){0});
    for (int i = 0; whole && i + 1 < simulation->descent.record_count; i++) {
        ScalarUpdate earlier = find_scalar_update(simulation, i);
        draw_newton_model(&plot, &earlier, 1.4, 4, pale);
    }
    draw_iteration(&plot, &update, !stage->content->lecture.hides_answer);
}

/* Returns the step length that backtracking finds from the present iterate. */
static double find_accepted_alpha(const Simulation *simulation)
{
    ScalarUpdate from = find_scalar_update(simulation, -1);
    double alpha = 1, p = from.x1 - from.x0;
    while (alpha > DBL_EPSILON &&
           evaluate_scalar_model(simulation, from.x0 + alpha * p).energy >
               from.f)
        alpha /= 2;
    return alpha;
}

void list_scalar_values(const Simulation *simulation, LiveValues *values)
{
    ScalarUpdate update =
        find_scalar_update(simulation, simulation->descent.record_count - 1);
    double x = update.x0, p = update.x1 - update.x0;
    double next = x + (update.alpha > 0 ? update.alpha : 1) * p;
    bool tangent = simulation->scene->picture == PICTURE_TANGENT;
    values_add_flag(values, "tangent", tangent);
    values_add(values, "number", update.iterate_index);
    values_add(values, "next number", update.iterate_index + 1);
    values_add_flag(values, "refused lengths", update.refused_count > 0);
    values_add(values, "iterate", x);
    values_add(values, "next", next);
    values_add_flag(values, "no length", !(update.alpha > 0));
    values_add_flag(values, "full length", update.alpha >= 1);
    if (update.alpha > 0 && update.alpha < 1)
        values_add(values, "shorter", update.alpha);
    values_add(values, "first length", find_accepted_alpha(simulation));
    values_add(values, "slope", update.slope);
    values_add(values, "curvature", update.curvature);
    values_add(values, "direction", p);
    values_add(values, "E", update.f);
    values_add_flag(values, update.curvature > 0 ? "lowest" : "highest", true);
}

/* ---- g with tangents, E with parabolas ----------------------------------- */

void find_tangent_bounds(const Plot *stage, double bounds[4])
{
    double x = stage->simulation->descent.iterate[0];
    find_centred_view(TANGENT_REACH, 1.05 * fabs(x), 2, bounds);
}

/* Makes the plot of g in the upper half (0) or of E in the lower half (1), with
 * a line at 0. All iterates are inside the plot. */
static Plot create_tangent_plot(const Plot *stage, int half)
{
    const Descent *descent = &stage->simulation->descent;
    double high = half ? 2 : 4;
    for (int i = 0; i <= descent->record_count; i++) {
        TaylorModel at =
            evaluate_scalar_model(stage->simulation, get_iterate(descent, i));
        high = fmax(high, half ? at.energy : fabs(at.g[0]));
    }
    high = plot_round_axis_end(fmin(high, 1e12));
    Plot part = *stage;
    part.box.height /= 2;
    part.box.y += half * part.box.height;
    Plot plot =
        plot_create_on_stage(&part, (Axis){.label = half ? "x in m" : NULL},
                             (Axis){.low = half ? -0.25 * high : -high,
                                    .high = high,
                                    .label = half ? "J s\u00b2" : "kg m"});
    plot_line(&plot, (double[2]){plot.x.low, 0}, (double[2]){plot.x.high, 0}, 1,
              COLOUR_GREY);
    return plot;
}

void draw_tangent_picture(Plot *stage)
{
    const Simulation *simulation = stage->simulation;
    const double target[2] = {simulation->exhibit.x_tilde[0], 0};
    ScalarUpdate update =
        find_scalar_update(simulation, simulation->descent.record_count - 1);
    const Plot plot[2] = {create_tangent_plot(stage, 0),
                          create_tangent_plot(stage, 1)};
    bool asked = stage->content->lecture.hides_answer;
    for (int half = 0; half < 2; half++) {
        update.shows_derivative = half == 0;
        draw_iteration(&plot[half], &update, update.is_recorded || !asked);
    }
    if (!stage->has_text)
        return;
    stage_draw_handles(&plot[1]);
    if (plot_disc(&plot[1], target, 5, COLOUR_X_TILDE))
        plot_label(&plot[1], 1, target, COLOUR_X_TILDE, "{xt}");
    Paper *paper = stage->paper;
    paper_write(paper, FACE_BOLD, 1.05, COLOUR_X, plot[0].box.x + paper->em,
                stage->box.y + 0.5 * paper->em, ALIGN_LEFT,
                "g(x) = m (x \u2212 {xt}^{n}) \u2212 h\u00b2 f(x)");
    paper_write(paper, FACE_BOLD, 1.05, COLOUR_X, plot[1].box.x + paper->em,
                plot[1].box.y - 1.7 * paper->em, ALIGN_LEFT,
                "E(x) = m/2 (x \u2212 {xt}^{n})\u00b2 + h\u00b2 P(x)");
}

/* Returns the zero of g that full updates find; NaN: no convergence. */
static double find_scalar_root(const Simulation *simulation)
{
    double x = simulation->descent.iterate[0], p = INFINITY;
    for (int i = 0; i < ROOT_MAX_UPDATES && fabs(p) > 1e-14 * fmax(1, fabs(x));
         i++) {
        TaylorModel at = evaluate_scalar_model(simulation, x);
        p = -at.g[0] / at.H[0];
        x += p;
    }
    return fabs(p) <= 1e-14 * fmax(1, fabs(x)) ? x : NAN;
}

/* Writes a double with 12 decimals, or 10 digits if large. */
static void format_decimals(double x, char text[DIGITS_TEXT_SIZE])
{
    bool plain = fabs(x) < 1e4;
    snprintf(text, DIGITS_TEXT_SIZE, plain ? "%s%.12f" : "%s%.9e",
             x < 0 ? "\u2212" : "", fabs(x));
}

/* Fills a row with iterate row - 1; digits from the first wrong on are grey. */
bool iterates_make_row(const FrameContent *content, int row,
                       CardTableRow *cells)
{
    const Simulation *simulation = active_pane(content)->simulation;
    char root[DIGITS_TEXT_SIZE], x[DIGITS_TEXT_SIZE];
    int right = 0;
    if (row == 0 || row > simulation->descent.record_count + 1)
        return row == 0;
    format_decimals(find_scalar_root(simulation), root);
    format_decimals(get_iterate(&simulation->descent, row - 1), x);
    while (x[right] && x[right] == root[right])
        right++;
    snprintf(cells->cell[0], CARD_CELL, "#x{x^{%d}}", row - 1);
    snprintf(cells->cell[1], CARD_CELL, "%.*s#grey{%s}", right, x, x + right);
    return true;
}

/* Writes the newest iterates that fit.  Correct digits have a light ground. */
static void draw_iterates(const Plot *card)
{
    const double size = 1.1, pitch = 1.6; /* ems */
    int count = card->simulation->descent.record_count + 1;
    Paper *paper = card->paper;
    int rows = (int)(card->box.height / (pitch * paper->em));
    int first = count > rows ? count - rows : 0;
    CardTableRow cells;
    for (int i = first;
         card_make_row(card->content, &card_tangent_numbers, i + 1, &cells);
         i++) {
        int y = card->box.y + paper_to_pixels(paper, pitch * (i - first));
        int right = (int)strcspn(cells.cell[1], "#");
        char words[2 * CARD_CELL];
        snprintf(words, sizeof words, "%s  ", cells.cell[0]);
        int left = paper_measure(paper, FACE_REGULAR, size, words);
        snprintf(words, sizeof words, "%s  %.*s", cells.cell[0], right,
                 cells.cell[1]);
        int end = paper_measure(paper, FACE_REGULAR, size, words);
        canvas_fill(&paper->canvas,
                    (Box){card->box.x + left, y + paper_to_pixels(paper, 0.28),
                          end - left, paper_to_pixels(paper, 1.2)},
                    right > 0 ? COLOUR_LIT : COLOUR_WHITE);
        paper_write(paper, FACE_REGULAR, size, COLOUR_TEXT, card->box.x, y,
                    ALIGN_LEFT, "%s  %s", cells.cell[0], cells.cell[1]);
    }
}

/* Writes the numbers of the shown update, and all iterates at the right. */
void draw_tangent_numbers_card(const Plot *card)
{
    Plot left = *card, right = *card;
    right.box = box_cut_off(&left.box, EDGE_RIGHT,
                            paper_to_pixels(card->paper, ITERATES_WIDE));
    card_write_text(&left, &card->pane->values, card_tangent_numbers.words);
    draw_iterates(&right);
}

/* Picks the handle that is nearest in x. */
void tangent_pick(const Plot *stage, double x, double y, Pick *pick)
{
    double at[SCENE_MAX_HANDLES][2];
    int handles = exhibit_list_handles(stage->simulation, at);
    for (int i = 0; i < handles; i++)
        at[i][1] = pick->point[1];
    plot_pick_point(stage, handles, *at, 14, x, y, PICK_HANDLE, pick);
}
