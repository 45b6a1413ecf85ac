/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact along loads that are a constant part and a share s times another (event stepping with constant
 * loads, and stages). With the cracks open u0 = a_0 + s (a_1 - a_0), two equilibria, so that the gaps without
 * contact are a straight line of s, and forces and gaps follow it in stretches between changes of status
 * (pg_contact_stretch): u = u0 + Z f is a straight line in each. That line, taken to s = 0 and to s = 1, is
 * what the caller gets; both ends are refined as all equilibria are, with the forces of contact
 * that belong to them among the loads. */
#include "contact.h"
#include <math.h>
#include <string.h>

enum { MOST_ROUNDS = 4 };
/* Relative change of gaps that is good enough; imbalance of forces that counts as balanced; forces that count
 * as zero; distance behind a change of status at which a path in total form is continued. */
static const double GOOD = 1e-12, BALANCED = 1e-12, ROUNDING = 1e-14, BEHIND = 1e-9;

static size_t rows_of (const struct system_contact *c) { return c->pieces.dim * c->pieces.n; }

static pg_contact_path path_of (const struct system_contact *c, const double *slip)
{
    return (pg_contact_path){ c->pieces.n,   c->pieces.dim,  c->compliance.C, c->route.gap,
                              c->route.rate, c->coefficient, c->cohesion,     slip };
}

/* ---- life ---------------------------------------------------------------------------------------------- */
/* Frees what belongs to the pieces, which have changed. */
void contact_route_clear (struct system_contact *c)
{
    contact_route *r = &c->route;
    pg_free (r->gap), pg_free (r->rate), pg_free (r->force_from);
    pg_free (r->track.force_rate), pg_free (r->track.gap_rate);
    pg_free (r->track.due), pg_free (r->mark);
    r->gap = r->rate = r->force_from = r->mark = NULL, r->track = (pg_contact_track){ 0 };
    r->ready = r->touches = 0, r->nmark = r->cap_mark = 0;
}

void contact_route_free (struct system_contact *c)
{
    contact_route_clear (c);
    pg_free (c->route.open[0]), pg_free (c->route.open[1]);
}

static pg_status make_room (pg_system *s)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    contact_route *r = &c->route;
    size_t n = rows_of (c);
    for (int i = 0; i < 2; i++) if (!r->open[i]) PG_ALLOC (r->open[i], s->ndof);
    if (!r->gap) PG_ALLOC (r->gap, n + 1);
    if (!r->rate) PG_ALLOC (r->rate, n + 1);
    if (!r->track.force_rate) PG_ALLOC (r->track.force_rate, n + 1);
    if (!r->track.gap_rate) PG_ALLOC (r->track.gap_rate, n + 1);
    if (!r->track.due) PG_ALLOC (r->track.due, c->pieces.n + 1);
    if (!r->force_from) PG_ALLOC (r->force_from, n + 1);
    r->track.force = c->force, r->track.gap = c->gap, r->track.status = c->status;
done:
    return status;
}

/* Counts the cost of a stretch or a beginning; `before`: the counts before it. */
static void count_work (pg_system *s, const pg_contact_track *before, double t0)
{
    const pg_contact_track *now = &s->contact->route.track;
    pg_statistics *r = s->report;
    r->contact.passes = now->solves - before->solves, r->contact.sweeps = now->sweeps - before->sweeps;
    r->contact.solves += r->contact.passes;
    r->contact.seconds += pg_seconds () - t0;
}

/* ---- where it stands ----------------------------------------------------------------------------------- */
/* Finds the forces on the nodes, and the counts of pieces for the report. */
static void show_forces (pg_system *s)
{
    struct system_contact *c = s->contact;
    contact_set_active (s, c->route.touches);
    if (c->is.active) pg_sparse_multiply (&c->G, c->force, c->nodal);
    contact_count (s);
    c->now.at = c->route.from + c->route.track.s;
}

/* Notes the contact forces that the present linear stretch of the path would have at s = 0, once for each
 * stretch: what is measured by them does not depend on the position of the state on it. */
static void note_line (pg_system *s)
{
    struct system_contact *c = s->contact;
    contact_route *r = &c->route;
    for (size_t i = 0; i < rows_of (c); i++)
        r->force_from[i] = c->force[i] - r->track.force_rate[i] * r->track.s;
}

