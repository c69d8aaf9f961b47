/* texts.c - what the frames say: every text that is drawn, as a line of JSON,
 * with the states it speaks of; checks/frame_numbers.py calculates the numbers
 * in it again.  It is told on standard input what to do, a line each:
 *   begin OPTIONS...         another run
 *   run N                    so many steps of it
 *   hover spring|node NUMBER the mouse is there; hover none 0: nowhere
 *   frame NAME               draws and writes
 *   anything else            a command of a script
 */
#include "attended.h"

#include <math.h>

#include "model/cells.h"
#include "model/contact.h"
#include "model/friction.h"
#include "model/pull_energy.h"
#include "picture/picture.h"
#include "picture/plot.h"
#include "picture/text.h"
#include "scenes/scene.h"

enum { WIDE = 1600, HIGH = 1200, MOST = 600, PLOTS = 12 };

static struct {
    double x, y;
    char words[400];
} texts[MOST];
static Plot plots[PLOTS];                       /* whose axes were written */
static int first_tick[PLOTS], last_tick[PLOTS]; /* texts of each */
static int count, drawn;
static bool listens, within; /* the lines of a paragraph are one text */

static void keep(double x, double y, const char *words)
{
    if (!listens || !words[0])
        return;
    assert_true(count < MOST);
    texts[count].x = x;
    texts[count].y = y;
    snprintf(texts[count++].words, sizeof texts[0].words, "%s", words);
}

int __real_text_draw(Text *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup);
int __wrap_text_draw(Text *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup);
int __real_paper_paragraph(Paper *paper, Face face, double size, Colour colour,
                           Box box, int lines, const char *markup);
int __wrap_paper_paragraph(Paper *paper, Face face, double size, Colour colour,
                           Box box, int lines, const char *markup);

int __wrap_text_draw(Text *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup)
{
    if (!within && !style->plain) /* code is none of its words */
        keep(x, y, markup);
    return __real_text_draw(text, canvas, style, x, y, align, markup);
}

int __wrap_paper_paragraph(Paper *paper, Face face, double size, Colour colour,
                           Box box, int lines, const char *markup)
{
    if (lines > 0)
        keep(box.x, box.y, markup);
    within = true;
    int used =
        __real_paper_paragraph(paper, face, size, colour, box, lines, markup);
    within = false;
    return used;
}

static Plot keep_plot(Plot plot, int first)
{
    assert_true(drawn < PLOTS);
    first_tick[drawn] = first;
    last_tick[drawn] = count;
    plots[drawn++] = plot;
    return plot;
}

Plot __real_plot_create(Paper *paper, Box outer, Axis x, Axis y);
Plot __wrap_plot_create(Paper *paper, Box outer, Axis x, Axis y);
Plot __real_plot_on(const Plot *stage, const PlotRoom *room, Axis x, Axis y);
Plot __wrap_plot_on(const Plot *stage, const PlotRoom *room, Axis x, Axis y);

Plot __wrap_plot_create(Paper *paper, Box outer, Axis x, Axis y)
{
    int first = count;
    return keep_plot(__real_plot_create(paper, outer, x, y), first);
}

/* Where there is no room for words, axes have no numbers. */
Plot __wrap_plot_on(const Plot *stage, const PlotRoom *room, Axis x, Axis y)
{
    int first = count;
    Plot plot = __real_plot_on(stage, room, x, y);
    return plot.text ? keep_plot(plot, first) : plot;
}

/* ---- JSON --------------------------------------------------------------- */

static void put_number(double value)
{
    if (isfinite(value))
        printf("%.17g", value);
    else
        printf("%s", isnan(value) ? "NaN"
                     : value > 0  ? "Infinity"
                                  : "-Infinity");
}

static void put_numbers(const char *name, const double *value, int size)
{
    printf(",\"%s\":[", name);
    for (int i = 0; value && i < size; i++) {
        printf("%s", i ? "," : "");
        put_number(value[i]);
    }
    printf("]");
}

static void put_whole(const char *name, const int *value, int size)
{
    printf(",\"%s\":[", name);
    for (int i = 0; value && i < size; i++)
        printf("%s%d", i ? "," : "", value[i]);
    printf("]");
}

static void put_words(const char *words)
{
    printf("\"");
    for (; *words; words++) {
        if (*words == '"' || *words == '\\')
            printf("\\");
        printf("%c", *words);
    }
    printf("\"");
}

