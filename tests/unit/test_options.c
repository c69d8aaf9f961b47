/* The command line: defaults, every option, and what is refused. */
#include "testing.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "scenes/one_line.h"
#include "scenes/options.h"
#include "scenes/scene.h"

/* Words of a line, separated by single spaces; "''" is an empty one. */
static Status parse(const char *line, Options *options, char *message)
{
    static char copy[1024];
    char *argv[32] = {(char[]){"elasto"}};
    int argc = 1;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " ")) {
        if (strcmp(word, "''") == 0)
            word[0] = '\0';
        argv[argc++] = word;
    }
    message[0] = '\0';
    return options_parse(argc, argv, options, message, 512);
}

static Options parse_good(const char *line)
{
    Options options;
    char message[512];
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
    CHECK(options.solver == SOLVER_AUTO);
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
    {"--segments 1.5e0", {"--segments", "'1.5e0'", "1 to 4096"}},
    {"--segments 99999999999999999999", {"--segments", "'9999", "1 to 4096"}},
    {"--segments 4294967300", {"--segments", "'4294967300'", "1 to 4096"}},
    {"--steps -1", {"--steps", "'-1'", "0 to 1e18"}},
    {"--steps 1.5", {"--steps", "'1.5'", "0 to 1e18"}},
    {"--steps 9223372036854775808", {"--steps", "'92233", "0 to 1e18"}},
    {"--steps ten", {"--steps", "'ten'", "0 to 1e18"}},
    {"--steps \t5", {"--steps", "'?5'", "0 to 1e18"}},
    {"--steps \n5", {"--steps", "'?5'", "0 to 1e18"}},
    {"--side 0", {"--side", "'0'", "1e-30 to 1e30"}},
    {"--side -1", {"--side", "'-1'", "1e-30 to 1e30"}},
    {"--side nan", {"--side", "'nan'", "1e-30 to 1e30"}},
    {"--side inf", {"--side", "'inf'", "1e-30 to 1e30"}},
    {"--side -0", {"--side", "'-0'", "1e-30 to 1e30"}},
    {"--side 1m", {"--side", "'1m'", "1e-30 to 1e30"}},
    {"--side 1,5", {"--side", "'1,5'", "1e-30 to 1e30"}},
    {"--density 0", {"--density", "'0'", "1e-30 to 1e30"}},
    {"--density -5", {"--density", "'-5'", "1e-30 to 1e30"}},
    {"--density ''", {"--density", "''", "1e-30 to 1e30"}},
    {"--density 1e999", {"--density", "'1e999'", "1e-30 to 1e30"}},
    {"--stiffness 0", {"--stiffness", "'0'", "1e-30 to 1e30"}},
    {"--stiffness -1e5", {"--stiffness", "'-1e5'", "1e-30 to 1e30"}},
    {"--stiffness 1e5J", {"--stiffness", "'1e5J'", "1e-30 to 1e30"}},
    {"--stiffness infinity", {"--stiffness", "'infinity'", "1e-30 to 1e30"}},
    {"--stretch nan", {"--stretch", "'nan'", "-1e200 to 1e200"}},
    {"--stretch -inf", {"--stretch", "'-inf'", "-1e200 to 1e200"}},
    {"--stretch 1.4.1", {"--stretch", "'1.4.1'", "-1e200 to 1e200"}},
    {"--stretch -", {"--stretch", "'-'", "-1e200 to 1e200"}},
    {"--stretch e5", {"--stretch", "'e5'", "-1e200 to 1e200"}},
    {"--timestep 0", {"--timestep", "'0'", "1e-30 to 1e30"}},
    {"--timestep -0.1", {"--timestep", "'-0.1'", "1e-30 to 1e30"}},
    {"--timestep 1e-400", {"--timestep", "'1e-400'", "1e-30 to 1e30"}},
    {"--timestep NAN", {"--timestep", "'NAN'", "1e-30 to 1e30"}},
    {"--timestep 0.004s", {"--timestep", "'0.004s'", "1e-30 to 1e30"}},
    {"--tolerance 0", {"--tolerance", "'0'", "1e-300 to 1e300"}},
    {"--tolerance -1", {"--tolerance", "'-1'", "1e-300 to 1e300"}},
    {"--tolerance +-1", {"--tolerance", "'+-1'", "1e-300 to 1e300"}},
    {"--tolerance nan(1)", {"--tolerance", "'nan(1)'", "1e-300 to 1e300"}},
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
    {"--unheard-of", {"--unheard-of", "--help", ""}},
    {"-y", {"-y", "--help", ""}},
    {"--headless=yes", {"--headless", "", ""}},
    {"circles", {"'circles'", "--list", ""}},
    {"Square", {"'Square'", "--list", ""}},
    {"''", {"''", "--list", ""}},
    {"square square", {"'square'", "one scene", ""}},
    {"square 7", {"'7'", "one scene", ""}},
    {"--ground 0,1,0,-1 --ground 0,1,0,-2 --ground 0,1,0,-3 --ground 0,1,0,-4 "
     "--ground 0,1,0,-5 --ground 0,1,0,-6 --ground 0,1,0,-7 --ground 0,1,0,-8 "
     "--ground 0,1,0,-9",
     {"--ground", "'0,1,0,-9'", "at most 8"}},
    {"-- --segments", {"'--segments'", "--list", ""}},
    {"--segments 4 nothing --side 2", {"'nothing'", "--list", ""}},
};

