/* check.c - compares the functions of a student's homework.c with those of
 * lecture.c on small cases, and explains each fault.
 *   check NOTE         prints a line for each function
 *   check NOTE NAME    prints CSV: NAME, number of right checks, first fault
 * NOTE is a warning of the compiler, or "".  The output goes to stream 3, since
 * the student's file may print to stdout.  Each function runs in its own
 * process, which may crash, exit or hang.  student.c is compiled with
 * sanitizers, and so that uninitialised variables hold an enormous number. */
#include <SDL.h>
#include <cholmod.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

typedef void TaskFunction(void);
extern TaskFunction *const student[];

/* check.sh defines TASK_FUNCTIONS: F(name) for each function of tasks.txt. */
#define F(name) TASK_##name,
enum { TASK_FUNCTIONS };
#undef F

/* A function of lecture.c with a frequent mistake, a row of mistakes.txt. */
typedef struct Mistake {
    int task_index; /* number of the function */
    TaskFunction *wrong_function;
    const char *sentence; /* sentence for the student; NULL ends the table */
} Mistake;

/* A call of exit in lecture.c becomes a jump to this place.  The headers that
 * declare exit are included above. */
static jmp_buf program_ended;

#define exit(code) longjmp(program_ended, (code) + 1)
#define main       lecture_main
int main(int argc, char **argv);
#include "lecture.c"
#include MISTAKES /* functions with mistakes, and the table mistakes[] */
#undef main
#undef exit

enum {
    MAX_SENTENCE_BYTES = 400, /* size of a sentence, bytes */
    MAX_RESULT_NUMBERS = 400, /* largest count of numbers in a result */
    MAX_NODES = 9,            /* number of nodes of the largest case */
    MAX_UNKNOWNS = 2 * MAX_NODES
};

/* Memory that the process of a check shares with its parent. */
typedef struct SharedMemory {
    char case_name[MAX_SENTENCE_BYTES]; /* for messages, or "" */
    char fault[MAX_SENTENCE_BYTES];     /* description of the fault, or "" */
    bool is_finished;                   /* the check came to its end */
    bool must_fail;                     /* lecture.c calls FAIL in this case */
} SharedMemory;
static SharedMemory *shared;

/* Writes the description of a fault. */
static void set_fault(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(shared->fault, MAX_SENTENCE_BYTES, format, arguments);
    va_end(arguments);
}

/* ---- small cases -------------------------------------------------- */

static unsigned long long random_state;

/* Returns the next random number from -1 to 1. */
static double make_random_number(void)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (double)(random_state >> 33) / (1u << 30) - 1;
}

/* Returns n random points, with coordinates from -size to size. */
static Vec2 *make_random_points(int n, double size)
{
    Vec2 *x = allocate(n, sizeof(Vec2));
    for (int i = 0; i < n; i++)
        x[i] = (Vec2){size * make_random_number(), size * make_random_number()};
    return x;
}

/* Meaning of the numbers of a result. */
typedef enum ResultKind {
    RESULT_NUMBER,
    RESULT_GRADIENT,
    RESULT_MATRIX,
    RESULT_LINE_SEARCH,
    RESULT_STATE
} ResultKind;

typedef struct Task {
    int task_index; /* TASK_name of the function, its index in student[] */
    const char *name;
    TaskFunction *lecture_function; /* function of lecture.c */
    ResultKind result_kind;         /* kind of the result */
    const char *case_names[5]; /* name of each case for messages, then NULL */
    int step_calls;        /* calls of step_forward; the first gets a table */
    unsigned needed_tasks; /* bit i: the task calls the function of task i */
} Task;

/* The arguments of the functions in a case. */
typedef struct TaskCase {
    Solid solid;
    Vec2 *x_tilde, *p;
    Vec2 x[MAX_NODES], x_new[MAX_NODES]; /* x is a copy of solid.x */
    Vec2 *g, g_before[MAX_NODES]; /* gradient before and after the call */
    double block[4][4];           /* argument of make_psd */
    int row[40 * MAX_UNKNOWNS], column[40 * MAX_UNKNOWNS];
    double value[40 * MAX_UNKNOWNS];
    cholmod_triplet H; /* Hessian, in the arrays row, column and value */
    double h, tol;
} TaskCase;

/* Makes a deformed square, in case 1 a single deformed short spring.  Masses
 * and stiffness differ from node to node and from spring to spring. */
