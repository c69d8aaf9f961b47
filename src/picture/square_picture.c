#include "picture/square_picture.h"

#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/hover.h"
#include "model/contact.h"
#include "model/fracture.h"
#include "model/plasticity.h"
#include "picture/marks.h"
#include "picture/square_contact.h"
#include "scenes/scene.h"

enum {
    GHOST_SPRINGS = 700, /* of more only the outline is drawn as a ghost */
    ARROW_SPACING = 16   /* pixels between nodes that have arrows, at least */
};

enum { NUMBERED = 121 }; /* nodes, at most, whose numbers are shown */

static const double ROOM = 1.14;      /* of the stage around the square */
static const double BARE_ROOM = 1.75; /* the bare square: 57 % of the side */
static const double NODE = 0.1;       /* of the distance of two nodes */

/* What does not change from spring to spring. */
typedef struct SpringPen {
    Paper *paper;
    const Stage *stage;
    const Pane *pane;
    const double *x;        /* [2n] m */
    double *at;             /* [2n] pixels; NULL: not enough memory */
    double spacing;         /* pixels, of two nodes at rest */
    double width;           /* pixels */
    double range;           /* of the strains; 0: all blue */
    bool plastic;           /* the colour is the plastic strain ... */
    const double *ep;       /* [springs] of each; NULL: springs do not flow */
    const Contact *contact; /* NULL: there is nothing to touch */
    bool projected;         /* springs whose block was changed are lit */
} SpringPen;

/* ---- how much of the world is seen -------------------------------------- */

/* Side lengths that the square may fill: a stretched one springs back, and a
 * squeezed one springs out and bulges. */
static double square_extent(double stretch)
{
    double s = fabs(stretch);
    return s < 1 ? 1 + 1.5 * (1 - s) : s;
}

/* Whether the scene says what is to be seen. */
static bool has_frame(const Simulation *simulation)
{
    const double *frame = simulation->scene->frame;
    return frame[2] > frame[0];
}

/* The square as it starts; where nodes have left that, 1.5, 1.5^2, ... times
 * as much around the same middle, so that the view jumps seldom. */
static void square_bounds(const Show *show, int pane, double bounds[4])
{
    const Pane *shown = &show->pane[pane];
    const Simulation *simulation = shown->simulation;
    const double *x = pane_x(shown);
    double extent = square_extent(simulation->options.stretch);
    double room = show->bare ? BARE_ROOM : ROOM;
    double half = 0.5 * simulation->mesh.side * room;
    double need = 1, grow = 1;
    bounds[2] = half * extent;
    bounds[3] = show->bare ? half * extent : half * fmin(extent, 1.25);
    if (shown->frame) {
        for (int k = 0; k < 4; k++)
            bounds[k] = shown->frame[k];
        return;
    }
    if (has_frame(simulation)) {
        for (int k = 0; k < 4; k++)
            bounds[k] = simulation->scene->frame[k];
        return;
    }
    for (int i = 0; i < simulation->system.nodes; i++) {
        double reach =
            fmax(fabs(x[2 * i]) / bounds[2], fabs(x[2 * i + 1]) / bounds[3]);
        if (isfinite(reach) && reach > need)
            need = reach;
    }
    while (grow < need && grow < 1e30)
        grow *= 1.5;
    bounds[2] *= grow;
    bounds[3] *= grow;
    bounds[0] = -bounds[2];
    bounds[1] = -bounds[3];
}

/* ---- springs and nodes -------------------------------------------------- */

/* Half of the largest plastic strain, or 5 %. */
static double plastic_range(const System *system, const double *ep)
{
    double largest = 0.1;
    for (int s = 0; s < system->springs; s++)
        largest = fmax(largest, fabs(ep[s]));
    return plot_round_up(0.5 * largest);
}

