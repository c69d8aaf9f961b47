/* Every allocation of ours and of CHOLMOD's fails once, and then for good:
 * OUT_OF_MEMORY, every block is freed, nothing crashes.  ../tests.mk wraps the
 * functions. */
#include "test.h"

#include <SuiteSparse_config.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__real_aligned_alloc(size_t page, size_t size);
void __real_free(void *block);

static long allocations;        /* allocations so far */
static long held;               /* blocks that were not freed */
static long first_failure = -1; /* the one that fails; -1: none */
static bool for_good;           /* the following allocations fail, too */

static bool allocation_fails(void)
{
    long number = allocations++;
    return first_failure >= 0 &&
           (for_good ? number >= first_failure : number == first_failure);
}

static void *track(void *block)
{
    held += block != NULL;
    return block;
}

void *__wrap_malloc(size_t size)
{
    return allocation_fails() ? NULL : track(__real_malloc(size));
}

void *__wrap_calloc(size_t count, size_t size)
{
    return allocation_fails() ? NULL : track(__real_calloc(count, size));
}

void *__wrap_aligned_alloc(size_t page, size_t size)
{
    return allocation_fails() ? NULL : track(__real_aligned_alloc(page, size));
}

void *__wrap_realloc(void *old, size_t size)
{
    void *new = allocation_fails() ? NULL : __real_realloc(old, size);
    held += new && !old;
    return new;
}

void __wrap_free(void *block)
{
    held -= block != NULL;
    __real_free(block);
}

/* CHOLMOD gets the same ones; how depends on its version. */
static void share_with_cholmod(void)
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

/* Set-up and one step. */
static Status run_once(const Options *options)
{
    Simulation simulation;
    allocations = held = 0;
    Status status = simulation_create(options, NULL, NULL, &simulation);
    if (!status)
        status = simulation_step(&simulation);
    first_failure = -1;
    simulation_free(&simulation);
    CHECK(held == 0);
    return status;
}

/* Small and large squares, indefinite factors; contact, friction, cells, flow,
 * damping and breaking. */
TEST(every_allocation_may_fail)
{
    static const char *const lines[] = {
        "--segments 3", "--segments 19", "--projection none",
        "dent --segments 3 --damping 0.01 --tear 0.3",
        "--segments 2 --body 0,0 --body 1.001,0 --self-friction 1"};
    share_with_cholmod();
    for (size_t l = 0; l < sizeof lines / sizeof *lines; l++) {
        const Options options = line_options(lines[l]);
        CHECK_OK(run_once(&options));
        long total = allocations;
        CHECK(total > 5);
        for (long i = 0; i < 2 * total; i++) {
            for_good = i >= total;
            first_failure = i % total;
            Status status = run_once(&options);
            if (status != STATUS_OUT_OF_MEMORY)
                print_error("%s: %ld of %ld\n", lines[l], i, total);
            CHECK_STATUS(status, STATUS_OUT_OF_MEMORY);
        }
        for_good = false;
    }
}

TESTS(NULL, NULL)
