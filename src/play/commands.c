#include "play/command.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/playing.h"

static const CommandRow command_rows[COMMAND_KINDS] = {
    [COMMAND_REDRAW] = {NULL, NULL, NULL, NULL, SCREEN},
    [COMMAND_QUIT] = {obey_quit, "quit", "Q", "quit", SCREEN},
    [COMMAND_TOGGLE_PAUSE] = {NULL, NULL, "Space", "run or pause",
                              .chip = "pause|play"},
    [COMMAND_PLAY] = {obey_pause, "play", NULL, NULL, KEPT | SCREEN},
    [COMMAND_PAUSE] = {obey_pause, "pause", NULL, NULL, KEPT | SCREEN},
    [COMMAND_NEXT] = {obey_next, "next", "N|Right", "one step on; back",
                      REPEATS | KEPT,
                      .chip = "next step|next update|next line|next"},
    [COMMAND_BACK] = {obey_back, "back", "Left", "", REPEATS | KEPT,
                      .chip = "back"},
    [COMMAND_STEP] = {obey_step, "step", NULL, NULL, KEPT},
    [COMMAND_FINER] = {obey_finer, "finer", "I|Shift+N",
                       "go by steps, updates, lines", KEPT,
                       .chip = "updates|lines|steps"},
    [COMMAND_HOME] = {obey_goto, "home", "Home", "to step 0; to the newest",
                      KEPT},
    [COMMAND_END] = {obey_goto, "end", "End", "", KEPT},
    [COMMAND_GOTO] = {obey_goto, "goto", NULL, NULL, KEPT, TAKES_NUMBER},
    [COMMAND_UNDO] = {obey_undo, "undo", "Ctrl+Z", "undo a change; redo",
                      REPEATS | KEPT},
    [COMMAND_REDO] = {obey_undo, "redo", "Ctrl+Shift+Z", "", REPEATS | KEPT},
    [COMMAND_RESTART] = {obey_restart, "restart", "R", "begin again", KEPT,
                         .chip = "restart"},
    [COMMAND_FASTER] = {obey_speed, "faster", "+|=", "faster; slower",
                        REPEATS | SCREEN},
    [COMMAND_SLOWER] = {obey_speed, "slower", "-", "", REPEATS | SCREEN},
    [COMMAND_FILTER] = {obey_switch, "projection", "P",
                        "projection; line search: off, on", KEPT,
                        .chip = "projection off|projection on"},
    [COMMAND_SEARCH] = {obey_switch, "line-search", "L", "", KEPT,
                        .chip = "line search off|line search on"},
    [COMMAND_METHOD] = {obey_method, "method", "M", "next method", KEPT,
                        .chip = "method"},
    [COMMAND_ADD_PANE] = {obey_add_pane, "add-pane", "Tab+M",
                          "next method, side by side", KEPT},
    [COMMAND_END_PANE] = {obey_end_pane, "end-pane", "Backspace",
                          "close the last pane", KEPT},
    [COMMAND_PANE] = {obey_pane, "pane", NULL, NULL, KEPT, TAKES_NUMBER},
    [COMMAND_SET] = {obey_set, "set", NULL, NULL, KEPT, TAKES_VALUE},
    [COMMAND_DEFAULT] = {obey_default, "default", NULL, NULL, 0, TAKES_OPTION},
    [COMMAND_SELECT] = {obey_select, "select", "Tab", "next number",
                        REPEATS | SCREEN},
    [COMMAND_RAISE] = {obey_raise, "raise", "Up", "make it larger; smaller",
                       REPEATS},
    [COMMAND_LOWER] = {obey_raise, "lower", "Down", "", REPEATS},
    [COMMAND_SCENE] = {obey_scene, "scene", "1|2|3|4|5|6|7|8|9", NULL, KEPT,
                       TAKES_WORD},
    [COMMAND_START] = {obey_start, "start", NULL, NULL, KEPT, TAKES_POINT},
    [COMMAND_GRAB] = {obey_grab, "grab", NULL, NULL, KEPT, TAKES_NUMBER},
    [COMMAND_DRAG] = {obey_drag, "drag", NULL, NULL, KEPT, TAKES_POINT},
    [COMMAND_RELEASE] = {obey_drag, "release", NULL, NULL, KEPT},
    [COMMAND_PIN] = {obey_pin, "pin", NULL, NULL, KEPT, TAKES_NUMBER},
    [COMMAND_HANDLE] = {obey_handle, "handle", NULL, NULL, KEPT, TAKES_BOTH},
    [COMMAND_FLIP] = {obey_handle, "flip", NULL, NULL, KEPT, TAKES_NUMBER},
    [COMMAND_ZOOM] = {obey_camera, "zoom", NULL, NULL, SCREEN, TAKES_BOTH},
    [COMMAND_PAN] = {obey_camera, "pan", NULL, NULL, SCREEN, TAKES_POINT},
    [COMMAND_FIT] = {obey_camera, "fit", "0", "fit the picture", SCREEN},
    [COMMAND_COLOURS] = {obey_shown, "colours", "C", "colours show strain",
                         SCREEN},
    [COMMAND_BARE] = {obey_shown, "bare", "H", "the picture alone", SCREEN},
    [COMMAND_KEYS] = {obey_column, "keys", "?|F1", "these keys", SCREEN,
                      .chip = "all keys"},
    [COMMAND_CARD] = {obey_card, "card", NULL, NULL, SCREEN, TAKES_NUMBER},
    [COMMAND_ENLARGE] = {obey_card, "enlarge", NULL, NULL, SCREEN,
                         TAKES_NUMBER},
    [COMMAND_PREDICT] = {obey_predict, "predict", NULL, NULL, 0, TAKES_POINT},
    [COMMAND_CELL] = {obey_cell, "cell", NULL, NULL, 0, TAKES_NUMBER},
    [COMMAND_PAGE] = {obey_page, "page", NULL, NULL, KEPT, TAKES_WORD},
    [COMMAND_PAGE_ON] = {obey_page, "page-on", "PageDown",
                         "the lecture: next page; back", KEPT,
                         .chip = "next page"},
    [COMMAND_PAGE_BACK] = {obey_page, "page-back", "PageUp", "", KEPT},
    [COMMAND_PAGES] = {obey_column, "pages", "G",
                       "list of pages; code of this page", SCREEN,
                       .chip = "pages"},
    [COMMAND_CODE] = {obey_column, "code", "K", "", SCREEN, .chip = "code"},
    [COMMAND_HASH] = {obey_hash, "hash", "Y", "this state: hash and script",
                      SCREEN},
    [COMMAND_SHOT] = {obey_shot, "shot", "S", "save a picture", SCREEN},
    [COMMAND_FILM] = {obey_film, "film", "Ctrl+R", "film, and its end", SCREEN},
    [COMMAND_FULL] = {obey_full, "full-screen", "F11", "full screen", SCREEN},
    [COMMAND_BLANK] = {obey_shown, "blank", "B", "a black screen", SCREEN},
    [COMMAND_ESCAPE] = {obey_escape, "escape", "Escape",
                        "close what is open; twice: quit"},
    /* A row further down has its keys where one above has them, too. */
    [COMMAND_TYPE_NUMBER] = {obey_type, NULL, "0|1|2|3|4|5|6|7|8|9|.|,|+|-",
                             NULL, REPEATS | SCREEN, .keyboard = AT_NUMBER},
    [COMMAND_TYPE_PAGE] = {obey_type, NULL, "1|2|3|4|5|6|7|8|9", NULL,
                           REPEATS | SCREEN, .keyboard = AT_LIST},
    [COMMAND_TYPE] = {obey_type, NULL, "*", NULL, REPEATS | SCREEN,
                      .keyboard = AT_FIELD},
    [COMMAND_ENTER] = {obey_enter, NULL, "Return|Keypad Enter", NULL,
                       REPEATS | SCREEN, .keyboard = AT_FIELD},
    [COMMAND_CLOSE] = {obey_close, NULL, "Escape", NULL, REPEATS | SCREEN,
                       .keyboard = AT_FIELD},
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
        if (strcmp(at, "*") == 0 || (strncmp(at, key, length) == 0 &&
                                     (at[length] == '\0' || at[length] == '|')))
            return true;
    }
    return false;
}

