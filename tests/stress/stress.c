/* build/stress: every named case, many random scenes and the envelope, within
 * minutes; ends with a table and the number of promises broken.
 *
 *   --random N   random scenes (100000)       --seed S  (1)
 *   --squares N  random squares of the command line (10000)
 *   --case N     only that one; shrunk and printed if it fails
 *   --quick      no slow case and no envelope
 *   --envelope CSV PNG   only the envelope, into these files
 */
#include "stress.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Longer than any case may take, s. */
enum { CASE_LIMIT = 240 };

/* What runs now, for the line that is printed if it never ends. */
static char present[160];

static void on_alarm(int number)
{
    (void)number;
    ssize_t written = write(STDERR_FILENO, present, strlen(present));
    _exit(written < 0 ? 2 : 1);
}

static void begin_case(const char *what)
{
    snprintf(present, sizeof present, "%s does not end\n", what);
    alarm(CASE_LIMIT);
}

/* On a terminal one line that moves. */
static void progress(const char *what, long done, long total)
{
    if (isatty(STDERR_FILENO))
        fprintf(stderr, "\r%-24s %ld / %ld  \r", what, done, total);
}

static void print_row(const char *name, const Tally *tally)
{
    printf("%-22s %7ld %9ld %8ld %5ld %9ld %7ld\n", name, tally->cases,
           tally->steps[VERDICT_CONVERGED], tally->steps[VERDICT_REPORTED],
           tally->wrong, tally->judged, tally->blurred);
    fflush(stdout);
}

static void add_tally(const Tally *tally, Tally *sum)
{
    sum->cases += tally->cases;
    sum->wrong += tally->wrong;
    sum->judged += tally->judged;
    sum->blurred += tally->blurred;
    for (int i = 0; i < VERDICTS; i++)
        sum->steps[i] += tally->steps[i];
    for (int i = 0; i < STATUS_COUNT; i++)
        sum->statuses[i] += tally->statuses[i];
}

static void run_cases(bool quick, Tally *sum)
{
    for (const StressCase *row = stress_cases; row->name; row++) {
        char reason[512] = "";
        Tally tally = {0};
        if (quick && row->slow)
            continue;
        begin_case(row->name);
        progress(row->name, 0, 1);
        if (!row->run(&tally, reason)) {
            tally.wrong += tally.wrong == 0;
            printf("%s: %s\n", row->name, reason);
        }
        print_row(row->name, &tally);
        add_tally(&tally, sum);
    }
}

static void run_random(const char *name, uint64_t seed, long first, long count,
                       Tally *sum)
{
    Tally tally = {0};
    for (long i = first; i < first + count; i++) {
        Wild wild;
        char reason[512] = "", line[80];
        snprintf(line, sizeof line, "build/stress --seed %llu --case %ld",
                 (unsigned long long)seed, i);
        begin_case(line);
        wild_create(seed, i, &wild);
        if (wild_run(&wild, &tally, reason) == VERDICT_WRONG)
            printf("%s: %s\n", line, reason);
        if (i % 1000 == 0)
            progress(name, i - first, count);
    }
    print_row(name, &tally);
    add_tally(&tally, sum);
}

static bool still_wrong(const Wild *wild, void *user)
{
    Tally tally = {0};
    (void)user;
    char reason[512];
    return wild_run(wild, &tally, reason) == VERDICT_WRONG;
}

/* One random scene again; if it fails, as small as it gets. */
static int run_one(uint64_t seed, long number)
{
    Wild wild;
    Tally tally = {0};
    char reason[512] = "";
    begin_case("this case");
    wild_create(seed, number, &wild);
    Verdict verdict = wild_run(&wild, &tally, reason);
    wild_print(&wild);
    if (verdict != VERDICT_WRONG) {
        printf("%s\n", verdict == VERDICT_CONVERGED ? "converged" : "reported");
        return 0;
    }
    printf("WRONG: %s\nshrunk:\n", reason);
    wild_shrink(&wild, still_wrong, NULL);
    wild_print(&wild);
    wild_run(&wild, &tally, reason);
    printf("WRONG: %s\n", reason);
    return 1;
}

static void run_envelope(const char *csv, const char *png, Tally *sum)
{
    static Envelope envelope;
    Tally tally = {0};
    for (int i = 0; i < SOLVER_COUNT * ENVELOPE_STRETCH; i++) {
        int solver = i / ENVELOPE_STRETCH, s = i % ENVELOPE_STRETCH;
        begin_case("a panel of the envelope");
        progress("envelope", i, SOLVER_COUNT * ENVELOPE_STRETCH);
        for (int k = 0; k < ENVELOPE_K; k++)
            for (int h = 0; h < ENVELOPE_H; h++) {
                char reason[600] = "";
                char verdict =
                    envelope_cell((Solver)solver, s, k, h, &tally, reason);
                envelope.verdict[solver][s][k][h] = verdict;
                if (verdict == 'w')
                    printf("%s\n", reason);
            }
    }
    print_row("envelope", &tally);
    for (int i = 0; i < SOLVER_COUNT; i++)
        printf("%s: %.2f %% converged where stretch >= 0.1 and something was "
               "done\n",
               solver_name((Solver)i),
               100 * envelope_share(&envelope, (Solver)i));
    if ((csv && !envelope_write(csv, &envelope)) ||
        (png && !envelope_draw(png, &envelope))) {
        perror(csv);
        tally.wrong++;
    }
    add_tally(&tally, sum);
}

static void print_sum(const Tally *sum)
{
    print_row("all", sum);
    puts("steps by status:");
    for (int i = 0; i < STATUS_COUNT; i++)
        if (sum->statuses[i] > 0)
            printf("  %-22s %9ld\n", status_name((Status)i), sum->statuses[i]);
    printf("%ld violated\n", sum->wrong);
}

int main(int argc, char **argv)
{
    uint64_t seed = 1;
    long random = 100000, squares = 10000, number = -1;
    bool quick = false;
    const char *csv = NULL, *png = NULL;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--quick") == 0)
            quick = true;
        else if (strcmp(argv[i], "--seed") == 0 && i + 1 < argc)
            stress_contact_seed = seed = strtoull(argv[++i], NULL, 10);
        else if (strcmp(argv[i], "--case") == 0 && i + 1 < argc)
            number = strtol(argv[++i], NULL, 10);
        else if (strcmp(argv[i], "--random") == 0 && i + 1 < argc)
            random = strtol(argv[++i], NULL, 10);
        else if (strcmp(argv[i], "--squares") == 0 && i + 1 < argc)
            squares = strtol(argv[++i], NULL, 10);
        else if (strcmp(argv[i], "--envelope") == 0 && i + 2 < argc)
            csv = argv[i + 1], png = argv[i + 2], i += 2;
        else
            return fprintf(stderr, "stress: what is '%s'?\n", argv[i]), 2;
    }
    signal(SIGALRM, on_alarm);
    if (number >= 0)
        return run_one(seed, number);
    Tally sum = {0};
    printf("%-22s %7s %9s %8s %5s %9s %7s\n", "", "cases", "converged",
           "reported", "wrong", "resolved", "blurred");
    if (!csv) {
        run_cases(quick, &sum);
        run_random("random scenes", seed, 0, random, &sum);
        run_random("random squares", seed, WILD_SQUARES, squares, &sum);
    }
    if (!quick)
        run_envelope(csv, png, &sum);
    print_sum(&sum);
    return sum.wrong > 0;
}
