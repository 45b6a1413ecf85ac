/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checkpoint of what later steps depend on, one walk to write and read it: the state (also that at the
 * start of a step in its middle), energies, counts, what a method carries from step to step. Caches are not
 * kept: they are functions of the bonds and the cracks, made again in the same order. The factor of an
 * earlier K is one of them: it is made again from the bonds and cracks of that time. */
#include "solve/contact/contact.h"
#include "solve/system/inverse.h"
#include "solve/growth/facet_growth.h"
#include <string.h>

static const long most = 1L << 50;                     /* largest value of any count */
/* Bytes that are 0 or 1: anything else in a file is a fault, as they are used in arithmetic. */
static pg_status keep_flags (const char *name, size_t n, unsigned char *flag, const pg_keeper *k)
{
    return pg_keep_bytes (k, name, n, flag, 1, name);
}

pg_status keep_state_numbers (pg_state *s, const char *name, const pg_keeper *k)
{
    return pg_keep_fields (k, name, "counts", "numbers", 1, PG_ROWS (
        PG_KEPT_IN (s->step, 0, most, name), PG_KEPT_IN (s->events, 0, most, name),
        PG_KEPT_IN (s->iterations, 0, most, name), PG_KEPT_IN (s->broken, 0, most, name),
        PG_KEPT_IN (s->history_rows, 0, most, name), PG_KEPT (s->time), PG_KEPT (s->factor),
        PG_KEPT (s->work)));
}

/* All of a state: counts, times, displacement, velocity, acceleration, the alive bit of every bond, cracks.
 * `name`: the present state, or that at the start of the step. */
static pg_status keep_state (pg_state *s, const pg_problem *p, const char *name, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char part[64];
    PG_TRY (keep_state_numbers (s, name, k));
    PG_TRY (pg_keep_numbers (k, name, "d", s->ndof, s->d));
    PG_TRY (pg_keep_numbers (k, name, "v", s->ndof, s->v));
    PG_TRY (pg_keep_numbers (k, name, "a", s->ndof, s->a));
    PG_TRY (keep_flags (strcat (strcpy (part, name), ".alive"), s->nbond, s->alive, k));
    strcat (strcpy (part, name), s->paths ? ".paths" : ".surfaces");
    if (s->paths) PG_TRY (pg_crack_paths_keep (s->paths, p, part, k));
    if (s->surfaces) PG_TRY (pg_crack_surfaces_keep (s->surfaces, p, part, k));
done:
    return status;
}

/* Writes or reads back text i of a list in the report. */
static pg_status keep_entry (const char *name, size_t i, size_t size, char *text, const pg_keeper *k)
{
    char part[64];
    snprintf (part, sizeof part, "report.%s.%zu", name, i);
    return pg_keep_text (k, part, size, text);
}

/* Counts, numbers and texts of the report, seconds too: those of the run so far, so that a resumed run
 * reports the whole of it. Numbers of entries are bounded before they are used. */
pg_status keep_report (pg_statistics *r, const pg_keeper *k)
{
    pg_status status = PG_OK;
    enum {
        SKIPS = sizeof r->skipped / sizeof *r->skipped,
        WARNINGS = sizeof r->warning / sizeof *r->warning
    };
    pg_skip *skip = r->skipped;
#define COUNT(field) PG_KEPT_IN (r->field, 0, most, "a count of the report")
#define NUMBER(field) PG_KEPT (r->field)
    PG_TRY (pg_keep_fields (
        k, "report", "counts", "numbers", 1,
        PG_ROWS (COUNT (steps), COUNT (events), COUNT (iterations), COUNT (broken), COUNT (bonds_over_limit),
                 COUNT (linear.factorizations), COUNT (linear.updates), COUNT (linear.solves),
                 COUNT (linear.preconditioners), COUNT (contact.columns), COUNT (contact.solves),
                 COUNT (contact.changes), COUNT (balance.states), COUNT (linear.cg_iterations),
                 COUNT (degenerate_points), COUNT (isolated_nodes), COUNT (fragments),
                 PG_KEPT_IN (r->nskipped, 0, SKIPS, "the number of skipped things"),
                 PG_KEPT_IN (r->nwarning, 0, WARNINGS, "the number of warnings"), NUMBER (utilisation_max),
                 NUMBER (residual_max), NUMBER (contact.overlap_max), NUMBER (energy.strain),
                 NUMBER (energy.kinetic), NUMBER (energy.external), NUMBER (energy.damping),
                 NUMBER (energy.dissipated), NUMBER (linear.factor_entries), NUMBER (linear.factor_flops),
                 NUMBER (energy.fracture), NUMBER (energy.friction), NUMBER (contact.overlap),
                 NUMBER (energy.contact), NUMBER (contact.seconds), NUMBER (balance.force),
                 NUMBER (balance.moment), NUMBER (seconds))));
#undef COUNT
#undef NUMBER
    PG_TRY (pg_keep_text (k, "report.ordering", sizeof r->linear.ordering, r->linear.ordering));
    PG_TRY (pg_keep_text (k, "report.solver", sizeof r->linear.solver, r->linear.solver));
    PG_TRY (
        pg_keep_text (k, "report.preconditioner", sizeof r->linear.preconditioner, r->linear.preconditioner));
    PG_TRY (pg_keep_fields (k, "report", NULL, "saved", SKIPS, PG_ROWS (PG_EACH (skip, seconds_saved))));
    for (size_t i = 0; i < SKIPS; i++) {
        PG_TRY (keep_entry ("skipped", i, sizeof skip[i].what, skip[i].what, k));
        PG_TRY (keep_entry ("why", i, sizeof skip[i].why, skip[i].why, k));
    }
    for (size_t i = 0; i < WARNINGS; i++)
        PG_TRY (keep_entry ("warning", i, sizeof r->warning[i], r->warning[i], k));
done:
    return status;
}

