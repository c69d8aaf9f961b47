/* command_line.c - reads values and lines of options, says what is wrong with
 * them, and writes --help.
 */
#include "lesson/command_line.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "run/body.h"
#include "lesson/pages.h"
#include "scenes/scenes.h"

/* ---- short texts -------------------------------------------------------- */

/* A short text, returned by value. */
typedef struct Text {
    char text[256];
} Text;

/* The names of a list: "clamp, none". */
static Text list_text(Names names)
{
    Text list = {""};
    const char *name;
    for (int i = 0; (name = name_at(names, i)); i++)
        append(list.text, sizeof list.text, "%s%s", i > 0 ? ", " : "", name);
    return list;
}

/* Whether a typed letter stands for a letter of a name: case is ignored, and
 * '_' stands for '-'. */
static bool letters_match(char typed, char letter)
{
    return tolower((unsigned char)typed) == tolower((unsigned char)letter) ||
           (typed == '_' && letter == '-');
}

/* Letters that are compared at most. */
enum { NAME_LETTERS = 24 };

/* Number of typing mistakes (Damerau 1964) between a text, of at most
 * NAME_LETTERS, and a name or the beginning of one, so that "seg" fits
 * segments.  A mistake is a letter too many, too few, another letter, or two
 * letters exchanged. */
static int count_mistakes(const char *text, const char *name)
{
    /* [i][j]: mistakes between i letters of the text and j of the name */
    int least[NAME_LETTERS + 1][NAME_LETTERS + 1];
    int rows = (int)strlen(text), columns = (int)strnlen(name, NAME_LETTERS);
    for (int i = 0; i <= rows; i++)
        for (int j = 0; j <= columns; j++) {
            least[i][j] = i + j;
            if (i == 0 || j == 0)
                continue;
            bool same = letters_match(text[i - 1], name[j - 1]);
            bool turned = i > 1 && j > 1 &&
                          letters_match(text[i - 1], name[j - 2]) &&
                          letters_match(text[i - 2], name[j - 1]);
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

/* A hint such as "; did you mean --timestep?".
 *   before  in, dashes to write before the name */
static Text suggest(const char *before, const char *name)
{
    Text hint;
    snprintf(hint.text, sizeof hint.text, "; did you mean %s%s?", before, name);
    return hint;
}

/* A word of another program or of a book, and the name that it has here. */
typedef struct Synonym {
    const char *word, *name; /* NULL ends a table */
} Synonym;

/* Returns the name for a word, or NULL. */
static const char *find_synonym(const Synonym *row, const char *word)
{
    while (row->word && strcasecmp(word, row->word) != 0)
        row++;
    return row->name;
}

/* Suggests the nearest name of the table, or returns "" if no name is near.  A
 * text of 3 to 4 letters may have one mistake, of 5 to 7 two. */
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
            hint = suggest(before, name);
        }
    }
    return hint;
}

/* The hint for an option, which may also be named by its letter in formulas or
 * by its name in lecture.c. */
static Text meant_option(const char *text)
{
    static const Synonym others[] = {{"h", "timestep"},
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
                                     {"initial_stretch", "stretch"},
                                     {NULL, NULL}};
    const char *name = find_synonym(others, text);
    return name ? suggest("--", name)
                : meant(text, "--", NAMES_OF(option_rows));
}

/* A word of a line: an option with its value, or the name of a scene. */
typedef struct Word {
    const OptionRow *row; /* option; NULL: the word is a scene */
    const char *text;     /* value, or name of the scene */
    const char *list;     /* list of values that has the text, or NULL */
    char picked[64];      /* the text, if there is a list */
} Word;

enum { WORDS_MOST = 256 };

/* A line while it is read. */
typedef struct Line {
    Options *options; /* out */
    Message message;  /* message about the first mistake */
    int words;
    Word word[WORDS_MOST];
} Line;

/* ---- removed options ------------------------------------------------------
 */

/* An option, or a value of one, that an earlier version had. */
typedef struct Gone {
    const char *option;
    const char *value;   /* the removed value; "": the whole option */
    const char *instead; /* end of the sentence: what to use now */
} Gone;

/* A row stays here for one release, so that users learn what to use; the last
 * row takes the table with it. */
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

/* The row of a removed value, or with "" of a removed option; NULL: no row. */
static const Gone *find_gone(const char *option, const char *value)
{
    for (const Gone *row = gone; row->option; row++)
        if (strcmp(row->option, option) == 0 && strcmp(row->value, value) == 0)
            return row;
    return NULL;
}

