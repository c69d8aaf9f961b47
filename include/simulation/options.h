/* options.h - the options of a simulation, and a table about them.
 *
 * A row of the table is the only description of an option: the command line,
 * --help, the window's row of numbers, scripts and labels of panes read it. */
#pragma once

#include <stddef.h>

#include "model/square_mesh.h"
#include "step/time_integrator.h"

#define ELASTO_VERSION "1.0.0"

struct Scene;
struct LecturePage;

/* Layers of a picture that can be added to its scene, as bits. */
typedef enum PictureLayer {
    LAYER_NODE_NUMBERS = 1 << 0, /* number of each node */
    LAYER_FORCES = 1 << 1,       /* force on each node, as an arrow */
    LAYER_MODES = 1 << 2, /* node displacements; eigenvectors of a spring */
    LAYER_SPRING_KINDS = 1 << 3, /* a colour and switch per kind of spring */
    LAYER_FILLED_CELLS = 1 << 4, /* cells; the page's answer adds the springs */
    LAYER_DOWNHILL = 1 << 5, /* -grad E and all directions in which E falls */
    LAYER_ZERO_CURVES = 1 << 6, /* curves on which a component of grad E is 0 */
    LAYER_FIRST_STEP = 1 << 7   /* draws only the first step, enlarged */
} PictureLayer;

/* Effect of the key N. */
typedef enum NextAction {
    NEXT_MAKES_STEP,      /* makes a step */
    NEXT_SHORTENS_SPRING, /* makes the spring shorter by a fifth */
    NEXT_ADDS_SPRING,     /* adds the next spring to the shown Hessian */
} NextAction;

enum { OPTIONS_MAX_GROUNDS = 8, OPTIONS_MAX_BALLS = 8 };

/* Numbers of --body: centre X, Y; turn; velocity X, Y; stretch X, Y. */
enum { BODY_OPTION_NUMBERS = 7 };

/* Words that --pin accepts besides node numbers. */
#define PINS_WORDS "top-corners, top, bottom, left, right, all"

static const double DEGREE = 0.017453292519943295; /* pi/180 */

/* Capacity of Options.number, which a static assertion below checks. */
enum { OPTIONS_MAX_NUMBERS = 256 };

/* The value of every option.  Numbers, whole numbers, switches (0 or 1) and
 * names (their index in the row's list) are doubles; the union makes them an
 * array, so that a row of the table can name its number by an index, the slot.
 * The struct has many fields because there are many options; the row of an
 * option in options.c has its meaning, unit and range. */
typedef struct Options {
    union {
        struct {
            double segments, side, density, stiffness, stretch;
            double turn, at[2], velocity[2], gravity, start[2];
            double state_step; /* step of the table --state; -1: the last */
            double grounds;    /* number of rows of ground that are used */
            double ground[OPTIONS_MAX_GROUNDS][4];
            double balls; /* number of rows of ball that are used */
            double ball[OPTIONS_MAX_BALLS][3];
            double bodies; /* number of rows of body that are used */
            double body[SQUARE_MESH_MAX_BODIES][BODY_OPTION_NUMBERS];
            /* height (m), velocity (m/s; 0: no ceiling), lowest height (m) */
            double ceiling[3]; /* values of --ceiling */
            double barrier[2]; /* d_hat (m) and kappa (J/m^2); 0: automatic */
            double friction, slip_speed, has_cell_energy, has_self_contact;
            double self_friction;  /* friction between bodies; -1: `friction` */
            double material;       /* 0: springs, 1: triangles */
            double young, poisson; /* read as material[1], [2] */
            double yield, hardening, tear; /* hardening: read as yield[1] */
            double damping;                /* value of --damping */
            double timestep, tolerance; /* --timestep (s), --tolerance (m/s) */
            double integrator;  /* row of integrator_methods; -1: not chosen */
            double solver;      /* enum Solver */
            double projection;  /* enum Projection */
            double line_search; /* enum LineSearch */
            double flips; /* bit s: switch s starts in the other position */
            double steps; /* -1: 100, or no limit in a window or by a script */
            double speed; /* steps a frame; 0: the speed of the scene */
            double size[2]; /* pixels; 0: the usual size */
            double paused, fullscreen, headless, quiet, big;
            double help, version, list; /* print a text and exit */
        };
        double number[OPTIONS_MAX_NUMBERS]; /* numbers of all options */
    };
    const struct Scene *scene;
    const struct LecturePage *page; /* page of the tour, or NULL */
    unsigned layers;                /* bits of PictureLayer */
    NextAction next_action;         /* effect of the key N */
    int pause_step;                 /* step at which playing pauses; 0: none */
    const char *law_name;           /* law that the card "law" draws, or NULL */
    const char *main_card;          /* name of the enlarged card, or NULL */
    const char *open_cards;         /* names of the open cards of a page */
    const char *pin;                /* nodes that are pinned, or NULL */
    const char *state;              /* CSV file with the start, or NULL */
    const char *state_springs;      /* CSV file with springs, or NULL */
    const char *frames, *states, *log, *energies, *springs, *film, *script;
    int panes; /* number of panes; 1 unless an option has a list of values */
} Options;

