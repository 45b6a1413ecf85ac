/* SPDX-License-Identifier: GPL-3.0-or-later
 * Facets in dynamics. A tip does not jump from facet to facet as in statics: it moves at the speed v at
 * which it takes what the material takes, G (v) = G0, with (Freund 1990, Dynamic Fracture Mechanics, section
 * 6.4, exact to a few percent)
 *
 *   G (v) = g (v) G (0),   g (v) = 1 - v / c_R,
 *
 * G (0) what a tip that stands there would release, c_R the speed of the Rayleigh wave of the material.
 * The integrals around the tip with their kinetic terms give what the tip takes as it runs, G (v): so
 *
 *   g_next = G0 / G (0) = g_now G0 / G (v),   v_next = c_R (1 - g_next), at least 0.
 *
 * A standing tip starts at the speed of that formula; a tip that runs goes on unchanged where G (v) = G0,
 * whatever the formula is worth: it only says by how much the speed is corrected. g_now is a mean over the
 * time that a Rayleigh wave takes for half a spacing: the field around the tip is that of a little while
 * ago.
 *
 * The rings lie where the facets open and short waves leave the tip: at 0.75 c_R they miss a seventh of what
 * it takes. What the facets dissipate is known to the last bit, though only when they have opened: it is the
 * work of the forces that hold them. So G (v) is what the rings show times what the facets of the last two
 * spacings of its way took over what the rings had promised for them (compare).
 *
 * A facet is cut when a tip begins to run and when it has come to the end of the one before; behind the tip
 * it opens (facet_hold.c). The field of the near ring answers to a turn only when the crack has gone on for
 * a few spacings and waves have told of it: of the turn that it asks for a running tip takes a part in each
 * facet, lest it swing. New cracks do not begin in dynamics. */
#include "facet_growth.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Times over which g_now, and the g that decides on branching, are averaged, in spacings travelled by a
 * Rayleigh wave. */
static const double memory = 0.5, steadiness = 4;
static const double part_of_turn = 0.3;
/* An event leaves its tip at G = G0, an unstable equilibrium that would take forever to leave: along the
 * facet of the event its speed is at least this share of c_R. */
static const double set_off = 0.1;
/* Bounds of the correction of rings (a factor); path over which dissipated energies are averaged, in
 * zones. */
static const double most_trust = 2, recent = 0.5;
static const double between = 0.25;  /* least path of a Rayleigh wave between two looks, spacings */

/* Path of a tip over which a facet opens, in facets; bonds between points, which reach over three spacings
 * and more, need less. */
double facet_zone (const break_loop *b) { return b->system.problem->method->shape_functions ? 4 : 2; }

void facet_doubt_step (break_loop *b, double dt)
{
    const pg_problem *p = b->system.problem;
    double c_R = 0, length = b->growth->length > 0 ? b->growth->length : p->cloud.h;
    for (size_t m = 0; m < p->nmaterial; m++)
        c_R = fmax (c_R, pg_material_waves (&p->material[m]).rayleigh);
    if (!(dt * c_R > 0.5 * length)) return;
    pg_statistics_warn (b->system.report,
                        "a Rayleigh wave comes %.3g facets far in a time step of %.4g s, and a tip grows by "
                        "at most one: speeds of cracks are not to be trusted; take solver.dt below %.3g s",
                        dt * c_R / length, dt, 0.5 * length / c_R);
}

/* Allocates the data of tips; a new tip has not moved yet. */
pg_status facet_make_room (facet_growth *g, size_t ntip)
{
    pg_status status = PG_OK;
    PG_GROW (g->motion.run, g->motion.cap_run, ntip);
    for (; g->motion.nrun < ntip; g->motion.nrun++)
        g->motion.run[g->motion.nrun] = (facet_run){ .mean = 1, .steady = 1, .g = 1 };
done:
    return status;
}

/* Rayleigh wave speed of the material at x, m/s. */
static double rayleigh_speed (const break_loop *b, const double *x)
{
    const pg_problem *p = b->system.problem;
    long node = pg_nearest_find (b->growth->near, x, NULL, NULL);
    return node < 0 ? 0 : pg_material_waves (pg_problem_law (p, PG_NODES, (size_t) node)).rayleigh;
}

