/* Sessions: what hands do in the window, and what they see, as text.  One
 * driver puts each line in as the Input that a window would send.
 *
 *     begin LINE               a new player of this command line
 *     key K ...                "N", "Shift+N", "Return": the window's names
 *     type TEXT                a key for each letter
 *     press, move, release,    at a PLACE: X Y in pixels; +X +Y from where the
 *     right, wheel             mouse was; the number of the row with this name;
 *                              a step of the time line
 *     run N                    until the run has come to this step
 *     at N, newest N           the step that is shown, and the last one
 *     scene NAME, page N       page 0: none
 *     number NAME VALUE        what the row shows
 *     says WORDS               in the last line
 *     chip KEY LABEL           what a key does now, below the picture
 *     files N                  that were written
 *     replays LINE             Y's script leads to the same bits
 *     mark M [WHAT]            the picture without its message; or of it the
 *     same M [WHAT]            cards; or the hash of the state
 *     other M [WHAT]           none of the same pixels
 */
#include "attended.h"

#include <ctype.h>
#include <glob.h>

#include "picture/picture.h"
#include "scenes/pages.h"
#include "scenes/scene.h"
#include "scenes/state.h"

enum { SIDE = 900, MARKS = 16 };

static uint64_t marks[MARKS]; /* by letter */
static double mouse[2];       /* pixels */
static bool open_player;
static char folder[] = "/tmp/elasto-session-XXXXXX";

static Layout layout_now(void)
{
    const Canvas *canvas = &view_paper(player.view)->canvas;
    return show_layout(&player.show, canvas->width, canvas->height);
}

static uint64_t hash_box(const Canvas *canvas, Box box)
{
    uint64_t hash = STATE_HASH_SEED;
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++)
            hash = (hash ^ canvas->pixels[(long)y * canvas->width + x]) *
                   1099511628211u;
    return hash;
}

/* The picture without its message, or the cards of it; the state.  As a window
 * does it, nothing is drawn that has not changed. */
static uint64_t seen(const char *what)
{
    char note[sizeof player.note];
    if (strcmp(what, "state") == 0)
        return player_hash(&player);
    memcpy(note, player.note, sizeof note);
    player.note[0] = '\0';
    if (player.changed)
        CHECK_STATUS(player_draw(&player), STATUS_OK);
    memcpy(player.note, note, sizeof note);
    const Canvas *canvas = &view_paper(player.view)->canvas;
    return hash_box(canvas, strcmp(what, "cards") == 0
                                ? layout_now().column
                                : (Box){0, 0, canvas->width, canvas->height});
}

static void finish_session(void)
{
    if (open_player)
        end();
    open_player = false;
}

static void begin_session(const char *line)
{
    finish_session();
    begin_script("0 pause\n", line);
    open_player = true;
    mouse[0] = mouse[1] = -1;
    CHECK_STATUS(view_create_surface(SIDE, SIDE, &player.view), STATUS_OK);
    seen(""); /* a window shows the scene before anything is put in */
}

/* What makes no sense is only told. */
static void put(Input input)
{
    input.x = mouse[0];
    input.y = mouse[1];
    Status status = player_input(&player, &input);
    CHECK(!status || status == STATUS_INVALID_INPUT ||
          status_is_unconverged(status));
    if (status == STATUS_INVALID_INPUT)
        snprintf(player.note, sizeof player.note, "%.150s", player.message);
}

static void press_key(const char *name)
{
    Input input = {.kind = INPUT_KEY};
    snprintf(input.key, sizeof input.key, "%s", name);
    put(input);
}

/* As the window names the key of a letter. */
static void press_letter(char letter)
{
    char name[16];
    snprintf(name, sizeof name, "%s%c", isupper(letter) ? "Shift+" : "",
             toupper(letter));
    press_key(letter == ' ' ? "Space" : name);
}

static const Setting *number_shown(const char *name, int *place)
{
    player_fill(&player);
    for (int i = 0; i < player.show.settings; i++)
        if (strcmp(player.show.setting[i].name, name) == 0 ||
            strcmp(name, "first") == 0) {
            *place = i;
            return &player.show.setting[i];
        }
    fail_msg("the row has no %s", name);
    return NULL;
}

