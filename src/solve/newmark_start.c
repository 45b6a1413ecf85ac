/* SPDX-License-Identifier: GPL-3.0-or-later
 * Newmark's method: where it starts, and nodes whose motion is prescribed by elimination, d = T q + z (t).
 * Their V = T q' + z' and A = T q'' + z'' follow from z: Newmark's own recursion would turn any error in them
 * into an oscillation that never dies. Start: d, V as given but for the supports; T' M T q'' = T' (P - F_int
 * - C V - M z''). */
#include "newmark_state.h"
#include <string.h>

/* T, where the force takes prescribed values by elimination; NULL: it does not. */
static const pg_sparse *elimination (const pg_system *sys)
{
    return sys->force->basis && sys->force->impose ? sys->force->basis (sys->self) : NULL;
}

/* residual -= C v with Rayleigh damping C = c_m M + c_k K. */
void newmark_damp (pg_solver *s, const double *v, double *residual)
{
    pg_system *sys = &s->break_loop.system;
    const pg_newmark_options *own = PG_OWN (pg_newmark_options, &s->options);
    double *Kv = newmark_of (s)->work2, cm = own->rayleigh_mass, ck = own->rayleigh_stiffness;
    system_add_mass (sys, -cm, v, residual);
    if (ck == 0) return;
    system_multiply (sys, v, Kv);
    for (size_t i = 0; i < sys->ndof; i++) residual[i] -= ck * Kv[i];
}

/* residual -= M a + C v */
void newmark_resist (pg_solver *s, const double *v, const double *a, double *residual)
{
    newmark_damp (s, v, residual);
    system_add_mass (&s->break_loop.system, -1, a, residual);
}

/* force0 = P - F_int - C V at the state, N, of which the alpha method takes a share in the next step. */
pg_status newmark_remember (pg_solver *s, double t, const pg_state *state)
{
    pg_status status = PG_OK;
    newmark *own = newmark_of (s);
    pg_system *sys = &s->break_loop.system;
    double unused;
    PG_TRY (sys->force->balance (sys->self, t, state->d, own->force0, &unused));
    newmark_damp (s, state->v, own->force0);
done:
    return status;
}

/* 1/2 v M v, J, with the mass matrix that the run uses. */
double newmark_kinetic (pg_solver *s, const double *v)
{
    const pg_system *sys = &s->break_loop.system;
    double sum = 0, *Mv = newmark_of (s)->work2;
    memset (Mv, 0, sys->ndof * sizeof *Mv);
    system_add_mass (sys, 1, v, Mv);
    for (size_t i = 0; i < sys->ndof; i++) sum += 0.5 * v[i] * Mv[i];
    return sum;
}

/* z, z', z'' at t by differences over a part of the step: forward at the start, else central. */
pg_status newmark_supports (pg_solver *s, double t, int start)
{
    pg_status status = PG_OK;
    newmark *own = newmark_of (s);
    pg_system *sys = &s->break_loop.system;
    double *z[3], e = s->options.dt / 16;
    own->support_updates = s->report.updates;
    if (!elimination (sys)) return PG_OK;
    for (size_t k = 0; k < 3; k++) {
        z[k] = own->support + k * sys->ndof;
        memset (z[k], 0, sys->ndof * sizeof *z[k]);
        PG_TRY (sys->force->impose (sys->self, t + ((double) k - !start) * e, z[k]));
    }
    for (size_t i = 0; i < sys->ndof; i++) {
        double z0 = z[0][i], z1 = z[1][i], z2 = z[2][i];
        z[0][i] = start ? z0 : z1;
        z[1][i] = start ? (4 * (z1 - z0) - (z2 - z0)) / (2 * e) : (z2 - z0) / (2 * e);
        z[2][i] = ((z2 - z1) - (z1 - z0)) / (e * e);
    }
done:
    return status;
}

/* Velocity and acceleration of prescribed nodes, T q + z' and so on. Where the supports have changed with
 * breaking their motion is found anew. */
void newmark_follow (pg_solver *s, double t, double *v, double *a)
{
    newmark *own = newmark_of (s);
    const pg_system *sys = &s->break_loop.system;
    if (!elimination (sys)) return;
    if (own->support_updates != s->report.updates) newmark_supports (s, t, 0);
    for (size_t k = 1; k < 3; k++) {
        double *w = k == 1 ? v : a;
        sys->force->impose (sys->self, t, w);          /* prescribed nodes: T q + z */
        for (size_t i = 0; i < sys->ndof; i++) w[i] += own->support[k * sys->ndof + i] - own->support[i];
    }
}

