/* SPDX-License-Identifier: GPL-3.0-or-later
 * output.h: files and pictures from plain arrays. Knows columns, fields and points, no method. */
#ifndef PERIGAL_OUTPUT_H
#define PERIGAL_OUTPUT_H
#include "perigal/cloud.h"

/* ---- fields on points ----------------------------------------------------------------------------------------------- */
typedef struct {
    char   name[32];                                   /* "displacement", "damage", "stress"                             */
    char   unit[16];                                   /* "m", "Pa", ""                                                  */
    int    components;                                 /* 1; dim (vector); nv (Voigt)                                    */
    const double *value;                               /* n x components                                                 */
} pg_field_view;

/* ---- result.e: Exodus layout in netCDF-4, one SPHERE element and one node per point; readable after a kill ------------ */
typedef struct pg_exodus pg_exodus;
pg_status pg_exodus_create (pg_exodus **out, const char *path, const pg_cloud *cloud, const char *title,
                            size_t nfield, const pg_field_view *fields /* values ignored */);
pg_status pg_exodus_write  (pg_exodus *file, double time, const pg_field_view *fields);   /* appends a step and syncs      */
void      pg_exodus_close  (pg_exodus **file);
/* Reads a field back: step -1 is the last. *value is n x *components, to be freed with pg_free. */
pg_status pg_exodus_read   (const char *path, const char *field, int step, size_t *n, int *components, double **value);
pg_status pg_exodus_points (const char *path, pg_cloud *cloud /* x, n, dim, volume, box, h filled */, size_t *nstep, double **time);
pg_status pg_exodus_fields (const char *path, char (**names)[32], size_t *n);    /* base names as written                 */
pg_status pg_exodus_unit   (const char *path, const char *field, char unit[16]);          /* "" when there is none        */

/* ---- tables --------------------------------------------------------------------------------------------------------- */
/* CSV: header "name [unit]" per column, one row a call, flushed; numbers with 17 digits. */
typedef struct pg_table pg_table;
pg_status pg_table_create (pg_table **out, const char *path, size_t n, const char *const *columns);
pg_status pg_table_row    (pg_table *table, const double *values);
pg_status pg_table_line   (pg_table *table, const char *const *values);
void      pg_table_close  (pg_table **table);

/* ---- JSON ----------------------------------------------------------------------------------------------------------- */
typedef struct pg_json pg_json;                        /* written to PATH.tmp, renamed on close                          */
pg_status pg_json_create (pg_json **out, const char *path);
void      pg_json_open   (pg_json *j, const char *key, char bracket);     /* '{' or '[' ; key NULL inside lists           */
void      pg_json_shut   (pg_json *j);
void      pg_json_number (pg_json *j, const char *key, double value);     /* NaN and infinities become null               */
void      pg_json_count  (pg_json *j, const char *key, size_t value);
void      pg_json_text   (pg_json *j, const char *key, const char *value);
pg_status pg_json_close  (pg_json **j);

/* ---- pictures (PNG or SVG by the file's ending) ----------------------------------------------------------------------- */
typedef struct {
    const char *title, *label;                         /* label of the colour bar, with unit: "damage", "s_yy (MPa)"     */
    double      low, high;                             /* colour range; low == high: from the data                       */
    int         diverging;                             /* 1: blue-white-red around 0, else sequential                    */
    double      magnify;                               /* points drawn at x + magnify u; 0: undeformed                   */
    const double *u;                                   /* n x dim displacement or NULL                                   */
    const pg_cracks *cracks;                           /* drawn as lines, or NULL                                        */
    int         section;                               /* 3D: 0: mid-plane of z; 1, 2, 3: the plane x, y, z = at         */
    double      at;                                    /* m                                                              */
} pg_picture_style;
/* 2D field, one cell-sized square per point, NaN grey, length unit chosen by size (mm, m, ...), axes with ticks, colour bar.
 * 1D: a chart over x. 3D: the section that style names. Labels may raise and lower text: "c_{x} (m^{2})". */
pg_status pg_picture_field (const char *path, const pg_cloud *cloud, const double *value /* n */, const pg_picture_style *style);

typedef struct { const char *name; size_t n; const double *x, *y; int points; /* 1: markers, 0: line */ } pg_curve;
typedef struct { const char *title, *xlabel, *ylabel; int logx, logy; } pg_chart_style;
pg_status pg_picture_chart (const char *path, size_t ncurve, const pg_curve *curves, const pg_chart_style *style);
#endif
