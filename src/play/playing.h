/* playing.h - functions that the sources of play share, by file from below: a
 * file calls only files before it.
 */
#ifndef ELASTO_PLAYING_H
#define ELASTO_PLAYING_H

#include "play/player.h"
#include "lesson/command_line.h"
#include "run/message.h"

/* Functions of commands have the same arguments, used or not. */
#pragma GCC diagnostic ignored "-Wunused-parameter"

/* Time of a frame for steps, s; then inputs are read. */
static const double SLICE = 0.05;

/* ---- session.c ----------------------------------------------------------- */

/* Machine, simulation and options of the active pane. */
const Machine *player_machine(const Player *player);
const Simulation *player_simulation(const Player *player);
const Options *player_settings(const Player *player);

/* Options of the active pane with the time step of its simulation, which a
 * scene may change by itself. */
Options player_numbers(const Player *player);

/* Finds the options of a scene or, if it is not NULL, of a page: those of the
 * command line if it named that scene, else the defaults.
 *   count  out, number of panes */
Status player_default_options(Player *player, const char *scene,
                              const LecturePage *page, Options *options,
                              int *count);

/* Whether the panes have different values of this option. */
bool player_panes_differ(const Player *player, const OptionRow *row);

/* Whether the run makes steps only after a command. */
bool player_is_stopped(const Player *player);

/* Whether a single factorisation takes longer than a slice. */
bool player_is_slow(const Player *player);

/* Index of the pane in which E along p is drawn, or -1. */
int player_line_pane(const Player *player);

/* Keeps E along p from now on if it is drawn, and makes the shown step once
 * more if it was not kept; player_work follows. */
void player_complete_line(Player *player);

/* Whether a step will be made with the present place of the hand, but was not
 * yet. */
bool player_pull_is_due(const Player *player);

/* Speed at the start, SPEED_LEAST ... SPEED_MOST: that of the options, else of
 * the scene if the run is attended, else a step a frame. */
int player_initial_speed(const Player *player, const Options *options);

/* Whether a list is open whose lines have numbers. */
bool player_has_list(const Player *player);

/* Deselects the number and closes the field. */
void player_deselect(Player *player);

/* Writes a value as the row of numbers shows it. */
void player_format_value(const OptionRow *row, const Options *options,
                         const Simulation *simulation, char *text, size_t size);

/* Shows a message below the picture. */
void player_note(Player *player, const char *format, ...);

/* Refuses a command with a formatted reason.  Returns INVALID_INPUT. */
#define player_refuse(player, ...)                                             \
    refuse((Message){(player)->message, sizeof(player)->message}, __VA_ARGS__)

/* Shows the reason of INVALID_INPUT as a message; returns any other status. */
Status player_report(Player *player, Status status);

/* Pauses the run. */
void player_pause(Player *player);

/* Pauses an attended run after a step that failed.  Returns OK, or the status
 * that ends the run. */
Status player_tolerate_failure(Player *player, Status status);

/* Returns the command that gives an option a value, in the present gesture. */
Command set_command(const OptionRow *row, double value);

/* Put commands into the queue: one; a new value of an option, which joins the
 * present gesture; lines of a script with a ; between them, or NULL, likewise.
 * A command of a drag replaces the same one before it. */
void player_enqueue(Player *player, const Command *command);
void player_enqueue_set(Player *player, const OptionRow *row, double value);
Status player_enqueue_lines(Player *player, const char *lines);

/* ---- steps.c ------------------------------------------------------------- */

/* Begins new runs with these options at step 0; tables begin again. */
Status player_begin_runs(Player *player, const Options *options, int count,
                         const Command *edit);

/* Edits panes from ... to - 1 as past_edit does. */
Status player_edit(Player *player, const Command *change, int from, int to,
                   bool again);

/* Iterates until the chosen step is shown, or the SLICE of a frame is over. */
Status player_work(Player *player);

/* Chooses the step to be shown, 0 ... newest + 1; player_work follows, after a
 * command by itself. */
Status player_seek(Player *player, long step, AfterWork after);

/* Edits panes from ... to - 1 and makes the present step once more with the
 * edit; the old outcome stays as a ghost in the active pane. */
Status player_repeat_step(Player *player, const Command *change, int from,
                          int to);

/* Removes ghosts and lines of the shown step. */
void player_forget_step(Player *player);

/* Writes the steps that the tables do not have yet. */
Status player_write_remaining(Player *player);

/* ---- start.c ------------------------------------------------------------- */

/* Begins new runs with the present pins.  The commands of a page that begins
 * again go into the queue. */
Status player_begin_again(Player *player, const Options *options, int panes,
                          const Command *edit);

/* Sets the pins of a control before new runs, and drops that control; or NULL.
 */
Status player_restore_pins(Player *player, const Control *before);

/* Puts the opening commands of the page into the queue. */
Status player_enqueue_page(Player *player);

/* Whether the page in the window waits for a guess. */
bool player_hides_answer(const Player *player);

/* Shows the answer of the page, judges the typed guess, or NULL, and puts the
 * page's commands for that into the queue. */
Status player_reveal(Player *player, const char *typed);

/* ---- numbers.c ----------------------------------------------------------- */

/* Finds the numbers in the row, or all numbers of the scene.  Returns their
 * count. */
int player_visible_options(const Player *player, bool all,
                           const OptionRow *found[OPTIONS_MAX_ROWS]);

/* Returns why a number has no effect now, or NULL. */
const char *player_idle_reason(const Player *player, const OptionRow *row);

/* Computes the value some paces above the present one. */
Status player_paced(Player *player, const OptionRow *row, int paces,
                    double *value);

/* ---- panes.c, bodies.c have deeds alone; sheet.c ------------------------- */

/* Makes steps of the scenes on the sheet for a slice of time, if it is open. */
void sheet_advance(Player *player);

/* Fill the contents of the open sheet; close it. */
void sheet_fill(const Player *player, FrameContent *content);
void sheet_close(Player *player);

/* ---- frame.c ------------------------------------------------------------- */

/* Fills player->screen.frame, and finds what is under a mouse that rests. */
void player_fill(Player *player);

/* Returns the paper in the present size, or NULL if nothing is drawn or memory
 * is missing. */
Paper *player_paper(Player *player);

/* Fills and draws the frame on a paper. */
void player_paint(Player *player, Paper *paper);

/* ---- screen.c, keepsakes.c; obey.c --------------------------------------- */

/* The function of a command.  Returns as player_obey. */
typedef Status Deed(Player *player, const Command *command);

#define ROW(kind, deed, ...) Deed deed;
#include "play/command_rows.def"
#undef ROW

/* Obeys the opening commands of the page; lines with a ; between them, or NULL,
 * as one gesture. */
Status player_obey_page(Player *player);
Status player_obey_lines(Player *player, const char *lines);

/* Shows the answer of the page beside the typed guess, or NULL. */
Status player_answer(Player *player, const char *typed);

/* Obeys the commands in the queue that need not wait.
 *   now  no command waits */
Status player_obey_waiting(Player *player, bool now);

/* Goes on with the work, and obeys the queue at its end. */
Status player_continue(Player *player);

#endif
