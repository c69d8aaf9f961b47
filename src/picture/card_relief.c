/* card_relief.c - E over the position of the free node as a surface, with the
 * path of the iterates on it. */
#include <math.h>

#include "picture/cards.h"

enum {
    SURFACE_CELLS = 96, /* cells of the surface along one side */
    CURVE_PIECES = 24,  /* pieces of a line that follows the surface */
    MAX_CONTOURS = 15   /* most contour lines below the rim */
};

static const double REACH = 1.87; /* m, half the width of the surface */
static const double HEIGHT = 1.5; /* m, height at which the rim is drawn */
/* The surface ends at a contour, the rim.  E there is a sum: the inertia at
 * RIM_INERTIA metres from x_tilde, and RIM_PASS times h^2 P at (0, 0). */
static const double RIM_INERTIA = 1.5, RIM_PASS = 1.7;
/* Cosine and sine of the view's angles: TURN around the E axis, RISE above the
 * xy plane.  The x axis points to the near right, y to the far right. */
static const double TURN[2] = {0.85, 0.5268}, RISE[2] = {0.7, 0.7141};
static const Colour LEVEL_COLOUR = 0x90606060u;
static const double LIGHT[3] = {0.30, -0.45, 0.84}; /* unit vector to light */

/* The surface of E and its projection to pixels. */
typedef struct Surface {
    const Simulation *simulation;
    Plot plot;           /* maps the projected surface (m) to pixels */
    double rim_E;        /* J s^2, E of the rim */
    double contour_step; /* J s^2, distance between two contour lines */
} Surface;

/* A corner of the surface's triangles. */
typedef struct Corner {
    double x, y, E; /* position in m, energy in J s^2 */
    bool is_convex; /* the Hessian is positive definite */
} Corner;

static double compute_rim_energy(const Simulation *simulation)
{
    const double *target = simulation->exhibit.x_tilde;
    unsigned parts = simulation->exhibit.switches;
    double rim = 0;
    if (parts & PART_INERTIA)
        rim += landscape_sum_energy_parts(simulation, PART_INERTIA,
                                          target[0] + RIM_INERTIA, target[1]);
    if (parts & PART_ELASTICITY)
        rim += RIM_PASS *
               landscape_sum_energy_parts(simulation, PART_ELASTICITY, 0, 0);
    return rim;
}

static Corner evaluate_corner(const Surface *relief, double x, double y)
{
    TaylorModel E = descent_evaluate(relief->simulation, PROJECTION_NONE, x, y);
    return (Corner){x, y, E.energy, local_model_is_convex(&E)};
}

/* Returns the orthographic projection: m to the right and upwards. */
static Point project_corner(const Surface *relief, const Corner *corner)
{
    double near = TURN[0] * corner->x - TURN[1] * corner->y;
    double height = HEIGHT * corner->E / relief->rim_E;
    return (Point){{TURN[1] * corner->x + TURN[0] * corner->y,
                    RISE[0] * height - RISE[1] * near}};
}

/* Returns the point of an edge where E has this value. */
static Corner find_edge_crossing(const Corner *a, const Corner *b, double E)
{
    double t = (E - a->E) / (b->E - a->E);
    return (Corner){a->x + t * (b->x - a->x), a->y + t * (b->y - a->y), E,
                    a->is_convex};
}

/* Finds the contour of a value in a triangle; returns false without one. */
static bool find_contour_piece(const Corner corner[3], double E, Corner end[2])
{
    int ends = 0;
    for (int k = 0; k < 3 && ends < 2; k++) {
        const Corner *a = &corner[k], *b = &corner[(k + 1) % 3];
        if ((a->E < E) != (b->E < E))
            end[ends++] = find_edge_crossing(a, b, E);
    }
    return ends == 2;
}

