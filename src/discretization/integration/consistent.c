/* SPDX-License-Identifier: GPL-3.0-or-later
 * Consistent integration: Gauss points in cells, with derivatives that obey the divergence identity cell by
 * cell (integration.h has identity and sources; doc/method.md, Consistent integration).
 *
 * In one cell, with polynomials p_a, M = sum_g w_g p p' and the residual R_a = oint p_a N n dS - sum_g w_g
 * (p_a,k N + p_a dN,k) of each node, the smallest change in the norm weighted by w_g is dN (g) += p (g)'
 * M^-1 R. The solve is done once per point, not per node: c = M^-1 p (g), then dN += sum_a c_a R_a. */
#include "consistent.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The polynomials: 1, x, y, z, xy, yz, xz, xyz in 3D. */
enum { POLYNOMIALS = 8 };

/* ---- set-up -------------------------------------------------------------------------------------------- */
/* For qsort: ascending. */
static int compare_nodes (const void *a, const void *b)
{
    int i = *(const int *) a, j = *(const int *) b;
    return (i > j) - (i < j);
}

/* Appends to `list` (n entries so far) the nodes in the families of the points first .. last - 1 that are not
 * in it yet: `seen` holds the stamp of the list that each node was last put into. Returns the new length. */
static size_t collect (const pg_family *f, size_t first, size_t last, int *seen, int stamp, int *list,
                       size_t n)
{
    for (size_t e = f->start[first]; e < f->start[last]; e++) {
        int j = f->node[e];
        if (seen[j] == stamp) continue;
        seen[j] = stamp;
        list[n++] = j;
    }
    return n;
}

/* Appends the nodes in the families of the points of one cell and of its faces, as `collect`. */
static size_t collect_cell (const pg_consistency *c, const pg_rows *points, size_t cell, int *seen, int stamp,
                            int *list, size_t n)
{
    n = collect (&points->family, c->first[cell], c->first[cell + 1], seen, stamp, list, n);
    for (size_t k = c->faces.of[cell]; k < c->faces.of[cell + 1]; k++) {
        size_t f = (size_t) c->faces.face[k];
        n = collect (&c->face.family, c->faces.start[f], c->faces.start[f + 1], seen, stamp, list, n);
    }
    return n;
}

/* One list of nodes, ascending, for all points of a cell: the families of its points and of the points of its
 * faces, and, if the cell is a host, those of the small cells that it integrates. The identity must hold for
 * each of these nodes, so that every point of the cell needs a derivative for them. */
static pg_status unite (pg_consistency *c, const pg_rows *points, size_t nodes)
{
    pg_status status = PG_OK;
    int *seen = NULL, *list = NULL;
    size_t cap = 0, cap_cell = 0;
    PG_ALLOC (seen, nodes);
    PG_ALLOC (list, nodes);
    PG_ALLOC (c->family.start, points->n + 1);
    PG_ALLOC (c->cell_family.start, c->cells->n + 1);
    c->family.n = points->n, c->cell_family.n = c->cells->n;
    for (size_t cell = 0; cell < c->cells->n; cell++) {
        size_t n = collect_cell (c, points, cell, seen, (int) cell + 1, list, 0);
        for (size_t k = c->guests.start[cell]; k < c->guests.start[cell + 1]; k++)
            n = collect_cell (c, points, (size_t) c->guests.node[k], seen, (int) cell + 1, list, n);
        size_t own = c->cell_family.start[cell];
        pg_sort (list, n, sizeof *list, compare_nodes);
        PG_GROW (c->cell_family.node, cap_cell, own + n);
        memcpy (c->cell_family.node + own, list, n * sizeof *list);
        c->cell_family.start[cell + 1] = own + n;
        for (size_t p = c->first[cell]; p < c->first[cell + 1]; p++) {
            size_t at = c->family.start[p];
            PG_GROW (c->family.node, cap, at + n);
            memcpy (c->family.node + at, list, n * sizeof *list);
            c->family.start[p + 1] = at + n;
        }
    }
done:
    pg_free (seen), pg_free (list);
    return status;
}

