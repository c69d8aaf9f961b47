/* live_values.c - the live values of a frame, which are filled into texts. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/neo_hookean.h"
#include "picture/cards.h"

/* ---- values -------------------------------------------------------------- */

static LiveValue *append_value(LiveValues *values, const char *name)
{
    LiveValue *new = &values->value[values->count % MAX_LIVE_VALUES];
    values->count += values->count < MAX_LIVE_VALUES;
    *new = (LiveValue){.name = name, .run = values->next_run};
    return new;
}

void values_add(LiveValues *values, const char *name, double number)
{
    if (!isnan(number))
        append_value(values, name)->value[0] = number;
}

void values_add_words(LiveValues *values, const char *name, const char *words)
{
    if (words)
        append_value(values, name)->text = words;
}

void values_add_flag(LiveValues *values, const char *name, bool flag)
{
    values_add_words(values, name, flag ? "" : NULL);
}

void values_add_point(LiveValues *values, const char *name,
                      const double point[2])
{
    LiveValue *new = append_value(values, name);
    new->is_point = true;
    memcpy(new->value, point, sizeof new->value);
}

void values_add_matrix(LiveValues *values, const char *const names[3],
                       const double H[3], double tiny)
{
    for (int k = 0; k < 3; k++)
        values_add(values, names[k], fabs(H[k]) < tiny ? 0 : H[k]);
}

static void add_view_values(const FrameContent *content, LiveValues *values)
{
    const LectureContent *lecture = &content->lecture;
    if (lecture->page)
        values_add(values, "page", (int)(lecture->page - lecture_pages) + 1);
    values_add(values, "pages", lecture_count_pages());
    values_add(values, "panes", content->panes > 1 ? content->panes : NAN);
    values_add_flag(values, "paused", content->time_line.is_paused);
    values_add_flag(values, "told", !lecture->hides_answer);
    values_add_flag(values, "guessed", lecture->guesses > 0);
    values_add(values, "guesses", lecture->guesses);
    values_add(values, "right", lecture->right_guesses);
    values_add_flag(
        values, content->view->drag_bounds.is_dragging ? "held" : "free", true);
}

static void add_setting_values(const Simulation *simulation, LiveValues *values)
{
    const Scene *scene = simulation->scene;
    const Options *options = &simulation->options;
    const TimeIntegrator *run = simulation->run;
    const IntegratorMethod *method = run[0].method;
    const Descent *descent = &simulation->descent;
    bool time = scene->traits & HAS_TIME;
    bool explicit = time && method && method->stages == 0;
    bool backward = method && strcmp(method->name, "backward-euler") == 0;
    bool forward = method && strcmp(method->name, "forward-euler") == 0;
    values_add_words(values, "scene",
                     options->page ? NULL : scene->description);
    bool settles = scene->needs_dissipation && !options->page;
    values_add_flag(values, "grows", settles && forward);
    values_add_flag(values, "keeps", settles && method && !method->is_damped);
    values_add_flag(values, "searches", scene->step == step_descent);
    values_add(values, "runs", simulation->runs);
    values_add_flag(values, "mixed",
                    simulation->runs > 1 && method != run[1].method);
    values_add_words(values, "method", method ? method->label : NULL);
    values_add_flag(values, "blocks",
                    simulation->runs > 1 && scene->picture == PICTURE_SQUARE);
    values_add_flag(values, "time", time);
    values_add_flag(values, "explicit", explicit);
    values_add_flag(values, explicit ? method->name : "", explicit);
    values_add_flag(values, "inside", time && method && !backward);
    values_add_flag(values, "one unknown", descent->scalar != NULL);
    values_add_flag(values, "by gradient", descent->tests_g);
    values_add_flag(values, "Algorithm 3", !explicit && !descent->tests_g);
    bool whole = options->line_search == LINE_SEARCH_NONE;
    bool search = descent->tests_g ? descent->scalar && !whole : !explicit;
    values_add_flag(values, "Algorithm 1", descent->tests_g && !search);
    bool map = descent->tests_g && !search && !descent->scalar;
    values_add_flag(values, map ? "map" : "no map", true);
    values_add_flag(values, "search", search);
    values_add_flag(values, "raw", options->projection == PROJECTION_NONE);
    values_add_flag(values, "whole", whole);
    values_add(values, "springs", simulation->system.springs);
    values_add_flag(values, "of a solid", get_neo_hookean(&simulation->system));
    values_add_flag(values, "done", simulation->is_over);
    if (simulation->is_over && scene->step == step_descent &&
        descent->residual <= options->tolerance) { /* the gradient is 0 at x */
        const double *x = descent->iterate;
        int down = descent_classify_hessian(simulation, x[0], x[1]);
        values_add_flag(values, "saddle", down == 1);
        values_add_flag(values, "maximum", down == 2);
    }
}

