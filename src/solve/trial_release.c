/* SPDX-License-Identifier: GPL-3.0-or-later
 * The potential energy that a cut releases at fixed loads. The body is linear: Pi (u) = u.K u/2 - f.u,
 * least at K u = f. A cut makes K' = K + dK and f' = f + df, which differ from K and f in the few unknowns
 * A beside it. With the residual of the old displacement in the cut body, r = f' - K' u (zero outside A),
 *
 *     Pi - Pi' = u.(r + df)/2 + r.x/2,    K' x = r,
 *
 * and (K'^-1)_AA = H (I + dK H)^-1 with H = (K^-1)_AA (Woodbury): the factor of the uncut body, one solve
 * with a right-hand side for every unknown of A, and a dense system of that order for each length of the
 * facet. For df = 0 this is -u_A.(I + dK H)^-1 dK u_A/2. All terms are local. Where there is no factor of K
 * (conjugate gradients, supports by elimination), where both terms are much larger than their sum (a cut
 * beside penalties, whose shape functions it changes), or where a part comes loose, the cut body is solved
 * anew, and the release is the difference of both potentials, which is also what tests compare with. */
#include "trial_facet.h"
#include "perigal/vector.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* More unknowns than this beside a cut: the cut body is solved anew instead. */
enum { MOST_COLUMNS = 3000, AT_ONCE = 64 };
/* Terms that cancel may be this many times as large as their sum; beyond, the cut body is solved anew. */
static const double most_lost = 30;

/* What one stage of a cut changes, as entries of the upper triangle of K and on the unknowns. */
typedef struct {
    size_t n, cap_row, cap_column, cap_value;
    long   *row, *column;
    double *value;                                     /* of dK, N/m */
    double *r[2];                                      /* residual of every field, N (ndof) */
    double work[3];                                    /* u_a.(r_b + df_b)/2, symmetric, J: 00, 01, 11 */
} change;

/* Polynomial of lambda of a quadratic form; two fields have the weights 1 - lambda and lambda. A part that
 * comes loose with its loads releases energy without bound, at whatever load. */
void trial_polynomial (const trial_fields *f, const trial_form *form, double *c)
{
    const double *v = form->value;
    if (!isfinite (v[0] + (f->n == 1 ? 0 : v[1] + v[2]))) {
        c[0] = f->n == 1 ? 0 : INFINITY, c[1] = 0, c[2] = f->n == 1 ? INFINITY : 0;
        return;
    }
    c[0] = f->n == 1 ? 0 : v[0];
    c[1] = f->n == 1 ? 0 : 2 * (v[1] - v[0]);
    c[2] = f->n == 1 ? v[0] : v[0] - 2 * v[1] + v[2];
}

pg_status trials_create (trials **out, pg_system *system)
{
    pg_status status = PG_OK;
    PG_ALLOC (*out, 1);
    (*out)->system = system;
done:
    return status;
}

void trials_free (trials **trials_)
{
    trials *w = *trials_;
    if (!w) return;
    pg_state_free (&w->state);
    pg_nearest_free (&w->points);
    pg_free (w->K), pg_free (w->after), pg_free (w->zero), pg_free (w->whole);
    for (int a = 0; a < 2; a++) pg_free (w->residual[a]), pg_free (w->load[a]), pg_free (w->excess[a]);
    pg_free (w);
    *trials_ = NULL;
}

/* Workspaces, and the copy of the state. */
static pg_status ready (trials *w, const pg_state *state)
{
    pg_status status = PG_OK;
    const pg_system *s = w->system;
    if (!w->state) PG_TRY (pg_state_create (&w->state, s->problem, s->components));
    if (!w->after) {
        PG_ALLOC (w->after, s->ndof);
        PG_ALLOC (w->zero, s->ndof);
        for (int a = 0; a < 2; a++) PG_ALLOC (w->residual[a], s->ndof);
        for (int a = 0; a < 2; a++) PG_ALLOC (w->load[a], s->ndof);
    }
    PG_TRY (pg_state_copy (w->state, state));
done:
    return status;
}

