/* card_energies.c - energies over time, energy budget, radii of orbits. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"

/* The axis covers the whole run, unless the largest energy of the run is more
 * than this many times the largest energy so far. */
static const double MAX_AXIS_RATIO = 1000;
/* The axis becomes logarithmic when the energy has grown LOG_GROWTH times, and
 * then shows at most LOG_LOW ... LOG_HIGH times the energy at the start. */
static const double LOG_GROWTH = 1e6, LOG_HIGH = 1e9, LOG_LOW = 1e-12;
static const double MIN_STEPS = 8; /* least length of the time axis, steps */
/* Energies always below this fraction of the largest one have no curve. */
static const double MIN_VISIBLE = 3e-3;
/* Energies below this fraction of k side^2 are rounding errors. */
static const double ROUNDING = 1e-20;
static const double LEGEND_SIZE = 0.85; /* ems, size of the legend's letters */
static const double LEGEND_GAP = 1;     /* letters, gap between two entries */
static const double MIN_PLOT = 4.7;   /* ems, least plot height with its axis */
static const double MIN_HEIGHT = 9.6; /* ems, least height of the card */
static const double ROW_HEIGHT = 1.2; /* ems, added for each of curves 5 to 7 */

/* A curve of a quantity of the history over time. */
typedef struct EnergyCurve {
    const Simulation *simulation;
    const History *history;
    int series;    /* index of the quantity in the history */
    bool is_total; /* is a total energy */
    Colour colour;
    const char *name;
} EnergyCurve;

typedef struct EnergyCurves {
    int count; /* number of curves */
    EnergyCurve curve[MAX_HISTORY_SERIES];
    int omitted_count;  /* number of curves for which the card has no room */
    double latest_time; /* s, latest time of all panes */
} EnergyCurves;

/* Whether quantity s of the history is the energy of run s; otherwise the
 * quantities are the energies of a single run. */
static bool has_series_per_run(const Simulation *simulation)
{
    PictureKind kind = simulation->scene->picture;
    return kind == PICTURE_CIRCLE || kind == PICTURE_MASS;
}

/* Finds the curves of the card.  With several panes or single masses, each pane
 * or run has one curve.  Otherwise the curves are the first three energies, and
 * each energy that was ever visible beside the largest energy. */
static EnergyCurves find_energy_curves(const FrameContent *content)
{
    EnergyCurves all = {
        .latest_time = simulation_get_time(active_pane(content)->simulation)};
    EnergyCurve *curve = all.curve;
    const Pane *active = active_pane(content);
    const History *history = active->history;
    bool runs = has_series_per_run(active->simulation);
    bool is_visible[MAX_HISTORY_SERIES] = {true, true, true};
    double most = 0;
    for (int p = 0; content->panes > 1 && p < content->panes; p++)
        if (content->pane[p].history)
            curve[all.count++] = (EnergyCurve){content->pane[p].simulation,
                                               content->pane[p].history,
                                               0,
                                               true,
                                               colour_of_run(p),
                                               content->pane[p].label};
    int series = !history || !history->series_count ? 0
                 : runs                             ? active->simulation->runs
                                                    : history->series_count;
    for (int i = 0; series > 3 && i < history->point_count; i++) {
        for (int s = 0; s < series; s++)
            most = fmax(most, fabs(history->value[s][i]));
        for (int s = 3; s < series; s++)
            is_visible[s] |= fabs(history->value[s][i]) > MIN_VISIBLE * most;
    }
    for (int s = 0; content->panes <= 1 && s < series; s++)
        if (runs || is_visible[s])
            curve[all.count++] = (EnergyCurve){
                active->simulation,
                history,
                s,
                runs || s == 0,
                runs ? colour_of_name(active->simulation->run[s].method->name)
                     : colour_of_name(s == 0 ? "total" : history->name[s]),
                history->name[s]};
    for (int c = 0; c < all.count; c++)
        all.latest_time =
            fmax(all.latest_time, simulation_get_time(curve[c].simulation));
    return all;
}

