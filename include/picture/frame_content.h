/* frame_content.h - the contents of a frame in one struct, which is filled
 * before the frame is drawn; pictures and cards only read it.
 *
 * The same contents and size of the paper give the same pixels.  Pointers are
 * not owned; an element whose pointer is NULL is not drawn.  The smallest valid
 * contents are made by frame_create; view is never NULL.  Texts are in the
 * markup of text.h. */
#pragma once

#include "picture/layout.h"
#include "lesson/pages.h"
#include "simulation/simulation.h"
#include "scenes/small_scenes.h"

enum {
    SENTENCE_SIZE = 224, /* bytes of a sentence */
    ANSWER_SIZE = 1536,  /* bytes of the answer of a page */
    VALUE_SIZE = 32      /* bytes of a setting's value */
};

/* The present line of Algorithm 3. The work of this line and of all lines
 * before it is done: at LINE_SOLVE p is known, at LINE_SEARCH alpha. */
typedef enum AlgoLine {
    LINE_NONE,     /* between two steps; no line is lit */
    LINE_START,    /* 1  x^i <- x^n */
    LINE_DO,       /* 2  do */
    LINE_PROJECT,  /* 3  H^ <- SPDProjection(Hessian E(x^i)) */
    LINE_SOLVE,    /* 4  p <- -H^^-1 grad E(x^i) */
    LINE_SEARCH,   /* 5  alpha <- BackTrackingLineSearch(x^i, p) */
    LINE_UPDATE,   /* 6  x^i <- x^i + alpha p */
    LINE_TEST,     /* 7  while |p|/h > epsilon */
    LINE_END_STEP, /* 8  x^n+1 <- x^i, v^n+1 <- (x^n+1 - x^n)/h */
    LINE_COUNT
} AlgoLine;

/* The minimisation of a step, or a descent, up to the present line of the
 * algorithm.  The present update is known from LINE_PROJECT on. */
typedef struct NewtonTrace {
    AlgoLine at_line;           /* present line of Algorithm 3 */
    double h, tolerance;        /* time step (s), tolerance (m/s) */
    int record_count;           /* number of records */
    const NewtonRecord *record; /* [record_count] records of iterations */
    int iteration;              /* number of the present update, from 0 */
    const double *x;            /* [2n] m, present iterate x^i */
    const double *p;       /* [2n] direction p (m); NULL before LINE_SOLVE */
    double residual;       /* |p|/h, m/s; |g| in Algorithm 1 */
    bool has_failed;       /* the step has ended without convergence */
    double slope;          /* grad E . p (J s^2) */
    int projected_blocks;  /* number of projected blocks; < 0: unknown */
    const double *x_n;     /* [2n] x^n (m); or NULL */
    const double *x_tilde; /* [2n] x_tilde (m), drawn as a ghost; or NULL */
    EnergyFunction energy_difference; /* change of E along p; or NULL */
    const void *difference_data;      /* first argument of energy_difference */
    double first_alpha; /* first step length tried; 0 stands for 1 */
    int trials;         /* number of step lengths tried so far */
    bool is_accepted;   /* the last trial was accepted */
} NewtonTrace;

enum { MAX_LIVE_VALUES = 160, VALUES_MAX_RUNS = 3 };

/* A value that texts use by its name (live_values.h). */
typedef struct LiveValue {
    const char *name; /* name in texts: "residual" */
    int run;          /* run 1, 2 or 3 that has the value; 0: all runs */
    const char *text; /* words; NULL: the value is a number or a point */
    double value[2];  /* number, or coordinates of a point */
    bool is_point;    /* value is a point, written as "(1, 0.5)" */
} LiveValue;

/* The values of a pane. */
typedef struct LiveValues {
    int count;    /* number of values */
    int next_run; /* run of the values that are added next; 0: all runs */
    /* Colours of the text lines that begin with "#0" to "#3"; run r: "#r". */
    Colour text_line_colour[VALUES_MAX_RUNS + 1];
    LiveValue value[MAX_LIVE_VALUES];
} LiveValues;

/* ---- the stage ---------------------------------------------------------- */

enum { MAX_HISTORY_SERIES = 16, HISTORY_MAX_POINTS = 1024 };

