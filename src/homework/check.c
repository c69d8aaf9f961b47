/* Holds the functions of a student's homework.c against those of lecture.c, in
 * the order of the slides, on small cases, and says in words what is wrong.
 *   check NOTE [NAME]   NAME: instead one line of CSV, name,right,first
 * sentence NOTE is what the compiler suspects, or "".  What is said goes to
 * stream 3, for the student's file may print.  Each function runs in a process
 * of its own: it may crash, end the program or never end.  student.c is
 * compiled with sanitizers, and so that a variable without a value holds an
 * enormous number.
 */
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#define main lecture_main
int main(int argc, char **argv);
#include "lecture.c"
#undef main

typedef void Function(void);
extern Function *const student[];

enum {
    /* as in student.c */
    TASK_inertia_val,
    TASK_inertia_grad,
    TASK_inertia_hess,
    TASK_make_psd,
    TASK_spring_val,
    TASK_spring_grad,
    TASK_spring_hess,
    TASK_line_search,
    TASK_residual,
    TASK_step_forward,
    TASK_explicit_euler,
    TEXT = 400, /* letters of a sentence */
    MOST = 400, /* numbers of a result */
    SIDE = 18   /* rows of a Hessian: nine nodes */
};
/* The student's function of this name. */
#define YOURS(name) ((__typeof__(&name))student[TASK_##name])

/* What a child finds, which its parent reads. */
typedef struct Shared {
    char doing[TEXT];    /* what it is at, where that is to be said */
    char sentence[TEXT]; /* what is wrong, or "" */
    bool unclear;        /* ... and it is no mistake that others made */
    bool finished;       /* it came to its end */
    bool must_end;       /* the function has to end the program now, by FAIL */
} Shared;
static Shared *shared;

/* Always true: something is wrong, and this is what. */
static bool say(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(shared->sentence, TEXT, format, arguments);
    va_end(arguments);
    return true;
}

/* ---- comparing numbers -------------------------------------------- */

/* Equal but for what another order of the sums changes. */
static bool same(const double *a, const double *b, int n)
{
    double size = 0, off = 0;
    for (int i = 0; i < n; i++) {
        size = fmax(size, fabs(b[i]));
        off = fabs(a[i] - b[i]) <= off ? off : fabs(a[i] - b[i]);
    }
    return off <= 1e-9 * size;
}

/* Where number i of a result stands. */
typedef enum Kind { NUMBER, NODES, MATRIX } Kind;
static const char *place(Kind kind, int i, int n)
{
    static char text[60];
    int side = (int)sqrt(n);
    if (kind == NUMBER)
        return "the result";
    if (kind == NODES)
        snprintf(text, sizeof text, "%s of node %d", i % 2 ? "y" : "x", i / 2);
    else
        snprintf(text, sizeof text, "the number in row %d, column %d", i / side,
                 i % side);
    return text;
}

/* A mistake that others made: the numbers it leads to. */
typedef struct Suspect {
    double value[MOST];
    const char *words;
} Suspect;
static Suspect suspects[12];
static int suspect_count;

/* Room for the numbers of one more mistake. */
static double *suspect(const char *words)
{
    suspects[suspect_count].words = words;
    return memset(suspects[suspect_count++].value, 0, sizeof suspects->value);
}

/* The student's numbers against the true ones; true if it has said why they are
 * wrong.  Forgets the suspects. */
static bool wrong(Kind kind, const double *yours, const double *truth, int n)
{
    static const struct {
        double factor;
        const char *words;
    } multiples[] = {
        {0, "all is zero: is it written yet? (In C 1/2 is 0, and 0.5 is not.)"},
        {-1, "the sign is wrong"},
        {2, "it is twice as large as it should be"},
        {4, "it is four times as large as it should be"},
        {0.5, "it is half of what it should be"},
        {0.25, "it is a quarter of what it should be"}};
    int count = suspect_count, worst = 0;
    suspect_count = 0;
    for (int i = 0; i < n; i++)
        if (!(fabs(yours[i]) < 1e100))
            return say("%s is %g: is a variable used before it has a value, or "
                       "does something divide by zero?",
                       place(kind, i, n), yours[i]);
    if (same(yours, truth, n))
        return false;
    for (int s = 0; s < count; s++)
        if (same(yours, suspects[s].value, n))
            return say("%s", suspects[s].words);
    for (size_t m = 0; m < sizeof multiples / sizeof *multiples; m++) {
        double value[MOST];
        for (int i = 0; i < n; i++)
            value[i] = multiples[m].factor * truth[i];
        if (same(yours, value, n))
            return say("%s", multiples[m].words);
    }
    for (int i = 0; i < n; i++)
        if (fabs(yours[i] - truth[i]) > fabs(yours[worst] - truth[worst]))
            worst = i;
    shared->unclear = true;
    return say("%s is %.9g, and should be %.9g", place(kind, worst, n),
               yours[worst], truth[worst]);
}

