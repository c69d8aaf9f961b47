/* command_line.c - the command line: its values, its words, and what to say
 * where one of them cannot be read; and its help.
 */
#include "lesson/command_line.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "run/body.h"
#include "run/one_line.h"
#include "lesson/pages.h"
#include "scenes/scenes.h"

/* ---- short texts -------------------------------------------------------- */

/* Something short to be printed inside a line. */
typedef struct Text {
    char text[256];
} Text;

/* "clamp, none" */
static Text list_text(Names names)
{
    Text list = {""};
    const char *name;
    for (int i = 0; (name = name_at(names, i)); i++)
        append(list.text, sizeof list.text, "%s%s", i > 0 ? ", " : "", name);
    return list;
}

/* Whether two letters are one for somebody who types: large or small, '_' or
 * '-'. */
static bool alike(char typed, char letter)
{
    return tolower((unsigned char)typed) == tolower((unsigned char)letter) ||
           (typed == '_' && letter == '-');
}

enum { NAME_LETTERS = 24 }; /* of a name, and of what is taken for one */

/* Mistakes that turn the beginning of a name, or all of it, into a text of at
 * most NAME_LETTERS: each a letter too many, too few, another one, or two that
 * changed places (Damerau 1964).  The name may go on: who types "seg" means
 * segments. */
static int count_mistakes(const char *text, const char *name)
{
    int least[NAME_LETTERS + 1][NAME_LETTERS + 1]; /* from j letters to i */
    int rows = (int)strlen(text), columns = (int)strnlen(name, NAME_LETTERS);
    for (int i = 0; i <= rows; i++)
        for (int j = 0; j <= columns; j++) {
            least[i][j] = i + j;
            if (i == 0 || j == 0)
                continue;
            bool same = alike(text[i - 1], name[j - 1]);
            bool turned = i > 1 && j > 1 && alike(text[i - 1], name[j - 2]) &&
                          alike(text[i - 2], name[j - 1]);
            double best = fmin(least[i - 1][j], least[i][j - 1]) + 1;
            best = fmin(best, least[i - 1][j - 1] + !same);
            best = turned ? fmin(best, least[i - 2][j - 2] + 1) : best;
            least[i][j] = (int)best;
        }
    int best = rows;
    for (int j = 0; j <= columns; j++)
        best = least[rows][j] < best ? least[rows][j] : best;
    return best;
}

/* "; did you mean --timestep?"  The name that fewest mistakes lead to, one in
 * three letters at most, two in five; "" where there is none. */
static Text meant(const char *text, const char *before, Names names)
{
    Text hint = {""};
    const char *name;
    int letters = (int)strlen(text);
    int fewest = letters > 2 ? (letters + 1) / 3 + 1 : 1;
    bool looks_like_one = letters > 1 && letters <= NAME_LETTERS;
    for (int i = 0; looks_like_one && (name = name_at(names, i)); i++) {
        int mistakes = count_mistakes(text, name);
        if (name[0] && mistakes < fewest) {
            fewest = mistakes;
            snprintf(hint.text, sizeof hint.text, "; did you mean %s%s?",
                     before, name);
        }
    }
    return hint;
}

/* Of a value that is no option's. */
#define STANDS_ALONE "; a value stands right behind its option, without blanks"

/* The same for an option: also by its letter in formulas, or its name in
 * lecture.c. */
static Text meant_option(const char *text)
{
    static const char *const others[][2] = {{"h", "timestep"},
                                            {"dt", "timestep"},
                                            {"k", "stiffness"},
                                            {"rho", "density"},
                                            {"e", "young"},
                                            {"nu", "poisson"},
                                            {"mu", "friction"},
                                            {"eta", "damping"},
                                            {"g", "gravity"},
                                            {"method", "integrator"},
                                            {"n_seg", "segments"},
                                            {"side_len", "side"},
                                            {"initial_stretch", "stretch"}};
    Text hint;
    if (isdigit((unsigned char)text[0]))
        return (Text){STANDS_ALONE};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (strcasecmp(text, others[i][0]) == 0) {
            snprintf(hint.text, sizeof hint.text, "; did you mean --%s?",
                     others[i][1]);
            return hint;
        }
    return meant(text, "--", NAMES_OF(option_rows));
}

