/* Every number on the screen is a true one.  What the texts of the pictures
 * know by name (facts.h) is calculated again, in extended precision and by
 * formulas that stand here or in the oracle; and every number that a frame
 * writes beside them is one of these.  (Its digits and numbers at axes are held
 * by test_picture, messages by test_player, a page's words by test_pages, what
 * plasticity, fracture and friction took by test_laws.) */
#include "attended.h"
#include "stress.h"
#include "test.h"

#include <math.h>

#include "model/fracture.h"
#include "model/friction.h"
#include "model/mass_spring_energy.h"
#include "model/neo_hookean.h"
#include "model/plasticity.h"
#include "picture/cards.h"

enum { WIDE = 1200, HIGH = 900, MOST = 400, UNKNOWNS = 50, NODES = 700 };

/* ---- what is true -------------------------------------------------------- */

typedef struct Truth {
    char name[24];
    int run;
    Real value, slack;
} Truth;

static int faults;

static void wrong(const char *name, const char *what, double value)
{
    print_error("%s, step %ld: '%s' says %.12g\n", name, player.past.step, what,
                value);
    faults++;
}

static Truth truth[MOST];
static int truths, run_now;

static bool is_true(const char *name, int run, double value);

/* All numbers of a frame that are no facts go through these. */
static const char *listens;
static Paper paper;
Number __real_number_with(double value, int digits);
Number __real_number_of(double value);
Number __wrap_number_with(double value, int digits);
Number __wrap_number_of(double value);
Plot __real_plot_create(const Plot *card, Axis x, Axis y);
Plot __real_plot_on(const Plot *stage, Axis x, Axis y);
Plot __wrap_plot_create(const Plot *card, Axis x, Axis y);
Plot __wrap_plot_on(const Plot *stage, Axis x, Axis y);

Number __wrap_number_with(double value, int digits)
{
    Number number = __real_number_with(value, digits);
    if (listens && !is_true(NULL, 0, value))
        wrong(listens, number.text, value);
    return number;
}

Number __wrap_number_of(double value)
{
    return __wrap_number_with(value, 3);
}

/* Those of axes are another test's. */
Plot __wrap_plot_create(const Plot *card, Axis x, Axis y)
{
    const char *before = listens;
    listens = NULL;
    Plot plot = __real_plot_create(card, x, y);
    listens = before;
    return plot;
}

Plot __wrap_plot_on(const Plot *stage, Axis x, Axis y)
{
    const char *before = listens;
    listens = NULL;
    Plot plot = __real_plot_on(stage, x, y);
    listens = before;
    return plot;
}

static void near(const char *name, Real value, Real slack)
{
    assert_true(truths < MOST);
    Truth *one = &truth[truths++];
    *one = (Truth){.run = run_now, .value = value, .slack = slack};
    snprintf(one->name, sizeof one->name, "%s", name);
}

/* A symmetric matrix, xx, xy, yy: "Hxx", "Hxy", "Hyy". */
static void near_matrix(char letter, const Real H[3], Real slack)
{
    for (int i = 0; i < 3; i++)
        near((const char[]){letter, "xxy"[i], "xyy"[i], 0}, H[i], slack);
}

static void is(const char *name, Real value)
{
    near(name, value, 1e-12L * fabsl(value));
}

static void is_point(const char *name, Real x, Real y)
{
    Real slack = 1e-12L * (fabsl(x) + fabsl(y));
    near(name, x, slack);
    near(name, y, slack);
}

/* The two last states, and with what the step between them was made; without h
 * nothing is known of it. */
static double x_n[2 * NODES], v_n[2 * NODES], x_now[2 * NODES],
    v_now[2 * NODES];
static Options made;
static int terms_made;
static long step_now;

static void remember(void)
{
    const Simulation *simulation = &machine(0)->simulation;
    size_t size = 2 * (size_t)simulation->system.nodes * sizeof(double);
    assert_true(simulation->system.nodes <= NODES);
    if (!simulation->run[0].x)
        return;
    if (player.past.step == step_now + 1) {
        memcpy(x_n, x_now, size);
        memcpy(v_n, v_now, size);
        made = simulation->options;
        terms_made = simulation->system.terms;
    } else if (player.past.step != step_now) {
        made.timestep = 0;
    } else if (memcmp(x_now, simulation->run[0].x, size) != 0) {
        made = simulation->options; /* it was taken again */
        terms_made = simulation->system.terms;
    }
    step_now = player.past.step;
    memcpy(x_now, simulation->run[0].x, size);
    memcpy(v_now, simulation->run[0].v, size);
}

/* ---- a step in time ------------------------------------------------------ */

static bool only_springs(const Simulation *simulation)
{
    const System *system = &simulation->system;
    const IntegratorMethod *method = simulation->run[0].method;
    Filter filter = simulation->options.filter;
    return system->terms == 1 && terms_made == 1 && made.timestep > 0 &&
           made.stiffness == simulation->options.stiffness &&
           made.filter == filter && system_is_free(system) &&
           system->nodes <= 25 &&
           system_find_term(system, &mass_spring_energy) && method &&
           strcmp(method->name, "backward-euler") == 0 &&
           system->gravity[1] == 0 &&
           (filter == FILTER_CLAMP || filter == FILTER_NONE);
}

/* E along p from where it is, at x_tilde, and after each update. */
static void tell_values(const Trace *trace, Spot *spot, const double *u_tilde,
                        Real before)
{
    for (int t = 1; spot->p && (t <= trace->trials || t == 1); t++) {
        spot->alpha = trace_alpha(trace, t);
        Real change = oracle_step(spot, u_tilde).f - before;
        near("trial", change, 1e-6L * fabsl(change) + 1e-14L * before);
    }
    for (int i = trace->iteration - 1; i >= 0; i--)
        before -= trace->record[i].change;
    for (int i = 0; i <= trace->updates; i++) {
        near("value", before, 1e-6L * before);
        before += i < trace->updates ? trace->record[i].change : 0;
    }
    Place aim = place_at(spot->at->system, x_n, u_tilde, trace->x_tilde);
    aim.w = spot->at->w;
    Spot there = {.at = &aim, .h = spot->h};
    near("value", oracle_step(&there, u_tilde).f, 1e-12L * before);
}

/* E where the step begins, at line 1. */
static void tell_start(const System *system, const Trace *trace)
{
    double none[UNKNOWNS] = {0}, u_tilde[UNKNOWNS];
    for (int i = 0; i < 2 * system->nodes; i++)
        u_tilde[i] = made.timestep * v_n[i];
    Place at = place_at(system, x_n, none, x_n);
    at.w = made.timestep * made.timestep;
    Spot spot = {.at = &at, .h = made.timestep};
    tell_values(trace, &spot, u_tilde, oracle_step(&spot, u_tilde).f);
}

