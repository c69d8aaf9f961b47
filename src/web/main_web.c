/* main_web.c - functions that page.js calls to begin the program with a command
 * line, to make the frames and to ask about the last frame. */
#include <emscripten.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "lesson/pages.h"
#include "picture/picture.h"
#include "play/playing.h"
#include "simulation/scene.h"
#include "web/document.h"

enum { MAX_COMMAND_WORDS = 512, MAX_COMMAND_LINE_BYTES = 1 << 15 };

/* Limit in bytes for states of past steps, since a tab may have little memory.
 * A state that was dropped is computed again when its step is shown. */
static const size_t PAST_ROOM = 8 << 20;

/* A player and its command line, into whose words the player's options point.
 * A new session replaces the shown session if its command line is right. */
typedef struct Session {
    Player player;
    char text[MAX_COMMAND_LINE_BYTES];
    char *word[MAX_COMMAND_WORDS + 1]; /* words in `text`; NULL ends the list */
} Session;

static volatile sig_atomic_t never = 0;
static Session sessions[2];
static Session *session = &sessions[0]; /* session that the page shows */
static bool has_session;                /* the page shows a session */

/* Begins a session with a command line, one word in each line.  Returns
 * EXIT_NONE, or the exit code if no session begins. */
EMSCRIPTEN_KEEPALIVE int web_begin_session(const char *words)
{
    Session *next = &sessions[has_session && session == &sessions[0]];
    int count = 1;
    snprintf(next->text, sizeof next->text, "elasto\n%s", words);
    next->word[0] = strtok(next->text, "\n");
    while (count < MAX_COMMAND_WORDS &&
           (next->word[count] = strtok(NULL, "\n")))
        count++;
    next->word[count] = NULL;
    int code =
        program_begin(count, next->word, &window_web, &never, &next->player);
    if (code != EXIT_NONE) {
        player_free(&next->player);
        return code;
    }
    if (has_session)
        player_free(&session->player);
    session = next;
    session->player.past.max_bytes = PAST_ROOM;
    has_session = true;
    return code;
}

/* ---- the address -------------------------------------------------------- */

/* Returns the command line that opens the shown scene or page with the shown
 * numbers, one word in each line; "": no such command line exists.  The text
 * is valid until the next call. */
EMSCRIPTEN_KEEPALIVE const char *web_get_command_line(void)
{
    static char words[MAX_COMMAND_LINE_BYTES];
    Player *player = &session->player;
    const Options *given = &player->setup.options[0];
    Options now[OPTIONS_MAX_PANES], base[OPTIONS_MAX_PANES];
    words[0] = '\0';
    if (!has_session)
        return words;
    int panes = player_copy_options(player, now);
    bool same = now->page == given->page && now->scene == given->scene;
    base[0] = *given; /* an option equal to base's is left out */
    if ((panes != given->panes && !now->page) ||
        (!same &&
         player_find_defaults(player, now->scene->name, now->page, base)))
        return words;
    for (int i = 0; same && (i = player_find_first_scene_word(player, i + 1));)
        append(words, sizeof words, "%s\n", player->setup.arguments[i]);
    if (!same)
        append(words, sizeof words, "%s%s", now->page ? "--lecture\n" : "",
               now->page ? now->page->name : now->scene->name);
    for (const OptionRow *row = option_rows; row->name && words[0]; row++) {
        char value[64];
        if (!row->label || panes > 1 || now->page ||
            option_is_equal(row, base, now))
            continue;
        option_write(row, now->number[row->slot], value, sizeof value);
        append(words, sizeof words, "\n--%s\n%s", row->name, value);
    }
    return words;
}

/* ---- the page beside the canvas ------------------------------------------ */

/* Returns the texts of the frame, valid until the next call.  A timer of the
 * page can ask for them after a command and before the next frame. */
EMSCRIPTEN_KEEPALIVE const char *web_get_document(void)
{
    static char text[DOCUMENT_SIZE];
    if (has_session) {
        player_update_frame(&session->player);
        document_write(&session->player, text);
    }
    return text;
}

/* Returns lines for the lists of pages, scenes and keys. */
EMSCRIPTEN_KEEPALIVE const char *web_get_lists(void)
{
    static char text[DOCUMENT_SIZE];
    document_write_lists(text);
    return text;
}

/* Returns the colour of a name in the markup as CSS writes it, "#d55e00". */
EMSCRIPTEN_KEEPALIVE const char *web_get_colour(const char *name)
{
    static char text[8];
    snprintf(text, sizeof text, "#%06x",
             document_darken(colour_find_by_name(name, strlen(name))));
    return text;
}

/* Draws a card of the frame on the card's canvas in the page.  Ignores an
 * index that the page still has from the scene before. */
