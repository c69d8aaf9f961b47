/* Pictures and files: shapes, letters, colours, frames, PNG, tables. */
#include <errno.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "testing.h"

#include "picture/colour_map.h"
#include "picture/draw.h"
#include "picture/landscape_picture.h"
#include "picture/panels.h"
#include "picture/plot.h"
#include "play/png_file.h"
#include "play/recording.h"
#include "scenes/scene.h"
#include "picture/text_block.h"
#include "play/view.h"

enum { NAME_SIZE = 256, FRAME = 900 };

/* ---- helpers ------------------------------------------------------------ */

static char folder[NAME_SIZE]; /* of this run, empty at the start */

/* FOLDER/NAME; the last four results stay valid. */
static const char *in_folder(const char *name)
{
    static char names[4][NAME_SIZE + 64];
    static int next = 0;
    char *result = names[next++ % 4];
    snprintf(result, sizeof names[0], "%s/%s", folder, name);
    return result;
}

static bool exists(const char *name)
{
    return access(name, F_OK) == 0;
}

static void write_text(const char *name, const char *text)
{
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

/* The whole file as a text that the caller frees. */
static char *read_text(const char *name)
{
    FILE *file = fopen(name, "r");
    assert_non_null(file);
    char *text = calloc(1, 1 << 20);
    assert_non_null(text);
    size_t size = fread(text, 1, (1 << 20) - 1, file);
    assert_true(size > 0);
    fclose(file);
    return text;
}

/* Pixels of a PNG file as 0xffRRGGBB; free it with canvas_free. */
static Canvas read_png(const char *name)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    Canvas canvas;
    if (!png_image_begin_read_from_file(&image, name))
        fail_msg("%s: %s", name, image.message);
    image.format = PNG_FORMAT_RGB;
    assert_int_equal(
        canvas_create((int)image.width, (int)image.height, &canvas), 0);
    uint8_t *bytes = malloc(PNG_IMAGE_SIZE(image));
    assert_non_null(bytes);
    assert_true(png_image_finish_read(&image, NULL, bytes, 0, NULL));
    for (size_t i = 0; i < (size_t)image.width * image.height; i++)
        canvas.pixels[i] = 0xff000000u | (uint32_t)bytes[3 * i] << 16 |
                           (uint32_t)bytes[3 * i + 1] << 8 | bytes[3 * i + 2];
    free(bytes);
    return canvas;
}

/* Largest difference of a colour channel of two pixels. */
static int pixel_distance(Colour a, Colour b)
{
    int largest = 0;
    for (int shift = 0; shift < 24; shift += 8) {
        int d = (int)(a >> shift & 255) - (int)(b >> shift & 255);
        largest = abs(d) > largest ? abs(d) : largest;
    }
    return largest;
}

/* Darkness of the picture: sum over pixels of 1 - green/255. */
static double ink(const Canvas *canvas)
{
    double sum = 0;
    for (int i = 0; i < canvas->width * canvas->height; i++)
        sum += 1 - (double)(canvas->pixels[i] >> 8 & 255) / 255;
    return sum;
}

static Options parsed(int count, char **arguments)
{
    Options options;
    char message[512] = "";
    if (options_parse(count, arguments, &options, message, sizeof message))
        fail_msg("%s", message);
    return options;
}

static bool observe(void *user, const NewtonRecord *record)
{
    hud_add_update(user, record);
    return true;
}

/* A scene after some steps, as the program shows it. */
static void simulate_line(const char *line, int steps, Simulation *simulation,
                          Hud *hud)
{
    hud_create(hud);
    simulation_from_line(line, observe, hud, simulation);
    hud->speed = 60 * simulation->options.timestep;
    hud_sample(hud, simulation);
    for (int i = 0; i < steps; i++) {
        hud_begin_step(hud);
        Status status = simulation_step(simulation);
        assert_true(!status || status_is_unconverged(status));
        hud_end_step(hud, simulation);
        hud_sample(hud, simulation);
    }
}

/* The default scene with this many segments after some steps. */
static void simulate(const char *segments, int steps, Simulation *simulation,
                     Hud *hud)
{
    char line[64];
    snprintf(line, sizeof line, "square --segments %s", segments);
    simulate_line(line, steps, simulation, hud);
}

/* ---- canvas ------------------------------------------------------------- */

