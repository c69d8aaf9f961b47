/* square_mouse.c - the part of the square under the mouse, and its note. */
#include <math.h>
#include <stdlib.h>

#include "model/contact.h"
#include "model/neo_hookean.h"
#include "model/plasticity.h"
#include "model/spring_law.h"
#include "picture/cards.h"

static const double NOTE_SIZE = 0.9; /* ems, size of the note's letters */
static const double NOTE_WIDTH = 17; /* ems, least width of the note */

/* Picks the nearest node within reach of the mouse, else the nearest spring,
 * else an obstacle that the options have added.  Before the first step a spring
 * of the left or right edge picks this edge.  Also sets pick->nearest_node. */
void square_pick(const Plot *stage, double x, double y, Pick *pick)
{
    const Simulation *simulation = stage->simulation;
    const System *system = &simulation->system;
    const SquareMesh *mesh = &simulation->mesh;
    const Options *options = &simulation->options;
    const Contact *contact = get_contact(system);
    const double *at = pane_get_positions(stage->pane);
    double spacing = stage->camera.scale[0] * mesh->spacing;
    double reach = fmin(fmax(0.3 * spacing, 7), 16), best = reach * reach / 4;
    int springs = get_neo_hookean(system) ? 0 : system->springs;
    Pick node = *pick;
    if (plot_pick_point(stage, system->nodes, at, fmax(reach, 0.75 * spacing),
                        x, y, PICK_NODE, &node))
        pick->nearest_node = node.index;
    if (plot_pick_point(stage, system->nodes, at, reach, x, y, PICK_NODE, pick))
        return;
    for (int s = 0; s < springs; s++) {
        const int *e = system->e + 2 * s;
        double p[2], q[2], t = 0;
        plot_to_pixel(stage, at + 2 * e[0], p);
        plot_to_pixel(stage, at + 2 * e[1], q);
        double dx = q[0] - p[0], dy = q[1] - p[1], length2 = dx * dx + dy * dy;
        if (length2 > 0)
            t = fmin(fmax(((x - p[0]) * dx + (y - p[1]) * dy) / length2, 0), 1);
        double ex = p[0] + t * dx - x, ey = p[1] + t * dy - y;
        double d2 = ex * ex + ey * ey;
        if (d2 < best && !spring_is_broken(system, s)) {
            best = d2;
            pick->kind = PICK_SPRING;
            pick->index = s;
        }
    }
    if (pick->kind == PICK_SPRING) {
        const int *e = system->e + 2 * (size_t)pick->index;
        int sides = square_mesh_get_node_sides(mesh, e[0]) &
                    square_mesh_get_node_sides(mesh, e[1]);
        if (stage->content->time_line.is_paused && simulation->steps == 0 &&
            options->bodies == 0 && sides & (MESH_LEFT | MESH_RIGHT)) {
            pick->kind = PICK_EDGE;
            pick->index = sides & MESH_LEFT ? 0 : 1;
        }
        return;
    }
    for (int k = 0; contact && k < options->grounds + options->balls; k++) {
        const Obstacle *obstacle = &contact->obstacle[k];
        if (contact_measure_gap(obstacle, obstacle->o, pick->point, 0).d > 0)
            continue;
        pick->kind = PICK_OBSTACLE;
        pick->index = k;
    }
}

/* ---- the note ----------------------------------------------------------- */

/* Writes a text into the lower corner that is farther from the mouse. */
static void draw_mouse_note(const Plot *stage, const LiveValues *values,
                            const char *text)
{
    Paper *paper = stage->paper;
    Plot note = *stage;
    Box *box = &note.box;
    double middle = stage->box.x + 0.5 * stage->box.width, mouse[2];
    double size = fmax(NOTE_SIZE, paper->min_letter_size);
    double wide = NOTE_WIDTH * paper->em;
    int margin = paper_to_pixels(paper, 0.7), high = 2 * margin;
    for (TextLine line = lines_begin(values, text); text_next_line(&line);) {
        wide = fmax(wide, paper_measure(paper, line.face, size, line.text));
        high += paper_write_paragraph(paper, line.face, size, line.colour, *box,
                                      0, line.text);
        high += paper_to_pixels(paper, 0.2 * size);
    }
    plot_to_pixel(stage, stage->content->view->hovered_part.point, mouse);
    box->width = (int)wide + 2 * margin;
    box->height = high;
    box->x += mouse[0] > middle ? 0 : stage->box.width - box->width;
    box->y += stage->box.height - box->height;
    canvas_framed_box(&paper->canvas, *box, COLOUR_NOTE, COLOUR_GREY);
    *box = box_inset(*box, margin);
    card_write_text(&note, values, text);
}

