/* SPDX-License-Identifier: GPL-3.0-or-later
 * Data for the integrals at tips and fronts: the material, and the fields and forces at integration points,
 * in the frame of the front. */
#include "gradient_fit.h"
#include "front.h"
#include <math.h>
#include <string.h>

const char *pg_tip_refuses (const pg_problem *p, const pg_force_type *force)
{
    if (p->dim == 1) return "a body of one dimension has no cracks: set dimension to 2 or 3";
    if (!force->sample) return "the force shows no stress between its points: take another method.force";
    for (size_t m = 0; m < p->nmaterial; m++)
        if (!(p->material[m].type->can & PG_MATERIAL_ISOTROPIC))
            return "their fields are those of an isotropic material: give youngs_modulus and poissons_ratio "
                   "to all materials";
    return NULL;
}

tip_material material_at (const pg_problem *p, size_t node)
{
    const pg_material *law = pg_problem_law (p, PG_NODES, node);
    double kappa = pg_tip_kappa (p->dim == 3 ? PG_PLANE_STRAIN : law->mode, law->nu);
    return (tip_material){ .dim = p->dim,
                           .mu = law->mu,
                           .kappa = kappa,
                           .modulus = 8 * law->mu / (kappa + 1),
                           .density = law->density,
                           .law = law,
                           .lambda = p->form.patches ? p->form.patches->lambda[p->block[PG_NODES][node]]
                                                     : 0 };
}

/* ---- loads --------------------------------------------------------------------------------------------- */
/* Returns 1: the load is a body force on the node. */
static int acts (const pg_load *load, size_t node)
{
    for (size_t i = 0; load->kind == PG_BODY_FORCE && i < load->set->npoint; i++)
        if ((size_t) load->set->point[i] == node) return 1;
    return 0;
}

int has_body_force (const pg_problem *p, size_t node)
{
    for (size_t l = 0; l < p->boundary.nload; l++) if (acts (&p->boundary.load[l], node)) return 1;
    return 0;
}

/* Component c of a load at x in field `at`: its value at t[at], less that at t[0] for the second field. */
static double load_of (const measuring *m, const pg_load *load, int c, const double *x, int at)
{
    double value = pg_load_value (load, c, m->p->dim, x, m->t[at]);
    return at > 0 ? value - pg_load_value (load, c, m->p->dim, x, m->t[0]) : value;
}

static int moves (const measuring *m)
{
    if (m->nfield != 1 || m->d[0] != m->state->d) return 0;
    for (size_t i = 0; i < m->state->ndof; i++)
        if (m->state->v[i] != 0 || m->state->a[i] != 0) return 1;
    return 0;
}

pg_status measuring_check (const measuring *m)
{
    pg_status status = PG_OK;
    const char *refused = pg_tip_refuses (m->p, m->force);
    if (refused) PG_FAIL (PG_E_USAGE, "no stress intensity factors: %s", refused);
    if (m->nfield < 1 || m->nfield > TIP_FIELDS)
        PG_FAIL (PG_E_USAGE, "%d displacement fields at a %s: 1 or 2 can be measured", m->nfield,
                 m->p->dim == 3 ? "front" : "tip");
done:
    return status;
}

pg_status measuring_begin (measuring *m, size_t n, const double *x, double reach)
{
    pg_status status = PG_OK;
    static const double anywhere[3] = { 0 };
    for (int a = 0; a < m->nfield; a++) {
        for (size_t l = 0; l < m->p->boundary.nload; l++)
            if (m->p->boundary.load[l].cracks)
                m->pressure[a] += load_of (m, &m->p->boundary.load[l], 0, anywhere, a);
        PG_TRY (mean_motion_take (&m->field[a], m->p, m->state, m->d[a], n, x, reach));
    }
    m->moving = moves (m);
done:
    return status;
}

void measuring_end (measuring *m)
{
    for (int a = 0; a < TIP_FIELDS; a++) mean_motion_clear (&m->field[a]);
}

/* ---- places -------------------------------------------------------------------------------------------- */
pg_status places_create (front_places *q, size_t most)
{
    pg_status status = PG_OK;
    memset (q, 0, sizeof *q);
    q->capacity = most;
    PG_ALLOC (q->r, most);
    PG_ALLOC (q->theta, most);
    PG_ALLOC (q->area, most);
    PG_ALLOC (q->x, 3 * most);
    PG_ALLOC (q->of, most);
done:
    if (status != PG_OK) places_clear (q);
    return status;
}

