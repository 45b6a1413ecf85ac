/* SPDX-License-Identifier: GPL-3.0-or-later
 * lattice_body.h: small bodies on a lattice with holes, cracks and shares, and the plain double loop that
 * every sweep must equal. */
#ifndef PERIGAL_TEST_LATTICE_BODY_H
#define PERIGAL_TEST_LATTICE_BODY_H
#include "check.h"
#include "perigal/sums.h"
#include <stdlib.h>

static const double cell_side = 1e-3;                  /* m */
typedef struct {
    int count[3];
    double holes;                                      /* share of sites that are empty */
    int  shares;                                       /* 1: half volumes on the sides of the box */
    int  reversed;                                     /* 1: points numbered against the order of sites */
    int  dim;
    double m;                                          /* horizon in steps */
    pg_surface surface;
    pg_partial partial;
    int  finite;
    pg_evaluation evaluation;
} body_wish;
typedef struct {
    pg_cloud cloud;
    pg_sums *sums;
    pg_family family;
    size_t nbond;
    unsigned char *alive, *exempt;
    double *modulus, *limit, *u;
    double *W;                                         /* of body_plain, J/m^3 */
    uint64_t seed;
} body;

static inline double body_random (body *b)             /* in [0, 1) */
{
    b->seed = b->seed * 6364136223846793005u + 1442695040888963407u;
    return (double) (b->seed >> 11) / 9007199254740992.0;
}

/* scatter > 0: no lattice, points moved by up to this share of a step; mixed: points in random order, two
 * materials side by side, some points tougher than others. */
static inline void body_create_as (body *b, const body_wish *w, double scatter, int mixed, uint64_t seed)
{
    static const pg_mode modes[] = { PG_LINE, PG_PLANE_STRESS, PG_SOLID };
    memset (b, 0, sizeof *b);
    b->seed = seed;
    pg_cloud *c = &b->cloud;
    size_t dim = (size_t) w->dim, sites = (size_t) w->count[0] * (size_t) w->count[1] * (size_t) w->count[2];
    c->dim = w->dim, c->h = cell_side, c->thickness = w->dim == 2 ? 5e-3 : 1;
    c->x = pg_calloc (sites * dim, sizeof *c->x), c->volume = pg_calloc (sites, sizeof *c->volume);
    for (size_t s = 0; s < sites; s++) {
        size_t site = w->reversed ? sites - 1 - s : s, nx = (size_t) w->count[0], ny = (size_t) w->count[1];
        size_t at[3] = { site % nx, site / nx % ny, site / nx / ny };
        if (sites > 1 && s > 0 && body_random (b) < w->holes) continue;
        c->volume[c->n] = pow (cell_side, w->dim) * c->thickness;
        for (size_t d = 0; d < dim; d++) {
            c->x[c->n * dim + d] = ((double) at[d] + 0.5) * cell_side;
            c->x[c->n * dim + d] += scatter > 0 ? scatter * cell_side * (2 * body_random (b) - 1) : 0;
            if (w->shares && (at[d] == 0 || at[d] + 1 == (size_t) w->count[d])) c->volume[c->n] *= 0.5;
        }
        c->n++;
    }
    for (size_t i = c->n; mixed && i > 1; i--) {
        size_t j = (size_t) (body_random (b) * (double) i);
        for (size_t d = 0; d < dim; d++) {
            double x = c->x[(i - 1) * dim + d];
            c->x[(i - 1) * dim + d] = c->x[j*dim + d], c->x[j*dim + d] = x;
        }
        double V = c->volume[i - 1];
        c->volume[i - 1] = c->volume[j], c->volume[j] = V;
    }
    for (size_t d = 0; d < dim; d++) {
        c->low[d] = INFINITY, c->high[d] = -INFINITY;
        for (size_t i = 0; i < c->n; i++)
            c->low[d] = fmin (c->low[d], c->x[i * dim + d]),
            c->high[d] = fmax (c->high[d], c->x[i * dim + d]);
    }
    pg_lattice lattice = { .dim = w->dim, .step = { cell_side, cell_side, cell_side } };
    pg_sum_rule rule = { .mode = modes[w->dim - 1],
                         .kernel = pg_kernel_find ("constant"),
                         .horizon = w->m * cell_side,
                         .partial = w->partial,
                         .surface = w->surface,
                         .calibrate = 1,
                         .finite = w->finite,
                         .evaluation = w->evaluation };
    check_ok (pg_sums_create (&b->sums, &rule, c, scatter > 0 ? NULL : &lattice));
    check_ok (pg_sums_family (&b->family, b->sums, NULL));
    b->nbond = b->family.start[c->n];
    b->alive = pg_calloc (b->nbond, 1), b->exempt = pg_calloc (c->n, 1);
    b->modulus = pg_calloc (c->n, sizeof *b->modulus), b->limit = pg_calloc (c->n, sizeof *b->limit),
    b->u = pg_calloc (c->n * dim, sizeof *b->u);
    b->W = pg_calloc (c->n, sizeof *b->W);
    double modulus = b->sums->calibration
                     * pg_bond_modulus (rule.mode, rule.kernel, rule.horizon, 72e9, c->thickness);
    memset (b->alive, 1, b->nbond);
    for (size_t i = 0; i < c->n; i++) b->modulus[i] = modulus, b->limit[i] = 1e-3;
    for (size_t i = 0; mixed && i < c->n; i++) {
        if (c->x[i*dim] > 0.5 * (c->low[0] + c->high[0])) b->modulus[i] *= 3;
        if (body_random (b) < 0.1) b->limit[i] *= 1 + body_random (b);
    }
    for (size_t i = 0; i < c->n * dim; i++) b->u[i] = 1e-6 * (body_random (b) - 0.5);
}

