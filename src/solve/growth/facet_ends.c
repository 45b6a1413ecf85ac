/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tips that cannot be judged. A tip without room for a ring is judged by trial facets, or goes straight
 * out; where neither can be (a support or a load on points stands in the way, or the last ligament is pressed
 * together) nothing tells at which load it goes on. Rows of a run in which that is so have no say in its
 * peak, and where nothing else grows up to full load the run ends. */
#include "facet_growth.h"
#include "front_growth.h"
#include <math.h>

/* 1: tip i cannot be judged, although its material can break. Tips hidden by closed faces may be judged
 * later, and do not count. */
static int is_lost (const break_loop *b, const pg_state *state, size_t i)
{
    const facet_growth *g = b->growth;
    const pg_tip_field *f = &g->field[i];
    pg_fracture_limits limits;
    if (!state->paths->tip[i].open || !isnan (f->near) || f->limit == PG_ROOM_FACES) return 0;
    if (i < g->motion.nrun && g->motion.run[i].straight > 0) return 0;                   /* a new branch */
    for (size_t k = 0; k < g->ntrial; k++)
        if (g->trial[k].tip == (long) i && facet_trial_utilisation (g, &g->trial[k], 1) > 0) return 0;
    return facet_limits (b, f->x, atan2 (f->e[1], f->e[0]), &limits);
}

/* 1: the faces of tip i overlap as contact is not modelled: its J means nothing. */
static int overlaps (const break_loop *b, size_t i, double factor)
{
    const facet_growth *g = b->growth;
    const pg_tip_field *f = &g->field[i];
    double l[2], K[3];
    if (b->system.contact || g->motion.moving || isnan (f->near) || f->closed) return 0;
    pg_tip_combine (f, facet_factors (g, factor, l), l, NULL, K, NULL);
    return K[0] < 0 && fabs (K[0]) > 1e-3 * fabs (K[1]);
}

/* Number of open tips that cannot be judged, or fronts without any measured vertex; *open: number of all open
 * ones. */
static long count_unjudged (const break_loop *b, const pg_state *state, double factor, long *open)
{
    const facet_growth *g = b->growth;
    const pg_crack_paths *paths = state->paths;
    size_t nfront;
    const pg_front *front = pg_fronts_of_state (b->system.problem, state, &nfront);
    long n = 0;
    for (size_t i = 0; paths && i < paths->ntip; i++) {
        if (!paths->tip[i].open) continue;
        ++*open;
        n += i < g->ntip && (is_lost (b, state, i) || overlaps (b, i, factor));
    }
    for (size_t k = 0; g->fronts && k < nfront; k++) {
        *open += front[k].open != 0;
        n += k < g->fronts->nfront && front[k].open && g->fronts->blind[k];
    }
    return n;
}

long facet_unjudged (const break_loop *b, const pg_state *state, double factor)
{
    const facet_growth *g = b->growth;
    long open = 0;
    if (!g || (!state->paths && !g->fronts)) return 0;
    long n = count_unjudged (b, state, factor, &open);
    /* a dynamic step that continues measured its tips before it was interrupted */
    if (open && g->ntip == 0) return g->motion.unjudged;
    /* where cracks have ended and none can begin the rest of the body is not judged */
    return n ? n : !open && !trial_has_strength (b->system.problem);
}

void facet_tell_lost (break_loop *b, const pg_state *state)
{
    const facet_growth *g = b->growth;
    for (size_t i = 0; i < g->ntip; i++) {
        const pg_tip_field *f = &g->field[i];
        char what[80];
        if (!(state->paths->tip[i].grown > 0) || !is_lost (b, state, i)) continue;
        pg_tip_limit_words (b->system.problem, f, what, sizeof what);
        pg_statistics_warn_once (b->system.report,
                                 "crack tip %ld at (%.6g, %.6g) m has no ring any more: %s is %.3g spacings "
                                 "away, 1.5 are needed; J is not known there",
                                 state->paths->tip[i].id, f->x[0], f->x[1], what, f->room / f->h);
    }
}

void facet_note_end (pg_statistics *report) { report->ended_by = "the measure of a crack tip ended"; }

int facet_measure_ends (pg_solver *s, const pg_state *state, double factor)
{
    break_loop *b = &s->break_loop;
    const facet_growth *g = b->growth;
    size_t lost = 0;
    if (b->system.problem->dim == 3) return 0;
    while (lost < g->ntip && !(state->paths->tip[lost].grown > 0 && is_lost (b, state, lost))) lost++;
    if (lost == g->ntip || facet_utilisation (b, state, 1) >= 1) return 0;
    facet_note_end (&s->report);
    pg_statistics_warn (&s->report,
                        "the measure of crack tip %ld has ended and nothing else grows up to full load: "
                        "the run "
                        "ends at event %ld, load factor %.6g; under which load it goes on is not known. A "
                        "smaller spacing leads nearer",
                        state->paths->tip[lost].id, state->events, factor);
    return 1;
}
