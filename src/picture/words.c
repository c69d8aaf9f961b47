/* words.c - words of plots: texts, legend, scale bar, labels in free places. */
#include <limits.h>
#include <math.h>

#include "picture/cards.h"

enum { LABEL_TEXT_SIZE = 512 }; /* bytes of a label */

static const double LEGEND_SIZE = 0.92; /* ems */
/* Least length of the scale bar over the stage's width. */
static const double SCALE_PART = 0.08;
static const double MAX_PIXEL = 1e6;   /* largest x or y of a labelled point */
static const double LINE_HEIGHT = 1.3; /* ems, height of a label */
/* Costs of a place for a label: on ink or other words, outside of the plot, far
 * from its point, and for each place that is tried before this one. */
static const double COST_INK = 60, COST_OUTSIDE = 30, COST_FAR = 2.5,
                    COST_LATER = 0.04;
static const double LABEL_MARGIN = 0.2; /* ems, free of ink around a label */
/* Ems, from point to label: near and far. */
static const double LABEL_DISTANCE[] = {0.8, 2};
static const Colour INK = 190; /* a pixel with a channel below this is ink */

/* ---- texts of cards ------------------------------------------------------ */

/* Draws a line at the upper edge of the box, or only measures it; long lines
 * wrap.  Returns the height in pixels. */
static int draw_text_line(Paper *paper, Box box, double size,
                          const TextLine *line, bool draw)
{
    const double air = 0.2, empty = 0.6; /* ems */
    int high = paper_write_paragraph(paper, line->face, size, line->colour, box,
                                     draw ? INT_MAX : 0, line->text);
    return high + paper_to_pixels(paper, size * (high > 0 ? air : empty));
}

void card_write_text(const Plot *card, const LiveValues *values,
                     const char *text)
{
    Paper *paper = card->paper;
    Box box = card->box;
    double height = 0, size = 1;
    if (card->content->lecture.page) /* larger letters for an audience */
        size = box.width > MAIN_CARD_WIDTH * paper->em ? 1.6 : 1.2;
    const TextLine begin = lines_begin(values, text);
    for (TextLine line = begin; text_next_line(&line);) {
        int width = paper_measure(paper, line.face, 1, line.text);
        height += draw_text_line(paper, box, 1, &line, false);
        if (width > 0)
            size = fmin(size, 0.97 * box.width / width);
    }
    size = fmax(fmin(size, box.height / height), paper->min_letter_size);
    for (TextLine line = begin; text_next_line(&line);)
        box.y += draw_text_line(paper, box, size, &line, true);
}

int card_write_lines(const Plot *card, int at[2], double size, double gap,
                     const TextLine *line, bool draw)
{
    Paper *paper = card->paper;
    int width = paper_measure(paper, line->face, size, line->text);
    if (at[0] > 0 && at[0] + width > card->box.width) {
        at[0] = 0;
        at[1] += paper_to_pixels(paper, 1.35 * size);
    }
    if (draw)
        paper_write_on_panel(paper, line->face, size, line->colour,
                             card->box.x + at[0], card->box.y + at[1],
                             ALIGN_LEFT, "%s", line->text);
    at[0] += width + paper_to_pixels(paper, gap);
    return at[1] + paper_to_pixels(paper, 1.5 * size);
}

void card_write_hint(const Plot *card, const char *text)
{
    TextLine line = text_find_known_line(&card->pane->values, text);
    paper_write_in_box(card->paper, FACE_REGULAR, 0.92, COLOUR_GREY, card->box,
                       ALIGN_CENTRE, line.text);
}

/* ---- scale and legend ---------------------------------------------------- */

void plot_draw_scale_bar(const Plot *plot)
{
    Paper *paper = plot->paper;
    double scale = plot->camera.scale[0];
    double metres = plot_nice_number(SCALE_PART * plot->box.width / scale);
    double length = metres * scale;
    Box line = {plot->box.x + paper_to_pixels(paper, 1),
                plot->box.y + plot->box.height - paper_to_pixels(paper, 0.9),
                (int)length, (int)(1.5 * paper->unit) + 1};
    if (!(length > 4) || !isfinite(length) || length > 0.6 * plot->box.width)
        return;
    canvas_fill(&paper->canvas, box_inset(line, -paper_to_pixels(paper, 0.3)),
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

double plot_find_label_cost(const Plot *plot, Box place)
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
    for (int i = 0; i < plot->paper->word_box_count && i < MAX_WORD_BOXES;
         i++) {
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
        Box wider = box_inset(place, -paper_to_pixels(paper, LABEL_MARGIN));
        double cost =
            plot_find_label_cost(plot, wider) + COST_FAR * far + COST_LATER * i;
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
