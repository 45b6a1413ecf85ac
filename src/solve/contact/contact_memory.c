/* SPDX-License-Identifier: GPL-3.0-or-later
 * Forces and slips of crack faces in earlier states, for the work of friction and for slips that go on.
 * Friction takes - sum f_t dg_t, by trapezoids between booked states like the work of loads; with f_t of the
 * total form and proportional loads that is exact. After a crack has grown there are other pieces: each takes
 * the values of those at the positions of its points. New faces begin without slip, with the forces that they
 * have when first booked: what a facet that slides takes while it forms is the energy of its material and the
 * work of the remaining friction. */
#include "contact.h"
#include <math.h>
#include <string.h>

/* Half the diagonal of a unit square: reach of a piece in 3D. Least cosine between normals of faces of the
 * same crack: those of one that crosses or branches off are not. */
static const double SQUARE = 0.70710678118654752, LEANS = 0.8;

void contact_vector (const pg_contact_pieces *pieces, size_t k, const double *along, double scale,
                     double *out)
{
    const pg_contact_piece *p = &pieces->piece[k];
    if (pieces->dim == 2) out[0] = scale * along[0];
    for (int c = 0; c < 3 && pieces->dim == 3; c++)
        out[c] = scale * (along[0] * p->tangent[0][c] + along[1] * p->tangent[1][c]);
}

/* Components of a vector along the tangents of piece k; in 2D the vector is one number already. */
static void part_along (const pg_contact_pieces *pieces, size_t k, const double *vector, double *out)
{
    const pg_contact_piece *p = &pieces->piece[k];
    if (pieces->dim == 2) out[0] = vector[0];
    for (int a = 0; a < 2 && pieces->dim == 3; a++)
        out[a] = vector[0] * p->tangent[a][0] + vector[1] * p->tangent[a][1] + vector[2] * p->tangent[a][2];
}

/* Piece of the memory that contains point q of the present pieces, of the same platen or a crack of about the
 * same direction; SIZE_MAX: none. In 3D pieces are about as wide as long. */
static size_t piece_at (const contact_memory *m, const pg_contact_pieces *now, size_t platen, size_t q)
{
    size_t found = SIZE_MAX, dim = now->dim;
    double least = INFINITY;
    contact_layout l = contact_layout_of (dim);
    const double *x = now->x + dim * q, *normal = now->normal + dim * q;
    for (size_t k = 0; k < m->n; k++) {
        const double *v = m->value + k * l.values;
        double away = hypot (v[0] - x[0], v[1] - x[1]), reach = 0.5, along = 0;
        if (dim == 3) away = hypot (away, v[2] - x[2]), reach = SQUARE;
        if (away > reach * v[l.length] * (1 + 1e-6) || away >= least) continue;
        for (size_t i = 0; i < dim; i++) along += v[l.normal + i] * normal[i];
        if (v[l.platen] != (double) platen || (!platen && fabs (along) < LEANS)) continue;
        least = away, found = k;
    }
    return found;
}

/* Sign of remembered vectors (3D), which are those of the side that the normal points to: -1 if that is the
 * other side now. */
static double sense_of (const double *old, const double *now, size_t dim)
{
    return dim == 3 && old[0] * now[0] + old[1] * now[1] + old[2] * now[2] < 0 ? -1 : 1;
}

pg_status contact_remember (struct system_contact *c)
{
    pg_status status = PG_OK;
    size_t dim = c->pieces.dim;
    int first = !c->now.n && !(c->is.began && c->ncrack);
    contact_layout l = contact_layout_of (dim);
    contact_memory fresh = { .friction = c->now.friction, .at = c->now.at, .n = c->pieces.n };
    PG_GROW (fresh.value, fresh.room, fresh.n * l.values);
    for (size_t k = 0; k < fresh.n; k++) {
        double *v = fresh.value + k * l.values, sum = 0, old = 0;
        const pg_contact_piece *p = &c->pieces.piece[k];
        memset (v, 0, l.values * sizeof *v);
        memcpy (v, p->x, dim * sizeof *v), v[l.length] = p->length;
        memcpy (v + l.normal, p->normal, dim * sizeof *v), v[l.platen] = (double) p->platen;
        for (size_t q = c->pieces.first[k]; q < c->pieces.first[k + 1]; q++) {
            size_t at = piece_at (&c->now, &c->pieces, p->platen, q);
            sum += c->pieces.weight[q], old += at != SIZE_MAX || first ? c->pieces.weight[q] : 0;
            if (at == SIZE_MAX) continue;
            const double *before = c->now.value + at * l.values;
            double sense = sense_of (before + l.normal, c->pieces.normal + dim * q, dim);
            for (size_t i = l.shear; i < l.values; i++)
                v[i] += c->pieces.weight[q] * (i < l.overlap ? sense : 1) * before[i];
        }
        for (size_t i = l.shear; i < l.values; i++) v[i] /= sum;
        v[l.old] = old / sum;
    }
    pg_free (c->now.value);
    c->now = fresh;
    contact_recall (c);
done:
    return status;
}

