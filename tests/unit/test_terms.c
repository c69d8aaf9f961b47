/* test_terms.c - the promises of term.h, tested for each term at random points
 * against the oracle. A new term without an option needs a row here. */
#include "oracle.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/cells.h"
#include "model/neo_hookean.h"
#include "model/damping.h"
#include "model/friction.h"
#include "model/plasticity.h"
#include "model/pull_energy.h"
#include "model/mass_spring_energy.h"
#include "model/self_contact.h"

enum { MAX_2N = 2 * 40 }; /* largest number of coordinates */

/* A system of a few nodes with one kind of energy, or two */
typedef struct TermRow {
    const char *name;
    enum {
        SPRING,
        RANDOM_SPRINGS,
        WALL,
        BALL,
        FREE_BALL,
        ONE_TRIANGLE,
        CELL_GRID,
        TWO_BODIES
    } shape;
    double yield, hardening; /* read as one array by plastic_energy.configure */
    double damping, pull_stiffness; /* 0: none; pull in J/m^2 */
    bool has_mu, is_collapsed; /* flat: springs have (nearly) no length at x */
    bool has_triangles;        /* triangles instead of springs */
    double max_alpha;          /* largest alpha, if no term limits it */
    const OptionRow *option;   /* option whose term is tested; NULL: none */
} TermRow;

static const TermRow rows[] = {
    {"one spring", SPRING, .max_alpha = 1e6},
    {"springs", RANDOM_SPRINGS, .max_alpha = 1e3},
    {"spring of no length", SPRING, .is_collapsed = true, .max_alpha = 1e3},
    {"springs of next to no length", RANDOM_SPRINGS, .is_collapsed = true,
     .max_alpha = 1e3},
    {"field and hand", RANDOM_SPRINGS, .pull_stiffness = 3, .max_alpha = 1e3},
    {"damped springs", RANDOM_SPRINGS, .damping = 0.3, .max_alpha = 1e3},
    {"flowing spring", SPRING, .yield = 0.1, .hardening = 0.3,
     .max_alpha = 1e3},
    {"flowing springs, damped", RANDOM_SPRINGS, .yield = 0.1, .hardening = 0.3,
     .damping = 0.3, .max_alpha = 1e3},
    {"perfectly plastic spring", SPRING, .yield = 0.1, .max_alpha = 1e6},
    {"wall", WALL, .max_alpha = 1e3},
    {"wall that rubs", WALL, .has_mu = true, .max_alpha = 1e3},
    {"ball", BALL, .max_alpha = 1e3},
    {"ball that rubs", BALL, .has_mu = true, .max_alpha = 1e3},
    {"free ball", FREE_BALL, .max_alpha = 1e3},
    {"free ball that rubs", FREE_BALL, .has_mu = true, .max_alpha = 1e3},
    {"corner", ONE_TRIANGLE, .max_alpha = 1e3},
    {"cells with springs", CELL_GRID, .max_alpha = 1e3},
    {"triangles", CELL_GRID, .has_triangles = true, .max_alpha = 1e3},
    {"two bodies", TWO_BODIES, .max_alpha = 1e3},
    {"two bodies that rub", TWO_BODIES, .has_mu = true, .max_alpha = 1e3},
};
enum { TERM_ROW_COUNT = sizeof rows / sizeof *rows };

/* One random point of a row, with directions p and q */
typedef struct TermCase {
    System system;
    EvalPoint at;
    double x_n[MAX_2N], u[MAX_2N], x[MAX_2N], p[MAX_2N], q[MAX_2N], h;
    int unknowns;
} TermCase;

