/* SPDX-License-Identifier: GPL-3.0-or-later
 * sums.h: direct sums over the bonds between points: constants of bond-based theory, partial volumes,
 * calibration on a lattice, surface factors, and the loops that sum forces. Sources: Silling 2000; Silling
 * and Askari 2005; Shen 2016; theory sections A1 to A4. Convention: pair force density f = c k(r) s e
 * (N/m^6), C(xi) = (c k / r) e x e; k = kernel value, 1 at r = 0 for `constant`. */
#ifndef PERIGAL_SUMS_H
#define PERIGAL_SUMS_H
#include "perigal/cloud.h"
#include "perigal/kernel.h"
#include "perigal/material.h"
#include "perigal/criterion.h"

PG_API_BEGIN

/* ---- constants (theory A1) ----------------------------------------------------------------------------- */
/* The fixed Poisson's ratio of bond-based theory: 1/3 plane stress, 1/4 plane strain and 3D, 0 in 1D. */
double pg_bond_poisson (pg_mode mode);
/* Micromodulus c (N/m^6, for kernels with k(0) = 1) from Young's modulus E (Pa); thickness: 2D m, 1D
 * cross-section m^2, 3D 1. */
double pg_bond_modulus (pg_mode mode, const pg_kernel *kernel, double horizon, double E, double thickness);
/* Fracture energy (J/m^2) when every bond across a plane has stretch s0. */
double pg_bond_fracture_energy (pg_mode mode, const pg_kernel *kernel, double horizon, double thickness,
                                double c, double s0);

/* ---- weights of bonds (scene: method.*) ---------------------------------------------------------------- */
typedef enum { PG_PARTIAL_NONE, PG_PARTIAL_LINEAR, PG_PARTIAL_OVERLAP } pg_partial;
typedef enum { PG_SURFACE_NONE, PG_SURFACE_PRODUCT, PG_SURFACE_VOLUME } pg_surface;
typedef enum { PG_EVALUATE_AUTO, PG_EVALUATE_STENCIL, PG_EVALUATE_LIST, PG_EVALUATE_FFT } pg_evaluation;
typedef struct {
    pg_mode    mode;
    const pg_kernel *kernel;
    double     horizon;                                /* m */
    pg_partial partial;  /* rule for the fraction beta of a neighbour's volume within the horizon */
    pg_surface surface;  /* g_ij: 1 | 1 / sqrt (v_i v_j) | 2 / (v_i + v_j), v = family volume / full one */
    int        calibrate;  /* 1: c_h = c S_d m_d / sum k r beta V, hydrostatic energy exact */
    /* 1: state-based (linear peridynamic solid, theory B6), see pg_bond_loop_setting; with beams: only the
     * dilatation */
    int        state;
    int        follow;  /* state-based: 1: q is summed over intact bonds, 0: over initial bonds */
    int        beams;  /* 1: micropolar bonds, with shear and bending (theory G) */
    int        finite;  /* 0: s = e.eta / r; 1: s = (|xi + eta| - r) / r, force along xi + eta */
    pg_evaluation evaluation;                          /* loop to use; does not change the result */
    /* expected number of force sums (0: a few); for many, FFT plans are timed */
    double     evaluations;
    int        threads;  /* threads of the search for neighbours on a lattice; no influence on results */
} pg_sum_rule;

/* ---- sites: a cloud as part of a lattice --------------------------------------------------------------- */
typedef struct {
    int    dim, count[3];  /* sites per axis (1 beyond dim); count[0] = 0: not a lattice */
    double step[3];                                    /* m */
    int   *site;                                       /* site of each point, x index fastest (n) */
    int   *point;                                      /* point on each site, -1: none */
} pg_sites;
/* Assigns the points to sites if they all lie on one lattice (to 1e-6 of a step); else count[0] = 0 and
 * PG_OK. lattice NULL or of dim 0: the steps are found from the points (at least two coordinates per axis, at
 * most 8 sites per point). Local spacings must be equal. */
pg_status pg_sites_build (pg_sites *out, const pg_cloud *cloud, const pg_lattice *lattice);
void      pg_sites_clear (pg_sites *sites);

