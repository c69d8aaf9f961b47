#include "scenes/body.h"
#include "scenes/option_row.h"
#include "scenes/pins.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/nearest.h"
#include "scenes/pages.h"

/* Whether a word is an option, rightly spelt or not. */
static bool is_option(const char *word)
{
    return word[0] == '-' && word[1] != '\0';
}

/* The letters of an option without its dashes and without "=VALUE". */
static Text option_letters(const char *word)
{
    Text letters = typed(word + strspn(word, "-"));
    letters.text[strcspn(letters.text, "=")] = '\0';
    return letters;
}

/* The row that a wrong name most likely means, or NULL. */
static const OptionRow *likely_row(const char *name)
{
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->name[0] &&
            (strcmp(row->name, name) == 0 || is_one_of(row->words, name)))
            return row;
    return nearest_row(option_rows, sizeof *option_rows, name);
}

/* The scene with this name, or that one of these words is about; NULL: none. */
static const Scene *scene_meant(const char *text)
{
    const Scene *scene = scene_find(text);
    for (const Scene *row = scenes; row->name && !scene; row++)
        if (is_one_of(row->words, text))
            scene = row;
    return scene;
}

/* What others have and we do not, and why. */
static const char *absent(const char *name)
{
    static const char *const rows[][2] = {
        {"seed random-seed rng random",
         "there is none: nothing is random, the same line gives the same bits"},
        {"fps framerate frame-rate",
         "there is none: windows and films have 60 frames a second"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (is_one_of(rows[i][0], name))
            return rows[i][1];
    return NULL;
}

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), last = strlen(end);
    return length > last && strcmp(text + length - last, end) == 0;
}

/* The row that suits the value better than the one its name means: --output
 * film.mp4, --resolution 1920x1080. */
static const OptionRow *row_of_value(const OptionRow *row, const char *value)
{
    static const char *const films[] = {".mp4", ".webm", ".gif", ".apng"};
    const char *better = NULL;
    int width, height;
    bool file = row && row->kind == KIND_TEXT;
    for (int i = 0; i < 4 && file; i++)
        if (ends_with(value, films[i]))
            better = "film";
    if (sscanf(value, "%dx%d", &width, &height) == 2)
        better = "size";
    return better ? option_row(better) : row;
}

/* "no option --dt; did you mean --timestep?"  value: what follows it, or "". */
static Status complain_unknown(const char *word, const char *value,
                               const Complaint *complaint)
{
    Text letters = option_letters(word), shown = typed(word);
    shown.text[strcspn(shown.text, "=")] = '\0';
    const char *why = absent(letters.text);
    if (why)
        return complain(complaint, "no option %s; %s", shown.text, why);
    const OptionRow *row = row_of_value(likely_row(letters.text), value);
    const IntegratorMethod *method = integrator_meant(letters.text);
    const Scene *scene =
        row ? scene_find(letters.text) : scene_meant(letters.text);
    bool no = strncmp(letters.text, "no-", 3) == 0;
    if (scene)
        return complain(complaint,
                        "no option %s; did you mean the scene: elasto %s?",
                        shown.text, scene->name);
    if (method)
        return complain(complaint,
                        "no option %s; did you mean --integrator %s?",
                        shown.text, method->name);
    if (row)
        return complain(complaint, "no option %s; did you mean --%s%s?",
                        shown.text, row->name,
                        no && row->names ? " none"
                        : no && row->kind == KIND_NUMBER && row->low <= 0 &&
                                !(row->needs & NEEDS_MESH)
                            ? " 0"
                            : "");
    return complain(complaint, "no option %s; see elasto --help", shown.text);
}

/* The row of "--name", "--name=value", of an abbreviation that only one option
 * has, or of a letter: "-h".  value: what follows it, for suggestions. */
