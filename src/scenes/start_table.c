#include "scenes/start_table.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scenes/one_line.h"

/* step,time,node,x,y,vx,vy as one line of the table. */
static bool read_row(const char *line, long *step, int *node, double row[4])
{
    int end = 0;
    int read = sscanf(line, "%ld,%*f,%d,%lf,%lf,%lf,%lf%n", step, node, &row[0],
                      &row[1], &row[2], &row[3], &end);
    double size = fabs(row[0]) + fabs(row[1]) + fabs(row[2]) + fabs(row[3]);
    return read == 6 && end > 0 && line[end] == '\n' && isfinite(size);
}

Status start_table_read(const char *name, int nodes, int run, double *x,
                        double *v, char *message, size_t size)
{
    char line[256], shown[64];
    double row[4] = {0};
    long number = 1, step = -1, last = -1;
    int node = 0, count = 0;
    one_line(name, shown, sizeof shown);
    FILE *file = fopen(name, "r");
    bool whole = file && fgets(line, sizeof line, file) &&
                 strcmp(line, "step,time,node,x,y,vx,vy\n") == 0;
    while (whole && fgets(line, sizeof line, file)) {
        number++;
        whole = read_row(line, &step, &node, row);
        count = step == last ? count + 1 : 1;
        last = step;
        whole = whole && node == count - 1;
        int own = node - run * nodes;
        for (int axis = 0; whole && own >= 0 && own < nodes && axis < 2;
             axis++) {
            x[2 * own + axis] = row[axis];
            v[2 * own + axis] = row[2 + axis];
        }
    }
    Status status = STATUS_INVALID_INPUT;
    if (!file || ferror(file))
        snprintf(message, size, "--state '%s': %s", shown, strerror(errno));
    else if (!whole)
        snprintf(message, size,
                 "--state '%s': line %ld is not one that --states writes, "
                 "step,time,node,x,y,vx,vy",
                 shown, number);
    else if (count == 0 || count % nodes != 0)
        snprintf(message, size,
                 "--state '%s': its last step has %d nodes, the body %d", shown,
                 count, nodes);
    else if (run >= count / nodes)
        snprintf(message, size,
                 "--state '%s': body %d of the scene is not in it", shown,
                 run + 1);
    else
        status = STATUS_OK;
    if (file)
        fclose(file);
    return status;
}
