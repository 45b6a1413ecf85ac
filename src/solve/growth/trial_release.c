/* SPDX-License-Identifier: GPL-3.0-or-later
 * The potential energy that a cut releases at fixed loads. The body is linear: Pi (u) = u.K u/2 - f.u,
 * least at K u = f. A cut makes K' = K + dK and f' = f + df, which differ from K and f in the few unknowns
 * A beside it. With the residual of the old displacement in the cut body, r = f' - K' u (zero outside A),
 *
 *     Pi - Pi' = u.(r + df)/2 + r.x/2,    K' x = r,
 *
 * and (K'^-1)_AA = H (I + dK H)^-1 with H = (K^-1)_AA: the inverse of the uncut body (inverse.h), in which
 * the columns of every unknown of A are solved for once, takes in stage after stage. For df = 0 this is
 * -u_A.(I + dK H)^-1 dK u_A/2. All terms are local. Where there is no factor of K (conjugate gradients,
 * supports by elimination), where both terms are much larger than their sum (a cut beside penalties, whose
 * shape functions it changes), or where a part comes loose, the cut body is solved anew, and the release is
 * the difference of both potentials, which is also what tests compare with. */
#include "solve/system/inverse.h"
#include "trial_facet.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

/* Terms that cancel may be at most this many times as large as their sum; else the cut body is solved
 * again. */
static const double most_lost = 30;

/* Changes by one stage of a cut: of K from the stage before it, of forces from the uncut body. */
typedef struct {
    pg_stiffness_change K;
    int    *node;                                      /* K.node and K.K, owned */
    double *dK;
    double *r[2];                                      /* residual of every field, N (ndof) */
    double work[3];                                    /* u_a.(r_b + df_b)/2, symmetric, J: 00, 01, 11 */
} change;

/* c = polynomial of lambda of a quadratic form; two fields have the weights 1 - lambda and lambda. A part
 * that comes loose with its loads releases energy without bound, at whatever load. */
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

/* Allocates workspaces, and copies the state. */
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

/* Restores the caches of the force. Forces with shape functions evaluate the touched points by the alive bits
 * of the state; others start anew. */
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
/* 1: there is a factor of K itself, without elimination. */
static int has_factor (const trials *w)
{
    const pg_system *s = w->system;
    return !w->never_columns && system_factors (s) && system_can_factor (s) && !system_basis (s);
}

/* Finds the entries of K that a stage has changed: rows of touched nodes are computed in the same order, so
 * that all other entries keep their bits. K of the next stage is compared with that of this one. *fits 0: too
 * many. */
static pg_status compare_matrix (trials *w, const inverse *v, change *c, int *fits)
{
    pg_status status = PG_OK;
    const pg_system *s = w->system;
    const pg_sparse *K;
    size_t m = (size_t) s->components, n = 0;
    size_t *at = NULL;
    PG_TRY (pg_force_assemble (s->force, s->self, &K));
    PG_ALLOC (at, s->problem->cloud.n);
    for (size_t j = 0; j < s->ndof; j++)
        for (long q = K->start[j]; q < K->start[j + 1]; q++)
            if (K->value[q] != w->K[q]) at[j / m] = at[(size_t) K->row[q] / m] = 1;
    for (size_t i = 0; i < s->problem->cloud.n; i++) if (at[i]) at[i] = n++;
    *fits = inverse_has_room (v, n * m);
    if (!*fits) goto done;
    PG_ALLOC (c->node, n);
    PG_ALLOC (c->dK, n * m * n * m);
    c->K = (pg_stiffness_change) { .known = 1, .n = n, .width = n * m, .node = c->node, .K = c->dK };
    for (size_t j = 0; j < s->ndof; j++)
        for (long q = K->start[j]; q < K->start[j + 1]; q++) {
            if (K->value[q] == w->K[q]) continue;
            size_t i = (size_t) K->row[q], a = at[i / m] * m + i % m, b = at[j / m] * m + j % m;
            c->node[at[i / m]] = (int) (i / m), c->node[at[j / m]] = (int) (j / m);
            c->dK[a * n * m + b] = c->dK[b * n * m + a] = K->value[q] - w->K[q];
            w->K[q] = K->value[q];
        }
done:
    pg_free (at);
    return status;
}

