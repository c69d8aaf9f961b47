/* What single commands do: walking through steps, changing a run, taking a step
 * again, panes, pins and hands, beginning anew, keeping pictures, the screen.
 */
#include "test.h"
#include "attended.h"

#include <math.h>
#include <sys/stat.h>

#include "base/clock.h"
#include "model/pull_energy.h"
#include "picture/picture.h"
#include "scenes/scene.h"

/* ---- walking ------------------------------------------------------------ */

/* Line by line back over the first line of a step: to the last of the step
 * before. */
TEST(lines_lead_back_into_the_step_before)
{
    begin("square --segments 2");
    obey_all(
        (const char *const[]){"step", "step", "finer", "finer", "back", NULL});
    CHECK(player.past.step == 2 && side(0)->place > 0);
    while (side(0)->place > 0)
        CHECK_STATUS(obey("back"), STATUS_OK);
    CHECK(player.past.step == 2);
    CHECK_STATUS(obey("back"), STATUS_OK);
    CHECK(player.past.step == 1 &&
          side(0)->place == machine(0)->rounds.places - 1);
    end();
}

/* Where one lane has come to the end of its step, it waits there for the
 * other. */
TEST(panes_wait_for_each_other)
{
    begin("square --segments 3 --tolerance 0.5,1e-9");
    obey_all((const char *const[]){"finer", "next", NULL});
    CHECK(machine(0)->rounds.places < machine(1)->rounds.places);
    bool waited = false;
    for (int i = 0; i < 1000 && player.past.step == 1; i++) {
        for (int k = 0; k < 2; k++)
            CHECK(side(k)->place >= 0 &&
                  side(k)->place < machine(k)->rounds.places);
        waited = waited || side(0)->place == machine(0)->rounds.places - 1;
        CHECK_STATUS(obey("next"), STATUS_OK);
    }
    CHECK(waited && player.past.step == 2);
    end();
}

/* Forward Euler explodes within 30 steps.  Beside others it ends there: its
 * pane goes back to a state of the square's own size, says so, and keeps the
 * energies of that; time is that of those who go on. */
TEST(a_pane_that_fails_leaves_the_others_alone)
{
    begin_script("0 play\n60 pause\n",
                 "square --integrator forward-euler,symplectic-euler");
    CHECK_STATUS(player_run(&player), STATUS_OK);
    CHECK(player.past.step == 60 && past_panes(&player.past) == 2);
    long last = past_ended(&player.past, 0);
    CHECK(last > 5 && last < 60 && past_ended(&player.past, 1) < 0);
    CHECK(machine(0)->outcome.extent < 10);
    CHECK(fabs(player_time(&player) - 60 * 0.004) < 1e-12);
    const History *history = &past_curves(&player.past, 0)->history;
    CHECK(history->count > 1);
    CHECK(history->high <= 10 * history->value[0][0]); /* J */
    char words[32];
    snprintf(words, sizeof words, "ended at step %ld", last);
    player_fill(&player);
    CHECK(strstr(player.show.pane[0].label, words) != NULL);
    CHECK(strstr(player.show.pane[1].label, "ended") == NULL);
    CHECK(strstr(player.show.time_text, "t = 0.24 s") != NULL);
    CHECK_STATUS(player_show(&player, 2, false, THEN_NOTHING),
                 STATUS_OK); /* it was alive there */
    player_fill(&player);
    CHECK(strstr(player.show.pane[0].label, "ended") == NULL);
    CHECK_STATUS(player_step(&player), STATUS_OK); /* and goes on from there */
    CHECK(player.past.step == 3);
    CHECK(fabs(machine_time(machine(0)) - 3 * 0.004) < 1e-12);
    end();
}

