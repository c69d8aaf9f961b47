#include "scenes/option_help.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scenes/one_line.h"
#include "scenes/options.h"
#include "scenes/scene.h"

enum { HELP_SIZE = 8192, HELP_COLUMNS = 80, HELP_INDENT = 21 };

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

/* A text under construction. */
typedef struct Help {
    char text[HELP_SIZE];
    size_t used;
    int column;
} Help;

/* A new line that begins with this. */
static void help_line(Help *help, const char *start)
{
    help->column = snprintf(help->text + help->used, HELP_SIZE - help->used,
                            "%s\n", start);
    help->used += (size_t)help->column--;
}

/* Adds words to the last line from the column of the texts on, and to new lines
 * where they do not fit. */
static void help_words(Help *help, const char *words)
{
    while (*words) {
        int length = (int)strcspn(words, " ");
        if (help->column + 1 + length > HELP_COLUMNS)
            help_line(help, "");
        int blanks =
            help->column < HELP_INDENT ? HELP_INDENT - help->column : 0;
        help->used--; /* the end of the line */
        help->used +=
            (size_t)snprintf(help->text + help->used, HELP_SIZE - help->used,
                             "%*s %.*s\n", blanks, "", length, words);
        help->column += blanks + 1 + length;
        words += length + (words[length] == ' ');
    }
}

/* One option: its name, what it is, unit, names or range, default. */
static void help_option(Help *help, const OptionRow *row)
{
    Text start, text, list = {""};
    const char *name;
    bool ranged = row->kind == OPTION_WHOLE && row->high <= 4096;
    bool standard =
        row->high > row->low && !row->count && row->standard >= row->low;
    snprintf(start.text, sizeof start.text, "  --%s%s%s%s%.1s", row->name,
             row->value ? " " : "", row->value ? row->value : "",
             row->letter ? ", -" : "", &row->letter);
    for (int i = 0; row->kind == OPTION_NAME && (name = row->names(i)); i++)
        add_name(&list, "", name);
    snprintf(text.text, sizeof text.text, "%s%s%s", row->help,
             row->unit[0] ? ", " : "", row->unit);
    help_line(help, start.text);
    help_words(help, text.text);
    help_words(help, list.text);
    snprintf(text.text, sizeof text.text, "%.31s ... %.31s",
             number_text(row->low).text, number_text(row->high).text);
    help_words(help, ranged ? text.text : "");
    snprintf(text.text, sizeof text.text, "[%.31s]",
             number_text(row->standard).text);
    help_words(help, standard ? text.text : "");
}

/* The scenes with their numbers, a line each; the options. */
const char *options_help(void)
{
    static Help help;
    Text start;
    help.used = 0;
    help_line(&help, "usage: elasto [SCENE] [options]; SCENE is a name or a "
                     "number, else square");
    help_line(&help, "scenes:");
    for (int i = 0; scenes[i].name; i++) {
        snprintf(start.text, sizeof start.text, "  %2d %s", i + 1,
                 scenes[i].name);
        help_line(&help, start.text);
        help_words(&help, scenes[i].sentence);
    }
    for (const OptionRow *row = option_rows; row->name; row++)
        if (row->name[0])
            help_option(&help, row);
        else
            help_line(&help, row->help);
    return help.text;
}
