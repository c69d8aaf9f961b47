#include "picture/cards.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/colour_map.h"

enum {
    LEAST_SPAN = 60,  /* steps that the time line shows room for */
    LEAST_BAR = 3,    /* pixels; narrower steps are shown in groups */
    MOST_UPDATES = 12 /* updates that a full bar has, at least */
};

static const double TOPIC = 1.3;  /* ems */
static const double SENTENCE = 1; /* ems */

/* White below a zone, and a thin line along its upper or lower edge. */
static void draw_ground(Paper *paper, Box zone, bool rule_below)
{
    int thick = (int)fmax(1, paper->unit);
    canvas_rectangle(&paper->canvas, zone.x, zone.y, zone.width, zone.height,
                     COLOUR_WHITE);
    canvas_rectangle(&paper->canvas, zone.x,
                     rule_below ? zone.y + zone.height - thick : zone.y,
                     zone.width, thick, COLOUR_RULE);
}

/* Whether the strip has two lines: then it tells the message, and the last line
 * keeps its chips. */
static bool strip_tells(const Layout *layout)
{
    return layout->strip.height > 2.6 * layout->em;
}

/* Topic and sentence from the left; method and state from the right. */
static void draw_strip(Paper *paper, const Layout *layout, const Show *show)
{
    Box strip = layout->strip;
    if (strip.width <= 0)
        return;
    draw_ground(paper, strip, true);
    double em = paper->em, left = strip.x + 0.9 * em;
    double line = strip.y + 0.5 * strip.height - 0.65 * em;
    double right = strip.x + strip.width - 0.9 * em;
    bool both = show->method[0] && show->state[0];
    char words[2 * SHOW_TEXT];
    snprintf(words, sizeof words, "%s%s%s", show->method,
             both ? " \u00b7 " : "", show->state);
    int wide = paper_width(paper, FACE_REGULAR, SENTENCE, words);
    int used =
        paper_write(paper, FACE_REGULAR, SENTENCE, COLOUR_FAINT, right, line,
                    ALIGN_RIGHT, "%s", /* a small window has room for less */
                    wide > 0.45 * strip.width ? show->state : words);
    right -= used > 0 ? used + 1.4 * em : 0;
    Box before = canvas_clip(
        &paper->canvas,
        (Box){strip.x, strip.y, (int)(right - strip.x), strip.height});
    const char *title = show->topic ? show->topic : "";
    double size =
        fitting_size(paper, FACE_BOLD, TOPIC, 0.8 / TOPIC, right - left, title);
    int topic =
        paper_write(paper, FACE_BOLD, size, COLOUR_TEXT, left,
                    line + 0.65 * (1 - size) * em, ALIGN_LEFT, "%s", title);
    Box room = {(int)(left + topic + 1.1 * em), (int)line, 0, strip.height};
    room.width = (int)right - room.x;
    bool message = show->message[0] && strip_tells(layout);
    const char *said = message ? show->message : show->sentence;
    Colour colour = !message        ? COLOUR_TEXT
                    : show->warning ? COLOUR_WARNING
                                    : COLOUR_VALUE;
    if (room.width > 6 * em && said[0]) {
        int full = paper_width(paper, FACE_REGULAR, SENTENCE, said);
        bool two = full > room.width && strip_tells(layout);
        room.y -= two ? (int)(0.62 * em) : 0;
        paper_paragraph(paper, FACE_REGULAR, two ? 0.9 : SENTENCE, colour, room,
                        two ? 2 : 1, said);
    }
    canvas_clip(&paper->canvas, before);
}

/* ---- the row ------------------------------------------------------------ */