/* Whatever a list varies, the panes say. */
TEST(every_list_labels_its_panes)
{
    static const char *const lines[] = {
        "square --gravity 1,9.81",
        "square --density 500,1000",
        "square --side 1,2",
        "square --turn 0,30",
        "square --yield 0.1,0.2",
        "square --tear 0.5,0.8",
        "square --cells on,off",
        "square --damping 0,0.01",
        "square --stiffness 1e4,1e5",
        "drop --friction 0,0.3",
        "drop --slip-speed 0.001,0.002",
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        begin(lines[i]);
        player_fill(&player);
        CHECK(side(0)->label[0] && side(1)->label[0]);
        CHECK(strcmp(side(0)->label, side(1)->label) != 0);
        end();
    }
    begin("square --turn 0,30 --stiffness 1e4,1e5");
    player_fill(&player);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < i; k++)
            CHECK(strcmp(side(i)->label, side(k)->label) != 0);
    end();
}

static bool next_page_is_lit(const char *line)
{
    bool lit = false;
    begin(line);
    player.rests = true;
    player_fill(&player);
    for (int i = 0; i < player.show.chips; i++)
        if (strcmp(player.show.chip[i].key, "PgDn") == 0)
            lit = player.show.chip[i].lit;
    end();
    return lit;
}

/* Where a page is over, the next one is offered; behind the last there is none.
 */
TEST(the_last_page_offers_no_next_one)
{
    CHECK(next_page_is_lit("--lecture mesh"));
    CHECK(!next_page_is_lit("--lecture trust"));
}

/* A square at rest with folded cells says why they may stay. */
TEST(folded_cells_at_rest_are_explained)
{
    begin("square --segments 16");
    for (int i = 0; i < 3000 && !player.paused; i++) {
        CHECK_STATUS(player_step(&player), STATUS_OK);
        player_pause_if_due(&player);
    }
    CHECK(player.rests);
    player_fill(&player);
    CHECK(pane_folded(&player.show.pane[0]) > 0);
    CHECK(strstr(player.note, "--cells on forbids it") != NULL);
    end();
}

/* The row's h follows the dial. */
TEST(numbers_follow_the_scene)
{
    begin("dial");
    for (int i = 0; i < 30; i++)
        CHECK_STATUS(player_step(&player), STATUS_OK);
    char value[32];
    double h = player_simulation(&player)->options.timestep;
    player_fill(&player);
    snprintf(value, sizeof value, "%.4g s", h);
    CHECK(h > 0.01 && strcmp(player.show.setting[0].name, "h") == 0);
    CHECK(strcmp(player.show.setting[0].value, value) == 0);
    end();
}

TEST(running_leaves_the_lines)
{
    begin("square --segments 2");
    obey_all((const char *const[]){"finer", "finer", "next", NULL});
    CHECK(side(0)->place == 0 && player.paused);
    CHECK_STATUS(obey("play"), STATUS_OK);
    CHECK(side(0)->place == -1 && !player.paused);
    CHECK(player.fine == 2);
    CHECK_STATUS(obey("finer"), STATUS_OK);
    CHECK(player.fine == 0);
    end();
}

/* Between two lines the square is where it was, then where it will be. */
TEST(glides_begin_and_end_at_lines)
{
    begin("square --segments 2");
    CHECK_STATUS(view_create_surface(320, 200, &player.view), STATUS_OK);
    player.window = true;
    enum { SIZE = 18 };
    double before[SIZE];
    obey_all((const char *const[]){"finer", "finer", "next", NULL});
    const Rounds *rounds = &machine(0)->rounds;
    while (rounds->place[side(0)->place].line != LINE_SEARCH)
        CHECK_STATUS(obey("next"), STATUS_OK);
    memcpy(before, side(0)->from, sizeof before);
    CHECK_STATUS(obey("next"), STATUS_OK); /* line 6 moves the square */
    CHECK_SAME_BITS(glide_between(&player, 0, 1), before, SIZE);
    Trace trace;
    const double *after = rounds_trace(rounds, side(0)->place, &trace);
    CHECK(after && memcmp(after, before, sizeof before) != 0);
    CHECK_SAME_BITS(glide_between(&player, 0, 0), after, SIZE);

    /* 1 ... 0 and flat at both ends: a fifth of the time before the end about
     * a tenth of the way is left, and never less than nothing. */
    player.glide = clock_now() - 0.2;
    double rest = glide_rest(&player);
    CHECK(rest >= 0 && rest < 0.105);
    player.glide = clock_now() - 1;
    CHECK(glide_rest(&player) == 0 && player.glide == 0);
    end();
}