static inline void body_create (body *b, const body_wish *w, uint64_t seed)
{
    body_create_as (b, w, 0, 0, seed);
}

static inline size_t body_reverse (const body *b, size_t i, size_t e)        /* the entry of j -> i */
{
    size_t j = (size_t) b->family.node[e];
    for (size_t k = b->family.start[j]; k < b->family.start[j + 1]; k++)
        if ((size_t) b->family.node[k] == i) return k;
    fail ();
    return 0;
}

/* Kills bonds, both directions, each with this chance */
static inline void body_wound (body *b, double chance)
{
    for (size_t i = 0; i < b->cloud.n; i++)
        for (size_t e = b->family.start[i]; e < b->family.start[i + 1]; e++)
            if ((size_t) b->family.node[e] > i && body_random (b) < chance)
                b->alive[e] = b->alive[body_reverse (b, i, e)] = 0;
}

static inline void body_free (body *b)
{
    void *blocks[] = { b->cloud.x, b->cloud.volume, b->alive, b->exempt, b->modulus, b->limit, b->u, b->W };
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++) pg_free (blocks[k]);
    pg_family_clear (&b->family);
    pg_sums_free (&b->sums);
}

/* Stretch of a bond as the contract has it, and the pull per (c weight s): unit vector of xi or of xi +
 * eta */
static inline double body_stretch (const body *b, const double *xi, const double *eta, double *along)
{
    size_t dim = (size_t) b->cloud.dim;
    double r2 = 0, y2 = 0, dot = 0, q = 0;
    for (size_t d = 0; d < dim; d++) {
        double y = xi[d] + eta[d];
        r2 += xi[d] * xi[d], y2 += y * y, dot += xi[d] * eta[d], q += eta[d] * (2 * xi[d] + eta[d]);
    }
    double r = sqrt (r2), l = sqrt (y2);
    for (size_t d = 0; d < dim; d++) along[d] = b->sums->rule.finite ? (xi[d] + eta[d]) / l : xi[d] / r;
    return b->sums->rule.finite ? q / (r * (l + r)) : dot / r2;
}

/* The plain loop: bonds at or over their limit die if `breaks`, in alive and noted in dead (nbond, or NULL);
 * then forces (n x dim), energies of points and that of all. */
static inline double body_plain (body *b, int breaks, double *f, unsigned char *dead)
{
    size_t dim = (size_t) b->cloud.dim, n = b->cloud.n;
    double *xi = pg_calloc (n * dim + 512 * dim, sizeof *xi), *weight = pg_calloc (n + 512, sizeof *weight),
           energy = 0;
    memset (f, 0, n * dim * sizeof *f);
    for (size_t i = 0; i < n; i++) {
        double before = energy;
        b->W[i] = 0;
        pg_sums_bonds (b->sums, &b->family, i, xi, weight, NULL);
        for (size_t e = b->family.start[i]; e < b->family.start[i + 1]; e++) {
            size_t j = (size_t) b->family.node[e], k = e - b->family.start[i];
            double eta[3], along[3], r = 0, a = b->modulus[i], c = b->modulus[j];
            for (size_t d = 0; d < dim; d++)
                eta[d] = b->u[j * dim + d] - b->u[i * dim + d], r += xi[k * dim + d] * xi[k * dim + d];
            double s = body_stretch (b, xi + k * dim, eta, along),
                   pull = (a == c ? a : 2 * a * c / (a + c)) * weight[k];
            if (breaks && b->alive[e] && !b->exempt[i] && !b->exempt[j]
                && s >= fmin (b->limit[i], b->limit[j])) {
                b->alive[e] = 0;
                if (dead) dead[e] = 1;
            }
            if (!b->alive[e]) continue;
            double both = b->cloud.volume[i] * b->cloud.volume[j];
            for (size_t d = 0; d < dim; d++) f[i*dim + d] += both * pull * s * along[d];
            b->W[i] += b->cloud.volume[j] * pull * sqrt (r) * s * s / 4;
        }
        energy = before + b->W[i] * b->cloud.volume[i];
    }
    pg_free (xi);
    pg_free (weight);
    return energy;
}
#endif
