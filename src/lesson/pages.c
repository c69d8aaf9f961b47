/* pages.c - finds pages of the tour. */
#include "lesson/pages.h"

#include <string.h>

int lecture_count_pages(void)
{
    return names_count(NAMES_OF(lecture_pages));
}

const LecturePage *lecture_find_page(const char *text)
{
    int place = names_find_or_parse(NAMES_OF(lecture_pages), text);
    return place < 0 ? NULL : &lecture_pages[place];
}

bool page_wants_click(const LecturePage *page)
{
    return page && page->answer_name && strcmp(page->answer_name, "click") == 0;
}

bool page_wants_number(const LecturePage *page)
{
    return page && page->answer_name && !page_wants_click(page);
}

void lecture_apply_page(const LecturePage *page, Options *options)
{
    options->page = page;
    options->layers = page->layers;
    options->next_action = page->next_action;
    options->pause_step = page->pause_step;
    options->law_name = page->law_name;
    options->main_card = page->main_card;
    options->open_cards = page->open_cards;
}
