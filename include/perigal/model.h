/* SPDX-License-Identifier: GPL-3.0-or-later
 * model.h: the problem (constant once built) and the state (all that evolves). */
#ifndef PERIGAL_MODEL_H
#define PERIGAL_MODEL_H
#include <math.h>
#include "perigal/scene.h"
#include "perigal/criterion.h"
#include "perigal/crack.h"
#include "perigal/approx.h"
#include "perigal/integration.h"
#include "perigal/sums.h"

PG_API_BEGIN

/* ---- loads and supports -------------------------------------------------------------------------------- */
typedef enum {
    PG_DISPLACEMENT,
    PG_VELOCITY,
    PG_TRACTION,
    PG_PRESSURE,
    PG_POINT_FORCE,
    PG_BODY_FORCE,
    PG_ROTATION,
    PG_MOMENT,
    PG_SPRING,                                         /* to a place that stands still or moves */
    PG_EIGENSTRAIN,                                    /* temperature, shrinkage, pore pressure */
    PG_PLATEN_MOTION,                                  /* of a rigid platen, m; its set is empty */
    PG_PLATEN_FORCE                                    /* on a rigid platen, N; its set is empty */
} pg_load_kind;
typedef struct pg_problem pg_problem;
typedef enum { PG_ESSENTIAL_NITSCHE, PG_ESSENTIAL_TRANSFORMATION, PG_ESSENTIAL_PENALTY } pg_essential;
typedef struct pg_load {
    char           name[64];
    pg_load_kind   kind;
    const pg_set  *set;
    int            platen;                             /* 1 + number of the platen that it moves; 0: none */
    /* 1: a pressure in all cracks, also in those that come into being, the same at all places; the set is
     * empty */
    int            cracks;
    /* per component, NULL: free; m, m/s, Pa, N, N/m^3, rad, N m; 2D rotation, moment: about z, the first */
    pg_expression *value[3];
    pg_expression *ramp;                               /* factor of t; NULL: from the table */
    double        *table; size_t ntable;               /* ntable x 2: t (s), factor */
    int            proportional;                       /* factor is t itself */
    /* m, without shape functions: a traction or pressure acts on the points down to this depth; 0: on the
     * outermost ones */
    double         depth;
    pg_essential   essential;                          /* how PG_DISPLACEMENT and PG_VELOCITY are imposed */
    double         penalty;  /* its factor of E / h, h the local spacing, for PG_ESSENTIAL_PENALTY */
    double         about[3];                           /* moments are about this place, m */
    /* 1: the set turns about that place as a rigid body, by these angles about x, y, z (rad; NULL: not); by
     * finite rotations, or by small ones. `value` then tells which components are prescribed. */
    int            turns, finite;  pg_expression *angle[3];
    int            symmetry;                           /* 1 + axis across a plane of symmetry; 0: none */
    int            weighs;                             /* a force per volume times the density */
    /* m^2: a total force on faces is a traction, its value (N) over this area, thickness included; 0: the
     * values of other loads are as they stand */
    double         over_area;
    /* A force or spring at a place `at`, m: shares of the points around it, which sum up to 1 and have their
     * centre there (set->npoint); NULL: all points of the set alike. The set is then the load's own. */
    double         at[3], *share;  pg_set *own;
    double         stiffness[3];                       /* of a spring along x, y, z, N/m */
    /* Of an eigenstrain: what the value is multiplied with in each material to give the free strain, the same
     * along all axes (pg_problem.nmaterial); unit of the value. */
    double        *per_material;
} pg_load;
/* What a balance or a step says of every load, in one array: forces on the body, N (of rotations and moments
 * N m), component k of load l being number 3 l + k; behind those of all loads the moments of these forces
 * about pg_load.about, N m, component k of load l being number 3 (nload + l) + k (the plane: k = 2). */
enum { PG_REACTIONS = 6 };
/* moment (3) += that of a force along axis k at place x, N m. */
void pg_load_add_moment (const pg_load *load, int dim, const double *x, int k, double force, double *moment);
/* 1: this rank counts a facet that several may hold; alone: every one. */
int  pg_problem_owns_facet (const pg_problem *problem, size_t facet);
/* points per direction by PG_ESSENTIAL_TRANSFORMATION: full matrices below 300 MB each */
#define PG_MOST_ELIMINATED 6000
/* Component k of the load at place x and time t (s; static: load factor). */
double pg_load_value (const pg_load *load, int k, int dim, const double *x, double t);
/* 1: the load is one pattern in space times a factor of t alone; pg_load_value is then the product of these
 * two, bit by bit. */
