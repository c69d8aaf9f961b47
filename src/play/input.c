/* input.c - turns inputs of keyboard and mouse into commands. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "play/playing.h"
#include "lesson/pages.h"

enum {
    CLICK_TOLERANCE = 4, /* pixels that the mouse may move during a click */
    NOTCH_PIXELS = 24    /* pixels that a drag moves a number by one notch */
};

static const double WHEEL_ZOOM = 1.15; /* zoom by a notch of the wheel */

/* The parts of the window and of the scene to which the mouse points. */
typedef struct MouseTarget {
    Layout layout; /* layout of the last frame */
    WindowHit hit; /* part of the window under the mouse */
    int pane;
    double point[2]; /* position of the mouse in the scene of this pane, m */
    Pick pick;       /* part of the scene under the mouse */
} MouseTarget;

static MouseTarget find_mouse_target(Player *player)
{
    const Mouse *mouse = &player->input.mouse;
    const Paper *paper = player_prepare_paper(player);
    const FrameContent *content = &player->screen.frame.content;
    DragBounds *held = &player->screen.view.drag_bounds;
    player_update_frame(player);
    MouseTarget target = {
        .layout = layout_create(content, paper ? paper->canvas.width : 1,
                                paper ? paper->canvas.height : 1),
        .pane = player->active_pane};
    target.hit = layout_find_hit(&target.layout, mouse->x, mouse->y);
    int pane = held->is_dragging               ? held->pane_index
               : target.hit.zone == ZONE_STAGE ? target.hit.index
                                               : target.pane;
    if (pane < past_count_panes(&player->past)) /* a dragged pane may close */
        target.pane = pane;
    held->is_mouse_off_stage = false;
    Camera camera = make_pane_camera(content, &target.layout, target.pane);
    camera_to_world(&camera, mouse->x, mouse->y, target.point);
    target.pick = frame_find_pick(content, &target.layout, mouse->x, mouse->y);
    held->is_mouse_off_stage = target.hit.zone != ZONE_STAGE;
    return target;
}

/* Obeys a command at a place (metres) as a part of the present gesture. */
static Status obey_at_xy(Player *player, CommandKind kind, long number,
                         const double at[2])
{
    const Command command = {kind, number, at[0], at[1], .joins_gesture = true};
    return player_obey(player, &command);
}

static Status obey(Player *player, CommandKind kind, long number)
{
    return obey_at_xy(player, kind, number, (const double[2]){0, 0});
}

static Status change_number(Player *player, const OptionRow *row, int notches)
{
    Status status = player_enqueue_notches(player, row, notches);
    return status ? status : player_obey_queue(player, true);
}

/* ---- the keyboard -------------------------------------------------------- */

/* Returns the part of the window that gets the keys now. */
static KeyScope find_key_scope(const Player *player)
{
    bool number = player->input.selected_option,
         list = player_shows_list(player), asks = player_hides_answer(player);
    return player->input.is_typing && (number || list || asks) ? SCOPE_FIELD
           : player->screen.sheet                              ? SCOPE_SHEET
           : number                                            ? SCOPE_NUMBER
           : list                                              ? SCOPE_LIST
           : asks                                              ? SCOPE_QUESTION
                                                               : SCOPE_RUN;
}

static Status open_page(Player *player, const char *name)
{
    Command page = {.kind = COMMAND_PAGE, .joins_gesture = true};
    snprintf(page.text, sizeof page.text, "%s", name);
    return player_obey(player, &page);
}

/* Opens the typed page, or adds the option at the typed place of the list. */
static Status open_typed_row(Player *player)
{
    const OptionRow *all[OPTIONS_MAX_ROWS];
    const char *typed = player->input.typed_text;
    char *end;
    long number = strtol(typed, &end, 10);
    if (player->screen.column != COLUMN_OPTIONS || player->screen.sheet)
        return open_page(player, typed);
    if (*end || number < 1 || number > player_list_options(player, true, all))
        return player_refuse(player, "there is no such number in the list");
    return obey(player, COMMAND_ADD, all[number - 1] - option_rows);
}

