/* card_hessian_pattern.c - non-zero blocks of the Hessian and its factor. */
#include <stdlib.h>

#include "picture/cards.h"

/* Blocks: zero; non-zero only in the factor; non-zero also in the Hessian. */
enum { NO_ENTRY, FILL_IN, HESSIAN_ENTRY };

/* Returns the row of a node: the node's number in natural order, else the
 * node's place in the elimination order. */
static int find_matrix_row(const System *system, int node, bool natural)
{
    return natural ? node : system->elimination_index[node];
}

/* Returns the pattern of the Hessian of the first `springs` springs if natural,
 * else of its factor in elimination order (George and Liu 1981).  Block
 * [j n + i] is row i > j of column j; block [i n + i] counts a node's springs.
 * Each column of the factor adds its pattern to its parent, the column of its
 * first non-zero row below the diagonal.  NULL: out of memory. */
static unsigned char *compute_matrix_pattern(const System *system, bool natural,
                                             int springs)
{
    size_t n = (size_t)system->nodes;
    unsigned char *block = calloc(n, n);
    for (int s = 0; block && s < springs; s++) {
        size_t i = (size_t)find_matrix_row(system, system->e[2 * s], natural);
        size_t j =
            (size_t)find_matrix_row(system, system->e[2 * s + 1], natural);
        block[i < j ? i * n + j : j * n + i] = HESSIAN_ENTRY;
        block[i * n + i]++;
        block[j * n + j]++;
    }
    for (size_t j = 0; block && j < n && !natural; j++) {
        size_t parent = j + 1;
        while (parent < n && !block[j * n + parent])
            parent++;
        for (size_t i = parent + 1; i < n; i++)
            if (block[j * n + i] && !block[parent * n + i])
                block[parent * n + i] = FILL_IN;
    }
    return block;
}

/* Returns the box of the block in row i, column j of n x n blocks, at least
 * `least` pixels a side.  Large blocks have gaps between them. */
static Box find_block_box(Box square, int n, int i, int j, int least)
{
    int side = square.width, gap = n * 5 < side;
    int x = j * side / n, y = i * side / n;
    int wide = (j + 1) * side / n - x - gap,
        high = (i + 1) * side / n - y - gap;
    return (Box){square.x + x, square.y + y, wide > least ? wide : least,
                 high > least ? high : least};
}

/* Draws the Hessian's blocks; unless natural, also the factor's fill-in below
 * the diagonal.  Marks the spring under the mouse, or a page's last spring. */
static void draw_matrix_pattern(const Plot *card, Box square, bool natural,
                                int springs)
{
    const System *system = &card->simulation->system;
    const Pick *hover = &card->content->view->hovered_part;
    unsigned char *block = compute_matrix_pattern(system, natural, springs);
    Canvas *canvas = &card->paper->canvas;
    bool writes = card->simulation->options.next_action == NEXT_ADDS_SPRING;
    int n = system->nodes, least = paper_to_pixels(card->paper, 0.35);
    int lit = hover->kind == PICK_SPRING    ? hover->index
              : card->content->lecture.page ? springs - 1
                                            : -1;
    canvas_framed_box(canvas, box_inset(square, -2), COLOUR_WHITE, COLOUR_GREY);
    for (int j = 0; block && j < n; j++)
        for (int i = j; i < n; i++) {
            int at = block[(size_t)j * (size_t)n + i];
            int what = i == j ? HESSIAN_ENTRY : at;
            Colour blue = colour_mix(0xffc0c8ffu, COLOUR_X,
                                     writes ? (i == j ? at : 1) / 8.0 : 1);
            if (what == HESSIAN_ENTRY)
                canvas_fill(canvas, find_block_box(square, n, j, i, 1), blue);
            if (what != NO_ENTRY)
                canvas_fill(canvas, find_block_box(square, n, i, j, 1),
                            what == HESSIAN_ENTRY ? blue : 0xffe0a060u);
        }
    for (int k = 0; block && k < 4 && lit >= 0 && lit < system->springs; k++) {
        const int *e = system->e + 2 * lit;
        int i = find_matrix_row(system, e[k / 2], natural);
        int j = find_matrix_row(system, e[k % 2], natural);
        Box box = find_block_box(square, n, i, j, least);
        canvas_framed_box(canvas, box_inset(box, -1), COLOUR_PROJECT,
                          COLOUR_WHITE);
    }
    free(block);
}

/* Draws the patterns in natural order and in elimination order.  During the
 * assembly of the Hessian draws only the first pattern, and on a high card the
 * triplets of the newest spring at its right. */
void draw_hessian_pattern_card(const Plot *card)
{
    Paper *paper = card->paper;
    const System *system = &card->simulation->system;
    bool writes = card->simulation->options.next_action == NEXT_ADDS_SPRING;
    const double list_height = 28; /* ems */
    Plot triplets = *card;
    Box inside = card->box;
    bool has_list = writes && !card->content->has_document &&
                    inside.height > list_height * paper->em;
    int line = paper_to_pixels(paper, 1.4), count = writes ? 1 : 2;
    if (has_list)
        triplets.box = box_cut_off(&inside, EDGE_RIGHT, inside.width / 3);
    int high = inside.height - line;
    int side = (inside.width - count * line) / count;
    side = side < high ? side : high;
    int springs =
        writes ? find_added_spring(card->simulation) + 1 : system->springs;
    if (side < 4 * line || system->nodes > side) {
        card_write_hint(card, side < 4 * line ? "enlarge it"
                                              : "too many nodes to draw");
        return;
    }
    for (int k = 0; k < count; k++) {
        int x = inside.x + k * (side + line);
        paper_write(paper, FACE_REGULAR, 0.9, COLOUR_FAINT, x, inside.y,
                    ALIGN_LEFT,
                    k ? "order of elimination" : "node i: rows 2i, 2i + 1");
        draw_matrix_pattern(card, (Box){x, inside.y + line, side, side}, !k,
                            springs);
    }
    if (has_list)
        card_write_text(&triplets, &card->pane->values, text_triplets);
}
