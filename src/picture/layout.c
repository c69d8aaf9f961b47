/* layout.c - computes the places of stage, cards and controls in the window. */
#include "picture/layout.h"

#include <math.h>

#include "picture/cards.h"

/* Heights of the zones, ems. */
static const double STRIP = 3.1, SETTINGS = 2.6, TIME_LINE = 4.9, CHIPS = 3.0;
/* Least height of a graph on a page: GRAPH_PART of the window's height, plus
 * GRAPH_AXES ems for title and axes, plus GRAPH_LEGEND ems for a legend. */
static const double GRAPH_PART = 0.17, GRAPH_AXES = 4.4, GRAPH_LEGEND = 1.5;
/* Further sizes, ems. */
static const double GAP = 0.9;     /* margins of the zones, gap between cards */
static const double LETTER = 0.56; /* average width of a letter */
static const double SETTING_GAP = 0.3;  /* gap between settings */
static const double CHIP_PADDING = 1.2; /* width of a chip beyond its letters */
static const double BARS = 2.4;         /* height of the time line's bars */
static const double NAME = 1.8;         /* height of a cell's name */
static const double HEADING = 2.2;      /* height of a group's heading */
static const double MIN_COLUMN = 27;    /* least width of the column */
static const double MIN_PAIR = 28;      /* least width for two cards in a row */

static const double BOLD = 1.12; /* factor by which bold letters are wider */
/* Fraction of the stage's width that the picture takes beside the main card, or
 * of the height below the main card if the column has no room for it. */
static const double PICTURE_PART = 0.45;
/* A picture that would be narrower than MIN_BESIDE ems beside the main card is
 * placed below, in the fraction PICTURE_BELOW of the stage's height. */
static const double MIN_BESIDE = 17, PICTURE_BELOW = 0.53;
/* Limits for a card below the picture: largest height, as a fraction of the
 * stage's; least height of a main card, in multiples of min_height. */
static const double CARD_BELOW = 0.65, MAIN_CARD_GROWTH = 1.3;
static const double MIN_SHRINK = 0.7; /* least fraction of the needed heights */
/* Fraction of a low window's width that the settings have. */
static const double SETTINGS_PART = 0.75;

/* The column's fraction of the window's width is COLUMN_PART.  The fraction
 * grows up to PAGE_PART (BIG_PART in large type) until a page's texts fit.
 * Code and lists of more than SHORT_LIST_MAX_ROWS rows have up to WIDE_PART. */
static const double COLUMN_PART = 0.38, PAGE_PART = 0.50, BIG_PART = 0.57,
                    WIDE_PART = 0.75, COLUMN_GROWTH = 0.01;
enum { SHORT_LIST_MAX_ROWS = 30 };

/* An em has 14 pixels in a window of 1000 x 800, is proportional to the smaller
 * one of width/1000 and height/800, and has at least 9 pixels. */
static const double EM_HEIGHT = 800, EM_WIDTH = 1000, EM_PIXELS = 14,
                    MIN_EM = 9;

static int ems_to_pixels(const Layout *layout, double ems)
{
    return (int)floor(ems * layout->em + 0.5);
}

/* Returns column `index` of `count` equal columns of the box, `gap` apart. */
static Box get_box_column(Box box, int index, int count, int gap)
{
    int room = box.width - (count - 1) * gap;
    int left = (int)((long)room * index / count) + index * gap;
    int right = (int)((long)room * (index + 1) / count) + index * gap;
    return (Box){box.x + left, box.y, right - left, box.height};
}

/* Places boxes of these widths from the left, `gap` apart, in at most `lines`
 * lines.  room.height is the height of a line.  Returns how many boxes fit. */
static int place_boxes(Box room, int lines, int gap, int count,
                       const int *width, Box *box)
{
    int x = room.x, line = 0;
    for (int i = 0; i < count; i++) {
        if (x > room.x && x + width[i] > room.x + room.width) {
            x = room.x;
            line++;
        }
        if (line == lines)
            return i;
        box[i] = (Box){x, room.y + line * room.height, width[i], room.height};
        x += width[i] + gap;
    }
    return count;
}

/* Places as many of the first boxes as fit into one line, and the last box
 * behind them; the others keep no width.  Returns how many of the first fit. */
