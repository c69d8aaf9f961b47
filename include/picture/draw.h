/* draw.h - one frame: the picture of the scene and the texts around it.
 *
 * The same simulation and the same hud give the same pixels, on every screen
 * and without one.  A scene's picture is one function; see draw.c.
 */
#ifndef ELASTO_DRAW_H
#define ELASTO_DRAW_H

#include "picture/hud.h"
#include "picture/picture.h"

/* Draws over all of the paper.  Returns what became of the springs. */
SpringCount draw_frame(Paper *paper, const Simulation *simulation,
                       const Hud *hud);

#endif
