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
    /* The criterion applies to tips of cracks, not to bonds: utilisation and factor are NULL; cracks grow by
     * facets (solver.break: facet), and `fracture` gives the energy that a facet consumes. */
    PG_NEEDS_FACETS = 16
};

/* Ratio of the energy consumed by a crack that grows bond by bond to that of a straight cut through bonds
 * which are all at their limit: mean over directions of growth, least and most of single lattices, as
 * measured by bench/single_bonds (doc/method.md A1). mean 0: not measured. */
typedef struct { double mean, least, most; } pg_growth;

/* Quantities that may be expressions of position: Young's modulus (of a material) and limits of failure. */
enum { PG_OF_STIFFNESS, PG_OF_ENERGY, PG_OF_STRETCH, PG_OF_TENSION, PG_OF_COHESION, PG_OF_COUNT };
/* Index PG_OF_... of a limit by the last word of its key; -1: the limit must be a number. */
int pg_limit_of_place (const char *key);
typedef struct { double of[PG_OF_COUNT]; } pg_limit_ratio;     /* value at a point over the reference value */

typedef struct pg_criterion_type pg_criterion_type;
typedef struct {
    const pg_criterion_type *type;
    int    single;  /* beam_limits: any one of the limits breaks a bond, not all together */
    int    never;                                      /* 1: bonds that end in this material never break */
    pg_growth growth;  /* factors in limits derived from an energy (mean 0: none) */
    double parameter[8];                               /* parameters that the type defines */
    void  *own;                                        /* further data of the type; its `clear` frees them */
} pg_criterion;
/* 1: there is a criterion, and it applies to bonds. */
int pg_criterion_of_bonds (const pg_criterion *c);
/* 1: there is a criterion, and it applies to tips. */
int pg_criterion_of_tips (const pg_criterion *c);

/* Measures of n bonds (with PG_NEEDS_ENERGY: of n points) to which a criterion is applied; arrays that the
 * criterion does not need are NULL. */
typedef struct {
    size_t n;
    int    dim;
    const double *xi;                                  /* reference bond vector, m (n x dim) */
    const double *eta;                                 /* relative displacement, m (n x dim) */
    /* support radius of the bond or point over the horizon of the setting; NULL: 1 (n) */
    const double *reach;
    /* principal stresses, largest first, means of both ends, Pa (n) */
    const double *s1, *s2, *s3;
    /* gamma (1) and kappa (rad) of bonds that bear shear (n): perigal/sums.h */
    const double *shear, *bending;
    const double *energy;  /* energy density of a point, J/m^3 (n): at its limit all its bonds break */
} pg_bond_measures;

typedef struct {  /* Data from which a criterion may derive its constants. */
    pg_mode mode;
    double  horizon;                                   /* m */
    double  modulus, poisson;  /* Pa, 1; NAN: the stiffness depends on the direction */
    double  thickness;                                 /* m; 1D: cross-section, m^2 */
    const char *kernel;
    const char *material;  /* name of the material; NULL: limits of `failure` only */
    int     graded;  /* 1: spacings differ, the horizon is that of the nominal one */
    /* energy per crack area of the discrete model over that of theory at the same stretch; 0: not known, 1 is
     * taken */
    double  toughness;
    pg_growth growth;  /* for cracks in such bonds; mean 0: not measured, limits of a straight cut are used */
    /* stretch measure of the force, "linear" or "finite"; NULL: that of failure.stretch */
    const char *stretch;
    int     state;                                     /* 1: state-based forces; 0: bond-based */
    /* micropolar bonds: energies (J/m^2) of a straight cut whose bonds all have s = 1, gamma = 1, kappa =
     * 1 */
    double  beam[3];
    /* Reference values (by PG_OF_...) of limits that are expressions of position, from which constants
     * derive; NAN: such an expression is an error of the scene. NULL: all are NAN. */
    const double *reference;
    const char *usual;  /* default criterion of the section `failure`; NULL: it must name one */
} pg_criterion_setting;

/* Fracture limits of a material at a position, for a direction of growth. */
typedef struct {
    double energy;                                     /* fracture energy of mode I, J/m^2 */
    double shear;                                      /* fracture energy of mode II, J/m^2; NAN: not given */
    /* tensile strength of intact material, Pa; NAN: not given */
    double strength;
    /* cohesion (shear strength without pressure) of intact material, Pa (NAN: not given), and tangent of its
     * angle of internal friction (Coulomb 1776) */
    double cohesion, slope;
} pg_fracture_limits;

