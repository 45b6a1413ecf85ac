/* SPDX-License-Identifier: GPL-3.0-or-later
 * Growth of crack surfaces in 3D: an equilibrium, J, K_I, K_II and K_III at every vertex of every front by
 * integrals over a tube around it (crack/fracture/front_measure.c), a plan for all vertices together
 * (front_direction.c), and the surface advances by a strip of triangles
 * (crack/geometry/crack_surfaces.c); every bond
 * that the strip crosses breaks at once. J of a vertex scatters by a per cent or two, so the load of an event
 * is that at which those who lead set as much energy free as they take: the load of the single vertex that
 * comes first would be too low by that scatter. This file: what facet_growth.c asks of fronts; the events are
 * those of facet_events.c. */
#include "solve/contact/contact.h"
#include "front_growth.h"
#include <math.h>
#include <string.h>

void fronts_free (front_growth **fronts)
{
    front_growth *f = *fronts;
    if (!f) return;
    pg_free (f->first), pg_free (f->blind), pg_free (f->vertex);
    pg_free (f->d), pg_free (f->theta), pg_free (f->row), pg_free (f->couple), pg_free (f->factor);
    pg_free (f->forward), pg_free (f->line), pg_free (f->going), pg_free (f->goes);
    pg_free (f);
    *fronts = NULL;
}

/* ---- measuring ----------------------------------------------------------------------------------------- */
pg_status fronts_lay_out (break_loop *b, const pg_state *state)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    size_t nfront;
    const pg_front *front = pg_fronts_of_state (b->system.problem, state, &nfront);
    if (!g->fronts) PG_ALLOC (g->fronts, 1);
    front_growth *f = g->fronts;
    f->n = 0, f->nfront = 0;
    PG_GROW (f->first, f->cap_first, nfront + 1);
    PG_GROW (f->blind, f->cap_blind, nfront + 1);
    for (size_t k = 0; k < nfront; k++) f->first[k] = f->n, f->n += front[k].open ? front[k].n : 0;
    f->first[nfront] = f->n;
    PG_GROW (f->vertex, f->cap_vertex, f->n);
    PG_GROW (f->d, f->cap_d, f->n);
    PG_GROW (f->theta, f->cap_theta, f->n);
    PG_GROW (f->row, f->cap_row, f->n);
    memset (f->vertex, 0, f->n * sizeof *f->vertex);
    f->nfront = nfront;
    PG_TRY (fronts_couple (f, front));
done:
    return status;
}

/* Finds the nearest measured vertices along the front: one, or two at the same distance on both sides.
 * Returns how many. */
static size_t nearest_known (const unsigned char *known, size_t n, int closed, size_t i, size_t at[2])
{
    size_t found = 0;
    for (size_t far = 1; far < n && !found; far++) {
        size_t back = i >= far ? i - far : i + n - far, on = i + far < n ? i + far : i + far - n;
        if ((closed || i >= far) && known[back]) at[found++] = back;
        if ((closed || i + far < n) && known[on] && !(found && on == back)) at[found++] = on;
    }
    return found;
}

/* out = mean of the values of two vertices. */
static void add_half (pg_tip_field *out, const pg_tip_field *other)
{
    double a[PG_TIP_NUMBERS], b[PG_TIP_NUMBERS];
    memcpy (a, out, sizeof a), memcpy (b, other, sizeof b);
    for (int q = 0; q < PG_TIP_NUMBERS; q++) a[q] = 0.5 * (a[q] + b[q]);
    memcpy (out, a, sizeof a);
    out->near = fmin (out->near, other->near), out->wide = fmin (out->wide, other->wide);
}

/* out = values for a vertex that has just left closed faces and has no room around it yet: the stress
 * intensity that made its first facet open, and the direction straight on. from: a closed vertex beside
 * it. */
