#include "panels.h"

#include <math.h>
#include <stdio.h>

#include "colour_map.h"
#include "plot.h"
#include "scene.h"

/* Sizes in units. */
enum {
    EDGE = 5, /* from panels to the edge of the picture */
    PLOT_WIDTH = 244,
    PLOT_HEIGHT = 90,
    LEGEND_WIDTH = 186,
    LEGEND_HEIGHT = 44,
    LEGEND_BAR = 8,
    TROUBLE_AT = 96 /* from the upper edge */
};

/* Distance from panels to the edge in pixels. */
static int panel_edge(const Paper *paper)
{
    return paper_pixels(paper, EDGE);
}

/* "slow motion x0.24": what is set, and what is reached where it differs. */
static void format_speed(char *text, size_t size, const Hud *hud)
{
    double speed = hud->speed;
    bool behind = hud->measured > 0 && hud->measured < 0.85 * speed;
    double shown = behind ? hud->measured : speed;
    const char *word = shown < 0.95   ? "slow motion "
                       : shown < 1.05 ? "real time "
                                      : "fast motion ";
    if (behind)
        snprintf(text, size, "%sx%.2g of x%.2g", word, shown, speed);
    else
        snprintf(text, size, "%sx%.2g", word, shown);
}

/* Step and time where there is time, iterations where there is none. */
static void add_progress_lines(TextBlock *block, const Simulation *simulation,
                               const Hud *hud)
{
    const char *paused = simulation->done ? "   end"
                         : hud->paused    ? "   paused"
                                          : "";
    char speed[TEXT_BLOCK_SIZE];
    if (!(simulation->scene->needs & NEEDS_TIME)) {
        text_block_add(block, COLOUR_TEXT, "iteration %ld%s", simulation->steps,
                       paused);
        return;
    }
    format_speed(speed, sizeof speed, hud);
    text_block_add(block, COLOUR_TEXT, "step      %ld%s", simulation->steps,
                   paused);
    text_block_add(block, COLOUR_TEXT, "time      %.4g s",
                   simulation_time(simulation));
    text_block_add(block, COLOUR_TEXT, "speed     %s", speed);
}

/* Step, time, speed, method, mesh. */
void panels_draw_run(Paper *paper, const Simulation *simulation, const Hud *hud)
{
    const TimeIntegrator *run = &simulation->run[0];
    unsigned needs = simulation->scene->needs;
    TextBlock block = {0};
    add_progress_lines(&block, simulation, hud);
    if ((needs & NEEDS_TIME) && simulation->runs == 1)
        text_block_add(&block, COLOUR_FAINT, "method    %s",
                       run->method->label);
    if (needs & NEEDS_TIME)
        text_block_add(&block, COLOUR_FAINT, "timestep  %g s", run->h);
    if (needs & NEEDS_MESH)
        text_block_add(&block, COLOUR_FAINT, "segments  %d (%d springs)",
                       simulation->mesh.segments, simulation->system.springs);
    if (simulation->unconverged > 0)
        text_block_add(&block, COLOUR_WARNING, "steps not converged: %ld",
                       simulation->unconverged);
    text_block_draw(&block, paper, panel_edge(paper), panel_edge(paper),
                    ALIGN_LEFT);
}

/* The record of the last iteration. */
static void add_record_lines(TextBlock *block, const NewtonRecord *record)
{
    const char *way = record->slope < 0   ? "downhill"
                      : record->slope > 0 ? "UPHILL"
                                          : "level";
    text_block_add(block, record->slope > 0 ? COLOUR_WARNING : COLOUR_TEXT,
                   "direction   %s", way);
    text_block_add(block, COLOUR_TEXT, "step length %.3g", record->alpha);
    text_block_add(block, COLOUR_TEXT, "tried       %d", record->trials);
    text_block_add(block, COLOUR_TEXT, "change      %.3g", record->change);
    text_block_add(block, COLOUR_TEXT, "residual    %.2e", record->residual);
}

/* Direction, step length, change, methods. */
void panels_draw_descent(Paper *paper, const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    TextBlock block = {0};
    if (descent->count > 0)
        add_record_lines(&block, &descent->record[descent->count - 1]);
    if (simulation->scene->picture == PICTURE_LANDSCAPE)
        text_block_add(&block, COLOUR_FAINT, "filter      %s",
                       filter_name(simulation->options.filter));
    text_block_add(&block, COLOUR_FAINT, "line search %-12s",
                   line_search_name(simulation->options.line_search));
    text_block_draw(&block, paper, paper->canvas.width - panel_edge(paper),
                    panel_edge(paper), ALIGN_RIGHT);
}