static void a_canvas_has_limits(void **unused)
{
    (void)unused;
    Canvas canvas;
    CHECK_STATUS(canvas_create(0, 5, &canvas), STATUS_INVALID_INPUT);
    CHECK_STATUS(canvas_create(5, -1, &canvas), STATUS_INVALID_INPUT);
    CHECK_STATUS(canvas_create(CANVAS_MAX_SIZE + 1, 5, &canvas),
                 STATUS_INVALID_INPUT);
    canvas_free(&canvas);
    canvas_free(NULL);
    CHECK_STATUS(canvas_create(1, 1, &canvas), STATUS_OK);
    CHECK(canvas.pixels[0] == COLOUR_WHITE);
    canvas_free(&canvas);
}

/* The ink of a line is its area, in whatever direction it runs. */
static void lines_have_their_area(void **unused)
{
    (void)unused;
    Random random = {11};
    Canvas canvas;
    assert_int_equal(canvas_create(200, 200, &canvas), 0);
    for (int i = 0; i < 200; i++) {
        double angle = random_uniform(&random, 0, 6.3);
        double width = random_uniform(&random, 0.5, 6);
        double x = random_uniform(&random, 99, 101), y = 100;
        canvas_clear(&canvas, COLOUR_WHITE);
        canvas_line(&canvas, x, y, x + 80 * cos(angle), y + 80 * sin(angle),
                    width, 0xff000000);
        CHECK_NEAR(ink(&canvas), 80 * width, 0.02 * 80 * width + 1);
    }
    canvas_free(&canvas);
}

static void discs_have_their_area(void **unused)
{
    (void)unused;
    Random random = {12};
    Canvas canvas;
    assert_int_equal(canvas_create(100, 100, &canvas), 0);
    for (int i = 0; i < 100; i++) {
        double radius = random_uniform(&random, 1, 40);
        double area = 3.14159265358979 * radius * radius;
        canvas_clear(&canvas, COLOUR_WHITE);
        canvas_disc(&canvas, random_uniform(&random, 49, 51), 50, radius,
                    0xff000000);
        CHECK_NEAR(ink(&canvas), area, 0.02 * area + 0.3);
    }
    canvas_free(&canvas);
}

/* A clipped line has the pixels of the whole one; nothing is written outside
 * (the sanitizers see to that). */
static void shapes_are_clipped(void **unused)
{
    (void)unused;
    Random random = {13};
    const double odd[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, 1e30, 0};
    Canvas canvas;
    assert_int_equal(canvas_create(31, 17, &canvas), 0);
    for (int i = 0; i < 2000; i++) {
        double at[4];
        for (int k = 0; k < 4; k++)
            at[k] = random_uniform(&random, -100, 100);
        if (i % 2)
            at[random_below(&random, 4)] = odd[random_below(&random, 7)];
        canvas_line(&canvas, at[0], at[1], at[2], at[3], 3, 0xff000000);
        canvas_disc(&canvas, at[0], at[1], fabs(at[2]), 0xff0000ff);
        canvas_rectangle(&canvas, (int)fmod(at[2], 50), -20, 60, 30,
                         0x80ff0000);
    }
    canvas_clear(&canvas, COLOUR_WHITE);
    canvas_line(&canvas, NAN, 1, 2, 3, 2, 0xff000000);
    canvas_line(&canvas, -10, -10, -10, 50, 2, 0xff000000);
    canvas_disc(&canvas, 1, NAN, 3, 0xff000000);
    CHECK_NEAR(ink(&canvas), 0, 0);
    canvas_line(&canvas, -1e6, 8.5, 1e6, 8.5, 1, 0xff000000);
    CHECK_NEAR(ink(&canvas), 31, 0.1);
    canvas_free(&canvas);
}

static void rectangles_mix_by_alpha(void **unused)
{
    (void)unused;
    Canvas canvas;
    assert_int_equal(canvas_create(4, 4, &canvas), 0);
    canvas_rectangle(&canvas, 1, 1, 2, 2, 0x80000000);
    CHECK(pixel_distance(canvas.pixels[5], 0xff7f7f7f) <= 1);
    CHECK(canvas.pixels[0] == COLOUR_WHITE);
    canvas_rectangle(&canvas, 0, 0, 4, 4, 0xff102030);
    CHECK(canvas.pixels[15] == 0xff102030);
    canvas_rectangle(&canvas, 2, 2, -1, 5, 0xffffffff);
    CHECK(canvas.pixels[10] == 0xff102030);
    canvas_free(&canvas);
}

/* ---- letters ------------------------------------------------------------ */

