/* SPDX-License-Identifier: GPL-3.0-or-later
 * force.h: out-of-balance force of a displacement, and what solvers need of it. Catalogue:
 * src/mechanics/force/<name>.c + list.h. A force (a discretised force model) owns its fields (displacement;
 * with micropolar models also rotation) and its caches; dofs are numbered node by node. */
#ifndef PERIGAL_FORCE_H
#define PERIGAL_FORCE_H
#include "perigal/linalg.h"
#include "perigal/model.h"

PG_API_BEGIN

typedef struct { const char *name, *unit; int components; } pg_field;

/* Work at the boundary: pairs of generalised force and displacement whose product is work, reactions per
 * load, and the stored energy. */
typedef struct {
    size_t  npair;
    double *force, *displacement;                      /* N, m (npair) */
    double *reaction;  /* reactions on the body, N, N m (PG_REACTIONS components per load) */
    double  strain;  /* stored energy: strain, stabilisation, boundary terms, J */
} pg_work_balance;

/* Quantities of a state that the caller of `work` already knows, so that the force need not evaluate them. */
typedef struct {
    /* Inertial and contact contributions to the residual, N (ndof); NULL: none. */
    const double *inertia;
    /* The residual of the state with its present intact bonds, N (ndof), without `inertia` (whole = 0) or
     * with it (whole = 1). NULL: the force evaluates it. */
    const double *residual;
    int whole;
    /* 1: a static state in equilibrium, so that stored energy may be computed as half the work of the forces
     * (Clapeyron's theorem). */
    int rest;
} pg_known;

/* Estimated error of the stress s against the recovered stress s*; norms: sqrt (int s C s dV), C =
 * compliance, so their squares are twice an energy. */
typedef struct {
    double error, norm;                                /* norms of s* - s and of s, sqrt (J) */
    double relative;                                   /* error / sqrt (norm^2 + error^2) */
    double seconds;
    /* numbers of evaluation points used; of those left out: degenerate, or without a patch */
    size_t points, left_out;
} pg_estimate;

/* Change of K by refreshes since the last request for it. */
typedef struct {
    /* 0: the change is not given (everything may have changed, or too much for an update). */
    int known;
    /* basis: 1: the basis of elimination has changed too; loads: 1: forces that do not depend on d have
     * changed. */
    int basis, loads;
    /* The n affected nodes, and the change of K between their unknowns, N/m: symmetric, row-major with row
     * length `width`, unknowns numbered node by node in this order. Borrowed until the next refresh. */
    size_t n, width;
    const int *node;
    const double *K;
} pg_stiffness_change;
/* A group of bonds that is evaluated repeatedly without evaluating the rest of the body. */
typedef struct {
    size_t  n, *bond;                                  /* ascending: indices of pg_state.alive */
    size_t  first[PG_BOND_SETS + 1];                   /* bonds of set s: first[s] .. first[s + 1] - 1 */
    size_t *owner;                                     /* centre point, in its set, of each bond (n) */
    /* points of each set at the ends of the bonds, ascending */
    size_t  npoint[PG_BOND_SETS], *point[PG_BOND_SETS];
    size_t  nnode;  int *node;  /* nodes whose unknowns determine displacement and stress there, ascending */
} pg_bond_group;
void pg_bond_group_clear (pg_bond_group *group);
/* Request for the utilisation of bonds. Arrays that are NULL are not wanted. */
typedef struct {
    /* Results for all bonds (nbond numbers each), or those of `group` in its order (n each; displacements are
     * read at the nodes of the group only): utilisation; kind, the mode of failure: 't' tension, 's' shear,
     * 'b' bending ...; factor, the load factor at which the bond reaches its limit, if d belongs to load
     * factor 1. Broken bonds, and bonds that never break: utilisation 0, factor INFINITY. */
    const pg_bond_group *group;
    double *utilisation, *factor;
    char   *kind;
    /* over: only the worst bonds are wanted. *top is the largest utilisation of an intact bond (of all
     * ranks); where it exceeds 1, `over` lists the bonds of this rank with utilisation >= `from`, ascending
     * (freed by the caller); utilisation and kind are valid for these only. */
    pg_changes *over;
    double from, *top;
    /* count > 0: d contains `count` displacements, d[unknown * count + k]; top[k] is the largest utilisation
     * of an intact bond that is not marked in left_out (nbond bytes), or (of_unit = 1) the reciprocal of the
     * least load factor. Sums may round differently than for one displacement. */
    size_t count;
    const unsigned char *left_out;
    int of_unit;
    /* If not NULL: only the largest overlap of the ends of broken bonds is computed, m; works without a
     * failure criterion, too. */
    double *overlap;
} pg_judging;
/* Finds the worst bonds (pg_judging.over) from the utilisation of all bonds. */
pg_status pg_worst_bonds (const pg_problem *problem, const pg_state *state, const double *utilisation,
                          double from, double *top, pg_changes *over);
