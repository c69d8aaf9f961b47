/* frame.c - what the player knows, as the Show that the pictures read; and the
 * paper on which they are drawn.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "picture/picture.h"
#include "play/playing.h"
#include "run/scene.h"

static const double LONG_WORK = 0.3;  /* s; then it is shown */
static const double SMALL_LETTER = 9; /* pixels, of a surface */

/* ---- the list of keys ---------------------------------------------------- */

/* As people read it: "Right" is an arrow. */
static void pretty_key(char key[SHOW_VALUE])
{
    static const char *const names[][2] = {
        {"Right", "\u2192"},         {"Left", "\u2190"},   {"Up", "\u2191"},
        {"Down", "\u2193"},          {"Escape", "Esc"},    {"-", "\u2212"},
        {"Backspace", "Back\u232b"}, {"PageDown", "PgDn"}, {"PageUp", "PgUp"},
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(key, names[i][0]) == 0)
            snprintf(key, SHOW_VALUE, "%s", names[i][1]);
}

static void fill_help(Show *show)
{
    static const HelpRow mouse[] = {
        {"drag", "pulls a node; paused: places it", false},
        {"", "a ground, a ball: pushes; a pin: moves", false},
        {"", "where nothing is: moves the picture", false},
        {"drag an edge", "of the paused square: stretch", false},
        {"right click", "pins a node, or frees it", false},
        {"wheel", "zooms, or changes a number", false},
        {"middle drag", "moves the picture, too", false},
        {"double click", "a ball; on a number: default", false},
        {"letters", "go into a lit number; Enter, Esc", false},
        {"1 \u2026 9", "a scene; G shows more", false},
    };
    HelpRow *row = show->help + sizeof mouse / sizeof *mouse;
    memcpy(show->help, mouse, sizeof mouse);
    for (int kind = 1; kind < COMMAND_KINDS; kind++) {
        const CommandRow *command = &command_rows[kind];
        if (!command->label)
            continue;
        if (command->label[0]) /* else it is told with the one before */
            snprintf((row++)->text, SHOW_TEXT, "%s", command->label);
        for (const char *at = command->keys; *at; at += *at == '|') {
            char key[SHOW_VALUE], *keys = row[-1].key; /* of "A|B", all */
            int length = (int)strcspn(at, "|");
            snprintf(key, sizeof key, "%.*s", length, at);
            pretty_key(key);
            append(keys, SHOW_VALUE, "%s%s", keys[0] ? ", " : "", key);
            at += length;
        }
    }
    show->help_rows = (int)(row - show->help);
}

/* ---- the row of numbers -------------------------------------------------- */

/* The row of numbers, and what a sentence can say of the one under the mouse,
 * or of that which is lit. */
static void fill_settings(Player *player)
{
    Show *show = &player->show;
    const Options shown = player_numbers(player), *options = &shown;
    const OptionRow *all[OPTIONS_MOST];
    show->selected = -1;
    player->numbers = player_row(player, false, player->number);
    bool over =
        show->over.zone == ZONE_SETTING && show->over.index < player->numbers;
    for (int i = 0; i < player->numbers; i++) {
        const OptionRow *row = player->number[i];
        Setting *setting = &show->setting[show->settings++];
        char now[COMMAND_TEXT_SIZE], start[COMMAND_TEXT_SIZE];
        setting->name = row->label ? row->label : row->name;
        setting->letters = row->field.letters;
        player_value(row, options, player_simulation(player), setting->value,
                     SHOW_VALUE);
        option_value(row, options, now, sizeof now);
        option_value(row, &past_start(&player->past, player->active)->options,
                     start, sizeof start);
        setting->changed = strcmp(now, start) != 0;
        const char *idle = player_idle(player, row);
        setting->off = strcmp(setting->value, "none") == 0 || idle;
        bool told = over ? i == show->over.index : row == player->lit;
        if (told && (idle || row->help[0]))
            snprintf(show->sentence, SHOW_TEXT, "%s: %s", row->name,
                     idle ? idle : row->help);
        if (row == player->lit)
            show->selected = i;
        if (row == player->lit && player->typing)
            snprintf(setting->value, SHOW_VALUE, "%s_", player->typed);
    }
    if (player_row(player, true, all) > player->numbers)
        show->setting[show->settings++] =
            (Setting){"", "+ more", 0, false, false};
}

