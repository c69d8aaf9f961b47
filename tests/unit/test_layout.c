/* Where everything in the window is, and its texts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "picture/layout.h"
#include "picture/text.h"
#include "test.h"

static const int sizes[][2] = {{1280, 800},  {900, 900},  {1366, 768},
                               {3840, 2160}, {400, 300},  {200, 200},
                               {1, 1},       {300, 4000}, {4000, 200}};
enum { SIZES = sizeof sizes / sizeof *sizes };

static LayoutWish full_wish(void)
{
    LayoutWish wish = {.panes = 1, .cards = 4, .large = -1, .settings = 9};
    for (int i = 0; i < wish.cards; i++) {
        wish.weight[i] = 1 + i;
        wish.least[i] = 6;
    }
    for (int i = 0; i < wish.settings; i++)
        wish.setting_letters[i] = 5 + 2 * i;
    wish.chips = 9;
    for (int i = 0; i < wish.chips; i++)
        wish.chip_letters[i] = 8 + i;
    return wish;
}

static bool boxes_overlap(Box a, Box b)
{
    return a.width > 0 && b.width > 0 && a.x < b.x + b.width &&
           b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

static bool box_inside(Box inner, Box outer)
{
    return inner.width <= 0 ||
           (inner.x >= outer.x && inner.y >= outer.y &&
            inner.x + inner.width <= outer.x + outer.width &&
            inner.y + inner.height <= outer.y + outer.height);
}

/* Boxes of one kind lie in their zone and apart from each other. */
static void check_boxes(const Box *boxes, int count, Box zone)
{
    for (int i = 0; i < count; i++) {
        CHECK(boxes[i].width > 0 && box_inside(boxes[i], zone));
        for (int j = 0; j < i; j++)
            CHECK(!boxes_overlap(boxes[i], boxes[j]));
    }
}

/* Chips lie in the last line; those without room have no width and are
 * counted; the last one, which tells of all keys, is there wherever the line
 * is. */
static void check_chips(const Layout *l, int wished)
{
    int out = 0;
    if (l->last.width <= 0 || l->last.height <= 0)
        return;
    CHECK(l->chips == wished && l->chip[wished - 1].width > 0);
    for (int i = 0; i < l->chips; i++) {
        out += l->chip[i].width <= 0;
        CHECK(box_inside(l->chip[i], l->last));
        for (int j = 0; j < i; j++)
            CHECK(!boxes_overlap(l->chip[i], l->chip[j]));
        if (i > 0 && i < l->chips - 1 && l->chip[i - 1].width <= 0)
            CHECK(l->chip[i].width <= 0); /* the first ones stay */
    }
    CHECK(out == l->chips_left_out);
}

/* Zones tile the window: areas add up, nothing overlaps; parts lie inside. */
TEST(zones_tile_every_size)
{
    for (int s = 0; s < SIZES; s++)
        for (int panes = 1; panes <= LAYOUT_PANES; panes++) {
            LayoutWish wish = full_wish();
            wish.panes = panes;
            Layout l = layout_create(sizes[s][0], sizes[s][1], &wish);
            const Box zones[] = {l.strip, l.stage, l.column,
                                 l.row,   l.time,  l.last};
            const Box window = {0, 0, l.width, l.height};
            long area = 0;
            for (int i = 0; i < 6; i++) {
                CHECK(box_inside(zones[i], window));
                area += (long)zones[i].width * zones[i].height;
                for (int j = 0; j < i; j++)
                    CHECK(!boxes_overlap(zones[i], zones[j]));
            }
            CHECK(area == (long)l.width * l.height);
            CHECK(l.panes == panes);
            if (l.width >= 200)
                check_boxes(l.pane, l.panes, l.stage);
            check_boxes(l.card, l.cards, l.column);
            check_boxes(l.setting, l.settings, l.row);
            check_chips(&l, wish.chips);
            CHECK(box_inside(l.bars, window));
        }
}

