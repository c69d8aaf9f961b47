#include "picture/layout.h"

#include <math.h>
#include <stddef.h>

/* Sizes in ems, the size of the texts. */
static const double STRIP = 3.1, ROW = 2.6, TIME = 4.9, LAST = 3.0;
static const double GAP = 0.9;       /* between the zones' contents */
static const double TITLE_BAR = 2.0; /* a card of which only that is seen */
static const double LETTER = 0.56;   /* a letter is wide, on average */
static const double SETTING_LETTER = 0.53; /* the same in the row */
static const double SMALL_LETTER = 0.57;   /* there, of less than 11 pixels */
static const double SETTING_GAP = 0.9;     /* between settings */
static const double CHIP_PADDING = 1.8;    /* a chip has beside its letters */
static const double CHIP_PADDING_LEAST = 1.2;
static const double BARS = 2.4; /* the bars of the time line are high */
static const double COLUMN_LEAST = 27;
static const double PAIR_LEAST = 28; /* a column for two cards in a row */

/* Cards fold where the room is less than this part of what they need. */
static const double FOLDS = 1.15;

/* The column's part of the width. */
static const double COLUMN_PART = 0.38;

/* At 800 pixels of height an em has 14, and never less than 9. */
static const double EM_HEIGHT = 800, EM_WIDTH = 1000, EM_PIXELS = 14,
                    EM_LEAST = 9;

static int pixels(const Layout *layout, double ems)
{
    return (int)floor(ems * layout->em + 0.5);
}

Box box_column(Box box, int index, int count, int gap)
{
    int room = box.width - (count - 1) * gap;
    int left = (int)((long)room * index / count) + index * gap;
    int right = (int)((long)room * (index + 1) / count) + index * gap;
    return (Box){box.x + left, box.y, right - left, box.height};
}

Box box_inset(Box box, int margin)
{
    Box inner = {box.x + margin, box.y + margin, box.width - 2 * margin,
                 box.height - 2 * margin};
    inner.width = inner.width < 0 ? 0 : inner.width;
    inner.height = inner.height < 0 ? 0 : inner.height;
    return inner;
}

bool box_contains(Box box, double x, double y)
{
    return x >= box.x && x < box.x + box.width && y >= box.y &&
           y < box.y + box.height;
}

/* Takes a strip off the lower edge of `rest`. */
static Box cut_bottom(Box *rest, int height)
{
    rest->height -= height;
    return (Box){rest->x, rest->y + rest->height, rest->width, height};
}

/* Takes a strip off its upper edge. */
static Box cut_top(Box *rest, int height)
{
    Box top = {rest->x, rest->y, rest->width, height};
    rest->y += height;
    rest->height -= height;
    return top;
}

/* The settings in lines from the left; the lines they need, at most `most`:
 * the rest is left out.  Place them in layout->row, if it is there. */
static int place_settings(const LayoutWish *wish, Layout *layout, int most)
{
    int gap = pixels(layout, SETTING_GAP), line = 0;
    int left = pixels(layout, GAP + 0.5), x = left;
    int right = layout->width - pixels(layout, GAP);
    int height = pixels(layout, ROW - 0.4);
    double letter = layout->em < 11 ? SMALL_LETTER : SETTING_LETTER;
    layout->settings = 0;
    for (int i = 0; i < wish->settings && i < LAYOUT_SETTINGS; i++) {
        int width = pixels(layout, wish->setting_letters[i] * letter + 0.6);
        if (x + width > right && x > left) {
            line++;
            x = left;
        }
        if (line >= most)
            return most;
        layout->setting[layout->settings++] =
            (Box){x, layout->row.y + pixels(layout, 0.2) + line * height, width,
                  height};
        x += width + gap;
    }
    return line + 1;
}

/* Pixels of chips from the left with this room beside their letters; a chip
 * that does not fit has no width, but the last one always has. */
static void place_chips_with(const LayoutWish *wish, Layout *layout,
                             double padding)
{
    int gap = pixels(layout, 0.6), margin = pixels(layout, GAP), x = margin;
    int count = wish->chips < LAYOUT_CHIPS ? wish->chips : LAYOUT_CHIPS;
    int inset = pixels(layout, 0.35), width[LAYOUT_CHIPS] = {0};
    for (int i = 0; i < count; i++)
        width[i] =
            pixels(layout, wish->chip_letters[i] * LETTER * 0.92 + padding);
    int room = layout->width - 2 * margin - (count ? width[count - 1] : 0);
    bool full = false;
    layout->chips = count;
    layout->chips_left_out = 0;
    for (int i = 0; i < count; i++) {
        full = full || (i < count - 1 && x - margin + width[i] + gap > room);
        bool out = full && i < count - 1;
        layout->chip[i] = (Box){x, layout->last.y + inset, out ? 0 : width[i],
                                layout->last.height - 2 * inset};
        layout->chips_left_out += out;
        x += out ? 0 : width[i] + gap;
    }
}