static void as_opened (pg_tip_field *out, const pg_tip_field *from, int nfield)
{
    double II = from->K_wide[1][0], III = from->K_wide[2][0], theta, K, G, of_K[2];
    if (nfield == 2) II += from->K_wide[1][1], III += from->K_wide[2][1];
    double J = (II * II + from->antiplane * III * III) / from->modulus;
    int turns = pg_kink (J, 0, II, NAN, 0, &theta, &K, &G);
    double c = turns ? cos (0.5 * theta) : 1, A = turns ? K / c : 0, root = hypot (A, 2 * III);
    /* K_v = c / 2 (A + root) by its derivatives with respect to K_II and K_III, as it is homogeneous */
    of_K[0] = II != 0 ? 0.5 * c * (A + (root > 0 ? A * A / root : 0)) / II : 0;
    of_K[1] = root > 0 ? 2 * c * III / root : 0;
    out->closed = 0;
    for (int a = 0; a < nfield; a++) {
        out->K[0][a] = of_K[0] * from->K_wide[1][a] + of_K[1] * from->K_wide[2][a];
        out->K_wide[0][a] = out->K[0][a];
        for (int k = 1; k < 3; k++) out->K[k][a] = out->K_wide[k][a] = 0;
    }
    pg_tip_energy (out, nfield, out->K, out->J), pg_tip_energy (out, nfield, out->K, out->J_near);
}

/* How unsuitable the values of another vertex are: those whose faces touch or not, unlike its own (closed),
 * count 2, extrapolated ones 1. */
static int unlike (const pg_tip_field *from, int closed)
{
    return 2 * (from->closed != closed) + from->extrapolated;
}

/* The values that vertex i may take over: of its nearest known neighbour, or the mean of two that are as
 * near. */
static pg_tip_field shown_beside (const pg_tip_field *field, const pg_front *front,
                                  const unsigned char *known, size_t i, int closed)
{
    size_t at[2] = { 0 }, found = nearest_known (known, front->n, front->closed, i, at);
    int less[2] = { 0 };
    for (size_t k = 0; k < found; k++) less[k] = unlike (&field[at[k]], closed);
    pg_tip_field from = field[at[found == 2 && less[1] < less[0]]];
    if (found == 2 && less[0] == less[1]) add_half (&from, &field[at[1]]);
    return from;
}

/* Gives vertices without room for a tube the values of their neighbours, but not where materials of different
 * stiffness meet: these stay where they are, as does a front without any values. faces: contact behind the
 * vertices, or NULL. */
static int fill_gaps (pg_tip_field *field, const pg_front *front, int nfield, const pg_front_faces *faces,
                      unsigned char *known)
{
    size_t n = front->n, gaps = 0;
    for (size_t i = 0; i < n; i++) known[i] = (unsigned char) !isnan (field[i].near), gaps += !known[i];
    for (size_t i = 0; gaps && gaps < n && i < n; i++) {
        int closed = faces && faces[i].closed;
        if (known[i] || field[i].interface) continue;
        const pg_tip_field own = field[i], from = shown_beside (field, front, known, i, closed);
        field[i] = from;
        memcpy (field[i].x, own.x, sizeof own.x), memcpy (field[i].e, own.e, sizeof own.e);
        memcpy (field[i].normal, own.normal, sizeof own.normal);
        field[i].h = own.h, field[i].room = own.room;
        if (faces && from.closed && !closed && front->grown[i] > 0) as_opened (&field[i], &from, nfield);
    }
    return gaps == n;
}

/* A vertex of front k at which materials of different stiffness meet; NULL: there is none. */
static const pg_tip_field *at_interface (const facet_growth *g, size_t k)
{
    for (size_t i = g->fronts->first[k]; i < g->fronts->first[k + 1]; i++)
        if (g->field[i].interface) return &g->field[i];
    return NULL;
}

/* Mean J of front k over its vertices, J/m^2; *apart: mean difference to J by the next smaller tube. 0: each
 * vertex has one tube only. */
static double mean_release (const facet_growth *g, size_t k, double *apart)
{
    const front_growth *f = g->fronts;
    double l[2], J = 0, length = 0;
    int n = facet_factors (g, 1, l);
    *apart = 0;
    for (size_t i = f->first[k]; i < f->first[k + 1]; i++) {
        const pg_tip_field *at = &g->field[i];
        double one, off = pg_tip_uncertainty (at, n, l);
        if (isnan (off)) continue;
        pg_tip_combine (at, n, l, &one, NULL, NULL);
        J += at->length * fabs (one), *apart += at->length * fabs (one) * off, length += at->length;
    }
    if (length > 0) *apart /= length;
    return length > 0 ? J / length : 0;
}

