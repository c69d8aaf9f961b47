/* hands.c - from keyboard and mouse to commands.
 *
 * What is under the mouse is a question to the layout and to the pictures; what
 * is done about it is a command, as a script could say it.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/picture.h"
#include "play/playing.h"
#include "scenes/scene.h"
#include "base/mathematics.h"

enum {
    CLICK_ROOM = 4,   /* pixels that a click may move */
    PACE_PIXELS = 24, /* of a drag that changes a number by one pace */
    NAME_PIXELS = 60  /* the same for a name */
};

static const double WHEEL_ZOOM = 1.15; /* of one notch */

/* Where everything was in the last frame. */
static Layout last_layout(Player *player)
{
    const Paper *paper = view_paper(player->view);
    return show_layout(&player->show, paper ? paper->canvas.width : 1,
                       paper ? paper->canvas.height : 1);
}

/* A command without arguments. */
static Status ask(Player *player, CommandKind kind)
{
    Command command = {.kind = kind};
    return player_obey(player, &command);
}

static Status ask_number(Player *player, CommandKind kind, long number,
                         double x, double y)
{
    Command command = {.kind = kind, .number = number, .x = x, .y = y};
    return player_obey(player, &command);
}

static Status ask_set(Player *player, const char *option, const char *value)
{
    Command command = {.kind = COMMAND_SET};
    snprintf(command.text, sizeof command.text, "%s %s", option, value);
    return player_obey(player, &command);
}

/* ---- the row of numbers ------------------------------------------------- */

/* One pace of a number, by wheel or key. */
static Status pace(Player *player, int index, int paces)
{
    char value[COMMAND_TEXT_SIZE / 2];
    if (index < 0 || index >= player->numbers)
        return STATUS_OK;
    const OptionRow *row = player->number[index];
    Options options = player_numbers(player);
    option_write(row, option_paced(row, &options, paces), value, sizeof value);
    return ask_set(player, row->name, value);
}

/* A number follows the mouse: from its value where the drag began. */
static Status drag_number(Player *player)
{
    Mouse *mouse = &player->mouse;
    if (mouse->index >= player->numbers)
        return STATUS_OK;
    const OptionRow *row = player->number[mouse->index];
    char value[COMMAND_TEXT_SIZE / 2];
    double paces = (mouse->x - mouse->from[0]) / PACE_PIXELS;
    if (row->kind == OPTION_NAME) {
        double names = (mouse->x - mouse->last[0]) / NAME_PIXELS;
        if (fabs(names) < 1)
            return STATUS_OK;
        mouse->last[0] = mouse->x;
        return pace(player, mouse->index, names > 0 ? 1 : -1);
    }
    if (row->pace > 0)
        paces = rint(paces);
    else if (paces == rint(paces))
        paces += 1e-9; /* a value between the round ones */
    double wanted = option_paced(row, &mouse->options, paces);
    option_write(row, wanted, value, sizeof value);
    return player_numbers(player).number[row->slot] == wanted
               ? STATUS_OK
               : ask_set(player, row->name, value);
}

/* ---- what is typed ------------------------------------------------------ */

/* The letter that a key types; "": none.  letter [size] out */
static void key_letter(const char *key, char *letter, size_t size)
{
    bool shift = strncmp(key, "Shift+", 6) == 0;
    const char *name = shift ? key + 6 : key;
    bool one = name[0] && (!name[1] || (unsigned char)name[0] >= 0x80);
    snprintf(letter, size, "%.4s",
             strcmp(name, "Space") == 0 ? " "
             : one                      ? name
                                        : "");
    if (one && !shift && name[0] >= 'A' && name[0] <= 'Z')
        letter[0] = (char)(name[0] - 'A' + 'a');
}

/* Return: the page is opened, or the number is set; what cannot be read leaves
 * the field as it is. */