/* Adds the values of the current step, or of the last update of a descent. */
static void add_trace_values(const Simulation *simulation,
                             const NewtonTrace *trace, LiveValues *values)
{
    bool made = trace->at_line == LINE_NONE || trace->at_line >= LINE_SOLVE;
    bool known = made && isfinite(trace->residual);
    bool above = trace->residual > trace->tolerance;
    if (trace->projected_blocks >= 0) {
        values_add(values, "projected", trace->projected_blocks);
        values_add_flag(values, "of springs",
                        simulation_projects_only_springs(simulation));
    }
    values_add(values, "h then", trace->h);
    values_add(values, "tolerance", trace->tolerance);
    values_add_flag(values, "walking", trace->at_line != LINE_NONE);
    values_add_flag(values, "updated", trace->record_count > 0);
    values_add(values, "nth", trace->iteration + 1);
    values_add_words(values, "way", trace->slope > 0 ? "uphill" : "downhill");
    values_add_flag(values, "uphill", trace->slope > 0);
    int trial = trace->trials > 1 ? trace->trials : 1;
    double alpha = find_trial_step_length(trace, trial);
    if (trace->trials > 0 || trace->at_line)
        values_add(values, "length", alpha);
    if (trace->trials > 0)
        values_add_flag(values, trace->is_accepted ? "taken" : "refused", true);
    values_add_flag(values, "given up", trace->has_failed);
    const int count = trace->record_count;
    const NewtonRecord *last = count > 0 ? trace->record + count - 1 : NULL;
    if (simulation->scene->traits & HAS_TIME && last &&
        last->status == STATUS_OK) {
        /* negligible: a bound shows that the next p is small enough; hidden:
         * p was left out, because rounding hides the change of E along p. */
        values_add_flag(values, "negligible",
                        last->residual > trace->tolerance);
        values_add_flag(values, "hidden",
                        last->alpha == 0 && trace->trials == last->trials);
    }
    if (trace->trials > 0 && trace->energy_difference) {
        double change = trace->energy_difference(trace->difference_data, alpha);
        values_add(values, "change", change);
        values_add_words(values, "change", "no number");
        values_add_words(values, "+", change > 0 ? "+" : "");
    }
    if (known) {
        values_add(values, "residual", trace->residual);
        values_add(values, "p size",
                   simulation->descent.tests_g ? NAN
                                               : trace->residual * trace->h);
        values_add_words(values, ">", above ? ">" : "\u2264");
        values_add_words(values, "above", above ? "above" : "not above");
        values_add_words(values, "given",
                         above && trace->has_failed ? ": given up" : "");
    }
}

/* Returns the change of the minimised function along a descent's p. */
static double compute_energy_change(const void *function, double alpha)
{
    const DescentTrace *space = function;
    const Point x = point_along(space->start, alpha, space->p);
    TaylorModel there =
        descent_evaluate(space->simulation, PROJECTION_NONE, x.xy[0], x.xy[1]);
    return there.energy - space->start_energy;
}

/* Makes the trace of a descent's last update.  Without updates, or if the last
 * one did not move x, makes the trace of the next update. */
