/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where three quadrics meet in a cube [-reach, reach]^3: the corners of a body, and the points where the
 * curve of two surfaces turns back. Subdivision: a box in which one of the three certainly has no zero is
 * discarded, others are divided into eight; in the boxes that remain at an edge of a tenth of the cell,
 * Newton's method. This finds all isolated solutions without a first guess. */
#include "cut.h"
#include <math.h>
#include <string.h>

/* Boxes visited at most. Three surfaces with a curve in common have infinitely many solutions; no box on
 * the curve could ever be discarded. */
enum { BOXES = 4000 };
/* State of a search: the three quadrics, the solutions so far (n x 3), half the edge of the cube, the numbers
 * of solutions and of boxes visited; full: a solution found no room. */
typedef struct { const cut_quadric *q; double *x, reach; int n, boxes, full; } search;

/* Newton's method by Cramer's rule, from x. 1: converged (step below 1e-15, or values below 1e-12 after 20
 * steps) without moving more than `reach` in any coordinate; a singular Jacobian ends it. */
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

/* Adds a solution unless it is outside the cube or known already, to 1e-9. */
static void keep (search *s, const double *x)
{
    for (int k = 0; k < 3; k++) if (fabs (x[k]) > s->reach + 1e-9) return;
    for (int i = 0; i < s->n; i++) {
        double d = 0;
        for (int k = 0; k < 3; k++) d = fmax (d, fabs (x[k] - s->x[3 * i + k]));
        if (d < 1e-9) return;
    }
    if (s->n < CUT_MEETINGS) memcpy (s->x + 3 * s->n++, x, 3 * sizeof *x);
    else s->full = 1;
}

/* Visits the box around `centre` with half edge `half`. */
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

int cut_solve (const cut_quadric *q, double reach, double *x, int *given_up)
{
    search s = {q, x, reach, 0, 0, 0};
    halve (&s, (double[]) {0, 0, 0}, reach);
    *given_up = s.full || s.boxes > BOXES;
    return s.n;
}