/* Returns the index of the last point up to this time; -1: no point. */
static int find_history_point(const History *history, double time)
{
    int at = -1;
    while (at + 1 < history->point_count &&
           history->time[at + 1] <= time * (1 + 1e-12))
        at++;
    return at;
}

/* Returns the present energy of a curve, J: 0 below rounding, NaN without a
 * point, infinity if the energies are not finite. */
static double find_present_energy(const EnergyCurve *curve)
{
    const History *history = curve->history;
    double now = simulation_get_time(curve->simulation), size = 0, first = 0;
    int point = find_history_point(history, now),
        last = history->point_count - 1;
    bool runs = has_series_per_run(curve->simulation);
    if (point < 0)
        return NAN;
    if (!runs && now > history->time[last] * (1 + 1e-12) &&
        !isfinite(simulation_get_energies(curve->simulation, 0).total))
        return INFINITY; /* infinite energies are not in the history */
    double value = history->value[curve->series][point];
    for (int s = 0; s < history->series_count && !runs; s++) {
        size = fmax(size, fabs(history->value[s][point]));
        first = fmax(first, fabs(history->value[s][0]));
    }
    return fabs(value) < 1e-15 * fmin(size, first) ? 0 : value;
}

double energies_find_height(const FrameContent *content, double wide, double em)
{
    int count = find_energy_curves(content).count;
    return MIN_HEIGHT + ROW_HEIGHT * fmin(fmax(count - 4, 0), 3);
}

/* Returns the largest rounding error of an energy, J. */
static double find_energy_rounding(const Simulation *simulation)
{
    const Options *options = &simulation->options;
    return ROUNDING * fmax(options->stiffness, options->young) * options->side *
           options->side;
}

/* Makes the axis of the energies.  The axis covers the whole run, unless the
 * energies so far would then be too small to see.  The axis is logarithmic if
 * no energy is far below 0, on a page with several panes or after a growth by
 * LOG_GROWTH.
 *   last  out, s, upper limit of the times of the curves */
static Axis make_energies_axis(const Simulation *simulation,
                               const EnergyCurves *all, double *last)
{
    double first = 0, least = INFINITY, low = 0, high = 0;
    double lowest = 0, highest = 0; /* extreme energies of the whole run */
    *last = MIN_STEPS * simulation->options.timestep;
    for (const EnergyCurve *curve = all->curve; curve < all->curve + all->count;
         curve++) {
        const History *history = curve->history;
        int point = find_history_point(history, all->latest_time);
        for (int i = 0; i < history->point_count; i++) {
            double value = history->value[curve->series][i];
            lowest = fmin(lowest, value);
            highest = fmax(highest, value);
            low = i <= point ? fmin(low, value) : low;
            high = i <= point ? fmax(high, value) : high;
            if (i <= point && curve->is_total && value > 0)
                least = fmin(least, value);
            *last = fmax(*last, history->time[i]);
            first = first > 0 ? fmin(first, history->value[0][0])
                              : history->value[0][0];
        }
    }
    if (fmax(highest, -lowest) < MAX_AXIS_RATIO * fmax(high, -low)) {
        low = lowest;
        high = highest;
    }
    double rounding = find_energy_rounding(simulation);
    high = high > rounding ? fmin(high, 1e300) : 1;
    low = fmax(low, -1e300);
    if (!(first > rounding)) /* the run began with E = 0: a fall from rest */
        first = -low;
    bool panes =
        simulation->options.page && all->count > 1 && all->curve[1].is_total;
    if (first > 0 && low >= -0.01 * high &&
        (panes || high > LOG_GROWTH * first))
        return (Axis){pow(10, floor(log10(fmax(least, LOG_LOW * first))) - 1),
                      pow(10, ceil(log10(fmin(high, LOG_HIGH * first)))),
                      .scale = SCALE_LOG, .label = "J"};
    return (Axis){low < -0.01 * high ? -plot_round_axis_end(-low) : 0,
                  plot_round_axis_end(high), .label = "J"};
}

