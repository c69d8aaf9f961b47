#include "picture/square_picture.h"

#include <math.h>
#include <stdio.h>

#include "picture/colour_map.h"
#include "picture/panels.h"
#include "picture/plot.h"

/* Sizes in units. */
enum { LEGEND_WIDTH = 208, LEGEND_BAR = 8, LEGEND_MARGIN = 3 };

/* What does not change from spring to spring. */
typedef struct SpringPen {
    Paper *paper;
    Mapping mapping;
    const double *x; /* [2n] m */
    double width;    /* units */
    double range;    /* of the strains; 0: all blue */
} SpringPen;

/* Side lengths that the square may fill: a stretched one springs back, and a
 * squeezed one springs out and bulges. */
static double square_extent(double stretch)
{
    double s = fabs(stretch);
    return s < 1 ? 1 + 1.5 * (1 - s) : s;
}

/* These side lengths are 57 % of the paper. */
static SpringPen square_pen(Paper *paper, const Simulation *simulation,
                            double range)
{
    const SquareMesh *mesh = &simulation->mesh;
    double size = square_extent(simulation->options.stretch) * mesh->side;
    SpringPen pen = {paper, paper_mapping(paper, size, 0.57),
                     simulation->run[0].x, 0, range};
    double spacing = pen.mapping.scale * mesh->side / mesh->segments;
    pen.width = fmin(fmax(0.12 * spacing / paper->unit, 0.65), 1);
    pen.width = fmax(pen.width, 1 / paper->unit) * (range > 0 ? 1.4 : 1);
    return pen;
}

/* The line from node i to node j, l their distance at rest. */
static void draw_spring(const SpringPen *pen, int i, int j, double l)
{
    const double *a = pen->x + 2 * (size_t)i, *b = pen->x + 2 * (size_t)j;
    Colour colour = COLOUR_SPRING;
    if (pen->range > 0) {
        double strain = hypot(a[0] - b[0], a[1] - b[1]) / l - 1;
        colour = colour_map_strain(strain, pen->range);
    }
    paper_line(pen->paper, &pen->mapping, a, b, pen->width, colour);
}

/* Every spring of the system. */
static void draw_all_springs(const SpringPen *pen, const System *system)
{
    for (int s = 0; s < system->springs; s++)
        draw_spring(pen, system->e[2 * (size_t)s], system->e[2 * (size_t)s + 1],
                    sqrt(system->l2[s]));
}

/* The springs of a mesh of every stride-th node, the last one included. */
static long draw_coarse_springs(const SpringPen *pen, const SquareMesh *mesh,
                                int stride)
{
    int n = mesh->segments, row = n + 1;
    double l = mesh->side / n;
    long drawn = 0;
    for (int i = 0; i <= n; i += stride)
        for (int j = 0; j <= n; j += stride) {
            int di = i + stride <= n ? stride : n - i;
            int dj = j + stride <= n ? stride : n - j;
            int node = i * row + j, right = node + di * row;
            if (di > 0)
                draw_spring(pen, node, right, l * di);
            if (dj > 0)
                draw_spring(pen, node, node + dj, l * dj);
            if (di > 0 && dj > 0) {
                draw_spring(pen, node, right + dj, l * hypot(di, dj));
                draw_spring(pen, node + dj, right, l * hypot(di, dj));
            }
            drawn += (di > 0) + (dj > 0) + 2 * (di > 0 && dj > 0);
        }
    return drawn;
}

/* Discs at all nodes; those that the springs hide are left out. */
static void draw_nodes(const SpringPen *pen, const SquareMesh *mesh)
{
    double radius = 0.1 * mesh->side / mesh->segments * pen->mapping.scale /
                    pen->paper->unit;
    if (radius < 0.5 * pen->width)
        return;
    Colour colour = pen->range > 0 ? COLOUR_TEXT : COLOUR_SPRING;
    for (int i = 0; i < mesh->nodes; i++)
        paper_disc(pen->paper, &pen->mapping, pen->x + 2 * (size_t)i, radius,
                   colour);
}

