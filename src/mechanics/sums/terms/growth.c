/* SPDX-License-Identifier: GPL-3.0-or-later
 * Energy that a crack consumes which grows bond by bond, over that of a straight cut through bonds that are
 * all at their limit (calibration.c). It is more: when a bond breaks, not only its own energy is released but
 * also energy of its neighbours while the gap opens, and a crack that has to leave the rows of its lattice
 * breaks bonds beside its path.
 *
 * Measured, not derived: strips clamped along both edges, cracked bond by bond, four directions of growth
 * under the lattice (0, 15, 30, 45 degrees), two shifts of each, by bench/single_bonds (doc/method.md A1).
 * The mean is over directions; least and most are single lattices. */
#include "perigal/sums.h"
#include <math.h>

/* Measured growth (mean, least, most) for a horizon in spacings. alone: bond-based forces. */
typedef struct { double horizon; pg_growth growth; } row;
enum { ROWS = 3 };
static const row alone[ROWS] = { { 3.015, { 1.138, 1.105, 1.182 } },
                                 { 4.015, { 1.086, 1.053, 1.117 } },
                                 { 5.015, { 1.039, 1.023, 1.071 } } };
/* State-based forces. At Poisson's ratio 1/3 in plane stress they equal bond-based ones; the row at 3
 * spacings is the mean of that and of Poisson's ratio 0.2. */
static const row state[ROWS] = { { 3.015, { 1.128, 1.083, 1.187 } },
                                 { 4.015, { 1.08, 1.05, 1.12 } },
                                 { 5.015, { 1.04, 1.02, 1.06 } } };
/* Micropolar bonds, Poisson's ratio 0.25. */
static const row beams[ROWS] = { { 3.015, { 1.156, 1.088, 1.274 } },
                                 { 4.015, { 1.068, 1.033, 1.121 } },
                                 { 5.015, { 1.043, 1.011, 1.105 } } };
/* Horizons beyond the rows by up to this, in spacings, take the nearest row. */
static const double beyond = 0.26;

/* Is the kernel the same at every distance within the horizon? */
static int is_flat (const pg_kernel *kernel)
{
    static const double place[4] = { 0.05, 0.35, 0.7, 0.999 };
    double w[4];
    kernel->value (4, place, w, NULL);
    return w[0] == w[1] && w[1] == w[2] && w[2] == w[3];
}

static double between (double a, double b, double share) { return a + share * (b - a); }

pg_growth pg_sums_growth (const pg_sums *sums)
{
    const pg_sum_rule *rule = &sums->rule;
    const row *r = rule->beams ? beams : rule->state ? state : alone;
    pg_growth none = { 0, 0, 0 };
    if (!rule->calibrate || sums->stencil.n == 0 || sums->sites.dim != 2 || !is_flat (rule->kernel))
        return none;
    double horizon = rule->horizon / sqrt (sums->stencil.cell);
    if (horizon < r[0].horizon - beyond || horizon > r[ROWS - 1].horizon + beyond) return none;
    size_t k = 1;
    while (k + 1 < ROWS && horizon > r[k].horizon) k++;
    const pg_growth *a = &r[k - 1].growth, *b = &r[k].growth;
    double share = (horizon - r[k - 1].horizon) / (r[k].horizon - r[k - 1].horizon);
    share = fmin (1, fmax (0, share));
    return (pg_growth) { between (a->mean, b->mean, share), between (a->least, b->least, share),
                         between (a->most, b->most, share) };
}
