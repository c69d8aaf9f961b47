/* playing.h - what player.c and obey.c share.
 */
#ifndef ELASTO_PLAYING_H
#define ELASTO_PLAYING_H

#include "play/player.h"

/* A new run with these options, from step 0; files begin anew. */
Status player_restart(Player *player, const Options *options);

/* The speed in the texts; it is measured anew from here. */
void player_reset_speed(Player *player);

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

/* Whether Escape ends the program: nothing else is open. */
bool player_escape_ends(const Player *player);

/* Shows another step. */
Status player_show(Player *player, long step);

#endif
