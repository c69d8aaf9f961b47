#include <stdio.h>
#include <string.h>

#include "picture/cards.h"
#include "scenes/listing.h"
#include "scenes/scene.h"

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
    if (strcmp(page->function, "step_forward") == 0 && trace &&
        trace->line != LINE_NONE && line_texts[trace->line])
        return line_texts[trace->line];
    if (page->kinds)
        return kinds[exhibit_kind(simulation, lecture_spring(simulation))];
    return page->lit;
}

/* The function with the comment above it, from near the first lit line on if
 * it is long. */
static void fill_code(const LecturePage *page, Show *show)
{
    const Listing *listing = listing_find(page->file);
    Page *code = &show->page;
    int from, body, to, first = -1;
    if (!listing ||
        !listing_function(listing, page->function, &from, &body, &to))
        return;
    const char *text = lit_text(show, page);
    code->kind = PAGE_CODE;
    code->title = page->file;
    code->line = listing->line + from;
    code->lines = to - from < SHOW_CODE_LINES ? to - from : SHOW_CODE_LINES;
    for (int i = body - from; i < code->lines; i++) {
        code->lit[i] = strstr(code->line[i], text) != NULL;
        if (code->lit[i] && first < 0)
            first = i;
    }
    code->top = first > 24 ? first - 12 : 0;
}

/* Numbers and topics; a page is marked. */
static void fill_pages(const LecturePage *marked, Show *show)
{
    int count = lecture_count();
    show->page.kind = PAGE_HELP;
    show->page.title = "The pages of the lecture";
    show->help = show->page_row;
    show->help_rows = count < SHOW_PAGES ? count : SHOW_PAGES;
    for (int i = 0; i < show->help_rows; i++) {
        bool now = &lecture_pages[i] == marked;
        snprintf(show->page_key[i], sizeof show->page_key[i], "%s%d",
                 now ? ">" : "", i + 1);
        show->page_row[i] =
            (HelpRow){show->page_key[i], lecture_pages[i].topic};
    }
}

/* Whether a word stands in a text of words. */
static bool has_word(const char *words, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = strstr(words, word); at; at = strstr(at + 1, word))
        if ((at == words || at[-1] == ' ') &&
            (at[length] == ' ' || at[length] == '\0'))
            return true;
    return false;
}

void show_lecture(LectureColumn column, const LecturePage *left, Show *show)
{
    const Simulation *simulation = show_pane(show)->simulation;
    const LecturePage *page = simulation->options.page;
    const Picture *picture = picture_of(simulation->scene);
    if (column == LECTURE_PAGES)
        fill_pages(page ? page : left, show);
    if (!page)
        return;
    show->lecture = page;
    show->topic = page->topic;
    show->numbers = page->numbers;
    snprintf(show->lecture_title, sizeof show->lecture_title,
             "page %d of %d \u00b7 K: its code and test",
             (int)(page - lecture_pages) + 1, lecture_count());
    show->hidden = show->veils = 0;
    for (int c = 0; picture->cards[c]; c++) {
        bool open = has_word(page->cards, picture->cards[c]->name);
        if (show->veiled && page->veils &&
            has_word(page->veils, picture->cards[c]->name))
            show->veils |= 1u << c;
        show->hidden |= open ? 0 : 1u << c;
        if (open && picture->cards[c]->closed)
            show->closed &= ~(1u << c);
    }
    if (column == LECTURE_CODE)
        fill_code(page, show);
}
