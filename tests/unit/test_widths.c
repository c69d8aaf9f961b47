/* test_widths.c - multigrid's loops, compiled for one number at a time, and the
 * Cholesky panels, for two, give the same bits as the program (ELASTO, or
 * build/elasto), which uses the widest registers of the processor. */
#include "test.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static uint64_t read_program_hash(const char *line, int steps)
{
    const char *program = getenv("ELASTO");
    char command[300], row[200];
    uint64_t hash = 0;
    snprintf(command, sizeof command, "%s %s --headless --steps %d",
             program ? program : "build/elasto", line, steps);
    FILE *output = popen(command, "r");
    CHECK(output != NULL);
    while (fgets(row, sizeof row, output))
        sscanf(row, "state hash %" SCNx64, &hash);
    CHECK(pclose(output) == 0);
    return hash;
}

TEST(bits_do_not_depend_on_registers)
{
    static const struct {
        const char *line;
        int steps;
    } rows[] = {{"--segments 40 --stretch 1.4", 10},
                {"--segments 51 --stretch 1.5 --pin left", 6},
                {"--segments 18 --stretch 0.5 --timestep 0.02 "
                 "--solver multigrid",
                 4},
                {"--segments 18 --solver newton", 4}};
    for (int i = 0; i < 4; i++) {
        Simulation *narrow =
            make_steps(simulate("%s", rows[i].line), rows[i].steps);
        CHECK((narrow->run[0].newton->counters.v_cycles > 0) == (i < 3));
        CHECK(i > 0 || narrow->run[0].newton->counters.tile_sweeps > 0);
        CHECK(state_hash(narrow, STATE_HASH_SEED) ==
              read_program_hash(rows[i].line, rows[i].steps));
    }
}

TESTS(NULL, NULL)
