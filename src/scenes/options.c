#include "scenes/options.h"

#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene.h"
#include "model/square_mesh.h"

static const char *const solver_names[SOLVER_COUNT] = {
    [SOLVER_NEWTON] = "newton",
    [SOLVER_LAGGED] = "lagged",
};

static const char *const filter_names[FILTER_COUNT] = {
    [FILTER_CLAMP] = "clamp",
    [FILTER_NONE] = "none",
    [FILTER_ABS] = "abs",
    [FILTER_ON_DEMAND] = "on-demand",
};

static const char *const line_search_names[LINE_SEARCH_COUNT] = {
    [LINE_SEARCH_BACKTRACK] = "backtrack",
    [LINE_SEARCH_NONE] = "none",
};

const char *solver_name(Solver solver)
{
    return solver_names[solver];
}

const char *filter_name(Filter filter)
{
    return filter_names[filter];
}

const char *line_search_name(LineSearch search)
{
    return line_search_names[search];
}

enum OptionCode {
    OPTION_SEGMENTS = 256,
    OPTION_SIDE,
    OPTION_DENSITY,
    OPTION_STIFFNESS,
    OPTION_STRETCH,
    OPTION_TIMESTEP,
    OPTION_TOLERANCE,
    OPTION_INTEGRATOR,
    OPTION_SOLVER,
    OPTION_FILTER,
    OPTION_LINE_SEARCH,
    OPTION_START,
    OPTION_STEPS,
    OPTION_HEADLESS,
    OPTION_FRAMES,
    OPTION_STATES,
    OPTION_LOG,
    OPTION_QUIET,
    OPTION_HELP,
    OPTION_VERSION,
    OPTION_LIST,
};

static const struct option option_rows[] = {
    {"segments", required_argument, NULL, OPTION_SEGMENTS},
    {"side", required_argument, NULL, OPTION_SIDE},
    {"density", required_argument, NULL, OPTION_DENSITY},
    {"stiffness", required_argument, NULL, OPTION_STIFFNESS},
    {"stretch", required_argument, NULL, OPTION_STRETCH},
    {"timestep", required_argument, NULL, OPTION_TIMESTEP},
    {"tolerance", required_argument, NULL, OPTION_TOLERANCE},
    {"integrator", required_argument, NULL, OPTION_INTEGRATOR},
    {"solver", required_argument, NULL, OPTION_SOLVER},
    {"filter", required_argument, NULL, OPTION_FILTER},
    {"line-search", required_argument, NULL, OPTION_LINE_SEARCH},
    {"start", required_argument, NULL, OPTION_START},
    {"steps", required_argument, NULL, OPTION_STEPS},
    {"headless", no_argument, NULL, OPTION_HEADLESS},
    {"frames", required_argument, NULL, OPTION_FRAMES},
    {"states", required_argument, NULL, OPTION_STATES},
    {"log", required_argument, NULL, OPTION_LOG},
    {"quiet", no_argument, NULL, OPTION_QUIET},
    {"help", no_argument, NULL, OPTION_HELP},
    {"version", no_argument, NULL, OPTION_VERSION},
    {"list", no_argument, NULL, OPTION_LIST},
    {NULL, 0, NULL, 0},
};

/* Where the one line that explains a refusal goes. */
typedef struct Complaint {
    char *text;
    size_t size;
} Complaint;

/* Writes the line; returns INVALID_INPUT. */
static Status complain(const Complaint *complaint, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(complaint->text, complaint->size, format, arguments);
    va_end(arguments);
    for (char *c = complaint->text; *c; c++)
        if (iscntrl((unsigned char)*c))
            *c = '?'; /* it stays one line */
    return STATUS_INVALID_INPUT;
}

