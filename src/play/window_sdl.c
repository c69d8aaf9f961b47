/* window_sdl.c - the window on a computer, by SDL. */
#include <SDL.h>
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/window.h"

/* Default size of the window, and screen left for its borders (points). */
enum {
    WINDOW_WIDTH = 1280,
    WINDOW_HEIGHT = 800,
    BORDER_WIDTH = 10,
    BORDER_HEIGHT = 40
};

static SDL_Window *window;

/* Tab and mouse at the event that is read; SDL's own state is newer. */
static bool tab_alone; /* Tab is down, and no other key was pressed since */
static bool tab_held;
static SDL_Point mouse;

static const char *sdl_get_failure_reason(void)
{
    return SDL_GetError();
}

/* ---- opening and closing ------------------------------------------------- */

/* Starts SDL's video, without Wayland if XDG_RUNTIME_DIR is missing, since the
 * Wayland library would print an error.  Returns false without a screen. */
static bool sdl_init_video(void)
{
#ifdef __linux__
    if (!getenv("XDG_RUNTIME_DIR"))
        SDL_SetHint(SDL_HINT_VIDEODRIVER, "x11,KMSDRM");
#endif
    bool began = SDL_Init(SDL_INIT_VIDEO) == 0;
    const char *driver = began ? SDL_GetCurrentVideoDriver() : NULL;
    if (driver && strcmp(driver, "offscreen") && strcmp(driver, "dummy"))
        return true;
    SDL_SetError("SDL finds no display");
    return false;
}

