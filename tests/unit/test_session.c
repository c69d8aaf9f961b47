/* Sessions: what hands do in the window, and what they see, as text.  One
 * driver puts each line in as the Input that a window would send.
 *
 *     begin LINE               a new player of this command line
 *     key K ...                "N", "Shift+N", "Return": the window's names
 *     type TEXT                a key for each letter
 *     press, move, release,    at a PLACE: X Y in pixels; +X +Y from where the
 *     right, middle, wheel,    mouse was; m X,Y in metres; node N; the number
 *     shift (and press)        of the row with this name;
 *                              a step of the time line
 *     do COMMAND               as a script gives it
 *     run N, rest              until the run has come to this step, or stops
 *     go N                     so many steps of it
 *     at N, newest N           the step that is shown, and the last one
 *     stands 1, panes N        whether time stands still; side by side
 *     ghost 1                  the earlier outcome is shown, too
 *     line P N                 of Algorithm 3, that is lit in pane P; 0: none
 *     residual X               of the trace
 *     over WHAT N              under the mouse: node 12, obstacle 0, none 0
 *     card C SIZE              how a card is: closed, open, large
 *     label P WORDS            in the label of a pane; <nothing>
 *     state WORDS, time WORDS  beside the sentence, in the time line
 *     topic WORDS, sentence WORDS  about the scene
 *     speed S                  2^S steps a frame
 *     lit KEY 1                a chip
 *     scene NAME, page NAME, page N   page 0: none
 *     number NAME VALUE        what the row shows
 *     says WORDS               in the last line
 *     chip KEY LABEL           what a key does now, below the picture
 *     files N                  that were written
 *     asks                     as in a window: pages wait for a guess
 *     replays LINE             Y's script leads to the same bits
 *     tables LINE              `states` and `log` are those of this line's run
 *     row STEP TEXT            in the states, at the end
 *     mark M [WHAT]            the picture without its message; or of it the
 *     same M [WHAT]            cards; the hash of the state; the square's shape
 *     other M [WHAT]           none of the same pixels
 */
#include "attended.h"

#include <ctype.h>
#include <glob.h>

enum { SIDE = 900, MARKS = 16 };

static uint64_t marks[MARKS]; /* by letter */
static double mouse[2];       /* pixels */
static bool open_player;
static uint64_t started; /* hash of the beginning */
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

/* Where the nodes of the active pane are drawn. */
static uint64_t shape_shown(void)
{
    player_fill(&player);
    const Pane *pane = &player.show.pane[player.show.active];
    const unsigned char *byte = (const unsigned char *)pane_x(pane);
    size_t size = 2 * sizeof(double) * (size_t)pane->simulation->system.nodes;
    uint64_t hash = STATE_HASH_SEED;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ byte[i]) * 1099511628211u;
    return hash;
}

/* The picture without its message, or the cards of it; the state.  As a window
 * does it, nothing is drawn that has not changed. */
static uint64_t seen(const char *what)
{
    char note[sizeof player.note];
    if (strcmp(what, "state") == 0)
        return player_hash(&player);
    if (strcmp(what, "shape") == 0)
        return shape_shown();
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
    CHECK_STATUS(view_create(SIDE, SIDE, &player.view), STATUS_OK);
    seen(""); /* a window shows the scene before anything is put in */
}

/* What makes no sense is only told. */
static void tell(Status status)
{
    CHECK(!status || status == STATUS_INVALID_INPUT ||
          status_is_unconverged(status));
    if (status == STATUS_INVALID_INPUT)
        snprintf(player.note, sizeof player.note, "%.150s", player.message);
}

