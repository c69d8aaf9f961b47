/* document.c - writes a frame as lines of text, which document.js shows.
 *
 * A line is a word and its fields, with a tab before each field.  TEXT is
 * markup (text.h) with its numbers filled in; LINE stands for the three fields
 * COLOUR BOLD TEXT; INDEX of a card is its index in the picture.
 *     page NUMBER COUNT NAME      NUMBER 0: a scene, which has the name NAME
 *     topic, sentence, time, picture, event TEXT
 *     text, formula, ask, look, try, claim, notes LINE
 *     told WARNING TEXT           message about the last command
 *     verdict TEXT                verdict on the guess; number of right guesses
 *     asks KIND COORDINATES       the page waits for a guess.  KIND: number,
 *                                 words, or place, which has 1 or 2 coordinates
 *     number NAME LABEL VALUE UNIT CHOICES HELP IDLE SHOWN
 *                                 an option.  CHOICES: names with | between, or
 *                                 "" for a number; IDLE: why it has no effect
 *                                 now, or ""; SHOWN: row (in the window's row),
 *                                 tried (in this row; the text Try asks to
 *                                 change it), or others (only in the full list)
 *     point INDEX X Y             a handle, m
 *     switch INDEX ON LABEL
 *     code LIT TEXT               a line of the page's code, without markup
 *     card INDEX NAME KIND CLOSED TITLE DESCRIPTION
 *                                 KIND: text, covered (before the guess), graph
 *                                 (drawn), or star (drawn larger than the
 *                                 picture); DESCRIPTION: a graph in words
 *     legend INDEX COLOUR NAME VALUE   a row of the graph's legend; VALUE may
 *                                 be missing
 *     words INDEX LINE            a line of a card of kind text
 *     row INDEX LIT STRUCK INDENTED TEXT VALUE   a line of the card's algorithm
 *     cells INDEX COLOUR TEXT ... a row of the card's table, the heads first
 *     step STEP NEWEST PAUSED */
#include "web/document.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"
#include "play/playing.h"
#include "simulation/scene.h"
#include "scenes/scenes.h"

/* A text that grows; words that do not fit in are left out. */
typedef struct Writer {
    char *text; /* [DOCUMENT_SIZE] */
    size_t used_bytes;
} Writer;

__attribute__((format(printf, 2, 3))) static void print(Writer *to,
                                                        const char *format, ...)
{
    char *end = to->text + to->used_bytes;
    write_formatted(end, DOCUMENT_SIZE - to->used_bytes, format);
    to->used_bytes += strlen(end);
}

/* Returns the relative luminance of a colour (WCAG 2.1), 0 ... 1. */
static double find_luminance(Colour colour)
{
    static const double parts[] = {0.0722, 0.7152, 0.2126}; /* b, g, r */
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double part = (colour >> 8 * k & 255) / 255.0;
        sum += parts[k] * (part > 0.04045 ? pow((part + 0.055) / 1.055, 2.4)
                                          : part / 12.92);
    }
    return sum;
}

unsigned document_darken(Colour colour)
{
    const double contrast = 4.6; /* contrast with white; WCAG 2.1 asks 4.5 */
    Colour darker = colour & 0xffffff;
    for (int i = 99; 1.05 / (find_luminance(darker) + 0.05) < contrast; i--) {
        darker = 0;
        for (int k = 0; k < 3; k++)
            darker |= (colour >> 8 * k & 255) * (Colour)i / 100 << 8 * k;
    }
    return darker;
}

/* Writes each line of a text whose values are all known, after `word`. */
static void write_text_lines(Writer *to, const LiveValues *values,
                             const char *word, const char *text)
{
    for (TextLine line = lines_begin(values, text); text_next_line(&line);)
        print(to, "%s\t#%06x\t%d\t%s\n", word, document_darken(line.colour),
              line.face == FACE_BOLD, line.text);
}

/* ---- the page of the lecture --------------------------------------------- */

/* Writes the texts of the page; `look` and `try` if the answer is shown. */
static void write_page_texts(Writer *to, const FrameContent *content)
{
    const LecturePage *page = content->lecture.page;
    const LiveValues *values = &active_pane(content)->values;
    write_text_lines(to, values, "text", page->intro);
    write_text_lines(to, values, "formula", page->formula);
    write_text_lines(to, values, "ask", page->question);
    if (content->lecture.hides_answer) {
        double at[2];
        print(
            to, "asks\t%s\t%d\n",
            page_wants_click(page) ? "place"
            : page->answer_name    ? "number"
                                   : "words",
            simulation_find_shown_point(active_pane(content)->simulation, at));
    } else {
        write_text_lines(to, values, "look", content->lecture.answer_text);
        write_text_lines(to, values, "try", page->try);
    }
    write_text_lines(to, values, "claim", page->claim);
    write_text_lines(to, values, "notes", page->notes);
    for (int i = 0; page->code[i]; i++)
        print(to, "code\t%d\t%s\n",
              strstr(page->code[i], lecture_find_highlight(content)) != NULL,
              page->code[i]);
}