static void sdl_set_full_screen(bool full)
{
    SDL_SetWindowFullscreen(window, full ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
}

static bool sdl_is_full_screen(void)
{
    return (SDL_GetWindowFlags(window) & SDL_WINDOW_FULLSCREEN_DESKTOP) != 0;
}

/* Opens the window, on X11 without acceleration: a frame of 900 x 900 pixels
 * takes 6 ms, with OpenGL computed by the processor 14 ms (measured). */
static bool sdl_open(const int size[2], bool full)
{
    SDL_Rect area = {0, 0, WINDOW_WIDTH, WINDOW_HEIGHT};
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
    SDL_SetHint(SDL_HINT_MOUSE_FOCUS_CLICKTHROUGH, "1");
    SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
    if (!sdl_init_video())
        return false;
    if (strcmp(SDL_GetCurrentVideoDriver(), "x11") == 0)
        SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    SDL_GetDisplayUsableBounds(0, &area);
    int width = SDL_min(WINDOW_WIDTH, area.w - BORDER_WIDTH);
    int height = SDL_min(WINDOW_HEIGHT, area.h - BORDER_HEIGHT);
    window = SDL_CreateWindow(
        "elasto", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
        size[0] > 0 ? size[0] : width, size[1] > 0 ? size[1] : height,
        SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
    if (!window || !SDL_GetWindowSurface(window))
        return false;
    if (full)
        sdl_set_full_screen(true);
    SDL_StartTextInput();
    return true;
}

static void sdl_close(void)
{
    if (window)
        SDL_DestroyWindow(window);
    window = NULL;
    SDL_Quit();
}

/* ---- output -------------------------------------------------------------- */

static void sdl_set_title(const char *title)
{
    SDL_SetWindowTitle(window, title);
}

static void sdl_find_size(int size[2])
{
    const SDL_Surface *surface = SDL_GetWindowSurface(window);
    size[0] = surface ? surface->w : 1;
    size[1] = surface ? surface->h : 1;
}

static void find_pixels_per_point(double scale[2])
{
    int size[2], points[2] = {0, 0};
    sdl_find_size(size);
    SDL_GetWindowSize(window, &points[0], &points[1]);
    for (int i = 0; i < 2; i++)
        scale[i] = points[i] > 0 ? (double)size[i] / points[i] : 1;
}

static double sdl_find_font_size(void)
{
    double scale[2];
    find_pixels_per_point(scale);
    return 9 * scale[0];
}

static Status sdl_show(const Canvas *canvas)
{
    SDL_Surface *surface = SDL_GetWindowSurface(window);
    SDL_Surface *picture = SDL_CreateRGBSurfaceWithFormatFrom(
        canvas->pixels, canvas->width, canvas->height, 32,
        canvas->width * (int)sizeof *canvas->pixels, SDL_PIXELFORMAT_RGB888);
    bool shown = surface && picture &&
                 SDL_UpperBlit(picture, NULL, surface, NULL) == 0 &&
                 SDL_UpdateWindowSurface(window) == 0;
    SDL_FreeSurface(picture);
    return shown ? STATUS_OK : STATUS_SCREEN_FAILED;
}

/* ---- keys ---------------------------------------------------------------- */

/* Reads a key with "Ctrl+", "Shift+", "Tab+" before its name.  Signs and digits
 * are read from text events, for every keyboard layout.  Tab is read at its
 * release, unless another key was pressed with Tab. */
static void read_key_event(const SDL_KeyboardEvent *event, Input *input)
{
    SDL_Keycode key = event->keysym.sym;
    SDL_Scancode place = event->keysym.scancode;
    if (key >= 128 && !(key & SDLK_SCANCODE_MASK) && /* non-Latin letter */
        place >= SDL_SCANCODE_A && place <= SDL_SCANCODE_Z)
        key = SDLK_a + (SDL_Keycode)(place - SDL_SCANCODE_A);
    SDL_Keymod mod = (SDL_Keymod)event->keysym.mod;
    bool letter = key >= SDLK_a && key <= SDLK_z;
    bool typed = key > SDLK_SPACE && key < SDLK_DELETE && !letter;
    bool down = event->state == SDL_PRESSED, is_tab = key == SDLK_TAB;
    bool is_command = is_tab ? tab_alone && !down : down;
    if (is_tab)
        tab_held = down;
    if ((mod & (KMOD_ALT | KMOD_GUI)) || (typed && !(mod & KMOD_CTRL)) ||
        (place >= SDL_SCANCODE_LCTRL && place <= SDL_SCANCODE_RGUI))
        return;
    if (down || is_tab)
        tab_alone = down && is_tab;
    if (!is_command)
        return;
    input->kind = INPUT_KEY;
    input->is_repeat = event->repeat != 0;
    snprintf(input->key, sizeof input->key, "%s%s%s%s",
             mod & KMOD_CTRL ? "Ctrl+" : "", mod & KMOD_SHIFT ? "Shift+" : "",
             tab_held ? "Tab+" : "", SDL_GetKeyName(key));
}

/* ---- mouse and window ---------------------------------------------------- */

/* Translates an event of the window.  When the window loses the keyboard focus
 * a drag ends, since another window may get the release of the button. */
static InputKind read_window_event(const SDL_WindowEvent *event)
{
    switch (event->event) {
    case SDL_WINDOWEVENT_CLOSE:
        return INPUT_CLOSE;
    case SDL_WINDOWEVENT_LEAVE:
        return INPUT_LEAVE;
    case SDL_WINDOWEVENT_FOCUS_LOST:
        return INPUT_RELEASE;
    case SDL_WINDOWEVENT_EXPOSED:
    case SDL_WINDOWEVENT_SHOWN:
    case SDL_WINDOWEVENT_RESTORED:
    case SDL_WINDOWEVENT_SIZE_CHANGED:
        return INPUT_REDRAW;
    default:
        return INPUT_NONE;
    }
}

static Input read_event(const SDL_Event *event)
{
    Input input = {.kind = INPUT_NONE};
    const char *text = event->text.text;
    bool press = event->type == SDL_MOUSEBUTTONDOWN;
    int button = event->button.button;
    double scale[2];
    if (event->type == SDL_QUIT) {
        input.kind = INPUT_CLOSE;
    } else if (event->type == SDL_KEYDOWN || event->type == SDL_KEYUP) {
        read_key_event(&event->key, &input);
    } else if (event->type == SDL_TEXTINPUT &&
               isgraph((unsigned char)text[0]) &&
               !isalpha((unsigned char)text[0]) && text[1] == '\0') {
        input.kind = INPUT_KEY; /* the key of a sign or a digit */
        snprintf(input.key, sizeof input.key, "%s", text);
    } else if (event->type == SDL_WINDOWEVENT) {
        input.kind = read_window_event(&event->window);
    } else if (event->type == SDL_MOUSEMOTION) {
        input.kind = INPUT_MOVE;
        mouse = (SDL_Point){event->motion.x, event->motion.y};
    } else if (press || event->type == SDL_MOUSEBUTTONUP) {
        mouse = (SDL_Point){event->button.x, event->button.y};
        input.kind = press ? INPUT_PRESS : INPUT_RELEASE;
        input.button = button == SDL_BUTTON_LEFT    ? BUTTON_LEFT
                       : button == SDL_BUTTON_RIGHT ? BUTTON_RIGHT
                                                    : BUTTON_MIDDLE;
        input.clicks = event->button.clicks;
    } else if (event->type == SDL_MOUSEWHEEL) {
        bool flipped = event->wheel.direction == SDL_MOUSEWHEEL_FLIPPED;
        input.kind = INPUT_WHEEL;
        input.wheel_notches = (flipped ? -1 : 1) * event->wheel.preciseY;
    }
    find_pixels_per_point(scale);
    input.x = mouse.x * scale[0];
    input.y = mouse.y * scale[1];
    return input;
}

static Input sdl_read_input(void)
{
    SDL_Event event, next;
    Input input = {.kind = INPUT_NONE};
    while (window && input.kind == INPUT_NONE && SDL_PollEvent(&event))
        if (event.type != SDL_MOUSEMOTION ||
            SDL_PeepEvents(&next, 1, SDL_PEEKEVENT, SDL_FIRSTEVENT,
                           SDL_LASTEVENT) != 1 ||
            next.type != SDL_MOUSEMOTION)
            input = read_event(&event);
    return input;
}

/* Polls for events.  SDL_WaitEventTimeout would end the program after the
 * window is closed: SDL sends itself an event by a second connection to X. */
static void sdl_wait_for_input(int milliseconds)
{
    enum { POLL_MS = 8 }; /* time between two polls, ms */
    for (; milliseconds > 0; milliseconds -= POLL_MS) {
        SDL_PumpEvents();
        if (SDL_HasEvents(SDL_FIRSTEVENT, SDL_LASTEVENT))
            return;
        SDL_Delay((Uint32)(milliseconds < POLL_MS ? milliseconds : POLL_MS));
    }
}

const Window window_sdl = {
    .open = sdl_open,
    .close = sdl_close,
    .find_size = sdl_find_size,
    .find_font_size = sdl_find_font_size,
    .set_title = sdl_set_title,
    .get_failure_reason = sdl_get_failure_reason,
    .show = sdl_show,
    .set_full_screen = sdl_set_full_screen,
    .is_full_screen = sdl_is_full_screen,
    .read_input = sdl_read_input,
    .wait_for_input = sdl_wait_for_input,
};
