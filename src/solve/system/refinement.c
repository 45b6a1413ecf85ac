/* SPDX-License-Identifier: GPL-3.0-or-later
 * Iterative refinement: solve, add, measure, until the out-of-balance force of the state is small. The
 * residual is measured by the force itself, not by K. States that are not exactly in balance are judged here,
 * and refused with a message. */
#include "solve/run/body_parts.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_REFINEMENTS = 12 };
static const double goal = 1e-12;                      /* refinement stops here or where it no longer gains */

/* Forces due to rounding, N. Where nothing resists (parts moved as rigid bodies) all forces are rounding, and
 * their own size is no measure: this makes the tolerance a backward error of 1e-14. With resistance it is far
 * below the forces. It grows with d, and with it the unbalance allowed in a body that nothing holds: a state
 * that is accepted by this alone has to be `settled`. */
static double force_of_rounding (const pg_system *s, const double *d)
{
    if (!(s->direct.mean_diagonal > 0)) return 0;
    return 1e-14 / s->options->tolerance * system_norm_owned (s, s->direct.diagonal0, d);
}

/* Most that a static residual may be compared with, N: the loads and the reactions that balance them, of
 * this state or (unloaded) of one before. Where K is next to singular the forces of a state may be many times
 * larger, and cancel each other but for rounding. Prescribed displacements are loads by the forces that they
 * exert on a body that is held everywhere else, which bound their reactions; those of a load are larger by
 * the ratio of lever arms, at most the length of the body over the spacing. */
static double largest_reference (pg_system *s)
{
    system_balance *b = &s->balance;
    const double *contact = b->pressed;
    double sum = b->loaded;
    if (contact) sum += system_norm (s, contact, s->ndof);
    if (b->excavated) sum += system_norm (s, b->excavated, s->ndof);
    return fmax (b->lever * sum, b->borne);
}

/* Measures the loads at t: the force at zero displacement but for prescribed ones, and the reference of the
 * force there, as free strains load a body by forces that may balance each other where it cannot expand.
 * `best` and `scratch` are free before a solve. */
static pg_status know_loads (pg_system *s, double t)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    const pg_problem *p = s->problem;
    double *d = b->best, low[3], high[3], length = 0, reference;
    if (b->lever > 0 && t == b->loaded_at) return PG_OK;
    if (b->lever > 0 && b->loaded_at != 0 && pg_problem_proportional (p)) {
        b->loaded *= fabs (t / b->loaded_at), b->loaded_at = t;
        return PG_OK;
    }
    pg_problem_box (p, low, high);
    for (int k = 0; k < p->dim; k++) length = fmax (length, high[k] - low[k]);
    memset (d, 0, s->ndof * sizeof *d);
    if (system_basis (s) && s->force->impose)
        PG_TRY (s->force->impose (s->self, t, d));
    PG_TRY (system_exchange (s, d));
    PG_TRY (s->force->balance (s->self, t, d, b->scratch, &reference));
    system_clear_ghosts (s, b->scratch);
    b->loaded = fmax (reference, system_norm (s, b->scratch, s->ndof)), b->loaded_at = t;
    b->lever = fmax (1, system_most (s, length) / p->cloud.h);
done:
    return status;
}

