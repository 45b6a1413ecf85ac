/* SPDX-License-Identifier: GPL-3.0-or-later
 * Springs that act on points within the rings of a tip. A spring of stiffness k whose other end is at g pulls
 * a point with the force - k (u - g): a body force that follows the displacement, so that it has the term of
 * body forces in J and in the interaction integrals, summed over the points instead of integrated. It needs
 * the displacement and its gradient at the points.
 *
 * The exact fields grow without bound towards the tip, where a point may lie. What a point does there is
 * spread over a disc as large as what belongs to it. */
#include "tip.h"
#include <math.h>
#include <string.h>

enum { RADII = 2, ANGLES = 8 };                        /* of the places in a disc */
static const double pi = 3.14159265358979323846;

void tip_mean_gradient (int mode, const tip_material *m, double r, double theta, double size, double *A)
{
    double x = r * cos (theta), y = r * sin (theta), at[RADII], w[RADII];
    memset (A, 0, 4 * sizeof *A);
    pg_gauss_rule (RADII, at, w);
    for (int i = 0; i < RADII; i++)
        for (int j = 0; j < ANGLES; j++) {
            /* equal weights in the square of the radius are equal areas */
            double away = size * sqrt (0.5 * (1 + at[i])), angle = 2 * pi * (j + 0.5) / ANGLES, H[4];
            double a = x + away * cos (angle), b = y + away * sin (angle);
            if (a < 0 && b * y < 0) b = -b;            /* the disc does not reach across the crack */
            pg_tip_near_field (mode, m->mu, m->kappa, hypot (a, b), atan2 (b, a), NULL, H, NULL);
            for (int k = 0; k < 4; k++) A[k] += 0.5 * w[i] / ANGLES * H[k];
        }
}

/* Does a spring act within the ring on point i of the set of a load? Its distance from the tip in
 * `offset`. */
static int reaches (const pg_problem *p, const pg_load *load, size_t i, const pg_tip_field *tip,
                    double offset[2])
{
    const double *x = p->cloud.x + 2 * (size_t) load->set->point[i];
    for (int c = 0; c < 2; c++) offset[c] = x[c] - tip->x[c];
    return pg_load_share (load, i) > 0 && hypot (offset[0], offset[1]) < tip->wide;
}

/* A point that several springs pull is there as often. */
pg_status tip_springs_create (tip_springs *out, const pg_tip_field *tip, const pg_problem *p)
{
    pg_status status = PG_OK;
    tip_grid *g = &out->grid;
    double offset[2], turned[2];
    size_t n = 0;
    memset (out, 0, sizeof *out);
    for (size_t l = 0; l < p->nload; l++)
        for (size_t i = 0; p->load[l].kind == PG_SPRING && i < p->load[l].set->npoint; i++)
            n += (size_t) reaches (p, &p->load[l], i, tip, offset);
    if (!n) return PG_OK;
    PG_ALLOC (g->r, n);
    PG_ALLOC (g->theta, n);
    PG_ALLOC (g->area, n);
    PG_ALLOC (g->x, 2 * n);
    PG_ALLOC (out->size, n);
    for (size_t l = 0; l < p->nload; l++)
        for (size_t i = 0; p->load[l].kind == PG_SPRING && i < p->load[l].set->npoint; i++) {
            if (!reaches (p, &p->load[l], i, tip, offset)) continue;
            size_t k = g->n++, point = (size_t) p->load[l].set->point[i];
            tip_turn (tip->e, offset, turned);
            g->r[k] = hypot (turned[0], turned[1]), g->theta[k] = atan2 (turned[1], turned[0]);
            g->area[k] = 1 / p->cloud.thickness;
            memcpy (g->x + 2*k, p->cloud.x + 2 * point, 2 * sizeof *g->x);
            out->size[k] = sqrt (p->cloud.volume[point] / (pi * p->cloud.thickness));
        }
done:
    if (status != PG_OK) tip_springs_clear (out);
    return status;
}

void tip_springs_clear (tip_springs *s)
{
    tip_grid_clear (&s->grid);
    pg_free (s->size);
    memset (s, 0, sizeof *s);
}

/* Component c of where the other end of a spring is in field `at`, m. */
static double goal (const pg_load *load, int c, const double *x, int at, const double *t)
{
    const double *site = pg_load_site (load, x);
    double end = pg_load_value (load, c, 2, site, t[at]);
    return at > 0 ? end - pg_load_value (load, c, 2, site, t[0]) : end;
}

/* Force of the springs of point i at x whose displacement in the frame of the tip is u, N, in the scene. */
static void pull_of (const pg_load *load, size_t i, const double *x, const double *u, int at, const double *e,
                     const double *t, double *pull)
{
    double moved[2] = { e[0] * u[0] - e[1] * u[1], e[1] * u[0] + e[0] * u[1] };
    for (int c = 0; c < 2; c++)
        pull[c] = load->stiffness[c] > 0
                      ? -load->stiffness[c] * pg_load_share (load, i) * (moved[c] - goal (load, c, x, at,
                                                                                          t)) : 0;
}

