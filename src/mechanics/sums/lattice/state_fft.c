/* SPDX-License-Identifier: GPL-3.0-or-later
 * State-based sums of points on a lattice by fast Fourier transforms (theory B6). With chi the share of a
 * point (0 where there is none), g_a = w xi_a V (odd) and C_ab = w xi_a xi_b / r^2 V (even), and (k * b)_i =
 * sum_n k[n] b_(i + n):
 *   alpha = factor [sum_a g_a * (chi u_a) - sum_a u_a G_a],   G_a = g_a * chi
 *   f_a = V chi {Q_a + alpha G_a + beta R_a - sum_b u_b (H_ab + beta D_ab)}, D_ab = C_ab * chi, H_ab = C_ab *
 *       (chi beta)
 *   Q_a   = g_a * (chi alpha) + sum_b C_ab * (chi beta u_b),   R_a = sum_b C_ab * (chi u_b):
 * 2 d + 1 transforms forward and as many backward. Blocks of 32 sites with a broken bond (cut blocks) are
 * summed bond by bond instead, by the loops of state_stencil.c. Each transform is done by one thread, so that
 * the bits do not depend on the number of threads. */
#include "fft_convolution.h"
#include "state_stencil.h"
#include <math.h>
#include <string.h>

enum { MOST = 7 };                                     /* most fields of a sum */
typedef struct {
    state   base;                                      /* first, as loops take a state or a stencil */
    int     dim, pairs;
    size_t  n[3], T[3], wide, complexes;  /* sites, places; doubles of a row, complex numbers of a field */
    fftw_plan forth, back;                             /* forward, backward */
    double *field[MOST];                               /* u, beta u, alpha (2 complexes) */
    /* Real (C) or imaginary (S) parts of the kernels' transforms, over the number of places (complexes); the
     * other parts are 0. */
    double *S[3], *C[6];
    double *chi, *G[3], *D[6], *H[6];                  /* padded (places) */
    int    *bits;                                      /* intact bonds of each block at the start */
    int    *cut, ncut;                                 /* blocks that have lost bonds, ascending */
    unsigned char *is_cut;                             /* 1: the block has lost bonds (blocks) */
    int     stale;                                     /* 1: H is out of date, as beta has changed */
    double  centre[3];                                 /* mean displacement, which is subtracted, m */
    transformer bound;                                 /* makes no sums: data for fft_bound.c */
    int    *suspect;                                   /* list of blocks that may have a bond at its limit */
    pg_bond_loop_counts count;
} convolver;

/* Number of a pair of axes in either order. */
static int pair_of (int dim, int a, int b) { return a > b ? fft_pair (dim, b, a) : fft_pair (dim, a, b); }

/* Returns why transforms cannot sum these bonds, NULL: they can. Reasons of the state-based stencil apply
 * too. */
static const char *refusal (const pg_bond_loop_setting *setting)
{
    /* bonds that are missing from the start do not make blocks cut, so that there may be none */
    if (setting->sums->cloud->between) return "slots, gaps or corners may part neighbours of this body";
    return pg_bond_loop_state_stencil.refusal (setting);
}