/* All numbers of the scene, what they are, and why some have no meaning now. */
static void fill_options(Player *player)
{
    const OptionRow *all[OPTIONS_MOST];
    const Options options = player_numbers(player);
    Show *show = &player->show;
    show->help_rows = player_row(player, true, all);
    for (int i = 0; i < show->help_rows; i++) {
        HelpRow *row = &show->help[i];
        char value[SHOW_VALUE];
        const char *idle = player_idle(player, all[i]);
        player_value(all[i], &options, player_simulation(player), value,
                     sizeof value);
        snprintf(row->key, SHOW_VALUE, "%d", i + 1);
        snprintf(row->text, SHOW_TEXT, "%s %s%s%s", all[i]->name, value,
                 idle || all[i]->help[0] ? ": " : "",
                 idle ? idle : all[i]->help);
        row->grey = idle != NULL;
    }
}

/* ---- the chips ----------------------------------------------------------- */

/* The chip of a command: its first key, and what that does now: word number
 * `word` of those of its row. */
static void add_chip(Player *player, CommandKind kind, int word, bool lit)
{
    static char keys[LAYOUT_CHIPS][SHOW_VALUE],
        labels[LAYOUT_CHIPS][SHOW_VALUE];
    Show *show = &player->show;
    int i = show->chips;
    const CommandRow *row = &command_rows[kind];
    const char *label = row->chip;
    if (i >= LAYOUT_CHIPS)
        return;
    for (; word > 0; word--)
        label = strchr(label, '|') + 1;
    snprintf(labels[i], SHOW_VALUE, "%.*s", (int)strcspn(label, "|"), label);
    snprintf(keys[i], SHOW_VALUE, "%.*s", (int)strcspn(row->keys, "|"),
             row->keys);
    pretty_key(keys[i]);
    player->chip[i] = kind;
    show->chip[show->chips++] = (Chip){keys[i], labels[i], lit};
}

/* The keys that matter now. */
static void fill_chips(Player *player)
{
    const Simulation *simulation = player_simulation(player);
    const Options *options = player_settings(player);
    bool time = simulation->scene->needs & NEEDS_TIME;
    bool nears = options->next == NEXT_NEARER;
    bool newton = simulation->run[0].newton && time && !nears;
    bool ended = simulation->done || player->mode > MODE_END;
    bool stands = player_stands(player);
    if (player->sheet) {
        add_chip(player, COMMAND_PAGE_ON, 0, false);
        add_chip(player, COMMAND_PAGES, 0, false);
        add_chip(player, COMMAND_SHEET, 1, false);
        return;
    }
    add_chip(player, COMMAND_TOGGLE_PAUSE, stands, stands && !ended);
    int next = nears ? 4 : newton ? player->fine : time ? 0 : 3;
    add_chip(player, COMMAND_NEXT, next, false);
    add_chip(player, COMMAND_BACK, 0, false);
    if (options->page) {
        add_chip(player, COMMAND_PAGE_ON, 0, ended && options->page[1].name);
        add_chip(player, COMMAND_CODE, 0, player->column == COLUMN_CODE);
        add_chip(player, COMMAND_PAGES, 0, player->column == COLUMN_PAGES);
    } else if (player->left) {
        add_chip(player, COMMAND_PAGE_BACK, 0, true);
    }
    add_chip(player, COMMAND_RESTART, 0, ended);
    if (newton)
        add_chip(player, COMMAND_FINER, player->fine, false);
    if (simulation_has_projection(simulation))
        add_chip(player, COMMAND_PROJECTION,
                 options->projection == PROJECTION_NONE, false);
    if (simulation_has_line_search(simulation))
        add_chip(player, COMMAND_SEARCH,
                 options->line_search == LINE_SEARCH_NONE, false);
    if (time && simulation->runs == 1)
        add_chip(player, COMMAND_METHOD, 0, false);
    if (player->past.now > 0)
        add_chip(player, COMMAND_UNDO, 0, false);
    add_chip(player, COMMAND_SHEET, 0, false);
    add_chip(player, COMMAND_KEYS, 0, player->column == COLUMN_KEYS);
}

/* ---- the picture --------------------------------------------------------- */

_Static_assert((int)OPTIONS_MAX_DRAWN == (int)LAYOUT_PANES, "all are drawn");

