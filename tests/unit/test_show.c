/* Frames: what is drawn of a Show, where, and what the mouse finds there. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/cards.h"
#include "picture/colour_map.h"
#include "picture/exhibits.h"
#include "picture/handles.h"
#include "picture/picture.h"
#include "picture/marks.h"
#include "picture/square_pen.h"
#include "picture/square_picture.h"
#include "scenes/scene.h"
#include "scenes/small_scenes.h"
#include "test.h"

/* A scene after some steps, and what a player would show of it. */
typedef struct Stand {
    Simulation simulation;
    History history;
    Trail trail;
    Show show;
    Paper paper;
} Stand;

static void stand_up(const char *line, int steps, int width, int height,
                     Stand *stand)
{
    memset(stand, 0, sizeof *stand);
    simulation_from_line(line, NULL, NULL, &stand->simulation);
    history_clear(&stand->history);
    show_sample(&stand->simulation, &stand->history, &stand->trail);
    for (int i = 0; i < steps; i++) {
        Status status = simulation_step(&stand->simulation);
        assert_true(!status || status_is_unconverged(status) ||
                    stand->simulation.done);
        show_sample(&stand->simulation, &stand->history, &stand->trail);
    }
    show_create(&stand->simulation, &stand->show);
    stand->show.pane[0].history = &stand->history;
    stand->show.pane[0].trail = &stand->trail;
    assert_int_equal(paper_create(width, height, &stand->paper), 0);
}

static void take_down(Stand *stand)
{
    paper_free(&stand->paper);
    simulation_free(&stand->simulation);
}

static Colour pixel(const Stand *stand, int x, int y)
{
    return stand->paper.canvas.pixels[y * stand->paper.canvas.width + x];
}

/* Pixels of exactly this colour inside a box. */
static int count_colour(const Stand *stand, Box box, Colour colour)
{
    int count = 0;
    for (int j = box.y; j < box.y + box.height; j++)
        for (int i = box.x; i < box.x + box.width; i++)
            count += pixel(stand, i, j) == colour;
    return count;
}

static Box whole(const Stand *stand)
{
    return (Box){0, 0, stand->paper.canvas.width, stand->paper.canvas.height};
}

/* Two drawings of the same state are equal in every pixel; so is a second
 * one on the same paper, which has kept something. */
TEST(frames_are_repeatable)
{
    static Stand stand[2];
    for (const Scene *scene = scenes; scene->name; scene++) {
        for (int i = 0; i < 2; i++) {
            stand_up(scene->name, 2, 700, 560, &stand[i]);
            stand[i].show.closed = 0;
            if (i == 1) /* measured run times */
                stand[1].simulation.exhibit.race =
                    stand[0].simulation.exhibit.race;
            show_describe(&stand[i].show);
            show_draw(&stand[i].paper, &stand[i].show);
        }
        show_draw(&stand[0].paper, &stand[0].show);
        assert_memory_equal(stand[0].paper.canvas.pixels,
                            stand[1].paper.canvas.pixels, 700 * 560 * 4);
        take_down(&stand[0]);
        take_down(&stand[1]);
    }
}

/* Bare means bare: white, blue and what lies between. */
TEST(a_bare_square_is_the_slide)
{
    static Stand stand;
    stand_up("square", 3, 300, 300, &stand);
    stand.show.bare = true;
    show_draw(&stand.paper, &stand.show);
    int blue = 0;
    for (int i = 0; i < 300 * 300; i++) {
        Colour at = stand.paper.canvas.pixels[i];
        CHECK((at & 255) == 255 && (at >> 8 & 255) == (at >> 16 & 255));
        blue += at == COLOUR_X;
    }
    CHECK(blue > 1000);
    take_down(&stand);
}

/* Cells below five pixels are faces: inside the outline each pixel is covered;
 * what has folded over is dark, and stands above the rest. */
TEST(fine_squares_are_faces)
{
    static Stand stand;
    stand_up("square --segments 90 --turn 17 --stretch 1.3", 0, 400, 400,
             &stand);
    stand.show.bare = true;
    show_draw(&stand.paper, &stand.show);
    int white = 0, covered = 0;
    for (int j = 0; j < 400; j++) {
        const Colour *row = stand.paper.canvas.pixels + 400 * j;
        int left = 0, right = 399;
        while (left < 400 && row[left] == COLOUR_WHITE)
            left++;
        while (right > left && row[right] == COLOUR_WHITE)
            right--;
        for (int i = left; i < right; i++)
            white += row[i] == COLOUR_WHITE;
        covered += right > left ? right - left + 1 : 0;
    }
    double width = 400 / 1.75; /* of the side; a pixel of outline around it */
    CHECK(white == 0);
    CHECK_NEAR(covered, width * width / 1.3, 8 * width);
    Box all = {0, 0, 400, 400};
    CHECK(count_colour(&stand, all, COLOUR_FOLDED) == 0);
    double *x = stand.simulation.run[0].x;
    int row = 91, middle = 45 * row + 45;
    for (int k = 0; k < 2; k++) { /* two nodes trade their places */
        double kept = x[2 * middle + k];
        x[2 * middle + k] = x[2 * (middle + 3 * row) + k];
        x[2 * (middle + 3 * row) + k] = kept;
    }
    show_draw(&stand.paper, &stand.show);
    int dark = count_colour(&stand, all, COLOUR_FOLDED);
    CHECK(dark > 10 && dark < 400);
    stand.show.strain = true;
    show_draw(&stand.paper, &stand.show);
    CHECK(count_colour(&stand, all, COLOUR_FOLDED) == dark);
    Colour stretched = stand.paper.canvas.pixels[400 * 150 + 200];
    CHECK((stretched >> 16 & 255) > (stretched & 255));
    take_down(&stand);
}

/* Any size can be drawn of any scene, all there is at once, and blown-up
 * positions do no harm. */
TEST(every_size_is_drawn)
{
    const int sizes[][2] = {{1, 1},     {1, 900},    {2000, 3}, {199, 201},
                            {400, 300}, {1500, 999}, {900, 900}};
    const int count = tests_are_long() ? 7 : 5;
    static Stand stand;
    for (const Scene *scene = scenes; scene->name; scene++)
        for (int i = 0; i < count; i++)
            for (int mode = 0; mode < 4; mode++) {
                if (!tests_are_long() && (scene - scenes + i + mode) % 2)
                    continue;
                stand_up(scene->name, mode, sizes[i][0], sizes[i][1], &stand);
                Show *show = &stand.show;
                show->strain = mode & 1;
                show->bare = mode == 3;
                show->page.kind = mode == 2 ? PAGE_HELP : PAGE_NONE;
                show->closed = 0;
                show->pane[0].trouble = STATUS_NOT_FINITE;
                show->hover = (Pick){PICK_SPRING, 0, 0, {0, 0}};
                if (stand.simulation.runs > 0 && mode > 0) {
                    double *x = stand.simulation.run[0].x;
                    x[0] = NAN;
                    x[1] = mode == 1 ? 1e300 : -INFINITY;
                }
                show_describe(show);
                show_draw(&stand.paper, show);
                take_down(&stand);
            }
}

