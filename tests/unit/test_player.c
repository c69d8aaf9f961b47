/* Promises of the window, held without a window: the same commands, scene by
 * scene.
 */
#include "test.h"
#include "attended.h"

#include <math.h>
#include <time.h>

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
        CHECK_OK(player_make_step(&player));
        for (int i = 0; i < size; i++)
            far = fmax(far, fabs(simulation->run[0].x[i] - start[i]));
    }
    return far / sqrt(l2);
}

/* The test whether the square rests changes no bit of the run. */
static void compare_with_plain_run(const char *line)
{
    Simulation plain;
    const TimeIntegrator *run = &player_simulation(&player)->run[0];
    simulation_from_line(line, NULL, NULL, &plain);
    for (int i = 0; i < 5; i++)
        CHECK_OK(player_make_step(&player));
    for (long i = 0; i < player.past.step; i++)
        CHECK_OK(simulation_step(&plain));
    CHECK_SAME_BITS(plain.run[0].x, run->x, (int)run->size);
    CHECK_SAME_BITS(plain.run[0].v, run->v, (int)run->size);
    simulation_free(&plain);
}

/* "At rest" is said of a body that stays where it is, however well its way is
 * computed from there, whatever the time step and the tolerance; and of none at
 * a turning point or in slow motion. */
TEST(rest_is_reported_where_nothing_moves)
{
#define STANDS "square --stretch 1 --gravity 9.81 --ground 0,1,0,-0.6 "
    static const char *const lines[] = {
        "square",
        "square --timestep 1",
        "square --timestep 1000 --stiffness 100",
        "square --tolerance 1",
        "square --segments 2 --tolerance 0.3",
        "hang --segments 3 --timestep 0.1",
        STANDS "--tolerance 1e-3",
        STANDS "--tolerance 1e-2"};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        begin(lines[i]);
        run_until_it_pauses();
        CHECK(player.time.mode == MODE_REST);
        CHECK(strncmp(player.note, "at rest", 7) == 0);
        player_fill_frame(&player);
        CHECK(strcmp(player.screen.frame.content.strip.state, "at rest") == 0);
        compare_with_plain_run(lines[i]);
        CHECK_AT_MOST(way_that_is_left(), 0.002);
        end();
    }
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
            /* with all lines of the step */
            past_choose_step(&player.past, step + 1, true);
            Status status = past_finish_work(&player.past);
            CHECK(!status || status_is_unconverged(status));
            const StepTrace *kept = &pane_run(0)->trace;
            for (int place = 0; place < kept->places; place++) {
                Trace trace;
                step_trace_fill(kept, place, &trace);
                int round = kept->place[place].round;
                if (trace.line != LINE_UPDATE)
                    continue;
                seen++;
                if (!trace.p) { /* of the first one where pins move */
                    CHECK(i == 3 && round == 0 && !trace.difference);
                    continue;
                }
                const NewtonRecord *record = &kept->records.row[round];
                double change =
                    trace.difference(trace.difference_data, record->alpha);
                rough += kept->round[round].has_remainder;
                if (kept->round[round].has_remainder &&
                    record->alpha < trace.first_alpha / ROUND_PARTS)
                    continue; /* between two kept values */
                CHECK_NEAR(change, record->change,
                           1e-7 * fabs(record->slope) * record->alpha);
            }
        }
        CHECK(seen > 60 && (i == 3 || (rough > 0) == (i > 0)));
        Trace whole;
        const StepTrace *kept = &pane_run(0)->trace;
        step_trace_fill(kept, -1, &whole);
        CHECK(whole.residual > 0);
        end();
    }
}

/* Frames until nothing is computed any more. */
static void work_off(void)
{
    while (past_works(&player.past))
        CHECK_OK(player_frame(&player));
}

/* A step that takes long is made a frame's time at a time: what concerns the
 * screen is obeyed meanwhile, one on is the same wish, Escape gives it up, and
 * everything else, too, but not where a number is typed; the bits are those of
 * the step as a whole. */
