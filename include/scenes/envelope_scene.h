/* envelope_scene.h - how far the solver can be trusted: the default square with
 * every time step from 1e-9 to 1e3 s and every stiffness from 1e-6 to 1e15
 * J/m^2, three steps each.
 *
 * A step of the scene fills one row of the map.  Cells whose steps converge
 * tell with how many updates, or that the tolerance was too loose for any to be
 * made; the others tell which status they ended with.
 */
#ifndef ELASTO_ENVELOPE_SCENE_H
#define ELASTO_ENVELOPE_SCENE_H

#include "scenes/scene.h"

enum { ENVELOPE_STEPS = 3 };

/* s, of column 0 ... ENVELOPE_COLUMNS - 1; J/m^2, of row 0 ... ENVELOPE_ROWS
 * - 1 */
double envelope_timestep(int column);
double envelope_stiffness(int row);

/* Run 0 is the cell that is shown; at first the one nearest to the options. */
Status create_envelope(Simulation *simulation, const NewtonSettings *settings);

/* The next row, from the softest to the stiffest. */
Status step_envelope(Simulation *simulation);

/* Runs one cell and shows it: run 0 is then its run.  Returns OK also where the
 * cell's steps did not converge; OUT_OF_MEMORY. */
Status envelope_visit(Simulation *simulation, int column, int row);

/* The command line that runs a cell in the window.  line [size] out */
void envelope_line(const Simulation *simulation, int column, int row,
                   char *line, size_t size);

#endif