/* ---- changing ----------------------------------------------------------- */

/* What panes are compared by changes in one of them, the rest in all. */
TEST(changes_are_for_one_pane_or_all)
{
    begin("square --segments 2 --timestep 0.01,0.005");
    obey_all(
        (const char *const[]){"set timestep 0.002", "set stiffness 2e5", NULL});
    CHECK(past_control(&player.past, 0)->options.timestep == 0.002);
    CHECK(past_control(&player.past, 1)->options.timestep == 0.005);
    for (int i = 0; i < 2; i++)
        CHECK(past_control(&player.past, i)->options.stiffness == 2e5);
    obey_all((const char *const[]){"pane 1", "pause", "set segments 3", NULL});
    CHECK(player.active == 1 && player.paused && player.past.step == 0);
    for (int i = 0; i < 2; i++)
        CHECK(past_start(&player.past, i)->options.segments == 3);
    CHECK_STATUS(obey("play"), STATUS_OK);
    CHECK_STATUS(obey("set segments 2"), STATUS_OK);
    CHECK(!player.paused);
    end();
}

/* The default is that of the command line in its own scene, and the scene's in
 * every other. */
TEST(defaults_are_the_scene_s)
{
    begin("square --timestep 0.003");
    obey_all(
        (const char *const[]){"set timestep 0.001", "default timestep", NULL});
    CHECK(past_control(&player.past, 0)->options.timestep == 0.003);
    CHECK_STATUS(obey("scene hang"), STATUS_OK);
    double own = past_start(&player.past, 0)->options.timestep;
    CHECK(own != 0.003);
    obey_all(
        (const char *const[]){"set timestep 0.001", "default timestep", NULL});
    CHECK(past_control(&player.past, 0)->options.timestep == own);
    end();
}

/* ---- the step once more ------------------------------------------------- */

/* The step is made again where it was; a run goes on running, and a walk stays
 * at its line. */
TEST(a_step_is_taken_again_in_its_place)
{
    begin("square --segments 3 --stretch 0.6");
    obey_all((const char *const[]){"next", "next", "play", "projection", NULL});
    CHECK(player.past.step == 2 && !player.paused);
    CHECK(side(0)->ghost != NULL);
    obey_all((const char *const[]){"finer", "finer", "next", NULL});
    CHECK(player.past.step == 3 && side(0)->ghost == NULL);
    Station at;
    do {
        CHECK_STATUS(obey("next"), STATUS_OK);
        at = machine(0)->rounds.place[side(0)->place];
    } while (at.round < 1 || at.line != LINE_SOLVE);
    CHECK(player.past.step == 3);
    CHECK_STATUS(obey("projection"), STATUS_OK);
    CHECK(player.past.step == 3 && player.paused);
    CHECK(machine(0)->rounds.place[side(0)->place].round == at.round);
    CHECK(machine(0)->rounds.place[side(0)->place].line == LINE_SOLVE);
    end();
}

/* ---- panes -------------------------------------------------------------- */

/* ---- hands -------------------------------------------------------------- */

TEST(hands_pin_and_hold)
{
    begin("square --segments 2");
    for (int i = 0; i < 2; i++) {
        CHECK_STATUS(obey("pin 3"), STATUS_OK);
        CHECK(simulation_is_pinned(player_simulation(&player), 3) == (i == 0));
    }
    CHECK_STATUS(obey("drag 1 1"), STATUS_INVALID_INPUT);
    CHECK_STATUS(obey("grab 0"), STATUS_OK);
    CHECK(player.holds);
    CHECK_STATUS(obey("step"), STATUS_OK); /* nothing let go of it */
    CHECK((past_control(&player.past, 0)->hand >= 0) && player.holds);
    for (int y = 1; y < 3; y++) { /* also straight upwards */
        obey_all((const char *const[]){y == 1 ? "drag 1 1" : "drag 1 2", "step",
                                       NULL});
        const Pull *hand = hand_energy_of(&player_simulation(&player)->system);
        CHECK(hand && hand->target[0] == 1 && hand->target[1] == y);
    }
    CHECK_STATUS(obey("release"), STATUS_OK);
    CHECK(!(past_control(&player.past, 0)->hand >= 0) && !player.holds);
    /* Back where it was held: nobody holds it now. */
    CHECK_STATUS(obey("goto 1"), STATUS_OK);
    CHECK((past_control(&player.past, 0)->hand >= 0) && !player.holds);
    CHECK_STATUS(obey("set stiffness 2e5"), STATUS_OK);
    CHECK_STATUS(obey("step"), STATUS_OK);
    CHECK(!(past_control(&player.past, 0)->hand >= 0));
    CHECK_STATUS(obey("goto 0"), STATUS_OK);
    CHECK_STATUS(obey("goto 99"), STATUS_OK); /* the newest there is */
    CHECK(player.past.step == past_newest(&player.past) &&
          player.past.step > 0);
    end();
}

