/* lecture.c - the lecture "Reliable Simulation of Elastodynamics" (Minchen Li,
 * CMU 15-362/662) as one program, in the order of the slides:
 *   square_mesh.py       square
 *   InertiaEnergy.py     inertia_val, inertia_grad, inertia_hess
 *   utils.py             make_psd
 *   MassSpringEnergy.py  spring_val, spring_grad, spring_hess
 *   time_integrator.py   ip_val, ip_grad, ip_hess, search_dir,
 *                        line_search: Algorithm 2, step_forward: Algorithm 3
 *   explicit steps       explicit_euler: forward or symplectic Euler
 *   simulator.py         draw, main
 * Each Newton iteration allocates, builds and factors the Hessian anew.
 *   cc -O2 lecture.c -o lecture $(sdl2-config --cflags --libs) \
 *      -I/usr/include/suitesparse -lcholmod -llapack -lm
 *   ./lecture                         a window: pull at a node; Esc closes it
 *   ./lecture k=1e6 n_seg=8           other parameters: see main
 *   ./lecture steps=50 states=FILE    no window: Newton's updates, x and v */
#include <SDL.h>
#include <cholmod.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
_Static_assert(!__FINITE_MATH_ONLY__, "no -ffast-math: NaN must be seen");

/* An array of n Vec2 is one vector of 2n numbers in memory: x, y, x, y, ... */
/* clang-format off */
typedef struct Vec2 { double x, y; } Vec2;
static Vec2 add(Vec2 a, Vec2 b) { return (Vec2){a.x + b.x, a.y + b.y}; }
static Vec2 sub(Vec2 a, Vec2 b) { return (Vec2){a.x - b.x, a.y - b.y}; }
static Vec2 mul(double s, Vec2 a) { return (Vec2){s * a.x, s * a.y}; }
static double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
static double distance(Vec2 a, Vec2 b) { return hypot(a.x - b.x, a.y - b.y); }
/* clang-format on */

/* Prints a line and ends.  code 2: an argument is wrong; 1: another failure. */
#define FAIL(code, ...) exit((fprintf(stderr, "lecture: " __VA_ARGS__), (code)))

/* Returns memory for count elements, all zero. */
static void *allocate(int count, size_t size)
{
    void *memory = calloc((size_t)count, size);
    if (!memory)
        FAIL(1, "not enough memory\n");
    return memory;
}

/* ==== Mass-spring representation of solids (square_mesh.py) =============== */
typedef struct Spring {
    int i, j;     /* nodes at the spring's ends */
    double l2, k; /* squared rest length (m^2), stiffness (J/m^2) */
} Spring;

typedef struct Solid {
    int nodes, springs;
    Vec2 *x, *v; /* [nodes] positions (m), velocities (m/s) */
    double *m;   /* [nodes] masses (kg) */
    Spring *e;   /* [springs] named e as on the slides */
} Solid;

/* Adds a spring that is at rest at the present positions of its nodes. */
static void add_spring(Solid *solid, int i, int j, double k)
{
    Vec2 d = sub(solid->x[i], solid->x[j]);
    solid->e[solid->springs++] = (Spring){i, j, dot(d, d), k};
}

/* The square in its rest shape, around the origin; n_seg segments on a side.
 *   2-----5-----8    n_seg = 2.  Nodes are numbered upwards, column by column:
 *   | \ / | \ / |    node (i, j) has the number i (n_seg + 1) + j.
 *   | / \ | / \ |
 *   1-----4-----7    Every cell has two crossing diagonals.  Without them it
 *   | \ / | \ / |    could shear into a rhombus and no spring would notice.
 *   | / \ | / \ |    There is no node at their crossing.
 *   0-----3-----6
 *   side_len m; rho kg/m^2, density: all nodes get the same mass; k J/m^2 */
