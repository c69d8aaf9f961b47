#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"
#include "scenes/listing.h"

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

/* How many lines from this one on only declare, report, remark or give back, a
 * condition before them included: a class reads past them. */
static int count_asides(const char *const *line)
{
    static const char words[] =
        "/*|FAIL(|fprintf(|fputs(|puts(|char |const char *states|snprintf(|"
        "FILE *f|return NULL;|(void)|free(|cholmod_free|cholmod_finish|"
        "cholmod_start|cholmod_common c|common.|size_t n|SDL_Quit|Vec2 *x|"
        "Vec2 *p|int n = |Solid solid = {|Parameter *|Parameter method|"
        "Parameter steps|for (int a|states = |read_argument(|bool drawn|"
        "Screen s|cholmod_triplet *IJV|if (drawn ?|";
    const char *head = line[0] + strspn(line[0], " ");
    bool heads = strncmp(head, "if (", 4) == 0 ||
                 strncmp(head, "for (", 5) == 0 || strcmp(head, "else") == 0;
    for (int count = 0; count <= (heads && !strchr(head, '{')); count++) {
        const char *body = line[count] + strspn(line[count], " ");
        size_t length;
        for (const char *word = words; *word; word += length + 1) {
            length = strcspn(word, "|");
            if (strncmp(body, word, length) != 0)
                continue;
            while (!strstr(line[count], word == words ? "*/" : ";"))
                count++;
            return count + 1;
        }
    }
    return 0;
}

/* The lines of the page's functions, as many as there is room for. */
static void fill_code(const LecturePage *page, Show *show)
{
    const Listing *listing = listing_find(page->file);
    const char *text = lit_text(show, page);
    Page *code = &show->page;
    *code = (Page){.kind = PAGE_CODE, .title = page->file};
    for (const char *names = page->function; listing && *names;) {
        char name[40];
        int length = (int)strcspn(names, ","), from, at, to;
        snprintf(name, sizeof name, "%.*s", length, names);
        names += length + (names[length] == ',');
        if (!listing_function(listing, name, &from, &at, &to))
            continue;
        if (code->lines > 0 && code->lines < SHOW_CODE_LINES)
            code->line[code->lines++] = "";
        while (at < to && code->lines < SHOW_CODE_LINES) {
            int last = code->lines - 1, asides;
            bool begins = last >= 0 && code->line[last][0] == '{';
            asides = count_asides(listing->line + at);
            at += asides;
            at += begins && !listing->line[at][0];
            if (asides > 0)
                continue;
            code->lit[code->lines] = strstr(listing->line[at], text) != NULL;
            code->line[code->lines++] = listing->line[at++];
        }
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
