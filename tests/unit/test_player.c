/* What the window promises, without a window: the same commands, scene by
 * scene.
 */
#include "test.h"
#include "attended.h"

#include <math.h>

#include "base/clock.h"
#include "scenes/scene.h"

/* E of a step from x_n with v_n where springs alone act, at x, J s^2. */
static double step_energy(const Simulation *simulation, const double *x_n,
                          const double *v_n, const double *x)
{
    const System *system = &simulation->system;
    long double h = simulation->options.timestep, sum = 0;
    for (int i = 0; i < 2 * system->nodes; i++) {
        long double off = (long double)x[i] - x_n[i] - h * v_n[i];
        sum += system->m[i / 2] / 2 * off * off;
    }
    for (int s = 0; s < system->springs; s++) {
        const double *a = x + 2 * (size_t)system->e[2 * s];
        const double *b = x + 2 * (size_t)system->e[2 * s + 1];
        long double dx = (long double)a[0] - b[0];
        long double dy = (long double)a[1] - b[1];
        long double strain = (dx * dx + dy * dy) / system->l2[s] - 1;
        sum += h * h * system->l2[s] * system->k[s] / 2 * strain * strain;
    }
    return (double)sum;
}

/* What a step is told to have done to E is E at its end less E at its start:
 * also where E was 2e16 in between, and where no update but the centre of mass
 * moved the square.  The last line: strains of 1e-6 have ten digits. */
TEST(e_is_told_as_it_is)
{
    static const struct {
        const char *line;
        double digits; /* of E */
    } rows[] = {{"explosion", 1e-12},
                {"square --segments 1 --timestep 0.05 --stretch 0.5 --filter "
                 "none --line-search none",
                 1e-12},
                {"square --stretch 1.4", 1e-12},
                {"square --stretch 1 --velocity 0.3,0.2 --tolerance 1", 1e-12},
                {"square --stretch 1.000001 --tolerance 1e-9", 1e-9}};
    for (int i = 0; i < 5; i++) {
        double x[64], v[64];
        begin(rows[i].line);
        const Simulation *simulation = player_simulation(&player);
        size_t bytes = 2 * (size_t)simulation->system.nodes * sizeof *x;
        CHECK(bytes <= sizeof x);
        memcpy(x, simulation->run[0].x, bytes);
        memcpy(v, simulation->run[0].v, bytes);
        double before = step_energy(simulation, x, v, x);
        CHECK_STATUS(obey("next"), STATUS_OK);
        double after = step_energy(simulation, x, v, simulation->run[0].x);
        CHECK(after != before);
        CHECK_NEAR(told(0, 1)->change, after - before,
                   rows[i].digits * (before + after));
        end();
    }
}

/* Runs until it pauses by itself, as it must within some hundred steps. */
static void run_until_it_pauses(void)
{
    for (int i = 0; i < 3000 && !player_stands(&player); i++)
        CHECK_STATUS(player_step(&player), STATUS_OK);
    CHECK(player_stands(&player));
}

/* How far a node gets from where it is in 400 steps of a hundredth of a second
 * with nine digits, over the length of the shortest spring. */
static double way_that_is_left(void)
{
    const Simulation *simulation = player_simulation(&player);
    const System *system = &simulation->system;
    int size = 2 * system->nodes;
    double start[64], far = 0, l2 = INFINITY;
    for (int s = 0; s < system->springs; s++)
        l2 = fmin(l2, system->l2[s]);
    memcpy(start, simulation->run[0].x, (size_t)size * sizeof *start);
    obey_all(
        (const char *const[]){"set timestep 0.01", "set tolerance 1e-9", NULL});
    for (int step = 0; step < 400; step++) {
        CHECK_STATUS(player_step(&player), STATUS_OK);
        for (int i = 0; i < size; i++)
            far = fmax(far, fabs(simulation->run[0].x[i] - start[i]));
    }
    return far / sqrt(l2);
}

