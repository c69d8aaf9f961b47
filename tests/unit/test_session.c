/* test_session.c - plays tests/data/sessions.txt: a line becomes the Input that
 * a window would send, or checks what the window shows. */
#include "golden.h"
#include "letters.h"
#include "model/contact.h"
#include "oracle.h"
#include "picture/live_values.h"
#include "picture/picture.h"

#include <ctype.h>
#include <glob.h>
#include <limits.h>
#include <math.h>

enum { WINDOW_SIDE = 900, MAX_HASHES = 16, MAX_EDITS = 80, MAX_STEPS = 80 };

static uint64_t marked_hashes[MAX_HASHES]; /* hash at each mark, a to p */
static double mouse[2];                    /* position, pixels */
static bool player_is_open;
static double heap_at_start;        /* bytes, at the start of the session */
static double heap_before_player;   /* bytes, before the session's player */
static char start_folder[PATH_MAX]; /* working folder of the suite */
static char folder[] = "/tmp/elasto-session-XXXXXX";

/* What the window shows, as player_build_frame filled it */
static const FrameContent *const content = &player.screen.frame.content;

static Layout find_layout(void)
{
    const Canvas *canvas = &player_prepare_paper(&player)->canvas;
    return layout_create(content, canvas->width, canvas->height);
}

static uint64_t add_to_hash(uint64_t hash, const void *bytes, size_t size)
{
    for (const unsigned char *byte = bytes; size > 0; size--)
        hash = (hash ^ *byte++) * 1099511628211u;
    return hash;
}

static uint64_t hash_pixels(const Canvas *canvas, Box box)
{
    uint64_t hash = STATE_HASH_SEED;
    for (int y = box.y; y < box.y + box.height; y++)
        hash = add_to_hash(hash, &canvas->pixels[y * canvas->width + box.x],
                           (size_t)box.width * sizeof(Colour));
    return hash;
}

static uint64_t hash_positions(void)
{
    player_build_frame(&player);
    const Pane *pane = active_pane(content);
    const int nodes = pane->simulation->system.nodes;
    return add_to_hash(STATE_HASH_SEED, pane_get_positions(pane),
                       2 * sizeof(double) * (size_t)nodes);
}

/* Returns a hash of the "state", the "shape" (positions), the "cards", or else
 * of all pixels without the message. Pixels are redrawn only after a change. */
static uint64_t hash_by_name(const char *aspect)
{
    char note[sizeof player.note];
    if (strcmp(aspect, "state") == 0)
        return player_compute_hash(&player);
    if (strcmp(aspect, "shape") == 0)
        return hash_positions();
    memcpy(note, player.note, sizeof note);
    player.note[0] = '\0';
    if (player.screen.must_redraw)
        CHECK_STATUS(player_draw(&player), STATUS_OK);
    memcpy(player.note, note, sizeof note);
    const Canvas *canvas = &player_prepare_paper(&player)->canvas;
    const Box all = {0, 0, canvas->width, canvas->height};
    bool cards = strcmp(aspect, "cards") == 0;
    return hash_pixels(canvas, cards ? find_layout().column : all);
}

/* Texts of the last frame, a line each: of the window, and of its column */
static char window_text[1 << 16], column_text[1 << 15];
static Box column;
static struct {
    size_t offset;    /* offset in window_text */
    double x, y;      /* pixels, middle of the text's left end */
    double font_size; /* pixels, size of the font */
    Colour colour;
} texts[1024];
static int text_count;

int __real_text_draw(Font *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup);

int __wrap_text_draw(Font *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup)
{
    size_t used = strlen(window_text), more = strlen(column_text);
    texts[text_count].offset = used;
    texts[text_count].x = x;
    texts[text_count].y = y + 0.5 * style->size;
    texts[text_count].font_size = style->size;
    texts[text_count].colour = style->colour;
    text_count += text_count < 1023;
    snprintf(window_text + used, sizeof window_text - used, "%s\n", markup);
    if (box_contains(column, x, y)) /* a bold key and its meaning: one line */
        snprintf(column_text + more, sizeof column_text - more, "%s%s", markup,
                 style->face == FACE_BOLD ? " " : "\n");
    return __real_text_draw(text, canvas, style, x, y, align, markup);
}

static void collect_drawn_texts(void)
{
    window_text[0] = column_text[0] = '\0';
    text_count = 0;
    player_build_frame(&player);
    column = find_layout().column;
    CHECK_STATUS(player_draw(&player), STATUS_OK);
}

/* Checks that the window "reads" or "lacks" some words, or that its column
 * ("list") has them. A \ separates words of two texts in succession. */
static void check_window_words(const char *verb, char *words)
{
    const char *among = strcmp(verb, "list") == 0 ? column_text : window_text;
    bool wanted = strcmp(verb, "lacks") != 0;
    for (char *at = words; (at = strchr(at, '\\'));)
        *at = '\n';
    collect_drawn_texts();
    if ((strstr(among, words) != NULL) != wanted) {
        fputs(among, stderr); /* cmocka cuts long messages */
        fail_msg("%s '%s'", wanted ? "no" : "there is", words);
    }
}

static int find_text(const char *words)
{
    int nearest = -1;
    double distance = INFINITY;
    collect_drawn_texts();
    for (int i = 0; i < text_count; i++) {
        const char *text = window_text + texts[i].offset;
        const char *at = strstr(text, words);
        double away = hypot(texts[i].x - mouse[0], texts[i].y - mouse[1]);
        if (at && at < strchr(text, '\n') && away < distance) {
            distance = away;
            nearest = i;
        }
    }
    if (nearest < 0)
        fail_msg("no '%s':\n%s", words, window_text);
    return nearest;
}

/* Pixels per metre of the first pane before the last action of the mouse */
static double scale_before;

static double find_pane_scale(void)
{
    player_build_frame(&player);
    Layout layout = find_layout();
    return make_pane_camera(content, &layout, 0).scale[0];
}

static void close_player(void)
{
    static double lost; /* bytes left by all sessions; caches may keep 1e6 */
    if (player_is_open) {
        end_player();
        lost += count_heap_bytes() - heap_before_player;
        CHECK_AT_MOST(lost, 1e6);
    }
    player_is_open = false;
}

static void begin_session(const char *line)
{
    close_player();
    heap_before_player = count_heap_bytes();
    begin_scripted_player("0 pause\n", line);
    player_is_open = true;
    mouse[0] = mouse[1] = -1;
    player.screen.draws_frames = true;
    player.screen.paper_size[0] = player.screen.paper_size[1] = WINDOW_SIDE;
    CHECK_OK(player_draw(&player)); /* windows draw before any input */
    heap_at_start = count_heap_bytes();
    scale_before = find_pane_scale();
}

static void show_refusal(Status status)
{
    status = player_show_refusal(&player, status);
    CHECK(!status || status_is_unconverged(status));
}

static void send_input(Input input)
{
    input.x = mouse[0];
    input.y = mouse[1];
    show_refusal(player_obey_input(&player, &input));
}

static void press_key(const char *name)
{
    Input input = {.kind = INPUT_KEY};
    snprintf(input.key, sizeof input.key, "%s", name);
    send_input(input);
}

/* Presses the key that types a letter: "Shift+N" for N, "Space" for a blank. */
static void press_letter(char letter)
{
    char name[16];
    snprintf(name, sizeof name, "%s%c", isupper(letter) ? "Shift+" : "",
             toupper(letter));
    press_key(letter == ' ' ? "Space" : name);
}

