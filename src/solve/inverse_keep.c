/* SPDX-License-Identifier: GPL-3.0-or-later
 * The inverse of a matrix that changes, in checkpoints. Written are the touched unknowns in the groups in
 * which they were taken in, D, and M, as the order of its updates shows in its last bits. Green columns are
 * made again by the factor of the base, group by group, so that all numbers have the bits that they had. */
#include "inverse.h"
#include <string.h>

/* A square of t columns, `cap` apart in memory and side by side in the file. */
static pg_status keep_square (inverse *v, const char *name, double *a, const pg_keeper *k)
{
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    double *packed = NULL;
    PG_ALLOC (packed, w->t * w->t + 1);
    for (size_t j = 0; j < w->t; j++) memcpy (packed + j * w->t, a + j * w->cap, w->t * sizeof *a);
    PG_TRY (k->numbers (k->context, name, w->t * w->t, packed));
    for (size_t j = 0; j < w->t; j++) memcpy (a + j * w->cap, packed + j * w->t, w->t * sizeof *a);
done:
    pg_free (packed);
    return status;
}

/* The touched unknowns and how they came: numbers that are no unknowns are refused before they are used. */
static pg_status keep_touched (inverse *v, const pg_keeper *k)
{
    green_columns *g = &v->columns;
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    long *word = NULL, count[2] = { (long) w->t, (long) g->ngroup };
    size_t sum = 0;
    PG_TRY (k->counts (k->context, "inverse.touched", 2, count));
    PG_KEEP_BOUND (k, "the number of touched unknowns", count[0], 0, (long) v->s->ndof);
    PG_KEEP_BOUND (k, "the groups of touched unknowns", count[1], 0, count[0]);
    if (k->reading) {
        touched_clear (v);
        PG_TRY (touched_reserve (v, (size_t) count[0]));
        PG_GROW (g->group, g->room_group, (size_t) count[1]);
    }
    PG_ALLOC (word, (size_t) (count[0] + count[1]) + 1);
    for (size_t i = 0; i < w->t; i++) word[i] = (long) w->dof[i];
    for (size_t i = 0; i < g->ngroup; i++) word[w->t + i] = (long) g->group[i];
    PG_TRY (k->counts (k->context, "inverse.unknowns", (size_t) (count[0] + count[1]), word));
    for (long i = 0; i < count[0]; i++)
        PG_KEEP_BOUND (k, "a touched unknown", word[i], 0, (long) v->s->ndof - 1);
    for (long i = 0; i < count[1]; i++) {
        PG_KEEP_BOUND (k, "a group of touched unknowns", word[count[0] + i], 1, count[0]);
        sum += (size_t) word[count[0] + i];
    }
    PG_KEEP_BOUND (k, "the sum of the groups", (long) sum, count[0], count[0]);
    w->t = (size_t) count[0], g->ngroup = (size_t) count[1];
    for (size_t i = 0; i < w->t; i++) w->dof[i] = (size_t) word[i], w->at[word[i]] = (int) i + 1;
    for (size_t i = 0; i < g->ngroup; i++) g->group[i] = (size_t) word[w->t + i];
done:
    pg_free (word);
    return status;
}

pg_status inverse_keep (inverse *v, const pg_keeper *k)
{
    inverse_base *b = &v->base;
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    long count[1] = { b->made };
    double number[4] = { b->spring, v->rent, b->k, v->columns.seconds };
    PG_TRY (k->counts (k->context, "inverse.counts", 1, count));
    PG_TRY (k->numbers (k->context, "inverse.numbers", 4, number));
    PG_KEEP_BOUND (k, "the base of events", count[0], 0, 1);
    b->spring = number[0], v->rent = number[1], b->k = number[2], v->columns.seconds = number[3];
    if (k->reading) b->made = (int) count[0], v->s->updates.base |= b->made;
    if (!b->made) goto done;
    PG_TRY (k->numbers (k->context, "inverse.diagonal", v->s->ndof, b->diagonal));
    PG_TRY (keep_touched (v, k));
    if (w->t) {
        PG_TRY (keep_square (v, "inverse.D", w->D, k));
        PG_TRY (keep_square (v, "inverse.M", w->M, k));
        PG_TRY (k->numbers (k->context, "inverse.stay", w->t, w->stay));
    }
    if (k->reading) v->restored = 1;
done:
    return status;
}

/* Green columns in their old groups; the record of changes of the force begins anew. */
pg_status inverse_restore (inverse *v)
{
    green_columns *g = &v->columns;
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    pg_stiffness_change change;
    size_t all = w->t;
    double green = g->seconds;                           /* columns made again count no second time */
    if (!v->restored) return PG_OK;
    v->restored = 0;
    if (!v->base.made) return PG_OK;
    for (size_t k = 0, first = 0; k < g->ngroup; first += g->group[k++]) {
        w->t = first + g->group[k];
        PG_TRY (columns_make (v, first));
    }
    w->t = all, w->factored = 0, g->seconds = green;
    v->base.factorizations = v->s->report->factorizations;
    PG_TRY (v->s->force->spares.change (v->s->self, &change));
done:
    return status;
}