/* Displacement jumps at n points on cracks, or displacements at points on the surface, as linear forms: at
 * point q the sum over e = start[q] .. start[q + 1] - 1 of value[e] times the unknowns of node[e], component
 * by component. */
typedef struct {
    size_t  n, *start;  int *node;  double *value;
    size_t  poor;  /* number of points whose values are zero: see pg_force_surfaces.jump */
} pg_jump_rows;
void pg_jump_rows_clear (pg_jump_rows *rows);
#define PG_CONTACT_STIFFEST 2.0                        /* see pg_force_surfaces.faces */
/* Crack faces that may come into contact, in pieces with sampling points. Borrowed. */
typedef struct {
    size_t n, dim, npoint;                             /* pieces; dimension; sampling points of all pieces */
    const size_t *first;                               /* points of piece k: first[k] .. first[k + 1] - 1 */
    /* of each point: position, m (x dim); unit normal (x dim); tangents (x dim - 1 x dim); area, m^2 */
    const double *x, *normal, *tangent, *weight;
    /* The first nknown pieces are of cracks of the state and get the broken bonds that cross them; the others
     * get the bonds listed: index `broken` in the family of all points, and sampling point `place` of each
     * (nbroken). */
    size_t nknown, nbroken;
    const size_t *broken, *place;
} pg_face_pieces;

/* Remains of a body whose bonds break. */
typedef struct {
    /* Numbers of evaluation points without a gradient, which carry no stress; of isolated nodes; of fragments
     * besides the largest part. */
    size_t degenerate, isolated, fragments;
    double at[3];  /* position of the first degenerate point, m; unchanged if there is none */
    /* background cells near cracks, but not near tips, whose integration cannot be cut off at the cracks */
    size_t unended;
} pg_census;

/* Request for the matrix K: as last assembled; assembled for the last refresh; or with its memory freed until
 * it is assembled again (a force may keep it). */
typedef enum { PG_MATRIX_AT_HAND, PG_MATRIX_ASSEMBLED, PG_MATRIX_FREED } pg_matrix_want;

