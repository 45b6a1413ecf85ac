/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loops of block.h without special instructions: pairs of doubles, which compilers map to the registers of
 * the machine. */
#include "block.h"
#include "fft_rows.h"
#include <math.h>

#define TARGET
#define NAME pg_block_scalar
#define FFT_NAME pg_fft_scalar
enum { LANES = 2 };
#define VECS(dim) ((dim) == 3 ? 1 : 2)
typedef double vec __attribute__ ((vector_size (16)));
typedef long long lane_bits __attribute__ ((vector_size (16)));
typedef lane_bits hits;

/* Masks of two lanes by the two bits of a number: -1 has all bits set and keeps a lane, 0 clears it. */
static const lane_bits lanes[4] = { { 0, 0 }, { -1, 0 }, { 0, -1 }, { -1, -1 } };

#ifdef __FP_FAST_FMA
#define FUSED 1
#define vec_fuse(a, b, c) ((vec) { fma ((a)[0], (b)[0], (c)[0]), fma ((a)[1], (b)[1], (c)[1]) })
#else
#define FUSED 0
#define vec_fuse(a, b, c) ((a) * (b) + (c))
#endif
#define vec_least(a, b) ((vec) { (a)[0] < (b)[0] ? (a)[0] : (b)[0], (a)[1] < (b)[1] ? (a)[1] : (b)[1] })
#define vec_most(a, b) ((vec) { (a)[0] > (b)[0] ? (a)[0] : (b)[0], (a)[1] > (b)[1] ? (a)[1] : (b)[1] })
#define vec_lowest(v) ((v)[0] < (v)[1] ? (v)[0] : (v)[1])
#define vec_highest(v) ((v)[0] > (v)[1] ? (v)[0] : (v)[1])
#define vec_root(v) ((vec) { sqrt ((v)[0]), sqrt ((v)[1]) })
#define vec_keep(v, bits) ((v) = (vec) ((lane_bits) (v) & lanes[(bits) & 3]))
#define HITS_OVER(hits, v, limit) ((hits) |= (lane_bits) ((v) >= (limit)))
#define HITS_OVER_OF(hits, v, limit, bits) ((hits) |= (lane_bits) ((v) >= (limit)) & lanes[(bits) & 3])
#define HITS_ANY(hits) (((hits)[0] | (hits)[1]) != 0)

static inline void zip (double *out, vec a, vec b)
{
    out[0] = a[0], out[1] = b[0], out[2] = a[1], out[3] = b[1];
}
static inline void unzip (const double *in, vec *a, vec *b)
{
    *a = (vec){ in[0], in[2] }, *b = (vec){ in[1], in[3] };
}

#include "block_kernel.h"
#include "fft_kernel.h"
