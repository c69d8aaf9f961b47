/* landscape_picture.c - maps of E over the position of one free node, with
 * Newton's path (scene landscape) or the minimisers of all h (scene dial). */
#include <math.h>
#include <string.h>

#include "picture/cards.h"

/* Levels of the contours for h up to 0.2 s, J s^2; dense where E is small. */
static const double map_levels[] = {0.1, 0.2, 0.4, 0.6, 1,  1.5, 2,
                                    3,   5,   7,   10,  15, 30,  50};
enum { MAP_LEVEL_COUNT = sizeof map_levels / sizeof *map_levels };

/* Colours "green" and "blue" for the zeros of components 1 and 2 of grad E. */
static const Colour curve_colour[2] = {0xff009e73u, 0xff0072b2u};

/* ---- the map ------------------------------------------------------------ */

/* Returns the difference between a value and the nearest contour's level. */
static double find_distance_to_level(double value)
{
    double nearest = INFINITY;
    for (int k = 0; k < MAP_LEVEL_COUNT; k++)
        nearest = fmin(nearest, fabs(value - map_levels[k]));
    return nearest;
}

/* Returns the factor of the contours' levels: elasticity grows as h^2. */
static double find_contour_scale(const Simulation *simulation)
{
    double h = simulation->run[0].h / 0.2;
    bool elastic = simulation->exhibit.switches & PART_ELASTICITY;
    return elastic && h > 1 ? h * h : 1;
}

/* Returns E at x, with the Hessian before projection. */
static TaylorModel evaluate_model(const Simulation *simulation, const double *x)
{
    return descent_evaluate(simulation, PROJECTION_NONE, x[0], x[1]);
}

bool local_model_is_convex(const TaylorModel *E)
{
    return E->H[0] > 0 && E->H[0] * E->H[2] > E->H[1] * E->H[1];
}

/* Draws contours in the 2 x 2 pixels from (i, j) on, where the function is
 * nearly linear: the distance to a contour in pixels is the difference from the
 * contour's level divided by the slope.
 *   right, up  slopes per pixel
 *   zero       draws the contour of 0 instead of the map's levels */
static void draw_contours(const Plot *plot, int i, int j, double value,
                          double right, double up, bool zero, Colour colour)
{
    double width = fmax(1, (zero ? 1.8 : 0.6) * plot->paper->unit);
    double reach = 0.5 + 0.5 * width;
    double slope = sqrt(right * right + up * up);
    double away = zero ? fabs(value) : find_distance_to_level(value);
    if (away > (reach + 1) * slope)
        return;
    for (int k = 0; k < 4; k++) {
        double at = value + (k % 2 - 0.5) * right - (k / 2 - 0.5) * up;
        away = zero ? fabs(at) : find_distance_to_level(at);
        double part = fmin(fmax(reach - away / slope, 0), 1);
        canvas_fill(&plot->paper->canvas, (Box){i + k % 2, j + k / 2, 1, 1},
                    (Colour)(255 * part) << 24 | (colour & 0xffffff));
    }
}

/* Draws contours, zeros of grad E's components, and the nonconvex region. */
static void draw_contour_map(const Plot *plot)
{
    const Simulation *simulation = plot->simulation;
    Canvas *canvas = &plot->paper->canvas;
    double metre = 1 / plot->camera.scale[0],
           e = find_contour_scale(simulation);
    const Box *box = &plot->box;
    bool curves = simulation->options.layers & LAYER_ZERO_CURVES;
    Colour contour = curves ? COLOUR_REST : COLOUR_GREY;
    Box before = canvas_set_clip(canvas, *box);
    canvas_fill(canvas, *box, COLOUR_WHITE);
    for (int j = box->y; j < box->y + box->height; j += 2)
        for (int i = box->x; i < box->x + box->width; i += 2) {
            TaylorModel E =
                descent_evaluate(simulation, PROJECTION_NONE,
                                 plot->x.low + (i - box->x + 1) * metre,
                                 plot->y.high - (j - box->y + 1) * metre);
            if (!local_model_is_convex(&E))
                canvas_fill(canvas, (Box){i, j, 2, 2}, COLOUR_SHADE);
            draw_contours(plot, i, j, E.energy / e, E.g[0] * metre / e,
                          E.g[1] * metre / e, false, contour);
            for (int k = 0; k < 2 && curves; k++)
                draw_contours(plot, i, j, E.g[k], E.H[k] * metre,
                              E.H[k + 1] * metre, true, curve_colour[k]);
        }
    canvas_set_clip(canvas, before);
}

