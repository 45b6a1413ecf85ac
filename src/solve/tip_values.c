/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a solver has measured at the tips of cracks, one entry for each, for the history of a run and its
 * report. Tips that have ended keep their last values. In space: at the vertices of fronts, as they were in
 * the last step. */
#include "solve.h"
#include <math.h>
#include <string.h>

pg_tip_values pg_tip_values_of (long id, size_t vertex, const double *x, const pg_tip_field *f, int nfield,
                                const double *l)
{
    pg_tip_values v = { .id = id, .vertex = vertex, .x = { x[0], x[1], x[2] }, .J = NAN, .T = NAN,
                        .K = { NAN, NAN, NAN }, .uncertainty = NAN, .utilisation = NAN };
    if (!f || isnan (f->near)) return v;
    pg_tip_combine (f, nfield, l, &v.J, NULL, &v.T);
    pg_tip_intensities (f, nfield, l, v.K);
    v.uncertainty = pg_tip_uncertainty (f, nfield, l);
    return v;
}

static pg_tip_values *find (const pg_solver *s, long id, size_t vertex)
{
    for (size_t i = 0; i < s->ntip; i++)
        if (s->tip[i].id == id && s->tip[i].vertex == vertex) return &s->tip[i];
    return NULL;
}

const pg_tip_values *pg_solver_tip (const pg_solver *s, long id) { return find (s, id, 0); }

pg_status solver_note_tip (pg_solver *s, const pg_tip_values *values)
{
    pg_status status = PG_OK;
    pg_tip_values *at = find (s, values->id, values->vertex);
    if (!at) {
        PG_GROW (s->tip, s->cap_tip, s->ntip + 1);
        at = &s->tip[s->ntip++];
    }
    *at = *values;
done:
    return status;
}

const pg_tip_values *pg_solver_tips (const pg_solver *s, size_t *n)
{
    *n = s->ntip;
    return s->tip;
}

/* Two whole numbers and ten numbers each, which follow each other. */
enum { COUNTS = 2, NUMBERS = 10 };

static void give_tip (void *context, size_t i, long *count, double *number)
{
    const pg_tip_values *t = &((const pg_solver *) context)->tip[i];
    count[0] = t->id, count[1] = (long) t->vertex;
    memcpy (number, t->x, NUMBERS * sizeof *number);
}

static pg_status take_tip (void *context, size_t i, const long *count, const double *number,
                           const pg_keeper *k)
{
    pg_status status = PG_OK;
    pg_solver *s = context;
    PG_KEEP_BOUND (k, "the vertex of a front", count[1], 0, (long) s->ntip);
    s->tip[i].id = count[0], s->tip[i].vertex = (size_t) count[1];
    memcpy (s->tip[i].x, number, NUMBERS * sizeof *number);
done:
    return status;
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
                                                .number_name = "solver.tip_values", .n = s->ntip,
                                                .counts = COUNTS, .numbers = NUMBERS, .give = give_tip,
                                                .take = take_tip, .context = s }));
done:
    return status;
}
