/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loop over bonds by fast Fourier transforms, as described in fft_convolution.h. */
#include "fft_convolution.h"
#include "mechanics/sums/terms/sums_private.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns why transforms cannot sum these bonds, NULL if they can: the reasons of stencils, and finite
 * stretch, as a convolution is linear in u. */
static const char *fft_refusal (const pg_bond_loop_setting *setting)
{
    if (setting->sums->rule.finite) return "finite stretch is not linear in the displacement";
    return pg_stencil_loop_refusal (setting);
}

/* Frees a loop by transforms, also one that was never completed. */
static void fft_free (void *self)
{
    transformer *t = self;
    if (!t) return;
    pg_fft_clear (&t->f);
    pg_stencil_loop_free (t->s);
    void *blocks[] = { t->K,       t->chi,   t->D,     t->cut,    t->seen,  t->seen_block,
                       t->touched, t->list,  t->edge,  t->ragged, t->risky, t->sum.W,
                       t->sum.ones,    t->sum.f_own, t->third, t->open,   t->rim };
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++) pg_free (blocks[k]);
    pg_free (t);
}

/* ---- data that depend on the alive bits ---------------------------------------------------------------- */
/* Sets the weight chi of point i at its place, 0 if all its bonds are broken: such a point takes part in no
 * sum, so that blocks around debris need not be summed bond by bond. */
static void weigh_point (transformer *t, size_t i)
{
    const stencil *s = t->s;
    size_t place = s->place[i];
    unsigned bit;
    const uint32_t *alive = s->alive + pg_stencil_loop_block (s, place, &bit) * s->job.n;
    uint32_t any = 0;
    for (size_t b = 0; b < s->job.n; b++) any |= alive[b];
    t->chi[place] = any >> bit & 1 ? (s->p ? s->p[place] : 1) : 0;
}

/* Sums K_ab and K_ab xi_c times the neighbours' weights: D and the third moments of a point with missing
 * neighbours. `terms` is a constant in each call, so that the inner loop is unrolled. */
static inline __attribute__ ((always_inline)) void sum_terms (const transformer *t, const double *chi,
                                                              const size_t terms, double *sum)
{
    for (size_t p = 0; p < terms; p++) sum[p] = 0;
    for (size_t e = 0; e < t->s->job.n; e++) {
        double weight = chi[t->s->jump[e]];
        for (size_t p = 0; weight != 0 && p < terms; p++) sum[p] += weight * t->K[e * terms + p];
    }
}

/* Sets D_ab = sum_j K_ab chi_j of point i, the factor of its own displacement, N/m. If all its neighbours
 * have weight 1 it is that of the whole stencil; else it is summed, and the third moments too, by which
 * forces of the uniform strain that was subtracted are added back. */
static void sum_D (transformer *t, size_t i)
{
    const stencil *s = t->s;
    size_t site = (size_t) s->setting.sums->sites.site[i], at = site / t->nx * t->width + site % t->nx,
           all = t->rows * t->width;
    const double *chi = t->chi + s->place[i], *sum = t->whole;
    double own[FFT_TERMS];
    int whole = 1;
    for (size_t b = 0; whole && b < s->job.n; b++) whole = chi[s->jump[b]] == 1;
    t->open[i] = !whole;
    if (!whole) {
        if (t->dim == 1) sum_terms (t, chi, 2, own);
        else if (t->dim == 2) sum_terms (t, chi, 7, own);
        else sum_terms (t, chi, FFT_TERMS, own);
        memcpy (t->third + i * (size_t) t->thirds, own + t->pairs, (size_t) t->thirds * sizeof *own);
        sum = own;
    }
    for (int p = 0; p < t->pairs; p++) t->D[(size_t) p * all + at] = sum[p];
}

/* Sets cut[k]: a broken bond joins two points with weight, which the convolution would sum. (Broken bonds of
 * points without weight do no harm.) */
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

/* weigh_point for points first .. last - 1; the functions below: sum_D, and judge_block for blocks. */
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

/* Counts the points all of whose bonds are broken, for reports. */
static void count_gone (transformer *t)
{
    t->gone = 0;
    for (size_t i = 0; i < t->s->setting.sums->cloud->n; i++) t->gone += t->chi[t->s->place[i]] == 0;
}

/* Lists point i, which lacks neighbours from now on, with its block for add_strain. Called once for a
 * point. */
