/* type.c - sets lines of words and formulas, letter by letter.
 *
 * A pen sets a part of a formula, or only measures the part if the pen has no
 * canvas.  For a fraction, pens first measure both parts, and then set each
 * part centred on the fraction's line. */
#include <math.h>
#include <string.h>

#include "picture/colour_map.h"

enum {
    MAX_FORMULA_DEPTH = 6, /* most formulas inside each other */
    MAX_MATRIX_ROWS = 8,   /* most rows of a matrix */
    MAX_MATRIX_COLUMNS = 8,
    MIN_TEXT_SIZE = 5,
    MAX_TEXT_SIZE = 400
};

/* Extent of a line and of its letters, from the baseline; lengths in ems. */
static const double LINE_ASCENT = 0.93, LINE_DESCENT = 0.37;
static const double LETTER_ASCENT = 0.76, LETTER_DESCENT = 0.24;
static const double SCRIPT_SIZE = 0.8;
static const double MARK_SIZE = 1.3;            /* size of a hat or tilde */
static const double RAISE = 0.36, LOWER = 0.18; /* shift of ^{...} and _{...} */
static const double FRACTION_SIZE = 0.9; /* size of a fraction's letters */
static const double AXIS_HEIGHT = 0.28;  /* height of a fraction's line */
static const double SPACE = 0.12; /* space around fractions and in brackets */
static const double COLUMN_GAP = 0.9;  /* space between columns of a matrix */
static const double ROW_GAP = 0.22;    /* space between rows of a matrix */
static const double RULE_WIDTH = 0.07; /* width of a fraction's line */

typedef struct Pen {
    Font *font;
    Canvas *canvas; /* NULL: the pen only measures */
    TextStyle style;
    double x, y;        /* pixels, position on the baseline */
    double top, bottom; /* pixels, extent of all letters set so far */
    /* Box of the last letter, pixels; a combining mark stands above. */
    int letter_left, letter_width, letter_top;
} Pen;

/* A part of a text, such as the inside of braces. */
typedef struct MarkupPart {
    const char *start, *end; /* first byte, byte after the last one */
} MarkupPart;

static MarkupPart whole_markup(const char *string)
{
    return (MarkupPart){string, string + strlen(string)};
}

static void typeset_markup(Pen *pen, MarkupPart part, int depth);

/* ---- letters ------------------------------------------------------------ */

/* Reads the next character of UTF-8; an invalid byte gives U+FFFD. */
static uint32_t read_utf8_letter(const char **string)
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

static void pen_extend(Pen *pen, double top, double bottom)
{
    pen->top = fmin(pen->top, top);
    pen->bottom = fmax(pen->bottom, bottom);
}

/* Sets a letter.  A combining mark stands, large, over the letter before it. */
static void typeset_letter(Pen *pen, uint32_t letter)
{
    double em = pen->style.size;
    int size = (int)(em + 0.5), base = (int)floor(pen->y + 0.5);
    bool mark = letter >= 0x300 && letter < 0x370;
    pen_extend(pen, pen->y - LETTER_ASCENT * em, pen->y + LETTER_DESCENT * em);
    if (!pen->font) {
        pen->x += mark ? 0 : FONT_GUESSED * em;
        return;
    }
    const Glyph *glyph =
        font_get_glyph(pen->font, mark ? FACE_BOLD : pen->style.face,
                       mark ? (int)(MARK_SIZE * em + 0.5) : size, letter);
    int x = (int)floor(pen->x + 0.5) + glyph->left, y = base + glyph->top;
    if (mark) {
        x = pen->letter_left + (pen->letter_width - glyph->width) / 2;
        y = base + pen->letter_top - (size + 8) / 16 - glyph->height;
    }
    if (pen->canvas && glyph->mask)
        canvas_fill_mask(pen->canvas, x, y, glyph->width, glyph->height,
                         glyph->mask, pen->style.colour);
    if (mark)
        return;
    pen->letter_left = x;
    pen->letter_width = glyph->width;
    pen->letter_top = glyph->top;
    pen->x += glyph->advance;
}

/* ---- parts of formulas -------------------------------------------------- */