/* Number of values in a list with commas. */
static int count_parts(const char *list)
{
    int count = 1;
    for (; *list; list++)
        count += *list == ',';
    return count;
}

/* ---- values ------------------------------------------------------------- */

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

/* Whether a text is the row's unit, written "J/m^2" or "J/m\u00b2"; for angles
 * also "deg". */
static bool is_unit(const OptionRow *row, const char *text)
{
    size_t length = strcspn(row->unit, " ");
    char shown[32];
    option_unit(row, shown, sizeof shown);
    return (strlen(text) == length && !strncmp(text, row->unit, length)) ||
           strcmp(text, shown) == 0 ||
           (strcmp(text, "deg") == 0 && strcmp(row->unit, "degrees") == 0);
}

/* The number in the row's unit that "1/60", "140%" or "5 ms" means; NaN: the
 * text is no such number. */
static double number_meant(const OptionRow *row, const char *text)
{
    static const struct {
        const char *sign;
        double over; /* parts of the unit: 1000 for "m" */
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

/* Whether a number is in the row's range; the number of a name is its index. */
static bool option_allows(const OptionRow *row, double number)
{
    if (row->kind == OPTION_NAME)
        return number >= 0 && number < names_count(row->names);
    return number >= row->low && number <= row->high &&
           (row->kind != OPTION_WHOLE || number == floor(number));
}

/* Reads the numbers of a value, each in the row's range.  Fewer numbers are
 * accepted if the row says so; a single number may have a decimal comma.
 *   number  [count] out
 * Returns whether the text could be read. */
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

/* A hint about commas in a refused number: "; '0,004' is a list of 2 values,
 * the number 0.004 has a point". */
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

/* The value that other programs and books call `text`: a hint, or "". */
static Text meant_value(const OptionRow *row, const char *text)
{
    static const Synonym others[] = {
        {"euler", "backward-euler"},
        {"implicit-euler", "backward-euler"},
        {"explicit-euler", "forward-euler"},
        {"semi-implicit-euler", "symplectic-euler"},
        {"leapfrog", "verlet"},
        {"velocity-verlet", "verlet"},
        {"cholesky", "newton"},
        {"cholmod", "newton"},
        {"armijo", "backtrack"},
        {"on", "backtrack"},
        {"off", "none"},
        {"psd", "clamp"},
        {"true", "on"},
        {"yes", "on"},
        {"false", "off"},
        {"no", "off"},
        {"triangles", "neo-hookean"},
        {"solid", "neo-hookean"},
        {"rubber", "neo-hookean"},
        {NULL, NULL}};
    const char *name = find_synonym(others, text);
    return name && name_place(row->names, name) >= 0
               ? suggest("", name)
               : meant(text, "", row->names);
}

/* Refuses a value with a message such as "is not X,Y, each from -1 to 1, in m".
 */
static Status refuse_value(const Line *line, const OptionRow *row, int count,
                           const char *text)
{
    if (row->kind == OPTION_PAGE)
        return refuse(line->message,
                      "--%s: there is no page '%.60s'%s; pages are 1 to %d, or "
                      "names: elasto --lecture --list",
                      row->name, text,
                      meant(text, "", NAMES_OF(lecture_pages)).text,
                      lecture_count());
    const Gone *went = find_gone(row->name, text);
    if (went)
        return refuse(line->message, "--%s: '%s' is gone: %s", row->name, text,
                      went->instead);
    if (row->kind == OPTION_NAME)
        return refuse(line->message, "--%s: '%.60s' is none of: %s%s",
                      row->name, text, list_text(row->names).text,
                      meant_value(row, text).text);
    return refuse(line->message,
                  "--%s: '%.60s' is not %s%s from %g to %g%s%s%s", row->name,
                  text, count > 1 ? row->value : "",
                  count > 1                    ? ", each"
                  : row->kind == OPTION_NUMBER ? "a number"
                                               : "a whole number",
                  row->low, row->high, row->unit[0] ? ", in " : "", row->unit,
                  hint_at_comma(line, row, count, text).text);
}

/* Puts the value of an option with a name or numbers into the options.  In
 * scenes with one coordinate the start may be x alone. */
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
        return refuse(line->message,
                      "--%s: '%.60s' is one too many; at most %d are possible",
                      row->name, text, row->times);
    if (row->times)
        used = (int)(*given)++;
    memcpy(&options->number[row->slot + used * most], number,
           (size_t)most * sizeof *number);
    return STATUS_OK;
}

/* The end of a file's name if it stands for another format than CSV, or NULL.
 */
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

/* Puts the name of a file, or of nodes, into the options. */
static Status apply_text(const Line *line, const OptionRow *row,
                         const char *text)
{
    const char *other = row->table ? other_format(text) : NULL;
    if (!text[0])
        return refuse(line->message, "--%s: the value is empty: --%s %s",
                      row->name, row->name, row->value);
    if (other)
        return refuse(line->message,
                      "--%s: '%.60s': tables are CSV, but %s is another "
                      "format; use .csv",
                      row->name, text, other);
    memcpy((char *)line->options + row->offset, &text, sizeof text);
    return STATUS_OK;
}

/* Puts the value of an option into the options.  --lecture without a page is
 * the first page. */
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

/* Checks that the scene has what the option is about. */
static Status check_scene(const Line *line, const OptionRow *row)
{
    const Scene *scene = line->options->scene;
    const char *lacks = row->needs & NEEDS_MESH      ? "square"
                        : row->needs == NEEDS_TIME   ? "time steps"
                        : row->needs & NEEDS_TIME    ? "time step to choose"
                        : row->needs & NEEDS_SPRINGS ? "springs"
                        : row->needs & NEEDS_START   ? "start to choose"
                        : row->needs & NEEDS_BODY    ? "body that falls"
                                                     : "minimum to find";
    return !row->needs || (row->needs & scene->needs)
               ? STATUS_OK
               : refuse(line->message, "--%s: the scene '%s' has no %s",
                        row->name, scene->name, lacks);
}

/* Checks that the integrator can do what the body asks for. */
static Status check_integrator(const Line *line)
{
    const char *end = body_needs_end_of_step(line->options);
    const IntegratorMethod *method = options_method(line->options);
    return !end || method->at_end
               ? STATUS_OK
               : refuse(line->message,
                        "--integrator: '%s' has no %s; only backward-euler has",
                        method->name, end);
}

/* Whether the other options, and the body, can have the row's new value. */
static Status check_change(const Line *line, const OptionRow *row)
{
    const Options *options = line->options;
    bool begins = row->effect == EFFECT_START && (row->needs & NEEDS_SQUARE) &&
                  (options->scene->needs & NEEDS_BODY);
    Status status = check_integrator(line);
    return status || !begins ? status : body_check(options, line->message);
}

Status options_set(Options *options, const char *name, const char *value,
                   Message message)
{
    const Line line = {.options = options, .message = message};
    const OptionRow *row = option_find(name);
    if (!row || row->kind == OPTION_SWITCH)
        return refuse(line.message,
                      "there is no option '%.60s' that has a value", name);
    if (check_scene(&line, row) || apply(&line, row, value))
        return STATUS_INVALID_INPUT;
    return check_change(&line, row);
}

Status options_put(Options *options, const OptionRow *row, double value,
                   Message message)
{
    const Line line = {.options = options, .message = message};
    char text[32] = "";
    if (row->kind == OPTION_NAME) /* -1, the scene's own choice: the first */
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

/* A hint if a text behind a word may be a part of its value, as in "4 ms" and
 * "1, 2": values have no blanks.  "" otherwise.
 *   before  in, or NULL */
static Text hint_at_blank(const Word *before, const char *text)
{
    Text hint = {""};
    const OptionRow *row = before ? before->row : NULL;
    if (row && row->value)
        snprintf(hint.text, sizeof hint.text,
                 "; a value has no blanks: --%s %s", row->name, row->value);
    else if (row && isdigit((unsigned char)text[0]))
        snprintf(hint.text, sizeof hint.text, "; --%s takes no value",
                 row->name);
    return hint;
}

/* Refuses a word before its '=', with a hint, or else with where to look. */
static Status refuse_unknown(const Line *line, const char *what,
                             const char *word, Text hint, const char *look)
{
    int length = (int)fmin(strcspn(word, "="), 60);
    return refuse(line->message, "%s '%.*s'%s", what, length, word,
                  hint.text[0] ? hint.text : look);
}

/* The row of "--name", "--name=value", or of a letter, "-h" or "-H".  NULL: the
 * word is refused. */
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
    const Word *before = line->words > 0 ? &line->word[line->words - 1] : NULL;
    if (went)
        refuse(line->message, "--%s is gone: %s", name, went->instead);
    else if (!found)
        refuse_unknown(line, "there is no option", word,
                       isdigit((unsigned char)name[0])
                           ? hint_at_blank(before, name)
                           : meant_option(name),
                       "; see elasto --help");
    return found;
}

static Status read_words(int argc, char **argv, Line *line)
{
    for (int i = 1; i < argc;) {
        const char *text = argv[i++], *equals = strchr(text, '=');
        const char *next = i < argc ? argv[i] : "--";
        Word word = {NULL, text, NULL, ""};
        if (line->words == WORDS_MOST)
            return refuse(line->message, "'%.60s': more than %d words", text,
                          WORDS_MOST);
        if (text[0] == '-' && text[1]) {
            const OptionRow *row = word.row = find_option(line, text);
            if (!row)
                return STATUS_INVALID_INPUT;
            bool alone = row->kind == OPTION_SWITCH;
            bool bare = row->kind == OPTION_PAGE && next[0] == '-';
            bool follows = !equals && !alone && !bare;
            if (equals && alone)
                return refuse(line->message, "%s: --%s takes no value", text,
                              row->name);
            if (follows && strncmp(next, "--", 2) == 0)
                return refuse(line->message,
                              "--%s: the value is missing: --%s %s", row->name,
                              row->name, row->value);
            word.text = equals ? equals + 1 : follows ? next : "";
            i += follows;
        }
        line->word[line->words++] = word;
    }
    return STATUS_OK;
}

/* Reads the words of a line without quotes, separated by blanks.
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

/* The last word about an option; NULL: the option is not given. */
static Word *given(Line *line, const OptionRow *row)
{
    for (int i = line->words - 1; i >= 0; i--)
        if (line->word[i].row == row)
            return &line->word[i];
    return NULL;
}

/* Refuses a word that is no scene.  The word may be an option without its
 * dashes, or with the dashes of an editor, or a part of a value. */
static Status refuse_scene(const Line *line, const Word *word)
{
    const char *text = word->text;
    char name[64];
    Text hint = meant(text, "", NAMES_OF(scenes));
    snprintf(name, sizeof name, "%.*s", (int)strcspn(text, "="), text);
    if (option_find(name))
        snprintf(hint.text, sizeof hint.text, "; did you mean --%s?", text);
    else if (strncmp(text, "\u2013", 2) == 0) /* U+2000 to U+203F */
        hint = (Text){"; an option begins with two signs '-'"};
    else if (!hint.text[0])
        hint = hint_at_blank(word > line->word ? word - 1 : NULL, text);
    return refuse_unknown(line, "there is no scene", text, hint,
                          "; see elasto --list");
}

/* Finds the scene or the page of a line, and refuses files, scenes or a page
 * that exclude each other. */
static Status check_words(Line *line)
{
    Options *options = line->options;
    for (int i = 0; i < line->words; i++) {
        const Word *word = &line->word[i], *last = given(line, word->row);
        const OptionRow *row = word->row;
        if (row && row->kind == OPTION_TEXT && last != word)
            return refuse(line->message,
                          "--%s: '%.60s' and '%.60s': only one can be given",
                          row->name, word->text, last->text);
        if (row && row->kind == OPTION_PAGE && apply(line, row, word->text))
            return STATUS_INVALID_INPUT;
        if (!row && options->scene)
            return refuse(line->message,
                          "'%.60s': only one scene can be given, and '%s' is "
                          "one%s",
                          word->text, options->scene->name,
                          hint_at_blank(word - 1, word->text).text);
        if (!row && !(options->scene = scene_find(word->text)))
            return refuse_scene(line, word);
    }
    if (options->scene && options->page)
        return refuse(line->message,
                      "--lecture: each page has its own scene; leave '%s' out",
                      options->scene->name);
    if (!options->scene)
        options->scene = &scenes[0];
    return STATUS_OK;
}

/* Fills the options with the defaults and with those of the scene or the page.
 */
static Status begin_options(Line *line)
{
    Options *options = line->options;
    char copy[512];
    Line own = {options, line->message, 0, {{0}}};
    if (options->page)
        return lecture_options(options->page, options, line->message);
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->standard != 0)
            options->number[row->slot] = row->standard;
    Status status = split_words(options->scene->line, copy, sizeof copy, &own);
    for (int i = 0; i < own.words && !status; i++)
        status = apply(&own, own.word[i].row, own.word[i].text);
    if (!given(line, option_find("body"))) /* pins of the scene's body */
        options->pin = options->scene->pin;
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->times && given(line, row))
            options->number[row->counter] = 0;
    return status;
}

