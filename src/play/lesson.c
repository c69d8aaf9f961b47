/* lesson.c - the lecture in the window: one page after the other. */
#include <stdio.h>
#include <string.h>

#include "picture/show.h"
#include "play/playing.h"
#include "scenes/small_scenes.h"
#include "scenes/pages.h"

Status lesson_prepare(Player *player)
{
    const LecturePage *page = player_settings(player)->page;
    const char *rest = page && page->open ? page->open : "";
    Status status = STATUS_OK;
    while (*rest && !status) {
        char word[COMMAND_TEXT_SIZE];
        Command command;
        size_t length = strcspn(rest, ";");
        snprintf(word, sizeof word, "%.*s", (int)length, rest);
        rest += length + (rest[length] == ';');
        status = command_parse(word, &command, player->message,
                               sizeof player->message);
        if (!status)
            status = player_obey(player, &command);
    }
    return status;
}

/* The page's scene from its start, with its settings. */
static Status lesson_open(Player *player, const LecturePage *page,
                          const Command *command)
{
    Options options;
    Status status = lecture_options(page, &options, player->message,
                                    sizeof player->message);
    if (status)
        return status;
    status = player_begin(player, &options, 1, command);
    player->speed = player_first_speed(&options);
    player_reset_speed(player);
    player->left = page;
    player->column = LECTURE_CARDS;
    player->help = false;
    if (!player->given[0].script)
        player->paused = !page->plays;
    player->fine = 0;
    return status || player->given[0].script ? status : lesson_prepare(player);
}

/* The first page and the last one have only one neighbour. */
static Status turn_page(Player *player, const Command *command)
{
    const LecturePage *page = player_settings(player)->page;
    if (command->kind == COMMAND_PAGE) {
        page = lecture_find(command->text);
        if (page)
            return lesson_open(player, page, command);
        snprintf(player->message, sizeof player->message,
                 "there is no page '%s', they are 1 ... %d", command->text,
                 lecture_count());
        return STATUS_INVALID_INPUT;
    }
    if (!page && player->left) { /* another scene was looked at */
        bool on = command->kind == COMMAND_PAGE_ON && player->left[1].name;
        return lesson_open(player, player->left + on, command);
    }
    if (!page)
        return lesson_open(player, &lecture_pages[0], command);
    if (command->kind == COMMAND_PAGE_ON && !page[1].name)
        return player_refuse(player, "this is the last page");
    if (command->kind == COMMAND_PAGE_BACK && page == lecture_pages)
        return player_refuse(player, "this is the first page");
    return lesson_open(player,
                       command->kind == COMMAND_PAGE_ON ? page + 1 : page - 1,
                       command);
}

/* ---- what the mouse does on a page -------------------------------------- */

bool lesson_asks(const Player *player)
{
    const LecturePage *page = player_settings(player)->page;
    const Simulation *simulation = player_simulation(player);
    return page && page->predict && !simulation->done;
}

/* A guess of where the next step leads. */
static Status predict(Player *player, const Command *command)
{
    double at[2];
    Simulation *simulation = &player->past.machine[player->active].simulation;
    if (simulation->done || simulation_point(simulation, at) == 0)
        return player_refuse(player, "nothing to predict here");
    player->paused = true;
    player->changed = true;
    simulation_predict(simulation, command->x, command->y);
    return STATUS_OK;
}

/* Whether the scene is the envelope and has this cell. */
static bool has_cell(const Player *player, long cell)
{
    return player_simulation(player)->scene->picture == PICTURE_ENVELOPE &&
           cell < (long)ENVELOPE_ROWS * ENVELOPE_COLUMNS;
}

/* Shows a cell of the envelope. */
static Status visit_cell(Player *player, const Command *command)
{
    long cell = command->number;
    Simulation *simulation = &player->past.machine[player->active].simulation;
    const EnvelopeMap *map = &simulation->exhibit.map;
    int column = (int)(cell % ENVELOPE_COLUMNS);
    int row = (int)(cell / ENVELOPE_COLUMNS);
    if (!has_cell(player, cell))
        return player_refuse(player, "there is no such cell");
    if (map->column == column && map->row == row)
        return STATUS_OK;
    player->changed = true;
    return envelope_visit(simulation, column, row);
}

/* A number of the scene, as a script would set it. */
static Status set_number(Player *player, const char *option, double value)
{
    Command command = {.kind = COMMAND_SET};
    snprintf(command.text, sizeof command.text, "%s %.17g", option, value);
    return player_obey(player, &command);
}

/* The square with the cell's numbers, from its start: commands that a script
 * can repeat. */
Status lesson_load(Player *player, long cell)
{
    const Options map = player_simulation(player)->options;
    Command scene = {.kind = COMMAND_SCENE, .text = "square"};
    Command restart = {.kind = COMMAND_RESTART};
    if (!has_cell(player, cell))
        return player_refuse(player, "there is no such cell");
    Status status = player_obey(player, &scene);
    if (!status)
        status = set_number(player, "segments", map.segments);
    if (!status)
        status = set_number(player, "stretch", map.stretch);
    if (!status)
        status = set_number(player, "timestep",
                            envelope_timestep((int)(cell % ENVELOPE_COLUMNS)));
    if (!status)
        status = set_number(player, "stiffness",
                            envelope_stiffness((int)(cell / ENVELOPE_COLUMNS)));
    player->paused = true;
    player->halted = false;
    if (!status)
        status = player_obey(player, &restart);
    player_note(player, "this cell as a scene; Ctrl+Z leads back to the map%s",
                map.page ? ", Page Down goes on" : "");
    return status;
}

const Deed lesson_deeds[] = {
    {COMMAND_PAGE, turn_page},      {COMMAND_PAGE_ON, turn_page},
    {COMMAND_PAGE_BACK, turn_page}, {COMMAND_PREDICT, predict},
    {COMMAND_CELL, visit_cell},     {COMMAND_NONE, NULL},
};
