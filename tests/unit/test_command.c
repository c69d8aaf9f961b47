/* The program as a process: what it prints where, what it leaves in files and
 * its exit codes.  The program is named by ELASTO, else build/elasto.
 */
#include "test.h"
#include "testing.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { TEXT = 1 << 20 };

static char program[4096] = "build/elasto";
static char folder[] = "/tmp/elasto-test-XXXXXX"; /* for everything written */

/* What a run left behind. */
typedef struct Result {
    int code; /* exit code; -1: killed by a signal */
    char out[TEXT], error[TEXT];
} Result;

static Result result; /* large, so only one */

static void read_text(const char *name, char *text)
{
    FILE *file = fopen(name, "r");
    CHECK(file != NULL);
    text[fread(text, 1, TEXT - 1, file)] = '\0';
    fclose(file);
}

/* PROGRAM ARGUMENTS, in a shell whose working directory is the folder;
 * ARGUMENTS may redirect.  No display, so never a window. */
static void run(const char *arguments)
{
    static char command[8192];
    snprintf(command, sizeof command,
             "cd %s && unset DISPLAY WAYLAND_DISPLAY && "
             "( timeout 60 '%s' %s ) >out 2>error",
             folder, program, arguments);
    char path[64];
    int status = system(command);
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    snprintf(path, sizeof path, "%s/out", folder);
    read_text(path, result.out);
    snprintf(path, sizeof path, "%s/error", folder);
    read_text(path, result.error);
}

