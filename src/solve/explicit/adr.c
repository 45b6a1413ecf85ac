/* SPDX-License-Identifier: GPL-3.0-or-later
 * Adaptive dynamic relaxation (Kilic and Madenci 2010; theory B4): dt = 1 and masses D_ii = 1/4 sum_j |K_ij|,
 * with which the largest frequency is at most 2; damping from Rayleigh's quotient at every iteration. */
#include "solve/contact/contact.h"
#include "relaxation.h"
#include <math.h>
#include <string.h>

/* At the bound itself the motion would not decay. */
static const double margin = 1.02;

/* sum[i] = sum_j |K_ij|, N/m, from the upper triangle of K */
static pg_status sum_rows (pg_system *sys, double *sum)
{
    pg_status status = PG_OK;
    const pg_sparse *K;
    PG_TRY (pg_force_assemble (sys->force, sys->self, &K));
    if (!K)
        PG_FAIL (PG_E_USAGE,
                 "adr needs the rows of the stiffness, and the force %s tells neither them nor their sums: "
                 "use relax",
                 sys->force->method.name);
    for (size_t j = 0; j < K->ncol; j++)
        for (long q = K->start[j]; q < K->start[j + 1]; q++) {
            size_t i = (size_t) K->row[q];
            sum[i] += fabs (K->value[q]);
            if (i != j) sum[j] += fabs (K->value[q]);
        }
done:
    return status;
}

/* Finds masses from the sums of rows of the stiffness: with dt = 1 the largest frequency is at most 2, so
 * that every mass is as small as stability allows and all parts of the body move about equally fast. */
static pg_status weigh (pg_solver *s)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    pg_system *sys = &s->break_loop.system;
    double *mass = m->relaxation->mass;
    memset (mass, 0, sys->ndof * sizeof *mass);
    if (sys->force->motion.row_sums) PG_TRY (sys->force->motion.row_sums (sys->self, mass));
    else PG_TRY (sum_rows (sys, mass));
    contact_row_sums (sys, mass);
    for (size_t i = 0; i < sys->ndof; i++) {
        mass[i] *= 0.25 * margin;
        m->inverse[i] = mass[i] > 0 ? 1 / mass[i] : 0;
    }
done:
    return status;
}

/* Sets time step and masses. Forces that give the sums of their rows only soften when bonds break; with
 * others breaking may stiffen the body, and masses are found again after it, as where bonds leave faces that
 * touch. */
static pg_status prepare (pg_solver *s)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    PG_TRY (relaxation_create (s));
    struct relaxation *x = motion_of (s)->relaxation;
    PG_TRY (system_refresh (sys, s->backup, NULL));
    x->dt = 1;
    PG_TRY (weigh (s));
    if (!sys->force->motion.row_sums || sys->contact) x->weigh = weigh;
    PG_TRY (relaxation_stages (s));
done:
    return status;
}

const pg_solver_type pg_solver_adr = {
    .name = "adr",
    .summary = "quasi-static stages by adaptive dynamic relaxation",
    .flags = PG_SOLVER_QUASI_STATIC | PG_SOLVER_STAGED | PG_SOLVER_CONTACT | PG_SOLVER_RANKS,
    .keys = { &solver_keys_stages, &solver_keys_breaking },
    .read = relaxation_read,
    .prepare = prepare,
    RELAXATION_ENTRIES,
};
