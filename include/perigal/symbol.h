/* SPDX-License-Identifier: GPL-3.0-or-later
 * symbol.h: the infinite lattice of a scene's first material, and its plane waves. With u_j = U exp (i k.x_j)
 * the force on every point is
 * - S (k) U exp (i k.x_j), S (k) = sum_j K_0j exp (i k.(x_j - x_0)), the symbol: Hermitian, m x m, m the
 *   unknowns of a point (its displacement, then length times its rotation). K_0j is what the force of the
 *   scene answers in a box of the same material, spacing and method, no formula: it holds for every entry of
 *   src/force, approximation and integration. (The largest frequency of a body at hand is
 * pg_solver_fastest.) */
#ifndef PERIGAL_SYMBOL_H
#define PERIGAL_SYMBOL_H
#include "perigal/force.h"

PG_API_BEGIN

enum { PG_UNKNOWNS = 6 };                              /* of a point at most */
typedef struct {
    int     dim, unknowns, threads;                    /* unknowns: m */
    size_t  points;                                    /* of the box it was measured in */
    double  step[3], h;  /* m: of the lattice; root of their product, by which rotations are multiplied */
    pg_material material;  /* as the force has it; density 1 where the scene gives none */
    int     dense;                                     /* 1: the scene gives a density */
    size_t  n;  /* points that the middle one is coupled to, itself among them */
    int    *offset;                                    /* x_j - x_0 in steps (n x 3) */
    double *block;                                     /* K_0j, N/m (n x m x m) */
    /* of shape functions: int N_0 N_j dV / V (n); NULL: displacements are the unknowns themselves */
    double *spread;
    unsigned char held[PG_UNKNOWNS];  /* 1: nothing resists this unknown at any k, so that it is held */
    double  volume;                                    /* of a point, m^3 */
    double  mass[PG_UNKNOWNS];                         /* lumped, kg */
    double  size;                                      /* largest |K_0j|, N/m */
    double  lopsided;  /* largest |K_0j - K_0,-j'| over the largest entry: rounding */
    /* of the largest frequency, as explicit methods take it, rad/s; NAN: they measure it */
    double  bound;  const char *from;
} pg_symbol;
/* problem: built from that scene. PG_E_USAGE where it is no lattice: a mesh, points of a file, points moved
 * at random; PG_E_LIMIT: a horizon of so many spacings that the box would be too large. */
pg_status pg_symbol_create (pg_symbol **out, const pg_scene *scene, const pg_problem *problem);
void      pg_symbol_free   (pg_symbol **symbol);
/* S (k), k in rad/m (dim): its real part and its imaginary part, N/m (m x m each). */
void      pg_symbol_at     (const pg_symbol *symbol, const double *k, double *real, double *imaginary);

typedef struct {
    int    n;                                          /* m less the unknowns that are held */
    double value[PG_UNKNOWNS];                         /* ascending */
    double turning[PG_UNKNOWNS];                       /* share of rotations in the motion, 0 to 1 */
    double along[PG_UNKNOWNS];  /* share of its displacement along k; modes alike: their mean */
} pg_symbol_modes;
/* Mean square of the displacement u (x) = sum N_j d_j whose coefficients d are a wave of size 1: 1 for long
 * waves. */
double    pg_symbol_amplitude (const pg_symbol *symbol, const double *k);
/* Eigenvalues of S h^2 / (E V), no unit; weighted: frequencies of S U = omega^2 M U, rad/s, those of a
 * growing motion (omega^2 < 0) as - |omega|. What is rounding beside K_0j is 0. */
void      pg_symbol_solve  (const pg_symbol *symbol, const double *k, int weighted, pg_symbol_modes *out);
/* Tangent of long waves, Pa (Voigt, nv x nv): uniform strain, rotations in equilibrium. NAN where rotations
 * are not stable. */
void      pg_symbol_tangent (const pg_symbol *symbol, double *D);

/* ---- survey -------------------------------------------------------------------------------------------- */
typedef struct {
    double k[3];                                       /* rad/m */
    double value;                                      /* as told where it is used */
    double turning, along;                             /* as in pg_symbol_modes */
    int    alike;                                      /* modes of that value there */
} pg_motion;
typedef struct {
    int       grid;  /* wave vectors along an axis of the whole zone, 0 and pi / step among them */
    size_t    vectors;                                 /* sampled: half of the zone, as - k is k */
    pg_motion smallest;  /* least eigenvalue of S h^2 / (E V), rigid translation left out */
    /* least eigenvalue over that of the continuum's softest wave of that k: by the mean square of u (x): 1
     * for long ones; motions that are mostly displacement */
    pg_motion softest;
    double    largest;                                 /* eigenvalue */
    /* least eigenvalue of motions that are mostly rotation: at k = 0, anywhere; NAN: there are none */
    double    turning[2];
    double    shortest[2];  /* eigenvalues at the edges and corners of the zone, least and largest */
    /* motions of a periodic box of grid^dim points that gain energy (by more than 1e-10 of the largest
     * eigenvalue), have none beside rigid translation, are softer than 0.01 (the others among them not) */
    size_t    negative, zero, weak;
    pg_motion first;                                   /* of those without energy, with the shortest wave */
    pg_motion fastest;                                 /* largest frequency, rad/s */
    struct {                                           /* waves of 20 h along x; xy; xyz */
        const char *along;                             /* NULL: no more */
        /* speed over that of the continuum; shear: slower, faster; NAN: none */
        double longitudinal, shear[2];
    } wave[3];
    double    tangent[36];  /* pg_symbol_tangent over the continuum's D entry by entry (0: both are zero) */
} pg_survey;
pg_status   pg_symbol_survey (pg_survey *out, const pg_symbol *symbol);
/* "stable: ...", "unstable: ..., try ...": one sentence. */
void pg_survey_verdict (const pg_survey *survey, const pg_symbol *symbol, const pg_problem *problem,
                        char *text, size_t size);
/* "displacement across k", "rotation", ...; where: "checkerboard", "waves of 3 spacings", ... */
const char *pg_motion_kind  (const pg_motion *motion, const pg_symbol *symbol);
void        pg_motion_where (const pg_motion *motion, const pg_symbol *symbol, char *text, size_t size);

/* Wave vectors along the edges of the zone from Gamma (k = 0) to X (pi / step, 0, 0), M (both), in three
 * dimensions R (all), and back to Gamma, `leg` steps each. Vector i: k (rad/m), the length of the path up to
 * it (rad/m) and its name ("" between); returns how many there are. */
size_t pg_symbol_path (const pg_symbol *symbol, size_t leg, size_t i, double *k, double *length,
                       const char **name);
PG_API_END
#endif
