/* SPDX-License-Identifier: GPL-3.0-or-later
 * Short-range contact and platens in explicit steps (perigal/contact.h): their forces are added to the
 * residual of the body, and kept in a list of their own for the work of the body's forces alone; their
 * energies are counted separately. */
#include "explicit.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

pg_status explicit_contact_create (pg_solver *s)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    const pg_system *sys = &s->break_loop.system;
    const pg_contact_setting *setting = &s->options.contact;
    int pairs = setting->kind != PG_CONTACT_NONE && setting->search == PG_CONTACT_SHORT_RANGE;
    if (!pairs && !s->problem->boundary.nplaten) return PG_OK;
    PG_ALLOC (m->contact, 1);
    if (pairs)
        PG_TRY (pg_short_range_create (&m->contact->pairs, s->problem, setting, (size_t) sys->components));
    if (pairs && sys->force->surfaces.at_nodes && !s->problem->form.approx.type->interpolates) {
        PG_ALLOC (m->contact->moved, sys->ndof);
        PG_ALLOC (m->contact->speed, sys->ndof);
        PG_ALLOC (m->contact->pressed, sys->ndof);
        PG_ALLOC (m->contact->taken, sys->ndof);
    }
    if (pairs && setting->impulses) {
        PG_ALLOC (m->contact->back, sys->ndof);
        PG_ALLOC (m->contact->ahead, sys->ndof);
        PG_ALLOC (m->contact->inverse, sys->ndof);
    }
    if (!s->problem->boundary.nplaten) goto done;
    PG_ALLOC (m->contact->shown, s->problem->boundary.nplaten);
    s->moving = m->contact->shown;
    PG_TRY (pg_moving_platens_create (&m->contact->platens, s->problem, setting, (size_t) sys->components));
done:
    return status;
}

/* Frees the contact of an explicit method, also one that was made in part only. */
void explicit_contact_free (pg_solver *s)
{
    struct explicit_contact *c = motion_of (s)->contact;
    if (!c) return;
    pg_short_range_free (&c->pairs);
    pg_moving_platens_free (&c->platens);
    pg_free (c->shown);
    pg_free (c->moved), pg_free (c->speed), pg_free (c->pressed), pg_free (c->taken);
    pg_free (c->back), pg_free (c->ahead), pg_free (c->inverse);
    pg_free (c);
    motion_of (s)->contact = NULL, s->moving = NULL;
}

double explicit_contact_rate (const pg_solver *s)
{
    const struct explicit_contact *c = motion_of (s)->contact;
    return (c && c->pairs ? pg_short_range_rate (c->pairs) : 0)
           + (c && c->platens ? pg_moving_platens_rate (c->platens) : 0);
}

double explicit_contact_kinetic (const pg_solver *s)
{
    const struct explicit_contact *c = motion_of (s)->contact;
    return c && c->platens ? pg_moving_platens_now (c->platens)->kinetic : 0;
}

/* Warns where a point has so many contacts at once that the time step may be unstable. */
static void doubt (pg_solver *s)
{
    const motion *m = motion_of (s);
    struct explicit_contact *c = m->contact;
    double rate = (c->pairs ? pg_short_range_now (c->pairs)->rate : 0)
                  + (c->platens ? pg_moving_platens_now (c->platens)->rate : 0),
           dt = s->options.dt;
    if (c->pairs && pg_short_range_now (c->pairs)->unsettled && !c->warned) {
        c->warned = 1;
        pg_statistics_warn (&s->report, "points that press on each other from many sides were not held apart "
                            "to the last digit in a time step: compare with solver.dt: %.3g s", 0.5 * dt);
    }
    if (c->warned || !(dt * dt * (c->bare * c->bare + rate) > 4)) return;
    c->warned = 1;
    pg_statistics_warn (&s->report,
                        "more points press on one than the time step counts on: it may be unstable; compare "
                        "with solver.dt: %.3g s", 1.8 / sqrt (c->bare * c->bare + rate));
}

/* Adds the forces of pairs to the residual f. Contact acts on points: where unknowns are not displacements of
 * points, these are found from them, and forces turned back by the transposed map, so that work is the same
 * and, as shape functions add up to one, momentum is kept. */
