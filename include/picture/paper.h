/* paper.h - a canvas, and texts on it in a size that fits the window.
 *
 * Sizes are in ems.  An em is the size of plain text; layout_create chooses its
 * pixels.  Widths of lines are in units; a unit is 1/14 em. */
#pragma once

#include "picture/text.h"

enum { MAX_WORD_BOXES = 64 };

typedef struct Paper {
    Canvas canvas;
    Font *font;             /* NULL: no font was found; texts are left out */
    double em;              /* pixels */
    double unit;            /* pixels, 1/14 em */
    double min_letter_size; /* ems, least size of normal letters */
    Box word_boxes[MAX_WORD_BOXES]; /* boxes that new labels must not cover */
    int word_box_count; /* boxes so far; the newest MAX_WORD_BOXES are kept */
} Paper;

/* Creates white paper of this size in pixels.  The caller frees it, also after
 * a failure.  Returns OK, INVALID_INPUT, OUT_OF_MEMORY. */
Status paper_create(int width, int height, Paper *paper);
void paper_free(Paper *paper);

/* Converts ems to whole pixels. */
int paper_to_pixels(const Paper *paper, double ems);

/* Keeps the box of words that labels must not cover. */
void paper_keep_word_box(Paper *paper, Box box);

/* Draws markup, formatted as by printf, below y.  Returns its width, pixels. */
int paper_write(Paper *paper, Face face, double size, Colour colour, double x,
                double y, Align align, const char *format, ...);

/* Replaces the last words of a line by an ellipsis if the line is wider than
 * `width` pixels.
 *   words  [room] in/out, markup */
void paper_shorten_words(Paper *paper, double size, int width, char *words,
                         size_t room);

/* Draws a line in the middle of a box's height.  A line wider than the box
 * shrinks to at least 0.6 of its size.  Returns the width in pixels. */
int paper_write_in_box(Paper *paper, Face face, double size, Colour colour,
                       Box box, Align align, const char *markup);

/* Draws markup, formatted as by printf, on a panel that hides the picture. */
void paper_write_on_panel(Paper *paper, Face face, double size, Colour colour,
                          double x, double y, Align align, const char *format,
                          ...);

/* Returns the width of a line in pixels. */
int paper_measure(Paper *paper, Face face, double size, const char *markup);

/* Draws a paragraph in the width of the box, broken at blanks outside of
 * braces. If text is left, the last line ends with an ellipsis.  Returns the
 * height in pixels.
 *   lines  the most lines to draw; 0: only measures the whole paragraph */
int paper_write_paragraph(Paper *paper, Face face, double size, Colour colour,
                          Box box, int lines, const char *markup);