/* What people type who have not read the manual, and what they are told. */
static const BadLine hopeful_lines[] = {
    {"--dt 0.01", {"no option --dt;", "did you mean --timestep?", ""}},
    {"--dt=0.01", {"no option --dt;", "did you mean --timestep?", ""}},
    {"-dt 0.01", {"no option -dt;", "did you mean --timestep?", ""}},
    {"--h 0.01", {"no option --h;", "did you mean --timestep?", ""}},
    {"--time-step 0.01", {"--time-step;", "did you mean --timestep?", ""}},
    {"--timestpe 0.01", {"--timestpe;", "did you mean --timestep?", ""}},
    {"--step-size 1", {"--step-size;", "did you mean --timestep?", ""}},
    {"--n 8", {"no option --n;", "did you mean --segments?", ""}},
    {"-n 8", {"no option -n;", "did you mean --segments?", ""}},
    {"--n_seg 8", {"no option --n_seg;", "did you mean --segments?", ""}},
    {"--resolution 8", {"--resolution;", "did you mean --segments?", ""}},
    {"--sgements 8", {"--sgements;", "did you mean --segments?", ""}},
    {"--segment5", {"--segment5;", "did you mean --segments?", ""}},
    {"--SEGMENTS 8", {"--SEGMENTS;", "did you mean --segments?", ""}},
    {"-segments 8", {"no option -segments;", "did you mean --segments?", ""}},
    {"--sdie 2", {"--sdie;", "did you mean --side?", ""}},
    {"--side_len 2", {"--side_len;", "did you mean --side?", ""}},
    {"--length 2", {"--length;", "did you mean --side?", ""}},
    {"--rho 500", {"no option --rho;", "did you mean --density?", ""}},
    {"--mass 500", {"no option --mass;", "did you mean --density?", ""}},
    {"--k 1e5", {"no option --k;", "did you mean --stiffness?", ""}},
    {"-k 1e5", {"no option -k;", "did you mean --stiffness?", ""}},
    {"--youngs-modulus 1", {"--youngs-", "did you mean --stiffness?", ""}},
    {"--stifness 1e5", {"--stifness;", "did you mean --stiffness?", ""}},
    {"--initial_stretch 2", {"--initial_", "did you mean --stretch?", ""}},
    {"--TOL 1e-3", {"--TOL;", "did you mean --tolerance?", ""}},
    {"--tolerence 1e-3", {"--tolerence;", "did you mean --tolerance?", ""}},
    {"--eps 1e-3", {"no option --eps;", "did you mean --tolerance?", ""}},
    {"--method bdf2", {"no option --method", "did you mean --integrator?", ""}},
    {"--scheme bdf2", {"no option --scheme", "did you mean --integrator?", ""}},
    {"--verlet", {"no option --verlet;", "did you mean --integrator verlet?"}},
    {"--be", {"no option --be;", "did you mean --integrator backward-euler?"}},
    {"--projection none", {"--projection;", "did you mean --filter?", ""}},
    {"--no-projection", {"did you mean --filter none?", "", ""}},
    {"--linesearch none", {"--linesearch;", "did you mean --line-search?", ""}},
    {"--no-line-search", {"did you mean --line-search none?", "", ""}},
    {"--num-steps 5", {"--num-steps;", "did you mean --steps?", ""}},
    {"--iterations 5", {"--iterations;", "did you mean --steps?", ""}},
    {"--no-window", {"--no-window;", "did you mean --headless?", ""}},
    {"--no-gui", {"no option --no-gui;", "did you mean --headless?", ""}},
    {"--head-less", {"--head-less;", "did you mean --headless?", ""}},
    {"-o out.csv", {"no option -o;", "did you mean --states?", ""}},
    {"--output out.csv", {"--output;", "did you mean --states?", ""}},
    {"--png d", {"no option --png;", "did you mean --frames?", ""}},
    {"--log-file l", {"--log-file;", "did you mean --log?", ""}},
    {"-q", {"no option -q;", "did you mean --quiet?", ""}},
    {"--silent", {"no option --silent;", "did you mean --quiet?", ""}},
    {"--usage", {"no option --usage;", "did you mean --help?", ""}},
    {"--scenes", {"no option --scenes;", "did you mean --list?", ""}},
    {"--scene circle", {"no option --scene;", "did you mean --list?", ""}},
    {"--circle", {"no option --circle;", "elasto circle?", ""}},
    {"circles", {"'circles'", "did you mean circle?", "--list"}},
    {"sqare", {"'sqare'", "did you mean square?", "--list"}},
    {"Square", {"'Square'", "did you mean square?", "--list"}},
    {"land", {"'land'", "did you mean landscape?", "--list"}},
    {"0", {"'0'", "from 1 to ", "--list"}},
    {"99", {"'99'", "from 1 to ", "--list"}},
    {"--segments 8 0.01", {"'0.01'", "--list", ""}},
    {"segments 8", {"'segments'", "did you mean --segments?", ""}},
    {"n_seg=8", {"'n_seg=8'", "did you mean --segments 8?", ""}},
    {"h=0.01", {"'h=0.01'", "did you mean --timestep 0.01?", ""}},
    {"bdf2", {"'bdf2'", "did you mean --integrator bdf2?", ""}},
    {"implicit-euler", {"did you mean --integrator backward-euler?", "", ""}},
    {"--integrator euler", {"'euler'", "did you mean backward-euler?", ""}},
    {"--integrator BE", {"'BE'", "did you mean backward-euler?", ""}},
    {"--integrator Verlet", {"'Verlet'", "did you mean verlet?", ""}},
    {"--integrator sympletic-euler", {"did you mean symplectic-euler?"}},
    {"--filter off", {"'off'", "did you mean none?", ""}},
    {"--filter psd", {"'psd'", "did you mean clamp?", ""}},
    {"--filter on_demand", {"'on_demand'", "did you mean on-demand?", ""}},
    {"--line-search armijo", {"'armijo'", "did you mean backtrack?", ""}},
    {"--line-search false", {"'false'", "did you mean none?", ""}},
    {"--solver newtons", {"'newtons'", "did you mean newton?", ""}},
    {"--st 1", {"--stiffness", "--stretch", "--states"}},
    {"--s=1", {"no option --s;", "did you mean --stretch?", ""}},
    {"--headless=1", {"--headless=1", "takes no value", ""}},
    {"--cfl 0.5", {"no option --cfl;", "did you mean --timestep?", ""}},
    {"-t 0.01", {"no option -t;", "did you mean --timestep?", ""}},
    {"--time 3", {"no option --time;", "did you mean --steps?", ""}},
    {"--maxiter 50", {"no option --maxiter;", "did you mean --tolerance?", ""}},
    {"--no-gravity", {"did you mean --gravity 0?", "", ""}},
    {"--gravity -9.81", {"--gravity: '-9.81'", "from 0 to", "downwards"}},
    {"--no-friction", {"did you mean --friction 0?", "", ""}},
    {"--restitution 1", {"--restitution;", "did you mean --damping?", ""}},
    {"--start-paused", {"--start-paused;", "did you mean --paused?", ""}},
    {"--screenshot", {"--screenshot;", "did you mean --frames?", ""}},
    {"--debug", {"no option --debug;", "did you mean --log?", ""}},
    {"--tutorial", {"--tutorial;", "did you mean --lecture?", ""}},
    {"--video o.mp4", {"--video;", "did you mean --film?", ""}},
    {"--output o.webm", {"--output;", "did you mean --film?", ""}},
    {"--output=o.gif", {"--output;", "did you mean --film?", ""}},
    {"--output o.csv", {"--output;", "did you mean --states?", ""}},
    {"--resolution 1920x1080", {"--resolution;", "mean --size?", ""}},
    {"--resolution 16", {"--resolution;", "did you mean --segments?", ""}},
    {"--seed 3", {"no option --seed;", "there is none", "random"}},
    {"--fps 30", {"no option --fps;", "there is none", "60"}},
    {"--timestep 5ms", {"'5ms' is not", "in s", "; write 0.005"}},
    {"--timestep 1/60", {"'1/60' is not", "in s", "; write 0.01667"}},
    {"--stretch 140%", {"'140%' is not", "", "; write 1.4"}},
    {"--side 20cm", {"'20cm' is not", "in m", "; write 0.2"}},
    {"--wall 1,0", {"no option --wall;", "did you mean --ground?", ""}},
    {"--mu 0.3", {"no option --mu;", "did you mean --friction?", ""}},
    {"--plasticity", {"--plasticity;", "did you mean --yield?", ""}},
    {"--contact", {"--contact;", "did you mean the scene: elasto drop?", ""}},
    {"squash", {"'squash'", "did you mean squeeze?", "--list"}},
    {"fracture", {"'fracture'", "did you mean tear?", "--list"}},
    {"contact", {"'contact'", "did you mean drop?", "--list"}},
    {"explode", {"'explode'", "did you mean explosion?", "--list"}},
    {"help", {"'help'", "did you mean --help?", ""}},
    {"lecture", {"'lecture'", "did you mean --lecture?", ""}},
    {"--integrator leapfrog", {"'leapfrog'", "did you mean verlet?", ""}},
    {"--integrator crank-nicolson", {"did you mean midpoint?", "", ""}},
    {"--integrator bdf1", {"'bdf1'", "did you mean backward-euler?", ""}},
    {"--integrator rk4", {"'rk4' is none of: backward-euler,", "avf4", ""}},
    {"--solver cholmod", {"'cholmod'", "did you mean newton?", ""}},
    {"--solver amg", {"'amg'", "did you mean multigrid?", ""}},
    {"--filter eigen", {"'eigen'", "did you mean clamp?", ""}},
    {"--size 1200", {"--size", "'1200'", "WIDTHxHEIGHT"}},
    {"--lecture overshot", {"'overshot'", "did you mean overshoot", ""}},
    {"drop --integrator avf", {"no contact", "only backward-euler", ""}},
    {"circle --gravity 9", {"--gravity", "'circle'", "no body that falls"}},
    {"square circle", {"'circle'", "one scene at a time", ""}},
    {"-h=1", {"-h=1", "takes no value", ""}},
    {"--steps --headless", {"--steps", "missing", ""}},
    {"--log --quiet", {"--log", "missing", ""}},
    {"landscape --start 3", {"--start", "'3'", "X,Y"}},
    {"overshoot --start x", {"--start", "'x'", "-1e300 to 1e300"}},
};

