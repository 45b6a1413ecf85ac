/* SPDX-License-Identifier: GPL-3.0-or-later
 * symbol.h: plane waves of the infinite lattice of the points in the interior of a body. With displacements
 * u_j = U exp (i k.x_j) the force on every point is - S (k) U exp (i k.x_j), where
 *
 *   S (k) = sum_j K_0j exp (i k.(x_j - x_0))
 *
 * is the symbol of the stiffness: a Hermitian m x m matrix, m being the number of unknowns of a point (its
 * displacement, then for points with rotations the spacing h times the rotation). Its eigenvalues say which
 * motions meet a resistance, and S U = omega^2 M U gives the dispersion of waves (doc/method.md, D4).
 *
 * K_0j is not taken from a formula. It is what the force model of the scene answers in a box with the scene's
 * first material, spacing and method, when its middle point moves; so the analysis holds for every force,
 * approximation and integration in the library. The largest frequency of a real body with its boundary is
 * found by pg_solver_fastest instead. */
#ifndef PERIGAL_SYMBOL_H
#define PERIGAL_SYMBOL_H
#include "perigal/force.h"

PG_API_BEGIN

/* Largest number of unknowns of a point: three displacements and three rotations. */
enum { PG_UNKNOWNS = 6 };
/* The measured blocks of an infinite lattice. */
typedef struct {
    /* Dimension; m, the unknowns of a point; threads to use. */
    int     dim, unknowns, threads;
    /* Points of the box in which the blocks were measured. */
    size_t  points;
    /* Steps of the lattice, and h, the dim-th root of their product, by which rotations are
     * multiplied, m. */
    double  step[3], h;
    /* The material as the force has it; its density is 1 where the scene gives none. */
    pg_material material;
    /* 1 if the scene gives a density, so that frequencies have a meaning. */
    int     dense;
    /* Number of points that the middle one is coupled to, itself among them. */
    size_t  n;
    /* Their offsets x_j - x_0 in steps (n x 3). */
    int    *offset;
    /* K_0j, N/m (n x m x m). */
    double *block;
    /* int N_0 N_j dV / V of shape functions (n); NULL where displacements are the unknowns
     * themselves. */
    double *spread;
    /* 1 if nothing resists this unknown at any k (for example rotations without bending); such
     * unknowns are left out of the eigenvalue problems. */
    unsigned char held[PG_UNKNOWNS];
    /* Volume of a point, m3. */
    double  volume;
    /* Lumped mass of each unknown, kg. */
    double  mass[PG_UNKNOWNS];
    /* Largest entry of the blocks, N/m. */
    double  size;
    /* Largest |K_0j - K_0,-j'| over the largest entry; only rounding, else pg_symbol_create
     * fails. */
    double  lopsided;
    /* Upper bound of the largest frequency that explicit solvers take for their time step,
     * rad/s, and where it comes from, in words; NAN if they measure the frequency itself. */
    double  bound;  const char *from;
} pg_symbol;
/* Measures the lattice of a scene, of which `problem` was built. PG_E_USAGE: there is no
 * lattice (points of a mesh or of a file, points moved at random), the material is not
 * isotropic, or nothing resists the points. PG_E_LIMIT: the horizon has so many spacings that
 * the box would be too large. */
pg_status pg_symbol_create (pg_symbol **out, const pg_scene *scene, const pg_problem *problem);
void      pg_symbol_free   (pg_symbol **symbol);
/* S (k) for k in rad/m (dim): real and imaginary part, N/m (m x m each). */
void      pg_symbol_at     (const pg_symbol *symbol, const double *k, double *real, double *imaginary);

/* The modes of one wave vector. */
typedef struct {
    /* Number of modes: m less the fixed unknowns. */
    int    n;
    /* Eigenvalues or frequencies, ascending. */
    double value[PG_UNKNOWNS];
    /* Fraction of the motion due to rotations, 0 to 1. */
    double turning[PG_UNKNOWNS];
    /* Share of the displacement that is along k (longitudinal), 0 to 1. Modes of equal value
     * have their mean. */
    double along[PG_UNKNOWNS];
} pg_symbol_modes;
/* Mean square of the displacement u (x) = sum N_j d_j if the coefficients d are a wave of unit
 * size: 1 for long waves, and 1 always where displacements are the unknowns. */
