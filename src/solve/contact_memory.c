/* SPDX-License-Identifier: GPL-3.0-or-later
 * What crack faces bore and how far they had slipped, for the work of friction and for slips that go on from
 * those before. Friction takes - sum f_t dg_t, by trapezoids between booked states as the work of loads; with
 * f_t of the total form and proportional loads that is exact. After a crack has grown there are other pieces:
 * each takes the values of those that lay where its points are now, new faces begin with none. */
#include "contact.h"
#include <math.h>
#include <string.h>

/* Piece of the memory that lies at x; SIZE_MAX: none. */
static size_t piece_at (const contact_memory *m, const double *x)
{
    size_t found = SIZE_MAX;
    double least = INFINITY;
    for (size_t k = 0; k < m->n; k++) {
        const double *v = m->value + k * CONTACT_VALUES;
        double away = hypot (v[CONTACT_X] - x[0], v[CONTACT_X + 1] - x[1]);
        if (away > 0.5 * v[CONTACT_LENGTH] * (1 + 1e-6) || away >= least) continue;
        least = away, found = k;
    }
    return found;
}

pg_status contact_remember (struct system_contact *c)
{
    pg_status status = PG_OK;
    contact_memory fresh = { .friction = c->now.friction, .n = c->pieces.n };
    PG_GROW (fresh.value, fresh.room, fresh.n * CONTACT_VALUES);
    for (size_t k = 0; k < fresh.n; k++) {
        double *v = fresh.value + k * CONTACT_VALUES, sum = 0;
        const pg_contact_piece *p = &c->pieces.piece[k];
        memset (v, 0, CONTACT_VALUES * sizeof *v);
        v[CONTACT_X] = p->x[0], v[CONTACT_X + 1] = p->x[1], v[CONTACT_LENGTH] = p->length;
        for (size_t q = c->pieces.first[k]; q < c->pieces.first[k + 1]; q++) {
            size_t at = piece_at (&c->now, c->pieces.x + 2*q);
            sum += c->pieces.weight[q];
            for (int i = CONTACT_SHEAR; at != SIZE_MAX && i < CONTACT_VALUES; i++)
                v[i] += c->pieces.weight[q] * c->now.value[at * CONTACT_VALUES + (size_t) i];
        }
        for (int i = CONTACT_SHEAR; i < CONTACT_VALUES; i++) v[i] /= sum;
        c->before[k] = v[CONTACT_ACCEPTED];
    }
    pg_free (c->now.value);
    c->now = fresh;
done:
    return status;
}

void contact_book (pg_system *s, double scale)
{
    struct system_contact *c = s->contact;
    for (size_t k = 0; c && k < c->pieces.n; k++) {
        double *v = c->now.value + k * CONTACT_VALUES, area = c->pieces.piece[k].area,
               shear = c->active ? scale * c->force[2*k + 1] : 0, slip = scale * c->gap[2*k + 1];
        c->now.friction -= 0.5 * (area * v[CONTACT_SHEAR] + shear) * (slip - v[CONTACT_SLIP]);
        v[CONTACT_SHEAR] = shear / area, v[CONTACT_SLIP] = slip;
    }
    if (c) s->report->energy_friction = c->now.friction;
}

void contact_accept (pg_system *s)
{
    struct system_contact *c = s->contact;
    for (size_t k = 0; c && k < c->pieces.n; k++)
        c->before[k] = c->now.value[k * CONTACT_VALUES + CONTACT_ACCEPTED] = c->gap[2*k + 1];
}

/* One memory as another. */
static pg_status copy (contact_memory *to, const contact_memory *from)
{
    pg_status status = PG_OK;
    PG_GROW (to->value, to->room, from->n * CONTACT_VALUES);
    if (from->n) memcpy (to->value, from->value, from->n * CONTACT_VALUES * sizeof *to->value);
    to->n = from->n, to->friction = from->friction;
done:
    return status;
}

pg_status contact_save (pg_system *s)
{
    return s->contact ? copy (&s->contact->start, &s->contact->now) : PG_OK;
}

/* The pieces at hand may be those of the step that is refused: what they remember follows. Nothing is
 * allocated where the memory at the start of the step had no more pieces than that of now had. */
void contact_return (pg_system *s)
{
    struct system_contact *c = s->contact;
    if (!c || copy (&c->now, &c->start) != PG_OK) return;
    s->report->energy_friction = c->now.friction;
    if (c->now.n == c->pieces.n)
        for (size_t k = 0; k < c->now.n; k++)
            c->before[k] = c->now.value[k * CONTACT_VALUES + CONTACT_ACCEPTED];
}

