/* SPDX-License-Identifier: GPL-3.0-or-later
 * Growth of cracks by facets: find an equilibrium, find J, K_I and K_II of every tip by integrals over rings
 * around it, extend the tip that is nearest to its fracture limit by a facet of about a spacing, break all
 * bonds that the facet crosses, and so on. The lattice enters only by the averaged field at 1 to 8 spacings
 * from the tip (doc/method.md). This file: measuring, growing, one round at a fixed load; facet_direction.c:
 * utilisation and direction of a tip; facet_place.c: the end of its facet; facet_events.c: event stepping. */
#include "solve/contact/contact.h"
#include "facet_growth.h"
#include "front_growth.h"
#include "hot_spot.h"
#include "trial_facet.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* T sqrt (h) / K_I from which on T counts as large. Tie for tips of closed cracks and their wings:
 * utilisations that differ by less than the scatter of K between two positions on a lattice, so that wings of
 * one crack grow together. */
static const double LARGE_T = 0.2, CLOSED_TIE = 0.05;

/* 1: the body is 3D, with fronts of surfaces instead of tips. */
static int in_space (const break_loop *b) { return b->system.problem->dim == 3; }

/* ---- life ---------------------------------------------------------------------------------------------- */
/* Warns of materials whose strength is more than the spacing resolves with their fracture energy. */
static void doubt_strength (const break_loop *b)
{
    const pg_problem *p = b->system.problem;
    for (size_t m = 0; m < p->nmaterial; m++) {
        pg_strength s;
        if (!pg_strength_of (p, m, &s)) continue;
        if (s.in_use < s.asked)
            pg_statistics_warn (b->system.report,
                                "material %.40s: of its strength of %.4g Pa only %.4g Pa are in use where "
                                "cracks "
                                "begin: it fails within E G0 / f_t^2 = %.3g m, which must be 8 spacings: "
                                "take a "
                                "spacing of at most %.3g m",
                                p->material[m].name, s.asked, s.in_use, s.zone, s.zone / 8);
        if (s.cohesion_in_use < s.cohesion)
            pg_statistics_warn (b->system.report,
                                "material %.40s: of its cohesion of %.4g Pa only %.4g Pa are in use where "
                                "cracks "
                                "begin in shear: it fails within E G_II / c^2 = %.3g m, which must be 8 "
                                "spacings",
                                p->material[m].name, s.cohesion, s.cohesion_in_use, s.shear_zone);
    }
}

/* Allocates growth by facets where the criterion judges tips. */
pg_status facet_create (break_loop *b, const growth_client *client)
{
    pg_status status = PG_OK;
    const pg_problem *p = b->system.problem;
    facet_growth *g = NULL;
    if (b->growth || !pg_criterion_of_tips (p->criterion)) return PG_OK;
    const char *why = pg_tip_refuses (p, b->system.force);
    if (why) PG_TRY (options_fault (b->system.options, "failure.criterion", "%s", why));
    PG_ALLOC (g, 1);
    b->growth = g, b->grower = client;
    g->length = b->system.options->facet;
    PG_TRY (pg_nearest_create (&g->near, p->dim, p->cloud.n, p->cloud.x));
    doubt_strength (b);
done:
    return status;
}

void facet_free (break_loop *b)
{
    facet_growth *g = b->growth;
    if (!g) return;
    trials_free (&g->trials);
    fronts_free (&g->fronts);
    pg_nearest_free (&g->near);
    pg_free (g->ramp), pg_free (g->before), pg_free (g->field), pg_free (g->trial), pg_free (g->motion.run);
    facet_hold_free (g);
    b->system.balance.held = NULL;
    pg_free (g);
    b->growth = NULL, b->grower = NULL;
}

/* Writes or reads back warnings and energy; the measurement follows in facet_memory.c. */
pg_status facet_keep (break_loop *b, const pg_keeper *k)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    if (!g) return PG_OK;
    PG_TRY (pg_keep_fields (k, "facets", "said", "needed", 1, PG_ROWS (
        PG_KEPT_IN (g->said, 0, FACET_SAID_ALL, "what was said of facets"), PG_KEPT (g->motion.unjudged),
        PG_KEPT (g->needed))));
    if (k->reading) g->fresh = 0, g->needed0 = g->needed, b->system.report->energy.fracture = g->needed;
    PG_TRY (facet_motion_keep (b, k));
