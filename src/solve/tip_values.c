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
static void give_front (void *context, size_t i, long *count, double *number)
{
    const pg_front_values *t = &((const pg_solver *) context)->front[i];
    const double value[9] = { t->x[0], t->x[1], t->x[2], t->J,          t->K[0],
                              t->K[1], t->K[2], t->T,    t->utilisation };
    count[0] = t->front, count[1] = (long) t->vertex;
    memcpy (number, value, sizeof value);
}

static pg_status take_front (void *context, size_t i, const long *count, const double *v, const pg_keeper *k)
{
    pg_status status = PG_OK;
    pg_solver *s = context;
    PG_KEEP_BOUND (k, "the vertex of a front", count[1], 0, (long) s->nfront);
    s->front[i] = (pg_front_values) { .front = count[0], .vertex = (size_t) count[1],
                                      .x = { v[0], v[1], v[2] }, .J = v[3], .K = { v[4], v[5], v[6] },
                                      .T = v[7], .utilisation = v[8] };
done:
    return status;
}

static pg_status keep_fronts (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    long n = (long) s->nfront;
    PG_TRY (k->counts (k->context, "solver.front_count", 1, &n));
    PG_KEEP_BOUND (k, "the number of vertices of fronts", n, 0, (long) s->problem->first_bond[PG_BOND_SETS]);
    if (k->reading) PG_GROW (s->front, s->cap_front, (size_t) n);
    s->nfront = (size_t) n;
    PG_TRY (pg_keep_records (k, &(pg_records) { .count_name = "solver.fronts",
                                                .number_name = "solver.front_values", .n = s->nfront,
                                                .counts = 2, .numbers = 9, .give = give_front,
                                                .take = take_front, .context = s }));
done:
    return status;
}

static void give_tip (void *context, size_t i, long *count, double *number)
{
    const pg_tip_values *t = &((const pg_solver *) context)->tip[i];
    const double value[9] = { t->x[0], t->x[1], t->J, t->K[0], t->K[1], t->K[2], t->T, t->uncertainty,
                              t->utilisation };
    count[0] = t->id;
    memcpy (number, value, sizeof value);
}

static pg_status take_tip (void *context, size_t i, const long *count, const double *v, const pg_keeper *k)
{
    (void) k;
    ((pg_solver *) context)->tip[i]
        = (pg_tip_values) { .id = count[0], .x = { v[0], v[1] }, .J = v[2], .K = { v[3], v[4], v[5] },
                            .T = v[6], .uncertainty = v[7], .utilisation = v[8] };
    return PG_OK;
}

pg_status solver_keep_tips (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    long n = (long) s->ntip;
    PG_TRY (k->counts (k->context, "solver.tip_count", 1, &n));
    PG_KEEP_BOUND (k, "the number of tips", n, 0, (long) s->problem->first_bond[PG_BOND_SETS]);
    if (k->reading) PG_GROW (s->tip, s->cap_tip, (size_t) n);
    s->ntip = (size_t) n;
    PG_TRY (pg_keep_records (k, &(pg_records) { .count_name = "solver.tips",
                                                .number_name = "solver.tip_values", .n = s->ntip, .counts = 1,
                                                .numbers = 9, .give = give_tip, .take = take_tip,
                                                .context = s }));
    if (s->problem->dim == 3 && s->break_loop.growth) PG_TRY (keep_fronts (s, k));
done:
    return status;
}
