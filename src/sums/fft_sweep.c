/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sweep by transforms: fft_sweep.h says how. */
#include "fft_sweep.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *fft_refusal (const pg_sweep_setting *setting)
{
    if (setting->sums->rule.finite) return "finite stretch is not linear in the displacement";
    return stencil_refusal (setting);
}

static void fft_free (void *self)
{
    transformer *t = self;
    if (!t) return;
    fft_clear (&t->f);
    stencil_free (t->s);
    void *blocks[] = { t->K, t->chi, t->D, t->cut, t->seen, t->seen_block, t->touched, t->list, t->edge, t->ragged, t->risky, t->W, t->ones, t->f_own };
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++) pg_free (blocks[k]);
    pg_free (t);
}

/* ---- what follows from the bits ------------------------------------------------------------------------------------------------ */
/* Weight of point i at its place, unless no bond of it lives. */
static void weigh_point (transformer *t, size_t i)
{
    const stencil *s = t->s;
    size_t place = s->place[i];
    unsigned bit;
    const uint32_t *alive = s->alive + stencil_block (s, place, &bit) * s->job.n;
    uint32_t any = 0;
    for (size_t b = 0; b < s->job.n; b++) any |= alive[b];
    t->chi[place] = any >> bit & 1 ? (s->p ? s->p[place] : 1) : 0;
}

static void sum_D (transformer *t, size_t i)
{
    const stencil *s = t->s;
    size_t site = (size_t) s->setting.sums->sites.site[i], n = s->job.n, at = site / t->nx * t->width + site % t->nx, all = t->rows * t->width;
    const double *chi = t->chi + s->place[i];
    int whole = 1;
    for (size_t b = 0; whole && b < n; b++) whole = chi[s->jump[b]] == 1;
    for (int p = 0; p < t->pairs; p++) {
        double sum = whole ? t->whole[p] : 0;
        for (size_t b = 0; !whole && b < n; b++) sum += t->K[(size_t) p * n + b] * chi[s->jump[b]];
        t->D[(size_t) p * all + at] = sum;
    }
}

static void judge_block (transformer *t, size_t k)
{
    const stencil *s = t->s;
    const pg_block *block = s->block + k;
    const double *chi = t->chi + block->base;
    t->cut[k] = 0;
    for (size_t b = 0; b < s->job.n; b++)
        for (uint32_t dead = block->present & ~s->alive[k * s->job.n + b]; dead; dead &= dead - 1) {
            int bit = __builtin_ctz (dead);
            if (chi[bit] == 0 || chi[bit + s->jump[b]] == 0) continue;
            t->cut[k] = 1;
            return;
        }
}

static void weigh_points (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    for (size_t i = first; i < last; i++) weigh_point (context, i);
}

static void sum_D_points (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    for (size_t i = first; i < last; i++) sum_D (context, i);
}

static void judge_blocks (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    for (size_t k = first; k < last; k++) judge_block (context, k);
}

static void count_gone (transformer *t)
{
    t->gone = 0;
    for (size_t i = 0; i < t->s->setting.sums->cloud->n; i++) t->gone += t->chi[t->s->place[i]] == 0;
}

static void renew (transformer *t)
{
    size_t n = t->s->setting.sums->cloud->n;
    int threads = stencil_threads (t->s);
    pg_parallel (threads, n, weigh_points, t);
    pg_parallel (threads, n, sum_D_points, t);
    pg_parallel (threads, t->s->nblock, judge_blocks, t);
    count_gone (t);
}

static void touch_block (transformer *t, size_t place, size_t *blocks)
{
    unsigned bit;
    size_t k = stencil_block (t->s, place, &bit);
    if (t->seen_block[k]) return;
    t->seen_block[k] = 1, t->list[(*blocks)++] = (int) k;
}