/* Name, then value with dots below: it can be changed. */
static void draw_setting(Paper *paper, Box box, const Setting *setting,
                         bool selected, bool over)
{
    double em = paper->em, size = 0.95;
    double x = box.x + 0.4 * em;
    double y = box.y + 0.5 * box.height - 0.65 * size * em;
    if (selected || over)
        canvas_card(&paper->canvas, box_inset(box, paper_pixels(paper, 0.1)),
                    0.3 * em, selected ? COLOUR_LIT : COLOUR_CHIP,
                    selected ? COLOUR_BORDER : 0);
    x += paper_write(paper, FACE_REGULAR, size, COLOUR_FAINT, x, y, ALIGN_LEFT,
                     "%s", setting->name) +
         0.5 * em;
    char value[SHOW_VALUE + 64], *rest; /* 1e-06 m/s, as people write it */
    double number = strtod(setting->value, &rest);
    const char *power = strchr(setting->value, 'e');
    bool typed = *rest == '_';
    snprintf(value, sizeof value, "%s%s",
             power && power < rest && !typed ? number_with(number, 6).text : "",
             power && power < rest && !typed ? rest : setting->value);
    int width = paper_write(paper, setting->changed ? FACE_BOLD : FACE_REGULAR,
                            size, setting->off ? COLOUR_GREY : COLOUR_VALUE, x,
                            y, ALIGN_LEFT, "%s", value);
    double below = floor(y + 1.3 * size * em) + 0.5, unit = paper->unit;
    canvas_dashes(&paper->canvas, x, below, x + width, below, fmax(1, unit),
                  3 * unit, 2 * unit, NULL,
                  setting->off ? COLOUR_GREY : COLOUR_VALUE);
}

static void draw_row(Paper *paper, const Layout *layout, const Show *show)
{
    if (layout->row.width <= 0)
        return;
    draw_ground(paper, layout->row, false);
    for (int i = 0; i < layout->settings; i++)
        draw_setting(paper, layout->setting[i], &show->setting[i],
                     show->selected == i,
                     show->over.zone == ZONE_SETTING && show->over.index == i);
}

/* ---- the time line ------------------------------------------------------ */

long frame_span(const Show *show)
{
    return show->bars > LEAST_SPAN ? show->bars : LEAST_SPAN;
}

/* Most updates of steps from ... to - 1, and whether one did not converge. */
static StepBar bar_group(const Show *show, long from, long to)
{
    StepBar group = {0, false};
    for (long s = from; s < to && s < show->bars; s++) {
        if (show->bar[s].updates > group.updates)
            group.updates = show->bar[s].updates;
        group.unconverged = group.unconverged || show->bar[s].unconverged;
    }
    return group;
}

/* Bars of single steps, or of groups where there is no room for all. */
static void draw_bars(Paper *paper, Box bars, const Show *show)
{
    long span = frame_span(show), most = MOST_UPDATES;
    double pitch = (double)bars.width / span;
    long group = pitch >= LEAST_BAR ? 1 : (long)ceil(LEAST_BAR / pitch);
    for (long s = 0; s < show->bars; s++)
        if (show->bar[s].updates > most)
            most = show->bar[s].updates;
    int gap = pitch * group >= 6 ? (int)fmax(1, 0.14 * pitch) : 1;
    if (pitch * group < 4)
        gap = 0;
    for (long s = 0; s < show->bars; s += group) {
        StepBar bar = bar_group(show, s, s + group);
        int x = bars.x + (int)(s * pitch);
        int right = bars.x + (int)((s + group) * pitch) - gap;
        bool now = show->step > s && show->step <= s + group;
        int least = (int)fmax(2, 0.08 * bars.height);
        int height = least + (int)((bars.height - least) *
                                   sqrt((double)bar.updates / most));
        Colour colour = bar.unconverged ? COLOUR_WARNING
                        : now           ? COLOUR_VALUE
                                        : COLOUR_BAR;
        canvas_rectangle(&paper->canvas, x, bars.y + bars.height - height,
                         right - x > 1 ? right - x : 1, height, colour);
    }
}

