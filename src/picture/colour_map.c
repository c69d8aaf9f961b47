#include "picture/colour_map.h"

/* One byte of from + (to - from) part / 256. */
static uint32_t blend_byte(Colour from, Colour to, int shift, uint32_t part)
{
    uint32_t a = from >> shift & 0xff, b = to >> shift & 0xff;
    return ((a * (256 - part) + b * part) >> 8) << shift;
}

/* Straight lines in RGB from the grey in the middle to both ends. */
Colour colour_map_strain(double strain, double range)
{
    Colour end = strain < 0 ? COLOUR_COMPRESS : COLOUR_STRETCH;
    double size = strain < 0 ? -strain : strain;
    uint32_t part = 0;
    if (size >= range)
        part = 256;
    else if (size > 0)
        part = (uint32_t)(256 * (size / range));
    return 0xff000000u | blend_byte(COLOUR_REST, end, 16, part) |
           blend_byte(COLOUR_REST, end, 8, part) |
           blend_byte(COLOUR_REST, end, 0, part);
}
