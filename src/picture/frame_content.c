/* frame_content.c - cameras of the panes, what the mouse finds on the stage,
 * and the drawing of a whole frame. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "base/mathematics.h"

static const double WORDS_ROOM = 1.8;  /* ems, of a legend or a label */
static const double LOW = 20;          /* ems, a pane has no room below words */
static const double LEAST_TEXT = 11;   /* ems, a pane with words is high */
static const double HANDLE_REACH = 14; /* pixels, a handle is hit within */
static const double SWITCH_WIDE = 13;  /* ems */
static const double SWITCH_HIGH = 1.8;

const Picture *picture_of(const struct Scene *scene)
{
    return &pictures[scene->picture];
}

bool frame_has_card(const FrameContent *content, const char *name)
{
    const Picture *picture =
        picture_of(active_pane(content)->simulation->scene);
    int card = picture_card(picture, name);
    return card >= 0 && !(content->cards.hidden >> card & 1);
}

int picture_card(const Picture *picture, const char *name)
{
    for (int c = 0; c < picture->count; c++)
        if (strcmp(picture->cards[c]->name, name) == 0)
            return c;
    return -1;
}

void frame_create(const Simulation *simulation, FrameContent *content)
{
    const Picture *picture = picture_of(simulation->scene);
    static const View whole = {.lens = {1, {0, 0}}};
    *content = (FrameContent){
        .panes = 1, .view = &whole, .settings.selected = -1, .cards.large = -1};
    content->pane[0].simulation = simulation;
    for (int c = 0; c < picture->count; c++) {
        content->cards.closed |= (unsigned)picture->cards[c]->starts_closed
                                 << c;
        content->cards.hidden |= (unsigned)picture->cards[c]->only_in_lecture
                                 << c;
    }
}

bool cards_need_line_energy(const Simulation *simulation, unsigned toggled)
{
    const Picture *picture = picture_of(simulation->scene);
    const LecturePage *page = simulation->options.page;
    for (int c = 0; c < picture->count; c++) {
        const Card *card = picture->cards[c];
        bool there = page ? strstr(page->cards, card->name) != NULL
                          : !card->only_in_lecture;
        bool closed = (card->starts_closed && !page) != (toggled >> c & 1);
        if (card->needs_line_energy && there && !closed)
            return true;
    }
    return false;
}

/* The box of a pane without what words need of it. */
static Box pane_room(const FrameContent *content, const Layout *layout,
                     int pane)
{
    const Simulation *simulation = content->pane[pane].simulation;
    bool stretched = picture_of(simulation->scene)->stretched;
    Box room = layout->pane[pane];
    int words = (int)(WORDS_ROOM * layout->em); /* above, and some below */
    if (content->lecture.page &&
        (content->panes > 1 || room.height < LOW * layout->em)) {
        box_cut_off(&room, EDGE_TOP, stretched ? 2 * words : words);
        box_cut_off(&room, EDGE_BOTTOM,
                    content->panes > 1 || stretched ? words : 0);
    }
    return room;
}

/* The part of the world that a pane would show by itself. */
static void own_bounds(const FrameContent *content, const Layout *layout,
                       int pane, double bounds[4])
{
    const Plot stage = {.content = content,
                        .simulation = content->pane[pane].simulation,
                        .box = pane_room(content, layout, pane),
                        .pane = pane};
    const Picture *picture = picture_of(stage.simulation->scene);
    if (picture->bounds)
        picture->bounds(&stage, bounds);
    else
        memcpy(bounds, picture->default_bounds, sizeof picture->default_bounds);
}

/* The part of the world that fits a pane; all panes of a page have that of the
 * last one, unless what is in them has left it. */
static void find_bounds(const FrameContent *content, const Layout *layout,
                        int pane, double bounds[4])
{
    const Held *held = &content->view->held;
    int last = content->lecture.page ? content->panes - 1 : pane;
    double own[4];
    if (held->on && !held->away && (held->pane == pane || held->pane == last)) {
        memcpy(bounds, held->bounds, sizeof held->bounds);
        return;
    }
    own_bounds(content, layout, last, bounds);
    if (last == pane)
        return;
    own_bounds(content, layout, pane, own);
    if (own[0] < bounds[0] || own[1] < bounds[1] || own[2] > bounds[2] ||
        own[3] > bounds[3])
        memcpy(bounds, own, sizeof own);
}

