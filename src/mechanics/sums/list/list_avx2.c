/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums over a list of bonds, four at a time. */
#include "list.h"
#ifdef __x86_64__
#include <immintrin.h>
#include <string.h>

#define TABLE  pg_list_avx2
#define TARGET __attribute__ ((target ("avx2")))
#define V      __m256d
#define WIDTH  4
#define V_LOAD(p)        _mm256_load_pd (p)
#define V_STORE(p, v)    _mm256_store_pd (p, v)
#define V_SET(s)         _mm256_set1_pd (s)
#define V_ROOT(v)        _mm256_sqrt_pd (v)
#define V_KEEP(v, bits)  keep (v, bits)
#define V_LEAST(a, b)    ((unsigned) _mm256_movemask_pd (_mm256_cmp_pd (a, b, _CMP_GE_OQ)))

/* v in lanes whose bit is set, 0 in the others. */
static inline __attribute__ ((always_inline)) TARGET __m256d keep (__m256d v, unsigned bits)
{
    const __m256i bit = _mm256_set_epi64x (8, 4, 2, 1);
    const __m256i got = _mm256_and_si256 (_mm256_set1_epi64x ((long long) bits), bit);
    return _mm256_and_pd (v, _mm256_castsi256_pd (_mm256_cmpeq_epi64 (got, bit)));
}

/* Transposes four rows to four columns; the compiler leaves out columns that are not used. */
static inline __attribute__ ((always_inline)) TARGET void turn (__m256d r0, __m256d r1, __m256d r2,
                                                                __m256d r3, __m256d *out)
{
    const __m256d low = _mm256_unpacklo_pd (r0, r1), high = _mm256_unpackhi_pd (r0, r1);
    const __m256d low2 = _mm256_unpacklo_pd (r2, r3), high2 = _mm256_unpackhi_pd (r2, r3);
    out[0] = _mm256_permute2f128_pd (low, low2, 0x20), out[1] = _mm256_permute2f128_pd (high, high2, 0x20);
    out[2] = _mm256_permute2f128_pd (low, low2, 0x31), out[3] = _mm256_permute2f128_pd (high, high2, 0x31);
}

/* Load four (ROW) or two (HALF) numbers of the record at offset o[k]; TURN: four columns of four records. */
#define ROW(record, o, k) _mm256_load_pd ((record) + (o)[k])
#define HALF(record, o, k) _mm_load_pd ((record) + (o)[k])
#define TURN(record, o, out) \
    turn (ROW (record, o, 0), ROW (record, o, 1), ROW (record, o, 2), ROW (record, o, 3), out)
/* Fetches two columns of four records. */
#define PAIR(record, o, out) \
    do { \
        const __m256d even_ = _mm256_set_m128d (HALF (record, o, 2), HALF (record, o, 0)); \
        const __m256d odd_ = _mm256_set_m128d (HALF (record, o, 3), HALF (record, o, 1)); \
        (out)[0] = _mm256_unpacklo_pd (even_, odd_), (out)[1] = _mm256_unpackhi_pd (even_, odd_); \
    } while (0)
/* As `columns` is a constant, the compiler keeps one of these branches. */
#define FETCH(record, o, columns, out) \
    do { \
        if ((columns) <= 2) PAIR (record, o, out); \
        else TURN (record, o, out); \
        if ((columns) > 4 && (columns) <= 6) PAIR ((record) + 4, o, (out) + 4); \
        else if ((columns) > 4) TURN ((record) + 4, o, (out) + 4); \
        if ((columns) > 8) TURN ((record) + 8, o, (out) + 8); \
    } while (0)

/* Subtracts forces in 2D from the sums of the other ends, one after the other, as two lanes may have the same
 * end. */
#define GIVE2(sum, o, f) \
    do { \
        const __m256d l_ = _mm256_unpacklo_pd ((f)[0], (f)[1]), h_ = _mm256_unpackhi_pd ((f)[0], (f)[1]); \
        TAKE2 (sum, o, 0, _mm256_castpd256_pd128 (l_)); \
        TAKE2 (sum, o, 1, _mm256_castpd256_pd128 (h_)); \
        TAKE2 (sum, o, 2, _mm256_extractf128_pd (l_, 1)); \
        TAKE2 (sum, o, 3, _mm256_extractf128_pd (h_, 1)); \
    } while (0)
/* Subtracts forces in 3D from the sums of the other ends, one after the other: three components and a zero
 * each. */
#define GIVE3(sum, o, f) \
    do { \
        __m256d t_[4]; \
        turn ((f)[0], (f)[1], (f)[2], _mm256_setzero_pd (), t_); \
        TAKE4 (sum, o, 0, t_[0]); \
        TAKE4 (sum, o, 1, t_[1]); \
        TAKE4 (sum, o, 2, t_[2]); \
        TAKE4 (sum, o, 3, t_[3]); \
    } while (0)

#include "list_give.h"
#include "list_instances.h"
#else
const list_kernels pg_list_avx2;
#endif
