/* type.c - lines of words and formulas, letter by letter.
 *
 * A part of a formula is set by a pen that starts where the part begins; a pen
 * without a canvas only measures it.  So a fraction measures its two parts, and
 * then sets each of them over the middle of the line between.
 */
#include <math.h>
#include <string.h>

#include "picture/colour_map.h"
#include "picture/font.h"

enum {
    DEPTH = 6, /* formulas in formulas */
    ROWS = 8,  /* of a matrix */
    COLUMNS = 8,
    LEAST_SIZE = 5,
    MOST_SIZE = 400
};

/* Ems of the letters. */
static const double ASCENT = 0.93, DESCENT = 0.37; /* a line, of its baseline */
static const double HIGH = 0.76, LOW = 0.24;       /* its letters */
static const double SCRIPT_SIZE = 0.8;
static const double RAISE = 0.36, LOWER = 0.18; /* of scripts */
static const double PART_SIZE = 0.9;            /* of a fraction's parts */
static const double AXIS =
    0.28; /* over the baseline, the middle of fractions */
static const double THIN = 0.12; /* around rules and inside of brackets */
static const double CELL = 0.9;  /* between the columns of a matrix */
static const double ROW = 0.22;  /* between its rows */
static const double RULE = 0.07; /* the width of a rule */

typedef struct Pen {
    Text *text;
    Canvas *canvas; /* NULL: it only measures */
    TextStyle style;
    double x, y;                         /* on the baseline */
    double top, bottom;                  /* the farthest that it reached */
    int mark_left, mark_width, mark_top; /* ink of the last letter */
} Pen;

/* A part of the markup: its first byte, and the one behind its last. */
typedef struct Part {
    const char *from, *end;
} Part;

static Part part_of(const char *string)
{
    return (Part){string, string + strlen(string)};
}

static void set_part(Pen *pen, Part part, int depth);

/* ---- letters ------------------------------------------------------------ */

/* The next character of UTF-8; a wrong byte is U+FFFD. */
static uint32_t next_letter(const char **string)
{
    const unsigned char *s = (const unsigned char *)*string;
    int more = s[0] < 0x80 ? 0 : s[0] < 0xe0 ? 1 : s[0] < 0xf0 ? 2 : 3;
    uint32_t letter = more ? s[0] & (0x3fu >> more) : s[0];
    bool wrong = (s[0] >= 0x80 && s[0] < 0xc2) || s[0] > 0xf4;
    for (int i = 1; i <= more && !wrong; i++) {
        wrong = (s[i] & 0xc0) != 0x80;
        letter = letter << 6 | (s[i] & 0x3f);
    }
    *string += wrong ? 1 : more + 1;
    return wrong ? 0xfffd : letter;
}

static void reach(Pen *pen, double top, double bottom)
{
    pen->top = fmin(pen->top, top);
    pen->bottom = fmax(pen->bottom, bottom);
}

/* One letter; a mark is centred over the one before. */
static void set_letter(Pen *pen, uint32_t letter)
{
    double em = pen->style.size;
    int size = (int)(em + 0.5), base = (int)floor(pen->y + 0.5);
    bool mark = letter >= 0x300 && letter < 0x370;
    reach(pen, pen->y - HIGH * em, pen->y + LOW * em);
    if (!pen->text) {
        pen->x += mark ? 0 : FONT_GUESSED * em;
        return;
    }
    const Glyph *glyph = font_glyph(pen->text, pen->style.face, size, letter);
    int x = (int)floor(pen->x + 0.5) + glyph->left, y = base + glyph->top;
    if (mark) {
        int low = base + pen->mark_top - (size + 8) / 16;
        x = pen->mark_left + (pen->mark_width - glyph->width) / 2;
        y = y + glyph->height > low ? low - glyph->height : y;
    }
    if (pen->canvas && glyph->mask)
        canvas_stencil(pen->canvas, x, y, glyph->width, glyph->height,
                       glyph->mask, pen->style.colour);
    if (mark)
        return;
    pen->mark_left = x;
    pen->mark_width = glyph->width;
    pen->mark_top = glyph->top;
    pen->x += glyph->advance;
}

/* ---- parts of formulas -------------------------------------------------- */

static TextExtent measure(const Pen *like, Part part, int depth)
{
    Pen pen = {.text = like->text, .style = like->style};
    set_part(&pen, part, depth);
    return (TextExtent){pen.x, -pen.top, pen.bottom};
}

/* Sets a part from (x, y) on; the pen stays where it is. */
static void set_at(Pen *pen, double x, double y, Part part, int depth)
{
    Pen inner = *pen;
    inner.x = x;
    inner.y = y;
    set_part(&inner, part, depth);
    reach(pen, inner.top, inner.bottom);
}