int    pg_load_separates (const pg_load *load);
double pg_load_factor  (const pg_load *load, double t);
double pg_load_pattern (const pg_load *load, int k, int dim, const double *x);
pg_place pg_place_of (int dim, const double *x, double t);             /* what expressions see at x */
/* What a force per volume is multiplied with at a point of a bond set: the density of a load that weighs, or
 * 1. */
double pg_load_density (const pg_problem *problem, const pg_load *load, int set, size_t point);
/* The free linear strain at time t at a point of a bond set, or at a node and place x: by temperature,
 * shrinkage
 * and pore pressure, the same along all axes. strained: 1: there are loads of this kind. */
double pg_problem_eigenstrain (const pg_problem *problem, int set, size_t point, double t);
int    pg_problem_strained    (const pg_problem *problem);
/* 1: whether a bond breaks follows from the displacements of its two ends alone, by the same limit for all
 * bonds (one criterion with pg_criterion_type.elongation, no free strains, no graded points). */
int    pg_problem_breaks_by_elongation (const pg_problem *problem);
/* 1: cracks of the scene grow by facets; known as soon as the force, the points and the materials are. */
int    pg_problem_by_facets (const pg_problem *problem, const pg_scene *scene);
/* The share of point i of its set in a total force or a spring; the place that its value is taken at: x, the
 * point's, or that of the load. */
double pg_load_share (const pg_load *load, size_t i);
const double *pg_load_site (const pg_load *load, const double *x);
int    pg_load_prescribes (const pg_load *load);       /* displacement, velocity or rotation */
int    pg_load_rotates (const pg_load *load);            /* rotation or moment */
int    pg_load_components (const pg_load *load, int dim);  /* dim; of a rotation or moment 1 in 2D, 3 in 3D */
char   pg_load_axis (const pg_load *load, int dim, int k);             /* 'x', 'y', 'z' of component k */

/* A stage of loading (key `stages`). Stage k (from 1) runs from t = k - 1 to t = k; its loads go straight to
 * their targets, and it ends early where one of its conditions is met. */
typedef struct {
    char    name[64];
    /* per load its factor at the end; NAN: it stays (nload) */
    double *target;
    long    steps;                                     /* stepping: fixed: load steps; 0: solver.steps */
    int     gauge;  double opening;                    /* number of a gauge, -1: none; m */
    /* number of a load, -1: none; its force falls by this share of the largest */
    int     load;   double drop;
    /* taken out of the body in this stage; NULL: nothing */
    const pg_set *remove;
    long    events;                                    /* 0: any number */
    double  growth;  /* of cracks since the stage began, m (in space m^2); 0: any */
} pg_stage;

/* A rigid platen or indenter (key `platens`): what of the body comes to its surface is pressed, and rubbed,
 * by it. It is moved or pressed by loads of its own, which follow those of `boundary`. Components that have
 * neither a displacement nor a force are held. */
typedef enum { PG_PLATEN_PLANE, PG_PLATEN_CYLINDER, PG_PLATEN_SPHERE } pg_platen_shape;
typedef struct {
    char   name[64];
    pg_platen_shape shape;
    /* a place of the plane; the centre of the sphere, of the cylinder in the plane; a place of its axis. It
     * turns about this place */
    double point[3];
    /* plane: unit normal towards the body; cylinder in space: unit vector along its axis */
    double normal[3];
    double radius;                                     /* of cylinder and sphere, m */
    double width;  /* plane: only so wide about `point` (3D: diameter), m; INFINITY: without end */
    int    concave;                                    /* 1: the body lies inside cylinder or sphere */
    double friction;                                   /* Coulomb's coefficient */
    int    tilts;                                      /* 1: free to turn, without a moment */
    int    free[3];                                    /* 1: moves along that axis as its force has it */
    int    motion, force;                              /* numbers of its loads; -1: none */
    double mass, velocity[3];  /* in motion: kg, 0: none; at the start, m/s */
} pg_platen;
/* Distance of a place from the surface of the platen where it was at the start, m; negative: inside it.
 * INFINITY: beside the platen. normal (dim): unit, from the platen towards the body. */
double pg_platen_distance (const pg_platen *platen, int dim, const double *x, double *normal);

/* ---- problem ------------------------------------------------------------------------------------------- */
/* Bond sets, each a list of points and the nodes they see (style: one array of alive bits per set, all in
 * state). */
enum { PG_NODES, PG_POINTS, PG_FACETS, PG_BOND_SETS };
/* The patch test of a discretisation: the body without cracks and supports, of one material, under the
 * tractions of a uniform stress on its whole surface; exactly, its displacement is linear. Of the worst state
 * of stress, but for the counts. */
