/* option_values.c - reads, writes and raises the values of options. */
#include "simulation/options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Reads a decimal number at the beginning of a text; "inf", "0x1" and leading
 * blanks are not accepted.  Returns the rest of the text, or NULL. */
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

/* Whether a text is the row's unit: "J/m^2", "J/m\u00b2"; "deg" for degrees. */
static bool is_option_unit(const OptionRow *row, const char *text)
{
    size_t length = strcspn(row->unit, " ");
    char shown[32];
    option_write_unit(row, shown, sizeof shown);
    return (strlen(text) == length && !strncmp(text, row->unit, length)) ||
           strcmp(text, shown) == 0 ||
           (strcmp(text, "deg") == 0 && strcmp(row->unit, "degrees") == 0);
}

/* Returns the number in the row's unit that a text such as "1/60", "140%" or
 * "5 ms" stands for; NaN: the text is no number. */
static double parse_option_number(const OptionRow *row, const char *text)
{
    static const struct {
        const char *unit_prefix;
        double parts_per_unit; /* prefix "m": 1000, as 1000 mm are 1 m */
    } prefixes[] = {{"", 1},    {"k", 1e-3},     {"c", 1e2},     {"m", 1e3},
                    {"u", 1e6}, {"\u00b5", 1e6}, {"\u03bc", 1e6}};
    double number, divisor = 1;
    const char *end = read_decimal(text, &number);
    if (end && *end == '/')
        end = read_decimal(end + 1, &divisor);
    if (!end)
        return NAN;
    end += strspn(end, " ");
    if (*end == '\0')
        return number / divisor;
    if (!row->unit[0])
        return strcmp(end, "%") == 0 ? number / 100 / divisor : NAN;
    for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++) {
        size_t length = strlen(prefixes[i].unit_prefix);
        if (strncmp(end, prefixes[i].unit_prefix, length) == 0 &&
            is_option_unit(row, end + length))
            return number / (divisor * prefixes[i].parts_per_unit);
    }
    return NAN;
}

bool option_allows(const OptionRow *row, double number)
{
    if (row->kind == OPTION_NAME)
        return number >= 0 && number < names_count(row->value_names);
    return number >= row->low && number <= row->high &&
           (row->kind != OPTION_WHOLE_NUMBER || number == floor(number));
}

int option_count_values(const char *text, char separator)
{
    int count = 1;
    for (; *text; text++)
        count += *text == separator;
    return count;
}

bool option_parse(const OptionRow *row, int count, const char *text,
                  double *number)
{
    const char separator[2] = {row->separator ? row->separator : ','};
    int given = option_count_values(text, separator[0]);
    char copy[256], *rest = copy;
    if (row->kind == OPTION_NAME) {
        *number = names_find(row->value_names, text);
        return *number >= 0;
    }
    if (strlen(text) >= sizeof copy)
        return false;
    strcpy(copy, text);
    for (char *comma; count == 1 && (comma = strchr(copy, ','));)
        *comma = '.';
    if (given < count && row->allowed_short_counts >> given & 1) {
        memcpy(number, row->omitted_defaults, (size_t)count * sizeof *number);
        count = given;
    }
    for (int i = 0; i < count; i++) {
        const char *part = strsep(&rest, separator);
        number[i] = part ? parse_option_number(row, part) : NAN;
        if (!option_allows(row, number[i]))
            return false;
    }
    return !rest;
}

void option_write(const OptionRow *row, double value, char *text, size_t size)
{
    if (row && row->kind == OPTION_NAME) {
        snprintf(text, size, "%s",
                 names_get(row->value_names, option_get_name_index(value)));
        return;
    }
    snprintf(text, size, "%.15g", value);
    if (strtod(text, NULL) != value)
        snprintf(text, size, "%.17g", value);
}

void option_write_short_value(const OptionRow *row, const Options *options,
                              char *text, size_t size)
{
    /* Most digits of a number; most letters of a list of numbers. */
    enum { MAX_DIGITS = 6, MAX_LIST_LETTERS = 20 };
    int count = row->number_count > 1 ? row->number_count : 1, last = 0;
    if (row->max_repetitions)
        last = (int)fmax(options->number[row->count_slot] - 1, 0);
    const double *value = options->number + row->slot + last * count;
    /* a value below the range can only be a default that means "none" */
    if (*value < row->low ||
        (row->number_count && (row->term || row->max_repetitions) &&
         !option_is_on(row, options)))
        snprintf(text, size, "none");
    else if (row->kind == OPTION_NAME)
        option_write(row, *value, text, size);
    else
        for (int digits = MAX_DIGITS; digits > 1; digits--) {
            size_t used = 0;
            for (int i = 0; i < count && used < size; i++)
                used += (size_t)snprintf(text + used, size - used, "%s%.*g",
                                         i ? "," : "", digits, value[i]);
            if (count == 1 || used <= MAX_LIST_LETTERS)
                break;
        }
}

void option_write_unit(const OptionRow *row, char *text, size_t size)
{
    int length = (int)strcspn(row->unit, " ^");
    bool angle = strcmp(row->unit, "degrees") == 0;
    snprintf(text, size, "%.*s%s", length, angle ? "\u00b0" : row->unit,
             row->unit[length] == '^' ? "\u00b2" : "");
}

/* Returns the round number with this index: 1, 1.5, 2, 3, 5, 7, 10, 15 ... */
static double find_round_number(double index)
{
    static const double mantissa[] = {1, 1.5, 2, 3, 5, 7};
    double decade = floor(index / 6);
    return mantissa[(int)(index - 6 * decade)] * pow(10, decade);
}

/* The result is rounded by way of text, because only strtod finds the double
 * nearest to a decimal number.  Arithmetic with powers of 10 may miss that
 * double by a bit, and the number would be shown with 17 digits. */
double option_find_value_after_wheel(const OptionRow *row,
                                     const Options *options, double notches)
{
    static const double FIRST = 0.01; /* value after a notch from 0 */
    double value = options->number[row->slot];
    double increment = row->display.notch_increment;
    char text[32];
    if (row->kind == OPTION_NAME) {
        int count = names_count(row->value_names), turns = (int)rint(notches);
        int index = (option_get_name_index(value) + turns) % count;
        return turns == 0 ? value : (index + count) % count;
    }
    if (increment > 0) {
        value = (rint(value / increment) + rint(notches)) * increment;
    } else if (!(value > 0)) {
        return notches > 0 ? fmax(row->low, FIRST) : value;
    } else if (notches != rint(notches)) {
        value *= pow(10, notches / 6);
    } else { /* `below` is the largest round number that is at most the value */
        double below = floor(6 * log10(value)) - 1;
        while (find_round_number(below + 1) <= value * (1 + 1e-9))
            below++;
        bool between = find_round_number(below) < value * (1 - 1e-9);
        value = find_round_number(below + notches + (between && notches < 0));
    }
    value = fmax(value, row->low);
    snprintf(text, sizeof text,
             row->kind == OPTION_WHOLE_NUMBER ? "%.0f" : "%.3g", value);
    return strtod(text, NULL);
}
