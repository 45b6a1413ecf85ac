/* SPDX-License-Identifier: GPL-3.0-or-later
 * The curve through the vertices of a front (Catmull and Rom 1974) and the frame along it: t along the curve,
 * n the normal of the crack between those of the vertices made orthogonal to t, e = n x t ahead. Beyond the
 * ends of an open front lies a vertex of the parabola through the last three. */
#include "front.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

static const double step = 0.125;                      /* difference of u for derivatives of the frame */

static double unit (double *a)
{
    double size = sqrt (pg_dot3 (a, a));
    for (int k = 0; k < 3 && size > 0; k++) a[k] /= size;
    return size;
}

/* Coordinate k of vertex i, m, which may be one beyond an end of the front. */
static double vertex (const pg_front *f, long i, size_t k)
{
    long n = (long) f->n;
    if (f->closed) return f->x[3 * (size_t) ((i % n + n) % n) + k];
    if (i >= 0 && i < n) return f->x[3 * (size_t) i + k];
    long end = i < 0 ? 0 : n - 1, inward = i < 0 ? 1 : -1;
    double a = f->x[3 * (size_t) end + k], b = f->x[3 * (size_t) (end + inward) + k];
    if (n < 3) return 2 * a - b;
    return 3 * a - 3 * b + f->x[3 * (size_t) (end + 2 * inward) + k];
}

/* Position, frame and speed at u, without `turn`. */
static void frame_at (const pg_front *f, double u, front_place *out)
{
    long i = (long) floor (u);
    if (!f->closed) i = i < 0 ? 0 : i > (long) f->n - 2 ? (long) f->n - 2 : i;
    double s = u - (double) i, normal[3], *e = out->frame, *n = e + 3, *t = e + 6;
    size_t m = (size_t) ((i % (long) f->n + (long) f->n) % (long) f->n), next = (m + 1) % f->n;
    for (size_t k = 0; k < 3; k++) {
        double a = vertex (f, i - 1, k), b = vertex (f, i, k), c = vertex (f, i + 1, k),
               d = vertex (f, i + 2, k);
        out->x[k] = b + 0.5 * s * (c - a + s * (2 * a - 5 * b + 4 * c - d + s * (3 * (b - c) + d - a)));
        t[k] = 0.5 * (c - a + 2 * s * (2 * a - 5 * b + 4 * c - d) + 3 * s * s * (3 * (b - c) + d - a));
        normal[k] = (1 - s) * f->normal[3 * m + k] + s * f->normal[3 * next + k];
    }
    out->speed = unit (t);
    double along = pg_dot3 (normal, t);
    for (int k = 0; k < 3; k++) n[k] = normal[k] - along * t[k];
    unit (n);
    pg_cross3 (n, t, e);
}

/* Computes all of front_place at u; db/ds by differences of frames: turn_1 = n'.t, turn_2 = -e'.t, turn_3 =
 * e'.n. */
void front_at (const pg_front *f, double u, front_place *out)
{
    front_place low, high;
    double change[9];
    frame_at (f, u, out);
    frame_at (f, u - step, &low), frame_at (f, u + step, &high);
    for (int k = 0; k < 9; k++) change[k] = (high.frame[k] - low.frame[k]) / (2 * step * out->speed);
    out->turn[0] = pg_dot3 (change + 3, out->frame + 6);
    out->turn[1] = -pg_dot3 (change, out->frame + 6);
    out->turn[2] = pg_dot3 (change, out->frame + 3);
}

double front_gap (const pg_front *f, double u, size_t i)
{
    double gap = fabs (u - (double) i);
    return f->closed ? fmin (gap, (double) f->n - gap) : gap;
}

/* ---- frames -------------------------------------------------------------------------------------------- */
void front_turn_vector (const double *frame, const double *v, double *out)
{
    for (int i = 0; i < 3; i++) out[i] = frame[3*i] * v[0] + frame[3*i + 1] * v[1] + frame[3*i + 2] * v[2];
}

void front_turn_tensor (const double *frame, const double *T, double *out)
{
    double rows[9];                                    /* frame times T */
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            rows[3*i + j] = frame[3*i] * T[j] + frame[3*i + 1] * T[3 + j] + frame[3*i + 2] * T[6 + j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[3*i + j] = frame[3*j] * rows[3*i] + frame[3*j + 1] * rows[3*i + 1]
                           + frame[3*j + 2] * rows[3*i + 2];
}