/* The minimisation of the step that led here: where its trace stands. */
static void tell_springs(const Simulation *simulation, const Trace *trace)
{
    const System *system = &simulation->system;
    bool over = trace->line == LINE_NONE || trace->line == LINE_END;
    const double *x = over && !trace->given_up ? x_now : trace->x;
    double u[UNKNOWNS] = {0}, u_tilde[UNKNOWNS], q[UNKNOWNS];
    Real p[UNKNOWNS], g[UNKNOWNS], slope = 0;
    int size = 2 * system->nodes, least = 0, most = 0;
    const IncrementalPotential E = {.system = system,
                                    .weight = made.timestep * made.timestep,
                                    .x_n = x_n,
                                    .u_tilde = u_tilde};
    for (int i = 0; i < size; i++) {
        u_tilde[i] = made.timestep * v_n[i];
        u[i] = x[i] - x_n[i];
    }
    Filter filter = simulation->options.filter;
    Real residual = wide_direction(&E, u, filter, made.timestep, p);
    near("residual", residual, 1e-6L * residual + 1e-12L);
    near("p size", residual * made.timestep,
         1e-6L * residual * made.timestep + 1e-14L);
    for (int i = 0; i < size; i++)
        u[i] = trace->x[i] - x_n[i];
    wide_direction(&E, u, filter, made.timestep, p);
    exact_derivatives(&E, u, trace->x, g, NULL);
    for (int i = 0; i < size; i++) {
        q[i] = (double)p[i];
        slope += g[i] * p[i];
    }
    for (int i = 0; i < size && trace->p; i++)
        CHECK_NEAR(trace->p[i], p[i], 1e-6L * (residual + fabsl(slope)));
    CHECK(!trace->p || (slope > 0) == (trace->slope > 0));
    for (int s = 0; s < system->springs; s++) {
        Real pair = exact_strain(system, trace->x, s);
        least += pair < -1e-9L;
        most += pair < 1e-9L;
    }
    if (simulation->options.filter == FILTER_NONE)
        least = most = 0;
    near("projected", (least + most) / 2.0L, (most - least) / 2.0L);
    Place at = place_at(system, x_n, u, trace->x);
    at.w = E.weight;
    Spot spot = {.at = &at, .h = made.timestep};
    Real before = oracle_step(&spot, u_tilde).f;
    spot.p = q;
    spot.alpha = trace_alpha(trace, trace->trials);
    Real change = oracle_step(&spot, u_tilde).f - before;
    near("change", change, 1e-6L * fabsl(change) + 1e-14L * before);
    if (trace->trials > 0 &&
        simulation->options.line_search != LINE_SEARCH_NONE)
        CHECK(fabsl(change) < 1e-14L * before || /* rounding */
              (change > 0) == !trace->accepted);
    tell_values(trace, &spot, u_tilde, before);
}

/* What the slides' program prints; test_reference has its own lists. */
static void tell_prints(const Trace *trace)
{
    for (int i = 0; i < trace->updates; i++) {
        is("Iteration", i);
        is("printed", trace->record[i].residual);
        is("printed", trace->record[i].alpha);
        is("printed", trace->record[i].change);
        if (i > 0)
            is("factor",
               trace->record[i - 1].residual / trace->record[i].residual);
    }
}

static void tell_trace(const Simulation *simulation, const Trace *trace)
{
    is("tolerance", simulation->options.tolerance);
    is("h then", trace->h);
    tell_prints(trace);
    CHECK(made.timestep == 0 || trace->h == made.timestep);
    for (int i = -9; i <= 9 && (trace->p || player.show.panes > 1); i++)
        is("search direction", powl(10, i));
    is("nth", trace->iteration + 1);
    is("length", powl(2, 1 - fmaxl(trace->trials, 1)) *
                     (trace->first > 0 ? trace->first : 1));
    Real risen = 0;
    for (int i = 0; i < trace->updates; i++)
        risen += trace->record[i].change;
    is("risen", risen);
    if (only_springs(simulation) && trace->x) {
        tell_springs(simulation, trace);
        return;
    }
    if (only_springs(simulation) && trace->x_tilde)
        tell_start(&simulation->system, trace);
    is("projected", trace->projected);
    is("residual", trace->residual);
    is("p size", (Real)trace->residual * trace->h);
    if (trace->difference && trace->trials > 0)
        is("change", trace->difference(trace->function,
                                       trace_alpha(trace, trace->trials)));
}

/* ---- energies ------------------------------------------------------------ */

/* The ledger's: what the terms hold is test_laws' matter, what masses do that
 * of check_tables. */
static void tell_energies(const Simulation *simulation)
{
    static const char *const stored[] = {"kinetic", "elastic", "gravity",
                                         "contact", "hand"};
    Energies ledger = simulation_energies(simulation, 0);
    Real size = fabsl(ledger.kinetic) + fabsl(ledger.gravity) + ledger.total;
    for (int i = 0; i < 5; i++) /* what is rounding is shown as 0 */
        near(stored[i], energies_of(&ledger, stored[i]), 1e-13L * size);
    for (int i = 0; i < ledger.rows; i++)
        is(ledger.row[i].name, ledger.row[i].value);
}

/* ---- what pages say of the square ---------------------------------------- */

/* The triangle with the smallest area over its area at rest, or with less, and
 * its energy over that area. */
static Real flattest(const Simulation *simulation, Real *energy)
{
    const NeoHookean *solid = solid_of(&simulation->system);
    Real least = INFINITY, nu = simulation->options.poisson;
    Real mu = simulation->options.young / (2 * (1 + nu));
    Real lambda = 2 * mu * nu / (1 - 2 * nu);
    for (int t = 0; t < solid->triangles; t++) {
        Real F[4] = {0}, F2 = 0;
        const double *x = simulation->run[0].x;
        const int *node = solid->node[t];
        for (int k = 0; k < 4; k++)
            F[k] = ((Real)x[2 * node[1 + k / 2] + k % 2] -
                    x[2 * node[0] + k % 2]) /
                   sqrtl(2 * (Real)solid->area);
        for (int k = 0; k < 4; k++)
            F2 += F[k] * F[k];
        Real J = F[0] * F[3] - F[1] * F[2];
        if (J > least - 1e-13L)
            continue;
        least = J;
        *energy =
            mu / 2 * (F2 - 2) - mu * logl(J) + lambda / 2 * powl(logl(J), 2);
    }
    return least;
}

/* The strain of the spring that flowed most, or the part of its strength of the
 * one nearest to breaking; its force in the same unit, its plastic strain. */
static Real most_loaded(const System *system, const double *x,
                        const Plasticity *flow, Real *force, Real *rest)
{
    Real most = -1, at = NAN;
    for (int i = 0; i < system->springs; i++) {
        Real strain = exact_strain(system, x, i), ep = flow ? flow->ep[i] : 0;
        Real load =
            flow
                ? fabsl(ep) + 1e-3L * fabsl(strain)
                : strain / fracture_strength(system_data(system, &fracture), i);
        if (system->k[i] == 0 || load <= most)
            continue;
        most = load;
        at = flow ? strain : load;
        *force = flow ? strain - ep : load;
        *rest = ep;
    }
    return at;
}

