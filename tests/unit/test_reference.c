/* test_reference.c - the program and src/lecture.c against trajectories of the
 * lecture's Python code in tests/data/reference. (check_lecture.sh compares
 * both with other sizes, densities and stiffnesses.) */
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/contact.h"

#define main lecture_main
int main(int argc, char **argv);
#include "lecture.c"
#undef main

/* ---- one reader -------------------------------------------------------- */

enum { MAX_UPDATE_ROWS = 1024 };

/* The Newton updates of a table, or of a run */
typedef struct NewtonUpdates {
    int row_count;
    struct {
        long step_index;
        int update_index;
        double residual, alpha;
    } row[MAX_UPDATE_ROWS];
} NewtonUpdates;

static FILE *open_reference(const char *name, const char *kind)
{
    char path[128], header[128];
    snprintf(path, sizeof path, "tests/data/reference/%s.%s.csv", name, kind);
    FILE *file = fopen(path, "r");
    if (!file)
        print_error("%s: run this from the top of the project\n", path);
    CHECK(file && fgets(header, sizeof header, file));
    return file;
}

static void read_updates(FILE *file, NewtonUpdates *updates)
{
    int i = 0;
    while (i < MAX_UPDATE_ROWS &&
           fscanf(file, "%ld,%d,%lf,%lf", &updates->row[i].step_index,
                  &updates->row[i].update_index, &updates->row[i].residual,
                  &updates->row[i].alpha) == 4)
        i++;
    CHECK(i < MAX_UPDATE_ROWS && feof(file));
    updates->row_count = i;
    fclose(file);
}

static bool store_update(void *user, const NewtonRecord *record)
{
    NewtonUpdates *kept = user;
    CHECK(kept->row_count < MAX_UPDATE_ROWS);
    int i = kept->row_count++;
    kept->row[i].step_index = record->step_number;
    kept->row[i].update_index = record->iteration;
    kept->row[i].residual = record->residual;
    kept->row[i].alpha = record->alpha;
    return true;
}

/* Checks that updates have the same steps and alpha. An alpha that is a power
 * of two is equal; where contact limits it, alpha agrees to 1e-11. Residuals
 * agree to 1e-8: at the end of a step they are small differences. */
static void check_updates(const NewtonUpdates *got,
                          const NewtonUpdates *expected)
{
    CHECK_NEAR(got->row_count, expected->row_count, 0);
    for (int i = 0; i < got->row_count; i++) {
        double alpha = expected->row[i].alpha;
        double residual = expected->row[i].residual;
        CHECK(got->row[i].step_index == expected->row[i].step_index);
        CHECK(got->row[i].update_index == expected->row[i].update_index);
        CHECK_NEAR(got->row[i].alpha, alpha,
                   log2(alpha) == rint(log2(alpha)) ? 0 : 1e-11);
        CHECK_NEAR(got->row[i].residual, residual, 1e-8 * residual);
    }
}

/* Checks the rows of one step in a table of states. */
static void check_state(FILE *file, long step, int nodes, const double *x,
                        const double *v, double x_tolerance, double v_tolerance)
{
    for (int i = 0; i < nodes; i++) {
        long at;
        int node;
        double X[2], V[2];
        CHECK(fscanf(file, "%ld,%*f,%d,%lf,%lf,%lf,%lf", &at, &node, &X[0],
                     &X[1], &V[0], &V[1]) == 6);
        CHECK(at == step && node == i);
        for (int axis = 0; axis < 2; axis++) {
            CHECK_NEAR(x[2 * i + axis], X[axis], x_tolerance);
            CHECK_NEAR(v[2 * i + axis], V[axis], v_tolerance);
        }
    }
}

/* ---- the slides' trajectories ------------------------------------------ */

/* A row of the table in tests/data/reference/README.md */
typedef struct ReferenceCase {
    char name[32], tested_program[8], line[320];
    int steps_per_state, steps;
} ReferenceCase;

static ReferenceCase cases[32];
static int case_count;