/* ---- stencil: the bonds of a point inside a lattice ---------------------------------------------------- */
typedef struct {
    int     dim;
    size_t  n;                                         /* number of bonds */
    /* offsets in sites (n x 3), in the order of sites (z, then y, then x), so that neighbours ascend */
    int    *offset;
    double *xi;                                        /* bond vectors, m (n x dim) */
    double *r;                                         /* lengths, m (n) */
    double *beta;                                      /* partial volume, 1 inside (n) */
    /* k beta; for a kernel that vanishes at the horizon k is its mean over the part of the cell in the ball
     * (n) */
    double *weight;
    double  cell;                                      /* product of the steps, m^dim */
} pg_stencil;
/* Builds the stencil. Bonds by rule->partial: none: r <= horizon (to 1e-9); linear: r < horizon + step / 2
 * (rectangular cells: root mean square of the steps, weighed by the bond's direction); overlap: cells that
 * the ball meets. Beyond the horizon the kernel's formula is continued; bonds of zero weight are left out.
 * Exactly symmetric under offset -> -offset and, for equal steps, permuted axes. PG_E_USAGE: no neighbour,
 * mode, horizon. */
pg_status pg_stencil_build (pg_stencil *out, const pg_sum_rule *rule, int dim, const double *step);
void      pg_stencil_clear (pg_stencil *stencil);
double    pg_stencil_calibration (const pg_stencil *stencil, const pg_sum_rule *rule);          /* c_h / c */
/* Tangent (Voigt, nv x nv, Pa) of the infinite lattice with modulus c (N/m^6); thickness as of
 * pg_bond_modulus. */
void      pg_stencil_tangent (const pg_stencil *stencil, double c, double thickness, double *D);
/* Energy per area (J/m^2) of all bonds across a lattice plane normal to `axis`, half way between points, each
 * at stretch s0. */
double pg_stencil_fracture_energy (const pg_stencil *stencil, double c, double thickness, double s0,
                                   int axis);

/* ---- sums: rule and cloud together --------------------------------------------------------------------- */
typedef struct {
    pg_sum_rule rule;
    const pg_cloud *cloud;                             /* borrowed */
    pg_sites   sites;
    int        ordered;  /* 1: points are numbered in the order of their sites */
    pg_stencil stencil;                                /* n = 0: not a lattice */
    /* c_h / c (1 if not calibrated); without a lattice from the median over points with a full family (volume
     * at least 0.8 of the largest) */
    double     calibration;
    /* lattice fracture energy over the prescribed one, mean of the axes, with c_h and s0 of theory; 1 without
     * a lattice */
    double     toughness;
    double     full;  /* sum of beta V of a full family, m^3; without a lattice the median */
    double    *share;  /* volume of a point over that of a lattice cell; NULL: all 1 (n) */
    /* v: sum of beta V of the family as built over `full`; NULL: surface none (n) */
    double    *family_volume;
} pg_sums;
/* Creates the sums of a rule for a cloud. Without a lattice horizon and spacing of a bond are the means of
 * those of its ends (pg_cloud_ratio times the nominal ones), and its weight carries the factor (horizon /
 * mean horizon)^(dim + 1), so that one modulus serves all spacings. PG_E_USAGE: mode and dimension differ, no
 * horizon, overlap without a lattice, points that coincide, no bond at all. */
pg_status pg_sums_create (pg_sums **out, const pg_sum_rule *rule, const pg_cloud *cloud,
                          const pg_lattice *lattice /* NULL: see pg_sites_build */);
void      pg_sums_free   (pg_sums **sums);
/* Energy of a straight crack along the lattice over that of theory at the same stretch, mean of the axes:
 * `toughness`, or with rule.state that of a material (E, Pa; nu). 1 without a lattice. */
double    pg_sums_toughness (const pg_sums *sums, double E, double nu);
/* Ratio of the energy of a crack that grows bond by bond to that of a straight cut (growth.c); mean 0: not
 * measured for these bonds. */
pg_growth pg_sums_growth (const pg_sums *sums);
/* Finds the neighbours of every point, ascending, without itself; symmetric. *parted: number of neighbours
 * excluded because a gap or slot lies between (pg_between_sift), over all points; NULL: not wanted. */
pg_status pg_sums_family (pg_family *out, const pg_sums *sums, size_t *parted);
/* Computes for the m bonds of point i in `family`: xi (m x dim, in metres; on a lattice that of the stencil),
 * weight k beta g_ij (m values), beta (m values); NULL: not wanted. The weight of i -> j and of j -> i are
 * the same bits. */
void pg_sums_bonds (const pg_sums *sums, const pg_family *family, size_t i, double *xi, double *weight,
                    double *beta);

/* ---- micropolar bonds (Chen 2022; theory G) ------------------------------------------------------------ */
/* A micropolar bond is a beam with stiffness against elongation, shear and bending; points have rotations (2D
 * 1, 3D 3). Energy of a bond, J/m^6:
 *   w = 1/2 k (C_N r s^2 + 12 C_t gamma^2 / r + B kappa^2 / r), s = e . eta / r, gamma = |w_perp| / r, kappa
 *     = |(theta_j - theta_i)_perp|, w = eta - (theta_i + theta_j) / 2 x xi, `perp`: across the bond (in 2D
 *     theta is). */
