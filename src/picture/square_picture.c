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
#include "picture/square_pen.h"
#include "scenes/scene.h"

enum { ARROW_SPACING = 16 }; /* pixels between nodes that have arrows, least */
enum { LEAST_CELL = 5 };     /* pixels; smaller cells are drawn as faces */
enum { NUMBERED = 121 };     /* nodes, at most, whose numbers are shown */

static const double MOST_SEEN = 1e303; /* times the square, the stage shows */
static const double PANE_LABEL = 1.9;  /* ems, the label of a pane needs */
static const double ROOM = 1.14;       /* of the stage around the square */
static const double BARE_ROOM = 1.75;  /* the bare square: 57 % of the side */

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

/* 1, 1.5, 1.5^2, ...: the first that is enough, so that the view jumps seldom.
 */
static double grown(double need)
{
    double grow = 1;
    while (grow < need && grow < MOST_SEEN)
        grow *= 1.5;
    return grow;
}

/* How far the nodes are from a point, in parts of half [2]; at least 1. */
static double reach_from(const Simulation *simulation, const double *x,
                         const double from[2], const double half[2])
{
    double need = 1;
    for (int i = 0; i < simulation->system.nodes; i++) {
        double right = fabs(x[2 * i] - from[0]) / half[0];
        double up = fabs(x[2 * i + 1] - from[1]) / half[1];
        double reach = right > up || isnan(up) ? right : up;
        if (isfinite(reach) && reach > need)
            need = reach;
    }
    return need;
}

/* Where a body that nothing holds has drifted to, less the way that the view
 * has room for: what the view follows it by.  by [2] m, out. */
static void drifted(const Simulation *simulation, const double *x,
                    const double half[2], double by[2])
{
    const SquareMesh *mesh = &simulation->mesh;
    const Options *options = &simulation->options;
    bool near_something = options->grounds + options->balls > 0 ||
                          simulation->scene->own || simulation->runs != 1;
    by[0] = by[1] = 0;
    for (int k = 0; k < 2 && !near_something; k++) {
        double centre = 0;
        for (int i = 0; i < mesh->nodes; i++)
            centre += x[2 * i + k] / mesh->nodes;
        if (isfinite(centre) && fabs(centre) > 0.5 * half[k])
            by[k] = centre - copysign(0.5 * half[k], centre);
    }
}

/* The square as it starts; where nodes have left that, 1.5, 1.5^2, ... times
 * as much around the same middle.  One that drifts off is followed. */
static void square_bounds(const Show *show, int pane, double bounds[4])
{
    const Pane *shown = &show->pane[pane];
    const Simulation *simulation = shown->simulation;
    const double *x = pane_x(shown);
    double extent = square_extent(simulation->options.stretch);
    double room = show->bare ? BARE_ROOM : ROOM;
    double half = 0.5 * simulation->mesh.side * room;
    double by[2];
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
    drifted(simulation, x, bounds + 2, by);
    double grow = grown(reach_from(simulation, x, by, bounds + 2));
    for (int k = 0; k < 2; k++) {
        double wide = grow * bounds[2 + k];
        bounds[k] = by[k] - wide;
        bounds[2 + k] = by[k] + wide;
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
    char number[48];
    double factor = stage_arrows(pen->paper, pen->stage,
                                 pen->pane->simulation->system.nodes,
                                 arrow_stride(pen), pen->x, p, grown,
                                 0.5 * fmin(box->width, box->height), COLOUR_P);
    if (factor == 0 || !pen->stage->text)
        return;
    plot_number(number, sizeof number, factor);
    if (factor == 1)
        stage_legend(pen->paper, pen->stage, legend, COLOUR_P,
                     "search direction p");
    else
        stage_legend(pen->paper, pen->stage, legend, COLOUR_P,
                     "search direction p \u00d7 %s", number);
}

/* The run of this number as its contacts see it. */
static ContactView contact_view(const SpringPen *pen, int run)
{
    const Simulation *simulation = pen->pane->simulation;
    return (ContactView){.paper = pen->paper,
                         .stage = pen->stage,
                         .run = &simulation->run[run],
                         .x = run == 0 ? pen->x : simulation->run[run].x,
                         .h = simulation->options.timestep,
                         .grip = simulation->grip[run],
                         .node = square_pen_radius(pen, false)};
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
    stage_ring(pen->paper, stage, node,
               square_pen_radius(pen, false) + 4 * unit, 2, COLOUR_HAND);
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
                   square_pen_radius(pen, false) + 4 * unit, 2, COLOUR_TEXT);
    if (hover->kind == PICK_SPRING && hover->index < system->springs)
        stage_line(pen->paper, pen->stage,
                   pen->x + 2 * (size_t)system->e[2 * hover->index],
                   pen->x + 2 * (size_t)system->e[2 * hover->index + 1], 4.5,
                   COLOUR_TEXT);
}

/* ---- all of it ---------------------------------------------------------- */

/* Below the springs: rest shape, ghosts, cells.  Returns how many cells have
 * folded over. */
