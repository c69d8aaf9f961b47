#include "picture/plot.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/colour_map.h"

enum {
    PLOT_TEXT = 512,     /* bytes of a text with numbers */
    PLOT_INTERVALS = 4,  /* between numbers, upwards */
    PLOT_MOST_LINES = 40 /* of any axis */
};

static const double TICK_SIZE = 0.82;    /* ems, letters at the axes */
static const double TICK_ROOM = 5;       /* ems, a number to the right needs */
static const double NUMBER_ROOM = 3.1;   /* ems, left of the plot */
static const double BELOW_ROOM = 1.5;    /* ems, below it */
static const double NUMBER_BELOW = 0.25; /* ems, from the plot to a number */

double plot_round_up(double value)
{
    double power = pow(10, floor(log10(value)));
    double part = value / power * (1 - 1e-12);
    return power * (part <= 1 ? 1 : part <= 2 ? 2 : part <= 5 ? 5 : 10);
}

/* The smallest multiple of the distance of its numbers. */
double plot_round_axis(double value)
{
    double step = plot_round_up(value / PLOT_INTERVALS);
    return step * ceil(value / step * (1 - 1e-12));
}

/* 0 at the low end of an axis, 1 at the high one. */
static double axis_part(const Axis *axis, double value)
{
    if (axis->log)
        return log10(value / axis->low) / log10(axis->high / axis->low);
    return (value - axis->low) / (axis->high - axis->low);
}

void plot_place(const Plot *plot, double x, double y, double place[2])
{
    double a = axis_part(&plot->x, x), b = axis_part(&plot->y, y);
    place[0] = plot->box.x + a * plot->box.width;
    place[1] = plot->box.y + (1 - b) * plot->box.height;
}

/* Three digits; a power of ten where there would be many zeros. */
void plot_number(char *text, size_t size, double value)
{
    char plain[32];
    double most = fabs(value);
    const char *sign = value < 0 ? "\u2212" : "";
    if (!isfinite(value)) {
        snprintf(text, size, "%s%s", isnan(value) ? "" : sign,
                 isnan(value) ? "no number" : "\u221e");
        return;
    }
    snprintf(plain, sizeof plain, "%.2e", most);
    char *power = strchr(plain, 'e');
    if (!power || (most >= 1e-3 && most < 1e5) || most == 0) {
        bool long_number = most >= 999.5; /* with three digits: 1000 */
        double digit = long_number ? pow(10, floor(log10(most)) - 2) : 1;
        if (long_number)
            snprintf(plain, sizeof plain, "%.0f",
                     floor(most / digit + 0.5) * digit);
        else
            snprintf(plain, sizeof plain, "%.3g", most);
        snprintf(text, size, "%s%s", sign, plain);
        return;
    }
    int exponent = (int)strtol(power + 1, NULL, 10);
    snprintf(plain, sizeof plain, "%.3g", most / pow(10, exponent));
    if (strcmp(plain, "10") == 0) {
        strcpy(plain, "1");
        exponent++;
    }
    bool one = strcmp(plain, "1") == 0;
    snprintf(text, size, "%s%s%s10^{%s%d}", sign, one ? "" : plain,
             one ? "" : "\u00b7", exponent < 0 ? "\u2212" : "", abs(exponent));
}

/* The part from e on of "1e-06" as markup; returns where it ends. */
static const char *power_text(const char *power, bool one, char *text,
                              size_t size)
{
    char *end;
    long exponent = strtol(power + 1, &end, 10);
    snprintf(text, size, "%s10^{%s%ld}", one ? "" : "\u00b7",
             exponent < 0 ? "\u2212" : "", labs(exponent));
    return end;
}

void plot_numbers(char *text, size_t size)
{
    char out[PLOT_TEXT] = "";
    size_t used = 0;
    const char *from = text;
    bool word = false; /* within a word, digits are no number */
    while (*from && used + 32 < sizeof out) {
        bool minus = *from == '-' && !word && isdigit((unsigned char)from[1]);
        const char *digits = from + minus;
        size_t length = strspn(digits, "0123456789.");
        if (word || length == 0) {
            word = isalpha((unsigned char)*from) || (*from & 0x80) ||
                   (word && isdigit((unsigned char)*from));
            out[used++] = *from++;
            continue;
        }
        const char *after = digits + length;
        bool power = *after == 'e' && (after[1] == '-' || after[1] == '+') &&
                     isdigit((unsigned char)after[2]);
        bool one = power && length == 1 && *digits == '1';
        if (length > 24)
            break;
        used += (size_t)snprintf(out + used, sizeof out - used, "%s%.*s",
                                 minus ? "\u2212" : "", one ? 0 : (int)length,
                                 digits);
        if (power)
            after = power_text(after, one, out + used, sizeof out - used);
        used += strlen(out + used);
        from = after;
    }
    out[used] = '\0';
    snprintf(text, size, "%s", out);
}