/* ---- small cases -------------------------------------------------- */

/* A number from -1 to 1, the next one of always the same row. */
static double draw_number(void)
{
    static unsigned long long state = 15362;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 33) / (1u << 30) - 1;
}

static Vec2 *draw_points(int n, double size)
{
    Vec2 *x = allocate(n, sizeof(Vec2));
    for (int i = 0; i < n; i++)
        x[i] = (Vec2){size * draw_number(), size * draw_number()};
    return x;
}

/* A square with n_seg segments, or for 0 a single short spring, bent out of
 * shape; each node and each spring has numbers of its own. */
static Solid draw_solid(int n_seg)
{
    Solid solid = square(1.2, n_seg ? n_seg : 1, 300, 2e3);
    if (n_seg == 0) {
        solid.nodes = 2;
        solid.springs = 1;
        solid.e[0] = (Spring){0, 1, 0.7, 1500};
    }
    for (int i = 0; i < solid.nodes; i++) {
        solid.x[i] = add(solid.x[i], mul(0.2, draw_points(1, 1)[0]));
        solid.v[i] = draw_points(1, 0.5)[0];
        solid.m[i] *= 1.5 + 0.5 * draw_number();
    }
    for (int s = 0; s < solid.springs; s++) {
        solid.e[s].k *= 1.5 + 0.5 * draw_number();
        solid.e[s].l2 *= 1.2 + 0.2 * draw_number();
    }
    return solid;
}

static void *copy(const void *from, int count, size_t size)
{
    return memcpy(allocate(count, size), from, (size_t)count * size);
}

static Solid copy_solid(const Solid *from)
{
    Solid to = *from;
    to.x = copy(from->x, from->nodes, sizeof(Vec2));
    to.v = copy(from->v, from->nodes, sizeof(Vec2));
    to.m = copy(from->m, from->nodes, sizeof(double));
    return to;
}

/* The same with mass m everywhere. */
static Solid with_mass(const Solid *from, double m)
{
    Solid to = copy_solid(from);
    for (int i = 0; i < to.nodes; i++)
        to.m[i] = m;
    return to;
}

/* A Hessian of n rows without entries. */
static cholmod_triplet new_triplets(int n)
{
    size_t most = 40 * (size_t)n;
    return (cholmod_triplet){.nrow = (size_t)n,
                             .ncol = (size_t)n,
                             .nzmax = most,
                             .i = allocate((int)most, sizeof(int)),
                             .j = allocate((int)most, sizeof(int)),
                             .x = allocate((int)most, sizeof(double)),
                             .stype = 1};
}

/* What a function has added to a Hessian, full [n^2] out; true: it has said
 * that an entry lies outside, or in the lower triangle. */
static bool outside(const cholmod_triplet *H, double *full)
{
    int n = (int)H->nrow;
    memset(full, 0, (size_t)(n * n) * sizeof *full);
    for (size_t t = 0; t < H->nnz; t++) {
        int row = ((int *)H->i)[t], column = ((int *)H->j)[t];
        if (row < 0 || row > column || column >= n)
            return say("an entry stands in row %d, column %d of a matrix with "
                       "%d rows, upper triangle; add_entry looks at that",
                       row, column, n);
        full[row * n + column] += ((double *)H->x)[t];
        if (row != column)
            full[column * n + row] += ((double *)H->x)[t];
    }
    return false;
}

/* ---- inertia ------------------------------------------------------ */
static bool check_inertia_val(void)
{
    Solid solid = draw_solid(2), light = with_mass(&solid, 1);
    Solid equal = with_mass(&solid, solid.m[0]);
    Vec2 *x_tilde = draw_points(solid.nodes, 0.7);
    *suspect("the masses are left out") = inertia_val(&light, solid.x, x_tilde);
    *suspect("all nodes get the mass of the first: it is solid->m[i]") =
        inertia_val(&equal, solid.x, x_tilde);
    *suspect("the masses and the factor 1/2 are left out") =
        2 * inertia_val(&light, solid.x, x_tilde);
    double truth = inertia_val(&solid, solid.x, x_tilde);
    double yours = YOURS(inertia_val)(&solid, solid.x, x_tilde);
    if (same(&yours, &(double){2 * truth}, 1))
        return say("the factor 1/2 is left out");
    return wrong(NUMBER, &yours, &truth, 1);
}

