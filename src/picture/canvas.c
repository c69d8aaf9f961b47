#include "picture/canvas.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

/* Numbers of 16 bits before and 16 bits after the binary point. */
enum { FIXED_BITS = 16, FIXED_ONE = 1 << FIXED_BITS };

/* A line with its long direction as the first axis: a is along, b across.
 * Pixel (i, j) in these axes is first[i * along + j * across]. */
typedef struct LineFrame {
    uint32_t *first;
    int along, across; /* distances in pixels[] */
    int end;           /* number of pixels across */
} LineFrame;

/* Allocates a white picture. */
Status canvas_create(int width, int height, Canvas *canvas)
{
    *canvas = (Canvas){0};
    if (width < 1 || height < 1 || width > CANVAS_MAX_SIZE ||
        height > CANVAS_MAX_SIZE)
        return STATUS_INVALID_INPUT;
    size_t count = (size_t)width * (size_t)height;
    canvas->pixels = malloc(count * sizeof *canvas->pixels);
    if (!canvas->pixels)
        return STATUS_OUT_OF_MEMORY;
    canvas->width = width;
    canvas->height = height;
    canvas_clear(canvas, 0xffffffff);
    return STATUS_OK;
}

/* Frees the pixels. */
void canvas_free(Canvas *canvas)
{
    if (!canvas)
        return;
    free(canvas->pixels);
    *canvas = (Canvas){0};
}

/* pixels = colour, opaque. */
void canvas_clear(Canvas *canvas, Colour colour)
{
    size_t count = (size_t)canvas->width * (size_t)canvas->height;
    for (size_t i = 0; i < count; i++)
        canvas->pixels[i] = colour | 0xff000000u;
}

/* below + (above - below) amount / 256, red and blue in one multiplication. */
static inline uint32_t mix(uint32_t below, uint32_t above, uint32_t amount)
{
    uint32_t rest = 256 - amount;
    uint32_t red_blue = (below & 0xff00ff) * rest + (above & 0xff00ff) * amount;
    uint32_t green = (below & 0x00ff00) * rest + (above & 0x00ff00) * amount;
    return 0xff000000u | (red_blue >> 8 & 0xff00ff) | (green >> 8 & 0x00ff00);
}

/* Alpha of the colour as 0 ... 256. */
static uint32_t opacity(Colour colour)
{
    uint32_t alpha = colour >> 24;
    return alpha + (alpha >> 7);
}