static Solid square(double side_len, int n_seg, double rho, double k)
{
    int row = n_seg + 1, nodes = row * row;
    double step = side_len / n_seg;
    Solid solid = {.nodes = nodes,
                   .x = allocate(nodes, sizeof(Vec2)),
                   .v = allocate(nodes, sizeof(Vec2)),
                   .m = allocate(nodes, sizeof(double)),
                   .e = allocate(4 * nodes, sizeof(Spring))};
    for (int i = 0; i < row; i++)
        for (int j = 0; j < row; j++) {
            solid.x[i * row + j].x = -side_len / 2 + i * step;
            solid.x[i * row + j].y = -side_len / 2 + j * step;
            solid.m[i * row + j] = rho * side_len * side_len / nodes;
        }
    for (int i = 0; i < n_seg; i++) /* horizontal springs */
        for (int j = 0; j < row; j++)
            add_spring(&solid, i * row + j, (i + 1) * row + j, k);
    for (int i = 0; i < row; i++) /* vertical springs */
        for (int j = 0; j < n_seg; j++)
            add_spring(&solid, i * row + j, i * row + j + 1, k);
    for (int i = 0; i < n_seg; i++) /* the diagonals of each cell */
        for (int j = 0; j < n_seg; j++) {
            add_spring(&solid, i * row + j, (i + 1) * row + j + 1, k);
            add_spring(&solid, (i + 1) * row + j, i * row + j + 1, k);
        }
    return solid;
}

/* ==== Inertia energy (InertiaEnergy.py) =================================== */
/* sum of m |x - x_tilde|^2 / 2: smallest at x_tilde = x_n + h v_n, where the
 * nodes would be if no spring pulled at them. */
static double inertia_val(const Solid *solid, const Vec2 *x,
                          const Vec2 *x_tilde)
{
    double sum = 0;
    for (int i = 0; i < solid->nodes; i++) {
        Vec2 diff = sub(x[i], x_tilde[i]);
        sum += 0.5 * solid->m[i] * dot(diff, diff);
    }
    return sum;
}

/* g += M (x - x_tilde) */
static void inertia_grad(const Solid *solid, const Vec2 *x, const Vec2 *x_tilde,
                         Vec2 *g)
{
    for (int i = 0; i < solid->nodes; i++)
        g[i] = add(g[i], mul(solid->m[i], sub(x[i], x_tilde[i])));
}

/* A Hessian is a list of triplets, the slides' IJV; values at the same place
 * are added later.  CHOLMOD reads the upper triangle of a symmetric matrix. */
static void add_entry(cholmod_triplet *H, int row, int column, double value)
{
    if (row > column)
        return;
    ((int *)H->i)[H->nnz] = row;
    ((int *)H->j)[H->nnz] = column;
    ((double *)H->x)[H->nnz++] = value;
}

/* H += M, diagonal: row 2i is x of node i, and row 2i + 1 is y. */
static void inertia_hess(const Solid *solid, cholmod_triplet *H)
{
    for (int row = 0; row < 2 * solid->nodes; row++)
        add_entry(H, row, row, solid->m[row / 2]);
}

/* ==== Projection to positive semi-definite (utils.py: make_PSD) =========== */
/* A = Q L Q^T by LAPACK, as in numpy's eigh.  l gets the eigenvalues, and the
 * eigenvectors replace A: in C's order of a matrix they are its rows. */
void dsyev_(const char *vectors, const char *triangle, const int *n, double *A,
            const int *lda, double *l, double *work, const int *size,
            int *info);

/* Negative eigenvalues become 0: hess = Q max(L, 0) Q^T. */
static void make_psd(double hess[4][4])
{
    double q[4][4], l[4], work[64];
    memcpy(q, hess, sizeof q);
    dsyev_("V", "U", &(int){4}, q[0], &(int){4}, l, work, &(int){64},
           &(int){0});
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            hess[r][c] = 0;
            for (int i = 0; i < 4; i++)
                hess[r][c] += q[i][r] * fmax(l[i], 0) * q[i][c];
        }
}

/* ==== Mass-spring elasticity (MassSpringEnergy.py) ======================== */
/* P = sum of l^2 k/2 (|d|^2/l^2 - 1)^2, d = x_i - x_j.  Why not (|d| - l)^2, as
 * at school?  P is a polynomial in x: no root, smooth also at |d| = 0. */
static double spring_val(const Solid *solid, const Vec2 *x)
{
    double sum = 0;
    for (const Spring *e = solid->e; e < solid->e + solid->springs; e++) {
        Vec2 d = sub(x[e->i], x[e->j]);
        double strain = dot(d, d) / e->l2 - 1;
        sum += e->l2 * 0.5 * e->k * strain * strain;
    }
    return sum;
}