/* Where the scene is on the law that its page draws. */
static void tell_law(const Simulation *simulation)
{
    const System *system = &simulation->system;
    const Options *o = &simulation->options;
    const char *law = o->page->law ? o->page->law : "";
    const double *x = simulation->run[0].x;
    const Plasticity *flow = system_data(system, &plastic_energy);
    Real at = INFINITY, value = 0, slip = 0, s, rest = 0;
    Real reach = o->barrier[0] > 0 ? o->barrier[0] : o->side / 100;
    Real kappa = o->barrier[1] > 0 ? o->barrier[1] : 4 * o->stiffness;
    Real c = o->side / o->segments * reach * kappa / 2;
    if (strcmp(law, "barrier") == 0) {
        const Contact *contact = contact_of(system);
        for (int k = 0; k < contact->obstacles * system->nodes; k++)
            at = fminl(
                at, exact_gap(system, x, k % system->nodes, k / system->nodes));
        s = at / reach;
        value = c * (s - 1) * logl(s);
        near("gap", 1e3L * at, 1e-10L);
        /* by differences over a ten thousandth of d to either side */
        near("law force", c / reach * (1 / s - 1 - logl(s)), 1e-2L);
    } else if (strcmp(law, "near") == 0) {
        at = exact_nearest(simulation, reach, &slip);
        near("gap", 1e3L * at, 1e-10L);
        s = powl(at / reach, 2);
        c /= 8;
        value = c * (s - 1) * logl(s);
        near("law force", 2 * c * at / reach / reach * (1 / s - 1 - logl(s)),
             1e-2L);
    } else if (strcmp(law, "rub") == 0) {
        near("gap", 1e3L * exact_nearest(simulation, reach, &at), 1e-10L);
        Real gone = 0; /* the upper block, whose nodes come last */
        for (int i = system->nodes; i < 2 * system->nodes; i += 2)
            gone += ((Real)x[i] - o->body[1][0]) / (system->nodes / 2);
        near("gone", gone, 1e-9L);
        near("rigid", 1 / (2 * 9.81L * o->friction), 1e-12L);
        s = fminl(at / o->slip_speed, 1);
        value = s * (2 - s);
    } else if (strcmp(law, "triangle") == 0) {
        at = flattest(simulation, &value);
    }
    if (strcmp(law, flow ? "yield" : "break") == 0)
        at = most_loaded(system, x, flow, &value, &rest);
    near("s_p", rest, 0);
    near("c", c, 1e-10L);
    near("d hat", 1e3L * reach, 1e-10L);
    near("law mm", 1e3L * at, 1e-10L);
    near("law x", at, 1e-12L * (1 + fabsl(at)));
    near("law y", value, 1e-10L * (1 + fabsl(value)));
}

/* What a stretched spring adds to the Hessian of E, kg, by P'' of its length
 * and P' over it; and where. */
static void tell_block(const Simulation *simulation, int spring)
{
    static const char *const rows[] = {"row 1", "row 2", "row 3", "row 4"};
    const System *system = &simulation->system;
    const int *e = system->e + 2 * spring;
    const double *x = simulation->run[0].x;
    Real d[2], k = system->k[spring], l2 = system->l2[spring];
    for (int c = 0; c < 2; c++)
        d[c] = (Real)x[2 * e[0] + c] - x[2 * e[1] + c];
    Real r2 = d[0] * d[0] + d[1] * d[1];
    Real across = fmaxl(0, 2 * k * (r2 / l2 - 1));
    Real along = fmaxl(0, 2 * k * (3 * r2 / l2 - 1));
    Real h = simulation->options.timestep, H[3];
    for (int i = 0; i < 3; i++) {
        Real part = d[i / 2] * d[(i + 1) / 2] / r2;
        H[i] = h * h * (part * along + ((i != 1) - part) * across);
    }
    near_matrix('B', H, 1e-12L * h * h * k);
    for (int i = 0; i < 4; i++)
        is(rows[i], 2 * e[i / 2] + i % 2);
}

static void tell_fastest(Real omega, Real h)
{
    Real half = omega * h / 2, grows = expl(2 * acoshl(half));
    near("fastest", omega, 1e-4L * omega);
    near("h limit", 2 / omega, 2e-4L / omega);
    near("h omega", 2 * half, 2e-4L * half);
    near("short h omega", 2 * half, 2e-4L * half);
    /* its slope, times the slack above */
    near("growth", grows, 2e-4L * grows * half / sqrtl(half * half - 1));
}

/* -g, of all nodes and of the last one. */
static void tell_forces(const System *system, const Real *g)
{
    int balanced = 0, size = 2 * system->nodes;
    for (int i = 0; i < size; i += 2)
        balanced += hypotl(g[i], g[i + 1]) < 1e-8L;
    is("balanced", balanced);
    for (int i = size - 2; i < size; i++) {
        near("f", -g[i], 1e-9L * (1 + fabsl(g[i])));
        near("a", -g[i] / system->m[i / 2], 1e-11L * (1 + fabsl(g[i])));
    }
}

/* Its mesh, its fastest oscillation, and the force on its last node. */
static void tell_page(const Simulation *simulation)
{
    static Real H[UNKNOWNS * UNKNOWNS], v[UNKNOWNS * UNKNOWNS];
    const System *system = &simulation->system;
    const Options *o = &simulation->options;
    const double *x = simulation->run[0].x;
    int size = 2 * system->nodes, shorter = 0;
    Real n = o->segments, nodes = (n + 1) * (n + 1), top = 0, g[UNKNOWNS];
    Real side = simulation->mesh.side;
    Real mass = o->density * side * side;
    const IncrementalPotential E = {.system = system, .weight = 1, .x_n = x};
    tell_law(simulation);
    for (int s = 0; s < system->springs; s++)
        shorter += exact_strain(system, x, s) < -1e-9L;
    if (o->bodies > 0 || o->scene->create != scene_find("square")->create)
        nodes = system->nodes;
    is("masses", nodes);
    near("mass", system->nodes * (Real)system->m[0], 1e-9L * mass);
    is("node mass", system->m[0]);
    is("places", 4 * (nodes + 2 * (Real)system->springs));
    is("short", shorter);
    int newest = (int)(simulation->steps % system->springs);
    is("newest", newest);
    is("from", system->e[2 * newest]);
    is("to", system->e[2 * newest + 1]);
    tell_block(simulation, newest);
    is("segments", n);
    is("side", side);
    is("rho", o->density);
    is("k", o->stiffness);
    is("stretch", o->stretch);
    is("h", o->timestep);
    is("epsilon", o->tolerance);
    is("last", system->nodes - 1);
    if (size > UNKNOWNS)
        return;
    exact_derivatives(&E, NULL, x, g, H);
    tell_forces(system, g);
    if (!o->page->modes)
        return;
    exact_derivatives(&E, NULL, rest_of(simulation), g, H);
    for (int i = 0; i < size * size; i++) /* masses are equal */
        H[i] /= system->m[0];
    exact_eigen(size, H, v);
    for (int i = 0; i < size; i++)
        top = fmaxl(top, H[i * size + i]);
    tell_fastest(sqrtl(top), o->timestep);
}

