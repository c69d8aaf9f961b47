#include "solve/one_thread.h"

#include <dlfcn.h>
#include <stddef.h>
#include <string.h>

/* Calls a function of a library that CHOLMOD may have brought along. */
static void call_if_loaded(const char *name, int argument)
{
    void (*function)(int);
    void *symbol = dlsym(RTLD_DEFAULT, name);
    if (!symbol)
        return;
    memcpy(&function, &symbol, sizeof function);
    function(argument);
}

void one_thread(void)
{
    call_if_loaded("omp_set_max_active_levels", 0);
    call_if_loaded("openblas_set_num_threads", 1);
}

/* Two library functions that CHOLMOD calls and that would take a part of every
 * factorisation; the program's own come before those of the libraries (weak: a
 * static library may bring its own).  `make ONE_THREAD=0` leaves them out; the
 * bits of all results are the same.
 *
 * GCC's OpenMP runs CHOLMOD's parallel loops.  One thread is wanted: each loop
 * runs where it is called, without a team of one being set up around it. */
#if ELASTO_ONE_THREAD

__attribute__((weak)) void GOMP_parallel(void (*loop)(void *), void *data,
                                         unsigned threads, unsigned flags);
void GOMP_parallel(void (*loop)(void *), void *data, unsigned threads,
                   unsigned flags)
{
    (void)threads;
    (void)flags;
    loop(data);
}

/* The clock, read before and after each call of BLAS for a statistic that is
 * not used here. */
__attribute__((weak)) double SuiteSparse_time(void);
double SuiteSparse_time(void)
{
    return 0;
}

#endif
