#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/handles.h"
#include "scenes/tangent_scene.h"

enum { TANGENT_POINTS = 300 };

static const double TANGENT_REACH = 3; /* m, x from -3 to 3 at least */

/* Only x counts: both plots share it. */
static void tangent_bounds(const Show *show, int pane, double bounds[4])
{
    const Simulation *simulation = show->pane[pane].simulation;
    double reach = TANGENT_REACH;
    while (reach < 1.05 * fabs(simulation->descent.point[0]) && reach < 1e100)
        reach *= 2;
    bounds[2] = bounds[3] = reach;
    bounds[0] = bounds[1] = -reach;
}

/* The last update, or the one to come: from x0 to x1. */
typedef struct TangentUpdate {
    double x0, x1, E, g, slope; /* at x0; x1 = x0 + p */
    double alpha;               /* 0: not known yet */
    bool made;
} TangentUpdate;

static TangentUpdate tangent_update(const Descent *descent)
{
    const ScalarFunction *f = &descent->scalar.f;
    bool whole = descent->scalar.search == LINE_SEARCH_NONE;
    TangentUpdate update = {.x0 = descent->scalar.x, .alpha = whole};
    int last = descent->count - 1;
    if (last >= 0 && last < DESCENT_MAX) {
        update.x0 = descent->record[last].from[0];
        update.alpha = descent->record[last].alpha;
        update.made = true;
    }
    update.E = scalar_at(f, update.x0).value;
    update.g = scalar_at(f, update.x0).first;
    update.slope = scalar_at(f, update.x0).second;
    update.x1 = update.x0 - update.g / update.slope;
    return update;
}

/* The largest |g| and E of all iterates, so that both axes fit them. */
static void tangent_range(const Descent *descent, double *g, double *E)
{
    const ScalarFunction *f = &descent->scalar.f;
    *g = 4;
    *E = 2;
    for (int i = 0; i <= descent->count; i++) {
        bool last = i == descent->count;
        double x = last ? descent->scalar.x : descent->record[i].from[0];
        *g = fmax(*g, fabs(scalar_at(f, x).first));
        *E = fmax(*E, scalar_at(f, x).value);
    }
    *g = plot_round_axis(fmin(*g, 1e12));
    *E = plot_round_axis(fmin(*E, 1e12));
}

/* Upper half (0): g.  Lower half (1): E. */
static Plot tangent_plot(Paper *paper, const Stage *stage,
                         const Simulation *simulation, int half)
{
    Box box = stage->box;
    double low[2], high[2], g, E;
    tangent_range(&simulation->descent, &g, &E);
    box.height /= 2;
    box.y += half * box.height;
    if (stage->text) {
        box.x += paper_pixels(paper, 3.2);
        box.width -= paper_pixels(paper, 4);
        box.y += paper_pixels(paper, half ? 2.0 : 2.2);
        box.height -= paper_pixels(paper, half ? 3.8 : 3.6);
    }
    if (box.width < 1 || box.height < 1)
        box = stage->box;
    camera_world(&stage->camera, box.x, box.y, low);
    camera_world(&stage->camera, box.x + box.width, box.y, high);
    Plot plot = {box,
                 {low[0], high[0], false, false, half ? "x in m" : NULL},
                 {half ? -0.25 * E : -g, half ? E : g, false, false, NULL}};
    if (stage->text)
        plot_axes(paper, &plot);
    return plot;
}

