/* option_read.c - the command line: its values, its words, and what to say
 * where one of them cannot be read.
 */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/body.h"
#include "scenes/option_help.h"
#include "scenes/pages.h"
#include "scenes/pins.h"
#include "scenes/scene.h"

/* Where the one line that explains a refusal goes. */
typedef struct Complaint {
    char *text;
    size_t size;
} Complaint;

/* Writes the line. */
static Status complain(const Complaint *why, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(why->text, why->size, format, arguments);
    va_end(arguments);
    return STATUS_INVALID_INPUT;
}

/* ---- what was meant ----------------------------------------------------- */

enum { LONGEST = 40 }; /* letters that are compared */

/* As two names are compared: small letters, '-' for '_'. */
static char plain(char c)
{
    return (char)(c == '_' ? '-' : tolower((unsigned char)c));
}

/* Letters to insert, delete, replace, or swap with their neighbours: row i of
 * d[][] is for the first i letters of a (optimal string alignment). */
static int distance(const char *a, const char *b)
{
    int rows = (int)strlen(a), columns = (int)strlen(b);
    double d[LONGEST + 1][LONGEST + 1];
    for (int i = 0; i <= rows; i++)
        for (int j = 0; j <= columns; j++) {
            d[i][j] = i + j;
            if (i == 0 || j == 0)
                continue;
            bool same = plain(a[i - 1]) == plain(b[j - 1]);
            d[i][j] = fmin(d[i - 1][j - 1] + !same,
                           1 + fmin(d[i - 1][j], d[i][j - 1]));
            if (i > 1 && j > 1 && plain(a[i - 1]) == plain(b[j - 2]) &&
                plain(a[i - 2]) == plain(b[j - 1]))
                d[i][j] = fmin(d[i][j], d[i - 2][j - 2] + 1);
        }
    return (int)d[rows][columns];
}

/* "; did you mean --timestep?"  Of the names until NULL the one that is most
 * like a text; at most a quarter of its letters may be wrong, else "". */
static Text meant(const char *text, const char *before,
                  const char *(*names)(int i))
{
    Text hint = {""};
    const char *name;
    int least = LONGEST;
    for (int i = 0; (name = names(i)); i++) {
        int longer = (int)fmax(strlen(name), strlen(text));
        int wrong =
            name[0] && longer <= LONGEST ? distance(name, text) : longer;
        if (4 * wrong > longer || wrong >= least)
            continue;
        least = wrong;
        snprintf(hint.text, sizeof hint.text, "; did you mean %s%s?", before,
                 name);
    }
    return hint;
}

static const char *row_name(int i)
{
    return option_rows[i].name;
}

static const char *scene_name(int i)
{
    return scenes[i].name;
}

/* ---- values ------------------------------------------------------------- */

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

/* "is none of: clamp, none", "is not X,Y, each from -1 to 1, in m" */
static Status refuse_value(const OptionRow *row, int count, const char *text,
                           const Complaint *why)
{
    Text list = {""};
    for (int i = 0; i < option_names(row); i++)
        add_name(&list, "", row->names(i));
    if (row->kind == OPTION_PAGE)
        snprintf(list.text, sizeof list.text,
                 "the pages from 1 to %d, their names", lecture_count());
    if (row->names)
        return complain(why, "--%s: '%s' is none of: %s%s", row->name,
                        typed(text).text, list.text,
                        meant(text, "", row->names).text);
    return complain(why, "--%s: '%s' is not %s%s from %s to %s%s%s", row->name,
                    typed(text).text, count > 1 ? row->value : "",
                    count > 1                    ? ", each"
                    : row->kind == OPTION_NUMBER ? "a number"
                                                 : "a whole number",
                    number_text(row->low).text, number_text(row->high).text,
                    row->unit[0] ? ", in " : "", row->unit);
}