/* Books friction in a time step: the mean force of the step does work on the change of slips over the step,
 * exactly; rounds of breaking find both again. */
static void book_step (struct system_contact *c)
{
    size_t dim = c->pieces.dim;
    contact_layout l = contact_layout_of (dim);
    double work = 0;
    for (size_t k = 0; k < c->pieces.n; k++) {
        double *v = c->now.value + k * l.values, area = c->weight * c->pieces.piece[k].area;
        for (size_t a = 1; a < dim && c->is.active; a++) {
            size_t i = dim * k + a;
            work -= c->force[i] / c->weight * (c->gap[i] - c->before[k * (dim - 1) + a - 1]);
        }
        contact_vector (&c->pieces, k, c->gap + dim * k + 1, 1, v + l.slip);
        memset (v + l.shear, 0, l.parts * sizeof *v);
        if (c->is.active) contact_vector (&c->pieces, k, c->force + dim * k + 1, 1 / area, v + l.shear);
    }
    c->now.friction = c->start.friction + work;
}

void contact_book (pg_system *s, double scale)
{
    struct system_contact *c = s->contact;
    contact_layout l = contact_layout_of (c ? c->pieces.dim : 2);
    if (c && c->is.moves) book_step (c);
    for (size_t k = 0; c && !c->is.moves && k < c->pieces.n; k++) {
        const double none[2] = { 0, 0 };
        size_t i = c->pieces.dim * k + 1;
        double *v = c->now.value + k * l.values, area = c->pieces.piece[k].area, shear[3], slip[3];
        contact_vector (&c->pieces, k, c->is.active ? c->force + i : none, scale, shear);
        contact_vector (&c->pieces, k, c->gap + i, scale, slip);
        for (size_t m = 0; m < l.parts; m++) {
            c->now.friction -=
                0.5 * (area * v[l.shear + m] + (2 - v[l.old]) * shear[m]) * (slip[m] - v[l.slip + m]);
            v[l.shear + m] = shear[m] / area, v[l.slip + m] = slip[m];
        }
        v[l.old] = 1;
    }
    if (c) s->report->energy.friction = c->now.friction;
}

void contact_recall (struct system_contact *c)
{
    size_t dim = c->pieces.dim;
    contact_layout l = contact_layout_of (dim);
    for (size_t k = 0; c->now.n == c->pieces.n && k < c->now.n; k++) {
        const double *v = c->now.value + k * l.values;
        part_along (&c->pieces, k, v + l.accepted, c->before + k * (dim - 1));
        if (k < c->ncrack) c->initial[dim * k] = v[l.overlap];
    }
}

void contact_accept (pg_system *s)
{
    struct system_contact *c = s->contact;
    if (!c) return;
    contact_layout l = contact_layout_of (c->pieces.dim);
    for (size_t k = 0; k < c->pieces.n; k++) {
        size_t i = c->pieces.dim * k;
        double *v = c->now.value + k * l.values;
        contact_vector (&c->pieces, k, c->gap + i + 1, 1, v + l.accepted);
        /* faces that have moved further apart need less of that initial overlap */
        if (k < c->ncrack) v[l.overlap] = fmin (v[l.overlap], fmax (0, c->initial[i] - c->gap[i]));
    }
    /* taken from the memory, whose vectors are rounded, as a resumed run takes them */
    contact_recall (c);
}

/* Copies a memory. */
static pg_status copy (contact_memory *to, const contact_memory *from, size_t dim)
{
    pg_status status = PG_OK;
    size_t values = contact_layout_of (dim).values;
    PG_GROW (to->value, to->room, from->n * values);
    if (from->n) memcpy (to->value, from->value, from->n * values * sizeof *to->value);
    to->n = from->n, to->friction = from->friction, to->at = from->at;
done:
    return status;
}

pg_status contact_save (pg_system *s)
{
    struct system_contact *c = s->contact;
    if (c) platens_save (&c->platens);
    return c ? copy (&c->start, &c->now, c->pieces.dim) : PG_OK;
}

/* Restores the memory of the start of a refused step; the present pieces, which may be those of that step,
 * take their values from it. Nothing is allocated if the memory then had no more pieces than now. */