/* Picks from each list of values the one of this pane; the last list changes
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
            return refuse(line->message,
                          "--%s: '%.60s' makes more than %d side by side%s",
                          row->name, text, most,
                          drawn ? "; with --headless, where nothing is drawn, "
                                  "64 are possible"
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

/* Checks the nodes of --pin. */
static Status check_pins(const Line *line, const SquareMesh *shape)
{
    char part[64];
    const char *at = line->options->pin;
    for (size_t length; at; at = at[length] ? at + length + 1 : NULL) {
        length = strcspn(at, ",");
        snprintf(part, sizeof part, "%.*s", (int)length, at);
        const char *colon = strchr(part, ':');
        if (pins_read(part, shape, NULL))
            return refuse(line->message,
                          "--pin: '%s' is no node from 0 to %d, and none "
                          "of: " PINS_WORDS "%s",
                          part, shape->nodes - 1,
                          colon && atoi(colon + 1) > shape->bodies
                              ? "; there are not so many bodies"
                              : "");
    }
    return STATUS_OK;
}

/* Refuses options that have no effect beside the others. */
static Status check_effects(Line *line)
{
    static const char *const minimising[] = {"tolerance", "solver",
                                             "projection", "line-search", NULL};
    Options *options = line->options;
    const IntegratorMethod *method = options_method(options);
    const Word *chosen = given(line, option_find("integrator"));
    bool fixed = options->headless &&
                 !options->script; /* nothing changes an option later */
    bool explicit = chosen && !chosen->list && !method->implicit;
    if (options->bodies > 1 && !given(line, option_find("self-contact")))
        options->self_contact = 1;
    for (int i = 0; i < line->words; i++) {
        const OptionRow *row = line->word[i].row;
        if (row && row->idle && row->idle(options))
            return refuse(line->message, "--%s: %s", row->name,
                          row->idle(options));
    }
    for (int i = 0; fixed && explicit && minimising[i]; i++)
        if (given(line, option_find(minimising[i])))
            return refuse(line->message,
                          "--%s: '%s' minimises nothing; choose an implicit "
                          "--integrator such as backward-euler",
                          minimising[i], method->name);
    return STATUS_OK;
}

