/* testing.h - shared by all suites: checks that print their values, seeded
 * random numbers and springs, and runs of command lines */
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

/* Checks |got - expected| <= tolerance; NaN fails. */
#define CHECK_NEAR(got, expected, tolerance)                                   \
    check_near(#got, (got), (expected), (tolerance), __FILE__, __LINE__)

/* Checks got <= limit; NaN fails. */
#define CHECK_AT_MOST(got, limit)                                              \
    check_at_most(#got, (got), (limit), __FILE__, __LINE__)

/* Checks that `count` numbers are equal to the last bit. */
#define CHECK_SAME_BITS(got, expected, count)                                  \
    check_same_bits(#got, (got), (expected), (count), __FILE__, __LINE__)

#define CHECK_STATUS(got, expected)                                            \
    check_status(#got, (got), (expected), __FILE__, __LINE__)
#define CHECK_OK(got) CHECK_STATUS(got, STATUS_OK)

/* Checks a condition, whose text the message of a failure shows. */
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

/* Returns true if all variations are to run (make long-test). */
bool tests_are_long(void);

/* Returns the number of random cases: `some`, or `all` in long tests, where the
 * address sanitizer cuts `all` to a fifth. */
int choose_case_count(int all, int some);

/* Random numbers by SplitMix64, equal on every machine */
typedef struct Random {
    uint64_t state; /* starts as the seed */
} Random;

double random_uniform(Random *random, double low, double high);
double random_logarithmic(Random *random, double low, double high);
int random_below(Random *random, int limit);

/* Lengths of random springs over rest lengths: 0.1 ... 2, or 1e-9 ... 1e-7 */
typedef enum SpringSize { SPRINGS_MIXED, SPRINGS_SHORT } SpringSize;

enum { MAX_NODES = 12, MAX_COORDINATES = 2 * MAX_NODES, MAX_SPRINGS = 40 };

/* Creates random springs between at most MAX_NODES nodes; masses and
 * stiffnesses cover four powers of ten.
 *   system  out; free it with system_free
 *   x       [MAX_COORDINATES] out */
void random_system(Random *random, SpringSize state, System *system, double *x);

/* Writes a sparse matrix to a full one [size size]. */
void fill_dense_matrix(const Sparse *A, double *dense);

/* Splits the part before " | " off a row and returns it; NULL: none is left. */
char *take_row_field(char **row);

/* Parses the words of a command line; "''" is an empty word. message [512] */
Status parse_line(const char *line, int pane, Options *options, char *message);

/* Returns the options of a command line, which must be valid. */
Options options_from_line(const char *line);

/* Sets up the simulation of a command line; free it with simulation_free. */
void simulation_from_line(const char *line, NewtonObserver observer, void *user,
                          Simulation *simulation);

/* Creates the simulation of a printf line, which the end of the test frees. */
#define simulate(...) simulate_observed(NULL, NULL, __VA_ARGS__)
Simulation *simulate_observed(NewtonObserver observer, void *user,
                              const char *line, ...)
    __attribute__((format(printf, 3, 4)));
void free_simulations(void);

/* Change an option (with this slot), a pin, or the held node (-1: none). */
Status change_option(Simulation *simulation, int slot, double value);
Status pin_node(Simulation *simulation, int node, bool pinned);
Status hold_node(Simulation *simulation, int node, double x, double y);

/* Makes `count` steps, all of which converge; returns the simulation. */
Simulation *make_steps(Simulation *simulation, int count);

/* Returns the entry `name` of a ledger, J; get_run_energy: of a run's ledger */
#define ENERGY(energies, name) get_energy(energies, #name)
double get_energy(const Energies *energies, const char *name);
double get_run_energy(const Simulation *simulation, int run, const char *name);

/* Returns a hash of the states of all runs, the time and the ledgers; `hash` is
 * STATE_HASH_SEED or the hash of the pane before. */
uint64_t hash_simulation(const Simulation *simulation, uint64_t hash);

double count_broken_springs(const Simulation *simulation);

/* Returns the allocated bytes, or 0 where the C library does not count them. */
double count_heap_bytes(void);

/* Returns the rest positions of the mesh, [2n] m, valid until the next call. */
double *get_rest_x(const Simulation *simulation);

#endif