/* Every printable character has dots of its own; unknown ones are a box. */
static void letters_differ(void **unused)
{
    (void)unused;
    unsigned long long seen[FONT_GLYPHS] = {0};
    for (int c = ' '; c <= 127; c++) {
        unsigned long long dots = 0;
        for (int i = 0; i < 45; i++)
            dots = dots << 1 | font_dot((unsigned char)c, i % 5, i / 5);
        CHECK((c == ' ') == (dots == 0));
        for (int k = 0; k < c - ' '; k++)
            CHECK(seen[k] != dots);
        seen[c - ' '] = dots;
    }
    CHECK(font_dot(7, 0, 0) && font_dot(200, 0, 0));
    CHECK(!font_dot('X', -1, 0) && !font_dot('X', 5, 0) &&
          !font_dot('X', 0, 9));
}

static void text_is_aligned(void **unused)
{
    (void)unused;
    Canvas canvas;
    Font font;
    assert_int_equal(canvas_create(100, 30, &canvas), 0);
    assert_int_equal(font_create(2, &font), 0);
    CHECK(font.width == 12 && font.height == 20);
    CHECK(font_width(&font, "abc") == 36);
    const int left[] = {50, 32, 14};
    for (int align = ALIGN_LEFT; align <= ALIGN_RIGHT; align++) {
        int first = 100;
        canvas_clear(&canvas, COLOUR_WHITE);
        font_draw(&font, &canvas, 50, 5, (Align)align, 0xff000000, "HHH");
        for (int i = 0; i < 100 * 30; i++)
            if (pixel_distance(canvas.pixels[i], COLOUR_WHITE) > 128)
                first = i % 100 < first ? i % 100 : first;
        CHECK(first == left[align]);
    }
    font_draw(&font, &canvas, -30, -7, ALIGN_LEFT, 0xff000000, "clipped \x80");
    font_draw(&font, &canvas, 95, 25, ALIGN_LEFT, 0xff000000, "clipped");
    font_free(&font);
    canvas_free(&canvas);
}

static void fonts_have_limits(void **unused)
{
    (void)unused;
    Font font;
    CHECK_STATUS(font_create(0, &font), STATUS_INVALID_INPUT);
    CHECK_STATUS(font_create(NAN, &font), STATUS_INVALID_INPUT);
    CHECK_STATUS(font_create(65, &font), STATUS_INVALID_INPUT);
    font_free(&font);
    CHECK_STATUS(font_create(0.002, &font), STATUS_OK);
    font_free(&font);
    font_free(NULL);
}

static void text_blocks_are_cut(void **unused)
{
    (void)unused;
    static TextBlock block;
    Paper paper;
    assert_int_equal(paper_create(450, 450, &paper), 0);
    text_block_draw(&block, &paper, 0, 0, ALIGN_LEFT);
    CHECK_NEAR(ink(&paper.canvas), 0, 0);
    for (int i = 0; i < 2 * TEXT_BLOCK_LINES; i++)
        text_block_add(&block, COLOUR_TEXT, "%0200d", i);
    CHECK(block.lines == TEXT_BLOCK_LINES);
    CHECK(strlen(block.text[3]) == TEXT_BLOCK_SIZE - 1);
    text_block_draw(&block, &paper, 225, 3, ALIGN_CENTRE);
    paper_free(&paper);
    paper_free(NULL);
}

/* ---- colours, history, plot ---------------------------------------------- */

static void strain_has_its_colours(void **unused)
{
    (void)unused;
    CHECK(colour_map_strain(0, 0.2) == COLOUR_REST);
    CHECK(colour_map_strain(NAN, 0.2) == COLOUR_REST);
    CHECK(colour_map_strain(0.2, 0.2) == COLOUR_STRETCH);
    CHECK(colour_map_strain(7, 0.2) == COLOUR_STRETCH);
    CHECK(colour_map_strain(-INFINITY, 0.2) == COLOUR_COMPRESS);
    for (int i = -99; i < 100; i++) {
        Colour a = colour_map_strain(i / 100.0, 1);
        Colour b = colour_map_strain((i + 1) / 100.0, 1);
        CHECK(pixel_distance(a, b) <= 3);
    }
    CHECK(pixel_distance(COLOUR_STRETCH, COLOUR_COMPRESS) > 100);
}

