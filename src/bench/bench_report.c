#include "bench/bench_report.h"

#include <cholmod.h>
#include <SDL_version.h>
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "scenes/options.h"

#ifndef BENCH_FLAGS
#define BENCH_FLAGS "unknown"
#endif

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

/* The first "model name" of Linux' list of processors, or "unknown". */
static void processor_name(char *name, size_t size)
{
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    snprintf(name, size, "unknown");
    while (file && fgets(line, sizeof line, file)) {
        char *value = strstr(line, ": ");
        if (strncmp(line, "model name", 10) != 0 || !value)
            continue;
        value[strcspn(value, "\n")] = '\0';
        snprintf(name, size, "%s", value + 2);
        break;
    }
    if (file)
        fclose(file);
}

static const char *compiler_name(void)
{
#if defined __clang__
    return "clang " __clang_version__;
#elif defined __GNUC__
    return "gcc " __VERSION__;
#else
    return "unknown";
#endif
}

void bench_machine(const Bench *bench, char *line, size_t size)
{
    char processor[128];
    processor_name(processor, sizeof processor);
    snprintf(line, size,
             "elasto %s; SuiteSparse %d.%d.%d; SDL %d.%d.%d; %s; flags %s; "
             "processor %s; threads %ld, of which 1 is used; %s run",
             ELASTO_VERSION, SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION,
             SUITESPARSE_SUBSUB_VERSION, SDL_MAJOR_VERSION, SDL_MINOR_VERSION,
             SDL_PATCHLEVEL, compiler_name(), BENCH_FLAGS, processor,
             sysconf(_SC_NPROCESSORS_ONLN), bench->quick ? "quick" : "full");
}

/* The one line about a file that could not be written. */
static Status report_csv(const Bench *bench, const char *name, int reason)
{
    bench_progress(bench, NULL);
    fprintf(stderr, "elasto-bench: %s: %s\n", name, strerror(reason));
    return STATUS_FILE_FAILED;
}

Status bench_csv_open(Bench *bench, const char *name, const char *columns)
{
    char path[4096], machine[1024];
    int length = snprintf(path, sizeof path, "%s/%s.csv", bench->folder, name);
    if (length < 0 || (size_t)length >= sizeof path)
        return report_csv(bench, name, ENAMETOOLONG);
    Status status = output_open(path, &bench->csv);
    if (status == STATUS_FILE_FAILED)
        return report_csv(bench, path, errno);
    if (status)
        return status;
    bench_machine(bench, machine, sizeof machine);
    fprintf(bench->csv.file, "# %s\n%s\n", machine, columns);
    return STATUS_OK;
}

void bench_csv_row(Bench *bench, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vfprintf(bench->csv.file, format, arguments);
    va_end(arguments);
    fputc('\n', bench->csv.file);
}

Status bench_csv_close(Bench *bench, Status status)
{
    bench_progress(bench, NULL);
    if (status) {
        output_discard(&bench->csv, false);
        return status;
    }
    char name[4096];
    snprintf(name, sizeof name, "%s", bench->csv.name ? bench->csv.name : "");
    errno = 0;
    if (output_close(&bench->csv))
        return report_csv(bench, name, errno ? errno : EIO);
    return STATUS_OK;
}

void bench_progress(const Bench *bench, const char *format, ...)
{
    if (!bench->progress)
        return;
    fputs("\r\033[K", stderr);
    if (!format)
        return;
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fflush(stderr);
}
