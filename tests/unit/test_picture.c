/* Pictures and files: shapes, letters, colours, frames, PNG, tables. */
#include <errno.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "attended.h"
#include "test.h"

#include "picture/colour_map.h"
#include "picture/picture.h"
#include "picture/plot.h"
#include "play/recording.h"
#include "play/view.h"
#include "scenes/options.h"
#include "scenes/scene.h"

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

/* The file is this text; NULL: it has any.  Returns it, to be freed. */
static char *check_text(const char *name, const char *expected)
{
    FILE *file = fopen(name, "r");
    char *text = calloc(1, 1 << 20);
    assert_true(file && text);
    assert_true(fread(text, 1, (1 << 20) - 1, file) > 0);
    fclose(file);
    if (expected)
        assert_string_equal(text, expected);
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

/* Darkness of a box: sum over pixels of 1 - green/255. */
static double ink_in(const Canvas *canvas, Box box)
{
    double sum = 0;
    for (int j = box.y; j < box.y + box.height; j++)
        for (int i = box.x; i < box.x + box.width; i++)
            sum +=
                1 - (canvas->pixels[canvas->width * j + i] >> 8 & 255) / 255.0;
    return sum;
}

static double ink(const Canvas *canvas)
{
    return ink_in(canvas, (Box){0, 0, canvas->width, canvas->height});
}

/* A white canvas until the next call. */
static Canvas *white_canvas(int width, int height)
{
    static Canvas canvas;
    canvas_free(&canvas);
    CHECK_STATUS(canvas_create(width, height, &canvas), STATUS_OK);
    CHECK(canvas.pixels[0] == COLOUR_WHITE);
    return &canvas;
}

/* ---- canvas ------------------------------------------------------------- */

TEST(a_canvas_has_limits)
{
    static const int sizes[][2] = {
        {0, 5}, {5, -1}, {CANVAS_MAX_SIZE + 1, 5}, {5, CANVAS_MAX_SIZE + 1}};
    Canvas canvas;
    for (int i = 0; i < 4; i++)
        CHECK_STATUS(canvas_create(sizes[i][0], sizes[i][1], &canvas),
                     STATUS_INVALID_INPUT);
    canvas_free(&canvas);
    canvas_free(NULL);
    white_canvas(1, 1);
}

/* The ink of a line is its area, in whatever direction it runs; that of a disc
 * and of a ring, too. */
TEST(shapes_have_their_area)
{
    Random random = {11};
    for (int i = 0; i < 300; i++) {
        double angle = random_uniform(&random, 0, 6.3), area;
        double width = random_uniform(&random, 1, 6);
        double x = random_uniform(&random, 99, 101), y = 100;
        double radius = random_uniform(&random, 1, 40);
        Canvas *canvas = white_canvas(200, 200);
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
        CHECK_NEAR(ink(canvas), area, 0.02 * area + (i % 3 ? 0.3 : 1));
    }
}

/* A clipped line has the pixels of the whole one; nothing is written outside
 * (the sanitizers see to that). */
TEST(shapes_are_clipped)
{
    Random random = {13};
    const double odd[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, 1e30, 0};
    Canvas *canvas = white_canvas(31, 17);
    for (int i = 0; i < 2000; i++) {
        double at[4];
        for (int k = 0; k < 4; k++)
            at[k] = random_uniform(&random, -100, 100);
        if (i % 2)
            at[random_below(&random, 4)] = odd[random_below(&random, 7)];
        canvas_line(canvas, at[0], at[1], at[2], at[3], 3, 0xff000000);
        canvas_disc(canvas, at[0], at[1], fabs(at[2]), 0xff0000ff);
        canvas_rectangle(canvas, (int)fmod(at[2], 50), -20, 60, 30, 0x80ff0000);
    }
    canvas_clear(canvas, COLOUR_WHITE);
    canvas_line(canvas, NAN, 1, 2, 3, 2, 0xff000000);
    canvas_line(canvas, -10, -10, -10, 50, 2, 0xff000000);
    canvas_disc(canvas, 1, NAN, 3, 0xff000000);
    CHECK_NEAR(ink(canvas), 0, 0);
    canvas_line(canvas, -1e6, 8.5, 1e6, 8.5, 1, 0xff000000);
    CHECK_NEAR(ink(canvas), 31, 0.1);
}

TEST(rectangles_mix_by_alpha)
{
    Canvas *canvas = white_canvas(4, 4);
    canvas_rectangle(canvas, 1, 1, 2, 2, 0x80000000);
    CHECK(pixel_distance(canvas->pixels[5], 0xff7f7f7f) <= 1);
    CHECK(canvas->pixels[0] == COLOUR_WHITE);
    canvas_rectangle(canvas, 0, 0, 4, 4, 0xff102030);
    CHECK(canvas->pixels[15] == 0xff102030);
    canvas_rectangle(canvas, 2, 2, -1, 5, 0xffffffff);
    CHECK(canvas->pixels[10] == 0xff102030);
}

/* ---- colours, history, plot ---------------------------------------------- */

TEST(strain_has_its_colours)
{
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
TEST(history_spans_the_run)
{
    static History history;
    history_clear(&history);
    CHECK(history_series(&history, "one") == 0);
    CHECK(history_series(&history, "two") == 1);
    CHECK(history_series(&history, "three") == 2);
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
    for (int i = 1; i < history.count - 1; i++) /* but for the newest */
        CHECK(history.time[i] == 0.5 * history.stride * i);
    const double bad[HISTORY_SERIES] = {1, NAN, 1};
    int count = history.count;
    history_add(&history, 1e9, bad);
    history_add(&history, NAN, (const double[HISTORY_SERIES]){1, 1, 1});
    CHECK(history.count == count);
    CHECK(history.time[count - 1] == 0.5 * 99999);
    CHECK(history_series(&history, "two") == 1); /* a new one was 0 */
    CHECK(history_series(&history, "late") == 3 && history.series == 4);
    CHECK(history.value[3][0] == 0 && history.value[3][count - 1] == 0);
    history_cut(&history, 100);
    double cut = history.time[history.count - 1];
    CHECK(cut <= 100 && cut > 100 - 0.5 * history.stride);
    CHECK(history.time[0] == 0);
    const double next[HISTORY_SERIES] = {1, 2, 3};
    history_add(&history, 200, next);
    history_add(&history, 201, next);
    CHECK(history.time[history.count - 1] == 201);
    CHECK(history.time[history.count - 2] == cut); /* it was due */
    history_cut(&history, -1);
    CHECK(history.count == 0);
}

TEST(axes_end_at_round_numbers)
{
    const double from[] = {0.9, 1, 1.1, 2.5, 5.01, 0.0031, 4e9, 1e-300};
    const double to[] = {1, 1, 2, 5, 10, 0.005, 5e9, 1e-300};
    for (int i = 0; i < 8; i++)
        CHECK_NEAR(plot_round_up(from[i]) / to[i], 1, 1e-9);
    CHECK_NEAR(plot_round_axis(103), 150, 1e-9);
    CHECK_NEAR(plot_round_axis(40), 40, 1e-9);
}

/* Beside each value that an axis names there is as much ink as its number has
 * elsewhere, all other ink is a line across, and 0 has the darkest of them. */
TEST(axes_name_their_values)
{
    enum { SIZE = 700 };
    static const struct {
        bool upright;
        Axis axis;
        double value[6]; /* NAN ends them */
    } rows[] = {
        {true, {0, 10, false, false, NULL}, {0, 5, 10, NAN}},
        {true, {-1, 3, false, false, NULL}, {-1, 0, 1, 2, 3, NAN}},
        {true, {0.3, 1.1, false, false, NULL}, {0.4, 0.6, 0.8, 1, NAN}},
        {true, {0, 2, false, true, NULL}, {0, 1, 2, NAN}},
        {true, {1e-3, 1, true, false, NULL}, {1e-3, 0.01, 0.1, 1, NAN}},
        {true, {2e-9, 5, true, false, NULL}, {1e-8, 1e-6, 1e-4, 0.01, 1, NAN}},
        {false, {0, 0.85, false, false, NULL}, {0, 0.2, 0.4, 0.6, 0.8, NAN}},
        {false, {0.5, 2e4, true, false, NULL}, {1, 10, 100, 1000, 1e4, NAN}},
    };
    const Axis plain = {0.05, 0.95, false, false, NULL};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        Paper paper, one;
        double sum = 0;
        int count = 0;
        bool up = rows[r].upright;
        assert_int_equal(paper_create(SIZE, SIZE, &paper), 0);
        assert_int_equal(paper_create(SIZE, SIZE, &one), 0);
        const Plot plot =
            plot_create(&paper, (Box){50, 50, 600, 600},
                        up ? plain : rows[r].axis, up ? rows[r].axis : plain);
        const Box box = plot.box;
        int wide = paper_pixels(&paper, 1), lines = 0;
        int left = box.x - 5, low = box.y + box.height + 1;
        for (; !isnan(rows[r].value[count]); count++) {
            double place[2], value = rows[r].value[count];
            canvas_clear(&one.canvas, COLOUR_WHITE);
            paper_write(&one, FACE_REGULAR, 0.82, COLOUR_FAINT, 99, 99,
                        ALIGN_LEFT, "%s", number_of(value).text);
            plot_place(&plot, (double[2]){up ? 0.5 : value, up ? value : 0.5},
                       place);
            int x = (int)place[0], y = (int)place[1];
            Box there = up ? (Box){0, y - wide, left, 2 * wide}
                           : (Box){x - 2 * wide, low, 4 * wide, SIZE - low};
            CHECK_NEAR(ink_in(&paper.canvas, there), ink(&one.canvas), 1e-9);
            sum += ink(&one.canvas);
            Colour line = paper.canvas.pixels[SIZE * y + 350];
            CHECK(!up || line == (value == 0 ? COLOUR_BORDER : COLOUR_GRID));
        }
        for (int y = 0; y < SIZE; y++)
            lines += paper.canvas.pixels[SIZE * y + 350] != COLOUR_WHITE;
        CHECK(!up || lines == count);
        Box margin = up ? (Box){0, 0, left, low + wide}
                        : (Box){0, low, SIZE, SIZE - low};
        CHECK_NEAR(ink_in(&paper.canvas, margin), sum, 1e-9);
        paper_free(&paper);
        paper_free(&one);
    }
}

/* What crosses the edge of the axes is cut there, whatever draws it; what has
 * its middle beyond is left out. */
TEST(plots_keep_to_their_axes)
{
    const Axis axis = {0, 1, false, false, NULL};
    const double in[2] = {0.5, 0.5}, out[2] = {1.02, 0.5}, d[2] = {0.52, 0};
    Paper paper;
    assert_int_equal(paper_create(300, 300, &paper), 0);
    Plot plot = plot_create(&paper, (Box){50, 50, 200, 200}, axis, axis);
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
        double inside = ink_in(&paper.canvas, plot.box);
        CHECK_NEAR(ink(&paper.canvas), inside, 1e-9);
        CHECK((inside > 100) == (shape < 3));
    }
    paper_free(&paper);
}