static void point_at(const char *place)
{
    double x, y;
    int i = 0;
    player_fill(&player);
    Layout layout = layout_now();
    if (sscanf(place, "%lf %lf", &x, &y) == 2) {
        bool relative = place[0] == '+' || place[0] == '-';
        mouse[0] = x + (relative ? mouse[0] : 0);
        mouse[1] = y + (relative ? mouse[1] : 0);
    } else if (strncmp(place, "step ", 5) == 0) {
        long step = atol(place + 5);
        mouse[0] = layout.bars.x;
        mouse[1] = layout.time.y + layout.time.height / 2;
        while (show_step_at(&player.show, &layout, mouse[0]) < step &&
               mouse[0] < layout.width)
            mouse[0]++;
    } else {
        number_shown(place, &i);
        mouse[0] = layout.setting[i].x + 2;
        mouse[1] = layout.setting[i].y + layout.setting[i].height / 2;
    }
}

static void use_mouse(const char *verb, const char *place)
{
    bool twice = strcmp(verb, "double") == 0;
    point_at(place);
    if (strcmp(verb, "move") == 0)
        put((Input){.kind = INPUT_MOVE});
    else if (strcmp(verb, "wheel") == 0)
        put((Input){.kind = INPUT_WHEEL, .amount = 1});
    else if (strcmp(verb, "right") == 0)
        put((Input){.kind = INPUT_PRESS, .button = BUTTON_RIGHT});
    else
        put((Input){.kind = verb[0] == 'r' ? INPUT_RELEASE : INPUT_PRESS,
                    .button = BUTTON_LEFT,
                    .clicks = twice ? 2 : 1});
}

static void run_until(long step)
{
    Command pause = {.kind = COMMAND_PAUSE};
    player.script.count = player.script.next; /* nothing else is due */
    CHECK_STATUS(script_add(&player.script, step, &pause), STATUS_OK);
    player_run(&player);
}

/* How many files there are; and without them. */
static int count_files(bool away)
{
    glob_t found;
    int count = glob("*", 0, NULL, &found) == 0 ? (int)found.gl_pathc : 0;
    for (int i = 0; i < count && away; i++)
        remove(found.gl_pathv[i]);
    globfree(&found);
    return count;
}

/* What Y writes leads a run without a window to the same bits. */
static void replay(const char *line)
{
    char script[65536] = "", paused[160];
    glob_t found;
    press_key("Y");
    assert_int_equal(glob("elasto_*.script", 0, NULL, &found), 0);
    FILE *file = fopen(found.gl_pathv[0], "r");
    assert_true(file && fread(script, 1, sizeof script - 1, file) > 0);
    fclose(file);
    globfree(&found);
    uint64_t hash = player_hash(&player);
    finish_session();
    snprintf(paused, sizeof paused, "%s --paused", line);
    begin_script(script, paused);
    open_player = true;
    player_run(&player); /* of some scenes steps do not converge */
    CHECK(player_hash(&player) == hash && !player.refused);
}

static void compare(const char *verb, const char *rest)
{
    const char *what = rest[1] ? rest + 2 : "";
    uint64_t now = seen(what), *mark = &marks[(rest[0] - 'a') % MARKS];
    if (strcmp(verb, "mark") == 0)
        *mark = now;
    else if ((now == *mark) != (strcmp(verb, "same") == 0))
        fail_msg("not the %s %s as at %s", verb, what, rest);
}

static void look_for_chip(const char *key, const char *label)
{
    player_fill(&player);
    for (int i = 0; i < player.show.chips; i++)
        if (strcmp(player.show.chip[i].key, key) == 0) {
            assert_string_equal(player.show.chip[i].label, label);
            return;
        }
    fail_msg("there is no chip %s", key);
}

