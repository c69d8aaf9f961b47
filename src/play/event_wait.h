/* event_wait.h - sleeping until somebody touches the window.
 */
#ifndef ELASTO_EVENT_WAIT_H
#define ELASTO_EVENT_WAIT_H

struct SDL_Window;

/* Returns when an event waits, a signal came, or after this many milliseconds;
 * the events stay in their queue. */
void event_wait(struct SDL_Window *window, int milliseconds);

#endif
