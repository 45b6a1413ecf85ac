/* SPDX-License-Identifier: GPL-3.0-or-later
 * What explicit dynamics and dynamic relaxation have in common: supports, loads, forces with breaking, rows
 * and levels. */
#include "solve/contact/contact.h"
#include "explicit.h"
#include "solve/growth/facet_growth.h"
#include <math.h>
#include <string.h>

enum { BLOCK = 2048 };

/* ---- supports ------------------------------------------------------------------------------------------ */
/* Finds the prescribed unknowns: rows of T without an entry. T must select: one entry a column, which is
 * 1. */
static pg_status find_prescribed (pg_solver *s, const pg_sparse *T, size_t ndof)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    const char *kind = s->type->name;
    size_t components = (size_t) s->break_loop.system.components;
    unsigned char *is_free = NULL;
    PG_ALLOC (is_free, ndof);
    for (size_t j = 0; j < T->ncol; j++) {
        if (T->start[j + 1] != T->start[j] + 1)
            PG_FAIL (PG_E_SCENE,
                     "%s needs supports that prescribe single unknowns, and with these shape functions "
                     "essential: transformation ties several "
                     "together: use essential: nitsche",
                     kind);
        is_free[T->row[T->start[j]]] = 1;
    }
    /* ghosts get the values of their owners, whatever is prescribed there */
    for (size_t i = 0; i < ndof; i++) is_free[i] |= !pg_cloud_owns (&s->problem->cloud, i / components);
    for (size_t i = 0; i < ndof; i++) m->nprescribed += !is_free[i];
    PG_ALLOC (m->prescribed, m->nprescribed);
    size_t n = 0;
    for (size_t i = 0; i < ndof; i++) if (!is_free[i]) m->prescribed[n++] = i;
done:
    pg_free (is_free);
    return status;
}

/* Is there a load that is a force, not a motion? */
static int has_forces (const pg_problem *p)
{
    for (size_t l = 0; l < p->boundary.nload; l++) if (!pg_load_prescribes (&p->boundary.load[l])) return 1;
    return 0;
}

/* 1: some support acts like a spring (penalty, Nitsche), whose work only the force can find. */
static int has_springs (const pg_problem *p)
{
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (pg_load_prescribes (&p->boundary.load[l])
            && p->boundary.load[l].essential != PG_ESSENTIAL_TRANSFORMATION)
            return 1;
    return 0;
}

/* Finds the prescribed unknowns, allocates, and chooses how work is measured: by velocities at every step
 * where the loads are known as nodal forces, else by the work balance of the force, which costs an
 * evaluation. */
pg_status explicit_create (pg_solver *s)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    const pg_force_type *force = sys->force;
    const pg_sparse *T = system_basis (sys);
    motion *m = motion_of (s);
    if (T && force->impose) PG_TRY (find_prescribed (s, T, sys->ndof));
    PG_ALLOC (m->lists, 3 * m->nprescribed);
    m->before = m->lists, m->goal = m->before + m->nprescribed, m->next = m->goal + m->nprescribed;
    PG_ALLOC (m->push, 3 * m->nprescribed);
    m->push0 = m->push + m->nprescribed, m->left = m->push0 + m->nprescribed;
    /* with shape functions supports do work elsewhere than at the unknowns that they prescribe */
    int by_unknowns = force->loads && !force->method.shape_functions;
    if (by_unknowns && has_forces (s->problem)) PG_ALLOC (m->P, sys->ndof);
    m->by_work_balance = !by_unknowns && force->work
                         && (has_forces (s->problem) || has_springs (s->problem));
    m->nblock = (sys->ndof + BLOCK - 1) / BLOCK;
    PG_ALLOC (m->sum, m->nblock * SUMS);
    PG_ALLOC (m->inverse, sys->ndof);
    double bonds = (double) s->problem->bonds.first[PG_BOND_SETS];
    PG_TRY (pg_cloud_most (&s->problem->cloud, 1, &bonds));
    m->between = (long) fmin (1000, fmax (1, 4e7 / fmax (bonds, 1)));
done:
    return status;
}

/* Frees what explicit_create made, also where it failed halfway. */
void explicit_free (pg_solver *s)
{
    motion *m = motion_of (s);
    if (!m) return;
    explicit_contact_free (s);
    pg_free (m->prescribed), pg_free (m->lists), pg_free (m->push), pg_free (m->P), pg_free (m->inverse),
        pg_free (m->sum), pg_free (m->broke);
}

/* Keeps prescribed unknowns out of the loops over all unknowns: without velocity these leave them where they
 * are. */