static void join_rim (transformer *t, size_t i)
{
    unsigned bit;
    size_t block = pg_stencil_loop_block (t->s, t->s->place[i], &bit);
    t->rim[t->nrim++] = (fft_rim) { (int) i, (int) block };
}

/* Computes all data that depend on the alive bits from scratch: at the start and after a checkpoint. */
static void renew (transformer *t)
{
    size_t n = t->s->setting.sums->cloud->n;
    int threads = pg_stencil_loop_threads (t->s);
    pg_parallel (threads, n, weigh_points, t);
    pg_parallel (threads, n, sum_D_points, t);
    t->nrim = 0;
    for (size_t i = 0; i < n; i++) if (t->open[i]) join_rim (t, i);
    pg_parallel (threads, t->s->nblock, judge_blocks, t);
    count_gone (t);
}

/* Adds the block of a place to the list, once. */
static void touch_block (transformer *t, size_t place, size_t *blocks)
{
    unsigned bit;
    size_t k = pg_stencil_loop_block (t->s, place, &bit);
    if (t->seen_block[k]) return;
    t->seen_block[k] = 1, t->list[(*blocks)++] = (int) k;
}

/* Updates the data for n bonds that broke (bits are set already). Points that lost their last bond lose their
 * weight, D of all points around them is summed anew (also across gaps, as the convolution sums all), and
 * blocks of all these points are judged anew. The cost depends on these bonds, not on the size of the body.
 * OWNER: the point lost a bond; AROUND: a neighbour lost its weight. */
static void lose_bonds (transformer *t, size_t n, const size_t *bond)
{
    enum { OWNER = 1, AROUND = 2 };
    const stencil *s = t->s;
    const pg_sums *sums = s->setting.sums;
    size_t points = 0, blocks = 0, owners;
    for (size_t c = 0; c < n; c++) {
        size_t i = pg_stencil_loop_owner (s, bond[c]);
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
        for (size_t b = 0; b < sums->stencil.n; b++) {
            int at = pg_sums_neighbour (&sums->sites, sums->sites.site[i], sums->stencil.offset + 3*b);
            if (at < 0) continue;
            size_t j = (size_t) at;
            if (!t->seen[j]) t->touched[points++] = (int) j;
            t->seen[j] |= AROUND;
            touch_block (t, s->place[j], &blocks);
        }
    }
    for (size_t c = 0; c < points; c++) {
        size_t i = (size_t) t->touched[c];
        int was = t->open[i];
        if (t->seen[i] & AROUND) sum_D (t, i);
        if (t->open[i] && !was) join_rim (t, i);
        t->seen[i] = 0;
    }
    for (size_t k = 0; k < blocks; k++) {
        judge_block (t, (size_t) t->list[k]);
        t->seen_block[t->list[k]] = 0;
    }
}

/* Updates the alive bits, then the data that depend on them. changes NULL: all of `alive` is new. */
static void fft_update (void *self, const unsigned char *alive, const pg_changes *changes)
{
    transformer *t = self;
    pg_stencil_loop_update (t->s, alive, changes);
    if (changes) lose_bonds (t, changes->n, changes->bond);
    else renew (t);
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
/* Component d of the displacement along a row less the subtracted motion (fft_motion.c), times a weight, to
 * x. */
static void still_row (const transformer *t, size_t row, int d, const double *weight, double *x)
{
    double from, by;
    pg_fft_motion_of (t, row, d, &from, &by);
    t->f.kernels->still (t->nx, t->s->job.u[d] + fft_row_base (t, row), t->off.shift[d], from, by, weight, x);
}

/* ---- forces -------------------------------------------------------------------------------------------- */
/* fft_job.fill: writes a row of chi u_d (d = field), which is transformed. */
static void fill_force (void *context, size_t row, int field, double *x)
{
    const transformer *t = context;
    still_row (t, row, field, t->chi + fft_row_base (t, row), x);
}

/* Copies the values of a row to their points (out: points x fields), except for blocks with broken bonds,
 * which the loop over bonds fills. Blocks without gaps whose points have consecutive numbers are copied in
 * one piece. */
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
            if (fields == 2)
                for (size_t k = 0; k < PG_BLOCK; k++)
                    to[2 * k] = x[0][from + k], to[2 * k + 1] = x[1][from + k];
            else
                for (size_t k = 0; k < PG_BLOCK; k++)
                    for (int d = 0; d < fields; d++) to[k * (size_t) fields + (size_t) d] = x[d][from + k];
            continue;
        }
        for (uint32_t left = b->present; left; left &= left - 1) {
            size_t k = (size_t) __builtin_ctz (left), i = (size_t) s->job.point[b->site + k];
            for (int d = 0; d < fields; d++) out[i * (size_t) fields + (size_t) d] = x[d][from + k];
        }
    }
}

