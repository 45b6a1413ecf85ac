/* SPDX-License-Identifier: GPL-3.0-or-later
 * The patch test of a discretisation (Irons): under the tractions of a uniform stress its displacement should
 * be linear. The error of the body as it is is measured, whatever its cause: families cut by the surface,
 * quadrature, zero-energy modes, outermost rows that bear loads. */
#include "patch_test_factor.h"
#include "solve/run/solve.h"
#include "perigal/vector.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { STATES = 6, DELAY = 6, FEWEST = 12, MOST = 3000 };
/* iterations end when they gain less than this share of the error's energy so far; of the linear field's
 * energy */
static const double gain = 1e-4, enough = 1e-7;
static const double bonds_paid = 3e8;  /* most bonds that all iterations together may visit */

typedef struct {
    const pg_problem *p;
    const pg_force_type *force;
    void     *self;
    pg_state *state;
    size_t    n, dim, stride, ndof, nv;
    int       turns;                                   /* 1: rotational unknowns have a stiffness */
    const pg_operator *op;
    pg_operator product;  /* K x by the matrix that was factored, which is cheaper than `op` of the force */
    patch_factor *factor;                              /* factor of K; NULL: conjugate gradients */
    double    middle[3], size;  /* of the body, m: centre of volume; root mean square distance */
    /* P: tractions of a state, N; inverse: 1 / diagonal of K, 0: held */
    double   *P, *x, *r, *z, *q, *inverse, *u;
    double    A[STATES * STATES];  /* x K y for all pairs of fields x, y of unit strain */
    size_t    limit;
    int       supported;                               /* 1: supports on points hold the body */
    int       rows;  /* 1: loads and supports act on the outermost rows of points */
    pg_patch  out;
} probe;

/* ---- fields -------------------------------------------------------------------------------------------- */
/* Finds the centre of volume and the root of the mean square distance from it, m, by which translations,
 * rotations and strains are scaled alike. */
static void find_middle (probe *t)
{
    double all = 0, square = 0;
    for (size_t i = 0; i < t->n; i++) {
        all += t->p->cloud.volume[i];
        for (size_t k = 0; k < t->dim; k++)
            t->middle[k] += t->p->cloud.volume[i] * t->p->cloud.x[i * t->dim + k];
    }
    for (size_t k = 0; k < t->dim; k++) t->middle[k] /= all;
    for (size_t i = 0; i < t->n * t->dim; i++) {
        double x = t->p->cloud.x[i] - t->middle[i % t->dim];
        square += t->p->cloud.volume[i / t->dim] * x * x;
    }
    t->size = sqrt (square / all);
}

/* A motion affine in the position x relative to the middle: d_k = p_k + sum_l R_kl x_l; k: dim displacements
 * (m), then rotations times the spacing. */
typedef struct { double p[6], R[6][3]; } motion;

/* Motion m about the middle: the nv linear ones of unit strain (engineering shear), then translations and
 * rotations, with rotational unknowns unless these are held. */
static motion motion_of (const probe *t, size_t m)
{
    static const int pair[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 1, 2 }, { 2, 0 } };
    motion d = { 0 };
    if (m < t->nv) {
        const int *of = pair[t->dim == 2 && m == 2 ? 3 : m];
        if (of[0] == of[1]) d.R[of[0]][of[0]] = 1;
        else d.R[of[0]][of[1]] = d.R[of[1]][of[0]] = 0.5;
    } else if (m < t->nv + t->dim) d.p[m - t->nv] = t->size;
    else {
        size_t turn = m - t->nv - t->dim;
        const int *of = pair[3 + turn];                /* xy, yz, zx */
        d.R[of[0]][of[1]] = -1, d.R[of[1]][of[0]] = 1;
        if (t->turns) d.p[t->dim + (t->dim == 2 ? 0 : (turn + 2) % 3)] = t->p->cloud.h;
    }
    return d;
}

/* a += c b */
static void add_motion (motion *a, double c, const motion *b)
{
    for (size_t k = 0; k < 6; k++) {
        a->p[k] += c * b->p[k];
        for (size_t l = 0; l < 3; l++) a->R[k][l] += c * b->R[k][l];
    }
}

#define INLINE static inline __attribute__ ((always_inline))

