/* listing.h - the text of the sources that the lecture's pages name, compiled
 * into the program: it never looks for its source folder.
 */
#ifndef ELASTO_LISTING_H
#define ELASTO_LISTING_H

#include <stdbool.h>

typedef struct Listing {
    const char *file;        /* as from the top folder: "src/lecture.c" */
    int lines;               /* of it */
    const char *const *line; /* [lines] without their ends */
} Listing;

/* The table; it ends with a NULL file.  The Makefile writes it. */
extern const Listing listings[];

/* The listing of this file, or NULL. */
const Listing *listing_find(const char *file);

/* Where a function is defined, the comment above it included.
 *   from, to  out, lines from <= line < to, counted from 0
 *   body      out, the line with its name
 * Returns false where the file has no function of this name. */
bool listing_function(const Listing *listing, const char *function, int *from,
                      int *body, int *to);

#endif
