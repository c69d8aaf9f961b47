/* envelope_picture.c - the map of time steps and stiffnesses for which the
 * square converges.
 */
#include <math.h>

#include "picture/cards.h"
#include "picture/colour_map.h"

/* From few updates (light) to many (dark), by powers of two. */
enum { ENVELOPE_SHADES = 6 };

static Colour envelope_shade(int shade)
{
    return canvas_mix(0xffe3f2e8u, 0xff064a38u,
                      (double)shade / ENVELOPE_SHADES);
}

#define COLOUR_REFUSED 0xffe08a1eu

static Colour envelope_colour(const EnvelopeCell *cell)
{
    int shade = 0;
    if (!cell->known)
        return COLOUR_CHIP;
    if (cell->worst)
        return COLOUR_REFUSED;
    while (shade < ENVELOPE_SHADES && cell->updates > 4 << shade)
        shade++;
    return envelope_shade(shade);
}

/* Pixels of a cell, but for a line to its neighbours. */
static Box envelope_box(const Plot *stage, int column, int row)
{
    double x = log10(envelope_timestep(column));
    double y = log10(envelope_stiffness(row));
    const double low[2] = {x - 0.25, y - 0.5}, high[2] = {x + 0.25, y + 0.5};
    double p[2], q[2];
    plot_place(stage, low, p);
    plot_place(stage, high, q);
    int left = pixel_at(ceil(p[0])), top = pixel_at(ceil(q[1]));
    return (Box){left, top, pixel_at(ceil(q[0])) - left - 1,
                 pixel_at(ceil(p[1])) - top - 1};
}

/* Where elasticity is so many times as stiff as inertia: h^2 k = ratio m. */
static void draw_ratio(const Plot *plot, double ratio)
{
    double m = plot->simulation->system.m[0];
    const double k[2] = {1e-6, 1e15};
    double ends[2][2];
    for (int i = 0; i < 2; i++) {
        ends[i][0] = fmin(fmax(sqrt(ratio * m / k[i]), 1e-9), 1e3);
        ends[i][1] = ratio * m / (ends[i][0] * ends[i][0]);
    }
    plot_dashes(plot, ends[0], ends[1], 1.4, NULL, COLOUR_TEXT);
    plot_words(plot, 1, ends[1], COLOUR_TEXT, "%s", number_of(ratio).text);
}

/* The cells lie on the axes' lines; the chosen one has a dark border. */
void envelope_draw(Plot *stage)
{
    const EnvelopeMap *map = &stage->simulation->exhibit.map;
    Plot plot = plot_on(stage, (Axis){.log = true, .label = "h in s"},
                        (Axis){.log = true, .label = "k in J/m\u00b2"});
    for (int row = 0; row < ENVELOPE_ROWS; row++)
        for (int column = 0; column < ENVELOPE_COLUMNS; column++)
            canvas_fill(&stage->paper->canvas, envelope_box(stage, column, row),
                        envelope_colour(&map->cell[row][column]));
    canvas_card(&stage->paper->canvas,
                box_inset(envelope_box(stage, map->column, map->row), -1),
                envelope_colour(&map->cell[map->row][map->column]),
                COLOUR_TEXT);
    for (int power = -8; power <= 16; power += 8)
        draw_ratio(&plot, pow(10, power));
}

void envelope_pick(const Plot *stage, double x, double y, Pick *pick)
{
    double column = round(2 * (pick->point[0] + 9));
    double row = round(pick->point[1] + 6);
    (void)stage, (void)x, (void)y; /* the point says it */
    if (column >= 0 && column < ENVELOPE_COLUMNS && row >= 0 &&
        row < ENVELOPE_ROWS) {
        pick->kind = PICK_CELL;
        pick->index = (int)row * ENVELOPE_COLUMNS + (int)column;
    }
}

/* ---- cards -------------------------------------------------------------- */

void envelope_facts(const Simulation *simulation, Facts *facts)
{
    const EnvelopeMap *map = &simulation->exhibit.map;
    const EnvelopeCell *cell = &map->cell[map->row][map->column];
    double h = envelope_timestep(map->column), m = simulation->system.m[0];
    int known = 0, converged = 0;
    bool rounded = true; /* those that do not converge are far too stiff */
    for (int i = 0; i < ENVELOPE_ROWS * ENVELOPE_COLUMNS; i++) {
        int row = i / ENVELOPE_COLUMNS, column = i % ENVELOPE_COLUMNS;
        const EnvelopeCell *one = &map->cell[row][column];
        double step = envelope_timestep(column);
        double ratio = step * step * envelope_stiffness(row) / m;
        known += one->known;
        converged += one->known && !one->worst;
        rounded = rounded && (!one->worst || ratio > 1e16);
    }
    facts->colour[0] = envelope_shade(4);
    facts->colour[1] = envelope_shade(3);
    facts->colour[2] = COLOUR_REFUSED;
    bool all = known == ENVELOPE_ROWS * ENVELOPE_COLUMNS;
    fact_when(facts, all ? "all runs" : "some runs", true);
    fact_when(facts, "all converged", all && converged == known);
    fact_when(facts, rounded ? "rounded" : "refused", all && converged < known);
    fact(facts, "known", known > 1 ? known : NAN);
    fact(facts, "converged", converged);
    fact(facts, "h", h);
    fact(facts, "k", envelope_stiffness(map->row));
    fact(facts, "steps", ENVELOPE_STEPS);
    fact(facts, "updates", cell->updates);
    fact_when(facts, "refused cell", cell->worst);
    fact_when(facts, "converged cell", !cell->worst);
}
