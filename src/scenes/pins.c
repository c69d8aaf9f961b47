#include "scenes/pins.h"

#include <stdbool.h>
#include <string.h>

/* Column and row of a node, from the lower left. */
typedef struct Cell {
    int column, row;
    int right, top; /* the last of each */
} Cell;

static bool is_top_corner(Cell at)
{
    return at.row == at.top && (at.column == 0 || at.column == at.right);
}

static bool is_top(Cell at)
{
    return at.row == at.top;
}

static bool is_bottom(Cell at)
{
    return at.row == 0;
}

static bool is_left(Cell at)
{
    return at.column == 0;
}

static bool is_right(Cell at)
{
    return at.column == at.right;
}

static const struct PinWord {
    const char *word;
    bool (*holds)(Cell at);
} pin_words[] = {
    {"top-corners", is_top_corner},
    {"top", is_top},
    {"bottom", is_bottom},
    {"left", is_left},
    {"right", is_right},
};

enum { PIN_WORDS = sizeof pin_words / sizeof *pin_words };

/* Pins the nodes that the word names; false: it is no word. */
static bool pin_word(const char *text, size_t length, int columns, int rows,
                     unsigned char *pinned)
{
    for (int i = 0; i < PIN_WORDS; i++) {
        if (strlen(pin_words[i].word) != length ||
            strncmp(pin_words[i].word, text, length) != 0)
            continue;
        int row = rows + 1;
        for (int node = 0; pinned && node < row * (columns + 1); node++)
            if (pin_words[i].holds(
                    (Cell){node / row, node % row, columns, rows}))
                pinned[node] = 1;
        return true;
    }
    return false;
}

/* Pins the node of this number; false: it is no number of a node. */
static bool pin_number(const char *text, size_t length, int columns, int rows,
                       unsigned char *pinned)
{
    long long number = 0, nodes = (columns + 1LL) * (rows + 1LL);
    if (length == 0)
        return false;
    for (size_t i = 0; i < length; i++) {
        if (text[i] < '0' || text[i] > '9')
            return false;
        number = 10 * number + (text[i] - '0');
        if (number >= nodes)
            return false;
    }
    if (pinned)
        pinned[number] = 1;
    return true;
}

Status pins_read(const char *text, int columns, int rows, unsigned char *pinned)
{
    for (;; text++) {
        size_t length = strcspn(text, ",");
        if (!pin_word(text, length, columns, rows, pinned) &&
            !pin_number(text, length, columns, rows, pinned))
            return STATUS_INVALID_INPUT;
        text += length;
        if (*text == '\0')
            return STATUS_OK;
    }
}