/* ---- one mass, one spring ------------------------------------------------ */

/* A step on the circle as a matrix: where it leads from (1, 0) and (0, 1), by
 * the old velocity or the new one; its eigenvalues by trace and determinant. */
static void tell_matrix(Real turn, bool backward, bool by_old)
{
    static const char *const names[] = {"Sxx", "Sxv", "Svx", "Svv"};
    Real S[4];
    for (int k = 0; k < 2; k++) {
        Real d = backward ? 1 + turn * turn : 1, at = k == 0, w = k == 1;
        S[2 + k] = (w - turn * at) / d;
        S[k] = at + turn * (by_old ? w : S[2 + k]);
    }
    for (int k = 0; k < 4; k++)
        near(names[k], S[k], 1e-15L);
    Real half = (S[0] + S[3]) / 2, det = S[0] * S[3] - S[1] * S[2];
    Real root = sqrtl(fabsl(half * half - det));
    near("re", half, 1e-15L);
    near("im", root, 1e-7L);
    near("least", half - root, 1e-7L);
    near("most", half + root, 1e-7L);
    near("size", sqrtl(det), 1e-15L); /* of a pair */
}

static void tell_masses(const Simulation *simulation)
{
    bool one = simulation->runs == 1;
    for (int r = 0; r < simulation->runs; r++) {
        const TimeIntegrator *run = &simulation->run[r];
        const char *name = run->method->name;
        const double *x = run->x, *v = run->v;
        Real h = simulation->options.timestep, a[2], new_x[2], new_v[2];
        Real E[2] = {0, 0}, by[2];
        bool backward = strcmp(name, "backward-euler") == 0;
        for (int i = 0; i < 2; i++) {
            new_v[i] =
                backward ? (v[i] - h * x[i]) / (1 + h * h) : v[i] - h * x[i];
            by[i] = strcmp(name, "forward-euler") == 0 ? v[i] : new_v[i];
            new_x[i] = x[i] + h * by[i];
            a[i] = backward ? -new_x[i] : -x[i];
            E[0] += ((Real)x[i] * x[i] + (Real)v[i] * v[i]) / 2;
            E[1] += (new_x[i] * new_x[i] + new_v[i] * new_v[i]) / 2;
        }
        run_now = r + 1;
        is("radius", hypotl(x[0], x[1]));
        run_now = one ? 0 : r + 1;
        is("energy", E[0]);
        is("later", E[1]);
        is("factor", E[1] / E[0]);
        is_point("place", x[0], x[1]);
        is_point("v", v[0], v[1]);
        is_point("a", a[0], a[1]);
        is_point("x'", new_x[0], new_x[1]);
        is_point("v'", new_v[0], new_v[1]);
        is_point("carrying", by[0], by[1]);
        run_now = 0;
        is("h", h);
        if (one) {
            Real off[2];
            for (int i = 0; i < 2; i++)
                off[i] = new_x[i] - cosl(h) * x[i] - sinl(h) * v[i];
            near("miss", hypotl(off[0], off[1]), 1e-15L * (1 + h));
            is("half", h * h / 2 * hypotl(x[0], x[1]));
            for (int i = 0; i < 2; i++)
                off[i] =
                    (1 - cosl(h / 2)) * x[i] + (h / 2 - sinl(h / 2)) * v[i];
            near("half miss", hypotl(off[0], off[1]), 1e-15L * (1 + h));
            Real kept = 2 * E[0] - h * (x[0] * v[0] + x[1] * v[1]);
            near("kept", kept, 4e-15L * (E[0] + E[1]));
            near("kept later", kept, 4e-15L * (E[0] + E[1]));
            is("h limit", 2); /* cos(turn) = 1 - h^2/2 is above -1 */
        }
        Real turn = 8 * atanl(1) * h;
        is("doubling", ceill(logl(4) / logl(1 + turn * turn)));
        run_now = r + 1;
        tell_matrix(turn, backward, by[0] == v[0]);
        run_now = 0;
    }
}

static void tell_spring(const Simulation *simulation)
{
    Real l = 1, k = simulation->system.k[0]; /* small_scenes.h */
    Real x = simulation->run[0].x[0], y = simulation->run[0].x[1];
    Real r = hypotl(x, y), s = r * r / (l * l) - 1;
    Real high = 2 * k * (3 * r * r / (l * l) - 1), low = 2 * k * s;
    is_point("d", x, y);
    is("distance", r);
    is("l", l);
    is("l2", l * l);
    is("k", k);
    near("strain", s, 1e-15L);
    near("energy", l * l * k / 2 * s * s, 1e-15L * k);
    near("force", -2 * k * s * x, 1e-15L * k);
    near("force", -2 * k * s * y, 1e-15L * k);
    near("along", high, 1e-14L * k);
    near("across", low, 1e-14L * k);
    Real up = fmaxl(high, 0) / (r * r), flat = fmaxl(low, 0) / (r * r);
    const Real H[2][3] = {{high - 4 * k * y * y / (l * l),
                           4 * k * x * y / (l * l),
                           high - 4 * k * x * x / (l * l)},
                          {up * x * x + flat * y * y, (up - flat) * x * y,
                           up * y * y + flat * x * x}};
    near_matrix('H', H[0], 1e-12L * k);
    near_matrix('P', H[1], 1e-12L * k);
    /* the third derivatives times 1e-8/6 m^2 */
    near_matrix('D', H[0], 1e-6L * k);
    near("force too", -2 * k * s * x, 1e-6L * k);
    near("force too", -2 * k * s * y, 1e-6L * k);
    is("apart", 0.1L);
    near("root energy", 2 * k * (r - l) * (r - l), 1e-15L * k);
    is("tip", 2 * k * l * l);
    is("root along", 4 * k);
    near("root across", 4 * k * (1 - l / r), 1e-14L * k);
    near("block along", 2 * high, 1e-13L * k);
    near("block across", 2 * low, 1e-13L * k);
    near("projected along", fmaxl(2 * high, 0), 1e-13L * k);
    near("projected across", fmaxl(2 * low, 0), 1e-13L * k);
    near("negative", fminl(0, 2 * fminl(low, high)), 1e-13L * k);
}

/* ---- minima that are searched -------------------------------------------- */

/* E, E' and E'' of one unknown. */
static void scalar_E(const Simulation *simulation, Real x, Real E[3])
{
    Real d = x - simulation->exhibit.target[0], s = x * x - 1;
    Real w =
        10 * (Real)simulation->options.timestep * simulation->options.timestep;
    bool line = simulation->scene->picture == PICTURE_TANGENT;
    E[0] = line ? d * d / 2 + w * s * s / 2
                : fabsl(x) + log1pl(expl(-2 * fabsl(x)));
    E[1] = line ? d + 2 * w * x * s : tanhl(x);
    E[2] = line ? 1 + 2 * w * (3 * x * x - 1) : 1 / (coshl(x) * coshl(x));
}

