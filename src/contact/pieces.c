/* SPDX-License-Identifier: GPL-3.0-or-later
 * Divides cracks into pieces of about two spacings, and computes the rows of their mean gaps and slips.
 *
 * Straight segments of cracks that meet end to end, and turn by less than half a radian there, form a path;
 * the part of it that cuts bonds (not just behind tips: mechanics/model/pre_crack_tips.c) is divided into
 * pieces of equal length in local spacings. A piece is sampled at points, eight per spacing, in the middle of
 * equal parts; points outside the body are ignored. With weights w_q = length of the part times thickness,
 *
 *     g_n = sum_q w_q n_q . [u]_q / sum_q w_q,    g_t the same with t_q,    t = (n_y, -n_x),
 *
 * [u] = u (left) - u (right) by one-sided shape functions (surfaces.jump of the force). */
#include "pieces.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A crack meets another one if it ends within MEETS spacings of it, unless they are nearly parallel (sine of
 * their angle below ALONG). */
static const double MEETS = 1e-3, ALONG = 1e-3;

/* A straight part of a path, at most a spacing long, m; h: local spacing, m; met (first link of a path): bits
 * 1, 2: the path begins, ends where cracks meet. */
typedef struct { double from[2], to[2], length, h; size_t path; int met; } link;
/* The part of a crack segment that cuts bonds. whole: 1: the end reaches the vertex and may be joined to
 * others; met: 1: cracks meet at that end. */
typedef struct { double end[2][2]; int whole[2], met[2], used; } segment;
typedef struct {
    const pg_problem *p;
    double nothing;                                    /* positions no further apart are equal, m */
    segment *segment;  size_t nsegment;
    link *link;  size_t nlink, cap_link;
    size_t cap_x, cap_normal, cap_tangent, cap_weight, cap_piece, cap_first;
} division;

/* ---- segments and paths -------------------------------------------------------------------------------- */
static pg_status take_segments (division *d, const pg_cracks *cracks)
{
    pg_status status = PG_OK;
    PG_ALLOC (d->segment, cracks->n);
    for (size_t k = 0; k < cracks->n; k++) {
        const pg_crack *c = &cracks->crack[k];
        segment *s = &d->segment[d->nsegment];
        if (c->kind != PG_CRACK_SEGMENT) continue;
        const double *a = c->vertex, *b = a + 2;
        double length = hypot (b[0] - a[0], b[1] - a[1]), cut[2] = { 0, 0 };
        for (int e = 0; e < 2; e++) cut[e] = c->retreat ? fmax (0, c->retreat[e]) : 0;
        if (!(length - cut[0] - cut[1] > d->nothing)) continue;
        for (int m = 0; m < 2; m++) {
            double t = (b[m] - a[m]) / length;
            s->end[0][m] = a[m] + cut[0] * t, s->end[1][m] = b[m] - cut[1] * t;
        }
        s->whole[0] = cut[0] <= d->nothing, s->whole[1] = cut[1] <= d->nothing, s->used = 0;
        d->nsegment++;
    }
done:
    return status;
}

/* Position at which segment j meets segment k between its ends, as a fraction of the length of k; NAN: it
 * does not. */
static double met_at (const division *d, size_t k, size_t j)
{
    const segment *s = &d->segment[k], *o = &d->segment[j];
    double u[2], v[2], w[2];
    for (int m = 0; m < 2; m++)
        u[m] = s->end[1][m] - s->end[0][m], v[m] = o->end[1][m] - o->end[0][m],
        w[m] = o->end[0][m] - s->end[0][m];
    double length = hypot (u[0], u[1]), across = u[0] * v[1] - u[1] * v[0],
           other = hypot (v[0], v[1]), near = MEETS * d->p->cloud.h / other;
    if (!(fabs (across) > ALONG * length * other)) return NAN;
    double share = (w[0] * v[1] - w[1] * v[0]) / across, by = (w[0] * u[1] - w[1] * u[0]) / across;
    return share > 0 && share < 1 && by >= -near && by <= 1 + near ? share : NAN;
}

