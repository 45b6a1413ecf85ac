/* SPDX-License-Identifier: GPL-3.0-or-later
 * Numbers of nodes and elements as a file gives them, found again in constant time. Most files number
 * without large gaps: a plain table serves. Else a hash table with open addressing, at most half full. */
#include "perigal/mesh.h"
#include <stdint.h>
#include <string.h>

/* Fibonacci hashing: multiplication by 2^64 over the golden ratio spreads consecutive numbers. */
static size_t slot_of (const pg_id_table *t, long id)
{
    uint64_t h = (uint64_t) id * UINT64_C (0x9E3779B97F4A7C15);
    return (size_t) (h >> 32) & t->mask;
}

/* Fills a plain table: the index of a number is its distance from the lowest. Entries of `direct` hold the
 * position in the list + 1; 0: empty. *twice: index of the first number that occurred before; n: none. */
static pg_status build_dense (pg_id_table *t, size_t *twice)
{
    pg_status status = PG_OK;
    PG_ALLOC (t->direct, t->range);
    for (size_t k = 0; k < t->n; k++) {
        int *at = &t->direct[(size_t) t->id[k] - (size_t) t->low];
        if (*at && *twice == t->n) *twice = k;
        if (!*at) *at = (int) k + 1;
    }
done:
    return status;
}

/* Fills a hash table with a power of two slots, at least twice as many as numbers; if a slot is taken by
 * another number the next one is tried. Entries and *twice: as in build_dense. */
static pg_status build_hash (pg_id_table *t, size_t *twice)
{
    pg_status status = PG_OK;
    size_t slots = 16;
    while (slots < 2 * t->n) slots *= 2;
    t->range = 0, t->mask = (unsigned) (slots - 1);
    PG_ALLOC (t->direct, slots);
    for (size_t k = 0; k < t->n; k++) {
        size_t s = slot_of (t, t->id[k]);
        while (t->direct[s] && t->id[t->direct[s] - 1] != t->id[k]) s = (s + 1) & t->mask;
        if (t->direct[s] && *twice == t->n) *twice = k;
        if (!t->direct[s]) t->direct[s] = (int) k + 1;
    }
done:
    return status;
}

/* A plain table takes at most four times the memory of the list. */
pg_status pg_id_table_build (pg_id_table *t, size_t n, const long *id, size_t *twice)
{
    long low = n ? id[0] : 0, high = low;
    memset (t, 0, sizeof *t);
    t->n = *twice = n, t->id = id;
    for (size_t k = 0; k < n; k++) {
        if (id[k] < low) low = id[k];
        if (id[k] > high) high = id[k];
    }
    t->low = low;
    size_t span = (size_t) high - (size_t) low;
    t->range = span < 4 * n + 64 ? span + 1 : 0;
    return t->range ? build_dense (t, twice) : build_hash (t, twice);
}

/* Subtraction in unsigned numbers covers also numbers below the lowest. */
long pg_id_table_find (const pg_id_table *t, long id)
{
    if (t->n == 0) return -1;
    if (t->range) {
        size_t at = (size_t) id - (size_t) t->low;
        return at < t->range ? (long) t->direct[at] - 1 : -1;
    }
    for (size_t s = slot_of (t, id); t->direct[s]; s = (s + 1) & t->mask)
        if (t->id[t->direct[s] - 1] == id) return t->direct[s] - 1;
    return -1;
}

/* The list of numbers belongs to the caller. */
void pg_id_table_clear (pg_id_table *t)
{
    pg_free (t->direct);
    memset (t, 0, sizeof *t);
}