/* Cuts one stage on the copy of the state, and lets the caches of the force follow. */
static pg_status cut_stage (trials *w, const pg_changes *cut)
{
    const pg_system *s = w->system;
    for (size_t i = 0; i < cut->n; i++) w->state->alive[cut->bond[i]] = 0;
    return s->force->refresh (s->self, w->state, cut);
}

/* Brings the caches back to the state. Forces with shape functions evaluate the touched points from the bits
 * as they are; others forget what they had summed and begin anew. */
static pg_status restore (trials *w, const pg_state *state, size_t n, const pg_changes *cut)
{
    pg_status status = PG_OK;
    const pg_system *s = w->system;
    pg_changes all = { 0 };
    if (!s->problem->method->shape_functions) return s->force->refresh (s->self, state, NULL);
    for (size_t k = 0; k < n; k++) {
        PG_GROW (all.bond, all.cap, all.n + cut[k].n);
        if (cut[k].n) memcpy (all.bond + all.n, cut[k].bond, cut[k].n * sizeof *all.bond);
        all.n += cut[k].n;
    }
    pg_sort (all.bond, all.n, sizeof *all.bond, pg_ascending_sizes);
    PG_TRY (s->force->refresh (s->self, state, &all));
done:
    pg_free (all.bond);
    return status;
}

/* ---- by columns of the inverse ------------------------------------------------------------------------- */
/* A factor of K itself, without elimination. */
static int has_factor (const trials *w)
{
    const pg_system *s = w->system;
    int keeps = s->choice.mode == SYSTEM_FACTOR || s->choice.mode == SYSTEM_KEPT_FACTOR;
    return !w->never_columns && keeps && s->direct.linear->factors && system_has_matrix (s)
           && !(s->force->basis && s->force->basis (s->self));
}

/* Entries of K that a stage has changed: the rows of touched nodes were computed anew in the same order, so
 * that all others have kept their bits. */
static pg_status compare_matrix (trials *w, change *c)
{
    pg_status status = PG_OK;
    const pg_system *s = w->system;
    const pg_sparse *K;
    PG_TRY (pg_force_assemble (s->force, s->self, &K));
    for (size_t j = 0; j < s->ndof; j++)
        for (long q = K->start[j]; q < K->start[j + 1]; q++) {
            if (K->value[q] == w->K[q]) continue;
            PG_GROW (c->row, c->cap_row, c->n + 1);
            PG_GROW (c->column, c->cap_column, c->n + 1);
            PG_GROW (c->value, c->cap_value, c->n + 1);
            c->row[c->n] = K->row[q], c->column[c->n] = (long) j;
            c->value[c->n++] = K->value[q] - w->K[q];
        }
done:
    return status;
}

/* Residuals in the body as it is now, less those before: r = df - dK u; and the work terms. */
static pg_status compare_forces (trials *w, const trial_fields *f, change *c)
{
    pg_status status = PG_OK;
    const pg_system *s = w->system;
    double reference, df[2][2];
    for (int a = 0; a < f->n; a++) {
        PG_ALLOC (c->r[a], s->ndof);
        PG_TRY (s->force->balance (s->self, f->t[a], f->d[a], c->r[a], &reference));
        for (size_t i = 0; i < s->ndof; i++) c->r[a][i] -= w->residual[a][i];
        PG_TRY (s->force->balance (s->self, f->t[a], w->zero, w->after, &reference));
        for (int b = 0; b < f->n; b++) df[b][a] = pg_dot (s->ndof, f->d[b], w->after)
                                                  - pg_dot (s->ndof, f->d[b], w->load[a]);
    }
    for (int a = 0, k = 0; a < f->n; a++)
        for (int b = a; b < f->n; b++)
            c->work[k++] = 0.25 * (pg_dot (s->ndof, f->d[a], c->r[b]) + pg_dot (s->ndof, f->d[b], c->r[a])
                                   + df[a][b] + df[b][a]);
done:
    return status;
}