static TextExtent measure_markup(const Pen *like, MarkupPart part, int depth)
{
    Pen pen = {.font = like->font, .style = like->style};
    typeset_markup(&pen, part, depth);
    return (TextExtent){pen.x, -pen.top, pen.bottom};
}

/* Sets a part at (x, y) without moving the pen. */
static void typeset_markup_at(Pen *pen, double x, double y, MarkupPart part,
                              int depth)
{
    Pen inner = *pen;
    inner.x = x;
    inner.y = y;
    typeset_markup(&inner, part, depth);
    pen_extend(pen, inner.top, inner.bottom);
}

static void draw_stroke(const Pen *pen, double x0, double y0, double x1,
                        double y1)
{
    if (pen->canvas)
        canvas_line(pen->canvas, x0, y0, x1, y1,
                    fmax(1, floor(RULE_WIDTH * pen->style.size + 0.5)),
                    pen->style.colour);
}

/* Finds a word that is not inside of further braces, or the brace that closes
 * the part.  Returns the part's end if there is neither.
 *   word  NULL: only finds the closing brace */
static const char *find_outside_braces(MarkupPart part, const char *word)
{
    size_t length = word ? strlen(word) : 0;
    int depth = 0;
    for (const char *at = part.start; at < part.end; at++) {
        depth += (*at == '{') - (*at == '}');
        if (depth < 0 || (depth == 0 && word && at + length <= part.end &&
                          strncmp(at, word, length) == 0))
            return at;
    }
    return part.end;
}

/* Reduces the letters of a superscript or fraction, down to min_size. */
static void shrink_letters(TextStyle *style, double factor)
{
    style->size =
        fmin(style->size, fmax(factor * style->size, style->min_size));
}

/* Sets a superscript ^{...} or a subscript _{...}. */
static void typeset_script(Pen *pen, MarkupPart part, int depth)
{
    Pen inner = *pen;
    inner.y += (part.start[-2] == '^' ? -RAISE : LOWER) * pen->style.size;
    shrink_letters(&inner.style, SCRIPT_SIZE);
    typeset_markup(&inner, part, depth);
    pen_extend(pen, inner.top, inner.bottom);
    pen->x = inner.x;
}

/* Sets frac{above over below}. */
static void typeset_fraction(Pen *pen, MarkupPart part, int depth)
{
    static const char over[] = " over ";
    const char *middle = find_outside_braces(part, over);
    MarkupPart above = {part.start, middle}, below = {middle, part.end};
    below.start += middle < part.end ? strlen(over) : 0;
    Pen small = *pen;
    shrink_letters(&small.style, FRACTION_SIZE);
    TextExtent a = measure_markup(&small, above, depth);
    TextExtent b = measure_markup(&small, below, depth);
    double thin = SPACE * pen->style.size;
    double wide = fmax(a.width, b.width) + 2 * thin, left = pen->x + thin;
    double y = floor(pen->y - AXIS_HEIGHT * pen->style.size) + 0.5;
    typeset_markup_at(&small, left + 0.5 * (wide - a.width),
                      y - thin - a.descent, above, depth);
    typeset_markup_at(&small, left + 0.5 * (wide - b.width),
                      y + thin + b.ascent, below, depth);
    draw_stroke(pen, left, y, left + wide, y);
    pen_extend(pen, small.top, small.bottom);
    pen->x = left + wide + thin;
}

/* Reads the next cell of a matrix, without blanks around it, and moves `at`
 * behind the cell.  Returns whether the cell is the last one of its row. */
static bool read_matrix_cell(const char **at, const char *end, MarkupPart *cell)
{
    MarkupPart rest = {*at, end};
    const char *row = find_outside_braces(rest, ";");
    const char *column = find_outside_braces((MarkupPart){*at, row}, "&");
    *cell = (MarkupPart){*at + strspn(*at, " "), column};
    while (cell->end > cell->start && cell->end[-1] == ' ')
        cell->end--;
    *at = column + (column < end);
    return column == row;
}

