/* panels.h - the texts around a picture that all scenes have, and the places
 * where a picture may put its own.
 *
 * From above: the sentence of the scene; two blocks of numbers, left and
 * right; the picture; what went wrong in the last step; a plot with a legend.
 */
#ifndef ELASTO_PANELS_H
#define ELASTO_PANELS_H

#include "picture/hud.h"
#include "picture/text_block.h"

/* Along the upper edge: the sentence of the scene. */
void panels_draw_sentence(Paper *paper, const Simulation *simulation);

/* Upper left: step, time, speed, method, mesh; or iteration and iterate. */
void panels_draw_run(Paper *paper, const Simulation *simulation,
                     const Hud *hud);

/* Upper right: a block of the picture's own. */
void panels_draw_right(Paper *paper, const TextBlock *block);

/* Lower left: where a plot goes.  Lower right: a legend beside it. */
Box panels_plot_box(const Paper *paper);
void panels_draw_legend(Paper *paper, const TextBlock *block);

/* For pictures of minimisations: the last update in the upper right, legends
 * in columns along the lower edge, and the room that both leave. */
void panels_draw_update(Paper *paper, const Simulation *simulation);
void panels_draw_columns(Paper *paper, const TextBlock *blocks, int count);
Box panels_middle_box(const Paper *paper);

/* "projection" and "line search": which are on, and what they did.
 *   projected  springs, or < 0: nothing was projected yet
 *   trials     step lengths looked at */
void panels_add_methods(TextBlock *block, const Simulation *simulation,
                        int projected, int trials);

/* Above what is along the lower edge: a step that failed, in red; a note. */
void panels_draw_trouble(Paper *paper, const Simulation *simulation,
                         const Hud *hud);
void panels_draw_note(Paper *paper, const Simulation *simulation,
                      const Hud *hud);

/* In the middle: the keys of this scene and what they do. */
void panels_draw_keys(Paper *paper, const Simulation *simulation);

#endif
