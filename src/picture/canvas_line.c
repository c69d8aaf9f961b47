#include "picture/canvas.h"

#include <math.h>
#include <stddef.h>

#include "picture/blend.h"

/* Numbers of 16 bits before and 16 bits after the binary point. */
enum { FIXED_BITS = 16, FIXED_ONE = 1 << FIXED_BITS };

/* A line with its long direction as the first axis: a is along, b across.
 * Pixel (i, j) in these axes is first[i * along + j * across]. */
typedef struct LineFrame {
    uint32_t *first;
    ptrdiff_t along, across;  /* distances in pixels[] */
    int begin, end;           /* clip along */
    int low, high;            /* clip across, fixed point */
    uint32_t red_blue, green; /* of the colour */
    uint32_t full;            /* opacity, 0 ... 256 */
} LineFrame;

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

/* Shortens the line (x0, y0, x1, y1) to the clip and a margin around it. */
static inline bool clip_line(const Box *clip, double margin, double line[4])
{
    double left = clip->x - margin, right = clip->x + clip->width + margin;
    double top = clip->y - margin, bottom = clip->y + clip->height + margin;
    if (line[0] >= left && line[2] >= left && line[0] <= right &&
        line[2] <= right && line[1] >= top && line[3] >= top &&
        line[1] <= bottom && line[3] <= bottom)
        return true; /* also far faster where nothing is to be cut */
    double dx = line[2] - line[0], dy = line[3] - line[1];
    double t0 = 0, t1 = 1;
    if (!isfinite(dx) || !isfinite(dy) ||
        !clip_side(-dx, line[0] - left, &t0, &t1) ||
        !clip_side(dx, right - line[0], &t0, &t1) ||
        !clip_side(-dy, line[1] - top, &t0, &t1) ||
        !clip_side(dy, bottom - line[1], &t0, &t1))
        return false;
    line[2] = line[0] + t1 * dx;
    line[3] = line[1] + t1 * dy;
    line[0] += t0 * dx;
    line[1] += t0 * dy;
    return true;
}

/* mix(), with the parts of the colour ready: below + (above - below) amount
 * / 256, where borrowed bits fall out of the mask. */
static inline void blend(uint32_t *pixel, const LineFrame *frame,
                         uint32_t amount)
{
    uint32_t red_blue = *pixel & 0xff00ff, green = *pixel & 0x00ff00;
    red_blue += (frame->red_blue - red_blue) * amount >> 8;
    green += (frame->green - green) * amount >> 8;
    *pixel = 0xff000000u | (red_blue & 0xff00ff) | (green & 0x00ff00);
}

/* Adds the pixels between low and high > low (fixed point) of one column. */
static inline void line_column(const LineFrame *frame, uint32_t *column,
                               int low, int high, uint32_t amount)
{
    int row = low >> FIXED_BITS, last = (high - 1) >> FIXED_BITS;
    uint32_t *p = column + row * frame->across;
    if (row == last) {
        blend(p, frame, (uint32_t)(high - low) * amount >> FIXED_BITS);
        return;
    }
    uint32_t part = (uint32_t)(FIXED_ONE - (low & (FIXED_ONE - 1)));
    blend(p, frame, part * amount >> FIXED_BITS);
    for (p += frame->across; ++row < last; p += frame->across)
        blend(p, frame, amount);
    part = (uint32_t)(high - last * FIXED_ONE);
    blend(p, frame, part * amount >> FIXED_BITS);
}

/* The same, as far as the clip goes. */
static void line_column_clipped(const LineFrame *frame, uint32_t *column,
                                int low, int high, uint32_t amount)
{
    low = low < frame->low ? frame->low : low;
    high = high > frame->high ? frame->high : high;
    if (low < high)
        line_column(frame, column, low, high, amount);
}

/* From a0 to a1 > a0, |slope| <= 1, b = b0 at a0, in the axes of the frame; in
 * fixed point, for most lines are a few pixels long. */