/* Bonds that died (their bits say so already): points whose last one it was lose their weight, and those about them renew D. */
static void lose_bonds (transformer *t, size_t n, const size_t *bond)
{
    enum { OWNER = 1, AROUND = 2 };
    const stencil *s = t->s;
    const pg_family *family = s->setting.family;
    size_t points = 0, blocks = 0, owners;
    for (size_t c = 0; c < n; c++) {
        size_t i = stencil_owner (s, bond[c]);
        if (t->seen[i]) continue;
        t->seen[i] = OWNER, t->touched[points++] = (int) i;
        touch_block (t, s->place[i], &blocks);
    }
    owners = points;
    for (size_t c = 0; c < owners; c++) {
        size_t i = (size_t) t->touched[c];
        int before = t->chi[s->place[i]] != 0;
        weigh_point (t, i);
        if (!before || t->chi[s->place[i]] != 0) continue;
        t->gone++;
        for (size_t e = family->start[i]; e < family->start[i + 1]; e++) {
            size_t j = (size_t) family->node[e];
            if (!t->seen[j]) t->touched[points++] = (int) j;
            t->seen[j] |= AROUND;
            touch_block (t, s->place[j], &blocks);
        }
    }
    for (size_t c = 0; c < points; c++) {
        size_t i = (size_t) t->touched[c];
        if (t->seen[i] & AROUND) sum_D (t, i);
        t->seen[i] = 0;
    }
    for (size_t k = 0; k < blocks; k++) {
        judge_block (t, (size_t) t->list[k]);
        t->seen_block[t->list[k]] = 0;
    }
}

static void fft_update (void *self, const unsigned char *alive, const pg_changes *changes)
{
    transformer *t = self;
    stencil_update (t->s, alive, changes);
    if (changes) lose_bonds (t, changes->n, changes->bond);
    else renew (t);
}

/* ---- rigid motion --------------------------------------------------------------------------------------------------------------- */
/* The motion that fits u best at some points spread over the body: taken off before the transforms, which would round by its size. */
static void fit_motion (transformer *t, const double *u)
{
    enum { SAMPLES = 4096 };
    const pg_cloud *cloud = t->s->setting.sums->cloud;
    size_t dim = (size_t) t->dim, stride = cloud->n / SAMPLES + 1, count = 0;
    double J[9] = { 0 }, h[3] = { 0, 0, 0 }, r[3] = { 0, 0, 0 }, v[3] = { 0, 0, 0 };
    for (int k = 0; k < 3; k++) t->centre[k] = t->shift[k] = t->turn[k] = 0;
    for (size_t i = 0; i < cloud->n; i += stride) {
        if (t->chi[t->s->place[i]] == 0) continue;
        for (size_t d = 0; d < dim; d++) t->centre[d] += cloud->x[i*dim + d], t->shift[d] += u[i*dim + d];
        count++;
    }
    for (size_t d = 0; count && d < dim; d++) t->centre[d] /= (double) count, t->shift[d] /= (double) count;
    for (size_t i = 0; i < cloud->n; i += stride) {
        if (t->chi[t->s->place[i]] == 0) continue;
        for (size_t d = 0; d < dim; d++) r[d] = cloud->x[i*dim + d] - t->centre[d], v[d] = u[i*dim + d] - t->shift[d];
        double rr = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        for (int a = 0; a < 3; a++) {
            int b = (a + 1) % 3, c = (a + 2) % 3;
            h[a] += r[b] * v[c] - r[c] * v[b];
            for (int k = 0; k < 3; k++) J[3*a + k] += (a == k ? rr : 0) - r[a] * r[k];
        }
    }
    if (dim == 2 && J[8] > 0) t->turn[2] = h[2] / J[8];
    if (dim < 3 || pg_dense_cholesky (3, J, 1e-9) != 0) return;
    pg_dense_solve (3, J, h);
    for (int k = 0; k < 3; k++) t->turn[k] = h[k];
}

/* That motion along a row: shift + (from + k * by) at its site k */
static void motion_of (const transformer *t, size_t row, int d, double *from, double *by)
{
    const pg_sums *sums = t->s->setting.sums;
    const pg_sites *sites = &sums->sites;
    size_t ny = (size_t) sites->count[1], i = 0, dim = (size_t) t->dim;
    long at[3] = { 0, (long) (row % ny), (long) (row / ny) }, first[3];
    double r[3] = { 0, 0, 0 };
    int site = sites->site[0];
    for (int k = 0; k < 3; k++) first[k] = site % sites->count[k], site /= sites->count[k];
    for (size_t k = 0; k < dim; k++) r[k] = sums->cloud->x[i*dim + k] + (double) (at[k] - first[k]) * sites->step[k] - t->centre[k];
    int b = (d + 1) % 3, c = (d + 2) % 3;
    *from = t->turn[b] * r[c] - t->turn[c] * r[b];
    *by = (c == 0 ? t->turn[b] : b == 0 ? -t->turn[c] : 0) * sites->step[0];
}