/* Positions just inside the body from which points on its boundary look for neighbours (pg_rows_eyes); NULL:
 * nothing separates points. */
static pg_status look_inward (double **eye, const pg_faces *f, const pg_cloud *cloud)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) f->dim;
    double *normal = NULL;
    *eye = NULL;
    if (!cloud->between) return PG_OK;
    PG_ALLOC (normal, f->npoint * dim);
    for (size_t k = 0; k < f->n; k++)
        if (f->cell[2*k + 1] < 0)
            memcpy (normal + f->start[k] * dim, f->flux + f->start[k] * dim,
                    (f->start[k + 1] - f->start[k]) * dim * sizeof *normal);
    PG_TRY (pg_rows_eyes (eye, cloud, f->npoint, f->x, normal));
done:
    pg_free (normal);
    return status;
}

/* Points come cell by cell, so that `first` is a running count. At faces there are values alone, no
 * derivatives. */
pg_status pg_consistency_create (pg_consistency **out, const pg_cells *cells, const pg_approx *approx,
                                 const pg_cloud *cloud, const pg_rows *points, int face_order, int threads)
{
    pg_status status = PG_OK;
    pg_consistency *c = NULL;
    pg_family_search *search = NULL;
    double *eye = NULL;
    PG_ALLOC (c, 1);
    c->cells = cells, c->cloud = cloud, c->order = approx->order;
    PG_ALLOC (c->first, cells->n + 1);
    for (size_t p = 0; p < points->n; p++) c->first[points->cell[p] + 1]++;
    for (size_t cell = 0; cell < cells->n; cell++) c->first[cell + 1] += c->first[cell];
    PG_TRY (pg_faces_build (&c->faces, cells, face_order));
    PG_TRY (consistent_close (c, points));
    PG_TRY (consistent_hosts (c));
    PG_TRY (pg_rows_search (&search, approx, cloud));
    PG_TRY (look_inward (&eye, &c->faces, cloud));
    PG_TRY (pg_rows_place (&c->face, search, cloud, c->faces.npoint, c->faces.x, NULL, NULL, NULL, eye,
                           threads));
    PG_TRY (pg_rows_widen (&c->face, approx, cloud, NULL, NULL, threads, &c->widened));
    PG_ALLOC (c->face.N, c->face.family.start[c->face.n]);             /* no derivatives at faces */
    PG_ALLOC (c->face.grade, c->face.n);
    PG_TRY (approx->type->evaluate (approx, cloud, &c->face, NULL, c->face.n, NULL, threads));
    PG_TRY (unite (c, points, cloud->n));
    *out = c, c = NULL;
done:
    pg_family_search_free (&search);
    pg_free (eye);
    pg_consistency_free (&c);
    return status;
}

void pg_consistency_free (pg_consistency **out)
{
    pg_consistency *c = *out;
    if (!c) return;
    pg_faces_clear (&c->faces);
    pg_rows_clear (&c->face);
    pg_family_clear (&c->family);
    pg_family_clear (&c->cell_family);
    pg_family_clear (&c->hosts);
    pg_family_clear (&c->guests);
    pg_family_clear (&c->needs);
    pg_family_clear (&c->opens);
    pg_free (c->first), pg_free (c->amended), pg_free (c->uneven), pg_free (c->guest_share);
    pg_free (c->widened.blind);
    pg_free (c);
    *out = NULL;
}

/* ---- one cell ------------------------------------------------------------------------------------------ */
/* The polynomials of one cell. */
typedef struct {
    /* Dimension, and number of polynomials in use. */
    int    dim, n;
    /* Polynomials are in z = (x - centre) / size (m), so that their values are of size 1 at the points: the
     * moment matrix is well conditioned at any spacing. */
    double centre[3], size;
    /* Cholesky factor of sum w p p' (n x n). */
    double L[POLYNOMIALS * POLYNOMIALS];
} space;