void explicit_release (pg_solver *s, pg_state *state)
{
    const motion *m = motion_of (s);
    for (size_t k = 0; k < m->nprescribed; k++) state->v[m->prescribed[k]] = state->a[m->prescribed[k]] = 0;
}

/* out = prescribed displacements at time t, m (nprescribed). */
static pg_status gather (pg_solver *s, double t, double *out)
{
    pg_status status = PG_OK;
    const motion *m = motion_of (s);
    const pg_system *sys = &s->break_loop.system;
    if (m->nprescribed == 0) return PG_OK;
    PG_TRY (sys->force->impose (sys->self, t, sys->balance.full));
    for (size_t k = 0; k < m->nprescribed; k++) out[k] = sys->balance.full[m->prescribed[k]];
done:
    return status;
}

/* Positions of the supports at t_n-1, t_n and t_n+1 give their velocity and acceleration by differences. From
 * the step before two of the three are at hand. */
pg_status explicit_follow (pg_solver *s, double before, double now, double next)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    const pg_system *sys = &s->break_loop.system;
    if (m->fresh) {  /* two come from the step before: one evaluation is enough */
        double *first = m->before;
        m->before = m->goal, m->goal = m->next, m->next = first;
    } else {
        PG_TRY (gather (s, before, m->before));
        PG_TRY (gather (s, now, m->goal));
    }
    PG_TRY (gather (s, next, m->next));
    if (m->P) PG_TRY (sys->force->loads (sys->self, now, m->P));
    m->fresh = 1;
done:
    return status;
}

/* ---- forces -------------------------------------------------------------------------------------------- */
/* Updates state and log for bonds that broke within the evaluation of the force; *own: those of points owned
 * here, as ghosts are counted by their owners. */
static pg_status remove_broken (pg_solver *s, pg_state *state, double t, size_t *own)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    const pg_force_type *force = b->system.force;
    const pg_bond_group dead = { .n = b->changes.n, .bond = b->changes.bond };
    char *kind = NULL;
    *own = 0;
    if (dead.n == 0) return PG_OK;
    PG_ALLOC (kind, dead.n);
    PG_TRY (force->judge (b->system.self, state, state->d, &(pg_judging){ .group = &dead, .kind = kind }));
    for (size_t k = 0; k < dead.n; k++) {
        state->alive[dead.bond[k]] = 0;
        if (!break_loop_owns (b, dead.bond[k])) continue;
        state->broken++, ++*own;
        PG_TRY (break_loop_log (b, dead.bond[k], kind[k], NAN, t));
    }
done:
    pg_free (kind);
    return status;
}

/* Breaks bonds by the utilisation of all; the force refreshes its caches. */
static pg_status break_by_utilisation (pg_solver *s, pg_state *state, double t)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    pg_system *sys = &b->system;
    double t0 = pg_seconds ();
    PG_TRY (break_loop_ready (b));
    PG_TRY (sys->force->judge (sys->self, state, state->d,
                               &(pg_judging){ .utilisation = b->utilisation, .kind = b->kind }));
    PG_TRY (break_loop_kill (b, state, NULL, b->utilisation, 1, 1, t));
    s->report.seconds[PG_SECONDS_BREAK] += pg_seconds () - t0;
    if (b->changes.n) PG_TRY (system_refresh (sys, state, &b->changes));
done:
    return status;
}

/* Do slips of crack faces follow every evaluation? In held stages they are those of the last balanced state:
 * oscillation on the way to balance is no loading. */
static int follows (const pg_solver *s)
{
    return !(s->options.flags & PG_SOLVER_STAGED) || !PG_OWN (pg_stages_options, &s->options)->hold;
}

/* 1: ranks compare the time steps of a row together when it ends; not where one process has the whole body or
 * stages are held. */
static int row_is_shared (const pg_solver *s)
{
    return system_is_shared (&s->break_loop.system) && !(s->options.flags & PG_SOLVER_STAGED);
}

pg_status explicit_room (motion *m, size_t steps)
{
    pg_status status = PG_OK;
    size_t room = m->nbroke;
    PG_GROW (m->broke, m->nbroke, steps);
    for (size_t k = room; k < m->nbroke; k++) m->broke[k] = 0;
done:
    return status;
}

/* Records that a bond broke here in this time step until the row ends, when all ranks count the steps in
 * which one broke anywhere (share_row). */
static pg_status note_break (pg_solver *s)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    size_t step = (size_t) s->break_loop.round;
    PG_TRY (explicit_room (m, step + 1));
    m->broke[step] = 1;
