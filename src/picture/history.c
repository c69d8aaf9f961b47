#include "picture/history.h"

#include <math.h>
#include <string.h>

void history_clear(History *history)
{
    history->series = 0;
    history->count = 0;
    history->stride = 1;
    history->calls = 0;
}

int history_series(History *history, const char *name)
{
    int s = 0;
    while (s < history->series && strcmp(history->name[s], name) != 0)
        s++;
    if (s == HISTORY_SERIES)
        return s - 1;
    if (s == history->series) {
        history->name[history->series++] = name;
        memset(history->value[s], 0, sizeof history->value[s]);
    }
    return s;
}

/* Keeps points 0, 2, 4, ... */
static void history_thin(History *history)
{
    for (int i = 1; 2 * i < history->count; i++) {
        history->time[i] = history->time[2 * i];
        for (int s = 0; s < history->series; s++)
            history->value[s][i] = history->value[s][2 * i];
    }
    history->count = (history->count + 1) / 2;
    history->stride *= 2;
}

/* The newest point always stays until the next comes, due or not. */
void history_add(History *history, double time, const double *value)
{
    double sum = time;
    for (int s = 0; s < history->series; s++)
        sum += 0 * value[s]; /* NaN where it is not finite */
    if (!isfinite(sum))
        return;
    if (history->stride < 1)
        history->stride = 1;
    if (history->count > 0 && (history->calls - 1) % history->stride != 0)
        history->count--;
    if (history->count == HISTORY_POINTS)
        history_thin(history);
    int last = history->count++;
    history->calls++;
    history->time[last] = time;
    for (int s = 0; s < history->series; s++)
        history->value[s][last] = value[s];
}

void history_cut(History *history, double time)
{
    int count = history->count;
    while (count > 0 && history->time[count - 1] > time)
        count--;
    if (count == history->count)
        return;
    history->count = count;
    history->calls = count > 0 ? (count - 1) * history->stride + 1 : 0;
}
