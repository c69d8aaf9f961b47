/* E over the position of the free node as a surface, from bowl to two valleys
 * as h grows, with the path of the iterates on it. */
#include <math.h>

#include "picture/cards.h"
#include "picture/colour_map.h"

enum {
    CELLS = 96,  /* of the ground, along one side */
    PIECES = 24, /* of a straight way of the map */
    LEVELS = 15  /* lines up to the rim, at most */
};

static const double REACH = 1.87; /* m, half the side of the ground */
static const double HEIGHT = 1.5; /* m, the rim is drawn above E = 0 */
/* The rim is the sum of inertia at this distance from x_tilde, m, and of
 * elasticity between the pins, the pass of the two valleys, times a factor. */
static const double RIM_INERTIA = 1.5, RIM_PASS = 1.7;
/* The view: x comes nearer to the right, y goes away to the right.  Cosine and
 * sine of the angle around E, and of the one above the ground. */
static const double TURN[2] = {0.85, 0.5268}, RISE[2] = {0.7, 0.7141};
static const Colour LEVEL_COLOUR = 0x90606060u;
static const double LIGHT[3] = {0.30, -0.45, 0.84}; /* a unit vector */

/* The surface, cut off at its rim. */
typedef struct Relief {
    const Simulation *simulation;
    Plot plot;         /* its plane is that of the projection, m */
    double rim, level; /* J s^2; from one level line to the next */
} Relief;

/* A point of the surface. */
typedef struct Corner {
    double x, y, E; /* m, m, J s^2 */
    bool convex;
} Corner;

static double rim_of(const Simulation *simulation)
{
    const double *target = simulation->exhibit.target;
    unsigned parts = simulation->exhibit.parts;
    double rim = 0;
    if (parts & PART_INERTIA)
        rim += landscape_part_value(simulation, PART_INERTIA,
                                    target[0] + RIM_INERTIA, target[1]);
    if (parts & PART_ELASTICITY)
        rim +=
            RIM_PASS * landscape_part_value(simulation, PART_ELASTICITY, 0, 0);
    return rim;
}

static Corner corner_at(const Relief *relief, double x, double y)
{
    Local E = descent_at(relief->simulation, PROJECTION_NONE, x, y);
    return (Corner){x, y, E.value, landscape_is_convex(&E)};
}

/* The orthographic projection, m to the right and upwards. */
static Point seen(const Relief *relief, const Corner *corner)
{
    double near = TURN[0] * corner->x - TURN[1] * corner->y;
    double height = HEIGHT * corner->E / relief->rim;
    return (Point){{TURN[1] * corner->x + TURN[0] * corner->y,
                    RISE[0] * height - RISE[1] * near}};
}

/* The point of an edge where E has this value, which lies between its ends. */
static Corner cross(const Corner *a, const Corner *b, double E)
{
    double t = (E - a->E) / (b->E - a->E);
    return (Corner){a->x + t * (b->x - a->x), a->y + t * (b->y - a->y), E,
                    a->convex};
}

/* The line on which a triangle has this value; false: there is none. */
static bool level_in(const Corner corner[3], double E, Corner end[2])
{
    int ends = 0;
    for (int k = 0; k < 3 && ends < 2; k++) {
        const Corner *a = &corner[k], *b = &corner[(k + 1) % 3];
        if ((a->E < E) != (b->E < E))
            end[ends++] = cross(a, b, E);
    }
    return ends == 2;
}

/* The colour of a plane triangle: light by its slope, yellow as on the map
 * where E is not convex. */
static Colour face_colour(const Relief *relief, const Corner corner[3])
{
    const Corner *o = &corner[0], *a = &corner[1], *b = &corner[2];
    double scale = HEIGHT / relief->rim;
    double ax = a->x - o->x, ay = a->y - o->y, az = scale * (a->E - o->E);
    double bx = b->x - o->x, by = b->y - o->y, bz = scale * (b->E - o->E);
    const double n[3] = {ay * bz - az * by, az * bx - ax * bz,
                         ax * by - ay * bx};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    double light =
        (n[0] * LIGHT[0] + n[1] * LIGHT[1] + n[2] * LIGHT[2]) / length;
    double bent = (3 - o->convex - a->convex - b->convex) / 3.0;
    Colour bright = canvas_mix(0xfff4f8fcu, 0xffffe9b0u, bent);
    Colour dark = canvas_mix(0xff44576cu, 0xff80602au, bent);
    return canvas_mix(dark, bright, fmin(fmax(1.1 * light, 0), 1));
}

/* Draws a triangle, as far as it is below the rim, with its level lines.  A
 * triangle that is seen from below is left out: it is part of the wall in
 * front, which would hide the valleys. */
static void draw_face(const Relief *relief, const Corner corner[3])
{
    const Plot *plot = &relief->plot;
    Corner inside[4], end[2];
    Point at[4] = {0};
    int count = 0;
    for (int k = 0; k < 3; k++) {
        const Corner *a = &corner[k], *b = &corner[(k + 1) % 3];
        if (a->E <= relief->rim)
            inside[count++] = *a;
        if ((a->E <= relief->rim) != (b->E <= relief->rim))
            inside[count++] = cross(a, b, relief->rim);
    }
    for (int k = 0; k < count; k++)
        at[k] = seen(relief, &inside[k]);
    const Point a = way(at[0].at, at[1].at), b = way(at[0].at, at[2].at);
    bool above = count > 2 && a.at[0] * b.at[1] > a.at[1] * b.at[0];
    const double *const face[] = {at[0].at, at[1].at, at[2].at,
                                  at[count > 3 ? 3 : 2].at};
    if (above)
        plot_face(plot, face, face_colour(relief, corner));
    for (int k = 1; k < LEVELS && k * relief->level < relief->rim; k++)
        if (above && level_in(corner, k * relief->level, end))
            plot_line(plot, seen(relief, &end[0]).at, seen(relief, &end[1]).at,
                      0.8, LEVEL_COLOUR);
    if (level_in(corner, relief->rim, end))
        plot_line(plot, seen(relief, &end[0]).at, seen(relief, &end[1]).at, 1.6,
                  COLOUR_FAINT);
}

