/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stresses between crack faces behind the vertices of fronts (3D): means over the pieces behind, as behind
 * tips in 2D, in a window that rises and falls smoothly. The last one and a half spacings carry too little,
 * as the front of a discretisation is not sharp. */
#include "contact.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

/* Window in spacings: from NEXT to LAST behind the vertex, ASIDE along the front, OFF the plane of the crack
 * there; pieces whose normals make a larger angle (cosine below LEANS) are left out. */
static const double NEXT = 1, LAST = 8, ASIDE = 3, OFF = 1, LEANS = 0.87;

/* Adds the force of piece k, times weight, to the stresses of each field: one field: all of it; two: its
 * value at the start of the growing loads, and its rate with these. */
static void add_force (const struct system_contact *c, size_t k, int nfield, double weight, double side,
                       pg_front_faces *out)
{
    for (int a = 0; a < nfield; a++) {
        double force[3], along[3];
        for (size_t i = 0; i < 3; i++) {
            const double *of = nfield == 1 ? c->force : a ? c->route.track.force_rate : c->route.force_from;
            force[i] = of[3*k + i];
        }
        contact_vector (&c->pieces, k, force + 1, side < 0 ? -weight : weight, along);
        out->pressure[a] += weight * force[0];
        for (int m = 0; m < 3; m++) out->shear[a][m] += along[m];
    }
}

/* Finds the stresses at one vertex at x; e: direction ahead, n: normal. */
static void at_vertex (const struct system_contact *c, double h, const double *x, const double *e,
                       const double *n, int nfield, double scale, pg_front_faces *out)
{
    double area = 0, t[3];
    for (int k = 0; k < 3; k++) t[k] = e[(k + 1) % 3] * n[(k + 2) % 3] - e[(k + 2) % 3] * n[(k + 1) % 3];
    memset (out, 0, sizeof *out);
    out->nearest = INFINITY;
    for (size_t k = 0; c->is.active && k < c->ncrack; k++) {
        const pg_contact_piece *p = &c->pieces.piece[k];
        double to[3], side = pg_dot3 (p->normal, n);
        int presses = nfield == 1 ? c->force[3*k] > 0 : c->status[k] != PG_CONTACT_OPEN;
        for (int m = 0; m < 3; m++) to[m] = x[m] - p->x[m];
        double behind = pg_dot3 (to, e), beside = pg_dot3 (to, t), off = pg_dot3 (to, n);
        if (presses) out->nearest = fmin (out->nearest, fmax (0, sqrt (pg_dot3 (to, to)) - 0.5 * p->length));
        double u = (behind - NEXT * h) / ((LAST - NEXT) * h), v = beside / (ASIDE * h);
        if (!(u > 0 && u < 1 && fabs (v) < 1) || fabs (off) > OFF * h || fabs (side) < LEANS) continue;
        double weight = pow (sin (3.14159265358979323846 * u) * (1 - v * v), 2);
        area += weight * p->area, out->closed |= presses;
        add_force (c, k, nfield, weight, side, out);
    }
    for (int a = 0; a < nfield && area > 0; a++) {
        out->pressure[a] *= scale / area;
        for (int m = 0; m < 3; m++) out->shear[a][m] *= scale / area;
    }
}

void contact_at_front (const pg_system *s, const pg_front *front, int nfield, double scale,
                       pg_front_faces *out)
{
    for (size_t i = 0; i < front->n; i++)
        at_vertex (s->contact, pg_problem_spacing_at (s->problem, front->x + 3*i), front->x + 3*i,
                   front->ahead + 3*i, front->normal + 3*i, nfield, scale, &out[i]);
}

/* Contact at a front of the state. In event stepping under proportional loads forces are those of load factor
 * 1, and are scaled. */
int pg_solver_front_faces (const pg_solver *s, const pg_state *state, size_t front, pg_front_faces *out)
{
    size_t n;
    const pg_front *fronts = pg_fronts_of_state (s->problem, state, &n);
    const pg_system *system = &s->break_loop.system;
    if (!system->contact || system->problem->dim != 3 || front >= n) return 0;
    int scaled = s->options.event && !system->contact->route.open[0];
    contact_at_front (system, &fronts[front], 1, scaled ? state->factor : 1, out);
    return 1;
}
