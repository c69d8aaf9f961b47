/* picture.c - draws a frame; cameras of panes, and picking on the stage. */
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"

static const double LEGEND_ROOM = 1.8; /* ems, height of a line of the legend */
/* Heights in ems.  On a page a pane lower than LOW_PANE keeps room for words
 * above the picture; a pane lower than MIN_TEXT has no words. */
static const double LOW_PANE = 20, MIN_TEXT = 11;
static const double HANDLE_REACH = 14;   /* pixels, pick radius of a handle */
static const double SWITCH_WIDTH = 13;   /* ems */
static const double SWITCH_HEIGHT = 1.8; /* ems */

/* Returns the box of a pane without its rows of words above and below the
 * picture.  On a page a pane has the rows if its height is small, or if there
 * are several panes. */
static Box find_picture_room(const FrameContent *content, const Layout *layout,
                             int pane)
{
    const Simulation *simulation = content->pane[pane].simulation;
    bool stretched = picture_of_scene(simulation->scene)->is_stretched;
    bool several = content->panes > 1;
    Box room = layout->pane[pane];
    int words = (int)(LEGEND_ROOM * layout->em);
    if (content->lecture.page &&
        (several || room.height < LOW_PANE * layout->em)) {
        box_cut_off(&room, EDGE_TOP, stretched ? 2 * words : words);
        box_cut_off(&room, EDGE_BOTTOM, several || stretched ? words : 0);
    }
    return room;
}

/* Finds the part of the world that a pane would show if it were alone. */
static void find_lone_pane_bounds(const FrameContent *content,
                                  const Layout *layout, int pane,
                                  double bounds[4])
{
    const Plot stage = plot_create_in_box(
        NULL, content, &content->pane[pane],
        find_picture_room(content, layout, pane), layout->em);
    const Picture *picture = picture_of_scene(stage.simulation->scene);
    if (picture->find_bounds)
        picture->find_bounds(&stage, bounds);
    else
        memcpy(bounds, picture->default_bounds, sizeof picture->default_bounds);
}

/* Finds the part of the world that a pane shows.  On a page all panes share the
 * bounds of the last pane, except a pane whose own bounds reach farther. */
static void find_pane_bounds(const FrameContent *content, const Layout *layout,
                             int pane, double bounds[4])
{
    const DragBounds *held = &content->view->drag_bounds;
    int last = content->lecture.page ? content->panes - 1 : pane;
    double own[4];
    if (held->is_dragging && !held->is_mouse_off_stage &&
        (held->pane_index == pane || held->pane_index == last)) {
        memcpy(bounds, held->bounds, sizeof held->bounds);
        return;
    }
    find_lone_pane_bounds(content, layout, last, bounds);
    if (last == pane)
        return;
    find_lone_pane_bounds(content, layout, pane, own);
    if (own[0] < bounds[0] || own[1] < bounds[1] || own[2] > bounds[2] ||
        own[3] > bounds[3])
        memcpy(bounds, own, sizeof own);
}

/* Lists the switches on the stage; a document has them beside the picture. */
static int list_switches(const Plot *stage, SceneSwitch out[SCENE_MAX_SWITCHES])
{
    return stage->has_text && !stage->content->has_document
               ? exhibit_list_switches(stage->simulation, out)
               : 0;
}

Plot stage_create(Paper *paper, const FrameContent *content,
                  const Layout *layout, int pane)
{
    const Lens *lens = &content->view->lens;
    Plot stage = plot_create_in_box(paper, content, &content->pane[pane],
                                    layout->pane[pane], layout->em);
    double bounds[4];
    stage.has_text = !content->is_bare;
    bool stretched = picture_of_scene(stage.simulation->scene)->is_stretched;
    Box room = find_picture_room(content, layout, pane);
    SceneSwitch switches[SCENE_MAX_SWITCHES];
    find_pane_bounds(content, layout, pane, bounds);
    stage.camera = camera_create(room, bounds, stretched, lens);
    if (list_switches(&stage, switches) == 0)
        return stage;
    /* The picture moves left of the switches if the picture keeps its size. */
    box_cut_off(&room, EDGE_RIGHT, (int)(SWITCH_WIDTH * layout->em));
    const Camera left = camera_create(room, bounds, stretched, lens);
    if (room.width > 0 && left.scale[0] >= stage.camera.scale[0])
        stage.camera = left;
    return stage;
}

