#include "picture/canvas.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "base/wide.h"
#include "picture/blend.h"

/* Numbers of 16 bits before and 16 bits after the binary point. */
enum { FIXED_BITS = 16, FIXED_ONE = 1 << FIXED_BITS };

/* A line with its long direction as the first axis: a is along, b across.
 * Pixel (i, j) in these axes is first[i * along + j * across]. */
typedef struct LineFrame {
    uint32_t *first;
    ptrdiff_t along, across;  /* distances in pixels[] */
    int first_begin;          /* clip along, */
    int begin, end;           /* and what of it is drawn */
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

/* Whether a line is above or below all rows from top to bottom: most lines are,
 * of a band of the picture. */
static inline bool is_beyond(double y0, double y1, int top, int bottom,
                             double margin)
{
    return (y0 < top - margin && y1 < top - margin) ||
           (y0 > bottom + margin && y1 > bottom + margin);
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

/* A line in fixed point, in the axes of its frame: most lines are a few pixels
 * long, and whole numbers are fast there. */
typedef struct LineRun {
    int from, to;   /* its ends along, fixed point */
    int begin, end; /* columns that it touches */
    int b, step;    /* its middle in column `begin`, and from one to the next */
    int reach;      /* from the middle to a rim, across */
} LineRun;

/* From a0 to a1 > a0, |slope| <= 1, b = b0 at a0; columns before `least` are
 * left out. */
static inline LineRun line_run(double a0, double a1, double b0, double slope,
                               double width, int least)
{
    LineRun run = {.from = (int)(a0 * FIXED_ONE), .to = (int)(a1 * FIXED_ONE)};
    run.begin = run.from >> FIXED_BITS;
    run.begin = run.begin < least ? least : run.begin;
    run.end = (run.to + FIXED_ONE - 1) >> FIXED_BITS;
    run.b = (int)((b0 + (run.begin + 0.5 - a0) * slope) * FIXED_ONE);
    run.step = (int)(slope * FIXED_ONE);
    run.reach = (int)(0.5 * width * sqrt(1 + slope * slope) * FIXED_ONE);
    return run;
}

/* Draws what the clip leaves of it. */
static void line_columns(const LineFrame *frame, double a0, double a1,
                         double b0, double slope, double width)
{
    LineRun run = line_run(a0, a1, b0, slope, width, frame->first_begin);
    int begin = run.begin < frame->begin ? frame->begin : run.begin;
    int end = run.end > frame->end ? frame->end : run.end;
    int reach = run.reach, step = run.step;
    int b = run.b + (begin - run.begin) * step; /* as it is without a band */
    int b_end = b + (end - begin) * step;
    uint32_t *column = frame->first + begin * frame->along;
    bool inside = (b < b_end ? b : b_end) - reach - FIXED_ONE >= frame->low &&
                  (b > b_end ? b : b_end) + reach + FIXED_ONE <= frame->high;
    for (int i = begin; i < end; i++, b += step, column += frame->along) {
        uint32_t amount = frame->full;
        if (i == begin || i + 1 == end) { /* its ends cover parts of pixels */
            int left = i * FIXED_ONE, right = left + FIXED_ONE;
            left = left < run.from ? run.from : left;
            right = right > run.to ? run.to : right;
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
static void clipped_line(const Canvas *canvas, double x0, double y0, double x1,
                         double y1, double width, Colour colour)
{
    double line[4] = {x0, y0, x1, y1};
    const Box *clip = &canvas->clip;
    int top = clip->y + canvas->above;
    int right = clip->x + clip->width;
    int bottom = clip->y + clip->height - canvas->below;
    if (!(width > 0) || width > CANVAS_MAX_WIDTH ||
        is_beyond(y0, y1, top, bottom, width + 1) ||
        !clip_line(clip, width + 1, line))
        return;
    double dx = line[2] - line[0], dy = line[3] - line[1];
    LineFrame frame = {.first = canvas->pixels,
                       .red_blue = colour & 0xff00ff,
                       .green = colour & 0x00ff00,
                       .full = opacity(colour)};
    if (fabs(dx) >= fabs(dy)) {
        frame.along = 1;
        frame.across = canvas->width;
        frame.first_begin = frame.begin = clip->x;
        frame.end = right;
        frame.low = top * FIXED_ONE;
        frame.high = bottom * FIXED_ONE;
        if (dx > 0)
            line_columns(&frame, line[0], line[2], line[1], dy / dx, width);
        else if (dx < 0)
            line_columns(&frame, line[2], line[0], line[3], dy / dx, width);
    } else {
        frame.along = canvas->width;
        frame.across = 1;
        frame.first_begin = clip->y;
        frame.begin = top;
        frame.end = bottom;
        frame.low = clip->x * FIXED_ONE;
        frame.high = right * FIXED_ONE;
        if (dy > 0)
            line_columns(&frame, line[1], line[3], line[0], dx / dy, width);
        else
            line_columns(&frame, line[3], line[1], line[2], dx / dy, width);
    }
}

/* ---- eight pixels at once ----------------------------------------------- */

#if defined(__x86_64__)
#include <immintrin.h>

#define INLINE_EIGHT                                                           \
    __attribute__((target("avx2"), always_inline)) static inline

/* What lines of one colour and width have in common.  A line whose ends are
 * both from low to high touches, with all that is written in one go, pixels
 * of this canvas and of this band alone. */
typedef struct EightPen {
    __m128d low, high;             /* x, y */
    __m256i red_blue, alpha_green; /* of the colour, in 16 bits each */
    __m256i full;                  /* opacity */
    uint32_t *pixels;
    ptrdiff_t row;
    double width;
} EightPen;

INLINE_EIGHT EightPen eight_pen(const Canvas *canvas, double width,
                                Colour colour)
{
    const Box *clip = &canvas->clip;
    double margin = width + 2, right = clip->x + clip->width - 8 - margin;
    if (!(width > 0) || width > 4) /* pixels: they would not be eight across */
        right = -INFINITY;
    return (EightPen){
        .low = _mm_setr_pd(clip->x + margin, clip->y + canvas->above + margin),
        .high =
            _mm_setr_pd(right, clip->y + clip->height - canvas->below - margin),
        .red_blue = _mm256_set1_epi32((int)(colour & 0xff00ff)),
        .alpha_green =
            _mm256_set1_epi32((int)(0xff0000 | (colour >> 8 & 0xff))),
        .full = _mm256_set1_epi32((int)opacity(colour)),
        .pixels = canvas->pixels,
        .row = canvas->width,
        .width = width};
}

/* 0 ... FIXED_ONE: how much of a pixel lies before this distance. */
INLINE_EIGHT __m256i covered(__m256i distance)
{
    return _mm256_min_epi32(_mm256_max_epi32(distance, _mm256_setzero_si256()),
                            _mm256_set1_epi32(FIXED_ONE));
}

/* a b >> FIXED_BITS */
INLINE_EIGHT __m256i fixed_product(__m256i a, __m256i b)
{
    return _mm256_srli_epi32(_mm256_mullo_epi32(a, b), FIXED_BITS);
}

/* Pixels p[0] ... p[7], which the line covers between these distances; amount:
 * where it covers all, 0 ... 256.  The numbers are those of blend(). */
INLINE_EIGHT void mix_eight(uint32_t *p, const EightPen *pen, __m256i near,
                            __m256i far, __m256i amount)
{
    const __m256i mask = _mm256_set1_epi32(0xff00ff);
    __m256i below = _mm256_loadu_si256((const __m256i *)p);
    __m256i part = _mm256_sub_epi32(covered(far), covered(near));
    part = fixed_product(part, amount);
    part = _mm256_or_si256(part, _mm256_slli_epi32(part, 16));
    __m256i rest = _mm256_sub_epi16(_mm256_set1_epi16(256), part);
    __m256i red_blue = _mm256_and_si256(below, mask);
    __m256i alpha_green = _mm256_srli_epi16(below, 8);
    red_blue = _mm256_add_epi16(_mm256_mullo_epi16(red_blue, rest),
                                _mm256_mullo_epi16(pen->red_blue, part));
    alpha_green = _mm256_add_epi16(_mm256_mullo_epi16(alpha_green, rest),
                                   _mm256_mullo_epi16(pen->alpha_green, part));
    _mm256_storeu_si256(
        (__m256i *)p, _mm256_or_si256(_mm256_srli_epi16(red_blue, 8),
                                      _mm256_andnot_si256(mask, alpha_green)));
}

/* Eight columns after the other. */
INLINE_EIGHT void flat_line(const EightPen *pen, LineRun run)
{
    const __m256i one = _mm256_set1_epi32(FIXED_ONE);
    const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    const __m256i rim = _mm256_slli_epi32(lane, FIXED_BITS);
    const __m256i slant = _mm256_mullo_epi32(lane, _mm256_set1_epi32(run.step));
    for (int i = run.begin; i < run.end; i += 8, run.b += 8 * run.step) {
        int columns = run.end - i < 8 ? run.end - i : 8;
        int b = run.b, b_end = b + (columns - 1) * run.step;
        int row = ((b < b_end ? b : b_end) - run.reach) >> FIXED_BITS;
        int last = ((b < b_end ? b_end : b) + run.reach - 1) >> FIXED_BITS;
        __m256i from = _mm256_set1_epi32(run.from - i * FIXED_ONE);
        __m256i to = _mm256_set1_epi32(run.to - i * FIXED_ONE);
        __m256i amount = _mm256_sub_epi32(covered(_mm256_sub_epi32(to, rim)),
                                          covered(_mm256_sub_epi32(from, rim)));
        __m256i near = _mm256_add_epi32(
            slant, _mm256_set1_epi32(b - run.reach - row * FIXED_ONE));
        __m256i far = _mm256_add_epi32(near, _mm256_set1_epi32(2 * run.reach));
        uint32_t *p = pen->pixels + row * pen->row + i;
        amount = fixed_product(amount, pen->full);
        for (; row <= last; row++, p += pen->row) {
            mix_eight(p, pen, near, far, amount);
            near = _mm256_sub_epi32(near, one);
            far = _mm256_sub_epi32(far, one);
        }
    }
}

/* A row after the other. */
INLINE_EIGHT void steep_line(const EightPen *pen, LineRun run)
{
    const __m256i rim = _mm256_slli_epi32(
        _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), FIXED_BITS);
    const __m256i across = _mm256_set1_epi32(2 * run.reach);
    uint32_t *row = pen->pixels + run.begin * pen->row;
    int low = run.b - run.reach;
    for (int i = run.begin; i < run.end;
         i++, low += run.step, row += pen->row) {
        int top = i * FIXED_ONE, bottom = top + FIXED_ONE;
        top = top < run.from ? run.from : top;
        bottom = bottom > run.to ? run.to : bottom;
        int column = low >> FIXED_BITS;
        __m256i near =
            _mm256_sub_epi32(_mm256_set1_epi32(low - column * FIXED_ONE), rim);
        mix_eight(row + column, pen, near, _mm256_add_epi32(near, across),
                  fixed_product(_mm256_set1_epi32(bottom - top), pen->full));
    }
}

/* From a to b; false: not drawn, the clip is too near. */
INLINE_EIGHT bool eight_line(const EightPen *pen, __m128d a, __m128d b)
{
    __m128d inside = _mm_and_pd(
        _mm_and_pd(_mm_cmpge_pd(a, pen->low), _mm_cmple_pd(a, pen->high)),
        _mm_and_pd(_mm_cmpge_pd(b, pen->low), _mm_cmple_pd(b, pen->high)));
    if (_mm_movemask_pd(inside) != 3)
        return false;
    double x0 = a[0], y0 = a[1], x1 = b[0], y1 = b[1], width = pen->width;
    double dx = x1 - x0, dy = y1 - y0;
    if (fabs(dx) >= fabs(dy)) {
        if (dx > 0)
            flat_line(pen, line_run(x0, x1, y0, dy / dx, width, 0));
        else if (dx < 0)
            flat_line(pen, line_run(x1, x0, y1, dy / dx, width, 0));
    } else if (dy > 0) {
        steep_line(pen, line_run(y0, y1, x0, dx / dy, width, 0));
    } else {
        steep_line(pen, line_run(y1, y0, x1, dx / dy, width, 0));
    }
    return true;
}

__attribute__((target("avx2"))) static void
lines_by_eight(const Canvas *canvas, const double *at, const int *ends,
               long count, double width, Colour colour)
{
    const EightPen pen = eight_pen(canvas, width, colour);
    const int top = canvas->clip.y + canvas->above;
    const int bottom = canvas->clip.y + canvas->clip.height - canvas->below;
    for (long k = 0; k < count; k++) {
        const double *a = at + 2 * (size_t)ends[2 * k];
        const double *b = at + 2 * (size_t)ends[2 * k + 1];
        if (is_beyond(a[1], b[1], top, bottom, width + 1))
            continue;
        if (!eight_line(&pen, _mm_loadu_pd(a), _mm_loadu_pd(b)))
            clipped_line(canvas, a[0], a[1], b[0], b[1], width, colour);
    }
}
#endif

bool canvas_has_eights(void)
{
    const char *limit = getenv("ELASTO_LANES");
    return wide_doubles() >= 4 && (!limit || atoi(limit) >= 4);
}

void canvas_lines(Canvas *canvas, const double *at, const int *ends, long count,
                  double width, Colour colour)
{
#if defined(__x86_64__)
    if (canvas->eights) {
        lines_by_eight(canvas, at, ends, count, width, colour);
        return;
    }
#endif
    for (long k = 0; k < count; k++) {
        const double *a = at + 2 * (size_t)ends[2 * k];
        const double *b = at + 2 * (size_t)ends[2 * k + 1];
        clipped_line(canvas, a[0], a[1], b[0], b[1], width, colour);
    }
}

void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1,
                 double width, Colour colour)
{
    const double at[4] = {x0, y0, x1, y1};
    const int ends[2] = {0, 1};
    canvas_lines(canvas, at, ends, 1, width, colour);
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
