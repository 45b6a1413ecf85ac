/* SPDX-License-Identifier: GPL-3.0-or-later
 * Direction and length of the advance of the vertices of crack fronts.
 *
 * A vertex in modes I, II and III turns about its front by the angle of the largest hoop stress (Erdogan and
 * Sih 1963; crack/fracture/kink_direction.c). With K_A = K_I cos^2 (theta/2) - 3/2 K_II sin theta, the
 * largest
 * principal
 * stress on the plane across the front there has the intensity (Schoellmann, Richard, Kullmer and Fulland
 * 2002, Int. J. Fract. 117, 129-141)
 *
 *   K_v = cos (theta/2) / 2 (K_A + sqrt (K_A^2 + 4 K_III^2)),
 *
 * and counts J K_v^2 / (K_I^2 + K_II^2 + K_III^2 / (1 - nu)), at most J but where faces press on each other:
 * a kink of a crack that slides sets free more than the crack itself would, as in the plane. K_III turns that
 * stress out of the normal n towards the tangent t by psi, tan 2 psi = 2 K_III / K_A: the new surface would
 * fall by tan psi along the front. Facets that each turn would tear from each other; here the surface stays
 * one sheet, and the rise z of the vertices is the one nearest to both: it makes
 *
 *   sum_i w_i (z_i - d_i sin theta_i)^2 + l^2 integral (dz/ds + tan psi)^2 ds
 *
 * least, d the advance, w the length of front of a vertex, l that of a facet. The second term also takes out
 * what differs from vertex to vertex: a wave of kinks of length L keeps 1 / (1 + (2 pi l / L)^2) of its
 * height.
 *
 * How far they go: front_ways.c. */
#include "front_growth.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

/* ---- one vertex ---------------------------------------------------------------------------------------- */
void front_judge (const break_loop *b, const pg_tip_field *f, double factor, front_vertex *out)
{
    const facet_growth *g = b->growth;
    double l[2], K[3], T, K_theta, G_theta, length = facet_length (g, f), x[3];
    pg_fracture_limits limits;
    *out = (front_vertex) { .width = out->width };
    if (isnan (f->near)) return;
    int n = facet_factors (g, factor, l);
    pg_tip_combine (f, n, l, &out->J, K, &T);
    if (!(out->J > 0)) return;
    /* opening decides whether there is a direction of tension; pure K_III has its own */
    int turns = pg_kink (out->J, K[0], K[1], T, length, &out->kink, &K_theta, &G_theta);
    if (!turns && !(fabs (K[2]) > 0 && K[0] >= 0)) return;
    double c = cos (0.5 * out->kink), K_A = turns ? K_theta / c : 0;
    double K_v = 0.5 * c * (K_A + hypot (K_A, 2 * K[2]));
    double all = K[0] * K[0] + K[1] * K[1] + f->antiplane * K[2] * K[2];
    if (!(all > 0)) return;
    out->ratio = f->closed ? K_v * K_v / all : fmin (1, K_v * K_v / all);
    out->slope = -tan (0.5 * atan2 (2 * K[2], K_A));
    for (int k = 0; k < 3; k++)
        x[k] = f->x[k] + 0.5 * length * (cos (out->kink) * f->e[k] + sin (out->kink) * f->normal[k]);
    if (!facet_limits (b, x, 0, &limits)) return;
    out->need = limits.energy;
    out->share = sqrt (out->J * out->ratio / limits.energy);
}

/* ---- neighbours ---------------------------------------------------------------------------------------- */
/* The neighbours of vertex i of n; an open front has none beyond its ends (i itself). */
static size_t before (size_t i, size_t n, int closed) { return i > 0 ? i - 1 : closed ? n - 1 : i; }
static size_t after (size_t i, size_t n, int closed) { return i + 1 < n ? i + 1 : closed ? 0 : i; }

/* ---- rise of the surface ------------------------------------------------------------------------------- */
/* 1: the vertices follow each other along the tangent t = e x n, to which K_III refers; -1: against it. */
static double runs_along (const pg_front *front)
{
    double sum = 0;
    for (size_t i = 0; i + 1 < front->n; i++) {
        double t[3], way[3];
        pg_cross3 (front->ahead + 3*i, front->normal + 3*i, t);
        pg_shift3 (front->x + 3*i + 3, front->x + 3*i, -1, way);
        sum += pg_dot3 (t, way);
    }
    return sum < 0 ? -1 : 1;
}