/* A word of a line: an option with its value, or the name of a scene. */
typedef struct Word {
    const OptionRow *row; /* NULL: a scene */
    const char *text;
    const char *list; /* of values, of which the text is one; or NULL */
    char picked[64];  /* the text, where there is a list */
} Word;

enum { WORDS_MOST = 256 };

/* A line while it is read: into what, who is told what is wrong, its words. */
typedef struct Line {
    Options *options;
    Refusal told;
    int words;
    Word word[WORDS_MOST];
} Line;

/* ---- what went ----------------------------------------------------------- */

/* An option of an earlier version, or one of its values, that is gone. */
typedef struct Gone {
    const char *option;
    const char *value;   /* "": the whole option is gone */
    const char *instead; /* what to use, as the end of a sentence */
} Gone;

/* A row stays for one release: who used the option is told what to use.  Then
 * the row goes, and the last one takes this table along. */
static const Gone gone[] = {
    {"vtk", "", "--states and --springs write each step as CSV"},
    {"integrator", "avf",
     "verlet, or midpoint with a small --tolerance, keeps the energy in the "
     "mean"},
    {"integrator", "avf4",
     "verlet, or midpoint with a small --tolerance, keeps the energy in the "
     "mean"},
    {"minimum", "", "a step may end on a saddle of E; nothing replaces it"},
    {NULL, NULL, NULL},
};

/* The row of an option and its value ("": of the option itself); NULL: there is
 * none. */
static const Gone *find_gone(const char *option, const char *value)
{
    for (const Gone *row = gone; row->option; row++)
        if (strcmp(row->option, option) == 0 && strcmp(row->value, value) == 0)
            return row;
    return NULL;
}

/* How many values a list has, with commas between them. */
static int count_parts(const char *list)
{
    int count = 1;
    for (; *list; list++)
        count += *list == ',';
    return count;
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

/* Whether a text is the row's unit, as the table or as the window writes it:
 * "J/m^2", "J/m\u00b2"; an angle has "deg", too. */
static bool is_unit(const OptionRow *row, const char *text)
{
    size_t length = strcspn(row->unit, " ");
    char shown[32];
    option_unit(row, shown, sizeof shown);
    return (strlen(text) == length && !strncmp(text, row->unit, length)) ||
           strcmp(text, shown) == 0 ||
           (strcmp(text, "deg") == 0 && strcmp(row->unit, "degrees") == 0);
}

/* What is meant by "1/60", "140%", "5 ms", as a number in the row's unit; NaN:
 * nobody knows. */
static double number_meant(const OptionRow *row, const char *text)
{
    static const struct {
        const char *sign;
        double over; /* parts of the unit */
    } prefixes[] = {{"", 1},    {"k", 1e-3},     {"c", 1e2},     {"m", 1e3},
                    {"u", 1e6}, {"\u00b5", 1e6}, {"\u03bc", 1e6}};
    double number, below = 1;
    const char *end = read_decimal(text, &number);
    if (end && *end == '/')
        end = read_decimal(end + 1, &below);
    if (!end)
        return NAN;
    end += strspn(end, " ");
    if (*end == '\0')
        return number / below;
    if (!row->unit[0])
        return strcmp(end, "%") == 0 ? number / 100 / below : NAN;
    for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++) {
        size_t length = strlen(prefixes[i].sign);
        if (strncmp(end, prefixes[i].sign, length) == 0 &&
            is_unit(row, end + length))
            return number / (below * prefixes[i].over);
    }
    return NAN;
}

/* Whether the row's range has this number; of names their places. */
static bool option_allows(const OptionRow *row, double number)
{
    if (row->kind == OPTION_NAME)
        return number >= 0 && number < names_count(row->names);
    return number >= row->low && number <= row->high &&
           (row->kind != OPTION_WHOLE || number == floor(number));
}

