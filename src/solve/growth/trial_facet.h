/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: trial facets in the plane. A facet is tried on a copy of the state; what counts is the
 * potential energy that it would release at fixed loads. Files: trial_release.c (that energy, for bonds
 * that are given), trial_facet.c (facets at tips and across the body), initiation.c (new cracks by
 * strength and energy together). */
#ifndef PG_TRIAL_FACET_H
#define PG_TRIAL_FACET_H
#include "solve/run/solve.h"
#include <math.h>

/* Displacements that are in equilibrium under the loads of load factor t each. One: everything is
 * proportional, u (lambda) = lambda d. Two: affine loads, u (lambda) = (1 - lambda) d_0 + lambda d_1. */
typedef struct { int n; const double *d[2]; double t[2]; } trial_fields;

/* A quadratic form of the weights w_a of the fields: sum_ab w_a w_b value (00, 01, 11), 01 counted twice,
 * J. */
typedef struct { double value[3]; } trial_form;
/* A form at u (lambda) of the fields as a polynomial: c[0] + c[1] lambda + c[2] lambda^2, J. */
void trial_polynomial (const trial_fields *f, const trial_form *form, double *c);

/* ---- trial_release.c ----------------------------------------------------------------------------------- */
typedef struct trials {
    pg_system *system;
    pg_state  *state;                                  /* the copy on which facets are tried */
    double    *K;                                      /* values of K before */
    double    *residual[2], *load[2];                  /* of each field before, N (ndof) */
    double    *after, *zero, *whole;                   /* workspaces (ndof) */
    double    *excess[2];                              /* fields without what closed faces bear (ndof) */
    int        said;                                   /* a warning that was given */
    pg_nearest *points;                                /* evaluation points, with several materials */
    int        never_columns;                          /* tests: 1: solve anew every time */
} trials;
pg_status trials_create (trials **out, pg_system *system);             /* the system is borrowed */
void      trials_free (trials **w);
/* The energy that stages of a cut release at fixed loads, J, as forms of the fields (n): stage k cuts the
 * bonds of the stages before it and those of cut[k], which live in `state` and are listed once. The state and
 * the caches of the force are afterwards what they were. */
pg_status trial_release (trials *w, const pg_state *state, const trial_fields *f, size_t n,
                         const pg_changes *cut, trial_form *release);

/* ---- trial_facet.c ------------------------------------------------------------------------------------- */
/* Distance from x along the unit `direction` to the first place without body or behind a crack, at most
 * `limit`, m; *what: PG_MEETS_... */
double    trial_reach (const pg_problem *p, const pg_state *state, const double *x, const double *direction,
                       double limit, int *what);
/* The load factor from which on c[0] + c[1] lambda + c[2] lambda^2 reaches `energy`; 0: always, INFINITY:
 * never. */
double    trial_energy_factor (const double *c, double energy);
/* What is set free has no bound: with this cut a loaded part comes loose. */
static inline int trial_comes_loose (const double *c) { return isinf (c[0]) || isinf (c[2]); }
/* The bonds that each of n sizes of a new crack cuts beyond the one before. start: lets the crack of size
 * number k begin in a state. */
pg_status trial_cuts (trials *w, const pg_state *state, size_t n,
                      pg_status (*start) (const void *context, pg_state *state, size_t k, pg_changes *cut),
                      const void *context, pg_changes *cut);

/* The fields of growth (pg_tip_measure) as those of trials: the second is the displacement at load factor
 * 1. */
pg_status trial_take_fields (trials *w, int nfield, const double *const *d, const double *t,
                             trial_fields *out);
/* A polynomial of the load factor as the form of growth's coefficients: lambda alone, or 1 and lambda. */
void      trial_fill_release (int nfield, const double *c, double out[2][2]);
/* A line [0] + [1] lambda likewise. */
void      trial_fill_stress  (int nfield, const double *c, double out[2]);
/* Does any material or interface give a strength? */
int       trial_has_strength (const pg_problem *p);

/* ---- initiation.c -------------------------------------------------------------------------------------- */
/* What new cracks of several sizes (m) set free over size^power: polynomials of lambda, value and slope over
 * the size; the sizes that they were fitted to. */
typedef struct { double release[3], slope[3], power, shortest, longest; } trial_sizes;
/* A straight line through energies over size^power (J), by least squares; through one: constant. */
void      trial_fit        (trial_sizes *out, size_t n, const double *size, double energy[][3], int power);
/* The polynomial of what a size sets free, J. */
void      trial_release_of (const trial_sizes *c, double size, double out[3]);
/* The load factor from which on v[0] + v[1] lambda reaches 1; INFINITY: none. */
double    trial_stress_factor (const double v[2]);

/* A new crack: where it would begin, and when. */
typedef struct {
    double from[3], to[3];                             /* m */
    int    open;                                       /* pg_crack_start */
    int    slides;                                     /* 1: in shear, its faces touch */
    double length;                                     /* inside the body, m */
    double factor;                                     /* load factor at which it comes into being */
    double energy;                                     /* that it takes, J */
    double release[3];                                 /* that it sets free, a polynomial of lambda, J */
    double stress[2];  /* least stress across it over the strength: [0] + [1] lambda */
} trial_start;
/* Limits at a place for a crack in the direction `angle` (rad, from x); 0: none can grow there. */
typedef int (*trial_limits) (void *context, const double *x, double angle, pg_fracture_limits *out);
enum { TRIAL_MOST_STARTS = 4 };
/* New cracks (room for TRIAL_MOST_STARTS): where strength and energy both suffice at the least load
 * factor, if that is below `below`; ties (symmetric bodies) together. *n: how many, 0: none. *arbitrary:
 * 1: the largest stress is the same at more places than that, and only one of them is given. */
pg_status trial_initiation (trials *w, const pg_state *state, const trial_fields *f, trial_limits limits,
                            void *context, double below, trial_start *out, size_t *n,
                            int *arbitrary);
#endif
