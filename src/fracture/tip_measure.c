/* SPDX-License-Identifier: GPL-3.0-or-later
 * J, K_I, K_II and T of one tip: its rings, the fields there, the integrals. */
#include "gradient_fit.h"
#include "tip.h"
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

static tip_material material_at (const pg_problem *p, size_t node)
{
    int block = p->block[PG_NODES][node];
    const pg_material *m = pg_problem_law (p, PG_NODES, node);
    double kappa = pg_tip_kappa (m->mode, m->nu);
    return (tip_material){ .mu = m->mu,
                           .kappa = kappa,
                           .modulus = 8 * m->mu / (kappa + 1),
                           .density = m->density,
                           .law = m,
                           .lambda = p->patches ? p->patches->lambda[block] : 0 };
}

/* ---- what acts inside the rings ------------------------------------------------------------------------ */
/* Does load l act on the body around the node? */
static int acts (const pg_load *load, size_t node)
{
    if (load->kind != PG_BODY_FORCE) return 0;
    for (size_t i = 0; i < load->set->npoint; i++)
        if ((size_t) load->set->point[i] == node) return 1;
    return 0;
}

int tip_has_body_force (const pg_problem *p, size_t node)
{
    for (size_t l = 0; l < p->nload; l++) if (acts (&p->load[l], node)) return 1;
    return 0;
}

/* b of field `at`: that of factor t[at], less that of t[0] for the second. */
pg_status tip_add_body_force (tip_grid *grid, int at, const pg_tip_field *tip, const pg_problem *p,
                              size_t node, const double *t)
{
    pg_status status = PG_OK;
    tip_sample *f = &grid->field[at];
    if (!f->load) PG_ALLOC (f->load, 2 * grid->n);
    for (size_t l = 0; l < p->nload; l++) {
        const pg_load *load = &p->load[l];
        if (!acts (load, node)) continue;
        for (size_t k = 0; k < grid->n; k++) {
            double b[2], turned[2];
            for (int c = 0; c < 2; c++) {
                b[c] = pg_load_value (load, c, 2, grid->x + 2*k, t[at]);
                if (at > 0) b[c] -= pg_load_value (load, c, 2, grid->x + 2*k, t[0]);
                b[c] *= pg_load_density (p, load, PG_NODES, node);
            }
            tip_turn (tip->e, b, turned);
            f->load[2*k] += turned[0], f->load[2*k + 1] += turned[1];
        }
    }
done:
    return status;
}

/* Pressure in the cracks in field `at`: of t[at], less that of t[0] for the second. */
double tip_pressure (const pg_problem *p, int at, const double *t)
{
    static const double anywhere[3] = { 0 };
    double sum = 0;
    for (size_t l = 0; l < p->nload; l++) {
        if (!p->load[l].cracks) continue;
        sum += pg_load_value (&p->load[l], 0, 2, anywhere, t[at]);
        if (at > 0) sum -= pg_load_value (&p->load[l], 0, 2, anywhere, t[0]);
    }
    return sum;
}

/* A uniform pressure in the whole body, subtracted, leaves faces that are free: J, K_I and K_II are the same,
 * the stress along the crack is larger by it. Its strain is p / (2 k), k = 2 mu / (kappa - 1) the modulus of
 * in-plane dilatation. */
static void free_faces (tip_grid *grid, int at, const tip_material *m, double pressure)
{
    tip_sample *f = &grid->field[at];
    double strain = pressure * (m->kappa - 1) / (4 * m->mu);
    for (size_t k = 0; k < grid->n; k++) {
        f->H[4*k] += strain, f->H[4*k + 3] += strain;
        f->stress[3*k] += pressure, f->stress[3*k + 1] += pressure;
    }
}

/* Frees faces that touch of their tractions: the uniform stress sigma_22 = -p, sigma_12 = tau of the frame,
 * sigma_11 = 0, is subtracted, without its rotation (Hooke's law by mu and kappa). */
static void part_faces (tip_grid *grid, int at, const tip_material *m, const double *stress)
{
    tip_sample *f = &grid->field[at];
    double along = (m->kappa - 3) * stress[0] / (8 * m->mu),
           across = (m->kappa + 1) * stress[0] / (8 * m->mu),
           shear = stress[1] / (2 * m->mu);
    for (size_t k = 0; k < grid->n; k++) {
        f->H[4*k] -= along, f->H[4*k + 3] -= across, f->H[4*k + 1] -= shear, f->H[4*k + 2] -= shear;
        f->stress[3*k + 1] -= stress[0], f->stress[3*k + 2] -= stress[1];
    }
}