/* As many numbers as the row has, or fewer if it allows that, each in its
 * range; a single one may have a decimal comma.  number [count] out.  Returns
 * whether they can be read. */
static bool read_numbers(const OptionRow *row, int count, const char *text,
                         double *number)
{
    char copy[256], *at = copy, between = row->between ? row->between : ',';
    int given = 1;
    if (strlen(text) >= sizeof copy)
        return false;
    strcpy(copy, text);
    for (const char *next = text; (next = strchr(next, between)); next++)
        given++;
    if (given < count && row->fewer >> given & 1) {
        memcpy(number, row->rest, (size_t)count * sizeof *number);
        count = given;
    }
    for (int i = 0; i < count; i++) {
        char *next = strchr(at, i + 1 < count ? between : '\0');
        if (!next)
            return false;
        *next = '\0';
        for (char *comma; count == 1 && (comma = strchr(at, ','));)
            *comma = '.';
        number[i] = number_meant(row, at);
        if (!option_allows(row, number[i]))
            return false;
        at = next + 1;
    }
    return true;
}

bool option_read(const OptionRow *row, const char *text, double *value)
{
    if (row->kind != OPTION_NAME)
        return read_numbers(row, 1, text, value);
    int i = name_place(row->names, text);
    *value = i;
    return i >= 0;
}

/* "; '0,004' is a list of 2 values, the number 0.004 has a point": what is said
 * of commas where a number is refused. */
static Text hint_at_comma(const Line *line, const OptionRow *row, int count,
                          const char *text)
{
    Text hint = {""};
    char number[32];
    double value;
    for (int i = 0; i < line->words; i++) {
        const Word *word = &line->word[i];
        if (!word->list || word->text != text)
            continue;
        snprintf(hint.text, sizeof hint.text,
                 "; '%.60s' is a list of %d values", word->list,
                 count_parts(word->list));
        if (word->list[0] == ',' || !option_read(row, word->list, &value))
            continue;
        option_write(row, value, number, sizeof number);
        append(hint.text, sizeof hint.text, ", the number %s has a point",
               number);
    }
    if (count > 1 && count_parts(text) == 2 * count)
        return (Text){"; a number has a point, a comma ends it"};
    return hint;
}

/* "is none of: clamp, none", "is not X,Y, each from -1 to 1, in m" */
static Status refuse_value(const Line *line, const OptionRow *row, int count,
                           const char *text)
{
    if (row->kind == OPTION_PAGE)
        return refuse(line->told,
                      "--%s: '%.60s' is none of: the pages from 1 to %d, their "
                      "names%s",
                      row->name, text, lecture_count(),
                      meant(text, "", NAMES_OF(lecture_pages)).text);
    const Gone *went = find_gone(row->name, text);
    if (went)
        return refuse(line->told, "--%s: '%s' is gone: %s", row->name, text,
                      went->instead);
    if (row->kind == OPTION_NAME)
        return refuse(line->told, "--%s: '%.60s' is none of: %s%s", row->name,
                      text, list_text(row->names).text,
                      meant(text, "", row->names).text);
    return refuse(line->told, "--%s: '%.60s' is not %s%s from %g to %g%s%s%s",
                  row->name, text, count > 1 ? row->value : "",
                  count > 1                    ? ", each"
                  : row->kind == OPTION_NUMBER ? "a number"
                                               : "a whole number",
                  row->low, row->high, row->unit[0] ? ", in " : "", row->unit,
                  hint_at_comma(line, row, count, text).text);
}