static Status give_typed(Player *player)
{
    char typed[sizeof player->typed], value[40], note[sizeof player->note];
    char unit[16];
    memcpy(typed, player->typed, sizeof typed);
    if (player->selected < 0) {
        Command command = {.kind = COMMAND_PAGE};
        memcpy(command.text, typed, sizeof typed);
        Status status = player_obey(player, &command);
        if (!status)
            player_deselect(player);
        return status;
    }
    const OptionRow *row = player->number[player->selected];
    double number;
    bool known = option_read(row, typed, &number);
    snprintf(value, sizeof value, "%s", typed);
    if (known)
        option_write(row, number, value, sizeof value);
    Status status = ask_set(player, row->name, value);
    if (status)
        return status;
    player_deselect(player);
    if (strcmp(typed, value) == 0)
        return STATUS_OK;
    memcpy(note, player->note, sizeof note);
    option_unit(row, unit, sizeof unit);
    player_note(player, "%s is read as %.4g%s%s%s%s", typed,
                strtod(value, NULL), unit[0] ? " " : "", unit,
                note[0] ? "; " : "", note);
    return STATUS_OK;
}

/* One letter more or less. */
static Status edit_typed(Player *player, const char *key)
{
    char *typed = player->typed, letter[8];
    size_t length = strlen(typed);
    if (strcmp(key, "Backspace") == 0) {
        while (length > 0 && ((unsigned char)typed[--length] & 0xc0) == 0x80)
            continue; /* of a letter of several bytes */
        typed[length] = '\0';
        return STATUS_OK;
    }
    key_letter(key, letter, sizeof letter);
    if (length + strlen(letter) >= sizeof player->typed) {
        player_note(player,
                    "there is room for %zu letters: Enter sets the "
                    "number, Esc leaves it",
                    sizeof player->typed - 1);
        return STATUS_OK;
    }
    memcpy(typed + length, letter, strlen(letter) + 1);
    return STATUS_OK;
}

/* A digit, sign or point opens the field of a selected number, a digit that of
 * the list of pages; an open field takes every key until Return or Escape.
 * taken out: whether it was one for a field. */
static Status type_key(Player *player, const char *key, bool *taken)
{
    bool number = player->selected >= 0 && player->selected < player->numbers;
    bool list = player->column == LECTURE_PAGES && !player->help;
    const char *opens = number ? "0123456789.,+-" : list ? "123456789" : "";
    player->typing = player->typing && (number || list);
    *taken = player->typing || (key[0] && !key[1] && strchr(opens, key[0]));
    if (!*taken)
        return STATUS_OK;
    player->typing = true;
    player->changed = true;
    player->note[0] = '\0';
    if (strcmp(key, "Return") == 0 || strcmp(key, "Keypad Enter") == 0)
        return give_typed(player);
    if (strcmp(key, "Escape") == 0) {
        player_deselect(player);
        return STATUS_OK;
    }
    Status status = edit_typed(player, key);
    if (player->note[0])
        return status;
    if (number)
        player_note(player, "a number is typed: Enter sets it, Esc leaves it");
    else
        player_note(player, "page %s_: Enter opens it, Esc leaves it",
                    player->typed);
    return status;
}

/* ---- the stage ---------------------------------------------------------- */

/* The stretch that puts the edge under the mouse. */
static Status drag_edge(Player *player, const Pick *pick)
{
    const Options *options = player_settings(player);
    char value[32], now[32];
    double stretch = 2 * fabs(pick->point[0]) / options->side;
    snprintf(value, sizeof value, "%.2f", fmax(stretch, 0.02));
    snprintf(now, sizeof now, "%.2f", options->stretch);
    return strcmp(value, now) == 0 ? STATUS_OK
                                   : ask_set(player, "stretch", value);
}

/* The node nearest to a place of the body, or -1: it is beside it. */
static int near_node(const Player *player, const Pick *pick)
{
    const Pane *pane = &player->show.pane[pick->pane];
    const Simulation *simulation = pane->simulation;
    const SquareMesh *mesh = &simulation->mesh;
    const double *x = pane_x(pane);
    double reach = 0.75 * mesh->spacing;
    int nearest = -1;
    for (int i = 0; i < mesh->nodes; i++) {
        double away = math_hypot(x[2 * i] - pick->point[0],
                                 x[2 * i + 1] - pick->point[1]);
        if (away < reach) {
            reach = away;
            nearest = i;
        }
    }
    return nearest;
}

