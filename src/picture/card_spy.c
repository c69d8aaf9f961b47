#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"

/* More nodes than the card has pixels show nothing. */
enum { SPY_NODES = 4500, WORD = 64 };

/* Which blocks are there, one bit each; row j holds the places i > j. */
typedef struct Pattern {
    int size, words; /* blocks a side, words a row */
    uint64_t *matrix, *factor;
} Pattern;

static void set_bit(uint64_t *rows, const Pattern *pattern, int j, int i)
{
    rows[(size_t)j * (size_t)pattern->words + (size_t)(i / WORD)] |=
        (uint64_t)1 << i % WORD;
}

static bool has_bit(const uint64_t *rows, const Pattern *pattern, int j, int i)
{
    return rows[(size_t)j * (size_t)pattern->words + (size_t)(i / WORD)] >>
               i % WORD &
           1;
}

/* Place of a node in the elimination order. */
static int node_place(const System *system, int node)
{
    return system->order ? system->order[node] : node;
}

/* Column j of the factor has what the matrix has there, and what each column
 * has whose first entry below the diagonal is j (George and Liu 1981). */
static void fill_factor(Pattern *pattern)
{
    int n = pattern->size, words = pattern->words;
    memcpy(pattern->factor, pattern->matrix,
           (size_t)n * (size_t)words * sizeof *pattern->factor);
    for (int j = 0; j < n; j++) {
        uint64_t *column = pattern->factor + (size_t)j * (size_t)words;
        int parent = j + 1;
        while (parent < n && !has_bit(pattern->factor, pattern, j, parent))
            parent++;
        if (parent == n)
            continue;
        uint64_t *above = pattern->factor + (size_t)parent * (size_t)words;
        for (int w = 0; w < words; w++)
            above[w] |= column[w];
        above[parent / WORD] &= ~((uint64_t)1 << parent % WORD);
        for (int w = 0; w < parent / WORD; w++)
            above[w] = 0;
        above[parent / WORD] &=
            ~(((uint64_t)1 << parent % WORD) - 1); /* only places below */
    }
}

static bool make_pattern(const System *system, Pattern *pattern)
{
    int n = system->nodes, words = (n + WORD - 1) / WORD;
    size_t size = (size_t)n * (size_t)words;
    *pattern = (Pattern){n, words, calloc(size, sizeof(uint64_t)),
                         calloc(size, sizeof(uint64_t))};
    if (!pattern->matrix || !pattern->factor)
        return false;
    for (int s = 0; s < system->springs; s++) {
        int i = node_place(system, system->e[2 * s]);
        int j = node_place(system, system->e[2 * s + 1]);
        set_bit(pattern->matrix, pattern, i < j ? i : j, i < j ? j : i);
    }
    fill_factor(pattern);
    return true;
}

/* The block in row i, column j of n, at least a pixel large. */
static void draw_block(Canvas *canvas, int n, int i, int j, int least,
                       Colour colour)
{
    int side = canvas->width;
    int x = (int)((long)j * side / n), y = (int)((long)i * side / n);
    int wide = (int)((long)(j + 1) * side / n) - x;
    int high = (int)((long)(i + 1) * side / n) - y;
    if (n * 5 < side) { /* a gap between the blocks */
        wide--;
        high--;
    }
    wide = wide < least ? least : wide;
    high = high < least ? least : high;
    canvas_rectangle(canvas, x, y, wide, high, colour);
}

/* Above the diagonal the matrix, below it the factor with its fill. */
static void draw_pattern(Canvas *canvas, const Pattern *pattern)
{
    int n = pattern->size;
    for (int j = 0; j < n; j++)
        for (int i = j + 1; i < n; i++) {
            bool there = has_bit(pattern->matrix, pattern, j, i);
            if (there)
                draw_block(canvas, n, j, i, 1, COLOUR_X);
            if (has_bit(pattern->factor, pattern, j, i))
                draw_block(canvas, n, i, j, 1, there ? COLOUR_X : 0xffe0a060u);
        }
    for (int i = 0; i < n; i++)
        draw_block(canvas, n, i, i, 1, COLOUR_X);
}

/* The four blocks of the spring under the mouse. */
static void light_spring(Paper *paper, const Show *show, Box square)
{
    const Pick *hover = &show->hover;
    const System *system = &show->pane[show->active].simulation->system;
    int place[2];
    if (hover->kind != PICK_SPRING || hover->index >= system->springs)
        return;
    for (int k = 0; k < 2; k++)
        place[k] = node_place(system, system->e[2 * hover->index + k]);
    Canvas *canvas = &paper->canvas;
    int n = system->nodes, least = paper_pixels(paper, 0.35);
    for (int k = 0; k < 4; k++) {
        int x = square.x + (int)((long)place[k % 2] * square.width / n);
        int y = square.y + (int)((long)place[k / 2] * square.width / n);
        int size = square.width / n > least ? square.width / n : least;
        canvas_rectangle(canvas, x - 1, y - 1, size + 2, size + 2,
                         COLOUR_WHITE);
        canvas_rectangle(canvas, x, y, size, size, COLOUR_PROJECT);
    }
}

/* What the colours mean, beside the square or below it. */
static void draw_words(Paper *paper, Box inside, int side)
{
    int line = paper_pixels(paper, 1.3);
    Box words = inside;
    if (inside.width - side > inside.height - side) {
        words.x += side + line / 2;
        words.width -= side + line / 2;
    } else {
        words.y += side + line / 2;
        words.height -= side + line / 2;
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
        cards_hint(paper, inside,
                   side < 4 * line ? "enlarge it" : "too many nodes to draw");
        return;
    }
    Box square = {inside.x, inside.y, side, side};
    const int facts[2] = {system->nodes, system->springs};
    uint64_t key = paper_key(0, facts, sizeof facts);
    Canvas *kept = paper_keep(paper, KEEP_SPY, key, side, side, &drawn);
    Pattern pattern = {0};
    if (!kept)
        return;
    if (!drawn && make_pattern(system, &pattern))
        draw_pattern(kept, &pattern);
    free(pattern.matrix);
    free(pattern.factor);
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
