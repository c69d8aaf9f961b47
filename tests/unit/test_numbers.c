/* What the texts of pages and cards know of the square by name (facts.h) is
 * calculated again, in extended precision and by formulas that stand here or in
 * the oracle.  (Other pictures, and numbers beside the mouse and in cards, are
 * held by test_session, digits and axes by test_picture, a page's claims by
 * test_pages, what plasticity, fracture and friction took by test_laws.) */
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

enum { MOST = 200, UNKNOWNS = 50, NODES = 700 };

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
    EvalPoint at = eval_point_at(system, x_n, u, trace->x);
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
}

static void tell_trace(const Simulation *simulation, const Trace *trace)
{
    CHECK(made.timestep == 0 || trace->h == made.timestep);
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
        for (int k = 0; k < 12; k++) {
            const double *x = simulation->run[0].x + 2 * solid->node[t][k % 3];
            F[k / 3] += (Real)solid->weight[t][k / 6][k % 3] * x[k / 3 % 2];
        }
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
        /* by differences over a ten thousandth of d to either side */
        near("law force", c / reach * (1 / s - 1 - logl(s)), 1e-2L);
    } else if (strcmp(law, "near") == 0) {
        at = exact_nearest(simulation, reach, &slip);
        s = powl(at / reach, 2);
        c /= 8;
        value = c * (s - 1) * logl(s);
        near("law force", 2 * c * at / reach / reach * (1 / s - 1 - logl(s)),
             1e-2L);
    } else if (strcmp(law, "rub") == 0) {
        exact_nearest(simulation, reach, &at);
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
    tell_block(simulation, newest);
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

/* ---- a frame ------------------------------------------------------------- */

static void tell_all(const Show *show)
{
    const Pane *pane = &show->pane[show->active];
    truths = 0;
    if (pane->trace)
        tell_trace(pane->simulation, pane->trace);
    for (int p = 0; p < show->panes; p++)
        tell_energies(show->pane[p].simulation);
    if (pane->simulation->options.page)
        tell_page(pane->simulation);
}

/* Settings, counts, and where a spring stands in its matrix. */
static const char not_calculated[] =
    " page pages panes runs springs segments side rho k stretch h epsilon "
    "newest "
    "from to last row 1 row 2 row 3 row 4 tolerance h then ";

/* Whether some truth of this name and run is the value. */
static bool is_true(const char *name, int run, double value)
{
    char word[32];
    bool named = false;
    for (int i = 0; i < truths; i++) {
        Real true_value = truth[i].value, slack = truth[i].slack;
        if (strcmp(truth[i].name, name) != 0 || truth[i].run != run)
            continue;
        named = true;
        if (isinf(true_value) ? isinf(value)
                              : fabsl(value - true_value) <=
                                    slack + 1e-13L * fabsl(true_value))
            return true;
    }
    snprintf(word, sizeof word, " %s ", name);
    if (!named && strstr(not_calculated, word))
        return true;
    if (!named)
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
    for (int s = 0; history && s < history->series; s++) {
        double value = energies_value(pane->simulation, history, s, now);
        if (!isnan(value) && !is_true(history->name[s], 0, value))
            wrong(name, history->name[s], value);
    }
}

/* Of the square, unless it has exploded beyond all numbers. */
static void check_frame(const char *name)
{
    const Simulation *simulation = &machine(0)->simulation;
    if (simulation->scene->picture != PICTURE_SQUARE ||
        isinf(simulation_energies(simulation, 0).kinetic))
        return;
    player_fill(&player);
    tell_all(&player.show);
    check_facts(name);
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
        check_frame(name);
    }
}

static const char walked[] =
    "explodes minimise algorithm3 square unprojected drop";

/* At its start, later, line by line, touched. */
static void play(const char *name)
{
    check_frame(name);
    run(2);
    check_frame(name);
    if (tests_are_long() || strstr(walked, name))
        walk(name);
    tell("set stiffness 5e4");
    check_frame(name);
    run(3);
    check_frame(name);
    end();
}

TEST(numbers_of_scenes)
{
    faults = 0;
    for (const Scene *scene = scenes; scene->name; scene++) {
        if (scene->picture != PICTURE_SQUARE)
            continue;
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
        {"explosion", 1, {"", "projection"}}};
    faults = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        open_scene(rows[i].line);
        for (int k = 0; k < 5 && rows[i].commands[k]; k++) {
            if (rows[i].commands[k][0])
                tell(rows[i].commands[k]);
            check_frame(rows[i].line);
            run(rows[i].steps);
            check_frame(rows[i].line);
        }
        walk(rows[i].line);
        end();
    }
    CHECK(faults == 0);
}

TESTS(NULL, NULL)