static void check_bad_line(const BadLine *bad)
{
    Options options;
    char message[512];
    Status status = parse(bad->line, &options, message);
    bool names = message[0] != '\0' && !strchr(message, '\n');
    for (int i = 0; i < 3; i++)
        names = names && (!bad->names[i] || strstr(message, bad->names[i]));
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

static void hopeful_lines_are_answered(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < sizeof hopeful_lines / sizeof *hopeful_lines; i++)
        check_bad_line(&hopeful_lines[i]);
}

static void other_words_are_understood(void **unused)
{
    (void)unused;
    static const char *const words[][2] = {
        {"implicit-euler", "backward-euler"}, {"be", "backward-euler"},
        {"explicit-euler", "forward-euler"},  {"fe", "forward-euler"},
        {"se", "symplectic-euler"},
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        char line[64];
        snprintf(line, sizeof line, "--integrator %s", words[i][0]);
        assert_string_equal(parse_good(line).integrator->name, words[i][1]);
    }
    for (int i = 0; scenes[i].name; i++) {
        char line[16];
        snprintf(line, sizeof line, "%d", i + 1);
        CHECK(parse_good(line).scene == &scenes[i]);
    }
    CHECK(parse_good("-h").help && parse_good("-v").version);
    CHECK(parse_good("-V").version);
    CHECK(parse_good("--segments 1e2").segments == 100);
    CHECK(parse_good("--steps 1e3").steps == 1000);
    CHECK(parse_good("--steps 4.0").steps == 4);
    CHECK(parse_good("--steps 999999999999999999").steps == 999999999999999999);
    CHECK(parse_good("--seg 3 --quie").segments == 3);
    Options options = parse_good("overshoot --start 3");
    CHECK(options.start[0] == 3 && options.start[1] == 0);
    options = parse_good("overshoot --start 3,4");
    CHECK(options.start[0] == 3 && options.start[1] == 4);
    options = parse_good("--stretch -1.5 --log -x");
    CHECK(options.stretch == -1.5);
    assert_string_equal(options.log, "-x");
}

