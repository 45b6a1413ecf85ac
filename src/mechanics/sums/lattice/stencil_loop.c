/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums over the bonds of points on a lattice: sites in blocks of 32 of a row, one alive bit per bond and
 * site, displacements in padded arrays. */
#include "folded_stencil.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>


/* A stencil has one set of numbers per bond for all points, so that only weights may differ from point to
 * point. */
const char *pg_stencil_loop_refusal (const pg_bond_loop_setting *setting)
{
    const pg_sums *sums = setting->sums;
    size_t n = sums->cloud->n;
    if (sums->stencil.n == 0 || sums->sites.count[0] == 0) return "the points are no lattice";
    if (sums->rule.surface == PG_SURFACE_VOLUME)
        return "surface_correction: volume differs from bond to bond";
    for (size_t i = 1; setting->modulus && i < n; i++)
        if (setting->modulus[i] != setting->modulus[0]) return "there are several moduli";
    for (size_t i = 1; setting->limit && i < n; i++)
        if (setting->limit[i] != setting->limit[0]) return "there are several critical stretches";
    if (setting->limit && n && !(setting->limit[0] > 0)) return "the critical stretch is not positive";
    return NULL;
}

/* Frees a loop over a stencil, also one that was never completed. */
void pg_stencil_loop_free (void *self)
{
    stencil *s = self;
    if (!s) return;
    folding_free (&s->fold);
    for (int t = 0; t < MAX_THREADS; t++) pg_free (s->found[t].bond);
    void *blocks[] = { s->block, s->block_at, s->place, s->jump, s->term, s->field,
                       s->p,     s->energy,   s->alive, s->may,  s->hit };
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++) pg_free (blocks[k]);
    pg_free (s);
}

/* ---- places -------------------------------------------------------------------------------------------- */
/* Returns the padded place of a site (x, y, z). Around the sites there is a margin as wide as the reach of
 * bonds, so that a neighbour is always `jump` places away, whether there is a point or not. */
static size_t place_of (const stencil *s, const size_t *at)
{
    return ((at[2] + (size_t) s->reach[2]) * s->rows + at[1] + (size_t) s->reach[1]) * s->pitch
           + (size_t) s->left + at[0];
}

/* Returns the block of a padded place, and the bit of its site. */
size_t pg_stencil_loop_block (const stencil *s, size_t place, unsigned *bit)
{
    size_t row = place / s->pitch, x = place % s->pitch - (size_t) s->left;
    *bit = (unsigned) (x % PG_BLOCK);
    return (size_t) s->block_at[row * s->row_blocks + x / PG_BLOCK];
}

/* Lays out the padded box: reach of the bonds along each axis; rows begin at a multiple of 8 places and end
 * after whole blocks of 32, so that vectors never cross a row; jump: padded places from a point to each
 * neighbour, the same for all points. */
static pg_status lay_out (stencil *s)
{
    pg_status status = PG_OK;
    const pg_sums *sums = s->setting.sums;
    const pg_stencil *st = &sums->stencil;
    for (size_t j = 0; j < st->n; j++)
        for (int d = 0; d < st->dim; d++)
            if (abs (st->offset[3 * j + (size_t) d]) > s->reach[d])
                s->reach[d] = abs (st->offset[3 * j + (size_t) d]);
    s->left = (s->reach[0] + 7) / 8 * 8;
    s->row_blocks = ((size_t) sums->sites.count[0] + PG_BLOCK - 1) / PG_BLOCK;
    s->pitch = (size_t) s->left + s->row_blocks * PG_BLOCK;
    s->rows = (size_t) (sums->sites.count[1] + 2 * s->reach[1]),
    s->planes = (size_t) (sums->sites.count[2] + 2 * s->reach[2]);
    size_t places = pg_stencil_loop_places (s);
    if (places > UINT32_MAX)
        PG_FAIL (PG_E_LIMIT, "a lattice of %zu padded sites: at most %lu; try evaluation: list", places,
                 (unsigned long) UINT32_MAX);
    PG_ALLOC (s->jump, st->n);
    for (size_t j = 0; j < st->n; j++) {
        const int *o = st->offset + 3*j;
        s->jump[j] = ((ptrdiff_t) (st->dim > 2 ? o[2] : 0) * (ptrdiff_t) s->rows + (st->dim > 1 ? o[1] : 0))
                         * (ptrdiff_t) s->pitch
                     + o[0];
    }
    PG_ALLOC (s->field, places * (size_t) st->dim);
    for (int d = 0; d < 3; d++) s->job.u[d] = s->field + places * (size_t) (d < st->dim ? d : 0);
    PG_ALLOC (s->block_at, s->rows * s->planes * s->row_blocks);
    PG_ALLOC (s->place, sums->cloud->n);
done:
    return status;
}

