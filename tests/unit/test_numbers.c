/* What texts know of a step of the square by name (live_values.h), and its
 * energies, are what the trace and the ledger say, on all pages and scenes of
 * it. (test_newton holds the trace to formulas of the oracle, test_laws and
 * check_tables the ledger; all other numbers of a frame are held by
 * test_session, those of a page by test_pages, digits and axes by
 * test_picture.) */
#include "attended.h"
#include "test.h"

#include <math.h>

#include "picture/cards.h"

/* ---- a frame ------------------------------------------------------------- */

/* A number that is said by this name, NaN: it is not, to 1e-12 of itself and
 * some slack. */
static void check_number(const char *line, const char *name, double said,
                         double value, double slack)
{
    double off = fabs(said - value) - 1e-12 * fabs(value);
    if (!isnan(said) && said != value && !(off <= slack))
        fail_msg("%s, step %ld: '%s' says %.12g, not %.12g", line,
                 player.past.step, name, said, value);
}

/* A line of the minimisation. */
static void check_trace(const char *line, const Pane *pane)
{
    const Trace *trace = pane->trace;
    double change = NAN,
           first = trace->first_alpha > 0 ? trace->first_alpha : 1;
    if (trace->difference && trace->trials > 0)
        change = trace->difference(trace->difference_data,
                                   trace_step_length(trace, trace->trials));
    const struct {
        const char *name;
        double value;
    } rows[] = {{"nth", trace->iteration + 1},
                {"length", first * pow(2, 1 - fmax(trace->trials, 1))},
                {"projected", trace->projected},
                {"residual", trace->residual},
                {"p size", trace->residual * trace->h},
                {"change", change}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        check_number(line, rows[i].name,
                     values_find_number(&pane->values, rows[i].name),
                     rows[i].value, 0);
}

/* Of the square, unless it has exploded beyond all numbers: facts, and what the
 * energies' card says, where what is rounding is 0. */
static void check_frame(const char *line)
{
    const Simulation *simulation = player_simulation(&player);
    Energies ledger = simulation_energies(simulation, 0);
    double now = simulation_time(simulation);
    double size = fabs(ledger.kinetic) + fabs(ledger.gravity) + ledger.total;
    if (simulation->scene->picture != PICTURE_SQUARE || isinf(ledger.kinetic))
        return;
    player_fill(&player);
    const Pane *pane = active_pane(&player.screen.frame.content);
    const History *history = pane->history;
    if (pane->trace)
        check_trace(line, pane);
    for (int i = 0; i < ledger.rows; i++) {
        const Energy *row = &ledger.row[i];
        check_number(line, row->name,
                     values_find_number(&pane->values, row->name), row->value,
                     0);
        for (int s = 0; history && s < history->series; s++)
            if (strcmp(history->name[s], row->name) == 0)
                check_number(line, row->name,
                             energies_value_at(simulation, history, s, now),
                             row->value, 1e-13 * size);
    }
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

TEST(scenes_show_the_numbers_of_trace_and_ledger)
{
    for (const Scene *scene = scenes; scene->name; scene++) {
        if (scene->picture != PICTURE_SQUARE)
            continue;
        begin(scene->name);
        play(scene->name);
    }
}

TEST(pages_show_the_numbers_of_trace_and_ledger)
{
    for (const LecturePage *page = lecture_pages; page->name; page++) {
        char command[64];
        begin("square");
        snprintf(command, sizeof command, "page %s", page->name);
        tell(command);
        if (page->law) /* until something touches, flows, nearly breaks */
            run(page->picture);
        play(page->name);
    }
}

/* Later, with other methods, and by hand. */
TEST(long_runs_show_the_numbers_of_trace_and_ledger)
{
    static const struct {
        const char *line;
        int steps;
        const char *commands[5];
    } rows[] = {
        {"square --yield 0.05 --hardening 0.1", 4, {"", "set yield 0.1"}},
        {"square --damping 0.01", 5, {"", "set damping 0.02"}},
        {"square --projection none --stretch 0.6", 3, {"", "projection"}},
        {"square --integrator sdirk2", 3, {"", "set integrator verlet"}},
        {"square --segments 2", 3, {"", "method", "add-pane", "add-pane"}},
        {"dent --segments 6", 80, {""}},
        {"tear --segments 8", 80, {""}},
        {"bend --segments 16", 60, {""}},
        {"slope", 30, {"", "set friction 0.5"}},
        {"explosion", 1, {"", "projection"}}};
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
}

TESTS(NULL, NULL)