/* In a row; closer together if they need it, and then as many of the first ones
 * as fit.  The last one, which tells of all keys, is never lost. */
static void place_chips(const LayoutWish *wish, Layout *layout)
{
    if (layout->last.width <= 0)
        return;
    place_chips_with(wish, layout, CHIP_PADDING);
    if (layout->chips_left_out > 0)
        place_chips_with(wish, layout, CHIP_PADDING_LEAST);
}

/* Strip, row, time line, last line off the whole; what is left is returned. */
static Box place_zones(const LayoutWish *wish, Layout *layout)
{
    Box rest = {0, 0, layout->width, layout->height};
    double high = layout->height / layout->em;
    if (wish->bare || high < 16)
        return rest;
    bool roomy = high >= 40;
    layout->strip = cut_top(&rest, pixels(layout, roomy ? STRIP : 2.2));
    if (high >= 20)
        layout->last = cut_bottom(&rest, pixels(layout, roomy ? LAST : 2.5));
    layout->time = cut_bottom(&rest, pixels(layout, roomy ? TIME : 2));
    if (roomy && wish->settings > 0) {
        int lines = place_settings(wish, layout, 2);
        int height = pixels(layout, ROW + (lines - 1) * (ROW - 0.4));
        layout->row = cut_bottom(&rest, height);
        place_settings(wish, layout, 2);
    }
    layout->bars = box_inset(layout->time, 0);
    layout->bars.x += pixels(layout, GAP);
    layout->bars.width -= 2 * pixels(layout, GAP);
    if (roomy) {
        int height = pixels(layout, BARS);
        layout->bars.y += layout->time.height - height - pixels(layout, 0.5);
        layout->bars.height = height;
    }
    if (layout->bars.width < 1)
        layout->bars.width = 1;
    place_chips(wish, layout);
    return rest;
}

/* Whether only the title of a card is seen. */
static bool card_is_bar(const LayoutWish *wish, int cards, int card)
{
    bool large = wish->large >= 0 && wish->large < cards;
    return (wish->closed >> card & 1) || (large && card != wish->large);
}

/* Cards that become bars since there is no room for all: from the last one on,
 * and never the first that is open. */
static LayoutWish fold_cards(const LayoutWish *wish, double room, double gap)
{
    LayoutWish folded = *wish;
    int cards = wish->cards < LAYOUT_CARDS ? wish->cards : LAYOUT_CARDS;
    double least = -gap;
    for (int i = 0; i < cards; i++)
        if (!(wish->hidden >> i & 1))
            least += gap +
                     (card_is_bar(wish, cards, i) ? TITLE_BAR : wish->least[i]);
    int open = 0;
    for (int i = 0; i < cards; i++)
        open += !(wish->hidden >> i & 1) && !card_is_bar(wish, cards, i);
    for (int i = cards - 1; i > 0 && open > 1 && least > FOLDS * room; i--) {
        if ((wish->hidden >> i & 1) || card_is_bar(wish, cards, i))
            continue;
        folded.closed |= 1u << i;
        least -= wish->least[i] - TITLE_BAR;
        open--;
    }
    return folded;
}

/* Whether a card and the next one stand in one row. */
static bool cards_pair(const LayoutWish *wish, const Layout *layout, int card)
{
    unsigned both = wish->half & ~wish->hidden;
    return card + 1 < layout->cards && (both >> card & 1) &&
           (both >> (card + 1) & 1) &&
           !card_is_bar(wish, layout->cards, card) &&
           !card_is_bar(wish, layout->cards, card + 1) &&
           layout->column.width >= PAIR_LEAST * layout->em;
}

/* Rows of one or two cards: each has what it needs, and what is left is shared
 * by weight; if there is not enough, what they need shrinks alike. */
