/* text_block.h - a few lines of text on a panel.
 */
#ifndef ELASTO_TEXT_BLOCK_H
#define ELASTO_TEXT_BLOCK_H

#include "picture/paper.h"

enum { TEXT_BLOCK_LINES = 24, TEXT_BLOCK_SIZE = 96 };

typedef struct TextBlock {
    int lines;
    Colour colour[TEXT_BLOCK_LINES];
    char text[TEXT_BLOCK_LINES][TEXT_BLOCK_SIZE]; /* '\0' at the end */
} TextBlock;

/* Adds a line as printf does; longer ones are cut, further ones dropped. */
void text_block_add(TextBlock *block, Colour colour, const char *format, ...);

/* Pixels that the block with its margins needs. */
Box text_block_size(const TextBlock *block, const Paper *paper);

/* Draws panel and lines, warnings in bold.  (x, y) is the upper edge of the
 * panel, at its left end, middle or right end. */
void text_block_draw(const TextBlock *block, Paper *paper, int x, int y,
                     Align align);

#endif
