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
/* the only Poisson ratio: 1/3 plane stress, 1/4 plane strain and solid, 0 line */
double pg_bond_poisson (pg_mode mode);
/* c (N/m^6, with kernels of k(0) = 1) from Young's modulus E (Pa); thickness: 2D m, 1D cross-section m^2, 3D
 * 1. */
double pg_bond_modulus (pg_mode mode, const pg_kernel *kernel, double horizon, double E, double thickness);
/* Fracture energy (J/m^2) when every bond across a plane has stretch s0. */
double pg_bond_fracture_energy (pg_mode mode, const pg_kernel *kernel, double horizon, double thickness,
                                double c, double s0);

/* ---- how bonds are weighed (scene: method.*) ----------------------------------------------------------- */
typedef enum { PG_PARTIAL_NONE, PG_PARTIAL_LINEAR, PG_PARTIAL_OVERLAP } pg_partial;
typedef enum { PG_SURFACE_NONE, PG_SURFACE_PRODUCT, PG_SURFACE_VOLUME } pg_surface;
typedef enum { PG_EVALUATE_AUTO, PG_EVALUATE_STENCIL, PG_EVALUATE_LIST, PG_EVALUATE_FFT } pg_evaluation;
typedef struct {
    pg_mode    mode;
    const pg_kernel *kernel;
    double     horizon;                                /* m */
    pg_partial partial;                                /* share beta of a neighbour's volume that counts */
    pg_surface surface;  /* g_ij: 1 | 1 / sqrt (v_i v_j) | 2 / (v_i + v_j), v = family volume / full one */
    int        calibrate;  /* 1: c_h = c S_d m_d / sum k r beta V, hydrostatic energy exact */
    /* 1: state-based (linear peridynamic solid, theory B6), see pg_bond_loop_setting; with beams dilatation
     * alone */
    int        state;
    int        follow;  /* state-based: 1: q counts the bonds that live, 0: those of the start */
    int        beams;                                  /* 1: bonds bear shear and bending (theory G) */
    int        finite;  /* 0: s = e.eta / r; 1: s = (|xi + eta| - r) / r, force along xi + eta */
    pg_evaluation evaluation;                          /* never changes the physics */
    /* sums of forces that will be asked for, about; 0: a few. Many are worth timing plans of transforms */
    double     evaluations;
    int        threads;  /* of the search for neighbours on a lattice, below 2: one; never changes a bit */
} pg_sum_rule;

/* ---- sites: a cloud as part of a lattice --------------------------------------------------------------- */
typedef struct {
    int    dim, count[3];  /* sites per axis (1 beyond dim); count[0] = 0: not a lattice */
    double step[3];                                    /* m */
    int   *site;                                       /* of each point, x fastest (n) */
    int   *point;                                      /* of each site, -1: none */
} pg_sites;
/* Points that all lie on one lattice (to 1e-6 of a step) with equal steps; else count[0] = 0 and PG_OK.
 * lattice NULL or of dim 0: the steps are found from the points (two coordinates at least along each axis, 8
 * sites a point at most). Spacings of their own must be equal. */
pg_status pg_sites_build (pg_sites *out, const pg_cloud *cloud, const pg_lattice *lattice);
void      pg_sites_clear (pg_sites *sites);

/* ---- stencil: the bonds of a point inside a lattice ---------------------------------------------------- */
typedef struct {
    int     dim;
    size_t  n;                                         /* bonds, own point excluded */
    int    *offset;  /* in sites (n x 3), ordered as sites are (z, then y, then x): neighbours ascend */
    double *xi;                                        /* m (n x dim) */
    double *r;                                         /* m (n) */
    double *beta;                                      /* partial volume, 1 inside (n) */
    /* k beta; of a kernel that vanishes at the horizon its mean over the cell's part in the ball times beta
     * (n) */
    double *weight;
    double  cell;                                      /* product of the steps, m^dim */
} pg_stencil;
/* none: r <= horizon (to 1e-9); linear: r < horizon + step / 2 (rectangular cells: root mean square of the
 * steps, weighed by the bond's direction); overlap: cells that the ball meets. Beyond the horizon the
 * kernel's formula goes on; bonds of no weight are left out (a kernel that vanishes at the horizon has none
 * there). Exactly symmetric under offset -> -offset and, for equal steps, permuted axes. PG_E_USAGE: no
 * neighbour, mode, horizon. */