/* A name, or numbers; where a scene is a curve, its start may be x alone. */
static Status apply_numbers(const OptionRow *row, const char *text,
                            Options *options, const Complaint *why)
{
    enum { NUMBERS_MOST = 4 };
    double number[NUMBERS_MOST] = {0}, *counter;
    int most = row->count ? row->count : 1, used = 0;
    bool curve = options->scene->needs & NEEDS_ONE_NUMBER;
    bool short_form = row->needs == NEEDS_START && curve && !strchr(text, ',');
    int count = short_form ? 1 : most;
    if (row->names ? !option_read(row, text, number)
                   : !read_numbers(row, count, text, number))
        return refuse_value(row, count, text, why);
    counter = &options->number[row->counter];
    if (row->times && *counter >= row->times)
        return complain(why, "--%s: '%s' is one too many: at most %d",
                        row->name, typed(text).text, row->times);
    if (row->times)
        used = (int)(*counter)++;
    for (int i = 0; i < most; i++)
        options->number[row->slot + used * most + i] = number[i];
    return STATUS_OK;
}

/* What the option is followed by, into its field; nothing for a page is the
 * first. */
static Status apply(const OptionRow *row, const char *text, Options *options,
                    const Complaint *why)
{
    switch (row->kind) {
    case OPTION_SWITCH:
        options->number[row->slot] = 1;
        return STATUS_OK;
    case OPTION_TEXT:
        memcpy((char *)options + row->offset, &text, sizeof text);
        return text[0] ? STATUS_OK
                       : complain(why, "--%s: the name is empty", row->name);
    case OPTION_PAGE:
        options->page = lecture_find(text[0] ? text : "1");
        return options->page ? STATUS_OK : refuse_value(row, 1, text, why);
    default:
        return apply_numbers(row, text, options, why);
    }
}

/* Whether the scene has what the row is about. */
static Status check_scene(const OptionRow *row, const Options *options,
                          const Complaint *why)
{
    const char *lacks = row->needs & NEEDS_MESH      ? "square"
                        : row->needs == NEEDS_TIME   ? "time steps"
                        : row->needs & NEEDS_TIME    ? "time"
                        : row->needs & NEEDS_SPRINGS ? "springs"
                        : row->needs & NEEDS_START   ? "start to choose"
                        : row->needs & NEEDS_BODY    ? "body that falls"
                                                     : "minimum to find";
    if (!row->needs || (row->needs & options->scene->needs))
        return STATUS_OK;
    return complain(why, "--%s: the scene '%s' has no %s", row->name,
                    options->scene->name, lacks);
}

/* What the body has is right with the integrator, where one was chosen. */
static Status check_integrator(const Options *options, const Complaint *why)
{
    const char *end = body_needs_end_of_step(options);
    const IntegratorMethod *method = options_integrator(options);
    if (!end || !method || method->at_end)
        return STATUS_OK;
    return complain(why,
                    "--integrator: '%s' has no %s; of all methods only "
                    "backward-euler has",
                    method->name, end);
}

Status options_set(Options *options, const char *name, const char *value,
                   char *message, size_t size)
{
    const Complaint why = {message, size};
    const OptionRow *row = option_find(name);
    if (!row || row->kind == OPTION_SWITCH)
        return complain(&why, "there is no option '%s' with a value",
                        typed(name).text);
    Status status = check_scene(row, options, &why);
    if (!status)
        status = apply(row, value, options, &why);
    return status ? status : check_integrator(options, &why);
}

/* ---- words -------------------------------------------------------------- */

/* A line while it is read: where, into what, and what the first look found. */
typedef struct Line {
    int argc, at;
    char **argv;
    Options *options;
    Complaint why;
    const char *list[OPTIONS_MOST]; /* values to be compared, or NULL */
    bool given[OPTIONS_MOST];       /* options that the line has */
} Line;

/* One word: an option with its value, or anything else. */
typedef struct Word {
    const OptionRow *row; /* NULL: no option */
    const char *text;     /* the option's value, or the word; NULL: the end */
} Word;

/* A line of our own, cut at its blanks as argv is. */
typedef struct Words {
    char text[512];
    char *argv[48];
    int argc;
} Words;

static void split_words(const char *line, Words *words)
{
    const int most = sizeof words->argv / sizeof *words->argv;
    char *rest = NULL, *word;
    snprintf(words->text, sizeof words->text, "elasto %s", line);
    words->argc = 0;
    for (char *text = words->text;
         words->argc < most && (word = strtok_r(text, " ", &rest)); text = NULL)
        words->argv[words->argc++] = word;
}