static Status find_option(const char *word, const char *value,
                          const OptionRow **found, const Complaint *complaint)
{
    Text list = {""};
    int matches = 0;
    *found = NULL;
    bool is_long = word[1] == '-';
    const char *name = word + 1 + is_long;
    size_t length = strcspn(name, "=");
    char letter = name[0] == 'V' ? 'v' : name[0]; /* many programs have -V */
    for (const OptionRow *row = option_rows; row->name; row++) {
        bool match = is_long ? strncmp(row->name, name, length) == 0
                             : row->letter == letter && length == 1;
        if (!match || length == 0 || !row->name[0])
            continue;
        *found = row;
        if (is_long && row->name[length] == '\0')
            return STATUS_OK;
        Text long_name;
        snprintf(long_name.text, sizeof long_name.text, "--%s", row->name);
        add_name(&list, long_name.text);
        matches++;
    }
    const OptionRow *likely = likely_row(option_letters(word).text);
    bool other = is_long && likely && likely != *found &&
                 is_one_of(likely->words, option_letters(word).text);
    if (matches == 1 && !other) /* --time is more than half of --timestep */
        return STATUS_OK;
    if (matches > 1 &&
        !(likely && is_one_of(likely->words, option_letters(word).text)))
        return complain(complaint, "%s can be %s: write a few letters more",
                        typed(word).text, list.text);
    return complain_unknown(word, value, complaint);
}

/* The words of a command line, one by one. */
typedef struct Words {
    int argc;
    char **argv;
    int at;
    bool plain; /* after "--" no word is an option */
} Words;

/* One word: an option with its value, or anything else. */
typedef struct Word {
    const OptionRow *row; /* NULL: no option */
    const char *text;     /* the option's value, or the word; "" if neither */
} Word;

/* Moves to the next word; at the end word->text is NULL. */
static Status next_word(Words *words, Word *word, const Complaint *complaint)
{
    *word = (Word){NULL, NULL};
    if (words->at < words->argc && !words->plain &&
        strcmp(words->argv[words->at], "--") == 0) {
        words->plain = true;
        words->at++;
    }
    if (words->at >= words->argc)
        return STATUS_OK;
    const char *text = word->text = words->argv[words->at++];
    if (words->plain || !is_option(text))
        return STATUS_OK;
    const char *value = strchr(text, '=');
    const char *next_text =
        words->at < words->argc ? words->argv[words->at] : "";
    Status status =
        find_option(text, value ? value + 1 : next_text, &word->row, complaint);
    if (status)
        return status;
    word->text = value ? value + 1 : "";
    if (word->row->kind == KIND_SWITCH) {
        if (value)
            return complain(complaint, "%s: --%s takes no value",
                            typed(text).text, word->row->name);
    } else if (!value && word->row->optional) {
        if (words->at < words->argc && words->argv[words->at][0] != '-')
            word->text = words->argv[words->at++];
    } else if (!value) {
        const OptionRow *next = NULL;
        char unread[2];
        Complaint unheard = {unread, sizeof unread};
        bool there = words->at < words->argc;
        if (there && strncmp(words->argv[words->at], "--", 2) == 0)
            there =
                find_option(words->argv[words->at], "", &next, &unheard) != 0;
        if (!there)
            return complain(complaint, "--%s: the value is missing: --%s %s",
                            word->row->name, word->row->name, word->row->value);
        word->text = words->argv[words->at++];
    }
    return STATUS_OK;
}

/* A word that is no scene may be an option without its dashes. */
static Status complain_scene(const char *word, const Complaint *complaint)
{
    Text left = typed(word);
    char *equals = strchr(left.text, '=');
    const char *right = equals ? equals + 1 : "";
    if (equals)
        *equals = '\0';
    const OptionRow *option = NULL;
    for (const OptionRow *row = option_rows; row->name && !option; row++)
        if (row->name[0] && (strcmp(row->name, left.text) == 0 ||
                             is_one_of(row->words, left.text)))
            option = row;
    const IntegratorMethod *method = integrator_meant(word);
    const Scene *scene = scene_meant(word);
    if (!scene)
        scene = nearest_row(scenes, sizeof *scene, word);
    Text hint = {""};
    if (method)
        snprintf(hint.text, sizeof hint.text, "did you mean --integrator %s?",
                 method->name);
    else if (scene)
        snprintf(hint.text, sizeof hint.text, "did you mean %s? ", scene->name);
    else if (option)
        snprintf(hint.text, sizeof hint.text, "did you mean --%s%s%.40s?",
                 option->name, equals ? " " : "", right);
    return complain(complaint, "there is no scene '%s'; %s%s", typed(word).text,
                    hint.text,
                    method || (option && !scene) ? "" : "see elasto --list");
}