pg_status pg_stencil_build (pg_stencil *out, const pg_sum_rule *rule, int dim, const double *step);
void      pg_stencil_clear (pg_stencil *stencil);
double    pg_stencil_calibration (const pg_stencil *stencil, const pg_sum_rule *rule);          /* c_h / c */
/* Tangent (Voigt, nv x nv, Pa) of the infinite lattice with modulus c (N/m^6) and thickness as above. */
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
    int        ordered;                                /* points are numbered as their sites are */
    pg_stencil stencil;                                /* n = 0: not a lattice */
    /* c_h / c (1 where the rule says no); without a lattice from the median over the points whose family is
     * whole: family volume at least 0.8 of the largest */
    double     calibration;
    /* lattice fracture energy over that asked for, mean of the axes, with c_h and s0 of theory; 1 without a
     * lattice */
    double     toughness;
    double     full;  /* sum of beta V of a whole family, m^3; without a lattice that median */
    double    *share;  /* volume of a point over that of a lattice cell; NULL: all 1 (n) */
    /* v: sum of beta V of the family as built over `full`; NULL: surface none (n) */
    double    *family_volume;
} pg_sums;
/* A cloud that is no lattice: horizon and spacing of a bond are the means of those of its ends
 * (pg_cloud_ratio times the nominal ones), and its weight carries the factor (horizon / mean horizon)^(dim +
 * 1), so that one modulus serves all spacings. PG_E_USAGE: mode and dimension differ, no horizon, overlap
 * without a lattice, points that coincide, no bond at all. */
pg_status pg_sums_create (pg_sums **out, const pg_sum_rule *rule, const pg_cloud *cloud,
                          const pg_lattice *lattice /* NULL: see pg_sites_build */);
void      pg_sums_free   (pg_sums **sums);
/* Energy of a straight crack along the lattice over that of theory at the same stretch, mean of the axes:
 * `toughness`, or with rule.state that of a material (E, Pa; nu). 1 without a lattice. */
double    pg_sums_toughness (const pg_sums *sums, double E, double nu);
/* How much more than such a straight cut a crack consumes that grows bond by bond (growth.c); mean 0: not
 * measured for these bonds. */
pg_growth pg_sums_growth (const pg_sums *sums);
/* Neighbours of every point, ascending, itself excluded; i sees j if and only if j sees i. *parted: how many
 * others lie within the horizon and are parted from their point (pg_between_sift), over all points; NULL: not
 * wanted. */
pg_status pg_sums_family (pg_family *out, const pg_sums *sums, size_t *parted);
/* Of the bonds of point i in `family`: xi (m x dim, m; on a lattice the stencil's own), weight k beta g_ij
 * (m), beta (m); NULL: not wanted. The weight of i -> j and of j -> i are the same bits. */
void pg_sums_bonds (const pg_sums *sums, const pg_family *family, size_t i, double *xi, double *weight,
                    double *beta);

/* ---- micropolar bonds (Chen 2022; theory G) ------------------------------------------------------------ */
/* A bond is a beam: it bears elongation, shear and bending of its ends, which have rotations of their own (2D
 * 1, 3D 3). Energy of a bond, J/m^6:
 *   w = 1/2 k (C_N r s^2 + 12 C_t gamma^2 / r + B kappa^2 / r), s = e . eta / r, gamma = |w_perp| / r, kappa
 *     = |(theta_j - theta_i)_perp|, w = eta - (theta_i + theta_j) / 2 x xi, `perp`: across the bond (in 2D
 *     theta is). */
/* largest Poisson's ratio: 1/3 plane stress, 1/4 plane strain and solid; there C_t = 0 */
double pg_beam_poisson (pg_mode mode);
/* C_N (N/m^6) and C_t (N/m^4) from E (Pa), nu; thickness as above. PG_E_USAGE: a line, nu out of range, a
 * kernel too singular for shear. */
pg_status pg_beam_moduli (double *axial, double *shear, pg_mode mode, const pg_kernel *kernel, double horizon,
                          double E, double nu, double thickness);
