#include "picture/history.h"

#include <math.h>
#include <string.h>

/* The series of this name, most often number i; one more where it is new;
 * HISTORY_SERIES where there is no room. */
static int find_series(History *history, int i, const char *name)
{
    int s = i < history->series && history->name[i] == name ? i : 0;
    while (s < history->series && strcmp(history->name[s], name) != 0)
        s++;
    if (s == history->series && s < HISTORY_SERIES) {
        history->name[history->series++] = name;
        memset(history->value[s], 0, sizeof history->value[s]);
    }
    return s;
}

void history_add(History *history, double time, int rows, const Energy *row)
{
    double sum = time;
    for (int i = 0; i < rows; i++)
        sum += 0 * row[i].value; /* NaN where it is not finite */
    if (!isfinite(sum) || history->count == HISTORY_POINTS)
        return;
    int last = history->count++;
    history->time[last] = time;
    for (int s = 0; s < history->series; s++)
        history->value[s][last] = 0;
    for (int i = 0; i < rows; i++) {
        int s = find_series(history, i, row[i].name);
        if (s < HISTORY_SERIES)
            history->value[s][last] = row[i].value;
    }
}