Camera make_pane_camera(const FrameContent *content, const Layout *layout,
                        int pane)
{
    return stage_create(NULL, content, layout, pane).camera;
}

DragBounds frame_find_view_bounds(const FrameContent *content,
                                  const Layout *layout, int pane)
{
    DragBounds held = {.is_dragging = true, .pane_index = pane};
    find_pane_bounds(content, layout, pane, held.bounds);
    return held;
}

/* ---- handles, switches, guesses ------------------------------------------ */

void stage_draw_handles(const Plot *stage)
{
    double at[SCENE_MAX_HANDLES][2];
    int count = exhibit_list_handles(stage->simulation, at);
    const Pick *hover = &stage->content->view->hovered_part;
    for (int i = 0; i < count && !stage->content->is_bare; i++) {
        bool over = hover->kind == PICK_HANDLE && hover->index == i &&
                    hover->pane_index == plot_pane_index(stage);
        plot_ring(stage, at[i], over ? 13 : 10, over ? 3 : 1.8, COLOUR_HAND);
    }
}

static Box find_switch_box(const Plot *stage, int i, int count)
{
    const Box *box = &stage->box;
    int wide = (int)(SWITCH_WIDTH * stage->em);
    int high = (int)(SWITCH_HEIGHT * stage->em), gap = (int)(0.4 * stage->em);
    bool narrow = box->width < 3 * wide; /* the legend fills the top */
    int top =
        narrow ? box->height - (count + 1) * (high + gap) : high + 3 * gap;
    return (Box){box->x + box->width - wide - gap,
                 box->y + top + i * (high + gap), wide, high};
}

/* Draws the scene's switches as chips in a corner of the stage. */
static void draw_switches(const Plot *stage)
{
    Paper *paper = stage->paper;
    SceneSwitch switches[SCENE_MAX_SWITCHES];
    int count = list_switches(stage, switches);
    for (int i = 0; i < count; i++) {
        Box box = find_switch_box(stage, i, count),
            mark = box_inset(box, box.height / 4);
        bool on = switches[i].is_on;
        Colour colour = stage->simulation->options.layers & LAYER_SPRING_KINDS
                            ? colour_of_spring_kind(i)
                            : COLOUR_VALUE;
        canvas_framed_box(&paper->canvas, box, on ? COLOUR_LIT : COLOUR_CHIP,
                          COLOUR_BORDER);
        mark.width = mark.height;
        canvas_framed_box(&paper->canvas, mark, on ? colour : COLOUR_WHITE,
                          COLOUR_FAINT);
        box_cut_off(&box, EDGE_LEFT, 2 * mark.width);
        paper_write_in_box(paper, FACE_REGULAR, 0.92,
                           on ? COLOUR_TEXT : COLOUR_FAINT, box, ALIGN_LEFT,
                           switches[i].label);
    }
}

/* Draws the user's guess as a cross, with a vertical line if only x is guessed,
 * and a dashed line from the guess to the outcome of the step. */
static void draw_user_guess(const Plot *stage)
{
    const UserPrediction *guess = &stage->simulation->prediction;
    const Box *box = &stage->box;
    Canvas *canvas = &stage->paper->canvas;
    double unit = stage->paper->unit, arm = 7 * unit, at[2], came[2], point[2];
    if (!guess->has_guess || stage->content->is_bare)
        return;
    plot_to_pixel(stage, guess->guess, at);
    plot_to_pixel(stage, guess->outcome, came);
    if (simulation_find_shown_point(stage->simulation, point) == 1) {
        canvas_line(canvas, at[0], box->y + box->height, at[0], box->y,
                    1.5 * unit, COLOUR_HAND);
        came[1] = at[1];
    }
    for (int k = -1; k <= 1; k += 2)
        canvas_line(canvas, at[0] - arm, at[1] - k * arm, at[0] + arm,
                    at[1] + k * arm, 3 * unit, COLOUR_HAND);
    canvas_dashes(canvas, at, came, 1.6 * unit, unit, NULL, COLOUR_HAND);
    plot_label(stage, 1, guess->guess, COLOUR_HAND, "your guess, %s off",
               format_number(guess->error).text);
}