/* Lists the blocks of 32 sites of a row that have points, in the order of sites, and sets block_at and the
 * padded places of points. `first` of a block: its first point if all its points have consecutive numbers, so
 * that copies need no lookup. */
static pg_status find_blocks (stencil *s)
{
    pg_status status = PG_OK;
    const pg_sites *sites = &s->setting.sums->sites;
    size_t lines = (size_t) sites->count[1] * (size_t) sites->count[2], nx = (size_t) sites->count[0],
           cap = 0;
    memset (s->block_at, -1, s->rows * s->planes * s->row_blocks * sizeof *s->block_at);
    for (size_t line = 0; line < lines; line++)
        for (size_t x = 0; x < nx; x += PG_BLOCK) {
            pg_block b = { .site = line * nx + x, .first = -1 };
            size_t at[3] = { x, line % (size_t) sites->count[1], line / (size_t) sites->count[1] };
            int runs = 1;
            b.base = place_of (s, at);
            for (unsigned k = 0; k < PG_BLOCK && x + k < nx; k++) {
                int point = sites->point[b.site + k];
                if (point < 0) continue;
                if (!b.present) b.first = point;
                runs = runs && point == b.first + __builtin_popcount (b.present);
                b.present |= 1u << k;
                s->place[point] = (unsigned) (b.base + k);
            }
            if (!b.present) continue;
            if (!runs) b.first = -1;
            PG_GROW (s->block, cap, s->nblock + 1);
            s->block_at[b.base / s->pitch * s->row_blocks + x / PG_BLOCK] = (int) s->nblock;
            s->block[s->nblock++] = b;
        }
done:
    return status;
}

/* ---- bonds -------------------------------------------------------------------------------------------- */
/* Returns the number of threads: 1 for small bodies, where starting others costs more than they save. */
int pg_stencil_loop_threads (const stencil *s)
{
    int t = s->setting.threads;
    if (s->nblock * s->job.n * PG_BLOCK < FEW || t < 1) return 1;
    return t < MAX_THREADS ? t : MAX_THREADS;
}

/* Returns the point whose family has this entry, by bisection of the starts. */
size_t pg_stencil_loop_owner (const stencil *s, size_t entry)
{
    const size_t *start = s->setting.family->start;
    size_t low = 0, high = s->setting.sums->cloud->n;
    while (high - low > 1) {  /* the last point whose bonds start at or before the entry */
        size_t middle = (low + high) / 2;
        if (start[middle] <= entry) low = middle;
        else high = middle;
    }
    return low;
}

/* Sets the numbers of each bond of the stencil (pg_block_job.term), the same for all points: xi, pull a xi or
 * a r^2, limit of the compared measure, r^2 and r, stored. a = c V^2 k beta / r^3, N/m^3. */
static pg_status set_terms (stencil *s)
{
    pg_status status = PG_OK;
    const pg_sums *sums = s->setting.sums;
    const pg_stencil *st = &sums->stencil;
    double volume = st->cell * sums->cloud->thickness,
           c = sums->cloud->n && s->setting.modulus ? s->setting.modulus[0] : 0;
    double s0 = s->setting.limit && sums->cloud->n ? s->setting.limit[0] : 0;
    PG_ALLOC (s->term, st->n * PG_TERMS);
    for (size_t j = 0; j < st->n; j++) {
        double *t = s->term + j * PG_TERMS, r = st->r[j],
               a = c * (volume * volume) * st->weight[j] / (r * r * r);
        for (int d = 0; d < st->dim; d++) {
            t[PG_AT_XI + d] = st->xi[j * (size_t) st->dim + (size_t) d];
            t[PG_AT_PULL + d] = sums->rule.finite ? a * (r * r) : a * t[PG_AT_XI + d];
        }
        t[PG_AT_LIMIT] = sums->rule.finite ? s0 * (2 + s0) * (r * r) : s0 * (r * r);
        t[PG_AT_R2] = r * r, t[PG_AT_R] = r;
        t[PG_AT_STORED] = sums->rule.finite ? a * (r * r) : a;
    }
done:
    return status;
}

/* Returns the number of padded places, with the margin before the first row. */
size_t pg_stencil_loop_places (const stencil *s) { return s->pitch * s->rows * s->planes + (size_t) s->left; }

