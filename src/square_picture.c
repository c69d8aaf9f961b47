#include "square_picture.h"

#include <math.h>

#include "colour_map.h"
#include "plot.h"

/* What does not change from spring to spring. */
typedef struct SpringPen {
    Paper *paper;
    Mapping mapping;
    const double *x; /* [2n] m */
    double width;    /* pixels */
    double range;    /* of the strains; 0: all blue */
} SpringPen;

/* max(1, |stretch|) side is 57 % of the paper. */
static SpringPen square_pen(Paper *paper, const Simulation *simulation,
                            double range)
{
    const SquareMesh *mesh = &simulation->mesh;
    double size = fmax(1, fabs(simulation->options.stretch)) * mesh->side;
    SpringPen pen = {paper, paper_mapping(paper, size, 0.57),
                     simulation->run[0].x, 0, range};
    double spacing = pen.mapping.scale * mesh->side / mesh->segments;
    double width = fmin(fmax(0.12 * spacing, 0.65 * paper->unit), paper->unit);
    pen.width = fmax(width, 1) * (range > 0 ? 1.4 : 1);
    return pen;
}

/* The line from node i to node j, l their distance at rest. */
static void draw_spring(const SpringPen *pen, int i, int j, double l)
{
    const double *a = pen->x + 2 * (size_t)i, *b = pen->x + 2 * (size_t)j;
    const Mapping *mapping = &pen->mapping;
    Colour colour = COLOUR_SPRING;
    if (pen->range > 0) {
        double strain = hypot(a[0] - b[0], a[1] - b[1]) / l - 1;
        colour = colour_map_strain(strain, pen->range);
    }
    canvas_line(&pen->paper->canvas, mapping->x0 + mapping->scale * a[0],
                mapping->y0 - mapping->scale * a[1],
                mapping->x0 + mapping->scale * b[0],
                mapping->y0 - mapping->scale * b[1], pen->width, colour);
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
    const Mapping *mapping = &pen->mapping;
    double radius = 0.1 * mesh->side / mesh->segments * mapping->scale;
    if (radius < 0.5 * pen->width)
        return;
    Colour colour = pen->range > 0 ? COLOUR_TEXT : COLOUR_SPRING;
    for (int i = 0; i < mesh->nodes; i++)
        canvas_disc(&pen->paper->canvas,
                    mapping->x0 + mapping->scale * pen->x[2 * (size_t)i],
                    mapping->y0 - mapping->scale * pen->x[2 * (size_t)i + 1],
                    radius, colour);
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

/* Half of |stretch - 1|, rounded up: smaller strains should show too. */
double square_picture_strain_range(const Simulation *simulation)
{
    double strain = fabs(fabs(simulation->options.stretch) - 1);
    return plot_round_up(fmax(0.5 * strain, 0.05));
}