/* Springs first, nodes on top of them. */
SpringCount square_picture_draw(Paper *paper, const Simulation *simulation,
                                double strain_range)
{
    const SquareMesh *mesh = &simulation->mesh;
    const System *system = &simulation->system;
    SpringPen pen = square_pen(paper, simulation, strain_range);
    double spacing = pen.mapping.scale * mesh->side / mesh->segments;
    int stride = (int)fmin(ceil(2 / spacing), mesh->segments);
    SpringCount count = {system->springs, 0};
    if (stride <= 1)
        draw_all_springs(&pen, system);
    else
        count.drawn = draw_coarse_springs(&pen, mesh, stride);
    count.skipped = system->springs - count.drawn;
    draw_nodes(&pen, mesh);
    return count;
}

/* Iterations, residual, methods, direction. */
static void add_newton_lines(TextBlock *block, const Simulation *simulation,
                             const Hud *hud)
{
    const Newton *newton = simulation->run[0].newton;
    bool uphill = hud->slope > 0, any = hud->iterations > 0;
    if (!hud->stepped) {
        panels_add_methods(block, simulation, -1, 0);
        return;
    }
    text_block_add(block, COLOUR_TEXT, "Newton      %d iteration%s",
                   hud->iterations, hud->iterations == 1 ? "" : "s");
    text_block_add(block, COLOUR_TEXT, "residual    %.2e m/s",
                   newton->residual);
    panels_add_methods(block, simulation, any ? hud->projected : -1,
                       hud->trials);
    if (any)
        text_block_add(block, uphill ? COLOUR_WARNING : COLOUR_TEXT,
                       "direction   %s, alpha %.3g",
                       uphill ? "UPHILL" : "downhill", hud->alpha);
}

/* Nothing to tell about explicit methods but that they are. */
static void draw_newton(Paper *paper, const Simulation *simulation,
                        const Hud *hud)
{
    TextBlock block = {0};
    if (simulation->run[0].newton) {
        add_newton_lines(&block, simulation, hud);
    } else {
        text_block_add(&block, COLOUR_TEXT, "explicit: no Newton, no matrix");
    }
    panels_draw_right(paper, &block);
}

/* The unit in which an energy up to `high` has few digits. */
typedef struct EnergyUnit {
    double joule;
    const char *name;
} EnergyUnit;

/* J, or a thousand, a million, ... times more or less. */
static EnergyUnit energy_unit(double high)
{
    static const EnergyUnit units[] = {
        {1e12, "TJ"}, {1e9, "GJ"},  {1e6, "MJ"},  {1e3, "kJ"},
        {1, "J"},     {1e-3, "mJ"}, {1e-6, "uJ"},
    };
    if (high >= 1e16 || high < 1e-6)
        return (EnergyUnit){1, "J"};
    size_t i = 0;
    while (high < units[i].joule)
        i++;
    return units[i];
}

/* Three curves; the axes grow by round numbers. */
static void draw_energy_plot(Paper *paper, const Simulation *simulation,
                             const History *history, EnergyUnit unit)
{
    Box outer = panels_plot_box(paper);
    char label[TEXT_BLOCK_SIZE];
    snprintf(label, sizeof label, "energy in %s", unit.name);
    double last = simulation_time(simulation);
    double least = 100 * simulation->options.timestep;
    Axis time = {0, plot_round_up(fmax(last, least)), "time in s"};
    double high = history->high > 0 ? fmin(history->high, 1e300) : 1;
    Axis energy = {0, plot_round_axis(high / unit.joule), label};
    Plot plot = plot_create(paper, outer, time, energy);
    plot.y.high *= unit.joule;
    const Colour colour[] = {COLOUR_TOTAL, COLOUR_KINETIC,
                                           COLOUR_ELASTIC};
    for (int s = 0; s < history->series; s++)
        plot_curve(paper, &plot, history->count, history->time,
                   history->value[s], colour[s]);
}

