/* SPDX-License-Identifier: GPL-3.0-or-later
 * Connected parts of the body, and their rigid motions that neither prescribed displacements nor springs
 * resist. */
#include "body_parts.h"
#include "perigal/ranks.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A motion counts as held where supports resist it by more than this share of the largest resistance: two
 * supports side by side hold a rotation by the square of their distance over the size of the part. */
static const double HELD = 1e-9;

void body_parts_clear (body_parts *parts)
{
    pg_free (parts->part), pg_free (parts->of);
    memset (parts, 0, sizeof *parts);
}

/* u: displacement of the point at x by the rigid motion m of its part, m. */
static void move_by (const body_part *part, int dim, const double *x, const double *m, double *u)
{
    double r[3] = { 0 }, size = part->size > 0 ? part->size : 1;
    for (int k = 0; k < dim; k++) r[k] = (x[k] - part->middle[k]) / size;
    for (int k = 0; k < 3; k++)
        u[k] = m[k] + m[3 + (k + 1) % 3] * r[(k + 2) % 3] - m[3 + (k + 2) % 3] * r[(k + 1) % 3];
}

void body_part_shift (const pg_system *s, const body_part *part, const double *x, const double *m, double *u)
{
    int dim = s->problem->dim;
    move_by (part, dim, x, m, u);
    for (int k = dim; k < s->components; k++)
        u[k] = m[dim == 2 ? 5 : k] * s->problem->cloud.h / part->size;
}

void body_part_place (const pg_problem *p, const body_part *part, char *text, size_t size)
{
    double all = (double) pg_cloud_total (&p->cloud);
    size_t used = (size_t) snprintf (text, size, "%zu of its %.0f points, around (%.6g", part->points, all,
                                     part->middle[0]);
    for (int k = 1; k < p->dim && used < size; k++)
        used += (size_t) snprintf (text + used, size - used, ", %.6g", part->middle[k]);
    if (used < size) snprintf (text + used, size - used, ") m");
}

/* "(x, y, z)" of as many components as the body has. */
static size_t write_vector (int dim, const double *x, char *text, size_t size)
{
    size_t used = 0;
    for (int k = 0; k < dim && used < size; k++)
        used += (size_t) snprintf (text + used, size - used, "%s%.4g%s", k ? ", " : "(",
                                   fabs (x[k]) < 1e-12 ? 0 : x[k], k + 1 == dim ? ")" : "");
    return used;
}

void body_part_way (const pg_problem *p, const body_part *part, const double *m, char *text, size_t size)
{
    double turn[3], square = 0, place[3] = { 0 };
    for (int k = 0; k < 3; k++)
        turn[k] = m[3 + k] / (part->size > 0 ? part->size : 1), square += turn[k] * turn[k];
    size_t used;
    if (!(square * part->size * part->size > 1e-12)) {
        used = (size_t) snprintf (text, size, "along ");
        write_vector (p->dim, m, text + used, size - used);
        return;
    }
    for (int k = 0; k < 3; k++)                        /* a point on the axis of rotation */
        place[k] = part->middle[k]
                   + (turn[(k + 1) % 3] * m[(k + 2) % 3] - turn[(k + 2) % 3] * m[(k + 1) % 3]) / square;
    for (int k = 0; k < 3; k++) turn[k] /= sqrt (square);
    used = (size_t) snprintf (text, size, "about %s", p->dim == 2 ? "z" : "");
    if (p->dim == 3) used += write_vector (3, turn, text + used, size - used);
    used += (size_t) snprintf (text + used, size - used, " through ");
    used += write_vector (p->dim, place, text + used, size - used);
    snprintf (text + used, size - used, " m");
}

/* ---- parts --------------------------------------------------------------------------------------------- */
/* Finds the number of the part of every point, by labels that all ranks agree on. */
static pg_status number_points (body_parts *out, const pg_system *s)
{
    pg_status status = PG_OK;
    const pg_cloud *cloud = &s->problem->cloud;
    size_t n = cloud->n, own = 0;
    int *parent = NULL;
    double *label = NULL, *mine = NULL, *all = NULL;
    PG_ALLOC (out->of, n);
    PG_ALLOC (parent, n);
    PG_ALLOC (label, n);
    PG_ALLOC (mine, n);
    s->force->join (s->self, parent);
    PG_TRY (pg_subdomain_label (cloud->subdomain, n, 1, parent, label));
    for (size_t i = 0; i < n; i++)
        if (pg_cloud_owns (cloud, i) && label[i] == (double) pg_cloud_number (cloud, i))
            mine[own++] = label[i];
    PG_TRY (pg_ranks_share (own, mine, &out->n, &all));
    pg_sort (all, out->n, sizeof *all, pg_ascending_numbers);
    PG_ALLOC (out->part, out->n);
    for (size_t i = 0; i < n; i++) {
        const double *at = pg_search (&label[i], all, out->n, sizeof *all, pg_ascending_numbers);
        out->of[i] = at ? (int) (at - all) : 0;
    }
done:
    pg_free (parent), pg_free (label), pg_free (mine), pg_free (all);
    return status;
}

