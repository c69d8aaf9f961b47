/* handles.h - what the mouse can drag and switch on a stage, and numbers in a
 * card: shared by the pictures of the lecture's small scenes.
 */
#ifndef ELASTO_HANDLES_H
#define ELASTO_HANDLES_H

#include "picture/picture.h"
#include "picture/plot.h"
#include "scenes/scene.h"

/* Open rings where the scene's handles are. */
void stage_handles(const Plot *stage, const Show *show);

/* The scene's switches as chips in the upper right corner. */
void stage_switches(const Plot *stage, const Show *show);

/* Where switch i is; pixels. */
Box stage_switch_box(const Plot *stage, int i);

/* A switch or a handle under pixel (x, y): fills kind and index. */
bool handles_pick(const Show *show, const Plot *stage, double x, double y,
                  Pick *pick);

/* The guess, and where the step led: over any picture. */
void stage_prediction(const Plot *stage, const Show *show);

/* Lines of markup in a card, one below the other, as large as fits but no
 * larger than plain text.  An empty line is half as high. */
enum { LINES_MOST = 16, LINE_TEXT = 160 };

typedef struct Lines {
    int count;
    char text[LINES_MOST][LINE_TEXT];
    Colour colour[LINES_MOST];
} Lines;

void lines_add(Lines *lines, Colour colour, const char *format, ...);
void lines_draw(Paper *paper, Box inside, const Lines *lines);

/* A number that something stands behind or before in a formula, such as an
 * exponent: in parentheses where it has a sign or a power of ten. */
void factor_text(char *text, size_t size, double value);

#endif