/* f += d at all points, `stride` numbers a point; for most bodies dim and stride are known to the
 * compiler. */
INLINE void add_points (const probe *t, const motion *d, const size_t dim, const size_t stride, double *f)
{
    const double *place = t->p->cloud.x, *middle = t->middle;
    for (size_t i = 0; i < t->n; i++) {
        double x[3] = { 0 };
        for (size_t l = 0; l < dim; l++) x[l] = place[i * dim + l] - middle[l];
        for (size_t k = 0; k < stride; k++) {
            double s = d->p[k];
            for (size_t l = 0; l < dim; l++) s += d->R[k][l] * x[l];
            f[i * stride + k] += s;
        }
    }
}

static void add_field (const probe *t, const motion *d, size_t stride, double *f)
{
    if (t->dim == 2 && stride == 2) add_points (t, d, 2, 2, f);
    else if (t->dim == 3 && stride == 3) add_points (t, d, 3, 3, f);
    else add_points (t, d, t->dim, stride, f);
}

/* out = sum of strains times their linear fields, `stride` numbers a point. */
static void linear_field (const probe *t, const double *strain, size_t stride, double *out)
{
    motion all = { 0 };
    for (size_t v = 0; v < t->nv; v++) {
        motion one = motion_of (t, v);
        add_motion (&all, strain[v], &one);
    }
    memset (out, 0, t->n * stride * sizeof *out);
    add_field (t, &all, stride, out);
}

/* Sums over the points, weighted by volumes or by 1: of products of (1, x) (4 x 4), and of these with the
 * components of a field (6 x 4). Products of fields with motions, and of motions, follow from them. */
typedef struct { double square[4][4], field[6][4]; } moments;

INLINE void add_moments (const probe *t, const size_t dim, const size_t stride, int volumes, const double *f,
                         moments *out)
{
    moments s = { 0 };
    const size_t m = dim + 1;
    for (size_t i = 0; i < t->n; i++) {
        double w = volumes ? t->p->cloud.volume[i] : 1, x[4] = { 1 };
        for (size_t l = 1; l < m; l++) x[l] = t->p->cloud.x[i * dim + l - 1] - t->middle[l - 1];
        for (size_t a = 0; a < m; a++) for (size_t b = 0; b <= a; b++) s.square[a][b] += w * x[a] * x[b];
        for (size_t k = 0; k < stride; k++)
            for (size_t b = 0; b < m; b++) s.field[k][b] += w * f[i * stride + k] * x[b];
    }
    for (size_t a = 0; a < m; a++) for (size_t b = 0; b < a; b++) s.square[b][a] = s.square[a][b];
    *out = s;
}

static moments moments_of (const probe *t, size_t stride, int volumes, const double *f)
{
    moments s;
    if (t->dim == 2 && stride == 2) add_moments (t, 2, 2, volumes, f, &s);
    else if (t->dim == 3 && stride == 3) add_moments (t, 3, 3, volumes, f, &s);
    else add_moments (t, t->dim, stride, volumes, f, &s);
    return s;
}

/* Coefficient b, of (1, x), in component k of a motion. */
static double part (const motion *d, size_t k, size_t b) { return b ? d->R[k][b - 1] : d->p[k]; }

/* Sum over the points of a motion times another one, or times the field (other NULL). */
static double product (const moments *s, size_t stride, const motion *d, const motion *other)
{
    double sum = 0;
    for (size_t k = 0; k < stride; k++)
        for (size_t a = 0; a < 4; a++) {
            if (!other) sum += part (d, k, a) * s->field[k][a];
            else for (size_t b = 0; b < 4; b++) sum += part (d, k, a) * part (other, k, b) * s->square[a][b];
        }
    return sum;
}

/* Subtracts from f (n x stride) its least squares fit by rigid motions, with `linear` by linear ones as well;
 * weights: volumes, or 1. Motions that do not exist in a body (points in a line) are left out by the
 * eigenvalues of their Gram matrix. */