/* Values p (n) and derivatives slope (n x dim, 1/m) of the polynomials at x: 1, z_k, then products. */
static void polynomials (const space *s, const double *x, double *p, double *slope)
{
    static const int products[4][3] = { { 1, 1, 0 }, { 0, 1, 1 }, { 1, 0, 1 }, { 1, 1, 1 } };
    double z[3] = { 0, 0, 0 };
    int n = 1;
    for (int k = 0; k < s->dim; k++) z[k] = (x[k] - s->centre[k]) / s->size;
    memset (slope, 0, (size_t) (s->n * s->dim) * sizeof *slope);
    p[0] = 1;
    for (int k = 0; k < s->dim && n < s->n; k++, n++) p[n] = z[k], slope[n * s->dim + k] = 1 / s->size;
    for (int m = 0; n < s->n; m++, n++) {
        p[n] = 1;
        for (int k = 0; k < s->dim; k++) if (products[m][k]) p[n] *= z[k];
        for (int k = 0; k < s->dim; k++) {
            double part = products[m][k] ? 1 / s->size : 0;
            for (int l = 0; l < s->dim; l++) if (l != k && products[m][l]) part *= z[l];
            slope[n * s->dim + k] = part;
        }
    }
}

/* Is the cell so thin along an axis (its spread below 1 % of its size) that errors of its quadrature would be
 * amplified? */
static int thin (const space *s)
{
    for (int k = 1; k <= s->dim && k < s->n; k++) if (s->L[k * s->n + k] < 1e-2 * s->L[0]) return 1;
    return 0;
}

/* Chooses as many polynomials as the points first .. last - 1 can determine: with products, linear, constant;
 * n = 0: not even the constant. */
static void find_space (space *s, const pg_rows *points, size_t first, size_t last)
{
    size_t dim = (size_t) points->dim, n = last - first;
    double volume = 0, p[POLYNOMIALS], slope[3 * POLYNOMIALS];
    *s = (space) { .dim = points->dim };
    for (size_t q = first; q < last; q++) volume += points->weight[q];
    for (size_t q = first; q < last; q++)
        for (size_t k = 0; k < dim; k++) s->centre[k] += points->weight[q] / volume * points->x[q * dim + k];
    for (size_t q = first; q < last; q++)
        for (size_t k = 0; k < dim; k++)
            s->size = fmax (s->size, fabs (points->x[q * dim + k] - s->centre[k]));
    if (!(s->size > 0)) s->size = 1;                   /* the cell has a single point */
    /* Numbers of polynomials that are tried: with products, linear, constant, none. */
    const int sizes[] = { 1 << dim, (int) dim + 1, 1, 0 };
    for (const int *size = sizes; (s->n = *size) > 0; size++) {
        if ((size_t) s->n > n) continue;
        memset (s->L, 0, sizeof s->L);
        for (size_t q = first; q < last; q++) {
            polynomials (s, points->x + q * dim, p, slope);
            for (int a = 0; a < s->n; a++)
                for (int b = 0; b <= a; b++) s->L[a * s->n + b] += points->weight[q] / volume * p[a] * p[b];
        }
        if (!thin (s) && pg_dense_cholesky (s->n, s->L, 1e-8) == 0) break;
    }
    for (int k = 0; k < s->n * s->n; k++) s->L[k] *= sqrt (volume);
}

/* Copies the values of n nodes (stride numbers each) from an ascending list of nodes to the positions of
 * these nodes in a wider list. */
static void spread (size_t n, const int *node, size_t stride, const double *value, const int *wide_node,
                    double *wide)
{
    for (size_t i = 0, at = 0; i < n; i++, at++) {
        while (wide_node[at] != node[i]) at++;
        for (size_t k = 0; k < stride; k++) wide[at * stride + k] = value[i * stride + k];
    }
}

