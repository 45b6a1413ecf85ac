/* SPDX-License-Identifier: GPL-3.0-or-later
 * The group of bonds in which events are looked for: around points near their limit, by steps from node to
 * node through families, which are as large as the reach of a break for every spacing and dimension. Nodes at
 * the ends of bonds near their limit have level 0, nodes in their families level 1, and so on; a point has
 * the smallest level of its neighbours. */
#include "event_ahead.h"
#include <string.h>

/* Largest number of levels of the inner part: more events fit into a wide group, but in a small body, as 3D
 * bodies often are, it would hold most bonds. FAR: a level that was not reached. */
enum { WIDEST_INNER = 2, FAR = 255 };

/* Levels beyond the inner part that a break there can touch: points with a touched node in their family; with
 * consistent integration also those of neighbouring cells. */
static int beyond (const pg_problem *p) { return p->form.integration->consistent ? 3 : 1; }

void event_zone_clear (event_zone *z)
{
    pg_bond_group_clear (&z->group);
    pg_free (z->left_out), pg_free (z->level), pg_free (z->front);
    for (int set = 0; set < PG_BOND_SETS; set++) pg_free (z->inner[set]);
    memset (z, 0, sizeof *z);
}

pg_status event_zone_room (event_zone *z, const pg_problem *p)
{
    pg_status status = PG_OK;
    if (z->left_out) return PG_OK;
    PG_ALLOC (z->level, p->cloud.n);
    PG_ALLOC (z->front, 2 * p->cloud.n);
    for (int set = 0; set < PG_BOND_SETS; set++) PG_ALLOC (z->inner[set], p->bonds.rows[set].n);
    PG_ALLOC (z->left_out, p->bonds.first[PG_BOND_SETS]);
done:
    return status;
}

/* Sets the levels of all nodes, from the ends of the bonds near their limit. */
static void spread (event_zone *z, const pg_problem *p, const pg_state *state, const double *near, double cut)
{
    int *now = z->front, *next = z->front + p->cloud.n;
    size_t n = 0;
    memset (z->level, FAR, p->cloud.n);
    for (int set = 0; set < PG_BOND_SETS; set++)
        for (size_t i = p->bonds.first[set]; i < p->bonds.first[set + 1]; i++) {
            if (!(near[i] >= cut) || !state->alive[i]) continue;
            int j = p->bonds.rows[set].family.node[i - p->bonds.first[set]];
            if (z->level[j] == FAR) now[n++] = j;
            z->level[j] = 0;
        }
    for (int level = 1; level <= WIDEST_INNER + beyond (p); level++) {
        const pg_family *f = &p->bonds.rows[PG_NODES].family;
        size_t count = 0;
        for (size_t k = 0; k < n; k++)
            for (size_t e = f->start[now[k]]; e < f->start[now[k] + 1]; e++) {
                int j = f->node[e];
                if (z->level[j] != FAR) continue;
                z->level[j] = (unsigned char) level, next[count++] = j;
            }
        int *swap = now;
        now = next, next = swap, n = count;
    }
}

/* Smallest level of a point's neighbours. */
static int level_of (const event_zone *z, const pg_family *f, size_t p)
{
    int least = FAR;
    for (size_t e = f->start[p]; e < f->start[p + 1] && least > 0; e++)
        if (z->level[f->node[e]] < least) least = z->level[f->node[e]];
    return least;
}

/* Marks the bonds of the points up to this level and what lies beyond; returns how many. */
static size_t mark_bonds (event_zone *z, const pg_problem *p, int inner)
{
    size_t n = 0;
    memset (z->left_out, 0, p->bonds.first[PG_BOND_SETS]);
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_family *f = &p->bonds.rows[set].family;
        for (size_t q = 0; q < f->n; q++) {
            int level = level_of (z, f, q);
            z->inner[set][q] = (set == PG_NODES ? z->level[q] : level) <= inner;
            if (level > inner + beyond (p)) continue;
            memset (z->left_out + p->bonds.first[set] + f->start[q], 1, f->start[q + 1] - f->start[q]);
            n += f->start[q + 1] - f->start[q];
        }
    }
    return n;
}

/* Makes the group: all bonds of points up to the outer level, from the levels of the nodes; they are counted
 * first. A node is in the inner part by its own level, as all points with it in their family must be in the
 * group. The inner part is the widest for which the group has at most the share `most` of the bonds. */
pg_status event_zone_fill (event_zone *z, const pg_system *sys, double most, double *share)
{
    pg_status status = PG_OK;
    const pg_problem *p = sys->problem;
    size_t nbond = p->bonds.first[PG_BOND_SETS], n = 0;
    int can;
    z->known = 0, *share = 1;
    for (int inner = WIDEST_INNER; inner >= 0 && *share > most; inner--) {
        n = mark_bonds (z, p, inner);
        *share = nbond ? (double) n / (double) nbond : 1;
    }
    if (n == 0 || *share > most) goto done;
    pg_free (z->group.bond), z->group.bond = NULL;
    PG_ALLOC (z->group.bond, n);
    z->group.n = 0;
    for (size_t i = 0; i < nbond; i++) if (z->left_out[i]) z->group.bond[z->group.n++] = i;
    PG_TRY (sys->force->spares.gather (sys->self, &z->group, &can));
    if (!can) *share = 1;
    z->known = can;
done:
    return status;
}

pg_status event_zone_make (event_zone *z, const pg_system *sys, const pg_state *state, const double *near,
                           double cut, double most, double *share)
{
    pg_status status = PG_OK;
    PG_TRY (event_zone_room (z, sys->problem));
    spread (z, sys->problem, state, near, cut);
    PG_TRY (event_zone_fill (z, sys, most, share));
done:
    return status;
}

/* 1: bond k of the group may break: its point, whose shape functions alone it changes, is in the inner
 * part. */
int event_zone_inner (const event_zone *z, size_t k)
{
    int set = 0;
    while (set + 1 < PG_BOND_SETS && k >= z->group.first[set + 1]) set++;
    return z->inner[set][z->group.owner[k]];
}