/* Takes what is under the mouse. */
static Status take(Player *player, const Pick *pick)
{
    Mouse *mouse = &player->mouse;
    mouse->index = pick->index;
    switch (pick->kind) {
    case PICK_NODE:
        mouse->drag = DRAG_NODE;
        return STATUS_OK;
    case PICK_EDGE:
        mouse->drag = player->paused && !player->halted ? DRAG_EDGE : DRAG_NODE;
        mouse->index = near_node(player, pick);
        return STATUS_OK;
    case PICK_HANDLE:
        mouse->drag = DRAG_HANDLE;
        return STATUS_OK;
    case PICK_SWITCH:
        return ask_number(player, COMMAND_FLIP, pick->index, 0, 0);
    case PICK_CELL:
        return lesson_load(player, pick->index);
    case PICK_PLACE:
        if (lesson_asks(player)) {
            mouse->drag = DRAG_NONE;
            return ask_number(player, COMMAND_PREDICT, 0, pick->point[0],
                              pick->point[1]);
        }
        mouse->drag = DRAG_START;
        return ask_number(player, COMMAND_START, 0, pick->point[0],
                          pick->point[1]);
    default:
        mouse->index = near_node(player, pick);
        mouse->drag = mouse->index >= 0 ? DRAG_NODE : DRAG_PICTURE;
        return STATUS_OK;
    }
}

/* The world under the mouse, in the pane where it is. */
static Pick world_at(Player *player, const Layout *layout)
{
    const Mouse *mouse = &player->mouse;
    Pick pick = {.pane = player->active};
    Hit hit = layout_hit(layout, mouse->x, mouse->y);
    if (hit.zone == ZONE_STAGE && hit.index < past_panes(&player->past))
        pick.pane = hit.index;
    Camera camera = show_camera(&player->show, layout, pick.pane);
    camera_world(&camera, mouse->x, mouse->y, pick.point);
    return pick;
}

/* What is held follows the mouse. */
static Status follow(Player *player, const Layout *layout)
{
    Mouse *mouse = &player->mouse;
    Pick pick = world_at(player, layout);
    double dx = mouse->x - mouse->last[0], dy = mouse->y - mouse->last[1];
    if (math_hypot(mouse->x - mouse->from[0], mouse->y - mouse->from[1]) >
        CLICK_ROOM)
        mouse->moved = true;
    Status status = STATUS_OK;
    switch (mouse->moved ? mouse->drag : DRAG_NONE) {
    case DRAG_NODE:
        if (!player->holds)
            status = ask_number(player, COMMAND_GRAB, mouse->index, 0, 0);
        return status ? status
                      : ask_number(player, COMMAND_DRAG, 0, pick.point[0],
                                   pick.point[1]);
    case DRAG_EDGE:
        return drag_edge(player, &pick);
    case DRAG_START:
        return ask_number(player, COMMAND_START, 0, pick.point[0],
                          pick.point[1]);
    case DRAG_HANDLE:
        return ask_number(player, COMMAND_HANDLE, mouse->index, pick.point[0],
                          pick.point[1]);
    case DRAG_NUMBER:
        return drag_number(player);
    case DRAG_TIME:
        return ask_number(player, COMMAND_GOTO,
                          show_step_at(&player->show, layout, mouse->x), 0, 0);
    case DRAG_PICTURE:
        show_move(&player->show, layout, pick.pane, dx, dy);
        player->lens = player->show.lens;
        player->changed = true;
        mouse->last[0] = mouse->x;
        mouse->last[1] = mouse->y;
        return STATUS_OK;
    default:
        return STATUS_OK;
    }
}

/* ---- events ------------------------------------------------------------- */

/* What is under the mouse, for the picture; a cell of the envelope is run. */
static Status hover(Player *player, const Layout *layout)
{
    const Mouse *mouse = &player->mouse;
    Hit over = layout_hit(layout, mouse->x, mouse->y);
    Pick pick = show_pick(&player->show, layout, mouse->x, mouse->y);
    Show *show = &player->show;
    bool same =
        over.zone == show->over.zone && over.index == show->over.index &&
        pick.kind == show->hover.kind && pick.index == show->hover.index &&
        pick.pane == show->hover.pane;
    bool idle = pick.kind == PICK_NONE && over.zone != ZONE_TIME;
    show->over = over;
    show->hover = pick;
    if (!same || !idle)
        player->changed = true;
    return pick.kind == PICK_CELL && !same
               ? ask_number(player, COMMAND_CELL, pick.index, 0, 0)
               : STATUS_OK;
}