/* g += scale grad P.  A spring pulls its two nodes in opposite directions. */
static void spring_grad(const Solid *solid, const Vec2 *x, double scale,
                        Vec2 *g)
{
    for (const Spring *e = solid->e; e < solid->e + solid->springs; e++) {
        Vec2 d = sub(x[e->i], x[e->j]);
        Vec2 g_diff = mul(scale * 2 * e->k * (dot(d, d) / e->l2 - 1), d);
        g[e->i] = add(g[e->i], g_diff);
        g[e->j] = sub(g[e->j], g_diff);
    }
}

/* H += scale (Hessian of P), the 4x4 block of each spring projected:
 *   [ D -D]
 *   [-D  D],  D = 2k/l^2 (2 d d^T + (|d|^2 - l^2) I)
 * A compressed spring, |d| < l, would rather turn aside than stay compressed:
 * its block has a negative eigenvalue, and Newton's p may lead uphill.  Why not
 * project the whole H?  Its eigenvalues are expensive, and a sum of positive
 * semi-definite blocks is positive semi-definite anyway. */
static void spring_hess(const Solid *solid, const Vec2 *x, double scale,
                        cholmod_triplet *H)
{
    for (const Spring *e = solid->e; e < solid->e + solid->springs; e++) {
        Vec2 d = sub(x[e->i], x[e->j]);
        double factor = 2 * e->k / e->l2, excess = dot(d, d) - e->l2;
        double D[2][2] = {
            {factor * (2 * d.x * d.x + excess), factor * 2 * d.x * d.y},
            {factor * 2 * d.x * d.y, factor * (2 * d.y * d.y + excess)}};
        double block[4][4];
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++)
                block[r][c] = (r / 2 == c / 2 ? 1 : -1) * D[r % 2][c % 2];
        make_psd(block);
        int place[4] = {2 * e->i, 2 * e->i + 1, 2 * e->j, 2 * e->j + 1};
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++)
                add_entry(H, place[r], place[c], scale * block[r][c]);
    }
}

/* ==== Incremental potential and search direction (time_integrator.py) ===== */
/* E(x) = |x - x_tilde|_M^2 / 2 + h^2 P(x).  Implicit Euler wants the x with
 *   x = x_n + h v,   v = v_n - h M^-1 grad P(x).
 * Put v into the first equation and multiply by M: the result is grad E(x) = 0.
 * So the end of the time step is a minimum of E. */
static double ip_val(const Solid *solid, const Vec2 *x, const Vec2 *x_tilde,
                     double h)
{
    return inertia_val(solid, x, x_tilde) + h * h * spring_val(solid, x);
}

/* g += M (x - x_tilde) + h^2 grad P(x) */
static void ip_grad(const Solid *solid, const Vec2 *x, const Vec2 *x_tilde,
                    double h, Vec2 *g)
{
    inertia_grad(solid, x, x_tilde, g);
    spring_grad(solid, x, h * h, g);
}

/* H = M + h^2 (projected Hessian of P): positive definite, because M is. */
static cholmod_sparse *ip_hess(const Solid *solid, const Vec2 *x, double h,
                               cholmod_common *common)
{
    size_t n = 2 * (size_t)solid->nodes; /* a symmetric 4x4 block: 10 numbers */
    cholmod_triplet *IJV = cholmod_allocate_triplet(
        n, n, n + 10 * (size_t)solid->springs, 1, CHOLMOD_REAL, common);
    if (!IJV)
        return NULL;
    inertia_hess(solid, IJV);
    spring_hess(solid, x, h * h, IJV);
    cholmod_sparse *H = cholmod_triplet_to_sparse(IJV, 0, common);
    cholmod_free_triplet(&IJV, common);
    return H;
}

/* p = -H^-1 g leads downhill, because g.p = -p^T H p < 0.  The slides call
 * spsolve; here Cholesky's H = L L^T does it: `analyze` finds a good order of
 * elimination and the places where L is not zero, `factorize` computes L. */
