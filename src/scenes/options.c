/* options.c - the table of options.
 *
 * To add an option: a field in options.h, its default in option_defaults, and
 * a row in option_rows.  Reading, range, unit, abbreviations, "did you mean",
 * refusal where a scene cannot make use of it, and --help come from the row.
 */
#include "scenes/options.h"

#include <stdio.h>
#include <string.h>

#include "model/square_mesh.h"
#include "scenes/option_row.h"
#include "scenes/pins.h"

#define FIELD(field)                                                           \
    .offset = offsetof(Options, field), .size = sizeof((Options){0}.field)

static const OptionName solver_names[] = {
    {"newton", SOLVER_NEWTON,
     "projected-newton pn direct cholesky cholmod ldl"},
    {"multigrid", SOLVER_MULTIGRID,
     "mg matrix-free newton-cg lagged amg gmg pcg"},
    {"auto", SOLVER_AUTO, "default automatic"},
    {NULL, 0, NULL},
};

static const OptionName filter_names[] = {
    {"clamp", FILTER_CLAMP, "on yes true 1 psd spd project projection eigen"},
    {"none", FILTER_NONE, "off no false 0"},
    {"abs", FILTER_ABS, "absolute-value"},
    {"on-demand", FILTER_ON_DEMAND, "auto lazy"},
    {NULL, 0, NULL},
};

static const OptionName cells_names[] = {
    {"on", 1, "yes true 1"},
    {"off", 0, "no false 0"},
    {NULL, 0, NULL},
};

static const OptionName line_search_names[] = {
    {"backtrack", LINE_SEARCH_BACKTRACK, "on yes true 1 armijo halving bisect"},
    {"none", LINE_SEARCH_NONE, "off no false 0 full"},
    {NULL, 0, NULL},
};

/* A row that has only a help text begins a section of --help.  No range lets
 * a product of two numbers become infinite, or lose digits. */