/* The row of the list of pages that was hit. */
static Status page_clicked(Player *player, const Layout *layout)
{
    Command command = {.kind = COMMAND_PAGE};
    int row =
        show_help_row(&player->show, layout, player->mouse.x, player->mouse.y);
    if (player->column != LECTURE_PAGES || row < 0)
        return STATUS_OK;
    snprintf(command.text, sizeof command.text, "%d", row + 1);
    return player_obey(player, &command);
}

static Status left_pressed(Player *player, const Layout *layout, int clicks)
{
    Mouse *mouse = &player->mouse;
    Hit hit = layout_hit(layout, mouse->x, mouse->y);
    player_deselect(player);
    switch (hit.zone) {
    case ZONE_CHIP:
        return ask(player, player->chip[hit.index]);
    case ZONE_CARD_CLOSE:
        return ask_number(player, COMMAND_CARD, hit.index, 0, 0);
    case ZONE_CARD:
        return ask_number(player, COMMAND_ENLARGE, hit.index, 0, 0);
    case ZONE_TIME:
        mouse->drag = DRAG_TIME;
        return ask_number(player, COMMAND_GOTO,
                          show_step_at(&player->show, layout, mouse->x), 0, 0);
    case ZONE_SETTING:
        if (hit.index >= player->numbers)
            return STATUS_OK;
        player->selected = hit.index;
        player->changed = true;
        if (clicks == 2) {
            Command command = {.kind = COMMAND_DEFAULT};
            snprintf(command.text, sizeof command.text, "%s",
                     player->number[hit.index]->name);
            return player_obey(player, &command);
        }
        mouse->drag = DRAG_NUMBER;
        mouse->index = hit.index;
        mouse->options = player_numbers(player);
        return STATUS_OK;
    case ZONE_PAGE:
        return page_clicked(player, layout);
    case ZONE_STRIP:
        player_note(player, player_settings(player)->page
                                ? "Page Down and Page Up turn the pages, G "
                                  "lists them, 1 ... 9 open scenes"
                                : "1 ... 9 open other scenes, ? lists them; "
                                  "Page Down begins the lecture");
        return STATUS_OK;
    case ZONE_STAGE:
        break;
    default:
        return STATUS_OK;
    }
    if (hit.index < past_panes(&player->past) && hit.index != player->active) {
        Status status = ask_number(player, COMMAND_PANE, hit.index, 0, 0);
        if (status)
            return status;
    }
    Pick pick = show_pick(&player->show, layout, mouse->x, mouse->y);
    if (pick.kind == PICK_NONE || pick.kind == PICK_SPRING) {
        Pick world = world_at(player, layout);
        memcpy(pick.point, world.point, sizeof pick.point);
        pick.pane = world.pane;
    }
    if (clicks == 2 && (pick.kind == PICK_NONE || pick.kind == PICK_SPRING))
        return ask(player, COMMAND_FIT);
    return take(player, &pick);
}

/* The node under the mouse, or the nearest one of the body there, is pinned or
 * set free. */
static Status pin(Player *player, const Layout *layout, Pick *pick)
{
    const Simulation *simulation = player_simulation(player);
    int node = pick->index;
    if (pick->kind != PICK_NODE) {
        *pick = world_at(player, layout);
        node = near_node(player, pick);
    }
    if (node < 0 && (simulation->scene->needs & NEEDS_MESH) &&
        !simulation->scene->step)
        return player_refuse(player, "no node is here: a right click on one "
                                     "pins it, or sets it free");
    return ask_number(player, COMMAND_PIN, node < 0 ? 0 : node, 0, 0);
}

