/* Newton in one unknown: f with its quadratic models (overshoot), and g with
 * its tangents above E with its parabolas (tangent). */
#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/handles.h"
#include "scenes/small_scenes.h"

enum { CURVE_POINTS = 400, TANGENT_POINTS = 300 };

static const double TANGENT_REACH = 3; /* m, x from -3 to 3 at least */
static const double LABEL_ROOM = 1.5;  /* ems */

/* The last update, or the first one that is to come, and the model that it
 * comes from: q(x) = f + f' (x - x0) + f'' (x - x0)^2 / 2 at x0, least at
 * x0 + p. */
typedef struct Update {
    double x0, p, f, first, second;
    double alpha; /* 0: not known yet, or refused */
    int refused;  /* lengths 1, 1/2, ... that the line search did not take */
    int number;   /* of the iterate x0 */
    bool made;
} Update;

static Local scalar_at(const Simulation *simulation, double x)
{
    return descent_at(simulation, FILTER_NONE, x, 0);
}

static Update last_update(const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    bool whole = simulation->options.line_search == LINE_SEARCH_NONE;
    Update update = {.x0 = descent->point[0], .alpha = whole};
    if (descent->count > 0) {
        const NewtonRecord *record = &descent->record[descent->count - 1];
        update.x0 = record->from[0];
        update.alpha = record->alpha;
        update.refused = record->trials - (record->alpha > 0);
        update.number = descent->count - 1;
        update.made = true;
    }
    Local at = scalar_at(simulation, update.x0);
    update.f = at.value;
    update.first = at.g[0];
    update.second = at.H[0];
    update.p = -at.g[0] / at.H[0];
    return update;
}

/* Iterate i, the present one after all others. */
static double iterate(const Descent *descent, int i)
{
    return i == descent->count ? descent->point[0] : descent->record[i].from[0];
}

/* The function, its derivative or the model over the whole axis. */
typedef enum Which { DERIVATIVE, FUNCTION, MODEL } Which;

static double height(const Simulation *simulation, Which which,
                     const Update *update, double x)
{
    double d = x - update->x0;
    if (which == MODEL)
        return update->f + d * (update->first + 0.5 * d * update->second);
    Local at = scalar_at(simulation, x);
    return which == FUNCTION ? at.value : at.g[0];
}

static void draw_function(Paper *paper, const Plot *plot,
                          const Simulation *simulation, Which which,
                          const Update *update, int points, double width,
                          Colour colour)
{
    double x[CURVE_POINTS + 1], y[CURVE_POINTS + 1], low = plot->x.low;
    for (int i = 0; i <= points; i++) {
        x[i] = low + (plot->x.high - low) * i / points;
        y[i] = height(simulation, which, update, x[i]);
    }
    if (points == CURVE_POINTS)
        plot_curve(paper, plot, points + 1, x, y, width, colour);
    else
        plot_lines(paper, plot, points + 1, x, y, width, colour);
}

/* ---- f and its models ---------------------------------------------------- */

/* From the minimum of the model up to f there, where the full step leads. */
static void draw_model_minimum(Paper *paper, const Plot *plot,
                               const Simulation *simulation,
                               const Update *model, bool text)
{
    double x1 = model->x0 + model->p, at[2];
    const double low[2] = {x1, height(simulation, MODEL, model, x1)};
    const double high[2] = {x1, height(simulation, FUNCTION, model, x1)};
    bool right = x1 > plot->x.high;
    char number[48];
    plot_hollow(paper, plot, low, 6, 3.6, COLOUR_P);
    plot_line(paper, plot, low, high, 1.2, COLOUR_P);
    if (!text || !isfinite(x1) || (x1 >= plot->x.low && !right))
        return;
    plot_number(number, sizeof number, x1);
    plot_place(plot, right ? plot->x.high : plot->x.low,
               0.5 * (plot->y.low + 0), at);
    paper_write(paper, FACE_BOLD, 1, COLOUR_P, at[0], at[1],
                right ? ALIGN_RIGHT : ALIGN_LEFT, "%sto x = %s%s",
                right ? "" : "\u2190 ", number, right ? " \u2192" : "");
}

/* x with its number, below the disc or above it in turn, unless there is one
 * already.
 *   used  [2] pixels, in/out: where the last one below and above is */
