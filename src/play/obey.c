/* obey.c - obeys a command and those in the queue, and does the work that they
 * ask for; writes the journal. */
#include <limits.h>
#include <string.h>

#include "base/clock.h"
#include "picture/picture.h"
#include "play/playing.h"

static CommandFunction *const functions[COMMAND_KIND_COUNT] = {
#define ROW(kind, function, ...) [COMMAND_##kind] = function,
#include "play/command_rows.def"
#undef ROW
};

long player_count_targets(const Player *player, int pane, CommandKind kind)
{
    const Simulation *simulation = &player->past.pane[pane].simulation;
    const Scene *scene = simulation->scene;
    double at[SCENE_MAX_HANDLES][2];
    SceneSwitch part[SCENE_MAX_SWITCHES];
    bool cells = scene->picture == PICTURE_ENVELOPE;
    switch (kind) {
    case COMMAND_PIN:
    case COMMAND_GRAB:
    case COMMAND_PLACE:
        return simulation->system.nodes;
    case COMMAND_HANDLE:
        return exhibit_list_handles(simulation, at);
    case COMMAND_FLIP:
        return exhibit_list_switches(simulation, part);
    case COMMAND_OBSTACLE:
    case COMMAND_PUSH:
        return (long)(simulation->options.grounds + simulation->options.balls);
    case COMMAND_PANE:
        return past_count_panes(&player->past);
    case COMMAND_CARD:
    case COMMAND_ENLARGE:
        return picture_of_scene(scene)->card_count;
    case COMMAND_CELL:
        return cells ? (long)ENVELOPE_ROWS * ENVELOPE_COLUMNS : 0;
    default:
        return LONG_MAX;
    }
}

/* Refuses a number if a pane has no such node, obstacle, ... */
static Status check_command_target(Player *player, const Command *command)
{
    for (int p = 0; p < past_count_panes(&player->past); p++) {
        long count = player_count_targets(player, p, command->kind);
        if (command->number >= count)
            return player_refuse(
                player,
                count > 0 ? "%s: there is no number %ld; they are 0 to %ld"
                          : "%s: this scene has none",
                command_rows[command->kind].name, command->number, count - 1);
    }
    return STATUS_OK;
}

/* Returns the script command that does what the key does now. */
static Command resolve_key_command(const Player *player, const Command *asked)
{
    const double *x = player_get_simulation(player)->run[0].x;
    Command meant = *asked;
    if (asked->kind == COMMAND_TOGGLE_PAUSE)
        meant.kind = player_is_stopped(player) ? COMMAND_PLAY : COMMAND_PAUSE;
    if (asked->kind == COMMAND_NEXT && !player_hides_answer(player) &&
        player_get_active_options(player)->next_action == NEXT_SHORTENS_SPRING)
        meant =
            (Command){.kind = COMMAND_HANDLE, .x = 0.8 * x[0], .y = 0.8 * x[1]};
    return meant;
}

/* Stores the change by a page's command in the page's own options. */
static void store_page_option(Player *player, const Command *command)
{
    Options *own = &player->tour.page_options[player->active_pane];
    if (command->kind == COMMAND_FLIP)
        own->flips = exhibit_get_flip_bits(player_get_simulation(player));
    if (command->kind == COMMAND_SET)
        option_copy_value(&option_rows[command->number],
                          player_get_active_options(player), own);
}

Status player_obey_queue(Player *player, bool now)
{
    const Past *past = &player->past;
    CommandQueue queue = player->commands.queue;
    const bool obeys_page = player->tour.is_page_running;
    Status status = STATUS_OK;
    int i = 0;
    player->commands.queue = (CommandQueue){.count = 0};
    for (; i < queue.count && !status; i++) {
        const Command *command = &queue.command[i];
        bool pulls = command->kind == COMMAND_RELEASE &&
                     !player_is_stopped(player) &&
                     past->shown_step <= player->input.last_pull_step;
        if (!now && (past_is_working(past) || pulls))
            break;
        player->tour.is_page_running = obeys_page || queue.is_from_page;
        status = player_obey(player, command);
        if (player->tour.is_page_running && !status)
            store_page_option(player, command);
        player->tour.is_page_running = obeys_page;
    }
    if (!status && i == queue.count) {
        status = player_restore_pins(player, queue.pins);
        if (queue.end_note[0])
            player_notify(player, "%s", queue.end_note);
        return status;
    }
    if (status) {
        control_release(queue.pins);
        return status;
    }
    queue.count -= i;
    memmove(queue.command, queue.command + i,
            (size_t)queue.count * sizeof *queue.command);
    player->commands.queue = queue;
    return STATUS_OK;
}

/* Whether this command waits until the step being made has ended. */
static bool command_waits_for_goal(const Past *past, CommandKind kind)
{
    return past_makes_step(past) &&
           (kind == COMMAND_PAUSE || kind == COMMAND_PLAY);
}

/* Abandons the step being made, and obeys the commands that waited for it.
 * Pause and play at the end of the journal become due at the shown step. */
