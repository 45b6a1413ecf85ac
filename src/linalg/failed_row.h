/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: how Cholesky factorisations tell pg_linear_failed_row which unknown had no positive pivot. */
#ifndef PG_LINALG_FAILED_ROW_H
#define PG_LINALG_FAILED_ROW_H
/* Records the unknown at which a factorisation on this thread has failed; defined in catalogue.c. */
void linear_failed_at (long row);
#endif