static const Setting *find_setting(const char *name, int *place)
{
    player_build_frame(&player);
    for (int i = 0; i < content->settings.count; i++)
        if (strcmp(content->settings.item[i].name, name) == 0 ||
            strcmp(name, "first") == 0) {
            *place = i;
            return &content->settings.item[i];
        }
    fail_msg("the row has no %s", name);
    return NULL;
}

/* Moves the mouse to the middle of a box or its empty lower left corner. */
static void move_mouse_into(Box box, bool corner)
{
    mouse[0] = box.x + (corner ? 0.1 : 0.5) * box.width;
    mouse[1] = box.y + (corner ? 0.95 : 0.5) * box.height;
}

static bool is_on_grip(const Layout *layout, int grip)
{
    Pick pick = frame_find_pick(content, layout, mouse[0], mouse[1]);
    return pick.kind == PICK_HANDLE && pick.index == grip;
}

/* Moves the mouse to a place in a pane's picture; false: no such place. */
static bool move_mouse_in_pane(const char *place, const Layout *layout)
{
    const char *of = strstr(place, " of ");
    int i = 0, p = of ? atoi(of + 4) : 0;
    const Pane *pane = &content->pane[p];
    assert_true(p < content->panes);
    double at[2], grip[SCENE_MAX_HANDLES][2];
    if (sscanf(place, "grip %d", &i) == 1) {
        assert_true(i < exhibit_list_handles(pane->simulation, grip));
        memcpy(at, grip[i], sizeof at);
    } else if (sscanf(place, "node %d", &i) == 1)
        memcpy(at, pane_get_positions(pane) + 2 * i, sizeof at);
    else if (sscanf(place, "m %lf,%lf", &at[0], &at[1]) != 2)
        return false;
    Camera camera = make_pane_camera(content, layout, p);
    camera_to_pixel(&camera, at, mouse);
    /* A grip on a curve is listed on the axis: search from the top. */
    if (place[0] == 'g' && !is_on_grip(layout, i))
        for (mouse[1] = layout->pane[p].y; !is_on_grip(layout, i); mouse[1]++)
            assert_true(mouse[1] < layout->height);
    return true;
}

static int find_chip(const char *key)
{
    int i = content->chips.count - 1;
    while (i >= 0 && strcmp(content->chips.chip[i].key, key) != 0)
        i--;
    return i;
}

static int find_sheet_cell(const char *scene)
{
    int i = content->sheet.cells - 1;
    while (i >= 0 && strcmp(content->sheet.cell[i].name, scene) != 0)
        i--;
    return i;
}

static void move_mouse(const char *place)
{
    double x, y;
    int i = 0;
    player_build_frame(&player);
    Layout layout = find_layout();
    if (sscanf(place, "%lf %lf", &x, &y) == 2) {
        mouse[0] += x;
        mouse[1] += y;
    } else if (strncmp(place, "step ", 5) == 0) {
        long step = atol(place + 5);
        mouse[0] = layout.step_bars.x;
        mouse[1] = layout.time_line.y + layout.time_line.height / 2;
        while (frame_pick_step(content, &layout, mouse[0]) < step &&
               mouse[0] < layout.width)
            mouse[0]++;
    } else if (strncmp(place, "text ", 5) == 0) {
        i = find_text(place + 5);
        mouse[0] = texts[i].x + 2;
        mouse[1] = texts[i].y;
    } else if (strcmp(place, "strip") == 0) {
        move_mouse_into(layout.title_bar, false);
    } else if (strcmp(place, "time") == 0) {
        move_mouse_into(layout.time_line, false);
    } else if (strcmp(place, "stage") == 0) {
        move_mouse_into(layout.stage, true);
    } else if (strncmp(place, "chip ", 5) == 0) {
        assert_true((i = find_chip(place + 5)) >= 0);
        move_mouse_into(layout.chip[i], false);
    } else if (strncmp(place, "cell ", 5) == 0) {
        assert_true((i = find_sheet_cell(place + 5)) >= 0);
        move_mouse_into(layout.cell[i], false);
    } else if (!move_mouse_in_pane(place, &layout)) {
        find_setting(place, &i);
        mouse[0] = layout.setting[i].x + 2;
        mouse[1] = layout.setting[i].y + layout.setting[i].height / 2;
    }
}

/* Sends an action of the mouse. Returns false if no action has this verb. */
static bool send_mouse_action(const char *verb, const char *place)
{
    static const struct {
        const char *verb;
        Input input;
    } actions[] = {
        {"press", {.kind = INPUT_PRESS, .button = BUTTON_LEFT, .clicks = 1}},
        {"double", {.kind = INPUT_PRESS, .button = BUTTON_LEFT, .clicks = 2}},
        {"release", {.kind = INPUT_RELEASE, .button = BUTTON_LEFT}},
        {"right", {.kind = INPUT_PRESS, .button = BUTTON_RIGHT}},
        {"middle", {.kind = INPUT_PRESS, .button = BUTTON_MIDDLE}},
        {"move", {.kind = INPUT_MOVE}},
        {"wheel", {.kind = INPUT_WHEEL, .wheel_notches = 1}},
        {"wheel-out", {.kind = INPUT_WHEEL, .wheel_notches = -1}},
        {"leave", {.kind = INPUT_LEAVE}}};
    for (size_t i = 0; i < sizeof actions / sizeof *actions; i++)
        if (strcmp(actions[i].verb, verb) == 0) {
            move_mouse(place);
            scale_before = find_pane_scale();
            send_input(actions[i].input);
            return true;
        }
    return false;
}

static void resize_window(const char *size)
{
    int *now = player.screen.paper_size;
    CHECK(sscanf(size, "%d %d", &now[0], &now[1]) == 2);
    send_input((Input){.kind = INPUT_REDRAW});
    hash_by_name("");
}

static void run_until_step(long step)
{
    Command pause = {.kind = COMMAND_PAUSE};
    if (player_is_stopped(&player))
        show_refusal(obey_command("play"));
    player.setup.script.lines =
        player.setup.script.next_line; /* drops later lines */
    CHECK_STATUS(script_add(&player.setup.script, step, &pause, 0), STATUS_OK);
    player_run(&player);
}

/* Begins a step and stops within it, as in a window after a slow frame. */
static void stop_within_step(void)
{
    Past *past = &player.past;
    show_refusal(player_seek(&player, past->shown_step + 1, AFTER_NOTHING));
    while (!past->pane[0].is_in_substep)
        CHECK_STATUS(past_continue_work(past), STATUS_RUNNING);
}

/* Counts the files of the session's folder, and removes them if asked to. */
static int count_files(bool remove_them)
{
    glob_t found;
    int count = glob("*", 0, NULL, &found) == 0 ? (int)found.gl_pathc : 0;
    for (int i = 0; i < count && remove_them; i++)
        remove(found.gl_pathv[i]);
    globfree(&found);
    return count;
}

/* Checks that the saved script leads a run without window to the same bits. */
static void check_replay(const char *line)
{
    char script[65536] = "", paused[160];
    glob_t found;
    /* Not the command's key Y, which a selected number would take as text. */
    show_refusal(obey_command("hash"));
    assert_int_equal(glob("elasto_*.script", 0, NULL, &found), 0);
    FILE *file = fopen(found.gl_pathv[0], "r");
    assert_true(file && fread(script, 1, sizeof script - 1, file) > 0);
    fclose(file);
    remove(found.gl_pathv[0]); /* the next call finds only its own script */
    globfree(&found);
    uint64_t hash = player_compute_hash(&player);
    close_player();
    snprintf(paused, sizeof paused, "%s --paused", line);
    begin_scripted_player(script, paused);
    player_is_open = true;
    player_run(&player); /* status ignored: some steps do not converge */
    CHECK(player_compute_hash(&player) == hash &&
          !player.commands.has_refused_line);
}