done:
    return status;
}

/* ---- measuring ----------------------------------------------------------------------------------------- */
pg_status facet_offer (facet_growth *g, const facet_candidate *c)
{
    pg_status status = PG_OK;
    PG_GROW (g->trial, g->cap_trial, g->ntrial + 1);
    g->trial[g->ntrial++] = *c;
done:
    return status;
}

/* 1: a trial facet extends this tip. */
static int is_tried (const facet_growth *g, size_t tip)
{
    for (size_t k = 0; k < g->ntrial; k++) if (g->trial[k].tip == (long) tip) return 1;
    return 0;
}

/* 1: the tip is pressed together. In dynamics a passing wave may do so for a moment, which counts from a
 * tenth of the toughness on. */
static int closes (const break_loop *b, const pg_tip_field *f, const double *K)
{
    pg_fracture_limits limits;
    if (!(K[0] < 0) || !(fabs (K[0]) > 1e-3 * fabs (K[1]))) return 0;
    if (!b->growth->motion.moving || !facet_limits (b, f->x, 0, &limits)) return 1;
    return K[0] * K[0] > 0.01 * f->modulus * limits.energy;
}

/* Warns where J of two rings differs by more than a tenth at a tip that may decide; not at one that is almost
 * unloaded compared with others, or with what its growth takes (rounding). */
static void doubt_release (break_loop *b, const pg_state *state, size_t i, double top)
{
    static const double doubtful = 0.1, decisive = 0.5, nothing = 1e-6;
    facet_growth *g = b->growth;
    const pg_tip_field *f = &g->field[i];
    double l[2];
    int n = facet_factors (g, 1, l);
    double off = pg_tip_uncertainty (f, n, l);
    if (g->said & FACET_SAID_UNKNOWN || g->motion.moving || !(off > doubtful) || !(top > nothing)
        || !(facet_judge (b, state, i, 1, NULL, NULL) >= decisive * top))
        return;
    pg_statistics_warn (b->system.report,
                        "the energy release rate of crack tip %ld at (%.6g, %.6g) m is known to +-%.2g %% "
                        "only: rings of %.2g and %.2g spacings differ by that much; take a smaller spacing, "
                        "and look for what lies within %.3g m of it",
                        state->paths->tip[i].id, f->x[0], f->x[1], 100 * off, f->near / f->h, f->wide / f->h,
                        f->wide);
    g->said |= FACET_SAID_UNKNOWN;
}

/* Warns of an open tip next to faces that press on each other, which a ring around a kink does not include:
 * its own ring ends at them. */
static void doubt_beside_faces (break_loop *b, const pg_state *state, size_t i)
{
    static const double narrow = 3;
    facet_growth *g = b->growth;
    const pg_tip_field *f = &g->field[i];
    if (g->said & FACET_SAID_BESIDE || f->closed || f->kinked || f->limit != PG_ROOM_FACES
        || !(f->wide < narrow * f->h))
        return;
    pg_statistics_warn (b->system.report,
                        "K of crack tip %ld at (%.6g, %.6g) m comes from a ring of %.2g spacings beside "
                        "faces that press on each other, where it may be half of what is right: take a "
                        "smaller spacing",
                        state->paths->tip[i].id, f->x[0], f->x[1], f->wide / f->h);
    g->said |= FACET_SAID_BESIDE;
}

/* Gives the warnings about tips that were measured, each once. */
static void tell (break_loop *b, const pg_state *state)
{
    facet_growth *g = b->growth;
    double l[2], K[3];
    size_t open = 0;
    facet_tell_lost (b, state);
    double top = g->said & FACET_SAID_UNKNOWN ? 0 : facet_utilisation (b, state, 1);
    for (size_t i = 0; i < g->ntip; i++) {
        const pg_tip_field *f = &g->field[i];
        if (!state->paths->tip[i].open) continue;
        open++;
        if (isnan (f->near)) continue;
        doubt_release (b, state, i, top);
        doubt_beside_faces (b, state, i);
        pg_tip_combine (f, facet_factors (g, 1, l), l, NULL, K, NULL);
        if (!b->system.contact && closes (b, f, K) && !(g->said & FACET_SAID_CLOSED)) {
            pg_statistics_warn (
                b->system.report,
                "crack tip %ld at (%.6g, %.6g) m closes (K_I = %.3g, K_II = %.3g Pa m^(1/2) at full "
                "load) and its faces overlap: contact is not modelled, so that facets are not to be "
                "trusted here: set contact.kind, or use a criterion that breaks single bonds",
                state->paths->tip[i].id, f->x[0], f->x[1], K[0], K[1]);
            g->said |= FACET_SAID_CLOSED;
        }
    }
    if (!open && !g->ntrial && !(g->said & FACET_SAID_NOTHING)) {
        pg_statistics_warn (b->system.report, "no crack can grow: there is no open tip%s",
                            state->paths->ntip ? " any more" : ", and no new crack begins");
        g->said |= FACET_SAID_NOTHING;
    }
}

