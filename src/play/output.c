#include "play/output.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

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

/* ---- arrays for numpy ---------------------------------------------------- */

/* A zip file (PKWARE: APPNOTE 6.3) of arrays (numpy: NEP 1), stored as they
 * are.  All sizes have 64 bits, those of the format's first version say so with
 * all bits set; the date is zip's first, so that equal tables are equal files.
 */
enum { TEXT_LETTERS = 24 }; /* at most */

/* Where bytes go: all are counted, and the file may be NULL. */
typedef struct Sink {
    FILE *file;
    uLong crc;
    uint64_t size;
} Sink;

static void put_bytes(Sink *sink, const void *bytes, size_t size)
{
    sink->crc = crc32(sink->crc, bytes, (uInt)size);
    sink->size += size;
    if (sink->file)
        fwrite(bytes, 1, size, sink->file);
}

/* How many rows each step has. */
typedef struct Shape {
    size_t steps, places; /* places = 0: not as many in all; steps are rows */
} Shape;

static Shape shape_of(const Table *table)
{
    double row[TABLE_COLUMNS], step = -1;
    size_t rows = 0, steps = 0, places = 0;
    bool even = false;
    for (int c = 0; c < table->columns; c++)
        even = even || table->column[c].kind == 'p';
    rewind(table->rows);
    for (; table_next(table, row); rows++) {
        even = even && (row[0] == step || rows == steps * places);
        steps += row[0] != step;
        places += steps == 1;
        step = row[0];
    }
    even = even && rows > 0 && rows == steps * places;
    return even ? (Shape){steps, places} : (Shape){rows, 0};
}

/* A value as numpy has it on machines that begin with the lowest byte; texts
 * have four bytes a letter. */
static void put_value(Sink *sink, const Table *table, int c, double value)
{
    const char *name = table->column[c].name;
    char kind = table->column[c].kind, letters[4 * TEXT_LETTERS] = "";
    int64_t whole = (int64_t)value;
    if (kind == '\0')
        put_bytes(sink, &value, sizeof value);
    else if (kind != 't')
        put_bytes(sink, &whole, sizeof whole);
    else {
        const char *text = table->text(name, (int)whole);
        for (int i = 0; i < TEXT_LETTERS && text[i]; i++)
            letters[4 * i] = text[i];
        put_bytes(sink, letters, sizeof letters);
    }
}

/* The array of column c, after a head of two times 64 bytes. */
static void put_array(Sink *sink, const Table *table, int c, Shape shape)
{
    double row[TABLE_COLUMNS];
    char head[128], size[48], kind = table->column[c].kind;
    bool once = shape.places > 0 && c < 2; /* in a step */
    bool first = shape.places > 0 && kind == 'p';
    snprintf(size, sizeof size, "%zu,", first ? shape.places : shape.steps);
    if (shape.places > 0 && !once && !first)
        snprintf(size, sizeof size, "%zu, %zu", shape.steps, shape.places);
    snprintf(head, sizeof head,
             "\x93NUMPY\x01%c%c%c{'descr': '%s', 'fortran_order': False, "
             "'shape': (%s), }",
             0, (int)sizeof head - 10, 0,
             kind == '\0'  ? "<f8"
             : kind == 't' ? "<U24"
                           : "<i8",
             size);
    size_t used = 10 + strlen(head + 10);
    memset(head + used, ' ', sizeof head - used);
    head[sizeof head - 1] = '\n';
    put_bytes(sink, head, sizeof head);
    rewind(table->rows);
    for (size_t i = 0; table_next(table, row); i++)
        if (once ? i % shape.places == 0 : !first || i < shape.places)
            put_value(sink, table, c, row[c]);
}

/* Words of a zip file, lowest byte first; numbers that take two or four. */
#define TWO(number)  (uint16_t)(number), (uint16_t)((number) >> 16)
#define FOUR(number) TWO(number), TWO((uint64_t)(number) >> 32)
#define PUT(sink, ...)                                                         \
    put_bytes(sink, (const uint16_t[]){__VA_ARGS__},                           \
              sizeof((const uint16_t[]){__VA_ARGS__}))

enum { VERSION = 45, FIRST_DAY = 0x21, SIZES = 16 };
static const uint32_t ALL = UINT32_MAX;