/* Warns where J of two tubes differs by more than a tenth in the mean, of a front that may decide. */
static void doubt_release (const break_loop *b, const pg_front *front, size_t nfront)
{
    static const double doubtful = 0.1, decisive = 0.25;
    facet_growth *g = b->growth;
    const front_growth *f = g->fronts;
    double top = 0, apart;
    if (g->said & FACET_SAID_UNKNOWN || g->motion.moving) return;
    for (size_t k = 0; k < nfront; k++) if (front[k].open) top = fmax (top, mean_release (g, k, &apart));
    for (size_t k = 0; k < nfront && !(g->said & FACET_SAID_UNKNOWN); k++) {
        double J = front[k].open ? mean_release (g, k, &apart) : 0;
        const pg_tip_field *at = &g->field[f->first[k]];
        if (!(J > decisive * top) || !(apart > doubtful * J)) continue;
        pg_statistics_warn (b->system.report,
                            "the energy release rate of crack front %ld at (%.6g, %.6g, %.6g) m is known to "
                            "+-%.2g %% only: tubes of two radii up to %.2g spacings differ by that much; "
                            "take a smaller spacing, and look for what lies within %.3g m of it",
                            front[k].id, at->x[0], at->x[1], at->x[2], 100 * apart / J, at->wide / at->h,
                            at->wide);
        g->said |= FACET_SAID_UNKNOWN;
    }
}

void fronts_tell (const break_loop *b, const pg_state *state)
{
    facet_growth *g = b->growth;
    const front_growth *f = g->fronts;
    size_t open = 0, nfront;
    const pg_front *front = pg_fronts_of_state (b->system.problem, state, &nfront);
    doubt_release (b, front, nfront);
    for (size_t k = 0; k < nfront; k++) {
        open += front[k].open != 0;
        if (!front[k].open) continue;
        const double *x = front[k].x;
        if (f->blind[k] && !at_interface (g, k) && state->events == 0 && !(g->said & FACET_SAID_ROOM)) {
            char what[80];
            pg_tip_limit_words (b->system.problem, &g->field[f->first[k]], what, sizeof what);
            pg_statistics_warn (b->system.report,
                                "no room for integrals around any vertex of crack front %ld at (%.6g, %.6g, "
                                "%.6g) m (%s is within 1.5 spacings): it does not grow; take a smaller "
                                "spacing",
                                front[k].id, x[0], x[1], x[2],
                                g->field[f->first[k]].limit == PG_ROOM_LOAD ? what : "a surface or a crack");
            g->said |= FACET_SAID_ROOM;
        }
        const pg_tip_field *held = at_interface (g, k);
        if (held && !(g->said & FACET_SAID_INTERFACE)) {
            pg_statistics_warn (b->system.report,
                                "crack front %ld comes within 1.5 spacings of where materials of unlike "
                                "stiffness meet, at (%.6g, %.6g, %.6g) m: J is not known there, and it goes "
                                "no further",
                                front[k].id, held->x[0], held->x[1], held->x[2]);
            g->said |= FACET_SAID_INTERFACE;
        }
        for (size_t i = f->first[k]; i < f->first[k + 1] && !f->blind[k]; i++) {
            double l[2], K[3];
            const pg_tip_field *at = &g->field[i];
            pg_tip_combine (at, facet_factors (g, 1, l), l, NULL, K, NULL);
            if (b->system.contact) break;
            if (!(K[0] < 0 && fabs (K[0]) > 1e-2 * hypot (K[1],
                                                          K[2])) || g->said & FACET_SAID_CLOSED) continue;
            pg_statistics_warn (b->system.report,
                                "crack front %ld closes at (%.6g, %.6g, %.6g) m (K_I = %.3g, K_II = %.3g, "
                                "K_III = %.3g Pa m^(1/2) at full load) and its faces overlap: contact is not "
                                "modelled, growth is not to be trusted there",
                                front[k].id, at->x[0], at->x[1], at->x[2], K[0], K[1], K[2]);
            g->said |= FACET_SAID_CLOSED;
        }
    }
    if (open || g->ntrial || g->said & FACET_SAID_NOTHING) return;
    pg_statistics_warn (b->system.report, "no crack can grow: there is no open front%s",
                        nfront ? " any more" : ", and no new crack begins up to full load");
    g->said |= FACET_SAID_NOTHING;
}