/* Nothing of the stage is drawn over the cards, however near it is seen. */
TEST(the_stage_keeps_to_itself)
{
    static Stand stand;
    stand_up("square", 0, 1280, 800, &stand);
    text_free(stand.paper.text); /* letters have colours too */
    stand.paper.text = NULL;
    Layout layout = show_layout(&stand.show, 1280, 800);
    show_draw(&stand.paper, &stand.show);
    int inside = count_colour(&stand, layout.stage, COLOUR_X);
    CHECK(inside > 1000);
    show_zoom(&stand.show, &layout, layout.stage.x + 200, 400, 5);
    show_draw(&stand.paper, &stand.show);
    CHECK(count_colour(&stand, layout.stage, COLOUR_X) != inside);
    CHECK(count_colour(&stand, whole(&stand), COLOUR_X) ==
          count_colour(&stand, layout.stage, COLOUR_X));
    take_down(&stand);
}

/* Every node is picked where it is drawn, also after zooming; so is the middle
 * of a spring, and left or right of the square there is nothing. */
TEST(the_mouse_finds_nodes_and_springs)
{
    static Stand stand;
    stand_up("square", 2, 1280, 800, &stand);
    Layout layout = show_layout(&stand.show, 1280, 800);
    const System *system = &stand.simulation.system;
    const double *x = stand.simulation.run[0].x;
    for (int zoomed = 0; zoomed < 2; zoomed++) {
        Camera camera = show_camera(&stand.show, &layout, 0);
        for (int i = 0; i < system->nodes; i++) {
            double at[2];
            camera_pixel(&camera, x + 2 * i, at);
            if (!box_contains(layout.stage, at[0] - 2, at[1] + 3))
                continue;
            Pick pick = show_pick(&stand.show, &layout, at[0] - 2, at[1] + 3);
            CHECK(pick.kind == PICK_NODE && pick.index == i);
            CHECK_NEAR(pick.point[0], x[2 * i] - 2 / camera.scale[0], 1e-12);
        }
        double at[2];
        const double *a = x + 2 * system->e[0], *b = x + 2 * system->e[1];
        const double middle[2] = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
        camera_pixel(&camera, middle, at);
        Pick pick = show_pick(&stand.show, &layout, at[0], at[1] + 1);
        CHECK(pick.kind == PICK_SPRING && pick.index == 0);
        show_zoom(&stand.show, &layout, at[0], at[1], 2.5);
    }
    stand.show.lens = LENS_FITS;
    CHECK(show_pick(&stand.show, &layout, 5, 200).kind == PICK_NONE);
    CHECK(show_pick(&stand.show, &layout, 1100, 200).kind == PICK_NONE);
    take_down(&stand);
}

/* A spring is found within 8 pixels, half as far as a node; a broken one is
 * not; later than at the start a side is its springs. */
TEST(springs_are_found_near_them)
{
    static Stand stand;
    stand_up("square", 2, 1280, 800, &stand);
    stand.show.paused = true;
    Layout layout = show_layout(&stand.show, 1280, 800);
    Camera camera = show_camera(&stand.show, &layout, 0);
    System *system = &stand.simulation.system;
    const double *x = stand.simulation.run[0].x;
    int left = 0; /* the spring of nodes 0 and 1, in the left column */
    while (system->e[2 * left] != 0 || system->e[2 * left + 1] != 1)
        left++;
    const double middle[2] = {0.5 * (x[0] + x[2]), 0.5 * (x[1] + x[3])};
    double at[2];
    camera_pixel(&camera, middle, at);
    Pick pick = show_pick(&stand.show, &layout, at[0] - 6, at[1]);
    CHECK(pick.kind == PICK_SPRING && pick.index == left);
    pick = show_pick(&stand.show, &layout, at[0] - 12, at[1]);
    CHECK(pick.kind == PICK_NONE);
    system->k[left] = 0;
    system->breaks = true;
    pick = show_pick(&stand.show, &layout, at[0] - 6, at[1]);
    CHECK(pick.kind == PICK_NONE);
    take_down(&stand);
}

/* Before the first step of a paused square its sides are edges. */
TEST(edges_set_the_stretch)
{
    static Stand stand;
    stand_up("square", 0, 1280, 800, &stand);
    stand.show.paused = true;
    Layout layout = show_layout(&stand.show, 1280, 800);
    Camera camera = show_camera(&stand.show, &layout, 0);
    for (int side = 0; side < 2; side++) {
        const double world[2] = {side ? 0.7 : -0.7, 0.125};
        double at[2];
        camera_pixel(&camera, world, at);
        Pick pick = show_pick(&stand.show, &layout, at[0], at[1]);
        CHECK(pick.kind == PICK_EDGE && pick.index == side);
    }
    take_down(&stand);
}

/* The landscape gives back the point that is drawn there. */
TEST(maps_are_where_they_seem)
{
    static Stand stand;
    stand_up("landscape --start 0.9,0.8 --tolerance 1e9", 0, 900, 700, &stand);
    Layout layout = show_layout(&stand.show, 900, 700);
    text_free(stand.paper.text);
    stand.paper.text = NULL;
    show_draw(&stand.paper, &stand.show);
    Camera camera = show_camera(&stand.show, &layout, 0);
    double at[2], sum[3] = {0};
    camera_pixel(&camera, (const double[2]){0.9, 0.8}, at);
    for (int j = (int)at[1] - 30; j < at[1] + 30; j++)
        for (int i = (int)at[0] - 30; i < at[0] + 30; i++)
            if (pixel(&stand, i, j) == COLOUR_TEXT) {
                sum[0] += i + 0.5;
                sum[1] += j + 0.5;
                sum[2] += 1;
            }
    CHECK(sum[2] > 50);
    Pick pick =
        show_pick(&stand.show, &layout, sum[0] / sum[2], sum[1] / sum[2]);
    CHECK(pick.kind == PICK_HANDLE && pick.index == 1);
    CHECK_NEAR(pick.point[0], 0.9, 0.01);
    CHECK_NEAR(pick.point[1], 0.8, 0.01);
    CHECK(show_pick(&stand.show, &layout, 300, 350).kind == PICK_PLACE);
    take_down(&stand);
}

/* Cells that have turned over are counted. */
TEST(folds_are_counted)
{
    static Stand stand;
    stand_up("square", 0, 400, 300, &stand);
    CHECK(pane_folded(&stand.show.pane[0]) == 0);
    double *x = stand.simulation.run[0].x;
    x[2 * 12] += 0.6; /* the middle node to the right of its neighbour */
    CHECK(pane_folded(&stand.show.pane[0]) == 2);
    take_down(&stand);
}

