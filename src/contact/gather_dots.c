/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points of a surface gathered to pieces around as many centres as it has pieces: each next to begin with
 * where it is farthest from those there are, then where the middles of its points lie (Lloyd 1982). */
#include "pieces.h"
#include <math.h>
#include <string.h>

/* Rounds of gathering; what a turn of normals counts, as a distance in spacings per rad. */
enum { ROUNDS = 12 };
static const double TURN_COUNTS = 4;

/* How far a dot is from a place of that normal, in local spacings, squared; a turn counts as a way. */
static double away (const dot *d, const double *x, const double *normal)
{
    double far = 0, turn = 0;
    for (int k = 0; k < 3; k++) {
        far += (d->x[k] - x[k]) * (d->x[k] - x[k]);
        turn += (d->normal[k] - normal[k]) * (d->normal[k] - normal[k]);
    }
    return far / (d->h * d->h) + TURN_COUNTS * TURN_COUNTS * turn;
}

/* Of a centre: place (3), normal (3), area in local spacings. */
enum { WIDE = 7 };

/* The first centres: the first dot, then always the one farthest from all there are. far: of each dot. */
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

/* Dots go to the nearest centre, then centres to the middle of their dots. */
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

/* A centre that holds too little is taken away, and the others gather anew. */
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