TEST(a_long_step_is_made_in_slices)
{
    const char *line = "--segments 110 --solver newton";
    Simulation plain;
    simulation_from_line(line, NULL, NULL, &plain);
    CHECK_OK(simulation_step(&plain));
    begin(line);
    player.screen.draws = true;
    player.screen.size[0] = 320;
    player.screen.size[1] = 200;
    player.screen.window = true;
    CHECK_OK(player_draw(&player));
    uint64_t start = player_hash(&player);
    obey_all((const char *const[]){"next", "colours", "next", NULL});
    static const char *const typed[] = {"Tab", "1", "Q", "Escape"};
    for (int i = 0; i < 4; i++) {
        Input input = {.kind = INPUT_KEY};
        strcpy(input.key, typed[i]);
        CHECK_OK(player_obey_input(&player, &input));
    }
    CHECK(past_works(&player.past) && player.past.step == 0 && !player.quit);
    work_off();
    CHECK(player.past.step == 1 && past_newest(&player.past) == 1);
    CHECK(player_hash(&player) == state_hash(&plain, STATE_HASH_SEED));
    obey_all((const char *const[]){"grab 0", "next", "drag 0.2 0.3", NULL});
    /* the hand follows as soon as it is there */
    CHECK(past_works(&player.past));
    work_off();
    CHECK(player.past.step == 2 && past_control(&player.past, 0)->at[0] == 0.2);
    obey_all((const char *const[]){"undo", NULL});
    work_off();
    obey_all((const char *const[]){"next", "escape", NULL});
    work_off();
    CHECK(!player.quit && player.past.step == 1 && !past_works(&player.past));
    CHECK(player_hash(&player) == state_hash(&plain, STATE_HASH_SEED));
    obey_all((const char *const[]){"next", "home", NULL});
    work_off();
    CHECK(player.past.step == 0 && player_hash(&player) == start);
    CHECK(past_newest(&player.past) == 1);
    simulation_free(&plain);
    end();
}

/* A hand that moves at every frame does not hold up time. */
TEST(time_goes_on_while_a_node_is_pulled)
{
    begin("square --segments 2");
    player.screen.draws = player.screen.window = true;
    player.screen.size[0] = player.screen.size[1] = 200;
    CHECK_OK(player_draw(&player));
    obey_all((const char *const[]){"play", "grab 3", NULL});
    for (int frame = 1; frame <= 1000 && player.past.step < 20; frame++) {
        const Command drag = {.kind = COMMAND_DRAG, .x = 0.001 * frame};
        CHECK_OK(player_obey(&player, &drag));
        player.time.due = 0; /* as if the last one were long ago */
        CHECK_OK(player_frame(&player));
    }
    CHECK(player.past.step == 20);
    end();
}

/* The clock of the window, s; < 0: the real one. */
static double wound = -1;

int __real_clock_gettime(clockid_t clock, struct timespec *now);
int __wrap_clock_gettime(clockid_t clock, struct timespec *now);

int __wrap_clock_gettime(clockid_t clock, struct timespec *now)
{
    if (wound < 0)
        return __real_clock_gettime(clock, now);
    now->tv_sec = (time_t)wound;
    now->tv_nsec = (long)(1e9 * (wound - (double)now->tv_sec));
    return 0;
}

/* At speed s time makes 60 2^s steps a second, and the window waits until the
 * next one is due. */
TEST(steps_are_due_at_the_speed_that_was_asked_for)
{
    for (int speed = -5; speed <= 3; speed++) {
        begin("square --segments 1 --stretch 1 --velocity 3,4");
        player.screen.draws = player.screen.window = true;
        player.screen.size[0] = player.screen.size[1] = 100;
        wound = 100;
        while (player.time.speed != speed)
            CHECK_OK(obey(player.time.speed < speed ? "faster" : "slower"));
        CHECK_OK(player_frame(&player)); /* the start is a frame, too */
        const double every = ldexp(1, speed < 0 ? -speed : 0) / 60;
        CHECK_NEAR(player_find_wait_time(&player), fmin(1e3 * every, 200), 1);
        const long before = player.past.step;
        for (int tick = 0; tick < 3 * 240; tick++) {
            wound += 1 / 240.0;
            CHECK_OK(player_frame(&player));
        }
        CHECK_NEAR(player.past.step - before, 180 * ldexp(1, speed),
                   fmax(1, ldexp(1, speed)));
        wound = -1;
        end();
    }
}

static const History *history_now(void)
{
    static History history;
    past_fill_history(&player.past, 0, &history);
    return &history;
}

/* Curves have the steps that are known, also of a long run the first and the
 * newest, in order; a change at an old step ends them there, and undone they
 * are as before. */
TEST(curves_span_what_is_known)
{
    begin("square --segments 1 --stretch 1 --gravity 9.81");
    for (int newest = 1; newest <= 2100; newest++) {
        CHECK_OK(obey("step"));
        if (newest % 300)
            continue;
        const History *history = history_now();
        int count = history->count, pace = 1;
        while (newest / pace > HISTORY_POINTS - 2)
            pace *= 2;
        CHECK(count == newest / pace + 1 && history->time[0] == 0);
        for (int i = 0; i < count; i++)
            CHECK_NEAR(history->time[i], 0.004 * pace * i, 1e-9);
    }
    double before = history_now()->value[1][400];
    obey_all((const char *const[]){"goto 30", "set stiffness 2e5", NULL});
    CHECK(history_now()->count == 31);
    obey_all((const char *const[]){"step", "undo", NULL});
    CHECK(history_now()->count == 2100 / 4 + 1);
    CHECK(history_now()->value[1][400] == before);
    end();
}

TESTS(NULL, NULL)
