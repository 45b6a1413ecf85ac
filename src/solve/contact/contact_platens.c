/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rigid platens in equilibria with contact: their pieces follow those of cracks, their prescribed motion
 * enters the gaps, their free motion is an unknown beside the forces (contact_free.c). Only pieces that can
 * come near are pairs: those within a spacing of the nearest one, or within the displacement of the platen;
 * the gaps of the others are checked after each solve, and closed ones become pairs. Work of platens is
 * summed by trapezoids like that of loads. */
#include "contact.h"
#include <math.h>
#include <string.h>

/* Pieces are pairs up to this distance beyond the nearest piece and the displacement of the platen,
 * spacings. */
static const double NEAR = 1;

/* ---- life ---------------------------------------------------------------------------------------------- */
static pg_status append (pg_contact_pieces *to, const pg_contact_pieces *from, const unsigned char *which)
{
    pg_status status = PG_OK;
    size_t dim = from->dim, points = to->npoint, pieces = to->n;
    for (size_t k = 0; k < from->n; k++)
        if (!which || which[k]) pieces++, points += from->first[k + 1] - from->first[k];
    size_t room[6] = { 0 };
    PG_GROW (to->piece, room[0], pieces + 1);
    PG_GROW (to->first, room[1], pieces + 1);
    PG_GROW (to->x, room[2], points * dim);
    PG_GROW (to->normal, room[3], points * dim);
    PG_GROW (to->tangent, room[4], points * dim * (dim - 1));
    PG_GROW (to->weight, room[5], points);
    to->dim = dim;
    if (!to->n) to->first[0] = 0;
    for (size_t k = 0; k < from->n; k++) {
        if (which && !which[k]) continue;
        size_t q = from->first[k], count = from->first[k + 1] - q, at = to->npoint;
        memcpy (to->x + at * dim, from->x + q * dim, count * dim * sizeof *to->x);
        memcpy (to->normal + at * dim, from->normal + q * dim, count * dim * sizeof *to->x);
        memcpy (to->tangent + at * dim * (dim - 1), from->tangent + q * dim * (dim - 1),
                count * dim * (dim - 1) * sizeof *to->x);
        memcpy (to->weight + at, from->weight + q, count * sizeof *to->x);
        to->piece[to->n++] = from->piece[k];
        to->npoint += count, to->first[to->n] = to->npoint;
    }
done:
    return status;
}

/* Reduces the mean gaps between a platen and the pieces of a curved surface, by which a disk of radius R
 * would touch a plane (2 h)^2 / 6 R too late: all by the difference between the mean gap of the nearest piece
 * and the least distance there. Then the first touch is right, and the shape of the surface stays. */
static void begin_at_first_touch (const pg_problem *p, const pg_contact_pieces *one, size_t platen,
                                  double *gap)
{
    size_t nearest = 0;
    for (size_t k = 1; k < one->n; k++) if (gap[k] < gap[nearest]) nearest = k;
    double h = pg_problem_spacing_at (p, one->piece[nearest].x),
           late = gap[nearest] - fmax (pg_platen_touches (one, &p->boundary.platen[platen], h), 0);
    for (size_t k = 0; k < one->n && late > PG_NO_LENGTH * h; k++) gap[k] -= late;
}

/* Finds the pieces opposite all platens from the positions at the start; a platen inside the body is
 * refused. */
