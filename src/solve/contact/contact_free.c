/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact with free rigid motions: of platens under a force or free to tilt, and of parts of the body that
 * supports do not hold. The amounts y of the motions enter the gaps, g = g0 + C f + B y, and each has an
 * equation of balance, Q + B' f = 0: Q is the force on the platen (of a free tilt: 0), or the work of the
 * loads of a part along its rigid motion. The method of multipliers finds them: springs of compliance S, much
 * softer than the body, pull each motion to its last value,
 *
 *     y = y_old + S (Q + B' f),    g = g0 + B (y_old + S Q) + (C + B S B') f,
 *
 * which is a problem of contact of the usual kind, and have no effect once y no longer changes (Rockafellar
 * 1976). Each round removes the springs' share of the balance, a hundredth of it and less. */
#include "contact.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Compliance of a spring over that of a piece of the surface. */
static const double SOFT = 1000;
/* A round that leaves more than this share of the imbalance is slow: its springs get softer by SOFTER. */
static const double SLOW = 0.3, SOFTER = 8;
/* Imbalance of a motion over its largest force: aimed at; accepted where rounding ends the rounds. */
static const double BALANCED = 1e-13, ACCEPTED = 1e-9;
enum { MOST_ROUNDS = 80 };
/* Motions count as free where closed pairs resist them by less than this share of the largest resistance. */
static const double RESISTED = 1e-12;
/* Sums whose terms cancel to this share are rounding. */
static const double ROUNDED = 1e-12;
/* Forces below this share of the forces in the body, or of those that would undo the overlap, are
 * rounding. */
static const double NOISE = 1e-15;

/* A free motion: of a platen along an axis (3..5: about it), or of a part (its mode of contact_loose; else
 * SIZE_MAX). */
typedef struct { size_t platen; int axis; size_t mode; } motion;

/* The m free motions with the gaps of n pieces; columns of B (dim n x m): gaps per unit of a motion. */
typedef struct {
    pg_system *s;
    struct system_contact *c;
    size_t  m, rows;
    double  size;                                      /* size of the body, m: radius of arcs of rotations */
    double  noise;                                     /* size of forces that are rounding, N */
    motion *motion;
    double *B, *Q, *S, *y, *C, *gap;
} problem_of_motions;

/* ---- motions ------------------------------------------------------------------------------------------- */
static double size_of_body (const pg_problem *p)
{
    double low[3], high[3], sum = 0;
    pg_problem_box (p, low, high);
    for (int k = 0; k < p->dim; k++) sum += (high[k] - low[k]) * (high[k] - low[k]);
    return sqrt (sum);
}

/* 1: the platen can tilt about that axis, and this changes its gaps. */
static int turns (const pg_problem *p, const pg_platen *w, int axis)
{
    if (!w->tilts) return 0;
    if (p->dim == 2) return axis == 2;
    /* rotation about its own normal or axis does not change a surface of revolution */
    return w->shape != PG_PLATEN_PLANE || fabs (w->normal[axis]) < 1 - 1e-12;
}

size_t contact_motions (const pg_system *s)
{
    const struct system_contact *c = s->contact;
    size_t m = c->loose.n;
    for (size_t i = 0; i < c->platens.n; i++)
        for (int k = 0; k < 6; k++)
            m += k < 3 ? (size_t) s->problem->boundary.platen[i].free[k]
                       : (size_t) turns (s->problem, &s->problem->boundary.platen[i], k - 3);
    return m;
}

static void column_of_platen (problem_of_motions *w, size_t j)
{
    const contact_platens *p = &w->c->platens;
    size_t dim = w->c->pieces.dim;
    double unit = w->motion[j].axis < 3 ? 1 : 1 / w->size;
    for (size_t k = w->c->ncrack; k < w->c->pieces.n; k++) {
        size_t piece = p->at[k - w->c->ncrack];
        if (p->all.piece[piece].platen != w->motion[j].platen + 1) continue;
        for (size_t a = 0; a < dim; a++)
            w->B[j * w->rows + dim * k + a] = unit * p->row[6 * (dim * piece + a)
                                                            + (size_t) w->motion[j].axis];
    }
}

/* row = change of the gaps by a rigid motion of a part; 0 where it is rounding, as of a part that moves with
 * its crack as a whole. */
