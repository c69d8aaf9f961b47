/* options.h - the command line as a struct, and the table that knows of it.
 *
 * A row of the table is all that the command line, --help, the row of numbers
 * in the window, commands of scripts and the labels of panes know of an option.
 */
#ifndef ELASTO_OPTIONS_H
#define ELASTO_OPTIONS_H

#include <stddef.h>
#include <stdio.h>

#include "model/square_mesh.h"
#include "step/time_integrator.h"

#define ELASTO_VERSION "1.0.0"

struct Scene;
struct LecturePage;

/* What a picture shows besides its scene, as bits. */
typedef enum Layer {
    LAYER_NUMBERS = 1 << 0,    /* number of each node */
    LAYER_FORCES = 1 << 1,     /* force on each node, as an arrow */
    LAYER_MODES = 1 << 2,      /* fastest oscillation, or eigenvectors */
    LAYER_KINDS = 1 << 3,      /* colour of each kind of spring; kinds are
                                  switches */
    LAYER_CUTS = 1 << 4,       /* a solid without springs before the guess */
    LAYER_DOWNHILL = 1 << 5,   /* -grad E, and the half plane on its side */
    LAYER_CURVES = 1 << 6,     /* where each component of the gradient is 0 */
    LAYER_FIRST_STEP = 1 << 7, /* the first step alone, as large as it fits */
} Layer;

/* What N does. */
typedef enum NextDeed {
    NEXT_STEP,   /* makes a step */
    NEXT_NEARER, /* brings the end of the spring nearer by a fifth */
    NEXT_SPRING, /* lights the spring whose number is that of the step */
} NextDeed;

enum { OPTIONS_MAX_GROUNDS = 8, OPTIONS_MAX_BALLS = 8 };

/* Numbers of a body's start: centre, turn, velocity, stretch. */
enum { BODY_NUMBERS = 7 };

static const double DEGREE = 0.017453292519943295; /* pi/180 */

/* All numbers are doubles that are seen as an array, too: a slot is the place
 * of one in it.  Whole numbers, switches (0 or 1) and names (their place in the
 * row's list) are among them.  What each is, its unit and its range: see its
 * row in options.c. */
enum { OPTIONS_NUMBERS = 256 }; /* room; the compiler says if it is too small */

typedef struct Options {
    union {
        struct {
            double segments, side, density, stiffness, stretch;
            double turn, at[2], velocity[2], gravity, start[2];
            double state_step; /* of the table; -1: the last */
            double grounds, ground[OPTIONS_MAX_GROUNDS][4]; /* how many, and */
            double balls, ball[OPTIONS_MAX_BALLS][3];       /* which ones */
            double bodies, body[SQUARE_MESH_MAX_BODIES][BODY_NUMBERS];
            double ceiling[3]; /* its velocity 0: there is none */
            double barrier[2]; /* 0: side/100, 4 k */
            double friction, slip_speed, cells;
            double self_contact, self_friction; /* -1: as friction */
            double material, young, poisson;    /* 0: springs, 1: triangles */
            double yield, hardening, tear;      /* 0: never */
            double damping;
            double timestep, tolerance;
            double integrator;  /* its row; -1: the scene's choice */
            double solver;      /* enum Solver */
            double projection;  /* enum Projection */
            double line_search; /* enum LineSearch */
            double flips;       /* bit s: switch s of the scene is turned
                                   over at the start: of a page, by hand */
            double steps;       /* -1: until closed, or 100 without a screen */
            double speed;       /* steps a frame; 0: the scene's */
            double size[2];     /* pixels; 0: the usual ones */
            double paused, fullscreen, headless, quiet, big;
            double help, version, list; /* print that and stop */
        };
        double number[OPTIONS_NUMBERS];
    };
    const struct Scene *scene;
    const struct LecturePage *page; /* of the lecture, or NULL */
    unsigned layers;                /* bits of Layer */
    NextDeed next;                  /* what N does */
    int pause;                      /* step at which playing pauses; 0: none */
    const char *law, *star;    /* of card law, of the large card; or NULL */
    const char *pin;           /* which nodes never move, or NULL */
    const char *state;         /* the table it begins in, or NULL */
    const char *state_springs; /* the table of its springs, or NULL */
    const char *frames, *states, *log, *energies, *springs, *film,
        *script; /* or NULL */
    int panes;   /* side by side, 1: no lists of values */
} Options;

/* The slot of a number of Options: OPTION_SLOT(timestep). */
#define OPTION_SLOT(field) ((int)(offsetof(Options, field) / sizeof(double)))

_Static_assert(OPTION_SLOT(scene) == OPTIONS_NUMBERS, "each number has a slot");