/* Checks the rows of the last step in the file `states` against a new run. */
static void check_states_file(const char *line)
{
    char whole[160];
    close_player();
    snprintf(whole, sizeof whole, "%s --states states2", line);
    begin_scripted_player("0 play\n", whole);
    player_run(&player);
    end_player();
    CHECK(0 ==
          system("nodes=$(grep -c '^0,' states2); tail -n $nodes states >rows; "
                 "tail -n $nodes states2 | cmp - rows"));
}

static void check_hash_mark(const char *verb, const char *rest)
{
    uint64_t now = hash_by_name(rest[1] ? rest + 2 : ""),
             *mark = &marked_hashes[(rest[0] - 'a') % MAX_HASHES];
    if (strcmp(verb, "mark") == 0)
        *mark = now;
    else if ((now == *mark) != (strcmp(verb, "same") == 0))
        fail_msg("not %s: %s", verb, rest);
}

/* Compares the window without words with data/NAME.png; PICTURES=1: writes. */
static void check_picture(const char *name)
{
    char file[PATH_MAX + 64];
    Canvas frame[2];
    snprintf(file, sizeof file, "%s/tests/data/%s.png", start_folder, name);
    player_build_frame(&player);
    paint_frame_pair(frame);
    if (getenv("PICTURES"))
        CHECK_OK(png_file_write(file, NULL, &frame[0]));
    if (count_differing_pixels(file, frame) > 0)
        fail_msg("%s differs; if it should: make pictures", file);
}

/* ---- facts of the window ----------------------------------------------- */

static char facts[1 << 15]; /* lines such as "at 3" and "says\tTEXT" */

static void add_fact(const char *format, ...)
{
    size_t used = strlen(facts);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(facts + used, sizeof facts - used - 1, format, arguments);
    va_end(arguments);
    strcat(facts, "\n");
}

static const char *text_or_nothing(const char *text)
{
    return text && text[0] ? text : "<nothing>";
}

/* Returns true if the nodes of a pane lie in its box, and not in one dot. */
static bool pane_shows_all_nodes(const Layout *layout, int p)
{
    const Pane *pane = &content->pane[p];
    const Box *box = &layout->pane[p];
    Camera camera = make_pane_camera(content, layout, p);
    double at[2], first[2], far = 0;
    camera_to_pixel(&camera, pane_get_positions(pane), first);
    for (int i = 0; i < pane->simulation->system.nodes; i++) {
        camera_to_pixel(&camera, pane_get_positions(pane) + 2 * i, at);
        if (!box_contains(*box, at[0], at[1]))
            return false;
        far = fmax(far, hypot(at[0] - first[0], at[1] - first[1]));
    }
    return far > 0.05 * box->width;
}

static void add_widget_facts(void)
{
    Layout layout = find_layout();
    char order[512] = "";
    for (int p = 0; p < content->panes; p++) {
        const NewtonTrace *trace = content->pane[p].trace;
        add_fact("inside %d %d", p, pane_shows_all_nodes(&layout, p));
        add_fact("label %d\t%s", p, text_or_nothing(content->pane[p].label));
        add_fact("line %d %d", p, trace ? (int)trace->at_line : 0);
    }
    for (int i = 0; i < content->settings.count; i++) {
        const Setting *setting = &content->settings.item[i];
        add_fact("number %s %s", setting->name, setting->value);
        add_fact("changed %s %d", setting->name, setting->is_changed);
        append(order, sizeof order, "%s ", setting->name);
    }
    add_fact("order\t%s", order);
    for (int i = 0; i < content->chips.count; i++) {
        add_fact("chip %s %s", content->chips.chip[i].key,
                 content->chips.chip[i].label);
        add_fact("lit %s %d", content->chips.chip[i].key,
                 content->chips.chip[i].is_highlighted);
    }
    for (int c = 0; c < active_picture(content)->card_count; c++)
        add_fact("card %d %s", c,
                 content->cards.closed_cards >> c & 1 ? "closed"
                 : content->cards.enlarged_card == c  ? "large"
                                                      : "open");
}

static void collect_window_facts(void)
{
    static const char *const kinds[] = {"none",     "node",  "spring",
                                        "obstacle", "other", "other",
                                        "other",    "other", "other"};
    const LecturePage *page = content->lecture.page;
    const NewtonTrace *trace = content->pane[content->active_pane_index].trace;
    facts[0] = '\0';
    add_fact("at %ld", content->time_line.shown_step);
    add_fact("newest %ld", past_find_newest(&player.past));
    add_fact("ended %d", player.is_quitting);
    add_fact("files %d", count_files(false));
    add_fact("page %d", page ? (int)(page - lecture_pages) + 1 : 0);
    add_fact("page %s", page ? page->name : "none");
    add_fact("stands %d", content->time_line.is_paused);
    add_fact("panes %d", content->panes);
    add_fact("ghost %d",
             content->pane[content->active_pane_index].ghost_x != NULL);
    add_fact("speed %d", player.play.log_speed);
    add_fact("scene %s", player_get_simulation(&player)->scene->name);
    add_fact("over %s %d", kinds[content->view->hovered_part.kind],
             content->view->hovered_part.index);
    double scale = find_pane_scale();
    add_fact("scale %s", scale < scale_before   ? "smaller"
                         : scale > scale_before ? "larger"
                                                : "same");
    add_fact("residual %.5g", trace ? trace->residual : -1);
    const Newton *newton =
        content->pane[content->active_pane_index].simulation->run->newton;
    add_fact("solver\t%s %s",
             newton ? get_solver_name(newton->active_solver) : "none",
             newton && newton->refusal_reason ? newton->refusal_reason : "");
    add_fact("says\t%s", text_or_nothing(player.note));
    add_fact("topic\t%s", text_or_nothing(content->title_bar.topic));
    add_fact("state\t%s", text_or_nothing(content->title_bar.state));
    add_fact("time\t%s", text_or_nothing(content->time_line.label));
    add_fact("sentence\t%s", text_or_nothing(content->title_bar.sentence));
    add_fact("method\t%s", text_or_nothing(content->title_bar.method));
    add_widget_facts();
}

/* ---- counters of Newton's method ------------------------------------- */

static const struct {
    const char *name;
    size_t counter_offset;
} counters[] = {{"all updates", offsetof(NewtonCounters, updates)},
                {"all factors", offsetof(NewtonCounters, factorisations)},
                {"all solves", offsetof(NewtonCounters, linear_solves)},
                {"all cycles", offsetof(NewtonCounters, v_cycles)},
                {"all tile sweeps", offsetof(NewtonCounters, tile_sweeps)},
                {"handed over", offsetof(NewtonCounters, newton_takeovers)}};
enum { COUNTER_COUNT = sizeof counters / sizeof *counters };

static long get_work_counter(const Simulation *simulation, size_t i)
{
    const NewtonCounters sum = simulation_sum_newton_counters(simulation);
    return *(const long *)((const char *)&sum + counters[i].counter_offset);
}

/* ---- records ------------------------------------------------------------- */

static char record[1 << 20];         /* lines of a session and changed facts */
static char recorded_texts[1 << 17]; /* texts that were recorded last */

static void clear_record(void)
{
    record[0] = facts[0] = recorded_texts[0] = '\0';
}

static void add_changed_lines(const char *before, const char *now)
{
    for (size_t length; *now; now += length + (now[length] == '\n')) {
        char line[1024];
        size_t used = strlen(record);
        length = strcspn(now, "\n");
        snprintf(line, sizeof line, "%.*s\n", (int)length, now);
        if (!strstr(before, line))
            snprintf(record + used, sizeof record - used, "%s", line);
    }
}