/* Arguments and workspaces that all threads share. */
typedef struct {
    const pg_consistency *c;
    const pg_rows *points;
    pg_rows *wide;
    const unsigned char *whole;
    const double *face;  /* N at the points of faces */
    const size_t *list;
    /* Per thread: the residual of the identity (POLYNOMIALS x nodes x dim), N at one point (nodes) and dN at
     * one point (nodes x dim). */
    double **workspace;
} job;

/* Four numbers at a time; sums have the same order with and without vector instructions. */
typedef double four __attribute__ ((vector_size (32), aligned (8)));

/* rest (m x dim) += rate (dim) times N (m), the outer product. The values of four nodes fill `dim`
 * vectors. */
PG_WIDE static void add_rate_solid (size_t m, const double *rate, const double *N, double *rest)
{
    four r[3] = { { rate[0], rate[1], rate[2], rate[0] }, { rate[1], rate[2], rate[0], rate[1] },
                  { rate[2], rate[0], rate[1], rate[2] } };
    size_t i = 0;
    for (; i + 4 <= m; i += 4) {
        four all = *(const four *) (N + i), *to = (four *) (rest + 3 * i);
        to[0] += r[0] * __builtin_shufflevector (all, all, 0, 0, 0, 1);
        to[1] += r[1] * __builtin_shufflevector (all, all, 1, 1, 2, 2);
        to[2] += r[2] * __builtin_shufflevector (all, all, 2, 3, 3, 3);
    }
    for (; i < m; i++) for (size_t k = 0; k < 3; k++) rest[3 * i + k] += rate[k] * N[i];
}

PG_WIDE static void add_rate_plane (size_t m, const double *rate, const double *N, double *rest)
{
    four r = { rate[0], rate[1], rate[0], rate[1] };
    size_t i = 0;
    for (; i + 4 <= m; i += 4) {
        four all = *(const four *) (N + i), *to = (four *) (rest + 2 * i);
        to[0] += r * __builtin_shufflevector (all, all, 0, 0, 1, 1);
        to[1] += r * __builtin_shufflevector (all, all, 2, 2, 3, 3);
    }
    for (; i < m; i++) rest[2 * i] += rate[0] * N[i], rest[2 * i + 1] += rate[1] * N[i];
}

/* rest (n) += p dN (n). */
PG_WIDE static void add_value (size_t n, double p, const double *dN, double *rest)
{
    size_t i = 0;
    for (; i + 4 <= n; i += 4) *(four *) (rest + i) += p * *(const four *) (dN + i);
    for (; i < n; i++) rest[i] += p * dN[i];
}

static void add_rate (size_t m, size_t dim, const double *rate, const double *N, double *rest)
{
    if (dim == 3) add_rate_solid (m, rate, N, rest);
    else if (dim == 2) add_rate_plane (m, rate, N, rest);
    else add_value (m, *rate, N, rest);
}

/* Adds `share` times the volume terms of one point to the residual, - w (p,k N + p dN,k), into rest
 * (polynomials x nodes x dim). */
static void add_point (const job *j, const space *s, size_t q, double share, size_t m, const double *N,
                       const double *dN, double *rest)
{
    size_t dim = (size_t) s->dim, n = (size_t) s->n;
    double p[POLYNOMIALS], slope[3 * POLYNOMIALS], weight = share * j->points->weight[q];
    polynomials (s, j->points->x + q * dim, p, slope);
    for (size_t k = 0; k < n * dim; k++) slope[k] *= -weight;
    for (size_t a = 0; a < n; a++) {
        if (a > 0) add_rate (m, dim, slope + a * dim, N, rest + a * m * dim);
        add_value (m * dim, -weight * p[a], dN, rest + a * m * dim);
    }
}

