/* SPDX-License-Identifier: GPL-3.0-or-later
 * (k K + m M) delta = R, d <- d + delta, until R is small: one linear solve with iterative refinement, the
 * residual always taken from the force, never from K. With elimination d = T q + g the matrix is T' (k K + m
 * M) T (system_factor.c) and the residual T' R. */
#include "body_parts.h"
#include "contact.h"
#include "event_solver.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Frees what a system of equations holds, also where it was made in part only. */
void system_free (pg_system *s)
{
    system_balance *b = &s->balance;
    system_iterations *it = &s->iterative;
    system_factor *f = &s->direct;
    system_release_matrix (s);
    if (f->factor) f->linear->free (&f->factor);
    event_solver_free (&s->updates.following);
    contact_free (s);
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

/* A force may have a matrix in general, yet none for the options of this problem: dilatations reach
 * neighbours of neighbours, and only their product with K is known. */
int system_has_matrix (const pg_system *s)
{
    if (system_is_shared (s)) return 0;                /* each rank has its rows, and products with them */
    return pg_force_matrix (s->force, s->self) != NULL;
}
/* K as a product straight from the bonds; NULL: the force has none. */
const pg_operator *system_operator (const pg_system *s)
{
    return s->force->operator_ ? s->force->operator_ (s->self) : NULL;
}

/* y = K x: by the operator where there is one, which needs no assembly, else by the matrix. */
void system_multiply (const pg_system *s, const double *x, double *y)
{
    const pg_operator *op = system_operator (s);
    if (op && s->iterative.whole) system_multiply_shared (s, op, x, y);
    else if (op) op->apply (op->context, x, y);
    else pg_sparse_multiply (pg_force_matrix (s->force, s->self), x, y);
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
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    s->nred = T ? T->ncol : s->ndof;
    PG_TRY (contact_create (s));
    f->stale = 1;
    if (!system_has_matrix (s) && !system_operator (s))
        PG_FAIL (PG_E_USAGE, "the force %s offers neither a matrix nor an operator", s->force->method.name);
    PG_ALLOC (b->scratch, s->ndof);
    PG_ALLOC (s->mass, s->ndof);
    PG_ALLOC (b->residual, s->ndof);
    PG_ALLOC (b->full, s->ndof);
    if (!(s->options->flags & PG_SOLVER_EXPLICIT)) {   /* what linear solves alone need */
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

/* Nodes of points that lack a bond. Of pre-cracks once: breaking changes the diagonal of such nodes, which is
 * how weak unknowns are found later, but the first K is already without the bonds across a pre-crack. */
void system_mark_touched (const pg_system *s, const unsigned char *bonds, unsigned char *touched)
{
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_family *f = &s->problem->rows[set].family;
        const unsigned char *alive = bonds + s->problem->first_bond[set];
        for (size_t p = 0; p < f->n; p++) {
            if (!memchr (alive + f->start[p], 0, f->start[p + 1] - f->start[p])) continue;
            for (size_t e = f->start[p]; e < f->start[p + 1]; e++) touched[f->node[e]] = 1;
        }
    }
}

/* A copy of cracks that grow, in its own memory. */
static pg_status copy_paths (const pg_system *s, pg_crack_paths **to, const pg_crack_paths *from)
{
    pg_status status = PG_OK;
    if (!from || !pg_problem_grows (s->problem)) return PG_OK;
    if (!*to) PG_TRY (pg_crack_paths_create (to, s->problem));
    PG_TRY (pg_crack_paths_copy (*to, from));
done:
    return status;
}

/* The force updates what broken bonds have touched. Where its revision says that this left K as it was
 * (bonds that do not enter K), the factor stays. K of ranks that share the body is another one where that of
 * any of them is: all call after a round of breaking. */
pg_status system_refresh (pg_system *s, const pg_state *state, const pg_changes *changes)
{
    system_factor *f = &s->direct;
    double t0 = pg_seconds ();
    pg_status status = s->force->refresh ? s->force->refresh (s->self, state, changes) : PG_OK;
    if (!changes && !f->marked) system_mark_touched (s, state->alive, f->touched), f->marked = 1;
    f->alive = state->alive;
    if (status == PG_OK) status = copy_paths (s, &f->paths, state->paths);
    unsigned long now = s->force->revision ? s->force->revision (s->self) : f->revision + 1;
    double other = now != f->revision;
    if (changes && (s->options->flags & PG_SOLVER_IMPLICIT)) other = system_most (s, other);
    if (other != 0) f->stale = 1, s->iterative.guess.fresh = 0;
    else s->choice.kept++;
    if (changes && now != f->revision) ways_note_broken (s, changes->n);
    f->revision = now;
    s->report->updates += changes != NULL;
    if (status == PG_OK) status = system_note_change (s);
    if (status == PG_OK) status = contact_refresh (s, state, changes);
    s->report->seconds[changes ? PG_SECONDS_UPDATE : PG_SECONDS_SHAPE] += pg_seconds () - t0;
    return status;
}

/* The matrix is another one from here on, with or without inertia, whatever K does. A factor of the old one
 * is no preconditioner of the new one: its next use makes a new one. */
void system_switch (pg_system *s, int mode)
{
    s->choice.mode = mode, s->direct.stale = 1, s->iterative.guess.n = 0;
    s->choice.extra_cost = mode == SYSTEM_KEPT_FACTOR ? 1e300 : 0;
    if (s->updates.following) event_solver_drop (s->updates.following);
    system_forget_preconditioner (s);
    s->iterative.remake = 0;
}

/* The bonds that live when a factor or preconditioner is made, and the cracks: a resumed run makes the same
 * ones again from them, bit by bit. */
pg_status system_remember_alive (pg_system *s)
{
    system_factor *f = &s->direct;
    pg_status status = PG_OK;
    size_t nbond = s->problem->first_bond[PG_BOND_SETS];
    if (!f->alive) return PG_OK;
    if (!f->factored) PG_ALLOC (f->factored, nbond);
    memcpy (f->factored, f->alive, nbond);
    PG_TRY (copy_paths (s, &f->factored_paths, f->paths));
done:
    return status;
}

enum { FEW_ITERATIONS = 40 };

/* Says what was spared, and why. */
static void tell_small_step (pg_system *s, size_t used)
{
    char why[160];
    snprintf (why, sizeof why,
              "the time step is small, so that the mass dominates: %zu iterations of conjugate gradients did "
              "in the first step",
              used);
    pg_statistics_skip (s->report, NAN, "stiffness matrix, analysis and factorization", why);
}

/* Iterations by the diagonal where the better preconditioner failed: probably a loaded part has come loose.
 * Small bodies have as many as they could need, for so many seconds. */
enum { LAST_TRY = 2000 };
static const double LAST_SECONDS = 3;
/* a factor that takes longer is none to fall back to */
static const double MOST_SECONDS = 600;

/* Finite elements fitted badly, and nothing converged: a factor instead from now on, where it can be had at
 * all. */
static int falls_back (pg_system *s)
{
    if (!s->force->spares.elements || !system_has_matrix (s) || strcmp (s->options->linear, "auto") != 0
        || system_direct_cost (s) > MOST_SECONDS)
        return 0;
    pg_statistics_warn (s->report, "the iterations with finite elements as preconditioner do not converge: a "
                                   "factor of K from step %ld on", s->report->steps);
    system_forget_preconditioner (s);
    s->choice.mode = SYSTEM_FACTOR, s->direct.stale = 1, s->report->preconditioner[0] = 0;
    memset (s->balance.delta, 0, s->nred * sizeof *s->balance.delta);
    return 1;
}

/* Where the diagonal does, it stays (until it has cost more, leave_diagonal). Else large solids take finite
 * elements, as at rest, and so does what has no matrix to be factored. */
static pg_status after_trial (pg_system *s, const dynamics *dyn, int did)
{
    pg_status status = PG_OK;
    int can, factors = system_has_matrix (s) && s->direct.linear->factors;
    PG_TRY (system_can_precondition (s, dyn, &can));
    pg_solve_counts c = pg_solve_count (s->problem);
    s->choice.mode = did ? (can ? SYSTEM_DIAGONAL : SYSTEM_NO_FACTOR)
                     : can && (!factors || pg_solve_by_elements (&c, 1, 0, 1)) ? SYSTEM_NO_FACTOR
                                                                                : SYSTEM_FACTOR;
done:
    return status;
}

/* Leaves the diagonal where ranks share the body, counted in iterations: for a preconditioner of several
 * levels, when those beyond a few would have paid for it. */
enum { SHARED_SET_UP = 150 };
static pg_status leave_for_shared (pg_system *s, const dynamics *dyn, size_t used)
{
    system_choice *c = &s->choice;
    pg_status status = PG_OK;
    int can;
    PG_TRY (system_can_precondition (s, dyn, &can));
    if (used > FEW_ITERATIONS) c->extra_cost += (double) (used - FEW_ITERATIONS);
    if (!can || c->extra_cost <= SHARED_SET_UP) goto done;
    c->mode = SYSTEM_NO_FACTOR, s->direct.stale = 1, c->extra_cost = 0;
done:
    return status;
}

/* In motion the diagonal did in the first step. Breaking may change that: nodes that few points see are
 * light, rows of few bonds stiff. When the iterations beyond a few have cost as much as a factor (rent or
 * buy, counted), something better is taken for good. */
static pg_status leave_diagonal (pg_system *s, const dynamics *dyn, size_t used)
{
    pg_status status = PG_OK;
    if (dyn && system_is_shared (s)) return leave_for_shared (s, dyn, used);
    if (!dyn || strcmp (s->options->linear, "auto") != 0 || !system_has_matrix (s) || s->problem->sums
        || !s->direct.linear->factors || s->options->plain)
        return PG_OK;
    if (used > FEW_ITERATIONS)
        s->choice.extra_cost += (double) (used - FEW_ITERATIONS) * system_apply_cost (s);
    if (s->choice.extra_cost <= system_direct_cost (s)) return PG_OK;
    PG_TRY (after_trial (s, dyn, 0));
    s->direct.stale = 1, s->choice.extra_cost = 0;
done:
    return status;
}

/* Conjugate gradients with a preconditioner of several levels where it can be made, else with the diagonal.
 * Where the better one fails, the diagonal has a last, limited try: mostly a loaded part has come loose,
 * and nothing converges. */
static pg_status solve_without_factor (pg_system *s, const dynamics *dyn, double tolerance)
{
    pg_status status = PG_OK;
    size_t used = 0, limit = 20 * s->ndof + 1000;
    int can;
    PG_TRY (system_can_precondition (s, dyn, &can));
    can = can && s->choice.mode != SYSTEM_DIAGONAL;
    if (can) {
        pg_status now = system_iterate_preconditioned (s, dyn, tolerance);
        if (now != PG_E_EQUILIBRIUM && now != PG_E_NOT_SPD) return now;
        if (falls_back (s)) return PG_OK;
        limit = (size_t) fmin ((double) limit, fmax (LAST_TRY, LAST_SECONDS / system_apply_cost (s)));
    }
    PG_TRY (system_iterate (s, dyn, BY_DIAGONAL, tolerance, limit, &used));
    if (!can) PG_TRY (leave_diagonal (s, dyn, used));
done:
    return status;
}

/* One linear solve by the way that was chosen; a trial decides between iterations and a factor. */
pg_status system_solve_once (pg_system *s, const dynamics *dyn, double tolerance)
{
    system_choice *c = &s->choice;
    pg_status status = PG_OK;
    size_t used = 0, before = s->report->cg_iterations;
    if (c->mode == SYSTEM_UNDECIDED) PG_TRY (system_choose (s, dyn));
    PG_TRY (ways_choose (s, dyn));
    if (c->mode == SYSTEM_TRIAL) {
        pg_status now = system_iterate (s, dyn, BY_DIAGONAL, tolerance, FEW_ITERATIONS, &used);
        if (now != PG_OK && now != PG_E_EQUILIBRIUM && now != PG_E_NOT_SPD) PG_TRY (now);
        PG_TRY (after_trial (s, dyn, now == PG_OK));
        if (now == PG_OK) {
            tell_small_step (s, used);
            goto done;
        }
        memset (s->balance.delta, 0, s->nred * sizeof *s->balance.delta);
    }
    if (c->mode == SYSTEM_NO_FACTOR || c->mode == SYSTEM_DIAGONAL)
        PG_TRY (solve_without_factor (s, dyn, tolerance));
    if (c->mode == SYSTEM_KEPT_FACTOR) PG_TRY (system_solve_by_kept_factor (s, dyn, tolerance));
    else if (c->mode == SYSTEM_FACTOR) PG_TRY (system_solve_by_factor (s, dyn));
    if (dyn) ways_count (s, s->report->cg_iterations - before);
done:
    s->report->solves += status == PG_OK;
    return status;
}