/* Masses, springs, triangles: they stay from step to step. */
static void put_mesh(const System *system)
{
    const Term *term = system_find_term(system, &cell_energy);
    const Cells *cells = term ? term->data : NULL;
    put_numbers("m", system->m, system->nodes);
    put_numbers("l2", system->l2, system->springs);
    put_whole("e", system->e, 2 * system->springs);
    if (!cells)
        return;
    const double shape[] = {cells->area, cells->c};
    put_whole("cells", cells->node, 3 * cells->triangles);
    put_whole("sides", cells->spring, 3 * cells->triangles);
    put_numbers("shape", shape, 2);
}

/* What is given, and not calculated: numbers of the command line, and where
 * obstacles are now. */
static void put_given(const Simulation *simulation)
{
    const Options *o = &simulation->options;
    const System *system = &simulation->system;
    const Contact *contact = contact_of(system);
    printf(",\"scene\":\"%s\",\"filter\":\"%s\",\"search\":\"%s\","
           "\"solver\":\"%s\"",
           simulation->scene->name, filter_name(o->filter),
           line_search_name(o->line_search), solver_name(o->solver));
    const double given[] = {
        o->timestep,  o->stiffness, o->tolerance, o->stretch,    o->side,
        o->density,   o->friction,  o->damping,   o->slip_speed, o->yield,
        o->hardening, o->segments,  o->gravity};
    put_numbers("given", given, sizeof given / sizeof *given);
    put_numbers("k", system->k, system->springs);
    put_numbers("g", system->gravity, 2);
    int pinned[4096];
    for (int i = 0; system->pinned && i < system->nodes; i++)
        pinned[i] = system->pinned[i];
    put_whole("pinned", system->pinned ? pinned : NULL, system->nodes);
    put_numbers("target", simulation->exhibit.target, 2);
    put_numbers("guess", simulation->prediction.at, 2);
    int parts = (int)simulation->exhibit.parts;
    put_whole("parts", &parts, 1);
    const int cell[] = {simulation->exhibit.map.column,
                        simulation->exhibit.map.row};
    put_whole("cell", cell, 2);
    const double field[] = {
        system_find_term(system, &central_field)
            ? ((Pull *)system_find_term(system, &central_field)->data)->k
            : 0};
    put_numbers("omega2", field, 1);
    const Pull *hand = hand_energy_of(system);
    if (hand) {
        const double pull[] = {hand->node, hand->k, hand->target[0],
                               hand->target[1]};
        put_numbers("hand", pull, 4);
    }
    if (contact)
        put_numbers("barrier", &contact->barrier.d_hat, 2);
    printf(",\"obstacles\":[");
    for (int r = 0; r < simulation->runs; r++) {
        const Contact *own = contact_of(simulation->run[r].system);
        for (int i = 0; own && i < own->obstacles; i++) {
            const Obstacle *b = &own->obstacle[i];
            const double row[] = {r,       b->kind, b->o[0],   b->o[1],
                                  b->n[0], b->n[1], b->radius, b->friction,
                                  b->node, b->v[0], b->v[1]};
            printf("%s", r + i ? "," : "");
            printf("{\"r\":0");
            put_numbers("b", row, 11);
            printf("}");
        }
    }
    printf("]");
}

/* Positions, velocities: the state after the player's step.  stepped: it was
 * made from the one before, with the same mesh. */
static void put_state(bool stepped)
{
    for (int i = 0; i < past_panes(&player.past); i++) {
        const Simulation *simulation = &machine(i)->simulation;
        printf("{\"state\":%ld,\"lane\":%d,\"line\":", player.past.step, i);
        put_words(player.line);
        printf(",\"time\":%.17g", simulation_time(simulation));
        put_given(simulation);
        if (!stepped)
            put_mesh(&simulation->system);
        printf(",\"runs\":[");
        for (int r = 0; r < simulation->runs; r++) {
            const TimeIntegrator *run = &simulation->run[r];
            int size = 2 * simulation->system.nodes;
            printf("%s{\"method\":\"%s\"", r ? "," : "",
                   run->method ? run->method->name : "");
            put_numbers("x", run->x, size);
            put_numbers("v", run->v, size);
            printf("}");
        }
        printf("]}\n");
    }
}

