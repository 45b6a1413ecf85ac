/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: trial facets in 2D. A facet is tried on a copy of the state; what counts is the potential energy
 * that it would release at fixed loads. Files: trial_release.c (that energy, for given bonds), trial_facet.c
 * (facets at tips and across the body), initiation.c (new cracks by strength and energy together). */
#ifndef PG_TRIAL_FACET_H
#define PG_TRIAL_FACET_H
#include "solve/run/solve.h"
#include <math.h>

/* Displacements d[a] that are in equilibrium under the loads of load factor t[a]. n = 1: proportional, u
 * (lambda) = lambda d. n = 2: affine loads, u (lambda) = (1 - lambda) d_0 + lambda d_1. */
typedef struct { int n; const double *d[2]; double t[2]; } trial_fields;

/* A quadratic form, J, of weights w_a of the fields: sum_ab w_a w_b value (00, 01, 11), 01 counted twice. */
typedef struct { double value[3]; } trial_form;
/* c = the form at u (lambda) as a polynomial: c[0] + c[1] lambda + c[2] lambda^2, J. */
void trial_polynomial (const trial_fields *f, const trial_form *form, double *c);

/* ---- trial_release.c ----------------------------------------------------------------------------------- */
typedef struct trials {
    pg_system *system;
    pg_state  *state;                                  /* the copy on which facets are tried */
    double    *K;                                      /* values of K before the trial */
    double    *residual[2], *load[2];                  /* of each field before the trial, N (ndof) */
    double    *after, *zero, *whole;                   /* workspaces (ndof) */
    double    *excess[2];  /* fields less the stress that closed faces bear (ndof) */
    int        said;                                   /* 1: a warning was given */
    pg_nearest *points;  /* evaluation points by position, with several materials */
    int        never_columns;                          /* for tests: 1: solve without Green columns */
} trials;
pg_status trials_create (trials **out, pg_system *system);             /* keeps a pointer to system */
void      trials_free (trials **w);
/* Finds the energy that n stages of a cut release at fixed loads, J, as forms of the fields: stage k cuts the
 * bonds of the stages before it and those of cut[k], which are intact in `state` and listed once. State and
 * caches of the force are restored. */
pg_status trial_release (trials *w, const pg_state *state, const trial_fields *f, size_t n,
                         const pg_changes *cut, trial_form *release);

/* ---- trial_facet.c ------------------------------------------------------------------------------------- */
/* Distance from x along the unit `direction` to the first point outside the body or behind a crack, at most
 * `limit`, m; *what: PG_MEETS_... */
double    trial_reach (const pg_problem *p, const pg_state *state, const double *x, const double *direction,
                       double limit, int *what);
/* Smallest load factor from which on c[0] + c[1] lambda + c[2] lambda^2 is at least `energy`; 0: always,
 * INFINITY: never. */
double    trial_energy_factor (const double *c, double energy);
/* 1: the energy release has no bound, as this cut separates a loaded part. */
static inline int trial_comes_loose (const double *c) { return isinf (c[0]) || isinf (c[2]); }
/* Finds the bonds that each of n sizes of a new crack cuts beyond the one before. start: begins the crack of
 * size number k in a state. */
pg_status trial_cuts (trials *w, const pg_state *state, size_t n,
                      pg_status (*start) (const void *context, pg_state *state, size_t k, pg_changes *cut),
                      const void *context, pg_changes *cut);

/* Takes the fields of growth (pg_tip_measure) over as fields of trials, whose second one is the displacement
 * at load factor 1. */
pg_status trial_take_fields (trials *w, int nfield, const double *const *d, const double *t,
                             trial_fields *out);
/* Turns a polynomial of the load factor into the form of growth's coefficients: lambda alone, or 1 and
 * lambda. */
void      trial_fill_release (int nfield, const double *c, double out[2][2]);
/* Turns a line [0] + [1] lambda into these coefficients. */
void      trial_fill_stress  (int nfield, const double *c, double out[2]);
/* Does any material or interface give a strength? */
int       trial_has_strength (const pg_problem *p);

/* ---- initiation.c -------------------------------------------------------------------------------------- */
/* Energy that new cracks of several sizes (m) release, over size^power: polynomials of lambda, value and
 * slope over the size; shortest and longest size of the fit. */
typedef struct { double release[3], slope[3], power, shortest, longest; } trial_sizes;
/* Fits a straight line to energies over size^power (J), by least squares; with one size a constant. */
void      trial_fit        (trial_sizes *out, size_t n, const double *size, double energy[][3], int power);
/* out = polynomial of lambda of the energy that a crack of this size releases, J. */
void      trial_release_of (const trial_sizes *c, double size, double out[3]);
/* Load factor from which on v[0] + v[1] lambda is at least 1; INFINITY: none. */
double    trial_stress_factor (const double v[2]);

/* A new crack: where it would begin, and when. */
typedef struct {
    double from[3], to[3];                             /* ends of the crack, m */
    int    open;                                       /* its open ends, as in pg_crack_start */
    int    slides;                                     /* 1: it slides in shear, its faces touch */
    double length;                                     /* length inside the body, m */
    double factor;                                     /* load factor at which it comes into being */
    double energy;                                     /* energy that it takes, J */
    double release[3];  /* energy that it releases, a polynomial of lambda, J */
    double stress[2];  /* least stress on it over the strength: [0] + [1] lambda */
} trial_start;
/* Fracture limits at x for a crack in the direction `angle` (rad, from x); 0: none can grow there. */
typedef int (*trial_limits) (void *context, const double *x, double angle, pg_fracture_limits *out);
enum { TRIAL_MOST_STARTS = 4 };
/* Finds new cracks (room for TRIAL_MOST_STARTS): where strength and energy both suffice at the smallest load
 * factor, if that is below `below`; ties (symmetric bodies) together. *n: how many, 0: none. *arbitrary 1:
 * the largest stress occurs at more points than that, and only one of them is given. */
pg_status trial_initiation (trials *w, const pg_state *state, const trial_fields *f, trial_limits limits,
                            void *context, double below, trial_start *out, size_t *n,
                            int *arbitrary);
#endif