/* Functions of a force for dynamics. */
typedef struct {
    /* Explicit methods: `balance` at (t, d), in which bonds at or over their limit at d count as broken, as
     * they do in the caches from then on; they are appended to `broken`, ascending; the caller clears their
     * alive bits and does not refresh. reference may be NULL. Entry NULL: judge, refresh and balance are
     * called instead. */
    pg_status (*balance_and_break) (void *self, double t, const double *d, double *residual,
                                    double *reference, pg_changes *broken);
    /* An upper bound, in closed form, of the largest eigenfrequency of K x = omega^2 M x with all bonds
     * intact, rad/s. NULL: from row_sums. */
    pg_status (*bound)   (void *self, double *omega);
    /* sum_j |K_ij| of every dof, N/m (Gershgorin; adaptive dynamic relaxation). NULL: from the matrix. */
    pg_status (*row_sums) (void *self, double *sum);
} pg_force_motion;
/* Functions of a force for loads and contact on the surface of the body and on crack faces. */
typedef struct {
    /* P += nodal forces, N (ndof), of the tractions of a uniform stress (3D: xx yy zz xy yz zx, 2D: xx yy xy,
     * Pa) on all facets on which this force carries loads (with pg_problem_bare: the whole surface). NULL:
     * not available. */
    pg_status (*surface) (void *self, const double *stress, double *P);
    /* Computes the displacement jump (side of the normal less the other side) at n points on cracks of the
     * state (x, m, and unit normal: n x dim), by shape functions with supports of `radius` spacings. Points
     * with too few neighbours on one side for a linear field have zero values (out->poor). NULL: this force
     * does not support contact of crack faces. */
    pg_status (*jump) (void *self, const pg_state *state, size_t n, const double *x, const double *normal,
                       double radius, pg_jump_rows *out);
    /* Computes the displacement at n points on the surface of the body (x, m, and outward unit normal: n x
     * dim), by the shape functions on which a traction there acts, visibility being tested from inside the
     * body. NULL: this force does not support platens. */
    pg_status (*trace) (void *self, const pg_state *state, size_t n, const double *x, const double *normal,
                        pg_jump_rows *out);
    /* Replaces `jump` for forces in which only bonds join the two sides. Computes columns of G' for each
     * piece (ndof x dim n: its mean opening, then its slips), the compliance of the layer between the faces,
     * m/N (dim n), and the largest ratio of its stiffness to that of the bonds that crossed it (*stiffer >=
     * 1), at the last refresh. Layers of bonds that broke one by one are made no stiffer than
     * PG_CONTACT_STIFFEST times. NULL: jump is used, if it is not NULL. */
    pg_status (*faces) (void *self, const pg_state *state, const pg_face_pieces *pieces, pg_sparse *rows,
                        double *soft, double *stiffer);
    /* For forces whose unknowns are not displacements of points (else both NULL): displacement or velocity at
     * the nodes, u = N x, from unknowns x by the shape functions of the last refresh; and forces on unknowns,
     * f += N' F, from forces F on the nodes, N. All arrays n x dim. */
    void      (*at_nodes)   (void *self, const double *x, double *u);
    void      (*from_nodes) (void *self, const double *F, double *f);
} pg_force_surfaces;
/* Functions of a force that save computation and change no result. */
typedef struct {
    /* Describes shortcut k of the force: texts what (96 bytes) and why (160 bytes), seconds saved so far;
     * returns 0 past the last. NULL: there are none. */
    int       (*spared)  (const void *self, size_t k, char *what, char *why, double *seconds);
    /* Computes the contribution to K x, N (ndof), of the evaluation points of the changed bonds, before a
     * refresh by these changes or after it. *can = 0: the changes affect forces at other points, too. NULL:
     * not available. */
    pg_status (*share_of) (void *self, const double *x, const pg_changes *changes, double *y, int *can);
    /* Returns the change of K by refreshes since the last call; the first call starts the record (known = 0).
     * NULL: not available. */
    pg_status (*change) (void *self, pg_stiffness_change *out);
    /* Rows of K at the last refresh, node by node, for preconditioners of the operator. NULL: not
     * available. */
    pg_status (*couplings) (void *self, pg_couplings *out);
    /* Finite elements on the points, whose energies approximate those of K at the last refresh, for
     * preconditioners of the operator. NULL: not available. */
    pg_status (*elements) (void *self, pg_elements *out);
    /* Fills in all fields of a group that follow from group->bond, so that `judge` can evaluate the group
     * alone; *can = 0: impossible with this problem, as stresses depend on more than the bonds. NULL: `judge`
     * computes only `kind` of a group, for which its n and bond suffice. */
    pg_status (*gather) (void *self, pg_bond_group *group, int *can);
    /* Computes the same as balance in one loop without storing strains, for displacements for which nothing
     * else will be evaluated. NULL: balance is used. */
    pg_status (*balance_lean) (void *self, double t, const double *d, double *residual, double *reference);
} pg_force_spares;
/* A force model. Mandatory functions: create, free, fields, balance and one of operator_ and matrix; newmark
 * also needs mass. Others may be NULL. */
