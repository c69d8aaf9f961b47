#include "play/command.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/playing.h"

static const CommandRow command_rows[COMMAND_KINDS] = {
    [COMMAND_REDRAW] = {NULL, NULL, NULL, NULL, NULL, SCREEN},
    [COMMAND_QUIT] = {obey_quit, "quit", "ends the program", "Q", "quit",
                      SCREEN, .keyboard = AT_PLAY | AT_SHEET},
    [COMMAND_TOGGLE_PAUSE] = {NULL, NULL, "runs, or stops", "Space",
                              "run or pause", .chip = "pause|play"},
    [COMMAND_PLAY] = {obey_pause, "play", "runs", NULL, NULL, KEPT | SCREEN},
    [COMMAND_PAUSE] = {obey_pause, "pause", "stops", NULL, NULL, KEPT | SCREEN},
    [COMMAND_NEXT] = {obey_next, "next", "one on: a step, an update or a line",
                      "N|Right", "one step on; back", REPEATS | KEPT,
                      .chip = "next step|next update|next line|next"},
    [COMMAND_BACK] = {obey_back, "back",
                      "one back: a step, an update or a line", "Left", "",
                      REPEATS | KEPT, .chip = "back"},
    [COMMAND_STEP] = {obey_step, "step", "a whole new step from here", NULL,
                      NULL, KEPT},
    [COMMAND_FINER] = {obey_finer, "finer",
                       "goes by steps, updates, lines of Algorithm 3, steps",
                       "I|Shift+N", "go by steps, updates, lines", KEPT,
                       .chip = "updates|lines|steps"},
    [COMMAND_HOME] = {obey_goto, "home", "shows step 0", "Home",
                      "to step 0; to the newest", KEPT},
    [COMMAND_END] = {obey_goto, "end", "shows the newest step", "End", "",
                     KEPT},
    [COMMAND_GOTO] = {obey_goto, "goto", "shows this step", NULL, NULL, KEPT,
                      "n"},
    [COMMAND_UNDO] = {obey_undo, "undo", "what was changed last is not",
                      "Ctrl+Z", "undo a change; redo", REPEATS | KEPT},
    [COMMAND_REDO] = {obey_undo, "redo", "what was undone last is again",
                      "Ctrl+Shift+Z", "", REPEATS | KEPT},
    [COMMAND_RESTART] = {obey_restart, "restart",
                         "begins again with the present numbers", "R",
                         "begin again", KEPT, .chip = "restart"},
    [COMMAND_FASTER] = {obey_speed, "faster", "twice as many steps a second",
                        "+|=", "faster; slower", REPEATS | SCREEN},
    [COMMAND_SLOWER] = {obey_speed, "slower", "half as many steps a second",
                        "-", "", REPEATS | SCREEN},
    [COMMAND_FILTER] = {obey_switch, "projection",
                        "projection off, or on again: the step once more", "P",
                        "projection; line search: off, on", KEPT,
                        .chip = "projection off|projection on"},
    [COMMAND_SEARCH] = {obey_switch, "line-search",
                        "line search off, or on again: the step once more", "L",
                        "", KEPT, .chip = "line search off|line search on"},
    [COMMAND_METHOD] = {obey_method, "method", "the next integrator", "M",
                        "next method", KEPT, .chip = "method"},
    [COMMAND_ADD_PANE] = {obey_add_pane, "add-pane",
                          "the next integrator, beside this one", "Tab+M",
                          "next method, side by side", KEPT},
    [COMMAND_END_PANE] = {obey_end_pane, "end-pane", "the last pane goes",
                          "Backspace", "close the last pane", KEPT},
    [COMMAND_PANE] = {obey_pane, "pane",
                      "the pane whose numbers are shown, from 0", NULL, NULL,
                      KEPT, "n"},
    [COMMAND_SET] = {obey_set, "set", "an option, as on the command line", NULL,
                     NULL, KEPT, "ov"},
    [COMMAND_DEFAULT] = {obey_default, "default",
                         "an option gets its default back", NULL, NULL, 0, "o"},
    [COMMAND_SELECT] = {obey_select, "select",
                        "lights the next number of the row", "Tab",
                        "next number", REPEATS | SCREEN},
    [COMMAND_OPTIONS] = {obey_column, "options",
                         "lists all numbers of the scene", "A",
                         "add a number to the row", SCREEN},
    [COMMAND_ADD] = {obey_add, "add", "puts an option into the row of numbers",
                     NULL, NULL, SCREEN, "o"},
    [COMMAND_RAISE] = {obey_raise, "raise", "the lit number goes a pace up",
                       "Up", "make it larger; smaller", REPEATS},
    [COMMAND_LOWER] = {obey_raise, "lower", "the lit number goes a pace down",
                       "Down", "", REPEATS},
    [COMMAND_SCENE] = {obey_scene, "scene", "another scene, by name or number",
                       "1|2|3|4|5|6|7|8|9", NULL, KEPT, "w"},
    [COMMAND_START] = {obey_start, "start", "where the scene begins, m", NULL,
                       NULL, KEPT, "xy"},
    [COMMAND_GRAB] = {obey_grab, "grab", "the hand takes a node", NULL, NULL,
                      KEPT, "n"},
    [COMMAND_DRAG] = {obey_drag, "drag", "the hand draws it there, m", NULL,
                      NULL, KEPT, "xy"},
    [COMMAND_RELEASE] = {obey_drag, "release", "the hand lets go", NULL, NULL,
                         KEPT},
    [COMMAND_PIN] = {obey_pin, "pin", "pins a node, or sets it free", NULL,
                     NULL, KEPT, "n"},
    [COMMAND_PLACE] = {obey_place, "place", "puts a node there, m", NULL, NULL,
                       KEPT, "nxy"},
    [COMMAND_OBSTACLE] = {obey_obstacle, "obstacle",
                          "moves a ground or, numbered on, a ball there, m",
                          NULL, NULL, KEPT, "nxy"},
    [COMMAND_HANDLE] = {obey_handle, "handle",
                        "moves a point of the scene there, m", NULL, NULL, KEPT,
                        "nxy"},
    [COMMAND_FLIP] = {obey_handle, "flip", "switches a part of the scene", NULL,
                      NULL, KEPT, "n"},
    [COMMAND_ZOOM] = {obey_camera, "zoom",
                      "percent, and the point that stays, m", NULL, NULL,
                      SCREEN, "nxy"},
    [COMMAND_PAN] = {obey_camera, "pan", "moves the picture so far, m", NULL,
                     NULL, SCREEN, "xy"},
    [COMMAND_FIT] = {obey_camera, "fit", "all of it in the picture", "0",
                     "fit the picture", SCREEN},
    [COMMAND_COLOURS] = {obey_shown, "colours",
                         "springs by their strain, or as they were", "C",
                         "colours show strain", SCREEN},
    [COMMAND_BARE] = {obey_shown, "bare", "the picture alone, or all", "H",
                      "the picture alone", SCREEN},
    [COMMAND_KEYS] = {obey_column, "keys", "the list of keys", "?|F1",
                      "these keys", SCREEN, .chip = "all keys"},
    [COMMAND_CARD] = {obey_card, "card", "closes a card, or opens it", NULL,
                      NULL, SCREEN, "n"},
    [COMMAND_ENLARGE] = {obey_card, "enlarge",
                         "a card takes the column, or gives it back", NULL,
                         NULL, SCREEN, "n"},
    [COMMAND_PREDICT] = {obey_predict, "predict",
                         "where the next step will lead, m", NULL, NULL, 0,
                         "xy"},
    [COMMAND_CELL] = {obey_cell, "cell", "shows a cell of the envelope", NULL,
                      NULL, 0, "n"},
    [COMMAND_PAGE] = {obey_page, "page",
                      "a page of the lecture, by number or name", NULL, NULL,
                      KEPT, "w"},
    [COMMAND_PAGE_ON] = {obey_page, "page-on",
                         "the next page; outside of the lecture the first",
                         "PageDown", "the lecture: next page; back", KEPT,
                         .keyboard = AT_PLAY | AT_SHEET, .chip = "next page"},
    [COMMAND_PAGE_BACK] = {obey_page, "page-back", "the page before", "PageUp",
                           "", KEPT, .keyboard = AT_PLAY | AT_SHEET,
                           .chip = "back"},
    [COMMAND_SHEET] = {obey_sheet, "sheet",
                       "all scenes as small pictures, or the run again", "G",
                       "all scenes; all pages; code of a page", SCREEN,
                       .keyboard = AT_PLAY | AT_SHEET, .chip = "scenes|back"},
    [COMMAND_PAGES] = {obey_column, "pages", "the list of pages", "Shift+G", "",
                       SCREEN, .keyboard = AT_PLAY | AT_SHEET, .chip = "pages"},
    [COMMAND_CODE] = {obey_column, "code", "the text of the page's function",
                      "K", "", SCREEN, .chip = "code"},
    [COMMAND_HASH] = {obey_hash, "hash",
                      "the hash of the state, and a script that leads to it",
                      "Y", "this state: hash and script", SCREEN},
    [COMMAND_SHOT] = {obey_shot, "shot", "saves a picture", "S",
                      "save a picture", SCREEN, .keyboard = AT_PLAY | AT_SHEET},
    [COMMAND_FILM] = {obey_film, "film", "begins a film, or ends it", "Ctrl+R",
                      "film, and its end", SCREEN,
                      .keyboard = AT_PLAY | AT_SHEET},
    [COMMAND_FULL] = {obey_full, "full-screen", "full screen and back", "F11",
                      "full screen", SCREEN, .keyboard = AT_PLAY | AT_SHEET},
    [COMMAND_BLANK] = {obey_shown, "blank", "a black screen and back", "B",
                       "a black screen", SCREEN,
                       .keyboard = AT_PLAY | AT_SHEET},
    [COMMAND_ESCAPE] = {obey_escape, "escape",
                        "closes what is open; twice ends the program", "Escape",
                        "close what is open; twice: quit",
                        .keyboard = AT_PLAY | AT_SHEET},
    /* A row further down has its keys where one above has them, too. */
    [COMMAND_TYPE_NUMBER] = {obey_type, NULL, NULL,
                             "0|1|2|3|4|5|6|7|8|9|.|,|+|-", NULL,
                             REPEATS | SCREEN,
                             .keyboard = AT_NUMBER | AT_QUESTION},
    [COMMAND_TYPE_PAGE] = {obey_type, NULL, NULL, "1|2|3|4|5|6|7|8|9", NULL,
                           REPEATS | SCREEN, .keyboard = AT_LIST | AT_SHEET},
    [COMMAND_CHOOSE] = {obey_choose, NULL, NULL, "Left|Right|Up|Down", NULL,
                        REPEATS | SCREEN, .keyboard = AT_SHEET},
    [COMMAND_OPEN] = {obey_open, NULL, NULL, "Return|Keypad Enter|Space", NULL,
                      0, .keyboard = AT_SHEET},
    [COMMAND_TYPE] = {obey_type, NULL, NULL, "*", NULL, REPEATS | SCREEN,
                      .keyboard = AT_FIELD},
    [COMMAND_ENTER] = {obey_enter, NULL, NULL, "Return|Keypad Enter", NULL,
                       REPEATS | SCREEN, .keyboard = AT_FIELD},
    [COMMAND_CLOSE] = {obey_close, NULL, NULL, "Escape", NULL, REPEATS | SCREEN,
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

/* A line for each: its word, what stands behind it, what it does, its keys. */
void commands_help(FILE *file)
{
    fprintf(file,
            "commands of scripts (--script FILE), a line each: STEP COMMAND\n"
            "A line waits until its step is shown; a run that is paused waits "
            "for none.\n\"& COMMAND\" is undone together with the one before "
            "it; # begins a comment.\n");
    for (int kind = 1; kind < COMMAND_KINDS; kind++) {
        const CommandRow *row = &command_rows[kind];
        char start[64];
        if (!row->word)
            continue;
        size_t used = (size_t)snprintf(start, sizeof start, "  %s", row->word);
        for (const char *at = row->takes; at && *at; at++)
            used += (size_t)snprintf(start + used, sizeof start - used, " %s",
                                     *at == 'n'   ? "N"
                                     : *at == 'x' ? "X"
                                     : *at == 'y' ? "Y"
                                     : *at == 'o' ? "OPTION"
                                     : *at == 'v' ? "VALUE"
                                                  : "NAME");
        fprintf(file, "%-20s %s", start, row->does);
        if (row->keys)
            fprintf(file, " [%.*s]", (int)strcspn(row->keys, "|"), row->keys);
        fprintf(file, "\n");
    }
}

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
