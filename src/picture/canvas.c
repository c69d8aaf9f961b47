/* canvas.c - anti-aliased shapes on a picture in memory.
 *
 * Lines take most of a frame's time and are computed in fixed point. */
#include "picture/canvas.h"
#include "base/mathematics.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_LINE_WIDTH = 4096 };    /* pixels, largest width of a line */
enum { MAX_COORDINATE = 1 << 29 }; /* pixels, limit of clamped coordinates */

/* Fixed point numbers have 16 bits before and after the binary point. */
enum { FRACTION_BITS = 16, FIXED_ONE = 1 << FRACTION_BITS };

/* Blends two colours: below + (above - below) amount / 256.  Red and blue share
 * a multiplication; masks remove bits that one colour puts into the next. */
static inline uint32_t blend_pixel(uint32_t below, uint32_t above,
                                   uint32_t amount)
{
    uint32_t red_blue = below & 0xff00ff, green = below & 0x00ff00;
    red_blue += ((above & 0xff00ff) - red_blue) * amount >> 8;
    green += ((above & 0x00ff00) - green) * amount >> 8;
    return 0xff000000u | (red_blue & 0xff00ff) | (green & 0x00ff00);
}

/* Converts the colour's alpha 0 ... 255 to 0 ... 256. */
static inline uint32_t find_opacity(Colour colour)
{
    uint32_t alpha = colour >> 24;
    return alpha + (alpha >> 7);
}

Colour colour_mix(Colour one, Colour other, double part)
{
    return blend_pixel(one, other, (uint32_t)(256 * part));
}

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
    canvas->clip = (Box){0, 0, width, height};
    canvas_clear(canvas, 0xffffffff);
    return STATUS_OK;
}

void canvas_free(Canvas *canvas)
{
    free(canvas->pixels);
    *canvas = (Canvas){0};
}

/* Sets row [count] to a colour; memset is faster if all bytes are equal. */
static void fill_pixels(uint32_t *row, size_t count, uint32_t colour)
{
    if (colour == (colour & 0xff) * 0x01010101u)
        memset(row, (int)(colour & 0xff), count * sizeof *row);
    else
        for (size_t i = 0; i < count; i++)
            row[i] = colour;
}

void canvas_clear(Canvas *canvas, Colour colour)
{
    fill_pixels(canvas->pixels, (size_t)canvas->width * (size_t)canvas->height,
                colour | 0xff000000u);
}

/* MIN and MAX are b if a or b is NaN, and are faster than fmin and fmax. */
#define MIN(a, b) ((a) < (b) ? (a) : (b))
#define MAX(a, b) ((a) > (b) ? (a) : (b))

/* Returns the pixels of clip that a rectangle touches; clip.x, clip.y >= 0. */
static Box find_touched_pixels(Box clip, double left, double top, double right,
                               double bottom)
{
    double x0 = MAX(left, clip.x), x1 = MIN(right, clip.x + clip.width);
    double y0 = MAX(top, clip.y), y1 = MIN(bottom, clip.y + clip.height);
    if (!(x1 >= x0) || !(y1 >= y0))
        return (Box){0, 0, 0, 0};
    int x = (int)x0, y = (int)y0, right_end = (int)x1, low_end = (int)y1;
    return (Box){x, y, right_end + (right_end < x1) - x,
                 low_end + (low_end < y1) - y};
}

int pixel_from_coordinate(double place)
{
    return (int)fmin(fmax(place, -MAX_COORDINATE), MAX_COORDINATE);
}

Box box_inset(Box box, int margin)
{
    int width = box.width - 2 * margin, height = box.height - 2 * margin;
    return (Box){box.x + margin, box.y + margin, width > 0 ? width : 0,
                 height > 0 ? height : 0};
}

Box box_cut_off(Box *rest, BoxEdge edge, int pixels)
{
    Box strip = *rest;
    bool across = edge == EDGE_LEFT || edge == EDGE_RIGHT;
    *(across ? &strip.width : &strip.height) = pixels;
    *(across ? &rest->width : &rest->height) -= pixels;
    strip.x += edge == EDGE_RIGHT ? rest->width : 0;
    strip.y += edge == EDGE_BOTTOM ? rest->height : 0;
    rest->x += edge == EDGE_LEFT ? pixels : 0;
    rest->y += edge == EDGE_TOP ? pixels : 0;
    return strip;
}

bool box_contains(Box box, double x, double y)
{
    return x >= box.x && x < box.x + box.width && y >= box.y &&
           y < box.y + box.height;
}