/* The out-of-balance force of the state, from the force itself, and what it is measured against. */
pg_status system_residual (pg_system *s, double t, const double *d, const dynamics *dyn, double *relative)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    double reference = 0, t0 = pg_seconds ();
    const pg_sparse *T = system_basis (s);
    int lean = dyn && !s->options->plain && s->force->spares.balance_lean;
    int joined = lean && dyn->join && dyn->join (dyn->context, d, b->full);
    if (lean)
        PG_TRY (s->force->spares.balance_lean (s->self, t, joined ? b->full : d, b->residual, &reference));
    else PG_TRY (s->force->balance (s->self, t, d, b->residual, &reference));
    if (dyn) dyn->add (dyn->context, d, b->residual, &reference);
    const double *contact = b->pressed;
    for (size_t i = 0; contact && i < s->ndof; i++) b->residual[i] += contact[i];
    for (size_t j = 0; !dyn && j < s->direct.props.n; j++) {
        size_t i = s->direct.props.unknown[j];
        b->residual[i] -= s->direct.mean_diagonal * (d[i] - s->direct.props.target[j]);
    }
    for (size_t i = 0; b->excavated && !dyn && i < s->ndof; i++) b->residual[i] += b->excavated[i];
    system_clear_ghosts (s, b->residual);
    system_reduce (s, b->residual, b->reduced);
    /* a rank may have no supports where others have */
    if (T || system_is_shared (s)) reference = fmax (reference, system_norm (s, b->residual, s->ndof));
    if (!dyn && b->lever > 0) reference = fmin (reference, largest_reference (s));
    b->reference = reference;
    reference = fmax (reference, force_of_rounding (s, d));
    b->scale = reference;
    double size = b->unbalanced = system_norm (s, b->reduced, s->nred);
    if (!isfinite (size)) PG_FAIL (PG_E_EQUILIBRIUM, "the out-of-balance force is not finite");
    *relative = reference > 0 ? size / reference : size > 0 ? 1 : 0;
done:
    s->report->seconds[PG_SECONDS_FORCE] += pg_seconds () - t0;
    return status;
}

/* One in so many solves is measured even if the iterations have carried its residual along. */
enum { MEASURED_AGAIN = 16 };

/* Accepts a state by the residual that the iterations have carried along for all rows, b - A x by sums of the
 * same products as the force. Measuring it would only add rounding, some 1e-15 of the reference where 1e-9 is
 * asked; this saves two loops over all bonds. As the residual before (*relative) was small, its reference is
 * within a tenth of the present one. */
static int accept_carried (pg_system *s, double *relative)
{
    system_balance *b = &s->balance;
    const pg_sparse *T = system_basis (s);
    if (!b->carried || *relative > 0.1 || s->report->linear.solves % MEASURED_AGAIN == 0) return 0;
    if (T) pg_sparse_multiply_transposed (T, b->residual, b->reduced);
    double size = system_norm (s, T ? b->reduced : b->residual, s->nred);
    if (!(size <= 0.1 * s->options->tolerance * b->reference)) return 0;
    b->unbalanced = size, *relative = b->scale > 0 ? size / b->scale : 0;
    b->unmeasured++;
    return 1;
}

/* Size of the last correction over that of d: of the order of rounding where K resists, of 1 where nothing
 * holds the body. */
static double restlessness (const pg_system *s, const double *step, const double *d)
{
    double size = system_norm_owned (s, NULL, d), by = system_norm_owned (s, NULL, step);
    return size > 0 ? by / size : 0;
}

static const double settled = 1e-3;

/* Is a state that only the rounding allowance accepts held by K? *restless < 0: there was no refinement yet,
 * and one is made to find it. */
static pg_status is_settled (pg_system *s, const dynamics *dyn, const double *d, double *restless)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    if (*restless >= 0) return PG_OK;
    b->known = 0;
    pg_status now = system_solve_once (s, dyn, 0.1);
    if (system_no_equilibrium (now)) *restless = 1;
    else {
        PG_TRY (now);
        *restless = restlessness (s, system_step (s, b->delta), d);
    }
done:
    return status;
}

/* The unknown with the largest out-of-balance force, for messages. With elimination forces are those of
 * columns of T, whose own row has the entry 1. */
static size_t worst_unknown (const pg_system *s, const pg_sparse *T)
{
    size_t worst = 0;
    for (size_t i = 1; i < s->nred; i++)
        if (fabs (s->balance.reduced[i]) > fabs (s->balance.reduced[worst])) worst = i;
    if (!T) return worst;
    for (long q = T->start[worst]; q < T->start[worst + 1]; q++)
        if (T->value[q] == 1) return (size_t) T->row[q];
    return (size_t) T->row[T->start[worst]];
}