/* ---- start --------------------------------------------------------------------------------------------- */
/* y = T' M T x, for conjugate gradients. */
static void apply_mass (void *context, const double *x, double *y)
{
    const pg_system *sys = context;
    const pg_sparse *T = elimination (sys);
    double *z = T ? sys->scratch : y;
    if (T) pg_sparse_multiply (T, x, sys->full);
    memset (z, 0, sys->ndof * sizeof *z);
    system_add_mass (sys, 1, T ? sys->full : x, z);
    if (T) pg_sparse_multiply_transposed (T, z, y);
}

/* The diagonal of T' M T preconditions the system for the first acceleration. */
static void diagonal_mass (void *context, double *d)
{
    const pg_system *sys = context;
    const pg_sparse *T = elimination (sys);
    double *z = T ? sys->scratch : d;
    memset (z, 0, sys->ndof * sizeof *z);
    system_add_mass_diagonal (sys, 1, z);
    for (size_t j = 0; T && j < T->ncol; j++) {
        d[j] = 0;
        for (long p = T->start[j]; p < T->start[j + 1]; p++) d[j] += T->value[p] * T->value[p] * z[T->row[p]];
    }
}

/* a += the acceleration that the residual gives to what is free: by division with a lumped mass, else by
 * conjugate gradients. */
static pg_status accelerate (pg_system *sys, double *a)
{
    pg_status status = PG_OK;
    const pg_sparse *T = elimination (sys);
    for (size_t i = 0; !T && !sys->M && i < sys->ndof; i++) a[i] += sys->residual[i] / sys->mass[i];
    if (!T && !sys->M) return PG_OK;
    pg_operator op = { sys->nred, sys, apply_mass, diagonal_mass };
    size_t used = 0;
    if (T) pg_sparse_multiply_transposed (T, sys->residual, sys->reduced);
    else memcpy (sys->reduced, sys->residual, sys->ndof * sizeof *sys->reduced);
    memset (sys->delta, 0, sys->ndof * sizeof *sys->delta);
    PG_TRY (pg_conjugate_gradients (&op, sys->reduced, sys->delta, 1e-13, 20 * sys->nred + 1000, &used));
    if (T) pg_sparse_multiply (T, sys->delta, sys->full);
    const double *gain = T ? sys->full : sys->delta;
    for (size_t i = 0; i < sys->ndof; i++) a[i] += gain[i];
done:
    return status;
}

/* The energy that the run starts with counts as work done before. */
static pg_status first_account (pg_solver *s, const pg_state *state)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    pg_system *sys = &b->system;
    s->report.energy_kinetic = newmark_kinetic (s, state->v);
    if (!sys->force->work_balance) goto done;
    memset (sys->full, 0, sys->ndof * sizeof *sys->full);
    newmark_resist (s, state->v, state->a, sys->full);
    PG_TRY (sys->force->work_balance (sys->self, state->time, state->d, sys->full, &b->work_balance));
    PG_TRY (break_loop_book (b, 1));
    s->report.energy_strain = b->work_balance.strain;
    b->work = s->report.energy_strain + s->report.energy_kinetic;
done:
    return status;
}

/* Allocates and finds the acceleration at the start from the loads, the resistance and the motion of the
 * supports; a run that goes on has it already. */
pg_status newmark_start (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    newmark *own = newmark_of (s);
    pg_system *sys = &s->break_loop.system;
    size_t ndof = sys->ndof;
    double reference;
    PG_TRY (system_refresh (sys, state, NULL));
    s->next_level = 1;
    if (!own->work1) PG_ALLOC (own->work1, ndof);
    if (!own->work2) PG_ALLOC (own->work2, ndof);
    if (!own->work3) PG_ALLOC (own->work3, ndof);
    if (!own->work4) PG_ALLOC (own->work4, 3 * ndof);
    PG_TRY (system_mass (sys, PG_OWN (pg_newmark_options, &s->options)->consistent));
    if (!own->support) PG_ALLOC (own->support, 3 * ndof);
    if (PG_OWN (pg_newmark_options, &s->options)->alpha != 0 && !own->force0) PG_ALLOC (own->force0, ndof);
    if (state->step > 0) goto done;
    for (size_t i = 0; i < ndof; i++)
        if (!(sys->mass[i] > 0))
            PG_FAIL (PG_E_USAGE, "newmark needs mass at every point: give the material a density");
    memset (state->a, 0, ndof * sizeof *state->a);
    if (elimination (sys)) {
        PG_TRY (sys->force->impose (sys->self, state->time, state->d));
        PG_TRY (newmark_supports (s, state->time, 1));
        newmark_follow (s, state->time, state->v, state->a);
    }
    PG_TRY (sys->force->balance (sys->self, state->time, state->d, sys->residual, &reference));
    newmark_resist (s, state->v, state->a, sys->residual);
    PG_TRY (accelerate (sys, state->a));
    PG_TRY (first_account (s, state));
    if (own->force0) PG_TRY (newmark_remember (s, state->time, state));
done:
    return status;
}
