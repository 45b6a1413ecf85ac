/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per format of mesh files: src/io/mesh_files/NAME.c ends in `const mesh_format mesh_format_NAME`.
 * The first that knows a file reads it. */
PG_MESH_FORMAT (gmsh2)
PG_MESH_FORMAT (gmsh4)
PG_MESH_FORMAT (abaqus)
PG_MESH_FORMAT (frd)
PG_MESH_FORMAT (exodus)
