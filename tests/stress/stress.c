/* stress.c - build/stress runs the named cases, many random scenes and a grid
 * of h, k and stretch (envelope); prints a table and the number of failures.
 *
 *   --seed S     seed of the random scenes (1)
 *   --line LINE  runs only this command line, for ten steps
 *   --quick      a tenth of the random scenes, no slow case, no envelope */
#include "stress.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Processor time after which a case counts as endless, s */
enum { CASE_TIME_LIMIT = 240 };

static void report_endless_case(int number)
{
    static const char words[] = " does not end\n";
    (void)number;
    ssize_t written = write(STDERR_FILENO, stress_line, strlen(stress_line));
    written += write(STDERR_FILENO, words, sizeof words - 1);
    _exit(written < 0 ? 2 : 1);
}

static void begin_test_case(const char *what)
{
    snprintf(stress_line, sizeof stress_line, "%s", what);
    stress_set_time_limit(CASE_TIME_LIMIT);
    if (isatty(STDERR_FILENO))
        fprintf(stderr, "\r%-40s\r", what);
}

static void print_tally(const char *name, const VerdictTally *tally)
{
    printf("%-22s %7ld %9ld %8ld %5ld %9ld %7ld\n", name, tally->cases,
           tally->steps_by_verdict[VERDICT_CONVERGED],
           tally->steps_by_verdict[VERDICT_REPORTED], tally->wrong_cases,
           tally->judged_residuals, tally->undecided_tests);
    fflush(stdout);
}

static void add_tally(const VerdictTally *tally, VerdictTally *sum)
{
    sum->cases += tally->cases;
    sum->wrong_cases += tally->wrong_cases;
    sum->updates += tally->updates;
    sum->judged_residuals += tally->judged_residuals;
    sum->undecided_tests += tally->undecided_tests;
    for (int i = 0; i < VERDICT_COUNT; i++)
        sum->steps_by_verdict[i] += tally->steps_by_verdict[i];
    for (int i = 0; i < STATUS_COUNT; i++)
        sum->steps_by_status[i] += tally->steps_by_status[i];
}

static void run_named_cases(bool quick, VerdictTally *sum)
{
    for (const StressCase *row = stress_cases; row->name; row++) {
        char reason[512] = "";
        VerdictTally tally = {0};
        if (quick && row->is_slow)
            continue;
        begin_test_case(row->name);
        if (!row->run_case(&tally, reason)) {
            tally.wrong_cases += tally.wrong_cases == 0;
            printf("%s: %s\n", row->name, reason);
        }
        print_tally(row->name, &tally);
        add_tally(&tally, sum);
    }
}

/* Families of random scenes: kinds (letters of stress.h), number of scenes,
 * steps of each, least share of converged steps. Steps with the status BLOCKED
 * do not count; one step of bodies in a thousand reaches the update limit. */
static const struct {
    const char *name, *scene_kinds;
    long scene_count;
    int step_count;
    double least_converged_share;
} families[] = {{"squares, shaken", "s", 20000, 2, 0.5},
                {"contact", "cccctbww", 20000, 10, 0.999},
                {"large squares", "l", 80, 4, 0.5},
                {"springs that flow", "f", 20000, 2, 0.5},
                {"stiff solids", "k", 10000, 3, 0.9},
                {"bodies", "mn", 20000, 10, 0.998}};

static void run_random_families(uint64_t seed, bool quick, VerdictTally *sum)
{
    for (size_t i = 0; i < sizeof families / sizeof *families; i++) {
        char reason[512];
        VerdictTally tally = {0};
        long count = families[i].scene_count / (quick ? 10 : 1);
        begin_test_case(families[i].name);
        if (!stress_run_scenes(families[i].scene_kinds, seed, count,
                               families[i].step_count, &tally, reason))
            printf("%s: %s\n", stress_line, reason);
        double good = (double)tally.steps_by_verdict[VERDICT_CONVERGED];
        double all = good + (double)(tally.steps_by_verdict[VERDICT_REPORTED] -
                                     tally.steps_by_status[STATUS_BLOCKED]);
        if (!(good >= families[i].least_converged_share * all)) {
            printf("only %g of %g steps converged\n", good, all);
            tally.wrong_cases++;
        }
        print_tally(families[i].name, &tally);
        add_tally(&tally, sum);
    }
}