EMSCRIPTEN_KEEPALIVE void web_draw_card(int card, int width, int height)
{
    static Paper paper;
    Player *player = &session->player;
    if (!has_session)
        return;
    const Picture *picture =
        picture_of_scene(player_get_simulation(player)->scene);
    if (card >= picture->card_count || !picture->cards[card]->draw)
        return;
    canvas_free(&paper.canvas);
    paper.font = player->screen.paper.font;
    if (!canvas_create(width, height, &paper.canvas)) {
        player_update_frame(player);
        frame_draw_card(&paper, &player->screen.frame.content, card);
        web_show_card(&paper.canvas, card);
    }
}

/* Obeys the commands in the queue, or shows why they were refused. */
static void obey_queued_commands(Player *player, Status status)
{
    status = status ? status : player_obey_queue(player, false);
    player_show_refusal(player, status);
    player->screen.must_redraw = true;
}

/* Obeys commands of a script: "set timestep 0.004; flip 1". */
EMSCRIPTEN_KEEPALIVE void web_obey_script(const char *lines)
{
    Player *player = &session->player;
    if (!has_session)
        return;
    player->commands.gesture_id = player->input.mouse.input_gesture_id =
        ++player->commands.gesture_count;
    obey_queued_commands(player, player_enqueue_lines(player, lines));
}

/* Judges a guess at the question of the page and shows the answer. */
EMSCRIPTEN_KEEPALIVE void web_answer_question(const char *guess)
{
    Player *player = &session->player;
    if (has_session && player_hides_answer(player))
        obey_queued_commands(player, player_reveal_answer(player, guess));
}

/* ---- the printed lecture ------------------------------------------------- */

/* Runs a page of the lecture (from 0) up to its printed step in the session for
 * printing, and shows the picture.  Then web_get_document and web_draw_card
 * show this page.  Page -1 returns to the session of the window. */
EMSCRIPTEN_KEEPALIVE void web_print_page(int page, int width, int height)
{
    static bool played, prints;
    const Command next = {.kind = COMMAND_NEXT};
    const LecturePage *row = &lecture_pages[page];
    Session *other = &sessions[session == &sessions[0]];
    Player *player = prints ? &session->player : &other->player;
    Options options;
    char message[256];
    if (prints)
        player_free(player);
    /* Switches from the window's session to the printed session, or back. */
    if (prints != (page >= 0)) {
        played = prints ? played : has_session;
        has_session = prints ? played : true;
        prints = !prints;
        session = other;
    }
    session->player.screen.must_redraw = true;
    if (page < 0)
        return;
    Status status = lecture_make_options(row, &options, MESSAGE(message));
    options.headless = options.quiet = true;
    options.steps = row->printed_step;
    status = status
                 ? status
                 : player_create(&options, NULL, &window_web, &never, player);
    player->screen.draws_frames = true;
    status = status ? status : player_enqueue_page(player);
    status = status ? status : player_obey_queue(player, false);
    status = status ? status : player_enqueue_lines(player, row->on_answer);
    status = status ? status : player_obey_queue(player, false);
    for (int i = 0; i < row->key_presses && !status; i++)
        status = player_obey(player, &next);
    if (!status && !row->key_presses)
        player_run(player);
    /* With a window the player also makes the texts beside the canvas. */
    player->screen.window = &window_web;
    player->screen.paper_size[0] = width;
    player->screen.paper_size[1] = height;
    Paper *paper = player_prepare_paper(player);
    if (!paper)
        return;
    player_paint_frame(player, paper);
    web_show_card(&paper->canvas, -1);
}

/* Hides the answer of the printed page, as before a guess. */
EMSCRIPTEN_KEEPALIVE void web_print_hide_answer(void)
{
    session->player.setup.asks_guess = true;
    session->player.tour.revealed_page = NULL;
    player_build_frame(&session->player);
}

/* ---- the loop ----------------------------------------------------------- */

/* Makes a frame; without a window, frames for SLICE seconds.  Returns the time
 * until the next frame is due, ms; INT_MAX: the next frame waits for an input;
 * < 0: the run has ended. */
EMSCRIPTEN_KEEPALIVE int web_make_frame(void)
{
    Player *player = &session->player;
    double begin = clock_now();
    Status status = STATUS_OK;
    if (!has_session)
        return -1;
    do
        status = player_make_frame(player);
    while (!status && !player->screen.window && !player_has_ended(player) &&
           clock_now() < begin + SLICE);
    if (!status && !player_has_ended(player))
        return player_is_idle(player) ? INT_MAX : player_find_wait_time(player);
    program_end(player, status);
    player_free(player);
    has_session = false;
    return -1;
}