static void look(const char *verb, const char *rest)
{
    const LecturePage *page = player_settings(&player)->page;
    char name[32], value[64];
    int i = 0;
    if (strcmp(verb, "at") == 0)
        assert_int_equal(player.past.step, atol(rest));
    else if (strcmp(verb, "newest") == 0)
        assert_int_equal(past_newest(&player.past), atol(rest));
    else if (strcmp(verb, "ended") == 0)
        assert_int_equal(player.quit, atol(rest));
    else if (strcmp(verb, "files") == 0)
        assert_int_equal(count_files(false), atol(rest));
    else if (strcmp(verb, "page") == 0)
        assert_int_equal(page ? page - lecture_pages + 1 : 0, atol(rest));
    else if (strcmp(verb, "scene") == 0)
        assert_string_equal(player_simulation(&player)->scene->name, rest);
    else if (strcmp(verb, "says") == 0 && !strstr(player.note, rest))
        fail_msg("it says '%s', not '%s'", player.note, rest);
    else if (strcmp(verb, "chip") == 0) {
        assert_int_equal(sscanf(rest, "%31s %63[^\n]", name, value), 2);
        look_for_chip(name, value);
    } else if (strcmp(verb, "number") == 0) {
        assert_int_equal(sscanf(rest, "%31s %63[^\n]", name, value), 2);
        assert_string_equal(number_shown(name, &i)->value, value);
    } else if (strcmp(verb, "says") != 0)
        compare(verb, rest);
}

static void session_line(const char *line)
{
    char verb[16] = "", rest[128] = "";
    sscanf(line, "%15s %127[^\n]", verb, rest);
    if (getenv("SHOW"))
        fprintf(stderr, "%s\n", line);
    if (strcmp(verb, "begin") == 0)
        begin_session(rest);
    else if (strcmp(verb, "key") == 0)
        for (char *word = strtok(rest, " "); word; word = strtok(NULL, " "))
            press_key(word);
    else if (strcmp(verb, "type") == 0)
        for (const char *letter = rest; *letter; letter++)
            press_letter(*letter);
    else if (strcmp(verb, "run") == 0)
        run_until(atol(rest));
    else if (strcmp(verb, "replays") == 0)
        replay(rest);
    else if (strstr("press double move release right wheel", verb))
        use_mouse(verb, rest);
    else
        look(verb, rest);
}

/* ---- sessions ----------------------------------------------------------- */

typedef struct Session {
    const char *name;
    const char *const *line;
} Session;

#define LINES(...)                                                             \
    (const char *const[])                                                      \
    {                                                                          \
        __VA_ARGS__, NULL                                                      \
    }