Box box_intersect(Box a, Box b)
{
    return find_touched_pixels(a, b.x, b.y, (double)b.x + b.width,
                               (double)b.y + b.height);
}

Box canvas_set_clip(Canvas *canvas, Box box)
{
    Box before = canvas->clip, whole = {0, 0, canvas->width, canvas->height};
    canvas->clip = box_intersect(whole, box);
    return before;
}

static uint32_t *get_pixel_row(const Canvas *canvas, int y)
{
    return canvas->pixels + (size_t)y * (size_t)canvas->width;
}

/* Mixes the colour into pixels left ... right - 1 of a row. */
static void blend_span(uint32_t *row, int left, int right, Colour colour,
                       uint32_t amount)
{
    if (amount == 0 || left >= right)
        return;
    if (amount == 256)
        fill_pixels(row + left, (size_t)(right - left), 0xff000000u | colour);
    else
        for (int i = left; i < right; i++)
            row[i] = blend_pixel(row[i], colour, amount);
}

void canvas_fill(Canvas *canvas, Box box, Colour colour)
{
    Box seen = box_intersect(canvas->clip, box);
    for (int j = seen.y; j < seen.y + seen.height; j++)
        blend_span(get_pixel_row(canvas, j), seen.x, seen.x + seen.width,
                   colour, find_opacity(colour));
}

void canvas_framed_box(Canvas *canvas, Box box, Colour fill, Colour border)
{
    canvas_fill(canvas, box, border);
    canvas_fill(canvas, box_inset(box, 1), fill);
}

/* ---- lines -------------------------------------------------------------- */

bool box_clip_line(const Box *box, double margin, double line[4])
{
    double left = box->x - margin, right = box->x + box->width + margin;
    double top = box->y - margin, bottom = box->y + box->height + margin;
    if (line[0] >= left && line[2] >= left && line[0] <= right &&
        line[2] <= right && line[1] >= top && line[3] >= top &&
        line[1] <= bottom && line[3] <= bottom)
        return true; /* the line lies inside, as most lines do */
    double dx = line[2] - line[0], dy = line[3] - line[1], t0 = 0, t1 = 1;
    /* The line's point at t = 0 ... 1 is inside if p[k] t <= q[k] for all k. */
    const double p[4] = {-dx, dx, -dy, dy};
    const double q[4] = {line[0] - left, right - line[0], line[1] - top,
                         bottom - line[1]};
    for (int k = 0; k < 4; k++) {
        if (!isfinite(p[k]) || (p[k] == 0 && q[k] < 0))
            return false;
        if (p[k] < 0)
            t0 = fmax(t0, q[k] / p[k]);
        if (p[k] > 0)
            t1 = fmin(t1, q[k] / p[k]);
    }
    line[2] = line[0] + t1 * dx;
    line[3] = line[1] + t1 * dy;
    line[0] += t0 * dx;
    line[1] += t0 * dy;
    return t0 <= t1;
}

/* Blends the colour into the pixels of a column between low and high > low.
 *   across     distance in memory from a pixel of the column to the next
 *   low, high  rows in fixed point */
static inline void blend_column(uint32_t *column, ptrdiff_t across, int low,
                                int high, Colour colour, uint32_t amount)
{
    int row = low >> FRACTION_BITS, last = (high - 1) >> FRACTION_BITS;
    uint32_t *p = column + row * across;
    if (row == last) {
        *p = blend_pixel(*p, colour,
                         (uint32_t)(high - low) * amount >> FRACTION_BITS);
        return;
    }
    uint32_t part = (uint32_t)(FIXED_ONE - (low & (FIXED_ONE - 1)));
    *p = blend_pixel(*p, colour, part * amount >> FRACTION_BITS);
    for (p += across; ++row < last; p += across)
        *p = blend_pixel(*p, colour, amount);
    part = (uint32_t)(high - last * FIXED_ONE);
    *p = blend_pixel(*p, colour, part * amount >> FRACTION_BITS);
}

