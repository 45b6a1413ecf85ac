/* SPDX-License-Identifier: GPL-3.0-or-later
 * session.h: what programs in other languages (MATLAB, Python) and small programs of one's own ask of the
 * library, with plain arrays: points, families and shape functions; constants of bonds; forces of bonds on
 * arrays; the linear system of a scene; a scene that is advanced step by step, with its fields, and with
 * its whole state as a block of bytes. Everything here is made of the functions of the headers below, which
 * it calls as the program does, so that the numbers are the same bits.
 *
 * Indices count from 0. Arrays of vectors are row-major: those of a point side by side. */
#ifndef PERIGAL_SESSION_H
#define PERIGAL_SESSION_H
#include "perigal/plan.h"
#include "perigal/results.h"

PG_API_BEGIN

/* ---- points -------------------------------------------------------------------------------------------- */
/* A cloud from arrays: x (n x dim, m), volume (n, m^3, thickness or cross section included; NULL: spacing^dim
 * times thickness each), nominal spacing (m; 0: the mean of the volumes gives it), thickness (2D, m; 1D:
 * cross section, m^2; 3D: 1). The arrays are copied; to be freed with pg_cloud_clear. PG_E_USAGE: dimension,
 * no points, positions that are not finite or twice the same, volumes, spacing or thickness not above 0,
 * neither volumes nor a spacing. PG_E_MEMORY. */
pg_status pg_cloud_of_arrays (pg_cloud *out, int dim, size_t n, const double *x, const double *volume,
                              double spacing, double thickness);

/* ---- shape functions ----------------------------------------------------------------------------------- */
/* An approximation as the section `method` of a scene names it. NULL: the default of scenes. */
typedef struct {
    const char *approximation;  /* of pg_approx_names; NULL: the first */
    const char *kernel;         /* of pg_kernel_names; NULL: the first */
    const char *support;        /* "radial" or "tensor" */
    const char *weights;        /* "auto", "unit" or "volume" */
    const char *degenerate;     /* "shepard" or "projected" */
    int    order;               /* of the basis: 1 or 2 */
    double horizon;             /* radius of the support, m */
} pg_shape_choice;
/* N, dN and w at `nplace` places (nplace x dim, m), or with place NULL at the points themselves, each being
 * its own place (which nosb tells apart: perigal/approx.h). alive: 0 or 1 for each entry of the families
 * that pg_family_build finds for the same centres, reach = horizon, shape, and closed as the kernel is; NULL:
 * all live. Rows are to be cleared with pg_rows_clear. PG_E_USAGE: unknown words, order, horizon;
 * PG_E_MEMORY. */
pg_status pg_shape_functions (pg_rows *out, const pg_shape_choice *choice, const pg_cloud *cloud,
                              size_t nplace, const double *place, const unsigned char *alive, int threads);

/* ---- constants of bonds -------------------------------------------------------------------------------- */
/* A material and how its bonds are weighed. */
typedef struct {
    pg_mode mode;
    const char *kernel;         /* NULL: that of bonds, constant up to the horizon */
    double  horizon;            /* m */
    double  modulus, poisson;   /* Pa; 1 */
    double  thickness;          /* 2D m, 1D cross section m^2, 3D 1 */
    double  fracture_energy;    /* J/m^2; 0: none */
    /* Of a square or cubic lattice, m: constants as a scene uses them there (partial volumes by overlap of
     * cells, calibrated, the fracture energy that of a straight cut). 0: constants of theory. */
    double  spacing;
} pg_bond_choice;
/* Constants and limits, theory A1, B2, B6, G1 and G5. NAN: there is none (no fracture energy; beams where
 * Poisson's ratio is more than they bear). */
typedef struct {
    /* Bonds alone: the only Poisson's ratio; c, N/m^6 (c_h on a lattice); c_h / c; critical stretch; energy
     * of the lattice's straight cut over that of theory at the same stretch. */
    double bond_poisson, micromodulus, calibration, stretch, toughness;
    /* Of a crack that grows bond by bond over a straight cut (pg_sums_growth): scenes with
     * failure.calibration: measured, their default, divide stretches by its root. NAN: not measured. */
    double growth;
    /* State-based: A and B, Pa (pg_state_moduli), and the critical stretch. */
    double dilation, deviation, state_stretch;
    /* Micropolar: largest Poisson's ratio; C_N (N/m^6) and C_t (N/m^4), calibrated on a lattice; bending B =
     * C_t (beam: euler), N/m^4; limits of stretch (1), shear (1) and bending (rad). */
    double beam_poisson, axial, shear, bending, beam_limit[3];
    /* Of the energy density of a point, J/m^3: G0 / (2 horizon) (Jafarzadeh et al. 2022). */
    double energy;
} pg_bond_constants;
/* PG_E_USAGE: unknown kernel, values out of range; PG_E_MEMORY. */
pg_status pg_bond_constants_find (pg_bond_constants *out, const pg_bond_choice *choice);