static void make_node_contact(const TermRow *row, Random *random, TermCase *c)
{
    double angle = random_uniform(random, 0, 6.28);
    Obstacle it = {.kind = row->shape == WALL ? OBSTACLE_WALL : OBSTACLE_BALL,
                   .n = {cos(angle), sin(angle)},
                   .radius = 0.3,
                   .v = {random_uniform(random, -9, 9), 4},
                   .mu = row->has_mu ? 0.7 : 0,
                   .ball_node = row->shape == FREE_BALL ? 1 : -1};
    const Barrier barrier = {.d_hat = 0.1, .c = 3};
    double d = 0.1 * random_logarithmic(random, 1e-3, row->has_mu ? 0.9 : 1.3) +
               (row->shape == WALL ? 0 : it.radius);
    for (int axis = 0; axis < 2; axis++) {
        it.o[axis] = random_uniform(random, -1, 1);
        c->x_n[axis] = it.o[axis] + d * it.n[axis];
        c->x_n[2 + axis] = it.o[axis] + (it.ball_node < 0 ? 9 * it.n[axis] : 0);
    }
    CHECK_OK(contact_configure(&c->system, &barrier, 1, &it));
    if (row->has_mu)
        CHECK_OK(friction_configure(&c->system, &friction_energy, true,
                                    random_logarithmic(random, 0.02, 50)));
}

static void configure_option(const OptionRow *option, Random *random,
                             const SquareMesh *mesh, System *system)
{
    double number[8];
    for (int i = 0; i < 8; i++)
        number[i] = random_uniform(random, fmax(option->low, -3),
                                   fmin(option->high, 3));
    CHECK_OK(option->term->configure(system, mesh, number));
}

static void make_cell_grid(const TermRow *row, Random *random, TermCase *c)
{
    int n = row->shape == ONE_TRIANGLE ? 1 : 2;
    const SquareMesh mesh = square_mesh_create(n, n, 1, 1);
    CHECK_OK(system_create(mesh.nodes, mesh.springs, &c->system));
    for (int i = 0; i < mesh.nodes; i++)
        square_mesh_rest_position(&mesh, i, c->x_n + 2 * i);
    square_mesh_list_springs(&mesh, c->system.e);
    for (int s = 0; s < mesh.springs; s++) {
        c->system.l2[s] = (s < 2 * n * (n + 1) ? 1.0 : 2.0) / (n * n);
        c->system.k[s] = 2;
    }
    const double material[3] = {1, random_logarithmic(random, 0.1, 10),
                                random_uniform(random, 0, 0.49)};
    CHECK_OK(row->has_triangles
                 ? neo_hookean_energy.configure(&c->system, &mesh, material)
                 : cells_configure(&c->system, &mesh, 5));
    if (row->option)
        configure_option(row->option, random, &mesh, &c->system);
    if (row->shape == CELL_GRID && !row->has_triangles &&
        random_below(random, 2))
        c->system.k[random_below(random, c->system.springs)] = 0;
    if (row->shape ==
        ONE_TRIANGLE) { /* one triangle remains, without springs */
        const CellBarriers *cells =
            system_find_term(&c->system, &cell_energy)->data;
        const int *side = cells->side_springs[0];
        for (int s = 0; s < c->system.springs; s++)
            if (s != side[0] && s != side[1] && s != side[2])
                c->system.k[s] = 0;
    }
}

/* Makes two cells whose springs have no energy: a corner of the second, turned
 * cell is near the right edge of the first, or beyond an end of this edge. */
static void make_two_bodies(const TermRow *row, Random *random, TermCase *c)
{
    const Barrier barrier = {.d_hat = 0.2, .c = 24};
    const SquareMesh mesh = square_mesh_create(1, 1, 1, 2);
    CHECK_OK(system_create(mesh.nodes, mesh.springs, &c->system));
    square_mesh_list_springs(&mesh, c->system.e);
    for (int s = 0; s < mesh.springs; s++)
        c->system.k[s] = c->system.l2[s] = 1;
    system_remove_term(&c->system, &mass_spring_energy);
    double angle = random_uniform(random, 0.05, 1.5);
    double up = random_uniform(random, -0.7, 0.7);
    double away = 0.2 * random_logarithmic(random, 1e-2, 1.3);
    /* The corner that comes near the other square is node 0 or node 4. */
    int swap = 4 * random_below(random, 2);
    for (int i = 0; i < mesh.nodes; i++) {
        double *x = c->x_n + 2 * ((i + swap) % mesh.nodes);
        square_mesh_rest_position(&mesh, i, x);
        if (i < 4)
            continue;
        double right = x[0] + 0.5, high = x[1] - 0.5; /* from the corner */
        x[0] = 0.5 + away + cos(angle) * right - sin(angle) * high;
        x[1] = up + sin(angle) * right + cos(angle) * high;
    }
    CHECK_OK(self_contact_configure(&c->system, &mesh, &barrier, 0.7));
    if (row->has_mu)
        CHECK_OK(friction_configure(&c->system, &self_friction_energy, true,
                                    random_logarithmic(random, 0.02, 50)));
}

