#include "play/view.h"

#include <SDL.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    WINDOW_SIZE = 900,
    WINDOW_LEAST = 200,
    PEEK_EVENTS = 256,
    SHOW_AGAIN = 200 /* ms */
};

struct View {
    SDL_Window *window;   /* NULL: a surface */
    SDL_Surface *surface; /* NULL: a window */
    SDL_Renderer *renderer;
    SDL_Texture *texture; /* of the size of the paper, or NULL */
    Paper paper;
    Uint64 shown;     /* ms, when present() was called last */
    bool initialised; /* SDL's video is ours to end */
};

/* A key and what it asks for. */
typedef struct KeyRow {
    SDL_Keycode key;
    CommandKind command;
    bool repeats; /* while it is held down */
} KeyRow;

static const KeyRow key_rows[] = {
    {SDLK_ESCAPE, COMMAND_QUIT, false},   {SDLK_q, COMMAND_QUIT, false},
    {SDLK_SPACE, COMMAND_PAUSE, false},   {SDLK_n, COMMAND_STEP, true},
    {SDLK_RIGHT, COMMAND_STEP, true},     {SDLK_r, COMMAND_RESTART, false},
    {SDLK_s, COMMAND_SCREENSHOT, false},  {SDLK_c, COMMAND_COLOURS, false},
    {SDLK_h, COMMAND_TEXT, false},        {SDLK_p, COMMAND_FILTER, false},
    {SDLK_l, COMMAND_LINE_SEARCH, false}, {SDLK_F1, COMMAND_KEYS, false},
};

/* Why SDL's video driver shows nothing, or NULL if it does. */
static const char *driver_complaint(void)
{
    const char *driver = SDL_GetCurrentVideoDriver();
    if (!driver)
        return "SDL has no video driver";
    if (strcmp(driver, "offscreen") == 0 || strcmp(driver, "dummy") == 0)
        return "SDL finds no display";
    return NULL;
}

/* 900, or what fits on the screen. */
static int window_size(void)
{
    SDL_Rect area;
    int size = WINDOW_SIZE;
    if (SDL_GetDisplayUsableBounds(0, &area))
        return size;
    size = area.w < size ? area.w : size;
    size = area.h < size ? area.h : size;
    return size < WINDOW_LEAST ? WINDOW_LEAST : size;
}

/* Wayland needs XDG_RUNTIME_DIR; without it its library writes a line of its
 * own to standard error, so SDL should not even ask it. */
static void avoid_wayland(void)
{
#ifdef __linux__
    if (!getenv("XDG_RUNTIME_DIR"))
        SDL_SetHint(SDL_HINT_VIDEODRIVER, "x11,KMSDRM");
#endif
}

/* SDL only says which drivers it tried; the environment says more. */
static void explain_display(void)
{
#ifdef __linux__
    const char *display = getenv("DISPLAY");
    if (display)
        SDL_SetError("the display %s cannot be opened", display);
    else if (!getenv("WAYLAND_DISPLAY"))
        SDL_SetError("neither DISPLAY nor WAYLAND_DISPLAY is set");
#endif
}

