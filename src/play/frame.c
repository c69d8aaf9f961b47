/* frame.c - fills the contents of a frame; picture.c draws them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "picture/picture.h"
#include "picture/plot.h"
#include "play/playing.h"

static const double LONG_WORK = 0.3;  /* longer work is reported, s */
static const double SMALL_LETTER = 9; /* smallest font without window, pixels */

/* ---- the list of keys ---------------------------------------------------- */

/* Replaces the name of a key by a sign: "Right" by an arrow. */
static void shorten_key_name(char key[VALUE_SIZE])
{
    static const char *const names[][2] = {
        {"Right", "\u2192"},         {"Left", "\u2190"},   {"Up", "\u2191"},
        {"Down", "\u2193"},          {"Escape", "Esc"},    {"-", "\u2212"},
        {"Backspace", "Back\u232b"}, {"PageDown", "PgDn"}, {"PageUp", "PgUp"},
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(key, names[i][0]) == 0)
            snprintf(key, VALUE_SIZE, "%s", names[i][1]);
}

static void build_key_list(FrameContent *content)
{
    static const ListRow mouse[] = {
        {"drag", "pulls a node; paused: places it"},
        {"", "a ground, a ball: pushes; a pin: moves"},
        {"", "where nothing is: moves the picture"},
        {"drag an edge", "of the paused square: stretch"},
        {"right click", "pins a node, or frees it"},
        {"wheel", "zooms, or changes a number"},
        {"middle drag", "moves the picture, too"},
        {"double click", "a ball; on a number: default"},
        {"letters", "go into a lit number; Enter, Esc"},
        {"1 \u2026 9", "a scene; G shows more"},
    };
    ListRow *row = content->list.row + sizeof mouse / sizeof *mouse;
    memcpy(content->list.row, mouse, sizeof mouse);
    for (int kind = 1; kind < COMMAND_KIND_COUNT; kind++) {
        const CommandRow *command = &command_rows[kind];
        if (!command->label)
            continue;
        if (command->label[0]) /* empty label: the keys join the row above */
            snprintf((row++)->text, SENTENCE_SIZE, "%s", command->label);
        for (const char *at = command->keys; *at; at += *at == '|') {
            char key[VALUE_SIZE], *keys = row[-1].key;
            int length = (int)strcspn(at, "|");
            snprintf(key, sizeof key, "%.*s", length, at);
            shorten_key_name(key);
            append(keys, VALUE_SIZE, "%s%s", keys[0] ? ", " : "", key);
            at += length;
        }
    }
    content->list.row_count = (int)(row - content->list.row);
}

/* ---- the row of numbers -------------------------------------------------- */

/* Fills the row of numbers, and the sentence about the number under the mouse
 * or the selected one. */
static void build_settings_row(const Player *player, WindowFrame *frame)
{
    FrameContent *content = &frame->content;
    const WindowHit *mouse = &player->screen.view.mouse_hit;
    const Options shown = player_get_shown_options(player), *options = &shown;
    const OptionRow *all[OPTIONS_MAX_ROWS];
    frame->option_count = player_list_options(player, false, frame->option);
    bool over =
        mouse->zone == ZONE_SETTING && mouse->index < frame->option_count;
    for (int i = 0; i < frame->option_count; i++) {
        const OptionRow *row = frame->option[i];
        Setting *setting = &content->settings.item[content->settings.count++];
        setting->name = option_get_label(row);
        setting->min_letters = row->display.max_letters;
        player_format_value(row, options, player_get_simulation(player),
                            setting->value, VALUE_SIZE);
        setting->is_changed = !option_is_equal(
            row, options,
            &past_get_start_control(&player->past, player->active_pane)
                 ->options);
        const char *idle = player_find_idle_reason(player, row);
        setting->is_off = strcmp(setting->value, "none") == 0 || idle;
        setting->is_selected = row == player->input.selected_option;
        bool is_explained = over ? i == mouse->index : setting->is_selected;
        if (is_explained && (idle || row->help[0]))
            snprintf(content->title_bar.sentence, SENTENCE_SIZE, "%s: %s",
                     row->name, idle ? idle : row->help);
        if (setting->is_selected && player->input.is_typing)
            snprintf(setting->value, VALUE_SIZE, "%s_",
                     player->input.typed_text);
    }
    if (player_list_options(player, true, all) > frame->option_count)
        content->settings.item[content->settings.count++] =
            (Setting){.name = "", .value = "+ more"};
}

