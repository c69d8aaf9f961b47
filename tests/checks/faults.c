/* faults.c - makes library calls fail; LD_PRELOAD loads it.
 *
 *   FAULT       kind of calls: memory, rename; hang: renaming never ends
 *   FAULT_AT    number of the failing call, from 1 after main begins; 0: none
 *   FAULT_FILE  file to which the number of calls is written at the end */
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);

/* The function of this name in the C library */
#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static const char *fault_kind;
static long fault_at, fault_count;

static int fault_is_of_kind(const char *kind)
{
    return fault_kind && strcmp(kind, fault_kind) == 0;
}

/* Counts a call, and returns 1 and sets errno if it is to fail. */
static int call_fails(const char *kind, int reason)
{
    if (!fault_is_of_kind(kind))
        return 0;
    int fault =
        __atomic_add_fetch(&fault_count, 1, __ATOMIC_RELAXED) == fault_at;
    if (fault)
        errno = reason;
    return fault;
}

void *malloc(size_t size)
{
    return call_fails("memory", ENOMEM) ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return call_fails("memory", ENOMEM) ? NULL : __libc_calloc(count, size);
}

void *realloc(void *old, size_t size)
{
    return call_fails("memory", ENOMEM) ? NULL : __libc_realloc(old, size);
}

int rename(const char *from, const char *to)
{
    while (fault_is_of_kind("hang"))
        pause();
    if (call_fails("rename", EIO))
        return -1;
    return REAL(rename)(from, to);
}

/* Writes the number of counted calls to FAULT_FILE. */
static void fault_write_call_count(void)
{
    const char *name = getenv("FAULT_FILE");
    fault_kind = NULL;
    FILE *file = name ? fopen(name, "w") : NULL;
    if (file) {
        fprintf(file, "%ld\n", fault_count);
        fclose(file);
    }
}

static void fault_init(void)
{
    const char *at = getenv("FAULT_AT");
    atexit(fault_write_call_count);
    fault_at = at ? strtol(at, NULL, 10) : 0;
    fault_kind = getenv("FAULT");
}

typedef int EntryPoint(int, char **, char **);
typedef int LibcStartMain(EntryPoint *, int, char **, void (*)(void),
                          void (*)(void), void (*)(void), void *);
LibcStartMain __libc_start_main;
static EntryPoint *real_main;

static int main_with_faults(int argc, char **argv, char **environment)
{
    fault_init();
    return real_main(argc, argv, environment);
}

int __libc_start_main(EntryPoint *function, int argc, char **argv,
                      void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void *stack_end)
{
    real_main = function;
    return REAL(__libc_start_main)(main_with_faults, argc, argv, init, fini,
                                   rtld_fini, stack_end);
}