/* ---- beginning ---------------------------------------------------------- */

TEST(scenes_begin)
{
    begin("square --segments 2 --tolerance 0.1 --speed 8");
    int speed = player.speed;
    CHECK(speed != 0);
    for (int i = 0; i < 3000 && !player.paused; i++) {
        CHECK_STATUS(player_step(&player), STATUS_OK);
        player_pause_if_due(&player);
    }
    CHECK(player.halted); /* at rest: nobody asked for this pause */
    CHECK_STATUS(obey("scene drop"), STATUS_OK);
    CHECK(!player.paused && player.past.step == 0 && player.speed == speed);
    obey_all((const char *const[]){"pause", "scene hang", NULL});
    CHECK(player.paused); /* somebody did */
    CHECK_STATUS(obey("start 0.3 -0.2"), STATUS_INVALID_INPUT);
    obey_all((const char *const[]){"scene landscape", "start 0.3 -0.2", NULL});
    CHECK(past_start(&player.past, 0)->options.start[0] == 0.3);
    CHECK(past_start(&player.past, 0)->options.start[1] == -0.2);
    end();
}

/* Of several panes each must have come to rest. */
TEST(rest_is_that_of_all_panes)
{
    begin("square --segments 2 --tolerance 1e-6,10");
    CHECK_STATUS(obey("play"), STATUS_OK);
    for (int i = 0; i < 5; i++)
        CHECK_STATUS(player_step(&player), STATUS_OK);
    CHECK(machine(0)->outcome.updates > 0 && machine(1)->outcome.updates == 0);
    player_pause_if_due(&player);
    CHECK(!player.paused && !player.rests);
    end();
}

/* ---- keeping ------------------------------------------------------------ */

static long size_of(const char *name)
{
    struct stat info;
    return stat(name, &info) == 0 ? (long)info.st_size : -1;
}

static bool same_files(const char *one, const char *other)
{
    FILE *a = fopen(one, "rb"), *b = fopen(other, "rb");
    assert_true(a && b);
    int c, d;
    do {
        c = getc(a);
        d = getc(b);
    } while (c == d && c != EOF);
    fclose(a);
    fclose(b);
    return c == d;
}

