/* SPDX-License-Identifier: GPL-3.0-or-later
 * Values that a solver has measured at crack tips, one entry for each, for the history of a run and its
 * report. Tips that have ended keep their last values. 3D: at the vertices of fronts, as they were in the
 * last step. */
#include "solve/run/solve.h"
#include <math.h>

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

pg_status solver_keep_tips (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    PG_KEEP_LENGTH (k, "solver", "tip_count", s->tip, s->ntip, s->cap_tip,
                    s->problem->bonds.first[PG_BOND_SETS], "the number of tips");
    pg_tip_values *t = s->tip;
    PG_TRY (pg_keep_fields (k, "solver", "tips", "tip_values", s->ntip, PG_ROWS (
        PG_EACH (t, id), PG_EACH_IN (t, vertex, 0, s->ntip, "the vertex of a front"), PG_EACH (t, x),
        PG_EACH (t, J), PG_EACH (t, K), PG_EACH (t, T), PG_EACH (t, uncertainty), PG_EACH (t, utilisation))));
done:
    return status;
}
