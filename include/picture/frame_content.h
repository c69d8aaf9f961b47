/* frame_content.h - the contents of a frame in one struct, which is filled
 * before the frame is drawn; pictures and cards only read it.
 *
 * The same contents and size of the paper give the same pixels.  Pointers are
 * not owned; an element whose pointer is NULL is not drawn.  A zeroed struct
 * with one pane is valid.  Texts are in the markup of text.h.
 */
#ifndef ELASTO_FRAME_CONTENT_H
#define ELASTO_FRAME_CONTENT_H

#include "picture/layout.h"
#include "lesson/pages.h"
#include "run/simulation.h"
#include "scenes/small_scenes.h"

enum {
    SENTENCE_SIZE = 224, /* bytes of a sentence */
    VALUE_SIZE = 32      /* bytes of a setting's value */
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

/* Words of the strip above the stage. */
typedef struct Strip {
    const char *topic;            /* "Algorithm 3: projected Newton" */
    char sentence[SENTENCE_SIZE]; /* what happens in the present state */
    char method[SENTENCE_SIZE];   /* "backward Euler" */
    char state[VALUE_SIZE];       /* "paused", "at rest"; "": running */
    char message[SENTENCE_SIZE];  /* shown instead of the sentence; or "" */
    bool is_warning;              /* the message is a warning */
} Strip;

/* A number or a choice in the row of settings. */
typedef struct Setting {
    const char *name;       /* "h", "stretch", "projection" */
    char value[VALUE_SIZE]; /* "0.02 s", "backward Euler" */
    int letters;            /* letters of the longest value; 0: of this value */
    bool changed;           /* differs from the scene's default */
    bool off;               /* a method that is switched off */
} Setting;

typedef struct SettingsRow {
    int count;
    Setting item[LAYOUT_SETTINGS];
    int selected; /* index of the setting selected by Tab; -1: none */
} SettingsRow;

/* A step in the time line. */
typedef struct StepBar {
    int updates;
    bool unconverged;
} StepBar;

typedef struct TimeLine {
    long steps;  /* number of known steps */
    long step;   /* the step on the stage, 0 ... steps */
    bool paused; /* time stands still */
    /* Returns the bar of a step 1 ... steps.  NULL: no bars are drawn. */
    StepBar (*bar)(const void *past, long step);
    const void *past;         /* first argument of bar */
    char text[SENTENCE_SIZE]; /* "step 12   t = 0.24 s   2 steps a frame" */
} TimeLine;

/* A key and what it does now. */
typedef struct Chip {
    const char *key, *label; /* "Space", "play" */
    bool lit;                /* is the key to press next */
} Chip;

typedef struct ChipRow {
    int count;
    Chip item[LAYOUT_CHIPS];
} ChipRow;

/* Contents of the column: the cards, or instead of them a page's code or a
 * list. */
typedef enum Column {
    COLUMN_CARDS,
    COLUMN_CODE,
    COLUMN_PAGES,
    COLUMN_LETTERS,
    COLUMN_KEYS,   /* list of keys, whose rows the application fills */
    COLUMN_OPTIONS /* list of options, whose rows the application fills */
} Column;

/* State of the cards.  Bit c of a set is the picture's card c. */
typedef struct CardSets {
    unsigned closed;  /* cards of which only the title is drawn */
    unsigned hidden;  /* cards that the picture or the page leaves out */
    unsigned covered; /* cards whose content is not drawn before a guess */
    int large;        /* index of the enlarged card; -1: none */
} CardSets;

/* A row of a list: a key or a number, and what it does. */
typedef struct ListRow {
    char key[VALUE_SIZE], text[SENTENCE_SIZE];
    bool grey; /* a key without a meaning now, or an extra page */
    bool head; /* a heading, without a key */
} ListRow;

typedef struct List {
    int rows;
    ListRow row[LAYOUT_ROWS];
} List;

/* A scene in the overview of all scenes. */
typedef struct SheetCell {
    const char *name;
    const char *group;            /* heading above the cell, or NULL */
    const Simulation *simulation; /* NULL: not made yet */
} SheetCell;

/* The overview of all scenes; no cells: it is closed. */
typedef struct SheetContent {
    int cells;
    SheetCell cell[LAYOUT_CELLS];
} SheetContent;

/* The page of the lecture and the guesses at its question. */
typedef struct LectureContent {
    const LecturePage *page; /* NULL outside of the lecture */
    bool hides_answer;       /* a guess is awaited before the answer is shown */
    const char *verdict;     /* verdict on the guess at this page, or NULL */
    int guesses, right;      /* guesses at all pages, and the right ones */
} LectureContent;

/* ---- all of it ----------------------------------------------------------- */

typedef struct FrameContent {
    int panes;  /* 1 ... LAYOUT_PANES */
    int active; /* index of the pane whose numbers the cards show */
    Pane pane[LAYOUT_PANES];
    const View *view;
    const struct Control *hand; /* what pulls in the active pane, or NULL */
    bool strain;                /* springs are coloured by strain */
    bool bare;                  /* the picture of the slide and nothing else */
    bool document;     /* the stage alone: a web page beside it has the rest */
    struct Text *text; /* measures a page's words; NULL: widths are guessed */
    double min_em;     /* pixels; 0: the usual minimum */
    Strip strip;
    SettingsRow settings;
    TimeLine time_line;
    ChipRow chips;
    Column column;
    CardSets cards;
    List list; /* for COLUMN_PAGES and the kinds after it */
    SheetContent sheet;
    LectureContent lecture;
} FrameContent;

/* Fills the contents with one pane that shows the simulation; the view fits the
 * scene. */
void frame_create(const Simulation *simulation, FrameContent *content);

/* The pane whose numbers the cards show. */
static inline const Pane *active_pane(const FrameContent *content)
{
    return &content->pane[content->active];
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
Layout layout_create(const FrameContent *content, int width, int height);

Camera camera_of_pane(const FrameContent *content, const Layout *layout,
                      int pane);

/* The part of the world that a pane shows now, to be held still. */
Held frame_hold_bounds(const FrameContent *content, const Layout *layout,
                       int pane);

/* What is at this pixel of the stage; PICK_NONE elsewhere. */
Pick frame_pick(const FrameContent *content, const Layout *layout, double x,
                double y);

/* The row of help or of the list of pages at this pixel; -1: none. */
int frame_find_row(const FrameContent *content, const Layout *layout, double x,
                   double y);

/* The step whose bar is under x; 0 ... bars. */
long frame_find_step(const FrameContent *content, const Layout *layout,
                     double x);

/* ---- what it knows ------------------------------------------------------ */

/* What the lecture adds, where the simulation's options name a page: topic and
 * cards that are hidden; what is in the column, there is code of pages alone;
 * the list of pages, in which the page that was left is marked where none is
 * open.  Before frame_describe. */
void frame_add_lecture(Column column, const struct LecturePage *left,
                       FrameContent *content);

/* Fills the values of all panes. */
void frame_fill_values(FrameContent *content);

/* The last thing before a frame: fills the values, and from those of the active
 * pane topic, sentence, method and state, as far as they are empty. */
void frame_describe(FrameContent *content);

/* The number that texts know by this name now; NaN: none. */
double frame_find_number(FrameContent *content, const char *name);

/* Whether E along p is drawn in a card of this scene or its page: each card is
 * open as at the start, but for those in `toggled`, bit c for card c. */
bool cards_need_line_energy(const Simulation *simulation, unsigned toggled);

/* What the history of this scene's picture shows of the state now.  row out;
 * returns how many. */
int picture_sample(const Simulation *simulation, Energy row[HISTORY_SERIES]);

#endif