static void line_columns(const LineFrame *frame, double a0, double a1,
                         double b0, double slope, double width)
{
    int from = (int)(a0 * FIXED_ONE), to = (int)(a1 * FIXED_ONE);
    int begin = from >> FIXED_BITS, end = (to + FIXED_ONE - 1) >> FIXED_BITS;
    begin = begin < frame->begin ? frame->begin : begin;
    end = end > frame->end ? frame->end : end;
    int b = (int)((b0 + (begin + 0.5 - a0) * slope) * FIXED_ONE);
    int step = (int)(slope * FIXED_ONE), b_end = b + (end - begin) * step;
    int reach = (int)(0.5 * width * sqrt(1 + slope * slope) * FIXED_ONE);
    uint32_t *column = frame->first + begin * frame->along;
    bool inside = (b < b_end ? b : b_end) - reach - FIXED_ONE >= frame->low &&
                  (b > b_end ? b : b_end) + reach + FIXED_ONE <= frame->high;
    for (int i = begin; i < end; i++, b += step, column += frame->along) {
        uint32_t amount = frame->full;
        if (i == begin || i + 1 == end) { /* its ends cover parts of pixels */
            int left = i * FIXED_ONE, right = left + FIXED_ONE;
            left = left < from ? from : left;
            right = right > to ? to : right;
            amount = (uint32_t)(right - left) * amount >> FIXED_BITS;
        }
        if (inside)
            line_column(frame, column, b - reach, b + reach, amount);
        else
            line_column_clipped(frame, column, b - reach, b + reach, amount);
    }
}

/* Columns or rows, whichever the line crosses more of; from left to right or
 * downwards. */
void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1,
                 double width, Colour colour)
{
    double line[4] = {x0, y0, x1, y1};
    const Box *clip = &canvas->clip;
    if (!(width > 0) || width > CANVAS_MAX_WIDTH ||
        !clip_line(clip, width + 1, line))
        return;
    int right = clip->x + clip->width, bottom = clip->y + clip->height;
    double dx = line[2] - line[0], dy = line[3] - line[1];
    LineFrame frame = {.first = canvas->pixels,
                       .red_blue = colour & 0xff00ff,
                       .green = colour & 0x00ff00,
                       .full = opacity(colour)};
    if (fabs(dx) >= fabs(dy)) {
        frame.along = 1;
        frame.across = canvas->width;
        frame.begin = clip->x;
        frame.end = right;
        frame.low = clip->y * FIXED_ONE;
        frame.high = bottom * FIXED_ONE;
        if (dx > 0)
            line_columns(&frame, line[0], line[2], line[1], dy / dx, width);
        else if (dx < 0)
            line_columns(&frame, line[2], line[0], line[3], dy / dx, width);
    } else {
        frame.along = canvas->width;
        frame.across = 1;
        frame.begin = clip->y;
        frame.end = bottom;
        frame.low = clip->x * FIXED_ONE;
        frame.high = right * FIXED_ONE;
        if (dy > 0)
            line_columns(&frame, line[1], line[3], line[0], dx / dy, width);
        else
            line_columns(&frame, line[3], line[1], line[2], dx / dy, width);
    }
}

void canvas_dashes(Canvas *canvas, double x0, double y0, double x1, double y1,
                   double width, double on, double off, double *phase,
                   Colour colour)
{
    double line[4] = {x0, y0, x1, y1}, length = hypot(x1 - x0, y1 - y0);
    double begin = phase ? *phase : 0, period = on + off;
    if (!(length > 0) || !(period > 0) || !isfinite(length))
        return;
    if (phase)
        *phase = fmod(begin + length, period);
    if (!clip_line(&canvas->clip, width + 1, line))
        return;
    double ux = (x1 - x0) / length, uy = (y1 - y0) / length;
    double from = (line[0] - x0) * ux + (line[1] - y0) * uy;
    double to = (line[2] - x0) * ux + (line[3] - y0) * uy;
    for (double k = floor((begin + from) / period); k * period - begin < to;
         k++) {
        double a = fmax(k * period - begin, from);
        double b = fmin(k * period - begin + on, to);
        if (b > a)
            canvas_line(canvas, x0 + a * ux, y0 + a * uy, x0 + b * ux,
                        y0 + b * uy, width, colour);
    }
}