static void make_random_solid(int case_number, Solid *solid)
{
    *solid = square(1.2, case_number == 2 ? 1 : 2, 300, 2e3);
    if (case_number == 1) {
        solid->nodes = 2;
        solid->springs = 1;
        solid->e[0] = (Spring){0, 1, 0.7, 1500};
    }
    for (int i = 0; i < solid->nodes; i++) {
        solid->x[i] = add(solid->x[i], mul(0.2, make_random_points(1, 1)[0]));
        solid->v[i] = make_random_points(1, 0.5)[0];
        solid->m[i] *= 1.5 + 0.5 * make_random_number();
    }
    for (int s = 0; s < solid->springs; s++) {
        solid->e[s].k *= 1.5 + 0.5 * make_random_number();
        solid->e[s].l2 *= 1.2 + 0.2 * make_random_number();
    }
}

/* Makes the start of a step: stretched, in case 1 squeezed, where alpha < 1. */
static void make_step_case(int case_number, TaskCase *c)
{
    c->solid = square(1, 2, 1000, 1e5);
    c->h = case_number ? 0.05 : 0.004;
    c->tol = case_number ? 1e-4 : 1e-2;
    for (int i = 0; i < c->solid.nodes; i++) {
        c->solid.x[i].x *= case_number ? 0.4 : 1.4;
        c->solid.x[i].y += case_number ? 0.05 * make_random_number() : 0;
        c->solid.v[i] = make_random_points(1, 1)[0];
    }
}

/* Makes a line search along Newton's direction, along a direction that is far
 * too long, along p = 0, and from E = 0, where every step raises E. */
static void make_line_search_case(int case_number, TaskCase *c)
{
    static const double length[] = {1, 50, 0, 0};
    search_dir(&c->solid, c->solid.x, c->x_tilde, c->h, c->p);
    for (int i = 0; i < c->solid.nodes; i++)
        c->p[i] = mul(length[case_number], c->p[i]);
    if (case_number == 3) { /* node 4 is in the middle, at 0 */
        c->solid = square(1.2, 2, 300, 2e3);
        memcpy(c->x_tilde, c->solid.x, MAX_NODES * sizeof(Vec2));
        c->p[4] = (Vec2){0, 1};
    }
}

static void make_arguments(const Task *task, int case_number, TaskCase *c)
{
    static const double shift[] = {0, -300, 1000, 0}, scale[] = {1, 1e-3, 1, 0};
    bool searches = task->task_index == TASK_line_search;
    for (int r = 0; r < 4 && task->task_index == TASK_make_psd; r++)
        for (int k = 0; k <= r; k++)
            c->block[r][k] = c->block[k][r] =
                scale[case_number] *
                (300 * make_random_number() + (r == k) * shift[case_number]);
    c->h = 0.02;
    if (task->task_index == TASK_step_forward)
        make_step_case(case_number, c);
    else
        make_random_solid(searches ? 0 : case_number, &c->solid);
    c->x_tilde = make_random_points(MAX_NODES, 0.7);
    c->p = make_random_points(MAX_NODES, 1);
    c->p[1] = (Vec2){-1.5, -1.2}; /* longest p, with negative components */
    c->g = make_random_points(MAX_NODES, 900);
    memcpy(c->g_before, c->g, sizeof c->g_before);
    if (searches)
        make_line_search_case(case_number, c);
    memcpy(c->x, c->solid.x, (size_t)c->solid.nodes * sizeof *c->x);
    c->H = (cholmod_triplet){.nrow = 2 * (size_t)c->solid.nodes,
                             .ncol = 2 * (size_t)c->solid.nodes,
                             .nzmax = 40 * MAX_UNKNOWNS,
                             .i = c->row,
                             .j = c->column,
                             .x = c->value,
                             .stype = 1};
}

/* Stores the matrix that a function added to H, in rows of MAX_UNKNOWNS
 * numbers. */
static void store_matrix_entries(const TaskCase *c, double *result)
{
    int n = (int)c->H.nrow;
    for (size_t t = 0; t < c->H.nnz; t++) {
        int row = c->row[t], column = c->column[t];
        if (row < 0 || row > column || column >= n) {
            set_fault(
                "an entry has row %d, column %d, outside the upper triangle "
                "of a matrix with %d rows; add_entry takes care of that",
                row, column, n);
            return;
        }
        result[row * MAX_UNKNOWNS + column] += c->value[t];
        if (row != column)
            result[column * MAX_UNKNOWNS + row] += c->value[t];
    }
}

