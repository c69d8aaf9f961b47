/* playing.h - what the sources of this room share.
 */
#ifndef ELASTO_PLAYING_H
#define ELASTO_PLAYING_H

#include "play/player.h"

/* ---- obey.c ------------------------------------------------------------- */

/* What commands of some kinds do; lists end with a row without an act. */
typedef Status DeedFunction(Player *player, const Command *command);
typedef struct Deed {
    CommandKind kind;
    DeedFunction *act;
} Deed;

extern const Deed walk_deeds[], change_deeds[], begin_deeds[], keep_deeds[],
    lesson_deeds[], screen_deeds[];

/* Says why a command makes no sense here.  Returns INVALID_INPUT. */
Status player_refuse(Player *player, const char *why);

/* The options of the pane whose numbers are shown. */
const Options *player_settings(const Player *player);

/* The same with the numbers as they are now: a scene may change its time step
 * by itself. */
Options player_numbers(const Player *player);

/* What belongs together and is undone at once: of the mouse or a key > 0, of a
 * command of a script < 0. */
int player_gesture(const Player *player);

/* Without a hand: another one begins, or that of the last grab goes on. */
void player_next_gesture(Player *player, CommandKind kind);

/* ---- walk.c ------------------------------------------------------------- */

/* What was wished for the step that is shown now. */
Status player_wish(Player *player, Then then);

/* All panes show their steps' ends again, no updates or lines. */
void player_leave_rounds(Player *player);

/* The part of the way to another line that is still to go: 1 ... 0; 0: it is
 * over.  The positions there, [2n] m, the side's own. */
double glide_rest(Player *player);
const double *glide_between(Player *player, int pane, double rest);

/* ---- change.c ----------------------------------------------------------- */

/* A change from here on, in panes from ... to - 1 or in all of them. */
Status player_change(Player *player, const Command *change, int from, int to);
Status player_change_all(Player *player, const Command *change);

/* The present options of all panes.  Returns how many. */
int player_options(const Player *player, Options options[OPTIONS_MAX_PANES]);

/* The next row of the table of integrators that all terms allow. */
const IntegratorMethod *player_next_method(const Simulation *simulation);

/* Tells what a step did before it was taken again and does now; unlike outcomes
 * are put beside each other. */
Status player_tell_retake(Player *player);

/* ---- begin.c ------------------------------------------------------------ */

/* The options of a scene: those of the command line where it was called for,
 * else the scene's defaults.  count out: of panes. */
Status player_scene_options(Player *player, const char *name,
                            Options options[OPTIONS_MAX_PANES], int *count);

/* ---- steps.c ------------------------------------------------------------ */

/* New runs with these options, from step 0; files begin anew. */
Status player_begin(Player *player, const Options *options, int count,
                    const Command *edit);

/* Iterates until the step that is wanted is shown, or the slice of time of a
 * frame is over. */
Status player_work(Player *player);

/* Shows another step, and waits there; again: with all that is told of its
 * iterations. */
Status player_show(Player *player, long step, bool again, Then then);

/* What goes whenever another step is shown. */
void player_leave_step(Player *player);

/* The next step, known or new. */
Status player_go_on(Player *player, Then then);

/* The past has another branch, which left the one before at this step. */
Status player_fork(Player *player, long step);

/* What curves and trails keep of states not seen before. */
void player_sample(Player *player);

/* Pauses at the first step that did not converge, at the end, and at rest; a
 * run of a given number of steps ends by itself and does not. */
void player_pause_if_due(Player *player);

/* What tables still lack of the past that is shown. */
Status player_write_rest(Player *player);

/* ---- player.c ----------------------------------------------------------- */

/* The machine of the pane whose numbers are shown, and its simulation. */
const Machine *player_machine(const Player *player);
const Simulation *player_simulation(const Player *player);

/* s: that of the pane whose numbers are shown, or where it has ended that of
 * one that goes on. */
double player_time(const Player *player);

/* The speed in the texts; it is measured anew from here. */
void player_reset_speed(Player *player);
double player_rate(const Player *player); /* steps a second */

/* Before a picture: of a step that was gone to, the cards shall know every
 * update: it is made once more, unless that is long work; while the time line
 * is dragged, only if it is short. */
void player_know_step(Player *player);

/* A line below the picture. */
void player_note(Player *player, const char *format, ...);

/* Of the window. */
void player_set_title(Player *player);

/* Speed as SPEED_LEAST ... SPEED_MOST: what the options say, else one step a
 * frame through time, and iterations one at a time. */
int player_first_speed(const Options *options);

/* What the page does when it opens: its own commands. */
Status lesson_prepare(Player *player);

/* Loads a cell of the envelope as a square of its own. */
Status lesson_load(Player *player, long cell);

/* Whether a click on a place of this scene is a guess. */
bool lesson_asks(const Player *player);

/* Whether Escape has anything to close; whether it ends the program: it was
 * pressed with nothing open, and is pressed again. */
bool player_is_open(const Player *player);
bool player_escape_ends(const Player *player);

/* Whether the window begins with a pause. */
bool player_explains(const Options *options);

/* Without a number that is selected or typed. */
void player_deselect(Player *player);

/* ---- showing.c ---------------------------------------------------------- */

/* Fills player->show. */
void player_fill(Player *player);

/* What is different in each pane, as its label. */
void player_label_panes(Player *player);

/* The whole picture. */
void player_paint(Player *player, Paper *paper);

/* Whether the panes have different values of this option. */
bool player_compares(const Player *player, const char *option);

#endif
