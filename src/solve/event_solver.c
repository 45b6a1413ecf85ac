/* SPDX-License-Identifier: GPL-3.0-or-later
 * The event solver: bases, updates after breaks, blocks of events. Algorithm: event_solver.h;
 * the dense system: event_touched.c. */
#include "event_solver_data.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

/* More touched unknowns are never worth their dense system; Green columns beyond this memory are not made. */
enum { MOST_TOUCHED = 2000 };
static const double most_memory = 1.5e9;               /* bytes of Green columns */
/* A displacement that grows this much in an event belongs to a part that has come loose: the residual of the
 * whole body decides. */
static const double loose = 1e6;
/* Share of one solve that a column costs among several right-hand sides; numbers read in a second. */
static const double column_share = 0.3, memory_rate = 1e9;

/* ---- life ---------------------------------------------------------------------------------------------- */
pg_status event_solver_create (event_solver **out, pg_system *s, int cases, const double *time)
{
    pg_status status = PG_OK;
    event_solver *e = NULL;
    *out = NULL;
    if (!s->force->spares.change || !system_has_matrix (s) || !s->direct.linear->factors) return PG_OK;
    /* Else there is one solve only. Plain runs leave out the springs of weak unknowns as well: what
     * refinement leaves of them moves mechanisms (rows of points between cracks), and the load of an event by
     * 1e-6. */
    if (cases) s->updates.serves = s->problem->criterion->type != NULL;
    if (s->options->plain) return PG_OK;
    PG_ALLOC (e, 1);
    e->columns.halves = cases == 0 && s->direct.linear->half_few;
    e->s = s, e->base.k = 1, e->cases = cases, e->ndof = s->ndof, e->nred = s->nred;
    e->why = "there is no base yet";
    PG_ALLOC (e->touched.at, e->ndof);
    PG_ALLOC (e->base.diagonal, e->ndof);
    for (int c = 0; c < cases; c++) {
        e->time[c] = time[c];
        PG_ALLOC (e->base.u[c], e->ndof);
        PG_ALLOC (e->base.constant[c], e->ndof);
    }
    *out = e, e = NULL;
done:
    event_solver_free (&e);
    return status;
}

void event_solver_free (event_solver **solver)
{
    event_solver *e = *solver;
    if (!e) return;
    touched_free (e);
    for (int c = 0; c < EVENT_CASES; c++) {
        pg_free (e->base.u[c]), pg_free (e->base.constant[c]);
        for (int k = 0; k <= EVENT_MOST; k++) pg_free (e->block.X[c][k]);
    }
    pg_free (e->base.diagonal);
    columns_free (e);
    pg_free (e);
    *solver = NULL;
}

int event_solver_has_base (const event_solver *e) { return e->base.made && !e->restored; }

void event_solver_drop (event_solver *e) { e->base.made = e->s->updates.base = 0,
    e->why = "there is no base yet"; }

void event_solver_at (event_solver *e, double first, double second)
{
    const double time[EVENT_CASES] = { first, second };
    for (int c = 0; c < e->cases; c++) {
        if (e->time[c] != time[c]) event_solver_drop (e);
        e->time[c] = time[c];
    }
}

const char *event_solver_why (const event_solver *e) { return e->why; }
double event_solver_residual (const event_solver *e) { return e->touched.residual; }

/* ---- bases --------------------------------------------------------------------------------------------- */
/* The residual of u = 0 at each load factor: what loads and prescribed values put in, N. */
static pg_status constant_forces (event_solver *e, double *const *out)
{
    pg_status status = PG_OK;
    double *zero = NULL, reference;
    PG_ALLOC (zero, e->ndof);
    for (int c = 0; c < e->cases; c++)
        PG_TRY (e->s->force->balance (e->s->self, e->time[c], zero, out[c], &reference));
done:
    pg_free (zero);
    return status;
}

/* The solution at hand becomes the one before the first event of a block. */
static pg_status remember (event_solver *e, int k)
{
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    for (int c = 0; c < e->cases; c++) {
        size_t room = e->block.X[c][k] ? e->block.tX[k] : 0;
        if (w->t > room || !e->block.X[c][k]) {
            pg_free (e->block.X[c][k]);
            e->block.X[c][k] = NULL;
            PG_ALLOC (e->block.X[c][k], w->t + 1);
        }
        if (w->t) memcpy (e->block.X[c][k], w->x[c], w->t * sizeof *w->x[c]);
    }
    e->block.tX[k] = w->t;
done:
    return status;
}

