/* playing.h - what the sources of the player share. */
#ifndef ELASTO_PLAYING_H
#define ELASTO_PLAYING_H

#include "play/player.h"
#include "lesson/command_line.h"
#include "run/one_line.h"

/* All deeds are called alike, whether they need to know the command or not. */
#pragma GCC diagnostic ignored "-Wunused-parameter"

/* s, of a frame in which steps are made; then inputs are looked at. */
static const double SLICE = 0.05;

/* ---- obey.c: commands and their deeds ------------------------------------ */

#define ROW(kind, deed, ...) Deed deed;
#include "play/command_rows.def"
#undef ROW

/* Says why a command makes no sense here: a format, and what it needs.  Returns
 * INVALID_INPUT. */
#define player_refuse(player, ...)                                             \
    refuse((Refusal){(player)->message, sizeof(player)->message}, __VA_ARGS__)

/* INVALID_INPUT becomes a line below the picture; returns any other status. */
Status player_tell(Player *player, Status status);

/* Sets an option, which belongs to the command that is obeyed, or to what the
 * hand does: they are undone at once. */
Status player_ask_set(Player *player, const OptionRow *row, double value);

/* A line below the picture. */
void player_note(Player *player, const char *format, ...);

/* ---- what is asked often ------------------------------------------------- */

/* The pane whose numbers are shown: its machine, its simulation, its options;
 * and those with the numbers as they are, for a scene may change its time step
 * by itself. */
const Machine *player_machine(const Player *player);
const Simulation *player_simulation(const Player *player);
const Options *player_settings(const Player *player);
Options player_numbers(const Player *player);

/* Whether no step is made by itself. */
bool player_stands(const Player *player);

/* ---- steps.c ------------------------------------------------------------- */

/* New runs with these options, from step 0; files begin anew. */
Status player_begin(Player *player, const Options *options, int count,
                    const Command *edit);

/* A change from here on in panes from ... to - 1; again: the step that is shown
 * is to be made once more with it. */
Status player_change(Player *player, const Command *change, int from, int to,
                     bool again);

/* Iterates until the step that is wanted is shown, or the slice of time of a
 * frame is over. */
Status player_work(Player *player);

/* Whether no step was made yet with where the hand is, and one will be. */
bool player_pulls(const Player *player);

/* Whether a single factor takes longer than a slice. */
bool player_is_slow(const Player *player);

/* Wants a step shown, the newest one or one before it, or the next new one.
 * player_work follows, after a deed by itself. */
Status player_show(Player *player, long step, Then then);

/* A change in panes from ... to - 1, and the present step once more with it,
 * from its own start; what it was before stays as a ghost of the active pane.
 */
Status player_retake(Player *player, const Command *change, int from, int to);

/* Somebody has asked for a pause. */
void player_stop(Player *player);

/* What goes whenever another step is shown. */
void player_leave_step(Player *player);

/* Where somebody attends, a step that failed is only shown.  Returns OK, or the
 * status of what ends the run. */
Status player_bear(Player *player, Status status);

/* What tables still lack of the past that is shown. */
Status player_write_rest(Player *player);

/* ---- change.c ------------------------------------------------------------ */

/* The options of a scene or, where it has one, of a page: those of the command
 * line where it was called for, else its own.  count out: of panes. */
Status player_own_options(Player *player, const char *scene,
                          const LecturePage *page, Options *options,
                          int *count);

/* Whether the page in the window waits for a guess; what it asks for is shown
 * from now on, beside the number that was typed, or NULL. */
bool player_veils(const Player *player);
Status player_unveil(Player *player, const char *typed);

/* Commands with a ; between them, which are undone at once; NULL: none. */
Status player_obey_lines(Player *player, const char *lines);

/* Whether the panes have different values of this option. */
bool player_compares(const Player *player, const OptionRow *row);

/* The numbers of the row, those of the table and those that were added; or all
 * that the scene has.  Returns how many. */
int player_row(const Player *player, bool all,
               const OptionRow *found[OPTIONS_MOST]);

/* The number goes so many paces up. */
Status player_pace(Player *player, const OptionRow *row, int paces);

/* Why a number has no meaning now; NULL: it has one. */
const char *player_idle(const Player *player, const OptionRow *row);

/* ---- screen.c ------------------------------------------------------------ */

/* Speed as SPEED_LEAST ... SPEED_MOST: what the options say, or the scene where
 * somebody attends, else one step a frame through time, and iterations one at a
 * time. */
int player_first_speed(const Player *player, const Options *options);

/* The scenes on the sheet go on for a slice of time, where it is open. */
void player_live(Player *player);

/* What is drawn of it; it is closed. */
void player_fill_sheet(Player *player);
void player_close_sheet(Player *player);

/* ---- hands.c ------------------------------------------------------------- */

/* Without a number that is lit or typed. */
void player_deselect(Player *player);

/* What is under a mouse that rests, in the Show as it is filled now. */
void player_look_again(Player *player);

/* What the mouse holds it lets go. */
Status player_release(Player *player);

/* ---- fill.c -------------------------------------------------------------- */

/* Fills player->show. */
void player_fill(Player *player);

/* A value as the row of numbers shows it. */
void player_value(const OptionRow *row, const Options *options,
                  const Simulation *simulation, char *text, size_t size);

/* What is different in each pane, as its label. */
void player_label_panes(Player *player);

#endif
