/* SPDX-License-Identifier: GPL-3.0-or-later
 * Velocity Verlet (theory B4) with damping C = c M:
 *   v_n = (v(n-1/2) + dt f_n / (2 m)) / (1 + c dt / 2), a_n = f_n / m - c v_n, v(n+1/2) = v_n + dt a_n / 2,
 *     u_n+1 = u_n + dt v(n+1/2). v and a of the state are those of its displacement. */
#include "explicit.h"

/* The two halves of a step round alike, whether they come at once or one by one. */
static void range (const half_kicks *w, size_t first, size_t last, double *sum)
{
    double h = 0.5 * w->dt, dt = w->dt, c = w->damping, less = 1 / (1 + h * c), before[8] = { 0 },
           after[8] = { 0 }, kinetic[8] = { 0 };
    double *restrict d = w->d, *restrict v = w->v, *restrict a = w->a;
    const double *restrict f = w->f, *restrict inverse = w->inverse;
    if (w->closing) {
        for (size_t i = first; c > 0 && i < last; i++) {
            double vn = (v[i] + h * (f[i] * inverse[i])) * less;
            before[i & 7] += w->mass[i] * vn * v[i];
            after[i & 7] += w->mass[i] * vn * (2 * vn - v[i]);
        }
        sum[SUM_C] = lane_sum (before), sum[SUM_D] = lane_sum (after);
    }
#define BOTH(i, per_mass) \
    do { \
        double acc = f[i] * (per_mass), vn = (v[i] + h * acc) * less; \
        v[i] = vn + h * (acc - c * vn); \
        d[i] += dt * v[i]; \
    } while (0)
    size_t at = first;
    if (w->closing && w->opening) {
        const double only = w->only;
        for (; only > 0 && at + LANES <= last; at += LANES)
            for (size_t k = at; k < at + LANES; k++) BOTH (k, only);
        for (; at + LANES <= last; at += LANES)
            for (size_t k = at; k < at + LANES; k++) BOTH (k, inverse[k]);
        for (; at < last; at++) BOTH (at, inverse[at]);
    }
    else if (w->opening)
        for (size_t i = first; i < last; i++) {
            v[i] = v[i] + h * a[i];
            d[i] += dt * v[i];
        }
    else {
        for (size_t i = first; i < last; i++) {
            double acc = f[i] * inverse[i], vn = (v[i] + h * acc) * less, old = v[i];
            v[i] = vn, a[i] = acc - c * vn;
            kinetic[i & 7] += w->mass[i] * old * (vn + h * a[i]);
        }
        sum[SUM_K] = lane_sum (kinetic);
    }
}

/* Velocities of the state are those of its displacements (not staggered). */
static pg_status step (pg_solver *s, pg_state *state, pg_step *out)
{
    return explicit_step (s, state, out, range, 0);
}

const pg_solver_type pg_solver_verlet = {
    .name = "verlet",
    .summary = "explicit dynamics, velocity Verlet",
    .step = step,
    EXPLICIT_ENTRIES,
};
