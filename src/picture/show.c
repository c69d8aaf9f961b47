#include "picture/show.h"

#include <math.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/exhibits.h"
#include "picture/handles.h"

void show_create(const Simulation *simulation, Show *show)
{
    const Picture *picture = picture_of(simulation->scene);
    *show = (Show){.panes = 1, .selected = -1, .large = -1};
    show->pane[0].simulation = simulation;
    show->lens = LENS_FITS;
    for (int c = 0; picture->cards[c]; c++) {
        show->closed |= (unsigned)picture->cards[c]->closed << c;
        show->hidden |= (unsigned)picture->cards[c]->lecture << c;
    }
}

/* Characters of UTF-8, markup and marks not counted apart. */
static int count_letters(const char *text)
{
    int letters = 0;
    for (; text && *text; text++)
        letters += (*text & 0xc0) != 0x80;
    return letters;
}

/* The cards that say themselves how high they have to be, where they are this
 * wide. */
static void ask_cards(const Show *show, const Layout *layout, LayoutWish *wish)
{
    const Picture *picture = picture_of(show_pane(show)->simulation->scene);
    for (int c = 0; c < wish->cards; c++)
        if (picture->cards[c]->needs)
            wish->least[c] = picture->cards[c]->needs(
                show,
                cards_inside(layout->card[c], layout->em).width / layout->em);
}

/* Pixels that letters have at least: on a page a 55th of the height, in large
 * type a 35th, on a page or not, where that leaves room for words beside the
 * stage. */
static double least_letter(const Show *show, int width, int height)
{
    bool big = show_pane(show)->simulation->options.big;
    double letter = big ? fmin(height / 35.0, width / 54.0)
                        : fmin(height / 55.0, width / 64.0);
    return show->lecture || big ? fmax(show->letter, letter) : show->letter;
}

/* The card that a page wants large stands on the stage, and the picture in the
 * card's place, if both are there. */
static void place_star(const Show *show, const Picture *picture, Layout *layout)
{
    const LecturePage *page = show->lecture;
    int star = page && page->star ? picture_card(picture, page->star) : -1;
    double bar = 3 * layout->em; /* more than a card that is closed has */
    if (star < 0 || star >= layout->cards || layout->panes != 1 ||
        layout->card[star].height < bar || layout->stage.height < bar)
        return;
    Box stage = box_inset(layout->pane[0], (int)(0.9 * layout->em));
    layout->pane[0] = layout->card[star];
    layout->card[star] = stage;
}

Layout show_layout(const Show *show, int width, int height)
{
    const Picture *picture = picture_of(show_pane(show)->simulation->scene);
    LayoutWish wish = {.bare = show->bare,
                       .letter = least_letter(show, width, height),
                       .panes = show->panes,
                       .closed = show->closed,
                       .hidden = show->hidden | show->print,
                       .print = show->print,
                       .large = show->large,
                       .page = show->page.kind != PAGE_NONE,
                       .settings = show->settings,
                       .chips = show->chips,
                       .cells = show->cells};
    for (int i = 0; i < show->cells; i++)
        wish.heads |= (unsigned)(show->cell[i].group != NULL) << i;
    for (; picture->cards[wish.cards]; wish.cards++) {
        const Card *card = picture->cards[wish.cards];
        bool half = card->half || (card->half_on_page && show->lecture);
        wish.least[wish.cards] = card->least;
        wish.weight[wish.cards] = card->weight;
        wish.half |= (unsigned)half << wish.cards;
    }
    for (int i = 0; i < wish.settings; i++) {
        const Setting *setting = &show->setting[i];
        int value = count_letters(setting->value);
        value = setting->letters > value ? setting->letters : value;
        wish.setting_letters[i] = count_letters(setting->name) + value + 1;
    }
    for (int i = 0; i < wish.chips; i++)
        wish.chip_letters[i] = count_letters(show->chip[i].key) +
                               count_letters(show->chip[i].label) +
                               (show->lecture ? 2 : 1);
    Layout layout = layout_create(width, height, &wish);
    ask_cards(show, &layout, &wish);
    layout = layout_create(width, height, &wish);
    place_star(show, picture, &layout);
    return layout;
}

/* The part of the world that fits the stage of a pane.  Returns its picture. */
static const Picture *find_bounds(const Show *show, int pane, double bounds[4])
{
    const Picture *picture = picture_of(show->pane[pane].simulation->scene);
    if (show->held.on && !show->held.away && show->held.pane == pane)
        memcpy(bounds, show->held.bounds, sizeof show->held.bounds);
    else if (picture->bounds)
        picture->bounds(show, pane, bounds);
    else
        memcpy(bounds, picture->around, sizeof picture->around);
    return picture;
}

Camera show_camera(const Show *show, const Layout *layout, int pane)
{
    double bounds[4];
    const Picture *picture = find_bounds(show, pane, bounds);
    return camera_create(layout->pane[pane], bounds, picture->stretched,
                         &show->lens);
}

void show_hold(Show *show, int pane)
{
    Held held = {.on = true, .pane = pane};
    find_bounds(show, pane, held.bounds);
    show->held = held;
}

Pick show_pick(const Show *show, const Layout *layout, double x, double y)
{
    Hit hit = layout_hit(layout, x, y);
    Pick none = {PICK_NONE, 0, 0, {0, 0}};
    if (hit.zone != ZONE_STAGE || hit.index >= show->panes)
        return none;
    Plot stage = {.box = layout->pane[hit.index],
                  .camera = show_camera(show, layout, hit.index),
                  .pane = hit.index,
                  .text = true,
                  .em = layout->em};
    const Picture *picture =
        picture_of(show->pane[hit.index].simulation->scene);
    Pick pick = {PICK_NONE, hit.index, 0, {0, 0}};
    camera_world(&stage.camera, x, y, pick.point);
    if (!picture->own_handles && handles_pick(show, &stage, x, y, &pick))
        return pick;
    if (picture->pick)
        return picture->pick(show, &stage, x, y);
    pick.kind = picture->places ? PICK_PLACE : PICK_NONE;
    return pick;
}

void show_zoom(Show *show, const Layout *layout, double x, double y,
               double factor)
{
    Hit hit = layout_hit(layout, x, y);
    if (hit.zone != ZONE_STAGE || hit.index >= show->panes)
        return;
    double bounds[4];
    const Picture *picture = find_bounds(show, hit.index, bounds);
    lens_zoom(&show->lens, layout->pane[hit.index], bounds, picture->stretched,
              x, y, factor);
}

void show_move(Show *show, const Layout *layout, int pane, double dx, double dy)
{
    lens_move(&show->lens, layout->pane[pane], dx, dy);
}

long show_step_at(const Show *show, const Layout *layout, double x)
{
    double part = layout_time_part(layout, x) * (double)frame_span(show);
    long step = part < 0.25 ? 0 : (long)part + 1;
    return step > show->bars ? show->bars : step;
}

const double *pane_x(const Pane *pane)
{
    return pane->x ? pane->x : pane->simulation->run[0].x;
}

int show_sample(const Simulation *simulation, Energy row[HISTORY_SERIES])
{
    const Picture *picture = picture_of(simulation->scene);
    return picture->sample ? picture->sample(simulation, row) : 0;
}