/* ---- forces of bonds on arrays ------------------------------------------------------------------------- */
/* Bonds between points, each alive or dead, and what sums their forces (perigal/sums.h). */
typedef struct pg_bond_sum pg_bond_sum;
/* Bond forces as pg_sum_rule says them (state and beams: 0) between the points of a cloud, which is copied,
 * all of one modulus c (N/m^6, before the calibration that rule.calibrate asks for). Whoever has a lattice
 * may ask for PG_EVALUATE_FFT. PG_E_USAGE: what pg_sums_create and pg_bond_loop_create refuse. */
pg_status pg_bond_sum_create (pg_bond_sum **out, const pg_cloud *cloud, const pg_sum_rule *rule, double c);
void      pg_bond_sum_free   (pg_bond_sum **sum);
/* f (n x dim, N) of the live bonds at displacement u (n x dim, m), and W (n, J/m^3; NULL: not wanted), the
 * stored energy density of each point. */
pg_status pg_bond_sum_force  (pg_bond_sum *sum, const double *u, double *f, double *W);
/* The bonds: who sees whom (ascending, without the own point), their alive bits (an entry each), their
 * vectors (entries x dim, m), weights k beta g (m) and partial volumes beta: f_i = V_i sum_j c w_ij (xi.eta
 * / r^2) (xi / r) V_j with the calibrated c that *modulus gets. Any of the arrays may be NULL. */
const pg_family *pg_bond_sum_family (const pg_bond_sum *sum, const unsigned char **alive);
void      pg_bond_sum_bonds  (const pg_bond_sum *sum, double *xi, double *weight, double *beta,
                              double *modulus);
int       pg_bond_sum_dim    (const pg_bond_sum *sum);         /* coordinates of a point */
const char *pg_bond_sum_name (const pg_bond_sum *sum);         /* "fft avx2", "list scalar", ... */
/* Sets the alive bit of every entry (0, 1). A bond lives where both its entries do: one that is dead in one
 * direction is made dead in the other. */
pg_status pg_bond_sum_mask   (pg_bond_sum *sum, const unsigned char *alive);

/* ---- the linear system of a scene ---------------------------------------------------------------------- */
/* K d = f at load factor or time t, with d = T q + g:
 *   (T' K T) q = T' (f - K g),   displacement of the points u = N d.
 * These are the equations that static runs solve, without inertia, contact and the small shifts by which the
 * program makes loose points harmless: unknowns that nothing resists are held at 0 here. */
typedef struct {
    size_t    n;              /* unknowns, numbered point by point */
    int       unknowns, dim;  /* of a point: dim, and rotations */
    pg_sparse K;              /* N/m: n x n, symmetric, upper triangle */
    double   *f;              /* loads, with those of supports by Nitsche's method or penalty, N (n) */
    pg_sparse T;              /* n x number of q */
    double   *g;              /* m (n) */
    pg_sparse N;              /* dim points x n: the identity where unknowns are displacements */
    /* 1: every column of T is one unknown: free (ascending, T.ncol of them); the others are held at g. 0: T
     * ties several together (essential: transformation). */
    int       selects;
    size_t   *free;
    size_t    idle;           /* unknowns held because nothing resists them */
} pg_equations;
/* Of the bonds that live in the state; NULL: at the start, pre-cracks cut. PG_E_USAGE: the force has no
 * matrix, as it reaches neighbours of neighbours, or the scene has platens; PG_E_MEMORY. */
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
const double     *pg_session_places  (const pg_session *session);      /* of the points, m (n x dim) */
/* pg_equations_create of its problem and state. PG_E_USAGE: besides, the scene has contact, which decides
 * which faces bear. */
pg_status pg_session_equations (pg_equations *out, const pg_session *session, double t);
int       pg_session_done  (const pg_session *session);
/* One step of the solver, as a row of history.csv. PG_E_USAGE: it is done. A step that fails leaves the last
 * accepted state. *step is borrowed until the next step. */
pg_status pg_session_step  (pg_session *session, const pg_step **step);
/* A field at the points as result.e has it ("displacement", "stress", "damage", ...): *value (n x
 * *components, borrowed until the next field). PG_E_USAGE: unknown, the message names those there are. */
pg_status pg_session_field (pg_session *session, const char *name, int *components, const char **unit,
                            const double **value);
/* Before the first step: "displacement" or "velocity" of the unknowns (n = ndof of the state; m, m/s; of
 * rotations as the force scales them). PG_E_USAGE: later, other words, another n, numbers that are not
 * finite, a solver that finds displacements by itself (static), or without inertia. */
pg_status pg_session_set   (pg_session *session, const char *what, size_t n, const double *value);
/* Cuts bonds between two steps: indices of state->alive, any order; dead ones are passed over. Forces from
 * now on are those of the bonds that are left. Bonds between points are cut in both directions. PG_E_USAGE:
 * no such bond, or a solver that cannot take it any more (pg_solver_cut). */
pg_status pg_session_cut   (pg_session *session, size_t n, const size_t *bond);
/* Everything that later steps depend on as a block (to be freed with pg_free), and back: a session of the
 * same scene that is read back goes on bit by bit. PG_E_USAGE: of another scene, other points or another
 * version; PG_E_FILE: damaged. The session stays as it was then. */
pg_status pg_session_save    (pg_session *session, size_t *bytes, void **block);
pg_status pg_session_restore (pg_session *session, size_t bytes, const void *block);
PG_API_END
#endif
