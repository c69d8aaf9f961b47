/* Films: their chunks are those of the APNG specification, and what a reader
 * makes of them is what was drawn.
 */
#include "testing.h"

#include <png.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "play/film.h"

enum { WIDTH = 37, HEIGHT = 23, FRAMES = 9, FILE_SIZE = 1 << 20 };

static char folder[] = "/tmp/elasto-film-XXXXXX";
static uint8_t file_bytes[FILE_SIZE];

/* A picture of which only a part changes from frame to frame; 4 and 5 are the
 * same. */
static uint32_t pixel(int frame, int x, int y)
{
    int shown = frame == 5 ? 4 : frame;
    bool moves = x >= shown && x < shown + 6 && y >= 2 * shown && y < 20;
    uint32_t still = (uint32_t)(7 * x + 131 * y) & 0xffffff;
    return 0xff000000u |
           (moves ? (uint32_t)(shown * 1234567) & 0xffffff : still);
}

static void draw(int frame, Canvas *canvas)
{
    for (int y = 0; y < canvas->height; y++)
        for (int x = 0; x < canvas->width; x++)
            canvas->pixels[y * canvas->width + x] = pixel(frame, x, y);
}

static void file_name(const char *end, char *name, size_t size)
{
    snprintf(name, size, "%s/film%s", folder, end);
}

static void make_film(const char *name, int frames)
{
    Film film;
    Canvas canvas;
    char message[256];
    CHECK_STATUS(film_open(name, 60, &film, message, sizeof message),
                 STATUS_OK);
    CHECK_STATUS(canvas_create(WIDTH, HEIGHT, &canvas), STATUS_OK);
    for (int i = 0; i < frames; i++) {
        draw(i, &canvas);
        CHECK_STATUS(film_add(&film, &canvas, i == 3 ? 30 : 1), STATUS_OK);
    }
    CHECK(access(name, F_OK) != 0); /* not before it is whole */
    CHECK_STATUS(film_close(&film), STATUS_OK);
    canvas_free(&canvas);
}

static size_t read_file(const char *name)
{
    FILE *file = fopen(name, "rb");
    CHECK(file != NULL);
    size_t size = fread(file_bytes, 1, FILE_SIZE, file);
    fclose(file);
    return size;
}

static uint32_t whole(const uint8_t *at)
{
    return png_get_uint_32(at);
}

/* CRC 32 as the PNG specification has it, bit by bit. */
static uint32_t check_sum(const uint8_t *data, size_t size)
{
    uint32_t c = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        c ^= data[i];
        for (int bit = 0; bit < 8; bit++)
            c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    }
    return ~c;
}

/* The chunks of one frame as a PNG of its own, decoded: [3 width height]. */
typedef struct Frame {
    uint32_t width, height, x, y;
    unsigned num, den;
    uint8_t data[1 << 16];
    size_t size;
} Frame;

static void put_chunk(FILE *file, const char *type, const uint8_t *data,
                      uint32_t size)
{
    static uint8_t bytes[1 << 17];
    uint8_t four[4];
    memcpy(bytes, type, 4);
    memcpy(bytes + 4, data, size);
    png_save_uint_32(four, size);
    fwrite(four, 1, 4, file);
    fwrite(bytes, 1, size + 4, file);
    png_save_uint_32(four, check_sum(bytes, size + 4));
    fwrite(four, 1, 4, file);
}

/* Draws the frame over what is on screen. */
static void render(const Frame *frame, uint8_t *screen)
{
    static uint8_t rgb[3 * WIDTH * HEIGHT];
    char name[128];
    file_name("-part.png", name, sizeof name);
    FILE *file = fopen(name, "wb");
    CHECK(file != NULL);
    uint8_t head[13] = {0};
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, file);
    png_save_uint_32(head, frame->width);
    png_save_uint_32(head + 4, frame->height);
    head[8] = 8;
    head[9] = 2;
    put_chunk(file, "IHDR", head, 13);
    put_chunk(file, "IDAT", frame->data, (uint32_t)frame->size);
    put_chunk(file, "IEND", head, 0);
    fclose(file);
    png_image image = {.version = PNG_IMAGE_VERSION};
    CHECK(png_image_begin_read_from_file(&image, name) != 0);
    image.format = PNG_FORMAT_RGB;
    CHECK(png_image_finish_read(&image, NULL, rgb, 0, NULL) != 0);
    for (uint32_t y = 0; y < frame->height; y++)
        memcpy(screen + 3 * ((frame->y + y) * WIDTH + frame->x),
               rgb + 3 * y * frame->width, 3 * frame->width);
    unlink(name);
}

