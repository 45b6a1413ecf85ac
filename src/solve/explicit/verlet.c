/* SPDX-License-Identifier: GPL-3.0-or-later
 * Velocity Verlet (theory B4) with damping C = c M:
 *   v_n = (v(n-1/2) + dt f_n / (2 m)) / (1 + c dt / 2), a_n = f_n / m - c v_n, v(n+1/2) = v_n + dt a_n / 2,
 *     u_n+1 = u_n + dt v(n+1/2). v and a of the state are those of its displacement. */
#include "explicit.h"

/* The two half kicks of a block; they round alike, whether both are due or one. */
PG_WIDEST static void range (const half_kicks *w, size_t first, size_t last, double *sum)
{
    const double h = 0.5 * w->dt, dt = w->dt, c = w->damping, less = 1 / (1 + h * c), only = w->only;
    double *restrict d = w->d, *restrict v = w->v, *restrict a = w->a;
    double *restrict f = w->f, *restrict inverse = w->inverse, *restrict mass = w->mass;
    pg_eight before = { 0 }, after = { 0 }, kinetic = { 0 };
#define RESIST(T, i, lane) \
    do { \
        const T vn = (OF (T, v, i) + h * (OF (T, f, i) * OF (T, inverse, i))) * less; \
        before lane += OF (T, mass, i) * vn * OF (T, v, i); \
        after lane += OF (T, mass, i) * vn * (2 * vn - OF (T, v, i)); \
    } while (0)
#define MOVE(T, i, per_mass) \
    do { \
        const T acc = OF (T, f, i) * (per_mass), vn = (OF (T, v, i) + h * acc) * less; \
        OF (T, v, i) = vn + h * (acc - c * vn); \
        OF (T, d, i) += dt * OF (T, v, i); \
    } while (0)
#define BOTH(T, i, lane) MOVE (T, i, OF (T, inverse, i))
#define BOTH_ALIKE(T, i, lane) MOVE (T, i, only)
#define OPEN(T, i, lane) \
    do { OF (T, v, i) += h * OF (T, a, i); OF (T, d, i) += dt * OF (T, v, i); } while (0)
#define CLOSE(T, i, lane) \
    do { \
        const T acc = OF (T, f, i) * OF (T, inverse, i), old = OF (T, v, i), vn = (old + h * acc) * less; \
        OF (T, v, i) = vn, OF (T, a, i) = acc - c * vn; \
        kinetic lane += OF (T, mass, i) * old * (vn + h * OF (T, a, i)); \
    } while (0)
    if (w->closing && c > 0) EACH_OF (first, last, RESIST);
    if (w->closing) sum[SUM_C] = lane_sum (&before), sum[SUM_D] = lane_sum (&after);
    if (w->closing && w->opening && only > 0) EACH_OF (first, last, BOTH_ALIKE);
    else if (w->closing && w->opening) EACH_OF (first, last, BOTH);
    else if (w->opening) EACH_OF (first, last, OPEN);
    else {
        EACH_OF (first, last, CLOSE);
        sum[SUM_K] = lane_sum (&kinetic);
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
