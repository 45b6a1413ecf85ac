/* SPDX-License-Identifier: GPL-3.0-or-later
 * Alive bits: a bit for each bond of the stencil and each site, 1: the bond is intact. Sets all, or those of
 * some bonds. */
#include "folded_stencil.h"
#include <string.h>

/* Returns the bond of the stencil with this jump (padded places to the neighbour); n: none. It is searched
 * from `from` on, as families mostly ascend as the stencil does, then by bisection. */
static size_t bond_of (const stencil *s, ptrdiff_t jump, size_t from)
{
    size_t n = s->job.n, low = 0, high = n;
    for (size_t j = from; j < n && s->jump[j] <= jump; j++) if (s->jump[j] == jump) return j;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (s->jump[middle] < jump) low = middle + 1;
        else high = middle;
    }
    return low < n && s->jump[low] == jump ? low : n;
}

/* Returns the jump of an entry of the family: padded places from point i to its neighbour. */
static ptrdiff_t jump_of (const stencil *s, size_t i, size_t entry)
{
    return (ptrdiff_t) s->place[s->setting.family->node[entry]] - (ptrdiff_t) s->place[i];
}

/* Sets the alive bits of the intact bonds of point i (live NULL: all are intact); exempt not NULL: also the
 * bits of bonds that may break. PG_E_USAGE: a bond is not one of the stencil, so that the family belongs to
 * other points. */
static pg_status set_bits (stencil *s, size_t i, const unsigned char *live, const unsigned char *exempt)
{
    pg_status status = PG_OK;
    const pg_family *family = s->setting.family;
    unsigned bit;
    size_t k = pg_stencil_loop_block (s, s->place[i], &bit), b = 0;
    for (size_t e = family->start[i]; e < family->start[i + 1]; e++) {
        if (live && !live[e]) continue;
        b = bond_of (s, jump_of (s, i, e), b);
        if (b == s->job.n)
            PG_FAIL (
                PG_E_USAGE,
                "points %zu and %d: their bond is not one of the lattice's stencil; try evaluation: list", i,
                family->node[e]);
        s->alive[k * s->job.n + b] |= 1u << bit;
        if (exempt && !exempt[i] && !exempt[family->node[e]]) s->may[k * s->job.n + b] |= 1u << bit;
    }
done:
    return status;
}

typedef struct {
    stencil *s;
    const unsigned char *live, *exempt;
    pg_status status[MAX_THREADS];
    size_t lost[MAX_THREADS];
} renewal;

/* Has point i all bonds of the stencil, in the same order in the family, and are all of them intact? */
static int has_all (const stencil *s, size_t i, const unsigned char *live)
{
    const pg_family *family = s->setting.family;
    const int *node = family->node + family->start[i];
    size_t n = family->start[i + 1] - family->start[i], others = 0;
    if (n != s->job.n || (live && memchr (live + family->start[i], 0, n))) return 0;
    for (size_t b = 0; b < n; b++)
        others += (ptrdiff_t) s->place[node[b]] - (ptrdiff_t) s->place[i] != s->jump[b];
    return others == 0;
}

/* Sets the bits of a block whose points all have all bonds, word by word; returns 0 if they have not. Not
 * with `exempt`: which bonds may break has to be found bond by bond. */
static int set_whole (stencil *s, const pg_block *block, const unsigned char *live,
                      const unsigned char *exempt)
{
    if (block->present != UINT32_MAX || exempt || s->setting.plain) return 0;
    for (size_t l = 0; l < PG_BLOCK; l++)
        if (!has_all (s, (size_t) s->job.point[block->site + l], live)) return 0;
    memset (s->alive + (size_t) (block - s->block) * s->job.n, 0xff, s->job.n * sizeof *s->alive);
    return 1;
}

/* Sets all bits of the blocks first .. last - 1 from the intact bonds of the family. */
static void renew_blocks (void *context, size_t first, size_t last, int thread)
{
    renewal *r = context;
    stencil *s = r->s;
    memset (s->alive + first * s->job.n, 0, (last - first) * s->job.n * sizeof *s->alive);
    for (size_t k = first; k < last; k++) {
        if (set_whole (s, &s->block[k], r->live, r->exempt)) continue;
        for (uint32_t left = s->block[k].present; left; left &= left - 1) {
            int i = s->job.point[s->block[k].site + (size_t) __builtin_ctz (left)];
            pg_status now = set_bits (s, (size_t) i, r->live, r->exempt);
            if (now != PG_OK) r->status[thread] = now, r->lost[thread] = (size_t) i;
        }
    }
}

/* Sets the bits of all blocks by threads. If one finds a bond that is not in the stencil, its error is
 * repeated on this thread, as messages belong to threads. */
pg_status pg_stencil_bits_renew (stencil *s, const unsigned char *live, const unsigned char *exempt)
{
    pg_status status = PG_OK;
    renewal r = { .s = s, .live = live, .exempt = exempt };
    pg_parallel_heavy (pg_stencil_loop_threads (s), s->nblock, renew_blocks, &r);
    for (int t = 0; t < MAX_THREADS; t++)
        if (r.status[t] != PG_OK) PG_TRY (set_bits (s, r.lost[t], live, exempt));
done:
    return status;
}

/* Updates the alive bits: changes NULL: all, from the mask `alive` of the family; else those of the bonds
 * that broke. */
void pg_stencil_loop_update (void *self, const unsigned char *alive, const pg_changes *changes)
{
    stencil *s = self;
    if (!changes) {
        (void) pg_stencil_bits_renew (s, alive, NULL);     /* cannot fail, as creation has found every bond */
        if (s->fold) folding_renew (s);
        return;
    }
    for (size_t c = 0; c < changes->n; c++) {
        size_t e = changes->bond[c], low = pg_stencil_loop_owner (s, e);
        unsigned bit;
        size_t k = pg_stencil_loop_block (s, s->place[low], &bit), b = bond_of (s, jump_of (s, low, e), 0);
        if (b < s->job.n) s->alive[k * s->job.n + b] &= ~(1u << bit);
        if (s->fold) folding_lose (s, k);
    }
}
