#include "scenes/nearest.h"
#include "scenes/option_row.h"
#include "scenes/pages.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/one_line.h"

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

NumberText number_text(double number)
{
    NumberText shown;
    double size = fabs(number);
    snprintf(shown.text, sizeof shown.text, "%.15g", number);
    if (size >= 1e5 || (size > 0 && size < 1e-3))
        snprintf(shown.text, sizeof shown.text, "%.0e", number);
    if (strtod(shown.text, NULL) != number)
        snprintf(shown.text, sizeof shown.text, "%.15g", number);
    char *plus = strstr(shown.text, "e+");
    if (plus) {
        char *digits = plus + 2 + strspn(plus + 2, "0");
        memmove(plus + 1, digits, strlen(digits) + 1);
    }
    return shown;
}

/* "a whole number from 1 to 4096", "a number from 1e-30 to 1e30, in s" */
static Text range_text(const OptionRow *row)
{
    Text range;
    const char *what = row->kind == KIND_WHOLE     ? "a whole number"
                       : row->kind == KIND_NUMBERS ? "each"
                                                   : "a number";
    snprintf(range.text, sizeof range.text, "%s%s%s from %s to %s%s%s",
             row->kind == KIND_NUMBERS ? row->value : "",
             row->kind == KIND_NUMBERS ? ", " : "", what,
             number_text(row->low).text, number_text(row->high).text,
             row->unit ? ", in " : "", row->unit ? row->unit : "");
    return range;
}

void add_name(Text *list, const char *name)
{
    size_t used = strlen(list->text);
    snprintf(list->text + used, sizeof list->text - used, "%s%s",
             used > 0 ? ", " : "", name);
}

/* A decimal number at the beginning of a text, no "inf", "0x1" or blanks;
 * returns what follows it, or NULL. */
static const char *read_number(const char *text, double *number)
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
    const char *unit = row->unit ? row->unit : "";
    double number, below = 1;
    const char *end = read_number(text, &number);
    if (end && *end == '/')
        end = read_number(end + 1, &below);
    if (!end || (row->kind != KIND_NUMBER && row->kind != KIND_WHOLE))
        return NAN;
    end += strspn(end, " ");
    if (*end == '\0' || strcmp(end, unit) == 0)
        return number / below;
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        if (strcmp(end, ends[i].end) == 0 && strcmp(unit, ends[i].unit) == 0)
            return number * ends[i].times / ends[i].over / below;
    return NAN;
}

void options_meant(const char *name, const char *text, char *value, size_t size)
{
    const OptionRow *row = option_row(name);
    char point[64];
    snprintf(point, sizeof point, "%s", text);
    for (char *comma = point; (comma = strchr(comma, ','));)
        *comma = '.';
    double number = row->name ? number_meant(row, point) : NAN;
    snprintf(value, size, "%s", text);
    if (!isfinite(number))
        return;
    snprintf(value, size, "%.15g", number);
    if (strtod(value, NULL) != number)
        snprintf(value, size, "%.17g", number);
}

static bool in_range(const OptionRow *row, double number)
{
    return number >= row->low && number <= row->high;
}

static Status refuse_number(const OptionRow *row, const char *text,
                            const Complaint *complaint)
{
    double meant = number_meant(row, text);
    char write[48] = "";
    bool whole = row->kind == KIND_WHOLE;
    if (in_range(row, meant) && !(whole && meant != floor(meant)))
        snprintf(write, sizeof write, "; write %.4g", meant);
    return complain(complaint, "--%s: '%s' is not %s%s", row->name,
                    typed(text).text, range_text(row).text, write);
}

/* Also 1e3 and 4.0; digits alone are read exactly. */
static Status parse_whole(const OptionRow *row, const char *text, void *field,
                          const Complaint *complaint)
{
    double number;
    const char *end = read_number(text, &number);
    if (!end || *end || !in_range(row, number) || number != floor(number))
        return refuse_number(row, text, complaint);
    long whole = text[strspn(text, "+-0123456789")] ? (long)number
                                                    : strtol(text, NULL, 10);
    int small = (int)whole;
    if (row->size == sizeof small)
        memcpy(field, &small, sizeof small);
    else
        memcpy(field, &whole, sizeof whole);
    return STATUS_OK;
}

/* As many numbers as the row has, with commas between them. */
static Status parse_numbers(const OptionRow *row, int count, const char *text,
                            double *numbers, const Complaint *complaint)
{
    const char *at = text;
    for (int i = 0; i < count; i++) {
        at = read_number(at, &numbers[i]);
        if (!at || !in_range(row, numbers[i]) ||
            *at++ != (i + 1 < count ? ',' : '\0'))
            return refuse_number(row, text, complaint);
    }
    return STATUS_OK;
}

/* One of the row's names. */
static Status parse_name(const OptionRow *row, const char *text, void *field,
                         const Complaint *complaint)
{
    Text list = {""};
    const OptionName *name = named_row(row->names, sizeof *name, text);
    if (name) {
        memcpy(field, &name->value, sizeof name->value);
        return STATUS_OK;
    }
    for (const OptionName *known = row->names; known->name; known++) {
        add_name(&list, known->name);
        if (!name && is_one_of(known->words, text))
            name = known;
    }
    if (!name)
        name = nearest_row(row->names, sizeof *name, text);
    return complain(complaint, "--%s: '%s' is none of: %s%s%s%s", row->name,
                    typed(text).text, list.text, name ? "; did you mean " : "",
                    name ? name->name : "", name ? "?" : "");
}

/* The slides' own words, and other usual ones. */
typedef struct IntegratorWord {
    const char *name, *means;
} IntegratorWord;

