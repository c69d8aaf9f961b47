/* Random scenes, and how one that fails is made smaller. */
#include "model/pull_energy.h"
#include "stress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* How the springs of a scene hang together. */
enum Graph {
    GRAPH_CHAIN,
    GRAPH_TREE,
    GRAPH_STAR,
    GRAPH_RING,
    GRAPH_ANY, /* random pairs, some twice, some nodes alone */
    GRAPH_TWO_PARTS,
    GRAPH_SQUARE,
    GRAPH_NONE,
    GRAPHS
};

static int random_row(Random *random)
{
    int rows = 0;
    while (integrator_methods[rows].name)
        rows++;
    return random_below(random, 2) ? 0 : random_below(random, rows);
}

static void wild_spring(Wild *wild, int i, int j)
{
    if (i == j || wild->springs == WILD_SPRINGS)
        return;
    wild->e[2 * wild->springs] = i;
    wild->e[2 * wild->springs + 1] = j;
    wild->springs++;
}

/* The springs of the slides' square. */
static void wild_square(Wild *wild, int segments)
{
    SquareMesh mesh;
    if (square_mesh_create(segments, segments, 1, &mesh) == STATUS_OK) {
        wild->nodes = mesh.nodes;
        for (int s = 0; s < mesh.springs; s++)
            wild_spring(wild, mesh.e[2 * s], mesh.e[2 * s + 1]);
        memcpy(wild->x, mesh.x, 2 * (size_t)mesh.nodes * sizeof *mesh.x);
    }
    square_mesh_free(&mesh);
}

/* Which nodes are joined. */
static void wild_graph(Random *random, Wild *wild)
{
    enum Graph graph = (enum Graph)random_below(random, GRAPHS);
    int n = wild->nodes = 2 + random_below(random, 8), half = n / 2;
    if (graph == GRAPH_SQUARE) {
        wild_square(wild, 1 + random_below(random, 3));
        return;
    }
    for (int i = 1; i < n; i++) {
        if (graph == GRAPH_CHAIN || graph == GRAPH_RING)
            wild_spring(wild, i - 1, i);
        else if (graph == GRAPH_TREE)
            wild_spring(wild, i, random_below(random, i));
        else if (graph == GRAPH_STAR)
            wild_spring(wild, 0, i);
        else if (graph == GRAPH_TWO_PARTS && i != half)
            wild_spring(wild, i, i < half ? 0 : half);
    }
    if (graph == GRAPH_RING)
        wild_spring(wild, n - 1, 0);
    for (int i = 0; graph == GRAPH_ANY && i < 2 * n; i++)
        wild_spring(wild, random_below(random, n), random_below(random, n));
    if (wild->springs > 0 && random_below(random, 5) == 0) {
        int s = random_below(random, wild->springs);
        wild_spring(wild, wild->e[2 * s + 1], wild->e[2 * s]);
    }
}

/* Where the nodes are, in units of the size of the scene. */
static void wild_positions(Random *random, Wild *wild, double size)
{
    int n = wild->nodes, shape = random_below(random, 8);
    bool square = n >= 4 && wild->x[0] != 0;
    double stretch = random_logarithmic(random, 0.05, 20);
    for (int i = 0; i < 2 * n; i++) {
        if (!square || shape == 1)
            wild->x[i] = random_uniform(random, -1, 1);
        else if (i % 2 == 0)
            wild->x[i] *= stretch;
        if (shape == 2 && i % 2)
            wild->x[i] = 0; /* on a line */
        if (shape == 3 && random_below(random, 3) == 0)
            wild->x[i] = wild->x[i % 2]; /* coincident */
        if (shape == 4)
            wild->x[i] = 0; /* all in one point */
    }
    double away = shape == 5 ? random_logarithmic(random, 1, 1e7) : 0;
    for (int i = 0; i < 2 * n; i++)
        wild->x[i] = (wild->x[i] + away) * size;
}