/* fft_job.take: forces of a row, f_a = chi (q_a - sum_b D_ab u_b) with the transformed q_a = sum_b K_ab *
 * (chi u_b), N, except for cut blocks. */
static void take_force (void *context, size_t row, double *const *q, double *spare)
{
    const transformer *t = context;
    size_t base = fft_row_base (t, row), all = t->rows * t->width;
    fft_row r = { .chi = t->chi + base,
                  .blocks = t->s->row_blocks,
                  .block_at = t->s->block_at + base / t->s->pitch * t->s->row_blocks,
                  .skip = t->cut };
    (void) spare;
    for (int d = 0; d < t->dim; d++) {
        r.u[d] = t->s->job.u[d] + base, r.q[d] = q[d], r.shift[d] = t->off.shift[d];
        pg_fft_motion_of (t, row, d, &r.from[d], &r.by[d]);
    }
    for (int p = 0; p < t->pairs; p++) r.D[p] = t->D + (size_t) p * all + row * t->width;
    t->f.kernels->force[t->dim - 1] (&t->s->job, &r);
}

/* Uniform strain that was subtracted, e: xx, 2 xy, yy, 2 xz, 2 yz, zz; it gives points that lack neighbours
 * the force f_a = chi sum_bc T_abc e_bc. */
typedef struct { transformer *t; double e[6]; } strain;

/* Returns the uniform strain that was subtracted, from its slopes per lattice step; engineering shears. */
static strain strain_of (transformer *t)
{
    const double *step = t->s->setting.sums->sites.step, *G = t->off.slope;
    strain s = { .t = t };
    for (int b = 0, at = 0; b < t->dim; b++)
        for (int c = 0; c <= b; c++)
            s.e[at++] = b == c ? G[4 * b] / step[b] : G[3 * b + c] / step[c] + G[3 * c + b] / step[b];
    return s;
}

/* Adds the forces of the subtracted strain on points of the rim. With a whole family a uniform strain gives
 * no force, so that only points that lack neighbours need this: T_abc = sum_j K_ab xi_c chi_j of sum_D.
 * third: index of the stored moment (of a symmetric third-order tensor) for component a and strain p. */
static inline __attribute__ ((always_inline)) void add_to (const strain *s, size_t first, size_t last,
                                                           const int dim, const int terms)
{
    /* indices by fft_third */
    static const int third[3][6] = { { 0, 1, 2, 4, 5, 7 }, { 1, 2, 3, 5, 6, 8 }, { 4, 5, 6, 7, 8, 9 } };
    const transformer *t = s->t;
    for (size_t k = first; k < last; k++) {
        size_t i = (size_t) t->rim[k].point;
        const double *T = t->third + i * (size_t) fft_third (0, 0, dim);
        double *f = t->s->job.f + i * (size_t) dim, chi = t->chi[t->s->place[i]];
        if (t->cut[t->rim[k].block]) continue;
        _Pragma ("GCC unroll 3") for (int a = 0; a < dim; a++) {
            double sum = 0;
            _Pragma ("GCC unroll 6") for (int p = 0; p < terms; p++) sum += s->e[p] * T[third[a][p]];
            f[a] += chi * sum;
        }
    }
}

static void add_strain (void *context, size_t first, size_t last, int thread)
{
    const strain *s = context;
    (void) thread;
    if (s->t->dim == 1) add_to (s, first, last, 1, 1);
    else if (s->t->dim == 2) add_to (s, first, last, 2, 3);
    else add_to (s, first, last, 3, 6);
}

/* Forces f, N: of blocks with broken bonds, or with bonds that might break (fft_bound.c), bond by bond, of
 * all others by transforms. If all blocks have broken bonds nothing is transformed. */
