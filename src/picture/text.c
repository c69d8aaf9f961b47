#include "picture/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/colour_map.h"

enum {
    TEXT_GLYPHS = 2048, /* kept at a time, a power of two */
    TEXT_NAME = 512,
    TEXT_DEPTH = 3, /* superscripts of superscripts */
    LEAST_SIZE = 5,
    MOST_SIZE = 400
};

static const double SCRIPT_SIZE = 0.7;   /* of the letter it belongs to */
static const double RAISE = 0.36;        /* ems up, a superscript */
static const double LOWER = 0.18;        /* ems down, a subscript */
static const double ASCENT = 0.93;       /* ems, upper edge to baseline */
static const double LINE_HEIGHT = 1.3;   /* ems */
static const double GUESSED_WIDTH = 0.6; /* ems a letter, without a font */

/* A letter, drawn once. */
typedef struct Glyph {
    uint64_t key;           /* 0: a free place */
    int left, top, advance; /* pixels, of the mask from pen and baseline */
    int width, height;
    uint8_t *mask; /* [height width] coverage, or NULL: nothing to draw */
} Glyph;

struct Text {
    FT_Library library;
    FT_Face font[FACE_COUNT];
    int glyphs;
    Glyph glyph[TEXT_GLYPHS]; /* hashed by key */
};

/* ---- fonts -------------------------------------------------------------- */

/* Those that begin with ~ are in the home folder. */
static const char *const font_folders[] = {
    "/usr/share/fonts/truetype/dejavu",   /* Debian, Ubuntu */
    "/usr/share/fonts/dejavu-sans-fonts", /* Fedora */
    "/usr/share/fonts/dejavu",            /* older Fedora, Gentoo */
    "/usr/share/fonts/TTF",               /* Arch */
    "/usr/share/fonts/truetype",          /* openSUSE */
    "/usr/local/share/fonts/dejavu",      /* BSD */
    "/Library/Fonts",                     /* macOS */
    "/opt/homebrew/share/fonts",
    "/usr/local/share/fonts",
    "~/Library/Fonts",
    "~/.local/share/fonts",
    "~/.fonts",
};

static const char *const face_files[FACE_COUNT] = {
    "DejaVuSans.ttf", "DejaVuSans-Bold.ttf", "DejaVuSansMono.ttf"};

/* The font that was asked for; else DejaVu from the first folder that has it.
 * Returns FreeType's last error: 0, or why there is none. */
static FT_Error open_font(FT_Library library, Face face, const char *given,
                          FT_Face *font)
{
    const char *home = getenv("HOME") ? getenv("HOME") : "";
    char name[TEXT_NAME];
    FT_Error error = FT_Err_Cannot_Open_Resource;
    if (given && face != FACE_MONO)
        error = FT_New_Face(library, given, 0, font);
    for (size_t i = 0; error && error != FT_Err_Out_Of_Memory &&
                       i < sizeof font_folders / sizeof *font_folders;
         i++) {
        const char *folder = font_folders[i];
        bool at_home = *folder == '~';
        snprintf(name, sizeof name, "%s%s/%s", at_home ? home : "",
                 folder + at_home, face_files[face]);
        error = FT_New_Face(library, name, 0, font);
    }
    return error;
}

Status text_create(Text **text)
{
    const char *given = getenv("ELASTO_FONT");
    *text = NULL;
    if (given && given[0] == '\0')
        return STATUS_OK;
    Text *made = calloc(1, sizeof *made);
    if (!made || FT_Init_FreeType(&made->library)) {
        free(made);
        return STATUS_OUT_OF_MEMORY;
    }
    FT_Error error = 0;
    for (int face = 0; face < FACE_COUNT && error != FT_Err_Out_Of_Memory;
         face++) {
        error = open_font(made->library, (Face)face, given, &made->font[face]);
        if (error)
            made->font[face] = made->font[FACE_REGULAR];
    }
    bool full = error == FT_Err_Out_Of_Memory;
    if (made->font[FACE_REGULAR] && !full)
        *text = made;
    else
        text_free(made);
    return full ? STATUS_OUT_OF_MEMORY : STATUS_OK;
}