void places_clear (front_places *q)
{
    for (int a = 0; a < TIP_FIELDS; a++) {
        front_sample *f = &q->field[a];
        pg_free (f->u), pg_free (f->H), pg_free (f->S), pg_free (f->excess), pg_free (f->load);
        pg_free (f->kinetic), pg_free (f->moving);
    }
    pg_free (q->r), pg_free (q->theta), pg_free (q->area), pg_free (q->x), pg_free (q->of);
    pg_free (q->stress), pg_free (q->gradient);
    memset (q, 0, sizeof *q);
}

/* Allocates an array with `each` numbers per point, if not yet done. */
static pg_status make_room (double **array, const front_places *q, size_t each)
{
    pg_status status = PG_OK;
    if (!*array) PG_ALLOC (*array, each * q->capacity);
done:
    return status;
}

/* A gradient (dim x dim) as a 3 x 3 tensor; stress_tensor: a stress xx yy zz xy yz zx (2D: in-plane
 * components only). */
static void gradient_tensor (size_t dim, const double *G, double T[9])
{
    memset (T, 0, 9 * sizeof *T);
    for (size_t c = 0; c < dim; c++) memcpy (T + 3*c, G + dim * c, dim * sizeof *T);
}

static void stress_tensor (size_t dim, const double *s, double T[9])
{
    const double full[9] = { s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2] },
                 plane[9] = { s[0], s[3], 0, s[3], s[1] };
    memcpy (T, dim == 3 ? full : plane, 9 * sizeof *T);
}

/* Mean normal stress of s less that of the gradient G, Pa. */
static double excess_of (int dim, const tip_material *m, const double *s, const double *G)
{
    double full[6];
    pg_stress_of_gradient (m->law, dim, G, full);
    return dim == 3 ? (s[0] + s[1] + s[2] - full[0] - full[1] - full[2]) / 3
                    : 0.5 * (s[0] + s[1] - full[0] - full[1]);
}

pg_status places_sample (front_places *q, const measuring *m, int a)
{
    pg_status status = PG_OK;
    front_sample *f = &q->field[a];
    size_t dim = (size_t) m->p->dim;
    PG_TRY (make_room (&q->stress, q, 6));
    PG_TRY (make_room (&q->gradient, q, 9));
    PG_TRY (make_room (&f->u, q, 3));
    PG_TRY (make_room (&f->H, q, 9));
    PG_TRY (make_room (&f->S, q, 9));
    if (m->p->form.patches) PG_TRY (make_room (&f->excess, q, 1));
    if (f->load) memset (f->load, 0, 3 * q->n * sizeof *f->load);
    PG_TRY (gradient_sample (m->p, m->force, m->self, m->state, m->field[a].d, q->n, q->x, f->u, q->stress,
                             q->gradient));
    for (size_t k = 0; k < q->n; k++) {
        const cross_section *at = &m->section[q->of[k]];
        double moved[3] = { 0 }, T[9];
        mean_motion_at (&m->field[a], q->x + dim * k, m->p->dim, moved);
        for (size_t c = 0; c < 3; c++) f->u[3*k + c] += moved[c];
        gradient_tensor (dim, q->gradient + 9*k, T), front_turn_tensor (at->at.frame, T, f->H + 9*k);
        stress_tensor (dim, q->stress + 6*k, T), front_turn_tensor (at->at.frame, T, f->S + 9*k);
        if (f->excess && at->material.lambda > 0)
            f->excess[k] = excess_of (m->p->dim, &at->material, q->stress + 6*k, q->gradient + 9*k);
    }
done:
    return status;
}