/* Bonds that broke in the step at hand, which was stopped in its middle. */
static pg_status keep_broken (break_loop *b, const pg_problem *p, const pg_keeper *k)
{
    pg_status status = PG_OK;
    PG_KEEP_LENGTH (k, "solver", "broken_count", b->broken, b->nbroken, b->cap_broken,
                    p->bonds.first[PG_BOND_SETS], "the number of broken bonds");
    if (b->nbroken) PG_TRY (pg_broken_keep (p, "solver.broken", b->nbroken, b->broken, k));
done:
    return status;
}

/* Bonds near their limit when last judged in the step at hand: the next round judges these first. */
static pg_status keep_near (break_loop *b, const pg_keeper *k)
{
    pg_status status = PG_OK;
    size_t nbond = b->system.problem->bonds.first[PG_BOND_SETS], n = b->round > 0 ? b->over.n : 0;
    PG_KEEP_LENGTH (k, "solver", "near_count", b->over.bond, n, b->over.cap, b->round > 0 ? nbond : 0,
                    "the number of bonds near their limit");
    if (n == 0) goto done;
    PG_TRY (pg_keep_fields (k, "solver", "near", NULL, 1, PG_ROWS (
        PG_ITEMS_IN (b->over.bond, n, 0, nbond - 1, "a bond near its limit"))));
    for (size_t i = 1; i < n; i++)
        PG_KEEP_BOUND (k, "a bond near its limit", b->over.bond[i], b->over.bond[i - 1] + 1, nbond - 1);
    b->over.n = n;
done:
    return status;
}

/* Forces and displacements of the last accounted states, between which work is summed. pairs: how many a
 * balance of this problem has, -1: none; only that number is accepted. */
static pg_status keep_work_balance (pg_work_balance *l, const char *name, size_t nload, long pairs,
                                    int reactions, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char part[64];
    long npair = l->force != NULL ? (long) l->npair : -1, reacts = l->reaction != NULL;
    strcat (strcpy (part, name), ".counts");
    PG_TRY (pg_keep_fields (k, name, "counts", NULL, 1, PG_ROWS (PG_KEPT (npair), PG_KEPT (reacts))));
    PG_KEEP_BOUND (k, part, npair, npair < 0 ? -1 : pairs, npair < 0 ? -1 : pairs);
    if (npair < 0) goto done;
    PG_KEEP_BOUND (k, part, reacts, reactions, 1);
    if (k->reading) {
        pg_work_balance_clear (l);
        l->npair = (size_t) npair;
        PG_ALLOC (l->force, l->npair);
        PG_ALLOC (l->displacement, l->npair);
        if (reacts) PG_ALLOC (l->reaction, PG_REACTIONS * nload);
    }
    if (npair > 0) PG_TRY (pg_keep_numbers (k, name, "force", l->npair, l->force));
    if (npair > 0) PG_TRY (pg_keep_numbers (k, name, "displacement", l->npair, l->displacement));
    if (reacts && nload) PG_TRY (pg_keep_numbers (k, name, "reaction", PG_REACTIONS * nload, l->reaction));
    PG_TRY (pg_keep_numbers (k, name, "strain", 1, &l->strain));
done:
    return status;
}

