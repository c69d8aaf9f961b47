/* show.h - all that a frame shows, in one struct: filled before a frame is
 * drawn, only read by pictures and cards.
 *
 * The same Show and size of the paper give the same pixels.  Pointers are not
 * owned; NULL means "there is none", and what would need it is left out.  A
 * zeroed Show with one pane is a valid one.  Texts are in the markup of text.h.
 */
#ifndef ELASTO_SHOW_H
#define ELASTO_SHOW_H

#include "picture/layout.h"
#include "lesson/pages.h"
#include "run/simulation.h"
#include "scenes/small_scenes.h"

enum {
    SHOW_TEXT = 224, /* bytes of a sentence */
    SHOW_VALUE = 32  /* bytes of a setting's value */
};

/* Where in Algorithm 3 the run stands.  Everything up to this line is done:
 * LINE_SOLVE: p is known and drawn; LINE_SEARCH: alpha is. */
typedef enum Line {
    LINE_NONE,    /* between two steps; no line is lit */
    LINE_START,   /* 1  x^i <- x^n */
    LINE_DO,      /* 2  do */
    LINE_PROJECT, /* 3  H^ <- SPDProjection(Hessian E(x^i)) */
    LINE_SOLVE,   /* 4  p <- -H^^-1 grad E(x^i) */
    LINE_SEARCH,  /* 5  alpha <- BackTrackingLineSearch(x^i, p) */
    LINE_UPDATE,  /* 6  x^i <- x^i + alpha p */
    LINE_TEST,    /* 7  while |p|/h > epsilon */
    LINE_END,     /* 8  x^n+1 <- x^i, v^n+1 <- (x^n+1 - x^n)/h */
    LINE_COUNT
} Line;

/* A minimisation as far as it has come: that of the step being made, or of the
 * last one. */
typedef struct Trace {
    Line line;
    double h, tolerance;        /* s, m/s, that the step was made with */
    int updates;                /* records of this step; more than fit in */
    const NewtonRecord *record; /* memory: the last of them */
    /* The present update, from line 3 on. */
    int iteration;         /* 0, 1, ... */
    const double *x;       /* [2n] m, x^i, where p was made */
    const double *p;       /* [2n] m, from line 4 on; NULL before */
    double residual;       /* of p, m/s */
    bool given_up;         /* no alpha was found, or no time was left */
    double slope;          /* grad E . p, J s^2 */
    int projected;         /* springs; < 0: not known */
    const double *x_tilde; /* [2n] m, drawn as a ghost; or NULL */
    /* E(x + alpha p) - E(x), J s^2, NaN or infinite where E is; or NULL. */
    EnergyDifference difference;
    const void *function; /* its first argument */
    double first;         /* alpha that the search begins with; 0 means 1 */
    int trials;    /* shown so far: first, first/2, ...; the last one is */
    bool accepted; /* taken, else it was refused like those before */
} Trace;

/* What is known of a pane, by name: see live_values.h. */
enum { VALUES_MOST = 160, VALUES_RUNS = 3 };

typedef struct LiveValue {
    const char *name;
    int run;           /* 1, 2, 3: it is known of this one alone; 0: of all */
    const char *words; /* NULL: numbers */
    double value[2];
    bool point; /* both: "(1, 0.5)" */
} LiveValue;

typedef struct LiveValues {
    int count, run; /* those that are added now are of this one */
    Colour colour[VALUES_RUNS + 1]; /* of a run; [0] of what is of all */
    LiveValue entry[VALUES_MOST];
} LiveValues;

/* ---- the stage ---------------------------------------------------------- */

enum { HISTORY_SERIES = 16, HISTORY_POINTS = 1024 };

/* A few quantities over time, for plots. */
typedef struct History {
    int series;                       /* rows in use, at most HISTORY_SERIES */
    const char *name[HISTORY_SERIES]; /* of each, not owned; the first is the
                                         total where there is one */
    int count;                        /* points */
    double time[HISTORY_POINTS];      /* s, ascending */
    double value[HISTORY_SERIES][HISTORY_POINTS]; /* one row a quantity */
} History;

/* Appends a point, unless a number is not finite or it is full.  A quantity
 * that is new was 0 before; the last ones are left out where there are too
 * many.
 *   time  s, in: above the one before
 *   row   [rows] in, by their names */