/* ---- cards --------------------------------------------------------------- */

/* Writes the lines of an algorithm that the scene shows now. */
static void write_algorithm_lines(Writer *to, const FrameContent *content,
                                  int card, const ListingRow *row)
{
    const Pane *pane = active_pane(content);
    for (; row->shown_if; row++) {
        if (!text_has_line_to_show(&pane->values, row->shown_if))
            continue;
        const ShownRow now = listing_make_row(pane, row);
        print(to, "row\t%d\t%d\t%d\t%d\t%s\t%s\n", card, now.is_highlighted,
              now.is_crossed_out, row->is_indented, now.text.text,
              now.value.text);
    }
}

/* Writes the energies of the first run, "total 21700 J, elastic 18200 J". */
static void write_energies(Writer *to, const Simulation *simulation)
{
    const Energies energies = simulation_get_energies(simulation, 0);
    for (int i = 0; i < energies.count; i++)
        print(to, "%s%s %s J", i ? ", " : "", energies.energy[i].name,
              format_number(energies.energy[i].value).text);
}

/* Writes the values of the graphs `budget` and `residual` for a description. */
static void write_graph_values(Writer *to, const Pane *pane, const char *name)
{
    const NewtonTrace *trace = pane->shown_trace;
    if (strcmp(name, "budget") == 0) {
        print(to, ": ");
        write_energies(to, pane->simulation);
    } else if (strcmp(name, "residual") == 0 && trace) {
        for (int i = 0; i < trace->record_count; i++)
            print(to, "; update %d: residual %s, step length %s", i + 1,
                  format_number(trace->record[i].residual).text,
                  format_number(trace->record[i].alpha).text);
    }
}

static void write_table_row(Writer *to, const char *word, int index,
                            const CardTableRow *row)
{
    print(to, "%s\t%d\t#%06x", word, index, document_darken(row->colour));
    for (int c = 0; c < row->columns; c++)
        print(to, "\t%s", row->cell[c]);
    print(to, "\n");
}

/* Writes the heads and the last rows of a card's table; false: no rows. */
static bool write_table(Writer *to, const FrameContent *content, int index,
                        const Card *card)
{
    enum { MAX_TABLE_ROWS = 40 };
    CardTableRow row;
    int rows = 0;
    while (card_make_row(content, card, rows, &row))
        rows++;
    for (int i = 0; i < rows; i++) {
        if (i > 0 && i < rows - MAX_TABLE_ROWS)
            continue;
        card_make_row(content, card, i, &row);
        write_table_row(to, "cells", index, &row);
    }
    return rows > 0;
}

/* Writes one or two `card` lines: for the card's graph, with the rows of the
 * legend below, and for the card's text, with the rows of the text below. */
static void write_document_card(Writer *to, const FrameContent *content,
                                int index, const Card *card)
{
    const Pane *pane = active_pane(content);
    const LecturePage *page = content->lecture.page;
    bool covered = content->cards.covered_cards >> index & 1;
    bool graph = !covered && card->draw && !card->is_text_only;
    bool star =
        page && page->main_card && strcmp(page->main_card, card->name) == 0;
    bool closed = content->cards.closed_cards >> index & 1;
    TextLine title = text_find_known_line(&pane->values, card->title);
    CardTableRow row;
    char word[24];
    snprintf(word, sizeof word, "words\t%d", index);
    if (graph) {
        print(to, "card\t%d\t%s\t%s\t%d\t%s\t%s", index, card->name,
              star ? "star" : "graph", closed, title.text, title.text);
        write_graph_values(to, pane, card->name);
        print(to, "\n");
        for (int i = 0;
             card->make_legend_row && card->make_legend_row(content, i, &row);
             i++)
            write_table_row(to, "legend", index, &row);
        TextLine line = lines_begin(&pane->values, card->legend);
        while (text_next_line(&line))
            print(to, "legend\t%d\t#%06x\t%s\n", index,
                  document_darken(line.colour), line.text);
    }
    if (graph && !card->make_row &&
        !text_has_line_to_show(&pane->values, card->words))
        return;
    print(to, "card\t%d\t%s%s\t%s\t%d\t%s\t\n", index, card->name,
          graph ? "-text" : "", covered ? "covered" : "text", closed,
          title.text);
    write_text_lines(to, &pane->values, word,
                     covered ? "after your guess" : card->words);
    if (card->listing && !covered)
        write_algorithm_lines(to, content, index, card->listing);
    if (card->make_row && !covered && !write_table(to, content, index, card))
        write_text_lines(to, &pane->values, word, text_undrawn);
}

