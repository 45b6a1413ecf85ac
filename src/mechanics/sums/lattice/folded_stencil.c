/* SPDX-License-Identifier: GPL-3.0-or-later
 * Folded stencils. A whole block (all bonds intact) is summed by mirror images (fold_kernel.h), any other one
 * bond by bond: this depends on the alive bits only, so that a run that is resumed, or has another number of
 * threads, gives the same bits.
 *
 * As folding computes no single bonds, their limits are checked separately, and seldom. Let e be the largest
 * stretch xi.eta / r^2 at the last check of a block, and D the displacements of points in step t since then.
 * Until now the ends of a bond have moved relative to each other by at most
 *
 * sum_t (max D_x - min D_x + max D_y - min D_y),  extremes over the blocks that the bonds of the block reach,
 *
 * so that no bond of it reaches its limit s0 while e + this sum / r_min < s0. A motion of the body as a whole
 * does not count, and blocks far from a crack are checked every hundredth step or so. */
#include "folded_stencil.h"
#include <math.h>
#include <string.h>

enum { LANES = 8 };                                    /* blocks of a row that are treated at once */

struct folding {
    pg_fold   fold;                                    /* arguments of the loops */
    double   *pull, *slope, *low, *high;               /* arrays of `fold`, owned */
    size_t    rows;                                    /* rows of sites */
    double    limit, shortest;  /* critical stretch s0 less rounding; length of the shortest bond, m */
    unsigned char *whole;                              /* 1: all bonds of the block are intact (blocks) */
    unsigned *from;  /* place whose displacement is subtracted in the block's group (blocks) */
    double   *most, *drift;                            /* e of each block; the sum since its check, m */
    /* Least, largest change of u_x, u_y over each block and those beside it in its row, m (4 x rows x wide);
     * wide: blocks of a row, rounded up to a multiple of LANES. */
    double   *span;
    size_t    wide;
    size_t    looks[MAX_THREADS], folded[MAX_THREADS]; /* numbers of checks and of folded blocks, by thread */
    size_t    sums;                                    /* number of sums of forces */
};

/* ---- creation ------------------------------------------------------------------------------------------ */
/* Returns the bond of the stencil with this offset; st->n: there is none. */
static size_t bond_at (const pg_stencil *st, int x, int y)
{
    for (size_t j = 0; j < st->n; j++) if (st->offset[3 * j] == x && st->offset[3 * j + 1] == y) return j;
    return st->n;
}

/* Is the stencil even: has each bond its three mirror images, with the same constants but for signs? */
static int is_even (const stencil *s)
{
    const pg_stencil *st = &s->setting.sums->stencil;
    for (size_t j = 0; j < st->n; j++) {
        const double *t = s->term + j * PG_TERMS;
        const int *o = st->offset + 3 * j;
        for (int mirror = 1; mirror < 4; mirror++) {
            int sx = mirror & 1 ? -1 : 1, sy = mirror & 2 ? -1 : 1;
            size_t i = bond_at (st, sx * o[0], sy * o[1]);
            if (i == st->n) return 0;
            const double *u = s->term + i * PG_TERMS;
            double size = fabs (t[PG_AT_PULL]) + fabs (t[PG_AT_PULL + 1]);
            if (fabs (u[PG_AT_XI] - sx * t[PG_AT_XI]) > 1e-14 * t[PG_AT_R]
                || fabs (u[PG_AT_XI + 1] - sy * t[PG_AT_XI + 1]) > 1e-14 * t[PG_AT_R]
                || fabs (u[PG_AT_PULL] - sx * t[PG_AT_PULL]) > 1e-14 * size
                || fabs (u[PG_AT_PULL + 1] - sy * t[PG_AT_PULL + 1]) > 1e-14 * size)
                return 0;
        }
    }
    return 1;
}