/* All stages: what each changes of K, and the residuals. */
static pg_status compare_stages (trials *w, const pg_state *state, const trial_fields *f, size_t n,
                                 const pg_changes *cut, change *c)
{
    pg_status status = PG_OK, back;
    pg_system *s = w->system;
    double reference;
    if (s->direct.stale) PG_TRY (system_factorize (s, NULL));
    s->choice.extra_cost = 0;
    const pg_sparse *K;
    PG_TRY (pg_force_assemble (s->force, s->self, &K));
    if (!w->K) PG_ALLOC (w->K, (size_t) K->start[s->ndof]);
    memcpy (w->K, K->value, (size_t) K->start[s->ndof] * sizeof *w->K);
    for (int a = 0; a < f->n; a++) {
        PG_TRY (s->force->balance (s->self, f->t[a], f->d[a], w->residual[a], &reference));
        PG_TRY (s->force->balance (s->self, f->t[a], w->zero, w->load[a], &reference));
    }
    for (size_t k = 0; k < n && status == PG_OK; k++) {
        status = cut_stage (w, &cut[k]);
        if (status == PG_OK) status = compare_matrix (w, &c[k]);
        if (status == PG_OK) status = compare_forces (w, f, &c[k]);
    }
    back = restore (w, state, n, cut);
    if (status == PG_OK) status = back;
    /* K is what it was: the factor stays */
    if (s->force->revision) s->direct.revision = s->force->revision (s->self);
done:
    return status;
}

/* The unknowns beside the cut of one stage, ascending: those of dK, and those whose loads have changed. */
static size_t beside (const pg_system *s, const trial_fields *f, const change *c, unsigned char *mark,
                      size_t *list)
{
    double largest = 0;
    size_t n = 0;
    memset (mark, 0, s->ndof);
    for (size_t e = 0; e < c->n; e++) mark[c->row[e]] = mark[c->column[e]] = 1;
    for (int a = 0; a < f->n; a++) {
        largest = 0;
        for (size_t i = 0; i < s->ndof; i++) largest = fmax (largest, fabs (c->r[a][i]));
        for (size_t i = 0; i < s->ndof; i++) if (fabs (c->r[a][i]) > 1e-12 * largest) mark[i] = 1;
    }
    for (size_t i = 0; i < s->ndof; i++) if (mark[i]) list[n++] = i;
    return n;
}

/* H = (K^-1)_AA, column by column (m x m). */
static pg_status inverse_block (trials *w, size_t m, const size_t *list, double *H)
{
    pg_status status = PG_OK;
    pg_system *s = w->system;
    double *b = NULL, *x = NULL, t0 = pg_seconds ();
    PG_ALLOC (b, AT_ONCE * s->ndof);
    PG_ALLOC (x, AT_ONCE * s->ndof);
    for (size_t first = 0; first < m; first += AT_ONCE) {
        size_t count = m - first < AT_ONCE ? m - first : AT_ONCE;
        for (size_t k = 0; k < count; k++) b[k * s->ndof + list[first + k]] = 1;
        PG_TRY (s->direct.linear->solve (s->direct.factor, count, b, x));
        for (size_t k = 0; k < count; k++) {
            b[k * s->ndof + list[first + k]] = 0;
            for (size_t i = 0; i < m; i++) H[(first + k) * m + i] = x[k * s->ndof + list[i]];
        }
    }
    w->columns += (long) m, w->by_columns++;
done:
    s->report->seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    pg_free (b), pg_free (x);
    return status;
}

/* What one stage leaves, on its own unknowns: numbers of them in A, their part of H, the matrix I + dK H. */
typedef struct {
    const trials *w;
    const change *c;
    size_t n;
    const size_t *list;                                /* of the stage -> unknown */
    size_t *own;                                       /* in A -> of the stage */
    const size_t *place;                               /* unknown -> in A */
    double *h, *M;                                     /* n x n, by columns */
    int    *pivot;                                     /* of M (n) */
    unsigned char *bare;                               /* no stiffness is left (n) */
} stage;

/* M = I + (dK + shift) H. The shift is for unknowns that the cut leaves without stiffness; `all`: for all of
 * them, as a part comes loose. */