/* Points, middle and size of every part, over all ranks. */
static pg_status measure (body_parts *out, const pg_problem *p)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) p->dim;
    double *sum = NULL, *most = NULL;
    PG_ALLOC (sum, 4 * out->n);
    PG_ALLOC (most, out->n);
    for (size_t i = 0; i < p->cloud.n; i++) {
        double *to = sum + 4 * (size_t) out->of[i];
        if (!pg_cloud_owns (&p->cloud, i)) continue;
        to[3]++;
        for (size_t k = 0; k < dim; k++) to[k] += p->cloud.x[i * dim + k];
    }
    PG_TRY (pg_ranks_sum (4 * out->n, sum));
    for (size_t r = 0; r < out->n; r++) {
        out->part[r].points = (size_t) sum[4 * r + 3];
        for (size_t k = 0; k < dim; k++) out->part[r].middle[k] = sum[4 * r + k] / fmax (1, sum[4 * r + 3]);
    }
    for (size_t i = 0; i < p->cloud.n; i++) {
        const double *middle = out->part[out->of[i]].middle, *x = p->cloud.x + i * dim;
        double square = 0;
        if (!pg_cloud_owns (&p->cloud, i)) continue;
        for (size_t k = 0; k < dim; k++) square += (x[k] - middle[k]) * (x[k] - middle[k]);
        most[out->of[i]] = fmax (most[out->of[i]], sqrt (square));
    }
    PG_TRY (pg_ranks_most (out->n, most));
    for (size_t r = 0; r < out->n; r++) out->part[r].size = most[r] > 0 ? most[r] : p->cloud.h;
done:
    pg_free (sum), pg_free (most);
    return status;
}

/* ---- motions ------------------------------------------------------------------------------------------- */
/* Which of the six numbers a motion has, by the dimension of the body. */
static const int line[1] = { 0 }, plane[3] = { 0, 1, 5 }, space[6] = { 0, 1, 2, 3, 4, 5 };
enum { MOST = 6, SQUARES = MOST * MOST };
static size_t numbers_of (int dim, const int **which)
{
    *which = dim == 1 ? line : dim == 2 ? plane : space;
    return dim == 1 ? 1 : dim == 2 ? 3 : 6;
}

/* Does a load resist motion along its component k? */
static int resists (const pg_load *load, int k)
{
    return load->kind == PG_SPRING ? load->stiffness[k] > 0 : pg_load_prescribes (load) && load->value[k];
}

/* Adds the resistance of a load at a point: A (n x n) += products of the displacements by each two motions,
 * in its direction. A prescribed rotation of rotational unknowns resists rotations of the part. */
static void resist (const body_part *part, int dim, const pg_load *load, const double *x, double *A)
{
    const int *which;
    size_t n = numbers_of (dim, &which);
    int turns = pg_load_rotates (load), count = pg_load_components (load, dim);
    for (int k = 0; k < count; k++) {
        double row[MOST];
        if (!resists (load, k)) continue;
        for (size_t a = 0; a < n; a++) {
            rigid_motion m = { 0 };
            double u[3];
            m[which[a]] = 1;
            move_by (part, dim, x, m, u);
            row[a] = turns ? m[dim == 2 ? 5 : 3 + k] : u[k];
        }
        for (size_t a = 0; a < n; a++) for (size_t b = 0; b < n; b++) A[a * n + b] += row[a] * row[b];
    }
}

/* A motion moves nothing where its sum of squares is less than this share of the largest. */
static const double STILL = 1e-12;

/* Counts motions that move no unknown as held: the rotation of a line of points about itself, all of a single
 * point, unless points have rotational unknowns. moved: n x n, products of displacements; A: resistance. */
static void hold_still_motions (const pg_system *s, body_part *part, double *moved, double *A)
{
    const int *which;
    size_t n = numbers_of (s->problem->dim, &which), still = 0, last = 0;
    double value[MOST], V[SQUARES], all = 0, turn = s->problem->cloud.h / part->size;
    int pass = s->components > s->problem->dim;
    pg_dense_eigen ((int) n, moved, value, V);
    for (size_t a = 0; a < n; a++) if (!(value[a] > STILL * value[0])) still++, last = a;
    part->line = s->problem->dim == 3 && part->points > 1 && still == 1;
    for (size_t b = 3; b < n && part->line; b++) part->axis[b - 3] = V[b * n + last];
    for (size_t a = 0; a < n; a++) all += A[a * n + a];
    for (size_t a = 0; a < n; a++) {
        double own = 0;                                /* rotations of the points themselves */
        for (size_t b = 0; b < n && pass; b++)
            if (which[b] >= 3) own += (double) part->points * V[b * n + a] * V[b * n + a] * turn * turn;
        if (value[a] + own > STILL * value[0]) continue;
        for (size_t b = 0; b < n; b++)
            for (size_t c = 0; c < n; c++) A[b * n + c] += (all > 0 ? all : 1) * V[b * n + a] * V[c * n + a];
    }
}

/* Sums of products of the displacements of all points of every part by each two motions: n x n a part, over
 * all ranks. */
