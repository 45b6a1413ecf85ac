/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pictures of points in a plane: the body is divided into one part per point, without gaps
 * between the parts: the undeformed body in tiles.c, the displaced one in warp.c. Drawing a
 * rectangle around each point would leave gaps between irregular or displaced points and would
 * blur cracks. */
#ifndef PG_PICTURE_TILES_H
#define PG_PICTURE_TILES_H
#include "picture_private.h"

/* The points of one picture. The caller fills and keeps the fields up to `cracks`; pg_tiles_open
 * makes those from `spacing` on, which pg_tiles_close frees. */
typedef struct {                                       /* borrowed unless said otherwise */
    /* Number of points that are seen. */
    size_t  n;
    /* Dimension of the body, 2 or 3 (a layer); loose = 1: the points lie on no lattice; moved = 1: `place`
     * holds displaced positions. */
    int     dim, loose, moved;
    /* Positions of the points in the plane of the picture, m (n x 2). */
    double *place;
    /* Displacement in that plane times the magnification, m (n x 2), or NULL: undeformed. */
    const double *shift;
    /* Damage of the points (n), or NULL if it is not known. */
    const double *damage;
    /* Spacing around each point, m (n), or NULL: the larger step. */
    const double *size;
    /* Cell of a lattice along both axes of the picture, m; in 3D the depth of the plane, m;
     * the area of all points in the plane, m2, or 0 if it is not known. */
    double  step[2], at, area;
    const pg_eye *eye;
    /* The body, or NULL: the points are all that is known of it. */
    const pg_outline *outline;
    const pg_cracks *cracks;
    /* Spacing around each point (n) and the largest one, m. */
    double *spacing, widest;
    /* Of a displaced body: the neighbours of each point, within 1.6 spacings. */
    pg_family near;
    /* Of each point (n): 1 if a pre-crack is within about two spacings, 2 if the point lies on
     * one, else 0. */
    unsigned char *cracked;
    /* Gradient of the shift at each point (n x 4: d shift_x / dx, dy, d shift_y / dx, dy); the
     * relative change of distance above which two damaged neighbours count as separated. */
    double *gradient, limit;
} pg_tiles;
/* Finds the points near pre-cracks. Fails on missing memory only. */
pg_status pg_tiles_open  (pg_tiles *t);
void      pg_tiles_close (pg_tiles *t);
/* Assigns each pixel of a new screen to the point it belongs to, the body being undeformed. */
pg_status pg_tiles_rest  (const pg_tiles *t, pg_screen *screen);
/* Assigns each pixel to the point it belongs to in the displaced body, or the undeformed one if there
 * is no shift. Parts of neighbours that hold together share their boundary; those that have separated
 * move apart and leave a gap. */
pg_status pg_tiles_draw  (pg_tiles *t, pg_screen *screen);

/* After pg_tiles_draw with a shift, in 2D: where both faces of every crack are now, so that an opened crack
 * is drawn as two lines. *face: PG_FACE points (x 2, m) of each of *n faces, NAN outside the body and where a
 * short piece needs fewer; grown as needed, *cap numbers. */
enum { PG_FACE = 129 };
pg_status pg_tiles_faces (pg_tiles *t, double **face, size_t *n, size_t *cap);

/* 1 if the point `at` of the plane (m) lies in the body; also 1 if the outline is unknown or a mesh. */
int       pg_tiles_inside (const pg_tiles *t, const double *at);
/* 1 if a pre-crack passes between the points a and b of the plane (m). */
int       pg_tiles_cut   (const pg_tiles *t, const double *a, const double *b);
/* Writes the coordinates in space (3, m) of the point (a, b) of the plane to x. */
void      pg_tiles_space (const pg_tiles *t, double a, double b, double *x);
#endif
