/* panels.h - the texts, the plot and the legend around a picture.
 */
#ifndef ELASTO_PANELS_H
#define ELASTO_PANELS_H

#include "hud.h"
#include "text_block.h"

/* Upper left: step, time, speed, method, mesh. */
void panels_draw_run(Paper *paper, const Simulation *simulation,
                     const Hud *hud);

/* Upper right: the last iteration of a minimisation shown step by step. */
void panels_draw_descent(Paper *paper, const Simulation *simulation);

/* Upper right: what Newton did in the last step. */
void panels_draw_newton(Paper *paper, const Simulation *simulation,
                        const Hud *hud);

/* Lower left: the energies over time.  Lower right: their numbers. */
void panels_draw_energies(Paper *paper, const Simulation *simulation,
                          const Hud *hud);

/* For other pictures: where their plot goes, and a legend beside it. */
Box panels_plot_box(const Paper *paper);
void panels_draw_legend(Paper *paper, const TextBlock *block);

/* Lower right, below the numbers: which colour is which strain. */
void panels_draw_strain_legend(Paper *paper, double range);

/* In the middle: a step that failed, in red; a note; the list of keys. */
void panels_draw_trouble(Paper *paper, const Hud *hud);
void panels_draw_note(Paper *paper, const Hud *hud);
void panels_draw_keys(Paper *paper);

#endif
