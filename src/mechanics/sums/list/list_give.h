/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: subtracts the forces of a vector of bonds from the sums of their other ends. WIDTH (bonds of a
 * vector), GIVE2 and GIVE3 (2D, 3D) are defined by the including file. As two bonds of a vector may have the
 * same end, lanes are subtracted one after the other. o: offsets of records, as `near` of bond_slots. */
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
/* Subtracts forces in 1D from the sums of the other ends, lane after lane, as two lanes may have the same
 * end. */
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
