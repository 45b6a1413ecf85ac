/* SPDX-License-Identifier: GPL-3.0-or-later
 * session.h: interface with plain arrays for other languages (MATLAB, Python) and small programs: points,
 * families and shape functions; constants of bonds; forces of bonds on arrays; the linear system of a scene;
 * a scene that is advanced step by step, with its fields, and with its whole state as a block of bytes.
 * Everything here is made of the functions of the headers below, which it calls as the program does, so that
 * the numbers are the same bits.
 *
 * Indices count from 0. Arrays of vectors are row-major: the components of a point are adjacent. */
#ifndef PERIGAL_SESSION_H
#define PERIGAL_SESSION_H
#include "perigal/plan.h"
#include "perigal/results.h"

PG_API_BEGIN

/* ---- points -------------------------------------------------------------------------------------------- */
/* Makes a cloud from arrays: x (n x dim, m), volume (n, m^3, thickness or cross section included; NULL:
 * spacing^dim times thickness each), nominal spacing (m; 0: the mean of the volumes gives it), thickness (2D,
 * m; 1D: cross section, m^2; 3D: 1). The arrays are copied; to be freed with pg_cloud_clear. PG_E_USAGE:
 * dimension, no points, positions that are not finite or twice the same, volumes, spacing or thickness not
 * above 0, neither volumes nor a spacing. PG_E_MEMORY. */
pg_status pg_cloud_of_arrays (pg_cloud *out, int dim, size_t n, const double *x, const double *volume,
                              double spacing, double thickness);

/* ---- shape functions ----------------------------------------------------------------------------------- */
/* An approximation as the section `method` of a scene names it. NULL: the default of scenes. */
typedef struct {
    const char *approximation;  /* one of pg_approx_names; NULL: the first */
    const char *kernel;         /* one of pg_kernel_names; NULL: the first */
    const char *support;        /* "radial" or "tensor" */
    const char *weights;        /* "auto", "unit" or "volume" */
    const char *degenerate;     /* "shepard" or "projected" */
    int    order;               /* order of the basis: 1 or 2 */
    double horizon;             /* radius of the support, m */
} pg_shape_choice;
/* Computes N, dN and w at `nplace` positions (nplace x dim, m), or with place NULL at the points themselves
 * (nosb treats these differently: perigal/approx.h). alive: 0 or 1 for each entry of the families that
 * pg_family_build finds for the same centres, reach = horizon, shape, and closed as the kernel is; NULL: all
 * intact. Rows are to be cleared with pg_rows_clear. PG_E_USAGE: unknown words, order, horizon;
 * PG_E_MEMORY. */
pg_status pg_shape_functions (pg_rows *out, const pg_shape_choice *choice, const pg_cloud *cloud,
                              size_t nplace, const double *place, const unsigned char *alive, int threads);

/* ---- constants of bonds -------------------------------------------------------------------------------- */
/* A material and the discretisation of its bonds. */
typedef struct {
    pg_mode mode;
    const char *kernel;         /* NULL: constant up to the horizon */
    double  horizon;            /* m */
    double  modulus, poisson;   /* Pa; 1 */
    double  thickness;          /* 2D m, 1D cross section m^2, 3D 1 */
    double  fracture_energy;    /* J/m^2; 0: none */
    /* Spacing of a square or cubic lattice, m: constants are those of scenes on it (partial volumes by
     * overlap of cells, calibrated, fracture energy of a straight cut). 0: constants of continuum theory. */
    double  spacing;
} pg_bond_choice;
/* Constants and limits of bonds (doc/method.md A1, B2, B6, G1 and G5). NAN: not defined (no fracture energy;
 * Poisson's ratio too large for micropolar bonds). */
typedef struct {
    /* Bond-based: the fixed Poisson's ratio; c, N/m^6 (c_h on a lattice); c_h / c; critical stretch; energy
     * of a straight cut of the lattice over that of theory at the same stretch. */
    double bond_poisson, micromodulus, calibration, stretch, toughness;
    /* Energy of a crack that grows bond by bond over that of a straight cut (pg_sums_growth); with
     * failure.calibration: measured (the default) critical stretches are divided by its root. NAN: not
     * measured. */
    double growth;
    /* State-based: A and B, Pa (pg_state_moduli), and the critical stretch. */
    double dilation, deviation, state_stretch;
    /* Micropolar: largest Poisson's ratio; C_N (N/m^6) and C_t (N/m^4), calibrated on a lattice; bending B =
     * C_t (beam: euler), N/m^4; limits of stretch (1), shear (1) and bending (rad). */
    double beam_poisson, axial, shear, bending, beam_limit[3];
    /* Limit of the energy density of a point, J/m^3: G0 / (2 horizon) (Jafarzadeh et al. 2022). */
    double energy;
} pg_bond_constants;
/* Computes the constants. PG_E_USAGE: unknown kernel, values out of range; PG_E_MEMORY. */
pg_status pg_bond_constants_find (pg_bond_constants *out, const pg_bond_choice *choice);

/* ---- forces of bonds on arrays ------------------------------------------------------------------------- */
/* Bonds between points, each intact or broken, and the loop that sums their forces (perigal/sums.h). */
typedef struct pg_bond_sum pg_bond_sum;
/* Creates bond-based forces by the rule (with state and beams 0) between the points of a cloud, which is
 * copied, with one modulus c (N/m^6, before the calibration by rule.calibrate). PG_EVALUATE_FFT is possible
 * on a lattice. PG_E_USAGE: as of pg_sums_create and pg_bond_loop_create. */