static void label_iterate(Paper *paper, const double at[2], int number,
                          double used[2], Colour colour)
{
    int above = number % 2;
    double gap = LABEL_ROOM * paper->em;
    if (fabs(at[0] - used[above]) < gap)
        return;
    used[above] = at[0];
    paper_write(paper, FACE_BOLD, 1, colour, at[0],
                above ? at[1] - 1.25 * gap : at[1] + 0.6 * gap, ALIGN_CENTRE,
                "x^{%d}", number);
}

/* Rings where the line search looked and went on; discs on the curve, the last
 * one is black. */
static void draw_iterates(Paper *paper, const Plot *plot,
                          const Simulation *simulation, const Update *update,
                          bool text)
{
    const Descent *descent = &simulation->descent;
    double used[2] = {-1e9, -1e9}, alpha = 1;
    for (int i = 0; i < update->refused; i++, alpha *= 0.5) {
        double x = update->x0 + alpha * update->p;
        const double at[2] = {x, height(simulation, FUNCTION, update, x)};
        plot_hollow(paper, plot, at, 5, 3.2, COLOUR_WARNING);
    }
    for (int i = 0; i <= descent->count; i++) {
        bool last = i == descent->count;
        double x = iterate(descent, i), at[2];
        const double point[2] = {x, height(simulation, FUNCTION, update, x)};
        Colour colour = last ? COLOUR_TEXT : COLOUR_X;
        plot_place(plot, point[0], point[1], at);
        if (plot_disc(paper, plot, point, last ? 7 : 5.5, colour) && text)
            label_iterate(paper, at, i, used, colour);
    }
}

static void curve_draw(Paper *paper, const Stage *stage, const Show *show)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    Update update = last_update(simulation);
    Legend legend = {0, 0};
    Plot plot =
        stage_plot(paper, stage, &stage_room, (Axis){.label = "x"}, (Axis){0});
    draw_function(paper, &plot, simulation, FUNCTION, &update, CURVE_POINTS,
                  2.4, COLOUR_X);
    draw_function(paper, &plot, simulation, MODEL, &update, CURVE_POINTS, 1.6,
                  COLOUR_P);
    draw_model_minimum(paper, &plot, simulation, &update, stage->text);
    draw_iterates(paper, &plot, simulation, &update, stage->text);
    if (show->bare || !stage->text)
        return;
    stage_legend(paper, stage, &legend, COLOUR_X,
                 "f(x) = ln(e^{x} + e^{\u2212x})");
    stage_legend(paper, stage, &legend, COLOUR_P, "quadratic model at x^{%d}",
                 update.number);
    if (update.refused > 0)
        stage_legend(paper, stage, &legend, COLOUR_WARNING, "refused lengths");
}

static const Card *const curve_cards[] = {&card_page, &card_listing, &card_line,
                                          &card_residual, NULL};

const Picture curve_picture = {
    .name = "curve",
    .cards = curve_cards,
    .stretched = true,
    .places = true,
    .around = {-1.08 * 14, 1.25 * -6, 1.05 * 14, 1.1 * 14},
    .draw = curve_draw,
};

/* ---- g and its tangents above E and its parabolas ------------------------ */

/* Only x counts: both plots share it. */
static void tangent_bounds(const Show *show, int pane, double bounds[4])
{
    const Simulation *simulation = show->pane[pane].simulation;
    bounds_around(TANGENT_REACH, 1.05 * fabs(simulation->descent.point[0]), 2,
                  bounds);
}

/* Upper half (0): g.  Lower half (1): E.  Both fit |g| and E of all iterates.
 */
static Plot tangent_plot(Paper *paper, const Stage *stage,
                         const Simulation *simulation, int half)
{
    static const StageRoom room[2] = {{3.2, 4, 2.2, 3.6}, {3.2, 4, 2, 3.8}};
    const Descent *descent = &simulation->descent;
    double g = 4, E = 2;
    for (int i = 0; i <= descent->count; i++) {
        Local at = scalar_at(simulation, iterate(descent, i));
        g = fmax(g, fabs(at.g[0]));
        E = fmax(E, at.value);
    }
    g = plot_round_axis(fmin(g, 1e12));
    E = plot_round_axis(fmin(E, 1e12));
    Stage part = *stage;
    part.box.height /= 2;
    part.box.y += half * part.box.height;
    return stage_plot(paper, &part, &room[half],
                      (Axis){.label = half ? "x in m" : NULL},
                      half ? (Axis){.low = -0.25 * E, .high = E}
                           : (Axis){.low = -g, .high = g});
}

