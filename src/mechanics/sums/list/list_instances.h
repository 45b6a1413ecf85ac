/* SPDX-License-Identifier: GPL-3.0-or-later
 * list_instances.h: every loop of list_laws.h for one instruction set, and the table of them (private, no
 * guard). Included by list_scalar.c, list_avx2.c, list_avx512.c behind their vectors:
 *   TARGET, TABLE                    attribute of every function; name of the table
 *   V, WIDTH                         a vector of WIDTH numbers, with + - * /
 *   V_LOAD (p), V_STORE (p, v)       aligned; V_SET (s): s in every lane; V_ROOT (v)
 *   V_KEEP (v, bits)                 0 in lanes whose bit is not set
 *   V_LEAST (a, b)                   bits of the lanes where a >= b
 *   FETCH (record, o, columns, out)  the first `columns` numbers (a constant) of the records at offsets
 *                                    o[0 .. WIDTH - 1]
 * GIVE (sum, o, dim, f)            subtracts f[0 .. dim - 1] from sums at half these offsets, lane after lane
 * No operation is contracted and the order is the same for every WIDTH: all instruction sets give the same
 * bits. */
#include "mechanics/sums/terms/inline.h"

/* Returns a . b. */
INLINE V vec_dot (int dim, const V *a, const V *b)
{
    V sum = a[0] * b[0];
    UNROLL for (int c = 1; c < dim; c++) sum = sum + a[c] * b[c];
    return sum;
}

INLINE void vec_differ (int dim, const V *own, const V *other, V *out)
{
    UNROLL for (int c = 0; c < dim; c++) out[c] = other[c] - own[c];
}

enum { PARTS = LIST_LANES / WIDTH, MOST_COLUMNS = 12, MOST_SUMS = 6 };
/* The points of a slice that fit into a vector: numbers of their records, and their sums. */
typedef struct { V own[MOST_COLUMNS], sum[MOST_SUMS]; } lanes;

#include "law_beam.h"
#include "law_pair.h"
#include "law_state.h"

#define GLUE_(a, b) a##b
#define GLUE(a, b) GLUE_ (a, b)
/* For each law: LAW_BREAKS 1: it has a loop that breaks bonds; LEAST_DIMENSION: the least that it is defined
 * for. */
#define LAW pair_linear
#define LAW_BREAKS 1
#define LEAST_DIMENSION 1
#include "list_kernel.h"
#define LAW pair_finite
#define LAW_BREAKS 1
#define LEAST_DIMENSION 1
#include "list_kernel.h"
#define LAW state_dilate
#define LAW_BREAKS 1
#define LEAST_DIMENSION 2
#include "list_kernel.h"
#define LAW state_pull
#define LAW_BREAKS 0
#define LEAST_DIMENSION 2
#include "list_kernel.h"
#define LAW state_store
#define LAW_BREAKS 0
#define LEAST_DIMENSION 2
#include "list_kernel.h"
#define LAW beam_force
#define LAW_BREAKS 1
#define LEAST_DIMENSION 2
#include "list_kernel.h"
#define LAW beam_store
#define LAW_BREAKS 0
#define LEAST_DIMENSION 2
#include "list_kernel.h"

/* Casts a loop, or the 0 in place of one that does not exist, which some compilers do not take for a null
 * pointer. */
#define THE(loop) (list_kernel) (loop)
#define LOOPS(law) \
    [LIST_##law] = { { THE (law##_10), THE (law##_11) }, { THE (law##_20), THE (law##_21) }, \
                     { THE (law##_30), THE (law##_31) } },
const list_kernels TABLE = { { LIST_LAWS (LOOPS) } };