/* However long the run, it holds the first and the newest point, in order. */
static void history_spans_the_run(void **unused)
{
    (void)unused;
    static History history = {.series = 3};
    history_clear(&history);
    for (int i = 0; i < 100000; i++) {
        const double value[HISTORY_SERIES] = {i, 2.0 * i, -i};
        history_add(&history, 0.5 * i, value);
        CHECK(history.count >= 1 && history.count <= HISTORY_POINTS);
        CHECK(history.time[0] == 0);
        CHECK(history.time[history.count - 1] == 0.5 * i);
        CHECK(history.value[1][history.count - 1] == 2.0 * i);
    }
    for (int i = 1; i < history.count; i++)
        CHECK(history.time[i] > history.time[i - 1]);
    CHECK(history.count > HISTORY_POINTS / 2);
    const double bad[HISTORY_SERIES] = {1, NAN, 1};
    int count = history.count;
    history_add(&history, 1e9, bad);
    CHECK(history.count == count);
    CHECK(history.high == 2.0 * 99999 && history.low == -99999);
    history_cut(&history, 100);
    CHECK(history.time[history.count - 1] <= 100 && history.time[0] == 0);
    CHECK(history.high == 4 * history.time[history.count - 1]);
    const double next[HISTORY_SERIES] = {1, 2, 3};
    history_add(&history, 200, next);
    history_add(&history, 201, next);
    CHECK(history.time[history.count - 1] == 201);
    CHECK(history.time[history.count - 2] <= 200);
    history_cut(&history, -1);
    CHECK(history.count == 0 && history.high == 0);
}

static void axes_end_at_round_numbers(void **unused)
{
    (void)unused;
    const double from[] = {0.9, 1, 1.1, 2.5, 5.01, 0.0031, 4e9, 1e-300};
    const double to[] = {1, 1, 2, 5, 10, 0.005, 5e9, 1e-300};
    for (int i = 0; i < 8; i++)
        CHECK_NEAR(plot_round_up(from[i]) / to[i], 1, 1e-9);
    CHECK_NEAR(plot_round_axis(103), 150, 1e-9);
    CHECK_NEAR(plot_round_axis(40), 40, 1e-9);
}

/* ---- frames ------------------------------------------------------------- */

/* Two drawings of the same state are equal in every pixel. */
static void frames_are_repeatable(void **unused)
{
    (void)unused;
    static Simulation simulation[2];
    static Hud hud[2];
    Paper paper[2];
    for (int i = 0; i < 2; i++) {
        simulate("4", 7, &simulation[i], &hud[i]);
        hud[i].strain = hud[i].keys = true;
        assert_int_equal(paper_create(500, 400, &paper[i]), 0);
        draw_frame(&paper[i], &simulation[i], &hud[i]);
    }
    draw_frame(&paper[0], &simulation[0], &hud[0]);
    assert_memory_equal(paper[0].canvas.pixels, paper[1].canvas.pixels,
                        500 * 400 * 4);
    for (int i = 0; i < 2; i++) {
        paper_free(&paper[i]);
        simulation_free(&simulation[i]);
    }
}

/* Pixels of tests/data/NAME.png that are off by more than 4 of 255. */
static int count_far_pixels(const char *name, const Paper *paper)
{
    char file[64];
    struct stat info;
    int far = 0;
    snprintf(file, sizeof file, "tests/data/%s.png", name);
    Canvas reference = read_png(file);
    assert_int_equal(reference.width, FRAME);
    assert_int_equal(reference.height, FRAME);
    for (int i = 0; i < FRAME * FRAME; i++)
        far += pixel_distance(paper->canvas.pixels[i], reference.pixels[i]) > 4;
    canvas_free(&reference);
    assert_int_equal(stat(file, &info), 0);
    CHECK(info.st_size < 120000);
    return far;
}

/* The pictures that `make pictures` made are those of now. */
static void readme_shows_what_is_drawn(void **unused)
{
    (void)unused;
    static Simulation simulation;
    static Hud hud;
    char name[32], line[128];
    int steps, count = 0;
    FILE *list = fopen("tests/data/pictures.txt", "r");
    assert_non_null(list);
    while (fscanf(list, "%31s %d %127[^\n]", name, &steps, line) == 3) {
        Paper paper;
        simulate_line(line, steps, &simulation, &hud);
        assert_int_equal(paper_create(FRAME, FRAME, &paper), 0);
        draw_frame(&paper, &simulation, &hud);
        int far = count_far_pixels(name, &paper);
        if (far)
            print_error("tests/data/%s.png differs\n", name);
        CHECK_AT_MOST(far, 0);
        paper_free(&paper);
        simulation_free(&simulation);
        count++;
    }
    fclose(list);
    CHECK(count == 5);
}

/* Bare means bare: white, blue and what lies between. */
static void hidden_text_leaves_the_slide(void **unused)
{
    (void)unused;
    static Simulation simulation;
    static Hud hud;
    Paper paper;
    simulate("4", 3, &simulation, &hud);
    hud.text = false;
    assert_int_equal(paper_create(300, 300, &paper), 0);
    SpringCount count = draw_frame(&paper, &simulation, &hud);
    CHECK(count.drawn == 72 && count.skipped == 0);
    for (int i = 0; i < 300 * 300; i++) {
        Colour pixel = paper.canvas.pixels[i];
        CHECK((pixel & 255) == 255 &&
              (pixel >> 8 & 255) == (pixel >> 16 & 255));
    }
    CHECK(ink(&paper.canvas) > 1000);
    paper_free(&paper);
    simulation_free(&simulation);
}