/* Masses and springs over the given powers of ten. */
static void wild_material(Random *random, Wild *wild, double size)
{
    double mass = random_logarithmic(random, 1e-6, 1e6);
    double k = random_logarithmic(random, 1e-6, 1e12);
    double mass_spread = random_below(random, 3) ? 1 : 1e6;
    double k_spread = random_below(random, 3) ? 1 : 1e9;
    double near = random_below(random, 2) ? 1.5 : 30;
    for (int i = 0; i < wild->nodes; i++)
        wild->m[i] = mass * random_logarithmic(random, 1, mass_spread);
    for (int s = 0; s < wild->springs; s++) {
        const double *xi = wild->x + 2 * wild->e[2 * s];
        const double *xj = wild->x + 2 * wild->e[2 * s + 1];
        double length = hypot(xi[0] - xj[0], xi[1] - xj[1]);
        double rest = (length > 0 ? length : size) *
                      random_logarithmic(random, 1 / near, near);
        wild->l2[s] = rest * rest;
        wild->k[s] = k * random_logarithmic(random, 1, k_spread);
    }
}

/* Time step, velocities and tolerance, in units of the scene most times. */
static void wild_motion(Random *random, Wild *wild, double size)
{
    int n = wild->nodes;
    double k = wild->springs > 0 ? wild->k[0] : 1;
    double period = sqrt(wild->m[0] / k);
    wild->h = random_below(random, 3)
                  ? period * random_logarithmic(random, 1e-3, 1e4)
                  : random_logarithmic(random, 1e-9, 1e3);
    wild->h = fmin(fmax(wild->h, 1e-9), 1e3);
    double speed = size / period * random_logarithmic(random, 1e-6, 10);
    if (random_below(random, 3) == 0)
        speed = 0;
    for (int i = 0; i < 2 * n; i++)
        wild->v[i] = speed * random_uniform(random, -1, 1);
    wild->tolerance =
        size / (period + wild->h) * random_logarithmic(random, 1e-10, 1);
    if (random_below(random, 10) == 0)
        wild->omega2 = random_logarithmic(random, 1e-3, 1e3) /
                       (wild->h * (wild->h + period));
    for (int i = 0; random_below(random, 10) == 0 && i < n; i += 2) {
        wild->pinned[i] = 1;
        wild->v[2 * i] = wild->v[2 * i + 1] = 0;
    }
}

/* As square_scenes.c sets one up. */
static void wild_command_line(Random *random, Wild *wild)
{
    int segments = 1 + random_below(random, 3);
    double side =
        random_below(random, 2) ? 1 : random_logarithmic(random, 1e-3, 1e3);
    double density = random_logarithmic(random, 1e-9, 1e6);
    double k = random_logarithmic(random, 1e-3, 1e15);
    double stretch = random_below(random, 8)
                         ? random_logarithmic(random, 0.01, 30)
                         : random_below(random, 3) - 1;
    wild_square(wild, segments);
    for (int s = 0; s < wild->springs; s++) {
        const double *xi = wild->x + 2 * wild->e[2 * s];
        const double *xj = wild->x + 2 * wild->e[2 * s + 1];
        double dx = side * (xi[0] - xj[0]), dy = side * (xi[1] - xj[1]);
        wild->l2[s] = dx * dx + dy * dy;
        wild->k[s] = k;
    }
    for (int i = 0; i < wild->nodes; i++) {
        wild->m[i] = density * side * side / wild->nodes;
        wild->x[2 * i] *= side * stretch;
        wild->x[2 * i + 1] *= side;
    }
    wild->h = random_logarithmic(random, 1e-6, 1e6);
    wild->tolerance =
        random_below(random, 2) ? 1e-2 : random_logarithmic(random, 1e-9, 1e3);
}

void wild_create(uint64_t seed, long number, Wild *wild)
{
    Random random = {seed * 0x9e3779b97f4a7c15u + (uint64_t)number};
    random_uniform(&random, 0, 1);
    *wild = (Wild){.max_iterations = 10000};
    if (number >= WILD_SQUARES) {
        wild_command_line(&random, wild);
        wild->steps = 1 + random_below(&random, 4);
        wild->method = random_row(&random);
        wild->solver = (Solver)random_below(&random, SOLVER_COUNT);
        if (random_below(&random, 2))
            wild->filter = (Filter)random_below(&random, FILTER_COUNT);
        return;
    }
    double size = random_logarithmic(&random, 1e-3, 1e3);
    wild_graph(&random, wild);
    wild_positions(&random, wild, size);
    wild_material(&random, wild, size);
    wild_motion(&random, wild, size);
    wild->steps = 1 + random_below(&random, 3);
    wild->method = random_row(&random);
    wild->solver = (Solver)random_below(&random, SOLVER_COUNT);
    if (random_below(&random, 20) == 0)
        wild->max_iterations = 1 + random_below(&random, 5);
    if (random_below(&random, 2))
        wild->filter = (Filter)random_below(&random, FILTER_COUNT);
}