/* The message for a state that is not in equilibrium: how far off, where, and what may be the cause. */
static pg_status refuse (pg_system *s, double residual, double restless)
{
    system_balance *b = &s->balance;
    const pg_problem *p = s->problem;
    size_t point = worst_unknown (s, system_basis (s)) / (size_t) s->components;
    const double *x = p->cloud.x + point * (size_t) p->dim;
    char where[96];
    snprintf (where, sizeof where, "largest at point %zu (%g, %g, %g) m", point, x[0], p->dim > 1 ? x[1] : 0,
              p->dim > 2 ? x[2] : 0);
    if (restless > settled)
        return pg_error (PG_E_EQUILIBRIUM, PG_HERE,
                         "%.3g N of the loads stay unbalanced (%.3g of the reference force, allowed %.3g), "
                         "%s, and each refinement moves the points by another %.2g of their displacement",
                         b->unbalanced, b->reference > 0 ? b->unbalanced / b->reference : 1,
                         s->options->tolerance, where, restless);
    return pg_error (PG_E_EQUILIBRIUM, PG_HERE,
                     "the residual stays at %.3g of the reference force (allowed %.3g), %s", residual,
                     s->options->tolerance, where);
}

/* Judges the state by its own forces; in an unloaded body, where these vanish, by the largest reference of an
 * accepted state; else by the forces of rounding, if the state is settled. */
static pg_status judge (pg_system *s, const double *d, const dynamics *dyn, double r, double restless,
                        double *residual)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    double tolerance = s->options->tolerance;
    *residual = r;
    if (b->unbalanced <= tolerance * b->reference) return PG_OK;
    if (b->unbalanced <= tolerance * b->borne) {
        *residual = fmin (r, b->unbalanced / b->borne);
        return PG_OK;
    }
    if (!(r <= tolerance)) return refuse (s, r, 0);
    PG_TRY (is_settled (s, dyn, d, &restless));
    if (!(restless <= settled)) status = refuse (s, r, restless);
done:
    return status;
}

/* Is the next solve as good as one by a factor of this very matrix? */
static int by_factor_at_hand (const pg_system *s, const dynamics *dyn)
{
    return s->choice.mode == SYSTEM_FACTOR || s->choice.mode == SYSTEM_UNDECIDED
           || (s->choice.mode == SYSTEM_KEPT_FACTOR && !s->direct.stale && !dyn);
}

/* 1: the state to be solved for begins a step of a motion that is solved by iterations. */
static int guesses (const pg_system *s, const dynamics *dyn)
{
    return dyn && s->choice.begins && !s->options->plain && s->choice.mode != SYSTEM_FACTOR;
}

/* Improves the prediction of the time scheme by the corrections of the last steps, and measures it again. */
static pg_status improve (pg_system *s, double t, double *d, const dynamics *dyn, double *r)
{
    pg_status status = PG_OK;
    double before = *r;
    int used;
    PG_TRY (system_guess (s, dyn, d, &used));
    if (used == 0) goto done;
    PG_TRY (system_exchange (s, d));
    PG_TRY (system_residual (s, t, d, dyn, r));
    if (*r > before) {
        system_guess_undo (s, d);
        PG_TRY (system_exchange (s, d));
        PG_TRY (system_residual (s, t, d, dyn, r));
    }
done:
    return status;
}

/* Residual that the iterations aim at, over the tolerance (a tenth would be accepted): smaller for the first
 * solve of a step than for later rounds of breaking. */
static double aim (const pg_system *s)
{
    return s->choice.begins || s->choice.mode != SYSTEM_DIAGONAL ? 0.03
           : 0.06;
}

/* to = d + T x */
void system_go_on (pg_system *s, const double *d, const double *x, double *to)
{
    const double *step = system_step (s, x);
    for (size_t i = 0; i < s->ndof; i++) to[i] = d[i] + step[i];
}

/* Allocates the vectors of the earlier iterate, once. */
static pg_status rough_ready (pg_rough *rough, size_t ndof)
{
    pg_status status = PG_OK;
    if (!rough->earlier) PG_ALLOC (rough->earlier, ndof);
    if (!rough->before) PG_ALLOC (rough->before, ndof);
done:
    return status;
}

