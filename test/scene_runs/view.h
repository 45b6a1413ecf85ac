/* SPDX-License-Identifier: GPL-3.0-or-later
 * view.h: one plate seen in other coordinates and units. What does not depend on the observer must not
 * change. */
#ifndef PERIGAL_TEST_VIEW_H
#define PERIGAL_TEST_VIEW_H
#include "run.h"

/* x' = length (sx x) + ox, y' = length (sy y) + oy; stresses are multiplied by stress. */
typedef struct { const char *name; double length, stress, sx, sy, ox, oy; int threads; } view;
static const view plain = { "as it is", 1, 1, 1, 1, 0, 0, 1 };

static inline void seen (const view *v, const double *x, double *out)
{
    out[0] = v->length * v->sx * x[0] + v->ox;
    out[1] = v->length * v->sy * x[1] + v->oy;
}

static inline void check_box (const view *v, double width, double height, char *out, size_t size)
{
    double a[2], b[2];
    seen (v, (double[2]) { 0, 0 }, a);
    seen (v, (double[2]) { width, height }, b);
    snprintf (out, size, "{low: [%.17g, %.17g], high: [%.17g, %.17g]}", fmin (a[0], b[0]), fmin (a[1], b[1]),
              fmax (a[0], b[0]), fmax (a[1], b[1]));
}

/* For each node of `from` the node of `to` at its image (within 1e-6 spacings). */
static inline int *images (const view *v, const run *from, const run *to)
{
    size_t n = from->problem->cloud.n;
    int *image = pg_calloc (n, sizeof *image);
    assert_int_equal (n, to->problem->cloud.n);
    for (size_t i = 0; i < n; i++) {
        double x[2], best = INFINITY;
        seen (v, from->problem->cloud.x + 2 * i, x);
        for (size_t j = 0; j < n; j++) {
            const double *y = to->problem->cloud.x + 2 * j;
            double d = hypot (y[0] - x[0], y[1] - x[1]);
            if (d < best) best = d, image[i] = (int) j;
        }
        check_below (best, 1e-6 * to->problem->cloud.h);
    }
    return image;
}

/* Largest difference of the rotations of points in the plane, relative to the largest; 0 where points do not
 * turn */
static inline double rotation_difference (const view *v, const run *a, const run *b, const int *image)
{
    size_t n = a->problem->cloud.n;
    double worst = 0, top = 0;
    assert_int_equal (pg_problem_rotations (a->problem), pg_problem_rotations (b->problem));
    if (!pg_problem_rotations (a->problem)) return 0;
    double *ra = field_of (a, NULL, "rotation", NULL), *rb = field_of (b, NULL, "rotation", NULL);
    for (size_t i = 0; i < n; i++)
        top = fmax (top, fabs (ra[i])), worst = fmax (worst, fabs (rb[image[i]] * v->sx * v->sy - ra[i]));
    assert_true (top > 0 && isfinite (top));
    pg_free (ra), pg_free (rb);
    return worst / top;
}

/* Largest difference of displacement and rotation (and, stress != NULL, of stress) at image points, relative
 * to the largest value */
static inline double displacement_difference (const view *v, const run *a, const run *b, double *stress)
{
    size_t n = a->problem->cloud.n;
    int *image = images (v, a, b);
    double *ua = field_of (a, NULL, "displacement", NULL), *ub = field_of (b, NULL, "displacement", NULL),
           top = largest_of (ua, 2 * n), worst = 0;
    for (size_t i = 0; i < n; i++) {
        const double *u = ub + 2 * (size_t) image[i];
        worst = fmax (worst, fabs (u[0] / (v->length * v->sx) - ua[2*i]));
        worst = fmax (worst, fabs (u[1] / (v->length * v->sy) - ua[2*i + 1]));
    }
    assert_true (top > 0 && isfinite (top));
    double turn = rotation_difference (v, a, b, image);
    if (stress) {
        double *sa = field_of (a, NULL, "stress", NULL), *sb = field_of (b, NULL, "stress", NULL),
               strength = largest_of (sa, 3 * n);
        *stress = 0;
        for (size_t i = 0; i < n; i++) {
            const double *s = sb + 3 * (size_t) image[i], back[3] = { s[0] / v->stress, s[1] / v->stress,
                s[2] * v->sx * v->sy / v->stress };
            *stress = fmax (*stress, largest_difference (back, sa + 3*i, 3) / strength);
        }
        pg_free (sa), pg_free (sb);
    }
    pg_free (ua), pg_free (ub), pg_free (image);
    return fmax (worst / top, turn);
}

/* A points file of an nx by ny grid h apart from the origin on, moved at random by up to amount h, in an
 * order that the seed shuffles (0: by rows). The positions do not depend on the seed. */
static inline void write_points (const char *path, int nx, int ny, double h, double amount,
                                 unsigned long long seed)
{
    int n = nx * ny, *order = pg_calloc ((size_t) n, sizeof *order);
    double *x = pg_calloc (2 * (size_t) n, sizeof *x);
    unsigned long long place = 20240607;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 2; k++) {
            place = place * 6364136223846793005ull + 1442695040888963407ull;
            x[2 * i + k] = h
                           * ((k ? i / nx : i % nx)
                              + amount * ((double) (place >> 11) / 4503599627370496.0 - 1));
        }
    for (int i = 0; i < n; i++) order[i] = i;
    for (int i = n - 1; seed && i > 0; i--) {
        seed = seed * 6364136223846793005ull + 1442695040888963407ull;
        int j = (int) ((seed >> 33) % (unsigned) (i + 1)), t = order[i];
        order[i] = order[j], order[j] = t;
    }
    FILE *file = fopen (path, "w");
    assert_non_null (file);
    for (int i = 0; i < n; i++)
        fprintf (file, "%.17g, %.17g, %.17g\n", x[2 * order[i]], x[2 * order[i] + 1], h * h * 0.02);
    fclose (file);
    pg_free (x), pg_free (order);
}
#endif
