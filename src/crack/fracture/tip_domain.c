/* SPDX-License-Identifier: GPL-3.0-or-later
 * Size of the integration rings around a tip. A ring may contain only one material and the two faces of its
 * own crack: no surface of the body, no other crack or tip (pg_tip_nearest), no interface, no support or load
 * on points except springs. Body forces are allowed if they act everywhere in it.
 *
 * Radii, in local spacings h: both rings begin at 1, where shape functions are no longer affected by the tip.
 * The near one, which gives the ratio of K_II to K_I and with it the direction, ends at 3: behind a kink the
 * field farther away is not yet that of the new facet. The wide one, which gives the magnitude, ends at 8,
 * but not far beyond the last turn of the crack, for J is independent of the ring only where the crack is
 * straight. Measured on cracks that grew (doc/accuracy.md); rings below 1.5 are useless. */
#include "front.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define INNER 1.0                                      /* all in local spacings */
#define NEAR  3.0
#define WIDE  8.0
#define CHORD 1.5
#define TURN  0.2                                      /* rad: smaller turns of the crack are ignored */

static double distance (const pg_problem *p, size_t node, const double *x)
{
    return hypot (p->cloud.x[2 * node] - x[0], p->cloud.x[2 * node + 1] - x[1]);
}

size_t tip_node_at (const pg_problem *p, const double *x)
{
    size_t nearest = 0;
    double least = INFINITY;
    for (size_t i = 0; i < p->cloud.n; i++) {
        double a = p->cloud.x[2*i] - x[0], b = p->cloud.x[2*i + 1] - x[1], square = a * a + b * b;
        if (square < least) least = square, nearest = i;
    }
    return nearest;
}

/* Returns 1: the node is in the set (bisection in its ascending points). */
static int member (const pg_set *set, size_t node)
{
    size_t low = 0, high = set->npoint;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if ((size_t) set->point[middle] < node) low = middle + 1;
        else high = middle;
    }
    return low < set->npoint && (size_t) set->point[low] == node;
}

static void end_room (pg_tip_field *out, double room, int limit, int load)
{
    if (room < out->room) out->room = room, out->limit = limit, out->load = load;
}

/* Limits the room to the nearest node with a support or point force. */
static void end_at_loads (pg_tip_field *out, const pg_problem *p)
{
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_set *set = p->boundary.load[l].set;
        if (p->boundary.load[l].kind == PG_BODY_FORCE || p->boundary.load[l].kind == PG_SPRING) continue;
        for (size_t i = 0; i < set->npoint; i++)
            end_room (out, distance (p, (size_t) set->point[i], out->x), PG_ROOM_LOAD, (int) l);
    }
}

int tip_same_material (const pg_problem *p, size_t i, size_t k)
{
    const pg_material *a = pg_problem_law (p, PG_NODES, i), *b = pg_problem_law (p, PG_NODES, k);
    if (pg_problem_interface (p, p->block[PG_NODES][i], p->block[PG_NODES][k])) return 0;
    return a == b || (a->type == b->type && a->mode == b->mode && a->mu == b->mu && a->nu == b->nu
                      && a->density == b->density);
}

/* Returns PG_ROOM_MATERIAL or PG_ROOM_FORCE if node i has another material or other body forces than `here`;
 * else PG_ROOM_FREE. */
static int differs (const pg_problem *p, size_t i, size_t here)
{
    if (!tip_same_material (p, i, here)) return PG_ROOM_MATERIAL;
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (p->boundary.load[l].kind == PG_BODY_FORCE
            && member (p->boundary.load[l].set, i) != member (p->boundary.load[l].set, here))
            return PG_ROOM_FORCE;
    return PG_ROOM_FREE;
}

/* Returns 1: there is only one material, and all body forces act everywhere. */
static int is_uniform (const pg_problem *p)
{
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (p->boundary.load[l].kind == PG_BODY_FORCE && p->boundary.load[l].set->npoint < p->cloud.n)
            return 0;
    return p->nmaterial == 1;
}

/* Limits the room to the nearest interface, which lies midway between nodes of the two sides. */
static void end_at_interfaces (pg_tip_field *out, const pg_problem *p, size_t here)
{
    if (is_uniform (p)) return;
    for (size_t i = 0; i < p->cloud.n; i++) {
        double away = distance (p, i, out->x) - 0.5 * pg_problem_spacing (p, PG_NODES, i);
        int what = away < out->room ? differs (p, i, here) : PG_ROOM_FREE;
        if (what != PG_ROOM_FREE) end_room (out, fmax (0, away), what, -1);
    }
}

double tip_room_about (const pg_problem *p, const pg_state *state, size_t tip, const double *x, size_t node,
                       double limit)
{
    const pg_ground g = pg_problem_ground (p);
    pg_tip_field at = { .x = { x[0], x[1] }, .load = -1,
                        .room = pg_path_room (&g, state->paths, tip, x, limit) };
    end_at_loads (&at, p);
    end_at_interfaces (&at, p, node);
    return at.room;
}

pg_status tip_domain (pg_tip_field *out, const pg_problem *p, const pg_state *state, size_t tip, size_t *node)
{
    pg_status status = PG_OK;
    const pg_ground g = pg_problem_ground (p);
    double from[2];
    memset (out, 0, sizeof *out);
    if (!state->paths || tip >= state->paths->ntip)
        PG_FAIL (PG_E_USAGE, "tip %zu of %zu is asked for", tip, state->paths ? state->paths->ntip : 0);
    memcpy (out->x, state->paths->tip[tip].x, 2 * sizeof *out->x);
    *node = tip_node_at (p, out->x);
    double h = out->h = pg_problem_spacing (p, PG_NODES, *node);
    int what;
    pg_tip_chord (state->paths, tip, CHORD * h, from, out->e);
    out->room = pg_tip_nearest (&g, state->paths, tip, WIDE * h, NULL, &what), out->load = -1;
    out->limit = what == PG_MEETS_SURFACE ? PG_ROOM_SURFACE : what == PG_MEETS_CRACK ? PG_ROOM_CRACK
                                                                                     : PG_ROOM_FREE;
    end_at_loads (out, p);
    end_at_interfaces (out, p, *node);
    double room = out->room;
    out->r1 = INNER * h;
    out->near = tip_is_ring (p, room, h) ? fmin (NEAR * h, room) : NAN;
    out->wide = fmin (fmin (WIDE * h, room), fmax (NEAR * h, pg_tip_straight (state->paths, tip, TURN)));
    if (isnan (out->near)) out->wide = NAN;
done:
    return status;
}

pg_status pg_tip_find (pg_tip_field *out, const pg_problem *p, const pg_state *state, size_t tip)
{
    size_t node;
    return tip_domain (out, p, state, tip, &node);
}

void pg_tip_limit_words (const pg_problem *p, const pg_tip_field *f, char *out, size_t size)
{
    static const char *const words[] = {
        [PG_ROOM_FREE] = "nothing", [PG_ROOM_SURFACE] = "the surface", [PG_ROOM_CRACK] = "another crack",
        [PG_ROOM_LOAD] = "a load", [PG_ROOM_MATERIAL] = "another material",
        [PG_ROOM_FORCE] = "the border of a body force", [PG_ROOM_FACES] = "crack faces that touch"
    };
    if (f->limit == PG_ROOM_LOAD && f->load >= 0 && (size_t) f->load < p->boundary.nload) {
        const pg_load *load = &p->boundary.load[f->load];
        snprintf (out, size, "the %s %.40s", pg_load_prescribes (load) ? "support" : "load", load->name);
    } else snprintf (out, size, "%s", words[f->limit]);
}
