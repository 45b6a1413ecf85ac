/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rounds in the middle of a cascade. Of the equilibrium between two rounds of breaking nothing is kept: it
 * only tells which bonds break next, those with a utilisation u of at least the cut c, which follows from the
 * largest one. Digits that do not change that answer need not be computed. Conjugate gradients therefore stop
 * when the residual has fallen to a share of what it was (1e-4 or so instead of 1e-8), and bonds are judged
 * twice: by that iterate, u, and by an earlier one, u', whose residual was ten times as large. With
 *
 *     m_i = |u_i - u'_i|,    e = max m_i    over all bonds with u >= 0.9,
 *
 * the error of u_i is about a tenth of m_i, and that of the cut a tenth of that of the worst bond, w. The
 * answer is accepted if the worst bond is above its limit by more than e, and every other one further from
 * the cut than m_i + m_w + e / 5: ten times the errors that are expected, and by the last term also of bonds
 * whose two iterates agree by chance. Else the iterations go on; after some such rounds the state is solved
 * for exactly. So are the first two of a step (by the diagonal, where iterations go on as cheaply as they
 * began, the first), and the last, which leaves the state that is accepted: what a step ends with has the
 * residual that it had without all this.
 *
 * By the diagonal the share is set by success, as a looser one costs fewer iterations: doubled after a round
 * in which it sufficed at once, halved after one in which it did not. With finite elements as preconditioner
 * an iteration costs far more than a judgement of some bonds. There every iterate whose residual has fallen
 * by another third is looked at, at first only the bonds that the last look has found near their limit, and
 * where these leave no doubt all bonds; the iterations end as soon as those leave none either. */
#include "solve/run/solve.h"
#include <math.h>
#include <string.h>

static const double first_share = 3e-4, least_share = 1e-6, most_share = 1e-3;
/* Largest share with the diagonal preconditioner, which needs few iterations for a digit more. */
static const double most_by_diagonal = 3e-5;

static double largest_share (const pg_system *s)
{
    return s->choice.mode == SYSTEM_DIAGONAL ? most_by_diagonal : most_share;
}

/* Factor by which the residual is reduced further where a solution leaves doubt, and how often it is
 * tried. */
static const double further = 0.03;
enum { MOST_TRIES = 3 };
/* Bonds from this utilisation on are compared. */
static const double near = 0.9;

/* Judges bonds by both iterates, by the earlier one those near the limit only: `over` and `utilisation` are
 * of the last iterate, rough.earlier_u of the earlier one, for the bonds of `over` in their order. *can 0:
 * the force cannot judge groups of bonds. */
static pg_status judge_both (break_loop *b, const pg_state *state, const double *d, double *top, int *can)
{
    pg_status status = PG_OK;
    pg_system *s = &b->system;
    pg_rough *r = &s->iterative.rough;
    pg_bond_group group = { .n = 0 };
    double t0 = pg_seconds ();
    PG_TRY (break_loop_ready (b));
    pg_judging worst = { .utilisation = b->utilisation, .kind = b->kind, .over = &b->over, .from = near,
                         .top = top };
    PG_TRY (s->force->judge (s->self, state, d, &worst));
    if (!(*top > 1)) goto done;
    PG_ALLOC (group.bond, b->over.n);
    memcpy (group.bond, b->over.bond, b->over.n * sizeof *group.bond);
    group.n = b->over.n;
    PG_GROW (r->earlier_u, r->room_u, group.n);
    PG_TRY (s->force->spares.gather (s->self, &group, can));
    if (*can) PG_TRY (s->force->judge (s->self, state, r->before,
                                       &(pg_judging){ .group = &group, .utilisation = r->earlier_u }));
done:
    pg_bond_group_clear (&group);
    s->report->seconds[PG_SECONDS_BREAK] += pg_seconds () - t0;
    return status;
}

/* Do the two iterates leave no doubt of what breaks? Utilisation of n bonds by both; those below `near` count
 * for nothing. */
static int decides (size_t n, const double *now, const double *rougher, double top, double cut)
{
    double error = 0, of_top = 0;
    size_t worst = SIZE_MAX;
    for (size_t k = 0; k < n; k++) {
        double u = now[k], m = fabs (u - rougher[k]);
        if (u >= near) error = fmax (error, m);
        if (u == top && worst == SIZE_MAX) worst = k, of_top = m;  /* the first of the worst breaks anyway */
    }
    for (size_t k = 0; k < n; k++) {
        double u = now[k], doubt = fabs (u - rougher[k]) + of_top + 0.2 * error;
        if (u >= near && k != worst && fabs (u - cut) <= doubt) return 0;
    }
    return top - error > 1;
}

