/* SPDX-License-Identifier: GPL-3.0-or-later
 * The patch test of a discretisation (Irons): under the tractions of a uniform stress its displacement should be linear. What is measured is
 * that of the body as it is, whatever makes the difference: families cut by the surface, quadrature, modes without energy, rows that bear loads. */
#include "solve.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { STATES = 6, DELAY = 6, FEWEST = 12, MOST = 3000 };
static const double gain = 1e-4, enough = 1e-7;        /* of the energy of the error found so far; of the linear field's  */
static const double bonds_paid = 3e8;                  /* visits of bonds that all iterations together may cost           */

typedef struct {
    const pg_problem *p;
    const pg_force_type *force;
    void     *self;
    pg_state *state;
    size_t    n, dim, stride, ndof, nv;
    const pg_operator *op;
    double   *field, *Kfield, *P;                      /* linear fields of unit strains, K of them, tractions of a state */
    double   *x, *r, *z, *q, *inverse, *u;             /* inverse: of the diagonal; 0: held                              */
    size_t    limit;
    int       rows;                                    /* loads and supports are borne by the outermost rows             */
    pg_patch  out;
} probe;

/* ---- fields -------------------------------------------------------------------------------------------------------------- */
/* Of unit strain v (engineering shear) about the origin `c` */
static void linear_field (const probe *t, size_t v, const double *c, double *out)
{
    static const int pair[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 1, 2 }, { 2, 0 } };
    const int *of = t->dim == 2 && v == 2 ? pair[3] : pair[v];
    memset (out, 0, t->ndof * sizeof *out);
    for (size_t i = 0; i < t->n; i++) {
        const double *x = t->p->cloud.x + i * t->dim;
        double *d = out + i * t->stride;
        double share = of[0] == of[1] ? 1 : 0.5;
        d[of[0]] = share * (x[of[1]] - c[of[1]]);
        if (of[0] != of[1]) d[of[1]] = share * (x[of[0]] - c[of[0]]);
    }
}

static double dot (size_t n, const double *a, const double *b)
{
    double s = 0;
    for (size_t i = 0; i < n; i++) s += a[i] * b[i];
    return s;
}

static void middle (const pg_problem *p, double *c)
{
    double all = 0;
    size_t dim = (size_t) p->dim;
    memset (c, 0, 3 * sizeof *c);
    for (size_t i = 0; i < p->cloud.n; i++) {
        all += p->cloud.volume[i];
        for (size_t k = 0; k < dim; k++) c[k] += p->cloud.volume[i] * p->cloud.x[i * dim + k];
    }
    for (size_t k = 0; k < dim; k++) c[k] /= all;
}

/* Motion number m, of stride numbers a point: rigid ones (translations, then turns), then linear ones. Rotations of points are the spacing times
 * the angle. 0: there are no more. */
static int mode_number (const probe *t, size_t m, const double *c, size_t stride, double *out)
{
    static const int plane[3][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 } };
    size_t turns = t->dim == 3 ? 3 : t->dim == 2 ? 1 : 0, axis = m - t->dim;
    memset (out, 0, t->n * stride * sizeof *out);
    for (size_t i = 0; i < t->n; i++) {
        const double *x = t->p->cloud.x + i * t->dim;
        double *d = out + i * stride;
        if (m < t->dim) d[m] = 1;
        else if (m < t->dim + turns) {
            const int *ab = plane[axis];
            d[ab[0]] = -(x[ab[1]] - c[ab[1]]), d[ab[1]] = x[ab[0]] - c[ab[0]];
            if (stride > t->dim) d[t->dim + (t->dim == 2 ? 0 : (axis + 2) % 3)] = t->p->cloud.h;
        } else for (size_t k = 0; k < t->dim; k++) d[k] = t->field[(m - t->dim - turns) * t->ndof + i * t->stride + k];
    }
    return m + 1 < t->dim + turns + t->nv;
}