/* A point that no other one sees, such as one on a crack, has no gradient, and what pulls it pulls nothing
 * else. */
static int pass_over_alone (tip_sample *f, size_t k)
{
    double sum = f->excess ? f->excess[k] : 0;
    for (size_t c = 0; c < 2; c++) sum += f->u[2*k + c];
    for (size_t c = 0; c < 4; c++) sum += f->H[4*k + c];
    for (size_t c = 0; c < 3; c++) sum += f->stress[3*k + c];
    if (isfinite (sum)) return 0;
    for (size_t c = 0; c < 2; c++) f->u[2*k + c] = 0;
    for (size_t c = 0; c < 4; c++) f->H[4*k + c] = 0;
    for (size_t c = 0; c < 3; c++) f->stress[3*k + c] = 0;
    if (f->excess) f->excess[k] = 0;
    return 1;
}

pg_status tip_springs_sample (tip_springs *s, int at, const pg_tip_field *tip, const tip_material *material,
                              const pg_problem *p, const pg_force_type *force, void *self,
                              const pg_state *state, const mean_motion *d, const double *t)
{
    pg_status status = PG_OK;
    tip_grid *g = &s->grid;
    tip_sample *f = &g->field[at];
    double offset[2];
    size_t k = 0;
    if (!g->n) return PG_OK;
    PG_ALLOC (f->load, 2 * g->n);
    PG_TRY (tip_grid_sample (g, at, tip, material, p, force, self, state, d));
    for (size_t l = 0; l < p->nload; l++) {
        const pg_load *load = &p->load[l];
        for (size_t i = 0; load->kind == PG_SPRING && i < load->set->npoint; i++) {
            if (!reaches (p, load, i, tip, offset)) continue;
            double pull[2] = { 0 };
            if (!pass_over_alone (f, k)) pull_of (load, i, g->x + 2*k, f->u + 2*k, at, tip->e, t, pull);
            tip_turn (tip->e, pull, f->load + 2*k), k++;
        }
    }
done:
    return status;
}

/* The point of a list that is nearest to x; n: the list is empty. */
static size_t nearest_of (const pg_problem *p, const size_t *list, size_t n, const double *x)
{
    size_t best = n;
    double least = INFINITY;
    for (size_t k = 0; k < n; k++) {
        double d = hypot (p->cloud.x[2 * list[k]] - x[0], p->cloud.x[2 * list[k] + 1] - x[1]);
        if (d < least) least = d, best = k;
    }
    return best;
}

/* Nodes that may be the nearest of a place in the ring. */
static pg_status nodes_around (const pg_problem *p, const pg_tip_field *tip, size_t **list, size_t *n)
{
    pg_status status = PG_OK;
    size_t cap = 0;
    *n = 0;
    for (size_t i = 0; i < p->cloud.n; i++) {
        if (hypot (p->cloud.x[2*i] - tip->x[0], p->cloud.x[2*i + 1] - tip->x[1]) > tip->wide + 2 * tip->h)
            continue;
        PG_GROW (*list, cap, *n + 1);
        (*list)[(*n)++] = i;
    }
done:
    return status;
}

pg_status tip_springs_spread (tip_grid *grid, int at, const pg_tip_field *tip, const pg_problem *p,
                              const double *t)
{
    pg_status status = PG_OK;
    tip_sample *f = &grid->field[at];
    size_t *node = NULL, n = 0, springs = 0, *of = NULL;
    for (size_t l = 0; l < p->nload; l++) springs += p->load[l].kind == PG_SPRING;
    if (!springs) return PG_OK;
    PG_TRY (nodes_around (p, tip, &node, &n));
    PG_ALLOC (of, p->cloud.n);
    if (!f->load) PG_ALLOC (f->load, 2 * grid->n);
    for (size_t l = 0; l < p->nload; l++) {
        const pg_load *load = &p->load[l];
        if (load->kind != PG_SPRING) continue;
        memset (of, 0, p->cloud.n * sizeof *of);       /* 1 + number within the set */
        for (size_t i = 0; i < load->set->npoint; i++) of[load->set->point[i]] = 1 + i;
        for (size_t k = 0; k < grid->n; k++) {
            size_t near = nearest_of (p, node, n, grid->x + 2*k);
            double pull[2], turned[2];
            if (near == n || !of[node[near]]) continue;
            pull_of (load, of[node[near]] - 1, grid->x + 2*k, f->u + 2*k, at, tip->e, t, pull);
            tip_turn (tip->e, pull, turned);
            for (size_t c = 0; c < 2; c++) f->load[2*k + c] += turned[c] / p->cloud.volume[node[near]];
        }
    }
done:
    pg_free (node), pg_free (of);
    return status;
}
