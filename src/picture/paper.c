/* paper.c - a canvas, and texts that fit on it. */
#include "picture/paper.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/colour_map.h"
#include "simulation/message.h"

enum { PAPER_TEXT_SIZE = 768, PAPER_EM = 14 }; /* bytes of a text; pixels */

/* A line that is too wide shrinks to at least this fraction of its size. */
static const double MIN_FIT = 0.6;

Status paper_create(int width, int height, Paper *paper)
{
    *paper = (Paper){.em = PAPER_EM, .unit = 1};
    Status status = canvas_create(width, height, &paper->canvas);
    return status ? status : font_create(&paper->font);
}

void paper_free(Paper *paper)
{
    canvas_free(&paper->canvas);
    font_free(paper->font);
    *paper = (Paper){0};
}

int paper_to_pixels(const Paper *paper, double ems)
{
    return (int)floor(ems * paper->em + 0.5);
}

void paper_keep_word_box(Paper *paper, Box box)
{
    paper->word_boxes[paper->word_box_count++ % MAX_WORD_BOXES] = box;
}

static TextStyle paper_make_style(const Paper *paper, Face face, double size,
                                  Colour colour)
{
    return (TextStyle){face, fmax(size, paper->min_letter_size) * paper->em,
                       colour, false, paper->min_letter_size * paper->em};
}

int paper_write(Paper *paper, Face face, double size, Colour colour, double x,
                double y, Align align, const char *format, ...)
{
    char words[PAPER_TEXT_SIZE];
    TextStyle style = paper_make_style(paper, face, size, colour);
    write_formatted(words, sizeof words, format);
    return text_draw(paper->font, &paper->canvas, &style, x, y, align, words);
}

int paper_measure(Paper *paper, Face face, double size, const char *markup)
{
    TextStyle style = paper_make_style(paper, face, size, 0);
    return (int)text_measure(paper->font, &style, markup).width;
}

int paper_write_in_box(Paper *paper, Face face, double size, Colour colour,
                       Box box, Align align, const char *markup)
{
    int air = paper_to_pixels(paper, 0.35); /* room for superscripts */
    Box room = {box.x, box.y - air, box.width, box.height + 2 * air};
    Box before = canvas_set_clip(&paper->canvas, room);
    double least = MIN_FIT * size, wide;
    while ((wide = paper_measure(paper, face, size, markup)) > box.width &&
           size > least)
        size = fmax(least, 0.99 * size * box.width / wide);
    TextStyle style = paper_make_style(paper, face, size, colour);
    double over = text_measure(paper->font, &style, markup).ascent -
                  text_measure(paper->font, &style, "").ascent;
    double y = fmax(0.5 * box.height - 0.65 * size * paper->em, over);
    int width = paper_write(paper, face, size, colour,
                            box.x + 0.5 * (int)align * box.width, box.y + y,
                            align, "%s", markup);
    canvas_set_clip(&paper->canvas, before);
    return width;
}

void paper_write_on_panel(Paper *paper, Face face, double size, Colour colour,
                          double x, double y, Align align, const char *format,
                          ...)
{
    char words[PAPER_TEXT_SIZE];
    write_formatted(words, sizeof words, format);
    int wide = paper_measure(paper, face, size, words);
    int left = pixel_from_coordinate(x) - (int)align * wide / 2;
    int air = paper_to_pixels(paper, 0.3);
    Box panel = {left - air, pixel_from_coordinate(y), wide + 2 * air,
                 paper_to_pixels(paper, 1.36 * size)};
    canvas_fill(&paper->canvas, panel, COLOUR_PANEL);
    paper_keep_word_box(paper, panel);
    paper_write(paper, face, size, colour, x, y, align, "%s", words);
}

void paper_shorten_words(Paper *paper, double size, int width, char *words,
                         size_t room)
{
    static const char end[] = " \u2026";
    TextStyle style = paper_make_style(paper, FACE_REGULAR, size, 0);
    int rest = width - paper_measure(paper, FACE_REGULAR, size, end);
    TextExtent extent;
    size_t fits =
        text_break_line(paper->font, &style, width, words, room, &extent);
    if (words[fits])
        fits = text_break_line(paper->font, &style, rest, words, room, &extent);
    if (words[fits])
        snprintf(words + fits, room - fits, "%s", end);
}

int paper_write_paragraph(Paper *paper, Face face, double size, Colour colour,
                          Box box, int lines, const char *markup)
{
    char part[PAPER_TEXT_SIZE];
    TextStyle style = paper_make_style(paper, face, size, colour);
    double y = box.y, above = text_measure(paper->font, &style, "").ascent;
    for (int line = 1; *markup && (line <= lines || lines == 0); line++) {
        TextExtent extent;
        size_t count = text_break_line(paper->font, &style, box.width, markup,
                                       sizeof part, &extent);
        if (count == 0)
            break;
        const char *next = markup + count + strspn(markup + count, " ");
        if (lines > 0) {
            snprintf(part, sizeof part, "%.*s%s", (int)count, markup,
                     *next && line == lines ? "\u2026" : "");
            text_draw(paper->font, &paper->canvas, &style, box.x,
                      y + extent.ascent - above, ALIGN_LEFT, part);
        }
        markup = next;
        y += extent.ascent + extent.descent;
    }
    return (int)ceil(y - box.y);
}
