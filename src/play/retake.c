/* retake.c - the counterfactual step: with another projection or line search,
 * or another number while its lines are gone through, the present step is made
 * again from its own start, beside what it was.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/playing.h"
#include "scenes/scene.h"

/* What the step that was just made did. */
typedef struct Outcome {
    double change; /* E at its end - E at its start, J s^2 */
    int updates;
    Status status;
    double extent; /* m */
} Outcome;

static Outcome outcome_of(const Lane *lane)
{
    return (Outcome){lane->track.now.change, lane->track.now.updates,
                     lane->outcome, lane_extent(lane)};
}

/* "E +206 in 12 updates" */
static void tell_outcome(const Outcome *outcome, char *text, size_t size)
{
    snprintf(text, size, "E %+.3g in %d update%s%s%s", outcome->change,
             outcome->updates, outcome->updates == 1 ? "" : "s",
             outcome->status ? ", " : "",
             outcome->status ? status_text(outcome->status) : "");
}

/* What a value is called in a sentence. */
static void value_words(const char *option, const char *value, char *text,
                        size_t size)
{
    if (strcmp(value, "none") == 0)
        snprintf(text, size, "%s",
                 strcmp(option, "filter") == 0 ? "no projection" : "full step");
    else
        snprintf(text, size, "%s %s", option_find(option)->label, value);
}

/* Whether it is the projection or the line search that changes. */
static bool is_method(const char *option)
{
    return strcmp(option, "filter") == 0 || strcmp(option, "line-search") == 0;
}

/* What was changed in a lane since the step that is shown, but for the
 * option. */
static Status keep_changes(const Lane *lane, const char *option, Script *kept)
{
    const Script *changes = &lane->track.changes;
    size_t length = strlen(option);
    Status status = STATUS_OK;
    for (size_t i = 0; i < changes->count && !status; i++) {
        const ScriptLine *line = &changes->line[i];
        bool same = line->command.kind == COMMAND_SET &&
                    strncmp(line->command.text, option, length) == 0 &&
                    line->command.text[length] == ' ';
        if (line->step == track_step_shown(&lane->track) && !same)
            status = script_add(kept, line->step, &line->command);
    }
    return status;
}

/* And once more, after the step was made again. */
static Status change_again(Lane *lane, const Script *kept)
{
    char message[256];
    Status status = STATUS_OK;
    for (size_t i = 0; i < kept->count && !status; i++)
        status = track_change(&lane->track, &kept->line[i].command, message,
                              sizeof message);
    return status;
}

/* The change at this step, and the step after it.  A hand that held a node
 * does so again. */
static Status step_again(Player *player, const Command *change, long first,
                         int from, int to)
{
    bool holds = player->holds, paused = player->paused;
    Status status = player_show(player, first);
    if (!status)
        status = player_change_lanes(player, change, from, to);
    player->holds = true;
    if (!status)
        status = player_step(player);
    player->holds = holds;
    player->paused = paused;
    player->sampled = -1;
    return status;
}

/* The place in the tape that is the same line of the same round as before. */
static void find_place(Lane *lane, int round, Line line)
{
    const Tape *tape = &lane->tape;
    if (!lane_walks(lane))
        return;
    lane->place = tape->places - 1;
    for (int i = tape->places - 1; i >= 0; i--)
        if (tape->place[i].round == round && tape->place[i].line <= line) {
            lane->place = i;
            return;
        }
}

/* The change, and the present step once more with it, from its own start; what
 * was there before stays as a ghost, or beside it. */
static Status make_again(Player *player, const Command *change,
                         const char *option, const char *value, const char *old,
                         int from, int to)
{
    Lane *lane = &player->lane[player->active];
    bool failed = lane->failed;
    long first = player->step - (failed ? 0 : 1);
    int round = -1;
    Line line = LINE_NONE;
    char was[64], is[64], had[160], has[160];
    Script kept[OPTIONS_MAX_PANES] = {{0}};
    if (lane->place >= 0 && player->fine > 0) {
        round = lane->tape.place[lane->place].round;
        line = lane->tape.place[lane->place].line;
    }
    if (first < 0)
        return player_change_lanes(player, change, from, to);
    Outcome before = outcome_of(lane);
    if (!failed && lane->track.keeps && track_step_shown(&lane->track) > 0) {
        const StepRow *row =
            track_row(&lane->track, track_step_shown(&lane->track));
        before.change = row->change;
        before.updates = row->updates;
    }
    value_words(option, old, was, sizeof was);
    value_words(option, value, is, sizeof is);
    double *ghost = NULL;
    if (is_method(option) && !failed &&
        state_size(&lane->track.simulation) > 0 && !lane_keep_ghost(lane, was))
        ghost = lane->ghost;
    else
        lane_drop_ghost(lane);
    lane->ghost = NULL; /* out of the reach of other steps */
    Status status = STATUS_OK;
    for (int i = 0; i < player->lanes && !failed && !status; i++)
        status = keep_changes(&player->lane[i], option, &kept[i]);
    if (!status)
        status = step_again(player, change, first, from, to);
    Outcome after = outcome_of(lane);
    for (int i = 0; i < player->lanes; i++) {
        Status changed = change_again(&player->lane[i], &kept[i]);
        status = status ? status : changed;
        if (kept[i].count > 0)
            lane_sample_again(&player->lane[i], player->step);
        script_free(&kept[i]);
    }
    lane_drop_ghost(lane);
    lane->ghost = ghost;
    if (round >= 0)
        find_place(lane, round, line);
    tell_outcome(&before, had, sizeof had);
    tell_outcome(&after, has, sizeof has);
    player_note(player, "%s: %s; %s: %s", was, had, is, has);
    return status;
}

/* Whether two outcomes fit into one picture. */
static bool fits_one_picture(const Outcome *one, const Outcome *other)
{
    enum { TIMES = 5 };
    return one->extent <= TIMES * other->extent &&
           other->extent <= TIMES * one->extent;
}

/* Two outcomes of methods that no one picture can show are put beside each
 * other. */
Status retake_step(Player *player, const Command *change, const char *option,
                   const char *value, const char *old, int from, int to)
{
    enum { SOON = 64 }; /* steps that are made again without a wait */
    Lane *lane = &player->lane[player->active], *beside = &player->lane[1];
    Status status = STATUS_OK;
    bool alone = is_method(option) && player->lanes == 1 && player->attended &&
                 player->step > 0 && player->step < SOON && !lane->failed &&
                 (lane->track.options.scene->needs & NEEDS_MESH) &&
                 state_size(&lane->track.simulation) > 0;
    Outcome before = outcome_of(lane);
    if (alone)
        status = lane_clone(lane, 1, player_watch, beside);
    if (alone && !status)
        status = lane_retape(beside, player->step);
    if (!status)
        status = make_again(player, change, option, value, old, from, to);
    Outcome after = outcome_of(lane);
    if (!alone)
        return status;
    if (status || fits_one_picture(&before, &after)) {
        lane_free(beside);
        return status;
    }
    lane_drop_ghost(lane);
    player->lanes = 2;
    player->start[1] = player->start[0];
    char note[sizeof player->note];
    memcpy(note, player->note, sizeof note);
    player_show_peaks(player);
    memcpy(player->note, note, sizeof note);
    return STATUS_OK;
}