/* Returns 1: the segment ends on another one, between the ends of that. */
static int ends_on_another (const division *d, const segment *s, int end)
{
    for (size_t k = 0; k < d->nsegment; k++) {
        const segment *o = &d->segment[k];
        double u[2], w[2];
        for (int m = 0; m < 2; m++) u[m] = o->end[1][m] - o->end[0][m], w[m] = s->end[end][m] - o->end[0][m];
        double length = hypot (u[0], u[1]), near = MEETS * d->p->cloud.h,
               along = (u[0] * w[0] + u[1] * w[1]) / length, off = fabs (u[0] * w[1] - u[1] * w[0]) / length;
        if (off <= near && along > near && along < length - near) return 1;
    }
    return 0;
}

/* Splits segments where others meet them, as the two parts of the face that is met move independently and no
 * piece may extend across. Parts shorter than half a spacing are not split off. */
static pg_status split_segments (division *d)
{
    pg_status status = PG_OK;
    segment *all = NULL;
    double *share = NULL;
    size_t n = 0, cap = 0;
    PG_ALLOC (share, d->nsegment + 1);
    for (size_t k = 0; k < d->nsegment; k++) {
        segment rest = d->segment[k];
        size_t met = 0;
        double from[2], u[2], x[3] = { 0 };
        for (size_t j = 0; j < d->nsegment; j++) {
            share[met] = j == k ? NAN : met_at (d, k, j);
            met += isfinite (share[met]) != 0;
        }
        pg_sort (share, met, sizeof *share, pg_ascending_numbers);
        for (int m = 0; m < 2; m++) from[m] = rest.end[0][m], u[m] = rest.end[1][m] - from[m];
        PG_GROW (all, cap, n + met + 1);
        for (size_t i = 0; i < met; i++) {
            for (int m = 0; m < 2; m++) x[m] = from[m] + share[i] * u[m];
            double least = 0.5 * pg_problem_spacing_at (d->p, x);
            if (hypot (x[0] - rest.end[0][0], x[1] - rest.end[0][1]) < least
                || hypot (rest.end[1][0] - x[0], rest.end[1][1] - x[1]) < least) continue;
            all[n] = rest, all[n].whole[1] = rest.whole[0] = 0, all[n].met[1] = rest.met[0] = 1;
            for (int m = 0; m < 2; m++) all[n].end[1][m] = rest.end[0][m] = x[m];
            n++;
        }
        all[n++] = rest;
    }
    for (size_t k = 0; k < n; k++)
        for (int e = 0; e < 2; e++) all[k].met[e] |= ends_on_another (d, &all[k], e);
    pg_free (d->segment);
    d->segment = all, d->nsegment = n, all = NULL;
done:
    pg_free (all), pg_free (share);
    return status;
}

/* Segment that continues segment k beyond its end `end`; *begins: its end that lies there. SIZE_MAX: none or
 * several, or the turn is too sharp. */
