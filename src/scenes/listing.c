#include "scenes/listing.h"

#include <ctype.h>
#include <string.h>

const Listing *listing_find(const char *file)
{
    for (const Listing *listing = listings; listing->file; listing++)
        if (strcmp(listing->file, file) == 0)
            return listing;
    return NULL;
}

/* The line after the closing brace of what begins here; 0: a declaration, for
 * it ends before a brace. */
static int find_end(const Listing *listing, int from)
{
    bool body = false;
    for (int i = from; i < listing->lines; i++) {
        const char *line = listing->line[i];
        char last = line[0] ? line[strlen(line) - 1] : ' ';
        if (line[0] == '}' || (!body && last == '}'))
            return i + 1;
        if (!body && last == ';')
            return 0;
        body = body || line[0] == '{';
    }
    return 0;
}

/* It is named outside of any body: in column 1 stands a type, and the name is a
 * whole word before a parenthesis. */
bool listing_function(const Listing *listing, const char *function, int *from,
                      int *body, int *to)
{
    for (int i = 0; i < listing->lines; i++) {
        const char *line = listing->line[i], *at = strstr(line, function);
        bool named = at && isalpha((unsigned char)line[0]) &&
                     (at == line || at[-1] == ' ' || at[-1] == '*') &&
                     at[strlen(function)] == '(';
        *to = named ? find_end(listing, i) : 0;
        if (*to == 0)
            continue;
        *from = *body = i;
        if (i > 0 && strstr(listing->line[i - 1], "*/"))
            for (--*from; *from > 0 && !strstr(listing->line[*from], "/*");)
                --*from;
        return true;
    }
    return false;
}
