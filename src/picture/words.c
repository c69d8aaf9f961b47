/* words.c - words of a plot: legend, scale, numbers, labels on free ground. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/colour_map.h"
#include "picture/live_values.h"
#include "picture/plot.h"

enum { LABEL_TEXT_SIZE = 512 }; /* bytes of a label */

static const double LEGEND_SIZE = 0.92; /* ems */
/* The scale bar is at least this part of the stage's width long. */
static const double SCALE_PART = 0.08;
static const double MAX_PIXEL = 1e6;   /* pixels, farthest labelled point */
static const double LINE_HEIGHT = 1.3; /* ems, height of a label */
/* Costs of a label's place on ink or other words, outside of the plot, or far
 * from its point, and for each place before in the list. */
static const double COST_INK = 60, COST_OUTSIDE = 30, COST_FAR = 2.5,
                    COST_LATER = 0.04;
static const double LABEL_MARGIN = 0.2; /* ems, free margin of a label */
/* Ems, from point to label: near and far. */
static const double LABEL_DISTANCE[] = {0.8, 2};
static const Colour INK = 190; /* a pixel with a channel below this is ink */

/* ---- numbers ------------------------------------------------------------ */

NumberText format_digits(double value, int digits)
{
    NumberText out;
    size_t size = sizeof out.text;
    char plain[26];
    const char *sign = value < 0 ? "\u2212" : "";
    double most = fabs(value), large = fmax(1e5, pow(10, digits) - 0.5);
    snprintf(plain, sizeof plain, "%.*e", digits - 1, most);
    if (!isfinite(value)) {
        snprintf(out.text, size, "%s%s", sign,
                 isnan(value) ? "no number" : "\u221e");
    } else if (most == 0 || (most >= 1e-3 && most < large)) {
        snprintf(out.text, size, "%s%.15g", sign, strtod(plain, NULL));
    } else {
        char *power = strchr(plain, 'e');
        int exponent = (int)strtol(power + 1, NULL, 10);
        *power = '\0';
        double part = strtod(plain, NULL);
        snprintf(plain, sizeof plain, "%.15g\u00b7", part);
        snprintf(out.text, size, "%s%s10^{%s%d}", sign, part == 1 ? "" : plain,
                 exponent < 0 ? "\u2212" : "", abs(exponent));
    }
    return out;
}

NumberText format_number(double value)
{
    return format_digits(value, 3);
}

NumberText format_power(const char *value)
{
    char *rest;
    double number = strtod(value, &rest);
    const char *power = strchr(value, 'e');
    NumberText out;
    if (power && power < rest && *rest != '_')
        snprintf(out.text, sizeof out.text, "%.30s%.16s",
                 format_digits(number, 6).text, rest);
    else
        snprintf(out.text, sizeof out.text, "%.47s", value);
    return out;
}

/* ---- scale and legend ---------------------------------------------------- */

void plot_scale(const Plot *plot)
{
    Paper *paper = plot->paper;
    double scale = plot->camera.scale[0];
    double metres = plot_round_up(SCALE_PART * plot->box.width / scale);
    double length = metres * scale;
    Box line = {plot->box.x + paper_pixels(paper, 1),
                plot->box.y + plot->box.height - paper_pixels(paper, 0.9),
                (int)length, (int)(1.5 * paper->unit) + 1};
    if (!(length > 4) || !isfinite(length) || length > 0.6 * plot->box.width)
        return;
    canvas_fill(&paper->canvas, box_inset(line, -paper_pixels(paper, 0.3)),
                COLOUR_PANEL);
    paper_write_on_panel(paper, FACE_REGULAR, 0.85, COLOUR_FAINT,
                         line.x + 0.5 * length, line.y - 1.4 * paper->em,
                         ALIGN_CENTRE, "%s m", format_number(metres).text);
    canvas_fill(&paper->canvas, line, COLOUR_GREY);
}

void plot_legend(Plot *plot, Colour colour, const char *format, ...)
{
    Plot room = *plot;
    TextLine line = {.colour = colour};
    double em = plot->paper->em;
    write_formatted(line.text, sizeof line.text, format);
    room.box.x += (int)(0.9 * em);
    room.box.y += (int)(0.6 * em);
    room.box.width -= (int)(1.8 * em);
    card_write_lines(&room, plot->legend_pixel, LEGEND_SIZE, 1.6, &line, true);
}

/* ---- labels -------------------------------------------------------------- */

double plot_label_cost(const Plot *plot, Box place)
{
    const Canvas *canvas = &plot->paper->canvas;
    Box seen = box_intersect(place, box_intersect(plot->box, canvas->clip));
    double area = (double)place.width * place.height, ink = 0;
    for (int y = seen.y; y < seen.y + seen.height; y++)
        for (int x = seen.x; x < seen.x + seen.width; x++) {
            Colour pixel = canvas->pixels[y * canvas->width + x];
            ink += (pixel & 255) < INK || (pixel >> 8 & 255) < INK ||
                   (pixel >> 16 & 255) < INK;
        }
    for (int i = 0; i < plot->paper->word_count && i < MAX_WORD_BOXES; i++) {
        Box both = box_intersect(seen, plot->paper->word_boxes[i]);
        ink += both.width > 0 ? (double)both.width * both.height : 0;
    }
    return (COST_INK * ink - COST_OUTSIDE * seen.width * seen.height) / area +
           COST_OUTSIDE;
}

void plot_label(const Plot *plot, int points, const double *at, Colour colour,
                const char *format, ...)
{
    Paper *paper = plot->paper;
    char words[LABEL_TEXT_SIZE];
    if (!plot->has_text)
        return;
    write_formatted(words, sizeof words, format);
    /* directions: right, left, below, above, then the corners */
    static const int side[8][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                   {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    int wide = paper_measure(paper, FACE_BOLD, 1, words);
    int high = (int)ceil(LINE_HEIGHT * paper->em);
    Box best = {0, 0, wide, high};
    double least = INFINITY;
    for (int i = 0; i < 16 * points; i++) {
        const int *to = side[i % 8];
        int far = i / 8 % 2;
        double p[2];
        plot_to_pixel(plot, at + i / 16 * 2, p);
        if (!(fabs(p[0]) < MAX_PIXEL && fabs(p[1]) < MAX_PIXEL))
            continue;
        double apart = (i % 8 < 4 ? 1 : 0.7) * LABEL_DISTANCE[far] * paper->em;
        Box place = {(int)(p[0] + to[0] * (apart + 0.5 * wide) - 0.5 * wide),
                     (int)(p[1] + to[1] * (apart + 0.5 * high) - 0.5 * high),
                     wide, high};
        Box wider = box_inset(place, -paper_pixels(paper, LABEL_MARGIN));
        double cost =
            plot_label_cost(plot, wider) + COST_FAR * far + COST_LATER * i;
        if (cost < least) {
            least = cost;
            best = place;
        }
    }
    if (wide < 1 || !isfinite(least))
        return;
    Box panel = {best.x - 1, best.y + high / 8, wide + 2, high - high / 4};
    canvas_fill(&paper->canvas, panel, COLOUR_PANEL);
    paper_keep_word_box(paper, panel);
    paper_write(paper, FACE_BOLD, 1, colour, best.x, best.y, ALIGN_LEFT, "%s",
                words);
}
