/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the Galerkin force. Files: galerkin.c (create, refresh, balance), galerkin_bulk.c (stress,
 * blocks, energy), galerkin_gradients.c (rows of K), galerkin_nitsche.c (Nitsche, penalty, loads),
 * galerkin_place.c (effective positions of points for these), galerkin_basis.c (elimination), galerkin_sum.c
 * (forces of all points), galerkin_measure.c (strains of all points), galerkin_runs.c (points with equal
 * shape functions), galerkin_silling.c (stabilisation), galerkin_operator.c (K x, K), galerkin_bonds.c
 * (utilisation, overlap, census), galerkin_worst.c (the bonds with the largest utilisation),
 * galerkin_stretch.c (the same by elongation), galerkin_groups.c (bonds outside of a group),
 * galerkin_sight.c (which points have which nodes in their families), galerkin_dilatation.c,
 * galerkin_dilatation_facet.c (near Poisson's ratio 1/2), galerkin_consistent.c (rows with corrected
 * derivatives), galerkin_ended.c, galerkin_ended_plan.c (cells that end at cracks), galerkin_change.c
 * (change of K by breaking), galerkin_field.c (fields), galerkin_elements.c, galerkin_elements_list.c
 * (preconditioner), galerkin_hats.c (preconditioner on a coarse grid), galerkin_rows.c (shape functions),
 * galerkin_sample.c (fields at arbitrary positions), galerkin_sample_alike.c (positions with equal
 * surroundings), galerkin_sample_again.c (positions sampled repeatedly), galerkin_estimate.c (error of the
 * stress). */
#ifndef PG_GALERKIN_H
#define PG_GALERKIN_H
#include "perigal/force.h"
#include "perigal/linalg.h"

typedef struct {                                       /* a prescribed component at a facet point */
    size_t point;
    int    load, component;
} constraint;

typedef struct {  /* elimination of one component k at prescribed nodes: C_s d_s = g - C_m d_m */
    int     component;
    size_t  n, nmaster;
    int    *slave, *load;  /* prescribed nodes (slaves), ascending, and the load of each */
    int    *master;  /* nodes coupled to the slaves, not slaves, ascending */
    double *inverse;                                   /* C_s^-1 (n x n); NULL: identity */
    double *X;                                         /* C_s^-1 C_m (n x nmaster) */
} elimination;

typedef struct galerkin_slices galerkin_slices;         /* in galerkin_slices.h */
typedef struct galerkin_sight galerkin_sight;           /* defined in galerkin_sight.c */
typedef struct galerkin_dilatation galerkin_dilatation; /* in galerkin_dilatation.h */
typedef struct galerkin_change galerkin_change;         /* defined in galerkin_change.c */
typedef struct galerkin_ended galerkin_ended;           /* defined in galerkin_ended.h */
typedef struct galerkin_store galerkin_store;           /* defined in galerkin_rows.c */

/* Options of the method in the scene (pg_problem.options). */
typedef struct {
    double silling;                                    /* factor Gs of Silling's stabilisation; 0: none */
    double nitsche, penalty;                           /* factors of E / h, h the local spacing */
} galerkin_options;
/* Values of the last measure of a displacement field, for each bond set and point: strain and stress (Pa), nv
 * numbers; zz: stress across the plane, Pa; u: displacement, m; s1, s2, s3: principal stresses, Pa. */
typedef struct {
    double  *strain[PG_BOND_SETS], *stress[PG_BOND_SETS], *zz[PG_BOND_SETS], *u[PG_BOND_SETS];
    double  *s1[PG_BOND_SETS], *s2[PG_BOND_SETS], *s3[PG_BOND_SETS];
    double  *seen[PG_BOND_SETS];                       /* the displacement field measured (ndof) */
    /* fresh: 1: the values belong to `seen` and to the present shape functions, except in blocks of points
     * that are disturbed (1) */
    int      fresh[PG_BOND_SETS];
    unsigned char *disturbed[PG_BOND_SETS];
    galerkin_sight *sight[PG_BOND_SETS];               /* NULL until needed */
    const double *at_d;                                /* shared with threads */
} galerkin_measured;

