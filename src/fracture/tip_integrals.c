/* SPDX-License-Identifier: GPL-3.0-or-later
 * The integrals around a tip. With a weight q that falls from 1 at r1 to 0 at r2, and the divergence theorem,
 * the line integral of Rice becomes one over the ring (Moran and Shih 1987),
 *
 *   J = int (sigma_ij u_i,1 - (W + W_k) delta_1j) q,j dA - int (b - rho a)_i u_i,1 q dA
 *       - int rho v_i v_i,1 q dA,
 *
 * W_k = 1/2 rho v.v; bilinear in two displacements a and b whose sum is the field:
 *
 *   J_ab = int (1/2 (sigma^a_ij u^b_i,1 + sigma^b_ij u^a_i,1) - W_ab delta_1j) q,j dA - ...,  W_ab = 1/2
 *   sigma^a : eps^b.
 *
 * With an exact field a of unit strength the mixed part of J (u + a) is the interaction integral
 *
 *   I = int (sigma_ij a_i,1 + s_ij u_i,1 - sigma_ij e_ij delta_1j) q,j dA - int (b - rho a)_i a_i,1 q dA,
 *
 * s and e its stress and strain: K = E'/2 I for the singular fields, T = E' I for the force on the tip.
 *
 * Where a mean dilatation carries the pressure p (Poisson's ratio near 1/2), sigma = D eps + (p - lambda tr
 * eps) 1, and the energy that this stress belongs to is W = 1/2 eps D eps - lambda / 2 (tr eps)^2 + p^2 / (2
 * lambda): with x = p - lambda tr eps, 1/2 eps D eps + x tr eps + x^2 / (2 lambda). */
#include "tip.h"
#include <math.h>
#include <string.h>

/* q = 1 - z^2 (3 - 2 z). */
double tip_weight (double r, double r1, double r2, double *slope)
{
    double z = (r - r1) / (r2 - r1);
    *slope = z > 0 && z < 1 ? -6 * z * (1 - z) / (r2 - r1) : 0;
    return z <= 0 ? 1 : z >= 1 ? 0 : 1 - z * z * (3 - 2 * z);
}

/* sigma : eps of a stress (11, 22, 12) and a displacement gradient. */
static double work (const double *stress, const double *H)
{
    return stress[0] * H[0] + stress[1] * H[3] + stress[2] * (H[1] + H[2]);
}

/* sigma_ij u_i,1 g_j. */
static double flux (const double *stress, const double *H, const double *g)
{
    return (stress[0] * H[0] + stress[2] * H[2]) * g[0] + (stress[2] * H[0] + stress[1] * H[2]) * g[1];
}

/* W_ab at place k. */
static double energy (const tip_grid *grid, const tip_material *m, size_t a, size_t b, size_t k)
{
    const tip_sample *f = &grid->field[a], *g = &grid->field[b];
    const double *H = f->H + 4*k, *G = g->H + 4*k;
    double W = 0.25 * (work (f->stress + 3*k, G) + work (g->stress + 3*k, H));
    if (!f->excess || !g->excess) return W;
    double x = f->excess[k], y = g->excess[k], h = H[0] + H[3], i = G[0] + G[3];
    return W + 0.25 * (x * i + y * h) + 0.5 * x * y / m->lambda;
}

/* What place k adds to J_ab, but for its area. */
static double energy_release (const tip_grid *grid, const tip_material *m, size_t a, size_t b, size_t k,
                              const double *g, double q)
{
    const tip_sample *f = &grid->field[a], *h = &grid->field[b];
    const double *H = f->H + 4*k, *G = h->H + 4*k;
    double sum = 0.5 * (flux (f->stress + 3*k, G, g) + flux (h->stress + 3*k, H, g))
                 - energy (grid, m, a, b, k) * g[0];
    if (f->load) sum -= 0.5 * q * (f->load[2*k] * G[0] + f->load[2*k + 1] * G[2]);
    if (h->load) sum -= 0.5 * q * (h->load[2*k] * H[0] + h->load[2*k + 1] * H[2]);
    if (f->kinetic) sum -= q * f->kinetic[k] + f->moving[k] * g[0];        /* the one field in motion */
    return sum;
}

/* What place k adds to the interaction integral of a field with an exact one, but for its area. */
static double interaction (const tip_sample *f, size_t k, const double *A, const double *s, const double *g,
                           double q)
{
    double sum = flux (f->stress + 3*k, A, g) + flux (s, f->H + 4*k, g) - work (f->stress + 3*k, A) * g[0];
    if (f->load) sum -= q * (f->load[2*k] * A[0] + f->load[2*k + 1] * A[2]);
    return sum;
}

/* J of two fields is the same in both orders. */
static void mirror (tip_sums *sums) { sums->J[0][1] = sums->J[1][0]; }

void tip_integrals (tip_sums *out, const tip_grid *grid, const tip_material *m, double r1, double r2)
{
    memset (out, 0, sizeof *out);
    for (size_t k = 0; k < grid->n; k++) {
        double slope, q = tip_weight (grid->r[k], r1, r2, &slope),
                      g[2] = { slope * cos (grid->theta[k]), slope * sin (grid->theta[k]) };
        if (q <= 0) continue;
        for (size_t a = 0; a < grid->nfield; a++)
            for (size_t b = 0; b <= a; b++)
                out->J[a][b] += grid->area[k] * energy_release (grid, m, a, b, k, g, q);
        for (int i = 0; i < PG_TIP_FIELDS; i++) {
            double A[4], s[3];
            pg_tip_near_field (i, m->mu, m->kappa, grid->r[k], grid->theta[k], NULL, A, s);
            for (size_t a = 0; a < grid->nfield; a++)
                out->I[i][a] += grid->area[k] * interaction (&grid->field[a], k, A, s, g, q);
        }
    }
    mirror (out);
}

/* A spring is a force F on the body at one place: - F_i u_i,1 q over the thickness instead of an integral. */
void tip_spring_integrals (tip_sums *out, const tip_springs *s, const tip_material *m, double r1, double r2)
{
    static const double nothing[3] = { 0 };
    const tip_grid *grid = &s->grid;
    for (size_t k = 0; k < grid->n; k++) {
        double slope, q = tip_weight (grid->r[k], r1, r2, &slope);
        if (q <= 0) continue;
        for (size_t a = 0; a < grid->nfield; a++)
            for (size_t b = 0; b <= a; b++)
                out->J[a][b] += grid->area[k] * energy_release (grid, m, a, b, k, nothing, q);
        for (int i = 0; i < PG_TIP_FIELDS; i++) {
            double A[4];
            tip_mean_gradient (i, m, grid->r[k], grid->theta[k], s->size[k], A);
            for (size_t a = 0; a < grid->nfield; a++)
                out->I[i][a] += grid->area[k] * interaction (&grid->field[a], k, A, nothing, nothing, q);
        }
    }
    mirror (out);
}

void tip_face_integrals (tip_sums *out, const tip_grid *faces, const tip_material *m, double r1, double r2)
{
    for (size_t k = 0; k < faces->n; k++) {
        double slope, q = tip_weight (faces->r[k], r1, r2, &slope);
        for (size_t a = 0; a < faces->nfield; a++)
            for (size_t b = 0; b <= a; b++) out->J[a][b] += faces->area[k] * q * energy (faces, m, a, b, k);
    }
    mirror (out);
}
