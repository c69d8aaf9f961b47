/* vtk.c - steps for ParaView: an unstructured grid in XML each, and the list of
 * all.  17 digits: reading them gives the same double.
 */
#include <string.h>

#include "model/area.h"
#include "model/mass_spring_energy.h"
#include "play/recording.h"

void vtk_name(long step, char name[VTK_NAME_SIZE])
{
    snprintf(name, VTK_NAME_SIZE, "step_%06ld.vtu", step);
}

enum { PARTS = OPTIONS_MAX_PANES * SIMULATION_MAX_RUNS };

/* Nodes of a cell, and what VTK calls it. */
enum { LINE = 2, TRIANGLE = 3, VTK_LINE = 3, VTK_TRIANGLE = 5 };

/* A run. */
typedef struct Part {
    const SquareMesh *mesh;
    const TimeIntegrator *run;
    int first; /* the number of its node 0 */
} Part;

typedef enum Array {
    POSITION,
    VELOCITY,
    RUN,
    NODES, /* from here on of cells: springs and triangles */
    ENDS,  /* of a cell in the list of nodes */
    TYPES,
    STRAIN,
    ARRAYS /* none: cells are only counted */
} Array;

static const struct {
    const char *before, *type, *name;
    int components;
} arrays[ARRAYS] = {
    {"<Points>", "Float64", "position", 3},
    {"</Points>\n<PointData Vectors=\"velocity\">", "Float64", "velocity", 3},
    {"", "Int32", "run", 1},
    {"</PointData>\n<Cells>", "Int32", "connectivity", 1},
    {"", "Int32", "offsets", 1},
    {"", "UInt8", "types", 1},
    {"</Cells>\n<CellData Scalars=\"strain\">", "Float64", "strain", 1},
};

/* Spring i or, behind the springs, a triangle: its nodes and how it is
 * strained, out.  Returns how many nodes; 0 where a spring is broken, or the
 * mesh is not cut so. */
static int get_cell(const Part *part, int i, int node[3], double *strain)
{
    const System *system = part->run->system;
    const double *x = part->run->x;
    int triangle = i - system->springs, side[3];
    double d[2], e[2], spacing = part->mesh->spacing;
    if (triangle < 0) {
        memcpy(node, system->e + 2 * i, 2 * sizeof *node);
        *strain = spring_strain(node, system->l2[i], x, d);
        return spring_is_broken(system, i) ? 0 : LINE;
    }
    bool whole = square_mesh_is_half(part->mesh, triangle);
    square_mesh_triangle(part->mesh, triangle, node, side);
    for (int k = 0; k < 3; k++)
        whole = whole && !spring_is_broken(system, side[k]);
    for (int k = 0; k < 2; k++) {
        d[k] = x[2 * node[1] + k] - x[2 * node[0] + k];
        e[k] = x[2 * node[2] + k] - x[2 * node[0] + k];
    }
    *strain = cross(d, e) / (spacing * spacing) - 1;
    return whole ? TRIANGLE : 0;
}

/* The numbers of an array.  Returns of how many nodes or cells. */
static int put_numbers(FILE *file, const Part *part, int parts, Array array)
{
    int count = 0, end = 0, corners = 1, node[3];
    double strain;
    for (int p = 0; p < parts; p++) {
        const TimeIntegrator *run = part[p].run;
        const double *at = array == POSITION ? run->x : run->v;
        int all = array < NODES
                      ? run->system->nodes
                      : run->system->springs + 4 * part[p].mesh->cells;
        for (int i = 0; i < all; i++) {
            if (array >= NODES)
                corners = get_cell(&part[p], i, node, &strain);
            count += corners > 0;
            end += corners;
            if (array == POSITION || array == VELOCITY)
                fprintf(file, "%.17g %.17g 0\n", at[2 * i], at[2 * i + 1]);
            else if (array == STRAIN && corners > 0)
                fprintf(file, "%.17g\n", strain);
            else if (array == NODES)
                for (int k = 0; k < corners; k++)
                    fprintf(file, "%d\n", part[p].first + node[k]);
            else if (array != ARRAYS && corners > 0)
                fprintf(file, "%d\n",
                        array == RUN      ? p
                        : array == ENDS   ? end
                        : corners == LINE ? VTK_LINE
                                          : VTK_TRIANGLE);
        }
    }
    return count;
}

Status vtk_write(const char *name, const Simulation *const *simulation,
                 int count)
{
    Part part[PARTS];
    Output output;
    int parts = 0, nodes = 0;
    Status status = output_open(name, &output);
    FILE *file = output.file;
    if (status)
        return status;
    for (int i = 0; i < count; i++)
        for (int r = 0; r < simulation[i]->runs; r++) {
            const TimeIntegrator *run = &simulation[i]->run[r];
            part[parts++] = (Part){&simulation[i]->mesh, run, nodes};
            nodes += run->system->nodes;
        }
    fprintf(file,
            "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">\n"
            "<UnstructuredGrid>\n"
            "<Piece NumberOfPoints=\"%d\" NumberOfCells=\"%d\">\n",
            nodes, put_numbers(NULL, part, parts, ARRAYS));
    for (Array array = 0; array < ARRAYS; array++) {
        fprintf(file,
                "%s\n<DataArray type=\"%s\" Name=\"%s\" "
                "NumberOfComponents=\"%d\" format=\"ascii\">\n",
                arrays[array].before, arrays[array].type, arrays[array].name,
                arrays[array].components);
        put_numbers(file, part, parts, array);
        fputs("</DataArray>\n", file);
    }
    fputs("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n", file);
    return output_close(&output, STATUS_OK);
}

void pvd_write(const Table *table, FILE *file)
{
    double row[TABLE_COLUMNS];
    char name[VTK_NAME_SIZE];
    fputs("<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
          file);
    rewind(table->rows);
    while (table_next(table, row)) {
        vtk_name((long)row[0], name);
        fprintf(file, "<DataSet timestep=\"%.17g\" file=\"%s\"/>\n", row[1],
                name);
    }
    fputs("</Collection>\n</VTKFile>\n", file);
}