pg_status pg_bond_sum_create (pg_bond_sum **out, const pg_cloud *cloud, const pg_sum_rule *rule, double c);
void      pg_bond_sum_free   (pg_bond_sum **sum);
/* Computes the forces f (n x dim, N) of the intact bonds at displacement u (n x dim, m), and W (n, J/m^3;
 * NULL: not wanted), the energy density of each point. */
pg_status pg_bond_sum_force  (pg_bond_sum *sum, const double *u, double *f, double *W);
/* The bonds: neighbours of each point (ascending, without itself), alive bits (one per entry); vectors
 * (entries x dim, m), weights k beta g (m) and partial volumes beta: f_i = V_i sum_j c w_ij (xi.eta / r^2)
 * (xi / r) V_j; *modulus: the calibrated c. Any of the arrays may be NULL. */
const pg_family *pg_bond_sum_family (const pg_bond_sum *sum, const unsigned char **alive);
void      pg_bond_sum_bonds  (const pg_bond_sum *sum, double *xi, double *weight, double *beta,
                              double *modulus);
int       pg_bond_sum_dim    (const pg_bond_sum *sum);         /* dimension */
const char *pg_bond_sum_name (const pg_bond_sum *sum);         /* "fft avx2", "list scalar", ... */
/* Sets the alive bit of every entry (0, 1). A bond whose entry is 0 in one direction is broken in both. */
pg_status pg_bond_sum_mask   (pg_bond_sum *sum, const unsigned char *alive);

/* ---- the linear system of a scene ---------------------------------------------------------------------- */
/* The linear system K d = f at load factor or time t, with d = T q + g:
 *   (T' K T) q = T' (f - K g),   displacement of the points u = N d.
 * These are the equations that static runs solve, without inertia, contact and the small diagonal terms by
 * which the program fixes loose points: unknowns without stiffness are set to 0 here. */
typedef struct {
    size_t    n;              /* unknowns, numbered point by point */
    int       unknowns, dim;  /* unknowns per point (dim plus rotations); dim */
    pg_sparse K;              /* N/m: n x n, symmetric, upper triangle */
    double   *f;              /* loads, with the terms of supports by Nitsche's method or penalty, N (n) */
    pg_sparse T;              /* n x number of q */
    double   *g;              /* m (n) */
    pg_sparse N;              /* (dim x points) x n: the identity where unknowns are displacements */
    /* 1: every column of T selects one unknown, listed in `free` (ascending, T.ncol); the others are
     * prescribed by g. 0: T couples several unknowns (essential: transformation). */
    int       selects;
    size_t   *free;
    size_t    idle;           /* number of unknowns fixed because they have no stiffness */
} pg_equations;
/* Assembles the system with the intact bonds of the state; NULL: of the initial state, with pre-cracks.
 * PG_E_USAGE: the force has no matrix, as it reaches neighbours of neighbours, or the scene has platens;
 * PG_E_MEMORY. */
pg_status pg_equations_create (pg_equations *out, const pg_problem *problem, const pg_state *state, double t);
void      pg_equations_clear  (pg_equations *e);

/* ---- a scene, step by step ----------------------------------------------------------------------------- */
typedef struct pg_session pg_session;
/* Reads and checks a scene with overrides "key=value", builds the problem, refuses what `perigal run` refuses
 * (a discretisation that fails the patch test, too little memory), and makes solver and state. threads: 0: as
 * many as processors. Nothing is written. PG_E_SCENE: all faults in pg_last_error. */
pg_status pg_session_open  (pg_session **out, const char *scene, size_t nset, const char *const *set,
                            int threads);
void      pg_session_close (pg_session **session);
/* Borrowed, until the next call that changes the session. */
const pg_problem *pg_session_problem (const pg_session *session);
const pg_state   *pg_session_state   (const pg_session *session);
pg_solver        *pg_session_solver  (const pg_session *session);
const double     *pg_session_places  (const pg_session *session);  /* positions of the points, m (n x dim) */
/* pg_equations_create for problem and state of the session. PG_E_USAGE: also for a scene with contact, whose
 * equations depend on the contact status. */
pg_status pg_session_equations (pg_equations *out, const pg_session *session, double t);
int       pg_session_done  (const pg_session *session);
/* Makes one step of the solver, as one row of history.csv. PG_E_USAGE: the run is finished. A step that fails
 * leaves the last accepted state. *step is borrowed until the next step. */
pg_status pg_session_step  (pg_session *session, const pg_step **step);
/* Computes a field at the points as in result.e ("displacement", "stress", "damage", ...): *value (n x
 * *components, borrowed until the next field). PG_E_USAGE: unknown name; the message lists the known ones. */
pg_status pg_session_field (pg_session *session, const char *name, int *components, const char **unit,
                            const double **value);
/* Sets, before the first step, "displacement" or "velocity" of the unknowns (n = ndof of the state; m, m/s;
 * of rotations as the force scales them). PG_E_USAGE: later, other words, another n, numbers that are not
 * finite, a solver that finds displacements by itself (static), or without inertia. */
pg_status pg_session_set   (pg_session *session, const char *what, size_t n, const double *value);
/* Cuts bonds between two steps: indices of state->alive, any order; broken ones are ignored. Later forces are
 * those of the remaining bonds. Bonds between points are cut in both directions. PG_E_USAGE: no such bond, or
 * a solver that cannot take it any more (pg_solver_cut). */
pg_status pg_session_cut   (pg_session *session, size_t n, const size_t *bond);
/* Saves everything on which later steps depend in a block of memory (pg_free), and restores it: a session of
 * the same scene then continues bit by bit. PG_E_USAGE: of another scene, other points or another version;
 * PG_E_FILE: damaged. The session stays as it was then. */
pg_status pg_session_save    (pg_session *session, size_t *bytes, void **block);
pg_status pg_session_restore (pg_session *session, size_t bytes, const void *block);
PG_API_END
#endif
