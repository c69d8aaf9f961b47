#include "picture/panels.h"

#include <math.h>
#include <stdio.h>

#include "picture/colour_map.h"
#include "scenes/scene.h"

/* Sizes in units. */
enum {
    EDGE = 5,         /* from panels to the edge of the picture */
    SENTENCE_AT = 4,  /* upper edge of the sentence */
    BLOCKS_AT = 19,   /* upper edge of the blocks below it */
    PLOT_WIDTH = 232, /* of a plot with a legend beside it */
    PLOT_HEIGHT = 100,
    MIDDLE_AT = 79, /* what lies between the blocks of a minimisation ... */
    COLUMNS_HEIGHT = 34, /* ... its legend, two lines high ... */
    TROUBLE_HEIGHT = 34  /* ... and what may go wrong above that */
};

/* Distance from panels to the edge in pixels. */
static int panel_edge(const Paper *paper)
{
    return paper_pixels(paper, EDGE);
}

/* Whether this scene moves through time. */
static bool has_time(const Simulation *simulation)
{
    return (simulation->scene->needs & NEEDS_TIME) != 0;
}

/* Bold, in the middle. */
void panels_draw_sentence(Paper *paper, const Simulation *simulation)
{
    paper_bold_text(paper, paper->canvas.width / 2,
                    paper_pixels(paper, SENTENCE_AT), ALIGN_CENTRE, COLOUR_TEXT,
                    simulation->scene->sentence);
}

/* "slow motion x0.24": what is set, and what is reached where it differs. */
static void format_speed(char *text, size_t size, const Hud *hud)
{
    double speed = hud->speed;
    const char *word = speed < 0.95   ? "slow motion "
                       : speed < 1.05 ? "real time "
                                      : "fast motion ";
    if (hud->measured > 0 && hud->measured < 0.85 * speed)
        snprintf(text, size, "x%.2g of x%.2g", hud->measured, speed);
    else
        snprintf(text, size, "%sx%.2g", word, speed);
}

/* What stands behind the number of the step. */
static const char *progress_word(const Simulation *simulation, const Hud *hud)
{
    return simulation->done ? "  end" : hud->paused ? "  paused" : "";
}

/* Step, time, speed, method, timestep. */
static void add_time_lines(TextBlock *block, const Simulation *simulation,
                           const Hud *hud)
{
    const TimeIntegrator *run = &simulation->run[0];
    char speed[TEXT_BLOCK_SIZE];
    format_speed(speed, sizeof speed, hud);
    text_block_add(block, COLOUR_TEXT, "step     %ld%s", simulation->steps,
                   progress_word(simulation, hud));
    text_block_add(block, COLOUR_TEXT, "time     %.4g s",
                   simulation_time(simulation));
    text_block_add(block, COLOUR_TEXT, "speed    %s", speed);
    if (simulation->runs == 1)
        text_block_add(block, COLOUR_FAINT, "method   %s", run->method->label);
    text_block_add(block, COLOUR_FAINT, "timestep %g s", run->h);
}

/* Iteration, value, place, next direction. */
static void add_iterate_lines(TextBlock *block, const Simulation *simulation,
                              const Hud *hud)
{
    const Descent *descent = &simulation->descent;
    const double *at = descent->point, *p = descent->direction;
    bool map = simulation->scene->picture == PICTURE_LANDSCAPE;
    text_block_add(block, COLOUR_TEXT, "iteration %ld%s", simulation->steps,
                   progress_word(simulation, hud));
    if (map)
        text_block_add(block, COLOUR_TEXT, "at    (%.3f, %.3f) m", at[0],
                       at[1]);
    else
        text_block_add(block, COLOUR_TEXT, "x     %.6g", at[0]);
    text_block_add(block, COLOUR_TEXT, map ? "E     %.4g J s^2" : "f(x)  %.6g",
                   descent->value);
    if (p[0] != 0 || p[1] != 0)
        text_block_add(block, descent->slope > 0 ? COLOUR_WARNING : COLOUR_TEXT,
                       "slope %.3g %s", descent->slope,
                       descent->slope > 0 ? "UPHILL" : "downhill");
    else if (simulation->done && simulation->status != STATUS_OK)
        text_block_add(block, COLOUR_WARNING, "p     does not exist");
    else
        text_block_add(block, COLOUR_TEXT, "p     below the tolerance");
}