/* Sets the constants of the stencil by columns and rows (fold.pull), slope, own and reach. */
static pg_status set_pulls (struct folding *g, stencil *s)
{
    pg_status status = PG_OK;
    const pg_stencil *st = &s->setting.sums->stencil;
    g->shortest = INFINITY;
    PG_ALLOC (g->pull, 3 * PG_FOLD_ROWS * (size_t) (PG_FOLD_HALO + 1));
    PG_ALLOC (g->slope, 2 * st->n);
    for (size_t j = 0; j < st->n; j++) {
        const double *t = s->term + j * PG_TERMS;
        int x = st->offset[3 * j], y = st->offset[3 * j + 1];
        g->shortest = fmin (g->shortest, t[PG_AT_R]);
        for (size_t d = 0; d < 2; d++) {
            g->slope[2 * j + d] = t[PG_AT_XI + d] / t[PG_AT_R2];
            g->fold.own[d] += t[PG_AT_PULL + d] * t[PG_AT_XI + d];
        }
        if (x < 0 || y < 0) continue;
        double *a = g->pull + 3 * ((size_t) x * PG_FOLD_ROWS + (size_t) y);
        a[0] = t[PG_AT_PULL] * t[PG_AT_XI], a[1] = t[PG_AT_PULL] * t[PG_AT_XI + 1],
        a[2] = t[PG_AT_PULL + 1] * t[PG_AT_XI + 1];
        g->fold.reach = x > g->fold.reach ? x : g->fold.reach;
        g->fold.reach = y > g->fold.reach ? y : g->fold.reach;
    }
    g->fold.pitch = s->pitch, g->fold.pull = g->pull, g->fold.slope = g->slope;
done:
    return status;
}

/* Sets `from`. Groups are PG_FOLD_BLOCKS consecutive blocks of a row: the place whose displacement is
 * subtracted is the first point of the third block of the group if it has one (else of its first block with
 * points), whichever of its blocks are summed together. */
static void set_groups (struct folding *g, const stencil *s)
{
    size_t nx = (size_t) s->setting.sums->sites.count[0];
    for (size_t k = 0; k < s->nblock; k++) {
        size_t at = s->block[k].site % nx / PG_BLOCK, middle = at - at % PG_FOLD_BLOCKS + PG_FOLD_BLOCKS / 2;
        const int *row = s->block_at + s->block[k].base / s->pitch * s->row_blocks;
        size_t j = middle - PG_FOLD_BLOCKS / 2;
        while (row[j] < 0) j++;                        /* stops at block k at the latest, which has points */
        if (middle < s->row_blocks && row[middle] >= 0) j = middle;
        const pg_block *b = s->block + row[j];
        g->from[k] = (unsigned) (b->base + (size_t) __builtin_ctz (b->present));
    }
}

/* Makes the folded stencil. *out stays NULL if it cannot be used (not 2D, finite stretch, weights of points,
 * not even, solver.plain). */
pg_status folding_create (struct folding **out, stencil *s)
{
    pg_status status = PG_OK;
    struct folding *g = NULL;
    *out = NULL;
    if (s->setting.plain || s->job.dim != 2 || s->p || s->setting.sums->rule.finite || s->nblock == 0
        || s->job.n == 0 || s->reach[0] > PG_FOLD_HALO || s->reach[0] != s->reach[1] || !is_even (s))
        return PG_OK;
    PG_ALLOC (g, 1);
    *out = g;
    g->rows = (size_t) s->setting.sums->sites.count[1];
    g->limit = s->setting.limit ? s->setting.limit[0] * (1 - 1e-9) : INFINITY;
    PG_TRY (set_pulls (g, s));
    PG_ALLOC (g->low, 2 * s->nblock);
    PG_ALLOC (g->high, 2 * s->nblock);
    PG_ALLOC (g->whole, s->nblock);
    PG_ALLOC (g->from, s->nblock);
    PG_ALLOC (g->most, s->nblock);
    PG_ALLOC (g->drift, s->nblock);
    g->wide = (s->row_blocks + LANES - 1) / LANES * LANES;
    PG_ALLOC (g->span, 4 * g->rows * g->wide);
    g->fold.low = g->low, g->fold.high = g->high, s->job.fold = &g->fold;
    set_groups (g, s);
done:
    return status;
}

void folding_free (struct folding **folding)
{
    struct folding *g = *folding;
    if (!g) return;
    void *blocks[] = { g->pull, g->slope, g->low, g->high, g->whole, g->from, g->most, g->drift, g->span };
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++) pg_free (blocks[k]);
    pg_free (g);
    *folding = NULL;
}

