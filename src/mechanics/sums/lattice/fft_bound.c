/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finds blocks in which a bond may be at its limit. Between sites i and i + n, u changes by the sum of its
 * changes along a path of n_1 steps along the first axis, n_2 along the second, ... With G_ab the changes of
 * u_b over a step h_a, divided by it, in the box around a block and its bonds, the stretch of a bond of
 * direction e is at most sum_a max G_aa e_a^2 + sum_{a<b} |e_a e_b| C_ab, C_ab = the larger of max G_ab + max
 * G_ba and -(min G_ab + min G_ba); a rotation, G_ab = -G_ba, adds nothing. Blocks with a site without a point
 * in their box (ragged) have no bound and are always checked. */
#include "fft_convolution.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns how many extremes are kept of a box: for each a, b the largest G_ab, for a != b also the largest
 * -G_ab. */
static int extremes (int dim) { return dim + 2 * dim * (dim - 1); }

enum { STRIP = 4 };                                    /* rows taken together */
typedef struct { transformer *t; const double *from; double *to; int axis; } slider;

/* Number of sites along an axis. strips_along: number of strips, which are STRIP rows, along y. */
static size_t rows_along (const transformer *t, int axis)
{
    return (size_t) t->s->setting.sums->sites.count[axis];
}
static size_t strips_along (const transformer *t) { return (rows_along (t, 1) + STRIP - 1) / STRIP; }

/* ---- ragged blocks ------------------------------------------------------------------------------------- */
/* Marks the blocks whose box has a site without a point (t->ragged): first each row with its halo along x,
 * then the rows around each block. */
static pg_status find_ragged (transformer *t)
{
    pg_status status = PG_OK;
    const stencil *s = t->s;
    const pg_sites *sites = &s->setting.sums->sites;
    size_t ny = rows_along (t, 1), nz = rows_along (t, 2), rx = (size_t) s->reach[0],
           ry = (size_t) s->reach[1], rz = (size_t) s->reach[2];
    unsigned char *row = NULL;  /* [row][block]: missing in the block's part, halo included */
    PG_ALLOC (row, t->rows * s->row_blocks);
    PG_ALLOC (t->ragged, s->nblock);
    for (size_t r = 0; r < t->rows; r++)
        for (size_t j = 0; j < s->row_blocks; j++) {
            size_t low = j * PG_BLOCK > rx ? j * PG_BLOCK - rx : 0, high = (j + 1) * PG_BLOCK + rx;
            for (size_t x = low; x < high && x < t->nx && !row[r * s->row_blocks + j]; x++)
                row[r * s->row_blocks + j] = sites->point[r * t->nx + x] < 0;
        }
    for (size_t k = 0; k < s->nblock; k++) {
        size_t r = s->block[k].site / t->nx, j = s->block[k].site % t->nx / PG_BLOCK, y = r % ny, z = r / ny;
        for (size_t b = z > rz ? z - rz : 0; b < nz && b <= z + rz; b++)
            for (size_t a = y > ry ? y - ry : 0; a < ny && a <= y + ry; a++)
                t->ragged[k] |= row[(b * ny + a) * s->row_blocks + j];
    }
done:
    pg_free (row);
    return status;
}

/* Allocates two copies of all extremes, as maxima along an axis are written to one copy from the other. */
pg_status pg_fft_bound_create (transformer *t)
{
    pg_status status = PG_OK;
    t->room_edges = (size_t) extremes (t->dim) * strips_along (t) * rows_along (t, 2) * t->s->row_blocks;
    PG_ALLOC (t->edge, 2 * t->room_edges);
    PG_ALLOC (t->risky, t->room_edges / (size_t) extremes (t->dim));
    PG_TRY (find_ragged (t));
done:
    return status;
}

/* ---- extremes ------------------------------------------------------------------------------------------ */
/* Returns a bit for each of the 32 sites of block j of a row: 1: it and its next site along the axis both
 * have points. (The last site of a block has its next site in the next block.) */
