/* frame.h - what is around the stage: strip, row of settings, time line, last
 * line.
 */
#ifndef ELASTO_FRAME_H
#define ELASTO_FRAME_H

#include "picture/picture.h"

void frame_draw(Paper *paper, const Layout *layout, const Show *show);

/* Steps that the time line has room for: those there are, at least some. */
long frame_span(const Show *show);

#endif
