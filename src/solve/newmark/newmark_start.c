/* SPDX-License-Identifier: GPL-3.0-or-later
 * Newmark's method: where it starts, and nodes whose motion is prescribed by elimination, d = T q + z (t).
 * Their V = T q' + z' and A = T q'' + z'' follow from z: Newmark's own recursion would turn any error in them
 * into an oscillation that never dies. Start: d, V as given but for the supports; T' M T q'' = T' (P - F_int
 * - C V - M z''). */
#include "solve/contact/contact.h"
#include "newmark_state.h"
#include <math.h>
#include <string.h>

/* T, where the force takes prescribed values by elimination; NULL: it does not. */
static const pg_sparse *elimination (const pg_system *sys)
{
    return sys->force->basis && sys->force->impose ? sys->force->basis (sys->self) : NULL;
}

/* residual -= C v with Rayleigh damping C = c_m M + c_k K. */
void newmark_damp (newmark *n, const double *v, double *residual)
{
    pg_system *sys = n->system;
    double *Kv = n->work2, cm = n->setting.rayleigh_mass, ck = n->setting.rayleigh_stiffness;
    system_add_mass (sys, -cm, v, residual);
    if (ck == 0) return;
    system_multiply (sys, v, Kv);
    for (size_t i = 0; i < sys->ndof; i++) residual[i] -= ck * Kv[i];
}

/* residual -= M a + C v; adds the forces that opening facets still carry. */
static void resist_motion (newmark *n, const double *v, const double *a, double *residual)
{
    newmark_damp (n, v, residual);
    system_add_held (n->system, residual);
    system_add_mass (n->system, -1, a, residual);
}

/* force0 = P - F_int - C V at the state, N, of which the alpha method takes a share in the next step. */
pg_status newmark_remember (newmark *n, double t, const pg_state *state)
{
    pg_status status = PG_OK;
    pg_system *sys = n->system;
    double unused;
    PG_TRY (sys->force->balance (sys->self, t, state->d, n->force0, &unused));
    newmark_damp (n, state->v, n->force0);
    system_add_held (sys, n->force0);
done:
    return status;
}

/* 1/2 v M v, J, with the mass matrix that the run uses. */
double newmark_kinetic (newmark *n, const double *v)
{
    const pg_system *sys = n->system;
    double sum = 0, *Mv = n->work2;
    memset (Mv, 0, sys->ndof * sizeof *Mv);
    system_add_mass (sys, 1, v, Mv);
    system_clear_ghosts (sys, Mv);                     /* each rank counts its own nodes */
    for (size_t i = 0; i < sys->ndof; i++) sum += 0.5 * v[i] * Mv[i];
    return sum;
}

/* z, z', z'' at t by differences over a part of the step: forward at the start, else central; z alone where
 * supports are held fixed. */
pg_status newmark_supports (newmark *n, double t, int start)
{
    pg_status status = PG_OK;
    pg_system *sys = n->system;
    double *z[3], e = n->held ? 0 : n->dt / 16;
    n->support_updates = sys->report->linear.updates;
    if (!elimination (sys)) return PG_OK;
    for (size_t k = 0; k < 3; k++) {
        z[k] = n->support + k * sys->ndof;
        memset (z[k], 0, sys->ndof * sizeof *z[k]);
        PG_TRY (sys->force->impose (sys->self, t + ((double) k - !start) * e, z[k]));
    }
    for (size_t i = 0; i < sys->ndof; i++) {
        double z0 = z[0][i], z1 = z[1][i], z2 = z[2][i];
        z[0][i] = start ? z0 : z1;
        z[1][i] = n->held ? 0 : start ? (4 * (z1 - z0) - (z2 - z0)) / (2 * e) : (z2 - z0) / (2 * e);
        z[2][i] = n->held ? 0 : ((z2 - z1) - (z1 - z0)) / (e * e);
    }
done:
    return status;
}

/* Velocity and acceleration of prescribed nodes, T q + z' and so on. Where the supports have changed with
 * breaking their motion is found anew. */