/* Acts on the typed text: opens the page, adds or sets the number, or checks
 * the answer.  The field stays open if its text cannot be read. */
static Status accept_typed_text(Player *player)
{
    const OptionRow *row = player->input.selected_option;
    Status status;
    if (!row && player_shows_list(player)) {
        status = open_typed_row(player);
        player->input.is_typing = player->input.is_typing && status;
        return status;
    }
    if (row) {
        Command made = make_set_command(row, 0);
        if (row->number_count > 1 ||
            !option_parse(row, 1, player->input.typed_text, &made.x))
            memcpy(made.text, player->input.typed_text,
                   sizeof player->input.typed_text);
        status = player_obey(player, &made);
    } else {
        status = player_reveal_answer(player, player->input.typed_text);
        status = status ? status : player_obey_queue(player, false);
    }
    if (!status)
        player_deselect(player);
    return status;
}

/* ---- the stage ----------------------------------------------------------- */

/* Sets the dragged number by the distance from the start of the drag.  A
 * dragged edge of the square sets the stretch, rounded to 0.01. */
static Status drag_number(Player *player, const MouseTarget *target)
{
    const Mouse *mouse = &player->input.mouse;
    const Options now = player_get_shown_options(player);
    bool edge = mouse->dragged_index < 0;
    const OptionRow *row =
        edge ? option_find("stretch") : player->input.selected_option;
    double notches = (mouse->x - mouse->drag_start[0]) / NOTCH_PIXELS;
    double wanted =
        fmax(rint(200 * fabs(target->point[0]) / now.side), 2) / 100;
    if (!row)
        return STATUS_OK;
    if (row->number_count >
        1) /* change_number refuses an option of several numbers */
        return change_number(player, row, 1);
    if (row->display.notch_increment > 0 || row->kind == OPTION_NAME)
        notches = rint(notches);
    else if (notches == rint(notches))
        notches += 1e-9; /* whole notches would lead to round values */
    if (!edge)
        wanted =
            option_find_value_after_wheel(row, &mouse->drag_options, notches);
    const Command set = make_set_command(row, wanted);
    return now.number[row->slot] == wanted ? STATUS_OK
                                           : player_obey(player, &set);
}

/* Opens a square with h, k and stretch of a cell, by commands for scripts. */
static Status open_envelope_cell(Player *player, long cell)
{
    const Options map = player_get_simulation(player)->options;
    player_enqueue_lines(player, "scene square");
    player_enqueue_set(player, option_find("segments"), map.segments);
    player_enqueue_set(player, option_find("stretch"), map.stretch);
    player_enqueue_set(player, option_find("timestep"),
                       envelope_get_timestep((int)(cell % ENVELOPE_COLUMNS)));
    player_enqueue_set(player, option_find("stiffness"),
                       envelope_get_stiffness((int)(cell / ENVELOPE_COLUMNS)));
    player_enqueue_lines(player, "pause;restart");
    Status status = player_obey_queue(player, true);
    player_notify(player,
                  "this cell as a scene; Ctrl+Z leads back to the map%s",
                  map.page ? ", Page Down goes on" : "");
    return status;
}

/* Whether drags place nodes and obstacles, instead of pulling and pushing. */
static bool drag_places_nodes(const Player *player)
{
    return player->play.mode == MODE_PAUSE || player->play.mode == MODE_END;
}