/* 1: the stress along the crack is large; of two fields: at either end of their loads. */
static int has_large_T (const pg_tip_field *f, int nfield)
{
    double T = f->T[0], K = f->K_wide[0][0];
    int large = fabs (T) * sqrt (f->h) > LARGE_T * fabs (K);
    if (nfield == 1) return large;
    T += f->T[1], K += f->K_wide[0][1];
    return large || fabs (T) * sqrt (f->h) > LARGE_T * fabs (K);
}

void facet_settle_energy (pg_tip_field *f, int nfield)
{
    if (f->closed || isnan (f->near) || !has_large_T (f, nfield)) return;
    pg_tip_energy (f, nfield, f->K_wide, f->J), pg_tip_energy (f, nfield, f->K_wide, f->J_near);
}

/* Drops integrals that are not finite: the tip counts as without rings, with a warning. */
static void drop_nan (pg_system *s, pg_tip_field *f, long id, int nfield)
{
    double sum = 0;
    if (isnan (f->near)) return;
    for (int a = 0; a < nfield; a++) {
        for (int c = 0; c < nfield; c++) sum += f->J[a][c];
        sum += f->K[0][a] + f->K[1][a];
    }
    if (isfinite (sum)) return;
    f->near = f->wide = NAN;
    pg_statistics_warn_once (s->report,
                             "J of crack tip %ld at (%.6g, %.6g) m is no number, since some point within "
                             "its rings sees no other: the tip is not judged; a lattice offset that puts no "
                             "point on the crack, or a smaller spacing, helps",
                             id, f->x[0], f->x[1]);
}

/* Measures one tip; with contact its faces may touch. */
static pg_status measure_tip (break_loop *b, const pg_state *state, size_t i, const double *const *d,
                              const double *times)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    pg_system *s = &b->system;
    pg_tip_field *f = &g->field[i];
    pg_tip_faces faces;
    double facet = g->length > 0 ? g->length : pg_problem_spacing_at (s->problem, state->paths->tip[i].x);
    if (s->contact) contact_at_tip (s, state, i, g->nfield, &faces);
    PG_TRY (pg_tip_measure (f, s->problem, s->force, s->self, state, i, g->nfield, d, times,
                                  s->contact ? &faces : NULL, facet));
    if (s->contact) facet_settle_energy (f, g->nfield);
    drop_nan (s, f, state->paths->tip[i].id, g->nfield);
done:
    return status;
}

/* Measures all open tips. In dynamics with contact the accelerations include those by contact forces. */
static pg_status tips_measure (break_loop *b, const pg_state *state, const double *const *d, const double *t)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    pg_system *s = &b->system;
    pg_state measured = *state;
    double *a = NULL;
    if (g->motion.moving && s->contact) {
        PG_ALLOC (a, s->ndof);
        memcpy (a, state->a, s->ndof * sizeof *a);
        contact_accelerate (s, a);
        measured.a = a;
    }
    for (size_t i = 0; i < g->ntip; i++)
        if (state->paths->tip[i].open) PG_TRY (measure_tip (b, &measured, i, d, t));
done:
    pg_free (a);
    return status;
}

pg_status facet_lay_out (break_loop *b, const pg_state *state)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    if (in_space (b)) PG_TRY (fronts_lay_out (b, state));
    size_t n = in_space (b) ? g->fronts->n : state->paths ? state->paths->ntip : 0;
    PG_GROW (g->field, g->cap_field, n);
    for (size_t i = 0; i < n; i++) g->field[i] = (pg_tip_field) { .near = NAN };
    g->ntip = n;
done:
    return status;
}

