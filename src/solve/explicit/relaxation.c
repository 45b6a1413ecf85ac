/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stages of a load, each brought to rest by damped motion (Kilic and Madenci 2010; Shen 2016; theory B4, C).
 * While a stage is held, bonds do not break before its load has taken effect, as the jolt of a sudden load is
 * not part of a quasi-static path. */
#include "solve/run/body_parts.h"
#include "solve/contact/contact.h"
#include "relaxation.h"
#include "perigal/ranks.h"
#include <math.h>
#include <string.h>

enum { BLOCK = 2048, SUM_R = 0, SUM_STIFF = 1, SUM_MASS = 2 };
static const double least = 1e-2;  /* least reference over the largest so far: separated parts bear nothing */
static const double arrival = 1e-2;  /* imbalance from which on the load of a stage counts as applied */

/* Allocates supports and vectors as for explicit dynamics; the method adds masses and time step. */
pg_status relaxation_create (pg_solver *s)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    struct relaxation *x = NULL;
    PG_TRY (explicit_create (s));
    PG_ALLOC (m->relaxation, 1);
    x = m->relaxation;
    PG_ALLOC (x->mass, s->break_loop.system.ndof);
done:
    return status;
}

/* Frees what relaxation and explicit dynamics hold, also where it was made in part only. */
void relaxation_free (pg_solver *s)
{
    struct relaxation *x = motion_of (s) ? motion_of (s)->relaxation : NULL;
    if (x) pg_free (x->mass), pg_free (x->rate);
    pg_free (x);
    explicit_free (s);
}

/* The first iteration starts from rest, with half a step of velocity. */
pg_status relaxation_begin (pg_solver *s, const pg_state *state)
{
    struct relaxation *x = motion_of (s)->relaxation;
    (void) state;
    x->resting = 1;
    return x->weigh ? x->weigh (s) : PG_OK;
}

/* Load factor of a stage; exactly 1 in the last one, whatever rounding makes of the quotient. */
static double factor_at (const pg_solver *s, long stage)
{
    const pg_stages_options *own = stages_of (s);
    return stage == own->stages ? 1 : (double) stage / (double) own->stages;
}

/* ---- one iteration ------------------------------------------------------------------------------------- */
typedef struct {
    const struct relaxation *x;
    double *d, *v, *a;
    double *r;  const double *inverse;
    double *sum, c;
    size_t ndof;
    int resting;
} iterating;

/* Sums for a range of blocks: r . r; the parts of Rayleigh's quotient v K v dt = v (r' - r), with the last
 * residual r', and v M v; NaN where a number is not finite. Eight lanes each, added in one order, so that
 * sums do not depend on the instruction set. */
PG_WIDEST static void measure (void *context, size_t first, size_t last, int thread)
{
    const iterating *w = context;
    double *d = w->d, *v = w->v, *a = w->a, *r = w->r, *mass = w->x->mass;
    (void) thread;
    for (size_t b = first; b < last; b++) {
        size_t i = b * BLOCK, end = i + BLOCK < w->ndof ? i + BLOCK : w->ndof;
        double *sum = w->sum + b * SUMS;
        pg_eight stiff = { 0 }, heavy = { 0 };
        sum[SUM_R] = lane_dot (r, r, i, end);
        sum[SUM_BAD] = lane_not_finite (d, i, end);
#define QUOTIENT(T, k, lane) \
    do { \
        const T speed = OF (T, v, k); \
        stiff lane += speed * (OF (T, a, k) - OF (T, r, k)); \
        heavy lane += speed * (speed * OF (T, mass, k)); \
    } while (0)
        EACH_OF (i, end, QUOTIENT);
        sum[SUM_STIFF] = lane_sum (&stiff), sum[SUM_MASS] = lane_sum (&heavy);
    }
}

/* One iteration for blocks of unknowns: from rest (half a kick), with a damping rate of its own for each
 * unknown, or with one rate c for all. v is at half steps, d at whole ones; a keeps the residual for the next
 * quotient. */