/* Returns the colour: bright in the light, yellow where E is not convex. */
static Colour shade_surface_face(const Surface *relief, const Corner corner[3])
{
    const Corner *o = &corner[0], *a = &corner[1], *b = &corner[2];
    double scale = HEIGHT / relief->rim_E;
    double ax = a->x - o->x, ay = a->y - o->y, az = scale * (a->E - o->E);
    double bx = b->x - o->x, by = b->y - o->y, bz = scale * (b->E - o->E);
    const double n[3] = {ay * bz - az * by, az * bx - ax * bz,
                         ax * by - ay * bx};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    double light =
        (n[0] * LIGHT[0] + n[1] * LIGHT[1] + n[2] * LIGHT[2]) / length;
    double bent = (3 - o->is_convex - a->is_convex - b->is_convex) / 3.0;
    Colour bright = colour_mix(0xfff4f8fcu, 0xffffe9b0u, bent);
    Colour dark = colour_mix(0xff44576cu, 0xff80602au, bent);
    return colour_mix(dark, bright, fmin(fmax(1.1 * light, 0), 1));
}

/* Draws the part of a triangle below the rim, with its contour lines.  A face
 * seen from below is left out: the front wall would hide the valleys. */
static void draw_surface_face(const Surface *relief, const Corner corner[3])
{
    const Plot *plot = &relief->plot;
    Corner inside[4], end[2];
    Point at[4] = {0};
    int count = 0;
    for (int k = 0; k < 3; k++) {
        const Corner *a = &corner[k], *b = &corner[(k + 1) % 3];
        if (a->E <= relief->rim_E)
            inside[count++] = *a;
        if ((a->E <= relief->rim_E) != (b->E <= relief->rim_E))
            inside[count++] = find_edge_crossing(a, b, relief->rim_E);
    }
    for (int k = 0; k < count; k++)
        at[k] = project_corner(relief, &inside[k]);
    const Point a = vector_between(at[0].xy, at[1].xy),
                b = vector_between(at[0].xy, at[2].xy);
    bool above = count > 2 && a.xy[0] * b.xy[1] > a.xy[1] * b.xy[0];
    const double *const face[] = {at[0].xy, at[1].xy, at[2].xy,
                                  at[count > 3 ? 3 : 2].xy};
    if (above)
        plot_quad(plot, face, shade_surface_face(relief, corner));
    for (int k = 1;
         k < MAX_CONTOURS && k * relief->contour_step < relief->rim_E; k++)
        if (above && find_contour_piece(corner, k * relief->contour_step, end))
            plot_line(plot, project_corner(relief, &end[0]).xy,
                      project_corner(relief, &end[1]).xy, 0.8, LEVEL_COLOUR);
    if (find_contour_piece(corner, relief->rim_E, end))
        plot_line(plot, project_corner(relief, &end[0]).xy,
                  project_corner(relief, &end[1]).xy, 1.6, COLOUR_FAINT);
}

/* Draws cell by cell from the far end to the near end (painter's algorithm). */
static void draw_surface(const Surface *relief)
{
    Corner column[2][SURFACE_CELLS + 1];
    double side = 2 * REACH / SURFACE_CELLS;
    for (int i = 0; i <= SURFACE_CELLS; i++) {
        Corner *left = column[(i + 1) % 2], *right = column[i % 2];
        for (int j = 0; j <= SURFACE_CELLS; j++)
            right[j] =
                evaluate_corner(relief, -REACH + i * side, -REACH + j * side);
        for (int j = SURFACE_CELLS - 1; j >= 0 && i > 0; j--) {
            const Corner far[3] = {left[j], right[j + 1], left[j + 1]};
            const Corner near[3] = {left[j], right[j], right[j + 1]};
            draw_surface_face(relief, far);
            draw_surface_face(relief, near);
        }
    }
}

/* Draws the surface's curve above a line of the plane, up to the rim. */
static void draw_surface_line(const Surface *relief, const double *a,
                              const double *b, double width, Colour colour)
{
    Corner before = {.E = NAN};
    for (int i = 0; i <= CURVE_PIECES; i++) {
        const Point x =
            point_along(a, (double)i / CURVE_PIECES, vector_between(a, b).xy);
        Corner now = evaluate_corner(relief, x.xy[0], x.xy[1]);
        if (before.E <= relief->rim_E && now.E <= relief->rim_E)
            plot_line(&relief->plot, project_corner(relief, &before).xy,
                      project_corner(relief, &now).xy, width, colour);
        before = now;
    }
}

