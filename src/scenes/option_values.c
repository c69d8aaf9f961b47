#include "scenes/option_values.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/one_line.h"
#include "scenes/pages.h"
#include "scenes/scene.h"

Status complain(const Complaint *complaint, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(complaint->text, complaint->size, format, arguments);
    va_end(arguments);
    return STATUS_INVALID_INPUT;
}

Text typed(const char *word)
{
    Text shown;
    one_line(word, shown.text, 64);
    return shown;
}

Text number_text(double number)
{
    Text shown;
    snprintf(shown.text, sizeof shown.text, fabs(number) >= 1e5 ? "%.0e" : "%g",
             number);
    char *plus = strstr(shown.text, "e+");
    if (plus) {
        char *digits = plus + 2 + strspn(plus + 2, "0");
        memmove(plus + 1, digits, strlen(digits) + 1);
    }
    return shown;
}

void add_name(Text *list, const char *before, const char *name)
{
    size_t used = strlen(list->text);
    snprintf(list->text + used, sizeof list->text - used, "%s%s%s",
             used > 0 ? ", " : "", before, name);
}

/* ---- what was meant ----------------------------------------------------- */

enum { LONGEST = 40 }; /* letters that are compared */

/* As two names are compared: small letters, '-' for '_'. */
static char plain(char c)
{
    return (char)(c == '_' ? '-' : tolower((unsigned char)c));
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
        for (int j = 0; j <= columns; j++) {
            d[i][j] = i + j;
            if (i == 0 || j == 0)
                continue;
            bool same = plain(a[i - 1]) == plain(b[j - 1]);
            d[i][j] = least(d[i - 1][j - 1] + !same,
                            1 + least(d[i - 1][j], d[i][j - 1]));
            if (i > 1 && j > 1 && plain(a[i - 1]) == plain(b[j - 2]) &&
                plain(a[i - 2]) == plain(b[j - 1]))
                d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[rows][columns];
}

void look_at_name(Nearest *nearest, const char *kind, const char *name)
{
    const char *text = nearest->text;
    int longer = (int)fmax(strlen(name), strlen(text));
    if (longer == 0 || longer > LONGEST)
        return;
    int wrong = distance(name, text);
    if (4 * wrong <= longer && (!nearest->name || wrong < nearest->unlike))
        *nearest = (Nearest){text, kind, name, wrong};
}

/* ---- numbers ------------------------------------------------------------ */

/* A decimal number at the beginning of a text, no "inf", "0x1" or blanks;
 * returns what follows it, or NULL. */
static const char *read_decimal(const char *text, double *number)
{
    size_t length = strspn(text, "+-.0123456789eE");
    char *end = NULL;
    *number = strtod(text, &end);
    if (length == 0 || !strchr("+-.0123456789", text[0]) ||
        end != text + length || !isfinite(*number))
        return NULL;
    return end;
}

/* What is meant by "1/60", "140%", "5 ms", as a number in the row's unit; NaN:
 * nobody knows. */
static double number_meant(const OptionRow *row, const char *text)
{
    static const struct {
        const char *end, *unit; /* "": of a number without one */
        double times, over;     /* whole, so that 7 ms are 0.007 s */
    } ends[] = {
        {"%", "", 1, 100},   {"sec", "s", 1, 1},      {"ms", "s", 1, 1e3},
        {"us", "s", 1, 1e6}, {"cm", "m", 1, 1e2},     {"mm", "m", 1, 1e3},
        {"km", "m", 1e3, 1}, {"cm/s", "m/s", 1, 1e2}, {"mm/s", "m/s", 1, 1e3}};
    size_t length = strcspn(row->unit, " ");
    double number, below = 1;
    const char *end = read_decimal(text, &number);
    if (end && *end == '/')
        end = read_decimal(end + 1, &below);
    if (!end)
        return NAN;
    end += strspn(end, " ");
    if (*end == '\0' ||
        (strlen(end) == length && strncmp(end, row->unit, length) == 0))
        return number / below;
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        if (strcmp(end, ends[i].end) == 0 &&
            strcmp(row->unit, ends[i].unit) == 0)
            return number * ends[i].times / ends[i].over / below;
    return NAN;
}

/* As many numbers as the row has, each in its range; a single one may have a
 * decimal comma.  number [count] out.  Returns whether they can be read. */
static bool read_numbers(const OptionRow *row, int count, const char *text,
                         double *number)
{
    char copy[128], *at = copy, between = row->between ? row->between : ',';
    if (strlen(text) >= sizeof copy)
        return false;
    strcpy(copy, text);
    for (int i = 0; i < count; i++) {
        char *next = strchr(at, i + 1 < count ? between : '\0');
        if (!next)
            return false;
        *next = '\0';
        for (char *comma; count == 1 && (comma = strchr(at, ','));)
            *comma = '.';
        number[i] = number_meant(row, at);
        if (!(number[i] >= row->low && number[i] <= row->high) ||
            (row->kind == OPTION_WHOLE && number[i] != floor(number[i])))
            return false;
        at = next + 1;
    }
    return true;
}

bool option_read(const OptionRow *row, const char *text, double *value)
{
    if (!row->names)
        return read_numbers(row, 1, text, value);
    for (int i = 0; i < option_names(row); i++) {
        *value = i;
        if (strcmp(row->names(i), text) == 0)
            return true;
    }
    return false;
}

/* "a whole number from 1 to 4096", "X,Y, each from -1 to 1, in m" */
Status refuse_number(const OptionRow *row, int count, const char *text,
                     const Complaint *complaint)
{
    return complain(complaint, "--%s: '%s' is not %s%s from %s to %s%s%s",
                    row->name, typed(text).text, count > 1 ? row->value : "",
                    count > 1                    ? ", each"
                    : row->kind == OPTION_NUMBER ? "a number"
                                                 : "a whole number",
                    number_text(row->low).text, number_text(row->high).text,
                    row->unit[0] ? ", in " : "", row->unit);
}

/* Where a scene is a curve, its start may be x alone. */
static Status apply_numbers(const OptionRow *row, const char *text,
                            Options *options, const Complaint *complaint)
{
    enum { NUMBERS_MOST = 4 };
    double number[NUMBERS_MOST] = {0};
    int most = row->count ? row->count : 1, count = most, used = 0;
    bool curve = options->scene->needs & NEEDS_ONE_NUMBER;
    if (row->needs == NEEDS_START && curve && !strchr(text, ','))
        count = 1;
    if (!read_numbers(row, count, text, number))
        return refuse_number(row, count, text, complaint);
    double *counter = &options->number[row->counter];
    if (row->times && *counter >= row->times)
        return complain(complaint, "--%s: '%s' is one too many: at most %d",
                        row->name, typed(text).text, row->times);
    if (row->times)
        used = (int)(*counter)++;
    for (int i = 0; i < most; i++)
        options->number[row->slot + used * most + i] = number[i];
    return STATUS_OK;
}

/* ---- names, and all ----------------------------------------------------- */

/* One of the row's names; a page by its number, too. */
static Status apply_name(const OptionRow *row, const char *text,
                         Options *options, const Complaint *complaint)
{
    Text list = {""};
    Nearest near = {.text = text};
    double value;
    bool known = option_read(row, text, &value);
    if (row->kind == OPTION_PAGE) {
        options->page = lecture_find(text[0] ? text : "1");
        known = options->page != NULL;
    } else if (known) {
        options->number[row->slot] = value;
    }
    if (known)
        return STATUS_OK;
    for (int i = 0; i < option_names(row); i++) {
        add_name(&list, "", row->names(i));
        look_at_name(&near, "", row->names(i));
    }
    if (row->kind == OPTION_PAGE)
        snprintf(list.text, sizeof list.text,
                 "the pages from 1 to %d, their names", lecture_count());
    return complain(complaint, "--%s: '%s' is none of: %s%s%s%s", row->name,
                    typed(text).text, list.text,
                    near.name ? "; did you mean " : "",
                    near.name ? near.name : "", near.name ? "?" : "");
}

Status option_apply(const OptionRow *row, const char *text, Options *options,
                    const Complaint *complaint)
{
    switch (row->kind) {
    case OPTION_SWITCH:
        options->number[row->slot] = 1;
        return STATUS_OK;
    case OPTION_TEXT:
        if (text[0] == '\0')
            return complain(complaint, "--%s: the name is empty", row->name);
        memcpy((char *)options + row->offset, &text, sizeof text);
        return STATUS_OK;
    case OPTION_NAME:
    case OPTION_PAGE:
        return apply_name(row, text, options, complaint);
    default:
        return apply_numbers(row, text, options, complaint);
    }
}
