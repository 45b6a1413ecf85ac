/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums over a list of bonds, four at a time. */
#include "list.h"
#ifdef __x86_64__
#include <immintrin.h>
#include <string.h>

#define SET    _avx2
#define TARGET __attribute__ ((target ("avx2")))
#define V      __m256d
#define WIDTH  4
#define V_LOAD(p)        _mm256_load_pd (p)
#define V_SET(s)         _mm256_set1_pd (s)
#define V_ROOT(v)        _mm256_sqrt_pd (v)
#define V_KEEP(v, bits)  keep (v, bits)
#define V_LEAST(a, b)    ((unsigned) _mm256_movemask_pd (_mm256_cmp_pd (a, b, _CMP_GE_OQ)))

static inline __attribute__ ((always_inline)) TARGET __m256d keep (__m256d v, unsigned bits)
{
    const __m256i bit = _mm256_set_epi64x (8, 4, 2, 1),
                  got = _mm256_and_si256 (_mm256_set1_epi64x ((long long) bits), bit);
    return _mm256_and_pd (v, _mm256_castsi256_pd (_mm256_cmpeq_epi64 (got, bit)));
}

/* Rows to columns; of rows that are not needed the columns are left out by the compiler. */
#define TURN(r0, r1, r2, r3, c0, c1, c2, c3) \
    const __m256d c0##l = _mm256_unpacklo_pd (r0, r1), c0##h = _mm256_unpackhi_pd (r0, r1); \
    const __m256d c2##l = _mm256_unpacklo_pd (r2, r3), c2##h = _mm256_unpackhi_pd (r2, r3); \
    const __m256d c0 = _mm256_permute2f128_pd (c0##l, c2##l, 0x20), \
                  c1 = _mm256_permute2f128_pd (c0##h, c2##h, 0x20); \
    const __m256d c2 = _mm256_permute2f128_pd (c0##l, c2##l, 0x31), \
                  c3 = _mm256_permute2f128_pd (c0##h, c2##h, 0x31)
#define ROW(record, o, k) _mm256_load_pd ((record) + (o)[k])
#define V_FETCH1(record, o) \
    const __m128d p0_ = _mm_load_pd ((record) + (o)[0]), p1_ = _mm_load_pd ((record) + (o)[1]); \
    const __m128d p2_ = _mm_load_pd ((record) + (o)[2]), p3_ = _mm_load_pd ((record) + (o)[3]); \
    const __m256d q0_ = _mm256_set_m128d (p2_, p0_), q1_ = _mm256_set_m128d (p3_, p1_); \
    const __m256d x0 = _mm256_unpacklo_pd (q0_, q1_), u0 = _mm256_unpackhi_pd (q0_, q1_)
#define V_FETCH2(record, o) \
    TURN (ROW (record, o, 0), ROW (record, o, 1), ROW (record, o, 2), ROW (record, o, 3), x0, x1, u0, u1)
#define V_FETCH3(record, o) \
    TURN (ROW (record, o, 0), ROW (record, o, 1), ROW (record, o, 2), ROW (record, o, 3), x0, x1, x2, u0); \
    const __m128d p0_ = _mm_load_pd ((record) + (o)[0] + 4), p1_ = _mm_load_pd ((record) + (o)[1] + 4); \
    const __m128d p2_ = _mm_load_pd ((record) + (o)[2] + 4), p3_ = _mm_load_pd ((record) + (o)[3] + 4); \
    const __m256d q0_ = _mm256_set_m128d (p2_, p0_), q1_ = _mm256_set_m128d (p3_, p1_); \
    const __m256d u1 = _mm256_unpacklo_pd (q0_, q1_), u2 = _mm256_unpackhi_pd (q0_, q1_)
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
#define V_GIVE1(sum, o) do { for (int k_ = 0; k_ < 4; k_++) *PLACE (sum, o, k_) -= f0[k_]; } while (0)
#define V_GIVE2(sum, o) \
    do { \
        const __m256d l_ = _mm256_unpacklo_pd (f0, f1), h_ = _mm256_unpackhi_pd (f0, f1); \
        TAKE2 (sum, o, 0, _mm256_castpd256_pd128 (l_)); \
        TAKE2 (sum, o, 1, _mm256_castpd256_pd128 (h_)); \
        TAKE2 (sum, o, 2, _mm256_extractf128_pd (l_, 1)); \
        TAKE2 (sum, o, 3, _mm256_extractf128_pd (h_, 1)); \
    } while (0)
#define V_GIVE3(sum, o) \
    do { \
        TURN (f0, f1, f2, _mm256_setzero_pd (), t0_, t1_, t2_, t3_); \
        TAKE4 (sum, o, 0, t0_); \
        TAKE4 (sum, o, 1, t1_); \
        TAKE4 (sum, o, 2, t2_); \
        TAKE4 (sum, o, 3, t3_); \
    } while (0)

#define DIM 1
#include "list_kernel.h"
#define DIM 2
#include "list_kernel.h"
#define DIM 3
#include "list_kernel.h"

const bond_list_kernel bond_list_avx2[3][2][2] = {
    { { linear1_avx2, linear_check1_avx2 }, { finite1_avx2, finite_check1_avx2 } },
    { { linear2_avx2, linear_check2_avx2 }, { finite2_avx2, finite_check2_avx2 } },
    { { linear3_avx2, linear_check3_avx2 }, { finite3_avx2, finite_check3_avx2 } } };
#else
const bond_list_kernel bond_list_avx2[3][2][2];
#endif
