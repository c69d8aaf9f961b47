/* A start out of a file: a step of a table of states. */
#include "scenes/body.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* What is looked for, and what was found. */
typedef struct Start {
    FILE *file;
    double step; /* below 0: the last */
    int nodes, run;
    double *x, *v; /* [2 nodes] */
    bool has_step; /* the file has it */
    bool has_panes;
    int count; /* nodes of it */
    long line; /* of the file, the last one that was read; 0: an array */
} Start;

/* Node i of all has this x, y, vx or vy (number 0 ... 3).  Returns whether it
 * is a number. */
static bool put_number(const Start *start, int i, int number, double value)
{
    int own = i - start->run * start->nodes;
    double *to = number < 2 ? start->x : start->v;
    if (own >= 0 && own < start->nodes)
        to[2 * own + number % 2] = value;
    return isfinite(value);
}

/* ---- CSV ---------------------------------------------------------------- */

/* step,time,node,x,y,vx,vy and perhaps more.  Returns false at another line. */
static bool read_lines(Start *start)
{
    static const char names[] = "step,time,node,x,y,vx,vy";
    char line[256];
    double row[4] = {0};
    long step = -1, last = -1;
    int node = 0;
    start->line = 1;
    if (!fgets(line, sizeof line, start->file) ||
        strncmp(line, names, strlen(names)) != 0)
        return false;
    start->has_panes = strstr(line, ",pane") != NULL;
    while (fgets(line, sizeof line, start->file)) {
        int end = 0;
        start->line++;
        if (sscanf(line, "%ld,%*f,%d,%lf,%lf,%lf,%lf%n", &step, &node, &row[0],
                   &row[1], &row[2], &row[3], &end) < 6 ||
            end == 0 || (line[end] != '\n' && line[end] != ','))
            return false;
        if (start->step >= 0 && (double)step > start->step)
            break;
        start->count = step == last ? start->count + 1 : 1;
        last = step;
        if (node != start->count - 1)
            return false;
        for (int k = 0; k < 4; k++)
            if (!put_number(start, node, k, row[k]))
                return false;
    }
    start->has_step = start->step < 0 || (double)last == start->step;
    return true;
}

/* ---- arrays ------------------------------------------------------------- */

/* A number of so many bytes, lowest byte first. */
static uint64_t number_at(const unsigned char *bytes, int count)
{
    uint64_t number = 0;
    while (count-- > 0)
        number = number << 8 | bytes[count];
    return number;
}

enum { MOST = 1000000000 }; /* rows or columns */

/* Goes to the first number of an array NAME.npy of a zip file, stored.
 *   kind   in, numpy's word for its numbers
 *   shape  [2] out, rows and columns; one row where it has no rows
 * Returns false where there is none. */
static bool find_array(FILE *file, const char *name, const char *kind,
                       long shape[2])
{
    unsigned char head[30], rest[512];
    char text[256] = "";
    for (long at = 0; !fseek(file, at, SEEK_SET);) {
        if (fread(head, 1, sizeof head, file) < sizeof head ||
            memcmp(head, "PK\3\4", 4) != 0)
            return false;
        size_t letters = number_at(head + 26, 2),
               more = number_at(head + 28, 2);
        uint64_t size = number_at(head + 18, 4);
        if (letters + more > sizeof rest - 8 ||
            fread(rest, 1, letters + more, file) < letters + more)
            return false;
        if (size == UINT32_MAX) /* it stands behind the name */
            size = number_at(rest + letters + 4, 8);
        if (size > LONG_MAX / 2)
            return false;
        at += (long)(sizeof head + letters + more + size);
        if (letters != strlen(name) + 4 || memcmp(rest, name, letters - 4) != 0)
            continue;
        size_t length =
            fread(head, 1, 10, file) == 10 ? number_at(head + 8, 2) : 0;
        if (length >= sizeof text || fread(text, 1, length, file) < length)
            return false;
        const char *sizes = strchr(text, '(');
        char behind = ')';
        int found =
            sizes ? sscanf(sizes, "(%ld, %ld%c", &shape[0], &shape[1], &behind)
                  : 0;
        if (found == 1) {
            shape[1] = shape[0];
            shape[0] = 1;
        }
        return found > 0 && behind == ')' && strstr(text, kind) &&
               strstr(text, ": False") && shape[0] > 0 && shape[0] < MOST &&
               shape[1] > 0 && shape[1] < MOST;
    }
    return false;
}

static bool read_arrays(Start *start)
{
    static const char *const names[] = {"x", "y", "vx", "vy"};
    unsigned char bytes[8];
    long shape[2], row = 0;
    bool found = start->step < 0;
    if (!found && find_array(start->file, "step", "<i8", shape))
        for (; row < shape[1] && !found; row += !found)
            found = fread(bytes, 1, 8, start->file) == 8 &&
                    (double)number_at(bytes, 8) == start->step;
    start->has_panes = find_array(start->file, "pane", "<i", shape);
    start->has_step = found;
    for (int k = 0; k < 4 && found; k++) {
        double value;
        long before[2] = {shape[0], shape[1]};
        if (!find_array(start->file, names[k], "<f8", shape) ||
            (k > 0 && memcmp(shape, before, sizeof shape) != 0))
            return false;
        row = start->step < 0 ? shape[0] - 1 : row;
        if (row >= shape[0])
            return false;
        start->count = (int)shape[1];
        if (fseek(start->file, row * shape[1] * 8, SEEK_CUR))
            return false;
        for (int i = 0; i < start->count; i++)
            if (fread(&value, sizeof value, 1, start->file) < 1 ||
                !put_number(start, i, k, value))
                return false;
    }
    return true;
}

/* ------------------------------------------------------------------------- */

Status start_table_read(const char *name, double step, int nodes, int run,
                        int runs, double *x, double *v, Refusal told)
{
    Start start = {fopen(name, "rb"), step, nodes, run, x, v, .line = 0};
    char why[128] = "";
    const char *end = strrchr(name, '.');
    bool arrays = end && strcasecmp(end, ".npz") == 0;
    bool whole = start.file && (arrays ? read_arrays : read_lines)(&start);
    if (!start.file || ferror(start.file))
        snprintf(why, sizeof why, "%s", strerror(errno));
    else if (!whole && arrays)
        strcpy(why, "x, y, vx, vy must be arrays of one shape, of finite "
                    "little-endian doubles, not compressed (numpy.savez)");
    else if (!whole)
        snprintf(why, sizeof why,
                 "line %ld is not one that --states writes, "
                 "step,time,node,x,y,vx,vy",
                 start.line);
    else if (!start.has_step)
        snprintf(why, sizeof why, "step %.0f is not in it", step);
    else if (start.count == 0 || start.count % nodes != 0 ||
             (!start.has_panes && start.count / nodes > runs))
        snprintf(why, sizeof why, "its %sstep has %d nodes, the body %d",
                 step < 0 ? "last " : "", start.count, nodes);
    else if (run >= start.count / nodes)
        snprintf(why, sizeof why, "body %d of the scene is not in it", run + 1);
    if (start.file)
        fclose(start.file);
    return why[0] ? refuse(told, "--state '%.60s': %s", name, why) : STATUS_OK;
}
