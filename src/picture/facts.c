/* facts.c - what is known of a frame, by name, and texts that are filled with
 * it.
 */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/neo_hookean.h"
#include "picture/cards.h"
#include "picture/colour_map.h"

/* ---- what is known ------------------------------------------------------- */

static Fact *add_fact(Facts *facts, const char *name)
{
    Fact *new = &facts->fact[facts->count % FACTS_MOST];
    facts->count += facts->count < FACTS_MOST;
    *new = (Fact){.name = name, .run = facts->run};
    return new;
}

void fact(Facts *facts, const char *name, double value)
{
    if (!isnan(value))
        add_fact(facts, name)->value[0] = value;
}

void fact_words(Facts *facts, const char *name, const char *words)
{
    if (words)
        add_fact(facts, name)->words = words;
}

void fact_when(Facts *facts, const char *name, bool on)
{
    fact_words(facts, name, on ? "" : NULL);
}

void fact_point(Facts *facts, const char *name, const double point[2])
{
    Fact *new = add_fact(facts, name);
    new->point = true;
    memcpy(new->value, point, sizeof new->value);
}

void fact_matrix(Facts *facts, const char *const names[3], const double H[3],
                 double none)
{
    for (int k = 0; k < 3; k++)
        fact(facts, names[k], fabs(H[k]) < none ? 0 : H[k]);
}

/* Scene, methods and settings. */
static void add_settings(const Show *show, const Simulation *simulation,
                         Facts *facts)
{
    const Scene *scene = simulation->scene;
    const Options *options = &simulation->options;
    const TimeIntegrator *run = simulation->run;
    const IntegratorMethod *method = run[0].method;
    const Descent *descent = &simulation->descent;
    bool time = scene->needs & NEEDS_TIME;
    bool explicit = time && method && !method->implicit;
    bool backward = method && strcmp(method->name, "backward-euler") == 0;
    bool forward = method && strcmp(method->name, "forward-euler") == 0;
    fact_words(facts, "scene", show->lecture ? NULL : scene->sentence);
    fact(facts, "page",
         show->lecture ? (double)(show->lecture - lecture_pages + 1) : NAN);
    fact(facts, "pages", lecture_count());
    bool settles = scene->settles && !show->lecture;
    fact_when(facts, "grows", settles && forward);
    fact_when(facts, "keeps", settles && method && !method->damps);
    fact(facts, "panes", show->panes > 1 ? show->panes : NAN);
    fact_when(facts, "searches", scene->step == step_descent);
    fact(facts, "runs", simulation->runs);
    fact_when(facts, "mixed", simulation->runs > 1 && method != run[1].method);
    fact_words(facts, "method", method ? method->label : NULL);
    fact_when(facts, "blocks",
              simulation->runs > 1 && scene->picture == PICTURE_SQUARE);
    fact_when(facts, "time", time);
    fact_when(facts, "explicit", explicit);
    fact_when(facts, explicit ? method->name : "", explicit);
    fact_when(facts, "inside", time && method && !backward);
    fact_when(facts, "one unknown", descent->scalar != NULL);
    fact_when(facts, "by gradient", descent->by_gradient);
    fact_when(facts, "Algorithm 3", !explicit && !descent->by_gradient);
    bool whole = options->line_search == LINE_SEARCH_NONE;
    bool search = descent->by_gradient ? descent->scalar && !whole : !explicit;
    fact_when(facts, "Algorithm 1", descent->by_gradient && !search);
    fact_when(facts, "search", search);
    fact_when(facts, "raw", options->projection == PROJECTION_NONE);
    fact_when(facts, "whole", whole);
    fact(facts, "springs", simulation->system.springs);
    fact_when(facts, "of a solid", neo_hookean_of(&simulation->system));
    fact_when(facts, "done", simulation->done);
    fact_when(facts, "paused", show->paused);
    fact_when(facts, show->veiled ? "asked" : "told", true);
    fact(facts, "guesses", show->guesses > 0 ? show->guesses : NAN);
    fact(facts, "right", show->right);
    fact_when(facts, show->view->held.on ? "held" : "free", true);
    if (simulation->done && scene->step == step_descent &&
        descent->residual <= options->tolerance) { /* the gradient is 0, too */
        const double *x = descent->point;
        int down = descent_bends_down(simulation, x[0], x[1]);
        fact_when(facts, "saddle", down == 1);
        fact_when(facts, "maximum", down == 2);
    }
}