/* Lists all numbers of the scene, and why some have no effect now. */
static void list_shown_options(const Player *player, FrameContent *content)
{
    const OptionRow *all[OPTIONS_MAX_ROWS];
    const Options options = player_get_shown_options(player);
    content->list.row_count = player_list_options(player, true, all);
    for (int i = 0; i < content->list.row_count; i++) {
        ListRow *row = &content->list.row[i];
        char value[VALUE_SIZE];
        const char *idle = player_find_idle_reason(player, all[i]);
        player_format_value(all[i], &options, player_get_simulation(player),
                            value, sizeof value);
        row->target_index = (int)(all[i] - option_rows);
        snprintf(row->key, VALUE_SIZE, "%d", i + 1);
        snprintf(row->text, SENTENCE_SIZE, "%s %s%s%s", all[i]->name, value,
                 idle || all[i]->help[0] ? ": " : "",
                 idle ? idle : all[i]->help);
        row->style = idle ? ROW_GREY : ROW_PLAIN;
    }
}

/* ---- the chips ----------------------------------------------------------- */

/* Adds the chip of a command, with its first key and one of its labels.
 *   state  in, index of the label in CommandRow.chip_labels */
static void add_chip(WindowFrame *frame, CommandKind kind, int state, bool lit)
{
    ChipRow *chips = &frame->content.chips;
    Chip *chip = &chips->chip[chips->count];
    const char *label = command_rows[kind].chip_labels;
    const char *keys = command_rows[kind].keys;
    for (; state > 0; state--)
        label = strchr(label, '|') + 1;
    *chip = (Chip){.is_highlighted = lit};
    append(chip->label, VALUE_SIZE, "%.*s", (int)strcspn(label, "|"), label);
    append(chip->key, VALUE_SIZE, "%.*s", (int)strcspn(keys, "|"), keys);
    shorten_key_name(chip->key);
    frame->chip_command[chips->count++] = kind;
}

static void build_chip_row(const Player *player, WindowFrame *frame)
{
    const Simulation *simulation = player_get_simulation(player);
    const Options *options = player_get_active_options(player);
    bool time = simulation->scene->traits & HAS_TIME;
    bool nears = options->next_action == NEXT_SHORTENS_SPRING;
    bool newton = simulation_has_newton_updates(simulation) && !nears;
    bool ended = simulation->is_over || player->play.mode > MODE_END;
    bool stands = player_is_stopped(player);
    if (player->screen.sheet) {
        add_chip(frame, COMMAND_PAGE_ON, 0, false);
        add_chip(frame, COMMAND_PAGES, 0, false);
        add_chip(frame, COMMAND_SHEET, 1, false);
        return;
    }
    add_chip(frame, COMMAND_TOGGLE_PAUSE, stands, stands && !ended);
    int next = nears ? 4 : newton ? (int)player->play.walk_unit : time ? 0 : 3;
    add_chip(frame, COMMAND_NEXT, next, false);
    add_chip(frame, COMMAND_BACK, 0, false);
    if (options->page) {
        add_chip(frame, COMMAND_PAGE_ON, 0, ended && options->page[1].name);
        add_chip(frame, COMMAND_CODE, 0, player->screen.column == COLUMN_CODE);
        add_chip(frame, COMMAND_PAGES, 0,
                 player->screen.column == COLUMN_PAGES);
    } else if (player->tour.tour_page) {
        add_chip(frame, COMMAND_PAGE_BACK, 0, true);
    }
    add_chip(frame, COMMAND_RESTART, 0, ended);
    if (newton)
        add_chip(frame, COMMAND_FINER, (int)player->play.walk_unit, false);
    if (simulation_has_projection(simulation))
        add_chip(frame, COMMAND_PROJECTION,
                 options->projection == PROJECTION_NONE, false);
    if (simulation_has_line_search(simulation))
        add_chip(frame, COMMAND_SEARCH,
                 options->line_search == LINE_SEARCH_NONE, false);
    if (time && simulation->runs == 1)
        add_chip(frame, COMMAND_METHOD, 0, false);
    if (player->past.branch_index > 0)
        add_chip(frame, COMMAND_UNDO, 0, false);
    add_chip(frame, COMMAND_SHEET, 0, false);
    add_chip(frame, COMMAND_KEYS, 0, player->screen.column == COLUMN_KEYS);
}