static int place_boxes_keep_last(Box room, int gap, int count, const int *width,
                                 Box *box)
{
    int last = count - 1, left = room.x;
    room.width -= width[last] + gap;
    int fit = place_boxes(room, 1, gap, last, width, box);
    if (fit > 0)
        left = box[fit - 1].x + box[fit - 1].width + gap;
    box[last] = (Box){left, room.y, width[last], room.height};
    return fit;
}

/* Counts the characters of a UTF-8 text, markup included; 0 for NULL. */
static int count_letters(const char *text)
{
    int letters = 0;
    for (; text && *text; text++)
        letters += (*text & 0xc0) != 0x80;
    return letters;
}

/* Places the settings in one to three lines at the bottom of `rest`, which
 * loses their height.  In a low window the settings stand in one line at the
 * right of the time line; room for the last setting, which may open the list of
 * all settings, is kept.  Settings without room are left out. */
static void place_settings(const SettingsRow *row, Layout *layout, bool low,
                           Box *rest)
{
    int width[LAYOUT_MAX_SETTINGS] = {0},
        left = ems_to_pixels(layout, GAP + 0.5);
    for (int i = 0; i < row->count; i++) {
        const Setting *setting = &row->item[i];
        int value = count_letters(setting->value);
        value = value > setting->min_letters ? value : setting->min_letters;
        value += count_letters(setting->name) + 1;
        width[i] = ems_to_pixels(layout, value * LETTER + 0.6);
    }
    Box room = {left, ems_to_pixels(layout, 0.2),
                layout->width - ems_to_pixels(layout, GAP) - left,
                ems_to_pixels(layout, SETTINGS - 0.4)};
    Box *box = layout->setting;
    int gap = ems_to_pixels(layout, SETTING_GAP);
    if (low) {
        room = box_cut_off(&layout->time_line, EDGE_RIGHT,
                           (int)(SETTINGS_PART * layout->width));
        layout->settings_row = room;
        room.x += left;
        room.width -= 2 * left;
        place_boxes_keep_last(room, gap, row->count, width, box);
        layout->setting_count = row->count;
        return;
    }
    layout->setting_count = place_boxes(room, 3, gap, row->count, width, box);
    int more = (box[layout->setting_count - 1].y - room.y) / room.height;
    layout->settings_row =
        box_cut_off(rest, EDGE_BOTTOM,
                    ems_to_pixels(layout, SETTINGS + more * (SETTINGS - 0.4)));
    for (int i = 0; i < layout->setting_count; i++)
        box[i].y += layout->settings_row.y;
}

/* Places the first chips that fit, and the last one, which lists all keys. */
static void place_chips(const ChipRow *chips, bool lecture, Layout *layout)
{
    int gap = ems_to_pixels(layout, 0.6), last = chips->count - 1;
    int width[LAYOUT_MAX_CHIPS];
    Box room = box_inset(layout->chip_row, ems_to_pixels(layout, 0.35));
    for (int i = 0; i <= last; i++) {
        double letters = BOLD * count_letters(chips->chip[i].key) +
                         count_letters(chips->chip[i].label) +
                         (lecture ? 2 : 1);
        width[i] =
            ems_to_pixels(layout, letters * LETTER * 0.92 + CHIP_PADDING);
    }
    room.x = ems_to_pixels(layout, GAP);
    room.width = layout->width - 2 * room.x;
    int fit =
        place_boxes_keep_last(room, gap, chips->count, width, layout->chip);
    layout->chip_count = chips->count;
    layout->omitted_chips = last - fit;
}