/* How a step has converged by another way than its residual: the next direction
 * is known to be negligible, or rounding hides what the last one would gain. */
static void add_end(const Trace *trace, Facts *facts)
{
    const NewtonRecord *last = trace->record + trace->updates - 1;
    if (trace->updates == 0 || last->status != STATUS_OK)
        return;
    fact_when(facts, "negligible", last->residual > trace->tolerance);
    fact_when(facts, "hidden",
              last->alpha == 0 && trace->trials == last->trials);
}

/* The step as far as it has come, or the last update of a search. */
static void add_trace(const Simulation *simulation, const Trace *trace,
                      Facts *facts)
{
    bool made = trace->line == LINE_NONE || trace->line >= LINE_SOLVE;
    bool known = made && isfinite(trace->residual);
    bool above = trace->residual > trace->tolerance;
    if (trace->projected >= 0) {
        fact(facts, "projected", trace->projected);
        fact_when(facts, "of springs", simulation_projects_springs(simulation));
    }
    fact(facts, "h then", trace->h);
    fact(facts, "tolerance", trace->tolerance);
    fact_when(facts, "walking", trace->line != LINE_NONE);
    fact_when(facts, "updated", trace->updates > 0);
    double risen = 0; /* E, by the updates of this step so far */
    for (int i = 0; i < trace->updates; i++)
        risen += trace->record[i].change;
    bool rose = risen > 0 && simulation->scene->needs & NEEDS_TIME;
    fact(facts, "risen", rose ? risen : NAN);
    fact(facts, "nth", trace->iteration + 1);
    fact_words(facts, "way", trace->slope > 0 ? "uphill" : "downhill");
    fact_when(facts, "uphill", trace->slope > 0);
    if (trace->trials > 0 || trace->line)
        fact(facts, "length",
             trace_alpha(trace, trace->trials > 1 ? trace->trials : 1));
    fact_when(facts, "taken", trace->trials > 0 && trace->accepted);
    fact_when(facts, "refused", trace->trials > 0 && !trace->accepted);
    fact_when(facts, "given up", trace->given_up);
    if (simulation->scene->needs & NEEDS_TIME)
        add_end(trace, facts);
    if (trace->trials > 0 && trace->difference) {
        double alpha = trace_alpha(trace, trace->trials);
        double change = trace->difference(trace->function, alpha);
        fact(facts, "change", change);
        fact_words(facts, "change", "no number");
        fact_words(facts, "+", change > 0 ? "+" : "");
    }
    if (known) {
        fact(facts, "residual", trace->residual);
        fact(facts, "p size",
             simulation->descent.by_gradient ? NAN
                                             : trace->residual * trace->h);
        fact_words(facts, ">", above ? ">" : "\u2264");
        fact_words(facts, "above", above ? "above" : "not above");
        fact_words(facts, "given",
                   above && trace->given_up ? ": given up" : "");
    }
}

/* f(x + alpha p) - f(x), or E in the landscape. */
static double descent_difference(const void *function, double alpha)
{
    const DescentTrace *space = function;
    Local there = descent_at(space->simulation, PROJECTION_NONE,
                             space->from[0] + alpha * space->p[0],
                             space->from[1] + alpha * space->p[1]);
    return there.value - space->value;
}

/* The last update of a descent; before the first one, the one to come.  The
 * residual is that of the present iterate: at the end the one that passes. */
static const Trace *descent_trace(const Simulation *simulation,
                                  DescentTrace *space)
{
    const Descent *descent = &simulation->descent;
    int last = descent->count - 1;
    const NewtonRecord *record = &descent->record[last < 0 ? 0 : last];
    bool made = last >= 0 && record->alpha > 0;
    bool given_up = last >= 0 && !made; /* no step along this p was taken */
    *space = (DescentTrace){.simulation = simulation};
    for (int k = 0; k < (descent->scalar ? 1 : 2); k++) {
        space->from[k] = made ? record->from[k] : descent->point[k];
        space->p[k] = made ? (record->to[k] - record->from[k]) / record->alpha
                           : descent->direction[k];
    }
    bool aims = space->p[0] != 0 || space->p[1] != 0, taken = aims && made;
    space->value =
        descent_at(simulation, PROJECTION_NONE, space->from[0], space->from[1])
            .value;
    space->trace = (Trace){
        .line = aims && !made ? LINE_SOLVE : LINE_NONE,
        .h = simulation->options.timestep,
        .tolerance = simulation->options.tolerance,
        .updates = descent->count,
        .record = descent->record,
        .iteration = descent->count,
        .residual = given_up ? record->residual : descent->residual,
        .given_up = given_up,
        .slope = !aims  ? 0
                 : made ? record->slope
                        : descent->slope,
        .projected = taken ? record->projected : -1,
        .difference = aims ? descent_difference : NULL,
        .function = space,
        .trials = taken ? record->trials : 0,
        .accepted = taken,
    };
    return &space->trace;
}

