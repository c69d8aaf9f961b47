/* testing.c - checks, random systems and command lines for all suites. */
#include "testing.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- checks ------------------------------------------------------------ */

enum { MAX_SIMULATIONS = 1024 };

static struct {
    Simulation *simulation[MAX_SIMULATIONS];
    int simulations;
    char line[400]; /* command line of the newest simulation */
} tested;

static void fail_test(const char *file, int line)
{
    if (tested.simulations > 0)
        print_error("in: %s\n", tested.line);
    _fail(file, line);
}

void check_near(const char *what, long double got, long double expected,
                long double tolerance, const char *file, int line)
{
    if (fabsl(got - expected) <= tolerance)
        return;
    print_error("%s: got %.21Lg, expected %.21Lg, differs by %.3Lg, "
                "tolerance %.3Lg\n",
                what, got, expected, got - expected, tolerance);
    fail_test(file, line);
}

void check_at_most(const char *what, long double got, long double limit,
                   const char *file, int line)
{
    if (got <= limit)
        return;
    print_error("%s: got %.21Lg, expected at most %.21Lg\n", what, got, limit);
    fail_test(file, line);
}

void check_same_bits(const char *what, const double *got,
                     const double *expected, int count, const char *file,
                     int line)
{
    for (int i = 0; i < count; i++) {
        if (memcmp(got + i, expected + i, sizeof *got) == 0)
            continue;
        print_error("%s[%d]: got %a, expected the same bits as %a\n", what, i,
                    got[i], expected[i]);
        fail_test(file, line);
    }
}

void check_status(const char *what, Status got, Status expected,
                  const char *file, int line)
{
    if (got == expected)
        return;
    print_error("%s: got %s, expected %s\n", what, status_name(got),
                status_name(expected));
    fail_test(file, line);
}

void check_true(bool condition, const char *what, const char *file, int line)
{
    if (condition)
        return;
    print_error("not true: %s\n", what);
    fail_test(file, line);
}

bool tests_are_long(void)
{
    const char *set = getenv("LONG");
    return set && *set;
}

int choose_case_count(int all, int some)
{
#ifdef __SANITIZE_ADDRESS__
    all /= 5;
#endif
    return tests_are_long() ? all : some;
}

/* Returns 64 random bits: SplitMix64 (Steele, Lea, Flood 2014). */
static uint64_t random_bits(Random *random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double random_uniform(Random *random, double low, double high)
{
    return low + (high - low) * (double)(random_bits(random) >> 11) * 0x1p-53;
}

double random_logarithmic(Random *random, double low, double high)
{
    return exp(random_uniform(random, log(low), log(high)));
}

int random_below(Random *random, int limit)
{
    return (int)(random_bits(random) % (uint64_t)limit);
}

void random_system(Random *random, SpringSize state, System *system, double *x)
{
    int n = 3 + random_below(random, MAX_NODES - 2);
    int springs = n + random_below(random, MAX_SPRINGS - n + 1);
    CHECK_OK(system_create(n, springs, system));
    for (int i = 0; i < n; i++) {
        x[2 * i] = random_uniform(random, -1, 1);
        x[2 * i + 1] = random_uniform(random, -1, 1);
        system->m[i] = random_logarithmic(random, 1e-2, 1e2);
    }
    for (int s = 0; s < springs; s++) {
        int i = s < n ? s : random_below(random, n);
        int j = (i + 1 + random_below(random, n - 1)) % n;
        double length = hypot(x[2 * i] - x[2 * j], x[2 * i + 1] - x[2 * j + 1]);
        double rest = length / (state == SPRINGS_MIXED
                                    ? random_uniform(random, 0.1, 2)
                                    : random_logarithmic(random, 1e-9, 1e-7));
        system->e[2 * s] = i;
        system->e[2 * s + 1] = j;
        system->l2[s] = rest * rest;
        system->k[s] = random_logarithmic(random, 1e-2, 1e2);
    }
}

void fill_dense_matrix(const Sparse *A, double *dense)
{
    for (int i = 0; i < A->size * A->size; i++)
        dense[i] = 0;
    for (int c = 0; c < A->size; c++)
        for (int s = A->column_start[c]; s < A->column_start[c + 1]; s++) {
            dense[A->size * A->row[s] + c] = A->value[s];
            dense[A->size * c + A->row[s]] = A->value[s];
        }
}

char *take_row_field(char **row)
{
    char *part = *row, *bar = part ? strstr(part, " | ") : NULL;
    *row = bar ? bar + 3 : NULL;
    if (bar)
        *bar = '\0';
    return part;
}

Status parse_line(const char *line, int pane, Options *options, char *message)
{
    static char copy[1024];
    char *argv[sizeof copy / 2 + 1] = {(char[]){"elasto"}};
    int argc = 1;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " ")) {
        if (strcmp(word, "''") == 0)
            word[0] = '\0';
        argv[argc++] = word;
    }
    message[0] = '\0';
    return options_parse(argc, argv, pane, options, (Message){message, 512});
}

