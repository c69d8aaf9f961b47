/* card_listing.c - lines of an algorithm, and numbers that the slides print. */
#include <math.h>
#include <stdio.h>

#include "picture/cards.h"

/* Heights of a row (ems): on a page of the lecture; in a scene. */
static const double PAGE_PITCH = 2.1, PITCH = 1.75;
/* Part of the main card's height that the table of residuals takes. */
static const double TABLE_PART = 0.68;

ShownRow listing_make_row(const Pane *pane, const ListingRow *row)
{
    const LiveValues *values = &pane->values;
    const NewtonTrace *trace = pane->shown_trace;
    bool reached = trace && (trace->at_line == LINE_NONE ||
                             trace->at_line >= row->at_line);
    bool struck = text_has_line_to_show(values, row->crossed_out_if);
    return (ShownRow){.is_highlighted = trace && trace->at_line == row->at_line,
                      .is_crossed_out = struck,
                      .text = text_find_known_line(values, row->text),
                      .value = text_find_known_line(
                          values, reached || struck ? row->value : NULL)};
}

/* Draws a row of the listing: number, text, value. */
static void draw_listing_row(const Plot *card, Box box, const ListingRow *row,
                             int number)
{
    Paper *paper = card->paper;
    const ShownRow now = listing_make_row(card->pane, row);
    char digits[12];
    double size = box.height < 0.95 * PAGE_PITCH * paper->em ? 1 : 1.2;
    int indent = paper_to_pixels(paper, 2 + 1.2 * row->is_indented);
    int wide = paper_measure(paper, FACE_REGULAR, 0.88 * size, now.value.text);
    Box count = {box.x, box.y, paper_to_pixels(paper, 1.2), box.height};
    Box room = {box.x + indent, box.y,
                box.width - indent - wide - paper_to_pixels(paper, 1.4),
                box.height};
    bool both = paper_measure(paper, FACE_REGULAR, paper->min_letter_size,
                              now.text.text) <= room.width;
    room.width += both ? 0 : wide;
    if (now.is_highlighted)
        canvas_fill(&paper->canvas, box, COLOUR_LIT);
    snprintf(digits, sizeof digits, "%d", number);
    paper_write_in_box(paper, FACE_REGULAR, 0.82, COLOUR_GREY, count,
                       ALIGN_RIGHT, digits);
    int text =
        paper_write_in_box(paper, FACE_REGULAR, size,
                           now.is_crossed_out ? COLOUR_GREY : COLOUR_TEXT, room,
                           ALIGN_LEFT, now.text.text);
    if (now.is_crossed_out)
        canvas_fill(&paper->canvas,
                    (Box){room.x, box.y + box.height / 2, text,
                          (int)fmax(1, 1.3 * paper->unit)},
                    COLOUR_GREY);
    box.width -= paper_to_pixels(paper, 0.6);
    if (both)
        paper_write_in_box(paper, FACE_REGULAR, 0.88 * size,
                           now.is_highlighted ? COLOUR_TEXT : COLOUR_FAINT, box,
                           ALIGN_RIGHT, now.value.text);
}

/* Draws the rows that are shown now, from the box `line` downwards; draw NULL:
 * draws nothing.  Returns the number of these rows. */
static int typeset_listing(const FrameContent *content, const ListingRow *row,
                           const Plot *draw, Box line)
{
    int count = 0;
    for (; row->shown_if; row++)
        if (text_has_line_to_show(&active_pane(content)->values,
                                  row->shown_if)) {
            if (draw)
                draw_listing_row(draw, line, row, count + 1);
            line.y += line.height;
            count++;
        }
    return count;
}

/* Returns the height of a row, ems; the rows of a page are read from afar. */
static double find_row_pitch(const FrameContent *content)
{
    return content->lecture.page ? PAGE_PITCH : PITCH;
}

double listing_find_height(const FrameContent *content, double wide, double em)
{
    return find_row_pitch(content) *
               typeset_listing(content, rows_listing, NULL, (Box){0}) +
           2.6;
}

void card_write_listing(const Plot *card, const ListingRow *row)
{
    double pitch = card->em * find_row_pitch(card->content);
    int count = typeset_listing(card->content, row, NULL, (Box){0});
    Box line = card->box;
    line.height = (int)fmin(lround(pitch), line.height / (double)count);
    typeset_listing(card->content, row, card, line);
}

/* Fills a row of an update, or the last row, which says why the loop ended. */
bool residuals_make_row(const FrameContent *content, int row,
                        CardTableRow *cells)
{
    const NewtonTrace *trace = active_pane(content)->shown_trace;
    int count = trace ? trace->record_count : 0;
    if (count == 0 || row == 0)
        return count > 0;
    const NewtonRecord *now =
        &trace->record[row <= count ? row - 1 : count - 1];
    if (row > count) {
        snprintf(cells->cell[1], CARD_CELL, "%s\u2264 \u03b5: the loop ends",
                 now->residual > trace->tolerance ? "next " : "");
        return row == count + 1 && now->status == STATUS_OK;
    }
    snprintf(cells->cell[0], CARD_CELL, "%d", row);
    snprintf(cells->cell[1], CARD_CELL, "%s",
             format_digits(now->residual, 4).text);
    snprintf(cells->cell[2], CARD_CELL, "%s", format_number(now->alpha).text);
    if (row > 1)
        snprintf(cells->cell[3], CARD_CELL, "\u00f7 %s",
                 format_number(now[-1].residual / now->residual).text);
    return true;
}

/* Draws the table of residuals, and on a high card their plot below. */
void draw_residual_table_card(const Plot *card)
{
    static const int order[CARD_COLUMNS] = {0, 1, 3, 2};
    Plot above = *card, below = *card;
    const NewtonTrace *trace = card->pane->shown_trace;
    if (card->content->has_document) {
        draw_residual_card(card);
        return;
    }
    if (trace && card->box.height > 14 * card->em) {
        above.box = box_cut_off(&below.box, EDGE_TOP,
                                (int)(TABLE_PART * card->box.height));
        above.box.height -= paper_to_pixels(card->paper, 0.7);
        draw_residual_card(&below);
    }
    if (trace && trace->record_count > 0)
        card_draw_table(&above, &card_prints, order);
    else
        card_write_hint(&above, text_undrawn);
}