static void set_rule(const Pen *pen, double x0, double y0, double x1, double y1)
{
    if (pen->canvas)
        canvas_line(pen->canvas, x0, y0, x1, y1,
                    fmax(1, floor(RULE * pen->style.size + 0.5)),
                    pen->style.colour);
}

/* Where a word stands outside of all inner braces, or the brace that closes
 * the part (all that is asked for, without a word), or the part's end. */
static const char *find_outside(Part part, const char *word)
{
    size_t length = word ? strlen(word) : 0;
    int depth = 0;
    for (const char *at = part.from; at < part.end; at++) {
        depth += (*at == '{') - (*at == '}');
        if (depth < 0 || (depth == 0 && word && at + length <= part.end &&
                          strncmp(at, word, length) == 0))
            return at;
    }
    return part.end;
}

/* Smaller than the letters around it, as far as it may be. */
static void shrink(TextStyle *style, double factor)
{
    style->size = fmin(style->size, fmax(factor * style->size, style->least));
}

/* ^{...} or _{...}, by what stands before the brace. */
static void set_raised(Pen *pen, Part part, int depth)
{
    Pen inner = *pen;
    inner.y += (part.from[-2] == '^' ? -RAISE : LOWER) * pen->style.size;
    shrink(&inner.style, SCRIPT_SIZE);
    set_part(&inner, part, depth);
    reach(pen, inner.top, inner.bottom);
    pen->x = inner.x;
}

/* frac{above over below} */
static void set_fraction(Pen *pen, Part part, int depth)
{
    static const char over[] = " over ";
    const char *middle = find_outside(part, over);
    Part above = {part.from, middle}, below = {middle, part.end};
    below.from += middle < part.end ? strlen(over) : 0;
    Pen small = *pen;
    shrink(&small.style, PART_SIZE);
    TextExtent a = measure(&small, above, depth);
    TextExtent b = measure(&small, below, depth);
    double thin = THIN * pen->style.size;
    double wide = fmax(a.width, b.width) + 2 * thin, left = pen->x + thin;
    double y = floor(pen->y - AXIS * pen->style.size) + 0.5;
    set_at(&small, left + 0.5 * (wide - a.width), y - thin - a.below, above,
           depth);
    set_at(&small, left + 0.5 * (wide - b.width), y + thin + b.above, below,
           depth);
    set_rule(pen, left, y, left + wide, y);
    reach(pen, small.top, small.bottom);
    pen->x = left + wide + thin;
}

/* The next cell of a matrix, without blanks around it; moves `at` behind it.
 * Returns whether it is the last one of its row. */
static bool next_cell(const char **at, const char *end, Part *cell)
{
    Part rest = {*at, end};
    const char *row = find_outside(rest, ";");
    const char *column = find_outside((Part){*at, row}, "&");
    *cell = (Part){*at + strspn(*at, " "), column};
    while (cell->end > cell->from && cell->end[-1] == ' ')
        cell->end--;
    *at = column + (column < end);
    return column == row;
}

/* matrix{a & b; c & d}: what is in a column ends at its right edge. */
static void set_matrix(Pen *pen, Part part, int depth)
{
    Part cell[ROWS][COLUMNS] = {{{0}}};
    double em = pen->style.size, above[ROWS], below[ROWS], wide[COLUMNS] = {0};
    double high = -ROW * em, right = pen->x + (3.5 * THIN - CELL) * em;
    const char *at = part.from;
    int rows = 0;
    for (; at < part.end && rows < ROWS; rows++) {
        bool last = false;
        above[rows] = HIGH * em;
        below[rows] = LOW * em;
        for (int c = 0; c < COLUMNS && at < part.end && !last; c++) {
            last = next_cell(&at, part.end, &cell[rows][c]);
            TextExtent in = measure(pen, cell[rows][c], depth);
            above[rows] = fmax(above[rows], in.above);
            below[rows] = fmax(below[rows], in.below);
            wide[c] = fmax(wide[c], in.width);
        }
        high += above[rows] + below[rows] + ROW * em;
    }
    double top = floor(pen->y - AXIS * em - 0.5 * high) + 0.5;
    double bottom = top + high;
    for (int c = 0; c < COLUMNS && wide[c] > 0; c++) {
        double y = top;
        right += wide[c] + CELL * em;
        for (int r = 0; r < rows; r++) {
            double width = measure(pen, cell[r][c], depth).width;
            set_at(pen, right - width, y + above[r], cell[r][c], depth);
            y += above[r] + below[r] + ROW * em;
        }
    }
    right += 2.5 * THIN * em;
    for (int side = 0; side < 2; side++) { /* the brackets */
        double x = floor(side ? right : pen->x + THIN * em) + 0.5;
        double in = x + (side ? -0.2 : 0.2) * em;
        set_rule(pen, x, top - 0.5, x, bottom + 0.5);
        set_rule(pen, x, top, in, top);
        set_rule(pen, x, bottom, in, bottom);
    }
    reach(pen, top, bottom);
    pen->x = right + 1.5 * THIN * em;
}