Options options_from_line(const char *line)
{
    char message[512];
    Options options;
    if (parse_line(line, 0, &options, message))
        print_error("%s\n", message);
    CHECK(message[0] == '\0');
    return options;
}

void simulation_from_line(const char *line, NewtonObserver observer, void *user,
                          Simulation *simulation)
{
    const Options options = options_from_line(line);
    CHECK_OK(simulation_create(&options, observer, user, simulation));
}

Simulation *simulate_observed(NewtonObserver observer, void *user,
                              const char *line, ...)
{
    va_list words;
    Simulation *run = calloc(1, sizeof *run);
    CHECK(run && tested.simulations < MAX_SIMULATIONS);
    va_start(words, line);
    vsnprintf(tested.line, sizeof tested.line, line, words);
    va_end(words);
    simulation_from_line(tested.line, observer, user, run);
    return tested.simulation[tested.simulations++] = run;
}

/* Applies a control to a simulation, and gives up the reference to it. */
static Status apply_user_control(Simulation *simulation, UserControl *control)
{
    Status status = control_apply(simulation, control);
    control_release(control);
    return status;
}

Status change_option(Simulation *simulation, int slot, double value)
{
    UserControl *control = control_create(simulation);
    control->options.number[slot] = value;
    return apply_user_control(simulation, control);
}

Status pin_node(Simulation *simulation, int node, bool pinned)
{
    UserControl *control = control_create(simulation);
    control->is_pinned[node] = pinned;
    return apply_user_control(simulation, control);
}

Status hold_node(Simulation *simulation, int node, double x, double y)
{
    UserControl *control = control_create(simulation);
    control->held_node = node;
    control->target[0] = x;
    control->target[1] = y;
    return apply_user_control(simulation, control);
}

Simulation *make_steps(Simulation *simulation, int count)
{
    for (int i = 0; i < count; i++)
        CHECK_OK(simulation_step(simulation));
    return simulation;
}

void free_simulations(void)
{
    while (tested.simulations > 0) {
        simulation_free(tested.simulation[--tested.simulations]);
        free(tested.simulation[tested.simulations]);
    }
}

double get_energy(const Energies *energies, const char *name)
{
    for (int i = 0; i < energies->count; i++)
        if (strcmp(energies->energy[i].name, name) == 0)
            return energies->energy[i].value;
    return 0;
}

double get_run_energy(const Simulation *simulation, int run, const char *name)
{
    const Energies energies = simulation_get_energies(simulation, run);
    return get_energy(&energies, name);
}

static uint64_t hash_number(uint64_t hash, double number)
{
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    return 31 * hash + bits;
}

uint64_t hash_simulation(const Simulation *simulation, uint64_t hash)
{
    hash = hash_number(state_hash(simulation, hash),
                       simulation_get_time(simulation));
    for (int r = 0; r < simulation->runs; r++) {
        const Energies ledger = simulation_get_energies(simulation, r);
        hash = hash_number(hash, ledger.work);
        for (int i = 0; i < ledger.count; i++)
            hash = hash_number(hash, ledger.energy[i].value);
        hash = hash_number(hash, simulation->ledger[r].gained_energy);
    }
    return hash;
}

double count_broken_springs(const Simulation *simulation)
{
    int count = 0;
    for (int s = 0; s < simulation->system.springs; s++)
        count += spring_is_broken(&simulation->system, s);
    return count;
}

double count_heap_bytes(void)
{
#ifdef __GLIBC__
    struct mallinfo2 now = mallinfo2();
    return (double)now.uordblks + (double)now.hblkhd;
#else
    return 0;
#endif
}

double *get_rest_x(const Simulation *simulation)
{
    static double rest[2 * 2048];
    CHECK(simulation->mesh.nodes <= 2048);
    for (int i = 0; i < simulation->mesh.nodes; i++)
        square_mesh_rest_position(&simulation->mesh, i, rest + 2 * i);
    return rest;
}