/* The same in the arrays of the core. */
/* n where the springs are those of a square of n x n cells, else 0. */
static int square_of(const Wild *wild)
{
    for (int n = 1; (n + 1) * (n + 1) <= WILD_NODES; n++) {
        SquareMesh mesh;
        bool same = wild->nodes == (n + 1) * (n + 1) &&
                    square_mesh_create(n, n, 1, &mesh) == STATUS_OK;
        if (!same)
            continue;
        same = wild->springs == mesh.springs &&
               memcmp(wild->e, mesh.e,
                      2 * (size_t)mesh.springs * sizeof *mesh.e) == 0;
        square_mesh_free(&mesh);
        if (same)
            return n;
    }
    return 0;
}

static Status wild_system(const Wild *wild, System *system)
{
    Status status = system_create(wild->nodes, wild->springs, system);
    bool pins = false;
    for (int i = 0; i < wild->nodes; i++)
        pins = pins || wild->pinned[i];
    if (!status && pins)
        status = system_create_pins(system);
    if (status)
        return status;
    size_t springs = (size_t)wild->springs, nodes = (size_t)wild->nodes;
    memcpy(system->m, wild->m, nodes * sizeof *wild->m);
    if (pins)
        memcpy(system->pinned, wild->pinned, nodes);
    if (springs > 0) {
        memcpy(system->e, wild->e, 2 * springs * sizeof *wild->e);
        memcpy(system->l2, wild->l2, springs * sizeof *wild->l2);
        memcpy(system->k, wild->k, springs * sizeof *wild->k);
    }
    system->segments = square_of(wild);
    central_field_set(system, wild->omega2);
    return STATUS_OK;
}

void tally_add(const Watch *watch, Tally *tally)
{
    for (int i = 0; i < VERDICTS; i++)
        tally->steps[i] += watch->steps[i];
    tally->judged += watch->judged;
    tally->blurred += watch->blurred;
    tally->worst = fmax(tally->worst, watch->worst);
}

Verdict wild_run(const Wild *wild, Tally *tally, char *reason)
{
    System system;
    TimeIntegrator run = {0};
    Watch watch = {0};
    NewtonSettings settings = {.h = wild->h,
                               .tolerance = wild->tolerance,
                               .solver = wild->solver,
                               .filter = wild->filter,
                               .max_iterations = wild->max_iterations};
    Verdict worst = VERDICT_WRONG;
    Status status = wild_system(wild, &system);
    if (!status)
        status =
            time_integrator_create(integrator_methods + wild->method, &system,
                                   &settings, wild->x, wild->v, &run);
    if (status) {
        snprintf(reason, 512, "refused: %s", status_name(status));
    } else if (watch_create(&run, &watch)) {
        worst = VERDICT_CONVERGED;
        for (int step = 0; step < wild->steps; step++) {
            Verdict verdict = watch_step(&watch);
            tally->statuses[watch.status]++;
            worst = verdict > worst ? verdict : worst;
            if (verdict == VERDICT_WRONG)
                memcpy(reason, watch.reason, sizeof watch.reason);
        }
        tally_add(&watch, tally);
    }
    tally->cases++;
    tally->wrong += worst == VERDICT_WRONG;
    watch_free(&watch);
    time_integrator_free(&run);
    system_free(&system);
    return worst;
}

/* Without spring s. */
static void drop_spring(Wild *wild, int s)
{
    int last = --wild->springs;
    wild->e[2 * s] = wild->e[2 * last];
    wild->e[2 * s + 1] = wild->e[2 * last + 1];
    wild->l2[s] = wild->l2[last];
    wild->k[s] = wild->k[last];
}

/* Without node i and its springs; the last node takes its number. */
static void drop_node(Wild *wild, int i)
{
    int last = --wild->nodes;
    for (int s = wild->springs - 1; s >= 0; s--)
        if (wild->e[2 * s] == i || wild->e[2 * s + 1] == i)
            drop_spring(wild, s);
    for (int s = 0; s < 2 * wild->springs; s++)
        if (wild->e[s] == last)
            wild->e[s] = i;
    wild->m[i] = wild->m[last];
    wild->pinned[i] = wild->pinned[last];
    for (int c = 0; c < 2; c++) {
        wild->x[2 * i + c] = wild->x[2 * last + c];
        wild->v[2 * i + c] = wild->v[2 * last + c];
    }
}

