/* bench.c - the program elasto-bench: run time against error, and where the
 * time goes.  Each part prints a table and writes a CSV file. */
#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bench/bench_claims.h"
#include "bench/bench_cost.h"
#include "bench/bench_drawing.h"
#include "bench/bench_filters.h"
#include "bench/bench_memory.h"
#include "bench/bench_problem.h"
#include "bench/bench_solver.h"
#include "bench/bench_starts.h"
#include "bench/bench_tolerance.h"
#include "bench/bench_work.h"

typedef struct BenchPart {
    const char *name;
    const char *sentence;
    Status (*run)(Bench *bench);
} BenchPart;

/* memory first: the peak of the process is then that of the large square. */
static const BenchPart bench_parts[] = {
    {"memory", "one step of a large square: time and memory", bench_memory},
    {"work_precision", "error against run time of all methods",
     bench_work_precision},
    {"solver", "milliseconds a step, and where they go", bench_solver},
    {"starts", "every solver over nine starts", bench_starts},
    {"saddles", "which ends are minima, and newton's", bench_saddles},
    {"tolerance", "Newton's tolerance, its cost and its error",
     bench_tolerance},
    {"filters", "what is done with negative eigenvalues", bench_filters},
    {"drawing", "milliseconds a frame", bench_drawing},
    {"claims", "what is said about this program", bench_claims},
    {NULL, NULL, NULL},
};

/* The command line. */
typedef struct BenchCommand {
    Bench bench;
    const BenchPart *only; /* NULL: all */
    bool help;
} BenchCommand;

static const struct option bench_option_rows[] = {
    {"quick", no_argument, NULL, 'q'},
    {"only", required_argument, NULL, 'p'},
    {"output", required_argument, NULL, 'o'},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

static void print_bench_help(void)
{
    puts("usage: elasto-bench [options]   run time against error\n"
         "  --quick         seconds instead of minutes: does it all work?\n"
         "  --only PART     one of the parts below\n"
         "  --output DIR    where the CSV files go     [build/bench]\n"
         "  --help\n"
         "parts:");
    for (const BenchPart *part = bench_parts; part->name; part++)
        printf("  %-15s %s\n", part->name, part->sentence);
}

/* The part with this name, or NULL after a line on standard error. */
static const BenchPart *find_part(const char *name)
{
    for (const BenchPart *part = bench_parts; part->name; part++)
        if (strcmp(part->name, name) == 0)
            return part;
    fprintf(stderr, "elasto-bench: --only: '%s' is none of:", name);
    for (const BenchPart *part = bench_parts; part->name; part++)
        fprintf(stderr, " %s", part->name);
    fputc('\n', stderr);
    return NULL;
}

/* One option; false after a line on standard error. */
static bool apply_bench_option(int code, char **argv, BenchCommand *command)
{
    switch (code) {
    case 'q':
        return command->bench.quick = true;
    case 'h':
        return command->help = true;
    case 'p':
        return (command->only = find_part(optarg)) != NULL;
    case 'o':
        command->bench.folder = optarg;
        if (optarg[0] != '\0')
            return true;
        fputs("elasto-bench: --output: the name is empty\n", stderr);
        return false;
    case ':':
        fprintf(stderr, "elasto-bench: %s: the value is missing\n",
                argv[optind - 1]);
        return false;
    default:
        fprintf(stderr, "elasto-bench: '%s' is no option; see --help\n",
                argv[optind - 1]);
        return false;
    }
}

static bool parse_bench(int argc, char **argv, BenchCommand *command)
{
    int code;
    *command = (BenchCommand){.bench.folder = "build/bench"};
    command->bench.progress = isatty(STDERR_FILENO);
    opterr = 0;
    while ((code = getopt_long(argc, argv, ":", bench_option_rows, NULL)) != -1)
        if (!apply_bench_option(code, argv, command))
            return false;
    if (optind < argc)
        fprintf(stderr, "elasto-bench: '%s' is no option; see --help\n",
                argv[optind]);
    return optind == argc;
}

/* Makes the folder and those it is in; false after a line on standard error. */
static bool make_folders(const char *folder)
{
    char path[4096];
    size_t length = strlen(folder);
    errno = length < sizeof path ? 0 : ENAMETOOLONG;
    for (size_t i = 1; i <= length && !errno; i++)
        if (folder[i] == '/' || folder[i] == '\0') {
            memcpy(path, folder, i);
            path[i] = '\0';
            if (mkdir(path, 0777) == 0 || errno == EEXIST)
                errno = 0;
        }
    if (errno)
        fprintf(stderr, "elasto-bench: %s: %s\n", folder, strerror(errno));
    return errno == 0;
}

/* Libraries are loaded, and from here on all of them use one thread. */
static Status warm_up(void)
{
    Options options = slides_options(4);
    Cost cost;
    return cost_measure(&options, SOLVER_NEWTON, 3, 10, &cost);
}

/* Runs the parts that are asked for. */
static Status run_parts(BenchCommand *command)
{
    char machine[1024];
    bench_machine(&command->bench, machine, sizeof machine);
    puts(machine);
    Status status = warm_up();
    for (const BenchPart *part = bench_parts; part->name && !status; part++) {
        if (command->only && command->only != part)
            continue;
        double start = clock_now();
        printf("\n%s: %s\n", part->name, part->sentence);
        status = part->run(&command->bench);
        printf("  (%.1f s)\n", clock_now() - start);
        fflush(stdout);
        if (status && status != STATUS_FILE_FAILED)
            fprintf(stderr, "elasto-bench: %s: %s\n", part->name,
                    status_text(status));
    }
    return status;
}

int main(int argc, char **argv)
{
    enum { FINE = 0, FAILED = 1, MISUSED = 2 };
    BenchCommand command;
    setvbuf(stdout, NULL, _IOLBF, 0); /* each line when it is measured */
    setenv("ELASTO_THREADS", "1", 0); /* unless it is set: one thread */
    if (!parse_bench(argc, argv, &command))
        return MISUSED;
    Status status = STATUS_OK;
    if (command.help)
        print_bench_help();
    else if (!make_folders(command.bench.folder))
        return FAILED;
    else
        status = run_parts(&command);
    errno = 0;
    if (fflush(stdout) || ferror(stdout)) {
        fprintf(stderr, "elasto-bench: standard output: %s\n",
                strerror(errno ? errno : EIO));
        return FAILED;
    }
    return status ? FAILED : FINE;
}
