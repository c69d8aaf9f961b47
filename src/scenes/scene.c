#include "scenes/scene.h"

#include <string.h>

#include "scenes/circle_scene.h"
#include "scenes/landscape_scene.h"
#include "scenes/overshoot_scene.h"
#include "scenes/square_scenes.h"

const Scene scenes[] = {
    {.name = "square",
     .sentence = "the stretched square relaxes",
     .picture = PICTURE_SQUARE,
     .needs = NEEDS_MESH | NEEDS_TIME | NEEDS_SPRINGS | NEEDS_MINIMUM,
     .create = create_square},
    {.name = "circle",
     .sentence = "forward Euler spirals out, backward in, symplectic stays",
     .picture = PICTURE_CIRCLE,
     .needs = NEEDS_TIME,
     .defaults = circle_defaults,
     .create = create_circle},
    {.name = "overshoot",
     .sentence = "Newton's full steps overshoot; a line search tames them",
     .picture = PICTURE_CURVE,
     .needs = NEEDS_START | NEEDS_ONE_NUMBER | NEEDS_MINIMUM,
     .defaults = overshoot_defaults,
     .create = create_overshoot,
     .step = step_overshoot},
    {.name = "landscape",
     .sentence = "without projection Newton may go uphill; clamped, never",
     .picture = PICTURE_LANDSCAPE,
     .needs = NEEDS_START | NEEDS_SPRINGS | NEEDS_MINIMUM,
     .defaults = landscape_defaults,
     .create = create_landscape,
     .step = step_landscape,
     .aim = aim_landscape},
    {.name = "unprojected",
     .sentence = "the squeezed square: without projection Newton is stuck",
     .picture = PICTURE_SQUARE,
     .needs = NEEDS_MESH | NEEDS_TIME | NEEDS_SPRINGS | NEEDS_MINIMUM,
     .defaults = unprojected_defaults,
     .create = create_square},
    {.name = NULL},
};

const Scene *scene_find(const char *name)
{
    for (const Scene *scene = scenes; scene->name; scene++)
        if (strcmp(scene->name, name) == 0)
            return scene;
    return NULL;
}
