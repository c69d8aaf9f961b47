/* options.c - the table of options.
 *
 * A new option is a field in options.h and a row in this table.  The row gives
 * the option's description, range, label and energy term. */
#include "simulation/options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/cells.h"
#include "model/contact.h"
#include "model/damping.h"
#include "model/fracture.h"
#include "model/friction.h"
#include "model/plasticity.h"
#include "model/neo_hookean.h"
#include "model/self_contact.h"
#include "model/square_mesh.h"
#include "simulation/scene.h"

static const char *const solvers[] = {"newton", "multigrid", "auto", NULL};
static const char *const projections[] = {"clamp", "none", "abs", "on-demand",
                                          NULL};
static const char *const searches[] = {"backtrack", "none", NULL};
static const char *const cells[] = {"off", "on", NULL};
static const char *const materials[] = {"springs", "neo-hookean", NULL};

const char *get_solver_name(int solver)
{
    return solvers[solver];
}

/* Numbers of --body that may be left out: turn 0, velocity 0, stretch 1. */
static const double body_omitted[BODY_OPTION_NUMBERS] = {0, 0, 0, 0, 0, 1, 1};

/* Functions for OptionRow.get_idle_reason: each returns why an option has no
 * effect, or NULL if the condition `works` is true. */
#define REASON(name, works, why)                                               \
    static const char *name(const Options *options)                            \
    {                                                                          \
        return (works) ? NULL : (why);                                         \
    }
REASON(why_nothing_meets,
       options->has_self_contact != 0 ||
           options->grounds + options->balls > 0 || options->ceiling[1] != 0,
       "there is nothing to touch; --ground or --ball adds an obstacle")
REASON(why_no_self_contact, options->has_self_contact != 0,
       "bodies do not touch each other; --self-contact on lets them")
REASON(why_start_is_given, options->bodies == 0 && !options->state,
       options->state ? "the table of --state gives the start"
                      : "each --body has its own; add it there")
REASON(why_own_bodies,
       !options->scene->body.make_obstacle &&
           options->scene->body.pin_speed == 0 &&
           options->scene->body.runs == 0,
       "this scene has its own bodies; --body works in square")
REASON(why_no_springs, options->material == 0,
       "the body has no springs; --material springs gives it some")
REASON(why_no_triangles, options->material != 0,
       "the body has no triangles; --material neo-hookean gives it some")
REASON(why_no_table, options->state,
       "there is no table to start from; --state FILE names it")
REASON(why_nothing_yields, options->yield > 0,
       "the springs do not yield; --yield lets them")
REASON(why_nothing_minimised,
       options_get_method(options)->stages > 0 || !options->headless ||
           options->script || options->panes > 1,
       "an explicit integrator minimises nothing; choose an implicit one, such "
       "as backward-euler")
REASON(why_no_window, !options->headless,
       "with --headless there is no window; leave one of them out")
REASON(why_no_key, !options->headless || options->script,
       "with --headless no key can end the pause; --steps 0 gives the start "
       "alone")
REASON(why_no_frames,
       !options->headless || options->script || options->speed < 1,
       "with --headless each step is a frame; below 1 a film is slower")
REASON(why_nothing_drawn,
       !options->headless || options->script || options->frames ||
           options->film,
       "with --headless only --frames and --film are drawn")

/* Macros for the beginning of a row: field, placeholder of the value,
 * description; then for numbers the unit, default, and range. */
#define SECTION(text) .name = "", .help = text
#define VALUE(sort, word, letters, text, u)                                    \
    .name = word, .placeholder = letters, .help = text, .kind = OPTION_##sort, \
    .unit = u
#define RANGE(sort, word, field, letters, text, u, number, from, to)           \
    VALUE(sort, word, letters, text, u), .slot = OPTION_SLOT(field),           \
                                         .default_value = number, .low = from, \
                                         .high = to
#define NUMBER(field, ...) RANGE(NUMBER, #field, field, __VA_ARGS__)
#define WHOLE(field, ...)  RANGE(WHOLE_NUMBER, #field, field, __VA_ARGS__)
#define NUMBERS(field, many, letters, text, u, from, to)                       \
    NUMBER(field, letters, text, u, 0, from, to), .number_count = many