/* A name, or numbers; where a scene is a curve, its start may be x alone. */
static Status apply_numbers(const Line *line, const OptionRow *row,
                            const char *text)
{
    enum { NUMBERS_MOST = 8 };
    Options *options = line->options;
    double number[NUMBERS_MOST] = {0}, *given = &options->number[row->counter];
    int most = row->count ? row->count : 1, used = 0;
    bool curve = options->scene->needs & NEEDS_ONE_NUMBER;
    bool short_form = row->needs == NEEDS_START && curve && !strchr(text, ',');
    int count = short_form ? 1 : most;
    if (row->kind == OPTION_NAME ? !option_read(row, text, number)
                                 : !read_numbers(row, count, text, number))
        return refuse_value(line, row, count, text);
    if (row->times && *given >= row->times)
        return refuse(line->told, "--%s: '%.60s' is one too many: at most %d",
                      row->name, text, row->times);
    if (row->times)
        used = (int)(*given)++;
    memcpy(&options->number[row->slot + used * most], number,
           (size_t)most * sizeof *number);
    return STATUS_OK;
}

/* How a file's name ends that promises another format than CSV; NULL: it does
 * not. */
static const char *other_format(const char *name)
{
    static const char *const ends[] = {
        ".npz",  ".npy", ".json", ".xml",  ".vtk",     ".vtu",
        ".pvd",  ".obj", ".gz",   ".xz",   ".zip",     ".xls",
        ".xlsx", ".ods", ".h5",   ".hdf5", ".parquet", ".feather",
        ".mat",  ".pkl", ".png",  ".html", ".db",      NULL};
    const char *end = strrchr(name, '.');
    int i = 0;
    while (end && ends[i] && strcasecmp(end, ends[i]) != 0)
        i++;
    return end ? ends[i] : NULL;
}

/* The name of a file or of nodes, into its field. */
static Status apply_text(const Line *line, const OptionRow *row,
                         const char *text)
{
    const char *other = row->table ? other_format(text) : NULL;
    if (!text[0])
        return refuse(line->told, "--%s: the name is empty", row->name);
    if (other)
        return refuse(line->told,
                      "--%s: '%.60s': tables are CSV, and %s promises another "
                      "format; use .csv",
                      row->name, text, other);
    memcpy((char *)line->options + row->offset, &text, sizeof text);
    return STATUS_OK;
}

/* What the option is followed by, into its field; nothing for a page is the
 * first. */
static Status apply(const Line *line, const OptionRow *row, const char *text)
{
    Options *options = line->options;
    switch (row->kind) {
    case OPTION_SWITCH:
        options->number[row->slot] = 1;
        return STATUS_OK;
    case OPTION_TEXT:
        return apply_text(line, row, text);
    case OPTION_PAGE:
        options->page = lecture_find(text[0] ? text : "1");
        return options->page ? STATUS_OK : refuse_value(line, row, 1, text);
    default:
        return apply_numbers(line, row, text);
    }
}

/* Whether the scene has what the row is about. */
static Status check_scene(const Line *line, const OptionRow *row)
{
    const Scene *scene = line->options->scene;
    const char *lacks = row->needs & NEEDS_MESH      ? "square"
                        : row->needs == NEEDS_TIME   ? "time steps"
                        : row->needs & NEEDS_TIME    ? "time"
                        : row->needs & NEEDS_SPRINGS ? "springs"
                        : row->needs & NEEDS_START   ? "start to choose"
                        : row->needs & NEEDS_BODY    ? "body that falls"
                                                     : "minimum to find";
    return !row->needs || (row->needs & scene->needs)
               ? STATUS_OK
               : refuse(line->told, "--%s: the scene '%s' has no %s", row->name,
                        scene->name, lacks);
}

/* What the body has is right with the integrator. */
static Status check_integrator(const Line *line)
{
    const char *end = body_needs_end_of_step(line->options);
    const IntegratorMethod *method = options_method(line->options);
    return !end || method->at_end
               ? STATUS_OK
               : refuse(line->told,
                        "--integrator: '%s' has no %s; of all methods only "
                        "backward-euler has",
                        method->name, end);
}

/* Whether the other options, and the body, can have the row's new value. */
static Status check_change(const Line *line, const OptionRow *row)
{
    const Options *options = line->options;
    bool begins = row->effect == EFFECT_START && (row->needs & NEEDS_SQUARE) &&
                  (options->scene->needs & NEEDS_BODY);
    Status status = check_integrator(line);
    return status || !begins ? status : body_check(options, line->told);
}

