#include "picture/hover.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "model/friction.h"
#include "model/plasticity.h"
#include "picture/colour_map.h"
#include "picture/plot.h"
#include "base/mathematics.h"

enum { HOVER_LINES = 8, HOVER_TEXT = 128 };

static const double LINE = 1.35; /* ems, of a line */
static const double SMALL = 0.9; /* ems, size of the letters */
static const double WIDTH = 17;  /* ems */
static const double CELL = 4.7;  /* ems, a number of the block */
static const double BARS = 3.6;  /* ems, the bars of the eigenvalues */

/* Lines of text that the card has. */
typedef struct Lines {
    int count;
    char text[HOVER_LINES][HOVER_TEXT];
} Lines;

static char *next_line(Lines *lines)
{
    return lines->text[lines->count < HOVER_LINES - 1 ? lines->count++
                                                      : HOVER_LINES - 1];
}

/* "(0.5, -1.25) m" */
static void add_vector(Lines *lines, const char *name, const double *a,
                       const char *unit)
{
    char x[48], y[48];
    plot_number(x, sizeof x, a[0]);
    plot_number(y, sizeof y, a[1]);
    snprintf(next_line(lines), HOVER_TEXT, "%s = (%s, %s) %s", name, x, y,
             unit);
}

static void draw_lines(Paper *paper, Box *box, const Lines *lines)
{
    for (int i = 0; i < lines->count; i++) {
        paper_write(paper, i == 0 ? FACE_BOLD : FACE_REGULAR, SMALL,
                    COLOUR_TEXT, box->x, box->y, ALIGN_LEFT, "%s",
                    lines->text[i]);
        box->y += paper_pixels(paper, LINE);
    }
}

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

/* m, x, v, f, x_tilde. */
static void hover_node(Plot *stage, const Pane *pane, int node)
{
    Paper *paper = stage->paper;
    const Simulation *simulation = pane->simulation;
    const System *system = &simulation->system;
    const double *x = pane_x(pane), *v = simulation->run[0].v;
    double h = simulation->options.timestep, force[2], tilde[2], at[2];
    Lines lines = {0};
    char mass[48];
    plot_number(mass, sizeof mass, system->m[node]);
    node_force(system, x, node, force);
    for (int k = 0; k < 2; k++)
        tilde[k] = pane->trace && pane->trace->x_tilde
                       ? pane->trace->x_tilde[2 * node + k]
                       : x[2 * node + k] + h * v[2 * node + k];
    snprintf(next_line(&lines), HOVER_TEXT, "node %d%s", node,
             system->pinned && system->pinned[node] ? ", pinned" : "");
    snprintf(next_line(&lines), HOVER_TEXT, "m = %s kg", mass);
    add_vector(&lines, "{x}", x + 2 * (size_t)node, "m");
    add_vector(&lines, "v", v + 2 * (size_t)node, "m/s");
    add_vector(&lines, "f", force, "N");
    add_vector(&lines, "{xt}", tilde, "m");
    plot_place(stage, x + 2 * (size_t)node, at);
    Box box = plot_note(stage, at[0], at[1], paper_pixels(paper, WIDTH),
                        paper_pixels(paper, LINE * lines.count),
                        body_box(stage, pane));
    draw_lines(paper, &box, &lines);
}

/* The block [[H, -H], [-H, H]], number by number. */
static void draw_block(Paper *paper, Box *box, const double H[3])
{
    const double part[2][2] = {{H[0], H[1]}, {H[1], H[2]}};
    double most = fmax(fabs(H[0]), fmax(fabs(H[1]), fabs(H[2])));
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            char number[48];
            double value = part[i % 2][j % 2] * (i / 2 == j / 2 ? 1 : -1);
            if (fabs(value) < 1e-9 * most)
                value = 0;
            plot_number(number, sizeof number, value);
            paper_write(paper, FACE_REGULAR, 0.78,
                        value == 0 ? COLOUR_GREY : COLOUR_TEXT,
                        box->x + (j + 1) * CELL * paper->em, box->y,
                        ALIGN_RIGHT, "%s", number);
        }
        box->y += paper_pixels(paper, 1.15);
    }
    box->y += paper_pixels(paper, 0.3);
}