/* Writes the contours' levels, J s^2, along a ray from x_tilde. */
static void write_contour_levels(const Plot *plot)
{
    static const double ray[2] = {0.62, -0.78}, pace = 0.005; /* m */
    const Simulation *simulation = plot->simulation;
    double e = find_contour_scale(simulation), before = NAN, last = 0, place[2];
    double space = 1.3 * plot->em / plot->camera.scale[0];
    const Box inside = box_inset(plot->box, (int)plot->em);
    for (double gone = 0; gone < 3; gone += pace) {
        const Point x = point_along(simulation->exhibit.x_tilde, gone, ray);
        double value = evaluate_model(simulation, x.xy).energy / e;
        plot_to_pixel(plot, x.xy, place);
        for (int k = 0; k < MAP_LEVEL_COUNT; k++)
            if (before < map_levels[k] && value >= map_levels[k] &&
                gone > last + space &&
                box_contains(inside, place[0], place[1])) {
                paper_write_on_panel(
                    plot->paper, FACE_REGULAR, 0.85, COLOUR_FAINT, place[0],
                    place[1] - 0.6 * plot->em, ALIGN_CENTRE, "%s",
                    format_number(map_levels[k] * e).text);
                last = gone;
            }
        before = value;
    }
}

/* Draws the map, the springs, the pins and x_tilde. */
static Plot draw_landscape_map(const Plot *stage)
{
    const Simulation *simulation = stage->simulation;
    const System *system = &simulation->system;
    const double *x = simulation->run[0].x;
    Plot plot =
        plot_create_on_stage(stage, (Axis){.label = "x in m"}, (Axis){0});
    bool curves = simulation->options.layers & LAYER_ZERO_CURVES;
    draw_contour_map(&plot);
    if (plot.has_text && stage->content->lecture.page)
        write_contour_levels(&plot);
    plot_springs(&plot, system, x, 3.5, curves ? COLOUR_GRID : COLOUR_REST);
    for (int i = 1; i < system->nodes; i++)
        plot_draw_pin(&plot, x + 2 * i, 5);
    plot_disc(&plot, simulation->exhibit.x_tilde, 6, COLOUR_X_TILDE);
    return plot;
}

/* ---- Newton's path ------------------------------------------------------- */

/* Marks the minima and the saddle of E, found by Newton's method.  The saddle
 * is left out with LAYER_DOWNHILL, as its label would cover the arrows. */
static void mark_stationary_points(const Plot *plot)
{
    const Simulation *simulation = plot->simulation;
    double at[3][2] = {{0, 1}, {0, -1}, {0, 0}};
    int points = simulation->options.layers & LAYER_DOWNHILL ? 2 : 3;
    for (int i = 0; i < points; i++) {
        double p[2] = {1, 1};
        for (int k = 0; k < 40 && vector_length(p) > 1e-9; k++) {
            descent_find_p(simulation, PROJECTION_NONE, at[i], p);
            at[i][0] += p[0];
            at[i][1] += p[1];
        }
        bool saddle = i == 2;
        if ((i == 1 && point_distance(at[0], at[1]) < 1e-6) ||
            !(vector_length(p) <= 1e-9) ||
            descent_classify_hessian(simulation, at[i][0], at[i][1]) != saddle)
            continue;
        plot_hollow_disc(plot, at[i], 4, 2, COLOUR_TEXT);
        plot_label(plot, 1, at[i], COLOUR_TEXT, saddle ? "saddle" : "minimum");
    }
}

/* Draws the direction p of the run, red if uphill, and if `both` also p with
 * projection switched on or off.  For one part of E: the run's p if `both`. */
static void draw_newton_directions(const Plot *plot, bool both)
{
    const Simulation *simulation = plot->simulation;
    const Descent *descent = &simulation->descent;
    bool raw = simulation->options.projection == PROJECTION_NONE;
    bool alone = simulation->exhibit.switches != PART_BOTH;
    const double *own = descent->direction, *from = descent->iterate;
    double p[2], slope;
    if (own[0] == 0 && own[1] == 0)
        return;
    slope = descent_find_p(simulation, raw ? PROJECTION_CLAMP : PROJECTION_NONE,
                           from, p);
    bool other = both && !alone && point_distance(own, p) > 1e-9;
    Colour colour = slope > 0 ? COLOUR_WARNING
                    : raw     ? COLOUR_PROJECT
                              : COLOUR_GHOST;
    Colour own_colour = descent->slope > 0 ? COLOUR_WARNING : COLOUR_P;
    if (other)
        plot_arrow(plot, from, p, 1, 2.2, colour);
    if (both || !alone)
        plot_arrow(plot, from, own, 1, 2.2, own_colour);
    if (other && plot->is_answer_shown)
        plot_label(plot, 1, point_along(from, 1, own).xy, own_colour,
                   "g \u00b7 p = %s J s\u00b2",
                   format_digits(descent->slope, 2).text);
    const Point tip = point_along(from, 1, p);
    double pixel[2];
    plot_to_pixel(plot, tip.xy, pixel);
    if (other && box_contains(plot->box, pixel[0], pixel[1]))
        plot_label(plot, 1, tip.xy, colour, "with %s: %s J s\u00b2",
                   raw ? "\u0124" : "H", format_digits(slope, 2).text);
}

