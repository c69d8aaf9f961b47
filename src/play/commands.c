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
    [COMMAND_GOTO] = {obey_goto, "goto", NULL, NULL, KEPT, "n"},
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
    [COMMAND_PANE] = {obey_pane, "pane", NULL, NULL, KEPT, "n"},
    [COMMAND_SET] = {obey_set, "set", NULL, NULL, KEPT, "ov"},
    [COMMAND_DEFAULT] = {obey_default, "default", NULL, NULL, 0, "o"},
    [COMMAND_SELECT] = {obey_select, "select", "Tab", "next number",
                        REPEATS | SCREEN},
    [COMMAND_RAISE] = {obey_raise, "raise", "Up", "make it larger; smaller",
                       REPEATS},
    [COMMAND_LOWER] = {obey_raise, "lower", "Down", "", REPEATS},
    [COMMAND_SCENE] = {obey_scene, "scene", "1|2|3|4|5|6|7|8|9", NULL, KEPT,
                       "w"},
    [COMMAND_START] = {obey_start, "start", NULL, NULL, KEPT, "xy"},
    [COMMAND_GRAB] = {obey_grab, "grab", NULL, NULL, KEPT, "n"},
    [COMMAND_DRAG] = {obey_drag, "drag", NULL, NULL, KEPT, "xy"},
    [COMMAND_RELEASE] = {obey_drag, "release", NULL, NULL, KEPT},
    [COMMAND_PIN] = {obey_pin, "pin", NULL, NULL, KEPT, "n"},
    [COMMAND_HANDLE] = {obey_handle, "handle", NULL, NULL, KEPT, "nxy"},
    [COMMAND_FLIP] = {obey_handle, "flip", NULL, NULL, KEPT, "n"},
    [COMMAND_ZOOM] = {obey_camera, "zoom", NULL, NULL, SCREEN, "nxy"},
    [COMMAND_PAN] = {obey_camera, "pan", NULL, NULL, SCREEN, "xy"},
    [COMMAND_FIT] = {obey_camera, "fit", "0", "fit the picture", SCREEN},
    [COMMAND_COLOURS] = {obey_shown, "colours", "C", "colours show strain",
                         SCREEN},
    [COMMAND_BARE] = {obey_shown, "bare", "H", "the picture alone", SCREEN},
    [COMMAND_KEYS] = {obey_column, "keys", "?|F1", "these keys", SCREEN,
                      .chip = "all keys"},
    [COMMAND_CARD] = {obey_card, "card", NULL, NULL, SCREEN, "n"},
    [COMMAND_ENLARGE] = {obey_card, "enlarge", NULL, NULL, SCREEN, "n"},
    [COMMAND_PREDICT] = {obey_predict, "predict", NULL, NULL, 0, "xy"},
    [COMMAND_CELL] = {obey_cell, "cell", NULL, NULL, 0, "n"},
    [COMMAND_PAGE] = {obey_page, "page", NULL, NULL, KEPT, "w"},
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

/* ---- lines of scripts ---------------------------------------------------- */

static const char blanks[] = " \t\r\n";

/* The next word of the line, or "".  word [COMMAND_TEXT_SIZE] out */
static bool take_word(const char **line, char *word)
{
    const char *at = *line + strspn(*line, blanks);
    size_t length = strcspn(at, blanks);
    bool fits = length > 0 && length < COMMAND_TEXT_SIZE;
    snprintf(word, COMMAND_TEXT_SIZE, "%.*s", fits ? (int)length : 0, at);
    *line = at + length;
    return fits;
}

/* What stands behind the word of a command, by the letters of its row. */
static const char *words_of(char letter)
{
    return letter == 'n'   ? " a whole number from 0"
           : letter == 'x' ? " X"
           : letter == 'y' ? " Y"
           : letter == 'o' ? " the name of an option"
           : letter == 'v' ? " a value"
                           : " a word";
}

