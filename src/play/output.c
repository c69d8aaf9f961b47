#include "play/output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* "-" and the device that means the same. */
bool output_is_standard(const char *name)
{
    return strcmp(name, "-") == 0 || strcmp(name, "/dev/stdout") == 0;
}

/* first and second, in memory of its own, or NULL. */
static char *join_texts(const char *first, const char *second)
{
    size_t size = strlen(first) + strlen(second) + 1;
    char *text = malloc(size);
    if (text)
        snprintf(text, size, "%s%s", first, second);
    return text;
}

/* Forgets the names; keeps errno. */
static void output_forget(Output *output)
{
    int reason = errno;
    free(output->name);
    free(output->temporary);
    *output = (Output){0};
    errno = reason;
}

/* Whether the name is that of something that must not be replaced. */
static bool is_special(const char *name)
{
    struct stat info;
    return lstat(name, &info) == 0 && !S_ISREG(info.st_mode);
}

/* Opens NAME.part, or NAME itself. */
Status output_open(const char *name, Output *output)
{
    bool standard = output_is_standard(name);
    *output = (Output){0};
    output->name = join_texts(standard ? "standard output" : name, "");
    if (output->name && !standard && !is_special(name))
        output->temporary = join_texts(name, ".part");
    if (!output->name ||
        (!output->temporary && !standard && !is_special(name))) {
        output_forget(output);
        return STATUS_OUT_OF_MEMORY;
    }
    if (standard)
        output->file = stdout;
    else
        output->file =
            fopen(output->temporary ? output->temporary : name, "wb");
    if (output->file)
        return STATUS_OK;
    output_forget(output);
    return STATUS_FILE_FAILED;
}

/* The stream remembers that a write failed. */
Status output_check(const Output *output)
{
    if (output->file && ferror(output->file))
        return STATUS_FILE_FAILED;
    return STATUS_OK;
}

/* Empties NAME.part; elsewhere the new text follows the old. */
Status output_restart(Output *output)
{
    if (!output->file || !output->temporary)
        return STATUS_OK;
    if (fflush(output->file) || ftruncate(fileno(output->file), 0) ||
        fseek(output->file, 0, SEEK_SET))
        return STATUS_FILE_FAILED;
    return STATUS_OK;
}

/* Every call that can tell of a failed write is asked. */
Status output_close(Output *output, bool keep)
{
    if (!output->file)
        return STATUS_OK;
    bool failed = ferror(output->file) != 0;
    int reason = failed && errno ? errno : EIO;
    if (fflush(output->file) && !failed) {
        failed = true;
        reason = errno;
    }
    if (output->file != stdout && fclose(output->file) && !failed) {
        failed = true;
        reason = errno;
    }
    if (!failed && output->temporary &&
        rename(output->temporary, output->name)) {
        failed = true;
        reason = errno;
    }
    if (failed && output->temporary && !keep)
        remove(output->temporary);
    output_forget(output);
    errno = reason;
    return failed ? STATUS_FILE_FAILED : STATUS_OK;
}

/* Nothing under the name changes. */
void output_discard(Output *output)
{
    int reason = errno;
    if (!output->file)
        return;
    if (output->file != stdout)
        fclose(output->file);
    if (output->temporary)
        remove(output->temporary);
    errno = reason;
    output_forget(output);
}