static pg_status fft_force (void *self, const double *u, double *f, pg_changes *broken)
{
    pg_status status = PG_OK;
    transformer *t = self;
    stencil *s = t->s;
    size_t before = broken ? broken->n : 0, n = 0, blocks = s->nblock, cut = 0;
    int check = broken && s->setting.limit && s->setting.sums->cloud->n;
    t->sum.u = u;
    pg_stencil_loop_spread (s, u);
    if (check) n = pg_fft_bound_suspects (t, s->setting.limit[0], t->list);
    else for (size_t k = 0; k < blocks; k++) if (t->cut[k]) t->list[n++] = (int) k;
    PG_TRY (pg_stencil_loop_force_some (s, n, t->list, f, check ? broken : NULL));
    if (check && broken->n > before) lose_bonds (t, broken->n - before, broken->bond + before);
    for (size_t k = 0; k < blocks; k++) cut += t->cut[k];
    t->count.sums++, t->count.blocks += blocks, t->count.bonds += n, t->count.cut += cut;
    if (cut == blocks) goto done;
    pg_fft_fit_motion (t, u, 1);
    fft_job job = { t->dim, t->dim, fill_force, take_force, t };
    pg_fft_convolve (&t->f, &job);
    strain strain_ = strain_of (t);
    pg_parallel (pg_stencil_loop_threads (s), t->nrim, add_strain, &strain_);
done:
    return status;
}

/* ---- energies ------------------------------------------------------------------------------------------ */
/* fft_job.take: W = u . D u - 2 u . q along a row, J, for the energy of each point. */
static void take_work (void *context, size_t row, double *const *q, double *spare)
{
    const transformer *t = context;
    size_t all = t->rows * t->width;
    double *W = t->sum.W + row * t->width, *u[3];
    for (int a = 0; a < t->dim; a++) still_row (t, row, a, t->sum.ones, u[a] = spare + (size_t) a * t->width);
    memset (W, 0, t->nx * sizeof *W);
    for (int a = 0; a < t->dim; a++)
        for (int b = 0; b < t->dim; b++) {
            const double *D = t->D + (size_t) fft_pair (t->dim, a < b ? a : b, a < b ? b : a) * all
                              + row * t->width;
            for (size_t k = 0; k < t->nx; k++)
                W[k] += u[a][k] * (D[k] * u[b][k] - (a == b ? 2 * q[a][k] : 0));
        }
}

/* fft_job.fill: writes a row of chi u_a u_b; `field` numbers the pairs a <= b. */
static void fill_squares (void *context, size_t row, int field, double *x)
{
    const transformer *t = context;
    const double *chi = t->chi + fft_row_base (t, row);
    int a = 0, b = field;
    for (; b >= t->dim - a; a++) b -= t->dim - a;
    still_row (t, row, a, chi, x);
    still_row (t, row, a + b, x, x);
}

/* fft_job.take: chi (W + S), J, with the transformed S = sum_ab K_ab * (chi u_a u_b): twice the energy of all
 * bonds of each point of the row. */
static void take_squares (void *context, size_t row, double *const *S, double *spare)
{
    const transformer *t = context;
    const double *chi = t->chi + fft_row_base (t, row);
    double *W = t->sum.W + row * t->width, *x[1] = { spare };
    for (size_t k = 0; k < t->nx; k++) x[0][k] = chi[k] * (W[k] + S[0][k]);
    hand_out (t, row, 1, x, t->sum.f_out);
}

/* Energy density of the points, J/m^3. Each bond stores 1/2 (u_j - u_i) K (u_j - u_i), whose sum over the
 * bonds of a point is half of chi (S - 2 u.q + u.D u), by convolutions. Small negative numbers from rounding
 * become 0. */
static pg_status fft_energies (void *self, const double *u, double *W)
{
    pg_status status = PG_OK;
    transformer *t = self;
    stencil *s = t->s;
    const pg_cloud *cloud = s->setting.sums->cloud;
    size_t n = 0;
    t->sum.u = u, t->sum.f_out = W;
    if (!t->sum.W) PG_ALLOC (t->sum.W, t->rows * t->width);
    PG_TRY (pg_fft_fields (&t->f, t->pairs));
    pg_stencil_loop_spread (s, u);
    pg_fft_fit_motion (t, u, 0);
    fft_job force = { t->dim, t->dim, fill_force, take_work, t },
            squares = { t->pairs, 1, fill_squares, take_squares, t };
    pg_fft_convolve (&t->f, &force);
    pg_fft_convolve (&t->f, &squares);
    for (size_t k = 0; k < s->nblock; k++) if (t->cut[k]) t->list[n++] = (int) k;
    pg_stencil_loop_energies_some (s, n, t->list, W);
    for (size_t i = 0; i < cloud->n; i++) W[i] = W[i] != 0 ? fmax (W[i], 0) / (4 * cloud->volume[i]) : 0;
done:
    return status;
}

