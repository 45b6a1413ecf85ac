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
    PG_SPRING,                                         /* springs to a fixed or moving position */
    PG_EIGENSTRAIN,  /* free strain: temperature, shrinkage, pore pressure */
    PG_PLATEN_MOTION,                                  /* displacement of a rigid platen, m; set is empty */
    PG_PLATEN_FORCE                                    /* force on a rigid platen, N; set is empty */
} pg_load_kind;
typedef struct pg_problem pg_problem;
typedef enum { PG_ESSENTIAL_NITSCHE, PG_ESSENTIAL_TRANSFORMATION, PG_ESSENTIAL_PENALTY } pg_essential;
typedef struct pg_load {
    char           name[64];
    pg_load_kind   kind;
    const pg_set  *set;
    int            platen;                             /* 1 + number of the platen it acts on; 0: none */
    /* 1: a uniform pressure in all cracks, new ones included; the set is empty */
    int            cracks;
    /* value per component (by kind m, m/s, Pa, N, N/m^3, rad, N m), NULL: free; 2D rotation, moment: [0],
     * about z */
    pg_expression *value[3];
    pg_expression *ramp;                               /* factor as a function of t; NULL: from the table */
    double        *table; size_t ntable;               /* ntable x 2: t (s), factor */
    int            proportional;                       /* 1: the factor is t itself */
    /* forces without shape functions: a traction or pressure acts on the points down to this depth, m; 0: on
     * the outermost ones */
    double         depth;
    pg_essential   essential;                          /* how PG_DISPLACEMENT and PG_VELOCITY are imposed */
    double         penalty;  /* PG_ESSENTIAL_PENALTY: penalty stiffness over E / h, h the local spacing */
    double         about[3];                           /* reference point of moments, m */
    /* turns: 1: the set rotates about `about` as a rigid body, by these angles about x, y, z (rad; NULL: 0);
     * finite: 1: finite rotations, 0: linearised. `value` then only says which components are prescribed. */
    int            turns, finite;  pg_expression *angle[3];
    int            symmetry;                           /* 1 + axis normal to a plane of symmetry; 0: none */
    int            weighs;                             /* 1: body force = value times density (weight) */
    /* total force on faces: area, m^2, thickness included, by which its value (N) is divided to give a
     * traction; 0: values of other loads are not divided */
    double         over_area;
    /* A force or spring at a position `at`, m: weights of the points around it, with sum 1 and centroid `at`
     * (set->npoint); NULL: equal weights of the points of the set. own: set allocated for this load. */
    double         at[3], *share;  pg_set *own;
    double         stiffness[3];                       /* spring stiffness along x, y, z, N/m */
    /* Eigenstrain: factor of the value in each material that gives the isotropic free strain
     * (pg_problem.nmaterial), such as an expansion coefficient, 1/K. */
    double        *per_material;
} pg_load;
/* Reactions per load: component k of the force of load l on the body, N (rotations and moments: N m), at
 * index 3 l + k of an array; component k of its moment about pg_load.about, N m, at index 3 (nload + l) + k
 * (2D: k = 2). */
enum { PG_REACTIONS = 6 };
/* Adds the moment about load->about of a force (N) along axis k at x (m) to moment (3, N m). */
void pg_load_add_moment (const pg_load *load, int dim, const double *x, int k, double force, double *moment);
/* 1: this rank owns the facet, so that sums over ranks count it once; serial runs: always 1. */
int  pg_problem_owns_facet (const pg_problem *problem, size_t facet);
/* Largest number of points per direction with PG_ESSENTIAL_TRANSFORMATION: keeps dense matrices below 300
 * MB. */
#define PG_MOST_ELIMINATED 6000
/* Component k of the load at x (m) and time t (s; static: load factor), in the unit of its kind. */
double pg_load_value (const pg_load *load, int k, int dim, const double *x, double t);
/* 1: the load is a function of position (pg_load_pattern) times a function of t (pg_load_factor);
 * pg_load_value is then exactly their product. */
int    pg_load_separates (const pg_load *load);
double pg_load_factor  (const pg_load *load, double t);
double pg_load_pattern (const pg_load *load, int k, int dim, const double *x);
pg_place pg_place_of (int dim, const double *x, double t);             /* variables of expressions at x */
/* Factor of a body force at a point of a bond set: the density, kg/m^3, if load->weighs, else 1. */
double pg_load_density (const pg_problem *problem, const pg_load *load, int set, size_t point);
/* 1: there are loads PG_EIGENSTRAIN: free strain by temperature, shrinkage or pore pressure. */
int    pg_problem_strained    (const pg_problem *problem);
/* 1: whether a bond breaks follows from the displacements of its two ends alone, by the same limit for all
 * bonds (one criterion with pg_criterion_type.elongation, no free strains, no graded points). */
