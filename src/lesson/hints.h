/* hints.h - names for users who mistyped one, or who used a removed option. */
#pragma once

#include "simulation/options.h"

/* A part of a message, returned by value. */
typedef struct Phrase {
    char text[256];
} Phrase;

/* Returns the names of a list: "clamp, none". */
Phrase join_names(NameTable names);

/* Returns a hint such as "; did you mean --timestep?": the name of which the
 * text is a synonym in other programs or books, else the nearest name; "": no
 * name is near.
 *   dashes  "--" or "", written before the name */
Phrase suggest_name(const char *text, const char *dashes, NameTable names);

/* Returns what to use instead of an option, or of one of its values, that an
 * earlier version had; NULL: no version had it.
 *   value  "": the option itself */
const char *find_replacement(const char *option, const char *value);