typedef struct {
    int    measured;                                   /* 0: not (yet) measured: the numbers below are NAN */
    /* of the displacement, relative: its root of mean square, or of that of the loaded surface (compliance)
     * if that is more */
    double error;
    double compliance;  /* work of the tractions over the exact one, less 1: > 0 too soft */
    int    state;                                      /* which stress: 0.. of pg_voigt order */
    /* 1: no facets: the outermost points are held in the linear field instead, compliance is NAN */
    int    held;
    int    settled;                                    /* 0: iterations ended early: at least so much */
    /* the largest strain of a rigid motion (a translation by the radius of the body, a turn by one), by its
     * energy and the work of uniform tractions in it: rounding where such motions strain nothing */
    double rigid;
    /* energy that rough forces of unit size put into the body, over their number: about 1; of small bodies
     * 10; 1e9 and more: next to nothing resists some motion */
    double softness;
    size_t iterations;                                 /* of conjugate gradients, all states */
    /* of evaluation; of these without a strain; points without a bond; parts beside the largest */
    size_t points, degenerate, isolated, fragments;
    double blind[3];                                   /* where the first of `degenerate` is, m */
    double worst[3];                                   /* the node whose displacement is furthest off, m */
    double seconds;
} pg_patch;
typedef struct { char name[32]; double from[3], to[3]; } pg_gauge;      /* opening along from -> to, m */

/* The relative displacement b - a of its ends along the line between them, m; positive when they move
 * apart. */
double pg_gauge_opening (const pg_gauge *gauge, int dim, const double *a, const double *b);

/* An interface between two materials with a fracture energy (J/m^2) and a tensile strength (Pa; NAN: none) of
 * its own. */
typedef struct { int material[2]; double energy, strength; } pg_interface;

/* Velocity of the points of a set at the start, per component, m/s; NULL: at rest. */
typedef struct { const pg_set *set; pg_expression *value[3]; } pg_initial;

/* What a force tells the model about itself before any of it exists: what it stands on, which keys it reads,
 * what it can carry. Every force has one of these in its own file (src/mechanics/force/<name>.c). The
 * model asks these
 * flags and calls these functions; it compares no names. */