/* value, limited to low ... high. */
static int clamp_int(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

/* Mixes the colour into every pixel of the rectangle. */
void canvas_rectangle(Canvas *canvas, int x, int y, int width, int height,
                      Colour colour)
{
    if (width <= 0 || height <= 0)
        return;
    int left = clamp_int(x, 0, canvas->width);
    int right = x > canvas->width - width ? canvas->width : x + width;
    int top = clamp_int(y, 0, canvas->height);
    int bottom = y > canvas->height - height ? canvas->height : y + height;
    uint32_t amount = opacity(colour);
    for (int j = top; j < bottom; j++) {
        uint32_t *row = canvas->pixels + (size_t)j * (size_t)canvas->width;
        for (int i = left; i < right; i++)
            row[i] = mix(row[i], colour, amount);
    }
}

/* One side of the Liang-Barsky clip: keeps the part of t in [t0, t1] where
 * p t <= q; false if nothing remains. */
static bool clip_side(double p, double q, double *t0, double *t1)
{
    if (p == 0)
        return q >= 0;
    double t = q / p;
    if (p < 0 && t > *t0)
        *t0 = t;
    if (p > 0 && t < *t1)
        *t1 = t;
    return *t0 <= *t1;
}

/* Shortens the line (x0, y0, x1, y1) to the canvas and a margin around it. */
static bool clip_line(const Canvas *canvas, double margin, double line[4])
{
    double dx = line[2] - line[0], dy = line[3] - line[1];
    double right = canvas->width + margin, bottom = canvas->height + margin;
    double t0 = 0, t1 = 1;
    if (!isfinite(dx) || !isfinite(dy) ||
        !clip_side(-dx, line[0] + margin, &t0, &t1) ||
        !clip_side(dx, right - line[0], &t0, &t1) ||
        !clip_side(-dy, line[1] + margin, &t0, &t1) ||
        !clip_side(dy, bottom - line[1], &t0, &t1))
        return false;
    line[2] = line[0] + t1 * dx;
    line[3] = line[1] + t1 * dy;
    line[0] += t0 * dx;
    line[1] += t0 * dy;
    return true;
}

/* Adds the pixels between top and bottom (fixed point) of one column. */
static inline void line_column(const LineFrame *frame, int column, int top,
                               int bottom, uint32_t amount, Colour colour)
{
    uint32_t *pixel = frame->first + (ptrdiff_t)column * frame->along;
    int limit = frame->end * FIXED_ONE;
    top = top < 0 ? 0 : top;
    bottom = bottom > limit ? limit : bottom;
    while (top < bottom) {
        int row = top >> FIXED_BITS;
        int next = (row + 1) * FIXED_ONE;
        int covered = (next < bottom ? next : bottom) - top;
        uint32_t *p = pixel + (ptrdiff_t)row * frame->across;
        *p = mix(*p, colour, (uint32_t)covered * amount >> FIXED_BITS);
        top = next;
    }
}

/* Draws from a0 to a1 > a0, clipped, |slope| <= 1, b = b0 at a0. */
static void line_columns(const LineFrame *frame, int columns, double a0,
                         double a1, double b0, double slope, double width,
                         Colour colour)
{
    int begin = clamp_int((int)floor(a0), 0, columns);
    int end = clamp_int((int)ceil(a1), 0, columns);
    double half = 0.5 * width * sqrt(1 + slope * slope);
    int reach = (int)(half * FIXED_ONE);
    int step = (int)(slope * FIXED_ONE);
    int b = (int)((b0 + (begin + 0.5 - a0) * slope) * FIXED_ONE);
    uint32_t full = opacity(colour);
    for (int i = begin; i < end; i++, b += step) {
        uint32_t amount = full;
        if (i < a0 || i + 1 > a1) {
            double part = fmin(i + 1, a1) - fmax(i, a0);
            amount = (uint32_t)(part * amount + 0.5);
        }
        line_column(frame, i, b - reach, b + reach, amount, colour);
    }
}

/* Columns or rows, whichever the line crosses more of. */
void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1,
                 double width, Colour colour)
{
    double line[4] = {x0, y0, x1, y1};
    if (!(width > 0) || width > CANVAS_MAX_WIDTH ||
        !clip_line(canvas, width + 1, line))
        return;
    bool flat = fabs(line[2] - line[0]) >= fabs(line[3] - line[1]);
    int along = flat ? 0 : 1, across = flat ? 1 : 0;
    int from = line[along] <= line[2 + along] ? 0 : 2, to = 2 - from;
    double length = line[to + along] - line[from + along];
    if (!(length > 0))
        return;
    double slope = (line[to + across] - line[from + across]) / length;
    LineFrame frame = {canvas->pixels, flat ? 1 : canvas->width,
                       flat ? canvas->width : 1,
                       flat ? canvas->height : canvas->width};
    line_columns(&frame, flat ? canvas->width : canvas->height,
                 line[from + along], line[to + along], line[from + across],
                 slope, width, colour);
}

/* Coverage of a pixel whose centre is at squared distance d2: 0 ... 1. */
static double disc_coverage(double d2, double radius)
{
    double inner = radius - 0.5, outer = radius + 0.5;
    if (d2 >= outer * outer)
        return 0;
    if (inner > 0 && d2 <= inner * inner)
        return 1;
    return fmin(outer - sqrt(d2), 1);
}

/* Pixels by their distance from the centre. */
void canvas_disc(Canvas *canvas, double x, double y, double radius,
                 Colour colour)
{
    double reach = radius + 1;
    if (!(radius > 0) || !(fabs(x) < 1e6) || !(fabs(y) < 1e6) ||
        !(radius < 1e6))
        return;
    int left = clamp_int((int)floor(x - reach), 0, canvas->width);
    int right = clamp_int((int)ceil(x + reach), 0, canvas->width);
    int top = clamp_int((int)floor(y - reach), 0, canvas->height);
    int bottom = clamp_int((int)ceil(y + reach), 0, canvas->height);
    uint32_t full = opacity(colour);
    for (int j = top; j < bottom; j++) {
        uint32_t *row = canvas->pixels + (size_t)j * (size_t)canvas->width;
        double dy = j + 0.5 - y;
        for (int i = left; i < right; i++) {
            double dx = i + 0.5 - x;
            double part = disc_coverage(dx * dx + dy * dy, radius);
            row[i] = mix(row[i], colour, (uint32_t)(part * full + 0.5));
        }
    }
}

/* Mixes the colour in by mask * alpha. */
void canvas_stencil(Canvas *canvas, int x, int y, int width, int height,
                    const uint8_t *mask, Colour colour)
{
    uint32_t full = opacity(colour);
    for (int j = 0; j < height; j++) {
        if (y + j < 0 || y + j >= canvas->height)
            continue;
        uint32_t *row =
            canvas->pixels + (size_t)(y + j) * (size_t)canvas->width;
        for (int i = 0; i < width; i++) {
            uint32_t part = mask[(size_t)j * (size_t)width + (size_t)i];
            if (part == 0 || x + i < 0 || x + i >= canvas->width)
                continue;
            part += part >> 7;
            row[x + i] = mix(row[x + i], colour, part * full >> 8);
        }
    }
}
