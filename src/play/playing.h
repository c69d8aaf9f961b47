/* playing.h - functions that files of play share, lowest layer first. */
#pragma once

#include "play/player.h"
#include "lesson/command_line.h"
#include "simulation/message.h"

/* The functions of commands have the same parameters; some use only one. */
#pragma GCC diagnostic ignored "-Wunused-parameter"

/* Time that a frame may spend on steps before inputs are read, s */
static const double SLICE = 0.05;

/* ---- session.c ----------------------------------------------------------- */

/* Three getters: the active pane, its simulation, its present options. */
const PastPane *player_get_active_pane(const Player *player);
const Simulation *player_get_simulation(const Player *player);
const Options *player_get_active_options(const Player *player);

/* Returns the options of the active pane, with the time step of its simulation,
 * which some scenes change by themselves. */
Options player_get_shown_options(const Player *player);

/* Whether the scene uses this option, and its value is a number or a choice. */
bool player_offers_option(const Player *player, const OptionRow *row);

/* Lists the options of the scene, or only the shown ones; returns the count. */
int player_list_options(const Player *player, bool all,
                        const OptionRow *found[OPTIONS_MAX_ROWS]);

/* Returns the page's own options of the first pane in which this option has
 * another value now, or NULL. */
const Options *player_find_page_options(const Player *player,
                                        const OptionRow *row);

/* Whether options or switches of the page were changed, or a handle moved. */
bool player_has_changed_page(const Player *player);

/* Finds the default options of a page or, if `page` is NULL, of a scene.  The
 * scene of the command line has the options given there.
 *   options  [OPTIONS_MAX_PANES] out, a page fills 1, a scene options->panes */
Status player_find_defaults(Player *player, const char *scene,
                            const LecturePage *page, Options *options);

/* Whether the panes have different values of this option. */
bool player_panes_differ(const Player *player, const OptionRow *row);

/* Whether steps are made only after commands. */
bool player_is_stopped(const Player *player);

/* Whether a factorisation of --solver newton takes longer than SLICE. */
bool player_factorises_slowly(const Player *player);

/* Lets E along p be sampled from now on if a card draws the curve.  Prepares to
 * make the shown step once more (player_obey) if its samples are missing. */
void player_sample_line_energy(Player *player);

/* Returns the first log_speed of a run: by --speed; else by the scene of an
 * attended run without page; else 0, or NEWTON_SPEED in scenes without time. */
int player_find_start_speed(const Player *player, const Options *options);

/* Whether the list of pages, the list of options, or the sheet is open. */
bool player_shows_list(const Player *player);
void player_deselect(Player *player);

/* Writes the value of an option as the row of numbers shows it. */
void player_format_value(const OptionRow *row, const Options *options,
                         const Simulation *simulation, char *text, size_t size);

/* Shows a message in the title bar, above the picture. */
void player_notify(Player *player, const char *format, ...);

/* Refuses a command, with a formatted reason.  Returns INVALID_INPUT. */
#define player_refuse(player, ...)                                             \
    refuse((Message){(player)->message, sizeof(player)->message}, __VA_ARGS__)

/* Turns INVALID_INPUT into a shown message and OK; returns other statuses. */
Status player_show_refusal(Player *player, Status status);

/* Pauses the run unless it has stopped already. */
void player_pause(Player *player);

/* Pauses an attended run after a failure.  Returns OK, or what ends the run. */
Status player_pause_after_failure(Player *player, Status status);

/* Returns the command that sets an option as a part of the present gesture.
 *   value  in, for OPTION_NAME the index of a name; -1 sets name 0 */
Command make_set_command(const OptionRow *row, double value);

/* Queues a command if there is room.  A drag's new place replaces its old. */
void player_enqueue(Player *player, const Command *command);
void player_enqueue_set(Player *player, const OptionRow *row, double value);

/* Puts lines of a script, separated by ;, into the queue; `lines` may be NULL.
 * Returns OK, INVALID_INPUT. */
Status player_enqueue_lines(Player *player, const char *lines);

/* ---- sheet.c ------------------------------------------------------------- */