static void row_of_part (const problem_of_motions *w, const double *mode, double *row)
{
    const pg_sparse *G = &w->c->G;
    for (size_t i = 0; i < G->ncol; i++) {
        double sum = 0, size = 0;
        for (long e = G->start[i]; e < G->start[i + 1]; e++)
            sum += G->value[e] * mode[G->row[e]], size += fabs (G->value[e] * mode[G->row[e]]);
        row[i] = fabs (sum) > ROUNDED * size ? sum : 0;
    }
}

static pg_status find_motions (problem_of_motions *w)
{
    pg_status status = PG_OK;
    const pg_problem *p = w->s->problem;
    const contact_loose *l = &w->c->loose;
    PG_ALLOC (w->motion, w->m);
    PG_ALLOC (w->B, w->m * w->rows);
    PG_ALLOC (w->S, w->m);
    PG_ALLOC (w->y, w->m);
    PG_ALLOC (w->C, w->rows * w->rows);
    PG_ALLOC (w->gap, w->rows);
    size_t j = 0;
    for (size_t i = 0; i < w->c->platens.n; i++)
        for (int k = 0; k < 6; k++) {
            if (k < 3 ? !p->boundary.platen[i].free[k] : !turns (p, &p->boundary.platen[i], k - 3)) continue;
            w->motion[j] = (motion) { i, k, SIZE_MAX };
            column_of_platen (w, j++);
        }
    for (size_t i = 0; i < l->n; i++, j++) {
        w->motion[j] = (motion) { SIZE_MAX, 0, i };
        row_of_part (w, l->mode + i * w->s->ndof, w->B + j * w->rows);
    }
done:
    return status;
}

/* Q = work of the loads at t along each motion. */
static pg_status find_loads (problem_of_motions *w, double t, double *Q)
{
    pg_status status = PG_OK;
    pg_system *s = w->s;
    double *zero = NULL, *residual = NULL, reference;
    PG_ALLOC (zero, s->ndof);
    PG_ALLOC (residual, s->ndof);
    if (w->c->loose.n) PG_TRY (s->force->balance (s->self, t, zero, residual, &reference));
    for (size_t j = 0; j < w->m; j++) {
        const motion *q = &w->motion[j];
        Q[j] = q->mode != SIZE_MAX ? 0
               : q->axis < 3       ? platens_press (s->problem, q->platen, q->axis, t)
                                   : 0;
        const double *mode = q->mode != SIZE_MAX ? w->c->loose.mode + q->mode * s->ndof : NULL;
        double all = 0;
        for (size_t i = 0; mode && i < s->ndof; i++)
            Q[j] += mode[i] * residual[i], all += fabs (mode[i] * residual[i]);
        if (mode && fabs (Q[j]) <= ROUNDED * all) Q[j] = 0;
    }
done:
    pg_free (zero), pg_free (residual);
    return status;
}

/* ---- messages ------------------------------------------------------------------------------------------ */
static pg_status refuse (const problem_of_motions *w, size_t j, double left)
{
    const motion *q = &w->motion[j];
    const pg_problem *p = w->s->problem;
    if (q->mode == SIZE_MAX)
        return pg_error (PG_E_EQUILIBRIUM, PG_HERE,
                         "the platen %s moves %s %c without end: nothing of the body bears %.3g N of what "
                         "presses it; prescribe its displacement, or hold the body",
                         p->boundary.platen[q->platen].name, q->axis < 3 ? "along" : "about",
                         "xyz"[q->axis % 3], left);
    const contact_loose *l = &w->c->loose;
    const body_part *part = &l->part[q->mode];
    char place[BODY_PART_WORDS], way[BODY_PART_WORDS];
    body_part_place (p, part, place, sizeof place);
    body_part_way (p, part, part->motion[l->motion[q->mode]], way, sizeof way);
    return pg_error (PG_E_EQUILIBRIUM, PG_HERE,
                     "a part of the body, %s, is held neither by prescribed displacements nor by what it "
                     "touches: it is free to move %s, and %.3g N of its loads stay unbalanced; prescribe "
                     "displacements of it, more friction, or use a solver of motion", place, way, left);
}

