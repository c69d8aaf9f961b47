/* test_memory.c - each allocation of the program and of CHOLMOD fails once, or
 * from then on: the status is OUT_OF_MEMORY, all blocks are freed, nothing
 * crashes. ../tests.mk wraps the functions. */
#include "test.h"

#include <SuiteSparse_config.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__real_aligned_alloc(size_t page, size_t size);
void __real_free(void *block);

static long allocations;        /* allocations so far */
static long block_count;        /* number of blocks not freed */
static long first_failure = -1; /* number of the failing allocation; -1: none */
static bool keeps_failing;      /* later allocations fail, too */

static bool allocation_fails(void)
{
    long number = allocations++;
    return first_failure >= 0 &&
           (keeps_failing ? number >= first_failure : number == first_failure);
}

static void *track_block(void *block)
{
    block_count += block != NULL;
    return block;
}

void *__wrap_malloc(size_t size)
{
    return allocation_fails() ? NULL : track_block(__real_malloc(size));
}

void *__wrap_calloc(size_t count, size_t size)
{
    return allocation_fails() ? NULL : track_block(__real_calloc(count, size));
}

void *__wrap_aligned_alloc(size_t page, size_t size)
{
    return allocation_fails() ? NULL
                              : track_block(__real_aligned_alloc(page, size));
}

void *__wrap_realloc(void *old, size_t size)
{
    void *new = allocation_fails() ? NULL : __real_realloc(old, size);
    block_count += new && !old;
    return new;
}

void __wrap_free(void *block)
{
    block_count -= block != NULL;
    __real_free(block);
}

/* Gives the wrapped functions to CHOLMOD; the way depends on its version. */
static void share_allocator_with_cholmod(void)
{
#if SUITESPARSE_MAIN_VERSION >= 7
    SuiteSparse_config_malloc_func_set(__wrap_malloc);
    SuiteSparse_config_calloc_func_set(__wrap_calloc);
    SuiteSparse_config_free_func_set(__wrap_free);
#else
    SuiteSparse_config.malloc_func = __wrap_malloc;
    SuiteSparse_config.calloc_func = __wrap_calloc;
    SuiteSparse_config.free_func = __wrap_free;
#endif
}

static Status simulate_one_step(const Options *options)
{
    Simulation simulation;
    allocations = block_count = 0;
    Status status = simulation_create(options, NULL, NULL, &simulation);
    if (!status)
        status = simulation_step(&simulation);
    first_failure = -1;
    simulation_free(&simulation);
    CHECK(block_count == 0);
    return status;
}

/* Small and large squares, indefinite factors, contact, friction, cells, flow,
 * damping and fracture survive each failure. */
TEST(every_allocation_may_fail)
{
    static const char *const lines[] = {
        "--segments 3", "--segments 19", "--projection none",
        "dent --segments 3 --damping 0.01 --tear 0.3",
        "--segments 2 --body 0,0 --body 1.001,0 --self-friction 1"};
    share_allocator_with_cholmod();
    for (size_t l = 0; l < sizeof lines / sizeof *lines; l++) {
        const Options options = options_from_line(lines[l]);
        CHECK_OK(simulate_one_step(&options));
        long total = allocations;
        CHECK(total > 5);
        for (long i = 0; i < 2 * total; i++) {
            keeps_failing = i >= total;
            first_failure = i % total;
            Status status = simulate_one_step(&options);
            if (status != STATUS_OUT_OF_MEMORY)
                print_error("%s: %ld of %ld\n", lines[l], i, total);
            CHECK_STATUS(status, STATUS_OUT_OF_MEMORY);
        }
        keeps_failing = false;
    }
}

TESTS(NULL, NULL)