static const Session sessions[] = {
    {"a number is worked out",
     LINES("begin square --paused", "key Tab", "type 1/60", "key Return",
           "number h 0.0166667 s", "says 1/60 is read as 0.01667 s", /**/
           "key Tab", "type 0,02", "key Return", "number h 0.02 s",
           "says 0,02 is read as 0.02 s", /**/
           "key Tab", "type 4ms", "key Return", "number h 0.004 s",
           "says 4ms is read as 0.004 s", "number method backward Euler",
           "files 0",                                                  /**/
           "key Tab", "type 7e3 us", "key Return", "number h 0.007 s", /**/
           "key Tab Tab Tab", "type 120%", "key Return", "number stretch 1.2",
           /**/
           "key Tab", "type 0.03", "key Backspace", "type 2", "key Return",
           "number h 0.02 s", "at 0", "scene square")},
    {"what cannot be read is said, and the field stays open",
     LINES("begin square --paused", "mark a", "key Tab", "type -3",
           "key Return", "says --timestep: '-3' is not a number from 1e-30",
           "number h -3_", "key Backspace Backspace Backspace Backspace",
           "number h _", "key Return", "says --timestep: '' is not a number",
           "type 4 m", "key Return", "says '4 m' is not a number", /**/
           "key Escape", "number h 0.004 s", "same a",             /**/
           "key Tab", "type 1,000.5", "key Return", "says '1,000.5' is not",
           "key Escape", "same a", /**/
           "key Tab", "type 1/0", "key Return", "says '1/0' is not",
           "key Escape", "key Tab", "type 0x10", "key Return",
           "says '0x10' is not", "key Escape", "same a", /**/
           "key Tab", "type 1", "key \u00dc", "number h 1\u00dc_",
           "key Backspace", "number h 1_", "key Return", "number h 1 s")},
    {"Escape closes what is open, and twice the window",
     LINES("begin square --paused", "key Tab Tab", "type 5", "key Escape",
           "number k 100000 J/m\u00b2", "ended 0", "key Tab Escape Escape",
           "says Esc once more", "ended 0", "key Escape", "ended 1")},
    {"up to six are side by side, with one past",
     LINES("begin square --segments 3 --timestep 0.0005 --paused", "key N N",
           "key Tab+M Tab+M Tab+M Tab+M Tab+M",
           "number method implicit midpoint", "key Tab+M",
           "says no room for more", "mark a state", "key N N", "mark b state",
           "key Left Left", "same a state", "key Right Right", "same b state",
           "key Backspace Backspace Backspace Backspace",
           "key Backspace Backspace", "says there is only one", "key Ctrl+Z",
           "number method backward Euler")},
    {"a key says what it does",
     LINES("begin square --segments 2 --filter abs --paused", "chip I updates",
           "key I", "chip I lines", "key I", "chip I steps", "key I",
           "chip I updates", "chip P projection off", "key P",
           "number projection none", "chip P projection on", "key P",
           "number projection abs", "key K", "says Page Down", /**/
           "begin race --paused", "key N P", "at 0",
           "says from the start: projection none")},
    {"the title tells of other scenes",
     LINES("begin square --paused", "press 60 20",
           "says 1 ... 9 open other scenes")},
    {"a choice that is lit takes digits, too",
     LINES("begin square --paused", "key Tab Tab Tab Tab Tab Tab", "type 0.8",
           "key Return", "says --integrator: '0.8' is none of: backward-euler",
           "key Escape", "scene square", "number method backward Euler")},
    {"an open field lets no key through",
     LINES("begin square --paused", "key N N", "mark a", "key Tab",
           "type 1spqrnghybcm?2-+=0", "key Space Tab Up Down Left Right Home",
           "key End PageDown PageUp F1 F11 Ctrl+R Tab+M Shift+N Delete",
           "type 0123456789", "says there is room for", "key Escape", "same a",
           "files 0", "at 2")},
    {"P and L keep what was changed since the last step",
     LINES("begin square --paused", "key N N N N N N N N N N N N",
           "mark a state", "key Tab Tab Up", "number k 150000 J/m\u00b2",
           "key P", "number k 150000 J/m\u00b2", "at 12", "key P",
           "same a state", "number k 150000 J/m\u00b2", /**/
           "press h", "release +0 +0", "type 0.01", "key Return", "key L",
           "number h 0.01 s", "key M", "number method forward Euler", /**/
           "key M", "key P", "number method symplectic Euler", "at 12",
           "says nothing to project")},
    {"P keeps pins and the hand",
     LINES("begin square --segments 2 --stretch 1 --paused", "key N N",
           "right 524 634", "says pinned", "press 279 389", "move 279 380",
           "move 350 300", "key N", "mark a state", /**/
           "begin square --segments 2 --stretch 1 --paused", "key N N",
           "right 524 634", "press 279 389", "move 279 380", "move 350 300",
           "key P P N", "same a state", "key P P", "same a state",
           "release 350 300", "key P P", "same a state", "key N",
           "replays square --segments 2 --stretch 1")},
    {"a node that nobody holds any more is let go",
     LINES("begin square --segments 2 --stretch 1 --paused", "press 279 389",
           "move 279 380", "move 350 300", "key Left N", "release 350 300",
           "replays square --segments 2 --stretch 1")},
    {"a node that was held at an old step is not taken by a click elsewhere",
     LINES("begin square --segments 2 --stretch 1 --paused", "key N",
           "press 279 389", "move 279 380", "move 350 300", "key N N",
           "release 350 300", "key Left Left", "press 280 634", "move 280 640",
           "move 300 650", "key N N N", "mark a state",
           "replays square --segments 2 --stretch 1", /**/
           "begin square --segments 2 --stretch 1 --paused", "key N",
           "press 279 389", "move 279 380", "move 350 300", "release 350 300",
           "press 280 634", "move 280 640", "move 300 650", "key N N N",
           "same a state")},
    {"a click on the projection does what P does",
     LINES("begin square --paused --integrator forward-euler", "key N",
           "mark a state", "key P", "says nothing to project",
           "press projection", "release +0 +0", "says nothing to project",
           "same a state", "number projection clamp", "key Escape")},
    {"within a step a number takes the step again",
     LINES("begin square --paused", "key N N N I I N N N N N", "at 4",
           "mark a cards", "mark b state", "press h", "move +0 +0",
           "move +48 +0", "release +0 +0", "number h 0.00862 s", "at 4",
           "newest 4", "other a cards", "other b state", "says h 0.004: E",
           "type 7ms", "key Return I Home End I I Left Left Left",
           "mark a cards", "mark b state", /**/
           "begin square --paused", "key N N N", "key Tab", "type 7ms",
           "key Return N Home End I I Left Left Left", "same b state",
           "same a cards", /**/
           "begin square --paused", "key N N N Tab", "type 5ms",
           "key Return I I Left Left Tab", "type 7ms", "key Return",
           "number h 0.007 s")},
    {"after a step a number is for the next one",
     LINES("begin --lecture minimise --paused", "key N N N P", "mark a cards",
           "mark b state", "key Tab Up Up", "number h 0.007 s", "same a cards",
           "same b state", "key Escape", "press \u03b5", "release +0 +0",
           "type 1e-9", "key Return", "number \u03b5 1e-09 m/s", "same a cards",
           "same b state")},
    {"the time line keeps the cards",
     LINES("begin square --paused", "key N N N N N N N N N N", "key Left Left",
           "mark a cards", "key End", "press step 9", "move step 8",
           "same a cards", "release +0 +0", "at 8", "same a cards", "key End",
           "press step 8", "release +0 +0", "at 8", "same a cards")},
    {"cards come back after the drag of a large square's time line",
     LINES("begin square --segments 80 --paused", "key N N N", "key Left",
           "mark a cards", "key End", "press step 2", "move step 2",
           "other a cards", "release +0 +0", "at 2", "same a cards")},
    {"a change at an old step leaves the later ones to undo",
     LINES("begin square --segments 2 --stretch 1 --paused", "key N N N N N N",
           "mark a state", "key Home Right", "mark b state", "right 524 634",
           "says pinned; steps 2 ... 6: Ctrl+Z leads back", "newest 1",
           "key N N", "mark c state", "key Ctrl+Z", "says undone", "at 1",
           "newest 6", "same b state", "key End", "same a state",    /**/
           "key Ctrl+Shift+Z", "at 3", "same c state", "key Ctrl+Z", /**/
           "key Home", "press 279 389", "move 279 380", "move 350 300", "key N",
           "move 360 310", "key N", "release +0 +0", "key N", "newest 3",
           "key Ctrl+Z", "at 0", "newest 6", "key End", "same a state", /**/
           "key Home", "press h", "move +0 +0", "move +24 +0", "move +24 +0",
           "release +0 +0", "number h 0.00862 s", "key Ctrl+Z",
           "number h 0.004 s", "key Home", "wheel stretch", "wheel stretch",
           "newest 0", "key N Ctrl+Z", "newest 6", /**/
           "key Home M", "number method forward Euler", "key Ctrl+Z",
           "number method backward Euler", "key Tab+M N Ctrl+Z", "at 0",
           "newest 6", "key R N Ctrl+Z", "newest 6", "key Escape 7 N N",
           "scene hang", "key Ctrl+Z", "scene square", "at 0", "newest 6",
           "key End", "same a state",
           "replays square --segments 2 --stretch 1")},
    {"running on from an old step shows the known ones",
     LINES("begin square --segments 2 --paused", "key N N N", "right 524 634",
           "key N N N N", "mark a state", "key Home Space", "run 5", "at 5",
           "newest 7", "key Space", "run 7", "same a state", "key Space",
           "run 9", "at 9", "newest 9")},
    {"what was refused is not told again",
     LINES("begin square --segments 2 --paused", "key N N N Backspace",
           "says there is only one", "key Ctrl+Z", "says nothing is to be",
           "key N N N", "replays square --segments 2")},
    {"a scene leaves the lecture where it was",
     LINES("begin --lecture solid --paused", "key PageDown", "page 2", "key 1",
           "page 0", "scene square", "number stretch 1.4", "key PageUp",
           "page 2", "key 2", "key PageDown", "page 3", "key 1", "key G",
           "type 5", "key Return", "page 5")},
    {"in the list of pages digits choose the page",
     LINES("begin --lecture solid --paused", "mark a", "key G", "other a",
           "key G", "same a", "key G", "type 28", "page 1", "says page 28_",
           "key Return", "page 28", "key G", "type 2", "key Backspace",
           "type 99", "key Return",
           "says there is no page '99', they are 1 ... 32", "key Escape",
           "page 28", "mark a", "key Escape", "other a", "key 2",
           "scene circle")},
    {"a cell of the map leaves the lecture where it was",
     LINES("begin --lecture trust --paused", "key N", "press 300 500",
           "release +0 +0", "scene square", "page 0", "key Ctrl+Z", "page 32",
           "scene envelope", "press 300 500", "release +0 +0", "key PageUp",
           "page 32")},
    {"a double click gives the page's number back",
     LINES("begin --lecture explodes --paused", "number h 0.02 s", "key Tab",
           "type 1", "key Return", "number h 1 s", "double h",
           "number h 0.02 s")},
};
enum { SESSIONS = sizeof sessions / sizeof *sessions };