/* Adds the volume terms of the points of the cell itself. */
static void add_points (const job *j, const space *s, size_t cell, size_t m, double *rest)
{
    const pg_rows *w = j->wide;
    size_t dim = (size_t) s->dim;
    for (size_t q = j->c->first[cell]; q < j->c->first[cell + 1]; q++)
        add_point (j, s, q, 1, m, w->N + j->c->family.start[q], w->dN + j->c->family.start[q] * dim, rest);
}

/* Writes the uncorrected N and dN of point q into a longer list of m nodes. */
static void widen (const job *j, size_t q, size_t m, const int *node, double *N, double *dN)
{
    const pg_rows *r = j->points;
    size_t dim = (size_t) r->dim, from = r->family.start[q], n = r->family.start[q + 1] - from;
    memset (N, 0, m * sizeof *N);
    memset (dN, 0, m * dim * sizeof *dN);
    spread (n, r->family.node + from, 1, r->N + from, node, N);
    spread (n, r->family.node + from, dim, r->dN + from * dim, node, dN);
}

/* Adds `share` times the surface term, oint p N n dS, over all faces of the cell; flux points out of the
 * first cell of a face. */
static void add_faces (const job *j, const space *s, size_t cell, double share, size_t m, const int *node,
                       double *rest, double *N)
{
    const pg_consistency *c = j->c;
    const pg_faces *f = &c->faces;
    size_t dim = (size_t) s->dim, n = (size_t) s->n;
    double p[POLYNOMIALS], slope[3 * POLYNOMIALS], rate[3];
    for (size_t e = f->of[cell]; e < f->of[cell + 1]; e++) {
        size_t face = (size_t) f->face[e];
        double sign = f->cell[2 * face] == (int) cell ? share : -share;
        for (size_t q = f->start[face]; q < f->start[face + 1]; q++) {
            size_t start = c->face.family.start[q];
            memset (N, 0, m * sizeof *N);
            spread (c->face.family.start[q + 1] - start, c->face.family.node + start, 1, j->face + start,
                    node, N);
            polynomials (s, f->x + q * dim, p, slope);
            for (size_t a = 0; a < n; a++) {
                for (size_t k = 0; k < dim; k++) rate[k] = sign * p[a] * f->flux[q * dim + k];
                add_rate (m, dim, rate, N, rest + a * m * dim);
            }
        }
    }
}

/* dN += sum_a c_a rest_a with c = (L L')^-1 p at each point: one solve per point, none per node. */
static void correct (const job *j, const space *s, size_t cell, size_t m, const double *rest)
{
    size_t dim = (size_t) s->dim, n = (size_t) s->n;
    double p[POLYNOMIALS], slope[3 * POLYNOMIALS];
    for (size_t q = j->c->first[cell]; q < j->c->first[cell + 1]; q++) {
        double *dN = j->wide->dN + j->c->family.start[q] * dim;
        polynomials (s, j->points->x + q * dim, p, slope);
        pg_dense_solve (s->n, s->L, p);
        for (size_t a = 0; a < n; a++) add_value (m * dim, p[a], rest + a * m * dim, dN);
    }
}

/* ---- residual that no derivatives can remove ----------------------------------------------------------- */
/* Functions b that the projection uses: 1, z, and with a quadratic basis their products; N reproduces
 * them. */
enum { REPRODUCED = 10 };

static int reproduced (const space *s, int quadratic, const double *x, double *b)
{
    double z[3] = { 0 };
    int n = 0;
    b[n++] = 1;
    for (int k = 0; k < s->dim; k++) b[n++] = z[k] = (x[k] - s->centre[k]) / s->size;
    for (int k = 0; quadratic && k < s->dim; k++) for (int l = k; l < s->dim; l++) b[n++] = z[k] * z[l];
    return n;
}

/* Factors the matrix L L' = sum w b b'. Returns the number of functions, 0 if the points cannot tell them
 * apart. */