static void move (void *context, size_t first, size_t last, int thread)
{
    const iterating *w = context;
    double dt = w->x->dt, *d = w->d, *v = w->v, *a = w->a;
    const double *r = w->r, *inverse = w->inverse, *rate = w->x->rate;
    (void) thread;
    for (size_t b = first; b < last; b++) {
        size_t i = b * BLOCK, end = i + BLOCK < w->ndof ? i + BLOCK : w->ndof;
        if (w->resting) for (size_t k = i; k < end; k++) v[k] = 0.5 * dt * (r[k] * inverse[k]);
        /* Central differences of M a + C v = r with C = rate M: (1/dt + rate/2) v_new = (1/dt - rate/2) v
         * + r/m, times 2 dt. */
        else if (rate)
            for (size_t k = i; k < end; k++)
                v[k] = ((2 - rate[k] * dt) * v[k] + 2 * dt * (r[k] * inverse[k])) / (2 + rate[k] * dt);
        else {
            double keep = (2 - w->c * dt) / (2 + w->c * dt), push = 2 * dt / (2 + w->c * dt);
            for (size_t k = i; k < end; k++) v[k] = keep * v[k] + push * (r[k] * inverse[k]);
        }
        for (; i < end; i++) d[i] += dt * v[i], a[i] = r[i];
    }
}

/* Adds up the sums of all blocks and the squares of loads and reactions, over all ranks that share the body;
 * at ghosts residuals, loads and velocities are 0. */
enum { SQUARE_P = SUMS, SQUARE_PUSH, ALL_SUMS };
static pg_status add_up (const pg_solver *s, double *total)
{
    pg_status status = PG_OK;
    const motion *m = motion_of (s);
    const pg_system *sys = &s->break_loop.system;
    explicit_total (s, total);
    total[SQUARE_P] = m->P ? lane_dot (m->P, m->P, 0, sys->ndof) : 0;
    total[SQUARE_PUSH] = lane_dot (m->push, m->push, 0, m->nprescribed);
    PG_TRY (pg_cloud_sum (&s->problem->cloud, ALL_SUMS, total));
done:
    return status;
}

/* Message with the first point that is not finite; on other ranks, that another rank has one. */
static pg_status lost (const pg_solver *s, const pg_state *state, double t)
{
    if (!system_is_shared (&s->break_loop.system) || lane_not_finite (state->d, 0, state->ndof) != 0)
        return explicit_lost (s, state, t);
    return pg_error (PG_E_EQUILIBRIUM, PG_HERE,
                     "a displacement on another rank is no longer finite at load factor %.6g", t);
}

/* 1: on some rank more bonds have broken than `before`. */
static int any_broke (const pg_solver *s, size_t before)
{
    return system_most (&s->break_loop.system, (double) (s->break_loop.nbroken - before)) > 0;
}

/* Measures the residual at d, without forces of supports; imbalance: its size over that of loads and
 * reactions, or over a hundredth of the largest so far once the body has come apart; sets the damping of the
 * next iteration. */
static pg_status examine (pg_solver *s, pg_state *state, double t, int breaking)
{
    pg_status status = PG_OK;
    const pg_stages_options *own = stages_of (s);
    motion *m = motion_of (s);
    struct relaxation *x = m->relaxation;
    pg_system *sys = &s->break_loop.system;
    double reference = 0, total[ALL_SUMS];
    size_t before = s->break_loop.nbroken;
    PG_TRY (explicit_force (s, state, t, breaking, &reference));
    x->broke = breaking && any_broke (s, before);
    if (x->broke && system_is_shared (sys)) state->events++, s->report.events++;
    if (x->broke && x->weigh) PG_TRY (x->weigh (s));
    double t0 = pg_seconds ();
    for (size_t k = 0; k < m->nprescribed; k++)
        m->push[k] = -sys->balance.residual[m->prescribed[k]], sys->balance.residual[m->prescribed[k]] = 0;
    iterating all = { x, state->d, state->v, state->a, sys->balance.residual, m->inverse, m->sum, 0,
                     sys->ndof, 0 };
    pg_parallel (s->problem->threads, m->nblock, measure, &all);
    PG_TRY (add_up (s, total));
    if (m->P) reference = 0;
    reference = fmax (reference, fmax (sqrt (total[SQUARE_P]), sqrt (total[SQUARE_PUSH])));
    if (x->armed || !own->hold) x->most = fmax (x->most, reference);
    reference = fmax (reference, least * x->most);
    x->reference = reference;
    double size = sqrt (total[SUM_R]);
    if (total[SUM_BAD] != 0 || !isfinite (size)) PG_TRY (lost (s, state, t));
    x->imbalance = reference > 0 ? size / reference : size > 0 ? 1 : 0;
    relaxation_damp (x, own->hold, total[SUM_STIFF], total[SUM_MASS]);
    s->report.seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
done:
    return status;
}