/* A function of x over the whole axis: 0 g, 1 E, 2 the parabola. */
static void tangent_curve(Paper *paper, const Plot *plot,
                          const ScalarFunction *f, int which,
                          const TangentUpdate *update, double width,
                          Colour colour)
{
    double from[2] = {0, 0};
    for (int i = 0; i <= TANGENT_POINTS; i++) {
        double x =
            plot->x.low + (plot->x.high - plot->x.low) * i / TANGENT_POINTS;
        double d = x - update->x0;
        const double to[2] = {
            x, which == 0 ? scalar_at(f, x).first
               : which == 1
                   ? scalar_at(f, x).value
                   : update->E + d * (update->g + 0.5 * d * update->slope)};
        if (i > 0)
            plot_line(paper, plot, from, to, width, colour);
        from[0] = to[0];
        from[1] = to[1];
    }
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
                             const Descent *descent, bool text)
{
    const ScalarFunction *f = &descent->scalar.f;
    double used = -1e9;
    for (int i = 0; i <= descent->count; i++) {
        bool last = i == descent->count;
        double x = last ? descent->scalar.x : descent->record[i].from[0];
        const double g[2] = {x, scalar_at(f, x).first};
        const double E[2] = {x, scalar_at(f, x).value};
        Colour colour = last ? COLOUR_TEXT : COLOUR_X;
        double at[2];
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
                          const ScalarFunction *f, const TangentUpdate *update)
{
    double d = 0.15 * (update->x1 - update->x0);
    const double a[2] = {update->x0 - d, update->g - d * update->slope};
    const double b[2] = {update->x1 + d, d * update->slope};
    const double zero[2] = {update->x1, 0};
    double p = update->x1 - update->x0;
    const double lowest[2] = {update->x1, update->E + 0.5 * update->g * p};
    plot_line(paper, &plot[0], a, b, 2.4, COLOUR_P);
    tangent_curve(paper, &plot[1], f, 2, update, 1.8, COLOUR_P);
    tangent_upright(paper, plot, update->x1, COLOUR_P);
    if (plot_disc(paper, &plot[0], zero, 6, COLOUR_P))
        plot_disc(paper, &plot[0], zero, 3.6, COLOUR_WHITE);
    if (plot_disc(paper, &plot[1], lowest, 6, COLOUR_P))
        plot_disc(paper, &plot[1], lowest, 3.6, COLOUR_WHITE);
}

/* Rings round the iterate on E and round x_tilde on the axis. */
static void tangent_handle_rings(Paper *paper, const Plot plot[2],
                                 const Show *show, const Simulation *simulation)
{
    double at[SCENE_MAX_HANDLES][2], pixel[2];
    tangent_handles(simulation, at);
    for (int i = 0; i < 2; i++) {
        bool over = show->hover.kind == PICK_HANDLE && show->hover.index == i;
        plot_place(&plot[1], at[i][0], at[i][1], pixel);
        if (at[i][0] < plot[1].x.low || at[i][0] > plot[1].x.high)
            continue;
        canvas_ring(&paper->canvas, pixel[0], pixel[1],
                    (over ? 13 : 10) * paper->unit,
                    (over ? 3 : 1.8) * paper->unit, COLOUR_HAND);
        if (i == 1)
            canvas_disc(&paper->canvas, pixel[0], pixel[1], 5 * paper->unit,
                        COLOUR_X_TILDE);
        if (i == 1)
            paper_write(paper, FACE_BOLD, 1, COLOUR_X_TILDE, pixel[0],
                        pixel[1] + 0.7 * paper->em, ALIGN_CENTRE, "{xt}");
    }
}

static void tangent_draw(Paper *paper, const Stage *stage, const Show *show)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    const Descent *descent = &simulation->descent;
    const Prediction *guess = &simulation->prediction;
    const ScalarFunction *f = &descent->scalar.f;
    TangentUpdate update = tangent_update(descent);
    Plot plot[2];
    for (int half = 0; half < 2; half++) {
        plot[half] = tangent_plot(paper, stage, simulation, half);
        const double a[2] = {plot[half].x.low, 0},
                     b[2] = {plot[half].x.high, 0};
        plot_line(paper, &plot[half], a, b, 1, COLOUR_GREY);
        tangent_curve(paper, &plot[half], f, half, &update, 2.6, COLOUR_X);
    }
    if (update.made || !(guess->made && !guess->shown))
        tangent_model(paper, plot, f, &update);
    tangent_iterates(paper, plot, descent, stage->text);
    if (!show->bare)
        tangent_handle_rings(paper, plot, show, simulation);
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
    const Simulation *simulation = show->pane[stage->pane].simulation;
    Pick pick = {PICK_PLACE, stage->pane, 0, {0, 0}};
    double at[SCENE_MAX_HANDLES][2], best = 14;
    camera_world(&stage->camera, x, y, pick.point);
    tangent_handles(simulation, at);
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
    TangentUpdate update = tangent_update(&simulation->descent);
    int number = simulation->descent.count - (update.made ? 1 : 0);
    Lines lines = {0};
    lines_add(&lines, COLOUR_X, "x^{%d} = %.8g", number, update.x0);
    lines_add(&lines, COLOUR_TEXT, "g = %.6g     E\u2033 = %.6g", update.g,
              update.slope);
    lines_add(&lines, COLOUR_P, "{p} = \u2212g / E\u2033 = %.8g",
              update.x1 - update.x0);
    double p = update.x1 - update.x0, x = update.x1;
    if (update.alpha > 0) {
        char alpha[32], words[64] = "";
        alpha_text(alpha, sizeof alpha, update.alpha);
        if (update.alpha < 1)
            snprintf(words, sizeof words, ",  {alpha} = %s", alpha);
        x = update.x0 + update.alpha * p;
        lines_add(&lines, COLOUR_X, "x^{%d} = %.8g%s", number + 1, x, words);
    } else {
        lines_add(&lines, COLOUR_X, "x^{%d} + {p} = %.8g", number, x);
    }
    lines_add(&lines, COLOUR_TEXT, "E: %.8g \u2192 %.8g", update.E,
              scalar_at(&simulation->descent.scalar.f, x).value);
    if (update.slope <= 0)
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
