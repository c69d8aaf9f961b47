#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scenes/body.h"
#include "scenes/option_values.h"
#include "scenes/pages.h"
#include "scenes/pins.h"
#include "scenes/scene.h"

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

/* "did you mean --timestep?"  What an unknown word most likely means, with what
 * follows its '='; else where to look. */
static Text suggestion(const char *word, const char *see)
{
    Text name = typed(word + strspn(word, "-")), hint;
    char *end = name.text + strcspn(name.text, "=");
    const char *value = *end ? end + 1 : "";
    *end = '\0';
    Nearest near = {.text = name.text};
    for (const OptionRow *row = option_rows; row->name; row++)
        look_at_name(&near, "--", row->name);
    for (const Scene *scene = scenes; scene->name; scene++)
        look_at_name(&near, "the scene ", scene->name);
    for (int i = 0; integrator_methods[i].name; i++)
        look_at_name(&near, "--integrator ", integrator_methods[i].name);
    snprintf(hint.text, sizeof hint.text, "%s%s%s%s%.40s%s",
             near.name ? "did you mean " : "see elasto ",
             near.name ? near.kind : "", near.name ? near.name : see,
             near.name && value[0] ? " " : "", near.name ? value : "",
             near.name ? "?" : "");
    return hint;
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
    return complain(&line->why, "no option %s; %s", shown.text,
                    suggestion(word, "--help").text);
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
    return complain(&line->why, "there is no scene '%s'; %s", typed(word).text,
                    suggestion(word, "--list").text);
}

static bool is_given(const Line *line, const char *name)
{
    return line->given[option_find(name) - option_rows];
}

static int count_values(const char *list)
{
    int count = 1;
    for (; list && *list; list++)
        count += *list == ',';
    return count;
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

/* The slides' numbers; whatever is no number begins as nothing. */
static Options option_defaults(void)
{
    Options options = {.panes = 1};
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->standard != 0)
            options.number[row->slot] = row->standard;
    return options;
}

/* First look: words that are wrong whatever they mean; the scene; the lists. */
static Status read_line(Line *line)
{
    Word word;
    Options *options = line->options;
    *options = option_defaults();
    Status status = STATUS_OK;
    while (!status && !(status = next_word(line, &word)) && word.text) {
        if (!word.row) {
            status = read_scene(word.text, line);
            continue;
        }
        size_t i = (size_t)(word.row - option_rows);
        bool list = word.row->compared;
        line->given[i] = true;
        line->list[i] = list && strchr(word.text, ',') ? word.text : NULL;
        if (word.row->kind == OPTION_PAGE)
            status = option_apply(word.row, word.text, options, &line->why);
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

/* The scene's own numbers. */
static Status begin_scene(Options *options, const Complaint *why)
{
    const Scene *scene = options->scene;
    Words words;
    Word word;
    Status status = STATUS_OK;
    split_words(scene->line ? scene->line : "", &words);
    Line line = {words.argc, 1, words.argv, options, *why, {0}, {0}};
    while (!status && !(status = next_word(&line, &word)) && word.text)
        status = option_apply(word.row, word.text, options, why);
    options->pin = scene->pin;
    return status;
}

/* What the values stand on: the page, or the scene's own numbers.  A page has
 * said what its scene needs, and beside a handout nothing has a meaning. */
static Status begin_options(Line *line)
{
    Options *options = line->options;
    for (const OptionRow *row = option_rows; row->name; row++) {
        bool given = line->given[row - option_rows];
        if (given && options->page && row->needs)
            return complain(&line->why,
                            "--%s: the lecture's pages say that themselves",
                            row->name);
        if (given && is_given(line, "handout") &&
            strcmp(row->name, "handout") != 0)
            return complain(&line->why,
                            "--handout: the program writes the file and ends, "
                            "--%s says nothing there",
                            row->name);
    }
    if (options->page)
        return lecture_options(options->page, options, line->why.text,
                               line->why.size);
    Status status = begin_scene(options, &line->why);
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->times && line->given[row - option_rows])
            options->number[row->counter] = 0;
    return status;
}

/* Which value of each list this pane has; the last list changes fastest. */
static Status choose_values(Line *line, int pane, int *chosen)
{
    for (int i = OPTIONS_MOST - 1; i >= 0; i--) {
        int count = count_values(line->list[i]);
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

/* One value, unless it says something about what the scene lacks. */
static Status set_value(const OptionRow *row, const char *text,
                        Options *options, const Complaint *why)
{
    Status status = check_scene(row, options, why);
    return status ? status : option_apply(row, text, options, why);
}

/* Second look: the values. */
static Status apply_line(Line *line, int pane)
{
    Word word;
    int chosen[OPTIONS_MOST];
    Status status = choose_values(line, pane, chosen);
    if (!status)
        status = begin_options(line);
    line->at = 1;
    while (!status && !(status = next_word(line, &word)) && word.text) {
        size_t i = word.row ? (size_t)(word.row - option_rows) : 0;
        Text value;
        if (line->list[i]) {
            value = list_value(word.text, chosen[i]);
            word.text = value.text;
        }
        if (word.row)
            status = set_value(word.row, word.text, line->options, &line->why);
    }
    return status;
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
    if (options->cells && !is_given(line, "filter"))
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

Status options_set(Options *options, const char *name, const char *value,
                   char *message, size_t size)
{
    const Complaint why = {message, size};
    const OptionRow *row = option_find(name);
    if (!row || row->kind == OPTION_SWITCH)
        return complain(&why, "there is no option '%s' with a value",
                        typed(name).text);
    Status status = set_value(row, value, options, &why);
    return status ? status : check_integrator(options, &why);
}

Status options_set_number(Options *options, int slot, double value,
                          char *message, size_t size)
{
    const Complaint why = {message, size};
    const OptionRow *row = option_at(slot);
    char text[64];
    if (!row)
        return complain(&why, "there is no number %d", slot);
    int names = option_names(row);
    double high = names > 0 ? names - 1 : row->high;
    bool inside = value >= row->low && value <= high;
    bool whole = row->kind == OPTION_NUMBER || value == floor(value);
    snprintf(text, sizeof text, "%g", value);
    Status status = check_scene(row, options, &why);
    if (!status && !(inside && whole) && value != row->standard)
        status = refuse_number(row, 1, text, &why);
    if (status)
        return status;
    options->number[slot] = value;
    return check_integrator(options, &why);
}
