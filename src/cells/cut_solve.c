/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where three quadrics meet in a cube: boxes are halved and thrown away where one of them has no zero; Newton
 * in those that are left. */
#include "cut.h"
#include <math.h>
#include <string.h>

enum { BOXES = 4000 };                                 /* curves of solutions would have no end */
typedef struct { const cut_quadric *q; double *x, reach; int n, boxes; } search;

static int newton (const cut_quadric *q, double *x, double reach)
{
    double from[3];
    memcpy (from, x, sizeof from);
    for (int i = 0; i < 20; i++) {
        double J[9], v[3], d[3], det, step = 0;
        for (int e = 0; e < 3; e++) cut_gradient (&q[e], x, J + 3 * e), v[e] = cut_value (&q[e], x);
        det = pg_dense_det (3, J);
        if (!(fabs (det) > 1e-300)) return 0;
        for (int k = 0; k < 3; k++) {
            double C[9];
            memcpy (C, J, sizeof C);
            for (int e = 0; e < 3; e++) C[3 * e + k] = v[e];
            d[k] = pg_dense_det (3, C) / det, step = fmax (step, fabs (d[k]));
        }
        for (int k = 0; k < 3; k++) {
            x[k] -= d[k];
            if (!(fabs (x[k] - from[k]) <= reach)) return 0;
        }
        if (step < 1e-15) return 1;
    }
    double size = 0;
    for (int e = 0; e < 3; e++) size = fmax (size, fabs (cut_value (&q[e], x)));
    return size < 1e-12;
}

static void keep (search *s, const double *x)
{
    for (int k = 0; k < 3; k++) if (fabs (x[k]) > s->reach + 1e-9) return;
    for (int i = 0; i < s->n; i++) {
        double d = 0;
        for (int k = 0; k < 3; k++) d = fmax (d, fabs (x[k] - s->x[3 * i + k]));
        if (d < 1e-9) return;
    }
    if (s->n < CUT_MEETINGS) memcpy (s->x + 3 * s->n++, x, 3 * sizeof *x);
}

static void halve (search *s, const double *centre, double half)
{
    const double edges[3] = {half, half, half};
    if (s->boxes++ > BOXES) return;
    for (int e = 0; e < 3; e++) if (!cut_meets (&s->q[e], centre, edges, 1e-12)) return;
    if (half < 0.1) {
        double x[3] = {centre[0], centre[1], centre[2]};
        if (newton (s->q, x, 4 * half)) keep (s, x);
        return;
    }
    for (int k = 0; k < 8; k++) {
        double part[3];
        for (int a = 0; a < 3; a++) part[a] = centre[a] + (k >> a & 1 ? 0.5 : -0.5) * half;
        halve (s, part, 0.5 * half);
    }
}

int cut_solve (const cut_quadric *q, double reach, double *x)
{
    search s = {q, x, reach, 0, 0};
    halve (&s, (double[]) {0, 0, 0}, reach);
    return s.n;
}