/* Bounds of the utilisation of bonds that are known for a point as a whole. */
typedef struct {
    /* galerkin_worst.c: an upper bound of the utilisation by the stress of each point alone, NULL until
     * needed; exact: 1: s1 and s3 of a point are exact, not bounds; bounded: 1: those of a block of points
     * belong to the stress of the last measure */
    double  *alone[PG_BOND_SETS];
    unsigned char *exact[PG_BOND_SETS], *bounded[PG_BOND_SETS];
    /* galerkin_stretch.c: the largest elongation in each block of points; position and displacement of every
     * node, 8 numbers (m); NULL until needed */
    double  *longest[PG_BOND_SETS], *place_now;
    /* 1 for each bond that a criterion judges while it is intact; NULL until needed */
    unsigned char *judged[PG_BOND_SETS];
} galerkin_bounds;

/* galerkin_eigenstrain.c */
typedef struct {
    /* free strain of every point at `time` (s; quasi-static: load factor; NULL: the scene has none); norm of
     * the forces that would hold the body against it, N */
    double  *strain[PG_BOND_SETS], time, force;
    /* per load and set: free strain of every point at factor 1, if the load is a pattern times a factor of t,
     * else NULL */
    double **pattern;
} galerkin_eigenstrain;

/* Stiffness matrix K and mass matrix M. */
typedef struct {
    pg_assembly *K;                                   /* stiffness matrix; NULL until needed */
    int      took;                                   /* 1: the bulk's part was taken from pg_problem.intact */
    pg_assembly *M;                                   /* consistent mass matrix, NULL until needed */
    int      all_stale;  /* rows of K to be reassembled: all, or the marked ones */
    unsigned char *stale;
    pg_operator   op;
    double  *wide;                                     /* scratch: one row of blocks of K */
    double  *diagonal;  /* diagonal of K, valid while diagonal_of equals revision */
    unsigned long diagonal_of;
    unsigned long revision;                            /* counts changes of K and T */
} galerkin_stiffness;

/* Prescribed displacements. */
typedef struct {
    constraint *nitsche;  size_t nnitsche;      /* constraints by Nitsche's terms, ascending by facet point */
    size_t  *nitsche_start;                                /* first constraint of each facet point */
    /* Constraints by penalty and springs; their `point` is an index into penalty_node. */
    constraint *penalty;  size_t npenalty;
    /* constraints of a node: penalty_start[k]..penalty_start[k + 1] */
    int     *penalty_node; size_t npenalty_node; size_t *penalty_start;
    pg_family penalty_family;  /* constrained nodes -> nodes (copy of the node rows' families) */
    elimination side[3];
    pg_sparse T;
    int      has_T;
} galerkin_supports;

/* Searches for positions among points and nodes; each NULL until a position is sampled. */
typedef struct {
    pg_nearest *near_point, *near_node;                /* searches for the nearest bulk point, node */
    pg_family_search *search;                          /* nodes in the support of a position */
    struct galerkin_alike *alike;                      /* positions of a lattice with equal surroundings */
    struct galerkin_again *again;                      /* positions that were sampled before */
} galerkin_places;

typedef struct {
    const pg_problem *problem;
    const galerkin_options *options;                   /* borrowed from pg_problem.options */
    int      dim, nv, threads, bulk;                   /* bulk: set of the evaluation points */
    size_t   n;                                        /* number of nodes */
    pg_rows  rows[PG_BOND_SETS];                    /* shape functions: geometry of the problem, own values */
    /* rows of the evaluation points for stiffness and force: those of the bulk, or with consistent
     * integration wider ones with corrected derivatives */
    pg_rows  sums;
    /* 1: the shape functions of nodes and points, and of `sums`, are borrowed from pg_problem.intact */
    int      borrows;
    galerkin_store *store[PG_BOND_SETS];               /* NULL: every point has a row of its own */
    unsigned char *whole;  /* 1: cells whose derivatives are corrected; NULL: integration is not consistent */
    galerkin_ended *ended;                             /* cells at cracks; NULL: none can end there */
    const int *material[PG_BOND_SETS];                 /* of each point; borrowed */
    galerkin_measured    measured;
    galerkin_bounds      bounds;
    galerkin_eigenstrain eigen;
    galerkin_stiffness   stiffness;
    galerkin_supports    supports;
    galerkin_places      places;
    galerkin_slices *slices;
    /* galerkin_silling.c: sums of each point, positions (m); NULL: no stabilisation */
    double  *kept, *place;
    galerkin_dilatation *dilatation;                   /* NULL: dilatation is not projected */
    galerkin_change *change;                           /* NULL until galerkin_change_of is called */
    double  *work;                                     /* scratch (ndof) */
    int     *ends;  /* number of bonds that end at each node (n), for damage; NULL until needed */
    size_t  *list[PG_BOND_SETS];                       /* points that lost bonds (scratch of refresh) */
} galerkin;

