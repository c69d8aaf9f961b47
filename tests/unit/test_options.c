/* The command line: defaults, every option, and what is refused. */
#include "testing.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "scenes/options.h"
#include "scenes/scene.h"

/* Words of a line, separated by single spaces; "''" is an empty one. */
static Status parse(const char *line, Options *options, char *message)
{
    static char copy[256];
    char *argv[32] = {(char[]){"elasto"}};
    int argc = 1;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " ")) {
        if (strcmp(word, "''") == 0)
            word[0] = '\0';
        argv[argc++] = word;
    }
    message[0] = '\0';
    return options_parse(argc, argv, options, message, 256);
}

static Options parse_good(const char *line)
{
    Options options;
    char message[256];
    Status status = parse(line, &options, message);
    if (status)
        print_error("%s: %s\n", line, message);
    CHECK_STATUS(status, STATUS_OK);
    return options;
}

static void defaults_are_the_slides(void **unused)
{
    (void)unused;
    Options options = parse_good("");
    assert_string_equal(options.scene->name, "square");
    CHECK(options.segments == 4 && options.side == 1);
    CHECK(options.density == 1000 && options.stiffness == 1e5);
    CHECK(options.stretch == 1.4 && options.timestep == 0.004);
    CHECK(options.tolerance == 1e-2 && options.steps == -1);
    CHECK(options.integrator == NULL); /* the scene's choice */
    CHECK(options.solver == SOLVER_NEWTON);
    CHECK(options.filter == FILTER_CLAMP);
    CHECK(options.line_search == LINE_SEARCH_BACKTRACK);
    CHECK(!options.frames && !options.states && !options.log);
    CHECK(!options.headless && !options.quiet && !options.help);
    CHECK(!options.version && !options.list);
}

static void numbers_are_read(void **unused)
{
    (void)unused;
    CHECK(parse_good("--segments 1").segments == 1);
    CHECK(parse_good("--segments 4096").segments == 4096);
    CHECK(parse_good("--segments=16").segments == 16);
    CHECK(parse_good("--side 2.5").side == 2.5);
    CHECK(parse_good("--density 1e-3").density == 1e-3);
    CHECK(parse_good("--stiffness 3E7").stiffness == 3e7);
    CHECK(parse_good("--stretch 0").stretch == 0);
    CHECK(parse_good("--stretch -1.5").stretch == -1.5);
    CHECK(parse_good("--stretch=-.5").stretch == -0.5);
    CHECK(parse_good("--timestep 1e-9").timestep == 1e-9);
    CHECK(parse_good("--tolerance 1e-300").tolerance == 1e-300);
    CHECK(parse_good("--steps 0").steps == 0);
    CHECK(parse_good("--steps 123456789").steps == 123456789);
    CHECK(parse_good("--side 2 --side 3").side == 3); /* the last one counts */
}

static void names_are_read(void **unused)
{
    (void)unused;
    for (const IntegratorMethod *row = integrator_methods; row->name; row++) {
        char line[64];
        snprintf(line, sizeof line, "--integrator %s", row->name);
        CHECK(parse_good(line).integrator == row);
    }
    for (int i = 0; i < SOLVER_COUNT; i++) {
        char line[64];
        snprintf(line, sizeof line, "--solver %s", solver_name((Solver)i));
        CHECK((int)parse_good(line).solver == i);
    }
    for (int i = 0; i < FILTER_COUNT; i++) {
        char line[64];
        snprintf(line, sizeof line, "--filter %s", filter_name((Filter)i));
        CHECK((int)parse_good(line).filter == i);
    }
    for (int i = 0; i < LINE_SEARCH_COUNT; i++) {
        char line[64];
        snprintf(line, sizeof line, "--line-search %s",
                 line_search_name((LineSearch)i));
        CHECK((int)parse_good(line).line_search == i);
    }
    CHECK(parse_good("--filter none").filter == FILTER_NONE);
    CHECK(parse_good("--line-search none").line_search == LINE_SEARCH_NONE);
}

static void files_and_switches_are_read(void **unused)
{
    (void)unused;
    assert_string_equal(parse_good("--frames a/b").frames, "a/b");
    assert_string_equal(parse_good("--states -").states, "-");
    assert_string_equal(parse_good("--log x.csv").log, "x.csv");
    CHECK(parse_good("--headless").headless);
    CHECK(parse_good("--quiet").quiet);
    CHECK(parse_good("--help").help);
    CHECK(parse_good("--version").version);
    CHECK(parse_good("--list").list);
}

