#include "play/command.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Short names for the columns of the table. */
enum { ONCE = false, REPEATS = true, SEEN = false, KEPT = true };

static const CommandRow command_rows[COMMAND_KINDS] = {
    [COMMAND_NONE] = {COMMAND_NONE, NULL, ARGUMENTS_NONE, NULL, NULL, ONCE,
                      SEEN},
    [COMMAND_REDRAW] = {COMMAND_REDRAW, NULL, ARGUMENTS_NONE, NULL, NULL, ONCE,
                        SEEN},
    [COMMAND_QUIT] = {COMMAND_QUIT, "quit", ARGUMENTS_NONE, "Q", "quit", ONCE,
                      SEEN},
    [COMMAND_TOGGLE_PAUSE] = {COMMAND_TOGGLE_PAUSE, NULL, ARGUMENTS_NONE,
                              "Space", "run or pause", ONCE, SEEN},
    [COMMAND_PLAY] = {COMMAND_PLAY, "play", ARGUMENTS_NONE, NULL, NULL, ONCE,
                      KEPT},
    [COMMAND_PAUSE] = {COMMAND_PAUSE, "pause", ARGUMENTS_NONE, NULL, NULL, ONCE,
                       KEPT},
    [COMMAND_NEXT] = {COMMAND_NEXT, "next", ARGUMENTS_NONE, "N|Right",
                      "one step on; back", REPEATS, KEPT},
    [COMMAND_BACK] = {COMMAND_BACK, "back", ARGUMENTS_NONE, "Left", "", REPEATS,
                      KEPT},
    [COMMAND_STEP] = {COMMAND_STEP, "step", ARGUMENTS_NONE, NULL, NULL, ONCE,
                      KEPT},
    [COMMAND_FINER] = {COMMAND_FINER, "finer", ARGUMENTS_NONE, "I|Shift+N",
                       "go by steps, updates, lines", ONCE, KEPT},
    [COMMAND_HOME] = {COMMAND_HOME, "home", ARGUMENTS_NONE, "Home",
                      "to step 0; to the newest", ONCE, KEPT},
    [COMMAND_END] = {COMMAND_END, "end", ARGUMENTS_NONE, "End", "", ONCE, KEPT},
    [COMMAND_GOTO] = {COMMAND_GOTO, "goto", ARGUMENTS_NUMBER, NULL, NULL, ONCE,
                      KEPT},
    [COMMAND_UNDO] = {COMMAND_UNDO, "undo", ARGUMENTS_NONE, "Ctrl+Z",
                      "undo a change; redo", REPEATS, KEPT},
    [COMMAND_REDO] = {COMMAND_REDO, "redo", ARGUMENTS_NONE, "Ctrl+Shift+Z", "",
                      REPEATS, KEPT},
    [COMMAND_RESTART] = {COMMAND_RESTART, "restart", ARGUMENTS_NONE, "R",
                         "begin again", ONCE, KEPT},
    [COMMAND_FASTER] = {COMMAND_FASTER, "faster", ARGUMENTS_NONE,
                        "+|=", "faster; slower", REPEATS, SEEN},
    [COMMAND_SLOWER] = {COMMAND_SLOWER, "slower", ARGUMENTS_NONE, "-", "",
                        REPEATS, SEEN},
    [COMMAND_FILTER] = {COMMAND_FILTER, "projection", ARGUMENTS_NONE, "P",
                        "projection; line search: off, on", ONCE, KEPT},
    [COMMAND_SEARCH] = {COMMAND_SEARCH, "line-search", ARGUMENTS_NONE, "L", "",
                        ONCE, KEPT},
    [COMMAND_METHOD] = {COMMAND_METHOD, "method", ARGUMENTS_NONE, "M",
                        "next method", ONCE, KEPT},
    [COMMAND_ADD_PANE] = {COMMAND_ADD_PANE, "add-pane", ARGUMENTS_NONE, "Tab+M",
                          "next method, side by side", ONCE, KEPT},
    [COMMAND_END_PANE] = {COMMAND_END_PANE, "end-pane", ARGUMENTS_NONE,
                          "Backspace", "close the last pane", ONCE, KEPT},
    [COMMAND_PANE] = {COMMAND_PANE, "pane", ARGUMENTS_NUMBER, NULL, NULL, ONCE,
                      KEPT},
    [COMMAND_SET] = {COMMAND_SET, "set", ARGUMENTS_TEXT, NULL, NULL, ONCE,
                     KEPT},
    [COMMAND_DEFAULT] = {COMMAND_DEFAULT, "default", ARGUMENTS_TEXT, NULL, NULL,
                         ONCE, SEEN},
    [COMMAND_SELECT] = {COMMAND_SELECT, "select", ARGUMENTS_NONE, "Tab",
                        "next number", REPEATS, SEEN},
    [COMMAND_RAISE] = {COMMAND_RAISE, "raise", ARGUMENTS_NONE, "Up",
                       "make it larger; smaller", REPEATS, SEEN},
    [COMMAND_LOWER] = {COMMAND_LOWER, "lower", ARGUMENTS_NONE, "Down", "",
                       REPEATS, SEEN},
    [COMMAND_SCENE] = {COMMAND_SCENE, "scene", ARGUMENTS_TEXT, NULL, NULL, ONCE,
                       KEPT},
    [COMMAND_START] = {COMMAND_START, "start", ARGUMENTS_POINT, NULL, NULL,
                       ONCE, KEPT},
    [COMMAND_GRAB] = {COMMAND_GRAB, "grab", ARGUMENTS_NUMBER, NULL, NULL, ONCE,
                      KEPT},
    [COMMAND_DRAG] = {COMMAND_DRAG, "drag", ARGUMENTS_POINT, NULL, NULL, ONCE,
                      KEPT},
    [COMMAND_RELEASE] = {COMMAND_RELEASE, "release", ARGUMENTS_NONE, NULL, NULL,
                         ONCE, KEPT},
    [COMMAND_PIN] = {COMMAND_PIN, "pin", ARGUMENTS_NUMBER, NULL, NULL, ONCE,
                     KEPT},
    [COMMAND_HANDLE] = {COMMAND_HANDLE, "handle", ARGUMENTS_NUMBER_POINT, NULL,
                        NULL, ONCE, KEPT},
    [COMMAND_FLIP] = {COMMAND_FLIP, "flip", ARGUMENTS_NUMBER, NULL, NULL, ONCE,
                      KEPT},
    [COMMAND_ZOOM] = {COMMAND_ZOOM, "zoom", ARGUMENTS_NUMBER_POINT, NULL, NULL,
                      ONCE, SEEN},
    [COMMAND_PAN] = {COMMAND_PAN, "pan", ARGUMENTS_POINT, NULL, NULL, ONCE,
                     SEEN},
    [COMMAND_FIT] = {COMMAND_FIT, "fit", ARGUMENTS_NONE, "0", "fit the picture",
                     ONCE, SEEN},
    [COMMAND_COLOURS] = {COMMAND_COLOURS, "colours", ARGUMENTS_NONE, "C",
                         "colours show strain", ONCE, SEEN},
    [COMMAND_BARE] = {COMMAND_BARE, "bare", ARGUMENTS_NONE, "H",
                      "the picture alone", ONCE, SEEN},
    [COMMAND_KEYS] = {COMMAND_KEYS, "keys", ARGUMENTS_NONE, "?|F1",
                      "these keys", ONCE, SEEN},
    [COMMAND_CARD] = {COMMAND_CARD, "card", ARGUMENTS_NUMBER, NULL, NULL, ONCE,
                      SEEN},
    [COMMAND_ENLARGE] = {COMMAND_ENLARGE, "enlarge", ARGUMENTS_NUMBER, NULL,
                         NULL, ONCE, SEEN},
    [COMMAND_PREDICT] = {COMMAND_PREDICT, "predict", ARGUMENTS_POINT, NULL,
                         NULL, ONCE, SEEN},
    [COMMAND_CELL] = {COMMAND_CELL, "cell", ARGUMENTS_NUMBER, NULL, NULL, ONCE,
                      SEEN},
    [COMMAND_PAGE] = {COMMAND_PAGE, "page", ARGUMENTS_TEXT, NULL, NULL, ONCE,
                      KEPT},
    [COMMAND_PAGE_ON] = {COMMAND_PAGE_ON, "page-on", ARGUMENTS_NONE, "PageDown",
                         "the lecture: next page; back", ONCE, KEPT},
    [COMMAND_PAGE_BACK] = {COMMAND_PAGE_BACK, "page-back", ARGUMENTS_NONE,
                           "PageUp", "", ONCE, KEPT},
    [COMMAND_PAGES] = {COMMAND_PAGES, "pages", ARGUMENTS_NONE, "G",
                       "list of pages; code of this page", ONCE, SEEN},
    [COMMAND_CODE] = {COMMAND_CODE, "code", ARGUMENTS_NONE, "K", "", ONCE,
                      SEEN},
    [COMMAND_HASH] = {COMMAND_HASH, "hash", ARGUMENTS_NONE, "Y",
                      "this state: hash and script", ONCE, SEEN},
    [COMMAND_SHOT] = {COMMAND_SHOT, "shot", ARGUMENTS_NONE, "S",
                      "save a picture", ONCE, SEEN},
    [COMMAND_FILM] = {COMMAND_FILM, "film", ARGUMENTS_NONE, "Ctrl+R",
                      "film, and its end", ONCE, SEEN},
    [COMMAND_FULL] = {COMMAND_FULL, "full-screen", ARGUMENTS_NONE, "F11",
                      "full screen", ONCE, SEEN},
    [COMMAND_BLANK] = {COMMAND_BLANK, "blank", ARGUMENTS_NONE, "B",
                       "a black screen", ONCE, SEEN},
    [COMMAND_ESCAPE] = {COMMAND_ESCAPE, "escape", ARGUMENTS_NONE, "Escape",
                        "close what is open; twice: quit", ONCE, SEEN},
};

