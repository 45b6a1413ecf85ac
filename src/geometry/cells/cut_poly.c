/* SPDX-License-Identifier: GPL-3.0-or-later
 * Real roots of polynomials of degree 4 at most, and Gauss-Legendre rules on [0, 1].
 *
 * Degrees 1 and 2 in closed form. Higher degrees by recursion: between two neighbouring roots of the
 * derivative a polynomial is monotone, so that an interval with a change of sign holds exactly one root,
 * which Newton's method with bisection finds safely. */
#include "cut.h"
#include <math.h>

/* Value at x by Horner's scheme; c[k] belongs to x^k. */
static double value (int degree, const double *c, double x)
{
    double v = c[degree];
    for (int k = degree; k-- > 0; ) v = v * x + c[k];
    return v;
}

/* Sum of the sizes of all terms at |x| = far: the scale against which a value counts as zero. */
static double size_of (int degree, const double *c, double far)
{
    double size = 0, power = 1;
    for (int k = 0; k <= degree; k++, power *= far) size += fabs (c[k]) * power;
    return size;
}

/* Roots of c[0] + c[1] x + c[2] x^2, ascending. A discriminant that may be zero but for an error
 * `rounding` in each coefficient is zero: the surfaces touch, and rounding alone would tear the double root
 * apart or lose it. (The error is not relative to the terms, which vanish where surfaces touch in the middle:
 * it is that of a cell, in which all has size 1.) The formula for q avoids cancellation. */
static int quadratic (const double *c, double rounding, double *root)
{
    double D = c[1] * c[1] - 4 * c[0] * c[2],
           tiny = rounding * (2 * fabs (c[1]) + 4 * fabs (c[2]) + 4 * fabs (c[0]));
    if (D < -tiny) return 0;
    if (D <= tiny) {
        root[0] = -0.5 * c[1] / c[2];
        return 1;
    }
    double s = sqrt (D), q = -0.5 * (c[1] + (c[1] < 0 ? -s : s)), a = q / c[2], b = c[0] / q;
    root[0] = fmin (a, b), root[1] = fmax (a, b);
    return 2;
}

/* The root in [a, b], at whose ends the signs differ: Newton's method, with bisection where a step leaves
 * the interval, which shrinks with every step. */
static double between (int degree, const double *c, double a, double b)
{
    double slope[CUT_DEGREE], x = 0.5 * (a + b);
    int rising = value (degree, c, b) > 0;
    for (int k = 0; k < degree; k++) slope[k] = (k + 1) * c[k + 1];
    for (int i = 0; i < 100; i++) {
        double v = value (degree, c, x), d = value (degree - 1, slope, x), next = x - v / d;
        if (v == 0) return x;
        if ((v > 0) == rising) b = x;
        else a = x;
        if (!(next > a && next < b)) next = 0.5 * (a + b);
        if (fabs (next - x) < 1e-16 || next == a || next == b) return next;
        x = next;
    }
    return x;
}

/* Roots of a polynomial of degree 3 or 4 in [low, high]. A stationary point (or an end) where the value is
 * within `touch` of zero is a root itself: there the polynomial touches zero. */
static int wider (int degree, const double *c, double rounding, double low, double high, double touch,
                  double *root)
{
    double slope[CUT_DEGREE], turn[CUT_DEGREE + 2];
    int n = 0;
    for (int k = 0; k < degree; k++) slope[k] = (k + 1) * c[k + 1];
    int turns = cut_roots (degree - 1, slope, rounding, low, high, turn + 1);
    turn[0] = low, turn[turns + 1] = high;
    for (int i = 0; i <= turns; i++) {
        double p = value (degree, c, turn[i]), q = value (degree, c, turn[i + 1]);
        if (fabs (p) <= touch) {
            if (n == 0 || root[n - 1] < turn[i]) root[n++] = turn[i];
        } else if (fabs (q) > touch && (p > 0) != (q > 0))
            root[n++] = between (degree, c, turn[i], turn[i + 1]);
    }
    if (fabs (value (degree, c, high)) <= touch && n < degree && (n == 0 || root[n - 1] < high))
        root[n++] = high;
    return n < degree ? n : degree;
}

/* Leading coefficients that contribute less than 1e-14 of the size are dropped, as they would only produce
 * roots far outside. A polynomial that is constant has no roots. */
int cut_roots (int degree, const double *c, double rounding, double low, double high, double *root)
{
    double far = fmax (fabs (low), fabs (high)), size = size_of (degree, c, far), found[2];
    int n = 0, kept = 0;
    while (degree > 0 && fabs (c[degree]) * pow (far, degree) <= 1e-14 * size) degree--;
    if (degree == 0) return 0;
    if (degree > 2) return wider (degree, c, rounding, low, high, fmax (1e-12, rounding) * size, root);
    if (degree == 1) found[0] = -c[0] / c[1], n = 1;
    else n = quadratic (c, rounding, found);
    for (int i = 0; i < n; i++) if (found[i] >= low && found[i] <= high) root[kept++] = found[i];
    return kept;
}

/* Newton's method on the Legendre polynomial P_n by its three-term recurrence, from Tricomi's approximation
 * of the roots; weights 2 / ((1 - t^2) P_n'(t)^2), halved for the interval of length 1. */
void cut_gauss (int n, double *x, double *w)
{
    for (int i = 0; i < n; i++) {
        double t = cos (acos (-1) * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int k = 0; k < 100; k++) {
            double p = 1, before = 0;
            for (int j = 0; j < n; j++) {
                double next = ((2*j + 1) * t * p - j * before) / (j + 1);
                before = p, p = next;
            }
            slope = n * (t * p - before) / (t * t - 1);
            if (fabs (p / slope) < 1e-16) break;
            t -= p / slope;
        }
        x[n - 1 - i] = 0.5 * (1 + t), w[n - 1 - i] = 1 / ((1 - t * t) * slope * slope);
    }
}