/* 1: the force offers K x without a matrix. */
static int operates (const pg_system *s) { return s->force->operator_ && s->force->operator_ (s->self); }

/* 2D: the cracks at the time when the alive bits `factored` were copied. */
static pg_status keep_earlier_paths (pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    if (s->problem->dim != 2 || !pg_problem_grows (s->problem)) return PG_OK;
    if (!s->direct.factored_paths) PG_TRY (pg_crack_paths_create (&s->direct.factored_paths, s->problem));
    PG_TRY (pg_crack_paths_keep (s->direct.factored_paths, s->problem, "system.paths", k));
done:
    return status;
}

/* The multilevel preconditioner and the factor of an earlier K are caches: kept are the alive bits
 * (`factored`) and the cracks at the time when they were made, from which they are made again. */
static pg_status keep_preconditioner (pg_system *s, int solves, long factored, const pg_keeper *k)
{
    system_iterations *it = &s->iterative;
    pg_status status = PG_OK;
    size_t nbond = s->problem->bonds.first[PG_BOND_SETS];
    long made = system_has_preconditioner (s) || it->remake;
    int can = solves && (s->force->spares.couplings || s->force->spares.elements) && operates (s) && factored;
    PG_TRY (k->counts (k->context, "system.multilevel", 1, &made));
    PG_KEEP_BOUND (k, "the multilevel preconditioner", made, 0, can ? 1 : 0);
    PG_KEEP_BOUND (k, "a factor of the bonds", made ? 0 : factored, 0, system_has_matrix (s) ? 1 : 0);
    PG_TRY (k->numbers (k->context, "system.pace", 1, &it->pace));
    PG_TRY (k->numbers (k->context, "system.made", 2, it->made));
    PG_TRY (k->numbers (k->context, "system.borne", 1, &s->balance.borne));
    if (k->reading) {                                  /* the start of the run may have made one */
        system_forget_preconditioner (s);
        it->remake = made != 0;
    }
    if (k->reading && factored && !s->direct.factored) PG_ALLOC (s->direct.factored, nbond);
    if (factored) PG_TRY (keep_flags ("system.factored", nbond, s->direct.factored, k));
    if (factored) PG_TRY (keep_earlier_paths (s, k));
done:
    return status;
}

/* The inverse that follows breaking since the factor was made (dynamics). */
static pg_status keep_following (pg_system *s, const pg_keeper *k)
{
    system_updates *u = &s->updates;
    pg_status status = PG_OK;
    long count = u->following && s->choice.mode == SYSTEM_KEPT_FACTOR;
    PG_TRY (k->counts (k->context, "system.following", 1, &count));
    PG_KEEP_BOUND (k, "what follows a factor", count, 0, s->choice.mode == SYSTEM_KEPT_FACTOR ? 1 : 0);
    if (!count && k->reading) inverse_free (&u->following);
    if (count && !u->following) PG_TRY (inverse_create (&u->following, s, INVERSE_HALVES));
    if (count && u->following) PG_TRY (inverse_keep (u->following, k));
done:
    return status;
}

/* Costs counted for a factor and for finite elements in dynamics, and how well inexact solutions did. */
static pg_status keep_ways (pg_ways *w, pg_rough *rough, const pg_keeper *k)
{
    return pg_keep_fields (k, "system", "ways", "ways.seconds", 1, PG_ROWS (
        PG_KEPT_IN (w->meanwhile, 0, 1, "whether elements stand in for a factor"),
        PG_KEPT_IN (w->solves, 0, most, "solves in place of a factor"), PG_KEPT (rough->rounds),
        PG_KEPT (rough->again), PG_KEPT (w->regret), PG_KEPT (w->iterations), PG_KEPT (w->breaking),
        PG_KEPT (w->bonds), PG_KEPT (w->fresh), PG_KEPT (w->spent), PG_KEPT (rough->share)));
}

/* Keeps the linear system: how it is solved, which unknowns are weak, what the iterations have cost so far. A
 * way to solve that this force does not have is refused. */
