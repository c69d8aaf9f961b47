/* bench_report.h - what all parts of the benchmark share: how it was called,
 * the clock, CSV files that say where they come from, and progress.
 */
#ifndef ELASTO_BENCH_REPORT_H
#define ELASTO_BENCH_REPORT_H

#include "base/clock.h"
#include "play/output.h"

typedef struct Bench {
    bool quick;         /* seconds instead of minutes */
    bool progress;      /* standard error is a terminal */
    const char *folder; /* where the CSV files go */
    Output csv;         /* the file that is being written */
} Bench;

/* Processor time of this thread, s: what a busy machine changes least. */
double bench_cpu(void);

/* The middle one, or the mean of the two in the middle; sorts the values.
 * count at least 1. */
double bench_median(double *values, int count);

/* Opens folder/name.csv with two lines: a comment with versions, flags and
 * machine, and the names of the columns.
 * Returns OK, OUT_OF_MEMORY, FILE_FAILED (after a line on standard error). */
Status bench_csv_open(Bench *bench, const char *name, const char *columns);

/* One row, as printf; what fails shows at bench_csv_close. */
void bench_csv_row(Bench *bench, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Returns status, or FILE_FAILED (after a line on standard error).  The file
 * appears only if status is OK. */
Status bench_csv_close(Bench *bench, Status status);

/* What is being measured, on a terminal, as printf; NULL: nothing any more. */
void bench_progress(const Bench *bench, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Versions, flags, processor and threads in one line. */
void bench_machine(const Bench *bench, char *line, size_t size);

#endif