/* A value of any length and of any bytes: one line, and the range is there. */
static void long_values_are_cut(void **unused)
{
    (void)unused;
    static char value[5000];
    char program[] = "elasto", option[] = "--side", message[512];
    char *argv[] = {program, option, value, NULL};
    Options options;
    for (int length = 1; length < 4999; length += length < 700 ? 1 : 500) {
        for (int i = 0; i < length; i++)
            value[i] = (char)("x\n\033\302\233\303\244"[i % 7]);
        value[length] = '\0';
        memset(message, 'y', sizeof message);
        CHECK_STATUS(options_parse(3, argv, &options, message, sizeof message),
                     STATUS_INVALID_INPUT);
        CHECK(strlen(message) < 200 && strstr(message, "--side"));
        CHECK(strstr(message, "a number from 1e-30 to 1e30, in m"));
        CHECK(!strpbrk(message, "\n\033") && !strstr(message, "\302\233"));
    }
    memset(message, 'y', sizeof message);
    CHECK_STATUS(options_parse(3, argv, &options, message, 20),
                 STATUS_INVALID_INPUT);
    CHECK(strlen(message) == 19 && message[20] == 'y');
}

/* A piece of a random line. */
static const char *random_word(unsigned *seed, char *word, size_t size)
{
    static const char *const pieces[] = {
        "segments", "side",     "st",       "timestep", "integrator",
        "filter",   "start",    "steps",    "lo",       "headless",
        "h",        "dt",       "circle",   "3",        "-1",
        "1e3",      "1e-300",   "inf",      "0x1",      "1,2",
        "",         "=",        "--",       "-",        ",",
        "none",     "clamp",    "be",       "-h",       "--help",
        "\n",       "\303\274", "\302\233", "%s%n",     "verlet,avf",
        "top-left",
    };
    static const char *const good[] = {
        "--segments=8",   "--side=2",      "--integrator=fe", "--steps=1e3",
        "--timestep=0.1", "--quiet",       "--filter=none",   "--stif=1e3",
        "--log=x",        "--stretch=-.5", "--headless",      "-h",
    };
    word[0] = '\0';
    if (*seed >> 30) { /* three of four */
        snprintf(word, size, "%s",
                 good[(*seed >> 12) % (sizeof good / sizeof *good)]);
        return word;
    }
    if (*seed >> 9 & 3)
        snprintf(word, size, "--");
    for (int i = 0; i < 1 + (int)(*seed >> 8) % 3; i++) {
        *seed = *seed * 1664525u + 1013904223u;
        size_t used = strlen(word);
        snprintf(word + used, size - used, "%s%s", i > 1 ? "=" : "",
                 pieces[(*seed >> 10) % (sizeof pieces / sizeof *pieces)]);
    }
    return word;
}

