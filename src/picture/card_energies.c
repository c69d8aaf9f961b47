#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/plot.h"
#include "scenes/scene.h"

static const double RADIUS_AXIS = 2;   /* m, upper end; curves may leave it */
static const double STILL = 1000;      /* times as high as what is shown now */
static const double LOG_FROM = 1e6;    /* times the energy at the beginning */
static const double LEAST_LOG = 1e-12; /* the same: where that axis begins */
static const double LEAST_SEEN =
    2e-3; /* of the largest: less lies on the axis */
static const double LEGEND_PART = 0.34; /* of the card, at most */

/* The unit in which an energy up to `high` has few digits. */
typedef struct EnergyUnit {
    double joule;
    const char *name;
} EnergyUnit;

/* What the axes have to hold. */
typedef struct EnergyRange {
    double low, high; /* J */
    double last;      /* s */
    double first;     /* J, the total at time 0 */
    double least;     /* J, the smallest total above 0; infinite: none */
} EnergyRange;

static EnergyUnit energy_unit(double high)
{
    static const EnergyUnit units[] = {
        {1e12, "TJ"}, {1e9, "GJ"},  {1e6, "MJ"},       {1e3, "kJ"},
        {1, "J"},     {1e-3, "mJ"}, {1e-6, "\u00b5J"},
    };
    if (high >= 1e16 || high < 1e-6)
        return (EnergyUnit){1, "J"};
    size_t i = 0;
    while (high < 0.9995 * units[i].joule) /* 1 with three digits */
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
static void draw_series(const Plot *plot, const History *history, int series,
                        double width, Colour colour)
{
    plot_curve(plot, history->count, history->time, history->value[series],
               width, colour);
}

/* Whether its series are runs side by side, each with a total of its own, not
 * the parts of one. */
static bool series_are_runs(const Simulation *simulation)
{
    return simulation->scene->picture == PICTURE_MASS && simulation->runs > 1;
}

static Colour series_colour(const Simulation *simulation,
                            const History *history, int series)
{
    if (series_are_runs(simulation))
        return circle_colour(simulation, series);
    return colour_of_energy(series == 0 ? "total" : history->name[series]);
}

/* The last point of the history that is not later than this time; -1: none. */
static int point_at(const History *history, double time)
{
    int at = -1;
    while (at + 1 < history->count &&
           history->time[at + 1] <= time * (1 + 1e-12))
        at++;
    return at;
}

/* The quantities that are worth a curve, bit s for s: the first three, and
 * those which at some time could be told from 0 beside the largest one until
 * then. */
static unsigned worthy_series(const Simulation *simulation,
                              const History *history)
{
    unsigned all = (1u << history->series) - 1, worthy = all & 7;
    double most = 0;
    if (series_are_runs(simulation))
        return all;
    for (int i = 0; i < history->count; i++) {
        for (int s = 0; s < history->series; s++)
            most = fmax(most, fabs(history->value[s][i]));
        for (int s = 3; s < history->series; s++)
            if (fabs(history->value[s][i]) > LEAST_SEEN * most)
                worthy |= 1u << s;
    }
    return worthy;
}

/* Range of all that is drawn up to now; the first total at its greatest. */
static EnergyRange find_range(const Show *show)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    EnergyRange range = {0, 0, 100 * simulation->options.timestep, 0, INFINITY};
    double now = simulation_time(simulation);
    for (int p = 0; p < show->panes; p++) {
        const History *history = show->pane[p].history;
        if (!history || (!compares(show) && p != show->active))
            continue;
        int point = point_at(history, now);
        for (int s = 0; s < (compares(show) ? 1 : history->series); s++)
            for (int i = 0; i <= point; i++) {
                range.low = fmin(range.low, history->value[s][i]);
                range.high = fmax(range.high, history->value[s][i]);
                bool total = s == 0 || series_are_runs(simulation);
                if (total && history->value[s][i] > 0)
                    range.least = fmin(range.least, history->value[s][i]);
            }
        if (history->count > 0) {
            range.last = fmax(range.last, history->time[history->count - 1]);
            range.first = fmax(range.first, history->value[0][0]);
        }
    }
    /* An axis that holds still is easier to read: it is that of the whole run
     * as long as what is shown so far can be seen on it. */
    double low = range.low, high = range.high;
    for (int p = 0; p < show->panes; p++) {
        const History *history = show->pane[p].history;
        if (!history || (!compares(show) && p != show->active))
            continue;
        low = fmin(low, history->low);
        high = fmax(high, history->high);
    }
    if (fmax(high, -low) < STILL * fmax(range.high, -range.low)) {
        range.low = low;
        range.high = high;
    }
    return range;
}

