/* blend.h - how a colour is mixed into a pixel. */
#ifndef ELASTO_BLEND_H
#define ELASTO_BLEND_H

#include "picture/canvas.h"

/* below + (above - below) amount / 256, red and blue in one multiplication. */
static inline uint32_t mix(uint32_t below, uint32_t above, uint32_t amount)
{
    uint32_t rest = 256 - amount;
    uint32_t red_blue = (below & 0xff00ff) * rest + (above & 0xff00ff) * amount;
    uint32_t green = (below & 0x00ff00) * rest + (above & 0x00ff00) * amount;
    return 0xff000000u | (red_blue >> 8 & 0xff00ff) | (green >> 8 & 0x00ff00);
}

/* Alpha of the colour as 0 ... 256. */
static inline uint32_t opacity(Colour colour)
{
    uint32_t alpha = colour >> 24;
    return alpha + (alpha >> 7);
}

#endif