/* A cell is torn by each of its six springs: those between its four nodes. */
TEST(cells_are_torn_by_their_springs)
{
    static Stand stand;
    stand_up("square --segments 3", 0, 100, 100, &stand);
    System *system = &stand.simulation.system;
    system->breaks = true;
    for (int s = 0; s < system->springs; s++) {
        double k = system->k[s];
        system->k[s] = 0;
        for (int cell = 0; cell < 9; cell++) {
            int a = cell / 3 * 4 + cell % 3, ends = 0;
            for (int c = 0; c < 2; c++) {
                int node = system->e[2 * s + c];
                ends += node == a || node == a + 1 || node == a + 4 ||
                        node == a + 5;
            }
            CHECK(square_torn(system, &stand.simulation.mesh, cell) ==
                  (ends == 2));
        }
        system->k[s] = k;
    }
    take_down(&stand);
}

/* The outline is seen on all four sides, and nowhere else. */
TEST(outlines_go_round)
{
    static Stand stand;
    stand_up("square --segments 4 --stretch 1", 0, 200, 200, &stand);
    Stage stage = {.box = {0, 0, 200, 200}, .em = 10};
    const double bounds[4] = {-1, -1, 1, 1};
    stage.camera = camera_create(stage.box, bounds, false, &LENS_FITS);
    const SpringPen pen = {.paper = &stand.paper,
                           .stage = &stage,
                           .simulation = &stand.simulation};
    square_outline(&pen, stand.simulation.run[0].x, false, COLOUR_X);
    static const double side[4][2] = {{-0.5, 0}, {0.5, 0}, {0, -0.5}, {0, 0.5}};
    for (int i = 0; i < 5; i++) {
        const double middle[2] = {i < 4 ? side[i][0] : 0,
                                  i < 4 ? side[i][1] : 0};
        double at[2];
        stage_pixel(&stage, middle, at);
        Box near = {(int)at[0] - 3, (int)at[1] - 3, 7, 7};
        int touched = 49 - count_colour(&stand, near, COLOUR_WHITE);
        CHECK((touched > 6) == (i < 4));
    }
    take_down(&stand);
}

/* Blocks are lit while they are projected, where any was. */
TEST(what_is_projected_is_lit)
{
    static Stand stand;
    stand_up("square --stretch 0.6", 0, 200, 200, &stand);
    Trace trace = {
        .line = LINE_PROJECT, .x = stand.simulation.run[0].x, .projected = 3};
    stand.show.pane[0].trace = &trace;
    Stage stage = {.box = {0, 0, 200, 200}, .em = 10};
    const double bounds[4] = {-1, -1, 1, 1};
    stage.camera = camera_create(stage.box, bounds, false, &LENS_FITS);
    SpringPen pen[SIMULATION_MAX_RUNS];
    Legend legend = {0, 0};
    CHECK(square_pens(&stand.paper, &stage, &stand.show, &legend, pen));
    CHECK(pen->projected);
    trace.projected = 0; /* on demand, where it was not needed */
    CHECK(square_pens(&stand.paper, &stage, &stand.show, &legend, pen));
    CHECK(!pen->projected);
    trace.projected = 3;
    trace.line = LINE_UPDATE;
    CHECK(square_pens(&stand.paper, &stage, &stand.show, &legend, pen));
    CHECK(!pen->projected);
    take_down(&stand);
}

/* Six panes side by side, each with its own square. */
TEST(panes_are_drawn_apart)
{
    static Stand stand;
    stand_up("square", 1, 1280, 800, &stand);
    stand.show.panes = 6;
    for (int p = 1; p < 6; p++)
        stand.show.pane[p] = stand.show.pane[0];
    for (int p = 0; p < 6; p++)
        stand.show.pane[p].label = "pane";
    show_draw(&stand.paper, &stand.show);
    Layout layout = show_layout(&stand.show, 1280, 800);
    int first = count_colour(&stand, layout.pane[0], COLOUR_X);
    CHECK(first > 100);
    for (int p = 1; p < 6; p++)
        CHECK(count_colour(&stand, layout.pane[p], COLOUR_X) > first / 2);
    take_down(&stand);
}

/* The bar under the mouse is the step that is asked for. */
TEST(bars_are_steps)
{
    static Stand stand;
    static StepBar bars[500];
    stand_up("square", 0, 1280, 800, &stand);
    stand.show.bar = bars;
    for (int s = 0; s < 500; s++)
        bars[s] = (StepBar){1 + s % 5, s == 250};
    for (long count = 1; count <= 500; count += 61) {
        stand.show.bars = count;
        Layout layout = show_layout(&stand.show, 1280, 800);
        CHECK(show_step_at(&stand.show, &layout, 0) == 0);
        CHECK(show_step_at(&stand.show, &layout, 1280) == count);
        long before = 0;
        for (int x = 0; x < 1280; x++) {
            long step = show_step_at(&stand.show, &layout, x);
            CHECK(step >= before && step <= count);
            before = step;
        }
        show_draw(&stand.paper, &stand.show);
        int red = count_colour(&stand, layout.bars, COLOUR_WARNING);
        CHECK((red > 0) == (count > 250));
    }
    take_down(&stand);
}

/* A trace lights its line, the springs whose block has a negative eigenvalue,
 * the arrows, the trials. */
static double falling(const void *unused, double alpha)
{
    (void)unused;
    return 20 * alpha * alpha * alpha - 4 * alpha;
}

TEST(a_trace_is_seen)
{
    static Stand stand;
    stand_up("unprojected --filter clamp", 0, 1280, 800, &stand);
    text_free(stand.paper.text);
    stand.paper.text = NULL;
    const System *system = &stand.simulation.system;
    double *p = calloc(2 * (size_t)system->nodes, sizeof *p);
    assert_non_null(p);
    for (int i = 0; i < 2 * system->nodes; i++)
        p[i] = i % 2 ? 0 : 0.1;
    NewtonRecord records[3] = {
        {.residual = 9}, {.residual = 1}, {.residual = 0.003}};
    Trace trace = {.line = LINE_START,
                   .tolerance = 0.01,
                   .x = stand.simulation.run[0].x,
                   .projected = 52,
                   .slope = -4,
                   .residual = 2,
                   .record = records,
                   .updates = 3};
    stand.show.pane[0].trace = &trace;
    Layout layout = show_layout(&stand.show, 1280, 800);
    show_draw(&stand.paper, &stand.show);
    CHECK(count_colour(&stand, layout.stage, COLOUR_PROJECT) == 0);
    CHECK(count_colour(&stand, layout.card[1], COLOUR_LIT) > 1000);
    CHECK(count_colour(&stand, layout.card[3], COLOUR_P) > 50);
    trace.line = LINE_PROJECT;
    show_draw(&stand.paper, &stand.show);
    CHECK(count_colour(&stand, layout.stage, COLOUR_PROJECT) > 500);
    CHECK(count_colour(&stand, layout.stage, COLOUR_P) == 0);
    trace.line = LINE_SEARCH;
    trace.p = p;
    trace.difference = falling;
    trace.trials = 3;
    show_draw(&stand.paper, &stand.show);
    CHECK(count_colour(&stand, layout.stage, COLOUR_P) > 500);
    CHECK(count_colour(&stand, layout.card[2], COLOUR_WARNING) > 20);
    CHECK(count_colour(&stand, layout.card[2], COLOUR_ALPHA) == 0);
    trace.accepted = true;
    show_draw(&stand.paper, &stand.show);
    CHECK(count_colour(&stand, layout.card[2], COLOUR_ALPHA) > 20);
    free(p);
    take_down(&stand);
}

