/* SPDX-License-Identifier: GPL-3.0-or-later
 * Plane waves of a lattice for all wave vectors of the Brillouin zone: has every motion a stiffness, what is
 * the highest frequency, how fast are long waves? The zone is sampled with 240 wave vectors along the axis
 * in 1D, 48 x 48 in 2D and 24^3 in 3D; edges and corners belong to the grid, since instabilities such as the
 * checkerboard lie there. */
#include "symbol.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
/* none: a motion with a smaller eigenvalue, relative to the largest one, has no energy; feeble: a motion with
 * less than this share of the stiffness of a continuum's wave is weak. */
static const double none = 1e-10, feeble = 1e-2;

/* ---- the zone ------------------------------------------------------------------------------------------ */
/* One wave vector: its position in the grid, how many vectors of the zone it represents, k (rad/m), the
 * eigenvalue of the continuum's softest wave, its modes by eigenvalue (still) and by frequency (moving). */
typedef struct { int at[3], copies; double k[3], stiffness; pg_symbol_modes still, moving; } sample;
typedef struct { const pg_symbol *s; sample *list; } work;

/* Eigenvalue of the continuum's softest wave over k^2: shear modulus (1D: Young's modulus)
 * times h^2 / E. */
static double continuum (const pg_symbol *s)
{
    const double *D = s->material.D;
    return (s->dim == 1 ? D[0] : D[s->dim == 2 ? 8 : 21]) * s->h * s->h / s->material.modulus;
}

/* Solves the wave vectors first to last - 1; each thread writes its own ones. */
static void solve_range (void *context, size_t first, size_t last, int thread)
{
    work *w = context;
    (void) thread;
    for (size_t i = first; i < last; i++) {
        sample *x = &w->list[i];
        double kk = 0;
        for (int a = 0; a < w->s->dim; a++) kk += x->k[a] * x->k[a];
        x->stiffness = kk > 0 ? continuum (w->s) * kk * fmax (pg_symbol_amplitude (w->s, x->k), none) : 0;
        pg_symbol_solve (w->s, x->k, 0, &x->still);
        pg_symbol_solve (w->s, x->k, 1, &x->moving);
    }
}

/* Samples the wave vectors pi / step times at / (grid / 2) with `at` from 1 - grid / 2 to grid / 2. Of k and
 * - k, which have the same modes, only the one is kept whose first component that is neither 0 nor at the
 * edge is positive. */
static pg_status sample_zone (const pg_symbol *s, int grid, sample **out, size_t *n)
{
    pg_status status = PG_OK;
    size_t side = (size_t) grid, all = s->dim == 1 ? side : s->dim == 2 ? side * side : side * side * side;
    PG_ALLOC (*out, all);
    *n = 0;
    for (size_t i = 0; i < all; i++) {
        sample *x = &(*out)[*n];
        size_t rest = i;
        int sign = 0, itself = 1;
        memset (x, 0, sizeof *x);
        for (int a = 0; a < s->dim; a++, rest /= side) {
            x->at[a] = (int) (rest % side) + 1 - grid / 2;
            x->k[a] = pi * x->at[a] / (grid / 2) / s->step[a];
            if (x->at[a] == 0 || x->at[a] == grid / 2) continue;  /* 0 and the edge are their own opposites */
            itself = 0;
            if (!sign) sign = x->at[a];
        }
        x->copies = itself ? 1 : 2;
        if (sign >= 0) ++*n;
    }
    work w = { s, *out };
    pg_parallel_heavy (s->threads, *n, solve_range, &w);
done:
    return status;
}

/* ---- evaluation of the samples ------------------------------------------------------------------------- */
/* Mode i of a sample as a pg_motion; alike: the number of modes of the same value. */
static pg_motion motion_of (const sample *x, const pg_symbol_modes *modes, int i, double value, double scale)
{
    pg_motion m = { { x->k[0], x->k[1], x->k[2] }, value, modes->turning[i], modes->along[i], 0 };
    for (int q = 0; q < modes->n; q++) m.alike += fabs (modes->value[q] - modes->value[i]) <= 1e-9 * scale;
    return m;
}

/* |k|^2, which orders waves by their length. */
static double length (const pg_motion *m)
{
    return m->k[0] * m->k[0] + m->k[1] * m->k[1] + m->k[2] * m->k[2];
}

/* 1 for a rigid translation: a mode at k = 0 without energy that is mostly displacement. */
static int rigid (const sample *x, int i, double largest)
{
    return x->stiffness == 0 && fabs (x->still.value[i]) <= none * largest && x->still.turning[i] < 0.5;
}

/* Adds one sample to the survey: extremes of the eigenvalues, those at the edges of the zone (`ends`:
 * components at the edge; `inside`: between 0 and the edge), rotations, and the counts of unstable and weak
 * motions, each counted for k and - k. */
