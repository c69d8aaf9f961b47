#include <math.h>
#include <stdio.h>
#include <stdarg.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/plot.h"
#include "picture/show.h"
#include "scenes/small_scenes.h"
#include "scenes/scene.h"

/* Formats into a text of SHOW_TEXT bytes that is still empty. */
static void say(char *text, size_t size, const char *format, ...)
{
    va_list arguments;
    if (text[0] != '\0')
        return;
    va_start(arguments, format);
    vsnprintf(text, size, format, arguments);
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

/* The end of the loop; both numbers as text. */
static void describe_test(char *s, const Trace *trace)
{
    char residual[48], tolerance[48];
    plot_number(residual, sizeof residual, trace->residual);
    plot_number(tolerance, sizeof tolerance, trace->tolerance);
    if (trace->passed)
        say(s, SHOW_TEXT,
            "line 7: \u2016{p}\u2016_{\u221e}/h is not above %s m/s: its "
            "%s is below, and {p} is not needed",
            tolerance, trace->kind == RESIDUAL_BOUND ? "bound" : "estimate");
    else
        say(s, SHOW_TEXT, "line 7: the residual is %s m/s, %s %s", residual,
            trace->residual > trace->tolerance ? "above" : "not above",
            tolerance);
}

/* Line by line. */
static void describe_line(Show *show, const Simulation *simulation,
                          const Trace *trace)
{
    char *s = show->sentence, number[48];
    const Options *options = &simulation->options;
    switch (trace->line) {
    case LINE_START:
        say(s, SHOW_TEXT, "line 1: the iterate begins where the step does");
        break;
    case LINE_DO:
        say(s, SHOW_TEXT, "line 2: the loop begins for the %d%s time",
            trace->iteration + 1, ordinal(trace->iteration + 1));
        break;
    case LINE_PROJECT:
        if (options->filter == FILTER_NONE)
            say(s, SHOW_TEXT, "line 3: the Hessian stays as it is");
        else if (simulation_projects_springs(simulation))
            say(s, SHOW_TEXT,
                "line 3: the blocks of %d of %d springs had a negative "
                "eigenvalue and were projected",
                trace->projected, simulation->system.springs);
        else
            say(s, SHOW_TEXT,
                "line 3: %d blocks of springs, contacts and cells had a "
                "negative eigenvalue and were projected",
                trace->projected);
        break;
    case LINE_SOLVE:
        say(s, SHOW_TEXT,
            "line 4: the direction points %s; \u2016{p}\u2016_{\u221e} is the "
            "largest |{p}_{x}| + |{p}_{y}| of a node",
            trace->slope > 0 ? "uphill" : "downhill");
        break;
    case LINE_SEARCH:
        alpha_text(number, sizeof number,
                   ldexp(trace->first > 0 ? trace->first : 1,
                         1 - (trace->trials > 1 ? trace->trials : 1)));
        say(s, SHOW_TEXT, "line 5: {alpha} = %s %s", number,
            trace->accepted ? "is taken" : "is refused: E would rise");
        break;
    case LINE_UPDATE:
        say(s, SHOW_TEXT, "line 6: the square moves by {alpha} {p}");
        break;
    case LINE_TEST:
        describe_test(s, trace);
        break;
    case LINE_END:
        plot_number(number, sizeof number, trace->h);
        say(s, SHOW_TEXT, "line 8: the step of %s s is done", number);
        break;
    default:
        break;
    }
}

static void describe_method(Show *show, const Simulation *simulation)
{
    const IntegratorMethod *method = simulation->run[0].method;
    if (show->panes > 1)
        say(show->method, sizeof show->method, "%d side by side", show->panes);
    else if (simulation->scene->picture == PICTURE_RACE)
        say(show->method, sizeof show->method, "%d methods", RACE_METHODS);
    else if (simulation->scene->turn &&
             simulation->scene->picture != PICTURE_ENVELOPE)
        say(show->method, sizeof show->method, "Newton's method");
    else if (simulation->runs > 1 &&
             simulation->run[0].method != simulation->run[1].method)
        say(show->method, sizeof show->method, "%d integrators",
            simulation->runs);
    else
        say(show->method, sizeof show->method, "%s", method->label);
}

static void describe_time(Show *show, const Simulation *simulation)
{
    char number[48];
    if (simulation->scene->turn) {
        say(show->time_text, SHOW_TEXT, "%s %ld", simulation->scene->turn,
            simulation->steps);
        return;
    }
    plot_number(number, sizeof number, simulation_time(simulation));
    if (simulation->run[0].newton && show->bars > 0 && show->step >= 1 &&
        show->step <= show->bars)
        say(show->time_text, SHOW_TEXT, "step %ld   t = %s s   %d update%s",
            show->step, number, show->bar[show->step - 1].updates,
            show->bar[show->step - 1].updates == 1 ? "" : "s");
    else
        say(show->time_text, SHOW_TEXT, "step %ld   t = %s s",
            simulation->steps, number);
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
    if (!show->topic)
        show->topic = simulation->scene->title ? simulation->scene->title
                                               : simulation->scene->name;
    const char *end = end_words(simulation);
    if (end)
        say(show->sentence, SHOW_TEXT, "%s", end);
    bool whole = !pane->trace || !pane->trace->line || pane->trace->given_up;
    if (whole && pane->trouble && pane->trouble != STATUS_INTERRUPTED)
        say(show->sentence, SHOW_TEXT, "%s",
            trouble_words(simulation, pane->trouble));
    else if (pane->trace && pane->trace->line)
        describe_line(show, simulation, pane->trace);
    if (!show->lecture) /* its pages have words of their own */
        say(show->sentence, SHOW_TEXT, "%s", scene_sentence(simulation));
    describe_method(show, simulation);
    describe_time(show, simulation);
    say(show->state, sizeof show->state, "%s",
        simulation->done ? "at its end"
        : show->paused   ? "paused"
                         : "running");
}