int    pg_problem_breaks_by_elongation (const pg_problem *problem);
/* 1: cracks of the scene grow by facets; known as soon as the force, the points and the materials are. */
int    pg_problem_by_facets (const pg_problem *problem, const pg_scene *scene);
/* Weight of point i of the load's set in a total force or a spring; position at which its value is evaluated:
 * x of the point, or load->at. */
double pg_load_share (const pg_load *load, size_t i);
const double *pg_load_site (const pg_load *load, const double *x);
int    pg_load_prescribes (const pg_load *load);       /* 1: displacement, velocity or rotation */
int    pg_load_rotates (const pg_load *load);            /* 1: rotation or moment */
int    pg_load_components (const pg_load *load, int dim);  /* dim; of a rotation or moment 1 in 2D, 3 in 3D */
char   pg_load_axis (const pg_load *load, int dim, int k);             /* 'x', 'y', 'z' of component k */

/* A stage of loading (key `stages`). Stage k (from 1) runs from t = k - 1 to t = k; its load factors change
 * linearly to their targets; it ends early when one of its conditions is met. */
typedef struct {
    char    name[64];
    /* load factor of each load at the end of the stage; NAN: unchanged (nload) */
    double *target;
    long    steps;                                     /* stepping: fixed: load steps; 0: solver.steps */
    int     gauge;  double opening;                    /* ends at this opening (m) of a gauge; -1: none */
    /* ends when the force of this load (-1: none) has dropped by this fraction of its maximum */
    int     load;   double drop;
    /* points removed from the body in this stage; NULL: none */
    const pg_set *remove;
    long    events;                                    /* ends after so many events; 0: no limit */
    double  growth;  /* ends at this crack growth in the stage, m (3D: m^2); 0: no limit */
} pg_stage;

/* A rigid platen or indenter (key `platens`): it is in frictional contact with the body. It is moved by loads
 * of its own, which follow those of `boundary` in pg_loading.load. Components with neither a displacement nor
 * a force are fixed. */
typedef enum { PG_PLATEN_PLANE, PG_PLATEN_CYLINDER, PG_PLATEN_SPHERE } pg_platen_shape;
typedef struct {
    char   name[64];
    pg_platen_shape shape;
    /* point of the plane; centre of the sphere or 2D cylinder; point of the axis of a 3D cylinder, m. The
     * platen rotates about it */
    double point[3];
    /* plane: unit normal towards the body; 3D cylinder: unit vector along its axis */
    double normal[3];
    double radius;                                     /* radius of cylinder or sphere, m */
    double width;  /* plane: width about `point` (3D: diameter), m; INFINITY: unbounded */
    int    concave;                                    /* 1: the body lies inside cylinder or sphere */
    double friction;                                   /* Coulomb's coefficient */
    int    tilts;                                      /* 1: free to rotate (zero moment) */
    int    free[3];                                    /* 1: free to move along that axis, under its force */
    int    motion, force;                              /* indices of its loads; -1: none */
    double mass, velocity[3];  /* dynamics: mass, kg (0: none); initial velocity, m/s */
} pg_platen;
/* Distance of x (m) from the initial surface of the platen, m; negative: inside it. INFINITY: beside a platen
 * of finite width. normal (dim): unit, from the platen towards the body. */
double pg_platen_distance (const pg_platen *platen, int dim, const double *x, double *normal);

/* ---- problem ------------------------------------------------------------------------------------------- */
/* Bond sets: points of a kind (nodes, evaluation points, points on boundary facets) with their bonds to
 * nodes. Alive bits of all sets are in pg_state. */
enum { PG_NODES, PG_POINTS, PG_FACETS, PG_BOND_SETS };
/* The patch test of a discretisation: the body without cracks and supports, of one material, under the
 * tractions of a uniform stress on its whole surface; the exact displacement is linear. Values are those of
 * the worst state of stress, except for the counts. */
