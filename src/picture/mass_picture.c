/* mass_picture.c - masses on a circle, and a mass with the arrows of a step. */
#include <math.h>
#include <string.h>

#include "picture/cards.h"

enum {
    MAX_TRAIL_STEPS = 256,  /* most steps of a drawn path */
    EIGENVALUE_PIECES = 200 /* pieces of the eigenvalues' path over h */
};

static const double MASS_REACH = 1.9;    /* m, least half side of the view */
static const double CIRCLE_REACH = 1.75; /* m, least half side of the view */
static const double CIRCLE_MAX = 4;      /* m, largest radius that is shown */
static const double TWO_PI = 6.283185307179586;
static const double EIGEN_REACH = 1.35; /* least half side of the shown plane */
static const double EIGEN_MAX = 5;      /* largest |eigenvalue| that is shown */
/* Room for the eigenvalues as numbers, ems. */
static const double NUMBERS_WIDE = 16.4, NUMBERS_HIGH = 9;
static const double origin[2] = {0, 0};

/* Returns the colour of a run's method, or COLOUR_X for a mass with arrows. */
static Colour colour_of_mass(const Simulation *simulation, int run)
{
    return simulation->runs == 1 && simulation->scene->picture == PICTURE_MASS
               ? COLOUR_X
               : colour_of_name(simulation->run[run].method->name);
}

/* Draws the paths of the runs over the newest steps.
 *   steps  also draws a disc for each step */
static void draw_trails(const Plot *stage, bool steps)
{
    const History *history = stage->pane->history;
    int runs = stage->simulation->runs;
    for (int r = 0; history && history->series_count && r < runs; r++) {
        const double *x = history->value[runs + 2 * r];
        const double *y = history->value[runs + 2 * r + 1];
        Colour colour = colour_of_mass(stage->simulation, r);
        int first = history->point_count > MAX_TRAIL_STEPS
                        ? history->point_count - MAX_TRAIL_STEPS
                        : 0;
        for (int i = first; i < history->point_count; i++) {
            const double at[2] = {x[i], y[i]};
            if (steps)
                plot_disc(stage, at, 3.5, colour);
            if (i > first)
                plot_line(stage, (double[2]){x[i - 1], y[i - 1]}, at,
                          steps ? 1.6 : 2.2, colour);
        }
    }
}

static double compute_energy(const double *x, const double *v)
{
    return 0.5 * (x[0] * x[0] + x[1] * x[1] + v[0] * v[0] + v[1] * v[1]);
}

/* Lists the radius (scene circle) or energy of each run, then x, y of each. */
int mass_sample_energies(const Simulation *simulation, Energy *row)
{
    static const char *const places[] = {"x0", "y0", "x1", "y1", "x2", "y2"};
    bool circle = simulation->scene->picture == PICTURE_CIRCLE;
    int runs = simulation->runs;
    for (int r = 0; r < runs; r++) {
        const double *x = simulation->run[r].x, *v = simulation->run[r].v;
        row[r] = (Energy){simulation->run[r].method->label,
                          circle ? vector_length(x) : compute_energy(x, v)};
        for (int k = 0; k < 2; k++)
            row[runs + 2 * r + k] = (Energy){places[2 * r + k], x[k]};
    }
    return 3 * runs;
}

/* ---- the circle ---------------------------------------------------------- */

/* Draws the exact path with its radius, the trails, and a disc for each run.
 * On a page after the answer, a dashed circle has twice the radius. */
void draw_circle_picture(Plot *stage)
{
    const Simulation *simulation = stage->simulation;
    plot_ring(stage, origin, stage->camera.scale[0] / stage->paper->unit, 5,
              COLOUR_GRID);
    plot_line(stage, origin, (double[2]){1, 0}, 1.2, COLOUR_GREY);
    if (stage->is_answer_shown)
        plot_ellipse(stage, origin, (double[2]){2, 0}, (double[2]){0, 2}, 1.4,
                     true, COLOUR_GREY);
    plot_disc(stage, origin, 3.5, COLOUR_GREY);
    plot_label(stage, 1, (double[2]){0.5, 0}, COLOUR_FAINT, "1 m");
    draw_trails(stage, false);
    for (int r = 0; r < simulation->runs; r++)
        plot_disc(stage, simulation->run[r].x, 7,
                  colour_of_mass(simulation, r));
}

