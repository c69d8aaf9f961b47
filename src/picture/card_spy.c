#include <stdlib.h>

#include "picture/cards.h"
#include "picture/colour_map.h"

/* More nodes than the card has pixels show nothing. */
enum { SPY_NODES = 4500 };

/* What a block holds. */
enum { NOTHING, FILL, ENTRY };

/* Place of a node in the elimination order, or its number. */
static int node_place(const System *system, int node, bool natural)
{
    return system->order && !natural ? system->order[node] : node;
}

/* What is in row i of column j < i of the factor: [j n + i]; NULL: not enough
 * memory.  A column has what the matrix has there, and what each column has
 * whose first entry below the diagonal it is (George and Liu 1981).  In the
 * natural order the matrix alone, of so many springs. */
static unsigned char *make_pattern(const System *system, bool natural,
                                   int springs)
{
    size_t n = (size_t)system->nodes;
    unsigned char *block = calloc(n, n);
    for (int s = 0; block && s < springs; s++) {
        size_t i = (size_t)node_place(system, system->e[2 * s], natural);
        size_t j = (size_t)node_place(system, system->e[2 * s + 1], natural);
        block[i < j ? i * n + j : j * n + i] = ENTRY;
    }
    for (size_t j = 0; block && j < n && !natural; j++) {
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
static void draw_square(Canvas *canvas, int n, int i, int j, Colour colour)
{
    int side = canvas->width;
    int x = (int)((long)j * side / n), y = (int)((long)i * side / n);
    int wide = (int)((long)(j + 1) * side / n) - x;
    int high = (int)((long)(i + 1) * side / n) - y;
    if (n * 5 < side) { /* a gap between the blocks */
        wide--;
        high--;
    }
    canvas_fill(canvas, (Box){x, y, wide > 1 ? wide : 1, high > 1 ? high : 1},
                colour);
}

/* Above the diagonal the matrix, below it the factor with its fill. */
static void draw_pattern(Canvas *canvas, int n, const unsigned char *block)
{
    for (int j = 0; j < n; j++)
        for (int i = j + 1; i < n; i++) {
            int what = block[(size_t)j * (size_t)n + (size_t)i];
            if (what == ENTRY)
                draw_square(canvas, n, j, i, COLOUR_X);
            if (what != NOTHING)
                draw_square(canvas, n, i, j,
                            what == ENTRY ? COLOUR_X : 0xffe0a060u);
        }
    for (int i = 0; i < n; i++)
        draw_square(canvas, n, i, i, COLOUR_X);
}

/* The four blocks of a spring; < 0: of none. */
static void light_spring(Paper *paper, const System *system, int spring,
                         bool natural, Box square)
{
    if (spring < 0 || spring >= system->springs)
        return;
    const int *e = system->e + 2 * spring;
    const long place[2] = {node_place(system, e[0], natural),
                           node_place(system, e[1], natural)};
    int n = system->nodes, least = paper_pixels(paper, 0.35);
    int size = square.width / n > least ? square.width / n : least;
    for (int k = 0; k < 4; k++) {
        int x = square.x + (int)(place[k % 2] * square.width / n);
        int y = square.y + (int)(place[k / 2] * square.width / n);
        canvas_card(&paper->canvas, (Box){x - 1, y - 1, size + 2, size + 2},
                    COLOUR_PROJECT, COLOUR_WHITE);
    }
}

/* Made once for a mesh and so many springs, then copied; the spring under the
 * mouse is lit, or the newest one. */
static void draw_matrix(const Plot *card, Box square, bool natural, int springs)
{
    Paper *paper = card->paper;
    const System *system = &card->simulation->system;
    const Pick *hover = &card->show->hover;
    const int facts[3] = {system->nodes, system->springs, springs};
    uint64_t key = paper_key(natural, facts, sizeof facts);
    bool drawn = false, over = hover->kind == PICK_SPRING;
    Canvas *kept = paper_keep(paper, natural ? KEEP_NATURAL : KEEP_SPY, key,
                              square.width, square.width, &drawn);
    unsigned char *block =
        !kept || drawn ? NULL : make_pattern(system, natural, springs);
    if (block)
        draw_pattern(kept, system->nodes, block);
    free(block);
    if (!kept)
        return;
    canvas_copy(&paper->canvas, kept, square.x, square.y);
    light_spring(paper, system,
                 over                             ? hover->index
                 : natural && card->show->lecture ? springs - 1
                                                  : -1,
                 natural, square);
}

/* What the newest spring adds, if there is room below the patterns. */
static void draw_block(const Plot *card, int used)
{
    Plot below = *card;
    below.box.y += used;
    below.box.height -= used;
    if (below.box.height > 7 * card->paper->em)
        text_in_card(&below, &show_pane(card->show)->facts, text_newest);
}

/* Beside each other: with the rows in the nodes' order, as the springs write
 * it, one a step, where a page wants it so; and in the order of elimination. */
void spy_draw(const Plot *card)
{
    Paper *paper = card->paper;
    const System *system = &card->simulation->system;
    const LecturePage *page = card->show->lecture;
    Box inside = card->box;
    int line = paper_pixels(paper, 1.4), gap = line;
    int side = (inside.width - gap) / 2;
    int below = page && page->writes ? paper_pixels(paper, 9) : 0;
    if (side > inside.height - line - below)
        side = inside.height - line - below;
    int springs = page && page->writes ? lecture_spring(card->simulation) + 1
                                       : system->springs;
    if (side < 4 * line || system->nodes > SPY_NODES || system->nodes < 1)
        cards_hint(card,
                   side < 4 * line ? "enlarge it" : "too many nodes to draw");
    else {
        for (int k = 0; k < 2; k++) {
            int x = inside.x + k * (side + gap);
            paper_write(paper, FACE_REGULAR, 0.9, COLOUR_FAINT, x, inside.y,
                        ALIGN_LEFT,
                        k ? "order of elimination" : "rows 2i, 2i + 1");
            draw_matrix(card, (Box){x, inside.y + line, side, side}, !k,
                        k ? system->springs : springs);
        }
        draw_block(card, 2 * line + side);
    }
}