/* Writes the note about a node, with the force m g - grad P (no friction). */
static void describe_node(Plot *stage, const Pane *pane, int node)
{
    const Simulation *simulation = pane->simulation;
    const System *system = &simulation->system;
    const double *all = pane_get_positions(pane), *x = all + 2 * (size_t)node;
    const double *v = simulation->run[0].v + 2 * (size_t)node;
    const double *ghost = pane->trace ? pane->trace->x_tilde : NULL;
    double h = simulation->options.timestep, force[2], tilde[2];
    double *f = calloc(2 * (size_t)system->nodes, sizeof *f);
    EvalPoint at = make_eval_point(system, all, NULL, all);
    LiveValues values = {0};
    at.weight = -1;
    for (const TermKind *kind; f && (kind = eval_point_next_term(&at));)
        if (kind->gradient)
            kind->gradient(&at, f);
    for (int k = 0; k < 2; k++) {
        force[k] =
            f ? f[2 * node + k] + system->m[node] * system->gravity[k] : NAN;
        tilde[k] = ghost ? ghost[2 * node + k] : x[k] + h * v[k];
    }
    free(f);
    values_add(&values, "node", node);
    values_add_words(&values, "pinned",
                     system->is_pinned[node] ? ", pinned" : "");
    values_add(&values, "mass", system->m[node]);
    values_add_point(&values, "place", x);
    values_add_point(&values, "velocity", v);
    values_add_point(&values, "force", force);
    values_add_point(&values, "inertia", tilde);
    values_add_words(&values, "pin",
                     !simulation_is_draggable(simulation) ? NULL
                     : system->is_pinned[node]            ? "frees"
                                                          : "pins");
    draw_mouse_note(stage, &values, text_node);
}

/* Writes the note about a spring.  The eigenvalues of its 4x4 block are 0, 0
 * and twice those of its 2x2 Hessian. */
static void describe_spring(Plot *stage, const Pane *pane, int s)
{
    const System *system = &pane->simulation->system;
    const int *e = system->e + 2 * s;
    Projection projection = pane->simulation->options.projection;
    double k = get_neo_hookean(system) ? NAN : system->k[s];
    double l2 = system->l2[s], d[2];
    double d2 = spring_vector(e, pane_get_positions(pane), d);
    const FlowLaw law = plasticity_get_flow_law(system, s);
    double s_e = spring_eigenvalue_across(d2, l2) / l2 - law.ep_n;
    double across = l2 * flow_law_slope(law, s_e);
    double along = flow_law_eigenvalue_along(law, s_e, d2, across);
    across *= 2 * spring_hessian_factor(l2, k);
    along *= 2 * spring_hessian_factor(l2, k);
    LiveValues values = {0};
    values_add(&values, "a", e[0]);
    values_add(&values, "b", e[1]);
    values_add(&values, "l2", l2);
    values_add(&values, "strain", 100 * (vector_length(d) / sqrt(l2) - 1));
    values_add(&values, "across", across);
    values_add(&values, "along", along);
    if (projects_blocks(projection) && fmin(along, across) < 0) {
        values_add(&values, "across after",
                   project_eigenvalue(projection, across));
        values_add(&values, "along after",
                   project_eigenvalue(projection, along));
    }
    draw_mouse_note(stage, &values, text_spring);
}

void draw_square_hover(Plot *stage)
{
    const Pane *pane = stage->pane;
    const Pick *hover = &stage->content->view->hovered_part;
    const System *system = &pane->simulation->system;
    if (hover->kind == PICK_NODE && hover->index < system->nodes)
        describe_node(stage, pane, hover->index);
    if (hover->kind == PICK_SPRING && hover->index < system->springs)
        describe_spring(stage, pane, hover->index);
}