Pick frame_find_pick(const FrameContent *content, const Layout *layout,
                     double x, double y)
{
    WindowHit hit = layout_find_hit(layout, x, y);
    Pick pick = {.kind = PICK_NONE, .nearest_node = -1};
    if (hit.zone != ZONE_STAGE || hit.index >= content->panes)
        return pick;
    pick.pane_index = hit.index;
    Plot stage = stage_create(NULL, content, layout, hit.index);
    const Picture *picture = picture_of_scene(stage.simulation->scene);
    double at[SCENE_MAX_HANDLES][2];
    SceneSwitch switches[SCENE_MAX_SWITCHES];
    camera_to_world(&stage.camera, x, y, pick.point);
    pick.kind = picture->takes_clicks ? PICK_POINT : PICK_NONE;
    if (!picture->draws_handles) {
        int count = list_switches(&stage, switches);
        for (pick.index = 0; pick.index < count; pick.index++)
            if (box_contains(find_switch_box(&stage, pick.index, count), x,
                             y)) {
                pick.kind = PICK_SWITCH;
                return pick;
            }
        pick.index = 0;
        if (plot_pick_point(&stage, exhibit_list_handles(stage.simulation, at),
                            *at, HANDLE_REACH, x, y, PICK_HANDLE, &pick))
            return pick;
    }
    if (picture->pick)
        picture->pick(&stage, x, y, &pick);
    return pick;
}

/* ---- drawing ------------------------------------------------------------- */

enum { LABEL_LINE_SIZE = 4 * VALUE_SIZE };

/* Copies the first parts of a label that fit into a line [LABEL_LINE_SIZE].
 * A comma or semicolon ends a part.  Returns the rest of the label. */
static const char *break_label_line(const Plot *stage, const char *label,
                                    char *line)
{
    int room = (int)(stage->box.width - stage->em);
    char *end;
    snprintf(line, LABEL_LINE_SIZE, "%s", label);
    while (paper_measure(stage->paper, FACE_BOLD, 1, line) > room &&
           ((end = strrchr(line, ';')) || (end = strrchr(line, ','))))
        *end = '\0';
    label += strlen(line);
    return label + strspn(label, ",; ");
}

/* Whether the picture has a scale bar; low panes only have room for a label. */
static bool stage_shows_scale_bar(const Plot *stage)
{
    bool is_low = stage->box.height < LOW_PANE * stage->em &&
                  stage->content->panes > 1 && stage->content->lecture.page;
    return stage->has_text && !is_low &&
           picture_of_scene(stage->simulation->scene)->shows_scale_bar;
}

/* Writes the label of a pane, which says how panes differ, in up to three lines
 * below the picture; a wide label stands above the scale bar. */
static void draw_pane_label(const Plot *stage, const char *label)
{
    enum { MAX_LABEL_LINES = 3 };
    Paper *paper = stage->paper;
    const Box *box = &stage->box;
    char line[MAX_LABEL_LINES][LABEL_LINE_SIZE];
    int lines = 0, wide = 0;
    while (*label && lines < MAX_LABEL_LINES) {
        label = break_label_line(stage, label, line[lines]);
        int own = paper_measure(paper, FACE_BOLD, 1, line[lines++]);
        wide = own > wide ? own : wide;
    }
    bool high =
        wide > box->width - 10 * paper->em && stage_shows_scale_bar(stage);
    double low = box->y + box->height - (high ? 4.2 : 1.7) * paper->em;
    for (int i = 0; i < lines; i++)
        paper_write_on_panel(
            paper, FACE_BOLD, 1, colour_of_run(plot_pane_index(stage)),
            box->x + 0.5 * box->width, low - 1.36 * (lines - 1 - i) * paper->em,
            ALIGN_CENTRE, "%s", line[i]);
}

