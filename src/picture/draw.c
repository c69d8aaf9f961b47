#include "picture/draw.h"

#include "picture/circle_picture.h"
#include "picture/colour_map.h"
#include "picture/curve_picture.h"
#include "picture/landscape_picture.h"
#include "picture/panels.h"
#include "scenes/scene.h"

/* Whether there are texts around the picture. */
static bool draws_text(const Paper *paper, const Hud *hud)
{
    return hud->text && paper_shows_text(paper);
}

/* By the kind of picture: first what moves, then its texts. */
static SpringCount draw_picture(Paper *paper, const Simulation *simulation,
                                const Hud *hud)
{
    bool text = draws_text(paper, hud);
    double range = hud->strain ? square_picture_strain_range(simulation) : 0;
    SpringCount count = {0};
    switch (simulation->scene->picture) {
    case PICTURE_CIRCLE:
        circle_picture_draw(paper, simulation, hud);
        if (text)
            circle_picture_panels(paper, simulation, hud);
        break;
    case PICTURE_CURVE:
        curve_picture_draw(paper, simulation, text);
        break;
    case PICTURE_LANDSCAPE:
        landscape_picture_draw(paper, simulation, text);
        break;
    case PICTURE_MASS:
    case PICTURE_TANGENT:
    case PICTURE_DIAL:
    case PICTURE_SPRING:
    case PICTURE_RACE:
    case PICTURE_ENVELOPE:
        break; /* texts alone */
    default:
        count = square_picture_draw(paper, simulation, range);
        if (text)
            square_picture_panels(paper, simulation, hud, range);
    }
    return count;
}

/* White, the picture, then what all of them have. */
SpringCount draw_frame(Paper *paper, const Simulation *simulation,
                       const Hud *hud)
{
    canvas_clear(&paper->canvas, COLOUR_WHITE);
    SpringCount count = draw_picture(paper, simulation, hud);
    if (draws_text(paper, hud)) {
        panels_draw_sentence(paper, simulation);
        panels_draw_run(paper, simulation, hud);
    }
    if (!paper_shows_text(paper))
        return count;
    panels_draw_trouble(paper, simulation, hud);
    panels_draw_note(paper, simulation, hud);
    if (hud->keys)
        panels_draw_keys(paper, simulation);
    return count;
}
