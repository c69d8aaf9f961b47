/* test_layout.c - places of the parts of the window, and texts */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "letters.h"
#include "picture/cards.h"
#include "test.h"

static const int sizes[][2] = {{1280, 800},  {900, 900},  {1366, 768},
                               {3840, 2160}, {400, 300},  {200, 200},
                               {1, 1},       {300, 4000}, {4000, 200}};
enum { WINDOW_SIZE_COUNT = sizeof sizes / sizeof *sizes };
enum {
    LISTING_CARD = 1,
    LINE_CARD,
    RESIDUAL_CARD,
    ENERGY_CARD,
    ASSEMBLY_CARD,
    SHOWN_CARD_COUNT = 5
}; /* indices of the cards that are shown */

static Simulation simulation;
static FrameContent content;

static void fill_frame_content(void)
{
    frame_create(&simulation, &content);
    frame_compute_values(&content);
    for (int i = 0; i < 9; i++) {
        content.settings.item[i].min_letters = 4 + 2 * i;
        content.chips.chip[i] = (Chip){"Tab", "", false};
        memset(content.chips.chip[i].label, '.', (size_t)i + 4);
    }
    content.settings.count = content.chips.count = 9;
}

static bool boxes_overlap(Box a, Box b)
{
    return a.width > 0 && b.width > 0 && a.x < b.x + b.width &&
           b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

static bool box_is_inside(Box inner, Box outer)
{
    return inner.width <= 0 ||
           (inner.x >= outer.x && inner.y >= outer.y &&
            inner.x + inner.width <= outer.x + outer.width &&
            inner.y + inner.height <= outer.y + outer.height);
}

/* Checks that boxes lie in their zone without overlap. Counts the boxes. */
static int check_boxes(const Box *boxes, int count, Box zone)
{
    int there = 0;
    for (int i = 0; i < count; i++) {
        there += boxes[i].width > 0;
        CHECK(box_is_inside(boxes[i], zone));
        for (int j = 0; j < i; j++)
            CHECK(!boxes_overlap(boxes[i], boxes[j]));
    }
    return there;
}

/* Checks that chips lie in the last line. Chips without room are counted and
 * have no width; the last chip, for the list of all keys, always has room. */
static void check_chips(const Layout *l, int wished)
{
    int out = 0;
    if (l->chip_row.width <= 0 || l->chip_row.height <= 0)
        return;
    CHECK(l->chip_count == wished && l->chip[wished - 1].width > 0);
    for (int i = 0; i < l->chip_count; i++) {
        out += l->chip[i].width <= 0;
        if (i > 0 && i < l->chip_count - 1 && l->chip[i - 1].width <= 0)
            CHECK(l->chip[i].width <= 0); /* no chip after a left-out chip */
    }
    CHECK(out == l->omitted_chips);
    CHECK(check_boxes(l->chip, l->chip_count, l->chip_row) ==
          l->chip_count - out);
}

/* Zones tile the window without overlap, and contain their parts. */
TEST(zones_tile_every_size)
{
    fill_frame_content();
    for (int s = 0; s < WINDOW_SIZE_COUNT; s++)
        for (content.panes = 1; content.panes <= LAYOUT_MAX_PANES;
             content.panes++) {
            Layout l = layout_create(&content, sizes[s][0], sizes[s][1]);
            const Box zones[] = {l.title_bar,    l.stage,     l.column,
                                 l.settings_row, l.time_line, l.chip_row};
            const Box window = {0, 0, l.width, l.height};
            long area = 0;
            for (int i = 0; i < 6; i++)
                area += (long)zones[i].width * zones[i].height;
            check_boxes(zones, 6, window);
            CHECK(area == (long)l.width * l.height);
            CHECK(l.pane_count == content.panes);
            if (l.width >= 200)
                CHECK(check_boxes(l.pane, l.pane_count, l.stage) ==
                      l.pane_count);
            CHECK(check_boxes(l.card, l.card_count, l.column) ==
                  (l.card_count ? SHOWN_CARD_COUNT : 0));
            CHECK(check_boxes(l.setting, l.setting_count, l.settings_row) ==
                  l.setting_count);
            check_chips(&l, content.chips.count);
            CHECK(box_is_inside(l.step_bars, window));
        }
}

static bool click_hits_zone(const Layout *layout, double x, double y,
                            WindowZone zone, int index)
{
    WindowHit hit = layout_find_hit(layout, x, y);
    return hit.zone == zone && hit.index == index;
}

/* A click hits a box at its middle and its first and last pixels, and not
 * beside them. */
TEST(a_click_hits_the_part_that_is_drawn_there)
{
    fill_frame_content();
    content.panes = 5;
    content.cards.closed_cards |= 1 << LISTING_CARD;
    Layout l = layout_create(&content, 1280, 800);
    const Box *const lists[] = {l.pane, l.card, l.setting, l.chip};
    const int counts[] = {l.pane_count, l.card_count, l.setting_count,
                          l.chip_count};
    const WindowZone zones[] = {ZONE_STAGE, ZONE_CARD, ZONE_SETTING, ZONE_CHIP};
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < counts[k]; i++) {
            Box box = lists[k][i];
            if (box.width == 0)
                continue;
            int right = box.x + box.width, low = box.y + box.height;
            double middle = box.x + 0.5 * box.width;
            CHECK(click_hits_zone(&l, middle, box.y + 0.5 * box.height,
                                  zones[k], i));
            CHECK(click_hits_zone(&l, box.x, box.y, zones[k], i));
            CHECK(click_hits_zone(&l, box.x, low - 1, zones[k], i));
            CHECK(k == 1 || click_hits_zone(&l, right - 1, box.y, zones[k], i));
            CHECK(!click_hits_zone(&l, box.x - 1, box.y, zones[k], i));
            CHECK(!click_hits_zone(&l, right, low - 1, zones[k], i));
            CHECK(!click_hits_zone(&l, middle, box.y - 1, zones[k], i));
            CHECK(!click_hits_zone(&l, middle, low, zones[k], i));
        }
    CHECK(l.card[LISTING_CARD].height < l.card[LINE_CARD].height);
    CHECK(layout_find_hit(&l, -1, -1).zone == ZONE_NONE);
}

