#include "play/script.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/output.h"
#include "scenes/one_line.h"

Status script_add(Script *script, long step, const Command *command)
{
    if (script->count == script->size) {
        size_t size = script->size ? 2 * script->size : 64;
        ScriptLine *line = realloc(script->line, size * sizeof *line);
        if (!line)
            return STATUS_OUT_OF_MEMORY;
        script->line = line;
        script->size = size;
    }
    script->line[script->count++] = (ScriptLine){step, *command, 0};
    return STATUS_OK;
}

/* One line of the file; an empty one adds nothing. */
static Status read_line(char *text, Script *script, char *message, size_t size)
{
    Command command;
    char *end = NULL;
    text[strcspn(text, "#\r\n")] = '\0';
    while (isspace((unsigned char)*text))
        text++;
    if (*text == '\0')
        return STATUS_OK;
    errno = 0;
    long step = strtol(text, &end, 10);
    if (!isdigit((unsigned char)*text) || errno ||
        !isspace((unsigned char)*end)) {
        snprintf(message, size, "a line is STEP COMMAND, the step a number");
        return STATUS_INVALID_INPUT;
    }
    Status status = command_parse(end, &command, message, size);
    return status ? status : script_add(script, step, &command);
}

Status script_read(const char *name, Script *script, char *message, size_t size)
{
    char *text = NULL, why[600] = "";
    size_t room = 0;
    *script = (Script){0};
    message[0] = '\0';
    FILE *file = fopen(name, "r");
    if (!file)
        return STATUS_FILE_FAILED;
    Status status = STATUS_OK;
    long number = 0;
    for (; !status && getline(&text, &room, file) >= 0; number++)
        status = read_line(text, script, why, sizeof why);
    if (status == STATUS_INVALID_INPUT)
        snprintf(message, size, "line %ld: %s", number, why);
    one_line(message, message, size);
    if (!status && !feof(file))
        status = STATUS_FILE_FAILED;
    int reason = errno;
    free(text);
    fclose(file);
    errno = reason;
    return status;
}

Status script_write(const char *name, const Script *script)
{
    Output output;
    Status status = output_open(name, &output);
    if (status)
        return status;
    errno = 0;
    for (size_t i = 0; i < script->count; i++) {
        char line[512];
        const ScriptLine *at = &script->line[i];
        Command command = at->command;
        if (at->gesture) /* drags go on with what was grabbed by themselves */
            command.joins = i > 0 && at->gesture == at[-1].gesture &&
                            command.kind != COMMAND_DRAG &&
                            command.kind != COMMAND_RELEASE;
        command_format(&command, line, sizeof line);
        fprintf(output.file, "%ld %s\n", at->step, line);
    }
    return output_close(&output);
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