/* Updates, residual, step length, projection, line search. */
static void add_newton_lines(TextBlock *block, const Newton *newton,
                             const Hud *hud)
{
    char residual[TEXT_BLOCK_SIZE] = "-", alpha[TEXT_BLOCK_SIZE] = "-";
    if (hud->stepped)
        snprintf(residual, sizeof residual, "%.2e m/s", newton->residual);
    if (hud->iterations > 0)
        snprintf(alpha, sizeof alpha, "%.3g", hud->alpha);
    text_block_add(block, COLOUR_TEXT, "Newton iterations %d", hud->iterations);
    text_block_add(block, COLOUR_TEXT, "residual          %s", residual);
    text_block_add(block, COLOUR_TEXT, "step length       %s", alpha);
    text_block_add(block, COLOUR_TEXT, "lengths tried     %d", hud->trials);
    text_block_add(block, COLOUR_TEXT, "springs projected %ld", hud->projected);
    text_block_add(block, COLOUR_FAINT, "filter            %s",
                   filter_name(newton->settings.filter));
    text_block_add(block, COLOUR_FAINT, "line search       %-12s",
                   line_search_name(newton->settings.search));
}

/* Nothing to tell about explicit methods but that they are. */
void panels_draw_newton(Paper *paper, const Simulation *simulation,
                        const Hud *hud)
{
    TextBlock block = {0};
    const Newton *newton = simulation->run[0].newton;
    if (newton)
        add_newton_lines(&block, newton, hud);
    else
        text_block_add(&block, COLOUR_TEXT, "explicit: no Newton iteration");
    text_block_draw(&block, paper, paper->canvas.width - panel_edge(paper),
                    panel_edge(paper), ALIGN_RIGHT);
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

/* The unit in which an energy up to `high` has few digits. */
typedef struct EnergyUnit {
    double joule;
    const char *name;
} EnergyUnit;

/* J, or a thousand, a million, ... times more or less. */
static EnergyUnit energy_unit(double high)
{
    static const EnergyUnit units[] = {
        {1e12, "TJ"}, {1e9, "GJ"},  {1e6, "MJ"},  {1e3, "kJ"},
        {1, "J"},     {1e-3, "mJ"}, {1e-6, "uJ"},
    };
    if (high >= 1e16 || high < 1e-6)
        return (EnergyUnit){1, "J"};
    size_t i = 0;
    while (high < units[i].joule)
        i++;
    return units[i];
}

/* Three curves; the axes grow by round numbers. */
static void draw_energy_plot(Paper *paper, const Simulation *simulation,
                             const History *history, EnergyUnit unit)
{
    Box outer = panels_plot_box(paper);
    char label[TEXT_BLOCK_SIZE];
    snprintf(label, sizeof label, "energy in %s", unit.name);
    double last = simulation_time(simulation);
    double least = 100 * simulation->options.timestep;
    Axis time = {0, plot_round_up(fmax(last, least)), "time in s"};
    double high = history->high > 0 ? fmin(history->high, 1e300) : 1;
    Axis energy = {0, plot_round_axis(high / unit.joule), label};
    Plot plot = plot_create(paper, outer, time, energy);
    plot.y.high *= unit.joule;
    const Colour colour[HISTORY_SERIES] = {COLOUR_TOTAL, COLOUR_KINETIC,
                                           COLOUR_ELASTIC};
    for (int s = 0; s < HISTORY_SERIES; s++)
        plot_curve(paper, &plot, history->count, history->time,
                   history->value[s], colour[s]);
}

/* The plot, and its legend with the numbers. */
void panels_draw_energies(Paper *paper, const Simulation *simulation,
                          const Hud *hud)
{
    const Energies *energies = &hud->energies;
    const EnergyUnit unit = energy_unit(hud->history.high);
    TextBlock block = {0};
    draw_energy_plot(paper, simulation, &hud->history, unit);
    text_block_add(&block, COLOUR_TOTAL, "total   %10.6g J", energies->total);
    text_block_add(&block, COLOUR_KINETIC, "kinetic %10.6g J",
                   energies->kinetic);
    text_block_add(&block, COLOUR_ELASTIC, "elastic %10.6g J",
                   energies->elastic);
    panels_draw_legend(paper, &block);
}

/* The bar from compressed to stretched. */
static void draw_strain_bar(Paper *paper, Box bar)
{
    for (int i = 0; i < bar.width; i++) {
        double strain = 2 * (i + 0.5) / bar.width - 1;
        canvas_rectangle(&paper->canvas, bar.x + i, bar.y, 1, bar.height,
                         colour_map_strain(strain, 1));
    }
}

/* Words above the bar, numbers below. */
void panels_draw_strain_legend(Paper *paper, double range)
{
    int margin = paper_pixels(paper, 4);
    Box panel = {0, 0, paper_pixels(paper, LEGEND_WIDTH),
                 paper_pixels(paper, LEGEND_HEIGHT)};
    panel.x = paper->canvas.width - panel_edge(paper) - panel.width;
    panel.y = paper->canvas.height - panel_edge(paper) - panel.height;
    Box bar = {panel.x + margin, panel.y + paper->font.height + 2 * margin,
               panel.width - 2 * margin, paper_pixels(paper, LEGEND_BAR)};
    int middle = bar.x + bar.width / 2, right = bar.x + bar.width;
    int below = bar.y + bar.height + margin;
    char low[TEXT_BLOCK_SIZE], high[TEXT_BLOCK_SIZE];
    snprintf(low, sizeof low, "-%.3g %%", 100 * fmin(range, 1));
    snprintf(high, sizeof high, "+%.3g %%", 100 * range);
    paper_panel(paper, panel);
    draw_strain_bar(paper, bar);
    int above = panel.y + margin;
    paper_text(paper, bar.x, above, ALIGN_LEFT, COLOUR_TEXT, "compressed");
    paper_text(paper, middle, above, ALIGN_CENTRE, COLOUR_TEXT, "at rest");
    paper_text(paper, right, above, ALIGN_RIGHT, COLOUR_TEXT, "stretched");
    paper_text(paper, bar.x, below, ALIGN_LEFT, COLOUR_TEXT, low);
    paper_text(paper, middle, below, ALIGN_CENTRE, COLOUR_TEXT, "strain 0");
    paper_text(paper, right, below, ALIGN_RIGHT, COLOUR_TEXT, high);
}

/* Which step, and why. */
void panels_draw_trouble(Paper *paper, const Hud *hud)
{
    if (!hud->trouble)
        return;
    bool made = status_is_unconverged(hud->trouble);
    TextBlock block = {0};
    text_block_add(&block, COLOUR_WARNING, "step %ld %s:", hud->trouble_step,
                   made ? "did not converge" : "failed");
    text_block_add(&block, COLOUR_WARNING, "%s", status_text(hud->trouble));
    text_block_draw(&block, paper, paper->canvas.width / 2,
                    paper_pixels(paper, TROUBLE_AT), ALIGN_CENTRE);
}

/* In the middle of the lower part. */
void panels_draw_note(Paper *paper, const Hud *hud)
{
    TextBlock block = {0};
    if (hud->note[0] == '\0')
        return;
    text_block_add(&block, COLOUR_TEXT, "%s", hud->note);
    Box box = text_block_size(&block, paper);
    text_block_draw(&block, paper, paper->canvas.width / 2,
                    paper->canvas.height - 2 * panel_edge(paper) -
                        paper_pixels(paper, PLOT_HEIGHT) - box.height,
                    ALIGN_CENTRE);
}

/* Every key and what it does. */
void panels_draw_keys(Paper *paper)
{
    static const char *const lines[] = {
        "Space      pause, go on",
        "N, Right   one step",
        "R          restart",
        "+ -        faster, slower",
        "C          colours show strain",
        "H          hide or show all text",
        "P          projection clamp, none",
        "L          line search on, off",
        "1 ... 9    another scene",
        "mouse      another start on the map",
        "S          save a picture (PNG)",
        "?, F1      this list",
        "Q, Esc     quit",
    };
    TextBlock block = {0};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        text_block_add(&block, COLOUR_TEXT, "%s", lines[i]);
    Box box = text_block_size(&block, paper);
    int y = (paper->canvas.height - box.height) / 2;
    Box back = {(paper->canvas.width - box.width) / 2, y, box.width,
                box.height};
    canvas_rectangle(&paper->canvas, back.x, back.y, back.width, back.height,
                     0xd0ffffff);
    text_block_draw(&block, paper, paper->canvas.width / 2, y, ALIGN_CENTRE);
}