/* Adds a session's line to the record, and the facts and values that changed,
 * except run times and the number of pages. On a page dots replace texts. */
static void add_changed_facts_to_record(const char *line)
{
    static char before[sizeof facts], head[160];
    const Simulation *simulation = player_get_simulation(&player);
    const Energies now = simulation_get_energies(simulation, 0);
    const bool must_redraw = player.screen.must_redraw;
    memcpy(before, facts, sizeof before);
    player_build_frame(&player);
    const LiveValues *values = &active_pane(content)->values;
    collect_window_facts();
    for (int i = 0; i < now.count; i++)
        add_fact("%s %.9g", now.energy[i].name, now.energy[i].value);
    if (content->lecture.page)
        for (char *at = facts; (at = strchr(at, '\t'));)
            memset(at, '.', strcspn(at, "\n"));
    for (size_t i = 0; i < COUNTER_COUNT; i++)
        add_fact("%s %ld", counters[i].name, get_work_counter(simulation, i));
    for (int i = 0; i < STATUS_COUNT; i++)
        if (simulation->status_counts[i] > 0)
            add_fact("steps with status %d: %d", i,
                     simulation->status_counts[i]);
    add_fact("values %d", values->count); /* shows lost values */
    add_fact(must_redraw ? "must be redrawn" : "stays as it is drawn");
    player.screen.must_redraw = false;
    for (int i = 0; i < values->count; i++) {
        const LiveValue *entry = &values->value[i];
        if (strstr(entry->name, "plicit") || !strcmp(entry->name, "pages"))
            continue; /* race's fastest methods depend on the clock */
        if (entry->text)
            add_fact("value %s %d: %s", entry->name, entry->run, entry->text);
        else
            add_fact("value %s %d: %.5g %.5g", entry->name, entry->run,
                     entry->value[0], entry->value[1]);
    }
    snprintf(head, sizeof head, "> %s\n", line);
    add_changed_lines("", head);
    add_changed_lines(before, facts);
}

/* Returns the name of the card in which a text stands, or "". */
static const char *find_card_name(const Layout *layout, double x, double y)
{
    for (int c = 0; c < layout->card_count; c++)
        if (box_contains(layout->card[c], x, y))
            return active_picture(content)->cards[c]->name;
    return "";
}

/* Writes the ink of a box: the sums over its pixels of 1 - red, 1 - green and
 * 1 - blue (0: white), and the ink's centre, pixels from the box's corner. */
static int write_ink_in_box(const Canvas *canvas, Box box, const char *name,
                            char *out)
{
    double ink[3] = {0}, at[2] = {0}, all = 0;
    for (int y = 0; y < box.height; y++)
        for (int x = 0; x < box.width; x++) {
            const long i = (long)canvas->width * (box.y + y) + box.x + x;
            for (int k = 0; k < 3; k++) {
                double lack = 1 - (canvas->pixels[i] >> 8 * k & 255) / 255.0;
                ink[k] += lack;
                at[0] += lack * x;
                at[1] += lack * y;
            }
        }
    all = fmax(ink[0] + ink[1] + ink[2], 1e-9);
    return sprintf(out, "%.1f %.1f %.1f %.1f %.1f | %s\n", ink[2], ink[1],
                   ink[0], at[0] / all, at[1] / all, name);
}

/* Writes how much is drawn besides words: in each of 25 parts of the picture,
 * and in each card. */
static int write_ink_table(const Layout *layout, char *out)
{
    enum { PARTS_PER_SIDE = 5 };
    Paper *paper = &player.screen.paper;
    Font *text = paper->font;
    const Box stage = layout->stage;
    char name[32], *at = out;
    paper->font = NULL;
    player_paint_frame(&player, paper);
    paper->font = text;
    for (int i = 0; !layout->cell_count && i < PARTS_PER_SIDE * PARTS_PER_SIDE;
         i++) {
        const int column = i % PARTS_PER_SIDE, row = i / PARTS_PER_SIDE;
        const int left = stage.width * column / PARTS_PER_SIDE;
        const int top = stage.height * row / PARTS_PER_SIDE;
        const Box part = {stage.x + left, stage.y + top,
                          stage.width * (column + 1) / PARTS_PER_SIDE - left,
                          stage.height * (row + 1) / PARTS_PER_SIDE - top};
        snprintf(name, sizeof name, "picture %d %d", column, row);
        at += write_ink_in_box(&paper->canvas, part, name, at);
    }
    for (int c = 0; c < layout->card_count; c++)
        at += write_ink_in_box(&paper->canvas, layout->card[c],
                               active_picture(content)->cards[c]->name, at);
    if (layout->has_list)
        at += write_ink_in_box(&paper->canvas, layout->column, "list", at);
    for (int i = 0; i < layout->cell_count; i++) /* race shows run times */
        if (strcmp(content->sheet.cell[i].name, "race") != 0)
            at += write_ink_in_box(&paper->canvas, layout->cell[i], "cell", at);
    player.screen.must_redraw = true;
    return (int)(at - out);
}

/* Writes what the mouse hits in each of 144 parts of the window: zone and
 * index, then kind and index of the scene's object or the list's row. */
static void write_mouse_hits(const Layout *layout, char *out)
{
    enum { COLUMNS = 16, ROWS = 9 };
    const Canvas *canvas = &player.screen.paper.canvas;
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        const double x = canvas->width * (i % COLUMNS + 0.5) / COLUMNS;
        const double y = canvas->height * (i / COLUMNS + 0.5) / ROWS;
        const WindowHit hit = layout_find_hit(layout, x, y);
        const Pick pick = frame_find_pick(content, layout, x, y);
        const int row = frame_find_list_row(content, layout, x, y);
        out += sprintf(out, i % COLUMNS ? " " : "| hits %d: ", i / COLUMNS);
        out += sprintf(out, "%c%d", 'a' + hit.zone, hit.index);
        if (pick.kind != PICK_NONE || row >= 0)
            out += sprintf(out, "%c%d", 'a' + pick.kind,
                           row < 0 ? pick.index : row);
        out += sprintf(out, i % COLUMNS == COLUMNS - 1 ? "\n" : "");
    }
}

/* Adds the shapes and texts of the window that are new to the record: places,
 * sizes, colours and words. On a page texts of cards have no place, and the
 * text of the page itself is left out. */
static void add_window_to_record(const char *unused)
{
    static char before[sizeof recorded_texts];
    char *now = recorded_texts;
    int count = 0;
    (void)unused;
    collect_drawn_texts();
    const Layout layout = find_layout();
    memcpy(before, now, sizeof before);
    for (int i = 0; i < text_count; i++) {
        const char *text = window_text + texts[i].offset;
        const double x = texts[i].x, y = texts[i].y;
        const char *card = find_card_name(&layout, x, y);
        const Colour colour = texts[i].colour & 0xffffff;
        const int length = (int)strcspn(text, "\n");
        const Box *places = layout.has_list ? &layout.column : &layout.stage;
        if (content->lecture.page && !box_contains(layout.stage, x, y) &&
            !box_contains(*places, x, y)) {
            if (!card[0] || strcmp(card, "page") == 0)
                continue;
            now += sprintf(now, "%.0f %s", texts[i].font_size, card);
        } else
            now += sprintf(now, "%.1f %.1f %.0f", x, y, texts[i].font_size);
        now += sprintf(now, " | %06x %.*s\n", colour, length, text);
        count++;
    }
    now += sprintf(now, "%d | texts\n", count);
    now += write_ink_table(&layout, now);
    write_mouse_hits(&layout, now);
    add_changed_lines(before, recorded_texts);
}

