/* commands.c - finds commands by key, reads and writes commands and scripts. */
#include "play/command.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/output.h"
#include "lesson/command_line.h"

const CommandRow command_rows[COMMAND_KIND_COUNT] = {
#define ROW(kind, function, ...) [COMMAND_##kind] = {__VA_ARGS__},
#include "play/command_rows.def"
#undef ROW
};

/* Whether a key types or deletes a letter. */
static bool key_types_text(const char *key)
{
    if (strncmp(key, "Shift+", 6) == 0)
        key += 6;
    return !key[1] || strcmp(key, "Space") == 0 ||
           strcmp(key, "Backspace") == 0;
}

/* Whether a list of keys, "A|B", has this key. */
static bool keys_include(const char *keys, const char *key)
{
    size_t length = strlen(key);
    for (const char *at = keys; at && length > 0; at = strchr(at, '|')) {
        at += *at == '|';
        if (strcmp(at, "*") == 0 ||
            (strcmp(at, "letters") == 0 && key_types_text(key)) ||
            (strncmp(at, key, length) == 0 &&
             (at[length] == '\0' || at[length] == '|')))
            return true;
    }
    return false;
}

Command command_from_key(const char *key, bool repeats, KeyScope scope)
{
    Command command = {.kind = COMMAND_NONE};
    for (int i = COMMAND_KIND_COUNT - 1; i > 0 && !command.kind; i--) {
        const CommandRow *row = &command_rows[i];
        unsigned listens = row->key_scope ? row->key_scope : SCOPE_PLAY;
        if (!(listens & scope) || !keys_include(row->keys, key))
            continue;
        if (repeats && !(row->flags & REPEATS))
            break;
        command.kind = (CommandKind)i;
        snprintf(command.text, sizeof command.text, "%s", key);
    }
    return command;
}

/* ---- lines of scripts ---------------------------------------------------- */

void commands_print_help(FILE *file)
{
    fprintf(file,
            "commands of scripts (--script FILE), a line each: STEP COMMAND\n"
            "A line waits until its step is shown; a run that is paused waits "
            "for none.\n\"& COMMAND\" is undone together with the one before "
            "it; # begins a comment.\n"
            "What a page does as it opens stands in the script, too.\n"
            "Tables keep the rows of steps that were taken back.\n");
    for (int kind = 1; kind < COMMAND_KIND_COUNT; kind++) {
        const CommandRow *row = &command_rows[kind];
        char start[64];
        if (!row->name)
            continue;
        snprintf(start, sizeof start, "  %s %s", row->name,
                 row->args ? row->args : "");
        fprintf(file, "%-20s %s", start, row->help);
        if (row->keys)
            fprintf(file, " [%.*s]", (int)strcspn(row->keys, "|"), row->keys);
        fprintf(file, "\n");
    }
}

static const char blanks[] = " \t\r\n";

/* Takes the next word from a line.  Returns false if there is no word, or if it
 * is too long.
 *   word  [COMMAND_TEXT_SIZE] out */
static bool take_next_word(const char **line, char *word)
{
    const char *at = *line + strspn(*line, blanks);
    size_t length = strcspn(at, blanks);
    bool fits = length > 0 && length < COMMAND_TEXT_SIZE;
    snprintf(word, COMMAND_TEXT_SIZE, "%.*s", fits ? (int)length : 0, at);
    *line = at + length;
    return fits;
}

/* Returns the next argument in CommandRow.args, or NULL. */
static const char *skip_to_next_argument(const char *at)
{
    at = strchr(at, ' ');
    return at ? at + 1 : NULL;
}

/* Reads a word as the argument of this kind, 'N' for example.  A wrong option
 * or value is refused when the command is obeyed, with its reason. */