void contact_return (pg_system *s)
{
    struct system_contact *c = s->contact;
    if (!c || copy (&c->now, &c->start, c->pieces.dim) != PG_OK) return;
    s->report->energy.friction = c->now.friction;
    platens_return (&c->platens);
    /* pieces of platens that closed in the refused step stay pairs */
    if (c->now.n != c->pieces.n && contact_remember (c) != PG_OK) return;
    contact_recall (c);
}

static pg_status keep_memory (contact_memory *m, const char *name, const pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    size_t values = contact_layout_of ((size_t) s->problem->dim).values;
    PG_TRY (pg_keep_fields (k, name, "count", NULL, 1, PG_ROWS (
        PG_KEPT_IN (m->n, 0, s->problem->bonds.first[PG_BOND_SETS], "the number of pieces in contact"))));
    if (k->reading) PG_GROW (m->value, m->room, m->n * values);
    PG_TRY (pg_keep_numbers (k, name, "friction", 1, &m->friction));
    PG_TRY (pg_keep_numbers (k, name, "at", 1, &m->at));
    if (m->n) PG_TRY (pg_keep_numbers (k, name, "values", m->n * values, m->value));
done:
    return status;
}

/* Keeps the pieces stored for results that are not written yet. */
static pg_status keep_shown (pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    size_t most = s->problem->bonds.first[PG_BOND_SETS];
    PG_KEEP_LENGTH (k, "contact", "shown_count", c->shown, c->nshown, c->cap_shown, most,
                    "the number of pieces in contact");
    PG_TRY (pg_keep_fields (
        k, "contact", "shown", "shown_values", c->nshown,
        PG_ROWS (PG_EACH_IN (c->shown, path, 0, most, "the path of a piece"),
                 PG_EACH_IN (c->shown, status, PG_CONTACT_OPEN, PG_CONTACT_SLIDING, "the status of a piece"),
                 PG_EACH_IN (c->shown, platen, 0, s->problem->boundary.nplaten, "the platen of a piece"),
                 PG_EACH (c->shown, x), PG_EACH (c->shown, normal), PG_EACH (c->shown, area),
                 PG_EACH (c->shown, length), PG_EACH (c->shown, arc), PG_EACH (c->shown, pressure),
                 PG_EACH (c->shown, shear), PG_EACH (c->shown, gap), PG_EACH (c->shown, slip))));
done:
    return status;
}

/* Keeps forces, gaps and status of the present pieces, as a state that is solved is not solved again. Called
 * after caches have been made again. */
pg_status contact_keep (pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    if (!c) return PG_OK;
    pg_statistics *r = s->report;
    PG_TRY (platens_keep (s, k));
    if (k->reading && c->platens.n) PG_TRY (contact_more_pairs (s));
    long piece[4] = { r->contact.pieces, r->contact.open, r->contact.stick, r->contact.sliding };
    size_t n = c->pieces.n;
    int made = c->compliance.made == s->direct.revision + 1, active = c->is.active;
    PG_TRY (keep_memory (&c->now, "contact.now", s, k));
    PG_TRY (keep_memory (&c->start, "contact.start", s, k));
    PG_TRY (keep_shown (s, k));
    PG_TRY (pg_keep_fields (k, "contact", "counts", NULL, 1, PG_ROWS (
        PG_KEPT_IN (n, c->pieces.n, c->pieces.n, "the number of pieces of cracks"),
        PG_KEPT_IN (active, 0, 1, "contact"), PG_KEPT (r->contact.passes), PG_KEPT (r->contact.sweeps),
        PG_KEPT (c->is.touched), PG_KEPT (made),
        PG_KEPT_IN (c->compliance.alone, 0, c->pieces.dim * n, "contact"), PG_KEPT (piece))));
    contact_set_active (s, active);
    if (k->reading) c->compliance.again = made ? s->direct.revision + 1 : 0;
    PG_TRY (contact_route_keep (s, k));
    if (!c->pieces.n) return PG_OK;
    PG_TRY (k->numbers (k->context, "contact.force", c->pieces.dim * c->pieces.n, c->force));
    PG_TRY (k->numbers (k->context, "contact.gap", c->pieces.dim * c->pieces.n, c->gap));
    PG_TRY (pg_keep_bytes (k, "contact.status", c->pieces.n, c->status, PG_CONTACT_SLIDING,
                           "the status of a piece"));
    if (k->reading) contact_recall (c);
    if (k->reading) platens_gaps (s);                  /* the work of platens counts from these gaps */
    if (k->reading) pg_sparse_multiply (&c->G, c->force, c->nodal);
    if (k->reading) contact_count (s);
    r->contact.pieces = piece[0], r->contact.open = piece[1];
    r->contact.stick = piece[2], r->contact.sliding = piece[3];
done:
    return status;
}
