/* SPDX-License-Identifier: GPL-3.0-or-later
 * Direction of growth: along the radius of the largest hoop stress around the tip (Erdogan and Sih 1963, On
 * the crack extension in plates under plane loading and transverse shear). There K_I sin theta + K_II (3 cos
 * theta - 1) = 0, whose root in tension is
 *
 *   tan (theta / 2) = - 2 K_II / (K_I + sqrt (K_I^2 + 8 K_II^2)),
 *
 * and the stress intensity of a crack that turns there is, to first order, that of the hoop stress, K_theta =
 * cos (theta / 2) (K_I cos^2 (theta / 2) - 3/2 K_II sin theta).
 *
 * That is the direction of an infinitely short facet. Over the length l of a facet a compression -T along the
 * crack causes an additional shear, which vanishes if K_I in the direction counts for K_I - 3.19 T sqrt (l)
 * (from K_II + theta (K_I / 2 - 1.6 T sqrt (l)) = 0 to first order in theta): negligible for ordinary cracks,
 * but without it wing cracks of closed cracks, where K_I is small, zigzag. Only the excess over 0.2 K_I is
 * used, so that the first kink of an ordinary crack is that of the closed form at any spacing.
 *
 * The magnitude is taken from J, the ratio from K, as J is more accurate (a T stress disturbs the interaction
 * integrals of an inexact field). */
#include "perigal/fracture.h"
#include <math.h>

int pg_kink (double J, double K_I, double K_II, double T, double l, double *angle, double *K_theta,
             double *G_theta)
{
    double size = K_I * K_I + K_II * K_II, along = T < 0 && l > 0 ? -T * sqrt (l) : 0,  /* NAN: 0 */
        opening = K_I + 3.19 * fmax (0, along - 0.2 * fmax (0, K_I));
    *angle = *K_theta = *G_theta = 0;
    if (!(size > 0) || !isfinite (size)) return 0;
    double theta = 2 * atan2 (-2 * K_II, opening + sqrt (opening * opening + 8 * K_II * K_II)),
           c = cos (theta / 2), K = c * (K_I * c * c - 1.5 * K_II * sin (theta));
    if (!(K > 0) || !(J > 0)) return 0;
    *angle = theta, *K_theta = K, *G_theta = J * K * K / size;
    return 1;
}

/* ---- behind a kink ------------------------------------------------------------------------------------- */
/* K_I, K_II at the end of a trial facet at angle theta, by Lagrange interpolation between the trial
 * angles. */
static void at_end (const pg_tip_field *f, int nfield, const double *l, double theta, double K[2])
{
    K[0] = K[1] = 0;
    for (int i = 0; i < PG_TIP_TRIALS; i++) {
        double share = 1;
        for (int j = 0; j < PG_TIP_TRIALS; j++)
            if (j != i) share *= (theta - f->trial_angle[j]) / (f->trial_angle[i] - f->trial_angle[j]);
        for (int a = 0; a < nfield; a++)
            for (int m = 0; m < 2; m++) K[m] += share * l[a] * f->trial_K[i][m][a];
    }
}

/* Three times the mean of K_II / K_I along a facet, which changes with the root of the length: two thirds of
 * the mean come from its end, one third from its beginning (to first order in the angle). NAN: the end does
 * not open. */
static double shear (const pg_tip_field *f, int nfield, const double *l, const double K[3], double theta)
{
    double end[2];
    at_end (f, nfield, l, theta, end);
    return end[0] > 0 && K[0] > 0 ? 2 * end[1] / end[0] + (K[1] + 0.5 * theta * K[0]) / K[0] : NAN;
}

int pg_kink_ahead (const pg_tip_field *f, int nfield, const double *l, double start, double *angle)
{
    enum { HALVINGS = 40, STEPS = 24 };
    double K[3], step = (f->trial_angle[PG_TIP_TRIALS - 1] - f->trial_angle[0]) / STEPS, found = NAN;
    if (!(f->trial > 0)) return 0;
    pg_tip_combine (f, nfield, l, NULL, K, NULL);
    for (int i = 0; i < STEPS; i++) {                  /* finds the root nearest to `start` */
        double a = f->trial_angle[0] + i * step, b = a + step, fa = shear (f, nfield, l, K, a),
               fb = shear (f, nfield, l, K, b);
        if (!(fa <= 0) || !(fb >= 0)) continue;
        for (int k = 0; k < HALVINGS; k++) {
            double c = 0.5 * (a + b);
            if (shear (f, nfield, l, K, c) <= 0) a = c;
            else b = c;
        }
        if (isnan (found) || fabs (a - start) < fabs (found - start)) found = a;
    }
    if (isnan (found)) return 0;
    *angle = found;
    return 1;
}
