/* SPDX-License-Identifier: GPL-3.0-or-later
 * displacement_discontinuity.h: cracks in an elastic plane, or in a part of it, by elements along which the
 * jump of the displacement is constant (S. L. Crouch, Solution of plane elasticity problems by the
 * displacement discontinuity method, Int. J. Num. Meth. Eng. 10 (1976) 301-343): an independent reference
 * for paths of cracks that touch, slide and kink. The stress is a uniform one and what the jumps add. A
 * closed outline (anticlockwise) whose inner side bears only the uniform stress makes the body finite.
 * Elements of cracks are open (free of traction), slide with friction, or stick; which, is found by trying
 * again until nothing overlaps, pulls, or slides the wrong way. E' = 1: jumps are those times E', K and
 * tractions do not know it. */
#ifndef PERIGAL_BENCH_DISPLACEMENT_DISCONTINUITY_H
#define PERIGAL_BENCH_DISPLACEMENT_DISCONTINUITY_H
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    double a[2], b[2];                                 /* ends; jumps: left side less the right one */
    int    outline;                                    /* 1: of the outline of the body */
    int    open, sign;                                 /* of a crack; sense of its slip, 0: sticks */
    double slip, gap, normal, shear;  /* jump along a to b and along the left normal; tractions */
} dd_element;

/* Stresses xx, yy, xy at (x, y) of an element of half length a on the x axis: of a unit jump along x
 * (out[0]), y (out[1]). With f,yy and so on the derivatives of Crouch's function; a place on the element
 * itself is above it. */
static inline void dd_influence (double x, double y, double a, double out[2][3])
{
    double u = x - a, v = x + a, r = u * u + y * y, s = v * v + y * y, k = -1 / (4 * acos (-1));
    double xy = k * (y / r - y / s), yy = -k * (u / r - v / s), yyy = 2 * k * y * (u / (r * r) - v / (s * s)),
           xyy = k * ((u * u - y * y) / (r * r) - (v * v - y * y) / (s * s));
    out[0][0] = 2 * xy + y * xyy, out[0][1] = -y * xyy, out[0][2] = yy + y * yyy;
    out[1][0] = yy + y * yyy, out[1][1] = yy - y * yyy, out[1][2] = -y * xyy;
}

static inline double dd_frame (const dd_element *e, double t[2], double middle[2])
{
    double length = hypot (e->b[0] - e->a[0], e->b[1] - e->a[1]);
    for (int k = 0; k < 2; k++)
        t[k] = (e->b[k] - e->a[k]) / length, middle[k] = 0.5 * (e->a[k] + e->b[k]);
    return length;
}

/* Tractions (normal, shear) on element i of a stress. */
static inline void dd_traction (const double t[2], const double s[3], double out[2])
{
    double n[2] = { -t[1], t[0] }, p[2] = { s[0] * n[0] + s[2] * n[1], s[2] * n[0] + s[1] * n[1] };
    out[0] = p[0] * n[0] + p[1] * n[1], out[1] = p[0] * t[0] + p[1] * t[1];
}

/* Rows 2 i, 2 i + 1: normal traction and shear on element i of jumps 2 j (slip), 2 j + 1 (gap). */
static inline void dd_matrix (const dd_element *e, size_t n, double *A)
{
    for (size_t j = 0; j < n; j++) {
        double t[2], from[2], length = dd_frame (&e[j], t, from);
        for (size_t i = 0; i < n; i++) {
            double q[2], at[2], local[2][3], s[3], p[2];
            dd_frame (&e[i], q, at);
            double d[2] = { at[0] - from[0], at[1] - from[1] };
            dd_influence (d[0] * t[0] + d[1] * t[1], i == j ? 0 : d[1] * t[0] - d[0] * t[1], 0.5 * length,
                          local);
            for (int k = 0; k < 2; k++) {
                const double *l = local[k];
                s[0] = l[0] * t[0] * t[0] + l[1] * t[1] * t[1] - 2 * l[2] * t[0] * t[1];
                s[1] = l[0] * t[1] * t[1] + l[1] * t[0] * t[0] + 2 * l[2] * t[0] * t[1];
                s[2] = (l[0] - l[1]) * t[0] * t[1] + l[2] * (t[0] * t[0] - t[1] * t[1]);
                dd_traction (q, s, p);
                A[2 * i * 2 * n + 2 * j + (size_t) k] = p[0];
                A[(2 * i + 1) * 2 * n + 2 * j + (size_t) k] = p[1];
            }
        }
    }
}

/* x in place of b, A x = b, by elimination with row exchanges. 0: singular. */
static inline int dd_eliminate (double *A, double *b, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        size_t top = k;
        for (size_t i = k; i < n; i++) if (fabs (A[i * n + k]) > fabs (A[top * n + k])) top = i;
        if (!(fabs (A[top * n + k]) > 0)) return 0;
        for (size_t j = k; top != k && j < n; j++) {
            double swap = A[k * n + j];
            A[k * n + j] = A[top * n + j], A[top * n + j] = swap;
        }
        double swap = b[k];
        b[k] = b[top], b[top] = swap;
        for (size_t i = k + 1; i < n; i++) {
            double f = A[i * n + k] / A[k * n + k];
            if (f == 0) continue;
            for (size_t j = k; j < n; j++) A[i * n + j] -= f * A[k * n + j];
            b[i] -= f * b[k];
        }
    }
    for (size_t k = n; k-- > 0; b[k] /= A[k * n + k])
        for (size_t j = k + 1; j < n; j++) b[k] -= A[k * n + j] * b[j];
    return 1;
}