/* Finds a view of the runs up to CIRCLE_MAX; the exact circle stays visible. */
void find_circle_bounds(const Plot *stage, double bounds[4])
{
    const Simulation *simulation = stage->simulation;
    double most = 0;
    for (int r = 0; r < simulation->runs; r++)
        most = fmax(most, vector_length(simulation->run[r].x));
    find_centred_view(CIRCLE_REACH, 1.4 * fmin(most, CIRCLE_MAX), 1.2, bounds);
}

void circle_pick(const Plot *stage, double x, double y, Pick *pick)
{
    for (int r = 0; r < stage->simulation->runs; r++)
        if (plot_pick_point(stage, 1, stage->simulation->run[r].x, 16, x, y,
                            PICK_NODE, pick))
            pick->index = r;
}

/* Finds the eigenvalues of the matrix {xx, xv; -xv, vv} by which a step with
 * t = h omega multiplies (x, v/omega).  Returns false unless the method is one
 * of the three Euler methods.
 *   lambda  [2][2] real and imaginary parts, out; real ones ascend */
static bool find_step_eigenvalues(const IntegratorMethod *method, double t,
                                  double lambda[2][2])
{
    bool forward = strcmp(method->name, "forward-euler") == 0;
    double k = 1 / (1 + t * t), xx = forward ? 1 : 1 - t * t, xv = t, vv = 1;
    if (strcmp(method->name, "backward-euler") == 0) {
        xx = vv = k;
        xv = k * t;
    } else if (!forward && strcmp(method->name, "symplectic-euler") != 0)
        return false;
    double re = 0.5 * (xx + vv), square = re * re - xx * vv - xv * xv;
    double root = sqrt(fabs(square)), im = square < 0 ? root : 0;
    double half = square < 0 ? 0 : root;
    lambda[0][0] = re - half;
    lambda[0][1] = -im;
    lambda[1][0] = re + half;
    lambda[1][1] = im;
    return true;
}

static void add_eigenvalues(const IntegratorMethod *method, double t,
                            LiveValues *values)
{
    double lambda[2][2];
    if (!find_step_eigenvalues(method, t, lambda))
        return;
    const double *least = lambda[0], *most = lambda[1];
    bool pair = most[1] > 0;
    values_add(values, "re", pair ? most[0] : NAN);
    values_add(values, "im", most[1]);
    values_add(values, "least", pair ? NAN : least[0]);
    values_add(values, "most", most[0]);
    values_add(values, "size", fmax(vector_length(least), vector_length(most)));
}

/* Draws the eigenvalues of a run's step, and their path from h = 0. */
static void draw_eigenvalues(const Plot *plot, const IntegratorMethod *method,
                             double turn)
{
    Colour colour = colour_of_name(method->name);
    double before[2][2], now[2][2];
    for (int i = 0; i <= EIGENVALUE_PIECES; i++) {
        if (!find_step_eigenvalues(method, turn * i / EIGENVALUE_PIECES, now))
            return;
        for (int k = 0; k < 2 && i > 0; k++)
            plot_line(plot, before[k], now[k], 1.4, colour);
        memcpy(before, now, sizeof now);
    }
    for (int k = 0; k < 2; k++)
        plot_disc(plot, now[k], 5, colour);
}

/* Draws the complex plane, the unit circle and the eigenvalues of all runs. */
static void draw_complex_plane(const Plot *card)
{
    static const double one[2] = {1, 0}, i[2] = {0, 1};
    const Simulation *simulation = card->simulation;
    double turn = simulation->run[0].h * TWO_PI, most = 0;
    double bounds[4], lambda[2][2];
    for (int r = 0; r < simulation->runs; r++)
        for (int k = 0; k < 2; k++)
            if (find_step_eigenvalues(simulation->run[r].method, turn, lambda))
                most = fmax(most, vector_length(lambda[k]));
    find_centred_view(EIGEN_REACH, 1.1 * fmin(most, EIGEN_MAX), 1.2, bounds);
    Plot plot = *card;
    plot.camera = camera_create(card->box, bounds, false, &LENS_FITS);
    for (int k = 0; k < 2; k++) {
        const double low[2] = {k ? 0 : bounds[0], k ? bounds[1] : 0};
        const double high[2] = {k ? 0 : bounds[2], k ? bounds[3] : 0};
        plot_line(&plot, low, high, 1, COLOUR_BORDER);
    }
    plot_ellipse(&plot, origin, one, i, 2, false, COLOUR_GREY);
    for (int r = 0; r < simulation->runs; r++)
        draw_eigenvalues(&plot, simulation->run[r].method, turn);
    plot_label(&plot, 1, one, COLOUR_FAINT, "1");
    plot_label(&plot, 1, i, COLOUR_FAINT, "i");
}

