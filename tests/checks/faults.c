/* Makes calls fail: preloaded as a library (LD_PRELOAD), where it sees every
 * library's calls too, or with -DFAULT_WRAP linked into the program by
 * -Wl,--wrap=..., where sanitizers can look on.
 *
 *   FAULT       which call: memory, open, write, close, rename, folder; hang:
 *               renaming never ends; late: what is opened for writing comes
 *               when there is a file "go"
 *   FAULT_AT    the number of the one that fails, from 1; 0: only count
 *   FAULT_ALL   set: and all after it
 *   FAULT_FILE  the number of calls goes to this file at the end
 *
 * Counting begins with main.  Streams opened for writing are replaced by ones
 * whose writes and closes can fail.
 */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#ifdef FAULT_WRAP
#define FAULTY(name)      __wrap_##name
#define REAL_MEMORY(name) __real_##name
#else
#define FAULTY(name)      name
#define REAL_MEMORY(name) __libc_##name
#endif

void *REAL_MEMORY(malloc)(size_t size);
void *REAL_MEMORY(calloc)(size_t count, size_t size);
void *REAL_MEMORY(realloc)(void *old, size_t size);

/* A function of the C library. */
#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static const char *fault_kind;
static long fault_at, fault_count;
static int fault_all;

static int is_kind(const char *kind)
{
    return fault_kind && strcmp(kind, fault_kind) == 0;
}

/* Whether this call is the one; errno is then the reason. */
static int fails(const char *kind, int reason)
{
    if (!is_kind(kind))
        return 0;
    long number = __atomic_add_fetch(&fault_count, 1, __ATOMIC_RELAXED);
    int fault =
        fault_all && fault_at > 0 ? number >= fault_at : number == fault_at;
    if (fault)
        errno = reason;
    return fault;
}

void *FAULTY(malloc)(size_t size)
{
    return fails("memory", ENOMEM) ? NULL : REAL_MEMORY(malloc)(size);
}

void *FAULTY(calloc)(size_t count, size_t size)
{
    return fails("memory", ENOMEM) ? NULL : REAL_MEMORY(calloc)(count, size);
}

void *FAULTY(realloc)(void *old, size_t size)
{
    return fails("memory", ENOMEM) ? NULL : REAL_MEMORY(realloc)(old, size);
}

/* A stream around another one. */
static ssize_t fault_write(void *cookie, const char *bytes, size_t count)
{
    if (fails("write", ENOSPC))
        return 0;
    return (ssize_t)fwrite(bytes, 1, count, cookie);
}

static int fault_close(void *cookie)
{
    int result = fclose(cookie);
    return fails("close", EIO) ? EOF : result;
}

static FILE *fault_stream(FILE *file, const char *mode)
{
    if (!file || (!is_kind("write") && !is_kind("close")))
        return file;
    setvbuf(file, NULL, _IONBF, 0);
    cookie_io_functions_t functions = {.write = fault_write,
                                       .close = fault_close};
    return fopencookie(file, mode, functions);
}

FILE *FAULTY(fopen)(const char *name, const char *mode)
{
    if (mode[0] != 'w')
        return REAL(fopen)(name, mode);
    if (fails("open", EMFILE))
        return NULL;
    return fault_stream(REAL(fopen)(name, mode), mode);
}

FILE *FAULTY(fdopen)(int file, const char *mode)
{
    return fault_stream(REAL(fdopen)(file, mode), mode);
}

/* Only of files that may be new. */
int FAULTY(open)(const char *name, int flags, ...)
{
    va_list arguments;
    va_start(arguments, flags);
    unsigned mode = flags & O_CREAT ? va_arg(arguments, unsigned) : 0;
    va_end(arguments);
    if ((flags & O_CREAT) && fails("open", EMFILE))
        return -1;
    int file = REAL(open)(name, flags, mode);
    while ((flags & O_CREAT) && is_kind("late") && access("go", F_OK) != 0)
        usleep(1000);
    return file;
}

int FAULTY(rename)(const char *from, const char *to)
{
    while (is_kind("hang"))
        pause();
    if (fails("rename", EIO))
        return -1;
    return REAL(rename)(from, to);
}

int FAULTY(mkdir)(const char *name, mode_t mode)
{
    if (fails("folder", ENOSPC))
        return -1;
    return REAL(mkdir)(name, mode);
}

/* How many calls there were. */
static void fault_report(void)
{
    const char *name = getenv("FAULT_FILE");
    fault_kind = NULL;
    FILE *file = name ? fopen(name, "w") : NULL;
    if (file) {
        fprintf(file, "%ld\n", fault_count);
        fclose(file);
    }
}

static void fault_begin(void)
{
    const char *at = getenv("FAULT_AT");
    atexit(fault_report);
    fault_at = at ? strtol(at, NULL, 10) : 0;
    fault_all = getenv("FAULT_ALL") != NULL;
    fault_kind = getenv("FAULT");
}

#ifdef FAULT_WRAP
__attribute__((constructor)) static void fault_early(void)
{
    fault_begin();
}
#else
typedef int Main(int, char **, char **);
typedef int Start(Main *, int, char **, void (*)(void), void (*)(void),
                  void (*)(void), void *);
Start __libc_start_main;
static Main *real_main;

static int fault_main(int argc, char **argv, char **environment)
{
    fault_begin();
    return real_main(argc, argv, environment);
}

int __libc_start_main(Main *function, int argc, char **argv, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void),
                      void *stack_end)
{
    real_main = function;
    return REAL(__libc_start_main)(fault_main, argc, argv, init, fini,
                                   rtld_fini, stack_end);
}
#endif