static pg_status add_pairs (struct explicit_contact *c, const pg_system *sys, const pg_state *state,
                            const pg_changes *broken, double dt, double way, double *f)
{
    pg_status status = PG_OK;
    if (!c->moved) return pg_short_range_add (c->pairs, state, broken, !broken, state->v, dt, way, f);
    pg_state points = *state;
    points.d = c->moved, points.v = c->speed;
    sys->force->surfaces.at_nodes (sys->self, state->d, c->moved);
    sys->force->surfaces.at_nodes (sys->self, state->v, c->speed);
    memset (c->pressed, 0, sys->ndof * sizeof *f);
    memset (c->taken, 0, sys->ndof * sizeof *f);
    /* it is not known how far shape functions move the points, which are therefore all checked */
    PG_TRY (pg_short_range_add (c->pairs, &points, broken, !broken, c->speed, dt, INFINITY, c->pressed));
    sys->force->surfaces.from_nodes (sys->self, c->pressed, c->taken);
    for (size_t i = 0; i < sys->ndof; i++) f[i] += c->taken[i];
done:
    return status;
}

/* ---- impulses ------------------------------------------------------------------------------------------ */
/* Displacement increments of a range of unknowns, by leapfrog in both forms (verlet.c, central.c). */
typedef struct { const pg_solver *s; const pg_state *state; double dt, keep, push; } going;
static void see_ways (void *context, size_t first, size_t last, int thread)
{
    const going *g = context;
    const motion *m = motion_of (g->s);
    const struct explicit_contact *c = m->contact;
    const double *f = g->s->break_loop.system.balance.residual;
    (void) thread;
    for (size_t i = first; i < last; i++) {
        c->back[i] = g->dt * g->state->v[i], c->inverse[i] = m->inverse[i];
        c->ahead[i] = g->dt * (g->keep * g->state->v[i] + g->push * f[i] * m->inverse[i]);
    }
}

/* Keeps pairs apart by impulses. Bodies that touch and approach at the start collide there: after the first
 * step they have the velocities after the collision. */
static pg_status hold_pairs (pg_solver *s, pg_state *state, const pg_changes *broken, double way, int first)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    struct explicit_contact *c = m->contact;
    pg_system *sys = &s->break_loop.system;
    double damping = PG_OWN (pg_explicit_options, &s->options)->rayleigh_mass, dt = s->options.dt,
        h = 0.5 * dt,
           less = 1 / (1 + h * damping);
    going g = { s, state, dt, first ? 1 - h * damping : (1 - h * damping) * less, first ? h : dt * less };
    pg_point_ways ways = { c->back, c->ahead, c->inverse, dt * (first ? dt : g.push), first };
    pg_parallel (s->problem->threads, sys->ndof, see_ways, &g);
    for (size_t k = 0; k < m->nprescribed; k++) {
        size_t i = m->prescribed[k];
        c->back[i] = m->goal[k] - m->before[k], c->ahead[i] = m->next[k] - m->goal[k], c->inverse[i] = 0;
    }
    if (first) memset (sys->balance.full, 0, sys->ndof * sizeof *sys->balance.full);
    PG_TRY (pg_short_range_hold (c->pairs, state, broken, !broken, &ways, way,
                                 first ? sys->balance.full : sys->balance.residual));
    for (size_t i = 0; first && i < sys->ndof; i++) state->v[i] += dt * c->inverse[i] * sys->balance.full[i];
done:
    return status;
}

/* Velocities of prescribed unknowns, which are zero inside a step, are set to those of their motion
 * meanwhile. */
pg_status explicit_contact_add (pg_solver *s, pg_state *state, double t, int first)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    struct explicit_contact *c = m->contact;
    pg_system *sys = &s->break_loop.system;
    double dt = first ? 0 : s->options.dt, t0 = pg_seconds (), *f = sys->balance.residual,
           way = first ? 0 : c ? c->way * sqrt ((double) s->problem->dim) : 0;
    if (!c) return PG_OK;
    for (size_t k = 0; !first && k < m->nprescribed; k++)
        state->v[m->prescribed[k]] = (m->goal[k] - m->before[k]) / dt;
    const pg_changes *broken = &s->break_loop.changes;
    int known = c->broken + (long) broken->n == state->broken;
    if (c->pairs && !c->back) status = add_pairs (c, sys, state, known ? broken : NULL, dt, way, f);
    if (status == PG_OK && c->platens) {
        double before = pg_moving_platens_now (c->platens)->work;
        status = pg_moving_platens_add (c->platens, state->d, state->v, t, dt, s->options.dt, way,
                                        f);
        s->break_loop.work += pg_moving_platens_now (c->platens)->work - before;
    }
    if (!first) explicit_release (s, state);
    PG_TRY (status);
    if (c->back) PG_TRY (hold_pairs (s, state, known ? broken : NULL, way, first));
    c->broken = state->broken;
    c->active = (c->pairs && pg_short_range_now (c->pairs)->touching > 0)
                || (c->platens && pg_moving_platens_now (c->platens)->touching > 0);
    doubt (s);
