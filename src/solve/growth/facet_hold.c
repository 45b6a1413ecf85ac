/* SPDX-License-Identifier: GPL-3.0-or-later
 * How a facet opens in dynamics. Were all bonds across it cut at once, the body would find forces
 * gone that the facet had carried a moment before: what they store is less than what the facet takes, and
 * the rest would ring through the lattice as waves as short as the spacing. In a body a crack takes its
 * energy while its faces part under what still pulls them together. So do facets here, as nodes of finite
 * elements are released step by step (Malluck and King 1980, in ASTM STP 711, 38-53): the change of the
 * nodal forces by the cut,
 *
 *   f = F_new (d) - F_old (d),   F the internal forces without and with the bonds,  N,
 *
 * is applied against it, so that no force jumps, and decays with the path s of the tip along the
 * facet of length l:
 *
 *   M a + C v + F_new (d) = P + (1 - s / l) f.
 *
 * f is in balance by itself, as F_new and F_old are under rigid motions. What is not given back,
 * the drop of stored energy by the cut less its work on the body, is what the facet dissipates: the sum of
 * traction times opening, and therefore G (v) times the area. Nothing enters but F: every force that shows
 * forces between points or by shape functions opens its facets so, with a matrix or without one. */
#include "facet_growth.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Share of the force that is left after the tip has moved by `way`; of a hold at its present way. */
static double left_at (const facet_hold *h, double way) { return way >= h->length ? 0 : 1 - way / h->length; }
static double left (const facet_hold *h) { return left_at (h, h->way); }

/* Share of its energy that a facet has taken after the tip has moved by `way`, if it opens linearly: 2 int
 * left ds / l. */
static double taken_at (const facet_hold *h, double way) { return 1 - left_at (h, way) * left_at (h, way); }

/* Work product f . d of the held forces, J. */
static double product (const facet_hold *h, const double *d)
{
    double sum = 0;
    for (size_t i = 0; i < h->n; i++) sum += h->force[i] * d[h->unknown[i]];
    return sum;
}

static void clear (facet_hold *hold, size_t first, size_t n)
{
    for (size_t k = first; k < n; k++) pg_free (hold[k].unknown), pg_free (hold[k].force);
}

void facet_hold_free (facet_growth *g)
{
    clear (g->motion.hold, 0, g->motion.nhold), clear (g->motion.start.hold, 0, g->motion.start.nhold);
    pg_free (g->motion.hold), pg_free (g->motion.start.hold), pg_free (g->motion.start.run);
    pg_free (g->motion.held), pg_free (g->motion.force_before);
    g->motion.hold = NULL, g->motion.held = g->motion.force_before = NULL,
    g->motion.nhold = g->motion.cap_hold = 0;
    g->motion.start = (facet_start) { 0 };
}

/* held = sum of the forces of all facets that open, which the system adds; also updates the fracture energy
 * taken, by how far facets are open. */
void facet_hold_sum (break_loop *b)
{
    facet_growth *g = b->growth;
    if (!g->motion.held) return;
    double closed = 0;
    memset (g->motion.held, 0, b->system.ndof * sizeof *g->motion.held);
    for (size_t k = 0; k < g->motion.nhold; k++) {
        const facet_hold *h = &g->motion.hold[k];
        for (size_t i = 0; i < h->n; i++) g->motion.held[h->unknown[i]] += left (h) * h->force[i];
        closed += (1 - taken_at (h, h->way)) * h->energy;
    }
    b->system.balance.held = g->motion.nhold ? g->motion.held : NULL;
    b->system.report->energy.fracture = g->needed - closed;
}

/* out = loads less internal force at (t, d) with the present bonds, N (ndof). */
static pg_status forces_at (const pg_system *s, double t, const double *d, double *out)
{
    double unused;
    return s->force->balance (s->self, t, d, out, &unused);
}

pg_status facet_hold_before (break_loop *b, double t, const double *d)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    pg_system *s = &b->system;
    if (!g->motion.force_before) PG_ALLOC (g->motion.force_before, s->ndof);
    if (!g->motion.held) PG_ALLOC (g->motion.held, s->ndof);
    PG_TRY (forces_at (s, t, d, g->motion.force_before));
done:
    return status;
}

pg_status facet_hold_begin (break_loop *b, double t, const double *d, const facet_hold *what,
                            const double *borne)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    pg_system *s = &b->system;
    facet_hold h = { .tip = what->tip, .length = what->length, .energy = what->energy,
                     .alone = what->alone };
    double *after = NULL, most = 0;
    PG_ALLOC (after, s->ndof);
    PG_TRY (forces_at (s, t, d, after));
    for (size_t i = 0; i < s->ndof; i++) {
        double f = g->motion.force_before[i] - after[i];
        g->motion.force_before[i] = after[i];
        if (borne) h.drop -= 0.5 * borne[i] * d[i], f -= borne[i];
        after[i] = f;
        most = fmax (most, fabs (f));
    }
    for (size_t i = 0; i < s->ndof; i++) h.n += fabs (after[i]) > 1e-15 * most;
    PG_ALLOC (h.unknown, h.n + 1);
    PG_ALLOC (h.force, h.n + 1);
    h.n = 0;
    for (size_t i = 0; i < s->ndof; i++)
        if (fabs (after[i]) > 1e-15 * most) h.unknown[h.n] = (long) i, h.force[h.n++] = after[i];
    h.product = product (&h, d), h.drop -= 0.5 * h.product;  /* the work of all forces that have changed */
    PG_GROW (g->motion.hold, g->motion.cap_hold, g->motion.nhold + 1);
    g->motion.hold[g->motion.nhold++] = h;
    h.unknown = NULL, h.force = NULL;
    facet_hold_sum (b);