/* Energy -1/2 f . u, J. The rigid motion that fits u best is subtracted first: forces do no work on it, and
 * the rest of u is small, and so are rounding errors. */
static double fft_energy (void *self, const double *u)
{
    transformer *t = self;
    const pg_cloud *cloud = t->s->setting.sums->cloud;
    size_t dim = (size_t) t->dim;
    double sum = 0;
    fft_force (t, u, t->sum.f_own, NULL);
    pg_fft_fit_motion (t, u, 0);
    for (size_t i = 0; i < cloud->n; i++) {
        size_t site = (size_t) t->s->setting.sums->sites.site[i];
        double part = 0, from, by;
        for (size_t d = 0; d < dim; d++) {
            pg_fft_motion_of (t, site / t->nx, (int) d, &from, &by);
            part += t->sum.f_own[i * dim + d]
                    * (u[i * dim + d] - t->off.shift[d] - (from + by * (double) (site % t->nx)));
        }
        sum += part;
    }
    return fmax (-0.5 * sum, 0);
}

/* ---- creation ------------------------------------------------------------------------------------------ */
/* Returns K of a pair of axes and a bond, N/m, for pg_fft_create. */
static double kernel_value (const void *context, int pair, size_t entry)
{
    const transformer *t = context;
    return t->K[entry * (size_t) (t->pairs + t->thirds) + (size_t) pair];
}

/* Computes K_ab = a xi_a xi_b (N/m) and K_ab xi_c (N) of every bond of the stencil, and the sums of K over
 * all bonds, which are D of a point with a whole family. */
static pg_status set_kernels (transformer *t)
{
    pg_status status = PG_OK;
    const stencil *s = t->s;
    size_t n = s->job.n, terms = (size_t) (t->pairs + t->thirds);
    PG_ALLOC (t->K, terms * n);
    for (size_t e = 0; e < n; e++) {
        const double *term = s->term + e * PG_TERMS;
        double *K = t->K + e * terms;
        for (int b = 0; b < t->dim; b++)
            for (int a = 0; a <= b; a++) {
                double pull = term[PG_AT_PULL + a] * term[PG_AT_XI + b];
                K[fft_pair (t->dim, a, b)] = pull;
                for (int c = b; c < t->dim; c++)
                    K[t->pairs + fft_third (a, b, c)] = pull * term[PG_AT_XI + c];
            }
    }
    for (size_t e = 0; e < n; e++)
        for (int p = 0; p < t->pairs; p++) t->whole[p] += t->K[e * terms + (size_t) p];
done:
    return status;
}

/* Are plans worth timing? That takes about as long as twenty transforms of a hundred thousand places each, a
 * second or less, and pays if points times sums of the run are many. */
static int worth_timing (const pg_bond_loop_setting *setting)
{
    return setting->sums->rule.evaluations * (double) setting->sums->cloud->n > 2e8;
}

/* Makes a stencil, which has the alive bits and sums blocks with broken bonds, kernels, plans, and the data
 * that depend on the bits. */