static SpringPen square_pen(Paper *paper, const Stage *stage, const Show *show,
                            int run)
{
    const Pane *pane = &show->pane[stage->pane];
    const Simulation *simulation = pane->simulation;
    const SquareMesh *mesh = &simulation->mesh;
    const Trace *trace = pane->trace;
    SpringPen pen = {.paper = paper, .stage = stage, .pane = pane};
    const System *system = simulation->run[run].system;
    pen.x = run == 0 ? pane_x(pane) : simulation->run[run].x;
    pen.spacing = stage->camera.scale[0] * mesh->side / mesh->segments;
    pen.width = fmin(fmax(0.06 * pen.spacing / paper->unit, 1.1), 1.9);
    pen.width = fmax(1, pen.width * paper->unit);
    pen.at = paper_places(paper, 2 * (size_t)simulation->system.nodes);
    for (int i = 0; pen.at && i < simulation->system.nodes; i++)
        stage_pixel(stage, pen.x + 2 * (size_t)i, pen.at + 2 * (size_t)i);
    const Plasticity *plasticity = plasticity_of(system);
    pen.contact = contact_of(system);
    pen.ep = plasticity ? plasticity->ep : NULL;
    pen.plastic = !show->strain && !show->bare && pen.ep;
    pen.range = show->strain ? square_picture_strain_range(simulation) : 0;
    if (pen.plastic)
        pen.range = plastic_range(system, pen.ep);
    if (pen.range > 0)
        pen.width *= 1.4;
    pen.projected = trace && trace->line >= LINE_PROJECT &&
                    trace->line <= LINE_SEARCH && !show->strain &&
                    simulation->options.filter != FILTER_NONE &&
                    trace->projected != 0;
    return pen;
}

/* Whether the block of this spring has a negative eigenvalue: it is shorter
 * than at rest. */
static bool spring_projected(const double *a, const double *b, double l2)
{
    double dx = a[0] - b[0], dy = a[1] - b[1];
    return dx * dx + dy * dy < l2;
}

/* The line from node i to node j, l2 their squared distance at rest. */
static void draw_spring(const SpringPen *pen, int i, int j, double l2,
                        double plastic)
{
    const double *a = pen->x + 2 * (size_t)i, *b = pen->x + 2 * (size_t)j;
    Colour colour = COLOUR_X;
    double width = pen->width;
    if (pen->plastic) {
        colour = colour_map_plastic(plastic, pen->range);
    } else if (pen->range > 0) {
        double strain = hypot(a[0] - b[0], a[1] - b[1]) / sqrt(l2) - 1;
        colour = colour_map_strain(strain, pen->range);
    } else if (pen->projected && spring_projected(a, b, l2)) {
        colour = COLOUR_PROJECT;
        width *= 1.15;
    }
    const double *p = pen->at + 2 * (size_t)i, *q = pen->at + 2 * (size_t)j;
    canvas_line(&pen->paper->canvas, p[0], p[1], q[0], q[1], width, colour);
}

static void draw_whole_springs(const SpringPen *pen, const System *system)
{
    for (int s = 0; s < system->springs; s++)
        if (!spring_is_broken(system, s))
            draw_spring(pen, system->e[2 * (size_t)s],
                        system->e[2 * (size_t)s + 1], system->l2[s],
                        pen->ep ? pen->ep[s] : 0);
}

/* More springs than this are shared by two threads, each in its band of the
 * picture: the pixels are those of one. */
enum { BANDED_SPRINGS = 10000, BANDS = 2, SPRING_NANOSECONDS = 70 };

typedef struct BandJob {
    const SpringPen *pen;
    const System *system;
} BandJob;

/* What can be seen of all springs in some bands of the picture. */
static void draw_bands(const void *job, int first, int end)
{
    const BandJob *all = job;
    const Box clip = all->pen->paper->canvas.clip;
    for (int band = first; band < end; band++) {
        Paper paper = *all->pen->paper;
        SpringPen pen = *all->pen;
        int top = clip.height * band / BANDS;
        int bottom = clip.height * (band + 1) / BANDS;
        canvas_clip(&paper.canvas,
                    (Box){clip.x, clip.y + top, clip.width, bottom - top});
        pen.paper = &paper;
        draw_whole_springs(&pen, all->system);
    }
}

