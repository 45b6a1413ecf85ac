/* SPDX-License-Identifier: GPL-3.0-or-later
 * How far the vertices of crack fronts go in an event. With u_i the square root of the energy released over
 * the energy taken, u_top the largest, l the length of a facet,
 *
 *   d_i / l = p (1 - mu / u_i - (R d)_i)  where that is positive, else 0,
 *
 * and mu such that the largest d_i is l. Without R a vertex goes the less the lower its u, by p times as
 * much. R is what the advance itself makes of u, to first order (Rice 1985, half plane; Gao and Rice 1987,
 * circle; c the distance of two vertices in a straight line):
 *
 *   (R d)_i = 1 / (2 pi) int (d_i - d (s)) / c^2 ds.
 *
 * A vertex that runs ahead of its neighbours releases less energy there: what is asked for are ways whose
 * u fits them AFTER the step, so that no wave is overshot, however short it is. A wave d = cos k s has R d =
 * |k| / 2 d, in the sums over vertices too, if those next to each other count one and a half times: for
 * sum_n (1 - cos n x) / n^2 = pi x / 2 - x^2 / 4, and the half takes the second term away. Measured values
 * that scatter by e u make waves of 2 e / (|k| + 2 / (p l)), never more than p l e.
 *
 * Times the lengths of front w_i the equations are symmetric, positive definite, with no positive entry off
 * the diagonal, so that no way becomes less as mu falls (Fiedler and Ptak 1962): from u_top down, vertices
 * join one after the other, each by a row more of a Cholesky factor, until the longest way is l.
 */
#include "front_growth.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

static const double power = 8;                         /* p of the head of this file */

/* Sets the width of each vertex: half of the distances to both neighbours. */
static void set_widths (const pg_front *front, front_vertex *v)
{
    size_t n = front->n;
    for (size_t i = 0; i < n; i++) {
        size_t a = i > 0 ? i - 1 : front->closed ? n - 1 : i, b = i + 1 < n ? i + 1 : front->closed ? 0 : i;
        v[i].width = 0.5 * (pg_distance (3, front->x + 3*i, front->x + 3*a)
                            + pg_distance (3, front->x + 3*i, front->x + 3*b));
    }
}

/* R += w_i R_ij of one front, whose first vertex is number `first` of n. */
static void add_front (const pg_front *front, const front_vertex *v, size_t first, size_t n, double *R)
{
    const double pi = acos (-1);
    for (size_t i = 0; i < front->n; i++)
        for (size_t j = 0; j < i; j++) {
            int beside = i - j == 1 || (front->closed && i - j == front->n - 1);
            double c = pg_distance (3, front->x + 3*i, front->x + 3*j);
            double r = (beside ? 1.5 : 1) * v[i].width * v[j].width / (2 * pi * c * c);
            double *a = R + (first + i) * n + first, *b = R + (first + j) * n + first;
            a[j] -= r, b[i] -= r, a[i] += r, b[j] += r;
        }
}

/* Fills the widths and w_i R_ij. Fronts are taken to be far from each other: one does not shield another. */
pg_status fronts_couple (front_growth *f, const pg_front *front)
{
    pg_status status = PG_OK;
    PG_GROW (f->couple, f->cap_couple, f->n * f->n);
    PG_GROW (f->factor, f->cap_factor, f->n * f->n);
    PG_GROW (f->going, f->cap_going, f->n);
    PG_GROW (f->goes, f->cap_goes, f->n);
    PG_GROW (f->forward, f->cap_forward, 2 * f->n);
    PG_GROW (f->line, f->cap_line, 2 * f->n);
    memset (f->couple, 0, f->n * f->n * sizeof *f->couple);
    for (size_t k = 0; k < f->nfront; k++) {
        size_t first = f->first[k];
        if (f->first[k + 1] == first) continue;
        set_widths (&front[k], f->vertex + first);
        add_front (&front[k], f->vertex + first, first, f->n, f->couple);
    }
done:
    return status;
}

/* Adds vertex `at` to the m that advance: a row of the factor L of their equations, and of the solutions of L
 * y for the right-hand sides w and w / u. */
static void join (front_growth *f, size_t m, size_t at, double l)
{
    const front_vertex *v = &f->vertex[at];
    double *row = f->factor + m * f->n, diagonal = f->couple[at * f->n + at] + v->width / (power * l);
    double y[2] = { v->width, v->width / v->share };
    for (size_t j = 0; j < m; j++) {
        const double *other = f->factor + j * f->n;
        row[j] = f->couple[at * f->n + f->going[j]];
        for (size_t k = 0; k < j; k++) row[j] -= row[k] * other[k];
        row[j] /= other[j];
        diagonal -= row[j] * row[j];
        y[0] -= row[j] * f->forward[2*j], y[1] -= row[j] * f->forward[2*j + 1];
    }
    row[m] = sqrt (diagonal);
    f->forward[2*m] = y[0] / row[m], f->forward[2*m + 1] = y[1] / row[m];
    f->going[m] = at;
}

/* Finds a and b from L: the ways of the m vertices that advance are a - mu b. */
static void solve (front_growth *f, size_t m)
{
    memcpy (f->line, f->forward, 2 * m * sizeof *f->line);
    for (size_t i = m; i-- > 0; ) {
        const double *row = f->factor + i * f->n;
        for (int q = 0; q < 2; q++) {
            f->line[2*i + q] /= row[i];
            for (size_t j = 0; j < i; j++) f->line[2*j + q] -= row[j] * f->line[2*i + q];
        }
    }
}

/* The vertex that joins next as mu falls, where 1 - mu / u = (R (a - mu b)), and that mu; n: none is left. */
static size_t next_to_join (const front_growth *f, size_t m, const unsigned char *goes, double *mu)
{
    size_t best = f->n;
    *mu = 0;
    for (size_t i = 0; i < f->n; i++) {
        const front_vertex *v = &f->vertex[i];
        if (goes[i] || !(v->share > 0)) continue;
        double above = v->width, below = v->width / v->share;
        for (size_t j = 0; j < m; j++) {
            double r = f->couple[i * f->n + f->going[j]];
            above -= r * f->line[2*j], below -= r * f->line[2*j + 1];
        }
        if (above / below > *mu) *mu = above / below, best = i;
    }
    return best;
}

void fronts_set_ways (front_growth *f, const double *l)
{
    size_t m = 0;
    for (size_t i = 0; i < f->n; i++) f->vertex[i].way = 0, f->goes[i] = 0;
    for (;;) {
        double mu = 0, join_at;
        for (size_t i = 0; i < m; i++)
            mu = fmax (mu, (f->line[2*i] - l[f->going[i]]) / f->line[2*i + 1]);
        size_t at = next_to_join (f, m, f->goes, &join_at);
        if (at == f->n || (m && join_at <= mu)) {
            for (size_t i = 0; i < m; i++)
                f->vertex[f->going[i]].way = fmax (0, f->line[2*i] - mu * f->line[2*i + 1]);
            return;
        }
        join (f, m++, at, l[at]), f->goes[at] = 1;
        solve (f, m);
    }
}