/* ---- what can be set ----------------------------------------------------- */

/* Whether the text has a sentence "Drag ..." or "Set ..." with the option. */
static bool text_asks_to_change(const char *text, const OptionRow *row)
{
    const char *name = option_get_label(row);
    size_t length = strlen(name);
    for (; text && *text; text++)
        if (strncmp(text, "Drag ", 5) == 0 || strncmp(text, "Set ", 4) == 0)
            for (const char *at = text; *at && !strchr(".;:", *at); at++)
                if (strchr(" (", *at) && strncmp(at + 1, name, length) == 0 &&
                    strchr(" ,.;:'\n\302", at[1 + length])) /* \302: ~ */
                    return true;
    return false;
}

static void write_options(Writer *to, const Player *player)
{
    const FrameContent *content = &player->screen.frame.content;
    const LecturePage *page =
        content->lecture.hides_answer ? NULL : content->lecture.page;
    const OptionRow *row[OPTIONS_MAX_ROWS];
    const Options now = player_get_shown_options(player);
    int count = player_list_options(player, true, row);
    for (int i = 0; i < count; i++) {
        char value[COMMAND_TEXT_SIZE], unit[16];
        const char *idle = player_find_idle_reason(player, row[i]);
        bool shown = false;
        for (int k = 0; k < player->screen.frame.option_count; k++)
            shown = shown || player->screen.frame.option[k] == row[i];
        option_write_short_value(row[i], &now, value, sizeof value);
        option_write_unit(row[i], unit, sizeof unit);
        print(to, "number\t%s\t%s\t%s\t%s\t", row[i]->name,
              option_get_label(row[i]), value, unit);
        bool named = row[i]->kind == OPTION_NAME;
        for (int k = 0; named && names_get(row[i]->value_names, k); k++)
            print(to, "%s%s", k ? "|" : "", names_get(row[i]->value_names, k));
        bool tried = !named && page && text_asks_to_change(page->try, row[i]);
        const char *place = tried ? "tried" : "row";
        print(to, "\t%s\t%s\t%s\n", row[i]->help, idle ? idle : "",
              shown ? place : "others");
    }
}

static void write_handles_and_switches(Writer *to, const Simulation *simulation)
{
    double at[SCENE_MAX_HANDLES][2];
    SceneSwitch part[SCENE_MAX_SWITCHES];
    int handles = exhibit_list_handles(simulation, at);
    int switches = exhibit_list_switches(simulation, part);
    for (int i = 0; i < handles; i++)
        print(to, "point\t%d\t%.4g\t%.4g\n", i, at[i][0], at[i][1]);
    for (int i = 0; i < switches; i++)
        print(to, "switch\t%d\t%d\t%s\n", i, part[i].is_on, part[i].label);
}

/* ---- what is seen, and what happened ------------------------------------- */

/* Describes size and place of a body, or the place of a point. */
static void describe_shown_body(Writer *to, const Pane *pane)
{
    const Simulation *simulation = pane->simulation;
    double box[4], at[2];
    int nodes = simulation->system.nodes;
    if (nodes > 1) {
        find_node_bounds(pane, 1, box);
        print(to, " Masses: %d, springs: %d, %s m wide and %s m high.", nodes,
              simulation->system.springs, format_number(box[2] - box[0]).text,
              format_number(box[3] - box[1]).text);
    } else if (simulation_find_shown_point(simulation, at) == 1)
        print(to, " The point is at %s.", format_digits(at[0], 4).text);
    else if (simulation_find_shown_point(simulation, at) == 2)
        print(to, " The point is at (%s, %s).", format_digits(at[0], 4).text,
              format_digits(at[1], 4).text);
}

