/* main_web.c - the program in a page: page.js begins it with a command line and
 * asks for its frames.
 */
#include <emscripten.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "play/playing.h"
#include "lesson/pages.h"
#include "run/scene.h"

enum { MOST_WORDS = 512, MOST_TEXT = 1 << 15 };

/* Of states of the past; a tab may have little memory, and what gives way is
 * made again. */
static const size_t PAST_ROOM = 8 << 20;

/* A run, with the words that its options point into.  The next one is begun
 * beside it: after a bad command line the old one goes on. */
typedef struct Run {
    Player player;
    char text[MOST_TEXT];
    char *word[MOST_WORDS + 1]; /* NULL ends them */
} Run;

static volatile sig_atomic_t never = 0;
static Run runs[2];
static Run *run = &runs[0]; /* the one that is shown, if `plays` */
static bool plays;

/* Begins a command line, a word a line.  Returns PROGRAM_PLAYS, or the exit
 * code where nothing new is played. */
EMSCRIPTEN_KEEPALIVE int web_begin(const char *words)
{
    Run *next = plays && run == &runs[0] ? &runs[1] : &runs[0];
    int count = 1;
    snprintf(next->text, sizeof next->text, "elasto\n%s", words);
    next->word[0] = strtok(next->text, "\n");
    while (count < MOST_WORDS && (next->word[count] = strtok(NULL, "\n")))
        count++;
    next->word[count] = NULL;
    int code = program_begin(count, next->word, &never, &next->player);
    if (code != PROGRAM_PLAYS) {
        player_free(&next->player);
        return code;
    }
    if (plays)
        player_free(&run->player);
    run = next;
    run->player.past.limit = PAST_ROOM;
    plays = true;
    return code;
}

/* ---- the address -------------------------------------------------------- */

/* The command line that leads to the scene, page and numbers that are shown, a
 * word a line; "": none does.  The same memory each time. */
EMSCRIPTEN_KEEPALIVE const char *web_address(void)
{
    static char words[MOST_TEXT];
    Player *player = &run->player;
    const Options *given = &player->given[0];
    Options now[OPTIONS_MAX_PANES], base[OPTIONS_MAX_PANES];
    words[0] = '\0';
    if (!plays)
        return words;
    int count, panes = player_options(player, now);
    bool same = now->page == given->page && now->scene == given->scene;
    base[0] = *given; /* what the run began with */
    if ((panes != given->panes && !now->page) ||
        (!same &&
         player_own_options(player, now->scene->name, now->page, base, &count)))
        return words;
    for (int i = 0; same && (i = player_next_word(player, i + 1));)
        append(words, sizeof words, "%s\n", player->words[i]);
    if (!same)
        append(words, sizeof words, "%s%s", now->page ? "--lecture\n" : "",
               now->page ? now->page->name : now->scene->name);
    for (const OptionRow *row = option_rows; row->name && words[0]; row++) {
        char was[64], is[64];
        if (!row->label || panes > 1)
            continue;
        option_write(row, base->number[row->slot], was, sizeof was);
        option_write(row, now->number[row->slot], is, sizeof is);
        if (strcmp(was, is) != 0)
            append(words, sizeof words, "\n--%s\n%s", row->name, is);
    }
    return words;
}

/* What the picture shows, in the markup of its texts. */
EMSCRIPTEN_KEEPALIVE const char *web_text(void)
{
    static char text[MOST_TEXT];
    const Show *show = &run->player.show;
    snprintf(text, sizeof text, "%s. %s. %s. %s. %s. %s",
             show->topic ? show->topic : "", show->sentence, show->method,
             show->time_text, show->state, show->message);
    return text;
}

/* ---- the loop ----------------------------------------------------------- */

/* One frame; without a window as many as fit into a slice of time.  Returns ms
 * until the next one is due; below 0: the end. */
EMSCRIPTEN_KEEPALIVE int web_frame(void)
{
    Player *player = &run->player;
    double begin = clock_now();
    Status status = STATUS_OK;
    if (!plays)
        return -1;
    do
        status = player_frame(player);
    while (!status && !player->window && !player_ended(player) &&
           clock_now() < begin + SLICE);
    if (!status && !player_ended(player))
        return player_wait(player);
    program_end(player, status);
    player_free(player);
    plays = false;
    return -1;
}
