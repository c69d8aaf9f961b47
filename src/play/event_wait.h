/* event_wait.h - sleeping until somebody touches the window.
 */
#ifndef ELASTO_EVENT_WAIT_H
#define ELASTO_EVENT_WAIT_H

struct SDL_Window;

/* Returns when an event waits, a signal came, or after this many milliseconds;
 * the events stay in their queue. */
void event_wait(struct SDL_Window *window, int milliseconds);

/* From now on `lost` is called when the window's server is gone; it must not
 * return.  NULL, NULL: there is no window any more. */
void event_guard(struct SDL_Window *window, void (*lost)(void));

/* Breaks the connection to the guarded window's server, which ends every wait
 * for its answer: then it is gone.  May be called in a signal's handler. */
void event_let_go(void);

#endif
