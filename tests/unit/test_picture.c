/* test_picture.c - shapes, axes, words, numbers, README pictures, PNG files */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "golden.h"
#include "test.h"

#include "picture/colour_map.h"
#include "picture/plot.h"

/* ---- helpers ------------------------------------------------------------ */

/* Returns the ink of a box: the sum over pixels of 1 - green/255. */
static double sum_ink_in_box(const Canvas *canvas, Box box)
{
    double sum = 0;
    for (int j = box.y; j < box.y + box.height; j++)
        for (int i = box.x; i < box.x + box.width; i++)
            sum +=
                1 - (canvas->pixels[canvas->width * j + i] >> 8 & 255) / 255.0;
    return sum;
}

static double sum_ink(const Canvas *canvas)
{
    return sum_ink_in_box(canvas, (Box){0, 0, canvas->width, canvas->height});
}

static Canvas *make_white_canvas(int width, int height)
{
    static Canvas canvas;
    canvas_free(&canvas);
    CHECK_OK(canvas_create(width, height, &canvas));
    CHECK(canvas.pixels[0] == COLOUR_WHITE);
    return &canvas;
}

/* ---- canvas ------------------------------------------------------------- */

/* The ink of a line in any direction, of a disc and of a ring is its area. */
TEST(shapes_have_their_area)
{
    Random random = {11};
    for (int i = 0; i < 300; i++) {
        double angle = random_uniform(&random, 0, 6.3), area;
        double width = random_uniform(&random, 1, 6);
        double x = random_uniform(&random, 99, 101), y = 100;
        double radius = random_uniform(&random, 1, 40);
        Canvas *canvas = make_white_canvas(200, 200);
        if (i % 3 == 0)
            canvas_line(canvas, x, y, x + 80 * cos(angle), y + 80 * sin(angle),
                        width, 0xff000000);
        else if (i % 3 == 1)
            canvas_disc(canvas, x, y, radius, 0xff000000);
        else
            canvas_ring(canvas, x, y, radius + width, width, 0xff000000);
        area = i % 3 == 0   ? 80 * width
               : i % 3 == 1 ? M_PI * radius * radius
                            : 2 * M_PI * (radius + width) * width;
        CHECK_NEAR(sum_ink(canvas), area, 0.02 * area + (i % 3 ? 0.3 : 1));
    }
}

/* A clipped line has the pixels of the whole one, and no other pixel changes
 * (sanitizers notice writes outside). */
TEST(shapes_are_clipped)
{
    Random random = {13};
    const double odd[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, 1e30, 0};
    Canvas *canvas = make_white_canvas(31, 17);
    for (int i = 0; i < 2000; i++) {
        double at[4];
        for (int k = 0; k < 4; k++)
            at[k] = random_uniform(&random, -100, 100);
        if (i % 2)
            at[random_below(&random, 4)] = odd[random_below(&random, 7)];
        canvas_line(canvas, at[0], at[1], at[2], at[3], 3, 0xff000000);
        canvas_disc(canvas, at[0], at[1], fabs(at[2]), 0xff0000ff);
        canvas_fill(canvas, (Box){(int)fmod(at[2], 50), -20, 60, 30},
                    0x80ff0000);
    }
    canvas_clear(canvas, COLOUR_WHITE);
    canvas_line(canvas, NAN, 1, 2, 3, 2, 0xff000000);
    canvas_line(canvas, -10, -10, -10, 50, 2, 0xff000000);
    canvas_disc(canvas, 1, NAN, 3, 0xff000000);
    CHECK_NEAR(sum_ink(canvas), 0, 0);
    canvas_line(canvas, -1e6, 8.5, 1e6, 8.5, 1, 0xff000000);
    CHECK_NEAR(sum_ink(canvas), 31, 0.1);
}

/* ---- colours, history, plot ---------------------------------------------- */

/* Quantities that appear later count as 0 before; numbers that are not finite
 * or too many are left out. */
TEST(history_joins_energies_by_name)
{
    static History history;
    const Energy rows[] = {{"one", 1}, {"two", 2}, {"late", 3}};
    const Energy bad[] = {{"one", 1}, {"two", NAN}};
    history.series_count = history.point_count = 0;
    history_add_point(&history, 0, 2, rows);
    history_add_point(&history, 1, 2, bad);
    history_add_point(&history, NAN, 2, rows);
    history_add_point(&history, 2, 2, rows + 1);
    CHECK(history.point_count == 2 && history.series_count == 3 &&
          history.time[1] == 2);
    for (int s = 0; s < 3; s++) {
        assert_string_equal(history.name[s], rows[s].name);
        CHECK(history.value[s][0] == (s < 2 ? rows[s].value : 0));
        CHECK(history.value[s][1] == (s > 0 ? rows[s].value : 0));
    }
    for (int i = 3; i < 2 * HISTORY_MAX_POINTS; i++)
        history_add_point(&history, i, 3, rows);
    CHECK(history.point_count == HISTORY_MAX_POINTS);
}

