/* window.h - the program's one window, behind view.h: window_sdl.c on a
 * computer, window_web.c in a page.
 */
#ifndef ELASTO_WINDOW_H
#define ELASTO_WINDOW_H

#include "play/view.h"

/* As view_create_window; false: view_failure tells why there is none.  It is
 * closed in any case. */
bool window_open(const char *title, const int size[2], bool full);
void window_close(void);

void window_set_title(const char *title);
void window_set_full(bool full);
bool window_is_full(void);

/* size  [2] out, pixels of a paper that fills it */
void window_size(int size[2]);

/* Pixels of a small letter that can be read there. */
double window_letter(void);

/* Returns OK, OUT_OF_MEMORY, SCREEN_FAILED. */
Status window_show(const Canvas *canvas);

Input window_input(void);
void window_wait(int milliseconds);

#endif