static long draw_all_springs(const SpringPen *pen, const System *system)
{
    Paper *paper = pen->paper;
    const BandJob job = {pen, system};
    long drawn = 0;
    for (int s = 0; s < system->springs; s++)
        drawn += !spring_is_broken(system, s);
    if (drawn > BANDED_SPRINGS && !paper->crew)
        paper->crew = crew_create(0);
    if (drawn <= BANDED_SPRINGS || !paper->crew) {
        draw_whole_springs(pen, system);
        return drawn;
    }
    crew_begin(paper->crew);
    crew_run(paper->crew, draw_bands, &job, BANDS,
             (double)SPRING_NANOSECONDS * (double)drawn);
    return drawn;
}

/* The springs of a mesh of every stride-th node, the last one included. */
static long draw_coarse_springs(const SpringPen *pen, const SquareMesh *mesh,
                                int stride)
{
    int n = mesh->segments, rows = mesh->rows, row = rows + 1;
    double l2 = mesh->side / n * (mesh->side / n);
    long drawn = 0;
    for (int i = 0; i <= n; i += stride)
        for (int j = 0; j <= rows; j += stride) {
            int di = i + stride <= n ? stride : n - i;
            int dj = j + stride <= rows ? stride : rows - j;
            int node = i * row + j, right = node + di * row;
            double diagonal = l2 * (di * di + dj * dj);
            if (di > 0)
                draw_spring(pen, node, right, l2 * di * di, 0);
            if (dj > 0)
                draw_spring(pen, node, node + dj, l2 * dj * dj, 0);
            if (di > 0 && dj > 0) {
                draw_spring(pen, node, right + dj, diagonal, 0);
                draw_spring(pen, node + dj, right, diagonal, 0);
            }
            drawn += (di > 0) + (dj > 0) + 2 * (di > 0 && dj > 0);
        }
    return drawn;
}

/* Radius of the nodes' discs, pixels. */
static double node_radius(const SpringPen *pen, bool bare)
{
    double radius = NODE * pen->spacing;
    return bare ? radius : fmin(radius, 6.5 * pen->paper->unit);
}

/* Discs at all nodes; those that the springs hide are left out. */
static void draw_nodes(const SpringPen *pen, const System *system, bool bare)
{
    double radius = node_radius(pen, bare);
    Colour colour = pen->range > 0 ? COLOUR_FAINT : COLOUR_X;
    if (pen->range > 0) /* they would hide the colours of a fine mesh */
        radius *= 0.75;
    if (radius >= 0.5 * pen->width)
        for (int i = 0; i < system->nodes; i++)
            canvas_disc(&pen->paper->canvas, pen->at[2 * (size_t)i],
                        pen->at[2 * (size_t)i + 1], radius, colour);
    for (int i = 0; system->pinned && i < system->nodes; i++)
        if (system->pinned[i])
            stage_pin(pen->paper, pen->stage, pen->x + 2 * (size_t)i, radius);
}

/* ---- outlines, ghosts, cells -------------------------------------------- */

/* Node k of the outline, anticlockwise from the lower left. */
static int outline_node(const SquareMesh *mesh, int k)
{
    int columns = mesh->segments, rows = mesh->rows, row = rows + 1;
    k %= 2 * (columns + rows);
    if (k < columns)
        return k * row;
    if (k < columns + rows)
        return columns * row + (k - columns);
    if (k < 2 * columns + rows)
        return (2 * columns + rows - k) * row + rows;
    return 2 * (columns + rows) - k;
}

/* The outline of the square at x. */
static void draw_outline(Paper *paper, const Stage *stage,
                         const SquareMesh *mesh, const double *x, bool dashed,
                         Colour colour)
{
    double phase = 0, unit = paper->unit;
    for (int k = 0; k < 2 * (mesh->segments + mesh->rows); k++) {
        const double *a = x + 2 * (size_t)outline_node(mesh, k);
        const double *b = x + 2 * (size_t)outline_node(mesh, k + 1);
        double p[2], q[2];
        stage_pixel(stage, a, p);
        stage_pixel(stage, b, q);
        if (dashed)
            canvas_dashes(&paper->canvas, p[0], p[1], q[0], q[1],
                          fmax(1, 1.4 * unit), 6 * unit, 4 * unit, &phase,
                          colour);
        else
            canvas_line(&paper->canvas, p[0], p[1], q[0], q[1],
                        fmax(1, 1.4 * unit), colour);
    }
}

