/* test_film.c - films of each format, read back: rate and pixels of frames */
#include "test.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "play/recording.h"

enum { WIDTH = 61, HEIGHT = 47, SIDE = 20, FRAME_COUNT = 8 };

static char folder[] = "/tmp/elasto-film-XXXXXX";

/* tolerance: allowed error of a channel, of 255. .apng and .gif keep so few
 * colours exactly. The other formats need even sizes; with a loss that no eye
 * sees (7 with ffmpeg 5.1), they are compared in the middle of the block. */
static const struct FilmRow {
    const char *name, *format; /* ffmpeg's name of the pixel format */
    double frame_rate;
    int tolerance, width, height;
} rows[] = {
    {"a film.apng", "rgb24", 60, 0, WIDTH, HEIGHT},
    {"x:y.gif", "bgra", 50, 0, WIDTH, HEIGHT},
    {"-film.mp4", "yuv420p", 60, 12, WIDTH + 1, HEIGHT + 1},
    {"film%03d.webm", "yuv420p", 60, 12, WIDTH + 1, HEIGHT + 1},
};
enum { FILM_ROW_COUNT = sizeof rows / sizeof *rows };

static uint32_t film_pixel(int frame, int x, int y)
{
    int i = frame == 5 ? 4 : frame; /* frames 4 and 5 are equal */
    bool inside = x >= i && x < i + SIDE && y >= 10 && y < 10 + SIDE;
    return inside ? 0xff0020c0u + 0x060000u * (uint32_t)i : 0xffffffffu;
}

static char message[MESSAGE_BYTES];

static Film open_film(const char *name)
{
    Film film;
    CHECK_OK(film_open(name, message, &film));
    return film;
}

/* Writes a film; two equal frames are added as one of double length. */
static void make_film(const char *name, int frames)
{
    Canvas canvas;
    Film film = open_film(name);
    CHECK_OK(canvas_create(WIDTH, HEIGHT, &canvas));
    for (int i = 0; i < frames; i += i == 4 ? 2 : 1) {
        for (int k = 0; k < WIDTH * HEIGHT; k++)
            canvas.pixels[k] = film_pixel(i, k % WIDTH, k / WIDTH);
        CHECK_OK(film_add_frame(&film, &canvas, i == 4 ? 2 : 1));
    }
    CHECK(film.frame_count == frames);
    CHECK(access(name, F_OK) != 0); /* the file appears when complete */
    CHECK_OK(film_close(&film, KEEP_FILE));
    canvas_free(&canvas);
}

static FILE *open_command_output(const char *format, const char *name)
{
    char line[512];
    snprintf(line, sizeof line, format, name);
    FILE *answer = popen(line, "r");
    assert_non_null(answer);
    return answer;
}

/* Reads the frames of a film as RGB, and returns their number. */
static int read_film(const char *name, int width, int height, uint8_t *bytes,
                     int most)
{
    size_t size = 3 * (size_t)width * (size_t)height;
    FILE *film = open_command_output(
        "ffmpeg -v error -i 'file:%s' -fps_mode passthrough -f "
        "rawvideo -pix_fmt rgb24 pipe:1 </dev/null",
        name);
    size_t read = fread(bytes, 1, size * (size_t)most, film);
    CHECK(pclose(film) == 0 && read % size == 0);
    return (int)(read / size);
}

/* Returns the frame rate, 1/s, from the times of the first and last frame. */
static double find_frame_rate(const char *name, int count)
{
    double first, last;
    FILE *times = open_command_output(
        "ffprobe -v error -show_entries packet=pts_time -of "
        "csv=p=0 'file:%s' | tr -d , | sort -g | sed -n '1p;$p'",
        name);
    CHECK(fscanf(times, "%lf %lf", &first, &last) == 2);
    CHECK(pclose(times) == 0);
    return (count - 1) / (last - first);
}

/* Checks the pixel format: all browsers play yuv420p, not all play others. */
static void check_format(const struct FilmRow *row)
{
    char format[16] = "";
    FILE *answer =
        open_command_output("ffprobe -v error -show_entries stream=pix_fmt -of "
                            "csv=p=0 'file:%s'",
                            row->name);
    CHECK(fscanf(answer, "%15[a-z0-9]", format) == 1 && pclose(answer) == 0);
    assert_string_equal(format, row->format);
}

