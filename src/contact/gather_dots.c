/* SPDX-License-Identifier: GPL-3.0-or-later
 * Clusters points of a surface into pieces around centres: initial centres are chosen one by one, each
 * farthest from those before, then moved to the centroids of their points (Lloyd 1982). */
#include "pieces.h"
#include <math.h>
#include <string.h>

/* Lloyd iterations; weight of an angle between normals, spacings per rad. */
enum { ROUNDS = 12 };
static const double TURN_COUNTS = 4;

/* Squared distance of a dot from x, in local spacings, including the weighted angle to `normal`. */
static double away (const dot *d, const double *x, const double *normal)
{
    double far = 0, turn = 0;
    for (int k = 0; k < 3; k++) {
        far += (d->x[k] - x[k]) * (d->x[k] - x[k]);
        turn += (d->normal[k] - normal[k]) * (d->normal[k] - normal[k]);
    }
    return far / (d->h * d->h) + TURN_COUNTS * TURN_COUNTS * turn;
}

/* Numbers of a centre: position (3, m), normal (3), area in local spacings. */
enum { WIDE = 7 };

/* Chooses the initial centres: the first dot, then always the dot farthest from all centres. far: distance of
 * each dot to the nearest centre. */
static void spread (const dot *d, size_t n, size_t count, double *centre, double *far)
{
    size_t next = 0;
    for (size_t i = 0; i < n; i++) far[i] = INFINITY;
    for (size_t k = 0; k < count; k++) {
        double *to = centre + WIDE * k;
        memcpy (to, d[next].x, 3 * sizeof *to), memcpy (to + 3, d[next].normal, 3 * sizeof *to);
        for (size_t i = 0; i < n; i++) far[i] = fmin (far[i], away (&d[i], to, to + 3));
        next = 0;
        for (size_t i = 0; i < n; i++) if (far[i] > far[next] * (1 + 1e-9)) next = i;
    }
}

/* One iteration: assigns dots to the nearest centre, then moves centres to the centroids of their dots. */
static void gather_round (dot *d, size_t n, size_t count, double *centre)
{
    for (size_t i = 0; i < n; i++) {
        double least = INFINITY;
        for (size_t k = 0; k < count; k++) {
            double now = away (&d[i], centre + WIDE * k, centre + WIDE * k + 3);
            if (now < least) least = now, d[i].piece = k;
        }
    }
    memset (centre, 0, WIDE * count * sizeof *centre);
    for (size_t i = 0; i < n; i++) {
        double *to = centre + WIDE * d[i].piece;
        for (int k = 0; k < 3; k++) to[k] += d[i].size * d[i].x[k], to[3 + k] += d[i].size * d[i].normal[k];
        to[6] += d[i].size;
    }
    for (size_t k = 0; k < count; k++) {
        double *to = centre + WIDE * k, size = sqrt (pg_dot3 (to + 3, to + 3));
        for (int c = 0; c < 3 && to[6] > 0; c++) to[c] /= to[6], to[3 + c] /= size;
    }
}

/* Iterates; centres whose pieces are too small are removed, and the iteration is repeated. */
pg_status gather_dots (dot *d, size_t n, double full, size_t *count)
{
    pg_status status = PG_OK;
    double *centre = NULL, *far = NULL;
    PG_ALLOC (centre, WIDE * *count);
    PG_ALLOC (far, n);
    spread (d, n, *count, centre, far);
    for (int small = 1; small;) {
        for (int round = 0; round < ROUNDS; round++) gather_round (d, n, *count, centre);
        small = 0;
        for (size_t k = 0; k < *count && *count > 1 && !small; k++) {
            if (centre[WIDE * k + 6] >= DOTS_LEAST * full) continue;
            memmove (centre + WIDE * k, centre + WIDE * (k + 1), WIDE * (*count - k - 1) * sizeof *centre);
            --*count, small = 1;
        }
    }
done:
    pg_free (centre), pg_free (far);
    return status;
}

void piece_tangents (const double *n, const double *along, double *out)
{
    double axis[3] = { 0 }, part, size;
    int least = 0;
    for (int c = 1; c < 3; c++) if (fabs (n[c]) < fabs (n[least])) least = c;
    axis[least] = 1;
    if (!along) along = axis;
    part = pg_dot3 (n, along);
    for (int k = 0; k < 3; k++) out[k] = along[k] - part * n[k];
    size = sqrt (pg_dot3 (out, out));
    for (int k = 0; k < 3; k++) out[k] /= size;
    pg_cross3 (n, out, out + 3);
}
