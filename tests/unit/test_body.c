/* How a square starts, falls and hangs: gravity in every integrator, pinned
 * nodes, turned and thrown starts, and the text of --pin.
 */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scenes/pins.h"

enum { STEPS = 25 };

/* A point that falls: position and velocity at t_n and before. */
typedef struct Fall {
    long double y, v, last_y, last_v;
    int steps;
} Fall;

/* One step of the method itself for the acceleration a, which does not depend
 * on the position: the formulas of the methods, not of this program. */
static void fall_step(const char *method, long double h, long double a,
                      Fall *fall)
{
    long double y = fall->y, v = fall->v;
    bool euler = strcmp(method, "backward-euler") == 0 ||
                 strcmp(method, "symplectic-euler") == 0 ||
                 (strcmp(method, "bdf2") == 0 && fall->steps == 0);
    if (euler) {
        fall->v = v + h * a;
        fall->y = y + h * fall->v;
    } else if (strcmp(method, "forward-euler") == 0) {
        fall->v = v + h * a;
        fall->y = y + h * v;
    } else if (strcmp(method, "bdf2") == 0) {
        fall->v = (4 * v - fall->last_v) / 3 + 2 * h / 3 * a;
        fall->y = (4 * y - fall->last_y) / 3 + 2 * h / 3 * fall->v;
    } else { /* exact for a parabola */
        fall->v = v + h * a;
        fall->y = y + h * v + h * h / 2 * a;
    }
    fall->last_y = y;
    fall->last_v = v;
    fall->steps++;
}

/* Mean of a component over the nodes, all of one mass. */
static long double centre(const Simulation *simulation, const double *values,
                          int axis)
{
    long double sum = 0;
    int n = simulation->system.nodes;
    for (int i = 0; i < n; i++)
        sum += values[2 * i + axis];
    return sum / n;
}

/* A stretched, turned, thrown square: springs work, and its centre of mass does
 * not notice.  1e-9: a hundred roundings of numbers of size 1. */
TEST(the_centre_of_mass_falls_as_the_method_says)
{
    for (const IntegratorMethod *row = integrator_methods; row->name; row++) {
        Simulation *simulation =
            simulate("square --segments 3 --stretch 1.2 --turn 30 --at 0.3,2 "
                     "--velocity 1.5,2.5 --gravity 9.81 --timestep 0.002 "
                     "--tolerance 1e-6 --integrator %s",
                     row->name);
        const TimeIntegrator *run = &simulation->run[0];
        Fall x = {centre(simulation, run->x, 0), 1.5L, 0, 0, 0};
        Fall y = {centre(simulation, run->x, 1), 2.5L, 0, 0, 0};
        CHECK_NEAR(x.y, 0.3, 1e-15);
        CHECK_NEAR(y.y, 2, 1e-15);
        for (int step = 0; step < STEPS; step++) {
            make_steps(simulation, 1);
            fall_step(row->name, 0.002L, 0, &x);
            fall_step(row->name, 0.002L, -9.81L, &y);
            CHECK_NEAR(centre(simulation, run->x, 0), x.y, 1e-9);
            CHECK_NEAR(centre(simulation, run->v, 0), x.v, 1e-9);
            CHECK_NEAR(centre(simulation, run->x, 1), y.y, 1e-9);
            CHECK_NEAR(centre(simulation, run->v, 1), y.v, 1e-9);
        }
    }
}

/* At rest it falls as one piece: the springs stay at their lengths.  100 steps
 * of backward Euler: y = -g h^2 n (n+1)/2. */
TEST(free_fall_is_exact)
{
    Simulation *simulation =
        simulate("square --stretch 1 --gravity 9.81 --timestep 0.01");
    const TimeIntegrator *run = &simulation->run[0];
    for (int n = 1; n <= 100; n++) {
        make_steps(simulation, 1);
        double y = -9.81 * 0.01 * 0.01 * n * (n + 1) / 2;
        for (int i = 0; i < simulation->system.nodes; i++) {
            CHECK_NEAR(run->x[2 * i], simulation->mesh.x[2 * i], 1e-12);
            CHECK_NEAR(run->x[2 * i + 1], simulation->mesh.x[2 * i + 1] + y,
                       1e-9);
            CHECK_NEAR(run->v[2 * i + 1], -9.81 * 0.01 * n, 1e-9);
        }
    }
}