static void scenes_stand_anywhere(void **unused)
{
    (void)unused;
    for (const Scene *scene = scenes; scene->name; scene++) {
        CHECK(parse_good(scene->name).scene == scene);
        CHECK(scene_find(scene->name) == scene && scene->sentence[0]);
        CHECK(scene->create != NULL);
    }
    CHECK(parse_good("--segments 3 square --side 2").segments == 3);
    CHECK(parse_good("--segments 3 square --side 2").side == 2);
    CHECK(scene_find("") == NULL);
}

/* The line, and what its message must name: option, value, range. */
typedef struct BadLine {
    const char *line;
    const char *names[3];
} BadLine;

static const BadLine bad_numbers[] = {
    {"--segments 0", {"--segments", "'0'", "1 to 4096"}},
    {"--segments 4097", {"--segments", "'4097'", "1 to 4096"}},
    {"--segments -4", {"--segments", "'-4'", "1 to 4096"}},
    {"--segments 4.5", {"--segments", "'4.5'", "1 to 4096"}},
    {"--segments 4x", {"--segments", "'4x'", "1 to 4096"}},
    {"--segments x", {"--segments", "'x'", "1 to 4096"}},
    {"--segments ''", {"--segments", "''", "1 to 4096"}},
    {"--segments 0x10", {"--segments", "'0x10'", "1 to 4096"}},
    {"--segments 1e2", {"--segments", "'1e2'", "1 to 4096"}},
    {"--segments 99999999999999999999", {"--segments", "'9999", "1 to 4096"}},
    {"--segments 4294967300", {"--segments", "'4294967300'", "1 to 4096"}},
    {"--steps -1", {"--steps", "'-1'", "0 or more"}},
    {"--steps 1.0", {"--steps", "'1.0'", "0 or more"}},
    {"--steps 9223372036854775808", {"--steps", "'92233", "0 or more"}},
    {"--steps ten", {"--steps", "'ten'", "0 or more"}},
    {"--steps \t5", {"--steps", "'?5'", "0 or more"}},
    {"--steps \n5", {"--steps", "'?5'", "0 or more"}},
    {"--side 0", {"--side", "'0'", "above 0"}},
    {"--side -1", {"--side", "'-1'", "above 0"}},
    {"--side nan", {"--side", "'nan'", "finite"}},
    {"--side inf", {"--side", "'inf'", "finite"}},
    {"--side -0", {"--side", "'-0'", "above 0"}},
    {"--side 1m", {"--side", "'1m'", "above 0"}},
    {"--side 1,5", {"--side", "'1,5'", "above 0"}},
    {"--density 0", {"--density", "'0'", "above 0"}},
    {"--density -5", {"--density", "'-5'", "above 0"}},
    {"--density ''", {"--density", "''", "above 0"}},
    {"--density 1e999", {"--density", "'1e999'", "finite"}},
    {"--stiffness 0", {"--stiffness", "'0'", "above 0"}},
    {"--stiffness -1e5", {"--stiffness", "'-1e5'", "above 0"}},
    {"--stiffness 1e5J", {"--stiffness", "'1e5J'", "above 0"}},
    {"--stiffness infinity", {"--stiffness", "'infinity'", "finite"}},
    {"--stretch nan", {"--stretch", "'nan'", "finite"}},
    {"--stretch -inf", {"--stretch", "'-inf'", "finite"}},
    {"--stretch 1.4.1", {"--stretch", "'1.4.1'", "finite"}},
    {"--stretch -", {"--stretch", "'-'", "finite"}},
    {"--stretch e5", {"--stretch", "'e5'", "finite"}},
    {"--timestep 0", {"--timestep", "'0'", "above 0"}},
    {"--timestep -0.1", {"--timestep", "'-0.1'", "above 0"}},
    {"--timestep 1e-400", {"--timestep", "'1e-400'", "above 0"}},
    {"--timestep NAN", {"--timestep", "'NAN'", "finite"}},
    {"--timestep 0.004s", {"--timestep", "'0.004s'", "above 0"}},
    {"--tolerance 0", {"--tolerance", "'0'", "above 0"}},
    {"--tolerance -1", {"--tolerance", "'-1'", "above 0"}},
    {"--tolerance +-1", {"--tolerance", "'+-1'", "above 0"}},
    {"--tolerance nan(1)", {"--tolerance", "'nan(1)'", "finite"}},
};