/* The row of "--name", "--name=value", of an abbreviation that only one option
 * has, or of a letter: "-h", as some programs have it "-H". */
static Status find_option(const char *word, Line *line, const OptionRow **found)
{
    Text list = {""}, shown = typed(word);
    int matches = 0;
    bool is_long = word[1] == '-';
    const char *name = word + 1 + is_long;
    size_t length = strcspn(name, "=");
    shown.text[strcspn(shown.text, "=")] = '\0';
    for (const OptionRow *row = option_rows; row->name && length > 0; row++) {
        if (is_long ? strncmp(row->name, name, length) != 0
                    : length > 1 || row->letter != tolower(name[0]))
            continue;
        *found = row;
        if (!is_long || row->name[length] == '\0')
            return STATUS_OK;
        add_name(&list, "--", row->name);
        matches++;
    }
    if (matches == 1)
        return STATUS_OK;
    if (matches > 1)
        return complain(&line->why, "%s can be %s: write a few letters more",
                        shown.text, list.text);
    return complain(
        &line->why, "no option %s; see elasto --help%s", shown.text,
        meant(shown.text + strspn(shown.text, "-"), "--", row_name).text);
}

/* Reads the next word. */
static Status next_word(Line *line, Word *word)
{
    const OptionRow *row = NULL;
    *word = (Word){NULL, line->at < line->argc ? line->argv[line->at++] : NULL};
    if (!word->text || word->text[0] != '-' || word->text[1] == '\0')
        return STATUS_OK;
    if (find_option(word->text, line, &row))
        return STATUS_INVALID_INPUT;
    const char *value = strchr(word->text, '=');
    const char *next = line->at < line->argc ? line->argv[line->at] : "--";
    bool alone = row->kind == OPTION_SWITCH;
    if (value && alone)
        return complain(&line->why, "%s: --%s takes no value",
                        typed(word->text).text, row->name);
    *word = (Word){row, value ? value + 1 : ""};
    if (value || alone || (row->kind == OPTION_PAGE && next[0] == '-'))
        return STATUS_OK;
    if (strncmp(next, "--", 2) == 0)
        return complain(&line->why, "--%s: the value is missing: --%s %s",
                        row->name, row->name, row->value);
    word->text = line->argv[line->at++];
    return STATUS_OK;
}

/* A scene by its name or its number in the list. */
static Status read_scene(const char *word, Line *line)
{
    if (line->options->scene)
        return complain(&line->why, "'%s': one scene at a time, please",
                        typed(word).text);
    line->options->scene = scene_find(word);
    if (line->options->scene)
        return STATUS_OK;
    return complain(&line->why, "there is no scene '%s'; see elasto --list%s",
                    typed(word).text, meant(word, "", scene_name).text);
}

/* First look: words that are wrong whatever they mean; the scene, or the page;
 * the lists.  Numbers begin as the slides', whatever is none as nothing. */
static Status read_line(Line *line)
{
    Word word;
    Options *options = line->options;
    *options = (Options){.panes = 1};
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->standard != 0)
            options->number[row->slot] = row->standard;
    Status status = STATUS_OK;
    while (!status && !(status = next_word(line, &word)) && word.text) {
        if (!word.row) {
            status = read_scene(word.text, line);
            continue;
        }
        int i = (int)(word.row - option_rows);
        bool list = word.row->label && strchr(word.text, ',');
        line->given[i] = true;
        line->list[i] = list ? word.text : NULL;
        if (word.row->kind == OPTION_PAGE)
            status = apply(word.row, word.text, options, &line->why);
    }
    if (!status && options->scene && options->page)
        return complain(&line->why,
                        "--lecture: its pages have scenes of their own, '%s' "
                        "cannot be asked for",
                        options->scene->name);
    if (!options->scene)
        options->scene = &scenes[0];
    return status;
}

/* A page has said what its scene needs, and beside a handout nothing has a
 * meaning. */
static Status check_given(const Line *line)
{
    const Options *options = line->options;
    bool handout = line->given[option_find("handout") - option_rows];
    for (const OptionRow *row = option_rows; row->name; row++) {
        if (!line->given[row - option_rows])
            continue;
        if (options->page && row->needs)
            return complain(&line->why,
                            "--%s: the lecture's pages say that themselves",
                            row->name);
        if (handout && strcmp(row->name, "handout") != 0)
            return complain(&line->why,
                            "--handout: the program writes the file and ends, "
                            "--%s says nothing there",
                            row->name);
    }
    return STATUS_OK;
}

