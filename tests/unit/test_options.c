/* test_options.c - the command line: defaults, options, refused lines */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "simulation/message.h"
#include "lesson/pages.h"

/* Sets one option of a square. message [512] */
static Status set_square_option(Options *options, const char *name,
                                const char *value, char *message)
{
    *options = options_from_line("square");
    return options_set(options, option_find(name), value, NAN,
                       (Message){message, 512});
}

static void check_option_refused(const char *option, const char *value,
                                 const char *range)
{
    Options options;
    char message[512], shown[80];
    snprintf(shown, sizeof shown, "--%s: '%s' is not ", option, value);
    CHECK_STATUS(set_square_option(&options, option, value, message),
                 STATUS_INVALID_INPUT);
    if (strncmp(message, shown, strlen(shown)) != 0 || !strstr(message, range))
        fail_msg("--%s %s: %s", option, value, message);
}

/* Each number has its own slot and takes the ends of its range, but not the
 * next numbers, nor words that are no whole decimal number. */
TEST(numbers_have_ranges)
{
    static const char *const bad[] = {
        "nan", "NAN",   "inf", "-infinity", "0x10", "",   "1e999",
        "4x",  "1.4.1", "-",   "e5",        "+-1",  "ten"};
    int numbers = 0;
    for (const OptionRow *row = option_rows; row->name; row++) {
        for (const OptionRow *other = option_rows; other < row; other++)
            CHECK(row->kind == OPTION_TEXT || row->kind == OPTION_PAGE ||
                  other->kind == OPTION_TEXT || other->kind == OPTION_PAGE ||
                  !row->name[0] || !other->name[0] || row->slot != other->slot);
        if (!(row->high > row->low) || row->number_count)
            continue;
        numbers++;
        for (int end = 0; end < 2; end++) {
            double border = end ? row->high : row->low, up = end ? 1 : -1;
            char text[32], beyond[32], message[512];
            Options options;
            option_write(row, border, text, sizeof text);
            CHECK_OK(set_square_option(&options, row->name, text, message));
            CHECK(options.number[row->slot] == border);
            option_write(row,
                         row->kind == OPTION_WHOLE_NUMBER
                             ? border + up
                             : nextafter(border, up * INFINITY),
                         beyond, sizeof beyond);
            check_option_refused(row->name, beyond, "a ");
        }
        for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
            check_option_refused(row->name, bad[k], " from ");
    }
    CHECK(numbers > 15);
}

/* Returns true if a part of a row is about an option, not the message. */
static bool field_is_option(const char *part)
{
    return strchr("=+-", part[0]) && part[1] == ' ';
}

/* Checks a part of a row of lines.txt: an option's value ("= NAME NUMBER..."),
 * an option on or off ("+ NAME", "- NAME"), or words of the message. */
static bool field_matches(const char *part, const Options *options,
                          const char *message)
{
    char name[32];
    int used;
    double wanted;
    if (!field_is_option(part))
        return strstr(message, part) != NULL;
    CHECK(sscanf(part + 2, "%31s%n", name, &used) == 1);
    const OptionRow *row = option_find(name);
    const double *number = options->number + row->slot;
    if (part[0] != '=')
        return option_is_on(row, options) == (part[0] == '+');
    for (part += 2 + used; sscanf(part, "%lf%n", &wanted, &used) == 1;
         part += used)
        if (*number++ != wanted)
            return false;
    return true;
}

/* Each line of tests/data/lines.txt is accepted, or refused with the reason. */
TEST(command_lines_are_accepted_or_explained)
{
    char row[512], message[512];
    int count = 0;
    FILE *file = fopen("tests/data/lines.txt", "r");
    assert_non_null(file);
    while (fgets(row, sizeof row, file)) {
        char *rest = row;
        row[strcspn(row, "\n")] = '\0';
        const char *line = take_row_field(&rest);
        bool taken = !rest || field_is_option(rest);
        if (line[0] == '#')
            continue;
        Options options = {.panes = 1};
        Status status = STATUS_OK;
        for (int pane = 0; pane < options.panes && !status; pane++)
            status = parse_line(line, pane, &options, message);
        bool good = status == (taken ? STATUS_OK : STATUS_INVALID_INPUT) &&
                    !strchr(message, '\n');
        for (const char *part; (part = take_row_field(&rest));)
            good = good && field_matches(part, &options, message);
        if (!good)
            fail_msg("%s: '%s'", line, message);
        count++;
    }
    fclose(file);
    CHECK(count > 80);
}

