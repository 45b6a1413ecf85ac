/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums over a list of bonds, eight at a time. */
#include "list.h"
#ifdef __x86_64__
#include <immintrin.h>
#include <string.h>

#define SET    _avx512
#define TARGET __attribute__ ((target ("avx512f,avx512dq,avx512vl,avx512bw")))
#define V      __m512d
#define WIDTH  8
#define V_LOAD(p)        load (p)
#define V_SET(s)         _mm512_set1_pd (s)
#define V_ROOT(v)        _mm512_sqrt_pd (v)
#define V_KEEP(v, bits)  _mm512_maskz_mov_pd ((__mmask8) (bits), v)
#define V_LEAST(a, b)    ((unsigned) _mm512_cmp_pd_mask (a, b, _CMP_GE_OQ))

/* Into a register: the compiler would merge it with the masked product behind it, whose load then waits for
 * the mask (a third of the speed lost). */
static inline __attribute__ ((always_inline)) TARGET __m512d load (const double *p)
{
    __m512d v = _mm512_load_pd (p);
    __asm__ ("" : "+v" (v));
    return v;
}

#define PAIR(record, o, i, j) \
    _mm512_insertf64x4 (_mm512_castpd256_pd512 (_mm256_load_pd ((record) + (o)[i])), \
                        _mm256_load_pd ((record) + (o)[j]), 1)
#define QUAD(record, o, i, j, k, m) \
    _mm512_insertf64x4 (_mm512_castpd256_pd512 ( \
                            _mm256_insertf128_pd (_mm256_castpd128_pd256 (_mm_load_pd ((record) + (o)[i])), \
                                                  _mm_load_pd ((record) + (o)[j]), 1)), \
                        _mm256_insertf128_pd (_mm256_castpd128_pd256 (_mm_load_pd ((record) + (o)[k])), \
                                              _mm_load_pd ((record) + (o)[m]), 1), \
                        1)
#define ROW(record, o, k) _mm512_load_pd ((record) + (o)[k])
#define LANES(a, b, choice) _mm512_shuffle_f64x2 (a, b, choice)

#define V_FETCH1(record, o) \
    const __m512d p0_ = QUAD (record, o, 0, 2, 4, 6), p1_ = QUAD (record, o, 1, 3, 5, 7); \
    const __m512d x0 = _mm512_unpacklo_pd (p0_, p1_), u0 = _mm512_unpackhi_pd (p0_, p1_)
#define V_FETCH2(record, o) \
    const __m512d p0_ = PAIR (record, o, 0, 2), p1_ = PAIR (record, o, 1, 3), p2_ = PAIR (record, o, 4, 6), \
                  p3_ = PAIR (record, o, 5, 7); \
    const __m512d l0_ = _mm512_unpacklo_pd (p0_, p1_), l1_ = _mm512_unpacklo_pd (p2_, p3_); \
    const __m512d h0_ = _mm512_unpackhi_pd (p0_, p1_), h1_ = _mm512_unpackhi_pd (p2_, p3_); \
    const __m512d x0 = LANES (l0_, l1_, 0x88), x1 = LANES (h0_, h1_, 0x88), u0 = LANES (l0_, l1_, 0xdd), \
                  u1 = LANES (h0_, h1_, 0xdd)
