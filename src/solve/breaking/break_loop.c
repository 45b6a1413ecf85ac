/* SPDX-License-Identifier: GPL-3.0-or-later
 * The break loop (Cui 2022 section 3.2, corrected in theory F5): solve, break the bonds over their limit,
 * update what they touched, solve again, until no bond is over its limit and the residual is small. Shared by
 * static and newmark. */
#include "solve/run/solve.h"
#include <math.h>
#include <string.h>

/* Allocates the utilisation of every bond, the load factor at which it reaches its limit and the kind of
 * failure, 17 bytes a bond, when bonds are first judged: a run in which nothing can break never has them. */
pg_status break_loop_ready (break_loop *b)
{
    pg_status status = PG_OK;
    size_t nbond = b->system.problem->bonds.first[PG_BOND_SETS];
    if (b->kind) return PG_OK;
    if (!b->utilisation) PG_ALLOC (b->utilisation, nbond);
    if (!b->factor) PG_ALLOC (b->factor, nbond);
    PG_ALLOC (b->kind, nbond);
done:
    return status;
}

void break_loop_free (break_loop *b)
{
    if (b->grower) b->grower->free (b);
    system_free (&b->system);
    pg_free (b->utilisation), pg_free (b->factor), pg_free (b->kind);
    pg_free (b->changes.bond), pg_free (b->over.bond), pg_free (b->broken);
    pg_work_balance_clear (&b->work_balance);
    pg_work_balance_clear (&b->before);
    pg_work_balance_clear (&b->start);
    pg_free (b->damage);
}

int break_loop_judges (const break_loop *b)
{
    return b->system.force->judge && pg_criterion_of_bonds (b->system.problem->criterion);
}

/* Finds the bond set of a broken bond and its middle, half way between its point and its node. */
static void locate (const pg_problem *p, pg_broken *out)
{
    size_t point, dim = (size_t) p->dim;
    pg_problem_locate (p, out->bond, &out->set, &point);
    const pg_rows *r = &p->bonds.rows[out->set];
    const double *end = p->cloud.x + (size_t) r->family.node[out->bond - p->bonds.first[out->set]] * dim;
    for (size_t k = 0; k < dim; k++) out->place[k] = 0.5 * (r->x[point * dim + k] + end[k]);
}

int break_loop_owns (const break_loop *b, size_t bond)
{
    const pg_problem *p = b->system.problem;
    int set;
    size_t point;
    if (!p->cloud.subdomain) return 1;
    pg_problem_locate (p, bond, &set, &point);
    return pg_problem_owns (p, set, point);
}

/* Appends to the list of bonds broken in this step; the caller clears the alive bit. */
pg_status break_loop_log (break_loop *b, size_t bond, char kind, double utilisation, double t)
{
    pg_status status = PG_OK;
    PG_GROW (b->broken, b->cap_broken, b->nbroken + 1);
    pg_broken *k = &b->broken[b->nbroken++];
    *k = (pg_broken) { bond, 0, kind, utilisation, { 0 }, t, b->round };
    locate (b->system.problem, k);
done:
    return status;
}

/* ---- bonds that ranks hold in common ------------------------------------------------------------------- */
/* Index of a number in an ascending list; n: it is not there. */
static size_t place_of (size_t n, const int64_t *list, int64_t number)
{
    size_t low = 0, high = n;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (list[middle] < number) low = middle + 1;
        else high = middle;
    }
    return low < n && list[low] == number ? low : n;
}

/* The bond that these numbers name: its set, its point, its node; SIZE_MAX: this rank does not hold it. */
static size_t bond_of (const pg_problem *p, const double *key)
{
    const pg_subdomain *s = p->cloud.subdomain;
    int set = (int) key[0];
    const pg_family *f = &p->bonds.rows[set].family;
    size_t point = place_of (f->n, p->bonds.held[set].number, (int64_t) key[1]),
           node = place_of (s->n, s->number, (int64_t) key[2]);
    if (point == f->n || node == s->n) return SIZE_MAX;
    for (size_t e = f->start[point]; e < f->start[point + 1]; e++)
        if ((size_t) f->node[e] == node) return p->bonds.first[set] + e;
    return SIZE_MAX;
}

/* Bonds broken in this round by the ranks that own them break on all ranks that hold them: `changes`, of
 * owned bonds so far, gets the others. Each rank judges its own bonds only, as it knows others not to the
 * last bit. */