static void without (const probe *t, size_t stride, int volumes, int linear, double *f)
{
    size_t first = linear ? 0 : t->nv, last = t->nv + t->dim + t->dim * (t->dim - 1) / 2, m = last - first;
    double G[144] = { 0 }, V[144], lambda[12], b[12] = { 0 };
    moments s = moments_of (t, stride, volumes, f);
    motion d[12], all = { 0 };
    for (size_t a = 0; a < m; a++) {
        d[a] = motion_of (t, first + a);
        b[a] = product (&s, stride, &d[a], NULL);
        for (size_t e = 0; e <= a; e++) G[a * m + e] = G[e * m + a] = product (&s, stride, &d[a], &d[e]);
    }
    pg_dense_eigen ((int) m, G, lambda, V);
    for (size_t l = 0; l < m && lambda[l] > 1e-12 * lambda[0]; l++) {
        double along = 0;
        for (size_t a = 0; a < m; a++) along += V[a * m + l] * b[a];
        for (size_t a = 0; a < m; a++) add_motion (&all, -V[a * m + l] * along / lambda[l], &d[a]);
    }
    add_field (t, &all, stride, f);
}

/* ---- points at the rim, where there are no facets ------------------------------------------------------ */
/* 1: point i is outermost: its neighbours within 1.6 spacings leave one side open, as the sum of the unit
 * vectors to them is more than a fifth of their number. */
static int outermost (const pg_problem *p, size_t i)
{
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    size_t dim = (size_t) p->dim;
    double h = pg_problem_spacing (p, PG_NODES, i), sum[3] = { 0 }, count = 0, open = 0;
    for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
        double xi[3] = { 0 }, r = 0;
        for (size_t k = 0; k < dim; k++)
            xi[k] = p->cloud.x[(size_t) f->node[e] * dim + k] - p->cloud.x[i * dim + k], r += xi[k] * xi[k];
        r = sqrt (r);
        if (!(r > 0.1 * h) || r > 1.6 * h) continue;
        count++;
        for (size_t k = 0; k < dim; k++) sum[k] += xi[k] / r;
    }
    for (size_t k = 0; k < dim; k++) open += sum[k] * sum[k];
    return sqrt (open) > 0.2 * count || count < (double) dim;
}

/* 1: some load or support acts on the outermost rows of points only: tractions do, and sets thinner than a
 * horizon; with shape functions facets are as thin. Then the compliance of the surface counts as error. */
static int borne_by_rows (const pg_problem *p)
{
    size_t dim = (size_t) p->dim;
    if (p->method->shape_functions) return 1;
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_set *set = p->boundary.load[l].set;
        double least = INFINITY;
        if (p->boundary.load[l].kind == PG_TRACTION || p->boundary.load[l].kind == PG_PRESSURE) return 1;
        for (size_t k = 0; k < dim; k++) {
            double low = INFINITY, high = -INFINITY;
            for (size_t i = 0; i < set->npoint; i++) {
                double x = p->cloud.x[(size_t) set->point[i] * dim + k];
                low = fmin (low, x), high = fmax (high, x);
            }
            least = fmin (least, high - low);
        }
        if (least < p->form.approx.horizon - 1.5 * p->cloud.h) return 1;
    }
    return 0;
}

/* ---- one state of stress ------------------------------------------------------------------------------- */
/* Makes the first guess of a state of stress: the minimum of the energy over linear fields. For a body that
 * is too soft or too stiff everywhere alike it is the answer, and iterations only find local differences. */
static void start (probe *t, const double *strain)
{
    double A[STATES * STATES], b[STATES], one[STATES];
    memcpy (A, t->A, sizeof A);
    memcpy (b, strain, sizeof b);
    for (size_t v = 0; v < t->nv && !t->out.held && !t->supported; v++) {
        memset (one, 0, sizeof one), one[v] = 1;
        linear_field (t, one, t->stride, t->x);
        b[v] = pg_dot (t->ndof, t->x, t->P);
    }
    int fitted = !t->out.held && !t->supported;
    if (fitted && pg_dense_cholesky ((int) t->nv, A, 1e-14)) memcpy (b, strain, sizeof b);
    else if (fitted) pg_dense_solve ((int) t->nv, A, b);
    linear_field (t, b, t->stride, t->x);
    t->op->apply (t->op->context, t->x, t->r);
    for (size_t i = 0; i < t->ndof; i++) t->r[i] = t->P[i] - t->r[i];
    if (fitted) without (t, t->stride, 0, 0, t->r);
    for (size_t i = 0; i < t->ndof; i++) if (t->inverse[i] == 0) t->r[i] = 0;
}

