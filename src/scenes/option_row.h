/* option_row.h - a row of the table of options, and what reads such rows.
 */
#ifndef ELASTO_OPTION_ROW_H
#define ELASTO_OPTION_ROW_H

#include <stddef.h>

#include "scenes/options.h"
#include "scenes/scene.h"

typedef enum OptionKind {
    KIND_SWITCH,  /* bool, takes no value */
    KIND_WHOLE,   /* int or long */
    KIND_NUMBER,  /* double */
    KIND_NUMBERS, /* double[count], separated by commas */
    KIND_NAME,    /* int or enum: one of the row's names */
    KIND_TEXT,    /* const char *, not empty: a file, a folder */
    KIND_OWN,     /* whatever the row's parse function makes of it */
} OptionKind;

/* A value that has a name. */
typedef struct OptionName {
    const char *name;
    int value;
    const char *words; /* what it is called elsewhere: only suggested */
} OptionName;

typedef struct OptionRow OptionRow;
typedef struct Complaint Complaint;
typedef Status ParseFunction(const OptionRow *row, const char *text,
                             Options *options, const Complaint *complaint);

struct OptionRow {
    const char *name;  /* without its dashes; NULL ends the table */
    char letter;       /* short form, or 0 */
    const char *value; /* what stands for the value in --help */
    const char *help;  /* for --help: what it is; or a new section, see below */
    const char *words; /* what people type instead: only suggested */
    OptionKind kind;
    size_t offset, size;     /* of its field in Options */
    double low, high;        /* numbers: from ... to, both included */
    const char *unit;        /* of the numbers, or NULL */
    int count;               /* KIND_NUMBERS: how many */
    int times;               /* more than 1: it may be given so often; the */
    size_t counter;          /* field is an array, its length an int here */
    const OptionName *names; /* KIND_NAME */
    ParseFunction *parse;    /* KIND_OWN */
    unsigned needs;          /* of enum SceneNeeds, one of them; 0: nothing */
    bool compared;           /* a list of values is side by side */
    bool optional;           /* the value may be left out */
};

/* The table; a row that has an empty name begins a section of --help, and a
 * row whose name is NULL ends it. */
extern const OptionRow option_rows[];
enum { OPTION_MOST = 64 }; /* rows */

/* The row with this name, or the end of the table. */
const OptionRow *option_row(const char *name);

/* A page of the lecture, by number or name; empty: the first. */
ParseFunction parse_page;

/* The slides' numbers. */
Options option_defaults(void);

/* Where the one line that explains a refusal goes. */
struct Complaint {
    char *text;
    size_t size;
};

/* Something short to be printed inside a line. */
typedef struct Text {
    char text[256];
} Text;

typedef struct NumberText {
    char text[32];
} NumberText;

/* Writes the line; returns INVALID_INPUT. */
Status complain(const Complaint *complaint, const char *format, ...);

/* What somebody typed: one line, and short enough to leave room. */
Text typed(const char *word);

/* 1e-30, 4096, 1e18: as people write it. */
NumberText number_text(double number);

/* Adds to a list: "a, b". */
void add_name(Text *list, const char *name);

/* What the option is followed by on the command line, into its field.
 * Returns OK or INVALID_INPUT with the reason. */
Status option_apply(const OptionRow *row, const char *text, Options *options,
                    const Complaint *complaint);

/* Functions of rows of KIND_OWN. */
ParseFunction parse_integrator, parse_start, parse_size;

/* A method by its own name or by one of the slides' words, or NULL. */
const IntegratorMethod *integrator_meant(const char *text);

#endif
