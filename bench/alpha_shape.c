/* SPDX-License-Identifier: GPL-3.0-or-later
 * Times alpha shapes: alpha_shape [POINTS]. About so many points (10^6) of a square with a round hole and of
 * a cube with a spherical cavity, on a lattice and moved at random by up to 0.4 spacings, alpha automatic.
 * CSV: case, points, processor seconds, alpha over the spacing, parts, holes, volume over that of the body.
 * The shape ends at the outermost points, half a spacing inside of the body, which is taken into account. */
#include "perigal/cloud.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const double pi = 3.14159265358979323846, radius = 0.25;

/* A uniform number of -1 to 1 (xorshift, the same on any machine). */
static double next (uint64_t *s)
{
    *s ^= *s << 13, *s ^= *s >> 7, *s ^= *s << 17;
    return (double) (*s >> 11) / 4503599627370496.0 - 1;
}

/* Points at the centres of the n^dim cells of the unit square or cube that lie outside of the hole. */
static size_t fill (double *x, int dim, long n, double moved)
{
    uint64_t seed = 88172645463325252u;
    double h = 1.0 / (double) n;
    size_t count = 0;
    long all = n * n * (dim == 3 ? n : 1);
    for (long k = 0; k < all; k++) {
        double at[3] = { 0 }, r2 = 0;
        long rest = k;
        for (int a = 0; a < dim; a++, rest /= n) {
            at[a] = ((double) (rest % n) + 0.5) * h;
            r2 += (at[a] - 0.5) * (at[a] - 0.5);
        }
        if (r2 < radius * radius) continue;
        for (int a = 0; a < dim; a++) x[(size_t) dim * count + (size_t) a] = at[a] + moved * h * next (&seed);
        count++;
    }
    return count;
}

static int time_one (int dim, double points, double moved)
{
    double hole = dim == 2 ? pi * radius * radius : 4 * pi / 3 * radius * radius * radius,
           side = dim == 2 ? sqrt (points / (1 - hole)) : cbrt (points / (1 - hole));
    long n = lround (side);
    size_t most = (size_t) (n * n * (dim == 3 ? n : 1));
    double *x = malloc (sizeof *x * (size_t) dim * most), h = 1.0 / (double) n;
    if (!x) return perror ("alpha_shape"), 1;
    size_t count = fill (x, dim, n, moved);
    pg_alpha_shape s = { 0 };
    clock_t start = clock ();
    pg_status status = pg_alpha_shape_create (&s, dim, count, x, 0);
    double seconds = (double) (clock () - start) / CLOCKS_PER_SEC, r = radius + h / 2,
           body = pow (1 - h, dim) - (dim == 2 ? pi * r * r : 4 * pi / 3 * r * r * r);
    if (status != PG_OK) fprintf (stderr, "alpha_shape: %s\n", pg_last_error ());
    else
        printf ("%s %s,%zu,%.3f,%.3f,%zu,%zu,%.5f\n", dim == 2 ? "square" : "cube",
                moved > 0 ? "moved" : "lattice", count, seconds, s.alpha / h, s.parts, s.holes,
                s.volume / body);
    pg_alpha_shape_clear (&s);
    free (x);
    return status != PG_OK;
}

int main (int argc, char **argv)
{
    double points = argc > 1 ? atof (argv[1]) : 1e6;
    if (!(points >= 100 && points <= 1e8)) return fprintf (stderr, "usage: alpha_shape [POINTS]\n"), 64;
    int failed = 0;
    printf ("case,points,seconds,alpha_over_spacing,parts,holes,volume_over_body\n");
    for (int dim = 2; dim <= 3; dim++)
        for (int moved = 0; moved < 2; moved++) failed |= time_one (dim, points, moved ? 0.4 : 0);
    return failed;
}