typedef struct {
    int    measured;                                   /* 0: not (yet) measured: the numbers below are NAN */
    /* relative error of the displacement: root mean square, or |compliance| if that is larger */
    double error;
    double compliance;  /* work of the tractions over the exact work, less 1; > 0: too soft */
    int    state;                                      /* component of the stress, Voigt order */
    /* 1: no facets: the outermost points are fixed to the linear field instead, compliance is NAN */
    int    held;
    int    settled;                                    /* 0: iterations ended early, error is a lower bound */
    /* largest strain measure of a rigid motion (translation by the radius of the body, rotation by 1 rad),
     * from its energy and the work of uniform tractions; of the size of rounding if rigid motions are
     * strain-free */
    double rigid;
    /* mean energy of the response to random unit forces: about 1 (small bodies 10); 1e9 and more: some motion
     * has almost no stiffness */
    double softness;
    size_t iterations;                                 /* of conjugate gradients, all stress states */
    /* numbers of evaluation points; of these without a strain; of points without a bond; of parts beside the
     * largest */
    size_t points, degenerate, isolated, fragments;
    double blind[3];                                   /* position of the first degenerate point, m */
    double worst[3];                                   /* position of the node with the largest error, m */
    double seconds;
} pg_patch;
/* displacement gauge between two points, m */
typedef struct { char name[32]; double from[3], to[3]; } pg_gauge;

/* Opening of a gauge, m: relative displacement b - a of its ends (displacements a, b, m) along the line
 * between them, positive when they move apart. */
double pg_gauge_opening (const pg_gauge *gauge, int dim, const double *a, const double *b);

/* Interface between two materials with its own fracture energy (J/m^2) and tensile strength (Pa; NAN:
 * none). */
typedef struct { int material[2]; double energy, strength; } pg_interface;

/* Initial velocity of the points of a set, per component, m/s; NULL: 0. */
typedef struct { const pg_set *set; pg_expression *value[3]; } pg_initial;

/* Properties of a force model, available before the force is created: its discretisation, keys and
 * capabilities. Every force has one of these in its own file (src/mechanics/force/<name>.c). The model uses
 * only these flags and functions; it compares no names. */