/* Finds the solution at share `at`, with slips from the last accepted state. */
static pg_status begin_at (pg_system *s, double at)
{
    struct system_contact *c = s->contact;
    contact_route *r = &c->route;
    pg_contact_path path = path_of (c, NULL);
    const pg_contact_track before = r->track;
    double t0 = pg_seconds ();
    r->ready = 0;
    if (r->touches) {
        pg_status status = pg_contact_begin (&r->track, &path, at, c->before);
        count_work (s, &before, t0);
        note_line (s);
        return status;
    }
    memset (c->force, 0, rows_of (c) * sizeof *c->force);
    memset (c->status, PG_CONTACT_OPEN, c->pieces.n);
    for (size_t i = 0; i < rows_of (c); i++) c->gap[i] = r->gap[i] + at * r->rate[i];
    r->track.s = r->track.end = at;
    note_line (s);
    return PG_OK;
}

/* Refines an end of the stretch. It may have hardly any forces: its residual is also compared with those of
 * the other end. */
static pg_status balance (pg_system *s, double t, double *d, double *residual)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    const double borne = b->borne, reference = s->contact->route.reference;
    if (reference > 0) PG_TRY (system_residual (s, t, d, NULL, residual));
    if (reference > 0 && b->unbalanced <= BALANCED * reference) {
        *residual = fmin (*residual, b->unbalanced / reference);
        return PG_OK;
    }
    b->borne = fmax (borne, reference);
    status = system_solve_linear (s, t, d, NULL, residual);
    b->borne = borne;
done:
    return status;
}

pg_status contact_route_begin (pg_system *s, double from, double *base, double *unit, double *residual)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    contact_route *r = &c->route;
    double *const guess[2] = { base, unit }, at = c->now.at - from;
    int known = r->open[0] && r->from == from;         /* open cracks are known, of the cracks before */
    if (contact_motions (s))
        PG_FAIL (PG_E_EQUILIBRIUM,
                 "a part of the body that contact alone holds is not known to event stepping under loads "
                 "with a constant part, or in stages: use stepping: fixed");
    PG_TRY (make_room (s));
    /* the end of a stage that takes all loads off has no forces, and comes first */
    s->balance.borne = fmax (s->balance.borne, r->reference);
    *residual = r->reference = 0, r->from = from, r->touches = 0;
    contact_set_active (s, 0);
    PG_TRY (contact_factor (s));
    for (int i = 1; i >= 0; i--) {
        double one, *row = i ? r->rate : r->gap;
        if (!known) memcpy (r->open[i], guess[i], s->ndof * sizeof *r->open[i]);
        PG_TRY (balance (s, from + i, r->open[i], &one));
        *residual = fmax (*residual, one), r->reference = fmax (r->reference, s->balance.reference);
        if (rows_of (c)) pg_sparse_multiply_transposed (&c->G, r->open[i], row);
        for (size_t k = 0; k < rows_of (c); k++) row[k] += c->initial[k];
        for (size_t k = 0; k < c->pieces.n; k++) r->touches |= row[c->pieces.dim * k] < 0;
    }
    for (size_t k = 0; k < rows_of (c); k++) r->rate[k] -= r->gap[k];
    c->is.touched = r->touches;
    if (r->touches) PG_TRY (contact_condense (s, NULL));
    PG_TRY (begin_at (s, at));
    show_forces (s);
done:
    return status;
}

/* ---- stretches ----------------------------------------------------------------------------------------- */
/* d = a_0 + s (a_1 - a_0) + Z f, with share s and contact forces f */
static void displacement_of (const pg_system *s, double share, const double *force, double *d)
{
    const struct system_contact *c = s->contact;
    const contact_route *r = &c->route;
    for (size_t k = 0; k < s->ndof; k++)
        d[k] = share == 1 ? r->open[1][k] : r->open[0][k] + share * (r->open[1][k] - r->open[0][k]);
    for (size_t i = 0; r->touches && i < rows_of (c); i++)
        for (size_t k = 0; force[i] != 0 && k < s->ndof; k++)
            d[k] += force[i] * c->compliance.Z[i * s->ndof + k];
}

/* The displacement at the start or end (s = 0 or 1) of a stretch without changes of status, refined until
 * its residual is small; the correction is added to the displacement with open cracks and to the gaps,
 * too. *change: of the gaps, over the largest of them. */