/* A whole text as a decimal number from low to high. */
static Status parse_whole(const char *name, const char *text, long low,
                          long high, long *value, const Complaint *complaint)
{
    char *end = NULL;
    errno = 0;
    *value = strtol(text, &end, 10);
    bool starts =
        (text[0] >= '0' && text[0] <= '9') || text[0] == '-' || text[0] == '+';
    if (starts && end != text && *end == '\0' && errno == 0 && *value >= low &&
        *value <= high)
        return STATUS_OK;
    if (high == LONG_MAX)
        return complain(complaint,
                        "--%s: '%s' is not a whole number of %ld or more", name,
                        text, low);
    return complain(complaint,
                    "--%s: '%s' is not a whole number from %ld to %ld", name,
                    text, low, high);
}

/* No white space, no name such as "inf". */
static bool starts_number(const char *text)
{
    return text[0] != '\0' && strchr("+-.0123456789", text[0]) != NULL;
}

/* A whole text as a finite number, above 0 if `positive`. */
static Status parse_number(const char *name, const char *text, bool positive,
                           double *value, const Complaint *complaint)
{
    char *end = NULL;
    double number = strtod(text, &end);
    if (starts_number(text) && end != text && *end == '\0' &&
        isfinite(number) && (!positive || number > 0)) {
        *value = number;
        return STATUS_OK;
    }
    return complain(complaint, "--%s: '%s' is not a finite number%s", name,
                    text, positive ? " above 0" : "");
}

/* One of the names of an enumeration. */
static Status parse_name(const char *name, const char *text,
                         const char *const *names, int count, int *value,
                         const Complaint *complaint)
{
    char allowed[128] = "";
    for (int i = 0; i < count; i++) {
        if (strcmp(text, names[i]) == 0) {
            *value = i;
            return STATUS_OK;
        }
        size_t used = strlen(allowed);
        snprintf(allowed + used, sizeof allowed - used, "%s%s",
                 i > 0 ? ", " : "", names[i]);
    }
    return complain(complaint, "--%s: '%s' is none of: %s", name, text,
                    allowed);
}

/* One of the names in the table of integrators. */
static Status parse_integrator(const char *text, Options *options,
                               const Complaint *complaint)
{
    char allowed[256] = "";
    options->integrator = integrator_method(text);
    if (options->integrator)
        return STATUS_OK;
    for (int i = 0; integrator_methods[i].name; i++) {
        size_t used = strlen(allowed);
        snprintf(allowed + used, sizeof allowed - used, "%s%s",
                 i > 0 ? ", " : "", integrator_methods[i].name);
    }
    return complain(complaint, "--integrator: '%s' is none of: %s", text,
                    allowed);
}

/* A file or folder name; an empty one cannot be meant. */
static Status parse_path(const char *name, const char *text, const char **value,
                         const Complaint *complaint)
{
    if (text[0] == '\0')
        return complain(complaint, "--%s: the name is empty", name);
    *value = text;
    return STATUS_OK;
}

/* X,Y, two finite numbers. */
static Status parse_point(const char *name, const char *text, double point[2],
                          const Complaint *complaint)
{
    char *end = NULL;
    double x = strtod(text, &end);
    bool valid = starts_number(text) && end != text && *end == ',';
    const char *second = valid ? end + 1 : text;
    double y = strtod(second, &end);
    valid = valid && starts_number(second) && end != second && *end == '\0';
    if (!valid || !isfinite(x) || !isfinite(y))
        return complain(complaint, "--%s: '%s' is not X,Y, two finite numbers",
                        name, text);
    point[0] = x;
    point[1] = y;
    return STATUS_OK;
}

/* Options whose value is a number. */
static Status apply_number(int code, const char *text, Options *options,
                           const Complaint *complaint)
{
    long whole = 0;
    Status status;
    switch (code) {
    case OPTION_SEGMENTS:
        status = parse_whole("segments", text, 1, SQUARE_MESH_MAX_SEGMENTS,
                             &whole, complaint);
        options->segments = (int)whole;
        return status;
    case OPTION_STEPS:
        return parse_whole("steps", text, 0, LONG_MAX, &options->steps,
                           complaint);
    case OPTION_SIDE:
        return parse_number("side", text, true, &options->side, complaint);
    case OPTION_DENSITY:
        return parse_number("density", text, true, &options->density,
                            complaint);
    case OPTION_STIFFNESS:
        return parse_number("stiffness", text, true, &options->stiffness,
                            complaint);
    case OPTION_STRETCH:
        return parse_number("stretch", text, false, &options->stretch,
                            complaint);
    case OPTION_TIMESTEP:
        return parse_number("timestep", text, true, &options->timestep,
                            complaint);
    case OPTION_START:
        return parse_point("start", text, options->start, complaint);
    default:
        return parse_number("tolerance", text, true, &options->tolerance,
                            complaint);
    }
}