static uint32_t pairs_of (const transformer *t, size_t row, size_t j, int axis)
{
    const stencil *s = t->s;
    const int *block_at = s->block_at + fft_row_base (t, row) / s->pitch * s->row_blocks;
    if (block_at[j] < 0) return 0;
    const pg_block *b = s->block + block_at[j];
    if (axis == 0) {
        int after = j + 1 < s->row_blocks ? block_at[j + 1] : -1;
        return b->present & (b->present >> 1 | (after >= 0 ? s->block[after].present << 31 : 0));
    }
    size_t ny = rows_along (t, 1), y = row % ny, z = row / ny;
    if (axis == 1 ? y + 1 >= ny : z + 1 >= rows_along (t, 2)) return 0;
    int next = block_at[j + (axis == 1 ? 1 : s->rows) * s->row_blocks];
    return next >= 0 ? b->present & s->block[next].present : 0;
}

/* Computes the extremes of G_ab of strips first .. last - 1: the blocks of STRIP consecutive rows along y.
 * Largest G_ab, and for a != b also largest -G_ab, changes of u over a lattice step divided by the step
 * (1). */
static void edges_of_strips (void *context, size_t first, size_t last, int thread)
{
    const slider *g = context;
    transformer *t = g->t;
    const stencil *s = t->s;
    const pg_sites *sites = &s->setting.sums->sites;
    size_t ny = rows_along (t, 1), per = strips_along (t), all = per * rows_along (t, 2) * s->row_blocks;
    (void) thread;
    for (size_t strip = first; strip < last; strip++) {
        size_t y = strip % per * STRIP, r = strip / per * ny + y, rows = ny - y < STRIP ? ny - y : STRIP,
               base = fft_row_base (t, r);
        for (size_t j = 0; j < s->row_blocks; j++, base += PG_BLOCK) {
            size_t at = strip * s->row_blocks + j, v = 0;
            for (int a = 0; a < t->dim; a++) {
                uint32_t both[STRIP], any = 0;
                ptrdiff_t jump = a == 0 ? 1 : (ptrdiff_t) (a == 1 ? s->pitch : s->pitch * s->rows);
                for (size_t k = 0; k < rows; k++) any |= both[k] = pairs_of (t, r + k, j, a);
                for (int b = 0; b < t->dim; b++) {
                    double high = -INFINITY, low = INFINITY;
                    if (any)
                        t->f.kernels->range (s->job.u[b] + base, s->pitch, rows, jump, both, &low, &high);
                    g->to[v++ * all + at] = high / sites->step[a];
                    if (a != b) g->to[v++ * all + at] = -low / sites->step[a];
                }
            }
        }
    }
}

/* fmax without handling of NAN, which the compiler makes one instruction of. */
static double larger (double a, double b) { return a > b ? a : b; }

/* Takes the largest extremes of all strips within reach along one axis; after all axes each strip has the
 * extremes of the box around it. */
static void slide_strips (void *context, size_t first, size_t last, int thread)
{
    const slider *g = context;
    const transformer *t = g->t;
    const stencil *s = t->s;
    size_t n = s->row_blocks, per = strips_along (t), all = per * rows_along (t, 2) * n,
           far = (size_t) s->reach[g->axis];
    if (g->axis == 1) far = (far + STRIP - 1) / STRIP;
    int count = extremes (t->dim);
    (void) thread;
    for (size_t r = first; r < last; r++)
        for (int v = 0; v < count; v++) {
            const double *from = g->from + (size_t) v * all;
            double *to = g->to + (size_t) v * all + r * n;
            if (g->axis == 0) {
                size_t blocks = (far + PG_BLOCK - 1) / PG_BLOCK;
                for (size_t j = 0; j < n; j++) {
                    double most = -INFINITY;
                    for (size_t k = j > blocks ? j - blocks : 0; k < n && k <= j + blocks; k++)
                        most = larger (most, from[r * n + k]);
                    to[j] = most;
                }
                continue;
            }
            size_t step = g->axis == 1 ? 1 : per, at = g->axis == 1 ? r % per : r / per,
                   end = g->axis == 1 ? per : rows_along (t, 2), start = r - at * step;
            for (size_t j = 0; j < n; j++) to[j] = -INFINITY;
            for (size_t k = at > far ? at - far : 0; k < end && k <= at + far; k++)
                for (size_t j = 0; j < n; j++) to[j] = larger (to[j], from[(start + k * step) * n + j]);
        }
}

