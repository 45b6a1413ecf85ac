/* SPDX-License-Identifier: GPL-3.0-or-later
 * Parts of the body that supports do not hold: what a crack has cut off, or a block that lies on platens. K
 * is singular along their rigid motions R. As many springs as there are motions, on unknowns of these parts,
 * make it regular without any force of their own: with f such that R' (F + G' f) = 0 a statically determinate
 * set of springs bears nothing, so that the solution of the sprung system is one of K, and all others differ
 * from it by R y. The amounts y are unknowns beside the forces of contact (Farhat and Roux 1991;
 * contact_free.c). */
#include "contact.h"
#include <math.h>
#include <string.h>

/* A motion counts as held where the prescribed displacements resist it by more than this share of what they
 * resist the stiffest one. */
static const double HELD = 1e-9;
/* More parts than this are rubble, and no matter of a dense system. */
enum { MOST_MODES = 120 };

typedef struct {
    const pg_problem *p;
    const unsigned char *alive;
    int    *parent;
    size_t *count;                                     /* nodes of each part, at its root */
    double (*middle)[3], *size;                        /* of each part, m, at its root */
} parts;

/* ---- parts --------------------------------------------------------------------------------------------- */
/* Nodes that a point of evaluation sees hang together. */
static void join (parts *w)
{
    const pg_problem *p = w->p;
    int set = p->integration->at_nodes ? PG_NODES : PG_POINTS;
    const pg_family *f = &p->rows[set].family;
    const unsigned char *alive = w->alive + p->first_bond[set];
    pg_disjoint_start (w->parent, p->cloud.n);
    for (size_t q = 0; q < f->n; q++) {
        int first = -1;
        for (size_t e = f->start[q]; e < f->start[q + 1]; e++) {
            if (!alive[e]) continue;
            if (first < 0) first = f->node[e];
            else pg_disjoint_join (w->parent, first, f->node[e]);
        }
    }
}

static void measure (parts *w)
{
    size_t dim = (size_t) w->p->dim;
    const double *x = w->p->cloud.x;
    for (size_t i = 0; i < w->p->cloud.n; i++) {
        size_t r = (size_t) pg_disjoint_root (w->parent, (int) i);
        w->count[r]++;
        for (size_t k = 0; k < dim; k++) w->middle[r][k] += x[i * dim + k];
    }
    for (size_t i = 0; i < w->p->cloud.n; i++)
        for (size_t k = 0; k < dim && w->count[i]; k++) w->middle[i][k] /= (double) w->count[i];
    for (size_t i = 0; i < w->p->cloud.n; i++) {
        size_t r = (size_t) pg_disjoint_root (w->parent, (int) i);
        double sum = 0;
        for (size_t k = 0; k < dim; k++)
            sum += (x[i * dim + k] - w->middle[r][k]) * (x[i * dim + k] - w->middle[r][k]);
        w->size[r] = fmax (w->size[r], sqrt (sum));
    }
}

/* ---- motions ------------------------------------------------------------------------------------------- */
/* Displacement at x of the rigid motion m (three translations, three rotations over the size of the part). */
static void move (const parts *w, size_t root, const double *x, const double *m, double *u)
{
    double r[3] = { 0 }, size = w->size[root] > 0 ? w->size[root] : 1;
    for (int k = 0; k < w->p->dim; k++) r[k] = (x[k] - w->middle[root][k]) / size;
    for (int k = 0; k < 3; k++)
        u[k] = m[k] + m[3 + (k + 1) % 3] * r[(k + 2) % 3] - m[3 + (k + 2) % 3] * r[(k + 1) % 3];
}

/* Which of the six numbers a motion has in this dimension. */
static const int plane[3] = { 0, 1, 5 }, space[6] = { 0, 1, 2, 3, 4, 5 };

/* What a prescribed displacement at a point resists: A += the squares of its rows, n x n. */
static void resist (const parts *w, size_t root, const pg_load *load, const double *x, size_t n, double *A)
{
    const int *which = w->p->dim == 2 ? plane : space;
    for (int k = 0; k < w->p->dim; k++) {
        double row[6];
        for (size_t a = 0; a < n; a++) {
            double m[6] = { 0 }, u[3];
            m[which[a]] = 1;
            move (w, root, x, m, u);
            row[a] = load->value[k] ? u[k] : 0;
        }
        for (size_t a = 0; a < n; a++) for (size_t b = 0; b < n; b++) A[a * n + b] += row[a] * row[b];
    }
}

/* Motions of a part that no prescribed displacement resists, as columns of six numbers; returns how many. */
static size_t free_motions (const parts *w, size_t root, double motion[6][6])
{
    const pg_problem *p = w->p;
    size_t dim = (size_t) p->dim, n = dim == 2 ? 3 : 6, found = 0;
    const int *which = dim == 2 ? plane : space;
    double A[36] = { 0 }, value[6], V[36];
    for (size_t l = 0; l < p->nload; l++) {
        const pg_load *load = &p->load[l];
        for (size_t i = 0; pg_load_prescribes (load) && i < load->set->npoint; i++)
            if ((size_t) pg_disjoint_root (w->parent, load->set->point[i]) == root)
                resist (w, root, load, p->cloud.x + (size_t) load->set->point[i] * dim, n, A);
    }
    pg_dense_eigen ((int) n, A, value, V);
    for (size_t a = 0; a < n; a++) {
        if (value[a] > HELD * value[0] && value[0] > 0) continue;
        memset (motion[found], 0, 6 * sizeof (double));
        for (size_t b = 0; b < n; b++) motion[found][which[b]] = V[b * n + a];
        found++;
    }
    return found;
}