pg_status event_solver_base (event_solver *e, double *const *u, double *residual)
{
    event_base *b = &e->base;
    pg_status status = PG_OK;
    pg_system *s = e->s;
    pg_stiffness_change change;
    event_solver_drop (e), e->why = "the system is solved without a factor";
    touched_clear (e);
    int factors = s->choice.mode == SYSTEM_FACTOR || s->choice.mode == SYSTEM_KEPT_FACTOR;
    if (s->direct.stale && factors) PG_TRY (system_factorize (s, NULL));
    *residual = 0;
    for (int c = 0; c < e->cases; c++) {
        double one;
        PG_TRY (system_solve (s, e->time[c], u[c], NULL, &one));
        *residual = fmax (*residual, one);
    }
    factors = s->choice.mode == SYSTEM_FACTOR || s->choice.mode == SYSTEM_KEPT_FACTOR;
    if (!factors || s->direct.stale) goto done;
    const pg_sparse *K = pg_force_matrix (s->force, s->self);
    /* K may have gone with its factor */
    const pg_operator *op = K && K->value ? NULL : s->force->operator_ (s->self);
    if (op) op->diagonal (op->context, b->diagonal);
    for (size_t i = 0; !op && i < e->ndof; i++) b->diagonal[i] = K->value[K->start[i + 1] - 1];
    b->shift = fmax (s->direct.shift, WEAK_SPRING) * s->direct.mean_diagonal,
        b->scale = s->balance.reference > 0 ? s->balance.reference : 1;
    for (int c = 0; c < e->cases; c++) memcpy (b->u[c], u[c], e->ndof * sizeof *u[c]);
    PG_TRY (constant_forces (e, b->constant));
    PG_TRY (s->force->spares.change (s->self, &change));      /* the record begins here */
    b->made = s->updates.base = 1, e->why = "", b->factorizations = s->report->factorizations;
    e->rent = 0;
    PG_TRY (event_solver_flush (e));
done:
    return status;
}

pg_status event_solver_follow (event_solver *e, double k, double m)
{
    event_base *b = &e->base;
    pg_status status = PG_OK;
    pg_system *s = e->s;
    pg_stiffness_change change;
    event_solver_drop (e), touched_clear (e);
    const pg_sparse *K = pg_force_matrix (s->force, s->self);
    for (size_t i = 0; i < e->ndof; i++) b->diagonal[i] = k * K->value[K->start[i + 1] - 1];
    if (m != 0) system_add_mass_diagonal (s, m, b->diagonal);
    b->k = k, b->shift = 0, b->scale = 1, e->rent = e->columns.seconds = e->touched.residual = 0;
    PG_TRY (s->force->spares.change (s->self, &change));      /* the record begins here */
    b->made = s->updates.base = 1, e->why = "", b->factorizations = s->report->factorizations;
    PG_TRY (event_solver_flush (e));
done:
    return status;
}

/* ---- updates ------------------------------------------------------------------------------------------- */
/* Constant forces that follow shape functions have changed: measured anew; p on the unknowns where they
 * differ from those of the base, which become touched. *fits 0: too many. */
static pg_status change_of_forces (event_solver *e, int *fits)
{
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    double *now[EVENT_CASES] = { NULL };
    size_t *fresh = NULL, nfresh = 0;
    *fits = 1;
    PG_ALLOC (fresh, e->ndof);
    for (int c = 0; c < e->cases; c++) PG_ALLOC (now[c], e->ndof);
    PG_TRY (constant_forces (e, now));
    for (size_t i = 0; i < e->ndof; i++) {
        int differs = 0;
        for (int c = 0; c < e->cases; c++) differs |= now[c][i] != e->base.constant[c][i];
        if (differs && !w->at[i]) fresh[nfresh++] = i;
    }
    *fits = w->t + nfresh <= MOST_TOUCHED;
    if (!*fits) goto done;
    PG_TRY (touched_grow (e, nfresh, fresh));
    for (int c = 0; c < e->cases; c++)
        for (size_t i = 0; i < w->t; i++)
            w->p[c][i] = now[c][w->dof[i]] - e->base.constant[c][w->dof[i]];
done:
    for (int c = 0; c < e->cases; c++) pg_free (now[c]);
    pg_free (fresh);
    return status;
}