void newmark_follow (newmark *n, double t, double *v, double *a)
{
    const pg_system *sys = n->system;
    if (!elimination (sys)) return;
    if (n->support_updates != sys->report->linear.updates) newmark_supports (n, t, 0);
    for (size_t k = 1; k < 3; k++) {
        double *w = k == 1 ? v : a;
        sys->force->impose (sys->self, t, w);          /* prescribed nodes: T q + z */
        for (size_t i = 0; i < sys->ndof; i++) w[i] += n->support[k * sys->ndof + i] - n->support[i];
    }
}

/* ---- start --------------------------------------------------------------------------------------------- */
/* y = T' M T x, for conjugate gradients. */
static void apply_mass (void *context, const double *x, double *y)
{
    const pg_system *sys = context;
    const pg_sparse *T = elimination (sys);
    double *z = T ? sys->balance.scratch : y;
    if (T) pg_sparse_multiply (T, x, sys->balance.full);
    memset (z, 0, sys->ndof * sizeof *z);
    system_add_mass (sys, 1, T ? sys->balance.full : x, z);
    system_clear_ghosts (sys, z);
    if (T) pg_sparse_multiply_transposed (T, z, y);
}

/* The diagonal of T' M T preconditions the system for the first acceleration. */
static void diagonal_mass (void *context, double *d)
{
    const pg_system *sys = context;
    const pg_sparse *T = elimination (sys);
    double *z = T ? sys->balance.scratch : d;
    memset (z, 0, sys->ndof * sizeof *z);
    system_add_mass_diagonal (sys, 1, z);
    for (size_t j = 0; T && j < T->ncol; j++) {
        d[j] = 0;
        for (long p = T->start[j]; p < T->start[j + 1]; p++) d[j] += T->value[p] * T->value[p] * z[T->row[p]];
    }
}

/* a += the acceleration of free unknowns by the residual: by division with a lumped mass, else by conjugate
 * gradients, on all ranks where one of them has prescribed nodes. */
static pg_status accelerate (pg_system *sys, double *a)
{
    system_balance *b = &sys->balance;
    pg_status status = PG_OK;
    const pg_sparse *T = elimination (sys);
    int divides = !(system_most (sys, T || sys->M) > 0);
    for (size_t i = 0; divides && i < sys->ndof; i++) a[i] += b->residual[i] / sys->mass[i];
    if (divides) return PG_OK;
    pg_operator op = { sys->nred, sys, apply_mass, diagonal_mass };
    size_t used = 0;
    if (T) pg_sparse_multiply_transposed (T, b->residual, b->reduced);
    else memcpy (b->reduced, b->residual, sys->ndof * sizeof *b->reduced);
    memset (b->delta, 0, sys->ndof * sizeof *b->delta);
    pg_cg_watch watch = { .shared = system_is_shared (sys) };
    PG_TRY (pg_conjugate_gradients_watched (&op, NULL, b->reduced, b->delta, 1e-13, 20 * sys->nred + 1000,
                                            &used, &watch));
    if (T) pg_sparse_multiply (T, b->delta, b->full);
    const double *gain = T ? b->full : b->delta;
    for (size_t i = 0; i < sys->ndof; i++) a[i] += gain[i];
done:
    return status;
}

/* a -= acceleration by the contact forces that are in the equations. The residual stays as it is. */
pg_status newmark_without_contact (newmark *n, double *a)
{
    pg_status status = PG_OK;
    pg_system *sys = n->system;
    const double *contact = sys->balance.pressed;
    double *kept = n->work4;
    if (!contact) return PG_OK;
    memcpy (kept, sys->balance.residual, sys->ndof * sizeof *kept);
    for (size_t i = 0; i < sys->ndof; i++) sys->balance.residual[i] = -contact[i];
    status = accelerate (sys, a);
    memcpy (sys->balance.residual, kept, sys->ndof * sizeof *kept);
    return status;
}

/* Pairs that have closed in this step have lost f_n times their gap before it, J. Impulses in proportion to
 * their forces, s q, give it back to the velocities: s^2/2 dv M dv + s v M dv = W, dv = M^-1 G' q. */