static const char *present; /* line of a session */

static void a_session(void **state)
{
    const Session *session = *state;
    for (const char *const *line = session->line; *line; line++)
        session_line(present = *line);
    present = NULL;
}

/* Says where a session has failed. */
static int end_session(void **unused)
{
    (void)unused;
    if (present)
        print_error("    at: %s\n", present);
    finish_session();
    count_files(true);
    present = NULL;
    return 0;
}

/* ---- a hand on every scene ---------------------------------------------- */

/* What is taken hold of where, and what makes sense there: g the hand pulls, d
 * a point is dragged, p pins, k there is a k, l lines of Algorithm 3, f the
 * projection, s the line search, m other methods. */
static const struct Scene_row {
    const char *scene;
    int x, y, dx, dy; /* pixels of a 900 x 900 window */
    const char *can;
} rows[] = {
    {"square", 280, 389, 60, -60, "gpklfsm"},
    {"circle", 438, 404, 40, -60, "g"},
    {"overshoot", 320, 466, 60, -30, "ds"},
    {"landscape", 293, 455, 60, -60, "dfs"},
    {"unprojected", 277, 388, 60, -60, "gpklfsm"},
    {"explosion", 257, 342, 60, -60, "gpklfsm"},
    {"hang", 277, 388, 60, -60, "gpklfsm"},
    {"drop", 212, 312, 60, 60, "gpklfs"},
    {"slope", 371, 105, 60, 20, "gpklfs"},
    {"squeeze", 277, 390, 60, 20, "gpklfs"},
    {"dent", 277, 250, 60, 60, "gpklfs"},
    {"tear", 180, 390, 60, 60, "gpklfs"},
    {"bend", 167, 350, 40, -60, "gpklfs"},
    {"arrows", 428, 404, 40, -60, "d"},
    {"tangent", 511, 97, -60, 0, "ds"},
    {"dial", 307, 358, 60, 60, "d"},
    {"spring", 377, 353, 40, 40, "dlfsm"},
};
enum { SCENES = sizeof rows / sizeof *rows };