/* Shapes are cut at the edge of the axes, and left out if centred outside. */
TEST(plots_keep_to_their_axes)
{
    const Axis axis = {0, 1, .label = NULL};
    const double in[2] = {0.5, 0.5}, out[2] = {1.02, 0.5}, d[2] = {0.52, 0};
    Paper paper;
    assert_int_equal(paper_create(300, 300, &paper), 0);
    const Plot card = {.paper = &paper, .box = {50, 50, 200, 200}};
    Plot plot = plot_create(&card, axis, axis);
    for (int shape = 0; shape < 5; shape++) {
        canvas_clear(&paper.canvas, COLOUR_WHITE);
        if (shape == 0)
            plot_line(&plot, in, out, 3, COLOUR_X);
        if (shape == 1)
            plot_dashes(&plot, in, out, 3, NULL, COLOUR_X);
        if (shape == 2)
            plot_arrow(&plot, in, d, 1, 3, COLOUR_X);
        if (shape == 3)
            CHECK(!plot_disc(&plot, out, 9, COLOUR_X));
        if (shape == 4)
            plot_ring(&plot, out, 9, 2, COLOUR_X);
        double inside = sum_ink_in_box(&paper.canvas, plot.box);
        CHECK_NEAR(sum_ink(&paper.canvas), inside, 1e-9);
        CHECK((inside > 100) == (shape < 3));
    }
    paper_free(&paper);
}

/* Counts the pixels of a colour; left: x of the leftmost one. */
static int count_pixels(const Canvas *canvas, Colour colour, int *left)
{
    int count = 0;
    *left = canvas->width;
    for (int i = 0; i < canvas->width * canvas->height; i++)
        if (canvas->pixels[i] == colour) {
            int x = i % canvas->width;
            *left = x < *left ? x : *left;
            count++;
        }
    return count;
}

/* Labels stand to the right of their point, unless a line or other words are
 * there; without a finite point they are left out. */
TEST(words_keep_off_lines_and_words)
{
    const double middle[2] = {200, 150}, far[2] = {INFINITY, 0};
    const double up[2] = {200, 280}, right[2] = {390, 150};
    for (int lines = 0; lines < 2; lines++) {
        Paper paper;
        int left, one = 0;
        assert_int_equal(paper_create(400, 300, &paper), 0);
        Plot plot = {.paper = &paper, /* unit: a pixel, y up */
                     .box = {0, 0, 400, 300},
                     .camera = {{1, 1}, {0, 300}},
                     .has_text = true,
                     .em = paper.em};
        if (lines) {
            plot_line(&plot, middle, up, 2, COLOUR_P);
            plot_line(&plot, middle, right, 2, COLOUR_P);
        }
        int sum_ink = count_pixels(&paper.canvas, COLOUR_P, &left);
        for (int i = 0; i < 5; i++) {
            plot_label(&plot, 1, i ? middle : far, COLOUR_TEXT, "words");
            int letters = count_pixels(&paper.canvas, COLOUR_TEXT, &left);
            one = i == 1 ? letters : one;
            CHECK(letters == i * one && (i == 0) == (letters == 0));
            CHECK(i != 1 || (left > 200) == !lines);
        }
        CHECK(count_pixels(&paper.canvas, COLOUR_P, &left) == sum_ink);
        paper_free(&paper);
    }
}

/* ---- frames ------------------------------------------------------------- */

/* Paints the frame of a step, with and without words; free both. */
static void paint_step(const char *line, int step, Canvas frame[2])
{
    char whole[160];
    snprintf(whole, sizeof whole, "%s --steps %d", line, step);
    begin_player(whole);
    player.screen.draws_frames = true; /* E along p is kept for the picture */
    player.play.mode = MODE_RUN;
    while (player.past.shown_step < step) {
        Status status = player_make_step(&player);
        CHECK(!status || status_is_unconverged(status));
    }
    paint_frame_pair(frame);
    end_player();
}

/* README pictures equal frames drawn now (slow pictures only in long tests). */
TEST(readme_pictures_are_current)
{
    char name[32], line[128], file[64];
    int step, count = 0, different = 0;
    FILE *list = fopen("tests/data/pictures.txt", "r");
    assert_non_null(list);
    while (fscanf(list, "%31s %d %127[^\n]", name, &step, line) == 3) {
        count++;
        if (!tests_are_long() && (strstr("dent tear", name) || step == 100))
            continue;
        Canvas frame[2];
        paint_step(line, step, frame);
        snprintf(file, sizeof file, "tests/data/%s.png", name);
        int far = count_differing_pixels(file, frame);
        if (far)
            print_error("%s differs; if it should: make pictures\n", file);
        different += far > 0;
    }
    fclose(list);
    CHECK(count == 30 && different == 0);
}

/* ---- files (what runs leave: check_files.sh) ---------------------------- */

TEST(png_files_are_whole)
{
    Random random = {21};
    Canvas *canvas = make_white_canvas(37, 23);
    char name[] = "/tmp/elasto-picture-XXXXXX";
    for (int i = 0; i < 37 * 23; i++)
        canvas->pixels[i] =
            0xff000000u | (uint32_t)random_below(&random, 0x1000000);
    int earlier = mkstemp(name);
    CHECK(write(earlier, "an earlier file", 15) == 15);
    close(earlier);
    CHECK_OK(png_file_write(name, NULL, canvas));
    Canvas again = read_png(name);
    assert_int_equal(again.width, 37);
    assert_memory_equal(again.pixels, canvas->pixels, 37 * 23 * 4);
    canvas_free(&again);
    remove(name);
}

TESTS(NULL, NULL)
