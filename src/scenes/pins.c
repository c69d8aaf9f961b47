#include "scenes/pins.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
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

/* Pins what one item names; false: it is neither a word nor a node. */
static bool pin_item(const char *item, const SquareMesh *shape,
                     unsigned char *pinned)
{
    const int words = sizeof pin_words / sizeof *pin_words;
    const struct PinWord *word = pin_words;
    while (word < pin_words + words && strcmp(word->word, item) != 0)
        word++;
    bool is_word = word < pin_words + words;
    size_t digits = strspn(item, "0123456789");
    long number = digits > 0 && digits < 10 ? atol(item) : -1;
    if (!is_word && (item[digits] || number < 0 || number >= shape->nodes))
        return false;
    for (int node = 0; pinned && node < shape->nodes; node++) {
        int sides = is_word ? square_mesh_sides(shape, node) : 0;
        if (is_word ? (sides & word->side) && (!word->or || (sides & word->or))
                    : node == number)
            pinned[node] = 1;
    }
    return true;
}

Status pins_read(const char *text, const SquareMesh *shape,
                 unsigned char *pinned)
{
    for (;; text++) {
        char item[32];
        size_t length = strcspn(text, ",");
        snprintf(item, sizeof item, "%.*s", (int)length, text);
        if (length >= sizeof item || !pin_item(item, shape, pinned))
            return STATUS_INVALID_INPUT;
        text += length;
        if (*text == '\0')
            return STATUS_OK;
    }
}
