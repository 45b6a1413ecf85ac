/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where a crack goes: across the direction of the largest hoop stress around its tip (Erdogan and Sih 1963,
 * On the crack extension in plates under plane loading and transverse shear). There K_I sin theta + K_II (3
 * cos theta - 1) = 0, whose root in tension is
 *
 *   tan (theta / 2) = - 2 K_II / (K_I + sqrt (K_I^2 + 8 K_II^2)),
 *
 * and the stress intensity of a crack that turns there is, to first order, that of the hoop stress, K_theta =
 * cos (theta / 2) (K_I cos^2 (theta / 2) - 3/2 K_II sin theta).
 *
 * That is the direction of an infinitely short facet. Over the length l of a facet a compression -T along the
 * crack brings a shear of its own, which vanishes if K_I in the direction counts for K_I - 3.19 T sqrt (l)
 * (from K_II + theta (K_I / 2 - 1.6 T sqrt (l)) = 0 to first order in theta): next to nothing for ordinary
 * cracks, but without it wing cracks of closed cracks, where K_I is small, swing from side to side. So that
 * the first kink of an ordinary crack stays that of the closed form on any spacing, only what exceeds 0.2 K_I
 * counts.
 *
 * The magnitude comes from J, the ratio from K: of J a discretisation knows more (a stress along the crack
 * falsifies the interaction integrals of a field that is not exact, J is a work). */
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