/* What the values stand on: the page, or the scene's own numbers. */
static Status begin_options(Line *line)
{
    Options *options = line->options;
    const Scene *scene = options->scene;
    Words words;
    Word word;
    if (options->page)
        return lecture_options(options->page, options, line->why.text,
                               line->why.size);
    split_words(scene->line ? scene->line : "", &words);
    Line own = {words.argc, 1, words.argv, options, line->why, {0}, {0}};
    Status status = STATUS_OK;
    while (!status && !(status = next_word(&own, &word)) && word.text)
        status = apply(word.row, word.text, options, &own.why);
    options->pin = scene->pin;
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->times && line->given[row - option_rows])
            options->number[row->counter] = 0;
    return status;
}

/* Which value of each list this pane has; the last list changes fastest. */
static Status choose_values(Line *line, int pane, int *chosen)
{
    for (int i = OPTIONS_MOST - 1; i >= 0; i--) {
        int count = 1;
        for (const char *at = line->list[i]; at && *at; at++)
            count += *at == ',';
        chosen[i] = pane % count;
        pane /= count;
        line->options->panes *= count;
        if (line->options->panes > OPTIONS_MAX_PANES)
            return complain(&line->why,
                            "--%s: '%s' makes more than %d side by side",
                            option_rows[i].name, typed(line->list[i]).text,
                            OPTIONS_MAX_PANES);
    }
    return STATUS_OK;
}

/* Value number i of a list, or the last; at most 63 letters of it. */
static Text list_value(const char *list, int i)
{
    Text value;
    for (; i > 0 && strchr(list, ','); i--)
        list = strchr(list, ',') + 1;
    snprintf(value.text, 64, "%.*s", (int)strcspn(list, ","), list);
    return value;
}

/* Second look: the values. */
static Status apply_line(Line *line, int pane)
{
    Word word;
    Text value;
    int chosen[OPTIONS_MOST];
    Status status = choose_values(line, pane, chosen);
    if (!status)
        status = check_given(line);
    if (!status)
        status = begin_options(line);
    line->at = 1;
    while (!status && !(status = next_word(line, &word)) && word.text) {
        if (!word.row)
            continue;
        int i = (int)(word.row - option_rows);
        value = list_value(word.text, chosen[i]);
        status = check_scene(word.row, line->options, &line->why);
        if (!status)
            status = apply(word.row, line->list[i] ? value.text : word.text,
                           line->options, &line->why);
    }
    return status;
}

/* What depends on several options: which nodes there are to be pinned, what
 * says something about what is not there, the projection, unless it was chosen,
 * and where the body begins. */
static Status check_body(Line *line)
{
    Options *options = line->options;
    const SquareMesh shape = body_shape(options);
    if (!(options->scene->needs & NEEDS_BODY))
        return STATUS_OK;
    if (options->pin && pins_read(options->pin, &shape, NULL))
        return complain(&line->why,
                        "--pin: '%s' is no list of node numbers from 0 to %d, "
                        "or of: " PINS_WORDS,
                        typed(options->pin).text, shape.nodes - 1);
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->idle && line->given[row - option_rows] && row->idle(options))
            return complain(&line->why, "--%s: %s", row->name,
                            row->idle(options));
    if (check_integrator(options, &line->why))
        return STATUS_INVALID_INPUT;
    if (options->cells && !line->given[option_find("filter") - option_rows])
        options->filter = FILTER_ON_DEMAND;
    return body_check(options, line->why.text, line->why.size);
}

Status options_parse(int argc, char **argv, int pane, Options *options,
                     char *message, size_t size)
{
    Line line = {argc, 1, argv, options, {message, size}, {0}, {0}};
    Status status = read_line(&line);
    if (!status)
        status = apply_line(&line, pane);
    return status ? status : check_body(&line);
}

Status options_of_line(const char *line, Options *options, char *message,
                       size_t size)
{
    Words words;
    split_words(line, &words);
    return options_parse(words.argc, words.argv, 0, options, message, size);
}