/* All springs of a small square, faintly, and its outline in dashes. */
static void draw_ghost(Paper *paper, const Stage *stage,
                       const Simulation *simulation, const double *x,
                       Colour colour)
{
    const System *system = &simulation->system;
    Colour faint = (colour & 0xffffff) | 0x50000000u;
    for (int s = 0; system->springs <= GHOST_SPRINGS && s < system->springs;
         s++)
        stage_line(paper, stage, x + 2 * (size_t)system->e[2 * s],
                   x + 2 * (size_t)system->e[2 * s + 1], 1, faint);
    draw_outline(paper, stage, &simulation->mesh, x, true, colour);
}

/* Twice the area of the triangle a b c, > 0 if it was not turned over. */
static double turn(const double *x, int a, int b, int c)
{
    const double *p = x + 2 * (size_t)a, *q = x + 2 * (size_t)b,
                 *r = x + 2 * (size_t)c;
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

bool square_picture_torn(const System *system, const SquareMesh *mesh, int cell)
{
    int columns = mesh->segments, rows = mesh->rows;
    int i = cell / rows, j = cell % rows, upright = columns * (rows + 1);
    int low = i * (rows + 1) + j, left = upright + i * rows + j;
    int diagonal = upright + (columns + 1) * rows + 2 * cell;
    const int spring[6] = {low,         low + 1,  left,
                           left + rows, diagonal, diagonal + 1};
    for (int k = 0; system->breaks && k < 6; k++)
        if (spring_is_broken(system, spring[k]))
            return true;
    return false;
}

bool square_picture_folded(const SquareMesh *mesh, const double *x, int cell)
{
    int row = mesh->rows + 1;
    int a = cell / mesh->rows * row + cell % mesh->rows;
    int b = a + row, c = b + 1, d = a + 1;
    return turn(x, a, b, c) < 0 || turn(x, a, c, d) < 0;
}

/* Cells whose four sides are whole are filled lightly; those that have turned
 * over in another colour. */
static void draw_cells(const SpringPen *pen, const Simulation *simulation,
                       bool all)
{
    const SquareMesh *mesh = &simulation->mesh;
    int rows = mesh->rows, row = rows + 1;
    for (int cell = 0; cell < mesh->segments * rows; cell++) {
        int a = cell / rows * row + cell % rows;
        const int node[4] = {a, a + row, a + row + 1, a + 1};
        bool folded = square_picture_folded(mesh, pen->x, cell);
        double p[4][2];
        if ((!folded && !all) ||
            square_picture_torn(&simulation->system, mesh, cell))
            continue;
        for (int k = 0; k < 4; k++)
            stage_pixel(pen->stage, pen->x + 2 * (size_t)node[k], p[k]);
        for (int k = 0; k < 2; k++) {
            const double corners[6] = {p[0][0],     p[0][1],     p[1 + k][0],
                                       p[1 + k][1], p[2 + k][0], p[2 + k][1]};
            canvas_triangle(&pen->paper->canvas, corners, false,
                            folded ? 0x38d00000u : 0x180000ffu);
        }
    }
}

/* ---- what Newton does --------------------------------------------------- */

static int arrow_stride(const SpringPen *pen)
{
    int stride = (int)ceil(ARROW_SPACING * pen->paper->unit / pen->spacing);
    return stride < 1 ? 1 : stride;
}

/* p as arrows that end where a full step leads, if that can be seen. */
static void draw_direction(const SpringPen *pen, const double *p,
                           Legend *legend)
{
    const Box *box = &pen->stage->box;
    const Trace *trace = pen->pane->trace;
    double grown = trace->line == LINE_SOLVE ? 1 - trace->rest : 1;
    double factor = stage_arrows(pen->paper, pen->stage,
                                 pen->pane->simulation->system.nodes,
                                 arrow_stride(pen), pen->x, p, grown,
                                 0.5 * fmin(box->width, box->height), COLOUR_P);
    if (factor == 0 || !pen->stage->text)
        return;
    if (factor == 1)
        stage_legend(pen->paper, pen->stage, legend, COLOUR_P,
                     "search direction p");
    else
        stage_legend(pen->paper, pen->stage, legend, COLOUR_P,
                     "search direction p \u00d7 %g", factor);
}

/* The run of this number as its contacts see it. */
static ContactView contact_view(const SpringPen *pen, int run)
{
    const Simulation *simulation = pen->pane->simulation;
    return (ContactView){.paper = pen->paper,
                         .stage = pen->stage,
                         .run = &simulation->run[run],
                         .x = pen->x,
                         .h = simulation->options.timestep,
                         .node = node_radius(pen, false)};
}

/* The start of the hand's spring, the spring, and its force. */
static void draw_hand(const SpringPen *pen, const Show *show)
{
    const Hand *hand = &show->hand;
    const Stage *stage = pen->stage;
    double unit = pen->paper->unit, at[2];
    if (!hand->on || hand->pane != stage->pane)
        return;
    const double *node = pen->x + 2 * (size_t)hand->node;
    stage_dashes(pen->paper, stage, node, hand->target, 2, COLOUR_HAND);
    stage_ring(pen->paper, stage, node, node_radius(pen, false) + 4 * unit, 2,
               COLOUR_HAND);
    stage_disc(pen->paper, stage, hand->target, 4 * unit, COLOUR_HAND);
    stage_pixel(stage, hand->target, at);
    if (hand->force > 0 && stage->text)
        paper_write(pen->paper, FACE_REGULAR, 0.9, COLOUR_HAND,
                    at[0] + 8 * unit, at[1] - 18 * unit, ALIGN_LEFT, "%.3g N",
                    hand->force);
}

/* What the mouse is over. */
static void draw_hover(const SpringPen *pen, const Show *show)
{
    const Pick *hover = &show->hover;
    const System *system = &pen->pane->simulation->system;
    double unit = pen->paper->unit;
    if (hover->pane != pen->stage->pane)
        return;
    if (hover->kind == PICK_NODE && hover->index < system->nodes)
        stage_ring(pen->paper, pen->stage, pen->x + 2 * (size_t)hover->index,
                   node_radius(pen, false) + 4 * unit, 2, COLOUR_TEXT);
    if (hover->kind == PICK_SPRING && hover->index < system->springs)
        stage_line(pen->paper, pen->stage,
                   pen->x + 2 * (size_t)system->e[2 * hover->index],
                   pen->x + 2 * (size_t)system->e[2 * hover->index + 1], 4.5,
                   COLOUR_TEXT);
}

/* ---- all of it ---------------------------------------------------------- */

/* Below the springs: rest shape, ghosts, cells. */
static void draw_ground(const SpringPen *pen, const Show *show, Legend *legend)
{
    const Pane *pane = pen->pane;
    const Simulation *simulation = pane->simulation;
    const Trace *trace = pane->trace;
    Paper *paper = pen->paper;
    const Stage *stage = pen->stage;
    if (!pane->frame && !has_frame(simulation) && !pen->contact) {
        draw_outline(paper, stage, &simulation->mesh, simulation->mesh.x, false,
                     COLOUR_RULE);
        if (stage->text && stage->pane == 0)
            stage_legend(paper, stage, legend, COLOUR_GREY, "rest shape");
    }
    draw_cells(pen, simulation,
               pen->contact || fracture_of(&simulation->system));
    for (int r = 1; r < simulation->runs; r++) /* the same with other numbers */
        if (simulation->run[r].system == &simulation->system)
            draw_ghost(paper, stage, simulation, simulation->run[r].x,
                       colour_of_run(r));
    if (pane->ghost) {
        draw_ghost(paper, stage, simulation, pane->ghost, COLOUR_GHOST);
        if (stage->text)
            stage_legend(paper, stage, legend, COLOUR_GHOST, "%s",
                         pane->ghost_label ? pane->ghost_label : "before");
    }
    if (trace && trace->x_tilde && (trace->line || show->arrows)) {
        draw_ghost(paper, stage, simulation, trace->x_tilde, COLOUR_X_TILDE);
        if (stage->text)
            stage_legend(paper, stage, legend, COLOUR_X_TILDE,
                         "{xt}, inertia alone");
    }
}

/* Above them. */
static void draw_signs(const SpringPen *pen, const Show *show, Legend *legend)
{
    const Pane *pane = pen->pane;
    const Trace *trace = pane->trace;
    if (pen->projected && pen->stage->text)
        stage_legend(pen->paper, pen->stage, legend, COLOUR_PROJECT,
                     "projected spring");
    if (trace && trace->p && trace->line >= LINE_SOLVE &&
        trace->line <= LINE_SEARCH)
        draw_direction(pen, trace->p, legend);
    draw_hover(pen, show);
    draw_hand(pen, show);
    int folded = pane_folded(pane);
    if (folded > 0 && pen->stage->text)
        stage_legend(pen->paper, pen->stage, legend, COLOUR_WARNING,
                     "%d cell%s folded over", folded, folded == 1 ? "" : "s");
}

/* What the colours mean, lower right: from compressed to stretched, or from
 * nothing to the largest plastic strain. */
static void draw_colour_bar(Paper *paper, const Stage *stage, double range,
                            bool plastic)
{
    int width = paper_pixels(paper, 14), height = paper_pixels(paper, 0.6);
    int x = stage->box.x + stage->box.width - width - paper_pixels(paper, 1);
    int y = stage->box.y + stage->box.height - paper_pixels(paper, 1.2);
    double above = y - 1.4 * paper->em;
    int rim = paper_pixels(paper, 0.4); /* walls may be behind it */
    canvas_rectangle(&paper->canvas, x - rim, (int)above - rim / 2,
                     width + 2 * rim, height + paper_pixels(paper, 1.9),
                     COLOUR_PANEL);
    for (int i = 0; i < width; i++) {
        double part = (i + 0.5) / width;
        canvas_rectangle(&paper->canvas, x + i, y, 1, height,
                         plastic ? colour_map_plastic(part, 1)
                                 : colour_map_strain(2 * part - 1, 1));
    }
    if (plastic)
        paper_write(paper, FACE_REGULAR, 0.85, COLOUR_FAINT, x, above,
                    ALIGN_LEFT, "0");
    else
        paper_write(paper, FACE_REGULAR, 0.85, COLOUR_COMPRESS, x, above,
                    ALIGN_LEFT, "\u2212%.3g %%", 100 * fmin(range, 1));
    paper_write(paper, FACE_REGULAR, 0.85, COLOUR_FAINT, x + 0.5 * width, above,
                ALIGN_CENTRE, plastic ? "plastic strain" : "strain");
    paper_write(paper, FACE_REGULAR, 0.85,
                plastic ? COLOUR_PLASTIC : COLOUR_STRETCH, x + width, above,
                ALIGN_RIGHT, plastic ? "%.3g %%" : "+%.3g %%", 100 * range);
}

/* The number of each node beside it. */
static void draw_numbers(const SpringPen *pen, const System *system)
{
    for (int i = 0; i < system->nodes; i++) {
        double at[2];
        char number[16];
        Paper *paper = pen->paper;
        stage_pixel(pen->stage, pane_x(pen->pane) + 2 * i, at);
        at[0] += 0.7 * paper->em;
        at[1] += 0.4 * paper->em;
        snprintf(number, sizeof number, "%d", i);
        canvas_rectangle(&paper->canvas, (int)at[0], (int)at[1],
                         paper_width(paper, FACE_BOLD, 1.3, number),
                         paper_pixels(paper, 1.5), COLOUR_PANEL);
        paper_write(paper, FACE_BOLD, 1.3, COLOUR_TEXT, at[0], at[1],
                    ALIGN_LEFT, "%s", number);
    }
}

/* Obstacles of all runs, so that no wall hides a body. */
static void draw_obstacles(const SpringPen *pen)
{
    const Simulation *simulation = pen->pane->simulation;
    bool apart = square_contact_apart(simulation);
    for (int r = 0; r < (apart ? simulation->runs : 1); r++) {
        ContactView view = contact_view(pen, r);
        view.x = r == 0 ? pen->x : simulation->run[r].x;
        square_contact_obstacles(&view, apart);
        if (apart && pen->stage->text)
            square_contact_label(&view);
    }
}

/* Runs with a system of their own; the first one is drawn last. */
static void draw_other_runs(Paper *paper, const Stage *stage, const Show *show)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    for (int r = 1; square_contact_apart(simulation) && r < simulation->runs;
         r++) {
        SpringPen pen = square_pen(paper, stage, show, r);
        if (!pen.at)
            return;
        if (!show->bare)
            draw_cells(&pen, simulation, true);
        draw_all_springs(&pen, simulation->run[r].system);
        draw_nodes(&pen, simulation->run[r].system, show->bare);
    }
}