/* Describes the picture: method and shape of each pane, energies, legend. */
static void describe_picture(Writer *to, const Player *player)
{
    const FrameContent *content = &player->screen.frame.content;
    const Simulation *simulation = player_get_simulation(player);
    const LiveValues *values = &active_pane(content)->values;
    print(to, "picture\t");
    for (int p = 0; p < content->panes; p++) {
        const Pane *pane = &content->pane[p];
        const IntegratorMethod *method = pane->simulation->run[0].method;
        if (content->panes > 1)
            print(to, " Picture %d of %d:", p + 1, content->panes);
        if (method && pane->simulation->scene->traits & HAS_TIME)
            print(to, " %s.", method->label);
        describe_shown_body(to, pane);
    }
    print(to, " %s, %s.", content->time_line.label, content->title_bar.state);
    if (simulation->scene->traits & HAS_BODY) {
        print(to, " Energies: ");
        write_energies(to, simulation);
        print(to, ".");
    }
    for (TextLine line = lines_begin(values, active_picture(content)->legend);
         text_next_line(&line);)
        print(to, " %s.", line.text);
    print(to, "\n");
}

/* Describes the last step: "step 12: 3 updates, E fell by 13.8". */
static void describe_shown_step(Writer *to, const Player *player)
{
    const FrameContent *content = &player->screen.frame.content;
    const NewtonTrace *trace = active_pane(content)->shown_trace;
    const StepOutcome *outcome = &player_get_active_pane(player)->outcome;
    const char *turn = player_get_simulation(player)->scene->step_name;
    print(to, "event\t%s %ld", turn ? turn : "step",
          content->time_line.shown_step);
    if (trace && trace->at_line != LINE_NONE &&
        content->title_bar.sentence[0]) {
        print(to, ": %s", content->title_bar.sentence);
    } else if (outcome->updates > 0) {
        print(to, ": %d update%s, %s %s by %s", outcome->updates,
              outcome->updates > 1 ? "s" : "",
              player_get_simulation(player)->scene->step ? "f" : "E",
              outcome->energy_change > 0 ? "rose" : "fell",
              format_number(fabs(outcome->energy_change)).text);
    }
    print(to, "\n");
}

void document_write(const Player *player, char *text)
{
    const FrameContent *content = &player->screen.frame.content;
    const LecturePage *page = content->lecture.page;
    const Picture *picture = active_picture(content);
    Writer writer = {.text = text}, *to = &writer;
    text[0] = '\0';
    const char *name =
        page ? page->name : player_get_simulation(player)->scene->name;
    print(to, "page\t%d\t%d\t%s\n", page ? (int)(page - lecture_pages) + 1 : 0,
          lecture_count_pages(), name);
    print(to, "topic\t%s\nsentence\t%s\n",
          content->title_bar.topic ? content->title_bar.topic : name,
          page ? "" : content->title_bar.sentence);
    print(to, "time\t%s · %s · %s\n", content->time_line.label,
          content->title_bar.method, content->title_bar.state);
    print(to, "told\t%d\t%s\n", content->title_bar.is_warning,
          content->title_bar.message);
    print(to, "step\t%ld\t%ld\t%d\n", content->time_line.shown_step,
          content->time_line.steps, content->time_line.is_paused);
    if (page)
        write_page_texts(to, content);
    if (content->lecture.verdict && !content->lecture.hides_answer) {
        print(to, "verdict\t%s", content->lecture.verdict);
        if (content->lecture.guesses > 1)
            print(to, " %d of %d so far.", content->lecture.right_guesses,
                  content->lecture.guesses);
        print(to, "\n");
    }
    for (int i = 0; i < picture->card_count && content->sheet.cells == 0; i++)
        if (!(content->cards.hidden_cards >> i & 1) &&
            strcmp(picture->cards[i]->name, "page") != 0)
            write_document_card(to, content, i, picture->cards[i]);
    write_options(to, player);
    write_handles_and_switches(to, active_pane(content)->simulation);
    describe_picture(to, player);
    describe_shown_step(to, player);
}

void document_write_lists(char *text)
{
    Writer writer = {.text = text}, *to = &writer;
    text[0] = '\0';
    for (const LecturePage *page = lecture_pages; page->name; page++)
        print(to, "pages\t--lecture+%s\t%s\n", page->name, page->topic);
    for (const Scene *scene = scenes; scene->name && !scene->is_hidden; scene++)
        print(to, "scenes\t%s\t%s: %s\n", scene->name, scene->name,
              scene->description);
    for (int kind = 1; kind < COMMAND_KIND_COUNT; kind++)
        if (command_rows[kind].keys && command_rows[kind].help)
            print(to, "keys\t%s\t%s\n", command_rows[kind].keys,
                  command_rows[kind].help);
}
