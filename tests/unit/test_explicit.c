/* Explicit integrators touch neither Newton nor CHOLMOD: the calls of CHOLMOD
 * are counted.  Linked with -Wl,--wrap=... for each function counted here.
 */
#include "test.h"

#include <cholmod.h>
#include <stdio.h>
#include <string.h>

static long calls; /* of CHOLMOD, so far */

int __real_cholmod_start(cholmod_common *common);
cholmod_factor *__real_cholmod_analyze(cholmod_sparse *A,
                                       cholmod_common *common);
int __real_cholmod_factorize(cholmod_sparse *A, cholmod_factor *L,
                             cholmod_common *common);
int __wrap_cholmod_start(cholmod_common *common);
cholmod_factor *__wrap_cholmod_analyze(cholmod_sparse *A,
                                       cholmod_common *common);
int __wrap_cholmod_factorize(cholmod_sparse *A, cholmod_factor *L,
                             cholmod_common *common);

int __wrap_cholmod_start(cholmod_common *common)
{
    calls++;
    return __real_cholmod_start(common);
}

cholmod_factor *__wrap_cholmod_analyze(cholmod_sparse *A,
                                       cholmod_common *common)
{
    calls++;
    return __real_cholmod_analyze(A, common);
}

int __wrap_cholmod_factorize(cholmod_sparse *A, cholmod_factor *L,
                             cholmod_common *common)
{
    calls++;
    return __real_cholmod_factorize(A, L, common);
}

/* Ten steps of this scene with this method; small ones, so that all are
 * stable. */
static void run(const char *scene, const char *method, Simulation *simulation)
{
    char line[128];
    snprintf(line, sizeof line, "%s --timestep 0.001%s%s", scene,
             method ? " --integrator " : "", method ? method : "");
    calls = 0;
    simulation_from_line(line, NULL, NULL, simulation);
    for (int i = 0; i < 10; i++)
        CHECK_STATUS(simulation_step(simulation), STATUS_OK);
}

/* No call, no Newton object, no Hessian, and nothing counted. */
TEST(explicit_methods_have_no_matrix)
{
    const char *names[] = {"square", "circle", "unprojected"};
    const NewtonCounters zero = {0};
    int checked = 0;
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        for (int i = 0; i < 3 && !row->implicit; i++, checked++) {
            Simulation simulation;
            run(names[i], row->name, &simulation);
            NewtonCounters sum = simulation_counters(&simulation);
            CHECK(calls == 0 && !simulation.run[0].newton);
            CHECK(simulation_matrix_entries(&simulation) == 0);
            CHECK(memcmp(&sum, &zero, sizeof sum) == 0);
            CHECK(!simulation_has_filter(&simulation));
            CHECK(!simulation_has_line_search(&simulation));
            simulation_free(&simulation);
        }
    CHECK(checked >= 9);
}

/* The same counters do count. */
TEST(implicit_methods_have_one)
{
    int checked = 0;
    for (const IntegratorMethod *row = integrator_methods; row->name; row++)
        if (row->implicit) {
            Simulation simulation;
            run("square", row->name, &simulation);
            CHECK(calls >= 3);
            CHECK(simulation_matrix_entries(&simulation) > 100);
            CHECK(simulation_counters(&simulation).factorisations > 0);
            CHECK(simulation_has_filter(&simulation));
            simulation_free(&simulation);
            checked++;
        }
    CHECK(checked >= 5);
}

/* Without springs not even backward Euler needs a matrix. */
TEST(the_circle_needs_no_matrix)
{
    Simulation simulation;
    run("circle", NULL, &simulation);
    CHECK(simulation.runs == 3 && calls == 0);
    CHECK(simulation_matrix_entries(&simulation) == 0);
    simulation_free(&simulation);
}

TESTS(NULL, NULL)
