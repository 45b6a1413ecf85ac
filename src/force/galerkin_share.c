/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shape functions of points that see their nodes alike are kept once.
 *
 * On a lattice almost all evaluation points have the N, dN and w of some other one, to the last bit, as bonds
 * are rounded before anything is computed of them (approx/congruent.h). A block of 993 000 unknowns has
 * 93 million bonds, 40 bytes each, but some thousand different rows. While no bond of a set is broken its
 * rows are therefore kept as a list of different ones, and of each point only where its own begins
 * (pg_rows.at). Rows are evaluated in parts, and those of a part are compared, bit by bit, with all
 * that have been seen: what is shared is what would have been stored, and no answer changes. Memory that is
 * never touched need not be cleared by the system either, which on large bodies takes longer than evaluation.
 *
 * With the first broken bond (galerkin_own), where rows are mostly different after all, with consistent
 * integration and stabilisation, which correct rows, and in plain runs each point has a row of its own. */
#include "galerkin.h"
#include <stdint.h>
#include <string.h>

/* Points of a part; points of a set from which on sharing is worth a list; numbers of a row that its
 * fingerprint is made of; different rows have at most a SHARE-th of all bonds, and the bonds of two parts. */
enum { PART = 16384, LEAST = 512, PRINTS = 12, SHARE = 4 };

/* A row that is kept: its first bond in the list, number of bonds, fingerprint. */
typedef struct { size_t at, bonds; uint64_t print; } kept_row;

/* The list while it grows. */
typedef struct {
    size_t   dim;
    double  *N, *dN, *w;                               /* values of all different rows */
    size_t   cap_N, cap_dN, cap_w, bonds;              /* room, and bonds in the list */
    kept_row *row;  size_t n, cap;
    size_t  *table, slots;                             /* by fingerprint: number + 1; a power of two */
} row_list;

static void list_clear (row_list *l)
{
    pg_free (l->N), pg_free (l->dN), pg_free (l->w), pg_free (l->row), pg_free (l->table);
    memset (l, 0, sizeof *l);
}

/* From some of the numbers: rows that differ anywhere mostly differ there. */
static uint64_t fingerprint (size_t bonds, size_t numbers, const double *value)
{
    uint64_t print = bonds * 0x9e3779b97f4a7c15u;
    size_t step = numbers / PRINTS + 1;
    for (size_t k = 0; k < numbers; k += step) {
        uint64_t bits;
        memcpy (&bits, value + k, sizeof bits);
        print = (print ^ bits) * 0xff51afd7ed558ccdu;
        print ^= print >> 32;
    }
    return print;
}

/* A table twice as large as the list needs. */
static pg_status widen_table (row_list *l)
{
    pg_status status = PG_OK;
    size_t slots = l->slots ? 2 * l->slots : 1024, *table = NULL;
    if (2 * l->n < l->slots) return PG_OK;
    PG_ALLOC (table, slots);
    for (size_t k = 0; k < l->n; k++) {
        size_t s = (size_t) l->row[k].print & (slots - 1);
        while (table[s]) s = (s + 1) & (slots - 1);
        table[s] = k + 1;
    }
    pg_free (l->table), l->table = table, l->slots = slots;
done:
    return status;
}

/* Where the values of a row are: those of an equal one, or its own, appended. */
static pg_status place_row (row_list *l, size_t m, const double *N, const double *dN, const double *w,
                            size_t *at)
{
    pg_status status = PG_OK;
    uint64_t print = fingerprint (m, m * l->dim, dN);
    PG_TRY (widen_table (l));
    size_t s = (size_t) print & (l->slots - 1);
    for (; l->table[s]; s = (s + 1) & (l->slots - 1)) {
        const kept_row *k = &l->row[l->table[s] - 1];
        if (k->print != print || k->bonds != m) continue;
        if (memcmp (l->dN + k->at * l->dim, dN, m * l->dim * sizeof *dN) != 0
            || memcmp (l->N + k->at, N, m * sizeof *N) != 0 || memcmp (l->w + k->at, w, m * sizeof *w) != 0)
            continue;
        *at = k->at;
        return PG_OK;
    }
    PG_GROW (l->N, l->cap_N, l->bonds + m);
    PG_GROW (l->dN, l->cap_dN, (l->bonds + m) * l->dim);
    PG_GROW (l->w, l->cap_w, l->bonds + m);
    PG_GROW (l->row, l->cap, l->n + 1);
    memcpy (l->N + l->bonds, N, m * sizeof *N);
    memcpy (l->dN + l->bonds * l->dim, dN, m * l->dim * sizeof *dN);
    memcpy (l->w + l->bonds, w, m * sizeof *w);
    l->row[l->n++] = (kept_row) { l->bonds, m, print };
    l->table[s] = l->n;
    *at = l->bonds, l->bonds += m;
done:
    return status;
}

