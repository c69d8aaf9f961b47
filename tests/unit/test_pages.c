/* test_pages.c - pages of the lecture: claims on numbers that no window shows
 * (other claims: tests/data/claims.txt), their code, and readable frames */
#include "test.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/plot.h"
#include "picture/text.h"

/* Creates the simulation of a page, with more options behind its own. */
static Simulation *open_page(const char *name, const char *more)
{
    const LecturePage *page = lecture_find_page(name);
    assert_non_null(page);
    Simulation *simulation = simulate("%s %s", page->command_line, more);
    lecture_apply_page(page, &simulation->options);
    return simulation;
}

/* ---- claims -------------------------------------------------------------- */

/* Page explicit: a push along the fastest mode stays small below the limit of
 * h, and grows above it; the stretch has no influence. */
TEST(the_fastest_motion_limits_h)
{
    FrameContent content;
    frame_create(open_page("explicit", ""), &content);
    double limit = frame_find_value(&content, "h limit");
    for (int i = 0; i < 2; i++) {
        char line[80];
        double mode[2 * SIMULATION_MAX_MODE_NODES];
        snprintf(line, sizeof line, "--timestep %.17g",
                 limit * (i ? 1.02 : 0.98));
        Simulation *simulation = open_page("explicit", line);
        TimeIntegrator *run = &simulation->run[0];
        simulation_find_max_omega(simulation, run->x, mode);
        for (size_t k = 0; k < run->x_length; k++)
            run->v[k] += 1e-6 * mode[k];
        double start = simulation_get_energies(simulation, 0).total;
        for (int step = 0; step < 300; step++)
            simulation_step(simulation);
        double now = simulation_get_energies(simulation, 0).total;
        CHECK((now < 1e3 * start) == (i == 0));
    }
    frame_create(open_page("explicit", "--stretch 1.2"), &content);
    CHECK_NEAR(frame_find_value(&content, "h limit"), limit, 1e-12);
}

/* Page dial: E is convex everywhere with h = 0.067 s, not with 0.0675 s. */
TEST(the_map_is_convex_for_short_steps)
{
    Simulation *simulation = open_page("dial", "");
    for (int convex = 0; convex < 2; convex++) {
        int bends = 0;
        simulation->run[0].h = convex ? 0.067 : 0.0675;
        for (int i = 0; i < 81 * 81; i++)
            bends += descent_classify_hessian(simulation, 0.05 * (i % 81 - 40),
                                              0.05 * (i / 81 - 40)) > 0;
        CHECK((bends == 0) == convex);
    }
}

/* Makes one Newton update of the first step, u += p [n], by eigenvectors of the
 * dense H. Returns the smallest |eigenvalue| of H. */
static Real make_dense_newton_update(const Simulation *simulation, int n,
                                     double *u)
{
    static Real g[50], H[50 * 50], q[50 * 50];
    double x[50] = {0}, resting[50] = {0}, h = simulation->options.timestep;
    const double *x_n = simulation->run[0].x;
    const IncrementalPotential E = {.system = &simulation->system,
                                    .weight = h * h,
                                    .x_n = x_n,
                                    .u_tilde = resting};
    Real least = INFINITY;
    for (int i = 0; i < n; i++)
        x[i] = x_n[i] + u[i];
    exact_derivatives(&E, u, x, h, 0, g, H);
    exact_eigenvectors(n, H, q);
    for (int k = 0; k < n; k++) {
        Real part = 0, lambda = H[(n + 1) * k];
        least = fminl(least, fabsl(lambda));
        for (int i = 0; i < n; i++)
            part -= q[n * i + k] * g[i] / lambda;
        for (int i = 0; i < n; i++)
            u[i] += (double)(part * q[n * i + k]);
    }
    return least;
}

/* Page explodes: the tenth Hessian alone has a tiny eigenvalue, and its update
 * leads 1.7 km away. */
TEST(the_tenth_update_has_a_tiny_eigenvalue)
{
    Simulation *simulation = open_page("explodes", "");
    double u[32] = {0}, farthest = 0;
    CHECK(simulation->system.nodes == 16);
    for (int update = 1; update <= 10; update++) {
        Real least = make_dense_newton_update(simulation, 32, u);
        CHECK(update == 1 || update == 10 || least > 62);
        if (update == 10)
            CHECK_NEAR(least, 0.0043, 5e-5);
    }
    for (int i = 0; i < 16; i++)
        farthest = fmax(farthest, hypot(u[2 * i], u[2 * i + 1]));
    CHECK_NEAR(farthest, 1700, 50);
}

/* Page fracture: springs break first at the ends of the slit (a column of
 * cells, x = 1/48, |y| < 5/48), then within 45 degrees of its line. */