/* Asking whether it rests leaves no trace: the same bits as without. */
static void compare_with_plain_run(const char *line)
{
    Simulation plain;
    const TimeIntegrator *run = &player_simulation(&player)->run[0];
    simulation_from_line(line, NULL, NULL, &plain);
    for (int i = 0; i < 5; i++)
        CHECK_STATUS(player_step(&player), STATUS_OK);
    for (long i = 0; i < player.past.step; i++)
        CHECK_STATUS(simulation_step(&plain), STATUS_OK);
    CHECK_SAME_BITS(plain.run[0].x, run->x, (int)run->size);
    CHECK_SAME_BITS(plain.run[0].v, run->v, (int)run->size);
    simulation_free(&plain);
}

/* "At rest" is said of a square that goes nowhere, however well it is computed
 * from there; of one that only the tolerance holds it is said that it does: in
 * long steps, in short ones, at a turning point, in the air.  A node that is a
 * hundredth of a spring from its balance swings twice as far. */
TEST(rest_is_told_from_tolerance)
{
#define STANDS "square --stretch 1 --gravity 9.81 --ground 0,1,0,-0.6 "
    static const struct {
        const char *line;
        bool rests;
    } rows[] = {{"square", true},
                {"square --timestep 1", true},
                {"square --timestep 1000 --stiffness 100", false},
                {"square --timestep 1e-6", false},
                {"square --tolerance 1", false},
                {"square --segments 2 --tolerance 0.3", false},
                {"hang --segments 3", true},
                {"hang --segments 3 --timestep 1e-4", false},
                {STANDS "--tolerance 1e-3", true},
                {STANDS "--tolerance 1e-2", true},
                {STANDS "--timestep 0.0005", false},
                {STANDS "--friction 0.3 --tolerance 1e-4", true}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        begin(rows[i].line);
        run_until_it_pauses();
        CHECK(player.mode == (rows[i].rests ? MODE_REST : MODE_HELD));
        CHECK(rows[i].rests || /* twice, or it may be a turning point */
              told(0, player.past.step - 1)->updates == 0);
        CHECK(machine(0)->outcome.updates == 0);
        CHECK((strncmp(player.note, "at rest", 7) == 0) == rows[i].rests);
        CHECK((strncmp(player.note, "within the tolerance, ", 22) == 0) !=
              rows[i].rests);
        player_fill(&player);
        CHECK((strcmp(player.show.state, "at rest") == 0) == rows[i].rests);
        compare_with_plain_run(rows[i].line);
        double way = way_that_is_left();
        CHECK(rows[i].rests ? way <= 0.02 : way > 0.02);
        end();
    }
    /* what friction does shows with a smaller tolerance only */
    begin(STANDS "--friction 0.3 --tolerance 1e-3");
    run_until_it_pauses();
    CHECK(player.mode == MODE_HELD &&
          strstr(player.note, "perhaps not at rest"));
    end();
}

/* What is left of a motion beside the rigid one. */
TEST(rigid_motion_deforms_nothing)
{
    double centre, turn;
    begin("square --segments 3 --stretch 1.2");
    Simulation *simulation = &player.past.machine[0].simulation;
    TimeIntegrator *run = &simulation->run[0];
    for (int i = 0; i < simulation->system.nodes; i++) {
        run->v[2 * i] = 3 - 2 * run->x[2 * i + 1];
        run->v[2 * i + 1] = 4 + 2 * run->x[2 * i];
    }
    /* rounding of numbers near 5 */
    CHECK_AT_MOST(simulation_deforming(simulation, &centre, &turn), 1e-14);
    CHECK_NEAR(centre, 5, 1e-14);
    CHECK_NEAR(turn, 2, 1e-14);
    for (int i = 0; i < simulation->system.nodes; i++)
        run->v[2 * i] += 0.5 * run->x[2 * i]; /* stretches; up to 0.3 m/s */
    CHECK_NEAR(simulation_deforming(simulation, &centre, &turn), 0.3, 1e-14);
    CHECK(simulation_is_free(simulation));
    CHECK_STATUS(obey("pin 0"), STATUS_OK);
    CHECK(!simulation_is_free(simulation));
    end();
    const char *held[] = {"hang", "drop", "squeeze", "bend", "tear"};
    for (size_t i = 0; i < sizeof held / sizeof *held; i++) {
        begin(held[i]);
        CHECK(!simulation_is_free(&machine(0)->simulation));
        end();
    }
}