/* ---- the rounds ---------------------------------------------------------------------------------------- */
/* Sets the springs by the compliance of the pieces whose gaps a motion changes. */
static void find_springs (problem_of_motions *w)
{
    size_t n = w->rows;
    for (size_t j = 0; j < w->m; j++) {
        const double *b = w->B + j * n;
        double own = 0, size = 0, count = 0;
        for (size_t i = 0; i < n; i++)
            if (b[i] != 0) own += w->c->compliance.C[i * n + i], size += b[i] * b[i], count++;
        w->S[j] = size > 0 ? SOFT * own / count / size : 0;
    }
}

/* w->C = C + B S B', the compliance with springs. */
static void soften (problem_of_motions *w)
{
    size_t n = w->rows;
    memcpy (w->C, w->c->compliance.C, n * n * sizeof *w->C);
    for (size_t j = 0; j < w->m; j++) {
        const double *b = w->B + j * n;
        for (size_t i = 0; i < n; i++)
            for (size_t k = 0; b[i] != 0 && k < n; k++) w->C[i * n + k] += w->S[j] * b[i] * b[k];
    }
}

/* Softens the springs of motions whose balance hardly improves, as closed pieces resist them little (a block
 * that tilts on a few pieces). Returns 1 if there were some. */
static int soften_slow (problem_of_motions *w, const double *left, const double *last, double small)
{
    int any = 0;
    for (size_t j = 0; j < w->m; j++)
        if (fabs (left[j]) > small && fabs (left[j]) > SLOW * fabs (last[j])) w->S[j] *= SOFTER, any = 1;
    return any;
}

/* left = unbalanced force of each motion at the contact forces f; finds the largest, its motion, and the
 * largest force. */
static void find_balance (const problem_of_motions *w, const double *f, double *left, double *worst,
                          size_t *which, double *size)
{
    *worst = *size = 0, *which = 0;
    for (size_t j = 0; j < w->m; j++) {
        double sum = w->Q[j], all = fabs (w->Q[j]);
        for (size_t i = 0; i < w->rows; i++)
            sum += w->B[j * w->rows + i] * f[i], all += fabs (w->B[j * w->rows + i] * f[i]);
        left[j] = sum, *size = fmax (*size, all);
        if (fabs (sum) > *worst) *worst = fabs (sum), *which = j;
    }
}

/* A motion that no row resists and that is not in balance by itself; SIZE_MAX: none. */
static size_t without_rows (const problem_of_motions *w, double size)
{
    for (size_t j = 0; j < w->m; j++)
        if (w->S[j] == 0 && fabs (w->Q[j]) > fmax (ACCEPTED * size, w->noise)) return j;
    return SIZE_MAX;
}

/* A motion of more than the size of the body that is not in balance; SIZE_MAX: none. */
static size_t runs_away (const problem_of_motions *w, const double *left, double size)
{
    for (size_t j = 0; j < w->m; j++)
        if (!(fabs (w->y[j]) <= w->size) && fabs (left[j]) > fmax (ACCEPTED * size, w->noise)) return j;
    return SIZE_MAX;
}

/* Finds the size of forces that are rounding. Where a part only follows a platen, or bears nothing, contact
 * forces are rounding, and their own size is no measure: loads and reactions of the body are, and the forces
 * that would undo the overlap of pieces. */
static void find_noise (problem_of_motions *w, const double *open)
{
    double most = fmax (w->s->balance.reference, w->s->balance.borne);
    size_t dim = w->c->pieces.dim;
    for (size_t i = 0; i < w->rows; i += dim) {
        double gap = open[i], stiff = w->c->compliance.C[i * w->rows + i];
        for (size_t j = 0; j < w->m; j++) gap += w->B[j * w->rows + i] * w->y[j];
        if (gap < 0 && stiff > 0) most = fmax (most, -gap / stiff);
    }
    w->noise = w->c->loose.noise = NOISE * most;
}

/* Solves the problem of contact with the springs at their present positions. */
static pg_status press_springs (problem_of_motions *w, pg_contact_solution *out, const double *open)
{
    const struct system_contact *c = w->c;
    for (size_t i = 0; i < w->rows; i++) {
        w->gap[i] = open[i];
        for (size_t j = 0; j < w->m; j++)
            w->gap[i] += w->B[j * w->rows + i] * (w->y[j] + w->S[j] * w->Q[j]);
    }
    pg_contact_problem problem = { .n = c->pieces.n, .dim = c->pieces.dim, .C = w->C, .gap = w->gap,
                                   .coefficient = c->coefficient, .cohesion = c->cohesion,
                                   .slip = c->is.history ? c->before : NULL };
    return pg_contact_solve (out, &problem);
}

