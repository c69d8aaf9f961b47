#include "play/numbers.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scenes/scene.h"

static const Number numbers[] = {
    {"timestep", "h", "s", 8, NUMBER_FACTOR, 0},
    {"stiffness", "k", "J/m\u00b2", 11, NUMBER_FACTOR, 0},
    {"stretch", "stretch", NULL, 5, NUMBER_STEP, 0.05},
    {"segments", "segments", NULL, 4, NUMBER_STEP, 1},
    {"tolerance", "\u03b5", "m/s", 9, NUMBER_FACTOR, 0},
    {"friction", "\u03bc", NULL, 7, NUMBER_STEP, 0.01},
    {"damping", "\u03b7", "s", 8, NUMBER_FACTOR, 0},
    {"integrator", "method", NULL, 16, NUMBER_NAME, 0},
    {"filter", "projection", NULL, 9, NUMBER_NAME, 0},
    {"line-search", "line search", NULL, 9, NUMBER_NAME, 0},
    {"solver", "solver", NULL, 15, NUMBER_NAME, 0},
    /* not in the row */
    {"side", "side", "m", 0, NUMBER_LABEL, 0},
    {"density", "\u03c1", "kg/m\u00b2", 0, NUMBER_LABEL, 0},
    {"turn", "turned by", "\u00b0", 0, NUMBER_LABEL, 0},
    {"gravity", "gravity", "m/s\u00b2", 0, NUMBER_LABEL, 0},
    {"slip-speed", "slip speed", "m/s", 0, NUMBER_LABEL, 0},
    {"cells", "cells", NULL, 0, NUMBER_LABEL, 0},
    {"yield", "yield", NULL, 0, NUMBER_LABEL, 0},
    {"hardening", "hardening", NULL, 0, NUMBER_LABEL, 0},
    {"tear", "tear", NULL, 0, NUMBER_LABEL, 0},
};

enum { NUMBERS = sizeof numbers / sizeof *numbers };

const Number *number_find(const char *option)
{
    for (int i = 0; i < NUMBERS; i++)
        if (strcmp(numbers[i].option, option) == 0)
            return &numbers[i];
    return NULL;
}

const Number *number_row(int i)
{
    return i >= 0 && i < NUMBERS ? &numbers[i] : NULL;
}

void number_value(const Number *number, const Options *options, char *text)
{
    options_value(options, number->option, text, COMMAND_TEXT_SIZE);
}

/* Whether there is something that the number is about. */
static bool has_meaning(const Number *number, const Options *options)
{
    if (number->kind == NUMBER_LABEL)
        return false;
    if (strcmp(number->option, "damping") == 0)
        return options->damping > 0;
    if (strcmp(number->option, "solver") == 0) /* of a few equations: any */
        return options->scene->needs & NEEDS_MESH;
    return strcmp(number->option, "friction") != 0 ||
           options->grounds + options->balls > 0;
}

int numbers_of(const Options *options, const Number *found[NUMBERS_MOST])
{
    int count = 0;
    for (int i = 0; i < NUMBERS; i++) {
        char text[COMMAND_TEXT_SIZE], unread[2];
        Options trial = *options;
        number_value(&numbers[i], options, text);
        if (has_meaning(&numbers[i], options) &&
            !options_set(&trial, numbers[i].option, text, unread,
                         sizeof unread))
            found[count++] = &numbers[i];
    }
    return count;
}

/* The name after this one, or before it. */
static const char *next_name(const char *option, const Options *options,
                             int way)
{
    int count = 0, now = 0;
    if (strcmp(option, "integrator") == 0) {
        while (integrator_methods[count].name) {
            if (options->integrator == &integrator_methods[count])
                now = count;
            count++;
        }
        return integrator_methods[(now + way + count) % count].name;
    }
    bool filter = strcmp(option, "filter") == 0;
    bool search = strcmp(option, "line-search") == 0;
    count = filter   ? FILTER_COUNT
            : search ? LINE_SEARCH_COUNT
                     : SOLVER_COUNT + 1;
    now = filter   ? (int)options->filter
          : search ? (int)options->line_search
                   : (int)options->solver;
    now = (now + way + count) % count;
    return filter   ? filter_name((Filter)now)
           : search ? line_search_name((LineSearch)now)
                    : solver_name((Solver)now);
}

/* 1, 1.5, 2, 3, 5, 7 times a power of ten. */
static double round_value(double pace)
{
    static const double mantissa[] = {1, 1.5, 2, 3, 5, 7};
    double decade = floor(pace / 6);
    return mantissa[(int)(pace - 6 * decade)] * pow(10, decade);
}

/* A value so many paces on; whole paces from a value between two round ones
 * lead to round ones. */
static double factor_paced(double value, double paces)
{
    double pace = 6 * log10(value);
    if (paces != rint(paces))
        return value * pow(10, paces / 6);
    double near = floor(pace + 0.5);
    for (double p = near - 1; p <= near + 1; p++)
        if (fabs(round_value(p) - value) <= 1e-9 * value)
            return round_value(p + paces);
    double below = near - 2;
    while (round_value(below + 1) < value)
        below++;
    return round_value(paces > 0 ? below + paces : below + 1 + paces);
}

void number_paced(const Number *number, const Options *options, double paces,
                  char *text)
{
    double value = 0;
    if (number->kind == NUMBER_NAME) {
        snprintf(text, COMMAND_TEXT_SIZE, "%s",
                 next_name(number->option, options, paces < 0 ? -1 : 1));
        return;
    }
    number_value(number, options, text);
    if (sscanf(text, "%lf", &value) != 1)
        return;
    if (number->kind == NUMBER_FACTOR) {
        value = factor_paced(value, paces);
    } else {
        value = (rint(value / number->step) + rint(paces)) * number->step;
        if (strcmp(number->option, "segments") == 0)
            value = fmax(value, 1);
        if (strcmp(number->option, "friction") == 0)
            value = fmax(value, 0);
    }
    snprintf(text, COMMAND_TEXT_SIZE, "%.3g", value);
    if (strcmp(number->option, "segments") == 0)
        snprintf(text, COMMAND_TEXT_SIZE, "%.0f", value);
}
