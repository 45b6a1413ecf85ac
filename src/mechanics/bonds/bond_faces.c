/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact of crack faces by the bonds that crossed them. Broken bonds that cross a piece of a crack stand for
 * the layer between its faces. With w the stiffness of such a bond along itself, e its direction from side -
 * to side +, xi_n its length along the normal and e_a the components of e along normal and tangents, unit
 * strain of the layer in traction mode a (0: opening, else sliding) elongates the bond by p_a = xi_n e_a, and
 *
 *     r_a (u) = sum w p_a e . (u+ - u-),     A_ac = sum w p_a e_c  (r_a of a unit jump along c),
 *     g = A^-1 r (u):  a mean jump along c is 1 in g_c and 0 in the others.
 *
 * Forces conjugate to g act along the bonds, so that they balance in force and moment, and rigid motions have
 * g = 0. The strain of a closed layer also has a g, l_a = (A^-1 Q)_aa per unit strain, Q_ac = sum w p_a p_c;
 * as the body would bear the stress M or G (moduli) times this strain, a pair of faces has the compliance l /
 * (M area) or l / (G area): it transmits what the intact layer did. Keeping single bonds that bear only
 * compression would lock the crack instead: inclined ones act as struts. */
#include "dilatation.h"
#include "mechanics/boundary/one_sided.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Least over largest eigenvalue of A below which A does not determine all directions of a jump. */
static const double POOR = 1e-3;

/* A broken bond that crosses a face: its ends (node[1] on side +), the piece and the point of the faces that
 * it crosses, its stiffness w, N/m, and its vector from side - to side +, m. */
typedef struct { int node[2]; size_t piece, place; double w, xi[3]; } crossing;
typedef struct {
    bond_force *b;
    const pg_face_pieces *pieces;
    const pg_cracks *cracks;
    pg_nearest *near;                                  /* search among the points of the pieces */
    size_t *piece_of;                                  /* piece of each of these points */
    crossing *list;  size_t n, room;
} search;

/* Returns the point of the pieces' faces near which the bond from a to b crosses; SIZE_MAX: it crosses none.
 * Ends on the face belong to the side to which the normal points. *turned: 1: the bond runs against the
 * normal. */
static size_t place_crossed (const search *s, const double *a, const double *b, int *turned)
{
    size_t dim = s->pieces->dim, q = SIZE_MAX;
    double x[3] = { 0 }, away = 0;
    for (size_t k = 0; k < dim; k++) x[k] = 0.5 * (a[k] + b[k]);
    for (int round = 0; round < 8; round++) {          /* iterates, as faces may be curved */
        size_t found = (size_t) pg_nearest_find (s->near, x, NULL, NULL);
        const double *n = s->pieces->normal + dim * found, *y = s->pieces->x + dim * found;
        double ha = 0, hb = 0, on = PG_NO_LENGTH * s->b->problem->cloud.h;
        away = 0;
        for (size_t k = 0; k < dim; k++)
            ha += n[k] * (a[k] - y[k]), hb += n[k] * (b[k] - y[k]), away += (x[k] - y[k]) * (x[k] - y[k]);
        if ((ha >= -on) == (hb >= -on)) return SIZE_MAX;
        if (found == q) break;
        double t = fmin (1, fmax (0, ha / (ha - hb)));
        for (size_t k = 0; k < dim; k++) x[k] = a[k] + t * (b[k] - a[k]);
        q = found, *turned = ha > hb;
    }
    double part = s->pieces->weight[q] / (dim == 2 ? s->b->problem->cloud.thickness : 1);
    double size = dim == 2 ? 0.5 * (1 + PG_NO_LENGTH) * part : 0.75 * sqrt (part);
    return away <= size * size ? q : SIZE_MAX;
}

/* Lists the broken bond e of point i (of bonds `bonds`), which crosses at point `place` of the faces. turned:
 * as in place_crossed. */