/* Painter's order: from the far end of the ground to the near one. */
static void draw_surface(const Relief *relief)
{
    Corner column[2][CELLS + 1];
    double side = 2 * REACH / CELLS;
    for (int i = 0; i <= CELLS; i++) {
        Corner *left = column[(i + 1) % 2], *right = column[i % 2];
        for (int j = 0; j <= CELLS; j++)
            right[j] = corner_at(relief, -REACH + i * side, -REACH + j * side);
        for (int j = CELLS - 1; j >= 0 && i > 0; j--) {
            const Corner far[3] = {left[j], right[j + 1], left[j + 1]};
            const Corner near[3] = {left[j], right[j], right[j + 1]};
            draw_face(relief, far);
            draw_face(relief, near);
        }
    }
}

/* A straight way of the map, as far as it is below the rim. */
static void draw_way(const Relief *relief, const double *a, const double *b,
                     double width, Colour colour)
{
    Corner before = {.E = NAN};
    for (int i = 0; i <= PIECES; i++) {
        const Point x = along(a, (double)i / PIECES, way(a, b).at);
        Corner now = corner_at(relief, x.at[0], x.at[1]);
        if (before.E <= relief->rim && now.E <= relief->rim)
            plot_line(&relief->plot, seen(relief, &before).at,
                      seen(relief, &now).at, width, colour);
        before = now;
    }
}

static void draw_point(const Relief *relief, const double *x, double radius,
                       Colour colour, const char *word)
{
    Corner corner = corner_at(relief, x[0], x[1]);
    const Point at = seen(relief, &corner);
    if (!(corner.E <= relief->rim))
        return;
    plot_disc(&relief->plot, at.at, radius, colour);
    if (word)
        plot_words(&relief->plot, 1, at.at, colour, "%s", word);
}

/* The updates so far and, thin, the direction that is next; uphill in red. */
static void draw_updates(const Relief *relief)
{
    const Descent *descent = &relief->simulation->descent;
    const double *x = descent->point;
    for (int i = 0; i < descent->count; i++) {
        const NewtonRecord *record = &descent->record[i];
        Colour colour = record->slope > 0 ? COLOUR_WARNING : COLOUR_P;
        draw_way(relief, record->from, record->to, 3, colour);
        draw_point(relief, record->from, 4.5, COLOUR_X, NULL);
    }
    if (!relief->plot.show->veiled)
        draw_way(relief, x, along(x, 1, descent->direction).at, 1.4,
                 descent->slope > 0 ? COLOUR_WARNING : COLOUR_P);
    draw_point(relief, x, 6, COLOUR_TEXT, NULL);
}

/* The minimisers for all h, and that of this one. */
static void draw_walk(const Relief *relief)
{
    const DialCurve *dial = &relief->simulation->exhibit.dial;
    int points = relief->plot.show->veiled ? 0 : DIAL_POINTS;
    for (int i = 1; i < points; i++)
        draw_way(relief, dial->point[i - 1], dial->point[i], 3, COLOUR_X);
    draw_point(relief, relief->simulation->run[0].x, 7, COLOUR_TEXT, NULL);
}

/* In the lower corners: where x, y and E grow, and the step of the levels. */
static void draw_axes(const Relief *relief)
{
    static const char *const names[] = {"x", "y", "E"};
    const Plot *plot = &relief->plot;
    const Box *box = &plot->box;
    const double size = 2.6 * plot->em / plot->camera.scale[0]; /* m */
    const Corner tip[] = {{.x = size},
                          {.y = size},
                          {.E = size * relief->rim / (HEIGHT * RISE[0])}};
    double corner[2];
    camera_world(&plot->camera, box->x + plot->em,
                 box->y + box->height - 2.8 * plot->em, corner);
    for (int k = 0; k < 3; k++) {
        const Point d = seen(relief, &tip[k]), end = along(corner, 1, d.at);
        plot_arrow(plot, corner, d.at, 1, 1.2, COLOUR_FAINT);
        plot_words(plot, 1, end.at, COLOUR_FAINT, "%s", names[k]);
    }
    paper_write(plot->paper, FACE_REGULAR, 0.9, COLOUR_FAINT,
                box->x + box->width, box->y + box->height - 1.4 * plot->em,
                ALIGN_RIGHT, "lines every %s J s\u00b2",
                number_of(relief->level).text);
}

void relief_draw(const Plot *card)
{
    static const double bounds[4] = {-1.95, -0.75, 2.05, 2.2}; /* m */
    Relief relief = {card->simulation, *card, rim_of(card->simulation), 0};
    relief.level = plot_round_up(relief.rim / LEVELS);
    relief.plot.camera = camera_create(card->box, bounds, false, &LENS_FITS);
    draw_surface(&relief);
    draw_axes(&relief);
    if (card->simulation->scene->picture == PICTURE_DIAL)
        draw_walk(&relief);
    else
        draw_updates(&relief);
    draw_point(&relief, card->simulation->exhibit.target, 5, COLOUR_X_TILDE,
               "{xt}");
}