static int read_cases(void **unused)
{
    char row[512];
    FILE *file = fopen("tests/data/reference/README.md", "r");
    (void)unused;
    assert_non_null(file);
    while (fgets(row, sizeof row, file)) {
        ReferenceCase *it = &cases[case_count];
        case_count += sscanf(row, "| %31s | %7s | %d | %d | %*f | `%319[^`]",
                             it->name, it->tested_program, &it->steps_per_state,
                             &it->steps, it->line) == 5;
    }
    fclose(file);
    return case_count == 19 ? 0 : -1;
}

static bool case_covers(const ReferenceCase *one, const char *who)
{
    return strcmp(one->tested_program, who) == 0;
}

/* Reads the start of a run. Checks that nodes move by at most `most`, m. */
static void read_start_state(FILE *file, TimeIntegrator *run, double most)
{
    for (int i = 0; i < 2 * run->system->nodes; i += 2) {
        double x[2] = {run->x[i], run->x[i + 1]};
        CHECK(fscanf(file, "%*d,%*f,%*d,%lf,%lf,%lf,%lf", &run->x[i],
                     &run->x[i + 1], &run->v[i], &run->v[i + 1]) == 4);
        CHECK_AT_MOST(hypot(run->x[i] - x[0], run->x[i + 1] - x[1]), most);
    }
}

/* The program, at the tolerance 1e-9 m/s, follows the trajectories of files.
 * Lessons 2, 3 and 4: the slides' programs wrote the files at 1e-6 m/s, which
 * leaves an error of 2e-8 m in each of up to 120 steps. Lessons 6, 7 and 8:
 * another program wrote the files at 1e-9 m/s, because the slides' program cuts
 * entries of the Hessian to integers. These runs begin at the file's first
 * state. */
TEST(the_program_follows_the_slides)
{
    for (int i = 0; i < case_count; i++) {
        const ReferenceCase *it = &cases[i];
        bool solid = case_covers(it, "solid");
        if (case_covers(it, "lecture"))
            continue;
        FILE *file = open_reference(it->name, "states");
        Simulation *scene = simulate("%s --tolerance 1e-9", it->line);
        TimeIntegrator *run = &scene->run[0];
        if (solid)
            read_start_state(file, run,
                             strstr(it->line, "--body") ? 1e-15 : INFINITY);
        for (int step = solid ? it->steps_per_state : 0; step <= it->steps;
             step += it->steps_per_state) {
            make_steps(scene, step > 0 ? it->steps_per_state : 0);
            check_state(file, step, run->system->nodes, run->x, run->v,
                        solid ? 1e-8 : 1e-6, (solid ? 1e-8 : 1e-6) / run->h);
        }
        CHECK(fscanf(file, " %*c") == EOF); /* the file ends here */
        fclose(file);
    }
}

/* The slides' fifth program at a small tolerance: a ceiling comes down at 0.5
 * m/s. A stiff spring pulls the ceiling of the reference, with an error of 1e-6
 * m; here the ceiling moves exactly. Only the ground has friction. */
TEST(a_ceiling_comes_down_as_in_the_lesson)
{
    Simulation *scene = simulate(
        "square --segments 4 --stiffness 2e4 --stretch 1 --timestep 0.01 "
        "--gravity 9.81 --barrier 0.01,1e5 --tolerance 1e-6 --friction 0.11 "
        "--ground 0,1,0,-1 --at 0,-0.3 --ceiling 0.25,-0.5,-9");
    const TimeIntegrator *run = &scene->run[0];
    const Obstacle *ceiling = &get_contact(run->system)->obstacle[1];
    FILE *file = open_reference("ceiling_tight", "states");
    for (int step = 0; step <= 120; step++) {
        double y;
        make_steps(scene, step > 0);
        check_state(file, step, run->system->nodes, run->x, run->v, 2e-6,
                    INFINITY);
        CHECK(fscanf(file, "%*d,%*f,%*d,%*f,%lf,%*f,%*f", &y) == 1);
        CHECK_NEAR(ceiling->o[1], y, 2e-6);
    }
    CHECK_NEAR(ceiling->o[1], 0.25 - 0.5 * 1.2, 1e-12);
    CHECK(simulation_get_energies(scene, 0).work > 0);
    fclose(file);
}