/* Appends a random piece of a command line. word [80] in/out */
static void append_random_piece(Random *random, char *word)
{
    static const char pieces[] =
        "--segments=8|--side=2|--st|--timestep=1/60|--projection|--lo|-h|3|-1|"
        "1e3|--integrator=bdf2|--steps=1e3|--quiet|--projection=none|inf|"
        "--stif=1e3|"
        "1,2|--stretch=-.5||verlet,bdf2|none|\n|=|--|\303\274|%s%n|circle|"
        "\302\233";
    const char *at = pieces;
    for (int n = random_below(random, 28); n > 0; n--)
        at = strchr(at, '|') + 1;
    strncat(word, at, strcspn(at, "|"));
}

/* Random command lines are understood, or refused with one short line. A word
 * is a random piece, or two pieces with a '=' between. */
TEST(random_lines_end_well)
{
    Random random = {1};
    int understood = 0, refused = 0;
    for (int line = 0; line < 50000; line++) {
        char words[5][80], *argv[7] = {"elasto"}, message[512] = "";
        int argc = 1 + random_below(&random, 6);
        Options options;
        for (int i = 1; i < argc; i++) {
            argv[i] = strcpy(words[i - 1], "");
            append_random_piece(&random, argv[i]);
            if (random_below(&random, 8) == 0)
                append_random_piece(&random, strcat(argv[i], "="));
        }
        Status status =
            options_parse(argc, argv, line % 5, &options, MESSAGE(message));
        understood += status == STATUS_OK;
        refused += status == STATUS_INVALID_INPUT;
        if (status == STATUS_OK) {
            CHECK(options.scene && options.panes >= 1);
            CHECK(options.timestep >= 1e-30 && options.timestep <= 1e30);
            CHECK(options.segments >= 1 && options.segments <= 4096);
        } else {
            CHECK(message[0] && strlen(message) < 500);
            CHECK(!strpbrk(message, "\n\033"));
        }
    }
    print_message("%d understood, %d refused\n", understood, refused);
    CHECK(understood > 1000 && refused > 1000);
    CHECK(understood + refused == 50000);
}

/* Control characters of a text become '?' in a message. */
TEST(texts_become_one_line)
{
    static const char *const rows[][2] = {
        {"a\nb\tc\177\033", "a?b?c??"},
        /* UTF-8 stays: signs of degree and micro, an emoji */
        {"5\302\260 2\302\265m", "5\302\260 2\302\265m"},
        {"\360\237\231\202", "\360\237\231\202"}};
    char line[16];
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        snprintf(line, sizeof line, "%s", rows[i][0]);
        replace_control_characters(line);
        assert_string_equal(line, rows[i][1]);
    }
}

/* The help has each scene, its number, and each option, in rows of at most 80
 * letters; a default value that it names is the default. */
TEST(help_fits_a_terminal)
{
    char line[128], text[8192] = "", word[40], message[512];
    char *argv[] = {"elasto", word, NULL};
    Options options, usual;
    CHECK_OK(options_parse(1, argv, false, &usual, MESSAGE(message)));
    const char *help = text;
    FILE *file = tmpfile();
    options_print_help(file);
    rewind(file);
    CHECK(fread(text, 1, sizeof text, file) < sizeof text);
    fclose(file);
    CHECK(strncmp(help, "usage: ", 7) == 0);
    for (const OptionRow *row = option_rows; row->name; row++) {
        snprintf(line, sizeof line, "\n  --%s%s%s", row->name,
                 row->placeholder ? " " : "",
                 row->placeholder ? row->placeholder : "");
        const char *at = strstr(help, row->name[0] ? line : row->help);
        CHECK(at != NULL);
        const char *next = strstr(at + 1, "\n  --");
        const char *value = strstr(at, " [");
        if (row->name[0] && value && next && value < next && value[2] != 'P') {
            snprintf(word, sizeof word, "--%s=%.*s", row->name,
                     (int)strcspn(value, "]") - 2, value + 2);
            /* stored even if refused because another option is missing */
            options_parse(2, argv, false, &options, MESSAGE(message));
            CHECK(options.number[row->slot] == usual.number[row->slot]);
        }
    }
    for (const Scene *scene = scenes; scene->name; scene++) {
        snprintf(line, sizeof line, " %-15s  %s\n", scene->name,
                 scene->description);
        CHECK(strstr(help, line) != NULL);
        sscanf(strstr(help, line) - 2, "%39s", word);
        CHECK_OK(options_parse(2, argv, false, &options, MESSAGE(message)));
        CHECK(options.scene == scene);
    }
    for (const char *end; *help; help = end + 1) {
        end = strchr(help, '\n');
        CHECK(end > help && end[-1] != ' ');
        CHECK_AT_MOST(end - help, 80);
    }
}

TESTS(NULL, NULL)