static pg_status share_changes (break_loop *b, pg_state *state)
{
    pg_status status = PG_OK;
    const pg_problem *p = b->system.problem;
    const pg_subdomain *s = p->cloud.subdomain;
    double *mine = NULL, *all = NULL;
    size_t n = 0, own = b->changes.n;
    if (!s) return PG_OK;
    PG_ALLOC (mine, 3 * own);
    for (size_t k = 0; k < own; k++) {
        int set;
        size_t point, bond = b->changes.bond[k];
        pg_problem_locate (p, bond, &set, &point);
        mine[3 * k] = set, mine[3 * k + 1] = (double) p->bonds.held[set].number[point];
        mine[3 * k + 2] = (double) s->number[p->bonds.rows[set].family.node[bond - p->bonds.first[set]]];
    }
    PG_TRY (pg_ranks_share (3 * own, mine, &n, &all));
    for (size_t k = 0; k < n; k += 3) {
        size_t bond = bond_of (p, all + k);
        if (bond == SIZE_MAX || !state->alive[bond]) continue;
        PG_GROW (b->changes.bond, b->changes.cap, b->changes.n + 1);
        state->alive[bond] = 0, b->changes.bond[b->changes.n++] = bond;
    }
    if (b->changes.n > own) pg_sort (b->changes.bond, b->changes.n, sizeof *b->changes.bond,
                                     pg_ascending_sizes);
done:
    pg_free (mine), pg_free (all);
    return status;
}

/* One round of breaking. Bonds that break are listed twice: in `changes` for the force, which updates what
 * they touched, and in `broken` for the results. */
pg_status break_loop_kill (break_loop *b, pg_state *state, const pg_changes *among, const double *measure,
                           double cut, double scale, double t)
{
    pg_status status = PG_OK;
    size_t n = among ? among->n : state->nbond;
    b->changes.n = 0;
    for (size_t k = 0; k < n; k++) {
        size_t i = among ? among->bond[k] : k;
        if (!(measure[i] >= cut) || !state->alive[i] || !break_loop_owns (b, i)) continue;
        PG_GROW (b->changes.bond, b->changes.cap, b->changes.n + 1);
        PG_TRY (break_loop_log (b, i, b->kind[i], b->utilisation[i] * scale, t));
        state->broken++, state->alive[i] = 0;
        b->changes.bond[b->changes.n++] = i;
    }
    PG_TRY (share_changes (b, state));
done:
    return status;
}

/* The largest of a[bond] times `sign` over all bonds, at least `least`. Bonds of ghosts are left to their
 * owners, who know all that they depend on. */
static double most_of (const break_loop *b, const double *a, double sign, double least)
{
    const pg_problem *p = b->system.problem;
    double top = least;
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_family *f = &p->bonds.rows[set].family;
        const double *of = a + p->bonds.first[set];
        for (size_t k = 0; k < f->n; k++) {
            if (!pg_problem_owns (p, set, k)) continue;
            for (size_t e = f->start[k]; e < f->start[k + 1]; e++)
                if (sign * of[e] > top) top = sign * of[e];
        }
    }
    return system_most (&b->system, top);
}

double break_loop_largest (const break_loop *b, const double *a) { return most_of (b, a, 1, 0); }
double break_loop_smallest (const break_loop *b, const double *a) { return -most_of (b, a, -1, -INFINITY); }

/* Counts intact bonds that are over their limit, a tie counting as at the limit: 0 in every state that the
 * loop accepts. */
long break_loop_over (const break_loop *b, const pg_state *state, double scale, double *top)
{
    long over = 0;
    *top = 0;
    for (size_t i = 0; i < state->nbond; i++) {
        double u = scale * b->utilisation[i];
        int is_over = u > 1 + b->system.options->tie;
        if (!state->alive[i] || (!is_over && !(u > *top)) || !break_loop_owns (b, i)) continue;
        if (u > *top) *top = u;
        over += is_over;
    }
    *top = system_most (&b->system, *top);
    return over;
}

/* *top = largest utilisation of all bonds; above 1, `over` lists the bonds that may break now. */
static pg_status look (break_loop *b, const pg_state *state, const double *d, double *top)
{
    pg_status status = PG_OK;
    pg_system *s = &b->system;
    double t0 = pg_seconds ();
    PG_TRY (break_loop_ready (b));
    pg_judging worst = { .utilisation = b->utilisation, .kind = b->kind, .over = &b->over,
                         .from = 1 - s->options->tie, .top = top };
    PG_TRY (s->force->judge (s->self, state, d, &worst));
done:
    s->report->seconds[PG_SECONDS_BREAK] += pg_seconds () - t0;
    return status;
}

double break_loop_cut (const break_loop *b, double top)
{
    const pg_solver_options *o = b->system.options;
    if (o->break_mode == PG_BREAK_ALL) return 1;
    if (o->break_mode == PG_BREAK_WORST) return top * (1 - o->tie);
    return fmax (1, top * (1 - fmax (o->break_fraction, o->tie)));
}

