/* playing.h - what the sources of the player share, by file, from below: a file
 * calls only those before it.
 */
#ifndef ELASTO_PLAYING_H
#define ELASTO_PLAYING_H

#include "play/player.h"
#include "lesson/command_line.h"
#include "run/one_line.h"

/* All deeds are called alike, whether they need to know the command or not. */
#pragma GCC diagnostic ignored "-Wunused-parameter"

/* s, of a frame in which steps are made; then inputs are looked at. */
static const double SLICE = 0.05;

/* ---- session.c ----------------------------------------------------------- */

/* Machine, simulation and options of the active pane. */
const Machine *player_machine(const Player *player);
const Simulation *player_simulation(const Player *player);
const Options *player_settings(const Player *player);

/* Options of the active pane with the time step of its simulation, which a
 * scene may change by itself. */
Options player_numbers(const Player *player);

/* The options of a scene or, where it has one, of a page: those of the command
 * line where it was called for, else its own.  count out: of panes. */
Status player_default_options(Player *player, const char *scene,
                              const LecturePage *page, Options *options,
                              int *count);

/* Whether the panes have different values of this option. */
bool player_panes_differ(const Player *player, const OptionRow *row);

/* Whether no step is made by itself. */
bool player_is_stopped(const Player *player);

/* Whether a single factor takes longer than a slice. */
bool player_is_slow(const Player *player);

/* The pane in which E along p is drawn, or -1. */
int player_line_pane(const Player *player);

/* Keeps E along p from now on where it is drawn; the step that is shown is made
 * once more where it was not kept. */
void player_complete_line(Player *player);

/* Whether no step was made yet with where the hand is, and one will be. */
bool player_pull_is_due(const Player *player);

/* Speed as SPEED_LEAST ... SPEED_MOST: what the options say, or the scene where
 * somebody attends, else one step a frame through time, and iterations one at a
 * time. */
int player_initial_speed(const Player *player, const Options *options);

/* Whether the page in the window waits for a guess. */
bool player_hides_answer(const Player *player);

/* Whether a list is open whose lines have numbers. */
bool player_has_list(const Player *player);

/* Without a number that is lit or typed. */
void player_deselect(Player *player);

/* A value as the row of numbers shows it. */
void player_format_value(const OptionRow *row, const Options *options,
                         const Simulation *simulation, char *text, size_t size);

/* A line below the picture. */
void player_note(Player *player, const char *format, ...);

/* Says why a command makes no sense here: a format, and what it needs.  Returns
 * INVALID_INPUT. */
#define player_refuse(player, ...)                                             \
    refuse((Refusal){(player)->message, sizeof(player)->message}, __VA_ARGS__)

/* INVALID_INPUT becomes a line below the picture; returns any other status. */
Status player_report(Player *player, Status status);

/* Somebody has asked for a pause. */
void player_pause(Player *player);

/* Where somebody attends, a step that failed is only shown.  Returns OK, or the
 * status of what ends the run. */
Status player_tolerate_failure(Player *player, Status status);

/* Commands for the queue: one; an option, undone together with the present
 * command; several with a ; between them, alike, NULL: none. */
void player_enqueue(Player *player, const Command *command);
void player_enqueue_set(Player *player, const OptionRow *row, double value);
Status player_enqueue_lines(Player *player, const char *lines);

/* ---- steps.c ------------------------------------------------------------- */

/* New runs with these options, from step 0; files begin anew. */
Status player_begin_runs(Player *player, const Options *options, int count,
                         const Command *edit);

/* A change from here on in panes from ... to - 1; again: the step that is shown
 * is to be made once more with it. */
Status player_edit(Player *player, const Command *change, int from, int to,
                   bool again);

/* Iterates until the step that is wanted is shown, or the slice of time of a
 * frame is over. */
Status player_work(Player *player);

/* Wants a step shown, the newest one or one before it, or the next new one.
 * player_work follows, after a deed by itself. */
Status player_seek(Player *player, long step, AfterWork after);

/* A change in panes from ... to - 1, and the present step once more with it,
 * from its own start; what it was before stays as a ghost of the active pane.
 */
Status player_repeat_step(Player *player, const Command *change, int from,
                          int to);

/* What goes whenever another step is shown. */
void player_forget_step(Player *player);

/* What tables still lack of the past that is shown. */
Status player_write_remaining(Player *player);

/* ---- start.c ------------------------------------------------------------- */

/* New runs with the present pins.  Where a page begins again its commands go
 * into the queue. */
Status player_begin_again(Player *player, const Options *options, int panes,
                          const Command *edit);

/* The pins that were there before new runs were begun; drops that control. */
Status player_restore_pins(Player *player, const Control *before);

/* What the page does when it opens goes into the queue. */
Status player_enqueue_page(Player *player);

/* What a page asks for is shown from now on, beside the number that was typed,
 * or NULL; the page's commands for that go into the queue. */
Status player_reveal(Player *player, const char *typed);

/* ---- numbers.c ----------------------------------------------------------- */

/* The numbers of the row, those of the table and those that were added; or all
 * that the scene has.  Returns how many. */
int player_visible_options(const Player *player, bool all,
                           const OptionRow *found[OPTIONS_MOST]);

/* Why a number has no meaning now; NULL: it has one. */
const char *player_idle_reason(const Player *player, const OptionRow *row);

/* The number so many paces up, into value. */
Status player_paced(Player *player, const OptionRow *row, int paces,
                    double *value);

/* ---- panes.c, bodies.c have deeds alone; sheet.c ------------------------- */

/* The scenes on the sheet go on for a slice of time, where it is open. */
void sheet_advance(Player *player);

/* What is drawn of the open sheet; the sheet is closed. */
void sheet_fill(const Player *player, Show *show);
void sheet_close(Player *player);

/* ---- frame.c ------------------------------------------------------------- */

/* Fills player->screen.frame, and finds what is under a mouse that rests. */
void player_fill(Player *player);

/* The paper, in the size that it has now; NULL: nothing is drawn, or there is
 * not enough memory. */
Paper *player_paper(Player *player);

/* The frame on any paper, which nobody sees. */
void player_paint(Player *player, Paper *paper);

/* One card of that frame, over all of a paper of its own. */
void player_paint_card(Player *player, Paper *paper, int card);

/* ---- screen.c, keepsakes.c; obey.c --------------------------------------- */

/* What a command does.  Returns as player_obey. */
typedef Status Deed(Player *player, const Command *command);

#define ROW(kind, deed, ...) Deed deed;
#include "play/command_rows.def"
#undef ROW

/* What the page does when it opens; commands with a ; between them, which are
 * undone at once, NULL: none. */
Status player_obey_page(Player *player);
Status player_obey_lines(Player *player, const char *lines);

/* The commands that have waited until now; now: those that wait on, too. */
Status player_obey_waiting(Player *player, bool now);

/* Work that is under way, and then what has waited for its end. */
Status player_continue(Player *player);

#endif