static void search_dir(const Solid *solid, const Vec2 *x, const Vec2 *x_tilde,
                       double h, Vec2 *p)
{
    size_t n = 2 * (size_t)solid->nodes;
    cholmod_common common;
    cholmod_start(&common);
    common.print = 0;    /* CHOLMOD prints no messages */
    common.final_ll = 1; /* L L^T, which only a positive definite H has */
    cholmod_sparse *H = ip_hess(solid, x, h, &common);
    cholmod_dense *g = cholmod_zeros(n, 1, CHOLMOD_REAL, &common), *y = NULL;
    if (g)
        ip_grad(solid, x, x_tilde, h, g->x);
    /* CHOLMOD's functions return NULL if they are given NULL, so one check is
     * enough.  L->minor is n if all pivots of L are positive. */
    cholmod_factor *L = cholmod_analyze(H, &common);
    cholmod_factorize(H, L, &common);
    if (common.status == CHOLMOD_OK && L->minor == n)
        y = cholmod_solve(CHOLMOD_A, L, g, &common);
    if (!y || !isfinite(cholmod_norm_dense(y, 0, &common)))
        FAIL(1, "CHOLMOD cannot solve H p = -g: %s\n",
             common.status < 0 ? "not enough memory" : "rounding, or overflow");
    for (int i = 0; i < solid->nodes; i++)
        p[i] = mul(-1, ((Vec2 *)y->x)[i]);
    cholmod_free_dense(&y, &common);
    cholmod_free_factor(&L, &common);
    cholmod_free_dense(&g, &common);
    cholmod_free_sparse(&H, &common);
    cholmod_finish(&common);
}

/* ==== Backtracking line search (Algorithm 2) ============================== */
/* alpha = 1, 1/2, 1/4, ... until E does not rise; x_new = x + alpha p.  Why
 * does the search end?  p leads downhill.  Unlike the slide, this loop has a
 * limit, since numbers may overflow, or rounding may hide a small decrease. */
static double line_search(const Solid *solid, const Vec2 *x, const Vec2 *p,
                          const Vec2 *x_tilde, double h, Vec2 *x_new)
{
    double E_last = ip_val(solid, x, x_tilde, h), alpha = 1;
    for (int halvings = 0; halvings <= 64; halvings++, alpha /= 2) {
        for (int i = 0; i < solid->nodes; i++)
            x_new[i] = add(x[i], mul(alpha, p[i]));
        if (ip_val(solid, x_new, x_tilde, h) <= E_last)
            return alpha;
    }
    FAIL(1, "no step tried lowers E: overflow, or tol below rounding errors\n");
}

/* ==== Projected Newton for implicit Euler (Algorithm 3) =================== */
/* Largest |p_x| + |p_y| of all nodes, divided by h: the change of a velocity by
 * the next update, m/s.  Therefore tol means the same for every h and mesh.
 * (numpy's norm(p, inf) of an array of shape (n, 2) is the largest row sum.) */
static double residual(const Solid *solid, const Vec2 *p, double h)
{
    double largest = 0;
    for (int i = 0; i < solid->nodes; i++)
        largest = fmax(largest, fabs(p[i].x) + fabs(p[i].y));
    return largest / h;
}

/* One time step of implicit Euler, from t_n to t_n + h (slide: step_forward).
 * Fails if tol is below the rounding errors of p.  elasto also adds the last p,
 * so its x is 10 to 1e11 times as accurate.  table: file of updates, or NULL. */
static void step_forward(Solid *solid, double h, double tol, int step,
                         FILE *table)
{
    int n = solid->nodes;
    Vec2 *x = solid->x, *v = solid->v;
    Vec2 *x_n = allocate(4 * n, sizeof(Vec2)), *x_tilde = x_n + n;
    Vec2 *p = x_tilde + n, *x_new = p + n;
    for (int i = 0; i < n; i++) {
        x_n[i] = x[i]; /* x_n is also Newton's first iterate */
        x_tilde[i] = add(x[i], mul(h, v[i]));
    }
    search_dir(solid, x, x_tilde, h, p);
    for (int update = 0; residual(solid, p, h) > tol; update++) {
        if (update == 10000)
            FAIL(1, "step %d does not end: residual %g m/s after %d updates\n",
                 step, residual(solid, p, h), update);
        double alpha = line_search(solid, x, p, x_tilde, h, x_new);
        if (table)
            fprintf(table, "%d,%d,%.17g,%.17g\n", step, update,
                    residual(solid, p, h), alpha);
        memcpy(x, x_new, (size_t)n * sizeof(Vec2));
        search_dir(solid, x, x_tilde, h, p);
    }
    for (int i = 0; i < n; i++)
        v[i] = mul(1 / h, sub(x[i], x_n[i]));
    free(x_n);
}

/* ==== Forward and symplectic Euler ======================================== */
/* There is no equation to solve.  Forward Euler moves x with the old v, and
 * each step adds energy until the square explodes.  Symplectic Euler moves x
 * with the new v: the energy stays near the true one if h is small.  From
 * main's start h = 0.01/n_seg s is small enough, 0.025/n_seg s too large. */