/* Sets the weights of points unless all are 1: share of a cell's volume, over the root of the family's
 * relative volume (surface correction "product"). A bond is weighted by p_i p_j, so that one number per bond
 * of the stencil still serves all points. */
static pg_status set_weights (stencil *s)
{
    pg_status status = PG_OK;
    const pg_sums *sums = s->setting.sums;
    int product = sums->rule.surface == PG_SURFACE_PRODUCT && sums->family_volume, one = 1;
    if (!sums->share && !product) return PG_OK;
    PG_ALLOC (s->p, pg_stencil_loop_places (s));
    for (size_t i = 0; i < sums->cloud->n; i++) {
        double p = (sums->share ? sums->share[i] : 1) / (product ? sqrt (sums->family_volume[i]) : 1);
        s->p[s->place[i]] = p;
        one = one && p == 1;
    }
    if (one) pg_free (s->p), s->p = NULL;
done:
    return status;
}

/* Is no point marked? */
static int none_of (const unsigned char *mark, size_t n)
{
    size_t i = 0;
    while (i < n && !mark[i]) i++;
    return i == n;
}

/* Makes the stencil; each step needs the former ones. */
pg_status pg_stencil_loop_create (void **self, const pg_bond_loop_setting *setting, pg_instructions set,
                                  size_t bytes)
{
    static const pg_block_kernels *const kernels[] = { &pg_block_scalar, &pg_block_avx2, &pg_block_avx512 };
    pg_status status = PG_OK;
    stencil *s = NULL;
    const unsigned char *exempt = setting->limit ? setting->exempt : NULL;
    size_t n = setting->sums->cloud->n;
    if (exempt && none_of (exempt, n)) exempt = NULL;  /* all bonds may break */
    *self = s = pg_calloc (1, bytes);
    if (!s) PG_FAIL (PG_E_MEMORY, "%zu bytes for a stencil", bytes);
    s->setting = *setting, s->kernels = kernels[set];
    s->nbond = n ? setting->family->start[n] : 0;
    PG_TRY (lay_out (s));
    PG_TRY (find_blocks (s));
    PG_TRY (set_terms (s));
    PG_TRY (set_weights (s));
    size_t words = s->nblock * setting->sums->stencil.n;
    PG_ALLOC (s->alive, words);
    if (exempt) PG_ALLOC (s->may, words);
    PG_ALLOC (s->hit, s->nblock);
    PG_ALLOC (s->energy, s->nblock);
    s->job.dim = setting->sums->stencil.dim, s->job.n = setting->sums->stencil.n, s->job.jump = s->jump,
    s->job.term = s->term;
    s->job.block = s->block, s->job.point = setting->sums->sites.point, s->job.alive = s->alive,
    s->job.may = s->may, s->job.p = s->p;
    s->job.hit = s->hit, s->job.energy = s->energy;
    PG_TRY (pg_stencil_bits_renew (s, NULL, exempt));
done:
    return status;
}

/* Makes the loop of bond-based theory: a stencil, and a folded one if that can be used. */
static pg_status create (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    pg_status status = PG_OK;
    PG_TRY (pg_stencil_loop_create (self, setting, set, sizeof (stencil)));
    stencil *s = *self;
    PG_TRY (folding_create (&s->fold, s));
    if (s->fold) folding_renew (s);
done:
    return status;
}

/* Memory traffic of a sum, bytes: per bond alive bits; per point unknowns, forces and padded copies. */
void pg_stencil_loop_bytes (const void *self, double *per_bond, double *per_point)
{
    const stencil *s = self;
    size_t n = s->setting.sums->cloud->n, dim = (size_t) s->job.dim;
    double words = (double) (s->nblock * s->job.n) * (s->may ? 2 : 1),
           places = (double) (s->nblock * PG_BLOCK);
    *per_bond = s->nbond ? sizeof (uint32_t) * words / (double) s->nbond : 0;
    *per_point = n ? sizeof (double) * ((double) (2 * dim * n) + places * (double) (2 * dim + (s->p != NULL)))
                         / (double) n
                   : 0;
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
/* Returns the entry of the family of bond b of point i at `place`, by bisection, as the family's neighbours
 * ascend. */
size_t pg_stencil_loop_entry (const stencil *s, int i, size_t place, size_t b)
{
    const pg_family *family = s->setting.family;
    size_t low = family->start[i], high = family->start[i + 1];
    unsigned bit;
    size_t k = pg_stencil_loop_block (s, (size_t) ((ptrdiff_t) place + s->jump[b]), &bit);
    int j = s->job.point[s->block[k].site + bit];
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (family->node[middle] <= j) low = middle;
        else high = middle;
    }
    return low;
}

