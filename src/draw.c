#include "draw.h"

#include "circle_picture.h"
#include "colour_map.h"
#include "curve_picture.h"
#include "landscape_picture.h"
#include "panels.h"
#include "scene.h"

/* Springs, discs, numbers, energies. */
static SpringCount draw_square(Paper *paper, const Simulation *simulation,
                               const Hud *hud)
{
    double range = hud->strain ? square_picture_strain_range(simulation) : 0;
    SpringCount count = square_picture_draw(paper, simulation, range);
    if (!hud->text || !paper_shows_text(paper))
        return count;
    panels_draw_run(paper, simulation, hud);
    panels_draw_newton(paper, simulation, hud);
    panels_draw_energies(paper, simulation, hud);
    if (hud->strain)
        panels_draw_strain_legend(paper, range);
    return count;
}

/* Trails and radii. */
static void draw_circle(Paper *paper, const Simulation *simulation,
                        const Hud *hud)
{
    circle_picture_draw(paper, simulation, hud);
    if (!hud->text || !paper_shows_text(paper))
        return;
    panels_draw_run(paper, simulation, hud);
    circle_picture_panels(paper, simulation, hud);
}

/* One Newton iteration after the other. */
static void draw_descent(Paper *paper, const Simulation *simulation,
                         const Hud *hud)
{
    if (simulation->scene->picture == PICTURE_LANDSCAPE)
        landscape_picture_draw(paper, simulation);
    else
        curve_picture_draw(paper, simulation);
    if (!hud->text || !paper_shows_text(paper))
        return;
    panels_draw_run(paper, simulation, hud);
    panels_draw_descent(paper, simulation);
    if (simulation->scene->picture == PICTURE_LANDSCAPE)
        landscape_picture_legend(paper);
}

/* By the kind of picture, then what all of them have. */
SpringCount draw_frame(Paper *paper, const Simulation *simulation,
                       const Hud *hud)
{
    SpringCount count = {0};
    canvas_clear(&paper->canvas, COLOUR_WHITE);
    switch (simulation->scene->picture) {
    case PICTURE_SQUARE:
        count = draw_square(paper, simulation, hud);
        break;
    case PICTURE_CIRCLE:
        draw_circle(paper, simulation, hud);
        break;
    case PICTURE_CURVE:
    case PICTURE_LANDSCAPE:
        draw_descent(paper, simulation, hud);
        break;
    default:
        break;
    }
    if (!paper_shows_text(paper))
        return count;
    panels_draw_trouble(paper, hud);
    panels_draw_note(paper, hud);
    if (hud->keys)
        panels_draw_keys(paper);
    return count;
}
