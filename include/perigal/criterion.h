/* SPDX-License-Identifier: GPL-3.0-or-later
 * criterion.h: when a bond breaks. Utilisation 1 is the limit; tension positive.
 * Catalogue: src/mechanics/criterion/<name>.c + one line in list.h. Sources: Cui 2022 section 1.1;
 * theory F2. */
#ifndef PERIGAL_CRITERION_H
#define PERIGAL_CRITERION_H
#include "perigal/material.h"

PG_API_BEGIN

enum {
    PG_NEEDS_STRETCH = 1,
    PG_NEEDS_STRESS = 2,
    PG_NEEDS_ENERGY = 4,
    PG_NEEDS_BEAMS = 8,
    /* Judges tips of cracks, not bonds: utilisation and factor are NULL, nothing asks bonds what they show;
     * cracks grow by facets (solver.break: facet), and `fracture` tells what a facet takes. */
    PG_NEEDS_FACETS = 16
};

/* Energy that a crack consumes which grows bond by bond, over that of a straight cut through bonds all at
 * their limit: mean over directions of growth, least and most of single lattices, as measured by
 * bench/single_bonds (doc/method.md A1). mean 0: not measured. */
typedef struct { double mean, least, most; } pg_growth;

/* What may be an expression of place: Young's modulus (of a material) and limits of failure. */
enum { PG_OF_STIFFNESS, PG_OF_ENERGY, PG_OF_STRETCH, PG_OF_TENSION, PG_OF_COHESION, PG_OF_COUNT };
/* The key of a limit (its last word) among these; -1: it must be a number. */
int pg_limit_of_place (const char *key);
typedef struct { double of[PG_OF_COUNT]; } pg_limit_ratio;     /* a place over the reference; 1: the same */

typedef struct pg_criterion_type pg_criterion_type;
typedef struct {
    const pg_criterion_type *type;
    int    single;  /* beam_limits: any one of the limits breaks a bond, not all together */
    int    never;                                      /* 1: bonds that end in this material never break */
    pg_growth growth;  /* how limits from an energy allow for the way cracks grow; mean 0: they do not */
    double parameter[8];                               /* of the type */
    void  *own;                                        /* what else the type keeps; its `clear` frees it */
} pg_criterion;
/* 1: there is a criterion, and it judges bonds. */
int pg_criterion_of_bonds (const pg_criterion *c);
/* 1: there is a criterion, and it judges tips. */
int pg_criterion_of_tips (const pg_criterion *c);

/* What a batch of bonds shows, or of points with PG_NEEDS_ENERGY; arrays the criterion did not ask for are
 * NULL. */
typedef struct {
    size_t n;
    int    dim;
    const double *xi;                                  /* reference bond vector, m (n x dim) */
    const double *eta;                                 /* relative displacement, m (n x dim) */
    const double *reach;  /* support of the bond or point over the horizon of the setting; NULL: 1 (n) */
    const double *s1, *s3;  /* largest, smallest principal stress, mean of both ends, Pa (n) */
    /* gamma (1) and kappa (rad) of bonds that bear shear (n): perigal/sums.h */
    const double *shear, *bending;
    const double *energy;  /* stored by a point, J/m^3 (n): at its limit all its bonds break */
} pg_bond_measures;

typedef struct {  /* what the criterion may need to derive its constants */
    pg_mode mode;
    double  horizon;                                   /* m */
    double  modulus, poisson;  /* Pa, 1; NAN: the stiffness depends on the direction */
    double  thickness;                                 /* m; 1D: cross-section, m^2 */
    const char *kernel;
    const char *material;  /* its name in the scene; NULL: limits of `failure` only */
    int     graded;  /* 1: spacings differ, the horizon is that of the nominal one */
    /* energy of a unit of crack over that of theory at the same stretch; 0: not known, 1 */
    double  toughness;
    pg_growth growth;  /* of cracks in such bonds; mean 0: not measured, limits are those of a straight cut */
    const char *stretch;  /* "linear", "finite": as the force measures it; NULL: as failure.stretch says */
    int     state;                                     /* 1: state-based forces; 0: those of bonds alone */
    /* bonds that bear shear: energy of a straight cut (J/m^2) whose bonds all have s = 1, gamma = 1, kappa =
     * 1 */
    double  beam[3];
    /* Limits that are expressions of place: the value that constants derive from (PG_OF_...); NAN: there is
     * none, such a limit is a fault. NULL: all are NAN. */
    const double *reference;
    const char *usual;  /* criterion where the scene has `failure` without one; NULL: it must say */
} pg_criterion_setting;