/* What a lecture's screen must have, and what a stamp must not. */
TEST(sizes_fold)
{
    LayoutWish wish = full_wish();
    for (int s = 0; s < 4; s++) {
        Layout l = layout_create(sizes[s][0], sizes[s][1], &wish);
        CHECK(l.cards == 4 && l.settings == 9);
        CHECK(l.chips - l.chips_left_out >= 7);
        CHECK(l.em >= 12 && l.stage.width >= 0.5 * l.width);
    }
    for (int i = 0; i < wish.chips; i++)
        wish.chip_letters[i] = 7 + i;
    Layout close = layout_create(900, 900, &wish); /* they move together */
    CHECK(close.chips_left_out == 0);
    Layout small = layout_create(400, 300, &wish);
    CHECK(small.cards == 0 && small.settings == 0);
    CHECK(small.chips_left_out > 0 && small.chip[small.chips - 1].width > 0);
    CHECK(small.stage.width == 400 && small.stage.height > 200);
    wish.setting_letters[0] = 400; /* wider than the window: the first line */
    Layout wide = layout_create(900, 900, &wish);
    CHECK(wide.settings > 1 && wide.setting[1].y > wide.setting[0].y);
    CHECK(wide.setting[0].y < wide.row.y + wide.em);
    wish.bare = true;
    Layout bare = layout_create(900, 900, &wish);
    CHECK(bare.stage.width == 900 && bare.stage.height == 900);
    CHECK(layout_hit(&bare, 450, 899).zone == ZONE_STAGE);
}

static bool hits(const Layout *layout, double x, double y, Zone zone, int index)
{
    Hit hit = layout_hit(layout, x, y);
    return hit.zone == zone && hit.index == index;
}

/* Every box is hit at its middle and its first and last pixels, and not beside
 * them (a card's upper right corner closes it). */
TEST(hits_are_what_is_there)
{
    LayoutWish wish = full_wish();
    wish.panes = 5;
    wish.closed = 2;
    Layout l = layout_create(1280, 800, &wish);
    const Box *const lists[] = {l.pane, l.card, l.setting, l.chip};
    const int counts[] = {l.panes, l.cards, l.settings, l.chips};
    const Zone zones[] = {ZONE_STAGE, ZONE_CARD, ZONE_SETTING, ZONE_CHIP};
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < counts[k]; i++) {
            Box box = lists[k][i];
            int right = box.x + box.width, low = box.y + box.height;
            double middle = box.x + 0.5 * box.width;
            CHECK(hits(&l, middle, box.y + 0.5 * box.height, zones[k], i));
            CHECK(hits(&l, box.x, box.y, zones[k], i));
            CHECK(hits(&l, box.x, low - 1, zones[k], i));
            CHECK(k == 1 || hits(&l, right - 1, box.y, zones[k], i));
            CHECK(!hits(&l, box.x - 1, box.y, zones[k], i));
            CHECK(!hits(&l, right, low - 1, zones[k], i));
            CHECK(!hits(&l, middle, box.y - 1, zones[k], i));
            CHECK(!hits(&l, middle, low, zones[k], i));
        }
    CHECK(l.card[1].height < l.card[0].height);
    for (int i = 0; i < l.cards; i++) {
        Box close = layout_close_box(&l, i);
        Hit hit = layout_hit(&l, close.x + 2, close.y + 2);
        CHECK(hit.zone == ZONE_CARD_CLOSE && hit.index == i);
    }
    CHECK(layout_hit(&l, 640, 5).zone == ZONE_STRIP);
    CHECK(layout_hit(&l, 640, l.time.y + 1).zone == ZONE_TIME);
    CHECK(layout_hit(&l, -1, -1).zone == ZONE_NONE);
    CHECK(layout_time_part(&l, l.bars.x) == 0);
    CHECK(layout_time_part(&l, l.bars.x + l.bars.width) == 1);
    CHECK(layout_time_part(&l, 1e9) == 1 && layout_time_part(&l, -1e9) == 0);
}

