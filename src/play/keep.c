/* keep.c - what is kept of a session: pictures, films, and the way to a state.
 * Nothing is overwritten.
 */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "play/playing.h"
#include "scenes/scene.h"

/* elasto_SCENE_000012.png, or the first of ..._2.png, ... that is free. */
static void free_name(const Player *player, const char *end, char *name,
                      size_t size)
{
    const char *scene = player_simulation(player)->scene->name;
    snprintf(name, size, "elasto_%s_%06ld%s", scene, player->past.step, end);
    for (int i = 2; access(name, F_OK) == 0 && i < 100000; i++)
        snprintf(name, size, "elasto_%s_%06ld_%d%s", scene, player->past.step,
                 i, end);
}

static const char *reason_of(Status status)
{
    return status == STATUS_FILE_FAILED ? strerror(errno) : status_text(status);
}

/* The frame as it is, in the present folder. */
static Status save_picture(Player *player, const Command *command)
{
    (void)command;
    enum { WIDTH = 1280, HEIGHT = 800 };
    char name[80];
    Paper *paper = player->view ? view_paper(player->view) : NULL;
    Paper own = {0};
    Status status = STATUS_OK;
    if (!paper) {
        status = paper_create(WIDTH, HEIGHT, &own);
        paper = &own;
    }
    free_name(player, ".png", name, sizeof name);
    if (!status) {
        player_know_step(player);
        player_paint(player, paper);
        status = png_file_write(name, &paper->canvas);
    }
    paper_free(&own);
    if (status)
        player_note(player, "not saved: %s", reason_of(status));
    else
        player_note(player, "saved %s", name);
    return STATUS_OK;
}

/* Begins a film of all that is drawn, or ends it. */
static Status switch_film(Player *player, const Command *command)
{
    (void)command;
    char name[80];
    Recording *recording = &player->recording;
    Status status;
    bool ends = film_runs(&recording->film);
    if (!player->view)
        return player_refuse(player, "nothing is drawn that could be filmed");
    if (ends) {
        status = recording_end_film(recording);
    } else {
        free_name(player, ".mp4", name, sizeof name);
        status = recording_film(recording, name);
        player->sampled = -1; /* the present frame is the first */
    }
    if (status)
        player_note(player, "no film: %s",
                    recording->message[0] ? recording->message
                                          : output_reason(recording->reason));
    else if (ends)
        player_note(player, "film ends: %ld frames, in %s",
                    recording->film_frames, recording->film_name);
    else
        player_note(player, "filming %s", name);
    recording->reason = 0;
    recording->message[0] = '\0';
    return STATUS_OK;
}

/* The hash of the state; where commands have led here they are written down as
 * a script, which leads here again. */
static Status tell_hash(Player *player, const Command *command)
{
    (void)command;
    char name[80];
    unsigned long long hash = player_hash(player);
    const char *scene = player_simulation(player)->scene->name;
    const Script *journal = &player->journal;
    Script script = {0};
    Status status = STATUS_OK;
    for (size_t i = 0; i < journal->count && !status; i++)
        status = script_add(&script, journal->line[i].step,
                            &journal->line[i].command);
    if (!status && !player->paused && script.count > 0)
        status = script_add(&script, player->past.step,
                            &(Command){.kind = COMMAND_PAUSE});
    if (script.count == 0) {
        player_note(player, "state %016llx: %.80s --steps %ld", hash,
                    player->line, player->past.step);
        return STATUS_OK;
    }
    free_name(player, ".script", name, sizeof name);
    if (!status)
        status = script_write(name, &script);
    script_free(&script);
    if (status)
        player_note(player, "state %016llx of %s, step %ld; no script: %s",
                    hash, scene, player->past.step, reason_of(status));
    else
        player_note(player, "state %016llx at step %ld: %.60s --script %s",
                    hash, player->past.step, player->line, name);
    return STATUS_OK;
}

const Deed keep_deeds[] = {
    {COMMAND_SHOT, save_picture},
    {COMMAND_FILM, switch_film},
    {COMMAND_HASH, tell_hash},
    {COMMAND_NONE, NULL},
};
