#include <math.h>
#include <stdio.h>
#include <stdarg.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/plot.h"
#include "picture/show.h"
#include "scenes/small_scenes.h"
#include "scenes/scene.h"

/* Formats into a text [SHOW_TEXT] that is still empty. */
static void say(char *text, const char *format, ...)
{
    va_list arguments;
    if (text[0] != '\0')
        return;
    va_start(arguments, format);
    vsnprintf(text, SHOW_TEXT, format, arguments);
    va_end(arguments);
}

/* What went wrong, as one says it in a lecture. */
static const char *trouble_words(const Simulation *simulation, Status status)
{
    if (status == STATUS_DIVERGED && simulation->descent.scalar)
        return "it flies away: no curvature is left, so there is no next step";
    static const struct {
        Status status;
        const char *words;
    } rows[] = {
        {STATUS_NOT_DESCENT,
         "the direction points uphill: no small step lowers E"},
        {STATUS_LINE_SEARCH_LIMIT,
         "no step tried along the direction lowers E"},
        {STATUS_ITERATION_LIMIT, "the updates do not end"},
        {STATUS_SINGULAR, "the Hessian has no inverse here: no direction"},
        {STATUS_NOT_POSITIVE_DEFINITE,
         "the Hessian has negative eigenvalues: no descent direction"},
        {STATUS_NOT_FINITE, "the numbers left the range of the computer"},
        {STATUS_DIVERGED, "nothing held E down: it ended above where it began"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].status == status)
            return rows[i].words;
    return status_text(status);
}

/* "st", "nd", "rd", "th" */
static const char *ordinal(int number)
{
    static const char *const ends[] = {"th", "st", "nd", "rd"};
    bool teen = number / 10 % 10 == 1;
    return teen || number % 10 > 3 ? "th" : ends[number % 10];
}

/* Line by line. */
static void describe_line(const Simulation *simulation, const Trace *trace,
                          char *s)
{
    const Number tolerance = number_of(trace->tolerance);
    int shown = trace->trials > 1 ? trace->trials : 1;
    int time = trace->iteration + 1;
    if (trace->line == LINE_START)
        say(s, "line 1: the iterate begins where the step does");
    if (trace->line == LINE_DO)
        say(s, "line 2: the loop begins for the %d%s time", time,
            ordinal(time));
    if (trace->line == LINE_PROJECT &&
        simulation->options.filter == FILTER_NONE)
        say(s, "line 3: the Hessian stays as it is");
    if (trace->line == LINE_PROJECT && simulation_projects_springs(simulation))
        say(s,
            "line 3: the blocks of %d of %d springs had a negative "
            "eigenvalue and were projected",
            trace->projected, simulation->system.springs);
    if (trace->line == LINE_PROJECT)
        say(s,
            "line 3: %d blocks of springs, contacts and cells had a "
            "negative eigenvalue and were projected",
            trace->projected);
    if (trace->line == LINE_SOLVE)
        say(s,
            "line 4: the direction points %s; \u2016{p}\u2016_{\u221e} is "
            "the largest |{p}_{x}| + |{p}_{y}| of a node",
            trace->slope > 0 ? "uphill" : "downhill");
    if (trace->line == LINE_SEARCH)
        say(s, "line 5: {alpha} = %s %s",
            alpha_of(trace_alpha(trace, shown)).text,
            trace->accepted ? "is taken" : "is refused: E would rise");
    if (trace->line == LINE_UPDATE)
        say(s, "line 6: the square moves by {alpha} {p}");
    if (trace->line == LINE_TEST && trace->passed)
        say(s,
            "line 7: \u2016{p}\u2016_{\u221e}/h is not above %s m/s: its "
            "%s is below, and {p} is not needed",
            tolerance.text,
            trace->kind == RESIDUAL_BOUND ? "bound" : "estimate");
    if (trace->line == LINE_TEST)
        say(s, "line 7: the residual is %s m/s, %s %s",
            number_of(trace->residual).text,
            trace->residual > trace->tolerance ? "above" : "not above",
            tolerance.text);
    if (trace->line == LINE_END)
        say(s, "line 8: the step of %s s is done", number_of(trace->h).text);
}

static void describe_method(const Show *show, const Simulation *simulation,
                            char *s)
{
    const Scene *scene = simulation->scene;
    const TimeIntegrator *run = simulation->run;
    if (show->panes > 1)
        say(s, "%d side by side", show->panes);
    else if (scene->picture == PICTURE_RACE)
        say(s, "%d methods", RACE_METHODS);
    else if (scene->turn && scene->picture != PICTURE_ENVELOPE)
        say(s, "Newton's method");
    else if (simulation->runs > 1 && run[0].method != run[1].method)
        say(s, "%d integrators", simulation->runs);
    else
        say(s, "%s", run->method->label);
}

/* What the scene shows, where its method does not do something else. */
static const char *scene_sentence(const Simulation *simulation)
{
    const Scene *scene = simulation->scene;
    const IntegratorMethod *method = simulation->run[0].method;
    if (!scene->settles || !method || method->damps)
        return scene->sentence;
    return strcmp(method->name, "forward-euler") == 0
               ? "every step of forward Euler adds energy"
               : "this method takes no energy out of the motion";
}

/* Where a search ended that is no minimum: the gradient is 0 there, too.  NULL
 * where E bends up. */
static const char *end_words(const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    int down = 0;
    if (!simulation->done || descent->residual > simulation->options.tolerance)
        return NULL;
    if (simulation->scene->step == step_descent)
        down = descent_bends_down(simulation, descent->point[0],
                                  descent->point[1]);
    return down == 2   ? "the gradient is 0, but this is a maximum"
           : down == 1 ? "the gradient is 0, but this is a saddle"
                       : NULL;
}

void show_describe(Show *show)
{
    const Pane *pane = &show->pane[show->active];
    const Simulation *simulation = pane->simulation;
    const Scene *scene = simulation->scene;
    const Trace *trace = pane->trace;
    char *sentence = show->sentence;
    const char *end = end_words(simulation);
    bool whole = !trace || !trace->line || trace->given_up;
    if (!show->topic)
        show->topic = scene->title ? scene->title : scene->name;
    if (end)
        say(sentence, "%s", end);
    if (whole && pane->trouble && pane->trouble != STATUS_INTERRUPTED)
        say(sentence, "%s", trouble_words(simulation, pane->trouble));
    else if (trace && trace->line)
        describe_line(simulation, trace, sentence);
    if (!show->lecture) /* its pages have words of their own */
        say(sentence, "%s", scene_sentence(simulation));
    describe_method(show, simulation, show->method);
    if (!show->state[0])
        snprintf(show->state, sizeof show->state, "%s",
                 simulation->done ? "at its end"
                 : show->paused   ? "paused"
                                  : "running");
}