pg_status places_force (front_places *q, const measuring *m, int a)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) m->p->dim;
    double *load;
    PG_TRY (make_room (&q->field[a].load, q, 3));
    load = q->field[a].load;
    for (size_t l = 0; l < m->p->boundary.nload; l++) {
        const pg_load *one = &m->p->boundary.load[l];
        size_t section = SIZE_MAX;
        int here = 0;
        for (size_t k = 0; k < q->n; k++) {
            const cross_section *s = &m->section[q->of[k]];
            double b[3] = { 0 }, turned[3];
            if (q->of[k] != section) section = q->of[k], here = acts (one, s->node);
            if (!here) continue;
            for (size_t c = 0; c < dim; c++)
                b[c] = load_of (m, one, (int) c, q->x + dim * k, a)
                       * pg_load_density (m->p, one, PG_NODES, s->node);
            front_turn_vector (s->at.frame, b, turned);
            for (size_t c = 0; c < 3; c++) load[3*k + c] += turned[c];
        }
    }
done:
    return status;
}

/* Adds the uniform stress p to a field, which frees crack faces of the pressure p: J and K are unchanged, T
 * is larger by p. The strain is p / (3 lambda + 2 mu) in all directions, in 2D p / (2 k), k = 2 mu / (kappa -
 * 1) the modulus of in-plane dilatation. */
static void free_faces (const tip_material *m, double pressure, double *H, double *S)
{
    double nu = 0.25 * (3 - m->kappa), strain = m->dim == 3
                                                    ? pressure * (1 - 2 * nu) / (2 * m->mu * (1 + nu))
                                                    : pressure * (m->kappa - 1) / (4 * m->mu);
    for (int i = 0; i < m->dim; i++) H[4*i] += strain, S[4*i] += pressure;
}

/* Frees faces in contact of their tractions by subtracting the uniform stress sigma_22, sigma_12, sigma_23
 * (frame components) and its strain, without rotation. K_II and K_III of the rest are those of the front, and
 * K_I is zero. */
static void part_faces (const tip_material *m, const double stress[3], double *H, double *S)
{
    double nu = 0.25 * (3 - m->kappa), E = 2 * m->mu * (1 + nu), along = (m->kappa - 3) * stress[0]
                                                                         / (8 * m->mu),
           across = (m->kappa + 1) * stress[0] / (8 * m->mu);
    if (m->dim == 3) along = -nu * stress[0] / E, across = stress[0] / E, H[8] -= along;
    H[0] -= along, H[4] -= across, S[4] -= stress[0];
    for (int a = 0; a < m->dim - 1; a++) {             /* 1 2, then 2 3 */
        int one = a ? 5 : 1, other = a ? 7 : 3;
        H[one] -= stress[1 + a] / (2 * m->mu), H[other] -= stress[1 + a] / (2 * m->mu);
        S[one] -= stress[1 + a], S[other] -= stress[1 + a];
    }
}

void places_part (front_places *q, const measuring *m, int a, size_t k)
{
    const cross_section *s = &m->section[q->of[k]];
    double *H = q->field[a].H + 9*k, *S = q->field[a].S + 9*k;
    if (s->closed) part_faces (&s->material, s->stress[a], H, S);
    if (m->pressure[a] != 0) free_faces (&s->material, m->pressure[a], H, S);
}

/* Adds inertia: - rho a to the loads, rho v_i v_i,1, and the kinetic energy, which is integrated together
 * with W. */
static pg_status add_inertia (front_places *q, const measuring *m)
{
    pg_status status = PG_OK;
    front_sample *f = &q->field[0];
    size_t n = q->n, dim = (size_t) m->p->dim;
    double *v = q->stress;
    PG_TRY (make_room (&f->kinetic, q, 1));
    PG_TRY (make_room (&f->moving, q, 1));
    PG_TRY (make_room (&f->load, q, 3));
    PG_TRY (gradient_sample (m->p, m->force, m->self, m->state, m->state->v, n, q->x, v, NULL, q->gradient));
    for (size_t k = 0; k < n; k++) {
        const cross_section *s = &m->section[q->of[k]];
        double sum = 0, square = 0;
        for (size_t c = 0; c < dim; c++) {             /* v_i v_i,1, with the derivative along e */
            double along = 0;
            for (size_t j = 0; j < dim; j++) along += q->gradient[9*k + dim * c + j] * s->at.frame[j];
            sum += v[3*k + c] * along, square += v[3*k + c] * v[3*k + c];
        }
        f->kinetic[k] = s->material.density * sum;
        f->moving[k] = 0.5 * s->material.density * square;
    }
    PG_TRY (gradient_sample (m->p, m->force, m->self, m->state, m->state->a, n, q->x, v, NULL, NULL));
    for (size_t k = 0; k < n; k++) {
        const cross_section *s = &m->section[q->of[k]];
        double a[3] = { 0 }, turned[3];
        memcpy (a, v + 3*k, dim * sizeof *a);
        front_turn_vector (s->at.frame, a, turned);
        for (size_t c = 0; c < 3; c++) f->load[3*k + c] -= s->material.density * turned[c];
    }
done:
    return status;
}