/* Draws the eigenvalues as numbers, and the complex plane at the right, in a
 * high card below. */
void draw_eigenvalues_card(const Plot *card)
{
    Plot numbers = *card, plane = *card;
    const Box *box = &card->box;
    if (card->content->has_document) {
        draw_complex_plane(card);
        return;
    }
    int wide = paper_to_pixels(card->paper, NUMBERS_WIDE);
    int high = paper_to_pixels(card->paper, NUMBERS_HIGH);
    int rest = box->width - wide;
    if (box->height > box->width)
        plane.box = box_cut_off(&numbers.box, EDGE_BOTTOM, box->height - high);
    else
        plane.box = box_cut_off(&numbers.box, EDGE_RIGHT,
                                rest < box->height ? rest : box->height);
    card_write_text(&numbers, &card->pane->values, card_eigenvalues.words);
    Box before = canvas_set_clip(&card->paper->canvas, plane.box);
    draw_complex_plane(&plane);
    canvas_set_clip(&card->paper->canvas, before);
}

/* Adds name and distance from the origin of each run, and h.  In the scene
 * circle, also adds the eigenvalues of each run's step. */
void list_circle_values(const Simulation *simulation, LiveValues *values)
{
    double turn = simulation->run[0].h * TWO_PI; /* h omega */
    bool circle = simulation->scene->picture == PICTURE_CIRCLE;
    const char *first = simulation->run[0].method->name;
    for (int r = 0; r < simulation->runs; r++) {
        const TimeIntegrator *run = &simulation->run[r];
        values->next_run = r + 1;
        values->text_line_colour[r + 1] = colour_of_name(run->method->name);
        values_add_flag(values, "many", simulation->runs > 1);
        values_add_words(values, "name", run->method->label);
        values_add(values, "radius", vector_length(run->x));
        if (circle)
            add_eigenvalues(run->method, turn, values);
    }
    values->next_run = 0;
    if (circle && strcmp(first, "forward-euler") == 0) /* steps */
        values_add(values, "doubling", ceil(2 * log(2) / log1p(turn * turn)));
    values_add(values, "h", simulation->run[0].h);
}

/* ---- the arrows ---------------------------------------------------------- */

/* Finds a view with all masses and arrows, which grows by factors of sqrt(2)
 * and seldom moves.  On a page about a single step the view is close. */
void find_mass_bounds(const Plot *stage, double bounds[4])
{
    const Simulation *simulation = stage->simulation;
    MassStep first;
    if (simulation->options.layers & LAYER_FIRST_STEP &&
        simulation->steps == 0 && mass_find_next_step(simulation, 0, &first)) {
        double side = 0;
        for (int k = 0; k < 2; k++) {
            double x = first.x[k], tip = x + first.v[k], next = first.new_x[k];
            bounds[k] = fmin(fmin(0, x), fmin(tip, next));
            bounds[2 + k] = fmax(fmax(0, x), fmax(tip, next));
            side = fmax(side, bounds[2 + k] - bounds[k]);
        }
        for (int i = 0; i < 4; i++)
            bounds[i] += (i < 2 ? -0.14 : 0.14) * side;
        return;
    }
    const double *began = simulation->exhibit.exact_start;
    double most = math_hypot(vector_length(began), vector_length(began + 2));
    for (int r = 0; r < simulation->runs; r++) {
        MassStep step;
        mass_find_next_step(simulation, r, &step);
        for (int k = 0; k < 2; k++)
            most = fmax(most,
                        fmax(fabs(step.new_x[k]), fabs(step.x[k] + step.v[k])));
    }
    find_centred_view(MASS_REACH, 1.1 * most, sqrt(2), bounds);
}