/* A letter of `can` or a space, and '-' where the line is for scenes that lack
 * it; then the line.  START, HALF and WHOLE are places of the drag. */
static const char *const hand[] = {
    "  press START",
    "  move START",
    "  move HALF",
    "  move WHOLE",
    "  key N N",
    "  release WHOLE",
    "  key N",
    "  right HALF",
    "  key N",
    "  wheel first",
    "k wheel k",
    "  move 450 880",
    "  key N N",
    "  mark a",
    /* back and on */
    "  key Left",
    "  other a",
    "  key Right",
    "  same a",
    "  key Home",
    "  press step 1",
    "  release +0 +0",
    "  at 1",
    "  move 450 880",
    "  key End",
    "  same a",
    "  key ? ?",
    "  same a",
    "  key H",
    "  other a",
    "  key H",
    "  same a",
    "  key F1 F1",
    "  same a",
    /* switches do something where they make sense, else nothing */
    "f key P",
    "f other a",
    "f key P",
    "f-key P",
    "f-same a",
    "  mark a",
    "s key L",
    "s other a",
    "s key L",
    "s-key L",
    "s-same a",
    /* line by line, there and back */
    "  mark a",
    "l key I I N",
    "l mark b",
    "l key N",
    "l other b",
    "l mark c",
    "l key N",
    "l other c",
    "l key Left",
    "l same c",
    "l key I",
    "l-key I",
    "l-same a",
    /* six side by side, and one again */
    "  mark a",
    "m key Tab+M Tab+M Tab+M Tab+M Tab+M",
    "m other a",
    "m key Backspace Backspace Backspace Backspace Backspace",
    "m-key Tab+M",
    "m-same a",
    /* the wheel and 0 */
    "  key 0",
    "  mark a",
    "  wheel 60 660",
    "  other a",
    "  key 0",
    "  same a",
};