void history_add(History *history, double time, int rows, const Energy *row);

/* A descent's last update as a trace. */
typedef struct DescentTrace {
    Trace trace;
    const Simulation *simulation;
    double from[2], p[2], value;
} DescentTrace;

/* One picture on the stage. */
typedef struct Pane {
    const Simulation *simulation;
    const double *x;         /* [2n] m, to be drawn; NULL: those of run 0 */
    const double *ghost;     /* [2n] m, the outcome with other settings */
    const char *ghost_label; /* "projection none: ..." */
    const History *history;  /* energies (or radii) over time */
    const Trace *trace;
    const char *label; /* over the pane where there are several */
    Status trouble;    /* how the shown step ended */
    /* What show_fill_values fills. */
    LiveValues values;
    DescentTrace descent;
    const Trace *update; /* the trace, or that of a descent; or NULL */
} Pane;

/* What the mouse is over, or holds. */
typedef enum PickKind {
    PICK_NONE,
    PICK_NODE,     /* a node; Pick.index: its number */
    PICK_SPRING,   /* a spring; Pick.index: its number */
    PICK_OBSTACLE, /* index: a ground of the options or, behind those, a ball */
    PICK_EDGE,     /* index: 0 left, 1 right edge: sets the stretch */
    PICK_PLACE,    /* any other point of a map or curve: a click starts there */
    PICK_HANDLE,   /* index: one of the scene's handles, which can be dragged */
    PICK_SWITCH,   /* index: one of its switches */
    PICK_CELL      /* index: row ENVELOPE_COLUMNS + column of the envelope */
} PickKind;

typedef struct Pick {
    PickKind kind;
    int pane, index;
    int near;        /* the nearest node within 3/4 of a cell; -1: none */
    double point[2]; /* m, where the mouse is in the world */
} Pick;

/* The part of a pane's world that stays on the stage while something in it is
 * dragged, so that it stays under the mouse. */
typedef struct Held {
    bool on, away; /* the mouse has left the stage: the view follows again */
    int pane;
    double bounds[4];
} Held;

/* How the user looks at a frame. */
typedef struct View {
    Lens lens;
    Pick hover; /* what the mouse is over on the stage */
    Hit over;   /* part of the window that the mouse is over */
    Held held;
    int chosen; /* cell of the sheet */
} View;

/* ---- around the stage --------------------------------------------------- */

/* A number or a choice in the row. */
typedef struct Setting {
    const char *name;       /* "h", "stretch", "projection" */
    char value[SHOW_VALUE]; /* "0.02 s", "backward Euler" */
    int letters;            /* the longest value has; 0: as long as now */
    bool changed;           /* differs from the scene's default */
    bool off;               /* a method that is switched off */
} Setting;

/* A key and what it does now. */
typedef struct Chip {
    const char *key, *label; /* "Space", "play" */
    bool lit;                /* the one to press next */
} Chip;

/* A step in the time line. */
typedef struct StepBar {
    int updates;
    bool unconverged;
} StepBar;

/* What is in the column: the cards, in their place a page's code, or a list. */
typedef enum Column {
    COLUMN_CARDS,
    COLUMN_CODE,
    COLUMN_PAGES,
    COLUMN_LETTERS,
    COLUMN_KEYS, /* the rows of this list and the next one others fill */
    COLUMN_OPTIONS
} Column;

/* A line of a list: a key or a number, and what it does. */
typedef struct HelpRow {
    char key[SHOW_VALUE], text[SHOW_TEXT];
    bool grey; /* without a meaning now; of a page: extra */
    bool head; /* heading of the rows below it, without a key */
} HelpRow;

/* A scene on the sheet of all of them. */
typedef struct SheetCell {
    const char *name;
    const char *group;            /* the heading above it, or NULL */
    const Simulation *simulation; /* NULL: not made yet */
} SheetCell;

