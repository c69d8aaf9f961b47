#include "scenes/scene.h"

#include <string.h>

#include "scenes/circle_scene.h"
#include "scenes/dial_scene.h"
#include "scenes/envelope_scene.h"
#include "scenes/landscape_scene.h"
#include "scenes/mass_scene.h"
#include "scenes/overshoot_scene.h"
#include "scenes/race_scene.h"
#include "scenes/spring_scene.h"
#include "scenes/square_scenes.h"
#include "scenes/tangent_scene.h"

const Scene scenes[] = {
    {.name = "square",
     .title = "A stretched square",
     .sentence = "the stretched square relaxes",
     .picture = PICTURE_SQUARE,
     .needs =
         NEEDS_MESH | NEEDS_TIME | NEEDS_SPRINGS | NEEDS_MINIMUM | NEEDS_BODY,
     .create = create_square},
    {.name = "circle",
     .title = "Stability on a circle",
     .sentence = "forward Euler spirals out, backward in, symplectic stays",
     .picture = PICTURE_CIRCLE,
     .needs = NEEDS_TIME,
     .defaults = circle_defaults,
     .create = create_circle},
    {.name = "overshoot",
     .title = "Overshooting",
     .sentence = "Newton's full steps overshoot; a line search tames them",
     .picture = PICTURE_CURVE,
     .needs = NEEDS_START | NEEDS_ONE_NUMBER | NEEDS_MINIMUM,
     .defaults = overshoot_defaults,
     .explains = true,
     .create = create_overshoot,
     .step = step_overshoot,
     .handles = overshoot_handles,
     .drag = overshoot_drag},
    {.name = "landscape",
     .title = "Search directions",
     .sentence = "without projection Newton may go uphill; clamped, never",
     .picture = PICTURE_LANDSCAPE,
     .needs = NEEDS_START | NEEDS_SPRINGS | NEEDS_MINIMUM | NEEDS_STEP,
     .defaults = landscape_defaults,
     .explains = true,
     .create = create_landscape,
     .step = step_landscape,
     .aim = aim_landscape,
     .handles = landscape_handles,
     .drag = landscape_drag,
     .switches = landscape_switches,
     .flip = landscape_flip},
    {.name = "unprojected",
     .title = "Without projection",
     .sentence = "the squeezed square: without projection Newton is stuck",
     .picture = PICTURE_SQUARE,
     .needs =
         NEEDS_MESH | NEEDS_TIME | NEEDS_SPRINGS | NEEDS_MINIMUM | NEEDS_BODY,
     .defaults = unprojected_defaults,
     .explains = true,
     .create = create_square},
    {.name = "hang",
     .title = "A hanging square",
     .sentence = "the square hangs from its upper corners and swings",
     .picture = PICTURE_SQUARE,
     .needs =
         NEEDS_MESH | NEEDS_TIME | NEEDS_SPRINGS | NEEDS_MINIMUM | NEEDS_BODY,
     .defaults = hang_defaults,
     .create = create_square},
    {.name = "arrows",
     .title = "One mass",
     .sentence = "one mass on a spring: the arrows of three Euler steps",
     .picture = PICTURE_MASS,
     .needs = NEEDS_TIME | NEEDS_START,
     .defaults = mass_defaults,
     .create = create_mass,
     .handles = mass_handles,
     .drag = mass_drag},
    {.name = "tangent",
     .title = "Newton in one dimension",
     .sentence = "Newton in one dimension: tangents of g, parabolas of E",
     .picture = PICTURE_TANGENT,
     .needs = NEEDS_START | NEEDS_MINIMUM | NEEDS_ONE_NUMBER | NEEDS_STEP,
     .defaults = tangent_defaults,
     .create = create_tangent,
     .step = step_overshoot,
     .handles = tangent_handles,
     .drag = tangent_drag},
    {.name = "dial",
     .title = "The time step as a dial",
     .sentence = "a longer time step: from x_tilde to the rest shape",
     .picture = PICTURE_DIAL,
     .needs = NEEDS_STEP,
     .defaults = dial_defaults,
     .create = create_dial,
     .step = step_dial,
     .handles = dial_handles,
     .drag = dial_drag,
     .switches = landscape_switches,
     .flip = landscape_flip},
    {.name = "spring",
     .title = "One spring",
     .sentence = "one spring: energy, force, eigenvalues; drag its end",
     .picture = PICTURE_SPRING,
     .needs = NEEDS_TIME | NEEDS_START | NEEDS_SPRINGS | NEEDS_MINIMUM,
     .defaults = spring_defaults,
     .create = create_spring,
     .handles = spring_handles,
     .drag = spring_drag,
     .switches = spring_switches,
     .flip = spring_flip},
    {.name = "race",
     .title = "Run time and error",
     .sentence = "run time against error, measured now",
     .picture = PICTURE_RACE,
     .needs = NEEDS_MESH | NEEDS_SPRINGS | NEEDS_MINIMUM,
     .defaults = race_defaults,
     .create = create_race,
     .step = step_race},
    {.name = "envelope",
     .title = "How far it can be trusted",
     .sentence = "where the square converges: h across, k upwards",
     .picture = PICTURE_ENVELOPE,
     .needs = NEEDS_MESH | NEEDS_SPRINGS | NEEDS_MINIMUM | NEEDS_STEP,
     .create = create_envelope,
     .step = step_envelope},
    {.name = NULL},
};

const Scene *scene_find(const char *name)
{
    for (const Scene *scene = scenes; scene->name; scene++)
        if (strcmp(scene->name, name) == 0)
            return scene;
    return NULL;
}
