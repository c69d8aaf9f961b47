/* colour_map.c - colours of words, methods and runs. */
#include "picture/colour_map.h"

#include <string.h>

Colour colour_of_run(int run)
{
    /* vermilion, green, blue, purple, brown, sky blue */
    static const Colour colours[] = {0xffd55e00u, 0xff009e73u, 0xff0072b2u,
                                     0xffb0559au, 0xff7a5c2eu, 0xff56b4e9u};
    return colours[run % 6];
}

Colour colour_of_spring_kind(int kind)
{
    return colour_of_run(kind < 2 ? kind : 3);
}

/* The first TERM_COLOUR_COUNT rows are terms (letters and energies); words and
 * methods follow.  With a row for a new energy TERM_COLOUR_COUNT grows by 1. */
enum { TERM_COLOUR_COUNT = 21 };
static const struct {
    const char *name;
    Colour colour;
} names[] = {{"x", COLOUR_X},
             {"xt", COLOUR_X_TILDE},
             {"p", COLOUR_P},
             {"alpha", COLOUR_ALPHA},
             {"force", COLOUR_FORCE},
             {"velocity", COLOUR_VELOCITY},
             {"ghost", COLOUR_GHOST},
             {"project", COLOUR_PROJECT},
             {"warning", COLOUR_WARNING},
             {"total", 0xff1c1c1cu},
             {"kinetic", 0xff3d9bd6u},
             {"elastic", 0xffb8860bu},
             {"gravity", 0xff6b8e23u},
             {"contact", 0xffa0522du},
             {"hand", 0xff8a8a8au},
             {"plastic", 0xff7b1fa2u},
             {"fracture", 0xffc2738bu},
             {"friction", 0xff2f6f6fu},
             {"work", 0xff0072b2u},
             {"dissipated", 0xff00a88fu},
             {"damping", 0xffd55e00u},
             {"faint", COLOUR_FAINT},
             {"grey", COLOUR_GREY},
             {"shaded", COLOUR_SHADED},
             {"orange", 0xffd55e00u}, /* orange to purple: run 0 to run 3 */
             {"green", 0xff009e73u},
             {"blue", 0xff0072b2u},
             {"purple", 0xffb0559au},
             {"forward-euler", 0xffd55e00u},
             {"symplectic-euler", 0xff009e73u},
             {"backward-euler", 0xff0072b2u},
             {"verlet", 0xffb0559au},
             {"midpoint", 0xff7a5c2eu},
             {"bdf2", 0xff8a7a00u},
             {"sdirk2", 0xff5a4fa2u}};

Colour colour_find_by_name(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strlen(names[i].name) == length &&
            strncmp(names[i].name, name, length) == 0)
            return names[i].colour;
    return COLOUR_TEXT;
}

Colour colour_of_name(const char *name)
{
    return colour_find_by_name(name, strlen(name));
}

Colour colour_of_term(int term)
{
    return term < TERM_COLOUR_COUNT ? names[term].colour : 0;
}
