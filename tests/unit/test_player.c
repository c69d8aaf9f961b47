/* test_player.c - curves of E along p and of energies, time between steps */
#include "test.h"
#include "attended.h"

#include <math.h>
#include <time.h>

/* The curve E(x + alpha p) - E(x), with polynomials and with contact, gives the
 * recorded change of E at the alpha of each update. */
TEST(the_curve_goes_through_the_step)
{
    static const char *const lines[] = {"square", "drop --segments 6",
                                        "dent --segments 6",
                                        "tear --segments 6", "slope"};
    for (int i = 0; i < 5; i++) {
        int rough = 0, seen = 0;
        begin_player(lines[i]);
        for (int step = 0; step < 90; step++) {
            /* the trace gets all lines of the step */
            past_set_goal(&player.past, step + 1, true);
            Status status = past_finish_work(&player.past);
            CHECK(!status || status_is_unconverged(status));
            const StepTrace *kept = &get_past_pane(0)->trace;
            for (int place = 0; place < kept->position_count; place++) {
                NewtonTrace trace;
                step_trace_read_position(kept, place, &trace);
                int iterate = kept->position[place].iterate;
                if (trace.at_line != LINE_UPDATE)
                    continue;
                seen++;
                if (!trace.p) { /* the first update with moving pins has no p */
                    CHECK(i == 3 && iterate == 0 && !trace.energy_difference);
                    continue;
                }
                const NewtonRecord *record = &kept->records.record[iterate];
                double change = trace.energy_difference(trace.difference_data,
                                                        record->alpha);
                rough += kept->iterate[iterate].has_remainder;
                if (kept->iterate[iterate].has_remainder &&
                    record->alpha < trace.first_alpha / SAMPLE_INTERVALS)
                    continue; /* alpha is between two samples of E */
                CHECK_NEAR(change, record->energy_change,
                           1e-7 * fabs(record->slope) * record->alpha);
            }
        }
        CHECK(seen > 60 && (i == 3 || (rough > 0) == (i > 0)));
        NewtonTrace whole;
        const StepTrace *kept = &get_past_pane(0)->trace;
        step_trace_read_position(kept, -1, &whole);
        CHECK(whole.residual > 0);
        end_player();
    }
}

/* Time of the window, s; < 0: the real clock */
static double fake_time = -1;

int __real_clock_gettime(clockid_t clock, struct timespec *now);

int __wrap_clock_gettime(clockid_t clock, struct timespec *now)
{
    if (fake_time < 0)
        return __real_clock_gettime(clock, now);
    now->tv_sec = (time_t)fake_time;
    now->tv_nsec = (long)(1e9 * (fake_time - (double)now->tv_sec));
    return 0;
}

static void begin_window(const char *line)
{
    begin_player(line);
    player.screen.draws_frames = true;
    player.screen.window = &window_sdl;
    player.screen.paper_size[0] = player.screen.paper_size[1] = 100;
    fake_time = 100;
}

static void make_frames(int ticks)
{
    while (ticks-- > 0) {
        fake_time += 1 / 240.0;
        CHECK_OK(player_make_frame(&player));
    }
}

/* Speed s makes 60 2^s steps a second; the window waits for the next one. */
TEST(steps_are_due_at_the_speed_that_was_asked_for)
{
    for (int speed = -5; speed <= 3; speed++) {
        begin_window("square --segments 1 --stretch 1 --velocity 3,4");
        while (player.play.log_speed != speed)
            CHECK_OK(obey_command(player.play.log_speed < speed ? "faster"
                                                                : "slower"));
        CHECK_OK(player_make_frame(&player)); /* frame of the start */
        const double every = ldexp(1, speed < 0 ? -speed : 0) / 60;
        CHECK_NEAR(player_find_wait_time(&player), fmin(1e3 * every, 200), 1);
        const long before = player.past.shown_step;
        fake_time += 9 * every;
        CHECK(player_find_wait_time(&player) == 0);
        fake_time -= 9 * every;
        make_frames(3 * 240);
        CHECK_NEAR(player.past.shown_step - before, 180 * ldexp(1, speed),
                   fmax(1, ldexp(1, speed)));
        fake_time = -1;
        end_player();
    }
}

/* While the overview is open, its scenes step in each frame; the run waits. */
TEST(the_overview_is_alive)
{
    const FrameContent *content = &player.screen.frame.content;
    begin_window("square");
    CHECK_OK(obey_command("sheet"));
    make_frames(4 * 8);
    for (int frames = 1; frames < 20; frames++, make_frames(4))
        for (int i = 0; i < content->sheet.cells; i++) {
            const Simulation *cell = content->sheet.cell[i].simulation;
            const bool moves = cell->scene->traits & HAS_TIME;
            if (i > 0) /* cell 0 shows pages, whose runs may end */
                assert_int_equal(cell->steps, moves ? frames + 2 : 0);
        }
    assert_int_equal(player.past.shown_step, 0);
    fake_time = -1;
    end_player();
}

static const History *get_history(void)
{
    static History history;
    past_fill_history(&player.past, 0, &history);
    return &history;
}

/* Curves show the known steps in order, of a long run every second or fourth
 * step. An edit at an old step shortens the curves, and undo restores them. */
TEST(curves_span_what_is_known)
{
    begin_player("square --segments 1 --stretch 1 --gravity 9.81");
    for (int newest = 1; newest <= 2100; newest++) {
        CHECK_OK(obey_command("step"));
        if (newest % 300)
            continue;
        const History *history = get_history();
        int count = history->point_count, pace = 1;
        while (newest / pace > HISTORY_MAX_POINTS - 2)
            pace *= 2;
        CHECK(count == newest / pace + 1 && history->time[0] == 0);
        for (int i = 0; i < count; i++)
            CHECK_NEAR(history->time[i], 0.004 * pace * i, 1e-9);
    }
    double before = get_history()->value[1][400];
    CHECK_OK(obey_command("goto 30"));
    CHECK_OK(obey_command("set stiffness 2e5"));
    CHECK(get_history()->point_count == 31);
    CHECK_OK(obey_command("step"));
    CHECK_OK(obey_command("undo"));
    CHECK(get_history()->point_count == 2100 / 4 + 1);
    CHECK(get_history()->value[1][400] == before);
    end_player();
}

TESTS(NULL, NULL)