/* The handle at the step that is shown, its words beside it. */
static void draw_time(Paper *paper, const Layout *layout, const Show *show)
{
    Box zone = layout->time, bars = layout->bars;
    if (zone.width <= 0)
        return;
    double em = paper->em, unit = paper->unit;
    bool words = zone.height > 3.5 * em;
    draw_ground(paper, zone, false);
    if (show->bar)
        draw_bars(paper, bars, show);
    long span = frame_span(show), step = show->step;
    double part = step > 0 ? (step - 0.5) / span : 0;
    double x = floor(bars.x + part * bars.width) + 0.5;
    double top = words ? zone.y + 1.1 * em : zone.y + 0.5 * em;
    canvas_line(&paper->canvas, x, top, x, bars.y + bars.height + 0.2 * em,
                fmax(1, 2 * unit), COLOUR_TEXT);
    canvas_disc(&paper->canvas, x, top, (words ? 7 : 5) * unit, COLOUR_TEXT);
    if (!words)
        return;
    double at = x + 1.1 * em;
    int width = paper_width(paper, FACE_REGULAR, 0.95, show->time_text);
    if (at + width > zone.x + zone.width - 0.9 * em)
        at = x - 1.1 * em - width;
    at = fmax(at, zone.x + 0.4 * em);
    paper_write(paper, FACE_REGULAR, 0.95, COLOUR_TEXT, at, top - 0.62 * em,
                ALIGN_LEFT, "%s", show->time_text);
}

/* ---- the last line ------------------------------------------------------ */

static void draw_chip(Paper *paper, Box box, const Chip *chip, bool over)
{
    double em = paper->em, size = 0.92;
    double y = box.y + 0.5 * box.height - 0.65 * size * em;
    int key = paper_width(paper, FACE_BOLD, size, chip->key);
    int label = paper_width(paper, FACE_REGULAR, size, chip->label);
    double gap = 0.5 * em, x = box.x + 0.5 * (box.width - key - gap - label);
    canvas_card(&paper->canvas, box, 0.4 * em,
                chip->lit ? COLOUR_LIT
                : over    ? COLOUR_WHITE
                          : COLOUR_CHIP,
                over ? COLOUR_GREY : COLOUR_BORDER);
    Box before = canvas_clip(&paper->canvas, box);
    paper_write(paper, FACE_BOLD, size, COLOUR_TEXT, x, y, ALIGN_LEFT, "%s",
                chip->key);
    paper_write(paper, FACE_REGULAR, size, COLOUR_TEXT, x + key + gap, y,
                ALIGN_LEFT, "%s", chip->label);
    canvas_clip(&paper->canvas, before);
}

static void draw_last(Paper *paper, const Layout *layout, const Show *show)
{
    Box last = layout->last;
    double em = paper->em;
    if (last.width <= 0)
        return;
    draw_ground(paper, last, false);
    if (show->message[0] && !strip_tells(layout)) {
        Box room = {last.x + (int)em,
                    (int)(last.y + 0.5 * last.height - 0.65 * em),
                    last.width - (int)(2 * em), last.height};
        paper_paragraph(paper, FACE_REGULAR, 1,
                        show->warning ? COLOUR_WARNING : COLOUR_TEXT, room, 1,
                        show->message);
        return;
    }
    for (int i = 0; i < layout->chips; i++) {
        Chip chip = show->chip[i];
        if (layout->chip[i].width <= 0)
            continue;
        if (layout->chips_left_out > 0 && i == layout->chips - 1)
            chip.label = "all \u2026"; /* those that are not here, too */
        draw_chip(paper, layout->chip[i], &chip,
                  show->over.zone == ZONE_CHIP && show->over.index == i);
    }
}

void frame_draw(Paper *paper, const Layout *layout, const Show *show)
{
    draw_strip(paper, layout, show);
    draw_row(paper, layout, show);
    draw_time(paper, layout, show);
    draw_last(paper, layout, show);
}