/* Nothing can be said of u until there is a new base. */
static pg_status lose (event_solver *e, const char *why, event_outcome *outcome)
{
    event_solver_drop (e), e->why = why;
    *outcome = EVENT_LOST;
    return PG_OK;
}

static double largest (const double *a, size_t n)
{
    double top = 0;
    for (size_t i = 0; i < n; i++) top = fmax (top, fabs (a[i]));
    return top;
}

/* Has a loaded part come loose? Its displacement knows no bounds, and all that can be said is what the
 * residual of the whole body says. */
static int runs_away (const event_solver *e)
{
    for (int c = 0; c < e->cases; c++)
        if (!(largest (e->touched.u[c], e->touched.t) <= loose * largest (e->base.u[c], e->ndof))) return 1;
    return 0;
}

/* Rent or buy: the dense algebra since the base has cost more than another assembly and factor and the
 * columns that would be needed again. */
static int base_is_due (const event_solver *e)
{
    double column = column_share * system_solve_cost (e->s),
        again = fmin ((double) e->touched.t, 80) * column;
    return e->rent > system_assembly_cost (e->s) + system_factor_cost (e->s) + again;
}

/* Room for the columns that a change may need, and a dense system that can be afforded. */
static int affordable (const event_solver *e, size_t count)
{
    size_t most = e->touched.t + count;
    return most <= MOST_TOUCHED
           && (e->columns.halves || (double) most * (double) e->ndof * sizeof (double) <= most_memory);
}

/* Takes the change of K and of forces in. *outcome stays EVENT_SOLVED where u is to be solved for. */
static pg_status take_in (event_solver *e, event_outcome *outcome)
{
    pg_status status = PG_OK;
    pg_stiffness_change change;
    int fits = 1;
    PG_TRY (e->s->force->spares.change (e->s->self, &change));
    *outcome = EVENT_SOLVED;
    if (!e->base.made) return lose (e, e->why, outcome);
    if (e->base.factorizations != e->s->report->factorizations)
        return lose (e, "the factor of the base is gone", outcome);
    if (!change.known) return lose (e, "too much has broken at once", outcome);
    if (change.basis) return lose (e, "bonds broke that carry prescribed displacements", outcome);
    if (change.n == 0 && !change.loads) *outcome = EVENT_SAME;
    else if (!affordable (e, change.n * (size_t) e->s->components))
        return lose (e, "too many unknowns are touched", outcome);
    if (*outcome == EVENT_SAME) return PG_OK;
    PG_TRY (touched_change (e, &change));
    if (change.loads) PG_TRY (change_of_forces (e, &fits));
    if (!fits) return lose (e, "loads have changed at too many unknowns", outcome);
done:
    return status;
}

pg_status event_solver_update (event_solver *e, event_outcome *outcome)
{
    pg_status status = PG_OK;
    PG_TRY (take_in (e, outcome));
    if (*outcome == EVENT_LOST) goto done;
    if (*outcome == EVENT_SOLVED) {
        if (!touched_solve (e) || runs_away (e)) {
            touched_undo (e);
            return lose (e, "the touched part of the body does not find its balance", outcome);
        }
        e->s->updates.by_columns++;
        if (base_is_due (e)) *outcome = EVENT_DUE, e->why = "the touched unknowns have become many";
    }
    if (e->block.count < EVENT_MOST) PG_TRY (remember (e, ++e->block.count));
done:
    return status;
}

pg_status event_solver_note (event_solver *e, event_outcome *outcome)
{
    pg_status status = PG_OK;
    PG_TRY (take_in (e, outcome));
    if (*outcome == EVENT_SOLVED && base_is_due (e))
        *outcome = EVENT_DUE, e->why = "the touched unknowns have become many";
done:
    return status;
}