static void forget_glyphs(Text *text)
{
    for (int i = 0; i < TEXT_GLYPHS; i++)
        free(text->glyph[i].mask);
    memset(text->glyph, 0, sizeof text->glyph);
    text->glyphs = 0;
}

void text_free(Text *text)
{
    if (!text)
        return;
    forget_glyphs(text);
    FT_Done_FreeType(text->library); /* and its fonts */
    free(text);
}

/* ---- letters ------------------------------------------------------------ */

/* Draws the letter.  One that cannot be drawn keeps its room. */
static Glyph make_glyph(Text *text, Face face, int size, uint32_t letter)
{
    Glyph glyph = {.advance = (int)(GUESSED_WIDTH * size)};
    FT_Face font = text->font[face];
    if (FT_Set_Char_Size(font, 0, size * 64, 0, 0) ||
        FT_Load_Char(font, letter, FT_LOAD_TARGET_LIGHT))
        return glyph;
    FT_GlyphSlot slot = font->glyph;
    const FT_Bitmap *map = &slot->bitmap;
    glyph.advance = (int)((slot->metrics.horiAdvance + 63) >> 6);
    if (FT_Render_Glyph(slot, FT_RENDER_MODE_NORMAL) ||
        map->pixel_mode != FT_PIXEL_MODE_GRAY)
        return glyph;
    glyph.left = slot->bitmap_left;
    glyph.top = -slot->bitmap_top;
    glyph.mask = malloc((size_t)map->width * map->rows + 1);
    if (!glyph.mask)
        return glyph;
    glyph.width = (int)map->width;
    glyph.height = (int)map->rows;
    for (size_t j = 0; j < map->rows; j++)
        memcpy(glyph.mask + j * map->width,
               map->buffer + (ptrdiff_t)j * map->pitch, map->width);
    return glyph;
}

/* From the cache, or drawn. */
static const Glyph *find_glyph(Text *text, Face face, int size, uint32_t letter)
{
    uint64_t key =
        (uint64_t)letter << 16 | (uint64_t)size << 4 | ((uint64_t)face + 1);
    if (text->glyphs > TEXT_GLYPHS / 2)
        forget_glyphs(text);
    size_t place = (size_t)(key * 0x9e3779b97f4a7c15u >> 40) % TEXT_GLYPHS;
    while (text->glyph[place].key && text->glyph[place].key != key)
        place = (place + 1) % TEXT_GLYPHS;
    Glyph *glyph = &text->glyph[place];
    if (!glyph->key) {
        *glyph = make_glyph(text, face, size, letter);
        glyph->key = key;
        text->glyphs++;
    }
    return glyph;
}

/* The next character of UTF-8; a wrong byte is U+FFFD. */
static uint32_t next_letter(const char **string)
{
    const unsigned char *s = (const unsigned char *)*string;
    int more = s[0] < 0x80   ? 0
               : s[0] < 0xc2 ? -1
               : s[0] < 0xe0 ? 1
               : s[0] < 0xf0 ? 2
               : s[0] < 0xf5 ? 3
                             : -1;
    uint32_t letter = more <= 0 ? s[0] : s[0] & (0x3fu >> more);
    for (int i = 1; i <= more; i++) {
        if ((s[i] & 0xc0) != 0x80) {
            more = -1;
            break;
        }
        letter = letter << 6 | (s[i] & 0x3f);
    }
    *string += more < 0 ? 1 : more + 1;
    return more < 0 ? 0xfffd : letter;
}

/* ---- lines -------------------------------------------------------------- */

/* A pen that moves along a line; canvas NULL: it only measures. */
typedef struct Pen {
    Text *text;
    Canvas *canvas;
    TextStyle style;
    double x, baseline;
    int mark_left, mark_width, mark_top; /* ink of the last letter */
} Pen;

