/* SPDX-License-Identifier: GPL-3.0-or-later
 * random_field (length, seed): a Gaussian random field of mean 0 and variance 1 as a function of position,
 * whatever the points, their order and the threads. It is a sum of plane waves,
 *
 * g (x) = sqrt (2 / M) sum_m cos (k_m . x + phi_m),
 *
 * with wave vectors k_m normal with deviation 1 / length along each axis and phases phi_m uniform (Shinozuka
 * and Deodatis 1991), so that its correlation is exp (- r^2 / (2 length^2)) on the mean over seeds. */
#include "expression.h"
#include <math.h>
#include <stdint.h>

enum { WAVES = 512 };

/* A bijection that spreads every bit (the finaliser of splitmix64). */
static uint64_t mix (uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Random number n of a seed, uniform in (0, 1). */
static double uniform (uint64_t seed, uint64_t n)
{
    uint64_t z = mix (mix (seed + 0x9e3779b97f4a7c15u) + n + 1);
    return ldexp ((double) (z >> 12) + 0.5, -52);
}

/* Wave vectors are made of independent normal numbers, two from two uniform ones (Box and Muller 1958); the
 * numbers do not depend on the length, so that fields of two lengths are one field at two scales. */
pg_status pg_field_create (double **out, double length, double seed)
{
    pg_status status = PG_OK;
    const double turn = 6.28318530717958647692;
    uint64_t s = (uint64_t) (int64_t) seed;
    PG_ALLOC (*out, 4 * WAVES);
    for (uint64_t m = 0; m < WAVES; m++) {
        double *wave = *out + 4*m, r = sqrt (-2 * log (uniform (s, 5*m))), a = turn * uniform (s, 5*m + 1),
               q = sqrt (-2 * log (uniform (s, 5*m + 2)));
        wave[0] = r * cos (a) / length, wave[1] = r * sin (a) / length;
        wave[2] = q * cos (turn * uniform (s, 5*m + 3)) / length;
        wave[3] = turn * uniform (s, 5*m + 4);
    }
done:
    return status;
}

double pg_field_value (const double *wave, const pg_place *at)
{
    double sum = 0;
    for (int m = 0; m < WAVES; m++, wave += 4)
        sum += cos (wave[0] * at->x + wave[1] * at->y + wave[2] * at->z + wave[3]);
    return sqrt (2.0 / WAVES) * sum;
}