static pg_status add_crossing (search *s, size_t i, const point_bonds *bonds, size_t e, size_t place,
                               int turned)
{
    pg_status status = PG_OK;
    const bond_force *b = s->b;
    const double *x = b->problem->cloud.x;
    size_t dim = (size_t) b->dim, m = (size_t) b->stride, j = (size_t) b->family->node[e];
    double own[36], rr = 0;
    b->theory->blocks (b, i, bonds, e - bonds->first, own, NULL);
    PG_GROW (s->list, s->room, s->n + 1);
    crossing *c = &s->list[s->n];
    *c = (crossing){ .node = { (int) (turned ? j : i), (int) (turned ? i : j) }, .place = place,
                     .piece = s->piece_of[place] };
    for (size_t k = 0; k < dim; k++) {
        c->xi[k] = (turned ? -1 : 1) * (x[dim * j + k] - x[dim * i + k]), rr += c->xi[k] * c->xi[k];
    }
    for (size_t k = 0; k < dim; k++)
        for (size_t l = 0; l < dim; l++) c->w += own[k * m + l] * c->xi[k] * c->xi[l] / rr;
    if (c->w > 0) s->n++;
done:
    return status;
}

/* Lists the broken bonds of point i to points j > i that cross a face of a crack of the state. */
static pg_status search_point (search *s, size_t i)
{
    pg_status status = PG_OK;
    bond_force *b = s->b;
    const double *x = b->problem->cloud.x;
    size_t dim = (size_t) b->dim;
    point_bonds bonds = { 0 };
    for (size_t e = b->family->start[i]; e < b->family->start[i + 1]; e++) {
        size_t j = (size_t) b->family->node[e];
        int turned = 0;
        if (j <= i || bond_force_lives (b, e)) continue;
        size_t place = place_crossed (s, x + dim * i, x + dim * j, &turned);
        /* A bond that no crack cuts broke by itself: add_listed lists it at its own face. */
        if (place == SIZE_MAX
            || !pg_cracks_cut (s->cracks, x + dim * i, x + dim * j, pg_cloud_same (&b->problem->cloud)))
            continue;
        if (!bonds.node) point_bonds_at (b, i, 0, &bonds);
        PG_TRY (add_crossing (s, i, &bonds, e, place, turned));
    }
done:
    return status;
}

/* Lists the bonds that broke one by one, each at the point of the faces that is given for it. */
static pg_status add_listed (search *s)
{
    pg_status status = PG_OK;
    bond_force *b = s->b;
    const pg_face_pieces *f = s->pieces;
    const double *x = b->problem->cloud.x;
    for (size_t k = 0; k < f->nbroken; k++) {
        size_t i, e = f->broken[k], j = (size_t) b->family->node[e], dim = (size_t) b->dim;
        int set;
        double along = 0;
        point_bonds bonds = { 0 };
        pg_problem_locate (b->problem, b->problem->bonds.first[PG_NODES] + e, &set, &i);
        for (size_t c = 0; c < dim; c++)
            along += f->normal[dim * f->place[k] + c] * (x[dim * j + c] - x[dim * i + c]);
        point_bonds_at (b, i, 0, &bonds);
        PG_TRY (add_crossing (s, i, &bonds, e, f->place[k], along < 0));
    }
done:
    return status;
}

/* Sorts the list by pieces, in a piece in the order in which bonds were found. first: where each piece
 * begins. */
static pg_status sort_by_piece (search *s, size_t *first)
{
    pg_status status = PG_OK;
    crossing *sorted = NULL;
    size_t *at = NULL;
    PG_ALLOC (sorted, s->n);
    PG_ALLOC (at, s->pieces->n);
    for (size_t c = 0; c < s->n; c++) first[s->list[c].piece + 1]++;
    for (size_t k = 0; k < s->pieces->n; k++) first[k + 1] += first[k], at[k] = first[k];
    for (size_t c = 0; c < s->n; c++) sorted[at[s->list[c].piece]++] = s->list[c];
    pg_free (s->list);
    s->list = sorted, sorted = NULL;
done:
    pg_free (sorted), pg_free (at);
    return status;
}

/* Sums over the crossing bonds of a piece: A^-1, Q, mean moduli P = M, G, Pa, and the diagonal of A, N
 * (borne). */
typedef struct { double inverse[9], Q[9], P[2], borne[3]; } layer;

/* Returns direction a at point q of the faces: a = 0: the normal, else a tangent. */
static const double *direction (const pg_face_pieces *f, size_t q, size_t a)
{
    return a ? f->tangent + ((f->dim - 1) * q + a - 1) * f->dim : f->normal + f->dim * q;
}

/* Components e_a of the direction of a crossing bond along normal and tangents, and p_a = xi_n e_a, m. */
static void parts (const pg_face_pieces *f, const crossing *c, double *e, double *p)
{
    double rr = 0;
    for (size_t a = 0; a < f->dim; a++) {
        const double *t = direction (f, c->place, a);
        e[a] = 0;
        for (size_t k = 0; k < f->dim; k++) e[a] += t[k] * c->xi[k];
        rr += e[a] * e[a];
    }
    double across = e[0];
    for (size_t a = 0; a < f->dim; a++) e[a] /= sqrt (rr), p[a] = across * e[a];
}