/* Cuts title bar, settings, time line, chips off.  Returns the rest. */
static Box place_window_rows(const FrameContent *content, Layout *layout)
{
    Box rest = {0, 0, layout->width, layout->height},
        *bars = &layout->step_bars;
    double high = layout->height / layout->em;
    bool roomy = high >= 40, lecture = content->lecture.page;
    bool big = active_pane(content)->simulation->options.big;
    if (content->is_bare || content->is_stage_only || high < 16)
        return rest;
    layout->title_bar = box_cut_off(&rest, EDGE_TOP,
                                    ems_to_pixels(layout, roomy ? STRIP : 2.2));
    if (high >= 20)
        layout->chip_row = box_cut_off(
            &rest, EDGE_BOTTOM, ems_to_pixels(layout, roomy ? CHIPS : 2.5));
    if (layout->chip_row.width > 0 && content->chips.count > 0)
        place_chips(&content->chips, lecture, layout);
    if (content->sheet.cells > 0)
        return rest;
    layout->time_line = box_cut_off(
        &rest, EDGE_BOTTOM, ems_to_pixels(layout, roomy ? TIME_LINE : 2));
    if (content->settings.count > 0 && (roomy || lecture || big))
        place_settings(&content->settings, layout, !roomy, &rest);
    *bars = layout->time_line;
    bars->x += ems_to_pixels(layout, GAP);
    bars->width -= 2 * ems_to_pixels(layout, GAP);
    if (roomy) {
        bars->height = ems_to_pixels(layout, BARS);
        bars->y += layout->time_line.height - bars->height -
                   ems_to_pixels(layout, 0.5);
    }
    bars->width = (int)fmax(bars->width, 1);
    return rest;
}

/* Returns the least height of a card, ems, whose content is `wide` ems wide. */
static double find_min_height(const FrameContent *content, const Layout *layout,
                              int card, double wide)
{
    const Card *row = active_picture(content)->cards[card];
    double em = layout->em;
    double least = row->find_least_height
                       ? row->find_least_height(content, wide, em)
                       : row->min_height;
    bool graph = card > 0 && row->draw && !row->is_text_only;
    double high = GRAPH_PART * layout->height / em + GRAPH_AXES +
                  (row->make_legend_row ? GRAPH_LEGEND : 0);
    return graph && content->lecture.page ? fmax(least, high) : least;
}

/* A row of the column, with one card or two. */
typedef struct CardRow {
    int first_card, card_count; /* cards of the row */
    double min_height;          /* ems; 0: only the title is seen */
    double weight; /* weight with which the row shares free height */
} CardRow;

/* Returns the index of the main card; -1: the page has no open main card. */
static int find_main_card(const FrameContent *content)
{
    const char *name = active_pane(content)->simulation->options.main_card;
    int card = name ? picture_find_card(active_picture(content), name) : -1;
    unsigned shut = content->cards.hidden_cards | content->cards.closed_cards;
    return card >= 0 && !(shut >> card & 1) ? card : -1;
}

/* Finds the rows of all visible cards.  If `pairs`, two cards of half width
 * share a row.  Returns the number of rows.
 *   rows  [LAYOUT_MAX_CARDS] out */
static int find_card_rows(const FrameContent *content, const Layout *layout,
                          double wide, bool pairs, CardRow *rows)
{
    const Picture *picture = active_picture(content);
    const CardSets *sets = &content->cards;
    int main_card = find_main_card(content);
    int count = 0, cards = picture->card_count, before = -2;
    bool large = sets->enlarged_card >= 0 && sets->enlarged_card < cards;
    for (int i = 0; i < cards; i++) {
        const Card *card = picture->cards[i];
        bool bar =
            sets->closed_cards >> i & 1 || (large && i != sets->enlarged_card);
        bool half = card->fits_half_width ||
                    (card->fits_half_page && content->lecture.page);
        bool on_stage =
            i == main_card && (card->main_place == BELOW_PICTURE ||
                               (card->main_place == BESIDE_PICTURE && !bar));
        if (sets->hidden_cards >> i & 1 || on_stage)
            continue;
        double least = bar ? 0 : find_min_height(content, layout, i, wide);
        if (pairs && half && !bar && before == i - 1) {
            rows[count - 1].card_count = 2;
            rows[count - 1].min_height =
                fmax(rows[count - 1].min_height, least);
            continue;
        }
        before = half && !bar ? i : -2;
        rows[count++] = (CardRow){i, 1, least, bar ? 0 : card->height_weight};
    }
    return count;
}

/* Gives each row its minimum height, lets the texts of a page grow to their
 * usual size, and shares the rest of the free height by the weights.
 * If the column is too low, closes rows from the last one on.  Cards in pairs
 * and a single open row are closed only outside of the lecture, if the cards
 * would shrink below MIN_SHRINK.  If the column is still too low, shrinks all
 * heights but those of the page's texts.  Returns whether the page's texts have
 * their usual size; in large type, whether the smallest letters fit. */