/* Displacements of a row less the motion, times a weight */
static void still_row (const transformer *t, size_t row, int d, const double *weight, double *x)
{
    double from, by;
    motion_of (t, row, d, &from, &by);
    t->f.kernels->still (t->nx, t->s->job.u[d] + fft_row_base (t, row), t->shift[d], from, by, weight, x);
}

/* ---- forces ------------------------------------------------------------------------------------------------------------------- */
static void fill_force (void *context, size_t row, int field, double *x)
{
    const transformer *t = context;
    still_row (t, row, field, t->chi + fft_row_base (t, row), x);
}

/* Values of a row to their points, except those of blocks with cut bonds */
static void hand_out (const transformer *t, size_t row, int fields, double *const *x, double *out)
{
    const stencil *s = t->s;
    const int *block_at = s->block_at + fft_row_base (t, row) / s->pitch * s->row_blocks;
    for (size_t j = 0; j < s->row_blocks; j++) {
        if (block_at[j] < 0 || t->cut[block_at[j]]) continue;
        const pg_block *b = s->block + block_at[j];
        size_t from = j * PG_BLOCK;
        if (b->present == UINT32_MAX && b->first >= 0) {
            double *to = out + (size_t) b->first * (size_t) fields;
            if (fields == 2) for (size_t k = 0; k < PG_BLOCK; k++) to[2*k] = x[0][from + k], to[2*k + 1] = x[1][from + k];
            else for (size_t k = 0; k < PG_BLOCK; k++) for (int d = 0; d < fields; d++) to[k * (size_t) fields + (size_t) d] = x[d][from + k];
            continue;
        }
        for (uint32_t left = b->present; left; left &= left - 1) {
            size_t k = (size_t) __builtin_ctz (left), i = (size_t) s->job.point[b->site + k];
            for (int d = 0; d < fields; d++) out[i * (size_t) fields + (size_t) d] = x[d][from + k];
        }
    }
}

static void take_force (void *context, size_t row, double *const *q, double *spare)
{
    const transformer *t = context;
    size_t base = fft_row_base (t, row), all = t->rows * t->width;
    fft_row r = { .chi = t->chi + base, .blocks = t->s->row_blocks, .block_at = t->s->block_at + base / t->s->pitch * t->s->row_blocks, .skip = t->cut };
    (void) spare;
    for (int d = 0; d < t->dim; d++) {
        r.u[d] = t->s->job.u[d] + base, r.q[d] = q[d], r.shift[d] = t->shift[d];
        motion_of (t, row, d, &r.from[d], &r.by[d]);
    }
    for (int p = 0; p < t->pairs; p++) r.D[p] = t->D + (size_t) p * all + row * t->width;
    t->f.kernels->force[t->dim - 1] (&t->s->job, &r);
}

/* Forces of blocks by their bonds where some are cut or might break, of the others by transforms. */
static pg_status fft_force (void *self, const double *u, double *f, pg_changes *broken)
{
    pg_status status = PG_OK;
    transformer *t = self;
    stencil *s = t->s;
    size_t before = broken ? broken->n : 0, n = 0, blocks = s->nblock, cut = 0;
    int check = broken && s->setting.limit && s->setting.sums->cloud->n;
    t->u = u;
    stencil_spread (s, u);
    if (check) n = fft_bound_suspects (t, s->setting.limit[0], t->list);
    else for (size_t k = 0; k < blocks; k++) if (t->cut[k]) t->list[n++] = (int) k;
    PG_TRY (stencil_force_some (s, n, t->list, f, check ? broken : NULL));
    if (check && broken->n > before) lose_bonds (t, broken->n - before, broken->bond + before);
    for (size_t k = 0; k < blocks; k++) cut += t->cut[k];
    t->count.sums++, t->count.blocks += blocks, t->count.bonds += n, t->count.cut += cut;
    if (cut == blocks) goto done;
    fit_motion (t, u);
    fft_job job = { t->dim, t->dim, fill_force, take_force, t };
    fft_convolve (&t->f, &job);
done:
    return status;
}

/* ---- energies ------------------------------------------------------------------------------------------------------------------ */
static void take_work (void *context, size_t row, double *const *q, double *spare)
{
    const transformer *t = context;
    size_t all = t->rows * t->width;
    double *W = t->W + row * t->width, *u[3];
    for (int a = 0; a < t->dim; a++) still_row (t, row, a, t->ones, u[a] = spare + (size_t) a * t->width);
    memset (W, 0, t->nx * sizeof *W);
    for (int a = 0; a < t->dim; a++)
        for (int b = 0; b < t->dim; b++) {
            const double *D = t->D + (size_t) fft_pair (t->dim, a < b ? a : b, a < b ? b : a) * all + row * t->width;
            for (size_t k = 0; k < t->nx; k++) W[k] += u[a][k] * (D[k] * u[b][k] - (a == b ? 2 * q[a][k] : 0));
        }
}

