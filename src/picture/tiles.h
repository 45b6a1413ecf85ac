/* SPDX-License-Identifier: GPL-3.0-or-later
 * The points seen in a plane as parts of the body that share it without gaps: at rest (tiles.c) and
 * displaced (warp.c). */
#ifndef PG_PICTURE_TILES_H
#define PG_PICTURE_TILES_H
#include "picture_private.h"

typedef struct {                                       /* borrowed unless said otherwise */
    size_t  n;
    int     dim, loose;                                /* of the body; 1: the points lie on no lattice */
    const double *place;                               /* in the picture's plane, m (n x 2) */
    const double *shift;                               /* magnified displacement in it, m, or NULL (n x 2) */
    const double *damage;                              /* or NULL: not known (n) */
    const double *size;                                /* local spacings, m, or NULL (n) */
    /* lattice; 3D: depth of the plane, m; of all points in the plane, m2, 0: not known */
    double  step[2], at, area;
    const pg_eye *eye;
    const pg_outline *outline;                         /* NULL: the points are all that is known */
    const pg_cracks *cracks;
    /* made by pg_tiles_open */
    double *spacing, widest, pitch, low[2];            /* of every point, the largest; buckets, m */
    long    buckets[2];
    size_t *first;  int *sorted;
    unsigned char *cracked;  /* a pre-crack is near: 1; the point lies on it: 2 (n) */
    double *gradient, limit;  /* of the shift, 1 (n x 4); strain above which damaged points are torn apart */
} pg_tiles;
pg_status pg_tiles_open  (pg_tiles *t);
void      pg_tiles_close (pg_tiles *t);
/* Owners of the pixels of a fresh screen, the body at rest: indices of points. */
pg_status pg_tiles_rest  (const pg_tiles *t, pg_screen *screen);
/* The same where the body is now: displaced by `shift` if there is one. Parts of points that hold together
 * share their corners; those that have lost each other move apart. */
pg_status pg_tiles_draw  (pg_tiles *t, pg_screen *screen);

/* After pg_tiles_draw with a shift: where n places along the left (side 1) or right face of a crack from a to
 * b are now, NAN outside of the body. */
void pg_tiles_face (const pg_tiles *t, const double *a, const double *b, int side, size_t n,
                    double *out /* n x 2, m */);

int       pg_tiles_inside (const pg_tiles *t, const double *at);  /* 1 also where there is no outline */
/* points, itself too */
size_t    pg_tiles_near  (const pg_tiles *t, const double *at, double reach, size_t most, int *out);
/* does a pre-crack lie between? */
int       pg_tiles_cut   (const pg_tiles *t, const double *a, const double *b);
/* place of the plane in space */
void      pg_tiles_space (const pg_tiles *t, double a, double b, double *x);
#endif