pg_status places_fields (front_places *q, const measuring *m, int forced, int moving)
{
    pg_status status = PG_OK;
    if (q->n == 0) return PG_OK;
    for (int a = 0; a < m->nfield; a++) {
        PG_TRY (places_sample (q, m, a));
        if (forced) PG_TRY (places_force (q, m, a));
        for (size_t k = 0; k < q->n; k++) places_part (q, m, a, k);
    }
    if (moving) PG_TRY (add_inertia (q, m));
done:
    return status;
}

/* ---- results ------------------------------------------------------------------------------------------- */
void measured_nothing (pg_tip_field *out)
{
    double none[PG_TIP_NUMBERS];
    for (int q = 0; q < PG_TIP_NUMBERS; q++) none[q] = NAN;
    memcpy (out, none, sizeof none);
}

void pg_tip_energy (const pg_tip_field *f, int nfield, double K[3][2], double J[2][2])
{
    for (int a = 0; a < nfield; a++)
        for (int b = 0; b < nfield; b++)
            J[a][b] = (K[0][a] * K[0][b] + K[1][a] * K[1][b] + f->antiplane * K[2][a] * K[2][b]) / f->modulus;
}

void measured_closed (pg_tip_field *out, int nfield)
{
    out->closed = 1;
    for (int a = 0; a < nfield; a++) {
        out->K[0][a] = out->K_wide[0][a] = 0, out->T[a] = NAN;
        for (int b = 0; b < nfield; b++) out->J_near[a][b] = NAN;      /* no second ring to compare with */
    }
    pg_tip_energy (out, nfield, out->K_wide, out->J);
}

/* ---- sums of the fields -------------------------------------------------------------------------------- */
void pg_tip_combine (const pg_tip_field *f, int nfield, const double *l, double *J, double *K, double *T)
{
    if (J) *J = 0;
    if (T) *T = 0;
    for (int m = 0; K && m < 3; m++) K[m] = 0;
    for (int a = 0; a < nfield; a++) {
        for (int b = 0; J && b < nfield; b++) *J += l[a] * l[b] * f->J[a][b];
        for (int m = 0; K && m < 3; m++) K[m] += l[a] * f->K[m][a];
        if (T) *T += l[a] * f->T[a];
    }
}

/* In 3D, with s the fraction of modes II and III in size^2, K^2 becomes K^2 ((1 - s) E' J / size^2 + s): the
 * effective position of a sliding front is some tenths of a spacing further ahead, which changes J, but K
 * about the drawn position not to first order (doc/method.md, "The front of a crack in space"). */
void pg_tip_intensities (const pg_tip_field *f, int nfield, const double *l, double *K)
{
    double J, size = 0, share = 0;
    pg_tip_combine (f, nfield, l, &J, K, NULL);
    size = K[0] * K[0] + K[1] * K[1] + f->antiplane * K[2] * K[2];
    if (!(J > 0) || !(size > 0)) return;
    if (f->antiplane > 0) share = 1 - K[0] * K[0] / size;
    double scale = sqrt ((1 - share) * f->modulus * J / size + share);
    for (int m = 0; m < 3; m++) K[m] *= scale;
}

double pg_tip_uncertainty (const pg_tip_field *f, int nfield, const double *l)
{
    double J = 0, near = 0;
    /* Rings of equal width (up to rounding) give no uncertainty. */
    if (!(f->wide > f->near * (1 + 1e-6))) return NAN;
    for (int a = 0; a < nfield; a++)
        for (int b = 0; b < nfield; b++) J += l[a] * l[b] * f->J[a][b], near += l[a] * l[b] * f->J_near[a][b];
    return fabs (J - near) / fabs (J);
}
