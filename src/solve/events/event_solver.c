/* SPDX-License-Identifier: GPL-3.0-or-later
 * The event solver: bases, the dense system of forces on the touched unknowns, updates after breaks, blocks
 * of events. With A u = f - W D u_T + W p and u = u_b + G x the forces x follow from
 *
 *     (1 + D H) dx = r,    r = p - x - D u_T,    u_T = (u_b)_T + H x,
 *
 * solved by the LU factors of the inverse and refined by its own residual, which is without springs. */
#include "event_solver.h"
#include "perigal/vector.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A displacement that grows by this factor in an event is that of a part that has come loose: then the
 * residual of the whole body decides. */
static const double loose = 1e6;
/* Numbers read from memory in a second. */
static const double memory_rate = 1e9;
enum { MOST_ROUNDS = 4 };
/* residual over the reference force: aimed at; accepted */
static const double fine = 1e-13, bearable = 1e-10;

/* ---- life ---------------------------------------------------------------------------------------------- */
pg_status event_solver_create (event_solver **out, pg_system *s, int cases, const double *time)
{
    pg_status status = PG_OK;
    event_solver *e = NULL;
    *out = NULL;
    if (!s->force->spares.change || !system_can_factor (s)) return PG_OK;
    /* Otherwise there is one solve only. Plain runs leave out the springs of weak unknowns as well, whose
     * effect after refinement moves mechanisms (rows of points between cracks), and the load of an event by
     * 1e-6. */
    s->updates.serves = s->problem->criterion->type != NULL;
    if (s->options->plain) return PG_OK;
    PG_ALLOC (e, 1);
    e->cases = cases;
    PG_TRY (inverse_create (&e->inverse, s, INVERSE_COLUMNS));
    for (int c = 0; c < cases; c++) {
        e->of[c].time = time[c];
        PG_ALLOC (e->of[c].base, s->ndof);
        PG_ALLOC (e->of[c].constant, s->ndof);
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
    for (int c = 0; c < EVENT_CASES; c++) {
        event_case *o = &e->of[c];
        pg_free (o->base), pg_free (o->constant), pg_free (o->x), pg_free (o->p), pg_free (o->q);
        pg_free (o->old), pg_free (o->u);
        for (int k = 0; k <= EVENT_MOST; k++) pg_free (o->X[k]);
    }
    inverse_free (&e->inverse);
    pg_free (e->r), pg_free (e->watched), pg_free (e->rows);
    pg_free (e);
    *solver = NULL;
}

int event_solver_has_base (const event_solver *e) { return inverse_has_base (e->inverse); }
void event_solver_drop (event_solver *e) { inverse_forget (e->inverse); }

void event_solver_at (event_solver *e, double first, double second)
{
    const double time[EVENT_CASES] = { first, second };
    for (int c = 0; c < e->cases; c++) {
        if (e->of[c].time != time[c]) event_solver_drop (e);
        e->of[c].time = time[c];
    }
}

/* ---- bases --------------------------------------------------------------------------------------------- */
/* out[c] = residual of u = 0 at the load factor of case c: loads and prescribed values, N (ndof). */
static pg_status constant_forces (event_solver *e, double *const *out)
{
    pg_status status = PG_OK;
    pg_system *s = e->inverse->s;
    double *zero = NULL, reference;
    PG_ALLOC (zero, s->ndof);
    for (int c = 0; c < e->cases; c++)
        PG_TRY (s->force->balance (s->self, e->of[c].time, zero, out[c], &reference));
done:
    pg_free (zero);
    return status;
}

/* Stores the present solution as that of event k of the block. */
static pg_status remember (event_solver *e, int k)
{
    pg_status status = PG_OK;
    size_t t = e->inverse->touched.t;
    for (int c = 0; c < e->cases; c++) {
        event_case *o = &e->of[c];
        size_t room = o->X[k] ? e->tX[k] : 0;
        if (t > room || !o->X[k]) {
            pg_free (o->X[k]);
            o->X[k] = NULL;
            PG_ALLOC (o->X[k], t + 1);
        }
        if (t) memcpy (o->X[k], o->x, t * sizeof *o->x);
    }
    e->tX[k] = t;
done:
    return status;
}

pg_status event_solver_base (event_solver *e, double *const *u, double *residual)
{
    pg_status status = PG_OK;
    inverse *v = e->inverse;
    pg_system *s = v->s;
    double *constant[EVENT_CASES] = { e->of[0].constant, e->of[1].constant };
    inverse_forget (v);
    if (s->direct.stale && system_factors (s)) PG_TRY (system_factorize (s, NULL));
    *residual = 0;
    for (int c = 0; c < e->cases; c++) {
        double one;
        PG_TRY (system_solve (s, e->of[c].time, u[c], NULL, &one));
        *residual = fmax (*residual, one);
    }
    if (!system_factors (s) || s->direct.stale) goto done;
    e->scale = s->balance.reference > 0 ? s->balance.reference : 1;
    for (int c = 0; c < e->cases; c++) memcpy (e->of[c].base, u[c], s->ndof * sizeof *u[c]);
    PG_TRY (constant_forces (e, constant));
    PG_TRY (inverse_renew (v, 1, 0, fmax (s->direct.shift, WEAK_SPRING) * s->direct.mean_diagonal));
    e->filled = 0;
    PG_TRY (event_solver_flush (e));
done:
    return status;
}

/* ---- forces on the touched unknowns -------------------------------------------------------------------- */
/* Makes the vectors of touched unknowns as long as those of the inverse. */
static pg_status make_room (event_solver *e)
{
    pg_status status = PG_OK;
    size_t cap = e->inverse->touched.cap;
    for (int c = 0; c < e->cases && e->room < cap; c++) {
        event_case *o = &e->of[c];
        double **const all[] = { &o->x, &o->p, &o->q, &o->old, &o->u, &e->r };
        for (size_t k = 0, room; k < sizeof all / sizeof *all; k++) {
            room = e->room;
            PG_GROW (*all[k], room, cap);
        }
    }
    e->room = cap > e->room ? cap : e->room;
done:
    return status;
}

/* Adds the touched unknowns from `first` on: no force acts on them, and their displacement stays. */
static pg_status extend (event_solver *e, size_t first)
{
    const touched_unknowns *w = &e->inverse->touched;
    pg_status status = PG_OK;
    PG_TRY (make_room (e));
    for (int c = 0; c < e->cases; c++)
        for (size_t i = first; i < w->t; i++) {
            event_case *o = &e->of[c];
            double sum = 0;
            for (size_t j = 0; j < first; j++) sum += w->H[j + i * w->cap] * o->x[j];
            o->x[i] = o->p[i] = o->q[i] = o->old[i] = 0, o->u[i] = o->base[w->dof[i]] + sum;
        }
done:
    return status;
}

/* u = displacement of the touched unknowns by the forces x. */
static void displace (event_solver *e, event_case *o)
{
    const touched_unknowns *w = &e->inverse->touched;
    for (size_t i = 0; i < w->t; i++) o->u[i] = o->base[w->dof[i]];
    inverse_add_H (e->inverse, o->x, o->u);
}

/* r = p + q - x - D u_T; its Euclidean norm over the reference force. */
static double unbalanced (event_solver *e, const event_case *o, double *r)
{
    size_t t = e->inverse->touched.t;
    double sum = 0;
    for (size_t i = 0; i < t; i++) r[i] = o->p[i] + o->q[i] - o->x[i];
    inverse_add_D (e->inverse, -1, o->u, r);
    for (size_t i = 0; i < t; i++) sum += r[i] * r[i];
    return sqrt (sum) / e->scale;
}

/* Solves one case until the residual is rounding or no longer falls by half; returns 0 where the system is
 * singular or the residual stays. */
static int solve_case (event_solver *e, event_case *o)
{
    inverse *v = e->inverse;
    size_t t = v->touched.t;
    double last = INFINITY, now = unbalanced (e, o, e->r);
    for (int k = 0; k < MOST_ROUNDS && now > fine && now < 0.5 * last; k++) {
        if (!inverse_substitute (v, 1, e->r)) return 0;
        for (size_t i = 0; i < t; i++) o->x[i] += e->r[i];
        displace (e, o);
        last = now, now = unbalanced (e, o, e->r);
    }
    v->rent += 3 * 8.0 * (double) t * (double) t / 8e9;
    e->residual = fmax (e->residual, now);
    return isfinite (now) && now <= bearable;
}

/* Solves all cases: x += dx, and u; returns 0 where the system is singular or its residual stays. */
static int solve_all (event_solver *e)
{
    size_t t = e->inverse->touched.t;
    e->residual = 0;
    for (int c = 0; c < e->cases && t; c++) memcpy (e->of[c].old, e->of[c].x, t * sizeof *e->r);
    for (int c = 0; c < e->cases; c++) if (!solve_case (e, &e->of[c])) return 0;
    return 1;
}

/* Restores x and u as before solve_all. */
static void undo (event_solver *e)
{
    size_t t = e->inverse->touched.t;
    for (int c = 0; c < e->cases && t; c++) {
        memcpy (e->of[c].x, e->of[c].old, t * sizeof *e->r);
        displace (e, &e->of[c]);
    }
}

/* ---- updates ------------------------------------------------------------------------------------------- */
/* Measures constant forces again that have changed with shape functions: p on the unknowns where they differ
 * from those of the base, which become touched. *fits 0: too many. */
static pg_status change_of_forces (event_solver *e, int *fits)
{
    pg_status status = PG_OK;
    inverse *v = e->inverse;
    const touched_unknowns *w = &v->touched;
    double *now[EVENT_CASES] = { NULL };
    size_t *fresh = NULL, nfresh = 0, first = w->t, ndof = v->s->ndof;
    *fits = 1;
    PG_ALLOC (fresh, ndof);
    for (int c = 0; c < e->cases; c++) PG_ALLOC (now[c], ndof);
    PG_TRY (constant_forces (e, now));
    for (size_t i = 0; i < ndof; i++) {
        int differs = 0;
        for (int c = 0; c < e->cases; c++) differs |= now[c][i] != e->of[c].constant[i];
        if (differs && !w->at[i]) fresh[nfresh++] = i;
    }
    *fits = inverse_has_room (v, nfresh);
    if (!*fits) goto done;
    PG_TRY (inverse_grow (v, nfresh, fresh));
    PG_TRY (extend (e, first));
    for (int c = 0; c < e->cases; c++)
        for (size_t i = 0; i < w->t; i++)
            e->of[c].p[i] = now[c][w->dof[i]] - e->of[c].constant[w->dof[i]];
done:
    for (int c = 0; c < e->cases; c++) pg_free (now[c]);
    pg_free (fresh);
    return status;
}

static double largest (const double *a, size_t n)
{
    double top = 0;
    for (size_t i = 0; i < n; i++) top = fmax (top, fabs (a[i]));
    return top;
}

/* 1: a loaded part has come loose: its displacement is unbounded, and only the residual of the whole body
 * tells. */
static int runs_away (const event_solver *e)
{
    const inverse *v = e->inverse;
    for (int c = 0; c < e->cases; c++)
        if (!(largest (e->of[c].u, v->touched.t) <= loose * largest (e->of[c].base, v->s->ndof))) return 1;
    return 0;
}

/* Takes in the change of K and of forces. INVERSE_LOST: u is not known until there is a new base. */
static pg_status take_in (event_solver *e, inverse_outcome *outcome)
{
    pg_status status = PG_OK;
    inverse *v = e->inverse;
    size_t first = v->touched.t;
    int fits = 1;
    PG_TRY (inverse_take (v, outcome));
    if (*outcome != INVERSE_TAKEN) goto done;
    PG_TRY (extend (e, first));
    if (v->loads) PG_TRY (change_of_forces (e, &fits));
    if (!fits) inverse_forget (v), *outcome = INVERSE_LOST;
done:
    return status;
}

pg_status event_solver_update (event_solver *e, inverse_outcome *outcome)
{
    pg_status status = PG_OK;
    PG_TRY (take_in (e, outcome));
    if (*outcome == INVERSE_TAKEN && (!solve_all (e) || runs_away (e))) {
        undo (e);
        inverse_forget (e->inverse), *outcome = INVERSE_LOST;
    }
    if (*outcome == INVERSE_LOST) goto done;
    if (*outcome == INVERSE_TAKEN) {
        e->inverse->s->updates.by_columns++;
        if (inverse_is_due (e->inverse)) *outcome = INVERSE_DUE;
    }
    if (e->count < EVENT_MOST) PG_TRY (remember (e, ++e->count));
done:
    return status;
}

/* ---- the solution -------------------------------------------------------------------------------------- */
pg_status event_solver_watch (event_solver *e, size_t n, const int *node)
{
    pg_status status = PG_OK;
    if (n == e->nwatched && (n == 0 || memcmp (node, e->watched, n * sizeof *node) == 0)) return PG_OK;
    pg_free (e->watched), e->watched = NULL, e->nwatched = e->filled = 0;
    PG_ALLOC (e->watched, n + 1);
    memcpy (e->watched, node, n * sizeof *node);
    e->nwatched = n;
done:
    return status;
}

/* Gathers the rows of the watched nodes from new columns of G, once, as full columns are far apart in
 * memory. */
static pg_status gather_rows (event_solver *e)
{
    pg_status status = PG_OK;
    const inverse *v = e->inverse;
    size_t m = (size_t) v->s->components, size = e->nwatched * m;
    PG_GROW (e->rows, e->room_rows, size * v->touched.t);
    for (; e->filled < v->touched.t; e->filled++) {
        const double *G = green_column (v, e->filled);
        double *to = e->rows + e->filled * size;
        for (size_t k = 0; k < e->nwatched; k++)
            for (size_t a = 0; a < m; a++) to[k * m + a] = G[(size_t) e->watched[k] * m + a];
    }
done:
    return status;
}

pg_status event_solver_watched (event_solver *e, int which, double *u)
{
    pg_status status = PG_OK;
    const event_case *o = &e->of[which];
    size_t m = (size_t) e->inverse->s->components, size = e->nwatched * m, t = e->inverse->touched.t;
    PG_TRY (gather_rows (e));
    for (size_t k = 0; k < e->nwatched; k++)
        for (size_t a = 0; a < m; a++) u[k * m + a] = o->base[(size_t) e->watched[k] * m + a];
    if (t && size) pg_dense_multiply (0, size, 1, t, 1, e->rows, size, o->x, t, 1, u, size);
done:
    return status;
}

pg_status event_solver_full (event_solver *e, int which, double *u)
{
    inverse *v = e->inverse;
    memcpy (u, e->of[which].base, v->s->ndof * sizeof *u);
    columns_times (v, 1, e->of[which].x, u);
    v->rent += (double) v->touched.t * (double) v->s->ndof / memory_rate;
    return PG_OK;
}

/* Corrects the base for what it has left unbalanced, mainly by springs of weak unknowns, up to which the
 * solution is an equilibrium; q is set so that the present solution is balanced. */
pg_status event_solver_settle (event_solver *e, int which, double enough, double *u, double *residual)
{
    pg_status status = PG_OK;
    inverse *v = e->inverse;
    pg_system *s = v->s;
    event_case *o = &e->of[which];
    double *force = NULL, *delta = NULL, reference;
    PG_ALLOC (force, s->ndof);
    PG_ALLOC (delta, s->ndof);
    PG_TRY (event_solver_full (e, which, u));
    PG_TRY (s->force->balance (s->self, o->time, u, force, &reference));
    system_reduce (s, force, delta);
    *residual = sqrt (pg_dot (s->nred, delta, delta)) / (reference > 0 ? reference : e->scale);
    if (*residual <= enough) goto done;
    memcpy (force, delta, s->nred * sizeof *delta);
    PG_TRY (inverse_solve (v, force, delta));
    system_expand (s, delta, force);
    for (size_t i = 0; i < s->ndof; i++) {
        double step = force[i];
        u[i] += step, o->base[i] += step;
    }
    displace (e, o);
    for (size_t i = 0; i < v->touched.t; i++) o->q[i] = o->x[i] - o->p[i];
    inverse_add_D (v, 1, o->u, o->q);
done:
    pg_free (force), pg_free (delta);
    return status;
}

/* ---- blocks of events ---------------------------------------------------------------------------------- */
pg_status event_solver_flush (event_solver *e)
{
    e->count = 0;
    return remember (e, 0);
}

/* One product of the Green columns with the forces of all events asked for; unknowns touched later have no
 * force in them. */
pg_status event_solver_block (event_solver *e, int which, int n, const int *list, double *u)
{
    pg_status status = PG_OK;
    inverse *v = e->inverse;
    const event_case *o = &e->of[which];
    double *x = NULL;
    size_t events = (size_t) n, t = v->touched.t, ndof = v->s->ndof;
    PG_ALLOC (x, events * (t + 1));
    for (size_t k = 0; k < events; k++)
        for (size_t i = 0; i < e->tX[list[k] + 1]; i++) x[k + i * events] = o->X[list[k] + 1][i];
    for (size_t i = 0; i < ndof; i++)
        for (size_t k = 0; k < events; k++) u[i * events + k] = o->base[i];
    for (size_t i = 0; i < t; i += CHUNK)
        pg_dense_add_product (events, ndof, t - i < CHUNK ? t - i : CHUNK, x + i * events,
                              green_column (v, i), u);
    v->rent += (double) events * 2 * (double) t * (double) ndof / 10e9;
done:
    pg_free (x);
    return status;
}

/* Goes back to event k; bonds broken since are intact again: D is as it was, up to rounding, which the next
 * updates correct. */
pg_status event_solver_back (event_solver *e, int k, inverse_outcome *outcome)
{
    pg_status status = PG_OK;
    PG_TRY (take_in (e, outcome));
    if (*outcome == INVERSE_LOST) goto done;
    *outcome = INVERSE_TAKEN;
    for (int c = 0; c < e->cases; c++) {
        event_case *o = &e->of[c];
        memset (o->x, 0, e->inverse->touched.t * sizeof *o->x);
        memcpy (o->x, o->X[k + 1], e->tX[k + 1] * sizeof *o->x);
        displace (e, o);
    }
    e->count = k + 1;
done:
    return status;
}

/* ---- checkpoints --------------------------------------------------------------------------------------- */
/* Keeps u_b and the constant residual at the base, x, p and q of every load case. */
static pg_status keep_cases (event_solver *e, const pg_keeper *k)
{
    pg_status status = PG_OK;
    size_t ndof = e->inverse->s->ndof, t = e->inverse->touched.t;
    if (k->reading) PG_TRY (make_room (e));
    for (int c = 0; c < e->cases; c++) {
        event_case *o = &e->of[c];
        const struct { const char *name; size_t n; double *value; } of_case[5] = {
            { "base", ndof, o->base }, { "constant", ndof, o->constant }, { "x", t, o->x }, { "p", t, o->p },
            { "q", t, o->q } };
        for (int i = 0; i < 5; i++) {
            char name[32];
            snprintf (name, sizeof name, "%s.%d", of_case[i].name, c);
            if (of_case[i].n)
                PG_TRY (pg_keep_numbers (k, "event_solver", name, of_case[i].n, of_case[i].value));
        }
    }
done:
    return status;
}

/* Keeps the forces of every event of the block, on the unknowns that were touched then. */
static pg_status keep_block (event_solver *e, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char name[48];
    PG_TRY (pg_keep_fields (k, "event_solver", "events", NULL, 1, PG_ROWS (
        PG_KEPT_IN (e->count, 0, EVENT_MOST, "the events of a block"))));
    for (int i = 0; i <= e->count; i++) {
        snprintf (name, sizeof name, "forces.%d.n", i);
        PG_TRY (pg_keep_fields (k, "event_solver", name, NULL, 1, PG_ROWS (
            PG_KEPT_IN (e->tX[i], 0, e->inverse->touched.t, "the unknowns of an event"))));
        for (int c = 0; c < e->cases; c++) {
            double **X = &e->of[c].X[i];
            snprintf (name, sizeof name, "forces.%d.%d", i, c);
            if (k->reading) {
                pg_free (*X);
                *X = NULL;
                PG_ALLOC (*X, e->tX[i] + 1);
            }
            if (e->tX[i]) PG_TRY (pg_keep_numbers (k, "event_solver", name, e->tX[i], *X));
        }
    }
done:
    return status;
}

pg_status event_solver_keep (event_solver *e, const pg_keeper *k)
{
    pg_status status = PG_OK;
    PG_TRY (inverse_keep (e->inverse, k));
    PG_TRY (pg_keep_fields (k, "event_solver", NULL, "numbers", 1, PG_ROWS (
        PG_KEPT (e->scale), PG_KEPT (e->residual))));
    if (k->reading) e->filled = 0;
    if (!e->inverse->base.made) goto done;
    PG_TRY (keep_cases (e, k));
    PG_TRY (keep_block (e, k));
done:
    return status;
}

pg_status event_solver_restore (event_solver *e)
{
    pg_status status = PG_OK;
    if (!e->inverse->restored) return PG_OK;
    PG_TRY (inverse_restore (e->inverse));
    for (int c = 0; c < e->cases; c++) displace (e, &e->of[c]);
done:
    return status;
}
