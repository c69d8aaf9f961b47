#include "play/output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- names -------------------------------------------------------------- */

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

/* The folder that a file is in. */
static bool folder_of(const char *name, struct stat *info)
{
    char folder[PATH_MAX];
    const char *slash = strrchr(name, '/');
    int length = slash ? (int)(slash + 1 - name) : 1;
    snprintf(folder, sizeof folder, "%.*s", length, slash ? name : ".");
    return stat(folder, info) == 0;
}

bool output_is_same(const char *one, const char *other)
{
    struct stat a, b;
    bool standard = output_is_standard(one), there = stat(one, &a) == 0;
    if (standard || output_is_standard(other))
        return standard && output_is_standard(other);
    if (there != (stat(other, &b) == 0))
        return false;
    if (there)
        return same_file(&a, &b) && !is_null_device(&a);
    const char *slash = strrchr(one, '/'), *second = strrchr(other, '/');
    return strcmp(slash ? slash + 1 : one, second ? second + 1 : other) == 0 &&
           folder_of(one, &a) && folder_of(other, &b) && same_file(&a, &b);
}

const char *output_reason(int reason)
{
    if (reason == ENOTSUP)
        return "only regular files, pipes and character devices can be written";
    if (reason == EBUSY)
        return "another run is writing it";
    return strerror(reason ? reason : EIO);
}

/* ---- opening ------------------------------------------------------------ */

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

/* Takes NAME.part for this run alone.  The lock goes with the process; whoever
 * waited for one that was renamed meanwhile holds what is NAME by now. */
static bool is_ours(int file, const char *temporary)
{
    struct stat held, named;
    bool locked = flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    if (locked && fstat(file, &held) == 0 && stat(temporary, &named) == 0 &&
        same_file(&held, &named))
        return true;
    errno = EBUSY;
    return false;
}

/* NAME.part as a stream, with the permissions of the file whose place it will
 * take (info, or NULL: there is none). */
static Status open_temporary(Output *output, const struct stat *info)
{
    size_t size = strlen(output->target) + sizeof ".part";
    output->temporary = malloc(size);
    if (!output->temporary)
        return STATUS_OUT_OF_MEMORY;
    snprintf(output->temporary, size, "%s.part", output->target);
    if (info && access(output->target, W_OK))
        return STATUS_FILE_FAILED; /* somebody protected it */
    int file = open(output->temporary,
                    O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0)
        return STATUS_FILE_FAILED;
    if (is_ours(file, output->temporary) && ftruncate(file, 0) == 0 &&
        (!info || fchmod(file, info->st_mode & 0777) == 0))
        output->file = fdopen(file, "wb");
    if (output->file)
        return STATUS_OK;
    int reason = errno;
    close(file);
    errno = reason;
    return STATUS_FILE_FAILED;
}

/* By the kind of what stands under the name. */
static Status open_named(const char *name, Output *output)
{
    struct stat info;
    bool exists = stat(name, &info) == 0;
    if (!exists && errno != ENOENT)
        return STATUS_FILE_FAILED;
    if (exists && (S_ISFIFO(info.st_mode) || S_ISCHR(info.st_mode))) {
        output->file = fopen(name, "wb");
        return output->file ? STATUS_OK : STATUS_FILE_FAILED;
    }
    errno = exists && S_ISDIR(info.st_mode) ? EISDIR : ENOTSUP;
    if (exists && !S_ISREG(info.st_mode))
        return STATUS_FILE_FAILED;
    output->target = exists ? realpath(name, NULL) : strdup(name);
    if (!output->target)
        return errno == ENOMEM ? STATUS_OUT_OF_MEMORY : STATUS_FILE_FAILED;
    return open_temporary(output, exists ? &info : NULL);
}

Status output_open(const char *name, Output *output)
{
    bool standard = output_is_standard(name);
    *output = (Output){.name = strdup(standard ? "standard output" : name)};
    if (!output->name)
        return STATUS_OUT_OF_MEMORY;
    if (standard)
        output->file = stdout;
    Status status = standard ? STATUS_OK : open_named(name, output);
    if (status)
        output_forget(output);
    return status;
}

/* ---- while it is open, and its end -------------------------------------- */

/* The stream remembers that a write failed. */
Status output_check(const Output *output)
{
    bool failed = output->file && ferror(output->file);
    return failed ? STATUS_FILE_FAILED : STATUS_OK;
}

/* Where the first line stands that begins with a number above `last`. */
static long find_line(FILE *file, long last)
{
    char *line = NULL, *end;
    size_t size = 0;
    long at = 0;
    ssize_t length;
    while (last >= 0 && (length = getline(&line, &size, file)) >= 0) {
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

/* Every call that can tell of a failed write is asked; errno tells why.  A
 * second descriptor holds the lock until the file has its name. */
Status output_close(Output *output)
{
    if (!output->file)
        return STATUS_OK;
    bool whole = !ferror(output->file);
    int reason = errno ? errno : EIO;
    int lock = output->temporary ? dup(fileno(output->file)) : -1;
    if (fflush(output->file) && whole) {
        whole = false;
        reason = errno;
    }
    if (output->file != stdout && fclose(output->file) && whole) {
        whole = false;
        reason = errno;
    }
    if (whole && output->temporary &&
        rename(output->temporary, output->target)) {
        whole = false;
        reason = errno;
    }
    if (lock >= 0)
        close(lock);
    errno = reason;
    output_forget(output);
    return whole ? STATUS_OK : STATUS_FILE_FAILED;
}

void output_discard(Output *output, bool keep)
{
    int reason = errno;
    if (!output->file)
        return;
    if (output->temporary && !keep)
        remove(output->temporary);
    if (output->file != stdout)
        fclose(output->file);
    errno = reason;
    output_forget(output);
}