/* Returns a length greater than the diagonal of the view, m. */
static double find_length_beyond_view(const Plot *plot)
{
    return 4 * (plot->box.width + plot->box.height) / plot->camera.scale[0];
}

/* Draws minus the gradient of each part of E that is on; an arrow of 1 m is a
 * gradient of 1 kg m, as E is in J s^2. */
static void draw_force_arrows(const Plot *plot, const TaylorModel *E)
{
    const Simulation *simulation = plot->simulation;
    const double *x = simulation->descent.iterate, *m = simulation->system.m;
    const double *target = simulation->exhibit.x_tilde;
    unsigned parts = simulation->exhibit.switches;
    double inertia[2], springs[2];
    for (int c = 0; c < 2; c++) {
        inertia[c] = parts & PART_INERTIA ? m[0] * (target[c] - x[c]) : 0;
        springs[c] = -E->g[c] - inertia[c];
    }
    plot_arrow(plot, x, inertia, 1, 2.6, COLOUR_X_TILDE);
    plot_arrow(plot, x, springs, 1, 2.6, COLOUR_FORCE);
    if (parts == PART_BOTH)
        plot_arrow(plot, x, E->g, -1, 2.2, COLOUR_TEXT);
}

/* Returns the sum of the given parts of E at x; values below 1e-30 become 0. */
static double evaluate_energy_parts(const Simulation *simulation,
                                    unsigned parts, const double *x)
{
    double value = landscape_sum_energy_parts(simulation, parts, x[0], x[1]);
    return value < 1e-30 ? 0 : value;
}

static void append_energy_part_name(unsigned parts, LiveValues *values)
{
    values_add_words(values, "part",
                     parts == PART_BOTH      ? "E"
                     : parts == PART_INERTIA ? "inertia"
                                             : "elasticity");
}

/* Adds live values: the number of updates that Algorithm 1 makes from the start
 * of the descent, and after the last update the new velocity. */
static void add_newton_values(const Simulation *simulation, LiveValues *values)
{
    const Descent *descent = &simulation->descent;
    double h = simulation->options.timestep, x[2], p[2], v[2];
    const double *start = descent->record_count > 0
                              ? descent->record[0].x_before
                              : descent->iterate;
    int updates = 0;
    memcpy(x, start, sizeof x);
    while (updates < DESCENT_MAX_RECORDS &&
           vector_length(evaluate_model(simulation, x).g) >
               simulation->options.tolerance &&
           descent_find_p(simulation, PROJECTION_NONE, x, p) != 0) {
        for (int k = 0; k < 2; k++)
            x[k] += p[k];
        updates++;
    }
    values_add(values, "updates", updates);
    for (int k = 0; k < 2; k++)
        v[k] = (descent->iterate[k] - start[k]) / h;
    if (simulation->is_over)
        values_add_point(values, "v end", v);
}