/* Begins a drag of a part of the scene, or obeys a click on the part. */
static Status begin_press(Player *player, const MouseTarget *target)
{
    Mouse *mouse = &player->input.mouse;
    const LecturePage *page = player_get_active_options(player)->page;
    double point[2];
    mouse->dragged_index = target->pick.index;
    player->screen.view.drag_bounds = frame_find_view_bounds(
        &player->screen.frame.content, &target->layout, target->pane);
    switch (target->pick.kind) {
    case PICK_OBSTACLE:
        mouse->drag_command = COMMAND_OBSTACLE;
        simulation_locate_obstacle(player_get_simulation(player), 0,
                                   mouse->dragged_index, point);
        mouse->grip_offset[0] = point[0] - target->point[0];
        mouse->grip_offset[1] = point[1] - target->point[1];
        return STATUS_OK;
    case PICK_EDGE:
        mouse->drag_command = COMMAND_SET;
        mouse->dragged_index = -1;
        return STATUS_OK;
    case PICK_HANDLE:
        mouse->drag_command = COMMAND_HANDLE;
        return STATUS_OK;
    case PICK_SWITCH:
        return obey(player, COMMAND_FLIP, target->pick.index);
    case PICK_CELL:
        return open_envelope_cell(player, target->pick.index);
    case PICK_POINT:
        if (page_wants_click(page) && player_hides_answer(player))
            return obey_at_xy(player, COMMAND_PREDICT, 0, target->pick.point);
        mouse->drag_command = COMMAND_START;
        return obey_at_xy(player, COMMAND_START, mouse->dragged_index,
                          target->pick.point);
    default:
        if (target->pick.kind != PICK_NODE) /* a drag highlights only nodes */
            player->screen.view.hovered_part.kind = PICK_NONE;
        mouse->dragged_index = target->pick.nearest_node;
        mouse->drag_command = mouse->dragged_index < 0    ? COMMAND_PAN
                              : drag_places_nodes(player) ? COMMAND_PLACE
                                                          : COMMAND_GRAB;
        return STATUS_OK;
    }
}

/* Adds a ball with a radius of 1/8 of the square.  In a coarse mesh the radius
 * is 0.7 cells so that no ball slips between nodes; near a node it is less. */
static Status add_ball(Player *player, const double at[2])
{
    const Simulation *simulation = player_get_simulation(player);
    Command command = make_set_command(option_find("ball"), 0);
    double radius =
        fmax(simulation->options.side / 8, 0.7 * simulation->mesh.spacing);
    for (int i = 0; i < simulation->system.nodes; i++) {
        const double *x = simulation->run[0].x + 2 * (size_t)i;
        double away = math_hypot(x[0] - at[0], x[1] - at[1]);
        radius = fmin(radius, 0.8 * away);
    }
    snprintf(command.text, sizeof command.text, "%.4g,%.4g,%.3g", at[0], at[1],
             radius);
    Status status = player_obey(player, &command);
    if (!status)
        player_notify(player, "a ball; drag moves it, Ctrl+Z takes it away");
    return status;
}

/* Pushes the dragged obstacle to `at` while time goes on.  In a pause, places
 * the obstacle at `at`, or on the way if a body in a pane blocks the way. */
static Status drag_obstacle(Player *player, const double at[2])
{
    Past *past = &player->past;
    int number = player->input.mouse.dragged_index;
    double part = 1, from[2];
    if (player->input.is_holding || !drag_places_nodes(player)) {
        Status status = STATUS_OK;
        if (!player->input.is_holding)
            status = obey(player, COMMAND_PUSH, number);
        return status ? status : obey_at_xy(player, COMMAND_DRAG, 0, at);
    }
    for (int p = 0; p < past_count_panes(past); p++) {
        const Options *options = &past_get_control(past, p)->options;
        part = fmin(part, simulation_find_free_fraction(
                              &past->pane[p].simulation, options, number, at));
    }
    simulation_locate_obstacle(player_get_simulation(player), 0, number, from);
    if (part == 0)
        return player_refuse(player, "no room: the square is in its way");
    const double to[2] = {from[0] + part * (at[0] - from[0]),
                          from[1] + part * (at[1] - from[1])};
    return obey_at_xy(player, COMMAND_OBSTACLE, number, part < 1 ? to : at);
}

