/* output.c - writes tables, and files that get their name when whole. */
#include "play/output.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "simulation/message.h"

bool output_is_stdout(const char *name)
{
    return strcmp(name, "-") == 0 || strcmp(name, "/dev/stdout") == 0;
}

const char *output_reason(Status status)
{
    return status != STATUS_FILE_FAILED ? status_text(status)
                                        : strerror(errno ? errno : EIO);
}

void print_line(FILE *file, const char *format, ...)
{
    char line[1024];
    write_formatted(line, sizeof line, format);
    replace_control_characters(line);
    fprintf(file, "%s\n", line);
}

Status output_fill_message(char *message, const char *name, Status status,
                           const char *why)
{
    if (message && !message[0])
        snprintf(message, MESSAGE_BYTES, "%s: %s", name,
                 why ? why : output_reason(status));
    return status;
}

Status output_report_failure(const OutputFile *output, const char *why)
{
    return output_fill_message(output->message, output->name,
                               STATUS_FILE_FAILED, why);
}

Status output_open(const char *name, char *message, OutputFile *output)
{
    struct stat info;
    bool standard = output_is_stdout(name);
    bool exists = !standard && stat(name, &info) == 0;
    *output = (OutputFile){.message = message};
    snprintf(output->name, sizeof output->name, "%s",
             standard ? "standard output" : name);
    if (standard)
        output->file = stdout;
    else if (exists && !S_ISREG(info.st_mode))
        output->file = fopen(name, "wbe");
    else if (!exists || access(name, W_OK) == 0) { /* new, or writable */
        snprintf(output->part_file_name, PATH_BYTES, "%.4096s.part", name);
        output->file = fopen(output->part_file_name, "wbe");
    }
    return output->file ? STATUS_OK : output_report_failure(output, NULL);
}

/* Checks every call that can report a failed write. */
Status output_close(OutputFile *output, CloseAction keep)
{
    FILE *file = output->file;
    bool beside = output->part_file_name[0];
    if (!file)
        return STATUS_OK;
    bool whole = !ferror(file);
    whole = fflush(file) == 0 && whole;
    if (file != stdout)
        whole = fclose(file) == 0 && whole;
    if (beside && keep == KEEP_NOTHING)
        remove(output->part_file_name);
    else if (beside && keep == KEEP_FILE && whole)
        whole = rename(output->part_file_name, output->name) == 0;
    output->file = NULL;
    return whole ? STATUS_OK : output_report_failure(output, NULL);
}

void table_add_columns(CsvTable *table, const char *names)
{
    for (const char *at = names; at && *at; at += *at == ',') {
        char name[TABLE_NAME_SIZE];
        int length = (int)strcspn(at, ",:"), c = 0;
        snprintf(name, sizeof name, "%.*s", length, at);
        while (c < table->column_count &&
               strcmp(table->column[c].name, name) != 0)
            c++;
        if (c == table->column_count && c < TABLE_MAX_COLUMNS) {
            memcpy(table->column[c].name, name, sizeof name);
            table->column[c].kind = at[length] == ':' ? at[length + 1] : '\0';
            table->column_count++;
        }
        at += strcspn(at, ",");
    }
}

Status table_open(const char *name, char *message, CsvTable *table)
{
    Status status = output_open(name, message, &table->output);
    if (status)
        return status;
    for (int c = 0; c < table->column_count; c++)
        fprintf(table->output.file, "%s%c", table->column[c].name,
                c + 1 < table->column_count ? ',' : '\n');
    return table_status(table);
}

void table_add_row(CsvTable *table, const double *value)
{
    FILE *file = table->output.file;
    for (int c = 0; c < table->column_count && !ferror(file); c++) {
        char kind = table->column[c].kind;
        if (kind == 't')
            fputs(table->get_text(table->column[c].name, (int)value[c]), file);
        else if (kind == '\0')
            fprintf(file, "%.17g", value[c]);
        else if (value[c] >= 0)
            fprintf(file, "%.0f", value[c]);
        putc(c + 1 < table->column_count ? ',' : '\n', file);
    }
}

/* A stream remembers that a write failed. */
Status table_status(const CsvTable *table)
{
    FILE *file = table->output.file;
    return file && ferror(file) ? output_report_failure(&table->output, NULL)
                                : STATUS_OK;
}