Status options_set(Options *options, const char *name, const char *value,
                   char *message, size_t size)
{
    const Line line = {.options = options, .told = {message, size}};
    const OptionRow *row = option_find(name);
    if (!row || row->kind == OPTION_SWITCH)
        return refuse(line.told, "there is no option '%.60s' with a value",
                      name);
    if (check_scene(&line, row) || apply(&line, row, value))
        return STATUS_INVALID_INPUT;
    return check_change(&line, row);
}

Status options_put(Options *options, const OptionRow *row, double value,
                   char *message, size_t size)
{
    const Line line = {.options = options, .told = {message, size}};
    char text[32] = "";
    if (row->kind == OPTION_NAME) /* the scene's own choice: the first */
        value = fmax(value, 0);
    if (check_scene(&line, row))
        return STATUS_INVALID_INPUT;
    if (row->count > 1 || !option_allows(row, value)) {
        if (!isnan(value))
            option_write(row, value, text, sizeof text);
        return refuse_value(&line, row, row->count, text);
    }
    options->number[row->slot] = value;
    return check_change(&line, row);
}

/* ---- words -------------------------------------------------------------- */

/* The row of "--name", "--name=value", or of a letter: "-h", as some programs
 * have it "-H".  NULL: there is none, and the line says so. */
static const OptionRow *find_option(const Line *line, const char *word)
{
    char name[64];
    int dashes = (int)strspn(word, "-"), length = (int)strcspn(word, "=");
    snprintf(name, sizeof name, "%.*s", length - dashes, word + dashes);
    const OptionRow *found = dashes == 2 ? option_find(name) : NULL;
    for (const OptionRow *row = option_rows; row->name; row++)
        if (dashes == 1 && !name[1] && row->letter == tolower(name[0]))
            found = row;
    const Gone *went = dashes == 2 ? find_gone(name, "") : NULL;
    if (went)
        refuse(line->told, "--%s is gone: %s", name, went->instead);
    else if (!found)
        refuse(line->told, "no option %.*s; see elasto --help%s",
               length < 60 ? length : 60, word, meant_option(name).text);
    return found;
}

static Status read_words(int argc, char **argv, Line *line)
{
    for (int i = 1; i < argc;) {
        const char *text = argv[i++], *equals = strchr(text, '=');
        const char *next = i < argc ? argv[i] : "--";
        Word word = {NULL, text, NULL, ""};
        if (line->words == WORDS_MOST)
            return refuse(line->told, "'%.60s': more than %d words", text,
                          WORDS_MOST);
        if (text[0] == '-' && text[1]) {
            const OptionRow *row = word.row = find_option(line, text);
            if (!row)
                return STATUS_INVALID_INPUT;
            bool alone = row->kind == OPTION_SWITCH;
            bool bare = row->kind == OPTION_PAGE && next[0] == '-';
            bool follows = !equals && !alone && !bare;
            if (equals && alone)
                return refuse(line->told, "%s: --%s takes no value", text,
                              row->name);
            if (follows && strncmp(next, "--", 2) == 0)
                return refuse(line->told, "--%s: the value is missing: --%s %s",
                              row->name, row->name, row->value);
            word.text = equals ? equals + 1 : follows ? next : "";
            i += follows;
        }
        line->word[line->words++] = word;
    }
    return STATUS_OK;
}

/* The words of a line of our own, cut at its blanks.
 *   copy  [size] out, the texts of the words */
static Status split_words(const char *text, char *copy, size_t size, Line *line)
{
    char *argv[48] = {""}, *rest = NULL, *word;
    const int most = sizeof argv / sizeof *argv;
    int argc = 1;
    snprintf(copy, size, "%s", text ? text : "");
    for (; argc < most && (word = strtok_r(copy, " ", &rest)); copy = NULL)
        argv[argc++] = word;
    return read_words(argc, argv, line);
}