static Status continue_drag(Player *player)
{
    Mouse *mouse = &player->input.mouse;
    const Simulation *simulation = player_get_simulation(player);
    MouseTarget target = find_mouse_target(player);
    double dx = mouse->x - mouse->drag_start[0],
           dy = mouse->y - mouse->drag_start[1];
    Status status = STATUS_OK;
    mouse->has_moved = mouse->has_moved || math_hypot(dx, dy) > CLICK_TOLERANCE;
    if (mouse->dragged_index >=
        player_count_targets(player, player->active_pane, mouse->drag_command))
        mouse->drag_command = COMMAND_NONE; /* undo removed the dragged part */
    switch (mouse->has_moved ? mouse->drag_command : COMMAND_NONE) {
    case COMMAND_GRAB: /* a drag frees a pinned node */
        if (!player->input.is_holding) {
            mouse->repins_node =
                simulation->system.is_pinned[mouse->dragged_index];
            if (mouse->repins_node)
                status = obey(player, COMMAND_PIN, mouse->dragged_index);
            status = status ? status
                            : obey(player, COMMAND_GRAB, mouse->dragged_index);
        }
        return status ? status
                      : obey_at_xy(player, COMMAND_DRAG, 0, target.point);
    case COMMAND_OBSTACLE:
        target.point[0] += mouse->grip_offset[0];
        target.point[1] += mouse->grip_offset[1];
        return drag_obstacle(player, target.point);
    case COMMAND_PLACE:
    case COMMAND_START:
    case COMMAND_HANDLE:
        return obey_at_xy(player, mouse->drag_command, mouse->dragged_index,
                          target.point);
    case COMMAND_SET:
        return drag_number(player, &target);
    case COMMAND_GOTO:
        return obey(player, COMMAND_GOTO,
                    frame_pick_step(&player->screen.frame.content,
                                    &target.layout, mouse->x));
    case COMMAND_PAN:
        lens_pan(&player->screen.view.lens, target.layout.pane[target.pane], dx,
                 dy);
        player->screen.must_redraw = true;
        mouse->drag_start[0] = mouse->x;
        mouse->drag_start[1] = mouse->y;
        return STATUS_OK;
    default:
        return STATUS_OK;
    }
}

/* ---- events -------------------------------------------------------------- */

/* Stores the object under the mouse.  A cell of the envelope is computed. */
static Status store_hovered_object(Player *player)
{
    FrameView *view = &player->screen.view;
    MouseTarget target = find_mouse_target(player);
    Pick pick = target.pick;
    const Pick *old = &view->hovered_part;
    bool same = target.hit.zone == view->mouse_hit.zone &&
                target.hit.index == view->mouse_hit.index &&
                pick.kind == old->kind && pick.index == old->index &&
                pick.pane_index == old->pane_index;
    bool idle =
        pick.kind == PICK_NONE && !player->screen.frame.content.lecture.page;
    if (target.hit.zone == ZONE_CELL)
        view->selected_cell = target.hit.index;
    view->mouse_hit = target.hit;
    view->hovered_part = pick;
    player->explains_hover = player->explains_hover || !same;
    if (!same || !idle)
        player->screen.must_redraw = true;
    return pick.kind == PICK_CELL && !same
               ? obey(player, COMMAND_CELL, pick.index)
               : STATUS_OK;
}

/* Selects a number of the row; a double click sets its default. */
static Status obey_setting_press(Player *player, int index, int clicks)
{
    Mouse *mouse = &player->input.mouse;
    if (index >=
        player->screen.frame.option_count) /* the last item is "+ more" */
        return obey(player, COMMAND_OPTIONS, 0);
    player->input.selected_option = player->screen.frame.option[index];
    player->screen.must_redraw = true;
    if (clicks == 2)
        return obey(player, COMMAND_DEFAULT,
                    player->input.selected_option - option_rows);
    mouse->drag_command = COMMAND_SET;
    mouse->dragged_index = index;
    mouse->drag_options = player_get_shown_options(player);
    return STATUS_OK;
}