static pg_status square_motions (const body_parts *out, const pg_problem *p, double *moved)
{
    const int *which;
    size_t dim = (size_t) p->dim, n = numbers_of (p->dim, &which);
    for (size_t i = 0; i < p->cloud.n; i++) {
        double u[MOST][3], *sum = moved + SQUARES * (size_t) out->of[i];
        if (!pg_cloud_owns (&p->cloud, i)) continue;
        for (size_t a = 0; a < n; a++) {
            rigid_motion m = { 0 };
            m[which[a]] = 1;
            move_by (&out->part[out->of[i]], p->dim, p->cloud.x + i * dim, m, u[a]);
        }
        for (size_t a = 0; a < n; a++)
            for (size_t b = 0; b < n; b++)
                for (size_t k = 0; k < dim; k++) sum[a * n + b] += u[a][k] * u[b][k];
    }
    return pg_ranks_sum (SQUARES * out->n, moved);
}

/* Order of facet numbers, for pg_search. */
static int ascending_facets (const void *a, const void *b) { return *(const int *) a - *(const int *) b; }

/* Adds the resistance of a support at an integration point of a boundary facet, to each part of which it has
 * a node among its neighbours. Cracks may leave parts of one node each beside it. */
static void resist_facet (const body_parts *out, const pg_system *s, const pg_load *load, size_t q, double *A)
{
    enum { PARTS = 16 };
    const pg_problem *p = s->problem;
    const pg_rows *r = &p->bonds.rows[PG_FACETS];
    int seen[PARTS], n = 0;
    for (size_t e = r->family.start[q]; e < r->family.start[q + 1] && n < PARTS; e++) {
        int part = out->of[r->family.node[e]], known = 0;
        if (s->direct.alive && !s->direct.alive[p->bonds.first[PG_FACETS] + e]) continue;
        for (int k = 0; k < n; k++) known |= seen[k] == part;
        if (known) continue;
        seen[n++] = part;
        resist (&out->part[part], p->dim, load, r->x + q * (size_t) p->dim, A + SQUARES * (size_t) part);
    }
}

/* Adds the resistance of a support on boundary facets; a set may have facets although it has no points. */
static void resist_facets (const body_parts *out, const pg_system *s, const pg_load *load, double *A)
{
    const pg_rows *r = &s->problem->bonds.rows[PG_FACETS];
    for (size_t q = 0; q < r->n; q++)
        if (pg_problem_owns (s->problem, PG_FACETS, q)
            && pg_search (&r->cell[q], load->set->facet, load->set->nfacet, sizeof (int), ascending_facets))
            resist_facet (out, s, load, q, A);
}

/* Adds the resistance of a load to the motions of all parts. */
static void resist_all (const body_parts *out, const pg_system *s, const pg_load *load, double *A)
{
    const pg_problem *p = s->problem;
    if (pg_load_prescribes (load) && load->essential == PG_ESSENTIAL_NITSCHE) {
        resist_facets (out, s, load, A);
        return;
    }
    for (size_t i = 0; i < load->set->npoint; i++) {
        size_t at = (size_t) load->set->point[i], r = (size_t) out->of[at];
        if (pg_cloud_owns (&p->cloud, at))
            resist (&out->part[r], p->dim, load, p->cloud.x + at * (size_t) p->dim, A + SQUARES * r);
    }
}

/* Finds the motions of every part that nothing resists. */
static pg_status find_free (body_parts *out, const pg_system *s)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->problem;
    const int *which;
    size_t n = numbers_of (p->dim, &which);
    double *A = NULL, *moved = NULL;
    PG_ALLOC (A, SQUARES * out->n);
    PG_ALLOC (moved, SQUARES * out->n);
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (pg_load_prescribes (load) || load->kind == PG_SPRING) resist_all (out, s, load, A);
    }
    PG_TRY (pg_ranks_sum (SQUARES * out->n, A));
    PG_TRY (square_motions (out, p, moved));
    for (size_t r = 0; r < out->n; r++) {
        body_part *part = &out->part[r];
        double value[MOST], V[SQUARES];
        hold_still_motions (s, part, moved + SQUARES * r, A + SQUARES * r);
        pg_dense_eigen ((int) n, A + SQUARES * r, value, V);
        for (size_t a = 0; a < n; a++) {
            if (value[a] > HELD * value[0] && value[0] > 0) continue;
            memset (part->motion[part->n], 0, sizeof (rigid_motion));
            for (size_t b = 0; b < n; b++) part->motion[part->n][which[b]] = V[b * n + a];
            part->n++;
        }
    }
done:
    pg_free (A), pg_free (moved);
    return status;
}

pg_status body_parts_find (body_parts *out, const pg_system *s)
{
    pg_status status = PG_OK;
    memset (out, 0, sizeof *out);
    if (!s->force->join) return PG_OK;
    PG_TRY (number_points (out, s));
    PG_TRY (measure (out, s->problem));
    PG_TRY (find_free (out, s));
done:
    if (status != PG_OK) body_parts_clear (out);
    return status;
}