/* Returns the largest stretch that extremes allow (value: one every `apart` numbers): the largest eigenvalue
 * of the symmetric matrix of G_aa and C_ab / 2 in 2D, its bound by Gershgorin's circles in 3D, plus a margin
 * for rounding. */
static double most_stretch (int dim, const double *value, size_t apart)
{
    double G[3][3], minus[3][3], C[3][3] = { { 0 } }, size = 0, most = -INFINITY;
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
            /* infinite: the lattice is one site thick, so that no bond runs along axis a */
            G[a][b] = isinf (*value) ? 0 : *value, value += apart;
            if (a != b) minus[a][b] = isinf (*value) ? 0 : *value, value += apart;
            size = larger (size, fabs (G[a][b])), size = a != b ? larger (size, fabs (minus[a][b])) : size;
        }
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++)
            if (a != b) C[a][b] = larger (G[a][b] + G[b][a], minus[a][b] + minus[b][a]);
    if (dim == 2) {
        double half = 0.5 * (G[0][0] - G[1][1]);
        most = 0.5 * (G[0][0] + G[1][1]) + sqrt (half * half + 0.25 * C[0][1] * C[0][1]);
    } else for (int a = 0; a < dim; a++) most = larger (most, G[a][a] + 0.5 * (C[a][0] + C[a][1] + C[a][2]));
    return most + 1e-12 * size;
}

typedef struct { transformer *t; const double *from; double limit; } judge;

/* Sets `risky` of the blocks of strips first .. last - 1. NAN counts as risky, hence the negation. */
static void judge_strips (void *context, size_t first, size_t last, int thread)
{
    const judge *g = context;
    transformer *t = g->t;
    size_t n = t->s->row_blocks, all = strips_along (t) * rows_along (t, 2) * n;
    (void) thread;
    for (size_t k = first * n; k < last * n; k++)
        t->risky[k] = !(most_stretch (t->dim, g->from + k, all) < g->limit);
}

/* Lists, ascending, the blocks that may have a bond at its limit, and those with broken bonds; returns how
 * many. In most steps the body is far from any limit: then the extremes of the whole body exclude it, and no
 * box is computed. */
size_t pg_fft_bound_suspects (transformer *t, double limit, int *list)
{
    const stencil *s = t->s;
    int threads = pg_stencil_loop_threads (s), count = extremes (t->dim), safe;
    size_t n = 0, per = strips_along (t), strips = per * rows_along (t, 2), all = strips * s->row_blocks;
    double least = limit * (1 - 1e-12), whole[15], *from = t->edge, *to = t->edge + t->room_edges;
    slider g = { t, NULL, from, 0 };
    pg_parallel_heavy (threads, strips, edges_of_strips, &g);
    for (int v = 0; v < count; v++) {
        whole[v] = -INFINITY;
        for (size_t k = 0; k < all; k++) whole[v] = larger (whole[v], from[(size_t) v * all + k]);
    }
    safe = most_stretch (t->dim, whole, 1) < least;
    for (int axis = 0; axis < t->dim && !safe; axis++) {
        g = (slider) { t, from, to, axis };
        pg_parallel_heavy (threads, strips, slide_strips, &g);
        double *keep = from;
        from = to, to = keep;
    }
    if (!safe) pg_parallel_heavy (threads, strips, judge_strips, &(judge) { t, from, least });
    for (size_t k = 0; k < s->nblock; k++) {
        int look = t->cut[k] || t->ragged[k];
        if (!look && !safe) {
            size_t row = s->block[k].site / t->nx, ny = rows_along (t, 1),
                   strip = row / ny * per + row % ny / STRIP;
            look = t->risky[strip * s->row_blocks + s->block[k].site % t->nx / PG_BLOCK];
        }
        if (look) list[n++] = (int) k;
    }
    return n;
}