/* Any Poisson's ratio (theory G3): bonds of the same shear modulus with a ratio of their own, and a
 * state-based energy of the dilatation for what they lack of the bulk modulus, (kappa - kappa_b) theta^2 / 2
 * per volume: kappa = K (solid), lambda + mu (plane strain), E / 2 (1 - nu) (plane stress). Young's modulus
 * of the bonds, Pa; dilation (Pa) is d (kappa - kappa_b), the A of a state without deviation; 0 with nu =
 * bond_poisson. */
void pg_beam_split (double *bond_modulus, double *dilation, pg_mode mode, double E, double nu,
                    double bond_poisson);
typedef struct {
    double calibration;                                /* C_t,h / C_t; C_N has that of pg_sums */
    /* Energy of a straight cut, J/m^2, all its bonds at s, gamma, kappa: C_N / 2 long s^2 + (6 C_t gamma^2 +
     * B / 2 kappa^2) across; m^5, m^3 (2D, by thickness: the same). Of the lattice, mean of its axes, where
     * the rule is to be calibrated; else of theory. */
    double along, across;
} pg_beam_sums;
pg_status pg_beam_measure (pg_beam_sums *out, const pg_sums *sums);
/* Energy (J/m^2) that dilatation stores when all bonds across a plane have stretch 1 and no other is
 * stretched; lattice or theory as above. */
double    pg_beam_cut_dilatation (const pg_sums *sums, double dilation);
typedef struct {                                       /* what pg_bond_loop_setting needs for beams */
    /* C_t,h and B of each point, N/m^4; between two of them 2 a b / (a + b) */
    const double *shear, *bending;
    double length;  /* m: unknowns of a point are its displacement and length times its rotation */
    /* gamma0, kappa0 of each point, with the setting's limit; INFINITY: none */
    const double *shear_limit, *bending_limit;
    /* a bond breaks 0: at (s+/s0)^2 + (gamma/gamma0)^2 + (kappa/kappa0)^2 = 1, 1: at any one limit */
    int    single;
} pg_beam_law;

typedef struct pg_bond_loop_setting pg_bond_loop_setting;
typedef struct { double shear, along, bending; } pg_beam;  /* of one bond: kt, kn (N/m), kb (N/m) */
/* Force on i, kt w + (kn - kt) e (e . w), moment over length on i, xi x force / (2 length) + kb (q_j -
 * q_i)_perp, q = length theta. xi (m) and weight as pg_sums_bonds gives them. */
pg_beam pg_beam_between (const pg_bond_loop_setting *setting, size_t i, size_t j, const double *xi,
                         double weight);
/* Force and moment on i = - own d_i - other d_j (m x m each, m = 3, 6); own is symmetric. */
void pg_beam_blocks (int dim, const double *xi, const pg_beam *beam, double length, double *own,
                     double *other);
/* gamma and kappa of a bond between points with unknowns di, dj. */
void pg_beam_strain (int dim, const double *xi, double length, const double *di, const double *dj,
                     double *shear, double *bending);

/* ---- the loops ----------------------------------------------------------------------------------------- */
/* bonds that died: indices of alive bits, ascending */
typedef struct { size_t n, cap; size_t *bond; } pg_changes;
struct pg_bond_loop_setting {
    const pg_sums   *sums;
    const pg_family *family;  /* from pg_sums_family; alive bits are counted by its entries */
    const double    *modulus;  /* c_h of each point, N/m^6; between two of them 2 a b / (a + b) */
    const double    *limit;  /* critical stretch of each point, the smaller one rules; NULL: nothing breaks */
    const unsigned char *exempt;  /* per point: bonds with such an end never break; NULL: none */
    /* With rule.state (Silling et al. 2007; theory B6): A and B of each point, Pa (pg_state_moduli);
     * `modulus` is not read then. w = k beta / r, so that A = 0 gives the sums of bonds alone with c = 2 B /
     * q. With beams and rule.state: A of what dilatation bears beside the bonds, B is 0. */
    const double    *dilation, *deviation;
    const unsigned char *counted;  /* bonds of the family that q counts, unless it follows; NULL: all */
    /* NULL: bonds pull along themselves only; else u and f below have dim + rotations unknowns a point,
     * moments in f over the law's length, N; linear rule only */
    const pg_beam_law *beams;
    int              threads;
    int              plain;                            /* 1: no folding: every sum looks at every bond */
    const char      *instructions;  /* "avx512", "avx2", "scalar"; NULL: the best that this machine has */
};
typedef struct pg_bond_loop pg_bond_loop;
/* evaluation auto: by stencil where the rule allows it (a lattice, one modulus, one limit, surface none or
 * product), by transforms where that saves a fifth of the stencil's time by counted work and stored rates
 * (never a clock; linear stretch), else by list. PG_E_USAGE: the rule asks for what cannot be, or the
 * instructions are not there. What the setting points to is borrowed. Plans of transforms are guessed, or
 * with rule.evaluations times points above 2e8 timed and kept in $XDG_CACHE_HOME/perigal or ~/.cache/perigal
 * (where that can be written): the same bits as long as they are kept. */