/* Draws the picture of a pane with its words, and the note at the mouse. */
static void draw_pane(Paper *paper, const Layout *layout,
                      const FrameContent *content, int pane)
{
    Plot stage = stage_create(paper, content, layout, pane);
    const Picture *picture = picture_of_scene(stage.simulation->scene);
    const Pick *hover = &content->view->hovered_part;
    Box before = canvas_set_clip(&paper->canvas, stage.box);
    if (content->lecture.page && stage.box.height < MIN_TEXT * paper->em)
        stage.has_text = false;
    picture->draw(&stage);
    TextLine line = lines_begin(&stage.pane->values, picture->legend);
    while (stage.has_text && text_next_line(&line))
        plot_legend(&stage, line.colour, "%s", line.text);
    if (stage_shows_scale_bar(&stage))
        plot_draw_scale_bar(&stage);
    if (!picture->draws_handles)
        stage_draw_handles(&stage);
    draw_switches(&stage);
    draw_user_guess(&stage);
    if (layout->pane_count > 1 && stage.pane->label)
        draw_pane_label(&stage, stage.pane->label);
    if (picture->draw_hover_note && stage.has_text &&
        hover->pane_index == pane && hover->kind != PICK_NONE &&
        !content->hand.is_held)
        picture->draw_hover_note(&stage);
    canvas_set_clip(&paper->canvas, before);
}

/* Draws a cell of the overview: the bare picture of its scene, the scene's name
 * below, and the heading of a group above. */
static void draw_sheet_cell(Paper *paper, Box box, const SheetCell *cell,
                            bool chosen)
{
    Layout layout = {.em = paper->em, .pane_count = 1};
    Box name = box;
    Box inside = box_cut_off(&name, EDGE_TOP, box.width);
    if (cell->heading)
        paper_write(paper, FACE_BOLD, 1.05, COLOUR_TEXT, box.x,
                    box.y - 1.7 * paper->em, ALIGN_LEFT, "%s", cell->heading);
    canvas_fill(&paper->canvas, inside, chosen ? COLOUR_VALUE : COLOUR_BORDER);
    canvas_fill(&paper->canvas, box_inset(inside, chosen ? 2 : 1),
                COLOUR_WHITE);
    layout.pane[0] = box_inset(inside, paper_to_pixels(paper, 0.3));
    if (cell->simulation) {
        FrameContent content;
        frame_create(cell->simulation, &content);
        content.is_bare = true;
        content.shows_strain = cell->simulation->scene->strain_colour_max > 0;
        draw_pane(paper, &layout, &content, 0);
    }
    paper_write_in_box(paper, chosen ? FACE_BOLD : FACE_REGULAR, 1,
                       chosen ? COLOUR_VALUE : COLOUR_TEXT, name, ALIGN_CENTRE,
                       cell->name);
}

static void prepare_paper(Paper *paper, double em, const FrameContent *content)
{
    paper->em = em;
    paper->unit = em / 14;
    paper->word_box_count = 0;
    paper->min_letter_size = content->lecture.page ? 1 : 0;
    canvas_clear(&paper->canvas, COLOUR_WHITE);
}

void frame_draw_card(Paper *paper, const FrameContent *content, int card)
{
    prepare_paper(paper, content->min_em, content);
    Box inside = box_inset(paper->canvas.clip, paper_to_pixels(paper, 0.4));
    card_draw(paper, inside, content, card);
    draw_term_highlight(paper, content);
}

void frame_draw(Paper *paper, const FrameContent *content)
{
    Layout layout =
        layout_create(content, paper->canvas.width, paper->canvas.height);
    bool sheet = layout.cell_count > 0, several = layout.pane_count > 1;
    prepare_paper(paper, layout.em, content);
    for (int i = 0; i < layout.cell_count; i++)
        draw_sheet_cell(paper, layout.cell[i], &content->sheet.cell[i],
                        i == content->view->selected_cell);
    if (several) /* lines between the panes */
        canvas_fill(&paper->canvas, layout.stage, COLOUR_RULE);
    for (int pane = 0; pane < layout.pane_count; pane++) {
        if (several)
            canvas_fill(&paper->canvas, layout.pane[pane], COLOUR_WHITE);
        draw_pane(paper, &layout, content, pane);
    }
    if (content->is_bare && !sheet)
        return;
    if (!sheet && !content->is_stage_only) {
        if (content->column != COLUMN_CARDS)
            canvas_fill(&paper->canvas, layout.column, COLOUR_WHITE);
        cards_draw(paper, &layout, content);
    }
    if (!sheet)
        draw_term_highlight(paper, content);
    if (!content->is_stage_only)
        window_rows_draw(paper, &layout, content);
}