/* What a new crack takes at a place, in a direction of growth. */
typedef struct {
    double energy;                                     /* opening, J/m^2 of crack */
    double shear;                                      /* sliding, J/m^2; NAN: not given */
    /* largest tension a sound place bears, Pa; NAN: not given */
    double strength;
    /* largest shear stress that it bears without pressure, Pa (NAN: not given), and tangent of its angle of
     * internal friction (Coulomb 1776) */
    double cohesion, slope;
} pg_fracture_limits;

struct pg_criterion_type {
    const char *name, *summary;
    int needs;                                         /* PG_NEEDS_... */
    /* Of the tables of `limits` only the first so many hold limits that must be given; 0: all. */
    int needed;
    /* Its keys: limits (failure.KEY, which a material may have of its own in materials.NAME.failure) and
     * options (of failure alone), each a list of tables that ends with NULL. A limit without a default is
     * needed; of several in one group any one. */
    const pg_key_table *limits[5], *options[4];
    /* Fills c from the limits of the setting's material; what is wrong becomes a fault of the scene. */
    pg_status (*read) (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting);
    /* utilisation (n); kind (n or NULL): 't' tension, 's' shear */
    void (*utilisation) (const pg_criterion *c, const pg_bond_measures *m, double *utilisation, char *kind);
    /* Load factor (> 0; INFINITY: never) at which each bond reaches its limit when the measures are those of
     * load factor 1 and all loads are proportional (events, section 4). */
    void (*factor) (const pg_criterion *c, const pg_bond_measures *m, double *factor);
    /* Limits at a place whose stiffness and limits are so many times those that c was read with, at the same
     * Poisson's ratio. NULL: limits must be numbers, or the criterion knows of place by itself. */
    void (*scale)       (pg_criterion *c, const pg_limit_ratio *ratio);
    /* Where utilisation is that of a form linear in what bonds show: of eta: a . eta if that is positive,
     * else 0, a (n x dim); of principal stresses: the largest of [i][0] s1 + [i][1] s3, or 0. Returns the
     * number of forms (at most 2), 0: it is not so. NULL: never. */
    int  (*linear)   (const pg_criterion *c, const pg_bond_measures *m, double *a);
    int  (*planes)   (const pg_criterion *c, double form[2][2]);
    /* Where utilisation grows with the elongation e = (2 xi . eta + square eta . eta) / xi . xi and depends
     * on nothing else (but reach): the e at which it is u > 0, and *square, 0 or 1. NULL: it is not so. */
    double (*elongation) (const pg_criterion *c, double u, double *square);
    /* Criteria of tips: the limits at x (m) for growth at `angle` from the x axis (rad). */
    void (*fracture) (const pg_criterion *c, const double *x, double angle, pg_fracture_limits *out);
    /* Criteria of tips: 1: the limits depend on place or angle, so that directions have to be compared. */
    int  (*uneven)   (const pg_criterion *c);
    /* Criteria of tips: the path that cracks are held to, m (*n x 2); NULL: none. */
    const double *(*path) (const pg_criterion *c, size_t *n);
    void (*clear)    (pg_criterion *c);                /* frees c->own; NULL: there is nothing in it */
    /* One line for logs and reports: constants given and derived. */
    void (*describe) (const pg_criterion *c, char *text, size_t size);
};
const pg_criterion_type *pg_criterion_find (const char *name);
const char *pg_criterion_names (void);
/* Name of the first criterion of list.h that judges by these measures (PG_NEEDS_...); NULL: there is none. */
const char *pg_criterion_by_need (int needs);
/* The criterion of `failure` in the scene for each of n materials, with the limits of materials.NAME.failure
 * before those of failure. All have one type; it is NULL when nothing breaks. Faults: keys they lack or would
 * ignore. */
pg_status pg_criterion_read (pg_criterion *out, size_t n, const pg_scene *scene,
                             const pg_criterion_setting *setting /* n */);
/* Frees what n criteria keep (not the array). */
void      pg_criterion_clear (pg_criterion *c, size_t n);
/* One line for logs and reports. */
void      pg_criterion_describe (const pg_criterion *c, char *text, size_t size);
/* Critical stretch from fracture energy G0 (J/m^2) and back: theory A1, by quadrature of the kernel
 * moments. */
double pg_stretch_from_energy (const pg_criterion_setting *setting, double G0);
/* Energy (J/m^2) of state-based theory when all bonds across a plane have stretch s0 and no other is
 * stretched: with I (z) = the part of q of a point z from the plane that lies beyond it, G = s0^2
 * int_0^horizon [A d (I/q)^2 + B I/q] dz (pg_state_moduli). With A = 0 that of bonds alone. */
double pg_state_fracture_energy (const pg_criterion_setting *setting, double s0);
/* That integral over horizon, Pa, with A and B (Pa) as given; 0: no such kernel. */
double pg_state_cut_share (pg_mode mode, const char *kernel, double A, double B);
double pg_energy_from_stretch (const pg_criterion_setting *setting, double s0);
PG_API_END
#endif