/* Zooming keeps the point under the mouse; panning moves it. */
TEST(zoom_keeps_the_point_under_the_mouse)
{
    const Box box = {100, 50, 700, 500};
    const double bounds[4] = {-1, -2, 3, 2};
    for (int stretched = 0; stretched < 2; stretched++) {
        Lens lens = LENS_FITS;
        Camera camera = camera_create(box, bounds, stretched, &lens);
        double world[2] = {1, 0}, pixel[2], after[2];
        camera_to_pixel(&camera, world, pixel);
        CHECK_NEAR(pixel[0], 450, 1e-12);
        CHECK_NEAR(pixel[1], 300, 1e-12);
        CHECK(stretched == (camera.scale[0] != camera.scale[1]));
        camera_to_world(&camera, 333, 222, world);
        for (int i = 0; i < 5; i++) {
            lens_zoom(&lens, box, 333, 222, 1.7);
            camera = camera_create(box, bounds, stretched, &lens);
            camera_to_pixel(&camera, world, after);
            CHECK_NEAR(after[0], 333, 1e-9);
            CHECK_NEAR(after[1], 222, 1e-9);
        }
        CHECK_NEAR(lens.zoom, 14.19857, 1e-6);
        lens_pan(&lens, box, 10, -20);
        camera = camera_create(box, bounds, stretched, &lens);
        camera_to_pixel(&camera, world, after);
        CHECK_NEAR(after[0], 343, 1e-9);
        CHECK_NEAR(after[1], 202, 1e-9);
    }
}

/* ---- texts -------------------------------------------------------------- */

static Font *text;
static Canvas canvas;
static const TextStyle style = {FACE_REGULAR, 20, 0xff000000, false, 0};

static int create_texts(void **unused)
{
    (void)unused;
    simulation_from_line("square", NULL, NULL, &simulation);
    return font_create(&text) || canvas_create(300, 120, &canvas);
}

static int free_texts(void **unused)
{
    (void)unused;
    font_free(text);
    canvas_free(&canvas);
    simulation_free(&simulation);
    return 0;
}

/* Exponents and indices are small, accents have no width, {unknown} stays. */
TEST(markup_has_expected_widths)
{
    static const struct {
        const char *markup;
        double min_width, max_width; /* unit: width of the letter x */
        bool is_plain;
    } rows[] = {
        {"xx", 2, 2, false},           {"x\u0303", 1, 1, false},
        {"{xt}", 1, 1, false},         {"x^{x}", 1.5, 1.99, false},
        {"x_{x^{x}}", 1.99, 3, false}, {"{a}", 2.01, 9, false},
        {"x^{", 1, 1, false},          {"{x}", 1, 1, false},
        {"{x}", 2.01, 9, true},
    };
    double x = text_measure(text, &style, "x").width;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        TextStyle same = style;
        same.is_plain = rows[i].is_plain;
        double width = text_measure(text, &same, rows[i].markup).width;
        CHECK(width >= rows[i].min_width * x && width <= rows[i].max_width * x);
    }
}