/* A number of an axis; rounding must not show as 1e-17. */
static void format_tick(char *text, size_t size, const Axis *axis, double value)
{
    double span = axis->high - axis->low;
    bool nothing = !axis->log && fabs(value) < 1e-9 * span;
    plot_number(text, size, nothing ? 0 : value);
}

/* The values that carry a number on this axis; returns how many. */
static int axis_ticks(const Axis *axis, double intervals, double *ticks)
{
    int count = 0;
    if (!(axis->high > axis->low) || (axis->log && !(axis->low > 0)))
        return 0;
    if (axis->log) {
        int low = (int)ceil(log10(axis->low) - 1e-9);
        int high = (int)floor(log10(axis->high) + 1e-9);
        int step = (int)ceil((high - low) / intervals);
        step = step < 1 ? 1 : step;
        for (int k = low; k <= high && count < PLOT_MOST_LINES; k += step)
            ticks[count++] = pow(10, k);
        return count;
    }
    double step = plot_round_up((axis->high - axis->low) / intervals);
    if (axis->whole)
        step = fmax(step, 1);
    for (double k = ceil(axis->low / step - 1e-9);
         k * step <= axis->high + 1e-9 * step && count < PLOT_MOST_LINES; k++)
        ticks[count++] = k * step;
    return count;
}

/* Numbers below, the label at the end of the axis. */
static void draw_x_axis(Paper *paper, const Plot *plot)
{
    const Box *box = &plot->box;
    double ticks[PLOT_MOST_LINES], at[2];
    double room = box->width / (TICK_ROOM * paper->em);
    int count = axis_ticks(&plot->x, fmin(fmax(room, 2), 8), ticks);
    double y = box->y + box->height + NUMBER_BELOW * paper->em;
    int right = box->x + box->width;
    if (plot->x.label)
        right -= paper_width(paper, FACE_REGULAR, TICK_SIZE, plot->x.label) +
                 paper_pixels(paper, 0.5);
    for (int i = 0; i < count; i++) {
        char number[48];
        format_tick(number, sizeof number, &plot->x, ticks[i]);
        plot_place(plot, ticks[i], plot->y.low, at);
        int half = paper_width(paper, FACE_REGULAR, TICK_SIZE, number) / 2;
        if (at[0] + half > right)
            continue;
        paper_write(paper, FACE_REGULAR, TICK_SIZE, COLOUR_FAINT, at[0], y,
                    ALIGN_CENTRE, "%s", number);
    }
    if (plot->x.label)
        paper_write(paper, FACE_REGULAR, TICK_SIZE, COLOUR_TEXT,
                    box->x + box->width, y, ALIGN_RIGHT, "%s", plot->x.label);
}

/* Light lines across with their numbers on the left; 0 is darker. */
static void draw_y_axis(Paper *paper, const Plot *plot)
{
    const Box *box = &plot->box;
    double ticks[PLOT_MOST_LINES], at[2];
    double room = box->height / (1.6 * paper->em);
    int count =
        axis_ticks(&plot->y, fmin(fmax(room, 1), PLOT_INTERVALS), ticks);
    double x = box->x - 0.35 * paper->em;
    for (int i = 0; i < count; i++) {
        char number[48];
        bool zero = !plot->y.log && fabs(ticks[i]) < 1e-12 * plot->y.high;
        format_tick(number, sizeof number, &plot->y, ticks[i]);
        plot_place(plot, plot->x.low, ticks[i], at);
        double row = floor(at[1]) + 0.5; /* sharp on the screen */
        canvas_line(&paper->canvas, box->x, row, box->x + box->width, row,
                    fmax(1, floor(paper->unit)),
                    zero ? COLOUR_BORDER : COLOUR_GRID);
        paper_write(paper, FACE_REGULAR, TICK_SIZE, COLOUR_FAINT, x,
                    at[1] - 0.65 * TICK_SIZE * paper->em, ALIGN_RIGHT, "%s",
                    number);
    }
    if (plot->y.label && box->height > 1.6 * TICK_SIZE * paper->em)
        paper_write(paper, FACE_REGULAR, TICK_SIZE, COLOUR_TEXT,
                    box->x + box->width, box->y + 0.1 * paper->em, ALIGN_RIGHT,
                    "%s", plot->y.label);
}

void plot_axes(Paper *paper, const Plot *plot)
{
    draw_y_axis(paper, plot);
    draw_x_axis(paper, plot);
}

/* Pixels left of the plot: the widest number of the axis beyond the usual
 * ones. */