size_t event_solver_touched (const event_solver *e) { return e->touched.t; }
double event_solver_filled (const event_solver *e) { return (double) e->touched.t / MOST_TOUCHED; }
double event_solver_spent (const event_solver *e) { return e->rent + e->columns.seconds; }

/* ---- the solution -------------------------------------------------------------------------------------- */
pg_status event_solver_watch (event_solver *e, size_t n, const int *node)
{
    green_columns *g = &e->columns;
    pg_status status = PG_OK;
    if (n == g->nwatched && (n == 0 || memcmp (node, g->watched, n * sizeof *node) == 0)) return PG_OK;
    pg_free (g->watched), g->watched = NULL, g->nwatched = g->filled = 0;
    PG_ALLOC (g->watched, n + 1);
    memcpy (g->watched, node, n * sizeof *node);
    g->nwatched = n;
done:
    return status;
}

pg_status event_solver_watched (event_solver *e, int which, double *u)
{
    green_columns *g = &e->columns;
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    size_t m = (size_t) e->s->components, size = g->nwatched * m;
    PG_TRY (columns_watch (e));
    for (size_t k = 0; k < g->nwatched; k++)
        for (size_t a = 0; a < m; a++) u[k * m + a] = e->base.u[which][(size_t) g->watched[k] * m + a];
    if (w->t && size) pg_dense_multiply (0, size, 1, w->t, 1, g->rows, size, w->x[which], w->t, 1, u, size);
done:
    return status;
}

pg_status event_solver_full (event_solver *e, int which, double *u)
{
    memcpy (u, e->base.u[which], e->ndof * sizeof *u);
    columns_times (e, 1, e->touched.x[which], u);
    e->rent += (double) e->touched.t * (double) e->ndof / memory_rate;
    return PG_OK;
}

/* The free unknowns of a full vector, in their order: rows of T with nothing but a 1. */
static void reduce (const event_solver *e, const pg_sparse *T, const double *full, double *reduced)
{
    for (size_t j = 0; j < e->nred; j++) {
        long q = T ? T->start[j] : 0;
        while (T && T->value[q] != 1) q++;
        reduced[j] = full[T ? (size_t) T->row[q] : j];
    }
}

/* y = (1 + D H)^-1 D u on the touched unknowns, from their displacements u behind y: 2 t numbers. */
static pg_status forces_of_change (event_solver *e, double *y)
{
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    double *u = y + w->t + 1;
    for (size_t i = 0; i < w->t; i++) y[i] = w->stay[i] * u[i];
    pg_dense_multiply (0, w->t, 1, w->t, 1, w->D, w->cap, u, w->cap, 1, y, w->cap);
    if (!touched_substitute (e, y)) PG_FAIL (PG_E_SINGULAR, "the system of the touched unknowns is singular");
done:
    return status;
}

/* Without Green columns: delta = A^-1 (r - W y), two solves. */
static pg_status correct_twice (event_solver *e, const double *r, double *delta)
{
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    pg_system *s = e->s;
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    double *full = NULL, *part = NULL, *y = NULL;
    PG_ALLOC (full, T ? e->ndof : 1);
    PG_ALLOC (part, e->nred);
    PG_ALLOC (y, 2 * (w->t + 1));
    PG_TRY (s->direct.linear->solve (s->direct.factor, 1, r, delta));
    if (T) pg_sparse_multiply (T, delta, full);
    for (size_t i = 0; i < w->t; i++) y[w->t + 1 + i] = T ? full[w->dof[i]] : delta[w->dof[i]];
    PG_TRY (forces_of_change (e, y));
    memcpy (part, r, e->nred * sizeof *part);
    columns_unload (e, y, part);
    PG_TRY (s->direct.linear->solve (s->direct.factor, 1, part, delta));
done:
    pg_free (full), pg_free (part), pg_free (y);
    return status;
}

