/* What texts know of a step of the square by name (facts.h), and its energies,
 * are calculated again, in extended precision.
 * (All other numbers of a frame are held by test_session, those of a page by
 * test_pages, digits and axes by test_picture, what plasticity, fracture and
 * friction took by test_laws.) */
#include "attended.h"
#include "test.h"

#include <math.h>

#include "picture/cards.h"

enum { MOST = 200 };

/* ---- what is true -------------------------------------------------------- */

typedef struct Truth {
    char name[24];
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
static int truths;

static void near(const char *name, Real value, Real slack)
{
    assert_true(truths < MOST);
    Truth *one = &truth[truths++];
    *one = (Truth){.value = value, .slack = slack};
    snprintf(one->name, sizeof one->name, "%s", name);
}

static void is(const char *name, Real value)
{
    near(name, value, 1e-12L * fabsl(value));
}

/* ---- a step in time ------------------------------------------------------ */

/* What a line of the minimisation says, of the trace that it shows (test_newton
 * holds that to formulas of the oracle). */
static void tell_trace(const Trace *trace)
{
    is("nth", trace->iteration + 1);
    is("length", powl(2, 1 - fmaxl(trace->trials, 1)) *
                     (trace->first > 0 ? trace->first : 1));
    Real risen = 0;
    for (int i = 0; i < trace->updates; i++)
        risen += trace->record[i].change;
    is("risen", risen);
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

/* ---- a frame ------------------------------------------------------------- */

static void tell_all(const Show *show)
{
    const Pane *pane = &show->pane[show->active];
    truths = 0;
    if (pane->trace)
        tell_trace(pane->trace);
    for (int p = 0; p < show->panes; p++)
        tell_energies(show->pane[p].simulation);
}

/* Whether some truth of this name is the value; others calculate names of which
 * there is none. */
static bool is_true(const char *name, double value)
{
    bool named = false;
    for (int i = 0; i < truths; i++) {
        Real true_value = truth[i].value, slack = truth[i].slack;
        if (strcmp(truth[i].name, name) != 0)
            continue;
        named = true;
        if (isinf(true_value) ? isinf(value)
                              : fabsl(value - true_value) <=
                                    slack + 1e-13L * fabsl(true_value))
            return true;
    }
    return !named;
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
            if (!is_true(one->name, one->value[k]))
                wrong(name, one->name, one->value[k]);
    for (int s = 0; history && s < history->series; s++) {
        double value = energies_value(pane->simulation, history, s, now);
        if (!isnan(value) && !is_true(history->name[s], value))
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

static void run(int steps)
{
    for (Status status = STATUS_OK; steps > 0 && !status; steps--)
        status = player_step(&player);
}

static void tell(const char *command)
{
    player.message[0] = '\0';
    obey(command);
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
        begin(scene->name);
        play(scene->name);
    }
    CHECK(faults == 0);
}

TEST(numbers_of_pages)
{
    faults = 0;
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        char command[64];
        begin("square");
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
        {"square --damping 0.01", 5, {"", "set damping 0.02"}},
        {"square --filter none --stretch 0.6", 3, {"", "projection"}},
        {"square --integrator sdirk2", 3, {"", "set integrator verlet"}},
        {"square --segments 2", 3, {"", "method", "add-pane", "add-pane"}},
        {"dent --segments 6", 80, {""}},
        {"tear --segments 8", 80, {""}},
        {"bend --segments 16", 60, {""}},
        {"slope", 30, {"", "set friction 0.5"}},
        {"explosion", 1, {"", "projection"}}};
    faults = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        begin(rows[i].line);
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