pg_status   pg_bond_loop_create (pg_bond_loop **out, const pg_bond_loop_setting *setting);
void        pg_bond_loop_free   (pg_bond_loop **loop);
const char *pg_bond_loop_name   (const pg_bond_loop *loop);   /* "stencil avx512", "list scalar", ... */
/* Why that one: "asked for", "auto: about 2.4 ns a point by transforms, 3 by stencil", ...; plans of
 * transforms guessed or timed. */
const char *pg_bond_loop_reason (const pg_bond_loop *loop);
typedef struct {  /* of a loop by transforms ("fft avx2") since it was made; all 0 of others */
    long   sums;                                       /* forces */
    long   forward, back;                              /* real transforms of the padded box */
    /* blocks of 32 sites, summed over forces; looked at bond by bond; with cut bonds */
    size_t blocks, bonds, cut;
    size_t looks, folded;  /* of a stencil: looks at the bonds of whole blocks, forces of such (folded) */
    double saved;  /* about, s: what folding has spared, by stored rates */
    size_t gone;                                       /* points all whose bonds are dead, now */
} pg_bond_loop_counts;
void        pg_bond_loop_counted (const pg_bond_loop *loop, pg_bond_loop_counts *out);
/* of memory that a force loop reads and writes */
void        pg_bond_loop_bytes  (const pg_bond_loop *loop, double *per_bond, double *per_point);
/* Brings the loop's own bits in line with alive (entries of the family): all (changes NULL), or those that
 * died. */
void        pg_bond_loop_update (pg_bond_loop *loop, const unsigned char *alive, const pg_changes *changes);
/* f (n x dim, N) = force of the live bonds on every point at displacement u (n x dim, m): V_i L_i. Unless
 * `broken` is NULL, bonds at or over their limit are dead before they are summed and stay so; they are
 * appended ascending, both directions. The same bits for any number of threads. */
pg_status   pg_bond_loop_force  (pg_bond_loop *loop, const double *u, double *f, pg_changes *broken);
/* Stored energy of the live bonds, J. */
double      pg_bond_loop_energy (pg_bond_loop *loop, const double *u);
/* 1: that energy is -1/2 f . u of the forces f at u, to the rounding of its own sum (linear stretch, bonds
 * one by one; transforms round by the size of u and not by that of its differences: 0). */
int         pg_bond_loop_halves (const pg_bond_loop *loop);
/* W (n, J/m^3) = energy density of every point at displacement u: half the energy of each of its live bonds
 * over its volume, W_i = 1/4 sum_j c k beta g r s^2 V_j (theory B2); sum of W_i V_i = pg_bond_loop_energy to
 * rounding. 0 where a point has no live bond. The same bits for any number of threads. */
pg_status   pg_bond_loop_energies (pg_bond_loop *loop, const double *u, double *W);
/* State-based sums: dilatation of every point, theta_i = d / q_i sum_j w xi.eta V_j (1), and its q_i (m^2
 * times m^3 over the unit of w), both n or NULL (theta NULL: u is not read); 0 where no bond counts.
 * PG_E_USAGE: bonds alone have none. */
pg_status   pg_bond_loop_dilatation (pg_bond_loop *loop, const double *u, double *theta, double *q);
PG_API_END
#endif
