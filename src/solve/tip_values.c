/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a solver has measured at the tips of cracks, one entry for each, for the history of a run and its
 * report. Tips that have ended keep their last values. In space: at the vertices of fronts, as they were in
 * the last step. */
#include "solve.h"
#include <string.h>

static pg_tip_values *find (const pg_solver *s, long id)
{
    for (size_t i = 0; i < s->ntip; i++) if (s->tip[i].id == id) return &s->tip[i];
    return NULL;
}

const pg_tip_values *pg_solver_tip (const pg_solver *s, long id) { return find (s, id); }

pg_status solver_note_tip (pg_solver *s, const pg_tip_values *values)
{
    pg_status status = PG_OK;
    pg_tip_values *at = find (s, values->id);
    if (!at) {
        PG_GROW (s->tip, s->cap_tip, s->ntip + 1);
        at = &s->tip[s->ntip++];
    }
    *at = *values;
done:
    return status;
}

const pg_front_values *pg_solver_fronts (const pg_solver *s, size_t *n)
{
    *n = s->nfront;
    return s->front;
}

/* Vertices of fronts: two whole numbers and nine numbers each. */
static pg_status keep_fronts (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    enum { NUMBERS = 9 };
    long n = (long) s->nfront, *id = NULL;
    double *number = NULL;
    PG_TRY (k->counts (k->context, "solver.front_count", 1, &n));
    PG_KEEP_BOUND (k, "the number of vertices of fronts", n, 0, (long) s->problem->first_bond[PG_BOND_SETS]);
    if (k->reading) PG_GROW (s->front, s->cap_front, (size_t) n);
    PG_ALLOC (id, 2 * (size_t) n + 1);
    PG_ALLOC (number, NUMBERS * (size_t) n + 1);
    for (long i = 0; !k->reading && i < n; i++) {
        const pg_front_values *t = &s->front[i];
        const double value[NUMBERS] = { t->x[0], t->x[1], t->x[2], t->J, t->K[0],
                                        t->K[1], t->K[2], t->T, t->utilisation };
        id[2*i] = t->front, id[2*i + 1] = (long) t->vertex;
        memcpy (number + NUMBERS * i, value, sizeof value);
    }
    PG_TRY (k->counts (k->context, "solver.fronts", 2 * (size_t) n, id));
    PG_TRY (k->numbers (k->context, "solver.front_values", NUMBERS * (size_t) n, number));
    for (long i = 0; k->reading && i < n; i++) {
        const double *v = number + NUMBERS * i;
        PG_KEEP_BOUND (k, "the vertex of a front", id[2*i + 1], 0, n);
        s->front[i] = (pg_front_values) { .front = id[2*i], .vertex = (size_t) id[2*i + 1],
                                          .x = { v[0], v[1], v[2] }, .J = v[3], .K = { v[4], v[5], v[6] },
                                          .T = v[7], .utilisation = v[8] };
    }
    s->nfront = (size_t) n;
done:
    pg_free (id), pg_free (number);
    return status;
}

/* Numbers by themselves: the struct may have gaps. */
pg_status solver_keep_tips (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    enum { NUMBERS = 9 };
    long n = (long) s->ntip, *id = NULL;
    double *number = NULL;
    PG_TRY (k->counts (k->context, "solver.tip_count", 1, &n));
    PG_KEEP_BOUND (k, "the number of tips", n, 0, (long) s->problem->first_bond[PG_BOND_SETS]);
    if (k->reading) PG_GROW (s->tip, s->cap_tip, (size_t) n);
    PG_ALLOC (id, (size_t) n + 1);
    PG_ALLOC (number, NUMBERS * (size_t) n + 1);
    for (long i = 0; !k->reading && i < n; i++) {
        const pg_tip_values *t = &s->tip[i];
        const double value[NUMBERS] = { t->x[0], t->x[1], t->J, t->K[0], t->K[1],
                                        t->K[2], t->T, t->uncertainty, t->utilisation };
        id[i] = t->id;
        for (int m = 0; m < NUMBERS; m++) number[NUMBERS * i + m] = value[m];
    }
    PG_TRY (k->counts (k->context, "solver.tips", (size_t) n, id));
    PG_TRY (k->numbers (k->context, "solver.tip_values", NUMBERS * (size_t) n, number));
    for (long i = 0; k->reading && i < n; i++) {
        const double *v = number + NUMBERS * i;
        s->tip[i] = (pg_tip_values) { .id = id[i], .x = { v[0], v[1] }, .J = v[2], .K = { v[3], v[4], v[5] },
                                      .T = v[6], .uncertainty = v[7], .utilisation = v[8] };
    }
    s->ntip = (size_t) n;
    if (s->problem->dim == 3 && s->break_loop.growth) PG_TRY (keep_fronts (s, k));
done:
    pg_free (id), pg_free (number);
    return status;
}
