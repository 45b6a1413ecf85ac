/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to initiation.c, front_initiation.c and hot_spot.c: where new cracks may begin. */
#ifndef PG_HOT_SPOT_H
#define PG_HOT_SPOT_H
#include "trial_facet.h"

/* A stress that is constant + lambda slope: xx, yy, xy, Pa. */
typedef struct { double constant[3], slope[3]; } affine_stress;

/* A place where a crack may begin. */
typedef struct {
    double x[3];                                       /* m */
    affine_stress stress;                              /* averaged there */
    double factor;                                     /* load factor at which the strength is reached */
    /* of a crack across the largest tension, rad from x; of one that slides half way between the two on which
     * the strength in shear is reached together */
    double angle;
    int    slides;                                     /* 1: it is the strength in shear that is reached */
    double slope;                                      /* then: tangent of the angle of friction there */
    const pg_material *material;
    double h;                                          /* local spacing, m */
    double modulus;                                    /* Young's modulus, Pa */
    const pg_interface *interface;                     /* that it lies on, its angle along it; NULL: none */
} hot_spot;

/* What a search goes by. */
typedef struct {
    trials *w;
    const pg_state *state;
    const trial_fields *f;
    trial_limits limits;
    void *context;
    double best;                                       /* least load factor so far */
} search;

/* Load factor >= 0 at which the largest of tau - slope p over all planes reaches the cohesion c (Coulomb), p
 * the pressure across the plane. */
double    hot_shear_factor (const affine_stress *s, double c, double slope);
/* The largest strength that points h apart can tell, Pa: an eighth of E G0/f^2 is to be h at least. */
double    hot_strength_cap (double modulus, double energy, double h);
/* Stress at n places (n x 2), of which each `count` that follow each other and have body are averaged: n /
 * count results. */
pg_status hot_stress (const search *g, size_t n, size_t count, const double *x, affine_stress *out);
/* What a crack at that angle takes at x: energy in J/m^2, strength as far as the points can tell; 0: none can
 * grow there, or has no strength given. */
int       hot_resists (const search *g, const double *x, double angle, double h, double modulus,
                       pg_fracture_limits *out);
/* Too near an open tip or front, which grows by its own law, or beside a crack, whose faces are free. */
int       hot_excluded (const search *g, const double *x, double h);
/* Least distance of hot spots from each other and from tips, spacings. */
#define HOT_APART 4
/* Up to `most` places of interfaces that reach a strength of their own, in interface_facet.c. */
pg_status hot_interfaces (const search *g, size_t most, hot_spot *out, size_t *n);
/* Up to `most` places that reach their strength below g->best, the least load factor first. */
pg_status hot_spots (const search *g, size_t most, hot_spot *out, size_t *n);
#endif