/* A word as one of them.  An option or a value that makes no sense is refused
 * when the command is obeyed, where somebody knows why. */
static bool read_word(const char *word, char letter, Command *command)
{
    const OptionRow *row;
    double number = strtod(word, NULL);
    char *end = NULL;
    bool one;
    errno = 0;
    switch (letter) {
    case 'n':
        command->number = strtol(word, &end, 10);
        return isdigit((unsigned char)word[0]) && errno == 0 && *end == '\0';
    case 'x':
    case 'y':
        *(letter == 'x' ? &command->x : &command->y) = strtod(word, &end);
        return end != word && *end == '\0' && isfinite(number);
    case 'o':
        row = option_find(word);
        command->number = row ? row - option_rows : -1;
        snprintf(command->text, sizeof command->text, "%s", row ? "" : word);
        return true;
    case 'v':
        if (command->number < 0)
            return true;
        row = &option_rows[command->number];
        one = row->count <= 1 && row->times == 0 && row->kind != OPTION_TEXT &&
              row->kind != OPTION_SWITCH && row->kind != OPTION_PAGE;
        if (one && option_read(row, word, &command->x))
            return true;
        break;
    default:
        break;
    }
    snprintf(command->text, sizeof command->text, "%s", word);
    return true;
}

Status command_parse(const char *line, Command *command, char *message,
                     size_t size)
{
    char word[COMMAND_TEXT_SIZE], next[COMMAND_TEXT_SIZE];
    int kind = 1, used;
    line += strspn(line, blanks);
    *command = (Command){.joins = *line == '&'};
    line += command->joins;
    take_word(&line, word);
    while (kind < COMMAND_KINDS && (!command_rows[kind].word ||
                                    strcmp(command_rows[kind].word, word) != 0))
        kind++;
    if (kind == COMMAND_KINDS) {
        used = snprintf(message, size,
                        "there is no command '%.20s', they are:", word);
        for (kind = 1; kind < COMMAND_KINDS && used < (int)size; kind++)
            if (command_rows[kind].word)
                used += snprintf(message + used, size - (size_t)used, " %s",
                                 command_rows[kind].word);
        return STATUS_INVALID_INPUT;
    }
    command->kind = (CommandKind)kind;
    const char *takes = command_rows[kind].takes;
    bool good = true;
    for (const char *at = takes; at && *at; at++)
        good = good && take_word(&line, next) && read_word(next, *at, command);
    if (good && line[strspn(line, blanks)] == '\0')
        return STATUS_OK;
    used = snprintf(message, size, "behind '%s' stands%s", word,
                    takes ? "" : " nothing");
    for (const char *at = takes; at && *at && used < (int)size; at++)
        used +=
            snprintf(message + used, size - (size_t)used, "%s", words_of(*at));
    return STATUS_INVALID_INPUT;
}

void command_format(const Command *command, char *line, size_t size)
{
    const CommandRow *row = &command_rows[command->kind];
    const OptionRow *option = NULL;
    if (row->takes && row->takes[0] == 'o' && command->number >= 0)
        option = &option_rows[command->number];
    size_t used = (size_t)snprintf(line, size, "%s%s",
                                   command->joins ? "& " : "", row->word);
    for (const char *at = row->takes; at && *at && used < size; at++) {
        char word[COMMAND_TEXT_SIZE];
        if (*at == 'n')
            snprintf(word, sizeof word, "%ld", command->number);
        else if (*at == 'x' || *at == 'y')
            snprintf(word, sizeof word, "%.17g",
                     *at == 'x' ? command->x : command->y);
        else if (*at == 'o' && option)
            snprintf(word, sizeof word, "%s", option->name);
        else if (*at == 'v' && option && !command->text[0])
            option_write(option, command->x, word, sizeof word);
        else
            snprintf(word, sizeof word, "%s", command->text);
        used += (size_t)snprintf(line + used, size - used, " %s", word);
    }
}
