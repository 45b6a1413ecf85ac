/* SPDX-License-Identifier: GPL-3.0-or-later
 * Divides the surface of the body opposite a platen into pieces of about two spacings; effect of rigid
 * motions of the platen on their gaps.
 *
 * Points are those by which a traction is integrated over the boundary facets, so that forces of pieces are
 * tractions like any other, also on cut cells and meshes. Only points are used where the surface faces the
 * platen within 60 degrees and no part of the body lies between. Along the platen (3D: on a grid of its two
 * directions) they are divided into pieces of equal size; gaps are measured along the normal n of the platen
 * at its nearest point, from the initial positions:
 *
 *     g_n = distance + n . (u - v),    g_t = t . (u - v),    v = q + w x (x - point) the motion of the
 * platen. */
#include "pieces.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Cosine of the largest angle between surface and platen; in spacings: difference of distance from which a
 * point hides another, and size of the boxes in which it is tested. */
static const double FACES = 0.5, HIDES = 1.5, BOX = 0.5;
/* Distance along the platen beyond which points belong to separate parts, spacings. */
static const double APART = 1.25;

/* A point of the surface (index `at`), or a half of it on a border of pieces: coordinates s along the platen,
 * distance from it, local spacing h, m; normal; weight: area, m^2; box: piece or grid indices. */
typedef struct { size_t at; double s[2], distance, h, normal[3], weight; long box[2]; } candidate;
typedef struct {
    const pg_problem *p;
    const pg_platen *platen;
    const pg_quadrature *q;
    candidate *point;  size_t n, capacity;
    double along[2][3];                                /* directions along the platen, at its `point` */
} facing;

/* ---- selection of points ------------------------------------------------------------------------------- */
static double product (const double *a, const double *b, size_t dim)
{
    double sum = 0;
    for (size_t k = 0; k < dim; k++) sum += a[k] * b[k];
    return sum;
}

/* Computes unit tangents t normal to n: the projection of a, and (3D) n x that. */
static void tangents (const double *n, const double *a, size_t dim, double t[2][3])
{
    if (dim == 2) {
        t[0][0] = n[1], t[0][1] = -n[0], t[0][2] = 0;
        return;
    }
    double along = product (a, n, 3), size = 0;
    for (int k = 0; k < 3; k++) t[0][k] = a[k] - along * n[k], size += t[0][k] * t[0][k];
    if (!(size > 1e-12)) {                             /* a is parallel to n (on a sphere) */
        const double other[3] = { a[1], a[2], a[0] };
        tangents (n, other, dim, t);
        return;
    }
    for (int k = 0; k < 3; k++) t[0][k] /= sqrt (size);
    for (int k = 0; k < 3; k++)
        t[1][k] = n[(k + 1) % 3] * t[0][(k + 2) % 3] - n[(k + 2) % 3] * t[0][(k + 1) % 3];
}

/* Finds two directions along the platen, tangents to its mean normal over the facing points: from the axis of
 * a cylinder, or the coordinate axis nearest to the tangent plane. */
static void find_directions (facing *f)
{
    size_t dim = (size_t) f->p->dim, flat = 0;
    double mean[3] = { 0 }, size = 0, axis[3] = { 0 };
    for (size_t i = 0; i < f->n; i++)
        for (size_t k = 0; k < dim; k++) mean[k] += f->point[i].normal[k];
    for (size_t k = 0; k < dim; k++) size += mean[k] * mean[k];
    if (!(size > 0)) mean[dim - 1] = size = 1;
    for (size_t k = 0; k < dim; k++) mean[k] /= sqrt (size);
    for (size_t k = 1; k < dim; k++) if (fabs (mean[k]) < fabs (mean[flat]) - 1e-9) flat = k;
    axis[flat] = 1;
    if (f->platen->shape == PG_PLATEN_CYLINDER && dim == 3) memcpy (axis, f->platen->normal, sizeof axis);
    tangents (mean, axis, dim, f->along);
}

/* Computes the coordinates s of points along the platen: lengths on its surface from its middle, m. */
static void find_places (facing *f)
{
    const pg_platen *p = f->platen;
    size_t dim = (size_t) f->p->dim;
    double mean[3];
    for (size_t k = 0; k < 3; k++) mean[k] = 0;
    for (size_t k = 0; k < dim && dim == 3; k++)
        mean[k] = f->along[0][(k + 1) % 3] * f->along[1][(k + 2) % 3]
                  - f->along[0][(k + 2) % 3] * f->along[1][(k + 1) % 3];
    if (dim == 2) mean[0] = -f->along[0][1], mean[1] = f->along[0][0];
    for (size_t i = 0; i < f->n; i++) {
        candidate *c = &f->point[i];
        const double *x = f->q->x + c->at * dim;
        double v[3] = { 0 }, flat = 0;
        for (size_t k = 0; k < dim; k++) v[k] = x[k] - p->point[k];
        for (size_t a = 0; a + 1 < dim; a++)
            c->s[a] = product (v, f->along[a], dim), flat += c->s[a] * c->s[a];
        flat = sqrt (flat);
        if (p->shape == PG_PLATEN_PLANE || !(flat > 0)) continue;
        double ahead = (p->concave ? -1 : 1) * product (v, mean, dim);
        if (p->shape == PG_PLATEN_CYLINDER && dim == 3) c->s[1] = p->radius * atan2 (c->s[1], ahead);
        else
            for (size_t a = 0; a + 1 < dim; a++) c->s[a] *= p->radius * atan2 (flat, ahead) / flat;
    }
}