/* The rows first .. last - 1 of r as rows of their own, which begin with bond 0; start: room for their
 * family's. Values are left to the caller. */
static pg_rows part_of (const pg_rows *r, size_t first, size_t last, size_t *start)
{
    pg_rows part = *r;
    size_t from = r->family.start[first], dim = (size_t) r->dim;
    for (size_t i = first; i <= last; i++) start[i - first] = r->family.start[i] - from;
    part.n = last - first, part.family.start = start, part.family.node = r->family.node + from;
    part.x = r->x + first * dim, part.grade = r->grade + first;
    part.weight = r->weight ? r->weight + first : NULL;
    part.wide = r->wide ? r->wide + first : NULL;
    part.own = r->own ? r->own + first : NULL, part.cell = r->cell ? r->cell + first : NULL;
    part.at = NULL, part.copied = part.copied_bonds = 0;
    return part;
}

/* Most bonds of PART rows that follow each other from a multiple of PART on. */
static size_t widest_part (const pg_rows *r)
{
    size_t most = 0;
    for (size_t i = 0; i < r->n; i += PART) {
        size_t last = i + PART < r->n ? i + PART : r->n, bonds = r->family.start[last] - r->family.start[i];
        if (bonds > most) most = bonds;
    }
    return most;
}

/* Evaluates all rows of a set, none of whose bonds is broken, part by part into a list of different ones.
 * *shared 0: too many are different, and nothing is kept. */
static pg_status share (galerkin *g, const unsigned char *alive, int set, int *shared)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    pg_rows *r = &g->rows[set], part = { 0 };
    row_list l = { .dim = (size_t) g->dim };
    size_t *start = NULL, *at = NULL, most = widest_part (r);
    double *value = NULL;
    *shared = 0;
    PG_ALLOC (start, PART + 1);
    PG_ALLOC (at, r->n);
    PG_ALLOC (value, most * (2 + l.dim));
    for (size_t first = 0; first < r->n; first += PART) {
        size_t last = first + PART < r->n ? first + PART : r->n;
        part = part_of (r, first, last, start);
        part.N = value, part.w = value + most, part.dN = part.w + most;
        PG_TRY (p->approx.type->evaluate (&p->approx, &p->cloud, &part, alive + r->family.start[first],
                                          part.n, NULL, g->threads));
        for (size_t i = 0; i < part.n; i++) {
            size_t e = start[i];
            PG_TRY (place_row (&l, start[i + 1] - e, part.N + e, part.dN + e * l.dim, part.w + e,
                               &at[first + i]));
        }
        r->copied += part.copied, r->copied_bonds += part.copied_bonds;
        if (l.bonds > r->family.start[last] / SHARE + 2 * most) goto done;
    }
    r->N = l.N, r->dN = l.dN, r->w = l.w, r->at = at, *shared = 1;
    l.N = l.dN = l.w = NULL, at = NULL;
done:
    if (!*shared) r->copied = r->copied_bonds = 0;
    list_clear (&l);
    pg_free (start), pg_free (at), pg_free (value);
    return status;
}

/* May rows of this set be shared? Boundary facets are few. */
static int may_share (const galerkin *g, const pg_state *state, int set)
{
    const pg_problem *p = g->problem;
    return p->approx.congruent && !p->plain && !p->consistency && !(g->options->silling > 0)
           && set != PG_FACETS && g->rows[set].n >= LEAST && galerkin_all_alive (g, set, state);
}

pg_status galerkin_evaluate (galerkin *g, const pg_state *state, int set, size_t count, const size_t *list)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    const unsigned char *alive = state->alive + p->first_bond[set];
    pg_rows *r = &g->rows[set];
    size_t bonds = r->family.start[r->n];
    if (!list) galerkin_leaders_free (g, set);
    int shared = r->at && !g->leaders[set];            /* all bonds live as they did: nothing has changed */
    if (!r->N && !list && may_share (g, state, set)) PG_TRY (share (g, alive, set, &shared));
    if (!shared) {
        if (!r->N || !r->dN || !r->w) list = NULL, count = r->n;   /* of none of them values are known */
        if (!r->N) PG_ALLOC (r->N, bonds);
        if (!r->dN) PG_ALLOC (r->dN, bonds * (size_t) g->dim);
        if (!r->w) PG_ALLOC (r->w, bonds);
        if (list) galerkin_leaders_leave (g, set, count, list);
        PG_TRY (p->approx.type->evaluate (&p->approx, &p->cloud, r, alive, count, list, g->threads));
        if (!list) PG_TRY (galerkin_leaders_find (g, state, set));
    }
done:
    galerkin_follow (g);
    return status;
}

size_t galerkin_shared_bonds (const galerkin *g)
{
    size_t sum = 0;
    for (int s = 0; s < PG_BOND_SETS; s++)
        if (g->rows[s].at && !g->leaders[s]) sum += g->rows[s].family.start[g->rows[s].n];
    return sum;
}