const CommandRow *command_row(CommandKind kind)
{
    return &command_rows[kind];
}

/* Whether `key` is one of the keys in "A|B". */
static bool is_one_of(const char *keys, const char *key)
{
    size_t length = strlen(key);
    for (const char *at = keys; at && length > 0; at = strchr(at, '|')) {
        at += *at == '|';
        if (strncmp(at, key, length) == 0 &&
            (at[length] == '\0' || at[length] == '|'))
            return true;
    }
    return false;
}

void command_from_key(const char *key, bool repeats, Command *command)
{
    *command = (Command){.kind = COMMAND_NONE};
    if (key[0] >= '1' && key[0] <= '9' && key[1] == '\0') {
        command->kind = repeats ? COMMAND_NONE : COMMAND_SCENE;
        snprintf(command->text, sizeof command->text, "%s", key);
        return;
    }
    for (int i = 0; i < COMMAND_KINDS; i++)
        if (is_one_of(command_rows[i].keys, key) &&
            (!repeats || command_rows[i].repeats))
            command->kind = command_rows[i].kind;
}

/* Says what is wrong. */
static Status refuse(char *message, size_t size, const char *format,
                     const char *word)
{
    snprintf(message, size, format, word);
    return STATUS_INVALID_INPUT;
}

/* The next word of the line, or NULL.  word [COMMAND_TEXT_SIZE] out */
static const char *take_word(const char **line, char *word)
{
    const char *at = *line;
    size_t length = 0;
    while (isspace((unsigned char)*at))
        at++;
    while (at[length] && !isspace((unsigned char)at[length]))
        length++;
    *line = at + length;
    if (length == 0 || length >= COMMAND_TEXT_SIZE)
        return NULL;
    memcpy(word, at, length);
    word[length] = '\0';
    return word;
}

