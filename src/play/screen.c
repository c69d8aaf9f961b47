/* screen.c - commands for the screen: speed, camera, cards, lists; the end. */
#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "play/playing.h"

/* Whether the session has edits, or a run of a minute, that could be lost. */
static bool could_lose_work(const Player *player)
{
    static const double LONG = 60; /* s */
    const Past *past = &player->past;
    return past->branch_index > 0 ||
           (past_find_newest(past) > 0 &&
            clock_now() - player->setup.start_time > LONG);
}

Status obey_change_screen(Player *player, const Command *command)
{
    const Window *window = player->screen.window;
    CommandKind kind = command->kind;
    if (kind == COMMAND_FASTER)
        player->play.log_speed += player->play.log_speed < MAX_LOG_SPEED;
    else if (kind == COMMAND_SLOWER)
        player->play.log_speed -= player->play.log_speed > MIN_LOG_SPEED;
    else if (kind == COMMAND_COLOURS)
        player->screen.has_toggled_strain = !player->screen.has_toggled_strain;
    else if (kind == COMMAND_BARE)
        player->screen.is_bare = !player->screen.is_bare;
    else if (kind == COMMAND_BLANK)
        player->screen.is_black = !player->screen.is_black;
    else if (kind == COMMAND_FULL && window)
        window->set_full_screen(!window->is_full_screen());
    else if (kind == COMMAND_PANE)
        player->active_pane = (int)command->number;
    else if (kind == COMMAND_CLOSE)
        player_deselect(player);
    return STATUS_OK;
}

Status obey_show_column(Player *player, const Command *command)
{
    ColumnContent column = command->kind == COMMAND_KEYS      ? COLUMN_KEYS
                           : command->kind == COMMAND_PAGES   ? COLUMN_PAGES
                           : command->kind == COMMAND_LETTERS ? COLUMN_LETTERS
                           : command->kind == COMMAND_OPTIONS ? COLUMN_OPTIONS
                                                              : COLUMN_CODE;
    if (column == COLUMN_CODE && !player_get_active_options(player)->page)
        return player_refuse(player, "only pages of the lecture have code: "
                                     "Page Down opens them");
    player->screen.column =
        player->screen.column == column ? COLUMN_CARDS : column;
    sheet_close(player);
    player_deselect(player);
    return STATUS_OK;
}

/* Ends the program; the key must be pressed twice if there is work to lose. */
Status obey_quit(Player *player, const Command *command)
{
    bool key = command->text[0] != '\0', asked = player->commands.quit_command;
    player->is_quitting = !key || asked || !could_lose_work(player);
    player->commands.quit_command = COMMAND_QUIT;
    if (!player->is_quitting)
        player_notify(player, "Q once more ends the program; Y saves first a "
                              "script that leads here");
    return STATUS_OK;
}

/* Closes the topmost open thing.  With everything closed a second Escape ends
 * the program, if there is no work to lose. */
Status obey_escape(Player *player, const Command *command)
{
    const Window *window = player->screen.window;
    bool asked = player->commands.quit_command == COMMAND_ESCAPE;
    player->commands.quit_command = COMMAND_NONE;
    if (player->screen.is_black)
        player->screen.is_black = false;
    else if (player->screen.sheet)
        sheet_close(player);
    else if (player->screen.column == COLUMN_KEYS)
        player->screen.column = COLUMN_CARDS;
    else if (player->input.selected_option)
        player_deselect(player);
    else if (player->screen.column)
        player->screen.column = COLUMN_CARDS;
    else if (window && window->is_full_screen())
        window->set_full_screen(false);
    else if (could_lose_work(player))
        player_notify(player, "nothing is open; Q ends the program");
    else if (asked)
        player->is_quitting = true;
    else
        player->commands.quit_command = COMMAND_ESCAPE;
    if (player->commands.quit_command)
        player_notify(player, "Esc once more, or Q, ends the program");
    return STATUS_OK;
}

Status obey_move_camera(Player *player, const Command *command)
{
    const FrameContent *content = &player->screen.frame.content;
    Lens *lens = &player->screen.view.lens;
    if (command->kind == COMMAND_FIT) {
        *lens = LENS_FITS;
        lens->shows_all_obstacles = true;
        return STATUS_OK;
    }
    const Paper *paper = player_prepare_paper(player);
    if (!paper)
        return STATUS_OK;
    player_build_frame(player);
    Layout layout =
        layout_create(content, paper->canvas.width, paper->canvas.height);
    Camera camera = make_pane_camera(content, &layout, player->active_pane);
    Box pane = layout.pane[player->active_pane];
    double at[2] = {command->x, command->y}, pixel[2];
    camera_to_pixel(&camera, at, pixel);
    if (command->kind == COMMAND_ZOOM)
        lens_zoom(lens, pane, pixel[0], pixel[1],
                  fmin(fmax((double)command->number, 1), 1e6) / 100);
    else
        lens_pan(lens, pane, camera.scale[0] * command->x,
                 -camera.scale[1] * command->y);
    return STATUS_OK;
}

Status obey_toggle_card(Player *player, const Command *command)
{
    int card = (int)command->number;
    const CardSets *sets = &player->screen.frame.content.cards;
    player_build_frame(player);
    bool closed = sets->closed_cards >> card & 1;
    if (sets->hidden_cards >> card & 1)
        return player_refuse(player, "this card is not shown here");
    if (command->kind == COMMAND_CARD || closed)
        player->screen.toggled_cards ^= 1u << card;
    else
        player->screen.enlarged_card =
            player->screen.enlarged_card == card ? -1 : card;
    return STATUS_OK;
}

/* Chooses another cell of the sheet.  Left and Right choose the next cell; Up
 * the last cell before it that lies higher and not further right; Down the
 * first cell after it that lies lower and not further left. */
Status obey_choose_sheet_cell(Player *player, const Command *command)
{
    const FrameContent *content = &player->screen.frame.content;
    int *chosen = &player->screen.view.selected_cell;
    const Paper *paper = player_prepare_paper(player);
    const char *key = command->text;
    bool up = strcmp(key, "Up") == 0, upright = up || strcmp(key, "Down") == 0;
    int way = up || strcmp(key, "Left") == 0 ? -1 : 1, i = *chosen + way;
    if (!paper)
        return STATUS_OK;
    player_build_frame(player);
    Layout layout =
        layout_create(content, paper->canvas.width, paper->canvas.height);
    const Box *cell = layout.cell, *now = &cell[*chosen];
    while (upright && 0 <= i && i < layout.cell_count &&
           !((cell[i].y - now->y) * way > 0 && (cell[i].x - now->x) * way >= 0))
        i += way;
    if (0 <= i && i < layout.cell_count)
        *chosen = i;
    return STATUS_OK;
}