/* What was added to g, which held `before`; suspects are sums. */
static bool wrong_sum(const Vec2 *g, const Vec2 *truth, const Vec2 *before,
                      int nodes)
{
    double added[MOST], right[MOST];
    for (int i = 0; i < 2 * nodes; i++) {
        double held = (&before->x)[i];
        added[i] = (&g->x)[i] - held;
        right[i] = (&truth->x)[i] - held;
        for (int s = 0; s < suspect_count; s++)
            suspects[s].value[i] -= held;
    }
    double *set = suspect("it sets g: it has to add to what g holds");
    for (int i = 0; i < 2 * nodes; i++)
        set[i] = right[i] - (&before->x)[i];
    return wrong(NODES, added, right, 2 * nodes);
}

static Vec2 *as_points(double *numbers, const Vec2 *from, int nodes)
{
    return memcpy(numbers, from, (size_t)nodes * sizeof(Vec2));
}

static bool check_inertia_grad(void)
{
    Solid solid = draw_solid(2), light = with_mass(&solid, 1);
    int n = solid.nodes;
    Vec2 *x_tilde = draw_points(n, 0.7), *before = draw_points(n, 900);
    Vec2 *g = copy(before, n, sizeof(Vec2)), *truth = copy(g, n, sizeof(Vec2));
    Vec2 *x = copy(solid.x, n, sizeof(Vec2));
    inertia_grad(&solid, x, x_tilde, truth);
    inertia_grad(&light, x, x_tilde,
                 as_points(suspect("the masses are left out"), before, n));
    YOURS(inertia_grad)(&solid, solid.x, x_tilde, g);
    if (memcmp(x, solid.x, (size_t)n * sizeof *x) != 0)
        return say("it moves the nodes: x is to be read only");
    return wrong_sum(g, truth, before, n);
}

static bool check_inertia_hess(void)
{
    Solid solid = draw_solid(2), light = with_mass(&solid, 1);
    int n = 2 * solid.nodes;
    static double full[SIDE * SIDE], truth[SIDE * SIDE];
    cholmod_triplet H = new_triplets(n), right = new_triplets(n);
    cholmod_triplet out = new_triplets(n);
    inertia_hess(&solid, &right);
    inertia_hess(&light, &out);
    outside(&right, truth);
    outside(&out, suspect("the masses are left out"));
    double *half = suspect("only half of the rows have their mass: node i has "
                           "row 2i for x and row 2i + 1 for y");
    double *first = suspect("only the rows 2i have their mass: node i has row "
                            "2i for x and row 2i + 1 for y");
    double *mixed = suspect("rows get the masses of other nodes: row r belongs "
                            "to node r / 2");
    for (int r = 0; r < n; r++) {
        half[r * n + r] = r < n / 2 ? solid.m[r / 2] : 0;
        first[r * n + r] = r % 2 == 0 ? solid.m[r / 2] : 0;
        mixed[r * n + r] = solid.m[r % (n / 2)];
    }
    YOURS(inertia_hess)(&solid, &H);
    return outside(&H, full) || wrong(MATRIX, full, truth, n * n);
}

/* ---- projection -------------------------------------------------------- */

static double eigenvalues(double a[4][4], double q[4][4], double *l)
{
    double work[64];
    memcpy(q, a, 16 * sizeof(double));
    dsyev_("V", "U", &(int){4}, q[0], &(int){4}, l, work, &(int){64},
           &(int){0});
    return l[0];
}

/* Indefinite; small, with three eigenvalues below 0; positive definite; zero.
 */
static bool check_make_psd(void)
{
    static const double shift[] = {0, -300, 1000}, scale[] = {1, 1e-3, 1};
    for (int trial = 0; trial < 4; trial++) {
        double a[4][4] = {{0}}, yours[4][4], truth[4][4], q[4][4], l[4];
        for (int r = 0; r < 4 && trial < 3; r++)
            for (int c = 0; c <= r; c++)
                a[r][c] = a[c][r] = scale[trial] * (300 * draw_number() +
                                                    (r == c) * shift[trial]);
        memcpy(yours, a, sizeof a);
        memcpy(truth, a, sizeof a);
        make_psd(truth);
        YOURS(make_psd)(yours);
        eigenvalues(a, q, l);
        double *positive = suspect("negative eigenvalues became positive, |l|: "
                                   "they have to become 0");
        double *turned = suspect("Q and its transpose are exchanged: dsyev_ "
                                 "leaves the eigenvectors in the rows of q");
        double *other = suspect("the positive eigenvalues became 0: the "
                                "negative ones have to");
        double *plain =
            suspect("the eigenvalues stand on the diagonal, without "
                    "their eigenvectors: it is Q max(L, 0) Q^T");
        for (int k = 0; k < 16; k++) {
            int r = k / 4, c = k % 4;
            plain[k] = r == c ? fmax(l[r], 0) : 0;
            for (int i = 0; i < 4; i++) {
                positive[k] += q[i][r] * fabs(l[i]) * q[i][c];
                turned[k] += q[r][i] * fmax(l[i], 0) * q[c][i];
                other[k] += q[i][r] * fmin(l[i], 0) * q[i][c];
            }
        }
        if (wrong(MATRIX, yours[0], truth[0], 16)) {
            if (shared->unclear && trial == 2)
                say("a matrix without negative eigenvalues has to stay as it "
                    "is");
            else if (shared->unclear && eigenvalues(yours, q, l) < -1e-9)
                say("eigenvalue %.6g is still there", l[0]);
            return true;
        }
    }
    return false;
}