static int find_projection (const job *j, const space *s, size_t cell, int quadratic, double *L)
{
    const pg_consistency *c = j->c;
    double b[REPRODUCED];
    int n = reproduced (s, quadratic, s->centre, b);
    memset (L, 0, REPRODUCED * REPRODUCED * sizeof *L);
    for (size_t q = c->first[cell]; q < c->first[cell + 1]; q++) {
        reproduced (s, quadratic, j->points->x + q * (size_t) s->dim, b);
        for (int k = 0; k < n; k++)
            for (int l = 0; l <= k; l++) L[k * n + l] += j->points->weight[q] * b[k] * b[l];
    }
    return pg_dense_cholesky (n, L, 1e-8) == 0 ? n : 0;
}

/* Do all points of the cell have a full quadratic basis? */
static int has_quadratic (const job *j, size_t cell)
{
    if (j->c->order < 2) return 0;
    for (size_t q = j->c->first[cell]; q < j->c->first[cell + 1]; q++)
        if (j->points->grade[q] != PG_GRADE_FULL) return 0;
    return 1;
}

/* The quadrature of the cell, or of a host with its guests, misses the divergence theorem for p_a q, a > 0, q
 * reproduced by N: sum_I R_aI q_I should be zero, as it is for all derivatives that reproduce q. Its actual
 * value is subtracted as a force spread over the volume. Not for a = 0: the patch test needs each R_0I as it
 * is, and the fluxes obey the theorem for 1 and x. */
static void project (const job *j, const space *s, size_t cell, size_t m, const int *node, double *rest)
{
    const pg_consistency *c = j->c;
    size_t dim = (size_t) s->dim;
    double L[REPRODUCED * REPRODUCED], b[REPRODUCED], sum[3][REPRODUCED], rate[3];
    int quadratic = has_quadratic (j, cell), n = find_projection (j, s, cell, quadratic, L);
    if (n == 0 && quadratic) n = find_projection (j, s, cell, quadratic = 0, L);
    for (int a = 1; a < s->n && n > 0; a++) {
        double *R = rest + (size_t) a * m * dim;
        memset (sum, 0, sizeof sum);
        for (size_t i = 0; i < m; i++) {
            reproduced (s, quadratic, c->cloud->x + (size_t) node[i] * dim, b);
            for (size_t k = 0; k < dim; k++) for (int l = 0; l < n; l++) sum[k][l] += R[i * dim + k] * b[l];
        }
        for (size_t k = 0; k < dim; k++) pg_dense_solve (n, L, sum[k]);
        for (size_t q = c->first[cell]; q < c->first[cell + 1]; q++) {
            reproduced (s, quadratic, j->points->x + q * dim, b);
            for (size_t k = 0; k < dim; k++) {
                rate[k] = 0;
                for (int l = 0; l < n; l++) rate[k] -= j->points->weight[q] * sum[k][l] * b[l];
            }
            add_rate (m, dim, rate, j->wide->N + c->family.start[q], R);
        }
    }
}

/* Subtracts what remains of sum_I dN_I at each point, distributed in proportion to N. */
static void remove_sums (const job *j, size_t cell, size_t m)
{
    size_t dim = (size_t) j->points->dim;
    for (size_t q = j->c->first[cell]; q < j->c->first[cell + 1]; q++) {
        double *dN = j->wide->dN + j->c->family.start[q] * dim, sum[3] = { 0 };
        for (size_t i = 0; i < m; i++) for (size_t k = 0; k < dim; k++) sum[k] -= dN[i * dim + k];
        add_rate (m, dim, sum, j->wide->N + j->c->family.start[q], dN);
    }
}