typedef struct {
    const char *name, *summary;
    /* Tables of its keys below `method` (besides those that every force reads); forces may share tables. Keys
     * of other forces that the scene gives are listed as ignored. */
    const pg_key_table *keys[6];
    /* 1: a weak form with the shape functions of method.approximation, with evaluation points and boundary
     * facets. 0: bonds between the points themselves carry the force: rows[PG_NODES] come from
     * pg_problem.sums, without the own point, and PG_POINTS and PG_FACETS are empty. */
    int         shape_functions;
    int         rotations[4];  /* rotational degrees of freedom of a point, by the dimension of the body */
    /* 1: supports any material, by its stiffness D; 0: isotropic ones only, by E and nu */
    int         anisotropic;
    int         shows;         /* PG_NEEDS_...: measures it can provide to a failure criterion */
    /* PG_NEEDS_...: if `failure` names no criterion, the first one that uses these measures is taken; 0: that
     * of stretch, if the scene gives limits of it. */
    int         judged_by;
    /* Forces without shape functions: default kernel and horizon (in spacings). */
    const char *kernel;
    double      horizon;
    /* Static systems of more unknowns than this are solved by conjugate gradients instead of a factor, by the
     * dimension of the body: with the multilevel preconditioner, and with the diagonal alone. 0: never. */
    double      iterate_above[2][4];
    /* 1: forces reach the neighbours of neighbours, so that there is no matrix. NULL: they never do. */
    int       (*long_range) (const pg_scene *scene);
    /* Forces without shape functions: distance behind its tip, in spacings, up to which a crack that grows by
     * facets cuts bonds. NULL: up to the tip. */
    double    (*tip_offset) (const pg_problem *problem);
    /* Forces without shape functions: sets the rule by which bonds are summed, on a lattice (lattice = 1) or
     * not; also used for forecasts. */
    void      (*rule) (pg_sum_rule *out, const pg_scene *scene, pg_mode mode, const pg_approx *approx,
                       double spacing, int lattice);
    /* Reads the keys of the force once points, materials and the approximation are there: sets `integration`,
     * `sums` (without shape functions) and, in one block of memory, `options`. Errors become errors of the
     * scene. */
    pg_status (*read) (pg_problem *problem, const pg_scene *scene);
    /* Reads how entry i of `boundary` imposes its displacement. NULL: as a constraint on the points of its
     * set. */
    void      (*support) (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
    /* Parallel runs: width of the layer of ghosts around a subdomain, in horizons (perigal/ranks.h); 0: not
     * supported by the force. */
    double    ghosts;
    /* Forces evaluated in cells: spacings by which the layer of ghosts is wider than `ghosts` horizons;
     * *beyond: spacings by which the layer of cells around owned points exceeds one horizon. NULL: others. */
    double  (*ghost_cells) (const pg_scene *scene, double *beyond);
    /* Completes the setting from which failure criteria derive their constants. NULL: nothing to add. */
    pg_status (*limits) (const pg_problem *problem, size_t material, pg_criterion_setting *setting);
    /* Final checks, which report errors of the scene: after criteria are read; after every point has its
     * material. NULL: none. */
    void      (*check_laws) (const pg_problem *problem, const pg_scene *scene);
    void      (*check_points) (const pg_problem *problem, const pg_scene *scene);
    /* The stiffest support, as a factor of E / spacing, for an estimate of the largest frequency. NULL: 0. */
    double    (*support_stiffness) (const pg_problem *problem);
    /* Writes the choices of the method in one line: "rkpm, linear basis, cubic_spline kernel, gauss
     * integration". */
    void      (*words) (const pg_problem *problem, char *text, size_t size);
    /* Returns NULL, or why this force cannot be used with solvers of these flags (PG_SOLVER_...): a sentence
     * for the user with a remedy, static text. Entry NULL: works with all. */
    const char *(*refuses) (const pg_problem *problem, unsigned solver);
} pg_method;
/* 1: static systems of `dofs` unknowns are cheaper by conjugate gradients than by a factor (from stored
 * timings, bench/equilibrium.c). preconditioned: the force gives the rows that the multilevel preconditioner
 * needs. */
int pg_method_iterates (const pg_method *method, int preconditioned, int dim, double dofs);
/* The force model chosen by the scene, from a list that ends with NULL. */
const pg_method *pg_method_of (const pg_method *const *methods, const pg_scene *scene);
/* Reads approximation and horizon of a force model from the scene, at this spacing (m). PG_E_SCENE. */
pg_status pg_method_approx (pg_approx *out, const pg_method *method, const pg_scene *scene, double spacing);

/* Properties of a material that are expressions of position, by PG_OF_... of perigal/criterion.h. */
typedef struct {
    pg_expression *of[PG_OF_COUNT];                    /* NULL: a number, or not given */
    double reference[PG_OF_COUNT];                     /* mean over all nodes, from which constants derive */
    double least[PG_OF_COUNT], mean[PG_OF_COUNT], most[PG_OF_COUNT];   /* over the nodes of the material */
} pg_variation;
/* Parallel runs: the points of a bond set stored on a rank: 1 if it owns the point, and number of the point
 * in the whole body, ascending and equal on all ranks (n). */
typedef struct { unsigned char *owned; int64_t *number; } pg_held_points;
/* Shape functions of the intact body (N, dN, w and grades) for the sets PG_NODES and PG_POINTS, and corrected
 * ones of consistent integration (sums). The patch test evaluates them; forces reuse them for points with all
 * bonds intact. K: the stiffness of the evaluation points, without supports, taken over by the first force
 * that uses it; NULL: taken, not assembled by the patch test, or the run has other materials. wanted: 1: the
 * force of the patch test, when freed, leaves its rows here, 2: also K. */
typedef struct pg_intact {
    pg_rows rows[PG_BOND_SETS], sums;
    struct pg_assembly *K;
    int wanted;
} pg_intact;
/* ---- parts of a problem -------------------------------------------------------------------------------- */
/* The cracks at the start of a run. */
typedef struct {
    pg_cracks given, slots;  /* sharp cracks of the scene; slots, which cut bonds and have no tips */
    pg_tip  *tip;  size_t ntip;                        /* 2D: the tips of the pre-cracks */
    pg_front *front;  size_t nfront;                   /* 3D: the fronts of the pre-cracks */
    /* Distance behind an open tip up to which its crack cuts no bonds, at the spacing cloud.h, m; that of a
     * tip whose faces are in contact (pg_tip_draw_back). */
    double   tip_offset, closed_tip_offset;
    struct pg_body_search *search;                     /* search structure; NULL: not needed */
    size_t   eroded;                                   /* number of points on pre-cracks */
} pg_start_cracks;
/* Elastic laws and criteria per point, for stiffness and limits that are expressions of position (laws.c).
 * law_of: index of the elastic law of each point, limit_of: index of its criterion. Without variation they
 * are material and block, criterion and block of the problem. */
typedef struct {
    pg_material  *law;    size_t nlaw;    int *law_of[PG_BOND_SETS];
    pg_criterion *limit;  size_t nlimit;  int *limit_of[PG_BOND_SETS];
    pg_variation *vary;                                /* per material; NULL: nothing varies */
    pg_interface *interface; size_t ninterface;        /* failure.interfaces */
} pg_point_laws;
/* The approximation of the displacement, and where the weak form is evaluated. */
typedef struct {
    pg_approx approx;
    const pg_integration_type *integration;
    pg_consistency *consistency;                       /* integration: consistent; else NULL */
    /* patches for the projected dilatation where Poisson's ratio is near 1/2; NULL: no projection */
    pg_patches *patches;
} pg_discretization;
/* Loads and supports of the body, initial velocities, stages of loading and gauges. */
typedef struct {
    pg_load *load;   size_t nload;
    pg_platen *platen; size_t nplaten;
    pg_stage *stage; size_t nstage;                    /* nstage 0: one path, t from 0 to 1 */
    pg_gauge *gauge; size_t ngauge;
    pg_expression *initial[3];  /* initial velocity per component, m/s; NULL: 0 */
    /* initial velocities of sets, which override `initial`; later ones prevail */
    pg_initial *motion;  size_t nmotion;
} pg_loading;
/* The bond sets: points and their neighbours, by geometry alone. */
typedef struct {
    pg_rows  rows[PG_BOND_SETS];                       /* N, dN, w, grade are NULL */
    int      wide_at_cracks;  /* 1: cracks make supports of nodes or evaluation points wider */
    pg_held_points held[PG_BOND_SETS];                 /* parallel runs; else NULL */
    double  *facet_normal;  /* outward unit normal at the points of PG_FACETS (n x dim) */
    size_t   first[PG_BOND_SETS + 1];                  /* bond b of set k is alive[first[k] + b] */
    double  *spacing[PG_BOND_SETS];  /* local spacing of every point (its nearest node's), m; NULL: h */
    unsigned char *exempt[PG_BOND_SETS];  /* per point: its bonds never break (failure: exclude, never) */
    int      facet_order;                              /* Gauss points per direction on a boundary facet */
} pg_bond_points;
/* Quality of the discretisation. */
typedef struct {
    int      thickness_assumed;  /* 1: the scene gives no thickness, 1 m is assumed */
    int      accept_inexact;  /* method.accept_inexact: 1: runs despite any patch test error */
    struct pg_intact *intact;  /* shape functions of the intact body; NULL: not evaluated */
    pg_patch patch;  /* result of the patch test (uniform stress) */
    /* pg_problem_bare only, else NULL: bit k of each facet: a support on points carries component k
     * (pg_patch_probe) */
    unsigned char *borne;
} pg_quality;
/* Remarks on the scene for plan and report: ignored keys, constants changed. */
typedef struct { char text[16][224];  size_t n; } pg_notes;
struct pg_problem {
    char     title[256], name[64];                     /* name: of the scene's folder or file */
    int      dim, threads;
    int      plain;                                    /* 1: no shortcuts (solver.plain) */
    int      equilibria;  /* 1: solver.kind finds equilibria by linear systems */
    pg_mode  mode;
    pg_body  body;  pg_mesh_body part;                 /* shapes or a mesh; both empty for points of a file */
    pg_between *between;  /* slots and gaps between points; NULL: there are none */
    pg_lattice lattice;  pg_cloud cloud;  pg_cells cells;  pg_sets sets;
    pg_start_cracks crack;
    pg_material  *material;  size_t nmaterial;
    pg_criterion *criterion;  /* per material, all of one type; type NULL: nothing breaks */
    int          *block[PG_BOND_SETS];                 /* material of every point of a bond set */
    pg_point_laws at;                                  /* laws of the points */
    pg_discretization form;
    const pg_method *method;                           /* properties of the force model of the scene */
    const pg_method *const *methods;                   /* all force models; ends with NULL */
    void    *options;                                  /* options read by method->read; NULL: none */
    pg_sums *sums;                                     /* without shape functions; else NULL */
    pg_loading boundary;
    pg_bond_points bonds;
    pg_quality quality;
    pg_notes notes;
};
/* Returns 1: this rank owns the point of the bond set (serial runs: always). */
static inline int pg_problem_owns (const pg_problem *p, int set, size_t point)
{
    return !p->bonds.held[set].owned || p->bonds.held[set].owned[point];
}
/* A remark on the scene, as printf. One that begins with PG_WARNING counts among the warnings of the run
 * (pg_solver_doubts), others among its notes (pg_solver_note). At most 16 are kept. */
#define PG_WARNING "warning: "
void pg_problem_note (pg_problem *problem, const char *format, ...) __attribute__ ((format (printf, 2, 3)));
/* Build a problem from a scene in two steps, so that errors of solver and output sections are reported
 * together with those of the problem. prepare_with: all but the bonds, if possible also for a scene with
 * errors (pg_scene_pass; *out then only serves to find more). complete: PG_E_SCENE with all errors, if any,
 * else the bonds. `methods`: all force models; programs call pg_problem_prepare and pg_problem_build of
 * perigal/force.h, which pass them. */
pg_status pg_problem_prepare_with (pg_problem **out, const pg_scene *scene, const pg_method *const *methods,
                                   int threads);
pg_status pg_problem_complete (pg_problem *problem, const pg_scene *scene);
void      pg_problem_free  (pg_problem **problem);
/* Makes a problem for the patch test: the discretisation of `problem` without loads, supports, cracks and
 * failure, entirely of its material with the largest Poisson's ratio; its only load is a traction of zero on
 * all facets, and PG_FACETS are points on all of them (none without shape functions). *out borrows from
 * `problem`. */
pg_status pg_problem_bare  (pg_problem **out, const pg_problem *problem);
void      pg_problem_bare_free (pg_problem **bare);
/* Finds the bond set, and the point of that set, to which a bond (an index into state->alive) belongs. */
void      pg_problem_locate (const pg_problem *problem, size_t bond, int *set, size_t *point);
/* Returns numbers of the points of a set (PG_NODES ...) that do not depend on the division of the body among
 * processes (*number: pg_free). PG_E_LIMIT: there are none. */
pg_status pg_problem_numbers (const pg_problem *problem, int set, int64_t **number);
int       pg_problem_rotations (const pg_problem *problem);            /* rotational unknowns per point */
int       pg_problem_unknowns  (const pg_problem *problem);  /* unknowns per point: dim + rotations */
/* Bounding box of the body, m (dim each); for points of a file or mesh that of the points. */
void      pg_problem_box (const pg_problem *problem, double *low, double *high);
double    pg_problem_spacing (const pg_problem *problem, int set, size_t point);   /* local spacing, m */
/* Elastic law of a point of a bond set; pg_problem_limit: its failure criterion. */
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
/* Name and unit of a quantity PG_OF_..., such as "youngs_modulus". */
const char *pg_variation_name (int of, const char **unit);
/* Writes line k about varying quantities (mean, least and largest value); returns 0 past the last. */
size_t    pg_variation_words (const pg_problem *problem, size_t k, char *text, size_t size);
/* Interface between materials a and b, in any order; NULL: there is none. */
const pg_interface *pg_problem_interface (const pg_problem *problem, int a, int b);
/* 1: entry `e` of the family of a point of a set has no length: its node is the point itself, or lies within
 * PG_NO_LENGTH of the local spacing of it (an evaluation point in the middle of a cell of `lattice: cells`).
 * It has no direction and no stretch: no criterion applies to it, it never breaks, and damage does not count
 * it. */
int       pg_problem_no_bond (const pg_problem *problem, int set, size_t point, size_t e);
/* Properties of a solver type (flags), set in src/solve/<name>.c; other code tests these flags, never a
 * name. */
enum {
    PG_SOLVER_QUASI_STATIC = 1,  /* t of loads is the load factor, 0 to 1; else time, s */
    PG_SOLVER_IMPLICIT = 2,                            /* solves linear systems: forces must be linear in d */
    PG_SOLVER_EXPLICIT = 4,                            /* explicit time steps of stable length */
    PG_SOLVER_STAGED = 8,  /* load stages, each relaxed by an explicit method */
    PG_SOLVER_EVENTS = 16,                             /* supports event stepping */
    PG_SOLVER_NEEDS_DENSITY = 32,
    PG_SOLVER_CONTACT = 128,                           /* supports contact of crack faces */
    PG_SOLVER_FACETS = 64,                             /* supports crack growth by facets */
    PG_SOLVER_RANKS = 256,                             /* supports parallel runs (perigal/ranks.h) */
    PG_SOLVER_STATIC = PG_SOLVER_QUASI_STATIC | PG_SOLVER_IMPLICIT     /* equilibria by linear systems */
};
/* Reports whatever a scene asks for that is not supported when the body is divided among ranks, as errors of
 * the scene. PG_E_SCENE. */
pg_status pg_subdomain_check  (const pg_method *method, const pg_scene *scene);
/* 1: the scene asks for nothing that a divided body does not support, as far as is known before the problem
 * is built. */
int       pg_subdomain_can    (const pg_method *method, const pg_scene *scene);
/* Width of the layer of ghosts around subdomains, m; h: nominal spacing of the points, m. */
pg_status pg_subdomain_width  (double *width, const pg_method *method, const pg_scene *scene, int dim,
                               double h);
/* 1: cracks grow by facets, as the criterion applies to their tips (2D). */
int       pg_problem_grows (const pg_problem *problem);
/* 1: every load is a constant pattern times t */
int       pg_problem_proportional (const pg_problem *problem);
/* 1: every load is a constant pattern plus t times another, t from 0 to 1. */
int       pg_problem_affine (const pg_problem *problem);
/* A copy of the problem with tables of loads of its own, for a run whose stages may end early; all else is
 * borrowed. */
pg_status pg_problem_staged      (pg_problem **out, const pg_problem *problem);
void      pg_problem_staged_free (pg_problem **staged);
/* Sets the loads for stages that end at the fraction share[k] (0 to 1) of stage k; NULL: all at 1. */
void      pg_stages_follow       (pg_problem *staged, const double *share);
/* Lists the intact bonds of the nodes that a stage (from 0) removes, and of evaluation points and facet
 * points nearest to one of these: ascending, each once. */
pg_status pg_stage_removes       (const pg_problem *problem, size_t stage, const unsigned char *alive,
                                  pg_changes *out);
int       pg_problem_removes     (const pg_problem *problem);          /* 1: some stage removes something */
/* 1: a load changes in that stage (from 0). */
int       pg_stage_loads         (const pg_problem *problem, size_t stage);

/* Create the crack paths (2D) or surfaces (3D) of a new state from the pre-cracks of the problem; ..._keep:
 * write or read them in checkpoints. */
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
    unsigned char *alive;                              /* 1: intact, 0: broken (nbond) */
    pg_crack_paths *paths;                             /* 2D; NULL: cracks do not grow */
    pg_crack_surfaces *surfaces;                       /* 3D where cracks grow; else NULL */
} pg_state;
/* Creates the initial state: d = 0, the problem's initial velocity, bonds across pre-cracks broken. */
pg_status pg_state_create (pg_state **out, const pg_problem *problem, int components /* dofs per node */);
pg_status pg_state_copy   (pg_state *to, const pg_state *from);
/* Copies all but the alive bits, for callers that know which of these differ. */
pg_status pg_state_copy_fields (pg_state *to, const pg_state *from);
/* Sets the initial alive bits of the bonds of one point of a set: 0 where a pre-crack cuts. */
void      pg_bonds_cut_at (const pg_problem *problem, int set, size_t point, unsigned char *alive);
void      pg_state_free   (pg_state **state);
/* The cracks of a state (NULL: the initial ones), for tests whether a crack lies between two positions
 * (bonds, sampling, gauges, pictures); damage by single broken bonds is not included. */