/* Quantities over time, for plots. */
typedef struct History {
    int series_count;                     /* number of quantities */
    const char *name[MAX_HISTORY_SERIES]; /* in scenes of a square name[0] is
                                             the total */
    int point_count;                      /* number of points in time */
    double time[HISTORY_MAX_POINTS];      /* s, ascending */
    double value[MAX_HISTORY_SERIES][HISTORY_MAX_POINTS];
} History;

/* Appends a point in time, unless the history is full or a number is not
 * finite.  The values of a new quantity before this time are 0.  Quantities
 * beyond MAX_HISTORY_SERIES are left out.
 *   time  s, in: later than the last point
 *   row   [rows] in, value of each quantity */
void history_add_point(History *history, double time, int rows,
                       const Energy *row);

/* Trace of a descent's last update. */
typedef struct DescentTrace {
    NewtonTrace trace;
    const Simulation *simulation;
    double start[2], p[2]; /* m, start and direction of the update */
    double start_energy;   /* E at `start` (J s^2) */
} DescentTrace;

/* A simulation that the stage shows. */
typedef struct Pane {
    const Simulation *simulation;
    const double *x;         /* [2n] m, drawn positions; NULL: x of run 0 */
    const double *ghost_x;   /* [2n] m, outcome with other settings; or NULL */
    const char *ghost_label; /* settings of the ghost, "projection none: ..." */
    const History *history;  /* energies, radii, positions over time */
    const NewtonTrace *trace; /* trace of the time step, or NULL */
    const char *label;        /* differences from other panes, "h 0.01, k 5" */
    Status step_status;       /* OK, or why the shown or next step has failed */
    /* frame_compute_values fills values, descent and shown_trace. */
    LiveValues values;
    DescentTrace descent;
    const NewtonTrace *shown_trace; /* trace, or else descent.trace, or NULL */
} Pane;

/* Part of a picture that the mouse can find. */
typedef enum PickKind {
    PICK_NONE,
    PICK_NODE,     /* Pick.index: number of the node */
    PICK_SPRING,   /* Pick.index: number of the spring */
    PICK_OBSTACLE, /* Pick.index: obstacle number; grounds, then balls */
    PICK_EDGE,     /* Pick.index: 0 left, 1 right edge of the square */
    PICK_POINT,    /* a clickable point of a map or curve */
    PICK_HANDLE,   /* Pick.index: number of a handle, which can be dragged */
    PICK_SWITCH,   /* Pick.index: number of a switch of the scene */
    PICK_CELL      /* Pick.index: row * ENVELOPE_COLUMNS + column of a cell */
} PickKind;

typedef struct Pick {
    PickKind kind;
    int pane_index, index; /* number of the pane, number of the part */
    int nearest_node;      /* nearest node within 3/4 of a spacing; -1: none */
    double point[2];       /* m, position of the mouse in the world */
} Pick;

/* Bounds of a pane's view while the mouse drags a thing: the view stands still,
 * so that the thing stays under the mouse. */
typedef struct DragBounds {
    bool is_dragging;
    bool is_mouse_off_stage; /* the mouse is off the stage: the view may move */
    int pane_index;
    double bounds[4]; /* left, bottom, right, top (m) */
} DragBounds;

/* Zoom, pan, mouse and selection with which a frame is drawn. */
typedef struct FrameView {
    Lens lens;
    Pick hovered_part;   /* part of the picture under the mouse */
    WindowHit mouse_hit; /* part of the window under the mouse */
    DragBounds drag_bounds;
    int selected_cell; /* index of the selected cell of the overview */
} FrameView;

/* ---- around the stage --------------------------------------------------- */

/* Words of the title bar, which is above the stage. */
typedef struct TitleBar {
    const char *topic;            /* "Algorithm 3: projected Newton" */
    char sentence[SENTENCE_SIZE]; /* sentence about the present state */
    char method[SENTENCE_SIZE];   /* name of the method, "backward Euler" */
    char state[VALUE_SIZE];       /* "paused", "at rest"; "" while running */
    char message[SENTENCE_SIZE];  /* shown instead of the sentence; or "" */
    bool is_warning;              /* the message is a warning */
} TitleBar;