/* Adds a file to the record; the log, named "l", without its run times. */
static void add_file_to_record(const char *name)
{
    char line[1024];
    close_player();
    FILE *file = fopen(name, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        char *seconds = line, *next;
        for (int commas = 0; *seconds && (commas += *seconds == ',') < 11;)
            seconds++;
        if (strcmp(name, "l") == 0 && (next = strchr(seconds + 1, ',')))
            memmove(seconds, next, strlen(next) + 1);
        add_changed_lines("", line);
    }
    fclose(file);
}

/* Returns true if a line equals that of a record. Numbers at its start may
 * differ a little, as the mathematics of compilers and processors do. */
static bool lines_nearly_same(const char *was, const char *is)
{
    double a, b;
    int from[2] = {0};
    for (;; was += from[0], is += from[1])
        if (sscanf(was, "%lf%n", &a, &from[0]) != 1 ||
            sscanf(is, "%lf%n", &b, &from[1]) != 1)
            return strcmp(was, is) == 0;
        else if (fabs(a - b) > 0.15)
            return false;
}

/* Compares the record with data/records/NAME.txt; PICTURES=1 writes it. */
static void compare_with_record(const char *name)
{
    char path[PATH_MAX + 64], was[1024];
    snprintf(path, sizeof path, "%s/tests/data/records/%s.txt", start_folder,
             name);
    FILE *file = fopen(path, getenv("PICTURES") ? "w+" : "r");
    assert_non_null(file);
    if (getenv("PICTURES"))
        CHECK(fputs(record, file) >= 0 && fseek(file, 0, SEEK_SET) == 0);
    for (char *is = strtok(record, "\n"); is; is = strtok(NULL, "\n")) {
        if (!fgets(was, sizeof was, file))
            was[0] = '\0';
        was[strcspn(was, "\n")] = '\0';
        if (!lines_nearly_same(was, is))
            fail_msg("%s: '%s' is now '%s'; if it should: "
                     "PICTURES=1 build/release/tests/unit/test_session '%s'",
                     path, was, is, "record*");
    }
    CHECK(!fgets(was, sizeof was, file));
    fclose(file);
}

/* Checks that a line is one of the facts, or has some words of its text. */
static void check_fact(const char *line)
{
    static char copy[sizeof facts];
    bool found = false;
    player_build_frame(&player);
    collect_window_facts();
    memcpy(copy, facts, sizeof copy);
    for (char *at = strtok(copy, "\n"); at && !found; at = strtok(NULL, "\n")) {
        size_t head = strcspn(at, "\t");
        found = at[head] ? strncmp(at, line, head) == 0 && line[head] == ' ' &&
                               strstr(at + head + 1, line + head + 1)
                         : strcmp(at, line) == 0;
    }
    if (!found) {
        fputs(facts, stderr);
        fail_msg("not '%s'", line);
    }
}

/* ---- numbers ------------------------------------------------------------- */

/* Returns the records of a descent, else of the last step, and their number. */
static int get_newton_records(const Simulation *simulation,
                              const NewtonRecord **row)
{
    const NewtonRecords *made =
        &player.past.pane[content->active_pane_index].newton_records;
    bool descends = simulation->scene->step == step_descent;
    *row = descends ? simulation->descent.record : made->record;
    return descends ? simulation->descent.record_count : made->count;
}

static double count_newton_records(const Simulation *simulation)
{
    const NewtonRecord *row;
    return get_newton_records(simulation, &row);
}

static double count_energy_rises(const Simulation *simulation)
{
    const NewtonRecord *row;
    int rises = 0;
    for (int i = get_newton_records(simulation, &row) - 1; i >= 0; i--)
        rises += !(row[i].energy_change < 0 && row[i].slope < 0);
    return rises;
}

static double find_energy_rise(const Simulation *simulation, int updates)
{
    const NewtonRecord *row;
    double E = 0;
    int count = get_newton_records(simulation, &row);
    for (int i = 0; i < updates && i < count; i++)
        E += row[i].energy_change;
    return E;
}

static double find_highest_energy_rise(const Simulation *simulation)
{
    double highest = 0;
    for (int i = (int)count_newton_records(simulation); i > 0; i--)
        highest = fmax(highest, find_energy_rise(simulation, i));
    return highest;
}

static double sum_masses(const Simulation *simulation)
{
    double sum = 0;
    for (int i = 0; i < simulation->system.nodes; i++)
        sum += simulation->system.m[i];
    return sum;
}

static double find_lowest_height(const Simulation *simulation)
{
    double low = INFINITY;
    for (int i = 0; i < simulation->system.nodes; i++)
        low = fmin(low, simulation->run[0].x[2 * i + 1]);
    return low;
}

static double find_highest_height(const Simulation *simulation)
{
    double high = -INFINITY;
    for (int i = 0; i < simulation->mesh.nodes / simulation->mesh.bodies; i++)
        high = fmax(high, simulation->run[0].x[2 * i + 1]);
    return high;
}

static double find_distance_from_rest(const Simulation *simulation)
{
    const double *x = simulation->run[0].x, *rest = get_rest_x(simulation);
    double most = 0;
    for (int i = 0; i < 2 * simulation->mesh.nodes; i += 2)
        most = fmax(most, hypot(x[i] - rest[i], x[i + 1] - rest[i + 1]));
    return most;
}

static double find_mean_vy(const Simulation *simulation)
{
    double sum = 0;
    for (int i = 0; i < simulation->system.nodes; i++)
        sum += simulation->system.m[i] * simulation->run[0].v[2 * i + 1];
    return sum / sum_masses(simulation);
}

/* Counts the triangles that are turned over; a cell of springs has four. */
static double count_turned_triangles(const Simulation *simulation)
{
    int turned = 0, node[3], side[3];
    const double *x = simulation->run[0].x;
    for (int t = 0; t < 4 * simulation->mesh.cells; t++) {
        square_mesh_get_triangle(&simulation->mesh, t, node, side);
        const double *a = x + 2 * node[0], *b = x + 2 * node[1];
        const double *c = x + 2 * node[2];
        turned += !(
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0);
    }
    return turned;
}

static double count_edge_crossings(const Simulation *simulation)
{
    return (double)edge_crossings(&simulation->system, simulation->run[0].x);
}

static double find_smallest_area_ratio(const Simulation *simulation)
{
    return smallest_area_ratio(&simulation->system, simulation->run[0].x);
}

static double find_gained_energy(const Simulation *simulation)
{
    return simulation->ledger[0].gained_energy;
}

static double count_steps_with_energy_gain(const Simulation *simulation)
{
    return (double)simulation->ledger[0].gain_steps;
}

static double find_energy_minus_work(const Simulation *simulation)
{
    Energies ledger = simulation_get_energies(simulation, 0);
    return ledger.total - ledger.work;
}

static double find_wall_height(const Simulation *simulation)
{
    return get_contact(&simulation->system)->obstacle[0].o[1];
}

static double find_hand_node_distance(const Simulation *simulation)
{
    const UserControl *control = past_get_control(&player.past, 0);
    const double *x = simulation->run[0].x + 2 * control->held_node;
    return hypot(x[0] - control->target[0], x[1] - control->target[1]);
}

static double find_held_node_motion(const Simulation *simulation)
{
    const TimeIntegrator *run = &simulation->run[0];
    const double *v = run->v + 2 * past_get_control(&player.past, 0)->held_node;
    return run->h * hypot(v[0], v[1]);
}

/* Positions [2n], m, at which run_until_rest stopped */
static double stopped_x[2 * 128];

