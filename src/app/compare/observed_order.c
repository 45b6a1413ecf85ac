/* SPDX-License-Identifier: GPL-3.0-or-later
 * Observed order of convergence and Richardson's extrapolated value, from values or from
 * errors at falling sizes h. Roache PJ, Verification and validation in computational science
 * and engineering, 1998, chapter 5; ratios of sizes may differ.
 *
 * The ratio (h1^p - h2^p) / (h2^p - h3^p) grows with p, so p is found by bisection without a
 * start value. At p = 0 the ratio is that of the logarithms; differences whose ratio is below
 * that do not get smaller. */
#include "perigal/compare.h"
#include <math.h>

/* Halvings of an interval of 20: the last one is below the spacing of doubles. */
enum { HALVINGS = 80 };
/* Largest order that is sought; differences that are this small relative to the values are
 * rounding and residuals of solvers. */
static const double highest = 20, same = 1e-10;

/* Returns the result where no order was found: what is known of limit and error, and why there is no
 * order. */
static pg_observed none (double limit, double error, const char *why)
{
    pg_observed o = { NAN, limit, error, why };
    return o;
}

/* (h1^p - h2^p) / (h2^p - h3^p), written with expm1, which keeps all digits for small p. It
 * grows with p, on which the bisection relies. */
static double ratio (const double *h, double p)
{
    if (p < 1e-9) return log (h[0] / h[1]) / log (h[1] / h[2]);
    return expm1 (p * log (h[0] / h[1])) / -expm1 (p * log (h[2] / h[1]));
}

/* 1 if n sizes are positive and each is smaller than the one before. */
static int falling (size_t n, const double *h)
{
    for (size_t k = 0; k < n; k++) if (!(h[k] > 0) || !isfinite (h[k]) || (k && !(h[k] < h[k - 1]))) return 0;
    return 1;
}

/* Finds the order from the last three values; the limit is v3 - (v2 - v3) / ((h2 / h3)^p - 1). */
pg_observed pg_observed_of_values (size_t n, const double *h, const double *value)
{
    if (n < 3) return none (NAN, NAN, "three sizes are needed");
    const double *s = h + n - 3, *v = value + n - 3;
    double first = v[0] - v[1], second = v[1] - v[2],
           scale = fmax (fmax (fabs (v[0]), fabs (v[1])), fabs (v[2]));
    double low = 0, high = highest;
    if (!falling (3, s)) return none (NAN, NAN, "the sizes do not fall");
    if (!isfinite (first) || !isfinite (second)) return none (NAN, NAN, "a value is missing");
    if (fabs (second) <= same * scale)
        return none (v[2], 0, fabs (first) <= same * scale ? "always the same" : "no longer changes");
    if (first / second <= 0) return none (NAN, fmax (fabs (first), fabs (second)), "oscillates");
    if (first / second <= ratio (s, 0)) return none (NAN, NAN, "diverges");
    if (first / second > ratio (s, highest)) return none (v[2], fabs (second), "last change too small");
    for (int k = 0; k < HALVINGS; k++) {
        double middle = 0.5 * (low + high);
        *(ratio (s, middle) < first / second ? &low : &high) = middle;
    }
    double rest = -second / expm1 (high * log (s[1] / s[2]));
    pg_observed o = { high, v[2] + rest, fabs (rest), NULL };
    return o;
}

/* Finds the order from the last two errors, which suffice, since their limit is known to be zero. An error
 * that is exactly zero has no logarithm. */
pg_observed pg_observed_of_errors (size_t n, const double *h, const double *error)
{
    if (n < 2) return none (0, NAN, "two sizes are needed");
    const double *s = h + n - 2, *e = error + n - 2;
    if (!falling (2, s)) return none (0, NAN, "the sizes do not fall");
    if (!isfinite (e[0]) || !isfinite (e[1])) return none (0, NAN, "a value is missing");
    if (!(e[0] > 0) || !(e[1] > 0)) return none (0, e[1], "an error is zero");
    if (e[1] >= e[0]) return none (NAN, e[1], "diverges");
    pg_observed o = { log (e[0] / e[1]) / log (s[0] / s[1]), 0, e[1], NULL };
    return o;
}

/* Interpolates y at `at` linearly in logarithms. (at - a) (at - b) <= 0 says that `at` lies between a and b,
 * in whichever order they come. */
double pg_loglog_at (size_t n, const double *x, const double *y, double at)
{
    for (size_t k = 0; k + 1 < n; k++) {
        double a = x[k], b = x[k + 1];
        if (!(a > 0) || !(b > 0) || !(y[k] > 0) || !(y[k + 1] > 0) || !(at > 0)) continue;
        if ((at - a) * (at - b) > 0) continue;
        if (a == b) return y[k];
        double share = log (at / a) / log (b / a);
        return exp (log (y[k]) + share * log (y[k + 1] / y[k]));
    }
    return NAN;
}
