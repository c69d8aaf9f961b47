/* window_rows.c - the title bar, the settings, the time line and the chips. */
#include "picture/cards.h"

#include <math.h>
#include <stdio.h>

enum {
    MIN_TIME_LINE_STEPS = 60, /* least number of steps of a time line */
    MIN_BAR_WIDTH = 3,        /* pixels, width below which bars are merged */
    FULL_BAR_UPDATES = 12 /* least number of updates at a bar's full height */
};

static const double TOPIC_SIZE = 1.3; /* ems, letters of the topic */
static const double TEXT_SIZE = 0.95; /* ems, letters of settings and time */

/* Draws the white background of a zone, with a thin line along one edge. */
static void draw_zone_background(Paper *paper, Box zone, bool rule_below)
{
    Box rule = {zone.x, zone.y, zone.width, (int)fmax(1, paper->unit)};
    rule.y += rule_below ? zone.height - rule.height : 0;
    canvas_fill(&paper->canvas, zone, COLOUR_WHITE);
    canvas_fill(&paper->canvas, rule, COLOUR_RULE);
}

/* Draws topic and sentence from the left, method and state from the right.  A
 * message stands in the place of the sentence.  In a low bar, the method makes
 * way for a message; a long message also takes the place of the topic. */
static void draw_title_bar(Paper *paper, Box room, const TitleBar *bar)
{
    double em = paper->em;
    bool low = room.height <= 2.6 * em, message = bar->message[0];
    const char *said = message ? bar->message : bar->sentence;
    const char *title = bar->topic ? bar->topic : "";
    Colour colour = !message          ? COLOUR_TEXT
                    : bar->is_warning ? COLOUR_WARNING
                                      : COLOUR_VALUE;
    char words[2 * SENTENCE_SIZE];
    draw_zone_background(paper, room, true);
    box_cut_off(&room, EDGE_LEFT, (int)(0.9 * em));
    room.width -= (int)(0.9 * em);
    snprintf(words, sizeof words, "%s%s%s", bar->method,
             bar->method[0] && bar->state[0] ? " \u00b7 " : "", bar->state);
    if ((low && message) ||
        paper_measure(paper, FACE_REGULAR, 1, words) > 0.45 * room.width)
        snprintf(words, sizeof words, "%s", bar->state);
    room.width -= paper_write_in_box(paper, FACE_REGULAR, 1, COLOUR_FAINT, room,
                                     ALIGN_RIGHT, words);
    room.width -= (int)(1.4 * em);
    int wide = paper_measure(paper, FACE_REGULAR, 1, said);
    int topic = paper_measure(paper, FACE_BOLD, TOPIC_SIZE, title);
    if (!low || !message || topic + wide + 1.1 * em < room.width) {
        topic = paper_write_in_box(paper, FACE_BOLD, TOPIC_SIZE, COLOUR_TEXT,
                                   room, ALIGN_LEFT, title);
        box_cut_off(&room, EDGE_LEFT, topic + (int)(1.1 * em));
    }
    bool two = !low && wide > room.width;
    room.y += (int)(0.5 * room.height - (two ? 1.27 : 0.65) * em);
    if (room.width > 6 * em)
        paper_write_paragraph(paper, FACE_REGULAR, two ? 0.9 : 1, colour, room,
                              two ? 2 : 1, said);
}

/* ---- settings ------------------------------------------------------------ */

/* Draws name and value of a setting; dashes underline a changeable value. */
static void draw_setting(Paper *paper, Box box, const Setting *setting,
                         bool over)
{
    bool selected = setting->is_selected;
    double em = paper->em, below = floor(box.y + 0.5 * box.height + 0.6 * em);
    Colour colour = setting->is_off ? COLOUR_GREY : COLOUR_VALUE;
    if (selected || over)
        canvas_framed_box(&paper->canvas,
                          box_inset(box, paper_to_pixels(paper, 0.1)),
                          selected ? COLOUR_LIT : COLOUR_CHIP,
                          selected ? COLOUR_BORDER : COLOUR_CHIP);
    box_cut_off(&box, EDGE_LEFT, (int)(0.4 * em));
    int width = paper_write_in_box(paper, FACE_REGULAR, TEXT_SIZE, COLOUR_FAINT,
                                   box, ALIGN_LEFT, setting->name);
    box_cut_off(&box, EDGE_LEFT, (int)(0.5 * em + width));
    box.width += (int)(0.8 * em); /* the value may reach into the gap */
    width = paper_write_in_box(
        paper, setting->is_changed ? FACE_BOLD : FACE_REGULAR, TEXT_SIZE,
        colour, box, ALIGN_LEFT, format_power_of_ten(setting->value).text);
    canvas_dashes(&paper->canvas, (double[2]){box.x, below + 0.5},
                  (double[2]){box.x + width, below + 0.5}, fmax(1, paper->unit),
                  paper->unit, NULL, colour);
}

/* ---- the time line ------------------------------------------------------ */

/* Returns the number of steps that the time line has room for. */
static long count_time_line_steps(const FrameContent *content)
{
    long steps = content->time_line.steps;
    return steps > MIN_TIME_LINE_STEPS ? steps : MIN_TIME_LINE_STEPS;
}