/* Of a closed tip: it does not open, and what it sets free is what sliding does. */
static void close_tip (pg_tip_field *out, int nfield)
{
    out->closed = 1;
    for (int a = 0; a < nfield; a++) {
        out->K[0][a] = out->K_wide[0][a] = 0, out->K[1][a] = out->K_wide[1][a], out->T[a] = NAN;
        for (int b = 0; b < nfield; b++) {
            out->J[a][b] = out->K_wide[1][a] * out->K_wide[1][b] / out->modulus;
            out->J_near[a][b] = NAN;                   /* one ring: nothing to compare it with */
        }
    }
}

/* Rings of an open tip hold no closed face. */
static void limit_rings (pg_tip_field *out, const pg_problem *p, const pg_tip_faces *faces)
{
    if (faces->nearest < out->room) out->room = faces->nearest, out->limit = PG_ROOM_FACES, out->load = -1;
    if (!(faces->nearest < out->wide)) return;
    out->wide = faces->nearest, out->near = fmin (out->near, faces->nearest);
    if (!tip_is_ring (p, out->near, out->h)) out->near = out->wide = NAN;
}

static int moves (const pg_state *state)
{
    for (size_t i = 0; i < state->ndof; i++) if (state->v[i] != 0 || state->a[i] != 0) return 1;
    return 0;
}

/* - rho a into the loads, rho v_i v_i,1, and the kinetic energy into the term of W: W and T stand together,
 * so that the gradient of the weight sees both. */
static pg_status add_inertia (tip_grid *grid, const pg_tip_field *tip, const tip_material *m,
                              const pg_problem *p, const pg_force_type *force, void *self,
                              const pg_state *state)
{
    pg_status status = PG_OK;
    tip_sample *f = &grid->field[0];
    size_t n = grid->n;
    double *v = NULL, *gradient = NULL;
    PG_ALLOC (v, 3 * n);
    PG_ALLOC (gradient, 9 * n);
    PG_ALLOC (f->kinetic, n);
    PG_ALLOC (f->moving, n);
    if (!f->load) PG_ALLOC (f->load, 2 * n);
    PG_TRY (gradient_sample (p, force, self, state, state->v, n, grid->x, v, NULL, gradient));
    for (size_t k = 0; k < n; k++) {
        const double *H = gradient + 9*k, *u = v + 3*k;
        /* v_i v_i,1, the derivative being along e */
        f->kinetic[k] = m->density * (u[0] * (H[0] * tip->e[0] + H[1] * tip->e[1])
                                      + u[1] * (H[2] * tip->e[0] + H[3] * tip->e[1]));
        f->moving[k] = 0.5 * m->density * (u[0] * u[0] + u[1] * u[1]);
    }
    PG_TRY (gradient_sample (p, force, self, state, state->a, n, grid->x, v, NULL, NULL));
    for (size_t k = 0; k < n; k++) {
        double a[2];
        tip_turn (tip->e, v + 3*k, a);
        f->load[2*k] -= m->density * a[0], f->load[2*k + 1] -= m->density * a[1];
    }
done:
    pg_free (v), pg_free (gradient);
    return status;
}

/* ---- one tip ------------------------------------------------------------------------------------------- */
static void unknown (pg_tip_field *out)
{
    for (int a = 0; a < 2; a++) {
        for (int b = 0; b < 2; b++) out->J[a][b] = out->J_near[a][b] = NAN;
        for (int m = 0; m < 3; m++) out->K[m][a] = out->K_wide[m][a] = NAN;
        out->T[a] = NAN;
    }
}

/* The integrals of both rings into the numbers of the tip. The direction comes from the near one, but for a
 * tip that has not grown: behind it there is no new kink, and the wide ring hears less of the lattice. */
static void integrate (pg_tip_field *out, const tip_grid *grid, const tip_grid *faces,
                       const tip_springs *springs, const tip_material *m, int grown)
{
    tip_sums near, wide;
    tip_integrals (&near, grid, m, out->r1, out->near);
    tip_integrals (&wide, grid, m, out->r1, out->wide);
    tip_face_integrals (&near, faces, m, out->r1, out->near);
    tip_face_integrals (&wide, faces, m, out->r1, out->wide);
    tip_spring_integrals (&near, springs, m, out->r1, out->near);
    tip_spring_integrals (&wide, springs, m, out->r1, out->wide);
    for (int a = 0; a < 2; a++) {
        for (int b = 0; b < 2; b++) out->J_near[a][b] = near.J[a][b], out->J[a][b] = wide.J[a][b];
        for (int k = 0; k < 2; k++)
            out->K[k][a] = 0.5 * m->modulus * (grown ? near : wide).I[k][a],
            out->K_wide[k][a] = 0.5 * m->modulus * wide.I[k][a];
        out->K[2][a] = out->K_wide[2][a] = 0;
        out->T[a] = m->modulus * wide.I[PG_TIP_FORCE][a];
    }
}

