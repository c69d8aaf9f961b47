/* lesson.c - the lecture in the window: one page after the other. */
#include <stdio.h>

#include "picture/show.h"
#include "play/playing.h"
#include "scenes/pages.h"

/* The page's scene from its start, with its settings. */
static Status lesson_open(Player *player, const LecturePage *page)
{
    Options options;
    char title[128];
    Status status = lecture_options(page, &options, player->message,
                                    sizeof player->message);
    if (status)
        return status;
    player_keep_files(player, &options);
    status = player_restart(player, &options, 1);
    player->speed = player_first_speed(&options);
    player_reset_speed(player);
    player->column = LECTURE_CARDS;
    player->help = false;
    if (!player->given[0].script)
        player->paused = !page->plays;
    player_title(player, title, sizeof title);
    if (player->view)
        view_set_title(player->view, title);
    return status;
}

static Status refuse_page(Player *player, const char *why)
{
    snprintf(player->message, sizeof player->message, "%s", why);
    return STATUS_INVALID_INPUT;
}

/* The first page and the last one have only one neighbour. */
Status lesson_turn(Player *player, const Command *command)
{
    const LecturePage *page = player->lane[0].track.settings.options.page;
    if (command->kind == COMMAND_PAGE) {
        page = lecture_find(command->text);
        return page ? lesson_open(player, page)
                    : refuse_page(player, "there is no such page");
    }
    if (!page)
        return lesson_open(player, &lecture_pages[0]);
    if (command->kind == COMMAND_PAGE_ON && !page[1].name)
        return refuse_page(player, "this is the last page");
    if (command->kind == COMMAND_PAGE_BACK && page == lecture_pages)
        return refuse_page(player, "this is the first page");
    return lesson_open(player,
                       command->kind == COMMAND_PAGE_ON ? page + 1 : page - 1);
}