long frame_pick_step(const FrameContent *content, const Layout *layout,
                     double x)
{
    const Box *bars = &layout->step_bars;
    double step =
        (x - bars->x) / fmax(bars->width, 1) * count_time_line_steps(content);
    return (long)fmin(fmax(step < 0.25 ? 0 : floor(step) + 1, 0),
                      content->time_line.steps);
}

/* Draws a bar for each step, or for the largest step of each group. */
static void draw_step_bars(Paper *paper, Box bars, double pitch,
                           const TimeLine *line)
{
    long group = (long)ceil(MIN_BAR_WIDTH / pitch), most = FULL_BAR_UPDATES;
    int gap = (int)fmax(1, 0.14 * pitch), least = (int)(0.08 * bars.height) + 1;
    for (long s = 1; s <= line->steps; s++)
        most = (long)fmax(most, line->get_bar(line->bar_data, s).updates);
    for (long s = 0; s < line->steps; s += group) {
        StepBar bar = {0, false};
        for (long k = s; k < s + group && k < line->steps; k++) {
            StepBar one = line->get_bar(line->bar_data, k + 1);
            bar.updates = (int)fmax(bar.updates, one.updates);
            bar.is_unconverged |= one.is_unconverged;
        }
        int left = (int)(s * pitch), right = (int)((s + group) * pitch) - gap;
        int high = least + (int)((bars.height - least) *
                                 sqrt((double)bar.updates / most));
        bool shown = line->shown_step > s && line->shown_step <= s + group;
        Box box = {bars.x + left, bars.y + bars.height - high, right - left,
                   high};
        canvas_fill(&paper->canvas, box,
                    bar.is_unconverged ? COLOUR_WARNING
                    : shown            ? COLOUR_VALUE
                                       : COLOUR_BAR);
    }
}

/* Draws the bars of the steps, and the handle at the shown step with a text. */
static void draw_time_line(Paper *paper, const Layout *layout,
                           const FrameContent *content)
{
    Box zone = layout->time_line, bars = layout->step_bars;
    const TimeLine *line = &content->time_line;
    double em = paper->em, room = count_time_line_steps(content);
    bool words = zone.height > 3.5 * em;
    double part = fmax((line->shown_step - 0.5) / room, 0);
    double x = floor(bars.x + part * bars.width) + 0.5;
    double top = zone.y + (words ? 1.1 : 0.5) * em, at = x + 1.1 * em;
    if (zone.width <= 0)
        return;
    draw_zone_background(paper, zone, false);
    if (line->get_bar)
        draw_step_bars(paper, bars, bars.width / room, line);
    canvas_line(&paper->canvas, x, top, x, bars.y + bars.height + 0.2 * em,
                2 * paper->unit, COLOUR_TEXT);
    canvas_disc(&paper->canvas, x, top, (words ? 7 : 5) * paper->unit,
                COLOUR_TEXT);
    int width = paper_measure(paper, FACE_REGULAR, TEXT_SIZE, line->label);
    if (at + width > zone.x + zone.width - 0.9 * em)
        at = fmax(x - 1.1 * em - width, zone.x + 0.4 * em);
    if (words)
        paper_write(paper, FACE_REGULAR, TEXT_SIZE, COLOUR_TEXT, at,
                    top - 0.62 * em, ALIGN_LEFT, "%s", line->label);
}

/* ---- chips --------------------------------------------------------------- */

static void draw_chips(Paper *paper, const Layout *layout,
                       const FrameContent *content)
{
    const double gap = 0.5 * paper->em, size = 0.92;
    const WindowHit *mouse = &content->view->mouse_hit;
    draw_zone_background(paper, layout->chip_row, false);
    for (int i = 0; i < layout->chip_count; i++) {
        const Chip *chip = &content->chips.chip[i];
        Box box = layout->chip[i];
        bool all = layout->omitted_chips > 0 && i == layout->chip_count - 1;
        bool over = mouse->zone == ZONE_CHIP && mouse->index == i;
        const char *label = all ? "all \u2026" : chip->label;
        int key = paper_measure(paper, FACE_BOLD, size, chip->key);
        int width = key + paper_measure(paper, FACE_REGULAR, size, label);
        canvas_framed_box(&paper->canvas, box,
                          chip->is_highlighted ? COLOUR_LIT
                          : over               ? COLOUR_WHITE
                                               : COLOUR_CHIP,
                          over ? COLOUR_GREY : COLOUR_BORDER);
        box_cut_off(&box, EDGE_LEFT,
                    (int)fmax(0, 0.5 * (box.width - gap - width)));
        paper_write_in_box(paper, FACE_BOLD, size, COLOUR_TEXT, box, ALIGN_LEFT,
                           chip->key);
        box_cut_off(&box, EDGE_LEFT, (int)(key + gap));
        paper_write_in_box(paper, FACE_REGULAR, size, COLOUR_TEXT, box,
                           ALIGN_LEFT, label);
    }
}

void window_rows_draw(Paper *paper, const Layout *layout,
                      const FrameContent *content)
{
    const WindowHit *mouse = &content->view->mouse_hit;
    draw_title_bar(paper, layout->title_bar, &content->title_bar);
    draw_zone_background(paper, layout->settings_row, false);
    for (int i = 0; i < layout->setting_count; i++)
        if (layout->setting[i].width > 0)
            draw_setting(paper, layout->setting[i], &content->settings.item[i],
                         mouse->zone == ZONE_SETTING && mouse->index == i);
    draw_time_line(paper, layout, content);
    draw_chips(paper, layout, content);
}