pg_status pg_tip_measure (pg_tip_field *out, const pg_problem *p, const pg_force_type *force, void *self,
                          const pg_state *state, size_t tip, int nfield, const double *const *d,
                          const double *t)
{
    return pg_tip_measure_faces (out, p, force, self, state, tip, nfield, d, t, NULL, 0);
}

pg_status pg_tip_measure_faces (pg_tip_field *out, const pg_problem *p, const pg_force_type *force,
                                void *self, const pg_state *state, size_t tip, int nfield,
                                const double *const *d, const double *t, const pg_tip_faces *touch,
                                double facet)
{
    pg_status status = PG_OK;
    tip_grid grid = { 0 }, faces = { 0 };
    tip_springs springs = { 0 };
    double pressure[TIP_FIELDS] = { 0 };
    mean_motion field[TIP_FIELDS] = { { .d = NULL } };
    size_t node;
    const char *refused = pg_tip_refuses (p, force);
    memset (out, 0, sizeof *out);
    if (refused) PG_FAIL (PG_E_USAGE, "no stress intensity factors: %s", refused);
    if (nfield < 1 || nfield > TIP_FIELDS)
        PG_FAIL (PG_E_USAGE, "%d displacement fields at a tip: 1 or 2 can be measured", nfield);
    PG_TRY (tip_domain (out, p, state, tip, &node));
    tip_material m = material_at (p, node);
    int closed = touch && touch->closed, kinked = 0, forced = tip_has_body_force (p, node),
        moving = nfield == 1 && d[0] == state->d && m.density > 0 && moves (state);
    out->modulus = m.modulus;
    if (touch && !closed) limit_rings (out, p, touch);
    unknown (out);
    for (int a = 0; a < nfield; a++)
        PG_TRY (mean_motion_take (&field[a], p, state, d[a], 1, out->x, fmax (out->wide, 4 * out->h)));
    if (!closed && !moving)
        PG_TRY (kinked_tip_measure (out, p, force, self, state, tip, nfield, field, t, facet, &m, touch,
                                    &kinked));
    if (kinked || isnan (out->near)) goto done;
    /* What moves needs no places within the rings: where a field goes along with its tip, v = - c u,1, rho a
     * u,1 and rho v v,1 are the same, and what is sampled there is the lattice. */
    PG_TRY (tip_grid_create (&grid, p, out, forced));
    PG_TRY (tip_faces_create (&faces, p, out, pg_state_cracks (p, state)));
    PG_TRY (tip_springs_create (&springs, out, p));
    grid.nfield = faces.nfield = springs.grid.nfield = (size_t) nfield;
    for (int a = 0; a < nfield; a++) {
        PG_TRY (tip_grid_sample (&grid, a, out, &m, p, force, self, state, &field[a]));
        if (faces.n) PG_TRY (tip_grid_sample (&faces, a, out, &m, p, force, self, state, &field[a]));
        PG_TRY (tip_springs_sample (&springs, a, out, &m, p, force, self, state, &field[a], t));
        if (forced) PG_TRY (tip_add_body_force (&grid, a, out, p, node, t));
        pressure[a] = tip_pressure (p, a, t);
        tip_grid *all[] = { &grid, &faces, &springs.grid };
        for (int k = 0; k < 3; k++) {
            if (closed) part_faces (all[k], a, &m, touch->stress[a]);
            if (pressure[a] != 0) free_faces (all[k], a, &m, pressure[a]);
        }
    }
    if (moving) PG_TRY (add_inertia (&grid, out, &m, p, force, self, state));
    integrate (out, &grid, &faces, &springs, &m, state->paths->tip[tip].grown > 0);
    for (int a = 0; a < nfield; a++) out->T[a] -= pressure[a];
    if (closed) close_tip (out, nfield);
done:
    tip_grid_clear (&grid), tip_grid_clear (&faces), tip_springs_clear (&springs);
    for (int a = 0; a < TIP_FIELDS; a++) mean_motion_clear (&field[a]);
    return status;
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

/* In space the share s of modes II and III is left as the interaction integrals have it, K^2 (1 - s) E' J /
 * size^2 + s K^2: a front that slides acts as one some tenths of a spacing further ahead, which J feels and K
 * about the place where it is drawn does not to first order (doc/method.md, "The front of a crack in
 * space"). */
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
    /* Domains that are as wide up to rounding are one: their difference would say 1e-16. */
    if (!(f->wide > f->near * (1 + 1e-6))) return NAN;
    for (int a = 0; a < nfield; a++)
        for (int b = 0; b < nfield; b++) J += l[a] * l[b] * f->J[a][b], near += l[a] * l[b] * f->J_near[a][b];
    return fabs (J - near) / fabs (J);
}
