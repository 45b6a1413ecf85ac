/* SPDX-License-Identifier: GPL-3.0-or-later
 * closed_crack_scenes.h: plates with a crack whose faces touch, and what is right. Included by the bench and
 * by tests. E = 1000 Pa; the half length a of the crack is `unit` m; the plate is the square of half width 2
 * a and bears on its outline the tractions that an infinite plate has there, so that the closed forms are
 * exact.
 *
 *   inclined   uniform compression of 1 Pa at the angle `load` to the crack. Closed faces bear the uniform
 *              stress sigma_n, mu sigma_n; the rest of the shear, t = |tau| - mu sigma_n, is that of an
 *              open crack: Westergaard's Z_II = t z / sqrt (z^2 - a^2), K_II = t sqrt (pi a). t < 0: it
 *              sticks, K_II = 0.
 *   bending    sigma_yy = x Pa/m along the crack. It is open from x = - a / 3 on, as a crack of half length
 *              b = 2 a / 3 whose left end closes smoothly: with s = x - a / 3, z = s + i y Westergaard's
 *              Z_I = sqrt ((z + b) / (z - b)) (z - b / 2), less z + b / 2; K_I = 2/3 a sqrt (2 pi a / 3).
 *
 * (H. M. Westergaard, Bearing pressures and cracks, J. Appl. Mech. 6 (1939) A49-A53.) */
#ifndef PERIGAL_BENCH_CLOSED_CRACK_SCENES_H
#define PERIGAL_BENCH_CLOSED_CRACK_SCENES_H
#include "perigal.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    int    bending;
    double load, friction;                             /* rad, 1 */
    double turn, shift[2], perturb, unit;              /* of the crack: rad, spacings; of points; m */
    int    n, mirrored;                                /* spacings of a half length */
    const char *plane;                                 /* stress, strain; NULL: stress */
    double nu;                                         /* Poisson's ratio; 0: 1/4 */
    const char *more;                                  /* last lines of the scene */
} closed_case;

/* Five lattices: points on the crack, two shifts, points moved at random, turned by 20 degrees. */
typedef struct { const char *name; double turn, shift[2], perturb; } closed_lattice;
enum { CLOSED_LATTICES = 5 };
static const closed_lattice closed_lattices[CLOSED_LATTICES] = { { "on points", 0, { 0, 0 }, 0 },
                                                                 { "shift .37 .21", 0, { 0.37, 0.21 }, 0 },
                                                                 { "shift .1 -.13", 0, { 0.1, -0.13 }, 0 },
                                                                 { "moved .2", 0, { 0, 0 }, 0.2 },
                                                                 { "turned 20", 0.34906585, { 0, 0 }, 0 } };

/* Growth is judged, so that K is measured, and takes so much energy that nothing grows. */
static const char *const closed_judged = "failure: {criterion: energy_release, fracture_energy: 1e30}\n"
                                         "solver: {kind: static, stepping: fixed, steps: 1}\n";
enum { CLOSED_TEXT = 400000, CLOSED_LONG = 9000 };

/* ---- the exact stress ---------------------------------------------------------------------------------- */
typedef struct { double normal, shear, along, free; } closed_exact;

static inline closed_exact closed_exact_of (const closed_case *c)
{
    double b = c->load;
    closed_exact e = { .normal = sin (b) * sin (b), .along = cos (b) * cos (b),
                       .shear = (c->mirrored ? -1 : 1) * sin (b) * cos (b) };
    e.free = copysign (fmax (0, fabs (e.shear) - c->friction * e.normal), e.shear);
    return e;
}

/* What is right at the right tip: K_I or K_II, Pa m^(1/2). */
static inline double closed_right (const closed_case *c)
{
    const double pi = acos (-1);
    return c->bending ? 2.0 / 3 * c->unit * sqrt (2 * pi * c->unit / 3)
                      : closed_exact_of (c).free * sqrt (pi * c->unit);
}

