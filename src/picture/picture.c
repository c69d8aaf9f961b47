#include <math.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "scenes/scene.h"

static const double LEAST_TEXT = 11; /* ems, the height of a pane with words */

const Picture *picture_of(const struct Scene *scene)
{
    return &pictures[scene->picture];
}

int picture_cards(const Picture *picture)
{
    int count = 0;
    while (picture->cards[count])
        count++;
    return count;
}

int picture_card(const Picture *picture, const char *name)
{
    for (int c = 0; picture->cards[c]; c++)
        if (strcmp(picture->cards[c]->name, name) == 0)
            return c;
    return -1;
}

/* One pane, its words, where it is not alone its label in the colour of its
 * curve, and what the mouse is over in it. */
static void draw_pane(Paper *paper, const Layout *layout, const Show *show,
                      int pane)
{
    Plot stage = show_stage(paper, show, layout, pane);
    const Picture *picture = picture_of(stage.simulation->scene);
    const Pick *hover = &show->hover;
    Box before = canvas_clip(&paper->canvas, stage.box);
    if (show->lecture && stage.box.height < LEAST_TEXT * paper->em)
        stage.text = false; /* a star has taken its room */
    picture->draw(&stage);
    TextLine line = text_of(&show->pane[pane].facts, picture->legend);
    while (stage.text && text_next(&line))
        plot_legend(&stage, line.colour, "%s", line.words);
    if (stage.text && picture->scale)
        plot_scale(&stage);
    if (!picture->own_handles)
        stage_handles(&stage);
    stage_switches(&stage);
    stage_prediction(&stage);
    const char *label = layout->panes > 1 ? show->pane[pane].label : NULL;
    if (label) { /* above the scale where it is long */
        int wide = paper_width(paper, FACE_BOLD, 1, label);
        bool high = wide > stage.box.width - 10 * paper->em;
        paper_panel(paper, FACE_BOLD, 1, colour_of_run(pane),
                    stage.box.x + 0.5 * stage.box.width,
                    stage.box.y + stage.box.height -
                        (high ? 4.2 : 1.7) * paper->em,
                    ALIGN_CENTRE, label);
    }
    if (picture->hover && stage.text && hover->pane == pane &&
        hover->kind != PICK_NONE && !show->hand)
        picture->hover(&stage);
    canvas_clip(&paper->canvas, before);
}

/* A scene on the sheet: its bare picture, its name, over it the heading of the
 * group that it begins. */
static void draw_cell(Paper *paper, Box box, const SheetCell *cell, bool chosen)
{
    Layout layout = {.em = paper->em, .panes = 1, .pane = {box}};
    Box *inside = &layout.pane[0];
    inside->height = box.width;
    if (cell->group)
        paper_write(paper, FACE_BOLD, 1.05, COLOUR_TEXT, box.x,
                    box.y - 1.7 * paper->em, ALIGN_LEFT, "%s", cell->group);
    canvas_card(&paper->canvas, *inside, COLOUR_WHITE,
                chosen ? COLOUR_VALUE : COLOUR_BORDER);
    if (chosen)
        canvas_card(&paper->canvas, box_inset(*inside, 1), COLOUR_WHITE,
                    COLOUR_VALUE);
    *inside = box_inset(*inside, paper_pixels(paper, 0.3));
    if (cell->simulation) {
        Show show;
        show_create(cell->simulation, &show);
        show.bare = true;
        show.strain = cell->simulation->scene->strain > 0;
        draw_pane(paper, &layout, &show, 0);
    }
    Box name = {box.x, box.y + box.width, box.width, box.height - box.width};
    paper_fit(paper, chosen ? FACE_BOLD : FACE_REGULAR, 1,
              chosen ? COLOUR_VALUE : COLOUR_TEXT, name, ALIGN_CENTRE,
              cell->name);
}

void show_draw(Paper *paper, const Show *show)
{
    Layout layout =
        show_layout(show, paper->canvas.width, paper->canvas.height);
    paper->em = layout.em;
    paper->unit = layout.em / 14;
    paper->least = show->lecture ? 1 : 0;
    canvas_clear(&paper->canvas, COLOUR_WHITE);
    for (int i = 0; i < layout.cells; i++)
        draw_cell(paper, layout.cell[i], &show->cell[i], i == show->chosen);
    if (layout.cells > 0) {
        frame_draw(paper, &layout, show);
        return;
    }
    if (layout.panes > 1) /* lines between them */
        canvas_fill(&paper->canvas, layout.stage, COLOUR_RULE);
    for (int pane = 0; pane < layout.panes; pane++) {
        if (layout.panes > 1)
            canvas_fill(&paper->canvas, layout.pane[pane], COLOUR_WHITE);
        draw_pane(paper, &layout, show, pane);
    }
    if (show->bare)
        return;
    if (show->page.kind != PAGE_NONE)
        canvas_fill(&paper->canvas, layout.column, COLOUR_WHITE);
    cards_draw(paper, &layout, show);
    glow_draw(paper, show);
    frame_draw(paper, &layout, show);
}
