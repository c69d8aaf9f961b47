#include "play/table.h"

#include <string.h>
#include <strings.h>
#include <unistd.h>

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

Status table_open(const char *name, Table *table)
{
    const char *end = strrchr(name, '.');
    table->format = !end                           ? NULL
                    : strcasecmp(end, ".npz") == 0 ? npz_write
                    : strcasecmp(end, ".pvd") == 0 ? pvd_write
                                                   : NULL;
    Status status = output_open(name, &table->output);
    if (status)
        return status;
    table->rows = table->format ? tmpfile() : NULL;
    if (table->format && !table->rows) {
        output_discard(&table->output);
        return STATUS_FILE_FAILED;
    }
    for (int c = 0; c < table->columns && !table->rows; c++)
        fprintf(table->output.file, "%s%c", table->column[c].name,
                c + 1 < table->columns ? ',' : '\n');
    table->head = table->output.temporary ? ftell(table->output.file) : 0;
    return table_check(table);
}

void table_add(Table *table, const double *value)
{
    FILE *file = table->output.file;
    if (table->rows) {
        fwrite(value, sizeof *value, (size_t)table->columns, table->rows);
        return;
    }
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
    bool failed =
        (file && ferror(file)) || (table->rows && ferror(table->rows));
    return failed ? STATUS_FILE_FAILED : STATUS_OK;
}

bool table_next(const Table *table, double *row)
{
    size_t columns = (size_t)table->columns;
    return fread(row, sizeof *row, columns, table->rows) == columns;
}

/* Where the rows of steps up to the last one end, in either kind of rows. */
static long find_end(const Table *table, FILE *file, long last)
{
    double row[TABLE_COLUMNS];
    long end = table->rows ? 0 : table->head;
    if (fseek(file, end, SEEK_SET))
        return 0;
    while ((table->rows ? table_next(table, row)
                        : fscanf(file, "%lf%*[^\n]%*c", row) == 1) &&
           row[0] <= (double)last)
        end = ftell(file);
    return end;
}

Status table_cut(Table *table, long last)
{
    FILE *file = table->rows ? table->rows : table->output.file;
    if (!file)
        return STATUS_OK;
    if (table->rows || table->output.temporary) {
        long end = find_end(table, file, last);
        if (fseek(file, end, SEEK_SET) || fflush(file) || /* what it has read */
            ftruncate(fileno(file), end))
            return STATUS_FILE_FAILED;
    }
    return table_check(table);
}

Status table_close(Table *table, Keep keep)
{
    Status status = table_check(table);
    if (table->rows && !status && fflush(table->rows) == 0)
        table->format(table, table->output.file);
    status = table_check(table);
    if (table->rows)
        fclose(table->rows);
    table->rows = NULL;
    if (keep == KEEP_NOTHING)
        output_discard(&table->output);
    if (keep && !status)
        status = STATUS_INTERRUPTED;
    status = output_close(&table->output, status);
    return status == STATUS_INTERRUPTED ? STATUS_OK : status;
}