/* A dashed upright through both plots. */
static void tangent_upright(Paper *paper, const Plot plot[2], double x,
                            Colour colour)
{
    double top[2], low[2];
    if (!(x >= plot[0].x.low && x <= plot[0].x.high))
        return;
    plot_place(&plot[0], x, plot[0].y.high, top);
    plot_place(&plot[1], x, plot[1].y.low, low);
    canvas_dashes(&paper->canvas, top[0], top[1], low[0], low[1],
                  fmax(1, paper->unit), 4 * paper->unit, 4 * paper->unit, NULL,
                  colour);
}

/* Discs on g and on E, with numbers; the present one is black. */
static void tangent_iterates(Paper *paper, const Plot plot[2],
                             const Simulation *simulation, bool text)
{
    const Descent *descent = &simulation->descent;
    double used = -1e9;
    for (int i = 0; i <= descent->count; i++) {
        bool last = i == descent->count;
        double x = iterate(descent, i), at[2];
        Local now = scalar_at(simulation, x);
        const double g[2] = {x, now.g[0]}, E[2] = {x, now.value};
        Colour colour = last ? COLOUR_TEXT : COLOUR_X;
        bool inside = plot_disc(paper, &plot[0], g, last ? 7 : 5, colour);
        plot_disc(paper, &plot[1], E, last ? 7 : 5, colour);
        plot_place(&plot[0], x, 0, at);
        if (!text || !inside || fabs(at[0] - used) < 1.8 * paper->em)
            continue;
        used = at[0];
        paper_write(paper, FACE_BOLD, 1, colour, at[0], at[1] + 0.4 * paper->em,
                    ALIGN_CENTRE, "x^{%d}", i);
    }
}

/* The tangent of g from x0 to its zero, and beside it the parabola's lowest
 * point. */
static void tangent_model(Paper *paper, const Plot plot[2],
                          const Simulation *simulation, const Update *update)
{
    double x1 = update->x0 + update->p, p = x1 - update->x0, d = 0.15 * p;
    const double a[2] = {update->x0 - d, update->first - d * update->second};
    const double b[2] = {x1 + d, d * update->second}, zero[2] = {x1, 0};
    const double lowest[2] = {x1, update->f + 0.5 * update->first * p};
    plot_line(paper, &plot[0], a, b, 2.4, COLOUR_P);
    draw_function(paper, &plot[1], simulation, MODEL, update, TANGENT_POINTS,
                  1.8, COLOUR_P);
    tangent_upright(paper, plot, x1, COLOUR_P);
    plot_hollow(paper, &plot[0], zero, 6, 3.6, COLOUR_P);
    plot_hollow(paper, &plot[1], lowest, 6, 3.6, COLOUR_P);
}

/* Rings round the iterate on E and round x_tilde on the axis. */
static void tangent_handle_rings(Paper *paper, const Plot *plot,
                                 const Show *show, const Simulation *simulation)
{
    double at[SCENE_MAX_HANDLES][2], pixel[2];
    exhibit_handles(simulation, at);
    for (int i = 0; i < 2; i++) {
        bool over = show->hover.kind == PICK_HANDLE && show->hover.index == i;
        plot_place(plot, at[i][0], at[i][1], pixel);
        if (at[i][0] < plot->x.low || at[i][0] > plot->x.high)
            continue;
        canvas_ring(&paper->canvas, pixel[0], pixel[1],
                    (over ? 13 : 10) * paper->unit,
                    (over ? 3 : 1.8) * paper->unit, COLOUR_HAND);
        if (i == 0)
            continue;
        canvas_disc(&paper->canvas, pixel[0], pixel[1], 5 * paper->unit,
                    COLOUR_X_TILDE);
        paper_write(paper, FACE_BOLD, 1, COLOUR_X_TILDE, pixel[0],
                    pixel[1] + 0.7 * paper->em, ALIGN_CENTRE, "{xt}");
    }
}