/* Forces on all runs, in one scale, and what they mean. */
static void draw_forces(const SpringPen *pen, Legend *legend)
{
    const Simulation *simulation = pen->pane->simulation;
    int runs = square_contact_apart(simulation) ? simulation->runs : 1;
    ContactView view[SIMULATION_MAX_RUNS];
    double most = 0;
    for (int r = 0; r < runs; r++) {
        view[r] = contact_view(pen, r);
        view[r].x = r == 0 ? pen->x : simulation->run[r].x;
        most = fmax(most, square_contact_most(&view[r]));
    }
    for (int r = 0; r < runs; r++)
        square_contact_forces(&view[r], most);
    if (pen->stage->text)
        square_contact_legend(&view[0], most, legend);
}

/* A tolerance at which bodies would hang in the air or freeze. */
static void draw_tolerance(const SpringPen *pen, Legend *legend)
{
    const Simulation *simulation = pen->pane->simulation;
    double needed = simulation_tolerance_needed(simulation);
    char number[48];
    if (!(simulation->options.tolerance > needed * (1 + 1e-9)))
        return;
    plot_number(number, sizeof number, needed);
    stage_legend(pen->paper, pen->stage, legend, COLOUR_WARNING,
                 "\u03b5 is loose: above %s m/s bodies may hang or freeze",
                 number);
}