static void place_cards(const LayoutWish *wished, Layout *layout)
{
    int gap = pixels(layout, GAP * 0.75), bar = pixels(layout, TITLE_BAR);
    Box inner = box_inset(layout->column, pixels(layout, GAP));
    bool pairs = layout->column.width >= PAIR_LEAST * layout->em;
    LayoutWish folded = fold_cards(wished, inner.height / layout->em, GAP);
    const LayoutWish *wish = pairs ? wished : &folded;
    double room = inner.height + gap, least = 0, weights = 0;
    layout->cards = wish->cards < LAYOUT_CARDS ? wish->cards : LAYOUT_CARDS;
    for (int i = 0; i < layout->cards; i++) {
        if (wish->hidden >> i & 1)
            continue;
        room -= gap;
        if (card_is_bar(wish, layout->cards, i)) {
            room -= bar;
            continue;
        }
        least += wish->least[i] * layout->em;
        weights += wish->weight[i];
        i += cards_pair(wish, layout, i);
    }
    double shrink = least > room ? room / least : 1;
    double more = least < room ? (room - least) / weights : 0;
    for (int i = 0, y = inner.y; i < layout->cards; i++) {
        if (wish->hidden >> i & 1)
            continue;
        double height =
            shrink * wish->least[i] * layout->em + more * wish->weight[i];
        if (card_is_bar(wish, layout->cards, i) || height < bar)
            height = bar;
        Box row = {inner.x, y, inner.width, (int)height};
        y += row.height + gap;
        layout->card[i] = row;
        if (cards_pair(wish, layout, i)) {
            layout->card[i] = box_column(row, 0, 2, gap);
            layout->card[++i] = box_column(row, 1, 2, gap);
        }
    }
}

/* One beside the other, in one, two or three columns. */
static void place_panes(const LayoutWish *wish, Layout *layout)
{
    int count = wish->panes < 1 ? 1 : wish->panes;
    count = count > LAYOUT_PANES ? LAYOUT_PANES : count;
    int columns = 1, gap = pixels(layout, 0.3);
    double best = 0;
    for (int c = 1; c <= count; c++) { /* the most room for squares */
        int rows = (count + c - 1) / c;
        double side = fmin((double)layout->stage.width / c,
                           (double)layout->stage.height / rows);
        if (side > best * 1.001) {
            best = side;
            columns = c;
        }
    }
    int rows = (count + columns - 1) / columns;
    for (int i = 0; i < count; i++) {
        Box column = box_column(layout->stage, i % columns, columns, gap);
        int top = layout->stage.height * (i / columns) / rows;
        int bottom = layout->stage.height * (i / columns + 1) / rows;
        column.y += top;
        column.height = bottom - top - (count > 1 ? gap : 0);
        layout->pane[i] = column;
    }
    layout->panes = count;
}

Layout layout_create(int width, int height, const LayoutWish *wish)
{
    Layout layout = {.width = width, .height = height};
    double size = EM_PIXELS * fmin(height / EM_HEIGHT, width / EM_WIDTH);
    layout.em = fmax(size, EM_LEAST);
    layout.stage = place_zones(wish, &layout);
    double wide = width / layout.em, high = height / layout.em;
    bool low = wish->page && high < 50; /* a page needs all of the width */
    if (!wish->bare && wide >= 60 && high >= 36 && !low &&
        (wish->page || wish->cards > 0)) {
        int column = pixels(&layout, fmax(COLUMN_PART * wide, COLUMN_LEAST));
        layout.column = layout.stage;
        layout.column.width = column;
        layout.column.x += layout.stage.width - column;
        layout.stage.width -= column;
        if (!wish->page)
            place_cards(wish, &layout);
    } else if (!wish->bare && wish->page) { /* over the stage */
        layout.column = layout.stage;
    }
    place_panes(wish, &layout);
    return layout;
}

Box layout_close_box(const Layout *layout, int card)
{
    Box box = layout->card[card];
    int side = pixels(layout, TITLE_BAR);
    return (Box){box.x + box.width - side, box.y, side,
                 box.height < side ? box.height : side};
}

static Hit hit_first(const Box *boxes, int count, Zone zone, double x, double y)
{
    for (int i = 0; i < count; i++)
        if (box_contains(boxes[i], x, y))
            return (Hit){zone, i};
    return (Hit){ZONE_NONE, 0};
}