/* A step is taken again as it was made, and what was changed since is changed
 * once more: the energies beside it are those with the change. */
TEST(energies_of_a_step_taken_again_have_its_changes)
{
    begin("square");
    obey_all((const char *const[]){"next", "next", "set stiffness 150000",
                                   "projection", NULL});
    const History *history = &past_curves(&player.past, 0)->history;
    double now = simulation_energies(player_simulation(&player), 0).total;
    CHECK_NEAR(history->value[0][history->count - 1], now, 1e-9 * now);
    end();
}

/* A step whose line search finds nothing, line by line: each line says what is
 * true of itself, and the verdict comes where the search gives up.  The test
 * after it shows the residual as it is, above the tolerance. */
TEST(a_failed_search_is_no_convergence)
{
    int verdicts = 0, lines = 0;
    begin("unprojected");
    obey_all((const char *const[]){"finer", "finer", "next", NULL});
    for (Line line = LINE_START; line != LINE_END; lines++) {
        char number[16];
        player_fill(&player);
        const Trace *trace = player.show.pane[0].trace;
        const char *sentence = player.show.sentence;
        line = trace->line;
        snprintf(number, sizeof number, "line %d:", (int)line);
        bool verdict = strstr(sentence, "no small step") != NULL;
        CHECK(verdict == trace->given_up);
        CHECK(verdict || strncmp(sentence, number, strlen(number)) == 0);
        CHECK(!trace->given_up || trace->slope > 0);
        CHECK(!trace->given_up || !trace->accepted);
        if (line == LINE_END) {
            CHECK(trace->given_up && trace->residual > 0.01);
            CHECK(trace->difference != NULL && verdicts == 1);
        }
        verdicts += verdict;
        if (line != LINE_END)
            CHECK_STATUS(obey("next"), STATUS_OK);
    }
    CHECK(lines > 10 && verdicts == 2);
    player_simulation(&player);
    obey_all((const char *const[]){"finer", NULL});
    player_fill(&player);
    CHECK(player.show.pane[0].trace->line == LINE_NONE);
    CHECK(player.show.pane[0].trace->given_up);
    CHECK(player.show.pane[0].trace->residual > 0.01);
    end();
    begin("square"); /* one that converges gives nothing up */
    obey_all((const char *const[]){"next", NULL});
    player_fill(&player);
    CHECK(!player.show.pane[0].trace->given_up);
    end();
}

/* The curve E(x + alpha p) - E(x) ends where the step went, in polynomials and
 * with contact; what is drawn of the last test is a p that belongs there, or
 * none. */