/* Checks that the body can start; chooses cells and projection where they are
 * not given. */
static Status check_body(Line *line)
{
    Options *options = line->options;
    const SquareMesh shape = body_shape(options);
    if (!(options->scene->needs & NEEDS_BODY))
        return STATUS_OK;
    if (check_pins(line, &shape) || check_integrator(line))
        return STATUS_INVALID_INPUT;
    if (options->material != 0)
        options->cells = 0; /* triangles do not turn over anyway */
    if (options->material != 0 &&
        (options->yield > 0 || options->tear > 0 || options->damping > 0))
        return refuse(line->message,
                      "--material: the scene '%s' is about springs; triangles "
                      "do not yield or tear, and have no damping",
                      options->scene->name);
    if ((options->cells || options->material != 0 || options->self_contact) &&
        !given(line, option_find("projection")))
        options->projection = PROJECTION_ON_DEMAND;
    return body_check(options, line->message);
}

/* Puts the words of a line into the options of a pane. */
static Status apply_words(Line *line, int pane)
{
    *line->options = (Options){.panes = 1};
    if (check_words(line) || begin_options(line) || pick_values(line, pane))
        return STATUS_INVALID_INPUT;
    for (int i = 0; i < line->words; i++) {
        const OptionRow *row = line->word[i].row;
        if (row && line->options->page && row->needs)
            return refuse(line->message,
                          "--%s: a page of --lecture has its own value; change "
                          "it in the window, or leave --lecture out",
                          row->name);
        if (row &&
            (check_scene(line, row) || apply(line, row, line->word[i].text)))
            return STATUS_INVALID_INPUT;
    }
    return check_effects(line) ? STATUS_INVALID_INPUT : check_body(line);
}

Status options_parse(int argc, char **argv, int pane, Options *options,
                     Message message)
{
    Line line = {options, message, 0, {{0}}};
    Status status = read_words(argc, argv, &line);
    return status ? status : apply_words(&line, pane);
}

Status options_of_line(const char *text, Options *options, Message message)
{
    char copy[512];
    Line line = {options, message, 0, {{0}}};
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

Status lecture_options(const LecturePage *page, Options *options,
                       Message message)
{
    Status status = options_of_line(page->line, options, message);
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

/* Prints `start`, and `words` in the column of descriptions, in more lines if
 * they do not fit. */
static void help_line(FILE *help, const char *start, const char *words)
{
    int column = fprintf(help, "%s", start);
    if (column > HELP_INDENT && *words) {
        fputc('\n', help);
        column = 0;
    }
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

/* A line for each scene with its number; for each option its description, unit,
 * names or range, and default. */
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
        if (named && row->standard >= 0)
            snprintf(standard.text, sizeof standard.text, "[%s]",
                     name_at(row->names, (int)row->standard));
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
