/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: forces of a vector of bonds subtracted from the sums of their points, for any width. Of the width
 * come WIDTH, GIVE2 and GIVE3; two bonds of a vector may meet at one point, so that the lanes follow one
 * after the other. Offsets o are those of list_kernel.h. */
#ifndef PG_LIST_GIVE_H
#define PG_LIST_GIVE_H
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
/* In the order of the lanes: two of them may meet at one point. */
#define GIVE1(sum, o, f) \
    do { \
        for (int k_ = 0; k_ < WIDTH; k_++) *PLACE (sum, o, k_) -= (f)[0][k_]; \
    } while (0)
#define GIVE(sum, o, dim, f) \
    do { \
        if ((dim) == 1) GIVE1 (sum, o, f); \
        else if ((dim) == 2) GIVE2 (sum, o, f); \
        else GIVE3 (sum, o, f); \
    } while (0)
#endif