static pg_status mend (pg_system *s, int end, double *d, double *change, double *residual)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    contact_route *r = &c->route;
    size_t n = rows_of (c);
    double *force = NULL, *gap = NULL, *before = NULL, size = 0, most = 0, way = end - r->track.s;
    PG_ALLOC (force, n + 1);
    PG_ALLOC (gap, n + 1);
    PG_ALLOC (before, s->ndof);
    for (size_t i = 0; i < n; i++) {
        force[i] = c->force[i] + way * r->track.force_rate[i];
        most = fmax (most, fmax (fabs (c->force[i]), fabs (force[i])));
    }
    for (size_t i = 0; i < n; i++) if (fabs (force[i]) < ROUNDING * most) force[i] = 0;
    displacement_of (s, end, force, d);
    memcpy (before, d, s->ndof * sizeof *d);
    pg_sparse_multiply (&c->G, force, c->nodal);
    contact_set_active (s, 1);
    PG_TRY (balance (s, r->from + end, d, residual));
    pg_sparse_multiply_transposed (&c->G, d, gap);
    for (size_t i = 0; i < c->pieces.dim * c->ncrack; i++) gap[i] += c->soft[i] * force[i];
    *change = 0;
    for (size_t i = 0; i < n; i++) {
        double expected = c->gap[i] + way * r->track.gap_rate[i], off = gap[i] + c->initial[i] - expected;
        *change = fmax (*change, fabs (off));
        size = fmax (size, fmax (fabs (r->gap[i]), fabs (r->gap[i] + r->rate[i])));
        size = fmax (size, fabs (expected));
        gap[i] = off;
    }
    *change = size > 0 ? *change / size : 0;
    if (!(*change > GOOD)) goto done;
    for (size_t k = 0; k < s->ndof; k++) r->open[end][k] += d[k] - before[k];
    for (size_t i = 0; i < n; i++) {
        if (!end) r->gap[i] += gap[i];
        r->rate[i] += end ? gap[i] : -gap[i];
    }
done:
    pg_free (force), pg_free (gap), pg_free (before);
    return status;
}

/* Finds the present state again after its gaps were refined; slips stay. */
static pg_status begin_again (pg_system *s, const double *slip)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    contact_route *r = &c->route;
    pg_contact_path path = path_of (c, NULL);
    double *kept = NULL;
    size_t d = c->pieces.dim, m = d - 1;
    PG_ALLOC (kept, rows_of (c) + 1);
    for (size_t k = 0; k < c->pieces.n; k++)
        memcpy (kept + m*k, slip ? slip + m*k : c->gap + d*k + 1, m * sizeof *kept);
    PG_TRY (pg_contact_begin (&r->track, &path, r->track.s, kept));
done:
    pg_free (kept);
    return status;
}

static pg_status find_stretch (pg_system *s, double until, const double *slip, double *base, double *unit,
                               double *residual)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    contact_route *r = &c->route;
    if (!r->touches) {
        memcpy (base, r->open[0], s->ndof * sizeof *base);
        memcpy (unit, r->open[1], s->ndof * sizeof *unit);
        r->track.end = until, r->track.changes = r->track.leapt = 0;
        goto done;
    }
    PG_TRY (contact_condense (s, NULL));
    const pg_contact_track before = r->track;
    int leapt = 0;
    double t0 = pg_seconds ();
    for (int round = 0; round < MOST_ROUNDS; round++) {
        double change[2], left[2];
        pg_contact_path path = path_of (c, slip);
        PG_TRY (pg_contact_stretch (&r->track, &path, until));
        leapt |= r->track.leapt;
        PG_TRY (mend (s, 0, base, &change[0], &left[0]));
        PG_TRY (mend (s, 1, unit, &change[1], &left[1]));
        *residual = fmax (left[0], left[1]);
        if (!(fmax (change[0], change[1]) > GOOD)) break;
        if (round + 1 < MOST_ROUNDS) PG_TRY (begin_again (s, slip));
    }
    r->track.leapt = leapt;
    count_work (s, &before, t0);
done:
    if (status == PG_OK) note_line (s), show_forces (s);
    return status;
}

pg_status contact_route_ahead (pg_system *s, double *base, double *unit, double *residual, int *fresh)
{
    pg_status status = PG_OK;
    contact_route *r = &s->contact->route;
    *fresh = !r->ready;
    if (r->ready) return PG_OK;
    PG_TRY (find_stretch (s, 1, NULL, base, unit, residual));
    r->ready = 1;
done:
    return status;
}

pg_status contact_route_back (pg_system *s, double *base, double *unit, double *residual)
{
    pg_status status = PG_OK;
    PG_TRY (begin_at (s, s->contact->route.track.s));
    status = find_stretch (s, 0, s->contact->before, base, unit, residual);
done:
    return status;
}

pg_status contact_route_behind (pg_system *s)
{
    pg_status status = PG_OK;
    contact_route *r = &s->contact->route;
    PG_TRY (begin_at (s, fmax (0, r->track.s - BEHIND)));
    show_forces (s);
done:
    return status;
}

double contact_route_end (const pg_system *s)
{
    return s->contact ? s->contact->route.from + s->contact->route.track.end : INFINITY;
}

int contact_route_leapt (const pg_system *s) { return s->contact->route.track.leapt; }

long contact_route_due (const pg_system *s)
{
    const contact_route *r = &s->contact->route;
    long due = 0;
    for (size_t k = 0; r->track.changes && r->track.s == r->track.end && k < s->contact->pieces.n; k++)
        due += r->track.due[k];
    return due;
}

