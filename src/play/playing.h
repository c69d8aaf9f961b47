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

extern const Deed walk_deeds[], change_deeds[], pane_deeds[], hold_deeds[],
    begin_deeds[], keep_deeds[], lesson_deeds[], screen_deeds[];

/* The act of this kind; NULL: there is none. */
DeedFunction *player_deed(CommandKind kind);

/* Says why a command makes no sense here.  Returns INVALID_INPUT. */
Status player_refuse(Player *player, const char *why);

/* The settings of the lane whose numbers are shown. */
const Settings *player_settings(const Player *player);

/* The same options with the numbers as they are now: a scene may change its
 * time step by itself. */
Options player_numbers(const Player *player);

/* ---- walk.c ------------------------------------------------------------- */

/* Where E has risen beyond all proportion within a step that was taken by
 * itself, that is what is shown. */
void player_show_peaks(Player *player);

/* All lanes show their steps' ends again, no updates or lines. */
void player_leave_tapes(Player *player);

/* ---- glide.c ------------------------------------------------------------ */

/* From what is shown now, before another line is; only in a window. */
void glide_begin(Player *player);

/* The part of the way that is still to go: 1 ... 0; 0: it is over. */
double glide_rest(Player *player);

/* The positions there, [2n] m, the lane's own. */
const double *glide_between(Lane *lane, double rest);

/* ---- change.c ----------------------------------------------------------- */

/* A change from here on, in lanes from ... to - 1 or in all of them; it makes
 * no step again. */
Status player_change_lanes(Player *player, const Command *change, int from,
                           int to);
Status player_change_all(Player *player, const Command *change);

/* The present options of all lanes.  Returns how many. */
int player_options(const Player *player, Options options[OPTIONS_MAX_PANES]);

/* The next row of the table of integrators that all terms allow. */
const IntegratorMethod *player_next_method(const Simulation *simulation);

/* ---- retake.c ----------------------------------------------------------- */

/* A change with the present step taken again; what was changed since that step
 * is changed again after it.  Two outcomes with and without projection or line
 * search that no one picture can show are put beside each other.
 *   option, value, old  what changes, and from what
 *   from, to            in these lanes */
Status retake_step(Player *player, const Command *change, const char *option,
                   const char *value, const char *old, int from, int to);

/* ---- begin.c ------------------------------------------------------------ */

/* The options of a scene: those of the command line where it was called for,
 * else the scene's defaults.  count out: of panes. */
Status player_scene_options(Player *player, const char *name,
                            Options options[OPTIONS_MAX_PANES], int *count);

/* Whether new runs with these options can begin, of as many lanes as there are;
 * message says why not; and then they do. */
Status player_try_restart(Player *player, const Options *options);

/* ---- steps.c ------------------------------------------------------------ */

/* Simulations, states and energies at step 0. */
Status player_begin(Player *player, const Options *options, int count);

/* New runs with these options, from step 0; files begin anew. */
Status player_restart(Player *player, const Options *options, int count);

/* The observer of all lanes. */
bool player_watch(void *lane, const NewtonRecord *record);

/* What curves and trails keep of states not seen before. */
void player_sample(Player *player);

/* Pauses at the first step that did not converge, at the end, and at rest; a
 * run of a given number of steps ends by itself and does not. */
void player_pause_if_due(Player *player);

/* Shows another step. */
Status player_show(Player *player, long step);

/* The same, so that it can be walked through line by line. */
Status player_retape(Player *player, long step);

/* The next step: known, or new. */
Status player_go_on(Player *player);

/* What came after an old step is forgotten. */
Status player_forget_later(Player *player);

/* Says which steps were forgotten, beside what else was said. */
void player_tell_forgotten(Player *player);

/* ---- player.c ----------------------------------------------------------- */

/* The lane whose numbers are shown, and the simulation in it. */
Lane *player_lane(Player *player);
const Simulation *player_simulation(const Player *player);

/* s: that of the lane whose numbers are shown, or where it has ended that of
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

/* Back from there to the envelope. */
Status lesson_back_to_map(Player *player);

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

/* What is different in each lane, as its label. */
void player_label_lanes(Player *player);

/* The whole picture. */
void player_paint(Player *player, Paper *paper);

/* Whether the lanes have different values of this option. */
bool player_compares(const Player *player, const char *option);

#endif