void facet_forward (break_loop *b, double dt)
{
    facet_growth *g = b->growth;
    int ends = !isfinite (dt);
    for (size_t i = 0; i < g->motion.nrun; i++) {
        facet_run *r = &g->motion.run[i];
        r->way = ends ? r->length : r->way + r->speed * dt;
        r->come += ends ? 0 : r->speed * dt;
    }
    for (size_t k = 0; k < g->motion.nhold; k++) {
        facet_hold *h = &g->motion.hold[k];
        h->way = ends ? h->length : h->way + g->motion.run[h->tip].speed * dt;
    }
    if (ends) facet_hold_drop (b, 0);
    else facet_hold_sum (b);
}

double facet_trust (const facet_growth *g, size_t i)
{
    if (!g->motion.moving || i >= g->motion.nrun || !(g->motion.run[i].shown > 0)) return 1;
    return fmin (most_trust, fmax (1 / most_trust, g->motion.run[i].taken / g->motion.run[i].shown));
}

/* Finds the speed of a tip for the next steps. share: G (v) / G0; dt: time since it was last judged, s. */
static void pace (facet_run *r, double share, double c_R, double h, double dt)
{
    double g = share > r->mean ? r->mean / share : 1, way = dt * c_R / h;
    r->g = g;
    r->speed = c_R * (1 - g);
    if (r->way < r->length) r->speed = fmax (r->speed, r->least);
    r->mean += (isfinite (dt) ? 1 - exp (-way / memory) : 1) * (g - r->mean);
    r->steady += (isfinite (dt) ? 1 - exp (-way / steadiness) : 1) * (g - r->steady);
}

/* Compares the energy that the facets of tip i dissipate with that of the rings, along the last half of a
 * zone. At a standing tip rings are right, and work of its faces under constant forces comes back: there both
 * become equal within the time that a Rayleigh wave takes for a zone (way: its path, m). */
static void compare (break_loop *b, size_t i, const double *d, double share, double way)
{
    facet_growth *g = b->growth;
    facet_run *r = &g->motion.run[i];
    double taken, needed, zone = facet_zone (b) * facet_length (g, &g->field[i]);
    facet_hold_account (b, i, d, &taken, &needed);
    if (r->come > 0 && needed > 0) {
        double fade = exp (-r->come / (recent * zone));
        r->taken = fade * r->taken + taken, r->shown = fade * r->shown + share * needed;
    } else if (!(r->come > 0) && isfinite (way)) r->taken += (1 - exp (-way / zone)) * (r->shown - r->taken);
    r->come = 0;
}

/* Cuts one facet of tip i and holds its forces. */
static pg_status cut (break_loop *b, pg_state *state, const facet_candidate *c, double t, const double *d)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    size_t i = (size_t) c->tip;
    facet_run *r = &g->motion.run[i];
    double length = hypot (c->to[0] - g->field[i].x[0], c->to[1] - g->field[i].x[1]), *borne = NULL;
    facet_faces faces;
    PG_TRY (facet_faces_before (b, state, d, g->field[i].x, c->to, &faces));
    PG_TRY (facet_grow_one (b, state, c, t));
    PG_TRY (system_refresh (&b->system, state, &b->changes));
    if (faces.n) {
        PG_ALLOC (borne, b->system.ndof);
        PG_TRY (facet_faces_bear (b, state, &faces, borne));
    }
    /* a ring that ends at a kink is as many facets wide, so that both may be equal */
    double zone = facet_zone (b) * length, equal = pg_cloud_same (&b->system.problem->cloud);
    const facet_hold what = { .tip = c->tip, .length = zone, .energy = c->energy,
                              .alone = g->field[i].wide > zone - equal };
    PG_TRY (facet_hold_begin (b, t, d, &what, borne));
    facet_doubt_cut (b, c, t, g->motion.hold[g->motion.nhold - 1].drop);
    if (!(r->shown > 0)) r->taken = r->shown = facet_zone (b) * c->energy;
    r->way = r->length > 0 ? fmin (r->way - r->length, length) : 0;
    r->length = length, r->straight -= length;
    if (!(r->straight > 0)) r->least = 0;
done:
    facet_faces_clear (&faces), pg_free (borne);
    return status;
}

