/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums over a list of bonds, eight at a time. */
#include "list.h"
#ifdef __x86_64__
#include <immintrin.h>
#include <string.h>

#define TABLE  pg_list_avx512
#define TARGET __attribute__ ((target ("avx512f,avx512dq,avx512vl,avx512bw")))
#define V      __m512d
#define WIDTH  8
#define V_LOAD(p)        load (p)
#define V_STORE(p, v)    _mm512_store_pd (p, v)
#define V_SET(s)         _mm512_set1_pd (s)
#define V_ROOT(v)        _mm512_sqrt_pd (v)
#define V_KEEP(v, bits)  _mm512_maskz_mov_pd ((__mmask8) (bits), v)
#define V_LEAST(a, b)    ((unsigned) _mm512_cmp_pd_mask (a, b, _CMP_GE_OQ))

/* Loads into a register: the compiler would merge the load with the masked product behind it, so that it
 * waits for the mask (a third of the speed lost). */
static inline __attribute__ ((always_inline)) TARGET __m512d load (const double *p)
{
    __m512d v = _mm512_load_pd (p);
    __asm__ ("" : "+v" (v));
    return v;
}

/* LANES: chooses quarters of two vectors. ROW, PAIR, HALF, QUAD: load rows of records, or parts of two or
 * four rows, which FETCH transposes to columns. */
#define LANES(a, b, choice) _mm512_shuffle_f64x2 (a, b, choice)
#define ROW(record, o, k) _mm512_load_pd ((record) + (o)[k])
#define PAIR(record, o, i, j) \
    _mm512_insertf64x4 (_mm512_castpd256_pd512 (_mm256_load_pd ((record) + (o)[i])), \
                        _mm256_load_pd ((record) + (o)[j]), 1)
#define HALF(record, o, i, j) \
    _mm256_insertf128_pd (_mm256_castpd128_pd256 (_mm_load_pd ((record) + (o)[i])), \
                          _mm_load_pd ((record) + (o)[j]), 1)
#define QUAD(record, o, i, j, k, m) \
    _mm512_insertf64x4 (_mm512_castpd256_pd512 (HALF (record, o, i, j)), HALF (record, o, k, m), 1)

/* FETCH2, FETCH4: transpose 2 or 4 columns of the records of eight points to as many vectors. Even and odd
 * points are loaded separately and interleaved by unpacking, as shuffles within quarters of a register cost
 * less than gathers. */
#define FETCH2(record, o, out) \
    do { \
        const __m512d even_ = QUAD (record, o, 0, 2, 4, 6), odd_ = QUAD (record, o, 1, 3, 5, 7); \
        (out)[0] = _mm512_unpacklo_pd (even_, odd_), (out)[1] = _mm512_unpackhi_pd (even_, odd_); \
    } while (0)
#define FETCH4(record, o, out) \
    do { \
        const __m512d p0_ = PAIR (record, o, 0, 2), p1_ = PAIR (record, o, 1, 3); \
        const __m512d p2_ = PAIR (record, o, 4, 6), p3_ = PAIR (record, o, 5, 7); \
        const __m512d l0_ = _mm512_unpacklo_pd (p0_, p1_), l1_ = _mm512_unpacklo_pd (p2_, p3_); \
        const __m512d h0_ = _mm512_unpackhi_pd (p0_, p1_), h1_ = _mm512_unpackhi_pd (p2_, p3_); \
        (out)[0] = LANES (l0_, l1_, 0x88), (out)[1] = LANES (h0_, h1_, 0x88); \
        (out)[2] = LANES (l0_, l1_, 0xdd), (out)[3] = LANES (h0_, h1_, 0xdd); \
    } while (0)
/* Columns n, n + 2, n + 4, n + 6 of rows that are interleaved two by two (01, 23, 45, 67); the compiler
 * leaves out columns that are not used. */
static inline __attribute__ ((always_inline)) TARGET void every_other (__m512d a, __m512d b, __m512d c,
                                                                       __m512d d, __m512d *out)
{
    const __m512d first = LANES (a, b, 0x44), second = LANES (c, d, 0x44);
    const __m512d third = LANES (a, b, 0xee), fourth = LANES (c, d, 0xee);
    out[0] = LANES (first, second, 0x88), out[2] = LANES (first, second, 0xdd);
    out[4] = LANES (third, fourth, 0x88), out[6] = LANES (third, fourth, 0xdd);
}
#define INTERLEAVED(unpack, record, o, i, j) unpack (ROW (record, o, i), ROW (record, o, j))
#define HALVES(unpack, record, o, out) \
    every_other (INTERLEAVED (unpack, record, o, 0, 1), INTERLEAVED (unpack, record, o, 2, 3), \
                 INTERLEAVED (unpack, record, o, 4, 5), INTERLEAVED (unpack, record, o, 6, 7), out)