static void fill_matrix (const stage *g, double shift, int all)
{
    const change *c = g->c;
    for (size_t j = 0; j < g->n; j++) {
        double *column = g->M + j * g->n;
        memset (column, 0, g->n * sizeof *column);
        for (size_t e = 0; e < c->n; e++) {
            size_t p = g->own[g->place[c->row[e]]], q = g->own[g->place[c->column[e]]];
            column[p] += c->value[e] * g->h[j * g->n + q];
            if (p != q) column[q] += c->value[e] * g->h[j * g->n + p];
        }
        column[j] += 1;
    }
    for (size_t i = 0; i < g->n; i++) {
        if (!all && !g->bare[i]) continue;
        for (size_t j = 0; j < g->n; j++) g->M[j * g->n + i] += shift * g->h[j * g->n + i];
    }
}

/* Unknowns of the stage whose stiffness the cut takes away. */
static void find_bare (const stage *g)
{
    const pg_system *s = g->w->system;
    const pg_sparse *K = pg_force_matrix (s->force, s->self);
    for (size_t e = 0; e < g->c->n; e++) {
        long i = g->c->row[e];
        double before = g->w->K[K->start[i + 1] - 1];  /* the diagonal is last in its column */
        if (i == g->c->column[e] && !(before + g->c->value[e] > 1e-12 * before))
            g->bare[g->own[g->place[i]]] = 1;
    }
}

/* y = M^-1 r on the unknowns of the stage, and the energies. 0: M is singular, to rounding. */
static int stage_energies (const stage *g, int fields, double shift, int all, double *y, trial_form *out)
{
    const double singular = 1e-9;                      /* H has as many digits less beside penalties */
    double least = INFINITY, most = 0;
    size_t n = g->n;
    fill_matrix (g, shift, all);
    for (size_t i = 0; i < n * n; i++) most = fmax (most, fabs (g->M[i]));
    if (!pg_dense_factor (n, g->M, n, g->pivot)) return 0;
    for (size_t i = 0; i < n; i++) {
        least = fmin (least, fabs (g->M[i * n + i]));
        for (int a = 0; a < fields; a++) y[(size_t) a * n + i] = g->c->r[a][g->list[i]];
    }
    if (!all && least < singular * most) return 0;
    pg_dense_substitute (n, g->M, n, g->pivot, (size_t) fields, y, n);
    for (int a = 0, k = 0; a < fields; a++)
        for (int b = a; b < fields; b++, k++) {
            double sum = 0;
            for (size_t j = 0; j < n; j++)
                for (size_t i = 0; i < n; i++)
                    sum += g->c->r[a][g->list[i]] * g->h[j * n + i] * y[(size_t) b * n + j];
            out->value[k] = g->c->work[k] + 0.5 * sum;
        }
    return 1;
}

/* The energies of one stage; NAN where a part comes loose: M is singular then. With contact, where the cut
 * body is not solved anew, springs too soft to matter hold it. */
static pg_status stage_release (const trials *w, const trial_fields *f, const change *c, size_t n,
                                const size_t *list, const size_t *place, size_t m, const double *H,
                                trial_form *out)
{
    pg_status status = PG_OK;
    stage g = { .w = w, .c = c, .n = n, .list = list, .place = place };
    double *y = NULL, weak = WEAK_SPRING * w->system->direct.mean_diagonal;
    PG_ALLOC (g.h, n * n);
    PG_ALLOC (g.M, n * n);
    PG_ALLOC (y, n * (size_t) f->n);
    PG_ALLOC (g.own, m);
    PG_ALLOC (g.bare, n);
    PG_ALLOC (g.pivot, n);
    for (size_t i = 0; i < n; i++) g.own[place[list[i]]] = i;
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++) g.h[j * n + i] = H[place[list[j]] * m + place[list[i]]];
    find_bare (&g);
    if (n == 0 || stage_energies (&g, f->n, weak, 0, y, out)) goto done;
    for (int k = 0; k < 3; k++) out->value[k] = NAN;
    if (w->system->contact && !stage_energies (&g, f->n, weak, 1, y, out))
        PG_FAIL (PG_E_SINGULAR, "the matrix of a trial cut beside %zu unknowns is singular", n);
