#include "scenes/option_row.h"

#include <stdio.h>
#include <string.h>

#include "scenes/scene.h"

enum { HELP_SIZE = 8192, HELP_COLUMNS = 80, HELP_INDENT = 22 };

/* A text under construction. */
typedef struct Help {
    char text[HELP_SIZE];
    size_t used;
    int column;
} Help;

/* Adds a word after a blank; or on a new line, where it does not fit. */
static void help_word(Help *help, const char *word, size_t length)
{
    if (help->column + 1 + (int)length > HELP_COLUMNS) {
        help->used += (size_t)snprintf(help->text + help->used,
                                       sizeof help->text - help->used, "\n%*s",
                                       HELP_INDENT - 1, "");
        help->column = HELP_INDENT - 1;
    }
    help->used += (size_t)snprintf(help->text + help->used,
                                   sizeof help->text - help->used, " %.*s",
                                   (int)length, word);
    help->column += 1 + (int)length;
}

static void help_words(Help *help, const char *words)
{
    while (words && *words) {
        size_t length = strcspn(words, " ");
        help_word(help, words, length);
        words += length + (words[length] == ' ');
    }
}

/* A new line that begins with this. */
static void help_line(Help *help, const char *start)
{
    int length =
        snprintf(help->text + help->used, sizeof help->text - help->used,
                 "%s%s", help->used > 0 ? "\n" : "", start);
    help->column = length - (help->used > 0);
    help->used += (size_t)length;
}

/* Spaces up to the column of the texts. */
static void help_indent(Help *help)
{
    int missing = HELP_INDENT - 1 - help->column;
    if (missing <= 0)
        return;
    help->used +=
        (size_t)snprintf(help->text + help->used,
                         sizeof help->text - help->used, "%*s", missing, "");
    help->column = HELP_INDENT - 1;
}

/* Names or range that a row knows. */
static void help_choices(Help *help, const OptionRow *row)
{
    Text list = {""};
    if (row->parse == parse_integrator)
        for (const IntegratorMethod *known = integrator_methods; known->name;
             known++)
            add_name(&list, known->name);
    for (const OptionName *known = row->names; known && known->name; known++)
        add_name(&list, known->name);
    if (row->kind == KIND_WHOLE && row->high < 1e9)
        snprintf(list.text, sizeof list.text, "%s ... %s",
                 number_text(row->low).text, number_text(row->high).text);
    help_words(help, list.text);
}

/* [4]: the slides' value, where it is a number that can be asked for. */
static void help_default(Help *help, const OptionRow *row)
{
    Options defaults = option_defaults();
    const char *field = (const char *)&defaults + row->offset;
    Text words = {""};
    int whole = -1;
    double number;
    if (row->kind == KIND_WHOLE && row->size == sizeof whole) {
        memcpy(&whole, field, sizeof whole);
        snprintf(words.text, sizeof words.text, "[%d]", whole);
    } else if (row->kind == KIND_NUMBER) {
        memcpy(&number, field, sizeof number);
        if (number >= row->low && number <= row->high)
            snprintf(words.text, sizeof words.text, "[%s]",
                     number_text(number).text);
    }
    help_words(help, words.text);
}

/* One option: its name, what it is, unit, choices, default. */
static void help_option(Help *help, const OptionRow *row)
{
    Text start, what;
    snprintf(start.text, sizeof start.text, "  --%s%s%s%s%.1s", row->name,
             row->value ? " " : "", row->value ? row->value : "",
             row->letter ? ", -" : "", row->letter ? &row->letter : "");
    snprintf(what.text, sizeof what.text, "%s%s%s", row->help ? row->help : "",
             row->unit ? ", " : "", row->unit ? row->unit : "");
    help_line(help, start.text);
    help_indent(help);
    help_words(help, what.text);
    help_choices(help, row);
    help_default(help, row);
}

/* The scenes with their numbers, a line each. */
static void help_scenes(Help *help)
{
    Text start;
    help_line(help, "scenes:");
    for (int i = 0; scenes[i].name; i++) {
        snprintf(start.text, sizeof start.text, "  %2d %s", i + 1,
                 scenes[i].name);
        help_line(help, start.text);
        help_indent(help);
        help_words(help, scenes[i].sentence);
    }
}

const char *options_help(void)
{
    static Help help;
    help.used = 0;
    help_line(&help, "usage: elasto [SCENE] [options]; SCENE is a name or a "
                     "number, else square");
    help_scenes(&help);
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->name[0])
            help_option(&help, row);
        else
            help_line(&help, row->help);
    help_line(&help, "");
    return help.text;
}
