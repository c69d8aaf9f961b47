/* highlight.c - highlights a term of the formulas in the whole frame.
 *
 * A term has the same colour everywhere: in letters, arrows, curves and
 * legends.  Therefore pixels of this colour belong to the term. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "picture/cards.h"

static const double HIGHLIGHT_RADIUS = 4; /* units of 1/14 em around a pixel */
static const double MOUSE_REACH = 0.5;    /* ems, from mouse to term at most */
static const double MIN_COVERAGE = 0.5;   /* least share of colour in a pixel */

static int get_channel(Colour colour, int k)
{
    return (int)(colour >> 8 * k & 255);
}

/* Whether the pixel is a mixture of this colour with white. */
static bool pixel_has_colour(Colour pixel, Colour colour)
{
    double ink = 0, off = 0;
    for (int k = 0; k < 3; k++)
        if (get_channel(colour, k) < 128)
            ink = fmax(ink, (255.0 - get_channel(pixel, k)) /
                                (255.0 - get_channel(colour, k)));
    for (int k = 0; k < 3; k++)
        off = fmax(off, fabs(255 - ink * (255 - get_channel(colour, k)) -
                             get_channel(pixel, k)));
    return ink > MIN_COVERAGE && off < 16;
}

/* Marks the pixels of a disc in the map of pixels to highlight. */
static void mark_disc_pixels(unsigned char *map, const Canvas *canvas, int x,
                             int y, int radius)
{
    for (int dy = -radius; dy <= radius; dy++) {
        int half = (int)sqrt((double)(radius * radius - dy * dy));
        int left = x > half ? x - half : 0;
        int right = x + half < canvas->width ? x + half : canvas->width - 1;
        if (y + dy >= 0 && y + dy < canvas->height)
            memset(map + (size_t)(y + dy) * canvas->width + left, 1,
                   (size_t)(right - left + 1));
    }
}

static void highlight_pixels(Canvas *canvas, Colour colour, int radius)
{
    size_t count = (size_t)canvas->width * canvas->height;
    unsigned char *map = calloc(count, 1);
    for (size_t i = 0; i < count && map; i++)
        if (canvas->pixels[i] != COLOUR_WHITE &&
            pixel_has_colour(canvas->pixels[i], colour))
            mark_disc_pixels(map, canvas, (int)(i % canvas->width),
                             (int)(i / canvas->width), radius);
    for (size_t i = 0; i < count && map; i++) {
        Colour pixel = canvas->pixels[i], lit = 0xff000000u;
        if (!map[i] || get_channel(pixel, 1) < 128)
            continue; /* dark pixels keep their colour */
        for (int k = 0; k < 3; k++) {
            int part = get_channel(pixel, k) * get_channel(COLOUR_HIGHLIGHT, k);
            lit |= (Colour)(part / 255) << 8 * k;
        }
        canvas->pixels[i] = lit;
    }
    free(map);
}

/* Returns the colour of the nearest term within `reach` pixels; 0: none. */
static Colour find_term_colour_at(const Canvas *canvas, const double at[2],
                                  int reach)
{
    const Box whole = {0, 0, canvas->width, canvas->height};
    int x = (int)at[0], y = (int)at[1], least = reach * reach + 1;
    Box box = box_intersect(
        whole, (Box){x - reach, y - reach, 2 * reach + 1, 2 * reach + 1});
    Colour colour, best = 0;
    for (int j = box.y; j < box.y + box.height; j++)
        for (int i = box.x; i < box.x + box.width; i++) {
            int far = (i - x) * (i - x) + (j - y) * (j - y);
            if (far >= least)
                continue;
            Colour pixel = canvas->pixels[canvas->width * j + i];
            for (int term = 0; (colour = colour_of_term(term)); term++)
                if (colour != COLOUR_TEXT && pixel_has_colour(pixel, colour)) {
                    best = colour;
                    least = far;
                }
        }
    return best;
}

void draw_term_highlight(Paper *paper, const FrameContent *content)
{
    static const Colour of_line[LINE_COUNT] = {[LINE_PROJECT] = COLOUR_PROJECT,
                                               [LINE_SOLVE] = COLOUR_P,
                                               [LINE_SEARCH] = COLOUR_ALPHA};
    const NewtonTrace *trace = active_pane(content)->trace;
    const WindowHit *mouse = &content->view->mouse_hit;
    unsigned layers = active_pane(content)->simulation->options.layers;
    bool stage = mouse->zone == ZONE_STAGE, idle = content->title_bar.state[0];
    PickKind over = content->view->hovered_part.kind;
    Colour colour = 0;
    if (!content->lecture.page)
        return;
    if (idle && (mouse->zone == ZONE_CARD || stage))
        colour = find_term_colour_at(&paper->canvas, mouse->pixel,
                                     (int)(MOUSE_REACH * paper->em));
    bool plain = over == PICK_NODE ||
                 (over == PICK_SWITCH && !(layers & LAYER_SPRING_KINDS));
    if (plain || (colour == COLOUR_X && stage) || layers & LAYER_ZERO_CURVES)
        colour = 0; /* the mouse highlights no node, switch, spring or curve */
    if (!colour && trace && frame_has_card(content, "listing"))
        colour = of_line[trace->at_line];
    if (colour)
        highlight_pixels(&paper->canvas, colour,
                         (int)(HIGHLIGHT_RADIUS * paper->unit + 0.5));
}