/* E of the map of small_scenes.h at a point, and the direction with this
 * projection. */
typedef struct MapE {
    Real value, elastic, g[2], H[3], p[2], slope;
    int springs; /* projected ones */
} MapE;

static MapE map_E(const Simulation *simulation, unsigned parts,
                  const Real at[2], Filter filter)
{
    Real h = simulation->run[0].h, w = parts & PART_ELASTICITY ? h * h : 0;
    Real m = parts & PART_INERTIA ? 1 : 0;
    Real k = simulation->system.k[0], l2 = simulation->system.l2[0];
    MapE E = {.H = {m, 0, m}};
    for (int i = 0; i < 2; i++) {
        E.g[i] = m * (at[i] - simulation->exhibit.target[i]);
        E.value += E.g[i] * (at[i] - simulation->exhibit.target[i]) / 2;
    }
    for (int pin = 1; pin <= 2; pin++) {
        const double *o = simulation->run[0].x + 2 * pin;
        Real d[2] = {at[0] - o[0], at[1] - o[1]};
        Real q = d[0] * d[0] + d[1] * d[1], s = q / l2 - 1;
        Real low = 2 * k * s, high = 2 * k * (3 * q / l2 - 1);
        E.springs += low < 0 && w > 0;
        if (filter != FILTER_NONE) {
            low = filter == FILTER_ABS ? fabsl(low) : fmaxl(low, 0);
            high = filter == FILTER_ABS ? fabsl(high) : fmaxl(high, 0);
        }
        E.value += w * l2 * k / 2 * s * s;
        E.elastic += h * h * l2 * k / 2 * s * s;
        for (int i = 0; i < 2; i++)
            E.g[i] += w * 2 * k * s * d[i];
        for (int i = 0; i < 3; i++)
            E.H[i] += w * ((i != 1) * low +
                           (high - low) / q * d[i / 2] * d[(i + 1) / 2]);
    }
    Real det = E.H[0] * E.H[2] - E.H[1] * E.H[1];
    E.p[0] = -(E.H[2] * E.g[0] - E.H[1] * E.g[1]) / det;
    E.p[1] = -(E.H[0] * E.g[1] - E.H[1] * E.g[0]) / det;
    E.slope = E.g[0] * E.p[0] + E.g[1] * E.p[1];
    return E;
}

/* What is minimised, there. */
static Real searched_E(const Simulation *simulation, const Real at[2])
{
    Real E[3];
    if (!simulation->descent.scalar)
        return map_E(simulation, simulation->exhibit.parts, at, FILTER_NONE)
            .value;
    scalar_E(simulation, at[0], E);
    return E[0];
}

/* Where it stands now: what is tested. */
static void tell_iterate(const Simulation *simulation)
{
    static const Filter ways[] = {FILTER_NONE, FILTER_CLAMP};
    const Descent *descent = &simulation->descent;
    Real at[2] = {descent->point[0], descent->point[1]}, E[3];
    scalar_E(simulation, at[0], E);
    if (descent->scalar)
        near("residual", fabsl(E[1]), 1e-13L);
    for (int way = 0; way < 2 && !descent->scalar; way++) {
        MapE map = map_E(simulation, simulation->exhibit.parts, at, ways[way]);
        near("slope", map.slope, 1e-9L * (1 + fabsl(map.slope)));
        near("residual", hypotl(map.g[0], map.g[1]), 1e-13L);
        Real size = fabsl(map.p[0]) + fabsl(map.p[1]);
        near("residual", size / simulation->run[0].h, 1e-12L);
        near("p size", size, 1e-12L);
    }
}

/* What its contours may be of: more with a long step. */
static void tell_contours(const Simulation *simulation)
{
    static const Real levels[] = {0.1L, 0.2L, 0.4L, 0.6L, 1,  1.5L, 2,
                                  3,    5,    7,    10,   15, 30,   50};
    Real h = simulation->run[0].h / 0.2L;
    bool grows = simulation->exhibit.parts != PART_INERTIA && h > 1;
    for (size_t i = 0; i < sizeof levels / sizeof *levels; i++)
        is("contour", levels[i] * (grows ? h * h : 1));
}

/* E at the iterate of the landscape: its parts and derivatives. */
static void tell_landscape(const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    const double *o = simulation->exhibit.target;
    Real at[2] = {descent->point[0], descent->point[1]};
    MapE E = map_E(simulation, simulation->exhibit.parts, at, FILTER_NONE);
    tell_contours(simulation);
    is_point("place", at[0], at[1]);
    is_point("x tilde", o[0], o[1]);
    near("E", E.value, 1e-13L * (1 + E.value));
    near("elastic part", E.elastic, 1e-13L * (1 + E.elastic));
    near("bowl", (powl(at[0] - o[0], 2) + powl(at[1] - o[1], 2)) / 2, 1e-15L);
    MapE own = map_E(simulation, simulation->exhibit.parts, at,
                     (Filter)simulation->options.filter);
    for (int i = 0; i < 2; i++) {
        near("g", E.g[i], 1e-12L);
        near("solution", own.p[i], 1e-12L);
        is("solution", 0); /* where it has ended */
    }
    near_matrix('H', E.H, 1e-12L);
    near("m", 1, 0);
    E = map_E(simulation, PART_BOTH, at, FILTER_CLAMP);
    near_matrix('P', E.H, 1e-12L);
}

/* The last update, or the first one that is to come. */
static void tell_search(const Simulation *simulation)
{
    const Descent *descent = &simulation->descent;
    const Filter filter = simulation->options.filter;
    bool begun = descent->count > 0, scalar = descent->scalar != NULL;
    const NewtonRecord *last = &descent->record[begun ? descent->count - 1 : 0];
    bool whole = simulation->options.line_search == LINE_SEARCH_NONE ||
                 (!begun && scalar);
    const double *from = begun ? last->from : descent->point;
    Real at[2] = {from[0], from[1]}, to[2], p[2] = {0}, E[3];
    Real alpha = 2, value, trial = INFINITY;
    MapE map = {.springs = 0};
    scalar_E(simulation, at[0], E);
    if (!scalar)
        map = map_E(simulation, simulation->exhibit.parts, at, filter);
    p[0] = scalar ? -E[1] / E[2] : map.p[0];
    p[1] = map.p[1];
    value = searched_E(simulation, at);
    do {
        alpha /= 2;
        for (int i = 0; i < 2; i++)
            to[i] = at[i] + alpha * p[i];
        trial = searched_E(simulation, to);
    } while (trial > value && alpha > 1e-20L && !whole);
    if (begun && last->alpha > 0) /* and there it is now */
        CHECK_NEAR(to[0], descent->point[0], 1e-9L * (1 + fabsl(to[0])));
    is("length", begun && last->alpha > 0 ? alpha : 1);
    is("shorter", alpha);
    near("change", trial - value, 1e-6L * fabsl(trial - value) + 1e-15L);
    is("tolerance", simulation->options.tolerance);
    is("h then", simulation->options.timestep);
    is("nth", descent->count + 1);
    is("projected", filter == FILTER_NONE ? 0 : map.springs);
    is("number", begun ? descent->count - 1 : 0);
    is("next number", begun ? descent->count : 1);
    is("iterate", at[0]);
    near("next", to[0], 1e-9L * (1 + fabsl(to[0])));
    near("direction", p[0], 1e-9L * fabsl(p[0]) + 1e-15L);
    near("minimum of the model", at[0] + p[0], 1e-9L * fabsl(p[0]));
    near("double sinh", sinhl(2 * at[0]), 1e-12L * fabsl(sinhl(2 * at[0])));
    near("slope", E[1], 1e-13L);
    is("digits", floorl(-log10l(fabsl(p[0] / to[0]))));
    is("curvature", E[2]);
    near("E", E[0], 1e-14L);
    tell_iterate(simulation);
    if (!scalar)
        tell_landscape(simulation);
}

