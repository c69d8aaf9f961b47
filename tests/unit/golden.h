/* golden.h - compares frames of a player with pictures of tests/data. */
#ifndef ELASTO_GOLDEN_H
#define ELASTO_GOLDEN_H

#include "attended.h"

#include <png.h>
#include <sys/stat.h>

enum { SIDE = 900 }; /* width and height of a golden picture, pixels */

/* Reads a PNG file as pixels 0xffRRGGBB; free it with canvas_free. */
static inline Canvas read_png(const char *name)
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

static inline int find_colour_difference(Colour a, Colour b)
{
    int largest = 0;
    for (int shift = 0; shift < 24; shift += 8) {
        int d = (int)(a >> shift & 255) - (int)(b >> shift & 255);
        largest = abs(d) > largest ? abs(d) : largest;
    }
    return largest;
}

/* Marks pixels near words: words are where the frames differ, and their shapes
 * depend on FreeType's version. mask [SIDE SIDE] out */
static inline void mask_words(const Canvas *words, const Canvas *plain,
                              unsigned char *mask)
{
    enum { WORD_MARGIN_X = 24, WORD_MARGIN_Y = 4 };
    memset(mask, 0, SIDE * SIDE);
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            if (words->pixels[SIDE * j + i] == plain->pixels[SIDE * j + i])
                continue;
            for (int b = j - WORD_MARGIN_Y; b <= j + WORD_MARGIN_Y; b++)
                for (int a = i - WORD_MARGIN_X; a <= i + WORD_MARGIN_X; a++)
                    if (a >= 0 && b >= 0 && a < SIDE && b < SIDE)
                        mask[SIDE * b + a] = 1;
        }
}

/* Paints the present frame, with and without words; free both. */
static inline void paint_frame_pair(Canvas frame[2])
{
    /* This font measures the words of both frames. */
    if (!player.screen.paper.font)
        assert_int_equal(font_create(&player.screen.paper.font), 0);
    for (int plain = 0; plain < 2; plain++) {
        Paper paper;
        assert_int_equal(paper_create(SIDE, SIDE, &paper), 0);
        if (plain) {
            font_free(paper.font);
            paper.font = NULL;
        }
        player_paint_frame(&player, &paper);
        frame[plain] = paper.canvas;
        paper.canvas = (Canvas){0};
        paper_free(&paper);
    }
}

/* Counts the pixels away from words that differ from a picture by more than 4
 * of 255, and frees the frames. */
static inline int count_differing_pixels(const char *file, Canvas frame[2])
{
    static unsigned char mask[SIDE * SIDE];
    struct stat info;
    int far = 0, compared = 0;
    Canvas reference = read_png(file);
    assert_int_equal(reference.width, SIDE);
    assert_int_equal(reference.height, SIDE);
    mask_words(&frame[0], &frame[1], mask);
    for (int i = 0; i < SIDE * SIDE; i++)
        if (!mask[i]) {
            far += find_colour_difference(frame[0].pixels[i],
                                          reference.pixels[i]) > 4;
            compared++;
        }
    CHECK(compared > SIDE * SIDE / 2);
    canvas_free(&reference);
    canvas_free(&frame[0]);
    canvas_free(&frame[1]);
    assert_int_equal(stat(file, &info), 0);
    CHECK(info.st_size < 250000);
    return far;
}

#endif
