/* text.c - fonts and letters, from which type.c sets lines and formulas. */
#include <errno.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/text.h"

enum {
    TEXT_MAX_GLYPHS = 2048, /* letters in the cache, a power of two */
    FONT_PATH_SIZE = 512
};

struct Font {
    FT_Library freetype;
    FT_Face font[FACE_COUNT];
    int glyph_count;
    Glyph glyph_table[TEXT_MAX_GLYPHS]; /* hash table of the letters in the
                                           cache */
};

/* ---- fonts -------------------------------------------------------------- */

/* Folders with the fonts; ~ stands for the home folder. */
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

/* Opens the font that the user named, or else DejaVu from the first folder that
 * has DejaVu.  Returns 0 or FreeType's last error. */
static FT_Error open_font(FT_Library library, Face face, const char *given,
                          FT_Face *font)
{
    const char *home = getenv("HOME") ? getenv("HOME") : "";
    char name[FONT_PATH_SIZE];
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

Status font_create(Font **text)
{
    const char *given = getenv("ELASTO_FONT");
    *text = NULL;
    if (given && given[0] == '\0')
        return STATUS_OK;
    Font *made = calloc(1, sizeof *made);
    errno = 0;
    if (!made || FT_Init_FreeType(&made->freetype)) {
        free(made);
        return STATUS_OUT_OF_MEMORY;
    }
    /* FreeType silently leaves out font formats for which it has no memory. */
    FT_Error error = errno == ENOMEM ? FT_Err_Out_Of_Memory : 0;
    for (int face = 0; face < FACE_COUNT && error != FT_Err_Out_Of_Memory;
         face++) {
        error = open_font(made->freetype, (Face)face, given, &made->font[face]);
        if (error)
            made->font[face] = made->font[FACE_REGULAR];
    }
    bool out_of_memory = error == FT_Err_Out_Of_Memory;
    if (made->font[FACE_REGULAR] && !out_of_memory)
        *text = made;
    else
        font_free(made);
    return out_of_memory ? STATUS_OUT_OF_MEMORY : STATUS_OK;
}

static void forget_glyphs(Font *text)
{
    for (int i = 0; i < TEXT_MAX_GLYPHS; i++)
        free(text->glyph_table[i].mask);
    memset(text->glyph_table, 0, sizeof text->glyph_table);
    text->glyph_count = 0;
}

void font_free(Font *text)
{
    if (!text)
        return;
    forget_glyphs(text);
    FT_Done_FreeType(text->freetype); /* also frees the fonts */
    free(text);
}

/* ---- letters ------------------------------------------------------------ */

/* Renders a letter; a letter that FreeType cannot render is blank. */
static Glyph render_glyph(Font *text, Face face, int size, uint32_t letter)
{
    Glyph glyph = {.advance = (int)(FONT_GUESSED * size)};
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

const Glyph *font_get_glyph(Font *text, Face face, int size, uint32_t letter)
{
    uint64_t key =
        (uint64_t)letter << 16 | (uint64_t)size << 4 | ((uint64_t)face + 1);
    if (text->glyph_count > TEXT_MAX_GLYPHS / 2)
        forget_glyphs(text);
    size_t place = (size_t)(key * 0x9e3779b97f4a7c15u >> 40) % TEXT_MAX_GLYPHS;
    while (text->glyph_table[place].key && text->glyph_table[place].key != key)
        place = (place + 1) % TEXT_MAX_GLYPHS;
    Glyph *glyph = &text->glyph_table[place];
    if (!glyph->key) {
        *glyph = render_glyph(text, face, size, letter);
        glyph->key = key;
        text->glyph_count++;
    }
    return glyph;
}
