/* glide.c - the way from one line of Algorithm 3 to the next: in a window the
 * square glides, arrows grow and points drop, for a quarter of a second.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "play/playing.h"

static const double GLIDE_TIME = 0.25; /* s */

/* Positions that a lane shows now, [2n] m. */
static const double *shown(const Lane *lane)
{
    Trace trace;
    const double *x = NULL;
    if (lane->taped)
        x = tape_trace(&lane->tape, lane->place, &trace);
    return x ? x : lane->track.simulation.run[0].x;
}

void glide_begin(Player *player)
{
    if (!player->window)
        return;
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        size_t bytes = 2 * (size_t)lane->track.simulation.system.nodes *
                       sizeof *lane->from;
        double *from = realloc(lane->from, 2 * bytes);
        if (!from)
            return; /* the square jumps */
        lane->from = from;
        memcpy(from, shown(lane), bytes);
    }
    player->glide = clock_now();
}

double glide_rest(Player *player)
{
    double part = (clock_now() - player->glide) / GLIDE_TIME;
    if (player->glide == 0)
        return 0;
    if (!(part < 1)) {
        player->glide = 0;
        return 0;
    }
    return 1 - part * part * (3 - 2 * part);
}

const double *glide_between(Lane *lane, double rest)
{
    const double *to = shown(lane);
    int size = 2 * lane->track.simulation.system.nodes;
    double *x = lane->from + size;
    for (int i = 0; i < size; i++)
        x[i] = to[i] + rest * (lane->from[i] - to[i]);
    return x;
}