/* Solves K x = P by conjugate gradients. An iteration reduces the energy of the error by alpha r.z (Hestenes
 * and Stiefel; Strakos and Tichy): they end when six together gain less than 1e-4 of all so far. Returns the
 * sum of these gains. */
static double iterate (probe *t, double scale)
{
    double rz = 0, found = 0, late[DELAY] = { 0 };
    double *p = t->u;
    size_t k;
    for (size_t i = 0; i < t->ndof; i++) p[i] = t->inverse[i] * t->r[i], rz += t->r[i] * p[i];
    for (k = 0; k < t->limit && rz > 0; k++) {
        double curve = 0, alpha, next = 0, of_late = 0;
        t->op->apply (t->op->context, p, t->q);
        for (size_t i = 0; i < t->ndof; i++) curve += p[i] * t->q[i];                  /* p is 0 where held */
        if (!(curve > 0)) break;
        alpha = rz / curve;
        for (size_t i = 0; i < t->ndof; i++) {
            if (t->inverse[i] == 0) continue;
            t->x[i] += alpha * p[i], t->r[i] -= alpha * t->q[i];
            next += t->inverse[i] * t->r[i] * t->r[i];
        }
        found += late[k % DELAY] = alpha * rz;
        for (int l = 0; l < DELAY; l++) of_late += late[l];
        for (size_t i = 0; i < t->ndof; i++) p[i] = t->inverse[i] * t->r[i] + next / rz * p[i];
        rz = next;
        if (k + 1 >= DELAY && of_late < fmax (gain * found, enough * scale)) break;
    }
    t->out.iterations += k;
    if (k == t->limit) t->out.settled = 0;
    return found;
}

/* Adds to x what is missing in K x = P; *energy: as of `iterate`, which a factor makes complete. A residual
 * of the size of rounding is left alone, as soft modes would exaggerate it. Supports on points need
 * iterations. */
static pg_status find_rest (probe *t, double scale, double *energy)
{
    pg_status status = PG_OK;
    *energy = 0;
    if (scale > 0 && !(pg_dot (t->ndof, t->r, t->r) > 1e-22 * pg_dot (t->ndof, t->P, t->P))) return PG_OK;
    if (!t->factor || t->supported) {
        *energy = iterate (t, scale);
        return PG_OK;
    }
    PG_TRY (patch_factor_solve (t->factor, t->r, t->z));
    for (size_t i = 0; i < t->ndof; i++) t->x[i] += t->z[i];
    *energy = pg_dot (t->ndof, t->r, t->z);
done:
    return status;
}

/* Measures the softness: energy of the body under rough forces of unit size, over their number, which has no
 * bound where hardly anything resists some motion. */
static pg_status measure_softness (probe *t)
{
    pg_status status = PG_OK;
    unsigned long long seed = 1;
    double size = 0, energy;
    memset (t->x, 0, t->ndof * sizeof *t->x);
    for (size_t i = 0; i < t->ndof; i++) {
        seed = seed * 6364136223846793005ull + 1442695040888963407ull;
        t->r[i] = t->inverse[i] > 0 ? (seed >> 40 & 1 ? 1 : -1) / sqrt (t->inverse[i]) : 0;
    }
    if (!t->out.held) without (t, t->stride, 0, 0, t->r);
    for (size_t i = 0; i < t->ndof; i++) {
        if (t->inverse[i] == 0) t->r[i] = 0;
        size += t->r[i] * t->r[i] * t->inverse[i];
    }
    /* it tells whether the displacement is converged, which these forces are not part of */
    int settled = t->out.settled;
    PG_TRY (find_rest (t, 0, &energy));
    t->out.settled = settled;
    t->out.softness = energy / size;
done:
    return status;
}

/* Square of a displacement f integrated over the body, m^5. */
static double size_of (const probe *t, const double *f)
{
    double s = 0;
    for (size_t i = 0; i < t->n * t->dim; i++) s += t->p->cloud.volume[i / t->dim] * f[i] * f[i];
    return s;
}