done:
    return status;
}

/* One evaluation of the force, with breaking. Some forces break bonds within the evaluation; with others
 * utilisation is measured, bonds are broken, and the force is evaluated again where some were. */
pg_status explicit_force (pg_solver *s, pg_state *state, double t, int breaking, double *reference)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    pg_system *sys = &b->system;
    const pg_force_type *force = sys->force;
    double t0 = pg_seconds (), unused;
    breaking = breaking && !b->growth && (force->motion.balance_and_break || force->judge)
               && s->problem->criterion->type;
    b->changes.n = 0;
    if (breaking && force->motion.balance_and_break)
        PG_TRY (force->motion.balance_and_break (sys->self, t, state->d, sys->balance.residual, reference,
                                                 &b->changes));
    else PG_TRY (force->balance (sys->self, t, state->d, sys->balance.residual,
                                 reference ? reference : &unused));
    s->report.seconds[PG_SECONDS_FORCE] += pg_seconds () - t0;
    s->evaluations++;
    if (!breaking) goto press;
    size_t own = 0;
    if (force->motion.balance_and_break) {
        PG_TRY (remove_broken (s, state, t, &own));
        /* in relaxation broken bonds leave faces that may touch */
        if (own && (s->options.flags & PG_SOLVER_QUASI_STATIC))
            PG_TRY (contact_refresh (sys, state, &b->changes));
    }
    else {
        PG_TRY (break_by_utilisation (s, state, t));
        double any = system_most (sys, (double) b->changes.n);         /* all ranks measure again */
        if (any > 0)
            PG_TRY (force->balance (sys->self, t, state->d, sys->balance.residual,
                                    reference ? reference : &unused));
    }
    if (own && row_is_shared (s)) PG_TRY (note_break (s));
    else if (b->changes.n && !system_is_shared (sys)) state->events++, s->report.events++;
press:
    if (sys->contact) contact_push (sys, state->d, sys->balance.residual, follows (s));
done:
    return status;
}

/* Adds up the sums of blocks in order, whatever thread made them: the same bits for any number of threads. */
void explicit_total (const pg_solver *s, double *sum)
{
    const motion *m = motion_of (s);
    for (int k = 0; k < SUMS; k++) {
        sum[k] = 0;
        for (size_t b = 0; b < m->nblock; b++) sum[k] += m->sum[b * SUMS + (size_t) k];
    }
}

/* Names the first point whose displacement is not finite. */
pg_status explicit_lost (const pg_solver *s, const pg_state *state, double t)
{
    const pg_problem *p = s->problem;
    size_t i = 0, dim = (size_t) p->dim, components = (size_t) s->break_loop.system.components;
    while (i + 1 < state->ndof && isfinite (state->d[i])) i++;
    const double *x = p->cloud.x + i / components * dim;
    return pg_error (PG_E_EQUILIBRIUM, PG_HERE,
                     "the displacement of point %zu (%g, %g, %g) m is no longer finite at %s %.6g%s: loads "
                     "or prescribed motions are too "
                     "large for it, or breaking has made the body stiffer",
                     i / components, x[0], dim > 1 ? x[1] : 0, dim > 2 ? x[2] : 0,
                     (s->options.flags & PG_SOLVER_QUASI_STATIC) ? "load factor" : "t =", t,
                     (s->options.flags & PG_SOLVER_QUASI_STATIC) ? "" : " s");
}

/* ---- rows and levels ----------------------------------------------------------------------------------- */
/* Number of rows of history.csv: as asked for, else a tenth of the steps, 100 to 1000; a multiple of the
 * levels. */
static long rows_of (const pg_solver_options *o, long total)
{
    long rows = o->rows > 0         ? o->rows
                : total / 10 < 100  ? 100
                : total / 10 > 1000 ? 1000
                                    : total / 10,
         levels = o->levels > 0 ? o->levels : 1;
    return levels * (rows > levels ? rows / levels : 1);
}

/* Time step at which row j of n ends. */
static long row_end (long j, long n, long total) { return (j * total + n - 1) / n; }

/* A step of the solver is a row of results of many time steps, of which an explicit run has far more than
 * rows. */
long explicit_row (const pg_solver *s, long total, long now)
{
    long n = rows_of (&s->options, total), j = now * n / total;
    long end;
    do end = row_end (++j, n, total);
    while (end <= now);
    return end;
}

/* 1: a level is reached at time step `now`. Levels end with rows, so that fields and history belong
 * together. */
