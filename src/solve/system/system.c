/* SPDX-License-Identifier: GPL-3.0-or-later
 * The linear system of a force, (k K + m M) delta = R: how it is made and freed, and how it follows breaking.
 * With elimination d = T q + g the matrix is T' (k K + m M) T (system_factor.c) and the residual T' R.
 * Solving begins in refinement.c (system_solve); the method of each solve is chosen in choice.c: a
 * factor (system_factor.c, kept_factor.c), its inverse after changes (inverse.c), or iterations
 * (iterate.c). */
#include "solve/run/body_parts.h"
#include "inverse.h"
#include <string.h>

/* Frees what a system of equations holds, also where it was made in part only. */
void system_free (pg_system *s)
{
    system_balance *b = &s->balance;
    system_iterations *it = &s->iterative;
    system_factor *f = &s->direct;
    system_release_matrix (s);
    if (f->factor) f->linear->free (&f->factor);
    inverse_free (&s->updates.following);
    if (s->client) s->client->free (s);
    if (b->floating) body_parts_clear (b->floating), pg_free (b->floating);
    system_guess_free (s);
    system_forget_preconditioner (s);
    if (s->force && s->self) s->force->free (&s->self);
    pg_free (f->diagonal0), pg_free (s->mass), pg_free (it->whole),
        pg_free (it->bare);
    pg_free (b->residual), pg_free (b->reduced), pg_free (b->delta), pg_free (b->full), pg_free (b->best),
        pg_free (b->scratch), pg_free (f->touched), pg_free (f->factored), pg_free (it->hanging);
    pg_crack_paths_free (&f->paths), pg_crack_paths_free (&f->factored_paths);
    pg_free (it->rough.earlier), pg_free (it->rough.before), pg_free (it->rough.earlier_u);
    for (int k = 0; k < ROUGH_VIEWS; k++) pg_free (it->rough.view[k].delta), pg_free (it->rough.view[k].u);
    pg_free (it->fixed), pg_free (it->own_row), pg_free (it->cg_room.v);
}

/* Asks the force for its unknowns, its masses (kg, lumped) and its constraints, and chooses the linear
 * solver. nred: unknowns that constraints leave. All vectors are of full length, as reactions need every
 * residual. */
pg_status system_create (pg_system *s)
{
    system_balance *b = &s->balance;
    system_factor *f = &s->direct;
    pg_status status = PG_OK;
    pg_field field[8];
    PG_TRY (s->force->create (&s->self, s->problem));
    size_t nfield = s->force->fields (s->self, 8, field);
    for (size_t k = 0; k < nfield && k < 8; k++) s->components += field[k].components;
    s->ndof = s->problem->cloud.n * (size_t) s->components;
    const pg_sparse *T = system_basis (s);
    s->nred = T ? T->ncol : s->ndof;
    f->stale = 1;
    if (!system_has_matrix (s) && !system_operator (s))
        PG_FAIL (PG_E_USAGE, "the force %s offers neither a matrix nor an operator", s->force->method.name);
    PG_ALLOC (b->scratch, s->ndof);
    PG_ALLOC (s->mass, s->ndof);
    PG_ALLOC (b->residual, s->ndof);
    PG_ALLOC (b->full, s->ndof);
    if (!(s->options->flags & PG_SOLVER_EXPLICIT)) {   /* vectors that only linear solves need */
        PG_ALLOC (b->reduced, s->ndof);
        PG_ALLOC (b->delta, s->ndof);
        PG_ALLOC (b->best, s->ndof);
        PG_ALLOC (f->diagonal0, s->ndof);
        if (system_is_shared (s)) PG_ALLOC (s->iterative.whole, s->ndof);
    }
    PG_ALLOC (f->touched, s->problem->cloud.n);
    if (s->force->mass) PG_TRY (s->force->mass (s->self, s->mass, NULL));
    int automatic = strcmp (s->options->linear, "auto") == 0;
    f->linear = automatic ? pg_linear_usual (1, 1) : pg_linear_find (s->options->linear);
    if (!f->linear) PG_FAIL (PG_E_USAGE, "there is no linear solver %s", s->options->linear);
done:
    return status;
}

/* The force updates what broken bonds have touched. Where its revision says that this left K as it was (bonds
 * that do not enter K), the factor stays. Where ranks share the body, K counts as changed on all of them if
 * it is on one: all call after a round of breaking. */
pg_status system_refresh (pg_system *s, const pg_state *state, const pg_changes *changes)
{
    system_factor *f = &s->direct;
    double t0 = pg_seconds ();
    pg_status status = s->force->refresh ? s->force->refresh (s->self, state, changes) : PG_OK;
    if (!changes && !f->marked) system_mark_touched (s, state->alive, f->touched), f->marked = 1;
    f->alive = state->alive;
    if (status == PG_OK) status = system_copy_paths (s, &f->paths, state->paths);
    unsigned long now = s->force->revision ? s->force->revision (s->self) : f->revision + 1;
    double other = now != f->revision;
    if (changes && (s->options->flags & PG_SOLVER_IMPLICIT)) other = system_most (s, other);
    if (other != 0) f->stale = 1, s->iterative.guess.fresh = 0;
    else s->choice.kept++;
    if (changes && now != f->revision) ways_note_broken (s, changes->n);
    f->revision = now;
    s->report->linear.updates += changes != NULL;
    if (status == PG_OK) status = system_note_change (s);
    if (status == PG_OK && s->client) status = s->client->refresh (s, state, changes);
    s->report->seconds[changes ? PG_SECONDS_UPDATE : PG_SECONDS_SHAPE] += pg_seconds () - t0;
    return status;
}

/* From now on the matrix is another one, with or without inertia, even if K stays. A factor of the old matrix
 * does not precondition the new one: its next use makes a new one. */
void system_switch (pg_system *s, int mode)
{
    s->choice.mode = mode, s->direct.stale = 1, s->iterative.guess.n = 0;
    s->choice.extra_cost = mode == SYSTEM_KEPT_FACTOR ? 1e300 : 0;
    if (s->updates.following) inverse_forget (s->updates.following);
    system_forget_preconditioner (s);
    s->iterative.remake = 0;
}