pg_status fronts_measure (break_loop *b, const pg_state *state, const double *const *d, const double *t)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    pg_system *s = &b->system;
    unsigned char *known = NULL;
    pg_front_faces *faces = NULL;
    size_t nfront, cap_faces = 0;
    const pg_front *front = pg_fronts_of_state (s->problem, state, &nfront);
    front_growth *f = g->fronts;
    PG_ALLOC (known, f->n);
    for (size_t k = 0; k < nfront; k++) {
        f->blind[k] = 0;
        if (!front[k].open || !front[k].n) continue;
        if (s->contact) {
            PG_GROW (faces, cap_faces, front[k].n);
            contact_at_front (s, &front[k], g->nfield, 1, faces);
        }
        PG_TRY (pg_front_measure (g->field + f->first[k], s->problem, s->force, s->self, state, k,
                                        g->nfield, d, t, s->contact ? faces : NULL));
        for (size_t i = f->first[k]; s->contact && i < f->first[k + 1]; i++)
            facet_settle_energy (&g->field[i], g->nfield);
        f->blind[k] = (unsigned char) fill_gaps (g->field + f->first[k], &front[k], g->nfield,
                                                 s->contact ? faces : NULL, known);
    }
done:
    pg_free (known), pg_free (faces);
    return status;
}

/* ---- growing ------------------------------------------------------------------------------------------- */
static size_t open_vertices (const pg_problem *p, const pg_state *state)
{
    size_t nfront, n = 0;
    const pg_front *front = pg_fronts_of_state (p, state, &nfront);
    for (size_t k = 0; k < nfront; k++) n += front[k].open ? front[k].n : 0;
    return n;
}

/* Advances front k by the ways in f->d and the angles in f->theta; need: mean energy that it takes, J/m^2. */
static pg_status advance (break_loop *b, pg_state *state, size_t k, double need)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    const front_growth *f = g->fronts;
    double area = state->surfaces->area;
    PG_TRY (pg_front_advance (state, b->system.problem, k, f->d + f->first[k], f->theta + f->first[k],
                              &b->changes));
    for (size_t i = 0; i < b->changes.n; i++) state->alive[b->changes.bond[i]] = 0;
    g->needed += need * (state->surfaces->area - area),
        g->event.energy += need * (state->surfaces->area - area);
done:
    return status;
}

/* 1: this front is still as measured; another one that grew before it in this event may have met it. */
static int is_as_measured (const front_growth *f, const pg_front *front, size_t k)
{
    return front[k].open && front[k].n > 0 && front[k].n == f->first[k + 1] - f->first[k];
}

/* Warns of a sharp turn of a front (3D): tubes around the next fronts include it, while their fields are
 * those of a straight crack (doc/accuracy.md, "Behind a kink"). theta, d: angle and way of each vertex of
 * front k. */
static void doubt_turn (break_loop *b, const pg_front *front, const double *d, const double *theta)
{
    static const double sharp = 0.7;                   /* rad: 3 % of the load at .79, 31 % at 1.23 */
    facet_growth *g = b->growth;
    double most = 0;
    size_t at = 0;
    for (size_t i = 0; i < front->n; i++)
        if (d[i] > 0 && fabs (theta[i]) > most) most = fabs (theta[i]), at = i;
    if (!(most > sharp) || g->said & FACET_SAID_KINKED) return;
    const double *x = front->x + 3*at;
    pg_statistics_warn (b->system.report,
                        "crack front %ld turns by %.0f degrees at (%.4g, %.4g, %.4g) m: the load is not "
                        "known well for the next two strips (behind a turn of 70 degrees +31 and -4 %%, of "
                        "45 -3 and -1 %%, against the plane)",
                        front->id, most * 57.295779513082320877, x[0], x[1], x[2]);
    g->said |= FACET_SAID_KINKED;
}

