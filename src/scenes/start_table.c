/* A start out of a file: a step of a table of states. */
#include "scenes/body.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* What is looked for, and what was found. */
typedef struct Start {
    FILE *file;
    double step; /* below 0: the last */
    int nodes, run;
    double *x, *v; /* [2 nodes] */
    bool has_step; /* the file has it */
    bool has_panes;
    int count; /* nodes of it */
    long line; /* of the file, the last one that was read */
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

/* step,time,node,x,y,vx,vy and perhaps more.  Where somebody went back the table
 * has a step several times: the last one counts.  Returns false at another
 * line. */
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
        bool follows = step == last;
        last = step;
        if (start->step >= 0 && (double)step != start->step)
            continue;
        start->count = node == 0 ? 1 : follows ? start->count + 1 : 0;
        if (node != start->count - 1)
            return false;
        for (int k = 0; k < 4; k++)
            if (!put_number(start, node, k, row[k]))
                return false;
    }
    start->has_step = start->step < 0 || start->count > 0;
    return true;
}

Status start_table_read(const char *name, double step, int nodes, int run,
                        int runs, double *x, double *v, Refusal told)
{
    Start start = {fopen(name, "r"), step, nodes, run, x, v, .line = 0};
    char why[128] = "";
    bool whole = start.file && read_lines(&start);
    if (!start.file || ferror(start.file))
        snprintf(why, sizeof why, "%s", strerror(errno));
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
