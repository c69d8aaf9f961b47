#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/plot.h"

#include <math.h>

/* The two lines of a method, in the order in which they are done. */
typedef struct Formula {
    const char *method, *first, *second, *growth;
} Formula;

static const Formula formulas[] = {
    {"forward-euler", "{x}^{n+1} = {x}^{n} + h v^{n}",
     "v^{n+1} = v^{n} + h a({x}^{n})",
     "radius \u00d7 \u221a(1 + (h\u03c9)\u00b2) a step: it grows"},
    {"symplectic-euler", "v^{n+1} = v^{n} + h a({x}^{n})",
     "{x}^{n+1} = {x}^{n} + h v^{n+1}",
     "stays on an ellipse while h\u03c9 < 2"},
    {"backward-euler", "v^{n+1} = v^{n} + h a({x}^{n+1})",
     "{x}^{n+1} = {x}^{n} + h v^{n+1}",
     "radius / \u221a(1 + (h\u03c9)\u00b2) a step: it shrinks"},
    {"verlet",
     "v^{n+\u00bd} = v^{n} + \u00bdh a({x}^{n});   "
     "{x}^{n+1} = {x}^{n} + h v^{n+\u00bd}",
     "v^{n+1} = v^{n+\u00bd} + \u00bdh a({x}^{n+1})",
     "on an ellipse, nearly the circle, while h\u03c9 < 2"},
    {"bdf2", "{x}^{n+1} = (4{x}^{n} \u2212 {x}^{n\u22121})/3 + \u2154h v^{n+1}",
     "v^{n+1} = (4v^{n} \u2212 v^{n\u22121})/3 + \u2154h a({x}^{n+1})",
     "shrinks, by far less than backward Euler"},
    {"midpoint", "{x}^{n+1} = {x}^{n} + \u00bdh (v^{n} + v^{n+1})",
     "v^{n+1} = v^{n} + h a(\u00bd({x}^{n} + {x}^{n+1}))",
     "stays on the circle, a little late"},
    {"sdirk2", "two stages of backward Euler with \u03b3h,",
     "\u03b3 = 1 \u2212 1/\u221a2; the second one is the end",
     "shrinks, by far less than backward Euler"},
    {"avf", "{x}^{n+1} = {x}^{n} + \u00bdh (v^{n} + v^{n+1})",
     "v^{n+1} = v^{n} + h \u222b a on the way from {x}^{n} to {x}^{n+1}",
     "stays on the circle: energy is kept"},
    {"avf4", "five steps of the averaged field:",
     "g h, g h, (1 \u2212 4g) h, g h, g h;  g = 1/(4 \u2212 4^{1/3})",
     "stays on the circle, hardly late"},
    {NULL, "", "", ""},
};
/* Name, both lines and what they do to the circle, run by run. */
static void draw_methods(Paper *paper, Box inside, const Show *show)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    double block = fmin(6.1, inside.height / paper->em / simulation->runs);
    double step = block / 4.5 * paper->em, x = inside.x + 0.3 * paper->em;
    for (int r = 0; r < simulation->runs; r++) {
        const IntegratorMethod *method = simulation->run[r].method;
        double y = inside.y + r * block * paper->em;
        int i = 0;
        while (formulas[i].method &&
               strcmp(formulas[i].method, method->name) != 0)
            i++;
        const Formula *formula = &formulas[i];
        paper_write(paper, FACE_BOLD, 1, circle_colour(simulation, r), x, y,
                    ALIGN_LEFT, "%s", method->label);
        paper_write(paper, FACE_REGULAR, 1, COLOUR_TEXT, x, y + step,
                    ALIGN_LEFT, "%s", formula->first);
        paper_write(paper, FACE_REGULAR, 1, COLOUR_TEXT, x, y + 2 * step,
                    ALIGN_LEFT, "%s", formula->second);
        paper_write(paper, FACE_REGULAR, 0.9, COLOUR_FAINT, x, y + 3 * step,
                    ALIGN_LEFT, "%s", formula->growth);
    }
}

const Card card_methods = {
    .name = "methods",
    .title = "The methods",
    .least = 20,
    .weight = 0.3,
    .draw = draw_methods,
};
