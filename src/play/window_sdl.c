/* window_sdl.c - the window on a computer; SDL only shows the finished picture.
 */
#include <SDL.h>
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "play/view.h"

enum { WINDOW_WIDTH = 1280, WINDOW_HEIGHT = 800 };

/* Points of a window's frame, both sides together, if the system does not say.
 */
enum { FRAME_WIDTH = 10, FRAME_HEIGHT = 40 };

static SDL_Window *window;
static bool tab; /* Tab is down, without another key so far */

/* Tab and mouse at the time of the event that is read; SDL only knows the
 * present. */
static bool tab_held;
static SDL_Point mouse;

const char *window_failure(void)
{
    return SDL_GetError();
}

/* ---- opening and closing ------------------------------------------------- */

/* Starts SDL's video.  Returns false if no screen shows it; SDL's error says
 * why. Without XDG_RUNTIME_DIR Wayland's library prints an error, so it is left
 * out.
 */
static bool open_video(void)
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

void window_set_full(bool full)
{
    SDL_SetWindowFullscreen(window, full ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
}

bool window_is_full(void)
{
    return (SDL_GetWindowFlags(window) & SDL_WINDOW_FULLSCREEN_DESKTOP) != 0;
}

/* Computes the usual size, or what fits on the screen with its frame. */
static void usual_size(const SDL_Rect *area, const int frame[2], int size[2])
{
    size[0] = SDL_max(SDL_min(WINDOW_WIDTH, area->w - frame[0]), 1);
    size[1] = SDL_max(SDL_min(WINDOW_HEIGHT, area->h - frame[1]), 1);
}

/* Shrinks a window that is larger than the screen with its frame. */
static void fit_frame(const SDL_Rect *area, const int now[2])
{
    int top = 0, left = 0, low = 0, right = 0, fits[2];
    if (SDL_GetWindowBordersSize(window, &top, &left, &low, &right))
        return;
    usual_size(area, (const int[]){left + right, top + low}, fits);
    if (fits[0] >= now[0] && fits[1] >= now[1])
        return;
    SDL_SetWindowSize(window, SDL_min(fits[0], now[0]),
                      SDL_min(fits[1], now[1]));
    SDL_SetWindowPosition(window, area->x + left, area->y + top);
}

/* On X11 without acceleration a frame of 900 x 900 pixels takes 6 ms, not 14 as
 * with OpenGL computed by the processor (measured). */
bool window_open(const char *title, const int size[2], bool full)
{
    SDL_Rect area = {0, 0, WINDOW_WIDTH, WINDOW_HEIGHT};
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
    SDL_SetHint(SDL_HINT_MOUSE_FOCUS_CLICKTHROUGH, "1");
    SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
    if (!open_video())
        return false;
    if (strcmp(SDL_GetCurrentVideoDriver(), "x11") == 0)
        SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    SDL_GetDisplayUsableBounds(0, &area);
    int usual[2];
    usual_size(&area, (const int[]){FRAME_WIDTH, FRAME_HEIGHT}, usual);
    window = SDL_CreateWindow(
        title, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
        size[0] > 0 ? size[0] : usual[0], size[1] > 0 ? size[1] : usual[1],
        SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
    if (!window || !SDL_GetWindowSurface(window))
        return false;
    if (size[0] <= 0 && size[1] <= 0)
        fit_frame(&area, usual);
    if (full)
        window_set_full(true);
    SDL_StartTextInput();
    return true;
}

void window_close(void)
{
    if (window)
        SDL_DestroyWindow(window);
    window = NULL;
    SDL_Quit();
}

/* ---- output -------------------------------------------------------------- */

void window_set_title(const char *title)
{
    SDL_SetWindowTitle(window, title);
}

void window_size(int size[2])
{
    const SDL_Surface *surface = SDL_GetWindowSurface(window);
    size[0] = surface ? surface->w : 1;
    size[1] = surface ? surface->h : 1;
}

/* Pixels per point in each direction; 1 if not known. */
static void window_scale(double scale[2])
{
    int size[2], points[2] = {0, 0};
    window_size(size);
    SDL_GetWindowSize(window, &points[0], &points[1]);
    for (int i = 0; i < 2; i++)
        scale[i] = points[i] > 0 ? (double)size[i] / points[i] : 1;
}

double window_letter(void)
{
    double scale[2] = {1, 1};
    if (window)
        window_scale(scale);
    return 9 * scale[0];
}

bool window_has_document(void)
{
    return false;
}

Status window_show(const Canvas *canvas)
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

/* Names a key with "Ctrl+", "Shift+", "Tab+" in front.  Signs and digits come
 * as texts, independent of the keyboard; Tab counts when it comes up again,
 * since Tab+M is another key. */
static void read_key(const SDL_KeyboardEvent *event, Input *input)
{
    SDL_Keycode key = event->keysym.sym;
    SDL_Scancode place = event->keysym.scancode;
    if (key >= 128 && !(key & SDLK_SCANCODE_MASK) && /* another alphabet */
        place >= SDL_SCANCODE_A && place <= SDL_SCANCODE_Z)
        key = SDLK_a + (SDL_Keycode)(place - SDL_SCANCODE_A);
    SDL_Keymod mod = (SDL_Keymod)event->keysym.mod;
    bool letter = key >= SDLK_a && key <= SDLK_z;
    bool typed = key > SDLK_SPACE && key < SDLK_DELETE && !letter;
    bool down = event->state == SDL_PRESSED, is_tab = key == SDLK_TAB;
    bool is_command = is_tab ? tab && !down : down;
    if (is_tab)
        tab_held = down;
    if ((mod & (KMOD_ALT | KMOD_GUI)) || (typed && !(mod & KMOD_CTRL)) ||
        (place >= SDL_SCANCODE_LCTRL && place <= SDL_SCANCODE_RGUI))
        return;
    if (down || is_tab)
        tab = down && is_tab;
    if (!is_command)
        return;
    input->kind = INPUT_KEY;
    input->repeats = event->repeat != 0;
    snprintf(input->key, sizeof input->key, "%s%s%s%s",
             mod & KMOD_CTRL ? "Ctrl+" : "", mod & KMOD_SHIFT ? "Shift+" : "",
             tab_held ? "Tab+" : "", SDL_GetKeyName(key));
}

/* ---- mouse and window ---------------------------------------------------- */

/* Translates an event of the window.  A drag ends when the window loses the
 * keys, since the release of the button may go elsewhere. */
static InputKind change_of_window(const SDL_WindowEvent *event)
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

/* Translates an event, with the place of the mouse. */
static Input read_event(const SDL_Event *event)
{
    Input input = {.kind = INPUT_NONE};
    const char *text = event->text.text;
    bool press = event->type == SDL_MOUSEBUTTONDOWN;
    int button = event->button.button;
    double scale[2];
    switch (event->type) {
    case SDL_QUIT:
        input.kind = INPUT_CLOSE;
        break;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
        read_key(&event->key, &input);
        break;
    case SDL_TEXTINPUT: /* signs and digits */
        if (isgraph((unsigned char)text[0]) &&
            !isalpha((unsigned char)text[0]) && text[1] == '\0') {
            input.kind = INPUT_KEY;
            snprintf(input.key, sizeof input.key, "%s", text);
        }
        break;
    case SDL_WINDOWEVENT:
        input.kind = change_of_window(&event->window);
        break;
    case SDL_MOUSEMOTION:
        input.kind = INPUT_MOVE;
        mouse = (SDL_Point){event->motion.x, event->motion.y};
        break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        mouse = (SDL_Point){event->button.x, event->button.y};
        input.kind = press ? INPUT_PRESS : INPUT_RELEASE;
        input.button = button == SDL_BUTTON_LEFT    ? BUTTON_LEFT
                       : button == SDL_BUTTON_RIGHT ? BUTTON_RIGHT
                                                    : BUTTON_MIDDLE;
        input.clicks = event->button.clicks;
        break;
    case SDL_MOUSEWHEEL:
        input.kind = INPUT_WHEEL;
        input.amount = event->wheel.preciseY;
        if (event->wheel.direction == SDL_MOUSEWHEEL_FLIPPED)
            input.amount = -input.amount;
        break;
    default:
        break;
    }
    window_scale(scale);
    input.x = mouse.x * scale[0];
    input.y = mouse.y * scale[1];
    return input;
}

/* Skips all but the last of several movements in a row. */
Input window_input(void)
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

/* SDL_WaitEventTimeout is not used: on X it wakes itself by an event of a
 * second connection, and such an event after the window is closed ends the
 * program. */
void window_wait(int milliseconds)
{
    enum { PAUSE = 8 }; /* ms */
    for (; milliseconds > 0; milliseconds -= PAUSE) {
        SDL_PumpEvents();
        if (SDL_HasEvents(SDL_FIRSTEVENT, SDL_LASTEVENT))
            return;
        SDL_Delay((Uint32)(milliseconds < PAUSE ? milliseconds : PAUSE));
    }
}