/* Stores the numbers that a function has changed in its case. */
static void store_result(const Task *task, const TaskCase *c, FILE *table,
                         double *result)
{
    size_t bytes = (size_t)c->solid.nodes * sizeof(Vec2);
    for (int r = 0; r < 4 && task->task_index == TASK_make_psd; r++)
        memcpy(result + r * MAX_UNKNOWNS, c->block[r], sizeof c->block[r]);
    if (task->task_index != TASK_make_psd && task->result_kind == RESULT_MATRIX)
        store_matrix_entries(c, result);
    for (int i = 0;
         i < 2 * c->solid.nodes && task->result_kind == RESULT_GRADIENT; i++)
        result[i] = (&c->g->x)[i] - (&c->g_before->x)[i];
    if (task->result_kind == RESULT_LINE_SEARCH)
        memcpy(result + 1, c->x_new, bytes);
    if (task->result_kind == RESULT_LINE_SEARCH &&
        memcmp(c->x, c->solid.x, bytes) != 0)
        set_fault("the function changes x; write to x_new only");
    if (task->result_kind != RESULT_STATE)
        return;
    memcpy(result, c->solid.x, bytes);
    memcpy(result + MAX_UNKNOWNS, c->solid.v, bytes);
    rewind(table);
    for (double *to = result + 2 * MAX_UNKNOWNS;
         to + 4 <= result + MAX_RESULT_NUMBERS; to += 4)
        if (fscanf(table, "%lf,%lf,%lf,%lf", to, to + 1, to + 2, to + 3) != 4)
            break;
}

/* Calls a function with the arguments of a case.
 *   result  [MAX_RESULT_NUMBERS] in/out, zeros, then the result */
static void call_function(const Task *task, int case_number,
                          TaskFunction *function, double *result)
{
#define AS(name) ((__typeof__(&name))function)
    static TaskCase c;
    FILE *table = tmpfile();
    c = (TaskCase){.h = 0};
    make_arguments(task, case_number, &c);
    strcpy(shared->case_name, task->case_names[case_number]);
    Solid *solid = &c.solid;
    if (task->task_index == TASK_inertia_val)
        *result = AS(inertia_val)(solid, solid->x, c.x_tilde);
    else if (task->task_index == TASK_inertia_grad)
        AS(inertia_grad)(solid, solid->x, c.x_tilde, c.g);
    else if (task->task_index == TASK_inertia_hess)
        AS(inertia_hess)(solid, &c.H);
    else if (task->task_index == TASK_make_psd)
        AS(make_psd)(c.block);
    else if (task->task_index == TASK_spring_val)
        *result = AS(spring_val)(solid, solid->x);
    else if (task->task_index == TASK_spring_grad)
        AS(spring_grad)(solid, solid->x, 0.3, c.g);
    else if (task->task_index == TASK_spring_hess)
        AS(spring_hess)(solid, solid->x, 0.3, &c.H);
    else if (task->task_index == TASK_line_search)
        *result =
            AS(line_search)(solid, solid->x, c.p, c.x_tilde, c.h, c.x_new);
    else if (task->task_index == TASK_residual)
        *result = AS(residual)(solid, c.p, 0.03);
    else if (task->task_index == TASK_explicit_euler)
        AS(explicit_euler)(solid, 0.01, case_number == 1);
    for (int step = 1; step <= task->step_calls; step++) {
        if (step > 1)
            strcpy(shared->case_name, "with table = NULL: ");
        AS(step_forward)(solid, c.h, c.tol, step, step > 1 ? NULL : table);
    }
    strcpy(shared->case_name, task->case_names[case_number]);
    store_result(task, &c, table, result);
    fclose(table);
}

/* ---- the tasks ---------------------------------------------------- */

#define BIT(name)  (1u << TASK_##name)
#define TASK(name) TASK_##name, #name, (TaskFunction *)name

static const Task tasks[] = {
    {TASK(inertia_val), RESULT_NUMBER, {""}},
    {TASK(inertia_grad), RESULT_GRADIENT, {""}},
    {TASK(inertia_hess), RESULT_MATRIX, {""}},
    {TASK(make_psd),
     RESULT_MATRIX,
     {"", "with three small negative eigenvalues: ",
      "a matrix without negative eigenvalues has to stay as it is: ",
      "of zeros: "}},
    {TASK(spring_val), RESULT_NUMBER, {"", "", ""}},
    {TASK(spring_grad), RESULT_GRADIENT, {"", "", ""}},
    {TASK(spring_hess),
     RESULT_MATRIX,
     {"", "", ""},
     .needed_tasks = BIT(make_psd)},
    {TASK(line_search),
     RESULT_LINE_SEARCH,
     {"along Newton's direction: ", "along a direction that is too long: ",
      "along p = 0, where E stays the same: ", "where no step lowers E: "},
     .needed_tasks = BIT(inertia_val) | BIT(spring_val)},
    {TASK(residual), RESULT_NUMBER, {""}},
    {TASK(step_forward), RESULT_STATE, {"", ""}, 2, BIT(step_forward) - 1},
    {TASK(explicit_euler),
     RESULT_STATE,
     {"forward Euler: ", "symplectic Euler: "},
     .needed_tasks = BIT(spring_grad)},
    {TASK_step_forward,
     "twenty steps",
     (TaskFunction *)step_forward,
     RESULT_STATE,
     {""},
     20,
     2 * BIT(step_forward) - 1}};
