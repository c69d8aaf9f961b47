/* spring_picture.c - a spring, and its energy over its length. */
#include <math.h>

#include "model/spring_law.h"
#include "picture/cards.h"

enum { SPRING_COILS = 12 };

static const double SPRING_REACH = 1.7;   /* m, least half side of the view */
static const double SPRING_ARROW = 0.005; /* m/N, scale of the force's arrow */
static const double SPRING_GAP = 0.13;    /* m, gap from spring to arrow */
static const double origin[2] = {0, 0};

void find_spring_bounds(const Plot *stage, double bounds[4])
{
    const double *x = stage->simulation->run[0].x;
    find_centred_view(SPRING_REACH, 1.1 * vector_length(x), sqrt(2), bounds);
}

static SpringValues evaluate_spring(const double d[2], const System *system)
{
    return spring_evaluate(d, system->l2[0], system->k[0]);
}

/* Returns the spring's energy at a signed length d, for plot_graph. */
static double energy_at_length(const void *system, double d)
{
    return evaluate_spring((double[2]){d, 0}, system).energy;
}

/* Returns P_root = 2k (|d| - l)^2 at a signed length d, for plot_graph. */
static double root_energy_at_length(const void *system, double d)
{
    return evaluate_spring((double[2]){d, 0}, system).root_energy;
}

/* Returns minus the slope of the spring's energy at a signed length d. */
static double force_at_length(const void *system, double d)
{
    return evaluate_spring((double[2]){d, 0}, system).force[0];
}

/* Returns minus the slope of the energy P_root at a signed length d. */
static double root_force_at_length(const void *data, double d)
{
    const System *system = data;
    return -4 * system->k[0] * (d - copysign(sqrt(system->l2[0]), d));
}

/* Draws a dashed circle of this radius around the held end. */
static void draw_length_circle(Plot *stage, double radius, Colour colour,
                               const char *word)
{
    const double a[2] = {radius, 0}, b[2] = {0, radius};
    const double label[2] = {-0.7071 * radius, -0.7071 * radius};
    plot_ellipse(stage, origin, a, b, 1.4, true, colour);
    plot_label(stage, 1, label, colour, "%s", word);
}

/* Draws a zigzag from the held end to x. */
static void draw_coil(Plot *stage, const double *x, Colour colour)
{
    const Point across = {{-x[1], x[0]}};
    Point from = {{0, 0}};
    double length = vector_length(x);
    for (int i = 1; i <= 2 * SPRING_COILS && length > 0; i++) {
        bool straight = i == 1 || i >= 2 * SPRING_COILS - 1;
        double side = straight ? 0 : (i % 2 ? 0.06 : -0.06) / length;
        const Point on = point_along(origin, (double)i / (2 * SPRING_COILS), x);
        const Point to = point_along(on.xy, side, across.xy);
        plot_line(stage, from.xy, to.xy, 2.4, colour);
        from = to;
    }
}

/* Draws the spring and its force.  The spring has another colour if projection
 * changes its block.  On a page about modes the eigenvectors (q, -q) of the
 * block replace the force: longer for larger eigenvalues, red for negative. */
void draw_spring_picture(Plot *stage)
{
    const Simulation *simulation = stage->simulation;
    const FrameContent *content = stage->content;
    const double *x = simulation->run[0].x;
    double l = sqrt(simulation->system.l2[0]);
    SpringValues spring = evaluate_spring(x, &simulation->system);
    bool shows_answer = !content->lecture.hides_answer;
    bool projects = spring.eigenvalue_across < 0 && shows_answer;
    bool modes = simulation->options.layers & LAYER_MODES;
    draw_length_circle(stage, l, COLOUR_FAINT, "l");
    if (!content->lecture.page || (modes && shows_answer))
        draw_length_circle(stage, l / sqrt(3), COLOUR_PROJECT, "l/\u221a3");
    draw_coil(stage, x, projects ? COLOUR_PROJECT : COLOUR_X);
    plot_draw_pin(stage, origin, 6);
    const double value[2] = {spring.eigenvalue_along, spring.eigenvalue_across};
    int vectors = modes && shows_answer && spring.length > 0 ? 4 : 0;
    for (int i = 0; i < vectors; i++) {
        double n[2] = {x[i / 2] / spring.length, x[1 - i / 2] / spring.length};
        double size = fabs(value[i / 2]);
        size /= size + 3 * simulation->system.k[0];
        n[0] = i / 2 ? -n[0] : n[0];
        plot_arrow(stage, i % 2 ? origin : x, n, i % 2 ? -size : size, 3.2,
                   value[i / 2] < 0 ? COLOUR_WARNING : COLOUR_X);
    }
    if (!modes && spring.length > 0) {
        const double across[2] = {-x[1], x[0]};
        const Point from = point_along(x, SPRING_GAP / spring.length, across);
        plot_arrow(stage, from.xy, spring.force, SPRING_ARROW, 3.2,
                   COLOUR_FORCE);
    }
    plot_disc(stage, x, 9, COLOUR_X);
}

/* ---- cards -------------------------------------------------------------- */

/* Adds two values: the force as a central difference of the energy, and the
 * Hessian as central differences of the force. */
