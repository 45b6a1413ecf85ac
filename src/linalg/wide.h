/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: four numbers at a time, for products with blocks of three unknowns a node. A block row and the
 * three numbers of a node are loaded as four, and the sum in the fourth lane is ignored. This reads one
 * number too many, which at the end of an array would not be there: the last block of a row, which may be the
 * last of all, is left to scalars. The operations and their order are the same with and without AVX. */
#ifndef PG_LINALG_WIDE_H
#define PG_LINALG_WIDE_H
typedef double four __attribute__ ((vector_size (32), aligned (8)));
typedef float  four_floats __attribute__ ((vector_size (16), aligned (4)));
/* Eight numbers at a time, for functions compiled with PG_WIDEST (AVX-512 where the machine has it). */
typedef double eight __attribute__ ((vector_size (64), aligned (8)));
/* Sum of the first three lanes. */
static inline double three_lanes (const four *a) { return (*a)[0] + (*a)[1] + (*a)[2]; }
#endif
