#define _POSIX_C_SOURCE 200809L /* getline */

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
    char *text = NULL, why[600] = "", shown[80];
    size_t room = 0;
    *script = (Script){0};
    if (!name)
        return STATUS_OK;
    one_line(name, shown, sizeof shown);
    FILE *file = fopen(name, "r");
    Status status = file ? STATUS_OK : STATUS_FILE_FAILED;
    long number = 0;
    for (; !status && getline(&text, &room, file) >= 0; number++)
        status = read_line(text, script, why, sizeof why);
    if (!status && !feof(file))
        status = STATUS_FILE_FAILED;
    if (status == STATUS_FILE_FAILED)
        snprintf(message, size, "--script: %s: %s", shown, strerror(errno));
    if (status == STATUS_INVALID_INPUT)
        snprintf(message, size, "--script: %s, line %ld: %s", shown, number,
                 why);
    free(text);
    if (file)
        fclose(file);
    return status == STATUS_FILE_FAILED ? STATUS_INVALID_INPUT : status;
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