/* Loops along axis k: columns, or rows of a steep line; j is the other axis. */
void canvas_line(Canvas *canvas, double x0, double y0, double x1, double y1,
                 double width, Colour colour)
{
    double line[4] = {x0, y0, x1, y1};
    const Box *clip = &canvas->clip;
    if (!(width > 0) || width > MAX_LINE_WIDTH ||
        !box_clip_line(clip, width + 1, line))
        return;
    const double d[2] = {line[2] - line[0], line[3] - line[1]};
    const int first[2] = {clip->x, clip->y};
    const int behind[2] = {clip->x + clip->width, clip->y + clip->height};
    /* Distance in memory to the next pixel along x and along y. */
    const ptrdiff_t next[2] = {1, canvas->width};
    int k = fabs(d[0]) >= fabs(d[1]) ? 0 : 1, j = 1 - k,
        back = d[k] > 0 ? 0 : 2;
    if (d[k] == 0)
        return;
    double from = line[back + k], slope = d[j] / d[k];
    int start = (int)(from * FIXED_ONE);
    int stop = (int)(line[2 - back + k] * FIXED_ONE);
    int begin = MAX(start >> FRACTION_BITS, first[k]);
    int end = MIN((stop + FIXED_ONE - 1) >> FRACTION_BITS, behind[k]);
    int reach = (int)(0.5 * width * sqrt(1 + slope * slope) * FIXED_ONE);
    int middle =
        (int)((line[back + j] + (begin + 0.5 - from) * slope) * FIXED_ONE);
    int step = (int)(slope * FIXED_ONE);
    uint32_t full = find_opacity(colour),
             *column = canvas->pixels + begin * next[k];
    for (int i = begin; i < end; i++, middle += step, column += next[k]) {
        int low = MAX(middle - reach, first[j] * FIXED_ONE);
        int high = MIN(middle + reach, behind[j] * FIXED_ONE);
        uint32_t amount = full;
        /* The first and the last pixel of the line are covered in part. */
        if (i == begin || i + 1 == end) {
            int left = MAX(i * FIXED_ONE, start);
            int right = MIN((i + 1) * FIXED_ONE, stop);
            amount = (uint32_t)(right - left) * amount >> FRACTION_BITS;
        }
        if (low < high)
            blend_column(column, next[j], low, high, colour, amount);
    }
}

void canvas_dashes(Canvas *canvas, const double a[2], const double b[2],
                   double width, double unit, double *phase, Colour colour)
{
    double line[4] = {a[0], a[1], b[0], b[1]}, begin = phase ? *phase : 0;
    double on = 5 * unit, pitch = on + 4 * unit;
    double dx = b[0] - a[0], dy = b[1] - a[1], length = math_hypot(dx, dy);
    if (!(length > 0) || !isfinite(length))
        return;
    if (phase)
        *phase = fmod(begin + length, pitch);
    if (!box_clip_line(&canvas->clip, width + 1, line))
        return;
    dx /= length;
    dy /= length;
    double from = (line[0] - a[0]) * dx + (line[1] - a[1]) * dy;
    double to = (line[2] - a[0]) * dx + (line[3] - a[1]) * dy;
    double k = floor((begin + from) / pitch) * pitch - begin;
    for (; k < to; k += pitch) {
        double s = fmax(k, from), t = fmin(k + on, to);
        if (t > s)
            canvas_line(canvas, a[0] + s * dx, a[1] + s * dy, a[0] + t * dx,
                        a[1] + t * dy, width, colour);
    }
}

void canvas_arrow(Canvas *canvas, double x0, double y0, double x1, double y1,
                  double width, double head, Colour colour)
{
    double length = math_hypot(x1 - x0, y1 - y0);
    if (!(length > 0) || !isfinite(length))
        return;
    head = fmin(head, 0.7 * length);
    double ux = (x1 - x0) / length, uy = (y1 - y0) / length;
    double bx = x1 - head * ux, by = y1 - head * uy, half = 0.38 * head;
    const double corners[6] = {
        x1, y1, bx - half * uy, by + half * ux, bx + half * uy, by - half * ux};
    canvas_line(canvas, x0, y0, x1 - 0.8 * head * ux, y1 - 0.8 * head * uy,
                width, colour);
    canvas_triangle(canvas, corners, true, colour);
}

/* ---- surfaces ----------------------------------------------------------- */

/* Shrinks [*left, *right) to the pixels i with a i + b >= 0; per_a is 1/a. */
static inline void clip_to_half_plane(double a, double per_a, double b,
                                      int *left, int *right)
{
    double i = -b * per_a; /* root of a i + b; not finite if a is 0 */
    if (a == 0 ? b < 0 : a > 0 ? i > *right : i < *left)
        *left = *right;
    else if (a > 0 && i > *left)
        *left = (int)i + ((int)i < i);
    else if (a < 0 && i < *right - 1)
        *right = (int)i + 1;
}

/* Fills each row from edge to edge.  With smooth edges the coverage of a pixel
 * is the distance to the nearest edge. */