/* A whole number from 0. */
static bool take_number(const char **line, long *number)
{
    char word[COMMAND_TEXT_SIZE], *end = NULL;
    if (!take_word(line, word) || !isdigit((unsigned char)word[0]))
        return false;
    errno = 0;
    *number = strtol(word, &end, 10);
    return errno == 0 && *end == '\0';
}

/* A finite number. */
static bool take_value(const char **line, double *value)
{
    char word[COMMAND_TEXT_SIZE], *end = NULL;
    if (!take_word(line, word))
        return false;
    *value = strtod(word, &end);
    return end != word && *end == '\0' && isfinite(*value);
}

/* The arguments behind the word. */
static bool take_arguments(const char **line, CommandArguments arguments,
                           Command *command)
{
    char word[COMMAND_TEXT_SIZE];
    switch (arguments) {
    case ARGUMENTS_NUMBER:
        return take_number(line, &command->number);
    case ARGUMENTS_NUMBER_POINT:
        return take_number(line, &command->number) &&
               take_value(line, &command->x) && take_value(line, &command->y);
    case ARGUMENTS_POINT:
        return take_value(line, &command->x) && take_value(line, &command->y);
    case ARGUMENTS_TEXT:
        if (!take_word(line, word))
            return false;
        snprintf(command->text, sizeof command->text, "%s", word);
        size_t used = strlen(word);
        if (take_word(line, word))
            return snprintf(command->text + used, sizeof command->text - used,
                            " %s", word) < (int)(sizeof command->text - used);
        return true;
    default:
        return true;
    }
}

