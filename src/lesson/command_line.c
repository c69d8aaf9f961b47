/* command_line.c - reads lines of options, and says what is wrong with them. */
#include "lesson/command_line.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lesson/hints.h"
#include "lesson/pages.h"
#include "simulation/body.h"
#include "scenes/scenes.h"

/* A word of a line: an option with its value, or the name of a scene. */
typedef struct ArgWord {
    const OptionRow *row;  /* option; NULL: the word is a scene */
    const char *text;      /* value, or name of the scene */
    const char *list_text; /* "1,2,3", if `text` is one of several values */
    char list_item[64];    /* copy of the text, if it is part of `list_text` */
} ArgWord;

enum { MAX_WORDS = 256 };

/* A command line that is being read. */
typedef struct ArgLine {
    Options *options; /* out */
    Message message;  /* out, the first mistake */
    int words;        /* number of words */
    ArgWord word[MAX_WORDS];
    char text_copy[512]; /* string that is cut into words */
} ArgLine;

/* Returns the last word that sets an option; NULL: no word sets it. */
static ArgWord *find_word(ArgLine *line, const char *option)
{
    for (int i = line->words - 1; i >= 0; i--)
        if (line->word[i].row && !strcmp(line->word[i].row->name, option))
            return &line->word[i];
    return NULL;
}

/* ---- values ------------------------------------------------------------- */

/* Refuses a value with a message such as "is not X,Y, each from -1 to 1, in m".
 *   count  in, number of numbers that the value needs */
static Status refuse_value(const ArgLine *line, const ArgWord *word, int count)
{
    const OptionRow *row = word->row;
    const char *text = word->text;
    const char *instead = find_replacement(row->name, text);
    Phrase hint = {""};
    if (row->kind == OPTION_PAGE)
        return refuse(line->message,
                      "--%s: there is no page '%.60s'%s; pages are 1 to %d, or "
                      "names: elasto --lecture --list",
                      row->name, text,
                      suggest_name(text, "", NAMES_OF(lecture_pages)).text,
                      lecture_count_pages());
    if (instead)
        return refuse(line->message, "--%s: '%s' is gone: %s", row->name, text,
                      instead);
    if (row->kind == OPTION_NAME)
        return refuse(line->message, "--%s: '%.60s' is none of: %s%s",
                      row->name, text, join_names(row->value_names).text,
                      suggest_name(text, "", row->value_names).text);
    if (word->list_text || option_count_values(text, ',') > count)
        append(hint.text, sizeof hint.text,
               "; in '%.60s' a comma ends a number, which has a point",
               word->list_text ? word->list_text : text);
    return refuse(
        line->message, "--%s: '%.60s' is not %s%s from %g to %g%s%s%s",
        row->name, text, count > 1 ? row->placeholder : "",
        count > 1                    ? ", each"
        : row->kind == OPTION_NUMBER ? "a number"
                                     : "a whole number",
        row->low, row->high, row->unit[0] ? ", in " : "", row->unit, hint.text);
}

/* Stores a name or numbers.  In one dimension the start is x without y. */
static Status apply_option_numbers(const ArgLine *line, const ArgWord *word)
{
    const OptionRow *row = word->row;
    Options *options = line->options;
    double number[BODY_OPTION_NUMBERS] = {0};
    double *times = &options->number[row->count_slot];
    int most = row->number_count ? row->number_count : 1, used = 0;
    bool x_alone = row->needs_any_trait == HAS_START &&
                   (options->scene->traits & HAS_ONE_COORDINATE);
    int count = x_alone ? 1 : most;
    if ((x_alone && strchr(word->text, ',')) ||
        !option_parse(row, count, word->text, number))
        return refuse_value(line, word, count);
    if (row->max_repetitions && *times >= row->max_repetitions)
        return refuse(line->message,
                      "--%s: '%.60s' is one too many; at most %d are possible",
                      row->name, word->text, row->max_repetitions);
    if (row->max_repetitions)
        used = (int)(*times)++;
    memcpy(&options->number[row->slot + used * most], number,
           (size_t)most * sizeof *number);
    return STATUS_OK;
}