/* #name{...}: in that colour, unless all of the text is grey. */
static void set_coloured(Pen *pen, Part part, int depth)
{
    Colour before = pen->style.colour;
    size_t length = 0;
    while (part.from[-2 - (ptrdiff_t)length] != '#')
        length++;
    if (before != COLOUR_GREY)
        pen->style.colour = colour_named(part.from - 1 - length, length);
    set_part(pen, part, depth);
    pen->style.colour = before;
}

/* ---- markup ------------------------------------------------------------- */

/* Words before a brace; letters that have a colour stand for other markup. */
static const struct {
    const char *name;
    void (*set)(Pen *pen, Part part, int depth);
    const char *means;
} words[] = {{"^", set_raised, NULL},
             {"_", set_raised, NULL},
             {"frac", set_fraction, NULL},
             {"matrix", set_matrix, NULL},
             {"#", set_coloured, NULL},
             {"{x}", NULL, "#x{x}"},
             {"{xt}", NULL, "#xt{x\u0303}"},
             {"{p}", NULL, "#p{p}"},
             {"{alpha}", NULL, "#alpha{\u03b1}"}};
enum { WORDS = sizeof words / sizeof *words };

/* The word that begins here, and its brace; WORDS: none does. */
static int find_word(const char *string, const char **brace)
{
    for (int i = 0; i < WORDS; i++) {
        size_t length = strlen(words[i].name);
        if (strncmp(string, words[i].name, length) != 0)
            continue;
        *brace = string + (words[i].means ? 0 : length);
        if (words[i].set == set_coloured)
            *brace += strspn(*brace, "abcdefghijklmnopqrstuvwxyz0123456789");
        if (**brace == '{')
            return i;
    }
    return WORDS;
}

bool text_is_markup(const char *text, const char *brace)
{
    const char *found = NULL;
    for (const char *at = brace + 1; at > text && brace - at < 16; at--)
        if (find_word(at - 1, &found) < WORDS && found == brace)
            return true;
    return false;
}

static void set_part(Pen *pen, Part part, int depth)
{
    const char *at = part.from, *brace = at;
    while (at < part.end) {
        bool plain = pen->style.plain || depth >= DEPTH;
        int word = plain ? WORDS : find_word(at, &brace);
        if (word < WORDS && words[word].means) {
            set_part(pen, part_of(words[word].means), depth);
            at += strlen(words[word].name);
        } else if (word < WORDS && brace < part.end) {
            Part inside = {brace + 1, part.end};
            inside.end = find_outside(inside, NULL);
            words[word].set(pen, inside, depth + 1);
            at = inside.end + (inside.end < part.end);
        } else {
            set_letter(pen, next_letter(&at));
        }
    }
}

/* ---- lines -------------------------------------------------------------- */

double text_line(double size)
{
    return (ASCENT + DESCENT) * size;
}

TextExtent text_extent(Text *text, const TextStyle *style, const char *markup)
{
    Pen pen = {.text = text, .style = *style};
    TextExtent ink = {0, 0, 0};
    if (style->size >= LEAST_SIZE && style->size <= MOST_SIZE)
        ink = measure(&pen, part_of(markup), 0);
    double above = ASCENT * style->size, below = DESCENT * style->size;
    double air = THIN * style->size; /* around what reaches beyond a line */
    return (TextExtent){ceil(ink.width),
                        ink.above > above ? ink.above + air : above,
                        ink.below > below ? ink.below + air : below};
}

/* Letters start at whole pixels; what flies off has no pixel. */
int text_draw(Text *text, Canvas *canvas, const TextStyle *style, double x,
              double y, Align align, const char *markup)
{
    int width = (int)text_extent(text, style, markup).width;
    double start = x - 0.5 * (int)align * width;
    if (!text || width == 0 || !(fabs(x) < 1e6) || !(fabs(y) < 1e6))
        return width;
    Pen pen = {.text = text,
               .canvas = canvas,
               .style = *style,
               .x = floor(start + 0.5),
               .y = y + ASCENT * style->size};
    set_part(&pen, part_of(markup), 0);
    return (int)ceil(pen.x - start);
}