/* A vertical line at the time that is shown, if it is not the last one. */
static void draw_now(const Plot *plot, double time)
{
    Paper *paper = plot->paper;
    double at[2];
    plot_place(plot, (double[2]){time, plot->y.low}, at);
    if (time < plot->x.high)
        canvas_line(&paper->canvas, floor(at[0]) + 0.5, plot->box.y,
                    floor(at[0]) + 0.5, plot->box.y + plot->box.height,
                    fmax(1, paper->unit), COLOUR_BORDER);
}

/* Whether the energies now are no numbers any more, so that the history has
 * no point of them. */
static bool is_beyond(const Simulation *simulation, const History *history,
                      double time)
{
    double now = simulation_time(simulation);
    double last = history->time[history->count - 1] * (1 + 1e-12);
    return time >= now && now > last && !series_are_runs(simulation) &&
           !isfinite(simulation_energies(simulation, 0).total);
}

double energies_value(const Simulation *simulation, const History *history,
                      int series, double time)
{
    int point = point_at(history, time);
    if (point < 0)
        return NAN;
    if (is_beyond(simulation, history, time))
        return INFINITY;
    double value = history->value[series][point], now = 0, first = 0;
    for (int s = 0; s < history->series && !series_are_runs(simulation); s++) {
        now = fmax(now, fabs(history->value[s][point]));
        first = fmax(first, fabs(history->value[s][0]));
    }
    return fabs(value) < 1e-15 * fmin(now, first) ? 0 : value;
}

Axis energies_axis(const Show *show, double *joule, double *last)
{
    EnergyRange range = find_range(show);
    double high = range.high > 0 ? fmin(range.high, 1e300) : 1;
    double low = fmax(range.low, -1e300);
    EnergyUnit unit = energy_unit(fmax(high, -low));
    *joule = unit.joule;
    *last = range.last;
    if (!(range.first > 0)) /* at rest in a field: what came first tells */
        range.first = -low;
    if (range.first > 0 && high > LOG_FROM * range.first) {
        unit = energy_unit(1);
        *joule = 1;
        double least = fmax(range.least, LEAST_LOG * range.first);
        return (Axis){pow(10, floor(log10(least)) - 1),
                      pow(10, ceil(log10(high))), true, false, unit.name};
    }
    Axis axis = {0, plot_round_axis(high / unit.joule), false, false,
                 unit.name};
    if (low < -0.01 * high)
        axis.low = -plot_round_axis(-low / unit.joule);
    return axis;
}

/* One word of the legend with its number; returns where the next goes.
 *   value   J; NaN: the name alone
 *   size    ems, letters
 *   colour  0: nothing is drawn, only the room is measured */
static int draw_word(Paper *paper, Box *row, int x, double size, Colour colour,
                     const char *name, double value)
{
    char words[128];
    EnergyUnit unit = energy_unit(fabs(value));
    if (isnan(value))
        snprintf(words, sizeof words, "%s", name);
    else
        snprintf(words, sizeof words, "%s %s %s", name,
                 number_of(value / unit.joule).text, unit.name);
    int width = paper_width(paper, FACE_REGULAR, size, words);
    if (x > row->x && x + width > row->x + row->width) {
        x = row->x;
        row->y += paper_pixels(paper, 1.35 * size);
    }
    if (colour)
        paper_write(paper, FACE_REGULAR, size, colour, x, row->y, ALIGN_LEFT,
                    "%s", words);
    return x + width + paper_pixels(paper, 1.05 * size);
}

/* Names in the colours of the curves with the first `numbers` values; returns
 * the pixels it is high, all of the box where it is too wide. */
