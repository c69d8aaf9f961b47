#include "picture/history.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

void history_clear(History *history)
{
    history->series = 0;
    history->count = 0;
    history->stride = 1;
    history->calls = 0;
    history->trail = 0;
    history->low = history->high = 0;
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

/* Point `to` = point `from`. */
static void history_move(History *history, int from, int to)
{
    history->time[to] = history->time[from];
    for (int s = 0; s < history->series; s++)
        history->value[s][to] = history->value[s][from];
}

/* Keeps points 0, 2, 4, ... */
static void history_thin(History *history)
{
    for (int i = 1; 2 * i < history->count; i++)
        history_move(history, 2 * i, i);
    history->count = (history->count + 1) / 2;
    history->stride *= 2;
}

/* Whether every number is finite. */
static bool history_accepts(const History *history, double time,
                            const double *value)
{
    bool finite = isfinite(time);
    for (int s = 0; s < history->series; s++)
        finite = finite && isfinite(value[s]);
    return finite;
}

/* The newest point always stays until the next comes, due or not. */
void history_add(History *history, double time, const double *value)
{
    if (!history_accepts(history, time, value))
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
    for (int s = 0; s < history->series; s++) {
        history->value[s][last] = value[s];
        history->low = fmin(history->low, value[s]);
        history->high = fmax(history->high, value[s]);
    }
}

/* Everything moves by one place where it is full. */
void history_follow(History *history, double time, int runs,
                    const double *place)
{
    if (history->trail == HISTORY_TRAIL) {
        history->trail--;
        memmove(history->when, history->when + 1,
                (HISTORY_TRAIL - 1) * sizeof *history->when);
        for (int r = 0; r < runs; r++)
            memmove(history->place[r][0], history->place[r][1],
                    (HISTORY_TRAIL - 1) * sizeof history->place[r][0]);
    }
    for (int r = 0; r < runs; r++)
        memcpy(history->place[r][history->trail], place + 2 * r,
               2 * sizeof *place);
    history->when[history->trail++] = time;
}

/* The range is that of the points which are left. */
void history_cut(History *history, double time)
{
    int count = history->count;
    while (history->trail > 0 && history->when[history->trail - 1] > time)
        history->trail--;
    while (count > 0 && history->time[count - 1] > time)
        count--;
    if (count == history->count)
        return;
    history->count = count;
    history->calls = count > 0 ? (count - 1) * history->stride + 1 : 0;
    history->low = history->high = 0;
    for (int s = 0; s < history->series; s++)
        for (int i = 0; i < count; i++) {
            history->low = fmin(history->low, history->value[s][i]);
            history->high = fmax(history->high, history->value[s][i]);
        }
}
