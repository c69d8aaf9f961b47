#include "play/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

bool output_is_standard(const char *name)
{
    return strcmp(name, "-") == 0 || strcmp(name, "/dev/stdout") == 0;
}

const char *output_reason(Status status)
{
    return status != STATUS_FILE_FAILED ? status_text(status)
           : errno == EBUSY             ? "it is being written already"
                                        : strerror(errno ? errno : EIO);
}

/* ---- opening ------------------------------------------------------------ */

/* NAME.part as a stream that nobody else writes, with the permissions of the
 * file whose place it will take (info, or NULL: there is none). */
static Status open_temporary(const char *name, Output *output,
                             const struct stat *info)
{
    output->target = info ? realpath(name, NULL) : strdup(name);
    if (!output->target)
        return errno == ENOMEM ? STATUS_OUT_OF_MEMORY : STATUS_FILE_FAILED;
    if (info && access(name, W_OK))
        return STATUS_FILE_FAILED; /* somebody protected it */
    size_t size = strlen(output->target) + sizeof ".part";
    output->temporary = malloc(size);
    if (!output->temporary)
        return STATUS_OUT_OF_MEMORY;
    snprintf(output->temporary, size, "%s.part", output->target);
    int file = open(output->temporary,
                    O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0)
        return STATUS_FILE_FAILED;
    struct stat ours, there; /* another run may have taken the name away before
                                the lock was ours */
    bool alone =
        (flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) &&
        fstat(file, &ours) == 0 && lstat(output->temporary, &there) == 0 &&
        ours.st_ino == there.st_ino;
    errno = alone ? errno : EBUSY;
    if (alone && ftruncate(file, 0) == 0 &&
        (!info || fchmod(file, info->st_mode & 0777) == 0))
        output->file = fdopen(file, "w+b");
    int reason = errno;
    if (!output->file)
        close(file);
    errno = reason;
    return output->file ? STATUS_OK : STATUS_FILE_FAILED;
}

Status output_open(const char *name, Output *output)
{
    struct stat info;
    bool standard = output_is_standard(name);
    bool exists = !standard && stat(name, &info) == 0;
    bool unknown = !standard && !exists && errno != ENOENT;
    Status status = STATUS_OK;
    *output = (Output){.name = strdup(standard ? "standard output" : name)};
    if (!output->name)
        return STATUS_OUT_OF_MEMORY;
    if (standard)
        output->file = stdout;
    else if (exists && !S_ISREG(info.st_mode))
        output->file = fopen(name, "wb");
    else if (!unknown)
        status = open_temporary(name, output, exists ? &info : NULL);
    if (!output->file && !status)
        status = STATUS_FILE_FAILED;
    return status ? output_close(output, status) : STATUS_OK;
}

/* ---- its end ------------------------------------------------------------ */

/* Every call that can tell of a failed write is asked; errno tells why.  A
 * second descriptor holds the lock until the file has its name. */
Status output_close(Output *output, Status status)
{
    FILE *file = output->file;
    int before = errno;
    int lock = file && output->temporary ? dup(fileno(file)) : -1;
    bool whole = !status;
    if (file) {
        whole = !ferror(file) && whole;
        whole = fflush(file) == 0 && whole;
        if (file != stdout)
            whole = fclose(file) == 0 && whole;
        if (output->temporary && whole)
            whole = rename(output->temporary, output->target) == 0;
    }
    int reason = status ? before : errno;
    if (lock >= 0)
        close(lock);
    free(output->name);
    free(output->target);
    free(output->temporary);
    *output = (Output){0};
    errno = reason;
    return status || whole ? status : STATUS_FILE_FAILED;
}

void output_discard(Output *output)
{
    int reason = errno;
    if (output->temporary)
        remove(output->temporary);
    output_close(output, STATUS_INTERRUPTED);
    errno = reason;
}
