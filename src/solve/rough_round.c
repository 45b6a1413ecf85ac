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
 * The share is set by success, as a looser one costs fewer iterations: doubled after a round in which it
 * sufficed at once, halved after one in which it did not. */
#include "solve.h"
#include <math.h>
#include <string.h>

static const double first_share = 3e-4, least_share = 1e-6, most_share = 1e-3;
/* By the diagonal, which needs few iterations for a digit more. */
static const double most_by_diagonal = 3e-5;

static double largest_share (const pg_system *s)
{
    return s->mode == SYSTEM_DIAGONAL ? most_by_diagonal : most_share;
}

/* What the iterations go on by where that is not enough, and how often they do. */
static const double further = 0.03;
enum { MOST_TRIES = 3 };
/* Bonds from this utilisation on are compared. */
static const double near = 0.9;

/* Judges by both iterates, by the earlier one only what is near the limit: `over` and `utilisation` are of
 * the one at hand, rough.earlier_u of the bonds of `over` in their order. *can 0: the force judges no
 * groups. */
static pg_status judge_both (break_loop *b, const pg_state *state, const double *d, double *top, int *can)
{
    pg_status status = PG_OK;
    pg_system *s = &b->system;
    pg_rough *r = &s->rough;
    pg_bond_group group = { .n = 0 };
    double t0 = pg_seconds ();
    PG_TRY (break_loop_ready (b));
    PG_TRY (s->force->worst (s->self, state, d, near, b->utilisation, b->kind, top, &b->over));
    if (!(*top > 1)) goto done;
    PG_ALLOC (group.bond, b->over.n);
    memcpy (group.bond, b->over.bond, b->over.n * sizeof *group.bond);
    group.n = b->over.n;
    PG_GROW (r->earlier_u, r->room_u, group.n);
    PG_TRY (s->force->gather (s->self, &group, can));
    if (*can) PG_TRY (s->force->judge_group (s->self, state, &group, r->before, r->earlier_u, NULL, NULL));
done:
    pg_bond_group_clear (&group);
    s->report->seconds[PG_SECONDS_BREAK] += pg_seconds () - t0;
    return status;
}

/* Do the two iterates leave no doubt of what breaks? */
static int decides (const break_loop *b, double top, double cut)
{
    const double *rougher = b->system.rough.earlier_u;
    double error = 0, of_top = 0;
    size_t worst = SIZE_MAX;
    for (size_t k = 0; k < b->over.n; k++) {
        double u = b->utilisation[b->over.bond[k]], m = fabs (u - rougher[k]);
        error = fmax (error, m);
        if (u == top && worst == SIZE_MAX) worst = k, of_top = m;  /* the first of the worst breaks anyway */
    }
    for (size_t k = 0; k < b->over.n; k++) {
        double u = b->utilisation[b->over.bond[k]];
        if (k != worst && fabs (u - cut) <= fabs (u - rougher[k]) + of_top + 0.2 * error) return 0;
    }
    return top - error > 1;
}

/* Also the first share of a run. */
static int may_be_rough (pg_system *s)
{
    if (!s->force->worst || !s->force->judge_group || s->options->plain || s->rough.share < 0 || s->contact)
        return 0;
    if (s->rough.share == 0) s->rough.share = fmin (first_share, largest_share (s));
    return 1;
}

/* What a round teaches of the share. */
static void learn (pg_rough *rough, double most, int done, int tries)
{
    rough->share = done && tries == 1 ? fmin (most, 2 * rough->share)
                                      : fmax (least_share, 0.5 * rough->share);
    if (done) rough->rounds++;
    else rough->again++;
}

pg_status break_loop_rough (break_loop *b, const pg_state *state, double t, double *d, const dynamics *dyn,
                            double *top, int *done)
{
    pg_status status = PG_OK;
    pg_system *s = &b->system;
    pg_rough *rough = &s->rough;
    int can = 1, fit = 1, tries = 0;
    *done = 0;
    if (!may_be_rough (s)) return PG_OK;
    for (; tries < MOST_TRIES && !*done; tries++) {
        PG_TRY (system_solve_roughly (s, t, d, dyn, tries ? further : rough->share, &fit));
        if (!fit) break;
        PG_TRY (judge_both (b, state, d, top, &can));
        if (!(*top > 1) || !can) break;
        *done = decides (b, *top, break_loop_cut (b, *top));
    }
    if (!can) rough->share = -1;                       /* never again */
    else if (tries > 0 && *top > 1) learn (rough, largest_share (s), *done, tries);
done:
    return status;
}