/* Largest sum of the residual along an axis over that of loads or reactions, whichever is larger, or over the
 * reference force where a separated body bears less: small unbalanced forces of one sign all over a body
 * change its reactions by many times their norm. Prescribed unknowns have no residual. */
static double imbalance_of_reactions (const pg_solver *s)
{
    const motion *m = motion_of (s);
    const pg_system *sys = &s->break_loop.system;
    size_t components = (size_t) sys->components, dim = (size_t) s->problem->dim;
    double left[3] = { 0 }, loads[3] = { 0 }, supports[3] = { 0 }, most = 0, size = m->relaxation->reference;
    for (size_t i = 0; i < sys->ndof; i++) {
        size_t k = i % components;
        if (k >= dim) continue;
        left[k] += sys->balance.residual[i];
        if (m->P) loads[k] += fabs (m->P[i]);
    }
    for (size_t j = 0; j < m->nprescribed; j++) {
        size_t k = m->prescribed[j] % components;
        if (k < dim) supports[k] += fabs (m->push[j]);
    }
    for (size_t k = 0; k < dim; k++) {
        most = fmax (most, fabs (system_sum (sys, left[k])));
        size = fmax (size, fmax (system_sum (sys, loads[k]), system_sum (sys, supports[k])));
    }
    return size > 0 ? most / size : 0;
}

/* One iteration for all unknowns. */
static pg_status iterate (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    struct relaxation *x = m->relaxation;
    const pg_system *sys = &s->break_loop.system;
    double t0 = pg_seconds ();
    iterating all = { x,          state->d, state->v, state->a,  sys->balance.residual,
                      m->inverse, m->sum,   x->c,     sys->ndof, x->resting };
    pg_parallel (s->problem->threads, m->nblock, move, &all);
    x->resting = 0;
    PG_TRY (system_exchange (sys, state->d));
done:
    s->report.seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    return status;
}

/* ---- a stage that is held ------------------------------------------------------------------------------ */
/* Prescribed unknowns take their values and have no velocity. */
static pg_status impose (const pg_solver *s, pg_state *state)
{
    const motion *m = motion_of (s);
    for (size_t k = 0; k < m->nprescribed; k++)
        state->d[m->prescribed[k]] = m->goal[k], state->v[m->prescribed[k]] = state->a[m->prescribed[k]] = 0;
    return system_exchange (&s->break_loop.system, state->d);
}

/* Begins the next stage. Under proportional loads the last balanced state is scaled by the ratio of loads,
 * which is the next one until bonds break: most iterations are then spent where something has changed. */
static pg_status open_stage (pg_solver *s, pg_state *state)
{
    struct relaxation *x = motion_of (s)->relaxation;
    /* u of stage n + 1 = (n + 1) / n times u of stage n. */
    double ratio = state->step > 0 && pg_problem_proportional (s->problem)
                       ? (double) (state->step + 1) / (double) state->step
                       : 1;
    for (size_t i = 0; i < state->ndof; i++) state->d[i] *= ratio, state->v[i] = state->a[i] = 0;
    x->resting = 1, x->armed = x->pending = 0;
    s->break_loop.nbroken = 0;
    return impose (s, state);
}

/* From now on bonds may break, as the load has taken effect. The work up to this state is remembered: the
 * state before the first break is the last one on the elastic path. */
static pg_status arm (pg_solver *s, const pg_state *state, double t, int breaking)
{
    pg_status status = PG_OK;
    struct relaxation *x = motion_of (s)->relaxation;
    pg_system *sys = &s->break_loop.system;
    x->armed = 1;
    if (!sys->force->work || !breaking) return PG_OK;
    PG_TRY (sys->force->work (sys->self, t, state->d, &(pg_known){ .inertia = sys->balance.pressed },
                              &s->break_loop.work_balance));
    s->break_loop.work_balance.strain += contact_energy (sys);
    x->pending = 1;
done:
    return status;
}