Plot stage_create(Paper *paper, const FrameContent *content,
                  const Layout *layout, int pane)
{
    Plot stage = {.paper = paper,
                  .content = content,
                  .simulation = content->pane[pane].simulation,
                  .box = layout->pane[pane],
                  .revealed =
                      content->lecture.page && !content->lecture.hides_answer,
                  .pane = pane,
                  .has_text = !content->bare,
                  .em = layout->em};
    double bounds[4];
    bool stretched = picture_of(stage.simulation->scene)->stretched;
    Box room = pane_room(content, layout, pane), beside;
    find_bounds(content, layout, pane, bounds);
    stage.camera = camera_create(room, bounds, stretched, &content->view->lens);
    beside = room; /* of the switches, where it is no smaller there */
    box_cut_off(&beside, EDGE_RIGHT, (int)(SWITCH_WIDE * layout->em));
    const Camera there =
        camera_create(beside, bounds, stretched, &content->view->lens);
    Switch out[SCENE_MAX_SWITCHES];
    if (stage.has_text && beside.width > 0 &&
        there.scale[0] >= stage.camera.scale[0] &&
        exhibit_switches(stage.simulation, out) > 0)
        stage.camera = there;
    return stage;
}

Camera camera_of_pane(const FrameContent *content, const Layout *layout,
                      int pane)
{
    return stage_create(NULL, content, layout, pane).camera;
}

Held frame_hold_bounds(const FrameContent *content, const Layout *layout,
                       int pane)
{
    Held held = {.on = true, .pane = pane};
    find_bounds(content, layout, pane, held.bounds);
    return held;
}

/* ---- what the mouse can drag and switch, and finds ----------------------- */

void stage_handles(const Plot *stage)
{
    double at[SCENE_MAX_HANDLES][2];
    int count = exhibit_handles(stage->simulation, at);
    const Pick *hover = &stage->content->view->hover;
    for (int i = 0; i < count && !stage->content->bare; i++) {
        bool over = hover->kind == PICK_HANDLE && hover->pane == stage->pane &&
                    hover->index == i;
        plot_ring(stage, at[i], (over ? 13 : 10), over ? 3 : 1.8, COLOUR_HAND);
    }
}

static Box switch_box(const Plot *stage, int i)
{
    const Box *box = &stage->box;
    int wide = (int)(SWITCH_WIDE * stage->em);
    int high = (int)(SWITCH_HIGH * stage->em), gap = (int)(0.4 * stage->em);
    return (Box){box->x + box->width - wide - gap,
                 box->y + 3 * gap + i * (high + gap) + high, wide, high};
}

/* The scene's switches as chips in the upper right corner. */
static void stage_switches(const Plot *stage)
{
    Paper *paper = stage->paper;
    Switch out[SCENE_MAX_SWITCHES];
    int count = exhibit_switches(stage->simulation, out);
    for (int i = 0; i < count && stage->has_text; i++) {
        Box box = switch_box(stage, i), mark = box_inset(box, box.height / 4);
        bool on = out[i].on;
        canvas_framed_box(&paper->canvas, box, on ? COLOUR_LIT : COLOUR_CHIP,
                          COLOUR_BORDER);
        mark.width = mark.height;
        canvas_framed_box(&paper->canvas, mark,
                          on ? COLOUR_VALUE : COLOUR_WHITE, COLOUR_FAINT);
        box.x += 2 * mark.width;
        box.width -= 2 * mark.width;
        paper_fit(paper, FACE_REGULAR, 0.92, on ? COLOUR_TEXT : COLOUR_FAINT,
                  box, ALIGN_LEFT, out[i].label);
    }
}

/* The guess is a cross; along x alone a line from top to bottom, too; and where
 * the step led: over any picture. */
static void stage_prediction(const Plot *stage)
{
    const Prediction *guess = &stage->simulation->prediction;
    const Box *box = &stage->box;
    Canvas *canvas = &stage->paper->canvas;
    double unit = stage->paper->unit, arm = 7 * unit, at[2], came[2], point[2];
    if (!guess->made || stage->content->bare)
        return;
    plot_pixel(stage, guess->at, at);
    plot_pixel(stage, guess->came, came);
    if (simulation_point(stage->simulation, point) == 1) {
        canvas_line(canvas, at[0], box->y + box->height, at[0], box->y,
                    1.5 * unit, COLOUR_HAND);
        came[1] = at[1];
    }
    for (int k = -1; k <= 1; k += 2)
        canvas_line(canvas, at[0] - arm, at[1] - k * arm, at[0] + arm,
                    at[1] + k * arm, 3 * unit, COLOUR_HAND);
    canvas_dashes(canvas, at, came, 1.6 * unit, unit, NULL, COLOUR_HAND);
    plot_label(stage, 1, guess->at, COLOUR_HAND, "your guess, %s off",
               format_number(guess->distance).text);
}