static bool read_argument(const char *word, char kind, Command *command)
{
    const OptionRow *row;
    double *number = kind == 'X' ? &command->x : &command->y;
    char *end = NULL;
    bool one;
    switch (kind) {
    case 'N':
        command->number = strtol(word, &end, 10);
        return isdigit((unsigned char)word[0]) && *end == '\0';
    case 'X':
    case 'Y':
        *number = strtod(word, &end);
        return end != word && *end == '\0' && isfinite(*number);
    case 'O':
        row = option_find(word);
        command->number = row ? row - option_rows : -1;
        snprintf(command->text, sizeof command->text, "%s", row ? "" : word);
        return true;
    case 'V':
        if (command->number < 0) /* unknown option */
            return append(command->text, sizeof command->text, " %s", word),
                   true;
        row = &option_rows[command->number];
        one = row->number_count <= 1 && row->max_repetitions == 0 &&
              row->kind != OPTION_TEXT && row->kind != OPTION_SWITCH &&
              row->kind != OPTION_PAGE;
        if (one && option_parse(row, 1, word, &command->x))
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
    *command = (Command){.joins_gesture = *line == '&'};
    line += command->joins_gesture;
    take_next_word(&line, word);
    while (kind < COMMAND_KIND_COUNT &&
           (!command_rows[kind].name ||
            strcmp(command_rows[kind].name, word) != 0))
        kind++;
    if (kind == COMMAND_KIND_COUNT)
        return refuse(message,
                      "there is no command '%.20s': elasto --help commands",
                      word);
    command->kind = (CommandKind)kind;
    const char *takes = command_rows[kind].args;
    bool good = true;
    for (const char *at = takes; at && good; at = skip_to_next_argument(at))
        good = take_next_word(&line, next) && read_argument(next, *at, command);
    if (good && line[strspn(line, blanks)] == '\0')
        return STATUS_OK;
    return refuse(message, "write it as '%s%s%s'", word, takes ? " " : "",
                  takes ? takes : "");
}

void command_format(const Command *command, char *line, size_t size)
{
    const CommandRow *row = &command_rows[command->kind];
    const OptionRow *option = NULL;
    if (row->args && row->args[0] == 'O' && command->number >= 0)
        option = &option_rows[command->number];
    snprintf(line, size, "%s%s", command->joins_gesture ? "& " : "", row->name);
    for (const char *at = row->args; at; at = skip_to_next_argument(at)) {
        char word[COMMAND_TEXT_SIZE];
        if (*at == 'V' && command->number < 0)
            continue; /* `text` has name and value of an unknown option */
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

bool command_replaces(const Command *command, const Command *before)
{
    return command_rows[command->kind].flags & REPLACES_SAME &&
           command->kind == before->kind && command->number == before->number;
}

/* ---- scripts ------------------------------------------------------------- */

Status script_add(Script *script, long step, const Command *command,
                  int gesture)
{
    ScriptLine line = {step, *command, gesture};
    ScriptLine *last = script->lines ? script->line + script->lines - 1 : NULL;
    bool same = gesture && last && last->gesture_id == gesture;
    if (gesture) /* "&" marks all but a drag and a release */
        line.command.joins_gesture = same && command->kind != COMMAND_DRAG &&
                                     command->kind != COMMAND_RELEASE;
    if (same && last->due_step == step &&
        command_replaces(command, &last->command)) {
        line.command.joins_gesture = last->command.joins_gesture;
        *last = line;
        return STATUS_OK;
    }
    if (script->lines == script->capacity) {
        size_t size = script->capacity ? 2 * script->capacity : 64;
        ScriptLine *lines = realloc(script->line, size * sizeof *lines);
        if (!lines)
            return STATUS_OUT_OF_MEMORY;
        script->line = lines;
        script->capacity = size;
    }
    script->line[script->lines++] = line;
    return STATUS_OK;
}

Status script_read(const char *name, Script *script, Message message)
{
    char *text = NULL, why[600] = "";
    size_t room = 0;
    *script = (Script){0};
    if (!name)
        return STATUS_OK;
    FILE *file = fopen(name, "r");
    Status status = STATUS_OK;
    long number = 0;
    for (; file && !status && getline(&text, &room, file) >= 0; number++) {
        Command command;
        char *line = text + strspn(text, blanks), *end;
        line[strcspn(line, "#\r\n")] = '\0';
        if (*line == '\0')
            continue;
        long step = strtol(line, &end, 10);
        if (!isdigit((unsigned char)*line) || !isspace((unsigned char)*end))
            status =
                refuse(MESSAGE(why), "write STEP COMMAND, such as 40 grab 12");
        else
            status = command_parse(end, &command, MESSAGE(why));
        if (!status)
            status = script_add(script, step, &command, 0);
    }
    if (!file || (!status && !feof(file)))
        status = refuse(message, "--script: %.80s: %s", name, strerror(errno));
    else if (status == STATUS_INVALID_INPUT)
        refuse(message, "--script: %.80s, line %ld: %s", name, number, why);
    free(text);
    if (file)
        fclose(file);
    return status;
}

Status script_write(const char *name, const char *line, const Script *script)
{
    OutputFile output;
    Status status = output_open(name, NULL, &output);
    if (status)
        return status;
    errno = 0;
    fprintf(output.file, "# %s\n", line);
    for (size_t i = 0; i < script->lines; i++) {
        char text[512];
        command_format(&script->line[i].command, text, sizeof text);
        fprintf(output.file, "%ld %s\n", script->line[i].due_step, text);
    }
    return output_close(&output, KEEP_FILE);
}

const Command *script_take_due_command(Script *script, long step, bool waits)
{
    if (script_is_over(script))
        return NULL;
    const ScriptLine *line = &script->line[script->next_line];
    if (waits && step < line->due_step)
        return NULL;
    script->next_line++;
    return &line->command;
}

bool script_is_over(const Script *script)
{
    return script->next_line >= script->lines;
}

void script_free(Script *script)
{
    free(script->line);
    *script = (Script){0};
}
