/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that have grown as lines and triangles beside the fields: both faces of every piece, so that
 * programs that draw the deformed body show the crack open. The corner of a face takes the displacement (and
 * all other fields) of the nearest point that no crack separates from it. cracks.csv says since when a piece
 * exists. In 3D the cracks of the scene are polygons and discs, which are drawn as fans of triangles about
 * their centre. */
#include "results_private.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* The search for the nearest point starts beside a corner: BESIDE spacings away from the crack, and WITHIN of
 * the way to the middle of the piece (of a line: to its other end), since the next piece may go to either
 * side. */
#define BESIDE 1e-3
#define WITHIN 1e-2

/* Context of `hidden`: cracks that may lie between a position and the points. */
typedef struct { const pg_problem *problem; const pg_cracks *cracks; } sight;

/* 1: a crack lies between the position and a point, which is then refused (pg_refuse). */
static int hidden (void *context, const double *place, size_t point)
{
    const sight *s = context;
    const pg_cloud *c = &s->problem->cloud;
    return pg_cracks_cut (s->cracks, place, c->x + (size_t) c->dim * point, 1e-9 * c->h) != NULL;
}

/* Makes the face of a piece on the side of its normal (side 1) or on the other (-1). corner: its vertices,
 * dim x dim, m. */
static void face_of (const sight *s, const pg_nearest *near, const double *corner, const double *normal,
                     int side, pg_crack_face *out)
{
    sight all = *s;
    size_t dim = (size_t) s->problem->dim;
    for (size_t a = 0; a < dim; a++) {
        const double *x = corner + dim * a;
        double place[3] = { 0 }, off = side * BESIDE * pg_problem_spacing_at (s->problem, x);
        for (size_t k = 0; k < dim; k++) {
            double inside = 0;
            for (size_t b = 0; b < dim; b++)
                if (b != a) inside += corner[dim * b + k] / (double) (dim - 1);
            out->x[a][k] = x[k];
            place[k] = x[k] + WITHIN * (inside - x[k]) + off * normal[k];
        }
        if (dim == 2) out->x[a][2] = 0;
        long point = pg_nearest_find (near, place, hidden, &all);
        if (point < 0) point = pg_nearest_find (near, place, NULL, NULL);
        out->point[a] = (size_t) point;
    }
}

/* A list of pieces with room for more. */
typedef struct { pg_crack_face *piece; size_t n, capacity; } pieces;

/* Appends both faces of a line or a triangle. */
static pg_status put_faces (pieces *all, const sight *s, const pg_nearest *near, const double *corner,
                            const double *normal, double since)
{
    pg_status status = PG_OK;
    PG_GROW (all->piece, all->capacity, all->n + 2);
    for (int side = -1; side <= 1; side += 2) {
        pg_crack_face *out = &all->piece[all->n++];
        *out = (pg_crack_face) { .since = since };
        face_of (s, near, corner, normal, side, out);
    }
done:
    return status;
}

/* Appends a segment, a triangle, or a polygon as a fan of triangles. */
static pg_status put_crack (pieces *all, const sight *s, const pg_nearest *near, const pg_crack *c,
                            double since)
{
    pg_status status = PG_OK;
    double middle[3] = { 0 }, corner[9];
    if (c->nvertex == (size_t) s->problem->dim) {
        PG_TRY (put_faces (all, s, near, c->vertex, c->normal, since));
        goto done;
    }
    for (size_t i = 0; i < c->nvertex; i++)
        for (size_t k = 0; k < 3; k++) middle[k] += c->vertex[3*i + k] / (double) c->nvertex;
    for (size_t i = 0; i < c->nvertex; i++) {
        memcpy (corner, middle, sizeof middle), memcpy (corner + 3, c->vertex + 3*i, sizeof middle);
        memcpy (corner + 6, c->vertex + 3 * ((i + 1) % c->nvertex), sizeof middle);
        PG_TRY (put_faces (all, s, near, corner, c->normal, since));
    }
done:
    return status;
}

/* Reads since which time of the fields each piece exists, from the rows of cracks.csv; pieces without a row
 * are parts of a crack of the scene: 0. */
static pg_status read_since (const pg_result *r, size_t n, double *since)
{
    pg_status status = PG_OK;
    pg_csv csv = { 0 };
    char path[4096];
    snprintf (path, sizeof path, "%s/cracks.csv", r->folder);
    PG_TRY (pg_csv_read (&csv, path));
    long stamp = pg_csv_column (&csv, "stamp"), segment = pg_csv_column (&csv, "segment");
    if (stamp < 0 || segment < 0) PG_FAIL (PG_E_FILE, "%s has no columns stamp, segment", path);
    for (size_t k = 0; k < n; k++) since[k] = 0;
    for (size_t i = 0; i < csv.nrow; i++) {
        const double *row = csv.value + i * csv.ncolumn;
        if (row[segment] >= 1 && row[segment] <= (double) n) since[(size_t) row[segment] - 1] = row[stamp];
    }
done:
    pg_csv_clear (&csv);
    return status;
}

/* Appends the strips between the triangles and the fronts, where the crack does not cut bonds yet. */
static pg_status put_fronts (pieces *all, const sight *s, const pg_nearest *near,
                             const pg_crack_surfaces *w, double since)
{
    pg_status status = PG_OK;
    for (size_t f = 0; f < w->nfront; f++) {
        const pg_front *front = &w->front[f];
        for (size_t i = 0; front->open && front->nrim && i + !front->closed < front->n; i++) {
            size_t j = (i + 1) % front->n;
            double c[4][3], corner[9];
            for (size_t k = 0; k < 3; k++) {
                c[0][k] = front->x[3*i + k], c[1][k] = front->x[3*j + k];
                c[2][k] = c[0][k] - front->offset[i] * front->ahead[3*i + k];
                c[3][k] = c[1][k] - front->offset[j] * front->ahead[3*j + k];
            }
            memcpy (corner, c[0], sizeof c[0]), memcpy (corner + 3, c[1], 2 * sizeof c[0]);
            PG_TRY (put_faces (all, s, near, corner, front->normal + 3*i, since));
            memcpy (corner, c[1], sizeof c[0]), memcpy (corner + 3, c[3], sizeof c[0]);
            memcpy (corner + 6, c[2], sizeof c[0]);
            PG_TRY (put_faces (all, s, near, corner, front->normal + 3*i, since));
        }
    }
done:
    return status;
}

pg_status pg_result_paths_faces (const pg_result *r, const pg_state *state, size_t *n, pg_crack_face **face)
{
    pg_status status = PG_OK;
    pg_nearest *near = NULL;
    pieces all = { 0 };
    double *since = NULL, last = 0;
    const pg_cracks *cracks = pg_state_cracks (r->problem, state);
    *n = 0, *face = NULL;
    if (!r->tips.grows || cracks->n == 0) return PG_OK;
    sight s = { r->problem, cracks };
    PG_ALLOC (since, cracks->n);
    PG_TRY (read_since (r, cracks->n, since));
    PG_TRY (pg_nearest_create (&near, r->problem->dim, r->problem->cloud.n, r->problem->cloud.x));
    for (size_t k = 0; k < cracks->n; k++) {
        PG_TRY (put_crack (&all, &s, near, &cracks->crack[k], since[k]));
        last = fmax (last, since[k]);
    }
    if (state->surfaces) PG_TRY (put_fronts (&all, &s, near, state->surfaces, last));
    *n = all.n, *face = all.piece, all.piece = NULL;
done:
    pg_nearest_free (&near);
    pg_free (all.piece), pg_free (since);
    return status;
}