pg_status platens_create (pg_system *s)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    contact_platens *w = &c->platens;
    const pg_problem *p = s->problem;
    pg_contact_pieces one = { 0 };
    double *gap = NULL;
    char key[32];
    size_t dim = (size_t) p->dim, room = 0;
    w->n = p->boundary.nplaten;
    PG_ALLOC (w->motion, w->n);
    PG_ALLOC (w->reaction, w->n);
    PG_ALLOC (w->shown, w->n);
    for (size_t i = 0; i < w->n; i++) {
        PG_TRY (pg_platen_pieces_create (&one, &gap, p, i));
        snprintf (key, sizeof key, "platens[%zu]", i);
        if (!one.n)
            PG_TRY (options_fault (s->options, key,
                                   "nothing of the body's surface faces the platen %s: turn its normal, or "
                                   "move it", p->boundary.platen[i].name));
        for (size_t k = 0; k < one.n; k++)
            if (gap[k] < -PG_NO_LENGTH * pg_problem_spacing_at (p, one.piece[k].x))
                PG_TRY (options_fault (s->options, key,
                                       "the platen %s overlaps the body by %.3g m at (%.6g, %.6g, %.6g) m "
                                       "before anything moves: put it where it touches at most (a body of "
                                       "whole cells has a surface of steps: cells: cut)",
                                       p->boundary.platen[i].name, -gap[k], one.piece[k].x[0],
                                       one.piece[k].x[1], one.piece[k].x[2]));
        begin_at_first_touch (p, &one, i, gap);
        size_t before = w->all.n;
        PG_TRY (append (&w->all, &one, NULL));
        PG_GROW (w->distance, room, w->all.n);
        memcpy (w->distance + before, gap, one.n * sizeof *gap);
        pg_contact_pieces_clear (&one);
        pg_free (gap), gap = NULL;
    }
    PG_ALLOC (w->row, 6 * dim * w->all.n);
    PG_ALLOC (w->booked, 2 * dim * w->all.n);
    PG_ALLOC (w->start, 2 * dim * w->all.n);
    PG_ALLOC (w->taken, w->all.n);
    PG_ALLOC (w->at, w->all.n);
    for (size_t k = 0; k < w->all.n; k++)
        pg_platen_row (&w->all, k, p->boundary.platen[w->all.piece[k].platen - 1].point,
                       w->row + 6 * dim * k);
    platens_take (s);
done:
    pg_contact_pieces_clear (&one);
    pg_free (gap);
    return status;
}

void platens_free (contact_platens *w)
{
    pg_contact_pieces_clear (&w->all);
    pg_sparse_clear (&w->G);
    pg_free (w->distance), pg_free (w->row), pg_free (w->taken), pg_free (w->at);
    pg_free (w->motion), pg_free (w->reaction), pg_free (w->booked), pg_free (w->start), pg_free (w->shown);
    memset (w, 0, sizeof *w);
}

/* Prescribed component k of a platen at t, m. */
static double prescribed (const pg_problem *p, size_t i, int k, double t)
{
    static const double anywhere[3] = { 0 };
    int load = p->boundary.platen[i].motion;
    return load < 0 ? 0 : pg_load_value (&p->boundary.load[load], k, p->dim, anywhere, t);
}

/* Marks the pieces that are pairs from the start. */
void platens_take (pg_system *s)
{
    contact_platens *w = &s->contact->platens;
    const pg_problem *p = s->problem;
    double ends = p->boundary.nstage ? (double) p->boundary.nstage : 1;
    for (size_t i = 0; i < w->n; i++) {
        double least = INFINITY, way = 0;
        for (size_t k = 0; k < w->all.n; k++)
            if (w->all.piece[k].platen == i + 1) least = fmin (least, w->distance[k]);
        for (int look = 1; look <= 8; look++) {
            double size = 0;
            for (int k = 0; k < p->dim; k++) size += pow (prescribed (p, i, k, ends * look / 8), 2);
            way = fmax (way, sqrt (size));
        }
        for (size_t k = 0; k < w->all.n; k++) {
            if (w->all.piece[k].platen != i + 1) continue;
            double near = NEAR * pg_problem_spacing_at (p, w->all.piece[k].x);
            w->taken[k] = w->distance[k] <= least + near || w->distance[k] <= way;
        }
    }
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
/* out = columns of two matrices side by side; of b those whose pieces are taken. */
static pg_status join_columns (pg_sparse *out, const pg_sparse *a, const pg_sparse *b, size_t width,
                               const unsigned char *taken)
{
    pg_status status = PG_OK;
    size_t entries = a->start ? (size_t) a->start[a->ncol] : 0, columns = a->ncol, at = 0;
    for (size_t j = 0; j < b->ncol; j++)
        if (taken[j / width]) columns++, entries += (size_t) (b->start[j + 1] - b->start[j]);
    PG_TRY (pg_sparse_create (out, b->nrow, columns, entries, 0));
    for (int part = 0; part < 2; part++) {
        const pg_sparse *m = part ? b : a;
        for (size_t j = 0; m->start && j < m->ncol; j++) {
            if (part && !taken[j / width]) continue;
            size_t count = (size_t) (m->start[j + 1] - m->start[j]);
            long to = out->start[at];
            memcpy (out->row + to, m->row + m->start[j], count * sizeof *out->row);
            memcpy (out->value + to, m->value + m->start[j], count * sizeof *out->value);
            out->start[++at] = to + (long) count;
        }
    }
done:
    return status;
}

pg_status platens_join (pg_system *s)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    contact_platens *w = &c->platens;
    pg_sparse both = { 0 };
    c->pieces.n = c->ncrack, c->pieces.npoint = c->ncrack ? c->pieces.first[c->ncrack] : 0;
    PG_TRY (append (&c->pieces, &w->all, w->taken));
    for (size_t k = 0, at = c->ncrack; k < w->all.n; k++) if (w->taken[k]) w->at[at++ - c->ncrack] = k;
    if (c->ncrack) c->G.ncol = c->ncrack * c->pieces.dim;
    else c->G.ncol = 0;
    PG_TRY (join_columns (&both, &c->G, &w->G, c->pieces.dim, w->taken));
    pg_sparse_clear (&c->G);
    c->G = both;
done:
    return status;
}