static void make_shape(const TermRow *row, Random *random, TermCase *c)
{
    if (row->shape == RANDOM_SPRINGS) {
        random_system(random, row->is_collapsed ? SPRINGS_SHORT : SPRINGS_MIXED,
                      &c->system, c->x_n);
        return;
    }
    if (row->shape == TWO_BODIES) {
        make_two_bodies(row, random, c);
        return;
    }
    if (row->shape == CELL_GRID || row->shape == ONE_TRIANGLE) {
        make_cell_grid(row, random, c);
        return;
    }
    CHECK_OK(system_create(2, row->shape == SPRING, &c->system));
    for (int i = 0; i < 4; i++)
        c->x_n[i] = random_uniform(random, -1, 1);
    if (row->shape != SPRING) {
        make_node_contact(row, random, c);
        return;
    }
    c->system.e[1] = 1;
    c->system.l2[0] = random_logarithmic(random, 0.05, 20);
    c->system.k[0] = 7;
}

/* Adds a central field and a hand, each of which pulls one node. */
static void add_pull_terms(Random *random, double strength, System *system)
{
    const NodePull all = {.node = random_below(random, system->nodes),
                          .k = strength};
    const NodePull one = {.node = random_below(random, system->nodes),
                          .k = 3 * strength,
                          .target = {random_uniform(random, -2, 2),
                                     random_uniform(random, -2, 2)}};
    CHECK_OK(pull_configure(system, &central_field, &all));
    CHECK_OK(pull_configure(system, &hand_energy, &one));
}

static void add_terms(const TermRow *row, Random *random, System *system)
{
    if (row->pull_stiffness > 0)
        add_pull_terms(random, row->pull_stiffness, system);
    if (row->yield > 0) {
        CHECK_OK(plastic_energy.configure(system, NULL, &row->yield));
        Plasticity *flow = system_term_data(system, &plastic_energy);
        for (int s = 0; s < system->springs; s++) {
            flow->ep[s] = random_uniform(random, -0.3, 0.3);
            flow->kappa[s] = random_uniform(random, 0, 0.5);
        }
    }
    if (row->damping > 0)
        CHECK_OK(damping.configure(system, NULL, &row->damping));
}

/* Draws random u that all terms allow, and random directions. */
static void draw_positions(const TermRow *row, Random *random, TermCase *c)
{
    double shake = row->is_collapsed          ? 1e-8
                   : row->shape == TWO_BODIES ? 0.05
                   : row->shape >= CELL_GRID  ? 0.3
                                              : 0.2;
    bool good = false;
    for (int k = 0; !good; k++, shake *= 0.7) {
        CHECK(k < 100);
        good = true;
        for (int i = 0; i < c->unknowns; i++) {
            int from = row->is_collapsed && row->shape == SPRING ? i % 2 : i;
            c->u[i] = shake * random_uniform(random, -1, 1);
            c->u[i] = c->u[from];
            c->x_n[i] = c->x_n[from];
            c->x[i] = c->x_n[i] + c->u[i];
            c->p[i] = random_uniform(random, -1, 1);
            c->q[i] = random_uniform(random, -1, 1);
        }
        for (int t = 0; t < c->system.term_count; t++) {
            c->at.term = &c->system.term[t];
            if (c->at.term->kind->element)
                good = good && elements_are_feasible(&c->at) &&
                       edge_crossings(&c->system, c->x) == 0;
        }
    }
    c->at.term = NULL; /* evaluation starts with the first term */
}