/* ---- the picture --------------------------------------------------------- */

_Static_assert((int)OPTIONS_MAX_DRAWN_PANES == (int)LAYOUT_MAX_PANES,
               "all are drawn");

/* Writes the value that an option has in a pane at the step that is shown. */
static void format_pane_value(const Player *player, int pane,
                              const OptionRow *row, char value[VALUE_SIZE])
{
    const Past *past = &player->past;
    const PastEntry *entry = past_find_entry(
        past, pane, past_find_made_step(past, pane, past->shown_step));
    player_format_value(row, &entry->next_control->options,
                        &past->pane[pane].simulation, value, VALUE_SIZE);
}

/* Whether at least two panes, and all but one, have this value of an option. */
static bool most_panes_have_value(const Player *player, const OptionRow *row,
                                  const char *value)
{
    int panes = past_count_panes(&player->past), equal = 0;
    char other[VALUE_SIZE];
    for (int p = 0; p < panes && panes > 2; p++) {
        format_pane_value(player, p, row, other);
        equal += strcmp(value, other) == 0;
    }
    return panes > 2 && equal == panes - 1;
}

void player_write_label(const Player *player, int pane, char label[LABEL_SIZE])
{
    const Past *past = &player->past;
    long last = past_find_made_step(past, pane, past->shown_step);
    char value[VALUE_SIZE];
    label[0] = '\0';
    for (int all = 0; all < 2 && !label[0]; all++)
        for (const OptionRow *row = option_rows; row->name; row++) {
            if (!player_panes_differ(player, row))
                continue;
            format_pane_value(player, pane, row, value);
            if (!all && most_panes_have_value(player, row, value))
                continue;
            append(label, LABEL_SIZE, "%s", label[0] ? ", " : "");
            if (row->slot != OPTION_SLOT(integrator))
                append(label, LABEL_SIZE, "%s ", row->label);
            append(label, LABEL_SIZE, "%s", format_power_of_ten(value).text);
        }
    if (last == past->shown_step)
        return;
    append(label, LABEL_SIZE, "%sended at step %ld", label[0] ? ", " : "",
           last);
    long seen = past_find_drawable_step(past, pane, last);
    if (seen < last)
        append(label, LABEL_SIZE, "; picture of step %ld", seen);
}

static void build_pane_content(const Player *player, int p, WindowFrame *frame)
{
    const PastPane *shown = &player->past.pane[p];
    const Simulation *simulation = &shown->simulation;
    const PaneView *view = &player->view_of_pane[p];
    Pane *pane = &frame->content.pane[p];
    past_fill_history(&player->past, p, &frame->history[p]);
    player_write_label(player, p, frame->pane_label[p]);
    *pane = (Pane){.simulation = simulation,
                   .history = &frame->history[p],
                   .ghost_x = view->ghost_x,
                   .ghost_label = view->ghost_label,
                   .step_status = shown->outcome.status};
    if (past_count_panes(&player->past) > 1)
        pane->label = frame->pane_label[p];
    if (shown->has_trace && simulation_has_newton_updates(simulation)) {
        pane->trace = &frame->trace[p];
        pane->x = step_trace_read_position(&shown->trace, view->trace_index,
                                           &frame->trace[p]);
    }
}

/* Returns the bar of a step in the time line of the player `shown`. */
static StepBar get_step_bar(const void *shown, long step)
{
    const Player *player = shown;
    const StepOutcome *outcome =
        &past_find_entry(&player->past, player->active_pane, step)->outcome;
    return (StepBar){outcome->updates, status_is_unconverged(outcome->status)};
}

/* Writes the text of the time line, "step 12 of 40   t = 0.24 s", the state of
 * the run, and how to stop a long step. */
