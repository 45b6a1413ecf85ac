/* SPDX-License-Identifier: GPL-3.0-or-later
 * The entry "skyline", once an envelope factorisation for small systems: now another name of the usual
 * factorisation. */
#include "perigal/linalg.h"

static const pg_linear_type *usual (void) { return pg_linear_first (1, 1); }
static pg_status analyse (void **self, const pg_sparse *A, const pg_linear_options *options)
{
    return usual ()->analyse (self, A, options);
}
static pg_status factor (void *self, const pg_sparse *A) { return usual ()->factor (self, A); }
static pg_status solve (void *self, size_t nrhs, const double *b, double *x)
{
    return usual ()->solve (self, nrhs, b, x);
}
static void info (const void *self, pg_linear_info *out) { usual ()->info (self, out); }
static void clear (void **self) { usual ()->free (self); }

const pg_linear_type pg_linear_skyline = { .name = "skyline",
                                           .summary = "another name of the usual factorisation",
                                           .symmetric = 1, .factors = 1, .analyse = analyse, .factor = factor,
                                           .solve = solve, .info = info, .free = clear };
