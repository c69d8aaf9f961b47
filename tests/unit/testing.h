/* testing.h - what all suites share: checks that print what they saw, seeded
 * random numbers and springs, and runs of command lines.
 */
#ifndef ELASTO_TESTING_H
#define ELASTO_TESTING_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "lesson/command_line.h"
#include "simulation/control.h"
#include "scenes/scenes.h"
#include "scenes/small_scenes.h"

/* |got - expected| <= tolerance; NaN fails. */
#define CHECK_NEAR(got, expected, tolerance)                                   \
    check_near(#got, (got), (expected), (tolerance), __FILE__, __LINE__)

/* got <= limit; NaN fails. */
#define CHECK_AT_MOST(got, limit)                                              \
    check_at_most(#got, (got), (limit), __FILE__, __LINE__)

/* count numbers are equal to the last bit. */
#define CHECK_SAME_BITS(got, expected, count)                                  \
    check_same_bits(#got, (got), (expected), (count), __FILE__, __LINE__)

#define CHECK_STATUS(got, expected)                                            \
    check_status(#got, (got), (expected), __FILE__, __LINE__)
#define CHECK_OK(got) CHECK_STATUS(got, STATUS_OK)

/* got > 0 and the like, with both numbers in the message. */
#define CHECK(condition) check_true((condition), #condition, __FILE__, __LINE__)

void check_near(const char *what, long double got, long double expected,
                long double tolerance, const char *file, int line);
void check_at_most(const char *what, long double got, long double limit,
                   const char *file, int line);
void check_same_bits(const char *what, const double *got,
                     const double *expected, int count, const char *file,
                     int line);
void check_status(const char *what, Status got, Status expected,
                  const char *file, int line);
void check_true(bool condition, const char *what, const char *file, int line);

/* Whether all variations are asked for (make long-test), or each promise once
 * (make test). */
bool tests_are_long(void);

/* The number of random cases: `some`, or `all` with all variations, of which
 * sanitizers, which are slow, run a fifth. */
int tests_many(int all, int some);

/* Random numbers, the same on every machine (SplitMix64). */
typedef struct Random {
    uint64_t state; /* the seed */
} Random;

double random_uniform(Random *random, double low, double high);
double random_logarithmic(Random *random, double low, double high);
int random_below(Random *random, int limit);

/* How long random springs are, against their rest length: 0.1 ... 2, or 1e-9
 * ... 1e-7. */
typedef enum SpringState { SPRINGS_MIXED, SPRINGS_NEAR_ZERO } SpringState;

enum { MAX_NODES = 12, MAX_SIZE = 2 * MAX_NODES, MAX_SPRINGS = 40 };

/* Random springs between random pairs of at most MAX_NODES nodes; masses and
 * stiffnesses over four powers of ten.
 *   system  out; free it with system_free
 *   x       [MAX_SIZE] out */
void random_system(Random *random, SpringState state, System *system,
                   double *x);

/* Full matrix [size size] of a sparse one. */
void dense_from_sparse(const Sparse *A, double *dense);

/* Returns the part of a row before " | " and moves the row behind it; NULL: the
 * row is empty. */
char *next_part(char **row);

/* options_parse of the words of a line, separated by single spaces; "''" is an
 * empty one.  message [512] out */
Status parse_line(const char *line, int pane, Options *options, char *message);

/* Options of this command line, which is a good one. */
Options line_options(const char *line);

/* The simulation that this line sets up; free it with simulation_free. */
void simulation_from_line(const char *line, NewtonObserver observer, void *user,
                          Simulation *simulation);

/* The simulation of a line, which may have formats; it is freed when the test
 * ends. */
#define simulate(...) simulate_watched(NULL, NULL, __VA_ARGS__)
Simulation *simulate_watched(NewtonObserver observer, void *user,
                             const char *line, ...)
    __attribute__((format(printf, 3, 4)));
void free_all_begun(void);

/* control_apply with one number, by its slot, a pin or a hold changed; -1:
 * nothing is held. */
Status simulation_set(Simulation *simulation, int slot, double value);
Status simulation_pin(Simulation *simulation, int node, bool pinned);
Status simulation_hold(Simulation *simulation, int node, double x, double y);

/* Makes `count` steps, all of which converge; returns the simulation. */
Simulation *make_steps(Simulation *simulation, int count);

/* Row of a ledger with this name, J; energy_now takes the ledger of a run. */
#define OF(energies, name) energies_of(energies, #name)
double energies_of(const Energies *energies, const char *name);
double energy_now(const Simulation *simulation, int run, const char *name);

/* Hash of the states of all runs, the time and the ledgers; `hash` is
 * STATE_HASH_SEED or the hash of the pane before. */
uint64_t hash_with_ledger(const Simulation *simulation, uint64_t hash);

double count_broken_springs(const Simulation *simulation);

/* Bytes that are allocated now, where the C library counts them, else 0. */
double heap_in_use(void);

/* Rest positions of the mesh, [2n] m; valid until the next call */
double *rest_x(const Simulation *simulation);

#endif