/* Values, estimates and bounds of residuals look different, and where there are
 * not values alone words above the curve say which is which. */
TEST(kinds_of_residuals_are_told_apart)
{
    static Stand stand;
    int points[3], blank[3]; /* pixels in their colour, and white above them */
    stand_up("unprojected --filter clamp", 0, 1280, 800, &stand);
    Layout layout = show_layout(&stand.show, 1280, 800);
    Box curve = layout.card[3], above = curve;
    above.height /= 3;
    for (int kind = 0; kind < 3; kind++) {
        NewtonRecord records[3] = {{.residual = 9, .kind = RESIDUAL_VALUE},
                                   {.residual = 1e-3},
                                   {.residual = 1e-4}};
        Trace trace = {.line = LINE_START,
                       .tolerance = 0.01,
                       .x = stand.simulation.run[0].x,
                       .record = records,
                       .updates = 3};
        for (int i = 1; i < 3; i++)
            records[i].kind = (ResidualKind)kind;
        stand.show.pane[0].trace = &trace;
        show_draw(&stand.paper, &stand.show);
        points[kind] = count_colour(&stand, curve, COLOUR_P);
        blank[kind] = count_colour(&stand, above, COLOUR_WHITE);
    }
    CHECK(points[0] != points[1] && points[2] < points[0]);
    CHECK(blank[1] < blank[0] - 100 && blank[2] < blank[0] - 100);
    CHECK(blank[1] != blank[2]);
    take_down(&stand);
}

/* A node or a spring under the mouse is marked, and told of beside it. */
TEST(hovers_are_seen)
{
    static Stand stand;
    stand_up("square", 1, 1280, 800, &stand);
    text_free(stand.paper.text);
    stand.paper.text = NULL;
    show_draw(&stand.paper, &stand.show);
    Layout layout = show_layout(&stand.show, 1280, 800);
    int dark = count_colour(&stand, layout.stage, COLOUR_TEXT);
    int blue = count_colour(&stand, layout.stage, COLOUR_X);
    for (PickKind kind = PICK_NODE; kind <= PICK_SPRING; kind++) {
        stand.show.hover = (Pick){kind, 0, 12, {0, 0}};
        show_draw(&stand.paper, &stand.show);
        CHECK(count_colour(&stand, layout.stage, COLOUR_TEXT) > dark + 40);
        CHECK(count_colour(&stand, layout.stage, COLOUR_X) < blue);
    }
    stand.show.hand.on = true; /* what is held is not told of */
    stand.show.hover.kind = PICK_NONE;
    show_draw(&stand.paper, &stand.show);
    CHECK(count_colour(&stand, layout.stage, COLOUR_HAND) > 20);
    take_down(&stand);
}

/* ---- what is written and plotted ---------------------------------------- */

/* Every text of a frame, and how far down it is. */
static struct Writing {
    char text[160];
    double y;
} written[500];
static int writings;

int __real_text_draw(Text *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup);
int __wrap_text_draw(Text *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup);

int __wrap_text_draw(Text *text, Canvas *canvas, const TextStyle *style,
                     double x, double y, Align align, const char *markup)
{
    if (writings < 500) {
        snprintf(written[writings].text, sizeof written->text, "%s", markup);
        written[writings++].y = y;
    }
    return __real_text_draw(text, canvas, style, x, y, align, markup);
}

/* Every line of a plot in the units of its axes. */
static struct Stroke {
    double a[2], b[2];
    Colour colour;
} plotted[4000];
static int lines;

void __real_plot_line(Paper *paper, const Plot *plot, const double *a,
                      const double *b, double width, Colour colour);
void __wrap_plot_line(Paper *paper, const Plot *plot, const double *a,
                      const double *b, double width, Colour colour);

void __wrap_plot_line(Paper *paper, const Plot *plot, const double *a,
                      const double *b, double width, Colour colour)
{
    if (lines < 4000)
        plotted[lines++] = (struct Stroke){{a[0], a[1]}, {b[0], b[1]}, colour};
    __real_plot_line(paper, plot, a, b, width, colour);
}

/* The place of a text in the frame that is drawn now; fails where it is not. */
static int drawn_text(Stand *stand, const char *text)
{
    writings = lines = 0;
    show_draw(&stand->paper, &stand->show);
    for (int i = 0; i < writings; i++)
        if (strcmp(written[i].text, text) == 0)
            return i;
    print_error("not written: %s\n", text);
    fail();
    return -1;
}

static void check_number(int at, long double value)
{
    char number[48];
    plot_number(number, sizeof number, (double)value);
    assert_string_equal(written[at].text, number);
}

/* Position, velocity, force and x_tilde of a node. */
TEST(notes_of_nodes_are_right)
{
    enum { N = 25, NODE = 7 };
    static Stand stand;
    stand_up("square --stretch 0.5 --turn 10 --velocity 1,2", 2, 1280, 800,
             &stand);
    const TimeIntegrator *run = &stand.simulation.run[0];
    const IncrementalPotential E = {&stand.simulation.system, 1, run->x, NULL,
                                    false};
    long double g[2 * N];
    exact_derivatives(&E, NULL, run->x, g, NULL);
    double line[4][2];
    for (int k = 0; k < 2; k++) {
        double x = run->x[2 * NODE + k], v = run->v[2 * NODE + k];
        double values[4] = {x, v, (double)-g[2 * NODE + k], x + 0.004 * v};
        for (int i = 0; i < 4; i++)
            line[i][k] = values[i];
    }
    static const char *const name[4] = {"{x}", "v", "f", "{xt}"};
    static const char *const unit[4] = {"m", "m/s", "N", "m"};
    stand.show.hover = (Pick){PICK_NODE, 0, NODE, {0, 0}};
    int first = drawn_text(&stand, "node 7");
    assert_string_equal(written[first + 1].text, "m = 40 kg");
    for (int i = 0; i < 4; i++) {
        char x[48], y[48], text[160];
        plot_number(x, sizeof x, line[i][0]);
        plot_number(y, sizeof y, line[i][1]);
        snprintf(text, sizeof text, "%s = (%s, %s) %s", name[i], x, y, unit[i]);
        assert_string_equal(written[first + 2 + i].text, text);
    }
    take_down(&stand);
}