static int number_room(Paper *paper, const Axis *axis, int height)
{
    double ticks[PLOT_MOST_LINES], room = height / (1.6 * paper->em);
    int most = paper_pixels(paper, NUMBER_ROOM);
    int count = axis_ticks(axis, fmin(fmax(room, 1), PLOT_INTERVALS), ticks);
    for (int i = 0; i < count; i++) {
        char number[48];
        format_tick(number, sizeof number, axis, ticks[i]);
        int width = paper_width(paper, FACE_REGULAR, TICK_SIZE, number) +
                    paper_pixels(paper, 0.4);
        most = width > most ? width : most;
    }
    return most;
}

Plot plot_create(Paper *paper, Box outer, Axis x, Axis y)
{
    int left = number_room(paper, &y, outer.height);
    int below = paper_pixels(paper, BELOW_ROOM);
    int above = paper_pixels(paper, 0.5), right = paper_pixels(paper, 0.6);
    Plot plot = {{outer.x + left, outer.y + above, outer.width - left - right,
                  outer.height - above - below},
                 x,
                 y};
    plot.box.width = plot.box.width < 1 ? 1 : plot.box.width;
    plot.box.height = plot.box.height < 1 ? 1 : plot.box.height;
    plot_axes(paper, &plot);
    return plot;
}

/* Cuts the part of a ... b off that is beyond low ... high in coordinate k;
 * false: nothing is left. */
static bool cut_line(double a[2], double b[2], int k, double low, double high)
{
    double *ends[2] = {a, b};
    if ((a[k] < low && b[k] < low) || (a[k] > high && b[k] > high))
        return false;
    for (int i = 0; i < 2; i++) {
        double *end = ends[i], *other = ends[1 - i];
        double limit = fmin(fmax(end[k], low), high);
        if (end[k] == limit)
            continue;
        double t = (limit - end[k]) / (other[k] - end[k]);
        end[1 - k] += t * (other[1 - k] - end[1 - k]);
        end[k] = limit;
    }
    return true;
}

/* Cut in both directions; NaN draws nothing. */
void plot_line(Paper *paper, const Plot *plot, const double *a, const double *b,
               double width, Colour colour)
{
    double p[2], q[2];
    const Box *box = &plot->box;
    plot_place(plot, a[0], a[1], p);
    plot_place(plot, b[0], b[1], q);
    if (!isfinite(p[0] + p[1]) || !isfinite(q[0] + q[1]))
        return;
    if (cut_line(p, q, 0, box->x, box->x + box->width) &&
        cut_line(p, q, 1, box->y, box->y + box->height))
        paper_line(paper, p, q, width, colour);
}

bool plot_disc(Paper *paper, const Plot *plot, const double *a, double radius,
               Colour colour)
{
    double at[2];
    if (!(a[0] >= plot->x.low && a[0] <= plot->x.high && a[1] >= plot->y.low &&
          a[1] <= plot->y.high))
        return false;
    plot_place(plot, a[0], a[1], at);
    canvas_disc(&paper->canvas, at[0], at[1], radius * paper->unit, colour);
    return true;
}

void plot_hollow(Paper *paper, const Plot *plot, const double *a, double radius,
                 double inner, Colour colour)
{
    if (plot_disc(paper, plot, a, radius, colour))
        plot_disc(paper, plot, a, inner, COLOUR_WHITE);
}

/* Moves the end of a line from p to q to the middle between two pixels of the
 * direction in which it is longer, so that the next line begins where no pixel
 * is covered by parts of both: their joint would be paler. */
static void end_between_pixels(const double p[2], double q[2])
{
    double dx = q[0] - p[0], dy = q[1] - p[1];
    int k = fabs(dx) >= fabs(dy) ? 0 : 1;
    double along = k == 0 ? dx : dy, across = k == 0 ? dy : dx;
    double end = floor(q[k] + 0.5);
    q[1 - k] += (end - q[k]) * across / along;
    q[k] = end;
}

void plot_curve(Paper *paper, const Plot *plot, int count, const double *x,
                const double *y, double width, Colour colour)
{
    const Box *box = &plot->box;
    double p[2] = {NAN, NAN};
    for (int i = 0; i < count; i++) {
        double q[2], a[2], b[2];
        plot_place(plot, x[i], y[i], q);
        bool joined = isfinite(p[0] + p[1]) && isfinite(q[0] + q[1]);
        if (joined) {
            if (fabs(q[0] - p[0]) < 1 && fabs(q[1] - p[1]) < 1 && i + 1 < count)
                continue; /* less than a pixel: wait for the next point */
            end_between_pixels(p, q);
            memcpy(a, p, sizeof a);
            memcpy(b, q, sizeof b);
            if (cut_line(a, b, 0, box->x, box->x + box->width) &&
                cut_line(a, b, 1, box->y, box->y + box->height))
                paper_line(paper, a, b, width, colour);
        }
        memcpy(p, q, sizeof p);
    }
}