static void add_central_differences(const Simulation *simulation,
                                    LiveValues *values)
{
    static const double step = 1e-4; /* m */
    static const char *const names[] = {"Dxx", "Dxy", "Dyy"};
    const System *system = &simulation->system;
    const double unit[2][2] = {{1, 0}, {0, 1}};
    const double *d = simulation->run[0].x;
    double force[2];
    for (int i = 0; i < 2; i++) {
        const SpringValues at[2] = {
            evaluate_spring(point_along(d, -step, unit[i]).xy, system),
            evaluate_spring(point_along(d, step, unit[i]).xy, system)};
        force[i] = (at[0].energy - at[1].energy) / (2 * step);
        for (int k = 0; k <= i; k++)
            values_add(values, names[i + k],
                       (at[0].force[k] - at[1].force[k]) / (2 * step));
    }
    values_add_point(values, "force too", force);
}

void list_spring_values(const Simulation *simulation, LiveValues *values)
{
    static const char *const names[2][3] = {{"Hxx", "Hxy", "Hyy"},
                                            {"Pxx", "Pxy", "Pyy"}};
    const System *system = &simulation->system;
    const double *d = simulation->run[0].x, k = system->k[0];
    double l2 = system->l2[0], H[3];
    SpringValues now = evaluate_spring(d, system);
    /* Nonzero eigenvalues of [[H, -H], [-H, H]], twice those of H. */
    double along = 2 * now.eigenvalue_along, across = 2 * now.eigenvalue_across;
    bool page = simulation->options.page;
    bool folds = simulation->options.projection == PROJECTION_ABS && !page;
    Projection projection = folds ? PROJECTION_ABS : PROJECTION_CLAMP;
    bool both = simulation->exhibit.switches;
    values_add_point(values, "d", d);
    values_add(values, "distance", now.length);
    values_add(values, "l", sqrt(l2));
    values_add(values, "l2", l2);
    values_add(values, "k", k);
    values_add(values, "strain", now.strain);
    values_add(values, "energy", now.energy);
    values_add_point(values, "force", now.force);
    values_add(values, "along", now.eigenvalue_along);
    values_add(values, "across", now.eigenvalue_across);
    values_add(values, "block along", along);
    values_add(values, "block across", across);
    values_add(values, "projected along",
               project_eigenvalue(projection, along));
    values_add(values, "projected across",
               project_eigenvalue(projection, across));
    for (int i = 0; i < 2; i++) { /* the Hessian before and after projection */
        spring_hessian(d, l2, k, i == 0 ? PROJECTION_NONE : projection, H);
        values_add_matrix(values, names[i], H, 1e-12 * k);
    }
    if (page)
        add_central_differences(simulation, values);
    values_add_flag(values, "root", both);
    values_add_flag(values, page ? "lecture" : "alone", true);
    values_add_flag(values, "pulled",
                    !(simulation->options.layers & LAYER_MODES));
    values_add_flag(values, "shortened", now.eigenvalue_across < 0);
    values_add(values, "root energy", both ? now.root_energy : NAN);
    values_add(values, "root along", both ? now.root_eigenvalue_along : NAN);
    values_add(values, "root across", now.root_eigenvalue_across);
}

typedef double SpringFunction(const void *system, double d);

/* Draws of_p over the length, and of_root if the switch is on; dots at d. */
static Plot draw_length_graphs(const Plot *card, double d, Axis y,
                               SpringFunction *of_p, SpringFunction *of_root)
{
    const System *system = &card->simulation->system;
    double reach = fmax(1.5, 1.1 * fabs(d)) * sqrt(system->l2[0]);
    Plot plot = plot_create(card, (Axis){-reach, reach, .label = "d in m"}, y);
    plot_graph(&plot, of_p, system, 2.4, COLOUR_X);
    if (card->simulation->exhibit.switches) {
        plot_graph(&plot, of_root, system, 1.8, COLOUR_GHOST);
        plot_disc(&plot, (double[2]){d, of_root(system, d)}, 5, COLOUR_GHOST);
    }
    plot_disc(&plot, (double[2]){d, of_p(system, d)}, 6, COLOUR_TEXT);
    return plot;
}

/* Draws the energies, and below them the forces.  A low card has only the
 * energies, a page only the forces, for which the page asks. */
void draw_spring_profile_card(const Plot *card)
{
    const System *system = &card->simulation->system;
    const double *x = card->simulation->run[0].x;
    double d = copysign(vector_length(x), x[0]); /* signed length, m */
    bool both = card->simulation->exhibit.switches;
    bool low = card->box.height < 14 * card->em;
    bool page = card->content->lecture.page;
    double tip = (both ? root_energy_at_length : energy_at_length)(system, 0);
    double most = fmax(600, fabs(force_at_length(system, d)));
    Plot upper = *card, lower = *card;
    if (!low)
        upper.box =
            box_cut_off(&lower.box, EDGE_TOP, (int)(0.55 * card->box.height));
    if (!low || page)
        draw_length_graphs(&lower, d,
                           (Axis){-most, most, .label = "force in N"},
                           force_at_length, root_force_at_length);
    if (low && page)
        return;
    const Axis y = {0, 1.12 * fmax(tip, energy_at_length(system, d)),
                    .label = NULL};
    Plot plot = draw_length_graphs(&upper, d, y, energy_at_length,
                                   root_energy_at_length);
    if (both) {
        plot_label(&plot, 1, (double[2]){0, root_energy_at_length(system, 0)},
                   COLOUR_GHOST, "P_{r} = 2k (|d| \u2212 l)\u00b2");
        plot_label(&plot, 1, (double[2]){0, energy_at_length(system, 0)},
                   COLOUR_X, "P");
    }
}