/* Stresses in the frame of the crack as formulas in x and y; X and Y: places over a. */
static inline void closed_inclined (const closed_case *c, const char *X, const char *Y, char *xx, char *yy,
                                    char *xy)
{
    closed_exact e = closed_exact_of (c);
    char angle[1600], modulus[1600], turn[1600], weight[1600];
    snprintf (angle, sizeof angle, "(atan2(%s,%s)-0.5*(atan2(%s,%s-1)+atan2(%s,%s+1)))", Y, X, Y, X, Y, X);
    snprintf (modulus, sizeof modulus, "hypot(%s,%s)/sqrt(hypot(%s-1,%s)*hypot(%s+1,%s))", X, Y, X, Y, X, Y);
    snprintf (turn, sizeof turn, "(1.5*(atan2(%s,%s-1)+atan2(%s,%s+1)))", Y, X, Y, X);
    snprintf (weight, sizeof weight, "%s/(hypot(%s-1,%s)*hypot(%s+1,%s))^1.5", Y, X, Y, X, Y);
    snprintf (xx, CLOSED_LONG, "(%.17g+%.17g*(2*%s*sin(%s)-%s*cos(%s)))", -e.along, e.free, modulus, angle,
              weight, turn);
    snprintf (yy, CLOSED_LONG, "(%.17g+%.17g*%s*cos(%s))", -e.normal, e.free, weight, turn);
    snprintf (xy, CLOSED_LONG, "(%.17g+%.17g*(%s*cos(%s)-%s*sin(%s)))", e.shear - e.free, e.free, modulus,
              angle, weight, turn);
}

/* In units of b: z = S + i Y. Z = R e^(i f) (z - 1/2) - z - 1/2, R e^(i f) = sqrt ((z + 1) / (z - 1)), Z' =
 * R e^(i f) (1 - w) - 1, w = (z - 1/2) / (z^2 - 1) = W e^(i g). */
static inline void closed_bending (const closed_case *c, const char *X, const char *Y0, char *xx, char *yy,
                                   char *xy)
{
    char S[300], Y[300], near[700], far[700], mid[700], R[1700], W[2200], f[1700], g[2200], real[12000],
        slope[12000], imaginary[12000];
    double b = 2.0 / 3, size = c->unit * b;
    snprintf (S, sizeof S, "(%.17g*%s-0.5)", 1 / b, X);
    snprintf (Y, sizeof Y, "(%.17g*%s)", 1 / b, Y0);
    snprintf (near, sizeof near, "atan2(%s,%s-1)", Y, S);
    snprintf (far, sizeof far, "atan2(%s,%s+1)", Y, S);
    snprintf (mid, sizeof mid, "atan2(%s,%s-0.5)", Y, S);
    snprintf (R, sizeof R, "sqrt(hypot(%s+1,%s)/hypot(%s-1,%s))", S, Y, S, Y);
    snprintf (W, sizeof W, "(hypot(%s-0.5,%s)/(hypot(%s-1,%s)*hypot(%s+1,%s)))", S, Y, S, Y, S, Y);
    snprintf (f, sizeof f, "(0.5*(%s-%s))", far, near);
    snprintf (g, sizeof g, "(%s-%s-%s)", mid, near, far);
    snprintf (real, sizeof real, "(%s*hypot(%s-0.5,%s)*cos(%s+%s)-%s-0.5)", R, S, Y, f, mid, S);
    snprintf (slope, sizeof slope, "(%s*(cos(%s)-%s*cos(%s+%s))-1)", R, f, W, f, g);
    snprintf (imaginary, sizeof imaginary, "(%s*(sin(%s)-%s*sin(%s+%s)))", R, f, W, f, g);
    snprintf (xx, CLOSED_TEXT, "(%.17g*(%s-%s*%s))", size, real, Y, imaginary);
    snprintf (yy, CLOSED_TEXT, "(%.17g*(%s+0.5+%s+%s*%s))", size, S, real, Y, imaginary);
    snprintf (xy, CLOSED_TEXT, "(%.17g*(-%s*%s))", size, Y, slope);
}

