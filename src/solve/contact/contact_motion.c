/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact of crack faces where forces are evaluated time step by time step, or iteration by iteration. The
 * layer between the faces (pg_force_type.faces) acts as a spring for each pair: it presses by f_n = - g_n /
 * soft_n where it is compressed, and its tangents follow f_t = - (g_t - s) / soft_t up to Coulomb's limit
 * mu f_n + c, beyond which s slides after (return mapping, as of an elastoplastic spring). An equilibrium
 * that is reached so is that of the condensed problem (contact_solve.c), whose pairs give way by the same. */
#include "contact.h"
#include <math.h>
#include <string.h>

/* Finds the shear force of a pair pressed by force[0], N; g, s: gap and slip so far along the tangents, m. */
static pg_contact_status shear (const struct system_contact *c, size_t k, const double *g, const double *s,
                                double *force)
{
    size_t m = c->pieces.dim - 1;
    const double *soft = c->soft + c->pieces.dim * k + 1;
    double size = 0, limit = c->coefficient[k] * force[0] + c->cohesion[k];
    for (size_t a = 0; a < m; a++) force[1 + a] = -(g[a] - s[a]) / soft[a];
    for (size_t a = 0; a < m; a++) size = hypot (size, force[1 + a]);
    if (size <= limit && limit > 0) return PG_CONTACT_STICK;
    for (size_t a = 0; a < m; a++) force[1 + a] *= size > 0 ? limit / size : 0;
    if (m > 1) return PG_CONTACT_SLIDING;
    return g[0] > s[0] ? PG_CONTACT_FORWARD : PG_CONTACT_BACKWARD;
}

void contact_push (pg_system *s, const double *d, double *residual, int follow)
{
    struct system_contact *c = s->contact;
    size_t dim = c ? c->pieces.dim : 2;
    if (!c || !c->ncrack) return;
    double t0 = pg_seconds ();
    memset (c->force, 0, dim * c->ncrack * sizeof *c->force);
    contact_gaps (c, d);
    if (c->is.active) memset (c->nodal, 0, s->ndof * sizeof *c->nodal);
    int active = 0;
    for (size_t k = 0; k < c->ncrack; k++) {
        double *f = c->force + dim * k, *g = c->gap + dim * k, *before = c->before + (dim - 1) * k;
        c->status[k] = PG_CONTACT_OPEN;
        if (g[0] < 0) {
            f[0] = -g[0] / c->soft[dim * k];
            c->status[k] = shear (c, k, g + 1, before, f), active = 1;
            /* compression of the layer is neither gap nor slip */
            g[0] = 0;
            for (size_t a = 1; a < dim; a++) g[a] += c->soft[dim * k + a] * f[a];
        }
        for (size_t a = 0; follow && a + 1 < dim; a++) before[a] = g[1 + a];
        for (size_t a = 0; c->status[k] != PG_CONTACT_OPEN && a < dim; a++)
            for (long q = c->G.start[dim * k + a]; q < c->G.start[dim * k + a + 1]; q++)
                c->nodal[c->G.row[q]] += c->G.value[q] * f[a], residual[c->G.row[q]] += c->G.value[q] * f[a];
    }
    contact_set_active (s, active);
    if (follow) contact_book (s, 1), contact_accept (s);
    s->report->seconds[PG_SECONDS_FORCE] += pg_seconds () - t0;
}

void contact_row_sums (const pg_system *s, double *sum)
{
    const struct system_contact *c = s->contact;
    for (size_t j = 0; c && j < c->pieces.dim * c->ncrack; j++) {
        double all = 0;
        for (long q = c->G.start[j]; q < c->G.start[j + 1]; q++) all += fabs (c->G.value[q]);
        for (long q = c->G.start[j]; q < c->G.start[j + 1]; q++)
            sum[c->G.row[q]] += fabs (c->G.value[q]) * all / c->soft[j];
    }
}