/* Finds the residuals of the present body less those before, r = df - dK u, and the work terms. */
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

/* Stores K, residuals and loads of the uncut body. */
static pg_status remember_uncut (trials *w, const trial_fields *f)
{
    pg_status status = PG_OK;
    const pg_system *s = w->system;
    const pg_sparse *K;
    double reference;
    PG_TRY (pg_force_assemble (s->force, s->self, &K));
    if (!w->K) PG_ALLOC (w->K, (size_t) K->start[s->ndof]);
    memcpy (w->K, K->value, (size_t) K->start[s->ndof] * sizeof *w->K);
    for (int a = 0; a < f->n; a++) {
        PG_TRY (s->force->balance (s->self, f->t[a], f->d[a], w->residual[a], &reference));
        PG_TRY (s->force->balance (s->self, f->t[a], w->zero, w->load[a], &reference));
    }
done:
    return status;
}

/* Updates the inverse to the body with this stage cut: unknowns A are those of dK, and those whose loads have
 * changed. *fits 0: too many. */
static pg_status take_stage (const trials *w, inverse *v, const trial_fields *f, const change *c, int *fits)
{
    pg_status status = PG_OK;
    const pg_system *s = w->system;
    double largest[2] = { 0 }, t0 = pg_seconds ();
    size_t *fresh = NULL, n = 0;
    PG_TRY (inverse_change (v, &c->K));
    PG_ALLOC (fresh, s->ndof);
    for (int a = 0; a < f->n; a++)
        for (size_t i = 0; i < s->ndof; i++) largest[a] = fmax (largest[a], fabs (c->r[a][i]));
    for (size_t i = 0; i < s->ndof; i++) {
        int loaded = 0;
        for (int a = 0; a < f->n; a++) loaded |= fabs (c->r[a][i]) > 1e-12 * largest[a];
        if (loaded && !v->touched.at[i]) fresh[n++] = i;
    }
    *fits = inverse_has_room (v, n);
    if (*fits) PG_TRY (inverse_grow (v, n, fresh));
done:
    pg_free (fresh);
    s->report->seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    return status;
}

/* Finds the energies of one stage; 0: its dense system is singular, to rounding. */
static int stage_energies (inverse *v, const trial_fields *f, const change *c, double *y, double *x,
                           trial_form *out)
{
    const touched_unknowns *u = &v->touched;
    size_t n = u->t;
    for (int a = 0; a < f->n; a++)
        for (size_t i = 0; i < n; i++) y[(size_t) a * n + i] = c->r[a][u->dof[i]];
    if (n && !inverse_substitute (v, (size_t) f->n, y)) return 0;
    for (int b = 0; b < f->n; b++) {
        memset (x, 0, n * sizeof *x);
        inverse_add_H (v, y + (size_t) b * n, x);
        for (int a = 0; a <= b; a++) {
            double sum = 0;
            for (size_t i = 0; i < n; i++) sum += c->r[a][u->dof[i]] * x[i];
            out->value[a + b] = c->work[a + b] + 0.5 * sum;
        }
    }
    return 1;
}

/* Finds the release of a stage; NAN where a part comes loose, as the dense system is singular then. With
 * contact, where the cut body is not solved again, very soft springs hold the part. */
static pg_status stage_release (const trials *w, inverse *v, const trial_fields *f, const change *c,
                                trial_form *out)
{
    const double singular = 1e-9;                      /* H has about as many digits less beside penalties */
    pg_status status = PG_OK;
    size_t n = v->touched.t;
    double *y = NULL, *x = NULL;
    PG_ALLOC (y, n * (size_t) f->n + 1);
    PG_ALLOC (x, n + 1);
    if (stage_energies (v, f, c, y, x, out) && !(n && v->touched.pivots < singular)) goto done;
    for (int k = 0; k < 3; k++) out->value[k] = NAN;
    if (!w->system->contact) goto done;
    inverse_hold (v, v->base.bare);
    if (!stage_energies (v, f, c, y, x, out))
        PG_FAIL (PG_E_SINGULAR, "the matrix of a trial cut beside %zu unknowns is singular", n);
    inverse_hold (v, 0);
done:
    pg_free (y), pg_free (x);
    return status;
}