/* A large card has the room; a page has it all. */
TEST(cards_share_the_column)
{
    LayoutWish wish = full_wish();
    Layout even = layout_create(1280, 800, &wish);
    CHECK(even.card[3].height > even.card[0].height);
    wish.large = 0;
    Layout large = layout_create(1280, 800, &wish);
    for (int i = 1; i < 4; i++)
        CHECK(large.card[0].height > 5 * large.card[i].height);
    wish.large = -1;
    wish.half = 6;
    Layout pair = layout_create(1280, 800, &wish);
    CHECK(pair.card[1].y == pair.card[2].y);
    CHECK(pair.card[1].width < 0.5 * pair.card[0].width);
    CHECK(pair.card[0].height > even.card[0].height);
    check_boxes(pair.card, pair.cards, pair.column);
    wish.closed = 4;
    Layout apart = layout_create(1280, 800, &wish);
    CHECK(apart.card[1].y < apart.card[2].y);
    CHECK(layout_create(900, 900, &wish).card[1].y <
          layout_create(900, 900, &wish).card[2].y);
    wish.page = true;
    Layout page = layout_create(1280, 800, &wish);
    CHECK(page.cards == 0 && page.column.width == even.column.width);
    CHECK(layout_hit(&page, page.column.x + 9, page.column.y + 9).zone ==
          ZONE_PAGE);
}

/* There and back; zooming keeps the point under the mouse. */
TEST(lenses_keep_the_point)
{
    const Box box = {100, 50, 700, 500};
    const double bounds[4] = {-1, -2, 3, 2};
    for (int stretched = 0; stretched < 2; stretched++) {
        Lens lens = LENS_FITS;
        Camera camera = camera_create(box, bounds, stretched, &lens);
        double world[2] = {1, 0}, pixel[2], after[2];
        camera_pixel(&camera, world, pixel);
        CHECK_NEAR(pixel[0], 450, 1e-12);
        CHECK_NEAR(pixel[1], 300, 1e-12);
        CHECK(stretched == (camera.scale[0] != camera.scale[1]));
        camera_world(&camera, 333, 222, world);
        for (int i = 0; i < 5; i++) {
            lens_zoom(&lens, box, bounds, stretched, 333, 222, 1.7);
            camera = camera_create(box, bounds, stretched, &lens);
            camera_pixel(&camera, world, after);
            CHECK_NEAR(after[0], 333, 1e-9);
            CHECK_NEAR(after[1], 222, 1e-9);
        }
        CHECK_NEAR(lens.zoom, 14.19857, 1e-6);
        lens_move(&lens, box, 10, -20);
        camera = camera_create(box, bounds, stretched, &lens);
        camera_pixel(&camera, world, after);
        CHECK_NEAR(after[0], 343, 1e-9);
        CHECK_NEAR(after[1], 202, 1e-9);
    }
}

/* ---- texts -------------------------------------------------------------- */

static double ink(const Canvas *canvas)
{
    double sum = 0;
    for (int i = 0; i < canvas->width * canvas->height; i++)
        sum += 255 - (canvas->pixels[i] & 255);
    return sum;
}

/* Mathematics adds what it should: scripts are small, marks take no room,
 * letters have their colours, braces that mean nothing stay. */
TEST(markup_is_set)
{
    Text *text = NULL;
    Canvas canvas;
    TextStyle style = {FACE_REGULAR, 20, 0xff000000, false};
    assert_int_equal(text_create(&text), 0);
    assert_int_equal(canvas_create(400, 60, &canvas), 0);
    int x = text_width(text, &style, "x");
    CHECK(x > 0 && text_width(text, &style, "xx") == 2 * x);
    CHECK(text_width(text, &style, "x\u0303") == x);
    CHECK(text_width(text, &style, "{xt}") == x);
    int script = text_width(text, &style, "x^{x}");
    CHECK(script > x + x / 2 && script < 2 * x);
    CHECK(text_width(text, &style, "x_{x^{x}}") > script);
    CHECK(text_width(text, &style, "{a}") > 2 * x);
    CHECK(text_width(text, &style, "x^{") == x);
    style.plain = true;
    CHECK(text_width(text, &style, "{x}") > 2 * x);
    style.plain = false;
    if (text) {
        canvas_clear(&canvas, 0xffffffff);
        text_draw(text, &canvas, &style, 0, 0, ALIGN_LEFT, "{p}");
        double blue = 0, red = 0;
        for (int i = 0; i < 400 * 60; i++) {
            blue += 255 - (canvas.pixels[i] & 255);
            red += 255 - (canvas.pixels[i] >> 16 & 255);
        }
        CHECK(blue > 2 * red && red > 0); /* orange keeps its red */
    }
    canvas_free(&canvas);
    text_free(text);
}