static double find_drift_since_stop(const Simulation *simulation)
{
    const System *system = &simulation->system;
    double far = 0, l2 = INFINITY;
    CHECK(2 * sizeof *stopped_x * (size_t)system->nodes <= sizeof stopped_x);
    for (int s = 0; s < system->springs; s++)
        l2 = fmin(l2, system->l2[s]);
    for (int i = 0; i < 2 * system->nodes; i++)
        far = fmax(far, fabs(simulation->run[0].x[i] - stopped_x[i]));
    return far / sqrt(l2);
}

/* Runs until the player pauses by itself, within 3000 steps. */
static void run_until_rest(void)
{
    if (player_is_stopped(&player))
        CHECK_OK(obey_command("play"));
    for (int i = 0; i < 3000 && !player_is_stopped(&player); i++)
        show_refusal(player_make_step(&player));
    CHECK(player_is_stopped(&player));
    const Simulation *simulation = player_get_simulation(&player);
    size_t size = 2 * sizeof *stopped_x * (size_t)simulation->system.nodes;
    memcpy(stopped_x, simulation->run[0].x,
           size < sizeof stopped_x ? size : sizeof stopped_x);
}

static double find_heap_growth(const Simulation *simulation)
{
    (void)simulation;
    return (count_heap_bytes() - heap_at_start) / 1e6;
}

static double count_unconverged_steps(const Simulation *simulation)
{
    return (double)simulation->unconverged_steps;
}

/* Numbers by their names in sessions, and the functions that find them */
static const struct {
    const char *name;
    double (*find_value)(const Simulation *simulation);
} numbers[] = {{"records", count_newton_records},
               {"rises", count_energy_rises},
               {"highest rise", find_highest_energy_rise},
               {"all masses", sum_masses},
               {"lowest", find_lowest_height},
               {"top", find_highest_height},
               {"way from rest", find_distance_from_rest},
               {"mean vy", find_mean_vy},
               {"turned", count_turned_triangles},
               {"broken", count_broken_springs},
               {"crossings", count_edge_crossings},
               {"flattest", find_smallest_area_ratio},
               {"grown", find_heap_growth},
               {"gained", find_gained_energy},
               {"gains", count_steps_with_energy_gain},
               {"own energy", find_energy_minus_work},
               {"wall", find_wall_height},
               {"hand distance", find_hand_node_distance},
               {"hand step", find_held_node_motion},
               {"way from stop", find_drift_since_stop},
               {"unconverged", count_unconverged_steps}};

/* Returns the number with a name: in `numbers` or `counters`, of a node, a run,
 * an update, the ledger or the live values of texts. NaN: unknown name */
static double find_value_by_name(const char *name)
{
    static const char *const fields[] = {"alpha",  "residual", "projected",
                                         "change", "slope",    "to"};
    const Pane *pane = active_pane(content);
    const Simulation *simulation = pane->simulation;
    const NewtonRecord *row = NULL;
    char field[16];
    int i = 0, k = 0;
    for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++)
        if (strcmp(numbers[n].name, name) == 0)
            return numbers[n].find_value(simulation);
    for (size_t n = 0; n < COUNTER_COUNT; n++)
        if (strcmp(counters[n].name, name) == 0)
            return (double)get_work_counter(simulation, n);
    if (strncmp(name, "gap", 3) == 0) {
        const TimeIntegrator *run = &simulation->run[atoi(name + 3)];
        return find_smallest_gap(run->system, run->x);
    }
    if (sscanf(name, "rise %d", &i) == 1)
        return find_energy_rise(simulation, i);
    if (sscanf(name, "radius %d", &i) == 1)
        return hypot(simulation->run[i].x[0], simulation->run[i].x[1]);
    if (sscanf(name, "x %d", &i) == 1)
        return pane_get_positions(pane)[2 * i];
    if (sscanf(name, "y %d", &i) == 1)
        return pane_get_positions(pane)[2 * i + 1];
    if (sscanf(name, "update %d %15s", &i, field) == 2) {
        CHECK(i >= 1 && i <= get_newton_records(simulation, &row));
        row += i - 1;
        while (strcmp(fields[k], field) != 0)
            k++;
        return (double[]){
            row->alpha,         row->residual, row->projected_blocks,
            row->energy_change, row->slope,    row->x_after[0]}[k];
    }
    const Energies ledger = simulation_get_energies(simulation, 0);
    for (i = 0; i < ledger.count; i++)
        if (strcmp(ledger.energy[i].name, name) == 0)
            return ledger.energy[i].value;
    return values_find_number(&pane->values, name);
}

/* Returns true if a number has these digits ("6.0e-5") or this bound ("<8"). */
static bool number_matches(double number, const char *digits)
{
    double wanted = strtod(digits + strspn(digits, "<>"), NULL);
    const char *point = strchr(digits, '.'), *e = strchr(digits, 'e');
    int decimals = point ? (int)strspn(point + 1, "0123456789") : 0;
    if (digits[0] == '<' || digits[0] == '>')
        return digits[0] == '<' ? number < wanted : number > wanted;
    return fabs(number - wanted) <=
           0.5000001 * pow(10, (e ? atoi(e + 1) : 0) - decimals);
}

/* Checks that the value NAME is NUMBER, for the line "NAME NUMBER". */
static void check_named_value(const char *line)
{
    char name[64];
    const char *digits = strrchr(line, ' ') + 1;
    snprintf(name, sizeof name, "%.*s", (int)(digits - line) - 1, line);
    player_build_frame(&player);
    double number = find_value_by_name(name);
    if (!number_matches(number, digits))
        fail_msg("%s is %.12g at step %ld, not %s", name, number,
                 player.past.shown_step, digits);
}

/* Makes the steps of "STEPS NAME NUMBER"; checks the number after each. */
static void check_value_in_steps(const char *line)
{
    for (long left = atol(line); left > 0; left--) {
        show_refusal(player_make_step(&player));
        check_named_value(strchr(line, ' ') + 1);
    }
}

static void run_session_line(const char *line)
{
    static const struct {
        const char *verb;
        void (*handler)(const char *rest);
    } acts[] = {{"begin", begin_session},       {"size", resize_window},
                {"value", check_named_value},   {"keeps", check_value_in_steps},
                {"replays", check_replay},      {"tables", check_states_file},
                {"file", add_file_to_record},   {"picture", check_picture},
                {"words", add_window_to_record}};
    char verb[16] = "", rest[192] = "";
    sscanf(line, "%15s %191[^\n]", verb, rest);
    if (getenv("SHOW"))
        fprintf(stderr, "%s\n", line);
    for (size_t i = 0; i < sizeof acts / sizeof *acts; i++)
        if (strcmp(acts[i].verb, verb) == 0) {
            acts[i].handler(rest);
            return;
        }
    if (strcmp(verb, "key") == 0)
        for (char *word = strtok(rest, " "); word; word = strtok(NULL, " "))
            press_key(word);
    else if (strcmp(verb, "type") == 0)
        for (const char *letter = rest; *letter; letter++)
            press_letter(*letter);
    else if (strcmp(verb, "do") == 0)
        show_refusal(obey_command(rest));
    else if (strcmp(verb, "run") == 0)
        run_until_step(atol(rest));
    else if (strcmp(verb, "rest") == 0)
        run_until_rest();
    else if (strcmp(verb, "go") == 0)
        for (long left = atol(rest); left > 0; left--)
            if (player.screen.sheet)
                sheet_advance_cells(&player);
            else
                show_refusal(player_make_step(&player));
    else if (strcmp(verb, "half") == 0)
        stop_within_step();
    else if (strcmp(verb, "whole") == 0)
        show_refusal(past_is_working(&player.past) ? player_make_step(&player)
                                                   : STATUS_OK);
    else if (strcmp(verb, "asks") == 0)
        player.setup.asks_guess = player.screen.must_redraw = true;
    else if (strstr("reads lacks list", verb))
        check_window_words(verb, rest);
    else if (strstr("mark same other", verb))
        check_hash_mark(verb, rest);
    else if (!send_mouse_action(verb, rest))
        check_fact(line);
}