/* The block of a spring and its eigenvalues, and bars as long as these are. */
TEST(notes_of_springs_are_right)
{
    enum { N = 25, SPRING = 12, MOST = 40 };
    static Stand stand;
    static long double g[2 * N], H[4 * N * N];
    stand_up("square --stretch 0.5 --turn 10", 0, 1280, 800, &stand);
    text_free(stand.paper.text);
    stand.paper.text = NULL;
    const System *system = &stand.simulation.system;
    const IncrementalPotential E = {system, 1, stand.simulation.run[0].x, NULL,
                                    false};
    exact_derivatives(&E, NULL, E.x_n, g, H);
    int node[2] = {system->e[2 * SPRING], system->e[2 * SPRING + 1]};
    long double B[3];
    for (int k = 0; k < 3; k++) /* of two nodes: minus the spring's */
        B[k] = -H[2 * N * (2 * node[0] + k / 2) + 2 * node[1] + (k + 1) / 2];
    stand.show.hover = (Pick){PICK_SPRING, 0, SPRING, {0, 0}};
    int at = drawn_text(&stand, "its block of \u2207\u00b2P, J/m\u00b2") + 1;
    for (int i = 0; i < 16; i++)
        check_number(at + i,
                     B[i / 4 % 2 + i % 2] * (i / 8 == i % 4 / 2 ? 1 : -1));
    long double middle = B[0] + B[2], apart = hypotl(B[0] - B[2], 2 * B[1]);
    long double value[4] = {0, 0, middle - apart, middle + apart};
    for (int i = 0; i < 4; i++)
        check_number(at + 17 + i, value[i]);
    CHECK(value[3] < 0); /* hollow bars for both, none of them in the words */
    int bars = 0, tall[MOST] = {0}, last = 0;
    for (int x = 0; x < 1280 && bars < MOST - 1; x++) {
        int high = count_colour(&stand, (Box){x, 0, 1, 800}, COLOUR_PROJECT);
        bars += high != tall[bars];
        tall[bars] = high;
        last += count_colour(&stand, (Box){x, (int)written[at + 17].y, 1, 20},
                             COLOUR_PROJECT);
    }
    CHECK(bars == 4 && last == 0);
    CHECK_NEAR(tall[1] / (double)value[2], tall[3] / (double)value[3],
               1 / -(double)value[3]);
    CHECK(tall[1] > 10);
    take_down(&stand);
}

/* The tangent of g is 0 where the update goes, and the parabola, which E has in
 * common with it at the start, is lowest there. */
TEST(tangents_lead_to_the_next_iterate)
{
    static Stand stand;
    stand_up("tangent", 0, 1280, 800, &stand);
    const Descent *descent = &stand.simulation.descent;
    const double x = descent->point[0];
    const double E = descent_value(&stand.simulation, x, 0);
    char text[80];
    Simulation after;
    simulation_from_line("tangent", NULL, NULL, &after);
    CHECK_STATUS(simulation_step(&after), STATUS_OK);
    const double next = after.descent.point[0];
    simulation_free(&after);
    snprintf(text, sizeof text, "x^{1} = %.8g", next);
    drawn_text(&stand, text);
    int first = 0;
    while (first < lines && plotted[first].colour != COLOUR_P)
        first++;
    const double *a = plotted[first].a, *b = plotted[first].b;
    CHECK_NEAR(a[0] - a[1] * (b[0] - a[0]) / (b[1] - a[1]), next, 1e-12);
    const double *near = NULL, *low = NULL;
    for (int i = first + 1; i < lines && plotted[i].colour == COLOUR_P; i++) {
        const double *end = plotted[i].b;
        near = !near || fabs(end[0] - x) < fabs(near[0] - x) ? end : near;
        low = !low || end[1] < low[1] ? end : low;
    }
    const double pace = plotted[first + 1].b[0] - plotted[first + 1].a[0];
    double slope = descent_at(&stand.simulation, FILTER_NONE, x, 0).g[0];
    CHECK_NEAR(low[0], next, 0.51 * pace);
    CHECK_NEAR(near[1], E + slope * (near[0] - x), 10 * pace * pace);
    take_down(&stand);
}

/* The first, second, third time, and so on. */
TEST(times_are_counted_in_words)
{
    static const struct {
        int time;
        const char *word;
    } rows[] = {{1, "1st"},   {2, "2nd"},   {3, "3rd"},    {4, "4th"},
                {11, "11th"}, {12, "12th"}, {13, "13th"},  {21, "21st"},
                {22, "22nd"}, {23, "23rd"}, {111, "111th"}};
    static Stand stand;
    stand_up("square", 0, 400, 300, &stand);
    Trace trace = {.line = LINE_DO};
    stand.show.pane[0].trace = &trace;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char sentence[80];
        trace.iteration = rows[i].time - 1;
        stand.show.sentence[0] = '\0';
        show_describe(&stand.show);
        snprintf(sentence, sizeof sentence,
                 "line 2: the loop begins for the %s time", rows[i].word);
        assert_string_equal(stand.show.sentence, sentence);
    }
    take_down(&stand);
}

/* Code stands in the place of the cards, its lines at work lit. */
TEST(pages_light_their_lines)
{
    static Stand stand;
    const char *const lines[] = {"int a;", "int b;", "int c;", "int d;"};
    stand_up("square", 0, 1280, 800, &stand);
    stand.show.page = (Page){.kind = PAGE_CODE,
                             .title = "file.c: function",
                             .lines = 4,
                             .line = lines,
                             .lit = {0, 1, 1, 0}};
    show_draw(&stand.paper, &stand.show);
    Layout layout = show_layout(&stand.show, 1280, 800);
    int two = count_colour(&stand, layout.column, COLOUR_LIT);
    stand.show.page.lit[2] = 0;
    show_draw(&stand.paper, &stand.show);
    int one = count_colour(&stand, layout.column, COLOUR_LIT);
    CHECK(one > 2000 && two > 1.5 * one && two < 2.5 * one);
    stand.show.page.kind = PAGE_NONE;
    show_draw(&stand.paper, &stand.show);
    CHECK(count_colour(&stand, layout.column, COLOUR_LIT) == 0);
    take_down(&stand);
}

/* Walls, balls, forces, and springs that are gone. */
TEST(contact_is_seen)
{
    static Stand stand;
    stand_up("drop", 75, 1280, 800, &stand);
    text_free(stand.paper.text);
    stand.paper.text = NULL;
    show_draw(&stand.paper, &stand.show);
    Layout layout = show_layout(&stand.show, 1280, 800);
    CHECK(count_colour(&stand, layout.stage, COLOUR_SOLID) > 1000);
    CHECK(count_colour(&stand, layout.stage, COLOUR_FORCE) > 100);
    int blue = count_colour(&stand, layout.stage, COLOUR_X);
    stand.simulation.system.breaks = true;
    stand.simulation.system.k[5] = 0;
    show_draw(&stand.paper, &stand.show);
    CHECK(count_colour(&stand, layout.stage, COLOUR_X) < blue);
    take_down(&stand);
    stand_up("bend", 0, 1280, 800, &stand);
    show_draw(&stand.paper, &stand.show);
    CHECK(count_colour(&stand, layout.stage, COLOUR_SOLID) > 500);
    take_down(&stand);
}