static size_t next_of (const division *d, size_t k, int end, int *begins)
{
    const segment *s = &d->segment[k];
    size_t found = SIZE_MAX;
    if (!s->whole[end]) return SIZE_MAX;
    for (size_t j = 0; j < d->nsegment; j++)
        for (int e = 0; e < 2; e++) {
            const segment *o = &d->segment[j];
            if (j == k || !o->whole[e]
                || hypot (o->end[e][0] - s->end[end][0], o->end[e][1] - s->end[end][1]) > d->nothing)
                continue;
            if (found != SIZE_MAX) return SIZE_MAX;
            found = j, *begins = e;
        }
    if (found == SIZE_MAX) return SIZE_MAX;
    const segment *o = &d->segment[found];
    double u[2], v[2];
    for (int m = 0; m < 2; m++)
        u[m] = s->end[end][m] - s->end[1 - end][m], v[m] = o->end[1 - *begins][m] - o->end[*begins][m];
    double turn = atan2 (u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
    return fabs (turn) > PG_CONTACT_TURN ? SIZE_MAX : found;
}

/* Consistent integration: appends one link per interval by which cells cut off at the crack integrate over
 * its faces. */
static pg_status add_intervals (division *d, const double *a, const double *b, size_t path)
{
    pg_status status = PG_OK;
    double *share = NULL, length = hypot (b[0] - a[0], b[1] - a[1]);
    size_t n = 0;
    PG_TRY (pg_crack_breaks (d->p, a, b, &n, &share));
    for (size_t k = 0; k + 1 < n; k++) {
        double s = share[k], t = share[k + 1], middle[3] = { 0 };
        for (int m = 0; m < 2; m++) middle[m] = a[m] + 0.5 * (s + t) * (b[m] - a[m]);
        double h = pg_problem_spacing_at (d->p, middle);
        size_t parts = pg_crack_intervals ((t - s) * length, h);
        PG_GROW (d->link, d->cap_link, d->nlink + parts);
        for (size_t i = 0; i < parts; i++) {
            link *l = &d->link[d->nlink++];
            double u = s + (double)i / (double)parts * (t - s),
                   v = s + (double)(i + 1) / (double)parts * (t - s);
            for (int m = 0; m < 2; m++)
                l->from[m] = a[m] + u * (b[m] - a[m]), l->to[m] = a[m] + v * (b[m] - a[m]);
            l->length = (v - u) * length, l->h = h, l->path = path, l->met = 0;
        }
    }
done:
    pg_free (share);
    return status;
}

/* Appends the links of a segment, starting at its end `begins`. */
static pg_status add_links (division *d, size_t k, int begins, size_t path)
{
    pg_status status = PG_OK;
    const segment *s = &d->segment[k];
    const double *a = s->end[begins], *b = s->end[1 - begins];
    double length = hypot (b[0] - a[0], b[1] - a[1]), least = INFINITY;
    if (d->p->form.consistency) return add_intervals (d, a, b, path);
    for (int i = 0; i <= 8; i++) {
        double x[3] = { a[0] + i / 8.0 * (b[0] - a[0]), a[1] + i / 8.0 * (b[1] - a[1]), 0 };
        least = fmin (least, pg_problem_spacing_at (d->p, x));
    }
    size_t parts = d->p->cloud.size ? pg_cloud_pieces (&d->p->cloud, length, least) : 1;
    PG_GROW (d->link, d->cap_link, d->nlink + parts);
    for (size_t i = 0; i < parts; i++) {
        link *l = &d->link[d->nlink++];
        double middle[3] = { 0 };
        for (int m = 0; m < 2; m++) {
            l->from[m] = a[m] + (double) i / (double) parts * (b[m] - a[m]);
            l->to[m] = i + 1 == parts ? b[m] : a[m] + (double) (i + 1) / (double) parts * (b[m] - a[m]);
            middle[m] = 0.5 * (l->from[m] + l->to[m]);
        }
        l->length = length / (double) parts, l->h = pg_problem_spacing_at (d->p, middle), l->path = path;
        l->met = 0;
    }
done:
    return status;
}

/* Finds the paths: from every free end, then around closed loops. */
static pg_status find_paths (division *d)
{
    pg_status status = PG_OK;
    size_t paths = 0;
    for (int closed = 0; closed < 2; closed++)
        for (size_t k = 0; k < d->nsegment; k++)
            for (int e = 0; e < 2; e++) {
                int begins = e, unused;
                if (d->segment[k].used || (!closed && next_of (d, k, e, &unused) != SIZE_MAX)) continue;
                size_t first = d->nlink;
                int met = d->segment[k].met[e];
                for (size_t at = k; at != SIZE_MAX && !d->segment[at].used;) {
                    d->segment[at].used = 1;
                    PG_TRY (add_links (d, at, begins, paths));
                    met = (met & 1) | 2 * d->segment[at].met[1 - begins];
                    at = next_of (d, at, 1 - begins, &begins);
                }
                if (d->nlink > first) d->link[first].met = met;
                paths++;
            }
done:
    return status;
}

/* ---- pieces -------------------------------------------------------------------------------------------- */
/* Appends the sampling points of the part u .. v (fractions) of a link to the current piece. */
static pg_status add_points (division *d, pg_contact_pieces *out, const link *l, double u, double v)
{
    pg_status status = PG_OK;
    double t[2], size = (v - u) * l->length;
    size_t count = d->p->form.consistency ? 1 : pg_crack_intervals (size, l->h);
    pg_contact_piece *piece = &out->piece[out->n];
    for (int m = 0; m < 2; m++) t[m] = (l->to[m] - l->from[m]) / l->length;
    PG_GROW (out->x, d->cap_x, 2 * (out->npoint + count));
    PG_GROW (out->normal, d->cap_normal, 2 * (out->npoint + count));
    PG_GROW (out->tangent, d->cap_tangent, 2 * (out->npoint + count));
    PG_GROW (out->weight, d->cap_weight, out->npoint + count);
    for (size_t i = 0; i < count; i++) {
        double s = u + ((double) i + 0.5) / (double) count * (v - u), x[3] = { 0 };
        for (int m = 0; m < 2; m++) x[m] = l->from[m] + s * (l->to[m] - l->from[m]);
        if (!pg_problem_has_body (d->p, x)) continue;
        double part = size / (double) count, *n = out->normal + 2 * out->npoint,
               *along = out->tangent + 2 * out->npoint;
        memcpy (out->x + 2 * out->npoint, x, 2 * sizeof *x);
        n[0] = -t[1], n[1] = t[0], along[0] = n[1], along[1] = -n[0];
        out->weight[out->npoint++] = part * d->p->cloud.thickness;
        piece->length += part, piece->area += part * d->p->cloud.thickness;
        for (int m = 0; m < 2; m++) piece->x[m] += part * x[m], piece->normal[m] += part * n[m];
    }
done:
    return status;
}

/* Completes the current piece, if it has points. */
static void end_piece (pg_contact_pieces *out)
{
    pg_contact_piece *k = &out->piece[out->n];
    double size = hypot (k->normal[0], k->normal[1]);
    if (out->npoint == out->first[out->n] || !(size > 0)) return;
    for (int m = 0; m < 2; m++) k->x[m] /= k->length, k->normal[m] /= size;
    k->tangent[0][0] = k->normal[1], k->tangent[0][1] = -k->normal[0];
    out->first[++out->n] = out->npoint;
}

/* End of piece `at` of a path, in units of a full piece; at ends where cracks meet (bits of met) the
 * outermost piece is divided into two halves. */
static double end_of (size_t at, size_t pieces, int met)
{
    size_t first = met & 1, last = met >> 1 && (pieces > 1 || !first);
    if (first && at == 0) return 0.5;
    if (last && at == pieces + first - 1) return (double) pieces - 0.5;
    return fmin ((double) (at + 1 - first), (double) pieces);
}

size_t pieces_of (const pg_cloud *cloud, double size, double full)
{
    return pg_cloud_pieces (cloud, (size - 0.5 * full) * cloud->h, full * cloud->h);
}

/* Divides the links from .. to - 1 of one path into pieces of equal length in local spacings. Where cracks
 * meet, the body between them can rotate, so that mean gaps do not prevent overlap at the ends of pieces:
 * there pieces are half as long. */
static pg_status divide (division *d, pg_contact_pieces *out, size_t from, size_t to)
{
    pg_status status = PG_OK;
    double whole = 0, passed = 0, arc = 0, same = pg_cloud_same (&d->p->cloud);
    for (size_t i = from; i < to; i++) whole += d->link[i].length / d->link[i].h;
    size_t even = pieces_of (&d->p->cloud, whole, PG_CONTACT_PIECE), at = 0;
    int met = whole > PG_CONTACT_HALVED ? d->link[from].met : 0;
    size_t pieces = even + (size_t) (met & 1) + (size_t) (met >> 1 && (even > 1 || !(met & 1)));
    double each = whole / (double) even, begins = 0;
    PG_GROW (out->piece, d->cap_piece, out->n + pieces + 1);
    PG_GROW (out->first, d->cap_first, out->n + pieces + 2);
    memset (&out->piece[out->n], 0, sizeof *out->piece), out->piece[out->n].path = d->link[from].path;
    for (size_t i = from; i < to; i++) {
        const link *l = &d->link[i];
        double size = l->length / l->h, u = 0;
        while (u < 1) {
            double goal = end_of (at, even, met) * each, v = (goal - passed) / size;
            int ends = at + 1 < pieces && v < (d->p->form.consistency ? 1.5 : 1) + same / l->length;
            if (!ends || v > 1 || d->p->form.consistency) v = 1;        /* intervals are not divided */
            PG_TRY (add_points (d, out, l, u, v));
            if (ends) {
                out->piece[out->n].arc = 0.5 * (begins + arc + v * l->length), begins = arc + v * l->length;
                end_piece (out), at++;
                memset (&out->piece[out->n], 0, sizeof *out->piece), out->piece[out->n].path = l->path;
            }
            u = v;
        }
        passed += size, arc += l->length;
    }
    out->piece[out->n].arc = 0.5 * (begins + arc);
    end_piece (out);
done:
    return status;
}

pg_status pg_contact_pieces_create (pg_contact_pieces *out, const pg_problem *p, const pg_state *state)
{
    pg_status status = PG_OK;
    division d = { .p = p, .nothing = PG_NO_LENGTH * p->cloud.h };
    memset (out, 0, sizeof *out);
    out->dim = p->dim == 3 ? 3 : 2;
    PG_GROW (out->first, d.cap_first, 1);
    if (p->dim == 3) {
        PG_TRY (surface_pieces_create (out, p, state));
        out->nknown = out->n;
        goto done;
    }
    PG_TRY (take_segments (&d, pg_state_cracks (p, state)));
    PG_TRY (split_segments (&d));
    PG_TRY (find_paths (&d));
    for (size_t from = 0, to; from < d.nlink; from = to) {
        for (to = from; to < d.nlink && d.link[to].path == d.link[from].path; to++) continue;
        PG_TRY (divide (&d, out, from, to));
    }
    out->nknown = out->n;
done:
    pg_free (d.segment), pg_free (d.link);
    if (status != PG_OK) pg_contact_pieces_clear (out);
    return status;
}

void pg_contact_pieces_clear (pg_contact_pieces *k)
{
    pg_free (k->piece), pg_free (k->first);
    pg_free (k->x), pg_free (k->normal), pg_free (k->tangent), pg_free (k->weight);
    pg_free (k->broken), pg_free (k->place);
    memset (k, 0, sizeof *k);
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
/* Adds the points of piece k to its dense rows: row a, unknown c of node j at row[(a n + j) dim + c]. list
 * (*count): affected nodes, each once. Returns the weight of points with values, m^2. */
static double gather (const pg_contact_pieces *pieces, const pg_jump_rows *jump, size_t k, size_t n,
                      double *row, unsigned char *seen, int *list, size_t *count)
{
    double sum = 0;
    size_t d = pieces->dim;
    *count = 0;
    for (size_t q = pieces->first[k]; q < pieces->first[k + 1]; q++) {
        double w = pieces->weight[q];
        int any = 0;
        for (size_t e = jump->start[q]; e < jump->start[q + 1]; e++) {
            size_t j = (size_t) jump->node[e];
            if (jump->value[e] == 0) continue;
            any = 1;
            if (!seen[j]) seen[j] = 1, list[(*count)++] = (int) j;
            for (size_t a = 0; a < d; a++) {
                const double *to = a ? pieces->tangent + ((d - 1) * q + a - 1) * d : pieces->normal + d*q;
                for (size_t c = 0; c < d; c++) row[(a*n + j) * d + c] += w * to[c] * jump->value[e];
            }
        }
        if (any) sum += w;
    }
    return sum;
}

static int compare_nodes (const void *a, const void *b)
{
    int i = *(const int *) a, j = *(const int *) b;
    return (i > j) - (i < j);
}

/* Writes a dense row, divided by the weight, as a sparse column of the listed nodes, and zeroes it for the
 * next piece. */
static void put_column (pg_sparse *out, size_t column, size_t dim, const int *list, size_t count,
                        double weight, double *row)
{
    long at = out->start[column];
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < dim; c++) {
            size_t unknown = dim * (size_t) list[i] + c;
            out->row[at] = (long) unknown, out->value[at++] = row[unknown] / weight;
            row[unknown] = 0;
        }
    out->start[column + 1] = at;
}

pg_status pg_contact_rows_of (pg_sparse *out, const pg_contact_pieces *pieces, const pg_problem *p,
                              const pg_jump_rows *jump)
{
    pg_status status = PG_OK;
    size_t n = p->cloud.n, d = pieces->dim, count, most = 0;
    double *row = NULL;
    unsigned char *seen = NULL;
    int *list = NULL;
    memset (out, 0, sizeof *out);
    for (size_t e = 0; e < jump->start[jump->n]; e++) most += jump->value[e] != 0;
    PG_TRY (pg_sparse_create (out, d * n, d * pieces->n, d * d * most, 0));
    PG_ALLOC (row, d * d * n);
    PG_ALLOC (seen, n);
    PG_ALLOC (list, n);
    for (size_t k = 0; k < pieces->n; k++) {
        double weight = gather (pieces, jump, k, n, row, seen, list, &count);
        char third[32] = "";
        if (d == 3) snprintf (third, sizeof third, ", %.6g", pieces->piece[k].x[2]);
        /* where single bonds break, faces may disintegrate: no contact then */
        if (!(weight > 0) && !pg_criterion_of_bonds (p->criterion))
            PG_FAIL (PG_E_USAGE,
                     "within %g spacings of (%.6g, %.6g%s) m the body sees too little on one side "
                     "of the surface for a gap: take a smaller spacing, or keep cracks and surfaces further "
                     "apart",
                     PG_CONTACT_RADIUS, pieces->piece[k].x[0], pieces->piece[k].x[1], third);
        pg_sort (list, count, sizeof *list, compare_nodes);
        for (size_t a = 0; a < d; a++)
            put_column (out, d*k + a, d, list, count, weight, row + a * d * n);
        for (size_t i = 0; i < count; i++) seen[list[i]] = 0;
    }
done:
    pg_free (row), pg_free (seen), pg_free (list);
    if (status != PG_OK) pg_sparse_clear (out);
    return status;
}

/* Counts sampling points without values: number, fraction of the area, position of the first. */
static pg_contact_blind blind_of (const pg_contact_pieces *pieces, const pg_jump_rows *jump)
{
    pg_contact_blind out = { 0 };
    double all = 0;
    for (size_t q = 0; q < pieces->npoint; q++) {
        int any = 0;
        for (size_t e = jump->start[q]; e < jump->start[q + 1]; e++) any |= jump->value[e] != 0;
        all += pieces->weight[q];
        if (any) continue;
        for (size_t k = 0; k < pieces->dim && !out.n; k++) out.x[k] = pieces->x[pieces->dim * q + k];
        out.n++, out.share += pieces->weight[q];
    }
    if (all > 0) out.share /= all;
    return out;
}

pg_status pg_contact_rows (pg_sparse *out, const pg_contact_pieces *pieces, const pg_problem *p,
                           const pg_force_type *force, void *self, const pg_state *state,
                           pg_contact_blind *blind)
{
    pg_status status = PG_OK;
    pg_jump_rows jump = { 0 };
    memset (out, 0, sizeof *out);
    if (!force->surfaces.jump)
        PG_FAIL (PG_E_USAGE, "contact of crack faces is known of forces that show the jump of the "
                             "displacement across a crack");
    PG_TRY (force->surfaces.jump (self, state, pieces->npoint, pieces->x, pieces->normal, PG_CONTACT_RADIUS,
                                  &jump));
    *blind = blind_of (pieces, &jump);
    PG_TRY (pg_contact_rows_of (out, pieces, p, &jump));
done:
    pg_jump_rows_clear (&jump);
    return status;
}

pg_status pg_contact_overlap (double *overlap, const pg_contact_pieces *k, const pg_force_type *force,
                              void *self, const pg_state *state, const double *d)
{
    pg_status status = PG_OK;
    pg_jump_rows jump = { 0 };
    size_t dim = k->dim, unknowns = 0;
    pg_field field[4];
    *overlap = 0;
    if (!k->npoint) return PG_OK;
    size_t fields = force->fields (self, 4, field);
    for (size_t i = 0; i < fields; i++) unknowns += (size_t) field[i].components;
    PG_TRY (force->surfaces.jump (self, state, k->npoint, k->x, k->normal, PG_CONTACT_RADIUS, &jump));
    for (size_t q = 0; q < k->npoint; q++) {
        double gap = 0;
        for (size_t e = jump.start[q]; e < jump.start[q + 1]; e++)
            for (size_t c = 0; c < dim; c++)
                gap += k->normal[dim * q + c] * jump.value[e] * d[unknowns * (size_t) jump.node[e] + c];
        *overlap = fmax (*overlap, -gap);
    }
done:
    pg_jump_rows_clear (&jump);
    return status;
}
