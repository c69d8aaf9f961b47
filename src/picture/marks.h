/* marks.h - what pictures draw on their stage in metres: lines, arrows, pins,
 * obstacles, a scale, words, axes.
 */
#ifndef ELASTO_MARKS_H
#define ELASTO_MARKS_H

#include "model/contact.h"
#include "picture/labels.h"
#include "picture/picture.h"
#include "picture/plot.h"

/* Where a point is, pixels; the same as camera_pixel. */
static inline void stage_pixel(const Stage *stage, const double *world,
                               double pixel[2])
{
    camera_pixel(&stage->camera, world, pixel);
}

/* Width in units. */
void stage_line(Paper *paper, const Stage *stage, const double *a,
                const double *b, double width, Colour colour);
void stage_dashes(Paper *paper, const Stage *stage, const double *a,
                  const double *b, double width, Colour colour);

/* From a to a + factor d. */
void stage_arrow(Paper *paper, const Stage *stage, const double *a,
                 const double *d, double factor, double width, Colour colour);

/* Words keep off a line from a to b, and off a disc of so many units. */
void keep_off_line(Labels *labels, const Stage *stage, const double *a,
                   const double *b);
void keep_off_disc(Labels *labels, const Paper *paper, const Stage *stage,
                   const double *a, double radius);

/* Discs and rings; radius in pixels. */
void stage_disc(Paper *paper, const Stage *stage, const double *a,
                double radius, Colour colour);
void stage_ring(Paper *paper, const Stage *stage, const double *a,
                double radius, double width, Colour colour);

/* A node that never moves. */
void stage_pin(Paper *paper, const Stage *stage, const double *a,
               double radius);

/* Arrows of part times d [2n] at x [2n], every stride-th node.  A power of ten
 * times as long as they are, so that the longest has between a tenth of `most`
 * pixels and `most`, where that is not so by itself; returns that factor, 0 if
 * there is nothing to draw. */
double stage_arrows(Paper *paper, const Stage *stage, int nodes, int stride,
                    const double *x, const double *d, double part, double most,
                    Colour colour);

/* Walls and balls, and how far their barrier reaches; thin: walls as slabs. */
void stage_obstacles(Paper *paper, const Stage *stage, const Contact *contact,
                     const double *x, bool thin);

/* Lower left: a line as long as so many metres. */
void stage_scale(Paper *paper, const Stage *stage);

/* Words in colours from the upper left corner to the right, on a second line
 * if there is no room; x, y where the next one goes, in/out (0, 0 at first). */
typedef struct Legend {
    int x, y; /* pixels, from the corner */
} Legend;
void stage_legend(Paper *paper, const Stage *stage, Legend *legend,
                  Colour colour, const char *format, ...);

/* The same behind an arrow so many ems long: what that length stands for. */
void stage_key(Paper *paper, const Stage *stage, Legend *legend, double length,
               Colour colour, const char *format, ...);

/* Axes over the whole stage, with numbers where there is room for words; what a
 * logarithmic one shows is the power of ten that the camera sees.
 *   room  ems left, left and right, above, above and below of the axes
 *   y     where high is not 0: its own range */
typedef struct StageRoom {
    double left, wide, above, high;
} StageRoom;
extern const StageRoom stage_room;
Plot stage_plot(Paper *paper, const Stage *stage, const StageRoom *room, Axis x,
                Axis y);

/* A square view around the middle, of at least so many metres, in which `most`
 * fits; it grows by this factor, so that it does not move all the time. */
void bounds_around(double reach, double most, double factor, double bounds[4]);

/* A small card beside pixel (x, y), inside the stage, and beside the body where
 * there is room.  Returns where its contents go.
 *   body  what it should not cover, in; without width: nothing */
Box stage_note(Paper *paper, const Stage *stage, double x, double y, int width,
               int height, Box body);

#endif