void list_landscape_values(const Simulation *simulation, LiveValues *values)
{
    static const char *const raw[] = {"Hxx", "Hxy", "Hyy"};
    static const char *const projected[] = {"Pxx", "Pxy", "Pyy"};
    const Descent *descent = &simulation->descent;
    unsigned parts = simulation->exhibit.switches;
    double h = simulation->run[0].h;
    const double *x = descent->iterate;
    TaylorModel E = evaluate_model(simulation, x);
    values_add_point(values, "place", x);
    values_add_point(values, "x tilde", simulation->exhibit.x_tilde);
    values_add(values, "slope", descent->slope != 0 ? descent->slope : NAN);
    unsigned layers = simulation->options.layers;
    bool raw_start = simulation->options.projection == PROJECTION_NONE &&
                     descent->record_count == 0;
    if (parts == PART_BOTH) {
        TaylorModel P =
            descent_evaluate(simulation, PROJECTION_CLAMP, x[0], x[1]);
        values_add_matrix(values, projected, P.H, 0);
        values_add_flag(values, "directions",
                        raw_start && layers & LAYER_DOWNHILL);
    }
    values_add(values, "E", evaluate_energy_parts(simulation, parts, x));
    values_add(values, "bowl",
               evaluate_energy_parts(simulation, PART_INERTIA, x));
    values_add(values, "elastic part",
               evaluate_energy_parts(simulation, PART_ELASTICITY, x));
    values_add_matrix(values, raw, E.H, 0);
    append_energy_part_name(parts, values);
    values_add(values, "h", parts == PART_INERTIA ? NAN : h);
    values_add_flag(values, "both", parts == PART_BOTH);
    values_add_flag(values, "elastic", parts != PART_INERTIA);
    values_add_flag(values, "inertial", parts != PART_ELASTICITY);
    bool pulls = layers & LAYER_FORCES, up = descent->slope > 0;
    bool down = descent->slope < 0 && parts == PART_BOTH && !pulls;
    for (int i = 0; i < descent->record_count; i++) {
        down = down || descent->record[i].slope < 0;
        up = up || descent->record[i].slope > 0;
    }
    values_add_flag(values, "pulls", pulls);
    add_newton_values(simulation, values);
    values_add_flag(values, "halves", layers & LAYER_DOWNHILL);
    values_add_flag(values, "curves", layers & LAYER_ZERO_CURVES);
    values_add_flag(values, "directed", down);
    values_add_flag(values, "went uphill", up);
}

/* If H is positive definite, draws three contours of the quadratic model around
 * its minimum x + p, the largest through x. */
static void draw_model_ellipses(const Plot *plot, const TaylorModel *E)
{
    static const double levels[] = {1, 0.6, 0.25};
    const Descent *descent = &plot->simulation->descent;
    const double *x = descent->iterate, *p = descent->direction;
    double low = E->H[0], lift = E->H[1] / E->H[0];
    double rest = E->H[2] - lift * E->H[1]; /* H = L D L^T */
    double q = p[0] + lift * p[1];
    double height = low * q * q + rest * p[1] * p[1];
    if (!(low > 0 && rest > 0))
        return;
    for (int k = 0; k < 3; k++) {
        double radius = levels[k] * sqrt(height), up = radius / sqrt(rest);
        const double a[2] = {radius / sqrt(low), 0}, b[2] = {-lift * up, up};
        plot_ellipse(plot, point_along(x, 1, p).xy, a, b, 1.6, false, COLOUR_P);
    }
}

/* Draws the lines on which a linearised component of the gradient is 0, and
 * once the page shows its answer a ring at their crossing. */
static void draw_linearised_zeros(const Plot *plot, const TaylorModel *E)
{
    const double *x = plot->simulation->descent.iterate;
    for (int k = 0; k < 2; k++) {
        const double *slope = E->H + k, across[2] = {-slope[1], slope[0]};
        double square = slope[0] * slope[0] + slope[1] * slope[1];
        double far = find_length_beyond_view(plot) / sqrt(square);
        const Point foot = point_along(x, -E->g[k] / square, slope);
        plot_dashes(plot, point_along(foot.xy, -far, across).xy,
                    point_along(foot.xy, far, across).xy, 2.4, NULL,
                    curve_colour[k]);
    }
    if (plot->is_answer_shown)
        plot_ring(plot,
                  point_along(x, 1, plot->simulation->descent.direction).xy, 8,
                  2.4, COLOUR_P);
}

/* Draws the half plane g . p < 0 of the directions that point downhill. */
static void draw_downhill_half_plane(const Plot *plot, const TaylorModel *E)
{
    const double *x = plot->simulation->descent.iterate;
    const double across[2] = {-E->g[1], E->g[0]};
    double far = find_length_beyond_view(plot) / vector_length(E->g);
    const Point a = point_along(x, far, across),
                b = point_along(x, -far, across),
                c = point_along(b.xy, -far, E->g),
                d = point_along(a.xy, -far, E->g);
    const double *const corner[4] = {a.xy, b.xy, c.xy, d.xy};
    Box before = canvas_set_clip(&plot->paper->canvas, plot->box);
    plot_quad(plot, corner, COLOUR_DOWNHILL);
    plot_line(plot, a.xy, b.xy, 1.2, COLOUR_COMPRESS);
    canvas_set_clip(&plot->paper->canvas, before);
}

/* Draws the map, the path and the layers that are on.  Each update has a thin
 * arrow for p and a thick line for alpha p, red if uphill. */