/* Largest Poisson's ratio (where C_t = 0): 1/3 plane stress, 1/4 plane strain and 3D. */
double pg_beam_poisson (pg_mode mode);
/* C_N (N/m^6) and C_t (N/m^4) from E (Pa), nu; thickness as of pg_bond_modulus. PG_E_USAGE: 1D, nu out of
 * range, a kernel too singular for shear. */
pg_status pg_beam_moduli (double *axial, double *shear, pg_mode mode, const pg_kernel *kernel, double horizon,
                          double E, double nu, double thickness);
/* Splits a material of any Poisson's ratio (theory G3) into bonds of the same shear modulus with their own
 * ratio, and a state-based energy of the dilatation for the rest of the bulk modulus, (kappa - kappa_b)
 * theta^2 / 2 per volume: kappa = K (solid), lambda + mu (plane strain), E / 2 (1 - nu) (plane stress).
 * *bond_modulus: Young's modulus of the bonds, Pa; *dilation: d (kappa - kappa_b), Pa, the A of a state-based
 * force with B = 0; 0 if nu = bond_poisson. */
void pg_beam_split (double *bond_modulus, double *dilation, pg_mode mode, double E, double nu,
                    double bond_poisson);
typedef struct {
    double calibration;                                /* C_t,h / C_t (of C_N: pg_sums.calibration) */
    /* Energy of a straight cut, J/m^2, with all its bonds at s, gamma, kappa: C_N / 2 along s^2 + (6 C_t
     * gamma^2 + B / 2 kappa^2) across; along in m^5, across in m^3. From the lattice, mean of its axes, if
     * the rule is calibrated; else from theory. */
    double along, across;
} pg_beam_sums;
pg_status pg_beam_measure (pg_beam_sums *out, const pg_sums *sums);
/* Energy (J/m^2) of the dilatation when all bonds across a plane have stretch 1 and no others are stretched;
 * lattice or theory as in pg_beam_sums. */
double    pg_beam_cut_dilatation (const pg_sums *sums, double dilation);
typedef struct {                                       /* micropolar part of pg_bond_loop_setting */
    /* C_t,h and B of each point, N/m^4; for a bond between two points the harmonic mean */
    const double *shear, *bending;
    double length;  /* m: unknowns of a point are its displacement and length times its rotation */
    /* limits gamma0, kappa0 (rad) of each point, besides s0 = setting->limit; INFINITY: none */
    const double *shear_limit, *bending_limit;
    /* breaking rule: 0: at (s+/s0)^2 + (gamma/gamma0)^2 + (kappa/kappa0)^2 = 1, 1: at any one of the
     * limits */
    int    single;
} pg_beam_law;

typedef struct pg_bond_loop_setting pg_bond_loop_setting;
typedef struct { double shear, along, bending; } pg_beam;  /* stiffnesses kt, kn, kb of one bond, N/m */
/* Stiffnesses of the bond i - j. Force on i: kt w + (kn - kt) e (e . w), moment over length on i, xi x force
 * / (2 length) + kb (q_j - q_i)_perp, q = length theta. xi (m) and weight as pg_sums_bonds gives them. */
pg_beam pg_beam_between (const pg_bond_loop_setting *setting, size_t i, size_t j, const double *xi,
                         double weight);
/* Stiffness blocks of a bond: force and moment on i = - own d_i - other d_j (m x m each, m = 3 or 6, N/m);
 * own is symmetric. */
void pg_beam_blocks (int dim, const double *xi, const pg_beam *beam, double length, double *own,
                     double *other);
/* gamma and kappa of a bond between points with unknowns di, dj. */
void pg_beam_strain (int dim, const double *xi, double length, const double *di, const double *dj,
                     double *shear, double *bending);

