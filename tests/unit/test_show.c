/* test_show.c - frames: what is drawn, where, and what the mouse finds */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "test.h"

/* ---- a scene after some steps, as a player would show it ---------------- */

static Simulation simulation;
static History history;
static FrameContent content;
static FrameView view;
static Paper paper;
static Layout layout;

static void set_paper_size(int width, int height)
{
    paper_free(&paper);
    assert_int_equal(paper_create(width, height, &paper), 0);
    layout = layout_create(&content, width, height);
}

static void sample_energies(void)
{
    Energy row[MAX_HISTORY_SERIES];
    const Picture *picture = picture_of_scene(simulation.scene);
    int n = picture->get_energies ? picture->get_energies(&simulation, row) : 0;
    history_add_point(&history, simulation_get_time(&simulation), n, row);
}

static void begin_show(const char *line, int steps)
{
    simulation_free(&simulation);
    simulation_from_line(line, NULL, NULL, &simulation);
    history.series_count = history.point_count = 0;
    sample_energies();
    for (int i = 0; i < steps; i++) {
        Status status = simulation_step(&simulation);
        assert_true(!status || status_is_unconverged(status) ||
                    simulation.is_over);
        sample_energies();
    }
    frame_create(&simulation, &content);
    view = *content.view;
    content.view = &view;
    content.pane[0].history = &history;
    frame_compute_values(&content);
    set_paper_size(1280, 800);
}

static int end_show(void **unused)
{
    (void)unused;
    paper_free(&paper);
    simulation_free(&simulation);
    return 0;
}

static void draw_picture(void)
{
    int width = paper.canvas.width, height = paper.canvas.height;
    frame_compute_values(&content);
    frame_draw(&paper, &content);
    layout = layout_create(&content, width, height);
}

/* Draws the frame without words, whose letters would be counted as colours. */
static void draw_without_words(void)
{
    font_free(paper.font);
    paper.font = NULL;
    draw_picture();
}

static Colour get_pixel(int x, int y)
{
    return paper.canvas.pixels[y * paper.canvas.width + x];
}

static int count_box_pixels(Box box, Colour colour)
{
    int count = 0;
    for (int j = box.y; j < box.y + box.height; j++)
        for (int i = box.x; i < box.x + box.width; i++)
            count += get_pixel(i, j) == colour;
    return count;
}

static int count_stage_pixels(Colour colour)
{
    return count_box_pixels(layout.stage, colour);
}

/* Picks at some pixels right of and below a point of the world. */
static Pick pick_at(double x, double y, double right, double down)
{
    const double world[2] = {x, y};
    Camera camera = make_pane_camera(&content, &layout, 0);
    double at[2];
    camera_to_pixel(&camera, world, at);
    return frame_find_pick(&content, &layout, at[0] + right, at[1] + down);
}

static bool pick_is(Pick pick, PickKind kind, int index)
{
    return pick.kind == kind && pick.index == index;
}

/* ---- all of a frame ------------------------------------------------------ */

/* Each scene is drawn in any size, and with positions that are not finite. */
TEST(every_window_size_is_drawn)
{
    const int sizes[][2] = {{1, 1},     {1, 900},    {2000, 3}, {199, 201},
                            {400, 300}, {1500, 999}, {900, 900}};
    const int count = tests_are_long() ? 7 : 5;
    for (const Scene *scene = scenes; scene->name; scene++)
        for (int i = 0; i < count; i++)
            for (int mode = 0; mode < 4; mode++) {
                if (!tests_are_long() && (scene - scenes + i + mode) % 2)
                    continue;
                begin_show(scene->name, mode);
                content.shows_strain = mode & 1;
                content.is_bare = mode == 3;
                content.column = mode == 2 ? COLUMN_KEYS : COLUMN_CARDS;
                content.cards.closed_cards = 0;
                content.pane[0].step_status = STATUS_NOT_FINITE;
                view.hovered_part = (Pick){.kind = PICK_SPRING, .index = 0};
                if (simulation.runs > 0 && mode > 0) {
                    simulation.run[0].x[0] = NAN;
                    simulation.run[0].x[1] = mode == 1 ? 1e300 : -INFINITY;
                }
                set_paper_size(sizes[i][0], sizes[i][1]);
                frame_expand_texts(&content);
                draw_picture();
            }
}

/* ---- what is seen -------------------------------------------------------- */