TEST(the_curve_goes_through_the_step)
{
    static const char *const lines[] = {"square", "drop --segments 6",
                                        "dent --segments 6",
                                        "tear --segments 6", "slope"};
    for (int i = 0; i < 5; i++) { /* slope: three runs, one is shown */
        int rough = 0, seen = 0;
        begin(lines[i]);
        for (int step = 0; step < 90; step++) {
            CHECK_STATUS(obey("step"), STATUS_OK);
            const Rounds *rounds = &machine(0)->rounds;
            for (int place = 0; place < rounds->places; place++) {
                Trace trace;
                rounds_trace(rounds, place, &trace);
                int round = rounds->place[place].round;
                if (trace.line != LINE_UPDATE)
                    continue;
                seen++;
                if (!trace.p) { /* of the first one where pins move */
                    CHECK(i == 3 && round == 0 && !trace.difference);
                    continue;
                }
                const NewtonRecord *record = &rounds->made.row[round];
                double change = trace.difference(trace.function, record->alpha);
                rough += rounds->round[round].value != NULL;
                if (rounds->round[round].value &&
                    record->alpha < trace.first / ROUND_PARTS)
                    continue; /* between two kept values */
                CHECK_NEAR(change, record->change,
                           1e-7 * fabs(record->slope) * record->alpha);
            }
        }
        CHECK(seen > 60 && (i == 3 || (rough > 0) == (i > 0)));
        Trace whole;
        const Rounds *rounds = &machine(0)->rounds;
        rounds_trace(rounds, -1, &whole);
        CHECK(whole.residual <= player.given[0].tolerance || !rounds->ended);
        end();
    }
}

/* The last round ends with the test: with a direction where one was made, also
 * without where a bound decides. */
TEST(last_rounds_have_their_lines)
{
    int passed[2] = {0, 0};
    begin("drop --segments 6");
    for (int step = 0; step < 60; step++) {
        static const char *const lines[2] = {"2347", "27"};
        char line[9] = "";
        CHECK_STATUS(obey("step"), STATUS_OK);
        const Rounds *rounds = &machine(0)->rounds;
        for (int i = 0; i < rounds->places && rounds->made.count > 0; i++)
            if (rounds->place[i].round == rounds->made.count &&
                rounds->place[i].line != LINE_END)
                snprintf(line + strlen(line), 3, "%d", rounds->place[i].line);
        if (rounds->made.count == 0)
            continue;
        assert_string_equal(line, lines[rounds->passed]);
        passed[rounds->passed]++;
    }
    CHECK(passed[0] > 0 && passed[1] > 0);
    end();
}

/* A point that is dragged changes the state of this step: what energies and
 * paths show of it is the state of now. */
TEST(what_is_dragged_is_shown_as_it_is)
{
    begin("arrows --integrator forward-euler");
    for (int step = 0; step < 3; step++) {
        player_sample(&player);
        CHECK_STATUS(obey("handle 0 0.5 0.25"), STATUS_OK);
        CHECK_STATUS(obey("handle 1 1.5 2.25"), STATUS_OK);
        player_sample(&player);
        const Curves *curves = past_curves(&player.past, 0);
        CHECK(curves->history.count == step + 1);
        /* (0.5^2 + 0.25^2 + 1^2 + 2^2) / 2 */
        CHECK_NEAR(curves->history.value[0][step], 2.65625, 0);
        CHECK_NEAR(curves->history.value[2][step], 0.25, 0);
        CHECK_STATUS(obey("next"), STATUS_OK);
    }
    end();
}

/* A pane that fails is not made good by the one after it. */
TEST(every_pane_may_fail)
{
    begin("square --integrator forward-euler,backward-euler --steps 1000");
    CHECK_STATUS(player_run(&player), STATUS_NOT_FINITE);
    CHECK(machine(0)->failed && !machine(1)->failed);
    end();
    begin("square --tolerance 1e-30,0.01");
    CHECK(!player_unconverged(&player));
    CHECK_STATUS(obey("step"), STATUS_OK);
    CHECK(machine(0)->simulation.unconverged == 1);
    CHECK(machine(1)->simulation.unconverged == 0);
    CHECK(player_unconverged(&player));
    end();
}

/* A run of a given number of steps ends at its failure. */
TEST(a_counted_run_ends_at_its_failure)
{
    begin("square --integrator forward-euler --steps 1000");
    CHECK_STATUS(player_run(&player), STATUS_NOT_FINITE);
    CHECK(!player_stands(&player) &&
          player.past.step == past_newest(&player.past));
    end();
}

/* Curves get each step once, however often it is drawn; a change at an old step
 * ends the time line there. */