/* One picture on the stage. */
static void fill_pane(Player *player, int p)
{
    const Machine *machine = &player->past.machine[p];
    const Simulation *simulation = &machine->simulation;
    static History histories[LAYOUT_PANES];
    static Trace traces[LAYOUT_PANES];
    const Side *side = &player->side[p];
    Pane *pane = &player->show.pane[p];
    past_history(&player->past, p, &histories[p]);
    *pane = (Pane){.simulation = simulation,
                   .history = &histories[p],
                   .ghost = side->ghost,
                   .ghost_label = side->ghost_label,
                   .trouble = machine->outcome.status};
    if (past_panes(&player->past) > 1)
        pane->label = side->label;
    bool newton =
        simulation->run[0].newton && (simulation->scene->needs & NEEDS_TIME);
    if (machine->known && newton) {
        pane->x = rounds_trace(&machine->rounds, side->place, &traces[p]);
        pane->trace = &traces[p];
    }
}

/* What the time line tells of a step. */
static StepBar bar_of(const void *shown, long step)
{
    const Player *player = shown;
    const Outcome *outcome =
        &past_entry(&player->past, player->active, step)->outcome;
    return (StepBar){outcome->updates, status_is_unconverged(outcome->status)};
}

void player_label_panes(Player *player)
{
    const Past *past = &player->past;
    for (int p = 0; p < past_panes(past); p++) {
        long last = past_ended(past, p, past->step);
        const Entry *entry = past_entry(past, p, last < 0 ? past->step : last);
        char *label = player->side[p].label, value[SHOW_VALUE];
        const size_t size = sizeof player->side[p].label;
        label[0] = '\0';
        for (const OptionRow *row = option_rows; row->name; row++) {
            if (!player_compares(player, row))
                continue;
            player_value(row, &entry->control->options,
                         &past->machine[p].simulation, value, sizeof value);
            append(label, size, "%s", label[0] ? ", " : "");
            if (row->slot != OPTION_SLOT(integrator))
                append(label, size, "%s ", row->label);
            append(label, size, "%s", value);
        }
        if (last < 0)
            continue;
        append(label, size, "%sended at step %ld", label[0] ? ", " : "", last);
        long seen = past_last_seen(past, p, last);
        if (seen < last)
            append(label, size, " (drawn: %ld)", seen);
    }
}

/* "step 12 of 40   t = 0.24 s   2 steps a frame", and what time does; a long
 * step says so, and how to stop it. */
static void fill_time(Player *player)
{
    Show *show = &player->show;
    const Past *past = &player->past;
    const char *turn = player_simulation(player)->scene->turn;
    char *text = show->time_text;
    double time = 0, longest = -1; /* h leads; a pane that ended stands still */
    for (int p = 0; p < past_panes(past); p++) {
        const Simulation *now = &past->machine[p].simulation;
        bool goes = past_ended(past, p, past->step) < 0;
        double h = goes ? now->options.timestep : 0;
        time = h > longest ? simulation_time(now) : time;
        longest = fmax(longest, h);
    }
    show->paused = player_stands(player);
    if (player_settings(player)->next ==
            NEXT_SPRING && /* its steps are springs */
        past->step < player_simulation(player)->system.springs) {
        snprintf(text, SHOW_TEXT, "spring %ld", past->step);
        return;
    }
    snprintf(text, SHOW_TEXT, "%s %ld", turn ? turn : "step", past->step);
    if (past_newest(past) > past->step)
        append(text, SHOW_TEXT, " of %ld", past_newest(past));
    if (!turn)
        append(text, SHOW_TEXT, "   t = %.4g s", time);
    if (!turn && player->speed != 0)
        append(text, SHOW_TEXT, "   %.4g steps a frame",
               ldexp(1, player->speed));
    snprintf(show->state, SHOW_VALUE, "%s",
             player->mode == MODE_REST ? "at rest" : "");
    if (!past->making ||
        (clock_now() - player->began <= LONG_WORK && !player_is_slow(player)))
        return;
    snprintf(show->sentence, SHOW_TEXT,
             "a long step: Esc stops it, at the last whole one");
    snprintf(show->state, SHOW_VALUE, "computing, update %d",
             player_machine(player)->outcome.updates);
}