/* One line of the legend; next to nothing is 0. */
static void add_energy(TextBlock *block, Colour colour, const char *name,
                       double energy, double high)
{
    text_block_add(block, colour, "%s %10.6g J", name,
                   fabs(energy) < 1e-15 * high ? 0 : energy);
}

/* The plot, and its legend with the numbers. */
static void draw_energies(Paper *paper, const Simulation *simulation,
                          const Hud *hud)
{
    const Energies *energies = &hud->energies;
    double high = hud->history.high;
    TextBlock block = {0};
    draw_energy_plot(paper, simulation, &hud->history, energy_unit(high));
    add_energy(&block, COLOUR_TOTAL, "total  ", energies->total, high);
    add_energy(&block, COLOUR_KINETIC, "kinetic", energies->kinetic, high);
    add_energy(&block, COLOUR_ELASTIC, "elastic", energies->elastic, high);
    panels_draw_legend(paper, &block);
}

/* The bar from compressed to stretched. */
static void draw_strain_bar(Paper *paper, Box bar)
{
    for (int i = 0; i < bar.width; i++) {
        double strain = 2 * (i + 0.5) / bar.width - 1;
        canvas_rectangle(&paper->canvas, bar.x + i, bar.y, 1, bar.height,
                         colour_map_strain(strain, 1));
    }
}

/* Words above the bar, numbers below, on a panel in the lower right. */
static void draw_strain_legend(Paper *paper, double range)
{
    int margin = paper_pixels(paper, LEGEND_MARGIN);
    int letter = paper->font.height,
        bar_height = paper_pixels(paper, LEGEND_BAR);
    Box plot = panels_plot_box(paper);
    Box panel = {0, 0, paper_pixels(paper, LEGEND_WIDTH),
                 2 * letter + bar_height + 4 * margin};
    panel.x = paper->canvas.width - plot.x - panel.width;
    panel.y = plot.y + plot.height - panel.height;
    Box bar = {panel.x + margin, panel.y + letter + 2 * margin,
               panel.width - 2 * margin, bar_height};
    int middle = bar.x + bar.width / 2, right = bar.x + bar.width;
    int above = panel.y + margin, below = bar.y + bar.height + margin;
    char low[TEXT_BLOCK_SIZE], high[TEXT_BLOCK_SIZE];
    snprintf(low, sizeof low, "-%.3g %%", 100 * fmin(range, 1));
    snprintf(high, sizeof high, "+%.3g %%", 100 * range);
    paper_panel(paper, panel);
    draw_strain_bar(paper, bar);
    paper_text(paper, bar.x, above, ALIGN_LEFT, COLOUR_TEXT, "compressed");
    paper_text(paper, middle, above, ALIGN_CENTRE, COLOUR_TEXT, "at rest");
    paper_text(paper, right, above, ALIGN_RIGHT, COLOUR_TEXT, "stretched");
    paper_text(paper, bar.x, below, ALIGN_LEFT, COLOUR_TEXT, low);
    paper_text(paper, middle, below, ALIGN_CENTRE, COLOUR_TEXT, "strain 0");
    paper_text(paper, right, below, ALIGN_RIGHT, COLOUR_TEXT, high);
}

/* Corner by corner. */
void square_picture_panels(Paper *paper, const Simulation *simulation,
                           const Hud *hud, double strain_range)
{
    draw_newton(paper, simulation, hud);
    draw_energies(paper, simulation, hud);
    if (strain_range > 0)
        draw_strain_legend(paper, strain_range);
}

/* Half of |stretch - 1|, rounded up: smaller strains should show too. */
double square_picture_strain_range(const Simulation *simulation)
{
    double strain = fabs(fabs(simulation->options.stretch) - 1);
    return plot_round_up(fmax(0.5 * strain, 0.05));
}