static int write_legend(Paper *paper, Box inside, const Show *show,
                        unsigned worthy, double size, int numbers, bool draw)
{
    const Pane *active = &show->pane[show->active];
    double time = simulation_time(active->simulation);
    Box row = inside;
    int x = row.x, count = 0, end = row.x;
    for (int p = 0; compares(show) && p < show->panes; p++) {
        const Pane *pane = &show->pane[p];
        if (!pane->history)
            continue;
        double value =
            count++ >= numbers
                ? NAN
                : energies_value(pane->simulation, pane->history, 0, time);
        x = draw_word(paper, &row, x, size, draw ? colour_of_run(p) : 0,
                      pane->label ? pane->label : "", value);
        end = x > end ? x : end;
    }
    const History *history = active->history;
    for (int s = 0; !compares(show) && s < history->series; s++) {
        if (!(worthy >> s & 1))
            continue;
        double value = count++ >= numbers ? NAN
                                          : energies_value(active->simulation,
                                                           history, s, time);
        x = draw_word(paper, &row, x, size,
                      draw ? series_colour(active->simulation, history, s) : 0,
                      history->name[s] ? history->name[s] : "", value);
        end = x > end ? x : end;
    }
    int gap = paper_pixels(paper, 1.05 * size);
    if (end - gap > inside.x + inside.width) /* a single word is too wide */
        return inside.height;
    return row.y + paper_pixels(paper, 1.5 * size) - inside.y;
}

/* All names and numbers, if they leave the curves most of the card; else the
 * total alone has a number, or none, or the letters are smaller. */
static Box draw_legend(Paper *paper, Box inside, const Show *show,
                       unsigned worthy)
{
    static const struct {
        double size;
        int numbers;
    } ways[] = {{0.85, HISTORY_SERIES},
                {0.75, HISTORY_SERIES},
                {0.85, 1},
                {0.75, 1},
                {0.75, 0},
                {0.65, 0}};
    enum { WAYS = sizeof ways / sizeof *ways };
    int most = (int)(LEGEND_PART * inside.height), way = 0;
    int line = paper_pixels(paper, 1.5 * ways[0].size);
    most = most > line ? most : line;
    while (way + 1 < WAYS &&
           write_legend(paper, inside, show, worthy, ways[way].size,
                        ways[way].numbers, false) > most)
        way++;
    int used = write_legend(paper, inside, show, worthy, ways[way].size,
                            ways[way].numbers, true);
    used = used < inside.height ? used : most;
    return (Box){inside.x, inside.y + used, inside.width, inside.height - used};
}

static void draw_energies(Paper *paper, Box inside, const Show *show)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    double joule, last;
    if (!show->pane[show->active].history)
        return;
    const History *history = show->pane[show->active].history;
    unsigned worthy = worthy_series(simulation, history);
    Box rest = draw_legend(paper, inside, show, worthy);
    Axis energy = energies_axis(show, &joule, &last);
    Axis time = {0, plot_round_up(last), false, false, "t in s"};
    Plot plot = plot_create(paper, rest, time, energy);
    plot_unit(&plot, joule);
    draw_now(&plot, simulation_time(simulation));
    for (int p = 0; compares(show) && p < show->panes; p++)
        if (show->pane[p].history)
            draw_series(&plot, show->pane[p].history, 0, 1.8, colour_of_run(p));
    for (int s = history->series - 1; !compares(show) && s >= 0; s--)
        if (worthy >> s & 1)
            draw_series(&plot, history, s, s == 0 ? 1.8 : 1.4,
                        series_colour(simulation, history, s));
}

/* Of bodies apart only one is told of. */
static const char *energies_title(const Show *show)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    bool apart =
        simulation->runs > 1 && simulation->scene->picture == PICTURE_SQUARE;
    return apart ? "Energies of the first block" : "Energies over time";
}

const Card card_energies = {
    .name = "energies",
    .titled = energies_title,
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
        draw_series(&plot, pane->history, s, 1.8, circle_colour(simulation, s));
}

const Card card_radius = {
    .name = "radius",
    .title = "Radius over time, m",
    .least = 10,
    .weight = 1,
    .draw = draw_radius,
};
