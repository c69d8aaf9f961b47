/* options.h - the command line as a struct.
 */
#ifndef ELASTO_OPTIONS_H
#define ELASTO_OPTIONS_H

#include <stddef.h>

#include "step/time_integrator.h"

#define ELASTO_VERSION "1.0.0"

struct Scene;

typedef struct Options {
    const struct Scene *scene;
    int segments;
    double side;                        /* m */
    double density;                     /* kg/m^2 */
    double stiffness;                   /* J/m^2 */
    double stretch;                     /* initial horizontal factor */
    double timestep;                    /* s */
    double tolerance;                   /* m/s */
    const IntegratorMethod *integrator; /* NULL: the scene's choice */
    Solver solver;
    Filter filter;
    LineSearch line_search;
    double start[2];    /* m, where scenes with a start begin */
    long steps;         /* -1: until closed, or 100 without a screen */
    bool headless;      /* no window even where there is a screen */
    const char *frames; /* folder for PNG frames, or NULL */
    const char *states; /* file for states, "-" for stdout, or NULL */
    const char *log;    /* file for the Newton log, or NULL */
    bool quiet;
    bool help, version, list; /* print that and stop */
} Options;

/* argv into options; argv may be reordered.
 *   options  out
 *   message  [size] out, one line without newline after INVALID_INPUT
 * Returns OK or INVALID_INPUT.  Prints nothing. */
Status options_parse(int argc, char **argv, Options *options, char *message,
                     size_t size);

/* The text of --help; fits 80 columns and 24 lines. */
const char *options_help(void);

/* The name of a value as on the command line. */
const char *solver_name(Solver solver);
const char *filter_name(Filter filter);
const char *line_search_name(LineSearch search);

#endif
