#include "play/command.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const CommandRow command_rows[COMMAND_KINDS] = {
    [COMMAND_REDRAW] = {NULL, NULL, NULL, SCREEN},
    [COMMAND_QUIT] = {"quit", "Q", "quit", SCREEN},
    [COMMAND_TOGGLE_PAUSE] = {NULL, "Space", "run or pause"},
    [COMMAND_PLAY] = {"play", NULL, NULL, KEPT | SCREEN},
    [COMMAND_PAUSE] = {"pause", NULL, NULL, KEPT | SCREEN},
    [COMMAND_NEXT] = {"next", "N|Right", "one step on; back", REPEATS | KEPT},
    [COMMAND_BACK] = {"back", "Left", "", REPEATS | KEPT},
    [COMMAND_STEP] = {"step", NULL, NULL, KEPT},
    [COMMAND_FINER] = {"finer", "I|Shift+N", "go by steps, updates, lines",
                       KEPT},
    [COMMAND_HOME] = {"home", "Home", "to step 0; to the newest", KEPT},
    [COMMAND_END] = {"end", "End", "", KEPT},
    [COMMAND_GOTO] = {"goto", NULL, NULL, KEPT, ARGUMENTS_NUMBER},
    [COMMAND_UNDO] = {"undo", "Ctrl+Z", "undo a change; redo", REPEATS | KEPT},
    [COMMAND_REDO] = {"redo", "Ctrl+Shift+Z", "", REPEATS | KEPT},
    [COMMAND_RESTART] = {"restart", "R", "begin again", KEPT},
    [COMMAND_FASTER] = {"faster", "+|=", "faster; slower", REPEATS | SCREEN},
    [COMMAND_SLOWER] = {"slower", "-", "", REPEATS | SCREEN},
    [COMMAND_FILTER] = {"projection", "P", "projection; line search: off, on",
                        KEPT},
    [COMMAND_SEARCH] = {"line-search", "L", "", KEPT},
    [COMMAND_METHOD] = {"method", "M", "next method", KEPT},
    [COMMAND_ADD_PANE] = {"add-pane", "Tab+M", "next method, side by side",
                          KEPT},
    [COMMAND_END_PANE] = {"end-pane", "Backspace", "close the last pane", KEPT},
    [COMMAND_PANE] = {"pane", NULL, NULL, KEPT, ARGUMENTS_NUMBER},
    [COMMAND_SET] = {"set", NULL, NULL, KEPT, ARGUMENTS_TEXT},
    [COMMAND_DEFAULT] = {"default", NULL, NULL, 0, ARGUMENTS_TEXT},
    [COMMAND_SELECT] = {"select", "Tab", "next number", REPEATS | SCREEN},
    [COMMAND_RAISE] = {"raise", "Up", "make it larger; smaller", REPEATS},
    [COMMAND_LOWER] = {"lower", "Down", "", REPEATS},
    [COMMAND_SCENE] = {"scene", NULL, NULL, KEPT, ARGUMENTS_TEXT},
    [COMMAND_START] = {"start", NULL, NULL, KEPT, ARGUMENTS_POINT},
    [COMMAND_GRAB] = {"grab", NULL, NULL, KEPT, ARGUMENTS_NUMBER},
    [COMMAND_DRAG] = {"drag", NULL, NULL, KEPT, ARGUMENTS_POINT},
    [COMMAND_RELEASE] = {"release", NULL, NULL, KEPT},
    [COMMAND_PIN] = {"pin", NULL, NULL, KEPT, ARGUMENTS_NUMBER},
    [COMMAND_HANDLE] = {"handle", NULL, NULL, KEPT, ARGUMENTS_NUMBER_POINT},
    [COMMAND_FLIP] = {"flip", NULL, NULL, KEPT, ARGUMENTS_NUMBER},
    [COMMAND_ZOOM] = {"zoom", NULL, NULL, SCREEN, ARGUMENTS_NUMBER_POINT},
    [COMMAND_PAN] = {"pan", NULL, NULL, SCREEN, ARGUMENTS_POINT},
    [COMMAND_FIT] = {"fit", "0", "fit the picture", SCREEN},
    [COMMAND_COLOURS] = {"colours", "C", "colours show strain", SCREEN},
    [COMMAND_BARE] = {"bare", "H", "the picture alone", SCREEN},
    [COMMAND_KEYS] = {"keys", "?|F1", "these keys", SCREEN},
    [COMMAND_CARD] = {"card", NULL, NULL, SCREEN, ARGUMENTS_NUMBER},
    [COMMAND_ENLARGE] = {"enlarge", NULL, NULL, SCREEN, ARGUMENTS_NUMBER},
    [COMMAND_PREDICT] = {"predict", NULL, NULL, 0, ARGUMENTS_POINT},
    [COMMAND_CELL] = {"cell", NULL, NULL, 0, ARGUMENTS_NUMBER},
    [COMMAND_PAGE] = {"page", NULL, NULL, KEPT, ARGUMENTS_TEXT},
    [COMMAND_PAGE_ON] = {"page-on", "PageDown", "the lecture: next page; back",
                         KEPT},
    [COMMAND_PAGE_BACK] = {"page-back", "PageUp", "", KEPT},
    [COMMAND_PAGES] = {"pages", "G", "list of pages; code of this page",
                       SCREEN},
    [COMMAND_CODE] = {"code", "K", "", SCREEN},
    [COMMAND_HASH] = {"hash", "Y", "this state: hash and script", SCREEN},
    [COMMAND_SHOT] = {"shot", "S", "save a picture", SCREEN},
    [COMMAND_FILM] = {"film", "Ctrl+R", "film, and its end", SCREEN},
    [COMMAND_FULL] = {"full-screen", "F11", "full screen", SCREEN},
    [COMMAND_BLANK] = {"blank", "B", "a black screen", SCREEN},
    [COMMAND_ESCAPE] = {"escape", "Escape", "close what is open; twice: quit"},
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
            (!repeats || command_rows[i].flags & REPEATS))
            command->kind = (CommandKind)i;
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
    while (isspace((unsigned char)*line))
        line++;
    command->joins = *line == '&';
    line += command->joins;
    if (!take_word(&line, word))
        return refuse(message, size, "%sno command", "");
    for (int i = 0; i < COMMAND_KINDS; i++) {
        const CommandRow *row = &command_rows[i];
        if (!row->word || strcmp(row->word, word) != 0)
            continue;
        command->kind = (CommandKind)i;
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
    char word[COMMAND_TEXT_SIZE];
    snprintf(word, sizeof word, "%s%s", command->joins ? "& " : "",
             row->word ? row->word : "");
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