/* *yes: do both iterates leave no doubt which of the bonds judged last break? top: largest utilisation. */
static pg_status decides_all (break_loop *b, double top, int *yes)
{
    pg_status status = PG_OK;
    double *u = NULL;
    PG_ALLOC (u, b->over.n);
    for (size_t k = 0; k < b->over.n; k++) u[k] = b->utilisation[b->over.bond[k]];
    *yes = decides (b->over.n, u, b->system.iterative.rough.earlier_u, top, break_loop_cut (b, top));
done:
    pg_free (u);
    return status;
}

/* May equilibria be solved inexactly? Sets the share to which the first residual is reduced. */
static int may_be_rough (pg_system *s)
{
    if (system_is_shared (s) || !s->force->spares.gather || s->options->plain
        || s->iterative.rough.share < 0 || s->contact)
        return 0;
    if (s->iterative.rough.share == 0) s->iterative.rough.share = fmin (first_share, largest_share (s));
    return 1;
}

/* Adapts the share after a round: doubled where the first try sufficed (at most `most`), else halved. */
static void learn (pg_rough *rough, double most, int done, int tries)
{
    rough->share = done && tries == 1 ? fmin (most, 2 * rough->share)
                                      : fmax (least_share, 0.5 * rough->share);
    if (done) rough->rounds++;
    else rough->again++;
}

/* ---- with finite elements ------------------------------------------------------------------------------ */
/* An iterate is kept if its residual has fallen to this share of that of the one kept before. */
static const double apart = 0.7;

/* A round whose iterations are watched, from displacement d. can 0: the force cannot judge groups of bonds.
 * candidates: bonds near their limit when all were last judged; list: number of this list in the round. */
typedef struct {
    break_loop *b;
    const pg_state *state;
    const double *d;
    int      can, done;
    double   top;
    pg_bond_group candidates;
    long     list, looks;
    double  *at;                                       /* displacement of an iterate (ndof) */
} looking;

/* Makes the bonds near their limit, as all bonds were last judged, the candidates from here on. */
static pg_status choose_candidates (looking *w)
{
    pg_status status = PG_OK;
    const pg_changes *over = &w->b->over;
    pg_bond_group_clear (&w->candidates);
    w->candidates.n = 0, w->list++;
    PG_ALLOC (w->candidates.bond, over->n);
    if (over->n) memcpy (w->candidates.bond, over->bond, over->n * sizeof *over->bond);
    w->candidates.n = over->n;
    PG_TRY (w->b->system.force->spares.gather (w->b->system.self, &w->candidates, &w->can));
done:
    return status;
}

/* Finds the utilisation of the candidates by an iterate. */
static pg_status judge_view (looking *w, pg_rough_view *v)
{
    pg_status status = PG_OK;
    pg_system *s = &w->b->system;
    if (v->list == w->list) return PG_OK;
    PG_GROW (v->u, v->room, w->candidates.n);
    system_go_on (s, w->d, v->delta, w->at);
    PG_TRY (s->force->judge (s->self, w->state, w->at,
                             &(pg_judging){ .group = &w->candidates, .utilisation = v->u }));
    v->list = w->list;
done:
    return status;
}

/* 1: the two iterates leave no doubt which candidates break, or all of these are below their limit. */
static int candidates_decide (const looking *w, const pg_rough_view *now, const pg_rough_view *before)
{
    double top = 0;
    size_t n = w->candidates.n;
    for (size_t k = 0; k < n; k++) top = fmax (top, now->u[k]);
    return top < 1 || decides (n, now->u, before->u, top, break_loop_cut (w->b, top));
}

/* Judges all bonds by an iterate, and those near their limit by the earlier one; *stop 1: the solve may
 * end. */
static pg_status look_at_all (looking *w, const pg_rough_view *now, const pg_rough_view *before, int *stop)
{
    pg_status status = PG_OK;
    break_loop *b = w->b;
    pg_rough *r = &b->system.iterative.rough;
    system_go_on (&b->system, w->d, now->delta, w->at);
    system_go_on (&b->system, w->d, before->delta, r->before);
    PG_TRY (judge_both (b, w->state, w->at, &w->top, &w->can));
    w->looks++;
    if (!w->can || !(w->top > 1)) {                    /* the end of the cascade: to be solved exactly */
        *stop = 1;
        return PG_OK;
    }
    PG_TRY (decides_all (b, w->top, &w->done));
    *stop = w->done;
    if (!w->done) PG_TRY (choose_candidates (w));
done:
    return status;
}