/* Runs of one command line: as many as are drawn side by side, or more where
 * nothing is drawn. */
enum { OPTIONS_MAX_DRAWN = 6, OPTIONS_MAX_PANES = 64 };

/* ---- the table ---------------------------------------------------------- */

typedef enum OptionKind {
    OPTION_SWITCH, /* 0 or 1; takes no value */
    OPTION_NUMBER, /* [count] */
    OPTION_WHOLE,  /* [count] without a fraction */
    OPTION_NAME,   /* the place of one of the row's names */
    OPTION_TEXT,   /* a file, a folder: not empty */
    OPTION_PAGE,   /* of the lecture; the value may be left out */
} OptionKind;

/* The names of a table whose rows begin with one, up to NULL. */
typedef struct Names {
    const void *table;
    size_t size; /* of a row */
} Names;

#define NAMES_OF(table) ((Names){table, sizeof *(table)})

/* Name i, NULL behind the last; the place of a name, or of a number from 1 too,
 * -1: there is none; how many there are. */
const char *name_at(Names names, int i);
int name_place(Names names, const char *name);
int name_or_number(Names names, const char *text);
int names_count(Names names);

/* When another number takes effect. */
typedef enum Effect {
    EFFECT_START, /* another system, or another start: a new run from step 0 */
    EFFECT_LIVE,  /* from the next step on */
    EFFECT_AGAIN  /* and the present step is made once more with it */
} Effect;

typedef struct OptionRow {
    const char *name;  /* without its dashes; "": help begins a section of
                          --help; NULL ends the table */
    char letter;       /* short form, or 0 */
    const char *value; /* what stands for the value in --help */
    const char *help;  /* what it is */
    OptionKind kind;
    int slot;           /* of its first number */
    size_t offset;      /* OPTION_TEXT: of its field in Options */
    bool table;         /* OPTION_TEXT: a file of CSV */
    int count;          /* numbers of one value; 0: one */
    unsigned fewer;     /* bit n: it may have only n numbers, */
    const double *rest; /* [count] the others are these */
    char between;       /* what stands between them; 0: a comma */
    int times;          /* more than 0: it may be given so often; the values */
    int counter;        /* stand behind one another, how many in this slot */
    double standard;    /* the slides' number */
    double low, high;   /* from ... to, both included */
    const char *unit;   /* of the numbers, or "" */
    Names names;        /* OPTION_NAME, OPTION_PAGE: as on the command line */
    unsigned needs;     /* of enum SceneNeeds, one of them; 0: nothing */
    /* Why it has no meaning with these options; NULL: it has one. */
    const char *(*idle)(const Options *options);
    Effect effect;
    const TermKind *term; /* that it brings where it is not 0; or NULL */
    const char *label; /* in the window, in the markup of text.h; of all whose
                          lists of values are side by side; or NULL */
    int place;         /* in the row of numbers, from 1; 0: not there */
    int letters;       /* the longest value has */
    double pace;       /* what one pace adds; 0: by factors, or names */
} OptionRow;

extern const OptionRow option_rows[];
enum { OPTIONS_MOST = 64 }; /* rows */

/* The row with this name, or NULL. */
const OptionRow *option_find(const char *name);

/* A number of the row (NULL: any) as text: with as many digits as option_read
 * needs to read the same number again, or in short, as the window has room for
 * it: of what is given several times the last one; "none": it was not given.
 *   text  [size] out */
void option_write(const OptionRow *row, double value, char *text, size_t size);
void option_value(const OptionRow *row, const Options *options, char *text,
                  size_t size);

/* Whether a number of the row is not 0: so its term is wanted. */
bool option_is_on(const OptionRow *row, const Options *options);

/* Its unit as the window writes it, "J/m\u00b2"; "": none.
 *   text  [size] out */
void option_unit(const OptionRow *row, char *text, size_t size);

/* The rows that the row of numbers has, in their places.
 *   found  [OPTIONS_MOST] out
 * Returns how many. */
int options_row(const Options *options, const OptionRow *found[OPTIONS_MOST]);

/* The value `paces` paces up (or, below 0, down): by what the row says a pace
 * adds; or a factor of 10 is 6 paces, and whole paces end on 1, 1.5, 2, 3, 5,
 * 7; names follow one another in a circle.  Parts of a pace are for dragging:
 * they have three digits. */
double option_paced(const OptionRow *row, const Options *options, double paces);

/* The chosen integrator, or the first of the table. */
const IntegratorMethod *options_method(const Options *options);

/* The name of a solver as on the command line. */
const char *solver_name(int solver);

#endif