static Status obey_left_press(Player *player, const MouseTarget *target,
                              int clicks)
{
    int index = target->hit.index;
    bool ground =
        target->pick.kind == PICK_NONE || target->pick.kind == PICK_SPRING;
    const ListRow *row = player->screen.frame.content.list.row;
    const Scene *scene = player_get_simulation(player)->scene;
    bool body = (scene->traits & HAS_BODY) && !scene->step;
    Status status = STATUS_OK;
    player_deselect(player);
    switch (target->hit.zone) {
    case ZONE_CHIP:
        return obey(player, player->screen.frame.chip_command[index], 0);
    case ZONE_CARD_CLOSE:
        return obey(player, COMMAND_CARD, index);
    case ZONE_CARD:
        return obey(player, COMMAND_ENLARGE, index);
    case ZONE_TIME_LINE: /* a click or drag shows the step under the mouse */
        player->input.mouse.drag_command = COMMAND_GOTO;
        player->input.mouse.has_moved = true;
        return continue_drag(player);
    case ZONE_SETTING:
        return obey_setting_press(player, index, clicks);
    case ZONE_LIST_CLOSE:
        return obey(player, COMMAND_ESCAPE, 0);
    case ZONE_LIST:
        index =
            frame_find_list_row(&player->screen.frame.content, &target->layout,
                                player->input.mouse.x, player->input.mouse.y);
        if (find_key_scope(player) != SCOPE_LIST || index < 0 ||
            row[index].target_index < 0)
            return STATUS_OK;
        return player->screen.column == COLUMN_OPTIONS
                   ? obey(player, COMMAND_ADD, row[index].target_index)
                   : open_page(player,
                               lecture_pages[row[index].target_index].name);
    case ZONE_CELL:
        player->screen.view.selected_cell = index;
        return obey(player, COMMAND_OPEN, 0);
    case ZONE_STAGE:
        if (target->pane != player->active_pane)
            status = obey(player, COMMAND_PANE, target->pane);
        if (status || clicks < 2 || !ground)
            return status ? status : begin_press(player, target);
        return body && target->pick.nearest_node < 0 &&
                       target->pick.kind == PICK_NONE
                   ? add_ball(player, target->point)
                   : obey(player, COMMAND_FIT, 0);
    default:
        return STATUS_OK;
    }
}

static Status obey_press(Player *player, const Input *input)
{
    Mouse *mouse = &player->input.mouse;
    MouseTarget target = find_mouse_target(player);
    const Scene *scene = player_get_simulation(player)->scene;
    bool nodes = (scene->traits & HAS_MESH) && !scene->step;
    int near = target.pick.nearest_node;
    mouse->drag_start[0] = mouse->x;
    mouse->drag_start[1] = mouse->y;
    mouse->has_moved = false;
    player->note[0] = '\0';
    if (input->button == BUTTON_LEFT)
        return obey_left_press(player, &target, input->clicks);
    if (target.hit.zone != ZONE_STAGE)
        return STATUS_OK;
    if (input->button == BUTTON_RIGHT && near < 0 && nodes)
        return player_refuse(player, "no node is here: a right click on one "
                                     "pins it, or sets it free");
    if (input->button == BUTTON_RIGHT)
        return obey(player, COMMAND_PIN, near < 0 ? 0 : near);
    mouse->drag_command = COMMAND_PAN;
    mouse->has_moved = true;
    return STATUS_OK;
}

/* Ends a drag or a click.  A click on a choice in the row takes the next value;
 * a click on a node explains drags and right clicks. */
static Status end_press(Player *player)
{
    Mouse *mouse = &player->input.mouse;
    const Simulation *simulation = player_get_simulation(player);
    CommandKind drag = mouse->drag_command;
    int node = mouse->dragged_index;
    mouse->drag_command = COMMAND_NONE;
    player->screen.view.drag_bounds.is_dragging = false;
    if (!mouse->has_moved && (drag == COMMAND_GRAB || drag == COMMAND_PLACE) &&
        node < simulation->mesh.nodes)
        player_notify(player, "a drag moves node %d, a right click %s it", node,
                      simulation->system.is_pinned[node] ? "frees" : "pins");
    if ((drag == COMMAND_OBSTACLE || drag == COMMAND_GRAB) &&
        player->input.is_holding) {
        Command next = {.kind = COMMAND_RELEASE, .joins_gesture = true};
        player_enqueue(player, &next);
        next = (Command){
            .kind = COMMAND_PIN, .number = node, .joins_gesture = true};
        if (drag == COMMAND_GRAB && mouse->repins_node)
            player_enqueue(player, &next);
        return player_show_refusal(player, player_obey_queue(player, false));
    }
    if (drag == COMMAND_SET &&
        mouse->has_moved) /* a click keeps the selection */
        player_deselect(player);
    if (drag == COMMAND_SET && !mouse->has_moved && mouse->dragged_index >= 0 &&
        player->input.selected_option &&
        player->input.selected_option->kind == OPTION_NAME)
        return change_number(player, player->input.selected_option, 1);
    return STATUS_OK;
}