struct pg_criterion_type {
    const char *name, *summary;
    int needs;                                         /* PG_NEEDS_... */
    /* Only the first `needed` tables of `limits` contain limits that must be given; 0: all tables do. */
    int needed;
    /* Keys of the criterion: limits (failure.KEY, which materials.NAME.failure may override) and options (of
     * failure alone), each a list of tables that ends with NULL. A limit without a default must be given; of
     * several in one group any one. */
    const pg_key_table *limits[5], *options[4];
    /* Fills c from the limits of the setting's material; errors are reported as errors of the scene. */
    pg_status (*read) (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting);
    /* Computes the utilisation (n) of bonds or points; kind (n or NULL): 't' tension, 's' shear. Of
     * stresses it must be convex: at the mean of two states no larger than at one of them, as bonds are
     * passed over by what their ends would have alone. */
    void (*utilisation) (const pg_criterion *c, const pg_bond_measures *m, double *utilisation, char *kind);
    /* Load factor (> 0; INFINITY: never) at which each bond reaches its limit when the measures are those of
     * load factor 1 and all loads are proportional (events, section 4). */
    void (*factor) (const pg_criterion *c, const pg_bond_measures *m, double *factor);
    /* Changes c to a position where stiffness and limits are `ratio` times those that c was read with, at the
     * same Poisson's ratio. NULL: limits must be numbers, or the criterion evaluates expressions itself. */
    void (*scale)       (pg_criterion *c, const pg_limit_ratio *ratio);
    /* Utilisation as a linear form of the measures. linear: max (a . eta, 0), a (n x dim, 1/m); planes: the
     * largest of form[i][0] s1 + form[i][1] s3 and 0 (form in 1/Pa). Return the number of forms (at most 2),
     * 0: utilisation has no such form. NULL: never. */
    int  (*linear)   (const pg_criterion *c, const pg_bond_measures *m, double *a);
    int  (*planes)   (const pg_criterion *c, double form[2][2]);
    /* If utilisation is an increasing function of the elongation e = (2 xi . eta + square eta . eta) / xi .
     * xi (and of reach) alone: returns the e at which it is u > 0, and *square, 0 or 1. NULL: it is no such
     * function. */
    double (*elongation) (const pg_criterion *c, double u, double *square);
    /* Criteria of tips: the limits at x (m) for growth at `angle` from the x axis (rad). */
    void (*fracture) (const pg_criterion *c, const double *x, double angle, pg_fracture_limits *out);
    /* Criteria of tips: 1: the limits depend on place or angle, so that directions have to be compared. */
    int  (*uneven)   (const pg_criterion *c);
    /* Criteria of tips: polyline that cracks must follow, m (*n x 2); NULL: none. */
    const double *(*path) (const pg_criterion *c, size_t *n);
    void (*clear)    (pg_criterion *c);                /* frees c->own; NULL: nothing to free */
    /* Writes one line for logs and reports: constants given and derived. */
    void (*describe) (const pg_criterion *c, char *text, size_t size);
};
const pg_criterion_type *pg_criterion_find (const char *name);
const char *pg_criterion_names (void);
/* Name of the first criterion of list.h that uses these measures (PG_NEEDS_...); NULL: there is none. */
const char *pg_criterion_by_need (int needs);
/* Reads the criterion of `failure` for each of n materials; limits of materials.NAME.failure override those
 * of failure. All have one type; it is NULL when nothing breaks. Missing keys, and keys that would be
 * ignored, are errors of the scene. */
pg_status pg_criterion_read (pg_criterion *out, size_t n, const pg_scene *scene,
                             const pg_criterion_setting *setting /* n */);
/* Frees the data of n criteria (not the array). */
void      pg_criterion_clear (pg_criterion *c, size_t n);
/* Writes one line for logs and reports. */
void      pg_criterion_describe (const pg_criterion *c, char *text, size_t size);
/* Critical stretch from fracture energy G0 (J/m^2): doc/method.md A1, by quadrature of the kernel moments.
 * Inverse: pg_energy_from_stretch. */
double pg_stretch_from_energy (const pg_criterion_setting *setting, double G0);
/* Energy (J/m^2) of state-based theory when all bonds across a plane have stretch s0 and no other is
 * stretched: with I (z) = the part of q of a point z from the plane that lies beyond it, G = s0^2
 * int_0^horizon [A d (I/q)^2 + B I/q] dz (pg_state_moduli). A = 0: bond-based. */
double pg_state_fracture_energy (const pg_criterion_setting *setting, double s0);
/* The integral of pg_state_fracture_energy divided by the horizon, Pa, for given A and B (Pa); 0: no such
 * kernel. */
double pg_state_cut_share (pg_mode mode, const char *kernel, double A, double B);
double pg_energy_from_stretch (const pg_criterion_setting *setting, double s0);
PG_API_END
#endif