/* Appends measures of a formula's picture to a line: ink in red, green and
 * blue, centre of the ink (pixels), and extent of the formula. */
static void append_formula_metrics(const TextStyle *like, const char *markup,
                                   char *line)
{
    double ink[3] = {0}, at[2] = {0};
    Font *boxes = (Font *)line; /* dummy: boxes instead of a font */
    TextExtent extent = text_measure(boxes, like, markup);
    canvas_clear(&canvas, 0xffffffff);
    CHECK(text_draw(boxes, &canvas, like, 9, 40, ALIGN_LEFT, markup) ==
          (int)extent.width);
    for (int i = 0; i < 3 * canvas.width * canvas.height; i++) {
        int p = i / 3, lack = 255 - (canvas.pixels[p] >> i % 3 * 8 & 255);
        ink[i % 3] += lack / 255.0;
        at[0] += p % canvas.width * lack / 255.0;
        at[1] += (double)(p / canvas.width) * lack / 255;
    }
    double all = fmax(ink[0] + ink[1] + ink[2], 1e-9);
    append(line, 256, "%.1f %.1f %.1f at %.2f %.2f, %.0f %.2f %.2f | ", ink[2],
           ink[1], ink[0], at[0] / all, at[1] / all, extent.width,
           extent.ascent, extent.descent);
}

/* Each formula of tests/data/formulas.txt looks as recorded: in 20 pixels, and
 * in 14 with exponents of at least 13.  PICTURES=1 writes the file anew. */
TEST(formulas_are_drawn_as_before)
{
    static const TextStyle small = {FACE_BOLD, 14, 0xff000000, false, 13};
    static char was[99][256];
    char is[256];
    int lines = 0;
    FILE *file = fopen("tests/data/formulas.txt", "r+");
    for (; lines < 98 && fgets(was[lines], sizeof *was, file); lines++)
        was[lines][strcspn(was[lines], "\n")] = '\0';
    rewind(file);
    letters_are_boxes = true;
    for (int i = 0; i < lines; i++) {
        const char *bar = strrchr(was[i], '|');
        const char *markup = bar ? bar + 2 : was[i];
        is[0] = '\0';
        append_formula_metrics(&style, markup, is);
        append_formula_metrics(&small, markup, is);
        append(is, sizeof is, "%s", markup);
        if (getenv("PICTURES"))
            fprintf(file, "%s\n", is);
        else
            assert_string_equal(is, was[i]);
    }
    letters_are_boxes = false;
    fclose(file);
}

/* Texts are clipped; wrong UTF-8 and impossible sizes are harmless. */
TEST(texts_are_clipped)
{
    for (double size = 4; size < 500; size *= 3) {
        TextStyle bold = {FACE_BOLD, size, 0xff000000, false, 0};
        for (int y = -80; y <= 60; y += 20)
            for (int x = -300; x <= 120; x += 30) {
                text_draw(text, &canvas, &bold, x, y, (Align)((x + 300) % 3),
                          "wrong \xff\xc3 \xe2\x82 ^{_{}}}{ \xf5");
                text_draw(text, &canvas, &bold, x, y, ALIGN_RIGHT, "");
            }
        for (double far = 1e5; far < 1e300; far *= 1e5) {
            double width = text_measure(text, &bold, "x").width;
            CHECK(width ==
                  text_draw(text, &canvas, &bold, far, -far, ALIGN_LEFT, "x"));
            CHECK(width ==
                  text_draw(text, &canvas, &bold, -far, NAN, ALIGN_RIGHT, "x"));
        }
    }
}

/* Without a font nothing is drawn, but texts have widths. */
TEST(without_a_font_nothing_fails)
{
    const char *was = getenv("ELASTO_FONT");
    char *kept = was ? strdup(was) : NULL;
    Font *none = (Font *)1;
    canvas_clear(&canvas, 0xffffffff);
    setenv("ELASTO_FONT", "", 1);
    CHECK_OK(font_create(&none));
    CHECK(none == NULL);
    CHECK(text_draw(none, &canvas, &style, 0, 0, ALIGN_LEFT, "abc") == 36);
    for (int i = 0; i < canvas.width * canvas.height; i++)
        CHECK(canvas.pixels[i] == 0xffffffff);
    unsetenv("ELASTO_FONT");
    if (kept)
        setenv("ELASTO_FONT", kept, 1);
    free(kept);
}

TESTS(create_texts, free_texts)