/* Stores the name of a file, or of nodes.  A table must be CSV. */
static Status apply_option_text(const ArgLine *line, const ArgWord *word)
{
    static const char formats[] =
        " .npz .npy .json .vtk .vtu .vtp .obj .gz .zip .xlsx .hdf5 .h5 .mat "
        ".parquet .xml .bz2 .xz .tar .pkl .feather .ply .stl .png .mp4 .tsv ";
    char format[16];
    const OptionRow *row = word->row;
    const char *text = word->text, *end = strrchr(text, '.');
    if (!text[0])
        return refuse(line->message, "--%s: the value is empty: --%s %s",
                      row->name, row->name, row->placeholder);
    snprintf(format, sizeof format, " %s ", end ? end : "");
    if (row->is_table && strcasestr(formats, format))
        return refuse(line->message,
                      "--%s: '%.60s': tables are CSV, but %s is another "
                      "format; use .csv",
                      row->name, text, end);
    memcpy((char *)line->options + row->offset, &text, sizeof text);
    return STATUS_OK;
}

/* Stores the value of an option.  --lecture with no value is the first page. */
static Status apply_option_word(const ArgLine *line, const ArgWord *word)
{
    Options *options = line->options;
    switch (word->row->kind) {
    case OPTION_SWITCH:
        options->number[word->row->slot] = 1;
        return STATUS_OK;
    case OPTION_TEXT:
        return apply_option_text(line, word);
    case OPTION_PAGE:
        options->page = lecture_find_page(word->text[0] ? word->text : "1");
        return options->page ? STATUS_OK : refuse_value(line, word, 1);
    default:
        return apply_option_numbers(line, word);
    }
}

/* Checks that the scene has what the option needs. */
static Status check_needed_traits(const Options *options, const OptionRow *row,
                                  Message message)
{
    const Scene *scene = options->scene;
    const char *missing = row->needs_any_trait & HAS_MESH   ? "square"
                          : row->needs_any_trait & HAS_TIME ? "time steps"
                          : row->needs_any_trait & HAS_TIMESTEP
                              ? "time step to choose"
                          : row->needs_any_trait & HAS_SPRINGS ? "springs"
                          : row->needs_any_trait & HAS_START ? "start to choose"
                          : row->needs_any_trait & HAS_BODY  ? "body"
                                                            : "minimum to find";
    return !row->needs_any_trait || (row->needs_any_trait & scene->traits)
               ? STATUS_OK
               : refuse(message, "--%s: the scene '%s' has no %s", row->name,
                        scene->name, missing);
}

Status options_set(Options *options, const OptionRow *row, const char *text,
                   double value, Message message)
{
    const ArgLine line = {.options = options, .message = message};
    char number[32] = "";
    Status status = check_needed_traits(options, row, message);
    if (!text[0] && !isnan(value))
        option_write(row, value, number, sizeof number);
    const ArgWord word = {row, text[0] ? text : number, NULL, ""};
    if (!status && text[0])
        status = apply_option_word(&line, &word);
    else if (!status && (row->number_count > 1 || !option_allows(row, value)))
        status = refuse_value(&line, &word, row->number_count);
    else if (!status)
        options->number[row->slot] = value;
    if (status)
        return status;
    /* The integrator must allow the new value.  If the value begins a new run,
     * the body must be able to start. */
    bool is_start = row->effect == EFFECT_NEW_RUN &&
                    (row->needs_any_trait & HAS_SQUARE) &&
                    (options->scene->traits & HAS_BODY);
    status = body_check_method(options, message);
    return status || !is_start ? status : body_check_start(options, message);
}

/* ---- words -------------------------------------------------------------- */

/* Returns a hint if a blank seems to split a value, as in "4 ms"; else "".
 *   before  in, word before the text, or NULL */
static Phrase hint_at_split_value(const ArgWord *before, const char *text)
{
    Phrase hint = {""};
    const OptionRow *row = before ? before->row : NULL;
    if (row && row->placeholder)
        append(hint.text, sizeof hint.text, "; a value has no blanks: --%s %s",
               row->name, row->placeholder);
    else if (row && isdigit((unsigned char)text[0]))
        append(hint.text, sizeof hint.text, "; --%s takes no value", row->name);
    return hint;
}