/* Marks supports on points, of a force whose unknowns are displacements of points (nosb): these leave the
 * traction on the facet unbalanced that acts through shape functions of other points, which Nitsche's method
 * does not. Returns 0: there are none. */
static int mark_supports (probe *t, const pg_problem *p)
{
    size_t marked = 0;
    if (!p->method->shape_functions || !p->form.approx.type->interpolates || !t->p->quality.borne) return 0;
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (!pg_load_prescribes (load) || load->essential == PG_ESSENTIAL_NITSCHE || !load->set->nfacet)
            continue;
        for (size_t k = 0; k < t->dim; k++) {
            if (!load->value[k]) continue;
            for (size_t i = 0; i < load->set->npoint; i++)
                t->inverse[(size_t) load->set->point[i] * t->stride + k] = 0, marked++;
            for (size_t i = 0; i < load->set->nfacet; i++)
                t->p->quality.borne[load->set->facet[i]] |= (unsigned char) (1u << k);
        }
    }
    t->supported = marked > 0;
    return t->supported;
}

/* End of the rigid motions, which are numbers nv and on of motion_of: translations and rotations. */
static size_t motions_end (const probe *t) { return t->nv + t->dim + t->dim * (t->dim - 1) / 2; }

static void rigid_field (const probe *t, size_t m, double *out)
{
    motion one = motion_of (t, m);
    memset (out, 0, t->ndof * sizeof *out);
    add_field (t, &one, t->stride, out);
}

static void measure_rigid_motions (probe *t)
{
    double strained = 0;
    for (size_t v = 0; v < t->nv; v++) strained = fmax (strained, t->A[v * t->nv + v]);
    for (size_t m = t->nv; m < motions_end (t) && strained > 0; m++) {
        rigid_field (t, m, t->x);
        t->op->apply (t->op->context, t->x, t->q);
        t->out.rigid = fmax (t->out.rigid, sqrt (fmax (0, pg_dot (t->ndof, t->x, t->q)) / strained));
    }
}

/* Measures the work of the tractions P of a uniform stress in rigid motions, over that of the stress in a
 * strain of the same size: shape functions on the surface that do not reproduce these do work, as do supports
 * by Nitsche's method. Points of bond-type forces lie behind the surface, which is no such error. */
static void measure_rigid_work (probe *t, double volume)
{
    if (t->out.held || t->supported || !t->p->method->shape_functions) return;
    for (size_t m = t->nv; m < motions_end (t); m++) {
        rigid_field (t, m, t->x);
        t->out.rigid = fmax (t->out.rigid, fabs (pg_dot (t->ndof, t->x, t->P)) / volume);
    }
}

/* Finds the node with the largest error of displacement (q: displacement less the linear one). */
static void find_worst (probe *t)
{
    double most = -1;
    for (size_t i = 0; i < t->n; i++) {
        double size = pg_dot (t->dim, t->q + i * t->dim, t->q + i * t->dim);
        if (!(size > most)) continue;
        most = size;
        memcpy (t->out.worst, t->p->cloud.x + i * t->dim, t->dim * sizeof *t->out.worst);
    }
}

/* Measures the error under one state of stress. A bar's displacement about its middle is half of that about
 * its end, from which displacements are commonly counted: the nonlinear part is compared with the latter.
 * Where rows bear loads, their compliance also moves the body, which the work of the tractions shows. */
