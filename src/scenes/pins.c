#include "scenes/pins.h"

#include <stdbool.h>
#include <string.h>

/* A node is meant that is on this side and, where `or` is not 0, on one of
 * those. */
static const struct PinWord {
    const char *word;
    int side, or ;
} pin_words[] = {
    {"top-corners", MESH_TOP, MESH_LEFT | MESH_RIGHT},
    {"top", MESH_TOP, 0},
    {"bottom", MESH_BOTTOM, 0},
    {"left", MESH_LEFT, 0},
    {"right", MESH_RIGHT, 0},
};

enum { PIN_WORDS = sizeof pin_words / sizeof *pin_words };

/* Pins the nodes that the word names; false: it is no word. */
static bool pin_word(const char *text, size_t length, const SquareMesh *shape,
                     unsigned char *pinned)
{
    for (int i = 0; i < PIN_WORDS; i++) {
        const struct PinWord *word = &pin_words[i];
        if (strlen(word->word) != length ||
            strncmp(word->word, text, length) != 0)
            continue;
        for (int node = 0; pinned && node < shape->nodes; node++) {
            int sides = square_mesh_sides(shape, node);
            if ((sides & word->side) && (!word->or || (sides & word->or)))
                pinned[node] = 1;
        }
        return true;
    }
    return false;
}

/* Pins the node of this number; false: it is no number of a node. */
static bool pin_number(const char *text, size_t length, int nodes,
                       unsigned char *pinned)
{
    long long number = 0;
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

Status pins_read(const char *text, const SquareMesh *shape,
                 unsigned char *pinned)
{
    for (;; text++) {
        size_t length = strcspn(text, ",");
        if (!pin_word(text, length, shape, pinned) &&
            !pin_number(text, length, shape->nodes, pinned))
            return STATUS_INVALID_INPUT;
        text += length;
        if (*text == '\0')
            return STATUS_OK;
    }
}
