/* envelope_picture.c - map of convergence by time step and spring stiffness. */
#include <math.h>

#include "picture/cards.h"

/* Shade 0: up to 4 updates; each next, darker shade: up to twice as many. */
enum { ENVELOPE_DARKEST_SHADE = 4 };

static Colour colour_of_shade(int shade)
{
    return colour_mix(0xffe3f2e8u, 0xff064a38u,
                      (double)shade / ENVELOPE_DARKEST_SHADE);
}

#define COLOUR_REFUSED 0xffe08a1eu

static Colour colour_of_cell(const ConvergenceCell *cell)
{
    int shade = 0;
    if (!cell->is_known)
        return COLOUR_CHIP;
    if (cell->run_status)
        return COLOUR_REFUSED;
    while (shade < ENVELOPE_DARKEST_SHADE && cell->updates > 4 << shade)
        shade++;
    return colour_of_shade(shade);
}

/* Returns the box of a cell, with a gap of a pixel to the next cells. */
static Box find_cell_box(const Plot *stage, int column, int row)
{
    double x = log10(envelope_get_timestep(column));
    double y = log10(envelope_get_stiffness(row));
    const double low[2] = {x - 0.25, y - 0.5}, high[2] = {x + 0.25, y + 0.5};
    double p[2], q[2];
    plot_to_pixel(stage, low, p);
    plot_to_pixel(stage, high, q);
    int left = pixel_from_coordinate(ceil(p[0])),
        top = pixel_from_coordinate(ceil(q[1]));
    return (Box){left, top, pixel_from_coordinate(ceil(q[0])) - left - 1,
                 pixel_from_coordinate(ceil(p[1])) - top - 1};
}

/* Draws the line on which h^2 k / m is `ratio`, m being the mass of a node. */
static void draw_ratio_line(const Plot *plot, double ratio)
{
    double m = plot->simulation->system.m[0];
    const double k[2] = {1e-6, 1e15};
    double ends[2][2];
    for (int i = 0; i < 2; i++) {
        ends[i][0] = fmin(fmax(sqrt(ratio * m / k[i]), 1e-9), 1e3);
        ends[i][1] = ratio * m / (ends[i][0] * ends[i][0]);
    }
    plot_dashes(plot, ends[0], ends[1], 1.4, NULL, COLOUR_TEXT);
    plot_label(plot, 1, ends[1], COLOUR_TEXT, "%s", format_number(ratio).text);
}

/* Draws axes, cells, a border around the selected cell, and the ratio lines. */
void draw_envelope_picture(Plot *stage)
{
    const ConvergenceMap *map = &stage->simulation->exhibit.envelope;
    Plot plot = plot_create_on_stage(
        stage, (Axis){.scale = SCALE_LOG, .label = "h in s"},
        (Axis){.scale = SCALE_LOG, .label = "k in J/m\u00b2"});
    for (int row = 0; row < ENVELOPE_ROWS; row++)
        for (int column = 0; column < ENVELOPE_COLUMNS; column++)
            canvas_fill(&stage->paper->canvas,
                        find_cell_box(stage, column, row),
                        colour_of_cell(&map->cell[row][column]));
    canvas_framed_box(
        &stage->paper->canvas,
        box_inset(find_cell_box(stage, map->shown_column, map->shown_row), -1),
        colour_of_cell(&map->cell[map->shown_row][map->shown_column]),
        COLOUR_TEXT);
    for (int power = -8; power <= 16; power += 8)
        draw_ratio_line(&plot, pow(10, power));
}

void envelope_pick(const Plot *stage, double x, double y, Pick *pick)
{
    double column = round(2 * (pick->point[0] + 9));
    double row = round(pick->point[1] + 6);
    if (column >= 0 && column < ENVELOPE_COLUMNS && row >= 0 &&
        row < ENVELOPE_ROWS) {
        pick->kind = PICK_CELL;
        pick->index = (int)row * ENVELOPE_COLUMNS + (int)column;
    }
}

/* ---- cards -------------------------------------------------------------- */

void list_envelope_values(const Simulation *simulation, LiveValues *values)
{
    const ConvergenceMap *map = &simulation->exhibit.envelope;
    const ConvergenceCell *cell = &map->cell[map->shown_row][map->shown_column];
    int known = 0, converged = 0;
    for (int i = 0; i < ENVELOPE_ROWS * ENVELOPE_COLUMNS; i++) {
        const ConvergenceCell *one =
            &map->cell[i / ENVELOPE_COLUMNS][i % ENVELOPE_COLUMNS];
        known += one->is_known;
        converged += one->is_known && !one->run_status;
    }
    values->text_line_colour[0] = colour_of_shade(3);
    values->text_line_colour[1] = colour_of_shade(2);
    values->text_line_colour[2] = COLOUR_REFUSED;
    bool all = known == ENVELOPE_ROWS * ENVELOPE_COLUMNS;
    values_add_flag(values, "all converged", all && converged == known);
    values_add_flag(values, "refused", all && converged < known);
    values_add(values, "known", known > 1 ? known : NAN);
    values_add(values, "converged", converged);
    values_add(values, "h", envelope_get_timestep(map->shown_column));
    values_add(values, "k", envelope_get_stiffness(map->shown_row));
    values_add(values, "steps", ENVELOPE_STEPS);
    values_add(values, "updates", cell->updates);
    values_add_flag(values, "refused cell", cell->run_status);
    values_add_flag(values, "converged cell", !cell->run_status);
}