const pg_cracks *pg_state_cracks (const pg_problem *problem, const pg_state *state);

/* Grows tip number `tip` in a straight line to `to` (m): adds a facet, moves the tip, and lets the path cut
 * up to its offset behind the tip. All intact bonds that the path now cuts, of every bond set, are added to
 * `cut`, which stays ascending and names each once; their alive bits are left to the caller. close: 1: the
 * tip ends there, on the surface or on another crack, and the path cuts to its end, on the surface a spacing
 * further; a tip of another crack whose offset is not shorter than the distance to `to` ends with it.
 * PG_E_USAGE: no such open tip, or no length. Nothing is changed by a call that fails, except `cut`. */
pg_status pg_crack_grow  (pg_state *state, const pg_problem *problem, size_t tip, const double *to, int close,
                          pg_changes *cut);
/* Adds a new 2D crack from `from` to `to` (m); bit 0, 1 of open: the end `from`, `to` is a tip;
 * PG_START_SLIDES: its faces are in contact and slide (closed_tip_offset). Other ends lie on the surface or
 * on another crack. */
pg_status pg_crack_start (pg_state *state, const pg_problem *problem, const double *from, const double *to,
                          int open, pg_changes *cut);
/* At the start of a run: increases the distance behind a tip that has not grown up to which its path cuts no
 * bonds to `offset` (m), if that is a small enough part of the path; bonds no longer cut become intact
 * again. */