static bool place_cards(const FrameContent *content, Layout *layout)
{
    CardRow rows[LAYOUT_MAX_CARDS] = {{0}};
    int gap = ems_to_pixels(layout, GAP * 0.75),
        bar = ems_to_pixels(layout, TITLE_BAR);
    bool big = active_pane(content)->simulation->options.big;
    Box rest = box_inset(layout->column, /* narrow margins in large type */
                         ems_to_pixels(layout, big ? 0.4 : GAP));
    bool pairs = !big && layout->column.width >= MIN_PAIR * layout->em;
    double wide = card_find_inner_box(rest, layout->em).width / layout->em;
    int count = find_card_rows(content, layout, wide, pairs, rows), open = 0;
    double room = (rest.height + gap) / layout->em; /* ems, for open rows */
    double least = 0, texts = 0, lacking = 0, weights = 1e-9;
    for (int i = 0; i < count; i++) {
        open += rows[i].min_height > 0;
        room -= gap / layout->em + (rows[i].min_height > 0 ? 0 : TITLE_BAR);
        least += rows[i].min_height;
    }
    if (content->lecture.page && least > room && rows->min_height > 0 &&
        rows->first_card == 0) { /* card 0, the page, may shrink */
        texts = page_find_least_height(content, wide, layout->em);
        lacking = rows->min_height - texts;
        least -= lacking;
    }
    for (int i = count - 1; i >= 0; i--)
        if (rows[i].min_height > 0 &&
            ((!pairs && open > 1 && least > room) ||
             (!content->lecture.page && MIN_SHRINK * least > room))) {
            least -= rows[i].min_height;
            room -= TITLE_BAR;
            rows[i].min_height = rows[i].weight = 0;
            open--;
        }
    double growth = fmin(fmax(room - least, 0), lacking);
    bool fits = growth == lacking || (big && least <= room);
    texts += growth;
    least += growth;
    double shrink = least > room ? (room - texts) / (least - texts) : 1;
    for (int i = 0; i < count; i++)
        weights += rows[i].weight;
    for (int i = 0; i < count; i++) {
        const CardRow *row = &rows[i];
        double high = (i == 0 && texts > 0 ? texts : row->min_height * shrink) +
                      row->weight * fmax(room - least, 0) / weights;
        int height = ems_to_pixels(layout, high);
        Box box = box_cut_off(&rest, EDGE_TOP, height < bar ? bar : height);
        box_cut_off(&rest, EDGE_TOP, gap);
        for (int k = 0; k < row->card_count; k++)
            layout->card[row->first_card + k] =
                get_box_column(box, k, row->card_count, gap);
    }
    return fits;
}

/* Places the panes in as many columns as leave each pane the largest square. */
static void place_panes(int count, Layout *layout)
{
    int columns = 1, gap = ems_to_pixels(layout, 0.15);
    double best = 0;
    for (int c = 1; c <= count; c++) { /* c columns */
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
        Box column = get_box_column(layout->stage, i % columns, columns, gap);
        int top = layout->stage.height * (i / columns) / rows;
        int bottom = layout->stage.height * (i / columns + 1) / rows;
        column.y += top;
        column.height = bottom - top - (count > 1 ? gap : 0);
        layout->pane[i] = column;
    }
    layout->pane_count = count;
}

/* Places the cells of the overview in rows of `columns` squares.  Returns the
 * height of all rows, pixels. */
static int place_overview_cells(const FrameContent *content, Layout *layout,
                                int columns, int side)
{
    int gap = ems_to_pixels(layout, GAP), name = ems_to_pixels(layout, NAME),
        column = 0;
    int left = (layout->stage.width - columns * (side + gap) + gap) / 2, y = 0;
    for (int i = 0; i < content->sheet.cells; i++) {
        bool heads = content->sheet.cell[i].heading;
        if (i > 0 && (heads || column == columns)) {
            y += side + name;
            column = 0;
        }
        y += heads ? ems_to_pixels(layout, HEADING) : 0;
        layout->cell[i] = (Box){layout->stage.x + left + column * (side + gap),
                                layout->stage.y + y, side, side + name};
        column++;
    }
    return y + side + name;
}