Pick frame_pick(const FrameContent *content, const Layout *layout, double x,
                double y)
{
    Hit hit = layout_hit(layout, x, y);
    Pick pick = {.kind = PICK_NONE, .near = -1};
    if (hit.zone != ZONE_STAGE || hit.index >= content->panes)
        return pick;
    Plot stage = stage_create(NULL, content, layout, hit.index);
    const Picture *picture = picture_of(stage.simulation->scene);
    pick.pane = hit.index;
    camera_world(&stage.camera, x, y, pick.point);
    double at[SCENE_MAX_HANDLES][2];
    Switch out[SCENE_MAX_SWITCHES];
    int handles = exhibit_handles(stage.simulation, at);
    int switches = exhibit_switches(stage.simulation, out);
    for (int i = 0; i < switches && stage.has_text && !picture->own_handles;
         i++)
        if (box_contains(switch_box(&stage, i), x, y)) {
            pick.kind = PICK_SWITCH;
            pick.index = i;
            return pick;
        }
    if (!picture->own_handles &&
        plot_pick_point(&stage, handles, *at, HANDLE_REACH, x, y, PICK_HANDLE,
                        &pick))
        return pick;
    pick.kind = picture->takes_clicks ? PICK_PLACE : PICK_NONE;
    if (picture->pick)
        picture->pick(&stage, x, y, &pick);
    return pick;
}

long frame_find_step(const FrameContent *content, const Layout *layout,
                     double x)
{
    const Box *bars = &layout->bars;
    double step =
        (x - bars->x) / fmax(bars->width, 1) * time_line_steps(content);
    return (long)fmin(fmax(step < 0.25 ? 0 : floor(step) + 1, 0),
                      content->time_line.steps);
}

const double *pane_x(const Pane *pane)
{
    return pane->x ? pane->x : pane->simulation->run[0].x;
}

int picture_sample(const Simulation *simulation, Energy row[HISTORY_SERIES])
{
    const Picture *picture = picture_of(simulation->scene);
    return picture->sample ? picture->sample(simulation, row) : 0;
}

/* ---- history ------------------------------------------------------------ */

void history_add(History *history, double time, int rows, const Energy *row)
{
    double sum = time;
    for (int i = 0; i < rows; i++)
        sum += 0 * row[i].value; /* NaN where it is not finite */
    if (!isfinite(sum) || history->count == HISTORY_POINTS)
        return;
    int last = history->count++;
    history->time[last] = time;
    for (int s = 0; s < history->series; s++)
        history->value[s][last] = 0;
    for (int i = 0; i < rows; i++) {
        const char *name = row[i].name; /* most often that of series i */
        int s = i < history->series && history->name[i] == name ? i : 0;
        while (s < history->series && strcmp(history->name[s], name) != 0)
            s++;
        if (s == HISTORY_SERIES)
            continue; /* there is no room */
        if (s == history->series) {
            history->name[history->series++] = name;
            memset(history->value[s], 0, sizeof history->value[s]);
        }
        history->value[s][last] = row[i].value;
    }
}

/* ---- all of it ----------------------------------------------------------- */

enum { LABEL = 4 * VALUE_SIZE };

/* The first parts of a label, with ", " between, that fit into a line.  Returns
 * what is left of it.
 *   line  [LABEL] out */
static const char *take_line(const Plot *stage, const char *label, char *line)
{
    int room = (int)(stage->box.width - stage->em);
    char *comma;
    snprintf(line, LABEL, "%s", label);
    while (paper_width(stage->paper, FACE_BOLD, 1, line) > room &&
           (comma = strrchr(line, ',')))
        *comma = '\0';
    label += strlen(line);
    return label + strspn(label, ", ");
}

/* What is different in a pane, in as many lines as it takes, above the scale
 * where it is long. */
static void draw_label(const Plot *stage, const char *label)
{
    enum { LINES = 3 };
    Paper *paper = stage->paper;
    const Box *box = &stage->box;
    char line[LINES][LABEL];
    int lines = 0, wide = 0;
    while (*label && lines < LINES) {
        label = take_line(stage, label, line[lines]);
        int own = paper_width(paper, FACE_BOLD, 1, line[lines++]);
        wide = own > wide ? own : wide;
    }
    bool high = wide > box->width - 10 * paper->em;
    double low = box->y + box->height - (high ? 4.2 : 1.7) * paper->em;
    for (int i = 0; i < lines; i++)
        paper_panel(paper, FACE_BOLD, 1, colour_of_run(stage->pane),
                    box->x + 0.5 * box->width,
                    low - 1.36 * (lines - 1 - i) * paper->em, ALIGN_CENTRE,
                    line[i]);
}

/* One pane, its words, where it is not alone its label in the colour of its
 * curve, and what the mouse is over in it. */