/* One round of breaking, of the bonds over the limit when all were last judged. */
static pg_status break_worst (break_loop *b, pg_state *state, double t, const double *d, const dynamics *dyn,
                              const pg_step *step, double top)
{
    pg_status status = PG_OK;
    double cut = break_loop_cut (b, top);
    if (step->iterations >= b->system.options->max_iterations)
        PG_FAIL (PG_E_EQUILIBRIUM,
                 "bonds still break after %ld rounds (%zu in this step, worst utilisation %.6g): raise "
                 "solver.max_iterations "
                 "or take smaller steps",
                 step->iterations, b->nbroken, top);
    PG_TRY (break_loop_kill (b, state, &b->over, b->utilisation, cut, 1, t));
    PG_TRY (system_break (&b->system, state, &b->changes, d, dyn));
done:
    return status;
}

/* Calls the caller's function between two rounds. */
static pg_status show_caller (break_loop *b, const pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    if (!b->watch || step->iterations <= b->began) return PG_OK;
    step->nbroken = b->nbroken, step->broken = b->broken;
    b->stopped = 1;
    PG_TRY (b->watch (b->watching, state, step));
    b->stopped = 0;
done:
    return status;
}

/* The loop: equilibrium, utilisation of all bonds, breaking of those over the limit as solver.break has
 * it, update, and again. Work is accounted before the first break and after the last: between them loads
 * and supports stay. The caller may look in between the rounds and stop the step; it then goes on where it
 * was. */
pg_status equilibrate (break_loop *b, pg_state *state, double t, double *d, const dynamics *dyn,
                       pg_step *step)
{
    pg_status status = PG_OK;
    pg_system *s = &b->system;
    if (b->round == 0) b->nbroken = 0;
    if (b->grower && dyn && b->round == 0) b->grower->forward (b, dyn->dt);
    step->utilisation = 0;
    for (step->iterations = b->round;; b->round = ++step->iterations) {
        PG_TRY (show_caller (b, state, step));
        s->choice.begins = step->iterations == 0;
        double top;
        int rough = 0, judges = !b->grower && break_loop_judges (b);
        if (judges && step->iterations > (s->choice.mode != SYSTEM_DIAGONAL))
            PG_TRY (break_loop_rough (b, state, t, d, dyn, &top, &rough));
        if (!rough) PG_TRY (system_solve (s, t, d, dyn, &step->residual));
        /* later rounds: loads and supports do not change */
        if (step->iterations == 0) PG_TRY (break_loop_account (b, t, d, dyn, 0, 1));
        if (b->grower) {
            int again;
            PG_TRY (b->grower->round (b, state, t, d, dyn, step, &again));
            if (!again) break;
            continue;
        }
        if (!judges) break;
        if (!rough) PG_TRY (look (b, state, d, &top));
        step->utilisation = top;
        if (!(top > 1)) break;
        PG_TRY (break_worst (b, state, t, d, dyn, step, top));
    }
    if (step->iterations > 0) PG_TRY (break_loop_account (b, t, d, dyn, 0, 1));
    b->round = 0;
    step->nbroken = b->nbroken, step->broken = b->broken;
done:
    return status;
}

/* solver.stop: compares the damage of the points of a set with the one that counts as arrival, and
 * remembers the largest for the progress of the run. */
pg_status break_loop_arrived (break_loop *b, const pg_state *state, const double *d, int *arrived)
{
    pg_status status = PG_OK;
    pg_system *s = &b->system;
    const pg_set *set = s->options->stop_set;
    int components;
    const char *unit;
    *arrived = 0;
    if (!set || !s->force->field) return PG_OK;
    if (!b->damage) PG_ALLOC (b->damage, 6 * s->problem->cloud.n);
    PG_TRY (s->force->field (s->self, state, d, "damage", &components, &unit, b->damage));
    b->nearest = 0;
    for (size_t i = 0; components == 1 && i < set->npoint; i++)
        if (pg_cloud_owns (&s->problem->cloud, (size_t) set->point[i]))
            b->nearest = fmax (b->nearest, b->damage[set->point[i]]);
    PG_TRY (pg_ranks_most (1, &b->nearest));
    if (!b->looked) b->nearest0 = b->nearest, b->looked = 1;
    *arrived = pg_set_points (set) && b->nearest >= s->options->stop_damage;
done:
    return status;
}

/* ---- checkpoints -------------------------------------------------------------------------------------- */
pg_status pg_broken_keep (const pg_problem *p, const char *name, size_t n, pg_broken *broken,
                          const pg_keeper *k)
{
    return pg_keep_fields (k, name, "bonds", "values", n, PG_ROWS (
        PG_EACH_IN (broken, bond, 0, p->bonds.first[PG_BOND_SETS] - 1, "a broken bond"),
        PG_EACH_IN (broken, set, 0, PG_BOND_SETS - 1, "the set of a broken bond"),
        PG_EACH_IN (broken, kind, 0, 127, "the kind of a broken bond"),
        PG_EACH_IN (broken, round, 0, 1L << 50, "the round of a broken bond"),
        PG_EACH (broken, utilisation), PG_EACH (broken, time), PG_EACH (broken, place)));
}