static void draw_surface_point(const Surface *relief, const double *x,
                               double radius, Colour colour, const char *word)
{
    Corner corner = evaluate_corner(relief, x[0], x[1]);
    const Point at = project_corner(relief, &corner);
    if (!(corner.E <= relief->rim_E))
        return;
    plot_disc(&relief->plot, at.xy, radius, colour);
    if (word)
        plot_label(&relief->plot, 1, at.xy, colour, "%s", word);
}

/* Draws the updates so far, and the next p as a thin line; red if uphill. */
static void draw_newton_path(const Surface *relief)
{
    const Descent *descent = &relief->simulation->descent;
    const double *x = descent->iterate;
    for (int i = 0; i < descent->record_count; i++) {
        const NewtonRecord *record = &descent->record[i];
        Colour colour = record->slope > 0 ? COLOUR_WARNING : COLOUR_P;
        draw_surface_line(relief, record->x_before, record->x_after, 3, colour);
        draw_surface_point(relief, record->x_before, 4.5, COLOUR_X, NULL);
    }
    if (!relief->plot.content->lecture.hides_answer)
        draw_surface_line(relief, x, point_along(x, 1, descent->direction).xy,
                          1.4, descent->slope > 0 ? COLOUR_WARNING : COLOUR_P);
    draw_surface_point(relief, x, 6, COLOUR_TEXT, NULL);
}

/* Draws the curve of the minimiser as h varies, and a dot for the present h. */
static void draw_dial_curve(const Surface *relief)
{
    const MinimiserCurve *dial = &relief->simulation->exhibit.dial;
    int points = relief->plot.content->lecture.hides_answer ? 0 : DIAL_POINTS;
    for (int i = 1; i < points; i++)
        draw_surface_line(relief, dial->minimiser[i - 1], dial->minimiser[i], 3,
                          COLOUR_X);
    draw_surface_point(relief, relief->simulation->run[0].x, 7, COLOUR_TEXT,
                       NULL);
}

/* Draws arrows along x, y and E, and writes the distance of the contours. */
static void draw_relief_axes(const Surface *relief)
{
    static const char *const names[] = {"x", "y", "J s\u00b2"};
    const Plot *plot = &relief->plot;
    const Box *box = &plot->box;
    const double size = 2.6 * plot->em / plot->camera.scale[0]; /* m */
    const Corner tip[] = {{.x = size},
                          {.y = size},
                          {.E = size * relief->rim_E / (HEIGHT * RISE[0])}};
    double corner[2];
    camera_to_world(&plot->camera, box->x + plot->em,
                    box->y + box->height - 2.8 * plot->em, corner);
    for (int k = 0; k < 3; k++) {
        const Point d = project_corner(relief, &tip[k]),
                    end = point_along(corner, 1, d.xy);
        plot_arrow(plot, corner, d.xy, 1, 1.2, COLOUR_FAINT);
        plot_label(plot, 1, end.xy, COLOUR_FAINT, "%s", names[k]);
    }
    paper_write(plot->paper, FACE_REGULAR, 0.9, COLOUR_FAINT,
                box->x + box->width, box->y + box->height - 1.4 * plot->em,
                ALIGN_RIGHT, "lines every %s J s\u00b2",
                format_number(relief->contour_step).text);
}

void draw_relief_card(const Plot *card)
{
    static const double bounds[4] = {-1.62, -0.75, 1.88, 2.2}; /* m */
    Surface relief = {card->simulation, *card,
                      compute_rim_energy(card->simulation), 0};
    relief.contour_step = plot_nice_number(relief.rim_E / MAX_CONTOURS);
    relief.plot.camera = camera_create(card->box, bounds, false, &LENS_FITS);
    draw_surface(&relief);
    draw_relief_axes(&relief);
    if (card->simulation->scene->picture == PICTURE_DIAL)
        draw_dial_curve(&relief);
    else
        draw_newton_path(&relief);
    draw_surface_point(&relief, card->simulation->exhibit.x_tilde, 5,
                       COLOUR_X_TILDE, "{xt}");
}