static const BadLine bad_words[] = {
    {"--integrator euler", {"--integrator", "'euler'", "backward-euler"}},
    {"--integrator ''", {"--integrator", "''", "forward-euler"}},
    {"--integrator Backward-Euler", {"--integrator", "'B", "symplectic-euler"}},
    {"--solver cg", {"--solver", "'cg'", "newton"}},
    {"--solver newto", {"--solver", "'newto'", "newton"}},
    {"--filter absolute", {"--filter", "'absolute'", "clamp, none"}},
    {"--filter clamped", {"--filter", "'clamped'", "clamp, none"}},
    {"--line-search wolfe", {"--line-search", "'wolfe'", "backtrack, none"}},
    {"--frames ''", {"--frames", "empty", ""}},
    {"--states ''", {"--states", "empty", ""}},
    {"--log ''", {"--log", "empty", ""}},
    {"--segments", {"--segments", "missing", ""}},
    {"--log", {"--log", "missing", ""}},
    {"--quiet --frames", {"--frames", "missing", ""}},
    {"--unknown", {"--unknown", "--help", ""}},
    {"-x", {"-x", "--help", ""}},
    {"--headless=yes", {"--headless", "", ""}},
    {"circles", {"'circles'", "--list", ""}},
    {"Square", {"'Square'", "--list", ""}},
    {"''", {"''", "--list", ""}},
    {"square square", {"'square'", "one scene", ""}},
    {"square 7", {"'7'", "one scene", ""}},
    {"-- --segments", {"'--segments'", "--list", ""}},
    {"--segments 4 nothing --side 2", {"'nothing'", "--list", ""}},
};

static void check_bad_line(const BadLine *bad)
{
    Options options;
    char message[256];
    Status status = parse(bad->line, &options, message);
    bool names = message[0] != '\0' && !strchr(message, '\n');
    for (int i = 0; i < 3; i++)
        names = names && strstr(message, bad->names[i]);
    if (status != STATUS_INVALID_INPUT || !names)
        print_error("%s: %s, '%s'\n", bad->line, status_name(status), message);
    CHECK_STATUS(status, STATUS_INVALID_INPUT);
    CHECK(names);
}

static void bad_numbers_are_refused(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < sizeof bad_numbers / sizeof *bad_numbers; i++)
        check_bad_line(&bad_numbers[i]);
}

static void bad_words_are_refused(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < sizeof bad_words / sizeof *bad_words; i++)
        check_bad_line(&bad_words[i]);
}

/* A value that does not fit the buffer is cut, and the buffer ends there. */
static void long_values_are_cut(void **unused)
{
    (void)unused;
    static char value[5000];
    char program[] = "elasto", option[] = "--side", message[40];
    char *argv[] = {program, option, value, NULL};
    Options options;
    memset(value, 'x', sizeof value - 1);
    memset(message, 'y', sizeof message);
    CHECK_STATUS(options_parse(3, argv, &options, message, 20),
                 STATUS_INVALID_INPUT);
    CHECK(strlen(message) == 19 && message[20] == 'y');
}

/* 24 rows of 80, and every option of the contract. */
static void help_fits_a_terminal(void **unused)
{
    (void)unused;
    const char *options[] = {
        "--segments N", "--side L",     "--density R",     "--stiffness K",
        "--stretch S",  "--timestep H", "--tolerance T",   "--integrator I",
        "--solver S",   "--filter F",   "--line-search L", "--steps N",
        "--headless",   "--frames DIR", "--states FILE",   "--log FILE",
        "--quiet",      "--help",       "--version",       "--list",
        "SCENE",
    };
    const char *help = options_help();
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        if (!strstr(help, options[i]))
            print_error("--help does not name %s\n", options[i]);
        CHECK(strstr(help, options[i]) != NULL);
    }
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        CHECK(strstr(help, row->name) != NULL);
    int lines = 0;
    for (const char *line = help; *line; lines++) {
        const char *end = strchr(line, '\n');
        CHECK(end != NULL);
        CHECK_AT_MOST(end - line, 80);
        line = end + 1;
    }
    CHECK_AT_MOST(lines, 24);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_the_slides),
        cmocka_unit_test(numbers_are_read),
        cmocka_unit_test(names_are_read),
        cmocka_unit_test(files_and_switches_are_read),
        cmocka_unit_test(scenes_stand_anywhere),
        cmocka_unit_test(bad_numbers_are_refused),
        cmocka_unit_test(bad_words_are_refused),
        cmocka_unit_test(long_values_are_cut),
        cmocka_unit_test(help_fits_a_terminal),
    };
    return cmocka_run_group_tests_name("options", tests, NULL, NULL);
}