/* Trouble is red, and shown even where text is hidden. */
static void trouble_is_red(void **unused)
{
    (void)unused;
    static Simulation simulation;
    static Hud hud;
    Paper paper;
    simulate("4", 0, &simulation, &hud);
    hud.text = false;
    simulation.status = STATUS_LINE_SEARCH_LIMIT;
    hud_end_step(&hud, &simulation);
    CHECK_STATUS(hud.trouble, STATUS_LINE_SEARCH_LIMIT);
    assert_int_equal(paper_create(FRAME, FRAME, &paper), 0);
    draw_frame(&paper, &simulation, &hud);
    int red = 0;
    for (int i = 0; i < FRAME * FRAME; i++)
        red += pixel_distance(paper.canvas.pixels[i], COLOUR_WARNING) < 10;
    CHECK(red > 500);
    simulation.status = STATUS_INTERRUPTED;
    hud_restart(&hud);
    hud_end_step(&hud, &simulation);
    CHECK_STATUS(hud.trouble, STATUS_OK);
    paper_free(&paper);
    simulation_free(&simulation);
}

/* Springs shorter than two pixels are drawn as a coarser mesh. */
static void short_springs_are_skipped(void **unused)
{
    (void)unused;
    static Simulation simulation;
    static Hud hud;
    Paper paper;
    simulate("100", 0, &simulation, &hud);
    assert_int_equal(paper_create(100, 100, &paper), 0);
    SpringCount count = draw_frame(&paper, &simulation, &hud);
    CHECK(count.drawn + count.skipped == simulation.system.springs);
    CHECK(count.skipped > count.drawn);
    CHECK(count.drawn > 500);
    paper_free(&paper);
    simulation_free(&simulation);
}

/* Any size can be drawn of any scene, and blown-up positions do no harm. */
static void every_size_is_drawn(void **unused)
{
    (void)unused;
    const int sizes[][2] = {
        {1, 1}, {1, 900}, {2000, 3}, {199, 201}, {1500, 999}};
    static Simulation simulation;
    static Hud hud;
    for (int i = 0; i < 5 * 5; i++) {
        Paper paper;
        const Scene *scene = &scenes[i / 5];
        const int *size = sizes[i % 5];
        simulate_line(scene->name, 2, &simulation, &hud);
        hud.strain = hud.keys = true;
        hud.trouble = STATUS_NOT_FINITE;
        simulation.run[0].x[0] = NAN;
        if (scene->needs & NEEDS_MESH) {
            simulation.run[0].x[3] = 1e300;
            simulation.run[0].x[4] = -INFINITY;
        }
        for (int text = 0; text < 2; text++) {
            hud.text = text;
            assert_int_equal(paper_create(size[0], size[1], &paper), 0);
            draw_frame(&paper, &simulation, &hud);
            paper_free(&paper);
        }
        simulation_free(&simulation);
    }
}

/* Ink of the part of a picture between two lines, 0 ... 1 from above. */
static double ink_between(const Paper *paper, double from, double to)
{
    const Canvas *canvas = &paper->canvas;
    int first = (int)(from * canvas->height), last = (int)(to * canvas->height);
    Canvas part = {canvas->width, last - first,
                   canvas->pixels + first * canvas->width};
    return ink(&part);
}

/* Every scene says its sentence, and keeps quiet when text is hidden. */
static void every_scene_says_its_sentence(void **unused)
{
    (void)unused;
    static Simulation simulation;
    static Hud hud;
    for (const Scene *scene = scenes; scene->name; scene++) {
        Paper paper;
        simulate_line(scene->name, 0, &simulation, &hud);
        CHECK(strlen(scene->sentence) <= PAPER_LETTERS);
        assert_int_equal(paper_create(FRAME, FRAME, &paper), 0);
        draw_frame(&paper, &simulation, &hud);
        CHECK(ink_between(&paper, 0, 0.035) > 30 * strlen(scene->sentence));
        hud.text = false;
        draw_frame(&paper, &simulation, &hud);
        if (scene->picture != PICTURE_LANDSCAPE &&
            scene->picture != PICTURE_CURVE)
            CHECK_NEAR(ink_between(&paper, 0, 0.035), 0, 0);
        paper_free(&paper);
        simulation_free(&simulation);
    }
}