/* By what the scene has. */
void panels_draw_run(Paper *paper, const Simulation *simulation, const Hud *hud)
{
    TextBlock block = {0};
    if (has_time(simulation))
        add_time_lines(&block, simulation, hud);
    else
        add_iterate_lines(&block, simulation, hud);
    if (simulation->scene->needs & NEEDS_MESH)
        text_block_add(&block, COLOUR_FAINT, "segments %d (%d springs)",
                       simulation->mesh.segments, simulation->system.springs);
    if (has_time(simulation) && simulation->unconverged > 0)
        text_block_add(&block, COLOUR_WARNING, "not converged: %ld step%s",
                       simulation->unconverged,
                       simulation->unconverged > 1 ? "s" : "");
    text_block_draw(&block, paper, panel_edge(paper),
                    paper_pixels(paper, BLOCKS_AT), ALIGN_LEFT);
}

/* As high as the block on the left. */
void panels_draw_right(Paper *paper, const TextBlock *block)
{
    text_block_draw(block, paper, paper->canvas.width - panel_edge(paper),
                    paper_pixels(paper, BLOCKS_AT), ALIGN_RIGHT);
}

/* Faint words where a method is off. */
void panels_add_methods(TextBlock *block, const Simulation *simulation,
                        int projected, int trials)
{
    const Options *options = &simulation->options;
    if (simulation->scene->picture != PICTURE_CURVE) {
        if (options->filter == FILTER_NONE || projected < 0)
            text_block_add(block, COLOUR_TEXT, "projection  %s",
                           filter_name(options->filter));
        else
            text_block_add(block, COLOUR_TEXT, "projection  %s, %d spring%s",
                           filter_name(options->filter), projected,
                           projected == 1 ? "" : "s");
    }
    if (options->line_search == LINE_SEARCH_NONE || projected < 0)
        text_block_add(block, COLOUR_TEXT, "line search %s",
                       line_search_name(options->line_search));
    else
        text_block_add(block, COLOUR_TEXT, "line search %s, %d tried",
                       line_search_name(options->line_search), trials);
}

/* Its direction, its length, what it did to the energy. */
void panels_draw_update(Paper *paper, const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    bool map = simulation->scene->picture == PICTURE_LANDSCAPE;
    TextBlock block = {0};
    if (descent->count == 0) {
        panels_add_methods(&block, simulation, -1, 0);
        panels_draw_right(paper, &block);
        return;
    }
    const NewtonRecord *record = &descent->record[descent->count - 1];
    bool uphill = record->slope > 0;
    panels_add_methods(&block, simulation, record->projected, record->trials);
    text_block_add(&block, uphill ? COLOUR_WARNING : COLOUR_TEXT,
                   "last update %s, alpha %.3g", uphill ? "UPHILL" : "downhill",
                   record->alpha);
    text_block_add(&block, record->change > 0 ? COLOUR_WARNING : COLOUR_TEXT,
                   "change of %s %+.3g%s", map ? "E" : "f", record->change,
                   map ? " J s^2" : "");
    panels_draw_right(paper, &block);
}

/* Lower left. */
Box panels_plot_box(const Paper *paper)
{
    Box box = {panel_edge(paper), 0, paper_pixels(paper, PLOT_WIDTH),
               paper_pixels(paper, PLOT_HEIGHT)};
    box.y = paper->canvas.height - panel_edge(paper) - box.height;
    return box;
}

/* Lower right, as high as the plot. */
void panels_draw_legend(Paper *paper, const TextBlock *block)
{
    text_block_draw(block, paper, paper->canvas.width - panel_edge(paper),
                    panels_plot_box(paper).y, ALIGN_RIGHT);
}

/* Columns of equal width. */
void panels_draw_columns(Paper *paper, const TextBlock *blocks, int count)
{
    int edge = panel_edge(paper), width = paper->canvas.width - 2 * edge;
    int y = paper->canvas.height - edge - paper_pixels(paper, COLUMNS_HEIGHT);
    for (int i = 0; i < count; i++)
        text_block_draw(&blocks[i], paper, edge + i * width / count, y,
                        ALIGN_LEFT);
}

/* Between blocks and trouble, over the full width. */
Box panels_middle_box(const Paper *paper)
{
    int edge = panel_edge(paper), top = paper_pixels(paper, MIDDLE_AT);
    int below = paper_pixels(paper, COLUMNS_HEIGHT + TROUBLE_HEIGHT) + edge;
    return (Box){edge, top, paper->canvas.width - 2 * edge,
                 paper->canvas.height - top - below};
}

/* Upper edge of what is along the lower edge of the picture. */
static int panels_floor(const Paper *paper, const Simulation *simulation,
                        const Hud *hud)
{
    int bottom = paper->canvas.height - panel_edge(paper);
    if (!hud->text)
        return bottom;
    return bottom - paper_pixels(paper, has_time(simulation) ? PLOT_HEIGHT
                                                             : COLUMNS_HEIGHT);
}

