/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the Galerkin force. Files: galerkin.c (life cycle, refresh, balance), galerkin_bulk.c (stress,
 * blocks, energy), galerkin_gradients.c (rows of K),
 * galerkin_nitsche.c (Nitsche, penalty, loads), galerkin_place.c (where these act), galerkin_basis.c
 * (elimination),
 * galerkin_sum.c (forces of all points), galerkin_measure.c (their strains),
 * galerkin_runs.c (points that are alike), galerkin_silling.c (stabilisation), galerkin_operator.c (K x, K),
 * galerkin_bonds.c (utilisation, overlap, census), galerkin_worst.c (the worst bonds),
 * galerkin_stretch.c (those by their elongation), galerkin_groups.c (bonds outside of a group),
 * galerkin_sight.c (which points see which nodes),
 * galerkin_dilatation.c, galerkin_dilatation_facet.c (near
 * Poisson's ratio 1/2), galerkin_consistent.c (rows of the sums),
 * galerkin_ended.c, galerkin_ended_plan.c (cells that end at cracks), galerkin_change.c
 * (what breaking changes of K), galerkin_field.c (fields), galerkin_elements.c, galerkin_elements_list.c
 * (preconditioner), galerkin_hats.c (the same on a coarse grid),
 * galerkin_rows.c (rows of shape functions), galerkin_sample.c (any place),
 * galerkin_sample_alike.c (places that are alike),
 * galerkin_sample_again.c (places that are asked for again),
 * galerkin_estimate.c (error of the stress). */
#ifndef PG_GALERKIN_H
#define PG_GALERKIN_H
#include "perigal/force.h"
#include "perigal/linalg.h"

typedef struct {                                       /* a prescribed component at a facet point */
    size_t point;
    int    load, component;
} constraint;

typedef struct {  /* one component's elimination: C_s d_s = g - C_m d_m */
    int     component;
    size_t  n, nmaster;
    int    *slave, *load;  /* nodes, ascending, and the load that prescribes each */
    int    *master;  /* nodes coupled to the slaves, not slaves, ascending */
    double *inverse;                                   /* C_s^-1 (n x n); NULL: identity */
    double *X;                                         /* C_s^-1 C_m (n x nmaster) */
} elimination;

typedef struct galerkin_slices galerkin_slices;         /* galerkin_sum.c */
typedef struct galerkin_sight galerkin_sight;           /* galerkin_sight.c */
typedef struct galerkin_dilatation galerkin_dilatation; /* galerkin_dilatation.c */
typedef struct galerkin_change galerkin_change;         /* galerkin_change.c */
typedef struct galerkin_ended galerkin_ended;           /* galerkin_ended.c */
typedef struct galerkin_store galerkin_store;           /* galerkin_rows.c */

/* What the scene says of the method (pg_problem.options). */
typedef struct {
    double silling;                                    /* Gs; 0: no stabilisation */
    double nitsche, penalty;                           /* factors of E / h, h the local spacing */
} galerkin_options;
/* The last measure of a displacement field. */
typedef struct {
    double  *strain[PG_BOND_SETS], *stress[PG_BOND_SETS], *zz[PG_BOND_SETS], *u[PG_BOND_SETS];
    double  *s1[PG_BOND_SETS], *s3[PG_BOND_SETS];
    double  *seen[PG_BOND_SETS];                       /* its displacement (ndof) */
    /* it is that of `seen` and of the rows as they are, but for blocks of points that are disturbed (1) */
    int      fresh[PG_BOND_SETS];
    unsigned char *disturbed[PG_BOND_SETS];
    galerkin_sight *sight[PG_BOND_SETS];               /* NULL until asked for */
    const double *at_d;                                /* for workers */
} galerkin_measured;

/* How near bonds are to their limits, as far as it can be told of a point at a glance. */
typedef struct {
    /* galerkin_worst.c: a bound of what each point would use of the limits, NULL until asked for; 1: s1 and
     * s3 of a point are no bounds; 1: those of a block of points are by the stress of the last measure */
    double  *alone[PG_BOND_SETS];
    unsigned char *exact[PG_BOND_SETS], *bounded[PG_BOND_SETS];
    /* galerkin_stretch.c: the largest elongation in each block of points; place and displacement of every
     * node, 8 numbers; NULL until asked for */
    double  *longest[PG_BOND_SETS], *place_now;
    /* bonds that a criterion looks at while they live (1 per bond); NULL until one does */
    unsigned char *judged[PG_BOND_SETS];
} galerkin_bounds;

/* galerkin_eigenstrain.c */
typedef struct {
    /* the free strain of every point at that time, s (NULL: the scene has none); norm of the forces that hold
     * the body against it, N; scratch (2 ndof) */
    double  *strain[PG_BOND_SETS], time, force;
    /* per load and set: free strain of factor 1 where that is a pattern times a factor of t, else NULL */
    double **pattern;
} galerkin_eigenstrain;

/* K and M. */
typedef struct {
    pg_assembly *K;                                   /* NULL until someone asks for the matrix */
    int      took;                                     /* 1: the bulk's part was pg_problem.intact's */
    pg_assembly *M;                                   /* consistent mass, NULL until asked for */
    int      all_stale;  /* rows of K to be gathered again: all, or those marked */
    unsigned char *stale;
    pg_operator   op;
    double  *wide;                                     /* scratch: one row of blocks */
    double  *diagonal;  /* of K; known as long as diagonal_of is the revision */
    unsigned long diagonal_of;
    unsigned long revision;                            /* of K and T */
} galerkin_stiffness;

/* Prescribed displacements. */
typedef struct {
    constraint *nitsche;  size_t nnitsche;                        /* Nitsche, ascending by point */
    size_t  *nitsche_start;                                /* facet point -> its constraints */
    /* penalty: point = index into penalty_node */
    constraint *penalty;  size_t npenalty;
    /* constraints of a node: penalty_start[k]..penalty_start[k + 1] */
    int     *penalty_node; size_t npenalty_node; size_t *penalty_start;
    pg_family penalty_family;  /* constrained nodes -> nodes (copy of the node rows' families) */
    elimination side[3];
    pg_sparse T;
    int      has_T;
} galerkin_supports;

/* What finds a place among points and nodes; each NULL until a place is asked for. */
typedef struct {
    pg_nearest *near_point, *near_node;                /* bulk points, nodes */
    pg_family_search *search;                          /* nodes that a place sees */
    struct galerkin_alike *alike;                      /* places that see them alike, where there are such */
    struct galerkin_again *again;                      /* places that were asked for before */
} galerkin_places;

typedef struct {
    const pg_problem *problem;
    const galerkin_options *options;                   /* pg_problem.options */
    int      dim, nv, threads, bulk;                   /* bulk: PG_NODES or PG_POINTS */
    size_t   n;                                        /* nodes */
    pg_rows  rows[PG_BOND_SETS];                       /* geometry borrowed from the problem, values owned */
    /* evaluation points in stiffness and force: those of the bulk, or with consistent integration wider ones
     * with corrected derivatives */
    pg_rows  sums;
    /* 1: the values of nodes and points, and of consistent sums, are pg_problem.intact's */
    int      borrows;
    galerkin_store *store[PG_BOND_SETS];               /* NULL: every point has a row of its own */
    unsigned char *whole;  /* cells whose derivatives are corrected; NULL: not consistent */
    galerkin_ended *ended;                             /* NULL: no cells that could end at cracks */
    const int *material[PG_BOND_SETS];                 /* per point; the problem's */
    galerkin_measured    measured;
    galerkin_bounds      bounds;
    galerkin_eigenstrain eigen;
    galerkin_stiffness   stiffness;
    galerkin_supports    supports;
    galerkin_places      places;
    galerkin_slices *slices;
    double  *kept, *place;  /* galerkin_silling.c; NULL: no stabilisation */
    galerkin_dilatation *dilatation;                   /* NULL: at the points everywhere */
    galerkin_change *change;                           /* NULL until someone asks for it */
    double  *work;                                     /* ndof */
    int     *ends;  /* bonds that end at each node (n), for damage; NULL until asked for */
    size_t  *list[PG_BOND_SETS];                       /* touched points (scratch of refresh) */
} galerkin;

/* scene: entries of pg_method */
extern const pg_key_table galerkin_keys;
pg_status galerkin_read (pg_problem *problem, const pg_scene *scene);
void      galerkin_support (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
double    galerkin_support_stiffness (const pg_problem *problem);
pg_status galerkin_limits (const pg_problem *problem, size_t material, pg_criterion_setting *setting);
double    galerkin_ghost_cells (const pg_scene *scene, double *beyond);
void      galerkin_words (const pg_problem *problem, char *text, size_t size);

/* rows: of a set as they are at first, those of the problem or none; all of the force go when it is freed,
 * before all else of it. */
pg_status galerkin_rows_create (galerkin *g, int set);
void      galerkin_rows_free   (galerkin *g);
int       galerkin_borrows     (const galerkin *g, int set);           /* 1: they are those of the problem */
/* 1: a bond is broken, so that rows of the problem serve no longer, and all are to be evaluated. */
int       galerkin_give_back   (galerkin *g, const pg_state *state);
/* The bulk's part of K, to be freed by the caller, or NULL: nobody has it, or bonds are broken. */
pg_assembly *galerkin_take_stiffness (const galerkin *g);
/* Evaluates rows of a set that are not those of the problem: all (list NULL), or `count` of them. */
pg_status galerkin_evaluate (galerkin *g, const pg_state *state, int set, size_t count, const size_t *list);
/* Bonds of all sets whose points share their rows. */
size_t    galerkin_shared_bonds (const galerkin *g);
/* sum: the loops over points */
pg_status galerkin_slices_create (galerkin *g);
void galerkin_slices_free (galerkin *g);
/* The rows of these points have changed (list NULL: of all). */
void galerkin_slices_stale (galerkin *g, size_t count, const size_t *list);
/* sight: points in blocks of so many; those that see a node where x and other differ (NULL: where x is not
 * zero) are marked, block by block. NULL: most of them do, or there is no table (galerkin_sight_ready: makes
 * those of sets that have been measured, and with `products` that of the bulk). Valid until the next call
 * for this set. */
enum { GALERKIN_BLOCK = 16 };
unsigned char *galerkin_active (galerkin *g, int set, const double *x, const double *other);
pg_status galerkin_sight_ready (galerkin *g, int products);
void galerkin_sight_free (galerkin *g);
/* u, strain, stress, zz of every point, unless known */
void galerkin_measure (galerkin *g, int set, const double *d);
/* Measures listed points of a set anew at its last displacement, after their rows have changed. */
void galerkin_measure_list (galerkin *g, int set, size_t count, const size_t *list);
void galerkin_measure_some (galerkin *g, int set, const double *d, size_t count, const size_t *list,
                            size_t nnode, const int *node);
/* f += sum w B' sigma of the last measure, which was at d */
void galerkin_sum_stress  (galerkin *g, const double *d, double *f);
void galerkin_sum_tangent (galerkin *g, const double *x, double *f);   /* f += sum w B' D B x */
/* f += sum w B' D B x of these points of the bulk alone, ascending. */
void galerkin_sum_list (galerkin *g, size_t count, const size_t *list, const double *x, double *f);
/* pg_force_type.spared: what runs have spared */
int  galerkin_spared (const void *self, size_t k, char *what, char *why, double *seconds);
/* eigenstrain: of time t for all that follows; the stress of a point by its strain; what the energy of its
 * strain has too much, J/m^3; pairs of work at the points of the bulk */
pg_status galerkin_eigen_create (galerkin *g);
void galerkin_eigen_free (galerkin *g);
void galerkin_eigen_at (galerkin *g, double t);
void galerkin_eigen_stress (const galerkin *g, int set, size_t p, const double *e);
void galerkin_eigen_relieve (const galerkin *g, double t, const double *x, size_t q, double *stress);
/* eta (relative displacements, m) less the free stretch of bonds xi */
void galerkin_eigen_bonds (const galerkin *g, int set, size_t count, const size_t *bond, const size_t *point,
                           const double *xi, double *eta);
double galerkin_eigen_energy (const galerkin *g, size_t p);
size_t galerkin_eigen_pairs (const galerkin *g);
void galerkin_eigen_work (const galerkin *g, double t, pg_work_balance *out, size_t at);
/* silling: stabilisation of nodal integration, together with the stress */
pg_status galerkin_silling_create (galerkin *g);
void galerkin_silling_free (galerkin *g);
/* The rows of these points have changed (list NULL: of the first `count`). */
void galerkin_silling_update (galerkin *g, size_t count, const size_t *list);
double galerkin_silling_modulus (const galerkin *g, size_t p);         /* Gs mu of a point, Pa */
/* f += forces of the points first .. last - 1 by their stresses (NULL: those of x); x, f: 4 numbers a node, f
 * from node `low` on. */
void galerkin_silling_sum (const galerkin *g, size_t first, size_t last, const double *stress,
                           const double *x, double *f, size_t low);
double galerkin_silling_energy (const galerkin *g, size_t p, const double *d);
/* runs: groups of points that are alike, for products with a tangent */
/* Lanes of a vector: arrays of nodal values by components have room for so many numbers more. */
enum { GALERKIN_LANES = 8 };
/* A bond of the first group of a run: where it stands in a row of nodes that follow each other, its node, the
 * point within the group, and its number in the family. */
typedef struct { int place, node, point; size_t bond; } galerkin_entry;
/* `count` groups of `points` points, the first from point `point` on; its bonds in the order of summation.
 * same: all groups have the N and dN of the first to the last bit. */
typedef struct { size_t point, points, count, entry, entries; int same; } galerkin_run;
/* Runs among the points first .. last - 1, ascending; to be found anew if stale. bonds: of all their
 * points. */
typedef struct {
    size_t first, last, n, cap, nentry, cap_entry, bonds;
    int    stale;
    galerkin_run   *run;
    galerkin_entry *entry;
} galerkin_run_list;
void galerkin_runs_find  (const galerkin *g, galerkin_run_list *list);
void galerkin_runs_clear (galerkin_run_list *list);
/* f += sum w B' D B x of a run; x, f: an array for each component, f from node `low` on; active: blocks of
 * points that x is not zero at (NULL: all). */
void galerkin_run_sum (const galerkin *g, const galerkin_run_list *list, const galerkin_run *run,
                       const double *const x[3], double *const f[3], size_t low,
                       const unsigned char *active);
/* u and strain of the points of a run that is the same, where blocks are active (NULL: all). */
void galerkin_run_strain (const galerkin *g, const galerkin_run *run, const double *const x[3],
                          const unsigned char *active, double *u, double *strain);
/* Eight groups of a run: the first of them is number `lane` of the run, `left` of them exist; x, f: nodal
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
/* rows that the touched points of each set enter */
void galerkin_mark_stale (galerkin *g, const size_t *count);
/* change: between `begin` and the end of a refresh every item of K that it touches is subtracted (sign -1)
 * and added again (1); nothing happens as long as nobody has asked for the change. */
void galerkin_change_free (galerkin *g);
void galerkin_change_begin (galerkin *g, int all);
pg_status galerkin_change_points (galerkin *g, int set, size_t count, const size_t *list, double sign);
pg_status galerkin_change_cells (galerkin *g, size_t count, const size_t *cell, double sign);
pg_status galerkin_change_patch (galerkin *g, size_t patch, int supported, double sign);
void galerkin_change_basis (galerkin *g);
pg_status galerkin_change_of (void *self, pg_stiffness_change *out);
/* consistent */
pg_status galerkin_consistent_create (galerkin *g);
void galerkin_consistent_free (galerkin *g);
/* Brings `sums` in line with the rows of the bulk: all, or cells with the touched points of g->list[bulk],
 * whose number grows to all points of the cells that changed. */
pg_status galerkin_consistent_update (galerkin *g, const pg_state *state, int all, size_t *count);
/* place: where a point of a set is for loads and supports, m (at: room for 3 numbers), and what is prescribed
 * there of a constraint on facets or nodes, m. */
const double *galerkin_place (const galerkin *g, int set, size_t point, double *at);
double galerkin_prescribed (const galerkin *g, const constraint *q, int set, double t);
/* ended: cells that end at cracks; whole cells near them by values of live bonds on their borders */
pg_status galerkin_ended_create (galerkin *g);
void galerkin_ended_free (galerkin *g);
/* How each cell near the cracks of the state is treated, and the values on their borders. *moved: the cracks
 * are others than at the last call. */
pg_status galerkin_ended_plan (galerkin *g, const pg_state *state, int *moved);
size_t galerkin_unended (const galerkin *g);           /* pg_census.unended */
size_t galerkin_ended_near (const galerkin *g, size_t *cell); /* cells near cracks (NULL: their number) */
const pg_rows *galerkin_ended_faces (const galerkin *g);  /* values and grades at the faces of cells */
void galerkin_ended_mark (galerkin *g);                       /* whole: of the cells that end at cracks */
/* Weights of these cells' points, and the derivatives of those in parts, after pg_consistency_apply. */
pg_status galerkin_ended_apply (galerkin *g, size_t count, const size_t *list);
/* Puts the values by which the cells integrate in the place of others, where a place is on their border. */
pg_status galerkin_ended_jump (const galerkin *g, size_t n, const double *x, const double *normal,
                               pg_jump_rows *rows);
/* dilatation: only where g->dilatation is there, but for galerkin_plain, _gaps, _traction, _adjoint */
pg_status galerkin_dilatation_create (galerkin *g);
void galerkin_dilatation_free (galerkin *g);
/* After the rows of all sets: all patches, or those with touched points of g->list (bulk, facets); marks the
 * rows of K that they enter. */
pg_status galerkin_dilatation_update (galerkin *g, const pg_state *state, int all, const size_t *count);
/* The material without the part of D that the projected dilatation carries. */
const pg_material *galerkin_plain (const galerkin *g, int set, size_t p);
/* adds the pressure of the patches to stresses of the plain materials */
void galerkin_dilatation_measure (galerkin *g, int set, const double *d);
void galerkin_dilatation_apply (galerkin *g, const double *x, double *y);   /* y += K x of the patches */
void galerkin_dilatation_diagonal (galerkin *g, double *d);
void galerkin_dilatation_blocks (void *context, size_t patch, size_t a, size_t m, double *out);
/* pressure of the patches at every node, Pa (n) */
const double *galerkin_dilatation_of_nodes (galerkin *g, const double *d);
const pg_family *galerkin_dilatation_family (const galerkin *g);            /* nodes of the patches */
void galerkin_dilatation_gaps (galerkin *g, double t);  /* after the measure of the facets */
/* what the flux through the gaps adds to the traction of a constraint, Pa */
double galerkin_dilatation_traction (const galerkin *g, const constraint *q);
/* f += work of the patches' pressures on the gaps, derived */
void galerkin_dilatation_adjoint (const galerkin *g, double *f);
/* bulk */
void galerkin_bulk_blocks (void *context, size_t p, size_t a, size_t m, double *out);
/* consistent: all points of a cell at once */
void galerkin_cell_blocks (void *context, size_t cell, size_t a, size_t m, double *out);
/* gradients: as sources of an assembly whose sums are finished once (pg_assembly_source.rows); 0: points
 * differ in D, or there is more than D, and the blocks above are needed. */
int  galerkin_has_rows    (const galerkin *g);
void galerkin_point_rows  (void *context, size_t p, size_t a, size_t m, double *out);
void galerkin_cell_rows   (void *context, size_t cell, size_t a, size_t m, double *out);
void galerkin_finish_rows (void *context, size_t m, double *rows);
/* f += internal force (after measure) */
void galerkin_bulk_force  (galerkin *g, const double *d, double *f);
void galerkin_bulk_apply  (galerkin *g, const double *x, double *y);   /* y += K x of the bulk */
double galerkin_bulk_energy (const galerkin *g, const double *d);
const pg_material *galerkin_material (const galerkin *g, int set, size_t p);
/* f_k = sum of sigma_kl dN/dx_l, thus B' sigma for one node: q is its gradient of N, 1/m, and s the
 * stress in Voigt order. */
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
/* boundary */
pg_status galerkin_boundary_create (galerkin *g);
void galerkin_boundary_free (galerkin *g);
void galerkin_facet_blocks (void *context, size_t p, size_t a, size_t m, double *out);
/* Nitsche's terms of facet points as block rows (pg_assembly_source.rows) */
void galerkin_facet_rows   (void *context, size_t p, size_t a, size_t m, double *out);
void galerkin_penalty_blocks   (void *context, size_t p, size_t a, size_t m, double *out);
/* y += what supports add to K x; facet points and constrained nodes only */
void galerkin_boundary_apply (galerkin *g, const double *x, double *y);
/* P: forces of all loads at t on the nodes, N, without supports */
void galerkin_loads (galerkin *g, double t, double *P);
/* residual += loads and boundary terms (after measure); external and reaction: squared norms for the
 * reference */
void galerkin_boundary_force (galerkin *g, double t, const double *d, double *residual, double *external,
                              double *reaction);
double galerkin_boundary_energy (galerkin *g, double t);
/* Sum of squares of forces on the nodes of this rank, N^2; all where it is alone. */
double galerkin_squared (const galerkin *g, const double *force);
/* 1: forces that do not depend on d lean on the shape functions of one of these points */
int    galerkin_boundary_loaded (const galerkin *g, int set, size_t count, const size_t *list);
long   galerkin_penalty_of (const galerkin *g, size_t node);   /* the place under a penalty, or -1 */
double galerkin_nitsche_stiffness (const galerkin *g, const constraint *q);
double galerkin_penalty_stiffness (const galerkin *g, const constraint *q);
size_t galerkin_boundary_pairs (galerkin *g);
/* P += factor times the nodal forces of a unit pressure in all cracks, N (ndof). */
void   galerkin_crack_pressure (galerkin *g, double factor, double *P);
/* The volume of all cracks, m^3, that a displacement d opens. */
double galerkin_crack_volume   (galerkin *g, const double *d);
size_t galerkin_boundary_work_balance (galerkin *g, double t, const double *d, pg_work_balance *out);
/* basis */
pg_status galerkin_basis_create (galerkin *g);
pg_status galerkin_basis_update (galerkin *g);
/* 1: T leans on the shape functions of one of these nodes */
int galerkin_basis_touched (const galerkin *g, size_t count, const size_t *list);
void galerkin_basis_free (galerkin *g);
const pg_sparse *galerkin_basis (void *self);
pg_status galerkin_impose (void *self, double t, double *d);
size_t galerkin_basis_work_balance (galerkin *g, double t, const double *residual, pg_work_balance *out,
                                    size_t at);
/* elements: finite elements on the nodes, as a preconditioner */
pg_status galerkin_elements (void *self, pg_elements *out);
/* bonds and fields */
/* Bonds of a set that are judged, with the arrays that take what they show (NULL: not wanted). */
typedef struct {
    galerkin *g;
    const pg_state *state;
    int     set;
    double *utilisation, *factor;
    char   *kind;
} galerkin_judging;
enum { GALERKIN_BATCH = 128 };
/* At most so many live bonds by the principal stresses of both ends; to: their places in the arrays. */
void galerkin_judge (const galerkin_judging *s, size_t count, const size_t *bond, const size_t *point,
                     const size_t *to);
/* Bonds of one set that are judged together. Of those judged so far: top, the largest utilisation; list those
 * that use `from` or more of their limit (NULL: not wanted). galerkin_judge_batch judges and empties it. */
typedef struct {
    galerkin_judging judge;
    double  from, top;
    pg_changes *list;
    size_t  bond[GALERKIN_BATCH], point[GALERKIN_BATCH], count;
} galerkin_batch;
pg_status galerkin_judge_batch (galerkin_batch *b);
/* s1 and s3 of a point by the stress measured last. */
void galerkin_principal (galerkin *g, int set, size_t p);
/* pg_force_type.judge, and its parts: of all bonds; worst: the worst bonds alone */
pg_status galerkin_judge_bonds (void *self, const pg_state *state, const double *d, const pg_judging *what);
pg_status galerkin_utilisation (galerkin *g, const pg_state *state, const double *d, double *utilisation,
                                char *kind, double *factor);
pg_status galerkin_worst (galerkin *g, const pg_state *state, const double *d, double from,
                          double *utilisation, char *kind, double *top, pg_changes *over);
/* stretch: the same where elongation decides (pg_problem_breaks_by_elongation) */
pg_status galerkin_longest (galerkin *g, const pg_state *state, const double *d, double from,
                            double *utilisation, char *kind, double *top, pg_changes *over);
/* Of all ranks that share the body. */
double    galerkin_largest (const galerkin *g, double mine);
/* g->judged, once */
pg_status galerkin_find_judged (galerkin *g);
/* Of graded clouds: support of a bond of an entry of a set over the horizon, by which limits scale. */
double galerkin_reach (const galerkin *g, int set, size_t point, size_t entry);
/* Which criteria (problem.limit) judge the ends of these bonds, each once; returns how many, at most 2
 * count. */
size_t galerkin_limits_of (const galerkin *g, int set, size_t count, const size_t *bond, const size_t *point,
                           int *limit);
/* The only criterion that the ends of these bonds have, or -1. */
int galerkin_one_material (const galerkin *g, int set, size_t count, const size_t *bond, const size_t *point);
/* groups */
pg_status galerkin_gather (void *self, pg_bond_group *group, int *can);
pg_status galerkin_judge_others (galerkin *g, const pg_state *state, const unsigned char *left_out,
                                 int of_unit, size_t count, const double *d, double *top);
pg_status galerkin_census (void *self, pg_census *out);
void galerkin_join (void *self, int *parent);
/* The force's refresh, for who asks before the first one. */
pg_status galerkin_refresh (void *self, const pg_state *state, const pg_changes *changes);
void galerkin_at_nodes   (void *self, const double *x, double *u);
void galerkin_from_nodes (void *self, const double *F, double *f);
pg_status galerkin_field (void *self, const pg_state *state, const double *d, const char *name,
                          int *components, const char **unit, double *value);
pg_status galerkin_estimate (void *self, const double *d, pg_estimate *out, double *value);
/* surface */
pg_status galerkin_surface (void *self, const double *stress, double *P);
pg_status galerkin_sample (void *self, const pg_state *state, const double *d, size_t n, const double *x,
                           double *u, double *stress, double *gradient);
/* sample_alike: places of a lattice that see their nodes alike, rows kept by keys 0, 1, ... */
typedef struct galerkin_alike galerkin_alike;
pg_status galerkin_alike_create (galerkin_alike **out, const pg_problem *problem);
void   galerkin_alike_free (galerkin_alike **alike);
/* Before places are sampled: the field (ndof numbers); rows of another one are forgotten. */
void   galerkin_alike_begin (galerkin_alike *alike, size_t ndof, const double *d);
/* Key of each place, or -1: these n = *nrest places are listed in `rest`, each with the key that its own row
 * is to be kept for, or -1. volume: of the nodes. */
pg_status galerkin_alike_sort (galerkin_alike *alike, const double *volume, size_t n, const double *x,
                               int *which, size_t *rest, int *leaves, size_t *nrest);
void   galerkin_alike_keep (galerkin_alike *alike, int key, const pg_rows *rows, size_t at, const double *x);
int    galerkin_alike_good (const galerkin_alike *alike, int key);      /* 0: the row serves nobody else */
/* u (3) and H (9) at place x; value: galerkin_alike_scratch numbers of the thread, held: of which block,
 * SIZE_MAX at first. */
size_t galerkin_alike_scratch (const galerkin_alike *alike);
void   galerkin_alike_values (const galerkin_alike *alike, int key, const double *x, const double *d,
                              double *value, size_t *held, double *u, double *H);

/* sample_again: shape functions of places that are asked for again, n <= a chunk. Is it worth looking? */
typedef struct galerkin_again galerkin_again;
void   galerkin_again_free (galerkin_again **again);
int    galerkin_again_serves (const galerkin *g, size_t n);
pg_status galerkin_again_find (galerkin *g, const pg_state *state, size_t n, const double *x,
                               const pg_rows **rows, size_t **at);
pg_status galerkin_again_keep (galerkin *g, const pg_state *state, size_t n, const double *x, pg_rows *rows,
                               size_t **at);
int    galerkin_again_served (const galerkin *g);      /* were any used again? */

/* Four numbers at a time; the same operations in the same order with and without AVX. */
typedef double four __attribute__ ((vector_size (32), aligned (8)));
/* Eight numbers, for which PG_WIDEST is meant. */
typedef double eight __attribute__ ((vector_size (64), aligned (8)));
#endif
