/* begin.c - from step 0: again, from another start, another scene, a page of
 * the lecture, a cell of the map; and what the mouse does on some of them.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/plot.h"
#include "play/playing.h"
#include "scenes/pages.h"
#include "scenes/scene.h"
#include "scenes/small_scenes.h"

Status player_own_options(Player *player, const char *scene,
                          const LecturePage *page, Options *options, int *count)
{
    const Options *given = &player->given[0];
    *count = 1;
    if (page)
        return lecture_options(page, options, player->message,
                               sizeof player->message);
    Status status = options_of_line(scene, options, player->message,
                                    sizeof player->message);
    if (status)
        return status;
    options->speed = given->speed;
    if (options->scene == given->scene && !given->page) {
        *count = given->panes;
        memcpy(options, given, (size_t)*count * sizeof *given);
    }
    return STATUS_OK;
}

/* Another scene, from its start; it keeps the pause, and one that explains
 * something begins with one. */
Status obey_scene(Player *player, const Command *command)
{
    Options options[OPTIONS_MAX_PANES];
    int count;
    bool runs = player->mode >= MODE_END || !player_stands(player);
    Status status =
        player_own_options(player, command->text, NULL, options, &count);
    if (!status)
        status = player_begin(player, options, count, command);
    if (status)
        return status;
    player_close_sheet(player);
    bool explains = options->scene->explains && !player->given[0].script;
    player->mode = runs && !explains ? MODE_RUN : MODE_PAUSE;
    if (player->column != COLUMN_KEYS)
        player->column = COLUMN_CARDS;
    return STATUS_OK;
}

/* From step 0 with the present numbers, or from another start; a pause that
 * nobody asked for ends. */
Status obey_restart(Player *player, const Command *command)
{
    Options options[OPTIONS_MAX_PANES];
    int panes = player_options(player, options);
    bool moves = command->kind == COMMAND_START;
    if (moves && !(options->scene->needs & NEEDS_START))
        return player_refuse(player, "this scene has no start to choose");
    for (int p = 0; p < panes && moves; p++) {
        options[p].start[0] = command->x;
        options[p].start[1] = command->y;
    }
    if (moves)
        player->mode = MODE_PAUSE;
    else if (player->mode >= MODE_END && !options->page &&
             !options->scene->explains)
        player->mode = MODE_RUN;
    if (!moves)
        player->show.lens = LENS_FITS;
    return player_begin(player, options, panes, command);
}

/* ---- the lecture --------------------------------------------------------- */

Status player_obey_lines(Player *player, const char *lines)
{
    Status status = STATUS_OK;
    while (lines && *lines && !status) {
        char line[COMMAND_TEXT_SIZE];
        Command command;
        size_t length = strcspn(lines, ";");
        snprintf(line, sizeof line, "& %.*s", (int)length, lines);
        lines += length + (lines[length] == ';');
        status = command_parse(line, &command, player->message,
                               sizeof player->message);
        if (!status)
            status = player_obey(player, &command);
    }
    return status;
}

Status player_open_page(Player *player)
{
    const LecturePage *page = player_settings(player)->page;
    player->told = page; /* nobody has asked for these steps */
    player->opens = true;
    Status status = player_obey_lines(player, page ? page->open : NULL);
    player->told = NULL;
    player->opens = false;
    return status;
}

bool player_veils(const Player *player)
{
    const LecturePage *page = player_settings(player)->page;
    return page && page->ask && player->told != page && player->asks;
}

/* Two of a hundred are near enough for what was calculated on paper. */
Status player_unveil(Player *player, const char *typed)
{
    const LecturePage *page = player_settings(player)->page;
    const OptionRow any = {
        .kind = OPTION_NUMBER, .unit = "", .low = -HUGE_VAL, .high = HUGE_VAL};
    double truth = page->answer ? show_number(&player->show, page->answer) : 0;
    double guess = truth;
    if (typed && (!option_read(&any, typed, &guess) || !isfinite(guess)))
        return player_refuse(player, "a number is wanted: 0.25 or 1/4");
    bool right = fabs(guess - truth) <= 0.02 * fabs(truth);
    player->told = page;
    Status status = player_obey_lines(player, page->tell);
    if (page->answer)
        player_note(player, "%s%sit is %s", typed ? typed : "",
                    !typed  ? ""
                    : right ? ": right, "
                            : ": no, ",
                    number_with(truth, 5).text);
    return status;
}

/* The page that is asked for, from its start with its settings: by its name;
 * the next one or the one before; the one that was left for another scene; or
 * the first. */
Status obey_page(Player *player, const Command *command)
{
    Options options;
    int count;
    const LecturePage *page = player_settings(player)->page;
    bool on = command->kind == COMMAND_PAGE_ON;
    if (command->kind == COMMAND_PAGE) {
        page = lecture_find(command->text);
        if (!page)
            return player_refuse(player,
                                 "there is no page '%s', they are 1 ... %d",
                                 command->text, lecture_count());
    } else if (page) {
        if (on ? !page[1].name : page == lecture_pages)
            return player_refuse(player, on ? "this is the last page"
                                            : "this is the first page");
        page += on ? 1 : -1;
    } else if (player->left) {
        page = player->left + (on && player->left[1].name);
    } else {
        page = &lecture_pages[0];
    }
    Status status = player_own_options(player, "", page, &options, &count);
    if (status)
        return status;
    status = player_begin(player, &options, 1, command);
    player->speed = player_first_speed(&options);
    player->left = page;
    player->told = NULL;
    player->column = COLUMN_CARDS;
    player->fine = 0;
    player_close_sheet(player);
    if (status || player->given[0].script)
        return status;
    player->mode = MODE_PAUSE;
    return player_open_page(player);
}

/* A guess of where the next step leads. */
Status obey_predict(Player *player, const Command *command)
{
    double at[2];
    Simulation *simulation = &player->past.machine[player->active].simulation;
    if (simulation->done || simulation_point(simulation, at) == 0)
        return player_refuse(player, "nothing to predict here");
    player_stop(player);
    simulation_predict(simulation, command->x, command->y);
    return STATUS_OK;
}

/* ---- the map ------------------------------------------------------------- */

/* Shows a cell of the envelope. */
Status obey_cell(Player *player, const Command *command)
{
    long cell = command->number;
    Simulation *simulation = &player->past.machine[player->active].simulation;
    const EnvelopeMap *map = &simulation->exhibit.map;
    int column = (int)(cell % ENVELOPE_COLUMNS);
    int row = (int)(cell / ENVELOPE_COLUMNS);
    if (map->column == column && map->row == row)
        return STATUS_OK;
    return envelope_visit(simulation, column, row);
}