/* ---- springs ----------------------------------------------------------- */
static bool check_spring_val(void)
{
    for (int n_seg = 0; n_seg < 3; n_seg++) {
        Solid solid = draw_solid(n_seg);
        double *school = suspect("that is k/2 (|d| - l)^2, as at school: the "
                                 "slides' energy has squares in the bracket");
        double *no_l2 = suspect("the factor l^2 is left out");
        double *no_k = suspect("the stiffness e->k is left out");
        double *no_one = suspect("the strain is |d|^2/l^2 - 1: the - 1 is "
                                 "left out");
        double *no_square = suspect("the strain is not squared");
        double *no_division = suspect("the strain is |d|^2/l^2 - 1: the "
                                      "division by l^2 is left out");
        for (const Spring *e = solid.e; e < solid.e + solid.springs; e++) {
            Vec2 d = sub(solid.x[e->i], solid.x[e->j]);
            double d2 = dot(d, d), strain = d2 / e->l2 - 1;
            double excess = sqrt(d2) - sqrt(e->l2);
            *school += e->k / 2 * excess * excess;
            *no_l2 += e->k / 2 * strain * strain;
            *no_k += e->l2 / 2 * strain * strain;
            *no_one += e->l2 * e->k / 2 * d2 / e->l2 * d2 / e->l2;
            *no_square += e->l2 * e->k / 2 * strain;
            *no_division += e->l2 * e->k / 2 * (d2 - 1) * (d2 - 1);
        }
        double truth = spring_val(&solid, solid.x);
        double yours = YOURS(spring_val)(&solid, solid.x);
        if (same(&yours, &(double){2 * truth}, 1))
            return say("the factor 1/2 is left out");
        if (wrong(NUMBER, &yours, &truth, 1))
            return true;
    }
    return false;
}

/* The forces with a mistake: those on i and on j times a and b, and this power
 * of l2 besides. */
static void add_forces(const Solid *solid, double scale, double a, double b,
                       double power, Vec2 *g)
{
    for (const Spring *e = solid->e; e < solid->e + solid->springs; e++) {
        Vec2 d = sub(solid->x[e->i], solid->x[e->j]);
        Vec2 force = mul(
            scale * pow(e->l2, power) * 2 * e->k * (dot(d, d) / e->l2 - 1), d);
        g[e->i] = add(g[e->i], mul(a, force));
        g[e->j] = sub(g[e->j], mul(b, force));
    }
}

static bool check_spring_grad(void)
{
    static const struct {
        double scale, a, b, power;
        const char *words;
    } mistakes[] = {
        {0.3, 1, -1, 0, "node j's force has the wrong sign"},
        {0.3, -1, 1, 0, "node i's force has the wrong sign"},
        {0.3, 1, 0, 0, "node j gets no force: a spring pulls at both"},
        {0.3, 0, 1, 0, "node i gets no force: a spring pulls at both"},
        {1, 1, 1, 0, "scale is left out"},
        {0.3, 1, 1, 1,
         "a factor l^2 is too much: it goes away with the "
         "derivative of |d|^2/l^2"},
        {0.3, 1, 1, -1,
         "a division by l^2 is too much: the l^2 in front takes "
         "it away"}};
    for (int n_seg = 0; n_seg < 3; n_seg++) {
        Solid solid = draw_solid(n_seg);
        int n = solid.nodes;
        Vec2 *before = draw_points(n, 900), *g = copy(before, n, sizeof *g);
        Vec2 *truth = copy(before, n, sizeof *truth);
        spring_grad(&solid, solid.x, 0.3, truth);
        for (size_t m = 0; m < sizeof mistakes / sizeof *mistakes; m++)
            add_forces(&solid, mistakes[m].scale, mistakes[m].a, mistakes[m].b,
                       mistakes[m].power,
                       as_points(suspect(mistakes[m].words), before, n));
        YOURS(spring_grad)(&solid, solid.x, 0.3, g);
        if (wrong_sum(g, truth, before, n))
            return true;
    }
    return false;
}