/* The key that changes what went wrong, or "". */
static const char *helpful_key(const Simulation *simulation, const Hud *hud)
{
    if (!hud->hints || hud->trouble == STATUS_NOT_FINITE)
        return "";
    if (simulation->scene->picture == PICTURE_CURVE)
        return simulation->options.line_search == LINE_SEARCH_NONE
                   ? "   L: line search"
                   : "";
    return simulation->options.filter == FILTER_NONE ? "   P: projection" : "";
}

/* Which step, which iteration, which status, and what that means. */
void panels_draw_trouble(Paper *paper, const Simulation *simulation,
                         const Hud *hud)
{
    TextBlock block = {0};
    char where[TEXT_BLOCK_SIZE] = "at the start";
    if (!hud->trouble)
        return;
    if (hud->trouble_step > 0 && !has_time(simulation))
        snprintf(where, sizeof where, "iteration %ld", hud->trouble_step);
    else if (hud->trouble_step > 0 && hud->iterations > 0)
        snprintf(where, sizeof where, "step %ld, iteration %d",
                 hud->trouble_step, hud->iterations);
    else if (hud->trouble_step > 0)
        snprintf(where, sizeof where, "step %ld", hud->trouble_step);
    text_block_add(&block, COLOUR_WARNING, "%s: %s%s", where,
                   status_name(hud->trouble), helpful_key(simulation, hud));
    text_block_add(&block, COLOUR_WARNING, "%s", status_text(hud->trouble));
    text_block_draw(&block, paper, paper->canvas.width / 2,
                    panels_floor(paper, simulation, hud) -
                        text_block_size(&block, paper).height,
                    ALIGN_CENTRE);
}

/* Where trouble would be, above it where it is. */
void panels_draw_note(Paper *paper, const Simulation *simulation,
                      const Hud *hud)
{
    TextBlock block = {0};
    if (hud->note[0] == '\0')
        return;
    text_block_add(&block, COLOUR_TEXT, "%s", hud->note);
    int y = panels_floor(paper, simulation, hud) -
            text_block_size(&block, paper).height;
    if (hud->trouble)
        y -= paper_pixels(paper, TROUBLE_HEIGHT);
    text_block_draw(&block, paper, paper->canvas.width / 2, y, ALIGN_CENTRE);
}

/* The keys that work in this scene. */
static void add_key_lines(TextBlock *block, const Simulation *simulation)
{
    PictureKind picture = simulation->scene->picture;
    int count = 0;
    while (scenes[count].name)
        count++;
    text_block_add(block, COLOUR_TEXT, "Space      pause, go on");
    text_block_add(block, COLOUR_TEXT, "N, Right   one %s",
                   has_time(simulation) ? "step" : "iteration");
    text_block_add(block, COLOUR_TEXT, "R          restart");
    text_block_add(block, COLOUR_TEXT, "+ -        faster, slower");
    if (picture == PICTURE_SQUARE)
        text_block_add(block, COLOUR_TEXT, "C          colours show strain");
    if (simulation_has_filter(simulation))
        text_block_add(block, COLOUR_TEXT, "P          projection on, off");
    if (simulation_has_line_search(simulation))
        text_block_add(block, COLOUR_TEXT, "L          line search on, off");
    if (picture == PICTURE_LANDSCAPE)
        text_block_add(block, COLOUR_TEXT, "mouse      another start");
    text_block_add(block, COLOUR_TEXT, "H          hide or show all text");
    text_block_add(block, COLOUR_TEXT, "S          save a picture (PNG)");
    for (int i = 0; i < count && i < 9; i++)
        text_block_add(
            block, scenes + i == simulation->scene ? COLOUR_FAINT : COLOUR_TEXT,
            "%d          %s", i + 1, scenes[i].name);
    text_block_add(block, COLOUR_TEXT, "?, F1      this list");
    text_block_add(block, COLOUR_TEXT, "Q, Esc     quit");
}

/* On a background that hides the picture. */
void panels_draw_keys(Paper *paper, const Simulation *simulation)
{
    TextBlock block = {0};
    add_key_lines(&block, simulation);
    Box box = text_block_size(&block, paper);
    int x = (paper->canvas.width - box.width) / 2;
    int y = (paper->canvas.height - box.height) / 2;
    int frame = paper_pixels(paper, 1);
    canvas_rectangle(&paper->canvas, x - frame, y - frame,
                     box.width + 2 * frame, box.height + 2 * frame,
                     COLOUR_FAINT);
    canvas_rectangle(&paper->canvas, x, y, box.width, box.height, COLOUR_WHITE);
    text_block_draw(&block, paper, paper->canvas.width / 2, y, ALIGN_CENTRE);
}