/* Options whose value is a name. */
static Status apply_name(int code, const char *text, Options *options,
                         const Complaint *complaint)
{
    int value = 0;
    Status status = STATUS_OK;
    switch (code) {
    case OPTION_INTEGRATOR:
        return parse_integrator(text, options, complaint);
    case OPTION_SOLVER:
        status = parse_name("solver", text, solver_names, SOLVER_COUNT, &value,
                            complaint);
        options->solver = (Solver)value;
        return status;
    case OPTION_FILTER:
        status = parse_name("filter", text, filter_names, FILTER_COUNT, &value,
                            complaint);
        options->filter = (Filter)value;
        return status;
    default:
        status = parse_name("line-search", text, line_search_names,
                            LINE_SEARCH_COUNT, &value, complaint);
        options->line_search = (LineSearch)value;
        return status;
    }
}

/* One option of the command line. */
static Status apply_option(int code, const char *text, Options *options,
                           const Complaint *complaint)
{
    switch (code) {
    case OPTION_HEADLESS:
        options->headless = true;
        return STATUS_OK;
    case OPTION_QUIET:
        options->quiet = true;
        return STATUS_OK;
    case OPTION_HELP:
        options->help = true;
        return STATUS_OK;
    case OPTION_VERSION:
        options->version = true;
        return STATUS_OK;
    case OPTION_LIST:
        options->list = true;
        return STATUS_OK;
    case OPTION_FRAMES:
        return parse_path("frames", text, &options->frames, complaint);
    case OPTION_STATES:
        return parse_path("states", text, &options->states, complaint);
    case OPTION_LOG:
        return parse_path("log", text, &options->log, complaint);
    case OPTION_INTEGRATOR:
    case OPTION_SOLVER:
    case OPTION_FILTER:
    case OPTION_LINE_SEARCH:
        return apply_name(code, text, options, complaint);
    default:
        return apply_number(code, text, options, complaint);
    }
}

/* Options that not every scene makes use of: it must have one of these. */
typedef struct OptionNeed {
    int first, last; /* codes */
    unsigned any;    /* of enum SceneNeeds */
    const char *what;
} OptionNeed;

static const OptionNeed option_needs[] = {
    {OPTION_SEGMENTS, OPTION_STRETCH, NEEDS_MESH, "square"},
    {OPTION_TIMESTEP, OPTION_TIMESTEP, NEEDS_TIME | NEEDS_SPRINGS, "time"},
    {OPTION_TOLERANCE, OPTION_TOLERANCE, NEEDS_MINIMUM, "minimum to find"},
    {OPTION_INTEGRATOR, OPTION_INTEGRATOR, NEEDS_TIME, "time steps"},
    {OPTION_SOLVER, OPTION_FILTER, NEEDS_SPRINGS, "springs"},
    {OPTION_LINE_SEARCH, OPTION_LINE_SEARCH, NEEDS_MINIMUM, "minimum to find"},
    {OPTION_START, OPTION_START, NEEDS_START, "start to choose"},
};

/* Refuses an option that says something about what the scene lacks. */
static Status check_need(int code, const Scene *scene,
                         const Complaint *complaint)
{
    enum { NEEDS = sizeof option_needs / sizeof *option_needs };
    const char *name = NULL;
    for (const struct option *row = option_rows; row->name; row++)
        if (row->val == code)
            name = row->name;
    for (const OptionNeed *need = option_needs; need < option_needs + NEEDS;
         need++)
        if (code >= need->first && code <= need->last &&
            !(scene->needs & need->any))
            return complain(complaint, "--%s: the scene '%s' has no %s", name,
                            scene->name, need->what);
    return STATUS_OK;
}

