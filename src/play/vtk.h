/* vtk.h - one step as a file that ParaView and VTK read (XML, PolyData).
 *
 * Points are the nodes of all runs, in the order of the states; lines are the
 * springs that are whole; triangles those of the cells whose sides are whole
 * (square_mesh_is_half).  Points have velocity (m/s) and run, lines and
 * triangles strain: Green's |d|^2/l2 - 1, of a triangle what its area has
 * grown by, as a part.  17 digits: reading them gives the same double.
 */
#ifndef ELASTO_VTK_H
#define ELASTO_VTK_H

#include "scenes/simulation.h"

/* The file's name in a folder: "step_000012.vtp". */
enum { VTK_NAME_SIZE = 32 };
void vtk_name(long step, char name[VTK_NAME_SIZE]);

/* Writes `count` simulations as they are, whole or not at all (output.h).
 * Returns OK, OUT_OF_MEMORY, FILE_FAILED (errno tells why). */
Status vtk_write(const char *name, const Simulation *const *simulation,
                 int count);

#endif
