/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that have grown as lines of result.e: both faces of every straight piece, so that programs that draw
 * the body displaced show the crack open. The end of a face takes the displacement (and all other fields) of
 * the nearest point that sees it: no crack lies between. From cracks.csv is known since when a piece
 * exists. */
#include "results_private.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>

/* Ends of faces are looked at from so far beside the crack, spacings; and from so far behind the end of a
 * piece, in parts of its length, for the next piece may go to either side. */
#define BESIDE 1e-3
#define WITHIN 1e-2

/* What lies between a place and the points. */
typedef struct { const pg_problem *problem; const pg_cracks *cracks; } sight;

/* Refuses points that a crack hides from the place (pg_refuse). */
static int hidden (void *context, const double *place, size_t point)
{
    const sight *s = context;
    const pg_cloud *c = &s->problem->cloud;
    return pg_cracks_cut (s->cracks, 2, place, c->x + 2 * point, 1e-9 * c->h) != NULL;
}

/* The face of a piece on its left (side 1) or right (-1). */
static void face_of (const sight *s, const pg_nearest *near, const pg_crack *c, int side, pg_exodus_line *out)
{
    sight all = *s;
    for (int end = 0; end < 2; end++) {
        const double *x = c->vertex + 2 * end, *other = c->vertex + 2 * (1 - end);
        double place[2], off = side * BESIDE * pg_problem_spacing_at (s->problem, x);
        for (int k = 0; k < 2; k++) {
            out->x[end][k] = x[k];
            place[k] = x[k] + WITHIN * (other[k] - x[k]) + off * c->normal[k];
        }
        out->x[end][2] = 0;
        long point = pg_nearest_find (near, place, hidden, &all);
        if (point < 0) point = pg_nearest_find (near, place, NULL, NULL);
        out->point[end] = (size_t) point;
    }
}

/* Time in result.e since when each piece exists, from the rows of cracks.csv; pieces without one have split
 * from a crack of the scene. */
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

pg_status pg_result_paths_lines (pg_result *r, const pg_state *state)
{
    pg_status status = PG_OK;
    pg_nearest *near = NULL;
    pg_exodus_line *line = NULL;
    double *since = NULL;
    if (!r->grows || !state->paths || state->paths->cracks.n == 0) return PG_OK;
    const pg_cracks *cracks = &state->paths->cracks;
    sight s = { r->problem, cracks };
    PG_ALLOC (line, 2 * cracks->n);
    PG_ALLOC (since, cracks->n);
    PG_TRY (read_since (r, cracks->n, since));
    PG_TRY (pg_nearest_create (&near, 2, r->problem->cloud.n, r->problem->cloud.x));
    for (size_t k = 0; k < cracks->n; k++)
        for (size_t side = 0; side < 2; side++) {
            face_of (&s, near, &cracks->crack[k], side ? 1 : -1, &line[2*k + side]);
            line[2*k + side].since = since[k];
        }
    PG_TRY (pg_exodus_add_lines (&r->file, &r->problem->cloud, r->problem->title, 2 * cracks->n, line));
done:
    pg_nearest_free (&near);
    pg_free (line), pg_free (since);
    return status;
}