enum Block { UNPROJECTED, NO_SCALE, SAME_SIGNS, NO_TWO, NO_L2 };

/* The Hessian with a mistake, in full. */
static void add_blocks(const Solid *solid, double scale, enum Block mistake,
                       double *full)
{
    cholmod_triplet H = new_triplets(2 * solid->nodes);
    for (const Spring *e = solid->e; e < solid->e + solid->springs; e++) {
        Vec2 d = sub(solid->x[e->i], solid->x[e->j]);
        double excess = dot(d, d) - e->l2, two = mistake == NO_TWO ? 1 : 2;
        double factor = 2 * e->k / (mistake == NO_L2 ? 1 : e->l2);
        double D[2][2] = {{two * d.x * d.x + excess, two * d.x * d.y},
                          {two * d.x * d.y, two * d.y * d.y + excess}};
        double block[4][4];
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++)
                block[r][c] =
                    (r / 2 == c / 2 || mistake == SAME_SIGNS ? 1 : -1) *
                    factor * D[r % 2][c % 2];
        if (mistake != UNPROJECTED)
            make_psd(block);
        int rows[4] = {2 * e->i, 2 * e->i + 1, 2 * e->j, 2 * e->j + 1};
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++)
                add_entry(&H, rows[r], rows[c],
                          (mistake == NO_SCALE ? 1 : scale) * block[r][c]);
    }
    outside(&H, full);
}

static bool check_spring_hess(void)
{
    for (int n_seg = 0; n_seg < 3; n_seg++) {
        Solid solid = draw_solid(n_seg);
        int n = 2 * solid.nodes;
        static double full[SIDE * SIDE], truth[SIDE * SIDE];
        cholmod_triplet H = new_triplets(n), right = new_triplets(n);
        spring_hess(&solid, solid.x, 0.3, &right);
        outside(&right, truth);
        add_blocks(&solid, 0.3, UNPROJECTED,
                   suspect("the blocks are not projected: call make_psd before "
                           "add_entry"));
        add_blocks(&solid, 0.3, NO_SCALE, suspect("scale is left out"));
        add_blocks(&solid, 0.3, SAME_SIGNS,
                   suspect("the blocks between i and j have the wrong sign: "
                           "the block is [D -D; -D D]"));
        add_blocks(&solid, 0.3, NO_TWO,
                   suspect("D has 2 d d^T in it: the 2 is left out"));
        add_blocks(&solid, 0.3, NO_L2,
                   suspect("the division by l^2 is left out"));
        double *diagonal = suspect("only the blocks of node i and of node j "
                                   "are there, not those between them");
        for (int i = 0; n_seg == 0 && i < n * n; i++)
            diagonal[i] = i / n / 2 == i % n / 2 ? truth[i] : 0;
        YOURS(spring_hess)(&solid, solid.x, 0.3, &H);
        if (outside(&H, full) || wrong(MATRIX, full, truth, n * n))
            return true;
    }
    return false;
}

/* ---- steps ------------------------------------------------------------- */

/* Along three directions: Newton's, one far too long, and none. */
static bool check_line_search(void)
{
    static const char *const along[] = {
        "along Newton's direction: ", "along a direction that is too long: ",
        "along p = 0, where E stays the same: "};
    for (int trial = 0; trial < 3; trial++) {
        Solid solid = draw_solid(2);
        int n = solid.nodes;
        double h = 0.02, most[] = {1, 50, 0};
        Vec2 *x_tilde = draw_points(n, 0.7), *p = draw_points(n, 1);
        Vec2 *x = copy(solid.x, n, sizeof *x), *x_new = draw_points(n, 1);
        Vec2 *untouched = copy(x_new, n, sizeof *x),
             *true_new = draw_points(n, 1);
        search_dir(&solid, x, x_tilde, h, p);
        for (int i = 0; i < n; i++)
            p[i] = mul(most[trial], p[i]);
        strcpy(shared->doing, along[trial]);
        double truth = line_search(&solid, x, p, x_tilde, h, true_new);
        double alpha =
            YOURS(line_search)(&solid, solid.x, p, x_tilde, h, x_new);
        double from = ip_val(&solid, x, x_tilde, h);
        double to = ip_val(&solid, x_new, x_tilde, h);
        int power;
        if (memcmp(x, solid.x, (size_t)n * sizeof *x) != 0)
            return say("it changes x: only x_new is to be written");
        if (memcmp(untouched, x_new, (size_t)n * sizeof *x) == 0)
            return say("x_new is not written");
        if (!(alpha > 0) || frexp(alpha, &power) != 0.5)
            return say("it returns %g: alpha is 1, 1/2, 1/4, ...", alpha);
        for (int i = 0; i < n; i++)
            true_new[i] = add(x[i], mul(alpha, p[i]));
        if (wrong(NODES, &x_new->x, &true_new->x, 2 * n))
            return say("x_new is not x + alpha p, with the alpha %g that it "
                       "returns",
                       alpha);
        if (!(to <= from))
            return say("E rose from %.4g to %.4g and alpha %g was taken", from,
                       to, alpha);
        if (alpha != truth)
            return say("alpha %g is taken, and %g is the first that does not "
                       "raise E",
                       alpha, truth);
    }
    /* E is 0, and every step raises it. */
    Solid solid = draw_solid(0);
    Vec2 x[] = {{0, 0}, {1, 0}}, p[] = {{0, 1}, {0, 0}}, x_new[2];
    solid.e[0].l2 = 1;
    strcpy(shared->doing, "where no step lowers E: ");
    shared->must_end = true;
    double alpha = YOURS(line_search)(&solid, x, p, x, 0.02, x_new);
    return say("it returns %g: after 64 halvings FAIL(1, ...)", alpha);
}

