/* screen.c - what only the screen shows: speed, camera, cards, help. */
#include <math.h>

#include "picture/picture.h"
#include "play/playing.h"

/* Twice or half as fast. */
static Status change_speed(Player *player, const Command *command)
{
    int speed = player->speed + (command->kind == COMMAND_FASTER ? 1 : -1);
    if (speed >= SPEED_LEAST && speed <= SPEED_MOST)
        player->speed = speed;
    player_reset_speed(player);
    return STATUS_OK;
}

/* What is on or off. */
static Status switch_shown(Player *player, const Command *command)
{
    bool *shown = command->kind == COMMAND_COLOURS ? &player->strain
                  : command->kind == COMMAND_BARE  ? &player->bare
                  : command->kind == COMMAND_KEYS  ? &player->help
                                                   : &player->blank;
    *shown = !*shown;
    return STATUS_OK;
}

static Status switch_full(Player *player, const Command *command)
{
    (void)command;
    if (player->view)
        view_set_full(player->view, !view_is_full(player->view));
    return STATUS_OK;
}

/* What is open ends first; then, asked twice, the program. */
static Status leave(Player *player, const Command *command)
{
    (void)command;
    if (player_escape_ends(player))
        player->quit = true;
    else if (player->help)
        player->help = false;
    else if (player->selected >= 0)
        player_deselect(player);
    else if (player->column)
        player->column = LECTURE_CARDS;
    else if (player->blank)
        player->blank = false;
    else if (player->view && view_is_full(player->view))
        view_set_full(player->view, false);
    else
        player_note(player, "Esc once more, or Q, ends the program");
    return STATUS_OK;
}

/* Zooms at a point in metres, or moves the picture by some of them. */
static Status move_camera(Player *player, const Command *command)
{
    const Paper *paper = player->view ? view_paper(player->view) : NULL;
    if (!paper)
        return STATUS_OK;
    player_fill(player);
    Layout layout =
        show_layout(&player->show, paper->canvas.width, paper->canvas.height);
    Camera camera = show_camera(&player->show, &layout, player->active);
    double at[2] = {command->x, command->y}, pixel[2];
    camera_pixel(&camera, at, pixel);
    if (command->kind == COMMAND_ZOOM)
        show_zoom(&player->show, &layout, pixel[0], pixel[1],
                  fmin(fmax((double)command->number, 1), 1e6) / 100);
    else
        show_move(&player->show, &layout, player->active,
                  camera.scale[0] * command->x, -camera.scale[1] * command->y);
    player->lens = player->show.lens;
    return STATUS_OK;
}

static Status fit(Player *player, const Command *command)
{
    (void)command;
    player->lens = LENS_FITS;
    return STATUS_OK;
}

/* A card is closed or opened; one that is open is enlarged, or as the others.
 */
static Status switch_card(Player *player, const Command *command)
{
    int cards = picture_cards(picture_of(player_simulation(player)->scene));
    int card = (int)fmin((double)command->number, 1e6);
    if (card >= cards)
        return player_refuse(player, "there is no such card");
    player_fill(player);
    bool closed = player->show.closed >> card & 1;
    if (command->kind == COMMAND_CARD || closed) /* its title opens it */
        player->closed ^= 1u << card;
    else
        player->large = player->large == card ? -1 : card;
    return STATUS_OK;
}

/* The list of pages, or a page's code, or the cards again. */
static Status switch_column(Player *player, const Command *command)
{
    LectureColumn column =
        command->kind == COMMAND_PAGES ? LECTURE_PAGES : LECTURE_CODE;
    if (column == LECTURE_CODE && !player_settings(player)->page)
        return player_refuse(player, "only pages of the lecture have code: "
                                     "Page Down opens them");
    player->help = false;
    player->column = player->column == column ? LECTURE_CARDS : column;
    return STATUS_OK;
}

static Status redraw(Player *player, const Command *command)
{
    (void)player; /* every command draws */
    (void)command;
    return STATUS_OK;
}

static Status end_program(Player *player, const Command *command)
{
    (void)command;
    player->quit = true;
    return STATUS_OK;
}

const Deed screen_deeds[] = {
    {COMMAND_FASTER, change_speed},
    {COMMAND_SLOWER, change_speed},
    {COMMAND_COLOURS, switch_shown},
    {COMMAND_BARE, switch_shown},
    {COMMAND_KEYS, switch_shown},
    {COMMAND_BLANK, switch_shown},
    {COMMAND_FULL, switch_full},
    {COMMAND_ESCAPE, leave},
    {COMMAND_ZOOM, move_camera},
    {COMMAND_PAN, move_camera},
    {COMMAND_FIT, fit},
    {COMMAND_CARD, switch_card},
    {COMMAND_ENLARGE, switch_card},
    {COMMAND_PAGES, switch_column},
    {COMMAND_CODE, switch_column},
    {COMMAND_REDRAW, redraw},
    {COMMAND_QUIT, end_program},
    {COMMAND_NONE, NULL},
};
