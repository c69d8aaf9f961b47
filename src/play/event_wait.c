#include "play/event_wait.h"

#include <SDL.h>
#include <SDL_syswm.h>
#include <poll.h>
#include <stdbool.h>

/* The descriptor on which the window's events arrive; -1: not known. */
static int event_descriptor(SDL_Window *window)
{
#if defined SDL_VIDEO_DRIVER_X11
    SDL_SysWMinfo info;
    SDL_VERSION(&info.version);
    if (SDL_GetWindowWMInfo(window, &info) && info.subsystem == SDL_SYSWM_X11)
        return ConnectionNumber(info.info.x11.display);
#endif
    (void)window;
    return -1;
}

/* SDL_WaitEventTimeout would do, but on X it wakes itself up by an event of a
 * second connection: one that arrives when the window has been closed is an X
 * error, which ends the program. */
void event_wait(SDL_Window *window, int milliseconds)
{
    struct pollfd events = {.fd = event_descriptor(window), .events = POLLIN};
    if (events.fd < 0) {
        SDL_WaitEventTimeout(NULL, milliseconds);
        return;
    }
    SDL_PumpEvents(); /* what Xlib has read already is not to be waited for */
    if (!SDL_HasEvents(SDL_FIRSTEVENT, SDL_LASTEVENT))
        poll(&events, 1, milliseconds);
}