/* Whatever is typed is either understood, or answered by one short line. */
static void random_lines_end_well(void **unused)
{
    (void)unused;
    unsigned seed = 1;
    int understood = 0, refused = 0;
    for (int line = 0; line < 50000; line++) {
        char words[6][80], *argv[8] = {"elasto"}, message[512];
        seed = seed * 1664525u + 1013904223u;
        int argc = 1 + (int)(seed >> 20) % 6;
        Options options;
        for (int i = 1; i < argc; i++) {
            seed = seed * 1664525u + 1013904223u;
            random_word(&seed, words[i - 1], sizeof words[0]);
            argv[i] = words[i - 1];
        }
        argv[argc] = NULL;
        message[0] = '\0';
        Status status =
            line % 2
                ? options_parse(argc, argv, &options, message, sizeof message)
                : options_parse_pane(argc, argv, line % 5, &options, message,
                                     sizeof message);
        if (status == STATUS_OK) {
            understood++;
            CHECK(options.scene && options.panes >= 1);
            CHECK(options.timestep >= 1e-30 && options.timestep <= 1e30);
            CHECK(options.segments >= 1 && options.segments <= 4096);
            continue;
        }
        refused++;
        CHECK_STATUS(status, STATUS_INVALID_INPUT);
        CHECK(message[0] && strlen(message) < 500);
        CHECK(!strpbrk(message, "\n\033") && !strstr(message, "\302\233"));
    }
    print_message("%d understood, %d refused\n", understood, refused);
    CHECK(understood > 1000 && refused > 1000);
}