/* As `columns` is a constant, the compiler keeps one of these branches. */
#define FETCH(record, o, columns, out) \
    do { \
        if ((columns) <= 2) FETCH2 (record, o, out); \
        else if ((columns) <= 4) FETCH4 (record, o, out); \
        else { \
            HALVES (_mm512_unpacklo_pd, record, o, out); \
            HALVES (_mm512_unpackhi_pd, record, o, (out) + 1); \
        } \
        if ((columns) > 8) FETCH4 ((record) + 8, o, (out) + 8); \
    } while (0)

/* Subtracts forces in 2D from the sums of the other ends, one after the other, as two lanes may have the same
 * end. */
#define GIVE2(sum, o, f) \
    do { \
        const __m512d even_ = _mm512_unpacklo_pd ((f)[0], (f)[1]); \
        const __m512d odd_ = _mm512_unpackhi_pd ((f)[0], (f)[1]); \
        TAKE2 (sum, o, 0, _mm512_castpd512_pd128 (even_)); \
        TAKE2 (sum, o, 1, _mm512_castpd512_pd128 (odd_)); \
        TAKE2 (sum, o, 2, _mm512_extractf64x2_pd (even_, 1)); \
        TAKE2 (sum, o, 3, _mm512_extractf64x2_pd (odd_, 1)); \
        TAKE2 (sum, o, 4, _mm512_extractf64x2_pd (even_, 2)); \
        TAKE2 (sum, o, 5, _mm512_extractf64x2_pd (odd_, 2)); \
        TAKE2 (sum, o, 6, _mm512_extractf64x2_pd (even_, 3)); \
        TAKE2 (sum, o, 7, _mm512_extractf64x2_pd (odd_, 3)); \
    } while (0)
/* Subtracts forces in 3D from the sums of the other ends: {f0, f1} and {f2, 0} of points 0 2 4 6 and of 1 3 5
 * 7 are put side by side as {f0, f1, f2, 0}. */
#define GIVE3(sum, o, f) \
    do { \
        const __m512d zero_ = _mm512_setzero_pd (); \
        const __m512d le_ = _mm512_unpacklo_pd ((f)[0], (f)[1]), ue_ = _mm512_unpacklo_pd ((f)[2], zero_); \
        const __m512d lo_ = _mm512_unpackhi_pd ((f)[0], (f)[1]), uo_ = _mm512_unpackhi_pd ((f)[2], zero_); \
        const __m512i first_ = _mm512_set_epi64 (11, 10, 3, 2, 9, 8, 1, 0); \
        const __m512i second_ = _mm512_set_epi64 (15, 14, 7, 6, 13, 12, 5, 4); \
        const __m512d a_ = _mm512_permutex2var_pd (le_, first_, ue_); \
        const __m512d b_ = _mm512_permutex2var_pd (le_, second_, ue_); \
        const __m512d c_ = _mm512_permutex2var_pd (lo_, first_, uo_); \
        const __m512d d_ = _mm512_permutex2var_pd (lo_, second_, uo_); \
        TAKE4 (sum, o, 0, _mm512_castpd512_pd256 (a_)); \
        TAKE4 (sum, o, 1, _mm512_castpd512_pd256 (c_)); \
        TAKE4 (sum, o, 2, _mm512_extractf64x4_pd (a_, 1)); \
        TAKE4 (sum, o, 3, _mm512_extractf64x4_pd (c_, 1)); \
        TAKE4 (sum, o, 4, _mm512_castpd512_pd256 (b_)); \
        TAKE4 (sum, o, 5, _mm512_castpd512_pd256 (d_)); \
        TAKE4 (sum, o, 6, _mm512_extractf64x4_pd (b_, 1)); \
        TAKE4 (sum, o, 7, _mm512_extractf64x4_pd (d_, 1)); \
    } while (0)

#include "list_give.h"
#include "list_instances.h"
#else
const list_kernels pg_list_avx512;
#endif