pg_status contact_route_go (pg_system *s, double t)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    contact_route *r = &c->route;
    double to = t == contact_route_end (s) ? r->track.end : t - r->from;
    if (r->touches) {
        PG_TRY (contact_condense (s, NULL));                 /* a resumed run has no compliance yet */
        pg_contact_path path = path_of (c, NULL);
        pg_contact_go (&r->track, &path, to);
    } else {
        r->track.s = to;
        for (size_t i = 0; i < rows_of (c); i++) c->gap[i] = r->gap[i] + to * r->rate[i];
    }
    if (r->track.changes && to == r->track.end) r->ready = 0;
    show_forces (s);
    c->now.at = t;
done:
    return status;
}

/* ---- marks --------------------------------------------------------------------------------------------- */
/* Numbers that a mark of the contact path keeps: share s, forces, gaps, status of every piece. */
static size_t mark_size (const struct system_contact *c) { return 1 + 2 * rows_of (c) + c->pieces.n; }

pg_status contact_route_mark (pg_system *s)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    contact_route *r = &c->route;
    size_t n = c->pieces.n, rows = rows_of (c), size = mark_size (c);
    PG_GROW (r->mark, r->cap_mark, (r->nmark + 1) * size);
    double *at = r->mark + r->nmark++ * size;
    at[0] = r->track.s;
    memcpy (at + 1, c->force, rows * sizeof *at);
    memcpy (at + 1 + rows, c->gap, rows * sizeof *at);
    for (size_t k = 0; k < n; k++) at[1 + 2*rows + k] = c->status[k];
done:
    return status;
}

void contact_route_return (pg_system *s, size_t k, double *d)
{
    struct system_contact *c = s->contact;
    contact_route *r = &c->route;
    size_t n = c->pieces.n, rows = rows_of (c);
    const double *at = r->mark + k * mark_size (c);
    r->track.s = r->track.end = at[0], r->track.changes = 0, r->ready = 0;
    memcpy (c->force, at + 1, rows * sizeof *at);
    memcpy (c->gap, at + 1 + rows, rows * sizeof *at);
    for (size_t i = 0; i < n; i++) c->status[i] = (unsigned char) at[1 + 2*rows + i];
    memset (r->track.due, 0, n);
    note_line (s);
    show_forces (s);
    if (d) displacement_of (s, r->track.s, c->force, d);
}

size_t contact_route_marks (const pg_system *s) { return s->contact->route.nmark; }
void   contact_route_forget (pg_system *s) { s->contact->route.nmark = 0; }

/* ---- checkpoint ---------------------------------------------------------------------------------------- */
pg_status contact_route_keep (pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    contact_route *r = &c->route;
    size_t n = rows_of (c);
    pg_contact_track *t = &r->track;
    long has = r->open[0] != NULL && r->gap != NULL;
    PG_TRY (k->counts (k->context, "contact.route", 1, &has));
    if (!has) return PG_OK;
    if (k->reading) PG_TRY (make_room (s));
    PG_TRY (pg_keep_fields (k, "contact.route", "counts", "numbers", 1, PG_ROWS (
        PG_KEPT_IN (r->touches, 0, 1, "a stretch of contact"),
        PG_KEPT_IN (r->ready, 0, 1, "a stretch of contact"),
        PG_KEPT_IN (t->changes, 0, 1, "a stretch of contact"),
        PG_KEPT_IN (t->leapt, 0, 1, "a stretch of contact"), PG_KEPT (t->total), PG_KEPT (t->solves),
        PG_KEPT (t->sweeps), PG_KEPT (t->leaps), PG_KEPT (r->from), PG_KEPT (t->s), PG_KEPT (t->end),
        PG_KEPT (r->reference))));
    PG_TRY (k->numbers (k->context, "contact.route.open_from", s->ndof, r->open[0]));
    PG_TRY (k->numbers (k->context, "contact.route.open_to", s->ndof, r->open[1]));
    if (n) PG_TRY (k->numbers (k->context, "contact.route.gap", n, r->gap));
    if (n) PG_TRY (k->numbers (k->context, "contact.route.rate", n, r->rate));
    if (n) PG_TRY (k->numbers (k->context, "contact.route.force_rate", n, t->force_rate));
    if (n) PG_TRY (k->numbers (k->context, "contact.route.gap_rate", n, t->gap_rate));
    if (n) PG_TRY (k->numbers (k->context, "contact.route.force_from", n, r->force_from));
    if (n) PG_TRY (k->bytes (k->context, "contact.route.due", c->pieces.n, t->due));
done:
    return status;
}