static void make_case(const TermRow *row, Random *random, TermCase *c)
{
    System *system = &c->system;
    memset(c, 0, sizeof *c);
    make_shape(row, random, c);
    for (int i = 0; i < system->nodes; i++)
        system->m[i] = random_logarithmic(random, 0.1, 10);
    add_terms(row, random, system);
    c->unknowns = 2 * system->nodes;
    c->h = random_logarithmic(random, 1e-3, 1);
    for (int i = 0; i < system->term_count; i++)
        if (system->term[i].kind->begin_step)
            CHECK_OK(system->term[i].kind->begin_step(
                &(TermStep){system, &system->term[i], c->x_n, c->u, c->h}));
    c->at = make_eval_point(system, c->x_n, c->u, c->x);
    c->at.weight = random_logarithmic(random, 0.1, 10);
    draw_positions(row, random, c);
}

/* Multiplies by the Hessian of a term: out += H q; a constant force has no
 * Hessian. Returns the number of changed blocks. */
static int apply_hessian(const TermCase *c, const TermKind *kind,
                         Projection projection, const double *q, double *out)
{
    return kind->hessian ? kind->hessian(&c->at, projection, NULL, q, out) : 0;
}

static double dot_product(const TermCase *c, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < c->unknowns; i++)
        sum += a[i] * b[i];
    return sum;
}

static const TermRow *row; /* row of the running test */
static long comparisons;   /* number of comparisons */

/* Returns energy and derivatives by the oracle. noise out: allowed errors */
static Jet evaluate_oracle(const TermCase *c, const TermKind *kind, Real alpha,
                           Jet *noise)
{
    Random random = {1};
    Probe probe = {
        .at = &c->at, .h = c->h, .alpha = alpha, .p = c->p, .q = c->q};
    Jet part = oracle_energy(&probe, kind), size = probe.abs_sum;
    *noise = (Jet){1e-12L * size.f, 1e-12L * size.p, 0, 1e-12L * size.pq};
    probe.jitter = &random;
    for (int i = 0; i < 8; i++) {
        Jet other = oracle_energy(&probe, kind);
        noise->f += 80 * fabsl(other.f - part.f);
        noise->p += 80 * fabsl(other.p - part.p);
        noise->pq += 80 * fabsl(other.pq - part.pq);
    }
    return part;
}

static void compare(const char *what, Real got, Real expected, Real tolerance)
{
    comparisons++;
    if (got == expected) /* both infinite: behind a wall */
        return;
    if (!(fabsl(got - expected) <= tolerance))
        print_error("%s: ", row->name);
    check_near(what, got, expected, tolerance, __FILE__, __LINE__);
}

/* Returns the allowed error of the scalar product a.b: four ulps of the sum of
 * |a_i b_i|, since a.b itself is small if a and b are nearly orthogonal. */
static Real find_dot_noise(const TermCase *c, const double *a, const double *b)
{
    Real sum = 0;
    for (int i = 0; i < c->unknowns; i++)
        sum += fabs(a[i] * b[i]);
    return 4 * DBL_EPSILON * sum;
}

/* Returns the allowed error of p H q: four ulps of each product in the sum. */
static Real find_hessian_noise(TermCase *c, const TermKind *kind)
{
    Real sum = 0;
    for (int i = 0; i < c->unknowns; i++) {
        double unit[MAX_2N] = {0}, column[MAX_2N] = {0};
        unit[i] = c->q[i];
        apply_hessian(c, kind, PROJECTION_NONE, unit, column);
        sum += find_dot_noise(c, c->p, column);
    }
    return sum;
}