/* Two of the slopes let the body slide, the third holds it; arrows of forces
 * end at their nodes, so that they come out of the slope. */
TEST(contacts_slide_or_hold)
{
    static Stand stand;
    stand_up("slope", 60, 600, 600, &stand);
    for (int r = 0; r < 3; r++) {
        const TimeIntegrator *run = &stand.simulation.run[r];
        Stage stage = {.box = {0, 0, 600, 600}, .em = 10};
        const double bounds[4] = {run->x[0] - 2, run->x[1] - 2, run->x[0] + 2,
                                  run->x[1] + 2};
        stage.camera = camera_create(stage.box, bounds, false, &LENS_FITS);
        const SpringPen pen = {.paper = &stand.paper,
                               .stage = &stage,
                               .simulation = &stand.simulation,
                               .run = r,
                               .system = run->system,
                               .x = run->x,
                               .contact = contact_of(run->system),
                               .radius = 1};
        int touches = 0;
        double lowest = -INFINITY, sum = 0;
        for (Touch touch = {.pair = -1}; square_next_touch(&pen, &touch);) {
            double at[2];
            touches++;
            CHECK(touch.rough && touch.slides == (r < 2));
            stage_pixel(&stage, run->x + 2 * touch.node, at);
            lowest = fmax(lowest, at[1]);
            sum += touch.force[1];
        }
        CHECK(touches > 1 && sum > 0);
        char words[64], expected[64];
        const Obstacle *wall = &pen.contact->obstacle[0];
        double angle = atan2(fabs(wall->n[0]), wall->n[1]);
        static const double part[] = {0.5, 0.9, 1.1};
        for (int k = 0; k < 2; k++) { /* as it is, and with another mu */
            double mu = k ? 0.45 : tan(angle);
            simulation_set_friction(&stand.simulation, mu);
            snprintf(expected, sizeof expected,
                     "%g \u03bc = %.3g tan %.3g\u00b0: %s", part[r],
                     part[r] * mu / tan(angle), angle * 180 / M_PI,
                     r < 2 ? "slides" : "holds");
            CHECK(square_contact_words(&pen, words, sizeof words));
            CHECK(strcmp(words, expected) == 0);
        }
        simulation_set_friction(&stand.simulation, tan(angle));
        canvas_rectangle(&stand.paper.canvas, 0, 0, 600, 600, COLOUR_WHITE);
        square_contact_forces(&pen, square_contact_most(&pen));
        int below = 0;
        for (int j = (int)lowest + 6; j < 600; j++)
            for (int i = 0; i < 600; i++)
                below += pixel(&stand, i, j) == COLOUR_FORCE;
        CHECK(below > 10);
    }
    take_down(&stand);
}

/* In a formula a number with a sign or a power of ten stands in parentheses. */
TEST(formulas_can_be_read)
{
    static const struct {
        double value;
        const char *text;
    } rows[] = {{0.69, "0.69"},   {-0.5511, "(-0.5511)"},
                {-0.0, "0"},      {1.468e-6, "(1.468e-06)"},
                {3e9, "(3e+09)"}, {12, "12"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[32];
        factor_text(text, sizeof text, rows[i].value);
        assert_string_equal(text, rows[i].text);
    }
}

/* The energy with the square root has its tip at d = 0, inside the plot. */
TEST(the_tip_is_inside_its_plot)
{
    static Stand stand;
    stand_up("spring --start 1.3,0", 0, 600, 400, &stand);
    const Card *card = picture_of(stand.simulation.scene)->cards[3];
    assert_string_equal(card->name, "profile");
    stand.simulation.exhibit.parts = true;
    canvas_rectangle(&stand.paper.canvas, 0, 0, 600, 400, COLOUR_WHITE);
    card->draw(&stand.paper, (Box){20, 20, 560, 360}, &stand.show);
    int left = 600, right = 0, top = 400;
    for (int i = 0; i < 600; i++)
        for (int j = 0; j < 400; j++)
            if (pixel(&stand, i, j) == COLOUR_GHOST) {
                left = i < left ? i : left;
                right = i > right ? i : right;
            }
    for (int i = (left + right) / 2 - 2; i <= (left + right) / 2 + 2; i++)
        for (int j = 399; j >= 0; j--)
            if (pixel(&stand, i, j) == COLOUR_GHOST)
                top = j;
    CHECK(right - left > 300 && top > 20 && top < 300);
    take_down(&stand);
}

/* What is a unit but for rounding is called by it. */
TEST(energies_near_a_unit_are_that)
{
    static Stand stand;
    stand_up("arrows --integrator midpoint", 3, 1440, 900, &stand);
    stand.history.value[0][stand.history.count - 1] = 0.99999999;
    drawn_text(&stand, "implicit midpoint 1 J");
    take_down(&stand);
}

/* The strip says where a search ended that found no minimum, and who makes the
 * steps. */
TEST(ends_and_methods_have_their_names)
{
    static const struct {
        const char *line, *sentence, *method;
    } rows[] = {
        {"landscape --start 0.05,-0.05 --filter none --line-search none",
         "the gradient is 0, but this is a saddle", "Newton's method"},
        {"landscape", "without projection Newton may go uphill; clamped, never",
         "Newton's method"},
        {"overshoot",
         "it flies away: no curvature is left, so there is no next "
         "step",
         "Newton's method"},
        {"race", "run time against error, measured now", "6 methods"},
        {"slope", "three blocks, each with a friction of its own",
         "backward Euler"},
    };
    Simulation simulation;
    Show show;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        simulation_from_line(rows[i].line, NULL, NULL, &simulation);
        while (simulation.scene->turn && !simulation.done)
            simulation_step(&simulation);
        show_create(&simulation, &show);
        show.pane[0].trouble = simulation.status;
        show_describe(&show);
        assert_string_equal(show.sentence, rows[i].sentence);
        assert_string_equal(show.method, rows[i].method);
        simulation_free(&simulation);
    }
    /* x = x_tilde = 0, where E'' = m - 2 h^2 k < 0 */
    simulation_from_line("tangent", NULL, NULL, &simulation);
    exhibit_drag(&simulation, 1, 0, 0);
    exhibit_drag(&simulation, 0, 0, 0);
    show_create(&simulation, &show);
    show_describe(&show);
    assert_string_equal(show.sentence,
                        "the gradient is 0, but this is a maximum");
    simulation_free(&simulation);
}