/* Arrows that would be too short or too long to be seen are a power of ten
 * times as long. */
TEST(arrows_have_a_length_that_is_seen)
{
    static const struct {
        double length, most, factor; /* pixels, of the longest arrow */
    } rows[] = {{50, 100, 1},   {10, 100, 1},     {5, 100, 10},
                {14, 1000, 10}, {15, 1000, 1},    {1e-3, 100, 1e4},
                {100, 100, 1},  {1000, 100, 0.1}, {2500, 100, 0.01},
                {0, 100, 0}};
    Paper paper;
    assert_int_equal(paper_create(400, 300, &paper), 0);
    const Plot plot = {.paper = &paper,
                       .box = {0, 0, 400, 300},
                       .camera = {{1, 1}, {0, 300}},
                       .em = 10};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const double x[4] = {9, 9, 9, 9}, d[4] = {rows[i].length, 0, NAN, 0};
        double factor =
            plot_arrows(&plot, 2, 1, x, d, 1, rows[i].most, COLOUR_P);
        CHECK_NEAR(factor, rows[i].factor, 1e-12 * factor);
    }
    paper_free(&paper);
}

/* Three digits, and a power of ten only where zeros would be many. */
TEST(numbers_are_read)
{
    const struct {
        double value;
        const char *text;
    } rows[] = {{0, "0"},
                {-5, "\u22125"},
                {0.1 + 0.2, "0.3"},
                {0.00123, "0.00123"},
                {0.00012, "1.2\u00b710^{\u22124}"},
                {1000, "1000"},
                {999.7, "1000"},
                {999.4, "999"},
                {12345, "12300"},
                {-77342, "\u221277300"},
                {1e5, "10^{5}"},
                {999999, "10^{6}"},
                {2.5e16, "2.5\u00b710^{16}"},
                {-INFINITY, "\u2212\u221e"},
                {-NAN, "no number"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_string_equal(number_of(rows[i].value).text, rows[i].text);
    }
}

/* A plot of 400 times 300 pixels whose unit is one, y up. */
static Plot bare_plot(Paper *paper)
{
    assert_int_equal(paper_create(400, 300, paper), 0);
    return (Plot){.paper = paper,
                  .box = {0, 0, 400, 300},
                  .camera = {{1, 1}, {0, 300}},
                  .em = paper->em};
}

static void put_words(Plot *plot, const double at[2], const char *words)
{
    plot_words(plot, 1, (const double(*)[2])at, 1.5, 1, FACE_REGULAR,
               COLOUR_TEXT, words);
}

/* Where words were put: the boxes after those that were there. */
TEST(words_keep_off_lines_and_words)
{
    const double middle[2] = {200, 150}, far[2] = {INFINITY, 0};
    const double up[2] = {200, 280}, right[2] = {390, 150};
    Paper paper;
    Plot plot = bare_plot(&paper);
    plot_keep_line(&plot, middle, up);
    plot_keep_line(&plot, middle, right);
    plot_keep_line(&plot, far, right); /* left out */
    CHECK(plot.lines == 2);
    plot_keep_disc(&plot, middle, 8);
    put_words(&plot, far, "no");
    CHECK(plot.boxes == 1); /* nothing can be beside it */
    for (int i = 0; i < 4; i++)
        put_words(&plot, middle, "words");
    CHECK(plot.boxes == 5);
    for (int i = 1; i < plot.boxes; i++) {
        Box a = plot.taken[i];
        bool over = a.x < 200 && a.x + a.width > 200 && a.y < 150;
        bool beside = a.y < 150 && a.y + a.height > 150 && a.x + a.width > 200;
        CHECK(!over && !beside);
        CHECK(a.x >= 0 && a.x + a.width <= 400);
        for (int j = 0; j < i; j++) {
            Box b = plot.taken[j];
            CHECK(a.x >= b.x + b.width || b.x >= a.x + a.width ||
                  a.y >= b.y + b.height || b.y >= a.y + a.height);
        }
    }
    paper_free(&paper);
}

/* Words stand to the right unless that costs more than another place: a little
 * corner of something else costs less, a line that ends before them nothing. */
TEST(words_stand_to_the_right)
{
    const double middle[2] = {200, 150}, far[2] = {390, 150};
    const double near[2] = {330, 150};
    Box place = {0};
    for (int round = 0; round < 3; round++) {
        Paper paper;
        Plot plot = bare_plot(&paper);
        if (round == 1)
            plot_keep_line(&plot, far, near);
        if (round == 2)
            plot_keep_box(&plot, (Box){place.x + place.width - 2,
                                       place.y + place.height - 2, 20, 20});
        put_words(&plot, middle, "words");
        Box at = plot.taken[plot.boxes - 1];
        if (round == 0)
            place = at;
        CHECK(at.x == place.x && at.y == place.y);
        plot_keep_disc(&plot, middle, 8);
        Box disc = plot.taken[plot.boxes - 1];
        CHECK(disc.x == 192 && disc.y == 142);
        CHECK(disc.width == 16 && disc.height == 16);
        paper_free(&paper);
    }
    CHECK(place.x >= 219 && place.x + place.width < near[0]);
    CHECK(place.width * place.height > 500); /* 4 pixels are little of it */
}

/* Where there is nothing to rub on, there is no coefficient to change. */
TEST(friction_is_a_number_of_contact)
{
    static const char *const scene[] = {"slope", "drop", "dent", "square"};
    const OptionRow *found[OPTIONS_MOST];
    for (int i = 0; i < 4; i++) {
        bool there = false;
        int count = options_row(&simulate("%s", scene[i])->options, found);
        for (int k = 0; k < count; k++)
            there = there || strcmp(found[k]->name, "friction") == 0;
        CHECK(there == (i < 3));
    }
}

/* ---- frames ------------------------------------------------------------- */

/* Marks the pixels around those that differ: where words are, whatever the
 * version of the library that drew them.  mask [FRAME FRAME] out. */
static void mask_words(const Canvas *words, const Canvas *plain,
                       unsigned char *mask)
{
    enum { AROUND = 24, ABOVE = 4 };
    memset(mask, 0, FRAME * FRAME);
    for (int j = 0; j < FRAME; j++)
        for (int i = 0; i < FRAME; i++) {
            if (words->pixels[FRAME * j + i] == plain->pixels[FRAME * j + i])
                continue;
            for (int b = j - ABOVE; b <= j + ABOVE; b++)
                for (int a = i - AROUND; a <= i + AROUND; a++)
                    if (a >= 0 && b >= 0 && a < FRAME && b < FRAME)
                        mask[FRAME * b + a] = 1;
        }
}

/* The frame of a step, with and without words; free both. */
static void frame_of(const char *line, int step, Canvas frame[2])
{
    char whole[160];
    snprintf(whole, sizeof whole, "%s --steps %d", line, step);
    begin(whole);
    player.mode = MODE_RUN;
    player_sample(&player);
    while (player.past.step < step) {
        Status status = player_step(&player);
        CHECK(!status || status_is_unconverged(status));
    }
    for (int plain = 0; plain < 2; plain++) {
        Paper paper;
        assert_int_equal(paper_create(FRAME, FRAME, &paper), 0);
        if (plain) {
            text_free(paper.text);
            paper.text = NULL;
        }
        player_paint(&player, &paper);
        frame[plain] = paper.canvas;
        paper.canvas = (Canvas){0};
        paper_free(&paper);
    }
    end();
}

/* Pixels of tests/data/NAME.png, away from words, that are off by more than 4
 * of 255. */
static int count_far_pixels(const char *name, const char *line, int step)
{
    static unsigned char mask[FRAME * FRAME];
    char file[64];
    struct stat info;
    int far = 0, compared = 0;
    snprintf(file, sizeof file, "tests/data/%s.png", name);
    Canvas reference = read_png(file);
    Canvas now[2];
    frame_of(line, step, now);
    assert_int_equal(reference.width, FRAME);
    assert_int_equal(reference.height, FRAME);
    mask_words(&now[0], &now[1], mask);
    for (int i = 0; i < FRAME * FRAME; i++)
        if (!mask[i]) {
            far += pixel_distance(now[0].pixels[i], reference.pixels[i]) > 4;
            compared++;
        }
    CHECK(compared > FRAME * FRAME / 2);
    canvas_free(&reference);
    canvas_free(&now[0]);
    canvas_free(&now[1]);
    assert_int_equal(stat(file, &info), 0);
    CHECK(info.st_size < 250000);
    return far;
}

/* The pictures that `make pictures` made are those of now. */
TEST(readme_shows_what_is_drawn)
{
    char name[32], line[128];
    int step, count = 0;
    FILE *list = fopen("tests/data/pictures.txt", "r");
    assert_non_null(list);
    while (fscanf(list, "%31s %d %127[^\n]", name, &step, line) == 3) {
        int far = count_far_pixels(name, line, step);
        if (far)
            print_error("tests/data/%s.png differs\n", name);
        CHECK_AT_MOST(far, 0);
        count++;
    }
    fclose(list);
    CHECK(count == 12);
}

/* A tolerance at which bodies could hang in the air is named on the stage; the
 * scene's own one is not. */
TEST(a_loose_tolerance_is_named)
{
    static const char *const lines[] = {"drop --segments 4",
                                        "drop --segments 4 --tolerance 0.01"};
    int red[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        Canvas frame[2];
        frame_of(lines[k], 0, frame);
        for (int i = 0; i < FRAME * FRAME; i++)
            red[k] += pixel_distance(frame->pixels[i], COLOUR_WARNING) < 60;
        canvas_free(&frame[0]);
        canvas_free(&frame[1]);
    }
    CHECK(red[0] == 0);
    CHECK(red[1] > 50);
}

/* The sheet of films has a tile for each line of tests/data/films.txt, all
 * lines can be run, and they are as long as one another. */
TEST(readme_shows_films_of_all_scenes)
{
    char name[32], line[128], begin[16];
    int speed, steps, count = 0;
    FILE *list = fopen("tests/data/films.txt", "r");
    assert_non_null(list);
    while (fscanf(list, "%31s %d %d %127[^\n]", name, &speed, &steps, line) ==
           4) {
        Simulation *scene = make_steps(simulate("%s", line), 1);
        CHECK(strcmp(scene->scene->name, name) == 0);
        CHECK(steps == 60 * speed);
        count++;
    }
    fclose(list);
    CHECK(count == 8);
    FILE *file = fopen("tests/data/scenes.webp", "rb");
    assert_non_null(file);
    CHECK(fread(begin, 1, sizeof begin, file) == sizeof begin);
    CHECK(fseek(file, 0, SEEK_END) == 0 && ftell(file) < 800000);
    CHECK(memcmp(begin, "RIFF", 4) == 0 && memcmp(begin + 8, "WEBP", 4) == 0);
    fclose(file);
}

/* An output without any pixel, as a window may have for a moment, has a paper
 * of one, and nothing fails. */
TEST(no_output_is_too_small)
{
    View *view = NULL;
    CHECK_STATUS(view_create_surface(0, 0, &view), STATUS_OK);
    const Paper *paper = view_paper(view);
    assert_non_null(paper);
    CHECK(paper->canvas.width == 1 && paper->canvas.height == 1);
    CHECK_STATUS(view_show(view), STATUS_OK);
    CHECK(view_input(view).kind == INPUT_NONE);
    view_free(view);
    view_free(NULL);
}

/* ---- files (what runs leave: check_files.sh) ---------------------------- */

TEST(png_files_are_whole)
{
    Random random = {21};
    Canvas *canvas = white_canvas(37, 23);
    const char *name = in_folder("noise.png");
    for (int i = 0; i < 37 * 23; i++)
        canvas->pixels[i] =
            0xff000000u | (uint32_t)random_below(&random, 0x1000000);
    write_text(name, "an earlier file");
    CHECK_STATUS(png_file_write(name, canvas), STATUS_OK);
    CHECK(!exists(in_folder("noise.png.part")));
    Canvas again = read_png(name);
    assert_int_equal(again.width, 37);
    assert_memory_equal(again.pixels, canvas->pixels, 37 * 23 * 4);
    canvas_free(&again);
}

TEST(png_failures_have_reasons)
{
    const struct {
        const char *name;
        int reason;
    } rows[] = {{"/dev/full", ENOSPC},
                {in_folder("none/a.png"), ENOENT},
                {folder, EISDIR}};
    Canvas *canvas = white_canvas(300, 300);
    for (int noise = 0; noise < 2; noise++) { /* fails at its end, or within */
        for (uint32_t i = 0; noise && i < 300 * 300; i++)
            canvas->pixels[i] = i * 2654435761u;
        for (int i = 0; i < 3; i++) {
            CHECK_STATUS(png_file_write(rows[i].name, canvas),
                         STATUS_FILE_FAILED);
            assert_int_equal(errno, rows[i].reason);
        }
    }
}

/* What stood there stays until the end, whatever becomes of it; a file that is
 * replaced keeps its mode, a new one has what umask leaves. */
TEST(outputs_replace_at_the_end)
{
    Output output;
    struct stat info;
    const char *name = in_folder("late.txt"),
               *part = in_folder("late.txt.part");
    mode_t before = umask(027);
    for (int round = 0; round < 3; round++) { /* new, replaced, discarded */
        static const char *const text[] = {"0\n", "1\n", "1\n"};
        CHECK_STATUS(output_open(name, &output), STATUS_OK);
        fputs("thrown away\n", output.file);
        CHECK_STATUS(output_cut(&output, -1), STATUS_OK);
        fprintf(output.file, "%d\n", round);
        CHECK(exists(part) && exists(name) == (round > 0));
        if (round == 2)
            output_discard(&output, false);
        CHECK_STATUS(output_close(&output), STATUS_OK);
        free(check_text(name, text[round]));
        CHECK(!exists(part) && stat(name, &info) == 0);
        assert_int_equal(info.st_mode & 07777, round ? 0604 : 0640);
        CHECK(chmod(name, 0604) == 0);
    }
    umask(before);
    CHECK_STATUS(output_open("/dev/full", &output), STATUS_OK);
    fputs("text", output.file);
    CHECK_STATUS(output_close(&output), STATUS_FILE_FAILED);
    assert_int_equal(errno, ENOSPC);
}

static bool record_update(void *user, const NewtonRecord *record)
{
    return recording_update(user, record, 1) == STATUS_OK;
}

/* Header, then a row a node and step; what is read is what was there. */
TEST(states_are_exact)
{
    static Recording recording;
    Simulation *scene = simulate("square");
    const Simulation *twice[] = {scene, scene};
    const char *name = in_folder("states.csv");
    Options options = scene->options;
    options.states = name;
    CHECK_STATUS(recording_open(&options, 1, &recording), STATUS_OK);
    CHECK_STATUS(recording_states(&recording, twice, 1, 0), STATUS_OK);
    make_steps(scene, 1);
    CHECK_STATUS(recording_states(&recording, twice, 2, 1), STATUS_OK);
    CHECK_STATUS(recording_close(&recording), STATUS_OK);
    char *text = check_text(name, NULL);
    char *line = strtok(text, "\n");
    assert_string_equal(line, "step,time,node,x,y,vx,vy");
    for (int i = 0; i < 3 * 25; i++) { /* the second run's nodes go on */
        long step;
        int node;
        double time, x[2], v[2];
        line = strtok(NULL, "\n");
        assert_non_null(line);
        assert_int_equal(sscanf(line, "%ld,%lf,%d,%lf,%lf,%lf,%lf", &step,
                                &time, &node, &x[0], &x[1], &v[0], &v[1]),
                         7);
        assert_int_equal(step, i >= 25);
        assert_int_equal(node, i < 25 ? i : i - 25);
        CHECK(time == (i >= 25) * 0.004);
        node %= 25;
        if (step == 1) {
            CHECK_SAME_BITS(x, scene->run[0].x + 2 * node, 2);
            CHECK_SAME_BITS(v, scene->run[0].v + 2 * node, 2);
        }
    }
    assert_null(strtok(NULL, "\n"));
    free(text);
}

/* A row for each Newton update, as many as Newton counted. */
TEST(log_has_every_update)
{
    static Recording recording;
    const char *name = in_folder("log.csv");
    Options options = simulate("square")->options;
    options.log = name;
    CHECK_STATUS(recording_open(&options, 1, &recording), STATUS_OK);
    Simulation *scene =
        make_steps(simulate_watched(record_update, &recording, "square"), 5);
    const NewtonRecord last = {.step = 5, .iteration = -1};
    CHECK(record_update(&recording, &last)); /* an end without an update */
    CHECK_STATUS(recording_close(&recording), STATUS_OK);
    char *text = check_text(name, NULL);
    CHECK(strstr(text, "\n5,,0,") != NULL);
    long rows = -2;
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        int commas = 0;
        for (char *c = line; *c; c++)
            commas += *c == ',';
        assert_int_equal(commas, 13);
        rows++;
    }
    assert_int_equal(rows, simulation_counters(scene).iterations);
    assert_memory_equal(text, "step,iteration,residual,alpha,", 30);
    free(text);
}

