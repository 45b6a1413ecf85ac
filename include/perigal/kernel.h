/* SPDX-License-Identifier: GPL-3.0-or-later
 * kernel.h: influence functions w(q), q = r / horizon in [0, 1]. Catalogue: src/kernel/<name>.c + one line in
 * list.h. */
#ifndef PERIGAL_KERNEL_H
#define PERIGAL_KERNEL_H
#include "perigal/base.h"

PG_API_BEGIN

typedef struct {
    const char *name;                                  /* as in the scene file */
    const char *summary;                               /* formula and source */
    int  closed;  /* 1: w(1) > 0, a bond of exactly the horizon's length counts */
    /* n values of q in [0, 1] -> w (n) and, unless dw is NULL, dw/dq (n) */
    void (*value) (size_t n, const double *q, double *w, double *dw);
} pg_kernel;

/* int_0^1 w(q) q^n dq; the moment m_n of a horizon d (theory section 0) is d^(n+1) times this. */
double           pg_kernel_moment (const pg_kernel *kernel, int n);
const pg_kernel *pg_kernel_find  (const char *name);   /* NULL: unknown */
const pg_kernel *pg_kernel_entry (size_t i);           /* NULL past the end */
const char      *pg_kernel_names (void);               /* "constant|quadratic|..." */
PG_API_END
#endif
