#include "play/recording.h"

#include "model/area.h"
#include "model/mass_spring_energy.h"
#include "play/table.h"

void vtk_name(long step, char name[VTK_NAME_SIZE])
{
    snprintf(name, VTK_NAME_SIZE, "step_%06ld.vtp", step);
}

enum { PARTS = OPTIONS_MAX_PANES * SIMULATION_MAX_RUNS };

/* A run. */
typedef struct Part {
    const SquareMesh *mesh;
    const System *system;
    const double *x, *v;
    int first; /* the number of its node 0 */
} Part;

/* Lines and triangles. */
enum { LINE = 2, TRIANGLE = 3 };

/* Number i of the lines or triangles: its nodes and how it is strained, out.
 * Returns false where a spring is broken, or the cells are not cut so. */
static bool get_cell(const Part *part, int corners, int i, int node[3],
                     double *strain)
{
    const System *system = part->system;
    int side[3] = {i, i, i};
    double d[2];
    if (corners == TRIANGLE)
        square_mesh_triangle(part->mesh, i, node, side);
    for (int k = 0; k < 3; k++)
        if (spring_is_broken(system, side[k]))
            return false;
    if (corners == LINE) {
        node[0] = system->e[2 * i];
        node[1] = system->e[2 * i + 1];
        *strain = spring_strain(node, system->l2[i], part->x, d);
        return true;
    }
    double e[2], f[2], spacing = part->mesh->spacing;
    for (int k = 0; k < 2; k++) {
        e[k] = part->x[2 * node[1] + k] - part->x[2 * node[0] + k];
        f[k] = part->x[2 * node[2] + k] - part->x[2 * node[0] + k];
    }
    *strain = cross(e, f) / (spacing * spacing) - 1;
    return square_mesh_is_half(part->mesh, i);
}

/* What is written of each: nothing, it is counted; its nodes; where they end in
 * their list; the strain. */
typedef enum CellText { COUNT, NODES, ENDS, STRAIN } CellText;

/* Returns how many there are. */
static int put_cells(FILE *file, const Part *part, int parts, int corners,
                     CellText text)
{
    int count = 0, node[3];
    double strain;
    for (int p = 0; p < parts; p++) {
        int all =
            corners == LINE ? part[p].system->springs : 4 * part[p].mesh->cells;
        for (int i = 0; i < all; i++) {
            if (!get_cell(&part[p], corners, i, node, &strain))
                continue;
            count++;
            for (int k = 0; k < corners && text == NODES; k++)
                fprintf(file, "%d\n", part[p].first + node[k]);
            if (text == ENDS)
                fprintf(file, "%d\n", corners * count);
            if (text == STRAIN)
                fprintf(file, "%.17g\n", strain);
        }
    }
    return count;
}

static void begin_array(FILE *file, const char *type, const char *name,
                        int components)
{
    fprintf(file,
            "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" "
            "format=\"ascii\">\n",
            type, name, components);
}

static const char array_end[] = "</DataArray>\n";

/* Positions or velocities of all nodes. */
static void put_vectors(FILE *file, const Part *part, int parts,
                        const char *name, bool velocities)
{
    begin_array(file, "Float64", name, 3);
    for (int p = 0; p < parts; p++) {
        const double *at = velocities ? part[p].v : part[p].x;
        for (int i = 0; i < part[p].system->nodes; i++)
            fprintf(file, "%.17g %.17g 0\n", at[2 * i], at[2 * i + 1]);
    }
    fputs(array_end, file);
}

/* The nodes of all lines or triangles. */
static void put_corners(FILE *file, const Part *part, int parts,
                        const char *what, int corners)
{
    fprintf(file, "<%s>\n", what);
    begin_array(file, "Int32", "connectivity", 1);
    put_cells(file, part, parts, corners, NODES);
    fputs(array_end, file);
    begin_array(file, "Int32", "offsets", 1);
    put_cells(file, part, parts, corners, ENDS);
    fputs(array_end, file);
    fprintf(file, "</%s>\n", what);
}

static void put_polydata(FILE *file, const Part *part, int parts, double time)
{
    const Part *last = &part[parts - 1];
    fputs("<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n"
          "<FieldData>\n",
          file);
    fprintf(file,
            "<DataArray type=\"Float64\" Name=\"TimeValue\" "
            "NumberOfTuples=\"1\" format=\"ascii\">%.17g</DataArray>\n"
            "</FieldData>\n<Piece NumberOfPoints=\"%d\" NumberOfLines=\"%d\" "
            "NumberOfPolys=\"%d\">\n<Points>\n",
            time, last->first + last->system->nodes,
            put_cells(NULL, part, parts, LINE, COUNT),
            put_cells(NULL, part, parts, TRIANGLE, COUNT));
    put_vectors(file, part, parts, "position", false);
    fputs("</Points>\n<PointData Vectors=\"velocity\">\n", file);
    put_vectors(file, part, parts, "velocity", true);
    begin_array(file, "Int32", "run", 1);
    for (int p = 0; p < parts; p++)
        for (int i = 0; i < part[p].system->nodes; i++)
            fprintf(file, "%d\n", p);
    fputs(array_end, file);
    fputs("</PointData>\n", file);
    put_corners(file, part, parts, "Lines", LINE);
    put_corners(file, part, parts, "Polys", TRIANGLE);
    fputs("<CellData Scalars=\"strain\">\n", file);
    begin_array(file, "Float64", "strain", 1);
    put_cells(file, part, parts, LINE, STRAIN);
    put_cells(file, part, parts, TRIANGLE, STRAIN);
    fputs(array_end, file);
    fputs("</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n", file);
}

Status vtk_write(const char *name, const Simulation *const *simulation,
                 int count)
{
    Part part[PARTS];
    Output output;
    int parts = 0, nodes = 0;
    Status status = output_open(name, &output);
    if (status)
        return status;
    for (int i = 0; i < count; i++)
        for (int r = 0; r < simulation[i]->runs; r++) {
            const TimeIntegrator *run = &simulation[i]->run[r];
            part[parts++] = (Part){&simulation[i]->mesh, run->system, run->x,
                                   run->v, nodes};
            nodes += run->system->nodes;
        }
    put_polydata(output.file, part, parts, simulation_time(simulation[0]));
    return output_close(&output);
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
