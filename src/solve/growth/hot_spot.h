/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to initiation.c, front_initiation.c and hot_spot.c: where new cracks may begin. */
#ifndef PG_HOT_SPOT_H
#define PG_HOT_SPOT_H
#include "trial_facet.h"

/* A stress that is constant + lambda slope: xx, yy, xy, Pa. */
typedef struct { double constant[3], slope[3]; } affine_stress;

/* A point where a crack may begin. */
typedef struct {
    double x[3];                                       /* position, m */
    affine_stress stress;                              /* average stress there, Pa */
    double factor;                                     /* load factor at which the strength is reached */
    /* crack across the largest tension: angle, rad from x; one that slides: half way between the two planes
     * on which the strength in shear is reached together */
    double angle;
    int    slides;                                     /* 1: the strength in shear is reached */
    double slope;                                      /* sliding: tangent of the angle of friction */
    const pg_material *material;
    double h;                                          /* local spacing, m */
    double modulus;                                    /* Young's modulus, Pa */
    const pg_interface *interface;  /* interface on which it lies, along `angle`; NULL: none */
} hot_spot;

/* Data of a search for hot spots. */
typedef struct {
    trials *w;
    const pg_state *state;
    const trial_fields *f;
    trial_limits limits;
    void *context;
    double best;                                       /* smallest load factor found so far */
} search;

/* Load factor >= 0 at which tau - slope p reaches the cohesion c on some plane (Coulomb), p being the
 * pressure on it. */
double    hot_shear_factor (const affine_stress *s, double c, double slope);
/* Largest strength that points with spacing h can resolve, Pa: an eighth of E G0/f^2 is to be h at least. */
double    hot_strength_cap (double modulus, double energy, double h);
/* Stress at n points (n x 2), averaged over each `count` successive ones that lie in the body: n / count
 * results. */
pg_status hot_stress (const search *g, size_t n, size_t count, const double *x, affine_stress *out);
/* Limits of a crack at that angle at x: energy in J/m^2, strength as far as the spacing resolves it; 0: none
 * can grow there, or no strength is given. */
int       hot_resists (const search *g, const double *x, double angle, double h, double modulus,
                       pg_fracture_limits *out);
/* 1: x is too near an open tip or front, which grows by its own criterion, or beside a crack, whose faces are
 * free. */
int       hot_excluded (const search *g, const double *x, double h);
/* Least distance between hot spots and from tips, spacings. */
#define HOT_APART 4
/* Finds up to `most` points of interfaces that reach a strength of their own (interface_facet.c). */
pg_status hot_interfaces (const search *g, size_t most, hot_spot *out, size_t *n);
/* Finds up to `most` points that reach their strength below g->best, the smallest load factor first. */
pg_status hot_spots (const search *g, size_t most, hot_spot *out, size_t *n);
#endif