/* Sums the crossing bonds from .. to - 1 of a piece. Returns 0 if they do not determine all directions of a
 * jump. */
static int measure (const search *s, size_t from, size_t to, layer *l)
{
    size_t d = s->pieces->dim;
    const pg_problem *p = s->b->problem;
    double A[9] = { 0 }, sum = 0, e[3], q[3], lambda[3];
    memset (l, 0, sizeof *l);
    for (size_t i = from; i < to; i++) {
        const crossing *c = &s->list[i];
        parts (s->pieces, c, e, q);
        for (size_t k = 0; k < d * d; k++)
            A[k] += c->w * q[k / d] * e[k % d], l->Q[k] += c->w * q[k / d] * q[k % d];
        for (int end = 0; end < 2; end++) {
            const double *D = pg_problem_law (p, PG_NODES, (size_t) c->node[end])->D;
            l->P[0] += c->w * D[0], l->P[1] += c->w * D[d == 2 ? 8 : 35];
        }
        sum += 2 * c->w;
    }
    for (int a = 0; a < 2 && sum > 0; a++) l->P[a] /= sum;
    for (size_t a = 0; a < d; a++) l->borne[a] = A[a * d + a];
    if (!(sum > 0)) return 0;
    pg_dense_eigen ((int) d, A, lambda, NULL);
    if (!(lambda[d - 1] > POOR * lambda[0]) || pg_dense_cholesky ((int) d, A, 0)) return 0;
    for (size_t k = 0; k < d; k++) {
        l->inverse[k * d + k] = 1;
        pg_dense_solve ((int) d, A, l->inverse + k * d);       /* symmetric: rows are columns */
    }
    return 1;
}

/* Computes the compliance of a piece (soft, m/N) and returns how many times stiffer than the bonds it may be.
 * Where bonds broke one by one (known 0) the layer bears no more than the broken ones did, as others beside
 * them may be intact. */
static double yield (const layer *l, size_t d, double area, int known, double *soft)
{
    double R[9] = { 0 }, T[9] = { 0 }, lambda[3];
    for (size_t a = 0; a < d; a++)
        for (size_t c = 0; c < d; c++)
            for (size_t k = 0; k < d; k++) R[a * d + c] += l->inverse[a * d + k] * l->Q[k * d + c];
    for (size_t a = 0; a < d; a++) {
        double whole = l->P[a > 0] * area;
        soft[a] = R[a * d + a] / (known ? whole : fmin (whole, l->borne[a]));
    }
    /* energy 1/2 g S^-1 g = 1/2 r B r with B = A^-1 S^-1 A^-1, r r' <= Q times that of the bonds */
    for (size_t a = 0; a < d; a++)
        for (size_t c = 0; c < d; c++) {
            for (size_t k = 0; k < d; k++) T[a * d + c] += R[a * d + k] * l->inverse[k * d + c];
            T[a * d + c] /= sqrt (soft[a] * soft[c]);
        }
    pg_dense_eigen ((int) d, T, lambda, NULL);
    double softer = known ? 1 : fmax (1, lambda[0] / PG_CONTACT_STIFFEST);
    for (size_t a = 0; a < d; a++) soft[a] *= softer;
    return lambda[0] / softer;
}

static int compare_nodes (const void *a, const void *b)
{
    int i = *(const int *) a, j = *(const int *) b;
    return (i > j) - (i < j);
}

/* Writes the columns of piece k, which give g from unknowns; row: workspace of dim x n x dim zeros, left
 * zero. */