static void check_derivatives(TermCase *c, const TermKind *kind)
{
    Jet noise;
    double g[MAX_2N] = {0}, Hq[MAX_2N] = {0}, Hp[MAX_2N] = {0};
    Jet formula = evaluate_oracle(c, kind, 0, &noise);
    kind->gradient(&c->at, g);
    noise.p += find_dot_noise(c, g, c->p);
    noise.pq += find_hessian_noise(c, kind);
    apply_hessian(c, kind, PROJECTION_NONE, c->q, Hq);
    apply_hessian(c, kind, PROJECTION_NONE, c->p, Hp);
    if (!(system_term_data(&c->system, &damping) && !kind->is_external))
        compare("value", c->at.weight * kind->potential(&c->at), formula.f,
                noise.f);
    compare("gradient", dot_product(c, g, c->p), formula.p, noise.p);
    compare("Hessian", dot_product(c, Hq, c->p), formula.pq, noise.pq);
    compare("symmetry", dot_product(c, Hp, c->q), formula.pq, noise.pq);
    for (int f = 0; f < PROJECTION_COUNT; f++) { /* each projection */
        double projected[MAX_2N] = {0};
        bool differs = false;
        int changed = apply_hessian(c, kind, (Projection)f, c->q, projected);
        for (int i = 0; i < c->unknowns; i++)
            differs = differs || projected[i] != Hq[i];
        CHECK((changed > 0) == differs);
    }
    for (int i = 0; kind->is_diagonal && i < c->unknowns; i++)
        compare("curvature", fabs(Hq[i]), 0,
                c->at.weight * kind->max_stiffness(&c->at) * fabs(c->q[i]) *
                    (1 + 4 * DBL_EPSILON));
    if (kind->is_external)
        return;
    Real sum[3] = {0}, size = 0;
    for (int i = 0; i < c->unknowns; i++) {
        double arm = i % 2 ? c->x[i - 1] : -c->x[i + 1];
        sum[i % 2] += g[i];
        sum[2] += (Real)arm * g[i];
        size += fabs(g[i]) * (1 + fabs(c->x[i]));
    }
    /* Self-friction has a torque, since its tangents are those at x_n. */
    for (int i = 0; i < (kind == &self_friction_energy ? 2 : 3); i++)
        compare("forces add up to nothing", sum[i], 0, 1e-14L * size);
}

/* Checks the change of E along p without its linear part, also a tiny one. */
static void check_E_along_p(TermCase *c, const TermKind *kind, Random *random)
{
    double q[3] = {0}, g[MAX_2N] = {0}, reach = INFINITY;
    if (kind->element)
        reach = elements_max_alpha(&c->at, c->p);
    double most = fmin(reach, row->max_alpha);
    if (random_below(random, 2))
        most *= random_logarithmic(random, 1e-6, 1);
    double alpha = random_below(random, 4) == 0
                       ? 1e-9
                       : most * random_logarithmic(random, 1e-9, 1);
    Jet noise[2], start = evaluate_oracle(c, kind, 0, &noise[0]);
    Jet end = evaluate_oracle(c, kind, alpha, &noise[1]);
    kind->gradient(&c->at, g);
    if (kind->line_polynomial)
        kind->line_polynomial(&c->at, c->p, q);
    double got = alpha * (alpha * (q[0] + alpha * (q[1] + alpha * q[2])));
    if (kind->taylor_remainder)
        got += kind->taylor_remainder(&c->at, c->p, alpha);
    Real expected = end.f - start.f - alpha * start.p;
    compare("change", got, expected,
            1e-13L * (fabsl(expected) + fabsl(end.f) + alpha * fabsl(start.p)) +
                noise[0].f + noise[1].f + alpha * noise[0].p);
    memcpy(c->q, c->p, sizeof c->p);
    start = evaluate_oracle(c, kind, 0, &noise[0]);
    if (alpha == 1e-9)
        compare("small change", got, alpha * alpha / 2 * start.pq,
                alpha * alpha * (1e-3L * fabsl(start.pq) + noise[0].pq));
}

/* Returns the smallest share that is left of a gap or a triangle's area. */
static double find_gap_ratio(const TermCase *c, const double *x)
{
    const Contact *contact = get_contact(&c->system);
    double least = INFINITY;
    for (int i = 0; contact && i < c->system.nodes; i++)
        if (contact_includes_pair(contact, &c->system, i, 0))
            least = fmin(least, exact_gap(&c->system, x, i, 0) /
                                    exact_gap(&c->system, c->x, i, 0));
    return contact ? least
                   : smallest_area_ratio(&c->system, x) /
                         smallest_area_ratio(&c->system, c->x);
}