typedef struct {
    pg_method method;  /* name, summary, and properties used before a force is created */
    pg_status (*create)  (void **self, const pg_problem *problem);
    void      (*free)    (void **self);
    size_t    (*fields)  (const void *self, size_t max, pg_field *out);
    /* Updates the caches to state->alive: all of them (changes NULL), or those affected by the changes. */
    pg_status (*refresh) (void *self, const pg_state *state, const pg_changes *changes);
    /* residual = loads (t) - internal force (d), N (ndof), boundary terms included; reference: the force to
     * which the norm of the residual is compared, N. */
    pg_status (*balance) (void *self, double t, const double *d, double *residual, double *reference);
    /* Mass, kg. lumped: of each unknown (ndof). consistent: matrix with one number for each pair of nodes
     * (upper triangle, n x n), the same for every component; computed with the bonds intact at the first
     * call, and kept when bonds break. *consistent = NULL: lumped mass only (forces without shape functions).
     * Arguments NULL: not wanted. */
    pg_status (*mass)    (void *self, double *lumped, const pg_sparse **consistent);
    const pg_operator *(*operator_) (void *self);                          /* the operator K x, or NULL */
    /* Returns K in the state given by `want`. *K = NULL: this problem has no matrix; (*K)->value NULL: not
     * assembled. Entry NULL: matrix-free. Use pg_force_assemble, pg_force_matrix. */
    pg_status (*matrix)  (void *self, pg_matrix_want want, const pg_sparse **K);
    /* Returns T of the elimination of prescribed displacements, d = T q + g; NULL (entry or result): no
     * elimination. */
    const pg_sparse   *(*basis)     (void *self);
    pg_status (*impose)  (void *self, double t, double *d);                /* makes d satisfy d = T q + g */
    /* Computes the utilisation of bonds at d (pg_judging). NULL: there are no bonds. */
    pg_status (*judge) (void *self, const pg_state *state, const double *d, const pg_judging *what);
    /* Computes the work balance at (t, d); known: values the caller already has, or NULL. `out` is allocated
     * on the first call. Entry NULL: not available. */
    pg_status (*work) (void *self, double t, const double *d, const pg_known *known, pg_work_balance *out);
    /* Computes a field at the nodes: "displacement" (m), "coefficient" (of the shape functions, m), "strain",
     * "stress" (Pa), "damage", "error_estimate" (Pa); *components 0: unknown name. value: n x 6. */
    pg_status (*field) (void *self, const pg_state *state, const double *d, const char *name, int *components,
                        const char **unit, double *value);
    /* Counts degenerate points, isolated nodes and fragments with the bonds of the last refresh. */
    pg_status (*census)  (void *self, pg_census *out);
    /* Unites points that exert forces on each other at the last refresh into disjoint sets (pg_disjoint, n;
     * on each rank by interactions of its own points). NULL: not available. */
    void      (*join)    (void *self, int *parent);
    /* Computes loads at t as nodal forces, N (ndof), without supports. NULL: balance at d = 0 is used, which
     * includes supports. */
    pg_status (*loads)   (void *self, double t, double *P);
    /* Number that changes whenever a refresh changed K or the basis; until then an old factor remains valid.
     * NULL: every refresh changes them. */
    unsigned long (*revision) (const void *self);
    /* Computes displacement (m), stress (Pa) and displacement gradient (the last two NULL: not wanted) at any
     * n positions by the force's own shape functions with the bonds of the last refresh, so that they jump
     * across cracks. x: n x dim; u: n x 3, 0 beyond dim; stress: n x 6, always xx yy zz xy yz zx (2D: zz as
     * the mode has it); gradient: n x 9, of which H[c * dim + k] = du_c/dx_k at the front, by the derivatives
     * of the shape functions. Outside the body: extrapolated from the nearest point. NULL: a least squares
     * fit is used (perigal/compare.h). */
    pg_status (*sample) (void *self, const pg_state *state, const double *d, size_t n, const double *x,
                         double *u, double *stress, double *gradient);
    /* Estimates the error of the stress s at d. value: NULL, or sqrt (E times the mean of (s* - s) C (s* - s)
     * around each node), Pa (n). Entry NULL: not available. */
    pg_status (*estimate) (void *self, const double *d, pg_estimate *out, double *value);
    /* Writes line number `line` of a description of constants and choices, for plans and reports; returns 0
     * past the last line. NULL: none. */
    int       (*describe) (const void *self, size_t line, char *text, size_t size);
    pg_force_motion   motion;
    pg_force_surfaces surfaces;
    pg_force_spares   spares;
} pg_force_type;
/* Assembles K for the last refresh. K may be NULL; *K = NULL: the force has no matrix. */
pg_status pg_force_assemble (const pg_force_type *force, void *self, const pg_sparse **K);
/* K as last assembled (value NULL: not assembled yet, or freed); returns NULL where the force has none. */
const pg_sparse *pg_force_matrix (const pg_force_type *force, void *self);
/* Stress (xx yy zz xy yz zx, Pa) of the displacement gradient H[c * dim + k] = du_c/dx_k. */
void pg_stress_of_gradient (const pg_material *material, int dim, const double *H, double *stress);
/* The upper bound of the largest eigenfrequency that explicit methods use, rad/s: the force's own bound, or
 * that from row sums at its last refresh (mass, kg, and workspace: ndof each). NAN: the force has neither. In
 * parallel runs for points owned by the rank. *from: which bound, in words. */
pg_status pg_force_bound (const pg_force_type *force, void *self, const pg_cloud *cloud, size_t ndof,
                          const double *mass, double *workspace, double *omega, const char **from);
const pg_force_type *pg_force_find  (const char *name);
/* The force model for which the problem was built. */
const pg_force_type *pg_force_of    (const pg_problem *problem);
const pg_method *const *pg_force_methods (void);  /* methods of all force models; ends with NULL */
/* Build the problem of a scene by pg_problem_prepare_with and pg_problem_complete of perigal/model.h, with
 * all force models. */
pg_status pg_problem_prepare (pg_problem **out, const pg_scene *scene, int threads);
pg_status pg_problem_build   (pg_problem **out, const pg_scene *scene, int threads);
const char          *pg_force_names (void);
void pg_work_balance_clear (pg_work_balance *work_balance);
PG_API_END
#endif