/* No line of the texts is cut: the longest that there are fit. */
static void texts_fit_on_a_line(void **unused)
{
    (void)unused;
    for (int status = 0; status < STATUS_COUNT; status++)
        CHECK(strlen(status_text((Status)status)) <= PAPER_LETTERS - 1);
}

/* A click on the black disc picks the place where it is. */
static void picks_are_where_the_disc_is(void **unused)
{
    (void)unused;
    static Simulation simulation;
    static Hud hud;
    Paper paper;
    assert_int_equal(paper_create(FRAME, 700, &paper), 0);
    for (int text = 0; text < 2; text++) {
        double point[2], sum[3] = {0};
        simulate_line("landscape --start 0.9,0.8 --tolerance 1e9", 0,
                      &simulation, &hud);
        hud.text = text;
        draw_frame(&paper, &simulation, &hud);
        CHECK(landscape_picture_pick(&paper, text, 450, 350, point));
        for (int j = 170; j < 350; j++) /* black: the disc, and no letters */
            for (int i = 460; i < 700; i++)
                if (paper.canvas.pixels[FRAME * j + i] == COLOUR_TEXT) {
                    sum[0] += i + 0.5;
                    sum[1] += j + 0.5;
                    sum[2] += 1;
                }
        CHECK(sum[2] > 50);
        CHECK(landscape_picture_pick(&paper, text, sum[0] / sum[2],
                                     sum[1] / sum[2], point));
        CHECK_NEAR(point[0], 0.9, 0.05);
        CHECK_NEAR(point[1], 0.8, 0.05);
        simulation_free(&simulation);
    }
    double point[2] = {7, 7};
    CHECK(!landscape_picture_pick(&paper, true, 5, 5, point));
    CHECK(!landscape_picture_pick(&paper, true, 450, 699, point));
    CHECK(landscape_picture_pick(&paper, false, 5, 5, point));
    CHECK(point[0] < -1.6 && point[1] > 1.6);
    paper_free(&paper);
}

/* SDL's software renderer shows exactly the paper. */
static void surface_shows_the_paper(void **unused)
{
    (void)unused;
    static Simulation simulation;
    static Hud hud;
    View *view = NULL;
    simulate("4", 1, &simulation, &hud);
    CHECK_STATUS(view_create_surface(300, 200, &view), STATUS_OK);
    Paper *paper = view_paper(view);
    assert_non_null(paper);
    draw_frame(paper, &simulation, &hud);
    CHECK_STATUS(view_show(view), STATUS_OK);
    for (int j = 0; j < 200; j++)
        for (int i = 0; i < 300; i++)
            CHECK(view_surface_pixel(view, i, j) ==
                  paper->canvas.pixels[300 * j + i]);
    CHECK(view_surface_pixel(view, 300, 0) == 0);
    CHECK(view_input(view).kind == INPUT_NONE && !view_quit_waits(view, true));
    view_free(view);
    view_free(NULL);
    simulation_free(&simulation);
}

/* ---- files -------------------------------------------------------------- */

static void png_files_are_whole(void **unused)
{
    (void)unused;
    Random random = {21};
    Canvas canvas;
    assert_int_equal(canvas_create(37, 23, &canvas), 0);
    for (int i = 0; i < 37 * 23; i++)
        canvas.pixels[i] =
            0xff000000u | (uint32_t)random_below(&random, 0x1000000);
    const char *name = in_folder("noise.png");
    write_text(name, "an earlier file");
    CHECK_STATUS(png_file_write(name, &canvas), STATUS_OK);
    CHECK(!exists(in_folder("noise.png.part")));
    Canvas again = read_png(name);
    assert_int_equal(again.width, 37);
    assert_memory_equal(again.pixels, canvas.pixels, 37 * 23 * 4);
    canvas_free(&again);
    canvas_free(&canvas);
}

static void png_failures_have_reasons(void **unused)
{
    (void)unused;
    Canvas canvas;
    assert_int_equal(canvas_create(300, 300, &canvas), 0);
    CHECK_STATUS(png_file_write("/dev/full", &canvas), STATUS_FILE_FAILED);
    assert_int_equal(errno, ENOSPC);
    CHECK_STATUS(png_file_write(in_folder("none/a.png"), &canvas),
                 STATUS_FILE_FAILED);
    assert_int_equal(errno, ENOENT);
    CHECK_STATUS(png_file_write(folder, &canvas), STATUS_FILE_FAILED);
    assert_int_equal(errno, EISDIR);
    canvas_free(&canvas);
}

