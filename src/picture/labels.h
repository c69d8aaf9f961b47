/* labels.h - words beside points and arrows of a picture, placed where they lie
 * neither on each other nor on a line.
 *
 * First all lines and places to keep off are named, then the words are put, the
 * most important ones first: each takes the best of the places around it.
 */
#ifndef ELASTO_LABELS_H
#define ELASTO_LABELS_H

#include "picture/paper.h"

enum { LABELS_LINES = 64, LABELS_BOXES = 32 };

/* Pixels; all of it zero but the stage at the start. */
typedef struct Labels {
    Box stage; /* words stay inside */
    int lines, boxes;
    double line[LABELS_LINES][4]; /* x, y of both ends */
    Box box[LABELS_BOXES];
} Labels;

/* A line from a to b, a disc, a box that words shall not cover; what there is
 * no room for is left out.  Pixels. */
void labels_line(Labels *labels, const double a[2], const double b[2]);
void labels_disc(Labels *labels, const double middle[2], double radius);
void labels_box(Labels *labels, Box box);

/* Writes the words beside one of these points, `gap` pixels from it, on a
 * ground of thin white, and keeps the later ones off them.
 *   point  [points][2] pixels in; the first ones are preferred */
void labels_put(Paper *paper, Labels *labels, Face face, double size,
                Colour colour, const double (*point)[2], int points, double gap,
                const char *words);

#endif