/* Frees the loop, also one that was never completed. */
static void release (void *self)
{
    convolver *c = self;
    if (!c) return;
    if (c->forth) pg_fft_plan_free (c->forth);
    if (c->back) pg_fft_plan_free (c->back);
    for (int k = 0; k < MOST; k++) pg_free (c->field[k]);
    for (int k = 0; k < 3; k++) pg_free (c->S[k]), pg_free (c->G[k]);
    for (int k = 0; k < 6; k++) pg_free (c->C[k]), pg_free (c->D[k]), pg_free (c->H[k]);
    pg_free (c->chi), pg_free (c->bits), pg_free (c->cut), pg_free (c->is_cut), pg_free (c->suspect);
    pg_free (c->bound.edge), pg_free (c->bound.ragged), pg_free (c->bound.risky);
    pg_state_loop_free (c);
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
/* Work on a row of sites, whose first site is at padded place `place`. */
typedef void (*rows_of) (convolver *c, size_t row, size_t place);
typedef struct { convolver *c; rows_of work; } rowing;

/* Number of rows of sites in the box. */
static size_t rows (const convolver *c) { return c->n[1] * c->n[2]; }

/* Does the work on the rows first .. last - 1, each with the padded place where it begins. */
static void do_rows (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const rowing *r = context;
    const stencil *s = &r->c->base.base;
    for (size_t row = first; row < last; row++) {
        size_t y = row % r->c->n[1], z = row / r->c->n[1];
        r->work (r->c, row,
                 ((z + (size_t) s->reach[2]) * s->rows + y + (size_t) s->reach[1]) * s->pitch
                     + (size_t) s->left);
    }
}

/* Does the work on all rows, by threads. */
static void each_row (convolver *c, rows_of work)
{
    pg_parallel_heavy (pg_stencil_loop_threads (&c->base.base), rows (c), do_rows, &(rowing) { c, work });
}

/* Returns where the first site of a row is in a field. */
static double *row_of (const convolver *c, int field, size_t row)
{
    return c->field[field] + (row / c->n[1] * c->T[1] + row % c->n[1]) * c->wide;
}

/* ---- transforms ---------------------------------------------------------------------------------------- */
typedef struct { convolver *c; int first, back; } transforming;

/* Transforms fields t->first + first .. last - 1, each in place by one thread. */
static void transform_fields (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const transforming *t = context;
    for (size_t k = first; k < last; k++) {
        double *x = t->c->field[(size_t) t->first + k];
        if (t->back) fftw_execute_dft_c2r (t->c->back, (fftw_complex *) x, x);
        else fftw_execute_dft_r2c (t->c->forth, x, (fftw_complex *) x);
    }
}

/* Transforms n fields from `first` on, forward or backward, and counts them for reports. */
static void transform (convolver *c, int first, int n, int back)
{
    pg_parallel_heavy (pg_stencil_loop_threads (&c->base.base), (size_t) n, transform_fields,
                       &(transforming){ c, first, back });
    *(back ? &c->count.back : &c->count.forward) += n;
}

/* Zeroes a field: places without a site must be zero before it is transformed. */
static void clear_field (convolver *c, int k) { memset (c->field[k], 0, 2 * c->complexes * sizeof (double)); }

typedef void (*places_of) (convolver *c, size_t first, size_t last);
typedef struct { convolver *c; places_of work; } multiplying;

/* Does the work on the transformed places first .. last - 1. */
static void do_places (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const multiplying *m = context;
    m->work (m->c, first, last);
}

/* Does the work on all transformed places, by threads. */
static void each_place (convolver *c, places_of work)
{
    pg_parallel_heavy (pg_stencil_loop_threads (&c->base.base), c->complexes, do_places,
                       &(multiplying) { c, work });
}

/* alpha = sum_a i S_a u_a at each place: g_a is odd, so that its transform is i times a real S_a. */
static void multiply_dilatation (convolver *c, size_t first, size_t last)
{
    double *out = c->field[2 * c->dim];
    for (size_t k = first; k < last; k++) {
        double re = 0, im = 0;
        for (int a = 0; a < c->dim; a++)
            re -= c->S[a][k] * c->field[a][2 * k + 1], im += c->S[a][k] * c->field[a][2 * k];
        out[2*k] = re, out[2*k + 1] = im;
    }
}

/* At each place replaces u_a by R_a = sum_b C_ab u_b, and beta u_a by Q_a = i S_a alpha + sum_b C_ab (beta
 * u_b). part: 0 real, 1 imaginary. */
static void multiply_forces (convolver *c, size_t first, size_t last)
{
    int d = c->dim;
    const double *alpha = c->field[2 * d];
    for (size_t k = first; k < last; k++)
        for (int part = 0; part < 2; part++) {
            double R[3], Q[3];
            for (int a = 0; a < d; a++) {
                R[a] = 0, Q[a] = c->S[a][k] * (part ? alpha[2*k] : -alpha[2*k + 1]);
                for (int b = 0; b < d; b++) {
                    double C = c->C[pair_of (d, a, b)][k];
                    R[a] += C * c->field[b][2 * k + (size_t) part],
                        Q[a] += C * c->field[d + b][2 * k + (size_t) part];
                }
            }
            for (int a = 0; a < d; a++)
                c->field[a][2 * k + (size_t) part] = R[a], c->field[d + a][2 * k + (size_t) part] = Q[a];
        }
}

/* ---- kernels and sums of the intact body --------------------------------------------------------------- */
/* Returns where an offset is in the box of a kernel: negative ones at its end, as convolutions are cyclic. */
static size_t place_in_box (const convolver *c, const int *offset)
{
    size_t at[3];
    for (int k = 0; k < 3; k++) at[k] = offset[k] < 0 ? c->T[k] - (size_t) -offset[k] : (size_t) offset[k];
    return (at[2] * c->T[1] + at[1]) * c->wide + at[0];
}

/* Writes the transform of one kernel, over the number of places: the real part of an even C_ab (b >= 0), or
 * minus the imaginary part of an odd g_a (b < 0). The other part is zero by symmetry. */
static void make_kernel (convolver *c, double *out, int a, int b)
{
    const pg_stencil *st = &c->base.base.setting.sums->stencil;
    size_t dim = (size_t) c->dim, places = c->T[0] * c->T[1] * c->T[2];
    clear_field (c, 0);
    for (size_t j = 0; j < st->n; j++) {
        int o[3] = { st->offset[3*j], dim > 1 ? st->offset[3*j + 1] : 0, dim > 2 ? st->offset[3*j + 2] : 0 };
        double wV = st->weight[j] / st->r[j] * c->base.base.job.volume, xa = st->xi[j * dim + (size_t) a];
        c->field[0][place_in_box (c, o)] = b < 0 ? wV * xa
                                                 : wV * xa * st->xi[j * dim + (size_t) b]
                                                       / (st->r[j] * st->r[j]);
    }
    transform (c, 0, 1, 0);
    for (size_t k = 0; k < c->complexes; k++)
        out[k] = (b < 0 ? -c->field[0][2 * k + 1] : c->field[0][2 * k]) / (double) places;
}

/* Writes a row of chi, the weights of the points, to field 2 dim. */
static void fill_chi (convolver *c, size_t row, size_t place)
{
    memcpy (row_of (c, 2 * c->dim, row), c->chi + place, c->n[0] * sizeof (double));
}

/* Writes a row of chi beta to field 2 dim. */
static void fill_chi_beta (convolver *c, size_t row, size_t place)
{
    double *x = row_of (c, 2 * c->dim, row);
    const double *beta = c->base.beta + place, *chi = c->chi + place;
    for (size_t k = 0; k < c->n[0]; k++) x[k] = chi[k] * beta[k];
}

/* Copies the rows of field 0 to a padded array of the bond loops. */
static void copy_rows (convolver *c, double *out)
{
    const stencil *s = &c->base.base;
    for (size_t row = 0; row < rows (c); row++) {
        size_t y = row % c->n[1], z = row / c->n[1],
               place = ((z + (size_t) s->reach[2]) * s->rows + y + (size_t) s->reach[1]) * s->pitch
                       + (size_t) s->left;
        memcpy (out + place, row_of (c, 0, row), c->n[0] * sizeof *out);
    }
}

/* out = convolution of a kernel with field 2 dim, which is transformed already; odd: 1: kernel S, 0: kernel
 * C. */
static void convolve_one (convolver *c, const double *kernel, int odd, double *out)
{
    const double *x = c->field[2 * c->dim];
    for (size_t k = 0; k < c->complexes; k++) {
        c->field[0][2*k] = odd ? -kernel[k] * x[2*k + 1] : kernel[k] * x[2*k];
        c->field[0][2*k + 1] = odd ? kernel[k] * x[2*k] : kernel[k] * x[2*k + 1];
    }
    transform (c, 0, 1, 1);
    copy_rows (c, out);
}

/* Computes H_ab = C_ab * (chi beta) anew after beta has changed. */
static void renew_beta (convolver *c)
{
    clear_field (c, 2 * c->dim);
    each_row (c, fill_chi_beta);
    transform (c, 2 * c->dim, 1, 0);
    for (int k = 0; k < c->pairs; k++) convolve_one (c, c->C[k], 0, c->H[k]);
    c->stale = 0;
}

/* Makes the kernels, and the sums G and D of the intact body, once. */
static void make_fixed (convolver *c)
{
    for (int a = 0; a < c->dim; a++) make_kernel (c, c->S[a], a, -1);
    for (int a = 0; a < c->dim; a++)
        for (int b = a; b < c->dim; b++) make_kernel (c, c->C[pair_of (c->dim, a, b)], a, b);
    clear_field (c, 2 * c->dim);
    each_row (c, fill_chi);
    transform (c, 2 * c->dim, 1, 0);
    for (int a = 0; a < c->dim; a++) convolve_one (c, c->S[a], 1, c->G[a]);
    for (int k = 0; k < c->pairs; k++) convolve_one (c, c->C[k], 0, c->D[k]);
    renew_beta (c);
}

/* ---- cut blocks ---------------------------------------------------------------------------------------- */
/* Counts the intact bonds of a block. */
static int bits_of (const stencil *s, size_t block)
{
    int sum = 0;
    for (size_t j = 0; j < s->job.n; j++) sum += __builtin_popcount (s->alive[block * s->job.n + j]);
    return sum;
}

/* Lists the cut blocks, ascending. */
static void list_cut (convolver *c)
{
    c->ncut = 0;
    for (size_t k = 0; k < c->base.base.nblock; k++) if (c->is_cut[k]) c->cut[c->ncut++] = (int) k;
}

/* Sets is_cut of the blocks first .. last - 1: fewer bonds are intact than at the start. */
static void look_at_blocks (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    convolver *c = context;
    for (size_t k = first; k < last; k++) c->is_cut[k] = bits_of (&c->base.base, k) != c->bits[k];
}

/* Marks and lists the cut blocks: all anew (changes NULL), or those of the bonds that broke. */
static void mark_cut (convolver *c, const pg_changes *changes)
{
    const stencil *s = &c->base.base;
    unsigned bit;
    if (!changes) pg_parallel_heavy (pg_stencil_loop_threads (s), s->nblock, look_at_blocks, c);
    for (size_t k = 0; changes && k < changes->n; k++)
        c->is_cut[pg_stencil_loop_block (s, s->place[pg_stencil_loop_owner (s, changes->bond[k])], &bit)] = 1;
    list_cut (c);
    c->stale |= s->setting.sums->rule.follow;
}

static void update (void *self, const unsigned char *alive, const pg_changes *changes)
{
    pg_state_loop_update (self, alive, changes);
    mark_cut (self, changes);
}

/* ---- creation ------------------------------------------------------------------------------------------ */
/* Allocates the 2 dim + 1 fields that are transformed, the kernels, and the padded arrays. */
static pg_status allocate (convolver *c)
{
    pg_status status = PG_OK;
    const stencil *s = &c->base.base;
    size_t places = pg_stencil_loop_places (s);
    for (int k = 0; k < 2 * c->dim + 1; k++) PG_ALLOC (c->field[k], 2 * c->complexes);
    for (int k = 0; k < c->dim; k++) {
        PG_ALLOC (c->S[k], c->complexes);
        PG_ALLOC (c->G[k], places);
    }
    for (int k = 0; k < c->pairs; k++) {
        PG_ALLOC (c->C[k], c->complexes);
        PG_ALLOC (c->D[k], places);
        PG_ALLOC (c->H[k], places);
    }
    PG_ALLOC (c->chi, places);
    PG_ALLOC (c->bits, s->nblock);
    PG_ALLOC (c->cut, s->nblock);
    PG_ALLOC (c->is_cut, s->nblock);
    PG_ALLOC (c->suspect, s->nblock);
done:
    return status;
}

/* Makes a state-based stencil, and the padded box: longer than the lattice by the reach of the bonds. */
static pg_status create (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    static const fft_kernels *const kernels[] = { &pg_fft_scalar, &pg_fft_avx2, &pg_fft_avx512 };
    pg_status status = PG_OK;
    PG_TRY (pg_state_loop_create (self, setting, set, sizeof (convolver)));
    convolver *c = *self;
    const stencil *s = &c->base.base;
    const pg_sites *sites = &setting->sums->sites;
    c->dim = s->job.dim, c->pairs = c->dim * (c->dim + 1) / 2;
    for (int k = 0; k < 3; k++)
        c->n[k] = (size_t) sites->count[k],
        c->T[k] = k < c->dim ? pg_fft_size (c->n[k] + (size_t) s->reach[k], k == 0) : 1;
    c->wide = c->T[0] + 2, c->complexes = (c->T[0] / 2 + 1) * c->T[1] * c->T[2];
    if ((double) c->T[0] * (double) c->T[1] * (double) c->T[2] > 1e9)
        PG_FAIL (PG_E_LIMIT, "transforms of %zu x %zu x %zu places are too large; try evaluation: stencil",
                 c->T[0], c->T[1], c->T[2]);
    PG_TRY (allocate (c));
    c->bound.s = &c->base.base, c->bound.dim = c->dim, c->bound.nx = c->n[0], c->bound.rows = rows (c),
    c->bound.cut = c->is_cut;
    c->bound.f.kernels = kernels[set];
    if (setting->limit) PG_TRY (pg_fft_bound_create (&c->bound));
    int T[3] = { (int) c->T[2], (int) c->T[1], (int) c->T[0] };
    c->forth = pg_fft_plan_box (T, c->field[0]), c->back = pg_fft_plan_box_back (T, c->field[0]);
    if (!c->forth || !c->back) PG_FAIL (PG_E_MEMORY, "no memory for the plan of a transform");
    for (size_t i = 0; i < setting->sums->cloud->n; i++) c->chi[s->place[i]] = s->p ? s->p[s->place[i]] : 1;
    for (size_t k = 0; k < s->nblock; k++) c->bits[k] = bits_of (s, k);
    make_fixed (c);
done:
    return status;
}

/* Memory traffic of one sum, bytes per point: each field is read and written about six times in forward and
 * backward transforms. */
static void bytes (const void *self, double *per_bond, double *per_point)
{
    const convolver *c = self;
    *per_bond = 0;
    *per_point = sizeof (double) * 2 * (double) c->complexes * 6 * (double) (2 * c->dim + 1)
                 / (double) c->base.base.setting.sums->cloud->n;
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
/* Computes the mean displacement of all points, m, which is subtracted: rounding errors of convolutions have
 * the size of u, and forces depend on differences only. */
static void take_mean (convolver *c, const double *u)
{
    size_t n = c->base.base.setting.sums->cloud->n, dim = (size_t) c->dim;
    for (size_t a = 0; a < dim; a++) {
        double sum = 0;
        for (size_t i = 0; i < n; i++) sum += u[i * dim + a];
        c->centre[a] = sum / (double) n;
    }
}

/* Fills a row of fields with displacements less their mean, times chi and times chi beta. job.u loses the
 * mean, too; places without a point stay 0. */
static void fill_displacements (convolver *c, size_t row, size_t place)
{
    const double *chi = c->chi + place, *beta = c->base.beta + place;
    for (int a = 0; a < c->dim; a++) {
        double *u = c->base.base.job.u[a] + place, *x = row_of (c, a, row), *y = row_of (c, c->dim + a, row);
        for (size_t k = 0; k < c->n[0]; k++) {
            u[k] = chi[k] > 0 ? u[k] - c->centre[a] : 0;
            x[k] = chi[k] * u[k], y[k] = x[k] * beta[k];
        }
    }
}

/* alpha = factor [sum_a g_a * (chi u_a) - sum_a u_a G_a] along a row. */
static void take_dilatation (convolver *c, size_t row, size_t place)
{
    const double *x = row_of (c, 2 * c->dim, row), *factor = c->base.base.job.factor + place;
    double *alpha = c->base.alpha + place;
    for (size_t k = 0; k < c->n[0]; k++) {
        double own = 0;
        for (int a = 0; a < c->dim; a++) own += c->base.base.job.u[a][place + k] * c->G[a][place + k];
        alpha[k] = factor[k] * (x[k] - own);
    }
}

/* Writes a row of chi alpha to field 2 dim. */
static void fill_dilatation (convolver *c, size_t row, size_t place)
{
    double *x = row_of (c, 2 * c->dim, row);
    for (size_t k = 0; k < c->n[0]; k++) x[k] = c->chi[place + k] * c->base.alpha[place + k];
}

/* f_a = V chi {Q_a + alpha G_a + beta R_a - sum_b u_b (H_ab + beta D_ab)} of the points of a row, N. */
static void take_forces (convolver *c, size_t row, size_t place)
{
    const stencil *s = &c->base.base;
    const int *point = s->setting.sums->sites.point + row * c->n[0];
    size_t dim = (size_t) c->dim;
    for (size_t k = 0, at = place; k < c->n[0]; k++, at++) {
        if (point[k] < 0) continue;
        double scale = s->job.volume * c->chi[at];
        for (int a = 0; a < c->dim; a++) {
            double sum = row_of (c, c->dim + a, row)[k] + c->base.alpha[at] * c->G[a][at]
                         + c->base.beta[at] * row_of (c, a, row)[k];
            for (int b = 0; b < c->dim; b++) {
                int p = pair_of (c->dim, a, b);
                sum -= s->job.u[b][at] * (c->H[p][at] + c->base.beta[at] * c->D[p][at]);
            }
            s->job.f[(size_t) point[k] * dim + (size_t) a] = scale * sum;
        }
    }
}

/* Sums the cut blocks bond by bond, over the results of the transforms. */
static void redo_cut (convolver *c, pg_block_loop loop)
{
    if (c->ncut) pg_stencil_loop_run_some (&c->base.base, loop, NULL, NULL, (size_t) c->ncut, c->cut, NULL);
}

/* Zeroes all fields of displacements before their rows are filled. */
static void clear_margins (convolver *c)
{
    for (int k = 0; k < 2 * c->dim; k++) clear_field (c, k);
}

/* Computes alpha of all points from displacements that have been filled in and transformed. */
static void dilate (convolver *c)
{
    const stencil *s = &c->base.base;
    each_place (c, multiply_dilatation);
    transform (c, 2 * c->dim, 1, 1);
    each_row (c, take_dilatation);
    redo_cut (c, s->kernels->dilate[c->dim - 2][PG_CHECK_NONE][s->p != NULL]);
}

/* Forces f, N. Bonds are first compared with their limits at the displacements as given; sums are then made
 * from displacements less their mean. */
static pg_status force (void *self, const double *u, double *f, pg_changes *broken)
{
    pg_status status = PG_OK;
    convolver *c = self;
    stencil *s = &c->base.base;
    int at = c->dim - 2, weighted = s->p != NULL,
        check = !broken || !s->setting.limit ? PG_CHECK_NONE
                : s->may                     ? PG_CHECK_SOME
                                             : PG_CHECK_ALL;
    size_t before = broken ? broken->n : 0;
    s->job.f = f;
    pg_stencil_loop_spread (s, u);
    if (check) {
        size_t n = pg_fft_bound_suspects (&c->bound, s->setting.limit[0], c->suspect);
        c->count.bonds += n;
        PG_TRY (pg_stencil_loop_run_some (s, s->kernels->dilate[at][check][weighted],
                                  s->kernels->dilate[at][PG_CHECK_NONE][weighted], pg_state_loop_lost (s), n,
                                  c->suspect, broken));
        if (broken->n > before) mark_cut (c, &(pg_changes) { broken->n - before, 0, broken->bond + before });
    }
    if (c->stale) renew_beta (c);
    c->count.sums++, c->count.blocks += s->nblock, c->count.cut += (size_t) c->ncut;
    take_mean (c, u);
    clear_margins (c);
    each_row (c, fill_displacements);
    transform (c, 0, 2 * c->dim, 0);
    dilate (c);
    clear_field (c, 2 * c->dim);
    each_row (c, fill_dilatation);
    transform (c, 2 * c->dim, 1, 0);
    each_place (c, multiply_forces);
    transform (c, 0, 2 * c->dim, 1);
    each_row (c, take_forces);
    redo_cut (c, s->kernels->pull[at][weighted]);
done:
    return status;
}

static void counts (const void *self, pg_bond_loop_counts *out) { *out = ((const convolver *) self)->count; }

const pg_bond_loop_kind pg_bond_loop_state_fft = {
    .name = "fft",
    .state = 1,
    .refusal = refusal,
    .create = create,
    .free = release,
    .bytes = bytes,
    .update = update,
    .force = force,
    .energy = pg_state_loop_energy,
    .energies = pg_state_loop_energies,
    .dilatation = pg_state_loop_dilatation,
    .counts = counts,
};