/* Takes rigid motions out of f, and with linear the linear ones as well, by weights of points (NULL: 1). */
static pg_status without (const probe *t, size_t stride, const double *weight, int linear, double *f)
{
    pg_status status = PG_OK;
    double *mode = NULL, c[3];
    size_t n = t->n * stride, most = t->dim * (t->dim + 1) / 2 + (linear ? t->nv : 0);
    middle (t->p, c);
    PG_ALLOC (mode, n * most);
    for (size_t m = 0; m < most; m++) {
        double *a = mode + m * n;
        mode_number (t, m, c, stride, a);
        for (size_t l = 0; l <= m; l++) {              /* orthogonal to those before it; the last round takes it out of f  */
            const double *b = mode + l * n;
            double *of = l < m ? a : f, up = 0, down = 0;
            for (size_t i = 0; i < n; i++) {
                double w = weight ? weight[i / stride] : 1;
                up += w * of[i] * b[i], down += w * b[i] * b[i];
            }
            for (size_t i = 0; i < n && down > 0; i++) of[i] -= up / down * b[i];
        }
    }
done:
    pg_free (mode);
    return status;
}

/* ---- points at the rim, where there are no facets ---------------------------------------------------------------------------- */
/* Neighbours within 1.6 spacings leave one side open. */
static int outermost (const pg_problem *p, size_t i)
{
    const pg_family *f = &p->rows[PG_NODES].family;
    size_t dim = (size_t) p->dim;
    double h = pg_problem_spacing (p, PG_NODES, i), sum[3] = { 0 }, count = 0, open = 0;
    for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
        double xi[3] = { 0 }, r = 0;
        for (size_t k = 0; k < dim; k++) xi[k] = p->cloud.x[(size_t) f->node[e] * dim + k] - p->cloud.x[i * dim + k], r += xi[k] * xi[k];
        r = sqrt (r);
        if (!(r > 0.1 * h) || r > 1.6 * h) continue;
        count++;
        for (size_t k = 0; k < dim; k++) sum[k] += xi[k] / r;
    }
    for (size_t k = 0; k < dim; k++) open += sum[k] * sum[k];
    return sqrt (open) > 0.2 * count || count < (double) dim;
}

/* Direct forces: is there a load or support that a set no deeper than a horizon bears? Those on facets of other forces are as thin as these. */
static int borne_by_rows (const pg_problem *p)
{
    size_t dim = (size_t) p->dim;
    if (!p->direct) return 1;
    for (size_t l = 0; l < p->nload; l++) {
        const pg_set *set = p->load[l].set;
        double least = INFINITY;
        if (p->load[l].kind == PG_TRACTION || p->load[l].kind == PG_PRESSURE) return 1;
        for (size_t k = 0; k < dim; k++) {
            double low = INFINITY, high = -INFINITY;
            for (size_t i = 0; i < set->npoint; i++) {
                double x = p->cloud.x[(size_t) set->point[i] * dim + k];
                low = fmin (low, x), high = fmax (high, x);
            }
            least = fmin (least, high - low);
        }
        if (least < p->approx.horizon - 1.5 * p->cloud.h) return 1;
    }
    return 0;
}

/* ---- one state of stress ------------------------------------------------------------------------------------------------------- */
/* The strain energy's minimum over linear fields starts it: in a body that is too soft or too stiff everywhere alike it is the answer. */
static pg_status start (probe *t, const double *strain)
{
    pg_status status = PG_OK;
    double A[STATES * STATES], b[STATES];
    memset (t->x, 0, t->ndof * sizeof *t->x);
    for (size_t v = 0; v < t->nv; v++) {
        b[v] = t->out.held ? strain[v] : dot (t->ndof, t->field + v * t->ndof, t->P);
        for (size_t w = 0; w < t->nv; w++) A[v * t->nv + w] = dot (t->ndof, t->field + v * t->ndof, t->Kfield + w * t->ndof);
    }
    if (!t->out.held) {
        if (pg_dense_cholesky ((int) t->nv, A, 1e-14)) memcpy (b, strain, t->nv * sizeof *b);
        else pg_dense_solve ((int) t->nv, A, b);
    }
    memcpy (t->r, t->P, t->ndof * sizeof *t->r);
    for (size_t v = 0; v < t->nv; v++)
        for (size_t i = 0; i < t->ndof; i++) t->x[i] += b[v] * t->field[v * t->ndof + i], t->r[i] -= b[v] * t->Kfield[v * t->ndof + i];
    if (!t->out.held) PG_TRY (without (t, t->stride, NULL, 0, t->r));
    for (size_t i = 0; i < t->ndof; i++) if (t->inverse[i] == 0) t->r[i] = 0;
done:
    return status;
}