static void draw_pane(Paper *paper, const Layout *layout,
                      const FrameContent *content, int pane)
{
    Plot stage = stage_create(paper, content, layout, pane);
    const Picture *picture = picture_of(stage.simulation->scene);
    const Pick *hover = &content->view->hover;
    Box before = canvas_set_clip(&paper->canvas, stage.box);
    if (content->lecture.page && stage.box.height < LEAST_TEXT * paper->em)
        stage.has_text = false; /* a star has taken its room */
    picture->draw(&stage);
    TextLine line = text_begin(&content->pane[pane].values, picture->legend);
    while (stage.has_text && text_next_line(&line))
        plot_legend(&stage, line.colour, "%s", line.words);
    if (stage.has_text && picture->shows_scale)
        plot_scale(&stage);
    if (!picture->own_handles)
        stage_handles(&stage);
    stage_switches(&stage);
    stage_prediction(&stage);
    if (layout->panes > 1 && content->pane[pane].label)
        draw_label(&stage, content->pane[pane].label);
    if (picture->hover && stage.has_text && hover->pane == pane &&
        hover->kind != PICK_NONE && !content->hand)
        picture->hover(&stage);
    canvas_set_clip(&paper->canvas, before);
}

/* A scene on the sheet: its bare picture, its name, over it the heading of the
 * group that it begins. */
static void draw_sheet_cell(Paper *paper, Box box, const SheetCell *cell,
                            bool chosen)
{
    Layout layout = {.em = paper->em, .panes = 1, .pane = {box}};
    Box *inside = &layout.pane[0];
    inside->height = box.width;
    if (cell->group)
        paper_write(paper, FACE_BOLD, 1.05, COLOUR_TEXT, box.x,
                    box.y - 1.7 * paper->em, ALIGN_LEFT, "%s", cell->group);
    canvas_framed_box(&paper->canvas, *inside, COLOUR_WHITE,
                      chosen ? COLOUR_VALUE : COLOUR_BORDER);
    if (chosen)
        canvas_framed_box(&paper->canvas, box_inset(*inside, 1), COLOUR_WHITE,
                          COLOUR_VALUE);
    *inside = box_inset(*inside, paper_pixels(paper, 0.3));
    if (cell->simulation) {
        FrameContent content;
        frame_create(cell->simulation, &content);
        content.bare = true;
        content.strain = cell->simulation->scene->strain_colour_max > 0;
        draw_pane(paper, &layout, &content, 0);
    }
    Box name = {box.x, box.y + box.width, box.width, box.height - box.width};
    paper_fit(paper, chosen ? FACE_BOLD : FACE_REGULAR, 1,
              chosen ? COLOUR_VALUE : COLOUR_TEXT, name, ALIGN_CENTRE,
              cell->name);
}

/* White paper with letters of this size, pixels. */
static void begin_paper(Paper *paper, double em, const FrameContent *content)
{
    paper->em = em;
    paper->unit = em / 14;
    paper->min_letter = content->lecture.page ? 1 : 0;
    canvas_clear(&paper->canvas, COLOUR_WHITE);
}

void frame_draw_card(Paper *paper, const FrameContent *content, int card)
{
    const Canvas *canvas = &paper->canvas;
    begin_paper(paper, content->min_em, content);
    card_draw(paper,
              box_inset((Box){0, 0, canvas->width, canvas->height},
                        paper_pixels(paper, 0.4)),
              content, card);
    highlight_draw(paper, content);
}

void frame_draw(Paper *paper, const FrameContent *content)
{
    Layout layout =
        layout_create(content, paper->canvas.width, paper->canvas.height);
    begin_paper(paper, layout.em, content);
    for (int i = 0; i < layout.cells; i++)
        draw_sheet_cell(paper, layout.cell[i], &content->sheet.cell[i],
                        i == content->view->chosen);
    if (layout.cells > 0) {
        if (!content->document)
            window_rows_draw(paper, &layout, content);
        return;
    }
    if (layout.panes > 1) /* lines between them */
        canvas_fill(&paper->canvas, layout.stage, COLOUR_RULE);
    for (int pane = 0; pane < layout.panes; pane++) {
        if (layout.panes > 1)
            canvas_fill(&paper->canvas, layout.pane[pane], COLOUR_WHITE);
        draw_pane(paper, &layout, content, pane);
    }
    if (content->bare)
        return;
    if (content->document) {
        highlight_draw(paper, content);
        return;
    }
    if (content->column != COLUMN_CARDS)
        canvas_fill(&paper->canvas, layout.column, COLOUR_WHITE);
    cards_draw(paper, &layout, content);
    highlight_draw(paper, content);
    window_rows_draw(paper, &layout, content);
}