/* The residual of a search that has ended is the one that passed. */
TEST(the_last_residual_passes)
{
    static const char *const lines[] = {
        "landscape", "landscape --filter none --line-search none", "tangent",
        "overshoot --line-search backtrack"};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        Simulation simulation;
        DescentTrace space;
        Show show;
        simulation_from_line(lines[i], NULL, NULL, &simulation);
        show_create(&simulation, &show);
        double tolerance = simulation.options.tolerance;
        while (!simulation.done) {
            double before = cards_trace(&show, &space)->residual;
            CHECK(before > tolerance);
            simulation_step(&simulation);
            const Descent *descent = &simulation.descent;
            CHECK_NEAR(descent->record[descent->count - 1].residual, before,
                       1e-9 * before);
        }
        CHECK_AT_MOST(cards_trace(&show, &space)->residual, tolerance);
        simulation_free(&simulation);
    }
}

/* What a later explosion would hide: the energies of a step before it keep
 * their numbers, and the axis is theirs; an axis that runs over many powers of
 * ten is a logarithmic one. */
TEST(energies_before_an_explosion_are_seen)
{
    static Stand stand;
    stand_up("square", 6, 1280, 800, &stand);
    const History *history = &stand.history;
    double now = simulation_time(&stand.simulation), joule, last;
    double total = history->value[0][history->count - 1], later[12];
    double before = energies_axis(&stand.show, &joule, &last).high * joule;
    for (int s = 0; s < history->series; s++)
        later[s] = 1e298;
    history_add(&stand.history, now + 0.1, later);
    CHECK(total > 1e3 &&
          energies_value(&stand.simulation, history, 0, now) == total);
    Axis axis = energies_axis(&stand.show, &joule, &last);
    CHECK(!axis.log && axis.high * joule <= before &&
          axis.high * joule >= total);
    CHECK(energies_value(&stand.simulation, history, 0, now + 0.1) == 1e298);
    CHECK(isnan(energies_value(&stand.simulation, history, 0, -1)));
    take_down(&stand);
    stand_up("square --timestep 0.008 --integrator symplectic-euler", 11, 640,
             400, &stand); /* x is finite, E is not */
    now = simulation_time(&stand.simulation);
    CHECK(isinf(energies_value(&stand.simulation, history, 0, now)));
    CHECK(isfinite(energies_value(&stand.simulation, history, 0, 0.9 * now)));
    take_down(&stand);
    stand_up("arrows", 80, 1280, 800, &stand);
    axis = energies_axis(&stand.show, &joule, &last);
    now = simulation_time(&stand.simulation);
    CHECK(axis.log && axis.low > 0);
    double least = INFINITY;
    Layout layout = show_layout(&stand.show, 1280, 800);
    Box card = layout.card[picture_card(&mass_picture, "energies")];
    for (int r = 0; r < 3; r++) {
        double energy = energies_value(&stand.simulation, history, r, now);
        least = fmin(least, energy);
        CHECK(energy <= axis.high * joule && energy >= axis.low * joule);
    }
    CHECK(least > 0 && least < 1e-6);
    take_down(&stand);
    stand_up("arrows", 6, 1280, 800, &stand);
    show_draw(&stand.paper, &stand.show);
    for (int r = 0; r < 3; r++) { /* one colour a method, here and there */
        Colour colour = colour_of_method(stand.simulation.run[r].method->name);
        CHECK(count_colour(&stand, card, colour) > 20);
        CHECK(count_colour(&stand, layout.stage, colour) > 50);
    }
    take_down(&stand);
}

/* However far nodes fly, the view goes with them as long as there are numbers;
 * beyond them words say why nothing is seen. */
TEST(what_flies_far_is_drawn_or_told)
{
    static Stand stand;
    stand_up("square", 0, 1280, 800, &stand);
    Layout layout = show_layout(&stand.show, 1280, 800);
    double *x = stand.simulation.run[0].x;
    int size = 2 * stand.simulation.system.nodes;
    for (double far = 1e10; far < 1e301; far *= 1e10) {
        for (int i = 0; i < size; i++)
            x[i] = far * (stand.simulation.mesh.x[i]);
        show_draw(&stand.paper, &stand.show);
        CHECK(count_colour(&stand, layout.stage, COLOUR_X) > 500);
        CHECK(count_colour(&stand, layout.stage, COLOUR_WARNING) == 0);
    }
    for (int i = 0; i < size; i++) /* two nodes alone, far above and below */
        x[i] = i == 2 * 11 + 1 ? 1e220 : i == 2 * 13 + 1 ? -1e220 : 0;
    show_draw(&stand.paper, &stand.show);
    CHECK(count_colour(&stand, layout.stage, COLOUR_X) > 300);
    stand.show.hover = (Pick){PICK_SPRING, 0, 0, {0, 0}};
    show_draw(&stand.paper, &stand.show);
    int noted = count_colour(&stand, layout.stage, COLOUR_NOTE);
    CHECK(noted > 1000);
    for (int part = 0; part < 2; part++) { /* one node, then all of them */
        for (int i = 0; i < (part ? size : 1); i++)
            x[i] = i % 2 ? INFINITY : NAN;
        show_draw(&stand.paper, &stand.show);
        CHECK(count_colour(&stand, layout.stage, COLOUR_WARNING) > 20);
        CHECK(count_colour(&stand, layout.stage, COLOUR_NOTE) == 0);
    }
    take_down(&stand);
}

/* Words on a pane keep apart: the card at the mouse hides the label of the
 * pane, and the colours of strain stand above it. */
TEST(words_of_a_pane_keep_apart)
{
    static Stand stand;
    stand_up("square", 1, 1280, 800, &stand);
    Show *show = &stand.show;
    show->panes = 2;
    show->pane[1] = show->pane[0];
    show->pane[0].label = show->pane[1].label = "label label label label label";
    show_draw(&stand.paper, show);
    Layout layout = show_layout(show, 1280, 800);
    Box pane = layout.pane[1];
    int before = count_colour(&stand, pane, colour_of_run(1));
    show->hover = (Pick){PICK_SPRING, 1, 12, {0, -0.5}};
    show_draw(&stand.paper, show);
    int after = count_colour(&stand, pane, colour_of_run(1));
    CHECK(before > 50 && after < before - 20);
    show->hover.kind = PICK_NONE;
    show->strain = true;
    show_draw(&stand.paper, show);
    int line = paper_pixels(&stand.paper, 1.7);
    Box low = {pane.x, pane.y + pane.height - line, pane.width, line};
    Box above = {pane.x, low.y - 2 * line, pane.width, 2 * line};
    Colour end = colour_map_strain(0.99, 1);
    CHECK(count_colour(&stand, low, end) == 0);
    CHECK(count_colour(&stand, above, end) > 0);
    take_down(&stand);
}

static bool boxes_meet(Box a, Box b)
{
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height &&
           b.y < a.y + a.height;
}

/* On each side of the body where there is room, and inside the stage where
 * there is none. */