void show_know(Show *show)
{
    static const char *const lines[LINE_COUNT] = {"",       "line 1", "line 2",
                                                  "line 3", "line 4", "line 5",
                                                  "line 6", "line 7", "line 8"};
    bool walks = !show->lecture || show_has_card(show, "listing") ||
                 show_has_card(show, "line");
    for (int i = 0; i < show->panes; i++) {
        Pane *now = &show->pane[i];
        Facts *facts = &now->facts;
        const Simulation *simulation = now->simulation;
        const Picture *picture = picture_of(simulation->scene);
        Line line = now->trace ? now->trace->line : LINE_NONE;
        now->update = now->trace;
        if (!now->trace && simulation->scene->step == step_descent)
            now->update = descent_trace(simulation, &now->descent);
        facts->count = facts->run = 0;
        for (int run = 0; run <= FACTS_RUNS; run++)
            facts->colour[run] = COLOUR_TEXT;
        add_settings(show, simulation, facts);
        if ((!line || now->trace->given_up) && now->trouble &&
            now->trouble != STATUS_INTERRUPTED) {
            fact_words(facts, status_name(now->trouble), "");
            fact_words(facts, "trouble", status_text(now->trouble));
        }
        fact_when(facts, lines[line], walks && line);
        fact_when(facts, "no step", !now->update);
        if (now->update)
            add_trace(simulation, now->update, facts);
        if (picture->facts && (i == show->active || picture->legend))
            picture->facts(simulation, facts); /* of others legends are read */
    }
}

/* ---- texts --------------------------------------------------------------- */

/* The fact of this name, up to its colon or brace. */
static const Fact *find_fact(const Facts *facts, int run, const char *name)
{
    size_t length = strcspn(name, ":}");
    for (int i = 0; i < facts->count; i++) {
        const Fact *one = &facts->fact[i];
        bool here = one->run == 0 || one->run == run;
        if (here && strlen(one->name) == length &&
            strncmp(name, one->name, length) == 0)
            return one;
    }
    return NULL;
}

double fact_number(const Facts *facts, const char *name)
{
    const Fact *one = find_fact(facts, 0, name);
    return one && !one->words ? one->value[0] : NAN;
}

double show_number(Show *show, const char *name)
{
    show_know(show);
    return fact_number(&show_pane(show)->facts, name);
}

/* One number or word of a line, as the letters behind the colon say: with / it
 * is 1/2, 1/4, ... where it is one of them. */
static void put_fact(const Fact *one, const char *format, char *out,
                     size_t size)
{
    char *rest;
    int digits = (int)strtol(format, &rest, 10), exponent;
    double value = one->value[0];
    Number number[2];
    for (int k = 0; k < 2 && !one->words; k++)
        number[k] = number_with(one->value[k], digits ? digits : 3);
    if (*rest == '/' && !one->words && value > 0 && value < 1 &&
        frexp(value, &exponent) == 0.5 && exponent > -9)
        snprintf(number->text, sizeof number->text, "1/%d",
                 1 << (1 - exponent));
    bool apart = *rest == '\'' && (value < 0 || strchr(number[0].text, '^'));
    if (one->words)
        snprintf(out, size, "%s", one->words);
    else if (one->point)
        snprintf(out, size, "(%s, %s)", number[0].text, number[1].text);
    else
        snprintf(out, size, apart ? "(%s)" : "%s", number[0].text);
}