pg_status newmark_rebound (newmark *n, const pg_state *from, double *v)
{
    pg_status status = PG_OK;
    pg_system *sys = n->system;
    double *kept = n->work4, *dv = kept + sys->ndof, lost = 0, a = 0, b = 0;
    if (!sys->balance.pressed) return PG_OK;
    memcpy (kept, sys->balance.residual, sys->ndof * sizeof *kept);
    PG_TRY (contact_impacts (sys, from->d, sys->balance.residual, &lost));
    memset (dv, 0, sys->ndof * sizeof *dv);
    if (lost > 0) PG_TRY (accelerate (sys, dv));
    for (size_t i = 0; lost > 0 && i < sys->ndof; i++)
        a += sys->mass[i] * dv[i] * dv[i], b += sys->mass[i] * v[i] * dv[i];
    /* the root that presses faces apart, without cancellation */
    double root = sqrt (b * b + 2 * a * lost),
           s = !(a > 0) ? 0 : b > 0 ? 2 * lost / (b + root) : (root - b) / a;
    for (size_t i = 0; a > 0 && i < sys->ndof; i++) v[i] += s * dv[i];
    contact_rebound (sys, s / n->dt);
done:
    memcpy (sys->balance.residual, kept, sys->ndof * sizeof *kept);
    return status;
}

/* Finds both energies of the state, and the work balance that later work is counted from. */
pg_status newmark_account (newmark *n, break_loop *b, const pg_state *state, double t)
{
    pg_status status = PG_OK;
    pg_system *sys = n->system;
    sys->report->energy.kinetic = newmark_kinetic (n, state->v);
    if (!sys->force->work) goto done;
    memset (sys->balance.full, 0, sys->ndof * sizeof *sys->balance.full);
    resist_motion (n, state->v, state->a, sys->balance.full);
    PG_TRY (sys->force->work (sys->self, t, state->d, &(pg_known){ .inertia = sys->balance.full },
                              &b->work_balance));
    PG_TRY (break_loop_book (b, 1));
    sys->report->energy.strain = b->work_balance.strain;
done:
    return status;
}

/* Allocates the vectors of the scheme and finds the mass; with alpha there is room for the residual of the
 * last step. */
pg_status newmark_open (newmark *n)
{
    pg_status status = PG_OK;
    size_t ndof = n->system->ndof;
    if (!n->work1) PG_ALLOC (n->work1, ndof);
    if (!n->work2) PG_ALLOC (n->work2, ndof);
    if (!n->work3) PG_ALLOC (n->work3, ndof);
    if (!n->work4) PG_ALLOC (n->work4, 3 * ndof);
    PG_TRY (options_blame (system_mass (n->system, n->setting.consistent), n->system->options,
                           "solver.mass"));
    if (!n->support) PG_ALLOC (n->support, 3 * ndof);
    if (n->setting.alpha != 0 && !n->force0) PG_ALLOC (n->force0, ndof);
done:
    return status;
}

void newmark_close (newmark *n)
{
    pg_free (n->work1), pg_free (n->work2), pg_free (n->work3), pg_free (n->work4);
    pg_free (n->support), pg_free (n->force0);
}

/* Finds the acceleration at the start; velocities of free nodes stay as given. */
pg_status newmark_launch (newmark *n, pg_state *state, double t)
{
    pg_status status = PG_OK;
    pg_system *sys = n->system;
    size_t ndof = sys->ndof;
    double reference;
    memset (state->a, 0, ndof * sizeof *state->a);
    if (elimination (sys)) {
        PG_TRY (sys->force->impose (sys->self, t, state->d));
        PG_TRY (newmark_supports (n, t, 1));
        newmark_follow (n, t, state->v, state->a);
    }
    PG_TRY (system_exchange (sys, state->d));
    PG_TRY (system_exchange (sys, state->v));
    PG_TRY (sys->force->balance (sys->self, t, state->d, sys->balance.residual, &reference));
    resist_motion (n, state->v, state->a, sys->balance.residual);
    system_clear_ghosts (sys, sys->balance.residual);
    PG_TRY (accelerate (sys, state->a));
    PG_TRY (system_exchange (sys, state->a));
done:
    return status;
}