static void tell_dial(const Simulation *simulation)
{
    Real h = simulation->run[0].h, d[2];
    const double *x = simulation->run[0].x;
    const Real at[2] = {x[0], x[1]};
    const MapE E = map_E(simulation, PART_BOTH, at, FILTER_NONE);
    for (int i = 0; i < 2; i++)
        d[i] = x[i] - (Real)simulation->exhibit.target[i];
    CHECK_AT_MOST(hypotl(E.g[0], E.g[1]), 1e-13L * (1 + 100 * h * h));
    is("h", h);
    is_point("minimiser", x[0], x[1]);
    is("distance", hypotl(d[0], d[1]));
    near("inertia", (d[0] * d[0] + d[1] * d[1]) / 2, 1e-15L);
    near("elasticity", E.elastic, 1e-13L * h * h);
    near("P", E.elastic / (h * h), 1e-13L);
    tell_contours(simulation);
    for (int i = -2; i <= 1; i++) /* the marks on the path */
        is("h", powl(10, i));
}

/* ---- race and map -------------------------------------------------------- */

static void tell_race(const Simulation *simulation)
{
    const Race *race = &simulation->exhibit.race;
    /* explicit, implicit, explicit that explodes later: ms, and its h */
    Real least[3] = {INFINITY, INFINITY, INFINITY}, h[3] = {0, 0, 0};
    is("methods", 9);
    for (int k = 0; k < race->count; k++) {
        const RacePoint *point = &race->point[k];
        Real ms = 1e3L * point->seconds;
        int kind = point->method->implicit ? 1 : point->stable ? 0 : 2;
        if (point->error <= 0.01 && (point->stable || kind == 2) &&
            ms < least[kind]) {
            least[kind] = ms;
            h[kind] = 1e3L * point->h;
        }
        for (int i = 0; i < race->count; i++) /* halved once */
            if (race->point[i].method == point->method &&
                fabs(race->point[i].h / point->h - 2) < 1e-9)
                is("divided", race->point[i].error / point->error);
    }
    is("explicit ms", least[0]);
    is("explicit h", h[0]);
    is("implicit ms", least[1]);
    is("implicit h", h[1]);
    is("hollow ms", least[2]);
    is("hollow h", h[2]);
    for (int i = 0; i < RACE_METHODS; i++) { /* the table */
        Real stable = 0;
        for (int k = i; k < race->count; k += RACE_METHODS) {
            const RacePoint *point = &race->point[k];
            if (point->stable)
                stable = fmaxl(stable, point->h);
            is("error", point->error);
            is("time", 1e3L * point->seconds);
            is("later", point->later);
        }
        is("stable", 1e3L * stable);
    }
}

/* A cell that is known has run: test_scenes makes its steps again. */
static void tell_map(const Simulation *simulation)
{
    const EnvelopeMap *map = &simulation->exhibit.map;
    const Options *options = &simulation->options;
    Real h = powl(10, map->column / 2.0L - 9), k = powl(10, map->row - 6);
    int known = 0, undone = 0, bad = 0;
    for (int i = 0; i < ENVELOPE_ROWS * ENVELOPE_COLUMNS; i++) {
        const EnvelopeCell *cell =
            &map->cell[i / ENVELOPE_COLUMNS][i % ENVELOPE_COLUMNS];
        known += cell->known;
        undone += cell->known && !cell->worst && cell->undone;
        bad += cell->known && cell->worst;
    }
    is("known", known);
    is("undone", undone);
    is("converged", known - undone - bad);
    is("h", h);
    is("k", k);
    is("passing", h * options->tolerance);
    is("steps", 3);
    is("updates", map->cell[map->row][map->column].updates);
    for (int power = -8; power <= 16; power += 8) /* h^2 k/m, a line each */
        is("ratio", powl(10, power));
}

/* ---- beside the mouse ---------------------------------------------------- */

static Jet potential_along(const System *system, const double *x,
                           const TermKind *kind, int p, int q)
{
    static double way[2][2 * NODES];
    Place at = place_at(system, x, NULL, x);
    Spot spot = {.at = &at, .h = 1, .p = way[0], .q = way[1]};
    way[0][p] = way[1][q] = 1;
    Jet out = oracle_energy(&spot, kind);
    way[0][p] = way[1][q] = 0;
    return out;
}

static void tell_node(const Pane *pane, int i)
{
    const Simulation *simulation = pane->simulation;
    const System *system = &simulation->system;
    const double *x = pane_x(pane), *v = simulation->run[0].v;
    const Trace *trace = pane->trace;
    is("node", i);
    is("m", system->m[i]);
    for (int k = 2 * i; k < 2 * i + 2; k++) {
        Jet P = potential_along(system, x, NULL, k, k);
        Real f = (Real)system->m[i] * system->gravity[k % 2] - P.p;
        is("x", x[k]);
        is("v", v[k]);
        near("f", f, 1e-9L * (1 + fabsl(f)));
        bool backward =
            strcmp(simulation->run[0].method->name, "backward-euler") == 0;
        Real tilde = trace && trace->x_tilde && !backward ? trace->x_tilde[k]
                     : trace && trace->x_tilde
                         ? x_n[k] + (Real)made.timestep * v_n[k] +
                               (Real)made.timestep * made.timestep *
                                   system->gravity[k % 2]
                         : x[k] + (Real)simulation->options.timestep * v[k];
        near("x tilde", tilde, 1e-12L);
    }
}

static void tell_hovered_spring(const Pane *pane, int s)
{
    const System *system = &pane->simulation->system;
    const double *x = pane_x(pane);
    const int *e = system->e + 2 * s;
    const TermKind *kind = system_find_term(system, &plastic_energy)
                               ? &plastic_energy
                               : &mass_spring_energy;
    Real H[3], most = 0;
    for (int i = 0; i < 3; i++)
        H[i] = -potential_along(system, x, kind, 2 * e[0] + i / 2,
                                2 * e[1] + (i + 1) / 2)
                    .pq;
    most = fabsl(H[0]) + fabsl(H[1]) + fabsl(H[2]);
    is("node", e[0]);
    is("node", e[1]);
    is("l2", system->l2[s]);
    near("strain", 100 * (sqrtl(1 + exact_strain(system, x, s)) - 1), 1e-11L);
    Real middle = (H[0] + H[2]) / 2, apart = hypotl((H[0] - H[2]) / 2, H[1]);
    near("eigenvalue", 2 * (middle - apart), 1e-9L * most);
    near("eigenvalue", 2 * (middle + apart), 1e-9L * most);
}