/* The next option, as getopt_long does, without its own messages. */
static int next_option(int argc, char **argv)
{
    return getopt_long(argc, argv, ":", option_rows, NULL);
}

/* Of several letters behind one dash, optind is not at them yet. */
static Status complain_unknown(char **argv, const Complaint *complaint)
{
    const char letter[] = {'-', (char)optopt, '\0'};
    bool is_letter = optopt > 0 && optopt < OPTION_SEGMENTS;
    return complain(complaint, "'%s' is no option; see elasto --help",
                    is_letter ? letter : argv[optind - 1]);
}

/* Before the first call of next_option. */
static void rewind_options(void)
{
    opterr = 0;
#ifdef __GLIBC__
    optind = 0; /* forgets an earlier permutation too */
#else
    optind = 1;
#endif
}

/* The one argument that is no option, or the first scene. */
static Status find_scene(int argc, char **argv, Options *options,
                         const Complaint *complaint)
{
    rewind_options();
    while (next_option(argc, argv) != -1)
        continue;
    options->scene = &scenes[0];
    if (optind >= argc)
        return STATUS_OK;
    if (optind + 1 < argc)
        return complain(complaint, "'%s': one scene at a time, please",
                        argv[optind + 1]);
    options->scene = scene_find(argv[optind]);
    if (!options->scene)
        return complain(complaint, "there is no scene '%s'; see elasto --list",
                        argv[optind]);
    return STATUS_OK;
}

/* The slides' numbers. */
static Options default_options(void)
{
    return (Options){
        .segments = 4,
        .side = 1,
        .density = 1000,
        .stiffness = 1e5,
        .stretch = 1.4,
        .timestep = 0.004,
        .tolerance = 1e-2,
        .steps = -1,
    };
}

Status options_parse(int argc, char **argv, Options *options, char *message,
                     size_t size)
{
    Complaint complaint = {message, size};
    *options = default_options();
    Status status = find_scene(argc, argv, options, &complaint);
    if (status)
        return status;
    if (options->scene->defaults)
        options->scene->defaults(options);
    rewind_options();
    int code;
    while (!status && (code = next_option(argc, argv)) != -1) {
        if (code == ':')
            status = complain(&complaint, "%s: the value is missing",
                              argv[optind - 1]);
        else if (code == '?')
            status = complain_unknown(argv, &complaint);
        else if (!(status = check_need(code, options->scene, &complaint)))
            status = apply_option(code, optarg, options, &complaint);
    }
    return status;
}

const char *options_help(void)
{
    return "usage: elasto [SCENE] [options]   a stretched square relaxes\n"
           "  --segments N      segments per side, 1 ... 4096    [4]\n"
           "  --side L          side length, m                   [1]\n"
           "  --density R       kg/m^2                           [1000]\n"
           "  --stiffness K     spring stiffness, J/m^2          [1e5]\n"
           "  --stretch S       initial horizontal stretch       [1.4]\n"
           "  --timestep H      s                                [0.004]\n"
           "  --tolerance T     stop at |p|/h <= T, m/s          [1e-2]\n"
           "  --integrator I    backward-euler, forward-euler, "
           "symplectic-euler, verlet,\n"
           "                    bdf2, midpoint, sdirk2, avf, avf4\n"
           "  --solver S        newton, lagged\n"
           "  --filter F        clamp, none, abs, on-demand (projection)\n"
           "  --line-search L   backtrack, none\n"
           "  --start X,Y       where overshoot and landscape begin, m\n"
           "  --steps N         stop after N steps (no screen: 100)\n"
           "  --headless        no window even where there is a screen\n"
           "  --frames DIR      a PNG of every drawn step\n"
           "  --states FILE     CSV of every step; \"-\": standard output\n"
           "  --log FILE        CSV, a row per Newton iteration\n"
           "  --quiet, --help, --version, --list (the scenes)\n";
}