/* ---- sessions ----------------------------------------------------------- */

enum { MAX_SESSIONS = 512, MAX_LINES = 16384 };

typedef struct Session {
    const char *name, **line;
} Session;

static Session sessions[MAX_SESSIONS + 1]; /* a NULL name is the end */
/* Lines of all sessions; NULL ends each session */
static const char *lines[MAX_LINES];
static char session_text[1 << 18];

static int session_count, line_count;

static void read_sessions(const char *name)
{
    static size_t used;
    FILE *file = fopen(name, "r");
    assert_non_null(file);
    char *text = session_text + used;
    used += fread(text, 1, sizeof session_text - used, file);
    assert_true(++used < sizeof session_text);
    fclose(file);
    for (char *row = strtok(text, "\n"); row; row = strtok(NULL, "\n"))
        if (row[0] == '=') {
            assert_true(session_count < MAX_SESSIONS);
            sessions[session_count++] =
                (Session){row + 2, lines + ++line_count};
        } else if (row[0] != '#') {
            while ((lines[line_count] = take_row_field(&row)))
                assert_true(++line_count + 2 < MAX_LINES);
        }
    line_count++;
}

static const Session *find_session(const char *name)
{
    const Session *session = sessions;
    while (session->name && strcmp(session->name, name) != 0)
        session++;
    return session;
}

static const char *current_line; /* line that runs now, for messages */

static void run_session(void **state)
{
    const Session *session = *state;
    const bool records = strncmp(session->name, "record ", 7) == 0;
    letters_are_boxes = records;
    clear_record();
    for (const char **line = session->line; *line; line++) {
        run_session_line(current_line = *line);
        if (records && player_is_open)
            add_changed_facts_to_record(current_line);
    }
    if (records)
        compare_with_record(session->name + 7);
    current_line = NULL;
}

/* Prints the line at which a session has failed, and cleans up. */
static int end_session(void **unused)
{
    (void)unused;
    if (current_line)
        print_error("    at: %s\n", current_line);
    close_player();
    count_files(true);
    current_line = NULL;
    letters_are_boxes = false;
    return 0;
}

/* ---- a hand in every scene ---------------------------------------------- */

/* Scenes with the start of a drag, its length in pixels, and letters for what
 * applies to the scene: g the hand pulls, d a point is dragged, p pins, k the
 * stiffness k, l lines of Algorithm 3, f projection, s line search, m method */
static const struct SceneRow {
    const char *scene, *drag_start;
    int drag_x, drag_y;
    const char *action_letters;
} rows[] = {
    {"square", "node 12", 60, -60, "gpklfsm"},
    {"circle", "m 1,0", 40, -60, "g"},
    {"overshoot", "m 1.98,1.97", 60, -30, "ds"},
    {"landscape", "grip 1", 60, -60, "dfs"},
    {"unprojected", "node 12", 60, -60, "gpklfsm"},
    {"explosion", "node 6", 60, -60, "gpklfsm"},
    {"hang", "node 84", 60, -60, "gpklfsm"},
    {"drop", "node 144", 60, 60, "gpklfs"},
    {"slope", "node 24", 60, 20, "gpklfs"},
    {"squeeze", "node 144", 60, 20, "gpklfs"},
    {"dent", "node 144", 60, 60, "gpklfs"},
    {"tear", "node 137", 60, 60, "gpklfs"},
    {"bend", "node 59", 40, -60, "gpklfs"},
    {"arrows", "grip 0", 40, -60, "d"},
    {"tangent", "m 2.495,2.522", -60, 0, "ds"},
    {"dial", "grip 0", 60, 60, "d"},
    {"spring", "grip 0", 40, 40, "dlfsm"},
};
enum { SCENE_ROW_COUNT = sizeof rows / sizeof *rows };

/* Replaces START, ON and BACK in a pattern by the scene's drag. Returns false
 * if the scene lacks the letter k of "[k] ", or has the letter k of "[-k] ". */
static bool fill_action_line(const char *pattern, const struct SceneRow *row,
                             char *line, size_t size)
{
    if (pattern[0] == '[') {
        bool lacks = pattern[1] == '-';
        if (lacks != !strchr(row->action_letters, pattern[1 + lacks]))
            return false;
        pattern += 4 + lacks;
    }
    const char *place = strchr(pattern, ' ') + 1;
    int verb = (int)(place - pattern), half = strcmp(place, "ON") == 0;
    half = strcmp(place, "BACK") == 0 ? -1 : half;
    if (half)
        snprintf(line, size, "%.*s%+d %+d", verb, pattern,
                 half * row->drag_x / 2, half * row->drag_y / 2);
    else
        snprintf(line, size, "%.*s%s", verb, pattern,
                 strcmp(place, "START") == 0 ? row->drag_start : place);
    return true;
}

static void drag_in_scene(void **state)
{
    static char line[128];
    const struct SceneRow *row = *state;
    snprintf(line, sizeof line, "begin %s --paused", row->scene);
    run_session_line(current_line = line);
    for (const char **act = find_session("hand")->line; *act; act++)
        if (fill_action_line(*act, row, line, sizeof line))
            run_session_line(line);
    check_replay(row->scene);
    current_line = NULL;
}

/* Checks that each grip of each scene is found where it was dragged to. */
static void grips_go_where_they_are_dragged(void **unused)
{
    (void)unused;
    int grips = 0;
    for (const Scene *scene = scenes; scene->name; scene++)
        for (int i = 0; scene->handle_kinds && scene->handle_kinds[i];
             i++, grips++) {
            char line[80];
            double at[SCENE_MAX_HANDLES][2];
            bool flat = scene->traits & HAS_ONE_COORDINATE; /* y is ignored */
            snprintf(line, sizeof line, "begin %s --paused", scene->name);
            run_session_line(line);
            snprintf(line, sizeof line, "press grip %d", i);
            run_session_line(current_line = line);
            run_session_line("move +9 +9");
            run_session_line("move m 0.4,-0.3");
            run_session_line("release +0 +0");
            exhibit_list_handles(player_get_simulation(&player), at);
            CHECK_NEAR(at[i][0], 0.4, 1e-9);
            CHECK(flat || fabs(at[i][1] + 0.3) < 1e-9);
        }
    CHECK(grips > 8);
    current_line = NULL;
}

/* ---- random keys -------------------------------------------------------- */

static uint64_t hash_all_but_setting(int place)
{
    uint64_t hash = hash_by_name("state") + (uint64_t)player.past.shown_step;
    player_build_frame(&player);
    for (int i = 0; i < content->settings.count; i++)
        if (i != place)
            hash = add_to_hash(hash, content->settings.item[i].value,
                               strlen(content->settings.item[i].value));
    return hash;
}