/* scene: entries of pg_method (galerkin_scene.c) */
extern const pg_key_table galerkin_keys;
pg_status galerkin_read (pg_problem *problem, const pg_scene *scene);
void      galerkin_support (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
double    galerkin_support_stiffness (const pg_problem *problem);
pg_status galerkin_limits (const pg_problem *problem, size_t material, pg_criterion_setting *setting);
double    galerkin_ghost_cells (const pg_scene *scene, double *beyond);
void      galerkin_words (const pg_problem *problem, char *text, size_t size);

/* rows: shape functions of a set, borrowed from the problem or empty at first; galerkin_rows_free frees all,
 * before anything else of the force is freed. */
pg_status galerkin_rows_create (galerkin *g, int set);
void      galerkin_rows_free   (galerkin *g);
int       galerkin_borrows     (const galerkin *g, int set);       /* 1: they are borrowed from the problem */
/* 1: a bond is broken, so that borrowed rows are invalid, are returned, and all rows must be evaluated. */
int       galerkin_give_back   (galerkin *g, const pg_state *state);
/* The bulk's part of K, which the caller has to free; NULL: it is not available, or bonds are broken. */
pg_assembly *galerkin_take_stiffness (const galerkin *g);
/* Evaluates rows of a set that are not borrowed: all (list NULL), or `count` of them. */
pg_status galerkin_evaluate (galerkin *g, const pg_state *state, int set, size_t count, const size_t *list);
/* Number of bonds of all sets whose points share rows with other points. */
size_t    galerkin_shared_bonds (const galerkin *g);
/* sum: slices for the loops over evaluation points (galerkin_sum.c) */
pg_status galerkin_slices_create (galerkin *g);
void galerkin_slices_free (galerkin *g);
/* Tells the slices that the rows of these points have changed (list NULL: of all). */
void galerkin_slices_stale (galerkin *g, size_t count, const size_t *list);
/* sight: marks, by blocks of GALERKIN_BLOCK points, those with a node in their families where x and other
 * differ (NULL: where x is not zero). Returns NULL if most do, or there is no table (galerkin_sight_ready
 * makes those of sets that have been measured, and with `products` that of the bulk). Valid until the next
 * call for this set. */
enum { GALERKIN_BLOCK = 16 };
unsigned char *galerkin_active (galerkin *g, int set, const double *x, const double *other);
pg_status galerkin_sight_ready (galerkin *g, int products);
void galerkin_sight_free (galerkin *g);
/* Measures u, strain, stress, zz of every point of a set at displacement d, unless known. */
void galerkin_measure (galerkin *g, int set, const double *d);
/* Measures listed points of a set anew at its last displacement, after their rows have changed. */
void galerkin_measure_list (galerkin *g, int set, size_t count, const size_t *list);
void galerkin_measure_some (galerkin *g, int set, const double *d, size_t count, const size_t *list,
                            size_t nnode, const int *node);
/* f += sum w B' sigma by the stresses of the last measure, which was at d, N. */
void galerkin_sum_stress  (galerkin *g, const double *d, double *f);
void galerkin_sum_tangent (galerkin *g, const double *x, double *f);   /* f += sum w B' D B x */
/* f += sum w B' D B x over the listed points of the bulk only, ascending. */
void galerkin_sum_list (galerkin *g, size_t count, const size_t *list, const double *x, double *f);
/* pg_force_type.spared: what shortcuts have saved */
int  galerkin_spared (const void *self, size_t k, char *what, char *why, double *seconds);
/* eigenstrain (galerkin_eigenstrain.c): _at sets the time t for all that follows; _stress: stress of a point
 * by its strain; _relieve: subtracts that of the free strain at a position; _energy: excess of half stress
 * times total strain, J/m^3; _pairs, _work: pairs of work at the points of the bulk */
pg_status galerkin_eigen_create (galerkin *g);
void galerkin_eigen_free (galerkin *g);
void galerkin_eigen_at (galerkin *g, double t);
void galerkin_eigen_stress (const galerkin *g, int set, size_t p, const double *e);
void galerkin_eigen_relieve (const galerkin *g, double t, const double *x, size_t q, double *stress);
/* eta -= free elongation of the bonds xi (relative displacements, m). */
void galerkin_eigen_bonds (const galerkin *g, int set, size_t count, const size_t *bond, const size_t *point,
                           const double *xi, double *eta);
double galerkin_eigen_energy (const galerkin *g, size_t p);
size_t galerkin_eigen_pairs (const galerkin *g);
void galerkin_eigen_work (const galerkin *g, double t, pg_work_balance *out, size_t at);
/* silling: stabilisation of nodal integration, together with the stress */
pg_status galerkin_silling_create (galerkin *g);
void galerkin_silling_free (galerkin *g);
/* Updates the stored sums of these points, whose rows have changed (list NULL: of the first `count`). */
void galerkin_silling_update (galerkin *g, size_t count, const size_t *list);
double galerkin_silling_modulus (const galerkin *g, size_t p);         /* Gs mu of point p, Pa */
/* f += forces of the points first .. last - 1, N, by their stresses (NULL: those of x); x, f: 4 numbers a
 * node, f from node `low` on. */
void galerkin_silling_sum (const galerkin *g, size_t first, size_t last, const double *stress,
                           const double *x, double *f, size_t low);
double galerkin_silling_energy (const galerkin *g, size_t p, const double *d);
/* runs: groups of points with the same shape functions, summed together in products K x */
/* Lanes of a vector: arrays of nodal values by components are longer by this many numbers. */
enum { GALERKIN_LANES = 8 };
/* A bond of the first group of a run: its position in a row of nodes with consecutive numbers, its node, its
 * point within the group, and its number in the family. */
typedef struct { int place, node, point; size_t bond; } galerkin_entry;
/* A run: `count` groups of `points` points, the first one from point `point` on; its bonds in the order of
 * summation. same: 1: all groups have the same N and dN, bit by bit. */
typedef struct { size_t point, points, count, entry, entries; int same; } galerkin_run;
/* Runs among the points first .. last - 1, ascending; stale: 1: they must be searched anew. bonds: number of
 * bonds of all their points. */
typedef struct {
    size_t first, last, n, cap, nentry, cap_entry, bonds;
    int    stale;
    galerkin_run   *run;
    galerkin_entry *entry;
} galerkin_run_list;
void galerkin_runs_find  (const galerkin *g, galerkin_run_list *list);
void galerkin_runs_clear (galerkin_run_list *list);
/* f += sum w B' D B x over a run; x, f: an array for each component, f from node `low` on; active: blocks of
 * points where x is not zero (NULL: all). */
void galerkin_run_sum (const galerkin *g, const galerkin_run_list *list, const galerkin_run *run,
                       const double *const x[3], double *const f[3], size_t low,
                       const unsigned char *active);
/* u and strain of the points of a run whose rows are equal bit by bit (same), in active blocks (NULL:
 * all). */
void galerkin_run_strain (const galerkin *g, const galerkin_run *run, const double *const x[3],
                          const unsigned char *active, double *u, double *strain);
/* A bundle: eight groups of a run, the first of which is number `lane`; `left` of them exist; x, f: nodal
 * values and forces, one array a component, f from node `low` on. */
typedef struct {
    const galerkin *g;
    const galerkin_run *run;
    const galerkin_entry *entry;
    const double *const *x;
    double *const *f;
    size_t low, lane, left;
} galerkin_bundle;
/* f += stress and stabilisation forces of the nodal values x of a bundle, whose groups are single points. */
void galerkin_silling_bundle (const galerkin_bundle *bundle);
/* operator: K x without K, and K */
pg_status galerkin_operator_create (galerkin *g);
void galerkin_apply (void *context, const double *x, double *y);
void galerkin_diagonal (void *context, double *d);
pg_status galerkin_matrix (void *self, pg_matrix_want want, const pg_sparse **K);
pg_status galerkin_consistent_mass (galerkin *g, const pg_sparse **M);
/* Marks the rows of K that the touched points of each set (g->list) contribute to. */
void galerkin_mark_stale (galerkin *g, const size_t *count);
/* change: from `begin` to the end of a refresh every item of K that the refresh changes is subtracted (sign
 * -1) and added again (1); nothing happens until galerkin_change_of has been called once. */
void galerkin_change_free (galerkin *g);
void galerkin_change_begin (galerkin *g, int all);
pg_status galerkin_change_points (galerkin *g, int set, size_t count, const size_t *list, double sign);
pg_status galerkin_change_cells (galerkin *g, size_t count, const size_t *cell, double sign);
pg_status galerkin_change_patch (galerkin *g, size_t patch, int supported, double sign);
void galerkin_change_basis (galerkin *g);
pg_status galerkin_change_of (void *self, pg_stiffness_change *out);
/* consistent: rows with corrected derivatives (galerkin_consistent.c) */
pg_status galerkin_consistent_create (galerkin *g);
void galerkin_consistent_free (galerkin *g);
/* Updates `sums` to the rows of the bulk: all, or cells with the touched points of g->list[bulk], which is
 * replaced by all points of the cells that changed. */
pg_status galerkin_consistent_update (galerkin *g, const pg_state *state, int all, size_t *count);
/* place: effective position of a point of a set for loads and supports, m (at: room for 3 numbers), and the
 * value prescribed there by a constraint on facets or nodes, m. */
const double *galerkin_place (const galerkin *g, int set, size_t point, double *at);
double galerkin_prescribed (const galerkin *g, const constraint *q, int set, double t);
/* ended: consistent integration in cells that end at cracks (galerkin_ended.c) */
pg_status galerkin_ended_create (galerkin *g);
void galerkin_ended_free (galerkin *g);
/* Decides how each cell near the cracks of the state is treated, and evaluates the values on their borders.
 * *moved: 1: the cracks have changed since the last call. */
pg_status galerkin_ended_plan (galerkin *g, const pg_state *state, int *moved);
size_t galerkin_unended (const galerkin *g);           /* number of cells for pg_census.unended */
size_t galerkin_ended_near (const galerkin *g, size_t *cell); /* cells near cracks (NULL: their number) */
const pg_rows *galerkin_ended_faces (const galerkin *g);  /* N and grades at the faces of all cells */
void galerkin_ended_mark (galerkin *g);                       /* sets g->whole of cells near cracks */
/* Sets the weights of the listed cells' points, and the derivatives of cells treated in parts, after
 * pg_consistency_apply. */
pg_status galerkin_ended_apply (galerkin *g, size_t count, const size_t *list);
/* Replaces shape functions at positions x by those with which cells integrate, where a position is on their
 * border. */
pg_status galerkin_ended_jump (const galerkin *g, size_t n, const double *x, const double *normal,
                               pg_jump_rows *rows);
/* dilatation: called only if g->dilatation exists, except galerkin_plain, _gaps, _traction, _adjoint */
pg_status galerkin_dilatation_create (galerkin *g);
void galerkin_dilatation_free (galerkin *g);
/* Updates, after the rows of all sets, all patches, or those with touched points of g->list (bulk, facets);
 * marks their rows of K as stale. */
pg_status galerkin_dilatation_update (galerkin *g, const pg_state *state, int all, const size_t *count);
/* The material of a point without lambda where the projected dilatation carries it. */
const pg_material *galerkin_plain (const galerkin *g, int set, size_t p);
/* Adds the pressure of the patches to stresses computed with galerkin_plain. */
void galerkin_dilatation_measure (galerkin *g, int set, const double *d);
void galerkin_dilatation_apply (galerkin *g, const double *x, double *y);   /* y += K x of the patches */
void galerkin_dilatation_diagonal (galerkin *g, double *d);
void galerkin_dilatation_blocks (void *context, size_t patch, size_t a, size_t m, double *out);
/* Pressure of the patches at every node at displacement d, Pa (n). */
const double *galerkin_dilatation_of_nodes (galerkin *g, const double *d);
const pg_family *galerkin_dilatation_family (const galerkin *g);            /* nodes of each patch */
void galerkin_dilatation_gaps (galerkin *g, double t);  /* sets the gaps; facets must be measured */
/* Contribution of the flux through the gaps to the traction of a constraint, Pa. */
double galerkin_dilatation_traction (const galerkin *g, const constraint *q);
/* f += derivative of the work of the patches' pressures on the gaps, N. */
void galerkin_dilatation_adjoint (const galerkin *g, double *f);
/* bulk */
void galerkin_bulk_blocks (void *context, size_t p, size_t a, size_t m, double *out);
/* consistent integration: blocks of all points of a cell at once */
void galerkin_cell_blocks (void *context, size_t cell, size_t a, size_t m, double *out);
/* gradients: rows of K from products of derivatives (pg_assembly_source.rows); galerkin_has_rows 0: points
 * differ in D, or there is stabilisation, and the blocks are needed. */
int  galerkin_has_rows    (const galerkin *g);
void galerkin_point_rows  (void *context, size_t p, size_t a, size_t m, double *out);
void galerkin_cell_rows   (void *context, size_t cell, size_t a, size_t m, double *out);
void galerkin_finish_rows (void *context, size_t m, double *rows);
/* f += internal force, N, by the last measure */
void galerkin_bulk_force  (galerkin *g, const double *d, double *f);
void galerkin_bulk_apply  (galerkin *g, const double *x, double *y);   /* y += K x of the bulk */
double galerkin_bulk_energy (const galerkin *g, const double *d);
const pg_material *galerkin_material (const galerkin *g, int set, size_t p);
/* f_k = sum of sigma_kl dN/dx_l, i.e. B' sigma for one node: q is its gradient of N, 1/m, and s the stress in
 * Voigt order. */
static inline void galerkin_B_transpose (int dim, const double *q, const double *s, double *f)
{
    if (dim == 1) f[0] = q[0] * s[0];
    else if (dim == 2) f[0] = q[0] * s[0] + q[1] * s[2], f[1] = q[1] * s[1] + q[0] * s[2];
    else {
        f[0] = q[0] * s[0] + q[1] * s[3] + q[2] * s[5];
        f[1] = q[1] * s[1] + q[0] * s[3] + q[2] * s[4];
        f[2] = q[2] * s[2] + q[1] * s[4] + q[0] * s[5];
    }
}
/* boundary: loads and supports (galerkin_nitsche.c) */
pg_status galerkin_boundary_create (galerkin *g);
void galerkin_boundary_free (galerkin *g);
void galerkin_facet_blocks (void *context, size_t p, size_t a, size_t m, double *out);
/* Nitsche's terms of facet points as block rows (pg_assembly_source.rows) */
void galerkin_facet_rows   (void *context, size_t p, size_t a, size_t m, double *out);
void galerkin_penalty_blocks   (void *context, size_t p, size_t a, size_t m, double *out);
/* y += K x of the supports */
void galerkin_boundary_apply (galerkin *g, const double *x, double *y);
/* P: nodal forces of all loads at time t, N, without supports */
void galerkin_loads (galerkin *g, double t, double *P);
/* residual += loads and boundary terms, N (facets and nodes must be measured); external and reaction: sums of
 * squares, N^2, for the reference of the residual */
void galerkin_boundary_force (galerkin *g, double t, const double *d, double *residual, double *external,
                              double *reaction);
double galerkin_boundary_energy (galerkin *g, double t);
/* Sum of squares of forces on the nodes that this rank owns, N^2. */
double galerkin_squared (const galerkin *g, const double *force);
/* 1: forces that do not depend on d use the shape functions of one of these points */
int    galerkin_boundary_loaded (const galerkin *g, int set, size_t count, const size_t *list);
long   galerkin_penalty_of (const galerkin *g, size_t node);   /* position in penalty_node, or -1 */
double galerkin_nitsche_stiffness (const galerkin *g, const constraint *q);
double galerkin_penalty_stiffness (const galerkin *g, const constraint *q);
size_t galerkin_boundary_pairs (galerkin *g);
/* P += factor times the nodal forces of a unit pressure in all cracks, N (ndof). */
void   galerkin_crack_pressure (galerkin *g, double factor, double *P);
/* The volume of all cracks, m^3, that a displacement d opens. */
double galerkin_crack_volume   (galerkin *g, const double *d);
size_t galerkin_boundary_work_balance (galerkin *g, double t, const double *d, pg_work_balance *out);
/* basis: elimination of prescribed displacements (galerkin_basis.c) */
pg_status galerkin_basis_create (galerkin *g);
pg_status galerkin_basis_update (galerkin *g);
/* 1: T depends on the shape functions of one of these nodes */
int galerkin_basis_touched (const galerkin *g, size_t count, const size_t *list);
void galerkin_basis_free (galerkin *g);
const pg_sparse *galerkin_basis (void *self);
pg_status galerkin_impose (void *self, double t, double *d);
size_t galerkin_basis_work_balance (galerkin *g, double t, const double *residual, pg_work_balance *out,
                                    size_t at);
/* elements: finite elements on the nodes, as a preconditioner (galerkin_elements.c) */
pg_status galerkin_elements (void *self, pg_elements *out);
/* bonds: judging by criteria (galerkin_bonds.c) */
/* Judging of bonds of a set; arrays for utilisation, factor and kind of failure (NULL: not wanted). */
typedef struct {
    galerkin *g;
    const pg_state *state;
    int     set;
    double *utilisation, *factor;
    char   *kind;
} galerkin_judging;
enum { GALERKIN_BATCH = 128 };
/* Judges up to GALERKIN_BATCH intact bonds by the principal stresses or displacements of both ends; to: their
 * positions in the arrays. */
void galerkin_judge (const galerkin_judging *s, size_t count, const size_t *bond, const size_t *point,
                     const size_t *to);
/* A batch of bonds of one set to be judged together. Of those judged so far: top: the largest utilisation;
 * list: those with `from` or more (NULL: not wanted). galerkin_judge_batch judges and empties the batch. */
typedef struct {
    galerkin_judging judge;
    double  from, top;
    pg_changes *list;
    size_t  bond[GALERKIN_BATCH], point[GALERKIN_BATCH], count;
} galerkin_batch;
pg_status galerkin_judge_batch (galerkin_batch *b);
/* Computes s1 and s3 of a point from the stress measured last, Pa. */
void galerkin_principal (galerkin *g, int set, size_t p);
/* pg_force_type.judge, and its parts: _utilisation: of all bonds; _worst: only the bonds with the largest
 * utilisation */
pg_status galerkin_judge_bonds (void *self, const pg_state *state, const double *d, const pg_judging *what);
pg_status galerkin_utilisation (galerkin *g, const pg_state *state, const double *d, double *utilisation,
                                char *kind, double *factor);
pg_status galerkin_worst (galerkin *g, const pg_state *state, const double *d, double from,
                          double *utilisation, char *kind, double *top, pg_changes *over);
/* galerkin_worst where elongation alone decides (pg_problem_breaks_by_elongation) */
pg_status galerkin_longest (galerkin *g, const pg_state *state, const double *d, double from,
                            double *utilisation, char *kind, double *top, pg_changes *over);
/* The largest of `mine` over all ranks that share the body. */
double    galerkin_largest (const galerkin *g, double mine);
/* Makes bounds.judged, on the first call. */
pg_status galerkin_find_judged (galerkin *g);
/* In graded clouds: mean support radius of the ends of a bond over the horizon; limits scale by it. */
double galerkin_reach (const galerkin *g, int set, size_t point, size_t entry);
/* limit: the criteria (problem.at.limit) of the ends of these bonds, each once; returns their number, at most
 * 2 count. */
size_t galerkin_limits_of (const galerkin *g, int set, size_t count, const size_t *bond, const size_t *point,
                           int *limit);
/* The criterion of both ends of all these bonds, or -1 if there are several. */
int galerkin_one_material (const galerkin *g, int set, size_t count, const size_t *bond, const size_t *point);
/* groups (galerkin_groups.c) */
pg_status galerkin_gather (void *self, pg_bond_group *group, int *can);
pg_status galerkin_judge_others (galerkin *g, const pg_state *state, const unsigned char *left_out,
                                 int of_unit, size_t count, const double *d, double *top);
pg_status galerkin_census (void *self, pg_census *out);
void galerkin_join (void *self, int *parent);
/* The force's refresh (pg_force_type.refresh). */
pg_status galerkin_refresh (void *self, const pg_state *state, const pg_changes *changes);
void galerkin_at_nodes   (void *self, const double *x, double *u);
void galerkin_from_nodes (void *self, const double *F, double *f);
pg_status galerkin_field (void *self, const pg_state *state, const double *d, const char *name,
                          int *components, const char **unit, double *value);
pg_status galerkin_estimate (void *self, const double *d, pg_estimate *out, double *value);
/* surface: nodal forces of a uniform stress (galerkin_surface.c) */
pg_status galerkin_surface (void *self, const double *stress, double *P);
pg_status galerkin_sample (void *self, const pg_state *state, const double *d, size_t n, const double *x,
                           double *u, double *stress, double *gradient);
/* sample_alike: sampling at positions of a lattice with equal surroundings, whose rows are kept by keys 0, 1,
 * ... */
typedef struct galerkin_alike galerkin_alike;
pg_status galerkin_alike_create (galerkin_alike **out, const pg_problem *problem);
void   galerkin_alike_free (galerkin_alike **alike);
/* Announces the field to be sampled (ndof numbers); rows kept for another one are dropped. */
void   galerkin_alike_begin (galerkin_alike *alike, size_t ndof, const double *d);
/* which: key of the kept row of each position, or -1: these *nrest positions are listed in `rest`, and in
 * `leaves` the key for which the row of each is to be kept, or -1. volume: of the nodes, m^3. */
pg_status galerkin_alike_sort (galerkin_alike *alike, const double *volume, size_t n, const double *x,
                               int *which, size_t *rest, int *leaves, size_t *nrest);
void   galerkin_alike_keep (galerkin_alike *alike, int key, const pg_rows *rows, size_t at, const double *x);
int    galerkin_alike_good (const galerkin_alike *alike, int key);  /* 0: no other position can use the row */
/* u (3) and H (9) at position x; value: scratch of the thread, galerkin_alike_scratch numbers; held: first
 * vertex of the block whose nodal values it contains, SIZE_MAX at first. */
size_t galerkin_alike_scratch (const galerkin_alike *alike);
void   galerkin_alike_values (const galerkin_alike *alike, int key, const double *x, const double *d,
                              double *value, size_t *held, double *u, double *H);

/* sample_again: kept shape functions of positions that are sampled repeatedly, n <= CHUNK of
 * galerkin_sample.c. galerkin_again_serves: 1: keeping may pay. */
typedef struct galerkin_again galerkin_again;
void   galerkin_again_free (galerkin_again **again);
int    galerkin_again_serves (const galerkin *g, size_t n);
pg_status galerkin_again_find (galerkin *g, const pg_state *state, size_t n, const double *x,
                               const pg_rows **rows, size_t **at);
pg_status galerkin_again_keep (galerkin *g, const pg_state *state, size_t n, const double *x, pg_rows *rows,
                               size_t **at);
int    galerkin_again_served (const galerkin *g);      /* 1: some were used again */

/* Four numbers at a time; the same operations in the same order with and without AVX. */
typedef double four __attribute__ ((vector_size (32), aligned (8)));
/* Eight numbers at a time, for functions marked PG_WIDEST. */
typedef double eight __attribute__ ((vector_size (64), aligned (8)));
#endif