/* delta = A^-1 r - A^-1 W y, (1 + D H) y = D W' A^-1 r */
pg_status event_solver_correct (event_solver *e, const double *r, double *delta)
{
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    pg_system *s = e->s;
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    double *full = NULL, *part = NULL, *y = NULL;
    if (w->t == 0) return s->direct.linear->solve (s->direct.factor, 1, r, delta);
    if (e->columns.halves) return correct_twice (e, r, delta);
    PG_ALLOC (full, e->ndof);
    PG_ALLOC (part, e->nred);
    PG_ALLOC (y, 2 * (w->t + 1));
    PG_TRY (s->direct.linear->solve (s->direct.factor, 1, r, delta));
    if (T) pg_sparse_multiply (T, delta, full);
    else memcpy (full, delta, e->ndof * sizeof *full);
    for (size_t i = 0; i < w->t; i++) y[w->t + 1 + i] = full[w->dof[i]];
    PG_TRY (forces_of_change (e, y));
    columns_times (e, 0, y, full);
    reduce (e, T, full, part);
    for (size_t j = 0; j < e->nred; j++) delta[j] -= part[j];
    e->rent += (double) w->t * (double) e->ndof / memory_rate;
done:
    pg_free (full), pg_free (part), pg_free (y);
    return status;
}

/* The solution is equilibrium up to what the base has left unbalanced, springs of weak unknowns above all:
 * that is taken out of the base itself. */
pg_status event_solver_settle (event_solver *e, int which, double enough, double *u, double *residual)
{
    pg_status status = PG_OK;
    pg_system *s = e->s;
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    double *force = NULL, *delta = NULL, reference;
    PG_ALLOC (force, e->ndof);
    PG_ALLOC (delta, e->ndof);
    PG_TRY (event_solver_full (e, which, u));
    PG_TRY (s->force->balance (s->self, e->time[which], u, force, &reference));
    if (T) pg_sparse_multiply_transposed (T, force, delta);
    else memcpy (delta, force, e->ndof * sizeof *delta);
    *residual = sqrt (pg_dot (e->nred, delta, delta)) / (reference > 0 ? reference : e->base.scale);
    if (*residual <= enough) goto done;
    memcpy (force, delta, e->nred * sizeof *delta);
    PG_TRY (event_solver_correct (e, force, delta));
    if (T) pg_sparse_multiply (T, delta, force);
    for (size_t i = 0; i < e->ndof; i++) {
        double step = T ? force[i] : delta[i];
        u[i] += step, e->base.u[which][i] += step;
    }
    touched_balance (e, which);
done:
    pg_free (force), pg_free (delta);
    return status;
}

/* ---- blocks of events ---------------------------------------------------------------------------------- */
int event_solver_count (const event_solver *e) { return e->block.count; }

pg_status event_solver_flush (event_solver *e)
{
    e->block.count = 0;
    return remember (e, 0);
}

/* One product of the Green columns with the forces of all events asked for; what was touched later has no
 * force in them. */
pg_status event_solver_block (event_solver *e, int which, int n, const int *list, double *u)
{
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    double *x = NULL;
    size_t events = (size_t) n;
    PG_ALLOC (x, events * (w->t + 1));
    for (size_t k = 0; k < events; k++)
        for (size_t i = 0; i < e->block.tX[list[k] + 1]; i++) x[k + i * events] =
            e->block.X[which][list[k] + 1][i];
    for (size_t i = 0; i < e->ndof; i++)
        for (size_t k = 0; k < events; k++) u[i * events + k] = e->base.u[which][i];
    for (size_t i = 0; i < w->t; i += CHUNK)
        pg_dense_add_product (events, e->ndof, w->t - i < CHUNK ? w->t - i : CHUNK, x + i * events,
                              green_column (e, i), u);
    e->rent += (double) events * 2 * (double) w->t * (double) e->ndof / 10e9;
done:
    pg_free (x);
    return status;
}

/* What broke since event k lives again: D is as it was, up to rounding, which the next updates correct. */
pg_status event_solver_back (event_solver *e, int k, event_outcome *outcome)
{
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    PG_TRY (take_in (e, outcome));
    if (*outcome == EVENT_LOST) goto done;
    *outcome = EVENT_SOLVED;
    for (int c = 0; c < e->cases; c++) {
        memset (w->x[c], 0, w->t * sizeof *w->x[c]);
        memcpy (w->x[c], e->block.X[c][k + 1], e->block.tX[k + 1] * sizeof *w->x[c]);
        touched_displacement (e, c);
    }
    e->block.count = k + 1;
done:
    return status;
}