/* Conjugate gradients; what an iteration takes off the energy of the error tells when to stop (Hestenes and Stiefel; Strakos and Tichy). */
static void iterate (probe *t, double scale)
{
    double rz = 0, found = 0, late[DELAY] = { 0 };
    double *p = t->u;
    size_t k;
    for (size_t i = 0; i < t->ndof; i++) p[i] = t->inverse[i] * t->r[i], rz += t->r[i] * p[i];
    for (k = 0; k < t->limit && rz > 0; k++) {
        t->op->apply (t->op->context, p, t->q);
        for (size_t i = 0; i < t->ndof; i++) if (t->inverse[i] == 0) t->q[i] = 0;
        double curve = dot (t->ndof, p, t->q), alpha, next = 0, of_late = 0;
        if (!(curve > 0)) break;
        alpha = rz / curve;
        for (size_t i = 0; i < t->ndof; i++) {
            t->x[i] += alpha * p[i], t->r[i] -= alpha * t->q[i];
            t->z[i] = t->inverse[i] * t->r[i], next += t->r[i] * t->z[i];
        }
        found += late[k % DELAY] = alpha * rz;
        for (int l = 0; l < DELAY; l++) of_late += late[l];
        for (size_t i = 0; i < t->ndof; i++) p[i] = t->z[i] + next / rz * p[i];
        rz = next;
        if (k + 1 >= DELAY && of_late < fmax (gain * found, enough * scale)) break;
    }
    t->out.iterations += k;
    if (k == t->limit) t->out.settled = 0;
}

static double size_of (const probe *t, const double *f)
{
    double s = 0;
    for (size_t i = 0; i < t->n * t->dim; i++) s += t->p->cloud.volume[i / t->dim] * f[i] * f[i];
    return s;
}

/* A bar's displacement has half the size about its middle that it has about its end, from which displacements are commonly counted: what is not
 * linear in the error is measured against that. Held or read off where it bears loads, the body moves by what its surface gives way: that is in
 * the work of the tractions. */
static pg_status measure_state (probe *t, size_t v)
{
    pg_status status = PG_OK;
    double stress[6] = { 0 }, strain[6] = { 0 }, D[STATES * STATES], square = 0, exact = 0, c[3];
    int components;
    const char *unit;
    const pg_material *m = t->p->material;
    middle (t->p, c);
    stress[v] = 1;
    memcpy (D, m->D, t->nv * t->nv * sizeof *D);
    memcpy (strain, stress, sizeof strain);
    if (pg_dense_cholesky ((int) t->nv, D, 1e-14)) return PG_OK;
    pg_dense_solve ((int) t->nv, D, strain);
    memset (t->P, 0, t->ndof * sizeof *t->P);
    if (!t->out.held) PG_TRY (t->force->surface (t->self, stress, t->P));
    PG_TRY (start (t, strain));
    memset (t->z, 0, t->ndof * sizeof *t->z);
    for (size_t w = 0; w < t->nv; w++) for (size_t i = 0; i < t->ndof; i++) t->z[i] += strain[w] * t->field[w * t->ndof + i];
    double scale = 0, work = dot (t->ndof, t->P, t->z), all = 0;
    for (size_t i = 0; i < t->n; i++) all += t->p->cloud.volume[i];
    for (size_t w = 0; w < t->nv; w++) scale += all * stress[w] * strain[w];
    iterate (t, scale);
    PG_TRY (t->force->field (t->self, t->state, t->x, "displacement", &components, &unit, t->u));
    for (size_t i = 0; i < t->n * t->dim; i++) t->z[i] = 0;
    for (size_t w = 0; w < t->nv; w++)
        for (size_t i = 0; i < t->n; i++) for (size_t k = 0; k < t->dim; k++) t->z[i * t->dim + k] += strain[w] * t->field[w * t->ndof + i * t->stride + k];
    for (size_t i = 0; i < t->n * t->dim; i++) {
        exact += t->p->cloud.volume[i / t->dim] * t->z[i] * t->z[i];
        t->q[i] = t->u[i] - t->z[i];
    }
    if (!t->out.held) PG_TRY (without (t, t->dim, t->p->cloud.volume, 0, t->q));
    all = size_of (t, t->q);
    PG_TRY (without (t, t->dim, t->p->cloud.volume, 1, t->q));
    square = size_of (t, t->q);
    double error = sqrt ((all - 0.75 * square) / exact), compliance = t->out.held ? NAN : dot (t->ndof, t->P, t->x) / work - 1;
    if (t->rows) error = fmax (error, fabs (compliance));              /* fmax passes NAN by                             */
    if (t->out.measured && !(error > (1 + 1e-6) * t->out.error) && !isnan (error)) goto done;
    t->out.measured = 1, t->out.error = isnan (error) ? INFINITY : error, t->out.state = (int) v;
    t->out.compliance = compliance;
done:
    return status;
}