/* What stands behind the word, for messages. */
static const char *arguments_text(CommandArguments arguments)
{
    static const char *const text[] = {
        [ARGUMENTS_NONE] = "nothing behind it",
        [ARGUMENTS_NUMBER] = "a whole number from 0 behind it",
        [ARGUMENTS_POINT] = "X Y behind it, two finite numbers",
        [ARGUMENTS_NUMBER_POINT] =
            "N X Y behind it, a whole and two finite numbers",
        [ARGUMENTS_TEXT] = "one or two words behind it",
    };
    return text[arguments];
}

Status command_parse(const char *line, Command *command, char *message,
                     size_t size)
{
    char word[COMMAND_TEXT_SIZE], rest[COMMAND_TEXT_SIZE], text[128];
    *command = (Command){.kind = COMMAND_NONE};
    if (!take_word(&line, word))
        return refuse(message, size, "%sno command", "");
    for (int i = 0; i < COMMAND_KINDS; i++) {
        const CommandRow *row = &command_rows[i];
        if (!row->word || strcmp(row->word, word) != 0)
            continue;
        command->kind = row->kind;
        if (take_arguments(&line, row->arguments, command) &&
            !take_word(&line, rest))
            return STATUS_OK;
        snprintf(text, sizeof text, "'%s' has %s", word,
                 arguments_text(row->arguments));
        return refuse(message, size, "%s", text);
    }
    int used =
        snprintf(message, size, "there is no command '%.20s', they are:", word);
    for (int i = 0; i < COMMAND_KINDS && used < (int)size; i++)
        if (command_rows[i].word)
            used += snprintf(message + used, size - (size_t)used, " %s",
                             command_rows[i].word);
    return STATUS_INVALID_INPUT;
}

void command_format(const Command *command, char *line, size_t size)
{
    const CommandRow *row = &command_rows[command->kind];
    const char *word = row->word ? row->word : "";
    switch (row->arguments) {
    case ARGUMENTS_NUMBER:
        snprintf(line, size, "%s %ld", word, command->number);
        break;
    case ARGUMENTS_POINT:
        snprintf(line, size, "%s %.17g %.17g", word, command->x, command->y);
        break;
    case ARGUMENTS_NUMBER_POINT:
        snprintf(line, size, "%s %ld %.17g %.17g", word, command->number,
                 command->x, command->y);
        break;
    case ARGUMENTS_TEXT:
        snprintf(line, size, "%s %s", word, command->text);
        break;
    default:
        snprintf(line, size, "%s", word);
    }
}