TEST(notes_stand_beside_the_body)
{
    static Stand stand;
    stand_up("square", 0, 400, 400, &stand);
    Stage stage = {.box = {0, 0, 400, 400}, .em = 10};
    static const Box bodies[] = {{20, 20, 200, 360},
                                 {200, 20, 190, 360},
                                 {20, 20, 360, 200},
                                 {20, 180, 360, 200}};
    for (int i = 0; i < 4; i++) {
        Box body = bodies[i];
        Box note = stage_note(&stand.paper, &stage, body.x + 20, body.y + 20,
                              100, 100, body);
        CHECK(!boxes_meet(note, body));
        CHECK(note.x > 0 && note.y > 0 && note.x + note.width < 400 &&
              note.y + note.height < 400);
    }
    Box note = stage_note(&stand.paper, &stage, 390, 390, 100, 100,
                          (Box){0, 0, 400, 400});
    CHECK(note.x > 0 && note.x + note.width < 400);
    CHECK(note.y > 0 && note.y + note.height < 400);
    take_down(&stand);
}

/* The widest number of an axis has room left of it; the unit of one that is
 * too low for it is left out. */
TEST(numbers_of_axes_have_room)
{
    static Stand stand;
    stand_up("square", 0, 400, 400, &stand);
    Axis x = {0, 1, false, false, "t in s"};
    Axis y = {-4e298, 4e298, false, false, "J"};
    Plot plot = plot_create(&stand.paper, (Box){100, 0, 300, 300}, x, y);
    int wide =
        paper_width(&stand.paper, FACE_REGULAR, 0.82, "\u22124\u00b710^{298}");
    CHECK(plot.box.x >= 100 + wide && plot.box.x < 100 + 2 * wide);
    CHECK(plot.box.x + plot.box.width <= 400);
    for (int low = 0; low < 2; low++) {
        canvas_clear(&stand.paper.canvas, COLOUR_WHITE);
        plot = plot_create(&stand.paper, (Box){0, 0, 300, low ? 40 : 80}, x,
                           (Axis){0, 1, false, false, "kJ"});
        Box corner = {plot.box.x + plot.box.width - 30, 0, 32,
                      plot.box.y + plot.box.height};
        int dark = count_colour(&stand, corner, COLOUR_TEXT);
        CHECK(low ? dark == 0 : dark > 0);
    }
    take_down(&stand);
}

/* Cards about updates promise none where a method makes none. */
TEST(explicit_methods_promise_no_updates)
{
    static const struct {
        const char *line;
        bool explicit;
    } rows[] = {{"square", false},
                {"square --integrator bdf2", false},
                {"square --integrator forward-euler", true},
                {"square --integrator verlet", true},
                {"landscape", false}};
    static Stand stand;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        stand_up(rows[i].line, 0, 640, 400, &stand);
        CHECK(cards_explicit(&stand.show) == rows[i].explicit);
        take_down(&stand);
    }
}

/* Seven kinds of energy in a small card leave room for their curves. */
TEST(a_legend_leaves_room_for_curves)
{
    static Stand stand;
    stand_up("dent --size 1280x800", 60, 1280, 800, &stand);
    int energies = picture_card(&square_picture, "energies");
    show_draw(&stand.paper, &stand.show);
    Layout layout = show_layout(&stand.show, 1280, 800);
    Box card = layout.card[energies];
    /* Light lines across are at most so far up as the plot is. */
    int top = -1;
    for (int y = card.y + 2; y < card.y + card.height - 2 && top < 0; y++)
        if (count_colour(&stand, (Box){card.x + 2, y, card.width - 4, 1},
                         COLOUR_GRID) > card.width / 3)
            top = y;
    CHECK(top > 0 && top < card.y + 0.55 * card.height);
    take_down(&stand);
}

/* Above the diagonal are the springs, below it what a factor has: eliminating a
 * node joins all its later neighbours. */
TEST(the_pattern_is_that_of_the_factor)
{
    enum { N = 81, SIDE = 10 * N };
    static Stand stand;
    static bool matrix[N][N], factor[N][N];
    stand_up("square --segments 8", 0, SIDE, SIDE, &stand);
    const System *system = &stand.simulation.system;
    CHECK(system->nodes == N);
    for (int s = 0; s < system->springs; s++) {
        int i = system->order[system->e[2 * s]];
        int j = system->order[system->e[2 * s + 1]];
        matrix[i][j] = matrix[j][i] = factor[i][j] = factor[j][i] = true;
    }
    for (int k = 0; k < N; k++)
        for (int i = k + 1; i < N; i++)
            for (int j = k + 1; j < N; j++)
                factor[i][j] = factor[i][j] || (factor[i][k] && factor[k][j]);
    card_spy.draw(&stand.paper, (Box){0, 0, SIDE, SIDE}, &stand.show);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            bool there = i == j || (i < j ? matrix : factor)[i][j];
            CHECK(there ==
                  (pixel(&stand, 10 * j + 5, 10 * i + 5) != COLOUR_WHITE));
        }
    take_down(&stand);
}

/* Every card of every picture has a name of its own, and they fit. */
TEST(cards_have_names)
{
    for (const Scene *scene = scenes; scene->name; scene++) {
        const Picture *picture = picture_of(scene);
        int count = picture_cards(picture);
        CHECK(count <= LAYOUT_CARDS);
        for (int c = 0; c < count; c++)
            CHECK(picture_card(picture, picture->cards[c]->name) == c);
        CHECK(picture_card(picture, "nothing") == -1);
    }
}

/* A square that drifts off is followed, once the view has grown a single time;
 * one that has something to meet is not. */
TEST(the_view_follows_what_drifts)
{
    static const struct {
        const char *line;
        bool followed;
    } rows[] = {
        {"square --stretch 1 --velocity 3,1 --timestep 0.02", true},
        {"square --stretch 1 --velocity 3,1 --timestep 0.02 --ball 0,-5,1",
         false},
    };
    for (int i = 0; i < 2; i++) {
        Stand begin, drifted;
        stand_up("square --stretch 1", 0, 1280, 800, &begin);
        stand_up(rows[i].line, 100, 1280, 800, &drifted);
        const double *x = pane_x(&drifted.show.pane[0]);
        Layout layout = show_layout(&drifted.show, 1280, 800);
        Camera was = show_camera(&begin.show, &layout, 0);
        Camera is = show_camera(&drifted.show, &layout, 0);
        Box box = layout.pane[0];
        CHECK(x[0] > 5);
        if (rows[i].followed)
            CHECK_NEAR(1.5 * is.scale[0], was.scale[0], 1e-12 * was.scale[0]);
        else
            CHECK(is.scale[0] < 0.3 * was.scale[0]);
        for (int k = 0; k < drifted.simulation.system.nodes; k++) {
            double at[2];
            camera_pixel(&is, x + 2 * k, at);
            CHECK(at[0] > box.x && at[0] < box.x + box.width);
            CHECK(at[1] > box.y && at[1] < box.y + box.height);
        }
        take_down(&begin);
        take_down(&drifted);
    }
}

TESTS(NULL, NULL)