/* The last word about an option, or NULL. */
static Word *given(Line *line, const OptionRow *row)
{
    for (int i = line->words - 1; i >= 0; i--)
        if (line->word[i].row == row)
            return &line->word[i];
    return NULL;
}

/* A word that is no scene: perhaps it is an option without its dashes or with
 * those that editors make of them, or a part of a value with a blank in it. */
static Status refuse_scene(const Line *line, const char *text)
{
    Text hint = meant(text, "", NAMES_OF(scenes));
    if (option_find(text))
        snprintf(hint.text, sizeof hint.text, "; did you mean --%s?", text);
    else if (strncmp(text, "\u2013", 2) == 0) /* U+2000 and what follows */
        hint = (Text){"; an option begins with two signs '-'"};
    else if (text[strspn(text, "+.")] == '%' ||
             isdigit((unsigned char)text[strspn(text, "+.")]))
        hint = (Text){STANDS_ALONE};
    return refuse(line->told, "there is no scene '%.60s'; see elasto --list%s",
                  text, hint.text);
}

/* The scene, by its name or its number in the list, or the page, and what
 * cannot be said in one line whatever they are: of two files only one would be
 * written. */
static Status check_words(Line *line)
{
    Options *options = line->options;
    for (int i = 0; i < line->words; i++) {
        const Word *word = &line->word[i], *last = given(line, word->row);
        const OptionRow *row = word->row;
        if (row && row->kind == OPTION_TEXT && last != word)
            return refuse(line->told,
                          "--%s: '%.60s' and '%.60s': one at a time, please",
                          row->name, word->text, last->text);
        if (row && row->kind == OPTION_PAGE && apply(line, row, word->text))
            return STATUS_INVALID_INPUT;
        if (!row && options->scene)
            return refuse(line->told, "'%.60s': one scene at a time, please",
                          word->text);
        if (!row && !(options->scene = scene_find(word->text)))
            return refuse_scene(line, word->text);
    }
    if (options->scene && options->page)
        return refuse(line->told,
                      "--lecture: its pages have scenes of their own, '%s' "
                      "cannot be asked for",
                      options->scene->name);
    if (!options->scene)
        options->scene = &scenes[0];
    return STATUS_OK;
}

/* What the values stand on: the slides' numbers and nothing of the rest; of
 * these, the scene's own, or the page. */
static Status begin_options(Line *line)
{
    Options *options = line->options;
    char copy[512];
    Line own = {options, line->told, 0, {{0}}};
    if (options->page)
        return lecture_options(options->page, options, line->told.message,
                               line->told.size);
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->standard != 0)
            options->number[row->slot] = row->standard;
    Status status = split_words(options->scene->line, copy, sizeof copy, &own);
    for (int i = 0; i < own.words && !status; i++)
        status = apply(&own, own.word[i].row, own.word[i].text);
    if (!given(line, option_find("body"))) /* they are of the scene's own */
        options->pin = options->scene->pin;
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->times && given(line, row))
            options->number[row->counter] = 0;
    return status;
}

/* Of each list of values the one that this pane has; the last list changes
 * fastest. */
static Status pick_values(Line *line, int pane)
{
    bool drawn = !given(line, option_find("headless")) ||
                 given(line, option_find("frames")) ||
                 given(line, option_find("film"));
    int most = drawn ? OPTIONS_MAX_DRAWN : OPTIONS_MAX_PANES;
    for (int i = names_count(NAMES_OF(option_rows)) - 1; i >= 0; i--) {
        const OptionRow *row = &option_rows[i];
        Word *word = given(line, row);
        const char *text = word ? word->text : "";
        int count = count_parts(text);
        if (!row->label || count == 1)
            continue;
        line->options->panes *= count;
        if (line->options->panes > most)
            return refuse(line->told,
                          "--%s: '%.60s' makes more than %d side by side%s",
                          row->name, text, most,
                          drawn ? "; --headless, where nothing is drawn, takes "
                                  "more"
                                : "");
        word->list = text;
        for (int k = pane % count; k > 0; k--)
            text = strchr(text, ',') + 1;
        snprintf(word->picked, sizeof word->picked, "%.*s",
                 (int)strcspn(text, ","), text);
        word->text = word->picked;
        pane /= count;
    }
    return STATUS_OK;
}

