#include "picture/text_block.h"

#include <stdarg.h>
#include <stdio.h>

#include "picture/colour_map.h"

enum { BLOCK_MARGIN = 4, BLOCK_LEADING = 1 }; /* units */

/* Formats into the next line. */
void text_block_add(TextBlock *block, Colour colour, const char *format, ...)
{
    if (block->lines >= TEXT_BLOCK_LINES)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(block->text[block->lines], TEXT_BLOCK_SIZE, format, arguments);
    va_end(arguments);
    block->colour[block->lines++] = colour;
}

/* Distance of two lines in pixels. */
static int block_pitch(const Paper *paper)
{
    return paper->font.height + paper_pixels(paper, BLOCK_LEADING);
}

/* Widest line by number of lines, and margins. */
Box text_block_size(const TextBlock *block, const Paper *paper)
{
    int margin = paper_pixels(paper, BLOCK_MARGIN);
    Box box = {0, 0, 0, block->lines * block_pitch(paper) + 2 * margin};
    for (int i = 0; i < block->lines; i++) {
        int width = font_width(&paper->font, block->text[i]) + 2 * margin;
        box.width = width > box.width ? width : box.width;
    }
    return box;
}

/* All lines begin at the left. */
void text_block_draw(const TextBlock *block, Paper *paper, int x, int y,
                     Align align)
{
    if (block->lines == 0)
        return;
    int margin = paper_pixels(paper, BLOCK_MARGIN);
    Box box = text_block_size(block, paper);
    box.x = align == ALIGN_LEFT     ? x
            : align == ALIGN_CENTRE ? x - box.width / 2
                                    : x - box.width;
    box.y = y;
    paper_panel(paper, box);
    for (int i = 0; i < block->lines; i++) {
        int top = box.y + margin + i * block_pitch(paper);
        (block->colour[i] == COLOUR_WARNING ? paper_bold_text : paper_text)(
            paper, box.x + margin, top, ALIGN_LEFT, block->colour[i],
            block->text[i]);
    }
}