TEST(the_crack_begins_at_the_slit)
{
    static bool before[4000];
    Simulation *simulation = make_steps(open_page("fracture", ""), 20);
    const System *system = &simulation->system;
    const double *rest = get_rest_x(simulation);
    int count = 0;
    for (int s = 0; s < system->springs; s++)
        before[s] = spring_is_broken(system, s);
    for (int step = 20; step < 45; step++) {
        make_steps(simulation, 1);
        for (int s = 0; s < system->springs; s++) {
            const double *a = rest + 2 * system->e[2 * s];
            const double *b = rest + 2 * system->e[2 * s + 1];
            double across = fabs(0.5 * (a[0] + b[0]) - 1 / 48.0);
            double beyond = fabs(0.5 * (a[1] + b[1])) - 5 / 48.0;
            if (before[s] || !spring_is_broken(system, s))
                continue;
            before[s] = true;
            CHECK(across <= beyond + 1e-9);
            CHECK(count++ >= 2 || (across < 1e-9 && beyond < 1 / 47.0));
        }
    }
    CHECK(count > 10);
}

static const MethodRace *run_race(const char *options)
{
    Simulation *simulation = open_page("order", options);
    while (!simulation->is_over)
        make_steps(simulation, 1);
    return &simulation->exhibit.race;
}

/* Page order: halving h divides the error by 2 or 4. With stiff springs all
 * explicit runs fail, and all implicit ones succeed. */
TEST(the_race_measures_errors)
{
    static const double factor[RACE_METHODS] = {2, 4, 2, 4};
    enum { VERLET_RUN = 1 }; /* index of Verlet's run with h = 8 ms */
    const MethodRace *race = run_race("");
    for (int i = 0; i < RACE_METHODS; i++) {
        const RaceResult *point =
            &race->result[(RACE_STEP_SIZES - 1) * RACE_METHODS + i];
        /* Errors below 1e-8 come from the tolerance, not from h. */
        while (point->error < 1e-8)
            point -= RACE_METHODS;
        /* 25 %, since the error also has terms of higher order */
        CHECK_NEAR((point - RACE_METHODS)->error / point->error, factor[i],
                   0.25 * factor[i]);
    }
    CHECK(!race->result[VERLET_RUN].is_stable);
    CHECK(race->result[RACE_METHODS + VERLET_RUN].is_stable);
    race = run_race("--stiffness 1e9 --stretch 1");
    for (int i = 0; i < race->run_count; i++) {
        const RaceResult *point = &race->result[i];
        CHECK(point->method->stages > 0 ? point->error < 0.01
                                        : !(point->error < 1e9));
    }
    CHECK_NEAR(race->result[0].h, RACE_TIME / 8, 1e-15);
}

/* ---- code and questions -------------------------------------------------- */

/* Each page shows its functions whole and in order, few lines highlighted. */
TEST(pages_show_their_code)
{
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        char names[160], *rest = names, *name;
        int lit = 0, functions = 0, ends = 0;
        snprintf(names, sizeof names, "%s", page->functions);
        name = strtok_r(rest, ",", &rest);
        for (const char *const *line = page->code; *line; line++) {
            lit += strstr(*line, page->highlight_text) != NULL;
            CHECK(!strstr(*line, "FAIL(")); /* listings omit error messages */
            ends += (*line)[0] == '}';
            if (name && ends == functions && strstr(*line, name)) {
                name = strtok_r(rest, ",", &rest);
                functions++;
            }
        }
        if (name || functions == 0 || ends != functions)
            fail_msg("page %s: no %s in %s", page->name, name, page->file);
        if (lit < 1 || lit > 5)
            fail_msg("page %s: '%s' is in %d lines", page->name,
                     page->highlight_text, lit);
    }
}

TEST(questions_have_answers)
{
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        FrameContent content;
        frame_create(open_page(page->name, ""), &content);
        if (page_wants_number(page) &&
            !isfinite(frame_find_value(&content, page->answer_name)))
            fail_msg("page %s: no number %s", page->name, page->answer_name);
        CHECK(page->question || (!page->answer_name && !page->covered_cards));
    }
}

/* ---- frames -------------------------------------------------------------- */

enum { MAX_WORDS = 512 };

/* Findings in a frame: heights of the smallest letters, pixels; numbers of
 * ellipses, of cut texts, of overlapping words, of points outside their axes */
static struct {
    int min_letter_size, min_code_letter_size, ellipsis_count, cut_text_count,
        overlaps;
    int outside_point_count, word_count;
    char cut_text[80]; /* the last text that leaves its box */
    Box column_box, word_box[MAX_WORDS];
    char drawn_texts[1 << 15];
} seen;

const Glyph *__real_font_get_glyph(Font *text, Face face, int size,
                                   uint32_t letter);