/* Checks that x is feasible up to the limit: 0.1 of a gap or area is left. */
static void check_max_alpha(TermCase *c, const TermKind *kind)
{
    double x[MAX_2N],
        alpha = kind->element ? elements_max_alpha(&c->at, c->p) : INFINITY;
    TermCase other = *c;
    if (!isfinite(alpha))
        return;
    for (int k = 1; k <= 20; k++) {
        for (int i = 0; i < c->unknowns; i++)
            x[i] = c->x[i] + alpha * k / 20 * c->p[i];
        other.at.x = x;
        CHECK(elements_are_feasible(&other.at) &&
              edge_crossings(&c->system, x) == 0);
    }
    long crossings = 0;
    for (int k = 2; k < 8; k++) { /* nodes go a little too far */
        double behind = (1 + pow(10, -k)) * alpha / 0.9;
        for (int i = 0; i < c->unknowns; i++)
            other.x[i] = c->x[i] + behind * c->p[i];
        crossings += edge_crossings(&c->system, other.x);
    }
    if (row->shape == TWO_BODIES)
        CHECK(crossings > 0);
    else if (row->shape != CELL_GRID) /* its smallest triangle may change */
        compare("what the limit leaves", find_gap_ratio(c, x), 0.1, 1e-8);
}

/* Checks that the matrix agrees with products, and that projection cuts or
 * mirrors the negative eigenvalues of its blocks. */
static void check_projection(TermCase *c, Random *random)
{
    IncrementalPotential E = {&c->system, c->at.weight, c->x_n, c->u};
    Iterate iterate = {.E = E, .u = c->u, .x = c->x};
    static double plain[MAX_2N * MAX_2N], H[MAX_2N * MAX_2N];
    static Real g[MAX_2N], exact_plain[MAX_2N * MAX_2N],
        exact_H[MAX_2N * MAX_2N];
    int n = c->unknowns;
    Sparse A;
    bool grown;
    CHECK_OK(incremental_potential_extend_pattern(&iterate, &grown));
    CHECK_OK(incremental_potential_create_hessian(&c->system, &A));
    CHECK(incremental_potential_hessian(&iterate, PROJECTION_NONE, &A) == 0);
    fill_dense_matrix(&A, plain);
    double Hq[MAX_2N], scale = 0;
    incremental_potential_apply_hessian(&iterate, PROJECTION_NONE, c->q, Hq);
    for (int i = 0; i < n * n; i++)
        scale = fmax(scale, fabs(plain[i]));
    for (int i = 0; i < n; i++) {
        Real sum = 0;
        for (int j = 0; j < n; j++)
            sum += (Real)plain[n * i + j] * c->q[j];
        compare("matrix", Hq[i], sum, 2e-14L * scale);
    }
    exact_derivatives(&E, c->u, c->x, c->h, 0, g, exact_plain);
    const Projection projections[2] = {PROJECTION_CLAMP, PROJECTION_ABS};
    for (int f = 0; f < 2; f++) {
        incremental_potential_hessian(&iterate, projections[f], &A);
        fill_dense_matrix(&A, H);
        for (int trial = 0; trial < 20; trial++) {
            double y[MAX_2N], value = 0;
            for (int i = 0; i < n; i++)
                y[i] = random_uniform(random, -1, 1);
            for (int i = 0; i < n * n; i++)
                value += y[i / n] * H[i] * y[i % n];
            CHECK(value >= -1e-12 * scale);
        }
        Real more = 0, expected = 0;
        exact_derivatives(&E, c->u, c->x, c->h, 1 + f, g, exact_H);
        for (int i = 0; i < n * n; i++) {
            Real pq = (Real)c->p[i / n] * c->q[i % n];
            more += pq * ((Real)H[i] - plain[i]);
            expected += pq * (exact_H[i] - exact_plain[i]);
        }
        /* An ulp of x changes a gap of 2 mm by 1e-13 of the gap, and the second
         * derivative of its barrier energy by 3e-13 of this derivative. */
        Real relative = 1e-14L * n + (row->shape == TWO_BODIES ? 4e-13L : 0);
        compare("projection", more, expected, relative * scale);
    }
    sparse_free(&A);
}