/* The work up to the first break of a stage is added when something breaks, or when the stage ends. */
static pg_status book_pending (pg_solver *s)
{
    struct relaxation *x = motion_of (s)->relaxation;
    if (!x->pending) return PG_OK;
    x->pending = 0;
    return break_loop_book (&s->break_loop, 1);
}

/* Breaks bonds over their limit in a balanced state as options.break_mode says (the worst, a share of the
 * worst, all); *died 1: some broke, on any rank. */
static pg_status break_in_balance (pg_solver *s, pg_state *state, double t, pg_step *step, int *died)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    break_loop *b = &s->break_loop;
    pg_system *sys = &b->system;
    const pg_solver_options *o = &s->options;
    double top, t0 = pg_seconds ();
    size_t before = b->nbroken;
    int tested = o->break_mode == PG_BREAK_PASSING
                 || (o->break_mode == PG_BREAK_ALL && sys->force->motion.balance_and_break);
    b->changes.n = 0;
    if (tested) PG_TRY (examine (s, state, t, 1));
    else {
        PG_TRY (break_loop_ready (b));
        PG_TRY (sys->force->judge (sys->self, state, state->d,
                                   &(pg_judging){ .utilisation = b->utilisation, .kind = b->kind }));
        step->utilisation = top = break_loop_largest (b, b->utilisation);
        /* Bonds at the cut or above break: with PG_BREAK_WORST those within `tie` of the worst, so that bonds
         * that are equal by symmetry break together; with a fraction more, but none below its limit of 1. */
        double cut =
            o->break_mode == PG_BREAK_ALL
                ? 1
                : top * (1 - (o->break_mode == PG_BREAK_WORST ? o->tie : fmax (o->break_fraction, o->tie)));
        if (o->break_mode != PG_BREAK_WORST) cut = fmax (cut, 1);
        if (top > 1) PG_TRY (break_loop_kill (b, state, NULL, b->utilisation, cut, 1, t));
        s->report.seconds[PG_SECONDS_BREAK] += pg_seconds () - t0;
        if (b->changes.n) {
            PG_TRY (system_refresh (sys, state, &b->changes));
            if (m->relaxation->weigh) PG_TRY (m->relaxation->weigh (s));
        }
    }
    *died = any_broke (s, before);
    if (*died && !tested) state->events++, s->report.events++;
done:
    return status;
}

/* Message for a stage that does not come to rest: why, and what to do. */
static pg_status too_long (pg_solver *s, const pg_state *state, double t, long iterations)
{
    const pg_problem *p = s->problem;
    pg_system *sys = &s->break_loop.system;
    size_t worst = 0, dim = (size_t) p->dim;
    for (size_t i = 1; i < state->ndof; i++)
        if (fabs (sys->balance.residual[i]) > fabs (sys->balance.residual[worst])) worst = i;
    const double *x = p->cloud.x + worst / (size_t) sys->components * dim;
    pg_error (PG_E_EQUILIBRIUM, PG_HERE,
                     "no balance after %ld iterations: the out-of-balance force is %.3g of the loads "
                     "(allowed %.3g), largest at point %zu "
                     "(%g, %g, %g) m: take more solver.stages, or raise solver.max_iterations or "
                     "solver.imbalance",
                     iterations, motion_of (s)->relaxation->imbalance, stages_of (s)->imbalance,
                     worst / (size_t) sys->components, x[0], dim > 1 ? x[1] : 0, dim > 2 ? x[2] : 0);
    return body_parts_explain (sys, t, PG_E_EQUILIBRIUM);
}

/* Calls the caller's function between iterations; it may stop the step. */
static pg_status look (pg_solver *s, pg_state *state, pg_step *step)
{
    break_loop *b = &s->break_loop;
    step->nbroken = b->nbroken, step->broken = b->broken, step->iterations = b->round;
    b->stopped = 1;
    pg_status status = b->watch (b->watching, state, step);
    if (status == PG_OK) b->stopped = 0;
    return status;
}

/* Iterates until the stage is balanced and no bond is over its limit. With PG_BREAK_PASSING bonds break at
 * any iteration once the load has taken effect, else in balanced states only. */