done:
    s->report.seconds[PG_SECONDS_FORCE] += pg_seconds () - t0;
    return status;
}

int explicit_contact_active (const pg_solver *s)
{
    const struct explicit_contact *c = motion_of (s)->contact;
    return c && c->active;
}

void explicit_contact_forces (const pg_solver *s, double *out)
{
    const struct explicit_contact *c = motion_of (s)->contact;
    const double *pairs = c->moved ? c->taken : c->pairs ? pg_short_range_forces (c->pairs) : NULL,
                 *platens = c->platens ? pg_moving_platens_forces (c->platens) : NULL;
    for (size_t i = 0; i < s->break_loop.system.ndof; i++)
        out[i] += (pairs ? pairs[i] : 0) + (platens ? platens[i] : 0);
}

static void show_platens (const struct explicit_contact *c, pg_statistics *r, size_t n)
{
    const pg_moving_report *now = pg_moving_platens_now (c->platens);
    r->energy.contact += now->energy, r->energy.friction += now->friction, r->energy.kinetic += now->kinetic;
    r->contact.overlap_max = fmax (r->contact.overlap_max, now->overlap_max),
    r->contact.touching += (long) now->touching;
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            c->shown[i].force[k] = now->platen[i].force[k],
            c->shown[i].motion[k] = now->platen[i].displacement[k];
}

/* Writes energies, friction and overlap of contact into the report, and the work that was skipped. */
void explicit_contact_show (pg_solver *s)
{
    const struct explicit_contact *c = motion_of (s)->contact;
    pg_statistics *r = &s->report;
    char what[96];
    if (!c) return;
    r->energy.contact = r->energy.friction = r->contact.overlap_max = 0, r->contact.touching = 0;
    if (c->platens) show_platens (c, r, s->problem->boundary.nplaten);
    if (!c->pairs) return;
    const pg_short_range_report *now = pg_short_range_now (c->pairs);
    r->energy.contact += now->energy, r->energy.friction += now->friction;
    r->contact.overlap_max = fmax (r->contact.overlap_max, now->overlap_max);
    r->contact.pairs = (long) now->listed, r->contact.touching += (long) now->touching;
    if (now->evaluations > now->searches) {
        snprintf (what, sizeof what, "search for contact in %ld steps", now->evaluations - now->searches);
        pg_statistics_skip (r, NAN, what, "no point had moved half the skin of the last search");
    }
    if (now->free) {
        snprintf (what, sizeof what, "forces of contact in %ld steps", now->free);
        pg_statistics_skip (r, NAN, what, "no two points without a bond were near each other");
    }
}

/* Saves, at the start of a row, what a refused row returns to. */
pg_status explicit_contact_save (pg_solver *s)
{
    struct explicit_contact *c = motion_of (s)->contact;
    if (!c) return PG_OK;
    c->energy0 = s->report.energy.contact, c->friction0 = s->report.energy.friction;
    if (c->platens) pg_moving_platens_save (c->platens);
    return c->pairs ? pg_short_range_save (c->pairs) : PG_OK;
}

void explicit_contact_return (pg_solver *s)
{
    struct explicit_contact *c = motion_of (s)->contact;
    if (!c) return;
    if (c->platens) pg_moving_platens_return (c->platens);
    if (c->pairs) pg_short_range_return (c->pairs);    /* there is memory: the pairs have fitted before */
    s->report.energy.contact = c->energy0, s->report.energy.friction = c->friction0;
    c->broken = -1;
}

/* Energy that contact has taken up since the row began, J. */
double explicit_contact_took (const pg_solver *s)
{
    const struct explicit_contact *c = motion_of (s)->contact;
    return c ? s->report.energy.contact - c->energy0 + s->report.energy.friction - c->friction0 : 0;
}

pg_status explicit_contact_keep (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    struct explicit_contact *c = motion_of (s)->contact;
    if (!c) return PG_OK;
    PG_TRY (pg_keep_fields (k, "contact", "warned", "energies", 1, PG_ROWS (
        PG_KEPT (c->warned), PG_KEPT (c->energy0), PG_KEPT (c->friction0))));
    if (k->reading) c->broken = -1;
    if (c->pairs) PG_TRY (pg_short_range_keep (c->pairs, k));
    if (c->platens) PG_TRY (pg_moving_platens_keep (c->platens, k));
done:
    return status;
}