/* Sets matrix{a & b; c & d}; columns are aligned at their right edge. */
static void typeset_matrix(Pen *pen, MarkupPart part, int depth)
{
    MarkupPart cell[MAX_MATRIX_ROWS][MAX_MATRIX_COLUMNS] = {{{0}}};
    double em = pen->style.size, above[MAX_MATRIX_ROWS], below[MAX_MATRIX_ROWS],
           wide[MAX_MATRIX_COLUMNS] = {0};
    double high = -ROW_GAP * em,
           right = pen->x + (3.5 * SPACE - COLUMN_GAP) * em;
    const char *at = part.start;
    int rows = 0;
    for (; at < part.end && rows < MAX_MATRIX_ROWS; rows++) {
        bool last = false;
        above[rows] = LETTER_ASCENT * em;
        below[rows] = LETTER_DESCENT * em;
        for (int c = 0; c < MAX_MATRIX_COLUMNS && at < part.end && !last; c++) {
            last = read_matrix_cell(&at, part.end, &cell[rows][c]);
            TextExtent in = measure_markup(pen, cell[rows][c], depth);
            above[rows] = fmax(above[rows], in.ascent);
            below[rows] = fmax(below[rows], in.descent);
            wide[c] = fmax(wide[c], in.width);
        }
        high += above[rows] + below[rows] + ROW_GAP * em;
    }
    double top = floor(pen->y - AXIS_HEIGHT * em - 0.5 * high) + 0.5;
    double bottom = top + high;
    for (int c = 0; c < MAX_MATRIX_COLUMNS && wide[c] > 0; c++) {
        double y = top;
        right += wide[c] + COLUMN_GAP * em;
        for (int r = 0; r < rows; r++) {
            double width = measure_markup(pen, cell[r][c], depth).width;
            typeset_markup_at(pen, right - width, y + above[r], cell[r][c],
                              depth);
            y += above[r] + below[r] + ROW_GAP * em;
        }
    }
    right += 2.5 * SPACE * em;
    for (int side = 0; side < 2; side++) { /* the brackets */
        double x = floor(side ? right : pen->x + SPACE * em) + 0.5;
        double in = x + (side ? -0.2 : 0.2) * em;
        draw_stroke(pen, x, top - 0.5, x, bottom + 0.5);
        draw_stroke(pen, x, top, in, top);
        draw_stroke(pen, x, bottom, in, bottom);
    }
    pen_extend(pen, top, bottom);
    pen->x = right + 1.5 * SPACE * em;
}

/* Sets #name{...} in the colour of this name, unless the whole text is grey. */
static void typeset_coloured(Pen *pen, MarkupPart part, int depth)
{
    Colour before = pen->style.colour;
    size_t length = 0;
    while (part.start[-2 - (ptrdiff_t)length] != '#')
        length++;
    if (before != COLOUR_GREY)
        pen->style.colour =
            colour_find_by_name(part.start - 1 - length, length);
    typeset_markup(pen, part, depth);
    pen->style.colour = before;
}

/* ---- markup ------------------------------------------------------------- */

/* Words that start markup.  Either `typeset_part` sets the part in braces that
 * follows, or the word is an abbreviation of the markup `expansion`. */
static const struct {
    const char *name;
    void (*typeset_part)(Pen *pen, MarkupPart part, int depth);
    const char *expansion;
} commands[] = {
    {"^", typeset_script, NULL},        {"_", typeset_script, NULL},
    {"frac", typeset_fraction, NULL},   {"matrix", typeset_matrix, NULL},
    {"#", typeset_coloured, NULL},      {"{x}", NULL, "#x{x}"},
    {"{xt}", NULL, "#xt{x\u0303}"},     {"{p}", NULL, "#p{p}"},
    {"{alpha}", NULL, "#alpha{\u03b1}"}};
enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

/* Finds the command that begins at `string`, and its brace.  Returns
 * COMMAND_COUNT if no command begins there. */
static int find_command(const char *string, const char **brace)
{
    for (int i = 0; i < COMMAND_COUNT; i++) {
        const char *name = commands[i].name;
        if (*string != *name || strncmp(string, name, strlen(name)) != 0)
            continue;
        *brace = string + (commands[i].expansion ? 0 : strlen(name));
        if (commands[i].typeset_part == typeset_coloured)
            *brace += strspn(*brace, "abcdefghijklmnopqrstuvwxyz0123456789");
        if (**brace == '{')
            return i;
    }
    return COMMAND_COUNT;
}

