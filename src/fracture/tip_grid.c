/* SPDX-License-Identifier: GPL-3.0-or-later
 * The places at which the integrals around a tip are summed, and the fields there. The shape functions are
 * smooth but not polynomial, with a length of their own of about h: Gauss points by four on pieces of less
 * than h along the radius, and on equal arcs around. None lies on the crack, at the angle +-pi. The near ring
 * and what the wide one adds are divided apart, so that both are sums over places that were sampled once. */
#include "gradient_fit.h"
#include "tip.h"
#include <math.h>
#include <string.h>

enum { GAUSS = 4, ARCS_NEAR = 12, ARCS_WIDE = 16 };
static const double piece = 0.75;                      /* of the radius, in spacings, at most */
static const double pi = 3.14159265358979323846;

void tip_turn (const double *e, const double *v, double *out)
{
    double ahead = e[0] * v[0] + e[1] * v[1], left = e[0] * v[1] - e[1] * v[0];
    out[0] = ahead, out[1] = left;
}

/* Radial pieces of a ring. */
static size_t pieces (const pg_problem *p, double from, double to, double h)
{
    return to > from + pg_cloud_same (&p->cloud) ? pg_cloud_pieces (&p->cloud, to - from, piece * h) : 0;
}

static size_t places (const pg_problem *p, double from, double to, double h, int arcs)
{
    return pieces (p, from, to, h) * GAUSS * (size_t) arcs * GAUSS;
}

/* Appends the places of the ring from .. to. */
static void add_ring (tip_grid *grid, const pg_problem *p, const pg_tip_field *tip, double from, double to,
                      int arcs)
{
    double x[GAUSS], w[GAUSS];
    size_t n = pieces (p, from, to, tip->h);
    double radius = n ? (to - from) / (double) n : 0, arc = 2 * pi / arcs;
    pg_gauss_rule (GAUSS, x, w);
    for (size_t i = 0; i < n * GAUSS; i++)
        for (int j = 0; j < arcs * GAUSS; j++) {
            double r = from + radius * ((double) (i / GAUSS) + 0.5 * (1 + x[i % GAUSS])),
                   theta = -pi + arc * (j / GAUSS + 0.5 * (1 + x[j % GAUSS]));
            double c = r * cos (theta), s = r * sin (theta);
            size_t k = grid->n++;
            grid->r[k] = r, grid->theta[k] = theta;
            grid->area[k] = 0.25 * w[i % GAUSS] * w[j % GAUSS] * radius * arc * r;
            grid->x[2*k] = tip->x[0] + c * tip->e[0] - s * tip->e[1];
            grid->x[2*k + 1] = tip->x[1] + c * tip->e[1] + s * tip->e[0];
        }
}

pg_status tip_grid_create (tip_grid *out, const pg_problem *p, const pg_tip_field *t, int core)
{
    pg_status status = PG_OK;
    size_t most = places (p, 0, t->r1, t->h, ARCS_NEAR) + places (p, t->r1, t->near, t->h, ARCS_NEAR)
                  + places (p, t->near, t->wide, t->h, ARCS_WIDE);
    memset (out, 0, sizeof *out);
    PG_ALLOC (out->r, most);
    PG_ALLOC (out->theta, most);
    PG_ALLOC (out->area, most);
    PG_ALLOC (out->x, 2 * most);
    if (core) add_ring (out, p, t, 0, t->r1, ARCS_NEAR);
    add_ring (out, p, t, t->r1, t->near, ARCS_NEAR);
    add_ring (out, p, t, t->near, t->wide, ARCS_WIDE);
done:
    if (status != PG_OK) tip_grid_clear (out);
    return status;
}

void tip_grid_clear (tip_grid *grid)
{
    for (int a = 0; a < TIP_FIELDS; a++)
        pg_free (grid->field[a].u), pg_free (grid->field[a].H), pg_free (grid->field[a].stress),
            pg_free (grid->field[a].excess), pg_free (grid->field[a].load), pg_free (grid->field[a].kinetic),
            pg_free (grid->field[a].moving);
    pg_free (grid->r), pg_free (grid->theta), pg_free (grid->area), pg_free (grid->x);
    memset (grid, 0, sizeof *grid);
}

/* A gradient du_c/dx_k (2 x 2) in the frame of the tip: R H R'. */
static void turn_gradient (const double *e, const double *H, double *out)
{
    double rows[2][2], columns[2][2], left[2] = { H[0], H[2] }, right[2] = { H[1], H[3] };
    tip_turn (e, left, columns[0]), tip_turn (e, right, columns[1]);       /* R H, column by column */
    for (int c = 0; c < 2; c++) {
        double row[2] = { columns[0][c], columns[1][c] };
        tip_turn (e, row, rows[c]);
        out[2*c] = rows[c][0], out[2*c + 1] = rows[c][1];
    }
}

/* A stress xx yy zz xy yz zx in the frame of the tip. */
static void turn_stress (const double *e, const double *s, double *out)
{
    double full[4] = { s[0], s[3], s[3], s[1] }, turned[4];
    turn_gradient (e, full, turned);
    out[0] = turned[0], out[1] = turned[3], out[2] = turned[1];
}

pg_status tip_grid_sample (tip_grid *grid, int at, const pg_tip_field *tip, const tip_material *material,
                           const pg_problem *p, const pg_force_type *force, void *self,
                           const pg_state *state, const mean_motion *d)
{
    pg_status status = PG_OK;
    tip_sample *f = &grid->field[at];
    double *u = NULL, *stress = NULL, *gradient = NULL;
    size_t n = grid->n;
    PG_ALLOC (u, 3 * n);
    PG_ALLOC (stress, 6 * n);
    PG_ALLOC (gradient, 9 * n);
    PG_ALLOC (f->u, 2 * n);
    PG_ALLOC (f->H, 4 * n);
    PG_ALLOC (f->stress, 3 * n);
    if (material->lambda > 0) PG_ALLOC (f->excess, n);
    PG_TRY (gradient_sample (p, force, self, state, d->d, n, grid->x, u, stress, gradient));
    for (size_t k = 0; k < n; k++) {
        double full[6], moved[3];
        mean_motion_at (d, grid->x + 2*k, 2, moved);
        for (size_t c = 0; c < 2; c++) moved[c] += u[3*k + c];
        tip_turn (tip->e, moved, f->u + 2*k);
        turn_gradient (tip->e, gradient + 9*k, f->H + 4*k);
        turn_stress (tip->e, stress + 6*k, f->stress + 3*k);
        if (!f->excess) continue;
        pg_stress_of_gradient (material->law, 2, gradient + 9*k, full);
        f->excess[k] = 0.5 * (stress[6*k] + stress[6*k + 1] - full[0] - full[1]);
    }
done:
    pg_free (u), pg_free (stress), pg_free (gradient);
    return status;
}
