#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/plot.h"
#include "scenes/scene.h"

static const double RADIUS_AXIS = 2; /* m, upper end; curves may leave it */

/* The unit in which an energy up to `high` has few digits. */
typedef struct EnergyUnit {
    double joule;
    const char *name;
} EnergyUnit;

static EnergyUnit energy_unit(double high)
{
    static const EnergyUnit units[] = {
        {1e12, "TJ"}, {1e9, "GJ"},  {1e6, "MJ"},       {1e3, "kJ"},
        {1, "J"},     {1e-3, "mJ"}, {1e-6, "\u00b5J"},
    };
    if (high >= 1e16 || high < 1e-6)
        return (EnergyUnit){1, "J"};
    size_t i = 0;
    while (high < units[i].joule)
        i++;
    return units[i];
}

/* Whether several panes are compared: then each has one curve. */
static bool compares(const Show *show)
{
    return show->panes > 1;
}

/* The curve of one quantity of one pane; points far apart in time are still
 * joined. */
static void draw_series(Paper *paper, const Plot *plot, const History *history,
                        int series, double width, Colour colour)
{
    plot_curve(paper, plot, history->count, history->time,
               history->value[series], width, colour);
}

/* Whether a quantity was ever anything but 0; the first three always count. */
static bool series_counts(const History *history, int series)
{
    for (int i = 0; i < history->count; i++)
        if (history->value[series][i] != 0)
            return true;
    return series < 3;
}

/* Range of all that is drawn. */
static void find_range(const Show *show, double *low, double *high,
                       double *last)
{
    for (int p = 0; p < show->panes; p++) {
        const History *history = show->pane[p].history;
        if (!history || (!compares(show) && p != show->active))
            continue;
        *low = fmin(*low, history->low);
        *high = fmax(*high, history->high);
        if (history->count > 0)
            *last = fmax(*last, history->time[history->count - 1]);
    }
}

/* A vertical line at the time that is shown, if it is not the last one. */
static void draw_now(Paper *paper, const Plot *plot, double time)
{
    double at[2];
    plot_place(plot, time, plot->y.low, at);
    if (time < plot->x.high)
        canvas_line(&paper->canvas, floor(at[0]) + 0.5, plot->box.y,
                    floor(at[0]) + 0.5, plot->box.y + plot->box.height,
                    fmax(1, paper->unit), COLOUR_BORDER);
}

/* The value at this time, or the last one before it. */
static double value_at(const History *history, int series, double time)
{
    double value = NAN, nothing = 1e-15 * (history->high - history->low);
    for (int i = 0;
         i < history->count && history->time[i] <= time * (1 + 1e-12); i++)
        value = history->value[series][i];
    return fabs(value) < nothing ? 0 : value; /* rounding is not an energy */
}

/* One word of the legend with its number; returns where the next goes.
 *   value  J; NaN: the name alone */
static int draw_word(Paper *paper, Box *row, int x, Colour colour,
                     const char *name, double value)
{
    char number[48], words[128];
    EnergyUnit unit = energy_unit(fabs(value));
    if (isfinite(value)) {
        plot_number(number, sizeof number, value / unit.joule);
        snprintf(words, sizeof words, "%s %s %s", name, number, unit.name);
    } else {
        snprintf(words, sizeof words, "%s", name);
    }
    int width = paper_width(paper, FACE_REGULAR, 0.85, words);
    if (x > row->x && x + width > row->x + row->width) {
        x = row->x;
        row->y += paper_pixels(paper, 1.15);
    }
    paper_write(paper, FACE_REGULAR, 0.85, colour, x, row->y, ALIGN_LEFT, "%s",
                words);
    return x + width + paper_pixels(paper, 0.9);
}

/* Names in the colours of the curves; values, or in a narrow card that of the
 * first one alone. */
static Box draw_legend(Paper *paper, Box inside, const Show *show, double time)
{
    Box row = inside;
    bool narrow = inside.width < 20 * paper->em;
    int x = row.x;
    for (int p = 0; compares(show) && p < show->panes; p++)
        if (show->pane[p].history)
            x = draw_word(paper, &row, x, colour_of_run(p),
                          show->pane[p].label ? show->pane[p].label : "",
                          narrow ? NAN
                                 : value_at(show->pane[p].history, 0, time));
    const History *history = show->pane[show->active].history;
    for (int s = 0; !compares(show) && s < history->series; s++)
        if (series_counts(history, s))
            x = draw_word(paper, &row, x, colour_of_energy(s),
                          history->name[s] ? history->name[s] : "",
                          narrow && s > 0 ? NAN : value_at(history, s, time));
    int used = row.y + paper_pixels(paper, 1.3) - inside.y;
    return (Box){inside.x, inside.y + used, inside.width, inside.height - used};
}

static void draw_energies(Paper *paper, Box inside, const Show *show)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    double low = 0, high = 0, last = 100 * simulation->options.timestep;
    double now = simulation_time(simulation);
    if (!show->pane[show->active].history)
        return;
    find_range(show, &low, &high, &last);
    high = high > 0 ? fmin(high, 1e300) : 1;
    EnergyUnit unit = energy_unit(fmax(high, -low));
    Box rest = draw_legend(paper, inside, show, now);
    Axis time = {0, plot_round_up(last), false, false, "t in s"};
    Axis energy = {0, plot_round_axis(high / unit.joule), false, false,
                   unit.name};
    if (low < -0.01 * high)
        energy.low = -plot_round_axis(-low / unit.joule);
    Plot plot = plot_create(paper, rest, time, energy);
    plot.y.low *= unit.joule;
    plot.y.high *= unit.joule;
    draw_now(paper, &plot, now);
    for (int p = 0; compares(show) && p < show->panes; p++)
        if (show->pane[p].history)
            draw_series(paper, &plot, show->pane[p].history, 0, 1.8,
                        colour_of_run(p));
    const History *history = show->pane[show->active].history;
    for (int s = history->series - 1; !compares(show) && s >= 0; s--)
        if (series_counts(history, s))
            draw_series(paper, &plot, history, s, s == 0 ? 1.8 : 1.4,
                        colour_of_energy(s));
}

const Card card_energies = {
    .name = "energies",
    .title = "Energies over time",
    .least = 8,
    .weight = 1,
    .half = true,
    .draw = draw_energies,
};

/* One curve a run, on an axis that does not move. */
static void draw_radius(Paper *paper, Box inside, const Show *show)
{
    const Pane *pane = &show->pane[show->active];
    const Simulation *simulation = pane->simulation;
    double last =
        fmax(simulation_time(simulation), 100 * simulation->options.timestep);
    if (!pane->history)
        return;
    Plot plot = plot_create(
        paper, inside, (Axis){0, plot_round_up(last), false, false, "t in s"},
        (Axis){0, RADIUS_AXIS, false, false, NULL});
    for (int s = 0; s < pane->history->series; s++)
        draw_series(paper, &plot, pane->history, s, 1.8,
                    circle_colour(simulation, s));
}

const Card card_radius = {
    .name = "radius",
    .title = "Radius over time, m",
    .least = 10,
    .weight = 1,
    .draw = draw_radius,
};