int __real_text_draw(Font *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup);
void __real_plot_curve(const Plot *plot, int count, const double *x,
                       const double *y, double width, Colour colour);

const Glyph *__wrap_font_get_glyph(Font *text, Face face, int size,
                                   uint32_t letter)
{
    if (letter != ' ' && size < seen.min_letter_size)
        seen.min_letter_size = size;
    if (face == FACE_MONO && size < seen.min_code_letter_size)
        seen.min_code_letter_size = size;
    seen.ellipsis_count += letter == 0x2026;
    return __real_font_get_glyph(text, face, size, letter);
}

int __wrap_text_draw(Font *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup)
{
    const Box *place = &canvas->clip;
    double wide = text_measure(text, style, markup).width;
    double left = x - 0.5 * (double)align * wide;
    size_t used = strlen(seen.drawn_texts);
    if (left < place->x - 1.5 || y < place->y - 1.5 ||
        left + wide > place->x + place->width + 1.5 ||
        y + style->size > place->y + place->height + 1.5) {
        seen.cut_text_count++;
        snprintf(seen.cut_text, sizeof seen.cut_text, "%s", markup);
    }
    snprintf(seen.drawn_texts + used, sizeof seen.drawn_texts - used, "%s ",
             markup);
    Box word = {(int)left + 1, (int)y, (int)wide - 2, (int)(0.4 * style->size)};
    char *end;
    strtod(markup, &end);
    /* Overlaps count for numbers, and for words in the column of cards. */
    bool counts = !*end || box_contains(seen.column_box, left + 1, y);
    for (int i = 0; i < seen.word_count && counts; i++)
        seen.overlaps += word.x < seen.word_box[i].x + seen.word_box[i].width &&
                         seen.word_box[i].x < word.x + word.width &&
                         abs(word.y - seen.word_box[i].y) < word.height;
    assert_true(seen.word_count < MAX_WORDS);
    seen.word_box[seen.word_count] = word;
    seen.word_count += counts;
    return __real_text_draw(text, canvas, style, x, y, align, markup);
}

void __wrap_plot_curve(const Plot *plot, int count, const double *x,
                       const double *y, double width, Colour colour)
{
    const Axis *axis = &plot->y;
    double slack = 1e-9 * fmax(fabs(axis->low), fabs(axis->high));
    for (int i = 0; i < count && plot->x.high > plot->x.low; i++)
        seen.outside_point_count +=
            x[i] >= plot->x.low && x[i] <= plot->x.high &&
            (y[i] < axis->low - slack || y[i] > axis->high + slack);
    __real_plot_curve(plot, count, x, y, width, colour);
}

/* Views: cards, large cards with answer, with question, code, list of pages */
enum { CARDS_VIEW, LARGE_VIEW, ASK_VIEW, CODE_VIEW, LIST_VIEW, VIEW_COUNT };

/* Returns the first line of a text that is not drawn whole, or NULL. */
static const char *find_missing_line(const FrameContent *content,
                                     const char *text)
{
    static TextLine line;
    line = lines_begin(&active_pane(content)->values, text);
    while (text_next_line(&line))
        if (!strstr(seen.drawn_texts, line.text))
            return line.text;
    return NULL;
}

static const char *find_missing_text(const FrameContent *content)
{
    const LecturePage *page = content->lecture.page;
    const char *texts[] = {page->intro, page->formula,
                           content->lecture.hides_answer ? page->question
                                                         : page->answer_text,
                           content->lecture.hides_answer ? NULL : page->try};
    const char *missing = NULL;
    for (int i = 0; i < 4 && !missing; i++)
        missing = find_missing_line(content, texts[i]);
    return missing;
}

/* Draws a frame, and stores properties of its words and curves in `seen`. */
static void inspect_frame(const FrameContent *content, Paper *paper)
{
    memset(&seen, 0, sizeof seen);
    seen.min_letter_size = seen.min_code_letter_size = INT_MAX;
    seen.column_box =
        layout_create(content, paper->canvas.width, paper->canvas.height)
            .column;
    frame_draw(paper, content);
}

