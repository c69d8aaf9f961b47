#include <math.h>
#include <stdio.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/handles.h"
#include "scenes/small_scenes.h"

/* The path of the minimiser, a disc for every power of ten of h. */
static void dial_path(Paper *paper, const Plot *plot, const Walk *walk,
                      Labels *labels)
{
    for (int i = 1; i < WALK_POINTS; i++) {
        double a[2], b[2];
        plot_line(paper, plot, walk->point[i - 1], walk->point[i], 3, COLOUR_X);
        plot_place(plot, walk->point[i - 1][0], walk->point[i - 1][1], a);
        plot_place(plot, walk->point[i][0], walk->point[i][1], b);
        labels_line(labels, a, b);
    }
    for (int i = 10; i < WALK_POINTS; i += 10)
        plot_disc(paper, plot, walk->point[i], 4.5, COLOUR_X);
}

/* h at each of the discs; the words of two that are one disc stand apart. */
static void dial_steps(Paper *paper, const Plot *plot, const Walk *walk,
                       Labels *labels)
{
    for (int i = WALK_POINTS - 1; i > 0; i -= 10) {
        double at[2];
        char words[32];
        plot_place(plot, walk->point[i][0], walk->point[i][1], at);
        snprintf(words, sizeof words, "h = %g s",
                 round(walk->h[i] * 1e6) / 1e6);
        labels_put(paper, labels, FACE_REGULAR, 0.95, COLOUR_X,
                   (const double(*)[2])at, 1, 0.8 * paper->em, words);
    }
}

static void dial_draw(Paper *paper, const Stage *stage, const Show *show)
{
    const Simulation *simulation = show->pane[stage->pane].simulation;
    bool text = stage->text && !show->bare;
    Legend legend = {0, 0};
    Plot plot = landscape_ground(paper, stage, show);
    Labels labels = {.stage = plot.box};
    double target[2];
    dial_path(paper, &plot, &simulation->exhibit.walk, &labels);
    plot_disc(paper, &plot, simulation->run[0].x, 9, COLOUR_TEXT);
    if (!text)
        return;
    stage_pixel(stage, simulation->exhibit.target, target);
    keep_off_disc(&labels, paper, stage, simulation->run[0].x, 9);
    labels_disc(&labels, target, 11 * paper->unit); /* the handle's ring */
    labels_put(paper, &labels, FACE_BOLD, 1.1, COLOUR_X_TILDE,
               (const double(*)[2])target, 1, 0.9 * paper->em, "{xt}");
    dial_steps(paper, &plot, &simulation->exhibit.walk, &labels);
    stage_legend(paper, stage, &legend, COLOUR_X_TILDE,
                 "{xt}: inertia is lowest");
    stage_legend(paper, stage, &legend, COLOUR_X, "minimiser of E for every h");
    stage_legend(paper, stage, &legend, COLOUR_TEXT, "for the h of now");
}

static void dial_draw_numbers(Paper *paper, Box inside, const Show *show)
{
    const Simulation *simulation = show->pane[show->active].simulation;
    const double *x = simulation->run[0].x, h = simulation->run[0].h;
    const double *target = simulation->exhibit.target;
    double inertia = landscape_part_value(simulation, PART_INERTIA, x[0], x[1]);
    double elastic =
        landscape_part_value(simulation, PART_ELASTICITY, x[0], x[1]);
    Lines lines = {0};
    lines_add(&lines, COLOUR_TEXT, "h = %.4g s", h);
    lines_add(&lines, COLOUR_X, "{x} = (%.4f, %.4f) m", x[0], x[1]);
    lines_add(&lines, COLOUR_X_TILDE, "from {xt}: %.4g m",
              hypot(x[0] - target[0], x[1] - target[1]));
    lines_add(&lines, COLOUR_TEXT, "inertia %.4g J s\u00b2", inertia);
    lines_add(&lines, COLOUR_TEXT, "elasticity h\u00b2 P %.4g J s\u00b2",
              elastic);
    lines_add(&lines, COLOUR_TEXT, "P = %.4g J", elastic / (h * h));
    lines_draw(paper, inside, &lines);
}

static const Card card_dial_numbers = {
    .name = "numbers",
    .title = "the minimiser in numbers",
    .least = 11.5,
    .weight = 1,
    .draw = dial_draw_numbers,
};

static const Card *const dial_cards[] = {&card_page, &card_dial_numbers, NULL};

const Picture dial_picture = {
    .name = "dial",
    .cards = dial_cards,
    .around = LANDSCAPE_AROUND,
    .draw = dial_draw,
};
