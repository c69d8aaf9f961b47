#include "scenes/nearest.h"

#include <ctype.h>
#include <string.h>

enum { LONGEST = 40 }; /* letters that are compared */

/* The name of row i, or NULL behind the last. */
static const char *row_name(const void *table, size_t stride, int i)
{
    const char *name;
    memcpy(&name, (const char *)table + stride * (size_t)i, sizeof name);
    return name;
}

/* As two names are compared: small letters, '-' for '_'. */
static char plain(char c)
{
    return (char)(c == '_' ? '-' : tolower((unsigned char)c));
}

static bool same_words(const char *a, const char *b, size_t length)
{
    for (size_t i = 0; i < length; i++)
        if (plain(a[i]) != plain(b[i]))
            return false;
    return true;
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* Letters to insert, delete, replace, or swap with their neighbours: row i of
 * d[][] is for the first i letters of a (optimal string alignment). */
static int distance(const char *a, const char *b)
{
    int rows = (int)strlen(a), columns = (int)strlen(b);
    int d[LONGEST + 1][LONGEST + 1];
    for (int i = 0; i <= rows; i++)
        d[i][0] = i;
    for (int j = 0; j <= columns; j++)
        d[0][j] = j;
    for (int i = 1; i <= rows; i++)
        for (int j = 1; j <= columns; j++) {
            bool same = plain(a[i - 1]) == plain(b[j - 1]);
            d[i][j] = least(d[i - 1][j - 1] + !same,
                            1 + least(d[i - 1][j], d[i][j - 1]));
            if (i > 1 && j > 1 && plain(a[i - 1]) == plain(b[j - 2]) &&
                plain(a[i - 2]) == plain(b[j - 1]))
                d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[rows][columns];
}

/* 0: the same; large: nothing in common. */
static int unlikeness(const char *name, const char *text)
{
    size_t n = strlen(name), t = strlen(text);
    size_t shorter = n < t ? n : t, longer = n < t ? t : n;
    if (shorter == 0 || longer > LONGEST)
        return LONGEST;
    int wrong = distance(name, text);
    if (3 * wrong <= (int)longer)
        return wrong;
    const char *more = n < t ? text : name, *less = n < t ? name : text;
    if (shorter >= 3 && (same_words(more, less, shorter) ||
                         same_words(more + longer - shorter, less, shorter)))
        return LONGEST / 2;
    return LONGEST;
}

const void *named_row(const void *table, size_t stride, const char *name)
{
    for (int i = 0; row_name(table, stride, i); i++)
        if (strcmp(row_name(table, stride, i), name) == 0)
            return (const char *)table + stride * (size_t)i;
    return NULL;
}

const void *nearest_row(const void *table, size_t stride, const char *text)
{
    const void *nearest = NULL;
    int smallest = LONGEST;
    for (int i = 0; row_name(table, stride, i); i++) {
        int unlike = unlikeness(row_name(table, stride, i), text);
        if (unlike < smallest) {
            smallest = unlike;
            nearest = (const char *)table + stride * (size_t)i;
        }
    }
    return nearest;
}

bool is_one_of(const char *words, const char *text)
{
    size_t length = strlen(text);
    while (words && *words) {
        size_t word = strcspn(words, " ");
        if (word == length && word > 0 && same_words(words, text, word))
            return true;
        words += word + (words[word] == ' ');
    }
    return false;
}