/* Fills in the line of so many bytes; false: something in it is not known. */
static bool fill_line(TextLine *line, const char *text, size_t length)
{
    const Facts *facts = line->facts;
    const char *from = text, *end = text + length;
    size_t used = 0, name = strcspn(text, " *{");
    line->colour = COLOUR_TEXT;
    line->face = FACE_REGULAR;
    if (*from == '#' && from[name] != '{') { /* "#warning", "#run", "#1" */
        int run = strncmp(from, "#run ", 5) == 0 ? line->run : from[1] - '0';
        line->colour = run >= 0 && run <= FACTS_RUNS
                           ? facts->colour[run]
                           : colour_named(from + 1, name - 1);
        line->face = from[name] == '*' ? FACE_BOLD : FACE_REGULAR;
        from += name + 1 + (from[name] == '*');
    }
    while (from < end && used + 1 < sizeof line->words) {
        if (*from != '{' || text_is_markup(text, from)) {
            line->words[used++] = *from++;
            continue;
        }
        bool minus = from[1] == '-';
        const Fact *found = find_fact(facts, line->run, from + 1 + minus);
        name = strcspn(from, ":}");
        if (!found)
            return false;
        Fact one = *found;
        one.value[0] *= minus ? -1 : 1;
        put_fact(&one, from[name] == ':' ? from + name + 1 : "",
                 line->words + used, sizeof line->words - used);
        used += strlen(line->words + used);
        from += strcspn(from, "}") + 1;
    }
    line->words[used] = '\0';
    return true;
}

TextLine text_of(const Facts *facts, const char *text)
{
    return (TextLine){.facts = facts, .rest = text ? text : ""};
}

bool text_next(TextLine *line)
{
    for (;;) {
        if (*line->rest == '@') {
            line->rest = line->each = line->rest + 2;
            line->run = 1;
        }
        if (!*line->rest && line->each && line->run < FACTS_RUNS) {
            line->rest = line->each;
            line->run++;
        }
        const char *text = line->rest;
        size_t length = strcspn(text, "\n");
        line->rest += length + (text[length] == '\n');
        if (*text && fill_line(line, text, length))
            return true;
        if (!*text)
            break;
    }
    line->words[0] = '\0';
    return false;
}

TextLine text_first(const Facts *facts, const char *text)
{
    TextLine line = text_of(facts, text);
    text_next(&line);
    return line;
}

bool text_is_known(const Facts *facts, const char *text)
{
    TextLine line = text_of(facts, text);
    return text_next(&line);
}

/* Draws a line at the upper edge of the box, or only measures it; returns the
 * pixels that it takes.  What is too wide goes on below. */
static int put_line(Paper *paper, Box box, double size, const TextLine *line,
                    bool draw)
{
    const double air = 0.2, empty = 0.6; /* ems */
    int high = paper_paragraph(paper, line->face, size, line->colour, box,
                               draw ? INT_MAX : 0, line->words);
    return high + paper_pixels(paper, size * (high > 0 ? air : empty));
}

void text_in_card(const Plot *card, const Facts *facts, const char *text)
{
    Paper *paper = card->paper;
    Box box = card->box;
    double height = 0, size = 1;
    if (card->show->lecture) /* in a star it is seen from farther away */
        size = box.width > STAR_WIDE * paper->em ? 1.6 : 1.2;
    const TextLine begin = text_of(facts, text);
    for (TextLine line = begin; text_next(&line);) {
        int width = paper_width(paper, line.face, 1, line.words);
        height += put_line(paper, box, 1, &line, false);
        if (width > 0)
            size = fmin(size, (double)box.width / width);
    }
    size = fmax(fmin(size, box.height / height), paper->least);
    for (TextLine line = begin; text_next(&line);)
        box.y += put_line(paper, box, size, &line, true);
}

int words_flow(const Plot *card, int at[2], double size, double gap,
               const TextLine *line)
{
    Paper *paper = card->paper;
    int width = paper_width(paper, line->face, size, line->words);
    if (at[0] > 0 && at[0] + width > card->box.width) {
        at[0] = 0;
        at[1] += paper_pixels(paper, 1.35 * size);
    }
    paper_panel(paper, line->face, size, line->colour, card->box.x + at[0],
                card->box.y + at[1], ALIGN_LEFT, line->words);
    at[0] += width + paper_pixels(paper, gap);
    return at[1] + paper_pixels(paper, 1.5 * size);
}

/* ---- what the strip says --------------------------------------------------
 */

/* The first line that is known, where there are no words yet; out [size]. */
static void say(const Show *show, const char *text, char *out, size_t size)
{
    if (!out[0])
        snprintf(out, size, "%.*s", (int)size - 1,
                 text_first(&show_pane(show)->facts, text).words);
}

void show_describe(Show *show)
{
    const Scene *scene = show_pane(show)->simulation->scene;
    show_know(show);
    if (!show->topic)
        show->topic = scene->title ? scene->title : scene->name;
    say(show, text_sentences, show->sentence, sizeof show->sentence);
    say(show, text_methods, show->method, sizeof show->method);
    say(show, text_states, show->state, sizeof show->state);
}