static const IntegratorWord integrator_words[] = {
    {"implicit-euler", "backward-euler"},
    {"be", "backward-euler"},
    {"explicit-euler", "forward-euler"},
    {"fe", "forward-euler"},
    {"se", "symplectic-euler"},
    {"semi-implicit-euler", "symplectic-euler"},
    {"velocity-verlet", "verlet"},
    {"implicit-midpoint", "midpoint"},
    {"average-vector-field", "avf"},
    {NULL, NULL},
};

/* Methods of others, and which of ours comes nearest. */
static const IntegratorWord integrator_others[] = {
    {"leapfrog", "verlet"},
    {"stormer", "verlet"},
    {"stoermer-verlet", "verlet"},
    {"bdf1", "backward-euler"},
    {"crank-nicolson", "midpoint"},
    {"trapezoidal", "midpoint"},
    {"trapezoid", "midpoint"},
    {"newmark", "midpoint"},
    {"newmark-beta", "midpoint"},
    {"gauss-legendre", "midpoint"},
    {"dirk", "sdirk2"},
    {NULL, NULL},
};

const IntegratorMethod *integrator_meant(const char *text)
{
    const IntegratorWord *word =
        named_row(integrator_words, sizeof *word, text);
    return integrator_method(word ? word->means : text);
}

/* A row of the table of integrators. */
Status parse_integrator(const OptionRow *row, const char *text,
                        Options *options, const Complaint *complaint)
{
    Text list = {""};
    const IntegratorWord *word;
    options->integrator = integrator_meant(text);
    if (options->integrator)
        return STATUS_OK;
    for (const IntegratorMethod *known = integrator_methods; known->name;
         known++)
        add_name(&list, known->name);
    const IntegratorMethod *near = NULL;
    for (word = integrator_others; word->name && !near; word++)
        if (is_one_of(word->name, text))
            near = integrator_method(word->means);
    if (!near)
        near = nearest_row(integrator_methods, sizeof *near, text);
    if (!near && (word = nearest_row(integrator_words, sizeof *word, text)))
        near = integrator_method(word->means);
    return complain(complaint, "--%s: '%s' is none of: %s%s%s%s", row->name,
                    typed(text).text, list.text, near ? "; did you mean " : "",
                    near ? near->name : "", near ? "?" : "");
}

/* X,Y; or X alone where the scene is a curve over x. */
Status parse_start(const OptionRow *row, const char *text, Options *options,
                   const Complaint *complaint)
{
    bool curve = options->scene->needs & NEEDS_ONE_NUMBER;
    double start[2] = {0, 0};
    int count = curve && !strchr(text, ',') ? 1 : 2;
    OptionRow needed = *row;
    needed.kind = curve ? KIND_NUMBER : KIND_NUMBERS;
    needed.value = "X,Y";
    Status status = parse_numbers(&needed, count, text, start, complaint);
    if (!status)
        memcpy(options->start, start, sizeof start);
    return status;
}

/* Where the next value of a row is stored; NULL: there were too many. */
static void *next_field(const OptionRow *row, Options *options)
{
    char *field = (char *)options + row->offset;
    int used = 0;
    if (row->times < 2)
        return field;
    memcpy(&used, (char *)options + row->counter, sizeof used);
    if (used >= row->times)
        return NULL;
    field += row->size / (size_t)row->times * (size_t)used++;
    memcpy((char *)options + row->counter, &used, sizeof used);
    return field;
}

/* One option of the command line. */
Status option_apply(const OptionRow *row, const char *text, Options *options,
                    const Complaint *complaint)
{
    void *field = next_field(row, options);
    const bool yes = true;
    if (!field)
        return complain(complaint, "--%s: '%s' is one too many: at most %d",
                        row->name, typed(text).text, row->times);
    switch (row->kind) {
    case KIND_SWITCH:
        memcpy(field, &yes, sizeof yes);
        return STATUS_OK;
    case KIND_WHOLE:
        return parse_whole(row, text, field, complaint);
    case KIND_NUMBER:
        return parse_numbers(row, 1, text, field, complaint);
    case KIND_NUMBERS:
        return parse_numbers(row, row->count, text, field, complaint);
    case KIND_NAME:
        return parse_name(row, text, field, complaint);
    case KIND_TEXT:
        if (text[0] == '\0')
            return complain(complaint, "--%s: the name is empty", row->name);
        memcpy(field, &text, sizeof text);
        return STATUS_OK;
    default:
        return row->parse(row, text, options, complaint);
    }
}

Status parse_size(const OptionRow *row, const char *text, Options *options,
                  const Complaint *complaint)
{
    int width = 0, height = 0;
    char end;
    bool digits = text[0] >= '0' && text[0] <= '9';
    if (digits && sscanf(text, "%5dx%5d%c", &width, &height, &end) == 2 &&
        width >= row->low && height >= row->low && width <= row->high &&
        height <= row->high) {
        options->size[0] = width;
        options->size[1] = height;
        return STATUS_OK;
    }
    return complain(complaint,
                    "--%s: '%s' is not WIDTHxHEIGHT, each from %s to %s",
                    row->name, typed(text).text, number_text(row->low).text,
                    number_text(row->high).text);
}

Status parse_page(const OptionRow *row, const char *text, Options *options,
                  const Complaint *complaint)
{
    const LecturePage *page = lecture_find(text[0] ? text : "1");
    if (page) {
        options->page = page;
        return STATUS_OK;
    }
    const LecturePage *near =
        nearest_row(lecture_pages, sizeof *lecture_pages, text);
    return complain(complaint, "--%s: there is no page '%s': from 1 to %d%s%s",
                    row->name, typed(text).text, lecture_count(),
                    near ? "; did you mean " : ", or a name",
                    near ? near->name : "");
}