static void look (pg_survey *o, const pg_symbol *s, const sample *x, int grid)
{
    const pg_symbol_modes *m = &x->still;
    int ends = 0, inside = 0;
    for (int a = 0; a < s->dim; a++)
        ends += x->at[a] == grid / 2, inside += x->at[a] != 0 && x->at[a] != grid / 2;
    for (int i = 0; i < m->n; i++) {
        double v = m->value[i], ratio = x->stiffness > 0 ? v / x->stiffness : INFINITY;
        if (rigid (x, i, o->largest)) continue;
        if (v < o->smallest.value) o->smallest = motion_of (x, m, i, v, o->largest);
        if (ratio < o->softest.value && m->turning[i] < 0.5)
            o->softest = motion_of (x, m, i, ratio, o->largest);
        if (m->turning[i] >= 0.5) o->turning[1] = isnan (o->turning[1]) ? v : fmin (o->turning[1], v);
        if (x->stiffness == 0 && m->turning[i] >= 0.5)
            o->turning[0] = isnan (o->turning[0]) ? v : fmin (o->turning[0], v);
        if (ends && !inside)
            o->shortest[0] = fmin (o->shortest[0], v), o->shortest[1] = fmax (o->shortest[1], v);
        if (v < -none * o->largest) o->negative += (size_t) x->copies;
        else if (v <= none * o->largest) {
            pg_motion here = motion_of (x, m, i, v, o->largest);
            if (!o->zero || length (&here) > length (&o->first)) o->first = here;
            o->zero += (size_t) x->copies;
        } else if (ratio < feeble && m->turning[i] < 0.5) o->weak += (size_t) x->copies;
    }
    int top = x->moving.n - 1;
    if (x->moving.value[top] > o->fastest.value)
        o->fastest = motion_of (x, &x->moving, top, x->moving.value[top], x->moving.value[top]);
}

/* ---- long waves ---------------------------------------------------------------------------------------- */
/* Computes the speeds of waves with a length of 20 spacings over those of the continuum. The longitudinal
 * wave is the mode with most displacement along k; the shear waves are the slowest of the others, since
 * rotations have high frequencies. */
static void travel (pg_survey *o, const pg_symbol *s)
{
    static const char *const names[] = { "x", "xy", "xyz" };
    pg_waves w = pg_material_waves (&s->material);
    for (int d = 0; d < s->dim; d++) {
        pg_symbol_modes m;
        double k[3] = { 0 }, size = 2 * pi / (20 * s->h);
        int best = 0, found = 0;
        for (int a = 0; a <= d; a++) k[a] = size / sqrt (d + 1);
        pg_symbol_solve (s, k, 1, &m);
        for (int i = 1; i < m.n; i++)
            if ((1 - m.turning[i]) * m.along[i] > (1 - m.turning[best]) * m.along[best]) best = i;
        o->wave[d].along = names[d], o->wave[d].longitudinal = m.value[best] / size / w.pressure;
        o->wave[d].shear[0] = o->wave[d].shear[1] = NAN;
        for (int i = 0; i < m.n && found < s->dim - 1; i++)  /* slow modes come first; rotations are fast */
            if (i != best && m.turning[i] < 0.5) o->wave[d].shear[found++] = m.value[i] / size / w.shear;
        if (found == 1) o->wave[d].shear[1] = o->wave[d].shear[0];
    }
}

pg_status pg_symbol_survey (pg_survey *o, const pg_symbol *s)
{
    pg_status status = PG_OK;
    sample *list = NULL;
    size_t n = 0;
    int nv = pg_voigt_size (s->dim);
    memset (o, 0, sizeof *o);
    o->grid = s->dim == 1 ? 240 : s->dim == 2 ? 48 : 24;
    o->smallest.value = o->softest.value = o->shortest[0] = INFINITY, o->shortest[1] = -INFINITY,
    o->turning[0] = o->turning[1] = NAN;
    PG_TRY (sample_zone (s, o->grid, &list, &n));
    o->vectors = n;
    for (size_t i = 0; i < n; i++)
        o->largest = fmax (o->largest,
                           fmax (fabs (list[i].still.value[0]), list[i].still.value[list[i].still.n - 1]));
    for (size_t i = 0; i < n; i++) look (o, s, &list[i], o->grid);
    travel (o, s);
    pg_symbol_tangent (s, o->tangent);
    for (int e = 0; e < nv * nv; e++) {
        double D = s->material.D[e];
        o->tangent[e] = fabs (D) > 1e-12 * s->material.modulus ? o->tangent[e] / D
                                                               : o->tangent[e] / s->material.modulus;
    }
done:
    pg_free (list);
    return status;
}

/* ---- path ---------------------------------------------------------------------------------------------- */
/* Point i of a path through the zone with `leg` points a leg: wave vector k (rad/m), length of the path so
 * far, and name of a corner. Corners are in units of pi / step, by dimension. */
size_t pg_symbol_path (const pg_symbol *s, size_t leg, size_t i, double *k, double *length_of,
                       const char **name)
{
    static const int corner[3][5][3] = { { { 0 }, { 1 } },
                                         { { 0 }, { 1 }, { 1, 1 }, { 0 } },
                                         { { 0 }, { 1 }, { 1, 1 }, { 1, 1, 1 }, { 0 } } };
    static const char *const names[3][5] = { { "Gamma", "X" },
                                             { "Gamma", "X", "M", "Gamma" },
                                             { "Gamma", "X", "M", "R", "Gamma" } };
    size_t legs = (size_t) (s->dim == 1 ? 1 : s->dim + 1), from = i / leg < legs ? i / leg : legs - 1;
    const int (*c)[3] = corner[s->dim - 1];
    double share = ((double) i - (double) (from * leg)) / (double) leg;
    *length_of = 0;
    for (size_t q = 0; q <= from; q++) {
        double way = 0;
        for (int a = 0; a < s->dim; a++)
            way += (c[q + 1][a] - c[q][a]) * (c[q + 1][a] - c[q][a]) * pi * pi / (s->step[a] * s->step[a]);
        *length_of += sqrt (way) * (q < from ? 1 : share);
    }
    for (int a = 0; a < s->dim; a++)
        k[a] = pi / s->step[a] * (c[from][a] + share * (c[from + 1][a] - c[from][a]));
    *name = i % leg ? "" : names[s->dim - 1][i / leg];
    return legs * leg + 1;
}