/* Each part of a list of nodes is a node or names some. */
static Status check_pins(const Line *line, const SquareMesh *shape)
{
    char part[64];
    const char *at = line->options->pin;
    for (size_t length; at; at = at[length] ? at + length + 1 : NULL) {
        length = strcspn(at, ",");
        snprintf(part, sizeof part, "%.*s", (int)length, at);
        if (pins_read(part, shape, NULL))
            return refuse(
                line->told,
                "--pin: '%s' is no node from 0 to %d, and none of: " PINS_WORDS,
                part, shape->nodes - 1);
    }
    return STATUS_OK;
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
    if (check_pins(line, &shape))
        return STATUS_INVALID_INPUT;
    if (options->bodies > 1 && !given(line, option_find("self-contact")))
        options->self_contact = 1;
    for (int i = 0; i < line->words; i++) {
        const OptionRow *row = line->word[i].row;
        if (row && row->idle && row->idle(options))
            return refuse(line->told, "--%s: %s", row->name,
                          row->idle(options));
    }
    if (check_integrator(line))
        return STATUS_INVALID_INPUT;
    if (options->material != 0)
        options->cells = 0; /* triangles keep their sides anyway */
    if (options->material != 0 &&
        (options->yield > 0 || options->tear > 0 || options->damping > 0))
        return refuse(line->told,
                      "--material: the scene '%s' is about springs; triangles "
                      "do not flow or tear, and are not damped",
                      options->scene->name);
    if ((options->cells || options->material != 0 || options->self_contact) &&
        !given(line, option_find("projection")))
        options->projection = PROJECTION_ON_DEMAND;
    return body_check(options, line->told);
}

/* Without a window, and without a script that could change something later,
 * what would have no effect is refused. */
static Status check_headless(Line *line)
{
    static const char *const minimising[] = {"tolerance", "solver",
                                             "projection", "line-search", NULL};
    const Options *options = line->options;
    const IntegratorMethod *method = options_method(options);
    const Word *chosen = given(line, option_find("integrator"));
    bool explicit = chosen && !chosen->list && !method->implicit;
    if (options->headless && options->fullscreen)
        return refuse(line->told, "--fullscreen: with --headless there is no "
                                  "window");
    if (!options->headless || options->script)
        return STATUS_OK;
    if (options->paused)
        return refuse(line->told,
                      "--paused: with --headless nobody could go on, and no "
                      "step would be made; --steps 0 is the start alone");
    if (options->speed > 1)
        return refuse(line->told, "--speed: with --headless each step is a "
                                  "frame; below 1 a film is slower");
    if (given(line, option_find("size")) && !options->frames && !options->film)
        return refuse(line->told, "--size: with --headless only --frames and "
                                  "--film are drawn");
    for (int i = 0; explicit && minimising[i]; i++)
        if (given(line, option_find(minimising[i])))
            return refuse(line->told,
                          "--%s: '%s' minimises nothing, of all methods only "
                          "implicit ones do",
                          minimising[i], method->name);
    return STATUS_OK;
}

/* The words that were read, into the options. */
static Status apply_words(Line *line, int pane)
{
    *line->options = (Options){.panes = 1};
    if (check_words(line) || begin_options(line) || pick_values(line, pane))
        return STATUS_INVALID_INPUT;
    for (int i = 0; i < line->words; i++) {
        const OptionRow *row = line->word[i].row;
        if (row && line->options->page && row->needs)
            return refuse(line->told,
                          "--%s: the lecture's pages say that themselves",
                          row->name);
        if (row &&
            (check_scene(line, row) || apply(line, row, line->word[i].text)))
            return STATUS_INVALID_INPUT;
    }
    return check_headless(line) ? STATUS_INVALID_INPUT : check_body(line);
}