/* Refuses an unknown name, the part of a word before '='.
 *   hint   in, end of the message, or ""
 *   where  in, end of the message without a hint: where to look */
static Status refuse_unknown_name(const ArgLine *line, const char *what,
                                  const char *word, Phrase hint,
                                  const char *where)
{
    int length = (int)fmin(strcspn(word, "="), 60);
    return refuse(line->message, "%s '%.*s'%s", what, length, word,
                  hint.text[0] ? hint.text : where);
}

/* Returns the row of "--name", "--name=value", or of a letter, "-h" or "-H";
 * NULL: the word is refused. */
static const OptionRow *find_named_option(const ArgLine *line, const char *word)
{
    char name[64];
    int dashes = (int)strspn(word, "-"), length = (int)strcspn(word, "=");
    snprintf(name, sizeof name, "%.*s", length - dashes, word + dashes);
    const OptionRow *found = dashes == 2 ? option_find(name) : NULL;
    for (const OptionRow *row = option_rows; row->name; row++)
        if (dashes == 1 && !name[1] && row->letter == tolower(name[0]))
            found = row;
    const char *instead = dashes == 2 ? find_replacement(name, "") : NULL;
    const ArgWord *before = line->words ? &line->word[line->words - 1] : NULL;
    if (instead)
        refuse(line->message, "--%s is gone: %s", name, instead);
    else if (!found)
        refuse_unknown_name(
            line, "there is no option", word,
            isdigit((unsigned char)name[0]) ? hint_at_split_value(before, name)
            : scene_find(name) || strcmp(name, "scene") == 0
                ? (Phrase){"; a scene has no dashes: elasto drop"}
                : suggest_name(name, "--", NAMES_OF(option_rows)),
            "; see elasto --help");
    return found;
}

/* Splits arguments into words; a value is behind '=' or the next argument. */
static Status read_argument_words(int argc, char **argv, ArgLine *line)
{
    for (int i = 1; i < argc;) {
        const char *text = argv[i++], *equals = strchr(text, '=');
        const char *next = i < argc ? argv[i] : "--";
        ArgWord word = {NULL, text, NULL, ""};
        if (line->words == MAX_WORDS)
            return refuse(line->message, "'%.60s': more than %d words", text,
                          MAX_WORDS);
        if (text[0] == '-' && text[1]) {
            const OptionRow *row = word.row = find_named_option(line, text);
            if (!row)
                return STATUS_INVALID_INPUT;
            bool is_switch = row->kind == OPTION_SWITCH;
            bool no_page = row->kind == OPTION_PAGE && next[0] == '-';
            bool is_next = !equals && !is_switch && !no_page;
            if (equals && is_switch)
                return refuse(line->message, "%s: --%s takes no value", text,
                              row->name);
            if (is_next && strncmp(next, "--", 2) == 0)
                return refuse(line->message,
                              "--%s: the value is missing: --%s %s", row->name,
                              row->name, row->placeholder);
            word.text = equals ? equals + 1 : is_next ? next : "";
            i += is_next;
        }
        line->word[line->words++] = word;
    }
    return STATUS_OK;
}

/* Reads the words of a text without quotes, separated by blanks. */
static Status read_text_words(const char *text, ArgLine *line)
{
    enum { MAX_SPLIT_WORDS = 48 };
    char *argv[MAX_SPLIT_WORDS] = {""}, *rest;
    int argc = 1;
    snprintf(line->text_copy, sizeof line->text_copy, "%s", text ? text : "");
    for (char *word = strtok_r(line->text_copy, " ", &rest);
         word && argc < MAX_SPLIT_WORDS; word = strtok_r(NULL, " ", &rest))
        argv[argc++] = word;
    return read_argument_words(argc, argv, line);
}

/* Refuses a word that is no scene.  The word may be an option without its
 * dashes, or with the dashes of an editor, or a part of a value. */
