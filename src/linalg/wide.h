/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: four numbers at a time, for products with blocks of three unknowns a node. A block row and the
 * three numbers of a node are loaded as four, and what the fourth lane adds up to is ignored. So the place
 * behind the last number is read: the last block of a row is left to scalars, as only that may be the last of
 * all. The operations and their order are the same with and without AVX. */
#ifndef PG_LINALG_WIDE_H
#define PG_LINALG_WIDE_H
typedef double four __attribute__ ((vector_size (32), aligned (8)));
typedef float  four_floats __attribute__ ((vector_size (16), aligned (4)));
/* not under the thread sanitizer: the choice is made before it has started */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(PG_DEBUG) \
    && !defined(__SANITIZE_THREAD__)
#define WIDE __attribute__ ((target_clones ("avx2", "default")))
#define WIDEST __attribute__ ((target_clones ("avx512f", "avx2", "default")))
#else
#define WIDE
#define WIDEST
#endif
/* Eight numbers, for which WIDEST is meant. */
typedef double eight __attribute__ ((vector_size (64), aligned (8)));
/* Sum of the first three lanes. */
static inline double three_lanes (const four *a) { return (*a)[0] + (*a)[1] + (*a)[2]; }
#endif