static Status abandon_unfinished_step(Player *player)
{
    int gesture = player->commands.gesture_id;
    const Script *done = &player->commands.journal;
    for (size_t i = done->lines;
         i-- > 0 && done->line[i].due_step == player->past.shown_step + 1 &&
         command_waits_for_goal(&player->past, done->line[i].command.kind);)
        done->line[i].due_step--;
    past_set_goal(&player->past, player->past.shown_step, false);
    player->play.after_work = AFTER_NOTHING;
    Status status =
        player_show_refusal(player, player_obey_queue(player, true));
    player->commands.gesture_id = gesture;
    return status;
}

/* Begins a gesture, which is undone as a whole, unless the command joins one; a
 * drag joins its grab.  Clears the messages of the last command. */
static void begin_command(Player *player, const Command *command)
{
    unsigned flags = command_rows[command->kind].flags;
    Commands *commands = &player->commands;
    if (command->kind == COMMAND_DRAG || command->kind == COMMAND_RELEASE)
        commands->gesture_id = commands->drag_gesture_id;
    else if (!command->joins_gesture)
        commands->gesture_id = ++commands->gesture_count;
    if (command->kind == COMMAND_GRAB || command->kind == COMMAND_PUSH)
        commands->drag_gesture_id = commands->gesture_id;
    if (commands->quit_command != command->kind)
        commands->quit_command = COMMAND_NONE;
    player->screen.must_redraw = true;
    player->message[0] = '\0';
    if (!(flags & KEEPS_NOTE ||
          (flags & REPLACES_SAME && player->input.mouse.drag_command)))
        player->note[0] = '\0';
}

/* Whether the present work replaces a command: "next" is ignored until a step
 * is loaded or made; a drag during a new step is put into the queue. */
static bool work_replaces_command(Player *player, const Command *command)
{
    bool drags =
        player->input.mouse.drag_command || command->kind == COMMAND_DRAG;
    if (past_is_working(&player->past) && command->kind == COMMAND_NEXT)
        return true;
    if (!past_makes_step(&player->past) || !drags ||
        !(command_rows[command->kind].flags & REPLACES_SAME))
        return false;
    player_enqueue(player, command);
    return true;
}

/* Iterates until the chosen step is shown; in a window at most for SLICE. */
static Status do_work(Player *player)
{
    Past *past = &player->past;
    double begin = clock_now();
    if (player->play.work_start_time == 0)
        player->play.work_start_time = begin;
    player_sample_line_energy(player);
    while (past_is_working(past) && !player->is_quitting) {
        long before = past->shown_step;
        bool made = past_makes_step(past);
        Status status = past_continue_work(past);
        if (!past_is_working(past) || (status && status != STATUS_RUNNING)) {
            status = player_finish_work(player, status, before, made);
            if (status)
                return status;
            player_sample_line_energy(player);
        }
        player->is_quitting = player->is_quitting || *player->setup.stop_signal;
        bool begins =
            past_makes_step(past) && !made && player_factorises_slowly(player);
        if (player->screen.window && (begins || clock_now() - begin > SLICE))
            break;
    }
    player->screen.must_redraw = true;
    if (!past_is_working(past))
        player->play.work_start_time = 0;
    return STATUS_OK;
}

Status player_obey(Player *player, const Command *command)
{
    Past *past = &player->past;
    Command meant = resolve_key_command(player, command);
    const unsigned flags = command_rows[meant.kind].flags;
    long step = past->shown_step, newest = past_find_newest(past);
    int now = past->branch_index;
    bool stops = false;
    Status status = STATUS_OK;
    begin_command(player, &meant);
    if (work_replaces_command(player, &meant))
        return STATUS_OK;
    if (player_hides_answer(player) &&
        (meant.kind == COMMAND_NEXT || meant.kind == COMMAND_PLAY)) {
        status = player_reveal_answer(player, NULL); /* no step is made yet */
        return status ? status : player_obey_queue(player, false);
    }
    if (past_is_working(past) && !(flags & KEEPS_STEP)) {
        stops = meant.kind == COMMAND_ESCAPE;
        status = abandon_unfinished_step(player);
    }
    status = status ? status : check_command_target(player, &meant);
    if (!status && stops)
        player_notify(player, "step abandoned: the last whole one is shown");
    else if (!status)
        status = functions[meant.kind](player, &meant);
    if (flags & IN_SCRIPT && status != STATUS_INVALID_INPUT &&
        script_add(&player->commands.journal,
                   step + command_waits_for_goal(past, meant.kind), &meant,
                   player->commands.gesture_id))
        return STATUS_OUT_OF_MEMORY;
    bool worked = past_is_working(past);
    player_sample_line_energy(player); /* a card may need the samples now */
    if (past_is_working(past) && (!worked || !(flags & KEEPS_STEP))) {
        Status shown = do_work(player);
        status = status ? status : shown;
    }
    if (past->branch_index > now && meant.kind != COMMAND_REDO &&
        !past->branch[past->branch_index].begins_runs && step < newest)
        append(player->note, sizeof player->note,
               "%ssteps %ld ... %ld: Ctrl+Z leads back",
               player->note[0] ? "; " : "", step + 1, newest);
    status = player_pause_after_failure(player, status);
    return status ? status : player_obey_queue(player, false);
}

Status player_make_step(Player *player)
{
    const Past *past = &player->past;
    Status status =
        past_is_working(past)
            ? STATUS_OK
            : player_seek(player, past->shown_step + 1, AFTER_NOTHING);
    status = status ? status : do_work(player);
    return status
               ? status
               : player_show_refusal(player, player_obey_queue(player, false));
}