static void outputs_replace_at_the_end(void **unused)
{
    (void)unused;
    Output output;
    const char *name = in_folder("late.txt"),
               *part = in_folder("late.txt.part");
    write_text(name, "old\n");
    CHECK_STATUS(output_open(name, &output), STATUS_OK);
    fputs("thrown away\n", output.file);
    CHECK_STATUS(output_restart(&output), STATUS_OK);
    fputs("new\n", output.file);
    char *text = read_text(name);
    assert_string_equal(text, "old\n");
    free(text);
    CHECK(exists(part));
    CHECK_STATUS(output_close(&output, true), STATUS_OK);
    CHECK_STATUS(output_close(&output, true), STATUS_OK);
    text = read_text(name);
    assert_string_equal(text, "new\n");
    free(text);
    CHECK(!exists(part));
}

static void discarded_outputs_leave_nothing(void **unused)
{
    (void)unused;
    Output output;
    CHECK_STATUS(output_open(in_folder("never.txt"), &output), STATUS_OK);
    fputs("text", output.file);
    output_discard(&output);
    output_discard(&output);
    CHECK(!exists(in_folder("never.txt")));
    CHECK(!exists(in_folder("never.txt.part")));
}

static void full_devices_are_noticed(void **unused)
{
    (void)unused;
    Output output;
    CHECK_STATUS(output_open("/dev/full", &output), STATUS_OK);
    fputs("text", output.file);
    CHECK_STATUS(output_close(&output, true), STATUS_FILE_FAILED);
    assert_int_equal(errno, ENOSPC);
}

/* The default options, to ask for files with. */
static Options recording_options(void)
{
    char program[] = "elasto";
    char *arguments[] = {program, NULL};
    return parsed(1, arguments);
}

static bool record_update(void *user, const NewtonRecord *record)
{
    return recording_update(user, record) == STATUS_OK;
}

/* Header, then a row a node and step; what is read is what was there. */
static void states_are_exact(void **unused)
{
    (void)unused;
    static Recording recording;
    static Simulation simulation;
    char name[NAME_SIZE + 64];
    snprintf(name, sizeof name, "%s", in_folder("states.csv"));
    Options options = recording_options();
    options.states = name;
    CHECK_STATUS(recording_open(&options, &recording), STATUS_OK);
    assert_int_equal(simulation_create(&options, NULL, NULL, &simulation), 0);
    CHECK_STATUS(recording_states(&recording, &simulation), STATUS_OK);
    assert_int_equal(simulation_step(&simulation), 0);
    CHECK_STATUS(recording_states(&recording, &simulation), STATUS_OK);
    CHECK_STATUS(recording_close(&recording), STATUS_OK);
    char *text = read_text(name);
    char *line = strtok(text, "\n");
    assert_string_equal(line, "step,time,node,x,y,vx,vy");
    for (int i = 0; i < 2 * 25; i++) {
        long step;
        int node;
        double time, x[2], v[2];
        line = strtok(NULL, "\n");
        assert_non_null(line);
        assert_int_equal(sscanf(line, "%ld,%lf,%d,%lf,%lf,%lf,%lf", &step,
                                &time, &node, &x[0], &x[1], &v[0], &v[1]),
                         7);
        assert_int_equal(step, i / 25);
        assert_int_equal(node, i % 25);
        CHECK(time == (i / 25) * 0.004);
        if (step == 1) {
            CHECK_SAME_BITS(x, simulation.run[0].x + 2 * node, 2);
            CHECK_SAME_BITS(v, simulation.run[0].v + 2 * node, 2);
        }
    }
    assert_null(strtok(NULL, "\n"));
    free(text);
    simulation_free(&simulation);
}

/* A row for each Newton update, as many as Newton counted. */
static void log_has_every_update(void **unused)
{
    (void)unused;
    static Recording recording;
    static Simulation simulation;
    char name[NAME_SIZE + 64];
    snprintf(name, sizeof name, "%s", in_folder("log.csv"));
    Options options = recording_options();
    options.log = name;
    CHECK_STATUS(recording_open(&options, &recording), STATUS_OK);
    assert_int_equal(
        simulation_create(&options, record_update, &recording, &simulation), 0);
    for (int i = 0; i < 5; i++)
        assert_int_equal(simulation_step(&simulation), 0);
    CHECK_STATUS(recording_close(&recording), STATUS_OK);
    char *text = read_text(name);
    long rows = -1;
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        int commas = 0;
        for (char *c = line; *c; c++)
            commas += *c == ',';
        assert_int_equal(commas, 11);
        rows++;
    }
    assert_int_equal(rows, simulation_counters(&simulation).iterations);
    assert_memory_equal(text, "step,iteration,residual,alpha,", 30);
    free(text);
    simulation_free(&simulation);
}