static pg_status create_convolution (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    static const fft_kernels *const kernels[] = { &pg_fft_scalar, &pg_fft_avx2, &pg_fft_avx512 };
    pg_status status = PG_OK;
    transformer *t = NULL;
    const pg_sites *sites = &setting->sums->sites;
    void *bonds = NULL;
    PG_ALLOC (t, 1);
    *self = t;
    status = pg_stencil_loop_create (&bonds, setting, set, sizeof (stencil));
    t->s = bonds;
    PG_TRY (status);
    stencil *s = t->s;
    size_t n = setting->sums->cloud->n,
           count[3] = { (size_t) sites->count[0], (size_t) sites->count[1], (size_t) sites->count[2] };
    t->dim = s->job.dim, t->pairs = t->dim * (t->dim + 1) / 2, t->thirds = fft_third (0, 0, t->dim);
    t->nx = count[0], t->rows = count[1] * count[2], t->width = s->row_blocks * PG_BLOCK,
    t->places = pg_stencil_loop_places (s);
    PG_ALLOC (t->chi, t->places);
    PG_ALLOC (t->D, (size_t) t->pairs * t->rows * t->width);
    PG_ALLOC (t->sum.ones, t->width);
    for (size_t k = 0; k < t->width; k++) t->sum.ones[k] = 1;
    PG_ALLOC (t->sum.f_own, n * (size_t) t->dim);
    PG_ALLOC (t->cut, s->nblock);
    PG_ALLOC (t->third, n * (size_t) t->thirds);
    PG_ALLOC (t->open, n);
    PG_ALLOC (t->rim, n);
    PG_ALLOC (t->seen, n);
    PG_ALLOC (t->seen_block, s->nblock);
    PG_ALLOC (t->touched, n);
    PG_ALLOC (t->list, s->nblock);
    PG_TRY (set_kernels (t));
    PG_TRY (pg_fft_create (&t->f, t->dim, count, s->job.n, setting->sums->stencil.offset, kernel_value, t,
                        kernels[set], pg_stencil_loop_threads (s), worth_timing (setting)));
    PG_TRY (pg_fft_bound_create (t));
    renew (t);
done:
    return status;
}

/* Memory traffic of one sum, bytes per point: fields read and written, D, rim, and the transformed fields
 * four times (rows and columns, forward and back). Bonds have none. */
static void fft_bytes (const void *self, double *per_bond, double *per_point)
{
    const transformer *t = self;
    const fft_box *b = &t->f.box;
    double n = (double) t->s->setting.sums->cloud->n, places = (double) (t->rows * t->width),
           passes = t->dim == 3 ? 4 : 4;
    *per_bond = 0;
    *per_point = sizeof (double)
                 * (2 * t->dim * n + (t->thirds + 2 * t->dim + 1) * (double) t->nrim
                    + places * (4 * t->dim + 2 + t->pairs)
                    + passes * t->dim * 2 * (double) (b->C * b->T[1] * b->n[2]))
                 / n;
}

/* Estimated time of one sum, ns. From bench/sums_rate fcbm on one thread of an AMD EPYC (280^2 to 1024^2 and
 * 50^3 to 140^3 places, AVX-512; plans between guessed and timed ones): a pair of transforms takes 0.3 ns (3D
 * 0.4) times places times their binary logarithm, everything else 6 ns (3D 15) per point and 20 us. */
static double fft_time (const pg_bond_loop_setting *setting, pg_instructions set)
{
    const pg_sums *sums = setting->sums;
    int dim = sums->cloud->dim, reach[3] = { 0, 0, 0 };
    double places = 1, slower = set == PG_SCALAR ? 2 : 1;
    for (size_t e = 0; e < sums->stencil.n; e++)
        for (int d = 0; d < dim; d++)
            if (sums->stencil.offset[3 * e + (size_t) d] > reach[d])
                reach[d] = sums->stencil.offset[3 * e + (size_t) d];
    for (int d = 0; d < dim; d++)
        places *= (double) pg_fft_size ((size_t) (sums->sites.count[d] + reach[d]), d == 0);
    return 2e4 + (dim == 3 ? 0.4 : 0.3) * dim * places * log2 (places)
           + (dim == 3 ? 15 : 6) * slower * (double) sums->cloud->n;
}

static const char *fft_remark (const void *self)
{
    return ((const transformer *) self)->f.box.measured ? "plans of transforms timed or remembered"
                                                        : "plans of transforms guessed";
}

static void fft_counts (const void *self, pg_bond_loop_counts *out)
{
    const transformer *t = self;
    *out = t->count;
    out->forward = t->f.forward, out->back = t->f.back, out->gone = t->gone;
}

const pg_bond_loop_kind pg_bond_loop_fft = {
    .name = "fft",
    .refusal = fft_refusal,
    .create = create_convolution,
    .free = fft_free,
    .bytes = fft_bytes,
    .update = fft_update,
    .force = fft_force,
    .energy = fft_energy,
    .energies = fft_energies,
    .counts = fft_counts,
    .time = fft_time,
    .remark = fft_remark,
};