static pg_status keep_system (pg_system *s, int solves, const pg_keeper *k)
{
    system_updates *u = &s->updates;
    system_choice *c = &s->choice;
    system_factor *f = &s->direct;
    pg_status status = PG_OK;
    /* without a factor, and after its preconditioner was dropped, no use is made of `factored` any more */
    int made_of = f->factored
                  && (system_has_matrix (s) || system_has_preconditioner (s) || s->iterative.remake),
        indefinite = f->indefinite, stale = f->stale;
    PG_TRY (pg_keep_fields (k, "system", "counts", "numbers", 1, PG_ROWS (
        PG_KEPT_IN (c->mode, SYSTEM_UNDECIDED, SYSTEM_DIAGONAL, "the way to solve"), PG_KEPT (indefinite),
        PG_KEPT (c->kept), PG_KEPT (f->marked), PG_KEPT_IN (made_of, 0, solves ? 1 : 0, "a kept factor"),
        PG_KEPT (stale), PG_KEPT (f->unshifted), PG_KEPT (c->spared),
        PG_KEPT_IN (u->base, 0, 1, "the base of events"),
        PG_KEPT_IN (f->loose, 0, 1, "whether parts are loose"), PG_KEPT (u->by_columns),
        PG_KEPT (f->mean_diagonal), PG_KEPT (f->shift), PG_KEPT (c->extra_cost))));
    if (c->mode < SYSTEM_NO_FACTOR && !system_has_matrix (s))
        PG_KEEP_BOUND (k, "the way to solve", c->mode, SYSTEM_UNDECIDED, SYSTEM_UNDECIDED);
    PG_KEEP_BOUND (k, "a kept factor", made_of, c->mode == SYSTEM_KEPT_FACTOR, 1);
    PG_KEEP_BOUND (k, "the base of events", u->base, 0, made_of);
    if (f->diagonal0) PG_TRY (k->numbers (k->context, "system.diagonal", s->ndof, f->diagonal0));
    PG_TRY (keep_flags ("system.touched", s->problem->cloud.n, f->touched, k));
    /* K had become indefinite: the method of factoring is changed as it was in the first run. */
    if (k->reading && indefinite && !f->indefinite) {
        if (f->factor) f->linear->free (&f->factor);
        f->linear = pg_linear_first (0, 1);
        f->indefinite = 1;
    }
    PG_TRY (keep_preconditioner (s, solves, made_of, k));
    PG_TRY (system_guess_keep (s, k));
    PG_TRY (system_keep_residual (s, k));
    PG_TRY (keep_following (s, k));
    PG_TRY (keep_ways (&c->ways, &s->iterative.rough, k));
    f->stale = stale;
done:
    return status;
}

/* Pairs of force and displacement in a work balance of this problem, by making one; -1: the force has
 * none. */
static pg_status count_pairs (pg_solver *s, long *pairs)
{
    pg_status status = PG_OK;
    const pg_system *sys = &s->break_loop.system;
    pg_work_balance work_balance = { 0 };
    if (!sys->force->work) goto done;
    PG_TRY (sys->force->work (sys->self, s->backup->time, s->backup->d, NULL, &work_balance));
    *pairs = (long) work_balance.npair;
done:
    pg_work_balance_clear (&work_balance);
    return status;
}

pg_status keep_solver_counts (pg_solver *s, const pg_keeper *k)
{
    return pg_keep_fields (k, "solver", "counts", NULL, 1, PG_ROWS (
        PG_KEPT (s->finished), PG_KEPT (s->warned_overlap), PG_KEPT (s->warned_energy),
        PG_KEPT_IN (s->next_level, 0, s->options.levels + 1, "the next level"),
        PG_KEPT_IN (s->break_loop.round, 0, most, "the round"), PG_KEPT (s->spared),
        PG_KEPT (s->evaluations)));
}

/* What the solver object itself carries: where it is among levels and rounds, energies, what it has warned
 * of, statistics, work balances. */
static pg_status keep_solver (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    size_t nload = s->problem->boundary.nload;
    long pairs = -1;
    PG_TRY (keep_solver_counts (s, k));
    PG_TRY (pg_keep_fields (k, "solver", NULL, "numbers", 1, PG_ROWS (
        PG_KEPT (b->work), PG_KEPT (b->work0), PG_KEPT (b->stored0), PG_KEPT (b->strain0),
        PG_KEPT (b->kinetic0))));
    b->saved = b->round > 0;
    PG_TRY (keep_report (&s->report, k));
    if (nload) PG_TRY (k->numbers (k->context, "solver.reaction", PG_REACTIONS * nload, s->reaction));
    PG_TRY (keep_broken (b, s->problem, k));
    PG_TRY (keep_near (b, k));
    PG_TRY (solver_keep_tips (s, k));
    if (k->reading) PG_TRY (count_pairs (s, &pairs));
    PG_TRY (keep_work_balance (&b->work_balance, "work_balance", nload, pairs, 1, k));
    PG_TRY (keep_work_balance (&b->before, "before", nload, pairs, 0, k));
    PG_TRY (keep_work_balance (&b->start, "start", nload, pairs, 0, k));
done:
    return status;
}