void canvas_triangle(Canvas *canvas, const double c[6], bool smooth,
                     Colour colour)
{
    double edge[3][4]; /* a, b, c, 1/a; a x + b y + c >= 0 is inside */
    double turn = (c[2] - c[0]) * (c[5] - c[1]) - (c[3] - c[1]) * (c[4] - c[0]);
    double reach = smooth ? 1 : 0;
    uint32_t full = find_opacity(colour);
    if (!(fabs(turn) > 1e-12) || !(fabs(turn) < 1e15))
        return;
    Box box = find_touched_pixels(
        canvas->clip, MIN(c[0], MIN(c[2], c[4])) - reach,
        MIN(c[1], MIN(c[3], c[5])) - reach, MAX(c[0], MAX(c[2], c[4])) + reach,
        MAX(c[1], MAX(c[3], c[5])) + reach);
    for (int k = 0; k < 3; k++) {
        const double *p = c + 2 * k, *q = c + 2 * ((k + 1) % 3);
        double dx = q[0] - p[0], dy = q[1] - p[1];
        double n = turn > 0 ? 1 : -1;
        if (smooth)
            n /= math_hypot(dx, dy); /* a x + b y + c is a distance */
        edge[k][0] = -dy * n;
        edge[k][1] = dx * n;
        edge[k][2] = (dy * p[0] - dx * p[1]) * n;
        edge[k][3] = 1 / edge[k][0];
    }
    for (int j = box.y; j < box.y + box.height; j++) {
        uint32_t *row = get_pixel_row(canvas, j);
        int left = box.x, right = box.x + box.width;
        double first[3]; /* a x + b y + c at the row's first pixel */
        for (int k = 0; k < 3; k++) {
            first[k] = edge[k][0] * 0.5 + edge[k][1] * (j + 0.5) + edge[k][2];
            clip_to_half_plane(edge[k][0], edge[k][3],
                               first[k] + 0.5 * reach + 1e-9, &left, &right);
        }
        if (!smooth)
            blend_span(row, left, right, colour, full);
        for (int i = left; smooth && i < right; i++) {
            double inside = 0.5; /* distance from nearest edge, <= 1/2 */
            for (int k = 0; k < 3; k++)
                inside = MIN(inside, edge[k][0] * i + first[k]);
            row[i] = blend_pixel(row[i], colour,
                                 (uint32_t)(MAX(inside + 0.5, 0) * full + 0.5));
        }
    }
}

/* The coverage of a pixel follows from its distances to the outer and the inner
 * circle; a disc has no inner circle. */
void canvas_ring(Canvas *canvas, double x, double y, double radius,
                 double width, Colour colour)
{
    double far = radius + 0.5 * width + 0.5, near = radius - 0.5 * width - 0.5;
    double out2 = far * far, in2 = near > 0 ? near * near : -1;
    bool disc = near <= -0.5;
    if (!(radius > 0) || !(fabs(x) < 1e6) || !(fabs(y) < 1e6) ||
        !(radius < 1e6))
        return;
    Box box =
        find_touched_pixels(canvas->clip, x - far, y - far, x + far, y + far);
    uint32_t full = find_opacity(colour);
    for (int j = box.y; j < box.y + box.height; j++) {
        uint32_t *row = get_pixel_row(canvas, j);
        double dy = j + 0.5 - y;
        for (int i = box.x; i < box.x + box.width; i++) {
            double dx = i + 0.5 - x, d2 = dx * dx + dy * dy;
            if (d2 <= in2 || d2 >= out2)
                continue;
            double d = sqrt(d2), part = MIN(far - d, 1);
            part = disc ? part : MIN(part, d - near);
            row[i] = blend_pixel(row[i], colour, (uint32_t)(part * full + 0.5));
        }
    }
}

void canvas_disc(Canvas *canvas, double x, double y, double radius,
                 Colour colour)
{
    canvas_ring(canvas, x, y, 0.5 * radius, radius, colour);
}

void canvas_fill_mask(Canvas *canvas, int x, int y, int width, int height,
                      const uint8_t *mask, Colour colour)
{
    uint32_t full = find_opacity(colour);
    Box box = find_touched_pixels(canvas->clip, x, y, x + width, y + height);
    for (int j = box.y; j < box.y + box.height; j++) {
        uint32_t *row = get_pixel_row(canvas, j);
        const uint8_t *part = mask + (size_t)(j - y) * (size_t)width;
        for (int i = box.x; i < box.x + box.width; i++) {
            uint32_t amount = part[i - x];
            if (amount == 0)
                continue;
            amount += amount >> 7;
            row[i] = blend_pixel(row[i], colour, amount * full >> 8);
        }
    }
}
