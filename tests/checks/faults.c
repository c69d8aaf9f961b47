/* Makes calls fail: preloaded as a library (LD_PRELOAD), where it sees every
 * library's calls too, or with -DFAULT_WRAP linked into the program by
 * -Wl,--wrap=..., where sanitizers can look on.
 *
 *   FAULT       which call: memory, open, write, close, rename, folder; hang:
 *               renaming never ends
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

typedef int MainFunction(int, char **, char **);
typedef FILE *OpenFunction(const char *, const char *);
typedef FILE *AttachFunction(int, const char *);
typedef int PathFunction(const char *, int, ...);
typedef int RenameFunction(const char *, const char *);
typedef int FolderFunction(const char *, mode_t);

static const char *fault_kind;
static long fault_at, fault_count;
static int fault_all;

void *REAL_MEMORY(malloc)(size_t size);
void *REAL_MEMORY(calloc)(size_t count, size_t size);
void *REAL_MEMORY(realloc)(void *old, size_t size);
void *FAULTY(malloc)(size_t size);
void *FAULTY(calloc)(size_t count, size_t size);
void *FAULTY(realloc)(void *old, size_t size);
OpenFunction FAULTY(fopen);
AttachFunction FAULTY(fdopen);
PathFunction FAULTY(open);
RenameFunction FAULTY(rename);
FolderFunction FAULTY(mkdir);

/* The function of the C library. */
static void (*real_function(const char *name))(void)
{
    void (*function)(void);
    void *symbol = dlsym(RTLD_NEXT, name);
    memcpy(&function, &symbol, sizeof function);
    return function;
}

/* Whether this call is the one. */
static int fault_fails(const char *kind)
{
    if (!fault_kind || strcmp(kind, fault_kind) != 0)
        return 0;
    long number = __atomic_add_fetch(&fault_count, 1, __ATOMIC_RELAXED);
    return fault_all && fault_at > 0 ? number >= fault_at : number == fault_at;
}

void *FAULTY(malloc)(size_t size)
{
    if (fault_fails("memory")) {
        errno = ENOMEM;
        return NULL;
    }
    return REAL_MEMORY(malloc)(size);
}

void *FAULTY(calloc)(size_t count, size_t size)
{
    if (fault_fails("memory")) {
        errno = ENOMEM;
        return NULL;
    }
    return REAL_MEMORY(calloc)(count, size);
}

void *FAULTY(realloc)(void *old, size_t size)
{
    if (fault_fails("memory")) {
        errno = ENOMEM;
        return NULL;
    }
    return REAL_MEMORY(realloc)(old, size);
}

/* A stream around another one. */
static ssize_t fault_write(void *cookie, const char *bytes, size_t count)
{
    if (fault_fails("write")) {
        errno = ENOSPC;
        return 0;
    }
    return (ssize_t)fwrite(bytes, 1, count, cookie);
}

static int fault_close(void *cookie)
{
    int result = fclose(cookie);
    if (fault_fails("close")) {
        errno = EIO;
        return EOF;
    }
    return result;
}

/* A stream that can fail, around a real one. */
static FILE *fault_stream(FILE *file, const char *mode)
{
    if (!file || !fault_kind ||
        (strcmp(fault_kind, "write") != 0 && strcmp(fault_kind, "close") != 0))
        return file;
    setvbuf(file, NULL, _IONBF, 0);
    cookie_io_functions_t functions = {.write = fault_write,
                                       .close = fault_close};
    return fopencookie(file, mode, functions);
}

FILE *FAULTY(fopen)(const char *name, const char *mode)
{
    OpenFunction *real = (OpenFunction *)real_function("fopen");
    if (mode[0] != 'w')
        return real(name, mode);
    if (fault_fails("open")) {
        errno = EMFILE;
        return NULL;
    }
    return fault_stream(real(name, mode), mode);
}

FILE *FAULTY(fdopen)(int file, const char *mode)
{
    AttachFunction *real = (AttachFunction *)real_function("fdopen");
    return fault_stream(real(file, mode), mode);
}

/* Only of files that may be new. */
int FAULTY(open)(const char *name, int flags, ...)
{
    PathFunction *real = (PathFunction *)real_function("open");
    va_list arguments;
    va_start(arguments, flags);
    unsigned mode = flags & O_CREAT ? va_arg(arguments, unsigned) : 0;
    va_end(arguments);
    if ((flags & O_CREAT) && fault_fails("open")) {
        errno = EMFILE;
        return -1;
    }
    return real(name, flags, mode);
}

int FAULTY(rename)(const char *from, const char *to)
{
    RenameFunction *real = (RenameFunction *)real_function("rename");
    while (fault_kind && strcmp(fault_kind, "hang") == 0)
        pause();
    if (fault_fails("rename")) {
        errno = EIO;
        return -1;
    }
    return real(from, to);
}

int FAULTY(mkdir)(const char *name, mode_t mode)
{
    FolderFunction *real = (FolderFunction *)real_function("mkdir");
    if (fault_fails("folder")) {
        errno = ENOSPC;
        return -1;
    }
    return real(name, mode);
}

/* How many calls there were. */
static void fault_report(void)
{
    const char *name = getenv("FAULT_FILE");
    OpenFunction *real = (OpenFunction *)real_function("fopen");
    long count = fault_count;
    fault_kind = NULL;
    FILE *file = name ? real(name, "w") : NULL;
    if (file) {
        fprintf(file, "%ld\n", count);
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
int __libc_start_main(MainFunction *function, int argc, char **argv,
                      void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void *stack_end);

static MainFunction *real_main;

static int fault_main(int argc, char **argv, char **environment)
{
    fault_begin();
    return real_main(argc, argv, environment);
}

typedef int StartFunction(MainFunction *, int, char **, void (*)(void),
                          void (*)(void), void (*)(void), void *);

int __libc_start_main(MainFunction *function, int argc, char **argv,
                      void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void *stack_end)
{
    StartFunction *real = (StartFunction *)real_function("__libc_start_main");
    real_main = function;
    return real(fault_main, argc, argv, init, fini, rtld_fini, stack_end);
}
#endif