static void fill_squares (void *context, size_t row, int field, double *x)
{
    const transformer *t = context;
    const double *chi = t->chi + fft_row_base (t, row);
    int a = 0, b = field;
    for (; b >= t->dim - a; a++) b -= t->dim - a;
    still_row (t, row, a, chi, x);
    still_row (t, row, a + b, x, x);
}

static void take_squares (void *context, size_t row, double *const *S, double *spare)
{
    const transformer *t = context;
    const double *chi = t->chi + fft_row_base (t, row);
    double *W = t->W + row * t->width, *x[1] = { spare };
    for (size_t k = 0; k < t->nx; k++) x[0][k] = chi[k] * (W[k] + S[0][k]);
    hand_out (t, row, 1, x, t->f_out);
}

/* Energy of a point times its volume, as the loops over bonds leave it, four times: chi (S - 2 u.q + u.D u) */
static pg_status fft_energies (void *self, const double *u, double *W)
{
    pg_status status = PG_OK;
    transformer *t = self;
    stencil *s = t->s;
    const pg_cloud *cloud = s->setting.sums->cloud;
    size_t n = 0;
    t->u = u, t->f_out = W;
    if (!t->W) PG_ALLOC (t->W, t->rows * t->width);
    PG_TRY (fft_fields (&t->f, t->pairs));
    stencil_spread (s, u);
    fit_motion (t, u);
    fft_job force = { t->dim, t->dim, fill_force, take_work, t }, squares = { t->pairs, 1, fill_squares, take_squares, t };
    fft_convolve (&t->f, &force);
    fft_convolve (&t->f, &squares);
    for (size_t k = 0; k < s->nblock; k++) if (t->cut[k]) t->list[n++] = (int) k;
    stencil_energies_some (s, n, t->list, W);
    for (size_t i = 0; i < cloud->n; i++) W[i] = W[i] != 0 ? fmax (W[i], 0) / (4 * cloud->volume[i]) : 0;
done:
    return status;
}

/* Half the work of the forces on the way there, less the rigid motion, on which they do none */
static double fft_energy (void *self, const double *u)
{
    transformer *t = self;
    const pg_cloud *cloud = t->s->setting.sums->cloud;
    size_t dim = (size_t) t->dim;
    double sum = 0;
    fft_force (t, u, t->f_own, NULL);
    fit_motion (t, u);
    for (size_t i = 0; i < cloud->n; i++) {
        double r[3] = { 0, 0, 0 }, part = 0;
        for (size_t d = 0; d < dim; d++) r[d] = cloud->x[i*dim + d] - t->centre[d];
        for (size_t d = 0; d < dim; d++) {
            size_t b = (d + 1) % 3, c = (d + 2) % 3;
            part += t->f_own[i*dim + d] * ((u[i*dim + d] - t->shift[d]) - (t->turn[b] * r[c] - t->turn[c] * r[b]));
        }
        sum += part;
    }
    return fmax (-0.5 * sum, 0);
}

/* ---- life --------------------------------------------------------------------------------------------------------------------- */
static double kernel_value (const void *context, int pair, size_t entry)
{
    const transformer *t = context;
    return t->K[(size_t) pair * t->s->job.n + entry];
}

static pg_status set_kernels (transformer *t)
{
    pg_status status = PG_OK;
    const stencil *s = t->s;
    size_t n = s->job.n;
    PG_ALLOC (t->K, (size_t) t->pairs * n);
    for (size_t e = 0; e < n; e++) {
        const double *term = s->term + e * PG_TERMS;
        for (int a = 0; a < t->dim; a++)
            for (int b = a; b < t->dim; b++) t->K[(size_t) fft_pair (t->dim, a, b) * n + e] = term[PG_AT_PULL + a] * term[PG_AT_XI + b];
    }
    for (int p = 0; p < t->pairs; p++) for (size_t e = 0; e < n; e++) t->whole[p] += t->K[(size_t) p * n + e];
done:
    return status;
}

/* Timing plans takes about as long as twenty transforms of a hundred thousand places each: a second or less. */
static int worth_timing (const pg_sweep_setting *setting)
{
    return setting->sums->rule.sweeps * (double) setting->sums->cloud->n > 2e8;
}