/* Where in the walk through a step the frame is. */
static void put_trace(const Pane *pane)
{
    const Trace *trace = pane->trace;
    int size = 2 * pane->simulation->system.nodes;
    if (!trace)
        return;
    printf(",\"trace\":{\"line\":%d,\"i\":%d,\"updates\":%d,\"trials\":%d,"
           "\"accepted\":%d,\"passed\":%d,\"given_up\":%d",
           trace->line, trace->iteration, trace->updates, trace->trials,
           trace->accepted, trace->passed, trace->given_up);
    put_numbers("x", trace->x, size);
    put_numbers("first", &trace->first, 1);
    printf("}");
}

static void put_frame(const char *name, Pick hover)
{
    Paper paper;
    Show *show = &player.show;
    assert_int_equal(paper_create(WIDE, HIGH, &paper), 0);
    show->hover = hover;
    player_sample(&player);
    player_fill(&player);
    count = drawn = 0;
    listens = true;
    show_draw(&paper, show);
    listens = false;
    Layout layout = show_layout(show, WIDE, HIGH);
    paper_free(&paper);
    printf("{\"frame\":");
    put_words(name);
    printf(",\"step\":%ld,\"newest\":%ld,\"active\":%d,\"lanes\":%d,"
           "\"hover\":[%d,%d],\"panes\":[",
           player.past.step, past_newest(&player.past), player.active,
           past_panes(&player.past), hover.kind, hover.index);
    for (int i = 0; i < show->panes; i++) {
        printf("%s{\"lane\":%d", i ? "," : "", i);
        put_numbers("x", pane_x(&show->pane[i]),
                    2 * show->pane[i].simulation->system.nodes);
        put_trace(&show->pane[i]);
        const double stage[] = {layout.pane[i].x,
                                show_camera(show, &layout, i).scale[0]};
        put_numbers("stage", stage, 2);
        printf("}");
    }
    printf("],\"plots\":[");
    for (int i = 0; i < drawn; i++) {
        const Plot *p = &plots[i];
        const double row[] = {p->box.x,      p->box.y,      p->box.width,
                              p->box.height, p->x.low,      p->x.high,
                              p->x.log,      p->y.low,      p->y.high,
                              p->y.log,      first_tick[i], last_tick[i]};
        printf("%s{\"r\":0", i ? "," : "");
        put_numbers("p", row, 12);
        printf("}");
    }
    printf("],\"texts\":[");
    for (int i = 0; i < count; i++) {
        printf("%s[%.6g,%.6g,", i ? "," : "", texts[i].x, texts[i].y);
        put_words(texts[i].words);
        printf("]");
    }
    printf("]}\n");
}

static void put_lists(void)
{
    printf("{\"pages\":[");
    for (const LecturePage *page = lecture_pages; page->name; page++)
        printf("%s\"%s\"", page > lecture_pages ? "," : "", page->name);
    printf("],\"claims\":[");
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        printf("%s", page > lecture_pages ? "," : "");
        put_words(page->claim);
    }
    printf("],\"scenes\":[");
    for (const Scene *scene = scenes; scene->name; scene++)
        printf("%s\"%s\"", scene > scenes ? "," : "", scene->name);
    printf("]}\n");
}

int main(void)
{
    char line[512];
    bool open = false;
    Pick hover = {0};
    put_lists();
    while (fgets(line, sizeof line, stdin)) {
        char *words = line + strcspn(line, " \n");
        line[strcspn(line, "\n")] = '\0';
        words += *words == ' ';
        if (strncmp(line, "begin ", 6) == 0) {
            if (open)
                end();
            begin(words);
            printf("{\"begin\":0}\n");
            open = true;
            hover = (Pick){0};
            player_sample(&player);
            put_state(false);
        } else if (strncmp(line, "run ", 4) == 0) {
            for (long left = atol(words); left > 0; left--) {
                Status status = player_step(&player);
                put_state(true);
                left = status ? 0 : left; /* beyond all numbers, or its end */
            }
        } else if (strncmp(line, "hover ", 6) == 0) {
            hover.kind = words[0] == 's'                      ? PICK_SPRING
                         : words[0] == 'n' && words[1] == 'o' ? PICK_NODE
                                                              : PICK_NONE;
            if (strncmp(words, "none", 4) == 0)
                hover.kind = PICK_NONE;
            hover.index = atoi(strchr(words, ' '));
        } else if (strncmp(line, "frame ", 6) == 0) {
            put_frame(words, hover);
        } else {
            obey(line);
            if (player.message[0])
                fprintf(stderr, "%s: %s\n", line, player.message);
            player.message[0] = '\0';
            put_state(false);
        }
    }
    if (open)
        end();
    return 0;
}
