/* How a square starts, falls and hangs: gravity in every integrator, pinned
 * nodes, turned and thrown starts, and the text of --pin.
 */
#include "test.h"

#include <string.h>

#include "scenes/body.h"

enum { STEPS = 25 };

/* A point that falls: height and velocity at t_n and before. */
typedef struct Fall {
    Real y, v, last_y, last_v;
} Fall;

/* One step of the method itself for the acceleration a, which does not depend
 * on the position: the formulas of the methods, not of this program. */
static void fall_step(const char *method, int step, Real h, Real a, Fall *fall)
{
    Real y = fall->y, v = fall->v;
    fall->v = v + h * a;
    if (strcmp(method, "bdf2") == 0 && step > 0) {
        fall->v = (4 * v - fall->last_v) / 3 + 2 * h / 3 * a;
        fall->y = (4 * y - fall->last_y) / 3 + 2 * h / 3 * fall->v;
    } else if (strcmp(method, "bdf2") == 0 || strstr(method, "d-euler") ||
               strstr(method, "symplectic")) {
        fall->y = y + h * (strstr(method, "forward") ? v : fall->v);
    } else { /* exact for a parabola */
        fall->y = y + h * v + h * h / 2 * a;
    }
    fall->last_y = y;
    fall->last_v = v;
}

/* Mean height or velocity upwards over the nodes, all of one mass. */
static Real mean(const Simulation *simulation, const double *values)
{
    Real sum = 0;
    for (int i = 0; i < simulation->system.nodes; i++)
        sum += values[2 * i + 1];
    return sum / simulation->system.nodes;
}

/* A thrown square falls as its method says: at rest as one piece, stretched and
 * turned as a whole, since the springs' work does not move the centre of mass.
 * 1e-9: a hundred roundings of numbers of size 1. */
TEST(a_square_falls_as_the_method_says)
{
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        for (int rest = 0; rest < 2; rest++) {
            double from[2 * 16];
            Simulation *simulation = simulate(
                "square --segments 3 --stretch %g --turn 30 --at 0.3,2 "
                "--velocity 1.5,2.5 --gravity 9.81 --timestep 0.002 "
                "--tolerance 1e-6 --integrator %s",
                rest ? 1 : 1.2, row->name);
            const TimeIntegrator *run = &simulation->run[0];
            Fall fall = {mean(simulation, run->x), 2.5L, 0, 0};
            CHECK_NEAR(fall.y, 2, 1e-15);
            memcpy(from, run->x, sizeof from);
            for (int step = 0; step < STEPS; step++) {
                make_steps(simulation, 1);
                fall_step(row->name, step, 0.002L, -9.81L, &fall);
                CHECK_NEAR(mean(simulation, run->x), fall.y, 1e-9);
                CHECK_NEAR(mean(simulation, run->v), fall.v, 1e-9);
                for (int i = 0; i < 16 && rest; i++) {
                    double along = run->x[2 * i] - from[2 * i];
                    CHECK_NEAR(along, 1.5 * run->clock, 1e-9);
                    CHECK_NEAR(run->x[2 * i + 1] - from[2 * i + 1], fall.y - 2,
                               1e-9);
                }
            }
        }
}

/* What hangs evenly around the height 0 has no energy there. */
TEST(a_square_begins_at_the_height_0)
{
    for (int n = 2; n <= 60; n++) {
        Simulation *simulation = simulate("hang --segments %d", n);
        CHECK_NEAR(simulation_energies(simulation, 0).gravity, 0, 0);
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
        double rest[2];
        square_mesh_place(&simulation->mesh, i, rest);
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
            square_mesh_shape(cases[i].columns, cases[i].rows, 1, 1);
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
    const SquareMesh shape = square_mesh_shape(2, 2, 1, 1);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        CHECK_STATUS(pins_read(bad[i], &shape, NULL), STATUS_INVALID_INPUT);
}

TESTS(NULL, NULL)