void folding_renew (stencil *s)
{
    struct folding *g = s->fold;
    for (size_t k = 0; k < s->nblock; k++) {
        const uint32_t *alive = s->alive + k * s->job.n;
        g->whole[k] = s->block[k].present == UINT32_MAX, g->drift[k] = INFINITY;
        for (size_t j = 0; j < s->job.n && g->whole[k]; j++) g->whole[k] = alive[j] == UINT32_MAX;
    }
}

void folding_lose (stencil *s, size_t k) { s->fold->whole[k] = 0; }

/* ---- the bound ----------------------------------------------------------------------------------------- */
enum { LOW = 0, HIGH = 1 };                            /* spans of component d: 2 d + LOW and 2 d + HIGH */
static double *span_of (const struct folding *g, int which, size_t row)
{
    return g->span + ((size_t) which * g->rows + row) * g->wide;
}

/* Returns an extreme of block k as a maximum (for LOW that of -u), m; k = -1: no block: -INFINITY. */
static double extreme_of (const struct folding *g, int which, int k)
{
    if (k < 0) return -INFINITY;
    size_t at = 2 * (size_t) k + (size_t) which / 2;
    return which & HIGH ? g->high[at] : -g->low[at];
}

/* Computes the spans of rows first .. last - 1: extremes over each block and those beside it, as bonds reach
 * less than a block. */
static void widen_rows (void *context, size_t first, size_t last, int thread)
{
    const stencil *s = context;
    const struct folding *g = s->fold;
    (void) thread;
    for (size_t row = first; row < last; row++) {
        const int *at = s->block_at + (row + (size_t) s->reach[1]) * s->row_blocks;
        for (int w = 0; w < 4; w++) {
            double *to = span_of (g, w, row), sign = w & HIGH ? 1 : -1, before = -INFINITY,
                   own = extreme_of (g, w, at[0]);
            for (size_t j = 0; j < s->row_blocks; j++) {
                double behind = j + 1 < s->row_blocks ? extreme_of (g, w, at[j + 1]) : -INFINITY,
                       most = before > own ? before : own;
                to[j] = sign * (behind > most ? behind : most);
                before = own, own = behind;
            }
        }
    }
}

/* Adds to out the largest `high` minus the least `low` over some rows, for LANES blocks. */
PG_WIDE static void spread_of_rows (const double *low, const double *high, size_t wide, size_t rows,
                                    double *out)
{
    double least[LANES], most[LANES];
    for (size_t l = 0; l < LANES; l++) least[l] = INFINITY, most[l] = -INFINITY;
    for (size_t r = 0; r < rows; r++, low += wide, high += wide)
        for (size_t l = 0; l < LANES; l++)
            least[l] = low[l] < least[l] ? low[l] : least[l], most[l] = high[l] > most[l] ? high[l] : most[l];
    for (size_t l = 0; l < LANES; l++) out[l] += most[l] - least[l];
}

/* Takes the extremes over the rows within reach, and adds the changes that they allow to `drift`, for the
 * blocks of rows first .. last - 1. */
static void widen_columns (void *context, size_t first, size_t last, int thread)
{
    const stencil *s = context;
    const struct folding *g = s->fold;
    size_t far = (size_t) s->reach[1];
    (void) thread;
    for (size_t row = first; row < last; row++) {
        const int *at = s->block_at + (row + far) * s->row_blocks;
        size_t low = row > far ? row - far : 0, high = row + far < g->rows ? row + far : g->rows - 1;
        for (size_t j = 0; j < s->row_blocks; j += LANES) {
            double moved[LANES] = { 0 };
            for (int d = 0; d < 2; d++)
                spread_of_rows (span_of (g, 2 * d + LOW, low) + j, span_of (g, 2 * d + HIGH, low) + j,
                                g->wide, high + 1 - low, moved);
            for (size_t l = 0; l < LANES && j + l < s->row_blocks; l++)
                if (at[j + l] >= 0) g->drift[at[j + l]] += moved[l];
        }
    }
}