static void tangent_draw(Paper *paper, const Stage *stage, const Show *show)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    const Prediction *guess = &simulation->prediction;
    Update update = last_update(simulation);
    Plot plot[2];
    for (int half = 0; half < 2; half++) {
        plot[half] = tangent_plot(paper, stage, simulation, half);
        const double a[2] = {plot[half].x.low, 0},
                     b[2] = {plot[half].x.high, 0};
        plot_line(paper, &plot[half], a, b, 1, COLOUR_GREY);
        draw_function(paper, &plot[half], simulation,
                      half ? FUNCTION : DERIVATIVE, &update, TANGENT_POINTS,
                      2.6, COLOUR_X);
    }
    if (update.made || !(guess->made && !guess->shown))
        tangent_model(paper, plot, simulation, &update);
    tangent_iterates(paper, plot, simulation, stage->text);
    if (!show->bare)
        tangent_handle_rings(paper, &plot[1], show, simulation);
    if (show->bare || !stage->text)
        return;
    paper_write(paper, FACE_BOLD, 1.05, COLOUR_X, plot[0].box.x + paper->em,
                stage->box.y + 0.5 * paper->em, ALIGN_LEFT,
                "g(x) = m (x \u2212 {xt}) + h\u00b2 P\u2032(x)");
    paper_write(paper, FACE_BOLD, 1.05, COLOUR_X, plot[1].box.x + paper->em,
                plot[1].box.y - 1.7 * paper->em, ALIGN_LEFT,
                "E(x) = m/2 (x \u2212 {xt})\u00b2 + h\u00b2 P(x)");
}

/* By x alone: whichever is nearer. */
static Pick tangent_pick(const Show *show, const Stage *stage, double x,
                         double y)
{
    Pick pick = {PICK_PLACE, stage->pane, 0, {0, 0}};
    double at[SCENE_MAX_HANDLES][2], best = 14;
    camera_world(&stage->camera, x, y, pick.point);
    exhibit_handles(show->pane[stage->pane].simulation, at);
    for (int i = 0; i < 2; i++) {
        double pixel[2];
        stage_pixel(stage, at[i], pixel);
        if (fabs(pixel[0] - x) < best) {
            best = fabs(pixel[0] - x);
            pick.kind = PICK_HANDLE;
            pick.index = i;
        }
    }
    return pick;
}

static void tangent_draw_numbers(Paper *paper, Box inside, const Show *show)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    Update update = last_update(simulation);
    double x1 = update.x0 + update.p, p = x1 - update.x0, x = x1;
    Lines lines = {0};
    lines_add(&lines, COLOUR_X, "x^{%d} = %.8g", update.number, update.x0);
    lines_add(&lines, COLOUR_TEXT, "g = %.6g     E\u2033 = %.6g", update.first,
              update.second);
    lines_add(&lines, COLOUR_P, "{p} = \u2212g / E\u2033 = %.8g", p);
    if (update.alpha > 0) {
        char alpha[32], words[64] = "";
        alpha_text(alpha, sizeof alpha, update.alpha);
        if (update.alpha < 1)
            snprintf(words, sizeof words, ",  {alpha} = %s", alpha);
        x = update.x0 + update.alpha * p;
        lines_add(&lines, COLOUR_X, "x^{%d} = %.8g%s", update.number + 1, x,
                  words);
    } else {
        lines_add(&lines, COLOUR_X, "x^{%d} + {p} = %.8g", update.number, x);
    }
    lines_add(&lines, COLOUR_TEXT, "E: %.8g \u2192 %.8g", update.f,
              scalar_at(simulation, x).value);
    if (update.second <= 0)
        lines_add(&lines, COLOUR_WARNING,
                  "E\u2033 < 0: the parabola has a highest point");
    lines_draw(paper, inside, &lines);
}

static const Card card_tangent_numbers = {
    .name = "numbers",
    .title = "the update with its numbers",
    .least = 10,
    .weight = 0.9,
    .draw = tangent_draw_numbers,
};

static const Card *const tangent_cards[] = {&card_page, &card_tangent_numbers,
                                            &card_residual, NULL};

const Picture tangent_picture = {
    .name = "tangent",
    .cards = tangent_cards,
    .stretched = true,
    .own_handles = true,
    .bounds = tangent_bounds,
    .draw = tangent_draw,
    .pick = tangent_pick,
};