/* The line with this scene's places. */
static void fill_in(const char *pattern, const struct Scene_row *row,
                    char *line, size_t size)
{
    static const char *const words[] = {"START", "HALF", "WHOLE"};
    snprintf(line, size, "%s", pattern);
    for (int i = 0; i < 3; i++) {
        char *word = strstr(line, words[i]);
        if (word)
            snprintf(word, size - (size_t)(word - line), "%d %d",
                     row->x + i * row->dx / 2, row->y + i * row->dy / 2);
    }
}

static void a_hand_on_this_scene(void **state)
{
    static char line[128];
    const struct Scene_row *row = *state;
    snprintf(line, sizeof line, "begin %s --paused", row->scene);
    session_line(present = line);
    for (size_t i = 0; i < sizeof hand / sizeof *hand; i++) {
        bool can = hand[i][0] == ' ' || strchr(row->can, hand[i][0]);
        if (can == (hand[i][1] == '-'))
            continue;
        fill_in(hand[i] + 2, row, line, sizeof line);
        session_line(line);
    }
    replay(row->scene);
    present = NULL;
}

/* ---- random keys -------------------------------------------------------- */

/* The rest of the row, and what else is seen of the run. */
static uint64_t all_but(int place)
{
    uint64_t hash = seen("state") + (uint64_t)player.past.step;
    player_fill(&player);
    for (int i = 0; i < player.show.settings; i++)
        for (const char *c = player.show.setting[i].value; i != place && *c;
             c++)
            hash = (hash ^ (unsigned char)*c) * 1099511628211u;
    return hash;
}

/* Whatever is typed into an open field, only its own number changes; after
 * Escape not even that. */