static int compare_boxes (const void *a, const void *b)
{
    const candidate *i = a, *j = b;
    for (int k = 0; k < 2; k++) if (i->box[k] != j->box[k]) return i->box[k] < j->box[k] ? -1 : 1;
    if (i->distance != j->distance) return i->distance < j->distance ? -1 : 1;
    return (i->at > j->at) - (i->at < j->at);
}

/* Removes hidden points: those in a small box along the platen that are much farther from it than the
 * nearest. */
static void drop_hidden (facing *f)
{
    size_t kept = 0, dim = (size_t) f->p->dim;
    double least = INFINITY;
    for (size_t i = 0; i < f->n; i++)
        for (size_t a = 0; a < 2; a++)
            f->point[i].box[a] = a + 1 < dim ? lround (floor (f->point[i].s[a] / (BOX * f->p->cloud.h))) : 0;
    pg_sort (f->point, f->n, sizeof *f->point, compare_boxes);
    for (size_t i = 0; i < f->n; i++) {
        const candidate c = f->point[i];
        const long *last = kept ? f->point[kept - 1].box : NULL;
        if (!last || last[0] != c.box[0] || last[1] != c.box[1]) least = c.distance;
        if (c.distance <= least + HIDES * c.h) f->point[kept++] = c;
    }
    f->n = kept;
}

static pg_status find_points (facing *f)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) f->p->dim;
    PG_GROW (f->point, f->capacity, f->q->n);
    for (size_t i = 0; i < f->q->n; i++) {
        candidate c = { .at = i, .weight = f->q->weight[i],
                        .h = pg_problem_spacing_at (f->p, f->q->x + i * dim) };
        c.distance = pg_platen_distance (f->platen, f->p->dim, f->q->x + i * dim, c.normal);
        if (!isfinite (c.distance) || product (f->q->normal + i * dim, c.normal, dim) > -FACES) continue;
        if (fabs (c.distance) <= PG_NO_LENGTH * c.h) c.distance = 0;
        f->point[f->n++] = c;
    }
    find_directions (f);
    find_places (f);
    drop_hidden (f);
done:
    return status;
}

/* ---- pieces -------------------------------------------------------------------------------------------- */
static int compare_places (const void *a, const void *b)
{
    const candidate *i = a, *j = b;
    if (i->s[0] != j->s[0]) return i->s[0] < j->s[0] ? -1 : 1;
    return (i->at > j->at) - (i->at < j->at);
}

/* Sets box[axis] of point i at position `place` (m) along an axis with n pieces of length `each` (m). On a
 * border it is divided in halves, so that neither rounding nor direction decides. */
static pg_status put_in_piece (facing *f, size_t i, int axis, double place, double each, long n)
{
    pg_status status = PG_OK;
    long border = lround (place / each), k = (long) floor (place / each);
    f->point[i].box[axis] = k < 0 ? 0 : k < n ? k : n - 1;
    if (border <= 0 || border >= n
        || fabs (place - (double) border * each) > pg_cloud_same (&f->p->cloud)) return PG_OK;
    PG_GROW (f->point, f->capacity, f->n + 1);
    f->point[i].weight *= 0.5, f->point[i].box[axis] = border;
    f->point[f->n] = f->point[i];
    f->point[f->n++].box[axis] = border - 1;
done:
    return status;
}

/* 2D: sets the piece of each point (box[0]): equal lengths in local spacings along each connected part. */
static pg_status divide_line (facing *f)
{
    pg_status status = PG_OK;
    size_t points = f->n;                              /* halves are appended behind them */
    long pieces = 0;
    double thick = f->p->cloud.thickness;
    pg_sort (f->point, f->n, sizeof *f->point, compare_places);
    for (size_t from = 0, to; from < points; from = to) {
        double whole = 0, passed = 0;
        for (to = from; to < points; to++) {
            const candidate *c = &f->point[to];
            if (to > from && c->s[0] - c[-1].s[0] > APART * fmax (c->h, c[-1].h)) break;
            whole += c->weight / thick / c->h;
        }
        long n = (long) pieces_of (&f->p->cloud, whole, PG_CONTACT_PIECE);
        for (size_t i = from; i < to; i++) {
            double h = f->point[i].h, part = f->point[i].weight / thick / h;
            size_t half = f->n;
            PG_TRY (put_in_piece (f, i, 0, (passed + 0.5 * part) * h, whole / (double) n * h, n));
            f->point[i].box[0] += pieces;
            if (f->n > half) f->point[half].box[0] += pieces;
            passed += part;
        }
        pieces += n;
    }
done:
    return status;
}

