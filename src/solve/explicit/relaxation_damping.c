/* SPDX-License-Identifier: GPL-3.0-or-later
 * Damping of relaxation, critical for the lowest frequency in the motion: c = 2 omega, omega^2 = v K v / v M
 * v, Rayleigh's quotient of the velocity, found at every iteration from the change of the residual (Kilic and
 * Madenci 2010). */
#include "relaxation.h"
#include "perigal/ranks.h"
#include <math.h>

/* Share of the two sums of the quotient that is kept from one iteration to the next, without and with hold:
 * one iteration alone would make the damping jump, and amplify rounding. */
static const double memory[2] = { 0.98, 0.9 };
/* Without hold the damping is at least this share of the critical one for the shape of the body under its
 * loads. */
static const double share = 0.5;

void relaxation_damp (struct relaxation *x, int hold, double stiff, double heavy)
{
    if (x->resting) x->stiff = x->heavy = 0;
    else if (!x->broke && heavy > 0) {
        x->stiff = memory[hold] * x->stiff + stiff, x->heavy = memory[hold] * x->heavy + heavy;
        x->c = fmin (1.9 / x->dt, fmax (x->floor, 2 * sqrt (fmax (0, x->stiff / (x->heavy * x->dt)))));
    }
}

/* Damping from Rayleigh's quotient of the displacement itself, less its mean, where d . (P - r) is d K d: a
 * body that follows slow loads has hardly any strain rate, so that v K v would give no damping and rounding
 * would grow into oscillations. */
double relaxation_least_damping (const pg_solver *s, const pg_state *state)
{
    const motion *m = motion_of (s);
    const pg_system *sys = &s->break_loop.system;
    const double *d = state->d, *mass = m->relaxation->mass;
    size_t components = (size_t) sys->components;
    double stiff = 0, heavy = 0, sum[1 + 3 * 6] = { 0 };
    for (size_t i = 0; i < sys->ndof; i++) stiff += d[i] * ((m->P ? m->P[i] : 0) - sys->balance.residual[i]);
    for (size_t k = 0; k < m->nprescribed; k++) stiff += d[m->prescribed[k]] * m->push[k];
    sum[0] = stiff;
    for (size_t i = 0; i < sys->ndof; i++) {
        double *of = sum + 1 + 3 * (i % components);
        if (!pg_cloud_owns (&s->problem->cloud, i / components)) continue;
        of[0] += mass[i], of[1] += mass[i] * d[i], of[2] += mass[i] * d[i] * d[i];
    }
    if (pg_cloud_sum (&s->problem->cloud, 1 + 3 * components, sum) != PG_OK) return NAN;
    for (size_t c = 0; c < components; c++) {
        const double *of = sum + 1 + 3 * c;
        if (of[0] > 0) heavy += of[2] - of[1] * of[1] / of[0];
    }
    stiff = sum[0];
    return heavy > 0 && stiff > 0 ? share * 2 * sqrt (stiff / heavy) : 0;
}