/* ---- the loops ----------------------------------------------------------------------------------------- */
/* List of newly broken bonds: indices of alive bits, ascending. */
typedef struct { size_t n, cap; size_t *bond; } pg_changes;
struct pg_bond_loop_setting {
    const pg_sums   *sums;
    const pg_family *family;  /* from pg_sums_family; alive bits are counted by its entries */
    const double    *modulus;  /* c_h of each point, N/m^6; for a bond the harmonic mean of both */
    /* critical stretch of each point, for a bond the smaller one; NULL: nothing breaks */
    const double    *limit;
    const unsigned char *exempt;  /* 1: bonds of this point never break (per point); NULL: none */
    /* With rule.state (Silling et al. 2007; theory B6): A and B of each point, Pa (pg_state_moduli);
     * `modulus` is not read then. w = k beta / r, so that A = 0 gives the sums of bonds alone with c = 2 B /
     * q. With beams and rule.state: A of the dilatational energy besides the bonds, B = 0. */
    const double    *dilation, *deviation;
    /* 1: the bond counts in q (unless rule.follow), per entry of family; NULL: all */
    const unsigned char *counted;
    /* NULL: central forces only; else u and f of the loops have dim + rotations unknowns per point, moments
     * in f divided by the law's length, N; linear rule only */
    const pg_beam_law *beams;
    int              threads;
    int              plain;  /* 1: no shortcuts: every sum visits every bond separately */
    const char      *instructions;  /* "avx512", "avx2", "scalar"; NULL: the best of this machine */
};
typedef struct pg_bond_loop pg_bond_loop;
/* Creates a loop. Evaluation auto: by stencil where the rule allows it (a lattice, one modulus, one limit,
 * surface none or product), by transforms where that saves a fifth of the stencil's time by counted work and
 * stored rates (never a clock; linear stretch), else by list. PG_E_USAGE: impossible rule, or instruction set
 * not available. Data of the setting are borrowed. FFT plans are estimated, or with rule.evaluations times
 * points above 2e8 timed and kept in $XDG_CACHE_HOME/perigal or ~/.cache/perigal (where that can be written):
 * the same bits as long as they are kept. */
pg_status   pg_bond_loop_create (pg_bond_loop **out, const pg_bond_loop_setting *setting);
void        pg_bond_loop_free   (pg_bond_loop **loop);
const char *pg_bond_loop_name   (const pg_bond_loop *loop);   /* "stencil avx512", "list scalar", ... */
/* Reason for the choice of the loop: "asked for", "auto: about 2.4 ns a point by transforms, 3 by stencil",
 * ...; plans of transforms guessed or timed. */
const char *pg_bond_loop_reason (const pg_bond_loop *loop);
typedef struct {  /* counts of a loop by transforms ("fft avx2") since its creation; 0 for other loops */
    long   sums;                                       /* number of force sums */
    long   forward, back;                              /* real transforms of the padded box */
    /* blocks of 32 sites, summed over force sums: all; evaluated bond by bond; with broken bonds */
    size_t blocks, bonds, cut;
    size_t looks, folded;  /* stencil: tests of whole blocks; blocks summed without testing bonds */
    double saved;  /* estimated seconds saved by shortcuts */
    size_t gone;                                       /* number of points without intact bonds now */
} pg_bond_loop_counts;
void        pg_bond_loop_counted (const pg_bond_loop *loop, pg_bond_loop_counts *out);
/* Bytes of memory that a force loop reads and writes. */
void        pg_bond_loop_bytes  (const pg_bond_loop *loop, double *per_bond, double *per_point);
/* Updates the loop's copy of the alive bits (entries of the family): all (changes NULL), or those of newly
 * broken bonds. */
void        pg_bond_loop_update (pg_bond_loop *loop, const unsigned char *alive, const pg_changes *changes);
/* f (n x dim, N) = force V_i L_i of the intact bonds on every point at displacement u (n x dim, m). Unless
 * `broken` is NULL, bonds at or over their limit are broken before they are summed, permanently; they are
 * appended ascending, both directions. Results do not depend on the number of threads. */
pg_status   pg_bond_loop_force  (pg_bond_loop *loop, const double *u, double *f, pg_changes *broken);
/* Stored energy of the intact bonds at displacement u, J. */
double      pg_bond_loop_energy (pg_bond_loop *loop, const double *u);
/* 1: the stored energy equals -1/2 f . u to rounding (linear stretch, bonds summed one by one; 0 for
 * transforms, whose rounding error is relative to u instead of its differences). */
int         pg_bond_loop_halves (const pg_bond_loop *loop);
/* W (n, J/m^3) = energy density of every point at displacement u: half the energy of each of its intact bonds
 * over its volume, W_i = 1/4 sum_j c k beta g r s^2 V_j (theory B2); sum of W_i V_i = pg_bond_loop_energy to
 * rounding. 0 where a point has no intact bond. Results do not depend on the number of threads. */
pg_status   pg_bond_loop_energies (pg_bond_loop *loop, const double *u, double *W);
/* Computes for state-based sums the dilatation of every point, theta_i = d / q_i sum_j w xi.eta V_j (1), and
 * its q_i (m^5 times the unit of w), both n or NULL (theta NULL: u is not read); 0 where no bond
 * counts. PG_E_USAGE: bond-based sums. */
pg_status   pg_bond_loop_dilatation (pg_bond_loop *loop, const double *u, double *theta, double *q);
PG_API_END
#endif