/* Solves the least squares for the rise: (w_i + l^2 (1/s_before + 1/s_after)) z_i - l^2 (z_before / s_before
 * + z_after / s_after) = w_i d_i sin theta_i + l^2 (psi_before - psi_after), s the lengths of the two edges,
 * psi the mean slope along each. By Gauss-Seidel: the matrix is diagonally dominant by the w_i. A sweep goes
 * forward and backward, so that a mirrored front rises as its mirror image, to the tolerance. */
static void settle_rises (const pg_front *front, front_vertex *v, double l)
{
    enum { SWEEPS = 200 };
    size_t n = front->n;
    double sense = runs_along (front);
    for (size_t i = 0; i < n; i++) v[i].rise = v[i].way * sin (v[i].kink);
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double change = 0, size = 0;
        for (size_t q = 0; q < 2 * n; q++) {
            size_t i = q < n ? q : 2*n - 1 - q;
            double diagonal = v[i].width, sum = v[i].width * v[i].way * sin (v[i].kink);
            for (int side = -1; side <= 1; side += 2) {
                size_t j = side < 0 ? before (i, n, front->closed) : after (i, n, front->closed);
                double s = pg_distance (3, front->x + 3*i, front->x + 3*j);
                if (j == i || !(s > 0)) continue;
                diagonal += l * l / s;
                double asked = 0.5 * sense * (v[i].slope * v[i].way + v[j].slope * v[j].way) / l;
                sum += l * l * (v[j].rise / s - side * asked);
            }
            double z = sum / diagonal;
            change = fmax (change, fabs (z - v[i].rise)), size = fmax (size, fabs (z));
            v[i].rise = z;
        }
        if (change <= 1e-13 * size) break;
    }
    for (size_t i = 0; i < n; i++) v[i].rise = fmax (-0.98 * v[i].way, fmin (0.98 * v[i].way, v[i].rise));
}

/* Gives the ends of a front the values of their nearest measured vertex: values extrapolated to an end carry
 * the noise of several vertices, and nothing holds back an end that runs ahead. So the front stays at right
 * angles to the surface where it was. */
static void hold_ends (const pg_tip_field *field, front_vertex *v, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (!field[i].extrapolated) continue;
        for (size_t far = 1; far < n; far++) {
            size_t at = i >= far && !field[i - far].extrapolated ? i - far : i + far;
            if (at >= n || field[at].extrapolated) continue;
            double width = v[i].width;
            v[i] = v[at], v[i].width = width;
            break;
        }
    }
}

/* Power of the ways that weights the energies of vertices: the load of an event is that at which the leading
 * vertices release, in the mean, what they take. Weighted by the ways themselves it would be the load of the
 * middle of the step. */
enum { LEADERS = 4 };

/* ---- all vertices -------------------------------------------------------------------------------------- */
double fronts_plan (const break_loop *b, const pg_state *state, double factor)
{
    const facet_growth *g = b->growth;
    const front_growth *f = g->fronts;
    double top = 0, gained = 0, taken = 0, lead;
    size_t nfront;
    const pg_front *front = pg_fronts_of_state (b->system.problem, state, &nfront);
    for (size_t i = 0; i < f->n; i++) front_judge (b, &g->field[i], factor, &f->vertex[i]);
    for (size_t k = 0; k < f->nfront; k++)
        hold_ends (g->field + f->first[k], f->vertex + f->first[k], f->first[k + 1] - f->first[k]);
    for (size_t i = 0; i < f->n; i++) top = fmax (top, f->vertex[i].share);
    if (!(top > 0)) return 0;
    for (size_t i = 0; i < f->n; i++) f->row[i] = facet_length (g, &g->field[i]);
    fronts_set_ways (g->fronts, f->row);
    for (size_t k = 0; k < f->nfront; k++) {
        size_t first = f->first[k], n = f->first[k + 1] - first;
        front_vertex *v = f->vertex + first;
        if (!n) continue;
        settle_rises (&front[k], v, facet_length (g, &g->field[first]));
        for (size_t i = 0; i < n; i++)
            lead = pow (v[i].way, LEADERS) * v[i].width,
                gained += v[i].J * v[i].ratio * lead, taken += v[i].need * lead;
    }
    return taken > 0 && gained > 0 ? sqrt (gained / taken) : 0;
}
