/* SPDX-License-Identifier: GPL-3.0-or-later
 * Forces that contact goes on transmitting between the faces of a facet that is cut in dynamics. Before the
 * cut its bonds carry a traction; of that, contact (contact_solve.c) transmits the pressure p, and of the
 * shear what friction can bear, at most mu p + c. Only the rest belongs to the material, and is held and
 * released (facet_hold.c): were the pressure held too, it would decay while contact takes over, nothing would
 * press the faces behind a moving tip meanwhile, and it would do work where they part. */
#include "solve/contact/contact.h"
#include "facet_growth.h"
#include <math.h>
#include <string.h>

void facet_faces_clear (facet_faces *f)
{
    pg_free (f->x), pg_free (f->normal), pg_free (f->force);
    memset (f, 0, sizeof *f);
}

pg_status facet_faces_before (const break_loop *b, const pg_state *state, const double *d, const double *from,
                              const double *to, facet_faces *out)
{
    pg_status status = PG_OK;
    const pg_system *s = &b->system;
    double *u = NULL, *stress = NULL, e[2], length = hypot (to[0] - from[0], to[1] - from[1]),
           middle[3] = { 0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]), 0 };
    memset (out, 0, sizeof *out);
    if (!s->contact || !(length > 0)) return PG_OK;
    const pg_contact_setting *setting = &s->contact->setting;
    size_t n = (size_t) ceil (PG_CONTACT_POINTS * length / pg_problem_spacing_at (s->problem, middle) - 1e-9);
    double part = length * s->problem->cloud.thickness / (double) n;
    for (int k = 0; k < 2; k++) e[k] = (to[k] - from[k]) / length;
    PG_ALLOC (out->x, 2 * n);
    PG_ALLOC (out->normal, 2 * n);
    PG_ALLOC (out->force, 2 * n);
    PG_ALLOC (u, 3 * n);
    PG_ALLOC (stress, 6 * n);
    for (size_t q = 0; q < n; q++) {
        for (size_t k = 0; k < 2; k++)
            out->x[2*q + k] = from[k] + ((double) q + 0.5) / (double) n * (to[k] - from[k]);
        out->normal[2*q] = -e[1], out->normal[2*q + 1] = e[0];
    }
    PG_TRY (s->force->sample (s->self, state, d, n, out->x, u, stress, NULL));
    for (size_t q = 0; q < n; q++) {
        const double *v = stress + 6*q, *m = out->normal + 2*q;
        /* traction on the right face */
        double t[2] = { v[0] * m[0] + v[3] * m[1], v[3] * m[0] + v[1] * m[1] },
               pressure = fmax (0, -(t[0] * m[0] + t[1] * m[1])), shear = -(t[0] * e[0] + t[1] * e[1]),
               limit = pressure > 0 ? setting->coefficient * pressure + setting->cohesion : 0;
        shear = fmax (-limit, fmin (limit, shear));
        for (size_t k = 0; k < 2; k++) out->force[2*q + k] = part * (pressure * m[k] + shear * e[k]);
    }
    out->n = n;
done:
    pg_free (u), pg_free (stress);
    if (status != PG_OK) facet_faces_clear (out);
    return status;
}

pg_status facet_faces_bear (const break_loop *b, const pg_state *state, const facet_faces *f, double *nodal)
{
    pg_status status = PG_OK;
    const pg_system *s = &b->system;
    pg_jump_rows jump = { 0 };
    memset (nodal, 0, s->ndof * sizeof *nodal);
    if (!f->n) return PG_OK;
    PG_TRY (s->force->surfaces.jump (s->self, state, f->n, f->x, f->normal, PG_CONTACT_RADIUS, &jump));
    for (size_t q = 0; q < f->n; q++)
        for (size_t e = jump.start[q]; e < jump.start[q + 1]; e++)
            for (size_t k = 0; k < 2; k++)
                nodal[2 * (size_t) jump.node[e] + k] += jump.value[e] * f->force[2*q + k];
done:
    pg_jump_rows_clear (&jump);
    return status;
}