/* The view follows finite positions; else words say why a picture is empty. */
TEST(distant_nodes_are_drawn_or_reported)
{
    begin_show("square", 0);
    double *x = simulation.run[0].x;
    int size = 2 * simulation.system.nodes;
    for (double far = 1e10; far < 1e301; far *= 1e10) {
        for (int i = 0; i < size; i++)
            x[i] = far * get_rest_x(&simulation)[i];
        draw_picture();
        CHECK(count_stage_pixels(COLOUR_X) > 500 &&
              count_stage_pixels(COLOUR_WARNING) == 0);
    }
    for (int i = 0; i < size; i++) /* one node far above, one far below 0 */
        x[i] = i == 2 * 11 + 1 ? 1e220 : i == 2 * 13 + 1 ? -1e220 : 0;
    draw_picture();
    CHECK(count_stage_pixels(COLOUR_X) > 300);
    view.hovered_part = (Pick){.kind = PICK_SPRING, .index = 0};
    draw_picture();
    CHECK(count_stage_pixels(COLOUR_NOTE) > 1000);
    for (int part = 0; part < 2; part++) { /* first one node, then all nodes */
        for (int i = 0; i < (part ? size : 1); i++)
            x[i] = i % 2 ? INFINITY : NAN;
        draw_picture();
        CHECK(count_stage_pixels(COLOUR_WARNING) > 20);
    }
}

/* In a step the camera moves by a small part of the stage. Only two jumps are
 * allowed, where the view grows or shrinks by at most the factor 1.5. */
TEST(the_camera_does_not_jump)
{
    static const char *const lines[] = {
        "square --stretch 1 --ground 0,1,0,-0.6 --velocity 3,0 --timestep 0.02",
        "square --stretch 1 --ball 1.1,0,0.2 --velocity -2,0 --timestep 0.02",
        "drop --velocity 3,3 --timestep 0.02"};
    for (int i = 0; i < 3; i++) {
        begin_show(lines[i], 0);
        Camera was = make_pane_camera(&content, &layout, 0);
        int jumps = 0;
        for (int step = 0; step < 150; step++) {
            const Box *box = &layout.pane[0];
            double middle[2], pixel[2];
            camera_to_world(&was, box->x + 0.5 * box->width,
                            box->y + 0.5 * box->height, middle);
            CHECK(!simulation_step(&simulation));
            Camera is = make_pane_camera(&content, &layout, 0);
            camera_to_pixel(&is, middle, pixel);
            double change = fabs(log(is.scale[0] / was.scale[0]));
            double moved = hypot(pixel[0] - box->x - 0.5 * box->width,
                                 pixel[1] - box->y - 0.5 * box->height);
            CHECK_AT_MOST(change, log(1.5) + 1e-9);
            jumps += change > 0.1 || moved > 0.1 * box->width;
            was = is;
        }
        CHECK_AT_MOST(jumps, 2);
    }
}

/* ---- what the mouse finds ------------------------------------------------ */

/* Each node is picked where it is drawn, also after zooming. A spring is picked
 * at its middle within 8 pixels, half as far as a node, and not where it is
 * broken; beside the square nothing is. */
TEST(the_mouse_finds_nodes_and_springs)
{
    begin_show("square", 2);
    content.time_line.is_paused = true;
    System *system = &simulation.system;
    const double *x = simulation.run[0].x;
    const double *a = x + 2 * system->e[0], *b = x + 2 * system->e[1];
    const double middle[2] = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
    for (int zoomed = 0; zoomed < 2; zoomed++) {
        Camera camera = make_pane_camera(&content, &layout, 0);
        double at[2];
        for (int i = 0; i < system->nodes; i++) {
            Pick pick = pick_at(x[2 * i], x[2 * i + 1], -2, 3);
            camera_to_pixel(&camera, x + 2 * i, at);
            if (!box_contains(layout.stage, at[0] - 2, at[1] + 3))
                continue;
            CHECK(pick_is(pick, PICK_NODE, i));
            CHECK_NEAR(pick.point[0], x[2 * i] - 2 / camera.scale[0], 1e-12);
        }
        camera_to_pixel(&camera, middle, at);
        CHECK(pick_is(pick_at(middle[0], middle[1], 0, 1), PICK_SPRING, 0));
        lens_zoom(&view.lens, layout.pane[0], at[0], at[1], 2.5);
    }
    view.lens = LENS_FITS;
    for (int s = 0; s < system->springs; s++) { /* diagonals cross nearby */
        const double *p = x + 2 * system->e[2 * s];
        const double *q = x + 2 * system->e[2 * s + 1];
        CHECK(pick_is(
            pick_at(0.54 * p[0] + 0.46 * q[0], 0.54 * p[1] + 0.46 * q[1], 0, 0),
            PICK_SPRING, s));
    }
    CHECK(frame_find_pick(&content, &layout, 5, 200).kind == PICK_NONE);
    CHECK(frame_find_pick(&content, &layout, 1100, 200).kind == PICK_NONE);
    int left = 0; /* index of the spring of nodes 0 and 1 */
    while (system->e[2 * left] != 0 || system->e[2 * left + 1] != 1)
        left++;
    double column = 0.5 * (x[0] + x[2]), height = 0.5 * (x[1] + x[3]);
    CHECK(pick_is(pick_at(column, height, -6, 0), PICK_SPRING, left));
    CHECK(pick_at(column, height, -12, 0).kind == PICK_NONE);
    system->k[left] = 0;
    CHECK(pick_at(column, height, -6, 0).kind == PICK_NONE);
    begin_show("square",
               0); /* sides of the square can be picked before the first step */
    content.time_line.is_paused = true;
    for (int side = 0; side < 2; side++)
        CHECK(
            pick_is(pick_at(side ? 0.7 : -0.7, 0.125, 0, 0), PICK_EDGE, side));
}

