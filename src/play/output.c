#include "play/output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    MOST_LINKS = 40,       /* of a chain, as the system's own limit */
    MOST_TEMPORARIES = 99, /* NAME.part, NAME.part2 ... */
    NUMBER_ROOM = 16
};

static const char PART[] = ".part";

/* ---- names ----------------------------------------------------------------
 */

/* Three texts one after the other, in memory of its own, or NULL. */
static char *join_texts(const char *first, const char *second,
                        const char *third)
{
    size_t size = strlen(first) + strlen(second) + strlen(third) + 1;
    char *text = malloc(size);
    if (text)
        snprintf(text, size, "%s%s%s", first, second, third);
    return text;
}

/* The folder of a path with its slash, or "./"; *base is what follows. */
static char *split_path(const char *path, const char **base)
{
    const char *slash = strrchr(path, '/');
    *base = slash ? slash + 1 : path;
    if (!slash)
        return join_texts("./", "", "");
    char *folder = join_texts(path, "", "");
    if (folder)
        folder[slash + 1 - path] = '\0';
    return folder;
}

/* Where a link leads, relative to the present folder; NULL: no link. */
static char *read_link(const char *path)
{
    char text[PATH_MAX];
    ssize_t length = readlink(path, text, sizeof text - 1);
    if (length < 0)
        return NULL;
    text[length] = '\0';
    if (text[0] == '/')
        return join_texts(text, "", "");
    const char *base;
    char *folder = split_path(path, &base), *joined = NULL;
    if (folder)
        joined = join_texts(folder, text, "");
    free(folder);
    return joined;
}

/* The real path of a file that is not there yet, in a folder that is. */
static char *new_target(const char *path)
{
    const char *base;
    char *folder = split_path(path, &base), *real = NULL, *target = NULL;
    if (folder)
        real = realpath(folder, NULL);
    if (real && base[0] == '\0')
        errno = EISDIR;
    else if (real)
        target = join_texts(real, strcmp(real, "/") == 0 ? "" : "/", base);
    free(folder);
    free(real);
    return target;
}

char *output_target(const char *name)
{
    char *path = join_texts(name, "", "");
    for (int links = 0; path && links < MOST_LINKS; links++) {
        char *target = realpath(path, NULL);
        if (!target && errno == ENOENT) {
            char *next = read_link(path);
            if (next) { /* a link to what is not there yet */
                free(path);
                path = next;
                continue;
            }
            target = new_target(path);
        }
        int reason = errno;
        free(path);
        errno = reason;
        return target;
    }
    free(path);
    errno = path ? ELOOP : ENOMEM;
    return NULL;
}