Hit layout_hit(const Layout *layout, double x, double y)
{
    if (box_contains(layout->column, x, y)) {
        Hit hit = hit_first(layout->card, layout->cards, ZONE_CARD, x, y);
        if (layout->cards == 0)
            return (Hit){ZONE_PAGE, 0};
        if (hit.zone == ZONE_CARD &&
            box_contains(layout_close_box(layout, hit.index), x, y))
            hit.zone = ZONE_CARD_CLOSE;
        return hit;
    }
    if (box_contains(layout->stage, x, y))
        return hit_first(layout->pane, layout->panes, ZONE_STAGE, x, y);
    if (box_contains(layout->row, x, y))
        return hit_first(layout->setting, layout->settings, ZONE_SETTING, x, y);
    if (box_contains(layout->last, x, y))
        return hit_first(layout->chip, layout->chips, ZONE_CHIP, x, y);
    if (box_contains(layout->time, x, y))
        return (Hit){ZONE_TIME, 0};
    if (box_contains(layout->strip, x, y))
        return (Hit){ZONE_STRIP, 0};
    return (Hit){ZONE_NONE, 0};
}

double layout_time_part(const Layout *layout, double x)
{
    const Box *bars = &layout->bars;
    if (bars->width < 1)
        return 0;
    return fmin(fmax((x - bars->x) / bars->width, 0), 1);
}

/* ---- stage and world ---------------------------------------------------- */

const Lens LENS_FITS = {1, {0, 0}};

static const double ZOOM_LEAST = 1e-3, ZOOM_MOST = 1e6;

/* Pixels a metre that fit; one for both directions unless stretched. */
static void fitting_scale(Box box, const double bounds[4], bool stretched,
                          double scale[2])
{
    double wide = fmax(bounds[2] - bounds[0], 1e-300);
    double high = fmax(bounds[3] - bounds[1], 1e-300);
    scale[0] = fmax(box.width, 1) / wide;
    scale[1] = fmax(box.height, 1) / high;
    if (!stretched)
        scale[0] = scale[1] = fmin(scale[0], scale[1]);
}

Camera camera_create(Box box, const double bounds[4], bool stretched,
                     const Lens *lens)
{
    Camera camera;
    double fit[2];
    double zoom = lens->zoom > 0 ? lens->zoom : 1;
    fitting_scale(box, bounds, stretched, fit);
    double middle[2] = {box.x + 0.5 * box.width, box.y + 0.5 * box.height};
    double size[2] = {box.width, -(double)box.height};
    for (int k = 0; k < 2; k++) {
        double centre = 0.5 * (bounds[k] + bounds[k + 2]);
        camera.scale[k] = fit[k] * zoom;
        double sign = k == 0 ? 1 : -1;
        camera.origin[k] = middle[k] + lens->pan[k] * size[k] * zoom -
                           sign * camera.scale[k] * centre;
    }
    return camera;
}

void camera_pixels(const Camera *camera, int count, const double *world,
                   double *pixels)
{
    const Camera c = *camera;
    for (size_t i = 0; i < 2 * (size_t)count; i += 2) {
        pixels[i] = c.origin[0] + c.scale[0] * world[i];
        pixels[i + 1] = c.origin[1] - c.scale[1] * world[i + 1];
    }
}

void camera_pixel(const Camera *camera, const double world[2], double pixel[2])
{
    camera_pixels(camera, 1, world, pixel);
}

void camera_world(const Camera *camera, double x, double y, double world[2])
{
    world[0] = (x - camera->origin[0]) / camera->scale[0];
    world[1] = (camera->origin[1] - y) / camera->scale[1];
}

/* pan is kept for zoom 1, so that the fitting view may change below it. */
void lens_zoom(Lens *lens, Box box, const double bounds[4], bool stretched,
               double x, double y, double factor)
{
    Camera camera = camera_create(box, bounds, stretched, lens);
    double world[2], after[2];
    double zoom = lens->zoom > 0 ? lens->zoom : 1;
    camera_world(&camera, x, y, world);
    lens->zoom = fmin(fmax(zoom * factor, ZOOM_LEAST), ZOOM_MOST);
    camera = camera_create(box, bounds, stretched, lens);
    camera_pixel(&camera, world, after);
    lens_move(lens, box, x - after[0], y - after[1]);
}

void lens_move(Lens *lens, Box box, double dx, double dy)
{
    double zoom = lens->zoom > 0 ? lens->zoom : 1;
    lens->pan[0] += dx / (zoom * fmax(box.width, 1));
    lens->pan[1] -= dy / (zoom * fmax(box.height, 1));
}