static void check_screen(const uint8_t *screen, int frame)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const uint8_t *at = screen + 3 * (y * WIDTH + x);
            uint32_t got = (uint32_t)at[0] << 16 | (uint32_t)at[1] << 8 | at[2];
            CHECK((got | 0xff000000u) == pixel(frame, x, y));
        }
}

/* Frame by frame, as a reader of animated PNGs goes through the file. */
static void animated_pngs_show_what_was_drawn(void **unused)
{
    (void)unused;
    static uint8_t screen[3 * WIDTH * HEIGHT];
    static Frame frame;
    char name[128];
    file_name(".apng", name, sizeof name);
    make_film(name, FRAMES);
    size_t size = read_file(name), at = 8;
    uint32_t sequence = 0;
    int frames = 0;
    bool ended = false;
    CHECK(memcmp(file_bytes, "\x89PNG\r\n\x1a\n", 8) == 0);
    while (at < size) {
        const uint8_t *chunk = file_bytes + at, *data = chunk + 8;
        uint32_t length = whole(chunk);
        CHECK(!ended && at + 12 + length <= size);
        CHECK(whole(data + length) == check_sum(chunk + 4, length + 4));
        if (memcmp(chunk + 4, "acTL", 4) == 0)
            CHECK(length == 8 && whole(data) == FRAMES && at == 33);
        ended = memcmp(chunk + 4, "IEND", 4) == 0;
        if ((memcmp(chunk + 4, "fcTL", 4) == 0 || ended) && frames > 0) {
            render(&frame, screen);
            check_screen(screen, frames - 1);
            CHECK(frame.num == (frames == 4 ? 30u : 1u) && frame.den == 60);
        }
        if (memcmp(chunk + 4, "fcTL", 4) == 0) {
            CHECK(length == 26 && whole(data) == sequence++);
            frame = (Frame){whole(data + 4),
                            whole(data + 8),
                            whole(data + 12),
                            whole(data + 16),
                            (unsigned)(data[20] << 8 | data[21]),
                            (unsigned)(data[22] << 8 | data[23]),
                            {0},
                            0};
            CHECK(frame.x + frame.width <= WIDTH &&
                  frame.y + frame.height <= HEIGHT);
            CHECK(frames == 0 || frame.width < WIDTH);
            frames++;
        }
        bool later = memcmp(chunk + 4, "fdAT", 4) == 0;
        if (later)
            CHECK(whole(data) == sequence++);
        if (later || memcmp(chunk + 4, "IDAT", 4) == 0) {
            CHECK(later == (frames > 1));
            memcpy(frame.data + frame.size, data + 4 * later,
                   length - 4 * later);
            frame.size += length - 4 * later;
        }
        at += 12 + length;
    }
    CHECK(ended && frames == FRAMES);
    unlink(name);
}

/* A reader that knows no films shows the first frame. */
static void the_first_frame_is_a_picture(void **unused)
{
    (void)unused;
    static uint8_t screen[3 * WIDTH * HEIGHT];
    char name[128];
    file_name(".png", name, sizeof name);
    make_film(name, 3);
    png_image image = {.version = PNG_IMAGE_VERSION};
    CHECK(png_image_begin_read_from_file(&image, name) != 0);
    CHECK(image.width == WIDTH && image.height == HEIGHT);
    image.format = PNG_FORMAT_RGB;
    CHECK(png_image_finish_read(&image, NULL, screen, 0, NULL) != 0);
    check_screen(screen, 0);
    unlink(name);
}

/* Canvases of other sizes are cut off or filled up. */
static void sizes_may_change(void **unused)
{
    (void)unused;
    char name[128], message[256];
    file_name(".apng", name, sizeof name);
    Film film;
    CHECK_STATUS(film_open(name, 60, &film, message, sizeof message),
                 STATUS_OK);
    for (int i = 0; i < 3; i++) {
        Canvas canvas;
        CHECK_STATUS(canvas_create(20 + 9 * i, 30 - 9 * i, &canvas), STATUS_OK);
        CHECK_STATUS(film_add(&film, &canvas, 1), STATUS_OK);
        canvas_free(&canvas);
    }
    CHECK(film.width == 20 && film.height == 30);
    CHECK_STATUS(film_close(&film), STATUS_OK);
    CHECK(access(name, F_OK) == 0);
    unlink(name);
}