static pg_status measure_state (probe *t, size_t v)
{
    pg_status status = PG_OK;
    double stress[STATES] = { 0 }, strain[STATES] = { 0 }, D[STATES * STATES], volume = 0, work, exact, whole,
           energy, local, compliance, error;
    int components;
    const char *unit;
    stress[v] = strain[v] = 1;
    memcpy (D, t->p->material->D, t->nv * t->nv * sizeof *D);
    if (pg_dense_cholesky ((int) t->nv, D, 1e-14)) return PG_OK;
    pg_dense_solve ((int) t->nv, D, strain);
    memset (t->P, 0, t->ndof * sizeof *t->P);
    if (!t->out.held) PG_TRY (t->force->surfaces.surface (t->self, stress, t->P));
    for (size_t i = 0; i < t->n; i++) volume += t->p->cloud.volume[i];
    measure_rigid_work (t, volume);
    start (t, strain);
    PG_TRY (find_rest (t, volume * pg_dot (t->nv, stress, strain), &energy));
    linear_field (t, strain, t->stride, t->z);
    work = pg_dot (t->ndof, t->P, t->z);
    linear_field (t, strain, t->dim, t->z);
    exact = size_of (t, t->z);
    PG_TRY (t->force->field (t->self, t->state, t->x, "displacement", &components, &unit, t->u));
    for (size_t i = 0; i < t->n * t->dim; i++) t->q[i] = t->u[i] - t->z[i];
    if (!t->out.held && !t->supported) without (t, t->dim, 1, 0, t->q);
    whole = size_of (t, t->q);
    without (t, t->dim, 1, 1, t->q);
    local = size_of (t, t->q);
    error = sqrt ((whole - 0.75 * local) / exact),
    compliance = t->out.held ? NAN : pg_dot (t->ndof, t->P, t->x) / work - 1;
    if (t->supported) error = 0.5 * sqrt (whole / exact), compliance = NAN;
    if (t->rows) error = fmax (error, fabs (compliance));              /* fmax ignores NAN */
    if (t->out.measured && !(error > (1 + 1e-6) * t->out.error) && !isnan (error)) goto done;
    t->out.measured = 1, t->out.error = isnan (error) ? INFINITY : error, t->out.state = (int) v;
    t->out.compliance = compliance;
    find_worst (t);
done:
    return status;
}

/* ---- the probe ----------------------------------------------------------------------------------------- */
/* Holds the outermost points at their linear field: without loads, and where the body is in several parts,
 * which tractions would leave free to rotate separately. */
static void hold_rim (probe *t)
{
    t->out.held = 1;
    for (size_t i = 0; i < t->n; i++)
        if (outermost (t->p, i)) for (size_t k = 0; k < t->stride; k++) t->inverse[i * t->stride + k] = 0;
}

/* Makes the force on the bare body and its unknowns, and bounds the iterations by their cost. */
static pg_status prepare (probe *t)
{
    pg_status status = PG_OK;
    pg_field field[8];
    size_t stride = 0, nbond = t->p->bonds.first[PG_BOND_SETS];
    PG_TRY (t->force->create (&t->self, t->p));
    for (size_t k = 0, n = t->force->fields (t->self, 8, field); k < n && k < 8; k++)
        stride += (size_t) field[k].components;
    t->n = t->p->cloud.n, t->dim = (size_t) t->p->dim, t->stride = stride, t->ndof = t->n * stride,
    t->nv = (size_t) pg_voigt_size (t->p->dim);
    PG_TRY (pg_state_create (&t->state, t->p, (int) stride));
    if (t->force->refresh) PG_TRY (t->force->refresh (t->self, t->state, NULL));
    t->op = t->force->operator_ (t->self);
    t->limit = (size_t) fmin (MOST, fmax (FEWEST, bonds_paid / ((double) nbond * (double) t->nv)));
    double **arrays[] = { &t->P, &t->x, &t->r, &t->z, &t->q, &t->inverse, &t->u };
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) PG_ALLOC (*arrays[k], t->ndof);
    find_middle (t);
done:
    return status;
}

/* y = K x by the matrix of a probe; `diagonal`: its diagonal, the last entry of each column. */
static void multiply (void *context, const double *x, double *y)
{
    const probe *t = context;
    pg_sparse_multiply (pg_force_matrix (t->force, t->self), x, y);
}

static void diagonal (void *context, double *d)
{
    const probe *t = context;
    const pg_sparse *K = pg_force_matrix (t->force, t->self);
    for (size_t i = 0; i < t->ndof; i++) d[i] = K->value[K->start[i + 1] - 1];
}

/* 1: the body will stay as here, without broken bonds, so that its shape functions are kept for the run; else
 * they would take memory beside those of the run. */
static int lasts (const pg_problem *p)
{
    return !p->plain && p->method->shape_functions && !p->criterion->type && p->crack.given.n == 0;
}

/* 1: the run has the material of the bare body everywhere. */
static int is_uniform (const pg_problem *p) { return p->nmaterial == 1 && p->at.nlaw == 1; }