/* Makes steps of the scenes on the sheet, for a part of the time of a frame. */
void sheet_advance_cells(Player *player);
void sheet_build_content(const Player *player, FrameContent *content);
void sheet_close(Player *player);

/* ---- steps.c ------------------------------------------------------------- */

/* Begins new runs with these options at step 0; the tables begin again.
 *   edit  in, command that begins the runs, for undo and redo */
Status player_begin_runs(Player *player, const Options *options, int count,
                         const Command *edit);

/* Edits a pane, or each one, at the shown step (past_edit). */
Status player_edit_step(Player *player, const Command *change, int pane,
                        bool again);

/* Records the step to which the work has led, then does what after_work asks.
 *   before  in, step that was shown before
 *   made    in, the step is a new one */
Status player_finish_work(Player *player, Status status, long before,
                          bool made);

/* Sets the step to show, clamped to 0 ... newest + 1.  player_obey then
 * works on it, in a window for at most SLICE, after which the next frames go on
 * (player_make_step).  After a command with KEEPS_STEP it does no work. */
Status player_seek(Player *player, long step, ActionAfterWork after);

/* Edits a pane, or each one.  player_obey then makes the shown step, or the
 * step that failed, once more.  The active pane keeps the shown step as a
 * ghost, unless the step failed or the edit begins a new run. */
Status player_repeat_step(Player *player, const Command *change, int pane);

/* Removes the ghosts, and shows the end of the step, no line of Algorithm 3. */
void player_reset_view(Player *player);

/* Writes the steps that the tables do not have yet. */
Status player_write_missing_rows(Player *player);

/* ---- start.c ------------------------------------------------------------- */

/* Begins new runs with the present pins; enqueues a page's opening commands. */
Status player_restart_runs(Player *player, const Options *options, int panes,
                           const Command *edit);

/* Pins and frees nodes as in an earlier control, if scene, page and mesh are
 * still the same; releases the earlier control.
 *   before  in, or NULL */
Status player_restore_pins(Player *player, const UserControl *before);

/* Puts the opening commands of the page into the queue. */
Status player_enqueue_page(Player *player);

/* Stores the options with which a page begins as the page's own. */
void player_store_page_options(Player *player, const Options *options);

/* Whether the page in the window waits for a guess. */
bool player_hides_answer(const Player *player);

/* Shows the answer of the page, judges the guess, enqueues the page's commands.
 *   typed  in, the guess, or NULL */
Status player_reveal_answer(Player *player, const char *typed);

/* ---- numbers.c ----------------------------------------------------------- */

/* Returns why a number has no effect now, or NULL. */
const char *player_find_idle_reason(const Player *player, const OptionRow *row);

/* Queues the command that changes a number by some notches of the wheel. */
Status player_enqueue_notches(Player *player, const OptionRow *row,
                              int notches);

/* ---- frame.c ------------------------------------------------------------- */

/* Fills player->screen.frame, and finds what is now under the mouse. */
void player_build_frame(Player *player);

/* Builds the frame if it must be drawn again: since the last drawing a command
 * may have discarded the step or the simulations that the frame shows. */
void player_update_frame(Player *player);

/* Returns the paper in the present size, and creates it if need be.  NULL: the
 * player does not draw, or memory is missing. */
Paper *player_prepare_paper(Player *player);

/* Fills the frame, and draws it on a paper. */
void player_paint_frame(Player *player, Paper *paper);

/* ---- sheet.c, steps.c to saves.c: functions of commands ------------------ */

/* A function that obeys a command.  Returns as player_obey. */
typedef Status CommandFunction(Player *player, const Command *command);

#define ROW(kind, function, ...) CommandFunction function;
#include "play/command_rows.def"
#undef ROW

/* ---- obey.c -------------------------------------------------------------- */

/* Returns how many targets (nodes, cards, ...) a command's number can name. */
long player_count_targets(const Player *player, int pane, CommandKind kind);

/* Obeys the queue until a command must wait: each command waits for the end of
 * the step being made, a release also for one step after the hand's last move.
 *   now  obeys all commands at once */
Status player_obey_queue(Player *player, bool now);