static Status pressed(Player *player, const Input *input, const Layout *layout)
{
    Mouse *mouse = &player->mouse;
    mouse->from[0] = mouse->last[0] = mouse->x;
    mouse->from[1] = mouse->last[1] = mouse->y;
    mouse->moved = false;
    if (input->button == BUTTON_LEFT)
        return left_pressed(player, layout, input->clicks);
    Hit hit = layout_hit(layout, mouse->x, mouse->y);
    if (hit.zone != ZONE_STAGE)
        return STATUS_OK;
    if (input->button == BUTTON_MIDDLE) {
        mouse->drag = DRAG_PICTURE;
        mouse->moved = true;
        return STATUS_OK;
    }
    Pick pick = show_pick(&player->show, layout, mouse->x, mouse->y);
    return pin(player, layout, &pick);
}

/* A click on a name takes the next one. */
static Status released(Player *player)
{
    Mouse *mouse = &player->mouse;
    Drag drag = mouse->drag;
    mouse->drag = DRAG_NONE;
    if (drag == DRAG_TIME)
        player->changed = true; /* now the cards know the step */
    if (drag == DRAG_NODE && player->holds)
        return ask(player, COMMAND_RELEASE);
    if (drag == DRAG_NUMBER && !mouse->moved &&
        mouse->index < player->numbers &&
        player->number[mouse->index]->kind == OPTION_NAME)
        return pace(player, mouse->index, 1);
    return STATUS_OK;
}

static Status wheeled(Player *player, double amount, const Layout *layout)
{
    const Mouse *mouse = &player->mouse;
    Hit hit = layout_hit(layout, mouse->x, mouse->y);
    int notches = amount > 0 ? 1 : -1;
    if (hit.zone == ZONE_SETTING)
        return pace(player, hit.index, notches);
    if (hit.zone == ZONE_TIME)
        return ask(player, amount > 0 ? COMMAND_BACK : COMMAND_NEXT);
    if (hit.zone != ZONE_STAGE)
        return STATUS_OK;
    show_zoom(&player->show, layout, mouse->x, mouse->y,
              pow(WHEEL_ZOOM, amount));
    player->lens = player->show.lens;
    player->changed = true;
    return STATUS_OK;
}

/* What the input asks for. */
static Status take_input(Player *player, const Input *input)
{
    Command command = {.kind = COMMAND_NONE};
    Mouse *mouse = &player->mouse;
    Status status;
    bool typed;
    switch (input->kind) {
    case INPUT_KEY:
        status = type_key(player, input->key, &typed);
        if (typed)
            return status;
        command_from_key(input->key, input->repeats, &command);
        return command.kind == COMMAND_NONE ? STATUS_OK
                                            : player_obey(player, &command);
    case INPUT_CLOSE:
        return ask(player, COMMAND_QUIT);
    case INPUT_REDRAW:
        return ask(player, COMMAND_REDRAW);
    case INPUT_LEAVE:
        mouse->inside = false;
        player->show.hover = (Pick){.kind = PICK_NONE};
        player->show.over = (Hit){ZONE_NONE, 0};
        player->changed = true;
        return STATUS_OK;
    case INPUT_NONE:
        return STATUS_OK;
    default:
        break;
    }
    bool rests =
        !mouse->placed || (mouse->x == input->x && mouse->y == input->y);
    mouse->x = input->x;
    mouse->y = input->y;
    mouse->inside = mouse->placed = true;
    if (rests && input->kind == INPUT_MOVE && mouse->drag == DRAG_NONE)
        return STATUS_OK; /* the window came to the mouse */
    Layout layout = last_layout(player);
    if (input->kind == INPUT_PRESS)
        return pressed(player, input, &layout);
    if (input->kind == INPUT_RELEASE)
        return released(player);
    if (input->kind == INPUT_WHEEL)
        return wheeled(player, input->amount, &layout);
    if (mouse->drag != DRAG_NONE)
        return follow(player, &layout);
    return hover(player, &layout);
}

/* A drag is one gesture, and so is a wheel that turns on. */
Status player_input(Player *player, const Input *input)
{
    bool turns = input->kind == INPUT_WHEEL && player->mouse.turns;
    bool key = input->kind == INPUT_KEY && !input->repeats &&
               player->mouse.drag == DRAG_NONE;
    if (input->kind == INPUT_PRESS || key ||
        (input->kind == INPUT_WHEEL && !turns))
        player->gesture++;
    player->mouse.turns = input->kind == INPUT_WHEEL;
    player->by_hand = true;
    Status status = take_input(player, input);
    player->by_hand = false;
    return status;
}