/* Finds the next facet of tip i; 0: none. A moving tip that has lost its room goes straight out to the
 * surface, and stops where it is not near. */
static int next_facet (break_loop *b, const pg_state *state, size_t i, double angle, int slides,
                       facet_candidate *c)
{
    facet_growth *g = b->growth;
    facet_run *r = &g->motion.run[i];
    const pg_tip_field *f = &g->field[i];
    if (r->straight > r->length) {
        facet_place (b, state, i, atan2 (f->e[1], f->e[0]), 0, c);
        return 1;
    }
    if (isnan (f->near)) {
        if (facet_way_out (b, state, i, c)) return 1;
        r->speed = 0;
        return 0;
    }
    double ahead = atan2 (f->e[1], f->e[0]), turn = remainder (angle - ahead, 2 * acos (-1));
    size_t n;
    int free = !b->system.problem->criterion->type->path (b->system.problem->criterion, &n);
    facet_place (b, state, i, r->length > 0 && free ? ahead + part_of_turn * turn : angle, slides, c);
    return 1;
}

/* 1: tips are to be judged: a Rayleigh wave has gone far enough, or a tip has reached the end of its
 * facet. */
int facet_due (break_loop *b, double dt)
{
    facet_growth *g = b->growth;
    const pg_problem *p = b->system.problem;
    double c_R = 0;
    g->motion.since += dt;
    for (size_t m = 0; m < p->nmaterial; m++)
        c_R = fmax (c_R, pg_material_waves (&p->material[m]).rayleigh);
    if (!(g->motion.since * c_R < between * p->cloud.h) || g->motion.nrun == 0) return 1;
    for (size_t i = 0; i < g->motion.nrun; i++)
        if (g->motion.run[i].speed > 0 && g->motion.run[i].way >= g->motion.run[i].length) return 1;
    return 0;
}

/* Sets the speed of tip i, which was measured, and cuts its next facet at the end of the last one. dt: time
 * since it was last judged, s. *any 1: something was cut at this look, so that the forces before the next cut
 * are at hand. */
static pg_status run_tip (break_loop *b, pg_state *state, size_t i, double t, const double *d, double dt,
                          double share, double angle, int slides, int *any)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    facet_run *r = &g->motion.run[i];
    const pg_tip_field *f = &g->field[i];
    facet_candidate c;
    int forks = 0;
    if (!isnan (f->near) && !(r->straight > r->length)) {
        double c_R = rayleigh_speed (b, f->x);
        compare (b, i, d, share, dt * c_R);
        pace (r, share * facet_trust (g, i), c_R, f->h, dt);
    }
    if (!(r->speed > 0) || r->way < r->length) return PG_OK;
    if (facet_branches (b, state, i)) {
        if (!*any) PG_TRY (facet_hold_before (b, t, d));
        PG_TRY (facet_fork (b, state, i, t, d, &forks));
        *any |= forks;
    }
    if (forks || !next_facet (b, state, i, angle, slides, &c)) goto done;
    if (!*any) PG_TRY (facet_hold_before (b, t, d));
    *any = 1;
    PG_TRY (cut (b, state, &c, t, d));
done:
    return status;
}

/* Warns once where a new crack might begin in dynamics, as none does. */
static pg_status tell_of_starts (break_loop *b, const pg_state *state, double t, const double *d)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    double x[3];
    int any;
    if (g->said & FACET_SAID_BEGINS) return PG_OK;
    PG_TRY (trial_hot_place (b, state, d, t, x, &any));
    if (!any) goto done;
    g->said |= FACET_SAID_BEGINS;
    pg_statistics_warn (b->system.report,
                        "in motion the stress reaches the strength at (%.4g, %.4g) m, at %.6g: new cracks do "
                        "not begin while the body moves, so that what follows may lack some; take a "
                        "criterion that breaks single bonds to see them",
                        x[0], x[1], t);
done:
    return status;
}