static Point find_exact_position(const MassStep *step, double h)
{
    const Point x = point_along(origin, cos(h), step->x);
    return point_along(x.xy, sin(h), step->v);
}

/* Draws the error of a step of forward Euler, about h^2/2 a. */
static void draw_step_error(const Plot *stage, const MassStep *step, double h,
                            const char *words)
{
    const Point to = point_along(step->x, h, step->v);
    const Point at[2] = {point_along(to.xy, 0.5 * h * h, step->a),
                         point_along(to.xy, 0.25 * h * h, step->a)};
    plot_hollow_disc(stage, find_exact_position(step, h).xy, 6, 3.4,
                     COLOUR_GREY);
    plot_ring(stage, to.xy, 6, 2, COLOUR_X);
    plot_arrow(stage, to.xy, step->a, 0.5 * h * h, 2, COLOUR_WARNING);
    plot_label(stage, 2, at->xy, COLOUR_WARNING, "%s", words);
}

/* Draws what a page explains: the exact end of the step; for forward Euler the
 * error, in the first step also with labels and with the error for h/2; for
 * symplectic Euler with h < 2 the ellipse through the steps. */
static void draw_step_explanation(Plot *stage, const MassStep *step)
{
    double h = stage->simulation->run[0].h;
    const Point end = find_exact_position(step, h);
    plot_hollow_disc(stage, end.xy, 6, 3.4, COLOUR_GREY);
    bool first = stage->simulation->steps == 0;
    if (step->uses_old_v && first)
        draw_step_error(stage, step, 0.5 * h, "with h/2: a quarter");
    if (step->uses_old_v)
        draw_step_error(stage, step, h, first ? "\u00bdh\u00b2 a^{n}" : "");
    plot_label(stage, 1, end.xy, COLOUR_FAINT, "exact");
    bool symplectic =
        !step->uses_old_v && stage->simulation->run[0].method->stages == 0;
    double turn = 1 - 0.5 * h * h, reach = sqrt(1 - turn * turn);
    const Point side = point_along(step->new_x, -turn, step->x);
    const Point across = point_along(origin, 1 / reach, side.xy);
    if (symplectic && h < 2)
        plot_ellipse(stage, origin, step->x, across.xy, 2.4, false,
                     COLOUR_ALPHA);
}

/* Draws the arrows of one step in the order of the method.  Writes the labels
 * of long arrows, the most important label first. */
static void draw_mass_step(Plot *stage)
{
    const Simulation *simulation = stage->simulation;
    static const int order[] = {0, 1, 3, 2, 4};
    static const double part[] = {0.55, 0.8, 0.35, 0.7};
    MassStep step;
    if (!mass_find_next_step(simulation, 0, &step))
        return;
    bool backward = simulation->run[0].method->stages > 0;
    const double *a = backward ? step.new_a : step.a;
    const Point tip = point_along(step.x, 1, step.v),
                to = vector_between(step.x, step.new_x);
    const Point push = point_along(origin, simulation->run[0].h, a);
    const struct MassArrow {
        const double *start, *vector; /* m, start and vector of the arrow */
        double width;
        Colour colour;
        const char *label;
    } arrow[] = {
        {step.x, step.v, 2.6, COLOUR_VELOCITY, "v^{n}"},
        {tip.xy, push.xy, 2.6, COLOUR_FORCE,
         backward ? "h a^{n+1}" : "h a^{n}"},
        {step.x, step.new_v, 1.4, COLOUR_VELOCITY, "v^{n+1}"},
        {step.x, to.xy, 4, COLOUR_X, step.uses_old_v ? "h v^{n}" : "h v^{n+1}"},
        {step.new_x, step.new_a, 1.6, COLOUR_FORCE, "a^{n+1}"}};
    for (int i = 0; i < 4 + backward; i++)
        plot_arrow(stage, arrow[i].start, arrow[i].vector, 1, arrow[i].width,
                   arrow[i].colour);
    plot_ring(stage, step.new_x, 9, 2.4, COLOUR_X);
    plot_disc(stage, step.x, 8, COLOUR_X);
    if (stage->content->lecture.page)
        draw_step_explanation(stage, &step);
    plot_label(stage, 1, step.new_x, COLOUR_X, "x^{n+1}");
    for (int i = 0; i < 4 + backward; i++) {
        const struct MassArrow *now = &arrow[order[i]];
        Point at[4];
        for (int k = 0; k < 4; k++)
            at[k] = point_along(now->start, part[k], now->vector);
        if (vector_length(now->vector) * stage->camera.scale[0] > 4 * stage->em)
            plot_label(stage, 4, at->xy, now->colour, "%s", now->label);
    }
}