static void explicit_euler(Solid *solid, double h, bool symplectic)
{
    Vec2 *x = solid->x, *v = solid->v, *g = allocate(solid->nodes, sizeof *g);
    spring_grad(solid, x, 1, g); /* the force on node i is -g[i] */
    for (int i = 0; i < solid->nodes; i++) {
        Vec2 v_n = v[i];
        v[i] = sub(v_n, mul(h / solid->m[i], g[i]));
        x[i] = add(x[i], mul(h, symplectic ? v[i] : v_n));
    }
    free(g);
}

/* ==== Drawing (simulator.py) ============================================== */
#define FOLDER "lecture_pictures"
enum { PIXELS = 600, MAX_PICTURES = 100, HELD_MASS_FACTOR = 1 << 20 };
typedef struct Screen {
    SDL_Surface *picture; /* picture in memory; NULL: there is a window */
    SDL_Renderer *renderer;
    double scale, node_radius; /* pixels per metre; pixels */
    Vec2 *x_start, mouse; /* [nodes] start positions (m); mouse position (m) */
    int pulled;           /* the node that the mouse pulls, or -1 */
    bool is_paused;
} Screen;

/* Converts metres, y upwards, to pixels, y downwards. */
static Vec2 screen_projection(const Screen *screen, Vec2 x)
{
    return (Vec2){PIXELS / 2 + screen->scale * x.x,
                  PIXELS / 2 - screen->scale * x.y};
}

/* Draws a line from a to b with round ends; a disc if a = b.  SDL's lines are
 * jagged, so we draw a blue polygon in a ring that fades out. */
static void draw_line(const Screen *screen, Vec2 a, Vec2 b, double radius)
{
    enum { N = 24 };          /* corners */
    SDL_Vertex vertex[2 * N]; /* polygon and outer ring */
    int index[9 * N];
    a = screen_projection(screen, a);
    b = screen_projection(screen, b);
    if (!(dot(a, a) + dot(b, b) < 1e8))
        return; /* coordinates too large for SDL */
    double direction = atan2(b.y - a.y, b.x - a.x);
    for (int i = 0; i < 2 * N; i++) {
        double angle = 2 * M_PI * (i + 0.5) / N, far = radius - 0.5 + i / N;
        Vec2 way = {cos(direction + angle), sin(direction + angle)};
        Vec2 at = add(cos(angle) > 0 ? b : a, mul(far, way));
        Uint8 opaque = i < N ? 255 : 0;
        vertex[i] = (SDL_Vertex){{at.x, at.y}, {0, 0, 255, opaque}, {0, 0}};
    }
    for (int i = 0; i < N; i++) {
        int next = (i + 1) % N;
        int triangles[] = {0, i, next, i, next, N + i, N + i, next, N + next};
        memcpy(index + 9 * i, triangles, sizeof triangles);
    }
    SDL_RenderGeometry(screen->renderer, NULL, vertex, 2 * N, index, 9 * N);
}

static void draw(const Screen *screen, const Solid *solid)
{
    SDL_SetRenderDrawColor(screen->renderer, 255, 255, 255, 255);
    SDL_RenderClear(screen->renderer);
    for (const Spring *e = solid->e; e < solid->e + solid->springs; e++)
        draw_line(screen, solid->x[e->i], solid->x[e->j], 1);
    for (int i = 0; i < solid->nodes; i++)
        draw_line(screen, solid->x[i], solid->x[i], screen->node_radius);
    SDL_RenderPresent(screen->renderer);
}