static pg_status hold (pg_solver *s, pg_state *state, double t, pg_step *step)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    break_loop *b = &s->break_loop;
    struct relaxation *x = m->relaxation;
    const pg_solver_options *o = &s->options;
    int can = relaxation_breaks (s), passing = can && o->break_mode == PG_BREAK_PASSING;
    for (;; b->round++) {
        if (b->watch && b->round > b->began && b->round % m->between == 0)
            PG_TRY (look (s, state, step));
        int tested = passing && x->armed;
        PG_TRY (examine (s, state, t, tested));
        if (x->broke) PG_TRY (book_pending (s));
        if (x->imbalance <= stages_of (s)->imbalance) x->imbalance = fmax (x->imbalance,
                                                                           imbalance_of_reactions (s));
        if (x->imbalance <= stages_of (s)->imbalance) {
            int died = x->broke;
            if (can && !tested) {
                if (!x->armed) PG_TRY (arm (s, state, t, 1));
                PG_TRY (break_in_balance (s, state, t, step, &died));
                if (died) PG_TRY (book_pending (s));
                if (died && o->break_mode != PG_BREAK_PASSING) PG_TRY (examine (s, state, t, 0));
                x->broke = died;
            }
            if (!died) break;
        }
        if (!x->armed && x->imbalance <= arrival) PG_TRY (arm (s, state, t, passing));
        if (b->round >= o->max_iterations) PG_TRY (too_long (s, state, t, b->round));
        PG_TRY (iterate (s, state));
    }
    step->iterations = b->round;
done:
    return status;
}

/* One step is one stage: the load is raised, the body comes to rest, bonds over their limit break, until
 * nothing breaks any more. */
static pg_status step_of_held_stage (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    break_loop *b = &s->break_loop;
    double t = factor_at (s, state->step + 1);
    m->fresh = 0;
    PG_TRY (explicit_follow (s, t, t, t));
    if (b->round == 0) PG_TRY (open_stage (s, state));
    PG_TRY (hold (s, state, t, step));
    PG_TRY (break_loop_account (b, t, state->d, NULL, 0, 1));
    memset (state->v, 0, state->ndof * sizeof *state->v);
    memset (state->a, 0, state->ndof * sizeof *state->a);
    b->round = 0;
    step->residual = m->relaxation->imbalance;
    state->factor = t;
    /* levels are the shares of the full load at which fields are written */
    while ((double) s->next_level / (double) s->options.levels <= t * (1 + 1e-12))
        s->next_level++, step->level = 1;
    PG_TRY (explicit_end (s, state, state->step + 1 >= stages_of (s)->stages, "load factor", t));
done:
    return status;
}

/* ---- one iteration a stage ----------------------------------------------------------------------------- */
/* 1: the least damping is estimated at this iteration: 1, 2, 4 ... 32, 64, 128 ..., often at first, seldom
 * later. */
static int is_due (long n) { return n % 64 == 0 || (n < 64 && (n & (n - 1)) == 0); }

/* hold: off: a step is a row of many stages, each of one iteration. */
static pg_status step_on (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    const pg_stages_options *own = stages_of (s);
    motion *m = motion_of (s);
    break_loop *b = &s->break_loop;
    struct relaxation *x = m->relaxation;
    long n = state->iterations + b->round, last = explicit_row (s, own->stages, state->iterations);
    if (b->round == 0) b->nbroken = 0, x->worst = 0;
    explicit_release (s, state);
    m->fresh = 0;
    while (n < last) {
        double t = factor_at (s, ++n);
        m->fresh = 0;
        PG_TRY (explicit_follow (s, t, t, t));
        PG_TRY (impose (s, state));
        PG_TRY (examine (s, state, t, 1));
        if (is_due (n)) x->floor = relaxation_least_damping (s, state);
        x->worst = fmax (x->worst, x->imbalance);
        PG_TRY (iterate (s, state));
        b->round = n - state->iterations;
        if (b->watch && n % m->between == 0 && n < last) {
            step->time = t;
            PG_TRY (look (s, state, step));
        }
    }
    step->iterations = b->round;
    double t = factor_at (s, n);
    PG_TRY (break_loop_account (b, t, state->d, NULL, 0, 1));
    b->round = 0;
    step->residual = x->worst;
    state->factor = t;
    step->level = explicit_level (s, own->stages, n);
    PG_TRY (explicit_end (s, state, n == own->stages, "load factor", t));
    if (s->finished)
        pg_statistics_warn (&s->report,
                            "hold: off takes one iteration a stage: its states are not in equilibrium, the "
                            "out-of-balance force is up to %.2g of the loads",
                            fmax (x->worst, s->report.residual_max));
done:
    return status;
}

