/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loops of block.h, 4 sites at once. */
#include "block.h"
#include "fft_rows.h"
#ifdef __x86_64__
#include <immintrin.h>

#define TARGET __attribute__ ((target ("avx2,fma")))
#define NAME pg_block_avx2
#define FFT_NAME pg_fft_avx2
enum { LANES = 4 };
#define VECS(dim) ((dim) == 1 ? 4 : 2)
typedef double vec __attribute__ ((vector_size (32)));
typedef vec hits;

/* Masks of four lanes for each of the 16 sets of bits: AVX2 has no mask registers, and reading this table is
 * faster than computing a mask. */
#define LANE(k, bit) ((k) >> (bit) & 1 ? -1 : 0)
#define LANE4(k) { LANE (k, 0), LANE (k, 1), LANE (k, 2), LANE (k, 3) }
static const long long lanes[16][4] __attribute__ ((aligned (32))) = {
    LANE4 (0), LANE4 (1), LANE4 (2), LANE4 (3), LANE4 (4), LANE4 (5), LANE4 (6), LANE4 (7),
    LANE4 (8), LANE4 (9), LANE4 (10), LANE4 (11), LANE4 (12), LANE4 (13), LANE4 (14), LANE4 (15) };
#define OF(bits) _mm256_castsi256_pd (_mm256_load_si256 ((const __m256i *) lanes[(bits) & 15]))
#define OVER(v, limit) _mm256_cmp_pd ((__m256d) (v), (__m256d) (limit), _CMP_GE_OQ)

/* Operations that block_kernel.h needs. Products and sums are fused; comparisons are quiet: NAN is over no
 * limit. */
#define FUSED 1
#define vec_least(a, b) ((vec) _mm256_min_pd ((__m256d) (a), (__m256d) (b)))
#define vec_most(a, b) ((vec) _mm256_max_pd ((__m256d) (a), (__m256d) (b)))
#define vec_fuse(a, b, c) ((vec) _mm256_fmadd_pd ((__m256d) (a), (__m256d) (b), (__m256d) (c)))
#define vec_root(v) ((vec) _mm256_sqrt_pd ((__m256d) (v)))
#define vec_keep(v, bits) ((v) = (vec) _mm256_and_pd ((__m256d) (v), OF (bits)))
#define HITS_OVER(hits, v, limit) ((hits) = (vec) _mm256_or_pd ((__m256d) (hits), OVER (v, limit)))
#define HITS_OVER_OF(hits, v, limit, bits) \
    ((hits) = (vec) _mm256_or_pd ((__m256d) (hits), _mm256_and_pd (OVER (v, limit), OF (bits))))
#define HITS_ANY(hits) (_mm256_movemask_pd ((__m256d) (hits)) != 0)

static inline __attribute__ ((always_inline)) TARGET double vec_lowest (vec v)
{
    __m128d half = _mm_min_pd (_mm256_castpd256_pd128 ((__m256d) v), _mm256_extractf128_pd ((__m256d) v, 1));
    return _mm_cvtsd_f64 (_mm_min_sd (half, _mm_unpackhi_pd (half, half)));
}
static inline __attribute__ ((always_inline)) TARGET double vec_highest (vec v)
{
    __m128d half = _mm_max_pd (_mm256_castpd256_pd128 ((__m256d) v), _mm256_extractf128_pd ((__m256d) v, 1));
    return _mm_cvtsd_f64 (_mm_max_sd (half, _mm_unpackhi_pd (half, half)));
}

/* out = a0 b0 a1 b1 ...: interleaves components x and y of LANES points, as vectors of forces have them. */
static inline __attribute__ ((always_inline)) TARGET void zip (double *out, vec a, vec b)
{
    __m256d low = _mm256_unpacklo_pd ((__m256d) a, (__m256d) b),
            high = _mm256_unpackhi_pd ((__m256d) a, (__m256d) b);
    _mm256_storeu_pd (out, _mm256_permute2f128_pd (low, high, 0x20));
    _mm256_storeu_pd (out + 4, _mm256_permute2f128_pd (low, high, 0x31));
}

/* in = a0 b0 a1 b1 ...: separates components x and y of LANES points into two vectors. */
static inline __attribute__ ((always_inline)) TARGET void unzip (const double *in, vec *a, vec *b)
{
    __m256d first = _mm256_loadu_pd (in), last = _mm256_loadu_pd (in + 4);
    __m256d low = _mm256_permute2f128_pd (first, last, 0x20),
            high = _mm256_permute2f128_pd (first, last, 0x31);
    *a = (vec) _mm256_unpacklo_pd (low, high);
    *b = (vec) _mm256_unpackhi_pd (low, high);
}

#include "block_kernel.h"
#include "fft_kernel.h"
#else
const pg_block_kernels pg_block_avx2 = { .spread = NULL };
const fft_kernels pg_fft_avx2 = { .still = NULL };
#endif