/* ---- what is written ----------------------------------------------- */

/* Texts of a frame, and pixels of their left ends */
static char texts[500][160];
static double text_left[500];
static int text_count;

int __real_text_draw(Font *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup);

int __wrap_text_draw(Font *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup)
{
    text_left[text_count % 500] = x;
    if (text_count < 500)
        snprintf(texts[text_count++], sizeof *texts, "%s", markup);
    return __real_text_draw(text, canvas, style, x, y, align, markup);
}

/* Draws the frame, and returns true if a text in it begins like `text`. */
static bool text_is_drawn(const char *text)
{
    text_count = 0;
    draw_picture();
    for (int i = 0; i < text_count; i++)
        if (strncmp(texts[i], text, strlen(text)) == 0)
            return true;
    return false;
}

/* Numbers in a text have the requested digits; in a formula those with a sign
 * or a power of ten are in parentheses. Lines with unknown values are left out;
 * lines behind "@" are repeated for each run. */
TEST(texts_contain_known_values)
{
    static const struct {
        const char *text, *line;
    } rows[] = {{"a {nothing}\nb", "b"},
                {"#warning* {a:4'}\u00b2", "0.69\u00b2"},
                {"{b:4'}\u00b2", "(\u22120.5511)\u00b2"},
                {"{-b} {-d:1}", "0.551 \u22120.2"},
                {"{c:4'}", "(1.468\u00b710^{\u22126})"},
                {"{d:/} of x^{{a}} {x}", "1/4 of x^{0.69} {x}"},
                {"{e:2} {e} {e:7}", "1200 1230 1234.567"},
                {"{nothing}\n@\n{f}", "2"}};
    LiveValues values = {.count = 0};
    values_add(&values, "a", 0.69);
    values_add(&values, "b", -0.5511);
    values_add(&values, "c", 1.468e-6);
    values_add(&values, "d", 0.25);
    values_add(&values, "e", 1234.567);
    values_add(&values, "nothing", NAN);
    values.next_run = 2;
    values_add(&values, "f", 2);
    values.next_run = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        TextLine line = text_find_known_line(&values, rows[i].text);
        assert_string_equal(line.text, rows[i].line);
        CHECK((line.colour == COLOUR_WARNING) == (i == 1));
        CHECK(!text_next_line(&line) && line.text[0] == 0);
    }
}

/* ---- cards --------------------------------------------------------------- */

/* On the map of inertia, |x - x_tilde|^2 / 2, labels stand where a ray crosses
 * their contours, to 4 pixels, because the ray has points every 5 mm. */
TEST(maps_of_inertia_label_their_contours)
{
    static const double levels[] = {0.2, 0.6, 1};
    begin_show("landscape --projection none --start 0.6,0.9 --timestep 0.1", 0);
    content.lecture.page = lecture_find_page("parts");
    lecture_apply_page(content.lecture.page, &simulation.options);
    simulation.exhibit.switches = PART_INERTIA;
    CHECK(text_is_drawn("0.6"));
    Plot stage = stage_create(&paper, &content, &layout, 0);
    const double *target = simulation.exhibit.x_tilde;
    for (int k = 0; k < 3; k++) {
        double far = sqrt(2 * levels[k]), at[2], near = INFINITY;
        plot_to_pixel(&stage, (double[]){target[0] + 0.62 * far, target[1]},
                      at);
        for (int i = 0; i < text_count && i < 500; i++)
            if (strtod(texts[i], NULL) == levels[k])
                near = fmin(near, fabs(text_left[i] - at[0]));
        CHECK_AT_MOST(near, 4);
    }
    draw_without_words();
    for (int k = 0; k < 3; k++) { /* pixels of the contour below x_tilde */
        double at[2], far = sqrt(2 * levels[k]);
        int darkest = -9;
        plot_to_pixel(&stage, (double[]){target[0], target[1] - far}, at);
        for (int i = -9; i < 9; i++)
            if ((get_pixel((int)at[0], (int)at[1] + i) & 255) <
                (get_pixel((int)at[0], (int)at[1] + darkest) & 255))
                darkest = i;
        CHECK_AT_MOST(abs(darkest), 1);
    }
}

TESTS(NULL, end_show)