/* Lists damping, imbalance and the sums they come from. */
static void give_numbers (const struct relaxation *x, double *number)
{
    const double now[RELAXATION_NUMBERS] = { x->c, x->imbalance, x->worst, x->most, x->stiff, x->heavy,
                                             x->floor };
    memcpy (number, now, sizeof now);
}

/* Makes a step of either kind; then finds energies, reactions and what breaking has dissipated. */
pg_status relaxation_step (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    struct relaxation *x = motion_of (s)->relaxation;
    if (x->read && x->weigh) PG_TRY (x->weigh (s));
    x->read = 0;
    if (b->round == 0) give_numbers (x, x->start);
    PG_TRY (stages_of (s)->hold ? step_of_held_stage (s, state, step) : step_on (s, state, step));
    if (b->system.contact) contact_accept (&b->system), contact_count (&b->system);
    PG_TRY (contact_show (&b->system, 1));
    s->report.energy.strain = b->work_balance.strain;
    step->dissipated = b->work - b->work0 - (b->work_balance.strain - b->stored0);
    state->time = step->time = step->factor = state->factor;
    step->nbroken = b->nbroken, step->broken = b->broken;
    if (b->work_balance.reaction)
        memcpy (s->reaction, b->work_balance.reaction,
                PG_REACTIONS * s->problem->boundary.nload * sizeof *s->reaction);
done:
    return status;
}

/* 1: all stages are done. A held stage is a step; without hold a step is many stages of one iteration. */
int relaxation_done (const pg_solver *s, const pg_state *state)
{
    const pg_stages_options *own = stages_of (s);
    return (own->hold ? state->step : state->iterations) >= own->stages;
}

/* Share of the stages that is done, 0 to 1. */
double relaxation_progress (const pg_solver *s, const pg_state *state)
{
    const pg_stages_options *own = stages_of (s);
    return (double) (own->hold ? state->step : state->iterations + s->break_loop.round)
           / (double) own->stages;
}

/* The stage begins again from rest after a refused step. */
void relaxation_refused (pg_solver *s)
{
    struct relaxation *x = motion_of (s)->relaxation;
    x->resting = 1, x->armed = x->pending = 0;
}

static pg_status keep_numbers (struct relaxation *x, const char *name, const pg_keeper *k)
{
    return pg_keep_fields (k, "relaxation", NULL, name, 1, PG_ROWS (
        PG_KEPT (x->c), PG_KEPT (x->imbalance), PG_KEPT (x->worst), PG_KEPT (x->most), PG_KEPT (x->stiff),
        PG_KEPT (x->heavy), PG_KEPT (x->floor)));
}

/* Checkpoint of relaxation: damping, imbalance, and how far the stage is. */
pg_status relaxation_keep (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    struct relaxation *x = motion_of (s)->relaxation;
    PG_TRY (keep_numbers (x, "numbers", k));
    PG_TRY (k->numbers (k->context, "relaxation.start", RELAXATION_NUMBERS, x->start));
    PG_TRY (pg_keep_fields (k, "relaxation", "counts", NULL, 1, PG_ROWS (
        PG_KEPT (x->armed), PG_KEPT (x->resting), PG_KEPT (x->pending), PG_KEPT (x->broke))));
    x->read = k->reading;
done:
    return status;
}

/* Reads what a run with other ranks kept; it starts from rest only before its first iteration. Ghosts have no
 * velocities of their own here. */
pg_status relaxation_moved (pg_solver *s, pg_state *state, const pg_moved *moved, int within)
{
    pg_status status = PG_OK;
    struct relaxation *x = motion_of (s)->relaxation;
    PG_TRY (keep_numbers (x, within ? "start" : "numbers", moved->alike));
    x->armed = x->pending = x->broke = 0, x->resting = state->iterations == 0, x->read = 1;
    motion_of (s)->fresh = 0;
    system_clear_ghosts (&s->break_loop.system, state->v);
    system_clear_ghosts (&s->break_loop.system, state->a);
    if (state->step > 0) PG_TRY (moved_balance (&s->break_loop, state->factor, state->d, 1));
done:
    return status;
}
