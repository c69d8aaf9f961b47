/* The program against the slides' own: nine trajectories of the lecture's
 * Python code, in tests/data/reference.
 */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 1024 };

/* One file of Newton updates, and our own beside it. */
typedef struct Updates {
    int count;
    long step[ROWS];
    int iteration[ROWS];
    double residual[ROWS], alpha[ROWS];
} Updates;

static FILE *reference_file(const char *name, const char *kind)
{
    char path[128], header[128];
    snprintf(path, sizeof path, "tests/data/reference/%s.%s.csv", name, kind);
    FILE *file = fopen(path, "r");
    if (!file)
        print_error("%s: run this from the top of the project\n", path);
    CHECK(file != NULL);
    CHECK(fgets(header, sizeof header, file) != NULL);
    return file;
}

static void read_updates(const char *name, Updates *updates)
{
    FILE *file = reference_file(name, "newton");
    int i = 0;
    while (i < ROWS && fscanf(file, "%ld,%d,%lf,%lf", &updates->step[i],
                              &updates->iteration[i], &updates->residual[i],
                              &updates->alpha[i]) == 4)
        i++;
    CHECK(i > 0 && i < ROWS && feof(file));
    updates->count = i;
    fclose(file);
}

static bool record_update(void *user, const NewtonRecord *record)
{
    Updates *updates = user;
    if (record->iteration < 0)
        return true;
    int i = updates->count < ROWS ? updates->count++ : ROWS - 1;
    updates->step[i] = record->step;
    updates->iteration[i] = record->iteration;
    updates->residual[i] = record->residual;
    updates->alpha[i] = record->alpha;
    return true;
}

/* The same updates in the same steps with the same alpha; residuals to 1e-8:
 * those near the end of a step are differences of nearly equal numbers. */
static void check_updates(const Updates *got, const Updates *expected)
{
    CHECK_NEAR(got->count, expected->count, 0);
    for (int i = 0; i < got->count; i++) {
        CHECK_NEAR(got->step[i], expected->step[i], 0);
        CHECK_NEAR(got->iteration[i], expected->iteration[i], 0);
        /* a power of two, or what a gap of the size 1e-3 lets through */
        CHECK_NEAR(got->alpha[i], expected->alpha[i],
                   log2(expected->alpha[i]) == rint(log2(expected->alpha[i]))
                       ? 0
                       : 1e-11);
        CHECK_NEAR(got->residual[i], expected->residual[i],
                   1e-8 * expected->residual[i]);
    }
}

/* A disturbance of 1e-12 grows about tenfold: 1e-9 m is what another order of
 * the sums may do, not another algorithm.  Velocities: 1e-9 of the largest. */
static void check_states(FILE *file, const Simulation *simulation,
                         double largest_v)
{
    const TimeIntegrator *run = &simulation->run[0];
    for (int i = 0; i < run->system->nodes; i++) {
        long step;
        int node;
        double t, x[2], v[2];
        CHECK(fscanf(file, "%ld,%lf,%d,%lf,%lf,%lf,%lf", &step, &t, &node,
                     &x[0], &x[1], &v[0], &v[1]) == 7);
        CHECK(step == simulation->steps && node == i);
        CHECK_NEAR(simulation_time(simulation), t, 1e-12);
        for (int axis = 0; axis < 2; axis++) {
            CHECK_NEAR(run->x[2 * i + axis], x[axis], 1e-9);
            CHECK_NEAR(run->v[2 * i + axis], v[axis], 1e-9 * largest_v);
        }
    }
}

/* The largest component of a velocity in the file. */
static double largest_velocity(const char *name)
{
    FILE *file = reference_file(name, "states");
    double largest = 0, v[2];
    while (fscanf(file, "%*d,%*f,%*d,%*f,%*f,%lf,%lf", &v[0], &v[1]) == 2)
        largest = fmax(largest, fmax(fabs(v[0]), fabs(v[1])));
    CHECK(largest > 0 && feof(file));
    fclose(file);
    return largest;
}

static void check_case(const char *name, const char *line, int steps)
{
    static Updates got, expected;
    got.count = 0;
    read_updates(name, &expected);
    double largest_v = largest_velocity(name);
    FILE *file = reference_file(name, "states");
    Simulation *simulation = simulate_watched(record_update, &got, "%s", line);
    check_states(file, simulation, largest_v);
    for (int step = 0; step < steps; step++) {
        make_steps(simulation, 1);
        check_states(file, simulation, largest_v);
    }
    CHECK(fscanf(file, " %*c") == EOF); /* nothing is left */
    check_updates(&got, &expected);
    CHECK(simulation_counters(simulation).iterations == expected.count);
    fclose(file);
}

TEST(default_scene)
{
    check_case("default", "square", 50);
}

TEST(one_cell)
{
    check_case("one_cell", "--segments 1", 60);
}

TEST(gentle_8)
{
    check_case("gentle_8", "--segments 8 --stretch 1.1", 25);
}

TEST(compressed)
{
    check_case("compressed", "--stretch 0.5 --timestep 0.02", 25);
}

TEST(stiff_large_step)
{
    check_case("stiff_large_step",
               "--segments 3 --stiffness 1e8 --stretch 2.5 --timestep 0.1", 20);
}

TEST(squashed)
{
    check_case("squashed",
               "--segments 3 --stretch 0.05 --timestep 0.1 --tolerance 1e-3",
               15);
}

/* Gravity and pins, from the lecture's second program. */
TEST(hang)
{
    check_case("hang",
               "hang --segments 4 --stiffness 1e3 --timestep 0.02 "
               "--tolerance 1e-2",
               60);
}

TEST(hang_tight)
{
    check_case("hang_tight",
               "square --gravity 9.81 --pin 24,4 --stretch 1 --segments 4 "
               "--stiffness 1e3 --timestep 0.02 --tolerance 1e-6",
               60);
}

TEST(hang_corner)
{
    check_case("hang_corner", "hang --segments 6 --pin 6 --tolerance 1e-6", 40);
}

/* Contact and friction, from its third and fourth programs: the same numbers
 * as theirs for the body, the barrier and the slip speed. */
#define LESSON                                                                 \
    "square --segments 4 --stiffness 2e4 --stretch 1 --timestep 0.01 "         \
    "--gravity 9.81 --barrier 0.01,1e5 "

TEST(drop)
{
    check_case("drop", LESSON "--ground 0,1,0,-1", 80);
}

TEST(drop_tight)
{
    check_case("drop_tight", LESSON "--tolerance 1e-6 --ground 0,1,0,-1", 80);
}

TEST(drop_turned)
{
    check_case("drop_turned",
               LESSON "--tolerance 1e-6 --ground 0,2,5,-1 --turn 20 --at "
                      "0,-0.2 --velocity 0,-2",
               50);
}

TEST(slope_stick)
{
    check_case("slope_stick",
               LESSON "--ground 0.1,1,0,-1 --friction 0.11 --at 0,-0.42", 120);
}

TEST(slope_stick_tight)
{
    check_case("slope_stick_tight",
               LESSON "--tolerance 1e-6 --ground 0.1,1,0,-1 --friction 0.11 "
                      "--slip-speed 1e-3 --at 0,-0.42",
               120);
}

TEST(slope_slide_tight)
{
    check_case("slope_slide_tight",
               LESSON "--tolerance 1e-6 --ground 0.5,1,0,-1 --friction 0.3 "
                      "--at 0,-0.2 --cells off",
               60);
}

TESTS(NULL, NULL)