/* pairs of one half of the columns: 01, 23, 45, 67 */
#define HALVES(l, unpack, record, o, first, second, third) \
    const __m512d l##0_ = unpack (ROW (record, o, 0), ROW (record, o, 1)), \
                  l##1_ = unpack (ROW (record, o, 2), ROW (record, o, 3)); \
    const __m512d l##2_ = unpack (ROW (record, o, 4), ROW (record, o, 5)), \
                  l##3_ = unpack (ROW (record, o, 6), ROW (record, o, 7)); \
    const __m512d l##4_ = LANES (l##0_, l##1_, 0x44), l##5_ = LANES (l##2_, l##3_, 0x44); \
    const __m512d first = LANES (l##4_, l##5_, 0x88), second = LANES (l##4_, l##5_, 0xdd); \
    const __m512d third = LANES (LANES (l##0_, l##1_, 0xaa), LANES (l##2_, l##3_, 0xaa), 0x88)
#define V_FETCH3(record, o) \
    HALVES (l, _mm512_unpacklo_pd, record, o, x0, x2, u1); \
    HALVES (h, _mm512_unpackhi_pd, record, o, x1, u0, u2)

#define PLACE(sum, o, k) (double *) (void *) ((char *) (sum) + 4 * (size_t) (o)[k])
#define TAKE2(sum, o, k, v) \
    do { \
        double *p_ = PLACE (sum, o, k); \
        _mm_store_pd (p_, _mm_sub_pd (_mm_load_pd (p_), v)); \
    } while (0)
#define TAKE4(sum, o, k, v) \
    do { \
        double *p_ = PLACE (sum, o, k); \
        _mm256_store_pd (p_, _mm256_sub_pd (_mm256_load_pd (p_), v)); \
    } while (0)
/* in the order of the lanes: two of them may meet at one point */
#define V_GIVE1(sum, o) do { for (int k_ = 0; k_ < 8; k_++) *PLACE (sum, o, k_) -= f0[k_]; } while (0)
#define V_GIVE2(sum, o) \
    do { \
        const __m512d even_ = _mm512_unpacklo_pd (f0, f1), odd_ = _mm512_unpackhi_pd (f0, f1); \
        TAKE2 (sum, o, 0, _mm512_castpd512_pd128 (even_)); \
        TAKE2 (sum, o, 1, _mm512_castpd512_pd128 (odd_)); \
        TAKE2 (sum, o, 2, _mm512_extractf64x2_pd (even_, 1)); \
        TAKE2 (sum, o, 3, _mm512_extractf64x2_pd (odd_, 1)); \
        TAKE2 (sum, o, 4, _mm512_extractf64x2_pd (even_, 2)); \
        TAKE2 (sum, o, 5, _mm512_extractf64x2_pd (odd_, 2)); \
        TAKE2 (sum, o, 6, _mm512_extractf64x2_pd (even_, 3)); \
        TAKE2 (sum, o, 7, _mm512_extractf64x2_pd (odd_, 3)); \
    } while (0)
/* {f0, f1} and {f2, 0} of points 0 2 4 6 and 1 3 5 7, then side by side */
#define V_GIVE3(sum, o) \
    do { \
        const __m512d zero_ = _mm512_setzero_pd (); \
        const __m512d le_ = _mm512_unpacklo_pd (f0, f1), ue_ = _mm512_unpacklo_pd (f2, zero_); \
        const __m512d lo_ = _mm512_unpackhi_pd (f0, f1), uo_ = _mm512_unpackhi_pd (f2, zero_); \
        const __m512i first_ = _mm512_set_epi64 (11, 10, 3, 2, 9, 8, 1, 0), \
                      second_ = _mm512_set_epi64 (15, 14, 7, 6, 13, 12, 5, 4); \
        const __m512d a_ = _mm512_permutex2var_pd (le_, first_, ue_), \
                      b_ = _mm512_permutex2var_pd (le_, second_, ue_); \
        const __m512d c_ = _mm512_permutex2var_pd (lo_, first_, uo_), \
                      d_ = _mm512_permutex2var_pd (lo_, second_, uo_); \
        TAKE4 (sum, o, 0, _mm512_castpd512_pd256 (a_)); \
        TAKE4 (sum, o, 1, _mm512_castpd512_pd256 (c_)); \
        TAKE4 (sum, o, 2, _mm512_extractf64x4_pd (a_, 1)); \
        TAKE4 (sum, o, 3, _mm512_extractf64x4_pd (c_, 1)); \
        TAKE4 (sum, o, 4, _mm512_castpd512_pd256 (b_)); \
        TAKE4 (sum, o, 5, _mm512_castpd512_pd256 (d_)); \
        TAKE4 (sum, o, 6, _mm512_extractf64x4_pd (b_, 1)); \
        TAKE4 (sum, o, 7, _mm512_extractf64x4_pd (d_, 1)); \
    } while (0)

#define DIM 1
#include "list_kernel.h"
#define DIM 2
#include "list_kernel.h"
#define DIM 3
#include "list_kernel.h"

const bond_list_kernel bond_list_avx512[3][2][2] = {
    { { linear1_avx512, linear_check1_avx512 }, { finite1_avx512, finite_check1_avx512 } },
    { { linear2_avx512, linear_check2_avx512 }, { finite2_avx512, finite_check2_avx512 } },
    { { linear3_avx512, linear_check3_avx512 }, { finite3_avx512, finite_check3_avx512 } } };
#else
const bond_list_kernel bond_list_avx512[3][2][2];
#endif