/* Whether two descriptions are of one file. */
static bool same_file(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* /dev/null takes everything from everybody. */
static bool is_null_device(const struct stat *info)
{
    struct stat null;
    return stat("/dev/null", &null) == 0 && same_file(info, &null);
}

bool output_is_standard(const char *name)
{
    struct stat named, standard;
    if (strcmp(name, "-") == 0)
        return true;
    if (stat(name, &named) || fstat(STDOUT_FILENO, &standard))
        return strcmp(name, "/dev/stdout") == 0;
    return same_file(&named, &standard) && !is_null_device(&named);
}

/* Whether a path is another one's NAME.part, or NAME.part2 ... */
static bool is_temporary_of(const char *path, const char *target)
{
    size_t length = strlen(target);
    if (strncmp(path, target, length) != 0 ||
        strncmp(path + length, PART, sizeof PART - 1) != 0)
        return false;
    path += length + sizeof PART - 1;
    return path[strspn(path, "0123456789")] == '\0';
}

bool output_collides(const char *one, const char *other)
{
    struct stat first, second;
    bool standard = output_is_standard(one);
    if (standard || output_is_standard(other))
        return standard && output_is_standard(other);
    if (stat(one, &first) == 0 && stat(other, &second) == 0)
        return same_file(&first, &second) && !is_null_device(&first);
    char *a = output_target(one), *b = output_target(other);
    bool collides =
        a && b &&
        (strcmp(a, b) == 0 || is_temporary_of(a, b) || is_temporary_of(b, a));
    free(a);
    free(b);
    return collides;
}

/* ---- opening ---------------------------------------------------------------
 */

/* Forgets the names; keeps errno. */
static void output_forget(Output *output)
{
    int reason = errno;
    free(output->name);
    free(output->target);
    free(output->temporary);
    *output = (Output){0};
    errno = reason;
}

/* A file of our own beside the target, which nothing was before.  Returns its
 * descriptor, or -1. */
static int make_temporary(Output *output, mode_t mode)
{
    for (int i = 1; i <= MOST_TEMPORARIES; i++) {
        char number[NUMBER_ROOM] = "";
        if (i > 1)
            snprintf(number, sizeof number, "%d", i);
        free(output->temporary);
        output->temporary = join_texts(output->target, PART, number);
        if (!output->temporary)
            return -1;
        int file = open(output->temporary,
                        O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (file >= 0 || errno != EEXIST)
            return file;
    }
    return -1;
}

/* The temporary file as a stream, with the permissions of the file whose place
 * it takes (info, or NULL: there is none). */
static Status open_temporary(Output *output, const struct stat *info)
{
    if (info && access(output->target, W_OK))
        return STATUS_FILE_FAILED; /* somebody protected it */
    int file = make_temporary(output, info ? info->st_mode & 0600 : 0666);
    if (file < 0)
        return output->temporary ? STATUS_FILE_FAILED : STATUS_OUT_OF_MEMORY;
    if (info && (info->st_uid != geteuid() || info->st_gid != getegid()))
        (void)!fchown(file, info->st_uid, info->st_gid);
    if (!info || fchmod(file, info->st_mode & 07777) == 0)
        output->file = fdopen(file, "wb");
    if (output->file)
        return STATUS_OK;
    int reason = errno;
    close(file);
    remove(output->temporary);
    errno = reason;
    return STATUS_FILE_FAILED;
}

/* Pipes and character devices; nothing of theirs can be lost. */
static Status open_stream(const char *name, Output *output)
{
    output->file = fopen(name, "wb");
    return output->file ? STATUS_OK : STATUS_FILE_FAILED;
}

/* By the kind of what stands under the name. */
static Status open_named(const char *name, Output *output)
{
    struct stat info, real;
    bool exists = stat(name, &info) == 0;
    if (exists && (S_ISFIFO(info.st_mode) || S_ISCHR(info.st_mode)))
        return open_stream(name, output);
    if (exists && !S_ISREG(info.st_mode)) {
        errno = S_ISDIR(info.st_mode) ? EISDIR : ENOTSUP;
        return STATUS_FILE_FAILED;
    }
    if (!exists && errno != ENOENT)
        return STATUS_FILE_FAILED;
    output->target = output_target(name);
    if (!output->target)
        return errno == ENOMEM ? STATUS_OUT_OF_MEMORY : STATUS_FILE_FAILED;
    if (exists && (stat(output->target, &real) || !same_file(&info, &real))) {
        errno = ENOENT; /* open elsewhere, but without a name by now */
        return STATUS_FILE_FAILED;
    }
    return open_temporary(output, exists ? &info : NULL);
}

Status output_open(const char *name, Output *output)
{
    bool standard = output_is_standard(name);
    *output = (Output){0};
    output->name = join_texts(standard ? "standard output" : name, "", "");
    if (!output->name)
        return STATUS_OUT_OF_MEMORY;
    if (standard) {
        output->file = stdout;
        return STATUS_OK;
    }
    Status status = open_named(name, output);
    if (status)
        output_forget(output);
    return status;
}

/* ---- while it is open ------------------------------------------------------
 */

/* The stream remembers that a write failed. */
Status output_check(const Output *output)
{
    if (output->file && ferror(output->file))
        return STATUS_FILE_FAILED;
    return STATUS_OK;
}

/* Empties NAME.part; elsewhere the new text follows the old. */
Status output_restart(Output *output)
{
    if (!output->file || !output->temporary)
        return STATUS_OK;
    if (fflush(output->file) || ftruncate(fileno(output->file), 0) ||
        fseek(output->file, 0, SEEK_SET))
        return STATUS_FILE_FAILED;
    return STATUS_OK;
}

/* Where the first line stands that begins with a number above `last`. */
static long find_line(FILE *file, long last)
{
    char *line = NULL, *end;
    size_t size = 0;
    long at = 0;
    ssize_t length;
    while ((length = getline(&line, &size, file)) >= 0) {
        long number = strtol(line, &end, 10);
        if (end != line && number > last)
            break;
        at += length;
    }
    free(line);
    return at;
}

Status output_cut(Output *output, long last)
{
    if (!output->file || !output->temporary)
        return STATUS_OK;
    if (fflush(output->file))
        return STATUS_FILE_FAILED;
    FILE *file = fopen(output->temporary, "r");
    if (!file)
        return STATUS_FILE_FAILED;
    long at = find_line(file, last);
    fclose(file);
    if (ftruncate(fileno(output->file), at) || fseek(output->file, 0, SEEK_END))
        return STATUS_FILE_FAILED;
    return STATUS_OK;
}

/* ---- closing ---------------------------------------------------------------
 */

/* Every call that can tell of a failed write is asked; errno tells why. */
static bool close_stream(Output *output)
{
    bool failed = ferror(output->file) != 0;
    int reason = failed && errno ? errno : EIO;
    if (fflush(output->file) && !failed) {
        failed = true;
        reason = errno;
    }
    if (output->file != stdout && fclose(output->file) && !failed) {
        failed = true;
        reason = errno;
    }
    errno = reason;
    return !failed;
}

Status output_close(Output *output, bool keep)
{
    if (!output->file)
        return STATUS_OK;
    bool whole = close_stream(output);
    if (whole && output->temporary)
        whole = rename(output->temporary, output->target) == 0;
    int reason = errno;
    if (!whole && output->temporary && !keep)
        remove(output->temporary);
    errno = reason;
    output_forget(output);
    return whole ? STATUS_OK : STATUS_FILE_FAILED;
}

Status output_set_aside(Output *output)
{
    if (!output->file)
        return STATUS_OK;
    if (!output->target || access(output->target, F_OK))
        return output_close(output, true);
    bool whole = close_stream(output);
    output_forget(output);
    return whole ? STATUS_OK : STATUS_FILE_FAILED;
}

/* Nothing under the name changes. */
void output_discard(Output *output)
{
    int reason = errno;
    if (!output->file)
        return;
    if (output->file != stdout)
        fclose(output->file);
    if (output->temporary)
        remove(output->temporary);
    errno = reason;
    output_forget(output);
}