pg_status facet_measure (break_loop *b, const pg_state *state, const double *base, const double *unit,
                         double t)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    pg_system *s = &b->system;
    double t0 = pg_seconds (), times[2] = { base ? t - 1 : t, base ? t : 1 };
    const double *d[2] = { base ? base : unit, NULL };
    g->ntrial = 0, g->nfield = base ? 2 : 1;
    if (base && !g->ramp) PG_ALLOC (g->ramp, s->ndof);
    for (size_t i = 0; base && i < s->ndof; i++) g->ramp[i] = unit[i] - base[i];
    if (base) d[1] = g->ramp;
    PG_TRY (facet_lay_out (b, state));
    PG_TRY (in_space (b) ? fronts_measure (b, state, d, times) : tips_measure (b, state, d, times));
    if (!g->motion.moving) PG_TRY (trial_facets (b, state, d, times));
    if (in_space (b)) fronts_tell (b, state);
    else tell (b, state);
    g->fresh = 1;
done:
    s->report->seconds[PG_SECONDS_BREAK] += pg_seconds () - t0;
    return status;
}

/* Utilisation of a trial facet at a load factor: a new crack needs stress and energy at once, the next facet
 * of a tip without room energy alone. */
double facet_trial_utilisation (const facet_growth *g, const facet_candidate *c, double factor)
{
    double l[2], release = 0, stress = 0;
    int n = facet_factors (g, factor, l);
    for (int a = 0; a < n; a++)
        for (int k = 0; k < n; k++) release += l[a] * l[k] * c->release[a][k];
    double energy = release > 0 && c->energy > 0 ? sqrt (release / c->energy) : 0;
    for (int a = 0; a < n; a++) stress += l[a] * c->stress[a];
    return isnan (c->stress[0]) ? energy : fmax (0, fmin (energy, stress));
}

double facet_utilisation (const break_loop *b, const pg_state *state, double factor)
{
    const facet_growth *g = b->growth;
    double top = in_space (b) ? fronts_plan (b, state, factor) : 0;
    for (size_t i = 0; i < g->ntip && !in_space (b); i++)
        top = fmax (top, facet_judge (b, state, i, factor, NULL, NULL));
    for (size_t k = 0; k < g->ntrial; k++)
        top = fmax (top, facet_trial_utilisation (g, &g->trial[k], factor));
    return top;
}

/* Stores J, K and utilisation at the present load for results. A tip without a ring keeps its earlier
 * values. */
pg_status facet_show (pg_solver *s, const pg_state *state, double factor)
{
    pg_status status = PG_OK;
    const facet_growth *g = s->break_loop.growth;
    double l[2];
    int n = facet_factors (g, factor, l);
    if (in_space (&s->break_loop)) return fronts_show (s, state, factor);
    for (size_t i = 0; i < g->ntip; i++) {
        const pg_tip_field *f = &g->field[i];
        if (isnan (f->near)) continue;
        pg_tip_values v = pg_tip_values_of (state->paths->tip[i].id, 0, f->x, f, n, l);
        v.utilisation = pow (facet_judge (&s->break_loop, state, i, factor, NULL, NULL), 2);
        double trust = facet_trust (g, i);
        v.J *= trust, v.utilisation *= trust;
        for (int m = 0; m < 3; m++) v.K[m] *= sqrt (trust);
        PG_TRY (solver_note_tip (s, &v));
    }
done:
    return status;
}

/* ---- growing ------------------------------------------------------------------------------------------- */
/* Breaks the bonds that crossed a facet: all listed ones, as a further facet sorts its bonds in among
 * them. */
static void kill_listed (const break_loop *b, pg_state *state)
{
    for (size_t i = 0; i < b->changes.n; i++) state->alive[b->changes.bond[i]] = 0;
}

/* Closes tips near the point where a tip met another crack, as they have nowhere to go. */
static pg_status close_others (break_loop *b, pg_state *state, const facet_candidate *c)
{
    pg_status status = PG_OK;
    pg_crack_paths *paths = state->paths;
    for (size_t i = 0; c->close && i < paths->ntip; i++) {
        const pg_tip *tip = &paths->tip[i];
        double d = hypot (tip->x[0] - c->to[0], tip->x[1] - c->to[1]);
        if (!tip->open || (long) i == c->tip || d > 0.6 * b->system.problem->cloud.h) continue;
        PG_TRY (pg_crack_grow (state, b->system.problem, i, c->to, 1, &b->changes));
    }
done:
    return status;
}