TEST(old_steps_are_neither_kept_twice_nor_for_ever)
{
    begin("square --segments 2");
    obey_all((const char *const[]){"step", "step", "step", "back", NULL});
    long count = past_curves(&player.past, 0)->history.calls;
    player_sample(&player);
    CHECK(count > 0 && past_curves(&player.past, 0)->history.calls == count);
    CHECK(player.past.step == 2 && past_newest(&player.past) == 3);
    CHECK_STATUS(obey("set stiffness 2e5"), STATUS_OK);
    CHECK(player.past.step == 2 && past_newest(&player.past) == 2);
    end();
}

/* The summary: no projection where there was none, and why the first step that
 * did not converge did not, whatever came after it. */
TEST(the_summary_counts)
{
    char text[2048], expected[80];
    begin("square --filter none --timestep 0.02 --stretch 0.5");
    CHECK_STATUS(obey("step"), STATUS_OK);
    Status first = told(0, 1)->status;
    obey_all((const char *const[]){"set timestep 1e-4", "set tolerance 1e-30",
                                   "step", NULL});
    CHECK(told(0, 2)->status > STATUS_OK);
    CHECK(told(0, 2)->status != first);
    FILE *file = fmemopen(text, sizeof text, "w");
    CHECK(file != NULL);
    summary_print(file, &player);
    fclose(file);
    NewtonCounters sum = simulation_counters(player_simulation(&player));
    CHECK(sum.projected == 0 && sum.trials > 0);
    CHECK(strstr(text, "springs projected") == NULL);
    snprintf(expected, sizeof expected, " not converged 2, the first: %s\n",
             status_name(first));
    CHECK(status_is_unconverged(first) && strstr(text, expected) != NULL);
    end();
}

/* Whether the summary after a step has this word at the start of a line. */
static bool summary_has(const char *line, const char *words)
{
    char text[2048], wanted[80];
    begin(line);
    CHECK_STATUS(obey("step"), STATUS_OK);
    FILE *file = fmemopen(text, sizeof text, "w");
    CHECK(file != NULL);
    summary_print(file, &player);
    fclose(file);
    CHECK(simulation_counters(player_simulation(&player)).projected > 0);
    end();
    snprintf(wanted, sizeof wanted, "\n%s ", words);
    return strstr(text, wanted) != NULL;
}

/* What is counted as projected is called what it is: springs, or, where
 * contacts and cells have blocks too, blocks. */
TEST(projections_have_their_name)
{
    static const char *const lines[] = {
        "square --stretch 0.5", "drop --stretch 0.6 --filter clamp",
        "square --stretch 0.6 --cells on --filter clamp",
        "square --stretch 0.5 --damping 0.01"};
    for (int n = 0; n < 4; n++) {
        bool springs = n == 0 || n == 3;
        CHECK(summary_has(lines[n], "springs projected") == springs);
        CHECK(summary_has(lines[n], "blocks projected") == !springs);
        begin(lines[n]);
        Trace trace = {.line = LINE_PROJECT, .projected = 9};
        Show show;
        show_create(player_simulation(&player), &show);
        show.pane[0].trace = &trace;
        show_describe(&show);
        CHECK(strstr(show.sentence, springs ? "9 of 72 springs" : "9 blocks"));
        end();
    }
}

static void give_up(int number)
{
    stop = number;
}

/* A line of the script waits for its step only while steps are made. */
TEST(scripts_wait_while_it_runs)
{
    begin_script("0 pause\n9 step\n", "square --segments 2");
    signal(SIGALRM, give_up);
    alarm(20); /* s; it takes milliseconds */
    CHECK_STATUS(player_run(&player), STATUS_OK);
    alarm(0);
    CHECK(!stop && player.past.step == 1 && player_stands(&player));
    end();
}