int explicit_level (pg_solver *s, long total, long now)
{
    int reached = 0;
    while (s->next_level <= s->options.levels && row_end (s->next_level, s->options.levels, total) <= now)
        s->next_level++, reached = 1;
    return reached;
}

/* Ends the run after its last step, where a crack has arrived at stop.set, or after too many steps with
 * breaking. */
pg_status explicit_end (pg_solver *s, const pg_state *state, int last, const char *what, double t)
{
    pg_status status = PG_OK;
    int arrived;
    PG_TRY (break_loop_arrived (&s->break_loop, state, state->d, &arrived));
    const char *unit = (s->options.flags & PG_SOLVER_QUASI_STATIC) ? "" : " s";
    if (arrived)
        pg_statistics_warn (&s->report, "the crack has arrived at %s: the run ends at %s %.6g%s",
                            s->options.stop_set->name, what, t, unit);
    int many = state->events >= s->options.max_events && !last && s->options.max_events > 0;
    if (many)
        pg_statistics_warn (&s->report, "stopped after solver.max_events = %ld events at %s %.6g%s",
                            s->options.max_events, what, t, unit);
    if (arrived || many || last) s->finished = 1;
done:
    return status;
}

/* Keeps the prescribed unknowns by numbers of points that are the same on all ranks, for runs that go on with
 * other ranks. */
static pg_status keep_prescribed (const pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    const motion *m = motion_of (s);
    const long components = s->break_loop.system.components;
    long *list = NULL;
    int64_t *number = NULL;
    PG_TRY (pg_problem_numbers (s->problem, PG_NODES, &number));
    PG_ALLOC (list, m->nprescribed);
    for (size_t i = 0; i < m->nprescribed; i++) {
        size_t unknown = m->prescribed[i];
        list[i] = (long) number[unknown / (size_t) components] * components
                  + (long) (unknown % (size_t) components);
    }
    PG_TRY (k->counts (k->context, "motion.prescribed", m->nprescribed, list));
done:
    pg_free (list), pg_free (number);
    return status;
}

/* Keeps energy taken by damping and reactions of supports, whose motion is evaluated again after reading. */
pg_status explicit_keep (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    PG_TRY (pg_keep_fields (k, "motion", NULL, "numbers", 1, PG_ROWS (
        PG_KEPT (m->damped), PG_KEPT (m->damped0), PG_KEPT (m->resist), PG_KEPT (m->resist0),
        PG_KEPT (m->most))));
    if (m->nprescribed) PG_TRY (keep_prescribed (s, k));
    if (m->nprescribed) PG_TRY (k->numbers (k->context, "motion.push", 2 * m->nprescribed, m->push));
    if (k->reading) m->fresh = 0;
    if (row_is_shared (s)) {  /* the checkpoint may be one in the middle of a row */
        size_t steps = (size_t) s->break_loop.round + 1;
        PG_TRY (explicit_room (m, steps));
        PG_TRY (k->numbers (k->context, "motion.broke", steps, m->broke));
    }
    PG_TRY (explicit_contact_keep (s, k));
    PG_TRY (facet_keep (&s->break_loop, k));
done:
    return status;
}

/* Reads what a run with other ranks kept. Ghosts have no velocities of their own here; displacements of the
 * supports are evaluated again. */
pg_status explicit_moved (pg_solver *s, pg_state *state, const pg_moved *moved, int within)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    pg_system *sys = &s->break_loop.system;
    size_t components = (size_t) sys->components;
    double share[5], alike[5];
    if (m->by_work_balance || m->contact)
        PG_FAIL (PG_E_USAGE, "an explicit run whose work is measured by the force, or with contact, goes on "
                 "only among as many processes as it had");
    PG_TRY (moved->shares (moved->context, "motion.numbers", 5, share));
    PG_TRY (moved->alike->numbers (moved->alike->context, "motion.numbers", 5, alike));
    m->damped = m->damped0 = share[within ? 1 : 0], m->resist = m->resist0 = share[within ? 3 : 2];
    m->most = alike[4];
    memset (sys->balance.full, 0, sys->ndof * sizeof *sys->balance.full);
    PG_TRY (moved->unknowns (moved->context, "motion.prescribed", "motion.push", (size_t) within, components,
                             sys->balance.full));
    for (size_t k = 0; k < m->nprescribed; k++) m->push[k] = m->push0[k] =
        sys->balance.full[m->prescribed[k]];
    m->fresh = 0, m->bad = 0;
    system_clear_ghosts (sys, state->v);
    system_clear_ghosts (sys, state->a);
done:
    return status;
}