static void build_time_line(const Player *player, FrameContent *content)
{
    const Past *past = &player->past;
    const char *turn = player_get_simulation(player)->scene->step_name;
    char *text = content->time_line.label;
    double time = 0, longest = -1; /* time of the pane of longest timestep, s */
    bool shared = true;            /* is one time step the same in each pane? */
    for (int p = 0; p < past_count_panes(past); p++) {
        const Simulation *now = &past->pane[p].simulation;
        bool goes =
            past_find_made_step(past, p, past->shown_step) == past->shown_step;
        double h = goes ? now->options.timestep : 0;
        time = h > longest ? simulation_get_time(now) : time;
        shared = shared && (p == 0 || h == longest);
        longest = fmax(longest, h);
    }
    content->time_line.is_paused = player_is_stopped(player);
    if (player_get_active_options(player)->next_action == NEXT_ADDS_SPRING) {
        long last = player_get_simulation(player)->system.springs - 1;
        snprintf(text, SENTENCE_SIZE, "spring %ld",
                 past->shown_step < last ? past->shown_step : last);
        return;
    }
    snprintf(text, SENTENCE_SIZE, "%s %ld", turn ? turn : "step",
             past->shown_step);
    if (past_find_newest(past) > past->shown_step)
        append(text, SENTENCE_SIZE, " of %ld", past_find_newest(past));
    if (!turn)
        append(text, SENTENCE_SIZE, "   t = %.4g s", time);
    if (!turn && shared && player->play.log_speed != 0)
        append(text, SENTENCE_SIZE,
               player->play.log_speed < 0 ? "   slowed %.4g times"
                                          : "   %.4g steps a frame",
               ldexp(1, abs(player->play.log_speed)));
    snprintf(content->title_bar.state, VALUE_SIZE, "%s",
             player->play.mode == MODE_REST ? "at rest" : "");
    if (!past_makes_step(past) ||
        (clock_now() - player->play.work_start_time <= LONG_WORK &&
         !player_factorises_slowly(player)))
        return;
    snprintf(content->title_bar.sentence, SENTENCE_SIZE,
             "a long step: Esc stops it, at the last whole one");
    snprintf(content->title_bar.state, VALUE_SIZE, "computing, update %d",
             player_get_active_pane(player)->outcome.updates);
}

/* If the user has changed the page, writes a heading of the answer with the
 * page's own values: "The page's own answer, with h = 1 s:". */
static void write_page_heading(const Player *player, LectureContent *lecture)
{
    const OptionRow *row[OPTIONS_MAX_ROWS];
    char text[SENTENCE_SIZE - 1] = "The page's own answer", value[VALUE_SIZE];
    const char *before = ", with ";
    if (!player_has_changed_page(player))
        return;
    int rows = player_list_options(player, true, row);
    for (int i = 0; i < rows; i++) {
        const Options *own = player_find_page_options(player, row[i]);
        if (!own)
            continue;
        player_format_value(row[i], own, player_get_simulation(player), value,
                            sizeof value);
        size_t comma = strcspn(value, ",");
        if (player_get_simulation(player)->descent.scalar)
            value[comma] = '\0'; /* only x: the scene has one unknown */
        append(text, sizeof text,
               value[comma] ? "%s%s = (%.*s)%s" : "%s%s = %.*s%s", before,
               option_get_label(row[i]), (int)strcspn(value, " "), value,
               value + strcspn(value, " "));
        before = ", ";
    }
    snprintf(lecture->heading, sizeof lecture->heading, "%s:", text);
}

