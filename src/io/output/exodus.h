/* SPDX-License-Identifier: GPL-3.0-or-later
 * The layout of result.e that the header and the records of a step have in common. */
#ifndef PERIGAL_OUTPUT_EXODUS_H
#define PERIGAL_OUTPUT_EXODUS_H
#include "perigal/output.h"

/* Name of the block of cracks. */
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
    /* Lines, two nodes each behind those of the points, as a block of their own; 0: none. The records then
     * end with one number for each piece, 1 if it exists. */
    size_t          npiece;
    const pg_crack_face *piece;
    /* Of a part of a whole; NULL: it is one. */
    const pg_field_share *share;
} exodus_layout;
/* Writes the file to its path, including all that does not change during a run. */
pg_status pg_exodus_layout_write (const exodus_layout *layout);
/* The suffix of component k of a field: "_x", "_xy", "_7", "" of the only one. */
void      pg_exodus_suffix (int dim, int components, int k, char *text, size_t size);
/* ---- exodus_join.c: parts ------------------------------------------------------------------------------ */
/* FOLDER/result.e.SIZE.RANK, with as many digits of the rank as the size has. */
void      pg_exodus_part_path  (char *out, size_t size, const char *folder, int count, int part);
/* Removes the parts in a folder that do not belong to a result of `keep` parts (0: all of them). */
void      pg_exodus_drop_parts (const char *folder, int keep);
#endif
