/* SPDX-License-Identifier: GPL-3.0-or-later
 * vector.h: products and lengths of short vectors. Those whose names end in 3 are of three components. */
#ifndef PERIGAL_VECTOR_H
#define PERIGAL_VECTOR_H
#include <math.h>
#include <stddef.h>

static inline double pg_dot (size_t n, const double *a, const double *b)
{
    double sum = 0;
    for (size_t k = 0; k < n; k++) sum += a[k] * b[k];
    return sum;
}
static inline double pg_size (size_t n, const double *a) { return sqrt (pg_dot (n, a, a)); }
static inline double pg_distance2 (size_t n, const double *a, const double *b)   /* squared distance */
{
    double sum = 0;
    for (size_t k = 0; k < n; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}
static inline double pg_distance (size_t n, const double *a, const double *b)
{
    return sqrt (pg_distance2 (n, a, b));
}
static inline double pg_dot3 (const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
/* Lengths computed without overflow or underflow of squares. */
static inline double pg_size3 (const double *a) { return hypot (hypot (a[0], a[1]), a[2]); }
static inline double pg_distance3 (const double *a, const double *b)
{
    return hypot (hypot (a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}
static inline void pg_cross3 (const double *a, const double *b, double *out)
{
    for (int k = 0; k < 3; k++) {
        int m = (k + 1) % 3, n = (k + 2) % 3;
        out[k] = a[m] * b[n] - a[n] * b[m];
    }
}
/* out = x + d e */
static inline void pg_shift3 (const double *x, const double *e, double d, double *out)
{
    for (int k = 0; k < 3; k++) out[k] = x[k] + d * e[k];
}
/* Scales a vector to length 1; returns 0 if its length is 0 (unchanged). */
static inline int pg_unit3 (double *a)
{
    double s = pg_size3 (a);
    for (int k = 0; k < 3 && s > 0; k++) a[k] /= s;
    return s > 0;
}
#endif