/* 3D: assigns points to equal boxes of a grid along the platen; *boxes: their number. */
static pg_status divide_grid (facing *f, long *boxes)
{
    pg_status status = PG_OK;
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY }, h = INFINITY;
    long n[2] = { 0 };
    for (size_t i = 0; i < f->n; i++) {
        double half = 0.5 * sqrt (f->point[i].weight);
        h = fmin (h, f->point[i].h);
        for (int a = 0; a < 2; a++)
            low[a] = fmin (low[a], f->point[i].s[a] - half),
            high[a] = fmax (high[a], f->point[i].s[a] + half);
    }
    for (int a = 0; a < 2 && f->n; a++) {
        n[a] = (long) pieces_of (&f->p->cloud, (high[a] - low[a]) / h, PG_CONTACT_PIECE);
        for (size_t i = 0, points = f->n; i < points; i++)
            PG_TRY (put_in_piece (f, i, a, f->point[i].s[a] - low[a], (high[a] - low[a]) / (double) n[a],
                                  n[a]));
    }
    for (size_t i = 0; i < f->n; i++) f->point[i].box[0] += f->point[i].box[1] * n[0], f->point[i].box[1] = 0;
    *boxes = n[0] * n[1];
done:
    return status;
}

/* Area (in squares of spacings) and centroid (m) of the points in a box. */
typedef struct { double area, middle[2]; } filling;

static double between (const filling *a, const filling *b)
{
    return hypot (a->middle[0] - b->middle[0], a->middle[1] - b->middle[1]);
}

/* Returns 1: the box has less than a third of the area of a full one. */
static int is_small (const filling *box) { return box->area < PG_CONTACT_PIECE * PG_CONTACT_PIECE / 3.0; }

/* Moves point i to the large box nearest to its own, in equal parts to equally near ones. */
static pg_status move_to_nearest (facing *f, const filling *box, long boxes, size_t i)
{
    pg_status status = PG_OK;
    const candidate c = f->point[i];
    const filling *own = &box[c.box[0]];
    double least = INFINITY, same = pg_cloud_same (&f->p->cloud);
    size_t first = f->n, found = 0;
    for (long j = 0; j < boxes; j++) if (!is_small (&box[j])) least = fmin (least, between (own, &box[j]));
    for (long j = 0; j < boxes; j++) {
        if (is_small (&box[j]) || between (own, &box[j]) > least + same) continue;
        PG_GROW (f->point, f->capacity, f->n + 1);
        candidate *to = found++ ? &f->point[f->n++] : &f->point[i];
        *to = c, to->box[0] = j;
    }
    if (found) f->point[i].weight /= (double) found;
    for (size_t k = first; k < f->n; k++) f->point[k].weight /= (double) found;
done:
    return status;
}

/* Merges small boxes into others. */
static pg_status join_small (facing *f, long boxes)
{
    pg_status status = PG_OK;
    filling *box = NULL;
    PG_ALLOC (box, (size_t) boxes);
    for (size_t i = 0; i < f->n; i++) {
        const candidate *c = &f->point[i];
        double w = c->weight / (c->h * c->h);
        box[c->box[0]].area += w;
        for (int a = 0; a < 2; a++) box[c->box[0]].middle[a] += w * c->s[a];
    }
    for (long k = 0; k < boxes; k++)
        for (int a = 0; a < 2 && box[k].area > 0; a++) box[k].middle[a] /= box[k].area;
    for (size_t i = 0, points = f->n; i < points; i++)
        if (is_small (&box[f->point[i].box[0]])) PG_TRY (move_to_nearest (f, box, boxes, i));
done:
    pg_free (box);
    return status;
}

static int compare_pieces (const void *a, const void *b)
{
    const candidate *i = a, *j = b;
    if (i->box[0] != j->box[0]) return i->box[0] < j->box[0] ? -1 : 1;
    return (i->at > j->at) - (i->at < j->at);
}