/* 1, 2 or 5 times a power of ten, not below. */
static Real round_up(Real value)
{
    Real power = powl(10, floorl(log10l(value)));
    Real part = value / power * (1 - 1e-9L);
    return power * (part <= 1 ? 1 : part <= 2 ? 2 : part <= 5 ? 5 : 10);
}

/* The largest force of contact and friction on a node, N, up to the next round
 * number. */
static void tell_contact(const Pane *pane)
{
    const Simulation *simulation = pane->simulation;
    Real most = 0;
    for (int r = 0; r < simulation->runs; r++) {
        const TimeIntegrator *run = &simulation->run[r];
        const System *system = run->system;
        const double *x = r ? run->x : pane_x(pane);
        const Contact *contact = contact_of(system);
        const Term *term = system_find_term(system, &friction_energy);
        for (int k = 0; contact && k < contact->obstacles; k++)
            for (int i = 0; i < system->nodes; i++) {
                const Obstacle *o = &contact->obstacle[k];
                if (!contact_has_pair(contact, system, i, k))
                    continue;
                Real s =
                    exact_gap(system, x, i, k) / (Real)contact->barrier.d_hat;
                Real way[2] = {o->n[0], o->n[1]}, v[2];
                if (!(s < 1))
                    continue;
                for (int c = 0; c < 2; c++) {
                    bool ball = o->kind == OBSTACLE_BALL;
                    const double *at = o->node >= 0 ? x + 2 * o->node : o->o;
                    way[c] = ball ? (Real)x[2 * i + c] - at[c] : way[c];
                    v[c] = run->v[2 * i + c] -
                           (o->node >= 0 ? run->v[2 * o->node + c] : o->v[c]);
                }
                Real slip = fabsl(way[0] * v[1] - way[1] * v[0]) /
                            hypotl(way[0], way[1]);
                Real a =
                    term ? fminl(slip /
                                     ((const Friction *)term->data)->slip_speed,
                                 1)
                         : 0;
                Real push = -contact->barrier.c / contact->barrier.d_hat *
                            (logl(s) + 1 - 1 / s);
                most = fmaxl(most, push * hypotl(1, o->friction * a * (2 - a)));
            }
    }
    if (simulation->scene->needs & NEEDS_TIME && simulation->runs == 3)
        for (int r = 0; r < 3; r++) { /* the blocks on their slopes */
            const Real part[] = {0.5L, 0.9L, 1.1L}, degree = M_PI / 180;
            is("slope", 20);
            is("slope", part[r]);
            is("slope",
               part[r] * simulation->options.friction / tanl(20 * degree));
        }
    if (most > 0)
        is("contact", /* force */ round_up(most));
}

/* The strains at the ends of the colours, in percent. */
static void tell_colours(const Simulation *simulation)
{
    const Plasticity *flow = system_data(&simulation->system, &plastic_energy);
    Real most = fabsl(fabsl(simulation->options.stretch) - 1), own = 0.1L;
    Real range = simulation->scene->strain;
    if (!(range > 0))
        range = round_up(fmaxl(most / 2, 0.05L));
    is("strain", 100 * fminl(range, 1));
    is("strain", 100 * range);
    for (int s = 0; s < simulation->system.springs && flow; s++)
        own = fmaxl(own, fabsl(flow->ep[s]));
    is("plastic", 100 * round_up(own / 2));
}

/* ---- a frame ------------------------------------------------------------- */

static void tell_all(const Show *show)
{
    const Pane *pane = &show->pane[show->active];
    const Simulation *simulation = pane->simulation;
    const Options *o = &simulation->options;
    const double settings[] = {o->timestep, o->stiffness, o->stretch,
                               o->segments, o->tolerance, o->friction,
                               o->damping,  o->young,     o->poisson};
    PictureKind kind = simulation->scene->picture;
    truths = 0;
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++)
        near("setting", settings[i], 5e-4L * fabsl(settings[i]));
    is("of its width, %", 100 * o->stretch);
    near("t", simulation_time(simulation), 1e-5L * simulation_time(simulation));
    if (show->lecture)
        is("page", (Real)(show->lecture - lecture_pages + 1));
    is("pages", lecture_count());
    is("panes", show->panes);
    is("runs", simulation->runs);
    is("springs", simulation->system.springs);
    is("h eps", (Real)o->timestep * o->tolerance);
    is("h eps", (Real)made.timestep * o->tolerance);
    double needed;
    if (simulation->scene->needs & NEEDS_TIME &&
        simulation_is_loose(simulation, &needed))
        is("needed",
           fminl(0.1L * o->timestep * fabs(o->gravity), 0.1L * o->slip_speed));
    if (pane->trace)
        tell_trace(simulation, pane->trace);
    if (kind == PICTURE_CIRCLE || kind == PICTURE_MASS)
        tell_masses(simulation);
    for (int p = 0; p < show->panes; p++)
        if (kind == PICTURE_SQUARE || kind == PICTURE_SPRING)
            tell_energies(show->pane[p].simulation);
    if (kind == PICTURE_SPRING)
        tell_spring(simulation);
    if (kind == PICTURE_CURVE || kind == PICTURE_TANGENT ||
        kind == PICTURE_LANDSCAPE)
        tell_search(simulation);
    if (kind == PICTURE_SQUARE && o->page)
        tell_page(simulation);
    if (kind == PICTURE_DIAL)
        tell_dial(simulation);
    if (kind == PICTURE_RACE)
        tell_race(simulation);
    if (kind == PICTURE_ENVELOPE)
        tell_map(simulation);
    tell_contact(pane);
    tell_colours(simulation);
    if (show->hover.kind == PICK_NODE && kind == PICTURE_SQUARE)
        tell_node(&show->pane[0], show->hover.index);
    if (show->hover.kind == PICK_SPRING && kind == PICTURE_SQUARE)
        tell_hovered_spring(&show->pane[0], show->hover.index);
}

/* Whether some truth of this name and run is the value; without a name any, and
 * what has another sign is one, too. */
static bool is_true(const char *name, int run, double value)
{
    bool named = false;
    for (int i = 0; i < truths; i++) {
        Real true_value = truth[i].value, slack = truth[i].slack;
        if (!name && isfinite(slack) &&
            slack > 0.01L * fabsl(true_value) + 1e-3L)
            continue; /* how many springs, about: true of too much */
        if (name && (strcmp(truth[i].name, name) != 0 || truth[i].run != run))
            continue;
        named = true;
        Real off = name ? value - true_value : fabsl(value) - fabsl(true_value);
        bool near_it = isinf(true_value)
                           ? isinf(value)
                           : fabsl(off) <= slack + 1e-13L * fabsl(true_value);
        if (near_it)
            return true;
    }
    if (name && !named)
        print_error("no formula for %s\n", name);
    return false;
}