/* Places the overview in the number of columns with the largest squares. */
static void place_overview(const FrameContent *content, Layout *layout)
{
    int gap = ems_to_pixels(layout, GAP), best = 0, wide = 1;
    for (int columns = 1; columns <= content->sheet.cells; columns++) {
        int least = place_overview_cells(content, layout, columns, 0);
        int rows = place_overview_cells(content, layout, columns, 1) - least;
        int side = (layout->stage.width - gap) / columns - gap;
        int high = (layout->stage.height - gap - least) / rows;
        side = side < high ? side : high;
        if (side > best) {
            best = side;
            wide = columns;
        }
    }
    place_overview_cells(content, layout, wide, best);
    layout->cell_count = content->sheet.cells;
}

/* Places a card below the panes, at least `least` pixels high, but not higher
 * than CARD_BELOW of the stage. */
static void place_card_below_panes(const FrameContent *content, Layout *layout,
                                   int card, double least)
{
    const Box *stage = &layout->stage;
    double em = layout->em;
    double needs =
        find_min_height(content, layout, card, stage->width / em) + 2 * GAP;
    Box box = box_cut_off(
        &layout->stage, EDGE_BOTTOM,
        (int)fmin(fmax(needs * em, least), CARD_BELOW * stage->height));
    layout->card[card] = box_inset(box, ems_to_pixels(layout, GAP));
    place_panes(layout->pane_count, layout);
}

/* Places the main card of a page on the stage, and the picture in the card's
 * place in the column.  If the column is too low or shows code, the picture
 * stands below the card.  Cards with BELOW_PICTURE or BESIDE_PICTURE share the
 * stage with the picture. */
static void place_main_card(const FrameContent *content, Layout *layout)
{
    const int main_card = find_main_card(content);
    double bar = 3 * layout->em; /* a lower card is closed */
    if (main_card < 0 || layout->card_count == 0 || layout->pane_count != 1 ||
        layout->stage.height < 2 * bar ||
        (content->cards.enlarged_card >= 0 &&
         content->cards.enlarged_card != main_card))
        return;
    const Card *card = active_picture(content)->cards[main_card];
    Box *stage = &layout->pane[0], place = layout->card[main_card];
    if (card->main_place == BELOW_PICTURE) {
        place_card_below_panes(content, layout, main_card,
                               (MAIN_CARD_GROWTH * card->min_height + 2 * GAP) *
                                   layout->em);
        return;
    }
    bool beside = card->main_place == BESIDE_PICTURE;
    if (place.width < 1 && !layout->has_list && !beside)
        return;
    if (beside && PICTURE_PART * stage->width > MIN_BESIDE * layout->em)
        place =
            box_cut_off(stage, EDGE_RIGHT, (int)(PICTURE_PART * stage->width));
    else if (beside || place.height < bar)
        place = box_cut_off(
            stage, EDGE_BOTTOM,
            (int)((beside ? PICTURE_BELOW : PICTURE_PART) * stage->height));
    layout->card[main_card] = box_inset(*stage, ems_to_pixels(layout, GAP));
    *stage = place;
}

/* On a page, places the first card that has no room in the column on the stage,
 * below the picture.  Does nothing if a main or enlarged card exists, or if
 * code is shown in normal type and several switches or panes need the whole
 * stage. */
static void place_overflow_card(const FrameContent *content, Layout *layout)
{
    const Simulation *simulation = active_pane(content)->simulation;
    const Options *options = &simulation->options;
    int bar = ems_to_pixels(layout, TITLE_BAR), folded = 1;
    unsigned shut = content->cards.closed_cards | content->cards.hidden_cards;
    while (folded < layout->card_count &&
           (shut >> folded & 1 ||
            (layout->card[folded].height != bar && !layout->has_list)))
        folded++;
    if (!content->lecture.page || options->main_card ||
        content->cards.enlarged_card >= 0 || folded >= layout->card_count ||
        (!options->big && layout->has_list &&
         (layout->pane_count != 1 || simulation->scene->switch_labels[1])))
        return;
    const Box stage = layout->stage, title = layout->card[folded];
    place_card_below_panes(content, layout, folded,
                           layout->has_list ? stage.height - 0.8 * stage.width
                                            : 0);
    Box *first = &layout->card[0]; /* card 0 may grow into the free place */
    if (!layout->has_list && title.y <= first->y + first->height + layout->em)
        first->height = title.y + title.height - first->y;
}

