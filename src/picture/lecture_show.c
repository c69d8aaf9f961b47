/* lecture_show.c - the code and the columns that pages of the lecture show. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"

_Static_assert((int)LINE_COUNT == LINES_WALKED, "a page has all lines");

const char *lecture_lit_code(const Show *show)
{
    const LecturePage *page = show->lecture;
    const Trace *trace = show_pane(show)->trace;
    const Options *options = &show_pane(show)->simulation->options;
    bool whole = options->line_search == LINE_SEARCH_NONE;
    bool walks = page->walk && trace && trace->line != LINE_NONE && !whole;
    return walks ? page->walk[trace->line] : page->lit;
}

/* Lists all pages of the lecture, each section below its heading.
 *   marked  page that gets a mark: the open one, or the one last open */
static void list_pages(const LecturePage *marked, Show *show)
{
    HelpRow *row = show->help;
    for (const LecturePage *page = lecture_pages;
         page->name && row < show->help + LAYOUT_ROWS - 1; page++) {
        if (page->section) {
            *row = (HelpRow){.head = true};
            snprintf((row++)->text, SHOW_TEXT, "%s", page->section);
        }
        *row = (HelpRow){.grey = page->extra};
        snprintf(row->key, SHOW_VALUE, "%s%d", page == marked ? ">" : "",
                 (int)(page - lecture_pages) + 1);
        snprintf((row++)->text, SHOW_TEXT, "%s%s", page->topic,
                 page->extra ? " (extra)" : "");
    }
    show->help_rows = (int)(row - show->help);
}

static void list_letters(Show *show)
{
    HelpRow *row = show->help;
    for (const Letter *letter = lecture_letters;
         letter->letter && row < show->help + LAYOUT_ROWS; letter++, row++) {
        *row = (HelpRow){.grey = false};
        snprintf(row->key, SHOW_VALUE, "%s", letter->letter);
        snprintf(row->text, SHOW_TEXT, "%s", letter->meaning);
    }
    show->help_rows = (int)(row - show->help);
}

void show_lecture(Column column, const LecturePage *left, Show *show)
{
    const Simulation *simulation = show_pane(show)->simulation;
    const LecturePage *page = simulation->options.page;
    const Picture *picture = picture_of(simulation->scene);
    if (column == COLUMN_PAGES)
        list_pages(page ? page : left, show);
    if (column == COLUMN_LETTERS)
        list_letters(show);
    show->column = page || column != COLUMN_CODE ? column : COLUMN_CARDS;
    if (!page)
        return;
    show->lecture = page;
    show->topic = page->topic;
    show->hidden = show->veils = 0;
    for (int c = 0; c < picture->count; c++) {
        /* strstr is safe: no card's name is part of another's. */
        const char *name = picture->cards[c]->name;
        bool open = strstr(page->cards, name);
        if (show->veiled && page->veils && strstr(page->veils, name))
            show->veils |= 1u << c;
        show->hidden |= open ? 0 : 1u << c;
        if (open && picture->cards[c]->starts_closed)
            show->closed &= ~(1u << c);
    }
}
