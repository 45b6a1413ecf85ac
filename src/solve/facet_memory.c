/* SPDX-License-Identifier: GPL-3.0-or-later
 * What was measured of tips and fronts, in checkpoints. A measurement that is at hand is kept with all its
 * digits and not made again: trial facets are solved for, with factors and preconditioners as they are at
 * that moment, so that a second measurement differs from the first one in its last digits, and counts. */
#include "front_growth.h"
#include <stddef.h>
#include <string.h>

/* The numbers of pg_tip_field come before its whole numbers, those of facet_candidate behind them. */
enum {
    NUMBERS = offsetof (pg_tip_field, limit) / sizeof (double),
    COUNTS = 6,
    TRIAL_NUMBERS = (sizeof (facet_candidate) - offsetof (facet_candidate, from)) / sizeof (double)
};

static void give_field (void *context, size_t i, long *count, double *number)
{
    const pg_tip_field *f = (const pg_tip_field *) context + i;
    const long whole[COUNTS] = { f->limit, f->load, f->extrapolated, f->interface, f->closed, f->kinked };
    memcpy (count, whole, sizeof whole);
    memcpy (number, f, NUMBERS * sizeof *number);
}

static pg_status take_field (void *context, size_t i, const long *count, const double *number,
                             const pg_keeper *k)
{
    pg_status status = PG_OK;
    pg_tip_field *f = (pg_tip_field *) context + i;
    PG_KEEP_BOUND (k, "what ends the room of a tip", count[0], PG_ROOM_FREE, PG_ROOM_FACES);
    for (int m = 2; m < COUNTS; m++) PG_KEEP_BOUND (k, "what is known of a tip", count[m], 0, 1);
    memcpy (f, number, NUMBERS * sizeof *number);
    f->limit = (int) count[0], f->load = (int) count[1], f->extrapolated = (int) count[2];
    f->interface = (int) count[3], f->closed = (int) count[4], f->kinked = (int) count[5];
done:
    return status;
}

static void give_trial (void *context, size_t i, long *count, double *number)
{
    const facet_candidate *c = &((const facet_growth *) context)->trial[i];
    const long whole[4] = { c->tip, c->open, c->close, c->slides };
    memcpy (count, whole, sizeof whole), memcpy (number, c->from, TRIAL_NUMBERS * sizeof *number);
}

static pg_status take_trial (void *context, size_t i, const long *count, const double *number,
                             const pg_keeper *k)
{
    pg_status status = PG_OK;
    facet_growth *g = context;
    facet_candidate *c = &g->trial[i];
    PG_KEEP_BOUND (k, "the tip of a trial facet", count[0], -1, (long) g->ntip - 1);
    PG_KEEP_BOUND (k, "the tips of a new crack", count[1], 0, 3);
    for (int m = 2; m < 4; m++) PG_KEEP_BOUND (k, "what a trial facet does", count[m], 0, 1);
    *c = (facet_candidate) { .tip = count[0], .open = (int) count[1], .close = (int) count[2],
                             .slides = (int) count[3] };
    memcpy (c->from, number, TRIAL_NUMBERS * sizeof *number);
done:
    return status;
}

/* The fields of tips, or of the vertices of fronts with the fronts that have no room. */
static pg_status keep_fields (break_loop *b, const pg_state *state, const pg_keeper *k)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    if (k->reading) PG_TRY (facet_lay_out (b, state));
    const front_growth *f = g->fronts;
    const pg_records fields = { .count_name = "facets.field", .number_name = "facets.field_numbers",
                                .n = g->ntip, .counts = COUNTS, .numbers = NUMBERS, .give = give_field,
                                .take = take_field, .context = g->field };
    if (g->ntip) PG_TRY (pg_keep_records (k, &fields));
    if (!f || !f->nfront) goto done;
    PG_TRY (k->bytes (k->context, "facets.blind", f->nfront, f->blind));
    for (size_t i = 0; i < f->nfront; i++)
        PG_KEEP_BOUND (k, "whether a front has room", f->blind[i], 0, 1);
done:
    return status;
}

pg_status facet_keep_measured (break_loop *b, const pg_state *state, const pg_keeper *k)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    if (!g) return PG_OK;
    long fresh = g->fresh && !g->moving, most = (long) b->system.problem->first_bond[PG_BOND_SETS];
    long count[4] = { fresh, fresh ? g->nfield : 1, fresh ? (long) g->ntrial : 0,
                      b->system.report->ended_by != NULL };
    PG_TRY (k->counts (k->context, "facets.measured", 4, count));
    PG_KEEP_BOUND (k, "whether tips were measured", count[0], 0, 1);
    PG_KEEP_BOUND (k, "the fields around tips", count[1], 1, 2);
    PG_KEEP_BOUND (k, "the number of trial facets", count[2], 0, most);
    PG_KEEP_BOUND (k, "whether the measure ended", count[3], 0, 1);
    if (k->reading && count[3]) facet_note_end (b->system.report);
    if (!count[0]) goto done;
    if (k->reading) {
        g->nfield = (int) count[1], g->ntrial = (size_t) count[2];
        PG_GROW (g->trial, g->cap_trial, g->ntrial);
    }
    PG_TRY (keep_fields (b, state, k));
    const pg_records offered = { .count_name = "facets.trial", .number_name = "facets.trial_numbers",
                                 .n = g->ntrial, .counts = 4, .numbers = TRIAL_NUMBERS, .give = give_trial,
                                 .take = take_trial, .context = g };
    if (g->ntrial) PG_TRY (pg_keep_records (k, &offered));
    if (k->reading) g->fresh = 1;
done:
    return status;
}