static int run_command_line(const char *line)
{
    static const char *const words[VERDICT_COUNT] = {"converged", "reported",
                                                     "WRONG"};
    VerdictTally tally = {0};
    char reason[512] = "";
    begin_test_case(line);
    StepVerdict verdict = stress_run_line(line, 10, &tally, reason);
    printf("%s %s\n", words[verdict], reason);
    return verdict == VERDICT_WRONG;
}

/* Makes three steps of the default square with each h from 1e-9 to 1e3 s by
 * half decades, k from 1e-6 to 1e15 J/m^2, and eight stretches. With a stretch
 * of 0.1 or more 99 % of the runs must converge, each with an update. */
static void run_parameter_grid(Solver solver, VerdictTally *sum)
{
    static const double stretch[] = {1e-6, 1e-3, 0.1, 0.5, 1.4, 10, 1e3, 1e6};
    enum { H = 25, K = 22, STRETCH_COUNT = sizeof stretch / sizeof *stretch };
    int cells = 0, converged = 0, idle = 0;
    VerdictTally tally = {0};
    for (int i = 0; i < STRETCH_COUNT * K * H; i++) {
        char line[160], reason[512];
        long before = tally.updates;
        double s = stretch[i / (K * H)];
        snprintf(line, sizeof line,
                 "--solver %s --stretch %g --stiffness %g --timestep %.17g",
                 get_solver_name(solver), s, pow(10, i / H % K - 6),
                 pow(10, 0.5 * (i % H) - 9));
        begin_test_case(line);
        StepVerdict verdict = stress_run_line(line, 3, &tally, reason);
        if (verdict == VERDICT_WRONG)
            printf("%s (%s)\n", reason, line);
        idle += s >= 0.1 && !verdict && tally.updates == before;
        cells += s >= 0.1;
        converged += s >= 0.1 && !verdict;
    }
    print_tally("envelope", &tally);
    printf("%s: %.2f %% converged where stretch >= 0.1, %d without an update\n",
           get_solver_name(solver), 100.0 * converged / cells, idle);
    tally.wrong_cases += converged < 0.99 * cells || idle > 0;
    add_tally(&tally, sum);
}

static void print_totals(const VerdictTally *sum)
{
    print_tally("all", sum);
    puts("steps by status:");
    for (int i = 0; i < STATUS_COUNT; i++)
        if (sum->steps_by_status[i] > 0)
            printf("  %-22s %9ld\n", status_name((Status)i),
                   sum->steps_by_status[i]);
    printf("%ld violated\n", sum->wrong_cases);
}

int main(int argc, char **argv)
{
    uint64_t seed = 1;
    bool quick = false;
    signal(SIGPROF, report_endless_case);
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--quick") == 0)
            quick = true;
        else if (strcmp(argv[i], "--seed") == 0 && i + 1 < argc)
            seed = strtoull(argv[++i], NULL, 10);
        else if (strcmp(argv[i], "--line") == 0 && i + 1 < argc)
            return run_command_line(argv[i + 1]);
        else
            return fprintf(stderr,
                           "stress: '%s' is none of: --seed S, --line LINE, "
                           "--quick\n",
                           argv[i]),
                   2;
    }
    VerdictTally sum = {0};
    printf("%-22s %7s %9s %8s %5s %9s %7s\n", "", "cases", "converged",
           "reported", "wrong", "resolved", "blurred");
    run_named_cases(quick, &sum);
    run_random_families(seed, quick, &sum);
    for (int solver = 0; solver < SOLVER_COUNT && !quick; solver++)
        run_parameter_grid((Solver)solver, &sum);
    print_totals(&sum);
    return sum.wrong_cases > 0;
}
