/* The loops of multigrid, compiled once more for one number at a time: their
 * bits are those of the program, which takes as many as the processor has.
 */
#include <stdlib.h>
#include <string.h>

#define FAST
#define rows_of                scalar_rows_of
#define memory_piece           scalar_memory_piece
#define memory_create          scalar_memory_create
#define grid_lay_out           scalar_grid_lay_out
#define grid_read_system       scalar_grid_read_system
#define grid_read_state        scalar_grid_read_state
#define grid_displacement      scalar_grid_displacement
#define grid_gradient          scalar_grid_gradient
#define grid_remainder         scalar_grid_remainder
#define grid_along             scalar_grid_along
#define grid_move              scalar_grid_move
#define grid_shift             scalar_grid_shift
#define tiles_lay_out          scalar_tiles_lay_out
#define tiles_relax            scalar_tiles_relax
#define v_cycle_lay_out        scalar_v_cycle_lay_out
#define v_cycle_read_system    scalar_v_cycle_read_system
#define v_solve                scalar_v_solve
#define v_decides              scalar_v_decides
#define multigrid_create       scalar_create
#define multigrid_free         scalar_free
#define multigrid_start        scalar_start
#define multigrid_iterate      scalar_iterate
#define multigrid_displacement scalar_displacement
#define multigrid_record       scalar_record
#include "solve/grid.c"
#include "solve/grid_energy.c"
#include "solve/tiles.c"
#include "solve/v_cycle.c"
#include "solve/multigrid.c"
#undef multigrid_create
#undef multigrid_free
#undef multigrid_start
#undef multigrid_iterate
#undef multigrid_displacement
#undef multigrid_record

/* Those of the library. */
Status multigrid_create(int segments, int threads, Multigrid **multigrid);
void multigrid_free(Multigrid *multigrid);
Status multigrid_start(Multigrid *multigrid, const MultigridStep *step);
Status multigrid_iterate(Multigrid *multigrid);
void multigrid_displacement(const Multigrid *multigrid, double *u);

#include "test.h"

/* Steps of a square; each of one solver is the other's, too. */
static void compare(const char *line, int steps)
{
    Simulation simulation;
    simulation_from_line(line, NULL, NULL, &simulation);
    TimeIntegrator *run = &simulation.run[0];
    const System *system = run->system;
    int size = 2 * system->nodes;
    double *u[2] = {calloc((size_t)size, sizeof(double)),
                    calloc((size_t)size, sizeof(double))};
    double *u_tilde = calloc((size_t)size, sizeof *u_tilde);
    Multigrid *scalar, *wide;
    assert_true(u[0] && u[1] && u_tilde);
    CHECK_STATUS(scalar_create(system->segments, 1, &scalar), STATUS_OK);
    CHECK_STATUS(multigrid_create(system->segments, 1, &wide), STATUS_OK);
    NewtonCounters did = {0};
    MultigridStep step = {.x_n = run->x,
                          .counters = &did,
                          .u_tilde = u_tilde,
                          .m = system->m,
                          .pinned = system->pinned,
                          .k = system->k,
                          .l2 = system->l2,
                          .weight = run->h * run->h,
                          .h = run->h,
                          .tolerance = simulation.options.tolerance,
                          .is_free = !system->pinned};
    for (int i = 0; i < steps; i++) {
        Status one = scalar_start(scalar, &step);
        Status other = multigrid_start(wide, &step);
        while (one == STATUS_RUNNING && other == STATUS_RUNNING) {
            one = scalar_iterate(scalar);
            other = multigrid_iterate(wide);
            scalar_displacement(scalar, u[0]);
            multigrid_displacement(wide, u[1]);
            CHECK_SAME_BITS(u[0], u[1], size);
        }
        CHECK(one == STATUS_OK && other == STATUS_OK);
        for (int k = 0; k < size; k++) {
            run->x[k] += u[0][k];
            u_tilde[k] = u[0][k];
        }
    }
    CHECK(did.local > 0 || steps < 10);
    scalar_free(scalar);
    multigrid_free(wide);
    free(u[0]);
    free(u[1]);
    free(u_tilde);
    simulation_free(&simulation);
}

TEST(bits_do_not_depend_on_registers)
{
    compare("--segments 40 --stretch 1.4", 10);
    compare("--segments 51 --stretch 1.5 --pin left", 6);
    compare("--segments 18 --stretch 0.5 --timestep 0.02", 4);
}

TESTS(NULL, NULL)