/* From the ground up. */
static SpringCount square_draw(Paper *paper, const Stage *stage,
                               const Show *show)
{
    SpringPen pen = square_pen(paper, stage, show, 0);
    const Simulation *simulation = pen.pane->simulation;
    const System *system = &simulation->system;
    SpringCount count = {0, 0};
    Legend legend = {0, 0};
    if (pen.contact)
        draw_obstacles(&pen);
    draw_other_runs(paper, stage, show);
    pen = square_pen(paper, stage, show, 0);
    if (!pen.at)
        return count;
    int stride =
        (int)fmin(fmax(ceil(2 / pen.spacing), 1), simulation->mesh.segments);
    if (!show->bare)
        draw_ground(&pen, show, &legend);
    if (stride <= 1 || fracture_of(system))
        count.drawn = draw_all_springs(&pen, system);
    else
        count.drawn = draw_coarse_springs(&pen, &simulation->mesh, stride);
    count.skipped = system->springs - count.drawn;
    draw_nodes(&pen, system, show->bare);
    if (show->bare)
        return count;
    if (pen.contact)
        draw_forces(&pen, &legend);
    draw_signs(&pen, show, &legend);
    if (stage->text && show->numbers && system->nodes <= NUMBERED)
        draw_numbers(&pen, system);
    if (stage->text) {
        draw_tolerance(&pen, &legend);
        stage_scale(paper, stage);
        if (pen.range > 0)
            draw_colour_bar(paper, stage, pen.range, pen.plastic);
    }
    return count;
}