/* Random keys in an open field change only its number; after Escape, none. */
static void random_keys_stay_in_their_field(void **unused)
{
    (void)unused;
    static const char *const others[] = {
        "Space",  "Tab",    "Up",        "Down",      "Left",   "Right",
        "Home",   "End",    "F1",        "F11",       "PageUp", "PageDown",
        "Delete", "Ctrl+R", "Tab+M",     "Shift+N",   "Ctrl+5", "Keypad 5",
        "Insert", "\u00dc", "Shift+Tab", "Backspace",
    };
    enum { OTHER_KEY_COUNT = sizeof others / sizeof *others, ROUNDS = 150 };
    Random random = {19};
    int set = 0, refused = 0;
    for (int round = 0; round < ROUNDS; round++) {
        if (round == 0 || set > 0) { /* new session after a changed number */
            run_session_line("begin square --segments 2 --paused");
            run_session_line("key N N");
        }
        uint64_t before = hash_by_name("");
        int place = random_below(&random, player.screen.frame.option_count);
        for (int i = 0; i <= place; i++)
            press_key("Tab");
        uint64_t rest = hash_all_but_setting(place);
        press_letter("0123456789.,+-"[random_below(&random, 14)]);
        for (int i = random_below(&random, 12); i > 0; i--)
            if (random_below(&random, 4) == 0)
                press_key(others[random_below(&random, OTHER_KEY_COUNT)]);
            else if (random_below(&random, 2) == 0)
                press_letter((char)(' ' + random_below(&random, 95)));
            else
                press_letter("0123456789.,e-/ms"[random_below(&random, 17)]);
        bool mesh = strcmp(content->settings.item[place].name, "segments") == 0;
        bool enter = !mesh && random_below(&random, 2) == 0;
        if (enter)
            press_key("Return");
        set = enter && !player.input.selected_option;
        refused += enter && !set;
        press_key("Escape");
        CHECK(!player.input.selected_option &&
              past_count_panes(&player.past) == 1 &&
              player_is_stopped(&player));
        if (set && player.past.shown_step == 2) /* no new run has begun */
            CHECK(hash_all_but_setting(place) == rest);
        if (!set)
            CHECK(hash_by_name("") == before);
        assert_string_equal(player_get_simulation(&player)->scene->name,
                            "square");
        assert_int_equal(count_files(false), 0);
    }
    CHECK(refused > ROUNDS / 10);
}

static uint64_t hash_panes(void)
{
    uint64_t hash = STATE_HASH_SEED;
    for (int p = 0; p < past_count_panes(&player.past); p++)
        hash = hash_simulation(&get_past_pane(p)->simulation, hash);
    return hash;
}

/* Goes to each step, backwards, and stores its hash; or, `again`, forwards, and
 * checks that its hash is the stored one. */
static void hash_each_step(uint64_t *hash, bool again)
{
    const long newest = past_find_newest(&player.past);
    CHECK(newest < MAX_STEPS);
    for (long i = 0; i <= newest; i++) {
        char line[32];
        long step = again ? i : newest - i;
        snprintf(line, sizeof line, "goto %ld", step);
        show_refusal(obey_command(line));
        const uint64_t now = hash_panes();
        CHECK(!again || hash[step] == now);
        hash[step] = now;
    }
}

static void undo_and_redo_all(uint64_t started)
{
    static uint64_t hash[MAX_EDITS][MAX_STEPS];
    int back = 0;
    run_session_line("release 350 300");
    const uint64_t end = player_compute_hash(&player);
    const long step = player.past.shown_step;
    for (; player.past.branch_index > 0; back++) {
        CHECK(back + 1 < MAX_EDITS);
        hash_each_step(hash[back], false);
        show_refusal(obey_command("undo"));
    }
    hash_each_step(hash[back], false);
    CHECK(player_compute_hash(&player) == started);
    for (; back >= 0; back--) {
        hash_each_step(hash[back], true);
        if (back > 0)
            show_refusal(obey_command("redo"));
    }
    char line[32];
    snprintf(line, sizeof line, "goto %ld", step);
    show_refusal(obey_command(line));
    CHECK(player_compute_hash(&player) == end);
}

/* Acts at random, with memory for few or many states. Undo and redo restore the
 * bits of each step, the saved script leads to the same bits without a refused
 * line, and the changed facts are those of the record. */
static void record_of_random_hands(void **unused)
{
    (void)unused;
    enum { ROUNDS = 60, ACTIONS_PER_ROUND = 40 };
    static const char *const scene[] = {
        "square --segments 2", "square --segments 2 --integrator sdirk2",
        "drop --segments 2", "square --segments 2 --integrator bdf2"};
    static const size_t states[] = {1, 6, 1000};
    Random random = {21};
    clear_record();
    const char **acts = find_session("acts")->line;
    int count = 0;
    while (acts[count])
        count++;
    for (int round = 0; round < ROUNDS; round++) {
        char line[80];
        snprintf(line, sizeof line, "begin %s --paused", scene[round % 4]);
        run_session_line(line);
        player.past.max_bytes = states[round % 3] * player.past.used_bytes;
        const uint64_t started = player_compute_hash(&player);
        for (int i = 0; i < ACTIONS_PER_ROUND; i++) {
            run_session_line(current_line = acts[random_below(&random, count)]);
            player.is_quitting = false; /* Escape may quit */
            add_changed_facts_to_record(current_line);
        }
        undo_and_redo_all(started);
        check_replay(scene[round % 4]);
        count_files(true);
    }
    compare_with_record("hands");
    current_line = NULL;
}

/* Checks that a page which is left and entered again looks the same. The race,
 * which measures times, is left out. */
static void pages_are_the_same_when_they_are_entered_again(void **unused)
{
    (void)unused;
    for (int i = 0; i < lecture_count_pages(); i += tests_are_long() ? 1 : 3) {
        char line[64];
        if (strcmp(lecture_pages[i].name, "order") == 0)
            continue;
        run_session_line("begin square --paused");
        snprintf(line, sizeof line, "do page %s", lecture_pages[i].name);
        run_session_line(current_line = line);
        run_session_line("mark a");
        run_session_line("key N N");
        show_refusal(obey_command("page-back"));
        show_refusal(obey_command("page-on"));
        run_session_line(line);
        run_session_line("same a");
        current_line = NULL;
    }
}

/* Checks that each page has a session for its Try, and one for its claim. */
static void each_page_has_its_sessions(void **unused)
{
    (void)unused;
    for (const LecturePage *page = lecture_pages; page->name; page++)
        for (int claim = 0; claim < 2; claim++) {
            char name[32];
            snprintf(name, sizeof name, "%s %s", claim ? "claim" : "try",
                     page->name);
            if (!find_session(name)->name)
                fail_msg("no session '%s'", name);
        }
}

int main(int argc, char **argv)
{
    struct CMUnitTest tests[5 + MAX_SESSIONS + SCENE_ROW_COUNT] = {
        cmocka_unit_test_teardown(grips_go_where_they_are_dragged, end_session),
        cmocka_unit_test_teardown(random_keys_stay_in_their_field, end_session),
        cmocka_unit_test_teardown(record_of_random_hands, end_session),
        cmocka_unit_test_teardown(
            pages_are_the_same_when_they_are_entered_again, end_session),
        cmocka_unit_test(each_page_has_its_sessions)};
    int count = 5;
    read_sessions("tests/data/sessions.txt");
    read_sessions("tests/data/claims.txt");
    assert_true(getcwd(start_folder, sizeof start_folder) && mkdtemp(folder));
    for (int i = 0; i < session_count; i++)
        if (strcmp(sessions[i].name, "hand") &&
            strcmp(sessions[i].name, "acts"))
            tests[count++] =
                (struct CMUnitTest){sessions[i].name, run_session, NULL,
                                    end_session, (void *)&sessions[i]};
    for (int i = 0; i < SCENE_ROW_COUNT; i++)
        tests[count++] = (struct CMUnitTest){rows[i].scene, drag_in_scene, NULL,
                                             end_session, (void *)&rows[i]};
    assert_int_equal(chdir(folder), 0);
    if (argc > 1)
        cmocka_set_test_filter(argv[1]);
    int failed =
        _cmocka_run_group_tests("sessions", tests, (size_t)count, NULL, NULL);
    assert_int_equal(chdir(start_folder), 0);
    rmdir(folder);
    return failed;
}