/* Returns xi.eta, or with finite stretch 2 xi.eta + eta.eta, of one bond, m^2: the measure that loops compare
 * with the limit, by the same operations, so that a bond breaks here if and only if its lane was over the
 * limit. */
static double measure (const stencil *s, size_t place, size_t b)
{
    const double *t = s->term + b * PG_TERMS;
    double sum = 0;
    for (int d = 0; d < s->job.dim; d++) {
        const double *u = s->job.u[d] + place, xi = t[PG_AT_XI + d], eta = u[s->jump[b]] - u[0];
        double with = s->setting.sums->rule.finite ? xi + (xi + eta) : xi;
        sum = d == 0 ? eta * with : s->kernels->fused ? fma (eta, with, sum) : eta * with + sum;
    }
    return sum;
}

/* Breaks the bonds of block k that are at or over their limit, and appends their entries of the family to
 * found. */
pg_status pg_stencil_loop_kill (stencil *s, size_t k, pg_changes *found)
{
    pg_status status = PG_OK;
    const pg_block *block = s->block + k;
    for (size_t b = 0; b < s->job.n; b++) {
        uint32_t *word = s->alive + k * s->job.n + b,
                 live = s->may ? *word & s->may[k * s->job.n + b] : *word;
        for (; live; live &= live - 1) {
            unsigned bit = (unsigned) __builtin_ctz (live);
            if (!(measure (s, block->base + bit, b) >= s->term[b * PG_TERMS + PG_AT_LIMIT])) continue;
            *word &= ~(1u << bit);
            if (s->fold) folding_lose (s, k);
            PG_GROW (found->bond, found->cap, found->n + 1);
            found->bond[found->n++] = pg_stencil_loop_entry (s, s->job.point[block->site + bit],
                                                             block->base + bit,
                                                     b);
        }
    }
done:
    return status;
}

/* Arguments of a parallel loop over n blocks; list: their numbers, NULL: 0 .. n - 1. */
typedef struct {
    stencil *s;
    const double *u;
    pg_block_loop loop, again;
    stencil_lost lost;
    size_t n;
    const int *list;
} pass;

/* Copies the displacements of blocks first .. last - 1 to their padded places. */
static void spread_blocks (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    pass *p = context;
    p->s->kernels->spread (&p->s->job, p->u, first, last);
}

/* Forces of blocks (or entries of the list) first .. last - 1. In a block with `hit` the bonds over their
 * limit are broken, and the block is summed once more without them. */
static void force_blocks (void *context, size_t first, size_t last, int thread)
{
    pass *p = context;
    stencil *s = p->s;
    if (!p->list) p->loop (&s->job, first, last);
    for (size_t at = first; (p->again || p->list) && at < last; at++) {
        size_t k = p->list ? (size_t) p->list[at] : at;
        if (p->list) p->loop (&s->job, k, k + 1);
        if (!p->again || !s->hit[k]) continue;
        s->hit[k] = 0;
        pg_status now = pg_stencil_loop_kill (s, k, &s->found[thread]);
        if (now != PG_OK) s->failed[thread] = now;
        if (p->lost) p->lost (s, k);
        p->again (&s->job, k, k + 1);
    }
}

/* Copies the displacements of all blocks to their padded places, by threads. */
void pg_stencil_loop_spread (stencil *s, const double *u)
{
    if (s->fold) folding_spread (s, u);
    else
        pg_parallel_heavy (pg_stencil_loop_threads (s), s->nblock, spread_blocks,
                           &(pass) { .s = s, .u = u });
}

/* Runs one pass over p->n blocks; broken bonds are collected in the order of the family. */
static pg_status run (stencil *s, pass *p, pg_changes *broken)
{
    int threads = pg_stencil_loop_threads (s);
    pg_parallel_heavy (threads, p->n, force_blocks, p);
    return p->again ? pg_changes_collect (broken, threads, s->found, s->failed) : PG_OK;
}

pg_status pg_stencil_loop_run (stencil *s, pg_block_loop loop, pg_block_loop again, stencil_lost lost,
                       pg_changes *broken)
{
    return run (s, &(pass) { .s = s, .loop = loop, .again = again, .lost = lost, .n = s->nblock }, broken);
}

pg_status pg_stencil_loop_run_some (stencil *s, pg_block_loop loop, pg_block_loop again, stencil_lost lost,
                                    size_t n,
                            const int *list, pg_changes *broken)
{
    return run (s, &(pass){ .s = s, .loop = loop, .again = again, .lost = lost, .n = n, .list = list },
                broken);
}