static void put(Input input)
{
    input.x = mouse[0];
    input.y = mouse[1];
    tell(player_input(&player, &input));
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
    double x, y, at[2];
    int i = 0;
    player_fill(&player);
    Layout layout = layout_now();
    if (sscanf(place, "%lf %lf", &x, &y) == 2) {
        bool relative = place[0] == '+' || place[0] == '-';
        mouse[0] = x + (relative ? mouse[0] : 0);
        mouse[1] = y + (relative ? mouse[1] : 0);
    } else if (sscanf(place, "m %lf,%lf", &at[0], &at[1]) == 2 ||
               sscanf(place, "node %d", &i) == 1) {
        const Pane *pane = &player.show.pane[0];
        Camera camera = show_camera(&player.show, &layout, 0);
        camera_pixel(&camera, place[0] == 'm' ? at : pane_x(pane) + 2 * i,
                     mouse);
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
    else if (strcmp(verb, "shift") == 0)
        put((Input){.kind = INPUT_PRESS, .button = BUTTON_BOX});
    else if (strcmp(verb, "right") == 0)
        put((Input){.kind = INPUT_PRESS, .button = BUTTON_RIGHT});
    else if (strcmp(verb, "middle") == 0)
        put((Input){.kind = INPUT_PRESS, .button = BUTTON_MIDDLE});
    else
        put((Input){.kind = verb[0] == 'r' ? INPUT_RELEASE : INPUT_PRESS,
                    .button = BUTTON_LEFT,
                    .clicks = twice ? 2 : 1});
}

static void run_until(long step)
{
    Command pause = {.kind = COMMAND_PAUSE};
    if (player_stands(&player))
        press_key("Space");
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
    remove(found.gl_pathv[0]); /* it may be asked again */
    globfree(&found);
    uint64_t hash = player_hash(&player);
    finish_session();
    snprintf(paused, sizeof paused, "%s --paused", line);
    begin_script(script, paused);
    open_player = true;
    player_run(&player); /* of some scenes steps do not converge */
    CHECK(player_hash(&player) == hash && !player.refused);
}

static void shell(const char *line)
{
    if (system(line) != 0)
        fail_msg("%s", line);
}

/* Column 12 of a log has seconds. */
static void check_tables(const char *line)
{
    char whole[160];
    finish_session();
    snprintf(whole, sizeof whole, "%s --states states2 --log log2", line);
    begin_script("0 play\n", whole);
    player_run(&player);
    end();
    shell("cmp states states2");
    shell("cut -d, -f1-11,13- log >log1; cut -d, -f1-11,13- log2 | cmp - log1");
}

/* A row of the states, "STEP,": its end. */
static void check_row(const char *words)
{
    char line[160];
    finish_session();
    snprintf(line, sizeof line, "grep -q -e '^%.*s,.*%s' states",
             (int)strcspn(words, " "), words, strchr(words, ' ') + 1);
    shell(line);
}

static void compare(const char *verb, const char *rest)
{
    uint64_t now = seen(rest[1] ? rest + 2 : ""),
             *mark = &marks[(rest[0] - 'a') % MARKS];
    if (strcmp(verb, "mark") == 0)
        *mark = now;
    else if ((now == *mark) != (strcmp(verb, "same") == 0))
        fail_msg("not %s: %s", verb, rest);
}

/* ---- what is seen -------------------------------------------------------- */

static char facts[1 << 14]; /* a line each: "at 3"; "says", a tab, the text */

static void fact(const char *format, ...)
{
    size_t used = strlen(facts);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(facts + used, sizeof facts - used - 1, format, arguments);
    va_end(arguments);
    strcat(facts, "\n");
}

static const char *text_or(const char *text)
{
    return text && text[0] ? text : "<nothing>";
}

/* Of a part of the window, the parts that it has several of. */
static void collect_parts(const Show *show)
{
    for (int p = 0; p < show->panes; p++) {
        const Trace *trace = show->pane[p].trace;
        fact("label %d\t%s", p, text_or(show->pane[p].label));
        fact("line %d %d", p, trace ? (int)trace->line : 0);
    }
    for (int i = 0; i < show->settings; i++)
        fact("number %s %s", show->setting[i].name, show->setting[i].value);
    for (int i = 0; i < show->chips; i++) {
        fact("chip %s %s", show->chip[i].key, show->chip[i].label);
        fact("lit %s %d", show->chip[i].key, show->chip[i].lit);
    }
    for (int c = 0; c < 8; c++)
        fact("card %d %s", c,
             show->closed >> c & 1 ? "closed"
             : show->large == c    ? "large"
                                   : "open");
}

/* All that is shown, but the pixels. */
static void collect_facts(void)
{
    static const char *const kinds[] = {"none",     "node",  "spring",
                                        "obstacle", "other", "other",
                                        "other",    "other", "other"};
    const Show *show = &player.show;
    const LecturePage *page = show->lecture;
    const Trace *trace = show->pane[show->active].trace;
    facts[0] = '\0';
    fact("at %ld", show->step);
    fact("newest %ld", past_newest(&player.past));
    fact("ended %d", player.quit);
    fact("files %d", count_files(false));
    fact("page %d", page ? (int)(page - lecture_pages) + 1 : 0);
    fact("page %s", page ? page->name : "none");
    fact("stands %d", show->paused);
    fact("panes %d", show->panes);
    fact("ghost %d", show->pane[show->active].ghost != NULL);
    fact("speed %d", player.speed);
    fact("scene %s", player_simulation(&player)->scene->name);
    fact("over %s %d", kinds[show->hover.kind], show->hover.index);
    fact("residual %.5g", trace ? trace->residual : -1);
    fact("says\t%s", text_or(player.note));
    fact("topic\t%s", text_or(show->topic));
    fact("state\t%s", text_or(show->state));
    fact("time\t%s", text_or(show->time_text));
    fact("sentence\t%s", text_or(show->sentence));
    collect_parts(show);
}

/* Whether this line is one of the facts, or some words of a text. */
static void look(const char *line)
{
    static char copy[sizeof facts];
    bool found = false;
    player_fill(&player);
    collect_facts();
    memcpy(copy, facts, sizeof copy);
    for (char *at = strtok(copy, "\n"); at && !found; at = strtok(NULL, "\n")) {
        size_t head = strcspn(at, "\t");
        found = at[head] ? strncmp(at, line, head) == 0 && line[head] == ' ' &&
                               strstr(at + head + 1, line + head + 1)
                         : strcmp(at, line) == 0;
    }
    if (!found)
        fail_msg("not '%s', but:\n%s", line, facts);
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
    else if (strcmp(verb, "do") == 0)
        tell(obey(rest));
    else if (strcmp(verb, "run") == 0)
        run_until(atol(rest));
    else if (strcmp(verb, "rest") == 0)
        run_until_it_pauses();
    else if (strcmp(verb, "go") == 0)
        for (long left = atol(rest); left > 0; left--)
            tell(player_step(&player));
    else if (strcmp(verb, "asks") == 0)
        player.asks = player.changed = true;
    else if (strcmp(verb, "replays") == 0)
        replay(rest);
    else if (strcmp(verb, "tables") == 0)
        check_tables(rest);
    else if (strcmp(verb, "row") == 0)
        check_row(rest);
    else if (strstr("press double move release right middle wheel shift", verb))
        use_mouse(verb, rest);
    else if (strstr("mark same other", verb))
        compare(verb, rest);
    else
        look(line);
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
           "number h 0.0166667 s", /**/
           "key Tab", "type 0,02", "key Return", "number h 0.02 s",
           "key Tab Tab Tab", "type 120%", "key Return", "number stretch 1.2",
           "files 0", /**/
           "key Tab", "type 0.03", "key Backspace", "type 2", "key Return",
           "number h 0.02 s", "at 0", "scene square")},
    {"what cannot be read is said, and the field stays open",
     LINES("begin square --paused", "mark a", "key Tab", "type -3",
           "key Return", "says --timestep: '-3' is not a number from 1e-30",
           "number h -3_", "key Backspace Backspace Backspace Backspace",
           "number h _", "key Return", "says --timestep: '' is not a number",
           "type 4 m", "key Return", "says '4 m' is not a number", /**/
           "key Escape", "number h 0.004 s", "same a",             /**/
           "key Tab", "type 1", "key \u00dc", "number h 1\u00dc_",
           "key Backspace", "number h 1_", "key Return", "number h 1 s")},
    {"Escape closes what is open, and twice the window",
     LINES("begin square --paused", "key Tab Tab", "type 5", "key Escape",
           "number k 100000 J/m\u00b2", "ended 0", "key Tab Escape Escape",
           "says Esc once more", "ended 0", "key Escape", "ended 1")},
    {"Escape leaves the black screen before what it hides",
     LINES("begin square --paused", "key Tab B Escape", "type 5", "key Escape",
           "scene square")},
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
           "begin race --paused", "key N P", "at 0", "number projection none")},
    {"the mouse tells what it can do",
     LINES("begin square --segments 2 --stretch 1 --paused", "press node 4",
           "release +0 +0", "says right click pins it", "right node 4",
           "press node 4", "release +0 +0", "says right click frees it",
           "key Left", "says this is step 0", "mark a", "key ?", "other a",
           "press 876 63", "release +0 +0", "same a", "press 60 20",
           "release +0 +0", "says elasto square: G shows all",
           "do place 3 0.1 0.123456789", "chip Ctrl+Z undo", "key Ctrl+Z",
           "says undone: place 3 0.1 0.123457")},
    {"a choice that is lit takes digits, too",
     LINES("begin square --paused", "key Tab Tab Tab Tab Tab Tab", "type 0.8",
           "key Return", "says --integrator: '0.8' is none of: backward-euler",
           "key Escape", "scene square", "number method backward Euler",
           "press method", "move +9 +0", "move +16 +0",
           "number method forward Euler", "move +24 +0",
           "number method symplectic Euler", "move -49 +0",
           "number method backward Euler", "release +0 +0")},
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
           "right 524 634", "says pinned", "do grab 4", "do drag 0.2 0.3",
           "key N", "mark a state", /**/
           "begin square --segments 2 --stretch 1 --paused", "key N N",
           "right 524 634", "do grab 4", "do drag 0.2 0.3", "key P P N",
           "same a state", "key P P", "same a state", "do release", "key P P",
           "same a state", "key N", "replays square --segments 2 --stretch 1")},
    {"a node that is placed stays where it is put, whatever comes next",
     LINES("begin hang --segments 4 --paused", "key N N", "mark a state",
           "press node 12", "move m 0.1,0", "move m 0.2,0.1", "release +0 +0",
           "move +1 +0", "over node 12", "other a state", "mark b state",
           "key P P", "same b state", "key N N Ctrl+Z", "key Ctrl+Z",
           "key Ctrl+Z", "same a state", "key Ctrl+Shift+Z", "same b state",
           "do place 99 0 0", "says place: there are 0 ... 24, no 99",
           "replays hang --segments 4")},
    {"nodes in a box are placed together",
     LINES("begin square --segments 4 --stretch 1 --cells on --paused", "key N",
           "mark a state", "shift m -0.55,-0.55", "move m 0,0",
           "move m 0.1,0.55", "release +0 +0", "says 15 nodes go together",
           "press node 6", "move m -0.3,-0.2", "move m -0.4,-0.2",
           "release +0 +0", "mark b state", "move m -0.15,-0.2", "over node 11",
           "key Ctrl+Z", "same a state", "key Ctrl+Shift+Z", "same b state",
           "press +0 +0", "move +20 +0", "mark b state", "move m 0.3,-0.2",
           "says no room", "release +0 +0", "same b state", "shift m 0.55,0.1",
           "release +0 +0", "do place 11 0.05 -0.2", "do place 6 -0.4 -0.2",
           "move m 0.05,-0.2", "over node 11", "key N N", "do box 1,2",
           "says two of its corners",
           "replays square --segments 4 --stretch 1 --cells on", /**/
           "begin landscape --paused", "do box 1,2,3,4", "says nothing to be")},
    {"a pin goes where it is dragged, and stays there",
     LINES("begin hang --segments 4 --paused", "key Space", "go 2",
           "press node 24", "move m 0.4,0.5", "move m 0.3,0.4", "go 90",
           "release +0 +0", "says node 24 is pinned", "move node 24",
           "move m 0.3,0.4", "over node 24", "key Space", "mark a state",
           "key Ctrl+Z", "newest 2", "key Ctrl+Shift+Z", "same a state",
           "replays hang --segments 4")},
    {"what is pulled stays under the mouse",
     LINES("begin square --segments 2 --stretch 1 --paused", "key Space",
           "press node 8", "move +150 +30", "go 60", "mark a state", /**/
           "begin square --segments 2 --stretch 1 --paused", "key Space",
           "press node 8", "move +150 +30", "go 30", "move +0 +0", "go 30",
           "same a state", /**/
           "begin square --integrator backward-euler,bdf2 --paused",
           "press 279 562", "move +10 +0", "key Backspace", "move +10 +0",
           "panes 1", "release +0 +0")},
    {"grounds and balls: put by a double click, moved, stopped by the square",
     LINES("begin hang --segments 8 --paused", "key N", "mark a state",
           "double m 0,-0.66", "says a ball", "move +1 +0", "over obstacle 0",
           "press m 0,-0.66", "move m 0.05,-0.66", "move m 0.3,-0.66",
           "release m 0.3,-0.66", "move +1 +0", "over obstacle 0",
           "press +0 +0", "move m 0.3,-0.64", "move m 0,0", "release +0 +0",
           "move +1 +0", "over node 40", "key N N N", "do set ball 0,0.1,0.2",
           "says it must be above 0", "key Ctrl+Z Ctrl+Z", "key Ctrl+Z",
           "same a state", "do set ground 0,1,0,-1", "do obstacle 0 0 -0.9",
           "do set friction 0.5", "key N N", "do obstacle 4 0 0",
           "says obstacle: there are 0 ... 0, no 4",
           "replays hang --segments 8")},
    {"what is undone during a drag ends it, in a script, too",
     LINES("begin square --segments 2 --paused", "press 279 389",
           "move 279 380", "do set gravity 9.81", "key Ctrl+Z", "move 470 800",
           "key Ctrl+Z", "mark a state", "key Ctrl+Z", "other a state",
           "key Ctrl+Shift+Z", "same a state", "replays square --segments 2")},
    {"a node that is let go by itself is undone by itself, in a script, too",
     LINES("begin square --segments 2 --paused", "key Space", "press 279 389",
           "move 279 380", "key End N M", "mark a state", "key Ctrl+Z Ctrl+Z",
           "key Ctrl+Z Ctrl+Shift+Z Ctrl+Shift+Z Ctrl+Shift+Z", "same a state",
           "replays square --segments 2")},
    {"neither a ball nor a ground is dragged into the square",
     LINES("begin square --stretch 1 --ball 0,-0.75,0.2 --ground 0,1,0,-1 "
           "--paused",
           "do add ball", "key Escape", "press m 0,-0.6", "move m 0.1,-0.6",
           "move m 0,0.3", "release +0 +0",
           "number ball 0.09375,-0.69375,0.2 m", "do add ground", "key Escape",
           "do obstacle 0 0 0", "number ground 0,1,0,-0.75",
           "do obstacle 0 0 0", "number ground 0,1,0,-0.5625", /**/
           "begin square --stretch 1 --ball 0.8,0.125,0.03 --paused",
           "do add ball", "key Escape", "do obstacle 0 0.3 0.125",
           "number ball 0.55,0.125,0.03 m", "do set ball 0.1,0.12,0.02",
           "says would be inside of a cell")},
    {"the row of numbers takes any that the scene has",
     LINES("begin square --segments 2 --paused", "key N", "key A", "type 2",
           "key Return", "says side: its length", "key Escape",
           "do add gravity", "says gravity: how strongly it pulls", "type 9,81",
           "key Return", "number gravity 9.81 m/s²", "at 1", "key N",
           "press first", "release +0 +0", "key P", "number gravity 9.81 m/s²",
           "do add friction", "says friction: there is nothing to touch",
           "do add ground", "type 0,1,0,-2", "key Return",
           "number ground 0,1,0,-2", "do add friction", "type 2000",
           "key Return", "says --friction: '2000' is not a number from 0",
           "key Escape", "do add yield", "type 0.1", "key Return", "at 0",
           "number yield 0.1", "key Ctrl+Z", "number yield none", "at 2",
           "replays square --segments 2")},
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
           "mark b state", "key Tab Up Up", "number h 0.02 s", "same a cards",
           "same b state", "key Escape", "press \u03b5", "release +0 +0",
           "type 1e-9", "key Return", "number \u03b5 1e-09 m/s", "same a cards",
           "same b state")},
    {"the time line keeps the cards",
     LINES("begin square --paused", "key N N N N N N N N N N", "key Left Left",
           "mark a cards", "key End", "press step 9", "move step 8",
           "same a cards", "release +0 +0", "at 8", "same a cards", "key End",
           "press step 8", "release +0 +0", "at 8", "same a cards")},
    {"the time line of a large square keeps the cards, too",
     LINES("begin square --segments 80 --paused", "key N N N", "key Left",
           "mark a cards", "key End", "press step 2", "move step 2",
           "same a cards", "release +0 +0", "at 2", "same a cards")},
    {"a change at an old step leaves the later ones to undo",
     LINES(
         "begin square --segments 2 --stretch 1 --paused", "key N N N N N N",
         "mark a state", "key Home Right", "mark b state", "right 524 634",
         "says pinned; steps 2 ... 6: Ctrl+Z leads back", "newest 1", "key N N",
         "mark c state", "chip Ctrl+Z undo", "key Ctrl+Z", "says undone: pin 6",
         "at 1", "newest 6", "same b state", "key End", "same a state", /**/
         "key Ctrl+Shift+Z", "at 3", "same c state", "key Ctrl+Z",      /**/
         "key Home", "press 279 389", "move 279 380", "move 350 300", "key N",
         "move 360 310", "key N", "release +0 +0", "key N", "newest 3",
         "key Ctrl+Z", "at 0", "newest 6", "key End", "same a state", /**/
         "key Home", "press h", "move +0 +0", "move +24 +0", "move +24 +0",
         "release +0 +0", "number h 0.00862 s", "key Ctrl+Z",
         "says undone: set timestep 0.00862", "number h 0.004 s", "key Home",
         "wheel stretch", "wheel stretch", "newest 0", "key N Ctrl+Z",
         "newest 6", /**/
         "key Home M", "number method forward Euler", "key Ctrl+Z",
         "number method backward Euler", "key Tab+M N Ctrl+Z", "at 0",
         "newest 6", "key R N Ctrl+Z", "newest 6", "key Escape 7 N N",
         "scene hang", "key Ctrl+Z", "scene square", "at 0", "newest 6",
         "key End", "same a state", "replays square --segments 2 --stretch 1")},
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
     LINES("begin --lecture solid --paused", "key PageDown", "page mesh",
           "key N 1", "page 0", "scene square", "number stretch 1.4",
           "key PageUp", "page mesh", "key N 2", "key PageDown",
           "page equation", "key N 1", "key Shift+G", "type 5", "key Return",
           "page 5")},
    {"a page asks before it tells: a number, or N, or a click",
     LINES("begin --lecture force --paused", "asks", "mark a", "type 23,8",
           "says your answer 23,8_", "key Return",
           "says 23.8: right, it is 23.805 (1 of 1 right", "other a", "at 0",
           "key PageDown PageUp", "type 24.4", "key Return",
           "says 24.4: no, it is 23.805 (1 of 2 right", "key PageDown PageUp",
           "type 95/4", "key Return",
           "says 95/4: right, it is 23.805 (2 of 3 right",
           "key PageDown PageUp", "type 2 Minus", "key Escape", "at 0", "key N",
           "at 0", "mark c", "key N", "other c", "at 0", "key PageDown PageUp",
           "key N 1", "scene square", "chip PgUp back to page 22", "key PageUp",
           "page force", "do page forward", "mark b", "key N", "other b",
           "at 0", "key N", "at 1", "do page parts", "mark b", "key N",
           "other b", "at 0", "do page tangent", "do predict 1 0", "key N",
           "at 1")},
    {"on a page that waits N and Space show the answer first, then they step",
     LINES("begin --lecture descent --paused", "asks", "mark a", "key N",
           "other a", "at 0", "key N", "at 1", "key PageDown PageUp", "at 0",
           "key Space", "at 0", "key N", "at 1")},
    {"on a page with a law N plays up to its picture, then Space goes on",
     LINES("begin --lecture friction --paused", "asks", "key N", "rest",
           "at 100", "stands 1", "key Space", "go 5", "at 105")},
    {"in the list of pages digits choose the page",
     LINES("begin --lecture solid --paused", "mark a", "key Shift+G", "other a",
           "key Shift+G", "same a", "key Shift+G", "type 28", "page 2",
           "says page 28_", "key Return", "page 28", "key Shift+G", "type 2",
           "key Backspace", "type 99", "key Return",
           "says there is no page '99', they are 1 ... ", "key Escape",
           "page 28", "mark a", "key Escape", "other a", "key N 2",
           "scene circle")},
    {"all scenes: arrows choose, Enter or a click opens, digits are a page's",
     LINES("begin tear --paused", "mark a", "key G", "other a", "topic All",
           "key P N R 7 Escape", "topic All", "key G", "same a", "key G",
           "key Right Return", "scene bend", "mark b", "key G Up Up Return",
           "scene explosion", "key Ctrl+Z", "same b", "key G", "type 12",
           "says page 12_", "key Return", "page 12", "key G", "press 200 150",
           "release +0 +0", "scene square", "page 0", "key G", "chip G back",
           "key PageDown", "page 13", "do sheet", "topic All", "key Shift+G",
           "type 2", "key Return", "page 2")},
    {"a pane that comes again is its neighbour's, not the one that went",
     LINES("begin square --segments 3,5 --paused", "do end-pane", "do add-pane",
           "do step", "at 1", "key Ctrl+Z", "key Ctrl+Z", "do step", "at 1")},
    {"a cell of the map leaves the lecture where it was",
     LINES("begin --lecture trust --paused", "key N", "press 300 500",
           "release +0 +0", "scene square", "page 0", "key Ctrl+Z",
           "page trust", "scene envelope", "press 300 500", "release +0 +0",
           "key PageUp", "page trust")},
    {"a double click gives the page's number back",
     LINES("begin --lecture explodes --paused", "number h 0.02 s", "key Tab",
           "type 1", "key Return", "number h 1 s", "double h",
           "number h 0.02 s")},
    /* through time, updates and lines */
    {"an update line by line",
     LINES("begin square --paused", "key I I N", "line 0 1", "mark a shape",
           "mark s state", "key N", "line 0 2", "same a shape", "key N",
           "line 0 3", "same a shape", "key N", "line 0 4", "same a shape",
           "key N", "line 0 5", "same a shape", "key N", "line 0 6",
           "other a shape", "mark b shape", "key N", "line 0 7", "same b shape",
           "key N", "line 0 2", "same b shape", "key Left Left", "line 0 6",
           "same b shape", "key Left", "line 0 5", "same a shape",
           "key Left Left Left", "line 0 2", "at 1", "same s state")},
    {"a step without updates has a residual",
     LINES("begin square --timestep 1000 --paused", "key N",
           "residual 0.00015171", "key Left I I N", "line 0 1", "residual 0",
           "key N N", "line 0 3", "residual 0", "key N", "line 0 4",
           "residual 0.00015171", "key N", "line 0 7", "key N", "line 0 8",
           "residual 0.00015171")},
    {"lines lead back into the step before",
     LINES("begin square --segments 2 --paused", "do step", "do step",
           "key I I Left", "at 2", "line 0 7",
           "key Left Left Left Left Left Left Left",
           "key Left Left Left Left Left Left Left", "at 2", "key Left", "at 1",
           "line 0 8", "key I", "line 0 0")},
    {"panes wait for each other",
     LINES("begin square --segments 3 --tolerance 0.5,1e-9 --paused", "key I N",
           "line 0 1", "line 1 1", "key N N N", "line 0 8", "line 1 7",
           "key N N N", "at 1", "key N", "at 2", "line 0 1", "line 1 1")},
    {"running leaves the lines",
     LINES("begin square --segments 2 --paused", "key I I N", "line 0 1",
           "stands 1", "do play", "line 0 0", "stands 0", "chip N next line",
           "key I", "chip N next step", "stands 1")},
    {"an explosion is shown where it is highest",
     LINES("begin explosion --paused", "at 0", "key N", "line 0 6",
           "says nodes are 1698 m away", "mark a shape", "key N", "line 0 0",
           "other a shape", "at 1")},
    {"either method tames it: the step is taken again, where it is",
     LINES("begin explosion --filter clamp --paused", "key N", "mark a state",
           "begin explosion --paused", "key N", "mark c state", "key P",
           "panes 1", "at 1", "newest 1", "line 0 0",
           "says no projection: E -13.8 in 34 updates",
           "says ; projection clamp: E -15.4 in 5 updates", "same a state",
           "ghost 1", "key Left N", "ghost 0", "key Ctrl+Z", "same c state",
           "key L", "panes 1", "says full step: E -13.8",
           "says ; line search backtrack: E +0 in 1 update, the search dir")},
    {"a switch tells both outcomes and takes the step again",
     LINES("begin square --stretch 0.6 --filter none --line-search none "
           "--paused",
           "key N N", "key P", "at 2", "says no projection: E ",
           "says ; projection clamp: E ", "begin square --stretch 0.6 --paused",
           "key N N L", "says line search backtrack: E ",
           "says ; full step: E ", "do play", "do projection", "at 2",
           "stands 0", "key I I N", "at 3", "key N N N N N N N N N N",
           "line 0 4", "key P", "at 3", "line 0 4", "stands 1")},
    {"a failure shows the last good state",
     LINES("begin square --integrator forward-euler --paused", "rest",
           "says beyond all numbers; shown is step 14, the last below ten",
           "at 14", "newest 23", "key Home", "at 0")},
    {"a pane that fails leaves the others alone",
     LINES("begin square --integrator forward-euler,symplectic-euler --paused",
           "run 60", "at 60", "label 0 ended at step 23", "time t = 0.24 s",
           "label 1 symplectic Euler", "do goto 2", "label 0 forward Euler",
           "do step", "at 3", "do goto 60", "label 0 ended at step 23")},
    {"cells of a pane that has ended do not explain the rest of others",
     LINES("begin square --integrator symplectic-euler,backward-euler "
           "--timestep 0.008 --paused",
           "rest", "says at rest: nothing moves")},
    /* rest */
    {"at rest it says so and stops",
     LINES("begin square --segments 2 --paused", "rest",
           "says at rest: nothing moves", "state at rest", "lit R 1",
           "lit Space 0", "do pin 8", "stands 0", "do pause", "rest",
           "state at rest", "do grab 0", "stands 0", "do drag 2 2", "do pause",
           "do step", "state paused", "do release", "rest", "state at rest",
           "do set stiffness 2e5", "stands 0", "do pause", "rest", "key R",
           "stands 0", "at 0", "do pause", "key R", "stands 1")},
    {"folded cells at rest are explained",
     LINES("begin square --segments 16 --paused", "rest", "state at rest",
           "says --cells on forbids it")},
    {"rest is that of all panes",
     LINES("begin square --segments 2 --tolerance 1e-6,10 --paused",
           "key Space", "go 5", "at 5", "state running", "stands 0")},
    {"a free square drifts and says so",
     LINES("begin square --segments 2 --velocity 3,4 --paused", "key Space",
           "go 600", "says drifts on at 5 m/s;", "state drifting", "stands 0",
           "do faster", "go 1", "says <nothing>", "state drifting", "do pin 4",
           "state running", "rest", "state at rest",
           "begin square --stretch 1 --velocity 3,4 --gravity 9.81 --paused",
           "key Space", "go 40", "state running", "says <nothing>")},
    {"the last page offers no next one",
     LINES("begin --lecture mesh --paused", "rest", "lit PgDn 1")},
    /* numbers, scenes and panes */
    {"changes are for one pane or all",
     LINES("begin square --segments 2 --timestep 0.01,0.005 --paused",
           "do set timestep 0.002", "do set stiffness 2e5", "number h 0.002 s",
           "number k 200000 J/m\u00b2", "do pane 1", "number h 0.005 s",
           "number k 200000 J/m\u00b2", "do set segments 3", "at 0", "stands 1",
           "number h 0.005 s", "number segments 3", "do pane 0",
           "number segments 3", "do pane 7",
           "says pane: there are 0 ... 1, no 7", "do play", "do set segments 2",
           "stands 0")},
    {"defaults are the scene's",
     LINES("begin square --timestep 0.003 --paused", "do set timestep 0.001",
           "do default timestep", "number h 0.003 s", "do scene hang",
           "do set timestep 0.003", "do default timestep", "number h 0.01 s",
           "do default pin", "says no such number")},
    {"scenes begin",
     LINES("begin square --segments 2 --tolerance 0.1 --speed 8 --paused",
           "speed 3", "rest", "do scene drop", "stands 0", "at 0", "speed 3",
           "do pause", "do scene hang", "stands 1", "do start 0.3 -0.2",
           "says no start to choose", "do scene landscape", "mark a state",
           "do start 0.3 -0.2", "other a state", "stands 1")},
    {"first speeds suit the scene",
     LINES("begin square", "speed 0", "begin square --speed 4", "speed 2",
           "begin overshoot", "speed -5", "begin overshoot --speed 1",
           "speed 0", "begin landscape", "speed -5",
           "begin square --speed 0.02", "speed -6", "begin circle", "speed 0",
           "key + + + + + + + + + + + +", "speed 10")},
    {"numbers are explained",
     LINES("begin square --segments 32 --paused", "do step",
           "number solver auto: newton", "move 1 1", "move solver",
           "sentence up to 32 segments", /**/
           "begin square --segments 33 --paused", "do step",
           "number solver auto: multigrid")},
    {"numbers follow the scene",
     LINES("begin dial --paused", "number h 0.005 s", "run 30",
           "number h 5 s")},
    {"a cell of the map is a scene, and undo leads back",
     LINES("begin envelope --segments 3 --stretch 1.3 --paused", "key N",
           "move 300 490", "press 300 500", "release +0 +0", "scene square",
           "stands 1", "at 0", "number segments 3", "number stretch 1.3",
           "key N", "mark a state",
           "replays envelope --segments 3 --stretch 1.3", /**/
           "begin envelope --segments 3 --stretch 1.3 --paused", "key N",
           "move 300 490", "press 300 500", "key Ctrl+Z", "scene envelope",
           "at 1", "ended 0", "number segments 3")},
    {"every pane is in the hash",
     LINES("begin square --timestep 0.004,0.002 --paused", "do step",
           "mark a state", "begin square --timestep 0.004,0.001 --paused",
           "do step", "other a state", "mark b state",
           "begin square --timestep 0.002,0.004 --paused", "do step",
           "other a state", "other b state")},
    /* tables */
    {"tables have what is shown, not what was undone",
     LINES("begin square --stretch 0.6 --paused --states states --log log",
           "key N N N", "mark a state", "key P", "other a state", "key Ctrl+Z",
           "same a state", "tables square --stretch 0.6 --steps 3")},
    {"tables begin anew with a run, and go on with it when it is undone",
     LINES("begin square --segments 2 --paused --states states --log log",
           "key N N N R N N", "tables square --segments 2 --steps 2",
           "begin square --segments 2 --paused --states states --log log",
           "key N N N R N Ctrl+Z N", "tables square --segments 2 --steps 4")},
    {"tables are made again for steps that were gone to",
     LINES("begin square --stretch 0.6 --paused --states states --log log",
           "key N N N N N N", "do goto 3", "do set stiffness 2e5", "key N N",
           "key Ctrl+Z", "do goto 5", "do next", "at 6",
           "tables square --stretch 0.6 --steps 6")},
    {"a node that is pinned stops in its row, and undone it does not",
     LINES("begin square --segments 2 --paused --states states --log log",
           "key N N", "do pin 3", "key N", "row 2 ,-0.47562491340079194,0,0",
           "begin square --segments 2 --paused --states states --log log",
           "key N N", "do pin 3", "key N", "key Ctrl+Z", "key N", "at 3",
           "tables square --segments 2 --steps 3",
           "begin arrows --paused --states states --log log", "key N N",
           "do handle 0 0.5 0.25", "key Ctrl+Z", "key N",
           "tables arrows --steps 3")},
    {"a row has the place where a point was dragged to",
     LINES("begin arrows --paused --states states --log log", "key N N",
           "do handle 0 0.5 0.25", "do handle 0 0.75 0.125", "key N",
           "row 2 ,0.75,0.125,", "begin arrows --paused --states states",
           "key N N N", "do goto 2", "do handle 0 0.5 0.25", "row 2 ,0.5,0.25,",
           "begin arrows --paused --states states", "do handle 0 0.5 0.25",
           "key N", "row 0 ,0.5,0.25,")},
    /* hands and the screen */
    {"hands pin and hold",
     LINES("begin square --segments 2 --paused", "do pin 3",
           "says node 3 is pinned", "do pin 3", "says node 3 is free",
           "do drag 1 1", "says the hand holds nothing", "do grab 0",
           "says paused: the hand pulls", "mark a state", "do step",
           "do drag 1 1", "do step", "mark b state", "do drag 1 2", "do step",
           "do release", "do goto 2", "do set stiffness 2e5", "do step",
           "do drag 1 1", "says the hand holds nothing", "do goto 99", "at 3")},
    {"a resting mouse asks nothing",
     LINES("begin square --paused", "move 279 389", "move 279 389",
           "over none 0", "move 280 389", "over node 12")},
    {"what is under the mouse stays there while the picture moves",
     LINES("begin square --integrator backward-euler,bdf2 --paused", "move 1 1",
           "move 279 212", "over node 12", "middle +0 +0", "move +1 -2",
           "move +30 -40", "release +0 +0", "move +1 +0", "over node 12",
           "press 310 170", "move +50 -20", "key N",
           "number method backward Euler", "release +0 +0",
           "begin square --integrator backward-euler,bdf2 --paused", "move 1 1",
           "move 279 562", "over node 12", "middle +0 +0", "move +40 +50",
           "release +0 +0", "move +1 +0", "over node 12", "press +0 +0",
           "number method BDF2")},
    {"where a key makes no sense it is said why",
     LINES(
         "begin circle --paused", "do pin 0", "says only nodes of a square",
         "do finer", "says has no finer ones", "do projection",
         "says nothing to project", "do add-pane", "says several runs are in",
         "begin overshoot --paused", "do finer", "says has no finer ones",
         "do add-pane", "says no time passes", "do method",
         "says no time passes", "begin landscape --paused", "do grab 0",
         "says nothing to take hold of", "begin drop --paused", "do add-pane",
         "says no other method knows all terms", "do method",
         "says no other method knows all terms", "begin dial --paused",
         "do projection", "says nothing to project", "do line-search",
         "says no line search", "begin race --paused", "do finer",
         "says has no finer ones", "do pin 3", "says only nodes of a square",
         "begin square --paused", "do drag 1 1", "says the hand holds nothing",
         "do end-pane", "says there is only one", "do pin 25",
         "says pin: there are 0 ... 24, no 25", "do flip 0",
         "says flip: none is here", "do set nothing 3",
         "says no option 'nothing'", "do set pin top", "says no option 'pin'",
         "do set timestep -1", "says '-1' is not a number", "do set start 1,2",
         "says has no start", "do handle 0 1 1", "says handle: none is here",
         "do cell 3", "says cell: none is here", "do page 99",
         "says no page '99'", "do predict 1 1", "says nothing to predict",
         "do scene nowhere", "says no scene 'nowhere'", "at 0", "newest 0")},
    {"what a list varies the panes say",
     LINES("begin square --gravity 1,9.81 --paused", "label 0 gravity 1",
           "label 1 gravity 9.81", "begin square --density 500,1000 --paused",
           "label 0 500", "label 1 1000", "begin square --turn 0,30 --paused",
           "label 0 turned by 0", "label 1 turned by 30",
           "begin square --cells on,off --paused", "label 0 on", "label 1 off",
           "begin drop --slip-speed 0.001,0.002 --paused", "label 1 0.002",
           "begin square --turn 0,30 --stiffness 1e4,1e5 --paused",
           "label 1 k 10000", "label 1 turned by 30", "label 2 k 100000")},
    {"the screen obeys",
     LINES("begin square --segments 2 --paused", "do card 1", "card 1 closed",
           "do enlarge 2", "card 2 large", "do card 1", "do enlarge 2",
           "card 1 open", "card 2 open", "do card 1", "do enlarge 1",
           "card 1 open", "card 5 closed", "do enlarge 5", "card 5 open",
           "do card 5", "do card 99", "says card: there are 0 ... ",
           "do card 1", "do enlarge 2", "key R", "card 1 closed",
           "card 2 large", "do scene drop", "card 1 open", "card 2 open")},
    {"the camera moves by metres",
     LINES("begin square --segments 2 --paused", "mark a", "do pan 0.1 0.2",
           "other a", "do pan -0.1 -0.2", "same a", "do zoom 200 0 0",
           "other a", "do fit", "same a")},
    {"pictures are kept, and show no message of before",
     LINES("begin square --segments 2 --paused", "do shot",
           "says saved elasto_square_000000.png", "do shot", "files 2",
           "says saved elasto_square_000000_2.png", "do hash",
           "says --script elasto_square_000000.script", "key N", "do hash",
           "says --script elasto_square_000001.script", "files 4")},
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
    "  move 450 20",
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
    "  move 450 20",
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
    enum { OTHERS = sizeof others / sizeof *others, ROUNDS = 150 };
    Random random = {19};
    int set = 0, refused = 0;
    for (int round = 0; round < ROUNDS; round++) {
        if (round == 0 || set > 0) { /* a number that was set is no more */
            session_line("begin square --segments 2 --paused");
            session_line("key N N");
        }
        uint64_t before = seen("");
        int place = random_below(&random, player.numbers);
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

static const char *const *const acts = LINES(
    "key N", "key N N N", "key Left", "key Left Left", "key Right", "key Home",
    "key End", "key P", "key L", "key I", "key M", "key Tab Up", "key Down",
    "key Escape", "right 524 634", "right 279 389", "press 279 389",
    "move 279 380", "move 350 300", "release 350 300", "press 280 634",
    "move 300 650", "release 300 650", "wheel h", "wheel k", "press step 1",
    "press step 2", "release +0 +0", "key Tab+M", "key Backspace",
    "press projection", "press h", "move +30 +0", "double 450 850",
    "press 450 850", "move 470 800", "key Ctrl+Z", "key Ctrl+Z Ctrl+Z",
    "key Ctrl+Shift+Z", "do place 3 0.3 0.2", "do set gravity 9.81",
    "do set damping 0.01", "do set yield 0.1", "do set barrier 0.02,1e5",
    "do set ground 0.1,1,0,-1", "do obstacle 0 0 -0.8",
    "do obstacle 1 0.1 -0.9", "key Space");

/* All that was done, undone and done again: the same bits. */
static void undo_and_redo(void)
{
    int back = 0;
    session_line("release 350 300");
    const uint64_t end = player_hash(&player);
    const long step = player.past.step;
    for (; player.past.now > 0; back++)
        press_key("Ctrl+Z");
    if (back == 0) /* nothing was done */
        return;
    press_key("Home");
    CHECK(player_hash(&player) == started);
    for (; back > 0; back--)
        press_key("Ctrl+Shift+Z");
    CHECK(player_hash(&player) == end && player.past.step == step);
}

/* Whatever hands do, Y's script leads to the same bits, and none of its lines
 * is refused. */
static void random_hands_are_written_down(void **unused)
{
    (void)unused;
    enum { ROUNDS = 30, LENGTH = 40 };
    Random random = {21};
    int count = 0;
    while (acts[count])
        count++;
    for (int round = 0; round < ROUNDS; round++) {
        session_line("begin square --segments 2 --paused");
        started = player_hash(&player);
        for (int i = 0; i < LENGTH; i++) {
            session_line(present = acts[random_below(&random, count)]);
            player.quit = false; /* by Escape */
        }
        undo_and_redo();
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
