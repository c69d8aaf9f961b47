/* bench.c - the program elasto-bench: run time against error, and how long
 * steps and frames take. */
#include "bench/bench.h"

#include <SDL_version.h>
#include <cholmod.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const struct {
    const char *name, *sentence;
    Status (*run)(bool quick);
    const char *columns;
} tables[] = {
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

void bench_claim(const char *what, double measured, double at_most)
{
    printf("# claim: %s: %.3g, at most %g: %s\n", what, measured, at_most,
           measured <= at_most ? "met" : "NOT MET");
}

Options slides_options(int segments)
{
    char message[128];
    Options options;
    options_of_line("square", &options, message, sizeof message);
    options.segments = segments;
    return options;
}

int main(int argc, char **argv)
{
    bool quick = argc == 3 && strcmp(argv[2], "--quick") == 0;
    int t = 0;
    while (t < TABLES && (argc < 2 || strcmp(argv[1], tables[t].name) != 0))
        t++;
    if (t == TABLES || argc != 2 + quick) {
        fprintf(stderr, "usage: elasto-bench TABLE [--quick]; tables:");
        for (t = 0; t < TABLES; t++)
            fprintf(stderr, " %s (%s)%s", tables[t].name, tables[t].sentence,
                    t + 1 < TABLES ? "," : "\n");
        return 2;
    }
    setvbuf(stdout, NULL, _IOLBF, 0); /* each line when it is measured */
    printf("# elasto %s; SuiteSparse %d.%d.%d; SDL %d.%d.%d; compiler %s; "
           "flags %s; one thread; %s run\n%s\n",
           ELASTO_VERSION, SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION,
           SUITESPARSE_SUBSUB_VERSION, SDL_MAJOR_VERSION, SDL_MINOR_VERSION,
           SDL_PATCHLEVEL, __VERSION__, BENCH_FLAGS, quick ? "quick" : "full",
           tables[t].columns);
    Status status = tables[t].run(quick);
    if (status)
        fprintf(stderr, "elasto-bench: %s\n", status_text(status));
    return status || fflush(stdout) || ferror(stdout);
}
