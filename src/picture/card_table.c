/* card_table.c - draws the table of a card, in letters as large as fit. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/cards.h"

bool card_make_row(const FrameContent *content, const Card *card, int row,
                   CardTableRow *cells)
{
    const LiveValues *values = &active_pane(content)->values;
    const TextLine heads = text_find_known_line(values, card->column_heads);
    size_t length;
    *cells = (CardTableRow){.colour = COLOUR_TEXT};
    for (const char *at = heads.text; *at; cells->columns++) {
        length = strcspn(at, "|");
        if (row == 0)
            snprintf(cells->cell[cells->columns], CARD_CELL, "%.*s",
                     (int)length, at);
        at += length + (at[length] == '|');
    }
    return card->make_row(content, row, cells);
}

void card_draw_table(const Plot *card, const Card *table, const int *order)
{
    /* Largest size of letters (ems), largest height of a row / letter size. */
    const double largest = 1.4, most = 2.2;
    Paper *paper = card->paper;
    const Box *box = &card->box;
    CardTableRow cells;
    double wide[CARD_COLUMNS] = {0}, em = paper->em, gap = 0.7 * em, all = 0;
    int rows = 0, columns = 0;
    bool shown[CARD_COLUMNS] = {false};
    for (; card_make_row(card->content, table, rows, &cells); rows++)
        for (int c = 0; c < cells.columns && cells.cell[0][0]; c++)
            wide[c] = fmax(wide[c],
                           paper_measure(paper, rows ? FACE_REGULAR : FACE_BOLD,
                                         1, cells.cell[c]));
    for (int c = 0; c < cells.columns; c++)
        all += wide[c] + gap;
    double size = fmin(box->width / all, box->height / (rows * CARD_ROW * em));
    size = fmin(fmax(size, 1), largest);
    double rest = box->width / size + gap;
    for (; columns < cells.columns && order[columns] >= 0 &&
           wide[order[columns]] + gap <= rest;
         columns++) {
        rest -= wide[order[columns]] + gap;
        shown[order[columns]] = true;
    }
    gap += rest / fmax(columns - 1, 1);
    double line = fmin(fmax(box->height / (double)rows, CARD_ROW * size * em),
                       most * size * em);
    int skipped = rows - (int)fmin(rows, box->height / line + 0.01);
    for (int i = 0; i < rows - skipped; i++) {
        double right = box->x - size * gap;
        card_make_row(card->content, table, i > 1 ? i + skipped : i, &cells);
        for (int c = 0; c < cells.columns; c++) {
            right += shown[c] ? size * (wide[c] + gap) : 0;
            if (shown[c])
                paper_write(paper, i ? FACE_REGULAR : FACE_BOLD, size,
                            c ? COLOUR_TEXT : cells.colour, c ? right : box->x,
                            box->y + i * line, c ? ALIGN_RIGHT : ALIGN_LEFT,
                            "%s", cells.cell[c]);
        }
    }
}