/* ---- the probe --------------------------------------------------------------------------------------------------------------------- */
static pg_status prepare (probe *t)
{
    pg_status status = PG_OK;
    pg_field field[8];
    double c[3];
    size_t stride = 0, nbond = t->p->first_bond[PG_BOND_SETS];
    PG_TRY (t->force->create (&t->self, t->p));
    for (size_t k = 0, n = t->force->fields (t->self, 8, field); k < n && k < 8; k++) stride += (size_t) field[k].components;
    t->n = t->p->cloud.n, t->dim = (size_t) t->p->dim, t->stride = stride, t->ndof = t->n * stride, t->nv = (size_t) pg_voigt_size (t->p->dim);
    PG_TRY (pg_state_create (&t->state, t->p, (int) stride));
    if (t->force->refresh) PG_TRY (t->force->refresh (t->self, t->state, NULL));
    t->op = t->force->operator_ (t->self);
    t->limit = (size_t) fmin (MOST, fmax (FEWEST, bonds_paid / ((double) nbond * (double) t->nv)));
    double **arrays[] = { &t->P, &t->x, &t->r, &t->z, &t->q, &t->inverse, &t->u };
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) PG_ALLOC (*arrays[k], t->ndof);
    PG_ALLOC (t->field, t->nv * t->ndof);
    PG_ALLOC (t->Kfield, t->nv * t->ndof);
    middle (t->p, c);
    for (size_t v = 0; v < t->nv; v++) {
        linear_field (t, v, c, t->field + v * t->ndof);
        t->op->apply (t->op->context, t->field + v * t->ndof, t->Kfield + v * t->ndof);
    }
    t->op->diagonal (t->op->context, t->inverse);
    for (size_t i = 0; i < t->ndof; i++) t->inverse[i] = t->inverse[i] > 0 ? 1 / t->inverse[i] : 0;
    t->out.held = t->p->nload == 0;
    for (size_t i = 0; t->out.held && i < t->n; i++)
        if (outermost (t->p, i)) for (size_t k = 0; k < stride; k++) t->inverse[i * stride + k] = 0;
done:
    return status;
}

static void clear (probe *t)
{
    pg_free (t->P), pg_free (t->x), pg_free (t->r), pg_free (t->z), pg_free (t->q), pg_free (t->inverse), pg_free (t->u), pg_free (t->field), pg_free (t->Kfield);
    pg_state_free (&t->state);
    if (t->self) t->force->free (&t->self);
}

/* What the intact body lacks: points that carry no stress, and parts that hang together by nothing. */
static void count_defects (probe *t)
{
    const pg_rows *bulk = &t->p->rows[t->p->direct || t->p->integration->at_nodes ? PG_NODES : PG_POINTS];
    t->out.points = bulk->n;
    if (t->force->census) t->force->census (t->self, &t->out.degenerate, &t->out.isolated, &t->out.fragments);
}

pg_status pg_patch_probe (pg_problem *problem)
{
    pg_status status = PG_OK;
    pg_problem *bare = NULL;
    probe t = { .force = pg_force_find (problem->force) };
    double start = pg_seconds ();
    t.out = (pg_patch) { .error = NAN, .compliance = NAN, .settled = 1 };
    if (!t.force || !t.force->surface || !t.force->operator_ || !t.force->field) return PG_OK;
    PG_TRY (pg_problem_bare (&bare, problem));
    t.p = bare, t.rows = borne_by_rows (problem);
    PG_TRY (prepare (&t));
    count_defects (&t);
    for (size_t v = 0; v < t.nv; v++) PG_TRY (measure_state (&t, v));
    t.out.seconds = pg_seconds () - start;
    problem->patch = t.out;
done:
    clear (&t);
    pg_problem_bare_free (&bare);
    return status;
}