const OptionRow option_rows[] = {
    {.name = "", .help = "the square:"},
    {.name = "segments",
     .value = "N",
     .help = "springs along a side",
     .words =
         "n n-seg nseg segs resolution res cells nodes grid mesh seg n_seg",
     .kind = KIND_WHOLE,
     FIELD(segments),
     .low = 1,
     .high = SQUARE_MESH_MAX_SEGMENTS,
     .needs = NEEDS_MESH,
     .compared = true},
    {.name = "side",
     .value = "L",
     .help = "its length",
     .words = "l side-len side-length length width size-of-square edge",
     .kind = KIND_NUMBER,
     FIELD(side),
     .low = 1e-30,
     .high = 1e30,
     .unit = "m",
     .needs = NEEDS_MESH,
     .compared = true},
    {.name = "density",
     .value = "R",
     .help = "mass of an area",
     .words = "rho r mass m",
     .kind = KIND_NUMBER,
     FIELD(density),
     .low = 1e-30,
     .high = 1e30,
     .unit = "kg/m^2",
     .needs = NEEDS_MESH,
     .compared = true},
    {.name = "stiffness",
     .value = "K",
     .help = "of each spring",
     .words = "k e young youngs-modulus young-modulus modulus spring-constant "
              "spring-stiffness ks",
     .kind = KIND_NUMBER,
     FIELD(stiffness),
     .low = 1e-30,
     .high = 1e30,
     .unit = "J/m^2",
     .needs = NEEDS_MESH,
     .compared = true},
    {.name = "stretch",
     .value = "S",
     .help = "horizontal, at the start",
     .words = "s initial-stretch init-stretch strain scale lambda",
     .kind = KIND_NUMBER,
     FIELD(stretch),
     .low = -1e200,
     .high = 1e200,
     .needs = NEEDS_MESH,
     .compared = true},
    {.name = "turn",
     .value = "DEG",
     .help = "the square, anticlockwise",
     .words = "angle rotate rotation tilt theta",
     .kind = KIND_NUMBER,
     FIELD(turn),
     .low = -1e6,
     .high = 1e6,
     .unit = "degrees",
     .needs = NEEDS_BODY,
     .compared = true},
    {.name = "at",
     .value = "X,Y",
     .help = "where its centre begins",
     .words = "position move centre center offset translate origin where",
     .kind = KIND_NUMBERS,
     .count = 2,
     FIELD(at),
     .low = -1e30,
     .high = 1e30,
     .unit = "m",
     .needs = NEEDS_BODY},
    {.name = "velocity",
     .value = "VX,VY",
     .help = "of every node at the start",
     .words = "v v0 speed initial-velocity throw",
     .kind = KIND_NUMBERS,
     .count = 2,
     FIELD(velocity),
     .low = -1e30,
     .high = 1e30,
     .unit = "m/s",
     .needs = NEEDS_BODY},
    {.name = "gravity",
     .value = "G",
     .help = "how strongly it pulls",
     .words = "g grav weight 9.81",
     .kind = KIND_NUMBER,
     FIELD(gravity),
     .low = 0,
     .high = 1e30,
     .unit = "m/s^2 downwards",
     .needs = NEEDS_BODY,
     .compared = true},
    {.name = "pin",
     .value = "WHAT",
     .help = "nodes that stay: numbers I,J,... or " PINS_WORDS,
     .words = "pins fix fixed dirichlet hold clamp-nodes attach anchor bc",
     .kind = KIND_TEXT,
     FIELD(pin),
     .needs = NEEDS_BODY},
    {.name = "start",
     .value = "X[,Y]",
     .help = "where overshoot (X), landscape (X,Y), ... begin",
     .words = "x0 x initial initial-position initial-guess from",
     .kind = KIND_OWN,
     FIELD(start),
     .parse = parse_start,
     .low = -1e300,
     .high = 1e300,
     .unit = "m",
     .needs = NEEDS_START},

    {.name = "", .help = "what it meets, and what becomes of it:"},
    {.name = "ground",
     .value = "NX,NY,OX,OY",
     .help = "half plane through O with normal N; up to 8",
     .words = "wall floor plane half-plane halfspace ground-n ground-o ceiling",
     .kind = KIND_NUMBERS,
     .count = 4,
     .times = OPTIONS_MAX_GROUNDS,
     .counter = offsetof(Options, grounds),
     FIELD(ground),
     .low = -1e9,
     .high = 1e9,
     .needs = NEEDS_BODY},
    {.name = "ball",
     .value = "X,Y,R",
     .help = "round obstacle that stays; up to 8",
     .words = "circle disc disk sphere obstacle",
     .kind = KIND_NUMBERS,
     .count = 3,
     .times = OPTIONS_MAX_BALLS,
     .counter = offsetof(Options, balls),
     FIELD(ball),
     .low = -1e9,
     .high = 1e9,
     .unit = "m",
     .needs = NEEDS_BODY},
    {.name = "barrier",
     .value = "DHAT,KAPPA",
     .help = "width (m) and stiffness (J/m^3) of contact",
     .words = "dhat kappa ipc contact-stiffness",
     .kind = KIND_NUMBERS,
     .count = 2,
     FIELD(barrier),
     .low = 1e-12,
     .high = 1e18,
     .needs = NEEDS_BODY},
    {.name = "friction",
     .value = "MU",
     .help = "coefficient of all obstacles",
     .words = "mu coulomb friction-coefficient",
     .kind = KIND_NUMBER,
     FIELD(friction),
     .low = 0,
     .high = 1e3,
     .needs = NEEDS_BODY,
     .compared = true},
    {.name = "slip-speed",
     .value = "EPSV",
     .help = "friction's full force begins there",
     .words = "epsv eps-v epsilon-v static-friction-speed",
     .kind = KIND_NUMBER,
     FIELD(slip_speed),
     .low = 1e-12,
     .high = 1e6,
     .unit = "m/s",
     .needs = NEEDS_BODY,
     .compared = true},
    {.name = "cells",
     .value = "on|off",
     .help = "cells that cannot turn over",
     .words = "inversion-free area-barrier no-inversion",
     .kind = KIND_NAME,
     FIELD(cells),
     .names = cells_names,
     .needs = NEEDS_BODY,
     .compared = true},
    {.name = "yield",
     .value = "Y",
     .help = "strain beyond which springs flow",
     .words = "plastic plasticity yield-strain yield-stress",
     .kind = KIND_NUMBER,
     FIELD(yield),
     .low = 1e-9,
     .high = 1e9,
     .needs = NEEDS_BODY,
     .compared = true},
    {.name = "hardening",
     .value = "H",
     .help = "how fast that strain grows",
     .words = "harden hardening-modulus",
     .kind = KIND_NUMBER,
     FIELD(hardening),
     .low = 0,
     .high = 1e9,
     .needs = NEEDS_BODY,
     .compared = true},
    {.name = "tear",
     .value = "S",
     .help = "strain at which springs break",
     .words = "break fracture strength break-strain max-strain",
     .kind = KIND_NUMBER,
     FIELD(tear),
     .low = 1e-9,
     .high = 1e9,
     .needs = NEEDS_BODY,
     .compared = true},
    {.name = "damping",
     .value = "ETA",
     .help = "of the springs' strain rate (Kelvin-Voigt)",
     .words = "eta damp damper viscosity viscous kelvin-voigt rayleigh "
              "restitution drag dissipation",
     .kind = KIND_NUMBER,
     FIELD(damping),
     .low = 0,
     .high = 1e6,
     .unit = "s",
     .needs = NEEDS_BODY,
     .compared = true},

    {.name = "", .help = "how it moves:"},
    {.name = "timestep",
     .value = "H",
     .help = "h",
     .words = "h t dt delta-t step-size stepsize time-step-size ts delta cfl",
     .kind = KIND_NUMBER,
     FIELD(timestep),
     .low = 1e-30,
     .high = 1e30,
     .unit = "s",
     .needs = NEEDS_TIME | NEEDS_STEP,
     .compared = true},
    {.name = "integrator",
     .value = "I",
     .help = NULL, /* the names of the table of integrators */
     .words = "i method scheme time-integrator time-integration integration "
              "stepper ode time-stepping",
     .kind = KIND_OWN,
     FIELD(integrator),
     .parse = parse_integrator,
     .needs = NEEDS_TIME,
     .compared = true},
    {.name = "tolerance",
     .value = "T",
     .help = "the search ends at |p|/h <= T",
     .words = "tol eps epsilon precision accuracy residual threshold newton-"
              "tolerance maxiter max-iter max-iterations newton-iterations",
     .kind = KIND_NUMBER,
     FIELD(tolerance),
     .low = 1e-300,
     .high = 1e300,
     .unit = "m/s",
     .needs = NEEDS_MINIMUM,
     .compared = true},
    {.name = "solver",
     .value = "S",
     .words = "linear-solver optimizer optimiser minimizer minimiser algorithm",
     .kind = KIND_NAME,
     FIELD(solver),
     .names = solver_names,
     .needs = NEEDS_SPRINGS,
     .compared = true},
    {.name = "minimum",
     .help = "a step does not end on a saddle",
     .words = "saddle negative-curvature second-order minimiser",
     .kind = KIND_SWITCH,
     FIELD(minimum),
     .needs = NEEDS_SPRINGS},
    {.name = "filter",
     .value = "F",
     .help = "the projection:",
     .words = "f projection project psd spd make-psd make-spd hessian-filter "
              "no-projection no-filter eigenvalues",
     .kind = KIND_NAME,
     FIELD(filter),
     .names = filter_names,
     .needs = NEEDS_SPRINGS,
     .compared = true},
    {.name = "line-search",
     .value = "L",
     .words = "ls search backtracking no-line-search alpha",
     .kind = KIND_NAME,
     FIELD(line_search),
     .names = line_search_names,
     .needs = NEEDS_MINIMUM,
     .compared = true},

    {.name = "", .help = "how long, and what is left behind:"},
    {.name = "steps",
     .value = "N",
     .help = "then end; without a screen after 100",
     .words = "num-steps nsteps n-steps iterations iters iter max-steps "
              "frames-count duration time end-time t-end tmax",
     .kind = KIND_WHOLE,
     FIELD(steps),
     .low = 0,
     .high = 1e18},
    {.name = "paused",
     .help = "at the start",
     .words = "pause wait stopped start-paused begin-paused",
     .kind = KIND_SWITCH,
     FIELD(paused)},
    {.name = "speed",
     .value = "S",
     .help = "steps a frame, 60 frames a second",
     .words = "rate slow slow-motion fast steps-per-frame",
     .kind = KIND_NUMBER,
     FIELD(speed),
     .low = 1.0 / 64,
     .high = 1024},
    {.name = "size",
     .value = "WxH",
     .help = "of the window or the frames, pixels",
     .words = "window-size geometry resolution-of-window win screen-size "
              "dimensions",
     .kind = KIND_OWN,
     FIELD(size),
     .parse = parse_size,
     .low = 16,
     .high = 8192},
    {.name = "fullscreen",
     .help = "F11 or Esc leaves it",
     .words = "full-screen full maximised maximized",
     .kind = KIND_SWITCH,
     FIELD(fullscreen)},
    {.name = "headless",
     .help = "no window even where there is a screen",
     .words = "no-window nowindow batch no-gui nogui offscreen no-display "
              "without-window console cli no-screen",
     .kind = KIND_SWITCH,
     FIELD(headless)},
    {.name = "frames",
     .value = "DIR",
     .help = "a PNG of every drawn step",
     .words = "png pngs images pictures frame out-dir output-dir outdir dir "
              "screenshots screenshot snapshot snapshots render",
     .kind = KIND_TEXT,
     FIELD(frames)},
    {.name = "states",
     .value = "FILE",
     .help = "CSV of every step; \"-\": standard output",
     .words = "csv o output out save dump state positions trajectory write "
              "export results",
     .kind = KIND_TEXT,
     FIELD(states)},
    {.name = "log",
     .value = "FILE",
     .help = "CSV, a row per Newton iteration",
     .words = "logfile log-file newton-log trace history verbose convergence "
              "debug logging",
     .kind = KIND_TEXT,
     FIELD(log)},
    {.name = "film",
     .value = "FILE",
     .help = "of all drawn steps: .mp4, .webm, .apng, .gif",
     .words = "movie video record gif mp4 webm apng animation",
     .kind = KIND_TEXT,
     FIELD(film)},
    {.name = "script",
     .value = "FILE",
     .help = "commands, each line: STEP COMMAND",
     .words = "commands replay play input actions",
     .kind = KIND_TEXT,
     FIELD(script)},
    {.name = "lecture",
     .value = "[PAGE]",
     .help = "page by page; Page Down is the next one",
     .words = "slides page pages lesson presentation present talk slide "
              "tutorial tour guide guided-tour course",
     .kind = KIND_OWN,
     FIELD(page),
     .parse = parse_page,
     .optional = true},
    {.name = "handout",
     .value = "FILE",
     .help = "all pages as one HTML file, and end",
     .words = "html web webpage export-html notes",
     .kind = KIND_TEXT,
     FIELD(handout)},
    {.name = "quiet",
     .help = "no summary",
     .words = "q silent no-summary no-output",
     .kind = KIND_SWITCH,
     FIELD(quiet)},
    {.name = "help",
     .letter = 'h',
     .help = "this",
     .words = "usage options info man ? commands",
     .kind = KIND_SWITCH,
     FIELD(help)},
    {.name = "version",
     .letter = 'v',
     .help = "the number of this version",
     .words = "ver about release",
     .kind = KIND_SWITCH,
     FIELD(version)},
    {.name = "list",
     .help = "the scenes",
     .words = "scenes scene examples demos list-scenes ls-scenes demo example",
     .kind = KIND_SWITCH,
     FIELD(list)},
    {.name = NULL},
};

