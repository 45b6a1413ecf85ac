/* SPDX-License-Identifier: GPL-3.0-or-later
 * Measurements of tips and fronts in checkpoints. A valid measurement is kept with all digits and not made
 * again: trial facets are solved with the factors and preconditioners of the moment, so that a second
 * measurement would differ in its last digits, and be counted. */
#include "front_growth.h"

/* Writes or reads back the fields of tips, or of the vertices of fronts. */
static pg_status keep_list_of_fields (pg_tip_field *f, size_t n, const pg_keeper *k)
{
    return pg_keep_fields (k, "facets", "field", "field_numbers", n, PG_ROWS (
        PG_EACH_IN (f, limit, PG_ROOM_FREE, PG_ROOM_FACES, "what ends the room of a tip"), PG_EACH (f, load),
        PG_EACH_IN (f, extrapolated, 0, 1, "what is known of a tip"),
        PG_EACH_IN (f, interface, 0, 1, "what is known of a tip"),
        PG_EACH_IN (f, closed, 0, 1, "what is known of a tip"),
        PG_EACH_IN (f, kinked, 0, 1, "what is known of a tip"), PG_EACH (f, J), PG_EACH (f, K),
        PG_EACH (f, K_wide), PG_EACH (f, J_near), PG_EACH (f, T), PG_EACH (f, x), PG_EACH (f, e),
        PG_EACH (f, h), PG_EACH (f, r1), PG_EACH (f, near), PG_EACH (f, wide), PG_EACH (f, normal),
        PG_EACH (f, tangent), PG_EACH (f, length), PG_EACH (f, room), PG_EACH (f, modulus),
        PG_EACH (f, antiplane), PG_EACH (f, kink), PG_EACH (f, trial), PG_EACH (f, trial_angle),
        PG_EACH (f, trial_K)));
}

static pg_status keep_trials (facet_growth *g, const pg_keeper *k)
{
    facet_candidate *c = g->trial;
    return pg_keep_fields (k, "facets", "trial", "trial_numbers", g->ntrial, PG_ROWS (
        PG_EACH_IN (c, tip, -1, (long) g->ntip - 1, "the tip of a trial facet"),
        PG_EACH_IN (c, open, 0, 3, "the tips of a new crack"),
        PG_EACH_IN (c, close, 0, 1, "what a trial facet does"),
        PG_EACH_IN (c, slides, 0, 1, "what a trial facet does"), PG_EACH (c, from), PG_EACH (c, to),
        PG_EACH (c, radius), PG_EACH (c, across), PG_EACH (c, energy), PG_EACH (c, release),
        PG_EACH (c, stress)));
}

/* The fields of tips, or of the vertices of fronts, with the flags of fronts without room. */
static pg_status keep_fields (break_loop *b, const pg_state *state, const pg_keeper *k)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    if (k->reading) PG_TRY (facet_lay_out (b, state));
    const front_growth *f = g->fronts;
    if (g->ntip) PG_TRY (keep_list_of_fields (g->field, g->ntip, k));
    if (f && f->nfront)
        PG_TRY (pg_keep_bytes (k, "facets.blind", f->nfront, f->blind, 1, "whether a front has room"));
done:
    return status;
}

pg_status facet_keep_measured (break_loop *b, const pg_state *state, const pg_keeper *k)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    if (!g) return PG_OK;
    int fresh = g->fresh && !g->motion.moving, nfield = fresh ? g->nfield : 1,
        ended = b->system.report->ended_by != NULL;
    size_t ntrial = fresh ? g->ntrial : 0;
    PG_TRY (pg_keep_fields (k, "facets", "measured", NULL, 1, PG_ROWS (
        PG_KEPT_IN (fresh, 0, 1, "whether tips were measured"),
        PG_KEPT_IN (nfield, 1, 2, "the fields around tips"),
        PG_KEPT_IN (ntrial, 0, b->system.problem->bonds.first[PG_BOND_SETS], "the number of trial facets"),
        PG_KEPT_IN (ended, 0, 1, "whether the measure ended"))));
    if (k->reading && ended) facet_note_end (b->system.report);
    if (!fresh) goto done;
    if (k->reading) {
        g->nfield = nfield, g->ntrial = ntrial;
        PG_GROW (g->trial, g->cap_trial, g->ntrial);
    }
    PG_TRY (keep_fields (b, state, k));
    if (g->ntrial) PG_TRY (keep_trials (g, k));
    if (k->reading) g->fresh = 1;
done:
    return status;
}