/* A number or a choice in the row of settings. */
typedef struct Setting {
    const char *name;       /* name of the option: "h", "stretch" */
    char value[VALUE_SIZE]; /* as shown: "0.02 s", "backward Euler" */
    int min_letters;        /* least width of the value, in letters */
    bool is_changed;        /* differs from the start of the run */
    bool is_off;            /* the method of the setting is switched off */
    bool is_selected;       /* selected by a click or by Tab */
} Setting;

typedef struct SettingsRow {
    int count; /* number of settings */
    Setting item[LAYOUT_MAX_SETTINGS];
} SettingsRow;

/* A step's bar in the time line; the height shows the number of updates. */
typedef struct StepBar {
    int updates; /* Newton updates of the step */
    bool is_unconverged;
} StepBar;

typedef struct TimeLine {
    long steps;      /* number of stored steps */
    long shown_step; /* the step on the stage, 0 ... steps */
    bool is_paused;  /* the run is paused */
    /* Returns the bar of a step 1 ... steps.  NULL: no bars are drawn. */
    StepBar (*get_bar)(const void *bar_data, long step);
    const void *bar_data;      /* first argument of get_bar */
    char label[SENTENCE_SIZE]; /* text at the handle: "step 12   t = 0.24 s" */
} TimeLine;

/* A key and what it does now. */
typedef struct Chip {
    char key[VALUE_SIZE], label[VALUE_SIZE]; /* "Space", "play" */
    bool is_highlighted; /* key to press next, or of an open part */
} Chip;

typedef struct ChipRow {
    int count; /* number of chips */
    Chip chip[LAYOUT_MAX_CHIPS];
} ChipRow;

/* Contents of the column: the cards, or instead a page's code or a list. */
typedef enum ColumnContent {
    COLUMN_CARDS,
    COLUMN_CODE,
    COLUMN_PAGES,
    COLUMN_LETTERS,
    COLUMN_KEYS,   /* list of keys, whose rows the application fills */
    COLUMN_OPTIONS /* list of options, whose rows the application fills */
} ColumnContent;

/* State of the cards.  Bit c of a set is the picture's card c. */
typedef struct CardSets {
    unsigned closed_cards;  /* cards of which only the title is drawn */
    unsigned hidden_cards;  /* cards that the picture or the page leaves out */
    unsigned covered_cards; /* cards that stay empty until a guess */
    int enlarged_card;      /* card that fills the column; -1: none */
} CardSets;

/* A row of a list: a key or a number, and what it does. */
typedef struct ListRow {
    char key[VALUE_SIZE], text[SENTENCE_SIZE];
    /* ROW_GREY: an option without effect now, or a page that lectures skip */
    enum { ROW_PLAIN, ROW_GREY, ROW_HEADING } style;
    int target_index; /* index of the page or option that a click opens; -1:
                         none */
} ListRow;

typedef struct ListContent {
    int row_count;
    ListRow row[LAYOUT_MAX_ROWS];
} ListContent;

/* A scene in the sheet, the overview of scenes. */
typedef struct SheetCell {
    const char *name;             /* name of the scene */
    const char *heading;          /* heading above the cell, or NULL */
    const Simulation *simulation; /* NULL: the scene is not ready yet */
} SheetCell;

/* The sheet, the overview of scenes; a sheet without cells is closed. */
typedef struct SheetContent {
    int cells; /* number of cells */
    SheetCell cell[LAYOUT_MAX_CELLS];
} SheetContent;

/* The page of the lecture and the guesses at its question. */
typedef struct LectureContent {
    const LecturePage *page; /* NULL outside of the lecture */
    bool hides_answer;       /* the page waits for the user's guess */
    const char *question; /* text of the question, unchanged after the answer;
                             NULL: this run asks none */
    const char *verdict;  /* verdict on the guess at this page, or NULL */
    int guesses, right_guesses;    /* numbers of guesses and of right guesses */
    char heading[SENTENCE_SIZE];   /* note that the answer is about the page's
                                      own options; "": they are unchanged */
    char answer_text[ANSWER_SIZE]; /* answer of the page, with live values */
} LectureContent;

/* ---- all of it ----------------------------------------------------------- */

