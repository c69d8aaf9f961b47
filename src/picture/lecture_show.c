/* lecture_show.c - lists of pages and letters, and what a page shows. */
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"

_Static_assert((int)LINE_COUNT == PAGE_HIGHLIGHT_COUNT,
               "walk has a text for each line");

const char *lecture_find_highlight(const FrameContent *content)
{
    const LecturePage *page = content->lecture.page;
    const NewtonTrace *trace = active_pane(content)->trace;
    bool walks = page->line_highlight && trace && trace->at_line != LINE_NONE;
    return walks ? page->line_highlight[trace->at_line] : page->highlight_text;
}

/* Lists all pages of the lecture, with a heading before each section.
 *   marked  page with a mark: the open page, or the page that was open last */
static void list_pages(const LecturePage *marked, FrameContent *content)
{
    ListRow *row = content->list.row;
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        if (page->section) {
            *row = (ListRow){.style = ROW_HEADING, .target_index = -1};
            snprintf((row++)->text, SENTENCE_SIZE, "%s", page->section);
        }
        *row = (ListRow){.target_index = (int)(page - lecture_pages),
                         .style = page->is_extra ? ROW_GREY : ROW_PLAIN};
        snprintf(row->key, VALUE_SIZE, "%s%d", page == marked ? ">" : "",
                 row->target_index + 1);
        snprintf((row++)->text, SENTENCE_SIZE, "%s%s", page->topic,
                 page->is_extra ? " (extra)" : "");
    }
    content->list.row_count = (int)(row - content->list.row);
}

static void list_formula_letters(FrameContent *content)
{
    ListRow *row = content->list.row;
    for (const SlideLetter *letter = lecture_letters; letter->letter;
         letter++) {
        snprintf(row->key, VALUE_SIZE, "%s", letter->letter);
        snprintf((row++)->text, SENTENCE_SIZE, "%s", letter->meaning);
    }
    content->list.row_count = (int)(row - content->list.row);
}

/* Adds a text's lines with live values; live false: the lines without. */
static void add_text_lines(const char *text, bool live, char *out, size_t size)
{
    while (*text) {
        size_t length = strcspn(text, "\n");
        bool has_value = false; /* the line has a live value */
        for (const char *at = text; at < text + length; at++)
            has_value |= *at == '{' && !text_is_markup_brace(text, at);
        if (has_value == live)
            append(out, size, "%.*s\n", (int)length, text);
        text += length + (text[length] == '\n');
    }
}

/* Copies the answer of the page.  If the user has changed options, lines with
 * live values come first.  The other lines, which hold only for the page's own
 * options, follow below lecture->heading. */
static void build_answer_text(const LecturePage *page, LectureContent *lecture)
{
    char *look = lecture->answer_text, others[ANSWER_SIZE] = "";
    look[0] = '\0';
    add_text_lines(page->answer_text, false, others, sizeof others);
    if (lecture->heading[0]) {
        add_text_lines(page->answer_text, true, look, ANSWER_SIZE);
        if (others[0])
            append(look, ANSWER_SIZE, "%s\n%s", lecture->heading, others);
    } else {
        append(look, ANSWER_SIZE, "%s", page->answer_text);
    }
}

void frame_add_lecture(ColumnContent column, const LecturePage *left,
                       FrameContent *content)
{
    const Simulation *simulation = active_pane(content)->simulation;
    const LecturePage *page = simulation->options.page;
    const Picture *picture = picture_of_scene(simulation->scene);
    if (column == COLUMN_PAGES)
        list_pages(page ? page : left, content);
    if (column == COLUMN_LETTERS)
        list_formula_letters(content);
    content->column = page || column != COLUMN_CODE ? column : COLUMN_CARDS;
    if (!page)
        return;
    content->lecture.page = page;
    build_answer_text(page, &content->lecture);
    if (content->lecture.hides_answer)
        content->lecture.question = page->question;
    content->title_bar.topic = page->topic;
    content->cards.covered_cards = 0;
    for (int c = 0; c < picture->card_count; c++)
        if (content->lecture.hides_answer && page->covered_cards &&
            strstr(page->covered_cards, picture->cards[c]->name))
            content->cards.covered_cards |= 1u << c;
}