/* Video, window, renderer: accelerated if possible. */
static bool open_window(View *view, const char *title)
{
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
    SDL_SetHint(SDL_HINT_MOUSE_FOCUS_CLICKTHROUGH, "1");
    SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
    avoid_wayland();
    if (SDL_Init(SDL_INIT_VIDEO)) {
        explain_display();
        return false;
    }
    view->initialised = true;
    const char *complaint = driver_complaint();
    if (complaint) {
        SDL_SetError("%s", complaint);
        return false;
    }
    int size = window_size();
    view->window = SDL_CreateWindow(
        title, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, size, size,
        SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
    if (!view->window)
        return false;
    view->renderer = SDL_CreateRenderer(
        view->window, -1, SDL_RENDERER_ACCELERATED | SDL_RENDERER_PRESENTVSYNC);
    if (!view->renderer)
        view->renderer =
            SDL_CreateRenderer(view->window, -1, SDL_RENDERER_SOFTWARE);
    if (!view->renderer)
        return false;
    SDL_EventState(SDL_MOUSEMOTION, SDL_IGNORE);
    SDL_StartTextInput();
    return true;
}

/* One line out of SDL's message. */
void view_failure(char *reason, size_t size)
{
    snprintf(reason, size, "%s", SDL_GetError());
    reason[strcspn(reason, "\r\n")] = '\0';
}

Status view_create_window(const char *title, View **view, char *reason,
                          size_t size)
{
    View *made = calloc(1, sizeof *made);
    *view = NULL;
    if (!made)
        return STATUS_OUT_OF_MEMORY;
    if (!open_window(made, title)) {
        view_failure(reason, size);
        view_free(made);
        return STATUS_SCREEN_FAILED;
    }
    *view = made;
    return STATUS_OK;
}

Status view_create_surface(int width, int height, View **view)
{
    View *made = calloc(1, sizeof *made);
    *view = NULL;
    if (!made)
        return STATUS_OUT_OF_MEMORY;
    made->surface = SDL_CreateRGBSurfaceWithFormat(0, width, height, 32,
                                                   SDL_PIXELFORMAT_ARGB8888);
    if (made->surface)
        made->renderer = SDL_CreateSoftwareRenderer(made->surface);
    if (!made->renderer) {
        view_free(made);
        return STATUS_SCREEN_FAILED;
    }
    *view = made;
    return STATUS_OK;
}

void view_free(View *view)
{
    if (!view)
        return;
    paper_free(&view->paper);
    if (view->texture)
        SDL_DestroyTexture(view->texture);
    if (view->renderer)
        SDL_DestroyRenderer(view->renderer);
    if (view->surface)
        SDL_FreeSurface(view->surface);
    if (view->window)
        SDL_DestroyWindow(view->window);
    if (view->initialised)
        SDL_Quit();
    free(view);
}

void view_set_title(View *view, const char *title)
{
    if (view->window)
        SDL_SetWindowTitle(view->window, title);
}

/* value, limited to 1 ... high. */
static int limit_size(int value, int high)
{
    return value < 1 ? 1 : value > high ? high : value;
}

/* Pixels of the output, as far as textures and canvases go. */
static void output_size(View *view, int *width, int *height)
{
    SDL_RendererInfo info = {0};
    int most_wide = CANVAS_MAX_SIZE, most_high = CANVAS_MAX_SIZE;
    if (SDL_GetRendererOutputSize(view->renderer, width, height))
        *width = *height = 1;
    if (SDL_GetRendererInfo(view->renderer, &info) == 0) {
        if (info.max_texture_width > 0 && info.max_texture_width < most_wide)
            most_wide = info.max_texture_width;
        if (info.max_texture_height > 0 && info.max_texture_height < most_high)
            most_high = info.max_texture_height;
    }
    *width = limit_size(*width, most_wide);
    *height = limit_size(*height, most_high);
}

Paper *view_paper(View *view)
{
    int width, height;
    output_size(view, &width, &height);
    const Canvas *canvas = &view->paper.canvas;
    if (canvas->pixels && canvas->width == width && canvas->height == height)
        return &view->paper;
    if (view->texture)
        SDL_DestroyTexture(view->texture);
    view->texture = NULL;
    paper_free(&view->paper);
    if (paper_create(width, height, &view->paper)) {
        paper_free(&view->paper);
        return NULL;
    }
    return &view->paper;
}

/* The texture again, on the whole output. */
static Status present(View *view)
{
    if (SDL_RenderCopy(view->renderer, view->texture, NULL, NULL))
        return STATUS_SCREEN_FAILED;
    SDL_RenderPresent(view->renderer);
    view->shown = SDL_GetTicks64();
    return STATUS_OK;
}

Status view_show(View *view)
{
    const Canvas *canvas = &view->paper.canvas;
    if (!canvas->pixels)
        return STATUS_SCREEN_FAILED;
    if (!view->texture) {
        view->texture = SDL_CreateTexture(
            view->renderer, SDL_PIXELFORMAT_ARGB8888,
            SDL_TEXTUREACCESS_STREAMING, canvas->width, canvas->height);
        if (!view->texture)
            return STATUS_SCREEN_FAILED;
        SDL_SetTextureBlendMode(view->texture, SDL_BLENDMODE_NONE);
    }
    if (SDL_UpdateTexture(view->texture, NULL, canvas->pixels,
                          canvas->width * (int)sizeof *canvas->pixels))
        return STATUS_SCREEN_FAILED;
    return present(view);
}

/* The letter at this place of a keyboard that types none of ours. */
static SDL_Keycode latin_key(const SDL_Keysym *key)
{
    if (key->sym < 128 || (key->sym & SDLK_SCANCODE_MASK) ||
        key->scancode < SDL_SCANCODE_A || key->scancode > SDL_SCANCODE_Z)
        return key->sym;
    return SDLK_a + (SDL_Keycode)(key->scancode - SDL_SCANCODE_A);
}

/* Letters and named keys. */
static CommandKind key_command(const SDL_KeyboardEvent *event)
{
    if (event->keysym.mod & (KMOD_CTRL | KMOD_ALT | KMOD_GUI))
        return COMMAND_NONE;
    SDL_Keycode key = latin_key(&event->keysym);
    for (size_t i = 0; i < sizeof key_rows / sizeof *key_rows; i++)
        if (key_rows[i].key == key &&
            (key_rows[i].repeats || event->repeat == 0))
            return key_rows[i].command;
    return COMMAND_NONE;
}

/* Signs and digits: by what is typed, wherever a keyboard has them. */
static Command text_command(const char *text)
{
    Command command = {COMMAND_NONE, 0, 0, 0};
    if (text[0] == '+' || text[0] == '=')
        command.kind = COMMAND_FASTER;
    if (text[0] == '-')
        command.kind = COMMAND_SLOWER;
    if (text[0] == '?')
        command.kind = COMMAND_KEYS;
    if (text[0] >= '1' && text[0] <= '9') {
        command.kind = COMMAND_SCENE;
        command.number = text[0] - '1';
    }
    return command;
}

/* Uncovered, resized, or closed. */
static CommandKind window_command(const SDL_WindowEvent *event)
{
    switch (event->event) {
    case SDL_WINDOWEVENT_CLOSE:
        return COMMAND_QUIT;
    case SDL_WINDOWEVENT_EXPOSED:
    case SDL_WINDOWEVENT_SHOWN:
    case SDL_WINDOWEVENT_RESTORED:
    case SDL_WINDOWEVENT_SIZE_CHANGED:
        return COMMAND_REDRAW;
    default:
        return COMMAND_NONE;
    }
}

/* From points of the window to pixels of the paper. */
static Command pick_command(const View *view, const SDL_MouseButtonEvent *event)
{
    Command command = {COMMAND_PICK, 0, event->x, event->y};
    int width = 0, height = 0;
    SDL_GetWindowSize(view->window, &width, &height);
    if (width > 0 && height > 0) {
        command.x *= (double)view->paper.canvas.width / width;
        command.y *= (double)view->paper.canvas.height / height;
    }
    return command;
}

/* What an event asks for. */
static Command event_command(const View *view, const SDL_Event *event)
{
    Command command = {COMMAND_NONE, 0, 0, 0};
    switch (event->type) {
    case SDL_QUIT:
        command.kind = COMMAND_QUIT;
        return command;
    case SDL_KEYDOWN:
        command.kind = key_command(&event->key);
        return command;
    case SDL_TEXTINPUT:
        return text_command(event->text.text);
    case SDL_WINDOWEVENT:
        command.kind = window_command(&event->window);
        return command;
    case SDL_RENDER_TARGETS_RESET:
    case SDL_RENDER_DEVICE_RESET:
        command.kind = COMMAND_REDRAW;
        return command;
    case SDL_MOUSEBUTTONDOWN:
        return pick_command(view, &event->button);
    default:
        return command;
    }
}

Command view_command(View *view)
{
    SDL_Event event;
    Command command = {COMMAND_NONE, 0, 0, 0};
    while (view->window && command.kind == COMMAND_NONE &&
           SDL_PollEvent(&event)) {
        if (event.type == SDL_RENDER_DEVICE_RESET && view->texture) {
            SDL_DestroyTexture(view->texture);
            view->texture = NULL;
        }
        command = event_command(view, &event);
    }
    return command;
}

void view_wait(View *view, int milliseconds)
{
    if (!view->window)
        return;
    if (milliseconds > 0)
        SDL_WaitEventTimeout(NULL, milliseconds);
}

bool view_quit_waits(View *view)
{
    SDL_Event events[PEEK_EVENTS];
    if (!view->window)
        return false;
    SDL_PumpEvents();
    int count = SDL_PeepEvents(events, PEEK_EVENTS, SDL_PEEKEVENT,
                               SDL_FIRSTEVENT, SDL_LASTEVENT);
    bool uncovered = false;
    for (int i = 0; i < count; i++) {
        CommandKind kind = event_command(view, &events[i]).kind;
        if (kind == COMMAND_QUIT)
            return true;
        uncovered = uncovered || kind == COMMAND_REDRAW;
    }
    if (uncovered && view->texture &&
        SDL_GetTicks64() >= view->shown + SHOW_AGAIN)
        present(view);
    return false;
}

Colour view_surface_pixel(const View *view, int x, int y)
{
    const SDL_Surface *surface = view->surface;
    if (!surface || x < 0 || y < 0 || x >= surface->w || y >= surface->h)
        return 0;
    const char *row = (const char *)surface->pixels + y * surface->pitch;
    uint32_t pixel;
    memcpy(&pixel, row + 4 * x, sizeof pixel);
    return pixel;
}