done:
    pg_free (g.h), pg_free (g.M), pg_free (y), pg_free (g.own), pg_free (g.bare), pg_free (g.pivot);
    return status;
}

static void change_clear (change *c)
{
    pg_free (c->row), pg_free (c->column), pg_free (c->value), pg_free (c->r[0]), pg_free (c->r[1]);
}

/* *unfit: the cut touches more unknowns than this way is good for, or digits were lost: no result. */
static pg_status by_columns (trials *w, const pg_state *state, const trial_fields *f, size_t n,
                             const pg_changes *cut, trial_form *release, int *unfit)
{
    pg_status status = PG_OK;
    const pg_system *s = w->system;
    change *c = NULL;
    unsigned char *mark = NULL, *any = NULL;
    size_t *list = NULL, *all = NULL, *place = NULL, m = 0;
    double *H = NULL;
    *unfit = 0;
    PG_ALLOC (c, n);
    PG_ALLOC (mark, s->ndof);
    PG_ALLOC (any, s->ndof);
    PG_ALLOC (list, s->ndof);
    PG_ALLOC (all, s->ndof);
    PG_ALLOC (place, s->ndof);
    PG_TRY (compare_stages (w, state, f, n, cut, c));
    for (size_t k = 0; k < n; k++) {
        size_t count = beside (s, f, &c[k], mark, list);
        for (size_t i = 0; i < count; i++) any[list[i]] = 1;
    }
    for (size_t i = 0; i < s->ndof; i++) if (any[i]) place[i] = m, all[m++] = i;
    *unfit = m > MOST_COLUMNS;
    if (*unfit) goto done;
    PG_ALLOC (H, m * m);
    PG_TRY (inverse_block (w, m, all, H));
    for (size_t k = 0; k < n; k++) {
        size_t count = beside (s, f, &c[k], mark, list);
        PG_TRY (stage_release (w, f, &c[k], count, list, place, m, H, &release[k]));
        for (int a = 0; a < f->n; a++)
            *unfit |= !s->contact
                      && !(fabs (c[k].work[2*a]) <= most_lost * fabs (release[k].value[2*a]));
    }
done:
    for (size_t k = 0; c && k < n; k++) change_clear (&c[k]);
    pg_free (c), pg_free (mark), pg_free (any), pg_free (list), pg_free (all), pg_free (place), pg_free (H);
    return status;
}

/* ---- by solving anew ----------------------------------------------------------------------------------- */
/* Field k of the combinations whose energies give the form: each alone, and the mean of two. */
static double combine (const trial_fields *f, int k, size_t ndof, double *d)
{
    if (k < f->n) {
        memcpy (d, f->d[k], ndof * sizeof *d);
        return f->t[k];
    }
    for (size_t i = 0; i < ndof; i++) d[i] = 0.5 * (f->d[0][i] + f->d[1][i]);
    return 0.5 * (f->t[0] + f->t[1]);
}

/* f + r, loads and residual r = f - K u: the potential energy is Pi = u.K u/2 - f.u = -u.(f + r)/2. It is
 * least in equilibrium, so that an error of u shows by its square, and what penalties store belongs to it. */
static pg_status loads_and_residual (trials *w, double t, const double *u, double *out)
{
    pg_status status = PG_OK;
    const pg_system *s = w->system;
    double reference;
    PG_TRY (s->force->balance (s->self, t, u, w->residual[0], &reference));
    PG_TRY (s->force->balance (s->self, t, w->zero, w->load[0], &reference));
    for (size_t i = 0; i < s->ndof; i++) out[i] = w->load[0][i] + w->residual[0][i];
done:
    return status;
}

/* Pi less Pi', from u and f + r of both: by differences, as penalties store much that does not change. */
static double released (size_t n, const double *u, const double *q, const double *now, const double *p)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += 0.5 * ((now[i] - u[i]) * p[i] + u[i] * (p[i] - q[i]));
    return sum;
}

/* The form from the energies of field 0, field 1 and their mean. */
static void form_of (const trial_fields *f, const double *energy, trial_form *out)
{
    *out = (trial_form) { { energy[0], 0, 0 } };
    if (f->n == 1) return;
    out->value[2] = energy[1], out->value[1] = 2 * energy[2] - 0.5 * (energy[0] + energy[1]);
}