static Status refuse_unknown_scene(const ArgLine *line, const ArgWord *word)
{
    const char *text = word->text;
    char name[64];
    Phrase hint = suggest_name(text, "", NAMES_OF(scenes));
    snprintf(name, sizeof name, "%.*s", (int)strcspn(text, "="), text);
    if (option_find(name))
        snprintf(hint.text, sizeof hint.text, "; did you mean --%s?", text);
    else if (strncmp(text, "\u2013", 2) == 0) /* long dash of an editor */
        hint = (Phrase){"; an option begins with two signs '-'"};
    else if (!hint.text[0])
        hint = hint_at_split_value(word > line->word ? word - 1 : NULL, text);
    return refuse_unknown_name(line, "there is no scene", text, hint,
                               "; see elasto --list");
}

/* Finds the scene or the page of a line.  Refuses a second scene, a scene
 * beside a page, and a second file for one option. */
static Status find_scene(ArgLine *line)
{
    Options *options = line->options;
    for (int i = 0; i < line->words; i++) {
        const ArgWord *word = &line->word[i];
        const OptionRow *row = word->row;
        const ArgWord *last = row ? find_word(line, row->name) : NULL;
        if (row && row->kind == OPTION_TEXT && last != word)
            return refuse(line->message,
                          "--%s: '%.60s' and '%.60s': only one can be given",
                          row->name, word->text, last->text);
        if (row && row->kind == OPTION_PAGE && apply_option_word(line, word))
            return STATUS_INVALID_INPUT;
        if (!row && options->scene)
            return refuse(line->message,
                          "'%.60s': only one scene can be given, and '%s' is "
                          "one%s",
                          word->text, options->scene->name,
                          hint_at_split_value(word - 1, word->text).text);
        if (!row && !(options->scene = scene_find(word->text)))
            return refuse_unknown_scene(line, word);
    }
    if (options->scene && options->page)
        return refuse(line->message,
                      "--lecture: each page has its own scene; leave '%s' out",
                      options->scene->name);
    if (!options->scene)
        options->scene = &scenes[0];
    return STATUS_OK;
}

/* Fills the options with the defaults, changed by the scene or by the page. */
static Status set_defaults(ArgLine *line)
{
    Options *options = line->options;
    ArgLine own = {.options = options, .message = line->message};
    if (options->page)
        return lecture_make_options(options->page, options, line->message);
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->default_value != 0)
            options->number[row->slot] = row->default_value;
    Status status = read_text_words(options->scene->default_options, &own);
    for (int i = 0; i < own.words && !status; i++)
        status = apply_option_word(&own, &own.word[i]);
    /* --body replaces the scene's body, and with the body its pins */
    if (!find_word(line, "body"))
        options->pin = options->scene->default_pin;
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->max_repetitions && find_word(line, row->name))
            options->number[row->count_slot] = 0;
    return status;
}

/* Picks this pane's value from each list; the last list changes fastest. */
static Status select_pane_values(ArgLine *line, int pane)
{
    bool is_drawn = !find_word(line, "headless") || find_word(line, "frames") ||
                    find_word(line, "film");
    int most = is_drawn ? OPTIONS_MAX_DRAWN_PANES : OPTIONS_MAX_PANES;
    for (int i = names_count(NAMES_OF(option_rows)) - 1; i >= 0; i--) {
        const OptionRow *row = &option_rows[i];
        ArgWord *word = row->label ? find_word(line, row->name) : NULL;
        const char *text = word ? word->text : "";
        int count = option_count_values(text, ',');
        if (count == 1)
            continue;
        line->options->panes *= count;
        if (line->options->panes > most)
            return refuse(line->message,
                          "--%s: '%.60s' makes more than %d side by side%s",
                          row->name, text, most,
                          is_drawn ? "; with --headless, where nothing is "
                                     "drawn, 64 are possible"
                                   : "");
        word->list_text = text;
        for (int k = pane % count; k > 0; k--)
            text = strchr(text, ',') + 1;
        snprintf(word->list_item, sizeof word->list_item, "%.*s",
                 (int)strcspn(text, ","), text);
        word->text = word->list_item;
        pane /= count;
    }
    return STATUS_OK;
}

