/* scenes.h - the table of scenes. */
#pragma once

#include "simulation/scene.h"

/* The scenes; a NULL name ends the table.  The first row is the default; the
 * last rows are hidden scenes, without a key and a cell in the overview. */
extern const Scene scenes[];

/* Returns the scene with this name, or this number from 1; NULL: none. */
const Scene *scene_find(const char *text);
