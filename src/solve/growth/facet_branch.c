/* SPDX-License-Identifier: GPL-3.0-or-later
 * Branching of a moving crack tip. Two tips need twice the energy of one, and what there is at most is G (0),
 * what the tip would release if it stood still, as branches start slowly (Eshelby 1970, in Inelastic Behavior
 * of Solids, 77-115; Adda-Bedia 2005, J. Mech. Phys. Solids 53, 227-248: it is largest then). So a tip
 * branches where
 *
 *   G (0) >= 2 G0,   that is g (v) = G0 / G (0) <= 1/2,   v >= c_R / 2,
 *
 * in the mean over the time in which a Rayleigh wave goes on by four spacings, for a tip that has room for
 * rings of six spacings and has grown by four. Nothing is fitted, and below that no crack can branch; where
 * above it one does is open, as experiments scatter, too.
 *
 * The branches leave at +-30 degrees: K_II is 0 there (local symmetry; Katzav, Adda-Bedia and Arias 2007,
 * Int. J. Fract. 143, 245-271, for the shortest ones). Measured on static forks of 0.12 of an edge crack:
 * their first facets turn by +19, +16, +10, +2 and -3.5 degrees where they lie at 15, 20, 25, 30, 35. Each
 * has half of the energy, g = 2 G0 / G (0), but runs at a fifth of c_R at least; after two facets they are
 * 1.7 spacings apart, rings fit between them, and each goes its own way. */
#include "facet_growth.h"
#include <math.h>

static const double half_angle = 0.52359877559829887, least_speed = 0.2, least_ring = 6, least_way = 4;
enum { STRAIGHT = 2 };  /* facets along which branches run straight on, until they are apart */

int facet_branches (const break_loop *b, const pg_state *state, size_t i)
{
    const facet_growth *g = b->growth;
    const facet_run *r = &g->motion.run[i];
    const pg_tip_field *f = &g->field[i];
    const pg_criterion *c = b->system.problem->criterion;
    size_t n;
    int slides;
    if (!b->system.options->branching || c->type->path (c, &n) || isnan (f->near)) return 0;
    facet_judge (b, state, i, 1, NULL, &slides);
    if (f->closed || slides) return 0;                 /* closed or sliding tips do not branch */
    /* a ring that ends at a kink, and the path, may be as many facets long: lengths that differ by rounding
     * only */
    double equal = pg_cloud_same (&b->system.problem->cloud);
    return r->steady <= 0.5 && f->wide > least_ring * f->h - equal
           && state->paths->tip[i].grown > least_way * f->h - equal;
}

/* Finds a facet of length l from x at an angle; 0: the material allows none there. */
static int branch_from (const break_loop *b, const double *x, double angle, double l, facet_candidate *out)
{
    pg_fracture_limits limits;
    double middle[3] = { x[0] + 0.5 * l * cos (angle), x[1] + 0.5 * l * sin (angle), 0 };
    *out = (facet_candidate) { .tip = -1, .open = 2, .from = { x[0], x[1] },
                               .to = { x[0] + l * cos (angle), x[1] + l * sin (angle) } };
    if (!facet_limits (b, middle, angle, &limits)) return 0;
    out->energy = limits.energy * l * b->system.problem->cloud.thickness;
    return 1;
}

pg_status facet_fork (break_loop *b, pg_state *state, size_t i, double t, const double *d, int *done)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    const pg_tip_field f = g->field[i];
    facet_candidate branch[2];
    facet_candidate end = { .tip = (long) i, .to = { f.x[0], f.x[1] }, .close = 1 };
    facet_run run = g->motion.run[i];
    double ahead = atan2 (f.e[1], f.e[0]), l = facet_length (g, &f), c_R = run.speed / (1 - run.g);
    *done = 0;
    for (int k = 0; k < 2; k++)
        if (!branch_from (b, f.x, ahead + (k ? -half_angle : half_angle), l, &branch[k])) return PG_OK;
    PG_TRY (facet_grow_one (b, state, &end, t));
    PG_TRY (system_refresh (&b->system, state, &b->changes));
    for (int k = 0; k < 2; k++) {
        PG_TRY (facet_grow_one (b, state, &branch[k], t));
        PG_TRY (system_refresh (&b->system, state, &b->changes));
    }
    run.speed = run.least = c_R * fmax (1 - 2 * run.g, least_speed);
    run.g = run.mean = 1 - run.speed / c_R, run.steady = 1;
    run.way = 0, run.length = l, run.straight = STRAIGHT * (1 - 1e-9) * l;
    size_t last = state->paths->ntip;
    PG_TRY (facet_make_room (g, last));
    g->motion.run[last - 1] = g->motion.run[last - 2] = run;
    const facet_hold what = { .tip = (long) last - 2, .length = facet_zone (b) * l,
                              .energy = branch[0].energy + branch[1].energy };
    PG_TRY (facet_hold_begin (b, t, d, &what, NULL));
    *done = 1;
done:
    return status;
}
