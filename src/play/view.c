#include "play/view.h"

#include <SDL.h>
#include <SDL_opengl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "play/event_wait.h"
#include "scenes/one_line.h"

enum { WINDOW_WIDTH = 1280, WINDOW_HEIGHT = 800, WINDOW_LEAST = 200 };

struct View {
    SDL_Window *window;   /* NULL: a surface */
    SDL_Surface *surface; /* NULL: a window */
    SDL_Renderer *renderer;
    SDL_Texture *texture; /* of the size of the paper, or NULL */
    Paper paper;
    int before[2];    /* pixels, before it became as large as the screen */
    bool initialised; /* SDL's video is ours to end */
    bool fontless;    /* that there is no font was said */
    bool tab;         /* Tab is down and has asked for nothing yet */
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

/* What was asked for, or what fits on the screen.  fitting [2] out */
static void window_size(const int size[2], int fitting[2])
{
    SDL_Rect area;
    fitting[0] = size[0] > 0 ? size[0] : WINDOW_WIDTH;
    fitting[1] = size[1] > 0 ? size[1] : WINDOW_HEIGHT;
    if (size[0] > 0 || SDL_GetDisplayUsableBounds(0, &area))
        return;
    fitting[0] = area.w < fitting[0] ? area.w : fitting[0];
    fitting[1] = area.h < fitting[1] ? area.h : fitting[1];
    for (int i = 0; i < 2; i++)
        fitting[i] = fitting[i] < WINDOW_LEAST ? WINDOW_LEAST : fitting[i];
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

/* Whether the renderer's OpenGL is computed by the processor, as Mesa does
 * where there is no graphics card: in virtual machines and on far screens. */
static bool opengl_is_software(void)
{
    const GLubyte *(APIENTRY * get_string)(GLenum) = NULL;
    void *symbol = NULL;
    if (SDL_GL_GetCurrentContext())
        symbol = SDL_GL_GetProcAddress("glGetString");
    memcpy(&get_string, &symbol, sizeof symbol);
    const char *name = get_string ? (const char *)get_string(GL_RENDERER) : "";
    return name && (strstr(name, "llvmpipe") || strstr(name, "softpipe") ||
                    strstr(name, "Software Rasterizer"));
}

/* Accelerated if possible.  Copying the paper to an X11 window costs less than
 * half of what drawing it by such an OpenGL does (measured: 6 instead of 14 ms
 * a frame of 900 x 900 pixels). */
static SDL_Renderer *create_renderer(SDL_Window *window)
{
    SDL_Renderer *renderer = SDL_CreateRenderer(
        window, -1, SDL_RENDERER_ACCELERATED | SDL_RENDERER_PRESENTVSYNC);
    bool asked = SDL_GetHint(SDL_HINT_RENDER_DRIVER) != NULL;
    if (renderer && !asked && opengl_is_software() &&
        strcmp(SDL_GetCurrentVideoDriver(), "x11") == 0) {
        SDL_DestroyRenderer(renderer);
        renderer = NULL;
        SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    }
    if (renderer)
        return renderer;
    return SDL_CreateRenderer(window, -1, SDL_RENDERER_SOFTWARE);
}

/* Video, window, renderer. */
static bool open_window(View *view, const char *title, const int size[2],
                        bool full)
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
    int fitting[2];
    window_size(size, fitting);
    view->window =
        SDL_CreateWindow(title, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                         fitting[0], fitting[1],
                         SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI |
                             (full ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0));
    if (!view->window)
        return false;
    view->renderer = create_renderer(view->window);
    if (!view->renderer)
        return false;
    SDL_StartTextInput();
    return true;
}

/* One line out of SDL's message. */
void view_failure(char *reason, size_t size)
{
    snprintf(reason, size, "%s", SDL_GetError());
    reason[strcspn(reason, "\r\n")] = '\0';
    one_line(reason, reason, size);
}

static volatile sig_atomic_t view_opens; /* a window is being opened */
static void (*view_lost)(void);

void view_when_lost(void (*lost)(void))
{
    view_lost = lost;
}

void view_let_go(void)
{
    if (view_opens)
        _exit(EXIT_FAILURE);
    event_let_go();
}

Status view_create_window(const char *title, const int size[2], bool full,
                          View **view, char *reason, size_t length)
{
    View *made = calloc(1, sizeof *made);
    *view = NULL;
    if (!made)
        return STATUS_OUT_OF_MEMORY;
    view_opens = 1;
    bool opened = open_window(made, title, size, full);
    event_guard(made->window, view_lost);
    view_opens = 0;
    if (!opened) {
        view_failure(reason, length);
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
    if (view->initialised) {
        SDL_Quit();
        event_guard(NULL, NULL);
    }
    free(view);
}

void view_set_title(View *view, const char *title)
{
    if (view->window)
        SDL_SetWindowTitle(view->window, title);
}

void view_set_full(View *view, bool full)
{
    if (!view->window || full == view_is_full(view))
        return;
    if (full)
        SDL_GetWindowSize(view->window, &view->before[0], &view->before[1]);
    SDL_SetWindowFullscreen(view->window,
                            full ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
    /* Where no window manager does it, SDL keeps the size of the screen. */
    if (!full && view->before[0] > 0)
        SDL_SetWindowSize(view->window, view->before[0], view->before[1]);
}

bool view_is_full(const View *view)
{
    return view->window && (SDL_GetWindowFlags(view->window) &
                            SDL_WINDOW_FULLSCREEN_DESKTOP) != 0;
}

double view_letter(const View *view)
{
    const double points = 9;
    int width = 0, height, wide, high;
    if (view->window)
        SDL_GetWindowSize(view->window, &width, &height);
    if (width < 1 || SDL_GetRendererOutputSize(view->renderer, &wide, &high))
        return points;
    return points * wide / width;
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

/* Once: pictures without words are pictures, too. */
static void tell_of_font(View *view)
{
    const char *given = getenv("ELASTO_FONT");
    bool wanted = !given || given[0] != '\0'; /* empty: no words, please */
    if (view->paper.text || !wanted || view->fontless)
        return;
    view->fontless = true;
    fprintf(stderr, "no font: DejaVu Sans is not installed; pictures have no "
                    "words (ELASTO_FONT=FILE.ttf names another font)\n");
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
    tell_of_font(view);
    return &view->paper;
}

/* The texture again, on the whole output. */
static Status present(View *view)
{
    if (SDL_RenderCopy(view->renderer, view->texture, NULL, NULL))
        return STATUS_SCREEN_FAILED;
    SDL_RenderPresent(view->renderer);
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

/* "Ctrl+", "Shift+", "Tab+" in front of the key's own name.  Signs and digits
 * come as texts, wherever a keyboard has them. */
static void name_key(View *view, const SDL_KeyboardEvent *event, Input *input)
{
    SDL_Keycode key = latin_key(&event->keysym);
    SDL_Keymod mod = (SDL_Keymod)event->keysym.mod;
    bool letter = key >= SDLK_a && key <= SDLK_z;
    bool held = SDL_GetKeyboardState(NULL)[SDL_SCANCODE_TAB] != 0;
    bool typed = key > SDLK_SPACE && key < SDLK_DELETE && !letter;
    if ((typed && !(mod & (KMOD_CTRL | KMOD_ALT | KMOD_GUI))) ||
        (mod & (KMOD_ALT | KMOD_GUI)))
        return;
    if (key == SDLK_TAB) { /* told when it comes up: Tab+M is another key */
        view->tab = true;
        return;
    }
    if (key == SDLK_LCTRL || key == SDLK_RCTRL || key == SDLK_LSHIFT ||
        key == SDLK_RSHIFT || key == SDLK_LALT || key == SDLK_RALT)
        return;
    input->kind = INPUT_KEY;
    input->repeats = event->repeat != 0;
    snprintf(input->key, sizeof input->key, "%s%s%s%s",
             mod & KMOD_CTRL ? "Ctrl+" : "", mod & KMOD_SHIFT ? "Shift+" : "",
             held ? "Tab+" : "", SDL_GetKeyName(key));
    view->tab = false;
}

/* Tab alone. */
static void name_tab(View *view, const SDL_KeyboardEvent *event, Input *input)
{
    if (event->keysym.sym != SDLK_TAB || !view->tab)
        return;
    view->tab = false;
    input->kind = INPUT_KEY;
    snprintf(input->key, sizeof input->key, "%s",
             event->keysym.mod & KMOD_SHIFT ? "Shift+Tab" : "Tab");
}

/* Signs and digits. */
static void name_text(const char *text, Input *input)
{
    bool letter = (text[0] >= 'a' && text[0] <= 'z') ||
                  (text[0] >= 'A' && text[0] <= 'Z') || text[0] == ' ';
    if (letter || (unsigned char)text[0] < ' ' || text[1] != '\0')
        return;
    input->kind = INPUT_KEY;
    snprintf(input->key, sizeof input->key, "%s", text);
}

/* Uncovered, resized, left or closed. */
static InputKind window_input(const SDL_WindowEvent *event)
{
    switch (event->event) {
    case SDL_WINDOWEVENT_CLOSE:
        return INPUT_CLOSE;
    case SDL_WINDOWEVENT_LEAVE:
        return INPUT_LEAVE;
    case SDL_WINDOWEVENT_EXPOSED:
    case SDL_WINDOWEVENT_SHOWN:
    case SDL_WINDOWEVENT_RESTORED:
    case SDL_WINDOWEVENT_SIZE_CHANGED:
        return INPUT_REDRAW;
    default:
        return INPUT_NONE;
    }
}

/* From points of the window to pixels of the paper. */
static void place_input(const View *view, int x, int y, Input *input)
{
    int width = 0, height = 0;
    SDL_GetWindowSize(view->window, &width, &height);
    input->x = x;
    input->y = y;
    if (width > 0 && height > 0) {
        input->x *= (double)view->paper.canvas.width / width;
        input->y *= (double)view->paper.canvas.height / height;
    }
}

/* A button that went down or up. */
static void button_input(const View *view, const SDL_MouseButtonEvent *event,
                         Input *input)
{
    input->kind = event->state == SDL_PRESSED ? INPUT_PRESS : INPUT_RELEASE;
    input->button = event->button == SDL_BUTTON_LEFT    ? BUTTON_LEFT
                    : event->button == SDL_BUTTON_RIGHT ? BUTTON_RIGHT
                                                        : BUTTON_MIDDLE;
    input->clicks = event->clicks;
    place_input(view, event->x, event->y, input);
}

/* Where the mouse is when its wheel turns. */
static void wheel_input(const View *view, const SDL_MouseWheelEvent *event,
                        Input *input)
{
    int x, y;
    SDL_GetMouseState(&x, &y);
    input->kind = INPUT_WHEEL;
    input->amount = event->preciseY;
    if (event->direction == SDL_MOUSEWHEEL_FLIPPED)
        input->amount = -input->amount;
    place_input(view, x, y, input);
}

/* What an event says. */
static Input read_event(View *view, const SDL_Event *event)
{
    Input input = {.kind = INPUT_NONE};
    switch (event->type) {
    case SDL_QUIT:
        input.kind = INPUT_CLOSE;
        break;
    case SDL_KEYDOWN:
        name_key(view, &event->key, &input);
        break;
    case SDL_KEYUP:
        name_tab(view, &event->key, &input);
        break;
    case SDL_TEXTINPUT:
        name_text(event->text.text, &input);
        break;
    case SDL_WINDOWEVENT:
        input.kind = window_input(&event->window);
        break;
    case SDL_RENDER_TARGETS_RESET:
    case SDL_RENDER_DEVICE_RESET:
        input.kind = INPUT_REDRAW;
        break;
    case SDL_MOUSEMOTION:
        input.kind = INPUT_MOVE;
        place_input(view, event->motion.x, event->motion.y, &input);
        break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
        button_input(view, &event->button, &input);
        break;
    case SDL_MOUSEWHEEL:
        wheel_input(view, &event->wheel, &input);
        break;
    default:
        break;
    }
    return input;
}

/* Whether the event behind this movement is another one. */
static bool moves_on(void)
{
    SDL_Event event;
    return SDL_PeepEvents(&event, 1, SDL_PEEKEVENT, SDL_FIRSTEVENT,
                          SDL_LASTEVENT) == 1 &&
           event.type == SDL_MOUSEMOTION;
}

Input view_input(View *view)
{
    SDL_Event event;
    Input input = {.kind = INPUT_NONE};
    while (view->window && input.kind == INPUT_NONE && SDL_PollEvent(&event)) {
        if (event.type == SDL_RENDER_DEVICE_RESET && view->texture) {
            SDL_DestroyTexture(view->texture);
            view->texture = NULL;
        }
        if (event.type != SDL_MOUSEMOTION || !moves_on())
            input = read_event(view, &event);
    }
    return input;
}

void view_wait(View *view, int milliseconds)
{
    if (!view->window)
        return;
    if (milliseconds > 0)
        event_wait(view->window, milliseconds);
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