double    pg_symbol_amplitude (const pg_symbol *symbol, const double *k);
/* Without `weighted`: eigenvalues of S h^2 / (E V), which have no unit. With it: frequencies
 * of S U = omega^2 M U, rad/s, where a growing motion (omega^2 < 0) is given as - |omega|.
 * Values that are only rounding of the blocks are 0. */
void      pg_symbol_solve  (const pg_symbol *symbol, const double *k, int weighted, pg_symbol_modes *out);
/* Computes the tangent stiffness for long waves, Pa (Voigt, nv x nv): uniform strain, with the rotations in
 * equilibrium. NAN where rotations are not stable. */
void      pg_symbol_tangent (const pg_symbol *symbol, double *D);

/* ---- survey -------------------------------------------------------------------------------------------- */
/* A wave motion reported by the survey. */
typedef struct {
    /* Wave vector, rad/m. */
    double k[3];
    /* The value (eigenvalue, ratio or frequency: see pg_survey). */
    double value;
    /* Shares of rotations, and of displacement along k, in the motion (pg_symbol_modes), 0 to 1. */
    double turning, along;
    /* Number of modes with this value at this k. */
    int    alike;
} pg_motion;
/* Results of a sampling of all wave vectors. "Eigenvalue" is that of S h^2 / (E V). */
typedef struct {
    /* Wave vectors along an axis of the whole Brillouin zone, 0 and pi / step among them. */
    int       grid;
    /* Number of sampled wave vectors: half of the zone, as k and - k are one. */
    size_t    vectors;
    /* The least eigenvalue, rigid translation left out. */
    pg_motion smallest;
    /* The least ratio of an eigenvalue to that of the continuum's softest wave with the same k
     * and the same mean square of u (x), among motions that are mostly displacement: 1 for
     * long waves. */
    pg_motion softest;
    /* The largest eigenvalue in size. */
    double    largest;
    /* Least eigenvalue of motions that are mostly rotation: at k = 0, and anywhere; NAN if
     * there are none. */
    double    turning[2];
    /* Least and largest eigenvalue at the edges and corners of the zone, where waves are
     * shortest. */
    double    shortest[2];
    /* Motions of a periodic box of grid^dim points that gain energy (by more than 1e-10 of the
     * largest eigenvalue); that have none, rigid translation not counted; that are softer than
     * 0.01 of a continuum's wave. */
    size_t    negative, zero, weak;
    /* The shortest wave among the motions without energy. */
    pg_motion first;
    /* The largest frequency, rad/s. */
    pg_motion fastest;
    /* Waves of 20 spacings along x, xy and xyz. */
    struct {
        /* Direction in words; NULL: no more of them. */
        const char *along;
        /* Speeds over those of the continuum: longitudinal wave; slower and faster shear wave,
         * NAN if there is none. */
        double longitudinal, shear[2];
    } wave[3];
    /* pg_symbol_tangent over the continuum's D, entry by entry; where that is zero, over
     * Young's modulus. */
    double    tangent[36];
} pg_survey;
/* Solves all wave vectors of the zone (with threads; the result does not depend on their
 * number) and sums up. */
pg_status   pg_symbol_survey (pg_survey *out, const pg_symbol *symbol);
/* One sentence for users: "stable: ..." or "unstable: ..., try ...". */
void pg_survey_verdict (const pg_survey *survey, const pg_symbol *symbol, const pg_problem *problem,
                        char *text, size_t size);
/* The kind of a motion in words: "transverse displacement", "rotation" and the like. */
const char *pg_motion_kind  (const pg_motion *motion, const pg_symbol *symbol);
/* Where in the zone it lies, in words: "checkerboard", "waves of 3 spacings" and the like. */
void        pg_motion_where (const pg_motion *motion, const pg_symbol *symbol, char *text, size_t size);

/* Wave vectors along the edges of the Brillouin zone, for dispersion curves: from Gamma (k =
 * 0) to X (pi / step, 0, 0), in 2D and 3D on to M (x and y), in 3D on to R (all three), and
 * back to Gamma, with `leg` steps each. Vector i has k (rad/m), the length of the path up to
 * it (rad/m) and its name ("" between the corners). Returns the number of vectors. */
size_t pg_symbol_path (const pg_symbol *symbol, size_t leg, size_t i, double *k, double *length,
                       const char **name);
PG_API_END
#endif