enum { TASK_COUNT = sizeof tasks / sizeof *tasks };

/* Returns the name of number i of a result, for messages. */
static const char *describe_result_number(ResultKind kind, int i)
{
    static char text[60];
    bool v = kind == RESULT_STATE && i >= MAX_UNKNOWNS;
    if (kind == RESULT_NUMBER)
        return "the result";
    if (kind == RESULT_LINE_SEARCH && i-- == 0)
        return "alpha";
    if (kind == RESULT_MATRIX)
        snprintf(text, sizeof text, "the number in row %d, column %d",
                 i / MAX_UNKNOWNS, i % MAX_UNKNOWNS);
    else if (i >= 2 * MAX_UNKNOWNS)
        snprintf(text, sizeof text, "number %d in line %d of table", i % 4 + 1,
                 (i - 2 * MAX_UNKNOWNS) / 4 + 1);
    else
        snprintf(text, sizeof text, "%s%s of node %d", v ? "v_" : "",
                 i % 2 ? "y" : "x", i % MAX_UNKNOWNS / 2);
    return text;
}

/* Returns the index of the first number that differs by more than rounding;
 * MAX_RESULT_NUMBERS: no number does. */
static int find_first_difference(const double *a, const double *b)
{
    double largest = 0;
    int i = 0;
    for (int k = 0; k < MAX_RESULT_NUMBERS; k++)
        largest = fmax(largest, fabs(b[k]));
    while (i < MAX_RESULT_NUMBERS && fabs(a[i] - b[i]) <= 1e-9 * largest)
        i++;
    return i;
}

/* Runs a function in a case.  Returns false if lecture.c's code calls exit. */
static bool run_function(const Task *task, int case_number,
                         TaskFunction *function, double *result)
{
    random_state = 15362 + (unsigned)case_number;
    memset(result, 0, MAX_RESULT_NUMBERS * sizeof *result);
    if (setjmp(program_ended))
        return false;
    call_function(task, case_number, function, result);
    return true;
}

/* Returns the sentence of the mistake that gives `yours`, or NULL. */
static const char *find_mistake(const Task *task, int case_number,
                                const double *yours)
{
    double other[MAX_RESULT_NUMBERS];
    for (const Mistake *mistake = mistakes; mistake->sentence; mistake++)
        if (mistake->task_index == task->task_index &&
            run_function(task, case_number, mistake->wrong_function, other) &&
            find_first_difference(yours, other) == MAX_RESULT_NUMBERS)
            return mistake->sentence;
    return NULL;
}

/* Returns a sentence if numbers are multiples of the right ones, or NULL. */
static const char *describe_multiple(const double *yours, const double *truth)
{
    static const struct {
        double factor; /* factor on the right result */
        const char *sentence;
    } multiples[] = {
        {0, "all numbers are 0: is it written yet? (In C 1/2 is 0, not 0.5.)"},
        {-1, "the sign is wrong"},
        {2, "the result is twice as large as it should be"},
        {0.5, "the result is half of what it should be"}};
    double other[MAX_RESULT_NUMBERS];
    for (size_t m = 0; m < sizeof multiples / sizeof *multiples; m++) {
        for (int i = 0; i < MAX_RESULT_NUMBERS; i++)
            other[i] = multiples[m].factor * truth[i];
        if (find_first_difference(yours, other) == MAX_RESULT_NUMBERS)
            return multiples[m].sentence;
    }
    return NULL;
}

/* Reports the fault in the student's numbers, if there is one. */
static void explain_difference(const Task *task, int case_number,
                               const double *yours, const double *truth)
{
    int first = find_first_difference(yours, truth);
    for (int i = 0; i < MAX_RESULT_NUMBERS; i++)
        if (!(fabs(yours[i]) < 1e100)) {
            set_fault("%s is %g: is a variable used before it has a value, or "
                      "does something divide by zero?",
                      describe_result_number(task->result_kind, i), yours[i]);
            return;
        }
    if (first == MAX_RESULT_NUMBERS)
        return;
    const char *words = find_mistake(task, case_number, yours);
    words = words ? words : describe_multiple(yours, truth);
    if (words)
        set_fault("%s", words);
    else
        set_fault("%s is %.9g, and should be %.9g",
                  describe_result_number(task->result_kind, first),
                  yours[first], truth[first]);
}