/* Not by a bit, in any method, also where the square is thrown. */
TEST(pinned_nodes_do_not_move)
{
    for (const IntegratorMethod *row = integrator_methods; row->name; row++) {
        double x[2 * 16];
        Simulation *simulation = simulate(
            "square --segments 3 --stretch 1.2 --velocity 1,-2 --gravity "
            "9.81 --timestep 0.002 --pin 0,15,7,top-corners "
            "--integrator %s",
            row->name);
        const TimeIntegrator *run = &simulation->run[0];
        memcpy(x, run->x, sizeof x);
        make_steps(simulation, STEPS);
        for (int i = 0; i < 16; i++) {
            bool pinned = i == 0 || i == 3 || i == 7 || i == 15;
            CHECK(pinned == (run->x[2 * i + 1] == x[2 * i + 1]));
            CHECK(!pinned || run->x[2 * i] == x[2 * i]);
            CHECK(!pinned || (run->v[2 * i] == 0 && run->v[2 * i + 1] == 0));
        }
    }
}

/* Stretched in x, then turned about the origin, then moved. */
TEST(a_start_is_stretched_turned_and_moved)
{
    Simulation *simulation =
        simulate("square --segments 2 --stretch 1.5 --turn 90 --at "
                 "3,-4 --velocity 5,6");
    for (int i = 0; i < 9; i++) {
        const double *rest = simulation->mesh.x + 2 * i;
        const double *x = simulation->run[0].x + 2 * i;
        const double *v = simulation->run[0].v + 2 * i;
        CHECK_NEAR(x[0], 3 - rest[1], 1e-15);
        CHECK_NEAR(x[1], -4 + 1.5 * rest[0], 1e-15);
        CHECK(v[0] == 5 && v[1] == 6);
    }
}

/* Nodes 0 ... rows are the left column from below. */
TEST(the_words_of_pin_name_their_nodes)
{
    static const struct {
        int columns, rows;
        const char *text, *pinned;
    } cases[] = {
        {2, 2, "top-corners", "001000001"}, {2, 2, "top", "001001001"},
        {2, 2, "bottom", "100100100"},      {2, 2, "left", "111000000"},
        {2, 2, "right", "000000111"},       {2, 2, "4", "000010000"},
        {2, 2, "0,8,left", "111000001"},    {2, 2, "8,8", "000000001"},
        {3, 1, "top-corners", "01000001"},  {3, 1, "top", "01010101"},
        {3, 1, "bottom", "10101010"},       {3, 1, "left", "11000000"},
        {3, 1, "right,2", "00100011"},      {1, 3, "top-corners", "00010001"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        unsigned char pinned[9] = {0};
        const SquareMesh shape =
            square_mesh_shape(cases[i].columns, cases[i].rows, 1);
        CHECK_STATUS(pins_read(cases[i].text, &shape, pinned), STATUS_OK);
        for (int node = 0; cases[i].pinned[node]; node++)
            CHECK(pinned[node] == (cases[i].pinned[node] == '1'));
    }
    static const char *const bad[] = {
        "",    "9",          "-1",
        "1,",  ",1",         "1.0",
        "1 ",  "upper",      "toppp",
        "to",  "1;2",        "1,,2",
        "+1",  "top left",   "0x1",
        "1e0", "4294967296", "99999999999999999999999999999999",
    };
    const SquareMesh shape = square_mesh_shape(2, 2, 1);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        CHECK_STATUS(pins_read(bad[i], &shape, NULL), STATUS_INVALID_INPUT);
}

TEST(pins_are_refused_in_one_line)
{
    char message[512];
    Options options;
    CHECK_STATUS(
        options_of_line("square --pin 3,25", &options, message, sizeof message),
        STATUS_INVALID_INPUT);
    assert_string_equal(message,
                        "--pin: '3,25' is no list of node numbers from 0 to "
                        "24, or of: top-corners, top, bottom, left, right");
}

TESTS(NULL, NULL)