/* Slot of a number in Options.number: OPTION_SLOT(timestep). */
#define OPTION_SLOT(field) ((int)(offsetof(Options, field) / sizeof(double)))

_Static_assert(OPTION_SLOT(scene) == OPTIONS_MAX_NUMBERS, "numbers have slots");

/* Largest number of panes, with pictures and without. */
enum { OPTIONS_MAX_DRAWN_PANES = 6, OPTIONS_MAX_PANES = 64 };

/* ---- the table ---------------------------------------------------------- */

typedef enum OptionKind {
    OPTION_SWITCH,       /* no value: 0, or 1 if the option is given */
    OPTION_NUMBER,       /* numbers, `number_count` of them */
    OPTION_WHOLE_NUMBER, /* whole numbers, `number_count` of them */
    OPTION_NAME,         /* index of one of the row's names */
    OPTION_TEXT,         /* file, folder or list of nodes, not empty */
    OPTION_PAGE,         /* page of the tour; the value may be left out */
} OptionKind;

/* The names of a table whose rows begin with a name; NULL ends the table. */
typedef struct NameTable {
    const void *rows; /* rows of the table, which begin with a name */
    size_t row_size;  /* bytes of a row of the table */
} NameTable;

#define NAMES_OF(table) ((NameTable){table, sizeof *(table)})

/* Returns name i; NULL after the last name. */
const char *names_get(NameTable names, int i);

/* Returns the index of a name; -1: the table has no such name. */
int names_find(NameTable names, const char *name);

/* Returns the index of a name, or of its number from 1; -1: neither of them. */
int names_find_or_parse(NameTable names, const char *text);

int names_count(NameTable names);

/* Returns the index of the name for a value of OPTION_NAME.  The value -1, for
 * an option that was not given, means name 0. */
static inline int option_get_name_index(double value)
{
    return value > 0 ? (int)value : 0;
}

/* When a changed option takes effect. */
typedef enum EffectTime {
    EFFECT_NEW_RUN,      /* takes effect in a new run */
    EFFECT_NEXT_STEP,    /* takes effect in the next step */
    EFFECT_REPEATED_STEP /* the present step is repeated with the value */
} EffectTime;

/* How the window shows an option and changes it by mouse, wheel and keys. */
typedef struct OptionDisplay {
    int row_position; /* position in the window's row of numbers, from 1; 0: in
                         the row only after the user has added the option */
    int max_letters;  /* letters of the longest value */
    double notch_increment; /* step of a wheel notch; 0: a notch multiplies */
} OptionDisplay;

