/* The sentences above the stage: texts of facts.h; the first line that is
 * known is said. */
#include <stdio.h>

#include "picture/cards.h"
#include "scenes/scene.h"

/* Where a search ended, what went wrong, the line of Algorithm 3, the scene. */
static const char sentences[] =
    "{saddle}the gradient is 0, but this is a saddle\n"
    "{maximum}the gradient is 0, but this is a maximum\n"
    "{diverged}{one unknown}it flies away: no curvature is left, so there is "
    "no next step\n"
    "{not_descent}the direction points uphill: no small step lowers E\n"
    "{line_search_limit}no step tried along the direction lowers E\n"
    "{iteration_limit}the updates do not end\n"
    "{singular}the Hessian has no inverse here: no direction\n"
    "{not_positive_definite}the Hessian has negative eigenvalues: no descent "
    "direction\n"
    "{not_finite}the numbers left the range of the computer\n"
    "{diverged}nothing held E down: it ended above where it began\n"
    "{trouble}\n"
    "{line 1}line 1: the iterate begins where the step does\n"
    "{line 2}line 2: the loop begins for the {nth}{th} time\n"
    "{line 3}{raw}line 3: the Hessian stays as it is\n"
    "{line 3}{of springs}line 3: the blocks of {projected} of {springs} "
    "springs had a negative eigenvalue and were projected\n"
    "{line 3}{of a solid}line 3: {projected} blocks of triangles and contacts "
    "had a negative eigenvalue and were projected\n"
    "{line 3}line 3: {projected} blocks of springs, contacts and cells had a "
    "negative eigenvalue and were projected\n"
    "{line 4}line 4: the direction points {way}; \u2016{p}\u2016_{\u221e} is "
    "the largest |{p}_{x}| + |{p}_{y}| of a node\n"
    "{line 5}{taken}line 5: {alpha} = {length:/} is taken\n"
    "{line 5}line 5: {alpha} = {length:/} is refused: E would rise\n"
    "{line 6}line 6: the square moves by {alpha} {p}\n"
    "{line 7}{passed}line 7: \u2016{p}\u2016_{\u221e}/h is not above "
    "{tolerance} m/s: its {kind} is below, and {p} is not needed\n"
    "{line 7}line 7: the residual is {residual} m/s, {above} {tolerance}\n"
    "{line 8}line 8: the step of {h then} s is done\n"
    "{scene}{grows}every step of forward Euler adds energy\n"
    "{scene}{keeps}this method takes no energy out of the motion\n"
    "{scene}";

static const char methods[] = "{panes} side by side\n"
                              "{methods} methods\n"
                              "{searches}Newton's method\n"
                              "{mixed}{runs} integrators\n"
                              "{method}";

static const char states[] = "{done}at its end\n"
                             "{paused}paused\n"
                             "running";

/* The first line that is known, where there are no words yet; out [size]. */
static void say(const Show *show, const char *text, char *out, size_t size)
{
    if (!out[0])
        snprintf(out, size, "%.*s", (int)size - 1,
                 text_first(&show_pane(show)->facts, text).words);
}

void show_know(Show *show)
{
    for (int i = 0; i < show->panes; i++) {
        Pane *pane = &show->pane[i];
        bool descends = pane->simulation->scene->step == step_descent;
        pane->update = pane->trace || !descends
                           ? pane->trace
                           : descent_trace(pane->simulation, &pane->descent);
        facts_of(show, i, &pane->facts);
    }
}

void show_describe(Show *show)
{
    const Scene *scene = show_pane(show)->simulation->scene;
    show_know(show);
    if (!show->topic)
        show->topic = scene->title ? scene->title : scene->name;
    say(show, sentences, show->sentence, sizeof show->sentence);
    say(show, methods, show->method, sizeof show->method);
    say(show, states, show->state, sizeof show->state);
}
