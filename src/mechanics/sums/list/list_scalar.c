/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums over a list of bonds, one bond after the other. */
#include "list.h"
#include <math.h>
#include <string.h>

/* Operations that list_instances.h needs: V is a vector of WIDTH numbers, here one; V_KEEP clears lanes whose
 * bit is not set; V_LEAST: bits of the lanes where a >= b. */
#define TABLE  pg_list_scalar
#define TARGET
#define V      double
#define WIDTH  1
#define V_LOAD(p)        (*(p))
#define V_STORE(p, v)    (*(p) = (v))
#define V_SET(s)         ((double) (s))
#define V_ROOT(v)        sqrt (v)
#define V_KEEP(v, bits)  ((bits) ? (v) : 0.0)
#define V_LEAST(a, b)    ((a) >= (b) ? 1u : 0u)
/* Fetches the first numbers of the record at offset *o (in doubles). */
#define FETCH(record, o, columns, out) \
    do { \
        const double *row_ = (record) + *(o); \
        UNROLL for (int c_ = 0; c_ < (columns); c_++) (out)[c_] = row_[c_]; \
    } while (0)
/* Subtracts the force f from the sums of the other end, which are half as long as its record. */
#define GIVE(sum, o, dim, f) \
    do { \
        double *to_ = (sum) + *(o) / 2; \
        UNROLL for (int c_ = 0; c_ < (dim); c_++) to_[c_] -= (f)[c_]; \
    } while (0)

#include "list_instances.h"
