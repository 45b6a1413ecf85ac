/* SPDX-License-Identifier: GPL-3.0-or-later
 * Random numbers and elementary functions with the same bits on every machine (random.h). */
#include "random.h"
#include <math.h>

/* ---- generator ------------------------------------------------------------------------------------------
 */
enum { WORDS = 624, FAR = 397 };

/* Initialises the generator from a seed (the initialisation of 2002). */
void random_start (random_source *r, uint32_t seed)
{
    r->word[0] = seed;
    for (uint32_t i = 1; i < WORDS; i++)
        r->word[i] = 1812433253u * (r->word[i - 1] ^ (r->word[i - 1] >> 30)) + i;
    r->at = WORDS;
}

/* Generates the next WORDS words. */
static void refill (random_source *r)
{
    for (int i = 0; i < WORDS; i++) {
        uint32_t y = (r->word[i] & 0x80000000u) | (r->word[(i + 1) % WORDS] & 0x7fffffffu);
        r->word[i] = r->word[(i + FAR) % WORDS] ^ (y >> 1) ^ (y & 1 ? 0x9908b0dfu : 0);
    }
    r->at = 0;
}

uint32_t random_word (random_source *r)
{
    if (r->at == WORDS) refill (r);
    uint32_t y = r->word[r->at++];
    y ^= y >> 11;
    y ^= (y << 7) & 0x9d2c5680u;
    y ^= (y << 15) & 0xefc60000u;
    return y ^ (y >> 18);
}

double random_uniform (random_source *r)
{
    uint64_t high = random_word (r) >> 6, low = random_word (r) >> 6;              /* 26 bits each */
    return ldexp ((double) (high << 26 | low) + 0.5, -52);
}

/* ---- elementary functions -------------------------------------------------------------------------------
 */
/* pi / 2 and log 2, each as a number of few digits, of which small multiples are exact, and the rest. */
static const double half_pi = 1.57079632679489661923, half_pi_high = 1.57079632673412561417,
                    half_pi_low = 6.07710050650619224932e-11, log_2_high = 6.93147180369123816490e-01,
                    log_2_low = 1.90821492927058770002e-10;

/* x = 2^k m, m from sqrt (1/2) to sqrt (2): log m = 2 artanh s, s = (m - 1) / (m + 1). */
double settled_log (double x)
{
    int k;
    double m = frexp (x, &k), sum = 0;
    if (m < 0.70710678118654752440) m *= 2, k--;
    double s = (m - 1) / (m + 1), square = s * s;
    for (int i = 21; i >= 1; i -= 2) sum = sum * square + 1.0 / i;
    return k * log_2_high + (2 * s * sum + k * log_2_low);
}

/* e^x = 2^k e^r, |r| <= log 2 / 2, by Taylor's series. */
double settled_exp (double x)
{
    if (x < -700) return 0;
    if (x > 700) return INFINITY;
    double k = floor (x / (log_2_high + log_2_low) + 0.5), r = (x - k * log_2_high) - k * log_2_low, sum = 1;
    for (int i = 16; i >= 1; i--) sum = 1 + sum * r / i;
    return ldexp (sum, (int) k);
}

double settled_power (double x, double y) { return settled_exp (y * settled_log (x)); }

/* Quarter turns first; the rest, at most pi / 4, by Taylor's series. */
void settled_angle (double angle, double *cosine, double *sine)
{
    double k = floor (angle / half_pi + 0.5), r = (angle - k * half_pi_high) - k * half_pi_low,
           square = r * r;
    double c = 1, s = 1;
    for (int i = 18; i >= 2; i -= 2) c = 1 - c * square / (i * (i - 1)), s = 1 - s * square / (i * (i + 1));
    s *= r;
    int quarter = (int) (k - 4 * floor (k / 4));
    *cosine = quarter == 0 ? c : quarter == 1 ? -s : quarter == 2 ? -c : s;
    *sine = quarter == 0 ? s : quarter == 1 ? c : quarter == 2 ? -s : -c;
}

/* ---- distributions --------------------------------------------------------------------------------------
 */
/* A point is drawn in the unit circle; its squared distance from the centre is uniform. The second number of
 * the polar method is not kept, so that calls do not depend on each other. */
double random_normal (random_source *r)
{
    double u, v, s;
    do {
        u = 2 * random_uniform (r) - 1, v = 2 * random_uniform (r) - 1;
        s = u * u + v * v;
    } while (s >= 1 || s == 0);
    return u * sqrt (-2 * settled_log (s) / s);
}

/* Rejection from a wrapped Cauchy distribution; the cosine f of the angle is all that is needed. */
void random_von_mises (random_source *r, double concentration, double direction[2])
{
    double f, c, s;
    if (!(concentration > 1e-6)) {                     /* uniform to the last digits of f */
        settled_angle (4 * half_pi * random_uniform (r), &direction[0], &direction[1]);
        return;
    }
    double tau = 1 + sqrt (1 + 4 * concentration * concentration),
           rho = (tau - sqrt (2 * tau)) / (2 * concentration), shape = (1 + rho * rho) / (2 * rho);
    for (;;) {
        settled_angle (2 * half_pi * random_uniform (r), &c, &s);
        f = (1 + shape * c) / (shape + c);
        double g = concentration * (shape - f), u = random_uniform (r);
        if (g * (2 - g) > u || settled_log (g / u) + 1 - g >= 0) break;
    }
    direction[0] = f = fmin (1, fmax (-1, f));
    direction[1] = sqrt (1 - f * f) * (random_uniform (r) < 0.5 ? -1 : 1);
}

/* The height has density ~ exp (concentration h) on [-1, 1], by inversion; the turn about the axis is
 * uniform. */
void random_fisher (random_source *r, double concentration, double direction[3])
{
    double u = random_uniform (r), h = 2 * u - 1, c, s;
    if (concentration > 1e-6)
        h = 1 + settled_log (u + (1 - u) * settled_exp (-2 * concentration)) / concentration;
    h = fmin (1, fmax (-1, h));
    settled_angle (4 * half_pi * random_uniform (r), &c, &s);
    double across = sqrt (1 - h * h);
    direction[0] = across * c, direction[1] = across * s, direction[2] = h;
}

/* ---- random shifts of points --------------------------------------------------------------------------- */
/* A bijection that spreads every bit (the finaliser of splitmix64). */
static uint64_t mix (uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* 53 random bits as a number in [-1, 1), from a hash of seed, site and axis. */
double pg_place_shift (uint64_t seed, uint64_t site, int axis)
{
    uint64_t z = mix (mix (seed + 0x9e3779b97f4a7c15u) + 3 * site + (uint64_t) axis + 1);
    return ldexp ((double) (z >> 11), -52) - 1;
}