typedef struct Show {
    int panes, active; /* 1 ... LAYOUT_PANES; the one that the cards are of */
    Pane pane[LAYOUT_PANES];

    /* The strip. */
    const char *topic;        /* "Algorithm 3: projected Newton" */
    char sentence[SHOW_TEXT]; /* follows the state */
    char method[SHOW_TEXT];   /* "backward Euler" */
    char state[SHOW_VALUE];   /* "paused", "at rest"; "" means running */
    bool paused;

    /* The row. */
    int settings;
    Setting setting[LAYOUT_SETTINGS];
    int selected; /* by Tab; -1: none */

    /* The time line: steps 1 ... bars; `step` is the one shown. */
    long bars, step;
    StepBar (*bar)(const void *past, long step); /* NULL: no bars are drawn */
    const void *past;
    char time_text[SHOW_TEXT]; /* "step 12   t = 0.24 s   real time x 0.5" */

    /* The last line. */
    int chips;
    Chip chip[LAYOUT_CHIPS];
    char message[SHOW_TEXT]; /* in the place of the sentence; "": none */
    bool warning;            /* the message is one */

    /* The column.  Bit c of a set is the picture's card c. */
    unsigned closed, hidden;
    int large; /* the enlarged one; -1: none */
    Column column;
    int help_rows;
    HelpRow help[LAYOUT_ROWS];

    /* The sheet of all scenes, where it is open: cells > 0. */
    int cells;
    SheetCell cell[LAYOUT_CELLS];

    /* The stage. */
    const View *view;
    const struct Control *hand; /* that pulls in the active pane; NULL: none */
    bool strain;                /* springs coloured by strain */
    bool bare;                  /* the picture of the slide and nothing else */
    struct Text
        *text;     /* what a page's words are measured with; NULL: guessed */
    double letter; /* pixels that an em has at least; 0: the usual ones */
    bool document; /* the paper has the stage alone: texts, numbers, keys and
                      cards are elements of a page beside it */

    /* The lecture: the page that is shown, or NULL outside of it. */
    const LecturePage *lecture;
    bool veiled;         /* its answer is not shown before a guess, */
    unsigned veils;      /* nor is what is in these cards */
    const char *verdict; /* on a guess at this page; NULL: none was made */
    int guesses, right;  /* at all pages */
} Show;

/* Nothing selected, everything fits, one pane that shows the simulation; view
 * is a constant. */
void show_create(const Simulation *simulation, Show *show);

/* The pane whose numbers the cards show. */
static inline const Pane *show_pane(const Show *show)
{
    return &show->pane[show->active];
}

/* Positions that a pane shows, [2n] m. */
const double *pane_x(const Pane *pane);

/* Bounding box of the nodes of the first runs: left, bottom, right, top, m.
 * Nodes that are not finite are left out. */
void pane_node_bounds(const Pane *pane, int runs, double bounds[4]);

/* Cells of which a triangle has turned over. */
int pane_folded(const Pane *pane);

/* ---- where things are --------------------------------------------------- */

/* On a paper of this size, 1 or more; chips beyond the room are left out, but
 * not the last one, which tells of all keys. */
Layout show_layout(const Show *show, int width, int height);

Camera show_camera(const Show *show, const Layout *layout, int pane);

/* The part of the world that a pane shows now, to be held still. */
Held show_hold(const Show *show, const Layout *layout, int pane);

/* What is at this pixel of the stage; PICK_NONE elsewhere. */
Pick show_pick(const Show *show, const Layout *layout, double x, double y);

/* The row of help or of the list of pages at this pixel; -1: none. */
int show_help_row(const Show *show, const Layout *layout, double x, double y);

/* The step whose bar is under x; 0 ... bars. */
long show_find_step(const Show *show, const Layout *layout, double x);

/* ---- what it knows ------------------------------------------------------ */

/* What the lecture adds, where the simulation's options name a page: topic and
 * cards that are hidden; what is in the column, there is code of pages alone;
 * the list of pages, in which the page that was left is marked where none is
 * open.  Before show_describe. */
void show_lecture(Column column, const struct LecturePage *left, Show *show);

/* Fills the values of all panes. */
void show_fill_values(Show *show);

/* The last thing before a frame: fills the values, and from those of the active
 * pane topic, sentence, method and state, as far as they are empty. */
void show_describe(Show *show);

/* The number that texts know by this name now; NaN: none. */
double show_number(Show *show, const char *name);

/* Whether E along p is drawn in a card of this scene or its page: each card is
 * open as at the start, but for those in `toggled`, bit c for card c. */
bool show_needs_line(const Simulation *simulation, unsigned toggled);

/* What the history of this scene's picture shows of the state now.  row out;
 * returns how many. */
int show_sample(const Simulation *simulation, Energy row[HISTORY_SERIES]);

#endif