/* What a message may show of a text. */
static void texts_become_one_line(void **unused)
{
    (void)unused;
    char line[12];
    one_line("a\nb\tc\177\033", line, sizeof line);
    assert_string_equal(line, "a?b?c??");
    one_line("0123456789012", line, sizeof line);
    assert_string_equal(line, "0123...9012");
    one_line("01234567890", line, sizeof line);
    assert_string_equal(line, "01234567890");
    one_line("012\303\274456789\303\274\303\274", line, sizeof line);
    assert_string_equal(line, "012...\303\274\303\274"); /* whole letters */
    one_line("0123456789\303\274abc", line, sizeof line);
    assert_string_equal(line, "0123...abc"); /* no half of one */
    /* controls above ASCII, and as single bytes; what turns writing around;
     * bytes that are no text: in the wrong place, too long, cut off */
    static const char *const hidden[] = {
        "\302\200",     "\302\205",     "\302\237",     "\200",
        "\233",         "\237",         "\330\234",     "\342\200\216",
        "\342\200\217", "\342\200\252", "\342\200\256", "\342\201\246",
        "\342\201\251", "\377",         "\342\200\250"};
    for (size_t i = 0; i < sizeof hidden / sizeof *hidden; i++) {
        char text[12];
        snprintf(text, sizeof text, "a%sb", hidden[i]);
        one_line(text, text, sizeof text);
        assert_string_equal(text, "a?b");
    }
    one_line("\303\050", line, sizeof line);
    assert_string_equal(line, "?(");
    one_line("\300\233a\342\200", line, sizeof line);
    assert_string_equal(line, "??a??");
    one_line("\302\240\342\200\247\342\201\252", line, sizeof line);
    assert_string_equal(line, "\302\240\342\200\247\342\201\252");
    one_line(NULL, line, sizeof line);
    assert_string_equal(line, "");
}

/* Options of pane 0, 1, ... of a line with lists. */
static void lists_are_side_by_side(void **unused)
{
    (void)unused;
    char *argv[] = {"elasto", "--timestep", "0.1,0.2", "--filter",
                    "clamp,none"};
    const double h[] = {0.1, 0.1, 0.2, 0.2};
    char message[512];
    Options options;
    for (int pane = 0; pane < 4; pane++) {
        CHECK_STATUS(options_parse_pane(5, argv, pane, &options, message,
                                        sizeof message),
                     STATUS_OK);
        CHECK(options.panes == 4 && options.timestep == h[pane]);
        CHECK(options.filter == (pane % 2 ? FILTER_NONE : FILTER_CLAMP));
    }
    CHECK_STATUS(options_parse(5, argv, &options, message, sizeof message),
                 STATUS_INVALID_INPUT);
    argv[2] = "1,2,3,4";
    CHECK_STATUS(
        options_parse_pane(5, argv, 0, &options, message, sizeof message),
        STATUS_INVALID_INPUT);
    CHECK(strstr(message, "more than 6 side by side") != NULL);
    argv[2] = "1,,2";
    CHECK_STATUS(
        options_parse_pane(5, argv, 2, &options, message, sizeof message),
        STATUS_INVALID_INPUT);
    CHECK(strstr(message, "--timestep: ''") != NULL);
}

