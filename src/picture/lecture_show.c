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

/* The text whose lines are lit: that of Algorithm 3's line while it is gone
 * through, else the page's. */
static const char *lit_text(const Show *show, const LecturePage *page)
{
    static const char *const kinds[SCENE_MAX_SWITCHES] = {
        "j, (i + 1) * row + j, k)", "(&solid, i * row + j, i * row + j + 1",
        "j, (i + 1) * row + j + 1", "1) * row + j, i * row + j + 1"};
    const Simulation *simulation = show->pane[show->active].simulation;
    const Trace *trace = show_pane(show)->trace;
    bool whole = simulation->options.line_search == LINE_SEARCH_NONE;
    if (strcmp(page->function, "step_forward") == 0 && trace && !whole &&
        trace->line != LINE_NONE && line_texts[trace->line])
        return line_texts[trace->line];
    if (page->kinds)
        return kinds[exhibit_kind(simulation, lecture_spring(simulation))];
    return page->lit;
}

/* The lines of the page's functions, as many as there is room for. */
static void fill_code(const LecturePage *page, Show *show)
{
    const char *text = lit_text(show, page);
    Page *code = &show->page;
    *code = (Page){.kind = PAGE_CODE, .title = page->file};
    for (const char *const *line = page->code;
         *line && code->lines < SHOW_CODE_LINES; line++) {
        code->lit[code->lines] = strstr(*line, text) != NULL;
        code->line[code->lines++] = *line;
    }
}

void show_lecture(Column column, const LecturePage *left, Show *show)
{
    const Simulation *simulation = show_pane(show)->simulation;
    const LecturePage *page = simulation->options.page;
    const Picture *picture = picture_of(simulation->scene);
    if (column == COLUMN_PAGES) {
        show->page.kind = PAGE_HELP;
        show->page.title = "The pages of the lecture";
        show->help_rows = (int)fmin(lecture_count(), LAYOUT_ROWS);
    }
    for (int i = 0; column == COLUMN_PAGES && i < show->help_rows; i++) {
        const LecturePage *row = &lecture_pages[i];
        snprintf(show->help[i].key, SHOW_VALUE, "%s%d",
                 row == (page ? page : left) ? ">" : "", i + 1);
        snprintf(show->help[i].text, SHOW_TEXT, "%s", row->topic);
    }
    if (!page)
        return;
    show->lecture = page;
    show->topic = page->topic;
    show->numbers = page->numbers;
    snprintf(show->lecture_title, sizeof show->lecture_title,
             "page %d of %d \u00b7 K: its code and test",
             (int)(page - lecture_pages) + 1, lecture_count());
    show->hidden = show->veils = 0;
    for (int c = 0; c < picture->count; c++) {
        const char *name = picture->cards[c]->name; /* in no other name */
        bool open = strstr(page->cards, name);
        if (show->veiled && page->veils && strstr(page->veils, name))
            show->veils |= 1u << c;
        show->hidden |= open ? 0 : 1u << c;
        if (open && picture->cards[c]->closed)
            show->closed &= ~(1u << c);
    }
    if (column == COLUMN_CODE)
        fill_code(page, show);
}
