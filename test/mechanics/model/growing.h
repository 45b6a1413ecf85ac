/* SPDX-License-Identifier: GPL-3.0-or-later
 * growing.h: a problem whose cracks grow call by call, in the plane and in space: the bonds that a call finds
 * die, and those that are dead must be those that the cracks of the state cut. */
#ifndef PERIGAL_TEST_GROWING_H
#define PERIGAL_TEST_GROWING_H
#include "scenes.h"

typedef struct { built b; const pg_problem *p; pg_ground ground; pg_state *s; pg_changes cut; } growing;

/* A state with paths or surfaces, whatever the criterion. */
static inline growing begin (const char *text)
{
    growing g = { .b = build (text) };
    g.p = g.b.problem, g.ground = pg_problem_ground (g.p);
    check_ok (pg_state_create (&g.s, g.p, pg_problem_unknowns (g.p)));
    if (g.p->cloud.dim == 3 && !g.s->surfaces) check_ok (pg_crack_surfaces_create (&g.s->surfaces, g.p));
    return g;
}

static inline void end (growing *g)
{
    pg_free (g->cut.bond);
    pg_state_free (&g->s);
    unbuild (&g->b);
}

/* The bonds that were found die; each is named once, in ascending order. Returns how many. */
static inline size_t bury (growing *g)
{
    size_t n = g->cut.n;
    for (size_t i = 0; i < n; i++) {
        assert_true (i == 0 || g->cut.bond[i] > g->cut.bond[i - 1]);
        assert_true (g->s->alive[g->cut.bond[i]]);
        g->s->alive[g->cut.bond[i]] = 0;
    }
    g->cut.n = 0;
    return n;
}

/* Every bond of every set is dead exactly if the cracks of the state cut it; every `few`-th of them asks all
 * cracks one by one as well, without their boxes. Returns the dead ones. */
static inline size_t check_mask (const growing *g, size_t few)
{
    const pg_problem *p = g->p;
    const pg_cracks *cracks = pg_state_cracks (p, g->s);
    size_t dim = (size_t) p->cloud.dim, dead = 0;
    pg_cracks plain = { .dim = p->cloud.dim, .crack = cracks->crack, .n = cracks->n };
    for (int set = 0; set < PG_BOND_SETS; set++)
        for (size_t q = 0; q < p->bonds.rows[set].n; q++)
            for (size_t e = p->bonds.rows[set].family.start[q]; e < p->bonds.rows[set].family.start[q + 1];
                 e++) {
                int j = p->bonds.rows[set].family.node[e];
                const double *x = p->bonds.rows[set].x + dim * q, *y = p->cloud.x + dim * (size_t) j;
                if (j == p->bonds.rows[set].own[q]) continue;
                int cut = pg_cracks_cut (cracks, x, y, 1e-9 * p->cloud.h) != NULL;
                if (e % few == 0)
                    assert_int_equal (cut, pg_cracks_cut (&plain, x, y, 1e-9 * p->cloud.h) != NULL);
                assert_int_equal (g->s->alive[p->bonds.first[set] + e], !cut);
                dead += (size_t) cut;
            }
    return dead;
}
#endif