/* To so many significant digits; 0 digits: 0 or 1. */
static double rounder(double value, int digits, double plain)
{
    char text[40];
    if (digits == 0)
        return plain;
    snprintf(text, sizeof text, "%.*e", digits - 1, value);
    return strtod(text, NULL);
}

/* Number `which` of all the numbers of a scene, or NULL; plain: what it may
 * become first. */
static double *wild_number(Wild *wild, int which, double *plain)
{
    int n = wild->nodes, springs = wild->springs;
    *plain = 0;
    if (which < 2 * n)
        return wild->v + which;
    if ((which -= 2 * n) < 2 * n)
        return wild->x + which;
    *plain = 1;
    if ((which -= 2 * n) < n)
        return wild->m + which;
    if ((which -= n) < springs)
        return wild->k + which;
    if ((which -= springs) < springs)
        return wild->l2 + which;
    which -= springs;
    if (which == 2)
        *plain = 0;
    return which == 0   ? &wild->h
           : which == 1 ? &wild->tolerance
           : which == 2 ? &wild->omega2
                        : NULL;
}

/* Keeps a change if the scene still fails. */
static bool keep_if(Wild *wild, const Wild *changed,
                    bool (*fails)(const Wild *, void *), void *user)
{
    if (memcmp(wild, changed, sizeof *wild) == 0 || !fails(changed, user))
        return false;
    *wild = *changed;
    return true;
}

/* Fewer steps, springs and nodes; no pins; the plainest method. */
static bool shrink_parts(Wild *wild, bool (*fails)(const Wild *, void *),
                         void *user)
{
    bool any = false;
    Wild changed;
    for (int s = wild->springs - 1; s >= 0; s--) {
        changed = *wild;
        drop_spring(&changed, s);
        any = keep_if(wild, &changed, fails, user) || any;
    }
    for (int i = wild->nodes - 1; i >= 0 && wild->nodes > 1; i--) {
        changed = *wild;
        drop_node(&changed, i);
        any = keep_if(wild, &changed, fails, user) || any;
    }
    for (int i = 0; i < wild->nodes; i++) {
        changed = *wild;
        changed.pinned[i] = 0;
        any = keep_if(wild, &changed, fails, user) || any;
    }
    changed = *wild;
    changed.method = 0;
    any = keep_if(wild, &changed, fails, user) || any;
    changed = *wild;
    changed.solver = SOLVER_NEWTON;
    any = keep_if(wild, &changed, fails, user) || any;
    changed = *wild;
    changed.filter = FILTER_CLAMP;
    any = keep_if(wild, &changed, fails, user) || any;
    changed = *wild;
    changed.steps = wild->steps > 1 ? wild->steps - 1 : 1;
    return keep_if(wild, &changed, fails, user) || any;
}

void wild_shrink(Wild *wild, bool (*fails)(const Wild *, void *), void *user)
{
    for (int round = 0; round < 10; round++)
        if (!shrink_parts(wild, fails, user))
            break;
    for (int digits = 0; digits <= 4; digits++) {
        double plain;
        for (int i = 0; wild_number(wild, i, &plain); i++) {
            Wild changed = *wild;
            double *number = wild_number(&changed, i, &plain);
            if (*number == plain)
                continue;
            *number = rounder(*number, digits, plain);
            keep_if(wild, &changed, fails, user);
        }
    }
    shrink_parts(wild, fails, user);
}

void wild_print(const Wild *wild)
{
    printf(
        "%s, %s, %s, h %.17g s, tolerance %.17g m/s, omega2 %.17g, %d steps, "
        "at most %d iterations\n",
        integrator_methods[wild->method].name, solver_name(wild->solver),
        filter_name(wild->filter), wild->h, wild->tolerance, wild->omega2,
        wild->steps, wild->max_iterations);
    for (int i = 0; i < wild->nodes; i++)
        printf("node %d: m %.17g, x %.17g %.17g, v %.17g %.17g%s\n", i,
               wild->m[i], wild->x[2 * i], wild->x[2 * i + 1], wild->v[2 * i],
               wild->v[2 * i + 1], wild->pinned[i] ? ", pinned" : "");
    for (int s = 0; s < wild->springs; s++)
        printf("spring %d-%d: l2 %.17g, k %.17g\n", wild->e[2 * s],
               wild->e[2 * s + 1], wild->l2[s], wild->k[s]);
}