/* The least em on a page is the smaller one of height/55 and width/64, in large
 * type the smaller one of height/35 and width/54. */
Layout layout_create(const FrameContent *content, int width, int height)
{
    Layout layout = {.width = width, .height = height};
    const Simulation *simulation = active_pane(content)->simulation;
    const Picture *picture = picture_of_scene(simulation->scene);
    double size = EM_PIXELS * fmin(height / EM_HEIGHT, width / EM_WIDTH);
    double least = content->min_em > 0 ? content->min_em : MIN_EM;
    bool page = content->column != COLUMN_CARDS, big = simulation->options.big;
    if (content->lecture.page || big)
        least = fmax(content->min_em, big ? fmin(height / 35.0, width / 54.0)
                                          : fmin(height / 55.0, width / 64.0));
    layout.em = fmax(size, least);
    layout.stage = place_window_rows(content, &layout);
    if (content->sheet.cells > 0) {
        place_overview(content, &layout);
        return layout;
    }
    double wide = width / layout.em, high = height / layout.em;
    bool low = page && high < 50; /* low: lists and code cover the stage */
    bool bare = content->is_bare || content->is_stage_only;
    if (!bare && wide >= 53 && high >= 34 && !low &&
        (page ||
         content->cards.hidden_cards != (1u << picture->card_count) - 1)) {
        double most = WIDE_PART * wide, end = big ? BIG_PART : PAGE_PART;
        const Box whole = layout.stage;
        for (double part = COLUMN_PART;; part += COLUMN_GROWTH) {
            double ems = fmax(part * wide, MIN_COLUMN);
            if (content->column == COLUMN_CODE)
                ems = fmin(fmax(code_find_width(content->lecture.page), ems),
                           most);
            else if (page && content->list.row_count > SHORT_LIST_MAX_ROWS)
                ems = most;
            layout.stage = whole;
            layout.column = box_cut_off(&layout.stage, EDGE_RIGHT,
                                        ems_to_pixels(&layout, ems));
            if (page || place_cards(content, &layout) ||
                !content->lecture.page || part >= end)
                break;
        }
        if (!page || content->column == COLUMN_CODE)
            layout.card_count = picture->card_count;
    } else if (!bare &&
               page) { /* the code or the list takes the place of the stage */
        layout.column = layout.stage;
    }
    layout.has_list = page && layout.column.width > 0;
    place_panes(content->panes, &layout);
    place_main_card(content, &layout);
    place_overflow_card(content, &layout);
    return layout;
}

Box layout_cross_box(const Layout *layout, int card)
{
    Box box = card >= 0 ? layout->card[card]
                        : box_inset(layout->column, ems_to_pixels(layout, GAP));
    int side = ems_to_pixels(layout, TITLE_BAR);
    return (Box){box.x + box.width - side, box.y, side,
                 box.height < side ? box.height : side};
}

WindowHit layout_find_hit(const Layout *l, double x, double y)
{
    const struct {
        WindowZone zone;
        const Box *box;
        int count; /* number of boxes */
    } lists[] = {{ZONE_TITLE_BAR, &l->title_bar, 1},
                 {ZONE_STAGE, l->pane, l->pane_count},
                 {ZONE_TIME_LINE, &l->time_line, 1},
                 {ZONE_LIST, &l->column, l->has_list},
                 {ZONE_CARD, l->card, l->card_count},
                 {ZONE_SETTING, l->setting, l->setting_count},
                 {ZONE_CHIP, l->chip, l->chip_count},
                 {ZONE_CELL, l->cell, l->cell_count}};
    WindowHit hit = {ZONE_NONE, 0, {x, y}};
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++)
        for (int i = 0; i < lists[k].count; i++)
            if (box_contains(lists[k].box[i], x, y))
                hit = (WindowHit){lists[k].zone, i, {x, y}};
    if (hit.zone == ZONE_CARD &&
        box_contains(layout_cross_box(l, hit.index), x, y))
        hit.zone = ZONE_CARD_CLOSE;
    if (hit.zone == ZONE_LIST && box_contains(layout_cross_box(l, -1), x, y))
        hit.zone = ZONE_LIST_CLOSE;
    return hit;
}