/* A part that comes loose with its loads releases without bound. */
static int is_loose (pg_status now)
{
    return now == PG_E_EQUILIBRIUM || now == PG_E_NOT_SPD || now == PG_E_SINGULAR;
}

static pg_status by_solves (trials *w, const pg_state *state, const trial_fields *f, size_t n,
                            const pg_changes *cut, trial_form *release)
{
    pg_status status = PG_OK, back;
    pg_system *s = w->system;
    int combinations = f->n == 1 ? 1 : 3;
    double *u[3] = { NULL }, *q[3] = { NULL }, *p = NULL, energy[3] = { 0 }, residual;
    PG_ALLOC (p, s->ndof);
    for (int a = 0; a < combinations; a++) {
        PG_ALLOC (u[a], s->ndof);
        PG_ALLOC (q[a], s->ndof);
        PG_TRY (loads_and_residual (w, combine (f, a, s->ndof, u[a]), u[a], q[a]));
    }
    for (size_t k = 0; k < n && status == PG_OK; k++) {
        for (size_t i = 0; i < cut[k].n; i++) w->state->alive[cut[k].bond[i]] = 0;
        status = system_refresh (s, w->state, &cut[k]);
        for (int a = 0; a < combinations && status == PG_OK; a++) {
            double t = combine (f, a, s->ndof, w->after);
            pg_status now = system_solve (s, t, w->after, NULL, &residual);
            energy[a] = INFINITY;
            if (is_loose (now)) continue;
            status = now == PG_OK ? loads_and_residual (w, t, w->after, p) : now;
            energy[a] = released (s->ndof, u[a], q[a], w->after, p);
        }
        form_of (f, energy, &release[k]);
    }
    w->by_solves += (long) n;
    back = restore (w, state, n, cut);
    if (status == PG_OK) status = back;
    /* whatever factor or preconditioner there is may be that of the cut body */
    s->direct.stale = 1, s->direct.alive = state->alive;
    if (s->force->revision) s->direct.revision = s->force->revision (s->self);
    system_forget_preconditioner (s);
done:
    pg_free (p);
    for (int a = 0; a < 3; a++) pg_free (u[a]), pg_free (q[a]);
    return status;
}

/* By columns where there is a factor, else by solving anew. */
pg_status trial_release (trials *w, const pg_state *state, const trial_fields *f, size_t n,
                         const pg_changes *cut, trial_form *release)
{
    pg_status status = PG_OK;
    int unfit = 1;
    PG_TRY (ready (w, state));
    if (has_factor (w)) PG_TRY (by_columns (w, state, f, n, cut, release, &unfit));
    if (!unfit) goto done;
    if (w->system->contact)
        PG_FAIL (PG_E_USAGE, "with contact.kind new cracks are tried by a factor of K%s: set solver.linear: "
                             "cholmod and method.essential: nitsche or penalty, or leave the strengths out",
                 has_factor (w) ? ", which a cut across so many unknowns is too much for" : "");
    PG_TRY (pg_state_copy (w->state, state));
    PG_TRY (by_solves (w, state, f, n, cut, release));
done:
    return status;
}

pg_status pg_solver_release (pg_solver *solver, const pg_state *state, int nfield, const double *const *d,
                             const double *t, size_t n, const pg_changes *cut, int anew, double *release)
{
    pg_status status = PG_OK;
    trials *w = NULL;
    trial_form *form = NULL;
    trial_fields f = { nfield, { d[0], nfield > 1 ? d[1] : NULL }, { t[0], nfield > 1 ? t[1] : 0 } };
    PG_TRY (trials_create (&w, &solver->break_loop.system));
    w->never_columns = anew;
    PG_ALLOC (form, n);
    PG_TRY (trial_release (w, state, &f, n, cut, form));
    for (size_t k = 0; k < n; k++) memcpy (release + 3*k, form[k].value, sizeof form[k].value);
done:
    pg_free (form);
    trials_free (&w);
    return status;
}