pg_status platens_refresh (pg_system *s, const pg_state *state)
{
    pg_status status = PG_OK;
    contact_platens *w = &s->contact->platens;
    pg_jump_rows rows = { 0 };
    if (!w->n) return PG_OK;
    if (!s->force->surfaces.trace)
        PG_FAIL (PG_E_USAGE, "platens are known of forces that show the displacement of the surface");
    PG_TRY (s->force->surfaces.trace (s->self, state, w->all.npoint, w->all.x, w->all.normal, &rows));
    pg_sparse_clear (&w->G);
    PG_TRY (pg_contact_rows_of (&w->G, &w->all, s->problem, &rows));
    PG_TRY (platens_join (s));
done:
    pg_jump_rows_clear (&rows);
    return status;
}

/* ---- motion -------------------------------------------------------------------------------------------- */
void platens_place (pg_system *s, double t)
{
    contact_platens *w = &s->contact->platens;
    for (size_t i = 0; i < w->n; i++) {
        memset (w->motion[i], 0, sizeof w->motion[i]);
        for (int k = 0; k < s->problem->dim; k++) w->motion[i][k] = prescribed (s->problem, i, k, t);
    }
    platens_gaps (s);
}

/* Change of gap `row` of a piece by the motion of its platen, m. */
static double gain (const contact_platens *w, size_t piece, size_t row)
{
    const double *b = w->row + 6 * (w->all.dim * piece + row), *q = w->motion[w->all.piece[piece].platen - 1];
    double sum = 0;
    for (int k = 0; k < 6; k++) sum += b[k] * q[k];
    return sum;
}

void platens_gaps (pg_system *s)
{
    struct system_contact *c = s->contact;
    contact_platens *w = &c->platens;
    size_t dim = c->pieces.dim;
    for (size_t k = c->ncrack; w->n && k < c->pieces.n; k++) {
        size_t piece = w->at[k - c->ncrack];
        for (size_t a = 0; a < dim; a++)
            c->initial[dim * k + a] = (a ? 0 : w->distance[piece]) + gain (w, piece, a);
    }
}

/* Makes pairs of pieces that have closed and were none. */
int platens_look (pg_system *s, const double *d)
{
    contact_platens *w = &s->contact->platens;
    size_t dim = w->all.dim;
    int found = 0;
    for (size_t k = 0; k < w->all.n; k++) {
        double gap = w->distance[k] + (w->taken[k] ? 0 : gain (w, k, 0));
        if (w->taken[k]) continue;
        for (long e = w->G.start[dim * k]; e < w->G.start[dim * k + 1]; e++)
            gap += w->G.value[e] * d[w->G.row[e]];
        if (gap < 0) w->taken[k] = 1, found = 1;
    }
    return found;
}