/* Stores the present iterate of the solve. */
static pg_status keep_view (pg_system *s, double residual, pg_rough_view **out)
{
    pg_status status = PG_OK;
    pg_rough *r = &s->iterative.rough;
    pg_rough_view *v = &r->view[r->nview % ROUGH_VIEWS];
    if (!v->delta) PG_ALLOC (v->delta, s->ndof);
    memcpy (v->delta, s->balance.delta, s->nred * sizeof *v->delta);
    v->residual = residual, v->list = 0;
    r->nview++;
    *out = v;
done:
    return status;
}

/* The last stored iterate whose residual was at least ROUGHER times as large; NULL: there is none. */
static pg_rough_view *earlier_view (pg_rough *r, double residual)
{
    for (long k = r->nview - 2; k >= 0 && k > r->nview - 1 - ROUGH_VIEWS; k--) {
        pg_rough_view *v = &r->view[k % ROUGH_VIEWS];
        if (v->residual >= ROUGHER * residual) return v;
    }
    return NULL;
}

/* Called after an iteration, residual over the first one; *stop 1: the solve may end. */
static pg_status look_at_iterate (void *context, double residual, int *stop)
{
    pg_status status = PG_OK;
    looking *w = context;
    pg_system *s = &w->b->system;
    pg_rough *r = &s->iterative.rough;
    pg_rough_view *now = NULL;
    if (r->nview > 0 && residual > apart * r->view[(r->nview - 1) % ROUGH_VIEWS].residual) return PG_OK;
    if (residual > ROUGHER / apart * most_share) return PG_OK;
    PG_TRY (keep_view (s, residual, &now));
    pg_rough_view *before = residual > most_share ? NULL : earlier_view (r, residual);
    if (!before) goto done;
    PG_TRY (judge_view (w, before));
    PG_TRY (judge_view (w, now));
    if (candidates_decide (w, now, before)) PG_TRY (look_at_all (w, now, before, stop));
done:
    return status;
}

/* A round whose iterations end when there is no doubt any more which bonds break. */
static pg_status watched_round (break_loop *b, const pg_state *state, double t, double *d,
                                const dynamics *dyn, double *top, int *done)
{
    pg_status status = PG_OK;
    pg_system *s = &b->system;
    pg_rough *r = &s->iterative.rough;
    looking w = { .b = b, .state = state, .can = 1 };
    int fit;
    PG_ALLOC (w.at, s->ndof);
    PG_TRY (choose_candidates (&w));
    if (!w.can) {
        r->share = -1;                                 /* no inexact rounds from now on */
        goto done;
    }
    w.d = d;                                           /* it changes after the iterations only */
    r->look = look_at_iterate, r->looking = &w;
    status = system_solve_roughly (s, t, d, dyn, least_share, &fit);
    r->look = NULL, r->looking = NULL;
    PG_TRY (status);
    *done = fit && w.done, *top = w.top;
    r->rounds += *done, r->again += w.looks - *done;
done:
    r->look = NULL;
    pg_bond_group_clear (&w.candidates);
    pg_free (w.at);
    return status;
}

pg_status break_loop_rough (break_loop *b, const pg_state *state, double t, double *d, const dynamics *dyn,
                            double *top, int *done)
{
    pg_status status = PG_OK;
    pg_system *s = &b->system;
    pg_rough *rough = &s->iterative.rough;
    int can = 1, fit = 1, tries = 0;
    *done = 0;
    if (!may_be_rough (s)) return PG_OK;
    if (s->choice.mode == SYSTEM_NO_FACTOR) return watched_round (b, state, t, d, dyn, top, done);
    for (; tries < MOST_TRIES && !*done; tries++) {
        PG_TRY (system_solve_roughly (s, t, d, dyn, tries ? further : rough->share, &fit));
        if (!fit) break;
        PG_TRY (judge_both (b, state, d, top, &can));
        if (!(*top > 1) || !can) break;
        PG_TRY (decides_all (b, *top, done));
    }
    if (!can) rough->share = -1;                       /* no inexact rounds from now on */
    else if (tries > 0 && *top > 1) learn (rough, largest_share (s), *done, tries);
done:
    return status;
}
