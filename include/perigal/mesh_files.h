/* SPDX-License-Identifier: GPL-3.0-or-later
 * mesh_files.h: meshes, and fields on them, read from files. Catalogue of formats:
 * src/io/mesh_files/<name>.c + one line in list.h; the format of a file is recognised by its content, never
 * by its name.
 *
 * | format        | versions                         | mesh | nodal fields                                |
 * |---------------|----------------------------------|------|---------------------------------------------|
 * | Gmsh .msh     | 2.2 and 4.1, text and binary     | yes  | no                                          |
 * | Abaqus .inp   | also CalculiX, with *INCLUDE     | yes  | no                                          |
 * | Exodus II     | any kind of netCDF               | yes  | yes: variables grouped by _x _y _z, _xx ... |
 * | CalculiX .frd | text and binary                  | yes  | yes: DISP displacement, STRESS, TOSTRAIN    |
 *
 * Faults are PG_E_FILE and name the file and its line, byte or element. */
#ifndef PERIGAL_MESH_FILES_H
#define PERIGAL_MESH_FILES_H
#include "perigal/mesh.h"

PG_API_BEGIN

/* Reads a mesh. Physical groups and sets of the file become blocks, side sets and node sets. Nodes that no
 * solid element uses are dropped. Elements given inside out are mirrored; flat elements, and nodes that do
 * not exist, are faults. Groups of lower dimension become node sets, and side sets where they are faces of
 * solid elements (a face between two belongs to the first of them). Sets of equal name are united; groups
 * and sets without a name are named by their number. Shells of lower dimension that a crack splits are no
 * fault. */
pg_status pg_mesh_read  (pg_mesh *out, const char *path);

/* Reads a mesh and the nodal fields of one step (-1: the last); *time is that of the step. Vectors of a
 * plane mesh come with two components; strains are those of the tensor (xy: half the angle), as CalculiX
 * writes them. A field that is not given at every node is a fault. Free with pg_mesh_clear and
 * pg_mesh_fields_clear. */
pg_status pg_mesh_result (pg_mesh *out, const char *path, int step, size_t *nfield, pg_mesh_field **fields,
                          double *time);

PG_API_END
#endif