/* What is said of a file before it, and in the list at the end. */
static void put_entry(Sink *sink, const char *name, const Sink *array,
                      bool listed, uint64_t at)
{
    char file[32];
    size_t letters = (size_t)snprintf(file, sizeof file, "%s.npy", name);
    if (listed)
        PUT(sink, TWO(0x02014b50), VERSION);
    else
        PUT(sink, TWO(0x04034b50));
    PUT(sink, VERSION, 0, 0, 0, FIRST_DAY, TWO(array->crc), TWO(ALL), TWO(ALL),
        (uint16_t)letters);
    if (listed)
        PUT(sink, SIZES + 12, FOUR(0), 0, TWO(ALL));
    else
        PUT(sink, SIZES + 4);
    put_bytes(sink, file, letters);
    PUT(sink, 1, listed ? SIZES + 8 : SIZES, FOUR(array->size),
        FOUR(array->size));
    if (listed)
        PUT(sink, FOUR(at));
}

/* Each array twice: its sum of 32 bits stands before it. */
static void npz_write(const Table *table, FILE *file)
{
    const Shape shape = shape_of(table);
    Sink zip = {file, 0, 0}, array[TABLE_COLUMNS] = {{0}};
    uint64_t at[TABLE_COLUMNS], count = (uint64_t)table->columns;
    for (int c = 0; c < table->columns; c++) {
        put_array(&array[c], table, c, shape);
        at[c] = zip.size;
        put_entry(&zip, table->column[c].name, &array[c], false, 0);
        put_array(&zip, table, c, shape);
    }
    uint64_t list = zip.size;
    for (int c = 0; c < table->columns; c++)
        put_entry(&zip, table->column[c].name, &array[c], true, at[c]);
    uint64_t end = zip.size;
    PUT(&zip, TWO(0x06064b50), FOUR(44), VERSION, VERSION, FOUR(0), FOUR(count),
        FOUR(count), FOUR(end - list), FOUR(list));
    PUT(&zip, TWO(0x07064b50), TWO(0), FOUR(end), TWO(1));
    PUT(&zip, TWO(0x06054b50), TWO(0), TWO(ALL), TWO(ALL), TWO(ALL), 0);
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
    const char *end = strrchr(name, '.');
    table->format = !end                           ? NULL
                    : strcasecmp(end, ".npz") == 0 ? npz_write
                    : strcasecmp(end, ".pvd") == 0 ? pvd_write
                                                   : NULL;
    Status status = output_open(name, told, &table->output);
    if (status)
        return status;
    table->rows = table->format ? tmpfile() : NULL;
    if (table->format && !table->rows) {
        status = output_fail(&table->output, NULL);
        output_close(&table->output, KEEP_NOTHING);
        return status;
    }
    for (int c = 0; c < table->columns && !table->rows; c++)
        fprintf(table->output.file, "%s%c", table->column[c].name,
                c + 1 < table->columns ? ',' : '\n');
    table->head = table->output.temporary[0] ? ftell(table->output.file) : 0;
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
    return failed ? output_fail(&table->output, NULL) : STATUS_OK;
}

bool table_next(const Table *table, double *row)
{
    size_t columns = (size_t)table->columns;
    return fread(row, sizeof *row, columns, table->rows) == columns;
}

Status table_cut(Table *table, long last)
{
    double row[TABLE_COLUMNS];
    FILE *file = table->rows ? table->rows : table->output.file;
    if (!file || (!table->rows && !table->output.temporary[0]))
        return table_check(table);
    long end = table->head;
    bool whole = fseek(file, end, SEEK_SET) == 0;
    while (whole &&
           (table->rows ? table_next(table, row)
                        : fscanf(file, "%lf%*[^\n]%*c", row) == 1) &&
           row[0] <= (double)last)
        end = ftell(file);
    whole = whole && fseek(file, end, SEEK_SET) == 0 &&
            fflush(file) == 0 && /* what it has read */
            ftruncate(fileno(file), end) == 0;
    return whole ? table_check(table) : output_fail(&table->output, NULL);
}

Status table_end(Table *table)
{
    if (table->rows && !ferror(table->rows) && fflush(table->rows) == 0)
        table->format(table, table->output.file);
    if (table->output.file)
        fflush(table->output.file);
    return table_check(table);
}

Status table_close(Table *table, Keep keep)
{
    if (table->rows)
        fclose(table->rows);
    table->rows = NULL;
    return output_close(&table->output, keep);
}
