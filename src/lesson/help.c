/* help.c - writes the text of --help. */
#include <string.h>

#include "lesson/command_line.h"
#include "lesson/hints.h"
#include "simulation/message.h"
#include "scenes/scenes.h"

enum { HELP_COLUMNS = 80, HELP_INDENT = 21 };

/* Writes the start of a line, and the words in the column of descriptions, in
 * several lines if they do not fit in one. */
static void write_help_line(FILE *help, const char *start, const char *words)
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

/* Writes what an option means: description, unit, names or range, default. */
static void describe_option_row(const OptionRow *row, char *words, size_t size)
{
    bool is_name = row->kind == OPTION_NAME;
    snprintf(words, size, "%s%s%s", row->help,
             is_name && row->help[0] ? ":"
             : row->unit[0]          ? ", "
                                     : "",
             row->unit);
    if (is_name)
        append(words, size, " %s", join_names(row->value_names).text);
    else if (row->kind == OPTION_WHOLE_NUMBER && row->high <= 4096)
        append(words, size, " %g ... %g", row->low, row->high);
    if (is_name && row->default_value >= 0)
        append(words, size, " [%s]",
               names_get(row->value_names, (int)row->default_value));
    else if (row->high > row->low && !row->number_count &&
             row->default_value >= row->low)
        append(words, size, " [%g]", row->default_value);
}

void options_print_help(FILE *help)
{
    fprintf(help, "usage: elasto [SCENE] [options]; SCENE is a name or a "
                  "number, else square\nscenes:\n");
    for (int i = 0; scenes[i].name; i++)
        fprintf(help, "  %2d %-15s  %s\n", i + 1, scenes[i].name,
                scenes[i].description);
    for (const OptionRow *row = option_rows; row->name; row++) {
        char start[80], words[512];
        if (!row->name[0]) {
            write_help_line(help, row->help, "");
            continue;
        }
        snprintf(start, sizeof start, "  --%s%s%s", row->name,
                 row->placeholder ? " " : "",
                 row->placeholder ? row->placeholder : "");
        if (row->letter)
            append(start, sizeof start, ", -%c", row->letter);
        describe_option_row(row, words, sizeof words);
        write_help_line(help, start, words);
    }
}
