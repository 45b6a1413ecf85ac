/* SPDX-License-Identifier: GPL-3.0-or-later
 * Colour maps. The sequential map rises evenly in lightness from indigo to yellow, so that it
 * keeps its order in print without colours and for readers who do not tell red from green. The
 * diverging map goes from blue through near-white to red. Curves of charts have eight colours. */
#include "picture_private.h"

/* Linear interpolation in t, limited to [0, 1] (NAN gives the first colour), between n colours
 * at equal distances. */
static void ramp (size_t n, const double anchor[][3], double t, double rgb[3])
{
    if (!(t > 0)) t = 0;
    if (t > 1) t = 1;
    double place = t * (double) (n - 1);
    size_t k = (size_t) place;
    if (k > n - 2) k = n - 2;
    for (int c = 0; c < 3; c++)
        rgb[c] = anchor[k][c] + (place - (double) k) * (anchor[k + 1][c] - anchor[k][c]);
}

void pg_colour_sequential (double t, double rgb[3])
{
    static const double anchor[][3] = {
        { 0.165, 0.090, 0.320 }, { 0.205, 0.205, 0.500 }, { 0.165, 0.345, 0.590 }, { 0.100, 0.480, 0.600 },
        { 0.110, 0.610, 0.540 }, { 0.340, 0.735, 0.410 }, { 0.680, 0.840, 0.310 }, { 0.985, 0.925, 0.430 },
    };
    ramp (sizeof anchor / sizeof *anchor, anchor, t, rgb);
}

void pg_colour_diverging (double t, double rgb[3])
{
    static const double anchor[][3] = {
        { 0.070, 0.180, 0.450 }, { 0.150, 0.390, 0.720 }, { 0.520, 0.710, 0.890 }, { 0.960, 0.960, 0.960 },
        { 0.950, 0.630, 0.510 }, { 0.800, 0.250, 0.210 }, { 0.480, 0.040, 0.120 },
    };
    ramp (sizeof anchor / sizeof *anchor, anchor, t, rgb);
}

void pg_colour_curve (size_t k, double rgb[3])
{
    static const double colour[PG_CURVE_COLOURS][3] = {
        { 0.07, 0.29, 0.60 }, { 0.84, 0.33, 0.06 }, { 0.10, 0.55, 0.36 }, { 0.55, 0.24, 0.62 },
        { 0.80, 0.62, 0.05 }, { 0.15, 0.65, 0.78 }, { 0.72, 0.12, 0.24 }, { 0.35, 0.35, 0.35 },
    };
    for (int c = 0; c < 3; c++) rgb[c] = colour[k % PG_CURVE_COLOURS][c];
}