/* No frame, no file; a film that is thrown away leaves nothing. */
static void nothing_is_left_behind(void **unused)
{
    (void)unused;
    char name[128], part[160], message[256];
    file_name(".apng", name, sizeof name);
    snprintf(part, sizeof part, "%s.part", name);
    Film film;
    CHECK_STATUS(film_open(name, 60, &film, message, sizeof message),
                 STATUS_OK);
    CHECK(film_runs(&film) && access(part, F_OK) == 0);
    CHECK_STATUS(film_close(&film), STATUS_OK);
    CHECK(!film_runs(&film));
    CHECK(access(name, F_OK) != 0 && access(part, F_OK) != 0);
    Canvas canvas;
    CHECK_STATUS(canvas_create(8, 8, &canvas), STATUS_OK);
    CHECK_STATUS(film_open(name, 60, &film, message, sizeof message),
                 STATUS_OK);
    CHECK_STATUS(film_add(&film, &canvas, 1), STATUS_OK);
    film_discard(&film);
    CHECK(access(name, F_OK) != 0 && access(part, F_OK) != 0);
    canvas_free(&canvas);
}

static void other_names_are_refused(void **unused)
{
    (void)unused;
    static const char *const bad[] = {"film", "film.avi", ".apng", "film.mp4x"};
    char message[256];
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        Film film;
        CHECK_STATUS(film_open(bad[i], 60, &film, message, sizeof message),
                     STATUS_INVALID_INPUT);
        CHECK(strstr(message, bad[i]) && strstr(message, ".apng"));
        CHECK_STATUS(film_close(&film), STATUS_OK);
    }
}

/* Without ffmpeg in the path one line says what to install; a "ffmpeg" that
 * fails leaves no film. */
static void ffmpeg_may_be_missing_or_fail(void **unused)
{
    (void)unused;
    char name[128], part[160], program[128], message[256];
    char *path = strdup(getenv("PATH"));
    Film film;
    file_name(".mp4", name, sizeof name);
    snprintf(part, sizeof part, "%s.part", name);
    setenv("PATH", folder, 1);
    CHECK_STATUS(film_open(name, 60, &film, message, sizeof message),
                 STATUS_INVALID_INPUT);
    CHECK(strstr(message, "ffmpeg") && strstr(message, "install"));
    film_discard(&film);
    snprintf(program, sizeof program, "%s/ffmpeg", folder);
    FILE *file = fopen(program, "w");
    CHECK(file != NULL);
    fputs("#!/bin/sh\nexit 3\n", file);
    fclose(file);
    CHECK(chmod(program, 0755) == 0);
    Canvas canvas;
    CHECK_STATUS(canvas_create(640, 480, &canvas), STATUS_OK);
    CHECK_STATUS(film_open(name, 60, &film, message, sizeof message),
                 STATUS_OK);
    Status status = STATUS_OK;
    for (int i = 0; i < 5 && !status; i++)
        status = film_add(&film, &canvas, 1);
    Status closed = film_close(&film);
    CHECK(status == STATUS_FILE_FAILED || closed == STATUS_FILE_FAILED);
    CHECK(access(name, F_OK) != 0 && access(part, F_OK) != 0);
    canvas_free(&canvas);
    unlink(program);
    setenv("PATH", path, 1);
    free(path);
}

static int make_folder(void **unused)
{
    (void)unused;
    signal(SIGPIPE, SIG_IGN);
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **unused)
{
    (void)unused;
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(animated_pngs_show_what_was_drawn),
        cmocka_unit_test(the_first_frame_is_a_picture),
        cmocka_unit_test(sizes_may_change),
        cmocka_unit_test(nothing_is_left_behind),
        cmocka_unit_test(other_names_are_refused),
        cmocka_unit_test(ffmpeg_may_be_missing_or_fail),
    };
    return cmocka_run_group_tests_name("film", tests, make_folder,
                                       remove_folder);
}
