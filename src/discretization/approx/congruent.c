/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cache of the shape functions of positions with equal surroundings (congruent.h). */
#include "congruent.h"
#include <string.h>

/* SLOTS: most slots. FEW: calls with fewer rows keep nothing, as that costs more than it saves. PATIENCE:
 * after this many rows in succession without an equal one the search is given up. */
enum { SLOTS = 1024, FEW = 16, PATIENCE = 8 * SLOTS };

/* Adding and subtracting this rounds a number of size 1 to a multiple of 2^-40: from 4096 on numbers are
 * 2^-40 apart. */
static const double ROUNDING = 6144;

struct congruent_slot {
    uint64_t print;
    /* Number of bonds in the row. */
    size_t   n;
    /* 1: the slot holds a row; 0: it is empty. */
    int      used;
    unsigned char grade;
};

/* Doubles in the store for one slot. */
static size_t stride (const congruent *c) { return c->most * (2 * (size_t) c->dim + 3); }

pg_status congruent_create (congruent *out, const pg_rows *rows, size_t count, size_t most)
{
    pg_status status = PG_OK;
    *out = (congruent) { .dim = rows->dim, .with_N = rows->N != NULL, .with_dN = rows->dN != NULL,
                         .most = most };
    if (count < FEW || most == 0) return PG_OK;
    size_t slots = FEW;
    while (slots < SLOTS && 2 * slots < count) slots *= 2;
    PG_ALLOC (out->slot, slots);
    PG_ALLOC (out->store, slots * stride (out));
    out->slots = slots;
done:
    return status;
}

void congruent_clear (congruent *c)
{
    pg_free (c->slot), pg_free (c->store);
    memset (c, 0, sizeof *c);
}

void congruent_round (size_t n, double *z)
{
    for (size_t k = 0; k < n; k++) z[k] = (z[k] + ROUNDING) - ROUNDING;
}

/* A fingerprint of the surroundings, computed from a few of the bonds only: surroundings that differ anywhere
 * mostly differ there. */
static uint64_t fingerprint (const pg_neighbourhood *s, size_t n)
{
    size_t dim = (size_t) s->dim, numbers = s->n * dim;
    uint64_t print = pg_fingerprint_numbers (n, numbers, numbers / 8 + 1, s->z);
    return s->n ? pg_fingerprint_numbers (print, dim, 1, s->z + numbers - dim) : print;
}

/* Do the n nodes have the volumes in `kept`, bit by bit? On a lattice volumes are 1 to 8 eighths of a
 * cell. */
static int same_volumes (const double *kept, const double *volume, const int *node, size_t n)
{
    for (size_t k = 0; k < n; k++) if (kept[k] != volume[node[k]]) return 0;
    return 1;
}

int congruent_find (congruent *c, const pg_neighbourhood *s, const double *volume, pg_rows *rows, size_t i,
                    size_t *slot)
{
    size_t first = rows->family.start[i], n = rows->family.start[i + 1] - first, dim = (size_t) c->dim,
           at = first + pg_rows_offset (rows, i);
    const int *node = rows->family.node + first;
    *slot = SIZE_MAX;
    if (!c->slots || c->missed > PATIENCE) return 0;
    uint64_t print = fingerprint (s, n);
    *slot = (size_t) (print & (c->slots - 1));
    struct congruent_slot *k = &c->slot[*slot];
    double *z = c->store + *slot * stride (c), *v = z + c->most * dim, *w = v + c->most, *N = w + c->most,
           *dN = N + c->most;
    if (!k->used || k->print != print || k->n != n
        || memcmp (z, s->z, s->n * dim * sizeof *z) != 0 || !same_volumes (v, volume, node, n)) {
        /* The bonds are stored now, since computing the row reorders them. */
        *k = (struct congruent_slot) { print, n, 0, 0 };
        memcpy (z, s->z, s->n * dim * sizeof *z);
        c->missed++;
        return 0;
    }
    if (c->with_N) memcpy (rows->N + at, N, n * sizeof *N);
    if (c->with_dN) memcpy (rows->dN + at * dim, dN, n * dim * sizeof *dN);
    if (rows->w) memcpy (rows->w + at, w, n * sizeof *w);
    rows->grade[i] = k->grade;
    c->copied++, c->copied_bonds += n, c->missed = 0;
    return 1;
}

void congruent_keep (congruent *c, size_t slot, const pg_rows *rows, size_t i, const double *volume)
{
    if (slot == SIZE_MAX) return;
    size_t first = rows->family.start[i], n = rows->family.start[i + 1] - first, dim = (size_t) c->dim,
           at = first + pg_rows_offset (rows, i);
    double *z = c->store + slot * stride (c), *v = z + c->most * dim, *w = v + c->most, *N = w + c->most,
           *dN = N + c->most;
    for (size_t k = 0; k < n; k++) v[k] = volume[rows->family.node[first + k]];
    if (c->with_N) memcpy (N, rows->N + at, n * sizeof *N);
    if (c->with_dN) memcpy (dN, rows->dN + at * dim, n * dim * sizeof *dN);
    if (rows->w) memcpy (w, rows->w + at, n * sizeof *w);
    c->slot[slot].grade = rows->grade[i];
    c->slot[slot].used = 1;
}
