/* SPDX-License-Identifier: GPL-3.0-or-later
 * Central differences as leapfrog (theory G4) with damping C = c M:
 *   v(n+1/2) = ((1 - c dt / 2) v(n-1/2) + dt f_n / m) / (1 + c dt / 2), u_n+1 = u_n + dt v(n+1/2), v(1/2) =
 *     v_0 + dt a_0 / 2. v of the state is half a step ahead of its displacement, a = (v(n+1/2) - v(n-1/2)) /
 *     dt. */
#include "explicit.h"

/* The two half kicks of a block. Where both are due in one pass the loop is cut into groups of LANES
 * unknowns, which the compiler turns into vector instructions; sums are kept in eight lanes so that they
 * round alike. */
PG_WIDEST static void range (const half_kicks *w, size_t first, size_t last, double *sum)
{
    const double h = 0.5 * w->dt, dt = w->dt, c = w->damping, less = 1 / (1 + h * c), only = w->only,
                 keep = (1 - h * c) * less, push = dt * less, rate = 1 / dt;
    double *restrict d = w->d, *restrict v = w->v, *restrict a = w->a;
    double *restrict f = w->f, *restrict inverse = w->inverse, *restrict mass = w->mass;
    pg_eight before = { 0 }, after = { 0 }, kinetic = { 0 };
/* the velocity half a step ahead */
#define NEXT(T, i, per_mass) (keep * OF (T, v, i) + push * (OF (T, f, i) * (per_mass)))
#define RESIST(T, i, lane) \
    do { \
        const T vn = 0.5 * (OF (T, v, i) + NEXT (T, i, OF (T, inverse, i))); \
        before lane += OF (T, mass, i) * vn * OF (T, v, i); \
        after lane += OF (T, mass, i) * vn * (2 * vn - OF (T, v, i)); \
    } while (0)
#define MOVE(T, i, per_mass) \
    do { OF (T, v, i) = NEXT (T, i, per_mass); OF (T, d, i) += dt * OF (T, v, i); } while (0)
#define BOTH(T, i, lane) MOVE (T, i, OF (T, inverse, i))
#define BOTH_ALIKE(T, i, lane) MOVE (T, i, only)
#define OPEN(T, i, lane) OF (T, d, i) += dt * OF (T, v, i)
#define CLOSE(T, i, lane) \
    do { \
        const T old = OF (T, v, i), now = NEXT (T, i, OF (T, inverse, i)); \
        kinetic lane += OF (T, mass, i) * old * now; \
        OF (T, a, i) = (now - old) * rate, OF (T, v, i) = now; \
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