static void build_frame_content(const Player *player, WindowFrame *frame)
{
    const Past *past = &player->past;
    const Window *window = player->screen.window;
    FrameContent *content = &frame->content;
    const int active = player->active_pane;
    frame_create(player_get_simulation(player), content);
    content->view = &player->screen.view;
    content->fonts = player->screen.paper.font;
    content->min_em = window                        ? window->find_font_size()
                      : player->screen.draws_frames ? SMALL_LETTER
                                                    : 0;
    content->is_stage_only = window && window->has_document;
    content->has_document = content->is_stage_only && window->has_document();
    content->panes = past_count_panes(past);
    if (content->panes > LAYOUT_MAX_PANES) /* a script can open more panes */
        content->panes = LAYOUT_MAX_PANES;
    content->active_pane_index = active < content->panes ? active : 0;
    for (int i = 0; i < content->panes; i++)
        build_pane_content(player, i, frame);
    build_time_line(player, content);
    build_settings_row(player, frame);
    build_chip_row(player, frame);
    const UserControl *control = past_get_control(past, active);
    if (control_is_holding(control) &&
        player->view_of_pane[active].trace_index < 0)
        content->hand = (HandGrip){true,
                                   control->held_node,
                                   control->held_obstacle,
                                   {control->target[0], control->target[1]}};
    content->time_line.steps = past->stores_states ? past_find_newest(past) : 0;
    content->time_line.get_bar = get_step_bar;
    content->time_line.bar_data = player;
    content->time_line.shown_step = past->shown_step;
    content->title_bar.is_warning = player->is_warning;
    content->cards.enlarged_card = player->screen.enlarged_card;
    content->shows_strain =
        player->screen.has_toggled_strain !=
        (content->pane[0].simulation->scene->strain_colour_max > 0);
    content->is_bare = player->screen.is_bare;
    if (player->screen.column == COLUMN_KEYS)
        build_key_list(content);
    if (player->screen.column == COLUMN_OPTIONS)
        list_shown_options(player, content);
    if (!(player->explains_hover && content->title_bar.sentence[0] &&
          !player->input.is_typing))
        snprintf(content->title_bar.message, SENTENCE_SIZE, "%s", player->note);
    content->lecture.hides_answer = player_hides_answer(player);
    write_page_heading(player, &content->lecture);
    bool answered =
        content->pane[0].simulation->options.page == player->tour.revealed_page;
    content->lecture.question = answered ? player->tour.asked_question : NULL;
    content->lecture.verdict =
        answered && player->tour.verdict[0] && !content->lecture.heading[0]
            ? player->tour.verdict
            : NULL;
    content->lecture.guesses = player->tour.guess_count;
    content->lecture.right_guesses = player->tour.right_guess_count;
    frame_add_lecture(player->screen.column, player->tour.tour_page, content);
    content->cards.closed_cards ^= player->screen.toggled_cards;
    if (player->screen.sheet)
        sheet_build_content(player, content);
    frame_expand_texts(content);
}

/* Updates the object under the mouse, as nodes and obstacles may have moved. */
static void update_hovered_object(Player *player)
{
    const FrameContent *content = &player->screen.frame.content;
    const Mouse *mouse = &player->input.mouse;
    const Canvas *canvas = &player->screen.paper.canvas;
    FrameView *view = &player->screen.view;
    PickKind kind = view->hovered_part.kind;
    bool body = kind == PICK_NODE || kind == PICK_SPRING ||
                kind == PICK_OBSTACLE || kind == PICK_EDGE;
    if (!body || !canvas->pixels || !mouse->has_position ||
        mouse->drag_command || view->mouse_hit.zone != ZONE_STAGE)
        return;
    Layout layout = layout_create(content, canvas->width, canvas->height);
    view->hovered_part = frame_find_pick(content, &layout, mouse->x, mouse->y);
}

void player_build_frame(Player *player)
{
    build_frame_content(player, &player->screen.frame);
    update_hovered_object(player);
}

void player_update_frame(Player *player)
{
    if (player->screen.must_redraw)
        player_build_frame(player);
}

/* ---- the paper ----------------------------------------------------------- */

Paper *player_prepare_paper(Player *player)
{
    static bool is_warned; /* the user was told that the font is missing */
    const char *font = getenv("ELASTO_FONT"); /* empty: no words in pictures */
    Paper *paper = &player->screen.paper;
    const Canvas *canvas = &paper->canvas;
    int size[2] = {player->screen.paper_size[0], player->screen.paper_size[1]};
    if (!player->screen.draws_frames)
        return NULL;
    if (size[0] == 0)
        player->screen.window->find_size(size);
    for (int i = 0; i < 2; i++)
        size[i] = (int)fmin(fmax(size[i], 1), CANVAS_MAX_SIZE);
    if (canvas->pixels && canvas->width == size[0] && canvas->height == size[1])
        return paper;
    paper_free(paper);
    if (paper_create(size[0], size[1], paper)) {
        paper_free(paper);
        return NULL;
    }
    player->screen.frame.content.fonts = paper->font;
    if (!paper->font && !is_warned && (!font || font[0])) {
        fprintf(stderr, "no font: DejaVu Sans is not installed; pictures have "
                        "no words (ELASTO_FONT=FILE.ttf names another font)\n");
        is_warned = true;
    }
    return paper;
}

void player_paint_frame(Player *player, Paper *paper)
{
    player_build_frame(player);
    if (player->screen.is_black)
        canvas_clear(&paper->canvas, 0xff000000u);
    else
        frame_draw(paper, &player->screen.frame.content);
}
