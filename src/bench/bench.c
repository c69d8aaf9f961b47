/* bench.c - the program elasto-bench: run time against error, and how long
 * steps and frames take. */
#include "bench/bench.h"

#include <SDL_version.h>
#include <cholmod.h>
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

typedef struct Table {
    const char *name, *sentence;
    Status (*run)(Bench *bench);
    const char *columns;
} Table;

static const Table tables[] = {
    {"work", "error against run time of all methods", bench_work,
     "case,segments,integrator,solver,order,steps,tolerance_m_s,run_time_s,"
     "error_m,failed"},
    {"steps", "milliseconds a step: the slides' program, newton, multigrid",
     bench_steps,
     "segments,solver,starts,median_ms,least_ms,most_ms,updates,"
     "energy_end_percent,unconverged"},
    {"frames", "milliseconds a frame", bench_frames,
     "segments,bare_ms,full_ms"},
};
enum { TABLES = sizeof tables / sizeof *tables };

double bench_cpu(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double bench_median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare_doubles);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

void bench_row(Bench *bench, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vfprintf(bench->csv.file, format, arguments);
    va_end(arguments);
    fputc('\n', bench->csv.file);
}

void bench_claim(const char *what, double measured, double at_most)
{
    printf("  claim: %s: %.3g, at most %g: %s\n", what, measured, at_most,
           measured <= at_most ? "met" : "NOT MET");
}

Options slides_options(int segments)
{
    char program[] = "elasto", message[128], *arguments[] = {program, NULL};
    Options options;
    options_parse(1, arguments, 0, &options, message, sizeof message);
    options.segments = segments;
    return options;
}

/* Versions and flags in one line. */
static void describe_machine(const Bench *bench, FILE *file)
{
    fprintf(file,
            "# elasto %s; SuiteSparse %d.%d.%d; SDL %d.%d.%d; compiler %s; "
            "flags %s; one thread; %s run\n",
            ELASTO_VERSION, SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION,
            SUITESPARSE_SUBSUB_VERSION, SDL_MAJOR_VERSION, SDL_MINOR_VERSION,
            SDL_PATCHLEVEL, __VERSION__, BENCH_FLAGS,
            bench->quick ? "quick" : "full");
}

/* The table and its file, which appears when it is whole. */
static Status run_table(Bench *bench, const Table *table)
{
    char path[4096];
    errno = 0;
    snprintf(path, sizeof path, "%s/%s.csv", bench->folder, table->name);
    Status status = output_open(path, &bench->csv);
    if (!status) {
        describe_machine(bench, bench->csv.file);
        fprintf(bench->csv.file, "%s\n", table->columns);
        printf("\n%s: %s\n", table->name, table->sentence);
        status = output_close(&bench->csv, table->run(bench));
    }
    if (status == STATUS_FILE_FAILED)
        fprintf(stderr, "elasto-bench: %s: %s\n", path, output_reason(errno));
    else if (status)
        fprintf(stderr, "elasto-bench: %s: %s\n", table->name,
                status_text(status));
    return status;
}

static int print_help(void)
{
    puts("usage: elasto-bench [options] [TABLE]   run time against error\n"
         "  --quick         seconds instead of minutes: does it all work?\n"
         "  --output DIR    where the CSV files go     [build/bench]\n"
         "  --help\n"
         "tables (all, if none is named):");
    for (int t = 0; t < TABLES; t++)
        printf("  %-8s %s\n", tables[t].name, tables[t].sentence);
    return 0;
}

int main(int argc, char **argv)
{
    Bench bench = {.folder = "build/bench"};
    int from = 0, to = TABLES;
    setvbuf(stdout, NULL, _IOLBF, 0); /* each line when it is measured */
    for (int i = 1, t; i < argc; i++) {
        for (t = 0; t < TABLES && strcmp(argv[i], tables[t].name); t++)
            continue;
        if (strcmp(argv[i], "--help") == 0)
            return print_help();
        if (strcmp(argv[i], "--quick") == 0) {
            bench.quick = true;
        } else if (strcmp(argv[i], "--output") == 0 && i + 1 < argc) {
            bench.folder = argv[++i];
        } else if (t < TABLES) {
            from = t;
            to = t + 1;
        } else {
            fprintf(stderr,
                    "elasto-bench: '%s' is no option and no table; see "
                    "--help\n",
                    argv[i]);
            return 2;
        }
    }
    if (mkdir(bench.folder, 0777) && errno != EEXIST) {
        fprintf(stderr, "elasto-bench: %s: %s\n", bench.folder,
                strerror(errno));
        return 1;
    }
    describe_machine(&bench, stdout);
    Status status = STATUS_OK;
    for (int t = from; t < to && !status; t++)
        status = run_table(&bench, &tables[t]);
    return status || fflush(stdout) || ferror(stdout);
}