/* The outline may move as a whole: three sums of its jumps are held at 0. */
static inline void dd_hold (const dd_element *e, size_t n, double *A)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; e[i].outline && j < n; j++) {
            double t[2], x[2], q[2], y[2];
            if (!e[j].outline) continue;
            dd_frame (&e[i], t, x), dd_frame (&e[j], q, y);
            double row[3][2] = { { t[0], -t[1] }, { t[1], t[0] },
                                 { x[0] * t[1] - x[1] * t[0], x[0] * t[0] + x[1] * t[1] } },
                   column[3][2] = { { q[0], -q[1] }, { q[1], q[0] },
                                    { y[0] * q[1] - y[1] * q[0], y[0] * q[0] + y[1] * q[1] } };
            /* rows: normal, shear; columns: slip, gap */
            for (int m = 0; m < 3; m++)
                for (int r = 0; r < 2; r++)
                    for (int c = 0; c < 2; c++)
                        A[(2 * i + (size_t) r) * 2 * n + 2 * j + (size_t) c] += row[m][1 - r] * column[m][c];
        }
}

/* One solve for the states at hand. */
static inline int dd_once (dd_element *e, size_t n, const double *A, double *M, double *x,
                           const double stress[3], double friction)
{
    memcpy (M, A, 4 * n * n * sizeof *M);
    for (size_t i = 0; i < n; i++) {
        double t[2], at[2], p[2], *normal = M + 2 * i * 2 * n, *shear = normal + 2 * n;
        dd_frame (&e[i], t, at), dd_traction (t, stress, p);
        x[2 * i] = e[i].outline ? 0 : -p[0], x[2 * i + 1] = e[i].outline ? 0 : -p[1];
        if (e[i].outline || e[i].open) continue;
        /* shear = sign friction (- normal); gap = 0, or gap = slip = 0 */
        for (size_t j = 0; j < 2 * n; j++) shear[j] += e[i].sign * friction * normal[j], normal[j] = 0;
        x[2 * i + 1] += e[i].sign * friction * x[2 * i], x[2 * i] = 0, normal[2 * i + 1] = 1;
        if (e[i].sign) continue;
        memset (shear, 0, 2 * n * sizeof *shear);
        shear[2 * i] = 1, x[2 * i + 1] = 0;
    }
    dd_hold (e, n, M);
    if (!dd_eliminate (M, x, 2 * n)) return 0;
    for (size_t i = 0; i < n; i++) {
        double t[2], at[2], p[2];
        dd_frame (&e[i], t, at), dd_traction (t, stress, p);
        for (size_t j = 0; j < 2 * n; j++)
            p[0] += A[2 * i * 2 * n + j] * x[j], p[1] += A[(2 * i + 1) * 2 * n + j] * x[j];
        e[i].slip = x[2 * i], e[i].gap = x[2 * i + 1], e[i].normal = p[0], e[i].shear = p[1];
    }
    return 1;
}

/* Corrects the states of elements; how many have changed. */
static inline size_t dd_correct (dd_element *e, size_t n, double friction)
{
    size_t changes = 0;
    for (size_t i = 0; i < n; i++) {
        dd_element *k = &e[i];
        int open = k->open, sign = k->sign;
        if (k->outline) continue;
        if (open) open = k->gap >= 0, sign = k->slip >= 0 ? 1 : -1;
        else if (k->normal > 0) open = 1;
        else if (sign && sign * k->slip < 0) sign = 0;
        else if (!sign && fabs (k->shear) > -friction * k->normal) sign = k->shear > 0 ? 1 : -1;
        changes += open != k->open || sign != k->sign;
        k->open = open, k->sign = sign;
    }
    return changes;
}

/* Solves; 0: no memory, singular, or the states do not settle. */
static inline int dd_solve (dd_element *e, size_t n, const double stress[3], double friction)
{
    enum { TRIES = 30 };
    double *A = calloc (4 * n * n, sizeof *A), *M = calloc (4 * n * n, sizeof *M),
           *x = calloc (2 * n, sizeof *x);
    int done = 0, sound = A && M && x;
    if (sound) dd_matrix (e, n, A);
    for (int k = 0; sound && !done && k < TRIES; k++) {
        sound = dd_once (e, n, A, M, x, stress, friction);
        done = sound && dd_correct (e, n, friction) == 0;
    }
    free (A), free (M), free (x);
    return done;
}

/* K_I, K_II of a tip from the last element, whose jump is that of a straight crack of so many elements. */
static inline void dd_intensity (const dd_element *last, double sense, double K[2])
{
    enum { ELEMENTS = 100 };
    static double scale = 0;
    const double pull[3] = { 0, 1, 0 };
    if (scale == 0) {
        dd_element e[ELEMENTS];
        memset (e, 0, sizeof e);
        for (int i = 0; i < ELEMENTS; i++)
            e[i].a[0] = -1 + 2.0 * i / ELEMENTS, e[i].b[0] = -1 + 2.0 * (i + 1) / ELEMENTS, e[i].open = 1;
        if (dd_solve (e, ELEMENTS, pull, 0)) scale = sqrt (2.0 / ELEMENTS) / e[0].gap;
    }
    double length = hypot (last->b[0] - last->a[0], last->b[1] - last->a[1]), pi = acos (-1);
    K[0] = scale * sqrt (pi / length) * last->gap, K[1] = scale * sqrt (pi / length) * last->slip * sense;
}
#endif