static bool check_residual(void)
{
    int n = 9;
    Solid solid = draw_solid(2);
    Vec2 *p = draw_points(n, 1);
    double h = 0.03, largest = 0, sum = 0, squares = 0, signs = 0;
    p[4] = (Vec2){-1.5, -1.2}; /* the largest sum has negative numbers */
    for (int i = 0; i < n; i++) {
        largest = fmax(largest, fmax(fabs(p[i].x), fabs(p[i].y)));
        sum += fabs(p[i].x) + fabs(p[i].y);
        squares = fmax(squares, sqrt(dot(p[i], p[i])));
        signs = fmax(signs, p[i].x + p[i].y);
    }
    double truth = residual(&solid, p, h);
    *suspect("the division by h is left out") = truth * h;
    *suspect("it is multiplied by h: divide") = truth * h * h;
    *suspect("that is the largest coordinate: it is |p_x| + |p_y|") =
        largest / h;
    *suspect("that is the sum over all nodes: it is the largest") = sum / h;
    *suspect("that is the largest length: it is |p_x| + |p_y|") = squares / h;
    *suspect("the signs of p are kept: it is |p_x| + |p_y|") = signs / h;
    double yours = YOURS(residual)(&solid, p, h);
    return wrong(NUMBER, &yours, &truth, 1);
}

enum Step { NO_LOOP, NO_TILDE, NO_SEARCH, OLD_P };

/* step_forward with a mistake. */
static void make_step(Solid *solid, double h, double tol, enum Step mistake)
{
    int n = solid->nodes, updates = 0;
    Vec2 *x = solid->x, *x_n = copy(x, n, sizeof *x);
    Vec2 *x_tilde = copy(x, n, sizeof *x);
    Vec2 *p = draw_points(n, 1), *x_new = draw_points(n, 1);
    for (int i = 0; i < n && mistake != NO_TILDE; i++)
        x_tilde[i] = add(x[i], mul(h, solid->v[i]));
    search_dir(solid, x, x_tilde, h, p);
    while (residual(solid, p, h) > tol && updates < 50) {
        double alpha = line_search(solid, x, p, x_tilde, h, x_new);
        for (int i = 0; i < n; i++)
            x[i] = add(x[i], mul(mistake == NO_SEARCH ? 1 : alpha, p[i]));
        updates++;
        if (mistake == NO_LOOP)
            break;
        if (mistake != OLD_P)
            search_dir(solid, x, x_tilde, h, p);
    }
    for (int i = 0; i < n; i++)
        solid->v[i] = mul(1 / h, sub(x[i], x_n[i]));
}

/* Whether two tables have other numbers; lines out, before they do. */
static bool tables_differ(FILE *yours, FILE *truth, int *lines)
{
    double a[4], b[4];
    int read, expected;
    bool differ = false;
    *lines = 0;
    rewind(yours);
    rewind(truth);
    do {
        expected = fscanf(truth, "%lf,%lf,%lf,%lf", b, b + 1, b + 2, b + 3);
        read = fscanf(yours, "%lf,%lf,%lf,%lf", a, a + 1, a + 2, a + 3);
        for (int i = 0; i < 4; i++)
            differ = differ || read != expected ||
                     (read == 4 && !(fabs(a[i] - b[i]) <= 1e-5 * fabs(b[i])));
        *lines += read == 4 && !differ;
    } while (read == 4 && expected == 4);
    return differ;
}