static const NewtonTrace *make_descent_trace(const Simulation *simulation,
                                             DescentTrace *space)
{
    const Descent *descent = &simulation->descent;
    int last = descent->record_count - 1;
    const NewtonRecord *record = &descent->record[last < 0 ? 0 : last];
    bool made = last >= 0 && record->alpha > 0;
    bool given_up = last >= 0 && !made; /* the line search refused all trials */
    *space = (DescentTrace){.simulation = simulation};
    for (int k = 0; k < (descent->scalar ? 1 : 2); k++) {
        space->start[k] = made ? record->x_before[k] : descent->iterate[k];
        space->p[k] =
            made ? (record->x_after[k] - record->x_before[k]) / record->alpha
                 : descent->direction[k];
    }
    bool aims = space->p[0] != 0 || space->p[1] != 0, taken = aims && made;
    space->start_energy = descent_evaluate(simulation, PROJECTION_NONE,
                                           space->start[0], space->start[1])
                              .energy;
    space->trace = (NewtonTrace){
        .at_line = aims && !made ? LINE_SOLVE : LINE_NONE,
        .h = simulation->options.timestep,
        .tolerance = simulation->options.tolerance,
        .record_count = descent->record_count,
        .record = descent->record,
        .iteration = descent->record_count,
        .residual = given_up ? record->residual : descent->residual,
        .has_failed = given_up,
        .slope = taken  ? record->slope
                 : aims ? descent->slope
                        : 0,
        .projected_blocks = taken ? record->projected_blocks : -1,
        .energy_difference = aims ? compute_energy_change : NULL,
        .difference_data = space,
        .trials = taken ? record->trials : 0,
        .is_accepted = taken,
    };
    return &space->trace;
}

void frame_compute_values(FrameContent *content)
{
    static const char *const lines[LINE_COUNT] = {"",       "line 1", "line 2",
                                                  "line 3", "line 4", "line 5",
                                                  "line 6", "line 7", "line 8"};
    bool walks = !content->lecture.page || frame_has_card(content, "listing") ||
                 frame_has_card(content, "line");
    for (int i = 0; i < content->panes; i++) {
        Pane *now = &content->pane[i];
        LiveValues *values = &now->values;
        const Simulation *simulation = now->simulation;
        const Picture *picture = picture_of_scene(simulation->scene);
        AlgoLine line = now->trace ? now->trace->at_line : LINE_NONE;
        now->shown_trace = now->trace;
        if (!now->trace && simulation->scene->step == step_descent)
            now->shown_trace = make_descent_trace(simulation, &now->descent);
        values->count = values->next_run = 0;
        for (int run = 0; run <= VALUES_MAX_RUNS; run++)
            values->text_line_colour[run] = COLOUR_TEXT;
        add_view_values(content, values);
        add_setting_values(simulation, values);
        if ((!line || now->trace->has_failed) && now->step_status &&
            now->step_status != STATUS_INTERRUPTED) {
            values_add_words(values, status_name(now->step_status), "");
            values_add_words(values, "trouble", status_text(now->step_status));
        }
        values_add_flag(values, lines[line], walks && line);
        values_add_flag(values, "no step", !now->shown_trace);
        if (now->shown_trace)
            add_trace_values(simulation, now->shown_trace, values);
        if (picture->add_values &&
            (i == content->active_pane_index || picture->legend))
            picture->add_values(simulation, values);
    }
}

/* ---- texts --------------------------------------------------------------- */

/* Finds the value of a run by its name, which a colon or a brace ends. */
static const LiveValue *find_live_value(const LiveValues *values, int run,
                                        const char *name)
{
    size_t length = strcspn(name, ":}");
    for (int i = 0; i < values->count; i++) {
        const LiveValue *one = &values->value[i];
        bool here = one->run == 0 || one->run == run;
        if (here && strlen(one->name) == length &&
            strncmp(name, one->name, length) == 0)
            return one;
    }
    return NULL;
}

double values_find_number(const LiveValues *values, const char *name)
{
    const LiveValue *one = find_live_value(values, 0, name);
    return one && !one->text ? one->value[0] : NAN;
}

double frame_find_value(FrameContent *content, const char *name)
{
    frame_compute_values(content);
    return values_find_number(&active_pane(content)->values, name);
}