void player_look_again(Player *player)
{
    Show *show = &player->show;
    const Mouse *mouse = &player->mouse;
    const Canvas *canvas = &player->paper.canvas;
    PickKind kind = show->hover.kind;
    bool body = kind == PICK_NODE || kind == PICK_SPRING ||
                kind == PICK_OBSTACLE || kind == PICK_EDGE;
    if (!body || !canvas->pixels || !mouse->placed || mouse->drag ||
        show->over.zone != ZONE_STAGE)
        return;
    Layout layout = show_layout(show, canvas->width, canvas->height);
    show->hover = show_pick(show, &layout, mouse->x, mouse->y);
}

void player_fill(Player *player)
{
    const Control *control = past_control(&player->past, player->active);
    Show *show = &player->show;
    const Show before = *show;
    show_create(player_simulation(player), show);
    show->panes = past_panes(&player->past);
    if (show->panes > LAYOUT_PANES) /* of a run that only a script draws */
        show->panes = LAYOUT_PANES;
    show->active = player->active < show->panes ? player->active : 0;
    player_label_panes(player);
    for (int i = 0; i < show->panes; i++)
        fill_pane(player, i);
    show->hover = before.hover;
    show->over = before.over;
    show->held = before.held;
    show->chosen = before.chosen;
    fill_time(player);
    fill_settings(player);
    fill_chips(player);
    if (control_holds(control) && player->side[player->active].place < 0)
        show->hand = control;
    show->bars = player->past.keeps ? past_newest(&player->past) : 0;
    show->bar = bar_of;
    show->past = player;
    show->step = player->past.step;
    snprintf(show->message, SHOW_TEXT, "%s", player->note);
    show->warning = player->warning;
    show->large = player->large;
    show->lens = before.lens;
    show->strain = player->strain !=
                   (show->pane[0].simulation->scene->strain_colour_max > 0);
    show->bare = player->bare;
    show->text = player->paper.text;
    show->letter = player->window  ? window_letter()
                   : player->draws ? SMALL_LETTER
                                   : 0;
    show->document = player->window && window_has_document();
    if (player->column == COLUMN_KEYS)
        fill_help(show);
    if (player->column == COLUMN_OPTIONS)
        fill_options(player);
    bool explained = show->sentence[0];
    show->veiled = player_veils(player);
    bool judged = show->pane[0].simulation->options.page == player->told &&
                  player->verdict[0];
    show->verdict = judged ? player->verdict : NULL;
    show->guesses = player->guesses;
    show->right = player->right;
    show_lecture(player->column, player->left, show);
    show->closed ^= player->closed;
    player_fill_sheet(player);
    player_look_again(player);
    show_describe(show);
    if (player->explains && explained && !player->typing)
        show->message[0] = '\0';
}

/* ---- the paper ----------------------------------------------------------- */

Paper *player_paper(Player *player)
{
    static bool told;
    const char *font = getenv("ELASTO_FONT"); /* empty: no words, please */
    Paper *paper = &player->paper;
    const Canvas *canvas = &paper->canvas;
    int size[2] = {player->size[0], player->size[1]};
    if (!player->draws)
        return NULL;
    if (size[0] == 0)
        window_size(size);
    for (int i = 0; i < 2; i++)
        size[i] = (int)fmin(fmax(size[i], 1), CANVAS_MAX_SIZE);
    if (canvas->pixels && canvas->width == size[0] && canvas->height == size[1])
        return paper;
    paper_free(paper);
    if (paper_create(size[0], size[1], paper)) {
        paper_free(paper);
        return NULL;
    }
    player->show.text = paper->text;
    if (!paper->text && !told && (!font || font[0])) {
        fprintf(stderr, "no font: DejaVu Sans is not installed; pictures have "
                        "no words (ELASTO_FONT=FILE.ttf names another font)\n");
        told = true; /* pictures without words are pictures, too */
    }
    return paper;
}

void player_paint(Player *player, Paper *paper)
{
    do {
        player_fill(player);
        if (player->blank)
            canvas_clear(&paper->canvas, 0xff000000u);
        else
            show_draw(paper, &player->show);
    } while (past_drawn(&player->past));
}

void player_paint_card(Player *player, Paper *paper, int card)
{
    show_draw_card(paper, &player->show, card);
    while (past_drawn(&player->past)) { /* what it draws is known only now */
        player_fill(player);
        show_draw_card(paper, &player->show, card);
    }
}
