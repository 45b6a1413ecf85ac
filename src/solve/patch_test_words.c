/* SPDX-License-Identifier: GPL-3.0-or-later
 * The patch test of a discretisation in words: how far off it is, what to do about it, when it is refused. */
#include "solve/run/solve.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Name of the worst state of stress, in Voigt order; in 2D the third is xy. */
const char *pg_patch_state (const pg_problem *p)
{
    static const char *const names[] = { "xx", "yy", "zz", "xy", "yz", "zx" };
    return names[p->dim == 2 && p->quality.patch.state == 2 ? 3 : p->quality.patch.state];
}

/* Writes a position, such as (0.1, 0.2) m. */
void pg_patch_place (const pg_problem *p, const double *x, char *out, size_t size)
{
    int n = snprintf (out, size, "(");
    for (int k = 0; k < p->dim && (size_t) n < size; k++)
        n += snprintf (out + n, size - (size_t) n, k ? ", %.6g" : "%.6g", x[k]);
    if ((size_t) n < size) snprintf (out + n, size - (size_t) n, ") m");
}

/* A share in per cent, rounded to two digits. */
static double percent (double share)
{
    double value = 100 * fabs (share), unit = value > 0 ? pow (10, floor (log10 (value)) - 1) : 1;
    return isfinite (value) ? round (value / unit) * unit : value;
}

/* Writes one sentence: the error, and how much too soft or too stiff the body is where that is most of it. */
void pg_patch_words (const pg_problem *p, char *out, size_t size)
{
    const pg_patch *t = &p->quality.patch;
    char by[60] = "";
    if (t->error >= 0.01 && fabs (t->compliance) >= 0.5 * t->error)
        snprintf (by, sizeof by, ": this body is %.4g %% too %s", percent (t->compliance),
                  t->compliance > 0 ? "soft" : "stiff");
    if (t->error < 1e-5)
        snprintf (out, size, "under uniform stress the displacement is off by less than 0.001 %%");
    else if (isinf (t->error))
        snprintf (out, size, "under uniform stress %s the displacement has no bound", pg_patch_state (p));
    else
        snprintf (out, size, "under uniform stress %s the displacement is off by %s%.4g %%%s",
                  pg_patch_state (p), t->settled ? "" : "at least ", percent (t->error), by);
}

/* Number of points across the thinnest side of the box around all points. */
static double thinnest (const pg_problem *p)
{
    const pg_cloud *c = &p->cloud;
    double least = INFINITY;
    for (int k = 0; k < p->dim; k++)
        least = fmin (least, (c->high[k] - c->low[k]) / (p->lattice.dim ? c->step[k] : c->h) + 1);
    return round (least);
}

/* 1: the influence function and its slope are zero at the horizon, and its slope is zero at the point itself:
 * such functions are integrated best. */
static int ends_smoothly (const pg_kernel *kernel)
{
    const double q[2] = { 1e-9, 1 - 1e-9 };
    double w[2], dw[2];
    kernel->value (2, q, w, dw);
    return fabs (dw[0]) < 1e-6 && fabs (w[1]) < 1e-6 && fabs (dw[1]) < 1e-6;
}

/* Writes the change that helps most: more points for bonds, consistent integration or exact derivatives for
 * shape functions. */
void pg_patch_remedy (const pg_problem *p, char *out, size_t size)
{
    double reach = p->form.approx.horizon / p->cloud.h, across = thinnest (p);
    int exact = p->form.approx.type->exact, consistent = p->form.integration->consistent,
        smooth = ends_smoothly (p->form.approx.kernel);
    if (p->sums && across < 4 * reach)
        snprintf (out, size,
                  "bond-type forces want at least %.0f points across, four horizons, and this body has %.0f: "
                  "use a smaller spacing or force: galerkin",
                  ceil (4 * reach), across);
    else if (p->sums && p->lattice.dim && p->cloud.step[0] > 0)
        snprintf (out, size,
                  "families cut by the surface and rows that bear loads make the difference: use a smaller "
                  "spacing, a smaller horizon (now %.3g spacings), or force: galerkin",
                  reach);
    else if (p->sums)
        snprintf (out, size,
                  "points that lie unevenly, or a kernel and horizon that few points sum badly: use a "
                  "lattice, a smaller spacing, horizon: 3 spacing, or force: galerkin");
    else if (p->cells.n == 0)
        snprintf (out, size,
                  "points without cells are integrated by their volumes: use points that lie more evenly, or "
                  "a mesh or body with integration: consistent");
    else if (p->form.approx.type->interpolates)
        snprintf (out, size,
                  "use %sessential: nitsche (supports on the points of nosb are not consistent), or "
                  "approximation: rkpm",
                  consistent ? "" : "integration: consistent and ");
    else if (!consistent)
        snprintf (out, size, "use integration: consistent%s%s",
                  exact ? "" : ", with approximation: rkpm if the horizon is wide",
                  smooth ? "" : ", or kernel: cubic_spline");
    else snprintf (out, size, "use a smaller spacing%s", exact ? "" : ", or approximation: rkpm");
}

/* Refuses too large an error unless the scene accepts it, too few neighbours always. */
pg_status pg_patch_refuse (const pg_problem *p, const pg_scene *scene)
{
    const pg_patch *t = &p->quality.patch;
    char words[240], remedy[240], at[100];
    if (!t->measured) return PG_OK;
    pg_patch_place (p, 4 * t->degenerate > t->points ? t->blind : t->worst, at, sizeof at);
    if (4 * t->degenerate > t->points)
        pg_scene_fault (scene, "method.horizon",
                        "%zu of %zu evaluation points, such as that at %s, see too few points for a strain "
                        "and would carry no stress: use a larger horizon%s "
                        "(now %.4g spacings), or a finer spacing",
                        t->degenerate, t->points, at, p->form.approx.order == 2 ? ", or basis: linear" : "",
                        p->form.approx.horizon / p->cloud.h);
    else if (!(t->error <= PG_PATCH_REFUSED) && !p->quality.accept_inexact) {
        pg_patch_words (p, words, sizeof words);
        pg_patch_remedy (p, remedy, sizeof remedy);
        pg_scene_fault (scene, "method",
                        "%s; most of all at %s; %s, or method.accept_inexact: yes to run all the same",
                        words, at, remedy);
    }
    return pg_scene_verdict (scene);
}