/* One letter; a mark is centred over the one before. */
static void pen_letter(Pen *pen, uint32_t letter)
{
    int size = (int)(pen->style.size + 0.5);
    bool mark = letter >= 0x300 && letter < 0x370;
    if (!pen->text) {
        pen->x += mark ? 0 : GUESSED_WIDTH * pen->style.size;
        return;
    }
    const Glyph *glyph = find_glyph(pen->text, pen->style.face, size, letter);
    int x = (int)floor(pen->x + 0.5) + glyph->left;
    int y = (int)floor(pen->baseline + 0.5) + glyph->top;
    if (mark) {
        int gap = (size + 8) / 16;
        int low = (int)floor(pen->baseline + 0.5) + pen->mark_top - gap;
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

/* The letters that have a colour. */
typedef struct Coloured {
    const char *name, *shown;
    Colour colour;
} Coloured;

static const Coloured coloured[] = {
    {"{x}", "x", COLOUR_X},
    {"{xt}", "x\u0303", COLOUR_X_TILDE},
    {"{p}", "p", COLOUR_P},
    {"{alpha}", "\u03b1", COLOUR_ALPHA},
};

/* The one that the string begins with, or NULL. */
static const Coloured *find_coloured(const char *string)
{
    for (size_t i = 0; i < sizeof coloured / sizeof *coloured; i++)
        if (strncmp(string, coloured[i].name, strlen(coloured[i].name)) == 0)
            return &coloured[i];
    return NULL;
}

/* The brace that closes the one before `string`, or the end. */
static const char *closing_brace(const char *string, const char *end)
{
    int depth = 1;
    for (; string < end; string++) {
        depth += *string == '{';
        depth -= *string == '}';
        if (depth == 0)
            return string;
    }
    return end;
}

static void pen_markup(Pen *pen, const char *string, const char *end, int depth)
{
    while (string < end) {
        const TextStyle style = pen->style;
        double baseline = pen->baseline;
        bool script = (*string == '^' || *string == '_') && string[1] == '{';
        const Coloured *word = *string == '{' ? find_coloured(string) : NULL;
        if (style.plain || !(word || (script && depth < TEXT_DEPTH))) {
            pen_letter(pen, next_letter(&string));
            continue;
        }
        if (word) {
            if (style.colour != COLOUR_GREY)
                pen->style.colour = word->colour;
            pen_markup(pen, word->shown, word->shown + strlen(word->shown), 0);
            string += strlen(word->name);
        } else {
            const char *close = closing_brace(string + 2, end);
            pen->baseline += style.size * (*string == '^' ? -RAISE : LOWER);
            pen->style.size *= SCRIPT_SIZE;
            pen_markup(pen, string + 2, close, depth + 1);
            string = close < end ? close + 1 : end;
        }
        pen->style = style;
        pen->baseline = baseline;
    }
}

double text_line(double size)
{
    return LINE_HEIGHT * size;
}

/* Along the whole string, from (x, y) on. */
static double pen_width(Text *text, Canvas *canvas, const TextStyle *style,
                        double x, double y, const char *string)
{
    Pen pen = {.text = text,
               .canvas = canvas,
               .style = *style,
               .x = x,
               .baseline = y + ASCENT * style->size};
    pen_markup(&pen, string, string + strlen(string), 0);
    return pen.x;
}

int text_width(Text *text, const TextStyle *style, const char *markup)
{
    bool draws = style->size >= LEAST_SIZE && style->size <= MOST_SIZE;
    return draws ? (int)ceil(pen_width(text, NULL, style, 0, 0, markup)) : 0;
}

/* Letters start at whole pixels; what flies off has no pixel. */
int text_draw(Text *text, Canvas *canvas, const TextStyle *style, double x,
              double y, Align align, const char *markup)
{
    int width = text_width(text, style, markup);
    double start = align == ALIGN_LEFT     ? x
                   : align == ALIGN_CENTRE ? x - 0.5 * width
                                           : x - width;
    if (!text || width == 0 || !(fabs(x) < 1e6) || !(fabs(y) < 1e6))
        return width;
    return (int)ceil(
        pen_width(text, canvas, style, floor(start + 0.5), y, markup) - start);
}