#define NAME(word, field, letters, text, number, all)                          \
    VALUE(NAME, word, letters, text, ""), .slot = OPTION_SLOT(field),          \
                                          .default_value = number,             \
                                          .value_names = {all, sizeof *all}
#define TEXT(field, letters, text)                                             \
    VALUE(TEXT, #field, letters, text, ""), .offset = offsetof(Options, field)
#define TABLE(field, text) TEXT(field, "FILE", text), .is_table = true
#define SWITCH(field, text)                                                    \
    VALUE(SWITCH, #field, NULL, text, ""), .slot = OPTION_SLOT(field)

/* Macros for the rest of a row: parts that the scene must have, repetitions,
 * the label of an option with lists of values.  SHOWN puts the option into the
 * window's row of numbers: place, length of the values, increment. */
#define NEEDS(what)     .needs_any_trait = HAS_##what
#define TIMES(n, field) .max_repetitions = n, .count_slot = OPTION_SLOT(field)
#define FEWER(bits, others)                                                    \
    .allowed_short_counts = bits, .omitted_defaults = others
#define LIST(text)              .label = text
#define LIVE                    .effect = EFFECT_NEXT_STEP
#define AGAIN                   .effect = EFFECT_REPEATED_STEP
#define TERM(kind)              .term = &(kind)
#define IDLE(why)               .get_idle_reason = why
#define SHOWN(n, longest, adds) .display = {n, longest, adds}

/* Within most ranges a product of two numbers does not over- or underflow. */
const OptionRow option_rows[] = {
    {SECTION("the body (flat: density in kg/m^2, stiffness in J/m^2):")},
    {WHOLE(segments, "N", "number of springs along a side", "", 4, 1,
           SQUARE_MESH_MAX_SEGMENTS),
     NEEDS(MESH), LIST("segments"), SHOWN(4, 4, 1)},
    {NUMBER(side, "L", "length of a side", "m", 1, 1e-30, 1e30), NEEDS(MESH),
     LIST("side")},
    {NUMBER(density, "R", "mass of the body per area", "kg/m^2", 1000, 1e-30,
            1e30),
     NEEDS(MESH), LIST("\u03c1")},
    {NUMBER(stiffness, "K", "stiffness k of each spring", "J/m^2", 1e5, 1e-30,
            1e30),
     NEEDS(MESH), LIST("k"), LIVE, IDLE(why_no_springs), SHOWN(2, 11, 0)},
    {NAME("material", material, "M", "a net of springs, or elastic triangles",
          0, materials),
     NEEDS(BODY), LIST("material"), TERM(neo_hookean_energy)},
    {NUMBER(young, "E", "Young's modulus of the triangles", "J/m^2", 1e5, 1e-30,
            1e30),
     NEEDS(BODY), IDLE(why_no_triangles), LIST("Young"), LIVE,
     SHOWN(12, 11, 0)},
    {NUMBER(poisson, "NU",
            "Poisson's ratio; near 0.5 triangles keep their area", "", 0.4, 0,
            0.499),
     NEEDS(BODY), IDLE(why_no_triangles), LIST("\u03bd"), LIVE,
     SHOWN(13, 8, 0.02)},
    {NUMBER(stretch, "S",
            "horizontal stretch at the start; 1 is the rest shape", "", 1.4,
            -1e200, 1e200),
     NEEDS(MESH), LIST("stretch"), IDLE(why_start_is_given), SHOWN(3, 5, 0.05)},
    {NUMBER(turn, "DEG", "angle of the body at the start, anticlockwise",
            "degrees", 0, -1e6, 1e6),
     NEEDS(BODY), LIST("turned by"), IDLE(why_start_is_given)},
    {NUMBERS(at, 2, "X,Y", "centre of the body at the start", "m", -1e30, 1e30),
     NEEDS(BODY), IDLE(why_start_is_given)},
    {NUMBERS(velocity, 2, "VX,VY", "velocity of every node at the start", "m/s",
             -1e30, 1e30),
     NEEDS(BODY), IDLE(why_start_is_given)},
    {NUMBERS(body, BODY_OPTION_NUMBERS, "X,Y[,DEG[,VX,VY[,SX,SY]]]",
             "a body with centre, angle, velocity, stretch; up to 16", "", -1e9,
             1e9),
     NEEDS(BODY), TIMES(SQUARE_MESH_MAX_BODIES, bodies),
     FEWER(1 << 2 | 1 << 3 | 1 << 5, body_omitted), IDLE(why_own_bodies)},
    {NUMBER(gravity, "G", "acceleration of gravity", "m/s^2 downwards", 0, 0,
            1e30),
     NEEDS(BODY), LIST("gravity"), LIVE},
    {TEXT(pin, "WHAT",
          "nodes that cannot move: numbers I,J,... or " PINS_WORDS
          "; top:2 is the top of body 2"),
     NEEDS(BODY)},
    {TABLE(state, "start from the last step of a table that --states wrote"),
     NEEDS(BODY)},
    {RANGE(WHOLE_NUMBER, "state-step", state_step, "N",
           "start from this step of that table", "", -1, 0, 1e15),
     NEEDS(BODY), IDLE(why_no_table)},
    {VALUE(TEXT, "state-springs", "FILE",
           "broken and yielded springs at the start, a table of --springs", ""),
     .offset = offsetof(Options, state_springs), .is_table = true, NEEDS(BODY),
     IDLE(why_no_table)},
    {NUMBERS(start, 2, "X,Y",
             "start point of overshoot and tangent (X alone), landscape, "
             "arrows and spring",
             "m", -1e300, 1e300),
     NEEDS(START)},

    {SECTION("obstacles, contact, and springs that yield or break:")},
    {NUMBERS(ground, 4, "NX,NY,OX,OY",
             "half plane through O, with the outward normal N; up to 8", "",
             -1e9, 1e9),
     NEEDS(BODY), TIMES(OPTIONS_MAX_GROUNDS, grounds), TERM(contact_energy),
     LIVE},
    {NUMBERS(ball, 3, "X,Y,R", "disc with centre X,Y and radius R, up to 8",
             "m", -1e9, 1e9),
     NEEDS(BODY), TIMES(OPTIONS_MAX_BALLS, balls), TERM(contact_energy), LIVE},
    {NUMBERS(ceiling, 3, "Y,V,STOP",
             "wall above, which moves down from Y to STOP with V < 0 (m, m/s)",
             "", -1e9, 1e9),
     NEEDS(BODY), TERM(contact_energy)},
    {NUMBERS(barrier, 2, "DHAT,KAPPA",
             "distance (m) at which contact begins, stiffness (J/m^2)", "",
             1e-12, 1e18),
     NEEDS(BODY), IDLE(why_nothing_meets), LIVE},
    {NUMBER(friction, "MU", "coefficient of friction of all obstacles", "", 0,
            0, 1e3),
     NEEDS(BODY), IDLE(why_nothing_meets), LIST("\u03bc"), LIVE,
     TERM(friction_energy), SHOWN(6, 7, 0.01)},
    {RANGE(NUMBER, "slip-speed", slip_speed, "EPSV",
           "slip velocity from which friction has its full force", "m/s", 1e-3,
           1e-12, 1e6),
     NEEDS(BODY), IDLE(why_nothing_meets), LIST("slip speed"), LIVE},
    {NAME("self-contact", has_self_contact, "on|off",
          "contact of bodies, also with themselves (two --body: on)", 0, cells),
     NEEDS(BODY), TERM(self_contact_energy)},
    {RANGE(NUMBER, "self-friction", self_friction, "MU",
           "coefficient of friction between bodies; else --friction", "", -1, 0,
           1e3),
     NEEDS(BODY), IDLE(why_no_self_contact)},
    {NAME("cells", has_cell_energy, "on|off",
          "keep the cells of springs from turning over", 0, cells),
     NEEDS(BODY), IDLE(why_no_springs), LIST("cells"), TERM(cell_energy)},
    {NUMBER(yield, "Y", "strain beyond which a spring stays deformed", "", 0,
            1e-9, 1e9),
     NEEDS(BODY), IDLE(why_no_springs), LIST("yield"), TERM(plastic_energy)},
    {NUMBER(hardening, "H", "how much that strain grows as a spring yields", "",
            0, 0, 1e9),
     NEEDS(BODY), IDLE(why_nothing_yields), LIST("hardening")},
    {NUMBER(tear, "S", "strain at which a spring breaks, +-10 % at random", "",
            0, 1e-9, 1e9),
     NEEDS(BODY), IDLE(why_no_springs), LIST("tear"), TERM(fracture)},
    {NUMBER(damping, "ETA",
            "damping of the springs' strain rate (Kelvin-Voigt)", "s", 0, 0,
            1e6),
     NEEDS(BODY), IDLE(why_no_springs), LIST("\u03b7"), LIVE, TERM(damping),
     SHOWN(7, 8, 0)},

    {SECTION("time step and solver:")},
    {NUMBER(timestep, "H", "time step h", "s", 0.004, 1e-30, 1e30),
     .needs_any_trait = HAS_TIMESTEP, LIST("h"), LIVE, SHOWN(1, 8, 0)},
    {NAME("integrator", integrator, "I", "time integrator", -1,
          integrator_methods),
     NEEDS(TIME), LIST("method"), LIVE, SHOWN(8, 16, 0)},
    {NUMBER(tolerance, "T", "Newton's method stops at |p|/h <= T", "m/s", 1e-2,
            1e-300, 1e300),
     NEEDS(MINIMISATION), LIST("\u03b5"), LIVE, IDLE(why_nothing_minimised),
     SHOWN(5, 9, 0)},
    {NAME("solver", solver, "S",
          "how p is found; auto is newton up to 8 segments", SOLVER_AUTO,
          solvers),
     NEEDS(MESH), LIST("solver"), LIVE, IDLE(why_nothing_minimised),
     SHOWN(11, 15, 0)},
    {NAME("projection", projection, "P",
          "what replaces negative eigenvalues of H", PROJECTION_CLAMP,
          projections),
     NEEDS(SPRINGS), LIST("projection"), AGAIN, IDLE(why_nothing_minimised),
     SHOWN(9, 9, 0)},
    {NAME("line-search", line_search, "L", "line search along p",
          LINE_SEARCH_BACKTRACK, searches),
     NEEDS(MINIMISATION), LIST("line search"), AGAIN,
     IDLE(why_nothing_minimised), SHOWN(10, 9, 0)},

    {SECTION("the run, its window and its files:")},
    {RANGE(WHOLE_NUMBER, "steps", steps, "N",
           "end after N steps; without a window after 100", "", -1, 0, 1e15)},
    {SWITCH(paused, "wait at the start until a key is pressed"),
     IDLE(why_no_key)},
    {NUMBER(speed, "S", "steps a frame; a second has 60 frames", "", 0,
            1.0 / 64, 1024),
     IDLE(why_no_frames)},
    {WHOLE(size, "WxH", "size of the window or of the frames, pixels", "", 0,
           16, 8192),
     .number_count = 2, .separator = 'x', IDLE(why_nothing_drawn)},
    {SWITCH(fullscreen, "fill the screen; F11 or Esc leaves it"),
     IDLE(why_no_window)},
    {SWITCH(headless, "open no window")},
    {TEXT(frames, "DIR",
          "write a PNG picture of every drawn step into a folder")},
    {TABLE(states, "write positions and velocities of every step as CSV; a "
                   "FILE - is standard output")},
    {TABLE(log, "write every Newton iteration as CSV")},
    {TABLE(energies, "write the energies of every step as CSV, J")},
    {TABLE(springs, "write the springs of every step as CSV"), NEEDS(MESH)},
    {TEXT(film, "FILE",
          "write a film of all drawn steps: .mp4, .webm, .apng, .gif")},
    {TEXT(script, "FILE",
          "carry out commands from a file; a line is STEP COMMAND")},
    {
        VALUE(PAGE, "lecture", "[PAGE]",
              "the tour, from this page on; Page Down turns the page", ""),
    },
    {SWITCH(big, "large letters, a 35th of the height")},
    {SWITCH(quiet, "print no summary at the end")},
    {SWITCH(help, "print this; --help commands lists the commands of scripts"),
     .letter = 'h'},
    {SWITCH(version, "print the version"), .letter = 'v'},
    {SWITCH(list, "print the scenes; with --lecture the pages of the tour")},
    {.name = NULL},
};

_Static_assert(sizeof option_rows / sizeof *option_rows - 1 <= OPTIONS_MAX_ROWS,
               "arrays have a place for each row");

const OptionRow *option_find(const char *name)
{
    if (strcmp(name, "filter") == 0) /* old name of the option */
        name = "projection";
    int place = names_find(NAMES_OF(option_rows), name);
    return place >= 0 && name[0] ? &option_rows[place] : NULL;
}

const char *names_get(NameTable names, int i)
{
    const char *row = (const char *)names.rows + (size_t)i * names.row_size;
    return *(const char *const *)row;
}

int names_find(NameTable names, const char *name)
{
    for (int i = names_count(names) - 1; i >= 0; i--)
        if (strcmp(names_get(names, i), name) == 0)
            return i;
    return -1;
}

int names_find_or_parse(NameTable names, const char *text)
{
    char *end;
    long number = strtol(text, &end, 10);
    if (end == text || *end)
        return names_find(names, text);
    return number >= 1 && number <= names_count(names) ? (int)number - 1 : -1;
}

int names_count(NameTable names)
{
    int count = 0;
    while (names_get(names, count))
        count++;
    return count;
}

const IntegratorMethod *options_get_method(const Options *options)
{
    return &integrator_methods[option_get_name_index(options->integrator)];
}

double *options_get_obstacle_point(Options *options, int number)
{
    int ball = number - (int)options->grounds;
    return ball < 0 ? options->ground[number] + 2 : options->ball[ball];
}

bool option_is_on(const OptionRow *row, const Options *options)
{
    bool on = false;
    if (row->max_repetitions > 0)
        return options->number[row->count_slot] > 0;
    for (int i = 0; i < row->number_count || i == 0; i++)
        on = on || options->number[row->slot + i] != 0;
    return on;
}

/* Returns the size of all numbers of an option, bytes. */
static size_t count_number_bytes(const OptionRow *row)
{
    int count = row->number_count ? row->number_count : 1;
    int times = row->max_repetitions ? row->max_repetitions : 1;
    return (size_t)count * (size_t)times * sizeof(double);
}

bool option_is_equal(const OptionRow *row, const Options *a, const Options *b)
{
    const double *of_a = &a->number[row->slot], *of_b = &b->number[row->slot];
    return row->kind == OPTION_NAME
               ? option_get_name_index(*of_a) == option_get_name_index(*of_b)
               : memcmp(of_a, of_b, count_number_bytes(row)) == 0;
}

void option_copy_value(const OptionRow *row, const Options *from, Options *to)
{
    memcpy(&to->number[row->slot], &from->number[row->slot],
           count_number_bytes(row));
}

const char *option_get_label(const OptionRow *row)
{
    return row->label ? row->label : row->name;
}

/* Lists the options by their position in the window's row.  An option whose
 * number a notch multiplies is left out while the number is 0. */
int options_list_visible_rows(const Options *options,
                              const OptionRow *found[OPTIONS_MAX_ROWS])
{
    int count = 0;
    for (int place = 1; place < OPTIONS_MAX_ROWS; place++)
        for (const OptionRow *row = option_rows; row->name; row++)
            if (row->display.row_position == place &&
                (row->needs_any_trait & options->scene->traits) &&
                !(row->get_idle_reason && row->get_idle_reason(options)) &&
                (row->kind == OPTION_NAME || row->display.notch_increment > 0 ||
                 options->number[row->slot] > 0))
                found[count++] = row;
    return count;
}