static pg_status keep_memory (contact_memory *m, const char *name, const pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char part[64];
    long n = (long) m->n;
    strcat (strcpy (part, name), ".count");
    PG_TRY (k->counts (k->context, part, 1, &n));
    PG_KEEP_BOUND (k, "the number of pieces in contact", n, 0, (long) s->problem->first_bond[PG_BOND_SETS]);
    if (k->reading) PG_GROW (m->value, m->room, (size_t) n * CONTACT_VALUES);
    m->n = (size_t) n;
    strcat (strcpy (part, name), ".friction");
    PG_TRY (k->numbers (k->context, part, 1, &m->friction));
    strcat (strcpy (part, name), ".values");
    if (n) PG_TRY (k->numbers (k->context, part, (size_t) n * CONTACT_VALUES, m->value));
done:
    return status;
}

/* What results have not written yet. */
static pg_status keep_shown (struct system_contact *c, const pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    enum { NUMBERS = 8 };
    long n = (long) c->nshown, *count = NULL;
    double *number = NULL;
    PG_TRY (k->counts (k->context, "contact.shown_count", 1, &n));
    PG_KEEP_BOUND (k, "the number of pieces in contact", n, 0, (long) s->problem->first_bond[PG_BOND_SETS]);
    if (k->reading) PG_GROW (c->shown, c->cap_shown, (size_t) n);
    PG_ALLOC (count, 2 * (size_t) n + 1);
    PG_ALLOC (number, NUMBERS * (size_t) n + 1);
    for (long i = 0; !k->reading && i < n; i++) {
        const pg_contact_values *v = &c->shown[i];
        const double value[NUMBERS] = { v->x[0],     v->x[1],  v->length, v->arc,
                                        v->pressure, v->shear, v->gap,    v->slip };
        count[2*i] = (long) v->path, count[2*i + 1] = (long) v->status;
        memcpy (number + NUMBERS * i, value, sizeof value);
    }
    if (n) PG_TRY (k->counts (k->context, "contact.shown", 2 * (size_t) n, count));
    if (n) PG_TRY (k->numbers (k->context, "contact.shown_values", NUMBERS * (size_t) n, number));
    for (long i = 0; k->reading && i < n; i++) {
        const double *v = number + NUMBERS * i;
        PG_KEEP_BOUND (k, "the path of a piece", count[2*i], 0,
                       (long) s->problem->first_bond[PG_BOND_SETS]);
        PG_KEEP_BOUND (k, "the status of a piece", count[2*i + 1], PG_CONTACT_OPEN, PG_CONTACT_BACKWARD);
        c->shown[i] = (pg_contact_values) { .path = (size_t) count[2*i], .x = { v[0], v[1] }, .length = v[2],
                                            .arc = v[3], .pressure = v[4], .shear = v[5], .gap = v[6],
                                            .slip = v[7], .status = (pg_contact_status) count[2*i + 1] };
    }
    c->nshown = (size_t) n;
done:
    pg_free (count), pg_free (number);
    return status;
}

/* Forces, gaps and states of the pieces of the state at hand: it has been solved for, and is not again.
 * Called when caches have been made again. */
pg_status contact_keep (pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    if (!c) return PG_OK;
    pg_statistics *r = s->report;
    long count[4] = { (long) c->pieces.n, c->active, r->contact_passes, r->contact_sweeps };
    PG_TRY (keep_memory (&c->now, "contact.now", s, k));
    PG_TRY (keep_memory (&c->start, "contact.start", s, k));
    PG_TRY (keep_shown (c, s, k));
    PG_TRY (k->counts (k->context, "contact.counts", 4, count));
    PG_KEEP_BOUND (k, "the number of pieces of cracks", count[0], (long) c->pieces.n, (long) c->pieces.n);
    PG_KEEP_BOUND (k, "contact", count[1], 0, 1);
    c->active = (int) count[1], r->contact_passes = count[2], r->contact_sweeps = count[3];
    if (!c->pieces.n) return PG_OK;
    PG_TRY (k->numbers (k->context, "contact.force", 2 * c->pieces.n, c->force));
    PG_TRY (k->numbers (k->context, "contact.gap", 2 * c->pieces.n, c->gap));
    PG_TRY (k->bytes (k->context, "contact.status", c->pieces.n, c->status));
    for (size_t i = 0; k->reading && i < c->pieces.n; i++) {
        PG_KEEP_BOUND (k, "the status of a piece", c->status[i], PG_CONTACT_OPEN, PG_CONTACT_BACKWARD);
        if (c->now.n == c->pieces.n) c->before[i] = c->now.value[i * CONTACT_VALUES + CONTACT_ACCEPTED];
    }
    if (k->reading) pg_sparse_multiply (&c->G, c->force, c->nodal);
    if (k->reading) contact_count (s);
done:
    return status;
}