/* Opens a window, or a picture in memory if SDL has no display. */
static Screen open_screen(const Solid *solid)
{
    double size = fmax(fabs(solid->x[0].x), fabs(solid->x[0].y));
    Screen screen = {.scale = PIXELS / (4 * size), .pulled = -1};
    screen.x_start = allocate(solid->nodes, sizeof(Vec2));
    memcpy(screen.x_start, solid->x, (size_t)solid->nodes * sizeof(Vec2));
    screen.node_radius = fmax(0.1 * screen.scale * sqrt(solid->e[0].l2), 1.5);
    SDL_Window *window = NULL;
    if (SDL_Init(SDL_INIT_VIDEO) == 0 &&
        strcmp(SDL_GetCurrentVideoDriver(), "dummy") != 0 &&
        strcmp(SDL_GetCurrentVideoDriver(), "offscreen") != 0)
        SDL_CreateWindowAndRenderer(PIXELS, PIXELS, SDL_WINDOW_RESIZABLE,
                                    &window, &screen.renderer);
    SDL_SetWindowTitle(
        window, "lecture: pull at a node; Space pauses, R restarts, Esc ends");
    if (!window) {
        printf("no screen: %d pictures go to %s/\n", MAX_PICTURES, FOLDER);
        mkdir(FOLDER, 0777); /* SDL_SaveBMP reports a missing folder */
        screen.picture = SDL_CreateRGBSurfaceWithFormat(0, PIXELS, PIXELS, 24,
                                                        SDL_PIXELFORMAT_RGB24);
        screen.renderer = SDL_CreateSoftwareRenderer(screen.picture);
    }
    if (!screen.renderer)
        FAIL(1, "cannot draw: %s\n", SDL_GetError());
    SDL_RenderSetLogicalSize(screen.renderer, PIXELS, PIXELS);
    SDL_SetRenderDrawBlendMode(screen.renderer, SDL_BLENDMODE_BLEND);
    return screen;
}

/* Handles Space, R, Esc and the mouse, which holds the nearest node: the held
 * node is so heavy that springs do not move it.  Returns false to quit. */
static bool handle_event(Screen *screen, Solid *solid, const SDL_Event *event)
{
    SDL_Keycode key = event->type == SDL_KEYDOWN ? event->key.keysym.sym : 0;
    screen->is_paused ^= key == SDLK_SPACE;
    for (int i = 0; i < solid->nodes && key == SDLK_r; i++) {
        solid->x[i] = screen->x_start[i];
        solid->v[i] = (Vec2){0, 0};
    }
    if (event->type == SDL_MOUSEMOTION)
        screen->mouse = (Vec2){(event->motion.x - PIXELS / 2) / screen->scale,
                               (PIXELS / 2 - event->motion.y) / screen->scale};
    if (event->type == SDL_MOUSEBUTTONDOWN && screen->pulled < 0) {
        screen->pulled = 0;
        for (int i = 1; i < solid->nodes; i++)
            if (distance(solid->x[i], screen->mouse) <
                distance(solid->x[screen->pulled], screen->mouse))
                screen->pulled = i;
        solid->m[screen->pulled] *= HELD_MASS_FACTOR;
    }
    bool leaves = event->type == SDL_WINDOWEVENT &&
                  event->window.event == SDL_WINDOWEVENT_FOCUS_LOST;
    if ((leaves || event->type == SDL_MOUSEBUTTONUP) && screen->pulled >= 0) {
        solid->m[screen->pulled] /= HELD_MASS_FACTOR;
        screen->pulled = -1;
    }
    return event->type != SDL_QUIT && key != SDLK_ESCAPE;
}

/* Shows the solid for a while, or saves a picture.  Returns false to end. */
static bool show(Screen *screen, Solid *solid, double h, int step)
{
    draw(screen, solid);
    if (screen->picture) {
        char name[40];
        snprintf(name, sizeof name, FOLDER "/step_%03d.bmp", step);
        if (SDL_SaveBMP(screen->picture, name) != 0) {
            remove(name); /* the picture is incomplete */
            FAIL(1, "cannot write %s: %s\n", name, SDL_GetError());
        }
        return step < MAX_PICTURES;
    }
    SDL_Event event; /* 40 ms a step: real time would be too fast */
    Uint32 end = SDL_GetTicks() + (step == 0 ? 1000 : 40);
    do {
        while (SDL_PollEvent(&event)) {
            if (!handle_event(screen, solid, &event))
                return false;
            draw(screen, solid); /* the window may have been resized */
        }
        SDL_Delay(5); /* under X11 SDL_WaitEvent may fail on closing */
    } while (screen->is_paused || !SDL_TICKS_PASSED(SDL_GetTicks(), end));
    if (screen->pulled >= 0) { /* the node moves 1/3 of the way to the mouse */
        Vec2 way = sub(screen->mouse, solid->x[screen->pulled]);
        solid->v[screen->pulled] = mul(1 / (3 * h), way);
    }
    return true;
}

/* ==== Simulator (simulator.py) ============================================ */
typedef struct Parameter {
    const char *name;
    double value, min, max;
} Parameter;
#define DEFAULTS                                                               \
    "side_len=1 rho=1000 k=1e5 initial_stretch=1.4 n_seg=4 h=0.004 tol=0.01 "  \
    "method=0 steps=N states=FILE"