/* Cuts one stage on the copy of the state and refreshes the force. *unfit 1: too many unknowns are touched
 * for this method, or digits were lost. */
static pg_status try_stage (trials *w, inverse *v, const trial_fields *f, const pg_changes *cut,
                            trial_form *release, int *unfit)
{
    pg_status status = PG_OK;
    change c = { .node = NULL };
    int fits;
    for (size_t i = 0; i < cut->n; i++) w->state->alive[cut->bond[i]] = 0;
    PG_TRY (w->system->force->refresh (w->system->self, w->state, cut));
    PG_TRY (compare_matrix (w, v, &c, &fits));
    if (fits) PG_TRY (compare_forces (w, f, &c));
    if (fits) PG_TRY (take_stage (w, v, f, &c, &fits));
    if (fits) PG_TRY (stage_release (w, v, f, &c, release));
    for (int a = 0; a < f->n && fits && !w->system->contact; a++)
        *unfit |= !(fabs (c.work[2*a]) <= most_lost * fabs (release->value[2*a]));
    *unfit |= !fits;
done:
    pg_free (c.node), pg_free (c.dK), pg_free (c.r[0]), pg_free (c.r[1]);
    return status;
}

/* Finds the releases of all stages by columns of the inverse; *unfit 1: no result. */
static pg_status by_columns (trials *w, const pg_state *state, const trial_fields *f, size_t n,
                             const pg_changes *cut, trial_form *release, int *unfit)
{
    pg_status status = PG_OK, back;
    pg_system *s = w->system;
    inverse *v = NULL;
    size_t tried = 0;
    *unfit = 0;
    if (s->direct.stale) PG_TRY (system_factorize (s, NULL));
    s->choice.extra_cost = 0;
    PG_TRY (remember_uncut (w, f));
    PG_TRY (inverse_create (&v, s, INVERSE_BLOCK));
    PG_TRY (inverse_renew (v, 1, 0, 0));
    v->base.bare = WEAK_SPRING * s->direct.mean_diagonal;
    for (; tried < n && status == PG_OK && !*unfit; tried++)
        status = try_stage (w, v, f, &cut[tried], &release[tried], unfit);
    back = restore (w, state, tried, cut);
    if (status == PG_OK) status = back;
    /* K is as before: the factor stays */
    if (s->force->revision) s->direct.revision = s->force->revision (s->self);
done:
    inverse_free (&v);
    return status;
}

/* ---- by solving anew ----------------------------------------------------------------------------------- */
/* d = combination k of the fields, whose energies give the form: each alone, and the mean of two; returns its
 * t. */
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

/* Pi less Pi', from u and f + r before (u, q) and after (now, p): by differences, as penalties store much
 * that does not change. */
static double released (size_t n, const double *u, const double *q, const double *now, const double *p)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += 0.5 * ((now[i] - u[i]) * p[i] + u[i] * (p[i] - q[i]));
    return sum;
}

/* out = form from the energies of field 0, field 1 and their mean. */
static void form_of (const trial_fields *f, const double *energy, trial_form *out)
{
    *out = (trial_form) { { energy[0], 0, 0 } };
    if (f->n == 1) return;
    out->value[2] = energy[1], out->value[1] = 2 * energy[2] - 0.5 * (energy[0] + energy[1]);
}

/* Finds the releases by solving the cut body for each stage; a part that comes loose with its loads releases
 * energy without bound. */
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
            if (system_no_equilibrium (now)) continue;
            status = now == PG_OK ? loads_and_residual (w, t, w->after, p) : now;
            energy[a] = released (s->ndof, u[a], q[a], w->after, p);
        }
        form_of (f, energy, &release[k]);
    }
    back = restore (w, state, n, cut);
    if (status == PG_OK) status = back;
    /* any factor or preconditioner may be that of the cut body */
    s->direct.stale = 1, s->direct.alive = state->alive;
    if (s->force->revision) s->direct.revision = s->force->revision (s->self);
    system_forget_preconditioner (s);
done:
    pg_free (p);
    for (int a = 0; a < 3; a++) pg_free (u[a]), pg_free (q[a]);
    return status;
}

/* Finds the releases by columns of the inverse where there is a factor, else by solving again. */
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
