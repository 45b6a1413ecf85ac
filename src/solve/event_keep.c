/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checkpoints of the event solver. Written are the displacements of the base, the touched unknowns in the
 * groups in which they were taken in, D, M (the order of its updates shows in its last bits) and the forces
 * of every event at hand. Green columns are made again by the factor of the base, group by group, so that
 * all numbers have the bits that they had. */
#include "event_solver_data.h"
#include <string.h>

/* A square of t columns, `cap` apart in memory and side by side in the file. */
static pg_status keep_square (event_solver *e, const char *name, double *a, const pg_keeper *k)
{
    touched_unknowns *w = &e->touched;
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
static pg_status keep_touched (event_solver *e, const pg_keeper *k)
{
    green_columns *g = &e->columns;
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    long *word = NULL, count[2] = { (long) w->t, (long) g->ngroup };
    size_t sum = 0;
    PG_TRY (k->counts (k->context, "event_solver.touched", 2, count));
    PG_KEEP_BOUND (k, "the number of touched unknowns", count[0], 0, (long) e->ndof);
    PG_KEEP_BOUND (k, "the groups of touched unknowns", count[1], 0, count[0]);
    if (k->reading) {
        touched_clear (e);
        PG_TRY (touched_reserve (e, (size_t) count[0]));
        PG_GROW (g->group, g->room_group, (size_t) count[1]);
    }
    PG_ALLOC (word, (size_t) (count[0] + count[1]) + 1);
    for (size_t i = 0; i < w->t; i++) word[i] = (long) w->dof[i];
    for (size_t i = 0; i < g->ngroup; i++) word[w->t + i] = (long) g->group[i];
    PG_TRY (k->counts (k->context, "event_solver.unknowns", (size_t) (count[0] + count[1]), word));
    for (long i = 0; i < count[0]; i++)
        PG_KEEP_BOUND (k, "a touched unknown", word[i], 0, (long) e->ndof - 1);
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

/* The forces of every event of the block, of as many unknowns as were touched then. */
static pg_status keep_block (event_solver *e, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char name[48];
    long count = e->block.count, t;
    PG_TRY (k->counts (k->context, "event_solver.events", 1, &count));
    PG_KEEP_BOUND (k, "the events of a block", count, 0, EVENT_MOST);
    e->block.count = (int) count;
    for (int i = 0; i <= e->block.count; i++) {
        t = (long) e->block.tX[i];
        snprintf (name, sizeof name, "event_solver.forces.%d", i);
        PG_TRY (k->counts (k->context, strcat (name, ".n"), 1, &t));
        PG_KEEP_BOUND (k, "the unknowns of an event", t, 0, (long) e->touched.t);
        e->block.tX[i] = (size_t) t;
        for (int c = 0; c < e->cases; c++) {
            snprintf (name, sizeof name, "event_solver.forces.%d.%d", i, c);
            if (k->reading) {
                pg_free (e->block.X[c][i]);
                e->block.X[c][i] = NULL;
                PG_ALLOC (e->block.X[c][i], e->block.tX[i] + 1);
            }
            if (t) PG_TRY (k->numbers (k->context, name, e->block.tX[i], e->block.X[c][i]));
        }
    }
done:
    return status;
}

/* Keeps, of every load case, u and constant residual at the base, and x, p, q of touched unknowns. */
static pg_status keep_cases (event_solver *e, const pg_keeper *k)
{
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    static const char *const names[3][EVENT_CASES] = {
        { "event_solver.base.0", "event_solver.base.1" },
        { "event_solver.constant.0", "event_solver.constant.1" },
        { "event_solver.x.0", "event_solver.x.1" },
    };
    static const char *const changes[EVENT_CASES] = { "event_solver.p.0", "event_solver.p.1" },
                             *const left[EVENT_CASES] = { "event_solver.q.0", "event_solver.q.1" };
    for (int c = 0; c < e->cases; c++) {
        PG_TRY (k->numbers (k->context, names[0][c], e->ndof, e->base.u[c]));
        PG_TRY (k->numbers (k->context, names[1][c], e->ndof, e->base.constant[c]));
        if (w->t) PG_TRY (k->numbers (k->context, names[2][c], w->t, w->x[c]));
        if (w->t) PG_TRY (k->numbers (k->context, changes[c], w->t, w->p[c]));
        if (w->t) PG_TRY (k->numbers (k->context, left[c], w->t, w->q[c]));
    }
done:
    return status;
}

pg_status event_solver_keep (event_solver *e, const pg_keeper *k)
{
    event_base *b = &e->base;
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    long count[1] = { b->made };
    double number[6] = { b->shift, b->scale, w->residual, e->rent, b->k, e->columns.seconds };
    PG_TRY (k->counts (k->context, "event_solver.counts", 1, count));
    PG_TRY (k->numbers (k->context, "event_solver.numbers", 6, number));
    PG_KEEP_BOUND (k, "the base of events", count[0], 0, 1);
    b->shift = number[0], b->scale = number[1], w->residual = number[2], e->rent = number[3],
        b->k = number[4], e->columns.seconds = number[5];
    if (k->reading) b->made = (int) count[0], e->s->updates.base |= b->made;
    if (!b->made) goto done;
    PG_TRY (k->numbers (k->context, "event_solver.diagonal", e->ndof, b->diagonal));
    PG_TRY (keep_touched (e, k));
    PG_TRY (keep_cases (e, k));
    if (w->t) {
        PG_TRY (keep_square (e, "event_solver.D", w->D, k));
        PG_TRY (keep_square (e, "event_solver.M", w->M, k));
        PG_TRY (k->numbers (k->context, "event_solver.stay", w->t, w->stay));
    }
    PG_TRY (keep_block (e, k));
    if (k->reading) e->restored = 1;
done:
    return status;
}

/* Green columns in their old groups; the record of changes of the force begins anew. */
pg_status event_solver_restore (event_solver *e)
{
    green_columns *g = &e->columns;
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    pg_stiffness_change change;
    size_t all = w->t;
    double green = g->seconds;                           /* columns made again count no second time */
    if (!e->restored) return PG_OK;
    e->restored = 0;
    if (!e->base.made) return PG_OK;
    for (size_t k = 0, first = 0; k < g->ngroup; first += g->group[k++]) {
        w->t = first + g->group[k];
        PG_TRY (touched_green (e, first));
    }
    w->t = all, w->factored = 0, g->seconds = green;
    for (int c = 0; c < e->cases; c++) touched_displacement (e, c);
    e->base.factorizations = e->s->report->factorizations;
    PG_TRY (e->s->force->spares.change (e->s->self, &change));
done:
    return status;
}