/* Checks E of a step, with inertia and all terms, and its derivatives. */
static void check_whole_step(TermCase *c, Random *random)
{
    double u_tilde[MAX_2N], g[MAX_2N], Hq[MAX_2N];
    for (int i = 0; i < c->unknowns; i++)
        u_tilde[i] = random_uniform(random, -1, 1);
    IncrementalPotential E = {&c->system, c->at.weight, c->x_n, u_tilde};
    Probe probe = {.at = &c->at, .h = c->h, .p = c->p, .q = c->q};
    Jet noise, part = oracle_step_energy(&probe, u_tilde), size = probe.abs_sum;
    evaluate_oracle(c, NULL, 0, &noise);
    Iterate iterate = {.E = E, .u = c->u, .x = c->x, .g = g, .p = c->p};
    incremental_potential_gradient(&E, c->u, c->x, g);
    incremental_potential_apply_hessian(&iterate, PROJECTION_NONE, c->q, Hq);
    compare("E's gradient", dot_product(c, g, c->p), part.p,
            noise.p + 1e-13L * size.p);
    compare("E's Hessian", dot_product(c, Hq, c->p), part.pq,
            noise.pq + find_dot_noise(c, Hq, c->p) + 1e-13L * size.pq);
    if (!system_term_data(&c->system, &damping))
        compare("E", incremental_potential_value(&E, c->u, c->x), part.f,
                noise.f + 1e-13L * size.f);
    const LineEnergy along = make_line_energy(&iterate);
    probe.alpha = 1e-3L;
    Real change = oracle_step_energy(&probe, u_tilde).f - part.f;
    compare("E along p", line_energy_difference(&along, 1e-3), change,
            2 * noise.f + noise.p + 1e-13L * size.f);
}

static void terms_match_the_oracle(void **state)
{
    row = *state;
    comparisons = 0;
    Random random = {strlen(row->name) + (uint64_t)row->shape};
    for (int n = 0; n < choose_case_count(2000, 150); n++) {
        static TermCase c;
        make_case(row, &random, &c);
        for (const TermKind *kind; (kind = eval_point_next_term(&c.at));) {
            if (!kind->potential)
                continue;
            CHECK(!(kind->potential(&c.at) < 0)); /* term.h promises P >= 0 */
            check_derivatives(&c, kind);
            check_max_alpha(&c, kind);
            check_E_along_p(&c, kind, &random);
        }
        check_projection(&c, &random);
        check_whole_step(&c, &random);
        system_free(&c.system);
    }
    CHECK(comparisons > 1000);
}

/* Checks a = -M^-1 grad P at each node; 1e-12: rounding. */
static void accelerations_are_forces_over_masses(void **unused)
{
    (void)unused;
    Random random = {77};
    System system;
    double x[MAX_2N], a[MAX_2N];
    random_system(&random, SPRINGS_MIXED, &system, x);
    EvalPoint at = make_eval_point(&system, x, NULL, x);
    system_acceleration(&system, x, a);
    for (int i = 0; i < 2 * system.nodes; i++) {
        double one[MAX_2N] = {0};
        one[i] = 1;
        Probe probe = {.at = &at, .p = one};
        Real force = -oracle_energy(&probe, NULL).p;
        CHECK_NEAR(a[i] * system.m[i / 2], force, 1e-12L * probe.abs_sum.p);
    }
    system_free(&system);
}

int main(int argc, char **argv)
{
    static TermRow all[TERM_ROW_COUNT + OPTIONS_MAX_ROWS];
    static struct CMUnitTest tests[TERM_ROW_COUNT + OPTIONS_MAX_ROWS + 1] = {
        cmocka_unit_test(accelerations_are_forces_over_masses)};
    int count = TERM_ROW_COUNT;
    memcpy(all, rows, sizeof rows);
    for (const OptionRow *option = option_rows; option->name; option++)
        if (option->term && option->term->configure)
            all[count++] = (TermRow){.name = option->name,
                                     .shape = CELL_GRID,
                                     .max_alpha = 1e3,
                                     .option = option};
    for (int i = 0; i < count; i++)
        tests[1 + i] = (struct CMUnitTest){all[i].name, terms_match_the_oracle,
                                           NULL, NULL, &all[i]};
    if (argc > 1)
        cmocka_set_test_filter(argv[1]);
    return _cmocka_run_group_tests("terms", tests, 1 + (size_t)count, NULL,
                                   NULL);
}
