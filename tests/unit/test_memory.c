/* Every allocation of ours and of CHOLMOD's fails once, and then for good:
 * OUT_OF_MEMORY, nothing leaks, nothing crashes.  Linked with
 * -Wl,--wrap=malloc,--wrap=calloc.
 */
#include "test.h"

#include <stdlib.h>
#include <string.h>

#include <SuiteSparse_config.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);

static long allocations;        /* so far */
static long first_failure = -1; /* the one that fails; -1: none */
static bool for_good;           /* and all after it */

static bool allocation_fails(void)
{
    long number = allocations++;
    return first_failure >= 0 &&
           (for_good ? number >= first_failure : number == first_failure);
}

void *__wrap_malloc(size_t size)
{
    return allocation_fails() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    return allocation_fails() ? NULL : __real_calloc(count, size);
}

/* CHOLMOD gets the same ones; how depends on its version. */
static void share_with_cholmod(void)
{
#if SUITESPARSE_MAIN_VERSION >= 7
    SuiteSparse_config_malloc_func_set(__wrap_malloc);
    SuiteSparse_config_calloc_func_set(__wrap_calloc);
#else
    SuiteSparse_config.malloc_func = __wrap_malloc;
    SuiteSparse_config.calloc_func = __wrap_calloc;
#endif
}

/* Set-up and one step of this command line. */
static Status run_once(int argc, char **argv)
{
    Options options;
    Simulation simulation;
    char message[256];
    char *copy[8];
    memcpy(copy, argv, (size_t)argc * sizeof *copy);
    CHECK_STATUS(
        options_parse(argc, copy, 0, &options, message, sizeof message),
        STATUS_OK);
    allocations = 0;
    Status status = simulation_create(&options, NULL, NULL, &simulation);
    if (!status)
        status = simulation_step(&simulation);
    first_failure = -1;
    simulation_free(&simulation);
    return status;
}

static void check_failures(int argc, char **argv)
{
    share_with_cholmod();
    first_failure = -1;
    CHECK_STATUS(run_once(argc, argv), STATUS_OK);
    long total = allocations;
    CHECK(total > 20);
    for (int pass = 0; pass < 2; pass++)
        for (long i = 0; i < total; i++) {
            for_good = pass == 1;
            first_failure = i;
            Status status = run_once(argc, argv);
            if (status != STATUS_OUT_OF_MEMORY)
                print_error("allocation %ld of %ld\n", i, total);
            CHECK_STATUS(status, STATUS_OUT_OF_MEMORY);
        }
    for_good = false;
}

TEST(small_squares_run_out)
{
    char program[] = "elasto", option[] = "--segments=3";
    check_failures(2, (char *[]){program, option, NULL});
}

TEST(large_squares_run_out)
{
    char program[] = "elasto", option[] = "--segments=19";
    check_failures(2, (char *[]){program, option, NULL});
}

TEST(indefinite_factors_run_out)
{
    char program[] = "elasto", option[] = "--filter=none";
    check_failures(2, (char *[]){program, option, NULL});
}

/* Contact, friction, cells, flow, damping and breaking. */
TEST(all_terms_run_out)
{
    char program[] = "elasto", scene[] = "dent", option[] = "--segments=3";
    char damped[] = "--damping=0.01", tears[] = "--tear=0.3";
    check_failures(5, (char *[]){program, scene, option, damped, tears, NULL});
}

TESTS(NULL, NULL)
