/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rows with equal bits are read from one place, once bonds are broken.
 *
 * From the first broken bond of a set on every point has a row of its own (galerkin_own). Most of a lattice
 * are still equal to the last bit, and sweeps over all points are bound by the memory that they read: 36
 * bytes a bond in space. So each point that has the row of an earlier one reads it there (pg_rows.at), and
 * all different rows stay in the caches. Nothing else changes: what a point has of its own is kept up to date
 * as well. Before a row is evaluated anew its point reads its own again, and those that read it there get
 * another place, which costs nothing but a number for each.
 *
 * Not where rows are corrected after they have been evaluated (consistent integration, stabilisation), in
 * plain runs, and where too many are different. */
#include "galerkin.h"
#include <stdint.h>
#include <string.h>

/* Points of a set from which on it is worth it; numbers of a row that its fingerprint is made of; of all
 * bonds different rows may have one SHARE-th. */
enum { LEAST = 512, PRINTS = 12, SHARE = 2 };

/* next: of points that read the row of the same leader, -1: the last one (n). Those that have left since
 * stay in the chain. leads: 1: points may read the row of this one (n). */
struct galerkin_leaders { int *next; unsigned char *leads; };

void galerkin_leaders_free (galerkin *g, int set)
{
    galerkin_leaders *l = g->leaders[set];
    if (!l) return;
    pg_free (l->next), pg_free (l->leads), pg_free (l);
    pg_free (g->rows[set].at);
    g->leaders[set] = NULL, g->rows[set].at = NULL;
    if (set == g->bulk) galerkin_follow (g);
}

/* From some of the numbers: rows that differ anywhere mostly differ there. */
static size_t print_of (const pg_rows *r, size_t p)
{
    size_t first = r->family.start[p] * (size_t) r->dim, last = r->family.start[p + 1] * (size_t) r->dim,
           step = (last - first) / PRINTS + 1;
    uint64_t print = (last - first) * 0x9e3779b97f4a7c15u;
    for (size_t k = first; k < last; k += step) {
        uint64_t bits;
        memcpy (&bits, r->dN + k, sizeof bits);
        print = (print ^ bits) * 0xff51afd7ed558ccdu;
        print ^= print >> 32;
    }
    return (size_t) print;
}

static int equal (const pg_rows *r, size_t p, size_t q)
{
    size_t a = r->family.start[p], b = r->family.start[q], m = r->family.start[p + 1] - a,
           dim = (size_t) r->dim;
    return r->family.start[q + 1] - b == m
           && memcmp (r->dN + a * dim, r->dN + b * dim, m * dim * sizeof *r->dN) == 0
           && memcmp (r->N + a, r->N + b, m * sizeof *r->N) == 0
           && memcmp (r->w + a, r->w + b, m * sizeof *r->w) == 0;
}

/* The leader of every point: the first that has its row. Returns the bonds of all leaders. */
static size_t elect (const pg_rows *r, galerkin_leaders *l, size_t *at, size_t *table, size_t slots)
{
    size_t bonds = 0;
    for (size_t p = 0; p < r->n; p++) {
        size_t s = print_of (r, p) & (slots - 1);
        while (table[s] && !equal (r, table[s] - 1, p)) s = (s + 1) & (slots - 1);
        l->next[p] = -1, at[p] = r->family.start[p];
        if (!table[s]) {
            table[s] = p + 1, l->leads[p] = 1;
            bonds += r->family.start[p + 1] - r->family.start[p];
            if (bonds > r->family.start[r->n] / SHARE) break;
            continue;
        }
        size_t leader = table[s] - 1;
        at[p] = r->family.start[leader];
        l->next[p] = l->next[leader], l->next[leader] = (int) p;
    }
    return bonds;
}

/* Rows of this set are own ones, of a lattice, as they have been evaluated. */
static int may_lead (const galerkin *g, const pg_state *state, int set)
{
    const pg_problem *p = g->problem;
    const pg_rows *r = &g->rows[set];
    return p->approx.congruent && !p->plain && !p->consistency && !(g->options->silling > 0)
           && set != PG_FACETS && r->n >= LEAST && !r->at && !g->borrows[set] && r->N && r->dN && r->w
           && !galerkin_all_alive (g, set, state);
}

pg_status galerkin_leaders_find (galerkin *g, const pg_state *state, int set)
{
    pg_status status = PG_OK;
    pg_rows *r = &g->rows[set];
    galerkin_leaders *l = NULL;
    size_t *at = NULL, *table = NULL, slots = 1024;
    if (!may_lead (g, state, set)) return PG_OK;
    while (slots < 2 * r->n) slots *= 2;
    PG_ALLOC (l, 1);
    PG_ALLOC (l->next, r->n);
    PG_ALLOC (l->leads, r->n);
    PG_ALLOC (at, r->n);
    PG_ALLOC (table, slots);
    if (elect (r, l, at, table, slots) > r->family.start[r->n] / SHARE) goto done;
    g->leaders[set] = l, r->at = at, l = NULL, at = NULL;
    if (set == g->bulk) galerkin_follow (g);
done:
    if (l) pg_free (l->next), pg_free (l->leads);
    pg_free (l), pg_free (at), pg_free (table);
    return status;
}

/* The first point of the chain that still reads the row of p leads from here on. */
static void hand_over (const pg_rows *r, galerkin_leaders *l, size_t p)
{
    size_t old = r->family.start[p];
    int heir = l->next[p];
    l->leads[p] = 0;
    while (heir >= 0 && (r->at[heir] != old || l->leads[heir])) heir = l->next[heir];
    if (heir < 0) return;
    l->leads[heir] = 1;
    for (int q = heir; q >= 0; q = l->next[q])
        if (r->at[q] == old) r->at[q] = r->family.start[heir];
}

void galerkin_leaders_leave (galerkin *g, int set, size_t count, const size_t *list)
{
    pg_rows *r = &g->rows[set];
    galerkin_leaders *l = g->leaders[set];
    for (size_t k = 0; l && k < count; k++) {
        size_t p = list[k];
        if (l->leads[p]) hand_over (r, l, p);
        r->at[p] = r->family.start[p];
    }
}