static void random_keys_stay_in_their_field(void **unused)
{
    (void)unused;
    static const char *const others[] = {
        "Space",  "Tab",    "Up",        "Down",      "Left",   "Right",
        "Home",   "End",    "F1",        "F11",       "PageUp", "PageDown",
        "Delete", "Ctrl+R", "Tab+M",     "Shift+N",   "Ctrl+5", "Keypad 5",
        "Insert", "\u00dc", "Shift+Tab", "Backspace",
    };
    enum { OTHERS = sizeof others / sizeof *others, ROUNDS = 300 };
    Random random = {19};
    int set = 0, refused = 0;
    for (int round = 0; round < ROUNDS; round++) {
        if (round == 0 || set > 0) { /* a number that was set is no more */
            session_line("begin square --segments 2 --paused");
            session_line("key N N");
        }
        uint64_t before = seen("");
        int place = random_below(&random, player.show.settings);
        for (int i = 0; i <= place; i++)
            press_key("Tab");
        uint64_t rest = all_but(place);
        press_letter("0123456789.,+-"[random_below(&random, 14)]);
        for (int i = random_below(&random, 12); i > 0; i--)
            if (random_below(&random, 4) == 0)
                press_key(others[random_below(&random, OTHERS)]);
            else if (random_below(&random, 2) == 0)
                press_letter((char)(' ' + random_below(&random, 95)));
            else
                press_letter("0123456789.,e-/ms"[random_below(&random, 17)]);
        bool mesh = strcmp(player.show.setting[place].name, "segments") == 0;
        bool enter = !mesh && random_below(&random, 2) == 0;
        if (enter)
            press_key("Return");
        set = enter && player.selected < 0;
        refused += enter && !set;
        press_key("Escape");
        CHECK(player.selected < 0 && past_panes(&player.past) == 1 &&
              player_stands(&player));
        if (set && player.past.step == 2) /* else it begins again with it */
            CHECK(all_but(place) == rest);
        if (!set)
            CHECK(seen("") == before);
        assert_string_equal(player_simulation(&player)->scene->name, "square");
        assert_int_equal(count_files(false), 0);
    }
    CHECK(refused > ROUNDS / 10);
}

/* Whatever hands do, Y's script leads to the same bits, and none of its lines
 * is refused. */
static void random_hands_are_written_down(void **unused)
{
    (void)unused;
    static const char *const acts[] = {
        "key N",
        "key N N N",
        "key Left",
        "key Left Left",
        "key Right",
        "key Home",
        "key End",
        "key P",
        "key L",
        "key I",
        "key M",
        "key Tab Up",
        "key Down",
        "key Escape",
        "right 524 634",
        "right 279 389",
        "press 279 389",
        "move 279 380",
        "move 350 300",
        "release 350 300",
        "press 280 634",
        "move 300 650",
        "release 300 650",
        "wheel h",
        "wheel k",
        "press step 1",
        "press step 2",
        "release +0 +0",
        "key Tab+M",
        "key Backspace",
        "press projection",
        "press h",
        "move +30 +0",
    };
    enum { ACTS = sizeof acts / sizeof *acts, ROUNDS = 30, LENGTH = 40 };
    Random random = {21};
    for (int round = 0; round < ROUNDS; round++) {
        session_line("begin square --segments 2 --paused");
        for (int i = 0; i < LENGTH; i++) {
            session_line(present = acts[random_below(&random, ACTS)]);
            player.quit = false; /* by Escape */
        }
        replay("square --segments 2");
        count_files(true);
    }
    present = NULL;
}

int main(void)
{
    struct CMUnitTest tests[SESSIONS + SCENES + 2];
    char before[4096];
    int count = 0;
    assert_true(getcwd(before, sizeof before) && mkdtemp(folder));
    for (int i = 0; i < SESSIONS; i++)
        tests[count++] = (struct CMUnitTest){sessions[i].name, a_session, NULL,
                                             end_session, (void *)&sessions[i]};
    for (int i = 0; i < SCENES; i++)
        tests[count++] =
            (struct CMUnitTest){rows[i].scene, a_hand_on_this_scene, NULL,
                                end_session, (void *)&rows[i]};
    tests[count++] = (struct CMUnitTest)cmocka_unit_test_teardown(
        random_keys_stay_in_their_field, end_session);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test_teardown(
        random_hands_are_written_down, end_session);
    assert_int_equal(chdir(folder), 0);
    int failed = cmocka_run_group_tests_name("sessions", tests, NULL, NULL);
    assert_int_equal(chdir(before), 0);
    rmdir(folder);
    return failed;
}
