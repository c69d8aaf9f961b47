/* lecture_show.c - the code and the columns that pages of the lecture show. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"

/* Where Algorithm 3's lines are in step_forward of lecture.c. */
static const char *const line_texts[LINE_COUNT] = {
    [LINE_START] = "x_n[i] = x[i]",
    [LINE_DO] = "for (int update",
    [LINE_PROJECT] = "search_dir(solid",
    [LINE_SOLVE] = "search_dir(solid",
    [LINE_SEARCH] = "line_search(solid",
    [LINE_UPDATE] = "memcpy(x, x_new",
    [LINE_TEST] = "residual(solid, p, h) > tol",
    [LINE_END] = "v[i] = mul(1 / h",
};

const char *lecture_lit_code(const Show *show)
{
    const LecturePage *page = show->lecture;
    const Simulation *simulation = show_pane(show)->simulation;
    const Trace *trace = show_pane(show)->trace;
    bool whole = simulation->options.line_search == LINE_SEARCH_NONE;
    if (strcmp(page->function, "step_forward") == 0 && trace && !whole &&
        trace->line != LINE_NONE)
        return line_texts[trace->line];
    return page->lit;
}

void show_lecture(Column column, const LecturePage *left, Show *show)
{
    const Simulation *simulation = show_pane(show)->simulation;
    const LecturePage *page = simulation->options.page;
    const Picture *picture = picture_of(simulation->scene);
    if (column == COLUMN_PAGES)
        show->help_rows = (int)fmin(lecture_count(), LAYOUT_ROWS);
    for (int i = 0; column == COLUMN_PAGES && i < show->help_rows; i++) {
        const LecturePage *row = &lecture_pages[i];
        snprintf(show->help[i].key, SHOW_VALUE, "%s%d",
                 row == (page ? page : left) ? ">" : "", i + 1);
        snprintf(show->help[i].text, SHOW_TEXT, "%s", row->topic);
    }
    show->column = page || column != COLUMN_CODE ? column : COLUMN_CARDS;
    if (!page)
        return;
    show->lecture = page;
    show->topic = page->topic;
    show->hidden = show->veils = 0;
    for (int c = 0; c < picture->count; c++) {
        const char *name = picture->cards[c]->name; /* in no other name */
        bool open = strstr(page->cards, name);
        if (show->veiled && page->veils && strstr(page->veils, name))
            show->veils |= 1u << c;
        show->hidden |= open ? 0 : 1u << c;
        if (open && picture->cards[c]->starts_closed)
            show->closed &= ~(1u << c);
    }
}