/* Runs the cases of a task up to the first fault.
 *   errors  file descriptor for the standard error of the student's function */
static void check_task(const Task *task, int errors)
{
    double yours[MAX_RESULT_NUMBERS], truth[MAX_RESULT_NUMBERS];
    int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    for (int t = 0; task->case_names[t] && !*shared->fault; t++) {
        dup2(nowhere, STDERR_FILENO);
        shared->must_fail =
            !run_function(task, t, task->lecture_function, truth);
        dup2(errors, STDERR_FILENO);
        run_function(task, t, student[task->task_index], yours);
        if (shared->must_fail)
            set_fault(
                "the search goes on: call FAIL(1, ...) after 64 halvings");
        if (!*shared->fault)
            explain_difference(task, t, yours, truth);
    }
}

/* Reports what the process wrote to its standard error: the first fault of a
 * sanitizer, with the line in the student's file, or the message of FAIL. */
static void report_error_output(FILE *errors)
{
    char line[1000], reason[200] = "", *at;
    int number = 0;
    rewind(errors);
    while (fgets(line, sizeof line, errors)) {
        line[strcspn(line, "\n")] = '\0';
        if (strncmp(line, "lecture: ", 9) == 0 && !*reason)
            snprintf(reason, sizeof reason, "ends the program: %.150s",
                     line + 9);
        if ((at = strstr(line, "runtime error: ")) && !*reason)
            snprintf(reason, sizeof reason, "fails: %.150s", at + 15);
        if ((at = strstr(line, "AddressSanitizer: ")) && !*reason)
            snprintf(reason, sizeof reason,
                     "reads or writes outside of an array (%.*s)",
                     (int)strcspn(at + 18, " "), at + 18);
        if (!number && (at = strstr(line, ".c:")) && !strstr(line, "check.c:"))
            number = atoi(at + 3);
    }
    if (!*reason)
        snprintf(reason, sizeof reason, "ends the program");
    if (number)
        set_fault("%s, line %d", reason, number);
    else
        set_fault("%s", reason);
}

enum {
    MAX_CHECK_SECONDS = 4
}; /* a function that runs longer counts as endless */

/* Runs one check in its own process.  The fault is then in `shared`. */
static void run_check(const Task *task)
{
    FILE *errors = tmpfile();
    int status = 0;
    memset(shared, 0, sizeof *shared);
    pid_t child = errors ? fork() : -1;
    if (child < 0)
        FAIL(1, "cannot run a check: %s\n", strerror(errno));
    if (child == 0) {
        alarm(MAX_CHECK_SECONDS);
        check_task(task, fileno(errors));
        shared->is_finished = true;
        _exit(0);
    }
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
        set_fault("the function does not end");
    else if (shared->must_fail && !*shared->fault && WIFEXITED(status) &&
             WEXITSTATUS(status) == 1)
        shared->is_finished = true;
    else if (status != 0 || !shared->is_finished)
        report_error_output(errors);
    fclose(errors);
}

int main(int argc, char **argv)
{
    unsigned failed = 0;
    int right = 0;
    char first[3 * MAX_SENTENCE_BYTES] = "";
    FILE *out = fdopen(3, "w");
    if (argc < 2 || !out)
        FAIL(2, "check.sh runs this\n");
    shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE,
                  MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED)
        FAIL(1, "not enough memory\n");
    for (int t = 0; t < TASK_COUNT; t++) {
        unsigned missing = tasks[t].needed_tasks & failed;
        if (missing) { /* the lowest bit is the first wrong task */
            shared->case_name[0] = '\0';
            set_fault("not checked: it calls %s, which is not right",
                      tasks[__builtin_ctz(missing)].name);
        } else
            run_check(&tasks[t]);
        bool bad = *shared->fault != '\0';
        failed |= (unsigned)bad << t;
        right += !bad;
        if (bad && !*first)
            snprintf(first, sizeof first, "%s: %s%s", tasks[t].name,
                     shared->case_name, shared->fault);
        if (argc == 2)
            fprintf(out, "%-14s  %s%s\n", tasks[t].name,
                    bad ? shared->case_name : "",
                    bad ? shared->fault : "right");
        fflush(out);
    }
    if (argc == 2)
        fprintf(out, "%d of %d are right\n%s%s", right, TASK_COUNT, argv[1],
                *argv[1] ? "\n" : "");
    else
        fprintf(out, "\"%s\",%d,\"%s\"\n", argv[2], right,
                *first ? first : argv[1]);
    fclose(out);
    return failed != 0 || *argv[1];
}
