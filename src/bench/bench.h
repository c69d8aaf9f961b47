/* bench.h - what the tables of the benchmark share: the clock, the CSV file
 * that is being written, and claims that are checked where they are printed.
 */
#ifndef ELASTO_BENCH_H
#define ELASTO_BENCH_H

#include "play/output.h"
#include "scenes/simulation.h"

typedef struct Bench {
    bool quick;         /* seconds instead of minutes: does it all work? */
    const char *folder; /* where the CSV files go */
    Output csv;         /* the one that is being written */
} Bench;

/* A table: prints itself and writes folder/name.csv.
 * Returns OK, OUT_OF_MEMORY, FILE_FAILED. */
Status bench_work(Bench *bench);
Status bench_steps(Bench *bench);
Status bench_frames(Bench *bench);

/* Processor time of this thread, s: what a busy machine changes least. */
double bench_cpu(void);

/* The middle one, or the mean of the two in the middle; sorts the values.
 * count at least 1. */
double bench_median(double *values, int count);

/* One row, as printf; what fails shows at the end of the table. */
void bench_row(Bench *bench, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Prints what README says, what was measured, and whether that holds. */
void bench_claim(const char *what, double measured, double at_most);

/* The slides' numbers, on a square of so many segments. */
Options slides_options(int segments);

/* step_forward of src/lecture.c.
 *   system  springs and masses are used, nothing else
 *   h, tol  s, m/s
 *   x, v    [2n] m, m/s, in/out
 * Returns OK, OUT_OF_MEMORY, or LINE_SEARCH_LIMIT: it gave up, as the slides'
 * program may, and x is where it was then. */
Status lecture_step(const System *system, double h, double tol, double *x,
                    double *v);

#endif
