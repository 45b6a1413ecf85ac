/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loops of block.h, 8 sites at once. */
#include "block.h"
#include "fft_rows.h"
#ifdef __x86_64__
#include <immintrin.h>

#define TARGET __attribute__ ((target ("avx512f,avx512bw,avx512dq,avx512vl,avx2,fma")))
#define NAME pg_block_avx512
#define FFT_NAME pg_fft_avx512
enum { LANES = 8 };
#define VECS(dim) ((dim) == 3 ? 2 : 4)
typedef double vec __attribute__ ((vector_size (64)));
typedef unsigned hits;

/* Operations that block_kernel.h needs. Lanes are masked and compared by mask registers, so that hits are
 * bits. */
#define FUSED 1
#define vec_fuse(a, b, c) ((vec) _mm512_fmadd_pd ((__m512d) (a), (__m512d) (b), (__m512d) (c)))
#define vec_least(a, b) ((vec) _mm512_min_pd ((__m512d) (a), (__m512d) (b)))
#define vec_most(a, b) ((vec) _mm512_max_pd ((__m512d) (a), (__m512d) (b)))
#define vec_lowest(v) _mm512_reduce_min_pd ((__m512d) (v))
#define vec_highest(v) _mm512_reduce_max_pd ((__m512d) (v))
#define vec_root(v) ((vec) _mm512_sqrt_pd ((__m512d) (v)))
#define vec_keep(v, bits) ((v) = (vec) _mm512_maskz_mov_pd ((__mmask8) (bits), (__m512d) (v)))
#define HITS_OVER(hits, v, limit) \
    ((hits) |= _mm512_cmp_pd_mask ((__m512d) (v), (__m512d) (limit), _CMP_GE_OQ))
#define HITS_OVER_OF(hits, v, limit, bits) \
    ((hits) |= _mm512_mask_cmp_pd_mask ((__mmask8) (bits), (__m512d) (v), (__m512d) (limit), _CMP_GE_OQ))
#define HITS_ANY(hits) ((hits) != 0)

/* out = a0 b0 a1 b1 ...: interleaves components x and y of LANES points, as vectors of forces have them. */
static inline __attribute__ ((always_inline)) TARGET void zip (double *out, vec a, vec b)
{
    const __m512i low = _mm512_setr_epi64 (0, 8, 1, 9, 2, 10, 3, 11),
                  high = _mm512_setr_epi64 (4, 12, 5, 13, 6, 14, 7, 15);
    _mm512_storeu_pd (out, _mm512_permutex2var_pd ((__m512d) a, low, (__m512d) b));
    _mm512_storeu_pd (out + 8, _mm512_permutex2var_pd ((__m512d) a, high, (__m512d) b));
}

/* in = a0 b0 a1 b1 ...: separates components x and y of LANES points into two vectors. */
static inline __attribute__ ((always_inline)) TARGET void unzip (const double *in, vec *a, vec *b)
{
    const __m512i even = _mm512_setr_epi64 (0, 2, 4, 6, 8, 10, 12, 14),
                  odd = _mm512_setr_epi64 (1, 3, 5, 7, 9, 11, 13, 15);
    __m512d low = _mm512_loadu_pd (in), high = _mm512_loadu_pd (in + 8);
    *a = (vec) _mm512_permutex2var_pd (low, even, high);
    *b = (vec) _mm512_permutex2var_pd (low, odd, high);
}

#include "block_kernel.h"
#include "fft_kernel.h"
#else
const pg_block_kernels pg_block_avx512 = { .spread = NULL };
const fft_kernels pg_fft_avx512 = { .still = NULL };
#endif