typedef struct {
    const char *name, *summary;
    /* Tables of its keys below `method` (beside those that every force reads); forces may share them. Keys of
     * other forces that the scene gives are listed as ignored. */
    const pg_key_table *keys[6];
    /* 1: a weak form with the shape functions of method.approximation, on points of evaluation and boundary
     * facets. 0: bonds between the points themselves carry the force: rows[PG_NODES] come from
     * pg_problem.sums, without the own point, and PG_POINTS and PG_FACETS are empty. */
    int         shape_functions;
    int         rotations[4];  /* rotational degrees of freedom of a point, by the dimension of the body */
    int         anisotropic;   /* 1: carries any material, by its tangent; 0: isotropic ones, by E and nu */
    int         shows;         /* PG_NEEDS_...: what its bonds can show to a failure criterion */
    /* PG_NEEDS_...: where `failure` names no criterion, the first that judges by these; 0: by the
     * stretch, if the scene gives limits of it. */
    int         judged_by;
    /* Without shape functions: kernel and horizon (spacings) where the scene gives none. */
    const char *kernel;
    double      horizon;
    /* Static systems of more unknowns than this are solved by conjugate gradients instead of a factor, by the
     * dimension of the body: with the multilevel preconditioner, and with the diagonal alone. 0: never. */
    double      iterate_above[2][4];
    /* 1: forces reach the neighbours of neighbours, so that there is no matrix. NULL: they never do. */
    int       (*long_range) (const pg_scene *scene);
    /* Without shape functions: how far behind its tip a crack that grows by facets cuts, in spacings. NULL:
     * up to the tip. */
    double    (*tip_offset) (const pg_problem *problem);
    /* Without shape functions: how its bonds are summed, on a lattice or not (also for forecasts). */
    void      (*rule) (pg_sum_rule *out, const pg_scene *scene, pg_mode mode, const pg_approx *approx,
                       double spacing, int lattice);
    /* Reads its keys once points, materials and the approximation are there: sets `integration`, `sums`
     * (without shape functions) and, in one block of memory, `options`. What is wrong becomes a fault of
     * the scene. */
    pg_status (*read) (pg_problem *problem, const pg_scene *scene);
    /* How entry i of `boundary` holds its displacement. NULL: as a constraint on the points of its set. */
    void      (*support) (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
    /* How many horizons of ghosts its points and their bonds need around a subdomain (perigal/ranks.h);
     * 0: the force cannot be divided among ranks so far. */
    double    ghosts;
    /* Forces evaluated in cells: spacings by which the layer of ghosts is wider than `ghosts` horizons;
     * *beyond: spacings by which the layer of cells around owned points exceeds one horizon. NULL: others. */
    double  (*ghost_cells) (const pg_scene *scene, double *beyond);
    /* Completes what failure criteria derive their constants from. NULL: nothing to add. */
    pg_status (*limits) (const pg_problem *problem, size_t material, pg_criterion_setting *setting);
    /* Last checks, as faults: once criteria are read; once every point has its material. NULL: none. */
    void      (*check_laws) (const pg_problem *problem, const pg_scene *scene);
    void      (*check_points) (const pg_problem *problem, const pg_scene *scene);
    /* The stiffest support, as a factor of E / spacing, for an estimate of the largest frequency. NULL: 0. */
    double    (*support_stiffness) (const pg_problem *problem);
    /* The choices of the method in one line: "rkpm, linear basis, cubic_spline kernel, gauss integration". */
    void      (*words) (const pg_problem *problem, char *text, size_t size);
    /* NULL, or why this force does not go with solvers of these flags (PG_SOLVER_...): a sentence for the
     * user that ends in what to do, static text. NULL entry: goes with all. */
    const char *(*refuses) (const pg_problem *problem, unsigned solver);
} pg_method;
/* 1: static systems of so many unknowns are cheaper by conjugate gradients than by a factor (stored rates,
 * bench/equilibrium.c). preconditioned: the force gives the rows that the multilevel preconditioner needs. */
int pg_method_iterates (const pg_method *method, int preconditioned, int dim, double dofs);
/* The entry of a catalogue (ends with NULL) that the scene asks for. */
const pg_method *pg_method_of (const pg_method *const *methods, const pg_scene *scene);
/* Approximation and horizon that the scene asks of a force, at this spacing, m. PG_E_SCENE. */
pg_status pg_method_approx (pg_approx *out, const pg_method *method, const pg_scene *scene, double spacing);

/* What of a material is an expression of place, by PG_OF_... of perigal/criterion.h. */
typedef struct {
    pg_expression *of[PG_OF_COUNT];                    /* NULL: a number, or not given */
    double reference[PG_OF_COUNT];                     /* mean over all nodes: what constants derive from */
    double least[PG_OF_COUNT], mean[PG_OF_COUNT], most[PG_OF_COUNT];   /* over the nodes of the material */
} pg_variation;
/* Points of a bond set that a rank holds: which it owns, and their numbers in the whole body, ascending and
 * the same on all ranks that hold them (n). */
typedef struct { unsigned char *owned; int64_t *number; } pg_held_points;
/* Values of shape functions with all bonds alive, N, dN, w and grades alone: of the sets PG_NODES and
 * PG_POINTS, and with consistent integration those of its wider rows. They were evaluated by the patch test;
 * forces read them as long as no bond of theirs is broken. K: the stiffness of the evaluation points, without
 * supports, for the force that takes it first (then NULL); NULL: the patch test has not assembled it, or the
 * materials of the run are others. wanted: 1, the force that is freed next, of the patch test, leaves its
 * rows here, 2: and K. */
typedef struct pg_intact {
    pg_rows rows[PG_BOND_SETS], sums;
    struct pg_assembly *K;
    int wanted;
} pg_intact;
/* ---- parts of a problem -------------------------------------------------------------------------------- */
/* The cracks that a problem begins with. */
typedef struct {
    pg_cracks given, slots;  /* of the scene; slots cut bonds and have no tips */
    pg_tip  *tip;  size_t ntip;                        /* 2D: the tips of the pre-cracks */
    pg_front *front;  size_t nfront;                   /* 3D: the fronts of the pre-cracks */
    /* Distance behind a tip from which its crack cuts, where the spacing is cloud.h, m; of a tip whose faces
     * touch (pg_tip_draw_back). */
    double   tip_offset, closed_tip_offset;
    struct pg_body_search *search;                     /* where the body is; NULL: nobody asks */
    size_t   eroded;                                   /* points that lie on a pre-crack */
} pg_start_cracks;
/* Stiffness and limits that are expressions of place (laws.c). law_of: which of the nlaw elastic laws holds
 * at each point, limit_of: which of the nlimit criteria. Where nothing varies they are material, nmaterial
 * and block, criterion, nmaterial and block of the problem themselves. */
typedef struct {
    pg_material  *law;    size_t nlaw;    int *law_of[PG_BOND_SETS];
    pg_criterion *limit;  size_t nlimit;  int *limit_of[PG_BOND_SETS];
    pg_variation *vary;                                /* per material; NULL: all are numbers */
    pg_interface *interface; size_t ninterface;        /* failure.interfaces */
} pg_point_laws;
/* The approximation of the displacement, and where the weak form is evaluated. */
typedef struct {
    pg_approx approx;
    const pg_integration_type *integration;
    pg_consistency *consistency;                       /* integration: consistent; else NULL */
    /* dilatation of patches where Poisson's ratio is near 1/2; NULL: at the points everywhere */
    pg_patches *patches;
} pg_discretization;
/* What acts on the body, what holds it, what is measured of it. */
typedef struct {
    pg_load *load;   size_t nload;
    pg_platen *platen; size_t nplaten;
    pg_stage *stage; size_t nstage;                    /* none: one path, t from 0 to 1 */
    pg_gauge *gauge; size_t ngauge;
    pg_expression *initial[3];  /* velocity at the start per component, m/s; NULL: at rest */
    pg_initial *motion;  size_t nmotion;               /* velocities of sets in its place; later ones count */
} pg_loading;
/* The bond sets: which nodes their points see, by geometry alone. */
typedef struct {
    pg_rows  rows[PG_BOND_SETS];                       /* N, dN, w, grade are NULL */
    int      wide_at_cracks;  /* 1: cracks make supports of nodes or evaluation points wider */
    pg_held_points held[PG_BOND_SETS];                 /* of ranks that share the body; else NULL */
    double  *facet_normal;  /* outward unit normal at the points of PG_FACETS (n x dim) */
    size_t   first[PG_BOND_SETS + 1];                  /* bond b of set k is alive[first[k] + b] */
    double  *spacing[PG_BOND_SETS];  /* local spacing of every point (its nearest node's), m; NULL: h */
    unsigned char *exempt[PG_BOND_SETS];  /* per point: its bonds never break (failure: exclude, never) */
    int      facet_order;                              /* points per direction of a boundary facet */
} pg_bond_points;
/* How good the discretisation is. */
typedef struct {
    int      thickness_assumed;  /* 1: cloud.thickness is not that of the scene, but 1 */
    int      accept_inexact;  /* method.accept_inexact: no measured patch error is too large */
    struct pg_intact *intact;  /* shape functions of the intact body; NULL: nobody has evaluated them */
    pg_patch patch;  /* how well the discretisation carries uniform stress */
    /* bare: per facet, bit k: a support on points bears component k (pg_patch_probe); else NULL */
    unsigned char *borne;
} pg_quality;
/* What the plan says: keys without meaning, constants taken otherwise. */
typedef struct { char text[16][224];  size_t n; } pg_notes;
struct pg_problem {
    char     title[256], name[64];                     /* name: of the scene's folder or file */
    int      dim, threads;
    int      plain;                                    /* 1: no shortcuts (solver.plain) */
    int      equilibria;  /* 1: solver.kind finds equilibria by linear systems */
    pg_mode  mode;
    pg_body  body;  pg_mesh_body part;                 /* one of them, or none: points of a file */
    pg_between *between;                               /* what parts the points; NULL: nothing does */
    pg_lattice lattice;  pg_cloud cloud;  pg_cells cells;  pg_sets sets;
    pg_start_cracks crack;
    pg_material  *material;  size_t nmaterial;
    pg_criterion *criterion;  /* per material, all of one type; type NULL: nothing breaks */
    int          *block[PG_BOND_SETS];                 /* material of every point of a bond set */
    pg_point_laws at;                                  /* laws of the points */
    pg_discretization form;
    const pg_method *method;                           /* the force, as the scene asks for it */
    const pg_method *const *methods;                   /* all there are; ends with NULL */
    void    *options;                                  /* what method->read made of the keys; NULL: nothing */
    pg_sums *sums;                                     /* without shape functions; else NULL */
    pg_loading boundary;
    pg_bond_points bonds;
    pg_quality quality;
    pg_notes notes;
};
/* 1: the point of the bond set is owned by this rank, or there are no ranks. */
static inline int pg_problem_owns (const pg_problem *p, int set, size_t point)
{
    return !p->bonds.held[set].owned || p->bonds.held[set].owned[point];
}
/* A remark on the scene, as printf. One that begins with PG_WARNING counts among the warnings of the run
 * (pg_solver_doubts), others among its notes (pg_solver_note). At most 16 are kept. */
#define PG_WARNING "warning: "
void pg_problem_note (pg_problem *problem, const char *format, ...) __attribute__ ((format (printf, 2, 3)));
/* A problem from a scene, in two halves, so that faults of solver and output can be found beside those of the
 * problem. prepare: all but the bonds, also of a scene with faults that do not keep it from that (they are
 * passed by, pg_scene_pass; *out then serves to look for more of them only). complete: PG_E_SCENE with all
 * faults if there are any, else the bonds. `methods`: the forces there are, which this layer does not know;
 * programs call pg_problem_prepare and pg_problem_build of perigal/force.h, which hand them down. */
pg_status pg_problem_prepare_with (pg_problem **out, const pg_scene *scene, const pg_method *const *methods,
                                   int threads);
pg_status pg_problem_complete (pg_problem *problem, const pg_scene *scene);
void      pg_problem_free  (pg_problem **problem);
/* The discretisation of `problem` without loads, supports, cracks and failure, all of its material with the
 * largest Poisson's ratio; the one load left is a traction of zero on all facets, and PG_FACETS are points on
 * all of them (none without shape functions). *out borrows from `problem`. */
pg_status pg_problem_bare  (pg_problem **out, const pg_problem *problem);
void      pg_problem_bare_free (pg_problem **bare);
/* The bond set and the point of that set that own a bond (an index into state->alive). */
void      pg_problem_locate (const pg_problem *problem, size_t bond, int *set, size_t *point);
/* Of each point of a set (PG_NODES ...) the number that it has however the points of the body are divided
 * among processes (pg_free). PG_E_LIMIT: there is none. */
pg_status pg_problem_numbers (const pg_problem *problem, int set, int64_t **number);
int       pg_problem_rotations (const pg_problem *problem);            /* of every point */
int       pg_problem_unknowns  (const pg_problem *problem);            /* of every point: dim + rotations */
/* The box of the body, m (dim each); of points of a file or mesh: of the points. */
void      pg_problem_box (const pg_problem *problem, double *low, double *high);
double    pg_problem_spacing (const pg_problem *problem, int set, size_t point);   /* local, m */
/* The elastic law and the criterion of a point of a set. */
static inline const pg_material *pg_problem_law (const pg_problem *p, int set, size_t point)
{
    return &p->at.law[p->at.law_of[set][point]];
}
static inline const pg_criterion *pg_problem_limit (const pg_problem *p, int set, size_t point)
{
    return &p->at.limit[p->at.limit_of[set][point]];
}
/* 1: the stiffness of a material is an expression of place. */
int       pg_problem_graded (const pg_problem *problem);
/* The name of what varies, "youngs_modulus", and its unit. */
const char *pg_variation_name (int of, const char **unit);
/* The k-th line about what varies: mean, least and largest value; 0: there are no more. */
size_t    pg_variation_words (const pg_problem *problem, size_t k, char *text, size_t size);
/* The entry for two materials, in any order; NULL: there is none. */
const pg_interface *pg_problem_interface (const pg_problem *problem, int a, int b);
/* 1: entry `e` of the family of a point of a set has no length: its node is the point itself, or lies within
 * PG_NO_LENGTH of the local spacing of it (an evaluation point in the middle of a cell of `lattice: cells`).
 * It has no direction and no stretch: no criterion judges it, it never breaks, and damage does not count
 * it. */
int       pg_problem_no_bond (const pg_problem *problem, int set, size_t point, size_t e);
/* What is true of an entry of the catalogue of solvers; each says so of itself in src/solve/<name>.c. Loads,
 * supports, forces, forecasts, results and commands ask for these, never for a name. */
enum {
    PG_SOLVER_QUASI_STATIC = 1,                        /* the t of loads is the load factor, 0 to 1; else s */
    PG_SOLVER_IMPLICIT = 2,                            /* solves linear systems: forces must be linear in d */
    PG_SOLVER_EXPLICIT = 4,                            /* time steps of a stable length, by the force alone */
    PG_SOLVER_STAGED = 8,  /* stages of the load, each relaxed by the force alone */
    PG_SOLVER_EVENTS = 16,                             /* knows event stepping */
    PG_SOLVER_NEEDS_DENSITY = 32,
    PG_SOLVER_CONTACT = 128,                           /* knows contact of crack faces */
    PG_SOLVER_FACETS = 64,                             /* lets cracks grow by facets */
    PG_SOLVER_RANKS = 256,                             /* ranks may share a run (perigal/ranks.h) */
    PG_SOLVER_STATIC = PG_SOLVER_QUASI_STATIC | PG_SOLVER_IMPLICIT     /* equilibria by linear systems */
};
/* What pg_rank_count ranks that divide the body cannot do so far, as faults of the scene. PG_E_SCENE. */
pg_status pg_subdomain_check  (const pg_method *method, const pg_scene *scene);
/* 1: nothing of that is in the scene, and nothing that may be found when the problem is built. */
int       pg_subdomain_can    (const pg_method *method, const pg_scene *scene);
/* The layer of ghosts around their parts, m; h: the nominal spacing of the points, m. */
pg_status pg_subdomain_width  (double *width, const pg_method *method, const pg_scene *scene, int dim,
                               double h);
/* 1: its cracks grow by facets: the criterion judges their tips (2D). */
int       pg_problem_grows (const pg_problem *problem);
int       pg_problem_proportional (const pg_problem *problem);  /* every load is a constant pattern times t */
/* every load is a constant pattern and t times another, t from 0 to 1 */
int       pg_problem_affine (const pg_problem *problem);
/* A copy of the problem with tables of loads of its own, for a run whose stages may end early; all else is
 * borrowed. */
pg_status pg_problem_staged      (pg_problem **out, const pg_problem *problem);
void      pg_problem_staged_free (pg_problem **staged);
/* The loads as they are where stage k ends at the share share[k] (0 to 1) of its way; NULL: all at 1. */
void      pg_stages_follow       (pg_problem *staged, const double *share);
/* The live bonds of the nodes that a stage (from 0) removes, and of the points of evaluation and facets that
 * are nearest to one of them: ascending, each once. */
pg_status pg_stage_removes       (const pg_problem *problem, size_t stage, const unsigned char *alive,
                                  pg_changes *out);
int       pg_problem_removes     (const pg_problem *problem);          /* 1: some stage removes something */
/* 1: a load changes in that stage (from 0). */
int       pg_stage_loads         (const pg_problem *problem, size_t stage);

/* Parts of pg_state_create and of checkpoints: the cracks that a problem begins with, and what of them is
 * kept. */
pg_status pg_crack_paths_create (pg_crack_paths **out, const pg_problem *problem);
pg_status pg_crack_paths_keep   (pg_crack_paths *paths, const pg_problem *problem, const char *name,
                                 const pg_keeper *keeper);
pg_status pg_crack_surfaces_create (pg_crack_surfaces **out, const pg_problem *problem);
pg_status pg_crack_surfaces_keep   (pg_crack_surfaces *surfaces, const pg_problem *problem, const char *name,
                                    const pg_keeper *keeper);

/* ---- state: one block and the paths of its cracks; copyable, comparable, savable ----------------------- */
typedef struct {
    size_t  ndof, nbond, bytes;
    double  time;                                      /* s; static: load factor of the last report */
    double  factor;                                    /* load factor (static) */
    long    step, events, iterations, broken, history_rows;
    double  work;                                      /* external work so far, J */
    double *d, *v, *a;  /* coefficients, velocity, acceleration (ndof): m, m/s, m/s^2 */
    unsigned char *alive;                              /* 1: the bond lives (nbond) */
    pg_crack_paths *paths;                             /* 2D; NULL: cracks do not grow */
    pg_crack_surfaces *surfaces;                       /* 3D where cracks grow; else NULL */
} pg_state;
/* At rest, or with the problem's initial velocity; pre-cracks cut. */
pg_status pg_state_create (pg_state **out, const pg_problem *problem, int components /* dofs per node */);
pg_status pg_state_copy   (pg_state *to, const pg_state *from);
/* All but the alive bits, of a copy whose caller knows which of them differ. */
pg_status pg_state_copy_fields (pg_state *to, const pg_state *from);
/* Alive bits at the start of the bonds of one point of a set: 0 where a pre-crack cuts. */
void      pg_bonds_cut_at (const pg_problem *problem, int set, size_t point, unsigned char *alive);
void      pg_state_free   (pg_state **state);
/* The cracks that exist in a state (NULL: at the start), for all who ask whether one lies between two
 * places: bonds, sampling, gauges, pictures. Damage is not among them. */
const pg_cracks *pg_state_cracks (const pg_problem *problem, const pg_state *state);

/* Grows tip number `tip` in a straight line to `to` (m): adds a facet, moves the tip, and lets the path cut
 * up to its offset behind the tip. All live bonds that the path now cuts, of every bond set, are added to
 * `cut`, which stays ascending and names each once; their alive bits are left to the caller. close: 1: the
 * tip ends there, on the surface or on another crack, and the path cuts to its end, on the surface a spacing
 * further; a tip of another crack whose offset is not shorter than the distance to `to` ends with it.
 * PG_E_USAGE: no such open tip, or no length. Nothing is changed by a call that fails, except `cut`. */
pg_status pg_crack_grow  (pg_state *state, const pg_problem *problem, size_t tip, const double *to, int close,
                          pg_changes *cut);
/* A new crack; bit 0, 1 of open: its end `from`, `to` is a tip; PG_START_SLIDES: its faces touch and slide
 * (closed_tip_offset). Other ends lie on the surface or on another crack. */
pg_status pg_crack_start (pg_state *state, const pg_problem *problem, const double *from, const double *to,
                          int open, pg_changes *cut);
/* At the start of a run: the path of a tip that has not grown cuts only from `offset` (m) behind it on, if
 * that is more than so far and no more than a share of the path; bonds that it cuts no more live again. */
void      pg_tip_draw_back (pg_state *state, const pg_problem *problem, size_t tip, double offset);
/* Points per spacing at which the faces of a crack are sampled, and the parts of equal length of so much of a
 * crack (m, at a local spacing h) in whose middle they lie. */
#define PG_CRACK_POINTS 8
static inline size_t pg_crack_intervals (double length, double h)
{
    double n = ceil (PG_CRACK_POINTS * length / h - 1e-9);
    return n > 1 ? (size_t) n : 1;
}
/* Where the straight piece of a crack from a to b crosses the borders of background cells with consistent
 * integration, in the plane: shares of the way, ascending, 0 and 1 among them (the caller frees). */
pg_status pg_crack_breaks (const pg_problem *problem, const double *a, const double *b, size_t *n,
                           double **share);
pg_ground pg_problem_ground (const pg_problem *problem);
/* Is there body at x? Points of a file have no surface: a place is in the body if a point is near. */
int       pg_problem_has_body (const pg_problem *problem, const double *x);
/* Local spacing at x: that of the nearest point, m. */
double    pg_problem_spacing_at (const pg_problem *problem, const double *x);
/* The fronts that exist in a state (NULL: at the start). */
const pg_front *pg_fronts_of_state (const pg_problem *problem, const pg_state *state, size_t *n);
/* Moves vertex i of an open front by d[i] (m; 0: it stays) in the direction cos theta[i] ahead + sin theta[i]
 * normal (rad), and adds the triangles between where the crack cut before and where it cuts now. Vertices
 * that come within 1.5 spacings of the surface ahead, or within 0.6 of another crack or front, go straight
 * there and are closed; a front is parted where vertices are closed, and ends where none is left. Ends are
 * put on the surface of the body; vertices are distributed anew where they lie too far apart or too close.
 * All live bonds that the new triangles cut, of every bond set, are added to `cut`, which stays ascending
 * and names each once; their alive bits are left to the caller. PG_E_USAGE: no such open front, nothing
 * moves. Nothing is changed by a call that fails, except `cut`. d, theta NULL: the front grows no more, and
 * its crack cuts to its end. */
pg_status pg_front_advance (pg_state *state, const pg_problem *problem, size_t front, const double *d,
                            const double *theta, pg_changes *cut);
/* A new crack: the convex polygon of n places (n x 3, m) in a plane of unit normal `normal`; what of its
 * outline lies inside the body is a front. */
pg_status pg_surface_start (pg_state *state, const pg_problem *problem, size_t n, const double *x,
                            const double *normal, pg_changes *cut);

/* ---- costs of linear solves, forces on shape functions ------------------------------------------------- */
typedef struct {
    int    dim, components, order;                     /* unknowns of a point; order of the basis */
    int    interpolates;                               /* 1: N is the identity at the nodes */
    int    projected;                                  /* 1: the dilatation is projected (near nu = 1/2) */
    /* 1: points at the centres of cells, behind the surface, where the supports are */
    int    behind;
    int    scattered;                                  /* 1: nodes are evaluated and form no lattice */
    double points, evaluation, bonds;  /* of evaluation; evaluation-point-to-node bonds */
    double reach;                                      /* horizon over spacing */
    double edge[3];                                    /* nodes along the body */
    /* Right-hand sides that every matrix is solved with beside the loads: forces between faces of cracks. */
    double columns;
} pg_solve_counts;
pg_solve_counts pg_solve_count (const pg_problem *problem);
/* 1: finite elements on a coarse grid precondition such a body, 0: on all its nodes. */
int    pg_solve_on_grid (const pg_solve_counts *c);
/* Seconds, by stored rates: assembly; the same with analysis and factor; one solve with finite elements. */
double pg_solve_assembly_cost (const pg_solve_counts *c);
double pg_solve_direct_cost   (const pg_solve_counts *c);
double pg_solve_elements_cost (const pg_solve_counts *c);
/* Seconds of K x for each bond. */
static const double pg_solve_apply_rate = 4e-9;
/* 1: systems are solved by conjugate gradients. available: finite elements can be had as preconditioner;
 * events: a factor would serve many events; motion: implicit dynamics, where the diagonal does not do. */
int    pg_solve_by_elements   (const pg_solve_counts *c, int available, int events, int motion);
PG_API_END
#endif