Command command_from_key(const char *key, bool repeats, Keyboard keyboard)
{
    Command command = {.kind = COMMAND_NONE};
    for (int i = COMMAND_KINDS - 1; i > 0 && !command.kind; i--) {
        const CommandRow *row = &command_rows[i];
        unsigned listens = row->keyboard ? row->keyboard : AT_PLAY;
        if (!(listens & keyboard) || !is_one_of(row->keys, key))
            continue;
        if (repeats && !(row->flags & REPEATS))
            break;
        command.kind = (CommandKind)i;
        snprintf(command.text, sizeof command.text, "%s", key);
    }
    return command;
}

/* ---- lines of scripts --------------------------------------------------- */

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

/* Two finite numbers. */
static bool take_point(const char **line, Command *command)
{
    double *value[] = {&command->x, &command->y};
    for (int i = 0; i < 2; i++) {
        char word[COMMAND_TEXT_SIZE], *end = NULL;
        if (!take_word(line, word))
            return false;
        *value[i] = strtod(word, &end);
        if (end == word || *end || !isfinite(*value[i]))
            return false;
    }
    return true;
}

/* Whether a value is one number, or a name. */
static bool is_one_number(const OptionRow *row)
{
    return row->count <= 1 && row->times == 0 &&
           (row->kind == OPTION_NUMBER || row->kind == OPTION_WHOLE ||
            row->kind == OPTION_NAME);
}

