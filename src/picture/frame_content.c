/* frame_content.c - queries about the contents of a frame; its history. */
#include <math.h>
#include <string.h>

#include "picture/cards.h"

const Picture *picture_of_scene(const struct Scene *scene)
{
    return &pictures[scene->picture];
}

int picture_find_card(const Picture *picture, const char *name)
{
    for (int c = 0; c < picture->card_count; c++)
        if (strcmp(picture->cards[c]->name, name) == 0)
            return c;
    return -1;
}

bool frame_has_card(const FrameContent *content, const char *name)
{
    int card = picture_find_card(active_picture(content), name);
    return card >= 0 && !(content->cards.hidden_cards >> card & 1);
}

/* Returns the cards that the page or scene hides or closes at first. */
static CardSets find_start_card_sets(const Simulation *simulation)
{
    const Picture *picture = picture_of_scene(simulation->scene);
    const char *open = simulation->options.open_cards; /* NULL: not on a page */
    CardSets sets = {.enlarged_card = -1};
    for (int c = 0; c < picture->card_count; c++) {
        /* strstr suffices: no card's name is part of another one. */
        const Card *card = picture->cards[c];
        bool has =
            open ? strstr(open, card->name) != NULL : !card->is_only_in_lecture;
        sets.hidden_cards |= (unsigned)!has << c;
        sets.closed_cards |= (unsigned)(card->starts_closed && !open) << c;
    }
    return sets;
}

void frame_create(const Simulation *simulation, FrameContent *content)
{
    static const FrameView whole = {.lens = {.zoom = 1}};
    *content = (FrameContent){
        .panes = 1, .view = &whole, .cards = find_start_card_sets(simulation)};
    content->pane[0].simulation = simulation;
}

bool cards_need_line_energy(const Simulation *simulation, unsigned toggled)
{
    const Picture *picture = picture_of_scene(simulation->scene);
    const CardSets sets = find_start_card_sets(simulation);
    unsigned shut = sets.hidden_cards | (sets.closed_cards ^ toggled);
    for (int c = 0; c < picture->card_count; c++)
        if (picture->cards[c]->needs_line_energy && !(shut >> c & 1))
            return true;
    return false;
}

const double *pane_get_positions(const Pane *pane)
{
    return pane->x ? pane->x : pane->simulation->run[0].x;
}

double find_trial_step_length(const NewtonTrace *trace, int trial)
{
    return ldexp(trace->first_alpha > 0 ? trace->first_alpha : 1, 1 - trial);
}

void history_add_point(History *history, double time, int rows,
                       const Energy *row)
{
    double sum = time;
    for (int i = 0; i < rows; i++)
        sum += 0 * row[i].value; /* NaN if the value is not finite */
    if (!isfinite(sum) || history->point_count == HISTORY_MAX_POINTS)
        return;
    int last = history->point_count++;
    history->time[last] = time;
    for (int s = 0; s < history->series_count; s++)
        history->value[s][last] = 0;
    for (int i = 0; i < rows; i++) {
        int s = 0;
        while (s < history->series_count &&
               strcmp(history->name[s], row[i].name) != 0)
            s++;
        if (s == MAX_HISTORY_SERIES)
            continue; /* the history has no room for more quantities */
        if (s == history->series_count) {
            history->name[history->series_count++] = row[i].name;
            memset(history->value[s], 0, sizeof history->value[s]);
        }
        history->value[s][last] = row[i].value;
    }
}