/* Only solves by iterations can be ended early; with others *done is 0. */
pg_status system_solve_roughly (pg_system *s, double t, double *d, const dynamics *dyn, double share,
                                int *done)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    const pg_sparse *T = system_basis (s);
    pg_rough *rough = &s->iterative.rough;
    double r;
    *done = 0;
    if (!dyn || s->options->plain
        || (s->choice.mode != SYSTEM_NO_FACTOR && s->choice.mode != SYSTEM_DIAGONAL))
        return PG_OK;
    PG_TRY (rough_ready (rough, s->ndof));
    if (b->at_hand) r = system_take_residual (s);
    else {
        if (s->force->impose && T) PG_TRY (s->force->impose (s->self, t, d));
        PG_TRY (system_residual (s, t, d, dyn, &r));
    }
    b->at_hand = 0;
    if (rough->look) share = fmax (share, 10 * s->options->tolerance / r);
    if (rough->look ? share > 0.01 : !(0.1 * share * r > s->options->tolerance)) return PG_OK;
    b->carried = b->known = 0, rough->found = 0, rough->goal = rough->look ? 0 : share;
    status = system_solve_once (s, dyn, share);
    rough->goal = 0;
    PG_TRY (status);
    if (rough->found > 0) system_go_on (s, d, rough->earlier, rough->before);
    system_go_on (s, d, b->delta, d);
    *done = rough->look || rough->found > 0;
    b->known = b->at_hand = b->carried;
done:
    return status;
}

/* Iterative refinement: solve, add, measure by the force. It ends when the residual is small enough (1e-12
 * with a factor, a tenth of the tolerance with iterations) or no longer falls by half, neither relative to
 * the forces nor in itself (an unloaded body has no forces); then the state is judged. */
static pg_status solve_linear (pg_system *s, double t, double *d, const dynamics *dyn, double *residual)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    const pg_sparse *T = system_basis (s);
    double last = INFINITY, r = 0, restless = -1;
    b->at_hand = 0;
    if (!dyn) PG_TRY (know_loads (s, t));
    struct { double unbalanced, reference; } before = { 0, 0 };
    if (s->force->impose && T) PG_TRY (s->force->impose (s->self, t, d));
    PG_TRY (system_exchange (s, d));
    for (int k = 0; k <= MOST_REFINEMENTS; k++) {
        PG_TRY (system_residual (s, t, d, dyn, &r));
        if (k == 0 && guesses (s, dyn)) PG_TRY (improve (s, t, d, dyn, &r));
        b->known = 1;
        /* the last refinement made it worse: take it back */
        if (k > 1 && r > last && b->unbalanced > before.unbalanced) {
            memcpy (d, b->best, s->ndof * sizeof *d);
            r = last, b->unbalanced = before.unbalanced, b->reference = before.reference;
            b->known = 0;
            break;
        }
        if (r <= (by_factor_at_hand (s, dyn) ? goal : 0.1 * s->options->tolerance)
            || k == MOST_REFINEMENTS
            || (k > 1 && r > 0.5 * last && b->unbalanced > 0.5 * before.unbalanced))
            break;
        memcpy (b->best, d, s->ndof * sizeof *d);
        last = r, before.unbalanced = b->unbalanced, before.reference = b->reference;
        b->carried = b->known = 0;
        PG_TRY (system_solve_once (s, dyn, fmin (0.1, aim (s) * s->options->tolerance / r)));
        const double *step = system_step (s, b->delta);
        for (size_t i = 0; i < s->ndof; i++) d[i] += step[i];
        PG_TRY (system_exchange (s, d));
        if (guesses (s, dyn)) system_guess_add (s, step);
        if (k > 0) restless = restlessness (s, step, d);
        b->known = accept_carried (s, &r);
        if (b->known) break;
    }
    PG_TRY (judge (s, d, dyn, r, restless, residual));
    if (guesses (s, dyn)) system_guess_learn (s);
done:
    return status;
}

/* Where a static solve finds no equilibrium, the message names the part that nothing holds, or another
 * reason. */
pg_status system_solve_linear (pg_system *s, double t, double *d, const dynamics *dyn, double *residual)
{
    pg_status status = solve_linear (s, t, d, dyn, residual);
    if (dyn) return status;
    return status == PG_OK ? body_parts_centre (s, d) : body_parts_explain (s, t, status);
}

pg_status system_solve (pg_system *s, double t, double *d, const dynamics *dyn, double *residual)
{
    return s->client ? s->client->solve (s, t, d, dyn, residual)
                     : system_solve_linear (s, t, d, dyn, residual);
}