/* One option.  Options differ in many ways; most fields of a row are 0. */
typedef struct OptionRow {
    const char *name; /* name without dashes; "": help is the heading of a
                         section of --help; NULL ends the table */
    char letter;      /* letter of the short form, or 0 */
    const char *placeholder; /* value in --help; NULL: the option is a switch */
    const char *help;        /* description in --help */
    OptionKind kind;
    int slot;         /* OPTION_SLOT of the option's first number */
    size_t offset;    /* OPTION_TEXT: offset of the field in Options */
    bool is_table;    /* OPTION_TEXT: the file is a CSV table */
    int number_count; /* how many numbers a value has; 0 means 1 */
    unsigned allowed_short_counts;  /* bit n: the first n numbers are enough */
    const double *omitted_defaults; /* [number_count], for omitted numbers */
    char separator;                 /* separator of the numbers; 0: a comma */
    int max_repetitions; /* limit of repetitions; 0: the last value counts */
    int count_slot;      /* max_repetitions > 0: slot of the number of values */
    double default_value;     /* default, as on the slides */
    double low, high;         /* range, both ends included */
    const char *unit;         /* unit of the numbers, or "" if they have none */
    NameTable value_names;    /* OPTION_NAME: the values */
    unsigned needs_any_trait; /* SceneTrait bits: a scene must have one */
    /* Returns why the option has no effect with the present options, or NULL.
     * The pointer is NULL for options that always have an effect. */
    const char *(*get_idle_reason)(const Options *options);
    EffectTime effect;
    const TermKind *term; /* energy term that the option adds, or NULL */
    const char *label;    /* name in the window, in the markup of text.h; NULL:
                             the option can have no list of values */
    OptionDisplay display;
} OptionRow;

extern const OptionRow option_rows[];

/* Capacity of arrays with an element for each row. */
enum { OPTIONS_MAX_ROWS = 64 };

/* Returns the row with this name, or NULL. */
const OptionRow *option_find(const char *name);

/* Whether a number is in the row's range; the number of a name is its index. */
bool option_allows(const OptionRow *row, double number);

/* Returns how many values a text with separators has. */
int option_count_values(const char *text, char separator);

/* Reads a value as users type it: numbers such as "1/60", "4 ms", and "0,02" if
 * there is only one, each in the row's range, or a name.
 *   count   expected numbers; a value may have fewer if the row says so
 *   number  [count] out; the index of a name
 * Returns whether the text is such a value. */
bool option_parse(const OptionRow *row, int count, const char *text,
                  double *number);

/* Writes a number so that option_parse reads the same number.
 *   row   option with this number, which may stand for a name; NULL: none
 *   text  [size] out */
void option_write(const OptionRow *row, double value, char *text, size_t size);

/* Writes an option's value, the last if repeated, in few digits, or "none".
 *   text  [size] out */
void option_write_short_value(const OptionRow *row, const Options *options,
                              char *text, size_t size);

/* Whether a number of the option is not 0, or a repeated option was given. */
bool option_is_on(const OptionRow *row, const Options *options);

/* Whether an option has the same numbers, or the same name, in two structs. */
bool option_is_equal(const OptionRow *row, const Options *a, const Options *b);

/* Copies all numbers of an option. */
void option_copy_value(const OptionRow *row, const Options *from, Options *to);

/* Returns what the window and the page call an option: "h" for timestep. */
const char *option_get_label(const OptionRow *row);

/* Writes the unit of an option as the window shows it, "J/m\u00b2", or "".
 *   text  [size] out */
void option_write_unit(const OptionRow *row, char *text, size_t size);

/* Lists the options that the window's row of numbers has by default.  Returns
 * how many. */
int options_list_visible_rows(const Options *options,
                              const OptionRow *found[OPTIONS_MAX_ROWS]);

/* Returns the value of an option after notches of the wheel: up, or down if the
 * number of notches is negative.  A notch adds the row's increment.  Without an
 * increment six notches are a factor of 10, and whole notches end on 1, 1.5, 2,
 * 3, 5, 7; names follow each other in a circle.  A drag gives fractions of a
 * notch, and a value of three digits. */
double option_find_value_after_wheel(const OptionRow *row,
                                     const Options *options, double notches);

/* Returns the place of an obstacle in the options, [2] m.
 *   number  of the obstacle: grounds first, then balls */
double *options_get_obstacle_point(Options *options, int number);

/* Returns the chosen integrator, or the first of the table. */
const IntegratorMethod *options_get_method(const Options *options);

/* Returns the name of a solver on the command line. */
const char *get_solver_name(int solver);