void      pg_tip_draw_back (pg_state *state, const pg_problem *problem, size_t tip, double offset);
/* Sampling points per spacing on the faces of a crack; pg_crack_intervals: number of equal parts of a piece
 * of crack (length, local spacing h, m) in whose middles they lie. */
#define PG_CRACK_POINTS 8
static inline size_t pg_crack_intervals (double length, double h)
{
    double n = ceil (PG_CRACK_POINTS * length / h - 1e-9);
    return n > 1 ? (size_t) n : 1;
}
/* Finds where the straight piece of a 2D crack from a to b (m) crosses borders of background cells with
 * consistent integration: fractions of its length, ascending, including 0 and 1 (*share: the caller
 * frees). */
pg_status pg_crack_breaks (const pg_problem *problem, const double *a, const double *b, size_t *n,
                           double **share);
pg_ground pg_problem_ground (const pg_problem *problem);
/* Returns 1: x (m) lies in the body (for points of a file, which have no surface: near a point). */
int       pg_problem_has_body (const pg_problem *problem, const double *x);
/* Local spacing at x: that of the nearest point, m. */
double    pg_problem_spacing_at (const pg_problem *problem, const double *x);
/* The fronts of a state (NULL: the initial ones); *n: their number. */
const pg_front *pg_fronts_of_state (const pg_problem *problem, const pg_state *state, size_t *n);
/* Moves vertex i of an open front by d[i] (m; 0: it stays) in the direction cos theta[i] ahead + sin theta[i]
 * normal (rad), and adds the triangles between the old and the new edge of the cutting part of the crack.
 * Vertices that come within 1.5 spacings of the surface ahead, or within 0.6 of another crack or front, move
 * there and are closed; a front is split where vertices are closed, and ends where none is left. Ends are put
 * on the surface of the body; vertices are distributed anew where they lie too far apart or too close. All
 * intact bonds that the new triangles cut, of every bond set, are added to `cut`, which stays ascending and
 * names each once; their alive bits are left to the caller. PG_E_USAGE: no such open front, nothing moves.
 * Nothing is changed by a call that fails, except `cut`. d, theta NULL: the front grows no more, and its
 * crack cuts to its end. */
