/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what the files that write the header, the steps and the parts of result.e have in common. */
#ifndef PERIGAL_OUTPUT_EXODUS_H
#define PERIGAL_OUTPUT_EXODUS_H
#include "perigal/output.h"

/* Name of the element block that holds the faces of cracks. */
#define EXODUS_CRACKS "cracks"
/* Largest number of components of a field. */
enum { EXODUS_COMPONENTS = 64 };
/* ---- exodus_layout.c: a whole result.e without steps -------------------------------------------------- */
/* What exodus_layout.c needs for a result.e without steps. The records have time_whole first
 * and then the nvar components of the fields, in this order. */
typedef struct {
    const char     *path;
    const pg_cloud *cloud;
    const char     *title;
    size_t          nfield, nvar;
    const pg_field_view *field;
    /* Volumes of the points (n), m3. */
    const double   *volume;
    /* Faces of cracks (0: none), a block of elements whose nodes (dim each) follow the points. Each record
     * then ends with one number per face: 1 if it exists, else 0. */
    size_t          npiece;
    const pg_crack_face *piece;
    /* Which part of the whole result this file is; NULL: it is the whole. */
    const pg_field_share *share;
} exodus_layout;
/* Writes the file to its path, including all that does not change during a run. */
pg_status pg_exodus_layout_write (const exodus_layout *layout);
/* Writes the suffix of component k of a field to text: such as "_x", "_xy", "_7"; "" for a scalar field. */
void      pg_exodus_suffix (int dim, int components, int k, char *text, size_t size);
/* ---- exodus_join.c: parts ------------------------------------------------------------------------------ */
/* Path of a part: FOLDER/result.e.COUNT.PART, with PART padded by zeros to the number of digits of COUNT. */
void      pg_exodus_part_path  (char *out, size_t size, const char *folder, int count, int part);
/* Removes the parts in a folder that do not belong to a result of `keep` parts (0: all of them). */
void      pg_exodus_drop_parts (const char *folder, int keep);
#endif