/* ---- lecture.c --------------------------------------------------------- */

static void free_solid(Solid *solid)
{
    free(solid->x);
    free(solid->v);
    free(solid->m);
    free(solid->e);
}

/* lecture.c follows the slides: x agrees to 1e-9 m, v to 1e-8 m/s. Steps leak
 * no memory; the C library may keep 20 kB. */
TEST(lecture_follows_the_slides)
{
    static NewtonUpdates got, expected;
    for (int i = 0; i < case_count && case_covers(&cases[i], "lecture"); i++) {
        const Options options = simulate("%s", cases[i].line)->options;
        Solid solid = square(1, options.segments, 1000, options.stiffness);
        FILE *file = open_reference(cases[i].name, "states");
        FILE *table = tmpfile();
        CHECK(table != NULL);
        for (int k = 0; k < solid.nodes; k++)
            solid.x[k].x *= options.stretch;
        double held = 0;
        for (int step = 0; step <= cases[i].steps; step++) {
            held = step == 2 ? count_heap_bytes() : held;
            if (step > 0)
                step_forward(&solid, options.timestep, options.tolerance, step,
                             table);
            check_state(file, step, solid.nodes, &solid.x->x, &solid.v->x, 1e-9,
                        1e-8);
        }
        CHECK_AT_MOST(count_heap_bytes() - held, 2e4);
        fclose(file);
        rewind(table);
        read_updates(table, &got);
        read_updates(open_reference(cases[i].name, "newton"), &expected);
        check_updates(&got, &expected);
        free_solid(&solid);
    }
}

/* Sends lecture.c an event with one or two numbers; false: the event quits. */
static bool send_event(Screen *screen, Solid *solid, Uint32 type, int a, int b)
{
    SDL_Event event = {.type = type};
    if (type == SDL_KEYDOWN)
        event.key.keysym.sym = a;
    else if (type == SDL_MOUSEMOTION)
        event.motion = (SDL_MouseMotionEvent){.type = type, .x = a, .y = b};
    else if (type == SDL_WINDOWEVENT)
        event.window.event = (Uint8)a;
    return handle_event(screen, solid, &event);
}

/* The mouse holds the nearest node until the button is released or the window
 * loses the focus; in a step the node moves a third of the way to the mouse.
 * Space pauses, R restarts, Escape ends. Here 150 of 600 pixels are 1 m. */
TEST(hands_act_on_lecture)
{
    Solid solid = square(1, 4, 1000, 1e5);
    Vec2 start[25];
    memcpy(start, solid.x, sizeof start);
    Screen screen = {.scale = 150, .pulled = -1, .x_start = start};
    for (int end = 0; end < 2; end++) {
        double m = solid.m[24];
        CHECK(send_event(&screen, &solid, SDL_MOUSEMOTION, 390, 240));
        CHECK(send_event(&screen, &solid, SDL_MOUSEBUTTONDOWN, 0, 0));
        CHECK(screen.pulled == 24 && solid.m[24] >= 1000 * m);
        CHECK(send_event(&screen, &solid, SDL_MOUSEMOTION, 150, 450));
        CHECK(send_event(&screen, &solid, SDL_MOUSEBUTTONDOWN, 0, 0));
        CHECK(send_event(&screen, &solid, SDL_WINDOWEVENT, 1, 0));
        CHECK(screen.pulled == 24 && show(&screen, &solid, 0.01, 1));
        CHECK_NEAR(distance(solid.v[24], (Vec2){-50, -50}), 0, 1e-9);
        CHECK(send_event(&screen, &solid,
                         end ? SDL_MOUSEBUTTONUP : SDL_WINDOWEVENT,
                         SDL_WINDOWEVENT_FOCUS_LOST, 0));
        CHECK(screen.pulled == -1);
        CHECK_NEAR(solid.m[24], m, 1e-9 * m);
    }
    solid.x[7].x += 1;
    CHECK(send_event(&screen, &solid, SDL_KEYDOWN, SDLK_r, 0));
    for (int i = 0; i < 25; i++)
        CHECK(distance(solid.x[i], start[i]) + dot(solid.v[i], solid.v[i]) ==
              0);
    for (int i = 0; i < 2; i++)
        CHECK(screen.is_paused == (i == 1) &&
              send_event(&screen, &solid, SDL_KEYDOWN, SDLK_SPACE, 0));
    CHECK(!screen.is_paused);
    CHECK(!send_event(&screen, &solid, SDL_KEYDOWN, SDLK_ESCAPE, 0));
    CHECK(!send_event(&screen, &solid, SDL_QUIT, 0, 0));
    free_solid(&solid);
}