/* Runs the loop for this dimension, strain measure and check, with or without weights, over n blocks of a
 * list. */
pg_status pg_stencil_loop_force_some (stencil *s, size_t n, const int *list, double *f, pg_changes *broken)
{
    int finite = s->setting.sums->rule.finite != 0, weighted = s->p != NULL;
    int check = !broken || !s->setting.limit ? PG_CHECK_NONE : s->may ? PG_CHECK_SOME : PG_CHECK_ALL;
    pass p = {
        .s = s, .loop = s->kernels->force[s->job.dim - 1][finite][check][weighted], .n = n, .list = list
    };
    if (check) p.again = s->kernels->force[s->job.dim - 1][finite][PG_CHECK_NONE][weighted];
    s->job.f = f;
    return run (s, &p, broken);
}

/* Forces of all points, N. */
static pg_status force (void *self, const double *u, double *f, pg_changes *broken)
{
    stencil *s = self;
    pg_stencil_loop_spread (s, u);
    if (s->fold) return folding_force (s, f, broken && s->setting.limit, broken);
    return pg_stencil_loop_force_some (s, s->nblock, NULL, f, broken);
}

/* Energies of the blocks (or entries of the list) first .. last - 1. */
static void energy_blocks (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    pass *p = context;
    if (!p->list) p->loop (&p->s->job, first, last);
    else
        for (size_t k = first; k < last; k++)
            p->loop (&p->s->job, (size_t) p->list[k], (size_t) p->list[k] + 1);
}

void pg_stencil_loop_energies_some (stencil *s, size_t n, const int *list, double *W)
{
    pass p = { .s = s,
               .loop = s->kernels->energy[s->job.dim - 1][s->setting.sums->rule.finite != 0][s->p != NULL],
               .list = list };
    s->job.energies = W;
    pg_parallel_heavy (pg_stencil_loop_threads (s), n, energy_blocks, &p);
    s->job.energies = NULL;
}

/* The sums of blocks are added in their order, whichever thread made them. */
double pg_stencil_loop_stored (stencil *s, pg_block_loop loop, double *W)
{
    double sum = 0;
    s->job.energies = W;
    pg_parallel_heavy (pg_stencil_loop_threads (s), s->nblock, energy_blocks, &(pass) { .s = s,
                                                                                        .loop = loop });
    s->job.energies = NULL;
    for (size_t k = 0; k < s->nblock; k++) sum += s->energy[k];
    return sum;
}

/* Energy of the body, J. */
static double energy (void *self, const double *u)
{
    stencil *s = self;
    pg_stencil_loop_spread (s, u);
    /* the loop sums twice the energy of each bond from both its ends */
    return pg_stencil_loop_stored (
               s, s->kernels->energy[s->job.dim - 1][s->setting.sums->rule.finite != 0][s->p != NULL], NULL)
           / 4;
}

/* Energy density of the points, J/m^3. */
static pg_status energies (void *self, const double *u, double *W)
{
    stencil *s = self;
    const pg_cloud *cloud = s->setting.sums->cloud;
    pg_stencil_loop_spread (s, u);
    pg_stencil_loop_energies_some (s, s->nblock, NULL, W);
    for (size_t i = 0; i < cloud->n; i++) W[i] = W[i] != 0 ? W[i] / (4 * cloud->volume[i]) : 0;
    return PG_OK;
}

/* Estimated time of one sum, ns; rate: bonds per nanosecond by instruction set, in 2D and in 3D. From
 * bench/sums_rate bond, square_400_m6 and cube_64, one thread of an AMD EPYC. */
static double time_of (const pg_bond_loop_setting *setting, pg_instructions set)
{
    static const double rate[][2] = { { 1.7, 0.8 }, { 3.9, 2.1 }, { 7.3, 3.7 } };
    const pg_sums *sums = setting->sums;
    return (double) sums->cloud->n * (double) sums->stencil.n / rate[set][sums->cloud->dim == 3];
}

static void counts (const void *self, pg_bond_loop_counts *out)
{
    const stencil *s = self;
    if (s->fold) folding_counts (s, out);
}

const pg_bond_loop_kind pg_bond_loop_stencil = {
    .name = "stencil",
    .refusal = pg_stencil_loop_refusal,
    .create = create,
    .free = pg_stencil_loop_free,
    .bytes = pg_stencil_loop_bytes,
    .update = pg_stencil_loop_update,
    .force = force,
    .energy = energy,
    .energies = energies,
    .counts = counts,
    .time = time_of,
    .apart = 1,
};