/* Four pairs of bars: hollow before projection, filled after it. */
static void draw_eigenvalues(Paper *paper, Box *box, const double before[4],
                             const double after[4])
{
    double most = 1e-300, low = 0;
    bool finite = true;
    int width = paper_pixels(paper, 1.1), room = paper_pixels(paper, BARS);
    for (int k = 0; k < 4; k++) {
        most = fmax(most, fmax(fabs(before[k]), fabs(after[k])));
        low = fmin(low, before[k]);
        finite = finite && isfinite(before[k]) && isfinite(after[k]);
    }
    double high = fmax(most, -low) - low;
    if (!finite || !isfinite(high))
        return; /* nothing that a bar could show */
    double scale = 0.6 * room / high;
    int base = box->y + (int)(0.62 * room + low * scale);
    for (int k = 0; k < 4; k++) {
        int x = box->x + (int)((k + 0.25) * CELL * paper->em);
        int tall[2] = {(int)(before[k] * scale), (int)(after[k] * scale)};
        for (int b = 0; b < 2; b++) {
            int top = base - (tall[b] > 0 ? tall[b] : 0);
            int size = abs(tall[b]) < 2 ? 2 : abs(tall[b]);
            Colour colour = b == 1          ? COLOUR_X
                            : before[k] < 0 ? COLOUR_PROJECT
                                            : COLOUR_GREY;
            canvas_rectangle(&paper->canvas, x + b * (width + 2), top, width,
                             size, colour);
        }
        char number[48];
        plot_number(number, sizeof number, before[k]);
        paper_write(paper, FACE_REGULAR, 0.78,
                    before[k] < 0 ? COLOUR_PROJECT : COLOUR_FAINT, x + width,
                    box->y + 0.64 * room, ALIGN_CENTRE, "%s", number);
    }
    box->y += room;
}

/* e, l2, strain, block, eigenvalues. */
static void hover_spring(Plot *stage, const Show *show, const Pane *pane, int s)
{
    Paper *paper = stage->paper;
    const System *system = &pane->simulation->system;
    const double *x = pane_x(pane);
    int i = system->e[2 * s], j = system->e[2 * s + 1];
    double k = system->k[s], l2 = system->l2[s], tau, bend, at[2];
    const double d[2] = {x[2 * i] - x[2 * j], x[2 * i + 1] - x[2 * j + 1]};
    double d2 = d[0] * d[0] + d[1] * d[1];
    spring_law(system, s, (d2 - l2) / l2, &tau, &bend);
    /* Eigenvalues of the 4x4 block are 0, 0 and twice those of
     * H = 2k/l2 (l2 tau I + 2 tau' d d^T). */
    const double H[3] = {2 * k / l2 * (l2 * tau + 2 * bend * d[0] * d[0]),
                         2 * k / l2 * 2 * bend * d[0] * d[1],
                         2 * k / l2 * (l2 * tau + 2 * bend * d[1] * d[1])};
    double before[4] = {0, 0, 4 * k * tau,
                        4 * k / l2 * (2 * bend * d2 + l2 * tau)};
    double after[4] = {0, 0, before[2], before[3]};
    Filter filter = pane->simulation->options.filter;
    for (int m = 2; m < 4; m++)
        if (before[m] < 0 && filter != FILTER_NONE)
            after[m] = filter == FILTER_ABS ? -before[m] : 0;
    Lines lines = {0};
    char number[48], rest[48];
    plot_number(number, sizeof number,
                100 * (math_hypot(d[0], d[1]) / sqrt(l2) - 1));
    plot_number(rest, sizeof rest, l2);
    snprintf(next_line(&lines), HOVER_TEXT, "spring %d\u2013%d", i, j);
    snprintf(next_line(&lines), HOVER_TEXT,
             "l\u00b2 = %s m\u00b2,  strain %s %%", rest, number);
    snprintf(next_line(&lines), HOVER_TEXT,
             "its block of \u2207\u00b2P, J/m\u00b2");
    int height = paper_pixels(paper, LINE * (lines.count + 1)) +
                 paper_pixels(paper, 4 * 1.15 + 0.3 + BARS);
    plot_place(stage, show->hover.point, at);
    Box box =
        plot_note(stage, at[0], at[1], paper_pixels(paper, 4 * CELL + 0.3),
                  height, body_box(stage, pane));
    draw_lines(paper, &box, &lines);
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

void hover_square(Plot *stage, const Show *show)
{
    const Pane *pane = &show->pane[stage->pane];
    const Pick *hover = &show->hover;
    const System *system = &pane->simulation->system;
    if (hover->kind == PICK_NODE && hover->index < system->nodes &&
        is_placed(pane, hover->index))
        hover_node(stage, pane, hover->index);
    if (hover->kind == PICK_SPRING && hover->index < system->springs &&
        is_placed(pane, system->e[2 * hover->index]) &&
        is_placed(pane, system->e[2 * hover->index + 1]))
        hover_spring(stage, show, pane, hover->index);
}
