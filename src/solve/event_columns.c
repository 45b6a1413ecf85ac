/* SPDX-License-Identifier: GPL-3.0-or-later
 * Green columns: G = T A^-1 T' E, the displacement of all unknowns under a unit force on each of the touched
 * ones (E selects them), by the factor of the base. T is the elimination of supports, d = T q + g: a force
 * on a full unknown acts on the free ones through T'. Prescribed unknowns that nothing depends on have
 * columns of zeros. */
#include "event_solver_data.h"
#include <string.h>

/* Writes T' e_i of the unknowns first .. t - 1 into the right-hand sides. */
static void unit_forces (event_solver *e, size_t first, const pg_sparse *T)
{
    size_t count = e->t - first;
    memset (e->rhs, 0, count * e->nred * sizeof *e->rhs);
    if (!T) {
        for (size_t k = 0; k < count; k++) e->rhs[k * e->nred + e->dof[first + k]] = 1;
        return;
    }
    for (size_t j = 0; j < T->ncol; j++)
        for (long q = T->start[j]; q < T->start[j + 1]; q++) {
            int at = e->at[T->row[q]];
            if (at > (int) first) e->rhs[((size_t) at - 1 - first) * e->nred + j] = T->value[q];
        }
}

/* All new columns by one solve with as many right-hand sides. */
pg_status columns_make (event_solver *e, size_t first)
{
    pg_status status = PG_OK;
    pg_system *s = e->s;
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    size_t count = e->t - first;
    PG_GROW (e->G, e->room_G, e->t * e->ndof);
    PG_GROW (e->rhs, e->room_rhs, count * e->nred);
    unit_forces (e, first, T);
    if (!T) {
        PG_TRY (s->linear->solve (s->factor, count, e->rhs, e->G + first * e->ndof));
        goto done;
    }
    PG_GROW (e->solved, e->room_solved, count * e->nred);
    PG_TRY (s->linear->solve (s->factor, count, e->rhs, e->solved));
    for (size_t k = 0; k < count; k++)
        pg_sparse_multiply (T, e->solved + k * e->nred, e->G + (first + k) * e->ndof);
done:
    if (status == PG_OK) e->account.columns += (long) count;
    return status;
}