static void draw_energy_curves(const Plot *plot, const EnergyCurves *all)
{
    for (int c = all->count - 1; c >= 0; c--) {
        const EnergyCurve *curve = &all->curve[c];
        plot_curve(plot, curve->history->point_count, curve->history->time,
                   curve->history->value[curve->series],
                   curve->is_total ? 1.8 : 1.4, curve->colour);
    }
}

static NumberText format_present_value(const EnergyCurve *one)
{
    double value = find_present_energy(one);
    bool is_zero = fabs(value) < find_energy_rounding(one->simulation);
    return format_number(is_zero ? 0 : value);
}

/* Fills a row of the legend: name and present value of a curve. */
bool energies_make_legend_row(const FrameContent *content, int row,
                              CardTableRow *cells)
{
    const EnergyCurves all = find_energy_curves(content);
    const EnergyCurve *one = &all.curve[row];
    if (row >= all.count)
        return false;
    *cells = (CardTableRow){2, one->colour, {""}};
    snprintf(cells->cell[0], CARD_CELL, "%s", one->name ? one->name : "");
    snprintf(cells->cell[1], CARD_CELL, "%s J", format_present_value(one).text);
    return true;
}

/* Writes the names and present values of the curves, or only measures them.
 * Returns the height in pixels.
 *   named  false: writes only the values, since each pane shows its name */
static int write_legend(const Plot *card, const EnergyCurves *all, bool named,
                        bool draw)
{
    Paper *paper = card->paper;
    const double size = fmax(LEGEND_SIZE, paper->min_letter_size);
    int at[2] = {0, 0}, used = 0;
    for (int c = 0; c < all->count; c++) {
        const EnergyCurve *one = &all->curve[c];
        TextLine line = {.colour = one->colour};
        char name[SENTENCE_SIZE] = "", sum[60];
        if (named && one->name)
            snprintf(name, sizeof name, "%s%s ", one->name,
                     card->content->panes > 1 ? ":" : "");
        snprintf(sum, sizeof sum, "%s J", format_present_value(one).text);
        paper_shorten_words(paper, size,
                            card->box.width -
                                paper_measure(paper, FACE_REGULAR, size, sum),
                            name, sizeof name);
        snprintf(line.text, sizeof line.text, "%.150s%s", name, sum);
        used = card_write_lines(card, at, size, LEGEND_GAP * size, &line, draw);
    }
    if (all->omitted_count > 0) {
        TextLine line = {.colour = COLOUR_GREY};
        snprintf(line.text, sizeof line.text, "+ %d smaller",
                 all->omitted_count);
        used = card_write_lines(card, at, size, LEGEND_GAP * size, &line, draw);
    }
    return used;
}

/* Removes the curve with the smallest maximum; the first curve always stays. */
static void omit_smallest_curve(EnergyCurves *all)
{
    double least = INFINITY;
    int smallest = all->count - 1;
    for (int c = 1; c < all->count; c++) {
        const History *history = all->curve[c].history;
        double most = 0;
        for (int i = 0; i < history->point_count; i++)
            most = fmax(most, fabs(history->value[all->curve[c].series][i]));
        if (most < least) {
            least = most;
            smallest = c;
        }
    }
    all->count--;
    all->omitted_count++;
    memmove(all->curve + smallest, all->curve + smallest + 1,
            (size_t)(all->count - smallest) * sizeof *all->curve);
}

/* Draws the curves with their names and present values above.  In a low card
 * the smallest curves are left out. */
void draw_energies_card(const Plot *card)
{
    EnergyCurves all = find_energy_curves(card->content);
    Plot rest = *card;
    double last;
    int room = card->box.height - paper_to_pixels(card->paper, MIN_PLOT);
    bool has_legend = !card->content->has_document;
    bool named = card->content->panes <= 1 ||
                 write_legend(card, &all, true, false) <= room;
    while (has_legend && all.count > 1 &&
           write_legend(card, &all, named, false) > room)
        omit_smallest_curve(&all);
    if (has_legend)
        box_cut_off(&rest.box, EDGE_TOP, write_legend(card, &all, named, true));
    Axis energy = make_energies_axis(card->simulation, &all, &last);
    Axis time = {0, plot_nice_number(last), .label = "t in s"};
    Plot plot = plot_create(&rest, time, energy);
    if (all.latest_time < plot.x.high)
        plot_line(&plot, (double[2]){all.latest_time, plot.y.low},
                  (double[2]){all.latest_time, plot.y.high}, 1, COLOUR_BORDER);
    draw_energy_curves(&plot, &all);
}