TEST(frames_are_numbered_by_step)
{
    static Recording recording;
    Canvas canvas;
    const char *name = in_folder("frames");
    Options options = simulate("square")->options;
    options.frames = name;
    assert_int_equal(canvas_create(3, 3, &canvas), 0);
    for (int i = 0; i < 2; i++) {
        CHECK_STATUS(recording_open(&options, 1, &recording), STATUS_OK);
        CHECK_STATUS(recording_frame(&recording, &canvas, 0, 1), STATUS_OK);
        CHECK_STATUS(recording_frame(&recording, &canvas, 12, 1), STATUS_OK);
        CHECK_STATUS(recording_frame(&recording, &canvas, 12, 1), STATUS_OK);
        assert_int_equal(recording.frames, 2); /* one was drawn again */
        CHECK_STATUS(recording_close(&recording), STATUS_OK);
    }
    CHECK(exists(in_folder("frames/frame_000000.png")));
    CHECK(exists(in_folder("frames/frame_000012.png")));
    canvas_free(&canvas);
}

/* Which file, and why: of the first failure. */
static void check_reason(const Recording *recording, const char *name,
                         int reason)
{
    char line[512];
    snprintf(line, sizeof line, "%s: %s", name, strerror(reason));
    assert_string_equal(recording->message, line);
}

TEST(recording_failures_name_the_file)
{
    static Recording recording;
    const char *file = in_folder("a_file"), *none = in_folder("none/s.csv");
    write_text(file, "text");
    Options options = simulate("square")->options;
    options.frames = file;
    CHECK_STATUS(recording_open(&options, 1, &recording), STATUS_FILE_FAILED);
    check_reason(&recording, file, ENOTDIR);
    recording_close(&recording);
    options.frames = NULL;
    options.states = none;
    CHECK_STATUS(recording_open(&options, 1, &recording), STATUS_FILE_FAILED);
    check_reason(&recording, none, ENOENT);
    recording_close(&recording);
    options.states = "/dev/full";
    options.log = file;
    CHECK_STATUS(recording_open(&options, 1, &recording), STATUS_OK);
    CHECK(unlink(file) == 0 && mkdir(file, 0700) == 0);
    CHECK_STATUS(recording_close(&recording), STATUS_FILE_FAILED);
    check_reason(&recording, "/dev/full", ENOSPC);
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

TESTS(make_test_folder, remove_test_folder)