static pg_status iterate (problem_of_motions *w, pg_contact_solution *out, const double *open)
{
    pg_status status = PG_OK;
    double *left = NULL, *before, worst = INFINITY, last, size;
    size_t which = 0, bad;
    PG_ALLOC (left, 2 * w->m);
    before = left + w->m;
    find_noise (w, open);
    find_springs (w), soften (w);
    for (size_t i = 0; i < w->rows; i++) out->force[i] = 0;
    find_balance (w, out->force, left, &worst, &which, &size);
    bad = without_rows (w, size), worst = INFINITY;
    for (int round = 0; bad == SIZE_MAX && round < MOST_ROUNDS; round++) {
        PG_TRY (press_springs (w, out, open));
        last = worst;
        memcpy (before, left, w->m * sizeof *left);
        find_balance (w, out->force, left, &worst, &which, &size);
        for (size_t j = 0; j < w->m; j++) w->y[j] += w->S[j] * left[j];
        if (worst <= fmax (BALANCED * size, w->noise) || (worst <= ACCEPTED * size && worst > 0.5 * last))
            goto done;
        bad = runs_away (w, left, size);
        if (round > 0 && soften_slow (w, left, before, fmax (ACCEPTED * size, w->noise))) soften (w);
    }
    if (bad == SIZE_MAX) bad = which;
    if (!(fabs (left[bad]) <= fmax (ACCEPTED * size, w->noise))) status = refuse (w, bad, fabs (left[bad]));
done:
    pg_free (left);
    return status;
}

/* ---- motions that nothing resists ---------------------------------------------------------------------- */
/* N += products of the gap changes by each two motions, over closed pairs with their friction (m x m): what
 * resists combinations of motions. */
static void find_resistance (const problem_of_motions *w, const pg_contact_solution *out, double *N)
{
    size_t dim = w->c->pieces.dim;
    for (size_t k = 0; k < w->c->pieces.n; k++) {
        if (out->status[k] == PG_CONTACT_OPEN) continue;
        size_t rows = w->c->coefficient[k] > 0 || w->c->cohesion[k] > 0 ? dim : 1;
        for (size_t i = dim * k; i < dim * k + rows; i++)
            for (size_t a = 0; a < w->m; a++)
                for (size_t b = 0; b < w->m; b++)
                    N[a * w->m + b] += w->B[a * w->rows + i] * w->B[b * w->rows + i];
    }
}

/* u = displacement by a combination z of motions, of those of parts of the body. */
static void displacement_of (const problem_of_motions *w, const double *z, size_t stride, double *u)
{
    size_t n = w->s->ndof;
    memset (u, 0, n * sizeof *u);
    for (size_t j = 0; j < w->m; j++) {
        if (w->motion[j].mode == SIZE_MAX) continue;
        const double *mode = w->c->loose.mode + w->motion[j].mode * n;
        for (size_t i = 0; i < n; i++) u[i] += z[j * stride] * mode[i];
    }
}

/* Share (at most 1) of the amount `by` along z at which no open pair closes; present gaps in out->gap. */
static double room_for (const problem_of_motions *w, const pg_contact_solution *out, const double *z,
                        size_t stride, double by)
{
    double share = 1;
    size_t dim = w->c->pieces.dim;
    for (size_t k = 0; k < w->c->pieces.n; k++) {
        double change = 0;
        if (out->status[k] != PG_CONTACT_OPEN) continue;
        for (size_t j = 0; j < w->m; j++) change += by * z[j * stride] * w->B[j * w->rows + dim * k];
        if (change < 0) share = fmin (share, fmax (0, out->gap[dim * k] / -change));
    }
    return share;
}

/* Moves along the combination z until the mean of `moved` along it is zero; returns how far. u: workspace. */
static double centre_along (problem_of_motions *w, const pg_contact_solution *out, const double *z, double *u,
                            double *moved)
{
    double along = 0, size = 0;
    displacement_of (w, z, w->m, u);
    for (size_t i = 0; i < w->s->ndof; i++) along += u[i] * moved[i], size += u[i] * u[i];
    if (!(size > 0)) return 0;
    double by = -along / size;
    by *= room_for (w, out, z, w->m, by);
    for (size_t j = 0; j < w->m; j++) w->y[j] += by * z[j * w->m];
    for (size_t i = 0; i < w->s->ndof; i++) moved[i] += by * u[i];
    return fabs (by);
}

