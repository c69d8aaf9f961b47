#include <stdlib.h>

#include "picture/cards.h"
#include "picture/colour_map.h"

/* More nodes than the card has pixels show nothing. */
enum { SPY_NODES = 4500 };

/* What a block holds. */
enum { NOTHING, FILL, ENTRY };

/* Place of a node in the elimination order. */
static int node_place(const System *system, int node)
{
    return system->order ? system->order[node] : node;
}

/* What is in row i of column j < i of the factor: [j n + i]; NULL: not enough
 * memory.  A column has what the matrix has there, and what each column has
 * whose first entry below the diagonal it is (George and Liu 1981). */
static unsigned char *make_pattern(const System *system)
{
    size_t n = (size_t)system->nodes;
    unsigned char *block = calloc(n, n);
    for (int s = 0; block && s < system->springs; s++) {
        size_t i = (size_t)node_place(system, system->e[2 * s]);
        size_t j = (size_t)node_place(system, system->e[2 * s + 1]);
        block[i < j ? i * n + j : j * n + i] = ENTRY;
    }
    for (size_t j = 0; block && j < n; j++) {
        size_t parent = j + 1;
        while (parent < n && !block[j * n + parent])
            parent++;
        for (size_t i = parent + 1; i < n; i++)
            if (block[j * n + i] && !block[parent * n + i])
                block[parent * n + i] = FILL;
    }
    return block;
}

/* The block in row i, column j of n, at least a pixel large. */
static void draw_block(Canvas *canvas, int n, int i, int j, Colour colour)
{
    int side = canvas->width;
    int x = (int)((long)j * side / n), y = (int)((long)i * side / n);
    int wide = (int)((long)(j + 1) * side / n) - x;
    int high = (int)((long)(i + 1) * side / n) - y;
    if (n * 5 < side) { /* a gap between the blocks */
        wide--;
        high--;
    }
    canvas_rectangle(canvas, x, y, wide > 1 ? wide : 1, high > 1 ? high : 1,
                     colour);
}

/* Above the diagonal the matrix, below it the factor with its fill. */
static void draw_pattern(Canvas *canvas, int n, const unsigned char *block)
{
    for (int j = 0; j < n; j++)
        for (int i = j + 1; i < n; i++) {
            int what = block[(size_t)j * (size_t)n + (size_t)i];
            if (what == ENTRY)
                draw_block(canvas, n, j, i, COLOUR_X);
            if (what != NOTHING)
                draw_block(canvas, n, i, j,
                           what == ENTRY ? COLOUR_X : 0xffe0a060u);
        }
    for (int i = 0; i < n; i++)
        draw_block(canvas, n, i, i, COLOUR_X);
}

/* The four blocks of the spring under the mouse. */
static void light_spring(Paper *paper, const Show *show, Box square)
{
    const Pick *hover = &show->hover;
    const System *system = &show->pane[show->active].simulation->system;
    if (hover->kind != PICK_SPRING || hover->index >= system->springs)
        return;
    const int *e = system->e + 2 * hover->index;
    const long place[2] = {node_place(system, e[0]), node_place(system, e[1])};
    int n = system->nodes, least = paper_pixels(paper, 0.35);
    int size = square.width / n > least ? square.width / n : least;
    for (int k = 0; k < 4; k++) {
        int x = square.x + (int)(place[k % 2] * square.width / n);
        int y = square.y + (int)(place[k / 2] * square.width / n);
        canvas_rectangle(&paper->canvas, x - 1, y - 1, size + 2, size + 2,
                         COLOUR_WHITE);
        canvas_rectangle(&paper->canvas, x, y, size, size, COLOUR_PROJECT);
    }
}

/* What the colours mean, beside the square or below it. */
static void draw_words(Paper *paper, Box words, int side)
{
    int line = paper_pixels(paper, 1.3), used = side + line / 2;
    if (words.width > words.height) {
        words.x += used;
        words.width -= used;
    } else {
        words.y += used;
        words.height -= used;
    }
    int room = words.height / line / 2;
    if (words.width < 6 * line || room < 1)
        return;
    room = room < 4 ? room : 4;
    int lines =
        paper_paragraph(paper, FACE_REGULAR, 0.85, COLOUR_X, words, room,
                        "blue: a 2 \u00d7 2 block of \u2207\u00b2E, "
                        "in the order of elimination");
    words.y += lines * paper_pixels(paper, 1.12) + line / 2;
    paper_paragraph(paper, FACE_REGULAR, 0.85, 0xffb87a30u, words, room,
                    "below the diagonal: the factor L with its fill");
}

/* Made once for a mesh, then copied. */
static void draw_spy(Paper *paper, Box inside, const Show *show)
{
    const System *system = &show->pane[show->active].simulation->system;
    int side = inside.width < inside.height ? inside.width : inside.height;
    int line = paper_pixels(paper, 1.3);
    bool drawn = false;
    if (side < 4 * line || system->nodes > SPY_NODES || system->nodes < 1) {
        cards_hint(paper, inside, show,
                   side < 4 * line ? "enlarge it" : "too many nodes to draw");
        return;
    }
    Box square = {inside.x, inside.y, side, side};
    const int facts[2] = {system->nodes, system->springs};
    uint64_t key = paper_key(0, facts, sizeof facts);
    Canvas *kept = paper_keep(paper, KEEP_SPY, key, side, side, &drawn);
    if (!kept)
        return;
    unsigned char *block = drawn ? NULL : make_pattern(system);
    if (block)
        draw_pattern(kept, system->nodes, block);
    free(block);
    canvas_copy(&paper->canvas, kept, square.x, square.y);
    light_spring(paper, show, square);
    draw_words(paper, inside, side);
}

const Card card_spy = {
    .name = "spy",
    .title = "Hessian and its factor",
    .least = 12,
    .weight = 2,
    .closed = true,
    .draw = draw_spy,
};