/* Warns of a tip without a ring that turns into the surface beside it, as of a hole that the path might pass:
 * the spacing does not resolve which of both it does. */
static void tell_swallowed (break_loop *b, const pg_state *state, const facet_candidate *c)
{
    const pg_tip_field *f = &b->growth->field[c->tip];
    double t[2] = { c->to[0] - f->x[0], c->to[1] - f->x[1] },
           turn = fabs (atan2 (f->e[0] * t[1] - f->e[1] * t[0], f->e[0] * t[0] + f->e[1] * t[1]));
    if (!isnan (f->near) || f->limit != PG_ROOM_SURFACE || turn < 0.2) return;
    pg_statistics_warn_once (b->system.report,
                             "crack tip %ld at (%.6g, %.6g) m went aside into the surface since it came "
                             "within "
                             "%.2g spacings of it (1.5 are needed to judge it): refine to decide whether "
                             "it passes",
                             state->paths->tip[c->tip].id, f->x[0], f->x[1], f->room / f->h);
}

/* Grows one facet and adds its energy. */
static pg_status grow_one (break_loop *b, pg_state *state, const facet_candidate *c)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    const pg_problem *p = b->system.problem;
    /* another tip has run into it in this event */
    if (c->tip >= 0 && !state->paths->tip[c->tip].open) return PG_OK;
    if (c->tip >= 0 && c->close) tell_swallowed (b, state, c);
    if (c->tip >= 0) PG_TRY (pg_crack_grow (state, p, (size_t) c->tip, c->to, c->close, &b->changes));
    else PG_TRY (pg_crack_start (state, p, c->from, c->to, c->open | (c->slides ? PG_START_SLIDES : 0),
                                 &b->changes));
    PG_TRY (close_others (b, state, c));
    kill_listed (b, state);
    g->needed += c->energy, g->event.energy += c->energy, g->event.closed |= c->close,
        g->event.began |= c->tip < 0;
    g->event.going |= c->tip >= 0 ? !c->close : c->open != 0;
    if (g->event.tip < 0 && !(c->tip >= 0 && c->close)) {
        const double *from = c->tip >= 0 ? g->field[c->tip].x : c->from;
        long last = (long) state->paths->ntip - 1;
        g->event.tip = c->tip >= 0 ? c->tip : c->open == 3 ? last - 1 : c->open ? last : -1;
        g->event.length = hypot (c->to[0] - from[0], c->to[1] - from[1]);
    }
done:
    return status;
}

/* 1: two new cracks tie and are no further apart than they are long, so that they are one. */
static int is_near (const facet_candidate *a, const facet_candidate *c)
{
    double d =
        hypot (a->from[0] + a->to[0] - c->from[0] - c->to[0], a->from[1] + a->to[1] - c->from[1] - c->to[1]);
    return 0.5 * d <= hypot (a->to[0] - a->from[0], a->to[1] - a->from[1])
                      + hypot (c->to[0] - c->from[0], c->to[1] - c->from[1]);
}

/* Grows new cracks and tips without room, the best first. Tips keep their numbers while cracks are added. */
static pg_status grow_trials (break_loop *b, pg_state *state, double factor, double least)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    for (size_t done = 0; done < g->ntrial; done++) {
        size_t best = done;
        int skip = 0;
        for (size_t k = done; k < g->ntrial; k++)
            if (facet_trial_utilisation (g, &g->trial[k], factor)
                > facet_trial_utilisation (g, &g->trial[best], factor))
                best = k;
        facet_candidate c = g->trial[best];
        g->trial[best] = g->trial[done], g->trial[done] = c;
        if (facet_trial_utilisation (g, &c, factor) < least) break;
        for (size_t k = 0; k < done; k++)
            skip |= c.tip >= 0 ? g->trial[k].tip == c.tip : g->trial[k].tip < 0 && is_near (&g->trial[k], &c);
        if (skip) continue;
        PG_TRY (grow_one (b, state, &c));
        g->event.tried |= c.tip >= 0;
    }
done:
    return status;
}