/* Draws the exact path, the trails and the next step of each run.  While the
 * page waits for a guess, velocity is the only arrow. */
void draw_mass_picture(Plot *stage)
{
    const Simulation *simulation = stage->simulation;
    const TimeIntegrator *run = simulation->run;
    double start[2], across[2]; /* conjugate half axes of the exact path */
    mass_find_exact_x(simulation, 0, start);
    mass_find_exact_x(simulation, 0.25 * TWO_PI, across);
    plot_ellipse(stage, origin, start, across, 4, false, COLOUR_GRID);
    for (int r = 0; r < simulation->runs; r++)
        plot_line(stage, origin, run[r].x, 1.4, COLOUR_REST);
    plot_draw_pin(stage, origin, 5);
    draw_trails(stage, true);
    for (int r = 0; simulation->runs > 1 && r < simulation->runs; r++) {
        MassStep step;
        mass_find_next_step(simulation, r, &step);
        plot_arrow(stage, step.x, vector_between(step.x, step.new_x).xy, 1, 3,
                   colour_of_mass(simulation, r));
        plot_ring(stage, step.new_x, 8, 2.2, colour_of_mass(simulation, r));
    }
    if (simulation->runs == 1 && stage->content->lecture.hides_answer) {
        plot_arrow(stage, run[0].x, run[0].v, 1, 2.6, COLOUR_VELOCITY);
        plot_label(stage, 1, point_along(run[0].x, 0.55, run[0].v).xy,
                   COLOUR_VELOCITY, "v^{n}");
    } else if (simulation->runs == 1)
        draw_mass_step(stage);
    for (int r = 0; r < simulation->runs; r++)
        plot_disc(stage, run[r].x, 8, colour_of_mass(simulation, r));
}

/* ---- live values -------------------------------------------------------- */

void list_mass_values(const Simulation *simulation, LiveValues *values)
{
    MassStep step;
    bool one = simulation->runs == 1;
    list_circle_values(simulation, values);
    for (int r = 0; r < simulation->runs; r++) {
        if (!mass_find_next_step(simulation, r, &step))
            continue;
        double before = compute_energy(step.x, step.v);
        double after = compute_energy(step.new_x, step.new_v);
        values->next_run = one ? 0 : r + 1;
        values_add(values, "energy", before);
        values_add(values, "later", after);
        values_add(values, "factor", after / before);
    }
    values->next_run = 0;
    bool backward = simulation->run[0].method->stages > 0;
    bool known = mass_find_next_step(simulation, 0, &step);
    values_add_flag(values, "stages", one && !known);
    if (!one || !known)
        return;
    values_add_flag(values, "numbers", true);
    values_add_words(values, "at", backward ? "n+1" : "n");
    values_add_words(values, "by", step.uses_old_v ? "n" : "n+1");
    values_add_point(values, "place", step.x);
    values_add_point(values, "v", step.v);
    values_add_point(values, "a", backward ? step.new_a : step.a);
    values_add_point(values, "x next", step.new_x);
    values_add_point(values, "v next", step.new_v);
    values_add_point(values, "carrying", step.uses_old_v ? step.v : step.new_v);
    double h = simulation->run[0].h;
    if (!step.uses_old_v && !backward) {
        /* Symplectic Euler keeps |x|^2 + |v|^2 - h x.v (h < 2: an ellipse). */
        double kept = 2 * compute_energy(step.x, step.v) -
                      h * (step.x[0] * step.v[0] + step.x[1] * step.v[1]);
        values_add_flag(values, "ellipse", h < 2);
        values_add(values, "kept", h < 2 ? kept : NAN);
    }
    values_add(values, "miss",
               point_distance(step.new_x, find_exact_position(&step, h).xy));
    if (step.uses_old_v) {
        const Point half = point_along(step.x, 0.5 * h, step.v);
        values_add(
            values, "half miss",
            point_distance(half.xy, find_exact_position(&step, 0.5 * h).xy));
    }
}