pg_status pg_front_advance (pg_state *state, const pg_problem *problem, size_t front, const double *d,
                            const double *theta, pg_changes *cut);
/* Adds a new 3D crack: the convex polygon of n vertices (n x 3, m) in a plane of unit normal `normal`; the
 * part of its outline inside the body becomes a front. */
pg_status pg_surface_start (pg_state *state, const pg_problem *problem, size_t n, const double *x,
                            const double *normal, pg_changes *cut);

/* ---- costs of linear solves, forces on shape functions ------------------------------------------------- */
typedef struct {
    int    dim, components, order;                     /* dimension; unknowns per point; order of the basis */
    int    interpolates;                               /* 1: N is the identity at the nodes */
    int    projected;                                  /* 1: the dilatation is projected (near nu = 1/2) */
    /* 1: points lie at the centres of cells, not on the surface with the supports */
    int    behind;
    int    scattered;                                  /* 1: nodal integration on points without lattice */
    /* numbers of points; evaluation points; bonds from evaluation points to nodes */
    double points, evaluation, bonds;
    double reach;                                      /* horizon over spacing */
    double edge[3];                                    /* nodes along each axis of the body */
    /* Number of right-hand sides per matrix besides the loads: contact forces between crack faces. */
    double columns;
} pg_solve_counts;
pg_solve_counts pg_solve_count (const pg_problem *problem);
/* 1: the preconditioner uses finite elements on a coarse grid, 0: on all nodes. */
int    pg_solve_on_grid (const pg_solve_counts *c);
/* Estimated seconds from stored timings: assembly; assembly with analysis and factor; one solve by conjugate
 * gradients with finite elements. */
double pg_solve_assembly_cost (const pg_solve_counts *c);
double pg_solve_direct_cost   (const pg_solve_counts *c);
double pg_solve_elements_cost (const pg_solve_counts *c);
/* Seconds per bond of a product K x. */
static const double pg_solve_apply_rate = 4e-9;
/* 1: systems are to be solved by conjugate gradients. available: the force provides finite elements as
 * preconditioner; events: a factor would serve many events; motion: implicit dynamics, where a diagonal
 * preconditioner is too weak. */
int    pg_solve_by_elements   (const pg_solve_counts *c, int available, int events, int motion);
PG_API_END
#endif