/* Pictures have names of their own, and show no message of before. */
TEST(pictures_are_kept)
{
    static const char *const name[] = {
        "elasto_square_000000.png", "elasto_square_000000_2.png",
        "elasto_square_000000.mp4", "elasto_square_000000_2.mp4"};
    char folder[] = "/tmp/elasto-test-XXXXXX", before[4096];
    assert_non_null(getcwd(before, sizeof before));
    assert_non_null(mkdtemp(folder));
    assert_int_equal(chdir(folder), 0);
    begin("square --segments 2");
    CHECK_STATUS(obey("pause"), STATUS_OK);
    CHECK_STATUS(obey("shot"), STATUS_OK);
    CHECK(strcmp(player.note, "saved elasto_square_000000.png") == 0);
    CHECK_STATUS(obey("shot"), STATUS_OK);
    CHECK(size_of(name[0]) > 1000 && same_files(name[0], name[1]));

    /* A film begins with what is seen. */
    CHECK_STATUS(obey("film"), STATUS_INVALID_INPUT);
    CHECK_STATUS(view_create_surface(320, 200, &player.view), STATUS_OK);
    bool films = system("ffmpeg -version >/dev/null 2>&1") == 0;
    if (!films) { /* the note says what to install */
        CHECK_STATUS(obey("film"), STATUS_OK);
        CHECK(strstr(player.note, "needs the program ffmpeg") != NULL);
    }
    for (int i = 2; i < 4 && films; i++) {
        CHECK_STATUS(player_draw(&player), STATUS_OK);
        CHECK_STATUS(obey("film"), STATUS_OK);
        CHECK(player.sampled == -1); /* a frame comes before the next step */
        CHECK_STATUS(player_draw(&player), STATUS_OK);
        CHECK(player.recording.film.frames == 1);
        CHECK_STATUS(obey("film"), STATUS_OK);
        CHECK(strstr(player.note, "film ends: 1 frames, in ") != NULL);
        CHECK(size_of(name[i]) > 1000);
    }
    end();
    for (int i = 0; i < (films ? 4 : 2); i++)
        CHECK(unlink(name[i]) == 0);
    assert_int_equal(chdir(before), 0);
    CHECK(rmdir(folder) == 0);
}

/* ---- the screen --------------------------------------------------------- */

TEST(the_screen_obeys)
{
    begin("square --segments 2");
    for (int i = 0; i < 30; i++)
        CHECK_STATUS(obey("faster"), STATUS_OK);
    CHECK(player.speed == SPEED_MOST);
    for (int i = 0; i < 30; i++)
        CHECK_STATUS(obey("slower"), STATUS_OK);
    CHECK(player.speed == SPEED_LEAST);
    obey_all((const char *const[]){"card 1", "enlarge 2", NULL});
    CHECK(player.closed == 2 && player.large == 2);
    obey_all((const char *const[]){"card 1", "enlarge 2", NULL});
    CHECK(player.closed == 0 && player.large == -1);
    /* A click on the title of a closed card opens it. */
    obey_all((const char *const[]){"card 1", "enlarge 1", NULL});
    CHECK(player.closed == 0 && player.large == -1);
    CHECK_STATUS(obey("enlarge 5"), STATUS_OK); /* closed from the start */
    player_fill(&player);
    CHECK(!(player.show.closed >> 5 & 1) && player.large == -1);
    CHECK_STATUS(obey("card 5"), STATUS_OK);
    CHECK_STATUS(obey("card 99"), STATUS_INVALID_INPUT);
    /* Another scene has cards of its own, and none of them is enlarged. */
    obey_all((const char *const[]){"card 1", "enlarge 2", "restart", NULL});
    CHECK(player.closed == 2 && player.large == 2);
    CHECK_STATUS(obey("scene drop"), STATUS_OK);
    CHECK(player.closed == 0 && player.large == -1);
    end();
}

/* What is seen moves by metres of the scene, up where y grows. */
TEST(the_camera_moves_by_metres)
{
    begin("square --segments 2");
    CHECK_STATUS(view_create_surface(800, 600, &player.view), STATUS_OK);
    CHECK_STATUS(player_draw(&player), STATUS_OK);
    Layout layout = show_layout(&player.show, 800, 600);
    Camera camera = show_camera(&player.show, &layout, 0);
    const double at[2] = {0, 0};
    double from[2], to[2];
    camera_pixel(&camera, at, from);
    CHECK_STATUS(obey("pan 0.1 0.2"), STATUS_OK);
    player_fill(&player);
    Camera moved = show_camera(&player.show, &layout, 0);
    camera_pixel(&moved, at, to);
    CHECK_NEAR(to[0] - from[0], 0.1 * camera.scale[0], 1e-6);
    CHECK_NEAR(to[1] - from[1], -0.2 * camera.scale[1], 1e-6);
    CHECK_STATUS(obey("fit"), STATUS_OK);
    player_fill(&player);
    moved = show_camera(&player.show, &layout, 0);
    camera_pixel(&moved, at, to);
    CHECK_SAME_BITS(to, from, 2);
    end();
}

TESTS(NULL, NULL)