/* ---- one cell ------------------------------------------------------------------------------------------ */
/* Computes derivatives of a cell that obey the identity of the cell and of its guests (small cells). */
static void obey (const job *j, size_t cell, size_t m, const int *node, double *workspace)
{
    const pg_consistency *c = j->c;
    size_t dim = (size_t) j->points->dim, guests = 0;
    space s;
    find_space (&s, j->points, c->first[cell], c->first[cell + 1]);
    if (s.n == 0) return;
    double *rest = workspace, *N = workspace + m * dim * POLYNOMIALS, *dN = N + m;
    memset (rest, 0, m * dim * POLYNOMIALS * sizeof *rest);
    add_points (j, &s, cell, m, rest);
    add_faces (j, &s, cell, 1, m, node, rest, N);
    for (size_t k = c->guests.start[cell]; k < c->guests.start[cell + 1]; k++) {
        size_t guest = (size_t) c->guests.node[k];
        double share = c->guest_share[k];
        if (!j->whole[guest]) continue;
        guests++;
        for (size_t q = c->first[guest]; q < c->first[guest + 1]; q++) {
            widen (j, q, m, node, N, dN);
            add_point (j, &s, q, share, m, N, dN, rest);
        }
        add_faces (j, &s, guest, share, m, node, rest, N);
    }
    for (int pass = 0; pass < 2 && (guests || c->uneven[cell]); pass++) project (j, &s, cell, m, node, rest);
    correct (j, &s, cell, m, rest);
    remove_sums (j, cell, m);
}

/* Treats one cell: copies the uncorrected N and dN into lists with room for more nodes; then corrects them if
 * the cell has all its bonds (whole) and is not a small one that another cell integrates (hosts.c). */
static void treat (const job *j, size_t cell, double *workspace)
{
    const pg_consistency *c = j->c;
    size_t dim = (size_t) j->points->dim, first = c->first[cell], last = c->first[cell + 1];
    if (first == last) return;
    const int *node = c->family.node + c->family.start[first];
    size_t m = c->family.start[first + 1] - c->family.start[first];
    for (size_t q = first; q < last; q++)
        widen (j, q, m, node, j->wide->N + c->family.start[q], j->wide->dN + c->family.start[q] * dim);
    int is_guest = c->hosts.start[cell] < c->hosts.start[cell + 1];
    if (j->whole[cell] && !is_guest) obey (j, cell, m, node, workspace);
}

/* Treats the cells first .. last - 1; run by each thread. */
static void work (void *context, size_t first, size_t last, int thread)
{
    const job *j = context;
    for (size_t k = first; k < last; k++) treat (j, j->list ? j->list[k] : k, j->workspace[thread]);
}

/* Corrects the derivatives of the listed cells. Workspaces have room for the longest list of nodes. */
pg_status pg_consistency_apply (const pg_consistency *c, const pg_rows *points, pg_rows *wide,
                                const unsigned char *whole, const double *face, size_t count,
                                const size_t *list, int threads)
{
    pg_status status = PG_OK;
    size_t most = 0, slots = threads < 1 ? 1 : (size_t) threads;
    job j = { c, points, wide, whole, face ? face : c->face.N, list, NULL };
    for (size_t p = 0; p < points->n; p++)
        if (c->family.start[p + 1] - c->family.start[p] > most)
            most = c->family.start[p + 1] - c->family.start[p];
    PG_ALLOC (j.workspace, slots);
    for (size_t t = 0; t < slots; t++)
        PG_ALLOC (j.workspace[t], most * ((size_t) points->dim * (POLYNOMIALS + 1) + 1));
    pg_parallel (threads, list ? count : c->cells->n, work, &j);
done:
    for (size_t t = 0; j.workspace && t < slots; t++) pg_free (j.workspace[t]);
    pg_free (j.workspace);
    return status;
}

/* The points are those of Gauss integration; only the derivatives differ. */
static pg_status points (pg_quadrature *out, const pg_cells *cells, double thickness, int order)
{
    return pg_cell_points (out, cells, thickness, order);
}

const pg_integration_type pg_integration_consistent = {
    "consistent",
    "Gauss points with derivatives that obey the divergence identity: exact patch test on any points", 0, 1,
    points
};