/* The value in brackets is one that the option takes. */
static void help_tells_values_that_are_read(void **unused)
{
    (void)unused;
    Options options = parse_good("slope");
    const char *name = NULL;
    int values = 0;
    for (const char *at = options_help(); *at; at++) {
        char option[32], value[32], message[512];
        if (strncmp(at, "\n  --", 5) == 0)
            name = at + 5;
        if (!name || sscanf(at, "[%30[-.0-9e]]", value) != 1)
            continue;
        snprintf(option, sizeof option, "%.*s", (int)strcspn(name, " "), name);
        Options trial = options;
        CHECK_STATUS(
            options_set(&trial, option, value, message, sizeof message),
            STATUS_OK);
        values++;
    }
    CHECK(values > 10);
}

/* What is typed in the window means a number in the option's own unit. */
static void numbers_are_worked_out(void **unused)
{
    (void)unused;
    static const char *const rows[][3] = {
        {"timestep", "1/60", "0.016666666666666666"},
        {"timestep", "0,02", "0.02"},
        {"timestep", "7ms", "0.007"},
        {"timestep", "1/8 s", "0.125"},
        {"timestep", "4e3us", "0.004"},
        {"timestep", "-3", "-3"},
        {"timestep", "4 m", "4 m"},
        {"timestep", "0x10", "0x10"},
        {"timestep", "1/0", "1/0"},
        {"timestep", "inf", "inf"},
        {"timestep", "", ""},
        {"tolerance", "5mm/s", "0.005"},
        {"side", "20 cm", "0.2"},
        {"stiffness", "2e5 J/m^2", "200000"},
        {"stretch", "140%", "1.4"},
        {"filter", "abs", "abs"},
        {"nothing", "1/2", "1/2"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char value[64];
        options_meant(rows[i][0], rows[i][1], value, sizeof value);
        assert_string_equal(value, rows[i][2]);
    }
}

/* Rows of 80, and every option of the contract. */
static void help_fits_a_terminal(void **unused)
{
    (void)unused;
    const char *options[] = {
        "--segments N", "--side L",     "--density R",     "--stiffness K",
        "--stretch S",  "--timestep H", "--tolerance T",   "--integrator I",
        "--solver S",   "--filter F",   "--line-search L", "--steps N",
        "--headless",   "--frames DIR", "--states FILE",   "--log FILE",
        "--quiet",      "--help, -h",   "--version, -v",   "--list",
        "SCENE",        "--start X",    "1 ... 4096 [4]",  "J/m^2 [1e5]",
        "clamp, none",  "[0.004]",
    };
    const char *help = options_help();
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        if (!strstr(help, options[i]))
            print_error("--help does not name %s\n", options[i]);
        CHECK(strstr(help, options[i]) != NULL);
    }
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        CHECK(strstr(help, row->name) != NULL);
    for (int i = 0; scenes[i].name; i++) { /* a line each, with its number */
        char line[128];
        snprintf(line, sizeof line, "\n  %2d %-15s  %s\n", i + 1,
                 scenes[i].name, scenes[i].sentence);
        CHECK(strstr(help, line) != NULL);
    }
    int lines = 0;
    for (const char *line = help; *line; lines++) {
        const char *end = strchr(line, '\n');
        CHECK(end != NULL);
        CHECK_AT_MOST(end - line, 80);
        CHECK(end > line && end[-1] != ' ');
        line = end + 1;
    }
    CHECK(lines > 20 && strcmp(help, options_help()) == 0);
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
        cmocka_unit_test(hopeful_lines_are_answered),
        cmocka_unit_test(other_words_are_understood),
        cmocka_unit_test(long_values_are_cut),
        cmocka_unit_test(random_lines_end_well),
        cmocka_unit_test(texts_become_one_line),
        cmocka_unit_test(lists_are_side_by_side),
        cmocka_unit_test(help_tells_values_that_are_read),
        cmocka_unit_test(numbers_are_worked_out),
        cmocka_unit_test(help_fits_a_terminal),
    };
    return cmocka_run_group_tests_name("options", tests, NULL, NULL);
}