done:
    pg_free (after), pg_free (h.unknown), pg_free (h.force);
    return status;
}

/* Sums the energy by trapezoids, as forces decay linearly between two looks. The cut itself released 1/2 d
 * (F_old - F_new) in a linear body; it is counted along the first facet of the path, as the tip takes it. */
void facet_hold_account (break_loop *b, size_t tip, const double *d, double *taken, double *needed)
{
    facet_growth *g = b->growth;
    double zone = facet_zone (b);
    *taken = *needed = 0;
    for (size_t k = 0; k < g->motion.nhold; k++) {
        facet_hold *h = &g->motion.hold[k];
        if (h->tip != (long) tip || !h->alone) continue;
        double q = product (h, d), l0 = left_at (h, h->way0), l1 = left (h), facet = h->length / zone;
        double part = h->way0 < facet ? fmin (1, (h->way - h->way0) / (facet - h->way0)) * h->drop : 0;
        *taken += part - 0.5 * (l0 + l1) * (q - h->product);
        *needed += h->energy * (taken_at (h, h->way) - taken_at (h, h->way0));
        h->product = q, h->drop -= part, h->way0 = h->way;
    }
}

/* Drops facets that are fully open. */
void facet_hold_drop (break_loop *b, int all)
{
    facet_growth *g = b->growth;
    size_t kept = 0;
    for (size_t k = 0; k < g->motion.nhold; k++)
        if (!all && left (&g->motion.hold[k]) > 0) g->motion.hold[kept++] = g->motion.hold[k];
        else clear (g->motion.hold, k, k + 1);
    g->motion.nhold = kept;
    facet_hold_sum (b);
}

pg_status facet_hold_copy (facet_hold **to, size_t *n, size_t *capacity, const facet_hold *from, size_t count)
{
    pg_status status = PG_OK;
    clear (*to, 0, *n);
    *n = 0;
    PG_GROW (*to, *capacity, count);
    for (size_t k = 0; k < count; k++) {
        facet_hold *h = &(*to)[k];
        *h = from[k], h->unknown = NULL, h->force = NULL;
        *n = k + 1;
        PG_ALLOC (h->unknown, h->n + 1);
        PG_ALLOC (h->force, h->n + 1);
        memcpy (h->unknown, from[k].unknown, h->n * sizeof *h->unknown);
        memcpy (h->force, from[k].force, h->n * sizeof *h->force);
    }
done:
    if (status != PG_OK) clear (*to, 0, *n), *n = 0;
    return status;
}

/* ---- checkpoints and refused steps --------------------------------------------------------------------- */
static pg_status keep_one (break_loop *b, size_t i, const pg_keeper *k)
{
    pg_status status = PG_OK;
    const facet_growth *g = b->growth;
    facet_hold *h = &g->motion.hold[i];
    char name[2][32];
    size_t n = h->n;
    snprintf (name[0], sizeof name[0], "opening.%zu", i), snprintf (name[1], sizeof name[1], "opened.%zu", i);
    PG_TRY (pg_keep_fields (k, "facets", name[0], name[1], 1, PG_ROWS (
        PG_KEPT_IN (h->tip, 0, (long) g->motion.nrun - 1, "the tip of a facet that opens"),
        PG_KEPT_IN (n, 0, b->system.ndof, "the unknowns that a facet holds"), PG_KEPT (h->alone),
        PG_KEPT (h->way), PG_KEPT (h->length), PG_KEPT (h->energy), PG_KEPT (h->way0), PG_KEPT (h->product),
        PG_KEPT (h->drop))));
    if (k->reading) {
        PG_ALLOC (h->unknown, n + 1);
        PG_ALLOC (h->force, n + 1);
        h->n = n;
    }
    snprintf (name[0], sizeof name[0], "unknowns.%zu", i);
    snprintf (name[1], sizeof name[1], "forces.%zu", i);
    PG_TRY (pg_keep_fields (k, "facets", name[0], name[1], 1, PG_ROWS (
        PG_ITEMS_IN (h->unknown, n, 0, b->system.ndof - 1, "an unknown that a facet holds"),
        PG_ITEMS (h->force, n))));
done:
    return status;
}

pg_status facet_hold_keep (break_loop *b, const pg_keeper *k)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    long count = (long) g->motion.nhold;
    PG_TRY (k->counts (k->context, "facets.holding", 1, &count));
    PG_KEEP_BOUND (k, "the facets that open", count, 0,
                   (long) b->system.problem->bonds.first[PG_BOND_SETS]);
    if (k->reading) {
        facet_hold_free (g);
        PG_ALLOC (g->motion.held, b->system.ndof);
        g->motion.hold = NULL, g->motion.cap_hold = 0;
        PG_GROW (g->motion.hold, g->motion.cap_hold, (size_t) count);
        g->motion.nhold = (size_t) count;
    }
    for (size_t i = 0; i < g->motion.nhold; i++) PG_TRY (keep_one (b, i, k));
    facet_hold_sum (b);
done:
    return status;
}