static void check_frames(const struct FilmRow *row, const uint8_t *bytes,
                         int count)
{
    int wrong = 0;
    for (int i = 0; i < count; i++)
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                const uint8_t *at =
                    bytes + 3 * ((i * row->height + y) * row->width + x);
                uint32_t drawn = film_pixel(i, x, y);
                bool middle = x == i + SIDE / 2 && y == 10 + SIDE / 2;
                for (int c = 0; c < 3 && (row->tolerance == 0 || middle); c++)
                    wrong += abs(at[c] - (int)(drawn >> (16 - 8 * c) & 255)) >
                             row->tolerance;
            }
    if (wrong)
        print_error("%s: %d numbers of %d frames\n", row->name, wrong, count);
    CHECK(wrong == 0);
}

TEST(films_show_what_was_drawn)
{
    static uint8_t bytes[3 * (WIDTH + 1) * (HEIGHT + 1) * (FRAME_COUNT + 1)];
    for (int i = 0; i < FILM_ROW_COUNT + 1; i++) {
        const struct FilmRow *row = &rows[i % FILM_ROW_COUNT];
        int count = i < FILM_ROW_COUNT ? FRAME_COUNT : 1;
        make_film(row->name, count);
        int frames = read_film(row->name, row->width, row->height, bytes,
                               FRAME_COUNT + 1);
        assert_int_equal(frames, count);
        check_format(row);
        check_frames(row, bytes, frames);
        if (frames == FRAME_COUNT) /* a film of one frame has no rate */
            CHECK(fabs(find_frame_rate(row->name, frames) / row->frame_rate -
                       1) < 1e-2);
        CHECK(unlink(row->name) == 0);
    }
}

/* A larger canvas is cut off, a smaller one filled up with white. */
TEST(frames_may_change_their_size)
{
    static uint8_t bytes[3 * 20 * 30 * 3];
    Film film = open_film("sizes.apng");
    for (int i = 0; i < 3; i++) {
        Canvas canvas;
        CHECK_OK(canvas_create(20 + 9 * i, 30 - 9 * i, &canvas));
        for (int k = 0; k < canvas.width * canvas.height; k++)
            canvas.pixels[k] = 0xff121212u;
        CHECK_OK(film_add_frame(&film, &canvas, 1));
        canvas_free(&canvas);
    }
    CHECK_OK(film_close(&film, KEEP_FILE));
    assert_int_equal(read_film("sizes.apng", 20, 30, bytes, 3), 3);
    for (int i = 0; i < 3 * 30; i++) /* rows */
        for (int k = 0; k < 3 * 20; k++)
            CHECK(bytes[60 * i + k] ==
                  (i % 30 < 30 - 9 * (i / 30) ? 0x12 : 0xff));
    unlink("sizes.apng");
}

/* A film reports that ffmpeg has ended too early, and does not wait for it. */
TEST(the_end_of_ffmpeg_is_reported)
{
    Canvas canvas;
    CHECK_OK(canvas_create(WIDTH, HEIGHT, &canvas));
    Film film = open_film("dead.mp4");
    CHECK(unlink("dead.mp4.part") == 0 && mkdir("dead.mp4.part", 0700) == 0);
    Status status = STATUS_OK;
    for (int i = 0; i < 1000 && !status; i++)
        status = film_add_frame(&film, &canvas, 1);
    CHECK_STATUS(status, STATUS_FILE_FAILED);
    CHECK(strstr(message, "dead.mp4: ffmpeg ended"));
    CHECK_STATUS(film_close(&film, KEEP_FILE), STATUS_FILE_FAILED);
    CHECK(access("dead.mp4", F_OK) != 0);
    rmdir("dead.mp4.part");
    canvas_free(&canvas);
}

static int make_folder(void **unused)
{
    (void)unused;
    signal(SIGPIPE, SIG_IGN);
    if (system("ffprobe -version >/dev/null 2>&1") != 0) {
        puts("skipped films: no ffmpeg\n[  SKIPPED ] 5 test(s).");
        exit(0);
    }
    return mkdtemp(folder) ? chdir(folder) : -1;
}

static int remove_folder(void **unused)
{
    (void)unused;
    return rmdir(folder);
}

TESTS(make_folder, remove_folder)
