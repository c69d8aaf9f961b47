/* playing.h - what the sources of this room share.
 */
#ifndef ELASTO_PLAYING_H
#define ELASTO_PLAYING_H

#include "play/player.h"

/* ---- player.c ----------------------------------------------------------- */

/* New runs with these options, from step 0; files begin anew. */
Status player_restart(Player *player, const Options *options, int count);

/* The observer of all lanes. */
bool player_watch(void *lane, const NewtonRecord *record);

/* The lane whose numbers are shown, and the simulation in it. */
Lane *player_lane(Player *player);
const Simulation *player_simulation(const Player *player);

/* The speed in the texts; it is measured anew from here. */
void player_reset_speed(Player *player);
double player_rate(const Player *player); /* steps a second */

/* A line below the picture. */
void player_note(Player *player, const char *format, ...);

/* Of the window. */
void player_title(const Player *player, char *title, size_t size);

/* Steps, files and the like are those of the command line. */
void player_keep_files(const Player *player, Options *options);

/* Speed as SPEED_LEAST ... SPEED_MOST: what the options say, else one step a
 * frame through time, and iterations one at a time. */
int player_first_speed(const Options *options);

/* A page of the lecture: by name or number, the next or the one before. */
Status lesson_turn(Player *player, const Command *command);

/* What the page does when it opens: its own commands. */
Status lesson_prepare(Player *player);

/* A guess of where the next step leads, m. */
Status lesson_predict(Player *player, double x, double y);

/* Shows a cell of the envelope; loads it as a square of its own. */
Status lesson_visit(Player *player, long cell);
Status lesson_load(Player *player, long cell);

/* Whether a click on a place of this scene is a guess. */
bool lesson_asks(const Player *player);

/* Whether Escape ends the program: nothing else is open. */
bool player_escape_ends(const Player *player);

/* Shows another step. */
Status player_show(Player *player, long step);

/* The same, so that it can be walked through line by line. */
Status player_retape(Player *player, long step);

/* Going on from an old step: what came after it is forgotten. */
Status player_forget_later(Player *player);

/* ---- showing.c ---------------------------------------------------------- */

/* Fills player->show. */
void player_fill(Player *player);

/* The whole picture. */
void player_paint(Player *player, Paper *paper);

/* Whether the lanes have different values of this option. */
bool player_compares(const Player *player, const char *option);

#endif