/* ---- the scene ----------------------------------------------------------------------------------------- */
/* Component `which` (xx, yy, xy) in the frame of the plate. */
static inline void closed_turned (const closed_case *c, const char *xx, const char *yy, const char *xy,
                                  char *out, int which)
{
    double C = cos (c->turn), S = sin (c->turn);
    const double weight[3][3] = { { C * C, S * S, -2 * C * S }, { S * S, C * C, 2 * C * S },
                                  { C * S, -C * S, C * C - S * S } };
    snprintf (out, CLOSED_TEXT, "%.17g*%s+%.17g*%s+%.17g*%s", weight[which][0], xx, weight[which][1], yy,
              weight[which][2], xy);
}

/* The text of the scene, to be freed by pg_free; NULL: no memory. */
static inline char *closed_text (const closed_case *c)
{
    double u = c->unit, w = 2 * u, h = u / c->n, C = cos (c->turn), S = sin (c->turn);
    char X[200], Y[200], contact[100], *part = pg_calloc (6, CLOSED_TEXT), *s[3];
    char *text = part ? pg_calloc (20, CLOSED_TEXT) : NULL;
    if (!text) {
        pg_free (part);
        return NULL;
    }
    char *xx = part, *yy = part + CLOSED_TEXT, *xy = yy + CLOSED_TEXT;
    for (int k = 0; k < 3; k++) s[k] = xy + (size_t) (k + 1) * CLOSED_TEXT;
    double at[2] = { c->shift[0] * h, c->shift[1] * h };
    snprintf (X, sizeof X, "((%.17g*x+%.17g*y-(%.17g m))/(%.17g m))", C, S, C * at[0] + S * at[1], u);
    snprintf (Y, sizeof Y, "((%.17g*y-%.17g*x-(%.17g m))/(%.17g m))", C, S, C * at[1] - S * at[0], u);
    (c->bending ? closed_bending : closed_inclined) (c, X, Y, xx, yy, xy);
    for (int k = 0; k < 3; k++) closed_turned (c, xx, yy, xy, s[k], k);
    snprintf (contact, sizeof contact,
              c->friction > 0 ? "{kind: friction, coefficient: %.17g}" : "{kind: normal}", c->friction);
    snprintf (text, 20 * (size_t) CLOSED_TEXT,
              "dimension: 2\nplane: %s\nthickness: %.17g\nbody: [{add: {box: {low: [%.17g, %.17g], high: "
              "[%.17g, %.17g]}}}]\nspacing: %.17g\nlattice: cells\nperturb: {amount: %.17g}\n"
              "cracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n"
              "materials: {m: {youngs_modulus: 1000, poissons_ratio: %.17g}}\ncontact: %s\n"
              "sets: {a: {where: \"x < %.17g and y < %.17g\"}, b: {where: \"x > %.17g and y < %.17g\"}}\n"
              "boundary:\n"
              "  - {name: r, set: right, traction: {x: \"%s\", y: \"%s\"}}\n"
              "  - {name: l, set: left, traction: {x: \"-(%s)\", y: \"-(%s)\"}}\n"
              "  - {name: t, set: top, traction: {x: \"%s\", y: \"%s\"}}\n"
              "  - {name: d, set: bottom, traction: {x: \"-(%s)\", y: \"-(%s)\"}}\n"
              "  - {name: a, set: a, essential: penalty, displacement: {x: 0, y: 0}}\n"
              "  - {name: b, set: b, essential: penalty, displacement: {y: 0}}\n"
              "output: {at: {levels: 1}}\n%s",
              c->plane ? c->plane : "stress", u, -w, -w, w, w, h, c->perturb, at[0] - C * u, at[1] - S * u,
              at[0] + C * u, at[1] + S * u, c->nu > 0 ? c->nu : 0.25, contact, -w + h, -w + h, w - h, -w + h,
              s[0], s[2], s[0], s[2], s[2], s[1], s[2], s[1], c->more ? c->more : closed_judged);
    pg_free (part);
    return text;
}
#endif
