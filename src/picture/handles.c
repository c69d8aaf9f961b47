#include "picture/plot.h"

#include <math.h>

#include "picture/colour_map.h"
#include "base/mathematics.h"

static const double HANDLE_REACH = 14; /* pixels, a handle is hit within */
static const double SWITCH_WIDE = 13;  /* ems */
static const double SWITCH_HIGH = 1.8;

void stage_handles(const Plot *stage)
{
    double at[SCENE_MAX_HANDLES][2];
    int count = exhibit_handles(stage->simulation, at);
    const Pick *hover = &stage->show->hover;
    for (int i = 0; i < count && !stage->show->bare; i++) {
        bool over = hover->kind == PICK_HANDLE && hover->pane == stage->pane &&
                    hover->index == i;
        plot_ring(stage, at[i], (over ? 13 : 10), over ? 3 : 1.8, COLOUR_HAND);
    }
}

static Box switch_box(const Plot *stage, int i)
{
    const Box *box = &stage->box;
    int wide = (int)(SWITCH_WIDE * stage->em);
    int high = (int)(SWITCH_HIGH * stage->em), gap = (int)(0.4 * stage->em);
    return (Box){box->x + box->width - wide - gap,
                 box->y + 3 * gap + i * (high + gap) + high, wide, high};
}

void stage_switches(const Plot *stage)
{
    Paper *paper = stage->paper;
    Switch out[SCENE_MAX_SWITCHES];
    int count = exhibit_switches(stage->simulation, out);
    for (int i = 0; i < count && stage->text; i++) {
        Box box = switch_box(stage, i), mark = box_inset(box, box.height / 4);
        bool on = out[i].on;
        canvas_card(&paper->canvas, box, on ? COLOUR_LIT : COLOUR_CHIP,
                    COLOUR_BORDER);
        mark.width = mark.height;
        canvas_card(&paper->canvas, mark, on ? COLOUR_VALUE : COLOUR_WHITE,
                    COLOUR_FAINT);
        box.x += 2 * mark.width;
        box.width -= 2 * mark.width;
        paper_fit(paper, FACE_REGULAR, 0.92, on ? COLOUR_TEXT : COLOUR_FAINT,
                  box, ALIGN_LEFT, out[i].label);
    }
}

bool handles_pick(const Plot *stage, double x, double y, Pick *pick)
{
    double at[SCENE_MAX_HANDLES][2];
    Switch out[SCENE_MAX_SWITCHES];
    int switches = exhibit_switches(stage->simulation, out);
    int handles = exhibit_handles(stage->simulation, at);
    for (int i = 0; i < switches && stage->text; i++)
        if (box_contains(switch_box(stage, i), x, y)) {
            pick->kind = PICK_SWITCH;
            pick->index = i;
            return true;
        }
    return plot_pick(stage, handles, *at, HANDLE_REACH, x, y, PICK_HANDLE,
                     pick);
}

/* The guess is a cross; along x alone a line from top to bottom, too. */
void stage_prediction(const Plot *stage)
{
    const Prediction *guess = &stage->simulation->prediction;
    const Box *box = &stage->box;
    Canvas *canvas = &stage->paper->canvas;
    double unit = stage->paper->unit, arm = 7 * unit, at[2], came[2], point[2];
    if (!guess->made || stage->show->bare)
        return;
    plot_place(stage, guess->at, at);
    plot_place(stage, guess->came, came);
    if (simulation_point(stage->simulation, point) == 1) {
        canvas_line(canvas, at[0], box->y + box->height, at[0], box->y,
                    1.5 * unit, COLOUR_HAND);
        came[1] = at[1];
    }
    for (int k = -1; k <= 1; k += 2)
        canvas_line(canvas, at[0] - arm, at[1] - k * arm, at[0] + arm,
                    at[1] + k * arm, 3 * unit, COLOUR_HAND);
    if (guess->shown)
        canvas_dashes(canvas, at, came, 1.6 * unit, unit, NULL, COLOUR_HAND);
    plot_words(stage, 1, guess->at, COLOUR_HAND,
               guess->shown ? "%s m off" : "your guess; N shows the step",
               number_of(guess->distance).text);
}
