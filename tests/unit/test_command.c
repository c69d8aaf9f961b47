/* What a square needs of memory, told before it is taken.  (Command lines,
 * files and exit codes of the program: check_lines.sh, check_files.sh.)
 * The program is named by ELASTO, else build/elasto.
 */
#include "test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/* Runs this line; its exit code, and the words [size] it says at its end. */
static int run(const char *line, char *words, int size)
{
    char command[512];
    const char *program = getenv("ELASTO");
    snprintf(command, sizeof command,
             "timeout 60 %s --headless --quiet %s 2>&1",
             program ? program : "build/elasto", line);
    FILE *output = popen(command, "r");
    CHECK(output != NULL);
    words[0] = '\0';
    while (fgets(words, size, output))
        continue;
    int status = pclose(output);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static double estimated_bytes(const char *line)
{
    const Options options = line_options(line);
    return simulation_bytes(&options);
}

/* Machines that have room for 4096 segments are asked nothing. */
TEST(squares_too_large_for_the_machine_are_refused)
{
    char words[512];
    double there =
        (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    double newton = estimated_bytes("--segments 4096 --solver newton");
    CHECK(estimated_bytes("--segments 4096 --integrator verlet") <
          0.1 * newton);
    CHECK(estimated_bytes("--segments 4096") < 0.3 * newton);
    if (newton <= there)
        return;
    CHECK(run("--segments 4096 --solver newton", words, sizeof words) == 2);
    CHECK(strstr(words, "--segments 4096 needs about"));
    CHECK(strstr(words, "GB") && strstr(words, "from 1 to "));
}

/* The largest process so far, less what the program itself takes; sanitizers
 * take more. */
TEST(memory_is_estimated_within_a_quarter)
{
#if !defined __SANITIZE_ADDRESS__
    static const char *const lines[] = {"--segments 300 --solver multigrid",
                                        "--segments 200 --solver newton"};
    for (int i = 0; i < 2; i++) {
        char line[200], words[512];
        struct rusage before, after;
        const double unit = 1024, own = 12e6, bytes = estimated_bytes(lines[i]);
        getrusage(RUSAGE_CHILDREN, &before);
        snprintf(line, sizeof line,
                 "--steps 1 --stretch 1.001 --timestep 1e-4 --tolerance 1e-6 "
                 "%s",
                 lines[i]);
        CHECK(run(line, words, sizeof words) == 0);
        getrusage(RUSAGE_CHILDREN, &after);
        CHECK(after.ru_maxrss > before.ru_maxrss);
        CHECK_NEAR(unit * (double)after.ru_maxrss - own, bytes, 0.25 * bytes);
    }
#endif
}

TESTS(NULL, NULL)