Status options_parse(int argc, char **argv, int pane, Options *options,
                     char *message, size_t size)
{
    Line line = {options, {message, size}, 0, {{0}}};
    Status status = read_words(argc, argv, &line);
    return status ? status : apply_words(&line, pane);
}

Status options_of_line(const char *text, Options *options, char *message,
                       size_t size)
{
    char copy[512];
    Line line = {options, {message, size}, 0, {{0}}};
    Status status = split_words(text, copy, sizeof copy, &line);
    return status ? status : apply_words(&line, 0);
}

/* ---- the lecture's pages ------------------------------------------------- */

int lecture_count(void)
{
    return names_count(NAMES_OF(lecture_pages));
}

const LecturePage *lecture_find(const char *text)
{
    int place = name_or_number(NAMES_OF(lecture_pages), text);
    return place < 0 ? NULL : &lecture_pages[place];
}

bool page_wants_click(const LecturePage *page)
{
    return page && page->answer && strcmp(page->answer, "click") == 0;
}

void lecture_enter(const LecturePage *page, Options *options)
{
    options->page = page;
    options->layers = page->layers;
    options->next = page->next;
    options->pause = page->pause;
    options->law = page->law;
    options->star = page->star;
}

Status lecture_options(const LecturePage *page, Options *options, char *message,
                       size_t size)
{
    Status status = options_of_line(page->line, options, message, size);
    const char *pin = strstr(page->line, "--pin ");
    if (pin) /* the line's last option: its text stays */
        options->pin = pin + strlen("--pin ");
    lecture_enter(page, options);
    options->flips = page->flips;
    options->speed = page->speed;
    return status;
}

/* ---- help --------------------------------------------------------------- */

enum { HELP_COLUMNS = 80, HELP_INDENT = 21 };

/* A line that begins with `start`; words stand from the column of the texts on,
 * in more lines where they do not fit. */
static void help_line(FILE *help, const char *start, const char *words)
{
    int column = fprintf(help, "%s", start);
    for (words += strspn(words, " "); *words; words += strspn(words, " ")) {
        int length = (int)strcspn(words, " ");
        if (column + 1 + length > HELP_COLUMNS) {
            fputc('\n', help);
            column = 0;
        }
        int blanks = column < HELP_INDENT ? HELP_INDENT - column : 0;
        column += fprintf(help, "%*s %.*s", blanks, "", length, words);
        words += length;
    }
    fputc('\n', help);
}

/* The scenes with their numbers, a line each; of an option its name, what it
 * is, unit, names or range, default. */
void options_help(FILE *help)
{
    fprintf(help, "usage: elasto [SCENE] [options]; SCENE is a name or a "
                  "number, else square\nscenes:\n");
    for (int i = 0; scenes[i].name; i++)
        fprintf(help, "  %2d %-15s  %s\n", i + 1, scenes[i].name,
                scenes[i].sentence);
    for (const OptionRow *row = option_rows; row->name; row++) {
        Text start, range = {""}, standard = {""};
        char words[3 * sizeof(Text)];
        if (!row->name[0]) {
            help_line(help, row->help, "");
            continue;
        }
        snprintf(start.text, sizeof start.text, "  --%s%s%s%s%.1s", row->name,
                 row->value ? " " : "", row->value ? row->value : "",
                 row->letter ? ", -" : "", &row->letter);
        bool named = row->kind == OPTION_NAME;
        if (named)
            range = list_text(row->names);
        if (row->kind == OPTION_WHOLE && row->high <= 4096)
            snprintf(range.text, sizeof range.text, "%g ... %g", row->low,
                     row->high);
        if (row->high > row->low && !row->count && row->standard >= row->low)
            snprintf(standard.text, sizeof standard.text, "[%g]",
                     row->standard);
        snprintf(words, sizeof words, "%s%s%s %s %s", row->help,
                 named && row->help[0] ? ":"
                 : row->unit[0]        ? ", "
                                       : "",
                 row->unit, range.text, standard.text);
        help_line(help, start.text, words);
    }
}