_Static_assert(sizeof option_rows / sizeof *option_rows - 1 <= OPTION_MOST,
               "arrays have a place for each row");

/* The slides' numbers. */
Options option_defaults(void)
{
    return (Options){
        .segments = 4,
        .solver = SOLVER_AUTO,
        .side = 1,
        .density = 1000,
        .stiffness = 1e5,
        .stretch = 1.4,
        .timestep = 0.004,
        .tolerance = 1e-2,
        .slip_speed = 1e-3,
        .cell_stiffness = 0.5,
        .steps = -1,
        .panes = 1,
    };
}

/* The name of a value on the command line. */
static const char *value_name(const OptionName *names, int value)
{
    while (names->name && names->value != value)
        names++;
    return names->name;
}

const char *solver_name(Solver solver)
{
    return value_name(solver_names, (int)solver);
}

const char *filter_name(Filter filter)
{
    return value_name(filter_names, (int)filter);
}

const char *line_search_name(LineSearch search)
{
    return value_name(line_search_names, (int)search);
}

const OptionRow *option_row(const char *name)
{
    const OptionRow *row = option_rows;
    while (row->name && strcmp(row->name, name) != 0)
        row++;
    return row;
}

bool options_value(const Options *options, const char *name, char *text,
                   size_t size)
{
    const OptionRow *row = option_row(name);
    const IntegratorMethod *method =
        options->integrator ? options->integrator : &integrator_methods[0];
    double number;
    int whole;
    text[0] = '\0';
    if (!row->name || !row->compared)
        return false;
    const char *field = (const char *)options + row->offset;
    if (row->kind == KIND_NUMBER) {
        memcpy(&number, field, sizeof number);
        snprintf(text, size, "%g", number);
    } else if (row->kind == KIND_OWN) {
        snprintf(text, size, "%s", method->name);
    } else {
        memcpy(&whole, field, sizeof whole);
        if (row->kind == KIND_NAME)
            snprintf(text, size, "%s", value_name(row->names, whole));
        else
            snprintf(text, size, "%d", whole);
    }
    return true;
}

const char *options_compared(int i)
{
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->compared && i-- == 0)
            return row->name;
    return NULL;
}