static void run_line(const char *format, ...)
{
    char line[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    run(line);
}

static void check_code(int expected)
{
    if (result.code != expected)
        print_error("exit code %d, expected %d; standard error: %s\n",
                    result.code, expected, result.error);
    CHECK(result.code == expected);
}

/* Lines that end with a newline. */
static int count_lines(const char *text)
{
    int lines = 0;
    for (; *text; text++)
        lines += *text == '\n';
    return lines;
}

/* Whether the folder has this file, not empty. */
static bool exists(const char *name)
{
    char path[4200];
    struct stat information;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return stat(path, &information) == 0 && information.st_size > 0;
}

/* One line on standard error that has all three words; nothing else. */
static void check_refused(int code, const char *a, const char *b, const char *c)
{
    check_code(code);
    bool good = count_lines(result.error) == 1 && strstr(result.error, a) &&
                strstr(result.error, b) && strstr(result.error, c);
    if (!good)
        print_error("%s", result.error);
    CHECK(good);
}

/* On standard output, and that alone; where it cannot be written it is a
 * failure. */
TEST(information_is_printed)
{
    static const struct {
        const char *line, *words;
        int lines; /* at least */
    } rows[] = {{"--help", "--segments", 20},
                {"--help --segments 3", "--segments", 20},
                {"--version", "elasto ", 1},
                {"--list", "square ", 10}};
    for (int i = 0; i < 4; i++) {
        run(rows[i].line);
        check_code(0);
        CHECK(strstr(result.out, rows[i].words) && result.error[0] == '\0');
        CHECK(count_lines(result.out) >= rows[i].lines);
        CHECK(rows[i].lines != 1 || count_lines(result.out) == 1);
        run_line("%s >/dev/full", rows[i].line);
        check_code(1);
    }
}

TEST(summaries_tell_what_was_done)
{
    run("--headless --steps 5");
    check_code(0);
    const char *words[] = {"5",       "Newton", "factor",  "solve",
                           "project", "energy", "converge"};
    char all[2 * TEXT];
    snprintf(all, sizeof all, "%s%s", result.out, result.error);
    for (int i = 0; i < 7; i++) {
        if (!strstr(all, words[i]))
            print_error("no '%s' in: %s\n", words[i], all);
        CHECK(strstr(all, words[i]) != NULL);
    }
    run("--headless --steps 2 --timestep 0.004,0.01");
    check_code(0);
    CHECK(strstr(result.out, "pane 1              h 0.004 s\nsteps          "
                             "     5\nsimulated time      0.02 s\n"));
    CHECK(strstr(result.out, "pane 2              h 0.01 s\nsteps           "
                             "    2\nsimulated time      0.02 s\n"));
    run("--headless --steps 1 --gravity 0,9.81 --segments 1,2,3");
    check_code(0);
    CHECK(strcmp(result.error, "6 panes: elasto --headless --gravity 0,9.81 "
                               "--segments "
                               "1,2,3\n") == 0);
    run("--headless --steps 5 --quiet");
    check_code(0);
    CHECK(result.out[0] == '\0' && result.error[0] == '\0');
    run("--headless --steps 0 --quiet");
    check_code(0);
}

/* On standard output there is the table and nothing else; its last state is
 * that of the library, to the last bit. */
TEST(states_are_clean_and_exact)
{
    Simulation simulation;
    run("--headless --segments 2 --steps 7 --states -");
    check_code(0);
    CHECK(count_lines(result.out) == 1 + 8 * 9);
    const char *line = result.out;
    CHECK(strncmp(line, "step,time,node,x,y,vx,vy\n", 25) == 0);
    simulation_from_line("--segments 2", NULL, NULL, &simulation);
    for (int step = 0; step <= 7; step++) {
        for (int node = 0; node < 9; node++) {
            const TimeIntegrator *state = &simulation.run[0];
            int s, n;
            double t, got[4], expected[4];
            line = strchr(line, '\n') + 1;
            CHECK(sscanf(line, "%d,%lf,%d,%lf,%lf,%lf,%lf\n", &s, &t, &n,
                         &got[0], &got[1], &got[2], &got[3]) == 7);
            memcpy(expected, state->x + 2 * node, 2 * sizeof *expected);
            memcpy(expected + 2, state->v + 2 * node, 2 * sizeof *expected);
            CHECK(s == step && n == node);
            CHECK_NEAR(t, simulation_time(&simulation), 0);
            CHECK_SAME_BITS(got, expected, 4);
        }
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    }
    simulation_free(&simulation);
}

TEST(logs_have_a_row_an_iteration)
{
    run("--headless --steps 5 --log log.csv --states states.csv --quiet");
    check_code(0);
    CHECK(exists("log.csv") && exists("states.csv"));
    char path[64];
    static char text[TEXT];
    snprintf(path, sizeof path, "%s/log.csv", folder);
    read_text(path, text);
    CHECK(strncmp(text, "step,iteration,residual,alpha", 29) == 0);
    Simulation simulation;
    simulation_from_line("square", NULL, NULL, &simulation);
    for (int step = 0; step < 5; step++)
        CHECK_STATUS(simulation_step(&simulation), STATUS_OK);
    CHECK(count_lines(text) == 1 + simulation_counters(&simulation).iterations);
    simulation_free(&simulation);
    double residual, alpha;
    int step, iteration;
    CHECK(sscanf(strchr(text, '\n'), "%d,%d,%lf,%lf", &step, &iteration,
                 &residual, &alpha) == 4);
    CHECK(step == 1 && iteration == 0 && alpha == 1 && residual > 1);
    snprintf(path, sizeof path, "%s/states.csv", folder);
    read_text(path, text);
    CHECK(count_lines(text) == 1 + 6 * 25);
}

TEST(frames_are_written)
{
    run("--headless --steps 3 --frames pictures --quiet");
    check_code(0);
    for (int i = 0; i <= 3; i++) {
        char path[80];
        unsigned char start[8] = {0};
        snprintf(path, sizeof path, "%s/pictures/frame_%06d.png", folder, i);
        FILE *file = fopen(path, "rb");
        CHECK(file != NULL);
        CHECK(fread(start, 1, 8, file) == 8);
        fclose(file);
        CHECK(memcmp(start, "\x89PNG\r\n\x1a\n", 8) == 0);
    }
    CHECK(!exists("pictures/frame_000004.png"));
}

TEST(headless_alone_draws_nothing)
{
    run("--headless --steps 2 --quiet");
    check_code(0);
    CHECK(!exists("frames"));
}

TEST(failed_files_exit_with_1)
{
    static const struct {
        const char *option, *name;
        int reason; /* 0: any */
    } rows[] = {{"states", "/dev/full", ENOSPC},
                {"log", "/dev/full", ENOSPC},
                {"states", "nowhere/states.csv", ENOENT},
                {"log", "nowhere/log.csv", ENOENT},
                {"frames", "nowhere/pictures", ENOENT},
                {"frames", "out", 0},
                {"states", ".", 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        run_line("--headless --steps 5 --quiet --%s %s", rows[i].option,
                 rows[i].name);
        check_refused(1, rows[i].name,
                      rows[i].reason ? strerror(rows[i].reason) : "", "");
    }
    CHECK(!exists("nowhere"));
}

/* Unconverged steps are made, counted and shown in the exit code. */
TEST(unconverged_steps_exit_with_3)
{
    run("--headless --steps 5 --filter none --timestep 0.02 --stretch 0.5");
    check_code(3);
    run("--headless --steps 3 --tolerance 1e-30 --quiet --states s.csv");
    check_code(3);
    CHECK(exists("s.csv"));
}

/* What simulation_bytes says of this line. */
static double estimated_bytes(char *segments, char *integrator, char *solver)
{
    Options options;
    char message[256];
    char *line[] = {"elasto",   "--segments", segments, "--integrator",
                    integrator, "--solver",   solver};
    CHECK_STATUS(options_parse(7, line, 0, &options, message, sizeof message),
                 STATUS_OK);
    return simulation_bytes(&options);
}

/* Machines that have room for 4096 segments are asked nothing. */
TEST(squares_too_large_for_the_machine_are_refused)
{
    double there =
        (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    double newton = estimated_bytes("4096", "backward-euler", "newton");
    CHECK(estimated_bytes("4096", "verlet", "auto") < 0.1 * newton);
    CHECK(estimated_bytes("4096", "backward-euler", "auto") < 0.3 * newton);
    if (newton <= there)
        return;
    run("--headless --steps 1 --segments 4096 --solver newton");
    check_refused(2, "--segments 4096 needs about", "GB", "from 1 to ");
}

/* The largest process so far, less what the program itself takes; sanitizers
 * take more. */
TEST(memory_is_estimated_within_a_quarter)
{
#if !defined __SANITIZE_ADDRESS__
    char *const solvers[] = {"multigrid", "newton"};
    for (int i = 0; i < 2; i++) {
        char line[200];
        struct rusage before, after;
        getrusage(RUSAGE_CHILDREN, &before);
        snprintf(line, sizeof line,
                 "--headless --quiet --steps 1 --segments %d --stretch 1.001 "
                 "--timestep 1e-4 --tolerance 1e-6 --solver %s",
                 i == 0 ? 300 : 200, solvers[i]);
        run(line);
        check_code(0);
        getrusage(RUSAGE_CHILDREN, &after);
#if defined __APPLE__
        double unit = 1;
#else
        double unit = 1024;
#endif
        double own = 12e6;
        double estimate = estimated_bytes(i == 0 ? "300" : "200",
                                          "backward-euler", solvers[i]);
        CHECK(after.ru_maxrss > before.ru_maxrss);
        CHECK_NEAR(unit * (double)after.ru_maxrss - own, estimate,
                   0.25 * estimate);
    }
#endif
}

TEST(overflow_exits_with_1)
{
    run("--headless --steps 100 --integrator forward-euler --timestep 1 "
        "--quiet --states blown.csv");
    check_refused(1, "step", "NaN or infinite", "--timestep");
    CHECK(exists("blown.csv")); /* what was written before stays */
    run("--headless --steps 50 --timestep 0.05 --quiet "
        "--integrator backward-euler,forward-euler");
    check_refused(1, "pane 2, step", "NaN or infinite", "--timestep");
}

/* Signals end a run early and leave whole files. */
TEST(signals_end_the_run)
{
    const char *names[] = {"INT", "TERM"};
    for (int i = 0; i < 2; i++) {
        static char line[256], text[TEXT];
        char path[64];
        snprintf(line, sizeof line,
                 "--headless --steps 100000000 --quiet --log signal.csv & "
                 "sleep 0.3; kill -%s $!; wait $!",
                 names[i]);
        run(line);
        CHECK(result.code != 124 && result.code >= 0);
        snprintf(path, sizeof path, "%s/signal.csv", folder);
        read_text(path, text);
        CHECK(strncmp(text, "step,", 5) == 0);
        unlink(path);
    }
}

TEST(same_line_gives_same_bits)
{
    static char first[TEXT];
    run("--headless --segments 5 --steps 10 --states -");
    check_code(0);
    memcpy(first, result.out, sizeof first);
    run("--headless --segments 5 --steps 10 --states - --quiet");
    CHECK(strcmp(first, result.out) == 0);
}

static int make_folder(void **unused)
{
    (void)unused;
    const char *name = getenv("ELASTO");
    if (realpath(name ? name : "build/elasto", program) && mkdtemp(folder))
        return 0;
    perror(program);
    return -1;
}

static int remove_folder(void **unused)
{
    (void)unused;
    char command[64];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

TESTS(make_folder, remove_folder)