static pg_status fft_create_sweep (void **self, const pg_sweep_setting *setting, pg_instructions set)
{
    static const fft_kernels *const kernels[] = { &pg_fft_scalar, &pg_fft_avx2, &pg_fft_avx512 };
    pg_status status = PG_OK;
    transformer *t = NULL;
    const pg_sites *sites = &setting->sums->sites;
    void *bonds = NULL;
    PG_ALLOC (t, 1);
    *self = t;
    status = stencil_create (&bonds, setting, set, sizeof (stencil));
    t->s = bonds;
    PG_TRY (status);
    stencil *s = t->s;
    size_t n = setting->sums->cloud->n, count[3] = { (size_t) sites->count[0], (size_t) sites->count[1], (size_t) sites->count[2] };
    t->dim = s->job.dim, t->pairs = t->dim * (t->dim + 1) / 2;
    t->nx = count[0], t->rows = count[1] * count[2], t->width = s->row_blocks * PG_BLOCK, t->places = stencil_places (s);
    PG_ALLOC (t->chi, t->places);
    PG_ALLOC (t->D, (size_t) t->pairs * t->rows * t->width);
    PG_ALLOC (t->ones, t->width);
    for (size_t k = 0; k < t->width; k++) t->ones[k] = 1;
    PG_ALLOC (t->f_own, n * (size_t) t->dim);
    PG_ALLOC (t->cut, s->nblock);
    PG_ALLOC (t->seen, n);
    PG_ALLOC (t->seen_block, s->nblock);
    PG_ALLOC (t->touched, n);
    PG_ALLOC (t->list, s->nblock);
    PG_TRY (set_kernels (t));
    PG_TRY (fft_create (&t->f, t->dim, count, s->job.n, setting->sums->stencil.offset, kernel_value, t, kernels[set], stencil_threads (s), worth_timing (setting)));
    PG_TRY (fft_bound_create (t));
    renew (t);
done:
    return status;
}

static void fft_bytes (const void *self, double *per_bond, double *per_point)
{
    const transformer *t = self;
    const fft_box *b = &t->f.box;
    double n = (double) t->s->setting.sums->cloud->n, places = (double) (t->rows * t->width), passes = t->dim == 3 ? 4 : 4;
    *per_bond = 0;
    *per_point = sizeof (double) * (2 * t->dim * n + places * (4 * t->dim + 2 + t->pairs) + passes * t->dim * 2 * (double) (b->C * b->T[1] * b->n[2])) / n;
}

/* From bench/sums_rate fcbm on one thread of an AMD EPYC (280^2 to 1024^2 and 50^3 to 140^3 places, AVX-512; plans between guessed and timed ones): a pair of
 * transforms takes 0.3 ns (in space 0.4) times places times their binary logarithm, all the rest 6 (15) ns a point and 20 us. */
static double fft_time (const pg_sweep_setting *setting, pg_instructions set)
{
    const pg_sums *sums = setting->sums;
    int dim = sums->cloud->dim, reach[3] = { 0, 0, 0 };
    double places = 1, slower = set == PG_SCALAR ? 2 : 1;
    for (size_t e = 0; e < sums->stencil.n; e++)
        for (int d = 0; d < dim; d++) if (sums->stencil.offset[3*e + (size_t) d] > reach[d]) reach[d] = sums->stencil.offset[3*e + (size_t) d];
    for (int d = 0; d < dim; d++) places *= (double) fft_size ((size_t) (sums->sites.count[d] + reach[d]), d == 0);
    return 2e4 + (dim == 3 ? 0.4 : 0.3) * dim * places * log2 (places) + (dim == 3 ? 15 : 6) * slower * (double) sums->cloud->n;
}

static const char *fft_remark (const void *self)
{
    return ((const transformer *) self)->f.box.measured ? "plans of transforms timed or remembered" : "plans of transforms guessed";
}

static void fft_counts (const void *self, pg_sweep_counts *out)
{
    const transformer *t = self;
    *out = t->count;
    out->forward = t->f.forward, out->back = t->f.back, out->gone = t->gone;
}

const pg_sweep_kind pg_sweep_fft = {
    .name = "fft", .refusal = fft_refusal, .create = fft_create_sweep, .free = fft_free, .bytes = fft_bytes, .update = fft_update, .force = fft_force,
    .energy = fft_energy, .energies = fft_energies, .counts = fft_counts, .time = fft_time, .remark = fft_remark,
};