/* Logs the broken bonds in ascending order. */
static pg_status log_all (break_loop *b, pg_state *state, double utilisation, double t)
{
    pg_status status = PG_OK;
    pg_sort (b->changes.bond, b->changes.n, sizeof *b->changes.bond, pg_ascending_sizes);
    for (size_t i = 0; i < b->changes.n; i++)
        PG_TRY (break_loop_log (b, b->changes.bond[i], 'f', utilisation, t));
    state->broken += (long) b->changes.n;
    b->system.report->energy.fracture = b->growth->needed;
    b->growth->fresh = 0;
done:
    return status;
}

/* Extends tips without room to the surface. What is left ahead of such a tip carries hardly any load, and the
 * energy to part it cannot be found: it is taken from its length. */
pg_status facet_run_out (break_loop *b, pg_state *state, double t, int *grew)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    b->changes.n = 0, *grew = 0, g->event.closed = 0;
    if (in_space (b)) PG_TRY (fronts_run_out (b, state, grew));
    for (size_t i = 0; i < g->ntip && !in_space (b); i++) {
        facet_candidate c;
        const pg_tip *tip = &state->paths->tip[i];
        if (!tip->open || !(tip->grown > 0) || !isnan (g->field[i].near) || is_tried (g, i)) continue;
        if (!facet_way_out (b, state, i, &c)) continue;
        PG_TRY (grow_one (b, state, &c));
        *grew = 1;
    }
    if (*grew) PG_TRY (log_all (b, state, 1, t));
done:
    return status;
}

/* Grows the facets of an event. Each tip is placed after the ones before it have grown, so that two that run
 * into each other meet. */
pg_status facet_grow (break_loop *b, pg_state *state, double factor, double t)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    double top = facet_utilisation (b, state, factor), angle,
           least = top * (1 - (b->system.contact ? CLOSED_TIE : facet_tie));
    b->changes.n = 0, g->event.closed = g->event.began = g->event.going = g->event.tried = 0,
    g->event.energy = 0, g->event.tip = -1;
    if (in_space (b)) {
        PG_TRY (fronts_grow (b, state, factor, least));
        PG_TRY (log_all (b, state, top, t));
        goto done;
    }
    for (size_t i = 0; i < g->ntip && top > 0; i++) {
        facet_candidate c;
        int slides;
        if (facet_judge (b, state, i, factor, &angle, &slides) < least) continue;
        facet_place (b, state, i, angle, slides, &c);
        PG_TRY (grow_one (b, state, &c));
    }
    PG_TRY (grow_trials (b, state, factor, least));
    PG_TRY (log_all (b, state, top, t));
done:
    return status;
}

pg_status facet_grow_one (break_loop *b, pg_state *state, const facet_candidate *c, double t)
{
    pg_status status = PG_OK;
    b->changes.n = 0;
    PG_TRY (grow_one (b, state, c));
    PG_TRY (log_all (b, state, NAN, t));
done:
    return status;
}

/* ---- a fixed load -------------------------------------------------------------------------------------- */
static pg_status round_at_rest (break_loop *b, pg_state *state, double t, const double *d, pg_step *step,
                                int *over)
{
    pg_status status = PG_OK;
    const pg_solver_options *o = b->system.options;
    *over = 0, b->growth->motion.moving = 0;
    PG_TRY (facet_measure (b, state, NULL, d, t));
    step->utilisation = facet_utilisation (b, state, 1);
    if (!(step->utilisation > 1)) goto done;
    if (step->iterations >= o->max_iterations)
        PG_FAIL (PG_E_EQUILIBRIUM,
                 "cracks still grow after %ld facets at this load (sqrt (G / G0) = %.6g): raise "
                 "solver.max_iterations, take smaller steps, or stepping: event",
                 step->iterations, step->utilisation);
    PG_TRY (facet_grow (b, state, 1, t));
    PG_TRY (system_refresh (&b->system, state, &b->changes));
    *over = 1;
done:
    return status;
}

/* One round of growth. In dynamics what is cut is held, so that there is no second round. */
pg_status facet_round (break_loop *b, pg_state *state, double t, const double *d, const dynamics *dyn,
                       pg_step *step, int *again)
{
    pg_status status = PG_OK;
    int over = 0;
    if (!dyn) return round_at_rest (b, state, t, d, step, again);
    *again = 0;
    if (facet_due (b, dyn->dt)) PG_TRY (facet_move (b, state, t, d, &step->utilisation, &over));
    if (over) PG_TRY (break_loop_account (b, t, d, dyn, 0, 1));
done:
    return status;
}
