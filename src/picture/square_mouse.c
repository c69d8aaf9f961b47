/* square_mouse.c - what of the square is under the mouse, and the small card
 * beside it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/mathematics.h"
#include "model/fracture.h"
#include "model/friction.h"
#include "model/mass_spring_energy.h"
#include "model/plasticity.h"
#include "picture/colour_map.h"
#include "picture/square_pen.h"
#include "scenes/scene.h"

enum { NOTE_LINES = 6, NOTE_TEXT = 128 };

static const double LINE = 1.35; /* ems, of a line */
static const double SMALL = 0.9; /* ems, size of the letters */
static const double WIDTH = 17;  /* ems */
static const double CELL = 4.7;  /* ems, a number of the block */
static const double BARS = 3.6;  /* ems, the bars of the eigenvalues */

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
    const int *e = simulation->system.e + 2 * (size_t)pick->index;
    int sides = square_mesh_sides(&simulation->mesh, e[0]) &
                square_mesh_sides(&simulation->mesh, e[1]);
    if (!show->paused || simulation->steps > 0 ||
        !(sides & (MESH_LEFT | MESH_RIGHT)))
        return;
    pick->kind = PICK_EDGE;
    pick->index = sides & MESH_LEFT ? 0 : 1;
}

/* The nearest node, else the nearest spring, within reach of the mouse. */
Pick square_pick(const Show *show, const Plot *stage, double x, double y)
{
    const Pane *pane = &show->pane[stage->pane];
    const System *system = &pane->simulation->system;
    const double *at = pane_x(pane);
    double spacing = stage->camera.scale[0] * pane->simulation->mesh.spacing;
    double reach = fmin(fmax(0.3 * spacing, 7), 16), best = reach * reach;
    Pick pick = {PICK_NONE, stage->pane, 0, {0, 0}};
    camera_world(&stage->camera, x, y, pick.point);
    for (int i = 0; i < system->nodes; i++) {
        double p[2];
        plot_place(stage, at + 2 * (size_t)i, p);
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
        plot_place(stage, at + 2 * (size_t)system->e[2 * s], p);
        plot_place(stage, at + 2 * (size_t)system->e[2 * s + 1], q);
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

/* ---- the card beside it ------------------------------------------------- */

/* m g - grad P: the force on a node, N, without friction. */
static void node_force(const System *system, const double *x, int node,
                       double force[2])
{
    double *f = calloc(2 * (size_t)system->nodes, sizeof *f);
    Place at = place_at(system, x, NULL, x);
    at.w = -1;
    for (const TermKind *kind; f && (kind = next_energy(&at));)
        if (kind != &friction_energy) /* it has no energy outside of a step */
            kind->gradient(&at, f);
    for (int k = 0; k < 2; k++)
        force[k] =
            f ? f[2 * node + k] + system->m[node] * system->gravity[k] : NAN;
    free(f);
}

/* tau and tau' of a spring with this strain: its own law, where it flows. */
static void spring_law(const System *system, int s, double strain, double *tau,
                       double *bend)
{
    const Plasticity *flow = plasticity_of(system);
    *tau = strain;
    *bend = 1;
    if (!flow)
        return;
    SpringLaw law = {.yield = flow->yield + flow->hardening * flow->kappa[s],
                     .flow = 1 / (1 + flow->hardening)};
    *tau = spring_law_slope(law, strain - flow->ep[s]);
    *bend = spring_law_curvature(law, strain - flow->ep[s]);
}

/* What the nodes that have a place fill, pixels; cut to the stage. */
static Box body_box(const Plot *stage, const Pane *pane)
{
    const Box *box = &stage->box;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < pane->simulation->system.nodes; i++) {
        double at[2];
        plot_place(stage, pane_x(pane) + 2 * (size_t)i, at);
        for (int k = 0; k < 2 && isfinite(at[0]) && isfinite(at[1]); k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    int left = (int)fmax(low[0], box->x), top = (int)fmax(low[1], box->y);
    int right = (int)fmin(high[0], box->x + box->width);
    int bottom = (int)fmin(high[1], box->y + box->height);
    return (Box){left, top, right - left, bottom - top};
}

/* Lines of a note, the first one bold; box in/out: what is left below. */
static void draw_lines(Paper *paper, Box *box, int count,
                       char line[][NOTE_TEXT])
{
    for (int i = 0; i < count; i++) {
        paper_write(paper, i == 0 ? FACE_BOLD : FACE_REGULAR, SMALL,
                    COLOUR_TEXT, box->x, box->y, ALIGN_LEFT, "%s", line[i]);
        box->y += paper_pixels(paper, LINE);
    }
}

/* m, x, v, f, x_tilde. */
static void note_node(Plot *stage, const Pane *pane, int node)
{
    Paper *paper = stage->paper;
    const Simulation *simulation = pane->simulation;
    const System *system = &simulation->system;
    const double *x = pane_x(pane) + 2 * (size_t)node;
    const double *v = simulation->run[0].v + 2 * (size_t)node;
    const Trace *trace = pane->trace;
    double h = simulation->options.timestep, force[2], tilde[2], at[2];
    char line[NOTE_LINES][NOTE_TEXT];
    node_force(system, pane_x(pane), node, force);
    for (int k = 0; k < 2; k++)
        tilde[k] = trace && trace->x_tilde ? trace->x_tilde[2 * node + k]
                                           : x[k] + h * v[k];
    const struct {
        const char *name;
        const double *a;
        const char *unit;
    } rows[4] = {{"{x}", x, "m"},
                 {"v", v, "m/s"},
                 {"f", force, "N"},
                 {"{xt}", tilde, "m"}};
    snprintf(line[0], NOTE_TEXT, "node %d%s", node,
             system->pinned && system->pinned[node] ? ", pinned" : "");
    snprintf(line[1], NOTE_TEXT, "m = %s kg", number_of(system->m[node]).text);
    for (int i = 0; i < 4; i++)
        snprintf(line[2 + i], NOTE_TEXT, "%s = (%s, %s) %s", rows[i].name,
                 number_of(rows[i].a[0]).text, number_of(rows[i].a[1]).text,
                 rows[i].unit);
    plot_place(stage, x, at);
    Box box = plot_note(stage, at[0], at[1], paper_pixels(paper, WIDTH),
                        paper_pixels(paper, LINE * NOTE_LINES),
                        body_box(stage, pane));
    draw_lines(paper, &box, NOTE_LINES, line);
}

/* The block [[H, -H], [-H, H]], number by number. */
static void draw_block(Paper *paper, Box *box, const double H[3])
{
    double most = fmax(fabs(H[0]), fmax(fabs(H[1]), fabs(H[2])));
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            double value = H[i % 2 + j % 2] * (i / 2 == j / 2 ? 1 : -1);
            if (fabs(value) < 1e-9 * most)
                value = 0;
            paper_write(paper, FACE_REGULAR, 0.78,
                        value == 0 ? COLOUR_GREY : COLOUR_TEXT,
                        box->x + (j + 1) * CELL * paper->em, box->y,
                        ALIGN_RIGHT, "%s", number_of(value).text);
        }
        box->y += paper_pixels(paper, 1.15);
    }
    box->y += paper_pixels(paper, 0.3);
}

/* Four pairs of bars: before projection in its colour, and after it. */
static void draw_eigenvalues(Paper *paper, const Box *box,
                             const double before[4], const double after[4])
{
    double most = 1e-300, low = 0;
    int width = paper_pixels(paper, 1.1), room = paper_pixels(paper, BARS);
    for (int k = 0; k < 4; k++) {
        if (!isfinite(before[k]))
            return; /* nothing that a bar could show */
        most = fmax(most, fmax(fabs(before[k]), fabs(after[k])));
        low = fmin(low, before[k]);
    }
    double scale = 0.6 * room / (fmax(most, -low) - low);
    int base = box->y + (int)(0.62 * room + low * scale);
    for (int k = 0; k < 4; k++) {
        int x = box->x + (int)((k + 0.25) * CELL * paper->em);
        int tall[2] = {(int)(before[k] * scale), (int)(after[k] * scale)};
        bool below = before[k] < 0;
        Colour colour[2] = {below ? COLOUR_PROJECT : COLOUR_GREY, COLOUR_X};
        for (int b = 0; b < 2; b++) {
            int top = base - (tall[b] > 0 ? tall[b] : 0);
            int size = abs(tall[b]) < 2 ? 2 : abs(tall[b]);
            canvas_rectangle(&paper->canvas, x + b * (width + 2), top, width,
                             size, colour[b]);
        }
        paper_write(paper, FACE_REGULAR, 0.78,
                    below ? COLOUR_PROJECT : COLOUR_FAINT, x + width,
                    box->y + 0.64 * room, ALIGN_CENTRE, "%s",
                    number_of(before[k]).text);
    }
}

/* e, l2, strain, block, eigenvalues. */
static void note_spring(Plot *stage, const Show *show, const Pane *pane, int s)
{
    Paper *paper = stage->paper;
    const System *system = &pane->simulation->system;
    const int *e = system->e + 2 * s;
    double k = system->k[s], l2 = system->l2[s], tau, bend, at[2], d[2];
    spring_strain(e, l2, pane_x(pane), d);
    double d2 = d[0] * d[0] + d[1] * d[1];
    spring_law(system, s, (d2 - l2) / l2, &tau, &bend);
    /* Eigenvalues of the 4x4 block are 0, 0 and twice those of
     * H = 2k/l2 (l2 tau I + 2 tau' d d^T). */
    const double H[3] = {2 * k / l2 * (l2 * tau + 2 * bend * d[0] * d[0]),
                         2 * k / l2 * 2 * bend * d[0] * d[1],
                         2 * k / l2 * (l2 * tau + 2 * bend * d[1] * d[1])};
    const double before[4] = {0, 0, 4 * k * tau,
                              4 * k / l2 * (2 * bend * d2 + l2 * tau)};
    double after[4] = {0};
    Filter filter = pane->simulation->options.filter;
    for (int m = 2; m < 4; m++)
        after[m] = filter_projects(filter)
                       ? projected_eigenvalue(filter, before[m])
                       : before[m];
    char line[3][NOTE_TEXT];
    snprintf(line[0], NOTE_TEXT, "spring %d\u2013%d", e[0], e[1]);
    snprintf(line[1], NOTE_TEXT, "l\u00b2 = %s m\u00b2,  strain %s %%",
             number_of(l2).text,
             number_of(100 * (math_hypot(d[0], d[1]) / sqrt(l2) - 1)).text);
    snprintf(line[2], NOTE_TEXT, "its block of \u2207\u00b2P, J/m\u00b2");
    int height = paper_pixels(paper, LINE * 4) +
                 paper_pixels(paper, 4 * 1.15 + 0.3 + BARS);
    plot_place(stage, show->hover.point, at);
    Box box =
        plot_note(stage, at[0], at[1], paper_pixels(paper, 4 * CELL + 0.3),
                  height, body_box(stage, pane));
    draw_lines(paper, &box, 3, line);
    draw_block(paper, &box, H);
    paper_write(paper, FACE_REGULAR, SMALL, COLOUR_TEXT, box.x, box.y,
                ALIGN_LEFT, "eigenvalues, and after projection");
    box.y += paper_pixels(paper, LINE);
    draw_eigenvalues(paper, &box, before, after);
}

/* Whether a node has a place. */
static bool is_placed(const Pane *pane, int node)
{
    const double *x = pane_x(pane) + 2 * (size_t)node;
    return isfinite(x[0]) && isfinite(x[1]);
}

void square_note(Plot *stage, const Show *show)
{
    const Pane *pane = &show->pane[stage->pane];
    const System *system = &pane->simulation->system;
    int i = show->hover.index, *e = system->e + 2 * i;
    if (show->hover.kind == PICK_NODE && i < system->nodes &&
        is_placed(pane, i))
        note_node(stage, pane, i);
    if (show->hover.kind == PICK_SPRING && i < system->springs &&
        is_placed(pane, e[0]) && is_placed(pane, e[1]))
        note_spring(stage, show, pane, i);
}