static int draw_ground(const SpringPen *pen, const Show *show, Legend *legend)
{
    const Pane *pane = pen->pane;
    const Simulation *simulation = pane->simulation;
    const Trace *trace = pane->trace;
    Paper *paper = pen->paper;
    const Stage *stage = pen->stage;
    if (!pane->frame && !has_frame(simulation) && !pen->contact) {
        square_outline(paper, stage, &simulation->mesh, simulation->mesh.x,
                       false, COLOUR_RULE);
        if (stage->text && stage->pane == 0)
            stage_legend(paper, stage, legend, COLOUR_GREY, "rest shape");
    }
    int folded = square_pen_cells(
        pen, simulation, pen->contact || fracture_of(&simulation->system));
    for (int r = 1; r < simulation->runs; r++) /* the same with other numbers */
        if (simulation->run[r].system == &simulation->system)
            square_ghost(paper, stage, simulation, simulation->run[r].x,
                         colour_of_run(r));
    if (pane->ghost) {
        square_ghost(paper, stage, simulation, pane->ghost, COLOUR_GHOST);
        if (stage->text)
            stage_legend(paper, stage, legend, COLOUR_GHOST, "%s",
                         pane->ghost_label ? pane->ghost_label : "before");
    }
    if (trace && trace->x_tilde && (trace->line || show->arrows)) {
        square_ghost(paper, stage, simulation, trace->x_tilde, COLOUR_X_TILDE);
        if (stage->text)
            stage_legend(paper, stage, legend, COLOUR_X_TILDE,
                         "{xt}, inertia alone");
    }
    return folded;
}

/* Nodes without a place: words for what cannot be drawn. */
static void draw_lost(const SpringPen *pen, Legend *legend)
{
    int nodes = pen->pane->simulation->system.nodes, lost = 0;
    for (int i = 0; i < nodes; i++)
        lost += !isfinite(pen->x[2 * (size_t)i]) ||
                !isfinite(pen->x[2 * (size_t)i + 1]);
    if (lost == nodes)
        stage_legend(pen->paper, pen->stage, legend, COLOUR_WARNING,
                     "no node has a place: beyond all numbers");
    else if (lost > 0)
        stage_legend(pen->paper, pen->stage, legend, COLOUR_WARNING,
                     "%d of %d nodes are beyond all numbers", lost, nodes);
}

/* Above them. */
static void draw_signs(const SpringPen *pen, const Show *show, int folded,
                       Legend *legend)
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
    if (pen->stage->text)
        draw_lost(pen, legend);
    if (folded > 0 && pen->stage->text)
        stage_legend(pen->paper, pen->stage, legend, COLOUR_WARNING,
                     "%d cell%s folded over", folded, folded == 1 ? "" : "s");
}

/* What the colours mean, lower right: from compressed to stretched, or from
 * nothing to the largest plastic strain; `raised` ems above its place. */
static void draw_colour_bar(Paper *paper, const Stage *stage, double range,
                            bool plastic, double raised)
{
    int width = paper_pixels(paper, 14), height = paper_pixels(paper, 0.6);
    int x = stage->box.x + stage->box.width - width - paper_pixels(paper, 1);
    int y =
        stage->box.y + stage->box.height - paper_pixels(paper, 1.2 + raised);
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
        if (!box_contains(pen->stage->box, at[0], at[1]))
            continue;
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
            square_pen_cells(&pen, simulation, true);
        square_pen_springs(&pen, simulation->run[r].system);
        square_pen_nodes(&pen, simulation->run[r].system, show->bare);
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
    double needed;
    char number[48];
    if (!simulation_is_loose(simulation, &needed))
        return;
    plot_number(number, sizeof number, needed);
    stage_legend(pen->paper, pen->stage, legend, COLOUR_WARNING,
                 "\u03b5 is loose: above %s m/s bodies may hang or freeze",
                 number);
}

/* From the ground up. */
static void square_draw(Paper *paper, const Stage *stage, const Show *show)
{
    SpringPen pen = square_pen(paper, stage, show, 0);
    const Simulation *simulation = pen.pane->simulation;
    const System *system = &simulation->system;
    Legend legend = {0, 0};
    if (pen.contact)
        draw_obstacles(&pen);
    draw_other_runs(paper, stage, show);
    pen = square_pen(paper, stage, show, 0); /* they took its places */
    if (!pen.at)
        return;
    int folded = show->bare ? 0 : draw_ground(&pen, show, &legend);
    if (pen.spacing >= LEAST_CELL || fracture_of(system))
        square_pen_springs(&pen, system);
    else
        square_pen_faces(&pen, &simulation->mesh);
    square_pen_nodes(&pen, system, show->bare);
    if (show->bare)
        return;
    if (pen.contact)
        draw_forces(&pen, &legend);
    draw_signs(&pen, show, folded, &legend);
    if (stage->text && show->numbers && system->nodes <= NUMBERED)
        draw_numbers(&pen, system);
    if (stage->text) {
        draw_tolerance(&pen, &legend);
        stage_scale(paper, stage);
        if (pen.range > 0)
            draw_colour_bar(paper, stage, pen.range, pen.plastic,
                            show->panes > 1 ? PANE_LABEL : 0);
    }
}

/* All energies of the first run, J; cards leave out those that are 0. */
static void square_sample(const Simulation *simulation, History *history,
                          Trail *trail)
{
    Energies energies = simulation_energies(simulation, 0);
    double value[HISTORY_SERIES] = {0};
    (void)trail;
    for (int i = 0; i < energies.rows; i++)
        value[history_series(history, energies.row[i].name)] =
            energies.row[i].value;
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