static void frames_are_numbered_by_step(void **unused)
{
    (void)unused;
    static Recording recording;
    Canvas canvas;
    char name[NAME_SIZE + 64];
    snprintf(name, sizeof name, "%s", in_folder("frames"));
    Options options = recording_options();
    options.frames = name;
    assert_int_equal(canvas_create(3, 3, &canvas), 0);
    for (int i = 0; i < 2; i++) {
        CHECK_STATUS(recording_open(&options, &recording), STATUS_OK);
        CHECK_STATUS(recording_frame(&recording, &canvas, 0, 1), STATUS_OK);
        CHECK_STATUS(recording_frame(&recording, &canvas, 12, 1), STATUS_OK);
        assert_int_equal(recording.frames, 2);
        CHECK_STATUS(recording_close(&recording), STATUS_OK);
    }
    CHECK(exists(in_folder("frames/frame_000000.png")));
    CHECK(exists(in_folder("frames/frame_000012.png")));
    canvas_free(&canvas);
}

/* Which file, and why. */
static void recording_failures_name_the_file(void **unused)
{
    (void)unused;
    static Recording recording;
    char file[NAME_SIZE + 64], none[NAME_SIZE + 64];
    snprintf(file, sizeof file, "%s", in_folder("a_file"));
    snprintf(none, sizeof none, "%s", in_folder("none/s.csv"));
    write_text(file, "text");
    Options options = recording_options();
    options.frames = file;
    CHECK_STATUS(recording_open(&options, &recording), STATUS_FILE_FAILED);
    assert_string_equal(recording.failed, file);
    assert_int_equal(recording.reason, ENOTDIR);
    recording_close(&recording);
    options.frames = NULL;
    options.states = none;
    CHECK_STATUS(recording_open(&options, &recording), STATUS_FILE_FAILED);
    assert_string_equal(recording.failed, none);
    assert_int_equal(recording.reason, ENOENT);
    recording_close(&recording);
    options.states = "/dev/full";
    CHECK_STATUS(recording_open(&options, &recording), STATUS_OK);
    CHECK_STATUS(recording_close(&recording), STATUS_FILE_FAILED);
    assert_string_equal(recording.failed, "/dev/full");
    assert_int_equal(recording.reason, ENOSPC);
}

/* ------------------------------------------------------------------------- */

static int make_test_folder(void **unused)
{
    (void)unused;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/elasto_test_XXXXXX",
             base ? base : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_test_folder(void **unused)
{
    (void)unused;
    char command[NAME_SIZE + 32];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_canvas_has_limits),
        cmocka_unit_test(lines_have_their_area),
        cmocka_unit_test(discs_have_their_area),
        cmocka_unit_test(shapes_are_clipped),
        cmocka_unit_test(rectangles_mix_by_alpha),
        cmocka_unit_test(letters_differ),
        cmocka_unit_test(text_is_aligned),
        cmocka_unit_test(fonts_have_limits),
        cmocka_unit_test(text_blocks_are_cut),
        cmocka_unit_test(strain_has_its_colours),
        cmocka_unit_test(history_spans_the_run),
        cmocka_unit_test(axes_end_at_round_numbers),
        cmocka_unit_test(frames_are_repeatable),
        cmocka_unit_test(readme_shows_what_is_drawn),
        cmocka_unit_test(hidden_text_leaves_the_slide),
        cmocka_unit_test(trouble_is_red),
        cmocka_unit_test(short_springs_are_skipped),
        cmocka_unit_test(every_size_is_drawn),
        cmocka_unit_test(every_scene_says_its_sentence),
        cmocka_unit_test(texts_fit_on_a_line),
        cmocka_unit_test(picks_are_where_the_disc_is),
        cmocka_unit_test(surface_shows_the_paper),
        cmocka_unit_test(png_files_are_whole),
        cmocka_unit_test(png_failures_have_reasons),
        cmocka_unit_test(outputs_replace_at_the_end),
        cmocka_unit_test(discarded_outputs_leave_nothing),
        cmocka_unit_test(full_devices_are_noticed),
        cmocka_unit_test(states_are_exact),
        cmocka_unit_test(log_has_every_update),
        cmocka_unit_test(frames_are_numbered_by_step),
        cmocka_unit_test(recording_failures_name_the_file),
    };
    return cmocka_run_group_tests_name("picture", tests, make_test_folder,
                                       remove_test_folder);
}