typedef struct { stencil *s; const double *u; } spreading;

static void spread_blocks (void *context, size_t first, size_t last, int thread)
{
    const spreading *g = context;
    (void) thread;
    g->s->kernels->spread_and_measure (&g->s->job, g->u, first, last);
}

void folding_spread (stencil *s, const double *u)
{
    int threads = pg_stencil_loop_threads (s);
    spreading g = { s, u };
    pg_parallel_heavy (threads, s->nblock, spread_blocks, &g);
    if (!s->setting.limit) return;
    pg_parallel_heavy (threads, s->fold->rows, widen_rows, s);
    pg_parallel_heavy (threads, s->fold->rows, widen_columns, s);
}

/* ---- forces -------------------------------------------------------------------------------------------- */
typedef struct { stencil *s; pg_block_loop loop, again; int breaking; } pass;

/* Breaks the bonds of block k over their limit. */
static void kill_in (stencil *s, size_t k, int thread)
{
    pg_status now = pg_stencil_loop_kill (s, k, &s->found[thread]);
    if (now != PG_OK) s->failed[thread] = now;
}

/* Checks the bonds of a whole block, unless the bound excludes that one is at its limit. NAN counts as at the
 * limit, hence the negation. */
static void look (stencil *s, size_t k, int thread)
{
    struct folding *g = s->fold;
    if (g->most[k] + g->drift[k] / g->shortest < g->limit) return;
    g->most[k] = s->kernels->most_stretch (&s->job, k), g->drift[k] = 0, g->looks[thread]++;
    if (!(g->most[k] < g->limit)) kill_in (s, k, thread);
}

/* Forces of the blocks first .. last - 1: those that are not whole one by one; consecutive whole ones of a
 * group together. */
static void force_blocks (void *context, size_t first, size_t last, int thread)
{
    const pass *p = context;
    stencil *s = p->s;
    struct folding *g = s->fold;
    for (size_t k = first; k < last; k++) {
        if (g->whole[k] && p->breaking) look (s, k, thread);
        if (g->whole[k]) continue;
        p->loop (&s->job, k, k + 1);
        if (!p->breaking || !s->hit[k]) continue;
        s->hit[k] = 0;
        kill_in (s, k, thread);
        p->again (&s->job, k, k + 1);
    }
    for (size_t k = first, count; k < last; k += count) {
        count = 1;
        if (!g->whole[k]) continue;
        while (k + count < last && g->whole[k + count] && g->from[k + count] == g->from[k]
               && s->block[k + count].base == s->block[k].base + count * PG_BLOCK) count++;
        double ref[2] = { s->job.u[0][g->from[k]], s->job.u[1][g->from[k]] };
        s->kernels->fold[g->fold.reach - 1] (&s->job, k, count, ref);
        g->folded[thread] += count;
    }
}

pg_status folding_force (stencil *s, double *f, int breaking, pg_changes *broken)
{
    int threads = pg_stencil_loop_threads (s),
        check = !breaking ? PG_CHECK_NONE : s->may ? PG_CHECK_SOME : PG_CHECK_ALL;
    pass p = { s, s->kernels->force[1][0][check][0], s->kernels->force[1][0][PG_CHECK_NONE][0], breaking };
    s->job.f = f, s->fold->sums++;
    pg_parallel_heavy (threads, s->nblock, force_blocks, &p);
    return breaking ? pg_changes_collect (broken, threads, s->found, s->failed) : PG_OK;
}

void folding_counts (const stencil *s, pg_bond_loop_counts *out)
{
    const struct folding *g = s->fold;
    out->sums = (long) g->sums, out->blocks = g->sums * s->nblock;
    for (int t = 0; t < MAX_THREADS; t++) out->looks += g->looks[t], out->folded += g->folded[t];
    /* A folded block saves half of its time bond by bond, at 7 bonds per nanosecond (AVX-512, one thread of
     * an AMD EPYC); a check takes as long as a block bond by bond. */
    double block = 1e-9 * PG_BLOCK * (double) s->job.n / 7;
    out->saved = block * (0.5 * (double) out->folded - (double) out->looks);
}
