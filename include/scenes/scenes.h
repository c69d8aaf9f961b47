/* scenes.h - the table of scenes.
 */
#ifndef ELASTO_SCENES_H
#define ELASTO_SCENES_H

#include "run/scene.h"

/* The table; the first row is the default; those by_name are the last ones; it
 * ends with a NULL name. */
extern const Scene scenes[];

/* The row with this name, or with this number from 1; NULL: there is none. */
const Scene *scene_find(const char *text);

#endif
