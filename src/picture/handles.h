/* handles.h - what the mouse can drag and switch on a stage: shared by the
 * pictures of the lecture's small scenes.
 */
#ifndef ELASTO_HANDLES_H
#define ELASTO_HANDLES_H

#include "picture/picture.h"
#include "picture/plot.h"
#include "scenes/scene.h"

/* The stage of a pane; paper NULL: it only tells where things are. */
Plot show_stage(Paper *paper, const Show *show, const Layout *layout, int pane);

/* Open rings where the scene's handles are. */
void stage_handles(const Plot *stage);

/* The scene's switches as chips in the upper right corner. */
void stage_switches(const Plot *stage);

/* Where switch i is; pixels. */
Box stage_switch_box(const Plot *stage, int i);

/* A switch or a handle under pixel (x, y): fills kind and index. */
bool handles_pick(const Plot *stage, double x, double y, Pick *pick);

/* The guess, and where the step led: over any picture. */
void stage_prediction(const Plot *stage);

#endif