/* ---- the mouse ---------------------------------------------------------- */

/* Squared distance of a pixel to a line between two pixels. */
static double distance2(const double p[2], const double q[2], double x,
                        double y)
{
    double dx = q[0] - p[0], dy = q[1] - p[1];
    double length2 = dx * dx + dy * dy, t = 0;
    if (length2 > 0)
        t = fmin(fmax(((x - p[0]) * dx + (y - p[1]) * dy) / length2, 0), 1);
    double ex = p[0] + t * dx - x, ey = p[1] + t * dy - y;
    return ex * ex + ey * ey;
}

/* Before the first step a spring of the left or right edge is that edge. */
static void pick_edge(const Show *show, const Simulation *simulation,
                      Pick *pick)
{
    const SquareMesh *mesh = &simulation->mesh;
    const int *e = simulation->system.e + 2 * (size_t)pick->index;
    int row = mesh->rows + 1, column = e[0] / row;
    if (!show->paused || simulation->steps > 0 || e[1] / row != column ||
        (column != 0 && column != mesh->segments))
        return;
    pick->kind = PICK_EDGE;
    pick->index = column != 0;
}

/* The nearest node, else the nearest spring, within reach of the mouse. */
static Pick square_pick(const Show *show, const Stage *stage, double x,
                        double y)
{
    const Pane *pane = &show->pane[stage->pane];
    const System *system = &pane->simulation->system;
    const SquareMesh *mesh = &pane->simulation->mesh;
    const double *at = pane_x(pane);
    double spacing = stage->camera.scale[0] * mesh->side / mesh->segments;
    double reach = fmin(fmax(0.3 * spacing, 7), 16), best = reach * reach;
    Pick pick = {PICK_NONE, stage->pane, 0, {0, 0}};
    camera_world(&stage->camera, x, y, pick.point);
    for (int i = 0; i < system->nodes; i++) {
        double p[2];
        stage_pixel(stage, at + 2 * (size_t)i, p);
        double d2 = (p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y);
        if (d2 < best) {
            best = d2;
            pick.kind = PICK_NODE;
            pick.index = i;
        }
    }
    best = reach * reach / 4;
    for (int s = 0; pick.kind == PICK_NONE && s < system->springs; s++) {
        double p[2], q[2];
        if (spring_is_broken(system, s))
            continue;
        stage_pixel(stage, at + 2 * (size_t)system->e[2 * s], p);
        stage_pixel(stage, at + 2 * (size_t)system->e[2 * s + 1], q);
        double d2 = distance2(p, q, x, y);
        if (d2 < best) {
            best = d2;
            pick.kind = PICK_SPRING;
            pick.index = s;
        }
    }
    if (pick.kind == PICK_SPRING)
        pick_edge(show, pane->simulation, &pick);
    return pick;
}

