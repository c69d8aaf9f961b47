#include "scene.h"

#include <string.h>

#include "circle_scene.h"
#include "landscape_scene.h"
#include "overshoot_scene.h"
#include "square_scenes.h"

const Scene scenes[] = {
    {"square", "the stretched square relaxes", PICTURE_SQUARE,
     NEEDS_MESH | NEEDS_TIME, NULL, create_square, NULL},
    {"circle", "three integrators go round in a circle; one stays on it",
     PICTURE_CIRCLE, NEEDS_TIME, circle_defaults, create_circle, NULL},
    {"overshoot", "Newton without line search jumps further each time",
     PICTURE_CURVE, NEEDS_START, overshoot_defaults, create_overshoot,
     step_overshoot},
    {"landscape", "Newton's way over a map of the incremental potential",
     PICTURE_LANDSCAPE, NEEDS_START, landscape_defaults, create_landscape,
     step_landscape},
    {"unprojected", "the squeezed square defeats Newton without projection",
     PICTURE_SQUARE, NEEDS_MESH | NEEDS_TIME, unprojected_defaults,
     create_square, NULL},
    {NULL, NULL, PICTURE_SQUARE, 0, NULL, NULL, NULL},
};

const Scene *scene_find(const char *name)
{
    for (const Scene *scene = scenes; scene->name; scene++)
        if (strcmp(scene->name, name) == 0)
            return scene;
    return NULL;
}