static Status obey_wheel_turn(Player *player, double amount)
{
    MouseTarget target = find_mouse_target(player);
    if (target.hit.zone == ZONE_SETTING &&
        target.hit.index < player->screen.frame.option_count)
        return change_number(player,
                             player->screen.frame.option[target.hit.index],
                             amount > 0 ? 1 : -1);
    if (target.hit.zone == ZONE_TIME_LINE)
        return obey(player, amount > 0 ? COMMAND_BACK : COMMAND_NEXT, 0);
    if (target.hit.zone != ZONE_STAGE)
        return STATUS_OK;
    lens_zoom(&player->screen.view.lens, target.layout.pane[target.hit.index],
              player->input.mouse.x, player->input.mouse.y,
              pow(WHEEL_ZOOM, amount));
    player->screen.must_redraw = true;
    return STATUS_OK;
}

static Status obey_mouse_input(Player *player, const Input *input)
{
    Mouse *mouse = &player->input.mouse;
    bool rests =
        !mouse->has_position || (mouse->x == input->x && mouse->y == input->y);
    mouse->x = input->x;
    mouse->y = input->y;
    mouse->has_position = true;
    if (input->kind == INPUT_PRESS)
        return obey_press(player, input);
    if (input->kind == INPUT_RELEASE)
        return end_press(player);
    if (input->kind == INPUT_WHEEL)
        return obey_wheel_turn(player, input->wheel_notches);
    if (mouse->drag_command != COMMAND_NONE)
        return continue_drag(player);
    return rests ? STATUS_OK : store_hovered_object(player);
}

/* A key, a drag, and successive turns of the wheel are one gesture each. */
Status player_obey_input(Player *player, const Input *input)
{
    Mouse *mouse = &player->input.mouse;
    Command command;
    bool wheel = input->kind == INPUT_WHEEL, press = input->kind == INPUT_PRESS;
    Status status = STATUS_OK;
    player->commands.gesture_id = mouse->input_gesture_id;
    if (press && mouse->drag_command != COMMAND_NONE)
        status = end_press(player); /* a second button ends the drag */
    if (!status)
        status = player_show_refusal(
            player,
            player_obey_queue(player, press && player->input.is_holding));
    if (status)
        return status;
    bool key = input->kind == INPUT_KEY && !input->is_repeat &&
               mouse->drag_command == COMMAND_NONE;
    if (press || key || (wheel && !mouse->was_wheel_turn))
        mouse->input_gesture_id = ++player->commands.gesture_count;
    mouse->was_wheel_turn = wheel;
    player->commands.gesture_id = mouse->input_gesture_id;
    switch (input->kind) {
    case INPUT_KEY:
        command = command_from_key(input->key, input->is_repeat,
                                   find_key_scope(player));
        command.joins_gesture = true;
        if (command.kind == COMMAND_SCENE &&
            player_get_active_options(player)->page) {
            player_notify(player, "no number is asked for; G shows the scenes");
            return STATUS_OK;
        }
        if (command.kind)
            status = player_obey(player, &command);
        return !status && command.kind == COMMAND_ENTER
                   ? accept_typed_text(player)
                   : status;
    case INPUT_CLOSE:
        return obey(player, COMMAND_QUIT, 0);
    case INPUT_LEAVE:
        player->screen.view.hovered_part = (Pick){.kind = PICK_NONE};
        player->screen.view.mouse_hit = (WindowHit){.zone = ZONE_NONE};
        /* fall through */
    case INPUT_REDRAW:
        player->screen.must_redraw = true;
        return STATUS_OK;
    default:
        return obey_mouse_input(player, input);
    }
}