/* Draws a bar for the energy at the start plus the work since then, and a bar
 * for each of its parts.  A part's bar begins where the bar above it ends. */
void draw_energy_budget_card(const Plot *card)
{
    static const double NAME = 7, VALUE = 5.2; /* ems, widths of columns */
    Paper *paper = card->paper;
    const Box *box = &card->box;
    Energies energies = simulation_get_energies(card->simulation, 0);
    Energy all = {"start + work", 0};
    const Energy *shown[MAX_HISTORY_SERIES + 1] = {&all};
    int rows = 1, air = paper_to_pixels(paper, 0.1);
    for (int i = 1; i < energies.count; i++) {
        const Energy *row = &energies.energy[i];
        if (strcmp(row->name, "gravity") == 0 || strcmp(row->name, "work") == 0)
            continue;
        shown[rows++] = row;
        all.value += row->value;
    }
    int left = box->x + paper_to_pixels(paper, NAME), high = box->height / rows;
    double wide = box->width - paper_to_pixels(paper, NAME + VALUE);
    double most = fmax(all.value, 1e-300), begin = 0;
    for (int i = 0; i < rows; i++) {
        double value =
            fabs(shown[i]->value) < 1e-12 * most ? 0 : shown[i]->value;
        double end = fmin(fmax(begin + value / most, 0), 1);
        double from = wide * fmin(begin, end), to = wide * fmax(begin, end);
        int y = box->y + i * high;
        Colour colour = colour_of_name(i ? shown[i]->name : "total");
        canvas_fill(&paper->canvas,
                    (Box){left + (int)from, y + air, (int)(to - from) + 1,
                          high - 2 * air},
                    colour);
        paper_write(paper, FACE_REGULAR, 1, colour, box->x, y, ALIGN_LEFT, "%s",
                    shown[i]->name);
        paper_write(paper, FACE_REGULAR, 1, colour, box->x + box->width, y,
                    ALIGN_RIGHT, "%s J", format_number(value).text);
        begin = i ? end : 0;
    }
}

/* Draws the radius of each run's orbit on a logarithmic axis.  Marks the step
 * at which the first run's radius has doubled, if h was never changed. */
void draw_orbit_radius_card(const Plot *card)
{
    const Simulation *simulation = card->simulation;
    const FrameContent *content = card->content;
    const EnergyCurves all = find_energy_curves(content);
    double last = fmax(simulation_get_time(simulation),
                       100 * simulation->options.timestep);
    double most = 0.4; /* decades, half the axis; the middle is 1 m */
    for (int r = 0; r < simulation->runs; r++)
        most =
            fmax(most, 1.1 * fabs(log10(vector_length(simulation->run[r].x))));
    Plot plot =
        plot_create(card, (Axis){0, plot_nice_number(last), .label = "t in s"},
                    (Axis){pow(10, -most), pow(10, most), .scale = SCALE_LOG});
    double steps = values_find_number(&card->pane->values, "doubling");
    const double twice[2] = {steps * simulation->options.timestep, 2};
    plot_dashes(&plot, (double[2]){0, 2}, (double[2]){plot.x.high, 2}, 1, NULL,
                COLOUR_GREY);
    draw_energy_curves(&plot, &all);
    const History *history = card->pane->history;
    double end = history ? history->time[history->point_count - 1] : 0;
    double even = content->time_line.steps * simulation->options.timestep;
    bool changed = fabs(end - even) > 1e-9 * even;
    if (!content->lecture.hides_answer && !changed &&
        plot_disc(&plot, twice, 4, COLOUR_TEXT))
        plot_label(&plot, 1, twice, COLOUR_TEXT, "2 m: step %g", steps);
}
