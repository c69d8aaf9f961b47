/* commands.c - finds commands by key, reads and writes them as text; scripts.
 */
#define _POSIX_C_SOURCE 200809L /* getline */

#include "play/command.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/output.h"
#include "lesson/command_line.h"

const CommandRow command_rows[COMMAND_KINDS] = {
#define ROW(kind, deed, ...) [COMMAND_##kind] = {__VA_ARGS__},
#include "play/command_rows.def"
#undef ROW
};

/* Whether a key types text or takes a letter back. */
static bool is_typed(const char *key)
{
    if (strncmp(key, "Shift+", 6) == 0)
        key += 6;
    return !key[1] || strcmp(key, "Space") == 0 ||
           strcmp(key, "Backspace") == 0;
}

/* Whether `key` is one of the keys in "A|B". */
static bool is_one_of(const char *keys, const char *key)
{
    size_t length = strlen(key);
    for (const char *at = keys; at && length > 0; at = strchr(at, '|')) {
        at += *at == '|';
        if (strcmp(at, "*") == 0 ||
            (strcmp(at, "letters") == 0 && is_typed(key)) ||
            (strncmp(at, key, length) == 0 &&
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

/* Prints a line for each command: word, arguments, what it does, first key. */
void commands_help(FILE *file)
{
    fprintf(file,
            "commands of scripts (--script FILE), a line each: STEP COMMAND\n"
            "A line waits until its step is shown; a run that is paused waits "
            "for none.\n\"& COMMAND\" is undone together with the one before "
            "it; # begins a comment.\n"
            "What a page does as it opens stands in the script, too.\n"
            "Tables on pipes keep the rows of steps that were taken back.\n");
    for (int kind = 1; kind < COMMAND_KINDS; kind++) {
        const CommandRow *row = &command_rows[kind];
        char start[64];
        if (!row->word)
            continue;
        snprintf(start, sizeof start, "  %s %s", row->word,
                 row->takes ? row->takes : "");
        fprintf(file, "%-20s %s", start, row->does);
        if (row->keys)
            fprintf(file, " [%.*s]", (int)strcspn(row->keys, "|"), row->keys);
        fprintf(file, "\n");
    }
}

static const char blanks[] = " \t\r\n";

/* Takes the next word of a line.  Returns false if there is none, or if it is
 * too long.
 *   word  [COMMAND_TEXT_SIZE] out */
static bool take_word(const char **line, char *word)
{
    const char *at = *line + strspn(*line, blanks);
    size_t length = strcspn(at, blanks);
    bool fits = length > 0 && length < COMMAND_TEXT_SIZE;
    snprintf(word, COMMAND_TEXT_SIZE, "%.*s", fits ? (int)length : 0, at);
    *line = at + length;
    return fits;
}

/* Returns the next argument of a command, or NULL. */
static const char *next_taken(const char *at)
{
    at = strchr(at, ' ');
    return at ? at + 1 : NULL;
}

/* Reads a word as an argument.  A wrong option or value is refused when the
 * command is obeyed, with its reason. */
static bool read_word(const char *word, const char *taken, Command *command)
{
    const OptionRow *row;
    double number = strtod(word, NULL);
    char *end = NULL;
    bool one;
    errno = 0;
    switch (*taken) {
    case 'N':
        command->number = strtol(word, &end, 10);
        return isdigit((unsigned char)word[0]) && errno == 0 && *end == '\0';
    case 'X':
    case 'Y':
        *(*taken == 'X' ? &command->x : &command->y) = strtod(word, &end);
        return end != word && *end == '\0' && isfinite(number);
    case 'O':
        row = option_find(word);
        command->number = row ? row - option_rows : -1;
        snprintf(command->text, sizeof command->text, "%s", row ? "" : word);
        return true;
    case 'V':
        if (command->number < 0)
            return true;
        row = &option_rows[command->number];
        one = row->count <= 1 && row->max_times == 0 &&
              row->kind != OPTION_TEXT && row->kind != OPTION_SWITCH &&
              row->kind != OPTION_PAGE;
        if (one && option_read(row, 1, word, &command->x))
            return true;
        break;
    default:
        break;
    }
    snprintf(command->text, sizeof command->text, "%s", word);
    return true;
}

Status command_parse(const char *line, Command *command, Message message)
{
    char word[COMMAND_TEXT_SIZE], next[COMMAND_TEXT_SIZE];
    int kind = 1;
    line += strspn(line, blanks);
    *command = (Command){.joins = *line == '&'};
    line += command->joins;
    take_word(&line, word);
    while (kind < COMMAND_KINDS && (!command_rows[kind].word ||
                                    strcmp(command_rows[kind].word, word) != 0))
        kind++;
    if (strcmp(word, "box") == 0)
        return refuse(message, "'box' is gone: place puts one node somewhere");
    if (kind == COMMAND_KINDS)
        return refuse(message,
                      "there is no command '%.20s': elasto --help commands",
                      word);
    command->kind = (CommandKind)kind;
    const char *takes = command_rows[kind].takes;
    bool good = true;
    for (const char *at = takes; at; at = next_taken(at))
        good = good && take_word(&line, next) && read_word(next, at, command);
    if (good && line[strspn(line, blanks)] == '\0')
        return STATUS_OK;
    return refuse(message, "write it as '%s%s%s'", word, takes ? " " : "",
                  takes ? takes : "");
}

void command_format(const Command *command, char *line, size_t size)
{
    const CommandRow *row = &command_rows[command->kind];
    const OptionRow *option = NULL;
    if (row->takes && row->takes[0] == 'O' && command->number >= 0)
        option = &option_rows[command->number];
    snprintf(line, size, "%s%s", command->joins ? "& " : "", row->word);
    for (const char *at = row->takes; at; at = next_taken(at)) {
        char word[COMMAND_TEXT_SIZE];
        if (*at == 'N')
            snprintf(word, sizeof word, "%ld", command->number);
        else if (*at == 'X' || *at == 'Y')
            option_write(NULL, *at == 'X' ? command->x : command->y, word,
                         sizeof word);
        else if (*at == 'O' && option)
            snprintf(word, sizeof word, "%s", option->name);
        else if (*at == 'V' && option && !command->text[0])
            option_write(option, command->x, word, sizeof word);
        else
            snprintf(word, sizeof word, "%s", command->text);
        append(line, size, " %s", word);
    }
}

/* ---- scripts ------------------------------------------------------------- */

Status script_add(Script *script, long step, const Command *command,
                  int gesture)
{
    if (script->count == script->size) {
        size_t size = script->size ? 2 * script->size : 64;
        ScriptLine *line = realloc(script->line, size * sizeof *line);
        if (!line)
            return STATUS_OUT_OF_MEMORY;
        script->line = line;
        script->size = size;
    }
    script->line[script->count++] = (ScriptLine){step, *command, gesture};
    return STATUS_OK;
}

Status script_read(const char *name, Script *script, Message message)
{
    char *text = NULL, why[600] = "", shown[80];
    size_t room = 0;
    *script = (Script){0};
    if (!name)
        return STATUS_OK;
    one_line(name, shown, sizeof shown);
    FILE *file = fopen(name, "r");
    Status status = STATUS_OK;
    long number = 0;
    for (; file && !status && getline(&text, &room, file) >= 0; number++) {
        Command command;
        char *line = text + strspn(text, blanks), *end;
        line[strcspn(line, "#\r\n")] = '\0';
        if (*line == '\0')
            continue;
        errno = 0;
        long step = strtol(line, &end, 10);
        if (!isdigit((unsigned char)*line) || errno ||
            !isspace((unsigned char)*end))
            status =
                refuse(MESSAGE(why), "write STEP COMMAND, such as 40 grab 12");
        else
            status = command_parse(end, &command, MESSAGE(why));
        if (!status)
            status = script_add(script, step, &command, 0);
    }
    if (!file || (!status && !feof(file)))
        status = refuse(message, "--script: %s: %s", shown, strerror(errno));
    else if (status == STATUS_INVALID_INPUT)
        refuse(message, "--script: %s, line %ld: %s", shown, number, why);
    free(text);
    if (file)
        fclose(file);
    return status;
}

/* Whether the next line is of the same drag and replaces this one. */
static bool is_covered(const ScriptLine *line)
{
    return command_rows[line->command.kind].flags & LATEST &&
           line->gesture == line[1].gesture && line->step == line[1].step &&
           line->command.kind == line[1].command.kind &&
           line->command.number == line[1].command.number;
}

Status script_write(const char *name, const char *line, const Script *script)
{
    Output output;
    Status status = output_open(name, NULL, &output);
    if (status)
        return status;
    errno = 0;
    fprintf(output.file, "# %s\n", line);
    int gesture = 0; /* gesture of the previous line */
    for (size_t i = 0; i < script->count; i++) {
        char line[512];
        const ScriptLine *at = &script->line[i];
        Command command = at->command;
        if (i + 1 < script->count && is_covered(at))
            continue;
        if (at->gesture) /* drags join their grab anyway */
            command.joins = at->gesture == gesture &&
                            command.kind != COMMAND_DRAG &&
                            command.kind != COMMAND_RELEASE;
        gesture = at->gesture;
        command_format(&command, line, sizeof line);
        fprintf(output.file, "%ld %s\n", at->step, line);
    }
    return output_close(&output, KEEP_WHOLE);
}

const Command *script_due(Script *script, long step, bool waits)
{
    if (script_is_over(script))
        return NULL;
    const ScriptLine *line = &script->line[script->next];
    if (waits && step < line->step)
        return NULL;
    script->next++;
    return &line->command;
}

bool script_is_over(const Script *script)
{
    return script->next >= script->count;
}

void script_free(Script *script)
{
    free(script->line);
    *script = (Script){0};
}