/* Grows the strips of all fronts by the present plan. */
static pg_status grow_planned (break_loop *b, pg_state *state)
{
    pg_status status = PG_OK;
    const front_growth *f = b->growth->fronts;
    const pg_problem *p = b->system.problem;
    size_t nfront;
    for (size_t k = 0; k < f->nfront; k++) {
        const pg_front *front = pg_fronts_of_state (p, state, &nfront);
        const front_vertex *v = f->vertex + f->first[k];
        double taken = 0, grown = 0;
        if (!is_as_measured (f, front, k)) continue;
        for (size_t i = 0; i < front[k].n; i++) {
            f->d[f->first[k] + i] = v[i].way;
            f->theta[f->first[k] + i] = v[i].way > 0 ? asin (v[i].rise / v[i].way) : 0;
            taken += v[i].need * v[i].way * v[i].width, grown += v[i].way * v[i].width;
        }
        doubt_turn (b, &front[k], f->d + f->first[k], f->theta + f->first[k]);
        if (grown > 0) PG_TRY (advance (b, state, k, taken / grown));
    }
done:
    return status;
}

pg_status fronts_grow (break_loop *b, pg_state *state, double factor, double least)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    const pg_problem *p = b->system.problem;
    if (fronts_plan (b, state, factor) >= least) PG_TRY (grow_planned (b, state));
    for (size_t k = 0; k < g->ntrial; k++)
        if (facet_trial_utilisation (g, &g->trial[k], factor) >= least)
            PG_TRY (fronts_start (b, state, &g->trial[k]));
    size_t open = open_vertices (p, state);
    g->event.going = open > 0, g->event.closed |= open == 0;
done:
    return status;
}

/* Extends fronts without room straight on. What is left ahead of such a front carries hardly any load: its
 * energy is taken from its area. */
pg_status fronts_run_out (break_loop *b, pg_state *state, int *grew)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    const front_growth *f = g->fronts;
    const pg_problem *p = b->system.problem;
    size_t nfront;
    for (size_t k = 0; k < f->nfront; k++) {
        const pg_front *front = pg_fronts_of_state (p, state, &nfront);
        pg_fracture_limits limits;
        double need = 0, far = 0;
        if (!is_as_measured (f, front, k) || !f->blind[k] || at_interface (g, k)) continue;
        for (size_t i = 0; i < front[k].n; i++) {
            size_t at = f->first[k] + i;
            int can = facet_limits (b, g->field[at].x, 0, &limits);
            f->d[at] = can ? facet_length (g, &g->field[at]) : 0, f->theta[at] = 0;
            if (can) need += limits.energy, far++;
        }
        for (size_t i = 0; i < front[k].n; i++) if (front[k].grown[i] > 0) *grew = 1;
        if (!*grew || !(far > 0)) continue;
        PG_TRY (advance (b, state, k, need / far));
    }
done:
    return status;
}

/* ---- results ------------------------------------------------------------------------------------------- */
/* Stores values at the vertices for results: K in the ratios of the interaction integrals, with the magnitude
 * of J, sqrt (E' J). */
pg_status fronts_show (pg_solver *s, const pg_state *state, double factor)
{
    pg_status status = PG_OK;
    const facet_growth *g = s->break_loop.growth;
    const front_growth *f = g->fronts;
    double l[2];
    int n = facet_factors (g, factor, l);
    size_t nfront;
    const pg_front *front = pg_fronts_of_state (s->problem, state, &nfront);
    s->ntip = 0;
    for (size_t k = 0; k < f->nfront; k++)
        for (size_t i = f->first[k]; i < f->first[k + 1]; i++) {
            const pg_tip_field *at = &g->field[i];
            pg_tip_values out = pg_tip_values_of (front[k].id, i - f->first[k], at->x, at, n, l);
            front_vertex v = { 0 };
            front_judge (&s->break_loop, at, factor, &v);
            if (!isnan (at->near)) out.utilisation = v.share * v.share;
            PG_TRY (solver_note_tip (s, &out));
        }
done:
    return status;
}