/* All energies of the first run, J; cards leave out those that are 0. */
static void square_sample(const Simulation *simulation, History *history,
                          Trail *trail)
{
    static const char *const names[] = {
        "total",   "kinetic",  "elastic",  "gravity", "contact",   "hand",
        "plastic", "fracture", "friction", "work",    "dissipated"};
    enum { NAMES = sizeof names / sizeof *names };
    Energies e = simulation_energies(simulation, 0);
    const double value[NAMES] = {e.total,    e.kinetic, e.elastic,   e.gravity,
                                 e.contact,  e.hand,    e.plastic,   e.fracture,
                                 e.friction, e.work,    e.dissipated};
    (void)trail;
    history->series = NAMES;
    for (int s = 0; s < NAMES; s++)
        history->name[s] = names[s];
    history_add(history, simulation_time(simulation), value);
}

double square_picture_strain_range(const Simulation *simulation)
{
    double strain = fabs(fabs(simulation->options.stretch) - 1);
    if (simulation->scene->strain > 0)
        return simulation->scene->strain;
    return plot_round_up(fmax(0.5 * strain, 0.05));
}

static const Card *const square_cards[] = {
    &card_page,     &card_listing, &card_line, &card_residual,
    &card_energies, &card_spy,     NULL};

const Picture square_picture = {
    .name = "square",
    .cards = square_cards,
    .bounds = square_bounds,
    .draw = square_draw,
    .pick = square_pick,
    .hover = hover_square,
    .sample = square_sample,
};
