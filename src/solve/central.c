/* SPDX-License-Identifier: GPL-3.0-or-later
 * Central differences as leapfrog (theory G4) with damping C = c M:
 *   v(n+1/2) = ((1 - c dt / 2) v(n-1/2) + dt f_n / m) / (1 + c dt / 2), u_n+1 = u_n + dt v(n+1/2), v(1/2) =
 *     v_0 + dt a_0 / 2. v of the state is half a step ahead of its displacement, a = (v(n+1/2) - v(n-1/2)) /
 *     dt. */
#include "explicit.h"

/* The two half kicks of a block. Where both are due in one pass the loop is cut into groups of LANES
 * unknowns, which the compiler turns into vector instructions; sums are kept in eight lanes so that they
 * round alike. */
static void range (const half_kicks *w, size_t first, size_t last, double *sum)
{
    double h = 0.5 * w->dt, dt = w->dt, c = w->damping, less = 1 / (1 + h * c), keep = (1 - h * c) * less,
           push = dt * less, rate = 1 / dt;
    double *restrict d = w->d, *restrict v = w->v, *restrict a = w->a, before[8] = { 0 }, after[8] = { 0 },
                     kinetic[8] = { 0 };
    const double *restrict f = w->f, *restrict inverse = w->inverse;
    if (w->closing) {
        for (size_t i = first; c > 0 && i < last; i++) {
            double vn = 0.5 * (v[i] + (keep * v[i] + push * (f[i] * inverse[i])));
            before[i & 7] += w->mass[i] * vn * v[i];
            after[i & 7] += w->mass[i] * vn * (2 * vn - v[i]);
        }
        sum[SUM_C] = lane_sum (before), sum[SUM_D] = lane_sum (after);
    }
#define BOTH(i, per_mass) \
    do { v[i] = keep * v[i] + push * (f[i] * (per_mass)); d[i] += dt * v[i]; } while (0)
    size_t at = first;
    if (w->closing && w->opening) {
        const double only = w->only;
        for (; only > 0 && at + LANES <= last; at += LANES)
            for (size_t k = at; k < at + LANES; k++) BOTH (k, only);
        for (; at + LANES <= last; at += LANES)
            for (size_t k = at; k < at + LANES; k++) BOTH (k, inverse[k]);
        for (; at < last; at++) BOTH (at, inverse[at]);
    }
    else if (w->opening) for (size_t i = first; i < last; i++) d[i] += dt * v[i];
    else {
        for (size_t i = first; i < last; i++) {
            double now = keep * v[i] + push * (f[i] * inverse[i]);
            kinetic[i & 7] += w->mass[i] * v[i] * now;
            a[i] = (now - v[i]) * rate;
            v[i] = now;
        }
        sum[SUM_K] = lane_sum (kinetic);
    }
}

/* Velocities of the state stay half a step ahead of its displacements (staggered). */
static pg_status step (pg_solver *s, pg_state *state, pg_step *out)
{
    return explicit_step (s, state, out, range, 1);
}

const pg_solver_type pg_solver_central = {
    .name = "central",
    .summary = "explicit dynamics, central differences",
    .step = step,
    EXPLICIT_ENTRIES,
};
