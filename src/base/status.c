/* status.c - the names and texts of all statuses. */
#include "base/status.h"

#define STATUS_ROW(name, lower, text) {#lower, text},
static const struct {
    const char *name, *text;
} status_rows[STATUS_COUNT] = {STATUSES(STATUS_ROW)};

const char *status_text(Status status)
{
    return status_rows[status].text;
}

const char *status_name(Status status)
{
    return status_rows[status].name;
}

bool status_is_unconverged(Status status)
{
    return status >= STATUS_ITERATION_LIMIT && status <= STATUS_DIVERGED;
}

bool status_is_failure(Status status)
{
    return status > STATUS_DIVERGED;
}