/* Writes a value.  format: characters after the colon, as in "{length:/}". */
static void format_live_value(const LiveValue *one, const char *format,
                              char *out, size_t size)
{
    char *rest;
    int digits = (int)strtol(format, &rest, 10), exponent;
    double value = one->value[0];
    NumberText number[2];
    for (int k = 0; k < 2 && !one->text; k++)
        number[k] = format_digits(one->value[k], digits ? digits : 3);
    if (*rest == '/' && !one->text && value > 0 && value < 1 &&
        frexp(value, &exponent) == 0.5 && exponent > -9)
        snprintf(number->text, sizeof number->text, "1/%d",
                 1 << (1 - exponent));
    bool apart = *rest == '\'' && (value < 0 || strchr(number[0].text, '^'));
    if (one->text)
        snprintf(out, size, "%s", one->text);
    else if (one->is_point)
        snprintf(out, size, "(%s, %s)", number[0].text, number[1].text);
    else
        snprintf(out, size, apart ? "(%s)" : "%s", number[0].text);
}

/* Fills `line` from `length` bytes of text, with the values of its names.
 * Returns false if a value is unknown. */
static bool fill_in_values(TextLine *line, const char *text, size_t length)
{
    const LiveValues *values = line->values;
    const char *from = text, *end = text + length;
    size_t used = 0, name = strcspn(text, " *{");
    line->colour = COLOUR_TEXT;
    line->face = FACE_REGULAR;
    if (*from == '#' && from[name] != '{') { /* the line has a colour */
        int run = strncmp(from, "#run ", 5) == 0 ? line->run : from[1] - '0';
        line->colour = run >= 0 && run <= VALUES_MAX_RUNS
                           ? values->text_line_colour[run]
                           : colour_find_by_name(from + 1, name - 1);
        line->face = from[name] == '*' ? FACE_BOLD : FACE_REGULAR;
        from += name + 1 + (from[name] == '*');
    }
    while (from < end && used + 1 < sizeof line->text) {
        if (*from != '{' || text_is_markup_brace(text, from)) {
            line->text[used++] = *from++;
            continue;
        }
        bool minus = from[1] == '-';
        const LiveValue *found =
            find_live_value(values, line->run, from + 1 + minus);
        name = strcspn(from, ":}");
        if (!found)
            return false;
        LiveValue one = *found;
        one.value[0] *= minus ? -1 : 1;
        format_live_value(&one, from[name] == ':' ? from + name + 1 : "",
                          line->text + used, sizeof line->text - used);
        used += strlen(line->text + used);
        from += strcspn(from, "}") + 1;
    }
    line->text[used] = '\0';
    return true;
}

TextLine lines_begin(const LiveValues *values, const char *text)
{
    return (TextLine){.values = values, .next_text = text ? text : ""};
}

bool text_next_line(TextLine *line)
{
    for (;;) {
        if (*line->next_text == '@') {
            line->next_text = line->repeated_lines = line->next_text + 2;
            line->run = 1;
        }
        if (!*line->next_text && line->repeated_lines &&
            line->run < VALUES_MAX_RUNS) {
            line->next_text = line->repeated_lines;
            line->run++;
        }
        const char *text = line->next_text;
        size_t length = strcspn(text, "\n");
        line->next_text += length + (text[length] == '\n');
        if (*text && fill_in_values(line, text, length))
            return true;
        if (!*text)
            break;
    }
    line->text[0] = '\0';
    return false;
}

TextLine text_find_known_line(const LiveValues *values, const char *text)
{
    TextLine line = lines_begin(values, text);
    text_next_line(&line);
    return line;
}

bool text_has_line_to_show(const LiveValues *values, const char *text)
{
    TextLine line = lines_begin(values, text);
    return text_next_line(&line);
}

/* ---- the title bar ------------------------------------------------------- */

/* Fills an empty string with a text's first line whose values are known. */
static void expand_text(const LiveValues *values, const char *text,
                        char *string, size_t size)
{
    if (!string[0])
        snprintf(string, size, "%.*s", (int)size - 1,
                 text_find_known_line(values, text).text);
}

void frame_expand_texts(FrameContent *content)
{
    const LiveValues *values = &active_pane(content)->values;
    TitleBar *bar = &content->title_bar;
    frame_compute_values(content);
    if (!bar->topic)
        bar->topic = active_pane(content)->simulation->scene->title;
    expand_text(values, text_sentences, bar->sentence, sizeof bar->sentence);
    expand_text(values, text_methods, bar->method, sizeof bar->method);
    expand_text(values, text_states, bar->state, sizeof bar->state);
}
