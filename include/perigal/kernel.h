/* SPDX-License-Identifier: GPL-3.0-or-later
 * kernel.h: influence functions w(q), q = r / horizon in [0, 1], the weight of a neighbour at distance r. A
 * kernel is an entry of the catalogue: src/discretization/kernel/NAME.c and one line in list.h. */
#ifndef PERIGAL_KERNEL_H
#define PERIGAL_KERNEL_H
#include "perigal/base.h"

PG_API_BEGIN

/* An influence function. */
typedef struct {
    /* The value of `method.kernel` in a scene. */
    const char *name;
    /* Formula and source. */
    const char *summary;
    /* 1: w(1) > 0, so that a bond of exactly the horizon's length counts. */
    int  closed;
    /* Values w (n) and, unless dw is NULL, derivatives dw/dq (n) at n values of q >= 0. */
    void (*value) (size_t n, const double *q, double *w, double *dw);
} pg_kernel;

/* int_0^1 w(q) q^n dq by quadrature. The moment m_n of a horizon delta, int_0^delta w(r / delta) r^n dr, is
 * delta^(n + 1) times this. */
double           pg_kernel_moment (const pg_kernel *kernel, int n);
/* The kernel of that name, NULL: unknown; entry i, NULL past the end; all names, separated by |. */
const pg_kernel *pg_kernel_find  (const char *name);
const pg_kernel *pg_kernel_entry (size_t i);
const char      *pg_kernel_names (void);
PG_API_END
#endif
