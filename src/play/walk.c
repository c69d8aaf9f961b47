/* walk.c - through time: run and pause, on and back by steps, by updates of
 * Newton's method, or by lines of Algorithm 3.
 */
#include "play/playing.h"
#include "scenes/scene.h"

static Status set_paused(Player *player, bool paused)
{
    player->paused = paused;
    player->halted = false;
    player->rests = player->rests && paused;
    if (!paused)
        player_leave_tapes(player);
    player_reset_speed(player);
    return STATUS_OK;
}

static Status play(Player *player, const Command *command)
{
    (void)command;
    return set_paused(player, false);
}

static Status pause_run(Player *player, const Command *command)
{
    (void)command;
    return set_paused(player, true);
}

/* The next step, known or new. */
static Status next_step(Player *player, bool walked)
{
    player->paused = true;
    if (player->step >= player->newest)
        return player_step(player);
    return walked ? player_retape(player, player->step + 1)
                  : player_show(player, player->step + 1);
}

/* All lanes that can be walked through, at their first or at their last
 * place. */
static void enter_tapes(Player *player, bool at_end)
{
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        if (lane_walks(lane))
            lane->place = at_end ? lane->tape.places - 1 : 0;
    }
}

/* A pace on or back in all lanes, as tape_next or tape_back has it; false: each
 * was at its end. */
static bool walk(Player *player, int (*pace)(const Tape *, int, int))
{
    bool moved = false;
    glide_begin(player);
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        int last = lane->tape.places - 1, place = lane->place;
        if (place < 0)
            continue;
        int next = pace(&lane->tape, player->fine, place);
        lane->place = next < 0 ? 0 : next > last ? last : next;
        moved = moved || lane->place != place;
    }
    return moved;
}

/* Where E has risen beyond all proportion within a step that was taken by
 * itself, that is what is shown. */
void player_show_peaks(Player *player)
{
    for (int i = 0; i < player->lanes; i++) {
        Lane *lane = &player->lane[i];
        double rise;
        int peak = lane_peak(lane, &rise);
        if (peak < 0)
            continue;
        lane->place = peak;
        player_note(player,
                    "update %d of %d: E has risen by %.3g J s\u00b2, and nodes "
                    "are %.4g m away; N goes on",
                    lane->tape.place[peak].round + 1, lane->tape.count, rise,
                    lane_extent(lane));
        player->warning = true;
    }
}

/* One on: a step, an update or a line. */
static Status go_on(Player *player, const Command *command)
{
    (void)command;
    bool peaked = player->fine == 0 && player_lane(player)->place >= 0;
    player->paused = true;
    if (player->fine > 0 && walk(player, tape_next))
        return STATUS_OK;
    if (peaked) { /* from the height of an explosion to its end */
        player_leave_tapes(player);
        return STATUS_OK;
    }
    Status status = next_step(player, player->fine > 0);
    if (!status && player->fine > 0)
        enter_tapes(player, false);
    else if (!status)
        player_show_peaks(player);
    return status;
}

/* One back, the same; from the first line of a step to the end of the one
 * before. */
static Status go_back(Player *player, const Command *command)
{
    (void)command;
    Lane *lane = player_lane(player);
    player->paused = true;
    if (player->fine == 0)
        return player_show(player, player->step - 1);
    if (lane->place < 0 && player->step > 0) {
        Status status =
            lane->taped ? STATUS_OK : player_retape(player, player->step);
        if (status || !lane_walks(lane))
            return status ? status : player_show(player, player->step - 1);
        enter_tapes(player, true);
    }
    if (lane->place < 0 || walk(player, tape_back))
        return STATUS_OK;
    Status status = player_retape(player, player->step - 1);
    if (!status)
        enter_tapes(player, true);
    return status;
}

/* Whether the steps of any lane are made of updates that are shown. */
static bool can_be_finer(const Player *player)
{
    for (int i = 0; i < player->lanes; i++) {
        const Simulation *simulation = &player->lane[i].track.simulation;
        if ((simulation->scene->needs & NEEDS_TIME) &&
            simulation->run[0].newton)
            return true;
    }
    return player->fine > 0; /* back from there */
}

/* Steps, updates, lines, and steps again. */
static Status go_finer(Player *player, const Command *command)
{
    (void)command;
    static const char *const text[] = {
        "N and \u2190 go by whole steps",
        "N and \u2190 go by updates of Newton's method",
        "N and \u2190 go by lines of Algorithm 3",
    };
    if (!can_be_finer(player))
        return player_refuse(player, player_simulation(player)->scene->turn
                                         ? "a step here has no finer ones"
                                         : "no step here has updates of "
                                           "Newton's method");
    player->fine = (player->fine + 1) % 3;
    if (player->fine == 0)
        player_leave_tapes(player);
    player->paused = true;
    player_note(player, "%s", text[player->fine]);
    return STATUS_OK;
}

/* Step 0, the newest one, or the one with this number. */
static Status go_to(Player *player, const Command *command)
{
    long step = command->kind == COMMAND_HOME  ? 0
                : command->kind == COMMAND_END ? player->newest
                                               : command->number;
    return player_show(player, step);
}

static Status make_step(Player *player, const Command *command)
{
    (void)command;
    player->paused = true;
    return player_step(player);
}

const Deed walk_deeds[] = {
    {COMMAND_PLAY, play},      {COMMAND_PAUSE, pause_run},
    {COMMAND_NEXT, go_on},     {COMMAND_BACK, go_back},
    {COMMAND_STEP, make_step}, {COMMAND_FINER, go_finer},
    {COMMAND_HOME, go_to},     {COMMAND_END, go_to},
    {COMMAND_GOTO, go_to},     {COMMAND_NONE, NULL},
};