/* Where a window shows sixteen steps a frame, a run of ten makes ten. */
TEST(many_steps_a_frame_end_in_time)
{
    begin("square --segments 2 --steps 10");
    CHECK_STATUS(view_create_surface(320, 200, &player.view), STATUS_OK);
    player.window = true;
    player.speed = 4;
    CHECK_STATUS(player_run(&player), STATUS_OK);
    CHECK(player.past.step == 10);
    end();
}

/* Frames until nothing is computed any more. */
static void work_off(void)
{
    while (player.past.works)
        CHECK_STATUS(player_frame(&player), STATUS_OK);
}

/* A step that takes long is made a frame's time at a time: what concerns the
 * screen is obeyed meanwhile, one on is the same wish, Escape gives it up, and
 * everything else, too, but not where a number is typed; the bits are those of
 * the step as a whole. */
TEST(a_long_step_is_made_in_slices)
{
    const char *line = "--segments 140 --solver newton";
    Simulation plain;
    simulation_from_line(line, NULL, NULL, &plain);
    CHECK_STATUS(simulation_step(&plain), STATUS_OK);
    begin(line);
    CHECK_STATUS(view_create_surface(320, 200, &player.view), STATUS_OK);
    player.window = true;
    CHECK_STATUS(player_draw(&player), STATUS_OK);
    uint64_t start = player_hash(&player);
    obey_all((const char *const[]){"next", "colours", "next", NULL});
    static const char *const typed[] = {"Tab", "1", "Q", "Escape"};
    for (int i = 0; i < 4; i++) {
        Input input = {.kind = INPUT_KEY};
        strcpy(input.key, typed[i]);
        CHECK_STATUS(player_input(&player, &input), STATUS_OK);
    }
    CHECK(player.past.works && player.past.step == 0 && !player.quit);
    work_off();
    CHECK(player.past.step == 1 && past_newest(&player.past) == 1);
    CHECK(player_hash(&player) == state_hash(&plain, STATE_HASH_SEED));
    obey_all((const char *const[]){"next", "escape", NULL});
    work_off();
    CHECK(!player.quit && player.past.step == 1 && !player.past.works);
    CHECK(player_hash(&player) == state_hash(&plain, STATE_HASH_SEED));
    obey_all((const char *const[]){"next", "home", NULL});
    work_off();
    CHECK(player.past.step == 0 && player_hash(&player) == start);
    CHECK(past_newest(&player.past) == 1);
    simulation_free(&plain);
    end();
}

/* Between two lines the square is where it was, then on its way, then where it
 * will be. */
TEST(glides_begin_and_end_at_lines)
{
    enum { SIZE = 18 };
    double before[SIZE], now[SIZE];
    begin("square --segments 2");
    player.window = true;
    obey_all((const char *const[]){"finer", "finer", "next", "next", "next",
                                   "next", "next", NULL});
    player.glide = clock_now() - 1;
    player_fill(&player);
    CHECK(player.show.pane[0].trace->line == LINE_SEARCH && player.glide == 0);
    memcpy(before, pane_x(&player.show.pane[0]), sizeof before);
    CHECK_STATUS(obey("next"), STATUS_OK);   /* line 6 moves the square */
    static const double ago[] = {0, 0.2, 1}; /* s */
    for (int i = 0; i < 3; i++) {
        /* 1 ... 0 and flat at both ends: a fifth of the time before the end
         * about a tenth of the way is left. */
        player.glide = clock_now() - ago[i];
        player_fill(&player);
        double rest = player.show.pane[0].trace->rest;
        CHECK(i == 0 ? rest > 0.99 : i == 1 ? rest < 0.105 : rest == 0);
        memcpy(now, pane_x(&player.show.pane[0]), sizeof now);
        const double *to = machine(0)->rounds.round[1].x;
        for (int k = 0; k < SIZE; k++)
            CHECK_NEAR(now[k], to[k] + rest * (before[k] - to[k]), 1e-12);
    }
    end();
}

TESTS(NULL, NULL)