bool text_is_markup_brace(const char *text, const char *brace)
{
    const char *found = NULL;
    for (const char *at = brace + 1; at > text && brace - at < 16; at--)
        if (find_command(at - 1, &found) < COMMAND_COUNT && found == brace)
            return true;
    return false;
}

/* Sets the letter or command at the start of a part.  Returns its end. */
static const char *typeset_first_token(Pen *pen, MarkupPart part, int depth)
{
    const char *at = part.start, *brace = at;
    bool plain = pen->style.is_plain || depth >= MAX_FORMULA_DEPTH;
    int command = plain ? COMMAND_COUNT : find_command(at, &brace);
    if (command < COMMAND_COUNT && commands[command].expansion) {
        typeset_markup(pen, whole_markup(commands[command].expansion), depth);
        return at + strlen(commands[command].name);
    }
    if (command < COMMAND_COUNT && brace < part.end) {
        MarkupPart inside = {brace + 1, part.end};
        inside.end = find_outside_braces(inside, NULL);
        commands[command].typeset_part(pen, inside, depth + 1);
        return inside.end + (inside.end < part.end);
    }
    typeset_letter(pen, read_utf8_letter(&at));
    return at;
}

static void typeset_markup(Pen *pen, MarkupPart part, int depth)
{
    while (part.start < part.end)
        part.start = typeset_first_token(pen, part, depth);
}

/* ---- lines -------------------------------------------------------------- */

double text_line_height(double size)
{
    return (LINE_ASCENT + LINE_DESCENT) * size;
}

/* Returns the extent of a pen's letters, at least as high as plain words. */
static TextExtent find_line_extent(const Pen *pen)
{
    const TextStyle *style = &pen->style;
    double above = LINE_ASCENT * style->size,
           below = LINE_DESCENT * style->size;
    double air = SPACE * style->size; /* space above and below fractions */
    return (TextExtent){ceil(pen->x),
                        -pen->top > above ? -pen->top + air : above,
                        pen->bottom > below ? pen->bottom + air : below};
}

TextExtent text_measure(Font *text, const TextStyle *style, const char *markup)
{
    Pen pen = {.font = text, .style = *style};
    if (style->size >= MIN_TEXT_SIZE && style->size <= MAX_TEXT_SIZE)
        typeset_markup(&pen, whole_markup(markup), 0);
    return find_line_extent(&pen);
}

size_t text_break_line(Font *text, const TextStyle *style, int width,
                       const char *markup, size_t room, TextExtent *extent)
{
    Pen pen = {.font = text, .style = *style};
    MarkupPart rest = whole_markup(markup);
    size_t fits = 0;
    for (int depth = 0;;) {
        size_t count = (size_t)(rest.start - markup);
        bool ends = rest.start == rest.end;
        if (count >= room)
            return fits;
        if (count > 0 && (ends || (depth <= 0 && *rest.start == ' '))) {
            if (fits > 0 && ceil(pen.x) > width)
                return fits;
            fits = count;
            *extent = find_line_extent(&pen);
        }
        if (ends)
            return fits;
        const char *next = typeset_first_token(&pen, rest, 0);
        for (; rest.start < next; rest.start++)
            depth += (*rest.start == '{') - (*rest.start == '}');
    }
}

/* Letters start at whole pixels.  Text far outside the canvas is left out. */
int text_draw(Font *text, Canvas *canvas, const TextStyle *style, double x,
              double y, Align align, const char *markup)
{
    int width = (int)text_measure(text, style, markup).width;
    double start = x - 0.5 * (int)align * width;
    if (!text || width == 0 || !(fabs(x) < 1e6) || !(fabs(y) < 1e6))
        return width;
    Pen pen = {.font = text,
               .canvas = canvas,
               .style = *style,
               .x = floor(start + 0.5),
               .y = y + LINE_ASCENT * style->size};
    typeset_markup(&pen, whole_markup(markup), 0);
    return (int)ceil(pen.x - start);
}