/* Facts, and what the energies' card says. */
static void check_facts(const char *name)
{
    const Pane *pane = show_pane(&player.show);
    const Facts *facts = &pane->facts;
    const History *history = pane->history;
    double now = simulation_time(pane->simulation);
    for (const Fact *one = facts->fact; one < facts->fact + facts->count; one++)
        for (int k = 0; k <= one->point && !one->words; k++)
            if (!is_true(one->name, one->run, one->value[k]))
                wrong(name, one->name, one->value[k]);
    bool square = pane->simulation->scene->picture == PICTURE_SQUARE;
    for (int s = 0; square && history && s < history->series; s++) {
        double value = energies_value(pane->simulation, history, s, now);
        if (!isnan(value) && !is_true(history->name[s], 0, value))
            wrong(name, history->name[s], value);
    }
}

/* What the row and the time line say. */
static void check_texts(const char *name)
{
    const Show *show = &player.show;
    const char *time = strstr(show->time_text, "t = ");
    if (time && !is_true("t", 0, strtod(time + 4, NULL)))
        wrong(name, show->time_text, NAN);
    for (int i = 0; i < show->settings; i++) {
        char *rest;
        double value = strtod(show->setting[i].value, &rest);
        if (rest != show->setting[i].value && !is_true("setting", 0, value))
            wrong(name, show->setting[i].value, value);
    }
}

/* Counts are not looked at: page, node, line of a listing; nor runs that have
 * exploded beyond all numbers. */
static void check_frame(const char *name, PickKind kind, int index)
{
    Show *show = &player.show;
    const Simulation *simulation = &machine(0)->simulation;
    if (simulation->runs > 0 &&
        isinf(simulation_energies(simulation, 0).kinetic))
        return;
    player_fill(&player);
    show->hover = (Pick){.kind = kind, .index = index};
    tell_all(show);
    check_facts(name);
    check_texts(name);
    listens = name;
    show_draw(&paper, show);
    listens = NULL;
}

/* ---- what is played ------------------------------------------------------ */

static void open_scene(const char *line)
{
    begin(line);
    made.timestep = 0;
    step_now = -1;
    remember();
}

static void run(int steps)
{
    for (Status status = STATUS_OK; steps > 0 && !status; steps--) {
        status = player_step(&player);
        remember();
    }
}

static void tell(const char *command)
{
    player.message[0] = '\0';
    obey(command);
    remember();
}

/* Every line of Algorithm 3. */
static void walk(const char *name)
{
    tell("finer");
    tell("finer");
    for (int i = 0; i < 8; i++) {
        tell("next");
        check_frame(name, PICK_NONE, 0);
    }
}

/* What is changed or dragged. */
static const char *touch_now(void)
{
    const Scene *scene = machine(0)->simulation.scene;
    return scene->grips                         ? "handle 0 0.4 -0.3"
           : scene->picture == PICTURE_ENVELOPE ? "cell 300"
           : scene->needs & NEEDS_MESH          ? "set stiffness 5e4"
           : scene->needs & NEEDS_TIME          ? "set timestep 0.05"
                                                : "start 0.7 0";
}

static const char walked[] =
    "newton explodes minimise algorithm3 square unprojected drop landscape";

/* At its start, later, line by line, touched. */
static void play(const char *name)
{
    check_frame(name, PICK_NONE, 0);
    run(2);
    check_frame(name, PICK_SPRING, 5);
    if (tests_are_long() || strstr(walked, name))
        walk(name);
    tell(touch_now());
    check_frame(name, PICK_NODE, 1);
    run(3);
    check_frame(name, PICK_NODE, 1);
    end();
}

TEST(numbers_of_scenes)
{
    faults = 0;
    for (const Scene *scene = scenes; scene->name; scene++) {
        open_scene(scene->name);
        play(scene->name);
    }
    CHECK(faults == 0);
}

TEST(numbers_of_pages)
{
    faults = 0;
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        char command[64];
        open_scene("square");
        snprintf(command, sizeof command, "page %s", page->name);
        tell(command);
        if (page->law) /* until something touches, flows, nearly breaks */
            run(page->picture);
        play(page->name);
    }
    CHECK(faults == 0);
}

/* Later, with other methods, and by hand. */
TEST(numbers_of_long_runs)
{
    static const struct {
        const char *line;
        int steps;
        const char *commands[5];
    } rows[] = {
        {"square --yield 0.05 --hardening 0.1", 4, {"", "set yield 0.1"}},
        {"square --timestep 1000 --stiffness 10", 1, {""}},
        {"square --damping 0.01", 5, {"", "set damping 0.02"}},
        {"square --filter none --stretch 0.6", 3, {"", "projection"}},
        {"square --integrator bdf2", 4, {"", "set integrator midpoint"}},
        {"square --integrator sdirk2", 3, {"", "set integrator verlet"}},
        {"square --segments 3", 2, {"", "grab 0", "drag -1 0.5", "release"}},
        {"square --segments 2", 3, {"", "method", "add-pane", "add-pane"}},
        {"dent --segments 6", 80, {""}},
        {"tear --segments 8", 80, {""}},
        {"drop --segments 6", 70, {"", "enlarge 4"}},
        {"squeeze --segments 6", 40, {""}},
        {"bend --segments 16", 60, {""}},
        {"slope", 30, {"", "set friction 0.5"}},
        {"hang", 30, {"", "pin 3"}},
        {"explosion", 1, {"", "projection"}},
        {"arrows --integrator forward-euler", 2, {""}},
        {"overshoot --start 1.08 --line-search none", 2, {"", "line-search"}},
        {"landscape --start 0.4,0.9", 1, {"", "flip 0", "flip 0", "flip 1"}},
        {"dial", 4, {"", "handle 0 0.3 0.5"}},
        {"spring --start 0.3,0.2", 2, {"", "flip 0"}},
        {"race", 14, {""}},
        {"envelope", 3, {"", "cell 200", "cell 430"}}};
    faults = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        open_scene(rows[i].line);
        for (int k = 0; k < 5 && rows[i].commands[k]; k++) {
            if (rows[i].commands[k][0])
                tell(rows[i].commands[k]);
            check_frame(rows[i].line, PICK_NODE, 7);
            run(rows[i].steps);
            check_frame(rows[i].line, PICK_SPRING, 2);
        }
        walk(rows[i].line);
        end();
    }
    CHECK(faults == 0);
}

static int set_up(void **unused)
{
    (void)unused;
    return paper_create(WIDE, HIGH, &paper);
}

static int take_down(void **unused)
{
    (void)unused;
    paper_free(&paper);
    return 0;
}

TESTS(set_up, take_down)