void draw_landscape_picture(Plot *stage)
{
    const Simulation *simulation = stage->simulation;
    const LectureContent *lecture = &stage->content->lecture;
    const Descent *descent = &simulation->descent;
    const TaylorModel E = evaluate_model(simulation, descent->iterate);
    Plot plot = draw_landscape_map(stage);
    unsigned layers = simulation->options.layers;
    bool halves = layers & LAYER_DOWNHILL && !simulation->is_over;
    bool curves = layers & LAYER_ZERO_CURVES;
    if (halves)
        draw_downhill_half_plane(&plot, &E);
    for (int i = 0; i < descent->record_count; i++) {
        const NewtonRecord *record = &descent->record[i];
        const double *from = record->x_before, *to = record->x_after;
        Colour colour = record->slope > 0 ? COLOUR_WARNING : COLOUR_P;
        if (record->alpha > 0)
            plot_arrow(&plot, from, vector_between(from, to).xy,
                       1 / record->alpha, 1.2, colour);
        plot_line(&plot, from, to, 3.2, colour);
        plot_disc(&plot, from, 5, COLOUR_X);
    }
    bool raw = simulation->options.projection == PROJECTION_NONE;
    bool both = !lecture->page || (raw && halves);
    if (stage->is_answer_shown && raw && !curves && !simulation->is_over)
        draw_model_ellipses(&plot, &E);
    if (curves && !simulation->is_over)
        draw_linearised_zeros(&plot, &E);
    if (stage->is_answer_shown && layers & LAYER_FORCES)
        draw_force_arrows(&plot, &E);
    else if (!lecture->hides_answer)
        draw_newton_directions(&plot, plot.has_text && both);
    if (halves) {
        double far = 6 * plot.em / plot.camera.scale[0] / vector_length(E.g);
        plot_arrow(&plot, descent->iterate, E.g, -far, 2.2, COLOUR_TEXT);
        plot_label(&plot, 1, point_along(descent->iterate, -far, E.g).xy,
                   COLOUR_TEXT, "\u2212\u2207E");
    }
    if (stage->is_answer_shown && plot.has_text && !curves &&
        simulation->exhibit.switches != PART_INERTIA)
        mark_stationary_points(&plot);
    plot_disc(&plot, descent->iterate, 7, COLOUR_TEXT);
    plot_label(&plot, 1, simulation->exhibit.x_tilde, COLOUR_X_TILDE, "{xt}");
}

/* ---- the dial ----------------------------------------------------------- */

/* Draws the curve of minimisers for all h, discs where h is a power of ten. */
void draw_dial_picture(Plot *stage)
{
    const Simulation *simulation = stage->simulation;
    const MinimiserCurve *dial = &simulation->exhibit.dial;
    Plot plot = draw_landscape_map(stage);
    int points = stage->content->lecture.hides_answer ? 0 : DIAL_POINTS;
    for (int i = 1; i < points; i++)
        plot_line(&plot, dial->minimiser[i - 1], dial->minimiser[i], 3,
                  COLOUR_X);
    for (int i = 10; i < points; i += 10)
        plot_disc(&plot, dial->minimiser[i], 4.5, COLOUR_X);
    plot_disc(&plot, simulation->run[0].x, 9, COLOUR_TEXT);
    plot_label(&plot, 1, simulation->exhibit.x_tilde, COLOUR_X_TILDE, "{xt}");
    for (int i = points - 11; i > 10 && plot.has_text; i -= 10) {
        bool last = i == points - 11; /* the label of h[i] and all larger h */
        double at[2];
        plot_to_pixel(&plot, dial->minimiser[i], at);
        paper_write_on_panel(
            plot.paper, FACE_BOLD, 1, COLOUR_X, at[0] + (last ? 0 : plot.em),
            at[1] - (last ? 2 : 0.6) * plot.em,
            last ? ALIGN_CENTRE : ALIGN_LEFT, "h %s %s s",
            last ? "\u2265" : "=", format_number(dial->h[i]).text);
    }
}

void list_dial_values(const Simulation *simulation, LiveValues *values)
{
    const double *x = simulation->run[0].x, h = simulation->run[0].h;
    double elastic = evaluate_energy_parts(simulation, PART_ELASTICITY, x);
    append_energy_part_name(simulation->exhibit.switches, values);
    values_add(values, "h", h);
    values_add_point(values, "minimiser", x);
    values_add(values, "distance",
               point_distance(simulation->exhibit.x_tilde, x));
    values_add(values, "inertia",
               evaluate_energy_parts(simulation, PART_INERTIA, x));
    values_add(values, "elasticity", elastic);
    values_add(values, "P", elastic / (h * h));
}