double platens_press (const pg_problem *p, size_t i, int k, double t)
{
    static const double anywhere[3] = { 0 };
    int load = p->boundary.platen[i].force;
    return load < 0 || k >= 3 ? 0 : pg_load_value (&p->boundary.load[load], k, p->dim, anywhere, t);
}

/* Finds forces and moments (about `point`) of the platens on the body: - B' f. */
void platens_react (pg_system *s)
{
    struct system_contact *c = s->contact;
    contact_platens *w = &c->platens;
    size_t dim = c->pieces.dim;
    for (size_t i = 0; i < w->n; i++) memset (w->reaction[i], 0, sizeof w->reaction[i]);
    for (size_t k = c->ncrack; w->n && c->is.active && k < c->pieces.n; k++) {
        size_t piece = w->at[k - c->ncrack];
        double *to = w->reaction[w->all.piece[piece].platen - 1];
        for (size_t a = 0; a < dim; a++)
            for (int m = 0; m < 6; m++)
                to[m] -= w->row[6 * (dim * piece + a) + (size_t) m] * c->force[dim * k + a];
    }
}

/* ---- work and results ---------------------------------------------------------------------------------- */
/* Sums work piece by piece, force times displacement: across the surface that of the body, so that a platen
 * that comes from afar does work only from the first touch on; along it that of the platen, so that slip
 * counts as friction. */
double platens_book (pg_system *s, double scale)
{
    struct system_contact *c = s->contact;
    contact_platens *w = c ? &c->platens : NULL;
    double work = 0;
    size_t dim = c ? c->pieces.dim : 0;
    for (size_t k = c ? c->ncrack : 0; w && w->n && k < c->pieces.n; k++) {
        size_t piece = w->at[k - c->ncrack];
        double *old = w->booked + 2 * dim * piece;
        for (size_t a = 0; a < dim; a++) {
            size_t i = dim * k + a;
            double f = c->is.active ? scale * c->force[i] : 0,
                   way = scale * (a ? -gain (w, piece, a) : c->gap[i] - c->initial[i]);
            work += 0.5 * (old[a] + f) * (way - old[dim + a]);
            old[a] = f, old[dim + a] = way;
        }
    }
    return work;
}

void platens_reactions (const pg_system *s, double *reaction)
{
    const contact_platens *w = s->contact ? &s->contact->platens : NULL;
    int nload = (int) s->problem->boundary.nload;
    for (size_t i = 0; w && reaction && i < w->n; i++)
        for (int k = 0; k < 6; k++) {
            const pg_platen *p = &s->problem->boundary.platen[i];
            int at = k < 3 ? k : 3 * nload + k - 3;
            if (p->motion >= 0) reaction[3 * p->motion + at] = w->reaction[i][k];
            if (p->force >= 0) reaction[3 * p->force + at] = w->reaction[i][k];
        }
}

double platens_secant (const pg_system *s)
{
    const contact_platens *w = s->contact ? &s->contact->platens : NULL;
    double sum = 0;
    for (size_t i = 0; w && i < w->n; i++)
        for (int k = 0; k < 6; k++) sum += w->reaction[i][k] * w->motion[i][k];
    return sum;
}

void platens_show (pg_system *s, double scale)
{
    contact_platens *w = &s->contact->platens;
    for (size_t i = 0; i < w->n; i++)
        for (int k = 0; k < 6; k++)
            w->shown[i].force[k] = scale * w->reaction[i][k], w->shown[i].motion[k] = scale * w->motion[i][k];
}

const pg_platen_values *pg_solver_platens (const pg_solver *s, size_t *n)
{
    const struct system_contact *c = s->break_loop.system.contact;
    if (s->moving) {
        *n = s->problem->boundary.nplaten;
        return s->moving;
    }
    *n = c ? c->platens.n : 0;
    return c ? c->platens.shown : NULL;
}

/* Warns where a platen that moves along its surface meets other parts of a curved one: where the linear gap
 * differs much from the true distance there. */