/* A scene by its name or its number in the list. */
static Status find_scene(const char *word, Options *options,
                         const Complaint *complaint)
{
    int count = 0;
    while (scenes[count].name)
        count++;
    options->scene = scene_find(word);
    if (options->scene)
        return STATUS_OK;
    if (word[0] != '\0' && word[strspn(word, "0123456789")] == '\0') {
        long number = strlen(word) < 6 ? strtol(word, NULL, 10) : 0;
        if (number < 1 || number > count)
            return complain(complaint,
                            "there is no scene '%s': from 1 to %d, or a name "
                            "of elasto --list",
                            typed(word).text, count);
        options->scene = &scenes[number - 1];
        return STATUS_OK;
    }
    return complain_scene(word, complaint);
}

/* What the first look at a line finds. */
typedef struct Line {
    const char *list[OPTION_MOST]; /* values to be compared, or NULL */
    bool given[OPTION_MOST];       /* options that the line has */
} Line;

static bool is_given(const Line *line, const char *name)
{
    for (int i = 0; option_rows[i].name; i++)
        if (strcmp(option_rows[i].name, name) == 0)
            return line->given[i];
    return false;
}

static int count_values(const char *list)
{
    int count = 1;
    for (; *list; list++)
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

/* Words that are wrong whatever they mean; the scene; the lists. */
static Status read_line(int argc, char **argv, bool compare, Options *options,
                        Line *line, const Complaint *complaint)
{
    Words words = {argc, argv, 1, false};
    Word word;
    Status status = next_word(&words, &word, complaint);
    *line = (Line){0};
    options->scene = NULL;
    for (; !status && word.text; status = next_word(&words, &word, complaint)) {
        if (word.row) {
            int i = (int)(word.row - option_rows);
            line->given[i] = true;
            if (compare && word.row->compared)
                line->list[i] = strchr(word.text, ',') ? word.text : NULL;
            if (word.row->optional &&
                parse_page(word.row, word.text, options, complaint))
                return STATUS_INVALID_INPUT;
        } else if (options->scene) {
            return complain(complaint, "'%s': one scene at a time, please",
                            typed(word.text).text);
        } else if (find_scene(word.text, options, complaint)) {
            return STATUS_INVALID_INPUT;
        }
    }
    if (options->scene && options->page)
        return complain(complaint,
                        "--lecture: its pages have scenes of their own, '%s' "
                        "cannot be asked for",
                        options->scene->name);
    if (!options->scene)
        options->scene = &scenes[0];
    return status;
}

/* The options of the page, before the rest of the line; that may not say again
 * what the page says. */
static Status take_page(const Line *line, Options *options,
                        const Complaint *complaint)
{
    for (int i = 0; option_rows[i].name; i++)
        if (line->given[i] && option_rows[i].needs)
            return complain(complaint,
                            "--%s: the lecture's pages say that themselves",
                            option_rows[i].name);
    return lecture_options(options->page, options, complaint->text,
                           complaint->size);
}

/* The number of combinations; which value of each list this pane has.  The
 * last list changes fastest. */
static Status choose_values(const Line *line, int pane, int *chosen,
                            Options *options, const Complaint *complaint)
{
    for (int i = OPTION_MOST - 1; i >= 0; i--) {
        int count = line->list[i] ? count_values(line->list[i]) : 1;
        chosen[i] = pane % count;
        pane /= count;
        options->panes *= count;
        if (options->panes > OPTIONS_MAX_PANES)
            return complain(complaint,
                            "--%s: '%s' makes more than %d side by side",
                            option_rows[i].name, typed(line->list[i]).text,
                            OPTIONS_MAX_PANES);
    }
    return STATUS_OK;
}

/* Refuses an option that says something about what the scene lacks. */
static Status check_need(const OptionRow *row, const Scene *scene,
                         const Complaint *complaint)
{
    const char *lacks = row->needs & NEEDS_MESH      ? "square"
                        : row->needs == NEEDS_TIME   ? "time steps"
                        : row->needs & NEEDS_TIME    ? "time"
                        : row->needs & NEEDS_SPRINGS ? "springs"
                        : row->needs & NEEDS_START   ? "start to choose"
                        : row->needs & NEEDS_BODY    ? "body that falls"
                                                     : "minimum to find";
    if (row->needs == 0 || (row->needs & scene->needs))
        return STATUS_OK;
    return complain(complaint, "--%s: the scene '%s' has no %s", row->name,
                    scene->name, lacks);
}

/* Second look: the values, on top of the scene's own numbers. */
static Status apply_line(int argc, char **argv, const Line *line,
                         const int *chosen, Options *options,
                         const Complaint *complaint)
{
    Words words = {argc, argv, 1, false};
    Word word;
    const int none = 0;
    for (int i = 0; option_rows[i].name; i++) /* not on top of the scene's */
        if (line->given[i] && option_rows[i].times > 1)
            memcpy((char *)options + option_rows[i].counter, &none,
                   sizeof none);
    Status status = next_word(&words, &word, complaint);
    for (; !status && word.text; status = next_word(&words, &word, complaint)) {
        if (!word.row)
            continue;
        int i = (int)(word.row - option_rows);
        status = check_need(word.row, options->scene, complaint);
        if (!status && line->list[i])
            status =
                option_apply(word.row, list_value(word.text, chosen[i]).text,
                             options, complaint);
        else if (!status)
            status = option_apply(word.row, word.text, options, complaint);
        if (status)
            return status;
    }
    return status;
}

/* Which numbers --pin may name depends on --segments. */
static Status check_pins(const Options *options, const Complaint *complaint)
{
    int columns = options->segments, rows = body_rows(options);
    if (!options->pin || !pins_read(options->pin, columns, rows, NULL))
        return STATUS_OK;
    return complain(complaint,
                    "--pin: '%s' is no list of node numbers from 0 to %d, "
                    "or of: " PINS_WORDS,
                    typed(options->pin).text, (columns + 1) * (rows + 1) - 1);
}

/* What the body has is right with the integrator, where one was chosen. */
static Status check_integrator(const Options *options,
                               const Complaint *complaint)
{
    const char *end = body_needs_end_of_step(options);
    if (!end || !options->integrator || options->integrator->at_end)
        return STATUS_OK;
    return complain(complaint,
                    "--integrator: '%s' has no %s; of all methods only "
                    "backward-euler has",
                    options->integrator->name, end);
}

/* Options that say something about what the line does not have. */
static Status check_meaning(const Line *line, const Options *options,
                            const Complaint *complaint)
{
    static const char *const about_obstacles[] = {"barrier", "friction",
                                                  "slip-speed"};
    for (int i = 0; i < 3; i++)
        if (is_given(line, about_obstacles[i]) && options->grounds == 0 &&
            options->balls == 0)
            return complain(complaint,
                            "--%s: there is nothing to touch; --ground or "
                            "--ball put it there",
                            about_obstacles[i]);
    if (is_given(line, "hardening") && !(options->yield > 0))
        return complain(complaint, "--hardening: the springs do not flow; "
                                   "--yield lets them");
    return check_integrator(options, complaint);
}

/* What depends on several options: the projection, unless it was chosen, and
 * where the body begins. */
static Status check_body(const Line *line, Options *options,
                         const Complaint *complaint)
{
    if (!(options->scene->needs & NEEDS_BODY))
        return STATUS_OK;
    Status status = check_pins(options, complaint);
    if (!status)
        status = check_meaning(line, options, complaint);
    if (status)
        return status;
    if (options->cells && !is_given(line, "filter"))
        options->filter = FILTER_ON_DEMAND;
    return body_check(options, complaint->text, complaint->size);
}

/* An option beside which no other has a meaning. */
static Status check_alone(const Line *line, const char *name,
                          const Complaint *complaint)
{
    for (int i = 0; option_rows[i].name; i++)
        if (line->given[i] && strcmp(option_rows[i].name, name) != 0)
            return complain(complaint,
                            "--%s: the program writes the file and ends, --%s "
                            "says nothing there",
                            name, option_rows[i].name);
    return STATUS_OK;
}

/* Options of one pane; lists are read as such or refused. */
static Status parse_line(int argc, char **argv, int pane, bool compare,
                         Options *options, const Complaint *complaint)
{
    Line line;
    int chosen[OPTION_MOST];
    *options = option_defaults();
    Status status = read_line(argc, argv, compare, options, &line, complaint);
    if (!status)
        status = choose_values(&line, pane, chosen, options, complaint);
    if (status)
        return status;
    if (options->page)
        status = take_page(&line, options, complaint);
    else if (options->scene->defaults)
        options->scene->defaults(options);
    if (status)
        return status;
    if (!status && is_given(&line, "handout"))
        status = check_alone(&line, "handout", complaint);
    if (status)
        return status;
    status = apply_line(argc, argv, &line, chosen, options, complaint);
    return status ? status : check_body(&line, options, complaint);
}

Status options_parse(int argc, char **argv, Options *options, char *message,
                     size_t size)
{
    Complaint complaint = {message, size};
    return parse_line(argc, argv, 0, false, options, &complaint);
}

Status options_parse_pane(int argc, char **argv, int pane, Options *options,
                          char *message, size_t size)
{
    Complaint complaint = {message, size};
    return parse_line(argc, argv, pane, true, options, &complaint);
}

/* "0 and 30", "1, 2 and 3" */
static Text list_text(const char *list)
{
    Text text = {""};
    int count = count_values(list);
    for (int i = 0; i < count; i++) {
        size_t used = strlen(text.text);
        snprintf(text.text + used, sizeof text.text - used, "%s%.63s",
                 i == 0           ? ""
                 : i == count - 1 ? " and "
                                  : ", ",
                 typed(list_value(list, i).text).text);
    }
    return text;
}

void options_panes(int argc, char **argv, char *text, size_t size)
{
    Line line;
    Options options = option_defaults();
    Complaint unheard = {text, size};
    int panes = 1;
    text[0] = '\0';
    if (read_line(argc, argv, true, &options, &line, &unheard))
        return;
    for (int i = 0; i < OPTION_MOST; i++)
        panes *= line.list[i] ? count_values(line.list[i]) : 1;
    size_t used = (size_t)snprintf(text, size, "%d panes:", panes);
    bool first = true;
    for (int i = 0; i < OPTION_MOST && used < size; i++) {
        if (!line.list[i])
            continue;
        used += (size_t)snprintf(text + used, size - used, "%s --%s %s",
                                 first ? "" : ";", option_rows[i].name,
                                 list_text(line.list[i]).text);
        first = false;
    }
}

Status options_set(Options *options, const char *name, const char *value,
                   char *message, size_t size)
{
    Complaint complaint = {message, size};
    for (const OptionRow *row = option_rows; row->name; row++) {
        if (!row->name[0] || strcmp(row->name, name) != 0 ||
            row->kind == KIND_SWITCH)
            continue;
        Status status = check_need(row, options->scene, &complaint);
        if (!status)
            status = option_apply(row, value, options, &complaint);
        return status ? status : check_integrator(options, &complaint);
    }
    return complain(&complaint, "there is no option '%s' with a value",
                    typed(name).text);
}