/* The node or obstacle that the mouse or a script holds in the active pane. */
typedef struct HandGrip {
    bool is_held;     /* the hand holds a node or an obstacle */
    int node;         /* node that the hand pulls; -1: none */
    int obstacle;     /* obstacle that the hand pushes; -1: none */
    double target[2]; /* m, place to which the hand pulls or pushes */
} HandGrip;

typedef struct FrameContent {
    int panes;             /* number of panes, 1 ... LAYOUT_MAX_PANES */
    int active_pane_index; /* index of the pane whose numbers the cards show */
    Pane pane[LAYOUT_MAX_PANES];
    const FrameView *view;
    HandGrip hand;      /* node or obstacle that is held */
    bool shows_strain;  /* springs are coloured by strain */
    bool is_bare;       /* shows pictures without words */
    bool is_stage_only; /* shows the stage alone, as on the web page */
    bool has_document;  /* a web page shows switches, texts and cards */
    struct Font *fonts; /* fonts; NULL: widths of texts are estimated */
    double min_em;      /* pixels, least size of an em; 0: the usual minimum */
    TitleBar title_bar;
    SettingsRow settings;
    TimeLine time_line;
    ChipRow chips;
    ColumnContent column;
    CardSets cards;
    ListContent list; /* shown if `column` is not COLUMN_CARDS or COLUMN_CODE */
    SheetContent sheet;
    LectureContent lecture;
} FrameContent;

/* Fills the contents with one pane that shows all of the simulation. */
void frame_create(const Simulation *simulation, FrameContent *content);

/* Returns the pane whose numbers the cards show. */
static inline const Pane *active_pane(const FrameContent *content)
{
    return &content->pane[content->active_pane_index];
}

/* Returns the positions that a pane shows, [2n] m. */
const double *pane_get_positions(const Pane *pane);

/* Finds the bounding box of all finite nodes of run 0 to run `runs` - 1: left,
 * bottom, right, top, m. */
void find_node_bounds(const Pane *pane, int runs, double bounds[4]);

/* Counts the cells with a triangle that has turned over. */
int pane_count_folded_cells(const Pane *pane);

/* ---- where things are --------------------------------------------------- */

/* Places all parts of the window on a paper of this size in pixels, >= 1. */
Layout layout_create(const FrameContent *content, int width, int height);

/* Returns the camera of a pane. */
Camera make_pane_camera(const FrameContent *content, const Layout *layout,
                        int pane);

/* Returns the present bounds of a pane's view, for FrameView.drag_bounds. */
DragBounds frame_find_view_bounds(const FrameContent *content,
                                  const Layout *layout, int pane);

/* Finds the part of a picture at this pixel; PICK_NONE outside of the stage. */
Pick frame_find_pick(const FrameContent *content, const Layout *layout,
                     double x, double y);

/* Finds the row of the list at this pixel; -1: none. */
int frame_find_list_row(const FrameContent *content, const Layout *layout,
                        double x, double y);

/* Finds the step 0 ... steps that the time line has at pixel column x. */
long frame_pick_step(const FrameContent *content, const Layout *layout,
                     double x);

/* ---- live values --------------------------------------------------------- */

/* If the simulation shows a page of the lecture, adds the page's topic and the
 * cards that are covered before the guess.  If the column shows a list (of
 * pages, or of the formulas' letters), fills it.  Must come before
 * frame_expand_texts.
 *   column  in, contents that the user chose; COLUMN_CODE exists only on a page
 *   left    in, page that was last open, which the list marks; or NULL */
void frame_add_lecture(ColumnContent column, const struct LecturePage *left,
                       FrameContent *content);

/* Fills the values of all panes. */
void frame_compute_values(FrameContent *content);

/* Fills the values of all panes, then topic, sentence, method and state of the
 * active pane where they are empty.  Must come last before drawing. */
void frame_expand_texts(FrameContent *content);

/* Returns the live value with this name in the active pane; NaN: unknown. */
double frame_find_value(FrameContent *content, const char *name);

/* Whether an open card of the scene or page draws E along p.
 *   toggled  bit c: card c was opened or closed by hand */
bool cards_need_line_energy(const Simulation *simulation, unsigned toggled);
