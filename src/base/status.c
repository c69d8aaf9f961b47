#include "base/status.h"

static const struct {
    const char *name, *text;
} status_rows[STATUS_COUNT] = {
    [STATUS_OK] = {"ok", "converged"},
    [STATUS_RUNNING] = {"running", "not at the end yet"},
    [STATUS_ITERATION_LIMIT] = {"iteration_limit",
                                "Newton used all its iterations"},
    [STATUS_LINE_SEARCH_LIMIT] =
        {"line_search_limit",
         "the line search found no step that lowers the energy"},
    [STATUS_NOT_DESCENT] =
        {"not_descent",
         "the search direction points uphill and no small step along it helps"},
    [STATUS_ROUNDING_LIMIT] =
        {"rounding_limit",
         "rounding hides every further decrease above the tolerance"},
    [STATUS_NOT_A_MINIMUM] = {"not_a_minimum",
                              "the gradient vanished, but not at a minimum"},
    [STATUS_NOT_POSITIVE_DEFINITE] = {"not_positive_definite",
                                      "the Hessian is not positive definite"},
    [STATUS_SINGULAR] = {"singular", "the Hessian is singular"},
    [STATUS_BLOCKED] = {"blocked", "what is moved found no room to go on"},
    [STATUS_DIVERGED] = {"diverged", "E ended above where it began"},
    [STATUS_NOT_FINITE] = {"not_finite", "a number became NaN or infinite"},
    [STATUS_INTERRUPTED] = {"interrupted", "interrupted"},
    [STATUS_INVALID_INPUT] = {"invalid_input", "the input is out of range"},
    [STATUS_TOO_LARGE] = {"too_large",
                          "the matrix is too large for 32-bit indices"},
    [STATUS_OUT_OF_MEMORY] = {"out_of_memory", "not enough memory"},
    [STATUS_FILE_FAILED] = {"file_failed", "a file could not be written"},
    [STATUS_SCREEN_FAILED] = {"screen_failed", "drawing failed"},
};

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