/* Completes a piece: centroid, mean normal, tangents, area, mean gap. */
static void end_piece (pg_contact_pieces *out, const facing *f, double *gap, double weight)
{
    size_t dim = out->dim;
    pg_contact_piece *k = &out->piece[out->n];
    double size = sqrt (product (k->normal, k->normal, dim));
    if (!(weight > 0) || !(size > 0)) return;
    for (size_t m = 0; m < dim; m++) k->x[m] /= weight, k->normal[m] /= size;
    tangents (k->normal, f->along[0], dim, k->tangent);
    k->area = weight, k->arc /= weight, gap[out->n] /= weight;
    k->length = dim == 2 ? weight / f->p->cloud.thickness : sqrt (weight);
    out->first[++out->n] = out->npoint;
}

/* Copies the points, sorted by pieces, into the arrays of `out`. */
static pg_status collect (facing *f, pg_contact_pieces *out, double **gap)
{
    pg_status status = PG_OK;
    size_t dim = out->dim, pieces = 0;
    double weight = 0;
    for (size_t i = 0; i < f->n; i++) pieces += i == 0 || f->point[i].box[0] != f->point[i - 1].box[0];
    PG_ALLOC (out->piece, pieces + 1);
    PG_ALLOC (out->first, pieces + 2);
    PG_ALLOC (out->x, f->n * dim);
    PG_ALLOC (out->normal, f->n * dim);
    PG_ALLOC (out->tangent, f->n * dim * (dim - 1));
    PG_ALLOC (out->weight, f->n);
    PG_ALLOC (*gap, pieces + 1);
    for (size_t i = 0; i < f->n; i++) {
        const candidate *c = &f->point[i];
        if (i && c->box[0] != f->point[i - 1].box[0]) end_piece (out, f, *gap, weight), weight = 0;
        pg_contact_piece *k = &out->piece[out->n];
        double w = c->weight, t[2][3];
        size_t q = out->npoint++;
        tangents (c->normal, f->along[0], dim, t);
        memcpy (out->x + q * dim, f->q->x + c->at * dim, dim * sizeof *out->x);
        memcpy (out->normal + q * dim, c->normal, dim * sizeof *out->x);
        for (size_t a = 0; a + 1 < dim; a++)
            memcpy (out->tangent + (q * (dim - 1) + a) * dim, t[a], dim * sizeof *out->x);
        out->weight[q] = w, weight += w;
        for (size_t m = 0; m < dim; m++) k->x[m] += w * out->x[q * dim + m], k->normal[m] += w * c->normal[m];
        k->arc += w * c->s[0], (*gap)[out->n] += w * c->distance;
    }
    end_piece (out, f, *gap, weight);
done:
    return status;
}

pg_status pg_platen_pieces_create (pg_contact_pieces *out, double **gap, const pg_problem *p, size_t platen)
{
    pg_status status = PG_OK;
    pg_quadrature q = { 0 };
    facing f = { .p = p, .platen = &p->boundary.platen[platen], .q = &q };
    long boxes = 0;
    memset (out, 0, sizeof *out);
    *gap = NULL;
    out->dim = (size_t) p->dim;
    PG_TRY (pg_facet_points (&q, &p->cells, p->bonds.facet_order));
    PG_TRY (find_points (&f));
    if (p->dim == 2) PG_TRY (divide_line (&f));
    else {
        PG_TRY (divide_grid (&f, &boxes));
        PG_TRY (join_small (&f, boxes));
    }
    pg_sort (f.point, f.n, sizeof *f.point, compare_pieces);
    PG_TRY (collect (&f, out, gap));
    for (size_t k = 0; k < out->n; k++) out->piece[k].platen = platen + 1;
done:
    pg_free (f.point);
    pg_quadrature_clear (&q);
    if (status != PG_OK) {
        pg_contact_pieces_clear (out);
        pg_free (*gap), *gap = NULL;
    }
    return status;
}

void pg_platen_row (const pg_contact_pieces *pieces, size_t k, const double *about, double *row)
{
    size_t dim = pieces->dim;
    double whole = 0;
    memset (row, 0, 6 * dim * sizeof *row);
    for (size_t q = pieces->first[k]; q < pieces->first[k + 1]; q++) {
        double w = pieces->weight[q], r[3] = { 0 };
        whole += w;
        for (size_t m = 0; m < dim; m++) r[m] = pieces->x[q * dim + m] - about[m];
        for (size_t a = 0; a < dim; a++) {
            const double *e = a ? pieces->tangent + (q * (dim - 1) + a - 1) * dim : pieces->normal + q * dim;
            double to[3] = { e[0], e[1], dim == 3 ? e[2] : 0 };
            for (int m = 0; m < 3; m++) {
                row[6 * a + (size_t) m] -= w * to[m];
                row[6 * a + 3 + (size_t) m] -= w * (r[(m + 1) % 3] * to[(m + 2) % 3]
                                                    - r[(m + 2) % 3] * to[(m + 1) % 3]);
            }
        }
    }
    for (size_t i = 0; i < 6 * dim; i++) row[i] /= whole;
}
