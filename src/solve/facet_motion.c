/* SPDX-License-Identifier: GPL-3.0-or-later
 * Facets in a body that moves. A tip does not jump from facet to facet as at rest: it runs at the speed at
 * which it takes what the material takes, to first order G (v) = G (0) (1 - v / c_R) = G0 (Freund 1990,
 * Dynamic Fracture Mechanics, section 6.4), so that
 *
 *   v = c_R (1 - G0 / G (0)),
 *
 * G (0) the energy release rate of the tip at rest in the field at hand, kinetic terms included, c_R the
 * speed of the Rayleigh wave of the material. The way adds up over the time steps, and when it is a facet
 * long, one grows. New cracks do not begin in motion. */
#include "facet_growth.h"
#include <math.h>

/* A new tip has come no way yet. */
static pg_status make_room (facet_growth *g)
{
    pg_status status = PG_OK;
    PG_GROW (g->way, g->cap_way, g->ntip);
    for (; g->nway < g->ntip; g->nway++) g->way[g->nway] = 0;
done:
    return status;
}

/* Of the material at the tip, m/s. */
static double rayleigh_speed (const break_loop *b, const pg_tip_field *f)
{
    const pg_problem *p = b->system.problem;
    long node = pg_nearest_find (b->growth->near, f->x, NULL, NULL);
    return node < 0 ? 0 : pg_material_waves (&p->material[p->block[PG_NODES][node]]).rayleigh;
}

pg_status facet_run (break_loop *b, const pg_state *state, double dt, int *any)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    double angle;
    *any = 0;
    PG_TRY (make_room (g));
    for (size_t i = 0; i < g->ntip; i++) {
        double over = facet_judge (b, state, i, 1, &angle), length = facet_length (g, &g->field[i]);
        if (!(over > 1)) continue;
        double way = isfinite (dt) ? rayleigh_speed (b, &g->field[i]) * (1 - 1 / (over * over)) * dt : length;
        g->way[i] = fmin (g->way[i] + way, length);
        *any |= facet_has_come (g, i);
    }
done:
    return status;
}

int facet_has_come (const facet_growth *g, size_t tip)
{
    return g->way[tip] >= facet_length (g, &g->field[tip]) * (1 - 1e-9);
}

void facet_rest (facet_growth *g)
{
    g->moving = 0, g->fresh = 0, g->nway = 0;
}