/* Makes a factor where it costs less than iterations and the body is connected. */
static pg_status make_factor (probe *t, const pg_problem *p, int held)
{
    pg_status status = PG_OK;
    int reused = lasts (p) && is_uniform (p);
    if (held || t->out.fragments || t->out.isolated) return PG_OK;
    PG_TRY (patch_factor_create (&t->factor, t->p, t->force, t->self, t->limit, reused));
    t->product = (pg_operator) { t->ndof, t, multiply, diagonal };
    if (t->factor) t->op = &t->product;
done:
    return status;
}

/* Finds A, K between the fields of unit strains, and the inverse diagonal of K. */
static void measure_unit_strains (probe *t)
{
    for (size_t v = 0; v < t->nv; v++) {
        double one[STATES] = { 0 };
        one[v] = 1;
        linear_field (t, one, t->stride, t->x);
        t->op->apply (t->op->context, t->x, t->q);
        for (size_t w = 0; w < t->nv; w++) {
            one[v] = 0, one[w] = 1;
            linear_field (t, one, t->stride, t->x);
            t->A[w * t->nv + v] = pg_dot (t->ndof, t->x, t->q);
            one[w] = 0;
        }
    }
    t->op->diagonal (t->op->context, t->inverse);
    for (size_t i = 0; i < t->ndof; i++) {
        t->inverse[i] = t->inverse[i] > 0 ? 1 / t->inverse[i] : 0;
        t->turns |= i % t->stride >= t->dim && t->inverse[i] > 0;
    }
}

/* Frees what a probe holds, also one that was made in part only. */
static void clear (probe *t)
{
    pg_free (t->P), pg_free (t->x), pg_free (t->r), pg_free (t->z), pg_free (t->q), pg_free (t->inverse),
        pg_free (t->u);
    pg_state_free (&t->state);
    patch_factor_free (&t->factor);
    if (t->self) t->force->free (&t->self);
}

/* Counts defects of the intact body: points without stress, isolated points, separate parts. */
static pg_status count_defects (probe *t)
{
    const pg_rows *bulk = &t->p->bonds.rows[t->p->form.integration->at_nodes ? PG_NODES : PG_POINTS];
    t->out.points = bulk->n;
    if (!t->force->census) return PG_OK;
    pg_census left = { .at = { t->out.blind[0], t->out.blind[1], t->out.blind[2] } };
    pg_status status = t->force->census (t->self, &left);
    t->out.degenerate = left.degenerate, t->out.isolated = left.isolated, t->out.fragments = left.fragments;
    memcpy (t->out.blind, left.at, sizeof left.at);
    return status;
}

/* Measures the error under each stress, with supports on points that act on facets a second time with these.
 * The worst counts. */
pg_status pg_patch_probe (pg_problem *problem)
{
    pg_status status = PG_OK;
    pg_problem *bare = NULL;
    probe t = { .force = pg_force_of (problem) };
    double start = pg_seconds ();
    t.out = (pg_patch) { .error = NAN, .compliance = NAN, .settled = 1 };
    if (!t.force || !t.force->surfaces.surface || !t.force->operator_ || !t.force->field) return PG_OK;
    if (lasts (problem) && !problem->quality.intact) {
        PG_ALLOC (problem->quality.intact, 1);
        problem->quality.intact->wanted = 1 + is_uniform (problem);
    }
    PG_TRY (pg_problem_bare (&bare, problem));
    t.p = bare, t.rows = borne_by_rows (problem);
    PG_TRY (prepare (&t));
    PG_TRY (count_defects (&t));
    int held = bare->boundary.nload == 0 || (t.out.fragments && !problem->method->shape_functions);
    PG_TRY (make_factor (&t, problem, held));
    measure_unit_strains (&t);
    measure_rigid_motions (&t);
    if (held) hold_rim (&t);
    for (size_t v = 0; v < t.nv; v++) PG_TRY (measure_state (&t, v));
    PG_TRY (measure_softness (&t));
    if (mark_supports (&t, problem)) for (size_t v = 0; v < t.nv; v++) PG_TRY (measure_state (&t, v));
    t.out.seconds = pg_seconds () - start;
    problem->quality.patch = t.out;
done:
    clear (&t);
    if (problem->quality.intact) problem->quality.intact->wanted = 0;
    pg_problem_bare_free (&bare);
    return status;
}