/* One of the lecture's first steps, and one that needs alpha < 1. */
static bool check_step_forward(void)
{
    static const char *const mistakes[] = {
        "only one update is made: go on until the residual is at most tol",
        "x_tilde is x_n + h v: h v is left out",
        "the updates are x + p: take what the line search found",
        "p stays the first one: a new x needs a new search_dir"};
    for (int trial = 0; trial < 2; trial++) {
        Solid from = square(1, 2, 1000, 1e5);
        double h = trial ? 0.05 : 0.004, tol = trial ? 1e-4 : 1e-2;
        shared->doing[0] = '\0';
        int n = from.nodes;
        for (int i = 0; i < n; i++) {
            from.x[i].x *= trial ? 0.4 : 1.4;
            from.x[i].y += trial ? 0.05 * draw_number() : 0;
            from.v[i] = draw_points(1, 1)[0];
        }
        Solid truth = copy_solid(&from), solid = copy_solid(&from);
        FILE *table = tmpfile(), *right = tmpfile();
        step_forward(&truth, h, tol, 1, right);
        for (enum Step s = NO_LOOP; s <= OLD_P; s++) {
            Solid other = copy_solid(&from);
            make_step(&other, h, tol, s);
            as_points(suspect(mistakes[s]), other.x, n);
        }
        as_points(suspect("x stays as it was"), from.x, n);
        YOURS(step_forward)(&solid, h, tol, 1, table);
        if (wrong(NODES, &solid.x->x, &truth.x->x, 2 * n))
            return true;
        as_points(suspect("v stays as it was: it is (x - x_n) / h"), from.v, n);
        suspect(
            "v is 0: x_n has to be a copy of the old x, and a pointer to it "
            "is none");
        double *way = suspect("v is x - x_n: the division by h is left out");
        for (int i = 0; i < 2 * n; i++)
            way[i] = h * (&truth.v->x)[i];
        strcpy(shared->doing, "x is right; v: ");
        if (wrong(NODES, &solid.v->x, &truth.v->x, 2 * n))
            return true;
        shared->doing[0] = '\0';
        int lines;
        if (tables_differ(table, right, &lines))
            return say("table gets %d good lines, then one with another step, "
                       "update, residual or alpha, or too few",
                       lines);
        strcpy(shared->doing, "with table = NULL: ");
        YOURS(step_forward)(&solid, h, tol, 2, NULL);
    }
    return false;
}

static bool check_explicit_euler(void)
{
    static const char *const words[] = {"forward Euler: ",
                                        "symplectic Euler: "};
    for (int symplectic = 0; symplectic < 2; symplectic++) {
        Solid from = draw_solid(2), truth = copy_solid(&from);
        Solid solid = copy_solid(&from), other = copy_solid(&from);
        Solid light = with_mass(&from, 1);
        int n = from.nodes;
        double h = 0.01, yours[MOST], right[MOST], *back;
        explicit_euler(&truth, h, symplectic);
        explicit_euler(&other, h, !symplectic);
        explicit_euler(&light, h, symplectic);
        as_points(yours, solid.x, n);
        strcpy(shared->doing, words[symplectic]);
        YOURS(explicit_euler)(&solid, h, symplectic);
        Solid *all[] = {&solid, &truth, &other, &light};
        double *into[] = {yours, right,
                          suspect("that is the other method: forward Euler "
                                  "moves x with the old v, symplectic Euler "
                                  "with the new one"),
                          suspect("the masses are left out")};
        for (int s = 0; s < 4; s++) {
            as_points(into[s], all[s]->x, n);
            as_points(into[s] + 2 * n, all[s]->v, n);
        }
        back = suspect("the force has the wrong sign: it is -g[i]");
        as_points(back, from.x, n);
        for (int i = 0; i < 2 * n; i++) {
            double v = (&from.v->x)[i];
            back[2 * n + i] = 2 * v - (&truth.v->x)[i];
            back[i] += h * (symplectic ? back[2 * n + i] : v);
        }
        as_points(suspect("neither x nor v has changed"), from.x, n);
        as_points(suspects[suspect_count - 1].value + 2 * n, from.v, n);
        if (wrong(NODES, yours, right, 4 * n))
            return true;
    }
    return false;
}

/* Twenty steps of the stretched square with all of the student's functions. */
static bool check_run(void)
{
    Solid truth = square(1, 3, 1000, 1e5), solid = square(1, 3, 1000, 1e5);
    for (int i = 0; i < solid.nodes; i++)
        truth.x[i].x = solid.x[i].x *= 1.4;
    for (int step = 1; step <= 20; step++) {
        step_forward(&truth, 0.004, 1e-6, step, NULL);
        YOURS(step_forward)(&solid, 0.004, 1e-6, step, NULL);
        for (int i = 0; i < solid.nodes; i++) {
            Vec2 off = sub(solid.x[i], truth.x[i]);
            if (!(dot(off, off) < 1e-16))
                return say("in step %d node %d is %.2g m from where it should "
                           "be",
                           step, i, sqrt(dot(off, off)));
        }
    }
    return false;
}

