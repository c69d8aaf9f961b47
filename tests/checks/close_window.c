/* close_window.c - asks a window to close, like the cross in its corner:
 * close_window WINDOW. check_window.sh links libX11.so.6, whose headers may be
 * missing; therefore its functions are declared here. */
#include <stdlib.h>

typedef struct Display Display;

typedef union Event {
    struct {
        int type;
        unsigned long serial;
        int send_event;
        Display *display;
        unsigned long window, message_type;
        int format;
        long data[5];
    } client;
    long padding[24];
} Event;

Display *XOpenDisplay(const char *name);
unsigned long XInternAtom(Display *display, const char *name, int only);
int XSendEvent(Display *display, unsigned long window, int propagate, long mask,
               Event *event);
int XCloseDisplay(Display *display);

int main(int argc, char **argv)
{
    enum { CLIENT_MESSAGE = 33 };
    Display *display = XOpenDisplay(NULL);
    if (argc != 2 || !display)
        return 1;
    unsigned long window = strtoul(argv[1], NULL, 0);
    Event event = {
        .client = {.type = CLIENT_MESSAGE, .window = window, .format = 32}};
    event.client.message_type = XInternAtom(display, "WM_PROTOCOLS", 0);
    event.client.data[0] = (long)XInternAtom(display, "WM_DELETE_WINDOW", 0);
    int sent = XSendEvent(display, window, 0, 0, &event);
    XCloseDisplay(display);
    return !sent;
}
