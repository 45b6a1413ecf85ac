/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that begin in shear under pressure (Mohr and Coulomb's strength, and energy together). The strength
 * is reached first on the two planes at 45 degrees - phi/2 to the largest pressure, where |tau| - tan (phi) p
 * is largest. Faces that have formed press on each other with p and bear mu p + c by friction while they
 * slide, so that what drives the crack is |tau| - mu p - c. What it sets free beyond the work of that
 * friction is what a crack with free faces would in the field less the uniform stress sigma_nn = - p,
 * sigma_nt = mu p + c of its plane (superposition; a straight crack that slides does not change p). Uniform
 * displacement gradients are exact in all bases, so that this field needs no solve. p is the mean along the
 * crack. */
#include "shear_initiation.h"
#include "facet_growth.h"
#include <math.h>

void shear_lay (const search *g, const hot_spot *spot, int side, double *angle, shear_start *out)
{
    const pg_contact_setting *faces = &g->w->system->options->contact;
    double v[3], half = 0.25 * acos (-1) - 0.5 * atan (spot->slope);
    *angle = spot->angle + (side ? half : -half);
    for (int k = 0; k < 3; k++) v[k] = spot->stress.constant[k] + spot->factor * spot->stress.slope[k];
    double a = -sin (*angle), b = cos (*angle),
           shear = a * b * (v[0] - v[1]) + (b * b - a * a) * v[2];
    *out = (shear_start) { .sense = shear < 0 ? -1 : 1, .friction = faces->coefficient,
                           .cohesion = faces->cohesion, .material = spot->material };
}

double shear_drive (const shear_start *c, const double face[4], int k)
{
    if (!c->sense) return face[k];
    return c->sense * face[2 + k] + c->friction * face[k] - (k ? 0 : c->cohesion);
}

/* d -= displacement of the uniform stress (normal, shear) in the frame of the crack. */
static void take_off (const pg_system *s, const pg_material *m, double angle, double normal, double shear,
                      double *d)
{
    const pg_cloud *cloud = &s->problem->cloud;
    double kappa = pg_tip_kappa (m->mode, m->nu), C = cos (angle), S = sin (angle);
    double along = (kappa - 3) * normal / (8 * m->mu), across = (kappa + 1) * normal / (8 * m->mu),
           slide = shear / (2 * m->mu);
    size_t parts = s->ndof / cloud->n;
    for (size_t i = 0; i < cloud->n; i++) {
        const double *x = cloud->x + 2*i;
        double t = C * x[0] + S * x[1], n = -S * x[0] + C * x[1];
        double ut = along * t + slide * n, un = slide * t + across * n;
        d[parts * i] -= C * ut - S * un, d[parts * i + 1] -= S * ut + C * un;
    }
}

pg_status shear_free_fields (const search *g, const shear_start *c, double angle, const double face[4],
                             trial_fields *out)
{
    pg_status status = PG_OK;
    trials *w = g->w;
    const pg_system *s = w->system;
    *out = *g->f;
    for (int a = 0; a < g->f->n; a++) {
        /* one field: at load factor 1; two: at 0 and at 1 */
        double normal = g->f->n == 1 ? face[1] : face[0] + a * face[1];
        if (!w->excess[a]) PG_ALLOC (w->excess[a], s->ndof);
        for (size_t i = 0; i < s->ndof; i++) w->excess[a][i] = g->f->d[a][i];
        /* faces parted by tension bear nothing */
        if (normal < 0)
            take_off (s, c->material, angle, normal, c->sense * (c->cohesion - c->friction * normal),
                      w->excess[a]);
        out->d[a] = w->excess[a];
    }
done:
    return status;
}