/* Checks the nodes of --pin. */
static Status check_pinned_nodes(const Options *options, Message message)
{
    const SquareMesh shape = body_make_mesh(options);
    const char *bad =
        options->pin ? pins_parse(options->pin, &shape, NULL) : NULL;
    if (!bad)
        return STATUS_OK;
    char name[64];
    int body = 0;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(bad, ","), bad);
    sscanf(bad, "%*[^:,]:%d", &body);
    return refuse(
        message,
        "--pin: '%s' is no node from 0 to %d, and none of: " PINS_WORDS "%s",
        name, shape.nodes - 1,
        body > shape.bodies ? "; there are not so many bodies"
                            : suggest_name(name, "", pins_get_words()).text);
}

/* Checks that the options of the body allow a start.  A material's triangles
 * cannot turn over, so --cells is switched off.  With cells, triangles or
 * self-contact the default projection is on-demand. */
static Status check_body_options(ArgLine *line)
{
    Options *options = line->options;
    bool is_solid = options->material != 0;
    if (!(options->scene->traits & HAS_BODY))
        return STATUS_OK;
    if (check_pinned_nodes(options, line->message) ||
        body_check_method(options, line->message))
        return STATUS_INVALID_INPUT;
    if (is_solid &&
        (options->yield > 0 || options->tear > 0 || options->damping > 0))
        return refuse(line->message,
                      "--material: the scene '%s' is about springs; triangles "
                      "do not yield or tear, and have no damping",
                      options->scene->name);
    if (is_solid)
        options->has_cell_energy = 0;
    if ((options->has_cell_energy || is_solid || options->has_self_contact) &&
        !find_word(line, "projection"))
        options->projection = PROJECTION_ON_DEMAND;
    return body_check_start(options, line->message);
}

/* Stores the words of a line in the options of a pane.  Refuses options that
 * have no effect beside the others. */
static Status apply_argument_line(ArgLine *line, int pane)
{
    Options *options = line->options;
    *options = (Options){.panes = 1};
    if (find_scene(line) || set_defaults(line) ||
        select_pane_values(line, pane))
        return STATUS_INVALID_INPUT;
    for (int i = 0; i < line->words; i++) {
        const OptionRow *row = line->word[i].row;
        if (row && options->page && row->needs_any_trait)
            return refuse(line->message,
                          "--%s: a page of --lecture has its own value; change "
                          "it in the window, or leave --lecture out",
                          row->name);
        if (row && (check_needed_traits(options, row, line->message) ||
                    apply_option_word(line, &line->word[i])))
            return STATUS_INVALID_INPUT;
    }
    if (options->bodies > 1 && !find_word(line, "self-contact"))
        options->has_self_contact = 1; /* bodies touch each other */
    for (int i = 0; i < line->words; i++) {
        const OptionRow *row = line->word[i].row;
        const char *reason =
            row && row->get_idle_reason ? row->get_idle_reason(options) : NULL;
        if (reason)
            return refuse(line->message, "--%s: %s", row->name, reason);
    }
    return check_body_options(line);
}

Status options_parse(int argc, char **argv, int pane, Options *options,
                     Message message)
{
    ArgLine line = {.options = options, .message = message};
    Status status = read_argument_words(argc, argv, &line);
    return status ? status : apply_argument_line(&line, pane);
}

Status options_parse_line(const char *line, Options *options, Message message)
{
    ArgLine words = {.options = options, .message = message};
    Status status = read_text_words(line, &words);
    return status ? status : apply_argument_line(&words, 0);
}

Status lecture_make_options(const LecturePage *page, Options *options,
                            Message message)
{
    Status status = options_parse_line(page->command_line, options, message);
    const char *pin = strstr(page->command_line, "--pin ");
    if (pin) /* pin must not point into the parsed copy of the line */
        options->pin = pin + strlen("--pin ");
    lecture_apply_page(page, options);
    options->flips = page->switch_flips;
    options->speed = page->speed;
    return status;
}