void platens_doubt (pg_system *s)
{
    struct system_contact *c = s->contact;
    contact_platens *w = &c->platens;
    size_t dim = c->pieces.dim;
    double worst = 0, h = s->problem->cloud.h;
    size_t at = 0;
    if ((w->warned & PLATENS_SLIDE) || !w->n || !c->is.active) return;
    for (size_t k = c->ncrack; k < c->pieces.n; k++) {
        const pg_contact_piece *piece = &c->pieces.piece[k];
        const pg_platen *p = &s->problem->boundary.platen[piece->platen - 1];
        double side = 0;
        if (!(c->force[dim * k] > 0) || p->shape == PG_PLATEN_PLANE) continue;
        for (size_t a = 1; a < dim; a++) side += c->gap[dim * k + a] * c->gap[dim * k + a];
        if (0.5 * side / p->radius > worst) worst = 0.5 * side / p->radius, at = k;
    }
    if (!(worst > 1e-2 * h)) return;
    w->warned |= PLATENS_SLIDE;
    pg_statistics_warn (s->report,
                        "the body slides along the curved platen %s by %.3g m: gaps are measured along the "
                        "normals at the start, which puts them out by %.2g m there",
                        s->problem->boundary.platen[c->pieces.piece[at].platen - 1].name,
                        sqrt (2 * worst * s->problem->boundary.platen[c->pieces.piece[at].platen - 1].radius),
                        worst);
}

/* 1: some platen bears a force. */
static int any_touches (const contact_platens *w)
{
    for (size_t i = 0; i < w->n; i++)
        for (int k = 0; k < 3; k++) if (w->reaction[i][k] != 0) return 1;
    return 0;
}

void platens_tell (pg_system *s)
{
    struct system_contact *c = s->contact;
    if (!c) return;
    contact_platens *w = &c->platens;
    if (w->n && !(w->warned & PLATENS_AWAY) && !any_touches (w)) {
        pg_statistics_warn (s->report, "at the end no platen touches the body: look at the signs of their "
                            "displacements and forces");
        w->warned |= PLATENS_AWAY;
    }
    if (c->loose.unresisted && !(w->warned & PLATENS_UNRESISTED)) {
        pg_statistics_warn (s->report, "parts that contact alone holds can move in %zu way%s that "
                            "nothing resists: of all the answers this is the one that leaves their mean "
                            "place as it was", c->loose.unresisted, c->loose.unresisted > 1 ? "s" : "");
        w->warned |= PLATENS_UNRESISTED;
    }
}

/* ---- checkpoints --------------------------------------------------------------------------------------- */
void platens_save (contact_platens *w)
{
    if (w->n) memcpy (w->start, w->booked, 2 * w->all.dim * w->all.n * sizeof *w->start);
}

void platens_return (contact_platens *w)
{
    if (w->n) memcpy (w->booked, w->start, 2 * w->all.dim * w->all.n * sizeof *w->start);
}

/* Writes or reads back platens; called before the pairs are read, as it tells which pieces are pairs. */
pg_status platens_keep (pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    contact_platens *w = &s->contact->platens;
    if (!w->n) return PG_OK;
    PG_TRY (k->bytes (k->context, "platens.taken", w->all.n, w->taken));
    PG_TRY (pg_keep_fields (k, "platens", "warned", NULL, 1, PG_ROWS (
        PG_KEPT_IN (w->warned, 0, 7, "a warning of platens"))));
    PG_TRY (k->numbers (k->context, "platens.motion", 6 * w->n, w->motion[0]));
    PG_TRY (k->numbers (k->context, "platens.reaction", 6 * w->n, w->reaction[0]));
    PG_TRY (k->numbers (k->context, "platens.booked", 2 * w->all.dim * w->all.n, w->booked));
    PG_TRY (k->numbers (k->context, "platens.start", 2 * w->all.dim * w->all.n, w->start));
    PG_TRY (pg_keep_fields (k, "platens", NULL, "shown", w->n, PG_ROWS (
        PG_EACH (w->shown, force), PG_EACH (w->shown, motion))));
done:
    return status;
}
