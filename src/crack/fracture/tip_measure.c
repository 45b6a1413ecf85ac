/* SPDX-License-Identifier: GPL-3.0-or-later
 * Computes J, K_I, K_II and T of one tip by integrals over rings. */
#include "front.h"
#include <math.h>
#include <string.h>

/* Limits the rings of an open tip to the nearest closed face. */
static void limit_rings (pg_tip_field *out, const pg_problem *p, const pg_tip_faces *faces)
{
    if (faces->nearest < out->room) out->room = faces->nearest, out->limit = PG_ROOM_FACES, out->load = -1;
    if (!(faces->nearest < out->wide)) return;
    out->wide = faces->nearest, out->near = fmin (out->near, faces->nearest);
    if (!tip_is_ring (p, out->near, out->h)) out->near = out->wide = NAN;
}

cross_section tip_section (const pg_problem *p, const double *x, const double *e, size_t node)
{
    return (cross_section) { .at = { .x = { x[0], x[1] },
                                     .frame = { e[0], e[1], 0, -e[1], e[0], 0, 0, 0, 1 } },
                             .length = p->cloud.thickness, .radii = 2, .node = node,
                             .material = material_at (p, node) };
}

/* Converts the integrals of both rings to J, K and T. K, which determines the direction, is taken from the
 * near ring, but for a tip that has not grown (no kink behind it) from the wide one, which depends less on
 * the lattice. */
static void take_sums (pg_tip_field *out, const front_sums *sums, const measuring *m, int grown)
{
    memcpy (out->J_near, sums->J[0], sizeof out->J_near), memcpy (out->J, sums->J[1], sizeof out->J);
    for (int a = 0; a < 2; a++) {
        for (int k = 0; k < 2; k++)
            out->K[k][a] = 0.5 * out->modulus * sums->I[!grown][k][a],
            out->K_wide[k][a] = 0.5 * out->modulus * sums->I[1][k][a];
        out->K[2][a] = out->K_wide[2][a] = 0;
        out->T[a] = out->modulus * sums->I[1][FRONT_FORCE][a] - m->pressure[a];
    }
}

pg_status pg_tip_measure (pg_tip_field *out, const pg_problem *p, const pg_force_type *force, void *self,
                          const pg_state *state, size_t tip, int nfield, const double *const *d,
                          const double *t, const pg_tip_faces *touch, double facet)
{
    pg_status status = PG_OK;
    front_places rings = { 0 }, faces = { 0 };
    cross_section s;
    measuring m = { .p = p, .force = force, .self = self, .state = state, .nfield = nfield, .d = d, .t = t,
                    .n = 1, .section = &s };
    size_t node;
    memset (out, 0, sizeof *out);
    PG_TRY (measuring_check (&m));
    PG_TRY (tip_domain (out, p, state, tip, &node));
    s = tip_section (p, out->x, out->e, node);
    if (touch && touch->closed) s.closed = 1;
    for (int a = 0; s.closed && a < nfield; a++) memcpy (s.stress[a], touch->stress[a], 2 * sizeof (double));
    if (touch && !s.closed) limit_rings (out, p, touch);
    m.h = out->h, m.r1 = out->r1, m.radius[0] = out->near, m.radius[1] = out->wide;
    out->modulus = s.material.modulus;
    measured_nothing (out);
    PG_TRY (measuring_begin (&m, 1, out->x, fmax (out->wide, 4 * out->h)));
    m.moving &= s.material.density > 0;
    int kinked = 0, forced = has_body_force (p, node);
    if (!s.closed && !m.moving) PG_TRY (kinked_tip_measure (out, &m, tip, facet, touch, &kinked));
    if (kinked || isnan (out->near)) goto done;
    /* Inertia terms are not integrated within r1: in a field that moves with its tip, v = - c u,1, rho a u,1
     * and rho v v,1 cancel, and samples there would only be noise of the lattice. */
    PG_TRY (tip_rings_create (&rings, p, out, forced));
    PG_TRY (tip_faces_create (&faces, p, out, pg_state_cracks (p, state)));
    PG_TRY (places_fields (&rings, &m, forced, m.moving));
    PG_TRY (places_fields (&faces, &m, 0, 0));
    front_integrals (&s.sums, &m, &s, &rings, 0, rings.n);
    tip_face_integrals (&s.sums, &m, &faces);
    PG_TRY (springs_add (&m));
    take_sums (out, &s.sums, &m, state->paths->tip[tip].grown > 0);
    if (s.closed) measured_closed (out, nfield), memcpy (out->K, out->K_wide, sizeof out->K);
done:
    places_clear (&rings), places_clear (&faces), measuring_end (&m);
    return status;
}