/* Adds `count` motions of a part, and an unknown for each that tells them apart: the largest entry of what is
 * left of its column once those of the others are eliminated. */
static pg_status add_motions (const parts *w, contact_loose *l, size_t root, size_t count,
                              double motion[6][6])
{
    pg_status status = PG_OK;
    const pg_problem *p = w->p;
    size_t dim = (size_t) p->dim, ndof = p->cloud.n * dim, first = l->n;
    double *left = NULL;
    PG_ALLOC (left, count * ndof);
    PG_GROW (l->mode, l->cap_mode, (first + count) * ndof);
    PG_GROW (l->prop, l->cap_prop, first + count);
    PG_GROW (l->place, l->cap_place, 3 * (first + count));
    memset (l->mode + first * ndof, 0, count * ndof * sizeof *left);
    for (size_t i = 0; i < p->cloud.n; i++) {
        if ((size_t) pg_disjoint_root (w->parent, (int) i) != root) continue;
        for (size_t m = 0; m < count; m++) {
            double u[3];
            move (w, root, p->cloud.x + i * dim, motion[m], u);
            memcpy (l->mode + (first + m) * ndof + i * dim, u, dim * sizeof *u);
        }
    }
    memcpy (left, l->mode + first * ndof, count * ndof * sizeof *left);
    for (size_t m = 0; m < count; m++) {
        size_t at = 0;
        for (size_t i = 1; i < ndof; i++)
            if (fabs (left[m * ndof + i]) > fabs (left[m * ndof + at]) * (1 + 1e-9)) at = i;
        l->prop[first + m] = at;
        for (size_t o = m + 1; o < count; o++) {
            double share = left[o * ndof + at] / left[m * ndof + at];
            for (size_t i = 0; i < ndof; i++) left[o * ndof + i] -= share * left[m * ndof + i];
        }
        memcpy (l->place + 3 * (first + m), w->middle[root], 3 * sizeof *left);
    }
    l->n += count;
done:
    pg_free (left);
    return status;
}

pg_status loose_refresh (contact_loose *l, const pg_system *s, const pg_state *state)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->problem;
    parts w = { .p = p, .alive = state->alive };
    size_t n = p->cloud.n, dim = (size_t) p->dim;
    l->n = 0;
    if (s->components != p->dim) return PG_OK;
    PG_ALLOC (w.parent, n);
    PG_ALLOC (w.count, n);
    PG_ALLOC (w.middle, n);
    PG_ALLOC (w.size, n);
    join (&w), measure (&w);
    for (size_t r = 0; r < n; r++) {
        double motion[6][6];
        if ((size_t) pg_disjoint_root (w.parent, (int) r) != r || w.count[r] <= dim) continue;
        size_t count = free_motions (&w, r, motion);
        if (l->n + count > MOST_MODES)
            PG_FAIL (PG_E_USAGE,
                     "more than %d rigid motions of parts of the body are held by contact alone, which is "
                     "too many for equilibria: prescribe displacements of these parts, or use a solver of "
                     "motion",
                     MOST_MODES);
        if (count) PG_TRY (add_motions (&w, l, r, count, motion));
    }
    PG_GROW (l->amount, l->cap_amount, l->n);
    PG_GROW (l->target, l->cap_target, l->n);
    for (size_t j = 0; j < l->n; j++) l->amount[j] = l->target[j] = 0;
done:
    pg_free (w.parent), pg_free (w.count), pg_free (w.middle), pg_free (w.size);
    return status;
}

void loose_free (contact_loose *l)
{
    pg_free (l->mode), pg_free (l->prop), pg_free (l->place), pg_free (l->amount), pg_free (l->target);
    memset (l, 0, sizeof *l);
}

/* ---- springs ------------------------------------------------------------------------------------------- */
void loose_matrix (const pg_system *s, const pg_sparse *K, double *value)
{
    const contact_loose *l = s->contact ? &s->contact->loose : NULL;
    for (size_t j = 0; l && j < l->n; j++) value[K->start[l->prop[j] + 1] - 1] += s->mean_diagonal;
}

void loose_forces (const pg_system *s, const double *d, double *residual)
{
    const contact_loose *l = s->contact ? &s->contact->loose : NULL;
    for (size_t j = 0; l && j < l->n; j++)
        residual[l->prop[j]] -= s->mean_diagonal * (d[l->prop[j]] - l->target[j]);
}

double loose_pull (const pg_system *s, const double *d)
{
    const contact_loose *l = &s->contact->loose;
    double most = 0;
    for (size_t j = 0; j < l->n; j++)
        most = fmax (most, s->mean_diagonal * fabs (d[l->prop[j]] - l->target[j]));
    return most;
}

void loose_move (contact_loose *l, size_t ndof, size_t j, double by, double *d)
{
    const double *mode = l->mode + j * ndof;
    if (by == 0) return;
    l->amount[j] += by;
    for (size_t i = 0; i < ndof; i++) d[i] += by * mode[i];
    for (size_t k = 0; k < l->n; k++) l->target[k] += by * mode[l->prop[k]];
}
