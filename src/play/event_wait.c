#include "play/event_wait.h"

#include <SDL.h>
#include <SDL_syswm.h>
#include <dlfcn.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static volatile sig_atomic_t guarded = -1; /* descriptor, -1: none */
static void (*when_lost)(void);

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

/* Xlib calls it when its server is gone, and ends the program if it returns. */
static int server_is_gone(void *display)
{
    (void)display;
    guarded = -1;
    SDL_SetError("the server of the screen is gone");
    when_lost();
    return 0;
}

void event_guard(SDL_Window *window, void (*lost)(void))
{
    typedef int Handler(void *display);
    Handler *(*set_handler)(Handler *) = NULL;
    guarded = window ? event_descriptor(window) : -1;
    void *xlib =
        guarded >= 0 ? dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD) : NULL;
    void *symbol = xlib ? dlsym(xlib, "XSetIOErrorHandler") : NULL;
    memcpy(&set_handler, &symbol, sizeof symbol);
    when_lost = lost;
    if (set_handler && lost)
        set_handler(server_is_gone);
}

void event_let_go(void)
{
    if (guarded >= 0)
        shutdown(guarded, SHUT_RDWR);
}