/* Makes a step of lecture.c that updates x and then tests p. All of p is used
 * if it is so short that rounding of E hides its effect. */
static void make_step_tested_last(Solid *solid, double h, double tol, int step,
                                  NewtonUpdates *updates)
{
    int n = solid->nodes;
    size_t bytes = (size_t)n * sizeof(Vec2);
    Vec2 *x = solid->x;
    Vec2 *x_n = allocate(4 * n, sizeof *x_n), *x_tilde = x_n + n;
    Vec2 *p = x_tilde + n, *x_new = p + n;
    memcpy(x_n, x, bytes);
    for (int i = 0; i < n; i++)
        x_tilde[i] = add(x[i], mul(h, solid->v[i]));
    for (int update = 0;; update++) {
        search_dir(solid, x, x_tilde, h, p);
        double alpha = 1;
        if (residual(solid, p, h) > 1e-3)
            alpha = line_search(solid, x, p, x_tilde, h, x_new);
        else
            for (int i = 0; i < n; i++)
                x_new[i] = add(x[i], p[i]);
        CHECK(updates->row_count < MAX_UPDATE_ROWS);
        updates->row[updates->row_count].step_index = step;
        updates->row[updates->row_count].update_index = update;
        updates->row[updates->row_count].residual = residual(solid, p, h);
        updates->row[updates->row_count++].alpha = alpha;
        memcpy(x, x_new, bytes);
        if (residual(solid, p, h) <= tol)
            break;
    }
    for (int i = 0; i < n; i++)
        solid->v[i] = mul(1 / h, sub(x[i], x_n[i]));
    free(x_n);
}

/* Checks that updates agree. The program may omit updates whose residual is at
 * most `negligible`, m/s, where p is a millionth of a spring's length.
 * Residuals agree to 2 % plus 1e-3 of the tolerance: a factor of an earlier
 * iterate gives a p with a relative error of 1e-4, 2 % of a next p that is 200
 * times shorter. */
static void check_same_updates(const NewtonUpdates *got,
                               const NewtonUpdates *expected, double tolerance,
                               double negligible)
{
    int i = 0;
    for (int k = 0; k < expected->row_count; k++) {
        double residual = expected->row[k].residual;
        bool there = i < got->row_count &&
                     got->row[i].step_index == expected->row[k].step_index &&
                     got->row[i].update_index == expected->row[k].update_index;
        if (!there) {
            CHECK_AT_MOST(residual, negligible);
            continue;
        }
        CHECK(got->row[i].alpha == expected->row[k].alpha);
        CHECK_NEAR(got->row[i].residual, residual,
                   0.02 * residual + 1e-3 * tolerance);
        i++;
    }
    CHECK(i == got->row_count && i > 10);
}

/* The program makes the same updates as lecture.c with p tested after the
 * update. In 15 steps x differs by at most 1e-5 m at the slides' tolerance, as
 * the program refines directions, and by 1e-8 m at the tolerance 1e-9 m/s. */