/* An option and its value; what makes no sense is refused when it is obeyed,
 * where somebody knows why. */
static bool take_option(const char **line, bool value, Command *command)
{
    char name[COMMAND_TEXT_SIZE];
    if (!take_word(line, name))
        return false;
    const OptionRow *row = option_find(name);
    command->number = row ? row - option_rows : -1;
    if (value && !take_word(line, command->text))
        return false;
    if (!row)
        memcpy(command->text, name, sizeof name);
    else if (value && is_one_number(row) &&
             option_read(row, command->text, &command->x))
        command->text[0] = '\0';
    return true;
}

/* The arguments behind the word. */
static bool take_arguments(const char **line, CommandArguments arguments,
                           Command *command)
{
    switch (arguments) {
    case TAKES_NUMBER:
        return take_number(line, &command->number);
    case TAKES_BOTH:
        return take_number(line, &command->number) && take_point(line, command);
    case TAKES_POINT:
        return take_point(line, command);
    case TAKES_WORD:
        return take_word(line, command->text);
    case TAKES_OPTION:
    case TAKES_VALUE:
        return take_option(line, arguments == TAKES_VALUE, command);
    default:
        return true;
    }
}

Status command_parse(const char *line, Command *command, char *message,
                     size_t size)
{
    static const char *const behind[] = {
        [TAKES_NOTHING] = "nothing",
        [TAKES_NUMBER] = "a whole number from 0",
        [TAKES_POINT] = "X Y",
        [TAKES_BOTH] = "N X Y, a whole and two finite numbers",
        [TAKES_WORD] = "one word",
        [TAKES_OPTION] = "the name of an option",
        [TAKES_VALUE] = "the name of an option and its value",
    };
    char word[COMMAND_TEXT_SIZE] = "", rest[COMMAND_TEXT_SIZE];
    int i = 1;
    while (isspace((unsigned char)*line))
        line++;
    *command = (Command){.joins = *line == '&'};
    line += command->joins;
    take_word(&line, word);
    while (i < COMMAND_KINDS &&
           (!command_rows[i].word || strcmp(command_rows[i].word, word) != 0))
        i++;
    if (i < COMMAND_KINDS) {
        const CommandArguments arguments = command_rows[i].arguments;
        command->kind = (CommandKind)i;
        if (take_arguments(&line, arguments, command) &&
            !take_word(&line, rest))
            return STATUS_OK;
        snprintf(message, size, "'%s' has %s behind it", word,
                 behind[arguments]);
        return STATUS_INVALID_INPUT;
    }
    int used =
        snprintf(message, size, "there is no command '%.20s', they are:", word);
    for (i = 1; i < COMMAND_KINDS && used < (int)size; i++)
        if (command_rows[i].word)
            used += snprintf(message + used, size - (size_t)used, " %s",
                             command_rows[i].word);
    return STATUS_INVALID_INPUT;
}

void command_format(const Command *command, char *line, size_t size)
{
    const CommandRow *row = &command_rows[command->kind];
    CommandArguments arguments = row->arguments;
    bool number = arguments == TAKES_NUMBER || arguments == TAKES_BOTH;
    size_t used = (size_t)snprintf(line, size, "%s%s",
                                   command->joins ? "& " : "", row->word);
    if (number)
        used +=
            (size_t)snprintf(line + used, size - used, " %ld", command->number);
    if (arguments == TAKES_POINT || arguments == TAKES_BOTH)
        snprintf(line + used, size - used, " %.17g %.17g", command->x,
                 command->y);
    if (arguments >= TAKES_OPTION && command->number >= 0)
        used += (size_t)snprintf(line + used, size - used, " %s",
                                 option_rows[command->number].name);
    if (arguments == TAKES_VALUE && command->number >= 0 && !command->text[0]) {
        line[used++] = ' ';
        option_write(&option_rows[command->number], command->x, line + used,
                     size - used);
    } else if (arguments == TAKES_WORD || arguments == TAKES_VALUE ||
               (arguments == TAKES_OPTION && command->number < 0)) {
        snprintf(line + used, size - used, " %s", command->text);
    }
}