static void put_columns (const search *s, size_t from, size_t to, size_t k, const layer *l, double *row,
                         int *list, pg_sparse *out)
{
    size_t d = s->pieces->dim, n = s->b->n, m = (size_t) s->b->stride, count = 0, kept = 0;
    double e[3], p[3], rr;
    for (size_t i = from; i < to; i++) {
        const crossing *c = &s->list[i];
        parts (s->pieces, c, e, p);
        rr = 0;
        for (size_t x = 0; x < d; x++) rr += c->xi[x] * c->xi[x];
        for (size_t a = 0; a < d; a++) {
            double f = 0;
            for (size_t x = 0; x < d; x++) f += l->inverse[a * d + x] * c->w * p[x] / sqrt (rr);
            for (size_t x = 0; x < d; x++) {
                row[(a * n + (size_t) c->node[1]) * d + x] += f * c->xi[x];
                row[(a * n + (size_t) c->node[0]) * d + x] -= f * c->xi[x];
            }
        }
        list[count++] = c->node[0], list[count++] = c->node[1];
    }
    pg_sort (list, count, sizeof *list, compare_nodes);
    for (size_t i = 0; i < count; i++) if (i == 0 || list[i] != list[kept - 1]) list[kept++] = list[i];
    for (size_t a = 0; a < d; a++) {
        long at = out->start[d * k + a];
        for (size_t i = 0; i < kept; i++)
            for (size_t x = 0; x < d; x++) {
                double *value = &row[(a * n + (size_t) list[i]) * d + x];
                out->row[at] = (long) (m * (size_t) list[i] + x), out->value[at++] = *value, *value = 0;
            }
        out->start[d * k + a + 1] = at;
    }
}

/* Reports an error for piece k, which too few bonds crossed. */
static pg_status refuse (const pg_face_pieces *f, size_t k)
{
    const double *x = f->x + f->dim * f->first[k];
    return pg_error (PG_E_USAGE, PG_HERE,
                     "contact of crack faces: too few bonds crossed the crack within a spacing of (%.6g, "
                     "%.6g, %.6g) m to tell what its faces do: take a smaller spacing, or keep cracks and "
                     "surfaces further apart", x[0], x[1], f->dim > 2 ? x[2] : 0);
}

/* Rows for the jump of displacement across faces, for output: by functions that reproduce linear fields on
 * either side, from the displacements of points. */
pg_status bond_force_jump (void *self, const pg_state *state, size_t n, const double *x, const double *normal,
                           double radius, pg_jump_rows *out)
{
    const bond_force *b = self;
    const pg_approx by = { .type = pg_approx_first (), .kernel = pg_kernel_entry (0) };
    return jump_rows (b->problem, &by, state, n, x, normal, radius, 1, out);
}

pg_status bond_force_faces (void *self, const pg_state *state, const pg_face_pieces *pieces, pg_sparse *rows,
                            double *soft, double *stiffer)
{
    pg_status status = PG_OK;
    search s = { .b = self, .pieces = pieces };
    s.cracks = pg_state_cracks (s.b->problem, state);
    size_t d = pieces->dim, n = s.b->n, *first = NULL;
    double *row = NULL;
    int *list = NULL;
    memset (rows, 0, sizeof *rows);
    *stiffer = 1;
    PG_ALLOC (first, pieces->n + 1);
    PG_ALLOC (s.piece_of, pieces->npoint);
    for (size_t k = 0; k < pieces->n; k++)
        for (size_t q = pieces->first[k]; q < pieces->first[k + 1]; q++) s.piece_of[q] = k;
    if (pieces->npoint) PG_TRY (dilatation_weigh (s.b));
    if (pieces->nknown) {
        PG_TRY (pg_nearest_create (&s.near, (int) d, pieces->first[pieces->nknown], pieces->x));
        for (size_t i = 0; i < n; i++) PG_TRY (search_point (&s, i));
    }
    PG_TRY (add_listed (&s));
    PG_TRY (sort_by_piece (&s, first));
    PG_TRY (pg_sparse_create (rows, n * (size_t) s.b->stride, d * pieces->n, 2 * d * d * s.n, 0));
    PG_ALLOC (row, d * n * d);
    PG_ALLOC (list, 2 * s.n);
    for (size_t k = 0; k < pieces->n; k++) {
        layer l;
        double area = 0;
        for (size_t q = pieces->first[k]; q < pieces->first[k + 1]; q++) area += pieces->weight[q];
        int tells = measure (&s, first[k], first[k + 1], &l), known = k < pieces->nknown;
        if (!tells && known) PG_TRY (refuse (pieces, k));
        /* A few broken bonds among intact ones determine no jump: there is no face yet. */
        if (tells) *stiffer = fmax (*stiffer, yield (&l, d, area, known, soft + d * k));
        put_columns (&s, first[k], tells ? first[k + 1] : first[k], k, &l, row, list, rows);
    }
done:
    pg_nearest_free (&s.near);
    pg_free (s.list), pg_free (s.piece_of), pg_free (first), pg_free (row), pg_free (list);
    if (status != PG_OK) pg_sparse_clear (rows);
    return status;
}
