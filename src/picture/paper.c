#include "picture/paper.h"

#include <math.h>

#include "picture/colour_map.h"

/* Size of a letter's dots in units, so that a line holds PAPER_LETTERS. */
static const double PAPER_DOT = 1.2;

/* Canvas and font. */
Status paper_create(int width, int height, Paper *paper)
{
    *paper = (Paper){0};
    Status status = canvas_create(width, height, &paper->canvas);
    if (status)
        return status;
    int smaller = width < height ? width : height;
    paper->unit = (double)smaller / PAPER_UNITS;
    return font_create(PAPER_DOT * paper->unit, &paper->font);
}

/* Canvas and font. */
void paper_free(Paper *paper)
{
    if (!paper)
        return;
    canvas_free(&paper->canvas);
    font_free(&paper->font);
}

/* units * unit, rounded. */
int paper_pixels(const Paper *paper, double units)
{
    return (int)floor(units * paper->unit + 0.5);
}

/* Letters below 4 x 7 pixels are only noise. */
bool paper_shows_text(const Paper *paper)
{
    return paper->font.width >= 4;
}

/* scale = part * smaller side / size */
Mapping paper_mapping(const Paper *paper, double size, double part)
{
    Mapping mapping;
    mapping.scale = part * PAPER_UNITS * paper->unit / size;
    mapping.x0 = 0.5 * paper->canvas.width;
    mapping.y0 = 0.5 * paper->canvas.height;
    return mapping;
}

/* The canvas clips. */
void paper_line(Paper *paper, const Mapping *mapping, const double *a,
                const double *b, double width, Colour colour)
{
    canvas_line(&paper->canvas, mapping->x0 + mapping->scale * a[0],
                mapping->y0 - mapping->scale * a[1],
                mapping->x0 + mapping->scale * b[0],
                mapping->y0 - mapping->scale * b[1],
                fmax(1, width * paper->unit), colour);
}

/* The canvas clips. */
void paper_disc(Paper *paper, const Mapping *mapping, const double *a,
                double radius, Colour colour)
{
    canvas_disc(&paper->canvas, mapping->x0 + mapping->scale * a[0],
                mapping->y0 - mapping->scale * a[1], radius * paper->unit,
                colour);
}

/* Lets one sixth of what is below shine through. */
void paper_panel(Paper *paper, Box box)
{
    canvas_rectangle(&paper->canvas, box.x, box.y, box.width, box.height,
                     COLOUR_PANEL);
}

/* The font of the paper on its canvas. */
void paper_text(Paper *paper, int x, int y, Align align, Colour colour,
                const char *text)
{
    font_draw(&paper->font, &paper->canvas, x, y, align, colour, text);
}

/* Twice, a little apart. */
void paper_bold_text(Paper *paper, int x, int y, Align align, Colour colour,
                     const char *text)
{
    int apart = paper_pixels(paper, 0.5);
    paper_text(paper, x, y, align, colour, text);
    if (apart > 0)
        paper_text(paper, x + apart, y, align, colour, text);
}