/* A mark stands just above its letter, a low one or a tall one. */
TEST(marks_stand_above_letters)
{
    enum { SIZE = 20, HIGH = 40, WIDE = 40 };
    static const char *const pairs[][2] = {{"x", "x\u0303"}, {"E", "E\u0303"}};
    Text *text = NULL;
    Canvas with, plain;
    TextStyle style = {FACE_REGULAR, SIZE, 0xff000000, false};
    assert_int_equal(text_create(&text), 0);
    assert_int_equal(canvas_create(WIDE, HIGH, &with), 0);
    assert_int_equal(canvas_create(WIDE, HIGH, &plain), 0);
    for (int k = 0; k < 2 && text; k++) {
        int letter = HIGH, top = HIGH, low = 0; /* rows */
        canvas_clear(&with, 0xffffffff);
        canvas_clear(&plain, 0xffffffff);
        text_draw(text, &plain, &style, 9, 9, ALIGN_LEFT, pairs[k][0]);
        text_draw(text, &with, &style, 9, 9, ALIGN_LEFT, pairs[k][1]);
        for (int i = HIGH * WIDE - 1; i >= 0; i--) {
            if (plain.pixels[i] != 0xffffffff)
                letter = i / WIDE;
            if (with.pixels[i] == plain.pixels[i])
                continue;
            top = i / WIDE;
            low = low ? low : top;
        }
        CHECK(top <= low && low < letter - 1 && low > letter - SIZE / 3);
    }
    canvas_free(&with);
    canvas_free(&plain);
    text_free(text);
}

/* Clipped at every edge; wrong UTF-8 and sizes that cannot be are harmless. */
TEST(texts_are_clipped)
{
    Text *text = NULL;
    Canvas canvas;
    assert_int_equal(text_create(&text), 0);
    assert_int_equal(canvas_create(50, 20, &canvas), 0);
    for (double size = 4; size < 500; size *= 3) {
        TextStyle style = {FACE_BOLD, size, 0xff000000, false};
        for (int y = -30; y <= 20; y += 10)
            for (int x = -300; x <= 60; x += 30) {
                text_draw(text, &canvas, &style, x, y, (Align)((x + 300) % 3),
                          "wrong \xff\xc3 \xe2\x82 ^{_{}}}{ \xf5");
                text_draw(text, &canvas, &style, x, y, ALIGN_RIGHT, "");
            }
        for (double far = 1e5; far < 1e300; far *= 1e5) {
            int width =
                text_draw(text, &canvas, &style, far, -far, ALIGN_LEFT, "x");
            CHECK(width == text_width(text, &style, "x"));
            CHECK(width == text_draw(text, &canvas, &style, -far, NAN,
                                     ALIGN_RIGHT, "x"));
        }
    }
    text_free(text);
    canvas_free(&canvas);
}

/* Without a font nothing is drawn, and everything has a width. */
TEST(no_font_is_no_failure)
{
    const char *was = getenv("ELASTO_FONT");
    char *kept = was ? strdup(was) : NULL;
    Text *text = (Text *)1;
    Canvas canvas;
    TextStyle style = {FACE_REGULAR, 20, 0xff000000, false};
    assert_int_equal(canvas_create(100, 40, &canvas), 0);
    setenv("ELASTO_FONT", "", 1);
    CHECK_STATUS(text_create(&text), STATUS_OK);
    CHECK(text == NULL);
    CHECK(text_draw(text, &canvas, &style, 0, 0, ALIGN_LEFT, "abc") == 36);
    CHECK(ink(&canvas) == 0);
    text_free(text);
    if (kept)
        setenv("ELASTO_FONT", kept, 1);
    else
        unsetenv("ELASTO_FONT");
    free(kept);
    canvas_free(&canvas);
}

TESTS(NULL, NULL)
