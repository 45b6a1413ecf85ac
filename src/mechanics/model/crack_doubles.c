/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that the scene gives twice. The tips of coincident cracks leave no room for integration rings, so
 * that neither would grow: the second crack is removed with a warning. In 2D a piece that lies on another is
 * the same crack; two straight cracks that overlap are united. */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static double distance (int dim, const double *a, const double *b)
{
    double sum = 0;
    for (int k = 0; k < dim; k++) sum = hypot (sum, a[k] - b[k]);
    return sum;
}

/* Positions of the ends of b along a, as fractions of its length; returns 0: they are not on the line of
 * a. */
static int on_line (const pg_crack *a, const pg_crack *b, double near, double share[2])
{
    const double *x = a->vertex, *y = b->vertex;
    double t[2] = { x[2] - x[0], x[3] - x[1] }, length = hypot (t[0], t[1]);
    for (int end = 0; end < 2; end++) {
        double v[2] = { y[2 * end] - x[0], y[2 * end + 1] - x[1] };
        if (fabs (t[0] * v[1] - t[1] * v[0]) > near * length) return 0;
        share[end] = (t[0] * v[0] + t[1] * v[1]) / (length * length);
    }
    return 1;
}

/* Returns 1: a and b have the same vertices, in the same or the reverse cyclic order. */
static int same_outline (const pg_crack *a, const pg_crack *b, double near)
{
    size_t n = a->nvertex;
    if (n != b->nvertex) return 0;
    for (size_t shift = 0; shift < n; shift++)
        for (int back = 0; back < 2; back++) {
            size_t i = 0;
            while (i < n && distance (3, a->vertex + 3*i, b->vertex + 3 * ((back ? n - i + shift : i
                                                                            + shift) % n))
                                <= near)
                i++;
            if (i == n) return 1;
        }
    return 0;
}

/* Returns 1: crack b is a part of a. *overlap: 1: they share a piece (2D). */
static int contains (int dim, const pg_crack *a, const pg_crack *b, double near, int *overlap)
{
    double share[2];
    *overlap = 0;
    if (a->kind != b->kind) return 0;
    if (a->kind == PG_CRACK_DISC)
        return distance (3, a->centre, b->centre) <= near && fabs (a->radius - b->radius) <= near
               && fabs (fabs (a->normal[0] * b->normal[0] + a->normal[1] * b->normal[1]
                              + a->normal[2] * b->normal[2]) - 1) < 1e-9;
    if (dim == 3) return same_outline (a, b, near);
    if (!on_line (a, b, near, share)) return 0;
    double length = distance (2, a->vertex, a->vertex + 2), tolerance = near / length,
           low = fmin (share[0], share[1]), high = fmax (share[0], share[1]);
    *overlap = low < 1 - 2 * tolerance && high > 2 * tolerance;
    return low >= -tolerance && high <= 1 + tolerance;
}

/* Number of pieces, and the first, of the entry in `cracks` to which piece i belongs. */
static size_t pieces_of (const pg_cracks *all, size_t i, size_t *first)
{
    size_t last = i;
    for (*first = i; *first > 0 && all->crack[*first - 1].entry == all->crack[i].entry; --*first);
    while (last < all->n && all->crack[last].entry == all->crack[i].entry) last++;
    return last - *first;
}

/* Extends straight crack a to the union of a and b. */
static void join (pg_crack *a, const pg_crack *b)
{
    double share[2], x[4];
    memcpy (x, a->vertex, sizeof x);
    if (!on_line (a, b, INFINITY, share)) return;
    for (int end = 0; end < 2; end++) {
        int at = share[end] < 0 ? 0 : 1;
        if (share[end] < 0 || share[end] > 1)
            x[2 * at] = b->vertex[2 * end], x[2 * at + 1] = b->vertex[2 * end + 1];
    }
    memcpy (a->vertex, x, sizeof x);
}

static void drop (pg_cracks *all, size_t i)
{
    pg_free (all->crack[i].vertex), pg_free (all->crack[i].retreat);
    memmove (all->crack + i, all->crack + i + 1, (all->n - i - 1) * sizeof *all->crack);
    all->n--;
}

/* Treats piece j, which may coincide with an earlier piece i; returns 1: j is removed. */
static int settle (pg_problem *p, size_t i, size_t j, const pg_scene *scene)
{
    pg_cracks *all = &p->crack.given;
    pg_crack *a = &all->crack[i], *b = &all->crack[j];
    double near = 1e-9 * pg_crack_size (a, p->dim);
    int overlap, back, whole = contains (p->dim, a, b, near, &overlap),
        inside = !whole && p->dim == 2 && contains (2, b, a, near, &back);
    size_t first, other;
    char at[64];
    if (!whole && !inside && !overlap) return 0;
    int lone = pieces_of (all, j, &first) == 1, alone = pieces_of (all, i, &other) == 1;
    if (!(whole && p->dim == 3) && !(lone && (whole || alone))) {
        /* part of a polyline: an error (whole polylines are treated by drop_polyline) */
        snprintf (at, sizeof at, "cracks[%zu]", b->entry);
        pg_scene_fault (scene, at, "runs along a piece of cracks[%zu]: give each piece once", a->entry);
        return 0;
    }
    pg_problem_note (p, PG_WARNING "cracks[%zu] %s cracks[%zu]: they count as one", b->entry,
                     whole ? "is given already as" : "lies on", a->entry);
    if (!whole) join (a, b);
    drop (all, j);
    return 1;
}

/* Returns 1: each of the n pieces of polyline j lies on one of the m pieces of entry i. */
static int same_polyline (const pg_cracks *all, size_t j, size_t n, size_t i, size_t m)
{
    int overlap;
    for (size_t k = 0; k < n; k++) {
        int found = 0;
        for (size_t q = i; q < i + m && !found; q++)
            found = contains (all->dim, &all->crack[q], &all->crack[j + k],
                              1e-9 * pg_crack_size (&all->crack[q], all->dim), &overlap);
        if (!found) return 0;
    }
    return 1;
}

static int drop_polyline (pg_problem *p, size_t j)
{
    pg_cracks *all = &p->crack.given;
    size_t first, other, n = pieces_of (all, j, &first);
    if (n < 2 || first != j) return 0;
    for (size_t i = 0; i < j; i += pieces_of (all, i, &other)) {
        size_t m = pieces_of (all, i, &other);
        if (!same_polyline (all, j, n, i, m)) continue;
        pg_problem_note (p, PG_WARNING "cracks[%zu] is given already as cracks[%zu]: they count as one",
                         all->crack[j].entry, all->crack[i].entry);
        for (size_t k = 0; k < n; k++) drop (all, j);
        return 1;
    }
    return 0;
}

pg_status drop_doubled_cracks (pg_problem *p, const pg_scene *scene)
{
    size_t before = p->crack.given.n, first = 0;
    if (p->dim < 2) return PG_OK;
    /* The pieces of the current entry start at `first`; those before belong to other entries. */
    for (size_t j = 1; j < p->crack.given.n; j++) {
        int begins = p->crack.given.crack[j].entry != p->crack.given.crack[j - 1].entry, gone;
        if (begins) first = j;
        gone = begins && drop_polyline (p, j);
        for (size_t i = 0; i < first && !gone; i++) gone = settle (p, i, j, scene);
        /* the next piece has moved to index j */
        if (gone) j--;
    }
    return p->crack.given.n < before ? pg_cracks_index (&p->crack.given) : PG_OK;
}