/* ---- one after the other ----------------------------------------------- */
#define BIT(name) (1u << TASK_##name)
static const struct Task {
    const char *name;
    bool (*check)(void);
    unsigned needs; /* those that it calls; BIT - 1: all before it */
} tasks[] = {
    {"inertia_val", check_inertia_val, 0},
    {"inertia_grad", check_inertia_grad, 0},
    {"inertia_hess", check_inertia_hess, 0},
    {"make_psd", check_make_psd, 0},
    {"spring_val", check_spring_val, 0},
    {"spring_grad", check_spring_grad, 0},
    {"spring_hess", check_spring_hess, BIT(make_psd)},
    {"line_search", check_line_search, BIT(inertia_val) | BIT(spring_val)},
    {"residual", check_residual, 0},
    {"step_forward", check_step_forward, BIT(step_forward) - 1},
    {"explicit_euler", check_explicit_euler, BIT(spring_grad)},
    {"twenty steps", check_run, BIT(step_forward) | (BIT(step_forward) - 1)}};
enum { CHECKS = sizeof tasks / sizeof *tasks };

/* What the child said on its standard error: the sanitizers' first reason, with
 * the line in the student's file, or the program's own last words. */
static void read_reason(FILE *errors)
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
                     "reads or writes where it must not (%.*s)",
                     (int)strcspn(at + 18, " "), at + 18);
        if (!number && (at = strstr(line, ".c:")) && !strstr(line, "check.c:"))
            number = atoi(at + 3);
    }
    if (!*reason)
        snprintf(reason, sizeof reason, "ends the program");
    if (number)
        say("%s, line %d", reason, number);
    else
        say("%s", reason);
}

/* Runs one check in a process of its own; what is wrong is then shared. */
static void run(const struct Task *task)
{
    FILE *errors = tmpfile();
    int status = 0;
    memset(shared, 0, sizeof *shared);
    pid_t child = errors ? fork() : -1;
    if (child < 0)
        FAIL(1, "cannot run a check: %s\n", strerror(errno));
    if (child == 0) {
        setrlimit(RLIMIT_CPU, &(struct rlimit){3, 3});
        dup2(fileno(errors), STDERR_FILENO);
        dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
        task->check();
        shared->finished = true;
        _exit(0);
    }
    int waited = 0; /* ms; some wait for ever without work */
    while (waitpid(child, &status, WNOHANG) == 0 && waited++ < 10000)
        usleep(1000);
    if (waited > 10000 && kill(child, SIGKILL) == 0)
        waitpid(child, &status, 0);
    if (WIFSIGNALED(status) &&
        (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
        say("it does not end");
    else if (shared->must_end && !*shared->sentence && WIFEXITED(status) &&
             WEXITSTATUS(status) == 1)
        shared->finished = true;
    else if (status != 0 || !shared->finished)
        read_reason(errors);
    fclose(errors);
}

int main(int argc, char **argv)
{
    unsigned failed = 0;
    int right = 0;
    char first[3 * TEXT] = "";
    FILE *out = fdopen(3, "w");
    if (argc < 2 || !out)
        FAIL(2, "check.sh runs this\n");
    shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE,
                  MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED)
        FAIL(1, "not enough memory\n");
    for (int t = 0; t < CHECKS; t++) {
        unsigned missing = tasks[t].needs & failed;
        if (missing) {
            int first_missing = 0;
            while (!(missing >> first_missing & 1))
                first_missing++;
            shared->doing[0] = '\0';
            say("waits for %s", tasks[first_missing].name);
        } else
            run(&tasks[t]);
        bool bad = *shared->sentence != '\0';
        failed |= (unsigned)bad << t;
        right += !bad;
        if (bad && !*first)
            snprintf(first, sizeof first, "%s: %s%s", tasks[t].name,
                     shared->doing, shared->sentence);
        if (argc == 2)
            fprintf(out, "%-14s  %s%s\n", tasks[t].name,
                    bad ? shared->doing : "", bad ? shared->sentence : "right");
        fflush(out);
    }
    if (argc == 2)
        fprintf(out, "%d of %d are right\n%s%s", right, CHECKS, argv[1],
                *argv[1] ? "\n" : "");
    else
        fprintf(out, "\"%s\",%d,\"%s\"\n", argv[2], right,
                *first ? first : argv[1]);
    fclose(out);
    return failed != 0 || *argv[1];
}