pg_status facet_move (break_loop *b, pg_state *state, double t, const double *d, double *top, int *any)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    double dt = g->motion.since;
    *any = 0, *top = 0, g->motion.moving = 1, g->motion.since = 0;
    PG_TRY (facet_measure (b, state, NULL, d, t));
    PG_TRY (tell_of_starts (b, state, t, d));
    size_t n = g->ntip;
    PG_TRY (facet_make_room (g, n));
    for (size_t i = 0; i < n; i++) {
        int slides;
        double angle, over = facet_judge (b, state, i, 1, &angle, &slides);
        *top = fmax (*top, over);
        if (state->paths->tip[i].open)
            PG_TRY (run_tip (b, state, i, t, d, dt, over * over, angle, slides, any));
    }
    g->motion.unjudged = facet_unjudged (b, state, 1);
    facet_hold_drop (b, 0);
done:
    return status;
}

/* ---- the begin and the end of a motion ----------------------------------------------------------------- */
void facet_rest (break_loop *b)
{
    facet_growth *g = b->growth;
    g->motion.moving = 0, g->fresh = 0, g->motion.nrun = 0, g->motion.since = 0;
    facet_hold_drop (b, 1);
}

pg_status facet_set_off (break_loop *b, const pg_state *state, double t, const double *d)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    facet_rest (b);
    if (g->event.tip < 0) return PG_OK;                /* no tip goes on: the crack has ended */
    size_t i = (size_t) g->event.tip;
    PG_TRY (facet_make_room (g, state->paths->ntip));
    g->motion.run[i].length = g->event.length;
    g->motion.run[i].taken = g->motion.run[i].shown = facet_zone (b) * g->event.energy;
    g->motion.run[i].speed = g->motion.run[i].least = set_off * rayleigh_speed (b, state->paths->tip[i].x);
    const facet_hold what = { .tip = (long) i, .length = facet_zone (b) * g->event.length,
                              .energy = g->event.energy, .alone = 1 };
    PG_TRY (facet_hold_begin (b, t, d, &what, NULL));
done:
    return status;
}

/* ---- checkpoints and refused steps --------------------------------------------------------------------- */
pg_status facet_motion_keep (break_loop *b, const pg_keeper *k)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    PG_KEEP_LENGTH (k, "facets", "running", g->motion.run, g->motion.nrun, g->motion.cap_run,
                    b->system.problem->bonds.first[PG_BOND_SETS], "the tips that run");
    facet_run *r = g->motion.run;
    PG_TRY (pg_keep_fields (k, "facets", NULL, "speed", g->motion.nrun, PG_ROWS (
        PG_EACH (r, speed), PG_EACH (r, g), PG_EACH (r, mean), PG_EACH (r, steady), PG_EACH (r, way),
        PG_EACH (r, length), PG_EACH (r, least), PG_EACH (r, straight), PG_EACH (r, come), PG_EACH (r, taken),
        PG_EACH (r, shown))));
    PG_TRY (pg_keep_fields (k, "facets", NULL, "since", 1,
                            PG_ROWS (PG_KEPT (g->motion.since), PG_KEPT (g->motion.top))));
    PG_TRY (facet_hold_keep (b, k));
done:
    return status;
}

pg_status facet_save (break_loop *b)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    facet_start *s = &g->motion.start;
    s->needed = g->needed, s->since = g->motion.since, s->nrun = 0;
    PG_GROW (s->run, s->cap_run, g->motion.nrun);
    if (g->motion.nrun) memcpy (s->run, g->motion.run, g->motion.nrun * sizeof *g->motion.run);
    s->nrun = g->motion.nrun;
    PG_TRY (facet_hold_copy (&s->hold, &s->nhold, &s->cap_hold, g->motion.hold, g->motion.nhold));
done:
    return status;
}

/* Restores the start of a refused step. Without memory for the copy no facet is held, as the step is refused
 * for another reason already. */
void facet_return (break_loop *b)
{
    facet_growth *g = b->growth;
    const facet_start *s = &g->motion.start;
    g->needed = s->needed, g->motion.since = s->since, g->fresh = 0;
    if (g->motion.nrun > s->nrun) g->motion.nrun = s->nrun;
    if (g->motion.nrun) memcpy (g->motion.run, s->run, g->motion.nrun * sizeof *g->motion.run);
    facet_hold_copy (&g->motion.hold, &g->motion.nhold, &g->motion.cap_hold, s->hold, s->nhold);
    facet_hold_sum (b);
}