/* Makes the factor or preconditioner of an earlier K again, from the bonds and cracks of that time. */
static pg_status rebuild_earlier (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    unsigned char *alive = state->alive;
    pg_crack_paths *paths = state->paths;
    double extra_cost = sys->choice.extra_cost, pace = sys->iterative.pace;
    state->alive = sys->direct.factored;
    if (sys->direct.factored_paths) state->paths = sys->direct.factored_paths,
        sys->direct.factored_paths = NULL;
    PG_TRY (system_refresh (sys, state, NULL));
    if (sys->iterative.remake) {
        PG_TRY (system_make_preconditioner (sys, sys->iterative.made[0], sys->iterative.made[1]));
        sys->choice.extra_cost = extra_cost, sys->iterative.pace = pace, sys->iterative.remake = 0;
    } else PG_TRY (system_factorize (sys, s->type->dynamics ? s->type->dynamics (s) : NULL));
done:
    if (state->paths != paths) pg_crack_paths_free (&state->paths);
    state->alive = alive, state->paths = paths;
    return status;
}

/* Makes the caches again: the kept factor from the bonds of its time, all else from the present bonds. */
static pg_status rebuild (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    /* Making caches counts factorisations and solves; the report must not show those that the first run
     * did not make, only their seconds. */
    pg_statistics counts = s->report;
    int stale = sys->direct.stale, fresh = sys->iterative.guess.fresh;
    if (sys->direct.factored
        && (sys->iterative.remake || sys->choice.mode == SYSTEM_KEPT_FACTOR || sys->updates.base || !stale))
        PG_TRY (rebuild_earlier (s, state));
    else stale = 1;
    PG_TRY (system_refresh (sys, state, NULL));
    sys->direct.stale = stale, sys->iterative.guess.fresh = fresh;
    memcpy (counts.seconds, s->report.seconds, sizeof counts.seconds);
    s->report = counts;
    if (sys->updates.following) PG_TRY (inverse_restore (sys->updates.following));
done:
    return status;
}

const pg_state *pg_solver_accepted (const pg_solver *s, const pg_state *state)
{
    return s->break_loop.round > 0 ? s->backup : state;
}

/* Keeps sums over a rank's own points, for runs that go on with other ranks; the data repeat what is kept
 * elsewhere. */
static pg_status keep_shares (const pg_solver *s, const pg_state *state, const pg_keeper *k)
{
    const break_loop *b = &s->break_loop;
    const pg_statistics *r = &s->report;
    const pg_state *at = pg_solver_accepted (s, state);
    double share[SHARES] = {
        [SHARE_BROKEN] = (double) at->broken, [SHARE_WORK] = at->work, [SHARE_REPORTED] = (double) r->broken,
        [SHARE_STRAIN] = b->round > 0 ? b->strain0 : r->energy.strain,
        [SHARE_KINETIC] = b->round > 0 ? b->kinetic0 : r->energy.kinetic,
        [SHARE_EXTERNAL] = r->energy.external, [SHARE_DAMPING] = r->energy.damping,
        [SHARE_DISSIPATED] = r->energy.dissipated
    };
    return k->numbers (k->context, "solver.shares", SHARES, share);
}

/* One walk for both directions: what is written in this order is read back in it. A solver that has not
 * begun is started first, so that its arrays exist. */
pg_status pg_solver_keep (pg_solver *s, pg_state *state, const pg_keeper *k)
{
    pg_status status = PG_OK;
    if (k->reading) PG_TRY (solver_start (s, state));
    s->started = 1;
    PG_TRY (keep_state (state, s->problem, "state", k));
    PG_TRY (keep_state (s->backup, s->problem, "backup", k));
    PG_TRY (keep_solver (s, k));
    PG_TRY (keep_shares (s, state, k));
    PG_TRY (stages_keep (s, k));
    PG_TRY (keep_system (&s->break_loop.system, (s->type->flags & PG_SOLVER_IMPLICIT) != 0, k));
    if (s->type->keep) PG_TRY (s->type->keep (s, k));
    PG_TRY (facet_keep_measured (&s->break_loop, state, k));
    if (k->reading) PG_TRY (rebuild (s, state));
    PG_TRY (contact_keep (&s->break_loop.system, k));
done:
    return status;
}
