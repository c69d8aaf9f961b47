#include "picture/draw.h"

#include <stdarg.h>
#include <stdio.h>

#include "scenes/scene.h"

/* The keys, for the page of help. */
static const HelpRow help_rows[] = {
    {"Space", "pause, go on"},
    {"N, \u2192", "one step or iteration"},
    {"R", "restart"},
    {"+ \u2212", "faster, slower"},
    {"C", "colours show strain"},
    {"P", "projection on, off"},
    {"L", "line search on, off"},
    {"H", "the bare picture"},
    {"S", "save a picture"},
    {"1 \u2026 9", "another scene"},
    {"?, F1", "this list"},
    {"Q, Esc", "quit"},
};

static void add_setting(Show *show, const char *name, int letters, bool off,
                        const char *format, ...)
{
    Setting *setting = &show->setting[show->settings++];
    va_list arguments;
    setting->name = name;
    setting->letters = letters;
    setting->off = off;
    va_start(arguments, format);
    vsnprintf(setting->value, SHOW_VALUE, format, arguments);
    va_end(arguments);
}

/* What the options of this scene are. */
static void add_settings(Show *show, const Simulation *simulation)
{
    const Options *options = &simulation->options;
    unsigned needs = simulation->scene->needs;
    if (needs & (NEEDS_TIME | NEEDS_STEP))
        add_setting(show, "h", 8, false, "%g s", options->timestep);
    if (needs & NEEDS_MESH) {
        add_setting(show, "k", 6, false, "%g", options->stiffness);
        add_setting(show, "stretch", 5, false, "%g", options->stretch);
        add_setting(show, "segments", 4, false, "%d", options->segments);
    }
    if (needs & NEEDS_MINIMUM)
        add_setting(show, "\u03b5", 9, false, "%g%s", options->tolerance,
                    needs & NEEDS_MESH ? " m/s" : "");
    if (simulation_has_filter(simulation))
        add_setting(show, "projection", 9, options->filter == FILTER_NONE, "%s",
                    filter_name(options->filter));
    if (simulation_has_line_search(simulation))
        add_setting(show, "line search", 9,
                    options->line_search == LINE_SEARCH_NONE, "%s",
                    line_search_name(options->line_search));
}

static void add_chip(Show *show, const char *key, const char *label)
{
    show->chip[show->chips++] = (Chip){key, label, false};
}

/* The keys that matter now. */
static void add_chips(Show *show, const Simulation *simulation, const Hud *hud)
{
    const Options *options = &simulation->options;
    bool time = simulation->scene->needs & NEEDS_TIME;
    add_chip(show, "Space", hud->paused ? "play" : "pause");
    add_chip(show, "N", time ? "next step" : "next iteration");
    add_chip(show, "R", "restart");
    if (simulation_has_filter(simulation))
        add_chip(show, "P",
                 options->filter == FILTER_NONE ? "projection on"
                                                : "projection off");
    if (simulation_has_line_search(simulation))
        add_chip(show, "L",
                 options->line_search == LINE_SEARCH_NONE ? "line search on"
                                                          : "line search off");
    add_chip(show, "C", hud->strain ? "plain colours" : "strain");
    add_chip(show, "H", "bare picture");
    add_chip(show, "?", "all keys");
}

/* The Show that a hud stands for. */
static void fill_show(const Simulation *simulation, const Hud *hud, Show *show)
{
    show_create(simulation, show);
    show->pane[0].history = &hud->history;
    show->pane[0].trail = &hud->trail;
    show->pane[0].trouble = hud->trouble;
    show->paused = hud->paused;
    show->strain = hud->strain;
    show->bare = !hud->text;
    show->step = simulation->steps;
    show->warning = hud->trouble != STATUS_OK;
    snprintf(show->message, SHOW_TEXT, "%s", hud->note);
    if (hud->keys) {
        show->page.kind = PAGE_HELP;
        show->help = help_rows;
        show->help_rows = sizeof help_rows / sizeof *help_rows;
    }
    add_settings(show, simulation);
    add_chips(show, simulation, hud);
    show_lecture((LectureColumn)hud->column, show);
    show_describe(show);
}

SpringCount draw_frame(Paper *paper, const Simulation *simulation,
                       const Hud *hud)
{
    Show show;
    fill_show(simulation, hud, &show);
    return show_draw(paper, &show);
}