/* Determines motions that nothing resists: the mean displacement along each becomes zero, or as near to zero
 * as is possible without closing open pairs. So the answer depends on no single point of the part. */
static pg_status centre (problem_of_motions *w, const pg_contact_solution *out, const double *d)
{
    pg_status status = PG_OK;
    double *N = NULL, *value = NULL, *V = NULL, *u = NULL, *moved = NULL;
    size_t n = w->s->ndof;
    if (!w->c->loose.n) return PG_OK;
    PG_ALLOC (N, w->m * w->m);
    PG_ALLOC (V, w->m * w->m);
    PG_ALLOC (value, w->m);
    PG_ALLOC (u, n);
    PG_ALLOC (moved, n);
    find_resistance (w, out, N);
    pg_dense_eigen ((int) w->m, N, value, V);
    memcpy (moved, d, n * sizeof *d);
    for (size_t j = 0; j < w->m; j++) {
        double by = w->motion[j].mode == SIZE_MAX ? 0 : w->y[j] - w->c->loose.amount[w->motion[j].mode];
        const double *mode = by != 0 ? w->c->loose.mode + w->motion[j].mode * n : moved;
        for (size_t i = 0; by != 0 && i < n; i++) moved[i] += by * mode[i];
    }
    w->c->loose.unresisted = 0;
    for (size_t a = 0; a < w->m; a++)
        w->c->loose.unresisted += !(value[a] > RESISTED * value[0] && value[0] > 0);
    /* motions are not orthogonal to each other: repeat */
    double most = 1, first = 0;
    for (int pass = 0; pass < MOST_ROUNDS && most > BALANCED * first; pass++) {
        most = 0;
        for (size_t a = 0; a < w->m; a++) {
            if (value[a] > RESISTED * value[0] && value[0] > 0) continue;
            most = fmax (most, centre_along (w, out, V + a, u, moved));
        }
        if (pass == 0) first = most;
        if (most == 0) break;
    }
done:
    pg_free (N), pg_free (V), pg_free (value), pg_free (u), pg_free (moved);
    return status;
}

/* ---- pressing ------------------------------------------------------------------------------------------ */
/* The amount of motion j that the present gaps contain. */
static double *amount_of (problem_of_motions *w, size_t j)
{
    const motion *q = &w->motion[j];
    return q->mode != SIZE_MAX ? &w->c->loose.amount[q->mode] : &w->c->platens.motion[q->platen][q->axis];
}

pg_status contact_press_free (pg_system *s, double t, pg_contact_solution *out, double *open, double *d)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    problem_of_motions w = { .s = s, .c = c, .m = contact_motions (s), .rows = c->pieces.dim * c->pieces.n,
                             .size = size_of_body (s->problem) };
    PG_ALLOC (w.Q, w.m);
    PG_TRY (find_motions (&w));
    PG_TRY (find_loads (&w, t, w.Q));
    for (size_t j = 0; j < w.m; j++) {
        double unit = w.motion[j].mode == SIZE_MAX && w.motion[j].axis > 2 ? w.size : 1;
        w.y[j] = *amount_of (&w, j) * unit;
        for (size_t i = 0; i < w.rows; i++) open[i] -= w.B[j * w.rows + i] * w.y[j];
    }
    PG_TRY (iterate (&w, out, open));
    PG_TRY (centre (&w, out, d));
    for (size_t j = 0; j < w.m; j++) {
        double unit = w.motion[j].mode == SIZE_MAX && w.motion[j].axis > 2 ? w.size : 1,
               *now = amount_of (&w, j);
        if (w.motion[j].mode == SIZE_MAX) *now = w.y[j] / unit;
        else loose_move (&c->loose, s->ndof, w.motion[j].mode, w.y[j] - *now, d);
    }
    platens_gaps (s);
done:
    pg_free (w.motion), pg_free (w.B), pg_free (w.Q), pg_free (w.S), pg_free (w.y), pg_free (w.C),
        pg_free (w.gap);
    return status;
}
