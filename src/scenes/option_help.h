/* option_help.h - short texts about options, for --help and for refusals.
 */
#ifndef ELASTO_OPTION_HELP_H
#define ELASTO_OPTION_HELP_H

/* Something short to be printed inside a line. */
typedef struct Text {
    char text[256];
} Text;

/* What somebody typed: one line, and short enough to leave room. */
Text typed(const char *word);

/* 1e-30, 4096, 1e15: as people write it. */
Text number_text(double number);

/* Adds to a list: "--a, --b". */
void add_name(Text *list, const char *before, const char *name);

#endif
