#include "play/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

bool output_is_standard(const char *name)
{
    return strcmp(name, "-") == 0 || strcmp(name, "/dev/stdout") == 0;
}

const char *output_reason(Status status)
{
    return status != STATUS_FILE_FAILED ? status_text(status)
           : errno == EBUSY             ? "it is being written already"
                                        : strerror(errno ? errno : EIO);
}

Status output_tell(char *told, const char *name, Status status, const char *why)
{
    if (told && !told[0])
        snprintf(told, OUTPUT_TOLD, "%s: %s", name,
                 why ? why : output_reason(status));
    return status;
}

Status output_fail(const Output *output, const char *why)
{
    return output_tell(output->told, output->name, STATUS_FILE_FAILED, why);
}

/* ---- opening ------------------------------------------------------------- */

/* NAME.part as a stream that nobody else writes, with the permissions of the
 * file whose place it will take (info, or NULL: there is none).  NULL: errno
 * tells why not. */
static FILE *open_temporary(const struct stat *info, Output *output)
{
    if (!info)
        memcpy(output->target, output->name, sizeof output->name);
    else if (!realpath(output->name, output->target) ||
             access(output->name, W_OK)) /* somebody protected it */
        return NULL;
    snprintf(output->temporary, OUTPUT_NAME, "%.4096s.part", output->target);
    int file = open(output->temporary,
                    O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0)
        return NULL;
    struct stat ours, there; /* another run may have taken the name away before
                                the lock was ours */
    FILE *stream = NULL;
    bool alone =
        (flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) &&
        fstat(file, &ours) == 0 && lstat(output->temporary, &there) == 0 &&
        ours.st_ino == there.st_ino;
    errno = alone ? errno : EBUSY;
    if (alone && ftruncate(file, 0) == 0 &&
        (!info || fchmod(file, info->st_mode & 0777) == 0))
        stream = fdopen(file, "w+b");
    int reason = errno;
    if (!stream)
        close(file);
    errno = reason;
    return stream;
}

Status output_open(const char *name, char *told, Output *output)
{
    struct stat info;
    bool standard = output_is_standard(name);
    bool exists = !standard && stat(name, &info) == 0;
    *output = (Output){.told = told};
    snprintf(output->name, sizeof output->name, "%s",
             standard ? "standard output" : name);
    if (standard)
        output->file = stdout;
    else if (exists && !S_ISREG(info.st_mode))
        output->file = fopen(name, "wb");
    else if (exists || errno == ENOENT) /* so the name is not too long */
        output->file = open_temporary(exists ? &info : NULL, output);
    return output->file ? STATUS_OK : output_fail(output, NULL);
}

/* ---- its end ------------------------------------------------------------- */

/* Every call that can tell of a failed write is asked.  A second descriptor
 * holds the lock until the file has its name. */
Status output_close(Output *output, Keep keep)
{
    FILE *file = output->file;
    bool beside = output->temporary[0];
    if (!file)
        return STATUS_OK;
    int lock = beside ? dup(fileno(file)) : -1;
    bool whole = !ferror(file);
    whole = fflush(file) == 0 && whole;
    if (file != stdout)
        whole = fclose(file) == 0 && whole;
    if (beside && keep == KEEP_NOTHING)
        remove(output->temporary);
    else if (beside && keep == KEEP_WHOLE && whole)
        whole = rename(output->temporary, output->target) == 0;
    Status status = whole ? STATUS_OK : output_fail(output, NULL);
    if (lock >= 0)
        close(lock);
    output->file = NULL;
    return status;
}

/* ---- rows ---------------------------------------------------------------- */

void table_columns(Table *table, const char *names)
{
    for (const char *at = names; at && *at; at += *at == ',') {
        char name[TABLE_LETTERS];
        int length = (int)strcspn(at, ",:"), c = 0;
        snprintf(name, sizeof name, "%.*s", length, at);
        while (c < table->columns && strcmp(table->column[c].name, name) != 0)
            c++;
        if (c == table->columns && c < TABLE_COLUMNS) {
            memcpy(table->column[c].name, name, sizeof name);
            table->column[c].kind = at[length] == ':' ? at[length + 1] : '\0';
            table->columns++;
        }
        at += strcspn(at, ",");
    }
}

Status table_open(const char *name, char *told, Table *table)
{
    Status status = output_open(name, told, &table->output);
    if (status)
        return status;
    for (int c = 0; c < table->columns; c++)
        fprintf(table->output.file, "%s%c", table->column[c].name,
                c + 1 < table->columns ? ',' : '\n');
    table->head = table->output.temporary[0] ? ftell(table->output.file) : 0;
    return table_check(table);
}

void table_add(Table *table, const double *value)
{
    FILE *file = table->output.file;
    for (int c = 0; c < table->columns && !ferror(file); c++) {
        char kind = table->column[c].kind;
        if (kind == 't')
            fputs(table->text(table->column[c].name, (int)value[c]), file);
        else if (kind == '\0')
            fprintf(file, "%.17g", value[c]);
        else if (value[c] >= 0)
            fprintf(file, "%.0f", value[c]);
        putc(c + 1 < table->columns ? ',' : '\n', file);
    }
}

/* The streams remember that a write failed. */
Status table_check(const Table *table)
{
    FILE *file = table->output.file;
    return file && ferror(file) ? output_fail(&table->output, NULL) : STATUS_OK;
}

Status table_cut(Table *table, long last)
{
    double step;
    FILE *file = table->output.file;
    if (!file || !table->output.temporary[0])
        return table_check(table);
    long end = table->head;
    bool whole = fseek(file, end, SEEK_SET) == 0;
    while (whole && fscanf(file, "%lf%*[^\n]%*c", &step) == 1 &&
           step <= (double)last)
        end = ftell(file);
    whole = whole && fseek(file, end, SEEK_SET) == 0 &&
            fflush(file) == 0 && /* what it has read */
            ftruncate(fileno(file), end) == 0;
    return whole ? table_check(table) : output_fail(&table->output, NULL);
}

Status table_end(Table *table)
{
    if (table->output.file)
        fflush(table->output.file);
    return table_check(table);
}

Status table_close(Table *table, Keep keep)
{
    return output_close(&table->output, keep);
}