/* Reads "h=0.004" or "h=1/60" into parameter h of p, a list up to NULL. */
static void read_argument(const char *text, Parameter *const *p)
{
    char name[20] = "";
    double value = 0, below = 1;
    int end = 0; /* end of the text that was read */
    sscanf(text, "%19[a-z_]=%lf%n/%lf%n", name, &value, &end, &below, &end);
    value /= below;
    while (*p && strcmp(name, (*p)->name) != 0)
        p++;
    if (!*p)
        FAIL(2, "'%s' is none of " DEFAULTS "\n", text);
    bool whole = (*p)->max < 1e30; /* a max of 1e30 marks real numbers */
    if (!(value >= (*p)->min && value <= (*p)->max) || text[end] ||
        (whole && value != floor(value)))
        FAIL(2, "'%s': %s is a %snumber from %g to %g\n", text, name,
             whole ? "whole " : "", (*p)->min, (*p)->max);
    (*p)->value = value;
}

int main(int argc, char **argv)
{
    Parameter side_len = {"side_len", 1, 1e-30, 1e30}; /* m */
    Parameter rho = {"rho", 1000, 1e-30, 1e30};        /* kg/m^2, density */
    Parameter k = {"k", 1e5, 1e-30, 1e30};             /* J/m^2, stiffness */
    Parameter stretch = {"initial_stretch", 1.4, -1e30, 1e30};
    Parameter n_seg = {"n_seg", 4, 1, 1000};    /* on a side */
    Parameter h = {"h", 0.004, 1e-30, 1e30};    /* s */
    Parameter tol = {"tol", 1e-2, 1e-30, 1e30}; /* m/s */
    Parameter method = {"method", 0, 0, 2};  /* 1 symplectic, 2 forward Euler */
    Parameter steps = {"steps", -1, 0, 1e9}; /* -1: until the window closes */
    Parameter *all[] = {&side_len, &rho, &k,      &stretch, &n_seg,
                        &h,        &tol, &method, &steps,   NULL};
    const char *states = "/dev/null"; /* the file for x and v */
    for (int a = 1; a < argc; a++)
        if (strncmp(argv[a], "states=", 7) == 0)
            states = argv[a] + 7;
        else
            read_argument(argv[a], all);
    Solid solid = square(side_len.value, (int)n_seg.value, rho.value, k.value);
    for (int i = 0; i < solid.nodes; i++)
        solid.x[i].x *= stretch.value; /* the springs keep their rest length */
    /* FILE.part becomes FILE when complete; a device has no .part. */
    char part[2 * FILENAME_MAX];
    snprintf(part, sizeof part, "%s%s", states,
             strncmp(states, "/dev/", 5) == 0 ? "" : ".part");
    FILE *file = fopen(part, "w");
    if (!file)
        FAIL(1, "cannot write %s: %s\n", part, strerror(errno));
    fputs("step,time,node,x,y,vx,vy\n", file);
    bool drawn = steps.value < 0;
    Screen screen = drawn ? open_screen(&solid) : (Screen){0};
    puts("step,iteration,residual,alpha");
    for (int step = 0;; step++) {
        for (int i = 0; i < solid.nodes; i++)
            fprintf(file, "%d,%.17g,%d,%.17g,%.17g,%.17g,%.17g\n", step,
                    step * h.value, i, solid.x[i].x, solid.x[i].y, solid.v[i].x,
                    solid.v[i].y);
        if (fflush(NULL) != 0 || ferror(file) || ferror(stdout))
            FAIL(1, "cannot write %s: %s\n",
                 ferror(file) ? part : "standard output", strerror(errno));
        if (drawn ? !show(&screen, &solid, h.value, step) : step == steps.value)
            break;
        if (method.value == 0)
            step_forward(&solid, h.value, tol.value, step + 1, stdout);
        else
            explicit_euler(&solid, h.value, method.value == 1);
        if (!isfinite(spring_val(&solid, solid.x)))
            FAIL(1, "step %d: the square has exploded\n", step + 1);
    }
    if (fclose(file) != 0 || (strcmp(part, states) && rename(part, states)))
        FAIL(1, "cannot write %s: %s\n", states, strerror(errno));
    SDL_Quit();
    return 0;
}