static void check_frame(const LecturePage *page, Simulation *simulation,
                        int kind, Paper *paper)
{
    static const ColumnContent column[VIEW_COUNT] = {
        COLUMN_CARDS, COLUMN_CARDS, COLUMN_CARDS, COLUMN_CODE, COLUMN_PAGES};
    int width = paper->canvas.width, height = paper->canvas.height;
    bool large = kind == LARGE_VIEW || kind == ASK_VIEW;
    /* E along p may leave the axis, which spans accepted values */
    bool cuts = strstr("descent algorithm2 closing", page->name);
    const char *missing = NULL;
    FrameContent content;
    simulation->options.big = large;
    frame_create(simulation, &content);
    content.lecture.hides_answer = kind == ASK_VIEW && page->question;
    frame_add_lecture(column[kind], NULL, &content);
    frame_expand_texts(&content);
    inspect_frame(&content, paper);
    bool good = (seen.min_letter_size + 0.5) * (large ? 35 : 55) >= height;
    if (kind == CODE_VIEW) { /* the picture and the main card stay */
        Layout beside = layout_create(&content, width, height);
        const Picture *picture = picture_of_scene(simulation->scene);
        int card =
            page->main_card ? picture_find_card(picture, page->main_card) : 0;
        CHECK(beside.stage.width > 0.3 * width && card >= 0);
        CHECK(!page->main_card ||
              beside.card[card].height > 0.25 * beside.stage.height);
        good = good && (strcmp(page->file, "src/lecture.c") != 0 ||
                        50 * (seen.min_code_letter_size + 0.5) > height);
    }
    if (kind < CODE_VIEW)
        missing = find_missing_text(&content);
    if (!good || missing || (large && seen.ellipsis_count > 0) ||
        (kind != LIST_VIEW && seen.cut_text_count > 0) || seen.overlaps > 0 ||
        (!cuts && seen.outside_point_count > 0))
        fail_msg(
            "page %s, step %ld, at %d x %d, %d: letters of %d, of code "
            "%d, %d ends in dots, %d outside its box (%s), %d over others, %d "
            "curves beyond the axes, no '%s'",
            page->name, simulation->steps, width, height, kind,
            seen.min_letter_size, seen.min_code_letter_size,
            seen.ellipsis_count, seen.cut_text_count, seen.cut_text,
            seen.overlaps, seen.outside_point_count, missing ? missing : "");
}

/* On each page, at its start and later, letters are at least 1/55 of the frame
 * high, code of lecture.c 1/50, large type 1/35 without ellipses. No word
 * leaves its card or covers another, and no curve leaves its axes. */
TEST(pages_are_legible_from_the_back_row)
{
    static const int sizes[][2] = {{1280, 800}, {1366, 768}, {1920, 1080}};
    for (int s = 0; s < 3; s++) {
        Paper paper;
        CHECK_STATUS(paper_create(sizes[s][0], sizes[s][1], &paper), STATUS_OK);
        for (int i = 0; lecture_pages[i].name; i++) {
            const LecturePage *page = &lecture_pages[i];
            Simulation *simulation = open_page(page->name, "");
            for (int kind = 0; kind < VIEW_COUNT; kind++)
                if (kind == LARGE_VIEW || kind == ASK_VIEW ||
                    (i + kind) % 3 == s)
                    check_frame(page, simulation, kind, &paper);
            for (int i = 0; i < 5 && !simulation_step(simulation); i++)
                continue;
            check_frame(page, simulation, s ? CARDS_VIEW : LARGE_VIEW, &paper);
            free_simulations();
        }
        paper_free(&paper);
    }
    FrameContent content; /* --big also enlarges scenes without a page */
    frame_create(simulate("square --big"), &content);
    CHECK(layout_create(&content, 1280, 800).em > 800 / 40);
}

/* In all scenes and window sizes no word leaves its box or covers another. */
TEST(scenes_keep_their_words_in_place)
{
    static const int sizes[][2] = {{900, 900}, {800, 600}, {1280, 800}};
    for (int i = 0; scenes[i].name; i++) {
        Simulation *simulation = simulate("%s", scenes[i].name);
        for (int s = 0; s < 3; s++) {
            Paper paper;
            FrameContent content;
            CHECK_OK(paper_create(sizes[s][0], sizes[s][1], &paper));
            frame_create(simulation, &content);
            frame_expand_texts(&content);
            inspect_frame(&content, &paper);
            paper_free(&paper);
            if (seen.cut_text_count > 0 || seen.overlaps > 0)
                fail_msg("%s at %d x %d: %d words cut (%s), %d over others",
                         scenes[i].name, sizes[s][0], sizes[s][1],
                         seen.cut_text_count, seen.cut_text, seen.overlaps);
        }
        free_simulations();
    }
}

TEST(labels_of_narrow_panes_are_not_cut)
{
    Paper paper;
    FrameContent content;
    CHECK_OK(paper_create(360, 300, &paper));
    frame_create(simulate("square"), &content);
    content.is_stage_only = true;
    content.min_em = 12;
    content.panes = 2;
    content.pane[1] = content.pane[0];
    content.pane[0].label =
        "symplectic Euler, ended at step 11; picture of step 6";
    inspect_frame(&content, &paper);
    paper_free(&paper);
    free_simulations();
    assert_int_equal(seen.cut_text_count, 0);
}

TESTS(NULL, NULL)