TEST(the_program_makes_the_updates_of_lecture)
{
    static NewtonUpdates got, expected;
    for (int i = 0; i < case_count && case_covers(&cases[i], "lecture"); i++)
        for (int tight = 0; tight < 2; tight++) {
            got.row_count = expected.row_count = 0;
            Simulation *scene =
                simulate_observed(store_update, &got, "%s %s", cases[i].line,
                                  tight ? "--tolerance 1e-9" : "");
            const Options *options = &scene->options;
            const TimeIntegrator *run = &scene->run[0];
            double h = options->timestep;
            Solid solid =
                square(1, options->segments, 1000, options->stiffness);
            for (int k = 0; k < solid.nodes; k++)
                solid.x[k].x *= options->stretch;
            for (int step = 1; step <= 15; step++) {
                make_steps(scene, 1);
                make_step_tested_last(
                    &solid, h, tight && h > 0.05 ? 1e-7 : options->tolerance,
                    step, &expected);
                for (int k = 0; k < 2 * solid.nodes; k++)
                    CHECK_NEAR(run->x[k], (&solid.x->x)[k],
                               tight ? 1e-8 : 1e-5);
            }
            if (!tight)
                check_same_updates(&got, &expected, options->tolerance,
                                   1e-6 / options->segments / h);
            free_solid(&solid);
        }
}

/* Both methods of explicit_euler in lecture.c agree with the program's. */
TEST(explicit_euler_agrees_with_the_program)
{
    static const char *const lines[] = {
        "--integrator forward-euler --timestep 0.001",
        "--integrator symplectic-euler --segments 6 --timestep 0.001"};
    for (int symplectic = 0; symplectic < 2; symplectic++) {
        Simulation *simulation = simulate("%s", lines[symplectic]);
        const TimeIntegrator *run = &simulation->run[0];
        Solid solid = square(1, symplectic ? 6 : 4, 1000, 1e5);
        for (int i = 0; i < solid.nodes; i++)
            solid.x[i].x *= 1.4;
        make_steps(simulation, 20);
        for (int step = 0; step < 20; step++)
            explicit_euler(&solid, 0.001, symplectic);
        for (int i = 0; i < 2 * solid.nodes; i++) {
            CHECK_NEAR((&solid.x->x)[i], run->x[i], 1e-12);
            CHECK_NEAR((&solid.v->x)[i], run->v[i], 1e-10);
        }
        free_solid(&solid);
    }
}

/* Returns the largest relative change of the energy of the stretched square in
 * `steps` time steps of c/n_seg s, at most 1000. */
static double find_energy_deviation(int n_seg, double c, int steps)
{
    Solid solid = square(1, n_seg, 1000, 1e5);
    double start, most = 0;
    for (int i = 0; i < solid.nodes; i++)
        solid.x[i].x *= 1.4;
    start = spring_val(&solid, solid.x);
    for (int step = 0; step < steps && most < 1000; step++) {
        explicit_euler(&solid, c / n_seg, true);
        double E = spring_val(&solid, solid.x);
        for (int i = 0; i < solid.nodes; i++)
            E += 0.5 * solid.m[i] * dot(solid.v[i], solid.v[i]);
        double part = fabs(E / start - 1);
        most = part < 1000 ? fmax(most, part) : 1000;
    }
    free_solid(&solid);
    return most;
}

/* The comment above explicit_euler in lecture.c is right about a stable and an
 * unstable time step. With the stable one the energy deviates by 0.19, 0.09 and
 * 0.05 of its start, because x and v are half a step apart. */
TEST(symplectic_euler_stays_as_long_as_it_says)
{
    static const int n_seg[] = {4, 8, 16};
    for (int i = 0; i < 3; i++) {
        CHECK(find_energy_deviation(n_seg[i], 0.01, 3000) <= 0.25);
        CHECK(find_energy_deviation(n_seg[i], 0.025, 50) == 1000);
    }
}

TESTS(read_cases, NULL)
